// NIfTI-1 in one file, packed or not. Its header is 348 bytes at fixed places: reading them here is safer
// than by niftilib, which believes a header's sizes, prints to stderr, and reads whatever other files it
// names.

#include "file/volume_reader.h"

#include "base/memory.h"

#include <math.h>
#include <stdio.h>

enum {
    HEADER_SIZE = 348,
    AT_DIM = 40,
    AT_DATATYPE = 70,
    AT_PIXDIM = 76,
    AT_VOX_OFFSET = 108,
    AT_SLOPE = 112,
    AT_INTERCEPT = 116,
    AT_UNITS = 123,
    AT_QFORM_CODE = 252,
    AT_SFORM_CODE = 254,
    AT_QUATERNION = 256,
    AT_QOFFSET = 268,
    AT_SROWS = 280,
    AT_MAGIC = 344,
};

typedef struct nifti {
    unsigned char bytes[HEADER_SIZE];
    bool big_endian;
} nifti;

static uint32_t field(const nifti *n, int at, int size) {
    uint32_t bits = 0;
    for (int k = 0; k < size; k++) {
        bits = bits << 8 | n->bytes[at + (n->big_endian ? k : size - 1 - k)];
    }
    return bits;
}

static int16_t field_short(const nifti *n, int at) {
    return (int16_t)field(n, at, 2);
}

static double field_float(const nifti *n, int at) {
    uint32_t bits = field(n, at, 4);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static vn_status check_header(nifti *n, const char *path) {
    if (field(n, 0, 4) != HEADER_SIZE) {
        n->big_endian = true;
    }
    if (field(n, 0, 4) != HEADER_SIZE) {
        bool second = n->bytes[4] == 'n' && n->bytes[5] == '+' && n->bytes[6] == '2';
        return vn_fail(VN_IO,
                       second ? "%s: is NIfTI-2; save it as NIfTI-1"
                              : "%s: is no NIfTI-1 file: its header does not begin with its size, 348",
                       path);
    }
    if (memcmp(n->bytes + AT_MAGIC, "ni1", 4) == 0) {
        return vn_fail(VN_IO, "%s: has its voxels in a second file (.img); save it as one file", path);
    }
    if (memcmp(n->bytes + AT_MAGIC, "n+1", 4) != 0) {
        return vn_fail(VN_IO, "%s: is no NIfTI-1 file: the mark \"n+1\" is missing at the end of its header",
                       path);
    }
    return VN_OK;
}

static vn_status read_sizes(const nifti *n, vn_volume_head *head, const char *path) {
    int count = field_short(n, AT_DIM);
    if (count < 1 || count > 7) {
        return vn_fail(VN_IO, "%s: dim[0] = %d: a NIfTI file has 1 to 7 dimensions", path, count);
    }
    for (int k = 1; k <= count; k++) {
        int size = field_short(n, AT_DIM + 2 * k);
        if (k <= 3) {
            head->size[k - 1] = size;
        } else if (size > 1) {
            return vn_fail(VN_IO, "%s: dim[%d] = %d: it holds several volumes; save one of them", path, k,
                           size);
        }
    }
    return VN_OK;
}

static vn_status read_type(const nifti *n, vn_volume_head *head, const char *path) {
    static const struct {
        int code;
        vn_scalar scalar;
    } types[] = {{2, VN_SCALAR_U8},   {4, VN_SCALAR_I16},  {8, VN_SCALAR_I32},   {16, VN_SCALAR_F32},
                 {64, VN_SCALAR_F64}, {256, VN_SCALAR_I8}, {512, VN_SCALAR_U16}, {768, VN_SCALAR_U32}};
    int code = field_short(n, AT_DATATYPE);
    for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
        if (types[i].code == code) {
            head->scalar = types[i].scalar;
            return VN_OK;
        }
    }
    return vn_fail(
        VN_IO, "%s: datatype = %d is not read: whole numbers of 8, 16 or 32 bits, float32 and float64 are",
        path, code);
}

// A slope of 0 or none means that there is no scaling.
static void read_scaling(const nifti *n, vn_volume_head *head) {
    double slope = field_float(n, AT_SLOPE), intercept = field_float(n, AT_INTERCEPT);
    if (isfinite(slope) && slope != 0) {
        head->slope = slope;
        head->intercept = isfinite(intercept) ? intercept : 0;
    }
}

