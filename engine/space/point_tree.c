#include "space/point_tree.h"

enum { LEAF = 12, DEEPEST = 60 };

void vn_point_tree_free(vn_point_tree *tree) {
    vn_array_free(&tree->cells);
    vn_array_free(&tree->benches);
    vn_array_free(&tree->places);
    tree->count = 0;
}

static const vn_tree_cell empty_cell = {-1, -1, 0};

static vn_status add_children(vn_point_tree *tree, int32_t *first) {
    int fan = 1 << tree->dim;
    VN_TRY(vn_array_reserve(&tree->cells, (int64_t)tree->cells.count + fan));
    *first = tree->cells.count;
    for (int c = 0; c < fan; c++) {
        tree->cells.data[tree->cells.count++] = empty_cell;
    }
    return VN_OK;
}

/// A box on the way down.
typedef struct place {
    double low[3], size;
} place;

static int octant(int dim, place *at, const double p[3]) {
    int which = 0;
    at->size *= 0.5;
    for (int k = 0; k < dim; k++) {
        if (p[k] >= at->low[k] + at->size) {
            at->low[k] += at->size;
            which |= 1 << k;
        }
    }
    return which;
}

// A leaf's points, and one more, on a bench each.
static vn_status make_benches(vn_point_tree *tree) {
    int64_t most = (int64_t)tree->benches.count + LEAF + 1;
    VN_TRY(vn_array_reserve(&tree->benches, most));
    return vn_array_reserve(&tree->places, most * VN_BENCH * tree->dim);
}

static int32_t take_bench(vn_point_tree *tree) {
    int32_t bench = tree->idle;
    if (bench >= 0) {
        tree->idle = tree->benches.data[bench].next;
        return bench;
    }
    return tree->benches.count++;
}

static void give_back(vn_point_tree *tree, int32_t bench) {
    tree->benches.data[bench].next = tree->idle;
    tree->idle = bench;
}

static double *places_of(const vn_point_tree *tree, int32_t bench) {
    return tree->places.data + (int64_t)bench * VN_BENCH * tree->dim;
}

// How many sit on the first bench of a leaf; its others are full.
static int first_taken(const vn_tree_cell *leaf) {
    return (leaf->count - 1) % VN_BENCH + 1;
}

static void get_place(const vn_point_tree *tree, int32_t bench, int seat, double p[3]) {
    const double *places = places_of(tree, bench) + seat;
    p[0] = places[0];
    p[1] = places[VN_BENCH];
    p[2] = tree->dim == 3 ? places[2 * VN_BENCH] : 0;
}

// There are benches enough: see make_benches().
static void seat_point(vn_point_tree *tree, int32_t cell, int32_t point, const double p[3]) {
    vn_tree_cell *leaf = &tree->cells.data[cell];
    int seat = leaf->count++ % VN_BENCH;
    if (seat == 0) {
        int32_t bench = take_bench(tree);
        tree->benches.data[bench].next = leaf->head;
        leaf->head = bench;
    }
    tree->benches.data[leaf->head].points[seat] = point;
    for (int k = 0; k < tree->dim; k++) {
        // NOLINTNEXTLINE(clang-analyzer-core.uninitialized.Assign): there are 2 or 3 dimensions
        places_of(tree, leaf->head)[k * VN_BENCH + seat] = p[k];
    }
}

static vn_status split_leaf(vn_point_tree *tree, int32_t cell, const place *at) {
    int32_t first;
    vn_tree_cell leaf = tree->cells.data[cell];
    VN_TRY(make_benches(tree));
    VN_TRY(add_children(tree, &first));
    int taken = first_taken(&leaf);
    for (int32_t bench = leaf.head; bench >= 0; taken = VN_BENCH) {
        vn_tree_bench old = tree->benches.data[bench];
        for (int seat = 0; seat < taken; seat++) {
            double p[3];
            place below = *at;
            get_place(tree, bench, seat, p);
            seat_point(tree, first + octant(tree->dim, &below, p), old.points[seat], p);
        }
        give_back(tree, bench);
        bench = old.next;
    }
    tree->cells.data[cell] = (vn_tree_cell){first, -1, 0};
    return VN_OK;
}

static place root_of(const vn_point_tree *tree) {
    return (place){{tree->low[0], tree->low[1], tree->low[2]}, tree->size};
}

static vn_status insert(vn_point_tree *tree, int32_t point, const double p[3]) {
    place at = root_of(tree);
    int32_t cell = 0;
    VN_TRY(make_benches(tree));
    for (int depth = 0;; depth++) {
        if (tree->cells.data[cell].children < 0) {
            if (tree->cells.data[cell].count < LEAF || depth >= DEEPEST) {
                seat_point(tree, cell, point, p);
                return VN_OK;
            }
            VN_TRY(split_leaf(tree, cell, &at));
        }
        cell = tree->cells.data[cell].children + octant(tree->dim, &at, p);
    }
}

