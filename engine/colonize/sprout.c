// How a vessel's node grows (Rauch & Harders 2021, section 3, Equation 4; READINGS R17 to R19).

#include "colonize/axis.h"
#include "colonize/extend.h"
#include "domain/domain.h"

/// One node that sprouts.
typedef struct sprout {
    const vn_extension *e;
    vn_zone zone;
    double at[3];
} sprout;

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double c[3]) {
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

// Scale @p v to length 1; false where it is no longer than @p nothing.
static bool normalise(double v[3], double nothing) {
    double length = sqrt(dot(v, v));
    for (int k = 0; k < 3; k++) {
        v[k] = length > nothing ? v[k] / length : 0;
    }
    return length > nothing;
}

static const double NOTHING = 1e-9; // of a vector that is of length 1 but for cancellation

// What of @p v is at right angles to the unit vector @p e, as a unit vector.
static bool perpendicular(const double v[3], const double e[3], double out[3]) {
    double along = dot(v, e);
    for (int k = 0; k < 3; k++) {
        out[k] = v[k] - along * e[k];
    }
    return normalise(out, NOTHING);
}

// Some direction at right angles to @p e, in the plane where that is flat.
static void any_perpendicular(const double e[3], int dim, double out[3]) {
    double axis[3] = {0, 0, 0};
    int least = 0;
    for (int k = 1; k < 3; k++) {
        least = fabs(e[k]) < fabs(e[least]) ? k : least;
    }
    axis[least] = 1;
    if (dim == 2) {
        out[0] = -e[1];
        out[1] = e[0];
        out[2] = 0;
    } else {
        perpendicular(axis, e, out);
    }
}

// Toward the attractor that ranks first.
static void first_ranked(const sprout *s, double n[3]) {
    const vn_extension *e = s->e;
    const vn_keyed *first = e->begin;
    for (const vn_keyed *pair = e->begin + 1; pair < e->end; pair++) {
        first = vn_rank(e, pair->value) < vn_rank(e, first->value) ? pair : first;
    }
    vn_direction_to(e, e->node, first->value, n);
}

// v of Equation 4: straight on, or Murray's optimal branch on the side of the attraction @p toward; where
// that leads along the vessel, on the side of the first-ranked attractor (R18).
static void preferred(const sprout *s, const double toward[3], double v[3]) {
    const vn_zone *zone = &s->zone;
    double side[3], unit[3] = {toward[0], toward[1], toward[2]};
    memcpy(v, zone->e, 3 * sizeof *v);
    if (zone->kind != VN_ZONE_BELT) {
        return;
    }
    bool sided = normalise(unit, 0) && perpendicular(unit, zone->e, side);
    if (!sided) {
        first_ranked(s, unit);
        sided = perpendicular(unit, zone->e, side);
    }
    if (!sided) {
        any_perpendicular(zone->e, s->e->network->dim, side);
    }
    for (int k = 0; k < 3; k++) {
        v[k] = zone->cosine * zone->e[k] + zone->sine * side[k];
    }
}

// Equation 4 for the summed directions @p sum of attractors; false where nothing is left of it.
static bool biased(const sprout *s, const double sum[3], double g[3]) {
    double w = s->zone.kind == VN_ZONE_BALL ? 0 : s->e->def->bias;
    double v[3], mean[3] = {sum[0], sum[1], sum[2]};
    if (s->e->def->bias_mean && !normalise(mean, NOTHING)) {
        return false;
    }
    preferred(s, sum, v);
    for (int k = 0; k < 3; k++) {
        g[k] = w * v[k] + (1 - w) * mean[k];
    }
    return normalise(g, NOTHING);
}

static bool is_free(const sprout *s, const double p[3], bool forks) {
    const vn_extension *e = s->e;
    return !vn_has_child_toward(e, e->node, p) && vn_stays_inside(e, e->node, p) &&
           vn_keeps_clear(e, e->node, p, forks);
}

// The slack is what rounding does to a mean of directions on the zone's own border.
static bool leads_to(const sprout *s, const double g[3], double p[3]) {
    vn_step_from(s->e, s->e->node, g, p);
    return vn_zone_holds(&s->zone, g, 1e-12) && is_free(s, p, false);
}

// Toward the first-ranked attractor that a step can be made to. A single one is always in the zone, and so is
// what Equation 4 makes of it.
static bool aim_at_one(const sprout *s, double p[3]) {
    const vn_extension *e = s->e;
    bool found = false;
    uint64_t least = 0;
    for (const vn_keyed *pair = e->begin; pair < e->end; pair++) {
        double n[3], g[3], q[3];
        uint64_t rank = vn_rank(e, pair->value);
        vn_direction_to(e, e->node, pair->value, n);
        if ((!found || rank < least) && biased(s, n, g) && leads_to(s, g, q)) {
            found = true;
            least = rank;
            memcpy(p, q, sizeof q);
        }
    }
    return found;
}

// Attractors on either side of a vessel draw an inter-node straight on, out of its zone and along the child
// that is there: then one of them alone is followed.
static bool aim(const sprout *s, double p[3]) {
    double sum[3], g[3];
    vn_sum_directions(s->e, sum);
    return (biased(s, sum, g) && leads_to(s, g, p)) || aim_at_one(s, p);
}

// √(mean θ²) of the angles to the mean attraction direction, in degrees (R19).
static double deviation(const sprout *s) {
    double sum[3], squares = 0;
    vn_sum_directions(s->e, sum);
    if (!normalise(sum, NOTHING)) {
        return 180;
    }
    for (const vn_keyed *pair = s->e->begin; pair < s->e->end; pair++) {
        double n[3], across[3];
        vn_direction_to(s->e, s->e->node, pair->value, n);
        cross(sum, n, across);
        double angle = atan2(sqrt(dot(across, across)), dot(sum, n)); // exact where a cosine is blunt
        squares += angle * angle;
    }
    return sqrt(squares / (double)(s->e->end - s->e->begin)) * (180 / 3.14159265358979323846);
}

// The attractors' mean @p mean, from the node, and the line of least squares through them, @p axis.
static void fit_line(const sprout *s, double mean[3], double axis[3]) {
    int64_t count = s->e->end - s->e->begin;
    vn_spread spread = {.covariance = {0}};
    memset(mean, 0, 3 * sizeof *mean);
    for (int pass = 0; pass < 2; pass++) {
        for (const vn_keyed *pair = s->e->begin; pair < s->e->end; pair++) {
            double q[3];
            vn_attractors_place(s->e->a, pair->value, q);
            for (int k = 0; k < 3; k++) {
                q[k] -= s->at[k];
                mean[k] += pass == 0 ? q[k] / (double)count : 0;
                q[k] -= mean[k];
            }
            if (pass == 1) {
                vn_spread_add(&spread, q);
            }
        }
    }
    vn_spread_axis(&spread, axis);
}

// The normal of the plane that both daughters lie in.
static bool find_plane(const sprout *s, double normal[3], double mean[3]) {
    double axis[3];
    fit_line(s, mean, axis);
    bool has_mean = normalise(mean, 0);
    cross(mean, axis, normal);
    if (has_mean && normalise(normal, NOTHING)) {
        return true;
    }
    cross(s->zone.e, axis, normal);
    return normalise(normal, NOTHING);
}

// The places of two daughters at Murray's angle for equal tips, cos α = 2^(2/κ−1), to either side of the
// vessel's direction in the plane of the attractors' spread (R19).
static bool fork(const sprout *s, double p[2][3]) {
    double normal[3], mean[3], axis[3], side[3];
    if (!find_plane(s, normal, mean)) {
        return false;
    }
    if (!perpendicular(s->zone.e, normal, axis)) {
        memcpy(axis, mean, sizeof axis);
    }
    cross(normal, axis, side);
    double c = exp2(2 / s->e->a->gaze.exponent - 1), w = sqrt(1 - c * c);
    for (int i = 0; i < 2; i++) {
        double g[3];
        for (int k = 0; k < 3; k++) {
            g[k] = c * axis[k] + (i == 0 ? w : -w) * side[k];
        }
        vn_step_from(s->e, s->e->node, g, p[i]);
    }
    return is_free(s, p[0], true) && is_free(s, p[1], true);
}

static bool may_fork(const sprout *s) {
    const vn_extend_def *def = s->e->def;
    return def->bifurcate > 0 && s->zone.kind == VN_ZONE_CONE && s->e->end - s->e->begin > 1 &&
           s->e->network->parent.data[s->e->node] >= 0 && deviation(s) > def->bifurcate;
}

vn_status vn_sprout(const vn_extension *e) {
    sprout s = {.e = e};
    double p[2][3];
    vn_zone_find(&s.zone, &e->a->gaze, e->network, e->node);
    vn_network_position(e->network, e->node, s.at);
    int places = may_fork(&s) && fork(&s, p) ? 2 : 0;
    places = places == 0 && aim(&s, p[0]) ? 1 : places;
    for (int i = 0; i < places; i++) {
        VN_TRY(vn_grow_edge(e, e->node, p[i]));
    }
    return VN_OK;
}
