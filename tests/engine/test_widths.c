// Widths where veins meet: Murray's law with joins and veinlets against recursion, and how they are drawn.
#include "support.h"

#include "draw/canvas.h"
#include "network/network.h"

enum { NODES = 240 };

// Joins between any two nodes: up and down one tree, into roots, from tree to tree.
static void join_at_random(vn_network *network, vn_rng *rng, int32_t tries) {
    int32_t last = vn_network_count(network) - 1;
    for (int32_t i = 0; i < tries; i++) {
        vn_network_join(network, (int32_t)whole(rng, 0, last), (int32_t)whole(rng, 0, last), 0.125);
    }
}

static vn_network *netted(uint64_t seed, double exponent, double veinlets, int32_t tries) {
    vn_network *network = random_tree(2, NODES, 1 + (int32_t)(seed % 4), seed);
    vn_murray_def law = {.exponent = exponent, .tip_radius = 0.7, .veinlets = veinlets};
    vn_rng rng = vn_rng_make(seed);
    if (seed % 2 == 0) {
        assert_ok(vn_network_murray(network, &law));
    }
    join_at_random(network, &rng, tries);
    if (seed % 2 == 1) {
        assert_ok(vn_network_murray(network, &law));
    }
    return network;
}

// ---- The oracle ----

// Demand of a node by recursion over the joins as they are oriented; 0: not known yet, -1: being asked for.
typedef struct oracle {
    const vn_network *network;
    double demand[NODES + 64];
    int32_t order[NODES + 64]; // Hickey's, without widening
    double veinlets;
} oracle;

static int32_t parents_of(const vn_network *network, int32_t node) {
    int32_t parents = vn_network_parent(network)[node] >= 0;
    for (int32_t i = 0; i < vn_network_join_count(network); i++) {
        int32_t a, b;
        double radius;
        vn_network_join_ends(network, i, &a, &b, &radius);
        parents += b == node;
    }
    return parents;
}

static double demand_by_recursion(oracle *o, int32_t node) {
    assert_true(o->demand[node] >= 0); // otherwise the node is its own parent
    if (o->demand[node] > 0) {
        return o->demand[node];
    }
    double sum = 0;
    o->demand[node] = -1;
    for (int32_t c = 0; c < vn_network_count(o->network); c++) {
        if (vn_network_parent(o->network)[c] == node) {
            sum += demand_by_recursion(o, c) / parents_of(o->network, c);
        }
    }
    for (int32_t i = 0; i < vn_network_join_count(o->network); i++) {
        int32_t a, b;
        double radius;
        vn_network_join_ends(o->network, i, &a, &b, &radius);
        sum += a == node ? demand_by_recursion(o, b) / parents_of(o->network, b) : 0;
    }
    bool widens = sum > 0 && o->order[node] <= 2;
    o->demand[node] = sum > 0 ? sum + (widens ? o->veinlets : 0) : 1;
    return o->demand[node];
}

static void check_radii(const vn_network *network, double veinlets, double exponent) {
    oracle *o = calloc(1, sizeof *o), *plain = calloc(1, sizeof *plain);
    assert_non_null(o);
    assert_non_null(plain);
    o->network = plain->network = network;
    o->veinlets = veinlets;
    int32_t count = vn_network_count(network);
    for (int32_t v = 0; v < count; v++) { // parents come first
        int32_t parent = vn_network_parent(network)[v];
        o->order[v] = parent < 0 ? 1 : o->order[parent];
        for (int32_t c = parent < 0 ? count : 0; c < count; c++) {
            if (c == v || vn_network_parent(network)[c] != parent) {
                continue;
            }
            double mine = demand_by_recursion(plain, v) / parents_of(network, v);
            double other = demand_by_recursion(plain, c) / parents_of(network, c);
            if (other > mine * (1 + 1e-12) || (fabs(other - mine) <= 1e-12 * mine && c < v)) {
                o->order[v] = o->order[parent] + 1;
            }
        }
    }
    for (int32_t v = 0; v < count; v++) {
        double share = demand_by_recursion(o, v) / (parents_of(network, v) > 0 ? parents_of(network, v) : 1);
        if (vn_network_parent(network)[v] >= 0) {
            double should = 0.7 * pow(share, 1 / exponent);
            assert_near(vn_network_radius(network, v), should, 1e-9 * should);
        }
    }
    for (int32_t i = 0; i < vn_network_join_count(network); i++) {
        int32_t a, b;
        double radius;
        vn_network_join_ends(network, i, &a, &b, &radius);
        double should = 0.7 * pow(demand_by_recursion(o, b) / parents_of(network, b), 1 / exponent);
        assert_near(radius, should, 1e-9 * should);
    }
    free(o);
    free(plain);
}

