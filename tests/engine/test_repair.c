// Meshes that are broken on purpose, and mended.
#include "mesh_support.h"

#include "file/mesh.h"

/// A mesh while it is broken.
typedef struct broken {
    mesh m;
    vn_repairs repairs;
} broken;

/// A globe of which every vertex is there once, and every triangle faces outwards.
static mesh ball_mesh(void) {
    mesh raw = globe(6, 2), m = {.xyz = {0}};
    int32_t number[1000];
    for (int32_t i = 0; i < raw.xyz.count / 3; i++) {
        const double *p = raw.xyz.data + 3 * i;
        int32_t same = 0;
        while (same < m.xyz.count / 3 && vn_distance2(m.xyz.data + 3 * same, p) > 0) {
            same++;
        }
        number[i] = same < m.xyz.count / 3 ? same : put_vertex(&m, p);
    }
    for (int32_t h = 0; h < raw.corners.count; h += 3) {
        int32_t a = number[raw.corners.data[h]], b = number[raw.corners.data[h + 1]],
                c = number[raw.corners.data[h + 2]];
        double n[3];
        cross_of(m.xyz.data + 3 * a, m.xyz.data + 3 * b, m.xyz.data + 3 * c, n);
        bool outwards = dot_of(n, m.xyz.data + 3 * a) > 0;
        put_triangle(&m, a, outwards ? b : c, outwards ? c : b);
    }
    free_mesh(&raw);
    return m;
}

static bool share_edge(const mesh *m, int32_t s, int32_t t) {
    int common = 0;
    for (int i = 0; i < 9; i++) {
        common += m->corners.data[3 * s + i / 3] == m->corners.data[3 * t + i % 3];
    }
    return common == 2;
}

static vn_status try_to_mend(vn_domain **out, broken *b, bool inside, bool repair) {
    vn_mesh_def def = vn_mesh_def_default();
    vn_faces faces = {.what = "organ",
                      .first = 1,
                      .xyz = b->m.xyz.data,
                      .vertices = b->m.xyz.count / 3,
                      .corners = b->m.corners.data,
                      .count = b->m.corners.count / 3};
    def.on = inside;
    def.repair = repair;
    def.repairs = &b->repairs;
    return vn_domain_mesh_faces(out, &faces, &def);
}

static vn_domain *mend(broken *b, bool inside) {
    vn_domain *domain;
    assert_ok(try_to_mend(&domain, b, inside, true));
    return domain;
}

static void assert_refused(broken *b, const char *message) {
    vn_domain *domain;
    assert_int_equal(try_to_mend(&domain, b, true, false), VN_INVALID);
    assert_message(message);
}

static void assert_repairs(const broken *b, vn_repairs expected) {
    assert_int_equal(b->repairs.merged, expected.merged);
    assert_int_equal(b->repairs.removed, expected.removed);
    assert_int_equal(b->repairs.turned, expected.turned);
    assert_int_equal(b->repairs.sewn, expected.sewn);
    assert_int_equal(b->repairs.holes, expected.holes);
    assert_int_equal(b->repairs.largest_hole, expected.largest_hole);
}

/// It is the ball again, as its triangles have it.
static void finish(broken *b, vn_domain *domain, double tolerance) {
    mesh whole = ball_mesh();
    vn_domain *expected;
    assert_ok(vn_domain_inside(&expected, whole.xyz.data, whole.xyz.count / 3, whole.corners.data,
                               whole.corners.count / 3, true));
    assert_near(vn_domain_measure(domain), vn_domain_measure(expected), tolerance);
    vn_domain_release(expected);
    vn_domain_release(domain);
    free_mesh(&whole);
    free_mesh(&b->m);
}

static void remove_triangle(mesh *m, int32_t t) {
    memmove(m->corners.data + 3 * t, m->corners.data + 3 * (t + 1),
            (size_t)(m->corners.count - 3 * (t + 1)) * sizeof *m->corners.data);
    m->corners.count -= 3;
}

static void turn_triangle(mesh *m, int32_t t) {
    int32_t *c = m->corners.data + 3 * t, first = c[0];
    c[0] = c[1];
    c[1] = first;
}

static void a_good_mesh_stays_as_it_is(void **state) {
    (void)state;
    broken b = {ball_mesh(), {0}};
    vn_domain *domain = mend(&b, true);
    assert_repairs(&b, (vn_repairs){0});
    finish(&b, domain, 1e-12);
}

