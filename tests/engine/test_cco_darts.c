// Random terminals: darts into cells that may still be hit have the distribution of darts thrown anywhere.
#include "cco_support.h"

#include "cco/cco.h"

/// Vessels that darts keep away from.
typedef struct vessels {
    double ends[64][2][3];
    int32_t count;
} vessels;

static double distance_to(const double p[3], int32_t vessel, void *payload) {
    const vessels *v = payload;
    return sqrt(vn_point_segment_distance2(p, v->ends[vessel][0], v->ends[vessel][1]));
}

static double distance(const double p[3], int32_t *vessel, void *payload) {
    const vessels *v = payload;
    double least = INFINITY;
    *vessel = -1;
    for (int32_t i = 0; i < v->count; i++) {
        double to = distance_to(p, i, payload);
        *vessel = to < least ? i : *vessel;
        least = fmin(least, to);
    }
    return least;
}

// Something else stands in the way: the lower left quarter of every unit square.
static bool refuse(const double p[3], void *payload) {
    (void)payload;
    return p[0] - floor(p[0]) < 0.5 && p[1] - floor(p[1]) < 0.5;
}

static vn_status tell_all(vn_darts *darts, const vessels *v) {
    int32_t numbers[64];
    for (int32_t i = 0; i < v->count; i++) {
        numbers[i] = i;
    }
    return vn_darts_tell(darts, numbers, (const double(*)[2][3])v->ends, v->count, 0);
}

static vn_dart_search search_of(vessels *v, double threshold, double factor, int32_t tries) {
    return (vn_dart_search){threshold, factor, tries, INT32_MAX, distance, distance_to, refuse, v};
}

static vessels random_vessels(const vn_domain *region, int32_t count, vn_rng *rng) {
    vessels v = {.count = count};
    for (int32_t i = 0; i < count; i++) {
        assert_ok(vn_domain_dart(region, rng, v.ends[i][0]));
        assert_ok(vn_domain_dart(region, rng, v.ends[i][1]));
        for (int k = 0; k < 3; k++) { // short ones
            v.ends[i][1][k] = v.ends[i][0][k] + 0.3 * (v.ends[i][1][k] - v.ends[i][0][k]);
        }
    }
    return v;
}

static vn_status sloping(double *value, const double p[3], void *payload) {
    (void)payload;
    *value = p[0] < 0 ? 0.2 : p[1] > 0 ? 1 : 0.6;
    return VN_OK;
}

/// What darts are compared in.
typedef struct place {
    const char *name;
    vn_domain *region;
    vn_cco_value_fn *density;
    double mean; ///< density, as the darts know it
} place;

// One dart after another, as the paper has it; the darts thrown.
static int64_t throw_plainly(const place *at, const vn_dart_search *search, vn_rng *rng, double p[3]) {
    double threshold = search->threshold;
    for (int64_t thrown = 1;; thrown++) {
        double density = 1, here = threshold;
        int32_t nearest;
        do {
            assert_ok(vn_domain_dart(at->region, rng, p));
            assert_ok(at->density != NULL ? at->density(&density, p, NULL) : VN_OK);
        } while (vn_rng_uniform(rng, 0, 1) >= density);
        here *= at->density != NULL ? pow(at->mean / density, 1.0 / vn_domain_dim(at->region)) : 1;
        if (distance(p, &nearest, search->payload) > here && !search->refuse(p, search->payload)) {
            return thrown;
        }
        threshold *= thrown % search->tries == 0 ? search->factor : 1;
    }
}

enum { ACROSS = 12, CLASSES = ACROSS * ACROSS, LEVELS = 40 };

static int32_t class_of(const vn_domain *region, const double p[3]) {
    vn_box b = vn_domain_bounds(region);
    int32_t at[2];
    for (int k = 0; k < 2; k++) {
        at[k] = (int32_t)(ACROSS * (p[k] - b.min[k]) / (b.max[k] - b.min[k]));
    }
    return (at[0] < ACROSS ? at[0] : ACROSS - 1) * ACROSS + (at[1] < ACROSS ? at[1] : ACROSS - 1);
}

/// What came of many throws.
typedef struct counts {
    int32_t cells[CLASSES], levels[LEVELS];
    double darts;
} counts;

static void count(counts *c, const place *at, const double p[3], int64_t thrown, int32_t tries) {
    int64_t level = (thrown - 1) / tries;
    c->cells[class_of(at->region, p)]++;
    c->levels[level < LEVELS ? level : LEVELS - 1]++;
    c->darts += (double)thrown;
}

