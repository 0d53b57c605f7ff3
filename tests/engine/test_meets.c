// Which points lie in a lune, and which edges a way meets: the indexes against going through everything.

#include "support.h"

#include "space/point_tree.h"

// --- the tree of points -----------------------------------------------------------------------------------

enum { MOST_POINTS = 400 };

typedef struct cloud {
    int dim, count;
    double x[MOST_POINTS], y[MOST_POINTS], z[MOST_POINTS];
} cloud;

static vn_points points_of(const cloud *c) {
    return (vn_points){c->x, c->y, c->dim == 3 ? c->z : NULL};
}

// Clusters, lines and lattices, of any size and far from the origin.
static cloud random_cloud(vn_rng *rng, uint64_t seed) {
    static const double sizes[] = {1e-9, 1, 1e9};
    cloud c = {.dim = seed % 2 == 0 ? 2 : 3, .count = (int)whole(rng, 1, MOST_POINTS)};
    double size = sizes[seed % 3], offset = seed % 5 == 0 ? 1000 * size : 0;
    int kind = (int)(seed % 4);
    for (int i = 0; i < c.count; i++) {
        double p[3];
        for (int k = 0; k < 3; k++) {
            p[k] = kind == 1 ? (double)whole(rng, 0, 9) : uniform(rng, 0, 10);
        }
        p[1] = kind == 2 ? p[0] : p[1];
        double far = kind == 3 && i % 9 == 0 ? 1e4 : 1;
        c.x[i] = offset + size * far * p[0];
        c.y[i] = offset + size * far * p[1];
        c.z[i] = c.dim == 3 ? offset + size * p[2] : 0;
    }
    return c;
}

typedef struct collection {
    bool seen[MOST_POINTS];
} collection;

static bool collect(int32_t point, const vn_lune *lune, void *payload) {
    (void)lune;
    ((collection *)payload)->seen[point] = true;
    return false;
}

static bool is_wanted(const vn_lune *lune, const double p[3]) {
    double along = 0;
    for (int k = 0; k < 3; k++) {
        if (p[k] < lune->low[k] || p[k] > lune->high[k]) {
            return false;
        }
        along += lune->normal[k] * p[k];
    }
    return along >= lune->least;
}

// Every point must be shown that is in the part of the lune that is asked for; and none clearly outside of
// it.
static void check_lune(const cloud *c, const vn_point_tree *tree, const vn_lune *lune) {
    collection found = {0};
    vn_points points = points_of(c);
    double width2 = vn_distance2(lune->s, lune->v);
    assert_false(vn_point_tree_any_in_lune(tree, lune, collect, &found));
    for (int i = 0; i < c->count; i++) {
        double to_s = vn_points_distance2(&points, i, lune->s),
               to_v = vn_points_distance2(&points, i, lune->v);
        double p[3];
        vn_points_get(&points, i, p);
        if (to_s < width2 && to_v <= width2 && is_wanted(lune, p)) {
            assert_true(found.seen[i]);
        }
        if (fmax(to_s, to_v) > width2 * (1 + 1e-6)) {
            assert_false(found.seen[i]);
        }
    }
}

// All of the lune, a box of it, what lies beyond a plane, or both.
static void ask_for_part(vn_lune *lune, vn_rng *rng, int kind) {
    double d = sqrt(vn_distance2(lune->s, lune->v)), along = 0;
    for (int k = 0; k < 3; k++) {
        double middle = uniform(rng, 0, 1) < 0.5 ? lune->s[k] : lune->v[k];
        lune->low[k] = kind & 1 ? middle - uniform(rng, 0, d) : -INFINITY;
        lune->high[k] = kind & 1 ? middle + uniform(rng, 0, d) : INFINITY;
        lune->normal[k] = kind & 2 ? uniform(rng, -1, 1) : 0;
        along += lune->normal[k] * middle;
    }
    lune->least = kind & 2 ? along : -INFINITY;
}

// At exactly the radius a point is not within it.
static void check_within(const cloud *c, const vn_point_tree *tree, vn_rng *rng) {
    vn_points points = points_of(c);
    double p[3], radius = (double)whole(rng, 0, 40);
    vn_points_get(&points, (int32_t)whole(rng, 0, c->count - 1), p);
    p[whole(rng, 0, c->dim - 1)] += (double)whole(rng, -40, 40);
    bool any = false;
    for (int32_t i = 0; i < c->count; i++) {
        any = any || vn_points_distance2(&points, i, p) < radius * radius;
    }
    assert_int_equal(vn_point_tree_any_within(tree, p, radius), any);
}

static void the_tree_shows_what_is_in_a_lune(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 600; seed++) {
        vn_rng rng = vn_rng_make(seed);
        cloud c = random_cloud(&rng, seed);
        vn_points points = points_of(&c);
        vn_point_tree tree = {0};
        for (int count = 1; count <= c.count; count += (int)whole(&rng, 1, 200)) {
            assert_ok(vn_point_tree_update(&tree, c.dim, &points, count));
        }
        assert_ok(vn_point_tree_update(&tree, c.dim, &points, c.count));
        for (int k = 0; k < 20; k++) {
            vn_lune lune;
            vn_points_get(&points, (int32_t)whole(&rng, 0, c.count - 1), lune.s);
            vn_points_get(&points, (int32_t)whole(&rng, 0, c.count - 1), lune.v);
            ask_for_part(&lune, &rng, k % 4);
            check_lune(&c, &tree, &lune);
            check_within(&c, &tree, &rng);
        }
        vn_point_tree_free(&tree);
    }
}

