// Polylines, and how single lines become some.
#include "network/paths.h"

#include "network/network.h"

#include <math.h>

vn_status vn_paths_create(vn_paths **out, int dim) {
    *out = NULL;
    if (dim != 2 && dim != 3) {
        return vn_fail(VN_INVALID, "paths.dim = %d must be 2 or 3", dim);
    }
    vn_paths *paths = vn_resize(NULL, 0, sizeof *paths);
    if (paths == NULL) {
        return vn_fail_memory("paths", sizeof *paths);
    }
    *paths = (vn_paths){.dim = dim};
    *out = paths;
    return VN_OK;
}

void vn_paths_destroy(vn_paths *paths) {
    if (paths != NULL) {
        vn_array_free(&paths->xyz);
        vn_array_free(&paths->ends);
        vn_resize(paths, sizeof *paths, 0);
    }
}

vn_status vn_paths_point(vn_paths *paths, const double p[3]) {
    if (!isfinite(p[0]) || !isfinite(p[1]) || !isfinite(p[2])) {
        return vn_fail(VN_INVALID, "paths: point %d of path %d is not finite: (%g, %g, %g)",
                       paths->xyz.count / 3 - vn_paths_open(paths) + 1, paths->ends.count + 1, p[0], p[1],
                       p[2]);
    }
    VN_TRY(vn_array_reserve(&paths->xyz, (int64_t)paths->xyz.count + 3));
    for (int k = 0; k < 3; k++) {
        paths->xyz.data[paths->xyz.count++] = k < paths->dim ? p[k] : 0;
    }
    return VN_OK;
}

vn_status vn_paths_end(vn_paths *paths) {
    int32_t points = paths->xyz.count / 3;
    return points > vn_paths_open(paths) ? vn_array_push(&paths->ends, points) : VN_OK;
}

vn_status vn_paths_draw(vn_paths *paths, const double p[3]) {
    int32_t points = paths->xyz.count / 3;
    const double *last = paths->xyz.data + 3 * (size_t)(points > 0 ? points - 1 : 0);
    bool here = points > vn_paths_open(paths) && last[0] == p[0] && last[1] == p[1] && last[2] == p[2];
    return here ? VN_OK : vn_paths_point(paths, p);
}

vn_status vn_paths_lift(vn_paths *paths) {
    int32_t open = vn_paths_open(paths);
    if (paths->xyz.count / 3 - open < 2) {
        paths->xyz.count = 3 * open;
    }
    return vn_paths_end(paths);
}

int vn_paths_dim(const vn_paths *paths) {
    return paths->dim;
}

int32_t vn_paths_count(const vn_paths *paths) {
    return paths->ends.count;
}

int32_t vn_paths_size(const vn_paths *paths, int32_t path) {
    return paths->ends.data[path] - (path > 0 ? paths->ends.data[path - 1] : 0);
}

void vn_paths_position(const vn_paths *paths, int32_t path, int32_t point, double p[3]) {
    int32_t begin = path > 0 ? paths->ends.data[path - 1] : 0;
    memcpy(p, paths->xyz.data + 3 * ((size_t)begin + (size_t)point), 3 * sizeof *p);
}

const char *vn_paths_unit(const vn_paths *paths) {
    return paths->unit;
}

void vn_wires_free(vn_wires *wires) {
    vn_array_free(&wires->xyz);
    vn_array_free(&wires->from);
    vn_array_free(&wires->to);
}

/// Wires as they hang together: those at vertex v are hanging[first[v] .. first[v + 1]).
typedef struct tangle {
    const vn_wires *wires;
    int32_t vertices;
    VN_ARRAY(int32_t) first;
    VN_ARRAY(int32_t) untried; ///< of each vertex, the first of its wires that may still be free
    VN_ARRAY(int32_t) hanging;
    VN_ARRAY(bool) led_to;   ///< whether some wire ends at the vertex
    VN_ARRAY(bool) taken;    ///< of each wire
    VN_ARRAY(int32_t) queue; ///< vertices that chains have come to
} tangle;

static void free_tangle(tangle *t) {
    vn_array_free(&t->first);
    vn_array_free(&t->untried);
    vn_array_free(&t->hanging);
    vn_array_free(&t->led_to);
    vn_array_free(&t->taken);
    vn_array_free(&t->queue);
}

static int32_t degree(const tangle *t, int32_t v) {
    return t->first.data[v + 1] - t->first.data[v];
}

