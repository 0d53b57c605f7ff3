// What closed meshes enclose, against the sum of solid angles and the nearest of all triangles; and shells of
// any domain.
#include "mesh_support.h"

#include "domain/domain.h"
#include "space/exact.h"
#include "space/triangle_meets.h"

// ---- Meshes ----

static const double *corner_at(const mesh *m, int32_t h) {
    return m->xyz.data + 3 * (int64_t)m->corners.data[h];
}

static vn_triangle triangle_at(const mesh *m, int32_t i) {
    vn_triangle t;
    memcpy(t.a, corner_at(m, 3 * i), sizeof t.a);
    memcpy(t.b, corner_at(m, 3 * i + 1), sizeof t.b);
    memcpy(t.c, corner_at(m, 3 * i + 2), sizeof t.c);
    return t;
}

static void turn_triangle(mesh *m, int32_t i) {
    int32_t corner = m->corners.data[3 * i];
    m->corners.data[3 * i] = m->corners.data[3 * i + 1];
    m->corners.data[3 * i + 1] = corner;
}

static void turn_all(mesh *m) {
    for (int32_t i = 0; i < m->corners.count / 3; i++) {
        turn_triangle(m, i);
    }
}

static mesh hollow_cube(void) {
    mesh m = {0}, cavity = {0};
    put_box(&cavity, 3, 3, 3, 7, 8, 6);
    turn_all(&cavity);
    put_box(&m, 0, 0, 0, 10, 10, 10);
    for (int32_t h = 0; h < cavity.corners.count; h++) {
        if (h % 3 == 0) {
            int32_t v[3];
            for (int k = 0; k < 3; k++) {
                v[k] = put_vertex(&m, corner_at(&cavity, h + k));
            }
            put_triangle(&m, v[0], v[1], v[2]);
        }
    }
    free_mesh(&cavity);
    return m;
}

static mesh tetrahedron(double corners[4][3]) {
    mesh m = {0};
    for (int i = 0; i < 4; i++) {
        put_vertex(&m, corners[i]);
    }
    put_triangle(&m, 0, 2, 1);
    put_triangle(&m, 0, 1, 3);
    put_triangle(&m, 1, 2, 3);
    put_triangle(&m, 2, 0, 3);
    return m;
}

// An octahedron's globe turns every other eighth the other way.
static mesh turned_globe(int n, double radius) {
    mesh m = globe(n, radius);
    for (int32_t i = 0; i < m.corners.count / 3; i++) {
        double normal[3];
        vn_triangle t = triangle_at(&m, i);
        cross_of(t.a, t.b, t.c, normal);
        if (dot_of(normal, t.a) < 0) {
            turn_triangle(&m, i);
        }
    }
    return m;
}

static void on_torus(double u, double v, double p[3]) {
    double a = u == 1 ? 0 : 2 * pi * u, b = v == 1 ? 0 : 2 * pi * v;
    set(p, (5 + 2 * cos(b)) * cos(a), (5 + 2 * cos(b)) * sin(a), 2 * sin(b));
}

// A step: two of four quarters of a prism.
static mesh step_mesh(void) {
    static const double flat[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    static const int ears[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 5}, {3, 4, 5}};
    mesh m = {0};
    for (int i = 0; i < 12; i++) {
        put_vertex(&m, (double[3]){flat[i % 6][0], flat[i % 6][1], i < 6 ? 0 : 1});
    }
    for (int i = 0; i < 4; i++) {
        put_triangle(&m, ears[i][0], ears[i][2], ears[i][1]);
        put_triangle(&m, 6 + ears[i][0], 6 + ears[i][1], 6 + ears[i][2]);
    }
    for (int i = 0; i < 6; i++) {
        int j = (i + 1) % 6;
        put_triangle(&m, i, j, 6 + j);
        put_triangle(&m, i, 6 + j, 6 + i);
    }
    return m;
}

enum { SHAPES = 6 };
static mesh shape_mesh(int shape) {
    static double corners[4][3] = {{0, 0, 0}, {3, 1, 0}, {1, 3, -1}, {1, 1, 4}};
    switch (shape) {
    case 0:
        return box_mesh(-2, 3);
    case 1:
        return tetrahedron(corners);
    case 2:
        return turned_globe(6, 4);
    case 3:
        return sheet(on_torus, 24, 12);
    case 4:
        return hollow_cube();
    default:
        return step_mesh();
    }
}

