// What is said of flows that somebody else found, and of levels; and when memory runs out on the way.
#include "flow_support.h"

// ---- The audit of what somebody else says ----

static void audits_name_the_worst(void **state) {
    (void)state;
    vn_network *network = random_network(7, 8, 3, 0);
    vn_flow_def def = vn_flow_def_default();
    vn_flow_report report = solved(network, &def);
    int32_t count = vn_network_count(network), terminal = report.terminals[1].node, join = 2;
    double flow[MOST_NODES], pressure[MOST_NODES], through[64] = {0};
    memcpy(flow, vn_network_flow(network), (size_t)count * sizeof *flow);
    memcpy(pressure, vn_network_pressure(network), (size_t)count * sizeof *pressure);
    for (int32_t j = 0; j < vn_network_join_count(network); j++) {
        through[j] = vn_network_join_flow(network, j);
    }
    vn_flow_report_free(&report);

    int32_t parent = vn_network_parent(network)[terminal];
    flow[terminal] *= 1.5;
    assert_ok(vn_network_set_flow(network, flow, pressure));
    assert_false(vn_network_has_join_flow(network));
    assert_ok(vn_network_set_join_flow(network, through));
    report = audited(network, &def);
    assert_int_equal(report.conservation.node, parent);
    assert_true(report.conservation.error > 1e-3);
    assert_int_equal(report.drop.node, terminal);
    assert_int_equal(report.drop.join, -1);
    vn_flow_report_free(&report);

    flow[terminal] /= 1.5;
    pressure[terminal] += 80;
    assert_ok(vn_network_set_flow(network, flow, pressure));
    assert_ok(vn_network_set_join_flow(network, through));
    report = audited(network, &def);
    assert_true(report.conservation.error < 1e-12);
    assert_int_equal(report.terminal.node, terminal);
    assert_near(report.terminal.error, 80 / def.pressure_out, 1e-12);
    assert_int_equal(report.drop.node, terminal);
    assert_near(report.drop.error, 80 / 5332.88, 1e-9);
    vn_flow_report_free(&report);

    pressure[terminal] -= 80;
    through[join] += 1e4 * (fabs(through[join]) + 1);
    assert_ok(vn_network_set_flow(network, flow, pressure));
    assert_ok(vn_network_set_join_flow(network, through));
    report = audited(network, &def);
    assert_int_equal(report.drop.join, join);
    assert_int_equal(report.drop.node, -1);
    vn_flow_report_free(&report);
    vn_network_destroy(network);
}

// A file may know flows alone, or pressures but not what goes through joins.
static void audits_find_what_is_missing(void **state) {
    (void)state;
    vn_flow_def def = vn_flow_def_default();
    vn_flow_report report;
    vn_network *tree = random_network(3, 0, 3, 0);
    assert_int_equal(vn_network_audit_flow(tree, &def, &report), VN_INVALID);
    assert_message("flow: the network's flows are not known");
    report = solved(tree, &def);
    vn_flow_report_free(&report);
    double flow[MOST_NODES], pressure[MOST_NODES];
    int32_t count = vn_network_count(tree);
    memcpy(flow, vn_network_flow(tree), (size_t)count * sizeof *flow);
    assert_ok(vn_network_set_flow(tree, flow, NULL));
    report = audited(tree, &def);
    assert_true(report.terminal.error < 1e-12 && report.conservation.error < 1e-12);
    assert_near(report.terminal_pressure.max, def.pressure_out, 1e-8);
    vn_flow_report_free(&report);
    for (int32_t i = 0; i < count; i++) {
        flow[i] *= 1.001; // conserved, but each terminal loses a thousandth more
    }
    assert_ok(vn_network_set_flow(tree, flow, NULL));
    report = audited(tree, &def);
    assert_true(report.conservation.error < 1e-12);
    assert_near(report.terminal.error, 5.33288 / def.pressure_out, 1e-9);
    vn_flow_report_free(&report);
    vn_network_destroy(tree);

    vn_network *netted = random_network(8, 9, 3, 0);
    report = solved(netted, &def);
    vn_flow_report_free(&report);
    count = vn_network_count(netted);
    memcpy(flow, vn_network_flow(netted), (size_t)count * sizeof *flow);
    memcpy(pressure, vn_network_pressure(netted), (size_t)count * sizeof *pressure);
    assert_ok(vn_network_set_flow(netted, flow, pressure));
    assert_false(vn_network_has_join_flow(netted));
    report = audited(netted, &def);
    assert_true(report.conservation.error < 1e-8);
    vn_flow_report_free(&report);
    assert_ok(vn_network_set_flow(netted, flow, NULL));
    assert_int_equal(vn_network_audit_flow(netted, &def, &report), VN_INVALID);
    assert_message("flow: neither the pressures nor the flows through the");
    vn_network_destroy(netted);
}

// Blood that comes back: tips let in, and the root takes.
static void veins_are_audited_too(void **state) {
    (void)state;
    static const double xy[][2] = {{0, 0}, {2, 0}, {4, 1}, {4, -1}};
    static const int32_t parent[] = {-1, 0, 1, 1};
    vn_network *network = tree_of(4, xy, parent, (double[]){0, cbrt(2), 1, 1});
    assert_ok(vn_network_set_flow(network, (double[]){-2, -2, -1, -1}, NULL));
    vn_flow_def def = vn_flow_def_default();
    vn_flow_report report = audited(network, &def);
    assert_near(report.inflow, -2, 0);
    assert_near(report.outflow, -2, 0);
    assert_true(report.conservation.error == 0 && report.murray.max < 1e-15);
    assert_near(report.fitted.median, 3, 1e-12);
    vn_flow_report_free(&report);
    vn_network_destroy(network);
}

