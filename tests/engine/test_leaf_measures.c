// A leaf's measures against graphs whose faces are known: grids, and triangulations that lose edges, where
// the triangles on either side of a lost edge are one face.
#include "support.h"

#include "network/leaf.h"

static const double pi = 3.141592653589793;

// ---- Networks from edges ----

enum { MOST = 2000 };

typedef struct sketch {
    int32_t nodes, edges;
    double x[MOST], y[MOST];
    int32_t a[3 * MOST], b[3 * MOST];
    double radius[3 * MOST];
} sketch;

static sketch *new_sketch(void) {
    sketch *s = calloc(1, sizeof *s);
    assert_non_null(s);
    return s;
}

static int32_t spot(sketch *s, double x, double y) {
    s->x[s->nodes] = x;
    s->y[s->nodes] = y;
    return s->nodes++;
}

static void line(sketch *s, int32_t a, int32_t b, double radius) {
    s->a[s->edges] = a;
    s->b[s->edges] = b;
    s->radius[s->edges++] = radius;
}

// A forest of the edges that reach something new, in their order over and over; the others are joins.
static vn_network *network_of_sketch(const sketch *s) {
    vn_network *network = NULL;
    int32_t *parent = malloc(MOST * sizeof *parent), *by = malloc(MOST * sizeof *by);
    double *radius = calloc(MOST, sizeof *radius);
    bool *seen = calloc(MOST, sizeof *seen), *used = calloc(3 * MOST, sizeof *used);
    assert_non_null(parent);
    assert_non_null(by);
    assert_non_null(radius);
    assert_non_null(seen);
    assert_non_null(used);
    for (int32_t v = 0; v < s->nodes; v++) {
        if (seen[v]) {
            continue;
        }
        parent[v] = -1;
        seen[v] = true;
        for (bool more = true; more;) {
            more = false;
            for (int32_t e = 0; e < s->edges; e++) {
                int32_t from = seen[s->a[e]] ? s->a[e] : s->b[e], to = seen[s->a[e]] ? s->b[e] : s->a[e];
                if (seen[from] && !seen[to]) {
                    parent[to] = from;
                    radius[to] = s->radius[e];
                    seen[to] = used[e] = more = true;
                }
            }
        }
    }
    vn_network_columns columns = {
        .dim = 2, .count = s->nodes, .x = s->x, .y = s->y, .parent = parent, .radius = radius};
    assert_ok(vn_network_from_columns(&network, &columns));
    for (int32_t e = 0; e < s->edges; e++) {
        if (!used[e]) {
            assert_ok(vn_network_join(network, s->a[e], s->b[e], s->radius[e]));
        }
    }
    free(parent);
    free(by);
    free(radius);
    free(seen);
    free(used);
    return network;
}

static vn_leaf_measures measured(const vn_network *network, const vn_domain *domain) {
    vn_leaf_def def = {.domain = domain};
    vn_leaf_measures m;
    assert_ok(vn_network_measure_leaf(network, &def, &m));
    return m;
}

static vn_leaf_measures measure_sketch(sketch *s) {
    vn_network *network = network_of_sketch(s);
    vn_leaf_measures m = measured(network, NULL);
    vn_network_destroy(network);
    free(s);
    return m;
}

static sketch *grid_of(int32_t columns, int32_t rows) {
    sketch *s = new_sketch();
    for (int32_t j = 0; j <= rows; j++) {
        for (int32_t i = 0; i <= columns; i++) {
            int32_t v = spot(s, i, j);
            if (i > 0) {
                line(s, v - 1, v, 1);
            }
            if (j > 0) {
                line(s, v - columns - 1, v, 1);
            }
        }
    }
    return s;
}

// ---- Areoles ----

