// One node of a vessel at a time (Rauch & Harders 2021, Equations 1 to 4): golden values of READINGS, what
// wakes and ends, and bad input.
#include "vessels_support.h"

// An inter-node whose child carries so many tips.
static double lateral_angle(double kappa, int tips) {
    vn_network *net = vessel_of(2, kappa);
    vn_zone_shape zone;
    vn_perception perception = {90, true};
    int32_t node = put_child(net, put_root(net, 0, 0, 0), 1, 0, 0);
    int32_t child = put_child(net, node, 2, 0, 0);
    for (int i = 0; i < tips; i++) {
        put_child(net, child, 3, i, 0);
    }
    assert_ok(vn_network_zone(net, node, &perception, &zone));
    assert_int_equal(zone.kind, VN_ZONE_BELT);
    assert_near(zone.angle, branch_angle(pow(tips, 1 / kappa), 1, kappa), 1e-9);
    vn_network_destroy(net);
    return zone.angle;
}

static void test_angles_of_laterals(void **state) {
    (void)state;
    assert_near(lateral_angle(2.55, 1), 30.5556, 5e-5);
    assert_near(lateral_angle(2.55, 10), 57.8868, 5e-5);
    assert_near(lateral_angle(2.55, 100), 72.4, 0.05);
    assert_near(lateral_angle(2.1, 1), 14.6403, 5e-5);
    assert_near(lateral_angle(2.9, 1), 36.2496, 5e-5);
    assert_near(lateral_angle(3, 1), 37.4673, 5e-5);
    assert_near(lateral_angle(4, 1), 45, 1e-9);
    for (int tips = 1; tips < 600; tips += 37) { // past the table, and turning outwards all along
        assert_true(lateral_angle(2.55, tips + 1) > lateral_angle(2.55, tips));
        assert_true(lateral_angle(2.55, tips) < 90);
    }
}

static double bent_by(double bias, bool mean) {
    vn_network *net = vessel_of(2, 2.55);
    vn_attractors *a = attractors_of(2, 1);
    vn_extend_def grow = vn_extend_def_default();
    put_child(net, put_root(net, -1, 0, 0), 0, 0, 0);
    put_attractor(a, 3 * cos(10 / DEGREES), 3 * sin(10 / DEGREES), 0);
    put_attractor(a, 4 * cos(50 / DEGREES), 4 * sin(50 / DEGREES), 0);
    grow.bias = bias;
    grow.bias_mean = mean;
    grow_once(net, a, 120, &grow);
    assert_int_equal(vn_network_count(net), 3);
    double angle = atan2(vn_network_y(net)[2], vn_network_x(net)[2]) * DEGREES;
    vn_attractors_destroy(a);
    vn_network_destroy(net);
    return angle;
}

static void test_bias(void **state) {
    (void)state;
    assert_near(bent_by(0.5, false), 19.68, 0.005);
    assert_near(bent_by(0.5, true), 15, 1e-9);
    assert_near(bent_by(0, false), 30, 1e-9);
    assert_near(bent_by(1, false), 0, 1e-9);
}

static void test_forks_in_the_plane(void **state) {
    (void)state;
    static const double golden[][2] = {
        {2.1, 14.6403}, {2.55, 30.5556}, {2.9, 36.2496}, {3, 37.4673}, {4, 45}};
    for (int i = 0; i < 5; i++) {
        vn_network *net = vessel_of(2, golden[i][0]);
        vn_attractors *a = attractors_of(2, 1);
        vn_extend_def grow = vn_extend_def_default();
        put_child(net, put_root(net, -1, 0, 0), 0, 0, 0);
        put_attractor(a, 3, 2, 0);
        put_attractor(a, 3, -2, 0);
        grow.bifurcate = 33; // they deviate by 33.69°
        grow_once(net, a, 90, &grow);
        assert_int_equal(vn_network_count(net), 4);
        for (int node = 2; node < 4; node++) {
            assert_int_equal(vn_network_parent(net)[node], 1);
            assert_near(fabs(atan2(vn_network_y(net)[node], vn_network_x(net)[node])) * DEGREES, golden[i][1],
                        5e-5);
        }
        assert_true(vn_network_y(net)[2] * vn_network_y(net)[3] < 0);
        vn_attractors_destroy(a);
        vn_network_destroy(net);
    }
}

