// Masks of voxels as domains, against the plain search over all voxels.
#include "support.h"

#include "domain/rings.h"
#include "domain/voxels.h"

enum { MOST = 12 };

/// A mask that the oracle can walk over.
typedef struct grid {
    int32_t size[3];
    double m[3][4]; ///< from voxels to the world
    int dim;
    bool set[MOST][MOST][MOST];
} grid;

static grid grid_of(int dim, int32_t nx, int32_t ny, int32_t nz) {
    grid g = {.size = {nx, ny, nz}, .dim = dim};
    for (int k = 0; k < 3; k++) {
        g.m[k][k] = 1;
    }
    return g;
}

static vn_volume volume_of(const grid *g) {
    static const double unit[3] = {1, 1, 1}, origin[3] = {0};
    vn_volume volume;
    assert_ok(vn_volume_init(&volume, VN_VOXEL_U8, g->size, unit, origin));
    memcpy(volume.to_world, g->m, sizeof g->m);
    for (int32_t k = 0; k < g->size[2]; k++) {
        for (int32_t j = 0; j < g->size[1]; j++) {
            for (int32_t i = 0; i < g->size[0]; i++) {
                ((uint8_t *)volume.data)[i + g->size[0] * (j + g->size[1] * k)] = g->set[i][j][k];
            }
        }
    }
    return volume;
}

static vn_status try_domain(vn_domain **out, const grid *g, vn_parts parts) {
    vn_volume volume = volume_of(g);
    vn_mask mask = {.dim = g->dim, .threshold = 0.5, .scale = 1, .parts = parts, .what = "mask"};
    vn_status status = vn_domain_voxels(out, &volume, &mask);
    assert_null(volume.data);
    assert_true((*out == NULL) == (status != VN_OK));
    return status;
}

static vn_domain *domain_of(const grid *g) {
    vn_domain *domain;
    assert_ok(try_domain(&domain, g, VN_PARTS_ALL));
    return domain;
}

static void to_world(const grid *g, const double u[3], double p[3]) {
    for (int r = 0; r < 3; r++) {
        p[r] = g->m[r][3];
        for (int a = 0; a < 3; a++) {
            p[r] += g->m[r][a] * (u[a] - 0.5);
        }
    }
    if (g->dim == 2) {
        p[2] = 0;
    }
}

static double side_of(const grid *g, int a) {
    return sqrt(g->m[0][a] * g->m[0][a] + g->m[1][a] * g->m[1][a] + g->m[2][a] * g->m[2][a]);
}

static bool set_at(const grid *g, int32_t i, int32_t j, int32_t k) {
    bool exists = i >= 0 && j >= 0 && k >= 0 && i < g->size[0] && j < g->size[1] && k < g->size[2];
    return exists && g->set[i][j][k];
}

static double gap_to(const grid *g, const double u[3], const int32_t cell[3]) {
    double sum = 0;
    for (int a = 0; a < (g->dim == 2 ? 2 : 3); a++) {
        double gap = fmax(fmax(cell[a] - u[a], u[a] - cell[a] - 1), 0) * side_of(g, a);
        sum += gap * gap;
    }
    return sqrt(sum);
}

// The least distance from u to a voxel of the other kind; beyond the grid there is a layer of background.
static double distance_by_all(const grid *g, const double u[3]) {
    bool inside =
        set_at(g, (int32_t)floor(u[0]), (int32_t)floor(u[1]), g->dim == 2 ? 0 : (int32_t)floor(u[2]));
    double least = INFINITY;
    int32_t c[3], z = g->dim == 2 ? 0 : 1;
    for (c[2] = -z; c[2] < g->size[2] + z; c[2]++) {
        for (c[1] = -1; c[1] <= g->size[1]; c[1]++) {
            for (c[0] = -1; c[0] <= g->size[0]; c[0]++) {
                if (set_at(g, c[0], c[1], c[2]) != inside) {
                    least = fmin(least, gap_to(g, u, c));
                }
            }
        }
    }
    return inside ? least : -least;
}

