// The surface of a mesh as a domain, and venation on surfaces that bend either way.
#include "mesh_support.h"

#include "domain/domain.h"
#include "domain/faces.h"
#include "growth/growth.h"
#include "space/triangle_tree.h"

// ---- Meshes ----

static vn_domain *domain_of(mesh *m) {
    vn_domain *domain = NULL;
    assert_ok(
        vn_domain_surface(&domain, m->xyz.data, m->xyz.count / 3, m->corners.data, m->corners.count / 3));
    free_mesh(m);
    return domain;
}

static void flat(double u, double v, double p[3]) {
    set(p, 10 * u, 10 * v, 3);
}

static void uneven(double u, double v, double p[3]) {
    set(p, 7 * u * u + u, 5 * v * v * v + v, 2 * u);
}

// A cap of a sphere of radius 10, 60° to each side.
static void cap(double u, double v, double p[3]) {
    double most = tan(pi / 3);
    on_sphere(most * (2 * u - 1), most * (2 * v - 1), 1, 10, p);
}

static void saddle(double u, double v, double p[3]) {
    double x = 20 * u - 10, y = 20 * v - 10;
    set(p, x, y, 0.06 * (x * x - y * y));
}

// Open along a slit, so that it has a border all round.
static void cylinder(double u, double v, double p[3]) {
    set(p, 5 * cos(1.9 * pi * u), 5 * sin(1.9 * pi * u), 20 * v);
}

// Two sheets at a distance of 0.6, joined by half a cylinder.
static const double gap = 0.6;
static void fold(double u, double v, double p[3]) {
    double arc = 0.5 * pi * gap, s = u * (20 + arc);
    double angle = (s - 10) / (0.5 * gap);
    if (s < 10) {
        set(p, s - 10, 10 * v, 0);
    } else if (s > 10 + arc) {
        set(p, 10 + arc - s, 10 * v, gap);
    } else {
        set(p, 0.5 * gap * sin(angle), 10 * v, 0.5 * gap * (1 - cos(angle)));
    }
}

// ---- What it answers ----

static double saddle_area(void) {
    double sum = 0, h = 20.0 / 2000;
    for (int i = 0; i < 2000; i++) {
        for (int j = 0; j < 2000; j++) {
            double x = (i + 0.5) * h - 10, y = (j + 0.5) * h - 10;
            sum += h * h * sqrt(1 + 0.12 * 0.12 * (x * x + y * y));
        }
    }
    return sum;
}

static void areas_are_those_of_the_shapes(void **state) {
    (void)state;
    mesh square = sheet(flat, 7, 3), hyperbolic = sheet(saddle, 200, 200), round = globe(60, 3);
    vn_domain *domain = domain_of(&square);
    assert_near(vn_domain_measure(domain), 100, 1e-11);
    assert_int_equal(vn_domain_dim(domain), 3);
    vn_box bounds = vn_domain_bounds(domain);
    assert_true(bounds.min[0] == 0 && bounds.max[1] == 10 && bounds.min[2] == 3 && bounds.max[2] == 3);
    vn_domain_release(domain);
    domain = domain_of(&hyperbolic);
    double area = saddle_area();
    assert_near(vn_domain_measure(domain), area, 1e-4 * area);
    vn_domain_release(domain);
    domain = domain_of(&round);
    assert_near(vn_domain_measure(domain), 36 * pi, 36 * pi * 1e-3);
    assert_true(vn_domain_measure(domain) < 36 * pi); // it is inscribed
    vn_domain_release(domain);
}

