// What lies in moving tissue moves along, and what growth has stretched is split: laterals could start only
// at rare nodes otherwise.

#include "growth/growth.h"

#include "base/parallel.h"
#include "network/network.h"

#include <stdatomic.h>

vn_status vn_growth_note_carried(vn_growth *growth, uint64_t serial, bool *first) {
    *first = growth->stepped;
    for (int32_t i = 0; i < growth->carried.count && *first; i++) {
        *first = growth->carried.data[i] != serial;
    }
    return *first ? vn_array_push(&growth->carried, serial) : VN_OK;
}

typedef struct moving {
    const vn_growth *growth;
    const double *x, *y;
    double *moved; ///< x, y of each point
    atomic_bool lost;
} moving;

static void move_range(int64_t begin, int64_t end, void *payload) {
    moving *m = payload;
    for (int64_t i = begin; i < end; i++) {
        double p[3] = {m->x[i], m->y[i], 0}, q[3] = {0};
        bool found = m->growth->kind->move(m->growth, p, q);
        if (!found || !(fabs(q[0]) <= VN_HUGE && fabs(q[1]) <= VN_HUGE)) {
            atomic_store_explicit(&m->lost, true, memory_order_relaxed);
        }
        m->moved[2 * i] = q[0];
        m->moved[2 * i + 1] = q[1];
    }
}

vn_status vn_growth_move_points(vn_growth *growth, double *x, double *y, int32_t count) {
    VN_TRY(growth->kind->prepare(growth, growth->time - 1, growth->time));
    size_t size = 2 * (size_t)count * sizeof(double);
    moving m = {.growth = growth, .x = x, .y = y, .moved = vn_resize(NULL, 0, size)};
    if (m.moved == NULL && count > 0) {
        return vn_fail_memory("points that move", size);
    }
    vn_parallel_for(count, 256, move_range, &m);
    for (int32_t i = 0; i < count && !m.lost; i++) {
        x[i] = m.moved[2 * (int64_t)i];
        y[i] = m.moved[2 * (int64_t)i + 1];
    }
    vn_resize(m.moved, m.moved != NULL ? size : 0, 0);
    return m.lost
               ? vn_fail(VN_INFEASIBLE,
                         "growth:advance: %s takes what is far outside the blade out of the range of numbers",
                         growth->kind->name)
               : VN_OK;
}

// ---- Splitting ----

static int32_t parts_of(const vn_network *network, int32_t node, double bound) {
    double p[3], q[3];
    int32_t parent = network->parent.data[node];
    if (parent < 0) {
        return 1;
    }
    vn_network_position(network, node, p);
    vn_network_position(network, parent, q);
    return (int32_t)fmin(fmax(ceil(sqrt(vn_distance2(p, q)) / bound), 1), INT32_MAX);
}

static vn_status make_room(vn_network *network, double bound) {
    int64_t need = network->x.count;
    for (int32_t i = 0; i < network->x.count; i++) {
        need += parts_of(network, i, bound) - 1;
    }
    if (need > network->max_nodes) {
        return vn_fail(
            VN_LIMIT,
            "growth.split = %g makes %lld nodes of %d, more than network.max_nodes = %d (is it about "
            "two vein segments?)",
            bound, (long long)need, network->x.count, network->max_nodes);
    }
    VN_TRY(vn_network_reserve(network, need));
    return need > network->x.count ? vn_array_reserve(&network->sequence, need) : VN_OK;
}

// From the child up: each new node is put above the last one.
static vn_status split_edge(vn_network *network, int32_t child, int32_t parts) {
    double top[3], bottom[3];
    int32_t lower = child;
    vn_network_position(network, child, bottom);
    vn_network_position(network, network->parent.data[child], top);
    for (int32_t k = 1; k < parts; k++) {
        double p[3], s = (double)k / parts;
        for (int c = 0; c < 3; c++) {
            p[c] = bottom[c] + s * (top[c] - bottom[c]);
        }
        VN_TRY(vn_network_split(network, lower, p, &lower));
    }
    return VN_OK;
}

static vn_status split_edges(vn_network *network, double bound) {
    int32_t count = network->x.count;
    for (int32_t i = 0; i < count; i++) {
        int32_t parts = parts_of(network, i, bound);
        if (parts > 1) {
            VN_TRY(split_edge(network, i, parts));
        }
    }
    return VN_OK;
}

static vn_status move_nodes(vn_growth *growth, vn_network *network) {
    VN_TRY(vn_growth_move_points(growth, network->x.data, network->y.data, network->x.count));
    network->moved++;
    network->version++;
    return VN_OK;
}

// The room for the parts is known only when the nodes are where they go: without it they come back.
static vn_status move_and_split(vn_growth *growth, vn_network *network) {
    double bound = growth->split * growth->unit;
    size_t size = (size_t)network->x.count * sizeof(double);
    double *old = vn_growth_moves(growth) && size > 0 ? vn_resize(NULL, 0, 2 * size) : NULL;
    vn_status status = VN_OK;
    if (vn_growth_moves(growth) && size > 0) {
        if (old == NULL) {
            return vn_fail_memory("a network's nodes", 2 * size);
        }
        memcpy(old, network->x.data, size);
        memcpy(old + network->x.count, network->y.data, size);
        status = move_nodes(growth, network);
    }
    status = status == VN_OK && bound > 0 ? make_room(network, bound) : status;
    if (status != VN_OK && old != NULL) {
        memcpy(network->x.data, old, size);
        memcpy(network->y.data, old + network->x.count, size);
    }
    vn_resize(old, old != NULL ? 2 * size : 0, 0);
    return status == VN_OK && bound > 0 ? split_edges(network, bound) : status;
}

vn_status vn_growth_carry(vn_growth *growth, vn_network *network) {
    bool first;
    if (vn_growth_moves(growth) && network->dim != 2) {
        return vn_fail(VN_INVALID,
                       "growth:advance: a network of %d dimensions in a flat blade whose tissue moves",
                       network->dim);
    }
    VN_TRY(vn_growth_note_carried(growth, network->serial, &first));
    if (!first) {
        return VN_OK;
    }
    vn_status status = move_and_split(growth, network);
    growth->carried.count -= status != VN_OK;
    return status;
}
