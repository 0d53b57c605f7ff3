// Networks as voxels: nothing that hangs together breaks, every voxel is where the plain rule puts it, and
// files say what the volume holds.

#include "support.h"

#include "draw/tubes.h"
#include "network/network.h"

#include <unistd.h>
#include <zlib.h>

// ---- helpers

static vn_volume *voxels_of(const vn_voxels_def *def) {
    vn_volume *volume = NULL;
    assert_ok(vn_voxelize(&volume, def));
    return volume;
}

static vn_voxels_def def_of(const vn_network *network, int content, double resolution) {
    vn_voxels_def def = vn_voxels_def_default();
    def.network = network;
    def.content = content;
    def.resolution = resolution;
    return def;
}

static vn_volume *quick_voxels(const vn_network *network, int content, double resolution) {
    vn_voxels_def def = def_of(network, content, resolution);
    return voxels_of(&def);
}

static size_t voxel_count(const vn_volume *volume) {
    return (size_t)volume->size[0] * (size_t)volume->size[1] * (size_t)volume->size[2];
}

static void give_radii(vn_network *network, vn_rng *rng, double low, double high) {
    int32_t count = vn_network_count(network);
    double *radius = malloc(((size_t)count + 1) * sizeof *radius);
    assert_non_null(radius);
    for (int32_t i = 0; i < count; i++) {
        radius[i] = low + (high - low) * pow(uniform(rng, 0, 1), 3);
    }
    assert_ok(vn_network_set_radii(network, radius));
    free(radius);
}

static void spread(const vn_volume *volume, int32_t *part, int32_t *stack, int32_t at, int32_t number) {
    int32_t top = 0;
    stack[top++] = at;
    part[at] = number;
    while (top > 0) {
        int32_t index = stack[--top];
        int32_t x = index % volume->size[0], y = index / volume->size[0] % volume->size[1],
                z = index / volume->size[0] / volume->size[1];
        for (int32_t k = 0; k < 27; k++) {
            int32_t i = x + k % 3 - 1, j = y + k / 3 % 3 - 1, l = z + k / 9 - 1;
            if (i < 0 || j < 0 || l < 0 || i >= volume->size[0] || j >= volume->size[1] ||
                l >= volume->size[2]) {
                continue;
            }
            int32_t next = i + volume->size[0] * (j + volume->size[1] * l);
            if (part[next] == 0 && vn_volume_at(volume, (size_t)next) != 0) {
                part[next] = number;
                stack[top++] = next;
            }
        }
    }
}

// How many 26-connected parts (8-connected ones of a flat volume) the voxels that are not 0 have.
static int32_t count_parts(const vn_volume *volume) {
    size_t voxels = voxel_count(volume);
    int32_t *part = calloc(voxels, sizeof *part), *stack = malloc(voxels * sizeof *stack), parts = 0;
    if (part == NULL || stack == NULL) {
        abort();
    }
    for (size_t i = 0; i < voxels; i++) {
        if (part[i] == 0 && vn_volume_at(volume, i) != 0) {
            spread(volume, part, stack, (int32_t)i, ++parts);
        }
    }
    free(part);
    free(stack);
    return parts;
}

typedef struct edge {
    double a[3], b[3], radius;
} edge;

static int32_t edges_of(const vn_network *network, edge *edges) {
    int32_t count = 0;
    for (int32_t i = 0; i < vn_network_count(network); i++) {
        int32_t parent = vn_network_parent(network)[i];
        if (parent >= 0 || vn_network_first_child(network, i) < 0) {
            vn_network_position(network, parent >= 0 ? parent : i, edges[count].a);
            vn_network_position(network, i, edges[count].b);
            edges[count++].radius = vn_network_radius(network, i);
        }
    }
    for (int32_t j = 0; j < vn_network_join_count(network); j++) {
        int32_t a, b;
        vn_network_join_ends(network, j, &a, &b, &edges[count].radius);
        vn_network_position(network, a, edges[count].a);
        vn_network_position(network, b, edges[count++].b);
    }
    return count;
}

// In the world, unlike the engine's.
static double distance_from(const edge *e, const double p[3]) {
    double along = 0, square = 0, rest = 0;
    for (int k = 0; k < 3; k++) {
        along += (p[k] - e->a[k]) * (e->b[k] - e->a[k]);
        square += (e->b[k] - e->a[k]) * (e->b[k] - e->a[k]);
    }
    double t = square > 0 ? fmin(fmax(along / square, 0), 1) : 0;
    for (int k = 0; k < 3; k++) {
        double d = p[k] - e->a[k] - t * (e->b[k] - e->a[k]);
        rest += d * d;
    }
    return sqrt(rest);
}

static void middle_of(const vn_volume *volume, size_t index, double p[3]) {
    size_t row = index / (size_t)volume->size[0];
    size_t v[3] = {index % (size_t)volume->size[0], row % (size_t)volume->size[1],
                   row / (size_t)volume->size[1]};
    for (int r = 0; r < 3; r++) {
        const double *m = volume->to_world[r];
        p[r] = m[0] * (double)v[0] + m[1] * (double)v[1] + m[2] * (double)v[2] + m[3];
    }
}

static size_t voxel_at(const vn_volume *volume, const double p[3]) {
    size_t index = 0;
    for (int k = 2; k >= 0; k--) {
        double v = floor((p[k] - volume->to_world[k][3]) / volume->to_world[k][k] + 0.5);
        assert_true(v >= 0 && v < volume->size[k]);
        index = index * (size_t)volume->size[k] + (size_t)v;
    }
    return index;
}

// ---- no break

