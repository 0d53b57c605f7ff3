// Networks that keep clear of each other, against all pairs of edges.
#include "network/berth.h"
#include "space/tube_grid.h"
#include "support.h"

// ---- Boxes ----

typedef struct seen_boxes {
    int32_t times[400];
} seen_boxes;

static bool see(int32_t item, void *payload) {
    ((seen_boxes *)payload)->times[item]++;
    return true;
}

static void random_box(vn_rng *rng, int dim, double size, double offset, double low[3], double high[3]) {
    for (int k = 0; k < 3; k++) {
        low[k] = k < dim ? offset + uniform(rng, -10, 10) : 0;
        high[k] = k < dim ? low[k] + size * uniform(rng, 0, 1) * (whole(rng, 0, 9) == 0 ? 20 : 1) : 0;
    }
}

static bool boxes_overlap(const double low[3], const double high[3], const double l[3], const double h[3],
                          double slack) {
    bool overlap = true;
    for (int k = 0; k < 3; k++) {
        overlap = overlap && low[k] <= h[k] + slack && l[k] <= high[k] + slack;
    }
    return overlap;
}

static void check_boxes(int dim, double cell, double offset, uint64_t seed) {
    enum { COUNT = 400 };
    static double low[COUNT][3], high[COUNT][3];
    vn_rng rng = vn_rng_make(seed);
    vn_box_grid grid = {.dim = 0};
    double origin[3] = {offset, offset, dim == 3 ? offset : 0};
    assert_ok(vn_box_grid_init(&grid, dim, cell, origin, 16));
    for (int32_t i = 0; i < COUNT; i++) {
        random_box(&rng, dim, i % 50 == 0 ? 0 : 1, offset, low[i], high[i]);
        assert_ok(vn_box_grid_insert(&grid, i, low[i], high[i]));
    }
    for (int n = 0; n < 200; n++) {
        double l[3], h[3];
        seen_boxes seen = {{0}};
        random_box(&rng, dim, n % 3, offset, l, h);
        assert_true(vn_box_grid_visit(&grid, l, h, see, &seen));
        for (int32_t i = 0; i < COUNT; i++) {
            bool near = boxes_overlap(low[i], high[i], l, h, 1e-4);
            assert_true(seen.times[i] > 0 || !boxes_overlap(low[i], high[i], l, h, 0));
            assert_true(seen.times[i] == 0 || near);
        }
    }
    vn_box_grid_free(&grid);
}

static void test_boxes(void **state) {
    (void)state;
    for (uint64_t seed = 1; seed <= 4; seed++) {
        for (int dim = 2; dim <= 3; dim++) {
            check_boxes(dim, 1, 0, seed);
            check_boxes(dim, 0.2, -3, seed);
            check_boxes(dim, 1e4, 1e3, seed);
        }
    }
}

static bool stop(int32_t item, void *payload) {
    (void)item;
    ++*(int *)payload;
    return false;
}

static void test_boxes_far_away(void **state) {
    (void)state;
    vn_box_grid grid = {.dim = 0};
    double origin[3] = {0, 0, 0}, low[3] = {-1e300, -1, 0}, high[3] = {1e300, 1, 0};
    int seen = 0;
    assert_ok(vn_box_grid_init(&grid, 2, 1e-3, origin, 1));
    assert_true(vn_box_grid_visit(&grid, low, high, stop, &seen));
    assert_ok(vn_box_grid_insert(&grid, 0, low, high));
    assert_ok(vn_box_grid_insert(&grid, 0, low, high));
    assert_false(vn_box_grid_visit(&grid, low, high, stop, &seen));
    assert_int_equal(seen, 1);
    vn_box_grid_free(&grid);
}

// ---- All pairs ----

typedef double width_fn(const vn_network *net, int32_t node);

static double radius_of(const vn_network *net, int32_t node) {
    return vn_network_radius(net, node);
}

static double room_of(const vn_network *net, int32_t node) {
    return net->berth.room.data[node];
}

typedef struct tube {
    double a[3], b[3], width;
} tube;

