// Runions §3.3: "for computational efficiency, instead of scaling up the leaf, we scale down the unit
// distance". The same leaf grown both ways is the same leaf.

#include "support.h"

enum { STEPS = 40, TRIES = 30 };

static const double FROM = 24, STEP = 2;

/// One leaf. In one of them nothing moves and the unit shrinks, in the other the unit stays and all is
/// scaled.
typedef struct leaf {
    vn_network *network;
    vn_attractors *auxin;
    vn_influence *influence;
    double scale; ///< of its coordinates against those at first
    double unit;
    int mode;
} leaf;

static leaf make_leaf(int mode) {
    leaf l = {network_of(2), attractors_of(2, 7), NULL, 1, 1, mode};
    put_root(l.network, 0, -FROM / 2, 0);
    return l;
}

static void free_leaf(leaf *l) {
    vn_influence_destroy(l->influence);
    vn_attractors_destroy(l->auxin);
    vn_network_destroy(l->network);
}

static void scale_leaf(leaf *l, double factor) {
    assert_ok(vn_network_scale(l->network, factor));
    for (int32_t i = 0; i < l->auxin->x.count; i++) {
        l->auxin->x.data[i] *= factor;
        l->auxin->y.data[i] *= factor;
        l->auxin->best.data[i] *= (float)factor;
    }
    for (int32_t i = 0; i < l->auxin->ties.count; i++) {
        l->auxin->ties.data[i].best *= (float)factor;
    }
    l->auxin->network_serial = 0; // what they remember is outdated
    vn_point_grid_free(&l->auxin->grid);
    l->auxin->grid.cell = 0;
    l->scale *= factor;
}

static bool is_free(const leaf *l, const double p[3], double clearance) {
    double q[3];
    for (int32_t i = 0; i < vn_attractors_count(l->auxin); i++) {
        assert_ok(vn_attractors_position(l->auxin, i, q));
        if (hypot(p[0] - q[0], p[1] - q[1]) <= clearance) {
            return false;
        }
    }
    for (int32_t i = 0; i < vn_network_count(l->network); i++) {
        if (hypot(p[0] - vn_network_x(l->network)[i], p[1] - vn_network_y(l->network)[i]) <= clearance) {
            return false;
        }
    }
    return true;
}

// The same places in the tissue for both leaves; what is free in one is free in the other.
static void throw_sources(leaf *a, leaf *b, vn_rng *rng) {
    for (int k = 0; k < TRIES; k++) {
        double angle = uniform(rng, 0, 6.283185307179586), r = FROM / 2 * sqrt(uniform(rng, 0, 1));
        double x = r * cos(angle), y = r * sin(angle);
        double p[3] = {x * a->scale, y * a->scale, 0}, q[3] = {x * b->scale, y * b->scale, 0};
        bool free = is_free(a, p, 2.5 * a->unit);
        assert_int_equal(free, is_free(b, q, 2.5 * b->unit));
        if (free) {
            put_attractor(a->auxin, p[0], p[1], 0);
            put_attractor(b->auxin, q[0], q[1], 0);
        }
    }
}

static int32_t vein_step(leaf *l) {
    bool closed = l->mode != 0;
    vn_influence_def find = {.mode = l->mode};
    vn_extend_def extend = {.length = l->unit, .meet = closed ? VN_MEET_JOIN : VN_MEET_CROSS};
    vn_consume_def consume = {.distance = l->unit, .mode = closed ? VN_CONSUME_TAGGED : VN_CONSUME_ANY};
    int32_t added, first, consumed;
    assert_ok(vn_influence_find(&l->influence, l->auxin, l->network, &find));
    assert_ok(vn_extend(l->network, l->influence, &extend, &added, &first));
    assert_ok(vn_consume(l->auxin, l->network, &consume, &consumed));
    return added;
}

static void assert_same_leaf(const leaf *a, const leaf *b) {
    int32_t count = vn_network_count(a->network);
    assert_int_equal(count, vn_network_count(b->network));
    assert_int_equal(vn_attractors_count(a->auxin), vn_attractors_count(b->auxin));
    assert_int_equal(vn_network_join_count(a->network), vn_network_join_count(b->network));
    assert_memory_equal(vn_network_parent(a->network), vn_network_parent(b->network),
                        (size_t)count * sizeof(int32_t));
    for (int32_t i = 0; i < count; i++) {
        assert_near(vn_network_x(a->network)[i] / a->scale, vn_network_x(b->network)[i] / b->scale, 1e-7);
        assert_near(vn_network_y(a->network)[i] / a->scale, vn_network_y(b->network)[i] / b->scale, 1e-7);
    }
}

static void grow_both(int mode, uint64_t seed) {
    leaf shrinking = make_leaf(mode), scaled = make_leaf(mode);
    vn_domain *disk = disk_of(0, 0, FROM / 2);
    vn_growth_def def = vn_growth_def_default();
    vn_growth *growth;
    vn_rng rng = vn_rng_make(seed);
    bool growing = true;
    def.domain = disk;
    def.from = FROM;
    def.to = FROM + STEPS * STEP;
    def.step = STEP;
    assert_ok(vn_growth_isogonic(&growth, &def));
    while (assert_ok(vn_growth_advance(growth, &growing)), growing) {
        shrinking.unit = vn_growth_unit(growth);
        scale_leaf(&scaled, vn_growth_length(growth) / FROM / scaled.scale);
        throw_sources(&shrinking, &scaled, &rng);
        for (int k = 0; k < 2; k++) {
            assert_int_equal(vein_step(&shrinking), vein_step(&scaled));
        }
        assert_same_leaf(&shrinking, &scaled);
    }
    assert_true(vn_network_count(shrinking.network) > 500);
    assert_true(mode == 0 || vn_network_join_count(shrinking.network) > 10);
    vn_growth_release(growth);
    vn_domain_release(disk);
    free_leaf(&shrinking);
    free_leaf(&scaled);
}

static void shrinking_the_unit_is_scaling_everything(void **state) {
    (void)state;
    for (int k = 0; k < 6; k++) {
        grow_both(k % 3, (uint64_t)k);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {counted_test(shrinking_the_unit_is_scaling_everything)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
