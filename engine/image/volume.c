#include "image/volume.h"

#include "base/status.h"
#include "venule/voxels.h"

#include <math.h>

static vn_status check_size(const int32_t size[3], const double spacing[3]) {
    double voxels = 1;
    for (int k = 0; k < 3; k++) {
        if (size[k] < 1 || !(spacing[k] > 0 && spacing[k] < INFINITY)) {
            return vn_fail(VN_INVALID,
                           "a volume of %d x %d x %d voxels, %g x %g x %g apart: all must be above 0",
                           size[0], size[1], size[2], spacing[0], spacing[1], spacing[2]);
        }
        voxels *= size[k];
    }
    if (voxels > INT32_MAX) {
        return vn_fail(VN_LIMIT,
                       "a volume of %d x %d x %d voxels is beyond 2^31 - 1 voxels; use a coarser one",
                       size[0], size[1], size[2]);
    }
    return VN_OK;
}

vn_status vn_volume_init(vn_volume *volume, vn_voxel type, const int32_t size[3], const double spacing[3],
                         const double origin[3]) {
    *volume = (vn_volume){.type = type, .threshold = 0.5};
    VN_TRY(check_size(size, spacing));
    size_t bytes = (size_t)size[0] * (size_t)size[1] * (size_t)size[2] * vn_voxel_size(type);
    volume->data = vn_resize(NULL, 0, bytes);
    if (volume->data == NULL) {
        return vn_fail_memory("a volume", bytes);
    }
    memset(volume->data, 0, bytes);
    volume->byte_size = bytes;
    for (int k = 0; k < 3; k++) {
        volume->size[k] = size[k];
        volume->to_world[k][k] = spacing[k];
        volume->to_world[k][3] = origin[k];
    }
    return VN_OK;
}

void vn_volume_free(vn_volume *volume) {
    vn_resize(volume->data, volume->byte_size, 0);
    *volume = (vn_volume){0};
}

void vn_volume_destroy(vn_volume *volume) {
    if (volume != NULL) {
        vn_volume_free(volume);
        VN_DELETE(volume);
    }
}

void vn_volume_position(const vn_volume *volume, const int32_t voxel[3], double p[3]) {
    for (int r = 0; r < 3; r++) {
        const double *row = volume->to_world[r];
        p[r] = row[0] * voxel[0] + row[1] * voxel[1] + row[2] * voxel[2] + row[3];
    }
}

int64_t vn_volume_count(const vn_volume *volume) {
    size_t voxels = volume->byte_size / vn_voxel_size(volume->type);
    int64_t count = 0;
    for (size_t i = 0; i < voxels; i++) {
        count += vn_volume_at(volume, i) != 0;
    }
    return count;
}
