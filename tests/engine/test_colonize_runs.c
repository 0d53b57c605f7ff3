// Whole runs: darts, margins that move, concave shapes, threads, and memory that runs out.
#include "support.h"

#include "domain/domain.h"
#include "space/segment_grid.h"

static void position_of(const vn_network *network, int32_t node, double p[3]) {
    vn_points points = vn_network_points(network);
    vn_points_get(&points, node, p);
}

static double nearest_node2(const vn_network *network, const double p[3]) {
    double least = INFINITY;
    vn_points points = vn_network_points(network);
    for (int32_t v = 0; v < vn_network_count(network); v++) {
        least = fmin(least, vn_points_distance2(&points, v, p));
    }
    return least;
}

static uint64_t hash_attractors(vn_attractors *attractors) {
    uint64_t hash = 0;
    for (int32_t i = 0; i < vn_attractors_count(attractors); i++) {
        double p[3];
        uint64_t bits[3];
        assert_ok(vn_attractors_position(attractors, i, p));
        memcpy(bits, p, sizeof bits);
        hash = vn_hash(hash, bits[0], bits[1], bits[2]);
    }
    return hash;
}

// ---- Darts ----

static void darts_keep_their_distances_and_stay_inside(void **state) {
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        vn_domain *domain = dim == 2 ? disk_of(3, -2, 5) : ball_of(1, 2, 3, 4);
        vn_network *network = random_tree(dim, 30, 2, 4);
        vn_attractors *attractors = attractors_of(dim, 0);
        vn_rng rng = vn_rng_make(8);
        vn_throw_def throw = {
            .domain = domain, .spacing = 0.4, .clearance = 0.7, .network = network, .rng = &rng};
        int32_t accepted, sum = 0;
        for (int call = 0; call < 4; call++) {
            throw.count = call < 2 ? 40 : 2000;
            assert_ok(vn_throw(attractors, &throw, &accepted));
            assert_true(accepted > 0);
            sum += accepted;
        }
        assert_int_equal(sum, vn_attractors_count(attractors));
        assert_int_equal(rng.counter, 4);
        for (int32_t i = 0; i < sum; i++) {
            double p[3], q[3];
            assert_ok(vn_attractors_position(attractors, i, p));
            assert_true(vn_domain_contains(domain, p));
            assert_true(nearest_node2(network, p) > 0.7 * 0.7);
            for (int32_t j = 0; j < i; j++) {
                assert_ok(vn_attractors_position(attractors, j, q));
                assert_true(vn_distance2(p, q) > 0.4 * 0.4);
            }
        }
        vn_attractors_destroy(attractors);
        vn_network_destroy(network);
        vn_domain_release(domain);
    }
}

// The same darts without spacing are all that fly; the law is then applied to them one after another.
static void darts_are_accepted_one_after_another(void **state) {
    (void)state;
    enum { DARTS = 900 };
    vn_domain *domain = box_of(0, 0, 10, 10);
    vn_attractors *all = attractors_of(2, 0), *kept = attractors_of(2, 0);
    vn_rng rng = vn_rng_make(15), same = rng;
    vn_throw_def throw = {.domain = domain, .count = DARTS, .rng = &rng};
    int32_t accepted, expected = 0;
    assert_ok(vn_throw(all, &throw, &accepted));
    assert_int_equal(accepted, DARTS);
    throw.rng = &same;
    throw.spacing = 0.5;
    assert_ok(vn_throw(kept, &throw, &accepted));
    double list[DARTS][3];
    for (int32_t i = 0; i < DARTS; i++) {
        bool refused = false;
        assert_ok(vn_attractors_position(all, i, list[expected]));
        for (int32_t j = 0; j < expected; j++) {
            refused = refused || vn_distance2(list[j], list[expected]) <= 0.25;
        }
        if (!refused) {
            double p[3];
            assert_ok(vn_attractors_position(kept, expected, p));
            assert_memory_equal(p, list[expected], sizeof p);
            expected++;
        }
    }
    assert_int_equal(accepted, expected);
    vn_attractors_destroy(all);
    vn_attractors_destroy(kept);
    vn_domain_release(domain);
}

