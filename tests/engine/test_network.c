// Networks: columns, orders, Murray's law and measures against slow and obvious ones.
#include "support.h"

#include "network/network.h"

static void columns_hold_what_was_added(void **state) {
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        vn_network *network = network_of(dim);
        vn_network_set_step(network, 4);
        int32_t root = put_root(network, 1, 2, 3), child = put_child(network, root, 4, 5, 6);
        vn_network_set_step(network, 9);
        int32_t second = put_child(network, root, 7, 8, 9), other = put_root(network, 0, 0, 0);
        assert_int_equal(vn_network_count(network), 4);
        assert_true(vn_network_x(network)[child] == 4 && vn_network_y(network)[second] == 8);
        assert_int_equal(vn_network_z(network) != NULL, dim == 3);
        assert_true(dim == 2 || vn_network_z(network)[child] == 6);
        assert_int_equal(vn_network_parent(network)[root], -1);
        assert_int_equal(vn_network_parent(network)[second], root);
        assert_int_equal(vn_network_tree(network)[second], 0);
        assert_int_equal(vn_network_tree(network)[other], 1);
        assert_int_equal(vn_network_birth(network)[child], 4);
        assert_int_equal(vn_network_birth(network)[other], 9);
        assert_int_equal(vn_network_first_child(network, root), second);
        assert_int_equal(vn_network_next_child(network, second), child);
        assert_int_equal(vn_network_next_child(network, child), -1);
        assert_true(vn_network_radius(network, child) == 0);
        vn_network_destroy(network);
    }
}

static void what_makes_no_sense_is_refused(void **state) {
    (void)state;
    vn_network *network = network_of(2);
    double p[3] = {0, 0, 0}, bad[3] = {0, NAN, 0};
    int32_t node = 5;
    assert_int_equal(vn_network_root(network, bad, &node), VN_INVALID);
    assert_int_equal(node, -1);
    assert_int_equal(vn_network_add(network, 0, p, &node), VN_INVALID);
    assert_message("parent");
    put_root(network, 0, 0, 0);
    assert_int_equal(vn_network_add(network, -1, p, &node), VN_INVALID);
    assert_int_equal(vn_network_add(network, 1, p, NULL), VN_INVALID);
    assert_int_equal(vn_network_scale(network, 0), VN_INVALID);
    assert_int_equal(vn_network_scale(network, NAN), VN_INVALID);
    vn_murray_def law = {.exponent = NAN, .tip_radius = 1};
    assert_int_equal(vn_network_murray(network, &law), VN_INVALID);
    law = (vn_murray_def){.exponent = 2, .tip_radius = 0};
    assert_int_equal(vn_network_murray(network, &law), VN_INVALID);
    assert_message("murray.tip_radius");
    assert_int_equal(vn_network_count(network), 1);
    vn_network_destroy(network);
}

static void a_network_stops_at_its_limit(void **state) {
    (void)state;
    vn_network_def def = {.dim = 2, .max_nodes = 3, .unit = "mm"};
    vn_network *network = NULL;
    double p[3] = {0, 0, 0};
    assert_ok(vn_network_create(&network, &def));
    assert_string_equal(vn_network_unit(network), "mm");
    put_child(network, put_child(network, put_root(network, 0, 0, 0), 1, 0, 0), 2, 0, 0);
    assert_int_equal(vn_network_add(network, 0, p, NULL), VN_LIMIT);
    assert_message("max_nodes = 3");
    assert_int_equal(vn_network_root(network, p, NULL), VN_LIMIT);
    assert_int_equal(vn_network_count(network), 3);
    vn_network_destroy(network);
}

// ---- Orders of walking ----

static void assert_parents_first(const vn_network *network) {
    const int32_t *order;
    int32_t count = vn_network_count(network);
    bool *seen = calloc((size_t)count + 1, sizeof *seen);
    assert_non_null(seen);
    assert_ok(vn_network_order(network, &order));
    for (int32_t k = 0; k < count; k++) {
        int32_t node = order != NULL ? order[k] : k;
        int32_t parent = vn_network_parent(network)[node];
        assert_false(seen[node]);
        assert_true(parent < 0 || seen[parent]);
        seen[node] = true;
    }
    free(seen);
}