// Chi² with 35 degrees of freedom is below 70 but for 4 in 10,000 cases.
static void darts_are_spread_evenly_over_the_area(void **state) {
    (void)state;
    enum { SIDE = 6, DARTS = 36000 };
    mesh m = sheet(uneven, SIDE, SIDE);
    vn_domain *domain = domain_of(&m);
    int32_t hits[SIDE * SIDE] = {0};
    vn_rng rng = vn_rng_make(11);
    for (int k = 0; k < DARTS; k++) {
        double p[3];
        assert_ok(vn_domain_dart(domain, &rng, p));
        assert_true(vn_domain_contains(domain, p));
        int i = 0, j = 0;
        double q[3];
        for (uneven((i + 1.0) / SIDE, 0, q); q[0] < p[0]; uneven((i + 1.0) / SIDE, 0, q)) {
            i++;
        }
        for (uneven(0, (j + 1.0) / SIDE, q); q[1] < p[1]; uneven(0, (j + 1.0) / SIDE, q)) {
            j++;
        }
        hits[j * SIDE + i]++;
    }
    double chi2 = 0;
    for (int k = 0; k < SIDE * SIDE; k++) {
        double p[3], q[3];
        int i = k % SIDE, j = k / SIDE;
        uneven((double)i / SIDE, (double)j / SIDE, p);
        uneven((i + 1.0) / SIDE, (j + 1.0) / SIDE, q);
        double area = hypot(q[0] - p[0], q[2] - p[2]) * (q[1] - p[1]);
        double expected = DARTS * area / vn_domain_measure(domain);
        chi2 += (hits[k] - expected) * (hits[k] - expected) / expected;
    }
    assert_true(chi2 < 70);
    assert_true(chi2 > 12);
    vn_domain_release(domain);
}

static void the_nearest_triangle_is_the_one_that_all_agree_on(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(2);
    for (int32_t count = 1; count <= 3000; count = 3 * count + 1) {
        vn_triangle *soup = test_malloc((size_t)count * sizeof *soup);
        vn_triangle_tree tree = {0};
        for (int32_t i = 0; i < count; i++) {
            for (int k = 0; k < 3; k++) {
                double middle = uniform(&rng, -10, 10), size = whole(&rng, 0, 9) == 0 ? 5 : 0.5;
                soup[i].a[k] = middle + uniform(&rng, -size, size);
                soup[i].b[k] = middle + uniform(&rng, -size, size);
                soup[i].c[k] = i % 5 == 4 ? soup[i].b[k] : middle + uniform(&rng, -size, size);
            }
        }
        assert_ok(vn_triangle_tree_build(&tree, soup, count));
        for (int trial = 0; trial < 200; trial++) {
            double p[3], q[3], d2, least = INFINITY;
            for (int k = 0; k < 3; k++) {
                p[k] = uniform(&rng, -14, 14);
            }
            for (int32_t i = 0; i < count; i++) {
                double d = i % 5 == 4 ? to_segment(p, soup[i].a, soup[i].b) : to_triangle(p, &soup[i]);
                least = fmin(least, d);
            }
            int32_t found = vn_triangle_tree_nearest(&tree, p, INFINITY, &d2, q);
            assert_near(sqrt(d2), least, 1e-9);
            assert_near(sqrt(vn_distance2(p, q)), least, 1e-9);
            assert_near(found % 5 == 4 ? to_segment(p, soup[found].a, soup[found].b)
                                       : to_triangle(p, &soup[found]),
                        least, 1e-9);
            assert_int_equal(vn_triangle_tree_nearest(&tree, p, 0.99 * d2, &d2, q), -1);
        }
        vn_triangle_tree_free(&tree);
        test_free(soup);
    }
}

static bool count_visit(int32_t number, void *payload) {
    int32_t *visits = payload;
    visits[number]++;
    return true;
}