static void a_fraction_of_a_dart_is_carried_on(void **state) {
    (void)state;
    static const int32_t expected[] = {0, 1, 0, 1, 1, 0, 1, 1, 0, 1}; // 0.625 a call
    vn_domain *domain = box_of(0, 0, 2, 1);
    vn_attractors *attractors = attractors_of(2, 0);
    vn_rng rng = vn_rng_make(1);
    vn_throw_def throw = {.domain = domain, .density = 0.3125, .rng = &rng};
    int32_t accepted, sum = 0, should = 0;
    for (int call = 0; call < 10; call++) {
        assert_ok(vn_throw(attractors, &throw, &accepted));
        sum += accepted;
        should += expected[call];
        assert_int_equal(sum, should);
    }
    vn_attractors_destroy(attractors);
    vn_domain_release(domain);
}

static void darts_do_not_depend_on_threads(void **state) {
    (void)state;
    vn_domain *domain = maple_shape();
    uint64_t hashes[3];
    for (int k = 0; k < 3; k++) {
        static const int threads[3] = {1, 2, 8};
        vn_attractors *attractors = attractors_of(2, 0);
        vn_rng rng = vn_rng_make(3);
        vn_throw_def throw = {.domain = domain, .count = 70000, .spacing = 0.05, .rng = &rng};
        int32_t accepted;
        vn_set_threads(threads[k]);
        assert_ok(vn_throw(attractors, &throw, &accepted));
        assert_true(accepted > 1024);
        hashes[k] = hash_attractors(attractors);
        vn_attractors_destroy(attractors);
    }
    vn_set_threads(0);
    assert_true(hashes[0] == hashes[1] && hashes[0] == hashes[2]);
    vn_domain_release(domain);
}

static void a_domain_that_no_dart_hits_is_infeasible(void **state) {
    (void)state;
    static const double sliver[] = {0, 0, 1000, 1000, 1000, 1000.0000002};
    vn_domain *domain = polygon_of(sliver, 3);
    vn_attractors *attractors = attractors_of(2, 0);
    vn_rng rng = vn_rng_make(3);
    vn_throw_def throw = {.domain = domain, .count = 1, .rng = &rng};
    int32_t accepted;
    assert_int_equal(vn_throw(attractors, &throw, &accepted), VN_INFEASIBLE);
    assert_message("no dart");
    assert_int_equal(accepted, 0);
    assert_int_equal(vn_attractors_count(attractors), 0);
    vn_attractors_destroy(attractors);
    vn_domain_release(domain);
}

static void assert_bad_throw(vn_throw_def def, const char *says) {
    vn_attractors *attractors = attractors_of(2, 0);
    int32_t accepted;
    assert_int_equal(vn_throw(attractors, &def, &accepted), VN_INVALID);
    assert_message(says);
    assert_int_equal(accepted, 0);
    vn_attractors_destroy(attractors);
}

static void a_throw_that_makes_no_sense_is_refused(void **state) {
    (void)state;
    vn_domain *disk = disk_of(0, 0, 1);
    vn_rng rng = vn_rng_make(1);
    assert_bad_throw((vn_throw_def){.domain = disk, .rng = &rng}, "count");
    assert_bad_throw((vn_throw_def){.domain = disk, .rng = &rng, .count = 1, .density = 1}, "density");
    assert_bad_throw((vn_throw_def){.domain = disk, .rng = &rng, .count = 1, .spacing = NAN},
                     "throw.spacing");
    assert_bad_throw((vn_throw_def){.domain = disk, .rng = &rng, .count = 1, .spacing = -1},
                     "throw.spacing = -1");
    assert_bad_throw((vn_throw_def){.domain = disk, .rng = &rng, .count = -4}, "throw.count = -4");
    assert_bad_throw((vn_throw_def){.domain = disk, .rng = &rng, .density = NAN}, "throw.density");
    assert_bad_throw((vn_throw_def){.domain = disk, .rng = &rng, .count = 1, .clearance = 1},
                     "throw.network");
    vn_domain_release(disk);
}

// ---- Margins that move ----

static vn_growth *blade(vn_domain *shape, double step) {
    vn_growth_def def = vn_growth_def_default();
    vn_growth *growth = NULL;
    def.domain = shape;
    def.step = step;
    assert_ok(vn_growth_marginal(&growth, &def));
    return growth;
}