enum { NODES = 300 };

// The columns of a random forest whose nodes are numbered at random.
static vn_network *shuffled(uint64_t seed, const double *radius) {
    vn_network *from = random_tree(2, NODES, 3, seed), *network = NULL;
    vn_rng rng = vn_rng_make(seed);
    int32_t place[NODES], parent[NODES];
    double x[NODES], y[NODES];
    for (int32_t i = 0; i < NODES; i++) {
        int32_t j = (int32_t)whole(&rng, 0, i);
        place[i] = i;
        place[i] = place[j];
        place[j] = i;
    }
    for (int32_t i = 0; i < NODES; i++) {
        int32_t above = vn_network_parent(from)[i];
        x[place[i]] = vn_network_x(from)[i];
        y[place[i]] = vn_network_y(from)[i];
        parent[place[i]] = above < 0 ? -1 : place[above];
    }
    vn_network_columns columns = {
        .dim = 2, .count = NODES, .x = x, .y = y, .parent = parent, .radius = radius};
    assert_ok(vn_network_from_columns(&network, &columns));
    assert_memory_equal(vn_network_parent(network), parent, sizeof parent);
    vn_network_destroy(from);
    return network;
}

static void parents_come_first(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 6; seed++) {
        vn_network *network = seed < 2 ? random_tree(2, NODES, 2, seed) : shuffled(seed, NULL);
        assert_parents_first(network);
        vn_rng rng = vn_rng_make(seed);
        for (int n = 0; n < 50; n++) {
            put_child(network, (int32_t)whole(&rng, 0, vn_network_count(network) - 1), 0, n, 0);
        }
        put_root(network, 1, 1, 0);
        assert_parents_first(network);
        vn_network_destroy(network);
    }
}

static vn_status try_parents(const int32_t *parent, int32_t count) {
    static const double zeros[8] = {0};
    vn_network *network = (vn_network *)&network;
    vn_network_columns columns = {.dim = 2, .count = count, .x = zeros, .y = zeros, .parent = parent};
    vn_status status = vn_network_from_columns(&network, &columns);
    assert_true(status == VN_OK || network == NULL);
    if (status == VN_OK) {
        vn_network_destroy(network);
    }
    return status;
}

static void parents_that_form_no_forest_are_refused(void **state) {
    (void)state;
    static const int32_t fine[] = {1, 2, -1}, self[] = {-1, 1}, circle[] = {-1, 2, 3, 1}, none[] = {-1, 7};
    assert_ok(try_parents(fine, 3));
    assert_ok(try_parents(fine, 0));
    assert_int_equal(try_parents(self, 2), VN_INVALID);
    assert_int_equal(try_parents(circle, 4), VN_INVALID);
    assert_message("3 of the 4 nodes hang from no root");
    assert_int_equal(try_parents(none, 2), VN_INVALID);
    assert_message("node 1 has the parent 7");
}

// ---- Splitting ----

static void assert_law(const vn_network *network, double exponent, double tip);
static int32_t naive_strahler(const vn_network *network, int32_t node);

static void assert_strahler(vn_network *network) {
    assert_ok(vn_network_set_orders(network, VN_STRAHLER));
    for (int32_t v = 0; v < vn_network_count(network); v++) {
        assert_int_equal(vn_network_orders(network)[v], naive_strahler(network, v));
    }
}

// The new node is between its child and what was above that, with the edge's radius on either side.
static void split_one(vn_network *network, vn_rng *rng) {
    int32_t count = vn_network_count(network), child = (int32_t)whole(rng, 0, count - 1), node;
    int32_t parent = vn_network_parent(network)[child];
    double p[3] = {uniform(rng, -5, 5), uniform(rng, -5, 5), 0}, radius = vn_network_radius(network, child);
    if (parent < 0) {
        assert_int_equal(vn_network_split(network, child, p, &node), VN_INVALID);
        assert_int_equal(node, -1);
        return;
    }
    assert_ok(vn_network_split(network, child, p, &node));
    assert_int_equal(node, count);
    assert_int_equal(vn_network_parent(network)[child], node);
    assert_int_equal(vn_network_parent(network)[node], parent);
    assert_int_equal(vn_network_first_child(network, node), child);
    assert_int_equal(vn_network_next_child(network, child), -1);
    assert_int_equal(vn_network_birth(network)[node], vn_network_birth(network)[child]);
    assert_int_equal(vn_network_tree(network)[node], vn_network_tree(network)[child]);
    assert_true(vn_network_x(network)[node] == p[0] && vn_network_y(network)[node] == p[1]);
    assert_true(vn_network_radius(network, node) == radius && vn_network_radius(network, child) == radius);
}

