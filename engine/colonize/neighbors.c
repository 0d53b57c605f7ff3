// V(s), the nodes that an attractor draws where veins may close loops (Runions et al. 2005, section 4;
// READINGS R4 and R5).
//
// The relative neighbors are kept exactly and without a triangulation of their own: nodes only ever come, so
// V(s ∪ u) is V(s) without what u excludes, and u if nothing excludes it. Only an attractor that is new looks
// at the triangulation of the nodes, for the corners of its conflict hole. The Urquhart neighbors have no
// such law (a node that u pushes out of the hole may have excluded another), and are found anew.

#include "colonize/attractors.h"

// Which of a and b is nearer to p; in doubles where that decides, or else exactly.
static int compare(const double p[3], const double a[3], const double b[3]) {
    double da = vn_distance2(p, a), db = vn_distance2(p, b);
    double error = 1e-14 * (da + db);
    if (error > 1e-280 && da - db > error) {
        return 1;
    }
    if (error > 1e-280 && db - da > error) {
        return -1;
    }
    return vn_compare_distances(p, a, b);
}

// Whether u keeps v from being a relative neighbor of s: |u - s| < |v - s| and |u - v| <= |v - s|.
static bool excludes(const double u[3], const double v[3], const double s[3]) {
    return compare(s, u, v) < 0 && compare(v, u, s) <= 0;
}

static void place_of(const vn_attractors *a, int32_t i, double p[3]) {
    vn_points points = vn_attractors_points(a);
    vn_points_get(&points, i, p);
}

static int32_t take_tie(vn_attractors *a) {
    int32_t tie = a->free_tie;
    if (tie >= 0) {
        a->free_tie = a->ties.data[tie].next;
        return tie;
    }
    bool room = vn_array_reserve(&a->ties, (int64_t)a->ties.count + 1) == VN_OK;
    return room ? a->ties.count++ : -1;
}

static void give_back(vn_attractors *a, int32_t tie) {
    a->ties.data[tie].next = a->free_tie;
    a->free_tie = tie;
}

vn_status vn_ties_prepare(vn_attractors *a) {
    VN_TRY(vn_array_reserve(&a->first_tie, a->x.count));
    VN_TRY(vn_array_reserve(&a->stage, a->x.count));
    for (; a->first_tie.count < a->x.count; a->first_tie.count++, a->stage.count++) {
        a->first_tie.data[a->first_tie.count] = -1;
        a->stage.data[a->stage.count] = VN_FREE;
    }
    return VN_OK;
}

void vn_ties_drop(vn_attractors *a, int32_t i) {
    if (i >= a->first_tie.count) {
        return;
    }
    for (int32_t tie = a->first_tie.data[i]; tie >= 0;) {
        int32_t next = a->ties.data[tie].next;
        give_back(a, tie);
        tie = next;
    }
    a->first_tie.data[i] = -1;
}

void vn_ties_drop_ghosts(vn_attractors *a, int32_t i) {
    int32_t *link = &a->first_tie.data[i];
    while (*link >= 0) {
        int32_t tie = *link;
        if (a->ties.data[tie].state & VN_GHOST) {
            *link = a->ties.data[tie].next;
            give_back(a, tie);
        } else {
            link = &a->ties.data[tie].next;
        }
    }
}

void vn_ties_forget(vn_attractors *a) {
    for (int32_t i = 0; i < a->first_tie.count; i++) {
        for (int32_t tie = a->first_tie.data[i]; tie >= 0; tie = a->ties.data[tie].next) {
            a->ties.data[tie].state |= VN_GHOST;
        }
    }
    for (int32_t k = 0; k < a->outdated.count; k++) {
        a->stage.data[a->outdated.data[k]] &= (uint8_t)~VN_OUTDATED;
    }
    a->outdated.count = 0;
}

void vn_ties_move(vn_attractors *a, int32_t from, int32_t to) {
    if (from < a->first_tie.count) {
        int32_t first = a->first_tie.data[from];
        a->first_tie.data[from] = -1;
        a->first_tie.data[to] = first;
        a->stage.data[to] = a->stage.data[from];
    }
}

