#include "domain/voxel_tree.h"

#include <math.h>

static vn_status make_level(vn_voxel_tree *tree, const int32_t below[3]) {
    vn_voxel_level *level = &tree->level[tree->levels++];
    level->count = 1;
    for (int a = 0; a < 3; a++) {
        level->size[a] = (below[a] - 1) / 4 + 1;
        level->count *= (size_t)level->size[a];
    }
    level->words = vn_new_block(level->count * sizeof *level->words);
    return level->words != NULL ? VN_OK : vn_fail_memory("a mask", level->count * sizeof *level->words);
}

void vn_voxel_tree_free(vn_voxel_tree *tree) {
    for (int l = 1; l < tree->levels; l++) {
        vn_voxel_level *level = &tree->level[l];
        vn_resize(level->words, level->words != NULL ? level->count * sizeof *level->words : 0, 0);
    }
    *tree = (vn_voxel_tree){0};
}

static size_t number_of(const int32_t size[3], const int32_t node[3]) {
    return (size_t)node[0] + (size_t)size[0] * ((size_t)node[1] + (size_t)size[1] * (size_t)node[2]);
}

// At the far ends of the grid a block has fewer than four voxels in a row.
static uint64_t existing(const vn_voxel_bits *bits, const int32_t block[3]) {
    uint64_t word = 0;
    int32_t n[3];
    for (int a = 0; a < 3; a++) {
        int32_t left = bits->size[a] - 4 * block[a];
        n[a] = left < 4 ? left : 4;
    }
    if (n[0] == 4 && n[1] == 4 && n[2] == 4) {
        return UINT64_MAX;
    }
    for (int c = 0; c < n[2]; c++) {
        for (int b = 0; b < n[1]; b++) {
            word |= (((uint64_t)1 << n[0]) - 1) << (4 * b + 16 * c);
        }
    }
    return word;
}

static uint64_t word_of(const vn_voxel_tree *tree, int level, const int32_t node[3], int what) {
    if (level > 0) {
        return tree->level[level].words[number_of(tree->level[level].size, node)][what];
    }
    uint64_t word = tree->bits->words[number_of(tree->bits->blocks, node)];
    return what == VN_FOREGROUND ? word : ~word & existing(tree->bits, node);
}

static void mark_in_parent(vn_voxel_tree *tree, int level, const int32_t node[3]) {
    vn_voxel_level *above = &tree->level[level + 1];
    int32_t parent[3] = {node[0] >> 2, node[1] >> 2, node[2] >> 2};
    for (int what = 0; what < 2; what++) {
        if (word_of(tree, level, node, what) != 0) {
            above->words[number_of(above->size, parent)][what] |= vn_voxel_bit(node[0], node[1], node[2]);
        }
    }
}

static vn_status build_level(vn_voxel_tree *tree, int level, const int32_t size[3]) {
    int32_t node[3];
    VN_TRY(make_level(tree, size));
    for (node[2] = 0; node[2] < size[2]; node[2]++) {
        VN_TRY(vn_poll());
        for (node[1] = 0; node[1] < size[1]; node[1]++) {
            for (node[0] = 0; node[0] < size[0]; node[0]++) {
                mark_in_parent(tree, level, node);
            }
        }
    }
    return VN_OK;
}

vn_status vn_voxel_tree_build(vn_voxel_tree *tree, const vn_voxel_bits *bits) {
    *tree = (vn_voxel_tree){.bits = bits, .levels = 1};
    memcpy(tree->level[0].size, bits->blocks, sizeof bits->blocks);
    tree->level[0].count = bits->count;
    while (tree->level[tree->levels - 1].count > 1) {
        int below = tree->levels - 1;
        VN_TRY(build_level(tree, below, tree->level[below].size));
    }
    return VN_OK;
}

/// Children that may be nearer than the best, with their square distances.
typedef struct candidates {
    int count;
    double d2[64];
    unsigned char child[64];
} candidates;

static double clamp(double value, double low, double high) {
    return value < low ? low : value > high ? high : value;
}