static vn_status try_inside(const mesh *m, bool check, vn_domain **domain) {
    vn_status status =
        vn_domain_inside(domain, m->xyz.data, m->xyz.count / 3, m->corners.data, m->corners.count / 3, check);
    assert_true((*domain == NULL) == (status != VN_OK));
    return status;
}

static vn_domain *inside_of(const mesh *m) {
    vn_domain *domain;
    vn_status status = try_inside(m, true, &domain);
    if (status != VN_OK) {
        print_error("%s\n", vn_message());
    }
    assert_ok(status);
    return domain;
}

// ---- Oracles ----

static double volume_of(const mesh *m) {
    double sum = 0, n[3], origin[3] = {0};
    for (int32_t i = 0; i < m->corners.count / 3; i++) {
        vn_triangle t = triangle_at(m, i);
        cross_of(origin, t.b, t.c, n);
        sum += dot_of(t.a, n) / 6;
    }
    return fabs(sum);
}

// How often the mesh, whose triangles turn alike, winds round a point (Van Oosterom and Strackee).
static double winding_of(const mesh *m, const double p[3]) {
    double sum = 0, origin[3] = {0};
    for (int32_t i = 0; i < m->corners.count / 3; i++) {
        vn_triangle t = triangle_at(m, i);
        double n[3], la, lb, lc;
        for (int k = 0; k < 3; k++) {
            t.a[k] -= p[k];
            t.b[k] -= p[k];
            t.c[k] -= p[k];
        }
        la = sqrt(dot_of(t.a, t.a));
        lb = sqrt(dot_of(t.b, t.b));
        lc = sqrt(dot_of(t.c, t.c));
        cross_of(origin, t.b, t.c, n);
        sum += 2 * atan2(dot_of(t.a, n), la * lb * lc + dot_of(t.a, t.b) * lc + dot_of(t.b, t.c) * la +
                                             dot_of(t.c, t.a) * lb);
    }
    return sum / (4 * pi);
}

static double nearest_of(const mesh *m, const double p[3]) {
    double least = INFINITY;
    for (int32_t i = 0; i < m->corners.count / 3; i++) {
        vn_triangle t = triangle_at(m, i);
        least = fmin(least, to_triangle(p, &t));
    }
    return least;
}

typedef enum placing { ANYWHERE, DEGENERATE, CLOSE, PLACINGS } placing;

// Degenerate: most coordinates are a vertex's, or half of one's, so that lines along the axes pass through
// vertices, edges and faces. Close: a little off a triangle.
static void place_somewhere(const mesh *m, const vn_box *box, vn_rng *rng, placing how, double p[3]) {
    int32_t triangle = (int32_t)whole(rng, 0, m->corners.count / 3 - 1);
    double u = uniform(rng, 0, 1), v = uniform(rng, 0, 1 - u);
    vn_triangle t = triangle_at(m, triangle);
    for (int k = 0; k < 3; k++) {
        double size = box->max[k] - box->min[k];
        p[k] = uniform(rng, box->min[k] - 0.2 * size, box->max[k] + 0.2 * size);
        if (how == DEGENERATE && whole(rng, 0, 3) > 0) {
            double other = m->xyz.data[3 * whole(rng, 0, m->xyz.count / 3 - 1) + k];
            p[k] = whole(rng, 0, 1) ? other : 0.5 * other + 0.5 * p[k];
        }
        if (how == CLOSE) {
            p[k] = (1 - u - v) * t.a[k] + u * t.b[k] + v * t.c[k] + uniform(rng, -0.02, 0.02) * size;
        }
    }
}

// Returns how many were inside.
static int check_points(const mesh *m, const vn_domain *domain, placing how, int trials, vn_rng *rng) {
    vn_box box = vn_domain_bounds(domain);
    int in = 0;
    for (int trial = 0; trial < trials; trial++) {
        double p[3], q[3];
        place_somewhere(m, &box, rng, how, p);
        double least = nearest_of(m, p), distance = vn_domain_distance(domain, p);
        assert_near(fabs(distance), least, 1e-12);
        vn_domain_closest(domain, p, q);
        assert_near(sqrt(vn_distance2(p, q)), least, 1e-12);
        assert_near(nearest_of(m, q), 0, 1e-12);
        if (least > 1e-9) {
            bool inside = fabs(winding_of(m, p)) > 0.5;
            assert_int_equal(vn_domain_contains(domain, p), inside);
            assert_int_equal(distance > 0, inside);
            in += inside;
        }
    }
    return in;
}