static void holes_are_counted_and_closed(void **state) {
    (void)state;
    broken b = {ball_mesh(), {0}};
    int32_t last = b.m.corners.count / 3 - 1, beside = 11;
    while (!share_edge(&b.m, 10, beside)) {
        beside++;
    }
    remove_triangle(&b.m, last);
    remove_triangle(&b.m, beside);
    remove_triangle(&b.m, 10);
    assert_refused(
        &b, "organ: the mesh is not closed: edges with a triangle on one side only: 7, around 2 holes, "
            "the largest of 4 edges, the first at vertex ");
    assert_message("give repair = true to close them");
    vn_domain *domain = mend(&b, true);
    assert_repairs(&b, (vn_repairs){.holes = 2, .largest_hole = 4});
    finish(&b, domain, 0.05); // the quadrangle may be cut the other way
}

// An open surface is meant to be open.
static void a_surface_keeps_its_holes(void **state) {
    (void)state;
    broken b = {ball_mesh(), {0}};
    remove_triangle(&b.m, 40);
    vn_domain *domain = mend(&b, false);
    assert_int_equal(b.repairs.holes, 0);
    assert_true(isfinite(vn_domain_distance(domain, b.m.xyz.data + 3 * b.m.corners.data[0])));
    vn_domain_release(domain);
    free_mesh(&b.m);
}

static void triangles_that_face_the_wrong_way_are_turned(void **state) {
    (void)state;
    broken b = {ball_mesh(), {0}};
    for (int32_t t = 0; t < b.m.corners.count / 3; t += 7) {
        turn_triangle(&b.m, t);
    }
    vn_domain *domain = mend(&b, true);
    assert_repairs(&b, (vn_repairs){.turned = (b.m.corners.count / 3 + 6) / 7});
    finish(&b, domain, 1e-12);
}

// As STL has it, and worse: no two triangles share a vertex, and none is quite where the others have it.
static void vertices_that_nearly_coincide_are_merged(void **state) {
    (void)state;
    mesh whole = ball_mesh();
    broken b = {.repairs = {0}};
    vn_rng rng = vn_rng_make(2);
    for (int32_t h = 0; h < whole.corners.count; h++) {
        double p[3];
        for (int k = 0; k < 3; k++) {
            p[k] = whole.xyz.data[3 * whole.corners.data[h] + k] + uniform(&rng, -5e-9, 5e-9);
        }
        put_vertex(&b.m, p);
        if (h % 3 == 2) {
            put_triangle(&b.m, h - 2, h - 1, h);
        }
    }
    assert_refused(&b, "holes, the largest of 3 edges");
    vn_domain *domain = mend(&b, true);
    assert_repairs(&b, (vn_repairs){.merged = whole.corners.count - whole.xyz.count / 3});
    free_mesh(&whole);
    finish(&b, domain, 1e-6);
}

static void triangles_twice_or_without_area_go(void **state) {
    (void)state;
    broken b = {ball_mesh(), {0}};
    const int32_t *c = b.m.corners.data;
    // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): a ball has triangles
    int32_t first[3] = {c[0], c[1], c[2]}, other[3] = {c[30], c[31], c[32]};
    put_triangle(&b.m, first[0], first[1], first[2]);
    put_triangle(&b.m, other[1], other[0], other[2]); // the other way round
    put_triangle(&b.m, first[0], first[0], first[2]);
    assert_refused(&b, "has no area: its corners are on one line; remove it, or give repair = true");
    vn_domain *domain = mend(&b, true);
    assert_repairs(&b, (vn_repairs){.removed = 3});
    finish(&b, domain, 1e-12);
}

// An edge has a vertex in its middle that only the triangle on its one side, a needle, knows of.
static void a_needle_is_removed_and_nothing_torn(void **state) {
    (void)state;
    broken b = {box_mesh(0, 1), {0}};
    int32_t *c = b.m.corners.data, from = c[0], to = c[1], top = c[2];
    double p[3];
    for (int k = 0; k < 3; k++) {
        p[k] = 0.5 * (b.m.xyz.data[3 * from + k] + b.m.xyz.data[3 * to + k]);
    }
    int32_t middle = put_vertex(&b.m, p);
    c = b.m.corners.data;
    c[1] = middle;
    put_triangle(&b.m, middle, to, top);
    put_triangle(&b.m, from, to, middle); // the needle, beside the triangle that knows the whole edge
    assert_refused(&b, "has no area");
    vn_domain *domain = mend(&b, true);
    assert_int_equal(b.repairs.holes, 0);
    assert_int_equal(b.repairs.removed, 1);
    assert_near(vn_domain_measure(domain), 1, 1e-12);
    vn_domain_release(domain);
    free_mesh(&b.m);
}