static void a_split_keeps_every_law(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 8; seed++) {
        vn_network *network = seed < 4 ? random_tree(2, 80, 3, seed) : shuffled(seed, NULL);
        vn_murray_def law = {.exponent = 2.55, .tip_radius = 0.3};
        vn_rng rng = vn_rng_make(seed);
        if (seed % 2 == 0) {
            assert_ok(vn_network_murray(network, &law));
        }
        for (int n = 0; n < 60; n++) {
            int32_t count = vn_network_count(network);
            vn_network_set_step(network, n);
            put_child(network, (int32_t)whole(&rng, 0, count - 1), n, 0, 0); // tips not told upwards yet
            put_child(network, (int32_t)whole(&rng, 0, count - 1), n, 1, 0);
            split_one(network, &rng);
        }
        assert_parents_first(network);
        if (seed % 2 == 0) {
            assert_law(network, 2.55, 0.3);
        }
        assert_strahler(network);
        vn_network_destroy(network);
    }
}

static void a_split_with_tips_pending_counts_them_once(void **state) {
    (void)state;
    vn_network *network = random_tree(2, 40, 1, 2);
    vn_murray_def law = {.exponent = 3, .tip_radius = 1};
    vn_rng rng = vn_rng_make(9);
    assert_ok(vn_network_murray(network, &law));
    assert_law(network, 3, 1);
    for (int n = 0; n < 200; n++) {
        int32_t count = vn_network_count(network), child = (int32_t)whole(&rng, 1, count - 1);
        double p[3] = {n, n, 0};
        put_child(network, (int32_t)whole(&rng, 0, count - 1), n, 0, 0);
        put_child(network, vn_network_parent(network)[child], n, 1, 0);
        assert_ok(vn_network_split(network, child, p, NULL)); // below a node that is pending
        put_child(network, count + 2, n, 2, 0);               // and a tip at the new node
        if (n % 7 == 0) {
            assert_law(network, 3, 1);
        }
    }
    assert_law(network, 3, 1);
    assert_parents_first(network);
    vn_network_destroy(network);
}

// Which child leads does not change, where no two are equally thick.
static void a_split_changes_no_order(void **state) {
    (void)state;
    for (int k = 0; k < 12; k++) {
        vn_network *network =
            k % 2 == 0 ? random_tree(2, NODES, 2, (uint64_t)k) : shuffled((uint64_t)k, NULL);
        int32_t before[NODES];
        double radius[NODES];
        vn_rng rng = vn_rng_make((uint64_t)k);
        for (int32_t i = 0; i < NODES; i++) {
            radius[i] = uniform(&rng, 1, 2);
        }
        assert_ok(vn_network_set_radii(network, radius));
        assert_ok(vn_network_set_orders(network, (vn_order_kind)(k % 3)));
        memcpy(before, vn_network_orders(network), sizeof before);
        for (int n = 0; n < 200; n++) {
            split_one(network, &rng);
        }
        assert_null(vn_network_orders(network));
        assert_ok(vn_network_set_orders(network, (vn_order_kind)(k % 3)));
        assert_memory_equal(vn_network_orders(network), before, sizeof before);
        for (int32_t i = NODES; i < vn_network_count(network); i++) {
            int32_t child = vn_network_first_child(network, i);
            assert_int_equal(vn_network_orders(network)[i], vn_network_orders(network)[child]);
        }
        vn_network_destroy(network);
    }
}

// ---- Radii ----

