// Growth in space. Isogonic growth against scaling everything; uniform growth against what its definition
// says of every point.
#include "mesh_support.h"

#include "domain/voxels.h"

typedef enum solid { BALL, BOX, CUBE_OF_MESH, SURFACE, VOXELS, HOLLOW, SHELL, SOLIDS } solid;

static const double HERE[3] = {2, -1, 3}; ///< about which all of them are scaled

/// The coordinate of what is @p d from HERE along axis k.
static double off(int k, const double factor[3], double d) {
    return HERE[k] + factor[k] * d;
}

static vn_domain *stretched_box(const double f[3], double low, double high) {
    return solid_box(off(0, f, low), off(1, f, low), off(2, f, low), off(0, f, high), off(1, f, high),
                     off(2, f, high));
}

static vn_domain *of_mesh(mesh m, const double f[3], bool surface) {
    vn_domain *domain;
    for (int32_t i = 0; i < m.xyz.count; i++) {
        m.xyz.data[i] = off(i % 3, f, m.xyz.data[i]);
    }
    assert_ok(
        surface ? vn_domain_surface(&domain, m.xyz.data, m.xyz.count / 3, m.corners.data, m.corners.count / 3)
                : vn_domain_inside(&domain, m.xyz.data, m.xyz.count / 3, m.corners.data, m.corners.count / 3,
                                   true));
    free_mesh(&m);
    return domain;
}

// 10³ voxels; those of a corner are not set.
static vn_domain *of_voxels(const double f[3]) {
    static const int32_t size[3] = {10, 10, 10};
    double side[3], first[3];
    vn_volume volume;
    vn_domain *domain;
    vn_mask mask = {.dim = 3, .threshold = 0.5, .scale = 1, .parts = VN_PARTS_ALL, .what = "voxels"};
    for (int k = 0; k < 3; k++) {
        side[k] = f[k];
        first[k] = off(k, f, -4.5);
    }
    assert_ok(vn_volume_init(&volume, VN_VOXEL_U8, size, side, first));
    for (int32_t i = 0; i < 1000; i++) {
        ((uint8_t *)volume.data)[i] = i % 10 < 6 || i / 10 % 10 < 6 || i / 100 < 6;
    }
    assert_ok(vn_domain_voxels(&domain, &volume, &mask));
    return domain;
}

/// A domain about 10 across. Round ones take one factor for all axes.
static vn_domain *make(solid kind, const double f[3]) {
    vn_domain *whole, *hole, *domain = NULL;
    switch (kind) {
    case BALL:
        return ball_of(HERE[0], HERE[1], HERE[2], 5 * f[0]);
    case BOX:
        return stretched_box(f, -5, 4);
    case CUBE_OF_MESH:
        return of_mesh(box_mesh(-5, 4), f, false);
    case SURFACE:
        return of_mesh(globe(4, 5), f, true);
    case VOXELS:
        return of_voxels(f);
    case HOLLOW:
        whole = stretched_box(f, -5, 5);
        hole = ball_of(HERE[0], HERE[1], HERE[2], 3 * f[0]);
        assert_ok(vn_domain_combine(&domain, whole, hole, VN_DIFFERENCE));
        break;
    default:
        whole = stretched_box(f, -5, 5);
        hole = NULL;
        assert_ok(vn_domain_shell(&domain, &(vn_shell_def){whole, 2 * f[0]}));
    }
    vn_domain_release(whole);
    vn_domain_release(hole);
    return domain;
}

// ---- Isogonic ----

/// One organ: nothing moves and the unit shrinks, or the unit stays and all is scaled.
typedef struct organ {
    vn_network *network;
    vn_attractors *drains;
    vn_influence *influence;
    double scale, unit;
} organ;

enum { FROM = 10, STEP = 1, STEPS = 10 };

static organ organ_at(const double root[3], bool vessels) {
    organ o = {network_of(3), attractors_of(3, 5), NULL, 1, 1};
    put_root(o.network, root[0], root[1], root[2]);
    if (vessels) {
        vn_murray_def murray = vn_murray_def_default();
        murray.exponent = 2.55;
        murray.tip_radius = 0.01;
        assert_ok(vn_network_murray(o.network, &murray));
    }
    return o;
}