// ---- Exact signs ----

__extension__ typedef __int128 wide;

// Whole numbers below 2^38, of which the determinant is exact in 128 bits.
static int sign_of_turn(int64_t v[4][3]) {
    wide d[3][3];
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            d[i][k] = i < 2 ? v[i + 1][k] - v[0][k] : v[3][k] - v[0][k];
        }
    }
    wide det = 0;
    for (int k = 0; k < 3; k++) {
        det += d[0][k] * (d[1][(k + 1) % 3] * d[2][(k + 2) % 3] - d[1][(k + 2) % 3] * d[2][(k + 1) % 3]);
    }
    return (det > 0) - (det < 0);
}

static void the_side_of_a_plane_is_exact(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(1);
    int zero = 0;
    for (int trial = 0; trial < 100000; trial++) {
        int64_t v[4][3], along[2] = {whole(&rng, -1000, 1000), whole(&rng, -1000, 1000)};
        double p[4][3];
        for (int k = 0; k < 3; k++) {
            for (int i = 0; i < 3; i++) {
                v[i][k] = whole(&rng, -(1LL << 26), 1LL << 26);
            }
            // in the plane of the others, or off it by next to nothing
            v[3][k] = v[0][k] + along[0] * (v[1][k] - v[0][k]) + along[1] * (v[2][k] - v[0][k]);
            v[3][k] += whole(&rng, 0, 3) == 0 ? whole(&rng, -1, 1) : 0;
            for (int i = 0; i < 4; i++) {
                p[i][k] = ldexp((double)v[i][k], -30);
            }
        }
        int expected = sign_of_turn(v);
        double turn = vn_turn_3(p[0], p[1], p[2], p[3]);
        assert_int_equal((turn > 0) - (turn < 0), expected);
        turn = vn_turn_3(p[1], p[0], p[2], p[3]);
        assert_int_equal((turn > 0) - (turn < 0), -expected);
        zero += expected == 0;
    }
    assert_true(zero > 10000 && zero < 90000);
}

// ---- What it answers ----

static void points_are_inside_where_the_mesh_winds_round_them(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(2);
    for (int shape = 0; shape < SHAPES; shape++) {
        mesh m = shape_mesh(shape);
        vn_domain *domain = inside_of(&m);
        for (placing how = ANYWHERE; how < PLACINGS; how++) {
            assert_true(check_points(&m, domain, how, 3000, &rng) > 90);
        }
        vn_domain_release(domain);
        free_mesh(&m);
    }
}

static void volumes_are_those_of_the_shapes(void **state) {
    (void)state;
    for (int shape = 0; shape < SHAPES; shape++) {
        mesh m = shape_mesh(shape);
        vn_domain *domain = inside_of(&m);
        assert_near(vn_domain_measure(domain), volume_of(&m), 1e-12 * volume_of(&m));
        assert_int_equal(vn_domain_dim(domain), 3);
        vn_domain_release(domain);
        free_mesh(&m);
    }
    mesh cube = box_mesh(-2, 3), hollow = hollow_cube(), ball = globe(60, 3),
         ring = sheet(on_torus, 200, 100);
    const struct {
        mesh *m;
        double volume, off;
    } known[] = {
        {&cube, 125, 1e-12}, {&hollow, 940, 1e-12}, {&ball, 36 * pi, 1e-3}, {&ring, 40 * pi * pi, 1e-3}};
    for (int i = 0; i < 4; i++) {
        vn_domain *domain = inside_of(known[i].m);
        assert_near(vn_domain_measure(domain), known[i].volume, known[i].off * known[i].volume);
        vn_domain_release(domain);
        free_mesh(known[i].m);
    }
}