static void all_triangles_around_a_point_are_visited_once(void **state) {
    (void)state;
    mesh m = globe(9, 3);
    int32_t count = m.corners.count / 3;
    vn_triangle *parts = test_malloc((size_t)count * sizeof *parts);
    int32_t *visits = test_calloc((size_t)count, sizeof *visits);
    vn_triangle_tree tree = {0};
    for (int32_t i = 0; i < count; i++) {
        memcpy(parts[i].a, m.xyz.data + 3 * m.corners.data[3 * i], sizeof parts[i].a);
        memcpy(parts[i].b, m.xyz.data + 3 * m.corners.data[3 * i + 1], sizeof parts[i].b);
        memcpy(parts[i].c, m.xyz.data + 3 * m.corners.data[3 * i + 2], sizeof parts[i].c);
    }
    assert_ok(vn_triangle_tree_build(&tree, parts, count));
    vn_rng rng = vn_rng_make(5);
    for (int trial = 0; trial < 100; trial++) {
        double p[3] = {uniform(&rng, -4, 4), uniform(&rng, -4, 4), uniform(&rng, -4, 4)};
        memset(visits, 0, (size_t)count * sizeof *visits);
        assert_true(vn_triangle_tree_around(&tree, p, 2.25, count_visit, visits));
        for (int32_t i = 0; i < count; i++) {
            double d = to_triangle(p, &parts[i]);
            assert_true(fabs(d - 1.5) < 1e-9 || visits[i] == (d < 1.5));
        }
    }
    vn_triangle_tree_free(&tree);
    test_free(parts);
    test_free(visits);
    free_mesh(&m);
}

static void what_is_inside_is_on_the_surface(void **state) {
    (void)state;
    mesh m = sheet(flat, 4, 4), round = globe(20, 3);
    vn_domain *square = domain_of(&m), *ball = domain_of(&round);
    double on[3] = {4, 2.5, 3}, above[3] = {4, 2.5, 3.5}, beside[3] = {-3, 2.5, 3}, q[3];
    assert_true(vn_domain_contains(square, on));
    assert_false(vn_domain_contains(square, above));
    assert_near(vn_domain_distance(square, on), 2.5, 1e-12); // to the border
    assert_near(vn_domain_distance(square, above), -0.5, 1e-12);
    assert_near(vn_domain_distance(square, beside), -3, 1e-12);
    vn_domain_closest(square, on, q);
    assert_true(q[0] == 4 && q[1] == 0 && q[2] == 3);
    vn_domain_closest(square, above, q);
    assert_true(q[0] == 4 && q[1] == 2.5 && q[2] == 3);
    assert_true(vn_domain_snap(square, above));
    assert_true(vn_domain_contains(square, above));
    assert_false(vn_domain_snap(square, beside));
    assert_true(beside[0] == -3);
    double pole[3] = {0, 0, 3}, middle[3] = {0.1, 0, 0};
    assert_true(isinf(vn_domain_distance(ball, pole))); // a closed surface has no border
    assert_near(vn_domain_distance(ball, middle), -2.9, 0.02);
    vn_domain_release(square);
    vn_domain_release(ball);
}