// ---- The law ----

static void radii_are_what_recursion_says(void **state) {
    (void)state;
    static const double exponents[] = {2, 2.55, 3};
    for (uint64_t seed = 0; seed < 12; seed++) {
        double exponent = exponents[seed % 3], veinlets = seed < 6 ? 0 : 0.75;
        vn_network *network = netted(seed, exponent, veinlets, seed % 4 == 3 ? 0 : 20 * (int32_t)(seed % 4));
        check_radii(network, veinlets, exponent);
        vn_rng rng = vn_rng_make(seed + 100);
        for (int32_t i = 0; i < 30; i++) { // and again once it has grown
            put_child(network, (int32_t)whole(&rng, 0, vn_network_count(network) - 1), i, 0, 0);
        }
        join_at_random(network, &rng, 10);
        check_radii(network, veinlets, exponent);
        vn_network_destroy(network);
    }
}

// What flows in where nothing is a parent is what the tips take up.
static void what_flows_in_is_what_tips_take_up(void **state) {
    (void)state;
    static const double exponents[] = {2, 2.55, 3};
    for (uint64_t seed = 0; seed < 30; seed++) {
        double n = exponents[seed % 3], in = 0;
        vn_network *network = netted(seed, n, 0, 5 * (int32_t)seed);
        int32_t count = vn_network_count(network), joins = vn_network_join_count(network), tips = 0;
        bool *has_child = calloc((size_t)count, sizeof *has_child);
        int32_t *parents = calloc((size_t)count, sizeof *parents);
        assert_non_null(has_child);
        assert_non_null(parents);
        for (int pass = 0; pass < 2; pass++) {
            for (int32_t e = 0; e < count + joins; e++) {
                int32_t a = e < count ? vn_network_parent(network)[e] : -1, b = e;
                double radius = e < count ? vn_network_radius(network, e) : 0;
                if (e >= count) {
                    vn_network_join_ends(network, e - count, &a, &b, &radius);
                }
                if (a >= 0 && pass == 0) {
                    has_child[a] = true;
                    parents[b]++;
                } else if (a >= 0) {
                    in += parents[a] == 0 ? pow(radius / 0.7, n) : 0;
                }
            }
        }
        for (int32_t v = 0; v < count; v++) {
            tips += !has_child[v] && parents[v] > 0;
        }
        assert_true(tips > 10);
        assert_near(in, tips, 1e-9 * tips);
        free(has_child);
        free(parents);
        vn_network_destroy(network);
    }
}

static void trees_are_what_they_were(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 3; seed++) {
        vn_network *network = netted(seed, 2.55, 0, 0);
        int32_t tips[NODES + 1];
        vn_network_count_tips(network, tips);
        for (int32_t v = 0; v < vn_network_count(network); v++) {
            bool root = vn_network_parent(network)[v] < 0;
            assert_true(root ||
                        vn_network_radius(network, v) == (tips[v] == 1 ? 0.7 : 0.7 * pow(tips[v], 1 / 2.55)));
        }
        vn_network_destroy(network);
    }
}

static void assert_join(const vn_network *network, int32_t join, int32_t a, int32_t b, double radius) {
    int32_t found_a, found_b;
    double found;
    vn_network_join_ends(network, join, &found_a, &found_b, &found);
    assert_int_equal(found_a, a);
    assert_int_equal(found_b, b);
    assert_near(found, radius, 1e-12);
}