static void it_does_not_matter_how_triangles_turn(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(3);
    for (int shape = 0; shape < SHAPES; shape++) {
        mesh m = shape_mesh(shape);
        vn_domain *plain = inside_of(&m);
        for (int32_t i = 0; i < m.corners.count / 3; i++) {
            if (whole(&rng, 0, 1)) {
                turn_triangle(&m, i);
            }
        }
        vn_domain *turned = inside_of(&m);
        vn_box box = vn_domain_bounds(plain);
        assert_near(vn_domain_measure(turned), vn_domain_measure(plain), 1e-12 * vn_domain_measure(plain));
        for (int trial = 0; trial < 1000; trial++) {
            double p[3];
            place_somewhere(&m, &box, &rng, (placing)(trial % PLACINGS), p);
            double distance = vn_domain_distance(plain, p);
            if (fabs(distance) > 1e-9) {
                assert_near(vn_domain_distance(turned, p), distance, 1e-12);
            }
        }
        vn_domain_release(plain);
        vn_domain_release(turned);
        free_mesh(&m);
    }
}

// A box in a box in a box, and another one beside them, all turned outwards.
static void shells_in_shells_are_solid_and_hollow_in_turn(void **state) {
    (void)state;
    mesh m = {0};
    for (int i = 0; i < 3; i++) {
        put_box(&m, i, i, i, 9 - i, 9 - i, 9 - i);
    }
    put_box(&m, 20, 0, 0, 21, 1, 1);
    vn_domain *domain = inside_of(&m);
    assert_near(vn_domain_measure(domain), 729 - 343 + 125 + 1, 1e-10);
    double p[3] = {0.5, 4.5, 4.5}, q[3] = {1.25, 4.5, 4.5}, r[3] = {4.5, 4.5, 4.5}, s[3] = {20.5, 0.5, 0.5};
    assert_near(vn_domain_distance(domain, p), 0.5, 1e-15);
    assert_near(vn_domain_distance(domain, q), -0.25, 1e-15);
    assert_near(vn_domain_distance(domain, r), 2.5, 1e-15);
    assert_near(vn_domain_distance(domain, s), 0.5, 1e-15);
    assert_false(vn_domain_sees(domain, p, r));
    assert_false(vn_domain_sees(domain, p, s));
    assert_true(vn_domain_sees(domain, p, (double[3]){0.5, 8.5, 0.5}));
    vn_domain_release(domain);
    free_mesh(&m);
}

// Two cubes that share an edge, and two that share a corner: each of them has all its edges.
static void parts_may_touch_in_edges_and_corners(void **state) {
    (void)state;
    for (int edge = 0; edge < 2; edge++) {
        mesh m = {0};
        put_box(&m, 0, 0, 0, 1, 1, 1);
        put_box(&m, 1, 1, edge ? 0 : 1, 2, 2, edge ? 1 : 2);
        vn_domain *domain = inside_of(&m);
        assert_near(vn_domain_measure(domain), 2, 1e-12);
        vn_rng rng = vn_rng_make(4);
        check_points(&m, domain, DEGENERATE, 2000, &rng);
        vn_domain_release(domain);
        free_mesh(&m);
    }
}

static void nothing_but_finite_points_are_inside(void **state) {
    (void)state;
    mesh m = turned_globe(6, 4);
    vn_domain *domain = inside_of(&m);
    static const double odd[] = {NAN, INFINITY, -INFINITY, 1e300, -1e300, 1e25, 5e-324};
    for (int i = 0; i < 7; i++) {
        for (int k = 0; k < 3; k++) {
            double p[3] = {0.1, 0.2, 0.3}, q[3];
            p[k] = odd[i];
            vn_domain_closest(domain, p, q);
            assert_int_equal(vn_domain_contains(domain, p), i == 6);
        }
    }
    double far[3] = {1e12, 0, 0};
    assert_near(vn_domain_distance(domain, far), -(1e12 - 4), 1e-3);
    vn_domain_release(domain);
    for (int i = 0; i < m.xyz.count; i++) {
        m.xyz.data[i] *= 1e-50;
    }
    domain = inside_of(&m);
    double p[3] = {1e-50, 2e-50, 3e-50};
    assert_true(vn_domain_contains(domain, p));
    assert_near(vn_domain_distance(domain, p) * 1e50, 4 - sqrt(14), 0.1);
    vn_domain_release(domain);
    free_mesh(&m);
}

// ---- Sight ----

