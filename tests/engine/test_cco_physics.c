// The physics of arterial trees: radii, volumes and bifurcation points against recomputation, golden cases
// and Ceres.
#include "support.h"

#include "cco/bifurcation.h"

bool ceres_oracle(const double f[3], const double l[3], const double d[2], double radius[3]);

static const double PI = 3.14159265358979323846;
static const double VISCOSITY = 3.6e-3, DROP = 5332.88, TERMINAL = 125.0 / 60;

static vn_tree tree_of(double exponent) {
    vn_tree tree = {.factor = 8 * VISCOSITY / PI / DROP};
    assert_ok(vn_array_push(&tree.exponents, ((vn_exponent){1, exponent})));
    return tree;
}

static int32_t put(vn_tree *tree, int32_t parent, double x, double y, double z) {
    int32_t node;
    assert_ok(vn_tree_push(tree, parent, (double[3]){x, y, z}, &node));
    tree->vessels.data[node].flow = TERMINAL;
    vn_tree_update(tree, node);
    return node;
}

static double radius_of(const vn_tree *tree, int32_t node) {
    return vn_tree_radius(tree, node);
}

// ---- The oracle: Equations 1 to 7, from the leaves and back, without anything that is kept ----

typedef struct physics {
    double flow, resistance, ratio, radius; // of each node's segment; the resistance with kappa in it
} physics;

static void from_below(const vn_tree *tree, int32_t node, physics *q) {
    const vn_vessel *v = tree->vessels.data;
    double kappa = 8 * VISCOSITY / PI, inverse = 0;
    q[node].flow = v[node].first_child < 0 ? v[node].flow : 0;
    for (int32_t c = v[node].first_child; c >= 0; c = v[c].next_child) {
        from_below(tree, c, q);
        q[node].flow += q[c].flow;
    }
    double exponent = vn_tree_exponent(tree, q[node].flow);
    for (int32_t c = v[node].first_child; c >= 0; c = v[c].next_child) {
        double alphas = 1;
        for (int32_t b = v[node].first_child; b >= 0; b = v[b].next_child) {
            if (b != c) { // (4), with the flow in place of L
                double alpha = pow(q[b].flow / q[c].flow * q[b].resistance / q[c].resistance, 0.25);
                alphas += pow(alpha, exponent);
            }
        }
        q[c].ratio = pow(alphas, -1 / exponent); // (3)
        inverse += pow(q[c].ratio, 4) / q[c].resistance;
    }
    double length = v[node].parent < 0 ? 0 : sqrt(vn_distance2(v[node].p, v[v[node].parent].p));
    q[node].resistance = kappa * length + (inverse > 0 ? 1 / inverse : 0); // (6)
}

static double from_above(const vn_tree *tree, int32_t node, double above, physics *q) {
    const vn_vessel *v = tree->vessels.data;
    double volume = 0;
    if (v[node].parent >= 0) {
        bool stem = v[v[node].parent].parent < 0;
        q[node].radius = stem ? pow(q[node].flow * q[node].resistance / DROP, 0.25) : above * q[node].ratio;
        volume = PI * q[node].radius * q[node].radius * sqrt(vn_distance2(v[node].p, v[v[node].parent].p));
    }
    for (int32_t c = v[node].first_child; c >= 0; c = v[c].next_child) {
        volume += from_above(tree, c, q[node].radius, q);
    }
    return volume;
}

static double oracle(const vn_tree *tree, physics *q) {
    from_below(tree, 0, q);
    return from_above(tree, 0, 0, q);
}

// The pressure at a node by Poiseuille's law, as drops from P_in.
static double drop_to(const vn_tree *tree, int32_t node, const physics *q) {
    double drop = 0;
    for (const vn_vessel *v = tree->vessels.data; v[node].parent >= 0; node = v[node].parent) {
        double length = sqrt(vn_distance2(v[node].p, v[v[node].parent].p));
        drop += 8 * VISCOSITY * length * q[node].flow / (PI * pow(q[node].radius, 4));
    }
    return drop;
}