static void free_organ(organ *o) {
    vn_influence_destroy(o->influence);
    vn_attractors_destroy(o->drains);
    vn_network_destroy(o->network);
}

static void scale_columns(double *const columns[3], int32_t count, double by) {
    for (int k = 0; k < 3; k++) {
        for (int32_t i = 0; i < count; i++) {
            columns[k][i] = HERE[k] + by * (columns[k][i] - HERE[k]);
        }
    }
}

static void scale_about_here(organ *o, double to) {
    double by = to / o->scale;
    vn_attractors *a = o->drains;
    scale_columns((double *const[]){o->network->x.data, o->network->y.data, o->network->z.data},
                  o->network->x.count, by);
    scale_columns((double *const[]){a->x.data, a->y.data, a->z.data}, a->x.count, by);
    for (int32_t i = 0; i < a->x.count; i++) {
        a->best.data[i] *= (float)by;
    }
    for (int32_t i = 0; i < a->ties.count; i++) {
        a->ties.data[i].best *= (float)by;
    }
    o->network->moved++;
    o->network->version++;
    a->network_serial = 0; // what they remember is outdated
    a->version++;
    vn_point_grid_free(&a->grid);
    a->grid.cell = 0;
    o->scale = to;
}

static int32_t organ_step(organ *o, vn_domain *domain, bool vessels) {
    vn_influence_def find = vn_influence_def_default();
    vn_extend_def extend = vn_extend_def_default();
    vn_consume_def consume = vn_consume_def_default();
    int32_t added, first, consumed;
    find.within = vessels ? 6 * o->unit : 0;
    find.perception.angle = vessels ? 120 : 0;
    extend.length = o->unit;
    extend.domain = domain;
    extend.bifurcate = vessels ? 15 : 0;
    extend.bias = vessels ? 0.4 : 0;
    consume.distance = 1.1 * o->unit;
    assert_ok(vn_influence_find(&o->influence, o->drains, o->network, &find));
    assert_ok(vn_extend(o->network, o->influence, &extend, &added, &first));
    assert_ok(vn_consume(o->drains, o->network, &consume, &consumed));
    return added;
}

static void assert_same_organ(const organ *still, const organ *scaled) {
    const vn_network *a = still->network, *b = scaled->network;
    const double *from[3] = {a->x.data, a->y.data, a->z.data}, *to[3] = {b->x.data, b->y.data, b->z.data};
    assert_int_equal(vn_network_count(a), vn_network_count(b));
    assert_int_equal(vn_attractors_count(still->drains), vn_attractors_count(scaled->drains));
    assert_memory_equal(a->parent.data, b->parent.data, (size_t)vn_network_count(a) * sizeof(int32_t));
    for (int k = 0; k < 3; k++) {
        for (int32_t i = 0; i < vn_network_count(a); i++) {
            assert_near((to[k][i] - HERE[k]) / scaled->scale, from[k][i] - HERE[k], 1e-7);
        }
    }
}

static void throw_both(organ *still, organ *scaled, vn_domain *domain, vn_rng *rng) {
    vn_throw_def throw = {.domain = domain, .count = 12, .rng = rng};
    int32_t before = vn_attractors_count(still->drains), accepted;
    assert_ok(vn_throw(still->drains, &throw, &accepted));
    for (int32_t i = before; i < before + accepted; i++) {
        double p[3];
        assert_ok(vn_attractors_position(still->drains, i, p));
        put_attractor(scaled->drains, HERE[0] + scaled->scale * (p[0] - HERE[0]),
                      HERE[1] + scaled->scale * (p[1] - HERE[1]), HERE[2] + scaled->scale * (p[2] - HERE[2]));
    }
}

