// Searches in space against asking every point, on sets that are random, degenerate and hostile.
#include "support.h"

#include "space/cover.h"
#include "space/point_grid.h"
#include "space/reach_tree.h"
#include "space/segment_grid.h"

enum { MOST = 700 };

typedef struct cloud {
    int dim;
    int32_t count;
    double x[MOST], y[MOST], z[MOST];
} cloud;

static vn_points points_of(const cloud *c) {
    return (vn_points){c->x, c->y, c->dim == 3 ? c->z : NULL};
}

static void add_point(cloud *c, double x, double y, double z) {
    assert_true(c->count < MOST);
    c->x[c->count] = x;
    c->y[c->count] = y;
    c->z[c->count++] = c->dim == 3 ? z : 0;
}

enum {
    RANDOM,
    CLUSTERED,
    LATTICE,
    DECIMAL_LATTICE,
    THIRDS,
    COINCIDENT,
    COLLINEAR,
    HUGE_NUMBERS,
    MIXED_SCALES,
    KINDS
};

static double coordinate(vn_rng *rng, int kind) {
    switch (kind) {
    case CLUSTERED:
        return (double)whole(rng, 0, 3) * 100 + uniform(rng, 0, 1e-3);
    case LATTICE:
        return (double)whole(rng, -6, 6);
    case DECIMAL_LATTICE:
        return (double)whole(rng, -6, 6) * 0.1;
    case THIRDS:
        return (double)whole(rng, -6, 6) / 3.0;
    case COINCIDENT:
        return 2;
    case HUGE_NUMBERS:
        return (double)whole(rng, -2, 2) * 1e150 + uniform(rng, -1, 1);
    case MIXED_SCALES:
        return uniform(rng, -1, 1) * pow(10, (double)whole(rng, -12, 12));
    default:
        return uniform(rng, -3, 3);
    }
}

static void some_place(vn_rng *rng, int kind, int dim, double p[3]) {
    for (int k = 0; k < 3; k++) {
        p[k] = k < dim ? coordinate(rng, kind) : 0;
    }
    if (kind == COLLINEAR) {
        p[1] = 2 * p[0];
        p[2] = dim == 3 ? -p[0] : 0;
    }
}

static void fill_cloud(cloud *c, vn_rng *rng, int kind, int dim, int32_t count) {
    c->dim = dim;
    c->count = 0;
    for (int32_t i = 0; i < count; i++) {
        double p[3];
        some_place(rng, kind, dim, p);
        add_point(c, p[0], p[1], p[2]);
    }
}

static const cloud *odd_only; // what the filter filters

static bool is_odd(int32_t point, void *payload) {
    assert_ptr_equal(payload, &odd_only);
    return point % 2 == 1;
}

// A place of the cloud's kind, one of its points, or somewhere else.
static void query_place(vn_rng *rng, const cloud *c, int kind, double p[3]) {
    int64_t how = whole(rng, 0, 3);
    some_place(rng, kind, c->dim, p);
    if (how == 0) {
        vn_points points = points_of(c);
        vn_points_get(&points, (int32_t)whole(rng, 0, c->count - 1), p);
    } else if (how == 1) {
        for (int k = 0; k < c->dim && k < 3; k++) {
            p[k] += uniform(rng, -1, 1) * pow(10, (double)whole(rng, -3, 3));
        }
    }
}

static void check_nearest(const vn_point_grid *grid, const cloud *c, const double p[3], double reach,
                          bool odd, uint64_t id) {
    vn_points points = points_of(c);
    vn_nearest query = {
        .reach2 = reach * reach, .seed = 7, .id = id, .accept = odd ? is_odd : NULL, .payload = &odd_only};
    int32_t best = -1;
    double least = reach * reach;
    for (int32_t i = odd; i < c->count; i += 1 + odd) {
        double d2 = vn_points_distance2(&points, i, p);
        if (d2 < least || (d2 == least && (best < 0 || vn_ranks_before(7, id, i, best)))) {
            best = i;
            least = d2;
        }
    }
    vn_point_grid_nearest(grid, &points, p, &query);
    if (query.point != best || (best >= 0 && query.reach2 != least)) {
        fail_msg(
            "nearest to (%.17g, %.17g, %.17g) is %d at %.17g and should be %d at %.17g (cell %g, %d points)",
            p[0], p[1], p[2], query.point, query.reach2, best, least, grid->cell, c->count);
    }
}