// What became attractors since `from`: passed by the margin in this step, and clear of the nodes.
static void check_released(vn_attractors *attractors, int32_t from, const vn_growth *growth, double before,
                           const vn_network *network, double clearance) {
    const vn_domain *domain = (const vn_domain *)growth;
    for (int32_t i = from; i < vn_attractors_count(attractors); i++) {
        double p[3];
        assert_ok(vn_attractors_position(attractors, i, p));
        double arrival = domain->kind->margin->arrival(domain, p);
        assert_true(arrival <= vn_growth_length(growth) && arrival > before);
        assert_true(vn_domain_contains(domain, p));
        assert_true(nearest_node2(network, p) > clearance * clearance);
    }
}

static void a_margin_releases_what_it_passes(void **state) {
    (void)state;
    vn_domain *shape = disk_of(0, 5, 5);
    vn_growth *growth = blade(shape, 0.37);
    vn_network *network = random_tree(2, 20, 1, 3);
    vn_attractors *attractors = attractors_of(2, 0);
    vn_rng rng = vn_rng_make(5);
    vn_throw_def throw = {.domain = vn_growth_domain(growth),
                          .density = 20,
                          .spacing = 0.1,
                          .clearance = 0.3,
                          .network = network,
                          .rng = &rng};
    double before = 0;
    int32_t accepted, sum = 0;
    assert_ok(vn_throw(attractors, &throw, &accepted));
    int32_t sown = accepted + vn_attractors_dormant(attractors);
    assert_in_range(sown, 1000, 1571);
    do {
        sum += accepted;
        check_released(attractors, sum - accepted, growth, before, network, 0.3);
        for (int32_t i = 0; i < attractors->dormant.count; i++) {
            assert_true(attractors->dormant.data[i].arrival > vn_growth_length(growth));
        }
        before = vn_growth_length(growth);
        advance(growth);
        assert_ok(before < 5 ? vn_throw(attractors, &throw, &accepted)
                             : vn_release(attractors, network, &accepted));
    } while (before < vn_growth_length(growth));
    assert_int_equal(vn_attractors_dormant(attractors), 0);
    assert_int_equal(sum, vn_attractors_count(attractors));
    assert_true(sum < sown && sum > sown / 2);
    vn_growth_release(growth);
    vn_attractors_destroy(attractors);
    vn_network_destroy(network);
    vn_domain_release(shape);
}

// ---- Shapes that hide ----

typedef struct setting {
    vn_domain *domain;
    double length, kill;
    double at[3];
    uint64_t seed;
    int32_t darts;
} setting;

static bool crosses_no_edge(const vn_rings *rings, const vn_segment *line) {
    for (int32_t r = 0; r < rings->ends.count; r++) {
        int32_t begin = vn_rings_begin(rings, r), end = rings->ends.data[r];
        for (int32_t i = begin; i < end; i++) {
            int32_t j = i + 1 < end ? i + 1 : begin;
            vn_segment edge = {rings->x.data[i], rings->y.data[i], rings->x.data[j], rings->y.data[j]};
            if (vn_segments_touch(line, &edge)) {
                return false;
            }
        }
    }
    return true;
}

static void assert_edge_inside(const vn_domain *domain, const vn_network *network, int32_t node) {
    double p[3], q[3], at[3];
    position_of(network, node, p);
    position_of(network, vn_network_parent(network)[node], q);
    for (int k = 0; k <= 40; k++) {
        for (int c = 0; c < 3; c++) {
            at[c] = q[c] + k / 40.0 * (p[c] - q[c]);
        }
        assert_true(vn_domain_contains(domain, at));
    }
    vn_segment line = {q[0], q[1], p[0], p[1]};
    vn_rings rings = {0}; // of a polygon, whose outline is its border
    if (strcmp(domain->kind->name, "polygon") == 0) {
        assert_ok(vn_domain_outline(domain, 4, &rings));
        assert_true(rings.ends.count > 0);
    }
    assert_true(crosses_no_edge(&rings, &line));
    vn_rings_free(&rings);
}

