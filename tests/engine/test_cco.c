// Arterial trees as a whole: what is written down obeys the physics and the rules, recomputed from the
// network alone.
#include "support.h"

#include "domain/domain.h"
#include "network/network.h"
#include "space/tube_grid.h"

#include <time.h>

static const double PI = 3.14159265358979323846;
static const double VISCOSITY = 3.6e-3, P_IN = 100 * 133.322, P_OUT = 60 * 133.322;

static vn_domain *disk_of_measure(double area) {
    return disk_of(0, 0, sqrt(area / PI));
}

static vn_domain *ball_of_measure(double volume) {
    return ball_of(0, 0, 0, cbrt(3 * volume / (4 * PI)));
}

static double top_of(const vn_domain *domain) {
    return vn_domain_bounds(domain).max[1];
}

static vn_cco *started(vn_domain *domain, int32_t terminals, int64_t seed) {
    vn_cco_def def = vn_cco_def_default();
    def.domain = domain;
    def.terminals = terminals;
    def.seed = seed;
    vn_cco *cco;
    int32_t tree;
    assert_ok(vn_cco_create(&cco, &def));
    vn_cco_tree_def one = vn_cco_tree_def_default();
    one.root[1] = top_of(domain);
    assert_ok(vn_cco_add(cco, &one, &tree));
    return cco;
}

static vn_network *network_at(const vn_cco *cco, int32_t tree) {
    vn_network *network;
    assert_ok(vn_cco_network(cco, tree, &network));
    return network;
}

// ---- Laws, from the network alone ----

static double length_of(const vn_network *n, int32_t i) {
    double a[3], b[3];
    vn_network_position(n, i, a);
    vn_network_position(n, n->parent.data[i], b);
    return sqrt(vn_distance2(a, b));
}

static void check_flow(const vn_network *n, double inflow) {
    const double *flow = vn_network_flow(n), *pressure = vn_network_pressure(n);
    assert_non_null(flow);
    assert_non_null(pressure);
    int32_t roots = 0;
    for (int32_t i = 0; i < n->x.count; i++) {
        double below = 0;
        for (int32_t c = n->first_child.data[i]; c >= 0; c = n->next_child.data[c]) {
            below += flow[c];
        }
        if (n->first_child.data[i] >= 0) {
            assert_near(below / flow[i], 1, 1e-9);
        } else {
            assert_near(pressure[i] / P_OUT, 1, 1e-6);
        }
        if (n->parent.data[i] < 0) {
            roots++;
            assert_near(pressure[i], P_IN, 1e-9);
            assert_near(flow[i] / inflow, 1, 1e-9);
            continue;
        }
        double drop = 8 * VISCOSITY * flow[i] * length_of(n, i) / (PI * pow(vn_network_radius(n, i), 4));
        assert_near((pressure[n->parent.data[i]] - pressure[i]) / drop, 1, 1e-9);
    }
    assert_int_equal(roots, 1);
}

// Equations 3 to 6 at every bifurcation, by the resistances that follow from the file.
static double check_equations(const vn_network *n, int32_t i, double exponent) {
    double inverse = 0, sum = 0, radius[2], resistance[2];
    const double *flow = vn_network_flow(n);
    int count = 0;
    int32_t child[2];
    for (int32_t c = n->first_child.data[i]; c >= 0; c = n->next_child.data[c]) {
        assert_true(count < 2);
        child[count] = c;
        resistance[count] = check_equations(n, c, exponent);
        radius[count] = vn_network_radius(n, c);
        count++;
    }
    if (n->parent.data[i] < 0) {
        assert_int_equal(count, 1);
        double r4 = flow[i] * resistance[0] / (P_IN - P_OUT);
        assert_near(pow(radius[0], 4) / r4, 1, 1e-9);
        return 0;
    }
    for (int k = 0; k < count; k++) {
        double ratio = radius[k] / vn_network_radius(n, i);
        sum += pow(ratio, exponent);
        inverse += pow(ratio, 4) / resistance[k];
    }
    if (count > 0) {
        assert_int_equal(count, 2);
        assert_near(sum, 1, 1e-9);
        double alpha = pow(flow[child[1]] / flow[child[0]] * resistance[1] / resistance[0], 0.25);
        assert_near(radius[1] / radius[0] / alpha, 1, 1e-9);
    }
    return 8 * VISCOSITY / PI * length_of(n, i) + (count > 0 ? 1 / inverse : 0);
}

