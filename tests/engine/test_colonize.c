// Space colonisation against a slow, obvious one, and the laws that hold whatever the shape.
#include "support.h"

#include "domain/domain.h"
#include "space/segment_grid.h"

enum { MOST_NODES = 20000, MOST_SOURCES = 4000 };

// ---- A slow, obvious open venation ----

typedef struct source {
    double p[3];
    uint32_t id;
    float best;
    int idle;
    bool gone;
} source;

static struct oracle {
    int dim;
    uint64_t seed;
    double node[MOST_NODES][3];
    int32_t parent[MOST_NODES];
    int32_t nodes;
    source sources[MOST_SOURCES];
    int32_t count;
    int32_t influenced[MOST_SOURCES];
    double near2[MOST_SOURCES];
    double reach2;
    bool begun;
    int32_t circled;
} oracle;

static void oracle_begin(int dim, uint64_t seed) {
    oracle.dim = dim;
    oracle.seed = seed;
    oracle.nodes = oracle.count = oracle.circled = 0;
    oracle.begun = false;
}

static void oracle_node(int32_t parent, const double p[3]) {
    assert_true(oracle.nodes < MOST_NODES);
    memcpy(oracle.node[oracle.nodes], p, 3 * sizeof *p);
    oracle.parent[oracle.nodes++] = parent;
}

static void oracle_source(const double p[3]) {
    assert_true(oracle.count < MOST_SOURCES);
    source *s = &oracle.sources[oracle.count];
    *s = (source){.id = (uint32_t)oracle.count, .best = INFINITY};
    memcpy(s->p, p, sizeof s->p);
    oracle.count++;
}

// Patience is counted anew whenever a wider reach makes everything be looked at again.
static void oracle_reach(double reach) {
    if (oracle.begun && reach * reach <= oracle.reach2) {
        return;
    }
    oracle.begun = true;
    oracle.reach2 = reach * reach;
    for (int32_t i = 0; i < oracle.count; i++) {
        oracle.sources[i].best = INFINITY;
        oracle.sources[i].idle = 0;
    }
}

static void oracle_influence(double within) {
    oracle_reach(within);
    for (int32_t i = 0; i < oracle.count; i++) {
        const source *s = &oracle.sources[i];
        oracle.influenced[i] = -1;
        oracle.near2[i] = within * within;
        for (int32_t v = 0; !s->gone && v < oracle.nodes; v++) {
            double d2 = vn_distance2(s->p, oracle.node[v]);
            int32_t best = oracle.influenced[i];
            bool ranks = best < 0 || vn_ranks_before(oracle.seed, s->id, v, best);
            if (d2 < oracle.near2[i] || (d2 == oracle.near2[i] && ranks)) {
                oracle.near2[i] = d2;
                oracle.influenced[i] = v;
            }
        }
    }
}

static double oracle_direction(int32_t v, int32_t i, double n[3]) {
    const double *p = oracle.node[v], *q = oracle.sources[i].p;
    double length = sqrt(vn_distance2(p, q));
    for (int k = 0; k < 3; k++) {
        n[k] = length > 0 ? (q[k] - p[k]) / length : 0;
    }
    return length;
}

static void oracle_place(int32_t v, const double n[3], double length, double p[3]) {
    for (int k = 0; k < 3; k++) {
        p[k] = oracle.node[v][k] + length * n[k];
    }
}

static bool oracle_has_child(int32_t v, const double p[3]) {
    const double *o = oracle.node[v];
    for (int32_t c = 0; c < oracle.nodes; c++) {
        const double *q = oracle.node[c];
        double dot = 0, lengths = sqrt(vn_distance2(o, p)) * sqrt(vn_distance2(o, q));
        for (int k = 0; k < 3; k++) {
            dot += (p[k] - o[k]) * (q[k] - o[k]);
        }
        double cross2 = lengths * lengths - dot * dot; // of the sine of the angle, times both lengths
        if (oracle.parent[c] == v && dot > 0 && cross2 < 1e-12 * lengths * lengths) {
            return true;
        }
    }
    return false;
}

static bool oracle_mean(int32_t v, double n[3]) {
    double sum[3] = {0, 0, 0};
    int32_t pairs = 0;
    for (int32_t i = 0; i < oracle.count; i++) {
        if (oracle.influenced[i] == v) {
            double one[3];
            oracle_direction(v, i, one);
            for (int k = 0; k < 3; k++) {
                sum[k] += one[k];
            }
            pairs++;
        }
    }
    double length = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    for (int k = 0; k < 3; k++) {
        n[k] = sum[k] / length;
    }
    return length > 1e-12 * pairs;
}

