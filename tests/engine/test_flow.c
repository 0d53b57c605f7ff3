// Flow: against dense elimination, by hand, and by the laws that hold for every network.
#include "flow_support.h"

static const double pi = 3.141592653589793;

static void refused(vn_network *network, const vn_flow_def *def, const char *part) {
    vn_flow_report report;
    assert_int_equal(vn_network_solve_flow(network, def, &report), VN_INVALID);
    assert_message(part);
    assert_null(report.terminals);
    assert_null(report.edge_shear);
}

static double resistance_of(double viscosity, double length, double radius) {
    return 8 * viscosity * length / (pi * pow(radius, 4));
}

// ---- The oracle: dense elimination in long doubles ----

// A node is taken out by the conductances that its neighbours then have between them. That is Gauss's
// elimination without a subtraction: plain pivoting loses up to nine digits of the flows in these networks.
typedef struct oracle {
    int32_t label[MOST_NODES]; // of places
    bool root[MOST_NODES], terminal[MOST_NODES];
    bool fixed[MOST_NODES];
    long double conductance[MOST_NODES][MOST_NODES], source[MOST_NODES], pressure[MOST_NODES];
} oracle;

static int32_t pipes_of(const vn_network *network) {
    return vn_network_count(network) + vn_network_join_count(network);
}

static long double pipe_resistance(const vn_pipe *pipe, const vn_flow_def *def) {
    long double r2 = (long double)pipe->radius * pipe->radius;
    return 8 * (long double)def->viscosity * pipe->length / (3.14159265358979323846L * r2 * r2);
}

static void label_places(oracle *o, const vn_network *network) {
    int32_t count = vn_network_count(network);
    for (int32_t i = 0; i < count; i++) {
        o->label[i] = i;
    }
    for (int32_t e = 0; e < pipes_of(network); e++) {
        vn_pipe pipe;
        if (vn_pipe_get(network, e, &pipe) && pipe.length == 0) {
            int32_t from = o->label[pipe.a], to = o->label[pipe.b];
            for (int32_t i = 0; i < count; i++) {
                o->label[i] = o->label[i] == from ? to : o->label[i];
            }
        }
    }
}

static void find_ends(oracle *o, const vn_network *network) {
    for (int32_t i = 0; i < vn_network_count(network); i++) {
        int32_t degree = 0;
        for (int32_t e = 0; e < pipes_of(network); e++) {
            vn_pipe pipe;
            degree += vn_pipe_get(network, e, &pipe) && (pipe.a == i || pipe.b == i);
        }
        o->root[i] = vn_network_parent(network)[i] < 0;
        o->terminal[i] = !o->root[i] && degree == 1;
    }
}

// Fixed places first, so that what is taken out from behind is taken out of what is before it.
static int32_t order_places(const oracle *o, int32_t count, int32_t *order) {
    int32_t done = 0, fixed = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t i = 0; i < count; i++) {
            if (o->label[i] == i && o->fixed[i] == (pass == 0)) {
                order[done++] = i;
            }
        }
        fixed = pass == 0 ? done : fixed;
    }
    return fixed;
}

static void eliminate(oracle *o, const int32_t *order, int32_t fixed, int32_t count) {
    for (int32_t k = count - 1; k >= fixed; k--) {
        int32_t v = order[k];
        long double all = 0;
        for (int32_t i = 0; i < k; i++) {
            all += o->conductance[v][order[i]];
        }
        for (int32_t i = 0; i < k; i++) {
            long double part = o->conductance[v][order[i]] / all;
            o->source[order[i]] += part * o->source[v];
            for (int32_t j = 0; j < k; j++) {
                o->conductance[order[i]][order[j]] += i != j ? part * o->conductance[v][order[j]] : 0;
            }
        }
    }
    for (int32_t k = fixed; k < count; k++) {
        int32_t v = order[k];
        long double all = 0, sum = o->source[v];
        for (int32_t i = 0; i < k; i++) {
            all += o->conductance[v][order[i]];
            sum += o->conductance[v][order[i]] * o->pressure[order[i]];
        }
        o->pressure[v] = sum / all;
    }
}

