// A tree of our own rather than CGAL's: it stays within the memory budget, gives ties to the lower number,
// and takes edges beside triangles.

#include "space/triangle_tree.h"

enum { FAN = VN_TRIANGLE_FAN };

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
    vn_array_free(&tree->radii);
    vn_array_free(&tree->packs);
    tree->levels = 0;
}

typedef struct box {
    double low[3], high[3];
} box;

static const box empty_box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static void include(box *b, const double low[3], const double high[3]) {
    for (int k = 0; k < 3; k++) {
        b->low[k] = fmin(b->low[k], low[k]);
        b->high[k] = fmax(b->high[k], high[k]);
    }
}

static void include_corner(box *b, const double p[3], double radius) {
    double low[3] = {p[0] - radius, p[1] - radius, p[2] - radius};
    double high[3] = {p[0] + radius, p[1] + radius, p[2] + radius};
    include(b, low, high);
}

static void include_triangle(box *b, const vn_triangle *t, double radius) {
    include_corner(b, t->a, radius);
    include_corner(b, t->b, radius);
    include_corner(b, t->c, radius);
}

// Of the triangle at place @p i.
static double radius_of(const vn_triangle_tree *tree, int32_t i) {
    return tree->radii.count > 0 ? tree->radii.data[i] : 0;
}

// ---- Building ----

// More than single precision rounds off, of what is in the bounds and of points near them.
static const float MARGIN = 1e-6F;

static void set_triangle_box(const vn_triangle_tree *tree, vn_triangle_pack *pack, int i, int32_t triangle) {
    box b = empty_box;
    include_triangle(&b, &tree->triangles.data[triangle], radius_of(tree, triangle));
    for (int k = 0; k < 3; k++) {
        pack->low[k][i] = (float)((b.low[k] - tree->low[k]) / tree->size) - MARGIN;
        pack->high[k][i] = (float)((b.high[k] - tree->low[k]) / tree->size) + MARGIN;
    }
}

static void set_pack_box(vn_triangle_pack *pack, int i, const vn_triangle_pack *part) {
    for (int k = 0; k < 3; k++) {
        for (int j = 0; j < FAN; j++) {
            pack->low[k][i] = fminf(pack->low[k][i], part->low[k][j]);
            pack->high[k][i] = fmaxf(pack->high[k][i], part->high[k][j]);
        }
    }
}

static vn_triangle_pack empty_pack(void) {
    vn_triangle_pack pack;
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < FAN; i++) {
            pack.low[k][i] = INFINITY;
            pack.high[k][i] = -INFINITY;
        }
    }
    return pack;
}

// Level 0 boxes triangles, every higher one the packs of the one below.
static vn_status build_level(vn_triangle_tree *tree, int32_t parts) {
    int level = tree->levels;
    for (int32_t first = 0; first < parts; first += FAN) {
        vn_triangle_pack pack = empty_pack();
        for (int i = 0; i < FAN && i < parts - first; i++) {
            if (level == 0) {
                set_triangle_box(tree, &pack, i, first + i);
            } else {
                set_pack_box(&pack, i, &tree->packs.data[tree->starts[level - 1] + first + i]);
            }
        }
        VN_TRY(vn_array_push(&tree->packs, pack));
        if (parts - first <= FAN) {
            break; // nor may the sum overflow
        }
    }
    tree->starts[level + 1] = tree->packs.count;
    tree->levels = level + 1;
    return VN_OK;
}

static vn_status build_packs(vn_triangle_tree *tree) {
    int32_t parts = tree->triangles.count;
    VN_TRY(vn_array_reserve(&tree->packs, parts / 7 + VN_TRIANGLE_LEVELS)); // 1/8 + 1/64 + … = 1/7
    do { // FAN to the power of the levels is more than there can be triangles
        VN_TRY(build_level(tree, parts));
        parts = tree->starts[tree->levels] - tree->starts[tree->levels - 1];
    } while (parts > 1);
    return VN_OK;
}

