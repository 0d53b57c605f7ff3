// Attractors of vessels: each looks to the nearest node that can still grow, and draws it if that one
// perceives it (READINGS R16). One that is not perceived sleeps until its node has changed enough for that.

#include "colonize/attractors.h"

double vn_attractors_reach(const vn_attractors *a) {
    return vn_gaze_is_open(&a->gaze) && isfinite(a->reach2) ? sqrt(a->reach2) : 0;
}

typedef struct growers {
    const vn_attractors *a;
    const vn_network *network;
} growers;

static bool accept_grower(int32_t node, void *payload) {
    const growers *g = payload;
    return vn_gaze_may_grow(&g->a->gaze, g->network, node);
}

// However many nearer ones cannot. What the attractor's patience is counted from stays, though the new node
// is farther off: nodes that fill up one after another would renew it for ever.
vn_status vn_look_for_grower(vn_attractors *a, vn_network *network, int32_t i) {
    const vn_point_grid *grid;
    growers payload = {a, network};
    vn_points nodes = vn_network_points(network);
    double p[3];
    vn_nearest query = {.reach2 = a->reach2,
                        .seed = a->seed,
                        .id = a->id.data[i],
                        .accept = accept_grower,
                        .payload = &payload};
    VN_TRY(vn_network_grid(network, vn_attractors_reach(a), &grid));
    vn_attractors_place(a, i, p);
    vn_point_grid_nearest(grid, &nodes, p, &query);
    if (query.point >= 0 && a->node.data[i] < 0) {
        VN_TRY(vn_array_push(&a->activated, ((vn_keyed){(uint64_t)i, i})));
    }
    a->node.data[i] = query.point;
    a->near2.data[i] = query.point >= 0 ? query.reach2 : a->reach2;
    vn_reach_tree_raise(&a->tree, p, a->near2.data[i]);
    return VN_OK;
}

// As the unit of length shrinks, so does what has to be looked through.
static void narrow(vn_attractors *a, double reach2) {
    for (int32_t i = 0; i < a->x.count; i++) {
        if (a->near2.data[i] > reach2) {
            a->near2.data[i] = reach2;
            a->node.data[i] = -1;
        }
    }
    a->reach2 = reach2;
}

static vn_status make_beds(vn_attractors *a) {
    VN_TRY(vn_array_reserve(&a->sleep, a->x.count));
    for (; a->sleep.count < a->x.count; a->sleep.count++) {
        a->sleep.data[a->sleep.count].node = -1;
    }
    return VN_OK;
}

static bool sleeps_on(const vn_attractors *a, const vn_network *network, int32_t i) {
    const vn_sleep *sleep = &a->sleep.data[i];
    int32_t node = a->node.data[i], child = network->first_child.data[node];
    return sleep->node == node && sleep->child == child &&
           (child < 0 || network->tips.data[child] < sleep->tips);
}

// The number of tips at which an inter-node's zone, that turns outwards with it, comes to @p d; one less, for
// rounding, or none at all.
static int32_t tips_to_wake(const vn_gaze *gaze, const vn_zone *zone, int32_t tips, const double d[3]) {
    vn_zone inner = *zone;
    inner.low_cos = -2;
    if (!vn_zone_holds(&inner, d, 1e-12)) {
        return INT32_MAX; // it has passed
    }
    int32_t low = tips, high = VN_TABLED_TIPS - 1;
    while (low < high) {
        int32_t middle = low + (high - low + 1) / 2;
        vn_zone_turn(&inner, gaze, middle);
        inner.high_cos = 2;
        if (vn_zone_holds(&inner, d, 1e-12)) {
            high = middle - 1;
        } else {
            low = middle;
        }
    }
    return low > tips ? low : tips + 1;
}

static void fall_asleep(vn_attractors *a, const vn_network *network, int32_t i, const vn_zone *zone,
                        const double d[3]) {
    int32_t node = a->node.data[i], child = network->first_child.data[node];
    int32_t tips = child >= 0 ? network->tips.data[child] : 0;
    a->sleep.data[i] = (vn_sleep){node, child, child >= 0 ? tips_to_wake(&a->gaze, zone, tips, d) : 0};
}

// Whether the attractor's node perceives it.
static bool is_perceived(vn_attractors *a, const vn_network *network, int32_t i) {
    vn_zone zone;
    double p[3], d[3];
    vn_zone_find(&zone, &a->gaze, network, a->node.data[i]);
    vn_network_position(network, a->node.data[i], p);
    vn_attractors_place(a, i, d);
    for (int k = 0; k < 3; k++) {
        d[k] -= p[k];
    }
    bool holds = vn_zone_holds(&zone, d, 0);
    if (!holds) {
        fall_asleep(a, network, i, &zone, d);
    }
    return holds;
}

vn_status vn_attractors_turn(vn_attractors *a, vn_network *network, double within,
                             vn_status (*push)(void *payload, int32_t attractor, int32_t node),
                             void *payload) {
    double within2 = within * within;
    if (within2 < 0.5 * a->reach2) {
        narrow(a, within2);
    }
    VN_TRY(make_beds(a));
    for (int32_t k = 0; k < a->active.count; k++) {
        int32_t i = a->active.data[k], node = a->node.data[i];
        if (node < 0 || a->near2.data[i] > within2 || sleeps_on(a, network, i)) {
            continue;
        }
        if (!vn_gaze_may_grow(&a->gaze, network, node)) {
            VN_TRY(vn_look_for_grower(a, network, i));
        }
        if (a->node.data[i] >= 0 && a->near2.data[i] <= within2 && is_perceived(a, network, i)) {
            VN_TRY(push(payload, i, a->node.data[i]));
        }
    }
    return VN_OK;
}
