#include "cco_support.h"

static const double PI = 3.14159265358979323846;
static const double VISCOSITY = 3.6e-3;

vn_domain *disk_of_measure(double area) {
    return disk_of(0, 0, sqrt(area / PI));
}

vn_domain *ball_of_measure(double volume) {
    return ball_of(0, 0, 0, cbrt(3 * volume / (4 * PI)));
}

double top_of(const vn_domain *domain) {
    return vn_domain_bounds(domain).max[1];
}

vn_cco *organ_of(vn_domain *domain, int32_t terminals, int64_t seed) {
    vn_cco_def def = vn_cco_def_default();
    def.domain = domain;
    def.terminals = terminals;
    def.seed = seed;
    vn_cco *cco;
    assert_ok(vn_cco_create(&cco, &def));
    return cco;
}

int32_t add_tree(vn_cco *cco, const vn_cco_tree_def *def) {
    int32_t tree;
    if (vn_cco_add(cco, def, &tree) != VN_OK) {
        fail_msg("%s", vn_message());
    }
    return tree;
}

vn_cco *started(vn_domain *domain, int32_t terminals, int64_t seed) {
    vn_cco *cco = organ_of(domain, terminals, seed);
    vn_cco_tree_def def = vn_cco_tree_def_default();
    def.root[1] = top_of(domain);
    assert_int_equal(add_tree(cco, &def), 0);
    return cco;
}

void grow_all(vn_cco *cco) {
    int32_t added;
    if (vn_cco_grow(cco, INT32_MAX, &added) != VN_OK) {
        report(cco, "stopped", 0);
        fail_msg("%s", vn_message());
    }
    assert_true(vn_cco_done(cco));
}

vn_network *network_at(const vn_cco *cco, int32_t tree) {
    vn_network *network;
    assert_ok(vn_cco_network(cco, tree, &network));
    return network;
}

void report(const vn_cco *cco, const char *what, double seconds) {
    vn_cco_report r = vn_cco_report_of(cco, 0);
    print_message(
        "%s: %d terminals in %.3f s, volume %.6g; %lld darts, %lld redrawn, %lld tried, %lld collapsed, "
        "%lld short, %lld outside, %lld crossing, %lld crowding\n",
        what, r.terminals, seconds, r.volume, (long long)r.darts, (long long)r.redrawn, (long long)r.tried,
        (long long)r.collapsed, (long long)r.short_segments, (long long)r.outside, (long long)r.crossing,
        (long long)r.crowding);
}

// ---- Laws, from the network alone ----

laws laws_default(void) {
    return (laws){
        .inflow = 500000.0 / 60, .pressure_in = 100 * 133.322, .pressure_out = 60 * 133.322, .exponent = 3};
}

double length_of(const vn_network *n, int32_t node) {
    double a[3], b[3];
    vn_network_position(n, node, a);
    vn_network_position(n, n->parent.data[node], b);
    return sqrt(vn_distance2(a, b));
}

static double exponent_at(const laws *l, double flow) {
    const double *e = l->exponents;
    if (e == NULL) {
        return l->exponent;
    }
    int32_t i = 1;
    while (i < l->exponent_count - 1 && flow > e[2 * i]) {
        i++;
    }
    double t = log(flow / e[2 * i - 2]) / log(e[2 * i] / e[2 * i - 2]);
    return e[2 * i - 1] + fmin(fmax(t, 0), 1) * (e[2 * i + 1] - e[2 * i - 1]);
}

static void check_node_flow(const vn_network *n, int32_t i, const laws *l) {
    const double *flow = vn_network_flow(n), *pressure = vn_network_pressure(n);
    double sign = l->venous ? -1 : 1, below = 0;
    assert_true(sign * flow[i] > 0);
    for (int32_t c = n->first_child.data[i]; c >= 0; c = n->next_child.data[c]) {
        below += flow[c];
    }
    if (n->first_child.data[i] >= 0) {
        assert_near(below / flow[i], 1, 1e-9);
    } else {
        assert_near(pressure[i] / (l->venous ? l->pressure_in : l->pressure_out), 1, 1e-6);
    }
    if (n->parent.data[i] < 0) {
        assert_near(pressure[i], l->venous ? l->pressure_out : l->pressure_in, 1e-9);
        assert_near(l->inflow > 0 ? sign * flow[i] / l->inflow : 1, 1, 1e-9);
        return;
    }
    double drop = 8 * VISCOSITY * flow[i] * length_of(n, i) / (PI * pow(vn_network_radius(n, i), 4));
    // in parts of the whole drop too: the difference of two pressures has no more digits than these
    assert_near(pressure[n->parent.data[i]] - pressure[i], drop, 1e-9 * fabs(drop) + 1e-9);
}