// One degree less spread than φ: the vessel goes on as one.
static void test_below_the_threshold(void **state) {
    (void)state;
    vn_network *net = vessel_of(2, 2.55);
    vn_attractors *a = attractors_of(2, 1);
    vn_extend_def grow = vn_extend_def_default();
    put_child(net, put_root(net, -1, 0, 0), 0, 0, 0);
    put_attractor(a, 3, 2, 0);
    put_attractor(a, 3, -2, 0);
    grow.bifurcate = 34;
    grow_once(net, a, 90, &grow);
    assert_int_equal(vn_network_count(net), 3);
    vn_attractors_destroy(a);
    vn_network_destroy(net);
}

static void test_fork_in_space(void **state) {
    (void)state;
    static const double drains[4][3] = {
        {.03, .01, .05}, {-.025, -.005, .045}, {.02, .012, .04}, {-.03, -.014, .05}};
    static const double golden[2][3] = {{-.481012, -.165932, .860868}, {.465283, .205958, .860868}};
    vn_network *net = vessel_of(3, 2.55);
    vn_attractors *a = attractors_of(3, 1);
    vn_extend_def grow = vn_extend_def_default();
    put_child(net, put_root(net, 0, 0, -1), 0, 0, 0);
    for (int i = 0; i < 4; i++) {
        put_attractor(a, drains[i][0], drains[i][1], drains[i][2]);
    }
    grow.bifurcate = 15;
    grow_once(net, a, 180, &grow);
    assert_int_equal(vn_network_count(net), 4);
    double p[2][3];
    place(net, 2, p[0]);
    place(net, 3, p[1]);
    int first = p[0][0] < 0 ? 0 : 1;
    for (int k = 0; k < 3; k++) {
        assert_near(p[first][k], golden[0][k], 1e-6);
        assert_near(p[1 - first][k], golden[1][k], 1e-6);
    }
    assert_near(angle_between(p[0], p[1]), 61.111157, 1e-6);
    vn_attractors_destroy(a);
    vn_network_destroy(net);
}

// A root looks all around, and has one child; with a heading it has a cone.
static void test_roots(void **state) {
    (void)state;
    vn_network *net = vessel_of(2, 2.55);
    vn_zone_shape zone;
    vn_perception perception = {90, true};
    double up[3] = {0, 2, 0}, nowhere[3] = {0, 0, 0};
    int32_t root = put_root(net, 0, 0, 0);
    assert_ok(vn_network_zone(net, root, &perception, &zone));
    assert_int_equal(zone.kind, VN_ZONE_BALL);
    assert_ok(vn_network_set_heading(net, root, up));
    assert_ok(vn_network_zone(net, root, &perception, &zone));
    assert_int_equal(zone.kind, VN_ZONE_CONE);
    assert_near(zone.direction[1], 1, 1e-15);
    assert_int_equal(vn_network_set_heading(net, root, nowhere), VN_INVALID);
    int32_t child = put_child(net, root, 0, 1, 0);
    assert_ok(vn_network_zone(net, root, &perception, &zone));
    assert_int_equal(zone.kind, VN_ZONE_NONE);
    assert_int_equal(vn_network_set_heading(net, child, up), VN_INVALID);
    vn_network_destroy(net);
}

// ---- What a second reader found ----