static void check_unbroken(const vn_network *network, double resolution, int32_t parts) {
    for (int content = VN_VOXELS_MASK; content <= VN_VOXELS_VESSELNESS; content++) {
        vn_volume *volume = quick_voxels(network, content, resolution);
        int32_t found = count_parts(volume);
        if (found != parts) {
            fail_msg("content %d at %g: %d parts", content, resolution, found);
        }
        vn_volume_destroy(volume);
    }
}

static void random_trees_never_break(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(11);
    for (uint64_t seed = 0; seed < 60; seed++) {
        vn_network *network = random_tree(seed % 3 == 0 ? 2 : 3, (int32_t)whole(&rng, 1, 40), 1, seed);
        give_radii(network, &rng, 1e-3, seed % 4 == 0 ? 1e-3 : uniform(&rng, 0.01, 2));
        check_unbroken(network, uniform(&rng, 0.15, 2), 1);
        vn_network_destroy(network);
    }
}

// Coordinates in halves: axes along the faces, edges and corners of voxels, with ties at every step.
static void trees_on_a_lattice_never_break(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(12);
    for (int32_t round = 0; round < 120; round++) {
        int dim = round % 4 == 0 ? 2 : 3;
        vn_network *network = network_of(dim);
        put_root(network, 0, 0, 0);
        for (int32_t i = 1; i < 20; i++) {
            double h = round % 2 == 0 ? 0.5 : 1.0 / 3;
            put_child(network, (int32_t)whole(&rng, 0, i - 1), h * (double)whole(&rng, -9, 9),
                      h * (double)whole(&rng, -9, 9), dim == 3 ? h * (double)whole(&rng, -9, 9) : 0);
        }
        vn_network_join(network, 3, 17, 0.25); // unless they are connected
        give_radii(network, &rng, 0.25, round % 3 == 0 ? 0.25 : sqrt(2));
        check_unbroken(network, round % 5 == 0 ? 0.5 : 1, 1);
        vn_network_destroy(network);
    }
}

static void long_thin_diagonals_never_break(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(13);
    for (int32_t round = 0; round < 60; round++) {
        vn_network *network = network_of(3);
        double slope = round % 3 == 0 ? 1 : (round % 3 == 1 ? 1 - 1e-13 : uniform(&rng, -1, 1));
        double x = round % 2 == 0 ? 0.5 : uniform(&rng, 0, 1);
        put_root(network, x, 0.5, 0.49999999999);
        put_child(network, 0, x + 60, 0.5 + 60 * slope, 0.5 - 60 * slope);
        put_child(network, 1, x + 60, 0.5 + 60 * slope, 0.5 - 60 * slope); // of no length
        put_child(network, 2, x + 3, 40, uniform(&rng, -60, 60));
        give_radii(network, &rng, 1e-6, 1e-6);
        check_unbroken(network, 1, 1);
        vn_network_destroy(network);
    }
}

static void a_lone_root_is_a_ball(void **state) {
    (void)state;
    vn_network *network = network_of(3);
    double radius = 3;
    put_root(network, 1, 2, 3);
    assert_ok(vn_network_set_radii(network, &radius));
    vn_volume *volume = quick_voxels(network, VN_VOXELS_MASK, 0.1);
    assert_near((double)vn_volume_count(volume) * 1e-3, 4.0 / 3 * 3.14159265 * 27, 0.5);
    vn_volume_destroy(volume);
    radius = 0;
    assert_ok(vn_network_set_radii(network, &radius));
    volume = quick_voxels(network, VN_VOXELS_MASK, 0.1);
    assert_int_equal(vn_volume_count(volume), 1);
    assert_int_equal(voxel_count(volume), 27);
    vn_volume_destroy(volume);
    vn_network_destroy(network);
}

static void trees_apart_are_parts(void **state) {
    (void)state;
    vn_network *network = network_of(3);
    for (int32_t i = 0; i < 4; i++) {
        put_root(network, 10 * i, 0, 0);
    }
    for (int32_t i = 0; i < 4; i++) {
        put_child(network, i, 10 * i, 5, 5);
    }
    assert_ok(vn_network_join(network, 0, 4 + 1, 0.2));
    vn_rng rng = vn_rng_make(1);
    give_radii(network, &rng, 0.2, 1);
    check_unbroken(network, 0.7, 3);
    vn_network_destroy(network);
}

// ---- the centre line

static void check_line(const vn_network *network, const edge *edges, int32_t count, double h) {
    vn_volume *line = quick_voxels(network, VN_VOXELS_CENTERLINE, h);
    vn_volume *mask = quick_voxels(network, VN_VOXELS_MASK, h);
    double longest = 0, p[3];
    for (size_t i = 0; i < voxel_count(line); i++) {
        if (vn_volume_at(line, i) == 0) {
            continue;
        }
        assert_true(vn_volume_at(mask, i) == 1);
        double nearest = INFINITY;
        middle_of(line, i, p);
        for (int32_t e = 0; e < count; e++) {
            nearest = fmin(nearest, distance_from(&edges[e], p));
        }
        assert_true(nearest < 0.9 * h); // half a diagonal of a voxel
    }
    for (int32_t e = 0; e < count; e++) {
        assert_true(vn_volume_at(line, voxel_at(line, edges[e].a)) == 1);
        assert_true(vn_volume_at(line, voxel_at(line, edges[e].b)) == 1);
        double most = 0;
        for (int k = 0; k < 3; k++) {
            most = fmax(most, fabs(edges[e].b[k] - edges[e].a[k]));
        }
        longest += most / h + 4;
    }
    assert_true((double)vn_volume_count(line) <= longest); // one voxel a step, and no more
    vn_volume_destroy(line);
    vn_volume_destroy(mask);
}