// Connect @p terminal to the segment of @p node where that is best; the tree's volume.
static double connect(vn_tree *tree, int32_t node, const double terminal[3], double x[3]) {
    const vn_vessel *v = tree->vessels.data;
    vn_triangle t = {.flow1 = v[node].flow, .flow2 = TERMINAL};
    vn_fork rest = vn_tree_fork(tree, node, -1, NULL);
    t.rest_resistance = rest.resistance;
    t.rest_volume = rest.volume;
    t.exponent = vn_tree_exponent(tree, t.flow1 + t.flow2);
    assert_true(vn_triangle_make(&t, v[v[node].parent].p, v[node].p, terminal));
    double at[2] = {t.distal / 2, t.across[1] / 4};
    vn_effect effect;
    assert_true(vn_bifurcation_least(tree, NULL, node, &t, 1e-12, 50, at, &effect));
    vn_triangle_point(&t, at, x);
    int32_t middle;
    assert_ok(vn_tree_split(tree, node, x, &middle));
    put(tree, middle, terminal[0], terminal[1], terminal[2]);
    vn_tree_update(tree, node);
    return vn_tree_volume(tree);
}

static void golden_one_terminal(void **state) {
    (void)state;
    vn_tree tree = tree_of(3);
    put(&tree, -1, 0, 0, 0);
    put(&tree, 0, 10, 0, 0);
    assert_near(radius_of(&tree, 1), 0.0773588298, 1e-9);
    vn_tree_free(&tree);
}

static void golden_a(void **state) {
    (void)state;
    vn_tree tree = tree_of(3);
    double x[3];
    put(&tree, -1, 0, 0, 0);
    put(&tree, 0, 10, 4, 0);
    assert_near(connect(&tree, 1, (double[3]){10, -4, 0}, x), 0.397084437513, 1e-9);
    assert_near(x[0], 4.780935894, 1e-6);
    assert_near(x[1], 0, 1e-6);
    assert_near(radius_of(&tree, 2), .0983559021, 1e-8);
    assert_near(radius_of(&tree, 1), .0780651312, 1e-8);
    assert_near(radius_of(&tree, 3), .0780651312, 1e-8);
    physics q[4] = {0};
    oracle(&tree, q);
    assert_near(drop_to(&tree, 2, q), 1951.3833, 1e-3);
    assert_near(drop_to(&tree, 1, q), DROP, 1e-8);
    vn_tree_free(&tree);
}

static vn_tree tree_b(double turn, double volume) {
    vn_tree tree = tree_of(3);
    double x[3], c = cos(turn), s = sin(turn); // the same case, turned about the x axis into space
    put(&tree, -1, 0, 0, 0);
    put(&tree, 0, 10, 2 * c, 2 * s);
    assert_near(connect(&tree, 1, (double[3]){4, -5 * c, -5 * s}, x), volume, 1e-9);
    assert_near(x[0], 1.131335482, 1e-6);
    assert_near(x[1], -0.332976096 * c, 1e-6);
    assert_near(x[2], -0.332976096 * s, 1e-6);
    return tree;
}

static void golden_b(void **state) {
    (void)state;
    vn_tree tree = tree_b(0, 0.288279615932);
    assert_near(radius_of(&tree, 2), .0927521507, 1e-8);
    assert_near(radius_of(&tree, 1), .0780305135, 1e-8);
    assert_near(radius_of(&tree, 3), .0686003663, 1e-8);
    physics q[4] = {0};
    oracle(&tree, q);
    assert_near(drop_to(&tree, 2, q), 608.648667, 1e-2);
    const int32_t nodes[] = {2, 1, 3};
    const double shear[] = {23.93, 20.10, 29.58};
    for (int i = 0; i < 3; i++) {
        const physics *s = &q[nodes[i]];
        assert_near(4 * VISCOSITY * s->flow / (PI * pow(s->radius, 3)), shear[i], 0.005);
    }
    vn_tree_free(&tree);
    tree = tree_b(1.1, 0.288279615932);
    vn_tree_free(&tree);
}

