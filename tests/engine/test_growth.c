// Growing blades: where tissue goes, what today's shape answers, and how networks and attractors are carried.
#include "support.h"

#include "growth/growth.h"
#include "network/network.h"

static const double pi = 3.14159265358979;

static vn_domain *leaf(void) {
    static const double half[] = {0, 2, 3, 3.2, 2.8, 1.8, 0.7, 0};
    vn_profile_def def = {.length = 12, .half_width = half, .samples = 8};
    vn_domain *domain = NULL;
    assert_ok(vn_domain_profile(&domain, &def));
    return domain;
}

// Its petiole is at (0, 0), and its lobes hang below.
static vn_domain *cordate(void) {
    static const double xy[] = {0, 0, 2, -2, 5, -2.5, 7, 1, 5, 6, 0, 11, -5, 6, -7, 1, -5, -2.5, -2, -2};
    return polygon_of(xy, 10);
}

static vn_growth *uniform_blade(vn_domain *domain, double x, double y, int32_t steps) {
    vn_uniform_def def = vn_uniform_def_default();
    vn_growth *growth = NULL;
    def.domain = domain;
    def.x = x;
    def.y = y;
    def.steps = steps;
    def.has_origin = true;
    assert_ok(vn_growth_uniform(&growth, &def));
    return growth;
}

// A function of the height at first, by which a blade grows.
typedef double factor_fn(double y0);

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

enum { SAMPLES = 16384 };

static vn_growth *rerg_blade(vn_domain *domain, factor_fn *fx, factor_fn *fy, int32_t steps) {
    vn_rerg_def def = vn_rerg_def_default();
    vn_growth *growth = NULL;
    double bottom, top, *x = malloc(SAMPLES * sizeof *x), *y = malloc(SAMPLES * sizeof *y);
    assert_true(x != NULL && y != NULL && def.samples == SAMPLES);
    def.domain = domain;
    def.has_origin = true;
    def.steps = steps;
    def.x = x;
    def.y = y;
    def.x_samples = def.y_samples = SAMPLES;
    assert_ok(vn_growth_heights(&def, &bottom, &top));
    for (int32_t i = 0; i < SAMPLES; i++) {
        double y0 = bottom + (top - bottom) * i / (SAMPLES - 1);
        x[i] = fx(y0);
        y[i] = fy(y0);
    }
    assert_ok(vn_growth_rerg(&growth, &def));
    free(x);
    free(y);
    return growth;
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

static void map(vn_growth *growth, double x, double y, double t1, double t2, double q[3]) {
    double p[3] = {x, y, 0};
    assert_ok(vn_growth_map(growth, p, t1, t2, q));
}

static void assert_maps(vn_growth *growth, const double at[4], double t1, double t2, double tolerance) {
    double q[3];
    map(growth, at[0], at[1], t1, t2, q);
    assert_near(q[0], at[2], tolerance);
    assert_near(q[1], at[3], tolerance);
}

// ---- Isogonic growth ----

// A blade that stays while the unit shrinks answers as one that is scaled, in units.
static void a_shrinking_unit_is_a_growing_blade(void **state) {
    (void)state;
    vn_domain *shape = leaf();
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
            map(still, p[0], p[1], 0, vn_growth_time(still), q);
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
        map(growth, x0, y0, 0, t, q);
        assert_near(q[1], y, 1e-6 * height + jump * 10.0 / SAMPLES);
        if (!near_jump) {
            assert_near(q[0], x0 * pow(f(y0), t), 1e-6 * height);
        }
        map(growth, q[0], q[1], t, 0, back);
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
        map(growth, p[0], p[1], 0, t0, a);
        map(growth, a[0], a[1], t0, t1, b);
        map(growth, b[0], b[1], t1, t2, c);
        map(growth, a[0], a[1], t0, t2, b);
        double size = 1 + hypot(b[0], b[1]);
        assert_near(c[0], b[0], tolerance * size);
        assert_near(c[1], b[1], tolerance * size);
        map(growth, a[0], a[1], t0, t0, b);
        assert_true(a[0] == b[0] && a[1] == b[1]);
    }
}

