// Where vessels are: nearest ones to a point, and those that may touch a segment.
#include "cco/cco.h"

#include "space/points.h"

static const double *upper_end(const vn_grower *g, int32_t node) {
    const vn_vessel *v = vn_vessel_of(g, node);
    return v->parent >= 0 ? vn_vessel_of(g, v->parent)->p : v->p;
}

static vn_status list(vn_grower *g, vn_tube_grid *grid, int32_t node) {
    return vn_tube_grid_insert(grid, node, upper_end(g, node), vn_vessel_of(g, node)->p);
}

static bool is_thick(const vn_grower *g, int32_t node) {
    return vn_vessel_of(g, node)->cap > (float)g->thin;
}

vn_status vn_places_insert(vn_grower *g, int32_t node) {
    VN_TRY(list(g, &g->grid, node));
    g->thickest = fmax(g->thickest, vn_vessel_of(g, node)->cap);
    return is_thick(g, node) ? list(g, &g->thick_grid, node) : VN_OK;
}

void vn_places_remove(vn_grower *g, int32_t node) {
    const double *p = vn_vessel_of(g, node)->p;
    vn_tube_grid_remove(&g->grid, node, upper_end(g, node), p);
    if (is_thick(g, node)) {
        vn_tube_grid_remove(&g->thick_grid, node, upper_end(g, node), p);
    }
}

vn_status vn_places_set_cap(vn_grower *g, int32_t node, double cap) {
    vn_vessel *v = vn_vessel_of(g, node);
    bool was_thick = is_thick(g, node);
    v->cap = vn_cap_below(cap);
    g->thickest = fmax(g->thickest, v->cap);
    if (was_thick && !is_thick(g, node)) {
        vn_tube_grid_remove(&g->thick_grid, node, upper_end(g, node), v->p);
    }
    return !was_thick && is_thick(g, node) ? list(g, &g->thick_grid, node) : VN_OK;
}

// Thin vessels are found by a wide look into small cells; the few that are thicker than half of one would
// make every look wide, so they are listed once more, in cells as large as they are.
static vn_status list_thick(const vn_cco *cco, vn_grower *g) {
    int32_t count = 0;
    g->thickest = 0;
    for (int32_t i = 0; i < g->tree.vessels.count; i++) {
        count += is_thick(g, i);
        g->thickest = fmax(g->thickest, vn_vessel_of(g, i)->cap);
    }
    double span = 1, cell = fmax(g->thickest, g->thin);
    for (int k = 0; k < cco->dim; k++) {
        span *= (cco->high[k] - cco->low[k]) / cell + 1;
    }
    int32_t cells = (int32_t)fmin(span, 8.0 * count + 64);
    VN_TRY(vn_tube_grid_init(&g->thick_grid, cco->dim, cco->low, cco->high, cells));
    for (int32_t i = 0; i < g->tree.vessels.count; i++) {
        VN_TRY(is_thick(g, i) ? list(g, &g->thick_grid, i) : VN_OK);
    }
    return VN_OK;
}

vn_status vn_places_update(const vn_cco *cco, vn_grower *g) {
    int32_t count = g->tree.vessels.count;
    if (g->grid_count > 0 && count <= 2 * (int64_t)g->grid_count) {
        return VN_OK;
    }
    VN_TRY(vn_tube_grid_init(&g->grid, cco->dim, cco->low, cco->high,
                             count < INT32_MAX / 2 ? 2 * count : count));
    g->thin = g->grid.cell / 2;
    g->grid_count = count;
    for (int32_t i = 0; i < count; i++) {
        VN_TRY(list(g, &g->grid, i));
    }
    return list_thick(cco, g);
}

double vn_places_distance_to(const vn_grower *g, const double p[3], int32_t node, bool terminals) {
    const vn_vessel *v = vn_vessel_of(g, node);
    return terminals ? sqrt(vn_distance2(p, v->p))
                     : sqrt(vn_point_segment_distance2(p, upper_end(g, node), v->p));
}

/// The nearest axis, terminal or segment so far; or whether the point is in a vessel.
typedef struct look {
    const vn_grower *g;
    const double *p;
    vn_seek seek;
    double inflate, distance2;
    int32_t node; ///< the lower of equals
} look;