static void compare_throws(const place *at, vn_darts *darts, const vn_dart_search *search, int32_t throws,
                           vn_rng *rng) {
    vessels *v = search->payload;
    counts ours = {0}, plain = {0};
    double threshold = search->threshold, factor = search->factor;
    int32_t tries = search->tries;
    for (int32_t i = 0; i < throws; i++) {
        double p[3] = {0};
        int64_t thrown = 0;
        int32_t nearest;
        assert_ok(vn_darts_throw(darts, search, rng, p, &thrown));
        assert_false(search->refuse(p, v));
        assert_true(factor < 1 || distance(p, &nearest, v) > threshold * pow(darts->mean, 1.0 / darts->dim));
        count(&ours, at, p, thrown, tries);
        thrown = throw_plainly(at, search, rng, p);
        count(&plain, at, p, thrown, tries);
    }
    double cells = two_sample_excess(ours.cells, plain.cells, CLASSES);
    double levels = two_sample_excess(ours.levels, plain.levels, LEVELS);
    print_message("%s, threshold %g: places %.2f, levels %.2f deviations off; %.4f darts against %.4f\n",
                  at->name, threshold, cells, levels, ours.darts / throws, plain.darts / throws);
    assert_true(cells < 4);
    assert_true(levels < (at->density != NULL ? 8 : 4)); // its mean is known to a hundredth
    assert_near(ours.darts / plain.darts, 1, 0.05);
}

static void compare(place *at, double threshold, double factor, int32_t tries, int32_t throws,
                    uint64_t seed) {
    vn_rng rng = vn_rng_make(seed);
    vessels v = random_vessels(at->region, 12, &rng);
    vn_dart_search search = search_of(&v, threshold, factor, tries);
    search.most_cells = seed % 2 == 0 ? INT32_MAX : 100;
    vn_darts darts = {0};
    assert_ok(vn_darts_init(&darts, vn_domain_dim(at->region), at->region, 0, at->density, NULL, &rng));
    at->mean = darts.mean;
    assert_ok(tell_all(&darts, &v));
    compare_throws(at, &darts, &search, throws, &rng);
    vn_darts_free(&darts);
}

static vn_domain *holed_polygon(void) {
    static const double xy[] = {-5, -5, 5, -5, 5, 5, 0, 2, -5, 5, -2, -2, -2, 0, 1, 0, 2, -3};
    static const int32_t sizes[] = {5, 4};
    vn_domain *domain = NULL;
    assert_ok(vn_domain_polygon(&domain, xy, sizes, 2));
    return domain;
}

static void as_darts_thrown_anywhere(void **state) {
    (void)state;
    vn_domain *regions[] = {disk_of(0, 0, 5), holed_polygon(), ball_of(0, 0, 0, 5)};
    const char *names[] = {"disk", "polygon", "ball"};
    for (int i = 0; i < 6; i++) {
        place at = {names[i / 2], regions[i / 2], i % 2 ? sloping : NULL, 1};
        double reach = i / 2 == 2 ? 2 : 1;
        compare(&at, reach, 0.999, INT32_MAX, 20000, 5 + (uint64_t)i);
        compare(&at, 2.5 * reach, 0.9, 20, 8000, 15 + (uint64_t)i);
    }
    for (int i = 0; i < 3; i++) {
        vn_domain_release(regions[i]);
    }
}

static bool refuse_nothing(const double p[3], void *payload) {
    (void)p, (void)payload;
    return false;
}

static void throw_in_vain(vn_darts *darts, vn_dart_search search, vn_rng *rng) {
    double p[3];
    int64_t thrown = 0;
    search.tries = 100;
    assert_ok(vn_darts_throw(darts, &search, rng, p, &thrown));
    assert_true(thrown > search.tries);
}

