// Arterial trees that cannot be: what is asked for wrongly, what does not fit, and memory that runs out.
#include "cco_support.h"

static vn_cco_def organ_def(vn_domain *domain) {
    vn_cco_def def = vn_cco_def_default();
    def.domain = domain;
    def.terminals = 20;
    return def;
}

static void check_def(const vn_cco_def *def, vn_status status, const char *message) {
    vn_cco *cco;
    assert_int_equal(vn_cco_create(&cco, def), status);
    assert_null(cco);
    assert_message(message);
}

static void organs(void **state) {
    (void)state;
    vn_domain *disk = disk_of(0, 0, 10);
    vn_cco_def def = organ_def(NULL);
    check_def(&def, VN_INVALID, "cco: `domain` is missing");
    def = organ_def(disk);
    def.terminals = 0;
    check_def(&def, VN_INVALID, "cco.terminals");
    def = organ_def(disk);
    def.threshold = 1;
    check_def(&def, VN_INVALID, "cco.threshold");
    def.threshold = NAN;
    check_def(&def, VN_INVALID, "cco.threshold");
    def = organ_def(disk);
    def.spacing = 0;
    check_def(&def, VN_INVALID, "cco.spacing");
    def = organ_def(disk);
    def.candidates = 0;
    check_def(&def, VN_INVALID, "cco.candidates");
    def = organ_def(disk);
    def.border_distance = -1;
    check_def(&def, VN_INVALID, "cco.border_distance");
    vn_domain_release(disk);
}

static void lists(void **state) {
    (void)state;
    vn_domain *disk = disk_of(0, 0, 10);
    const double outside[] = {0, 0, 0, 9, 9, 0}, nowhere[] = {NAN, 0, 0}, twice[] = {0, 0, 0, 0, 0, 0};
    vn_cco_def def = organ_def(disk);
    vn_cco_tree_def one = vn_cco_tree_def_default();
    int32_t added;
    vn_cco *cco;
    def.list = outside;
    def.list_count = 2;
    check_def(&def, VN_INVALID, "number 2 at (9, 9, 0) is outside the domain");
    def.list = nowhere;
    def.list_count = 1;
    check_def(&def, VN_INVALID, "number 1");
    def.list = twice;
    def.list_count = 2;
    assert_ok(vn_cco_create(&cco, &def));
    one.root[1] = 10;
    one.inflow = 1;
    add_tree(cco, &one);
    assert_int_equal(vn_cco_stage(cco, NULL, 1), VN_INVALID);
    assert_message("the terminals are a list already");
    assert_int_equal(vn_cco_grow(cco, 2, &added), VN_INFEASIBLE);
    assert_message("terminal 2 of the list, at (0, 0, 0), cannot be connected");
    assert_int_equal(added, 1);
    vn_cco_destroy(cco);
    vn_domain_release(disk);
}

// A list of none, and a terminal at the root itself.
static void empty_lists(void **state) {
    (void)state;
    vn_domain *disk = disk_of(0, 0, 10);
    const double root[] = {1, 2, 0};
    vn_cco_def def = organ_def(disk);
    vn_cco_tree_def one = vn_cco_tree_def_default();
    int32_t added;
    vn_cco *cco;
    def.list = root;
    def.list_count = 1;
    assert_ok(vn_cco_create(&cco, &def));
    one.root[0] = 1;
    one.root[1] = 2;
    add_tree(cco, &one);
    assert_int_equal(vn_cco_grow(cco, 1, &added), VN_INFEASIBLE);
    vn_cco_destroy(cco);
    def.list_count = 0;
    check_def(&def, VN_INVALID, "cco.terminals");
    def.list_count = -1;
    check_def(&def, VN_INVALID, "cco.terminals");
    vn_domain_release(disk);
}

static void check_tree_def(vn_cco *cco, const vn_cco_tree_def *def, vn_status status, const char *message) {
    int32_t tree;
    assert_int_equal(vn_cco_add(cco, def, &tree), status);
    assert_int_equal(tree, -1);
    assert_message(message);
}

