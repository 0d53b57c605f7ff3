// Vessels (Rauch & Harders 2021, section 3) against slow, obvious ones, and the golden values of READINGS.
#include "vessels_support.h"

// ---- What a node perceives, from the paper's words ----

static int children_of(const vn_network *net, int32_t node, int32_t *child) {
    int count = 0;
    for (int32_t c = vn_network_first_child(net, node); c >= 0; c = vn_network_next_child(net, c)) {
        *child = c;
        count++;
    }
    return count;
}

static int tips_of(const vn_network *net, int32_t node) {
    int tips = 0;
    for (int32_t c = vn_network_first_child(net, node); c >= 0; c = vn_network_next_child(net, c)) {
        tips += tips_of(net, c);
    }
    return tips > 0 ? tips : 1;
}

static bool may_grow(const vn_network *net, int32_t node, bool lateral) {
    int32_t child;
    int count = children_of(net, node, &child);
    return count == 0 || (lateral && count == 1 && vn_network_parent(net)[node] >= 0);
}

// 1: perceived, 0: not, -1: too near to the border of the zone to say.
static int perceives(const vn_network *net, int32_t node, const double at[3], double gamma, double kappa) {
    int32_t parent = vn_network_parent(net)[node], child;
    double p[3], q[3], e[3], d[3];
    if (parent < 0) {
        return 1;
    }
    place(net, parent, p);
    place(net, node, q);
    for (int k = 0; k < 3; k++) {
        e[k] = q[k] - p[k];
        d[k] = at[k] - q[k];
    }
    double theta = angle_between(e, d), alpha = 0;
    if (children_of(net, node, &child) == 1) {
        alpha = branch_angle(pow(tips_of(net, child), 1 / kappa), 1, kappa);
    }
    double off = fabs(theta - alpha) - gamma / 2;
    return fabs(off) < 1e-5 ? -1 : off < 0;
}

typedef struct rules {
    double gamma, kappa, within, consume;
    bool lateral;
    uint64_t seed;
} rules;

// The nearest node that may grow; of equally near ones the first-ranked.
static int32_t nearest_grower(const vn_network *net, const double at[3], int32_t id, const rules *r) {
    int32_t best = -1;
    double best2 = r->within * r->within;
    for (int32_t v = 0; v < vn_network_count(net); v++) {
        double p[3];
        place(net, v, p);
        double d2 = vn_distance2(at, p);
        bool nearer =
            d2 < best2 || (d2 == best2 && (best < 0 || vn_ranks_before(r->seed, (uint64_t)id, v, best)));
        if (nearer && may_grow(net, v, r->lateral)) {
            best = v;
            best2 = d2;
        }
    }
    return best;
}

static double nearest_any(const vn_network *net, const double at[3]) {
    double best = INFINITY;
    for (int32_t v = 0; v < vn_network_count(net); v++) {
        double p[3];
        place(net, v, p);
        best = fmin(best, sqrt(vn_distance2(at, p)));
    }
    return best;
}

static int32_t id_of(vn_attractors *a, int32_t index) {
    int32_t internal;
    assert_ok(vn_attractors_number(a, index, &internal));
    return (int32_t)a->id.data[internal];
}

static void check_influence(vn_attractors *a, const vn_network *net, const vn_influence *f, const rules *r) {
    int32_t pair = 0;
    for (int32_t i = 0; i < vn_attractors_count(a); i++) {
        double at[3];
        assert_ok(vn_attractors_position(a, i, at));
        int32_t node = nearest_grower(net, at, id_of(a, i), r);
        int expected = node >= 0 ? perceives(net, node, at, r->gamma, r->kappa) : 0;
        bool listed = pair < vn_influence_count(f) && vn_influence_attractor(f, pair) == i;
        if (expected >= 0) {
            assert_int_equal(listed, expected);
        }
        if (listed) {
            assert_int_equal(vn_influence_node(f, pair), node);
            pair++;
        }
    }
    assert_int_equal(pair, vn_influence_count(f));
}

