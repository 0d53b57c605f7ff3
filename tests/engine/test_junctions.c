// Where veins meet (READINGS R6), by the rule itself: a run of one source among roots, watched from outside.
// What is tagged, which veins have come and what joins them is worked out from where nodes are and when they
// came, by going through all of them.

#include "support.h"

#include "space/exact.h"

enum { MOST_NODES = 600, MOST_STEPS = 200 };

/// One source, the veins that grow to it, and what R6 says of them so far.
typedef struct meeting {
    double source[3];
    double kill;
    vn_network *network;
    vn_attractors *alive;
    vn_influence *found;
    bool touched;
    bool tagged[MOST_NODES], came[MOST_NODES];
    int32_t nodes, joins; ///< before the source died
} meeting;

/// How often each case came.
typedef struct tally {
    int clean;   ///< all ends close to one another
    int several; ///< of these, more than two ends
    int apart;   ///< none close to another
    int chains;  ///< some
} tally;

static void place_of(const meeting *m, int32_t node, double p[3]) {
    vn_network_position(m->network, node, p);
}

static double distance_between(const double p[3], const double q[3]) {
    return sqrt(vn_distance2(p, q));
}

static double way_to_source(const meeting *m, int32_t node) {
    double p[3];
    place_of(m, node, p);
    return distance_between(p, m->source);
}

static double way_between(const meeting *m, int32_t a, int32_t b) {
    double p[3], q[3];
    place_of(m, a, p);
    place_of(m, b, q);
    return distance_between(p, q);
}

// READINGS R4, word for word.
static bool is_neighbor(const meeting *m, int32_t v) {
    double p[3], q[3];
    place_of(m, v, p);
    for (int32_t u = 0; u < vn_network_count(m->network); u++) {
        place_of(m, u, q);
        if (u != v && vn_compare_distances(m->source, q, p) < 0 &&
            vn_compare_distances(p, q, m->source) <= 0) {
            return false;
        }
    }
    return true;
}

// At random, on a regular polygon, on one line, or in two bundles.
static void place_root(vn_rng *rng, int kind, int k, int roots, double p[3]) {
    double angle = uniform(rng, 0, 6.28), far = uniform(rng, 2, 9);
    if (kind == 1) {
        angle = 6.283185307179586 * k / roots;
        far = 5;
    } else if (kind == 2) {
        angle = k % 2 == 0 ? 0 : 3.141592653589793;
    } else if (kind == 3) {
        angle = (k % 2 == 0 ? 0.5 : 2.8) + uniform(rng, -0.4, 0.4);
    }
    p[0] = far * cos(angle);
    p[1] = far * sin(angle);
    p[2] = 0;
}

static void begin(meeting *m, uint64_t seed) {
    static const double kills[] = {0.7, 1, 1.2, 2, 3, 5};
    vn_rng rng = vn_rng_make(seed);
    int roots = (int)whole(&rng, 2, 8);
    *m = (meeting){
        .kill = kills[seed % 6], .network = network_of(2), .alive = attractors_of(2, (int64_t)seed)};
    for (int k = 0; k < roots; k++) {
        double p[3];
        place_root(&rng, (int)(seed / 6 % 4), k, roots, p);
        put_root(m->network, p[0], p[1], p[2]);
    }
    put_attractor(m->alive, 0, 0, 0);
}

static void end(meeting *m) {
    vn_influence_destroy(m->found);
    vn_attractors_destroy(m->alive);
    vn_network_destroy(m->network);
}

// The first vein that comes tags all that are drawn then; descendants inherit.
static void tag(meeting *m, int32_t before) {
    const int32_t *parent = vn_network_parent(m->network);
    int32_t count = vn_network_count(m->network);
    assert_true(count <= MOST_NODES);
    for (int32_t v = before; v < count; v++) {
        m->tagged[v] = parent[v] >= 0 && m->tagged[parent[v]];
    }
    bool comes = false;
    for (int32_t v = 0; v < count && !m->touched; v++) {
        comes = comes || way_to_source(m, v) < m->kill;
    }
    for (int32_t v = 0; v < count && comes; v++) {
        m->tagged[v] = is_neighbor(m, v);
    }
    m->touched = m->touched || comes;
    for (int32_t v = 0; v < count; v++) {
        bool here = m->tagged[v] && way_to_source(m, v) < m->kill;
        m->came[v] = m->came[v] || (here && is_neighbor(m, v));
    }
}

// Until the source is gone. False when it was given up instead.
static bool run(meeting *m) {
    vn_influence_def find = {.mode = VN_RELATIVE};
    vn_extend_def extend = {.length = 1};
    vn_consume_def consume = {.distance = m->kill, .mode = VN_CONSUME_TAGGED};
    for (int step = 0; vn_attractors_count(m->alive) > 0; step++) {
        int32_t added, first, consumed;
        assert_true(step < MOST_STEPS);
        assert_ok(vn_influence_find(&m->found, m->alive, m->network, &find));
        assert_ok(vn_extend(m->network, m->found, &extend, &added, &first));
        tag(m, first);
        m->nodes = vn_network_count(m->network);
        m->joins = vn_network_join_count(m->network);
        assert_ok(vn_consume(m->alive, m->network, &consume, &consumed));
    }
    vn_retired retired = vn_attractors_retired(m->alive);
    return retired.hidden + retired.circled + retired.barred == 0;
}

// --- who has come, and who is to be joined ----------------------------------------------------------------

