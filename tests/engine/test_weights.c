// Darts that are kept with the probability that a map or a function has where they fall.
#include "support.h"

#include "domain/voxels.h"

enum { WIDE = 4, HIGH = 3, CELLS = WIDE * HIGH };

// Of 100.
static const uint8_t values[CELLS] = {0, 10, 25, 40, 50, 60, 75, 90, 100, 1, 99, 33};

// Pixels of side 2, the first at (0, 0).
static vn_domain *map_of_values(void) {
    static const int32_t size[3] = {WIDE, HIGH, 1};
    static const double side[3] = {2, 2, 1}, origin[3] = {1, 1, 0};
    vn_volume volume;
    vn_domain *map;
    vn_mask mask = {.dim = 2, .threshold = 0, .scale = 100, .parts = VN_PARTS_ALL, .what = "map"};
    assert_ok(vn_volume_init(&volume, VN_VOXEL_U8, size, side, origin));
    memcpy(volume.data, values, sizeof values);
    assert_ok(vn_domain_voxels(&map, &volume, &mask));
    return map;
}

static int cell_at(const double p[3]) {
    return (int)(p[0] / 2) + WIDE * (int)(p[1] / 2);
}

static vn_status value_at(double *weight, const double p[3], void *payload) {
    (void)payload;
    *weight = values[cell_at(p)] / 100.0;
    return VN_OK;
}

/// @p count darts into the map's square.
static vn_attractors *throw_by(vn_domain *weight, vn_weight_fn *weight_at, void *payload, int32_t count,
                               double spacing) {
    vn_domain *box = box_of(0, 0, 2 * WIDE, 2 * HIGH);
    vn_attractors *a = attractors_of(2, 0);
    vn_rng rng = vn_rng_make(77);
    vn_throw_def throw = {.domain = box,
                          .count = count,
                          .spacing = spacing,
                          .weight = weight,
                          .weight_at = weight_at,
                          .weight_payload = payload,
                          .rng = &rng};
    int32_t accepted;
    assert_ok(vn_throw(a, &throw, &accepted));
    assert_int_equal(accepted, vn_attractors_count(a));
    assert_int_equal(rng.counter, 1);
    vn_domain_release(box);
    return a;
}

static void assert_same(vn_attractors *a, vn_attractors *b) {
    size_t bytes = (size_t)a->x.count * sizeof(double);
    assert_int_equal(a->x.count, b->x.count);
    assert_memory_equal(a->x.data, b->x.data, bytes);
    assert_memory_equal(a->y.data, b->y.data, bytes);
}

// Each cell's count is binomial; with 10 cells that are neither empty nor full the sum of the squares of
// what each is off, in deviations, is above 29.6 once in a thousand times.
static void as_many_stay_in_each_cell_as_its_value_says(void **state) {
    (void)state;
    enum { DARTS = 120000 };
    vn_domain *map = map_of_values();
    vn_attractors *all = throw_by(NULL, NULL, NULL, DARTS, 0), *kept = throw_by(map, NULL, NULL, DARTS, 0);
    int32_t thrown[CELLS] = {0}, stayed[CELLS] = {0};
    double p[3], sum = 0;
    for (int32_t i = 0; i < DARTS; i++) {
        assert_ok(vn_attractors_position(all, i, p));
        thrown[cell_at(p)]++;
    }
    for (int32_t i = 0; i < vn_attractors_count(kept); i++) {
        assert_ok(vn_attractors_position(kept, i, p));
        stayed[cell_at(p)]++;
    }
    for (int k = 0; k < CELLS; k++) {
        double v = values[k] / 100.0, off = stayed[k] - v * thrown[k];
        assert_true(thrown[k] > DARTS / CELLS / 2);
        if (v == 0 || v == 1) {
            assert_true(off == 0);
        } else {
            sum += off * off / (thrown[k] * v * (1 - v));
        }
    }
    assert_true(sum < 29.6);
    assert_true(sum > 1.5); // numbers that kept the shares exactly would not be random
    vn_attractors_destroy(all);
    vn_attractors_destroy(kept);
    vn_domain_release(map);
}