static void check_point(const grid *g, const vn_domain *domain, const double u[3]) {
    double p[3], q[3];
    to_world(g, u, p);
    double expected = distance_by_all(g, u), found = vn_domain_distance(domain, p);
    vn_domain_closest(domain, p, q);
    assert_near(fabs(found), fabs(expected), 1e-11 * (1 + fabs(expected)));
    assert_near(hypot(hypot(p[0] - q[0], p[1] - q[1]), g->dim == 3 ? p[2] - q[2] : 0), fabs(found),
                1e-11 * (1 + fabs(expected)));
    assert_near(vn_domain_distance(domain, q), 0, 1e-12 * 30);
    assert_true(vn_domain_contains(domain, p) ==
                (found > 0 || (found == 0 && vn_domain_contains(domain, p))));
    if (fabs(expected) > 1e-9) {
        assert_true(vn_domain_contains(domain, p) == (expected > 0));
        assert_true(vn_domain_value(domain, p) == (expected > 0 ? 1 : 0));
    }
}

// At random, and where voxels meet.
static void check_grid(const grid *g, uint64_t seed, int points) {
    vn_rng rng = vn_rng_make(seed);
    vn_domain *domain = domain_of(g);
    double voxels = 0, measure = 1;
    for (int i = 0; i < points; i++) {
        double u[3];
        for (int a = 0; a < 3; a++) {
            u[a] = uniform(&rng, -3, g->size[a] + 3);
            u[a] = i % 3 == 1 ? floor(u[a] * 2) / 2 : u[a];
            u[a] = i % 7 == 1 ? fmin(fmax(u[a], 0), g->size[a]) : u[a];
        }
        u[2] = g->dim == 2 ? 0.5 : u[2];
        check_point(g, domain, u);
    }
    for (int32_t n = 0; n < MOST * MOST * MOST; n++) {
        voxels += set_at(g, n % MOST, n / MOST % MOST, n / MOST / MOST);
    }
    for (int a = 0; a < g->dim; a++) {
        measure *= side_of(g, a);
    }
    assert_near(vn_domain_measure(domain), voxels * measure, 1e-12 * voxels * measure);
    vn_domain_release(domain);
}

static void fill(grid *g, vn_rng *rng, double share) {
    for (int32_t k = 0; k < g->size[2]; k++) {
        for (int32_t j = 0; j < g->size[1]; j++) {
            for (int32_t i = 0; i < g->size[0]; i++) {
                g->set[i][j][k] = uniform(rng, 0, 1) < share;
            }
        }
    }
    g->set[whole(rng, 0, g->size[0] - 1)][0][0] = true;
}

// Permuted, mirrored and stretched axes.
static void place_at_random(grid *g, vn_rng *rng) {
    int32_t first = (int32_t)whole(rng, 0, g->dim - 1), turn = (int32_t)whole(rng, 1, 2);
    memset(g->m, 0, sizeof g->m);
    for (int a = 0; a < 3; a++) {
        int row = g->dim == 3 ? (first + turn * a) % 3 : a < 2 ? (first + a) % 2 : 2;
        g->m[row][a] = (whole(rng, 0, 1) ? 1 : -1) * uniform(rng, 0.2, 3);
        g->m[a][3] = uniform(rng, -20, 20);
    }
    g->m[2][3] = g->dim == 2 ? 0 : g->m[2][3];
}

// By an angle about an axis through all three.
static void turn_at_random(grid *g, vn_rng *rng) {
    double turned[3][3], angle = uniform(rng, 0, 6), c = cos(angle), s = sin(angle),
                         n[3] = {2. / 7, 3. / 7, 6. / 7};
    for (int r = 0; r < 3; r++) {
        for (int a = 0; a < 3; a++) {
            int third = 3 - r - a;
            double sign = (a + 1) % 3 == r ? 1 : -1;
            turned[r][a] = (1 - c) * n[r] * n[a] + (r == a ? c : sign * s * n[third % 3]);
        }
    }
    for (int a = 0; a < 3; a++) {
        double side = uniform(rng, 0.3, 2);
        for (int r = 0; r < 3; r++) {
            g->m[r][a] = turned[r][a] * side;
        }
    }
}