// The square distances along each axis to the four layers of children, of those that meet the query's box.
// The bits of what is in such layers.
static uint64_t measure_layers(const vn_voxel_query *q, int level, const int32_t node[3],
                               double layers[3][4]) {
    static const uint64_t layer[3] = {0x1111111111111111, 0x000F000F000F000F, 0xFFFF};
    double span = (double)((int64_t)1 << 2 * level);
    uint64_t left = UINT64_MAX;
    for (int a = 0; a < 3; a++) {
        double base = 4.0 * node[a] * span, size = 1 / span;
        int first = (int)clamp((q->low[a] - base) * size - 1e-6, 0, 3); // with what only touches the box
        int last = (int)clamp((q->high[a] - base) * size + 1e-6, 0, 3);
        uint64_t some = 0;
        for (int c = first; c <= last; c++) {
            double below = base + c * span - q->u[a], above = -span - below;
            double gap = below > above ? below : above;
            gap = gap > 0 ? gap * q->scale[a] : 0;
            layers[a][c] = gap * gap;
            some |= layer[a] << (c << 2 * a);
        }
        left &= some;
    }
    return left;
}

static void collect(const vn_voxel_tree *tree, const vn_voxel_query *q, int level, const int32_t node[3],
                    candidates *out) {
    double layers[3][4];
    uint64_t left = measure_layers(q, level, node, layers) & word_of(tree, level, node, q->what);
    out->count = 0;
    for (; left != 0; left &= left - 1) {
        int child = __builtin_ctzll(left);
        double d2 = layers[0][child & 3] + layers[1][child >> 2 & 3] + layers[2][child >> 4];
        if (d2 < q->best) {
            out->d2[out->count] = d2;
            out->child[out->count++] = (unsigned char)child;
        }
    }
}

// The nearest of the candidates, which is taken out; of equal ones any, but always the same.
static int take_nearest(candidates *c, double *d2) {
    int best = 0;
    for (int i = 1; i < c->count; i++) {
        best = c->d2[i] < c->d2[best] ? i : best;
    }
    int child = c->child[best];
    *d2 = c->d2[best];
    c->count--;
    c->d2[best] = c->d2[c->count];
    c->child[best] = c->child[c->count];
    return child;
}

static void descend(const vn_voxel_tree *tree, vn_voxel_query *q, int level, const int32_t node[3]) {
    candidates c;
    double d2;
    collect(tree, q, level, node, &c);
    while (c.count > 0) {
        int child = take_nearest(&c, &d2);
        if (d2 >= q->best) {
            return;
        }
        int32_t below[3] = {4 * node[0] + (child & 3), 4 * node[1] + (child >> 2 & 3),
                            4 * node[2] + (child >> 4)};
        if (level == 0) {
            q->best = d2;
            q->found = true;
            memcpy(q->cell, below, sizeof below);
            return;
        }
        descend(tree, q, level - 1, below);
    }
}

// The lowest node that has all of the query's box.
static int find_start(const vn_voxel_tree *tree, const vn_voxel_query *q, int32_t node[3]) {
    int32_t far[3];
    int level = 0;
    for (int a = 0; a < 3; a++) {
        double last = tree->bits->blocks[a] - 1.0;
        node[a] =
            (int32_t)fmin(fmax(floor(0.25 * q->low[a] - 1e-6), 0), last); // what only touches the box, too
        far[a] = (int32_t)fmin(fmax(floor(0.25 * q->high[a] + 1e-6), 0), last);
    }
    for (; node[0] != far[0] || node[1] != far[1] || node[2] != far[2]; level++) {
        for (int a = 0; a < 3; a++) {
            node[a] >>= 2;
            far[a] >>= 2;
        }
    }
    return level;
}

void vn_voxel_tree_nearest(const vn_voxel_tree *tree, vn_voxel_query *query) {
    int32_t node[3];
    int level = find_start(tree, query, node);
    descend(tree, query, level, node);
}
