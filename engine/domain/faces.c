#include "domain/faces.h"

#include "space/points.h"

enum { MOST_CORNERS = 1000 };

// Beyond these the fourth powers of lengths, which nearest points are computed with, leave the doubles.
static const double LARGEST = 1e60, SMALLEST = 1e-60;

static const double *vertex(const vn_faces *f, int32_t i) {
    return f->xyz + 3 * (int64_t)i;
}

static void add_cross(double n[3], const double p[3], const double q[3], const double r[3]) {
    double a[3], b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = q[k] - p[k];
        b[k] = r[k] - p[k];
    }
    n[0] += a[1] * b[2] - a[2] * b[1];
    n[1] += a[2] * b[0] - a[0] * b[2];
    n[2] += a[0] * b[1] - a[1] * b[0];
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static vn_status check_vertices(const vn_faces *f) {
    double low = INFINITY, high = -INFINITY, size = 0;
    for (int k = 0; k < 3; k++, low = INFINITY, high = -INFINITY) {
        for (int32_t i = 0; i < f->vertices; i++) {
            double value = vertex(f, i)[k];
            if (!(fabs(value) <= LARGEST)) {
                return vn_fail(VN_INVALID, "%s: vertex %lld: %c = %g must be a number from -1e60 to 1e60",
                               f->what, (long long)i + f->first, "xyz"[k], value);
            }
            low = fmin(low, value);
            high = fmax(high, value);
        }
        size = fmax(size, high - low);
    }
    if (!(size >= SMALLEST)) {
        return vn_fail(VN_INVALID, "%s: the vertices are all at one place, within %g: scale the mesh up",
                       f->what, SMALLEST);
    }
    return VN_OK;
}

static vn_status check_corners(const vn_faces *f, int32_t face, const int32_t *corners, int32_t size) {
    long long number = (long long)face + f->first;
    if (size < 3) {
        return vn_fail(VN_INVALID, "%s: face %lld has %d corners; a face needs 3 or more", f->what, number,
                       size);
    }
    if (size > MOST_CORNERS) {
        return vn_fail(VN_INVALID, "%s: face %lld has %d corners, more than %d: cut it into triangles",
                       f->what, number, size, MOST_CORNERS);
    }
    for (int32_t k = 0; k < size; k++) {
        if (corners[k] < 0 || corners[k] >= f->vertices) {
            return vn_fail(VN_INVALID,
                           "%s: face %lld has a corner at vertex %lld, but the vertices are %d to %lld",
                           f->what, number, (long long)corners[k] + f->first, f->first,
                           (long long)f->vertices - 1 + f->first);
        }
    }
    return VN_OK;
}

// Twice its area against its longest side: below the rounding of its corners it has no plane.
static bool has_area(const vn_faces *f, const int32_t corners[3]) {
    const double *p[3] = {vertex(f, corners[0]), vertex(f, corners[1]), vertex(f, corners[2])};
    double n[3] = {0}, longest2 = 0;
    add_cross(n, p[0], p[1], p[2]);
    for (int k = 0; k < 3; k++) {
        longest2 = fmax(longest2, vn_distance2(p[k], p[(k + 1) % 3]));
    }
    return sqrt(dot(n, n)) > 1e-14 * longest2;
}

static vn_status add_triangle(const vn_faces *f, int32_t face, const int32_t corners[3], vn_corners *out) {
    if (!has_area(f, corners)) {
        return vn_fail(
            VN_INVALID,
            "%s: face %lld has no area: its corners are on one line; remove it, or give repair = true",
            f->what, (long long)face + f->first);
    }
    for (int k = 0; k < 3; k++) {
        VN_TRY(vn_array_push(out, corners[k]));
    }
    return VN_OK;
}

/// What is left of a face while ears are cut off.
typedef struct rest {
    const vn_faces *faces;
    int32_t corner[MOST_CORNERS];
    int32_t count;
    double normal[3];
} rest;