static void a_grid_has_its_cells(void **state) {
    (void)state;
    vn_leaf_measures m = measure_sketch(grid_of(7, 5));
    assert_int_equal(m.areoles, 35);
    assert_int_equal(m.loops, 35);
    assert_int_equal(m.crossings, 0);
    assert_int_equal(m.tips, 0);
    assert_int_equal(m.degree3, 2 * (6 + 4));
    assert_int_equal(m.degree4, 6 * 4);
    assert_true(m.hull && m.area == 35 && m.length == 7 * 6 + 5 * 8);
    assert_near(m.density, 82 / 35.0, 1e-12);
    for (int32_t i = 0; i < 35; i++) {
        assert_true(m.areole_areas[i] == 1);
        assert_near(m.areole_quotients[i], pi / 4, 1e-12);
    }
    assert_true(m.areole_area.median == 1 && m.areole_area.deviation == 0 && m.areole_area.count == 35);
    vn_leaf_measures_free(&m);
}

static void statistics_of_a_list(void **state) {
    (void)state;
    static const double list[] = {9, 1, 4, 4, 2};
    vn_statistics s;
    assert_ok(vn_statistics_of(&s, list, 5));
    assert_true(s.count == 5 && s.mean == 4 && s.min == 1 && s.lower == 2 && s.median == 4);
    assert_true(s.upper == 4 && s.max == 9);
    assert_near(s.deviation, sqrt(38 / 5.0), 1e-12);
    assert_ok(vn_statistics_of(&s, list, 2));
    assert_true(s.lower == 3 && s.median == 5);
    assert_ok(vn_statistics_of(&s, list, 0));
    assert_true(s.count == 0 && s.mean == 0);
}

enum { SIDE = 14, TRIANGLES = 2 * SIDE * SIDE, OUTSIDE = TRIANGLES };

// Each cell of a bent grid has two triangles; edges are lost with a probability.
typedef struct triangulation {
    sketch *sketch;
    int32_t above[TRIANGLES + 1]; // sets of triangles that no edge parts
    double area[TRIANGLES + 1], around[TRIANGLES + 1];
    int32_t left[3 * MOST], right[3 * MOST]; // of each edge that is there
} triangulation;

static int32_t find(int32_t *above, int32_t i) {
    while (above[i] != i) {
        i = above[i];
    }
    return i;
}

static int32_t triangle_at(int32_t i, int32_t j, int32_t which) {
    bool inside = i >= 0 && j >= 0 && i < SIDE && j < SIDE;
    return inside ? 2 * (j * SIDE + i) + which : OUTSIDE;
}

static void keep_or_lose(triangulation *t, vn_rng *rng, double loss, int32_t a, int32_t b, int32_t left,
                         int32_t right) {
    if (uniform(rng, 0, 1) < loss) {
        int32_t one = find(t->above, left), other = find(t->above, right);
        t->above[one < other ? one : other] = one < other ? other : one; // the outside has the highest number
        return;
    }
    t->left[t->sketch->edges] = left;
    t->right[t->sketch->edges] = right;
    line(t->sketch, a, b, uniform(rng, 1, 2));
}

static double triangle_area(const sketch *s, int32_t a, int32_t b, int32_t c) {
    return 0.5 * fabs((s->x[b] - s->x[a]) * (s->y[c] - s->y[a]) - (s->x[c] - s->x[a]) * (s->y[b] - s->y[a]));
}