static void connect(oracle *o, const vn_network *network, const vn_flow_def *def) {
    for (int32_t e = 0; e < pipes_of(network); e++) {
        vn_pipe pipe;
        if (vn_pipe_get(network, e, &pipe) && o->label[pipe.a] != o->label[pipe.b]) {
            int32_t a = o->label[pipe.a], b = o->label[pipe.b];
            o->conductance[a][b] += 1 / pipe_resistance(&pipe, def);
            o->conductance[b][a] = o->conductance[a][b];
        }
    }
}

static void solve_densely(oracle *o, const vn_network *network, const vn_flow_def *def) {
    int32_t count = vn_network_count(network), terminals = 0, roots = 0, places = 0, order[MOST_NODES];
    memset(o, 0, sizeof *o);
    label_places(o, network);
    find_ends(o, network);
    for (int32_t i = 0; i < count; i++) {
        terminals += o->terminal[i];
        roots += o->root[i];
        places += o->label[i] == i;
    }
    bool by_roots = def->inflow > 0 && def->share == VN_SHARE_ROOTS;
    double take = def->terminal_flow > 0 ? def->terminal_flow : !by_roots ? def->inflow / terminals : 0;
    for (int32_t i = 0; i < count; i++) {
        int32_t at = o->label[i];
        o->source[at] += by_roots && o->root[i] ? (long double)def->inflow / roots : 0;
        o->source[at] -= o->terminal[i] ? take : 0;
        if ((o->root[i] && !by_roots) || (o->terminal[i] && take == 0)) {
            o->fixed[at] = true;
            o->pressure[at] = o->root[i] ? def->pressure_in : def->pressure_out;
        }
    }
    connect(o, network, def);
    eliminate(o, order, order_places(o, count, order), places);
    for (int32_t i = 0; i < count; i++) {
        o->pressure[i] = o->pressure[o->label[i]];
    }
}

static double flow_through(const vn_network *network, int32_t edge) {
    int32_t count = vn_network_count(network);
    return edge < count ? vn_network_flow(network)[edge] : vn_network_join_flow(network, edge - count);
}

static void check_against(const oracle *o, const vn_network *network, const vn_flow_def *def,
                          double tolerance) {
    long double most = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t e = 0; e < pipes_of(network); e++) {
            vn_pipe pipe;
            if (!vn_pipe_get(network, e, &pipe) || pipe.length == 0) {
                continue;
            }
            long double drop = o->pressure[pipe.a] - o->pressure[pipe.b];
            long double flow = drop / pipe_resistance(&pipe, def);
            most = fmaxl(most, fabsl(flow));
            if (pass == 1) {
                assert_near(flow_through(network, e), (double)flow, tolerance * (double)most);
            }
        }
    }
    for (int32_t i = 0; i < vn_network_count(network); i++) {
        double p = (double)o->pressure[i];
        assert_near(vn_network_pressure(network)[i], p, tolerance * (fabs(p) + def->pressure_in));
    }
}

// ---- Networks at random ----

static bool every_part_has_a_terminal(const vn_network *network) {
    vn_flow_def def = vn_flow_def_default();
    vn_flow_report report;
    def.inflow = 1;
    bool has = vn_network_solve_flow((vn_network *)(uintptr_t)network, &def, &report) == VN_OK;
    vn_flow_report_free(&report);
    return has;
}

// By their span.
static double rounding_of_pressures(const vn_network *network) {
    double low = INFINITY, high = -INFINITY;
    for (int32_t i = 0; i < vn_network_count(network); i++) {
        low = fmin(low, vn_network_pressure(network)[i]);
        high = fmax(high, vn_network_pressure(network)[i]);
    }
    return 1e-15 * fmax(fabs(low), fabs(high)) / (high - low);
}

static void solve_both_ways(vn_network *network, const vn_flow_def *def, double tolerance) {
    oracle *o = malloc(sizeof *o);
    assert_non_null(o);
    vn_flow_report report = solved(network, def);
    solve_densely(o, network, def);
    check_against(o, network, def, tolerance);
    assert_true(report.conservation.error < 1e-12);
    assert_true(report.drop.error < 1e-12 + rounding_of_pressures(network));
    assert_near(report.outflow, report.inflow, 1e-12 * report.inflow);
    vn_flow_report again = audited(network, def);
    assert_memory_equal(&again.conservation, &report.conservation, sizeof report.conservation);
    assert_true(again.power == report.power && again.murray.mean == report.murray.mean);
    vn_flow_report_free(&report);
    vn_flow_report_free(&again);
    free(o);
}