static vn_status read_spacings(const nifti *n, double spacing[3], const char *path) {
    for (int k = 0; k < 3; k++) {
        spacing[k] = fabs(field_float(n, AT_PIXDIM + 4 * (k + 1)));
        if (k >= field_short(n, AT_DIM)) {
            spacing[k] = spacing[k] > 0 && spacing[k] < INFINITY ? spacing[k] : 1; // nobody filled it in
        }
        if (!(spacing[k] > 0 && spacing[k] < INFINITY)) {
            return vn_fail(VN_IO, "%s: pixdim[%d] = %g: the size of a voxel must be above 0, and finite",
                           path, k + 1, spacing[k]);
        }
    }
    return VN_OK;
}

static void set_srows(const nifti *n, vn_volume_head *head) {
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 4; c++) {
            head->to_world[r][c] = field_float(n, AT_SROWS + 16 * r + 4 * c);
        }
    }
}

// A rotation by the unit quaternion (a, b, c, d), of which the file has the last three; then pixdim, with the
// third axis mirrored where pixdim[0] is negative.
static vn_status set_quaternion(const nifti *n, vn_volume_head *head, const double spacing[3],
                                const char *path) {
    double b = field_float(n, AT_QUATERNION), c = field_float(n, AT_QUATERNION + 4),
           d = field_float(n, AT_QUATERNION + 8);
    double rest = 1 - (b * b + c * c + d * d);
    if (!(rest > -1e-3)) {
        return vn_fail(VN_IO, "%s: its quaternion (%g, %g, %g) is longer than 1", path, b, c, d);
    }
    double length = rest < 0 ? sqrt(b * b + c * c + d * d) : 1;
    double a = rest > 0 ? sqrt(rest) : 0;
    b /= length;
    c /= length;
    d /= length;
    double turn[3][3] = {{a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)},
                         {2 * (b * c + a * d), a * a + c * c - b * b - d * d, 2 * (c * d - a * b)},
                         {2 * (b * d - a * c), 2 * (c * d + a * b), a * a + d * d - b * b - c * c}};
    for (int r = 0; r < 3; r++) {
        for (int k = 0; k < 3; k++) {
            head->to_world[r][k] = turn[r][k] * spacing[k];
        }
        head->to_world[r][2] *= field_float(n, AT_PIXDIM) < 0 ? -1 : 1;
        head->to_world[r][3] = field_float(n, AT_QOFFSET + 4 * r);
    }
    return VN_OK;
}

// The sform is what somebody has worked out since; then the scanner's qform; then the sizes of voxels alone.
static vn_status place(const nifti *n, vn_volume_head *head, const char *path) {
    double spacing[3];
    if (field_short(n, AT_SFORM_CODE) > 0) {
        set_srows(n, head);
        return VN_OK;
    }
    VN_TRY(read_spacings(n, spacing, path));
    if (field_short(n, AT_QFORM_CODE) > 0) {
        return set_quaternion(n, head, spacing, path);
    }
    for (int k = 0; k < 3; k++) {
        head->to_world[k][k] = spacing[k];
    }
    return VN_OK;
}

vn_status vn_nifti_read(vn_volume *volume, vn_bytes *bytes) {
    static const char *const units[8] = {"", "m", "mm", "um", "", "", "", ""};
    const char *path = vn_bytes_path(bytes);
    nifti n = {.big_endian = false};
    vn_volume_head head = vn_volume_head_default();
    if (vn_bytes_are_packed(bytes)) {
        VN_TRY(vn_bytes_unpack(bytes));
    }
    VN_TRY(vn_bytes_take(bytes, n.bytes, HEADER_SIZE, "header"));
    VN_TRY(check_header(&n, path));
    VN_TRY(read_sizes(&n, &head, path));
    VN_TRY(read_type(&n, &head, path));
    VN_TRY(place(&n, &head, path));
    read_scaling(&n, &head);
    head.big_endian = n.big_endian;
    snprintf(head.unit, sizeof head.unit, "%s", units[n.bytes[AT_UNITS] & 7]);
    double offset = field_float(&n, AT_VOX_OFFSET);
    if (!(offset >= HEADER_SIZE && offset <= 1e9)) {
        return vn_fail(VN_IO, "%s: vox_offset = %g: voxels begin after the header of 348 bytes", path,
                       offset);
    }
    VN_TRY(vn_bytes_check(bytes, offset - HEADER_SIZE, false, "header"));
    VN_TRY(vn_bytes_skip(bytes, (size_t)offset - HEADER_SIZE, "header"));
    return vn_volume_take(volume, bytes, &head);
}