static vn_growth *isogonic_of(vn_domain *shape) {
    vn_growth_def def = vn_growth_def_default();
    vn_growth *growth;
    def.domain = shape;
    def.has_origin = true;
    memcpy(def.origin, HERE, sizeof HERE);
    def.from = FROM;
    def.to = FROM + STEPS * STEP;
    def.step = STEP;
    assert_ok(vn_growth_isogonic(&growth, &def));
    return growth;
}

// The shape is given at half the length it begins with, so that the growth has to scale it as well.
static void grow_both(solid kind, bool vessels) {
    static const double one[3] = {1, 1, 1};
    vn_domain *unscaled = make(kind, one);
    double half = 0.5 * FROM / (vn_domain_bounds(unscaled).max[1] - vn_domain_bounds(unscaled).min[1]);
    vn_domain *shape = make(kind, (double[3]){half, half, half});
    vn_growth *growth = isogonic_of(shape);
    vn_domain *still = vn_growth_domain(growth);
    vn_rng rng = vn_rng_make((uint64_t)kind);
    double root[3];
    assert_ok(vn_domain_dart(still, &rng, root));
    organ a = organ_at(root, vessels), b = organ_at(root, vessels);
    while (advance(growth)) {
        double size = vn_growth_length(growth) / FROM, f = 2 * half * size;
        vn_domain *scaled = make(kind, (double[3]){f, f, f});
        a.unit = vn_growth_unit(growth);
        scale_about_here(&a, 1); // both forget what they remember of distances
        scale_about_here(&b, size);
        throw_both(&a, &b, still, &rng);
        for (int k = 0; k < 2; k++) {
            assert_int_equal(organ_step(&a, still, vessels), organ_step(&b, scaled, vessels));
        }
        assert_same_organ(&a, &b);
        vn_domain_release(scaled);
    }
    assert_true(vn_network_count(a.network) > (vessels ? 20 : 40));
    free_organ(&a);
    free_organ(&b);
    vn_growth_release(growth);
    vn_domain_release(shape);
    vn_domain_release(unscaled);
}

static void shrinking_the_unit_is_scaling_every_solid(void **state) {
    (void)state;
    for (solid kind = BALL; kind < SOLIDS; kind++) {
        grow_both(kind, false);
        grow_both(kind, true);
    }
}

// ---- What a grown domain answers ----

static vn_growth *uniform_of(vn_domain *shape, const double factor[3], int32_t steps) {
    vn_uniform_def def = vn_uniform_def_default();
    vn_growth *growth;
    def.domain = shape;
    def.has_origin = true;
    memcpy(def.origin, HERE, sizeof HERE);
    def.x = factor[0];
    def.y = factor[1];
    def.z = factor[2];
    def.steps = steps;
    def.split = 0;
    assert_ok(vn_growth_uniform(&growth, &def));
    return growth;
}

static void random_point(const vn_domain *domain, vn_rng *rng, double p[3]) {
    vn_box box = vn_domain_bounds(domain);
    for (int k = 0; k < 3; k++) {
        double margin = 0.1 * (box.max[k] - box.min[k]);
        p[k] = uniform(rng, box.min[k] - margin, box.max[k] + margin);
    }
}

static void assert_same_answers(const vn_domain *a, const vn_domain *b, bool measured, vn_rng *rng) {
    vn_box of_a = vn_domain_bounds(a), of_b = vn_domain_bounds(b);
    for (int k = 0; k < 3; k++) {
        assert_near(of_a.min[k], of_b.min[k], 1e-9);
        assert_near(of_a.max[k], of_b.max[k], 1e-9);
    }
    double tolerance = measured ? 2e-3 : 1e-9; // of what points are counted for
    assert_near(vn_domain_measure(a) / vn_domain_measure(b), 1, tolerance);
    double p[3], q[3];
    random_point(a, rng, q);
    for (int i = 0; i < 500; i++) {
        random_point(a, rng, p);
        double distance = vn_domain_distance(b, p);
        assert_near(vn_domain_distance(a, p), distance, 1e-9);
        if (fabs(distance) > 1e-9) {
            assert_int_equal(vn_domain_contains(a, p), vn_domain_contains(b, p));
            assert_near(vn_domain_value(a, p), vn_domain_value(b, p), 0);
        }
        assert_int_equal(vn_domain_sees(a, p, q), vn_domain_sees(b, p, q));
        memcpy(q, p, sizeof q);
    }
}