static bool is_above(const meeting *m, int32_t above, int32_t node) {
    for (node = vn_network_parent(m->network)[node]; node >= 0; node = vn_network_parent(m->network)[node]) {
        if (node == above) {
            return true;
        }
    }
    return false;
}

// Of one vein its last node is its end. The junction's own node came too late to count.
static int list_ends(const meeting *m, int32_t ends[MOST_NODES]) {
    int count = 0;
    for (int32_t v = 0; v < m->nodes; v++) {
        bool last = m->came[v];
        for (int32_t w = 0; w < m->nodes && last; w++) {
            last = !(m->came[w] && is_above(m, v, w));
        }
        if (last) {
            ends[count++] = v;
        }
    }
    return count;
}

static bool are_close(const meeting *m, int32_t a, int32_t b) {
    return way_between(m, a, b) <= 2 * (1 + 1e-9);
}

// One node apart, or next to one another.
static bool are_joined(const meeting *m, int32_t a, int32_t b) {
    bool joined = vn_network_connected(m->network, a, b);
    for (int32_t c = 0; c < vn_network_count(m->network) && !joined; c++) {
        joined = vn_network_connected(m->network, a, c) && vn_network_connected(m->network, b, c);
    }
    return joined;
}

static int count_close_pairs(const meeting *m, const int32_t *ends, int count) {
    int close = 0;
    for (int a = 0; a < count; a++) {
        for (int b = 0; b < a; b++) {
            close += are_close(m, ends[a], ends[b]);
        }
    }
    return close;
}

// --- what must hold ---------------------------------------------------------------------------------------

static void fail_at(uint64_t seed, const char *what, int is, int expected) {
    if (is != expected) {
        fail_msg("seed %d: %s: %d, not %d", (int)seed, what, is, expected);
    }
}

// Two ends within two segments of one another are joined, always.
static void check_no_near_miss(const meeting *m, uint64_t seed, const int32_t *ends, int count) {
    for (int a = 0; a < count; a++) {
        for (int b = 0; b < a; b++) {
            if (are_close(m, ends[a], ends[b]) && !are_joined(m, ends[a], ends[b])) {
                fail_msg("seed %d: ends %d and %d are %g apart, and not joined", (int)seed, ends[a], ends[b],
                         way_between(m, ends[a], ends[b]));
            }
        }
    }
}

static void check_short(const meeting *m, uint64_t seed) {
    for (int32_t v = m->nodes; v < vn_network_count(m->network); v++) {
        assert_true(way_between(m, v, vn_network_parent(m->network)[v]) <= 2 + 1e-9);
    }
    for (int32_t j = m->joins; j < vn_network_join_count(m->network); j++) {
        int32_t a, b;
        double radius;
        vn_network_join_ends(m->network, j, &a, &b, &radius);
        if (way_between(m, a, b) > 2 + 1e-9) {
            fail_msg("seed %d: join %d is %g long", (int)seed, j, way_between(m, a, b));
        }
    }
}

// All ends are close to one another: one node at the source, or the end that is there, and an edge from each
// other end to it. Its own one is the first that came.
static void check_junction(const meeting *m, uint64_t seed, const int32_t *ends, int count) {
    const int32_t *birth = vn_network_birth(m->network);
    int32_t junction = m->nodes, first = ends[0];
    bool near = true;
    for (int k = 0; k < count; k++) {
        junction = junction == m->nodes && way_to_source(m, ends[k]) < 1e-6 ? ends[k] : junction;
        first = birth[ends[k]] < birth[first] ? ends[k] : first;
        near = near && way_to_source(m, ends[k]) <= 2 * (1 + 1e-9);
    }
    fail_at(seed, "new nodes", vn_network_count(m->network) - m->nodes, junction == m->nodes);
    fail_at(seed, "joins", vn_network_join_count(m->network) - m->joins, count - 1);
    if (junction == m->nodes) {
        fail_at(seed, "parent", vn_network_parent(m->network)[junction], first);
        assert_true(!near || way_to_source(m, junction) < 1e-12);
    }
    for (int k = 0; k < count; k++) {
        assert_true(ends[k] == junction || vn_network_connected(m->network, ends[k], junction));
    }
}

static void check_meeting(const meeting *m, uint64_t seed, tally *all) {
    int32_t ends[MOST_NODES];
    int count = list_ends(m, ends), close = count_close_pairs(m, ends, count);
    check_short(m, seed);
    check_no_near_miss(m, seed, ends, count);
    if (close == 0) {
        fail_at(seed, "new nodes", vn_network_count(m->network) - m->nodes, 0);
        fail_at(seed, "joins", vn_network_join_count(m->network) - m->joins, 0);
        all->apart++;
    } else if (close == count * (count - 1) / 2) {
        check_junction(m, seed, ends, count);
        all->clean++;
        all->several += count > 2;
    } else {
        all->chains++;
    }
}

static void veins_that_come_to_one_source_meet_in_one_node(void **state) {
    (void)state;
    tally all = {0};
    for (uint64_t seed = 0; seed < 6000; seed++) {
        meeting m;
        begin(&m, seed);
        if (run(&m)) {
            check_meeting(&m, seed, &all);
        }
        end(&m);
    }
    assert_true(all.clean > 2000);
    assert_true(all.several > 500);
    assert_true(all.apart > 2000);
    assert_true(all.chains > 100);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(veins_that_come_to_one_source_meet_in_one_node),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