static void trees(void **state) {
    (void)state;
    vn_domain *disk = disk_of(0, 0, 10);
    vn_cco *cco = organ_of(disk, 20, 1);
    vn_cco_tree_def good = vn_cco_tree_def_default(), def = good;
    int32_t added;
    assert_int_equal(vn_cco_grow(cco, 1, &added), VN_INVALID);
    assert_message("there is no tree to grow");
    def.root[0] = 11;
    check_tree_def(cco, &def, VN_INVALID, "cco.root at (11, 0, 0) is outside the domain, 1 from its border");
    def.root[0] = NAN;
    check_tree_def(cco, &def, VN_INVALID, "cco.root");
    def = good;
    def.pressure_out = def.pressure_in;
    check_tree_def(cco, &def, VN_INVALID, "must be above pressure_out");
    def.pressure_in = NAN;
    check_tree_def(cco, &def, VN_INVALID, "cco.pressure_in");
    const double inflows[] = {0, -1, NAN, INFINITY};
    for (int i = 0; i < 4; i++) {
        def = good;
        def.inflow = inflows[i];
        check_tree_def(cco, &def, VN_INVALID, "cco.inflow");
        def = good;
        def.viscosity = inflows[i];
        check_tree_def(cco, &def, VN_INVALID, "cco.viscosity");
        if (i > 0) {
            def = good;
            def.terminal_flow = inflows[i];
            check_tree_def(cco, &def, VN_INVALID, "cco.terminal_flow");
        }
    }
    const double exponents[] = {0.5, 1e9, NAN};
    for (int i = 0; i < 3; i++) {
        def = good;
        def.exponent = exponents[i];
        check_tree_def(cco, &def, VN_INVALID, "must be between 1 and 100");
    }
    def = good;
    def.exponents = (double[]){1, 3, 1, 2.5};
    def.exponent_count = 2;
    check_tree_def(cco, &def, VN_INVALID, "the flow 1 mm³/s of a pair must be above the one before");
    def.exponents = (double[]){0, 3};
    def.exponent_count = 1;
    check_tree_def(cco, &def, VN_INVALID, "cco.exponent: the flow 0");
    def = good;
    def.symmetry = 1.5;
    check_tree_def(cco, &def, VN_INVALID, "cco.symmetry");
    assert_int_equal(vn_cco_tree_count(cco), 0);
    vn_cco_destroy(cco);
    vn_domain_release(disk);
}

static void roots_in_vessels(void **state) {
    (void)state;
    vn_domain *disk = disk_of(0, 0, 10);
    vn_cco *cco = organ_of(disk, 20, 1);
    vn_cco_tree_def def = vn_cco_tree_def_default();
    int32_t added;
    def.inflow = 10;
    def.root[1] = 10;
    add_tree(cco, &def);
    check_tree_def(cco, &def, VN_INVALID, "is in a vessel of another tree");
    assert_ok(vn_cco_grow(cco, 5, &added));
    vn_network *n = network_at(cco, 0);
    vn_network_position(n, 1, def.root);
    check_tree_def(cco, &def, VN_INVALID, "is in a vessel of another tree");
    vn_network_destroy(n);
    vn_cco_destroy(cco);
    vn_domain_release(disk);
}

static void check_from(vn_cco *cco, vn_network *from, const char *message) {
    vn_cco_tree_def def = vn_cco_tree_def_default();
    def.from = from;
    check_tree_def(cco, &def, VN_INVALID, message);
    vn_network_destroy(from);
}