static triangulation *triangulate(uint64_t seed, double bend, double loss) {
    triangulation *t = calloc(1, sizeof *t);
    assert_non_null(t);
    sketch *s = t->sketch = new_sketch();
    vn_rng rng = vn_rng_make(seed);
    for (int32_t k = 0; k <= OUTSIDE; k++) {
        t->above[k] = k;
    }
    for (int32_t j = 0; j <= SIDE; j++) {
        for (int32_t i = 0; i <= SIDE; i++) {
            spot(s, i + uniform(&rng, -bend, bend), j + uniform(&rng, -bend, bend));
        }
    }
    for (int32_t j = 0; j <= SIDE; j++) {
        for (int32_t i = 0; i <= SIDE; i++) {
            int32_t v = j * (SIDE + 1) + i, up = v + SIDE + 1;
            if (i < SIDE) {
                keep_or_lose(t, &rng, loss, v, v + 1, triangle_at(i, j, 0), triangle_at(i, j - 1, 1));
            }
            if (j < SIDE) {
                keep_or_lose(t, &rng, loss, v, up, triangle_at(i - 1, j, 0), triangle_at(i, j, 1));
            }
            if (i < SIDE && j < SIDE) { // triangle 0 is below the diagonal
                keep_or_lose(t, &rng, loss, v, up + 1, triangle_at(i, j, 1), triangle_at(i, j, 0));
                t->area[triangle_at(i, j, 0)] = triangle_area(s, v, v + 1, up + 1);
                t->area[triangle_at(i, j, 1)] = triangle_area(s, v, up + 1, up);
            }
        }
    }
    for (int32_t k = 0; k < OUTSIDE; k++) {
        int32_t set = find(t->above, k);
        t->area[set] += set != k ? t->area[k] : 0;
    }
    for (int32_t e = 0; e < s->edges; e++) {
        int32_t left = find(t->above, t->left[e]), right = find(t->above, t->right[e]);
        if (left != right) {
            double length = hypot(s->x[s->a[e]] - s->x[s->b[e]], s->y[s->a[e]] - s->y[s->b[e]]);
            t->around[left] += length;
            t->around[right] += length;
        }
    }
    return t;
}

static int compare(const void *a, const void *b) {
    const double *p = a, *q = b;
    return (*p > *q) - (*p < *q);
}

static int32_t sorted_areoles(const triangulation *t, double *areas, double *quotients) {
    int32_t count = 0;
    for (int32_t k = 0; k < OUTSIDE; k++) {
        if (find((int32_t *)t->above, k) == k) {
            quotients[count] = 4 * pi * t->area[k] / (t->around[k] * t->around[k]);
            areas[count++] = t->area[k];
        }
    }
    qsort(areas, (size_t)count, sizeof *areas, compare);
    qsort(quotients, (size_t)count, sizeof *quotients, compare);
    return count;
}

static int32_t tips_in_areoles(const triangulation *t, const vn_network *network) {
    int32_t ends = 0;
    for (int32_t v = 0; v < t->sketch->nodes; v++) {
        int32_t degree = 0, at = -1;
        for (int32_t e = 0; e < t->sketch->edges; e++) {
            if (t->sketch->a[e] == v || t->sketch->b[e] == v) {
                degree++;
                at = e;
            }
        }
        ends += degree == 1 && vn_network_parent(network)[v] >= 0 &&
                find((int32_t *)t->above, t->left[at]) != OUTSIDE;
    }
    return ends;
}

// With many edges lost, faces hold islands and twigs.
static void faces_are_triangles_united(void **state) {
    (void)state;
    int32_t islands = 0;
    for (uint64_t seed = 0; seed < 60; seed++) {
        double areas[TRIANGLES], quotients[TRIANGLES];
        triangulation *t = triangulate(seed, seed % 3 == 0 ? 0 : 0.2, 0.1 * (double)(seed % 8));
        vn_network *network = network_of_sketch(t->sketch);
        vn_leaf_measures m = measured(network, NULL);
        int32_t count = sorted_areoles(t, areas, quotients);
        assert_int_equal(m.crossings, 0);
        assert_int_equal(m.areoles, count);
        assert_int_equal(m.loops, count);
        qsort(m.areole_areas, (size_t)count, sizeof *areas, compare);
        qsort(m.areole_quotients, (size_t)count, sizeof *areas, compare);
        for (int32_t i = 0; i < count; i++) {
            assert_near(m.areole_areas[i], areas[i], 1e-9);
            assert_near(m.areole_quotients[i], quotients[i], 1e-9);
        }
        assert_int_equal(m.free_ends, tips_in_areoles(t, network));
        islands += m.free_ends;
        vn_leaf_measures_free(&m);
        vn_network_destroy(network);
        free(t->sketch);
        free(t);
    }
    assert_true(islands > 50);
}