static void lines_follow_their_edges(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(14);
    for (uint64_t seed = 0; seed < 60; seed++) {
        vn_network *network = random_tree(seed % 3 == 0 ? 2 : 3, (int32_t)whole(&rng, 1, 12), 1, seed);
        edge edges[16];
        give_radii(network, &rng, 1e-3, 1);
        check_line(network, edges, edges_of(network, edges), uniform(&rng, 0.1, 3));
        vn_network_destroy(network);
    }
}

// ---- every voxel by the plain rule

enum { MOST_EDGES = 32 };

typedef struct expected {
    edge edges[MOST_EDGES];
    int32_t count;
    vn_volume *lines[MOST_EDGES]; // of each edge alone, in the same voxels
} expected;

static void expect(expected *x, const vn_network *network, double h, const vn_box *bounds) {
    x->count = edges_of(network, x->edges);
    for (int32_t e = 0; e < x->count; e++) {
        vn_network *alone = network_of(vn_network_dim(network));
        const edge *at = &x->edges[e];
        put_root(alone, at->a[0], at->a[1], at->a[2]);
        put_child(alone, 0, at->b[0], at->b[1], at->b[2]);
        vn_voxels_def def = def_of(alone, VN_VOXELS_CENTERLINE, h);
        def.bounds = *bounds;
        x->lines[e] = voxels_of(&def);
        vn_network_destroy(alone);
    }
}

// The edge that has the voxel, or -1.
static int32_t owner_of(const expected *x, const vn_volume *grid, size_t voxel, double h, double *near_tie) {
    double p[3];
    float deepest = -INFINITY;
    int32_t owner = -1;
    middle_of(grid, voxel, p);
    *near_tie = INFINITY;
    for (int32_t e = 0; e < x->count; e++) {
        float depth = (float)((x->edges[e].radius - distance_from(&x->edges[e], p)) / h);
        *near_tie = fmin(*near_tie, fmin(fabs((double)depth), fabs((double)depth - (double)deepest)));
        if ((depth >= 0 || vn_volume_at(x->lines[e], voxel) != 0) && depth > deepest) {
            deepest = depth;
            owner = e;
        }
    }
    return owner;
}

static void check_owners(const vn_network *network, const expected *x, double h, const vn_box *bounds) {
    vn_voxels_def def = def_of(network, VN_VOXELS_MASK, h);
    def.bounds = *bounds;
    vn_volume *mask = voxels_of(&def);
    def.content = VN_VOXELS_RADIUS;
    vn_volume *radius = voxels_of(&def);
    int64_t vessels = 0;
    for (size_t i = 0; i < voxel_count(mask); i++) {
        double near_tie;
        int32_t owner = owner_of(x, mask, i, h, &near_tie);
        if (near_tie < 1e-5) {
            continue; // rounded otherwise in the world than in voxels
        }
        vessels += owner >= 0;
        assert_true(vn_volume_at(mask, i) == (owner >= 0));
        assert_true(vn_volume_at(radius, i) == (owner >= 0 ? (float)x->edges[owner].radius : 0));
    }
    assert_true(vessels > 0);
    vn_volume_destroy(mask);
    vn_volume_destroy(radius);
}

static void voxels_belong_to_the_deepest_tube(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(15);
    for (uint64_t seed = 0; seed < 40; seed++) {
        vn_network *network = random_tree(seed % 4 == 0 ? 2 : 3, (int32_t)whole(&rng, 1, 14), 1, seed);
        if (vn_network_count(network) > 8) {
            vn_network_join(network, 0, 7, 0.4);
        }
        give_radii(network, &rng, 0.02, 1.5);
        double h = uniform(&rng, 0.4, 1);
        vn_box bounds = {{-7, -7, -7}, {7, 7, 7}};
        if (seed % 2 == 0) {
            bounds = (vn_box){{-2, -3, -1}, {3, 2, 4}}; // which cuts vessels
        }
        expected x = {.count = 0};
        expect(&x, network, h, &bounds);
        check_owners(network, &x, h, &bounds);
        for (int32_t e = 0; e < x.count; e++) {
            vn_volume_destroy(x.lines[e]);
        }
        vn_network_destroy(network);
    }
}

// A root, a way of two edges to a branching, two tips; and a join from tip to tip. All 9 apart, in voxels
// of 1.
static vn_network *fork_of(vn_status (*then)(vn_network *network)) {
    vn_network *network = network_of(3);
    put_root(network, 0, 0, 0);
    put_child(network, 0, 0, 9, 0);
    put_child(network, 1, 0, 18, 0);
    put_child(network, 2, -9, 27, 0);
    put_child(network, 2, 9, 27, 0);
    double radius[5] = {2, 2, 2, 1, 1.5};
    assert_ok(vn_network_set_radii(network, radius));
    if (then != NULL) {
        assert_ok(then(network));
    }
    return network;
}

static vn_status join_tips(vn_network *network) {
    return vn_network_join(network, 3, 4, 0.5);
}

static vn_status order_by_hickey(vn_network *network) {
    return vn_network_set_orders(network, VN_HICKEY);
}

static double at(const vn_volume *volume, double x, double y, double z) {
    double p[3] = {x, y, z};
    return vn_volume_at(volume, voxel_at(volume, p));
}

static void branches_are_named_by_their_far_ends(void **state) {
    (void)state;
    vn_network *network = fork_of(join_tips);
    vn_volume *segments = quick_voxels(network, VN_VOXELS_SEGMENT, 1);
    assert_int_equal(segments->type, VN_VOXEL_U32);
    assert_true(at(segments, 0, 4, 0) == 3); // both edges up to the third node
    assert_true(at(segments, 0, 13, 0) == 3);
    assert_true(at(segments, -6, 24, 0) == 4);
    assert_true(at(segments, 6, 24, 0) == 5);
    assert_true(at(segments, 0, 27, 0) == 6); // the first join
    assert_true(at(segments, 0, 23, 0) == 0);
    vn_volume_destroy(segments);
    vn_network_destroy(network);
}

