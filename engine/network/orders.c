#include "network/network.h"

static const vn_orders_def orders_default = {.kind = VN_STRAHLER};

static const vn_field orders_fields[] = {
    {"ratio", VN_F64, VN_ABOVE_MIN | VN_OPTIONAL, offsetof(vn_orders_def, ratio), 0, 1, "", NULL,
     "hickey: a lateral this many times as thick as the thickest child has its order too; left out: none "
     "has"},
};
const vn_schema vn_orders_schema = VN_SCHEMA("orders", "Vein orders", orders_fields, orders_default);

vn_orders_def vn_orders_def_default(void) {
    return orders_default;
}

// What decides which child continues a vein: its width, or the tips that it feeds where no radii are known.
static double weight_of(const vn_network *network, const int32_t *tips, int32_t node) {
    return vn_network_has_radii(network) ? vn_network_radius(network, node) : tips[node];
}

// Of the highest order in @p among (when given), then the thickest, then of the least index.
static int32_t thickest_child(const vn_network *network, const int32_t *tips, int32_t node,
                              const int32_t *among) {
    int32_t best = -1;
    double most = -1;
    int32_t highest = -1;
    for (int32_t c = network->first_child.data[node]; c >= 0; c = network->next_child.data[c]) {
        int32_t order = among != NULL ? among[c] : 0;
        double weight = weight_of(network, tips, c);
        bool equal = order == highest && weight == most;
        if (order > highest || (order == highest && weight > most) || (equal && c < best)) {
            highest = order;
            most = weight;
            best = c;
        }
    }
    return best;
}

static void strahler(const vn_network *network, int32_t *order) {
    for (int32_t k = network->x.count - 1; k >= 0; k--) {
        int32_t node = vn_network_nth(network, k);
        int32_t highest = 0, times = 0;
        for (int32_t c = network->first_child.data[node]; c >= 0; c = network->next_child.data[c]) {
            times = order[c] > highest ? 1 : times + (order[c] == highest);
            highest = order[c] > highest ? order[c] : highest;
        }
        order[node] = highest == 0 ? 1 : highest + (times > 1);
    }
}

static void horton(const vn_network *network, const int32_t *tips, int32_t *order) {
    strahler(network, order);
    for (int32_t k = 0; k < network->x.count; k++) {
        int32_t node = vn_network_nth(network, k);
        int32_t main = thickest_child(network, tips, node, order);
        if (main >= 0) {
            order[main] = order[node];
        }
    }
}

static void hickey(const vn_network *network, const int32_t *tips, double ratio, int32_t *order) {
    for (int32_t k = 0; k < network->x.count; k++) {
        int32_t node = vn_network_nth(network, k);
        order[node] = network->parent.data[node] < 0 ? 1 : order[node];
        int32_t main = thickest_child(network, tips, node, NULL);
        double enough = main >= 0 && ratio > 0 ? ratio * weight_of(network, tips, main) : INFINITY;
        for (int32_t c = network->first_child.data[node]; c >= 0; c = network->next_child.data[c]) {
            order[c] = order[node] + (c != main && !(weight_of(network, tips, c) >= enough));
        }
    }
}

vn_status vn_network_compute_orders(const vn_network *network, const vn_orders_def *def, int32_t *order) {
    VN_ARRAY(int32_t) tips = {0};
    VN_TRY(vn_array_zero(&tips, network->x.count));
    vn_network_count_tips(network, tips.data);
    if (def->kind == VN_STRAHLER) {
        strahler(network, order);
    } else if (def->kind == VN_HORTON) {
        horton(network, tips.data, order);
    } else {
        hickey(network, tips.data, def->ratio, order);
    }
    vn_array_free(&tips);
    return VN_OK;
}

vn_status vn_network_set_orders_by(vn_network *network, const vn_orders_def *def) {
    VN_TRY(vn_check_def(&vn_orders_schema, def));
    VN_TRY(vn_array_zero(&network->orders, network->x.count));
    vn_status status = vn_network_compute_orders(network, def, network->orders.data);
    if (status != VN_OK) {
        network->orders.count = 0;
        return status;
    }
    network->orders_ratio = def->kind == VN_HICKEY ? def->ratio : 0;
    network->orders_version = network->version;
    return VN_OK;
}

vn_status vn_network_set_orders(vn_network *network, vn_order_kind kind) {
    return vn_network_set_orders_by(network, &(vn_orders_def){.kind = kind});
}

const int32_t *vn_network_orders(const vn_network *network) {
    bool current = network->orders.count == network->x.count && network->orders_version == network->version;
    return current && network->orders.count > 0 ? network->orders.data : NULL;
}