// A square in a square in a square, and a twig on its own in the innermost.
static void islands_are_no_part_of_the_areole_round_them(void **state) {
    (void)state;
    sketch *s = new_sketch();
    for (int32_t k = 0; k < 3; k++) {
        double r = 3 - k;
        int32_t first = spot(s, -r, -r);
        spot(s, r, -r);
        spot(s, r, r);
        spot(s, -r, r);
        for (int32_t i = 0; i < 4; i++) {
            line(s, first + i, first + (i + 1) % 4, 1 + k);
        }
    }
    line(s, spot(s, 0, 0), spot(s, 0.5, 0.5), 1);
    vn_leaf_measures m = measure_sketch(s);
    assert_int_equal(m.areoles, 3);
    qsort(m.areole_areas, 3, sizeof(double), compare);
    assert_true(m.areole_areas[0] == 4 && m.areole_areas[1] == 12 && m.areole_areas[2] == 20);
    assert_int_equal(m.tips, 1); // the twig's root is none
    assert_int_equal(m.free_ends, 1);
    assert_int_equal(m.hierarchy.merge_count, 2);
    assert_int_equal(m.area, 36);
    vn_leaf_measures_free(&m);
}

static void a_comb_has_no_loops(void **state) {
    (void)state;
    vn_network *network = network_of(2);
    int32_t back = put_root(network, 0, 0, 0);
    for (int32_t i = 1; i <= 6; i++) {
        back = put_child(network, back, i, 0, 0);
        put_child(network, back, i, 2, 0);
    }
    vn_domain *blade = box_of(-1, -1, 9, 4);
    vn_leaf_measures m = measured(network, blade);
    assert_int_equal(m.areoles, 0);
    assert_int_equal(m.loops, 0);
    assert_int_equal(m.tips, 6);
    assert_int_equal(m.free_ends, 0);
    assert_int_equal(m.degree3, 5); // the last tooth bends off
    assert_true(!m.hull && m.area == 50);
    assert_near(m.density, 18 / 50.0, 1e-12);
    assert_near(m.tip_density, 6 / 50.0, 1e-12);
    assert_int_equal(m.order_count, 2);
    assert_near(m.order_density[0], 7 / 50.0, 1e-12); // of the two last teeth the older continues the back
    assert_near(m.order_density[1], 11 / 50.0, 1e-12);
    assert_null(vn_network_orders(network)); // measuring leaves them as they are
    assert_near(m.angles.daughters, 90, 1e-9);
    vn_leaf_measures_free(&m);
    vn_domain_release(blade);
    vn_network_destroy(network);
}

// ---- What is no drawing in the plane ----

static void crossings_are_counted(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 5; seed++) {
        vn_network *network = random_tree(2, 150, 2, seed);
        const double *x = vn_network_x(network), *y = vn_network_y(network);
        const int32_t *parent = vn_network_parent(network);
        int32_t crossings = 0;
        for (int32_t i = 0; i < 150; i++) {
            for (int32_t j = 0; j < i; j++) {
                int32_t p = parent[i], q = parent[j];
                if (p < 0 || q < 0 || p == q || p == j || q == i) {
                    continue;
                }
                vn_segment s = {x[i], y[i], x[p], y[p]}, t = {x[j], y[j], x[q], y[q]};
                crossings += vn_segments_touch(&s, &t);
            }
        }
        vn_leaf_measures m = measured(network, NULL);
        assert_int_equal(m.crossings, crossings);
        assert_true(crossings > 10);
        vn_leaf_measures_free(&m);
        vn_network_destroy(network);
    }
}