static void the_first_of_equal_tubes_has_the_voxel(void **state) {
    (void)state;
    vn_network *network = network_of(3);
    double radius[3] = {2, 2, 2};
    put_root(network, 0, 0, 0);
    put_child(network, 0, 20, 9, 3);
    put_child(network, 0, 20, 9, 3);
    assert_ok(vn_network_set_radii(network, radius));
    vn_volume *segments = quick_voxels(network, VN_VOXELS_SEGMENT, 1);
    for (size_t i = 0; i < voxel_count(segments); i++) {
        assert_in_set((unsigned long)vn_volume_at(segments, i), ((unsigned long[]){0, 2}), 2);
    }
    vn_volume_destroy(segments);
    vn_network_destroy(network);
}

static void orders_are_the_network_s_or_strahler_s(void **state) {
    (void)state;
    vn_network *network = fork_of(NULL);
    vn_volume *orders = quick_voxels(network, VN_VOXELS_ORDER, 1);
    assert_true(at(orders, 0, 4, 0) == 2 && at(orders, -6, 24, 0) == 1 && at(orders, 6, 24, 0) == 1);
    assert_null(vn_network_orders(network)); // asking leaves no trace
    vn_volume_destroy(orders);
    vn_network_destroy(network);
    network = fork_of(order_by_hickey);
    orders = quick_voxels(network, VN_VOXELS_ORDER, 1);
    assert_true(at(orders, 0, 4, 0) == 1 && at(orders, -6, 24, 0) == 2 && at(orders, 6, 24, 0) == 1);
    vn_volume_destroy(orders);
    vn_network_destroy(network);
}

static void networks_and_trees_are_labelled(void **state) {
    (void)state;
    vn_network *arteries = fork_of(NULL), *veins = network_of(3);
    double radius[4] = {1, 1, 1, 1};
    put_root(veins, 30, 0, 0);
    put_root(veins, 40, 0, 0);
    put_child(veins, 0, 30, 9, 0);
    put_child(veins, 1, 40, 9, 0);
    assert_ok(vn_network_set_radii(veins, radius));
    const vn_network *both[] = {arteries, veins};
    vn_voxels_def def = def_of(NULL, VN_VOXELS_LABEL, 1);
    def.networks = both;
    def.network_count = 2;
    vn_volume *volume = voxels_of(&def);
    assert_true(at(volume, 0, 5, 0) == 1 && at(volume, 30, 5, 0) == 2 && at(volume, 40, 5, 0) == 2);
    vn_volume_destroy(volume);
    def.content = VN_VOXELS_TREE;
    volume = voxels_of(&def);
    assert_true(at(volume, 0, 5, 0) == 1 && at(volume, 30, 5, 0) == 2 && at(volume, 40, 5, 0) == 3);
    vn_volume_destroy(volume);
    def.content = VN_VOXELS_SEGMENT;
    volume = voxels_of(&def);
    assert_true(at(volume, 0, 5, 0) == 3 && at(volume, 30, 5, 0) == 8 && at(volume, 40, 5, 0) == 9);
    vn_volume_destroy(volume);
    vn_network_destroy(arteries);
    vn_network_destroy(veins);
}

// ---- soft voxels

static double sum_of(const vn_volume *volume) {
    double sum = 0;
    for (size_t i = 0; i < voxel_count(volume); i++) {
        double value = vn_volume_at(volume, i);
        assert_true(value >= 0 && value <= 1);
        sum += value;
    }
    return sum;
}

static void soft_voxels_sum_up_to_what_vessels_fill(void **state) {
    (void)state;
    static const double radii[] = {0.1, 0.3, 0.45, 0.6, 1, 2.5, 6};
    vn_rng rng = vn_rng_make(16);
    for (int dim = 2; dim <= 3; dim++) {
        for (size_t r = 0; r < sizeof radii / sizeof *radii; r++) {
            double sum = 0, exact = 0;
            for (int32_t round = 0; round < 12; round++) {
                vn_network *network = network_of(dim);
                double radius[2] = {radii[r], radii[r]}, d[3], length = 0;
                put_root(network, uniform(&rng, 0, 1), uniform(&rng, 0, 1), uniform(&rng, 0, 1));
                for (int k = 0; k < 3; k++) {
                    d[k] = k < dim ? uniform(&rng, -50, 50) : 0;
                    length += d[k] * d[k];
                }
                put_child(network, 0, d[0], d[1], d[2]);
                assert_ok(vn_network_set_radii(network, radius));
                vn_volume *volume = quick_voxels(network, VN_VOXELS_VESSELNESS, 1);
                double s = radii[r], l = sqrt(length), pi = 3.14159265358979;
                sum += sum_of(volume);
                exact += dim == 3 ? pi * s * s * (l + 4.0 / 3 * s) : 2 * s * l + pi * s * s;
                vn_volume_destroy(volume);
                vn_network_destroy(network);
            }
            if (fabs(sum / exact - 1) > 0.04) {
                fail_msg("%dD, radius %g: %g in place of %g", dim, radii[r], sum, exact);
            }
        }
    }
}

// ---- where the voxels are