// No run goes on for ever: a drain that vessels circle is given up, whatever fills up around it.
static void test_every_run_ends(void **state) {
    (void)state;
    for (uint64_t seed = 1; seed <= 12; seed++) {
        vn_rng rng = vn_rng_make(seed);
        vn_network *net = vessel_of(2, 2.55);
        vn_attractors *a = attractors_of(2, (int64_t)seed);
        vn_extend_def grow = vn_extend_def_default();
        int calls = 0;
        put_root(net, 0, 0, 0);
        for (int i = 0; i < 3; i++) {
            put_attractor(a, uniform(&rng, -2, 2), uniform(&rng, -2, 2), 0);
        }
        grow.length = uniform(&rng, 0.3, 1.5);
        grow.bias = uniform(&rng, 0, 0.8);
        grow.bifurcate = 15;
        for (int32_t before = -1; before < vn_network_count(net) && calls < 2000; calls++) {
            vn_consume_def eat = {.distance = 0.05};
            int32_t consumed;
            before = vn_network_count(net);
            grow_once(net, a, uniform(&rng, 250, 360), &grow);
            assert_ok(vn_consume(a, net, &eat, &consumed));
        }
        assert_true(calls < 2000);
        vn_attractors_destroy(a);
        vn_network_destroy(net);
    }
}

static int32_t pairs_of(vn_attractors *a, vn_network *net, double angle) {
    vn_influence *f = NULL;
    vn_influence_def def = vn_influence_def_default();
    def.within = 10;
    def.perception = (vn_perception){angle, true};
    assert_ok(vn_influence_find(&f, a, net, &def));
    int32_t pairs = vn_influence_count(f);
    vn_influence_destroy(f);
    return pairs;
}

// A drain beside a vessel's direction is not perceived; once that turns, it is.
static void test_sleepers_wake(void **state) {
    (void)state;
    vn_network *net = vessel_of(2, 2.55), *other = vessel_of(2, 2.55);
    vn_attractors *a = attractors_of(2, 1);
    double right[3] = {1, 0, 0}, up[3] = {0, 1, 0}, beside[3] = {0.5, -0.6, 0};
    int32_t root = put_root(net, 0, 0, 0), consumed;
    put_attractor(a, 0, 2, 0);
    assert_ok(vn_network_set_heading(net, root, right));
    assert_int_equal(pairs_of(a, net, 60), 0);
    assert_ok(vn_network_set_heading(net, root, up));
    assert_int_equal(pairs_of(a, net, 60), 1);
    // Of another network in between, through a consume.
    put_child(other, put_root(other, 0, 1, 0), 0, 1.5, 0);
    assert_ok(vn_network_set_heading(net, root, right));
    assert_int_equal(pairs_of(a, net, 60), 0);
    vn_consume_def eat = {.distance = 0.01};
    assert_ok(vn_consume(a, other, &eat, &consumed));
    assert_int_equal(pairs_of(a, other, 60), 1);
    // An edge that is split off its line.
    int32_t tip = put_child(net, root, 1, 0, 0);
    vn_attractors *b = attractors_of(2, 1);
    put_attractor(b, 2, 1.5, 0);
    assert_int_equal(pairs_of(b, net, 100), 0);
    assert_ok(vn_network_split(net, tip, beside, NULL));
    assert_int_equal(pairs_of(b, net, 100), 1);
    vn_attractors_destroy(a);
    vn_attractors_destroy(b);
    vn_network_destroy(net);
    vn_network_destroy(other);
}

// What was found with other eyes is not grown by.
static void test_an_influence_of_other_eyes_is_refused(void **state) {
    (void)state;
    vn_network *net = vessel_of(2, 2.55);
    vn_attractors *a = attractors_of(2, 1);
    vn_influence *f = NULL, *g = NULL;
    vn_influence_def def = vn_influence_def_default();
    vn_extend_def grow = vn_extend_def_default();
    int32_t added, first;
    put_child(net, put_root(net, -1, 0, 0), 0, 0, 0);
    put_attractor(a, 1, 0.1, 0);
    def.perception.angle = 90;
    assert_ok(vn_influence_find(&f, a, net, &def));
    def.perception.angle = 1;
    assert_ok(vn_influence_find(&g, a, net, &def));
    assert_int_equal(vn_extend(net, f, &grow, &added, &first), VN_INVALID);
    assert_message("out of date");
    vn_influence_destroy(f);
    vn_influence_destroy(g);
    vn_attractors_destroy(a);
    vn_network_destroy(net);
}