// A flat mesh of the U's squares sees what the polygon sees, whichever way its triangles turn.
static void a_flat_mesh_sees_what_its_polygon_sees(void **state) {
    (void)state;
    vn_domain *polygon = u_shape();
    vn_box box = vn_domain_bounds(polygon);
    mesh m = {0};
    vn_rng rng = vn_rng_make(6);
    enum { N = 20 };
    double h = 0.5;
    for (int j = 0; j <= N; j++) {
        for (int i = 0; i <= N; i++) {
            put_vertex(&m, (double[3]){box.min[0] + h * i, box.min[1] + h * j, 0});
        }
    }
    for (int j = 0; j < N; j++) {
        for (int i = 0; i < N; i++) {
            int32_t a = j * (N + 1) + i;
            double middle[3] = {box.min[0] + h * (i + 0.5), box.min[1] + h * (j + 0.5), 0};
            if (vn_domain_contains(polygon, middle)) {
                bool turned = whole(&rng, 0, 1);
                put_triangle(&m, a, turned ? a + 1 : a + N + 2, turned ? a + N + 2 : a + 1);
                put_triangle(&m, a, a + N + 2, a + N + 1);
            }
        }
    }
    vn_domain *surface = domain_of(&m);
    assert_near(vn_domain_measure(surface), vn_domain_measure(polygon), 1e-9);
    int seen = 0, hidden = 0;
    for (int trial = 0; trial < 4000; trial++) {
        double p[3], q[3];
        assert_ok(vn_domain_dart(surface, &rng, p));
        assert_ok(vn_domain_dart(surface, &rng, q));
        if (trial % 3 == 0) { // vertices and edges of the mesh
            p[0] = box.min[0] + h * (1 + floor((p[0] - box.min[0]) / h));
            p[1] = box.min[1] + h * (1 + floor((p[1] - box.min[1]) / h));
            q[trial % 2] = p[trial % 2];
        }
        if (vn_domain_distance(polygon, p) <= 1e-3 || vn_domain_distance(polygon, q) <= 1e-3) {
            continue;
        }
        bool sees = vn_domain_sees(polygon, p, q);
        double higher[2][3] = {{p[0], p[1] + 1e-4, 0}, {q[0], q[1] + 1e-4, 0}};
        double lower[2][3] = {{p[0], p[1] - 1e-4, 0}, {q[0], q[1] - 1e-4, 0}};
        if (vn_domain_sees(polygon, higher[0], higher[1]) != vn_domain_sees(polygon, lower[0], lower[1])) {
            continue; // it grazes the border
        }
        assert_int_equal(vn_domain_sees(surface, p, q), sees);
        assert_int_equal(vn_domain_sees(surface, q, p), sees);
        seen += sees;
        hidden += !sees;
    }
    assert_true(seen > 1000 && hidden > 500);
    vn_domain_release(surface);
    vn_domain_release(polygon);
}

static void the_sheets_of_a_fold_do_not_see_each_other(void **state) {
    (void)state;
    mesh m = sheet(fold, 160, 20);
    vn_domain *domain = domain_of(&m);
    vn_rng rng = vn_rng_make(9);
    int same = 0, across = 0;
    for (int trial = 0; trial < 3000; trial++) {
        double p[3], q[3];
        assert_ok(vn_domain_dart(domain, &rng, p));
        assert_ok(vn_domain_dart(domain, &rng, q));
        if (p[0] > -1 || q[0] > -1) {
            continue; // near the bend
        }
        bool one_sheet = fabs(p[2] - q[2]) < 0.5 * gap;
        assert_int_equal(vn_domain_sees(domain, p, q), one_sheet);
        same += one_sheet;
        across += !one_sheet;
    }
    assert_true(same > 500 && across > 500);
    double below[3] = {-2, 5, 0}, above[3] = {-2, 5, gap}, far[3] = {-9, 5, gap};
    assert_false(vn_domain_sees(domain, below, above));
    assert_false(vn_domain_sees(domain, below, far));
    vn_domain_release(domain);
}

static void round_a_ball_one_sees_up_to_the_horizon(void **state) {
    (void)state;
    mesh m = globe(40, 3);
    vn_domain *domain = domain_of(&m);
    vn_rng rng = vn_rng_make(19);
    for (int trial = 0; trial < 2000; trial++) {
        double p[3], q[3];
        assert_ok(vn_domain_dart(domain, &rng, p));
        assert_ok(vn_domain_dart(domain, &rng, q));
        double angle = 2 * asin(fmin(sqrt(vn_distance2(p, q)) / 6, 1)) * 180 / pi;
        // Beyond a quarter of the circle the normals are nearer to each other's opposites.
        if (angle < 88) {
            assert_true(vn_domain_sees(domain, p, q));
        } else if (angle > 92) {
            assert_false(vn_domain_sees(domain, p, q));
        }
    }
    vn_domain_release(domain);
}

// ---- Venation ----

typedef struct run {
    vn_domain *domain;
    double root[3];
    int mode; ///< of influence
    double length, kill, spacing, within;
    int32_t darts; ///< a step
    vn_network *network;
    vn_attractors *attractors;
    int32_t sources;
} run;