// R3: the first-ranked of those toward which a step leads nearer, to a place without a child.
static bool oracle_one(int32_t v, double length, double p[3]) {
    bool found = false;
    uint64_t least = 0;
    for (int32_t i = 0; i < oracle.count; i++) {
        double n[3], q[3];
        if (oracle.influenced[i] != v) {
            continue;
        }
        bool nearer = length < 2 * oracle_direction(v, i, n);
        uint64_t rank = vn_hash(oracle.seed, oracle.sources[i].id, (uint64_t)v, 0);
        oracle_place(v, n, length, q);
        if (nearer && !oracle_has_child(v, q) && (!found || rank < least)) {
            found = true;
            least = rank;
            memcpy(p, q, sizeof q);
        }
    }
    return found;
}

static void oracle_patience(int32_t v, double length) {
    for (int32_t i = 0; i < oracle.count; i++) {
        source *s = &oracle.sources[i];
        if (oracle.influenced[i] != v) {
            continue;
        }
        double distance = sqrt(oracle.near2[i]);
        if (distance < (double)s->best - 1e-3 * length) {
            s->best = (float)distance;
            s->idle = 0;
        } else if (++s->idle > 24) {
            s->gone = true;
            oracle.circled++;
        }
    }
}

static bool oracle_is_influenced(int32_t v) {
    for (int32_t i = 0; i < oracle.count; i++) {
        if (oracle.influenced[i] == v) {
            return true;
        }
    }
    return false;
}

static int32_t oracle_extend(double length) {
    int32_t before = oracle.nodes;
    for (int32_t v = 0; v < before; v++) {
        double n[3], p[3];
        if (!oracle_is_influenced(v)) {
            continue;
        }
        bool free = oracle_mean(v, n);
        oracle_place(v, n, length, p);
        free = free && !oracle_has_child(v, p);
        if (free || oracle_one(v, length, p)) {
            oracle_node(v, p);
        }
        oracle_patience(v, length);
    }
    return oracle.nodes - before;
}

static int32_t oracle_consume(double distance) {
    int32_t consumed = 0;
    oracle_reach(distance);
    for (int32_t i = 0; i < oracle.count; i++) {
        for (int32_t v = 0; !oracle.sources[i].gone && v < oracle.nodes; v++) {
            if (vn_distance2(oracle.sources[i].p, oracle.node[v]) < distance * distance) {
                oracle.sources[i].gone = true;
                consumed++;
            }
        }
    }
    return consumed;
}

// ---- Both side by side ----

typedef struct pair {
    vn_network *network;
    vn_attractors *attractors;
    vn_influence *influence;
} pair;

static pair pair_begin(int dim, uint64_t seed) {
    oracle_begin(dim, seed);
    return (pair){network_of(dim), attractors_of(dim, (int64_t)seed), NULL};
}

static void pair_end(pair *both) {
    vn_influence_destroy(both->influence);
    vn_attractors_destroy(both->attractors);
    vn_network_destroy(both->network);
}

static void pair_node(const pair *both, int32_t parent, double x, double y, double z) {
    double p[3] = {x, y, z};
    assert_ok(parent < 0 ? vn_network_root(both->network, p, NULL)
                         : vn_network_add(both->network, parent, p, NULL));
    oracle_node(parent, p);
}

static void pair_source(const pair *both, double x, double y, double z) {
    double p[3] = {x, y, z};
    put_attractor(both->attractors, x, y, z);
    oracle_source(p);
}

static void assert_same_nodes(const vn_network *network) {
    vn_points points = vn_network_points(network);
    assert_int_equal(vn_network_count(network), oracle.nodes);
    for (int32_t v = 0; v < oracle.nodes; v++) {
        double p[3];
        vn_points_get(&points, v, p);
        // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison): the same bits is what is asked for
        if (memcmp(p, oracle.node[v], sizeof p) != 0 || vn_network_parent(network)[v] != oracle.parent[v]) {
            fail_msg("node %d is (%.17g, %.17g, %.17g) and should be (%.17g, %.17g, %.17g)", v, p[0], p[1],
                     p[2], oracle.node[v][0], oracle.node[v][1], oracle.node[v][2]);
        }
    }
}