static bool is_relative(const cloud *c, int v, const double s[3]) {
    vn_points points = points_of(c);
    double q[3], d2 = vn_points_distance2(&points, v, s);
    vn_points_get(&points, v, q);
    for (int u = 0; u < c->count; u++) {
        if (vn_points_distance2(&points, u, s) < d2 * (1 - 1e-9) &&
            vn_points_distance2(&points, u, q) < d2 * (1 - 1e-9)) {
            return false;
        }
    }
    return true;
}

static void what_is_around_has_all_relative_neighbors(void **state) {
    (void)state;
    vn_found_array found = {0};
    for (uint64_t seed = 0; seed < 1200; seed++) {
        vn_rng rng = vn_rng_make(seed);
        cloud c = random_cloud(&rng, seed);
        vn_points points = points_of(&c);
        vn_point_tree tree = {0};
        bool seen[MOST_POINTS] = {false};
        double s[3];
        vn_points_get(&points, (int32_t)whole(&rng, 0, c.count - 1), s);
        s[0] += seed % 3 == 0 ? 0.37 * s[1] : 0;
        double reach2 = seed % 4 == 0 ? vn_points_distance2(&points, 0, s) : INFINITY;
        assert_ok(vn_point_tree_update(&tree, c.dim, &points, c.count));
        assert_ok(vn_point_tree_around(&tree, s, reach2, &found));
        for (int32_t k = 0; k < found.count; k++) {
            assert_false(seen[found.data[k].point]);
            assert_true(k == 0 || found.data[k - 1].distance2 <= found.data[k].distance2);
            assert_true(found.data[k].distance2 <= reach2);
            seen[found.data[k].point] = true;
        }
        for (int v = 0; v < c.count; v++) {
            assert_true(seen[v] || !is_relative(&c, v, s) || vn_points_distance2(&points, v, s) > reach2);
        }
        vn_point_tree_free(&tree);
    }
    vn_array_free(&found);
}

// --- what a way meets -------------------------------------------------------------------------------------

// Points that touch, lie on one line and are shared, and edges a thousand times longer than the others.
static void random_end(vn_rng *rng, int kind, double size, double offset, double p[3]) {
    double range = kind == 2 && whole(rng, 0, 9) == 0 ? 1000 : 8;
    for (int k = 0; k < 2; k++) {
        double value = uniform(rng, 0, range);
        p[k] = offset + size * (kind == 1 ? floor(value) : value);
    }
    p[2] = 0;
}

static vn_network *random_edges(vn_rng *rng, int kind, double size, double offset) {
    vn_network *network = network_of(2);
    int count = (int)whole(rng, 2, 60);
    for (int i = 0; i < count; i++) {
        double p[3];
        random_end(rng, kind, size, offset, p);
        if (i < 2 || whole(rng, 0, 4) == 0) {
            assert_ok(vn_network_root(network, p, NULL));
        } else {
            assert_ok(vn_network_add(network, (int32_t)whole(rng, 0, i - 1), p, NULL));
        }
    }
    return network;
}

static double distance_to_edge(const vn_segment *s, double x, double y) {
    double dx = s->x1 - s->x0, dy = s->y1 - s->y0, length2 = dx * dx + dy * dy;
    double part = length2 > 0 ? ((x - s->x0) * dx + (y - s->y0) * dy) / length2 : 0;
    part = fmin(fmax(part, 0), 1);
    return hypot(s->x0 + part * dx - x, s->y0 + part * dy - y);
}

static double distance_between(const vn_segment *s, const vn_segment *t) {
    double a = fmin(distance_to_edge(t, s->x0, s->y0), distance_to_edge(t, s->x1, s->y1));
    double b = fmin(distance_to_edge(s, t->x0, t->y0), distance_to_edge(s, t->x1, t->y1));
    return vn_segments_touch(s, t) ? 0 : fmin(a, b);
}

// How far the way is from meeting the edge: 0, or less than `near`, where it does; negative where that is too
// close to call. Edges of its ends are met where they lie along it.
static double gap_to(const vn_network *network, const vn_segment *way, int32_t node, int32_t to,
                     int32_t edge) {
    int32_t a, b;
    vn_network_edge_ends(network, edge, &a, &b);
    vn_segment t = vn_network_segment(network, edge);
    bool at_node = a == node || b == node, at_to = a == to || b == to;
    if (!at_node && !at_to) {
        return distance_between(way, &t);
    }
    if (at_node && at_to) {
        return 0;
    }
    bool first = at_node ? a == node : a == to;
    double px = at_node ? way->x0 : way->x1, py = at_node ? way->y0 : way->y1;
    double qx = at_node ? way->x1 : way->x0, qy = at_node ? way->y1 : way->y0;
    double ox = first ? t.x1 : t.x0, oy = first ? t.y1 : t.y0;
    double forward = (ox - px) * (qx - px) + (oy - py) * (qy - py);
    return forward > 0 ? fmin(distance_to_edge(way, ox, oy), distance_to_edge(&t, qx, qy)) : INFINITY;
}