static int32_t count_reached(vn_attractors *a, const vn_network *net, double distance) {
    int32_t reached = 0;
    for (int32_t i = 0; i < vn_attractors_count(a); i++) {
        double at[3];
        assert_ok(vn_attractors_position(a, i, at));
        reached += nearest_any(net, at) < distance;
    }
    return reached;
}

static void check_left(vn_attractors *a, const vn_network *net, double distance) {
    assert_int_equal(count_reached(a, net, distance), 0);
}

typedef struct garden {
    vn_network *net;
    vn_attractors *a;
    vn_influence *f;
    vn_domain *domain;
    vn_rng rng;
    rules r;
    vn_extend_def grow;
} garden;

static garden garden_of(int dim, uint64_t seed) {
    garden g = {.rng = vn_rng_make(seed)};
    g.net = network_of(dim);
    g.a = attractors_of(dim, (int64_t)seed);
    g.domain = dim == 2 ? disk_of(0, 0, 1) : ball_of(0, 0, 0, 1);
    g.r = (rules){.gamma = uniform(&g.rng, 20, 200),
                  .kappa = uniform(&g.rng, 2.05, 4),
                  .within = uniform(&g.rng, 0.3, 0.8),
                  .lateral = whole(&g.rng, 0, 3) > 0,
                  .seed = seed};
    g.r.consume = uniform(&g.rng, 0.05, 0.15);
    g.grow = vn_extend_def_default();
    g.grow.length = uniform(&g.rng, 0.05, 0.15);
    g.grow.bias = uniform(&g.rng, 0, 1);
    g.grow.bias_mean = whole(&g.rng, 0, 1) > 0;
    g.grow.bifurcate = whole(&g.rng, 0, 2) > 0 ? uniform(&g.rng, 0.1, 40) : 0;
    g.grow.domain = whole(&g.rng, 0, 1) > 0 ? g.domain : NULL;
    vn_murray_def law = {.exponent = g.r.kappa, .tip_radius = 0.01};
    assert_ok(vn_network_murray(g.net, &law));
    for (int64_t roots = whole(&g.rng, 1, 3); roots > 0; roots--) {
        put_root(g.net, uniform(&g.rng, -0.5, 0.5), uniform(&g.rng, -0.5, 0.5), 0);
    }
    return g;
}

static void end_garden(garden *g) {
    vn_influence_destroy(g->f);
    vn_attractors_destroy(g->a);
    vn_network_destroy(g->net);
    vn_domain_release(g->domain);
}

static void influence(garden *g) {
    vn_influence_def def = vn_influence_def_default();
    def.within = g->r.within;
    def.perception = (vn_perception){g->r.gamma, g->r.lateral};
    assert_ok(vn_influence_find(&g->f, g->a, g->net, &def));
}

static void throw_some(garden *g, double unit) {
    vn_throw_def def = vn_throw_def_default();
    int32_t accepted;
    def.domain = g->domain;
    def.count = 60;
    def.spacing = 0.1 * unit;
    def.clearance = g->r.consume * (g->r.seed % 2 ? 1.3 : 0.5);
    def.network = g->net;
    def.rng = &g->rng;
    assert_ok(vn_throw(g->a, &def, &accepted));
}

static void consume(garden *g) {
    vn_consume_def def = vn_consume_def_default();
    int32_t consumed, expected = count_reached(g->a, g->net, g->r.consume);
    def.distance = g->r.consume;
    assert_ok(vn_consume(g->a, g->net, &def, &consumed));
    assert_int_equal(consumed, expected);
    check_left(g->a, g->net, g->r.consume);
}

// One step of a tissue that grows by a tenth; now and then sight widens again.
static void step_garden(garden *g, int step) {
    double shrink = 1 / (1 + 0.1 / (1 + 0.1 * step));
    double change = step % 7 == 6 ? 1.5 : shrink;
    int32_t added, first;
    g->r.within *= change;
    g->r.consume *= shrink;
    g->grow.length *= shrink;
    throw_some(g, 1 / (1 + 0.1 * step));
    influence(g);
    check_influence(g->a, g->net, g->f, &g->r);
    assert_ok(vn_extend(g->net, g->f, &g->grow, &added, &first));
    consume(g);
}

