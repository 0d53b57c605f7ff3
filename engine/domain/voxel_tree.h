/// Finding the nearest voxel that is set, or that is not: a tree over a mask's bits.
#ifndef VN_DOMAIN_VOXEL_TREE_H
#define VN_DOMAIN_VOXEL_TREE_H

#include "domain/voxel_bits.h"

enum { VN_BACKGROUND, VN_FOREGROUND, VN_VOXEL_LEVELS = 16 };

/// Node (i, j, k) is number i + size[0] (j + size[1] k), and child (a, b, c) of it bit a + 4 b + 16 c of its
/// two words: which children have background in them, and which have foreground.
typedef struct vn_voxel_level {
    int32_t size[3];
    size_t count;
    uint64_t (*words)[2];
} vn_voxel_level;

/// The bits are level 0. A zeroed one is empty and owns nothing.
typedef struct vn_voxel_tree {
    const vn_voxel_bits *bits; ///< borrowed
    int levels;
    vn_voxel_level level[VN_VOXEL_LEVELS]; ///< from 1 on
} vn_voxel_tree;

vn_status vn_voxel_tree_build(vn_voxel_tree *tree, const vn_voxel_bits *bits);
void vn_voxel_tree_free(vn_voxel_tree *tree);

/// What is looked for. Voxel (i, j, k) is the box from there to (i + 1, j + 1, k + 1), and axis a is scaled
/// by scale[a].
typedef struct vn_voxel_query {
    int what; ///< VN_BACKGROUND or VN_FOREGROUND
    const double *u, *scale;
    double low[3], high[3]; ///< only voxels that meet this box
    double best;            ///< only voxels within this square distance of u; then that of the one found
    bool found;             ///< whether there is one, in `cell`: set, and else left alone
    int32_t cell[3];
} vn_voxel_query;

void vn_voxel_tree_nearest(const vn_voxel_tree *tree, vn_voxel_query *query);

#endif