static void flows_are_what_elimination_says(void **state) {
    (void)state;
    int32_t met = 0;
    for (uint64_t seed = 0; seed < 90; seed++) {
        int32_t joins = seed % 4 == 0 ? 0 : 3 * (int32_t)(seed % 7);
        vn_network *network = random_network(seed, joins, 4, seed % 3 == 1 ? 0.3 : 0);
        vn_flow_def def = vn_flow_def_default();
        solve_both_ways(network, &def, 1e-11);
        def.inflow = 250;
        def.share = VN_SHARE_TERMINALS;
        solve_both_ways(network, &def, 1e-10);
        def.share = VN_SHARE_ROOTS;
        if (every_part_has_a_terminal(network)) {
            solve_both_ways(network, &def, 1e-10);
            met++;
        }
        def = (vn_flow_def){.viscosity = 1e-3, .pressure_in = 5, .terminal_flow = 0.25, .exponent = 2};
        solve_both_ways(network, &def, 1e-10);
        vn_network_destroy(network);
    }
    assert_true(met > 60);
}

// What is lost on the way from a node to its root, and the sum of the parts without their signs.
static long double loss_to_root(const vn_network *network, const vn_flow_def *def, int32_t node,
                                long double *size) {
    long double loss = 0;
    vn_pipe pipe;
    for (; vn_pipe_get(network, node, &pipe); node = pipe.a) {
        long double part = pipe_resistance(&pipe, def) * vn_network_flow(network)[node];
        loss += part;
        *size += fabsl(part);
    }
    return loss;
}

// Roots have one pressure, so every join closes a loop, through them at the longest.
static void check_loops(const vn_network *network, const vn_flow_def *def, double tolerance) {
    for (int32_t j = 0; j < vn_network_join_count(network); j++) {
        vn_pipe pipe;
        long double size = 0;
        vn_pipe_get(network, vn_network_count(network) + j, &pipe);
        long double loss = loss_to_root(network, def, pipe.a, &size);
        loss -= loss_to_root(network, def, pipe.b, &size);
        long double own = pipe_resistance(&pipe, def) * vn_network_join_flow(network, j);
        size += fabsl(own);
        assert_near((double)(loss + own), 0, tolerance * (double)size);
    }
}

// Ten decades and more of conductance, and still the flows add up, round loops as well: for every loop to a
// part of what is lost in it, which where it is wide is far less than the pressures' last digit.
static void far_conductances_keep_what_flows(void **state) {
    (void)state;
    oracle *o = malloc(sizeof *o);
    assert_non_null(o);
    for (uint64_t seed = 0; seed < 60; seed++) {
        vn_network *network = random_network(seed, 2 + (int32_t)(seed % 20), 12, 0);
        vn_flow_def def = vn_flow_def_default();
        vn_flow_report report = solved(network, &def);
        assert_true(report.conservation.error < 1e-9);
        assert_true(report.drop.error < 1e-12);
        solve_densely(o, network, &def);
        check_against(o, network, &def, 1e-9);
        check_loops(network, &def, 1e-14);
        vn_flow_report_free(&report);
        vn_network_destroy(network);
    }
    free(o);
}

static void conductances_too_far_apart_are_refused(void **state) {
    (void)state;
    static const double xy[][2] = {{0, 0}, {1, 1}, {1, -1}, {2, 0}, {5, 0}};
    static const int32_t parent[] = {-1, 0, 0, 1, 3};
    vn_network *network = tree_of(5, xy, parent, (double[]){0, 0.1, 1e6, 0.1, 0.1});
    assert_ok(vn_network_join(network, 2, 3, 1e-2));
    vn_flow_def def = vn_flow_def_default();
    vn_flow_report report;
    assert_int_equal(vn_network_solve_flow(network, &def, &report), VN_INFEASIBLE);
    assert_message("flow: where joins close loops, conductances from ");
    assert_null(vn_network_flow(network));
    vn_network_destroy(network);
}

// ---- By hand ----

