// Vessels on the surface of meshes and inside them: none floats above or sinks below, none leaves.
#include "mesh_support.h"

#include "domain/domain.h"
#include "file/mesh.h"
#include "space/triangle_meets.h"

/// A run of vessels, lengths as parts of the organ's extent.
typedef struct run {
    vn_domain *domain;
    vn_triangles triangles;
    double extent;
    vn_network *network;
    vn_attractors *drains;
    vn_influence *influence;
    int32_t forks;
} run;

static const double SEGMENT = 0.03, WITHIN = 0.08, CLEAR = 0.03;

static run begin(vn_domain *domain, uint64_t seed) {
    run r = {.domain = domain, .network = network_of(3), .drains = attractors_of(3, 3)};
    vn_murray_def murray = vn_murray_def_default();
    vn_box box = vn_domain_bounds(domain);
    vn_rng rng = vn_rng_make(seed);
    double p[3];
    r.extent = sqrt(vn_distance2(box.min, box.max));
    murray.exponent = 2.55;
    murray.tip_radius = 0.001 * r.extent;
    assert_ok(vn_network_murray(r.network, &murray));
    if (domain->kind->triangles != NULL) {
        assert_ok(vn_domain_triangles(domain, &r.triangles));
    }
    assert_ok(vn_domain_dart(domain, &rng, p));
    put_root(r.network, p[0], p[1], p[2]);
    return r;
}

static void end(run *r) {
    vn_influence_destroy(r->influence);
    vn_attractors_destroy(r->drains);
    vn_network_destroy(r->network);
    vn_triangles_free(&r->triangles);
    vn_domain_release(r->domain);
}

static void step(run *r, vn_rng *rng, int32_t darts, double bias) {
    vn_throw_def throw = {.domain = r->domain,
                          .count = darts,
                          .spacing = CLEAR * r->extent,
                          .clearance = CLEAR * r->extent,
                          .network = r->network,
                          .rng = rng};
    vn_influence_def find = {.within = WITHIN * r->extent, .perception = {90, true}};
    vn_extend_def extend = vn_extend_def_default();
    vn_consume_def consume = {.distance = CLEAR * r->extent};
    int32_t accepted, added, first, consumed;
    extend.length = SEGMENT * r->extent;
    extend.domain = r->domain;
    extend.bias = bias;
    extend.bifurcate = 15;
    assert_ok(vn_throw(r->drains, &throw, &accepted));
    assert_ok(vn_influence_find(&r->influence, r->drains, r->network, &find));
    assert_ok(vn_extend(r->network, r->influence, &extend, &added, &first));
    assert_ok(vn_consume(r->drains, r->network, &consume, &consumed));
    for (int32_t i = first + 1; i < first + added; i++) {
        r->forks += r->network->parent.data[i] == r->network->parent.data[i - 1];
    }
}

static void grow(run *r, int steps, int32_t darts, double bias) {
    vn_rng rng = vn_rng_make(21);
    for (int i = 0; i < steps; i++) {
        step(r, &rng, darts, bias);
    }
}

static vn_triangle triangle_of(const run *r, int32_t t) {
    vn_triangle triangle;
    const double *xyz = r->triangles.xyz.data;
    const int32_t *c = r->triangles.corners.data + 3 * (int64_t)t;
    memcpy(triangle.a, xyz + 3 * (int64_t)c[0], sizeof triangle.a);
    memcpy(triangle.b, xyz + 3 * (int64_t)c[1], sizeof triangle.b);
    memcpy(triangle.c, xyz + 3 * (int64_t)c[2], sizeof triangle.c);
    return triangle;
}

/// One triangle after the other, but those whose first corner is too far for them to be nearer.
static double to_surface(const run *r, const double p[3], double longest) {
    double least = INFINITY;
    for (int32_t t = 0; t < r->triangles.corners.count / 3; t++) {
        vn_triangle triangle = triangle_of(r, t);
        double reach = least + longest;
        if (vn_distance2(triangle.a, p) <= reach * reach) {
            least = fmin(least, to_triangle(p, &triangle));
        }
    }
    return least;
}

static double longest_edge(const run *r) {
    double longest2 = 0;
    for (int32_t t = 0; t < r->triangles.corners.count / 3; t++) {
        vn_triangle triangle = triangle_of(r, t);
        longest2 = fmax(
            longest2, fmax(vn_distance2(triangle.a, triangle.b),
                           fmax(vn_distance2(triangle.b, triangle.c), vn_distance2(triangle.c, triangle.a))));
    }
    return sqrt(longest2);
}

static void ends_of(const run *r, int32_t node, double p[3], double q[3]) {
    vn_network_position(r->network, node, p);
    vn_network_position(r->network, r->network->parent.data[node], q);
}

static void along(const double p[3], const double q[3], double t, double at[3]) {
    for (int k = 0; k < 3; k++) {
        at[k] = p[k] + t * (q[k] - p[k]);
    }
}

// The ends of an edge see each other along a section of the surface that is at most a fifth longer than the
// edge: so it is nowhere farther off than the height of an isosceles triangle with such sides.
static void assert_on_surface(const run *r, double *worst) {
    const double steepest = 0.5 * sqrt(1.2 * 1.2 - 1);
    double longest = longest_edge(r);
    *worst = 0;
    for (int32_t i = 0; i < vn_network_count(r->network); i++) {
        double p[3], q[3], at[3];
        vn_network_position(r->network, i, p);
        assert_true(to_surface(r, p, longest) <= 1e-6 * r->extent);
        if (r->network->parent.data[i] >= 0) {
            ends_of(r, i, p, q);
            double length = sqrt(vn_distance2(p, q));
            assert_true(length <=
                        1.25 * SEGMENT * r->extent); // over a ridge it is stretched once, and overshoots
            for (int k = 1; k < 4; k++) {
                along(p, q, 0.25 * k, at);
                double off = to_surface(r, at, longest);
                assert_true(off <= steepest * length);
                *worst = fmax(*worst, off / length);
            }
        }
    }
}