void check_flow(const vn_network *n, const laws *l) {
    int32_t roots = 0;
    assert_non_null(vn_network_flow(n));
    assert_non_null(vn_network_pressure(n));
    for (int32_t i = 0; i < n->x.count; i++) {
        check_node_flow(n, i, l);
        roots += n->parent.data[i] < 0;
    }
    assert_int_equal(roots, 1);
}

// Equations 3 to 6 at every node, by the resistances that follow from the file.
static double check_equations(const vn_network *n, int32_t i, const laws *l) {
    enum { MOST = 8 };
    double inverse = 0, sum = 0, head[MOST], radius[MOST], own = vn_network_radius(n, i);
    const double *flow = vn_network_flow(n);
    double exponent = exponent_at(l, fabs(flow[i]));
    bool root = n->parent.data[i] < 0;
    int count = 0;
    for (int32_t c = n->first_child.data[i]; c >= 0; c = n->next_child.data[c]) {
        assert_true(count < MOST);
        double resistance = check_equations(n, c, l);
        head[count] = fabs(flow[c]) * resistance;
        radius[count] = vn_network_radius(n, c);
        sum += pow(radius[count] / own, exponent);
        inverse += pow(radius[count] / own, 4) / resistance;
        if (root) {
            assert_near(pow(radius[count], 4) / (head[count] / (l->pressure_in - l->pressure_out)), 1, 1e-9);
        }
        count++;
    }
    assert_true(i < l->given || count == (root ? 1 : 0) || (!root && count == 2));
    if (root) {
        return 0;
    }
    assert_near(count > 0 ? sum : 1, 1, 1e-9);
    for (int k = 1; k < count; k++) {
        assert_near(radius[k] / radius[0] / pow(head[k] / head[0], 0.25), 1, 1e-9);
        bool even = fmin(radius[0], radius[k]) >= l->symmetry * fmax(radius[0], radius[k]) * (1 - 1e-9);
        assert_true(even || i < l->given);
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

void check_pairs(const vn_network *a, const vn_network *b) {
    for (int32_t i = 0; i < a->x.count; i++) {
        for (int32_t j = a == b ? i + 1 : 0; j < b->x.count; j++) {
            check_pair(a, i, b, j);
        }
    }
}

static void check_places(const vn_network *n, const vn_domain *domain, const laws *l) {
    for (int32_t i = 0; i < n->x.count; i++) {
        int32_t parent = n->parent.data[i];
        if (parent < 0 || i < l->given) {
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
            assert_true(vn_domain_distance(domain, p) >= (stem ? -1e-6 : r + l->border));
        }
    }
}

static int32_t root_of(const vn_network *n) {
    int32_t root = 0;
    while (n->parent.data[root] >= 0) {
        root = n->parent.data[root];
    }
    return root;
}

void check_laws(const vn_network *n, const vn_domain *domain, const laws *l) {
    check_flow(n, l);
    check_equations(n, root_of(n), l);
    check_pairs(n, n);
    check_places(n, domain, l);
}

double two_sample_excess(const int32_t *a, const int32_t *b, int32_t classes) {
    double all[2] = {0, 0}, square = 0, part[2] = {0, 0};
    int32_t free = -1;
    for (int32_t i = 0; i < classes; i++) {
        all[0] += a[i];
        all[1] += b[i];
    }
    double scale = sqrt(all[1] / all[0]);
    for (int32_t i = 0; i < classes; i++) { // classes that hold next to nothing go to the next
        part[0] += a[i];
        part[1] += b[i];
        if (part[0] + part[1] >= 20) {
            double off = part[0] * scale - part[1] / scale;
            square += off * off / (part[0] + part[1]);
            free++;
            part[0] = part[1] = 0;
        }
    }
    return free > 0 ? (square - free) / sqrt(2.0 * free) : 0;
}
