// Growing blades: where tissue goes, and what today's shape answers.
#include "support.h"

#include "growth/growth.h"

static const double pi = 3.14159265358979;

static double one(double y0) {
    (void)y0;
    return 1;
}

static double half_more(double y0) {
    return 1 + y0 / 2;
}

static double tenth_more(double y0) {
    return 1 + y0 / 10;
}

static double smooth(double y0) {
    return 1.3 + 0.25 * sin(0.8 * y0 + 1) + 0.1 * cos(1.7 * y0);
}

static double shrinking(double y0) {
    return 0.95 + 0.04 * cos(y0);
}

static double stairs(double y0) {
    return y0 < 1 ? 0.9 : (y0 < 4 ? 1.5 : 1.1);
}

static vn_growth *morph_blade(vn_domain *a, vn_domain *b, int32_t steps) {
    vn_morph_def def = vn_morph_def_default();
    vn_domain *domains[] = {a, b};
    vn_growth *growth = NULL;
    def.domains = domains;
    def.count = 2;
    def.steps = steps;
    assert_ok(vn_growth_morph(&growth, &def));
    return growth;
}

static void assert_maps(vn_growth *growth, const double at[4], double t1, double t2, double tolerance) {
    double q[3];
    map_point(growth, at[0], at[1], t1, t2, q);
    assert_near(q[0], at[2], tolerance);
    assert_near(q[1], at[3], tolerance);
}

// ---- Isogonic growth ----

// A blade that stays while the unit shrinks answers as one that is scaled, in units.
static void a_shrinking_unit_is_a_growing_blade(void **state) {
    (void)state;
    vn_domain *shape = leaf_shape();
    vn_growth_def def = {.domain = shape, .from = 3, .to = 60, .step = 2.5};
    vn_growth *still = NULL, *scaled = NULL;
    assert_ok(vn_growth_isogonic(&still, &def));
    assert_ok(vn_growth_marginal(&scaled, &def));
    vn_rng rng = vn_rng_make(1);
    do {
        double unit = vn_growth_unit(still), length = vn_growth_length(still);
        assert_near(unit * length, 3, 1e-14);
        assert_true(length == vn_growth_length(scaled));
        vn_box b = vn_domain_bounds(vn_growth_domain(still));
        assert_near(b.max[1] - b.min[1], 3, 1e-14);
        double area = vn_domain_measure(vn_growth_domain(scaled));
        assert_near(vn_domain_measure(vn_growth_domain(still)) / (unit * unit), area, 1e-12 * area);
        for (int n = 0; n < 50; n++) {
            double p[3] = {uniform(&rng, -1, 1), uniform(&rng, -0.2, 3.2), 0}, q[3];
            double big[3] = {p[0] / unit, p[1] / unit, 0};
            double d = vn_domain_distance(vn_growth_domain(scaled), big);
            assert_near(vn_domain_distance(vn_growth_domain(still), p) / unit, d, 1e-11);
            map_point(still, p[0], p[1], 0, vn_growth_time(still), q);
            assert_true(q[0] == p[0] && q[1] == p[1]);
        }
        assert_int_equal(vn_growth_is_grown(still), length >= 60);
    } while (advance(still) == advance(scaled) && !vn_growth_is_grown(scaled));
    assert_true(vn_growth_length(still) == 60 && !advance(still));
    assert_int_equal(vn_growth_time(still), vn_growth_steps(still));
    assert_string_equal(vn_growth_kind_name(still), "isogonic");
    vn_growth_release(still);
    vn_growth_release(scaled);
    vn_domain_release(shape);
}

// ---- Where tissue goes ----

