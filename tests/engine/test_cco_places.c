// Where vessels are, against a look at all of them: the grid of tubes, nearest segments in their order, and
// what may touch; on random segments and on those that lie badly.
#include "cco_support.h"

#include "cco/cco.h"

enum { MOST = 160 };

/// Segments of which some are in the grid.
typedef struct tubes {
    int dim;
    int32_t count;
    double ends[MOST][2][3];
    bool there[MOST], seen[MOST];
} tubes;

// On a lattice as the cells' borders are, long or of no length, across the box or outside it.
static void lay(tubes *t, int32_t i, vn_rng *rng) {
    int kind = (int)whole(rng, 0, 5);
    for (int k = 0; k < 3; k++) {
        double a = uniform(rng, -1, 9), b = uniform(rng, -1, 9);
        if (kind == 0 || kind == 1) { // along cells
            a = (double)whole(rng, 0, 8);
            b = kind == 0 ? a : (double)whole(rng, 0, 8);
        } else if (kind == 2) { // far outside
            a = uniform(rng, -30, 30);
            b = uniform(rng, -30, 30);
        } else if (kind == 3) { // of no length
            b = a;
        } else if (kind == 4) { // short
            b = a + uniform(rng, -0.3, 0.3);
        }
        t->ends[i][0][k] = k < t->dim ? a : 0;
        t->ends[i][1][k] = k < t->dim ? b : 0;
    }
    if (i > 0 && whole(rng, 0, 9) == 0) {
        memcpy(t->ends[i], t->ends[i - 1], sizeof t->ends[i]);
    }
}

static bool see(int32_t tube, void *payload) {
    tubes *t = payload;
    assert_in_range(tube, 0, t->count - 1);
    assert_true(t->there[tube]);
    t->seen[tube] = true;
    return true;
}

static void check_box(const vn_tube_grid *grid, tubes *t, vn_rng *rng) {
    double low[3] = {0}, high[3] = {0};
    for (int k = 0; k < t->dim; k++) {
        low[k] = whole(rng, 0, 1) ? (double)whole(rng, -2, 9) : uniform(rng, -20, 12);
        high[k] = low[k] + (whole(rng, 0, 2) ? uniform(rng, 0, 4) : 0);
    }
    memset(t->seen, 0, sizeof t->seen);
    assert_true(vn_tube_grid_visit(grid, low, high, see, t));
    for (int32_t i = 0; i < t->count; i++) {
        bool in = false;
        for (int s = 0; s <= 64 && t->there[i] && !in; s++) {
            in = true;
            for (int k = 0; k < t->dim; k++) {
                double p = t->ends[i][0][k] + s / 64.0 * (t->ends[i][1][k] - t->ends[i][0][k]);
                in = in && p >= low[k] && p <= high[k];
            }
        }
        assert_true(!in || t->seen[i]);
    }
}

static void check_rings(const vn_tube_grid *grid, tubes *t, vn_rng *rng) {
    double p[3] = {0}, reach = 0;
    for (int k = 0; k < t->dim; k++) {
        p[k] = whole(rng, 0, 1) ? (double)whole(rng, 0, 8) : uniform(rng, -15, 20);
    }
    memset(t->seen, 0, sizeof t->seen);
    for (int32_t ring = 0; reach < INFINITY; ring++) {
        assert_true(ring < 1000);
        reach = vn_tube_grid_visit_ring(grid, p, ring, see, t);
        for (int32_t i = 0; i < t->count; i++) {
            double far = sqrt(vn_point_segment_distance2(p, t->ends[i][0], t->ends[i][1]));
            assert_true(!t->there[i] || t->seen[i] || far >= reach);
        }
    }
}

