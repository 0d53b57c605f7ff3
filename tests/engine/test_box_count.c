// Boxes that lines pass, against an exact test of each box, and the dimension of figures that have a known
// one.
#include "support.h"

#include "network/vessels.h"
#include "space/box_set.h"

// ---- Boxes ----

enum { SIDE = 8, PARTS = VN_BOX_PARTS };

/// A number of the line's way, as a fraction, and whether it belongs to it.
typedef struct bound {
    int64_t top, bottom;
    bool closed;
} bound;

static int compare(const bound *a, const bound *b) {
    int64_t left = a->top * b->bottom, right = b->top * a->bottom;
    return (left > right) - (left < right);
}

// The part of the way on which `low <= a + t (b - a) < high`, cut from [from, to]; false where there is none.
static bool cut(int64_t a, int64_t b, int64_t low, int64_t high, bound *from, bound *to) {
    int64_t size = b > a ? b - a : a - b;
    if (size == 0) {
        return low <= a && a < high;
    }
    bound enter = b > a ? (bound){low - a, size, true} : (bound){a - high, size, false};
    bound leave = b > a ? (bound){high - a, size, false} : (bound){a - low, size, true};
    int at = compare(&enter, from);
    *from =
        at > 0 ? enter : (at == 0 ? (bound){from->top, from->bottom, from->closed && enter.closed} : *from);
    at = compare(&leave, to);
    *to = at < 0 ? leave : (at == 0 ? (bound){to->top, to->bottom, to->closed && leave.closed} : *to);
    return true;
}

static bool passes(int dim, const int64_t a[3], const int64_t b[3], const int64_t box[3]) {
    bound from = {0, 1, true}, to = {1, 1, true};
    for (int k = 0; k < dim; k++) {
        if (!cut(a[k], b[k], box[k] * PARTS, (box[k] + 1) * PARTS, &from, &to)) {
            return false;
        }
    }
    int at = compare(&from, &to);
    return at < 0 || (at == 0 && from.closed && to.closed);
}

// Corners and faces more often than not.
static void random_place(vn_rng *rng, int dim, int64_t p[3]) {
    bool fine = whole(rng, 0, 1) == 0;
    for (int k = 0; k < 3; k++) {
        p[k] = fine ? whole(rng, 0, SIDE * PARTS - 1) : whole(rng, 0, 2 * SIDE - 1) * PARTS / 2;
        p[k] = k < dim ? p[k] : 0;
    }
}

static void lines_take_the_boxes_that_they_pass(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(4);
    vn_box_set set = {0};
    for (int round = 0; round < 6000; round++) {
        int dim = 2 + round % 2;
        int64_t a[3], b[3], count = 0;
        random_place(&rng, dim, a);
        random_place(&rng, dim, b);
        assert_ok(vn_box_set_clear(&set, dim, SIDE));
        vn_box_set_add(&set, a, b);
        for (int64_t box = 0; box < SIDE * SIDE * (dim == 3 ? SIDE : 1); box++) {
            int64_t at[3] = {box % SIDE, box / SIDE % SIDE, box / SIDE / SIDE};
            bool taken = passes(dim, a, b, at);
            assert_int_equal(vn_box_set_has(&set, at), taken);
            count += taken;
        }
        assert_true(vn_box_set_count(&set) == count);
    }
    vn_box_set_free(&set);
}

static void larger_boxes_hold_smaller_ones(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(8);
    vn_box_set set = {0}, larger = {0};
    for (int round = 0; round < 200; round++) {
        int dim = 2 + round % 2;
        assert_ok(vn_box_set_clear(&set, dim, SIDE));
        for (int line = 0; line < 3; line++) {
            int64_t a[3], b[3];
            random_place(&rng, dim, a);
            random_place(&rng, dim, b);
            vn_box_set_add(&set, a, b);
        }
        assert_ok(vn_box_set_double(&larger, &set));
        for (int64_t box = 0; box < SIDE * SIDE * SIDE / 8; box++) {
            int64_t at[3] = {box % (SIDE / 2), box / (SIDE / 2) % (SIDE / 2), box * 4 / SIDE / SIDE};
            bool any = false;
            for (int part = 0; part < 1 << dim; part++) {
                int64_t in[3] = {2 * at[0] + part % 2, 2 * at[1] + part / 2 % 2, 2 * at[2] + part / 4};
                any = any || (at[2] < (dim == 3 ? SIDE / 2 : 1) && vn_box_set_has(&set, in));
            }
            assert_true(at[2] >= (dim == 3 ? SIDE / 2 : 1) || vn_box_set_has(&larger, at) == any);
        }
    }
    vn_box_set_free(&set);
    vn_box_set_free(&larger);
}