static void scaled_solids_answer_as_those_made_so(void **state) {
    (void)state;
    static const double one[3] = {1, 1, 1};
    vn_rng rng = vn_rng_make(6);
    for (solid kind = BALL; kind < SOLIDS; kind++) {
        vn_domain *shape = make(kind, one);
        double f = FROM / (vn_domain_bounds(shape).max[1] - vn_domain_bounds(shape).min[1]);
        vn_domain *expected = make(kind, (double[3]){f, f, f});
        vn_growth *growth = isogonic_of(shape);
        bool counted = kind == HOLLOW || kind == SHELL;
        assert_same_answers(vn_growth_domain(growth), expected, counted, &rng);
        vn_growth_release(growth);
        vn_growth *even = uniform_of(shape, (double[3]){sqrt(f), sqrt(f), sqrt(f)}, 2);
        assert_true(advance(even) && advance(even) && !advance(even));
        assert_same_answers(vn_growth_domain(even), expected, counted, &rng);
        vn_growth_release(even);
        vn_domain_release(expected);
        vn_domain_release(shape);
    }
}

static const double UNEVEN[3] = {1.3, 0.8, 1.7};

// Boxes, meshes and voxels can be made at once as they are after a step.
static void stretched_boxes_and_meshes_are_exact(void **state) {
    (void)state;
    static const solid kinds[] = {BOX, CUBE_OF_MESH, SURFACE};
    static const double one[3] = {1, 1, 1};
    vn_rng rng = vn_rng_make(7);
    for (int i = 0; i < 3; i++) {
        vn_domain *shape = make(kinds[i], one), *expected = make(kinds[i], UNEVEN);
        vn_growth *growth = uniform_of(shape, UNEVEN, 1);
        assert_true(advance(growth));
        assert_same_answers(vn_growth_domain(growth), expected, false, &rng);
        assert_near(vn_growth_length(growth), vn_growth_final_length(growth), 1e-9);
        vn_growth_release(growth);
        vn_domain_release(expected);
        vn_domain_release(shape);
    }
}

static void back(const double q[3], double p[3]) {
    for (int k = 0; k < 3; k++) {
        p[k] = HERE[k] + (q[k] - HERE[k]) / UNEVEN[k];
    }
}

// The ellipsoid's border is near enough to one of many points of it.
static double to_ellipsoid(const double p[3]) {
    double least2 = INFINITY;
    for (int i = 0; i < 200; i++) {
        for (int j = 0; j < 400; j++) {
            double q[3], s = pi * (i + 0.5) / 200, t = 2 * pi * j / 400;
            set(q, HERE[0] + UNEVEN[0] * 5 * sin(s) * cos(t), HERE[1] + UNEVEN[1] * 5 * sin(s) * sin(t),
                HERE[2] + UNEVEN[2] * 5 * cos(s));
            least2 = fmin(least2, vn_distance2(p, q));
        }
    }
    return sqrt(least2);
}

static void a_stretched_balls_distance_is_never_too_long(void **state) {
    (void)state;
    vn_domain *ball = make(BALL, (double[3]){1, 1, 1});
    vn_growth *growth = uniform_of(ball, UNEVEN, 1);
    vn_domain *egg = vn_growth_domain(growth);
    vn_rng rng = vn_rng_make(3);
    assert_true(advance(growth));
    assert_near(vn_domain_measure(egg), 4 * pi / 3 * 125 * UNEVEN[0] * UNEVEN[1] * UNEVEN[2], 1e-9 * 1000);
    for (int i = 0; i < 60; i++) {
        double p[3], q[3], r[3];
        random_point(egg, &rng, p);
        double distance = fabs(vn_domain_distance(egg, p)), truth = to_ellipsoid(p);
        assert_true(distance <= truth + 1e-9);
        assert_true(distance >= truth * UNEVEN[1] / UNEVEN[2] - 0.06); // the oracle's points are 0.1 apart
        vn_domain_closest(egg, p, q);
        back(q, r);
        assert_near(sqrt(vn_distance2(r, HERE)), 5, 1e-9);
    }
    vn_growth_release(growth);
    vn_domain_release(ball);
}