static bool is_inside(const vn_point_tree *tree, const double p[3]) {
    for (int k = 0; k < tree->dim; k++) {
        // NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): there are 2 or 3 dimensions
        if (p[k] < tree->low[k] || p[k] >= tree->low[k] + tree->size) {
            return false;
        }
    }
    return true;
}

// The root becomes one of the children of a root of twice its size, toward the point.
static vn_status grow_root(vn_point_tree *tree, const double p[3]) {
    int32_t first;
    int which = 0;
    VN_TRY(add_children(tree, &first));
    for (int k = 0; k < tree->dim; k++) {
        // NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): there are 2 or 3 dimensions
        if (p[k] < tree->low[k]) {
            tree->low[k] -= tree->size;
            which |= 1 << k;
        }
    }
    tree->size *= 2;
    tree->cells.data[first + which] = tree->cells.data[0];
    tree->cells.data[0] = (vn_tree_cell){first, -1, 0};
    return VN_OK;
}

// A power of two, at a multiple of it: then no box's corner is ever rounded, whatever the points' scale.
static vn_status plant(vn_point_tree *tree, int dim, const vn_points *points, int32_t count) {
    double high[3];
    tree->dim = dim;
    tree->idle = -1;
    double size = vn_points_extent(points, 0, count, tree->low, high);
    int exponent;
    frexp(size > 0 ? size : 1, &exponent);
    tree->size = ldexp(1, exponent);
    for (int k = 0; k < 3; k++) {
        tree->low[k] = floor(tree->low[k] / tree->size) * tree->size;
    }
    return vn_array_push(&tree->cells, empty_cell);
}

vn_status vn_point_tree_update(vn_point_tree *tree, int dim, const vn_points *points, int32_t count) {
    if (tree->cells.count == 0 && count > 0) {
        VN_TRY(plant(tree, dim, points, count));
    }
    for (; tree->count < count; tree->count++) {
        double p[3];
        vn_points_get(points, tree->count, p);
        while (!is_inside(tree, p)) {
            VN_TRY(grow_root(tree, p));
        }
        VN_TRY(insert(tree, tree->count, p));
    }
    return VN_OK;
}

typedef struct lune_query {
    const vn_point_tree *tree;
    const vn_lune *lune;
    double width2; ///< the squared distance of the lune's two points, and a little
    vn_point_test_fn *test;
    void *payload;
} lune_query;

static place child_place(const place *at, int dim, int child) {
    place below = {{at->low[0], at->low[1], at->low[2]}, 0.5 * at->size};
    for (int k = 0; k < dim; k++) {
        below.low[k] += child >> k & 1 ? below.size : 0;
    }
    return below;
}

static double distance2_to(const place *at, int dim, const double p[3]) {
    double sum = 0;
    for (int k = 0; k < dim; k++) {
        double below = at->low[k] - p[k], above = p[k] - (at->low[k] + at->size);
        double d = below > 0 ? below : above > 0 ? above : 0; // not fmax(): half of the time went there
        sum += d * d;
    }
    return sum;
}

static bool any_in_leaf(const lune_query *q, const vn_tree_cell *leaf) {
    int taken = first_taken(leaf);
    for (int32_t bench = leaf->head; bench >= 0; bench = q->tree->benches.data[bench].next) {
        for (int seat = 0; seat < taken; seat++) {
            double p[3];
            get_place(q->tree, bench, seat, p);
            if (vn_distance2(p, q->lune->s) <= q->width2 && vn_distance2(p, q->lune->v) <= q->width2 &&
                q->test(q->tree->benches.data[bench].points[seat], q->lune, q->payload)) {
                return true;
            }
        }
        taken = VN_BENCH;
    }
    return false;
}

static double farthest_along(const place *at, int dim, const double normal[3]) {
    double sum = 0;
    for (int k = 0; k < dim; k++) {
        sum += normal[k] * (normal[k] > 0 ? at->low[k] + at->size : at->low[k]);
    }
    return sum;
}

static bool may_hold(const lune_query *q, const place *at) {
    int dim = q->tree->dim;
    return farthest_along(at, dim, q->lune->normal) >= q->lune->least &&
           distance2_to(at, dim, q->lune->v) <= q->width2 && distance2_to(at, dim, q->lune->s) <= q->width2;
}

// The child nearest to the middle of the lune, where it is widest: what is found there ends the search.
static int child_amid(const lune_query *q, const place *at) {
    int which = 0;
    for (int k = 0; k < q->tree->dim; k++) {
        which |= q->lune->s[k] + q->lune->v[k] >= 2 * at->low[k] + at->size ? 1 << k : 0;
    }
    return which;
}

