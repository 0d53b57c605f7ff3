// Murray's law where veins meet (READINGS R9) or take up more than their children do. A node's demand is
// what its child edges carry, or one tip's; its parent edges carry equal shares of it. Demands are counted
// in tips, r_tip^n each, so they depend on neither the exponent nor the tips' radius.

#include "network/network.h"

bool vn_demand_rules(const vn_network *network) {
    return network->murray && (network->joins.count > 0 || network->law.veinlets > 0);
}

vn_status vn_demand_reserve(vn_network *network, int64_t nodes, int64_t joins) {
    vn_demand *d = &network->demand;
    VN_TRY(vn_array_reserve(&d->share, nodes));
    VN_TRY(vn_array_reserve(&d->sorted, nodes));
    VN_TRY(vn_array_reserve(&d->first, nodes));
    VN_TRY(vn_array_reserve(&d->major, nodes));
    VN_TRY(vn_array_reserve(&d->next, 2 * joins));
    return vn_array_reserve(&d->flipped, joins);
}

void vn_demand_free(vn_demand *d) {
    vn_array_free(&d->share);
    vn_array_free(&d->sorted);
    vn_array_free(&d->first);
    vn_array_free(&d->major);
    vn_array_free(&d->next);
    vn_array_free(&d->flipped);
}

// Join end 2 j is a's, 2 j + 1 is b's. Each node lists its ends in the order of the joins.
static void link_joins(vn_network *network) {
    vn_demand *d = &network->demand;
    for (int32_t i = 0; i < network->x.count; i++) {
        d->first.data[i] = -1;
    }
    for (int32_t j = network->joins.count - 1; j >= 0; j--) {
        int32_t ends[2] = {network->joins.data[j].a, network->joins.data[j].b};
        d->flipped.data[j] = false;
        for (int k = 0; k < 2; k++) {
            d->next.data[2 * j + k] = d->first.data[ends[k]];
            d->first.data[ends[k]] = 2 * j + k;
        }
    }
}

// Whether the node at a join's end is that join's parent.
static bool is_parent_end(const vn_demand *d, int32_t end) {
    return (end % 2 == 1) == d->flipped.data[end / 2];
}

static int32_t other_node(const vn_network *network, int32_t end) {
    const vn_join *join = &network->joins.data[end / 2];
    return end % 2 == 0 ? join->b : join->a;
}

static int32_t count_parents(const vn_network *network, int32_t node) {
    int32_t parents = network->parent.data[node] >= 0;
    for (int32_t end = network->demand.first.data[node]; end >= 0; end = network->demand.next.data[end]) {
        parents += !is_parent_end(&network->demand, end);
    }
    return parents;
}

// Until demands are known, `share` holds how many parents a node still waits for; SORTED: it is in `sorted`.
#define SORTED (-1)

static void release(vn_demand *d, int32_t node) {
    d->share.data[node] -= 1;
    if (d->share.data[node] == 0) {
        d->share.data[node] = SORTED;
        d->sorted.data[d->sorted.count++] = node;
    }
}

static void release_children(vn_network *network, int32_t node) {
    vn_demand *d = &network->demand;
    for (int32_t c = network->first_child.data[node]; c >= 0; c = network->next_child.data[c]) {
        release(d, c);
    }
    for (int32_t end = d->first.data[node]; end >= 0; end = d->next.data[end]) {
        if (is_parent_end(d, end)) {
            release(d, other_node(network, end));
        }
    }
}

// The node waits for itself, round a circle of parents: its joins from nodes not yet sorted are turned.
static void turn_joins(vn_network *network, int32_t node) {
    vn_demand *d = &network->demand;
    for (int32_t end = d->first.data[node]; end >= 0; end = d->next.data[end]) {
        int32_t other = other_node(network, end);
        if (!is_parent_end(d, end) && d->share.data[other] != SORTED) {
            d->flipped.data[end / 2] = true;
            d->share.data[other] += 1;
        }
    }
    d->share.data[node] = 1;
    release(d, node);
}