static void assert_same_sources(vn_attractors *attractors) {
    int32_t alive = 0;
    for (int32_t i = 0; i < oracle.count; i++) {
        if (!oracle.sources[i].gone) {
            double p[3];
            assert_ok(vn_attractors_position(attractors, alive++, p));
            assert_memory_equal(p, oracle.sources[i].p, sizeof p);
        }
    }
    assert_int_equal(vn_attractors_count(attractors), alive);
    assert_int_equal(vn_attractors_retired(attractors).circled, oracle.circled);
    assert_int_equal(vn_attractors_retired(attractors).hidden, 0);
}

static void assert_same_influence(const vn_influence *influence) {
    int32_t pairs = 0, alive = 0;
    for (int32_t i = 0; i < oracle.count; i++) {
        if (oracle.influenced[i] >= 0) {
            assert_true(pairs < vn_influence_count(influence));
            assert_int_equal(vn_influence_attractor(influence, pairs), alive);
            assert_int_equal(vn_influence_node(influence, pairs++), oracle.influenced[i]);
        }
        alive += !oracle.sources[i].gone;
    }
    assert_int_equal(vn_influence_count(influence), pairs);
}

// One step; how many nodes there are more. `within` 0 is any distance.
static int32_t pair_step(pair *both, double within, double length, double kill) {
    vn_influence_def find = {.within = within};
    vn_extend_def extend = {.length = length};
    vn_consume_def consume = {.distance = kill};
    int32_t added, first, consumed;
    assert_ok(vn_influence_find(&both->influence, both->attractors, both->network, &find));
    oracle_influence(within > 0 ? within : INFINITY);
    assert_same_influence(both->influence);
    assert_ok(vn_extend(both->network, both->influence, &extend, &added, &first));
    assert_int_equal(first, oracle.nodes);
    assert_int_equal(added, oracle_extend(length));
    assert_same_nodes(both->network);
    assert_ok(vn_consume(both->attractors, both->network, &consume, &consumed));
    assert_int_equal(consumed, oracle_consume(kill));
    assert_same_sources(both->attractors);
    return added;
}

static void pair_run(pair *both, double within, double length, double kill, int steps) {
    for (int step = 0; step < steps && pair_step(both, within, length, kill) > 0; step++) {
    }
}

static void scatter(const pair *both, vn_rng *rng, int32_t count, double size) {
    for (int32_t i = 0; i < count; i++) {
        double x = uniform(rng, 0, size), y = uniform(rng, 0, size);
        pair_source(both, x, y, oracle.dim == 3 ? uniform(rng, 0, size) : 0);
    }
}

static void random_sets_grow_as_the_oracle_says(void **state) {
    (void)state;
    for (uint64_t seed = 1; seed <= 24; seed++) {
        int dim = seed % 3 == 0 ? 3 : 2;
        vn_rng rng = vn_rng_make(seed);
        pair both = pair_begin(dim, seed);
        for (int root = 0; root < 1 + (int)(seed % 4); root++) {
            pair_node(&both, -1, uniform(&rng, 0, 10), uniform(&rng, 0, 10), dim == 3 ? 5 : 0);
        }
        scatter(&both, &rng, (int32_t)whole(&rng, 5, 250), 10);
        pair_run(&both, seed % 2 == 0 ? 0 : uniform(&rng, 1, 8), 0.4, uniform(&rng, 0.3, 1.5), 120);
        pair_end(&both);
    }
}

static void lattices_with_many_ties_grow_as_the_oracle_says(void **state) {
    static const double spacings[] = {1, 0.1, 0.3, 1.0 / 3, 0.7};
    (void)state;
    for (int k = 0; k < 10; k++) {
        double h = spacings[k % 5];
        pair both = pair_begin(2, 77 + (uint64_t)k);
        pair_node(&both, -1, (k < 5 ? 5 : 4.5) * h, 5 * h, 0);
        pair_node(&both, -1, 0, 0, 0);
        for (int i = 0; i < 121; i++) {
            int row = i / 11;
            pair_source(&both, (i % 11) * h, row * h, 0);
        }
        pair_run(&both, k % 2 == 0 ? 0 : 4 * h, h, h * (k % 3 == 0 ? 1 : 0.6), 60);
        pair_end(&both);
    }
}

static void a_lattice_in_space_grows_as_the_oracle_says(void **state) {
    (void)state;
    pair both = pair_begin(3, 5);
    pair_node(&both, -1, 0.2, 0.2, 0.2);
    for (int i = 0; i < 125; i++) {
        int row = i / 5 % 5, layer = i / 25;
        pair_source(&both, i % 5 * 0.1, row * 0.1, layer * 0.1);
    }
    pair_run(&both, 0, 0.05, 0.05, 60);
    pair_end(&both);
}