static void find_size(vn_triangle_tree *tree, const vn_triangle *triangles, const double *radii,
                      int32_t count) {
    box all = empty_box;
    for (int32_t i = 0; i < count; i++) {
        include_triangle(&all, &triangles[i], radii != NULL ? radii[i] : 0);
    }
    tree->size = 0;
    for (int k = 0; k < 3; k++) {
        tree->low[k] = all.low[k];
        tree->size = fmax(tree->size, all.high[k] - all.low[k]);
    }
    tree->size = tree->size > 0 ? tree->size : 1;
}

static double middle_of(const vn_triangle *t, int k) {
    return t->a[k] / 3 + t->b[k] / 3 + t->c[k] / 3;
}

/// Triangles that are to be put in an order.
typedef struct sorting {
    const vn_triangle *triangles;
    vn_keyed_array scratch;
} sorting;

// The axis along which the middles are spread widest, and where they begin there.
static int widest_axis(const sorting *s, const vn_keyed_array *items, double *low) {
    int axis = 0;
    double widest = -1;
    for (int k = 0; k < 3; k++) {
        double least = INFINITY, most = -INFINITY;
        for (int32_t i = 0; i < items->count; i++) {
            double at = middle_of(&s->triangles[items->data[i].value], k);
            least = at < least ? at : least;
            most = at > most ? at : most;
        }
        if (most - least > widest) {
            widest = most - least;
            axis = k;
            *low = least;
        }
    }
    return axis;
}

static vn_status sort_along_axis(sorting *s, vn_keyed_array *items) {
    double low = 0;
    int axis = widest_axis(s, items, &low);
    for (int32_t i = 0; i < items->count; i++) {
        double at = middle_of(&s->triangles[items->data[i].value], axis) - low;
        memcpy(&items->data[i].key, &at, sizeof at); // the bits of numbers from 0 up sort as they do
    }
    return vn_sort_keyed(items, &s->scratch);
}

// Into halves, of whole packs of the highest level that they have, down to packs of triangles. (Along a
// Z-shaped curve, packs had to be looked into twice as often.)
static vn_status halve(sorting *s, vn_keyed_array *items) {
    int64_t pack = FAN;
    if (items->count <= FAN) {
        return VN_OK;
    }
    while (pack * FAN < items->count) {
        pack *= FAN;
    }
    VN_TRY(sort_along_axis(s, items));
    int32_t left = (int32_t)((items->count + pack - 1) / pack / 2 * pack);
    vn_keyed_array halves[2] = {{items->data, left, left},
                                {items->data + left, items->count - left, items->count - left}};
    VN_TRY(halve(s, &halves[0]));
    return halve(s, &halves[1]);
}

static vn_status put_in_order(vn_keyed_array *items, const vn_triangle *triangles, int32_t count) {
    sorting s = {.triangles = triangles};
    VN_TRY(vn_array_zero(items, count));
    for (int32_t i = 0; i < count; i++) {
        items->data[i].value = i;
    }
    vn_status status = halve(&s, items);
    vn_array_free(&s.scratch);
    return status;
}

static vn_status copy_in_order(vn_triangle_tree *tree, const vn_keyed_array *items,
                               const vn_triangle *triangles, const double *radii) {
    VN_TRY(vn_array_reserve(&tree->triangles, items->count));
    VN_TRY(vn_array_reserve(&tree->numbers, items->count));
    VN_TRY(vn_array_reserve(&tree->radii, radii != NULL ? items->count : 0));
    for (int32_t i = 0; i < items->count; i++) {
        int32_t number = items->data[i].value;
        tree->numbers.data[tree->numbers.count++] = number;
        tree->triangles.data[tree->triangles.count++] = triangles[number];
        if (radii != NULL) {
            tree->radii.data[tree->radii.count++] = radii[number];
        }
    }
    return VN_OK;
}

vn_status vn_triangle_tree_build_thick(vn_triangle_tree *tree, const vn_triangle *triangles,
                                       const double *radii, int32_t count) {
    vn_keyed_array items = {0};
    vn_triangle_tree_free(tree);
    find_size(tree, triangles, radii, count);
    vn_status status = put_in_order(&items, triangles, count);
    status = status == VN_OK ? copy_in_order(tree, &items, triangles, radii) : status;
    vn_array_free(&items);
    status = status == VN_OK && count > 0 ? build_packs(tree) : status;
    if (status != VN_OK) {
        vn_triangle_tree_free(tree);
    }
    return status;
}