/// Every edge against every triangle that it can reach.
static void assert_inside(const run *r) {
    double longest = longest_edge(r);
    for (int32_t i = 0; i < vn_network_count(r->network); i++) {
        double p[3], q[3];
        vn_network_position(r->network, i, p);
        assert_true(vn_domain_contains(r->domain, p));
        if (r->network->parent.data[i] < 0) {
            continue;
        }
        ends_of(r, i, p, q);
        double reach = longest + sqrt(vn_distance2(p, q));
        for (int32_t t = 0; t < r->triangles.corners.count / 3; t++) {
            vn_triangle triangle = triangle_of(r, t);
            if (vn_distance2(triangle.a, p) <= reach * reach) {
                assert_true(vn_line_meets(&triangle, p, q) != VN_LINE_MEETS);
            }
        }
    }
}

static vn_domain *liver_surface(void) {
    vn_mesh_def def = vn_mesh_def_default();
    vn_domain *domain;
    assert_ok(vn_domain_mesh(&domain, VN_SOURCE_DIR "/scripts/data/liver.obj", &def));
    return domain;
}

static vn_domain *of_globe(int n, bool inside) {
    mesh m = globe(n, 10);
    vn_domain *domain;
    int32_t vertices = m.xyz.count / 3, count = m.corners.count / 3;
    assert_ok(inside ? vn_domain_inside(&domain, m.xyz.data, vertices, m.corners.data, count, true)
                     : vn_domain_surface(&domain, m.xyz.data, vertices, m.corners.data, count));
    free_mesh(&m);
    return domain;
}

/// A sheet with waves and four borders.
static void wave(double u, double v, double p[3]) {
    set(p, 10 * u, 10 * v, sin(6 * u) * cos(5 * v));
}

static vn_domain *of_waves(void) {
    mesh m = sheet(wave, 40, 40);
    vn_domain *domain;
    assert_ok(vn_domain_surface(&domain, m.xyz.data, m.xyz.count / 3, m.corners.data, m.corners.count / 3));
    free_mesh(&m);
    return domain;
}

static void check_surface(vn_domain *domain, int steps, double bias, int32_t nodes, int32_t forks) {
    run r = begin(domain, 4);
    double worst;
    grow(&r, steps, 400, bias);
    assert_true(vn_network_count(r.network) > nodes);
    assert_true(r.forks > forks);
    assert_on_surface(&r, &worst);
    print_message("%d nodes, %d forks, %.3f of an edge off the surface at most\n",
                  vn_network_count(r.network), r.forks, worst);
    end(&r);
}

static void vessels_keep_to_a_coarse_ball(void **state) {
    (void)state;
    check_surface(of_globe(3, false), 100, 0.5, 400, 5); // facets of three segments
    check_surface(of_globe(1, false), 100, 0.5, 400, 5); // an octahedron
    check_surface(of_globe(30, false), 100, 0, 400, 5);  // triangles smaller than segments
}

static void vessels_keep_to_a_sheet_with_borders(void **state) {
    (void)state;
    check_surface(of_waves(), 120, 0.5, 300, 5);
}

static void vessels_keep_to_the_livers_capsule(void **state) {
    (void)state;
    check_surface(liver_surface(), 100, 0.5, 400, 5);
}

static void check_inside(vn_domain *domain, int32_t nodes) {
    run r = begin(domain, 4);
    grow(&r, 100, 400, 0.5);
    assert_true(vn_network_count(r.network) > nodes);
    assert_true(r.forks > 5);
    assert_inside(&r);
    print_message("%d nodes, %d forks\n", vn_network_count(r.network), r.forks);
    end(&r);
}

static void vessels_stay_inside(void **state) {
    (void)state;
    check_inside(of_globe(3, true), 1000);
    check_inside(liver(), 300);
}

// A globe of which another one is left out: asked point by point, as there are no triangles.
static void vessels_stay_in_one_mesh_and_out_of_another(void **state) {
    (void)state;
    vn_domain *whole = of_globe(8, true), *domain;
    mesh m = globe(4, 6);
    vn_domain *hole;
    assert_ok(
        vn_domain_inside(&hole, m.xyz.data, m.xyz.count / 3, m.corners.data, m.corners.count / 3, true));
    assert_ok(vn_domain_combine(&domain, whole, hole, VN_DIFFERENCE));
    run r = begin(domain, 4);
    grow(&r, 60, 400, 0.5);
    assert_true(vn_network_count(r.network) > 400);
    for (int32_t i = 0; i < vn_network_count(r.network); i++) {
        for (int k = 0; k <= 20 && r.network->parent.data[i] >= 0; k++) {
            double p[3], q[3], at[3];
            ends_of(&r, i, p, q);
            along(p, q, k / 20.0, at);
            assert_true(vn_domain_contains(whole, at) && !vn_domain_contains(hole, at));
        }
    }
    end(&r);
    vn_domain_release(whole);
    vn_domain_release(hole);
    free_mesh(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(vessels_keep_to_a_coarse_ball),
        counted_test(vessels_keep_to_a_sheet_with_borders),
        counted_test(vessels_keep_to_the_livers_capsule),
        counted_test(vessels_stay_inside),
        counted_test(vessels_stay_in_one_mesh_and_out_of_another),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
