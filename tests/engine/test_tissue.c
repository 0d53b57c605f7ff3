// Distances of tissue against a look at every vessel from every point, and against figures that are known.
#include "mesh_support.h"
#include "support.h"

#include "network/vessels.h"

static vn_tissue measured_by(const vn_network *network, const vn_tissue_def *def) {
    vn_tissue tissue;
    assert_ok(vn_network_measure_tissue(network, def, &tissue));
    return tissue;
}

static vn_network *random_vessels(int dim, int32_t nodes, uint64_t seed) {
    vn_rng rng = vn_rng_make(seed + 7);
    vn_network *network = random_tree(dim, nodes, 2, seed);
    double *radius = malloc((size_t)nodes * sizeof *radius);
    assert_non_null(radius);
    for (int32_t i = 0; i < nodes; i++) { // few are thick by far
        radius[i] = 0.3 * pow(uniform(&rng, 0, 1), 8);
    }
    assert_ok(vn_network_set_radii(network, radius));
    for (int k = 0; k < 5; k++) {
        int32_t a = (int32_t)whole(&rng, 0, nodes - 1), b = (int32_t)whole(&rng, 0, nodes - 1);
        (void)vn_network_join(network, a, b, 0.1);
    }
    free(radius);
    return network;
}

static double to_vessel(const vn_network *network, int32_t from, int32_t to, double radius,
                        const double p[3]) {
    double a[3], b[3];
    vn_network_position(network, from, a);
    vn_network_position(network, to, b);
    return fmax(to_segment(p, a, b) - radius, 0);
}

static double to_nearest(const vn_network *network, bool thick, const double p[3]) {
    double least = INFINITY, radius;
    for (int32_t i = 0; i < vn_network_count(network); i++) {
        int32_t parent = vn_network_parent(network)[i];
        radius = thick && parent >= 0 ? vn_network_radius(network, i) : 0;
        least = fmin(least, to_vessel(network, parent >= 0 ? parent : i, i, radius, p));
    }
    for (int32_t j = 0; j < vn_network_join_count(network); j++) {
        int32_t a, b;
        vn_network_join_ends(network, j, &a, &b, &radius);
        least = fmin(least, to_vessel(network, a, b, thick ? radius : 0, p));
    }
    return least;
}

/// What a look at every vessel from every point finds.
typedef struct slowly {
    int32_t points, lumen, perfused;
    double sum, max;
    int32_t histogram[64];
} slowly;

// Twice: the bins need the largest distance.
static slowly look_at_all(const vn_network *network, const vn_tissue_def *def, double step) {
    slowly s = {0};
    vn_box box = vn_domain_bounds(def->domain);
    for (int pass = 0; pass < 2; pass++) {
        for (int z = 0; z < (vn_domain_dim(def->domain) == 3 ? ceil((box.max[2] - box.min[2]) / step) : 1);
             z++) {
            for (int y = 0; y < ceil((box.max[1] - box.min[1]) / step); y++) {
                for (int x = 0; x < ceil((box.max[0] - box.min[0]) / step); x++) {
                    double p[3] = {box.min[0] + (x + 0.5) * step, box.min[1] + (y + 0.5) * step,
                                   vn_domain_dim(def->domain) == 3 ? box.min[2] + (z + 0.5) * step : 0};
                    if (!vn_domain_contains(def->domain, p)) {
                        continue;
                    }
                    double d = to_nearest(network, def->from == VN_FROM_SURFACE, p);
                    if (pass == 0) {
                        s.points++;
                        s.sum += d;
                        s.max = fmax(s.max, d);
                        s.lumen += d == 0;
                        s.perfused += d <= def->reach;
                    } else {
                        int bin = (int)(d / (s.max / def->bins));
                        s.histogram[bin < def->bins ? bin : def->bins - 1]++;
                    }
                }
            }
        }
    }
    return s;
}

static void check_slowly(const vn_network *network, const vn_tissue_def *def) {
    vn_tissue tissue = measured_by(network, def);
    slowly s = look_at_all(network, def, tissue.resolution);
    assert_int_equal(tissue.points, s.points);
    assert_near(tissue.distance.mean, s.sum / s.points, 1e-12);
    assert_near(tissue.distance.max, s.max, 1e-12);
    assert_near(to_nearest(network, def->from == VN_FROM_SURFACE, tissue.furthest), s.max, 1e-12);
    assert_true(vn_domain_contains(def->domain, tissue.furthest));
    assert_near(tissue.perfused, (double)s.perfused / s.points, 1e-12);
    assert_near(tissue.lumen, def->from == VN_FROM_SURFACE ? (double)s.lumen / s.points : 0, 1e-12);
    assert_near(tissue.bin, s.max / def->bins, 1e-12);
    int32_t binned = 0;
    for (int32_t k = 0; k < def->bins; k++) {
        binned += tissue.histogram[k];
        assert_int_equal(tissue.histogram[k], s.histogram[k]);
    }
    assert_int_equal(binned, s.points);
    vn_tissue_free(&tissue);
}

