// The remembered nearest nodes. DESIGN: a new node changes only attractors that it is nearer to than what
// they remember, and a new attractor has to look once.

#include "colonize/attractors.h"

#include "base/parallel.h"

static void forget(vn_attractors *a, const vn_network *network, int mode, double reach2) {
    bool moved = a->network_serial == network->serial && a->network_moved != network->moved;
    vn_ties_forget(a, moved);
    if (a->ties_serial != network->serial) {
        vn_ties_leave(a);
        a->ties_serial = network->serial;
    }
    a->mode = mode;
    for (int32_t i = 0; i < a->x.count; i++) {
        if (!vn_is_gone(a, i)) {
            a->near2.data[i] = reach2;
            a->node.data[i] = -1;
            a->idle.data[i] &=
                (uint8_t)~VN_HIDDEN; // its patience stays: no set lives for ever by changing networks
            a->best.data[i] = moved ? INFINITY : a->best.data[i];
        }
    }
    a->network_serial = network->serial;
    a->network_moved = network->moved;
    a->reach2 = reach2;
    a->nodes_seen = 0;
    a->attractors_seen = 0;
    a->tree_count = 0;
    a->tree.levels = 0;
    a->active.count = 0;
    a->activated.count = 0;
    a->waiting.count = 0;
    a->sleep.count = 0;
    a->fresh.count = 0;
    a->fresh_all = true;
}

vn_status vn_attractors_note_fresh(vn_attractors *a, int32_t i, double d2) {
    if (a->fresh_all) {
        return VN_OK;
    }
    if (a->fresh.count > 2 * a->x.count + 1024) {
        a->fresh.count = 0;
        a->fresh_all = true;
        return VN_OK;
    }
    return vn_array_push(&a->fresh, ((vn_reach_hit){i, d2}));
}

void vn_attractors_forget(vn_attractors *a) {
    a->network_serial = 0;
}

static bool is_hidden_from(const vn_attractors *a, const vn_network *network, int32_t i, int32_t node) {
    double p[3], q[3];
    if (!(a->idle.data[i] & VN_HIDDEN)) {
        return false;
    }
    vn_attractors_place(a, i, p);
    vn_network_position(network, node, q);
    return !vn_domain_sees(a->sight, q, p);
}

// Node @p node is at squared distance @p d2 <= near2 of attractor @p i.
static vn_status show(vn_attractors *a, const vn_network *network, int32_t i, int32_t node, double d2) {
    int32_t present = a->node.data[i];
    bool tie = d2 == a->near2.data[i] && present >= 0;
    if (tie && !vn_ranks_before(a->seed, a->id.data[i], node, present)) {
        return VN_OK;
    }
    VN_TRY(vn_attractors_note_fresh(a, i, d2));
    if (vn_gaze_is_open(&a->gaze) && !vn_gaze_may_grow(&a->gaze, network, node)) {
        return VN_OK; // it may consume the attractor, but can do nothing more for it
    }
    if (is_hidden_from(a, network, i, node)) {
        return VN_OK; // it may be reached, and consumed, but does not draw the node
    }
    if (present < 0) {
        VN_TRY(vn_array_push(&a->activated, ((vn_keyed){(uint64_t)i, i})));
    }
    a->node.data[i] = node;
    a->near2.data[i] = d2;
    return VN_OK;
}

static bool keeps_out(const void *payload, int32_t i, const double p[3], double d2, double guard[3]) {
    return vn_ties_keep_out(payload, i, p, d2, guard);
}

static vn_reach_filter filter_of(const vn_attractors *a) {
    return (vn_reach_filter){keeps_out, a, a->farthest2.data};
}

static vn_status show_node(vn_attractors *a, const vn_network *network, int32_t node, int32_t seen) {
    double p[3], guard[3];
    vn_points points = vn_attractors_points(a);
    vn_reach_filter filter = filter_of(a);
    bool filtered = a->mode == VN_RELATIVE;
    vn_network_position(network, node, p);
    a->hits.count = 0;
    VN_TRY(vn_reach_tree_query(&a->tree, &points, a->near2.data, filtered ? &filter : NULL, p, &a->hits));
    for (int32_t i = a->tree_count; i < seen; i++) {
        double d2 = vn_points_distance2(&points, i, p);
        if (d2 <= a->near2.data[i] && !(filtered && vn_ties_keep_out(a, i, p, d2, guard))) {
            VN_TRY(vn_array_push(&a->hits, ((vn_reach_hit){i, d2})));
        }
    }
    for (int32_t h = 0; h < a->hits.count; h++) {
        vn_reach_hit hit = a->hits.data[h];
        if (hit.point >= seen) {
            continue;
        }
        VN_TRY(a->mode == VN_NEAREST ? show(a, network, hit.point, node, hit.distance2)
                                     : vn_array_push(&a->news, ((vn_keyed){(uint64_t)hit.point, node})));
    }
    return VN_OK;
}