// Bit c: the lune's box reaches into child c of a cell that it reaches into.
static unsigned children_reached(const lune_query *q, const place *at) {
    static const unsigned lower[3] = {0x55, 0x33, 0x0F}; // the children below the middle of each axis
    unsigned reached = q->tree->dim == 3 ? 0xFF : 0x0F;
    for (int k = 0; k < q->tree->dim; k++) {
        double middle = at->low[k] + 0.5 * at->size;
        reached &= q->lune->low[k] < middle ? ~0U : ~lower[k];
        reached &= q->lune->high[k] >= middle ? ~0U : lower[k];
    }
    return reached;
}

// NOLINTNEXTLINE(misc-no-recursion): no deeper than DEEPEST below the root, and that by doubling alone
static bool any_below(const lune_query *q, int32_t cell, const place *at) {
    const vn_tree_cell *here = &q->tree->cells.data[cell];
    int dim = q->tree->dim;
    if (here->children < 0) {
        return any_in_leaf(q, here);
    }
    int first = child_amid(q, at);
    unsigned reached = children_reached(q, at);
    for (int k = 0; k < 1 << dim; k++) {
        int c = k ^ first;
        const vn_tree_cell *child = &q->tree->cells.data[here->children + c];
        if (!(reached >> c & 1) || (child->children < 0 && child->count == 0)) {
            continue;
        }
        place below = child_place(at, dim, c);
        if (may_hold(q, &below) && any_below(q, here->children + c, &below)) {
            return true;
        }
    }
    return false;
}

// Down to the smallest cell that holds the lune's box.
static int32_t descend_to(const lune_query *q, place *at) {
    const vn_tree_cell *cells = q->tree->cells.data;
    int32_t cell = 0;
    while (cells[cell].children >= 0) {
        double size = 0.5 * at->size;
        int which = 0;
        for (int k = 0; k < q->tree->dim; k++) {
            double middle = at->low[k] + size;
            if (q->lune->low[k] < middle && q->lune->high[k] >= middle) {
                return cell;
            }
            which |= q->lune->low[k] >= middle ? 1 << k : 0;
        }
        *at = child_place(at, q->tree->dim, which);
        cell = cells[cell].children + which;
    }
    return cell;
}

bool vn_point_tree_any_in_lune(const vn_point_tree *tree, const vn_lune *lune, vn_point_test_fn *test,
                               void *payload) {
    lune_query q = {tree, lune, vn_distance2(lune->s, lune->v) * (1 + 1e-9), test, payload};
    place at = root_of(tree);
    return tree->cells.count > 0 && any_below(&q, descend_to(&q, &at), &at);
}

typedef struct near_query {
    const vn_point_tree *tree;
    const double *p;
    double radius2;
} near_query;

static bool any_near_in(const near_query *q, const vn_tree_cell *leaf) {
    int taken = first_taken(leaf);
    for (int32_t bench = leaf->head; bench >= 0; bench = q->tree->benches.data[bench].next) {
        for (int seat = 0; seat < taken; seat++) {
            double p[3];
            get_place(q->tree, bench, seat, p);
            if (vn_distance2(p, q->p) < q->radius2) {
                return true;
            }
        }
        taken = VN_BENCH;
    }
    return false;
}

// NOLINTNEXTLINE(misc-no-recursion): as any_below()
static bool any_near(const near_query *q, int32_t cell, const place *at) {
    const vn_tree_cell *here = &q->tree->cells.data[cell];
    if (here->children < 0) {
        return any_near_in(q, here);
    }
    place nearest = *at;
    int first = octant(q->tree->dim, &nearest, q->p);
    for (int k = 0; k < 1 << q->tree->dim; k++) {
        int c = k ^ first;
        const vn_tree_cell *child = &q->tree->cells.data[here->children + c];
        if (child->children < 0 && child->count == 0) {
            continue;
        }
        place below = child_place(at, q->tree->dim, c);
        if (distance2_to(&below, q->tree->dim, q->p) < q->radius2 &&
            any_near(q, here->children + c, &below)) {
            return true;
        }
    }
    return false;
}

bool vn_point_tree_any_within(const vn_point_tree *tree, const double p[3], double radius) {
    near_query q = {tree, p, radius * radius};
    place root = root_of(tree);
    return tree->cells.count > 0 && any_near(&q, 0, &root);
}

typedef struct around_query {
    const vn_point_tree *tree;
    const double *p;
    double reach2;
    vn_found_array *found;
} around_query;

enum { BLOCKERS = 64 }; // as many of the nearest are asked whether they hide a box; seldom are there more