static void test_influence_of_random_vessels(void **state) {
    (void)state;
    for (uint64_t seed = 1; seed <= 24; seed++) {
        garden g = garden_of(seed % 3 == 0 ? 3 : 2, seed);
        for (int step = 0; step < 25; step++) {
            step_garden(&g, step);
        }
        assert_true(vn_network_count(g.net) > 10);
        end_garden(&g);
    }
}

// Drains on a lattice, equally far from many nodes that lie on it too.
static void test_influence_on_a_lattice(void **state) {
    (void)state;
    for (uint64_t seed = 1; seed <= 8; seed++) {
        garden g = garden_of(2, seed);
        g.grow.domain = NULL;
        g.grow.length = 0.125;
        g.r.consume = 0.1;
        for (int i = -8; i <= 8; i++) {
            for (int j = -8; j <= 8; j++) {
                put_attractor(g.a, 0.125 * i, 0.125 * j, 0);
            }
        }
        put_root(g.net, 0, 0, 0);
        for (int step = 0; step < 20; step++) {
            int32_t added, first;
            influence(&g);
            check_influence(g.a, g.net, g.f, &g.r);
            assert_ok(vn_extend(g.net, g.f, &g.grow, &added, &first));
            consume(&g);
        }
        end_garden(&g);
    }
}

// ---- Laws ----

static bool is_fork(const vn_network *net, int32_t node, int32_t first) {
    int count = 0;
    for (int32_t c = vn_network_first_child(net, node); c >= 0; c = vn_network_next_child(net, c)) {
        count += c >= first;
    }
    return count == 2;
}

static void check_direction(const vn_network *net, int32_t node, int32_t first, double kappa,
                            const vn_zone_shape *zone, double gamma) {
    int32_t parent = vn_network_parent(net)[node];
    double p[3], q[3], d[3];
    place(net, parent, p);
    place(net, node, q);
    for (int k = 0; k < 3; k++) {
        d[k] = q[k] - p[k];
    }
    double theta = zone->kind == VN_ZONE_BALL ? 0 : angle_between(zone->direction, d);
    if (is_fork(net, parent, first)) {
        double pair[2][3];
        int32_t sister = vn_network_next_child(net, vn_network_first_child(net, parent));
        place(net, vn_network_first_child(net, parent), pair[0]);
        place(net, sister, pair[1]);
        for (int k = 0; k < 3; k++) {
            pair[0][k] -= p[k];
            pair[1][k] -= p[k];
        }
        assert_near(angle_between(pair[0], pair[1]), 2 * acos(pow(2, 2 / kappa - 1)) * DEGREES, 1e-5);
    } else if (zone->kind != VN_ZONE_BALL) {
        assert_true(theta >= zone->angle - gamma / 2 - 1e-4 && theta <= zone->angle + gamma / 2 + 1e-4);
    }
}

static void test_directions_are_allowed(void **state) {
    (void)state;
    int32_t forks = 0, laterals = 0;
    for (uint64_t seed = 31; seed < 43; seed++) {
        garden g = garden_of(seed % 2 == 0 ? 3 : 2, seed);
        for (int step = 0; step < 20; step++) {
            static vn_zone_shape zones[20000];
            vn_perception perception = {g.r.gamma, g.r.lateral};
            int32_t added, first;
            throw_some(&g, 1);
            influence(&g);
            for (int32_t node = 0; node < vn_network_count(g.net); node++) {
                assert_ok(vn_network_zone(g.net, node, &perception, &zones[node]));
            }
            assert_ok(vn_extend(g.net, g.f, &g.grow, &added, &first));
            for (int32_t node = first; node < first + added; node++) {
                int32_t parent = vn_network_parent(g.net)[node];
                check_direction(g.net, node, first, g.r.kappa, &zones[parent], g.r.gamma);
                forks += is_fork(g.net, parent, first);
                laterals += zones[parent].kind == VN_ZONE_BELT;
            }
            consume(&g);
        }
        end_garden(&g);
    }
    assert_true(forks > 50 && laterals > 50);
}