static void stretched_solids_contain_see_and_sample_what_they_did(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(11);
    for (solid kind = BALL; kind < SOLIDS; kind++) {
        vn_domain *shape = make(kind, (double[3]){1, 1, 1});
        vn_growth *growth = uniform_of(shape, UNEVEN, 1);
        vn_domain *today = vn_growth_domain(growth);
        assert_true(advance(growth));
        double p[3], q[3], r[3], last[3] = {0}, sum[3] = {0}, was[3] = {0};
        for (int i = 0; i < 4000 && kind != SURFACE; i++) {
            random_point(today, &rng, p);
            back(p, q);
            back(last, r);
            if (fabs(vn_domain_distance(shape, q)) > 1e-9) {
                assert_int_equal(vn_domain_contains(today, p), vn_domain_contains(shape, q));
            }
            assert_int_equal(vn_domain_sees(today, p, last), vn_domain_sees(shape, q, r));
            memcpy(last, p, sizeof last);
        }
        for (int i = 0; i < 4000; i++) {
            assert_ok(vn_domain_dart(today, &rng, p));
            assert_ok(vn_domain_dart(shape, &rng, q));
            assert_true(vn_domain_contains(today, p));
            for (int k = 0; k < 3; k++) {
                sum[k] += (p[k] - HERE[k]) / UNEVEN[k] / 4000;
                was[k] += (q[k] - HERE[k]) / 4000;
            }
        }
        for (int k = 0; k < 3 && kind != SURFACE; k++) {
            assert_near(sum[k], was[k], 4 * 5 * sqrt(2.0 / 4000)); // a coordinate deviates by less than 5
        }
        vn_growth_release(growth);
        vn_domain_release(shape);
    }
}

// ---- What lies in the tissue ----

static void nodes_and_attractors_move_along(void **state) {
    (void)state;
    vn_domain *ball = make(BALL, (double[3]){1, 1, 1});
    vn_growth *growth = uniform_of(ball, UNEVEN, 3);
    vn_network *network = random_tree(3, 300, 2, 8);
    vn_attractors *drains = attractors_of(3, 0);
    double before[3][300];
    const double *columns[3] = {network->x.data, network->y.data, network->z.data};
    for (int k = 0; k < 3; k++) {
        memcpy(before[k], columns[k], sizeof before[k]);
    }
    for (int32_t i = 0; i < 300; i++) {
        put_attractor(drains, before[0][i], before[1][i], before[2][i]);
    }
    for (int32_t t = 1; advance(growth); t++) {
        assert_ok(vn_growth_carry(growth, network));
        assert_ok(vn_growth_carry(growth, network)); // once a step
        assert_ok(vn_attractors_carry(drains, growth));
        for (int32_t i = 0; i < 300; i++) {
            double p[3], q[3], start[3] = {before[0][i], before[1][i], before[2][i]};
            assert_ok(vn_attractors_position(drains, i, p));
            assert_ok(vn_growth_map(growth, start, 0, t, q));
            for (int k = 0; k < 3; k++) {
                double expected = HERE[k] + (start[k] - HERE[k]) * pow(UNEVEN[k], t);
                assert_near(columns[k][i], expected, 1e-9 * (1 + fabs(expected)));
                assert_near(p[k], expected, 1e-9 * (1 + fabs(expected)));
                assert_near(q[k], expected, 1e-9 * (1 + fabs(expected)));
            }
        }
    }
    vn_attractors_destroy(drains);
    vn_network_destroy(network);
    vn_growth_release(growth);
    vn_domain_release(ball);
}