// All of a square, or a cube, is as near to the vessel in its middle as no dart may be; the cells know. Then
// the vessel bends by all it may untold: there is room in a corner again.
static void compare_bent(int dim, double threshold, double tolerance) {
    vn_rng rng = vn_rng_make(25);
    vn_domain *region = dim == 3 ? solid_box(-5, -5, -5, 5, 5, 5) : box_of(-5, -5, 5, 5);
    place at = {"bent", region, NULL, 1};
    vessels v = {.ends = {{{0, 0, -5}, {0, 0, 5}}}, .count = 1};
    vn_dart_search search = search_of(&v, threshold, 0.999, INT32_MAX);
    vn_darts darts = {0};
    search.refuse = refuse_nothing;
    assert_ok(vn_darts_init(&darts, dim, region, tolerance, NULL, NULL, &rng));
    assert_ok(tell_all(&darts, &v));
    throw_in_vain(&darts, search, &rng);
    for (int k = 0; k < 4; k++) {
        v.ends[0][k / 2][k % 2] += tolerance / sqrt(2);
    }
    compare_throws(&at, &darts, &search, 4000, &rng);
    vn_darts_free(&darts);
    vn_domain_release(region);
}

static void darts_allow_for_vessels_that_bent_untold(void **state) {
    (void)state;
    compare_bent(2, 7.6, 1);
    compare_bent(3, 7.5, 1);
}

// Also where a cell reaches out of the region by a corner only.
static void darts_fall_into_the_region(void **state) {
    (void)state;
    vn_domain *regions[] = {disk_of(0, 0, 5), holed_polygon(), ball_of(0, 0, 0, 5)};
    for (int i = 0; i < 3; i++) {
        vn_rng rng = vn_rng_make(3);
        vessels v = random_vessels(regions[i], 40, &rng);
        vn_dart_search search = search_of(&v, 0.7, 0.999, INT32_MAX);
        vn_darts darts = {0};
        int32_t outside = 0;
        assert_ok(vn_darts_init(&darts, vn_domain_dim(regions[i]), regions[i], 0, NULL, NULL, &rng));
        for (int k = 0; k < 20000; k++) {
            double p[3];
            int64_t thrown = 0;
            assert_ok(vn_darts_throw(&darts, &search, &rng, p, &thrown));
            outside += !vn_domain_contains(regions[i], p);
        }
        print_message("%d of 20000 darts fell outside\n", outside);
        assert_int_equal(outside, 0);
        vn_darts_free(&darts);
        vn_domain_release(regions[i]);
    }
}

// ---- Bounds ----

// The leaf that a point lies in, its middle and half its diagonal.
static const vn_dart_cell *leaf_at(const vn_darts *darts, const double p[3], double middle[3], double *half) {
    double low[3] = {darts->low[0], darts->low[1], darts->low[2]}, side = darts->side;
    const vn_dart_cell *c = &darts->cells.data[0];
    while (c->link < -1) {
        int child = 0;
        side /= 2;
        for (int k = 0; k < 3; k++) {
            bool upper = k < darts->dim && p[k] >= low[k] + side;
            child |= upper << k;
            low[k] += upper ? side : 0;
        }
        c = &darts->cells.data[~c->link + child];
    }
    for (int k = 0; k < 3; k++) {
        middle[k] = low[k] + (k < darts->dim ? side / 2 : 0);
    }
    *half = side / 2 * sqrt(darts->dim);
    return c;
}

static void check_bounds(const vn_darts *darts, const vn_domain *region, vessels *v, vn_rng *rng) {
    for (int i = 0; i < 300; i++) {
        double p[3], middle[3], half;
        int32_t nearest;
        assert_ok(vn_domain_dart(region, rng, p));
        const vn_dart_cell *leaf = leaf_at(darts, p, middle, &half);
        assert_true(leaf->link >= 0); // it can be hit
        assert_true(distance(p, &nearest, v) <= leaf->bound);
        assert_true(distance(middle, &nearest, v) + half <= leaf->bound); // so all about the middle is near
        assert_true(leaf->witness[0] < v->count && leaf->witness[1] < v->count);
    }
}

// Connect p to a vessel somewhat off it, or leave the vessel be.
static void grow(vn_darts *darts, vessels *v, const double p[3], vn_rng *rng) {
    int32_t at = (int32_t)whole(rng, 0, v->count - 1);
    double x[3] = {0}, t = uniform(rng, 0.05, 0.95), told[3][2][3];
    for (int k = 0; k < darts->dim; k++) {
        x[k] = v->ends[at][0][k] + t * (v->ends[at][1][k] - v->ends[at][0][k]) + uniform(rng, -0.5, 0.5);
    }
    double moved = sqrt(vn_point_segment_distance2(x, v->ends[at][0], v->ends[at][1]));
    const double *ends[3][2] = {{v->ends[at][0], x}, {x, v->ends[at][1]}, {x, p}};
    for (int i = 0; i < 3; i++) {
        memcpy(told[i][0], ends[i][0], sizeof told[i][0]);
        memcpy(told[i][1], ends[i][1], sizeof told[i][1]);
    }
    memcpy(v->ends[at], told[1], sizeof told[1]); // the lower part keeps the number
    memcpy(v->ends[v->count++], told[0], sizeof told[0]);
    memcpy(v->ends[v->count++], told[2], sizeof told[2]);
    const int32_t numbers[] = {v->count - 2, at, v->count - 1};
    assert_ok(vn_darts_tell(darts, numbers, (const double(*)[2][3])told, 3, moved));
}