static void golden_cases_of_the_appendix(void **state) {
    (void)state;
    vn_domain *shape = box_of(-2, -1, 2, 3);
    vn_growth *growth = rerg_blade(shape, tenth_more, half_more, 3);
    assert_maps(growth, (double[]){0, 2, 0, 7.5}, 0, 3, 1e-12);
    assert_maps(growth, (double[]){0, 7.5, 0, 2}, 3, 0, 1e-12);
    assert_maps(growth, (double[]){0, 2, 0, 3}, 0, 1, 1e-12);
    assert_maps(growth, (double[]){0, -1, 0, -7.0 / 12}, 0, 2, 1e-12);
    assert_maps(growth, (double[]){0, -7.0 / 12, 0, -1}, 2, 0, 1e-12);
    vn_growth_release(growth);
    growth = rerg_blade(shape, tenth_more, one, 3);
    assert_maps(growth, (double[]){1, 2, 1.728, 2}, 0, 3, 1e-12); // f_x(2) = 1.2
    assert_maps(growth, (double[]){1.728, 2, 1, 2}, 3, 0, 1e-12);
    vn_growth_release(growth);
    vn_domain_release(shape);
}

static double simpson(factor_fn *f, double t, double a, double b) {
    return (b - a) / 6 * (pow(f(a), t) + 4 * pow(f(0.5 * (a + b)), t) + pow(f(b), t));
}

static double quadrature(factor_fn *f, double t, double a, double b, double tolerance, int depth) {
    double m = 0.5 * (a + b), whole = simpson(f, t, a, b);
    double left = simpson(f, t, a, m), right = simpson(f, t, m, b);
    if (depth == 0 || (depth < 35 && fabs(left + right - whole) <= 15 * tolerance)) {
        return left + right + (left + right - whole) / 15;
    }
    return quadrature(f, t, a, m, tolerance / 2, depth - 1) +
           quadrature(f, t, m, b, tolerance / 2, depth - 1);
}

// The width over which a jump of the function is spread, times what it jumps by, may be missing.
static void check_against_quadrature(factor_fn *f, double jump) {
    vn_domain *shape = box_of(-2, -3, 2, 7);
    vn_growth *growth = rerg_blade(shape, f, f, 8);
    vn_rng rng = vn_rng_make(7);
    for (int n = 0; n < 60; n++) {
        double t = n % 2 == 0 ? (double)whole(&rng, 0, 8) : uniform(&rng, 0, 8);
        double y0 = uniform(&rng, -3, 7), x0 = uniform(&rng, -2, 2), q[3], back[3];
        double height = quadrature(f, t, -3, 7, 1e-11, 40);
        double y = quadrature(f, t, 0, y0, 1e-11, 40);
        bool near_jump = jump > 0 && (fabs(y0 - 1) < 1e-3 || fabs(y0 - 4) < 1e-3);
        map_point(growth, x0, y0, 0, t, q);
        assert_near(q[1], y, 1e-6 * height + jump * 10.0 / SAMPLES);
        if (!near_jump) {
            assert_near(q[0], x0 * pow(f(y0), t), 1e-6 * height);
        }
        map_point(growth, q[0], q[1], t, 0, back);
        assert_near(back[0], x0, 1e-9);
        assert_near(back[1], y0, 1e-9);
    }
    vn_growth_release(growth);
    vn_domain_release(shape);
}

static void tables_are_what_quadrature_says(void **state) {
    (void)state;
    check_against_quadrature(tenth_more, 0);
    check_against_quadrature(smooth, 0);
    check_against_quadrature(shrinking, 0);
    check_against_quadrature(stairs, 2 * pow(1.5, 8));
}

static void assert_composes(vn_growth *growth, vn_rng *rng, double last, double tolerance) {
    for (int n = 0; n < 100; n++) {
        double p[3] = {uniform(rng, -3, 3), uniform(rng, -1, 8), 0}, a[3], b[3], c[3];
        double t0 = uniform(rng, 0, last), t1 = uniform(rng, 0, last), t2 = floor(uniform(rng, 0, last));
        t0 = n % 3 == 0 ? floor(t0) : t0;
        map_point(growth, p[0], p[1], 0, t0, a);
        map_point(growth, a[0], a[1], t0, t1, b);
        map_point(growth, b[0], b[1], t1, t2, c);
        map_point(growth, a[0], a[1], t0, t2, b);
        double size = 1 + hypot(b[0], b[1]);
        assert_near(c[0], b[0], tolerance * size);
        assert_near(c[1], b[1], tolerance * size);
        map_point(growth, a[0], a[1], t0, t0, b);
        assert_true(a[0] == b[0] && a[1] == b[1]);
    }
}