static void grids(void **state) {
    (void)state;
    for (int i = 0; i < 60; i++) {
        vn_rng rng = vn_rng_make((uint64_t)i);
        tubes t = {.dim = 2 + i % 2, .count = MOST};
        vn_tube_grid grid = {.spare = -1};
        const double low[3] = {0, 0, 0}, high[3] = {8, i % 5 == 0 ? 0 : 8, i % 2 ? 8 : 0};
        const int32_t cells[] = {64, 512, 1, 4000};
        assert_ok(vn_tube_grid_init(&grid, t.dim, low, high, cells[i % 4]));
        for (int step = 0; step < 600; step++) {
            int32_t at = (int32_t)whole(&rng, 0, MOST - 1);
            if (t.there[at]) {
                vn_tube_grid_remove(&grid, at, t.ends[at][0], t.ends[at][1]);
            } else {
                lay(&t, at, &rng);
                assert_ok(vn_tube_grid_insert(&grid, at, t.ends[at][0], t.ends[at][1]));
            }
            t.there[at] = !t.there[at];
            if (step % 10 == 0) {
                check_box(&grid, &t, &rng);
                check_rings(&grid, &t, &rng);
            }
        }
        vn_tube_grid_free(&grid);
    }
}

static bool stop(int32_t tube, void *payload) {
    (void)tube;
    ++*(int *)payload;
    return false;
}

static void visits_can_be_stopped(void **state) {
    (void)state;
    vn_tube_grid grid = {.spare = -1};
    const double low[3] = {0, 0, 0}, high[3] = {8, 8, 0};
    int seen = 0;
    assert_ok(vn_tube_grid_init(&grid, 2, low, high, 64));
    for (int32_t i = 0; i < 5; i++) {
        assert_ok(vn_tube_grid_insert(&grid, i, low, high));
    }
    assert_false(vn_tube_grid_visit(&grid, low, high, stop, &seen));
    assert_int_equal(seen, 1);
    vn_tube_grid_free(&grid);
}

// ---- Vessels of a tree ----

static const double *upper(const vn_grower *g, int32_t node) {
    int32_t parent = vn_vessel_of(g, node)->parent;
    return vn_vessel_of(g, parent >= 0 ? parent : node)->p;
}

// Squared: roots of different squares may be equal.
static double away2(const vn_grower *g, const double p[3], int32_t node, bool ends) {
    return ends ? vn_distance2(p, vn_vessel_of(g, node)->p)
                : vn_point_segment_distance2(p, upper(g, node), vn_vessel_of(g, node)->p);
}

static void random_point(int dim, vn_rng *rng, double p[3]) {
    bool coarse = whole(rng, 0, 2) == 0; // so that distances are often equal
    for (int k = 0; k < 3; k++) {
        double x = coarse ? (double)whole(rng, -4, 4) : uniform(rng, -5, 5);
        p[k] = k < dim ? x : 0;
    }
}

static void grow(vn_cco *cco, vn_grower *g, vn_rng *rng) {
    double p[3];
    int32_t node;
    int32_t parent = (int32_t)whole(rng, 0, g->tree.vessels.count - 1);
    random_point(cco->dim, rng, p);
    if (vn_distance2(p, vn_vessel_of(g, parent)->p) == 0) {
        return;
    }
    assert_ok(vn_places_update(cco, g));
    assert_ok(vn_tree_push(&g->tree, parent, p, &node));
    vn_vessel_of(g, node)->flow = uniform(rng, 0.1, 4);
    vn_tree_update(&g->tree, node);
    vn_vessel_of(g, node)->cap = (float)(whole(rng, 0, 9) ? 0.05 : 1.5);
    assert_ok(vn_places_insert(g, node));
    int32_t other = (int32_t)whole(rng, 1, node);
    assert_ok(vn_places_set_cap(g, other, uniform(rng, 0.01, whole(rng, 0, 9) ? 0.2 : 2)));
}

static void check_seek(const vn_grower *g, const double p[3], vn_seek seek) {
    double least = INFINITY;
    int32_t nearest = -1, node;
    for (int32_t i = 0; i < g->tree.vessels.count; i++) {
        const vn_vessel *v = vn_vessel_of(g, i);
        bool counts =
            seek == VN_SEEK_AXIS || (v->parent >= 0 && (seek == VN_SEEK_SEGMENT || v->first_child < 0));
        double far = counts ? away2(g, p, i, seek == VN_SEEK_TERMINAL) : INFINITY;
        nearest = far < least ? i : nearest;
        least = fmin(least, far);
    }
    double found = vn_places_seek(g, p, seek, &node);
    assert_true(found == sqrt(least));
    assert_int_equal(node, nearest);
    assert_true(node < 0 || vn_places_distance_to(g, p, node, seek == VN_SEEK_TERMINAL) == found);
}

