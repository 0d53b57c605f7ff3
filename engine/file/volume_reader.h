/// Volumes and images from files.
#ifndef VN_FILE_VOLUME_READER_H
#define VN_FILE_VOLUME_READER_H

#include "file/bytes.h"
#include "image/volume.h"

/// Read a volume (.nii, .nii.gz, .nrrd, .vol) or a flat image (.png, .pgm), by the extension of @p path.
/// Signed and wide numbers become VN_VOXEL_F32. VN_INVALID for another extension; VN_IO for a file that is
/// missing, broken, cut off or says what cannot be; VN_LIMIT beyond 2^31 - 1 voxels. @p volume is empty after
/// a failure.
vn_status vn_volume_read(vn_volume *volume, const char *path);

typedef enum vn_scalar {
    VN_SCALAR_I8,
    VN_SCALAR_U8,
    VN_SCALAR_I16,
    VN_SCALAR_U16,
    VN_SCALAR_I32,
    VN_SCALAR_U32,
    VN_SCALAR_F32,
    VN_SCALAR_F64,
} vn_scalar;

/// What a file's header says of its voxels, and of the volume they make.
typedef struct vn_volume_head {
    double size[3];
    double to_world[3][4]; ///< as vn_volume has it
    char unit[8];
    double white, threshold; ///< as vn_volume has them
    vn_scalar scalar;
    bool big_endian, text;
    double slope, intercept; ///< voxels are slope times what is in the file, plus intercept
} vn_volume_head;

/// Voxels 1 apart, the first at the origin, 0.5 or above inside, bytes.
vn_volume_head vn_volume_head_default(void);

/// Make the volume of a head, zeroed. What cannot be is VN_IO: a size below 1, axes that are not finite or
/// span no volume.
vn_status vn_volume_make(vn_volume *volume, const vn_bytes *bytes, const vn_volume_head *head);
/// Make it, and read its voxels from where @p bytes stands.
vn_status vn_volume_take(vn_volume *volume, vn_bytes *bytes, const vn_volume_head *head);

// The formats. What they have put into @p volume after a failure is freed by vn_volume_read().
vn_status vn_nifti_read(vn_volume *volume, vn_bytes *bytes);
vn_status vn_nrrd_read(vn_volume *volume, vn_bytes *bytes);
vn_status vn_vol_read(vn_volume *volume, vn_bytes *bytes);
vn_status vn_pgm_read(vn_volume *volume, vn_bytes *bytes);
vn_status vn_png_read(vn_volume *volume, vn_bytes *bytes);

/// Rows come from above: place a flat image's lower left corner at (0, 0).
void vn_volume_head_flip(vn_volume_head *head);

#endif