static const double *rest_at(const rest *r, int32_t i) {
    return vertex(r->faces, r->corner[(i + r->count) % r->count]);
}

static double turn(const rest *r, const double *p, const double *q, const double *s) {
    double n[3] = {0};
    add_cross(n, p, q, s);
    return dot(n, r->normal);
}

// Seen along the normal, nothing else of the face is in the triangle at corner i.
static bool is_ear(const rest *r, int32_t i) {
    const double *p = rest_at(r, i - 1), *q = rest_at(r, i), *s = rest_at(r, i + 1);
    if (!(turn(r, p, q, s) > 0)) {
        return false;
    }
    for (int32_t k = i + 2; k < i + r->count - 1; k++) {
        const double *t = rest_at(r, k % r->count);
        if (turn(r, p, q, t) >= 0 && turn(r, q, s, t) >= 0 && turn(r, s, p, t) >= 0) {
            return false;
        }
    }
    return true;
}

// The ear with the shortest cut, or -1.
static int32_t best_ear(const rest *r) {
    int32_t best = -1;
    double least = INFINITY;
    for (int32_t i = 0; i < r->count; i++) {
        double cut = vn_distance2(rest_at(r, i - 1), rest_at(r, i + 1));
        if (cut < least && is_ear(r, i)) {
            least = cut;
            best = i;
        }
    }
    return best;
}

static vn_status cut_face(const vn_faces *f, int32_t face, const int32_t *corners, int32_t size,
                          vn_corners *out) {
    rest r = {.faces = f, .count = size};
    memcpy(r.corner, corners, (size_t)size * sizeof *corners);
    for (int32_t k = 1; k + 1 < size; k++) { // Newell's normal
        add_cross(r.normal, rest_at(&r, 0), rest_at(&r, k), rest_at(&r, k + 1));
    }
    while (r.count > 3) {
        int32_t ear = best_ear(&r);
        if (ear < 0) {
            return vn_fail(VN_INVALID, "%s: face %lld crosses itself or has no area: cut it into triangles",
                           f->what, (long long)face + f->first);
        }
        int32_t t[3] = {r.corner[(ear + r.count - 1) % r.count], r.corner[ear],
                        r.corner[(ear + 1) % r.count]};
        VN_TRY(add_triangle(f, face, t, out));
        r.count--;
        memmove(r.corner + ear, r.corner + ear + 1, (size_t)(r.count - ear) * sizeof *r.corner);
    }
    return add_triangle(f, face, r.corner, out);
}

static vn_status check_not_empty(const vn_faces *f) {
    if (f->vertices <= 0 || f->count <= 0) {
        return vn_fail(VN_INVALID, "%s: the mesh is empty: it has %d vertices and %d faces", f->what,
                       f->vertices, f->count);
    }
    return VN_OK;
}

vn_status vn_faces_check(const vn_faces *f) {
    VN_TRY(check_not_empty(f));
    VN_TRY(check_vertices(f));
    const int32_t *corners = f->corners;
    for (int32_t face = 0; face < f->count; face++) {
        int32_t size = f->sizes != NULL ? f->sizes[face] : 3;
        VN_TRY(check_corners(f, face, corners, size));
        corners += size;
    }
    return VN_OK;
}

vn_status vn_faces_triangulate(const vn_faces *f, vn_corners *triangles) {
    VN_TRY(check_not_empty(f));
    VN_TRY(check_vertices(f));
    VN_TRY(vn_array_reserve(triangles, 3 * (int64_t)f->count));
    const int32_t *corners = f->corners;
    for (int32_t face = 0; face < f->count; face++) {
        int32_t size = f->sizes != NULL ? f->sizes[face] : 3;
        VN_TRY(check_corners(f, face, corners, size));
        VN_TRY(size == 3 ? add_triangle(f, face, corners, triangles)
                         : cut_face(f, face, corners, size, triangles));
        corners += size;
    }
    return VN_OK;
}
