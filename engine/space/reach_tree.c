#include "space/reach_tree.h"

enum { LEAF = 8, FAN = 4 };

void vn_reach_tree_free(vn_reach_tree *tree) {
    vn_array_free(&tree->items);
    vn_array_free(&tree->blocks);
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

static vn_reach_block empty_block(void) {
    vn_reach_block block = {.reach2 = -1};
    for (int k = 0; k < 3; k++) {
        block.low[k] = INFINITY;
        block.high[k] = -INFINITY;
    }
    return block;
}

static void include_block(vn_reach_block *block, const vn_reach_block *part) {
    for (int k = 0; k < 3; k++) {
        block->low[k] = fminf(block->low[k], part->low[k]);
        block->high[k] = fmaxf(block->high[k], part->high[k]);
    }
    block->reach2 = fmaxf(block->reach2, part->reach2);
}

static vn_reach_block point_block(const vn_points *points, int32_t i, double reach2) {
    double p[3];
    vn_points_get(points, i, p);
    vn_reach_block block = {.reach2 = float_above(reach2)};
    for (int k = 0; k < 3; k++) {
        block.low[k] = float_below(p[k]);
        block.high[k] = float_above(p[k]);
    }
    return block;
}

static vn_status sort_items(vn_reach_tree *tree, const vn_points *points, const double *reach2, int32_t count) {
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    vn_keyed_array keys = {0}, scratch = {0};
    vn_status status = vn_array_reserve(&keys, count);
    for (int32_t i = 0; status == VN_OK && i < count; i++) {
        if (reach2[i] >= 0) {
            double p[3];
            vn_points_get(points, i, p);
            for (int k = 0; k < 3; k++) {
                low[k] = fmin(low[k], p[k]);
                high[k] = fmax(high[k], p[k]);
            }
            keys.data[keys.count++].value = i;
        }
    }
    double size = fmax(fmax(high[0] - low[0], high[1] - low[1]), high[2] - low[2]);
    for (int32_t i = 0; i < keys.count; i++) {
        double p[3];
        vn_points_get(points, keys.data[i].value, p);
        keys.data[i].key = vn_morton(p, tree->dim, low, size);
    }
    status = status == VN_OK ? vn_sort_keyed(&keys, &scratch) : status;
    status = status == VN_OK ? vn_array_reserve(&tree->items, keys.count) : status;
    tree->items.count = status == VN_OK ? keys.count : 0;
    for (int32_t i = 0; i < tree->items.count; i++) {
        tree->items.data[i] = keys.data[i].value;
    }
    vn_array_free(&keys);
    vn_array_free(&scratch);
    return status;
}

static vn_status build_leaves(vn_reach_tree *tree, const vn_points *points, const double *reach2) {
    int32_t count = tree->items.count;
    VN_TRY(vn_array_reserve(&tree->blocks, count / 5 + 16)); // 1/8 + 1/32 + … = 1/6
    for (int32_t begin = 0; begin < count; begin += LEAF) {
        vn_reach_block block = empty_block();
        for (int32_t i = begin; i < count && i < begin + LEAF; i++) {
            int32_t item = tree->items.data[i];
            vn_reach_block one = point_block(points, item, reach2[item]);
            include_block(&block, &one);
        }
        VN_TRY(vn_array_push(&tree->blocks, block));
    }
    tree->starts[1] = tree->blocks.count;
    tree->levels = 1;
    return VN_OK;
}

static vn_status build_level(vn_reach_tree *tree, int level) {
    for (int32_t begin = tree->starts[level - 1]; begin < tree->starts[level]; begin += FAN) {
        vn_reach_block block = empty_block();
        for (int32_t i = begin; i < tree->starts[level] && i < begin + FAN; i++) {
            include_block(&block, &tree->blocks.data[i]);
        }
        VN_TRY(vn_array_push(&tree->blocks, block));
    }
    tree->starts[level + 1] = tree->blocks.count;
    tree->levels = level + 1;
    return VN_OK;
}

vn_status vn_reach_tree_build(vn_reach_tree *tree, int dim, const vn_points *points, const double *reach2,
                              int32_t count) {
    tree->dim = dim;
    tree->blocks.count = 0;
    tree->levels = 0;
    tree->starts[0] = 0;
    VN_TRY(sort_items(tree, points, reach2, count));
    VN_TRY(build_leaves(tree, points, reach2));
    while (tree->levels < VN_REACH_LEVELS &&
           tree->starts[tree->levels] - tree->starts[tree->levels - 1] > FAN) {
        VN_TRY(build_level(tree, tree->levels));
    }
    return VN_OK;
}

static bool may_answer(const vn_reach_block *block, const double p[3], int dim) {
    double d2 = 0;
    for (int k = 0; k < dim; k++) {
        double below = (double)block->low[k] - p[k];
        double above = p[k] - (double)block->high[k];
        double d = below > above ? below : above;
        d2 += d > 0 ? d * d : 0;
    }
    return d2 <= (double)block->reach2;
}

typedef struct reach_query {
    vn_reach_tree *tree;
    const vn_points *points;
    const double *reach2;
    const double *p;
    vn_reach_hits *hits;
} reach_query;

static vn_status query_leaf(const reach_query *q, int32_t leaf, float *reach2) {
    const vn_reach_tree *tree = q->tree;
    int32_t begin = leaf * LEAF;
    int32_t end = begin + LEAF < tree->items.count ? begin + LEAF : tree->items.count;
    double most = -1;
    VN_TRY(vn_array_reserve(q->hits, q->hits->count + LEAF));
    for (int32_t i = begin; i < end; i++) {
        int32_t item = tree->items.data[i];
        double remembered = q->reach2[item];
        double d2 = vn_points_distance2(q->points, item, q->p);
        if (d2 <= remembered) {
            q->hits->data[q->hits->count++] = (vn_reach_hit){item, d2};
        }
        most = remembered > most ? remembered : most;
    }
    *reach2 = float_above(most);
    return VN_OK;
}

// What is remembered only shrinks between builds, so a bound may be stale but never wrong; each visit renews it.
static vn_status query_block(const reach_query *q, int level, int32_t index) {
    vn_reach_tree *tree = q->tree;
    vn_reach_block *block = &tree->blocks.data[tree->starts[level] + index];
    if (!may_answer(block, q->p, tree->dim)) {
        return VN_OK;
    }
    if (level == 0) {
        return query_leaf(q, index, &block->reach2);
    }
    int32_t below = tree->starts[level] - tree->starts[level - 1];
    int32_t end = (index + 1) * FAN < below ? (index + 1) * FAN : below;
    float most = -1;
    for (int32_t i = index * FAN; i < end; i++) {
        VN_TRY(query_block(q, level - 1, i));
        most = fmaxf(most, tree->blocks.data[tree->starts[level - 1] + i].reach2);
    }
    block->reach2 = most;
    return VN_OK;
}

vn_status vn_reach_tree_query(vn_reach_tree *tree, const vn_points *points, const double *reach2,
                              const double p[3], vn_reach_hits *hits) {
    if (tree->levels == 0) {
        return VN_OK;
    }
    reach_query q = {tree, points, reach2, p, hits};
    int top = tree->levels - 1;
    for (int32_t i = 0; i < tree->starts[top + 1] - tree->starts[top]; i++) {
        VN_TRY(query_block(&q, top, i));
    }
    return VN_OK;
}

static bool holds(const vn_reach_block *block, const double p[3], int dim) {
    for (int k = 0; k < dim; k++) {
        if (p[k] < (double)block->low[k] || p[k] > (double)block->high[k]) {
            return false;
        }
    }
    return true;
}

// Every block that the point may be in: which one it is in is not kept, and a bound too high is only slower.
static void raise_block(vn_reach_tree *tree, int level, int32_t index, const double p[3], float reach2) {
    vn_reach_block *block = &tree->blocks.data[tree->starts[level] + index];
    if (!holds(block, p, tree->dim)) {
        return;
    }
    block->reach2 = fmaxf(block->reach2, reach2);
    int32_t below = level > 0 ? tree->starts[level] - tree->starts[level - 1] : 0;
    for (int32_t i = index * FAN; i < below && i < (index + 1) * FAN; i++) {
        raise_block(tree, level - 1, i, p, reach2);
    }
}

void vn_reach_tree_raise(vn_reach_tree *tree, const double p[3], double reach2) {
    int top = tree->levels - 1;
    for (int32_t i = 0; top >= 0 && i < tree->starts[top + 1] - tree->starts[top]; i++) {
        raise_block(tree, top, i, p, float_above(reach2));
    }
}