// Parents before children, over edges and joins (Kahn 1962). The first node that is not sorted when nothing
// more can be is one whose tree parent is: only joins hold it up.
static void sort_nodes(vn_network *network) {
    vn_demand *d = &network->demand;
    int32_t count = network->x.count, done = 0;
    d->sorted.count = 0;
    for (int32_t k = 0; k < count; k++) {
        int32_t node = vn_network_nth(network, k);
        d->share.data[node] = count_parents(network, node) + 1;
    }
    for (int32_t k = 0; k < count; k++) {
        release(d, vn_network_nth(network, k));
    }
    for (int32_t k = 0; done < count;) {
        while (done < d->sorted.count) {
            release_children(network, d->sorted.data[done++]);
        }
        while (k < count && d->share.data[vn_network_nth(network, k)] == SORTED) {
            k++;
        }
        if (k < count) {
            turn_joins(network, vn_network_nth(network, k));
        }
    }
}

// A sum that does not depend on the order of so many addends: the order of children is not in files.
enum { SORTED_ADDENDS = 16 };

typedef struct addends {
    double least[SORTED_ADDENDS]; // ascending
    double rest;
    int32_t count;
} addends;

static void add(addends *sum, double value) {
    int32_t i = sum->count++;
    if (i >= SORTED_ADDENDS) {
        sum->rest += value;
        return;
    }
    for (; i > 0 && sum->least[i - 1] > value; i--) {
        sum->least[i] = sum->least[i - 1];
    }
    sum->least[i] = value;
}

static double total_of(const addends *sum) {
    double total = 0;
    for (int32_t i = 0; i < sum->count && i < SORTED_ADDENDS; i++) {
        total += sum->least[i];
    }
    return total + sum->rest;
}

static double demand_of(const vn_network *network, int32_t node, bool widened) {
    const vn_demand *d = &network->demand;
    addends sum = {.count = 0};
    for (int32_t c = network->first_child.data[node]; c >= 0; c = network->next_child.data[c]) {
        add(&sum, d->share.data[c]);
    }
    for (int32_t end = d->first.data[node]; end >= 0; end = d->next.data[end]) {
        if (is_parent_end(d, end)) {
            add(&sum, d->share.data[other_node(network, end)]);
        }
    }
    double taken_up = widened && d->major.data[node] ? network->law.veinlets : 0;
    return sum.count > 0 ? total_of(&sum) + taken_up : 1;
}

static void find_shares(vn_network *network, bool widened) {
    for (int32_t k = network->x.count - 1; k >= 0; k--) {
        int32_t node = network->demand.sorted.data[k];
        int32_t parents = count_parents(network, node);
        double demand = demand_of(network, node, widened);
        network->demand.share.data[node] = parents > 1 ? demand / parents : demand;
    }
}

static int32_t main_child(const vn_network *network, int32_t node) {
    const double *share = network->demand.share.data;
    int32_t best = -1;
    for (int32_t c = network->first_child.data[node]; c >= 0; c = network->next_child.data[c]) {
        if (best < 0 || share[c] > share[best] || (share[c] == share[best] && c < best)) {
            best = c;
        }
    }
    return best;
}

// Hickey's orders 1 and 2 by the shares without widening; `major` holds an order until it holds a truth.
static void find_major(vn_network *network) {
    uint8_t *order = network->demand.major.data;
    for (int32_t k = 0; k < network->x.count; k++) {
        int32_t node = vn_network_nth(network, k);
        order[node] = network->parent.data[node] < 0 ? 1 : order[node];
        int32_t main = main_child(network, node);
        for (int32_t c = network->first_child.data[node]; c >= 0; c = network->next_child.data[c]) {
            order[c] = (uint8_t)(order[node] < 3 ? order[node] + (c != main) : 3);
        }
    }
    for (int32_t i = 0; i < network->x.count; i++) {
        order[i] = order[i] <= 2;
    }
}

const vn_demand *vn_network_demand(const vn_network *constant) {
    vn_network *network = (vn_network *)constant; // a cache, whose memory was reserved as the network grew
    if (network->demand.version != network->version) {
        link_joins(network);
        sort_nodes(network);
        find_shares(network, false);
        if (network->law.veinlets > 0) {
            find_major(network);
            find_shares(network, true);
        }
        network->demand.version = network->version;
    }
    return &network->demand;
}

double vn_demand_thickest(const vn_network *network, int32_t node) {
    const vn_demand *d = vn_network_demand(network);
    double most = 0;
    for (int32_t c = network->first_child.data[node]; c >= 0; c = network->next_child.data[c]) {
        most = fmax(most, d->share.data[c]);
    }
    for (int32_t end = d->first.data[node]; end >= 0; end = d->next.data[end]) {
        if (is_parent_end(d, end)) {
            most = fmax(most, d->share.data[other_node(network, end)]);
        }
    }
    return most;
}