static void collinear_and_coincident_sources_grow_as_the_oracle_says(void **state) {
    (void)state;
    pair both = pair_begin(2, 3);
    pair_node(&both, -1, 0, 0, 0);
    for (int i = 0; i < 40; i++) {
        pair_source(&both, i % 20 - 9.5, 0, 0); // every place twice
    }
    pair_source(&both, 0, 0, 0); // on the root
    pair_run(&both, 0, 0.5, 0.6, 80);
    pair_end(&both);
}

static void an_attractor_on_a_node_harms_nothing(void **state) {
    (void)state;
    pair both = pair_begin(2, 9);
    pair_node(&both, -1, 1, 1, 0);
    pair_source(&both, 1, 1, 0);
    pair_run(&both, 0, 1, 0.5, 40);
    assert_int_equal(vn_attractors_count(both.attractors), 0);
    pair_end(&both);
}

static void what_is_added_in_the_middle_of_a_run_counts(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 8; seed++) {
        vn_rng rng = vn_rng_make(100 + seed);
        pair both = pair_begin(2, seed);
        pair_node(&both, -1, 5, 5, 0);
        scatter(&both, &rng, seed % 2 == 0 ? 30 : 300, 10);
        for (int step = 0; step < 60; step++) {
            pair_step(&both, seed < 4 ? 0 : 3, 0.3, 0.5);
            if (step % 7 == 3) {
                scatter(&both, &rng, (int32_t)whole(&rng, 1, 40), 10);
            }
            if (step % 11 == 5) {
                int32_t parent = (int32_t)whole(&rng, -1, oracle.nodes - 1);
                pair_node(&both, parent, uniform(&rng, 0, 10), uniform(&rng, 0, 10), 0);
            }
        }
        pair_end(&both);
    }
}

static void a_set_that_loses_most_of_its_attractors_is_tidied(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(12);
    pair both = pair_begin(2, 12);
    pair_node(&both, -1, 5, 5, 0);
    scatter(&both, &rng, 900, 10);
    for (int step = 0; step < 70; step++) {
        pair_step(&both, step % 2 == 0 ? 0 : 2, 0.4, 0.7);
        if (step % 9 == 8) {
            scatter(&both, &rng, 60, 10);
        }
    }
    assert_true(both.attractors->x.count < 900);
    pair_end(&both);
}

static void distances_may_change_from_step_to_step(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 10; seed++) {
        vn_rng rng = vn_rng_make(500 + seed);
        pair both = pair_begin(2, seed);
        pair_node(&both, -1, 2, 5, 0);
        scatter(&both, &rng, 200, 10);
        for (int step = 0; step < 50; step++) {
            double within = step % 5 == 0 && seed > 4 ? 0 : uniform(&rng, 1, 6);
            double kill = step % 13 == 12 ? 7 - 0.1 * step : uniform(&rng, 0.05, 0.9);
            pair_step(&both, within, uniform(&rng, 0.2, 0.5), seed < 7 ? fmin(kill, 1) : kill);
        }
        pair_end(&both);
    }
}

static void segments_longer_than_the_kill_distance_end(void **state) {
    (void)state;
    int32_t circled = 0;
    for (uint64_t seed = 0; seed < 6; seed++) {
        vn_rng rng = vn_rng_make(seed);
        pair both = pair_begin(2, seed);
        pair_node(&both, -1, 2, 2, 0);
        scatter(&both, &rng, 12, 5);
        int steps = 0;
        while (vn_attractors_count(both.attractors) > 0 && steps++ < 3000) {
            pair_step(&both, 0, 1, 0.1);
        }
        assert_int_equal(vn_attractors_count(both.attractors), 0);
        circled += vn_attractors_retired(both.attractors).circled;
        pair_end(&both);
    }
    assert_true(circled > 0);
}

