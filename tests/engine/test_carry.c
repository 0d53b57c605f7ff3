// What lies in growing blades: networks and attractors are carried, and stretched edges are split.
#include "support.h"

#include "growth/growth.h"

static double smooth(double y0) {
    return 1.3 + 0.25 * sin(0.8 * y0 + 1) + 0.1 * cos(1.7 * y0);
}

static double total_length(const vn_network *network) {
    vn_network_measures m;
    assert_ok(vn_network_measure(network, &m));
    return m.length;
}

static double longest_edge(const vn_network *network) {
    double longest = 0;
    for (int32_t i = 0; i < vn_network_count(network); i++) {
        double p[3], q[3];
        if (vn_network_parent(network)[i] >= 0) {
            vn_network_position(network, i, p);
            vn_network_position(network, vn_network_parent(network)[i], q);
            longest = fmax(longest, sqrt(vn_distance2(p, q)));
        }
    }
    return longest;
}

// Old nodes keep their numbers; the tree without the nodes that splitting put in is the tree before.
static void assert_same_tree(const vn_network *network, const int32_t *parent, int32_t count) {
    for (int32_t i = 0; i < count; i++) {
        int32_t above = vn_network_parent(network)[i];
        while (above >= count) {
            int32_t child = vn_network_first_child(network, above);
            assert_true(child >= 0 && vn_network_next_child(network, child) < 0);
            above = vn_network_parent(network)[above];
        }
        assert_int_equal(above, parent[i]);
    }
}

static void stretched_edges_are_split(void **state) {
    (void)state;
    vn_domain *shape = cordate_shape();
    for (uint64_t seed = 0; seed < 4; seed++) {
        vn_growth *growth =
            seed < 2 ? uniform_blade(shape, 1.3, 1.2, 5) : rerg_blade(shape, smooth, smooth, 5);
        vn_network *network = random_tree(2, 60, 2, seed);
        vn_murray_def law = {.exponent = 2.5, .tip_radius = 0.5};
        assert_ok(vn_network_murray(network, &law));
        put_child(network, 5, 1, 1, 0); // a tip that waits to be told upwards
        while (advance(growth)) {
            int32_t count = vn_network_count(network), parent[5000], order;
            double x[5000], y[5000], radius[5000], length = 0;
            assert_true(count < 5000);
            for (int32_t i = 0; i < count; i++) {
                double q[3];
                map_point(growth, vn_network_x(network)[i], vn_network_y(network)[i],
                          vn_growth_time(growth) - 1, vn_growth_time(growth), q);
                parent[i] = vn_network_parent(network)[i];
                x[i] = q[0];
                y[i] = q[1];
                radius[i] = vn_network_radius(network, i);
            }
            for (int32_t i = 0; i < count; i++) {
                length += parent[i] >= 0 ? hypot(x[i] - x[parent[i]], y[i] - y[parent[i]]) : 0;
            }
            assert_ok(vn_growth_carry(growth, network));
            for (int32_t i = 0; i < count; i++) {
                assert_true(vn_network_x(network)[i] == x[i] && vn_network_y(network)[i] == y[i]);
                assert_true(vn_network_radius(network, i) == radius[i]);
            }
            assert_near(total_length(network), length, 1e-9 * length);
            assert_true(longest_edge(network) <= 2 * (1 + 1e-12));
            assert_same_tree(network, parent, count);
            uint64_t hash = network_hash(network);
            assert_ok(vn_growth_carry(growth, network));
            assert_true(network_hash(network) == hash); // once a step
            assert_ok(vn_network_set_orders(network, VN_HICKEY));
            order = vn_network_orders(network)[3];
            assert_true(order >= 1);
        }
        uint64_t hash = network_hash(network);
        assert_ok(vn_growth_carry(growth, network));
        assert_true(network_hash(network) == hash);
        vn_network_destroy(network);
        vn_growth_release(growth);
    }
    vn_domain_release(shape);
}

static void an_edge_is_cut_into_equal_parts(void **state) {
    (void)state;
    vn_domain *shape = box_of(-1, 0, 1, 4);
    vn_growth *growth = uniform_blade(shape, 1, 1.75, 3);
    vn_network *network = network_of(2);
    put_child(network, put_root(network, 0, 0, 0), 0, 4, 0);
    assert_true(advance(growth));
    assert_ok(vn_growth_carry(growth, network));
    assert_int_equal(vn_network_count(network), 5); // 7 long: four parts
    for (int32_t node = 1, k = 4; k > 0; k--, node = vn_network_parent(network)[node]) {
        assert_near(vn_network_y(network)[node], 1.75 * k, 1e-12);
    }
    vn_network_destroy(network);
    vn_growth_release(growth);
    vn_domain_release(shape);
}