// What a new tie takes over: from a ghost of itself, or from the node's parent, whose tags it inherits.
// @p anew says that it was no member before.
static vn_tie inherit(const vn_attractors *a, const vn_network *network, int32_t i, int32_t node, bool *anew) {
    vn_tie made = {.node = node, .best = INFINITY};
    *anew = true;
    int32_t parent = network->parent.data[node];
    for (int32_t tie = a->first_tie.data[i]; tie >= 0; tie = a->ties.data[tie].next) {
        const vn_tie *other = &a->ties.data[tie];
        if (other->node == node || other->node == parent) {
            made.best = other->best;
            made.idle = other->idle;
            made.state = other->state & (other->node == node ? ~VN_GHOST : ~(VN_GHOST | VN_REACHED));
            made.state |= other->node == parent ? VN_GREW : 0;
        }
        if (other->node == node) {
            *anew = false;
            break;
        }
    }
    return made;
}

// A vein that comes nearer renews the attractor's patience.
static void note_progress(vn_attractors *a, const vn_network *network, int32_t i, const vn_tie *tie,
                          double d2) {
    double s[3], q[3];
    if ((tie->state & VN_GREW) && network->parent.data[tie->node] >= 0) {
        place_of(a, i, s);
        vn_network_position(network, network->parent.data[tie->node], q);
        bool nearer = sqrt(d2) < sqrt(vn_distance2(s, q)) - 1e-3 * a->last.length;
        a->idle.data[i] &= nearer ? (uint8_t) ~(VN_IDLE | VN_HIDDEN) : 0xFF;
    }
}

static vn_status add_tie(vn_attractors *a, const vn_network *network, int32_t i, int32_t node, double d2) {
    bool anew;
    vn_tie made = inherit(a, network, i, node, &anew);
    if (anew) {
        note_progress(a, network, i, &made, d2);
    }
    int32_t tie = take_tie(a);
    if (tie < 0) {
        return VN_NO_MEMORY;
    }
    if (a->node.data[i] < 0) {
        VN_TRY(vn_array_push(&a->activated, ((vn_keyed){(uint64_t)i, i})));
    }
    made.next = a->first_tie.data[i];
    a->ties.data[tie] = made;
    a->first_tie.data[i] = tie;
    a->node.data[i] = node;
    return vn_attractors_note_fresh(a, i, d2);
}

static bool is_in_lune(int32_t node, const vn_lune *lune, void *payload) {
    double u[3];
    vn_network_position(payload, node, u);
    return excludes(u, lune->v, lune->s);
}

static bool lune_is_empty(const vn_network *network, const double s[3], const double v[3]) {
    vn_lune lune = {{s[0], s[1], s[2]}, {v[0], v[1], v[2]}};
    vn_points nodes = vn_network_points(network);
    return !vn_point_tree_any_in_lune(&network->tree_of_points, &nodes, &lune, is_in_lune, (void *)network);
}

static bool is_tie(const vn_attractors *a, int32_t i, int32_t node) {
    for (int32_t tie = a->first_tie.data[i]; tie >= 0; tie = a->ties.data[tie].next) {
        if (a->ties.data[tie].node == node && !(a->ties.data[tie].state & VN_GHOST)) {
            return true;
        }
    }
    return false;
}

// The nodes among which V(s) is: all while they are few, the corners of the conflict hole later.
static vn_status find_candidates(vn_attractors *a, vn_network *network, const double s[3], double *reach) {
    enum { FEW = 48 };
    *reach = INFINITY;
    if (network->x.count <= FEW) {
        VN_TRY(vn_array_reserve(&a->candidates, network->x.count));
        a->candidates.count = network->x.count;
        for (int32_t k = 0; k < network->x.count; k++) {
            a->candidates.data[k] = k;
        }
        return VN_OK;
    }
    vn_delaunay *delaunay;
    VN_TRY(vn_network_delaunay(network, &delaunay));
    vn_points nodes = vn_network_points(network);
    vn_nearest near = {.reach2 = INFINITY};
    vn_point_grid_nearest(&network->grid, &nodes, s, &near);
    return vn_delaunay_neighbors(delaunay, s, near.point, &a->candidates, reach);
}

static vn_status sort_candidates(vn_attractors *a, const vn_network *network, const double s[3]) {
    VN_TRY(vn_array_reserve(&a->near_nodes, a->candidates.count));
    vn_points nodes = vn_network_points(network);
    int32_t count = 0;
    for (int32_t k = 0; k < a->candidates.count; k++) {
        int32_t node = a->candidates.data[k];
        double d2 = vn_points_distance2(&nodes, node, s);
        int32_t at = count++;
        for (; at > 0 && a->near_nodes.data[at - 1].distance2 > d2; at--) {
            a->near_nodes.data[at] = a->near_nodes.data[at - 1];
        }
        a->near_nodes.data[at] = (vn_reach_hit){node, d2};
    }
    a->near_nodes.count = count;
    return VN_OK;
}