// 0-1-2-3 and 1-4: joins 4-3, which is fine, and 3-1, which is a circle.
static void a_join_is_turned_only_where_it_must_be(void **state) {
    (void)state;
    vn_network *network = network_of(2);
    vn_murray_def law = {.exponent = 2, .tip_radius = 1};
    int32_t one = put_child(network, put_root(network, 0, 0, 0), 1, 0, 0);
    int32_t three = put_child(network, put_child(network, one, 2, 1, 0), 3, 0, 0);
    int32_t four = put_child(network, one, 2, -1, 0);
    assert_ok(vn_network_join(network, four, three, 0.25));
    assert_join(network, 0, four, three, 0.25); // as given
    assert_ok(vn_network_murray(network, &law));
    assert_join(network, 0, four, three, sqrt(0.5));
    assert_near(vn_network_radius(network, three), sqrt(0.5), 1e-12);
    assert_near(vn_network_radius(network, four), sqrt(0.5), 1e-12); // no tip: it feeds 3
    assert_near(vn_network_radius(network, one), 1, 1e-12);
    assert_ok(vn_network_join(network, three, one, 0.25));
    assert_join(network, 1, one, three, sqrt(1 / 3.0));
    assert_join(network, 0, four, three, sqrt(1 / 3.0));
    assert_near(vn_network_radius(network, one), 1, 1e-12);
    vn_network_destroy(network);
}

// A root that another tree feeds hangs from it.
static void trees_can_be_grafted(void **state) {
    (void)state;
    vn_network *network = network_of(2);
    vn_murray_def law = {.exponent = 3, .tip_radius = 1};
    int32_t tip = put_child(network, put_root(network, 0, 0, 0), 1, 0, 0), other = put_root(network, 2, 0, 0);
    put_child(network, other, 3, 1, 0);
    put_child(network, other, 3, -1, 0);
    assert_ok(vn_network_murray(network, &law));
    assert_ok(vn_network_join(network, tip, other, 0));
    assert_join(network, 0, tip, other, cbrt(2));
    assert_near(vn_network_radius(network, tip), cbrt(2), 1e-12);
    assert_near(vn_network_radius(network, other), 1, 1e-12);
    assert_ok(vn_network_join(network, other, 0, 0)); // both roots wait for each other: the first one leads
    assert_join(network, 1, 0, other, 1);
    assert_near(vn_network_radius(network, 0), 1, 1e-12);
    vn_network_destroy(network);
}

static void radii_need_no_memory(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 4; seed++) {
        vn_network *network = netted(seed, 2, seed / 2.0, 30);
        put_child(network, 7, 1, 1, 0);
        vn_fail_allocations_from(0);
        double radius = vn_network_radius(network, 7);
        vn_fail_allocations_from(-1);
        assert_true(radius > 0);
        vn_network_destroy(network);
    }
}

static void a_split_changes_no_width(void **state) {
    (void)state;
    vn_network *network = netted(2, 2, 0, 0);
    double before[NODES], p[3] = {0, 0, 0};
    for (int32_t v = 30; v < NODES; v += 7) { // as growth does it: to what is younger
        vn_network_join(network, v - 30, v, 0);
    }
    assert_true(vn_network_join_count(network) > 20);
    for (int32_t v = 0; v < NODES; v++) {
        before[v] = vn_network_radius(network, v);
    }
    for (int32_t v = 0; v < NODES; v += 3) {
        if (vn_network_parent(network)[v] >= 0) {
            assert_ok(vn_network_split(network, v, p, NULL));
        }
    }
    for (int32_t v = 0; v < NODES; v++) {
        assert_near(vn_network_radius(network, v), before[v], 1e-12 * before[v]);
    }
    vn_network_destroy(network);
}

// ---- Files ----

static vn_network *reloaded(const vn_network *network) {
    vn_network_set set;
    assert_ok(vn_network_save(network, "test_widths.json", NULL));
    assert_ok(vn_networks_load(&set, "test_widths.json"));
    vn_network *again = set.networks[0];
    set.networks[0] = NULL;
    vn_networks_free(&set);
    remove("test_widths.json");
    return again;
}

