// PGM, in text (P2) or bytes (P5).

#include "file/volume_reader.h"

#include <math.h>

static vn_status read_whole(vn_bytes *bytes, double *value, double most, const char *name) {
    VN_TRY(vn_bytes_number(bytes, value, "header"));
    if (!(*value >= 1 && *value <= most) || *value != floor(*value)) {
        return vn_fail(VN_IO, "%s: its %s is %.17g: a whole number from 1 to %.17g expected",
                       vn_bytes_path(bytes), name, *value, most);
    }
    return VN_OK;
}

static vn_status check_maximum(const vn_volume *volume, const vn_bytes *bytes, double most) {
    size_t voxels = volume->byte_size / vn_voxel_size(volume->type);
    for (size_t i = 0; i < voxels; i++) {
        if (vn_volume_at(volume, i) > most) {
            return vn_fail(VN_IO, "%s: pixel %zu is %g, above the greatest value of its header, %g",
                           vn_bytes_path(bytes), i, vn_volume_at(volume, i), most);
        }
    }
    return VN_OK;
}

vn_status vn_pgm_read(vn_volume *volume, vn_bytes *bytes) {
    vn_volume_head head = vn_volume_head_default();
    int p = vn_bytes_next(bytes), kind = vn_bytes_next(bytes);
    if (p != 'P' || (kind != '2' && kind != '5')) {
        return vn_fail(VN_IO, "%s: is no PGM file: it begins with neither P2 nor P5", vn_bytes_path(bytes));
    }
    VN_TRY(read_whole(bytes, &head.size[0], INT32_MAX, "width"));
    VN_TRY(read_whole(bytes, &head.size[1], INT32_MAX, "height"));
    VN_TRY(read_whole(bytes, &head.white, UINT16_MAX, "greatest value"));
    head.text = kind == '2';
    head.scalar = head.white > UINT8_MAX ? VN_SCALAR_U16 : VN_SCALAR_U8;
    head.big_endian = true;
    vn_volume_head_flip(&head);
    VN_TRY(vn_volume_take(volume, bytes, &head));
    return check_maximum(volume, bytes, head.white);
}