static void isogonic_growth_splits_by_its_unit(void **state) {
    (void)state;
    vn_domain *shape = leaf_shape();
    vn_growth_def def = {.domain = shape, .from = 12, .to = 48, .step = 12, .split = 3};
    vn_growth *growth = NULL;
    vn_network *network = network_of(2);
    put_child(network, put_root(network, 0, 0, 0), 0, 6, 0);
    assert_ok(vn_growth_isogonic(&growth, &def));
    for (int step = 1; advance(growth); step++) {
        assert_ok(vn_growth_carry(growth, network));
        assert_true(longest_edge(network) <= 3.0 / (step + 1));
        assert_near(total_length(network), 6, 1e-12);
    }
    assert_int_equal(vn_network_count(network), 9);
    assert_true(network->moved == 0);
    vn_network_destroy(network);
    vn_growth_release(growth);
    def.split = 0;
    network = network_of(2);
    put_child(network, put_root(network, 0, 0, 0), 0, 6, 0);
    assert_ok(vn_growth_isogonic(&growth, &def));
    while (advance(growth)) {
        assert_ok(vn_growth_carry(growth, network));
    }
    assert_int_equal(vn_network_count(network), 2);
    vn_network_destroy(network);
    vn_growth_release(growth);
    vn_domain_release(shape);
}

static void without_room_for_the_parts_nothing_moves(void **state) {
    (void)state;
    vn_domain *shape = box_of(-1, 0, 1, 40);
    vn_growth *growth = uniform_blade(shape, 1.5, 1.5, 3);
    vn_network_def def = {.dim = 2, .max_nodes = 5, .unit = ""};
    vn_network *network = NULL;
    assert_ok(vn_network_create(&network, &def));
    put_child(network, put_root(network, 1, 1, 0), 1, 30, 0);
    uint64_t hash = network_hash(network);
    assert_true(advance(growth));
    assert_int_equal(vn_growth_carry(growth, network), VN_LIMIT);
    assert_message("max_nodes = 5");
    assert_true(network_hash(network) == hash);
    vn_network_destroy(network);
    vn_network *solid = network_of(3);
    assert_int_equal(vn_growth_carry(growth, solid), VN_INVALID);
    assert_message("3 dimensions");
    vn_network_destroy(solid);
    vn_growth_release(growth);
    vn_domain_release(shape);
}

// ---- Attractors ----

static int32_t naive_nearest(const vn_network *network, const double p[3]) {
    int32_t best = 0;
    for (int32_t i = 1; i < vn_network_count(network); i++) {
        double a = hypot(vn_network_x(network)[i] - p[0], vn_network_y(network)[i] - p[1]);
        double b = hypot(vn_network_x(network)[best] - p[0], vn_network_y(network)[best] - p[1]);
        best = a < b ? i : best;
    }
    return best;
}

static void assert_nearest(vn_attractors *attractors, vn_network *network) {
    vn_influence_def def = vn_influence_def_default();
    vn_influence *influence = NULL;
    assert_ok(vn_influence_find(&influence, attractors, network, &def));
    assert_int_equal(vn_influence_count(influence), vn_attractors_count(attractors));
    for (int32_t k = 0; k < vn_influence_count(influence); k++) {
        double p[3];
        assert_ok(vn_attractors_position(attractors, vn_influence_attractor(influence, k), p));
        assert_int_equal(vn_influence_node(influence, k), naive_nearest(network, p));
    }
    vn_influence_destroy(influence);
}

static void assert_apart(vn_attractors *attractors, int32_t first, double spacing) {
    for (int32_t i = first; i < vn_attractors_count(attractors); i++) {
        for (int32_t j = 0; j < i; j++) {
            double p[3], q[3];
            assert_ok(vn_attractors_position(attractors, i, p));
            assert_ok(vn_attractors_position(attractors, j, q));
            assert_true(hypot(p[0] - q[0], p[1] - q[1]) > spacing);
        }
    }
}