// Where the line passes each triangle's plane, by how much it is inside the triangle (as a share of its
// size): false when it is a close call.
static bool is_clear_cut(const mesh *m, const double a[3], const double b[3], bool *free) {
    *free = true;
    for (int32_t i = 0; i < m->corners.count / 3; i++) {
        vn_triangle t = triangle_at(m, i);
        double n[3], from[3], to[3], x[3];
        cross_of(t.a, t.b, t.c, n);
        for (int k = 0; k < 3; k++) {
            from[k] = a[k] - t.a[k];
            to[k] = b[k] - t.a[k];
        }
        double da = dot_of(n, from), db = dot_of(n, to);
        if (fabs(da) < 1e-9 || fabs(db) < 1e-9) {
            return false;
        }
        for (int k = 0; k < 3; k++) {
            x[k] = a[k] + da / (da - db) * (b[k] - a[k]);
        }
        double off = da * db < 0 ? to_triangle(x, &t) : 1;
        if (off > 1e-12 && off < 1e-6) {
            return false;
        }
        *free = *free && off > 1e-6;
    }
    return true;
}

static void lines_that_cross_no_triangle_are_free(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(5);
    for (int shape = 0; shape < SHAPES; shape++) {
        mesh m = shape_mesh(shape);
        vn_domain *domain = inside_of(&m);
        int seen = 0, hidden = 0;
        for (int trial = 0; trial < 1000; trial++) {
            double p[3], q[3];
            bool free;
            assert_ok(vn_domain_dart(domain, &rng, p));
            assert_ok(vn_domain_dart(domain, &rng, q));
            if (is_clear_cut(&m, p, q, &free)) {
                assert_int_equal(vn_domain_sees(domain, p, q), free);
                assert_int_equal(vn_domain_sees(domain, q, p), free);
                seen += free;
                hidden += !free;
            }
        }
        bool convex = shape < 3;
        assert_true(seen > 200 && (hidden > 50 || (convex && hidden == 0)));
        vn_domain_release(domain);
        free_mesh(&m);
    }
}

// So that boxes of triangles are full of what is beside them; quarters stay exact.
static void slant(double p[3]) {
    set(p, p[0] - 2 * p[2] + p[1], p[1] + p[0] + p[2], p[2] - p[1]);
}

static bool step_sees(const vn_domain *step, bool slanted, double x0, double y0, double x1, double y1) {
    double p[3] = {x0, y0, 0.5}, q[3] = {x1, y1, 0.25};
    if (slanted) {
        slant(p);
        slant(q);
    }
    bool sees = vn_domain_sees(step, p, q);
    assert_int_equal(vn_domain_sees(step, q, p), sees);
    return sees;
}

// In the step, the planes of its hollow edge are continued inside: lines in them are free.
static void lines_in_the_plane_of_a_triangle_are_free_until_it_ends_them(void **state) {
    (void)state;
    for (int slanted = 0; slanted < 2; slanted++) {
        mesh m = step_mesh();
        for (int32_t i = 0; slanted && i < m.xyz.count; i += 3) {
            slant(m.xyz.data + i);
        }
        vn_domain *step = inside_of(&m);
        assert_true(step_sees(step, slanted, 0.25, 1, 0.75, 1));
        assert_true(step_sees(step, slanted, 1, 0.25, 1, 0.75));
        assert_true(step_sees(step, slanted, 0.25, 1, 1, 1)); // ends on the border
        assert_true(step_sees(step, slanted, 1, 0.25, 1, 1));
        assert_true(step_sees(step, slanted, 0.25, 1, 1.5, 0.5));
        assert_false(step_sees(step, slanted, 0.5, 1.5, 1.5, 0.5)); // touches the hollow edge
        assert_false(step_sees(step, slanted, 0.5, 1.75, 1.75, 0.5));
        vn_domain_release(step);
        free_mesh(&m);
    }
}

// ---- Darts ----