static bool tube_of(const vn_network *net, int32_t node, width_fn *width, tube *t) {
    int32_t parent = vn_network_parent(net)[node];
    vn_network_position(net, node, t->b);
    t->width = width(net, node);
    if (parent >= 0) {
        vn_network_position(net, parent, t->a);
    }
    return parent >= 0;
}

static bool touch(const tube *s, const tube *t) {
    double reach = s->width + t->width,
           far = reach + sqrt(vn_distance2(s->a, s->b)) + sqrt(vn_distance2(t->a, t->b));
    return vn_distance2(s->a, t->a) <= far * far &&
           sqrt(vn_segment_segment_distance2(s->a, s->b, t->a, t->b)) <= reach;
}

static int32_t count_crossed_by(const vn_network *p, int32_t i, const vn_network *q, width_fn *width) {
    tube s, t;
    int32_t crossed = 0;
    if (!tube_of(p, i, width, &s)) {
        return 0;
    }
    for (int32_t j = 0; j < vn_network_count(q); j++) {
        crossed += tube_of(q, j, width, &t) && touch(&s, &t);
    }
    return crossed;
}

/// Pairs of edges that touch as tubes.
static int32_t count_crossed(const vn_network *p, const vn_network *q, width_fn *width) {
    int32_t crossed = 0;
    for (int32_t i = 0; i < vn_network_count(p); i++) {
        crossed += count_crossed_by(p, i, q, width);
    }
    return crossed;
}

// ---- Groves ----

enum { MOST_TREES = 3 };

typedef struct grove {
    int dim, count;
    vn_network *net[MOST_TREES];
    vn_attractors *a[MOST_TREES];
    vn_murray_def law[MOST_TREES];
    vn_domain *domain;
    vn_rng rng;
    vn_extend_def grow;
    vn_influence_def see;
    double consume, growth;
    bool rescale; ///< tips have the unit's size
    bool avoids;
} grove;

static void plant(grove *g, int i, uint64_t seed) {
    g->net[i] = network_of(g->dim);
    g->a[i] = attractors_of(g->dim, (int64_t)seed + i);
    g->law[i] = (vn_murray_def){.exponent = uniform(&g->rng, 2.05, 4),
                                .tip_radius = g->grow.length * uniform(&g->rng, 0.01, 0.2)};
    if (i < 2 || g->see.perception.angle > 0) { // some third ones are lines without a radius
        assert_ok(vn_network_murray(g->net[i], &g->law[i]));
    }
    for (int64_t roots = whole(&g->rng, 1, 3); roots > 0; roots--) {
        double turn = (3 * (double)roots + i + uniform(&g->rng, 0, 0.7)) * (6.2831853 / 9);
        put_root(g->net[i], 0.9 * cos(turn), 0.9 * sin(turn), g->dim == 3 ? uniform(&g->rng, -0.3, 0.3) : 0);
    }
    if (!g->net[i]->murray && seed % 8 == 5) { // and some have radii of their own
        double radius[3] = {0.01, 0.02, 0.03};
        assert_ok(vn_network_set_radii(g->net[i], radius));
    }
}

static grove grove_of(uint64_t seed, bool avoids) {
    grove g = {.dim = seed % 3 == 0 ? 3 : 2, .count = seed % 4 < 2 ? 3 : 2, .rng = vn_rng_make(seed)};
    g.domain = g.dim == 2 ? disk_of(0, 0, 1) : ball_of(0, 0, 0, 1);
    g.avoids = avoids;
    g.see = vn_influence_def_default();
    g.see.within = uniform(&g.rng, 0.4, 0.9);
    if (seed % 2 == 0) {
        g.see.perception = (vn_perception){uniform(&g.rng, 60, 200), whole(&g.rng, 0, 3) > 0};
    }
    g.grow = vn_extend_def_default();
    g.grow.length = uniform(&g.rng, 0.06, 0.12);
    g.grow.domain = whole(&g.rng, 0, 1) > 0 ? g.domain : NULL;
    if (seed % 2 == 0) {
        g.grow.bias = uniform(&g.rng, 0, 0.7);
        g.grow.bias_mean = true;
        g.grow.bifurcate = whole(&g.rng, 0, 1) > 0 ? uniform(&g.rng, 0.1, 40) : 0;
    }
    g.growth = whole(&g.rng, 0, 2) > 0 ? 0.03 : 0;
    g.rescale = g.growth > 0 && whole(&g.rng, 0, 1) > 0;
    g.consume = g.grow.length * uniform(&g.rng, 0.8, 1.5);
    int64_t gap = whole(&g.rng, 0, 2);
    for (int i = 0; i < g.count; i++) {
        plant(&g, i, seed);
    }
    g.grow.gap = avoids && gap > 0 ? g.grow.length * (gap == 1 ? 0 : 0.6) : -1;
    return g;
}