vn_status vn_triangle_tree_build(vn_triangle_tree *tree, const vn_triangle *triangles, int32_t count) {
    return vn_triangle_tree_build_thick(tree, triangles, NULL, count);
}

// ---- Searching ----

/// A point in the units of the packs, and how far a box may be from it.
typedef struct ball {
    float p[3];
    float reach2;
    bool far; ///< beyond what single precision can square: no box is passed over
} ball;

static ball ball_at(const vn_triangle_tree *tree, const double p[3]) {
    ball b = {.reach2 = 0};
    for (int k = 0; k < 3; k++) {
        double at = (p[k] - tree->low[k]) / tree->size;
        b.far = b.far || !(fabs(at) < 1e9);
        b.p[k] = b.far ? 0 : (float)at;
    }
    return b;
}

// The factor is more than the rounding of squares and sums, and of points far off.
static void set_reach(ball *b, const vn_triangle_tree *tree, double reach2) {
    double part = sqrt(reach2) / tree->size * 1.00001;
    b->reach2 = b->far || !(part < 1e18) ? INFINITY : (float)(part * part);
}

// The loops have no branches, so that a compiler makes vectors of them.
static void distances2_to(const vn_triangle_pack *pack, const ball *b, float d2[FAN]) {
    memset(d2, 0, FAN * sizeof *d2);
    for (int k = 0; k < 3; k++) {
#pragma omp simd
        for (int i = 0; i < FAN; i++) {
            float below = pack->low[k][i] - b->p[k];
            float above = b->p[k] - pack->high[k][i];
            float d = below > above ? below : above;
            d = d > 0 ? d : 0;
            d2[i] += d * d;
        }
    }
}

/// The parts of pack @p index of a level: how many there are, from which on.
typedef struct parts {
    int32_t first;
    int count;
} parts;

static parts parts_of(const vn_triangle_tree *tree, int level, int32_t index) {
    int32_t all = level == 0 ? tree->triangles.count : tree->starts[level] - tree->starts[level - 1];
    int32_t first = index * FAN;
    return (parts){first, all - first < FAN ? all - first : FAN};
}

static const vn_triangle_pack *pack_of(const vn_triangle_tree *tree, int level, int32_t index) {
    return &tree->packs.data[tree->starts[level] + index];
}

typedef struct near_query {
    const vn_triangle_tree *tree;
    const double *p;
    ball ball;
    double best2;
    int32_t found;
    double q[3];
} near_query;

// Of a point from the triangle at place @p i, or from its thick surface.
static double distance2_to(const vn_triangle_tree *tree, int32_t i, const double p[3], double q[3]) {
    double d2 = vn_triangle_closest(&tree->triangles.data[i], p, q);
    if (tree->radii.count == 0) {
        return d2;
    }
    double d = fmax(sqrt(d2) - tree->radii.data[i], 0);
    return d * d;
}

static void compare_triangle(near_query *query, int32_t i) {
    double q[3];
    double d2 = distance2_to(query->tree, i, query->p, q);
    int32_t number = query->tree->numbers.data[i];
    if (d2 < query->best2 || (d2 == query->best2 && (query->found < 0 || number < query->found))) {
        query->best2 = d2;
        query->found = number;
        memcpy(query->q, q, sizeof q);
        set_reach(&query->ball, query->tree, d2);
    }
}

static int least_of(const float d2[FAN], int count) {
    int best = 0;
    for (int i = 1; i < count; i++) {
        best = d2[i] < d2[best] ? i : best;
    }
    return best;
}

static void descend(near_query *query, int level, int32_t index);

static void enter(near_query *query, int level, int32_t part) {
    if (level == 0) {
        compare_triangle(query, part);
    } else {
        descend(query, level - 1, part);
    }
}

// The nearest part first: it mostly rules out the others.
static void descend(near_query *query, int level, int32_t index) {
    float d2[FAN];
    parts p = parts_of(query->tree, level, index);
    distances2_to(pack_of(query->tree, level, index), &query->ball, d2);
    int nearest = least_of(d2, p.count);
    if (d2[nearest] > query->ball.reach2) {
        return;
    }
    enter(query, level, p.first + nearest);
    for (int i = 0; i < p.count; i++) {
        if (i != nearest && d2[i] <= query->ball.reach2) {
            enter(query, level, p.first + i);
        }
    }
}

