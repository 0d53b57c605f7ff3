// Vessels (Rauch & Harders 2021, section 3) against slow, obvious ones, and the golden values of READINGS.
#include "support.h"

static const double DEGREES = 180 / 3.14159265358979323846;

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

static void place(const vn_network *net, int32_t node, double p[3]) {
    p[0] = vn_network_x(net)[node];
    p[1] = vn_network_y(net)[node];
    p[2] = vn_network_z(net) != NULL ? vn_network_z(net)[node] : 0;
}

static double angle_between(const double a[3], const double b[3]) {
    double dot = 0, aa = 0, bb = 0;
    for (int k = 0; k < 3; k++) {
        dot += a[k] * b[k];
        aa += a[k] * a[k];
        bb += b[k] * b[k];
    }
    return acos(fmin(fmax(dot / sqrt(aa * bb), -1), 1)) * DEGREES;
}

// Equation 1 for the branch r, where the other one is l.
static double branch_angle(double l, double r, double kappa) {
    double p = pow(pow(l, kappa) + pow(r, kappa), 1 / kappa);
    return acos((pow(p, 4) - pow(l, 4) + pow(r, 4)) / (2 * p * p * r * r)) * DEGREES;
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
    g.grow.bifurcate = whole(&g.rng, 0, 2) > 0 ? uniform(&g.rng, 0, 40) : -1;
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

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(test_influence_of_random_vessels),
        counted_test(test_influence_on_a_lattice),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