static void a_map_and_a_function_of_its_values_keep_the_same_at_any_thread_count(void **state) {
    (void)state;
    static const int threads[3] = {1, 2, 8};
    vn_domain *map = map_of_values();
    vn_attractors *first = throw_by(map, NULL, NULL, 50000, 0.02);
    assert_true(vn_attractors_count(first) > 5000);
    for (int k = 0; k < 3; k++) {
        vn_set_threads(threads[k]);
        vn_attractors *by_map = throw_by(map, NULL, NULL, 50000, 0.02),
                      *by_function = throw_by(NULL, value_at, NULL, 50000, 0.02);
        assert_same(first, by_map);
        assert_same(first, by_function);
        vn_attractors_destroy(by_map);
        vn_attractors_destroy(by_function);
    }
    vn_set_threads(0);
    vn_attractors_destroy(first);
    vn_domain_release(map);
}

/// What a function of the place was asked, and said.
typedef struct record {
    vn_rng rng;
    double at[1000][3], weight[1000];
    int32_t count;
} record;

static vn_status random_weight(double *weight, const double p[3], void *payload) {
    record *r = payload;
    memcpy(r->at[r->count], p, sizeof r->at[0]);
    *weight = r->weight[r->count++] = (double)whole(&r->rng, 0, 1);
    return VN_OK;
}

// Weights of 0 and 1 leave nothing to chance: the darts that stay are known, and refuse each other in order.
static void a_function_is_asked_of_each_dart_in_order(void **state) {
    (void)state;
    enum { DARTS = 1000 };
    static record r;
    r = (record){.rng = vn_rng_make(4)};
    vn_attractors *all = throw_by(NULL, NULL, NULL, DARTS, 0),
                  *kept = throw_by(NULL, random_weight, &r, DARTS, 0.2), *oracle = attractors_of(2, 0);
    assert_int_equal(r.count, DARTS);
    for (int32_t i = 0; i < DARTS; i++) {
        double p[3];
        bool stays = r.weight[i] > 0;
        assert_ok(vn_attractors_position(all, i, p));
        assert_memory_equal(p, r.at[i], sizeof p);
        for (int32_t j = 0; j < vn_attractors_count(oracle) && stays; j++) {
            double q[3];
            assert_ok(vn_attractors_position(oracle, j, q));
            stays = vn_distance2(p, q) > 0.2 * 0.2;
        }
        if (stays) {
            put_attractor(oracle, p[0], p[1], p[2]);
        }
    }
    assert_true(vn_attractors_count(oracle) > 100);
    assert_same(kept, oracle);
    vn_attractors_destroy(all);
    vn_attractors_destroy(kept);
    vn_attractors_destroy(oracle);
}

static vn_status upward(double *weight, const double p[3], void *payload) {
    (void)payload;
    *weight = 0.5 * (1 + p[2]);
    return VN_OK;
}

// Over the ball of radius 1 the weight (1 + z) / 2 has the mean 1/2, and the kept ones' z the mean 1/5 and
// the mean square 1/5.
static void weights_work_in_space(void **state) {
    (void)state;
    enum { DARTS = 100000 };
    vn_domain *ball = ball_of(0, 0, 0, 1);
    vn_attractors *a = attractors_of(3, 0);
    vn_rng rng = vn_rng_make(8);
    vn_throw_def throw = {.domain = ball, .count = DARTS, .weight_at = upward, .rng = &rng};
    int32_t accepted;
    double sum = 0;
    assert_ok(vn_throw(a, &throw, &accepted));
    for (int32_t i = 0; i < accepted; i++) {
        sum += a->z.data[i];
    }
    assert_near(accepted, DARTS / 2.0, 4 * sqrt(DARTS * 0.25));
    assert_near(sum / accepted, 0.2, 4 * sqrt((0.2 - 0.04) / accepted));
    vn_attractors_destroy(a);
    vn_domain_release(ball);
}

// Any domain is a map of 0 and 1.
static void a_plain_domain_keeps_what_is_inside(void **state) {
    (void)state;
    vn_domain *disk = disk_of(4, 3, 2);
    vn_attractors *all = throw_by(NULL, NULL, NULL, 1000, 0), *kept = throw_by(disk, NULL, NULL, 1000, 0);
    int32_t next = 0;
    for (int32_t i = 0; i < 1000; i++) {
        double p[3], q[3];
        assert_ok(vn_attractors_position(all, i, p));
        if (vn_domain_contains(disk, p)) {
            assert_ok(vn_attractors_position(kept, next++, q));
            assert_memory_equal(p, q, sizeof p);
        }
    }
    assert_int_equal(next, vn_attractors_count(kept));
    vn_attractors_destroy(all);
    vn_attractors_destroy(kept);
    vn_domain_release(disk);
}