static void check_within(const vn_point_grid *grid, const cloud *c, const double p[3], double radius,
                         bool odd) {
    vn_points points = points_of(c);
    bool any = false;
    for (int32_t i = odd; i < c->count; i += 1 + odd) {
        any = any || vn_points_distance2(&points, i, p) < radius * radius;
    }
    int32_t found = vn_point_grid_any_within(grid, &points, p, radius, odd ? is_odd : NULL, &odd_only);
    assert_int_equal(found >= 0, any);
    if (found >= 0) {
        assert_true(vn_points_distance2(&points, found, p) < radius * radius);
        assert_true(!odd || found % 2 == 1);
    }
}

static double some_reach(vn_rng *rng, int kind) {
    static const double lattice[] = {0.1, 0.2, 0.3, 1.0 / 3, 1, 2};
    if (whole(rng, 0, 3) == 0) {
        return INFINITY;
    }
    return kind == LATTICE || kind == DECIMAL_LATTICE || kind == THIRDS ? lattice[whole(rng, 0, 5)]
                                                                        : pow(10, uniform(rng, -4, 3));
}

static void ask_grid(const vn_point_grid *grid, const cloud *c, vn_rng *rng, int kind) {
    for (int q = 0; q < 60 && c->count > 0; q++) {
        double p[3];
        query_place(rng, c, kind, p);
        double reach = some_reach(rng, kind);
        check_nearest(grid, c, p, reach, q % 5 == 0, (uint64_t)q);
        check_within(grid, c, p, reach, q % 7 == 0);
    }
}

static void a_point_grid_finds_what_asking_everybody_finds(void **state) {
    static const double cells[] = {0.1, 0.3, 1, 1.0 / 3, 0.7, 7, 1e-6, 1e4};
    static cloud c;
    (void)state;
    vn_rng rng = vn_rng_make(1);
    for (int round = 0; round < 360; round++) {
        int kind = round % KINDS, dim = round / KINDS % 2 + 2;
        vn_point_grid grid;
        vn_point_grid_init(&grid, dim, cells[whole(&rng, 0, 7)]);
        fill_cloud(&c, &rng, kind, dim, (int32_t)whole(&rng, 1, round % 5 == 0 ? 600 : 60));
        vn_points points = points_of(&c);
        int32_t all = c.count;
        for (c.count = all / 3; c.count <= all; c.count += all - c.count > 0 ? (all - c.count + 1) / 2 : 1) {
            assert_ok(vn_point_grid_update(&grid, &points, c.count));
            assert_int_equal(vn_point_grid_count(&grid), c.count);
            ask_grid(&grid, &c, &rng, kind);
        }
        vn_point_grid_free(&grid);
    }
}

static void an_empty_grid_finds_nothing(void **state) {
    (void)state;
    vn_point_grid grid;
    vn_points points = {NULL, NULL, NULL};
    double p[3] = {1, 2, 0};
    vn_nearest query = {.reach2 = INFINITY};
    vn_point_grid_init(&grid, 2, 1);
    vn_point_grid_nearest(&grid, &points, p, &query);
    assert_int_equal(query.point, -1);
    assert_int_equal(vn_point_grid_any_within(&grid, &points, p, 1e9, NULL, NULL), -1);
    vn_point_grid_free(&grid);
}