static bool share_an_end(const vn_network *n, int32_t i, int32_t j) {
    int32_t pi = n->parent.data[i], pj = n->parent.data[j];
    return i == j || pi == j || pj == i || pi == pj;
}

static void check_pair(const vn_network *a, int32_t i, const vn_network *b, int32_t j) {
    double p[4][3];
    if (a->parent.data[i] < 0 || b->parent.data[j] < 0 || (a == b && share_an_end(a, i, j))) {
        return;
    }
    vn_network_position(a, i, p[0]);
    vn_network_position(a, a->parent.data[i], p[1]);
    vn_network_position(b, j, p[2]);
    vn_network_position(b, b->parent.data[j], p[3]);
    double gap = sqrt(vn_segment_segment_distance2(p[0], p[1], p[2], p[3]));
    if (!(gap > vn_network_radius(a, i) + vn_network_radius(b, j))) {
        fail_msg("segments %d and %d are %g apart, with radii %g and %g", i, j, gap, vn_network_radius(a, i),
                 vn_network_radius(b, j));
    }
}

static void check_pairs(const vn_network *a, const vn_network *b) {
    for (int32_t i = 0; i < a->x.count; i++) {
        for (int32_t j = a == b ? i + 1 : 0; j < b->x.count; j++) {
            check_pair(a, i, b, j);
        }
    }
}

static void check_places(const vn_network *n, const vn_domain *domain, double border) {
    for (int32_t i = 0; i < n->x.count; i++) {
        int32_t parent = n->parent.data[i];
        if (parent < 0) {
            continue;
        }
        double r = vn_network_radius(n, i), a[3], b[3];
        assert_true(2 * r <= length_of(n, i));
        vn_network_position(n, i, a);
        vn_network_position(n, parent, b);
        for (int k = 0; k <= 20; k++) {
            double p[3], t = k / 20.0;
            for (int d = 0; d < 3; d++) {
                p[d] = a[d] + t * (b[d] - a[d]);
            }
            bool stem = n->parent.data[parent] < 0;
            assert_true(vn_domain_distance(domain, p) >= (stem ? -1e-6 : r + border));
        }
    }
}

static void check_tree(const vn_network *n, const vn_domain *domain, int32_t terminals, double inflow) {
    assert_int_equal(n->x.count, 2 * terminals);
    check_flow(n, inflow);
    check_equations(n, 0, 3);
    check_pairs(n, n);
    check_places(n, domain, 0);
}

static void report(const vn_cco *cco, const char *what, double seconds) {
    vn_cco_report r = vn_cco_report_of(cco, 0);
    print_message(
        "%s: %d terminals in %.3f s, volume %.6g; %lld darts, %lld redrawn, %lld tried, %lld collapsed, "
        "%lld short, %lld outside, %lld crossing, %lld crowding\n",
        what, r.terminals, seconds, r.volume, (long long)r.darts, (long long)r.redrawn, (long long)r.tried,
        (long long)r.collapsed, (long long)r.short_segments, (long long)r.outside, (long long)r.crossing,
        (long long)r.crowding);
}

static vn_network *grown(vn_domain *domain, int32_t terminals, int64_t seed, const char *what) {
    vn_cco *cco = started(domain, terminals, seed);
    int32_t added;
    clock_t start = clock();
    if (vn_cco_grow(cco, terminals, &added) != VN_OK) {
        report(cco, what, 0);
        fail_msg("%s", vn_message());
    }
    report(cco, what, (double)(clock() - start) / CLOCKS_PER_SEC);
    assert_int_equal(added, terminals);
    assert_true(vn_cco_done(cco));
    vn_network *network = network_at(cco, 0);
    vn_cco_destroy(cco);
    return network;
}

static void trees_obey_all_laws(void **state) {
    (void)state;
    for (int i = 0; i < 6; i++) {
        int32_t terminals = (int32_t[]){1, 2, 10, 200, 1000, 1500}[i];
        vn_domain *domain = i % 2 ? ball_of_measure(20000) : disk_of_measure(20000);
        vn_network *n = grown(domain, terminals, 7 + i, i % 2 ? "ball" : "disk");
        check_tree(n, domain, terminals, 500000.0 / 60);
        vn_network_destroy(n);
        vn_domain_release(domain);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(trees_obey_all_laws),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
