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

vn_status vn_growth_check_dim(const vn_growth *growth, const char *what, int dim) {
    if (dim != growth->base.dim) {
        return vn_fail(VN_INVALID, "growth:advance: %s of %d dimensions in a %s blade whose tissue moves",
                       what, dim, growth->base.dim == 2 ? "flat" : "solid");
    }
    return VN_OK;
}

typedef struct moving {
    const vn_growth *growth;
    double *const *columns;
    double *moved; ///< the coordinates of each point
    atomic_bool lost;
} moving;

static void move_range(int64_t begin, int64_t end, void *payload) {
    moving *m = payload;
    int dim = m->growth->base.dim;
    for (int64_t i = begin; i < end; i++) {
        double p[3] = {0}, q[3] = {0};
        for (int k = 0; k < dim; k++) {
            p[k] = m->columns[k][i];
        }
        bool found = m->growth->kind->move(m->growth, p, q);
        for (int k = 0; k < dim; k++) {
            found = found && fabs(q[k]) <= VN_HUGE;
            m->moved[dim * i + k] = q[k];
        }
        if (!found) {
            atomic_store_explicit(&m->lost, true, memory_order_relaxed);
        }
    }
}

static void store_moved(const moving *m, int32_t count) {
    int dim = m->growth->base.dim;
    for (int k = 0; k < dim; k++) {
        for (int64_t i = 0; i < count; i++) {
            m->columns[k][i] = m->moved[dim * i + k];
        }
    }
}

vn_status vn_growth_move_points(vn_growth *growth, double *const columns[3], int32_t count) {
    VN_TRY(growth->kind->prepare(growth, growth->time - 1, growth->time));
    size_t size = (size_t)growth->base.dim * (size_t)count * sizeof(double);
    moving m = {.growth = growth, .columns = columns, .moved = vn_resize(NULL, 0, size)};
    if (m.moved == NULL && count > 0) {
        return vn_fail_memory("points that move", size);
    }
    vn_parallel_for(count, 256, move_range, &m);
    if (!m.lost) {
        store_moved(&m, count);
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

static double *coordinates(vn_network *network, int k) {
    return k == 0 ? network->x.data : k == 1 ? network->y.data : network->z.data;
}

static vn_status move_nodes(vn_growth *growth, vn_network *network) {
    double *columns[3] = {coordinates(network, 0), coordinates(network, 1), coordinates(network, 2)};
    VN_TRY(vn_growth_move_points(growth, columns, network->x.count));
    network->moved++;
    network->version++;
    return VN_OK;
}

// The room for the parts is known only when the nodes are where they go: without it they come back.
static vn_status move_and_split(vn_growth *growth, vn_network *network) {
    double bound = growth->split * growth->unit;
    size_t size = (size_t)network->x.count * sizeof(double), whole = (size_t)network->dim * size;
    double *old = vn_growth_moves(growth) && size > 0 ? vn_resize(NULL, 0, whole) : NULL;
    vn_status status = VN_OK;
    if (vn_growth_moves(growth) && size > 0) {
        if (old == NULL) {
            return vn_fail_memory("a network's nodes", whole);
        }
        for (int k = 0; k < network->dim; k++) {
            memcpy(old + (int64_t)k * network->x.count, coordinates(network, k), size);
        }
        status = move_nodes(growth, network);
    }
    status = status == VN_OK && bound > 0 ? make_room(network, bound) : status;
    for (int k = 0; k < network->dim && status != VN_OK && old != NULL; k++) {
        memcpy(coordinates(network, k), old + (int64_t)k * network->x.count, size);
    }
    vn_resize(old, old != NULL ? whole : 0, 0);
    return status == VN_OK && bound > 0 ? split_edges(network, bound) : status;
}

vn_status vn_growth_carry(vn_growth *growth, vn_network *network) {
    bool first;
    VN_TRY(vn_growth_moves(growth) ? vn_growth_check_dim(growth, "a network", network->dim) : VN_OK);
    VN_TRY(vn_growth_note_carried(growth, network->serial, &first));
    if (!first) {
        return VN_OK;
    }
    vn_status status = move_and_split(growth, network);
    growth->carried.count -= status != VN_OK;
    return status;
}