// Also where edges were split, so that children are listed in another order.
static void files_keep_widths_to_the_bit(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 8; seed++) {
        vn_network *network = netted(seed, 2.55, seed < 4 ? 0 : 1.5, 100);
        double p[3] = {0, 0, 0};
        for (int32_t v = 0; v < NODES; v += 2) {
            if (vn_network_parent(network)[v] >= 0) {
                assert_ok(vn_network_split(network, v, p, NULL));
            }
        }
        assert_ok(vn_network_set_orders_by(network, &(vn_orders_def){VN_HICKEY, 0.75}));
        vn_network *again = reloaded(network);
        size_t size = (size_t)vn_network_count(network) * sizeof(int32_t);
        assert_memory_equal(vn_network_orders(again), vn_network_orders(network), size);
        for (int32_t v = 0; v < vn_network_count(network); v++) {
            assert_true(vn_network_radius(again, v) == vn_network_radius(network, v));
        }
        for (int32_t i = 0; i < vn_network_join_count(network); i++) {
            int32_t ends[4];
            double radius[2];
            vn_network_join_ends(network, i, &ends[0], &ends[1], &radius[0]);
            vn_network_join_ends(again, i, &ends[2], &ends[3], &radius[1]);
            assert_true(ends[0] == ends[2] && ends[1] == ends[3] && radius[0] == radius[1]);
        }
        vn_network_destroy(network);
        vn_network_destroy(again);
    }
}

// ---- Orders ----

// Of three veins from the root's first node two are nearly as thick; one of them forks evenly.
static void laterals_as_thick_as_the_main_vein_share_its_order(void **state) {
    (void)state;
    static const int32_t parents[] = {-1, 0, 1, 1, 1, 2, 2, 3};
    double radius[] = {0, 5, 4, 3.5, 1, 3, 3, 3.5};
    static const int32_t expected[3][8] = {
        {1, 1, 1, 2, 2, 1, 2, 2}, {1, 1, 1, 1, 2, 1, 1, 1}, {1, 1, 1, 2, 2, 1, 1, 2}};
    static const double ratios[] = {0, 0.8, 1};
    vn_network *network = network_of(2);
    put_root(network, 0, 0, 0);
    for (int i = 1; i < 8; i++) {
        put_child(network, parents[i], i, i, 0);
    }
    assert_ok(vn_network_set_radii(network, radius));
    assert_ok(vn_network_join(network, 4, 7, 1));
    assert_int_equal(vn_network_join_order(network, 0), 0);
    for (int i = 0; i < 3; i++) {
        vn_orders_def def = {VN_HICKEY, ratios[i]};
        assert_ok(vn_network_set_orders_by(network, &def));
        assert_memory_equal(vn_network_orders(network), expected[i], sizeof expected[i]);
        assert_int_equal(vn_network_join_order(network, 0), 2);
    }
    assert_int_equal(vn_network_set_orders_by(network, &(vn_orders_def){VN_HICKEY, 1.5}), VN_INVALID);
    assert_message("orders.ratio");
    vn_network_destroy(network);
}

// ---- Drawing ----

static vn_canvas *canvas_of(const vn_network *network, const vn_stroke_def *def) {
    vn_canvas_def page = vn_canvas_def_default();
    page.view = (vn_box){{-5, -5, 0}, {5, 5, 0}};
    vn_canvas *canvas;
    assert_ok(vn_canvas_create(&canvas, &page));
    assert_ok(vn_canvas_stroke(canvas, network, def));
    return canvas;
}

static bool same_spot(vn_spot a, vn_spot b) {
    return a.x == b.x && a.y == b.y;
}

// The width that the picture gives the edge a-b at its end b; 0: not in the picture.
static double drawn(const vn_canvas *canvas, const vn_network *network, int32_t a, int32_t b) {
    const double *x = vn_network_x(network), *y = vn_network_y(network);
    vn_spot from = vn_canvas_place(canvas, x[a], y[a]), to = vn_canvas_place(canvas, x[b], y[b]);
    for (int32_t i = 0; i < canvas->pieces.count; i++) {
        const vn_piece *piece = &canvas->pieces.data[i];
        const vn_spot *spots = canvas->points.data + piece->begin;
        for (int32_t k = 1; k < piece->count; k++) {
            if (same_spot(spots[k - 1], from) && same_spot(spots[k], to)) {
                return piece->end_width;
            }
        }
    }
    return 0;
}