static void far_points_do_not_confuse_a_grid(void **state) {
    static cloud c = {.dim = 2};
    (void)state;
    vn_point_grid grid;
    vn_point_grid_init(&grid, 2, 1e-9);
    c.count = 0;
    for (int i = 0; i < 40; i++) {
        add_point(&c, (i % 2 == 0 ? 1 : -1) * pow(10, 8 * i), i % 3, 0);
    }
    vn_points points = points_of(&c);
    assert_ok(vn_point_grid_update(&grid, &points, c.count));
    for (int i = 0; i < 40; i++) {
        double p[3] = {c.x[i], c.y[i] + 0.25, 0};
        check_nearest(&grid, &c, p, INFINITY, false, 3);
        check_nearest(&grid, &c, p, 0.2, false, 3);
        check_within(&grid, &c, p, 0.3, false);
    }
    vn_point_grid_free(&grid);
}

// ---- Points that remember ----

static int by_point(const void *a, const void *b) {
    return ((const vn_reach_hit *)a)->point - ((const vn_reach_hit *)b)->point;
}

static void check_hits(vn_reach_tree *tree, const cloud *c, const double *reach2, const double p[3]) {
    vn_points points = points_of(c);
    vn_reach_hits hits = {0};
    int32_t k = 0;
    assert_ok(vn_reach_tree_query(tree, &points, reach2, NULL, p, &hits));
    if (hits.count > 1) {
        qsort(hits.data, (size_t)hits.count, sizeof *hits.data, by_point);
    }
    for (int32_t i = 0; i < c->count; i++) {
        double d2 = vn_points_distance2(&points, i, p);
        if (d2 <= reach2[i]) {
            assert_true(k < hits.count);
            assert_int_equal(hits.data[k].point, i);
            assert_true(hits.data[k++].distance2 == d2);
        }
    }
    assert_int_equal(k, hits.count);
    vn_array_free(&hits);
}

static void change_memory(vn_reach_tree *tree, const cloud *c, vn_rng *rng, double *reach2) {
    vn_points points = points_of(c);
    for (int n = 0; n < 12; n++) {
        int32_t i = (int32_t)whole(rng, 0, c->count - 1);
        int64_t how = whole(rng, 0, 9);
        if (how == 0) {
            reach2[i] = -1;
        } else if (how == 1 && reach2[i] >= 0) {
            double p[3];
            vn_points_get(&points, i, p);
            reach2[i] = reach2[i] * 5 + 0.01;
            vn_reach_tree_raise(tree, p, reach2[i]);
        } else if (reach2[i] > 0) {
            reach2[i] *= isinf(reach2[i]) ? 0 : uniform(rng, 0, 1);
        }
    }
}

static void a_reach_tree_finds_what_asking_everybody_finds(void **state) {
    static cloud c;
    static double reach2[MOST];
    (void)state;
    vn_rng rng = vn_rng_make(2);
    for (int round = 0; round < 200; round++) {
        int kind = round % KINDS, dim = round / KINDS % 2 + 2;
        vn_reach_tree tree = {.dim = dim};
        fill_cloud(&c, &rng, kind, dim, (int32_t)whole(&rng, 1, round % 4 == 0 ? MOST : 90));
        for (int32_t i = 0; i < c.count; i++) {
            double reach = whole(&rng, 0, 9) == 0 ? INFINITY : pow(10, uniform(&rng, -3, 1));
            reach2[i] = whole(&rng, 0, 9) == 0 ? -1 : reach * reach;
        }
        for (int build = 0; build < 3; build++) {
            vn_points points = points_of(&c);
            assert_ok(vn_reach_tree_build(&tree, dim, &points, reach2, NULL, c.count));
            for (int q = 0; q < 40; q++) {
                double p[3];
                query_place(&rng, &c, kind, p);
                check_hits(&tree, &c, reach2, p);
                change_memory(&tree, &c, &rng, reach2);
            }
        }
        vn_reach_tree_free(&tree);
    }
}

typedef struct crowd {
    const cloud *c;
    int guards;
    double guard[24][3];
    double near2[MOST];
} crowd;

static bool is_kept_out(const void *payload, int32_t i, const double p[3], double d2, double guard[3]) {
    const crowd *all = payload;
    vn_points points = points_of(all->c);
    for (int g = 0; g < all->guards && d2 > all->near2[i]; g++) {
        double sure = (1 - 1e-12) * d2;
        if (vn_points_distance2(&points, i, all->guard[g]) < sure && vn_distance2(all->guard[g], p) < sure) {
            memcpy(guard, all->guard[g], sizeof all->guard[g]);
            return true;
        }
    }
    return false;
}