static void odd_networks_are_measured(void **state) {
    (void)state;
    vn_network *network = network_of(2);
    vn_leaf_measures m = measured(network, NULL);
    assert_true(m.area == 0 && m.density == 0 && m.areoles == 0 && m.order_count == 0 && m.hull);
    vn_leaf_measures_free(&m);
    put_root(network, 3, 4, 0);
    m = measured(network, NULL);
    assert_true(m.tips == 0 && m.loops == 0 && m.length == 0);
    vn_leaf_measures_free(&m);
    vn_network_destroy(network);

    sketch *s = new_sketch(); // all on one line, a triangle that is flat
    for (int32_t i = 0; i < 4; i++) {
        spot(s, i, 2 * i);
    }
    line(s, 0, 1, 1);
    line(s, 1, 2, 1);
    line(s, 2, 3, 1);
    m = measure_sketch(s);
    assert_true(m.area == 0 && m.density == 0 && m.crossings == 0 && m.tips == 1);
    vn_leaf_measures_free(&m);

    s = new_sketch(); // edges on each other, and two nodes in one place
    spot(s, 0, 0);
    spot(s, 2, 0);
    spot(s, 1, 0);
    spot(s, 2, 0);
    spot(s, 3, 1);
    line(s, 0, 1, 1);
    line(s, 0, 2, 1);
    line(s, 1, 3, 1);
    line(s, 3, 4, 1);
    m = measure_sketch(s);
    assert_int_equal(m.crossings, 1);
    assert_int_equal(m.tips, 2);
    assert_int_equal(m.areoles, 0);
    vn_leaf_measures_free(&m);
}

static void what_is_no_leaf_is_refused(void **state) {
    (void)state;
    vn_network *solid = random_tree(3, 5, 1, 1), *flat = random_tree(2, 5, 1, 1);
    vn_domain *ball = ball_of(0, 0, 0, 1);
    vn_leaf_def def = vn_leaf_def_default();
    vn_leaf_measures m;
    assert_int_equal(vn_network_measure_leaf(solid, &def, &m), VN_INVALID);
    assert_message("2D");
    def.domain = ball;
    assert_int_equal(vn_network_measure_leaf(flat, &def, &m), VN_INVALID);
    def = (vn_leaf_def){.resolution = 1e-6};
    assert_int_equal(vn_network_measure_leaf(flat, &def, &m), VN_INVALID);
    assert_message("measure.resolution = 1e-06");
    assert_null(m.order_density);
    def.resolution = -1;
    assert_int_equal(vn_network_measure_leaf(flat, &def, &m), VN_INVALID);
    put_child(flat, 0, 1e200, 0, 0);
    def.resolution = 0;
    assert_int_equal(vn_network_measure_leaf(flat, &def, &m), VN_INVALID);
    assert_message("another length unit");
    vn_domain_release(ball);
    vn_network_destroy(solid);
    vn_network_destroy(flat);
}

// ---- The hull ----

static void the_hull_holds_every_node(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 6; seed++) {
        vn_network *network = random_tree(2, 60, 1, seed);
        const double *x = vn_network_x(network), *y = vn_network_y(network);
        double area = 0; // of the sides that leave all nodes to their left
        for (int32_t i = 0; i < 60; i++) {
            for (int32_t j = 0; j < 60; j++) {
                bool side = i != j;
                for (int32_t k = 0; k < 60 && side; k++) {
                    side = k == i || k == j || vn_turn(x[i], y[i], x[j], y[j], x[k], y[k]) > 0;
                }
                area += side ? 0.5 * (x[i] * y[j] - x[j] * y[i]) : 0;
            }
        }
        vn_leaf_measures m = measured(network, NULL);
        assert_near(m.area, area, 1e-9);
        vn_leaf_measures_free(&m);
        vn_network_destroy(network);
    }
}

// ---- The hierarchy of loops ----

// How thick the line at @p i of 8 is: the middle is thickest, then the quarters.
static double rank(int32_t i) {
    return i % 8 == 0 ? 9 : i % 4 == 0 ? 6 : i % 2 == 0 ? 4 : 2;
}

