// Domains: what each answers agrees with what it answers otherwise, and with darts thrown at it.
#include "support.h"

#include "domain/domain.h"
#include "growth/growth.h"

static const double pi = 3.141592653589793;

// ---- A menagerie ----

static vn_domain *holed(void) {
    static const double xy[] = {0, 0, 10, 0, 10, 8, 0, 8, 2, 2, 2, 6, 5, 6, 5, 2, 3, 3, 4, 3, 4, 4};
    static const int32_t sizes[] = {4, 4, 3}; // an island in the hole
    vn_domain *domain = NULL;
    assert_ok(vn_domain_polygon(&domain, xy, sizes, 3));
    return domain;
}

static vn_domain *leaf(void) {
    static const double half[] = {0, 2, 3, 3.2, 2.8, 1.8, 0.7, 0};
    vn_profile_def def = {.length = 12, .half_width = half, .samples = 8};
    vn_domain *domain = NULL;
    assert_ok(vn_domain_profile(&domain, &def));
    return domain;
}

static vn_domain *combined(vn_domain *a, vn_domain *b, vn_combination how) {
    vn_domain *domain = NULL;
    assert_ok(vn_domain_combine(&domain, a, b, how));
    vn_domain_release(a);
    vn_domain_release(b);
    return domain;
}

static vn_domain *grown(vn_domain *shape) {
    vn_growth_def def = {.domain = shape, .from = 3};
    vn_growth *growth = NULL;
    assert_ok(vn_growth_marginal(&growth, &def));
    vn_domain_release(shape);
    return vn_growth_domain(growth);
}

static vn_domain *still(vn_domain *shape) {
    vn_growth_def def = {.domain = shape};
    vn_growth *growth = NULL;
    assert_ok(vn_growth_none(&growth, &def));
    vn_domain_release(shape);
    return vn_growth_domain(growth);
}

enum { BEASTS = 23 };

static vn_domain *beast(int which) {
    switch (which) {
    case 0:
        return disk_of(1, 2, 3);
    case 1:
        return box_of(-1, -2, 3, 7);
    case 2:
        return ball_of(1, 2, 3, 2);
    case 3:
        return solid_box(0, 0, 0, 1, 2, 3);
    case 4:
        return holed();
    case 5:
        return leaf();
    case 6:
        return maple_shape();
    case 7:
        return comb_shape();
    case 8:
        return grown(disk_of(0, 4, 4));
    case 9:
        return still(u_shape());
    case 10:
    case 11:
    case 12:
        return combined(u_shape(), holed(), (vn_combination)(which - 10));
    case 13:
    case 14:
    case 15:
        return combined(u_shape(), disk_of(4, 5, 3.5), (vn_combination)(which - 13));
    case 16:
    case 17:
    case 18:
        return combined(disk_of(0, 0, 4), disk_of(2, 1, 3), (vn_combination)(which - 16));
    case 19:
    case 20:
    case 21:
        return combined(ball_of(0, 0, 0, 2), solid_box(-1, -1, 0, 1, 1, 3), (vn_combination)(which - 19));
    default:
        return combined(combined(maple_shape(), disk_of(0, 0, 2), VN_DIFFERENCE), disk_of(6, 0, 2), VN_UNION);
    }
}

static double size_of(const vn_domain *domain) {
    vn_box b = vn_domain_bounds(domain);
    return sqrt(vn_distance2(b.min, b.max));
}

static void place_near(const vn_domain *domain, vn_rng *rng, double p[3]) {
    vn_box b = vn_domain_bounds(domain);
    for (int k = 0; k < 3; k++) {
        double more = 0.3 * (b.max[k] - b.min[k]);
        p[k] = k < vn_domain_dim(domain) ? uniform(rng, b.min[k] - more, b.max[k] + more) : 0;
    }
}

// ---- Laws ----

static void distances_agree_with_everything_else(void **state) {
    (void)state;
    for (int which = 0; which < BEASTS; which++) {
        vn_domain *domain = beast(which);
        vn_rng rng = vn_rng_make((uint64_t)which);
        double before = 0, last[3] = {0}, least = 1e-9 * size_of(domain);
        for (int n = 0; n < 3000; n++) {
            double p[3], q[3];
            place_near(domain, &rng, p);
            double d = vn_domain_distance(domain, p);
            vn_domain_closest(domain, p, q);
            assert_near(sqrt(vn_distance2(p, q)), fabs(d), least);
            assert_true(fabs(d) < least || vn_domain_contains(domain, p) == (d > 0));
            if (n > 0) {
                assert_true(fabs(d - before) <= sqrt(vn_distance2(p, last)) + least);
            }
            before = d;
            memcpy(last, p, sizeof last);
        }
        vn_domain_release(domain);
    }
}

