// The extra edges that close loops. A pair of nodes has one edge at most: a table of hashed pairs says
// whether it has one.

#include "network/network.h"

static uint64_t pair_key(int32_t a, int32_t b) {
    uint32_t low = (uint32_t)(a < b ? a : b);
    uint32_t high = (uint32_t)(a < b ? b : a);
    return (uint64_t)low << 32 | high; // never 0: the nodes differ, so the higher is not 0
}

// The place of the pair, or the empty one where it belongs.
static int32_t place_of(const uint64_t *table, int32_t size, uint64_t key) {
    uint32_t mask = (uint32_t)size - 1;
    uint32_t at = (uint32_t)vn_hash(0, key, 0, 0) & mask;
    while (table[at] != 0 && table[at] != key) {
        at = (at + 1) & mask;
    }
    return (int32_t)at;
}

static void fill_table(vn_network *network) {
    memset(network->joined.data, 0, (size_t)network->joined.count * sizeof *network->joined.data);
    for (int32_t i = 0; i < network->joins.count; i++) {
        uint64_t key = pair_key(network->joins.data[i].a, network->joins.data[i].b);
        network->joined.data[place_of(network->joined.data, network->joined.count, key)] = key;
    }
}

// At most half full, so that a free place is near.
static vn_status make_room(vn_network *network) {
    int64_t size = network->joined.count > 0 ? network->joined.count : 16;
    while (size < 2 * ((int64_t)network->joins.count + 1)) {
        size *= 2;
    }
    VN_TRY(vn_array_reserve(&network->joins, (int64_t)network->joins.count + 1));
    if (network->murray) {
        VN_TRY(vn_demand_reserve(network, network->x.count, (int64_t)network->joins.count + 1));
    }
    if (size > network->joined.count) {
        VN_TRY(vn_array_reserve(&network->joined, size));
        network->joined.count = (int32_t)size;
        fill_table(network);
    }
    return VN_OK;
}

bool vn_network_connected(const vn_network *network, int32_t a, int32_t b) {
    if (network->parent.data[a] == b || network->parent.data[b] == a) {
        return true;
    }
    uint64_t key = pair_key(a, b);
    return network->joined.count > 0 &&
           network->joined.data[place_of(network->joined.data, network->joined.count, key)] == key;
}

vn_status vn_network_join(vn_network *network, int32_t a, int32_t b, double radius) {
    int32_t count = network->x.count;
    if (a < 0 || b < 0 || a >= count || b >= count || a == b) {
        return vn_fail(VN_INVALID, "a join needs two different nodes of the %d there are", count);
    }
    if (!(radius >= 0 && radius <= VN_HUGE)) {
        return vn_fail(VN_INVALID, "a join's radius = %g must be 0 or more", radius);
    }
    VN_TRY(make_room(network));
    uint64_t key = pair_key(a, b);
    int32_t place = place_of(network->joined.data, network->joined.count, key);
    if (vn_network_connected(network, a, b)) {
        return vn_fail(VN_INVALID, "a join needs two nodes that are not connected yet");
    }
    network->joined.data[place] = key;
    network->joins.data[network->joins.count++] = (vn_join){a, b, radius};
    network->version++;
    return VN_OK;
}

int32_t vn_network_join_count(const vn_network *network) {
    return network->joins.count;
}

void vn_network_join_ends(const vn_network *network, int32_t join, int32_t *a, int32_t *b, double *radius) {
    const vn_join *given = &network->joins.data[join];
    *a = given->a;
    *b = given->b;
    *radius = given->radius;
    if (vn_demand_rules(network)) {
        const vn_demand *demand = vn_network_demand(network);
        bool flipped = demand->flipped.data[join];
        *a = flipped ? given->b : given->a;
        *b = flipped ? given->a : given->b;
        *radius = vn_murray_radius(network, demand->share.data[*b]);
    }
}

int32_t vn_network_join_order(const vn_network *network, int32_t join) {
    const int32_t *orders = vn_network_orders(network);
    if (orders == NULL) {
        return 0;
    }
    int32_t a = orders[network->joins.data[join].a], b = orders[network->joins.data[join].b];
    return a > b ? a : b;
}