// Whether a candidate excludes candidate @p k. Distances in doubles order them but for rounding, so what
// comes a little later is asked too.
static bool is_excluded_among(const vn_attractors *a, const vn_network *network, int32_t k,
                              const double s[3]) {
    double u[3], v[3];
    const vn_reach_hit *hits = a->near_nodes.data;
    vn_network_position(network, hits[k].point, v);
    double last = hits[k].distance2 * (1 + 1e-14);
    for (int32_t j = 0; j < a->near_nodes.count && hits[j].distance2 <= last; j++) {
        vn_network_position(network, hits[j].point, u);
        if (j != k && excludes(u, v, s)) {
            return true;
        }
    }
    return false;
}

static void set_interest(vn_attractors *a, int32_t i, double reach) {
    double farthest = a->near_nodes.count > 0 ? a->near_nodes.data[a->near_nodes.count - 1].distance2 : 0;
    // A node that pushes a corner out of the hole lies in one of the circles round it, which end at twice
    // their radius.
    double reach2 = a->mode == VN_URQUHART ? 4 * reach * reach : fmax(reach * reach, farthest);
    a->near2.data[i] = fmin(reach2 * (1 + 1e-9), a->reach2);
}

vn_status vn_ties_look(vn_attractors *a, vn_network *network, int32_t i) {
    double s[3], v[3], reach;
    const vn_point_grid *grid;
    const vn_point_tree *tree;
    place_of(a, i, s);
    VN_TRY(vn_network_grid(network, 0, &grid));
    VN_TRY(vn_network_tree_of_points(network, &tree));
    VN_TRY(find_candidates(a, network, s, &reach));
    VN_TRY(sort_candidates(a, network, s));
    set_interest(a, i, reach);
    // Farthest first, so that the nearest becomes the head of the list, where it is asked first.
    for (int32_t k = a->near_nodes.count - 1; k >= 0; k--) {
        vn_reach_hit hit = a->near_nodes.data[k];
        vn_network_position(network, hit.point, v);
        if (hit.distance2 <= a->reach2 && !is_excluded_among(a, network, k, s) &&
            (a->mode == VN_URQUHART || lune_is_empty(network, s, v)) && !is_tie(a, i, hit.point)) {
            VN_TRY(add_tie(a, network, i, hit.point, hit.distance2));
        }
    }
    return VN_OK;
}

// The new node drives out the members that it excludes, even where it is no member itself: that is what
// sets the relative neighbors apart from the Urquhart ones (Figure 8).
static bool push_in(vn_attractors *a, const vn_network *network, int32_t i, const double u[3],
                    const double s[3]) {
    bool excluded = false;
    for (int32_t tie = a->first_tie.data[i]; tie >= 0; tie = a->ties.data[tie].next) {
        double v[3];
        if (a->ties.data[tie].state & VN_GHOST) {
            continue;
        }
        vn_network_position(network, a->ties.data[tie].node, v);
        if (!excluded && excludes(v, u, s)) {
            excluded = true;
        } else if (excludes(u, v, s)) {
            a->ties.data[tie].state |= VN_GHOST;
        }
    }
    return !excluded;
}

vn_status vn_ties_show(vn_attractors *a, const vn_network *network, int32_t i, int32_t node, double d2) {
    double s[3], u[3];
    if (a->mode == VN_URQUHART) {
        bool listed = a->stage.data[i] & VN_OUTDATED;
        a->stage.data[i] |= VN_OUTDATED;
        return listed ? VN_OK : vn_array_push(&a->outdated, i);
    }
    place_of(a, i, s);
    vn_network_position(network, node, u);
    if (!push_in(a, network, i, u, s) || !lune_is_empty(network, s, u) || is_tie(a, i, node)) {
        return VN_OK;
    }
    return add_tie(a, network, i, node, d2);
}

vn_status vn_ties_renew(vn_attractors *a, vn_network *network) {
    for (int32_t k = 0; k < a->outdated.count; k++) {
        int32_t i = a->outdated.data[k];
        a->stage.data[i] &= (uint8_t)~VN_OUTDATED;
        for (int32_t tie = a->first_tie.data[i]; tie >= 0; tie = a->ties.data[tie].next) {
            a->ties.data[tie].state |= VN_GHOST;
        }
        if (!vn_is_gone(a, i)) {
            VN_TRY(vn_ties_look(a, network, i));
        }
    }
    a->outdated.count = 0;
    return VN_OK;
}