static void end_grove(grove *g) {
    for (int i = 0; i < g->count; i++) {
        vn_attractors_destroy(g->a[i]);
        vn_network_destroy(g->net[i]);
    }
    vn_domain_release(g->domain);
}

static void throw_darts(grove *g, int i) {
    vn_throw_def def = vn_throw_def_default();
    int32_t accepted;
    def.domain = g->domain;
    def.count = 40;
    def.spacing = 1.2 * g->grow.length;
    def.clearance = g->consume * 1.2;
    def.network = g->net[i];
    def.rng = &g->rng;
    assert_ok(vn_throw(g->a[i], &def, &accepted));
}

// @p status: of the extension; a meddler may have moved others over a root.
static int32_t try_to_extend(grove *g, int i, vn_status *status) {
    vn_influence *f = NULL;
    int32_t added, first, consumed;
    vn_consume_def eat = vn_consume_def_default();
    vn_extend_def def = g->grow;
    def.avoid_count = 0;
    for (int k = 0; k < g->count && g->avoids; k++) {
        if (k != i) {
            def.avoid[def.avoid_count++] = g->net[k];
        }
    }
    assert_ok(vn_influence_find(&f, g->a[i], g->net[i], &g->see));
    *status = vn_extend(g->net[i], f, &def, &added, &first);
    vn_influence_destroy(f);
    eat.distance = g->consume;
    assert_ok(vn_consume(g->a[i], g->net[i], &eat, &consumed));
    return added;
}

static void extend_one(grove *g, int i) {
    vn_status status;
    try_to_extend(g, i, &status);
    assert_ok(status);
}

static void step_grove(grove *g, int step) {
    double shrink = (1 + g->growth * step) / (1 + g->growth * (step + 1));
    for (int i = 0; i < g->count; i++) {
        throw_darts(g, i);
        if (g->rescale && vn_network_has_radii(g->net[i])) {
            assert_ok(vn_network_murray(g->net[i], &g->law[i]));
            g->law[i].tip_radius *= shrink;
        }
        extend_one(g, i);
    }
    g->grow.length *= shrink;
    g->grow.gap *= g->grow.gap > 0 ? shrink : 1;
    g->see.within *= shrink;
    g->consume *= shrink;
}

static void check_rooms(const vn_network *net) {
    assert_int_equal(net->berth.room.count, vn_network_count(net));
    for (int32_t i = 0; i < vn_network_count(net); i++) {
        assert_true(room_of(net, i) >= vn_network_radius(net, i) * (1 - 1e-12) ||
                    vn_network_parent(net)[i] < 0);
    }
}

static int32_t check_grove(const grove *g) {
    int32_t crossed = 0;
    for (int i = 0; i < g->count; i++) {
        for (int k = 0; k < i; k++) {
            crossed += count_crossed(g->net[i], g->net[k], radius_of);
            if (g->avoids) {
                assert_int_equal(crossed, 0);
                assert_int_equal(count_crossed(g->net[i], g->net[k], room_of), 0);
            }
        }
        if (g->avoids) {
            check_rooms(g->net[i]);
        }
    }
    return crossed;
}

static int32_t nodes_of(const grove *g) {
    int32_t nodes = 0;
    for (int i = 0; i < g->count; i++) {
        nodes += vn_network_count(g->net[i]);
    }
    return nodes;
}