// READINGS R3: between two sources, v stays nearest to both for ever.
static void a_node_between_two_sources_turns_to_one(void **state) {
    (void)state;
    pair both = pair_begin(2, 0);
    pair_node(&both, -1, 0, 0, 0);
    pair_source(&both, 5, 0.01, 0);
    pair_source(&both, -5, 0.01, 0);
    pair_step(&both, 0, 1, 1.1);
    assert_near(vn_network_x(both.network)[1], 0, 1e-12);
    assert_near(vn_network_y(both.network)[1], 1, 1e-12);
    pair_step(&both, 0, 1, 1.1);
    assert_int_equal(vn_network_parent(both.network)[2], 0);
    assert_near(fabs(vn_network_x(both.network)[2]), 1, 1e-5);
    int steps = 2;
    while (vn_attractors_count(both.attractors) > 0 && steps++ < 50) {
        pair_step(&both, 0, 1, 1.1);
    }
    assert_int_equal(vn_attractors_count(both.attractors), 0);
    for (int32_t v = 0; v < oracle.nodes; v++) {
        for (int32_t w = 0; w < v; w++) {
            assert_true(vn_distance2(oracle.node[v], oracle.node[w]) > 1e-12);
        }
    }
    pair_end(&both);
}

static void a_set_may_serve_two_networks_in_turn(void **state) {
    (void)state;
    vn_network *networks[2] = {network_of(2), network_of(2)};
    vn_attractors *attractors = attractors_of(2, 0);
    vn_influence *influence = NULL;
    vn_influence_def find = vn_influence_def_default();
    put_root(networks[0], 0, 0, 0);
    put_root(networks[1], 9, 9, 0);
    put_root(networks[1], 1, 1, 0);
    put_attractor(attractors, 2, 2, 0);
    for (int turn = 0; turn < 6; turn++) {
        assert_ok(vn_influence_find(&influence, attractors, networks[turn % 2], &find));
        assert_int_equal(vn_influence_count(influence), 1);
        assert_int_equal(vn_influence_node(influence, 0), turn % 2);
    }
    vn_influence_destroy(influence);
    vn_attractors_destroy(attractors);
    vn_network_destroy(networks[0]);
    vn_network_destroy(networks[1]);
}

static void a_scaled_network_is_looked_at_anew(void **state) {
    (void)state;
    vn_network *network = network_of(2);
    vn_attractors *attractors = attractors_of(2, 0);
    vn_influence *influence = NULL;
    vn_influence_def find = vn_influence_def_default();
    put_root(network, 1, 0, 0);
    put_root(network, 5, 0, 0);
    put_attractor(attractors, 4, 0, 0);
    assert_ok(vn_influence_find(&influence, attractors, network, &find));
    assert_int_equal(vn_influence_node(influence, 0), 1);
    assert_ok(vn_network_scale(network, 3));
    assert_false(vn_influence_current(influence));
    assert_ok(vn_influence_find(&influence, attractors, network, &find));
    assert_int_equal(vn_influence_node(influence, 0), 0);
    vn_influence_destroy(influence);
    vn_attractors_destroy(attractors);
    vn_network_destroy(network);
}

// ---- Bad input ----

static void a_stale_influence_is_refused(void **state) {
    (void)state;
    pair both = pair_begin(2, 0);
    vn_influence_def find = vn_influence_def_default();
    vn_extend_def extend = vn_extend_def_default();
    int32_t added, first;
    pair_node(&both, -1, 0, 0, 0);
    pair_source(&both, 3, 0, 0);
    assert_ok(vn_influence_find(&both.influence, both.attractors, both.network, &find));
    assert_true(vn_influence_current(both.influence));
    assert_int_equal(vn_influence_attractor(both.influence, 0), 0);
    pair_source(&both, 4, 0, 0);
    assert_false(vn_influence_current(both.influence));
    assert_int_equal(vn_influence_attractor(both.influence, 0), -1);
    assert_int_equal(vn_extend(both.network, both.influence, &extend, &added, &first), VN_INVALID);
    assert_message("out of date");
    assert_ok(vn_influence_find(&both.influence, both.attractors, both.network, &find));
    assert_ok(vn_extend(both.network, both.influence, &extend, &added, &first));
    assert_int_equal(vn_extend(both.network, both.influence, &extend, &added, &first), VN_INVALID);
    pair_end(&both);
}

static void an_influence_that_could_not_be_found_is_not_current(void **state) {
    (void)state;
    pair both = pair_begin(2, 0);
    vn_influence_def find = vn_influence_def_default();
    pair_node(&both, -1, 0, 0, 0);
    pair_source(&both, 3, 0, 0);
    assert_ok(vn_influence_find(&both.influence, both.attractors, both.network, &find));
    vn_interrupt();
    assert_int_equal(vn_influence_find(&both.influence, both.attractors, both.network, &find),
                     VN_INTERRUPTED);
    assert_false(vn_influence_current(both.influence));
    pair_end(&both);
}