static void the_grid_covers_what_was_asked_for(void **state) {
    (void)state;
    vn_network *network = fork_of(NULL);
    vn_volume *volume = quick_voxels(network, VN_VOXELS_MASK, 0.5);
    assert_int_equal(volume->size[0], 2 * (18 + 1 + 1.5) + 2); // tips of 1 and 1.5 about -9 and 9
    assert_int_equal(volume->size[1], 2 * (27 + 2 + 1.5) + 2);
    assert_int_equal(volume->size[2], 2 * 4 + 2);
    assert_near(volume->to_world[0][3], -10 - 0.25, 1e-12);
    assert_near(volume->to_world[0][0], 0.5, 0);
    vn_volume_destroy(volume);
    vn_voxels_def def = def_of(network, VN_VOXELS_RADIUS, 0);
    def.size = 100;
    def.margin = 3;
    volume = voxels_of(&def);
    assert_int_equal(volume->size[1], 100);
    vn_volume_destroy(volume);
    def = def_of(network, VN_VOXELS_MASK, 0.1);
    def.bounds = (vn_box){{0, 0, -1}, {0.3, 18, 1}};
    volume = voxels_of(&def);
    assert_int_equal(volume->size[0], 3);
    assert_int_equal(volume->size[1], 180);
    assert_int_equal(volume->size[2], 20);
    assert_int_equal(vn_volume_count(volume), 3 * 180 * 20);
    vn_volume_destroy(volume);
    vn_network_destroy(network);
}

// A node on the upper face of given bounds is still in the last voxel.
static void bounds_include_their_upper_faces(void **state) {
    (void)state;
    vn_network *network = network_of(2);
    put_root(network, 0, 0, 0);
    put_child(network, 0, 1, 1, 0);
    put_root(network, 1, 0.35, 0); // alone, in voxel (9, 3)
    vn_voxels_def def = def_of(network, VN_VOXELS_CENTERLINE, 0.1);
    def.bounds = (vn_box){{0, 0, 0}, {1, 1, 0}};
    vn_volume *volume = voxels_of(&def);
    assert_int_equal(volume->size[0], 10);
    assert_int_equal(volume->size[2], 1);
    assert_int_equal(vn_volume_count(volume), 11);
    assert_true(vn_volume_at(volume, 99) == 1 && vn_volume_at(volume, 39) == 1);
    vn_volume_destroy(volume);
    vn_network_destroy(network);
}

static void what_lies_outside_costs_nothing(void **state) {
    (void)state;
    vn_network *network = network_of(3);
    put_root(network, -1e11, -1e11, -1e11);
    put_child(network, 0, 1e11, 1e11, 1e11);
    put_child(network, 1, 1e300, 1e300, 0);
    put_root(network, 1e308, 0, 0);
    double radius[4] = {0.001, 0.001, 1, 1};
    assert_ok(vn_network_set_radii(network, radius));
    vn_voxels_def def = def_of(network, VN_VOXELS_MASK, 1);
    def.bounds = (vn_box){{0, 0, 0}, {50, 50, 50}};
    vn_volume *volume = voxels_of(&def);
    assert_in_range(vn_volume_count(volume), 50, 52);
    assert_int_equal(count_parts(volume), 1);
    vn_volume_destroy(volume);
    vn_network_destroy(network);
}

static void threads_change_nothing(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(17);
    vn_network *network = random_tree(3, 300, 1, 5);
    give_radii(network, &rng, 0.01, 0.6);
    for (int content = VN_VOXELS_LABEL; content <= VN_VOXELS_VESSELNESS; content++) {
        vn_voxels_def def = def_of(network, content, 0);
        def.size = 190; // enough slabs for a parallel loop
        vn_set_threads(1);
        vn_volume *one = voxels_of(&def);
        vn_set_threads(4);
        vn_volume *four = voxels_of(&def);
        assert_memory_equal(one->data, four->data, one->byte_size);
        assert_int_equal(count_parts(one), 1);
        vn_volume_destroy(one);
        vn_volume_destroy(four);
    }
    vn_set_threads(0);
    vn_network_destroy(network);
}

// A volume of many slabs is what volumes of one slab each, laid on each other, are. Tubes hide their lines,
// which depend on where they are cut.
static void slabs_fit_together(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(18);
    vn_network *network = random_tree(3, 200, 1, 6);
    give_radii(network, &rng, 0.12, 0.7);
    for (int content = VN_VOXELS_SEGMENT; content <= VN_VOXELS_RADIUS; content++) {
        vn_voxels_def def = def_of(network, content, 0.1);
        def.bounds = (vn_box){{-6, -6, -6}, {6, 6, 6}};
        vn_volume *whole = voxels_of(&def);
        for (int32_t k = 0; k < 12; k++) {
            def.bounds.min[2] = k - 6;
            def.bounds.max[2] = k - 5;
            vn_volume *part = voxels_of(&def);
            assert_memory_equal(part->data, (char *)whole->data + (size_t)k * part->byte_size,
                                part->byte_size);
            vn_volume_destroy(part);
        }
        assert_in_range(vn_volume_count(whole), 10000, 1000000);
        vn_volume_destroy(whole);
    }
    vn_network_destroy(network);
}

// ---- refusals

static void check_refused(const vn_voxels_def *def, vn_status status, const char *part, int line) {
    vn_volume *volume = (vn_volume *)&line; // a failure must clear it
    assert_int_equal(vn_voxelize(&volume, def), status);
    assert_null(volume);
    check_message(part, __FILE__, line);
}