static void attractors_move_with_the_tissue(void **state) {
    (void)state;
    vn_domain *shape = cordate_shape();
    vn_growth *growth = rerg_blade(shape, smooth, smooth, 5);
    vn_attractors *attractors = attractors_of(2, 1);
    vn_network *network = random_tree(2, 70, 1, 3);
    vn_rng rng = vn_rng_make(5);
    vn_throw_def throw = {.domain = vn_growth_domain(growth), .count = 300, .spacing = 0.5, .rng = &rng};
    vn_consume_def consume = {.distance = 0.3};
    int32_t accepted, consumed;
    do {
        assert_ok(vn_throw(attractors, &throw, &accepted));
        assert_apart(attractors, vn_attractors_count(attractors) - accepted, 0.5);
        assert_nearest(attractors, network);
        assert_ok(vn_consume(attractors, network, &consume, &consumed));
        int32_t count = vn_attractors_count(attractors);
        double before[2000][3];
        assert_true(count < 2000);
        for (int32_t i = 0; i < count; i++) {
            assert_ok(vn_attractors_position(attractors, i, before[i]));
        }
        bool growing = advance(growth);
        for (int twice = 0; twice < 2; twice++) {
            assert_ok(vn_attractors_carry(attractors, growth));
            assert_ok(vn_growth_carry(growth, network));
        }
        assert_int_equal(vn_attractors_count(attractors), count);
        for (int32_t i = 0; i < count && growing; i++) {
            double p[3], q[3];
            assert_ok(vn_attractors_position(attractors, i, p));
            map_point(growth, before[i][0], before[i][1], vn_growth_time(growth) - 1, vn_growth_time(growth),
                      q);
            assert_true(p[0] == q[0] && p[1] == q[1]);
        }
        assert_nearest(attractors, network);
    } while (!vn_growth_is_grown(growth));
    assert_int_equal(vn_growth_time(growth), 5);
    vn_attractors_destroy(attractors);
    vn_network_destroy(network);
    vn_growth_release(growth);
    vn_domain_release(shape);
}

// Veins on a pane of glass over the tissue.
static void attractors_may_move_alone(void **state) {
    (void)state;
    vn_domain *shape = box_of(-3, 0, 3, 5);
    vn_growth *growth = uniform_blade(shape, 1.4, 1.2, 3);
    vn_attractors *attractors = attractors_of(2, 1);
    vn_network *network = random_tree(2, 300, 1, 3);
    vn_rng rng = vn_rng_make(5);
    vn_throw_def throw = {.domain = shape, .count = 200, .rng = &rng};
    int32_t accepted;
    assert_ok(vn_throw(attractors, &throw, &accepted));
    do {
        assert_nearest(attractors, network);
        assert_ok(vn_attractors_carry(attractors, growth));
    } while (advance(growth));
    assert_true(network->moved == 0);
    vn_attractors_destroy(attractors);
    vn_network_destroy(network);
    vn_growth_release(growth);
    vn_domain_release(shape);
}

// ---- Memory ----

static vn_status grow_once(vn_domain *shape, vn_domain *other, vn_network *network, int kind) {
    vn_growth *growth = NULL;
    vn_rerg_def rerg = vn_rerg_def_default();
    vn_domain *domains[] = {shape, other};
    vn_morph_def morph = vn_morph_def_default();
    bool growing;
    morph.domains = domains;
    morph.count = 2;
    rerg.domain = shape;
    vn_status status = kind == 0 ? vn_growth_rerg(&growth, &rerg) : vn_growth_morph(&growth, &morph);
    status = status == VN_OK ? vn_growth_advance(growth, &growing) : status;
    status = status == VN_OK ? vn_growth_carry(growth, network) : status;
    vn_growth_release(growth);
    return status;
}

static void no_memory_leaves_nothing_behind(void **state) {
    (void)state;
    vn_domain *shape = leaf_shape(), *other = cordate_shape();
    for (int kind = 0; kind < 2; kind++) {
        vn_status status = VN_NO_MEMORY;
        int64_t n = 0;
        for (; status != VN_OK; n++) {
            vn_network *network = random_tree(2, 50, 1, 3);
            uint64_t hash = network_hash(network);
            size_t bytes = vn_byte_count();
            vn_fail_allocations_from(n);
            status = grow_once(shape, other, network, kind);
            vn_fail_allocations_from(-1);
            if (status != VN_OK) {
                assert_int_equal(status, VN_NO_MEMORY);
                assert_true(network_hash(network) == hash);
            }
            assert_true(vn_byte_count() <= bytes + 100000);
            vn_network_destroy(network);
        }
        assert_true(n > 20);
    }
    vn_domain_release(shape);
    vn_domain_release(other);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(stretched_edges_are_split),
        counted_test(an_edge_is_cut_into_equal_parts),
        counted_test(isogonic_growth_splits_by_its_unit),
        counted_test(without_room_for_the_parts_nothing_moves),
        counted_test(attractors_move_with_the_tissue),
        counted_test(attractors_may_move_alone),
        counted_test(no_memory_leaves_nothing_behind),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