static void test_random_groves(void **state) {
    (void)state;
    int32_t crossed = 0, apart = 0, nodes[2] = {0, 0};
    for (uint64_t seed = 1; seed <= 16; seed++) {
        for (int avoids = 0; avoids < 2; avoids++) {
            grove g = grove_of(seed, avoids > 0);
            for (int step = 0; step < 40; step++) {
                step_grove(&g, step);
                if (avoids && step % 5 == 0) {
                    check_grove(&g);
                }
            }
            int32_t *count = avoids ? &apart : &crossed;
            *count += check_grove(&g);
            nodes[avoids] += nodes_of(&g);
            end_grove(&g);
        }
    }
    assert_int_equal(apart, 0);
    assert_true(crossed > 1000);
    assert_true(nodes[1] > nodes[0] / 3); // those that avoid each other do grow
}

// One that is out of reach changes nothing.
static void test_avoiding_nothing(void **state) {
    (void)state;
    for (uint64_t seed = 1; seed <= 8; seed++) {
        uint64_t hash[2];
        for (int avoids = 0; avoids < 2; avoids++) {
            grove g = grove_of(seed, false);
            vn_network *far = random_tree(g.dim, 50, 1, seed);
            assert_ok(vn_network_scale(far, 0.1));
            for (int32_t i = 0; i < vn_network_count(far); i++) {
                far->x.data[i] += 100;
            }
            far->moved++;
            for (int step = 0; step < 20; step++) {
                vn_influence *f = NULL;
                int32_t added, first;
                throw_darts(&g, 0);
                assert_ok(vn_influence_find(&f, g.a[0], g.net[0], &g.see));
                g.grow.avoid[0] = far;
                g.grow.avoid_count = avoids;
                assert_ok(vn_extend(g.net[0], f, &g.grow, &added, &first));
                vn_influence_destroy(f);
            }
            hash[avoids] = network_hash(g.net[0]);
            vn_network_destroy(far);
            end_grove(&g);
        }
        assert_true(hash[0] == hash[1]);
    }
}

// ---- What did not ask ----

static void set_law(vn_network *net, double exponent, double tip) {
    vn_murray_def law = {.exponent = exponent, .tip_radius = tip};
    assert_ok(vn_network_murray(net, &law));
}

// A chain from (x, y) along x.
static void put_chain(vn_network *net, double x, double y, double length, int32_t edges) {
    int32_t node = put_root(net, x, y, 0);
    for (int32_t i = 1; i <= edges; i++) {
        node = put_child(net, node, x + length * i, y, 0);
    }
}

static grove pair_of(double tip) {
    grove g = {.dim = 2, .count = 2, .rng = vn_rng_make(5), .avoids = true, .consume = 0.06};
    g.domain = disk_of(0, 0, 1);
    g.see = vn_influence_def_default();
    g.grow = vn_extend_def_default();
    g.grow.length = 0.05;
    for (int i = 0; i < 2; i++) {
        g.net[i] = network_of(2);
        g.a[i] = attractors_of(2, i);
        set_law(g.net[i], 3, tip);
    }
    return g;
}

// Grow the first alone; its count of nodes then.
static int32_t grow_first(grove *g, int steps) {
    for (int step = 0; step < steps; step++) {
        throw_darts(g, 0);
        extend_one(g, 0);
    }
    return vn_network_count(g->net[0]);
}

static void test_others_that_do_not_ask(void **state) {
    (void)state;
    grove g = pair_of(0.004);
    put_root(g.net[0], -0.9, 0, 0);
    put_chain(g.net[1], -0.3, -0.2, 0.7, 1); // one long edge
    int32_t count = grow_first(&g, 20);
    assert_int_equal(count_crossed(g.net[0], g.net[1], radius_of), 0);
    put_chain(g.net[1], 0.85, -0.2, 0.01, 20); // a hand adds another tree where there is room
    assert_int_equal(count_crossed(g.net[0], g.net[1], radius_of), 0);
    assert_true(grow_first(&g, 20) > count);
    assert_int_equal(count_crossed(g.net[0], g.net[1], radius_of), 0);
    end_grove(&g);
}