static void assert_none_in_reach(vn_attractors *attractors, const vn_network *network, double kill) {
    for (int32_t i = 0; i < vn_attractors_count(attractors); i++) {
        double p[3];
        assert_ok(vn_attractors_position(attractors, i, p));
        assert_true(nearest_node2(network, p) >= kill * kill);
    }
}

static int32_t one_step(vn_network *network, vn_attractors *attractors, vn_influence **influence,
                        const setting *s) {
    vn_influence_def find = vn_influence_def_default();
    vn_extend_def extend = {.length = s->length, .domain = s->domain};
    vn_consume_def consume = {.distance = s->kill};
    int32_t added, first, consumed, before = vn_attractors_count(attractors);
    assert_ok(vn_influence_find(influence, attractors, network, &find));
    assert_ok(vn_extend(network, *influence, &extend, &added, &first));
    for (int32_t v = first; v < first + added && s->domain != NULL; v++) {
        assert_edge_inside(s->domain, network, v);
    }
    assert_ok(vn_consume(attractors, network, &consume, &consumed));
    assert_none_in_reach(attractors, network, s->kill);
    return added + before - vn_attractors_count(attractors);
}

// Until no attractor is left, which happens however the border winds.
static void run_inside(const setting *s) {
    vn_network *network = network_of(2);
    vn_attractors *attractors = attractors_of(2, (int64_t)s->seed);
    vn_influence *influence = NULL;
    vn_rng rng = vn_rng_make(s->seed);
    vn_throw_def throw = {.domain = s->domain, .count = s->darts, .rng = &rng};
    int32_t accepted, steps = 0, idle = 0;
    put_root(network, s->at[0], s->at[1], 0);
    assert_ok(vn_throw(attractors, &throw, &accepted));
    while (vn_attractors_count(attractors) > 0) {
        idle = one_step(network, attractors, &influence, s) > 0 ? 0 : idle + 1;
        assert_true(idle < 30 && steps++ < 3000);
    }
    assert_true(vn_network_count(network) > 10);
    vn_influence_destroy(influence);
    vn_attractors_destroy(attractors);
    vn_network_destroy(network);
}

static void veins_stay_inside_concave_shapes_and_every_run_ends(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 4; seed++) {
        vn_domain *shapes[3] = {u_shape(), comb_shape(), maple_shape()};
        static const double roots[3][3] = {{1, 9, 0}, {0.5, 7.5, 0}, {0.1, 0.1, 0}};
        for (int k = 0; k < 3; k++) {
            setting s = {.domain = shapes[k],
                         .length = seed == 3 ? 0.9 : 0.2,
                         .kill = 0.3,
                         .seed = seed,
                         .darts = 250};
            memcpy(s.at, roots[k], sizeof s.at);
            run_inside(&s);
            vn_domain_release(shapes[k]);
        }
    }
}

static void veins_stay_inside_combinations(void **state) {
    (void)state;
    vn_domain *outer = disk_of(0, 0, 5), *hole = disk_of(1, 0, 2.5), *domain = NULL;
    assert_ok(vn_domain_combine(&domain, outer, hole, VN_DIFFERENCE));
    setting s = {.domain = domain, .length = 0.25, .kill = 0.3, .at = {-4, 0, 0}, .seed = 3, .darts = 200};
    run_inside(&s);
    vn_domain_release(domain);
    vn_domain_release(hole);
    vn_domain_release(outer);
}

static void what_no_node_sees_is_retired_and_counted(void **state) {
    (void)state;
    vn_domain *domain = NULL;
    static const double two[] = {0, 0, 4, 0, 4, 4, 0, 4, 6, 0, 10, 0, 10, 4, 6, 4};
    static const int32_t sizes[] = {4, 4};
    assert_ok(vn_domain_polygon(&domain, two, sizes, 2));
    vn_network *network = network_of(2);
    vn_attractors *attractors = attractors_of(2, 1);
    vn_influence *influence = NULL;
    setting s = {.domain = domain, .length = 0.3, .kill = 0.4};
    put_root(network, 1, 1, 0);
    put_attractor(attractors, 8, 2, 0);
    put_attractor(attractors, 9, 3, 0);
    put_attractor(attractors, 3, 3, 0);
    for (int step = 0; step < 60; step++) {
        one_step(network, attractors, &influence, &s);
    }
    assert_int_equal(vn_attractors_count(attractors), 0);
    assert_int_equal(vn_attractors_retired(attractors).hidden, 2);
    assert_int_equal(vn_attractors_retired(attractors).circled, 0);
    vn_influence_destroy(influence);
    vn_attractors_destroy(attractors);
    vn_network_destroy(network);
    vn_domain_release(domain);
}

