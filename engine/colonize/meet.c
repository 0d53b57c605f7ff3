// A vein that grows into another one ends there: no edge crosses another but at a node, and the two are
// joined. The papers let edges cross; then loops that are drawn are no cycles of the network.

#include "colonize/attractors.h"

// Below this part of a segment's length from its end, an edge is met at that end.
static const double NEAR_END = 0.25;

enum { KIN = 3 };

static bool is_above(const vn_network *network, int32_t above, int32_t node, int steps) {
    for (int k = 0; k <= steps && node >= 0; k++) {
        if (node == above) {
            return true;
        }
        node = network->parent.data[node];
    }
    return false;
}

// Twigs of one fork that touch are no loop worth having.
static bool are_kin(const vn_network *network, int32_t a, int32_t b) {
    for (int k = 0; k < KIN && a >= 0; k++) {
        if (is_above(network, a, b, KIN)) {
            return true;
        }
        a = network->parent.data[a];
    }
    return false;
}

// Whether @p a has a join with a node that is next to @p b, or next but one, in the tree.
static bool is_joined_beside(const vn_network *network, int32_t a, int32_t b) {
    int32_t parent = network->parent.data[b];
    if (parent >= 0 && vn_network_connected(network, a, parent)) {
        return true;
    }
    for (int32_t c = network->first_child.data[b]; c >= 0; c = network->next_child.data[c]) {
        if (vn_network_connected(network, a, c)) {
            return true;
        }
    }
    int32_t sibling = parent >= 0 ? network->first_child.data[parent] : -1;
    while (sibling >= 0 && !vn_network_connected(network, a, sibling)) {
        sibling = network->next_child.data[sibling];
    }
    return sibling >= 0;
}

bool vn_met_before(const vn_network *network, int32_t a, int32_t b) {
    return vn_network_connected(network, a, b) || are_kin(network, a, b) || is_joined_beside(network, a, b) ||
           is_joined_beside(network, b, a);
}

// The vein that is met becomes the second parent of the newcomer: were it the other way round, half of what a
// main vein feeds would count for the twig that ran into it.
static vn_status join_to(vn_network *network, int32_t node, int32_t to, double length, vn_outcome *outcome) {
    double p[3];
    bool meets;
    vn_meeting other;
    *outcome = VN_BARRED;
    if (node == to || vn_met_before(network, node, to)) {
        return VN_OK;
    }
    vn_network_position(network, to, p);
    VN_TRY(vn_network_meets(network, node, p, to, length, &meets, &other));
    if (!meets) {
        VN_TRY(vn_network_join(network, to, node, 0));
        *outcome = VN_MET;
    }
    return VN_OK;
}

static vn_status join_into(vn_network *network, int32_t node, const vn_meeting *met, double length,
                           vn_outcome *outcome) {
    int32_t ends[2];
    double q[2][3], d[2];
    vn_network_edge_ends(network, met->edge, &ends[0], &ends[1]);
    for (int k = 0; k < 2; k++) {
        vn_network_position(network, ends[k], q[k]);
        d[k] = sqrt(vn_distance2(met->p, q[k]));
    }
    int nearer = d[1] < d[0];
    *outcome = VN_BARRED;
    if (vn_met_before(network, node, ends[0]) || vn_met_before(network, node, ends[1])) {
        return VN_OK;
    }
    if (met->edge >= 0 && d[nearer] >= NEAR_END * length) {
        int32_t middle;
        VN_TRY(vn_network_split(network, met->edge, met->p, &middle));
        *outcome = VN_MET;
        return vn_network_join(network, middle, node, 0);
    }
    VN_TRY(join_to(network, node, ends[nearer], length, outcome));
    bool other = *outcome == VN_BARRED && d[!nearer] <= length;
    return other ? join_to(network, node, ends[!nearer], length, outcome) : VN_OK;
}

vn_status vn_meet(vn_network *network, int32_t node, const double p[3], int32_t to, const vn_extend_def *def,
                  vn_outcome *outcome) {
    bool meets;
    vn_meeting met;
    *outcome = VN_CLEAR;
    if (def->meet == VN_MEET_CROSS || network->dim != 2) {
        return VN_OK;
    }
    VN_TRY(vn_network_meets(network, node, p, to, def->length, &meets, &met));
    if (!meets) {
        return VN_OK;
    }
    int32_t a, b;
    vn_network_edge_ends(network, met.edge, &a, &b);
    *outcome = VN_BARRED;
    bool stays = def->meet == VN_MEET_STOP || a == node || b == node;
    return stays ? VN_OK : join_into(network, node, &met, def->length, outcome);
}