static void maps_compose(void **state) {
    (void)state;
    vn_domain *shape = cordate(), *other = leaf();
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
        map(growth, p[0], p[1], vn_growth_time(growth), 0, q);
        bool in = vn_domain_contains(today, p);
        vn_domain_closest(today, p, c);
        assert_near(hypot(c[0] - p[0], c[1] - p[1]), fabs(vn_domain_distance(today, p)), 1e-12 * b.max[1]);
        if (fabs(vn_domain_distance(today, p)) > tolerance) {
            assert_int_equal(in, vn_domain_contains(first, q));
            inside += in;
            outside += !in;
        }
        map(growth, c[0], c[1], vn_growth_time(growth), 0, q);
        assert_near(vn_domain_distance(first, q), 0, tolerance);
    }
    assert_true(inside > 50 && outside > 50);
    assert_near(vn_growth_length(growth), b.max[1] - b.min[1], 0);
}

static double half_width(double y0) { // of leaf(), as profile
    static const double half[] = {0, 2, 3, 3.2, 2.8, 1.8, 0.7, 0};
    int i = (int)fmin(floor(y0 / 12 * 7), 6);
    double s = y0 / 12 * 7 - i;
    return half[i] + s * (half[i + 1] - half[i]);
}

// Its area is ∫ 2 w(y₀) (f_x f_y)^t dy₀.
static void today_is_the_image_of_the_first_shape(void **state) {
    (void)state;
    enum { PARTS = 1 << 18 };
    vn_domain *shape = leaf();
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
    vn_domain *shape = cordate();
    vn_growth *growths[] = {uniform_blade(shape, 1.05, 1.1, 5), rerg_blade(shape, smooth, stairs, 5)};
    for (int k = 0; k < 2; k++) {
        double p[3], q[3];
        vn_growth_origin(growths[k], p);
        while (advance(growths[k])) {
            check_today(growths[k], shape, 2e-3);
        }
        map(growths[k], p[0], p[1], 0, 5, q);
        assert_near(q[0], p[0], 1e-12);
        assert_near(q[1], p[1], 1e-12);
        vn_box b = vn_domain_bounds(vn_growth_domain(growths[k]));
        map(growths[k], 5, -2.5, 0, 5, q);
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
    vn_domain *shape = leaf();
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
    vn_domain *shape = leaf(), *same = leaf();
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
    vn_domain *shape = leaf(), *big = scaled_leaf(2.5);
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
    vn_domain *shape = leaf(), *end = cordate();
    vn_growth *growth = morph_blade(shape, end, 20);
    double area = vn_domain_measure(vn_growth_domain(growth));
    assert_near(area, vn_domain_measure(shape), 1e-9); // all its corners are there
    while (advance(growth)) {
        vn_domain *today = vn_growth_domain(growth);
        vn_rings rings = {0};
        assert_ok(vn_domain_outline(shape, 8, &rings));
        for (int32_t i = 0; i < rings.x.count; i++) {
            double q[3];
            map(growth, rings.x.data[i], rings.y.data[i], 0, vn_growth_time(growth), q);
            assert_near(vn_domain_distance(today, q), 0, 1e-9);
        }
        vn_rings_free(&rings);
        vn_rng rng = vn_rng_make(4);
        for (int n = 0; n < 100; n++) {
            double p[3], q[3];
            assert_ok(vn_domain_dart(shape, &rng, p));
            map(growth, p[0], p[1], 0, vn_growth_time(growth), q);
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

// ---- Carrying ----

static double total_length(const vn_network *network) {
    vn_network_measures m;
    assert_ok(vn_network_measure(network, &m));
    return m.length;
}

static double longest_edge(const vn_network *network) {
    double longest = 0;
    for (int32_t i = 0; i < vn_network_count(network); i++) {
        double p[3], q[3];
        if (vn_network_parent(network)[i] >= 0) {
            vn_network_position(network, i, p);
            vn_network_position(network, vn_network_parent(network)[i], q);
            longest = fmax(longest, sqrt(vn_distance2(p, q)));
        }
    }
    return longest;
}

// Old nodes keep their numbers; the tree without the nodes that splitting put in is the tree before.
static void assert_same_tree(const vn_network *network, const int32_t *parent, int32_t count) {
    for (int32_t i = 0; i < count; i++) {
        int32_t above = vn_network_parent(network)[i];
        while (above >= count) {
            int32_t child = vn_network_first_child(network, above);
            assert_true(child >= 0 && vn_network_next_child(network, child) < 0);
            above = vn_network_parent(network)[above];
        }
        assert_int_equal(above, parent[i]);
    }
}

static void stretched_edges_are_split(void **state) {
    (void)state;
    vn_domain *shape = cordate();
    for (uint64_t seed = 0; seed < 4; seed++) {
        vn_growth *growth =
            seed < 2 ? uniform_blade(shape, 1.3, 1.2, 5) : rerg_blade(shape, smooth, smooth, 5);
        vn_network *network = random_tree(2, 60, 2, seed);
        vn_murray_def law = {.exponent = 2.5, .tip_radius = 0.5};
        assert_ok(vn_network_murray(network, &law));
        put_child(network, 5, 1, 1, 0); // a tip that waits to be told upwards
        while (advance(growth)) {
            int32_t count = vn_network_count(network), parent[5000], order;
            double x[5000], y[5000], radius[5000], length = 0;
            assert_true(count < 5000);
            for (int32_t i = 0; i < count; i++) {
                double q[3];
                map(growth, vn_network_x(network)[i], vn_network_y(network)[i], vn_growth_time(growth) - 1,
                    vn_growth_time(growth), q);
                parent[i] = vn_network_parent(network)[i];
                x[i] = q[0];
                y[i] = q[1];
                radius[i] = vn_network_radius(network, i);
            }
            for (int32_t i = 0; i < count; i++) {
                length += parent[i] >= 0 ? hypot(x[i] - x[parent[i]], y[i] - y[parent[i]]) : 0;
            }
            assert_ok(vn_growth_carry(growth, network));
            for (int32_t i = 0; i < count; i++) {
                assert_true(vn_network_x(network)[i] == x[i] && vn_network_y(network)[i] == y[i]);
                assert_true(vn_network_radius(network, i) == radius[i]);
            }
            assert_near(total_length(network), length, 1e-9 * length);
            assert_true(longest_edge(network) <= 2 * (1 + 1e-12));
            assert_same_tree(network, parent, count);
            uint64_t hash = network_hash(network);
            assert_ok(vn_growth_carry(growth, network));
            assert_true(network_hash(network) == hash); // once a step
            assert_ok(vn_network_set_orders(network, VN_HICKEY));
            order = vn_network_orders(network)[3];
            assert_true(order >= 1);
        }
        uint64_t hash = network_hash(network);
        assert_ok(vn_growth_carry(growth, network));
        assert_true(network_hash(network) == hash);
        vn_network_destroy(network);
        vn_growth_release(growth);
    }
    vn_domain_release(shape);
}

static void an_edge_is_cut_into_equal_parts(void **state) {
    (void)state;
    vn_domain *shape = box_of(-1, 0, 1, 4);
    vn_growth *growth = uniform_blade(shape, 1, 1.75, 3);
    vn_network *network = network_of(2);
    put_child(network, put_root(network, 0, 0, 0), 0, 4, 0);
    assert_true(advance(growth));
    assert_ok(vn_growth_carry(growth, network));
    assert_int_equal(vn_network_count(network), 5); // 7 long: four parts
    for (int32_t node = 1, k = 4; k > 0; k--, node = vn_network_parent(network)[node]) {
        assert_near(vn_network_y(network)[node], 1.75 * k, 1e-12);
    }
    vn_network_destroy(network);
    vn_growth_release(growth);
    vn_domain_release(shape);
}

static void isogonic_growth_splits_by_its_unit(void **state) {
    (void)state;
    vn_domain *shape = leaf();
    vn_growth_def def = {.domain = shape, .from = 12, .to = 48, .step = 12, .split = 3};
    vn_growth *growth = NULL;
    vn_network *network = network_of(2);
    put_child(network, put_root(network, 0, 0, 0), 0, 6, 0);
    assert_ok(vn_growth_isogonic(&growth, &def));
    for (int step = 1; advance(growth); step++) {
        assert_ok(vn_growth_carry(growth, network));
        assert_true(longest_edge(network) <= 3.0 / (step + 1));
        assert_near(total_length(network), 6, 1e-12);
    }
    assert_int_equal(vn_network_count(network), 9);
    assert_true(network->moved == 0);
    vn_network_destroy(network);
    vn_growth_release(growth);
    def.split = 0;
    network = network_of(2);
    put_child(network, put_root(network, 0, 0, 0), 0, 6, 0);
    assert_ok(vn_growth_isogonic(&growth, &def));
    while (advance(growth)) {
        assert_ok(vn_growth_carry(growth, network));
    }
    assert_int_equal(vn_network_count(network), 2);
    vn_network_destroy(network);
    vn_growth_release(growth);
    vn_domain_release(shape);
}

static void without_room_for_the_parts_nothing_moves(void **state) {
    (void)state;
    vn_domain *shape = box_of(-1, 0, 1, 40);
    vn_growth *growth = uniform_blade(shape, 1.5, 1.5, 3);
    vn_network_def def = {.dim = 2, .max_nodes = 5, .unit = ""};
    vn_network *network = NULL;
    assert_ok(vn_network_create(&network, &def));
    put_child(network, put_root(network, 1, 1, 0), 1, 30, 0);
    uint64_t hash = network_hash(network);
    assert_true(advance(growth));
    assert_int_equal(vn_growth_carry(growth, network), VN_LIMIT);
    assert_message("max_nodes = 5");
    assert_true(network_hash(network) == hash);
    vn_network_destroy(network);
    vn_network *solid = network_of(3);
    assert_int_equal(vn_growth_carry(growth, solid), VN_INVALID);
    assert_message("3 dimensions");
    vn_network_destroy(solid);
    vn_growth_release(growth);
    vn_domain_release(shape);
}

// ---- Attractors ----

static int32_t naive_nearest(const vn_network *network, const double p[3]) {
    int32_t best = 0;
    for (int32_t i = 1; i < vn_network_count(network); i++) {
        double a = hypot(vn_network_x(network)[i] - p[0], vn_network_y(network)[i] - p[1]);
        double b = hypot(vn_network_x(network)[best] - p[0], vn_network_y(network)[best] - p[1]);
        best = a < b ? i : best;
    }
    return best;
}

static void assert_nearest(vn_attractors *attractors, vn_network *network) {
    vn_influence_def def = vn_influence_def_default();
    vn_influence *influence = NULL;
    assert_ok(vn_influence_find(&influence, attractors, network, &def));
    assert_int_equal(vn_influence_count(influence), vn_attractors_count(attractors));
    for (int32_t k = 0; k < vn_influence_count(influence); k++) {
        double p[3];
        assert_ok(vn_attractors_position(attractors, vn_influence_attractor(influence, k), p));
        assert_int_equal(vn_influence_node(influence, k), naive_nearest(network, p));
    }
    vn_influence_destroy(influence);
}

static void assert_apart(vn_attractors *attractors, int32_t first, double spacing) {
    for (int32_t i = first; i < vn_attractors_count(attractors); i++) {
        for (int32_t j = 0; j < i; j++) {
            double p[3], q[3];
            assert_ok(vn_attractors_position(attractors, i, p));
            assert_ok(vn_attractors_position(attractors, j, q));
            assert_true(hypot(p[0] - q[0], p[1] - q[1]) > spacing);
        }
    }
}

static void attractors_move_with_the_tissue(void **state) {
    (void)state;
    vn_domain *shape = cordate();
    vn_growth *growth = rerg_blade(shape, smooth, smooth, 5);
    vn_attractors *attractors = attractors_of(2, 1);
    vn_network *network = random_tree(2, 70, 1, 3);
    vn_rng rng = vn_rng_make(5);
    vn_throw_def throw = {.domain = vn_growth_domain(growth), .count = 300, .spacing = 0.5, .rng = &rng};
    vn_consume_def consume = {.distance = 0.3};
    int32_t accepted, consumed;
    do {
        assert_ok(vn_throw(attractors, &throw, &accepted));
        assert_apart(attractors, vn_attractors_count(attractors) - accepted, 0.5);
        assert_nearest(attractors, network);
        assert_ok(vn_consume(attractors, network, &consume, &consumed));
        int32_t count = vn_attractors_count(attractors);
        double before[2000][3];
        assert_true(count < 2000);
        for (int32_t i = 0; i < count; i++) {
            assert_ok(vn_attractors_position(attractors, i, before[i]));
        }
        bool growing = advance(growth);
        for (int twice = 0; twice < 2; twice++) {
            assert_ok(vn_attractors_carry(attractors, growth));
            assert_ok(vn_growth_carry(growth, network));
        }
        assert_int_equal(vn_attractors_count(attractors), count);
        for (int32_t i = 0; i < count && growing; i++) {
            double p[3], q[3];
            assert_ok(vn_attractors_position(attractors, i, p));
            map(growth, before[i][0], before[i][1], vn_growth_time(growth) - 1, vn_growth_time(growth), q);
            assert_true(p[0] == q[0] && p[1] == q[1]);
        }
        assert_nearest(attractors, network);
    } while (!vn_growth_is_grown(growth));
    assert_int_equal(vn_growth_time(growth), 5);
    vn_attractors_destroy(attractors);
    vn_network_destroy(network);
    vn_growth_release(growth);
    vn_domain_release(shape);
}

// Veins on a pane of glass over the tissue.
static void attractors_may_move_alone(void **state) {
    (void)state;
    vn_domain *shape = box_of(-3, 0, 3, 5);
    vn_growth *growth = uniform_blade(shape, 1.4, 1.2, 3);
    vn_attractors *attractors = attractors_of(2, 1);
    vn_network *network = random_tree(2, 300, 1, 3);
    vn_rng rng = vn_rng_make(5);
    vn_throw_def throw = {.domain = shape, .count = 200, .rng = &rng};
    int32_t accepted;
    assert_ok(vn_throw(attractors, &throw, &accepted));
    do {
        assert_nearest(attractors, network);
        assert_ok(vn_attractors_carry(attractors, growth));
    } while (advance(growth));
    assert_true(network->moved == 0);
    vn_attractors_destroy(attractors);
    vn_network_destroy(network);
    vn_growth_release(growth);
    vn_domain_release(shape);
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
    vn_domain *shape = leaf();
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
    vn_domain *shape = leaf(), *ball = ball_of(0, 0, 0, 1), *ring = NULL, *hole = disk_of(0, 5, 1);
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

// ---- Memory ----

static vn_status grow_once(vn_domain *shape, vn_domain *other, vn_network *network, int kind) {
    vn_growth *growth = NULL;
    vn_rerg_def rerg = vn_rerg_def_default();
    vn_domain *domains[] = {shape, other};
    vn_morph_def morph = vn_morph_def_default();
    bool growing;
    morph.domains = domains;
    morph.count = 2;
    rerg.domain = shape;
    vn_status status = kind == 0 ? vn_growth_rerg(&growth, &rerg) : vn_growth_morph(&growth, &morph);
    status = status == VN_OK ? vn_growth_advance(growth, &growing) : status;
    status = status == VN_OK ? vn_growth_carry(growth, network) : status;
    vn_growth_release(growth);
    return status;
}

static void no_memory_leaves_nothing_behind(void **state) {
    (void)state;
    vn_domain *shape = leaf(), *other = cordate();
    for (int kind = 0; kind < 2; kind++) {
        vn_status status = VN_NO_MEMORY;
        int64_t n = 0;
        for (; status != VN_OK; n++) {
            vn_network *network = random_tree(2, 50, 1, 3);
            uint64_t hash = network_hash(network);
            size_t bytes = vn_byte_count();
            vn_fail_allocations_from(n);
            status = grow_once(shape, other, network, kind);
            vn_fail_allocations_from(-1);
            if (status != VN_OK) {
                assert_int_equal(status, VN_NO_MEMORY);
                assert_true(network_hash(network) == hash);
            }
            assert_true(vn_byte_count() <= bytes + 100000);
            vn_network_destroy(network);
        }
        assert_true(n > 20);
    }
    vn_domain_release(shape);
    vn_domain_release(other);
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
        counted_test(stretched_edges_are_split),
        counted_test(an_edge_is_cut_into_equal_parts),
        counted_test(isogonic_growth_splits_by_its_unit),
        counted_test(without_room_for_the_parts_nothing_moves),
        counted_test(attractors_move_with_the_tissue),
        counted_test(attractors_may_move_alone),
        counted_test(factors_that_are_none_are_refused),
        counted_test(lengths_and_times_that_make_no_sense_are_refused),
        counted_test(outlines_that_cannot_morph_are_refused),
        counted_test(no_memory_leaves_nothing_behind),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