// What boxes are guarded from is what the points in them are guarded from one by one.
static void check_unguarded(vn_reach_tree *tree, const crowd *all, const double *reach2, const double p[3]) {
    vn_points points = points_of(all->c);
    vn_reach_filter filter = {is_kept_out, all, all->near2};
    vn_reach_hits hits = {0};
    int32_t k = 0;
    double guard[3];
    assert_ok(vn_reach_tree_query(tree, &points, reach2, &filter, p, &hits));
    if (hits.count > 1) {
        qsort(hits.data, (size_t)hits.count, sizeof *hits.data, by_point);
    }
    for (int32_t i = 0; i < all->c->count; i++) {
        double d2 = vn_points_distance2(&points, i, p);
        if (d2 <= reach2[i] && !is_kept_out(all, i, p, d2, guard)) {
            assert_true(k < hits.count);
            assert_int_equal(hits.data[k++].point, i);
        }
    }
    assert_int_equal(k, hits.count);
    vn_array_free(&hits);
}

// Guards come, and points heed what is farther off, or nearer alone.
static void change_interest(vn_reach_tree *tree, crowd *all, vn_rng *rng, int kind) {
    vn_points points = points_of(all->c);
    if (all->guards < 24 && whole(rng, 0, 9) == 0) {
        query_place(rng, all->c, kind, all->guard[all->guards++]);
    }
    for (int n = 0; n < 3; n++) {
        int32_t i = (int32_t)whole(rng, 0, all->c->count - 1);
        all->near2[i] *= uniform(rng, 0, 2);
        vn_reach_tree_raise_near(tree, &points, i, all->near2[i]);
    }
}

static void fill_crowd(crowd *all, const cloud *c, vn_rng *rng, double reach2[MOST]) {
    all->c = c;
    all->guards = 0;
    for (int32_t i = 0; i < c->count; i++) {
        double reach = whole(rng, 0, 3) > 0 ? INFINITY : pow(10, uniform(rng, -3, 1));
        reach2[i] = whole(rng, 0, 9) == 0 ? -1 : reach * reach;
        all->near2[i] = pow(10, uniform(rng, -6, 1));
    }
}

static void a_guarded_reach_tree_finds_what_nobody_keeps_out(void **state) {
    static cloud c;
    static crowd all;
    static double reach2[MOST];
    (void)state;
    vn_rng rng = vn_rng_make(3);
    for (int round = 0; round < 100; round++) {
        int kind = round % KINDS, dim = round / KINDS % 2 + 2;
        vn_reach_tree tree = {.dim = dim};
        fill_cloud(&c, &rng, kind, dim, (int32_t)whole(&rng, 1, round % 2 == 0 ? MOST : 90));
        fill_crowd(&all, &c, &rng, reach2);
        vn_points points = points_of(&c);
        vn_reach_filter filter = {is_kept_out, &all, all.near2};
        assert_ok(vn_reach_tree_build(&tree, dim, &points, reach2, &filter, c.count));
        for (int q = 0; q < 100; q++) {
            double p[3];
            query_place(&rng, &c, kind, p);
            check_unguarded(&tree, &all, reach2, p);
            change_interest(&tree, &all, &rng, kind);
            double *remembered = &reach2[whole(&rng, 0, c.count - 1)];
            *remembered = fmin(*remembered, whole(&rng, 0, 3) == 0 ? -1 : 0);
        }
        vn_reach_tree_free(&tree);
    }
}