static void distances_are_those_of_the_plain_search(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(7);
    static const double shares[] = {0.02, 0.2, 0.5, 0.9, 0.995, 1};
    for (int round = 0; round < 120; round++) {
        int dim = round % 2 ? 3 : 2;
        grid g = grid_of(dim, (int32_t)whole(&rng, 1, MOST), (int32_t)whole(&rng, 1, MOST),
                         dim == 3 ? (int32_t)whole(&rng, 1, MOST) : 1);
        fill(&g, &rng, shares[round / 2 % 6]);
        if (round % 5 > 1) {
            place_at_random(&g, &rng);
        }
        if (dim == 3 && round % 5 == 3) {
            turn_at_random(&g, &rng);
        }
        check_grid(&g, (uint64_t)round, 150);
    }
}

static void shells_sheets_and_single_voxels_are_measured(void **state) {
    (void)state;
    for (int shape = 0; shape < 5; shape++) {
        for (int dim = 2; dim <= 3; dim++) {
            grid g = grid_of(dim, 11, 10, dim == 3 ? 12 : 1);
            for (int32_t n = 0; n < 11 * 10 * g.size[2]; n++) {
                int32_t i = n % 11, j = n / 11 % 10, k = n / 110;
                bool edge = i == 0 || j == 0 || i == 10 || j == 9 || (dim == 3 && (k == 0 || k == 11));
                bool in[5] = {edge, i == 5, i == 5 && j == 4 && (dim == 2 || k == 6), true, j == 3 || j == 6};
                g.set[i][j][k] = in[shape];
            }
            g.m[0][0] = 0.5;
            g.m[1][1] = -2;
            check_grid(&g, (uint64_t)shape, 400);
        }
    }
}

// What is seen has no border in its way; what is not, has.
static void sight_ends_at_the_border(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(3);
    int seen = 0, hidden = 0;
    for (int round = 0; round < 40; round++) {
        int dim = round % 2 ? 3 : 2;
        grid g = grid_of(dim, 9, 8, dim == 3 ? 7 : 1);
        fill(&g, &rng, 0.8);
        place_at_random(&g, &rng);
        vn_domain *domain = domain_of(&g);
        for (int i = 0; i < 40; i++) {
            double a[3], b[3], least = INFINITY;
            assert_ok(vn_domain_dart(domain, &rng, a));
            assert_ok(vn_domain_dart(domain, &rng, b));
            for (int k = 0; k <= 4000; k++) {
                double p[3];
                for (int r = 0; r < 3; r++) {
                    p[r] = a[r] + k / 4000. * (b[r] - a[r]);
                }
                least = fmin(least, vn_domain_distance(domain, p));
            }
            bool sees = vn_domain_sees(domain, a, b);
            assert_true(sees == vn_domain_sees(domain, b, a));
            assert_true(sees ? least > -1e-9 : least < 0.02);
            seen += sees;
            hidden += !sees;
        }
        vn_domain_release(domain);
    }
    assert_true(seen > 200 && hidden > 200);
}