static void networks(void **state) {
    (void)state;
    vn_domain *disk = disk_of(0, 0, 10), *ball = ball_of(0, 0, 0, 10);
    vn_cco *cco = organ_of(disk, 20, 1);
    vn_network *n = network_of(3);
    put_child(n, put_root(n, 0, 0, 0), 1, 0, 0);
    assert_int_equal(vn_cco_avoid(cco, n), VN_INVALID);
    assert_message("cco.avoid has 3 dimensions, and the domain 2");
    check_from(cco, n, "cco.from has 3 dimensions, and the domain 2");
    n = network_of(2);
    check_from(cco, n, "cco.from has 0 nodes");
    n = network_of(2);
    put_root(n, 0, 0, 0);
    check_from(cco, n, "cco.from has 1 nodes: it needs at least one segment");
    n = network_of(2);
    put_child(n, put_root(n, 1, 1, 0), 1, 1, 0);
    check_from(cco, n, "nodes 1 and 0 lie at the same point (1, 1, 0)");
    n = network_of(2);
    put_child(n, put_child(n, put_root(n, 0, 0, 0), 1, 0, 0), 1, 1, 0);
    assert_ok(vn_network_join(n, 0, 2, 0.1));
    check_from(cco, n, "cco.from has 1 joins");
    assert_int_equal(vn_cco_stage(cco, NULL, 5), VN_INVALID);
    assert_message("add the trees first");
    vn_cco_tree_def one = vn_cco_tree_def_default();
    one.root[1] = 10;
    add_tree(cco, &one);
    assert_int_equal(vn_cco_stage(cco, ball, 5), VN_INVALID);
    assert_message("the part has 3 dimensions, and the domain 2");
    assert_int_equal(vn_cco_stage(cco, NULL, 0), VN_INVALID);
    assert_message("it needs 1 terminal or more");
    vn_cco_tree_def def = vn_cco_tree_def_default();
    def.inflow = 1;
    add_tree(cco, &def);
    assert_int_equal(vn_cco_stage(cco, NULL, 21), VN_INVALID);
    assert_message("21 terminals more than the 0 there are, and cco.terminals = 20 in all");
    vn_cco_destroy(cco);
    vn_domain_release(disk);
    vn_domain_release(ball);
}

static vn_status constant(double *value, const double p[3], void *payload) {
    (void)p;
    *value = *(const double *)payload;
    return VN_OK;
}

static vn_status failing(double *value, const double p[3], void *payload) {
    (void)p;
    (void)payload;
    *value = 1;
    return vn_fail(VN_CALLBACK, "nobody knows");
}

static void callbacks(void **state) {
    (void)state;
    vn_domain *disk = disk_of(0, 0, 10);
    vn_cco_def def = organ_def(disk);
    vn_cco_tree_def one = vn_cco_tree_def_default();
    double values[] = {1.5, NAN, -1, 0};
    static const struct {
        vn_status status;
        const char *message;
    } refusals[] = {{VN_INVALID, "cco.density is 1.5 at ("},
                    {VN_INVALID, "cco.density is "},
                    {VN_INVALID, "cco.density is -1 at ("},
                    {VN_INFEASIBLE, "the density is 0 all over"},
                    {VN_CALLBACK, "nobody knows"}};
    int32_t added;
    vn_cco *cco;
    one.inflow = 10;
    for (int i = 0; i < 5; i++) {
        def.density = i < 4 ? constant : failing;
        def.density_payload = &values[i % 4];
        assert_ok(vn_cco_create(&cco, &def));
        check_tree_def(cco, &one, refusals[i].status, refusals[i].message);
        vn_cco_destroy(cco);
    }
    def.density = NULL;
    for (int i = 1; i < 5; i++) {
        one.flow = i < 4 ? constant : failing;
        one.flow_payload = &values[i % 4];
        assert_ok(vn_cco_create(&cco, &def));
        add_tree(cco, &one);
        assert_int_equal(vn_cco_grow(cco, 1, &added), i < 4 ? VN_INVALID : VN_CALLBACK);
        assert_message(i < 4 ? "cco.terminal_flow: a terminal at (" : "nobody knows");
        assert_int_equal(added, 0);
        vn_cco_destroy(cco);
    }
    vn_domain_release(disk);
}

static vn_status until_told(double *value, const double p[3], void *payload) {
    (void)p;
    *value = 1;
    return *(const bool *)payload ? vn_fail(VN_CALLBACK, "no more") : VN_OK;
}

