/// Voxels in space: what masks and density maps are read into, and what networks are voxelised into.
#ifndef VN_IMAGE_VOLUME_H
#define VN_IMAGE_VOLUME_H

#include "base/array.h"

typedef enum vn_voxel {
    VN_VOXEL_U8,
    VN_VOXEL_U16,
    VN_VOXEL_U32,
    VN_VOXEL_F32,
} vn_voxel;

/// Voxel (i, j, k) is element i + size[0] (j + size[1] k), and a box around the point to_world takes it to:
/// world[r] = to_world[r][0] i + to_world[r][1] j + to_world[r][2] k + to_world[r][3]. A flat image has
/// size[2] 1.
typedef struct vn_volume {
    int32_t size[3];
    double to_world[3][4];
    char unit[8];     ///< of the world: "mm", "um", "m", or ""
    double white;     ///< the value that counts as 1; 0 where its format does not say
    double threshold; ///< the least value inside, where it is a mask; 0.5 unless its format says more
    vn_voxel type;
    void *data;       ///< size[0] size[1] size[2] voxels of `type`
    size_t byte_size; ///< of `data`
} vn_volume;

static inline size_t vn_voxel_size(vn_voxel type) {
    return type == VN_VOXEL_U8 ? 1 : type == VN_VOXEL_U16 ? 2 : 4;
}

/// Zeroed voxels, @p spacing apart along the axes, the middle of the first at @p origin. VN_INVALID for a
/// size below 1 or a spacing that is not above 0, VN_LIMIT beyond 2^31 - 1 voxels, VN_NO_MEMORY.
vn_status vn_volume_init(vn_volume *volume, vn_voxel type, const int32_t size[3], const double spacing[3],
                         const double origin[3]);
void vn_volume_free(vn_volume *volume);

/// Where the middle of a voxel is in the world.
void vn_volume_position(const vn_volume *volume, const int32_t voxel[3], double p[3]);

/// How many voxels are not 0.
int64_t vn_volume_count(const vn_volume *volume);

/// Any voxel as a number.
static inline double vn_volume_at(const vn_volume *volume, size_t index) {
    switch (volume->type) {
    case VN_VOXEL_U8:
        return ((const uint8_t *)volume->data)[index];
    case VN_VOXEL_U16:
        return ((const uint16_t *)volume->data)[index];
    case VN_VOXEL_U32:
        return ((const uint32_t *)volume->data)[index];
    default:
        return ((const float *)volume->data)[index];
    }
}

/// Set a voxel to a number that its type can hold.
static inline void vn_volume_put(vn_volume *volume, size_t index, double value) {
    switch (volume->type) {
    case VN_VOXEL_U8:
        ((uint8_t *)volume->data)[index] = (uint8_t)value;
        break;
    case VN_VOXEL_U16:
        ((uint16_t *)volume->data)[index] = (uint16_t)value;
        break;
    case VN_VOXEL_U32:
        ((uint32_t *)volume->data)[index] = (uint32_t)value;
        break;
    case VN_VOXEL_F32:
        ((float *)volume->data)[index] = (float)value;
        break;
    }
}

#endif