// New sources are thrown against old nodes, step by step, while the margin moves.
static void a_growing_blade_keeps_its_laws(void **state) {
    (void)state;
    vn_domain *shape = maple_shape();
    vn_growth_def def = vn_growth_def_default();
    vn_growth *growth = NULL;
    def.domain = shape;
    def.has_origin = true;
    def.step = 0.4;
    assert_ok(vn_growth_marginal(&growth, &def));
    vn_network *network = network_of(2);
    vn_attractors *attractors = attractors_of(2, 1);
    vn_influence *influence = NULL;
    vn_rng rng = vn_rng_make(21);
    setting s = {.domain = vn_growth_domain(growth), .length = 0.2, .kill = 0.35};
    vn_throw_def throw = {
        .domain = s.domain, .density = 3, .spacing = 0.2, .clearance = 0.35, .network = network, .rng = &rng};
    int32_t accepted, done, idle = 0;
    put_root(network, 0.01, 0.01, 0);
    for (int step = 0; step < 800 && idle < 30; step++) {
        assert_ok(vn_throw(attractors, &throw, &accepted));
        assert_none_in_reach(attractors, network, 0.35);
        done = one_step(network, attractors, &influence, &s);
        idle = advance(growth) || done > 0 ? 0 : idle + 1;
    }
    assert_int_equal(vn_attractors_count(attractors), 0);
    assert_int_equal(vn_attractors_dormant(attractors), 0);
    assert_true(vn_network_count(network) > 100);
    vn_influence_destroy(influence);
    vn_attractors_destroy(attractors);
    vn_network_destroy(network);
    vn_growth_release(growth);
    vn_domain_release(shape);
}

static void a_root_on_the_border_grows(void **state) {
    (void)state;
    vn_domain *domain = box_of(0, 0, 10, 10);
    vn_network *network = network_of(2);
    vn_attractors *attractors = attractors_of(2, 1);
    vn_influence *influence = NULL;
    vn_influence_def find = vn_influence_def_default();
    vn_extend_def extend = {.length = 1, .domain = domain};
    int32_t added, first;
    put_root(network, 5, 0, 0);
    put_attractor(attractors, 5, 5, 0);
    assert_ok(vn_influence_find(&influence, attractors, network, &find));
    assert_ok(vn_extend(network, influence, &extend, &added, &first));
    assert_int_equal(added, 1);
    vn_influence_destroy(influence);
    vn_attractors_destroy(attractors);
    vn_network_destroy(network);
    vn_domain_release(domain);
}

// The tolerance for roots on the border is not one for what grows.
static void no_node_steps_over_the_border(void **state) {
    (void)state;
    vn_domain *domain = box_of(0, 0, 10, 10);
    vn_network *network = network_of(2);
    vn_attractors *attractors = attractors_of(2, 1);
    vn_influence *influence = NULL;
    setting s = {.domain = domain, .length = 5.000001, .kill = 0.01};
    put_root(network, 5, 5, 0);
    put_attractor(attractors, 5, 9.9, 0);
    one_step(network, attractors, &influence, &s);
    vn_influence_destroy(influence);
    vn_attractors_destroy(attractors);
    vn_network_destroy(network);
    vn_domain_release(domain);
}

// ---- Threads and memory ----

typedef struct run {
    vn_domain *a, *b, *domain;
    vn_network *network;
    vn_attractors *attractors, *eaten;
    vn_influence *influence;
    int32_t darts, steps;
    uint64_t hash;
} run;