static void small_moves_change_distances_little(void **state) {
    (void)state;
    for (int which = 0; which < BEASTS; which++) {
        vn_domain *domain = beast(which);
        vn_rng rng = vn_rng_make(50 + (uint64_t)which);
        for (int n = 0; n < 1500; n++) {
            double p[3], q[3];
            place_near(domain, &rng, p);
            for (int k = 0; k < 3; k++) {
                double move = k < vn_domain_dim(domain) ? uniform(&rng, -1, 1) : 0;
                q[k] = p[k] + move * pow(10, (double)(n % 7) - 6);
            }
            double change = vn_domain_distance(domain, p) - vn_domain_distance(domain, q);
            assert_true(fabs(change) <= sqrt(vn_distance2(p, q)) + 1e-9 * size_of(domain));
        }
        vn_domain_release(domain);
    }
}

static void borders_of_simple_kinds_are_borders(void **state) {
    (void)state;
    for (int which = 0; which < 13; which++) { // whose distances are exact everywhere
        vn_domain *domain = beast(which);
        vn_rng rng = vn_rng_make(90 + (uint64_t)which);
        for (int n = 0; n < 500; n++) {
            double p[3], q[3];
            place_near(domain, &rng, p);
            vn_domain_closest(domain, p, q);
            assert_near(vn_domain_distance(domain, q), 0, 1e-9 * size_of(domain));
        }
        vn_domain_release(domain);
    }
}

// What is seen lies inside; what lies inside with some room is seen.
static void check_sight(const vn_domain *domain, const double a[3], const double b[3], double margin) {
    bool inside = true, clearly = true;
    for (int k = 0; k <= 200; k++) {
        double p[3];
        for (int c = 0; c < 3; c++) {
            p[c] = a[c] + k / 200.0 * (b[c] - a[c]);
        }
        double d = vn_domain_distance(domain, p);
        inside = inside && d > -margin;
        clearly = clearly && d > 0.01 * size_of(domain);
    }
    bool sees = vn_domain_sees(domain, a, b);
    assert_true(!sees || inside);
    assert_true(sees || !clearly);
    assert_int_equal(sees, vn_domain_sees(domain, b, a));
}

static void what_is_seen_lies_inside(void **state) {
    (void)state;
    for (int which = 0; which < BEASTS; which++) {
        vn_domain *domain = beast(which);
        vn_rng rng = vn_rng_make(200 + (uint64_t)which);
        for (int n = 0; n < 400; n++) {
            double a[3], b[3];
            place_near(domain, &rng, a);
            place_near(domain, &rng, b);
            if (n % 2 == 0) {
                assert_ok(vn_domain_dart(domain, &rng, a));
                assert_ok(vn_domain_dart(domain, &rng, b));
            }
            check_sight(domain, a, b, 2e-6 * size_of(domain));
        }
        vn_domain_release(domain);
    }
}

static double share_inside(const vn_domain *domain, uint64_t seed, int32_t darts, double *bounds) {
    vn_box b = vn_domain_bounds(domain);
    vn_rng rng = vn_rng_make(seed);
    int32_t hits = 0;
    *bounds = 1;
    for (int k = 0; k < vn_domain_dim(domain); k++) {
        *bounds *= b.max[k] - b.min[k];
    }
    for (int32_t n = 0; n < darts; n++) {
        double p[3] = {uniform(&rng, b.min[0], b.max[0]), uniform(&rng, b.min[1], b.max[1]), 0};
        p[2] = vn_domain_dim(domain) == 3 ? uniform(&rng, b.min[2], b.max[2]) : 0;
        hits += vn_domain_contains(domain, p);
    }
    return (double)hits / darts;
}

static void measures_are_what_darts_say(void **state) {
    (void)state;
    enum { DARTS = 100000 };
    for (int which = 0; which < BEASTS; which++) {
        vn_domain *domain = beast(which);
        double bounds;
        double share = share_inside(domain, 300 + (uint64_t)which, DARTS, &bounds);
        double sigma = sqrt(share * (1 - share) / DARTS);
        assert_near(vn_domain_measure(domain) / bounds, share, 5 * sigma + 1e-9);
        vn_domain_release(domain);
    }
}