static void halves_of_halves_merge_evenly(void **state) {
    (void)state;
    sketch *s = grid_of(8, 8);
    for (int32_t e = 0; e < s->edges; e++) {
        bool upright = s->x[s->a[e]] == s->x[s->b[e]];
        s->radius[e] = upright ? rank((int32_t)s->x[s->a[e]]) : rank((int32_t)s->y[s->a[e]]) + 1;
    }
    vn_leaf_measures m = measure_sketch(s);
    assert_int_equal(m.hierarchy.merge_count, 63);
    assert_int_equal(m.hierarchy.height, 6);
    assert_int_equal(m.hierarchy.strahler, 7);
    assert_true(m.hierarchy.asymmetry == 0 && m.hierarchy.nesting == 1);
    assert_int_equal(m.hierarchy.merges[62].loops, 64);
    assert_true(m.hierarchy.merges[62].radius == 7 && m.hierarchy.merges[0].radius == 2);
    assert_int_equal(m.hierarchy.merges[0].loops, 2);
    vn_leaf_measures_free(&m);
}

static void loops_in_a_row_merge_one_by_one(void **state) {
    (void)state;
    sketch *s = grid_of(10, 1);
    for (int32_t e = 0; e < s->edges; e++) {
        s->radius[e] = 1 + s->x[s->a[e]];
    }
    vn_leaf_measures m = measure_sketch(s);
    assert_int_equal(m.hierarchy.merge_count, 9);
    assert_int_equal(m.hierarchy.height, 9);
    assert_int_equal(m.hierarchy.strahler, 2);
    double weights = 0, asymmetry = 0, nesting = 0;
    for (int32_t k = 1; k <= 9; k++) { // k loops and one more
        weights += k;
        asymmetry += k > 1 ? k : 0;
        nesting += 1;
    }
    assert_near(m.hierarchy.asymmetry, asymmetry / weights, 1e-12);
    assert_near(m.hierarchy.nesting, nesting / weights, 1e-12);
    vn_leaf_measures_free(&m);
}

// Cutting everything up to a width unites what the edges above it do not part.
static void merges_up_to_a_width_leave_the_faces_of_the_rest(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 8; seed++) {
        triangulation *t = triangulate(seed, 0.2, 0.2);
        vn_network *network = network_of_sketch(t->sketch);
        vn_leaf_measures m = measured(network, NULL);
        for (int eighth = 8; eighth <= 16; eighth++) {
            double width = eighth / 8.0;
            int32_t merged = 0, united = 0, above[TRIANGLES + 1];
            memcpy(above, t->above, sizeof above);
            for (int32_t e = 0; e < t->sketch->edges; e++) {
                int32_t left = find(above, t->left[e]), right = find(above, t->right[e]);
                bool inner = find(t->above, t->left[e]) != OUTSIDE && find(t->above, t->right[e]) != OUTSIDE;
                if (inner && left != right && t->sketch->radius[e] <= width) {
                    above[left] = right;
                    united++;
                }
            }
            for (int32_t i = 0; i < m.hierarchy.merge_count; i++) {
                merged += m.hierarchy.merges[i].radius <= width;
                assert_true(i == 0 || m.hierarchy.merges[i].radius >= m.hierarchy.merges[i - 1].radius);
            }
            assert_int_equal(merged, united);
        }
        vn_leaf_measures_free(&m);
        vn_network_destroy(network);
        free(t->sketch);
        free(t);
    }
}

// ---- Angles and distances ----