static void a_tree_of_nobody_answers_nothing(void **state) {
    (void)state;
    vn_reach_tree tree = {0};
    vn_reach_hits hits = {0};
    double x[2] = {0, 1}, y[2] = {0, 1}, gone[2] = {-1, -1}, p[3] = {0, 0, 0};
    vn_points points = {x, y, NULL};
    assert_ok(vn_reach_tree_query(&tree, &points, gone, NULL, p, &hits));
    assert_ok(vn_reach_tree_build(&tree, 2, &points, gone, NULL, 2));
    vn_reach_tree_raise(&tree, p, 4);
    assert_ok(vn_reach_tree_query(&tree, &points, gone, NULL, p, &hits));
    assert_ok(vn_reach_tree_build(&tree, 2, &points, gone, NULL, 0));
    assert_ok(vn_reach_tree_query(&tree, &points, gone, NULL, p, &hits));
    assert_int_equal(hits.count, 0);
    vn_array_free(&hits);
    vn_reach_tree_free(&tree);
}

// ---- Segments ----

enum { LINES, UPRIGHT, ALMOST_UPRIGHT, OUTLINE, POINTS_ONLY, FAR_AWAY, TURNED_BOX, SEGMENT_KINDS };

static vn_segment some_segment(vn_rng *rng, int kind, int i, int count) {
    double a = uniform(rng, 0, 10), b = uniform(rng, 0, 10), c = uniform(rng, 0, 10), d = uniform(rng, 0, 10);
    double t = 6.283185307179586 * i / count, u = 6.283185307179586 * (i + 1) / count;
    static const double box[5][2] = {{3, 1}, {933, 1}, {933, 701}, {3, 701}, {3, 1}};
    double wobble = uniform(rng, -4, 4) * 1e-13;
    switch (kind) {
    case UPRIGHT:
        return (vn_segment){floor(a), floor(b), floor(a), floor(d)};
    case ALMOST_UPRIGHT:
        return (vn_segment){floor(a) + 100, b + 300, floor(a) + 100 + uniform(rng, -3, 3) * 1e-13, d + 300};
    case OUTLINE:
        return (vn_segment){5 * cos(t), 5 * sin(t), 5 * cos(u), 5 * sin(u)};
    case POINTS_ONLY:
        return (vn_segment){a, b, a, b};
    case FAR_AWAY:
        return (vn_segment){a + 1e9, b - 1e9, a + 1e9 + 1e-6 * c, d - 1e9};
    case TURNED_BOX:
        return (vn_segment){box[i % 4][0], box[i % 4][1], box[i % 4 + 1][0] + wobble,
                            box[i % 4 + 1][1] - wobble};
    default:
        return (vn_segment){a, b, c, d};
    }
}

static double to_segment(const vn_segment *s, double x, double y) {
    double dx = s->x1 - s->x0, dy = s->y1 - s->y0, length2 = dx * dx + dy * dy;
    double t = length2 > 0 ? ((x - s->x0) * dx + (y - s->y0) * dy) / length2 : 0;
    t = fmin(fmax(t, 0), 1);
    double qx = s->x0 + t * dx, qy = s->y0 + t * dy;
    return (x - qx) * (x - qx) + (y - qy) * (y - qy);
}

static void check_nearest_segment(const vn_segment_grid *grid, double x, double y) {
    int32_t best = -1;
    double least = INFINITY, d2, q[2];
    for (int32_t i = 0; i < grid->segments.count; i++) {
        double here = to_segment(&grid->segments.data[i], x, y);
        if (here < least) {
            best = i;
            least = here;
        }
    }
    int32_t found = vn_segment_grid_nearest(grid, x, y, &d2, q);
    if (d2 > least * (1 + 1e-9) + 1e-15 || (found != best && d2 != least)) {
        fail_msg("to (%.17g, %.17g) %d is nearest, at %.17g, and not %d, at %.17g", x, y, best, least, found,
                 d2);
    }
    assert_near(hypot(x - q[0], y - q[1]), sqrt(d2), 1e-9 * (1 + sqrt(d2)));
}

static bool mark_visited(int32_t segment, void *payload) {
    ((bool *)payload)[segment] = true;
    return true;
}

static bool stop_at_once(int32_t segment, void *payload) {
    (void)segment;
    ++*(int *)payload;
    return false;
}