static void test_radii_stay_murrays(void **state) {
    (void)state;
    for (uint64_t seed = 51; seed < 57; seed++) {
        garden g = garden_of(2 + (int)(seed % 2), seed);
        for (int step = 0; step < 30; step++) {
            step_garden(&g, step);
            vn_network_radius(g.net, 0); // counts are carried up in some steps, and pile up in others
            for (int32_t node = 0; step % 3 == 0 && node < vn_network_count(g.net); node++) {
                double sum = 0, r = vn_network_radius(g.net, node);
                for (int32_t c = vn_network_first_child(g.net, node); c >= 0;
                     c = vn_network_next_child(g.net, c)) {
                    sum += pow(vn_network_radius(g.net, c), g.r.kappa);
                }
                if (sum > 0 && vn_network_parent(g.net)[node] >= 0) {
                    assert_near(pow(r, g.r.kappa) / sum, 1, 1e-9);
                    assert_near(r, 0.01 * pow(tips_of(g.net, node), 1 / g.r.kappa), 1e-12);
                }
            }
        }
        end_garden(&g);
    }
}

// ---- Darts ----

// Each dart in turn, against everybody.
static int32_t throw_slowly(const garden *g, vn_rng rng, const vn_throw_def *def, double (*at)[3],
                            int32_t count) {
    vn_rng volley = vn_rng_fork(&rng);
    int32_t first = count;
    for (int32_t k = 0; k < def->count; k++) {
        vn_rng own = {.seed = volley.seed, .stream = vn_hash(volley.seed, volley.stream, (uint64_t)k, 2)};
        double p[3];
        assert_ok(vn_domain_dart(g->domain, &own, p));
        bool sticks = nearest_any(g->net, p) > def->clearance;
        for (int32_t i = 0; i < count; i++) {
            sticks = sticks && sqrt(vn_distance2(at[i], p)) > def->spacing;
        }
        if (sticks) {
            memcpy(at[count++], p, sizeof p);
        }
    }
    return count - first;
}

// Short cuts, as clearances shrink and nodes come: the same darts stick.
static void test_darts_stick_where_they_should(void **state) {
    (void)state;
    static double at[6000][3];
    for (uint64_t seed = 71; seed < 79; seed++) {
        garden g = garden_of(2 + (int)(seed % 2), seed);
        for (int step = 0; step < 16; step++) {
            vn_throw_def def = vn_throw_def_default();
            int32_t accepted, count = vn_attractors_count(g.a);
            def.domain = g.domain;
            def.count = 300;
            def.spacing = 0.12 / (1 + 0.1 * step);
            def.clearance = (step % 5 == 4 ? 0.3 : 0.2) / (1 + 0.1 * step);
            def.network = g.net;
            def.rng = &g.rng;
            for (int32_t i = 0; i < count; i++) {
                assert_ok(vn_attractors_position(g.a, i, at[i]));
            }
            int32_t expected = throw_slowly(&g, g.rng, &def, at, count);
            assert_ok(vn_throw(g.a, &def, &accepted));
            assert_int_equal(accepted, expected);
            for (int32_t i = 0; i < accepted; i++) {
                double p[3];
                assert_ok(vn_attractors_position(g.a, count + i, p));
                assert_memory_equal(p, at[count + i], sizeof p);
            }
            influence(&g);
            assert_ok(vn_extend(g.net, g.f, &g.grow, &accepted, &count));
            consume(&g);
        }
        end_garden(&g);
    }
}

// ---- Growth of the tissue ----

