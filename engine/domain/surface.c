// The surface of a triangle mesh, as a domain in space. Distances along it are measured straight: that is
// right while what looks for each other is nearer than the surface's folds are.

#include "domain/domain.h"
#include "domain/faces.h"
#include "domain/seams.h"
#include "domain/stretch.h"
#include "space/triangle_tree.h"

// Halfedge 3t + k leads from corner k of triangle t to the next one.
typedef struct surface {
    vn_domain base;
    VN_ARRAY(double) xyz;
    vn_corners corners;          ///< three a triangle
    vn_corners mate;             ///< of each halfedge the next one at the same edge (vn_seams_link())
    VN_ARRAY(double) area_up_to; ///< of each triangle, with all before it
    vn_triangle_tree tree;
    vn_triangle_tree border; ///< of edges that one triangle has for itself
    double tolerance;
} surface;

static const surface *surface_of(const vn_domain *domain) {
    return (const surface *)domain;
}

static const double *place(const surface *s, int32_t vertex) {
    return s->xyz.data + 3 * (int64_t)vertex;
}

static const double *corner_of(const surface *s, int32_t triangle, int k) {
    return place(s, s->corners.data[3 * (int64_t)triangle + k % 3]);
}

static vn_triangle triangle_of(const surface *s, int32_t triangle) {
    vn_triangle t;
    memcpy(t.a, corner_of(s, triangle, 0), sizeof t.a);
    memcpy(t.b, corner_of(s, triangle, 1), sizeof t.b);
    memcpy(t.c, corner_of(s, triangle, 2), sizeof t.c);
    return t;
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(double n[3], const double a[3], const double b[3]) {
    n[0] = a[1] * b[2] - a[2] * b[1];
    n[1] = a[2] * b[0] - a[0] * b[2];
    n[2] = a[0] * b[1] - a[1] * b[0];
}

// Of the length of twice its area.
static void normal_of(const surface *s, int32_t triangle, double n[3]) {
    double ab[3], ac[3];
    vn_triangle t = triangle_of(s, triangle);
    for (int k = 0; k < 3; k++) {
        ab[k] = t.b[k] - t.a[k];
        ac[k] = t.c[k] - t.a[k];
    }
    cross(n, ab, ac);
}

static bool scale_to_one(double n[3]) {
    double length = sqrt(dot(n, n));
    for (int k = 0; k < 3; k++) {
        n[k] = length > 0 ? n[k] / length : 0;
    }
    return length > 0;
}

// ---- What a domain answers ----

static bool end_visit(int32_t number, void *payload) {
    (void)number;
    (void)payload;
    return false;
}

static bool is_near(const vn_triangle_tree *tree, const double p[3], double distance) {
    return !vn_triangle_tree_around(tree, p, distance * distance, end_visit, NULL);
}

static bool surface_contains(const vn_domain *domain, const double p[3]) {
    return is_near(&surface_of(domain)->tree, p, surface_of(domain)->tolerance);
}

static double surface_closest(const vn_domain *domain, const double p[3], double q[3]) {
    const surface *s = surface_of(domain);
    double d2;
    memcpy(q, p, 3 * sizeof *q);
    vn_triangle_tree_nearest(surface_contains(domain, p) ? &s->border : &s->tree, p, INFINITY, &d2, q);
    return sqrt(d2);
}

static bool surface_snap(const vn_domain *domain, const double p[3], double q[3]) {
    const surface *s = surface_of(domain);
    double d2;
    memcpy(q, p, 3 * sizeof *q);
    vn_triangle_tree_nearest(&s->tree, p, INFINITY, &d2, q);
    return d2 <= s->tolerance * s->tolerance || !is_near(&s->border, q, s->tolerance);
}

static vn_status surface_dart(const vn_domain *domain, vn_rng *rng, double p[3]) {
    const surface *s = surface_of(domain);
    double area = vn_rng_uniform(rng, 0, domain->measure);
    int32_t low = 0, high = s->area_up_to.count - 1;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (s->area_up_to.data[middle] > area) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    double root = sqrt(vn_rng_uniform(rng, 0, 1)), share = vn_rng_uniform(rng, 0, 1);
    vn_triangle t = triangle_of(s, low);
    for (int k = 0; k < 3; k++) {
        p[k] = (1 - root) * t.a[k] + root * (1 - share) * t.b[k] + root * share * t.c[k];
    }
    return VN_OK;
}

// ---- Sight ----

/// A walk from a along the section of the surface with the plane through the line and the surface's normal.
typedef struct walk {
    const surface *s;
    const double *a, *b;
    double along[3];  ///< the line's direction
    double across[3]; ///< normal to the plane
    double left;      ///< how much longer the walk may be
    double at[3];     ///< where it is
    bool arrived;
} walk;

// The section is hardly longer than the line, or it leads round something.
static const double LONGEST_WALK = 1.2;

static bool reaches_end(const walk *w, int32_t triangle) {
    double q[3];
    vn_triangle t = triangle_of(w->s, triangle);
    double near = 2 * w->s->tolerance;
    return vn_triangle_closest(&t, w->b, q) <= near * near && vn_distance2(w->at, w->b) <= w->left * w->left;
}

static double side_of(const walk *w, const double p[3]) {
    return dot(w->across, p) - dot(w->across, w->a);
}

// Whether the plane passes halfedge @p h, and where. What is in the plane counts as on its right side: so it
// passes two of a triangle's edges or none.
static bool is_passed(const walk *w, int32_t h, double q[3]) {
    const double *p0 = corner_of(w->s, h / 3, h % 3), *p1 = corner_of(w->s, h / 3, h % 3 + 1);
    double s0 = side_of(w, p0), s1 = side_of(w, p1);
    if ((s0 >= 0) == (s1 >= 0)) {
        return false;
    }
    for (int k = 0; k < 3; k++) {
        q[k] = p0[k] + s0 / (s0 - s1) * (p1[k] - p0[k]);
    }
    return true;
}

// Through halfedge @p h into the next triangle: the halfedge that leads out of it again, or -1 at the border.
// Where several triangles meet in an edge, the one that leads nearest to the end.
static int32_t next_halfedge(walk *w, int32_t h, double q[3]) {
    int32_t best = -1;
    double least = INFINITY, p[3];
    for (int32_t in = w->s->mate.data[h]; in != h && !w->arrived; in = w->s->mate.data[in]) {
        w->arrived = reaches_end(w, in / 3);
        for (int k = 1; k < 3; k++) {
            int32_t out = in - in % 3 + (in % 3 + k) % 3;
            if (is_passed(w, out, p) && vn_distance2(p, w->b) < least) {
                least = vn_distance2(p, w->b);
                best = out;
                memcpy(q, p, sizeof p);
            }
        }
    }
    return best;
}

static void go_to(walk *w, const double q[3]) {
    w->left -= sqrt(vn_distance2(w->at, q));
    memcpy(w->at, q, sizeof w->at);
}

// Small triangles may make steps of no length at all, but not more than there are triangles.
static void walk_on(walk *w, int32_t h, const double from[3]) {
    double q[3];
    go_to(w, from);
    for (int32_t steps = 0; w->left >= 0 && steps <= w->s->corners.count / 3; steps++) {
        h = next_halfedge(w, h, q);
        if (w->arrived || h < 0) {
            return;
        }
        go_to(w, q);
    }
}

// Of the two halfedges through which the section leaves this triangle, the one ahead.
static bool walk_from(int32_t triangle, void *payload) {
    walk *w = payload;
    int32_t ahead = -1;
    double q[3], from[3], most = -INFINITY;
    memcpy(w->at, w->a, sizeof w->at);
    w->left = LONGEST_WALK * sqrt(vn_distance2(w->a, w->b));
    w->arrived = reaches_end(w, triangle);
    for (int32_t h = 3 * triangle; h < 3 * triangle + 3 && !w->arrived; h++) {
        if (is_passed(w, h, q) && dot(w->along, q) > most) {
            most = dot(w->along, q);
            ahead = h;
            memcpy(from, q, sizeof q);
        }
    }
    if (ahead >= 0) {
        walk_on(w, ahead, from);
    }
    return !w->arrived;
}

static bool normal_at(const surface *s, const double p[3], double n[3]) {
    double d2, q[3];
    int32_t triangle = vn_triangle_tree_nearest(&s->tree, p, 4 * s->tolerance * s->tolerance, &d2, q);
    if (triangle < 0) {
        return false;
    }
    normal_of(s, triangle, n);
    return scale_to_one(n);
}

// The plane through the line and the mean normal at its ends. There is none where the line leaves the surface
// steeply, as it does from one sheet of a fold to the other.
static bool lay_plane(walk *w) {
    double n[3], m[3];
    for (int k = 0; k < 3; k++) {
        w->along[k] = w->b[k] - w->a[k];
    }
    if (!scale_to_one(w->along) || !normal_at(w->s, w->a, n) || !normal_at(w->s, w->b, m)) {
        return false;
    }
    double same = dot(n, m) < 0 ? -1 : 1;
    for (int k = 0; k < 3; k++) {
        n[k] += same * m[k];
    }
    cross(w->across, w->along, n);
    double sine2 = dot(w->across, w->across);
    return sine2 >= 0.25 * dot(n, n) && scale_to_one(w->across);
}

static bool surface_sees(const vn_domain *domain, const double a[3], const double b[3]) {
    const surface *s = surface_of(domain);
    walk w = {.s = s, .a = a, .b = b};
    double near = 2 * s->tolerance;
    if (vn_distance2(a, b) <= near * near) {
        return true;
    }
    if (lay_plane(&w)) {
        vn_triangle_tree_around(&s->tree, a, near * near, walk_from, &w);
    }
    return w.arrived;
}

// ---- Construction ----

static void surface_destroy(vn_domain *domain) {
    surface *s = (surface *)domain;
    vn_array_free(&s->xyz);
    vn_array_free(&s->corners);
    vn_array_free(&s->mate);
    vn_array_free(&s->area_up_to);
    vn_triangle_tree_free(&s->tree);
    vn_triangle_tree_free(&s->border);
}

static vn_status surface_triangles(const vn_domain *domain, vn_triangles *out) {
    const surface *s = surface_of(domain);
    VN_TRY(vn_array_reserve(&out->xyz, s->xyz.count));
    VN_TRY(vn_array_reserve(&out->corners, s->corners.count));
    memcpy(out->xyz.data, s->xyz.data, (size_t)s->xyz.count * sizeof *s->xyz.data);
    memcpy(out->corners.data, s->corners.data, (size_t)s->corners.count * sizeof *s->corners.data);
    out->xyz.count = s->xyz.count;
    out->corners.count = s->corners.count;
    return VN_OK;
}

static vn_status surface_stretched(vn_domain **out, const vn_domain *domain, const vn_stretch *stretch) {
    vn_triangles moved = {.xyz = {0}};
    vn_status status = vn_stretch_triangles(domain, stretch, &moved);
    if (status == VN_OK) {
        status = vn_domain_surface(out, moved.xyz.data, moved.xyz.count / 3, moved.corners.data,
                                   moved.corners.count / 3);
    }
    vn_triangles_free(&moved);
    return status;
}

static const vn_domain_kind surface_kind = {.name = "surface",
                                            .destroy = surface_destroy,
                                            .contains = surface_contains,
                                            .closest = surface_closest,
                                            .sees = surface_sees,
                                            .dart = surface_dart,
                                            .snap = surface_snap,
                                            .triangles = surface_triangles,
                                            .stretched = surface_stretched};

static void include_place(vn_box *box, const double p[3]) {
    for (int k = 0; k < 3; k++) {
        box->min[k] = fmin(box->min[k], p[k]);
        box->max[k] = fmax(box->max[k], p[k]);
    }
}

// Of the triangles: vertices that none of them has do not count.
static vn_status measure_triangles(surface *s) {
    vn_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    VN_TRY(vn_array_reserve(&s->area_up_to, s->corners.count / 3));
    for (int32_t t = 0; t < s->corners.count / 3; t++) {
        double n[3];
        normal_of(s, t, n);
        s->base.measure += 0.5 * sqrt(dot(n, n));
        s->area_up_to.data[s->area_up_to.count++] = s->base.measure;
        for (int k = 0; k < 3; k++) {
            include_place(&box, corner_of(s, t, k));
        }
    }
    s->base.bounds = box;
    s->tolerance = 1e-6 * sqrt(vn_distance2(box.min, box.max));
    return VN_OK;
}

static vn_status link_triangles(surface *s) {
    vn_corners first = {0};
    vn_status status = vn_seams_link(s->xyz.data, s->xyz.count / 3, &s->corners, &first, &s->mate);
    vn_array_free(&first);
    return status;
}

typedef VN_ARRAY(vn_triangle) triangle_array;

static vn_status build_trees(surface *s, triangle_array *parts) {
    int32_t count = s->corners.count / 3;
    VN_TRY(vn_array_reserve(parts, count));
    for (int32_t t = 0; t < count; t++) {
        parts->data[parts->count++] = triangle_of(s, t);
    }
    VN_TRY(vn_triangle_tree_build(&s->tree, parts->data, parts->count));
    parts->count = 0;
    for (int32_t h = 0; h < s->mate.count; h++) {
        if (s->mate.data[h] == h) {
            vn_triangle edge;
            memcpy(edge.a, corner_of(s, h / 3, h % 3), sizeof edge.a);
            memcpy(edge.b, corner_of(s, h / 3, h % 3 + 1), sizeof edge.b);
            memcpy(edge.c, edge.b, sizeof edge.c);
            VN_TRY(vn_array_push(parts, edge));
        }
    }
    return vn_triangle_tree_build(&s->border, parts->data, parts->count);
}

static vn_status fill_surface(surface *s, const vn_faces *faces) {
    triangle_array parts = {0};
    VN_TRY(vn_faces_triangulate(faces, &s->corners));
    VN_TRY(vn_array_reserve(&s->xyz, 3 * (int64_t)faces->vertices));
    s->xyz.count = 3 * faces->vertices;
    memcpy(s->xyz.data, faces->xyz, (size_t)s->xyz.count * sizeof *s->xyz.data);
    VN_TRY(measure_triangles(s));
    VN_TRY(link_triangles(s));
    vn_status status = build_trees(s, &parts);
    vn_array_free(&parts);
    return status;
}

vn_status vn_domain_faces(vn_domain **out, const vn_faces *faces) {
    *out = NULL;
    surface *s = vn_domain_new(&surface_kind, sizeof *s, 3);
    if (s == NULL) {
        return vn_fail_memory("a surface", sizeof *s);
    }
    vn_status status = fill_surface(s, faces);
    if (status != VN_OK) {
        vn_domain_release(&s->base);
        return status;
    }
    *out = &s->base;
    return VN_OK;
}

vn_status vn_domain_surface(vn_domain **out, const double *xyz, int32_t vertices, const int32_t *triangles,
                            int32_t count) {
    vn_faces faces = {
        .what = "surface", .xyz = xyz, .vertices = vertices, .corners = triangles, .count = count};
    return vn_domain_faces(out, &faces);
}