static void dimensions_that_differ_are_refused(void **state) {
    (void)state;
    vn_network *space = network_of(3);
    vn_attractors *flat = attractors_of(2, 0), *solid = attractors_of(3, 0);
    vn_influence *influence = NULL;
    vn_influence_def find = vn_influence_def_default();
    vn_consume_def consume = vn_consume_def_default();
    vn_domain *ball = ball_of(0, 0, 0, 1), *disk = disk_of(0, 0, 1);
    vn_rng rng = vn_rng_make(1);
    vn_throw_def throw = {.domain = ball, .count = 3, .rng = &rng};
    vn_extend_def extend = {.length = 1, .domain = disk};
    int32_t n, first;
    put_root(space, 0, 0, 0);
    put_attractor(solid, 0, 0, 3);
    assert_int_equal(vn_influence_find(&influence, flat, space, &find), VN_INVALID);
    assert_null(influence);
    assert_int_equal(vn_consume(flat, space, &consume, &n), VN_INVALID);
    assert_int_equal(vn_throw(flat, &throw, &n), VN_INVALID);
    consume.into = flat;
    assert_int_equal(vn_consume(solid, space, &consume, &n), VN_INVALID);
    consume.into = solid;
    assert_int_equal(vn_consume(solid, space, &consume, &n), VN_INVALID);
    assert_ok(vn_influence_find(&influence, solid, space, &find));
    assert_int_equal(vn_extend(space, influence, &extend, &n, &first), VN_INVALID);
    throw = (vn_throw_def){.domain = disk, .count = 3, .rng = &rng, .network = space, .clearance = 1};
    assert_int_equal(vn_throw(flat, &throw, &n), VN_INVALID);
    vn_influence_destroy(influence);
    vn_domain_release(ball);
    vn_domain_release(disk);
    vn_attractors_destroy(flat);
    vn_attractors_destroy(solid);
    vn_network_destroy(space);
}

static void assert_bad_step(pair *both, double within, double length, double kill) {
    vn_influence_def find = {.within = within};
    vn_extend_def extend = {.length = length};
    vn_consume_def consume = {.distance = kill};
    int32_t n, first;
    vn_status status = vn_influence_find(&both->influence, both->attractors, both->network, &find);
    status = status == VN_OK ? vn_extend(both->network, both->influence, &extend, &n, &first) : status;
    status = status == VN_OK ? vn_consume(both->attractors, both->network, &consume, &n) : status;
    assert_int_equal(status, VN_INVALID);
    assert_int_equal(vn_network_count(both->network), 1);
}

static void numbers_that_make_no_sense_are_refused(void **state) {
    (void)state;
    pair both = pair_begin(2, 0);
    double nowhere[3] = {0, NAN, 0}, far[3] = {INFINITY, 0, 0};
    pair_node(&both, -1, 0, 0, 0);
    assert_int_equal(vn_attractors_add(both.attractors, nowhere), VN_INVALID);
    assert_int_equal(vn_attractors_add(both.attractors, far), VN_INVALID);
    assert_message("finite");
    assert_bad_step(&both, NAN, 1, 1);
    assert_bad_step(&both, -1, 1, 1);
    assert_bad_step(&both, 0, NAN, 1);
    assert_message("extend.length");
    assert_bad_step(&both, 0, 0, 1);
    assert_bad_step(&both, 0, 1, NAN);
    assert_bad_step(&both, 0, 1, 0);
    assert_message("consume.distance");
    assert_bad_step(&both, 0, 1, -2);
    pair_end(&both);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(random_sets_grow_as_the_oracle_says),
        counted_test(lattices_with_many_ties_grow_as_the_oracle_says),
        counted_test(a_lattice_in_space_grows_as_the_oracle_says),
        counted_test(collinear_and_coincident_sources_grow_as_the_oracle_says),
        counted_test(an_attractor_on_a_node_harms_nothing),
        counted_test(what_is_added_in_the_middle_of_a_run_counts),
        counted_test(a_set_that_loses_most_of_its_attractors_is_tidied),
        counted_test(distances_may_change_from_step_to_step),
        counted_test(segments_longer_than_the_kill_distance_end),
        counted_test(a_node_between_two_sources_turns_to_one),
        counted_test(a_set_may_serve_two_networks_in_turn),
        counted_test(a_scaled_network_is_looked_at_anew),
        counted_test(a_stale_influence_is_refused),
        counted_test(an_influence_that_could_not_be_found_is_not_current),
        counted_test(dimensions_that_differ_are_refused),
        counted_test(numbers_that_make_no_sense_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