// Every segment that reaches into the box is visited, whatever else is.
static void check_visit(const vn_segment_grid *grid, double x, double y, double size) {
    bool visited[MOST] = {false};
    int calls = 0;
    assert_true(vn_segment_grid_visit(grid, x, y, x + size, y + size, mark_visited, visited));
    for (int32_t i = 0; i < grid->segments.count; i++) {
        const vn_segment *s = &grid->segments.data[i];
        vn_segment sides[2] = {{x, y, x + size, y + size}, {x, y + size, x + size, y}};
        bool inside = s->x0 >= x && s->x0 <= x + size && s->y0 >= y && s->y0 <= y + size;
        if (inside || vn_segments_touch(s, &sides[0]) || vn_segments_touch(s, &sides[1])) {
            if (!visited[i]) {
                fail_msg("(%.17g, %.17g) to (%.17g, %.17g) is not visited from (%.17g, %.17g), %g wide",
                         s->x0, s->y0, s->x1, s->y1, x, y, size);
            }
        }
    }
    bool went_on = vn_segment_grid_visit(grid, x, y, x + size, y + size, stop_at_once, &calls);
    assert_int_equal(calls, !went_on);
}

static void a_segment_grid_finds_what_asking_everybody_finds(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(3);
    for (int round = 0; round < 280; round++) {
        int kind = round % SEGMENT_KINDS;
        int count = kind == TURNED_BOX ? 4 : (int)whole(&rng, 1, round % 5 == 0 ? 500 : 30);
        vn_segment_grid grid = {0};
        for (int i = 0; i < count; i++) {
            assert_ok(vn_array_push(&grid.segments, some_segment(&rng, kind, i, count)));
        }
        assert_ok(vn_segment_grid_build(&grid));
        for (int q = 0; q < 60; q++) {
            const vn_segment *s = &grid.segments.data[whole(&rng, 0, count - 1)];
            double t = q % 3 == 0 ? (double)whole(&rng, 0, 1) : uniform(&rng, 0, 1);
            double away = q % 4 == 0 ? 0 : uniform(&rng, -1, 1) * pow(10, (double)whole(&rng, -9, 2));
            double x = s->x0 + t * (s->x1 - s->x0) + away, y = s->y0 + t * (s->y1 - s->y0) - 0.7 * away;
            check_nearest_segment(&grid, x, y);
            check_visit(&grid, x, y, q % 5 == 0 ? 0 : pow(10, (double)whole(&rng, -9, 1)));
        }
        vn_segment_grid_free(&grid);
    }
}

static void a_grid_of_no_segments_finds_none(void **state) {
    (void)state;
    vn_segment_grid grid = {0};
    double d2, q[2];
    int calls = 0;
    assert_ok(vn_segment_grid_build(&grid));
    assert_int_equal(vn_segment_grid_nearest(&grid, 1, 2, &d2, q), -1);
    assert_true(vn_segment_grid_visit(&grid, 0, 0, 1, 1, stop_at_once, &calls));
    assert_int_equal(calls, 0);
    vn_segment_grid_free(&grid);
}

// ---- Exact signs ----

static int sign(double value) {
    return (value > 0) - (value < 0);
}

// Whole numbers of up to 53 bits, so that their products need 108.
static int long_turn(const int64_t p[6]) {
    __extension__ typedef __int128 wide;
    wide left = ((wide)p[0] - p[4]) * ((wide)p[3] - p[5]);
    wide right = ((wide)p[1] - p[5]) * ((wide)p[2] - p[4]);
    return (left > right) - (left < right);
}

static void check_turn(const int64_t p[6], double scale) {
    double d[6];
    for (int k = 0; k < 6; k++) {
        d[k] = (double)p[k] * scale;
    }
    int expected = long_turn(p);
    assert_int_equal(sign(vn_turn(d[0], d[1], d[2], d[3], d[4], d[5])), expected);
    assert_int_equal(sign(vn_turn(d[2], d[3], d[4], d[5], d[0], d[1])), expected);
    assert_int_equal(sign(vn_turn(d[2], d[3], d[0], d[1], d[4], d[5])), -expected);
}