static void maps_compose(void **state) {
    (void)state;
    vn_domain *shape = cordate_shape(), *other = leaf_shape();
    vn_rng rng = vn_rng_make(3);
    vn_growth *growths[] = {uniform_blade(shape, 1.1, 0.95, 9), rerg_blade(shape, smooth, stairs, 9),
                            rerg_blade(shape, shrinking, smooth, 9), morph_blade(shape, other, 9)};
    for (int k = 0; k < 4; k++) {
        assert_composes(growths[k], &rng, 9, 1e-11);
        vn_growth_release(growths[k]);
    }
    vn_domain_release(shape);
    vn_domain_release(other);
}

// ---- Today's shape ----

// What is in today's shape was in the first one. Within 1e-4 of the border the polygon may say otherwise.
static void check_today(vn_growth *growth, const vn_domain *first, double tolerance) {
    vn_domain *today = vn_growth_domain(growth);
    vn_rng rng = vn_rng_make(11);
    vn_box b = vn_domain_bounds(today);
    int inside = 0, outside = 0;
    for (int n = 0; n < 400; n++) {
        double p[3] = {uniform(&rng, b.min[0], b.max[0]), uniform(&rng, b.min[1], b.max[1]), 0}, q[3], c[3];
        map_point(growth, p[0], p[1], vn_growth_time(growth), 0, q);
        bool in = vn_domain_contains(today, p);
        vn_domain_closest(today, p, c);
        assert_near(hypot(c[0] - p[0], c[1] - p[1]), fabs(vn_domain_distance(today, p)), 1e-12 * b.max[1]);
        if (fabs(vn_domain_distance(today, p)) > tolerance) {
            assert_int_equal(in, vn_domain_contains(first, q));
            inside += in;
            outside += !in;
        }
        map_point(growth, c[0], c[1], vn_growth_time(growth), 0, q);
        assert_near(vn_domain_distance(first, q), 0, tolerance);
    }
    assert_true(inside > 50 && outside > 50);
    assert_near(vn_growth_length(growth), b.max[1] - b.min[1], 0);
}

static double half_width(double y0) { // of leaf_shape(), as profile
    static const double half[] = {0, 2, 3, 3.2, 2.8, 1.8, 0.7, 0};
    int i = (int)fmin(floor(y0 / 12 * 7), 6);
    double s = y0 / 12 * 7 - i;
    return half[i] + s * (half[i + 1] - half[i]);
}

// Its area is ∫ 2 w(y₀) (f_x f_y)^t dy₀.
static void today_is_the_image_of_the_first_shape(void **state) {
    (void)state;
    enum { PARTS = 1 << 18 };
    vn_domain *shape = leaf_shape();
    vn_growth *growth = rerg_blade(shape, smooth, tenth_more, 6);
    do {
        double area = 0, t = vn_growth_time(growth);
        for (int i = 0; i < PARTS; i++) {
            double y0 = 12 * (i + 0.5) / PARTS;
            area += 2 * half_width(y0) * pow(smooth(y0) * tenth_more(y0), t) * 12 / PARTS;
        }
        assert_near(vn_domain_measure(vn_growth_domain(growth)), area, 2e-6 * area);
        check_today(growth, shape, 2e-3);
    } while (advance(growth));
    assert_int_equal(vn_growth_time(growth), 6);
    assert_near(vn_growth_length(growth), vn_growth_final_length(growth), 0);
    vn_growth_release(growth);
    vn_domain_release(shape);
}

static void lobes_below_the_petiole_grow_too(void **state) {
    (void)state;
    vn_domain *shape = cordate_shape();
    vn_growth *growths[] = {uniform_blade(shape, 1.05, 1.1, 5), rerg_blade(shape, smooth, stairs, 5)};
    for (int k = 0; k < 2; k++) {
        double p[3], q[3];
        vn_growth_origin(growths[k], p);
        while (advance(growths[k])) {
            check_today(growths[k], shape, 2e-3);
        }
        map_point(growths[k], p[0], p[1], 0, 5, q);
        assert_near(q[0], p[0], 1e-12);
        assert_near(q[1], p[1], 1e-12);
        vn_box b = vn_domain_bounds(vn_growth_domain(growths[k]));
        map_point(growths[k], 5, -2.5, 0, 5, q);
        assert_near(b.min[1], q[1], 1e-9);
        assert_true(b.min[1] < -1);
        vn_growth_release(growths[k]);
    }
    vn_domain_release(shape);
}