// Drains at equal angles on both sides of an inter-node draw along it: the first-ranked one says where the
// lateral goes, and not always to the same side (R18).
static void test_the_first_ranked_decides_between_sides(void **state) {
    (void)state;
    int left = 0;
    for (int64_t seed = 1; seed <= 24; seed++) {
        vn_network *net = vessel_of(2, 2.55);
        vn_attractors *a = attractors_of(2, seed);
        vn_extend_def grow = vn_extend_def_default();
        int32_t node = put_child(net, put_root(net, -1, 0, 0), 0, 0, 0);
        put_child(net, node, 9, 0, 0);
        put_attractor(a, 2 * cos(40 / DEGREES), 2 * sin(40 / DEGREES), 0);
        put_attractor(a, 2 * cos(40 / DEGREES), -2 * sin(40 / DEGREES), 0);
        grow.bias = 0.8;
        grow_once(net, a, 60, &grow);
        assert_int_equal(vn_network_count(net), 4);
        left += vn_network_y(net)[3] > 0;
        vn_attractors_destroy(a);
        vn_network_destroy(net);
    }
    assert_true(left > 4 && left < 20);
}

// ---- Bad input ----

static void test_bad_input(void **state) {
    (void)state;
    vn_network *net = network_of(2);
    vn_attractors *a = attractors_of(2, 1);
    vn_influence *f = NULL;
    vn_influence_def def = vn_influence_def_default();
    vn_extend_def grow = vn_extend_def_default();
    vn_murray_def law = {.exponent = 5, .tip_radius = 1};
    int32_t added, first;
    put_root(net, 0, 0, 0);
    put_attractor(a, 0.5, 0, 0);
    def.perception.angle = 90;
    assert_int_equal(vn_influence_find(&f, a, net, &def), VN_INVALID);
    assert_message("Murray's law");
    assert_ok(vn_network_murray(net, &law));
    assert_int_equal(vn_influence_find(&f, a, net, &def), VN_INVALID);
    assert_message("murray.exponent = 5 must be above 2 and at most 4");
    law.exponent = 2;
    assert_ok(vn_network_murray(net, &law));
    assert_int_equal(vn_influence_find(&f, a, net, &def), VN_INVALID);
    law.exponent = 3;
    assert_ok(vn_network_murray(net, &law));
    def.mode = VN_RELATIVE;
    assert_int_equal(vn_influence_find(&f, a, net, &def), VN_INVALID);
    assert_message("nearest");
    def.mode = VN_NEAREST;
    def.perception.angle = 400;
    assert_int_equal(vn_influence_find(&f, a, net, &def), VN_INVALID);
    def.perception.angle = 0;
    assert_ok(vn_influence_find(&f, a, net, &def));
    grow.bias = 0.5;
    assert_int_equal(vn_extend(net, f, &grow, &added, &first), VN_INVALID);
    assert_message("perception");
    vn_influence_destroy(f);
    vn_attractors_destroy(a);
    vn_network_destroy(net);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(test_angles_of_laterals),
        counted_test(test_bias),
        counted_test(test_forks_in_the_plane),
        counted_test(test_below_the_threshold),
        counted_test(test_fork_in_space),
        counted_test(test_roots),
        counted_test(test_every_run_ends),
        counted_test(test_sleepers_wake),
        counted_test(test_an_influence_of_other_eyes_is_refused),
        counted_test(test_the_first_ranked_decides_between_sides),
        counted_test(test_bad_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