static vn_status run_begin(run *r) {
    static const double square[] = {-5, -5, 5, -5, 5, 5, -5, 5}, notch[] = {-1, -1, 7, -1, 7, 1, -1, 1};
    static const int32_t four = 4;
    vn_network_def network = vn_network_def_default();
    vn_attractors_def attractors = vn_attractors_def_default();
    vn_murray_def law = vn_murray_def_default();
    double root[3] = {4, 4, 0};
    VN_TRY(vn_domain_polygon(&r->a, square, &four, 1));
    VN_TRY(vn_domain_polygon(&r->b, notch, &four, 1));
    VN_TRY(vn_domain_combine(&r->domain, r->a, r->b, VN_DIFFERENCE));
    VN_TRY(vn_network_create(&r->network, &network));
    VN_TRY(vn_network_murray(r->network, &law));
    VN_TRY(vn_network_root(r->network, root, NULL));
    VN_TRY(vn_attractors_create(&r->attractors, &attractors));
    return vn_attractors_create(&r->eaten, &attractors);
}

static vn_status run_steps(run *r, double size) {
    vn_rng rng = vn_rng_make(6);
    vn_throw_def throw = {.domain = r->domain,
                          .count = r->darts,
                          .spacing = 0.5 * size,
                          .clearance = size,
                          .network = r->network,
                          .rng = &rng};
    vn_influence_def find = vn_influence_def_default();
    vn_extend_def extend = {.length = size, .domain = r->domain};
    vn_consume_def consume = {.distance = 1.2 * size, .into = r->eaten};
    int32_t n, first;
    for (int step = 0; step < r->steps; step++) {
        if (step % 8 == 0) {
            VN_TRY(vn_throw(r->attractors, &throw, &n));
        }
        VN_TRY(vn_influence_find(&r->influence, r->attractors, r->network, &find));
        VN_TRY(vn_extend(r->network, r->influence, &extend, &n, &first));
        VN_TRY(vn_consume(r->attractors, r->network, &consume, &n));
    }
    vn_network_measures measures;
    VN_TRY(vn_network_measure(r->network, &measures));
    return vn_network_set_orders(r->network, VN_HORTON);
}

static vn_status whole_run(run *r, double size) {
    vn_status status = run_begin(r);
    status = status == VN_OK ? run_steps(r, size) : status;
    if (status == VN_OK) {
        r->hash = network_hash(r->network) ^ (uint64_t)vn_attractors_count(r->eaten);
    }
    vn_influence_destroy(r->influence);
    vn_attractors_destroy(r->attractors);
    vn_attractors_destroy(r->eaten);
    vn_network_destroy(r->network);
    vn_domain_release(r->domain);
    vn_domain_release(r->a);
    vn_domain_release(r->b);
    return status;
}

static void a_run_does_not_depend_on_threads(void **state) {
    (void)state;
    static const int threads[3] = {1, 2, 8};
    uint64_t hashes[3];
    for (int k = 0; k < 3; k++) {
        run r = {.darts = 2500, .steps = 40};
        vn_set_threads(threads[k]);
        assert_ok(whole_run(&r, 0.12));
        hashes[k] = r.hash;
    }
    vn_set_threads(0);
    assert_true(hashes[0] == hashes[1] && hashes[0] == hashes[2]);
}

static void every_allocation_may_fail(void **state) {
    (void)state;
    size_t before = vn_byte_count();
    vn_status status = VN_NO_MEMORY;
    run undisturbed = {.darts = 60, .steps = 12};
    int64_t n = 0;
    assert_ok(whole_run(&undisturbed, 0.7));
    for (; status != VN_OK; n++) {
        run r = {.darts = 60, .steps = 12};
        vn_fail_allocations_from(n);
        status = whole_run(&r, 0.7);
        vn_fail_allocations_from(-1);
        assert_true(status == VN_OK || status == VN_NO_MEMORY);
        assert_true(vn_byte_count() == before);
        assert_true(status != VN_OK || r.hash == undisturbed.hash);
        assert_true(n < 5000);
    }
    assert_true(n > 50);
}

