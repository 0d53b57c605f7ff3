// Shells of any domain, flat and solid.
#include "mesh_support.h"

#include "domain/domain.h"
#include "growth/growth.h"

static vn_domain *shell_of(vn_domain *domain, double thickness) {
    vn_shell_def def = vn_shell_def_default();
    vn_domain *shell;
    def.domain = domain;
    def.thickness = thickness;
    assert_ok(vn_domain_shell(&shell, &def));
    return shell;
}

// Both borders of a ball's shell are spheres: every answer is exact.
static void the_shell_of_a_ball_lies_between_two_spheres(void **state) {
    (void)state;
    vn_domain *ball = ball_of(1, 2, 3, 5), *shell = shell_of(ball, 1.5);
    double volume = 4 * pi / 3 * (125 - 3.5 * 3.5 * 3.5), center[3] = {1, 2, 3};
    vn_rng rng = vn_rng_make(10);
    assert_near(vn_domain_measure(shell), volume, 2e-3 * volume);
    for (int trial = 0; trial < 5000; trial++) {
        double p[3], q[3];
        for (int k = 0; k < 3; k++) {
            p[k] = center[k] + uniform(&rng, -7, 7);
        }
        double r = sqrt(vn_distance2(p, center)), distance = fmin(5 - r, r - 3.5);
        assert_near(vn_domain_distance(shell, p), distance, 1e-12);
        assert_int_equal(vn_domain_contains(shell, p), distance > 0);
        vn_domain_closest(shell, p, q);
        assert_near(sqrt(vn_distance2(p, q)), fabs(distance), 1e-12);
        assert_near(sqrt(vn_distance2(q, center)), distance == r - 3.5 || r < 3.5 ? 3.5 : 5, 1e-12);
        assert_ok(vn_domain_dart(shell, &rng, p));
        assert_true(vn_domain_contains(shell, p));
    }
    double left[3] = {-3, 2, 3}, right[3] = {5, 2, 3}, near[3] = {-3, 3, 3};
    assert_false(vn_domain_sees(shell, left, right));
    assert_true(vn_domain_sees(shell, left, near));
    vn_domain_release(ball);
    vn_domain_release(shell);
}

// The slow distance, to many points of both borders, is never below what the shell says.
static void the_shell_of_a_box_never_says_too_far(void **state) {
    (void)state;
    vn_domain *box = box_of(0, 0, 10, 6), *shell = shell_of(box, 2), *inner = box_of(2, 2, 8, 4);
    vn_rng rng = vn_rng_make(11);
    assert_near(vn_domain_measure(shell), 60 - 12, 1e-6);
    for (int trial = 0; trial < 5000; trial++) {
        double p[3] = {uniform(&rng, -1, 11), uniform(&rng, -1, 7), 0};
        double outer = vn_domain_distance(box, p), core = vn_domain_distance(inner, p);
        double distance = vn_domain_distance(shell, p), truly = fmin(outer, -core);
        assert_int_equal(distance > 0, outer > 0 && core < 0);
        assert_true(fabs(distance) <= fabs(truly) + 1e-12);
        if (!(outer > 0 && core < 0) || (p[0] > 2 && p[0] < 8)) {
            assert_near(distance, truly, 1e-12);
        }
    }
    vn_domain_release(box);
    vn_domain_release(inner);
    vn_domain_release(shell);
}

// Flat ones have an outline, so that they are drawn and combined.
static void flat_shells_are_cut_out(void **state) {
    (void)state;
    vn_domain *disk = disk_of(3, 4, 2), *ring = shell_of(disk, 0.5), *u = u_shape(),
              *lining = shell_of(u, 0.5);
    vn_domain *half, *right = box_of(3, 0, 9, 9), *whole = shell_of(disk, 7);
    assert_near(vn_domain_measure(ring), pi * (4 - 2.25), 1e-4);
    assert_near(vn_domain_measure(whole), 4 * pi, 1e-4);
    // The U less a strip of 0.5 along its length of 54; four hollow corners would count twice, of which two
    // are round.
    double core = 0;
    vn_rings rings = {0};
    assert_ok(vn_domain_outline(lining, 64, &rings));
    assert_int_equal(rings.ends.count, 2);
    for (int32_t i = 0; i < 2; i++) {
        core += vn_rings_area_of(&rings, i);
    }
    assert_near(core, vn_domain_measure(lining), 1e-9);
    assert_near(core, vn_domain_measure_by_points(lining), 0.05);
    vn_rings_free(&rings);
    assert_ok(vn_domain_combine(&half, ring, right, VN_INTERSECTION));
    assert_near(vn_domain_measure(half), pi * (4 - 2.25) / 2, 1e-4);
    vn_domain *all[] = {disk, ring, u, lining, half, right, whole};
    for (int i = 0; i < 7; i++) {
        vn_domain_release(all[i]);
    }
}