static void edges_that_meet_are_drawn_equally_thick(void **state) {
    (void)state;
    vn_network *network = netted(5, 2, 0, 80);
    vn_stroke_def def = vn_stroke_def_default();
    def.min_width = 0;
    vn_canvas *canvas = canvas_of(network, &def);
    for (int32_t i = 0; i < vn_network_join_count(network); i++) {
        int32_t a, b;
        double radius;
        vn_network_join_ends(network, i, &a, &b, &radius);
        double width = drawn(canvas, network, a, b), parent = vn_network_parent(network)[b];
        assert_near(width, 2 * radius * vn_canvas_scale(canvas), 1e-3 * width);
        assert_true(parent < 0 || width == drawn(canvas, network, (int32_t)parent, b));
    }
    vn_canvas_destroy(canvas);
    vn_network_destroy(network);
}

// 0-1, from where only the join to 3 goes on; 2 is the other root that 3 hangs from.
static void a_join_continues_the_vein_that_it_leaves(void **state) {
    (void)state;
    vn_network *network = network_of(2);
    vn_murray_def law = {.exponent = 2, .tip_radius = 0.1};
    int32_t one = put_child(network, put_root(network, 0, 0, 0), 1, 0, 0);
    int32_t three = put_child(network, put_root(network, 4, 0, 0), 2, 1, 0);
    int32_t four = put_child(network, put_root(network, 4, 4, 0), 2, -1, 0);
    assert_ok(vn_network_join(network, one, three, 0));
    assert_ok(vn_network_join(network, one, four, 0));
    assert_ok(vn_network_murray(network, &law));
    vn_stroke_def def = vn_stroke_def_default();
    vn_canvas *canvas = canvas_of(network, &def);
    int32_t tapers = 0;
    double scale = vn_canvas_scale(canvas);
    for (int32_t i = 0; i < canvas->pieces.count; i++) {
        const vn_piece *piece = &canvas->pieces.data[i];
        if (vn_piece_tapers(piece)) {
            assert_near(piece->width, 0.2 * scale, 1e-3);
            assert_near(piece->end_width, 0.2 * sqrt(0.5) * scale, 1e-3);
            tapers++;
        }
    }
    assert_int_equal(tapers, 1); // of equal joins the first
    vn_canvas_destroy(canvas);
    vn_network_destroy(network);
}

static void thin_edges_can_be_left_out(void **state) {
    (void)state;
    vn_network *network = netted(4, 2, 0, 60);
    vn_stroke_def def = vn_stroke_def_default();
    def.min_width = 3000; // however thick the rest is drawn
    def.hide_below = 200;
    vn_canvas *canvas = canvas_of(network, &def);
    double scale = vn_canvas_scale(canvas);
    int32_t hidden = 0, shown = 0;
    for (int32_t v = 0; v < vn_network_count(network) + vn_network_join_count(network); v++) {
        int32_t a, b = v;
        double radius;
        if (v < vn_network_count(network)) {
            a = vn_network_parent(network)[v];
            radius = vn_network_radius(network, v);
        } else {
            vn_network_join_ends(network, v - vn_network_count(network), &a, &b, &radius);
        }
        if (a < 0) {
            continue;
        }
        bool thin = 2 * radius * scale < 199.99;
        assert_true((drawn(canvas, network, a, b) == 0) == thin);
        hidden += thin;
        shown += !thin;
    }
    assert_true(hidden > 20 && shown > 20);
    vn_canvas_destroy(canvas);
    vn_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(radii_are_what_recursion_says),
        counted_test(what_flows_in_is_what_tips_take_up),
        counted_test(trees_are_what_they_were),
        counted_test(a_join_is_turned_only_where_it_must_be),
        counted_test(trees_can_be_grafted),
        counted_test(radii_need_no_memory),
        counted_test(a_split_changes_no_width),
        counted_test(files_keep_widths_to_the_bit),
        counted_test(laterals_as_thick_as_the_main_vein_share_its_order),
        counted_test(edges_that_meet_are_drawn_equally_thick),
        counted_test(a_join_continues_the_vein_that_it_leaves),
        counted_test(thin_edges_can_be_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