static void grow_once(const run *r, vn_influence **pairs, int32_t *changes) {
    vn_influence_def influence = {.mode = r->mode, .within = r->within};
    vn_extend_def extend = {.length = r->length, .domain = r->domain};
    vn_consume_def consume = {.distance = r->kill, .mode = r->mode == 0 ? VN_CONSUME_ANY : VN_CONSUME_TAGGED};
    int32_t added, first, consumed;
    assert_ok(vn_influence_find(pairs, r->attractors, r->network, &influence));
    assert_ok(vn_extend(r->network, *pairs, &extend, &added, &first));
    assert_ok(vn_consume(r->attractors, r->network, &consume, &consumed));
    *changes += added + consumed;
}

// Until thirty steps in a row have brought nothing new.
static void grow(run *r) {
    vn_rng rng = vn_rng_make(4);
    vn_influence *pairs = NULL;
    r->network = network_of(3);
    r->attractors = attractors_of(3, 1);
    r->sources = 0;
    put_root(r->network, r->root[0], r->root[1], r->root[2]);
    vn_throw_def throw = {.domain = r->domain,
                          .count = r->darts,
                          .spacing = r->spacing,
                          .clearance = r->spacing,
                          .network = r->network,
                          .rng = &rng};
    for (int step = 0, idle = 0; idle < 30; step++) {
        int32_t accepted, changes = 0;
        assert_true(step < 5000);
        assert_ok(vn_throw(r->attractors, &throw, &accepted));
        r->sources += accepted;
        grow_once(r, &pairs, &changes);
        idle = changes + accepted > 0 ? 0 : idle + 1;
    }
    vn_influence_destroy(pairs);
}

static void end_run(run *r) {
    vn_network_destroy(r->network);
    vn_attractors_destroy(r->attractors);
}

static void check_edges(const run *r) {
    const vn_network *network = r->network;
    int32_t long_edges = 0;
    for (int32_t v = 0; v < vn_network_count(network); v++) {
        double p[3], q[3];
        vn_network_position(network, v, p);
        assert_true(vn_domain_contains(r->domain, p));
        if (network->parent.data[v] >= 0) {
            vn_network_position(network, network->parent.data[v], q);
            double length = sqrt(vn_distance2(p, q)) / r->length;
            assert_true(length < 2.1);
            assert_true(vn_domain_sees(r->domain, p, q));
            long_edges += fabs(length - 1) > 0.05;
        }
    }
    // Only junctions, which stand where their attractor was, have edges of other lengths.
    assert_true(long_edges <= (r->mode == 0 ? vn_network_count(network) / 200 : r->sources));
}

static void check_run(run *r, const char *name) {
    grow(r);
    vn_retired retired = vn_attractors_retired(r->attractors);
    int32_t joins = vn_network_join_count(r->network);
    print_message("%s: %d sources, %d nodes, %d joins, retired %d + %d\n", name, r->sources,
                  vn_network_count(r->network), joins, retired.hidden, retired.circled);
    assert_int_equal(vn_attractors_count(r->attractors), 0);
    assert_true(r->sources > 300);
    assert_true(retired.hidden + retired.circled <= r->sources / 50);
    assert_true(vn_network_count(r->network) > r->sources);
    assert_true(r->mode == 0 ? joins == 0 : joins > r->sources / 5);
    check_edges(r);
    end_run(r);
}

static void venation_grows_on_surfaces_that_bend_either_way(void **state) {
    (void)state;
    place_fn *const places[] = {cap, saddle, cylinder, flat};
    static const char *const names[] = {"cap", "saddle", "cylinder", "flat"};
    for (int k = 0; k < 4; k++) {
        mesh m = sheet(places[k], 60, 60);
        run r = {.length = 0.1, .within = 2, .darts = 100};
        places[k](0.5, k == 2 ? 0.0 : 0.5, r.root);
        r.length = k == 3 ? 0.05 : 0.1;
        r.kill = r.length;
        r.spacing = k == 3 ? 0.3 : 0.6;
        r.domain = domain_of(&m);
        for (r.mode = 0; r.mode < 2; r.mode++) {
            check_run(&r, names[k]);
        }
        vn_domain_release(r.domain);
    }
}