static void what_cannot_be_is_refused(void **state) {
    (void)state;
    vn_network *network = network_of(3), *flat = network_of(2), *empty = network_of(3);
    put_root(network, 0, 0, 0);
    put_child(network, 0, 100, 0, 0);
    vn_voxels_def def = def_of(network, VN_VOXELS_MASK, 1);
    check_refused(&def, VN_INVALID, "no radii", __LINE__);
    double radius[2] = {1, 1};
    assert_ok(vn_network_set_radii(network, radius));
    def.size = 5;
    check_refused(&def, VN_INVALID, "not both", __LINE__);
    def.size = 2;
    def.resolution = 0;
    check_refused(&def, VN_INVALID, "margin", __LINE__);
    def.size = 0;
    def.resolution = 1e-5;
    check_refused(&def, VN_LIMIT, "coarser", __LINE__);
    def.resolution = 0.02;
    def.bounds = (vn_box){{0, 0, 0}, {40, 40, 40}};
    check_refused(&def, VN_LIMIT, "2^31", __LINE__);
    def.bounds.max[1] = -1;
    check_refused(&def, VN_INVALID, "bounds", __LINE__);
    def.bounds.max[1] = NAN;
    check_refused(&def, VN_INVALID, "bounds", __LINE__);
    def = def_of(empty, VN_VOXELS_MASK, 1);
    check_refused(&def, VN_INVALID, "nothing to cover", __LINE__);
    const vn_network *both[] = {network, flat};
    def.network = NULL;
    check_refused(&def, VN_INVALID, "one at least", __LINE__);
    def.networks = both;
    def.network_count = 2;
    check_refused(&def, VN_INVALID, "dimensions", __LINE__);
    vn_network_destroy(network);
    vn_network_destroy(flat);
    vn_network_destroy(empty);
}

static void an_empty_network_within_bounds_is_blank(void **state) {
    (void)state;
    vn_network *network = network_of(3);
    vn_voxels_def def = def_of(network, VN_VOXELS_RADIUS, 1);
    def.bounds = (vn_box){{0, 0, 0}, {4, 4, 4}};
    vn_volume *volume = voxels_of(&def);
    assert_int_equal(vn_volume_count(volume), 0);
    assert_int_equal(voxel_count(volume), 64);
    vn_volume_destroy(volume);
    vn_network_destroy(network);
}

// More trees than a label of 16 bits holds.
static void too_many_labels_are_refused(void **state) {
    (void)state;
    vn_network *network = network_of(2);
    for (int32_t i = 0; i < 65536; i++) {
        put_root(network, i % 256, floor(i / 256.0), 0);
    }
    vn_murray_def murray = vn_murray_def_default();
    assert_ok(vn_network_murray(network, &murray));
    vn_voxels_def def = def_of(network, VN_VOXELS_TREE, 1);
    check_refused(&def, VN_LIMIT, "number 65536, and the largest that this content has is 65535", __LINE__);
    vn_network_destroy(network);
}

// ---- files

typedef struct file_bytes {
    uint8_t *data;
    size_t size;
} file_bytes;

// Unpacked if it is packed: zlib looks for itself.
static file_bytes read_bytes(const char *path, long from) {
    enum { ROOM = 1 << 20 };
    file_bytes bytes = {malloc(ROOM), 0};
    FILE *plain = fopen(path, "rb");
    assert_true(bytes.data != NULL && plain != NULL);
    fseek(plain, from, SEEK_SET);
    gzFile file = gzdopen(dup(fileno(plain)), "rb");
    lseek(fileno(plain), from, SEEK_SET);
    assert_non_null(file);
    int count = gzread(file, bytes.data, ROOM);
    assert_in_range(count, 0, ROOM - 1);
    bytes.size = (size_t)count;
    bytes.data[bytes.size] = 0;
    gzclose(file);
    fclose(plain);
    return bytes;
}

static uint32_t get_int(const uint8_t *p, int bytes) {
    uint32_t value = 0;
    for (int i = bytes - 1; i >= 0; i--) {
        value = value << 8 | p[i];
    }
    return value;
}