// The "Kamiya" column: Equations 8 to 13 alone, (12) by our root and by Ceres.
static void golden_b_kamiya(void **state) {
    (void)state;
    vn_kamiya_fn *const solvers[] = {vn_kamiya_radii, vn_ceres_radii};
    for (int i = 0; i < 2; i++) {
        vn_tree tree = tree_of(3);
        put(&tree, -1, 0, 0, 0);
        put(&tree, 0, 10, 2, 0);
        vn_triangle t = {.flow1 = TERMINAL, .flow2 = TERMINAL, .exponent = 3};
        assert_true(vn_triangle_make(&t, (double[3]){0}, (double[3]){10, 2, 0}, (double[3]){4, -5, 0}));
        double at[2], x[3];
        vn_effect effect;
        assert_true(vn_bifurcation_kamiya(&tree, 1, &t, solvers[i], 1e-15, 500, at, &effect));
        vn_triangle_point(&t, at, x);
        assert_near(x[0], 1.133574579, 1e-6);
        assert_near(x[1], -0.333864070, 1e-6);
        assert_near(effect.radius, .0927520209, 1e-8);
        assert_near(vn_tree_volume(&tree) + effect.volume, 0.288279624586, 1e-9);
        vn_tree_free(&tree);
    }
}

static void golden_c(void **state) {
    (void)state;
    const double volume[] = {0.415602, 0.433333};
    const double where[][2] = {{6.175974, -0.506948}, {3.527699, -2.180821}};
    const int32_t node[] = {1, 3};
    for (int i = 0; i < 2; i++) {
        vn_tree tree = tree_b(0, 0.288279615932);
        double x[3];
        assert_near(connect(&tree, node[i], (double[3]){9, -3, 0}, x), volume[i], 1e-6);
        assert_near(x[0], where[i][0], 1e-5);
        assert_near(x[1], where[i][1], 1e-5);
        vn_tree_free(&tree);
    }
}

static void golden_d(void **state) {
    (void)state;
    const double at[][2] = {{0, 0}, {4, 0}, {10, 3}, {7, -2}, {11, -4}, {9, -6}};
    const int32_t parent[] = {-1, 0, 1, 1, 3, 3};
    const double exponent[] = {3, 2.55}, volume[] = {.55572975765, .55831645901};
    const double radius[][5] = {{.111282919, .076008517, .097923570, .077721989, .077721989},
                                {.115859414, .074945323, .099061907, .075484139, .075484139}};
    for (int k = 0; k < 2; k++) {
        vn_tree tree = tree_of(exponent[k]);
        for (int32_t i = 0; i < 6; i++) {
            put(&tree, parent[i], at[i][0], at[i][1], 0);
        }
        assert_near(vn_tree_volume(&tree), volume[k], 1e-10);
        for (int32_t i = 1; i < 6; i++) {
            assert_near(radius_of(&tree, i), radius[k][i - 1], 1e-9);
        }
        vn_tree_free(&tree);
    }
}

static void check_roots(const double f[3], const double l[3], const double d[2], double tolerance) {
    double fast[3], tiny[3], full[3];
    assert_true(vn_kamiya_radii(f, l, d, fast));
    assert_true(vn_ceres_radii(f, l, d, tiny));
    assert_true(ceres_oracle(f, l, d, full));
    for (int i = 0; i < 3; i++) {
        assert_near(fast[i] / full[i], 1, tolerance);
        assert_near(tiny[i] / full[i], 1, tolerance);
    }
}

static void golden_e_and_ceres(void **state) {
    (void)state;
    double radius[3];
    assert_true(vn_kamiya_radii((double[3]){3, 1, 2}, (double[3]){1, 1.3, .7}, (double[2]){1, 1.1}, radius));
    assert_near(radius[0], 1.5927315471, 1e-9);
    assert_near(radius[1], 1.2492131173, 1e-9);
    assert_near(radius[2], 1.2191019489, 1e-9);
    assert_false(vn_kamiya_radii((double[3]){3, 1, 2}, (double[3]){1, 1, 1}, (double[2]){0, 1}, radius));
    vn_rng rng = vn_rng_make(5);
    for (int i = 0; i < 300; i++) {
        double f[3], l[3], d[2];
        for (int k = 1; k < 3; k++) {
            f[k] = exp(uniform(&rng, -3, 8));
            l[k] = exp(uniform(&rng, -3, 3));
            d[k - 1] = exp(uniform(&rng, 2, 8));
        }
        f[0] = f[1] + f[2];
        l[0] = exp(uniform(&rng, -3, 3));
        check_roots(f, l, d, 1e-9);
    }
}