static void distances_are_those_of_all_vessels(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 6; seed++) {
        vn_network *network = random_vessels(2, 60, seed);
        vn_network_measures m;
        assert_ok(vn_network_measure(network, &m));
        vn_domain *disk = disk_of(m.extent.max[0], m.extent.min[1], 3);
        vn_tissue_def def = {.domain = disk, .from = seed % 2, .reach = 0.4, .resolution = 0.09, .bins = 7};
        check_slowly(network, &def);
        vn_domain_release(disk);
        vn_network_destroy(network);
    }
    for (uint64_t seed = 0; seed < 6; seed++) {
        vn_network *network = random_vessels(3, 60, seed);
        vn_domain *ball = ball_of(0.3, 0.2, 0.1, 2);
        vn_tissue_def def = {.domain = ball, .from = seed % 2, .reach = 0.7, .resolution = 0.21, .bins = 13};
        check_slowly(network, &def);
        vn_domain_release(ball);
        vn_network_destroy(network);
    }
}

static vn_network *point_at(int dim, double x, double y, double z) {
    vn_network *network = network_of(dim);
    put_root(network, x, y, z);
    return network;
}

// From the middle of a disk of radius R the mean distance is 2R/3, of a ball 3R/4.
static void from_the_middle(void **state) {
    (void)state;
    vn_domain *disk = disk_of(1, 2, 3), *ball = ball_of(1, 2, 3, 4);
    vn_network *flat = point_at(2, 1, 2, 0), *solid = point_at(3, 1, 2, 3);
    vn_tissue_def def = vn_tissue_def_default();
    def.domain = disk;
    def.reach = 1.5;
    vn_tissue tissue = measured_by(flat, &def);
    assert_near(tissue.resolution, sqrt(vn_domain_measure(disk) / 40000), 1e-12);
    assert_near(tissue.points, 40000, 200);
    assert_near(tissue.distance.mean, 2, 1e-3);
    assert_near(tissue.distance.max, 3, tissue.resolution);
    assert_near(tissue.distance.median, 3 * sqrt(0.5), 5e-3);
    assert_near(tissue.perfused, 0.25, 1e-3);
    assert_true(tissue.mode > 2.5 && tissue.mode < 3 && tissue.lumen == 0);
    vn_tissue_free(&tissue);
    def.domain = ball;
    def.reach = 2;
    tissue = measured_by(solid, &def);
    assert_near(tissue.points, 262144, 2000);
    assert_near(tissue.distance.mean, 3, 3e-3);
    assert_near(tissue.distance.max, 4, 2 * tissue.resolution);
    assert_near(tissue.perfused, 0.125, 1e-3);
    vn_tissue_free(&tissue);
    vn_domain_release(disk);
    vn_domain_release(ball);
    vn_network_destroy(flat);
    vn_network_destroy(solid);
}

// From a point of a sphere, straight through space, the mean distance is 4R/3.
static void over_a_surface(void **state) {
    (void)state;
    vn_domain *domain = NULL;
    mesh m = globe(32, 2);
    assert_ok(vn_domain_surface(&domain, m.xyz.data, m.xyz.count / 3, m.corners.data, m.corners.count / 3));
    vn_network *network = point_at(3, 0, 0, 2);
    vn_tissue_def def = vn_tissue_def_default();
    def.domain = domain;
    def.reach = 2;
    vn_tissue tissue = measured_by(network, &def), again = measured_by(network, &def);
    assert_near(tissue.points, 40000, 1);
    assert_near(tissue.distance.mean, 8.0 / 3, 2e-2);
    assert_near(tissue.distance.max, 4, 5e-2);
    assert_near(tissue.perfused, 0.25, 1e-2); // a cap of height d²/2R
    assert_near(tissue.furthest[2], -2, 5e-2);
    assert_true(again.distance.mean == tissue.distance.mean);
    vn_tissue_free(&tissue);
    vn_tissue_free(&again);
    vn_network_destroy(network);
    vn_domain_release(domain);
    free_mesh(&m);
}