static void measures_of_simple_shapes_are_exact(void **state) {
    (void)state;
    static const double expected[] = {9 * 3.141592653589793, 36, 32.0 / 3 * 3.141592653589793, 6,
                                      80 - 12 + 0.5};
    for (int which = 0; which < 5; which++) {
        vn_domain *domain = beast(which);
        assert_near(vn_domain_measure(domain), expected[which], 1e-9);
        vn_domain_release(domain);
    }
    vn_domain *ring = combined(disk_of(0, 0, 2), disk_of(0, 0, 1), VN_DIFFERENCE);
    assert_near(vn_domain_measure(ring), 3 * pi, 1e-5 * 3 * pi);
    vn_domain_release(ring);
}

// 8 × 8 cells of the bounds; those that lie wholly inside must get equal shares.
static void darts_are_spread_evenly(void **state) {
    (void)state;
    enum { DARTS = 40000, ACROSS = 8, CELLS = ACROSS * ACROSS };
    for (int which = 0; which < BEASTS; which++) {
        vn_domain *domain = beast(which);
        vn_box b = vn_domain_bounds(domain);
        vn_rng rng = vn_rng_make(400 + (uint64_t)which);
        int hits[CELLS] = {0}, reference[CELLS] = {0};
        int32_t thrown = 0;
        for (; thrown < 5 * DARTS; thrown++) {
            double p[3];
            bool dart = thrown < DARTS;
            if (dart) {
                assert_ok(vn_domain_dart(domain, &rng, p));
                assert_true(vn_domain_contains(domain, p));
            } else {
                place_near(domain, &rng, p);
            }
            int i = (int)floor((p[0] - b.min[0]) / (b.max[0] - b.min[0]) * ACROSS);
            int j = (int)floor((p[1] - b.min[1]) / (b.max[1] - b.min[1]) * ACROSS);
            if (vn_domain_contains(domain, p) && i >= 0 && j >= 0 && i < ACROSS && j < ACROSS) {
                ++*(dart ? &hits[j * ACROSS + i] : &reference[j * ACROSS + i]);
            }
        }
        double chi2 = 0, sum = 0;
        int free = 0;
        for (int c = 0; c < CELLS; c++) {
            sum += reference[c];
        }
        for (int c = 0; c < CELLS; c++) {
            double ratio = DARTS / sum; // the two counts are compared as two samples of one law
            double both = hits[c] + reference[c];
            free += both > 0;
            chi2 += both > 0 ? pow(hits[c] - ratio * reference[c], 2) / (ratio * both) : 0;
        }
        assert_true(chi2 < free + 5 * sqrt(2.0 * free));
        vn_domain_release(domain);
    }
}

static void combinations_are_what_their_names_say(void **state) {
    (void)state;
    for (int pairing = 0; pairing < 4; pairing++) {
        vn_domain *a = pairing < 2 ? u_shape() : disk_of(4, 4, 3);
        vn_domain *b = pairing % 2 == 0 ? holed() : disk_of(5, 6, 3);
        vn_rng rng = vn_rng_make((uint64_t)pairing);
        for (int how = VN_DIFFERENCE; how <= VN_INTERSECTION; how++) {
            vn_domain *c = NULL;
            assert_ok(vn_domain_combine(&c, a, b, (vn_combination)how));
            for (int n = 0; n < 4000; n++) {
                double p[3];
                place_near(a, &rng, p);
                bool in_a = vn_domain_contains(a, p), in_b = vn_domain_contains(b, p);
                bool expected =
                    how == VN_DIFFERENCE ? in_a && !in_b : (how == VN_UNION ? in_a || in_b : in_a && in_b);
                assert_int_equal(vn_domain_contains(c, p), expected);
            }
            vn_domain_release(c);
        }
        vn_domain_release(a);
        vn_domain_release(b);
    }
}

static void a_domain_lives_while_someone_holds_it(void **state) {
    (void)state;
    vn_domain *a = disk_of(0, 0, 2), *b = disk_of(1, 0, 2), *c = NULL;
    assert_ok(vn_domain_combine(&c, a, b, VN_UNION));
    vn_domain_release(a);
    vn_domain_release(b);
    double p[3] = {2.5, 0, 0};
    assert_true(vn_domain_contains(c, p));
    assert_ptr_equal(vn_domain_retain(c), c);
    vn_domain_release(c);
    assert_near(vn_domain_value(c, p), 1, 0);
    vn_domain_release(c);
    vn_domain_release(NULL);
}

// ---- Bad input ----