// The tree may lack a tail of newcomers, which each node goes through one by one; when that would take longer
// than to build it anew, it is.
static vn_status renew_tree(vn_attractors *a, int32_t nodes) {
    int64_t tail = a->x.count - a->tree_count;
    if (a->tree.levels > 0 && tail * nodes <= 32 * (int64_t)a->x.count) {
        return VN_OK;
    }
    vn_points points = vn_attractors_points(a);
    vn_reach_filter filter = filter_of(a);
    VN_TRY(vn_reach_tree_build(&a->tree, a->dim, &points, a->near2.data,
                               a->mode == VN_RELATIVE ? &filter : NULL, a->x.count));
    a->tree_count = a->x.count;
    return VN_OK;
}

// Along the curve that the tree is built on: neighbours then ask the same packs while these are in the cache.
static vn_status sort_nodes(vn_attractors *a, const vn_network *network, int32_t begin) {
    double low[3], high[3];
    vn_points points = vn_network_points(network);
    VN_TRY(vn_array_reserve(&a->nodes, network->x.count - begin));
    a->nodes.count = network->x.count - begin;
    for (int32_t i = 0; i < a->nodes.count; i++) {
        a->nodes.data[i].value = begin + i;
    }
    double size = vn_points_extent(&points, begin, network->x.count, low, high);
    return vn_points_sort(&points, a->dim, low, size, &a->nodes, &a->scratch);
}

typedef struct showing {
    vn_attractors *a;
    const vn_network *network;
    int32_t node, seen;
    double p[3];
    vn_status status;
} showing;

static bool show_to(int32_t i, void *payload) {
    showing *s = payload;
    vn_points points = vn_attractors_points(s->a);
    double d2 = vn_points_distance2(&points, i, s->p);
    if (i < s->seen && d2 <= s->a->near2.data[i]) {
        s->status = show(s->a, s->network, i, s->node, d2);
    }
    return s->status != VN_OK;
}

// Where sight ends near by, and attractors come and go with every step, a grid of them is cheaper than a
// tree.
static vn_status show_around(vn_attractors *a, const vn_network *network, int32_t begin, int32_t seen) {
    double reach = nextafter(sqrt(a->reach2), INFINITY);
    vn_points points = vn_attractors_points(a);
    VN_TRY(vn_attractors_grid(a, reach));
    for (int32_t node = begin; node < network->x.count; node++) {
        showing s = {.a = a, .network = network, .node = node, .seen = seen};
        vn_network_position(network, node, s.p);
        vn_point_grid_any_within(&a->grid, &points, s.p, reach, show_to, &s);
        VN_TRY(s.status);
    }
    return vn_poll();
}

static vn_status show_nodes(vn_attractors *a, const vn_network *network, int32_t begin, int32_t seen) {
    if (begin >= network->x.count || seen == 0) {
        return VN_OK;
    }
    if (vn_gaze_is_open(&a->gaze) && isfinite(a->reach2)) {
        return show_around(a, network, begin, seen);
    }
    VN_TRY(renew_tree(a, network->x.count - begin));
    VN_TRY(sort_nodes(a, network, begin));
    for (int32_t k = 0; k < a->nodes.count; k++) {
        VN_TRY(show_node(a, network, a->nodes.data[k].value, seen));
        if (k % 4096 == 4095) {
            VN_TRY(vn_poll());
        }
    }
    return VN_OK;
}

typedef struct look_around {
    vn_attractors *a;
    const vn_network *network;
    const vn_point_grid *grid;
    int32_t first;
    vn_nearest *found;
} look_around;

static void look_range(int64_t begin, int64_t end, void *payload) {
    const look_around *job = payload;
    vn_points nodes = vn_network_points(job->network);
    vn_points points = vn_attractors_points(job->a);
    for (int64_t k = begin; k < end; k++) {
        int32_t i = job->first + (int32_t)k;
        double p[3];
        vn_points_get(&points, i, p);
        job->found[k] =
            (vn_nearest){.reach2 = job->a->reach2, .seed = job->a->seed, .id = job->a->id.data[i]};
        vn_point_grid_nearest(job->grid, &nodes, p, &job->found[k]);
    }
}