static void edges_in_series_and_side_by_side(void **state) {
    (void)state;
    static const double xy[][2] = {{0, 0}, {2, 0}, {5, 0}, {2, 1}, {5, 0}, {9, 0}};
    static const int32_t parent[] = {-1, 0, 1, 1, 3, 2};
    static const double radius[] = {0, 0.2, 0.1, 0.15, 0.12, 0.2};
    vn_network *network = tree_of(6, xy, parent, radius);
    assert_ok(vn_network_join(network, 4, 2, 0.3)); // of no length: two ways between nodes 1 and 2
    vn_flow_def def = vn_flow_def_default();
    vn_flow_report report = solved(network, &def);
    double mu = def.viscosity, one = resistance_of(mu, 3, 0.1);
    double other = resistance_of(mu, 1, 0.15) + resistance_of(mu, sqrt(10), 0.12);
    double all = resistance_of(mu, 2, 0.2) + one * other / (one + other) + resistance_of(mu, 4, 0.2);
    double flow = (def.pressure_in - def.pressure_out) / all;
    assert_near(report.inflow, flow, 1e-12 * flow);
    assert_near(report.resistance, all, 1e-12 * all);
    assert_near(vn_network_flow(network)[0], flow, 1e-12 * flow);
    assert_near(vn_network_flow(network)[2], flow * other / (one + other), 1e-12 * flow);
    assert_near(vn_network_join_flow(network, 0), flow * one / (one + other), 1e-12 * flow);
    assert_near(report.power, flow * flow * all, 1e-12 * report.power);
    double most = 0;
    for (int32_t e = 0; e < report.edge_count; e++) {
        most = fmax(most, report.edge_shear[e]);
    }
    assert_int_equal(report.edge_count, 7);
    assert_true(report.edge_shear[0] == 0 && report.wall_shear.max == most);
    assert_near(report.edge_shear[5], 4 * mu * flow / (pi * 0.008), 1e-12 * report.edge_shear[5]);
    assert_int_equal(report.terminal_count, 1);
    assert_int_equal(report.terminals[0].node, 5);
    vn_flow_report_free(&report);
    vn_network_destroy(network);
}

// Root 0 to 1 and 2, both to 3, and a bridge between 1 and 2.
static void wheatstone_bridge(void **state) {
    (void)state;
    static const double xy[][2] = {{0, 0}, {1, 1}, {1, -1}, {2, 0}, {5, 0}};
    static const int32_t parent[] = {-1, 0, 0, 1, 3};
    double radius[] = {0, 0.2, 0.1, 0.2, 0.3};
    for (int unbalanced = 0; unbalanced < 2; unbalanced++) {
        radius[3] = unbalanced ? 0.15 : 0.2;
        vn_network *network = tree_of(5, xy, parent, radius);
        assert_ok(vn_network_join(network, 2, 3, 0.1));
        assert_ok(vn_network_join(network, 2, 1, 0.25));
        vn_flow_def def = vn_flow_def_default();
        vn_flow_report report = solved(network, &def);
        double bridge = vn_network_join_flow(network, 1), all = report.inflow;
        assert_true(unbalanced ? bridge < -1e-3 * all : fabs(bridge) < 1e-14 * all);
        const double *p = vn_network_pressure(network), *q = vn_network_flow(network);
        assert_near((p[2] - p[1]) / resistance_of(def.viscosity, 2, 0.25), bridge, 1e-9 * all);
        assert_near(q[1] + q[2], q[4], 1e-13 * all);
        assert_near(q[1] + bridge, q[3], 1e-13 * all);
        assert_true(report.conservation.error < 1e-14);
        vn_flow_report_free(&report);
        vn_network_destroy(network);
    }
}

// ---- READINGS: the golden trees carry the declared loss to every terminal ----

static vn_flow_report carried(vn_network *network, double inflow) {
    vn_flow_def def = vn_flow_def_default();
    def.inflow = inflow;
    def.share = VN_SHARE_TERMINALS;
    vn_flow_report report = solved(network, &def);
    assert_true(report.terminal.error < 1e-6);
    assert_near(def.pressure_in - report.terminal_pressure.mean, 5332.88, 1e-4);
    assert_near(report.resistance * inflow, 5332.88, 1e-4);
    return report;
}