static void assert_bad_polygon(const double *xy, int32_t points, const char *says) {
    vn_domain *domain = (vn_domain *)&says;
    assert_int_equal(vn_domain_polygon(&domain, xy, &points, 1), VN_INVALID);
    assert_null(domain);
    assert_message(says);
    assert_null(strchr(vn_message(), '\n'));
}

static void bad_outlines_are_refused_with_a_remedy(void **state) {
    (void)state;
    static const double bow[] = {0, 0, 4, 4, 4, 0, 0, 4}, askew[] = {0, 0, 4, 4, 4, 0, 0, 3},
                        line[] = {0, 0, 1, 1, 2, 2};
    static const double nan[] = {0, 0, 1, NAN, 2, 2}, spike[] = {0, 0, 4, 0, 4, 3, 4, -2, 0, -2};
    static const double crossing[] = {0, 0, 4, 0, 4, 4, 0, 4, 2, 2, 6, 2, 6, 3, 2, 3};
    static const int32_t two[] = {4, 4};
    vn_domain *domain = NULL;
    assert_bad_polygon(bow, 4, "crosses itself near (2, 2)");
    assert_bad_polygon(askew, 4, "crosses itself near (1.71429, 1.71429)");
    assert_bad_polygon(line, 3, "has no area");
    assert_bad_polygon(nan, 3, "finite");
    assert_bad_polygon(bow, 2, "3 or more");
    assert_bad_polygon(spike, 5, "crosses itself");
    assert_int_equal(vn_domain_polygon(&domain, crossing, two, 2), VN_INVALID);
    assert_message("two outlines cross near (4,");
    assert_int_equal(vn_domain_polygon(&domain, crossing, two, 0), VN_INVALID);
    assert_message("3 points or more");
}

static void bad_numbers_are_refused_with_their_values(void **state) {
    (void)state;
    vn_domain *domain = NULL;
    static const double radii[] = {0, -2, NAN, INFINITY};
    for (int k = 0; k < 4; k++) {
        vn_disk_def def = {.radius = radii[k]};
        assert_int_equal(vn_domain_disk(&domain, &def), VN_INVALID);
        assert_message("disk.radius");
        assert_int_equal(vn_domain_sphere(&domain, &def), VN_INVALID);
        assert_null(domain);
    }
    vn_box_def box = {.min = {0, 3, 0}, .max = {1, 2, 0}, .dim = 2};
    assert_int_equal(vn_domain_box(&domain, &box), VN_INVALID);
    assert_message("box.max = 2");
    box.max[1] = NAN;
    assert_int_equal(vn_domain_box(&domain, &box), VN_INVALID);
    box.dim = 4;
    assert_int_equal(vn_domain_box(&domain, &box), VN_INVALID);
    assert_message("dimensions");
}

static void bad_profiles_are_refused(void **state) {
    (void)state;
    vn_domain *domain = NULL;
    static const double negative[] = {0, -1, 0}, pinched[] = {0, 1, 0, 1, 0}, nan[] = {0, NAN, 1};
    vn_profile_def def = {.length = 1, .half_width = negative, .samples = 3};
    assert_int_equal(vn_domain_profile(&domain, &def), VN_INVALID);
    assert_message("half_width = -1 at t = 0.5");
    def.half_width = nan;
    assert_int_equal(vn_domain_profile(&domain, &def), VN_INVALID);
    def.half_width = pinched;
    def.samples = 5;
    assert_int_equal(vn_domain_profile(&domain, &def), VN_INVALID);
    assert_message("closed at its ends only");
    def.samples = 2;
    assert_int_equal(vn_domain_profile(&domain, &def), VN_INVALID);
    assert_message("3 or more");
    def.length = -1;
    assert_int_equal(vn_domain_profile(&domain, &def), VN_INVALID);
    assert_message("profile.length = -1");
    assert_null(domain);
}

static void combinations_that_leave_nothing_are_infeasible(void **state) {
    (void)state;
    vn_domain *small = disk_of(0, 0, 1), *large = disk_of(0, 0, 2), *far = disk_of(9, 9, 1), *c = NULL;
    vn_domain *ball = ball_of(0, 0, 0, 1), *inner = box_of(1, 1, 2, 2), *outer = box_of(0, 0, 5, 5);
    assert_int_equal(vn_domain_combine(&c, small, large, VN_DIFFERENCE), VN_INFEASIBLE);
    assert_message("empty");
    assert_int_equal(vn_domain_combine(&c, small, far, VN_INTERSECTION), VN_INFEASIBLE);
    assert_int_equal(vn_domain_combine(&c, inner, outer, VN_DIFFERENCE), VN_INFEASIBLE);
    assert_int_equal(vn_domain_combine(&c, small, ball, VN_UNION), VN_INVALID);
    assert_message("2 dimensions");
    assert_null(c);
    vn_domain *all[] = {small, large, far, ball, inner, outer};
    for (int k = 0; k < 6; k++) {
        vn_domain_release(all[k]);
    }
}