static void nothing_is_seen_through_a_corner(void **state) {
    (void)state;
    vn_domain *domain;
    grid g = grid_of(2, 2, 2, 1);
    double a[3] = {-0.25, -0.25, 0}, b[3] = {1.25, 1.25, 0};
    g.set[0][0][0] = g.set[1][1][0] = true;
    domain = domain_of(&g);
    assert_false(vn_domain_sees(domain, a, b));
    vn_domain_release(domain);
    g.set[0][1][0] = g.set[1][0][0] = true;
    domain = domain_of(&g);
    assert_true(vn_domain_sees(domain, a, b));
    vn_domain_release(domain);
    grid s = grid_of(3, 2, 2, 2);
    double c[3] = {0, 0, 0}, d[3] = {1, 1, 1};
    s.set[0][0][0] = s.set[1][1][1] = s.set[1][0][0] = s.set[1][1][0] = true;
    domain = domain_of(&s);
    assert_false(vn_domain_sees(domain, c, d));
    vn_domain_release(domain);
}

static void darts_are_spread_evenly(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(11);
    grid g = grid_of(3, 9, 7, 5);
    fill(&g, &rng, 0.3);
    place_at_random(&g, &rng);
    vn_domain *domain = domain_of(&g);
    enum { DARTS = 200000 };
    int hits[MOST][MOST][MOST] = {0};
    double voxels = 0, chi2 = 0, halves = 0;
    for (int i = 0; i < DARTS; i++) {
        double p[3], u[3];
        assert_ok(vn_domain_dart(domain, &rng, p));
        assert_true(vn_domain_contains(domain, p));
        for (int a = 0; a < 3; a++) {
            u[a] = 0.5;
            for (int r = 0; r < 3; r++) {
                u[a] += g.m[r][a] * (p[r] - g.m[r][3]) / side_of(&g, a) / side_of(&g, a);
            }
        }
        hits[(int)u[0]][(int)u[1]][(int)u[2]]++;
        halves += u[0] - floor(u[0]) < 0.5;
    }
    for (int32_t n = 0; n < 9 * 7 * 5; n++) {
        int32_t i = n % 9, j = n / 9 % 7, k = n / 63;
        voxels += g.set[i][j][k];
    }
    for (int32_t n = 0; n < 9 * 7 * 5; n++) {
        int32_t i = n % 9, j = n / 9 % 7, k = n / 63;
        double expected = g.set[i][j][k] ? DARTS / voxels : 0, hit = hits[i][j][k];
        assert_true(expected > 0 || hit == 0);
        chi2 += expected > 0 ? (hit - expected) * (hit - expected) / expected : 0;
    }
    assert_true(fabs(chi2 - voxels) < 5 * sqrt(2 * voxels));
    assert_near(halves / DARTS, 0.5, 0.01);
    vn_domain_release(domain);
}

static double outline_area(const vn_domain *domain, int32_t *rings) {
    vn_rings out = {0};
    double area = 0;
    assert_ok(vn_domain_outline(domain, 8, &out));
    for (int32_t i = 0; i < out.ends.count; i++) {
        area += vn_rings_area_of(&out, i);
    }
    *rings = out.ends.count;
    vn_rings_free(&out);
    return area;
}

static void outlines_have_the_area_of_their_pixels(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(5);
    int32_t rings;
    for (int round = 0; round < 60; round++) {
        grid g = grid_of(2, (int32_t)whole(&rng, 1, MOST), (int32_t)whole(&rng, 1, MOST), 1);
        fill(&g, &rng, round % 3 ? 0.5 : 0.9);
        place_at_random(&g, &rng);
        vn_domain *domain = domain_of(&g), *half, *all;
        double area = vn_domain_measure(domain);
        assert_near(outline_area(domain, &rings), area, 1e-9 * area);
        vn_box box = vn_domain_bounds(domain);
        double middle = 0.5 * (box.min[0] + box.max[0]);
        vn_domain *left = box_of(box.min[0] - 1, box.min[1] - 1, middle, box.max[1] + 1);
        vn_domain *right = box_of(middle, box.min[1] - 1, box.max[0] + 1, box.max[1] + 1);
        double sum = 0;
        if (vn_domain_combine(&half, domain, left, VN_INTERSECTION) == VN_OK) {
            sum += vn_domain_measure(half);
            vn_domain_release(half);
        }
        if (vn_domain_combine(&half, domain, right, VN_INTERSECTION) == VN_OK) {
            sum += vn_domain_measure(half);
            vn_domain_release(half);
        }
        assert_near(sum, area, 1e-6 * area);
        assert_ok(vn_domain_combine(&all, domain, left, VN_UNION));
        vn_domain_release(all);
        vn_domain_release(left);
        vn_domain_release(right);
        vn_domain_release(domain);
    }
    grid g = grid_of(2, 4, 4, 1); // a frame, and a pixel that touches its corner only
    for (int32_t n = 0; n < 9; n++) {
        g.set[n % 3][n / 3][0] = n != 4;
    }
    g.set[3][3][0] = true;
    vn_domain *domain = domain_of(&g);
    assert_near(outline_area(domain, &rings), 9, 0);
    assert_int_equal(rings, 3);
    vn_domain_release(domain);
    g.set[2][2][0] = false; // what is inside is open to the outside now
    domain = domain_of(&g);
    assert_near(outline_area(domain, &rings), 8, 0);
    assert_int_equal(rings, 2);
    vn_domain_release(domain);
}

