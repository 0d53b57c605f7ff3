/// What the writers of volumes share.
#ifndef VN_FILE_VOLUME_FILE_H
#define VN_FILE_VOLUME_FILE_H

#include "file/packer.h"
#include "image/volume.h"

typedef enum vn_voxel_bytes {
    VN_LITTLE_ENDIAN,
    VN_BIG_ENDIAN,
} vn_voxel_bytes;

/// Write @p count voxels from number @p begin on, each times @p factor, which is 1 but for bytes.
vn_status vn_volume_pack(vn_packer *packer, const vn_volume *volume, size_t begin, size_t count,
                         vn_voxel_bytes order, int factor);

static inline size_t vn_volume_voxels(const vn_volume *volume) {
    return (size_t)volume->size[0] * (size_t)volume->size[1] * (size_t)volume->size[2];
}

vn_status vn_nifti_write(vn_sink *sink, const vn_volume *volume, const char *path, const char *manifest,
                         bool packs);

#endif