// What is certain, whatever doubles do to the last bits.
static const double SURE = 1 - 1e-12;

// Whether everything in the box is nearer to the found point than to p, and farther from p than that point
// is: none of it can be a relative neighbor of p.
static inline bool hides_box(const around_query *q, int dim, const vn_found *by, const place *at,
                             double nearest2) {
    double least = 0;
    if (!(by->distance2 < SURE * nearest2)) {
        return false;
    }
    for (int k = 0; k < dim; k++) {
        double low = at->low[k] - q->p[k];
        least += by->to[k] * (by->to[k] > 0 ? low : low + at->size);
    }
    return SURE * least > 0.5 * by->distance2;
}

static bool hides_point(const vn_found *by, const vn_found *other) {
    return by->distance2 < SURE * other->distance2 &&
           vn_distance2(by->to, other->to) < SURE * other->distance2;
}

static inline bool is_box_hidden(const around_query *q, int dim, const place *at, double nearest2) {
    int32_t count = q->found->count < BLOCKERS ? q->found->count : BLOCKERS;
    for (int32_t k = 0; k < count; k++) {
        if (hides_box(q, dim, &q->found->data[k], at, nearest2)) {
            return true;
        }
    }
    return false;
}

static bool comes_before(const vn_found *a, const vn_found *b) {
    return a->distance2 < b->distance2 || (a->distance2 == b->distance2 && a->point < b->point);
}

// What is left is so few that all of it can be asked whether it hides a box: where the nearest dozen of a
// longer list were on one side, looks went on for a hundred thousand points on the other.
static void drop_hidden(vn_found_array *found, const vn_found *by) {
    int32_t kept = 0;
    for (int32_t k = 0; k < found->count; k++) {
        found->data[kept] = found->data[k];
        kept += !hides_point(by, &found->data[k]);
    }
    found->count = kept;
}

static vn_status find_point(const around_query *q, int32_t bench, int seat) {
    vn_found_array *found = q->found;
    vn_found one = {.point = q->tree->benches.data[bench].points[seat]};
    double u[3];
    get_place(q->tree, bench, seat, u);
    for (int k = 0; k < 3; k++) {
        one.to[k] = k < q->tree->dim ? u[k] - q->p[k] : 0;
        one.distance2 += one.to[k] * one.to[k];
    }
    if (one.distance2 > q->reach2) {
        return VN_OK;
    }
    for (int32_t k = 0; k < found->count; k++) {
        if (hides_point(&found->data[k], &one)) {
            return VN_OK;
        }
    }
    drop_hidden(found, &one);
    VN_TRY(vn_array_push(found, one));
    int32_t at = found->count - 1;
    for (; at > 0 && comes_before(&one, &found->data[at - 1]); at--) {
        found->data[at] = found->data[at - 1];
    }
    found->data[at] = one;
    return VN_OK;
}

static vn_status find_in_leaf(const around_query *q, const vn_tree_cell *leaf) {
    int taken = first_taken(leaf);
    for (int32_t bench = leaf->head; bench >= 0; bench = q->tree->benches.data[bench].next) {
        for (int seat = 0; seat < taken; seat++) {
            VN_TRY(find_point(q, bench, seat));
        }
        taken = VN_BENCH;
    }
    return VN_OK;
}

// The nearest child first, so that what it holds hides the others.
// NOLINTNEXTLINE(misc-no-recursion): as any_below()
static vn_status find_below(const around_query *q, int dim, int32_t cell, const place *at) {
    const vn_tree_cell *here = &q->tree->cells.data[cell];
    double nearest2 = distance2_to(at, dim, q->p);
    if (nearest2 > q->reach2 || is_box_hidden(q, dim, at, nearest2)) {
        return VN_OK;
    }
    if (here->children < 0) {
        return find_in_leaf(q, here);
    }
    place nearest = *at;
    int first = octant(dim, &nearest, q->p);
    for (int c = 0; c < 1 << dim; c++) {
        int child = c ^ first; // those that share a side with the first come before the one across
        const vn_tree_cell *next = &q->tree->cells.data[here->children + child];
        if (next->children >= 0 || next->count > 0) {
            place below = child_place(at, dim, child);
            VN_TRY(find_below(q, dim, here->children + child, &below));
        }
    }
    return VN_OK;
}

vn_status vn_point_tree_around(const vn_point_tree *tree, const double p[3], double reach2,
                               vn_found_array *found) {
    around_query q = {tree, p, reach2, found};
    place root = root_of(tree);
    found->count = 0;
    if (tree->cells.count == 0) {
        return VN_OK;
    }
    return tree->dim == 2 ? find_below(&q, 2, 0, &root) : find_below(&q, 3, 0, &root);
}