// ---- Figures ----

/// A figure in a plane that lies in space anyhow.
typedef struct easel {
    vn_network *network;
    double turn, tilt;
} easel;

static void place(const easel *e, double x, double y, double p[3]) {
    double along = x * cos(e->turn) - y * sin(e->turn), up = x * sin(e->turn) + y * cos(e->turn);
    p[0] = along;
    p[1] = up * cos(e->tilt);
    p[2] = up * sin(e->tilt);
}

static int32_t begin(const easel *e, double x, double y) {
    double p[3];
    place(e, x, y, p);
    return put_root(e->network, p[0], p[1], p[2]);
}

static int32_t draw_to(const easel *e, int32_t from, double x, double y) {
    double p[3];
    place(e, x, y, p);
    return put_child(e->network, from, p[0], p[1], p[2]);
}

static int32_t koch(const easel *e, int32_t at, const double a[2], const double b[2], int depth) {
    double x = (b[0] - a[0]) / 3, y = (b[1] - a[1]) / 3, rise = sqrt(3) / 2;
    double p[2] = {a[0] + x, a[1] + y}, r[2] = {a[0] + 2 * x, a[1] + 2 * y};
    double q[2] = {p[0] + x / 2 - rise * y, p[1] + rise * x + y / 2};
    if (depth == 0) {
        return draw_to(e, at, b[0], b[1]);
    }
    at = koch(e, at, a, p, depth - 1);
    at = koch(e, at, p, q, depth - 1);
    at = koch(e, at, q, r, depth - 1);
    return koch(e, at, r, b, depth - 1);
}

static void sierpinski(const easel *e, double x, double y, double side, int depth) {
    double height = sqrt(3) / 2 * side;
    if (depth == 0) {
        int32_t a = begin(e, x, y), b = draw_to(e, a, x + side, y),
                c = draw_to(e, b, x + side / 2, y + height);
        assert_ok(vn_network_join(e->network, c, a, 0));
        return;
    }
    sierpinski(e, x, y, side / 2, depth - 1);
    sierpinski(e, x + side / 2, y, side / 2, depth - 1);
    sierpinski(e, x + side / 4, y + height / 2, side / 2, depth - 1);
}

static vn_boxes counted(const vn_network *network) {
    vn_boxes boxes;
    vn_boxes_def def = vn_boxes_def_default();
    assert_ok(vn_network_measure_boxes(network, &def, &boxes));
    return boxes;
}

static double dimension_of(const easel *e) {
    vn_boxes boxes = counted(e->network);
    assert_int_equal(boxes.sizes, 7);
    assert_true(boxes.r2 > 0.998);
    vn_network_destroy(e->network);
    return boxes.dimension;
}

// The ranges that the header promises.
static void check_figures(int dim, double turn) {
    easel e = {network_of(dim), turn, dim == 3 ? 0.2 + 0.7 * turn : 0};
    draw_to(&e, begin(&e, 0, 0), 1, 0);
    double line = dimension_of(&e);
    e.network = network_of(dim);
    koch(&e, begin(&e, 0, 0), (double[]){0, 0}, (double[]){1, 0}, 7);
    double curve = dimension_of(&e);
    e.network = network_of(dim);
    sierpinski(&e, 0, 0, 1, 8);
    double triangle = dimension_of(&e);
    e.network = network_of(dim);
    for (int i = 0; i <= 512; i++) {
        draw_to(&e, begin(&e, i / 512.0, 0), i / 512.0, 1);
    }
    double square = dimension_of(&e);
    assert_true(line > 0.999 && line <= 1.05);
    assert_true(curve >= 1.27 && curve <= 1.33);
    assert_true(triangle >= 1.58 && triangle <= 1.64);
    assert_true(square >= 1.85 && square <= 2.03);
}

static void known_figures_have_their_dimension(void **state) {
    (void)state;
    static const double turns[] = {0, 0.3, 1, 2.2};
    for (int i = 0; i < 4; i++) {
        check_figures(2, turns[i]);
        check_figures(3, turns[i]);
    }
}