static void golden_trees_carry_their_pressure(void **state) {
    (void)state;
    const double tip = 125.0 / 60;
    static const double xa[][2] = {{0, 0}, {4.780935894, 0}, {10, 4}, {10, -4}};
    static const int32_t two[] = {-1, 0, 1, 1};
    static const double ra[] = {0, .0983559021, .0780651312, .0780651312};
    vn_network *a = tree_of(4, xa, two, ra);
    vn_flow_report report = carried(a, 2 * tip);
    assert_near(vn_network_pressure(a)[1] - 13332.2, -1951.3833, 1e-4);
    assert_near(report.volume, 0.397084437513, 1e-9);
    assert_true(report.murray.count == 1 && report.murray.max < 1e-8);
    assert_near(report.fitted.median, 3, 1e-7);
    vn_flow_report_free(&report);
    vn_network_destroy(a);

    static const double xb[][2] = {{0, 0}, {1.131335482, -0.332976096}, {10, 2}, {4, -5}};
    static const double rb[] = {0, .0927521507, .0780305135, .0686003663};
    vn_network *b = tree_of(4, xb, two, rb);
    report = carried(b, 2 * tip);
    assert_near(vn_network_pressure(b)[1] - 13332.2, -608.648667, 1e-4);
    assert_near(report.volume, 0.288279615932, 1e-9);
    assert_near(report.edge_shear[1], 23.93, 0.005);
    assert_near(report.edge_shear[2], 20.10, 0.005);
    assert_near(report.edge_shear[3], 29.58, 0.005);
    vn_flow_report_free(&report);
    vn_network_destroy(b);

    static const double xd[][2] = {{0, 0}, {4, 0}, {10, 3}, {7, -2}, {11, -4}, {9, -6}};
    static const int32_t three[] = {-1, 0, 1, 1, 3, 3};
    static const double rd[2][6] = {{0, .111282919, .076008517, .097923570, .077721989, .077721989},
                                    {0, .115859414, .074945323, .099061907, .075484139, .075484139}};
    for (int k = 0; k < 2; k++) {
        vn_network *d = tree_of(6, xd, three, rd[k]);
        report = carried(d, 3 * tip);
        assert_near(report.volume, k == 0 ? .55572975765 : .55831645901, 1e-8);
        assert_near(report.fitted.median, k == 0 ? 3 : 2.55, 1e-6);
        assert_int_equal(report.fitted.count, 2);
        vn_flow_report_free(&report);
        vn_network_destroy(d);
    }
}

// ---- Laws ----

static void flows_follow_scale_and_viscosity(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 12; seed++) {
        vn_network *network = random_network(seed, seed % 2 == 0 ? 0 : 12, 4, 0);
        vn_flow_def def = vn_flow_def_default();
        vn_flow_report one = solved(network, &def);
        double pressure = vn_network_pressure(network)[15];
        assert_ok(vn_network_scale(network, 3));
        assert_null(vn_network_flow(network)); // outdated
        assert_false(vn_network_has_join_flow(network));
        vn_flow_report scaled = solved(network, &def);
        assert_near(scaled.inflow, 27 * one.inflow, 1e-11 * scaled.inflow);
        assert_near(scaled.volume, 27 * one.volume, 1e-11 * scaled.volume);
        assert_near(scaled.wall_shear.mean, one.wall_shear.mean, 1e-9 * one.wall_shear.mean);
        assert_near(vn_network_pressure(network)[15], pressure, 1e-9 * pressure);
        def.viscosity *= 2;
        vn_flow_report thick = solved(network, &def);
        assert_near(2 * thick.inflow, scaled.inflow, 1e-11 * scaled.inflow);
        assert_near(thick.resistance, 2 * scaled.resistance, 1e-10 * thick.resistance);
        vn_flow_report_free(&one);
        vn_flow_report_free(&scaled);
        vn_flow_report_free(&thick);
        vn_network_destroy(network);
    }
}

// Widths by Murray's law with equal flows at the tips: one exponent everywhere, and with 3 one shear stress.
static void murray_trees_keep_the_law(void **state) {
    (void)state;
    static const double exponents[] = {2, 2.55, 3};
    for (int k = 0; k < 3; k++) {
        vn_network *network = random_tree(3, 300, 1, 4);
        vn_murray_def law = {.exponent = exponents[k], .tip_radius = 0.1};
        assert_ok(vn_network_murray(network, &law));
        vn_flow_def def = vn_flow_def_default();
        def.terminal_flow = 2;
        def.exponent = law.exponent;
        vn_flow_report report = solved(network, &def);
        vn_network_measures m;
        assert_ok(vn_network_measure(network, &m));
        assert_int_equal(report.terminal_count, m.tips);
        assert_near(report.inflow, 2.0 * m.tips, 1e-11 * report.inflow);
        assert_true(report.murray.max < 1e-12);
        assert_near(report.fitted.min, law.exponent, 1e-9);
        assert_near(report.fitted.max, law.exponent, 1e-9);
        bool same = report.wall_shear.max - report.wall_shear.min < 1e-9 * report.wall_shear.max;
        assert_true(same == (k == 2));
        assert_int_equal(report.fitted.count, report.murray.count);
        vn_flow_report_free(&report);
        vn_network_destroy(network);
    }
}