static void the_shell_of_a_growing_blade_grows(void **state) {
    (void)state;
    vn_domain *disk = disk_of(0, 0, 1);
    vn_growth *growth = uniform_blade(disk, 1.5, 1.5, 3);
    vn_domain *blade = vn_growth_domain(growth), *ring = shell_of(blade, 0.5);
    for (int step = 0; step < 3; step++) {
        double radius = pow(1.5, step), p[3] = {0.9 * radius, 0, 0};
        assert_near(vn_domain_measure(ring), pi * (radius * radius - (radius - 0.5) * (radius - 0.5)), 1e-3);
        assert_near(vn_domain_bounds(ring).max[0], radius, 1e-3);
        assert_int_equal(vn_domain_contains(ring, p), 0.1 * radius < 0.5);
        assert_true(advance(growth));
    }
    vn_domain_release(blade);
    vn_domain_release(ring);
    vn_domain_release(disk);
}

static void shells_that_cannot_be_are_refused(void **state) {
    (void)state;
    vn_domain *ball = ball_of(0, 0, 0, 1), *surface, *shell;
    vn_shell_def def = {.domain = ball, .thickness = 0};
    assert_int_equal(vn_domain_shell(&shell, &def), VN_INVALID);
    assert_message("shell.thickness = 0 must be above 0");
    def.thickness = NAN;
    assert_int_equal(vn_domain_shell(&shell, &def), VN_INVALID);
    def.thickness = 1e-12;
    assert_int_equal(vn_domain_shell(&shell, &def), VN_INFEASIBLE);
    assert_message("shell.thickness = 1e-12 is too thin");
    mesh m = box_mesh(0, 1);
    assert_ok(vn_domain_surface(&surface, m.xyz.data, 8, m.corners.data, 12));
    def = (vn_shell_def){.domain = surface, .thickness = 0.1};
    assert_int_equal(vn_domain_shell(&shell, &def), VN_INVALID);
    assert_message("shell.domain is a surface");
    vn_domain_release(surface);
    vn_domain_release(ball);
    free_mesh(&m);
}

// As in the paper's Figure 6: a thick shell of an organ.
static void the_shell_of_a_liver_is_hollow(void **state) {
    (void)state;
    vn_domain *organ = liver(), *shell = shell_of(organ, 5);
    vn_rng rng = vn_rng_make(12);
    double core = 0, volume = vn_domain_measure(organ);
    enum { DARTS = 20000 };
    for (int i = 0; i < DARTS; i++) {
        double p[3], depth;
        assert_ok(vn_domain_dart(organ, &rng, p));
        depth = vn_domain_distance(organ, p);
        assert_int_equal(vn_domain_contains(shell, p), depth <= 5);
        assert_near(vn_domain_distance(shell, p), fmin(depth, 5 - depth), 1e-12);
        core += depth > 5;
    }
    assert_near(vn_domain_measure(shell), volume * (1 - core / DARTS), 0.02 * volume);
    assert_near(vn_domain_measure(shell), 0.35 * volume, 0.1 * volume);
    vn_domain_release(organ);
    vn_domain_release(shell);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(the_shell_of_a_ball_lies_between_two_spheres),
        counted_test(the_shell_of_a_box_never_says_too_far),
        counted_test(flat_shells_are_cut_out),
        counted_test(the_shell_of_a_growing_blade_grows),
        counted_test(shells_that_cannot_be_are_refused),
        counted_test(the_shell_of_a_liver_is_hollow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