static int32_t tips_below(const vn_network *network, int32_t node) {
    int32_t child = vn_network_first_child(network, node), tips = child < 0;
    for (; child >= 0; child = vn_network_next_child(network, child)) {
        tips += tips_below(network, child);
    }
    return tips;
}

static void assert_law(const vn_network *network, double exponent, double tip) {
    for (int32_t v = 0; v < vn_network_count(network); v++) {
        double sum = 0, thickest = 0;
        for (int32_t c = vn_network_first_child(network, v); c >= 0; c = vn_network_next_child(network, c)) {
            sum += pow(vn_network_radius(network, c), exponent);
            thickest = fmax(thickest, vn_network_radius(network, c));
        }
        double radius = vn_network_radius(network, v);
        if (vn_network_parent(network)[v] < 0) {
            assert_true(radius == thickest);
            continue;
        }
        double should = sum > 0 ? pow(sum, 1 / exponent) : tip;
        assert_near(radius, should, 1e-9 * should);
        assert_near(pow(radius / tip, exponent), tips_below(network, v), 1e-9 * tips_below(network, v));
    }
}

static void murrays_law_holds_however_the_network_grows(void **state) {
    (void)state;
    static const double exponents[] = {2, 2.55, 3};
    for (int k = 0; k < 9; k++) {
        vn_network *network = k < 6 ? random_tree(2, 4, 2, 3) : shuffled((uint64_t)k, NULL);
        vn_murray_def law = {.exponent = exponents[k % 3], .tip_radius = 0.7};
        vn_rng rng = vn_rng_make((uint64_t)k);
        assert_ok(vn_network_murray(network, &law));
        for (int n = 0; n < 900; n++) {
            int32_t count = vn_network_count(network);
            int32_t from = k % 2 == 0 && count > 9 ? count - 9 : 0;
            put_child(network, (int32_t)whole(&rng, from, count - 1), n, 0, 0);
            if (whole(&rng, 0, 99) == 0) {
                put_root(network, 0, n, 0);
            }
            if (whole(&rng, 0, 59) == 0) {
                assert_law(network, law.exponent, 0.7);
            } else if (whole(&rng, 0, 9) == 0) {
                vn_network_radius(network, 0); // settles what is pending
            }
        }
        assert_ok(vn_network_scale(network, 3));
        assert_law(network, law.exponent, 2.1);
        vn_network_destroy(network);
    }
}

static void a_law_may_be_replaced(void **state) {
    (void)state;
    vn_network *network = random_tree(2, 60, 1, 5);
    vn_murray_def law = {.exponent = 2, .tip_radius = 1};
    double radius[61];
    for (int i = 0; i < 61; i++) {
        radius[i] = 0.5 + i;
    }
    assert_ok(vn_network_murray(network, &law));
    assert_ok(vn_network_set_radii(network, radius));
    assert_true(vn_network_radius(network, 7) == 7.5);
    int32_t node = put_child(network, 7, 0, 0, 0);
    assert_true(vn_network_radius(network, node) == 7.5); // as thick as what it leaves
    assert_ok(vn_network_scale(network, 2));
    assert_true(vn_network_radius(network, 7) == 15);
    law.exponent = 3;
    assert_ok(vn_network_murray(network, &law));
    assert_law(network, 3, 1);
    vn_network_destroy(network);
}

static void scaling_multiplies_every_length(void **state) {
    (void)state;
    vn_network *network = random_tree(3, 50, 1, 6);
    double z = vn_network_z(network)[20], joined;
    int32_t a, b;
    assert_ok(vn_network_join(network, 10, 40, 0.25));
    vn_network_measures before, after;
    assert_ok(vn_network_measure(network, &before));
    assert_ok(vn_network_scale(network, 4));
    assert_ok(vn_network_measure(network, &after));
    vn_network_join_ends(network, 0, &a, &b, &joined);
    assert_true(vn_network_z(network)[20] == 4 * z && joined == 1);
    assert_near(after.length, 4 * before.length, 1e-9);
    vn_network_destroy(network);
}

// ---- Measures ----