static void turns_have_the_right_sign(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(4);
    int flat = 0;
    for (int n = 0; n < 200000; n++) {
        int64_t size = (int64_t)1 << whole(&rng, 3, 52);
        int64_t x = whole(&rng, -size, size), y = whole(&rng, -size, size);
        int64_t most = (int64_t)1 << whole(&rng, 0, 30);
        int64_t dx = whole(&rng, -most, most), dy = whole(&rng, -most, most);
        int64_t s = whole(&rng, -1000, 1000), t = whole(&rng, -1000, 1000);
        int64_t p[6] = {x,
                        y,
                        x + s * dx + whole(&rng, -1, 1),
                        y + s * dy + whole(&rng, -1, 1),
                        x + t * dx + whole(&rng, -1, 1),
                        y + t * dy};
        check_turn(p, ldexp(1, (int)whole(&rng, -40, 40)));
        flat += long_turn(p) == 0;
    }
    assert_true(flat > 1000);
}

static void segments_touch_where_they_share_a_point(void **state) {
    (void)state;
    static const struct {
        vn_segment s, t;
        bool touch;
    } cases[] = {
        {{0, 0, 2, 2}, {0, 2, 2, 0}, true},  {{0, 0, 2, 0}, {1, 0, 1, 5}, true},
        {{0, 0, 2, 0}, {2, 0, 4, 1}, true},  {{0, 0, 2, 0}, {3, 0, 4, 0}, false},
        {{0, 0, 2, 0}, {1, 0, 4, 0}, true},  {{0, 0, 4, 0}, {1, 0, 2, 0}, true},
        {{0, 0, 2, 0}, {2, 0, 3, 0}, true},  {{0, 0, 2, 0}, {0, 1, 2, 1}, false},
        {{1, 1, 1, 1}, {0, 0, 2, 2}, true},  {{1, 1, 1, 1}, {0, 0, 2, 3}, false},
        {{1, 1, 1, 1}, {1, 1, 1, 1}, true},  {{1, 1, 1, 1}, {1, 2, 1, 2}, false},
        {{0, 0, 0, 2}, {0, 2, 0, 3}, true},  {{0, 0, 0, 2}, {0, 2.0000000000000004, 0, 3}, false},
        {{0, 0, 1, 1}, {2, 2, 3, 3}, false}, {{3, 3, 3, 3}, {0, 0, 2, 2}, false},
        {{0, 0, 3, 1}, {3, 1, 0, 0}, true},  {{0, 0, 1, 0}, {0.5, -1, 0.5, -1e-300}, false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const vn_segment *s = &cases[i].s, *t = &cases[i].t;
        vn_segment back = {s->x1, s->y1, s->x0, s->y0};
        assert_int_equal(vn_segments_touch(s, t), cases[i].touch);
        assert_int_equal(vn_segments_touch(t, s), cases[i].touch);
        assert_int_equal(vn_segments_touch(&back, t), cases[i].touch);
    }
}

// ---- The curve ----

static void the_curve_visits_quarter_after_quarter(void **state) {
    (void)state;
    double min[3] = {0, 0, 0};
    uint64_t last[4] = {0};
    vn_rng rng = vn_rng_make(6);
    for (int n = 0; n < 4000; n++) {
        int quarter = n % 4;
        double p[3] = {uniform(&rng, 0, 1) + quarter % 2, uniform(&rng, 0, 1) + (quarter > 1), 0};
        uint64_t key = vn_morton(p, 2, min, 2);
        assert_true(key >> 38 == (uint64_t)quarter);
        last[quarter] = key;
    }
    assert_true(last[0] < last[1] && last[1] < last[2] && last[2] < last[3]);
}

static void the_curve_takes_any_point(void **state) {
    (void)state;
    double min[3] = {0, 0, 0}, beyond[3] = {1e300, 1e300, 1e300}, before[3] = {-1e300, -5, -1};
    assert_true(vn_morton(beyond, 2, min, 1) == (1ULL << 40) - 1);
    assert_true(vn_morton(beyond, 3, min, 1) == (1ULL << 42) - 1);
    assert_true(vn_morton(before, 2, min, 1) == 0);
    assert_true(vn_morton(beyond, 2, min, 0) == 0);
    double a[3] = {0.4, 0.4, 0.4}, b[3] = {0.4, 0.4, 0.6};
    assert_true(vn_morton(a, 3, min, 1) < vn_morton(b, 3, min, 1));
}

// ---- Covers ----

static double nearest_of(const cloud *c, const double p[3]) {
    vn_points points = points_of(c);
    double best2 = INFINITY;
    for (int32_t i = 0; i < c->count; i++) {
        best2 = fmin(best2, vn_points_distance2(&points, i, p));
    }
    return sqrt(best2);
}

// What is covered is nearer than the radius; and most of what is nearer than half of it is covered.
static void what_a_cover_holds_is_near(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 12; seed++) {
        vn_rng rng = vn_rng_make(seed);
        cloud c = {.dim = 2 + (int)(seed % 2)};
        double low[3] = {-1, 5, -0.25}, high[3] = {1, 6, 0.5}, radius = uniform(&rng, 0.05, 0.4);
        vn_cover cover = {0};
        int32_t near = 0, covered = 0;
        assert_ok(vn_cover_init(&cover, c.dim, low, high, radius));
        assert_true(cover.cell > 0);
        for (int i = 0; i < 12; i++) { // some of them outside the box
            add_point(&c, uniform(&rng, -1.5, 1.5), uniform(&rng, 4.5, 6.5), uniform(&rng, -0.5, 0.8));
            vn_points points = points_of(&c);
            double p[3];
            vn_points_get(&points, i, p);
            vn_cover_add(&cover, p);
        }
        for (int i = 0; i < 20000; i++) {
            double p[3] = {uniform(&rng, -1.6, 1.6), uniform(&rng, 4.4, 6.6),
                           c.dim == 3 ? uniform(&rng, -0.5, 0.8) : 0};
            bool inside = p[0] >= low[0] && p[0] <= high[0] && p[1] >= low[1] && p[1] <= high[1] &&
                          (c.dim == 2 || (p[2] >= low[2] && p[2] <= high[2]));
            double distance = nearest_of(&c, p);
            if (vn_cover_holds(&cover, p)) {
                assert_true(distance < radius);
            }
            near += inside && distance < 0.35 * radius;
            covered += inside && distance < 0.35 * radius && vn_cover_holds(&cover, p);
        }
        assert_true(near == 0 || covered == near);
        vn_cover_free(&cover);
    }
}