static void solids_combine(void **state) {
    (void)state;
    grid g = grid_of(3, 10, 10, 10);
    memset(g.set, 1, sizeof g.set);
    vn_domain *cube = domain_of(&g), *ball = ball_of(4.5, 4.5, 4.5, 3), *rest;
    assert_ok(vn_domain_combine(&rest, cube, ball, VN_DIFFERENCE));
    assert_near(vn_domain_measure(rest), 1000 - 36 * 3.141592653589793, 1);
    double p[3] = {4.5, 4.5, 0}, q[3] = {4.5, 4.5, 4.5};
    assert_true(vn_domain_contains(rest, p) && !vn_domain_contains(rest, q));
    assert_near(vn_domain_distance(rest, p), 0.5, 1e-12);
    vn_domain_release(rest);
    vn_domain_release(ball);
    vn_domain_release(cube);
}

static void parts_are_counted_chosen_and_refused(void **state) {
    (void)state;
    vn_domain *domain;
    grid g = grid_of(3, 8, 8, 8);
    assert_int_equal(try_domain(&domain, &g, VN_PARTS_ONE), VN_INVALID);
    assert_message("mask: the mask is empty: none of its 8 x 8 x 8 voxels is inside");
    assert_int_equal(try_domain(&domain, &g, VN_PARTS_ALL), VN_INVALID);
    for (int32_t n = 0; n < 27; n++) {
        g.set[n % 3][n / 3 % 3][n / 9] = true;
        g.set[3 + n % 3][3 + n / 3 % 3][3 + n / 9] = n != 5; // touches the first by a corner
    }
    assert_int_equal(try_domain(&domain, &g, VN_PARTS_ONE), VN_INVALID);
    assert_message("mask: the mask has 2 parts that do not hang together, the largest of 27 and 26 voxels");
    assert_message("component = \"largest\" or \"all\"");
    assert_ok(try_domain(&domain, &g, VN_PARTS_LARGEST));
    assert_near(vn_domain_measure(domain), 27, 0);
    assert_near(vn_domain_bounds(domain).max[0], 2.5, 0);
    vn_domain_release(domain);
    assert_ok(try_domain(&domain, &g, VN_PARTS_ALL));
    assert_near(vn_domain_measure(domain), 53, 0);
    vn_domain_release(domain);
    memset(g.set, 0, sizeof g.set); // a spiral, whose runs find each other late
    for (int32_t n = 0; n < 64; n++) {
        g.set[n % 8][n / 8][4] = n % 8 == 0 || n / 8 == 7 || (n % 2 == 0 && n / 8 > 1);
    }
    assert_ok(try_domain(&domain, &g, VN_PARTS_ONE));
    vn_domain_release(domain);
}