static int by_distance(const void *a, const void *b) {
    const vn_near *c = a, *d = b;
    return c->distance2 != d->distance2 ? (c->distance2 > d->distance2) - (c->distance2 < d->distance2)
                                        : c->node - d->node;
}

static void check_nearest(vn_grower *g, const double p[3], int32_t count) {
    vn_near all[2 * MOST];
    int32_t segments = 0;
    for (int32_t i = 0; i < g->tree.vessels.count; i++) {
        const vn_vessel *v = vn_vessel_of(g, i);
        if (v->parent >= 0) {
            all[segments++] = (vn_near){i, vn_point_segment_distance2(p, upper(g, i), v->p)};
        }
    }
    qsort(all, (size_t)segments, sizeof *all, by_distance);
    assert_ok(vn_places_nearest(g, p, count));
    assert_int_equal(g->nearest.count, count < segments ? count : segments);
    for (int32_t i = 0; i < g->nearest.count; i++) {
        assert_int_equal(g->nearest.data[i].node, all[i].node);
        assert_true(g->nearest.data[i].distance2 == all[i].distance2);
    }
}

static bool note(int32_t node, void *payload) {
    ((bool *)payload)[node] = true;
    return true;
}

static void check_touching(const vn_grower *g, const double a[3], const double b[3], double reach) {
    bool seen[2 * MOST] = {false};
    assert_true(vn_places_visit(g, a, b, reach, note, seen));
    for (int32_t i = 1; i < g->tree.vessels.count; i++) {
        const vn_vessel *v = vn_vessel_of(g, i);
        double far = sqrt(vn_segment_segment_distance2(a, b, upper(g, i), v->p));
        assert_true(seen[i] || far > reach + v->cap);
    }
}

// A radius counts where the cap allows it: caps are never below radii.
static void check_inside(const vn_grower *g, const double p[3]) {
    bool in = false;
    for (int32_t i = 1; i < g->tree.vessels.count; i++) {
        double radius = fmin(1.3 * vn_tree_radius(&g->tree, i), vn_vessel_of(g, i)->cap);
        in = in || away2(g, p, i, false) <= radius * radius;
    }
    assert_int_equal(vn_places_inside(g, p, 1.3), in);
}

static void vessels(void **state) {
    (void)state;
    for (int i = 0; i < 24; i++) {
        vn_rng rng = vn_rng_make(90 + (uint64_t)i);
        int dim = 2 + i % 2;
        vn_cco cco = {.dim = dim, .low = {-4, -4, dim == 3 ? -4 : 0}, .high = {4, 4, dim == 3 ? 4 : 0}};
        vn_grower g = {.tree.factor = 1e-3};
        int32_t root;
        assert_ok(vn_array_push(&g.tree.exponents, ((vn_exponent){1, 3})));
        assert_ok(vn_tree_push(&g.tree, -1, (double[3]){0}, &root));
        assert_ok(vn_places_update(&cco, &g));
        for (int k = 0; k < MOST; k++) {
            double p[3], q[3];
            random_point(dim, &rng, p);
            random_point(dim, &rng, q);
            for (int seek = VN_SEEK_AXIS; seek <= VN_SEEK_TERMINAL; seek++) {
                check_seek(&g, p, (vn_seek)seek);
            }
            check_nearest(&g, p, (int32_t)whole(&rng, 1, 40));
            check_touching(&g, p, q, uniform(&rng, 0, 0.5));
            check_touching(&g, p, p, 0);
            check_inside(&g, p);
            grow(&cco, &g, &rng);
        }
        vn_tree_free(&g.tree);
        vn_tube_grid_free(&g.grid);
        vn_tube_grid_free(&g.thick_grid);
        vn_array_free(&g.nearest);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(grids),
        counted_test(visits_can_be_stopped),
        counted_test(vessels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