// A tree of random shape: binary where chains and forks of three are not asked for.
static vn_tree random_cco(double exponent, int32_t terminals, bool wild, int dim, vn_rng *rng) {
    vn_tree tree = tree_of(exponent);
    put(&tree, -1, 0, 0, 0);
    put(&tree, 0, 1, uniform(rng, 0, 1), 0);
    for (int32_t i = 1; i < terminals; i++) {
        int32_t node = (int32_t)whole(rng, 1, tree.vessels.count - 1), middle;
        double p[3] = {uniform(rng, -9, 9), uniform(rng, -9, 9), dim == 3 ? uniform(rng, -9, 9) : 0};
        double q[3] = {uniform(rng, -9, 9), uniform(rng, -9, 9), dim == 3 ? uniform(rng, -9, 9) : 0};
        if (!wild || whole(rng, 0, 3) > 0) {
            assert_ok(vn_tree_split(&tree, node, p, &middle));
            vn_tree_update(&tree, node);
            node = middle;
        }
        int32_t leaf = put(&tree, node, q[0], q[1], q[2]);
        tree.vessels.data[leaf].flow = wild ? uniform(rng, 0.1, 9) : TERMINAL;
        vn_tree_update(&tree, leaf);
    }
    return tree;
}

static void kept_values_are_those_recomputed(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(11);
    for (int i = 0; i < 60; i++) {
        const double exponents[] = {3, 2.55, 2.1};
        vn_tree tree = random_cco(exponents[i % 3], 1 + i, i % 2 == 1, 2 + i % 2, &rng);
        physics q[300] = {0};
        double volume = oracle(&tree, q);
        assert_near(vn_tree_volume(&tree) / volume, 1, 1e-9);
        for (int32_t n = 1; n < tree.vessels.count; n++) {
            assert_near(vn_tree_radius(&tree, n) / q[n].radius, 1, 1e-9);
            if (tree.vessels.data[n].first_child < 0) {
                assert_near(drop_to(&tree, n, q) / DROP, 1, 1e-9);
            }
        }
        vn_tree_free(&tree);
    }
}

static vn_triangle triangle_at(const vn_tree *tree, int32_t node, const double terminal[3]) {
    const vn_vessel *v = tree->vessels.data;
    vn_triangle t = {.flow1 = v[node].flow, .flow2 = TERMINAL};
    vn_fork rest = vn_tree_fork(tree, node, -1, NULL);
    t.rest_resistance = rest.resistance;
    t.rest_volume = rest.volume;
    t.exponent = vn_tree_exponent(tree, t.flow1 + t.flow2);
    assert_true(vn_triangle_make(&t, v[v[node].parent].p, v[node].p, terminal));
    return t;
}

// The tree with the bifurcation put in, and its volume recomputed.
static double volume_with(const vn_tree *tree, int32_t node, const vn_triangle *t, const double at[2],
                          const double terminal[3], double *radius) {
    vn_tree copy = {.factor = tree->factor};
    double x[3];
    int32_t middle;
    assert_ok(vn_array_push(&copy.exponents, tree->exponents.data[0]));
    for (int32_t i = 0; i < tree->vessels.count; i++) {
        assert_ok(vn_array_push(&copy.vessels, tree->vessels.data[i]));
    }
    vn_triangle_point(t, at, x);
    assert_ok(vn_tree_split(&copy, node, x, &middle));
    put(&copy, middle, terminal[0], terminal[1], terminal[2]);
    physics *q = calloc((size_t)copy.vessels.count, sizeof *q);
    double volume = oracle(&copy, q);
    *radius = q[middle].radius;
    free(q);
    vn_tree_free(&copy);
    return volume;
}

