// Murray's law, r_parent^n = Σ r_child^n (Runions et al. 2005, section 3.5), for equal tips: r^n is the
// number of tips times r_tip^n. So the network counts tips, which are integers and cannot drift, and powers
// are taken on demand. Joins and veinlets are demand.c's.

#include "network/network.h"

static const vn_murray_def murray_default = {.exponent = 3, .tip_radius = 1};

static const vn_field murray_fields[] = {
    {"exponent", VN_F64, VN_ABOVE_MIN, offsetof(vn_murray_def, exponent), 0, 100, "", NULL,
     "n in r_parent^n = Σ r_child^n: 3 by Murray, 2 in most of Runions' leaves"},
    {"tip_radius", VN_F64, VN_ABOVE_MIN, offsetof(vn_murray_def, tip_radius), 0, VN_HUGE, "length", NULL,
     "radius of the edges that end in a tip"},
    {"veinlets", VN_F64, 0, offsetof(vn_murray_def, veinlets), 0, 1e9, "tips", NULL,
     "what each node of a primary or secondary vein takes up besides its children, for veinlets that are "
     "not modeled"},
};
const vn_schema vn_murray_schema =
    VN_SCHEMA("murray", "Radii by Murray's law", murray_fields, murray_default);

vn_murray_def vn_murray_def_default(void) {
    return murray_default;
}

void vn_network_count_tips(const vn_network *network, int32_t *tips) {
    int32_t count = network->x.count;
    for (int32_t i = 0; i < count; i++) {
        tips[i] = network->first_child.data[i] < 0;
    }
    for (int32_t k = count - 1; k >= 0; k--) {
        int32_t node = vn_network_nth(network, k);
        int32_t parent = network->parent.data[node];
        if (parent >= 0) {
            tips[parent] += tips[node];
        }
    }
}

// Tell those above each pending node; false when that takes longer than counting all anew. Counts are
// then in between.
static bool climb(vn_network *network) {
    int64_t steps = 0;
    for (int32_t i = 0; i < network->pending.count; i++) {
        int32_t node = network->pending.data[i];
        for (; node >= 0; node = network->parent.data[node]) {
            network->tips.data[node]++;
            steps++;
        }
        if (steps > network->x.count) {
            return false;
        }
    }
    return true;
}

void vn_network_settle(const vn_network *constant) {
    vn_network *network =
        (vn_network *)constant; // the counts are a cache: their value was settled by the growth
    if (network->recount || !climb(network)) {
        vn_network_count_tips(network, network->tips.data);
    }
    network->pending.count = 0;
    network->recount = false;
}

vn_status vn_network_murray(vn_network *network, const vn_murray_def *def) {
    VN_TRY(vn_check_def(&vn_murray_schema, def));
    if (network->murray && def->exponent == network->law.exponent && def->veinlets == network->law.veinlets) {
        network->law.tip_radius = def->tip_radius; // tissue growth sets it anew each step: tips stay counted
        network->version++;
        return VN_OK;
    }
    VN_TRY(vn_array_reserve(&network->tips, network->x.count));
    if (network->joins.count > 0 || def->veinlets > 0) {
        VN_TRY(vn_demand_reserve(network, network->x.count, network->joins.count));
    }
    network->tips.count = network->x.count;
    network->murray = true;
    network->law = *def;
    network->recount = true;
    network->version++;
    vn_array_free(&network->radius);
    return VN_OK;
}

bool vn_network_murray_get(const vn_network *network, vn_murray_def *def) {
    *def = network->murray ? network->law : murray_default;
    return network->murray;
}

bool vn_network_has_radii(const vn_network *network) {
    return network->murray || network->radius.count > 0;
}

double vn_murray_radius(const vn_network *network, double tips) {
    double radius = network->law.tip_radius;
    return tips == 1 ? radius : radius * pow(tips, 1 / network->law.exponent);
}

static double edge_radius(const vn_network *network, int32_t node) {
    if (!network->murray) {
        return network->radius.count > 0 ? network->radius.data[node] : 0;
    }
    return vn_murray_radius(network, network->tips.data[node]);
}

// Joins that a root is the parent of count among its children.
static double demanded_radius(const vn_network *network, int32_t node) {
    bool root = network->parent.data[node] < 0;
    return vn_murray_radius(network, root ? vn_demand_thickest(network, node)
                                          : vn_network_demand(network)->share.data[node]);
}

double vn_network_radius(const vn_network *network, int32_t node) {
    if (vn_demand_rules(network)) {
        return demanded_radius(network, node);
    }
    if (network->recount || network->pending.count > 0) {
        vn_network_settle(network);
    }
    if (network->parent.data[node] >= 0) {
        return edge_radius(network, node);
    }
    double thickest = network->murray ? 0 : edge_radius(network, node);
    for (int32_t c = network->first_child.data[node]; c >= 0; c = network->next_child.data[c]) {
        thickest = fmax(thickest, edge_radius(network, c));
    }
    return thickest;
}