// ---- What is degenerate ----

static void one_edge_and_none(void **state) {
    (void)state;
    vn_flow_def def = vn_flow_def_default();
    vn_network *network = network_of(2);
    vn_flow_report report = solved(network, &def);
    assert_int_equal(report.terminal_count, 0);
    assert_int_equal(report.conservation.node, -1);
    vn_flow_report_free(&report);
    put_root(network, 0, 0, 0);
    assert_ok(vn_network_set_radii(network, (double[]){0}));
    report = solved(network, &def);
    assert_true(vn_network_flow(network)[0] == 0);
    assert_true(vn_network_pressure(network)[0] == def.pressure_in);
    assert_true(report.inflow == 0 && report.conservation.error == 0);
    vn_flow_report_free(&report);
    put_child(network, 0, 10, 0, 0);
    assert_ok(vn_network_set_radii(network, (double[]){0, 0.0773588298}));
    report = solved(network, &def);
    assert_near(report.inflow, 125.0 / 60, 1e-8);
    assert_true(report.terminals[0].flow == report.inflow);
    vn_flow_report_free(&report);
    vn_network_destroy(network);
}

// A part with a loop and no terminal stands still; one that hangs from what flows does so but for rounding.
static void loops_without_an_end_stand_still(void **state) {
    (void)state;
    static const double xy[][2] = {{0, 0}, {1, 0}, {2, 1}, {2, -1}, {5, 5}, {5, 6}};
    static const int32_t parent[] = {-1, 0, 1, 1, -1, 4};
    static const double radius[] = {0, 0.2, 0.1, 0.15, 0, 0.1};
    vn_network *network = tree_of(6, xy, parent, radius);
    assert_ok(vn_network_join(network, 2, 3, 0.1));
    vn_flow_def def = vn_flow_def_default();
    vn_flow_report report = solved(network, &def);
    for (int32_t i = 0; i < 4; i++) {
        assert_true(vn_network_flow(network)[i] == 0);
        assert_true(vn_network_pressure(network)[i] == def.pressure_in);
    }
    assert_true(vn_network_join_flow(network, 0) == 0 && report.inflow > 0);
    assert_true(report.conservation.error < 1e-15);
    vn_flow_report_free(&report);
    def.inflow = 5;
    refused(network, &def, "flow: what enters at root 0 can leave nowhere, as no terminal hangs from it");
    vn_network_destroy(network);

    static const int32_t hanging[] = {-1, 0, 1, 1, 1, 4};
    network = tree_of(6, xy, hanging, radius);
    network->radius.data[4] = 0.1;
    assert_ok(vn_network_join(network, 2, 3, 0.1));
    def.inflow = 0;
    report = solved(network, &def);
    assert_true(fabs(vn_network_join_flow(network, 0)) < 1e-25 * report.inflow);
    assert_true(report.conservation.error < 1e-14);
    assert_int_equal(report.murray.count, 0);
    vn_flow_report_free(&report);
    vn_network_destroy(network);
}

// Chains whose ends are joined back, with chords: not one bit moves.
static void closed_rings_stand_still(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 20; seed++) {
        vn_rng rng = vn_rng_make(seed);
        vn_network *network = network_of(2);
        double radius[30];
        for (int32_t i = 0; i < 30; i++) {
            double x = uniform(&rng, -5, 5), y = uniform(&rng, -5, 5);
            radius[i] = uniform(&rng, 0.1, 2);
            (void)(i == 0 ? put_root(network, x, y, 0) : put_child(network, i - 1, x, y, 0));
        }
        assert_ok(vn_network_set_radii(network, radius));
        assert_ok(vn_network_join(network, 29, 3, 0.1));
        vn_network_join(network, (int32_t)whole(&rng, 4, 12), (int32_t)whole(&rng, 15, 28), 0.7);
        vn_flow_def def = vn_flow_def_default();
        vn_flow_report report = solved(network, &def);
        for (int32_t i = 0; i < 30; i++) {
            assert_true(vn_network_flow(network)[i] == 0);
            assert_true(vn_network_pressure(network)[i] == def.pressure_in);
        }
        assert_true(report.power == 0 && report.conservation.error == 0);
        vn_flow_report_free(&report);
        vn_network_destroy(network);
    }
}