static void venation_closes_round_a_ball(void **state) {
    (void)state;
    mesh m = globe(40, 3);
    run r = {.root = {0, 0, 3},
             .mode = 1,
             .length = 0.08,
             .kill = 0.08,
             .spacing = 0.35,
             .within = 1.5,
             .darts = 60};
    r.domain = domain_of(&m);
    check_run(&r, "ball");
    vn_domain_release(r.domain);
}

// Attraction reaches twice across the fold: veins come round it all the same, and never through the air.
static void no_vein_jumps_across_a_fold(void **state) {
    (void)state;
    mesh m = sheet(fold, 200, 50);
    run r = {
        .root = {-9, 5, 0}, .length = 0.15, .kill = 0.15, .spacing = 0.5, .within = 2 * gap, .darts = 60};
    r.domain = domain_of(&m);
    for (r.mode = 0; r.mode < 2; r.mode++) {
        grow(&r);
        int32_t above = 0;
        for (int32_t v = 0; v < vn_network_count(r.network); v++) {
            double p[3], q[3];
            int32_t parent = r.network->parent.data[v];
            vn_network_position(r.network, v, p);
            assert_true(vn_domain_contains(r.domain, p));
            above += p[2] > 0.9 * gap && p[0] < -2;
            if (parent >= 0) {
                vn_network_position(r.network, parent, q);
                assert_true(p[0] > -0.5 || fabs(p[2] - q[2]) < 0.01 * gap);
            }
        }
        print_message("fold: %d nodes, %d above\n", vn_network_count(r.network), above);
        assert_true(above > 100);
        end_run(&r);
    }
    vn_domain_release(r.domain);
}

static void a_still_blade_of_a_surface_is_that_surface(void **state) {
    (void)state;
    mesh m = sheet(saddle, 30, 30);
    run r = {.length = 0.2, .kill = 0.2, .spacing = 0.8, .within = 3, .darts = 40};
    uint64_t hash[2];
    saddle(0.5, 0.5, r.root);
    r.domain = domain_of(&m);
    for (int k = 0; k < 2; k++) {
        grow(&r);
        hash[k] = network_hash(r.network);
        end_run(&r);
        vn_growth_def def = {.domain = r.domain};
        vn_growth *still = NULL;
        assert_ok(vn_growth_none(&still, &def));
        vn_domain_release(r.domain);
        r.domain = vn_growth_domain(still);
    }
    assert_true(hash[0] == hash[1]);
    vn_growth_def margin = {.domain = r.domain};
    vn_growth *marginal;
    assert_int_not_equal(vn_growth_marginal(&marginal, &margin), VN_OK);
    vn_domain_release(r.domain);
}