static void bounds_hold_while_vessels_move(void **state) {
    (void)state;
    vn_domain *regions[] = {disk_of(0, 0, 5), holed_polygon(), ball_of(0, 0, 0, 5)};
    for (int i = 0; i < 60; i++) {
        const vn_domain *region = regions[i % 3];
        vn_rng rng = vn_rng_make(40 + (uint64_t)i);
        vessels v = random_vessels(region, 2, &rng);
        vn_darts darts = {0};
        assert_ok(vn_darts_init(&darts, vn_domain_dim(region), region, 0, NULL, NULL, &rng));
        assert_ok(tell_all(&darts, &v));
        while (v.count < 62) {
            vn_dart_search search = search_of(&v, 8 / sqrt(v.count), 0.9, 100);
            double p[3];
            int64_t thrown = 0;
            search.most_cells = i % 2 == 0 ? INT32_MAX : 50;
            assert_ok(vn_darts_throw(&darts, &search, &rng, p, &thrown));
            assert_true(darts.cells.count - 8 < search.most_cells);
            grow(&darts, &v, p, &rng);
            check_bounds(&darts, region, &v, &rng);
        }
        vn_darts_free(&darts);
    }
    for (int i = 0; i < 3; i++) {
        vn_domain_release(regions[i]);
    }
}

// The same in a tree that grows by all rules.
static void check_tree_bounds(int dim, int placement) {
    vn_domain *domain = dim == 3 ? ball_of_measure(20000) : disk_of_measure(20000);
    vn_cco_def def = vn_cco_def_default();
    vn_cco_tree_def one = vn_cco_tree_def_default();
    vn_cco *cco;
    int32_t added, low = 0;
    vn_rng rng = vn_rng_make(8);
    def.domain = domain;
    def.terminals = 400;
    def.placement = placement;
    one.root[1] = top_of(domain);
    assert_ok(vn_cco_create(&cco, &def));
    add_tree(cco, &one);
    for (int i = 0; i < 40; i++) {
        assert_ok(vn_cco_grow(cco, i < 10 ? 1 : 10, &added));
        const vn_grower *g = vn_cco_tree_at(cco, 0);
        for (int k = 0; k < 300; k++) {
            double p[3], middle[3], half;
            int32_t node;
            assert_ok(vn_domain_dart(domain, &rng, p));
            double bound = leaf_at(&g->darts, p, middle, &half)->bound + g->darts.tolerance;
            vn_seek seek = placement == VN_PLACE_TERMINALS ? VN_SEEK_TERMINAL : VN_SEEK_AXIS;
            low += vn_places_seek(g, p, seek, &node) > bound;
            low += vn_places_seek(g, middle, seek, &node) + half > bound;
        }
    }
    print_message(
        "%dD, placement %d: %d of 12000 points are farther than their cell's bound, or its middle\n", dim,
        placement, low);
    assert_int_equal(low, 0);
    vn_cco_destroy(cco);
    vn_domain_release(domain);
}

static void bounds_hold_in_trees(void **state) {
    (void)state;
    check_tree_bounds(2, VN_PLACE_SEGMENTS);
    check_tree_bounds(3, VN_PLACE_SEGMENTS);
}

static void bounds_hold_between_terminals(void **state) {
    (void)state;
    check_tree_bounds(2, VN_PLACE_TERMINALS);
    check_tree_bounds(3, VN_PLACE_TERMINALS);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(as_darts_thrown_anywhere),   counted_test(darts_allow_for_vessels_that_bent_untold),
        counted_test(darts_fall_into_the_region), counted_test(bounds_hold_while_vessels_move),
        counted_test(bounds_hold_in_trees),       counted_test(bounds_hold_between_terminals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