static int32_t depth_of(const vn_network *network, int32_t node) {
    int32_t depth = 0;
    while ((node = vn_network_parent(network)[node]) >= 0) {
        depth++;
    }
    return depth;
}

static double distance_between(const vn_network *network, int32_t a, int32_t b) {
    vn_points points = vn_network_points(network);
    double p[3];
    vn_points_get(&points, a, p);
    return sqrt(vn_points_distance2(&points, b, p));
}

static void measures_are_what_counting_says(void **state) {
    (void)state;
    double radius[NODES];
    for (int i = 0; i < NODES; i++) {
        radius[i] = 1 + i % 17;
    }
    for (uint64_t seed = 0; seed < 6; seed++) {
        vn_network *network =
            seed < 3 ? random_tree(2 + (int)(seed % 2), NODES, 3, seed) : shuffled(seed, radius);
        vn_network_measures m, n = {.nodes = NODES, .roots = 3, .joins = 1};
        n.min_radius = seed < 3 ? 0 : INFINITY;
        int32_t far = NODES - 1;
        assert_ok(vn_network_join(network, 0, depth_of(network, far) > 1 ? far : 100, 1));
        for (int32_t v = 0; v < NODES; v++) {
            int32_t first = vn_network_first_child(network, v), parent = vn_network_parent(network)[v];
            n.tips += first < 0;
            n.bifurcations += first >= 0 && vn_network_next_child(network, first) >= 0;
            n.depth = depth_of(network, v) > n.depth ? depth_of(network, v) : n.depth;
            n.length += parent >= 0 ? distance_between(network, v, parent) : 0;
            n.min_radius = parent >= 0 ? fmin(n.min_radius, vn_network_radius(network, v)) : n.min_radius;
            n.max_radius = parent >= 0 ? fmax(n.max_radius, vn_network_radius(network, v)) : n.max_radius;
        }
        n.length += distance_between(network, 0, depth_of(network, far) > 1 ? far : 100);
        assert_ok(vn_network_measure(network, &m));
        assert_memory_equal(&m, &n, offsetof(vn_network_measures, length));
        assert_near(m.length, n.length, 1e-8);
        assert_true(m.min_radius == n.min_radius && m.max_radius == n.max_radius);
        assert_true(m.extent.min[0] >= -5 && m.extent.min[0] < -4.5 && m.extent.max[1] > 4.5);
        vn_network_destroy(network);
    }
}

static void an_empty_network_measures_nothing(void **state) {
    (void)state;
    vn_network *network = network_of(2);
    vn_network_measures m, nothing = {0};
    assert_ok(vn_network_measure(network, &m));
    assert_memory_equal(&m, &nothing, sizeof m);
    assert_ok(vn_network_set_orders(network, VN_STRAHLER));
    assert_null(vn_network_orders(network));
    assert_ok(vn_network_scale(network, 2));
    vn_network_destroy(network);
}

static void joins_are_between_strangers(void **state) {
    (void)state;
    vn_network *network = random_tree(2, 5, 1, 1);
    int32_t stranger = put_child(network, put_child(network, 4, 0, 0, 0), 1, 1, 0);
    assert_ok(vn_network_join(network, 0, stranger, 0));
    assert_int_equal(vn_network_join_count(network), 1);
    assert_int_equal(vn_network_join(network, stranger, 0, 0), VN_INVALID);
    assert_message("not connected yet");
    assert_int_equal(vn_network_join(network, 5, stranger, 0), VN_INVALID);
    assert_int_equal(vn_network_join(network, 2, 2, 0), VN_INVALID);
    assert_int_equal(vn_network_join(network, 2, 99, 0), VN_INVALID);
    assert_int_equal(vn_network_join(network, 1, stranger, NAN), VN_INVALID);
    assert_message("radius");
    assert_int_equal(vn_network_join_count(network), 1);
    vn_network_destroy(network);
}

// ---- Orders of veins ----

static int32_t naive_strahler(const vn_network *network, int32_t node) {
    int32_t highest = 0, times = 0;
    for (int32_t c = vn_network_first_child(network, node); c >= 0; c = vn_network_next_child(network, c)) {
        int32_t order = naive_strahler(network, c);
        times = order > highest ? 1 : times + (order == highest);
        highest = order > highest ? order : highest;
    }
    return highest == 0 ? 1 : highest + (times > 1);
}