// The same sources in a square and on a mesh of it, all at once.
static void a_flat_mesh_grows_what_its_square_grows(void **state) {
    (void)state;
    mesh m = sheet(flat, 23, 31);
    for (int32_t i = 2; i < m.xyz.count; i += 3) {
        m.xyz.data[i] = 0;
    }
    vn_domain *domains[2] = {box_of(0, 0, 10, 10), domain_of(&m)};
    vn_rng rng = vn_rng_make(7);
    vn_throw_def throw = {.domain = domains[0], .count = 5000, .spacing = 0.5, .rng = &rng};
    for (int mode = 0; mode < 2; mode++) {
        run runs[2];
        int32_t changes = 1, thrown;
        vn_influence *pairs = NULL;
        for (int k = 0; k < 2; k++) {
            runs[k] = (run){.mode = mode, .length = 0.1, .kill = 0.2, .within = 3, .domain = domains[k]};
            runs[k].network = network_of(2 + k);
            runs[k].attractors = attractors_of(2 + k, 0);
            put_root(runs[k].network, 5, 0, 0);
        }
        assert_ok(vn_throw(runs[0].attractors, &throw, &thrown));
        for (int32_t i = 0; i < thrown; i++) {
            double p[3];
            assert_ok(vn_attractors_position(runs[0].attractors, i, p));
            put_attractor(runs[1].attractors, p[0], p[1], 0);
        }
        for (int k = 0; k < 2; k++, changes = 1) {
            while (changes > 0) {
                changes = 0;
                grow_once(&runs[k], &pairs, &changes);
            }
            vn_influence_destroy(pairs);
            pairs = NULL;
        }
        int32_t nodes = vn_network_count(runs[0].network);
        assert_true(nodes > 1000);
        assert_int_equal(vn_network_count(runs[1].network), nodes);
        assert_int_equal(vn_network_join_count(runs[1].network), vn_network_join_count(runs[0].network));
        for (int32_t v = 0; v < nodes; v++) {
            double p[3], q[3];
            vn_network_position(runs[0].network, v, p);
            vn_network_position(runs[1].network, v, q);
            assert_true(vn_distance2(p, q) < 1e-18);
        }
        end_run(&runs[0]);
        end_run(&runs[1]);
    }
    vn_domain_release(domains[0]);
    vn_domain_release(domains[1]);
}

// In a solid, loops close too; and the run ends.
static void venation_closes_in_a_solid(void **state) {
    (void)state;
    run r = {.domain = ball_of(0, 0, 0, 3),
             .root = {0, 0, -3},
             .mode = 1,
             .length = 0.15,
             .kill = 0.15,
             .spacing = 0.6,
             .within = 2,
             .darts = 60};
    grow(&r);
    vn_retired retired = vn_attractors_retired(r.attractors);
    int32_t joins = vn_network_join_count(r.network);
    print_message("solid: %d sources, %d nodes, %d joins, retired %d + %d\n", r.sources,
                  vn_network_count(r.network), joins, retired.hidden, retired.circled);
    assert_int_equal(vn_attractors_count(r.attractors), 0);
    assert_true(joins > r.sources / 4);
    end_run(&r);
    vn_domain_release(r.domain);
}

static void a_surface_is_not_combined(void **state) {
    (void)state;
    mesh m = sheet(flat, 2, 2);
    vn_domain *surface = domain_of(&m), *ball = ball_of(0, 0, 0, 5), *out;
    assert_int_equal(vn_domain_combine(&out, surface, ball, VN_DIFFERENCE), VN_INVALID);
    assert_message("a surface cannot be combined");
    assert_int_equal(vn_domain_combine(&out, ball, surface, VN_UNION), VN_INVALID);
    vn_domain_release(ball);
    vn_domain_release(surface);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(areas_are_those_of_the_shapes),
        counted_test(darts_are_spread_evenly_over_the_area),
        counted_test(the_nearest_triangle_is_the_one_that_all_agree_on),
        counted_test(all_triangles_around_a_point_are_visited_once),
        counted_test(what_is_inside_is_on_the_surface),
        counted_test(a_flat_mesh_sees_what_its_polygon_sees),
        counted_test(the_sheets_of_a_fold_do_not_see_each_other),
        counted_test(round_a_ball_one_sees_up_to_the_horizon),
        counted_test(venation_grows_on_surfaces_that_bend_either_way),
        counted_test(venation_closes_round_a_ball),
        counted_test(no_vein_jumps_across_a_fold),
        counted_test(a_still_blade_of_a_surface_is_that_surface),
        counted_test(a_flat_mesh_grows_what_its_square_grows),
        counted_test(venation_closes_in_a_solid),
        counted_test(a_surface_is_not_combined),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