static void darts_are_spread_evenly_over_the_volume(void **state) {
    (void)state;
    enum { SIDE = 5, DARTS = 40000 };
    mesh m = hollow_cube();
    vn_domain *domain = inside_of(&m);
    int32_t hits[SIDE * SIDE * SIDE] = {0};
    vn_rng rng = vn_rng_make(6);
    for (int i = 0; i < DARTS; i++) {
        double p[3];
        assert_ok(vn_domain_dart(domain, &rng, p));
        assert_true(vn_domain_contains(domain, p));
        hits[(int)(p[0] / 2) + SIDE * (int)(p[1] / 2) + SIDE * SIDE * (int)(p[2] / 2)]++;
    }
    double chi2 = 0;
    int blocks = 0;
    for (int i = 0; i < SIDE * SIDE * SIDE; i++) {
        double cavity = 1, low[3] = {3, 3, 3}, high[3] = {7, 8, 6};
        int at[3] = {i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE};
        for (int k = 0; k < 3; k++) {
            cavity *= fmax(0, fmin(high[k], 2 * at[k] + 2) - fmax(low[k], 2 * at[k]));
        }
        double expected = DARTS * (8 - cavity) / 940;
        assert_true(expected > 0 || hits[i] == 0);
        if (expected > 0) {
            chi2 += (hits[i] - expected) * (hits[i] - expected) / expected;
            blocks++;
        }
    }
    assert_true(chi2 > 0.6 * blocks && chi2 < 1.6 * blocks); // 5 standard deviations and more
    vn_domain_release(domain);
    free_mesh(&m);
}

static void darts_hit_thin_shells(void **state) {
    (void)state;
    mesh m = {0};
    put_box(&m, 0, 0, 0, 1, 1, 1);
    put_box(&m, 1e-5, 1e-5, 1e-5, 1 - 1e-5, 1 - 1e-5, 1 - 1e-5);
    vn_domain *domain = inside_of(&m);
    vn_rng rng = vn_rng_make(7);
    int32_t high[3] = {0};
    for (int i = 0; i < 1000; i++) {
        double p[3];
        assert_ok(vn_domain_dart(domain, &rng, p));
        assert_true(vn_domain_contains(domain, p));
        for (int k = 0; k < 3; k++) {
            high[k] += p[k] > 0.5;
        }
    }
    for (int k = 0; k < 3; k++) {
        assert_in_range(high[k], 420, 580);
    }
    vn_domain_release(domain);
    free_mesh(&m);
}

// ---- What is refused ----

static void refused(const mesh *m, bool check, const char *message) {
    vn_domain *domain;
    assert_int_equal(try_inside(m, check, &domain), VN_INVALID);
    assert_message(message);
    vn_domain_release(domain);
}

static void meshes_without_an_inside_are_refused(void **state) {
    (void)state;
    mesh m = box_mesh(0, 1);
    m.corners.count -= 3;
    refused(&m, true,
            "inside: the mesh is not closed: edges with a triangle on one side only: 3, around 1 "
            "hole, the largest of 3 edges, the first at vertex 4 at (0, 0, 1); give repair = true");
    m.corners.count = 3;
    refused(
        &m, true,
        "one side only: 3, around 1 hole, the largest of 3 edges, the first at vertex 0 at (0, 0, 0); give");
    m.corners.count = 0;
    refused(&m, true, "inside: the mesh is empty: it has 8 vertices and 0 faces");
    free_mesh(&m);

    m = box_mesh(0, 1);
    int32_t top = put_vertex(&m, (double[3]){0.5, -1, -1});
    put_triangle(&m, 0, 1, top); // a fin
    refused(&m, true, "the mesh is not closed: edges with a triangle on one side only: 2");
    put_triangle(&m, top, 1, put_vertex(&m, (double[3]){0.5, -2, -1}));
    put_triangle(&m, top, 0, m.xyz.count / 3 - 1);
    put_triangle(&m, 0, 1, m.xyz.count / 3 - 1); // a tetrahedron on the edge: there are four
    vn_domain *domain = inside_of(&m);
    vn_domain_release(domain);
    free_mesh(&m);
}

static void a_sheet_inside_is_refused(void **state) {
    (void)state;
    mesh m = {0};
    put_box(&m, 0, 0, 0, 1, 1, 1);
    put_box(&m, 1, 0, 0, 2, 1, 1); // the wall between them twice; then once
    int32_t kept = 0;
    for (int32_t i = 0; i < m.corners.count / 3; i++) {
        vn_triangle t = triangle_at(&m, i);
        bool wall = i >= 12 && t.a[0] == 1 && t.b[0] == 1 && t.c[0] == 1;
        if (!wall) {
            memmove(m.corners.data + 3 * kept++, m.corners.data + 3 * i, 3 * sizeof *m.corners.data);
        }
    }
    assert_int_equal(kept, 22);
    m.corners.count = 3 * kept;
    refused(&m, true,
            "inside: the mesh has sheets inside: edges with an odd number of triangles, 3 or more: 4");
    assert_message("the first from vertex");
    assert_message("remove the inner sheets");
    free_mesh(&m);
}

