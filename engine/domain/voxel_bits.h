/// A mask of voxels, a bit each. A word has the bits of a block of 4 x 4 x 4.
#ifndef VN_DOMAIN_VOXEL_BITS_H
#define VN_DOMAIN_VOXEL_BITS_H

#include "base/memory.h"

/// Block (i, j, k) is word i + blocks[0] (j + blocks[1] k); voxel (a, b, c) of it is bit a + 4 b + 16 c.
typedef struct vn_voxel_bits {
    int32_t size[3];
    int32_t blocks[3];
    size_t count; ///< of the words
    uint64_t *words;
} vn_voxel_bits;

/// None is set.
vn_status vn_voxel_bits_init(vn_voxel_bits *bits, const int32_t size[3]);
void vn_voxel_bits_free(vn_voxel_bits *bits);

static inline uint64_t *vn_voxel_word(const vn_voxel_bits *bits, int32_t i, int32_t j, int32_t k) {
    size_t row = (size_t)(j >> 2) + (size_t)bits->blocks[1] * (size_t)(k >> 2);
    return &bits->words[(size_t)(i >> 2) + (size_t)bits->blocks[0] * row];
}
static inline uint64_t vn_voxel_bit(int32_t i, int32_t j, int32_t k) {
    return (uint64_t)1 << ((i & 3) | (j & 3) << 2 | (k & 3) << 4);
}
/// Of a voxel within the size.
static inline bool vn_voxel_is_set(const vn_voxel_bits *bits, int32_t i, int32_t j, int32_t k) {
    return *vn_voxel_word(bits, i, j, k) & vn_voxel_bit(i, j, k);
}
static inline bool vn_voxel_exists(const vn_voxel_bits *bits, int32_t i, int32_t j, int32_t k) {
    return i >= 0 && j >= 0 && k >= 0 && i < bits->size[0] && j < bits->size[1] && k < bits->size[2];
}

#endif