// Along the axes counts are those of arithmetic.
static void lines_along_axes_count_exactly(void **state) {
    (void)state;
    for (int axis = 0; axis < 3; axis++) {
        vn_network *network = network_of(3);
        int32_t root = put_root(network, 0.1, -7, 3);
        put_child(network, root, 0.1 + 5 * (axis == 0), -7 + 5 * (axis == 1), 3 + 5 * (axis == 2));
        vn_boxes boxes = counted(network);
        for (int32_t k = 0; k < boxes.sizes; k++) {
            assert_true(boxes.count[k] == 4 << k);
            assert_near(boxes.side[k], 5.0 / (4 << k), 1e-12);
        }
        assert_near(boxes.dimension, 1, 1e-12);
        assert_near(boxes.r2, 1, 1e-12);
        vn_network_destroy(network);
    }
}

// The least of several is what the first alone has, or less.
static void more_grids_never_count_more(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 6; seed++) {
        vn_network *network = random_tree(2 + seed % 2, 300, 2, seed);
        vn_boxes one, many;
        vn_boxes_def def = {.coarsest = 0, .finest = 7, .offsets = 1};
        assert_ok(vn_network_measure_boxes(network, &def, &one));
        def.offsets = 40;
        assert_ok(vn_network_measure_boxes(network, &def, &many));
        assert_int_equal(one.sizes, 8);
        bool fewer = false;
        for (int32_t k = 0; k < one.sizes; k++) {
            assert_true(many.count[k] <= one.count[k] && many.count[k] >= 1);
            assert_true(k == 0 || many.count[k] >= many.count[k - 1]);
            fewer = fewer || many.count[k] < one.count[k];
        }
        assert_true(fewer && one.count[0] == 1);
        vn_network_destroy(network);
    }
}

static void points_have_no_dimension(void **state) {
    (void)state;
    vn_network *network = network_of(2);
    put_child(network, put_root(network, 3, 4, 0), 3, 4, 0);
    vn_boxes boxes = counted(network);
    assert_true(boxes.dimension == 0 && boxes.r2 == 1 && boxes.extent == 0 && boxes.count[6] == 1);
    vn_network_destroy(network);
}

static void refused(const vn_network *network, const vn_boxes_def *def, const char *part) {
    vn_boxes boxes;
    assert_int_equal(vn_network_measure_boxes(network, def, &boxes), VN_INVALID);
    assert_message(part);
    assert_int_equal(boxes.sizes, 0);
}

static void bad_requests_are_refused(void **state) {
    (void)state;
    vn_network *network = network_of(3);
    vn_boxes_def def = vn_boxes_def_default();
    refused(network, &def, "measure_boxes: the network is empty; grow or load it first");
    put_child(network, put_root(network, 0, 0, 0), 1e308, 0, 0);
    put_child(network, 0, -1e308, 0, 0);
    refused(network, &def,
            "measure_boxes: node 1 at (1e+308, 0, 0) is beyond 1e+150; use another length unit");
    def.finest = 2;
    refused(network, &def, "measure_boxes.finest = 2 must be above coarsest = 2");
    def.finest = 11;
    refused(network, &def, "measure_boxes.finest = 11 must be at most 10 in 3D: there would be 2^33 boxes");
    def.finest = 16;
    refused(network, &def, "measure_boxes.finest = 16 must be at most 15");
    def.offsets = 0;
    def.finest = 8;
    refused(network, &def, "measure_boxes.offsets = 0 must be at least 1 grids");
    vn_network_destroy(network);
}

static void memory_may_run_out_anywhere(void **state) {
    (void)state;
    vn_network *network = random_tree(3, 50, 1, 2);
    vn_boxes_def def = vn_boxes_def_default();
    vn_status status = VN_NO_MEMORY;
    for (int64_t nth = 0; status == VN_NO_MEMORY; nth++) {
        vn_boxes boxes;
        vn_fail_allocations_from(nth);
        status = vn_network_measure_boxes(network, &def, &boxes);
        vn_fail_allocations_from(-1);
        assert_true(status == VN_OK || nth < 10);
    }
    assert_ok(status);
    vn_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(lines_take_the_boxes_that_they_pass),
        counted_test(larger_boxes_hold_smaller_ones),
        counted_test(known_figures_have_their_dimension),
        counted_test(lines_along_axes_count_exactly),
        counted_test(more_grids_never_count_more),
        counted_test(points_have_no_dimension),
        counted_test(bad_requests_are_refused),
        counted_test(memory_may_run_out_anywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