static void a_combination_follows_its_growing_operand(void **state) {
    (void)state;
    vn_domain *shape = box_of(-1, 0, 1, 4), *hole = disk_of(0, 2, 0.5), *rest = NULL;
    vn_growth *growth = uniform_blade(shape, 1.2, 1.1, 4);
    assert_ok(vn_domain_combine(&rest, vn_growth_domain(growth), hole, VN_DIFFERENCE));
    do {
        double t = vn_growth_time(growth);
        assert_near(vn_domain_measure(rest), 8 * pow(1.32, t) - pi / 4, 1e-6);
        assert_near(vn_domain_bounds(rest).max[0], pow(1.2, t), 1e-9);
    } while (advance(growth));
    vn_growth_release(growth);
    vn_domain_release(hole);
    vn_domain_release(rest);
    vn_domain_release(shape);
}

// ---- Morphs ----

static vn_domain *scaled_leaf(double scale) {
    double xy[28];
    vn_domain *shape = leaf_shape();
    vn_rings rings = {0};
    assert_ok(vn_domain_outline(shape, 8, &rings));
    int32_t count = rings.x.count;
    assert_true(count <= 14);
    for (int32_t i = 0; i < count; i++) {
        xy[2 * i] = scale * rings.x.data[i];
        xy[2 * i + 1] = scale * rings.y.data[i];
    }
    vn_domain_release(shape);
    vn_rings_free(&rings);
    return polygon_of(xy, count);
}

static void equal_outlines_move_nothing(void **state) {
    (void)state;
    vn_domain *shape = leaf_shape(), *same = leaf_shape();
    vn_growth *growth = morph_blade(shape, same, 5);
    vn_rng rng = vn_rng_make(4);
    for (int n = 0; n < 100; n++) {
        double x = uniform(&rng, -6, 6), y = uniform(&rng, -3, 15);
        assert_maps(growth, (double[]){x, y, x, y}, 0, 5, 0);
        assert_maps(growth, (double[]){x, y, x, y}, 3.5, 0, 0);
    }
    assert_near(vn_domain_measure(vn_growth_domain(growth)), vn_domain_measure(shape), 1e-9);
    vn_growth_release(growth);
    vn_domain_release(shape);
    vn_domain_release(same);
}

// Mean value coordinates reproduce affine maps; equal parts of the way stay equal when all is scaled alike.
static void a_scaled_outline_scales_the_tissue(void **state) {
    (void)state;
    vn_domain *shape = leaf_shape(), *big = scaled_leaf(2.5);
    vn_growth *growth = morph_blade(shape, big, 6);
    vn_rng rng = vn_rng_make(4);
    for (int n = 0; n < 100; n++) {
        double x = uniform(&rng, -4, 4), y = uniform(&rng, -1, 13), t = (double)whole(&rng, 0, 6);
        double s = 1 + 1.5 * t / 6;
        assert_maps(growth, (double[]){x, y, s * x, s * y}, 0, t, 1e-10);
    }
    while (advance(growth)) {
        check_today(growth, shape, 1e-3);
    }
    assert_near(vn_growth_length(growth), 30, 1e-9);
    vn_growth_release(growth);
    vn_domain_release(shape);
    vn_domain_release(big);
}

static void a_morph_takes_border_to_border(void **state) {
    (void)state;
    vn_domain *shape = leaf_shape(), *end = cordate_shape();
    vn_growth *growth = morph_blade(shape, end, 20);
    double area = vn_domain_measure(vn_growth_domain(growth));
    assert_near(area, vn_domain_measure(shape), 1e-9); // all its corners are there
    while (advance(growth)) {
        vn_domain *today = vn_growth_domain(growth);
        vn_rings rings = {0};
        assert_ok(vn_domain_outline(shape, 8, &rings));
        for (int32_t i = 0; i < rings.x.count; i++) {
            double q[3];
            map_point(growth, rings.x.data[i], rings.y.data[i], 0, vn_growth_time(growth), q);
            assert_near(vn_domain_distance(today, q), 0, 1e-9);
        }
        vn_rings_free(&rings);
        vn_rng rng = vn_rng_make(4);
        for (int n = 0; n < 100; n++) {
            double p[3], q[3];
            assert_ok(vn_domain_dart(shape, &rng, p));
            map_point(growth, p[0], p[1], 0, vn_growth_time(growth), q);
            assert_true(vn_domain_distance(today, q) > -1e-9);
        }
    }
    assert_near(vn_domain_measure(vn_growth_domain(growth)), vn_domain_measure(end), 1e-9);
    vn_growth_release(growth);
    vn_domain_release(shape);
    vn_domain_release(end);
}