// A point within the domain that is farther than @p apart from all edges of the others.
static bool find_clear(grove *g, int i, double apart, double p[3]) {
    bool clear = vn_domain_contains(g->domain, p);
    for (int k = 0; k < g->count; k++) {
        tube s = {{p[0], p[1], p[2]}, {p[0], p[1], p[2]}, apart}, t;
        for (int32_t j = 0; j < vn_network_count(g->net[k]) && k != i; j++) {
            clear = clear && !(tube_of(g->net[k], j, radius_of, &t) && touch(&s, &t));
        }
    }
    return clear;
}

static void add_by_hand(grove *g, int i) {
    vn_network *net = g->net[i];
    double p[3] = {0}, step = g->grow.length;
    int32_t parent = (int32_t)whole(&g->rng, 0, vn_network_count(net) - 1);
    vn_network_position(net, parent, p);
    for (int k = 0; k < g->dim; k++) {
        p[k] += uniform(&g->rng, -step, step);
    }
    if (find_clear(g, i, uniform(&g->rng, 0, step), p)) {
        assert_ok(vn_network_add(net, parent, p, NULL));
    }
}

static void move_a_little(grove *g, int i) {
    double by = uniform(&g->rng, -0.1, 0.1);
    for (int32_t n = 0; n < vn_network_count(g->net[i]); n++) {
        g->net[i]->x.data[n] += by;
    }
    g->net[i]->moved++;
    g->net[i]->version++;
}