static float get_float(const uint8_t *p) {
    uint32_t bits = get_int(p, 4);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static double get_voxel(const uint8_t *p, vn_voxel type) {
    return type == VN_VOXEL_F32 ? (double)get_float(p) : get_int(p, (int)vn_voxel_size(type));
}

static void check_voxels(const vn_volume *volume, const uint8_t *at) {
    for (size_t i = 0; i < voxel_count(volume); i++) {
        assert_true(get_voxel(at + i * vn_voxel_size(volume->type), volume->type) == vn_volume_at(volume, i));
    }
}

static const char manifest[] = "{\"seed\": 7,\n \"script\": \"a\\\\b\"}";

static void check_nifti(const vn_volume *volume, const char *path, double factor, int unit) {
    static const uint32_t datatypes[] = {
        [VN_VOXEL_U8] = 2, [VN_VOXEL_U16] = 512, [VN_VOXEL_U32] = 768, [VN_VOXEL_F32] = 16};
    assert_ok(vn_volume_write(volume, path, manifest));
    file_bytes file = read_bytes(path, 0);
    const uint8_t *head = file.data;
    assert_int_equal(get_int(head, 4), 348);
    assert_memory_equal(head + 344, "n+1", 4);
    assert_int_equal(get_int(head + 40, 2), 3);
    assert_int_equal(get_int(head + 70, 2), datatypes[volume->type]);
    assert_int_equal(get_int(head + 72, 2), 8 * vn_voxel_size(volume->type));
    assert_int_equal(head[123], unit);
    assert_int_equal(get_int(head + 252, 2), 1);
    assert_int_equal(get_int(head + 254, 2), 1);
    for (int k = 0; k < 3; k++) {
        assert_int_equal(get_int(head + 42 + 2 * k, 2), volume->size[k]);
        assert_true(get_float(head + 80 + 4 * k) == (float)(factor * volume->to_world[k][k]));
        assert_true(get_float(head + 268 + 4 * k) == (float)(factor * volume->to_world[k][3]));
        for (int c = 0; c < 4; c++) {
            assert_true(get_float(head + 280 + 16 * k + 4 * c) == (float)(factor * volume->to_world[k][c]));
        }
    }
    assert_int_equal(head[348], 1);
    uint32_t comment = get_int(head + 352, 4), offset = (uint32_t)get_float(head + 108);
    assert_int_equal(offset, 352 + comment);
    assert_int_equal(comment % 16, 0);
    assert_string_equal((const char *)head + 360, manifest);
    assert_int_equal(file.size, offset + volume->byte_size);
    check_voxels(volume, head + offset);
    free(file.data);
    unlink(path);
}

static void check_nrrd(const vn_volume *volume, const char *path) {
    assert_ok(vn_volume_write(volume, path, manifest));
    char head[2048], line[128];
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    size_t size = fread(head, 1, sizeof head - 1, file);
    fclose(file);
    head[size] = '\0';
    assert_memory_equal(head, "NRRD0004\n", 9);
    snprintf(line, sizeof line, "\nsizes: %d %d %d\n", volume->size[0], volume->size[1], volume->size[2]);
    assert_non_null(strstr(head, line));
    assert_non_null(strstr(head, "\nvenule:={\"seed\": 7,\\n \"script\": \"a\\\\\\\\b\"}\n"));
    assert_non_null(strstr(head, "\nspace units: \"mm\" \"mm\" \"mm\"\n"));
    double m[4][3];
    assert_int_equal(sscanf(strstr(head, "directions:") + 11, " (%lf,%lf,%lf) (%lf,%lf,%lf) (%lf,%lf,%lf)",
                            m[0], m[0] + 1, m[0] + 2, m[1], m[1] + 1, m[1] + 2, m[2], m[2] + 1, m[2] + 2),
                     9);
    assert_int_equal(sscanf(strstr(head, "origin:") + 7, " (%lf,%lf,%lf)", m[3], m[3] + 1, m[3] + 2), 3);
    for (int i = 0; i < 12; i++) {
        assert_true(m[i / 3][i % 3] == volume->to_world[i % 3][i / 3]);
    }
    file_bytes voxels = read_bytes(path, strstr(head, "\n\n") + 2 - head);
    assert_int_equal(voxels.size, volume->byte_size);
    check_voxels(volume, voxels.data);
    free(voxels.data);
    unlink(path);
}

static vn_network *small_tree(int dim, const char *unit) {
    vn_network_def def = vn_network_def_default();
    vn_network *network = NULL;
    vn_rng rng = vn_rng_make(3);
    def.dim = dim;
    def.unit = unit;
    assert_ok(vn_network_create(&network, &def));
    put_root(network, 0, 0, 0);
    for (int32_t i = 1; i < 9; i++) {
        put_child(network, i / 2, uniform(&rng, -5, 5), uniform(&rng, -5, 5), uniform(&rng, -2, 2));
    }
    give_radii(network, &rng, 0.1, 0.8);
    return network;
}

static void files_hold_the_volume(void **state) {
    (void)state;
    vn_network *network = small_tree(3, "mm");
    for (int content = VN_VOXELS_MASK; content <= VN_VOXELS_VESSELNESS; content++) {
        vn_volume *volume = quick_voxels(network, content, 0.37);
        check_nifti(volume, "voxels.nii", 1, 2);
        check_nifti(volume, "voxels.nii.gz", 1, 2);
        check_nrrd(volume, "voxels.nrrd");
        vn_volume_destroy(volume);
    }
    vn_network_destroy(network);
    static const struct {
        const char *name;
        double factor;
        int code;
    } units[] = {{"um", 1, 3}, {"m", 1, 1}, {"cm", 10, 2}, {"", 1, 0}, {"ell", 1, 0}, {"leaf lengths", 1, 0}};
    for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
        network = small_tree(2, units[i].name);
        vn_volume *volume = quick_voxels(network, VN_VOXELS_MASK, 0.37);
        check_nifti(volume, "voxels.nii.gz", units[i].factor, units[i].code);
        vn_volume_destroy(volume);
        vn_network_destroy(network);
    }
}

static void packed_files_carry_no_time(void **state) {
    (void)state;
    vn_network *network = small_tree(3, "mm");
    vn_volume *volume = quick_voxels(network, VN_VOXELS_MASK, 0.37);
    assert_ok(vn_volume_write(volume, "voxels.nii.gz", NULL));
    FILE *file = fopen("voxels.nii.gz", "rb");
    uint8_t head[10];
    assert_non_null(file);
    assert_int_equal(fread(head, 1, sizeof head, file), sizeof head);
    fclose(file);
    assert_memory_equal(head, "\x1f\x8b\x08\0\0\0\0\0", 8); // no name, no time
    file_bytes bytes = read_bytes("voxels.nii.gz", 0);
    assert_int_equal(bytes.size, 352 + volume->byte_size); // and no manifest, as there was none
    free(bytes.data);
    unlink("voxels.nii.gz");
    vn_volume_destroy(volume);
    vn_network_destroy(network);
}