// The child of highest Strahler order (when asked), then of most tips, then of least index.
static int32_t naive_main(const vn_network *network, int32_t node, bool by_order) {
    int32_t best = -1, order = -1, tips = -1;
    for (int32_t c = 0; c < vn_network_count(network); c++) {
        if (vn_network_parent(network)[c] == node) {
            int32_t o = by_order ? naive_strahler(network, c) : 0, t = tips_below(network, c);
            if (o > order || (o == order && t > tips)) {
                best = c;
                order = o;
                tips = t;
            }
        }
    }
    return best;
}

static int32_t naive_horton(const vn_network *network, int32_t node) {
    int32_t parent = vn_network_parent(network)[node];
    bool goes_on = parent >= 0 && naive_main(network, parent, true) == node;
    return goes_on ? naive_horton(network, parent) : naive_strahler(network, node);
}

static int32_t naive_hickey(const vn_network *network, int32_t node) {
    int32_t parent = vn_network_parent(network)[node];
    return parent < 0 ? 1 : naive_hickey(network, parent) + (naive_main(network, parent, false) != node);
}

static void orders_are_what_recursion_says(void **state) {
    (void)state;
    int32_t (*naive[3])(const vn_network *, int32_t) = {naive_strahler, naive_horton, naive_hickey};
    for (uint64_t seed = 0; seed < 4; seed++) {
        vn_network *network = seed < 2 ? random_tree(2, 150, 2, seed) : shuffled(seed, NULL);
        vn_murray_def law = vn_murray_def_default();
        if (seed % 2 == 0) {
            assert_ok(vn_network_murray(network, &law));
        }
        for (int kind = VN_STRAHLER; kind <= VN_HICKEY; kind++) {
            assert_ok(vn_network_set_orders(network, (vn_order_kind)kind));
            for (int32_t v = 0; v < vn_network_count(network); v++) {
                assert_int_equal(vn_network_orders(network)[v], naive[kind](network, v));
            }
        }
        put_child(network, 0, 0, 0, 0);
        assert_null(vn_network_orders(network));
        vn_network_destroy(network);
    }
}

// 0-1; 1 forks to 2 and 3; 2 forks to 4 and 5; 3 goes on to 6; 6 forks to 7, 8 and 9.
static void orders_of_a_tree_worked_by_hand(void **state) {
    (void)state;
    static const int32_t parents[] = {-1, 0, 1, 1, 2, 2, 3, 6, 6, 6};
    static const int32_t expected[3][10] = {
        {3, 3, 2, 2, 1, 1, 2, 1, 1, 1}, {3, 3, 2, 3, 2, 1, 3, 3, 1, 1}, {1, 1, 2, 1, 2, 3, 1, 1, 2, 2}};
    vn_network *network = network_of(2);
    put_root(network, 0, 0, 0);
    for (int i = 1; i < 10; i++) {
        put_child(network, parents[i], i, 0, 0);
    }
    for (int kind = 0; kind < 3; kind++) {
        assert_ok(vn_network_set_orders(network, (vn_order_kind)kind));
        assert_memory_equal(vn_network_orders(network), expected[kind], sizeof expected[kind]);
    }
    vn_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(columns_hold_what_was_added),
        counted_test(what_makes_no_sense_is_refused),
        counted_test(a_network_stops_at_its_limit),
        counted_test(parents_come_first),
        counted_test(parents_that_form_no_forest_are_refused),
        counted_test(murrays_law_holds_however_the_network_grows),
        counted_test(a_law_may_be_replaced),
        counted_test(a_split_keeps_every_law),
        counted_test(a_split_changes_no_order),
        counted_test(a_split_with_tips_pending_counts_them_once),
        counted_test(scaling_multiplies_every_length),
        counted_test(measures_are_what_counting_says),
        counted_test(an_empty_network_measures_nothing),
        counted_test(joins_are_between_strangers),
        counted_test(orders_are_what_recursion_says),
        counted_test(orders_of_a_tree_worked_by_hand),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