// A petiole may lie anywhere on the border, on edges that contains() counts in and on those it counts out.
static void a_border_point_sees_into_the_shape(void **state) {
    (void)state;
    static const double square[] = {0, 0, 4, 0, 4, 4, 0, 4}, middle[3] = {2.1, 1.9, 0},
                        beyond[3] = {2.1, 9, 0};
    vn_domain *domain = polygon_of(square, 4);
    for (int side = 0; side < 4; side++) {
        for (int k = 0; k <= 8; k++) {
            double s = 0.5 * k, on[4][3] = {{s, 0, 0}, {4, s, 0}, {s, 4, 0}, {0, s, 0}};
            assert_true(vn_domain_sees(domain, on[side], middle));
            assert_true(vn_domain_sees(domain, middle, on[side]));
            assert_false(vn_domain_sees(domain, on[side], beyond));
        }
    }
    assert_false(vn_domain_sees(domain, beyond, middle));
    vn_domain_release(domain);
}

// ---- Growth ----

static void a_margin_passes_each_point_once(void **state) {
    (void)state;
    vn_domain *shape = disk_of(0, 4, 4);
    vn_growth_def def = {.domain = shape, .from = 0.5, .to = 10, .step = 0.3};
    vn_growth *growth = NULL;
    assert_ok(vn_growth_marginal(&growth, &def));
    vn_domain *today = vn_growth_domain(growth);
    vn_rng rng = vn_rng_make(2);
    do {
        double length = vn_growth_length(growth);
        vn_box b = vn_domain_bounds(today);
        assert_near(b.max[1] - b.min[1], length, 1e-12);
        assert_near(b.min[1], 0, 1e-4); // the petiole stays
        assert_near(vn_domain_measure(today), pi * length * length / 4, 1e-9);
        for (int n = 0; n < 300; n++) {
            double p[3] = {uniform(&rng, -5, 5), uniform(&rng, -0.5, 10.5), 0};
            double arrival = today->kind->margin->arrival(today, p);
            assert_int_equal(vn_domain_contains(today, p), length >= arrival);
        }
    } while (advance(growth));
    assert_true(vn_growth_length(growth) == 10);
    assert_int_equal(vn_growth_time(growth), 32);
    assert_false(advance(growth));
    assert_int_equal(vn_growth_time(growth), 32);
    vn_growth_release(growth);
    vn_domain_release(shape);
}

static void growth_ends_exactly_where_it_should(void **state) {
    (void)state;
    static const double cases[][3] = {{0, 0, 0},       {1, 7, 0.7}, {2, 2, 1},
                                      {0.1, 0.3, 0.1}, {3, 0, 100}, {0.1, 1, 0.3}};
    vn_domain *shape = leaf();
    for (int k = 0; k < 6; k++) {
        vn_growth_def def = {.domain = shape, .from = cases[k][0], .to = cases[k][1], .step = cases[k][2]};
        vn_growth *growth = NULL;
        int steps = 0;
        assert_ok(vn_growth_marginal(&growth, &def));
        double to = cases[k][1] > 0 ? cases[k][1] : 12, from = cases[k][0] > 0 ? cases[k][0] : to / 20;
        assert_true(vn_growth_length(growth) == from && vn_growth_final_length(growth) == to);
        while (advance(growth)) {
            steps++;
        }
        assert_true(vn_growth_length(growth) == to);
        assert_int_equal(vn_growth_time(growth), steps);
        assert_true(cases[k][2] > 0 || steps == 100);
        assert_true(vn_growth_unit(growth) == 1);
        vn_growth_release(growth);
    }
    vn_domain_release(shape);
}

static void a_domain_that_does_not_grow_stays(void **state) {
    (void)state;
    vn_domain *shape = leaf();
    vn_growth_def def = {.domain = shape};
    vn_growth *growth = NULL;
    assert_ok(vn_growth_none(&growth, &def));
    assert_false(advance(growth));
    assert_near(vn_growth_length(growth), 12, 0);
    assert_near(vn_domain_measure(vn_growth_domain(growth)), vn_domain_measure(shape), 0);
    vn_growth_release(growth);
    vn_domain_release(shape);
}

