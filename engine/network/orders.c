#include "network/network.h"

// What decides which child continues a vein: its width, or the tips that it feeds where no radii are known.
static double weight_of(const vn_network *network, const int32_t *tips, int32_t node) {
    return vn_network_has_radii(network) ? vn_network_radius(network, node) : tips[node];
}

// The children are listed newest first; of equals the lower index leads, so the later of equals in the list.
static int32_t thickest_child(const vn_network *network, const int32_t *tips, int32_t node,
                              const int32_t *among) {
    int32_t best = -1;
    double most = -1;
    int32_t highest = -1;
    for (int32_t c = network->first_child.data[node]; c >= 0; c = network->next_child.data[c]) {
        int32_t order = among != NULL ? among[c] : 0;
        double weight = weight_of(network, tips, c);
        if (order > highest || (order == highest && weight >= most)) {
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

static void hickey(const vn_network *network, const int32_t *tips, int32_t *order) {
    for (int32_t k = 0; k < network->x.count; k++) {
        int32_t node = vn_network_nth(network, k);
        order[node] = network->parent.data[node] < 0 ? 1 : order[node];
        int32_t main = thickest_child(network, tips, node, NULL);
        for (int32_t c = network->first_child.data[node]; c >= 0; c = network->next_child.data[c]) {
            order[c] = order[node] + (c != main);
        }
    }
}

vn_status vn_network_set_orders(vn_network *network, vn_order_kind kind) {
    VN_ARRAY(int32_t) tips = {0};
    VN_TRY(vn_array_zero(&tips, network->x.count));
    vn_status status = vn_array_zero(&network->orders, network->x.count);
    if (status != VN_OK) {
        vn_array_free(&tips);
        return status;
    }
    vn_network_count_tips(network, tips.data);
    if (kind == VN_STRAHLER) {
        strahler(network, network->orders.data);
    } else if (kind == VN_HORTON) {
        horton(network, tips.data, network->orders.data);
    } else {
        hickey(network, tips.data, network->orders.data);
    }
    network->orders_version = network->version;
    vn_array_free(&tips);
    return VN_OK;
}

const int32_t *vn_network_orders(const vn_network *network) {
    bool current = network->orders.count == network->x.count && network->orders_version == network->version;
    return current && network->orders.count > 0 ? network->orders.data : NULL;
}