static void stretched_edges_are_split_in_space(void **state) {
    (void)state;
    vn_domain *ball = make(BALL, (double[3]){1, 1, 1});
    vn_uniform_def def = vn_uniform_def_default();
    vn_growth *growth;
    vn_network *network = network_of(3);
    put_child(network, put_root(network, 0, 0, 0), 0, 0, 1);
    def = (vn_uniform_def){
        .domain = ball, .has_origin = true, .x = 1, .y = 1, .z = 3.5, .steps = 1, .split = 1};
    assert_ok(vn_growth_uniform(&growth, &def));
    assert_true(advance(growth));
    assert_ok(vn_growth_carry(growth, network));
    assert_int_equal(vn_network_count(network), 5);
    assert_near(network->z.data[1], 3.5, 1e-12);
    vn_network_destroy(network);
    vn_growth_release(growth);
    vn_domain_release(ball);
}

// ---- Refused ----

static void what_cannot_grow_in_space_says_so(void **state) {
    (void)state;
    static const double flat[] = {0, 0, 0, 1, 0, 0, 0, 0, 1};
    static const int32_t corners[] = {0, 1, 2};
    vn_domain *ball = ball_of(0, 0, 0, 1), *disk = disk_of(0, 0, 1), *floor_of;
    vn_growth *growth;
    vn_growth_def def = vn_growth_def_default();
    assert_ok(vn_domain_surface(&floor_of, flat, 3, corners, 1));
    def.domain = ball;
    assert_int_equal(vn_growth_marginal(&growth, &def), VN_INVALID);
    assert_message("marginal.domain has 3 dimensions, and this growth is of the plane: use");
    vn_rerg_def rerg = vn_rerg_def_default();
    rerg.domain = ball;
    assert_int_equal(vn_growth_rerg(&growth, &rerg), VN_INVALID);
    assert_message("rerg.domain has 3 dimensions");
    def.domain = floor_of;
    assert_int_equal(vn_growth_isogonic(&growth, &def), VN_INVALID);
    assert_message("isogonic.domain is flat across y");
    assert_int_equal(vn_growth_marginal(&growth, &def), VN_INVALID);
    assert_message("marginal.domain is a surface");
    assert_ok(vn_growth_none(&growth, &def));
    assert_true(vn_domain_bounds(vn_growth_domain(growth)).max[0] == 1);
    vn_growth_release(growth);
    vn_uniform_def uniform = vn_uniform_def_default();
    uniform.domain = disk;
    uniform.z = 2;
    assert_int_equal(vn_growth_uniform(&growth, &uniform), VN_INVALID);
    assert_message("uniform.z = 2: the domain is flat");
    uniform.domain = ball;
    uniform.z = 1e6;
    assert_ok(vn_growth_uniform(&growth, &uniform));
    vn_network *network = network_of(2);
    put_root(network, 0, 0, 0);
    bool growing = true;
    for (int i = 0; i < 9; i++) {
        assert_ok(vn_growth_advance(growth, &growing));
    }
    assert_int_equal(vn_growth_carry(growth, network), VN_INVALID);
    assert_message("a network of 2 dimensions in a solid blade whose tissue moves");
    assert_int_equal(vn_growth_advance(growth, &growing), VN_OK);
    assert_int_equal(vn_growth_advance(growth, &growing), VN_INFEASIBLE);
    assert_message("uniform: at step 11 the shape is from -1e+66 to 1e+66 along z, out of range");
    vn_network_destroy(network);
    vn_growth_release(growth);
    vn_domain_release(floor_of);
    vn_domain_release(disk);
    vn_domain_release(ball);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(shrinking_the_unit_is_scaling_every_solid),
        counted_test(scaled_solids_answer_as_those_made_so),
        counted_test(stretched_boxes_and_meshes_are_exact),
        counted_test(a_stretched_balls_distance_is_never_too_long),
        counted_test(stretched_solids_contain_see_and_sample_what_they_did),
        counted_test(nodes_and_attractors_move_along),
        counted_test(stretched_edges_are_split_in_space),
        counted_test(what_cannot_grow_in_space_says_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