static void specks_are_left_out(void **state) {
    (void)state;
    vn_domain *domain;
    grid g = grid_of(3, 12, 11, 11);
    for (int32_t n = 0; n < 11 * 10 * 10; n++) {
        g.set[n % 11][n / 11 % 10][n / 110] = true;
    }
    g.set[11][10][10] = true;
    assert_ok(try_domain(&domain, &g, VN_PARTS_ONE));
    assert_near(vn_domain_measure(domain), 1100, 0);
    vn_domain_release(domain);
    g.set[9][10][10] = true;
    assert_int_equal(try_domain(&domain, &g, VN_PARTS_ONE), VN_INVALID);
}

static void axes_have_to_be_at_right_angles(void **state) {
    (void)state;
    vn_domain *domain;
    grid g = grid_of(3, 3, 3, 3);
    g.set[1][1][1] = true;
    g.m[1][0] = 0.02;
    assert_int_equal(try_domain(&domain, &g, VN_PARTS_ONE), VN_INVALID);
    assert_message("mask: its voxel axes 0 and 1 are 88.85 degrees apart");
    g.m[1][0] = 0.0005;
    assert_ok(try_domain(&domain, &g, VN_PARTS_ONE));
    vn_domain_release(domain);
}

static void values_are_those_of_the_voxels(void **state) {
    (void)state;
    static const int32_t size[3] = {3, 1, 1};
    static const double spacing[3] = {2, 2, 2}, origin[3] = {1, 1, 1};
    static const float values[3] = {NAN, 0.5f, 4};
    for (int invert = 0; invert < 2; invert++) {
        vn_volume volume;
        vn_domain *domain;
        assert_ok(vn_volume_init(&volume, VN_VOXEL_F32, size, spacing, origin));
        memcpy(volume.data, values, sizeof values);
        volume.white = invert ? 8 : 0;
        vn_mask mask = {.dim = 3, .threshold = invert ? 5 : 0.5, .scale = 1, .invert = invert, .what = "v"};
        assert_ok(vn_domain_voxels(&domain, &volume, &mask));
        double p[3] = {1, 1, 1};
        assert_near(vn_domain_value(domain, p), 0, 0);
        p[0] = 2.01;
        assert_near(vn_domain_value(domain, p), invert ? 1 - 0.5 / 8 : 0.125, 0);
        p[0] = 5;
        assert_near(vn_domain_value(domain, p), invert ? 0.5 : 1, 0);
        assert_near(vn_domain_measure(domain), 16, 0);
        vn_domain_release(domain);
    }
}

static void a_mask_loses_nothing_when_memory_runs_out(void **state) {
    (void)state;
    grid g = grid_of(3, 12, 9, 9);
    vn_rng rng = vn_rng_make(1);
    fill(&g, &rng, 0.5);
    vn_status status = VN_NO_MEMORY;
    for (int64_t nth = 0; status == VN_NO_MEMORY; nth++) {
        vn_volume volume = volume_of(&g);
        vn_mask mask = {.dim = 3, .threshold = 0.5, .scale = 1, .parts = VN_PARTS_LARGEST, .what = "mask"};
        vn_domain *domain;
        vn_fail_allocations_from(nth);
        status = vn_domain_voxels(&domain, &volume, &mask);
        vn_fail_allocations_from(-1);
        vn_domain_release(domain);
        assert_true(nth < 1000);
    }
    assert_ok(status);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(distances_are_those_of_the_plain_search),
        counted_test(shells_sheets_and_single_voxels_are_measured),
        counted_test(sight_ends_at_the_border),
        counted_test(nothing_is_seen_through_a_corner),
        counted_test(darts_are_spread_evenly),
        counted_test(outlines_have_the_area_of_their_pixels),
        counted_test(solids_combine),
        counted_test(parts_are_counted_chosen_and_refused),
        counted_test(specks_are_left_out),
        counted_test(axes_have_to_be_at_right_angles),
        counted_test(values_are_those_of_the_voxels),
        counted_test(a_mask_loses_nothing_when_memory_runs_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