static void edges_without_a_length(void **state) {
    (void)state;
    // Node 1 lies on the root, 4 on 3, and the terminals 5 and 6 both on 4; a circle 2-7-8 has no length.
    static const double xy[][2] = {{0, 0}, {0, 0}, {3, 0}, {6, 0}, {6, 0}, {6, 0}, {6, 0}, {3, 0}, {3, 0}};
    static const int32_t parent[] = {-1, 0, 1, 2, 3, 4, 4, 2, 7};
    static const double radius[] = {0, 0.1, 0.1, 0.2, 0.1, 0.1, 0.1, 0.1, 0.1};
    vn_network *network = tree_of(9, xy, parent, radius);
    assert_ok(vn_network_join(network, 8, 2, 0.1));
    vn_flow_def def = vn_flow_def_default();
    vn_flow_report report = solved(network, &def);
    const double *q = vn_network_flow(network), *p = vn_network_pressure(network);
    double all = resistance_of(def.viscosity, 3, 0.1) + resistance_of(def.viscosity, 3, 0.2);
    double flow = (def.pressure_in - def.pressure_out) / all;
    for (int32_t i = 0; i < 5; i++) {
        assert_near(q[i], flow, 1e-12 * flow);
    }
    assert_near(q[5], flow / 2, 1e-12 * flow);
    assert_near(q[6], flow / 2, 1e-12 * flow);
    assert_true(q[7] == 0 && q[8] == 0 && vn_network_join_flow(network, 0) == 0);
    assert_true(p[1] == def.pressure_in && p[3] == def.pressure_out);
    assert_true(p[7] == p[2] && p[8] == p[2]);
    assert_true(report.conservation.error < 1e-14 && report.drop.error < 1e-14);
    vn_flow_report_free(&report);
    def.inflow = 8; // the root's pressure and the terminals' flows follow
    report = solved(network, &def);
    assert_near(vn_network_pressure(network)[0], def.pressure_out + 8 * all, 1e-9 * def.pressure_out);
    assert_near(vn_network_flow(network)[6], 4, 1e-12);
    vn_flow_report_free(&report);
    def.share = VN_SHARE_TERMINALS;
    report = solved(network, &def);
    assert_near(vn_network_pressure(network)[5], def.pressure_in - 8 * all, 1e-9 * def.pressure_in);
    assert_near(vn_network_flow(network)[0], 8, 1e-12);
    assert_near(vn_network_flow(network)[5], 4, 1e-12);
    vn_flow_report_free(&report);
    vn_network_destroy(network);
}

static void joined_roots_share_what_enters(void **state) {
    (void)state;
    static const double xy[][2] = {{0, 0}, {4, 0}, {4, 3}, {8, 0}};
    static const int32_t parent[] = {-1, 0, -1, 1};
    static const double radius[] = {0, 0.1, 0, 0.2};
    vn_network *network = tree_of(4, xy, parent, radius);
    assert_ok(vn_network_join(network, 2, 1, 0.1));
    vn_flow_def def = vn_flow_def_default();
    def.inflow = 6;
    vn_flow_report report = solved(network, &def);
    const double *q = vn_network_flow(network), *p = vn_network_pressure(network);
    assert_true(q[0] == 3 && q[2] == 3);
    assert_near(q[1], 3, 1e-13);
    assert_near(vn_network_join_flow(network, 0), 3, 1e-13);
    assert_near(q[3], 6, 1e-13);
    assert_near((p[0] - p[1]) / (p[2] - p[1]), 4.0 / 3, 1e-9);
    assert_true(report.conservation.error < 1e-14);
    vn_flow_report_free(&report);
    vn_network_destroy(network);
}