// A hook that turns over to the other side meets itself on the way.
static void a_blade_that_would_cross_itself_stays_at_the_last_good_step(void **state) {
    (void)state;
    static const double hook[] = {0, 0, 10, 0, 10, 10, 2, 10, 2, 8, 8, 8, 8, 2, 0, 2};
    static const double turned[] = {0, 0, 10, 0, 10, 2, 2, 2, 2, 8, 8, 8, 8, 10, 0, 10};
    vn_domain *a = polygon_of(hook, 8), *b = polygon_of(turned, 8);
    vn_growth *growth = morph_blade(a, b, 30);
    bool growing = true;
    vn_status status = VN_OK;
    double area = 0;
    while (status == VN_OK && growing) {
        area = vn_domain_measure(vn_growth_domain(growth));
        status = vn_growth_advance(growth, &growing);
    }
    assert_int_equal(status, VN_INFEASIBLE);
    assert_false(growing);
    char part[80];
    snprintf(part, sizeof part, "morph: at step %d: the outline crosses itself near (",
             vn_growth_time(growth) + 1);
    assert_message(part);
    assert_true(vn_growth_time(growth) > 0);
    assert_true(vn_domain_measure(vn_growth_domain(growth)) == area);
    vn_network *network = network_of(2);
    put_root(network, 3, 1, 0);
    assert_ok(vn_growth_carry(growth, network));
    assert_true(vn_network_x(network)[0] == 3);
    assert_int_equal(vn_growth_advance(growth, &growing), VN_INFEASIBLE);
    vn_network_destroy(network);
    vn_growth_release(growth);
    vn_domain_release(a);
    vn_domain_release(b);
}

// ---- What makes no sense ----

static vn_status try_rerg(vn_rerg_def def) {
    vn_growth *growth = NULL;
    vn_status status = vn_growth_rerg(&growth, &def);
    assert_true((status == VN_OK) == (growth != NULL));
    vn_growth_release(growth);
    return status;
}

static void factors_that_are_none_are_refused(void **state) {
    (void)state;
    vn_domain *shape = box_of(-1, 0, 1, 4), *ball = ball_of(0, 0, 0, 1);
    double bad[][3] = {{1, 0, 1}, {1, 1, -2}, {NAN, 1, 1}, {1, INFINITY, 1}}, fine[] = {1, 2};
    static const char *const messages[] = {"rerg.y = 0 at height 2 above", "rerg.y = -2 at height 4 above",
                                           "nan at height 0 above", "inf at height 2 above"};
    vn_rerg_def def = vn_rerg_def_default();
    def.domain = shape;
    for (int k = 0; k < 4; k++) {
        def.y = bad[k];
        def.y_samples = 3;
        assert_int_equal(try_rerg(def), VN_INVALID);
        assert_message(messages[k]);
    }
    def.y_samples = 1;
    assert_int_equal(try_rerg(def), VN_INVALID);
    assert_message("2 or more");
    def.y = fine;
    def.y_samples = 2;
    assert_ok(try_rerg(def));
    def.steps = 0;
    assert_int_equal(try_rerg(def), VN_INVALID);
    assert_message("rerg.steps = 0");
    def.steps = 3000;
    assert_int_equal(try_rerg(def), VN_INFEASIBLE);
    assert_message("take fewer steps");
    def.steps = 3;
    def.domain = ball;
    assert_int_equal(try_rerg(def), VN_INVALID);
    assert_message("3 dimensions");
    vn_domain_release(shape);
    vn_domain_release(ball);
}