static void split_one(grove *g, int i) {
    vn_network *net = g->net[i];
    int32_t node = vn_network_count(net) - 1, parent = vn_network_parent(net)[node];
    if (parent >= 0) {
        double a[3], b[3];
        vn_network_position(net, parent, a);
        vn_network_position(net, node, b);
        double p[3] = {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
        assert_ok(vn_network_split(net, node, p, NULL));
    }
}

static void widen(vn_network *net) {
    double radius[4096];
    for (int32_t n = 0; n < net->radius.count; n++) {
        radius[n] = 1.3 * net->radius.data[n];
    }
    if (net->radius.count > 0) {
        assert_ok(vn_network_set_radii(net, radius));
    }
}

static void meddle(grove *g, int i) {
    int64_t what = whole(&g->rng, 0, 9);
    if (what < 3) {
        add_by_hand(g, i);
    } else if (what == 3) {
        move_a_little(g, i);
    } else if (what == 4) {
        split_one(g, i);
    } else if (what == 5 && g->net[i]->murray) {
        set_law(g->net[i], g->law[i].exponent, g->net[i]->law.tip_radius * uniform(&g->rng, 0.5, 1.6));
    } else if (what == 6 && g->net[i]->murray) {
        g->law[i].exponent = uniform(&g->rng, 2.1, 4);
        set_law(g->net[i], g->law[i].exponent, g->net[i]->law.tip_radius);
    } else if (what > 6 && !g->net[i]->murray) {
        widen(g->net[i]);
    }
}

static int32_t crossed_of(const grove *g, int i) {
    int32_t crossed = 0;
    for (int k = 0; k < g->count; k++) {
        crossed += k != i ? count_crossed(g->net[i], g->net[k], radius_of) : 0;
    }
    return crossed;
}

// Whatever is done to the others and to itself between its steps, no step of one lets more edges touch.
static void test_meddling(void **state) {
    (void)state;
    int32_t grown = 0;
    for (uint64_t seed = 1; seed <= 48; seed++) {
        grove g = grove_of(seed, true);
        g.rescale = false;
        for (int step = 0; step < 25; step++) {
            int i = (int)whole(&g.rng, 0, g.count - 1);
            meddle(&g, (int)whole(&g.rng, 0, g.count - 1));
            throw_darts(&g, i);
            int32_t crossed = crossed_of(&g, i);
            vn_status status;
            grown += try_to_extend(&g, i, &status);
            assert_true(crossed_of(&g, i) <= crossed);
            if (status == VN_OK) {
                check_rooms(g.net[i]);
            }
        }
        end_grove(&g);
    }
    assert_true(grown > 1500);
}

// Claims that reach farther than a trunk is thick hold no longer where a hand has put something else.
static void test_a_hand_between(void **state) {
    (void)state;
    grove g = pair_of(0.004);
    double limit = 0;
    put_chain(g.net[0], -0.9, 0, 0.05, 12);
    put_chain(g.net[1], 0.9, 0, 0.05, 1);
    for (int step = 0; step < 40; step++) {
        throw_darts(&g, 0);
        extend_one(&g, 0);
        extend_one(&g, 1);
        if (step == 12) {
            limit = 1.2 * vn_network_radius(g.net[0], 3);
            put_child(g.net[1], put_root(g.net[1], -0.78, limit + 0.004, 0), -0.77, limit + 0.004, 0);
        }
        assert_int_equal(count_crossed(g.net[0], g.net[1], radius_of), 0);
    }
    assert_true(vn_network_radius(g.net[0], 3) > 0.98 * limit);
    end_grove(&g);
}

// What crosses already stays, and everything else keeps clear.
static void test_crossed_before(void **state) {
    (void)state;
    grove g = pair_of(0.004);
    put_chain(g.net[0], -0.5, 0, 0.05, 20);
    put_chain(g.net[1], 0.1, -1, 0, 1);
    put_child(g.net[1], 1, 0.1, 1, 0);
    int32_t crossed = count_crossed(g.net[0], g.net[1], radius_of);
    assert_true(crossed > 0);
    int32_t old = vn_network_count(g.net[0]), beyond = 0;
    grow_first(&g, 40);
    for (int32_t i = old; i < vn_network_count(g.net[0]); i++) {
        assert_int_equal(count_crossed_by(g.net[0], i, g.net[1], radius_of), 0);
        beyond += vn_network_x(g.net[0])[i] > 0.2;
    }
    assert_true(beyond > 50);
    end_grove(&g);
}

static void test_joins_are_avoided(void **state) {
    (void)state;
    grove g = pair_of(0.004);
    double wide = 0.01 + 0.004; // both radii
    put_root(g.net[0], -0.9, 0, 0);
    put_root(g.net[0], 0.2 + wide + 1e-6, 0, 0); // this one is nearer than the gap, and has to lead away
    put_root(g.net[1], 0.2, -1, 0);
    put_root(g.net[1], 0.2, 1, 0);
    assert_ok(vn_network_join(g.net[1], 0, 1, 0.01));
    grow_first(&g, 60);
    int32_t nodes[2] = {0, 0};
    for (int32_t i = 0; i < vn_network_count(g.net[0]); i++) {
        int tree = vn_network_tree(g.net[0])[i];
        double away = fabs(vn_network_x(g.net[0])[i] - 0.2);
        assert_true(away > wide + (tree == 0 ? g.grow.length / 4 : 0));
        nodes[tree]++;
    }
    assert_true(nodes[0] > 100 && nodes[1] > 20);
    vn_retired retired = vn_attractors_retired(g.a[0]);
    assert_true(retired.barred > 10);
    end_grove(&g);
}

// A trunk between two walls gets as many tips as there is room for its thickness.
static void test_a_trunk_between_walls(void **state) {
    (void)state;
    grove g = pair_of(0.004);
    put_chain(g.net[0], -0.9, 0, 0.05, 12);
    put_chain(g.net[1], -0.95, 0.02, 0.02, 30);
    grow_first(&g, 60);
    double room = 0.02 - 0.004, thickest = 0;
    assert_int_equal(count_crossed(g.net[0], g.net[1], radius_of), 0);
    for (int32_t i = 0; i < vn_network_count(g.net[0]); i++) {
        thickest = fmax(thickest, vn_network_radius(g.net[0], i));
    }
    assert_true(thickest > 0.9 * room && thickest < room);
    end_grove(&g);
}

// ---- What is refused ----

static vn_status try_extend(grove *g, const vn_extend_def *def) {
    vn_influence *f = NULL;
    int32_t added, first;
    assert_ok(vn_influence_find(&f, g->a[0], g->net[0], &g->see));
    vn_status status = vn_extend(g->net[0], f, def, &added, &first);
    vn_influence_destroy(f);
    return status;
}

static void test_refusals(void **state) {
    (void)state;
    grove g = pair_of(0.004);
    vn_network *solid = network_of(3);
    put_root(g.net[0], 0, 0, 0);
    put_root(g.net[1], 0.5, 0, 0);
    put_attractor(g.a[0], 0, 0.5, 0);
    vn_extend_def def = g.grow;
    def.gap = 0.1;
    assert_int_equal(try_extend(&g, &def), VN_INVALID);
    assert_message("extend.gap");
    def.gap = -1;
    def.avoid_count = 1;
    def.avoid[0] = g.net[0];
    assert_int_equal(try_extend(&g, &def), VN_INVALID);
    assert_message("cannot avoid itself");
    def.avoid[0] = solid;
    assert_int_equal(try_extend(&g, &def), VN_INVALID);
    assert_message("2 dimensions cannot avoid one of 3");
    def.avoid[0] = g.net[1];
    def.avoid_count = VN_MOST_AVOIDED + 1;
    assert_int_equal(try_extend(&g, &def), VN_LIMIT);
    assert_message("at most 16");
    def.avoid_count = 1;
    def.meet = VN_MEET_JOIN;
    assert_int_equal(try_extend(&g, &def), VN_INVALID);
    assert_message("without joins");
    def.meet = VN_MEET_STOP;
    g.see.mode = 1;
    assert_int_equal(try_extend(&g, &def), VN_INVALID);
    assert_message("nearest");
    g.see.mode = 0;
    assert_ok(try_extend(&g, &def));
    vn_murray_def law = {.exponent = 3, .tip_radius = 0.004, .veinlets = 1};
    assert_ok(vn_network_murray(g.net[0], &law));
    assert_int_equal(try_extend(&g, &def), VN_INVALID);
    assert_message("veinlets");
    vn_network_destroy(solid);
    end_grove(&g);
}

static void test_roots_that_are_too_near(void **state) {
    (void)state;
    grove g = pair_of(0.02);
    put_root(g.net[0], 0, 0, 0);
    put_root(g.net[1], 0.03, 0, 0);
    put_attractor(g.a[0], 0, 0.5, 0);
    g.grow.avoid_count = 1;
    g.grow.avoid[0] = g.net[1];
    assert_int_equal(try_extend(&g, &g.grow), VN_INVALID);
    assert_message("the root at (0, 0, 0) is 0.03 from");
    // Just beyond the radii, it leads away from the other.
    put_root(g.net[0], -0.0101, 0, 0);
    put_attractor(g.a[0], -0.5, 0, 0);
    vn_extend_def def = g.grow;
    assert_int_equal(try_extend(&g, &def), VN_INVALID);
    assert_int_equal(vn_network_count(g.net[0]), 3);
    end_grove(&g);
}

// A law that only changes its tips' radius counts nothing anew, and misses nothing.
static void test_tips_of_another_radius(void **state) {
    (void)state;
    vn_network *net = random_tree(2, 50, 2, 3);
    vn_rng rng = vn_rng_make(9);
    set_law(net, 2.7, 1);
    for (int i = 0; i < 200; i++) {
        put_child(net, (int32_t)whole(&rng, 0, vn_network_count(net) - 1), uniform(&rng, -1, 1),
                  uniform(&rng, -1, 1), 0);
        if (i % 7 == 0) {
            set_law(net, 2.7, 1.0 / (i + 1));
        }
        if (i % 31 == 0) {
            int32_t tips[400];
            vn_network_count_tips(net, tips);
            for (int32_t k = 0; k < vn_network_count(net); k++) {
                double radius = net->law.tip_radius * pow(tips[k], 1 / 2.7);
                assert_true(vn_network_parent(net)[k] < 0 ||
                            fabs(vn_network_radius(net, k) - radius) <= 1e-12 * radius);
            }
        }
    }
    vn_network_destroy(net);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(test_boxes),
        counted_test(test_boxes_far_away),
        counted_test(test_random_groves),
        counted_test(test_avoiding_nothing),
        counted_test(test_others_that_do_not_ask),
        counted_test(test_meddling),
        counted_test(test_a_hand_between),
        counted_test(test_crossed_before),
        counted_test(test_joins_are_avoided),
        counted_test(test_a_trunk_between_walls),
        counted_test(test_refusals),
        counted_test(test_roots_that_are_too_near),
        counted_test(test_tips_of_another_radius),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