int32_t vn_triangle_tree_nearest(const vn_triangle_tree *tree, const double p[3], double reach2, double *d2,
                                 double q[3]) {
    near_query query = {.tree = tree, .p = p, .best2 = reach2, .found = -1};
    if (tree->levels > 0) {
        query.ball = ball_at(tree, p);
        set_reach(&query.ball, tree, reach2);
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
    ball ball;
    double reach2;
    vn_triangle_visit *visit;
    void *payload;
} around_query;

static bool visit_near(const around_query *query, int32_t i) {
    double q[3];
    const vn_triangle_tree *tree = query->tree;
    return distance2_to(tree, i, query->p, q) > query->reach2 ||
           query->visit(tree->numbers.data[i], query->payload);
}

static bool visit_around(const around_query *query, int level, int32_t index) {
    float d2[FAN];
    parts p = parts_of(query->tree, level, index);
    distances2_to(pack_of(query->tree, level, index), &query->ball, d2);
    for (int i = 0; i < p.count; i++) {
        if (d2[i] <= query->ball.reach2 &&
            !(level == 0 ? visit_near(query, p.first + i) : visit_around(query, level - 1, p.first + i))) {
            return false;
        }
    }
    return true;
}

bool vn_triangle_tree_around(const vn_triangle_tree *tree, const double p[3], double reach2,
                             vn_triangle_visit *visit, void *payload) {
    around_query query = {.tree = tree, .p = p, .reach2 = reach2, .visit = visit, .payload = payload};
    if (tree->levels == 0) {
        return true;
    }
    query.ball = ball_at(tree, p);
    set_reach(&query.ball, tree, reach2);
    return visit_around(&query, tree->levels - 1, 0);
}

/// A line by its middle and half of its way, in the units of the packs.
typedef struct along_query {
    const vn_triangle_tree *tree;
    double middle[3], half[3];
    double slack; ///< more than rounding is
    vn_triangle_along *visit;
    void *payload;
} along_query;

// No plane along an axis, nor one along the line and an axis, parts them.
static bool comes_into(const along_query *query, const vn_triangle_pack *pack, int part) {
    double size[3], off[3];
    for (int k = 0; k < 3; k++) {
        double low = (double)pack->low[k][part], high = (double)pack->high[k][part];
        size[k] = 0.5 * (high - low) + query->slack;
        off[k] = 0.5 * (low + high) - query->middle[k];
        if (fabs(off[k]) > size[k] + fabs(query->half[k])) {
            return false;
        }
    }
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        double reach = size[i] * fabs(query->half[j]) + size[j] * fabs(query->half[i]);
        if (fabs(query->half[i] * off[j] - query->half[j] * off[i]) > reach) {
            return false;
        }
    }
    return true;
}

static bool visit_along(const along_query *query, int level, int32_t index) {
    const vn_triangle_tree *tree = query->tree;
    const vn_triangle_pack *pack = pack_of(tree, level, index);
    parts p = parts_of(tree, level, index);
    for (int i = 0; i < p.count; i++) {
        int32_t part = p.first + i;
        if (comes_into(query, pack, i) &&
            !(level == 0 ? query->visit(&tree->triangles.data[part], tree->numbers.data[part], query->payload)
                         : visit_along(query, level - 1, part))) {
            return false;
        }
    }
    return true;
}

bool vn_triangle_tree_along(const vn_triangle_tree *tree, const double a[3], const double b[3],
                            vn_triangle_along *visit, void *payload) {
    along_query query = {.tree = tree, .visit = visit, .payload = payload};
    for (int k = 0; k < 3; k++) {
        query.middle[k] = (0.5 * a[k] + 0.5 * b[k] - tree->low[k]) / tree->size;
        query.half[k] = (0.5 * b[k] - 0.5 * a[k]) / tree->size;
        query.slack += 1e-12 * (fabs(query.middle[k]) + fabs(query.half[k]));
    }
    return tree->levels == 0 || visit_along(&query, tree->levels - 1, 0);
}
