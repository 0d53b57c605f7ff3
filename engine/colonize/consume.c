#include "colonize/attractors.h"

static const vn_consume_def consume_default = {.distance = 1};

static const vn_field consume_fields[] = {
    {"distance", VN_F64, VN_REQUIRED | VN_ABOVE_MIN, offsetof(vn_consume_def, distance), 0, VN_HUGE, "length",
     NULL, "kill distance: an attractor that a node is closer to is consumed"},
    {"mode", VN_CHOICE, 0, offsetof(vn_consume_def, mode), 0, 0, "", "any|all|tagged",
     "which nodes must be that close: any one (open venation, Runions §3.3), all that it influences (Webb), "
     "or "
     "all whose veins it influenced when the first one came (closed venation, §4)"},
    {"into", VN_OBJECT, 0, offsetof(vn_consume_def, into), 0, 0, "", "attractors",
     "a set that the consumed ones are added to"},
};
const vn_schema vn_consume_schema =
    VN_SCHEMA("consume", "Remove the attractors that were reached", consume_fields, consume_default);

vn_consume_def vn_consume_def_default(void) {
    return consume_default;
}

vn_status vn_consume_one(vn_attractors *a, int32_t i, vn_attractors *into, int32_t *consumed) {
    double p[3];
    vn_attractors_place(a, i, p);
    if (into != NULL) {
        VN_TRY(vn_attractors_add(into, p));
    }
    vn_attractors_remove(a, i);
    ++*consumed;
    return VN_OK;
}

// A hidden attractor remembers the nearest node that sees it, a perceived one the nearest that can grow; any
// node may consume it.
static bool is_reached(const vn_attractors *a, const vn_network *network, int32_t i, double distance) {
    bool nearest = a->mode == VN_NEAREST && !vn_gaze_is_open(&a->gaze);
    if (nearest && !(a->idle.data[i] & VN_HIDDEN)) {
        return a->node.data[i] >= 0 && a->near2.data[i] < distance * distance;
    }
    double p[3];
    vn_points nodes = vn_network_points(network);
    vn_attractors_place(a, i, p);
    return vn_point_grid_any_within(&network->grid, &nodes, p, distance, NULL, NULL) >= 0;
}

static vn_status consume_all(vn_attractors *a, vn_network *network, const vn_consume_def *def,
                             int32_t *consumed) {
    const vn_point_grid *grid;
    VN_TRY(vn_network_grid(network, 0, &grid));
    for (int32_t i = 0; i < a->x.count; i++) {
        if (!vn_is_gone(a, i) && is_reached(a, network, i, def->distance)) {
            VN_TRY(vn_consume_one(a, i, def->into, consumed));
        }
    }
    return VN_OK;
}

static vn_status consume_fresh(vn_attractors *a, const vn_consume_def *def, int32_t *consumed) {
    double distance2 = def->distance * def->distance;
    for (int32_t k = 0; k < a->fresh.count; k++) {
        const vn_reach_hit *hit = &a->fresh.data[k];
        if (hit->distance2 < distance2 && !vn_is_gone(a, hit->point)) {
            VN_TRY(vn_consume_one(a, hit->point, def->into, consumed));
        }
    }
    return VN_OK;
}

// Attractors that wait are shown only nodes that would consume them.
static void watch_waiting(vn_attractors *a, double distance2) {
    for (int32_t k = 0; k < a->waiting.count; k++) {
        int32_t i = a->waiting.data[k];
        if (!vn_is_gone(a, i) && a->node.data[i] < 0) {
            double p[3];
            vn_attractors_place(a, i, p);
            a->near2.data[i] = distance2;
            vn_reach_tree_raise(&a->tree, p, distance2);
        }
    }
}

// What waited for its veins in another mode is consumed by any of them, or free again.
static void forget_touched(vn_attractors *a) {
    for (int32_t k = 0; k < a->touched.count; k++) {
        a->stage.data[a->touched.data[k]] &= (uint8_t)~VN_TOUCHED;
    }
    a->fresh_all = a->fresh_all || a->touched.count > 0;
    a->touched.count = 0;
    a->tagging = false;
}

// Where an attractor draws one node alone, all of its nodes are any of them.
static vn_status consume_by_mode(vn_attractors *a, vn_network *network, const vn_consume_def *def,
                                 int32_t *consumed) {
    if (a->mode != VN_NEAREST && def->mode != VN_CONSUME_ANY) {
        return vn_touch(a, network, def, consumed);
    }
    forget_touched(a);
    return vn_attractors_ask_all(a, def->distance) ? consume_all(a, network, def, consumed)
                                                   : consume_fresh(a, def, consumed);
}

vn_status vn_consume(vn_attractors *a, vn_network *network, const vn_consume_def *def, int32_t *consumed) {
    *consumed = 0;
    VN_TRY(vn_check_def(&vn_consume_schema, def));
    if (def->into == a || (def->into != NULL && def->into->dim != a->dim)) {
        return vn_fail(VN_INVALID, "consume.into must be another set of attractors, of %d dimensions",
                       a->dim);
    }
    VN_TRY(vn_attractors_sync(a, network, a->mode, def->distance));
    double distance2 = def->distance * def->distance;
    vn_status status = consume_by_mode(a, network, def, consumed);
    if (status != VN_OK) {
        *consumed = 0;
        return status;
    }
    a->fresh.count = 0;
    a->fresh_all = false;
    if (a->consumed2 != distance2) {
        watch_waiting(a, distance2);
    }
    a->consumed2 = distance2;
    return VN_OK;
}