static void meshes_that_enclose_nothing_are_refused(void **state) {
    (void)state;
    static double flat[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.25, 0.25, 0}};
    mesh m = tetrahedron(flat);
    refused(&m, false, "inside: the mesh encloses no volume");
    refused(&m, true, "crosses or touches itself");
    free_mesh(&m);
    m = (mesh){0};
    for (int i = 0; i < 3; i++) {
        put_vertex(&m, flat[i]);
    }
    put_triangle(&m, 0, 1, 2);
    put_triangle(&m, 2, 1, 0);
    refused(&m, true, "inside: the mesh encloses no volume");
    free_mesh(&m);
}

// Edges of one against triangles of the other, in general position.
static bool tetrahedra_meet(const mesh *m) {
    for (int side = 0; side < 2; side++) {
        for (int32_t h = 0; h < 12; h++) {
            int32_t edge = 12 * side + h;
            const double *a = corner_at(m, edge), *b = corner_at(m, edge - edge % 3 + (edge + 1) % 3);
            for (int32_t i = 0; i < 4; i++) {
                double n[3], d[2], x[3];
                vn_triangle t = triangle_at(m, 4 * (1 - side) + i);
                cross_of(t.a, t.b, t.c, n);
                d[0] = dot_of(n, a) - dot_of(n, t.a);
                d[1] = dot_of(n, b) - dot_of(n, t.a);
                for (int k = 0; k < 3; k++) {
                    x[k] = a[k] + d[0] / (d[0] - d[1]) * (b[k] - a[k]);
                }
                if (d[0] * d[1] < 0 && to_triangle(x, &t) < 1e-12) {
                    return true;
                }
            }
        }
    }
    return false;
}

static void crossings_are_found(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(8);
    int met = 0, apart = 0;
    for (int trial = 0; trial < 500; trial++) {
        mesh m = {0};
        for (int part = 0; part < 2; part++) {
            double corners[4][3];
            for (int i = 0; i < 12; i++) {
                corners[i / 3][i % 3] = uniform(&rng, 0, 1) + (i % 3 == 0 ? 0.4 * part : 0);
            }
            mesh one = tetrahedron(corners);
            for (int i = 0; i < 4; i++) {
                put_vertex(&m, corners[i]);
            }
            for (int32_t h = 0; h < 12; h += 3) {
                const int32_t *c = one.corners.data + h;
                put_triangle(&m, 4 * part + c[0], 4 * part + c[1], 4 * part + c[2]);
            }
            free_mesh(&one);
        }
        vn_domain *domain;
        bool meet = tetrahedra_meet(&m);
        assert_int_equal(try_inside(&m, true, &domain), meet ? VN_INVALID : VN_OK);
        if (meet) {
            assert_message("inside: the mesh crosses or touches itself: the edge from vertex ");
        }
        vn_domain_release(domain);
        met += meet;
        apart += !meet;
        free_mesh(&m);
    }
    assert_true(met > 100 && apart > 100);
}

static void touching_is_found_but_for_common_corners_and_edges(void **state) {
    (void)state;
    static const struct {
        double box[6];
        bool refused;
    } second[] = {
        {{2, 0, 0, 3, 1, 1}, false},          // apart
        {{1, 1, 1, 2, 2, 2}, false},          // a corner
        {{1, 1, 0, 2, 2, 1}, false},          // an edge
        {{1, 1, 0.5, 2, 2, 2}, true},         // a part of an edge
        {{1, 0, 0, 2, 1, 1}, false},          // a whole face: all of its triangles twice
        {{1, 0.25, 0.25, 2, 0.5, 0.5}, true}, // a part of a face
        {{1, -1, -1, 2, 2, 2}, true},         // likewise, all within the other's
        {{0.25, 0.25, 0.25, 0.5, 0.5, 0.5}, false},
        {{0, 0.25, 0.25, 0.5, 0.5, 0.5}, true}, // inside, and touching
        {{0.5, 0.5, 0.5, 2, 2, 2}, true},
        {{0.5, 0, 0, 1.5, 1, 1}, true}, // faces in the same planes
    };
    for (size_t i = 0; i < sizeof second / sizeof *second; i++) {
        mesh m = {0};
        const double *b = second[i].box;
        vn_domain *domain;
        put_box(&m, 0, 0, 0, 1, 1, 1);
        put_box(&m, b[0], b[1], b[2], b[3], b[4], b[5]);
        assert_int_equal(try_inside(&m, true, &domain), second[i].refused ? VN_INVALID : VN_OK);
        vn_domain_release(domain);
        free_mesh(&m);
    }
}