// Of both kinds of weight the lesser counts: half the disk stays, at the left.
static vn_status left(double *weight, const double p[3], void *payload) {
    *weight = p[0] < *(const double *)payload ? 1 : 0;
    return VN_OK;
}

static void the_lesser_of_two_weights_counts(void **state) {
    (void)state;
    double middle = 4;
    vn_domain *disk = disk_of(4, 3, 2);
    vn_attractors *a = throw_by(disk, left, &middle, 1000, 0);
    int32_t count = vn_attractors_count(a);
    assert_true(count > 60 && count < 200);
    for (int32_t i = 0; i < count; i++) {
        double p[3];
        assert_ok(vn_attractors_position(a, i, p));
        assert_true(p[0] < 4 && vn_domain_contains(disk, p));
    }
    vn_attractors_destroy(a);
    vn_domain_release(disk);
}

// All of a marginal growth's darts are weighed at once; the margin then releases what was kept.
static void a_margin_releases_what_was_kept(void **state) {
    (void)state;
    double middle = 0;
    vn_domain *disk = disk_of(0, 0, 10);
    vn_growth_def def = vn_growth_def_default();
    vn_growth *growth;
    def.domain = disk;
    assert_ok(vn_growth_marginal(&growth, &def));
    vn_attractors *a = attractors_of(2, 0);
    vn_rng rng = vn_rng_make(5);
    vn_throw_def throw = {.domain = vn_growth_domain(growth),
                          .count = 1000,
                          .weight_at = left,
                          .weight_payload = &middle,
                          .rng = &rng};
    int32_t accepted;
    do {
        assert_ok(vn_throw(a, &throw, &accepted));
    } while (advance(growth));
    assert_ok(vn_throw(a, &throw, &accepted));
    assert_int_equal(vn_attractors_dormant(a), 0);
    assert_near(vn_attractors_count(a), 500, 100);
    for (int32_t i = 0; i < vn_attractors_count(a); i++) {
        assert_true(a->x.data[i] < 0);
    }
    vn_attractors_destroy(a);
    vn_growth_release(growth);
    vn_domain_release(disk);
}

static vn_status given(double *weight, const double p[3], void *payload) {
    (void)p;
    *weight = *(const double *)payload;
    return VN_OK;
}

static vn_status broken(double *weight, const double p[3], void *payload) {
    (void)weight;
    (void)p;
    (void)payload;
    return VN_CALLBACK;
}

static void weights_that_make_no_sense_are_refused(void **state) {
    (void)state;
    static const double bad[] = {1.5, -0.1, NAN, INFINITY};
    vn_domain *disk = disk_of(0, 0, 1), *ball = ball_of(0, 0, 0, 1);
    vn_attractors *a = attractors_of(2, 0);
    vn_rng rng = vn_rng_make(1);
    vn_throw_def throw = {.domain = disk, .count = 5, .weight_at = given, .rng = &rng};
    int32_t accepted;
    for (int k = 0; k < 4; k++) {
        double weight = bad[k];
        throw.weight_payload = &weight;
        assert_int_equal(vn_throw(a, &throw, &accepted), VN_INVALID);
        assert_message("throw.weight is ");
        assert_int_equal(accepted, 0);
    }
    throw.weight_at = broken;
    assert_int_equal(vn_throw(a, &throw, &accepted), VN_CALLBACK);
    throw = (vn_throw_def){.domain = disk, .count = 5, .weight = ball, .rng = &rng};
    assert_int_equal(vn_throw(a, &throw, &accepted), VN_INVALID);
    assert_message("throw.weight has 3 dimensions, the attractors 2");
    assert_int_equal(vn_attractors_count(a), 0);
    vn_attractors_destroy(a);
    vn_domain_release(ball);
    vn_domain_release(disk);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(as_many_stay_in_each_cell_as_its_value_says),
        counted_test(a_map_and_a_function_of_its_values_keep_the_same_at_any_thread_count),
        counted_test(a_function_is_asked_of_each_dart_in_order),
        counted_test(weights_work_in_space),
        counted_test(a_plain_domain_keeps_what_is_inside),
        counted_test(the_lesser_of_two_weights_counts),
        counted_test(a_margin_releases_what_was_kept),
        counted_test(weights_that_make_no_sense_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