enum { LOOK_AT_ONCE = 1 << 15 };

// Newcomers look for their nearest node in the network's grid.
static vn_status look_for_nodes(vn_attractors *a, vn_network *network, int32_t begin) {
    const vn_point_grid *grid;
    VN_ARRAY(vn_nearest) found = {0};
    VN_TRY(vn_network_grid(network, vn_attractors_reach(a), &grid));
    vn_status status = VN_OK;
    for (int32_t first = begin; status == VN_OK && first < a->x.count; first += LOOK_AT_ONCE) {
        int32_t count = a->x.count - first < LOOK_AT_ONCE ? a->x.count - first : LOOK_AT_ONCE;
        status = vn_array_reserve(&found, count);
        if (status == VN_OK) {
            look_around job = {a, network, grid, first, found.data};
            vn_parallel_for(count, 256, look_range, &job);
        }
        for (int32_t k = 0; status == VN_OK && k < count; k++) {
            if (!vn_is_gone(a, first + k) && found.data[k].point >= 0) {
                status = show(a, network, first + k, found.data[k].point, found.data[k].reach2);
                bool none = status == VN_OK && a->node.data[first + k] < 0;
                status =
                    none && vn_gaze_is_open(&a->gaze) ? vn_look_for_grower(a, network, first + k) : status;
            }
        }
        status = status == VN_OK ? vn_poll() : status;
    }
    vn_array_free(&found);
    return status;
}

// Newcomers to a closed mode look for all their neighbors.
static vn_status look_for_ties(vn_attractors *a, vn_network *network, int32_t begin) {
    for (int32_t i = begin; i < a->x.count; i++) {
        if (!vn_is_gone(a, i)) {
            VN_TRY(vn_ties_look(a, network, i));
        }
        if (i % 4096 == 4095) {
            VN_TRY(vn_poll());
        }
    }
    return VN_OK;
}

static vn_status show_ties(vn_attractors *a, vn_network *network, int32_t begin, int32_t seen) {
    if (a->mode == VN_RELATIVE) {
        const vn_point_tree *tree;
        VN_TRY(vn_network_tree_of_points(network, &tree));
    }
    a->news.count = 0;
    VN_TRY(show_nodes(a, network, begin, seen));
    VN_TRY(vn_ties_show(a, network));
    return vn_ties_renew(a, network);
}

enum { FEW_NODES = 64 };

vn_status vn_attractors_sync(vn_attractors *a, vn_network *network, int mode, double reach) {
    double reach2 = reach * reach;
    if (a->dim != network->dim) {
        return vn_fail(VN_INVALID, "attractors of %d dimensions cannot influence a network of %d", a->dim,
                       network->dim);
    }
    bool same = a->network_serial == network->serial && a->network_moved == network->moved;
    if (!same || reach2 > a->reach2 || mode != a->mode) {
        forget(a, network, mode, reach2);
    }
    if (mode != VN_NEAREST) {
        VN_TRY(vn_ties_prepare(a));
        if (!vn_ties_have_room(a, network, a->nodes_seen)) {
            a->has_room = false; // somebody put nodes where no vein would grow
            forget(a, network, mode, reach2);
        }
    }
    int32_t known = a->attractors_seen;
    for (int32_t i = known; i < a->x.count; i++) {
        a->near2.data[i] = vn_is_gone(a, i) ? -1 : a->reach2;
    }
    int32_t newcomers = a->x.count - known;
    if (network->x.count <= FEW_NODES && a->nodes_seen == 0) {
        known = a->x.count; // as quick as a look around from each, and needs no grid
        newcomers = 0;
    }
    // Half a sync that memory or time cut short would leave nodes unseen: then the next one starts over.
    a->network_serial = 0;
    if (newcomers > 0) {
        VN_TRY(mode == VN_NEAREST ? look_for_nodes(a, network, known) : look_for_ties(a, network, known));
    }
    VN_TRY(mode == VN_NEAREST ? show_nodes(a, network, a->nodes_seen, known)
                              : show_ties(a, network, a->nodes_seen, known));
    a->network_serial = network->serial;
    a->nodes_seen = network->x.count;
    a->attractors_seen = a->x.count;
    return VN_OK;
}