static void lengths_and_times_that_make_no_sense_are_refused(void **state) {
    (void)state;
    vn_domain *shape = leaf_shape();
    vn_growth *growth = NULL;
    vn_growth_def def = {.domain = shape, .from = 5, .to = 4};
    assert_int_equal(vn_growth_isogonic(&growth, &def), VN_INVALID);
    assert_message("isogonic.from = 5 must not be above isogonic.to = 4");
    def = (vn_growth_def){.domain = shape, .from = 1, .to = 2, .step = 1e-9};
    assert_int_equal(vn_growth_isogonic(&growth, &def), VN_INVALID);
    assert_message("more than 1e8 steps");
    vn_uniform_def wide = vn_uniform_def_default();
    wide.domain = shape;
    wide.x = 1e6;
    assert_int_equal(vn_growth_uniform(&growth, &wide), VN_INFEASIBLE);
    assert_message("out of range");
    assert_null(growth);
    growth = uniform_blade(shape, 1.1, 1.1, 3);
    double p[3] = {0, 0, 0}, nan[3] = {NAN, 0, 0}, q[3];
    assert_int_equal(vn_growth_map(growth, p, -1, 0, q), VN_INVALID);
    assert_message("the time -1");
    assert_int_equal(vn_growth_map(growth, p, 0, NAN, q), VN_INVALID);
    assert_int_equal(vn_growth_map(growth, nan, 0, 1, q), VN_INVALID);
    vn_growth *inner = NULL;
    def = (vn_growth_def){.domain = vn_growth_domain(growth)};
    assert_int_equal(vn_growth_isogonic(&inner, &def), VN_INVALID);
    assert_message("a growth of a growing domain");
    vn_growth_release(growth);
    vn_domain_release(shape);
}

static vn_status try_morph(vn_domain *a, vn_domain *b, int32_t count, int32_t steps) {
    vn_domain *domains[] = {a, b};
    vn_morph_def def = vn_morph_def_default();
    vn_growth *growth = NULL;
    def.domains = domains;
    def.count = count;
    def.steps = steps;
    vn_status status = vn_growth_morph(&growth, &def);
    vn_growth_release(growth);
    return status;
}

static void outlines_that_cannot_morph_are_refused(void **state) {
    (void)state;
    vn_domain *shape = leaf_shape(), *ball = ball_of(0, 0, 0, 1), *ring = NULL, *hole = disk_of(0, 5, 1);
    assert_ok(vn_domain_combine(&ring, shape, hole, VN_DIFFERENCE));
    assert_int_equal(try_morph(shape, shape, 1, 5), VN_INVALID);
    assert_message("2 or more");
    assert_int_equal(try_morph(shape, ball, 2, 5), VN_INVALID);
    assert_message("morph.domains[2]");
    assert_int_equal(try_morph(shape, ring, 2, 5), VN_INVALID);
    assert_message("has 2 outlines");
    assert_ok(try_morph(shape, hole, 2, 1));
    vn_growth *growth = morph_blade(shape, hole, 4);
    double p[3] = {0, 0, 0}, q[3];
    assert_int_equal(vn_growth_map(growth, p, 0, 4.5, q), VN_INVALID);
    assert_message("after its last step, 4");
    vn_growth_release(growth);
    vn_domain_release(shape);
    vn_domain_release(ball);
    vn_domain_release(ring);
    vn_domain_release(hole);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(a_shrinking_unit_is_a_growing_blade),
        counted_test(golden_cases_of_the_appendix),
        counted_test(tables_are_what_quadrature_says),
        counted_test(maps_compose),
        counted_test(today_is_the_image_of_the_first_shape),
        counted_test(lobes_below_the_petiole_grow_too),
        counted_test(a_combination_follows_its_growing_operand),
        counted_test(equal_outlines_move_nothing),
        counted_test(a_scaled_outline_scales_the_tissue),
        counted_test(a_morph_takes_border_to_border),
        counted_test(a_blade_that_would_cross_itself_stays_at_the_last_good_step),
        counted_test(factors_that_are_none_are_refused),
        counted_test(lengths_and_times_that_make_no_sense_are_refused),
        counted_test(outlines_that_cannot_morph_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