static void angles_go_by_how_thin_the_thinnest_is(void **state) {
    (void)state;
    sketch *s = new_sketch();
    int32_t y = spot(s, 0, 0), t = spot(s, 10, 0); // an even Y and a T with a thin foot
    for (int32_t k = 0; k < 3; k++) {
        line(s, y, spot(s, cos(k * 2 * pi / 3), sin(k * 2 * pi / 3)), 1);
    }
    line(s, t, spot(s, 9, 0), 2);
    line(s, t, spot(s, 11, 0), 1.9);
    line(s, t, spot(s, 10, 1), 0.2);
    vn_leaf_measures m = measure_sketch(s);
    assert_int_equal(m.angles.count, 2);
    assert_near(m.angles.daughters, (120 + 90) / 2.0, 1e-9);
    assert_int_equal(m.angles.bins[4].count, 1);
    assert_near(m.angles.bins[4].thick_thin, 120, 1e-9);
    assert_near(m.angles.bins[4].thick_middle, 120, 1e-9);
    assert_int_equal(m.angles.bins[0].count, 1);
    assert_near(m.angles.bins[0].thick_thin, 90, 1e-9);
    assert_near(m.angles.bins[0].thick_middle, 180, 1e-9);
    assert_near(m.angles.bins[0].middle_thin, 90, 1e-9);
    assert_int_equal(m.angles.bins[1].count + m.angles.bins[2].count + m.angles.bins[3].count, 0);
    vn_leaf_measures_free(&m);
}

// Veins one apart from side to side: distances are evenly spread from 0 to a half.
static void distances_between_parallel_veins(void **state) {
    (void)state;
    sketch *s = new_sketch();
    for (int32_t k = 0; k < 10; k++) {
        line(s, spot(s, 0, k + 0.5), spot(s, 10, k + 0.5), 1);
    }
    vn_domain *blade = box_of(0, 0, 10, 10);
    vn_network *network = network_of_sketch(s);
    vn_leaf_measures m = measured(network, blade);
    assert_int_equal(m.distance.points, 40000);
    assert_near(m.distance.resolution, 0.05, 1e-12);
    assert_near(m.distance.mean, 0.25, 1e-9);
    assert_near(m.distance.max, 0.475, 1e-9);
    assert_near(m.distance.mode, 0.4585020216, 1e-9); // the last quarter of the octave up to a half
    vn_leaf_measures_free(&m);
    vn_leaf_def def = {blade, 0.5};
    assert_ok(vn_network_measure_leaf(network, &def, &m));
    assert_int_equal(m.distance.points, 400);
    assert_near(m.distance.mean, 0.25, 1e-12);
    vn_leaf_measures_free(&m);
    vn_network_destroy(network);
    vn_domain_release(blade);
    free(s);
}

// ---- Memory ----

static void no_failed_allocation_loses_memory(void **state) {
    (void)state;
    triangulation *t = triangulate(3, 0.2, 0.5);
    vn_network *network = network_of_sketch(t->sketch);
    vn_leaf_def def = vn_leaf_def_default();
    vn_leaf_measures m;
    vn_status status = VN_NO_MEMORY;
    size_t before = vn_byte_count();
    int64_t n = 0;
    for (; status != VN_OK && n < 1000; n++) {
        vn_fail_allocations_from(n);
        status = vn_network_measure_leaf(network, &def, &m);
        vn_fail_allocations_from(-1);
        assert_true(status == VN_OK || status == VN_NO_MEMORY);
        vn_leaf_measures_free(&m);
        assert_int_equal(vn_byte_count(), before);
    }
    assert_true(n > 20 && n < 1000);
    vn_network_destroy(network);
    free(t->sketch);
    free(t);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(a_grid_has_its_cells),
        counted_test(statistics_of_a_list),
        counted_test(faces_are_triangles_united),
        counted_test(islands_are_no_part_of_the_areole_round_them),
        counted_test(a_comb_has_no_loops),
        counted_test(crossings_are_counted),
        counted_test(odd_networks_are_measured),
        counted_test(what_is_no_leaf_is_refused),
        counted_test(the_hull_holds_every_node),
        counted_test(halves_of_halves_merge_evenly),
        counted_test(loops_in_a_row_merge_one_by_one),
        counted_test(merges_up_to_a_width_leave_the_faces_of_the_rest),
        counted_test(angles_go_by_how_thin_the_thinnest_is),
        counted_test(distances_between_parallel_veins),
        counted_test(no_failed_allocation_loses_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
