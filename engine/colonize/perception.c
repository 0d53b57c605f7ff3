#include "colonize/perception.h"

static const double PI = 3.14159265358979323846;
static const vn_perception perception_default = {.lateral = true};

static const vn_field perception_fields[] = {
    {"angle", VN_F64, VN_REQUIRED | VN_ABOVE_MIN | VN_OPTIONAL, offsetof(vn_perception, angle), 0, 360,
     "degrees", NULL, "γ: a leaf perceives what lies within half of it on either side of its direction"},
    {"lateral", VN_BOOL, 0, offsetof(vn_perception, lateral), 0, 0, "", NULL,
     "whether inter-nodes perceive too, around Murray's optimal branch, and grow laterals"},
};
const vn_schema vn_perception_schema =
    VN_SCHEMA("perception", "What a vessel's nodes perceive (Rauch & Harders, Equations 2 and 3)",
              perception_fields, perception_default);

vn_perception vn_perception_default(void) {
    return perception_default;
}

// The lateral of one tip against a child of so many. r_p⁴ − r_ℓ⁴ by the difference of powers of neighbours.
static double lateral_cosine(double exponent, double tips) {
    double child2 = pow(tips, 2 / exponent), parent2 = pow(tips + 1, 2 / exponent);
    double difference = child2 * child2 * expm1(4 / exponent * log1p(1 / tips));
    return fmin((difference + 1) / (2 * parent2), 1);
}

static bool is_ready(const vn_gaze *gaze, const vn_network *network, const vn_perception *perception) {
    return gaze->exponent == network->law.exponent && gaze->perception.angle == perception->angle &&
           gaze->perception.lateral == perception->lateral;
}

vn_status vn_gaze_prepare(vn_gaze *gaze, const vn_network *network, const vn_perception *perception,
                          bool *changed) {
    *changed = false;
    VN_TRY(vn_check_def(&vn_perception_schema, perception));
    if (perception->angle > 0 && !network->murray) {
        return vn_fail(VN_INVALID,
                       "influence.perception: the angles of branches follow from Murray's law: give the "
                       "network murray = {exponent=, tip_radius=}");
    }
    double exponent = network->law.exponent;
    if (perception->angle > 0 && !(exponent > 2 && exponent <= 4)) {
        return vn_fail(VN_INVALID,
                       "influence.perception: murray.exponent = %g must be above 2 and at most 4: only there "
                       "branches have angles of their own (Equation 1)",
                       exponent);
    }
    if (is_ready(gaze, network, perception)) {
        return VN_OK;
    }
    *changed = true;
    double half = perception->angle * (PI / 360);
    gaze->perception = *perception;
    gaze->exponent = exponent;
    gaze->half_cos = cos(half);
    gaze->half_sin = sin(half);
    for (int tips = 1; perception->angle > 0 && tips < VN_TABLED_TIPS; tips++) {
        gaze->lateral_cos[tips] = lateral_cosine(exponent, tips);
    }
    return VN_OK;
}

static double cosine_of(const vn_gaze *gaze, int32_t tips) {
    return tips < VN_TABLED_TIPS ? gaze->lateral_cos[tips] : lateral_cosine(gaze->exponent, tips);
}

// The direction of the edge that leads to the node, or that was given to a root; false where there is none.
static bool find_direction(const vn_network *network, int32_t node, double e[3]) {
    int32_t parent = network->parent.data[node];
    double p[3], q[3];
    if (parent < 0) {
        return vn_network_heading(network, node, e);
    }
    vn_network_position(network, parent, p);
    vn_network_position(network, node, q);
    double length = sqrt(vn_distance2(p, q));
    for (int k = 0; k < 3; k++) {
        e[k] = length > 0 ? (q[k] - p[k]) / length : 0;
    }
    return length > 0;
}

static const double ANY = 2; // no cosine is beyond it

void vn_zone_turn(vn_zone *zone, const vn_gaze *gaze, int32_t tips) {
    double c = cosine_of(gaze, tips), s = sqrt(1 - c * c);
    zone->cosine = c;
    zone->sine = s;
    zone->low_cos = -c < gaze->half_cos ? c * gaze->half_cos - s * gaze->half_sin : -ANY;
    zone->high_cos = c < gaze->half_cos ? c * gaze->half_cos + s * gaze->half_sin : ANY;
}

void vn_zone_find(vn_zone *zone, const vn_gaze *gaze, const vn_network *network, int32_t node) {
    *zone = (vn_zone){.kind = VN_ZONE_NONE, .cosine = 1, .low_cos = -ANY, .high_cos = ANY};
    int32_t child = network->first_child.data[node];
    if (!vn_gaze_may_grow(gaze, network, node)) {
        return;
    }
    if (!find_direction(network, node, zone->e)) {
        zone->kind = VN_ZONE_BALL;
        return;
    }
    zone->kind = child < 0 ? VN_ZONE_CONE : VN_ZONE_BELT;
    if (child < 0) {
        zone->low_cos = gaze->half_cos > -1 ? gaze->half_cos : -ANY;
        return;
    }
    vn_zone_turn(zone, gaze, network->tips.data[child]);
}

bool vn_zone_holds(const vn_zone *zone, const double d[3], double slack) {
    if (zone->kind <= VN_ZONE_BALL) {
        return zone->kind == VN_ZONE_BALL;
    }
    double along = zone->e[0] * d[0] + zone->e[1] * d[1] + zone->e[2] * d[2];
    double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    return along >= (zone->low_cos - slack) * length && along <= (zone->high_cos + slack) * length;
}

vn_status vn_network_zone(const vn_network *network, int32_t node, const vn_perception *perception,
                          vn_zone_shape *out) {
    vn_gaze gaze = {.exponent = 0};
    vn_zone zone;
    bool changed;
    VN_TRY(vn_gaze_prepare(&gaze, network, perception, &changed));
    if (node < 0 || node >= network->x.count) {
        return vn_fail(VN_INVALID, "node %d is not one of the %d there are", node, network->x.count);
    }
    if (!vn_gaze_is_open(&gaze)) {
        *out = (vn_zone_shape){.kind = VN_ZONE_BALL};
        return VN_OK;
    }
    vn_network_settle(network);
    vn_zone_find(&zone, &gaze, network, node);
    *out = (vn_zone_shape){.kind = zone.kind, .angle = acos(zone.cosine) * (180 / PI)};
    memcpy(out->direction, zone.e, sizeof out->direction);
    return VN_OK;
}