// Without the check, what two parts have in common is outside.
static void a_mesh_that_crosses_itself_is_taken_as_it_is_when_told(void **state) {
    (void)state;
    mesh m = {0};
    put_box(&m, 0, 0, 0, 1, 1, 1);
    put_box(&m, 0.5, 0.25, 0.25, 2, 0.75, 0.75);
    vn_domain *domain;
    assert_ok(try_inside(&m, false, &domain));
    double one[3] = {0.25, 0.5, 0.5}, both[3] = {0.75, 0.5, 0.5}, other[3] = {1.5, 0.5, 0.5};
    assert_true(vn_domain_contains(domain, one));
    assert_false(vn_domain_contains(domain, both));
    assert_true(vn_domain_contains(domain, other));
    vn_domain_release(domain);
    free_mesh(&m);
}

static void an_inside_loses_nothing_when_memory_runs_out(void **state) {
    (void)state;
    mesh m = hollow_cube();
    vn_status status = VN_NO_MEMORY;
    vn_domain *domain;
    for (int64_t nth = 0; status == VN_NO_MEMORY; nth++) {
        vn_fail_allocations_from(nth);
        status = try_inside(&m, true, &domain);
        vn_fail_allocations_from(-1);
        assert_true(nth < 200);
    }
    assert_ok(status);
    vn_domain_release(domain);
    free_mesh(&m);
}

// ---- An organ ----

static uint64_t answers_of(const vn_domain *domain) {
    vn_rng rng = vn_rng_make(9);
    uint64_t hash = 0;
    for (int i = 0; i < 2000; i++) {
        double p[3];
        uint64_t bits;
        assert_ok(vn_domain_dart(domain, &rng, p));
        double distance = vn_domain_distance(domain, p);
        assert_true(distance > 0);
        memcpy(&bits, &distance, sizeof bits);
        hash = vn_hash(hash, bits, 0, 0);
    }
    return hash;
}

static void a_liver_is_the_same_at_any_number_of_threads(void **state) {
    (void)state;
    uint64_t hash[2];
    for (int k = 0; k < 2; k++) {
        vn_set_threads(k == 0 ? 1 : 3);
        vn_domain *domain = liver();
        hash[k] = answers_of(domain);
        assert_near(vn_domain_measure(domain), 1741605.8, 0.1);
        assert_near(vn_domain_measure_by_points(domain), vn_domain_measure(domain), 2000);
        vn_domain_release(domain);
    }
    vn_set_threads(0);
    assert_true(hash[0] == hash[1]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(the_side_of_a_plane_is_exact),
        counted_test(points_are_inside_where_the_mesh_winds_round_them),
        counted_test(volumes_are_those_of_the_shapes),
        counted_test(it_does_not_matter_how_triangles_turn),
        counted_test(shells_in_shells_are_solid_and_hollow_in_turn),
        counted_test(parts_may_touch_in_edges_and_corners),
        counted_test(nothing_but_finite_points_are_inside),
        counted_test(lines_that_cross_no_triangle_are_free),
        counted_test(lines_in_the_plane_of_a_triangle_are_free_until_it_ends_them),
        counted_test(darts_are_spread_evenly_over_the_volume),
        counted_test(darts_hit_thin_shells),
        counted_test(meshes_without_an_inside_are_refused),
        counted_test(a_sheet_inside_is_refused),
        counted_test(meshes_that_enclose_nothing_are_refused),
        counted_test(crossings_are_found),
        counted_test(touching_is_found_but_for_common_corners_and_edges),
        counted_test(a_mesh_that_crosses_itself_is_taken_as_it_is_when_told),
        counted_test(an_inside_loses_nothing_when_memory_runs_out),
        counted_test(a_liver_is_the_same_at_any_number_of_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
