// A tree of our own rather than CGAL's: it stays within the memory budget, gives ties to the lower number,
// and takes edges beside triangles.

#include "space/triangle_tree.h"

enum { FAN = 4 };

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void subtract(double d[3], const double a[3], const double b[3]) {
    for (int k = 0; k < 3; k++) {
        d[k] = a[k] - b[k];
    }
}

static double at(const vn_triangle *t, double v, double w, const double p[3], double q[3]) {
    for (int k = 0; k < 3; k++) {
        q[k] = t->a[k] + v * (t->b[k] - t->a[k]) + w * (t->c[k] - t->a[k]);
    }
    return vn_distance2(p, q);
}

// By the region of the triangle's plane that p is over (Ericson, Real-Time Collision Detection, 5.1.5).
double vn_triangle_closest(const vn_triangle *t, const double p[3], double q[3]) {
    double ab[3], ac[3], ap[3], bp[3], cp[3];
    subtract(ab, t->b, t->a);
    subtract(ac, t->c, t->a);
    subtract(ap, p, t->a);
    double d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) {
        return at(t, 0, 0, p, q);
    }
    subtract(bp, p, t->b);
    double d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) {
        return at(t, 1, 0, p, q);
    }
    double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        return at(t, d1 / (d1 - d3), 0, p, q);
    }
    subtract(cp, p, t->c);
    double d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) {
        return at(t, 0, 1, p, q);
    }
    double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        return at(t, 0, d2 / (d2 - d6), p, q);
    }
    double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 >= d3 && d5 >= d6) {
        double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return at(t, 1 - w, w, p, q);
    }
    return at(t, vb / (va + vb + vc), vc / (va + vb + vc), p, q);
}

void vn_triangle_tree_free(vn_triangle_tree *tree) {
    vn_array_free(&tree->triangles);
    vn_array_free(&tree->numbers);
    vn_array_free(&tree->boxes);
    tree->levels = 0;
}

static void include(vn_triangle_box *box, const double low[3], const double high[3]) {
    for (int k = 0; k < 3; k++) {
        box->low[k] = fmin(box->low[k], low[k]);
        box->high[k] = fmax(box->high[k], high[k]);
    }
}

static void include_triangle(vn_triangle_box *box, const vn_triangle *t) {
    include(box, t->a, t->a);
    include(box, t->b, t->b);
    include(box, t->c, t->c);
}

static vn_triangle_box box_of_run(const vn_triangle_tree *tree, int level, int32_t first, int32_t end) {
    vn_triangle_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (int32_t i = first; i < end; i++) {
        if (level == 0) {
            include_triangle(&box, &tree->triangles.data[i]);
        } else {
            const vn_triangle_box *part = &tree->boxes.data[tree->starts[level - 1] + i];
            include(&box, part->low, part->high);
        }
    }
    return box;
}

static vn_status build_boxes(vn_triangle_tree *tree) {
    int32_t parts = tree->triangles.count;
    VN_TRY(vn_array_reserve(&tree->boxes, parts / 2 + VN_TRIANGLE_LEVELS * (int64_t)2));
    tree->boxes.count = 0;
    tree->levels = 0;
    do { // FAN to the power of the levels is more than there can be triangles
        tree->starts[tree->levels] = tree->boxes.count;
        for (int32_t first = 0; first < parts; first += FAN) {
            int32_t end = parts - first < FAN ? parts : first + FAN;
            vn_triangle_box box = box_of_run(tree, tree->levels, first, end);
            VN_TRY(vn_array_push(&tree->boxes, box));
        }
        tree->starts[++tree->levels] = tree->boxes.count;
        parts = tree->boxes.count - tree->starts[tree->levels - 1];
    } while (parts > 1);
    return VN_OK;
}

static double side_of(const vn_triangle_box *box) {
    double size = 0;
    for (int k = 0; k < 3; k++) {
        size = fmax(size, box->high[k] - box->low[k]);
    }
    return size;
}

// By the middles of the triangles.
static vn_status sort_along_curve(vn_keyed_array *keys, const vn_triangle *triangles, int32_t count) {
    vn_keyed_array scratch = {0};
    vn_triangle_box all = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    vn_status status = vn_array_reserve(keys, count);
    for (int32_t i = 0; i < count; i++) {
        include_triangle(&all, &triangles[i]);
    }
    double size = side_of(&all);
    for (int32_t i = 0; status == VN_OK && i < count; i++) {
        const vn_triangle *t = &triangles[i];
        double middle[3];
        for (int k = 0; k < 3; k++) {
            middle[k] = t->a[k] / 3 + t->b[k] / 3 + t->c[k] / 3;
        }
        keys->data[keys->count++] = (vn_keyed){vn_morton(middle, 3, all.low, size), i};
    }
    status = status == VN_OK ? vn_sort_keyed(keys, &scratch) : status;
    vn_array_free(&scratch);
    return status;
}