static vn_status blade_run(vn_domain *shape) {
    vn_growth_def def = {.domain = shape};
    vn_growth *growth = NULL;
    vn_attractors *attractors = NULL;
    vn_attractors_def set = vn_attractors_def_default();
    vn_rng rng = vn_rng_make(5);
    int32_t n;
    vn_status status = vn_growth_marginal(&growth, &def);
    status = status == VN_OK ? vn_attractors_create(&attractors, &set) : status;
    for (int step = 0; status == VN_OK && step < 5; step++) {
        vn_throw_def throw = {.domain = vn_growth_domain(growth), .count = 80, .spacing = 0.1, .rng = &rng};
        status = vn_throw(attractors, &throw, &n);
        advance(growth);
    }
    vn_attractors_destroy(attractors);
    vn_growth_release(growth);
    return status;
}

static void every_allocation_of_a_blade_may_fail(void **state) {
    (void)state;
    vn_domain *shape = disk_of(0, 0, 4);
    size_t before = vn_byte_count();
    vn_status status = VN_NO_MEMORY;
    for (int64_t n = 0; status != VN_OK; n++) {
        vn_fail_allocations_from(n);
        status = blade_run(shape);
        vn_fail_allocations_from(-1);
        assert_true(status == VN_OK || status == VN_NO_MEMORY);
        assert_true(vn_byte_count() == before);
        assert_true(n < 5000);
    }
    vn_domain_release(shape);
}

static void a_failure_leaves_the_counts_at_zero(void **state) {
    (void)state;
    vn_domain *domain = box_of(0, 0, 1, 1);
    vn_attractors *attractors = attractors_of(2, 0);
    vn_rng rng = vn_rng_make(1);
    vn_throw_def throw = {.domain = domain, .count = 500, .rng = &rng};
    for (int64_t n = 0; n < 12; n++) {
        int32_t accepted = 7;
        vn_fail_allocations_from(n);
        vn_status status = vn_throw(attractors, &throw, &accepted);
        vn_fail_allocations_from(-1);
        assert_true(status == VN_OK || accepted == 0);
    }
    vn_attractors_destroy(attractors);
    vn_domain_release(domain);
}

// A set that ran out of memory once goes on as if it had not.
static void a_sync_that_failed_is_made_up_for(void **state) {
    (void)state;
    uint64_t hashes[2];
    for (int k = 0; k < 2; k++) {
        vn_network *network = network_of(2);
        vn_attractors *attractors = attractors_of(2, 4);
        vn_influence *influence = NULL;
        vn_rng rng = vn_rng_make(2);
        setting s = {.length = 0.3, .kill = 0.4};
        vn_influence_def find = vn_influence_def_default();
        put_root(network, 0, 0, 0);
        for (int step = 0; step < 40; step++) {
            for (int i = 0; step % 5 == 0 && i < 30; i++) {
                put_attractor(attractors, uniform(&rng, -5, 5), uniform(&rng, -5, 5), 0);
            }
            for (int64_t n = 0; k == 1 && n < 3; n++) {
                vn_fail_allocations_from(n);
                vn_influence_find(&influence, attractors, network, &find);
                vn_fail_allocations_from(-1);
            }
            one_step(network, attractors, &influence, &s);
        }
        hashes[k] = network_hash(network);
        vn_influence_destroy(influence);
        vn_attractors_destroy(attractors);
        vn_network_destroy(network);
    }
    assert_true(hashes[0] == hashes[1]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(darts_keep_their_distances_and_stay_inside),
        counted_test(darts_are_accepted_one_after_another),
        counted_test(a_fraction_of_a_dart_is_carried_on),
        counted_test(darts_do_not_depend_on_threads),
        counted_test(a_domain_that_no_dart_hits_is_infeasible),
        counted_test(a_throw_that_makes_no_sense_is_refused),
        counted_test(a_margin_releases_what_it_passes),
        counted_test(veins_stay_inside_concave_shapes_and_every_run_ends),
        counted_test(veins_stay_inside_combinations),
        counted_test(what_no_node_sees_is_retired_and_counted),
        counted_test(a_growing_blade_keeps_its_laws),
        counted_test(a_root_on_the_border_grows),
        counted_test(no_node_steps_over_the_border),
        counted_test(a_run_does_not_depend_on_threads),
        counted_test(every_allocation_may_fail),
        counted_test(every_allocation_of_a_blade_may_fail),
        counted_test(a_failure_leaves_the_counts_at_zero),
        counted_test(a_sync_that_failed_is_made_up_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