// What the step makes of everything scaled by @p sigma, with lengths that stay.
static vn_network *step_scaled(const garden *g, double sigma, const vn_influence_def *see,
                               const vn_extend_def *grow) {
    vn_network *net = vessel_of(2, g->r.kappa);
    vn_attractors *a = attractors_of(2, (int64_t)g->r.seed);
    vn_influence *f = NULL;
    int32_t added, first;
    for (int32_t i = 0; i < vn_network_count(g->net); i++) {
        double p[3];
        place(g->net, i, p);
        int32_t parent = vn_network_parent(g->net)[i];
        if (parent < 0) {
            put_root(net, sigma * p[0], sigma * p[1], 0);
        } else {
            put_child(net, parent, sigma * p[0], sigma * p[1], 0);
        }
    }
    for (int32_t i = 0; i < vn_attractors_count(g->a); i++) {
        double p[3];
        assert_ok(vn_attractors_position(g->a, i, p));
        put_attractor(a, sigma * p[0], sigma * p[1], 0);
    }
    assert_ok(vn_influence_find(&f, a, net, see));
    assert_ok(vn_extend(net, f, grow, &added, &first));
    vn_influence_destroy(f);
    vn_attractors_destroy(a);
    return net;
}

// λ_t = λ_0 σ_0 / σ_t: lengths that shrink in a tissue that stays do what lengths do that stay in one that
// grows.
static void test_relative_growth_is_growth(void **state) {
    (void)state;
    for (uint64_t seed = 61; seed < 67; seed++) {
        garden g = garden_of(2, seed);
        g.grow.domain = NULL;
        double within = g.r.within, length = g.grow.length, reach = g.r.consume;
        for (int step = 0; step < 18; step++) {
            double sigma = 1 + 0.1 * step;
            vn_influence_def see = vn_influence_def_default();
            vn_extend_def grow = g.grow;
            int32_t added, first;
            g.r.within = within / sigma;
            g.grow.length = length / sigma;
            g.r.consume = reach / sigma;
            see.within = within;
            see.perception = (vn_perception){g.r.gamma, g.r.lateral};
            grow.length = length;
            throw_some(&g, 1 / sigma);
            vn_network *scaled = step_scaled(&g, sigma, &see, &grow);
            influence(&g);
            assert_ok(vn_extend(g.net, g.f, &g.grow, &added, &first));
            assert_int_equal(vn_network_count(scaled), vn_network_count(g.net));
            for (int32_t i = first; i < first + added; i++) {
                assert_int_equal(vn_network_parent(scaled)[i], vn_network_parent(g.net)[i]);
                assert_near(vn_network_x(scaled)[i], sigma * vn_network_x(g.net)[i], 1e-9);
                assert_near(vn_network_y(scaled)[i], sigma * vn_network_y(g.net)[i], 1e-9);
            }
            vn_network_destroy(scaled);
            consume(&g);
        }
        end_garden(&g);
    }
}

// A throw that found no memory for its short cuts can be made again.
static void test_throws_without_memory(void **state) {
    (void)state;
    for (int64_t fails = 1; fails < 40; fails++) {
        garden g = garden_of(2, 5);
        vn_throw_def def = vn_throw_def_default();
        int32_t accepted;
        def.domain = g.domain;
        def.count = 200;
        def.spacing = 0.1;
        def.clearance = 0.1;
        def.network = g.net;
        def.rng = &g.rng;
        vn_fail_allocations_from(fails);
        vn_status status = vn_throw(g.a, &def, &accepted);
        vn_fail_allocations_from(-1);
        assert_true(status == VN_OK || status == VN_NO_MEMORY);
        assert_ok(vn_throw(g.a, &def, &accepted));
        end_garden(&g);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(test_directions_are_allowed),        counted_test(test_radii_stay_murrays),
        counted_test(test_darts_stick_where_they_should), counted_test(test_relative_growth_is_growth),
        counted_test(test_throws_without_memory),         counted_test(test_influence_of_random_vessels),
        counted_test(test_influence_on_a_lattice),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