vn_status vn_triangle_tree_build(vn_triangle_tree *tree, const vn_triangle *triangles, int32_t count) {
    vn_keyed_array keys = {0};
    vn_triangle_tree_free(tree);
    vn_status status = sort_along_curve(&keys, triangles, count);
    status = status == VN_OK ? vn_array_reserve(&tree->triangles, count) : status;
    status = status == VN_OK ? vn_array_reserve(&tree->numbers, count) : status;
    for (int32_t i = 0; status == VN_OK && i < count; i++) {
        tree->numbers.data[tree->numbers.count++] = keys.data[i].value;
        tree->triangles.data[tree->triangles.count++] = triangles[keys.data[i].value];
    }
    vn_array_free(&keys);
    status = status == VN_OK && count > 0 ? build_boxes(tree) : status;
    if (status != VN_OK) {
        vn_triangle_tree_free(tree);
    }
    return status;
}

static double distance2_to(const vn_triangle_box *box, const double p[3]) {
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        double beyond = fmax(fmax(box->low[k] - p[k], p[k] - box->high[k]), 0);
        sum += beyond * beyond;
    }
    return sum;
}

typedef struct near_query {
    const vn_triangle_tree *tree;
    const double *p;
    double best2;
    int32_t found;
    double q[3];
} near_query;

static void compare_triangle(near_query *query, int32_t i) {
    double q[3];
    double d2 = vn_triangle_closest(&query->tree->triangles.data[i], query->p, q);
    int32_t number = query->tree->numbers.data[i];
    if (d2 < query->best2 || (d2 == query->best2 && (query->found < 0 || number < query->found))) {
        query->best2 = d2;
        query->found = number;
        memcpy(query->q, q, sizeof q);
    }
}

/// The parts of one run, the nearest first.
typedef struct near_parts {
    int32_t part[FAN];
    double d2[FAN];
    int count;
} near_parts;

static void sort_parts(near_parts *parts, const near_query *query, int level, int32_t run) {
    const vn_triangle_tree *tree = query->tree;
    int32_t count = tree->starts[level] - tree->starts[level - 1];
    parts->count = 0;
    for (int32_t i = run * FAN; i < count && i < (run + 1) * FAN; i++) {
        double d2 = distance2_to(&tree->boxes.data[tree->starts[level - 1] + i], query->p);
        int place = parts->count++;
        for (; place > 0 && parts->d2[place - 1] > d2; place--) {
            parts->d2[place] = parts->d2[place - 1];
            parts->part[place] = parts->part[place - 1];
        }
        parts->d2[place] = d2;
        parts->part[place] = i;
    }
}

// Level 0 is a run of triangles, any other a run of boxes of the level below.
static void descend(near_query *query, int level, int32_t run) {
    if (level == 0) {
        for (int32_t i = run * FAN; i < query->tree->triangles.count && i < (run + 1) * FAN; i++) {
            compare_triangle(query, i);
        }
        return;
    }
    near_parts parts;
    sort_parts(&parts, query, level, run);
    for (int k = 0; k < parts.count && parts.d2[k] <= query->best2; k++) {
        descend(query, level - 1, parts.part[k]);
    }
}

int32_t vn_triangle_tree_nearest(const vn_triangle_tree *tree, const double p[3], double reach2, double *d2,
                                 double q[3]) {
    near_query query = {.tree = tree, .p = p, .best2 = reach2, .found = -1};
    if (tree->levels > 0) {
        descend(&query, tree->levels - 1, 0);
    }
    *d2 = query.best2;
    if (query.found >= 0) {
        memcpy(q, query.q, sizeof query.q);
    }
    return query.found;
}

typedef struct around_query {
    const vn_triangle_tree *tree;
    const double *p;
    double reach2;
    vn_triangle_visit *visit;
    void *payload;
} around_query;

static bool visit_triangles(const around_query *query, int32_t run) {
    const vn_triangle_tree *tree = query->tree;
    for (int32_t i = run * FAN; i < tree->triangles.count && i < (run + 1) * FAN; i++) {
        double q[3];
        if (vn_triangle_closest(&tree->triangles.data[i], query->p, q) <= query->reach2 &&
            !query->visit(tree->numbers.data[i], query->payload)) {
            return false;
        }
    }
    return true;
}

static bool visit_run(const around_query *query, int level, int32_t run) {
    const vn_triangle_tree *tree = query->tree;
    if (level == 0) {
        return visit_triangles(query, run);
    }
    int32_t count = tree->starts[level] - tree->starts[level - 1];
    for (int32_t i = run * FAN; i < count && i < (run + 1) * FAN; i++) {
        if (distance2_to(&tree->boxes.data[tree->starts[level - 1] + i], query->p) <= query->reach2 &&
            !visit_run(query, level - 1, i)) {
            return false;
        }
    }
    return true;
}

bool vn_triangle_tree_around(const vn_triangle_tree *tree, const double p[3], double reach2,
                             vn_triangle_visit *visit, void *payload) {
    around_query query = {tree, p, reach2, visit, payload};
    return tree->levels == 0 || visit_run(&query, tree->levels - 1, 0);
}