// What a stage that fails leaves behind can still be grown in: the part before, which only the organ holds.
static void a_stage_that_fails(void **state) {
    (void)state;
    vn_domain *disk = disk_of(0, 0, 10), *upper = box_of(-10, 0, 10, 10), *lower = box_of(-10, -10, 10, 0);
    bool fail = false;
    vn_cco_def def = organ_def(disk);
    vn_cco_tree_def one = vn_cco_tree_def_default();
    int32_t added;
    vn_cco *cco;
    def.density = until_told;
    def.density_payload = &fail;
    def.spacing = 0.3;
    one.inflow = 0.1;
    assert_ok(vn_cco_create(&cco, &def));
    one.root[1] = 10;
    add_tree(cco, &one);
    one.root[0] = 2;
    one.root[1] = 9.7;
    add_tree(cco, &one);
    assert_ok(vn_cco_stage(cco, upper, 2));
    vn_domain_release(upper);
    assert_ok(vn_cco_grow(cco, 1, &added));
    fail = true;
    assert_int_equal(vn_cco_stage(cco, lower, 4), VN_CALLBACK);
    fail = false;
    assert_ok(vn_cco_grow(cco, 1, &added));
    vn_cco_destroy(cco);
    vn_domain_release(lower);
    vn_domain_release(disk);
}

static void an_organ_too_small(void **state) {
    (void)state;
    vn_domain *domains[] = {disk_of(0, 0, 5), ball_of(0, 0, 0, 2)};
    for (int i = 0; i < 2; i++) {
        vn_cco *cco = organ_of(domains[i], 400, 3);
        vn_cco_tree_def def = vn_cco_tree_def_default();
        laws l = laws_default();
        int32_t added;
        def.root[1] = top_of(domains[i]);
        def.inflow = i == 0 ? 20000 : 5000;
        add_tree(cco, &def);
        assert_int_equal(vn_cco_grow(cco, 400, &added), VN_INFEASIBLE);
        print_message("%s\n", vn_message());
        char number[64];
        snprintf(number, sizeof number, "terminal %d of 400", added + 1);
        assert_message(number);
        assert_false(vn_cco_done(cco));
        assert_int_equal(vn_cco_report_of(cco, 0).terminals, added);
        vn_network *n = network_at(cco, 0);
        l.inflow = def.inflow * added / 400;
        if (added > 0) {
            check_laws(n, domains[i], &l);
        }
        vn_network_destroy(n);
        vn_cco_destroy(cco);
        vn_domain_release(domains[i]);
    }
}

// Everything from the first call to the network.
static vn_status small_run(vn_domain *disk, vn_network **out) {
    vn_cco_def def = organ_def(disk);
    vn_cco_tree_def one = vn_cco_tree_def_default();
    vn_cco *cco;
    int32_t added, tree;
    *out = NULL;
    def.spacing = 0.3; // near ones: far ones lie behind the other tree
    one.root[1] = 10;
    one.inflow = 1;
    vn_status status = vn_cco_create(&cco, &def);
    status = status == VN_OK ? vn_cco_add(cco, &one, &tree) : status;
    one.root[0] = 2;
    one.root[1] = 9.7;
    status = status == VN_OK ? vn_cco_add(cco, &one, &tree) : status;
    status = status == VN_OK ? vn_cco_stage(cco, NULL, 12) : status;
    status = status == VN_OK ? vn_cco_grow(cco, 20, &added) : status;
    status = status == VN_OK ? vn_cco_network(cco, 0, out) : status;
    vn_cco_destroy(cco);
    return status;
}

static void memory_runs_out(void **state) {
    (void)state;
    vn_domain *disk = disk_of(0, 0, 10);
    size_t before = vn_byte_count();
    vn_status status = VN_NO_MEMORY;
    int64_t nth = 0;
    for (; status != VN_OK && nth < 100000; nth++) {
        vn_network *n;
        vn_fail_allocations_from(nth);
        status = small_run(disk, &n);
        vn_fail_allocations_from(-1);
        if (status != VN_OK && status != VN_NO_MEMORY) {
            fail_msg("allocation %d: %s", (int)nth, vn_message());
        }
        assert_int_equal(n != NULL, status == VN_OK);
        vn_network_destroy(n);
        assert_int_equal(vn_byte_count(), before);
    }
    print_message("%d allocations\n", (int)nth - 1);
    assert_true(nth > 20);
    vn_domain_release(disk);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(organs),
        counted_test(lists),
        counted_test(empty_lists),
        counted_test(trees),
        counted_test(roots_in_vessels),
        counted_test(networks),
        counted_test(callbacks),
        counted_test(a_stage_that_fails),
        counted_test(an_organ_too_small),
        counted_test(memory_runs_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
