#include "space/reach_tree.h"

enum { FAN = VN_REACH_FAN };

void vn_reach_tree_free(vn_reach_tree *tree) {
    vn_array_free(&tree->items);
    vn_array_free(&tree->packs);
    tree->levels = 0;
}

// Rounded outwards, so that a box in single precision still holds its points.
static float float_below(double value) {
    float f = (float)value;
    return (double)f > value ? nextafterf(f, -INFINITY) : f;
}

static float float_above(double value) {
    float f = (float)value;
    return (double)f < value ? nextafterf(f, INFINITY) : f;
}

// One box and its bound, while packs are made from them.
typedef struct reach_box {
    float low[3], high[3];
    float reach2;
} reach_box;

static reach_box empty_box(void) {
    reach_box box = {.reach2 = -1};
    for (int k = 0; k < 3; k++) {
        box.low[k] = INFINITY;
        box.high[k] = -INFINITY;
    }
    return box;
}

static void include_point(reach_box *box, const vn_points *points, int32_t i, double reach2) {
    double p[3];
    vn_points_get(points, i, p);
    for (int k = 0; k < 3; k++) {
        box->low[k] = fminf(box->low[k], float_below(p[k]));
        box->high[k] = fmaxf(box->high[k], float_above(p[k]));
    }
    box->reach2 = fmaxf(box->reach2, float_above(reach2));
}

static reach_box box_of_pack(const vn_reach_pack *pack) {
    reach_box box = empty_box();
    for (int i = 0; i < FAN; i++) {
        for (int k = 0; k < 3; k++) {
            box.low[k] = fminf(box.low[k], pack->low[k][i]);
            box.high[k] = fmaxf(box.high[k], pack->high[k][i]);
        }
        box.reach2 = fmaxf(box.reach2, pack->reach2[i]);
    }
    return box;
}

static void set_box(vn_reach_pack *pack, int i, const reach_box *box) {
    for (int k = 0; k < 3; k++) {
        pack->low[k][i] = box->low[k];
        pack->high[k][i] = box->high[k];
    }
    pack->reach2[i] = box->reach2;
}

static vn_status sort_items(vn_reach_tree *tree, const vn_points *points, const double *reach2,
                            int32_t count) {
    double low[3], high[3];
    vn_keyed_array keys = {0}, scratch = {0};
    vn_status status = vn_array_reserve(&keys, count);
    for (int32_t i = 0; status == VN_OK && i < count; i++) {
        if (reach2[i] >= 0) {
            keys.data[keys.count++].value = i;
        }
    }
    double size = vn_points_extent(points, 0, count, low, high);
    status = status == VN_OK ? vn_points_sort(points, tree->dim, low, size, &keys, &scratch) : status;
    status = status == VN_OK ? vn_array_reserve(&tree->items, keys.count) : status;
    tree->items.count = status == VN_OK ? keys.count : 0;
    for (int32_t i = 0; i < tree->items.count; i++) {
        tree->items.data[i] = keys.data[i].value;
    }
    vn_array_free(&keys);
    vn_array_free(&scratch);
    return status;
}

static reach_box box_of_run(const vn_reach_tree *tree, int32_t run, const vn_points *points,
                            const double *reach2) {
    reach_box box = empty_box();
    for (int32_t i = run * FAN; i < tree->items.count && i < (run + 1) * FAN; i++) {
        int32_t item = tree->items.data[i];
        include_point(&box, points, item, reach2[item]);
    }
    return box;
}

// Level 0 boxes runs of items, every higher level the packs of the one below.
static vn_status build_level(vn_reach_tree *tree, int32_t parts, const vn_points *points,
                             const double *reach2) {
    int level = tree->levels;
    for (int32_t first = 0; first < parts; first += FAN) {
        vn_reach_pack pack;
        for (int i = 0; i < FAN; i++) {
            reach_box box = empty_box();
            if (first + i < parts) {
                box = level == 0 ? box_of_run(tree, first + i, points, reach2)
                                 : box_of_pack(&tree->packs.data[tree->starts[level - 1] + first + i]);
            }
            set_box(&pack, i, &box);
        }
        VN_TRY(vn_array_push(&tree->packs, pack));
    }
    tree->starts[level + 1] = tree->packs.count;
    tree->levels = level + 1;
    return VN_OK;
}

vn_status vn_reach_tree_build(vn_reach_tree *tree, int dim, const vn_points *points, const double *reach2,
                              int32_t count) {
    tree->dim = dim;
    tree->packs.count = 0;
    tree->levels = 0;
    tree->starts[0] = 0;
    VN_TRY(sort_items(tree, points, reach2, count));
    int32_t parts = (tree->items.count + FAN - 1) / FAN;
    VN_TRY(vn_array_reserve(&tree->packs, parts / 7 + VN_REACH_LEVELS)); // 1/8 + 1/64 + … = 1/7
    do {
        VN_TRY(build_level(tree, parts, points, reach2));
        parts = tree->starts[tree->levels] - tree->starts[tree->levels - 1];
    } while (parts > 1 && tree->levels < VN_REACH_LEVELS);
    return VN_OK;
}