// By counting; the wires of a vertex stay in their order.
static vn_status hang_wires(tangle *t) {
    const vn_wires *w = t->wires;
    VN_TRY(vn_array_zero(&t->first, (int64_t)t->vertices + 2));
    VN_TRY(vn_array_zero(&t->hanging, 2 * (int64_t)w->from.count));
    VN_TRY(vn_array_zero(&t->led_to, t->vertices));
    VN_TRY(vn_array_zero(&t->taken, w->from.count));
    int32_t *at = t->first.data + 1; // moved by one while they are filled
    for (int32_t i = 0; i < w->from.count; i++) {
        at[w->from.data[i] + 1]++;
        at[w->to.data[i] + 1]++;
        t->led_to.data[w->to.data[i]] = true;
    }
    for (int32_t v = 0; v < t->vertices; v++) {
        at[v + 1] += at[v];
    }
    for (int32_t i = 0; i < w->from.count; i++) {
        t->hanging.data[at[w->from.data[i]]++] = i;
        t->hanging.data[at[w->to.data[i]]++] = i;
    }
    VN_TRY(vn_array_reserve(&t->untried, t->vertices));
    memcpy(t->untried.data, t->first.data, (size_t)t->vertices * sizeof *t->first.data);
    return VN_OK;
}

// However often a vertex is asked, each of its wires is looked at once.
static int32_t free_wire(tangle *t, int32_t v) {
    int32_t *k = &t->untried.data[v];
    while (*k < t->first.data[v + 1] && t->taken.data[t->hanging.data[*k]]) {
        ++*k;
    }
    return *k < t->first.data[v + 1] ? t->hanging.data[*k] : -1;
}

// One chain from vertex @p v along @p wire, as far as there is no choice.
static vn_status follow_chain(tangle *t, vn_paths *paths, int32_t v, int32_t wire) {
    const vn_wires *w = t->wires;
    VN_TRY(vn_paths_draw(paths, w->xyz.data + 3 * (size_t)v));
    while (wire >= 0) {
        t->taken.data[wire] = true;
        v = w->from.data[wire] == v ? w->to.data[wire] : w->from.data[wire];
        VN_TRY(vn_paths_draw(paths, w->xyz.data + 3 * (size_t)v));
        wire = degree(t, v) == 2 ? free_wire(t, v) : -1;
    }
    VN_TRY(vn_array_push(&t->queue, v));
    return vn_paths_lift(paths);
}

// All that hangs together with vertex @p v.
static vn_status follow_all(tangle *t, vn_paths *paths, int32_t v) {
    t->queue.count = 0;
    VN_TRY(vn_array_push(&t->queue, v));
    for (int32_t i = 0; i < t->queue.count; i++) {
        int32_t from = t->queue.data[i];
        for (int32_t wire = free_wire(t, from); wire >= 0; wire = free_wire(t, from)) {
            VN_TRY(follow_chain(t, paths, from, wire));
        }
        VN_TRY(i % 4096 == 4095 ? vn_poll() : VN_OK);
    }
    return VN_OK;
}

static int rank_of(const tangle *t, int32_t v) {
    if (!t->led_to.data[v]) {
        return degree(t, v) == 1 ? 0 : 1;
    }
    return degree(t, v) == 1 ? 2 : 3;
}

vn_status vn_paths_from_wires(vn_paths *paths, const vn_wires *wires) {
    tangle t = {.wires = wires, .vertices = wires->xyz.count / 3};
    vn_status status = t.vertices > 0 ? hang_wires(&t) : VN_OK;
    for (int rank = 0; rank <= 3; rank++) {
        for (int32_t v = 0; v < t.vertices && status == VN_OK; v++) {
            if (rank_of(&t, v) == rank && free_wire(&t, v) >= 0) {
                status = follow_all(&t, paths, v);
            }
        }
    }
    free_tangle(&t);
    return status;
}

static vn_status wire_network(vn_wires *wires, const vn_network *network) {
    const int32_t *order;
    VN_TRY(vn_network_order(network, &order));
    for (int32_t i = 0; i < network->x.count; i++) {
        double p[3];
        vn_network_position(network, i, p);
        for (int k = 0; k < 3; k++) {
            VN_TRY(vn_array_push(&wires->xyz, p[k]));
        }
        int32_t node = order != NULL ? order[i] : i;
        int32_t parent = network->parent.data[node];
        VN_TRY(parent >= 0 ? vn_array_push(&wires->from, parent) : VN_OK);
        VN_TRY(parent >= 0 ? vn_array_push(&wires->to, node) : VN_OK);
    }
    return VN_OK;
}

static vn_status chain_network(vn_paths *paths, const vn_network *network) {
    vn_wires wires = {0};
    vn_status status = wire_network(&wires, network);
    status = status == VN_OK ? vn_paths_from_wires(paths, &wires) : status;
    vn_wires_free(&wires);
    return status;
}

vn_status vn_paths_of_network(vn_paths **out, const vn_network *network) {
    VN_TRY(vn_paths_create(out, vn_network_dim(network)));
    strncpy((*out)->unit, vn_network_unit(network), sizeof(*out)->unit - 1);
    vn_status status = chain_network(*out, network);
    if (status != VN_OK) {
        vn_paths_destroy(*out);
        *out = NULL;
    }
    return status;
}