static vn_status try_marginal(vn_growth_def def) {
    vn_growth *growth = NULL;
    vn_status status = vn_growth_marginal(&growth, &def);
    vn_growth_release(growth);
    return status;
}

static void a_blade_that_growth_would_erode_is_refused(void **state) {
    (void)state;
    vn_domain *star = maple_shape(), *u = u_shape(), *hole = holed();
    assert_int_equal(try_marginal((vn_growth_def){.domain = u}), VN_INVALID);
    assert_message("origin");
    assert_int_equal(try_marginal((vn_growth_def){.domain = u, .has_origin = true, .origin = {1, 9, 0}}),
                     VN_INVALID);
    assert_int_equal(try_marginal((vn_growth_def){.domain = hole}), VN_INVALID);
    assert_int_equal(try_marginal((vn_growth_def){.domain = star}), VN_INVALID);
    assert_message("star-shaped");
    assert_ok(try_marginal((vn_growth_def){.domain = star, .has_origin = true}));
    assert_int_equal(try_marginal((vn_growth_def){.domain = star, .has_origin = true, .origin = {40, 0, 0}}),
                     VN_INVALID);
    vn_domain_release(star);
    vn_domain_release(u);
    vn_domain_release(hole);
}

// A notch of many short edges erodes as one of a few long ones does.
static void a_fine_outline_is_checked_like_a_coarse_one(void **state) {
    (void)state;
    enum { POINTS = 200000 };
    double *xy = malloc(2 * POINTS * sizeof *xy);
    assert_non_null(xy);
    for (int i = 0; i < POINTS; i++) {
        double angle = 2 * pi * i / POINTS, radius = 5 + sin(9 * angle);
        xy[2 * i] = radius * cos(angle);
        xy[2 * i + 1] = radius * sin(angle);
    }
    vn_domain *wavy = polygon_of(xy, POINTS);
    free(xy);
    assert_ok(try_marginal((vn_growth_def){.domain = wavy, .has_origin = true}));
    assert_int_equal(try_marginal((vn_growth_def){.domain = wavy, .has_origin = true, .origin = {4.5, 0, 0}}),
                     VN_INVALID);
    vn_domain_release(wavy);
}

static void lengths_that_make_no_sense_are_refused(void **state) {
    (void)state;
    vn_domain *shape = leaf();
    assert_int_equal(try_marginal((vn_growth_def){.domain = shape, .from = 5, .to = 4}), VN_INVALID);
    assert_message("marginal.from = 5");
    assert_int_equal(try_marginal((vn_growth_def){.domain = shape, .from = -1}), VN_INVALID);
    assert_int_equal(try_marginal((vn_growth_def){.domain = shape, .step = NAN}), VN_INVALID);
    assert_message("marginal.step");
    assert_int_equal(try_marginal((vn_growth_def){.domain = shape, .step = 1e-12}), VN_INVALID);
    assert_message("longer");
    vn_domain *ball = ball_of(0, 0, 0, 1);
    assert_int_equal(try_marginal((vn_growth_def){.domain = ball}), VN_INVALID);
    assert_message("of the plane");
    vn_domain_release(ball);
    vn_domain_release(shape);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(distances_agree_with_everything_else),
        counted_test(small_moves_change_distances_little),
        counted_test(borders_of_simple_kinds_are_borders),
        counted_test(what_is_seen_lies_inside),
        counted_test(measures_are_what_darts_say),
        counted_test(measures_of_simple_shapes_are_exact),
        counted_test(darts_are_spread_evenly),
        counted_test(combinations_are_what_their_names_say),
        counted_test(a_domain_lives_while_someone_holds_it),
        counted_test(bad_outlines_are_refused_with_a_remedy),
        counted_test(bad_numbers_are_refused_with_their_values),
        counted_test(bad_profiles_are_refused),
        counted_test(combinations_that_leave_nothing_are_infeasible),
        counted_test(a_border_point_sees_into_the_shape),
        counted_test(a_margin_passes_each_point_once),
        counted_test(growth_ends_exactly_where_it_should),
        counted_test(a_domain_that_does_not_grow_stays),
        counted_test(a_blade_that_growth_would_erode_is_refused),
        counted_test(a_fine_outline_is_checked_like_a_coarse_one),
        counted_test(lengths_that_make_no_sense_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