// A vessel of length L and radius a has the share (2 a L + π a²) / area in a flat domain.
static void what_is_in_vessels(void **state) {
    (void)state;
    vn_domain *box = box_of(-5, -5, 5, 5);
    vn_network *network = network_of(2);
    put_child(network, put_root(network, -2, 0.3, 0), 2, 0.3, 0);
    vn_tissue_def def = {.domain = box, .bins = 4};
    vn_tissue tissue = measured_by(network, &def); // no radii are known: the center line
    assert_true(tissue.lumen == 0 && tissue.perfused == 0);
    vn_tissue_free(&tissue);
    assert_ok(vn_network_set_radii(network, (double[]){0, 0.75}));
    tissue = measured_by(network, &def);
    assert_near(tissue.lumen, (2 * 0.75 * 4 + pi * 0.75 * 0.75) / 100, 1e-3);
    double far = sqrt(9.0 + 5.3 * 5.3) - 0.75;
    assert_near(tissue.distance.max, far, tissue.resolution);
    assert_near(fabs(tissue.furthest[0]), 5, tissue.resolution);
    assert_near(tissue.furthest[1], -5, tissue.resolution);
    vn_tissue_free(&tissue);
    def.resolution = 0.25; // of points at equal distances, the first
    tissue = measured_by(network, &def);
    assert_true(tissue.furthest[0] == -4.875 && tissue.furthest[1] == -4.875 && tissue.furthest[2] == 0);
    vn_tissue_free(&tissue);
    vn_network_destroy(network);
    vn_domain_release(box);
}

static void inside_a_mesh(void **state) {
    (void)state;
    vn_domain *organ = liver();
    vn_box box = vn_domain_bounds(organ);
    vn_network *network = point_at(3, box.min[0], box.min[1], box.min[2]);
    put_child(network, 0, box.max[0], box.max[1], box.max[2]);
    vn_tissue_def def = vn_tissue_def_default();
    def.domain = organ;
    def.resolution = (box.max[0] - box.min[0]) / 40;
    vn_tissue tissue = measured_by(network, &def);
    assert_near(tissue.points * pow(tissue.resolution, 3) / vn_domain_measure(organ), 1, 0.03);
    assert_near(tissue.distance.max, to_nearest(network, true, tissue.furthest), 1e-9);
    vn_tissue_free(&tissue);
    vn_network_destroy(network);
    vn_domain_release(organ);
}

static void refused(const vn_network *network, const vn_tissue_def *def, const char *part) {
    vn_tissue tissue;
    assert_int_equal(vn_network_measure_tissue(network, def, &tissue), VN_INVALID);
    assert_message(part);
    assert_null(tissue.histogram);
}

static void bad_requests_are_refused(void **state) {
    (void)state;
    vn_domain *disk = disk_of(0, 0, 1), *ball = ball_of(0, 0, 0, 1);
    vn_network *network = network_of(2);
    vn_tissue_def def = vn_tissue_def_default();
    refused(network, &def, "measure_tissue: `domain` is missing");
    def.domain = ball;
    refused(network, &def,
            "measure_tissue.domain is in 3D and the network in 2D; both must be of one dimension");
    def.domain = disk;
    refused(network, &def, "measure_tissue: the network is empty; grow or load it first");
    put_root(network, 0, 0, 0);
    def.resolution = 1e-9;
    refused(network, &def, "measure_tissue.resolution = 1e-09 makes 4e+18 points, and 1e+08 are the limit");
    def.resolution = 1e9;
    refused(network, &def, "measure_tissue.resolution = 1e+09 puts no point into the domain; give less");
    def.resolution = 0;
    def.reach = -1;
    refused(network, &def, "measure_tissue.reach = -1 must be above 0 length");
    def.reach = 0;
    def.bins = 20000;
    refused(network, &def, "measure_tissue.bins = 20000 must be at most 10000 bins");
    def.bins = 20;
    put_child(network, 0, 1, 1e200, 0);
    refused(network, &def,
            "measure_tissue: node 1 at (1, 1e+200, 0) is beyond 1e+150; use another length unit");
    vn_network_destroy(network);
    vn_domain_release(disk);
    vn_domain_release(ball);
}

static void memory_may_run_out_anywhere(void **state) {
    (void)state;
    vn_domain *disk = disk_of(0, 0, 1);
    vn_network *network = random_vessels(2, 100, 3);
    vn_tissue_def def = {.domain = disk, .resolution = 0.05, .bins = 5};
    vn_status status = VN_NO_MEMORY;
    int64_t nth = 0;
    for (; status == VN_NO_MEMORY; nth++) {
        vn_tissue tissue;
        size_t before = vn_byte_count();
        vn_fail_allocations_from(nth);
        status = vn_network_measure_tissue(network, &def, &tissue);
        vn_fail_allocations_from(-1);
        vn_tissue_free(&tissue);
        assert_true(vn_byte_count() == before);
    }
    assert_ok(status);
    assert_true(nth > 10);
    vn_network_destroy(network);
    vn_domain_release(disk);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(distances_are_those_of_all_vessels),
        counted_test(from_the_middle),
        counted_test(over_a_surface),
        counted_test(what_is_in_vessels),
        counted_test(inside_a_mesh),
        counted_test(bad_requests_are_refused),
        counted_test(memory_may_run_out_anywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