static void a_cover_that_would_be_huge_is_none(void **state) {
    (void)state;
    vn_cover cover = {0};
    double low[3] = {-1e9, -1e9, -1e9}, high[3] = {1e9, 1e9, 1e9};
    assert_ok(vn_cover_init(&cover, 3, low, high, 1));
    assert_true(cover.cell == 0);
    high[0] = INFINITY;
    assert_ok(vn_cover_init(&cover, 3, low, high, 1));
    assert_true(cover.cell == 0);
    vn_cover_free(&cover);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(a_point_grid_finds_what_asking_everybody_finds),
        counted_test(an_empty_grid_finds_nothing),
        counted_test(far_points_do_not_confuse_a_grid),
        counted_test(what_a_cover_holds_is_near),
        counted_test(a_cover_that_would_be_huge_is_none),
        counted_test(a_reach_tree_finds_what_asking_everybody_finds),
        counted_test(a_guarded_reach_tree_finds_what_nobody_keeps_out),
        counted_test(a_tree_of_nobody_answers_nothing),
        counted_test(a_segment_grid_finds_what_asking_everybody_finds),
        counted_test(a_grid_of_no_segments_finds_none),
        counted_test(turns_have_the_right_sign),
        counted_test(segments_touch_where_they_share_a_point),
        counted_test(the_curve_visits_quarter_after_quarter),
        counted_test(the_curve_takes_any_point),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