static void several_parts_are_all_kept(void **state) {
    (void)state;
    broken b = {.repairs = {0}};
    put_box(&b.m, 0, 0, 0, 1, 1, 1);
    put_box(&b.m, 3, 0, 0, 4, 2, 1);
    put_box(&b.m, 3.25, 0.25, 0.25, 3.75, 0.75, 0.75); // a cavity
    remove_triangle(&b.m, 14);
    turn_triangle(&b.m, 3);
    vn_domain *domain = mend(&b, true);
    assert_repairs(&b, (vn_repairs){.turned = 1, .holes = 1, .largest_hole = 3});
    assert_near(vn_domain_measure(domain), 1 + 2 - 0.125, 1e-12);
    vn_domain_release(domain);
    free_mesh(&b.m);
}

static void what_cannot_be_mended_is_refused(void **state) {
    (void)state;
    vn_domain *domain;
    broken b = {globe(200, 2), {0}}; // each eighth of it by itself
    b.m.corners.count /= 2;          // half a ball, open along 800 edges
    assert_int_equal(try_to_mend(&domain, &b, true, true), VN_INVALID);
    assert_message("is above the limit of 500 for repair: close it, or take the surface");
    free_mesh(&b.m);
    b.m = box_mesh(0, 1);
    b.m.xyz.data[4] = NAN;
    assert_int_equal(try_to_mend(&domain, &b, true, true), VN_INVALID);
    assert_message("organ: vertex 2: y = nan must be");
    free_mesh(&b.m);
    b.m = box_mesh(0, 1);
    b.m.corners.data[5] = 8;
    assert_int_equal(try_to_mend(&domain, &b, true, true), VN_INVALID);
    assert_message("organ: face 2 has a corner at vertex 9");
    free_mesh(&b.m);
    put_vertex(&b.m, (double[]){0, 0, 0});
    put_vertex(&b.m, (double[]){1, 1, 1});
    put_vertex(&b.m, (double[]){2, 2, 2});
    put_triangle(&b.m, 0, 1, 2);
    assert_int_equal(try_to_mend(&domain, &b, false, true), VN_INVALID);
    assert_message("organ: the mesh cannot be repaired: none of its 1 faces has an area");
    free_mesh(&b.m);
}

// Whatever is made of any soup, it is a domain or an error.
static void any_soup_is_mended_or_refused(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(9);
    for (int round = 0; round < 200; round++) {
        broken b = {.repairs = {0}};
        int32_t vertices = (int32_t)whole(&rng, 3, 9), faces = (int32_t)whole(&rng, 1, 20);
        for (int32_t i = 0; i < vertices; i++) {
            double p[3];
            set(p, (double)whole(&rng, 0, 2), (double)whole(&rng, 0, 2), (double)whole(&rng, 0, 2));
            put_vertex(&b.m, p);
        }
        for (int32_t i = 0; i < faces; i++) {
            put_triangle(&b.m, (int32_t)whole(&rng, 0, vertices - 1), (int32_t)whole(&rng, 0, vertices - 1),
                         (int32_t)whole(&rng, 0, vertices - 1));
        }
        for (int inside = 0; inside < 2; inside++) {
            vn_domain *domain;
            vn_status status = try_to_mend(&domain, &b, inside, true);
            assert_true(status == VN_OK || status == VN_INVALID);
            assert_true((domain != NULL) == (status == VN_OK));
            vn_domain_release(domain);
        }
        free_mesh(&b.m);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(a_good_mesh_stays_as_it_is),
        counted_test(holes_are_counted_and_closed),
        counted_test(a_surface_keeps_its_holes),
        counted_test(triangles_that_face_the_wrong_way_are_turned),
        counted_test(vertices_that_nearly_coincide_are_merged),
        counted_test(triangles_twice_or_without_area_go),
        counted_test(a_needle_is_removed_and_nothing_torn),
        counted_test(several_parts_are_all_kept),
        counted_test(what_cannot_be_mended_is_refused),
        counted_test(any_soup_is_mended_or_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