static bool look_at(int32_t node, void *payload) {
    look *l = payload;
    const vn_vessel *v = vn_vessel_of(l->g, node);
    if ((l->seek == VN_SEEK_TERMINAL && v->first_child >= 0) || (l->seek != VN_SEEK_AXIS && v->parent < 0)) {
        return true;
    }
    double distance2 = l->seek == VN_SEEK_TERMINAL
                           ? vn_distance2(l->p, v->p)
                           : vn_point_segment_distance2(l->p, upper_end(l->g, node), v->p);
    if (distance2 < l->distance2 || (distance2 == l->distance2 && node < l->node)) {
        l->distance2 = distance2;
        l->node = node;
    }
    return true;
}

double vn_places_seek(const vn_grower *g, const double p[3], vn_seek seek, int32_t *node) {
    look l = {.g = g, .p = p, .seek = seek, .distance2 = INFINITY, .node = -1};
    double reach = 0;
    for (int32_t ring = 0; reach * reach < l.distance2 && reach < INFINITY; ring++) {
        reach = vn_tube_grid_visit_ring(&g->grid, p, ring, look_at, &l);
    }
    *node = l.node;
    return sqrt(l.distance2);
}

static bool look_inside(int32_t node, void *payload) {
    look *l = payload;
    const vn_vessel *v = vn_vessel_of(l->g, node);
    if (v->parent < 0) {
        return true;
    }
    double axis2 = vn_point_segment_distance2(l->p, upper_end(l->g, node), v->p), cap = v->cap;
    if (axis2 > cap * cap) {
        return true;
    }
    double radius = l->g->fixed ? cap : l->inflate * vn_tree_radius(&l->g->tree, node);
    return axis2 > radius * radius;
}

bool vn_places_inside(const vn_grower *g, const double p[3], double inflate) {
    look l = {.g = g, .p = p, .inflate = inflate};
    return !vn_places_visit(g, p, p, 0, look_inside, &l);
}

/// The nearest segments so far, in order: they are few.
typedef struct nearest {
    vn_grower *g;
    const double *p;
    int32_t most;
} nearest;

static bool is_nearer(const vn_near *a, const vn_near *b) {
    return a->distance2 < b->distance2 || (a->distance2 == b->distance2 && a->node < b->node);
}

// How many are nearer.
static int32_t rank_of(const vn_grower *g, const vn_near *near) {
    int32_t low = 0, high = g->nearest.count;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (is_nearer(&g->nearest.data[middle], near)) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

static bool consider(int32_t node, void *payload) {
    nearest *n = payload;
    vn_grower *g = n->g;
    const vn_vessel *v = vn_vessel_of(g, node);
    vn_near near = {node, 0};
    if (v->parent < 0) {
        return true;
    }
    near.distance2 = vn_point_segment_distance2(n->p, upper_end(g, node), v->p);
    int32_t at = rank_of(g, &near), count = g->nearest.count;
    if (at == n->most || (at < count && g->nearest.data[at].node == node)) {
        return true;
    }
    count -= count == n->most;
    memmove(&g->nearest.data[at + 1], &g->nearest.data[at], (size_t)(count - at) * sizeof near);
    g->nearest.data[at] = near;
    g->nearest.count = count + 1;
    return true;
}

vn_status vn_places_nearest(vn_grower *g, const double p[3], int32_t count) {
    nearest n = {g, p, count};
    double reach = 0;
    g->nearest.count = 0;
    VN_TRY(vn_array_reserve(&g->nearest, count));
    for (int32_t ring = 0; reach < INFINITY; ring++) {
        if (g->nearest.count == count && g->nearest.data[count - 1].distance2 <= reach * reach) {
            break;
        }
        reach = vn_tube_grid_visit_ring(&g->grid, p, ring, consider, &n);
    }
    return VN_OK;
}

bool vn_places_visit(const vn_grower *g, const double a[3], const double b[3], double reach,
                     vn_tube_visit_fn *visit, void *payload) {
    double low[2][3], high[2][3];
    for (int k = 0; k < 3; k++) {
        for (int thick = 0; thick < 2; thick++) {
            double wide =
                reach + 1.000001 * (thick ? g->thickest : fmin(g->thin, g->thickest)); // caps are floats
            low[thick][k] = fmin(a[k], b[k]) - wide;
            high[thick][k] = fmax(a[k], b[k]) + wide;
        }
    }
    return vn_tube_grid_visit(&g->grid, low[0], high[0], visit, payload) &&
           (g->thickest <= g->thin || vn_tube_grid_visit(&g->thick_grid, low[1], high[1], visit, payload));
}