static void vol_is_as_dgtal_reads_it(void **state) {
    (void)state;
    vn_network *network = small_tree(3, "mm");
    vn_voxels_def def = def_of(network, VN_VOXELS_MASK, 0.5);
    def.bounds =
        (vn_box){{-3.25, -2.25, 0.75}, {4.75, 3.25, 2.75}}; // the first voxel at (-3, -2, 1): (-6, -4, 2)
    vn_volume *volume = voxels_of(&def);
    assert_ok(vn_volume_write(volume, "voxels.vol", manifest));
    file_bytes file = read_bytes("voxels.vol", 0);
    static const char head[] =
        "X: 16\nY: 11\nZ: 4\nVoxel-Size: 1\nAlpha-Color: 0\nInt-Endian: 0123\nVoxel-Endian: 0\n"
        "Version: 2\nCenter-X: 1\nCenter-Y: 1\nCenter-Z: 3\n.\n";
    assert_int_equal(file.size, sizeof head - 1 + volume->byte_size);
    assert_memory_equal(file.data, head, sizeof head - 1);
    for (size_t i = 0; i < voxel_count(volume); i++) {
        assert_int_equal(file.data[sizeof head - 1 + i], vn_volume_at(volume, i) != 0 ? 255 : 0);
    }
    free(file.data);
    unlink("voxels.vol");
    vn_volume_destroy(volume);
    volume = quick_voxels(network, VN_VOXELS_MASK, 0.37);
    assert_ok(vn_volume_write(volume, "voxels.vol", NULL));
    file = read_bytes("voxels.vol", 0);
    assert_null(strstr((const char *)file.data, "Center")); // no whole coordinates
    free(file.data);
    unlink("voxels.vol");
    vn_volume_destroy(volume);
    vn_network_destroy(network);
}

static void pgm_stands_upright(void **state) {
    (void)state;
    vn_network *network = small_tree(2, "mm");
    for (int content = VN_VOXELS_MASK; content <= VN_VOXELS_ORDER; content++) {
        vn_volume *volume = quick_voxels(network, content, 0.37);
        int width, height, most, begin = 0;
        assert_ok(vn_volume_write(volume, "voxels.pgm", manifest));
        file_bytes file = read_bytes("voxels.pgm", 0);
        const char *text = strstr((const char *)file.data, "\\\\b\"}\n");
        assert_non_null(text);
        assert_int_equal(sscanf(text + 6, "%d %d %d%n", &width, &height, &most, &begin), 3);
        const uint8_t *pixels = (const uint8_t *)text + 6 + begin + 1;
        assert_int_equal(most, content == VN_VOXELS_MASK ? 255 : 65535);
        assert_int_equal(file.data + file.size - pixels, volume->byte_size);
        for (size_t i = 0; i < voxel_count(volume); i++) {
            size_t row = (size_t)(height - 1) - i / (size_t)width,
                   pixel = row * (size_t)width + i % (size_t)width;
            int value = most == 255 ? pixels[pixel] / 255 : pixels[2 * pixel] << 8 | pixels[2 * pixel + 1];
            assert_int_equal(value, vn_volume_at(volume, i));
        }
        free(file.data);
        unlink("voxels.pgm");
        vn_volume_destroy(volume);
    }
    vn_network_destroy(network);
}

static void what_a_format_does_not_hold_leaves_no_file(void **state) {
    (void)state;
    vn_network *network = small_tree(3, "mm"), *flat = small_tree(2, "mm");
    vn_volume *labels = quick_voxels(network, VN_VOXELS_LABEL, 1),
              *soft = quick_voxels(flat, VN_VOXELS_RADIUS, 1);
    const struct {
        const vn_volume *volume;
        const char *path, *message;
    } cases[] = {{labels, "voxels.vol", "voxels.vol: .vol holds bytes"},
                 {labels, "voxels.pgm", "voxels.pgm: a .pgm is flat"},
                 {soft, "voxels.pgm", "voxels.pgm: a .pgm holds whole numbers"},
                 {soft, "voxels.tiff", "voxels.tiff: volumes are written as"},
                 {soft, ".nrrd", ".nrrd: volumes are written as"},
                 {soft, "voxels.gz", "voxels.gz: volumes are written as"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_int_equal(vn_volume_write(cases[i].volume, cases[i].path, NULL), VN_INVALID);
        assert_message(cases[i].message);
        assert_int_not_equal(access(cases[i].path, F_OK), 0);
    }
    assert_int_equal(vn_volume_write(soft, "no/such/folder.nii", NULL), VN_IO);
    vn_voxels_def def = def_of(flat, VN_VOXELS_CENTERLINE, 1);
    def.bounds = (vn_box){{0, 0, 0}, {40000, 1, 0}};
    vn_volume *wide = voxels_of(&def);
    assert_int_equal(vn_volume_write(wide, "voxels.nii.gz", NULL), VN_LIMIT);
    assert_message("40000 voxels in x are above NIfTI's limit of 32767");
    assert_int_not_equal(access("voxels.nii.gz", F_OK), 0);
    vn_volume_destroy(wide);
    vn_volume_destroy(labels);
    vn_volume_destroy(soft);
    vn_network_destroy(network);
    vn_network_destroy(flat);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(random_trees_never_break),
        counted_test(trees_on_a_lattice_never_break),
        counted_test(long_thin_diagonals_never_break),
        counted_test(a_lone_root_is_a_ball),
        counted_test(trees_apart_are_parts),
        counted_test(lines_follow_their_edges),
        counted_test(voxels_belong_to_the_deepest_tube),
        counted_test(branches_are_named_by_their_far_ends),
        counted_test(the_first_of_equal_tubes_has_the_voxel),
        counted_test(orders_are_the_network_s_or_strahler_s),
        counted_test(networks_and_trees_are_labelled),
        counted_test(soft_voxels_sum_up_to_what_vessels_fill),
        counted_test(the_grid_covers_what_was_asked_for),
        counted_test(bounds_include_their_upper_faces),
        counted_test(what_lies_outside_costs_nothing),
        counted_test(threads_change_nothing),
        counted_test(slabs_fit_together),
        counted_test(what_cannot_be_is_refused),
        counted_test(an_empty_network_within_bounds_is_blank),
        counted_test(too_many_labels_are_refused),
        counted_test(files_hold_the_volume),
        counted_test(packed_files_carry_no_time),
        counted_test(vol_is_as_dgtal_reads_it),
        counted_test(pgm_stands_upright),
        counted_test(what_a_format_does_not_hold_leaves_no_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