// A law that turns joins turns what flows through them.
static void turned_joins_keep_their_flow(void **state) {
    (void)state;
    vn_network *network = network_of(2);
    put_root(network, 0, 0, 0);
    put_child(network, 0, 0, 1, 0);
    put_child(network, 1, 1, 2, 0);
    put_child(network, 2, 0, 3, 0);
    put_child(network, 3, 0, 5, 0);
    assert_ok(vn_network_join(network, 3, 1, 0.25));
    vn_murray_def law = {.exponent = 3, .tip_radius = 0.1};
    assert_ok(vn_network_murray(network, &law));
    vn_flow_def def = vn_flow_def_default();
    vn_flow_report report = solved(network, &def);
    int32_t a, b;
    double radius, flow = vn_network_join_flow(network, 0);
    vn_network_join_ends(network, 0, &a, &b, &radius);
    assert_int_equal(a, 1);
    assert_true(flow > 0);
    assert_near(flow + vn_network_flow(network)[2], report.inflow, 1e-13 * report.inflow);
    assert_ok(vn_network_set_join_flow(network, &flow));
    assert_true(vn_network_join_flow(network, 0) == flow);
    vn_flow_report_free(&report);
    vn_network_destroy(network);
}

static void what_cannot_flow_is_said(void **state) {
    (void)state;
    static const double xy[][2] = {{0, 0}, {1, 0}, {2, 0}};
    static const int32_t parent[] = {-1, 0, 1};
    vn_network *network = tree_of(3, xy, parent, (double[]){0, 0.1, 0.1});
    vn_flow_def def = vn_flow_def_default();
    def.pressure_in = 10;
    refused(network, &def, "flow: pressure_in = 10 Pa must be above pressure_out = 7999.32 Pa");
    def = vn_flow_def_default();
    def.inflow = def.terminal_flow = 2;
    refused(network, &def, "flow: inflow = 2 and terminal_flow = 2 are both given");
    def.inflow = 0;
    def.share = VN_SHARE_TERMINALS;
    refused(network, &def, "needs an inflow that they share");
    def = vn_flow_def_default();
    def.viscosity = 0;
    refused(network, &def, "flow.viscosity = 0 must be above 0 Pa s");
    def = vn_flow_def_default();
    def.inflow = NAN;
    refused(network, &def, "flow.inflow is not a number");
    def = vn_flow_def_default();
    assert_ok(vn_network_set_radii(network, (double[]){0, 0.1, 0}));
    refused(network, &def, "flow: the edge to node 2 at (2, 0, 0) has the radius 0, which must be above 0");
    assert_ok(vn_network_set_radii(network, (double[]){0, 0.1, 1e-60}));
    refused(network, &def, "use another length unit");
    assert_ok(vn_network_set_radii(network, (double[]){0, 0.1, 0.1}));
    assert_ok(vn_network_join(network, 0, 2, 0));
    refused(network, &def, "flow: join 0, from node 0 to node 2 at (2, 0, 0) has the radius 0");
    vn_network_destroy(network);

    network = network_of(2);
    put_child(network, put_root(network, 0, 0, 0), 1, 0, 0);
    refused(network, &def, "flow: the network has no radii");
    assert_ok(vn_network_set_radii(network, (double[]){0, 0.1}));
    network->x.data[1] = 0;
    refused(network, &def, "flow: node 1, a terminal, is at the same place as a root");
    vn_network_destroy(network);

    network = network_of(2);
    put_root(network, 0, 0, 0);
    assert_ok(vn_network_set_radii(network, (double[]){0}));
    def.terminal_flow = 1;
    refused(network, &def, "flow: the network has no terminal to take any flow");
    vn_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(flows_are_what_elimination_says),
        counted_test(far_conductances_keep_what_flows),
        counted_test(conductances_too_far_apart_are_refused),
        counted_test(edges_in_series_and_side_by_side),
        counted_test(wheatstone_bridge),
        counted_test(golden_trees_carry_their_pressure),
        counted_test(flows_follow_scale_and_viscosity),
        counted_test(murray_trees_keep_the_law),
        counted_test(one_edge_and_none),
        counted_test(loops_without_an_end_stand_still),
        counted_test(closed_rings_stand_still),
        counted_test(edges_without_a_length),
        counted_test(joined_roots_share_what_enters),
        counted_test(turned_joins_keep_their_flow),
        counted_test(what_cannot_flow_is_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