typedef struct reach_query {
    vn_reach_tree *tree;
    const vn_points *points;
    const double *reach2;
    double p[3];
    float low[3], high[3]; ///< p, rounded down and up
    vn_reach_hits *hits;
} reach_query;

// Bit i: part i may hold an answer. In single precision, on the safe side: p lies between low and high, and
// the factor outweighs the rounding of squares and sums. The loops have no branches, so that a compiler makes
// vectors of them.
static unsigned may_answer(const vn_reach_pack *pack, const reach_query *q) {
    float d2[FAN] = {0};
    for (int k = 0; k < q->tree->dim; k++) {
#pragma omp simd
        for (int i = 0; i < FAN; i++) {
            float below = pack->low[k][i] - q->high[k];
            float above = q->low[k] - pack->high[k][i];
            float d = below > above ? below : above;
            d = d > 0 ? d : 0;
            d2[i] += d * d;
        }
    }
    unsigned bits = 0;
#pragma omp simd reduction(| : bits)
    for (int i = 0; i < FAN; i++) {
        bits |= d2[i] * 0.999999F <= pack->reach2[i] ? 1U << i : 0U;
    }
    return bits;
}

// The hits have room for a run more. Returns what the run remembers at most.
static double query_run(const reach_query *q, int32_t run) {
    const vn_reach_tree *tree = q->tree;
    int32_t end = (run + 1) * FAN < tree->items.count ? (run + 1) * FAN : tree->items.count;
    double most = -1;
    for (int32_t i = run * FAN; i < end; i++) {
        int32_t item = tree->items.data[i];
        double remembered = q->reach2[item];
        double d2 = vn_points_distance2(q->points, item, q->p);
        if (d2 <= remembered) {
            q->hits->data[q->hits->count++] = (vn_reach_hit){item, d2};
        }
        most = remembered > most ? remembered : most;
    }
    return most;
}

static float most_of(const vn_reach_pack *pack) {
    float most = -1;
    for (int i = 0; i < FAN; i++) {
        most = pack->reach2[i] > most ? pack->reach2[i] : most;
    }
    return most;
}

// What is remembered only shrinks between builds (but for vn_reach_tree_raise()), so a bound may be stale but
// never wrong; each visit renews it.
static vn_status query_pack(const reach_query *q, int level, int32_t index) {
    vn_reach_tree *tree = q->tree;
    vn_reach_pack *pack = &tree->packs.data[tree->starts[level] + index];
    unsigned bits = may_answer(pack, q);
    for (int i = 0; bits != 0; i++, bits >>= 1) {
        int32_t part = index * FAN + i;
        if (!(bits & 1)) {
            continue;
        }
        if (level == 0) {
            VN_TRY(vn_array_reserve(q->hits, q->hits->count + FAN));
            pack->reach2[i] = float_above(query_run(q, part));
        } else {
            VN_TRY(query_pack(q, level - 1, part));
            pack->reach2[i] = most_of(&tree->packs.data[tree->starts[level - 1] + part]);
        }
    }
    return VN_OK;
}

vn_status vn_reach_tree_query(vn_reach_tree *tree, const vn_points *points, const double *reach2,
                              const double p[3], vn_reach_hits *hits) {
    if (tree->levels == 0 || tree->items.count == 0) {
        return VN_OK;
    }
    reach_query q = {.tree = tree, .points = points, .reach2 = reach2, .hits = hits};
    for (int k = 0; k < 3; k++) {
        q.p[k] = p[k];
        q.low[k] = float_below(p[k]);
        q.high[k] = float_above(p[k]);
    }
    return query_pack(&q, tree->levels - 1, 0);
}

// Every box that the point may be in: which one it is in is not kept, and a bound too high is only slower.
static void raise_pack(vn_reach_tree *tree, int level, int32_t index, const double p[3], float reach2) {
    vn_reach_pack *pack = &tree->packs.data[tree->starts[level] + index];
    for (int i = 0; i < FAN; i++) {
        bool inside = true;
        for (int k = 0; k < tree->dim; k++) {
            inside = inside && p[k] >= (double)pack->low[k][i] && p[k] <= (double)pack->high[k][i];
        }
        if (inside) {
            pack->reach2[i] = fmaxf(pack->reach2[i], reach2);
            if (level > 0) {
                raise_pack(tree, level - 1, index * FAN + i, p, reach2);
            }
        }
    }
}

void vn_reach_tree_raise(vn_reach_tree *tree, const double p[3], double reach2) {
    if (tree->levels > 0 && tree->items.count > 0) {
        raise_pack(tree, tree->levels - 1, 0, p, float_above(reach2));
    }
}