// ---- Levels ----

static void levels_by_hand(void **state) {
    (void)state;
    static const double xy[][2] = {{0, 0},  {0, 1}, {0, 3},  {3, 3}, {-4, 3},
                                   {-4, 3}, {5, 3}, {-4, 8}, {-5, 3}};
    static const int32_t parent[] = {-1, 0, 1, 2, 2, 4, 3, 5, 5};
    static const double radius[] = {0, 4, 2, 1.5, 1, 1, 0.5, 0.5, 0.25};
    vn_network *network = tree_of(9, xy, parent, radius);
    vn_levels levels;
    assert_ok(vn_network_levels(network, &levels));
    assert_false(levels.has_flow);
    assert_int_equal(levels.count, 3);
    assert_int_equal(levels.segments, 5);
    assert_int_equal(levels.levels[1].count, 2);
    assert_int_equal(levels.levels[2].count, 2);
    assert_near(levels.levels[0].diameter.mean, (8 * 1 + 4 * 2) / 3.0, 1e-12);
    assert_near(levels.levels[0].length.mean, 3, 0);
    double one = (3 * 3 + 1 * 2) / 5.0; // of the segment by node 3; the other has 2
    assert_near(levels.levels[1].diameter.mean, (one + 2) / 2, 1e-12);
    assert_near(levels.levels[1].diameter.deviation, (one - 2) / 2, 1e-12);
    assert_near(levels.levels[1].length.deviation, 0.5, 1e-12);
    assert_int_equal(levels.symmetry.count, 2);
    assert_near(levels.symmetry.min, 0.5, 0);
    assert_near(levels.symmetry.max, 1 / 1.5, 1e-15);
    assert_near(levels.angle.min, 90, 1e-12);
    assert_near(levels.angle.max, 180, 1e-12);
    assert_near(levels.slenderness.min, 9.0 / 16, 1e-12);
    assert_near(levels.slenderness.max, 5, 1e-12);
    vn_levels_free(&levels);
    vn_network_destroy(network);
}

static int32_t level_by_recursion(const vn_network *network, int32_t node) {
    int32_t parent = vn_network_parent(network)[node], children = 0;
    if (vn_network_parent(network)[parent] < 0) {
        return 0;
    }
    for (int32_t i = 0; i < vn_network_count(network); i++) {
        children += vn_network_parent(network)[i] == parent;
    }
    return level_by_recursion(network, parent) + (children > 1);
}

static void levels_are_what_recursion_says(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 20; seed++) {
        vn_network *network = random_network(seed, (int32_t)(seed % 5), 2, 0);
        vn_flow_def def = vn_flow_def_default();
        vn_flow_report report = solved(network, &def);
        double length[MOST_NODES] = {0}, total = 0;
        for (int32_t i = 0; i < vn_network_count(network); i++) {
            vn_pipe pipe;
            if (vn_pipe_get(network, i, &pipe)) {
                length[level_by_recursion(network, i)] += pipe.length;
            }
        }
        vn_levels levels;
        assert_ok(vn_network_levels(network, &levels));
        assert_true(levels.has_flow);
        for (int32_t k = 0; k < MOST_NODES; k++) {
            const vn_level *level = k < levels.count ? &levels.levels[k] : NULL;
            double sum = level != NULL ? level->count * level->length.mean : 0;
            assert_near(sum, length[k], 1e-9);
            total += level != NULL ? level->count : 0;
        }
        assert_near(total, levels.segments, 0);
        vn_levels_free(&levels);
        vn_flow_report_free(&report);
        vn_network_destroy(network);
    }
}

static void levels_of_nothing(void **state) {
    (void)state;
    vn_network *network = network_of(2);
    vn_levels levels;
    assert_ok(vn_network_levels(network, &levels));
    assert_int_equal(levels.count, 0);
    put_child(network, put_root(network, 0, 0, 0), 1, 0, 0); // no radii either
    assert_ok(vn_network_levels(network, &levels));
    assert_int_equal(levels.count, 1);
    assert_near(levels.levels[0].diameter.mean, 0, 0);
    assert_int_equal(levels.slenderness.count, 0);
    vn_levels_free(&levels);
    vn_network_destroy(network);
}

// ---- Memory ----

static void memory_that_runs_out_changes_nothing(void **state) {
    (void)state;
    vn_flow_def def = vn_flow_def_default();
    int64_t n = 0;
    for (vn_status status = VN_NO_MEMORY; status != VN_OK; n++) {
        vn_network *network = random_network(5, 10, 3, 0.2);
        vn_flow_report report;
        vn_levels levels = {0};
        vn_fail_allocations_from(n);
        status = vn_network_solve_flow(network, &def, &report);
        status = status == VN_OK ? vn_network_levels(network, &levels) : status;
        vn_fail_allocations_from(-1);
        assert_true(status == VN_OK || status == VN_NO_MEMORY);
        assert_true(report.terminals != NULL || vn_network_flow(network) == NULL);
        vn_flow_report_free(&report);
        vn_levels_free(&levels);
        vn_network_destroy(network);
    }
    assert_true(n > 20);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(audits_name_the_worst),
        counted_test(audits_find_what_is_missing),
        counted_test(veins_are_audited_too),
        counted_test(levels_by_hand),
        counted_test(levels_are_what_recursion_says),
        counted_test(levels_of_nothing),
        counted_test(memory_that_runs_out_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