static void check_way(vn_network *network, int32_t node, const double p[3], int32_t to, double typical) {
    bool meets;
    vn_meeting met;
    vn_segment way = {network->x.data[node], network->y.data[node], p[0], p[1]};
    double least = INFINITY;
    assert_ok(vn_network_meets(network, node, p, to, typical, &meets, &met));
    for (int32_t e = -network->joins.count; e < network->x.count; e++) {
        if (e < 0 || network->parent.data[e] >= 0) {
            least = fmin(least, gap_to(network, &way, node, to, e));
        }
    }
    double rounding = 1e-13 * (fabs(p[0]) + fabs(p[1]) + fabs(way.x0) + fabs(way.y0)), near = 1e-6 * typical;
    if (least > near * (1 + 1e-6) + rounding) {
        assert_false(meets);
    } else if (least <= near * (1 - 1e-6) - rounding) {
        assert_true(meets);
    }
    if (meets) {
        vn_segment t = vn_network_segment(network, met.edge);
        assert_true(met.way >= 0 && met.way <= 1);
        assert_true(distance_to_edge(&t, met.p[0], met.p[1]) <= rounding);
    }
}

static void ways_meet_what_they_touch(void **state) {
    (void)state;
    static const double sizes[] = {1e-9, 1, 1e9};
    for (uint64_t seed = 0; seed < 1000; seed++) {
        vn_rng rng = vn_rng_make(seed);
        int kind = (int)(seed % 3);
        double size = sizes[seed / 3 % 3], offset = seed % 7 == 0 ? size * 1e6 : 0;
        vn_network *network = random_edges(&rng, kind, size, offset);
        int32_t count = vn_network_count(network);
        for (int k = 0; k < 30; k++) {
            double p[3];
            int32_t node = (int32_t)whole(&rng, 0, count - 1), to = -1;
            random_end(&rng, kind, size, offset, p);
            if (k % 3 == 0) {
                to = (int32_t)whole(&rng, 0, count - 1);
                vn_network_position(network, to, p);
            }
            if (to != node && !(to >= 0 && vn_network_connected(network, node, to))) {
                check_way(network, node, p, to, k < 15 ? size : 0.3 * size);
                if (to >= 0 && k % 2 == 0) {
                    assert_ok(vn_network_join(network, node, to, 0));
                }
            }
            if (k % 10 == 9) {
                assert_ok(vn_network_scale(network, 1));
            }
        }
        vn_network_destroy(network);
    }
}

// A way that stops short of an edge by what rounding does, or leads past the end of one, meets it there.
static void near_misses_are_met(void **state) {
    (void)state;
    vn_network *network = network_of(2);
    int32_t a = put_root(network, 0, 0, 0), b = put_child(network, a, 1, 0, 0);
    int32_t c = put_root(network, 0.5, 1, 0), d = put_root(network, 3, 0, 0);
    bool meets;
    vn_meeting met;
    assert_ok(vn_network_meets(network, c, (double[3]){0.5, 1e-9, 0}, -1, 1, &meets, &met));
    assert_true(meets && met.edge == b && met.p[0] == 0.5 && met.p[1] == 0);
    assert_ok(vn_network_meets(network, c, (double[3]){0.5, 1e-5, 0}, -1, 1, &meets, &met));
    assert_false(meets);
    assert_ok(vn_network_meets(network, d, (double[3]){0, 0, 0}, a, 1, &meets, &met)); // along a-b, to a
    assert_true(meets && met.edge == b);
    assert_near(met.way, 2.0 / 3, 1e-12);
    assert_ok(vn_network_meets(network, d, (double[3]){1, 0, 0}, b, 1, &meets, &met));
    assert_false(meets);
    vn_network_destroy(network);
}

static void a_failed_allocation_leaves_the_edges_whole(void **state) {
    (void)state;
    vn_status status = VN_NO_MEMORY;
    int refused = 0;
    for (; status != VN_OK; refused++) {
        vn_network *network = random_tree(2, 300, 3, 7);
        bool meets = false;
        vn_meeting met;
        double p[3] = {0.1, 0.2, 0};
        vn_fail_allocations_from(refused);
        status = vn_network_meets(network, 5, p, -1, 1, &meets, &met);
        vn_fail_allocations_from(-1);
        assert_true(status == VN_OK || status == VN_NO_MEMORY);
        check_way(network, 5, p, -1, 1);
        vn_network_destroy(network);
    }
    assert_true(refused > 3);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(the_tree_shows_what_is_in_a_lune),
        counted_test(what_is_around_has_all_relative_neighbors),
        counted_test(ways_meet_what_they_touch),
        counted_test(near_misses_are_met),
        counted_test(a_failed_allocation_leaves_the_edges_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