static void the_effect_of_a_candidate(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(12);
    for (int i = 0; i < 200; i++) {
        vn_tree tree = random_cco(i % 3 == 0 ? 2.55 : 3, 2 + i % 40, i % 4 == 3, 2 + i % 2, &rng);
        int32_t node = (int32_t)whole(&rng, 1, tree.vessels.count - 1);
        double terminal[3] = {uniform(&rng, -9, 9), uniform(&rng, -9, 9), 0}, radius, other;
        vn_triangle t = triangle_at(&tree, node, terminal);
        double at[2] = {t.distal * 0.4, t.across[1] * 0.2}, before = vn_tree_volume(&tree);
        vn_branch b[3];
        vn_triangle_branches(&t, at, b);
        vn_effect e = vn_tree_effect(&tree, node, &b[0]);
        double after = volume_with(&tree, node, &t, at, terminal, &radius);
        assert_near((before + e.volume) / after, 1, 1e-9);
        assert_near(e.radius / radius, 1, 1e-9);
        for (int k = 0; k < 2; k++) { // its derivatives against differences
            vn_branch more = b[0], less = b[0];
            double step = 1e-5 * b[0].resistance;
            *(k == 0 ? &more.resistance : &more.volume) += step;
            *(k == 0 ? &less.resistance : &less.volume) -= step;
            double by =
                (vn_tree_effect(&tree, node, &more).volume - vn_tree_effect(&tree, node, &less).volume) /
                (2 * step);
            other = k == 0 ? e.by_resistance : e.by_volume;
            assert_near(other, by, 1e-5 * (fabs(by) + e.by_volume));
        }
        vn_tree_free(&tree);
    }
}

// No point around it, near or far, gives less; where the search gives up, a corner of the triangle does.
static void the_point_is_of_least_volume(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(13);
    int found = 0;
    for (int i = 0; i < 200; i++) {
        vn_tree tree = random_cco(i % 3 == 0 ? 2.55 : 3, 2 + i % 30, false, 2 + i % 2, &rng);
        int32_t node = (int32_t)whole(&rng, 1, tree.vessels.count - 1);
        double terminal[3] = {uniform(&rng, -9, 9), uniform(&rng, -9, 9), uniform(&rng, -9, 9)}, radius;
        vn_triangle t = triangle_at(&tree, node, terminal);
        double at[2] = {t.distal / 2, t.across[1] / 8};
        vn_effect e;
        bool inner = vn_bifurcation_least(&tree, NULL, node, &t, 1e-10, 30, at, &e);
        found += inner;
        double least = INFINITY, best[2] = {0, 0};
        double size = t.distal + t.across[1];
        for (int k = 0; k < 400; k++) { // inside the triangle
            double u = uniform(&rng, 0, 1), w = uniform(&rng, 0, 1);
            double a = u + w > 1 ? 1 - u : u, b = u + w > 1 ? 1 - w : w;
            double near[2] = {at[0] + 1e-3 * size * (a - 0.5), at[1] + 1e-3 * size * (b - 0.5)};
            double far[2] = {a * t.distal + b * t.across[0], b * t.across[1]};
            double volume = volume_with(&tree, node, &t, inner && k % 2 ? near : far, terminal, &radius);
            memcpy(best, volume < least ? (inner && k % 2 ? near : far) : best, sizeof best);
            least = fmin(least, volume);
        }
        if (inner) {
            assert_true(vn_tree_volume(&tree) + e.volume <= least * (1 + 1e-12));
        } else {
            double lengths[3];
            vn_triangle_lengths(&t, best, lengths);
            assert_true(fmin(lengths[0], fmin(lengths[1], lengths[2])) < 0.35 * size);
        }
        vn_tree_free(&tree);
    }
    assert_true(found > 80);
}

static void scaling(void **state) {
    (void)state;
    for (int k = 0; k < 2; k++) {
        double s = k == 0 ? 7 : 1e-3, x[3];
        vn_tree tree = tree_of(3);
        put(&tree, -1, 0, 0, 0);
        put(&tree, 0, 10 * s, 2 * s, 0);
        double volume = connect(&tree, 1, (double[3]){4 * s, -5 * s, 0}, x);
        assert_near(volume / (0.288279615932 * pow(s, 1.5)), 1, 1e-9);
        assert_near(x[0] / s, 1.131335482, 1e-6);
        assert_near(radius_of(&tree, 2) / (.0927521507 * pow(s, 0.25)), 1, 1e-8);
        vn_tree_free(&tree);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(golden_one_terminal),
        counted_test(golden_a),
        counted_test(golden_b),
        counted_test(golden_b_kamiya),
        counted_test(golden_c),
        counted_test(golden_d),
        counted_test(golden_e_and_ceres),
        counted_test(kept_values_are_those_recomputed),
        counted_test(the_effect_of_a_candidate),
        counted_test(the_point_is_of_least_volume),
        counted_test(scaling),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
