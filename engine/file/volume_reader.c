#include "file/volume_reader.h"

#include <math.h>
#include <stdio.h>
#include <strings.h>

vn_volume_head vn_volume_head_default(void) {
    vn_volume_head head = {.size = {1, 1, 1}, .threshold = 0.5, .scalar = VN_SCALAR_U8, .slope = 1};
    for (int k = 0; k < 3; k++) {
        head.to_world[k][k] = 1;
    }
    return head;
}

void vn_volume_head_flip(vn_volume_head *head) {
    head->to_world[0][3] = 0.5;
    head->to_world[1][1] = -1;
    head->to_world[1][3] = head->size[1] - 0.5;
}

static size_t scalar_size(vn_scalar scalar) {
    static const unsigned char sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[scalar];
}

// What fits is kept as it is.
static vn_voxel voxel_of(const vn_volume_head *head) {
    if (head->slope != 1 || head->intercept != 0) {
        return VN_VOXEL_F32;
    }
    return head->scalar == VN_SCALAR_U8    ? VN_VOXEL_U8
           : head->scalar == VN_SCALAR_U16 ? VN_VOXEL_U16
                                           : VN_VOXEL_F32;
}

// ---- What a header may say ----

static vn_status check_size(const vn_bytes *bytes, const vn_volume_head *head) {
    double voxels = head->size[0] * head->size[1] * head->size[2];
    for (int a = 0; a < 3; a++) {
        if (!(head->size[a] >= 1) || head->size[a] != floor(head->size[a])) {
            return vn_fail(
                VN_IO, "%s: its header claims %.17g x %.17g x %.17g voxels: a volume has 1 or more each way",
                vn_bytes_path(bytes), head->size[0], head->size[1], head->size[2]);
        }
    }
    if (!(voxels <= INT32_MAX)) {
        return vn_fail(VN_LIMIT,
                       "%s: its header claims %.17g x %.17g x %.17g voxels, beyond the limit of 2^31 - 1; "
                       "make it coarser",
                       vn_bytes_path(bytes), head->size[0], head->size[1], head->size[2]);
    }
    return VN_OK;
}

// Before room is made for what the file cannot hold. As text a voxel is a digit and a space, but for the
// last.
static vn_status check_held(const vn_bytes *bytes, const vn_volume_head *head) {
    double voxels = head->size[0] * head->size[1] * head->size[2];
    double least = head->text ? 2 * voxels - 1 : voxels * (double)scalar_size(head->scalar);
    return vn_bytes_check(bytes, least, false, "voxels");
}

static vn_status check_axes(const vn_bytes *bytes, const vn_volume_head *head) {
    const double(*m)[4] = head->to_world;
    double lengths = 1;
    for (int a = 0; a < 4; a++) {
        double length = 0;
        for (int r = 0; r < 3; r++) {
            if (!(fabs(m[r][a]) <= 1e60)) {
                return vn_fail(
                    VN_IO, "%s: its %s is (%g, %g, %g): its numbers must be finite, and within 1e60",
                    vn_bytes_path(bytes), a < 3 ? "voxel axis" : "origin", m[0][a], m[1][a], m[2][a]);
            }
            length += m[r][a] * m[r][a];
        }
        lengths *= a < 3 ? sqrt(length) : 1;
    }
    double determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    if (!(fabs(determinant) > 1e-6 * lengths) || !(lengths >= 1e-180)) {
        return vn_fail(VN_IO,
                       "%s: its voxel axes (%g, %g, %g), (%g, %g, %g) and (%g, %g, %g) span no volume: its "
                       "matrix is singular",
                       vn_bytes_path(bytes), m[0][0], m[1][0], m[2][0], m[0][1], m[1][1], m[2][1], m[0][2],
                       m[1][2], m[2][2]);
    }
    return VN_OK;
}

vn_status vn_volume_make(vn_volume *volume, const vn_bytes *bytes, const vn_volume_head *head) {
    static const double unit[3] = {1, 1, 1}, origin[3] = {0, 0, 0};
    VN_TRY(check_size(bytes, head));
    VN_TRY(check_axes(bytes, head));
    int32_t size[3] = {(int32_t)head->size[0], (int32_t)head->size[1], (int32_t)head->size[2]};
    VN_TRY(vn_volume_init(volume, voxel_of(head), size, unit, origin));
    memcpy(volume->to_world, head->to_world, sizeof volume->to_world);
    memcpy(volume->unit, head->unit, sizeof volume->unit);
    volume->white = head->white;
    volume->threshold = head->threshold;
    return VN_OK;
}

// ---- Voxels ----

static uint64_t gather(const unsigned char *from, size_t size, bool big_endian) {
    uint64_t bits = 0;
    for (size_t k = 0; k < size; k++) {
        bits = bits << 8 | from[big_endian ? k : size - 1 - k];
    }
    return bits;
}

static double scalar_of(vn_scalar scalar, uint64_t bits) {
    uint32_t word = (uint32_t)bits;
    float single;
    double number;
    switch (scalar) {
    case VN_SCALAR_I8:
        return (int8_t)bits;
    case VN_SCALAR_I16:
        return (int16_t)bits;
    case VN_SCALAR_I32:
        return (int32_t)word;
    case VN_SCALAR_F32:
        memcpy(&single, &word, sizeof single);
        return single;
    case VN_SCALAR_F64:
        memcpy(&number, &bits, sizeof number);
        return number;
    default:
        return word;
    }
}

static vn_status take_numbers(vn_volume *volume, vn_bytes *bytes, const vn_volume_head *head, size_t voxels) {
    for (size_t i = 0; i < voxels; i++) {
        double value;
        VN_TRY(vn_bytes_number(bytes, &value, "voxels"));
        bool whole = volume->type == VN_VOXEL_F32 || (value >= 0 && value == floor(value));
        double most = volume->type == VN_VOXEL_U8    ? UINT8_MAX
                      : volume->type == VN_VOXEL_U16 ? UINT16_MAX
                                                     : INFINITY;
        if (!whole || value > most) {
            return vn_fail(VN_IO, "%s: voxel %zu is %.17g: its type holds whole numbers from 0 to %g",
                           vn_bytes_path(bytes), i, value, most);
        }
        vn_volume_put(volume, i, head->slope * value + head->intercept);
        if (i % 65536 == 0) {
            VN_TRY(vn_poll());
        }
    }
    return VN_OK;
}

static vn_status take_scalars(vn_volume *volume, vn_bytes *bytes, const vn_volume_head *head, size_t voxels) {
    enum { CHUNK = 2048 };
    unsigned char chunk[CHUNK * sizeof(double)];
    size_t size = scalar_size(head->scalar);
    for (size_t begin = 0; begin < voxels; begin += CHUNK) {
        size_t count = voxels - begin < CHUNK ? voxels - begin : CHUNK;
        VN_TRY(vn_bytes_take(bytes, chunk, count * size, "voxels"));
        for (size_t i = 0; i < count; i++) {
            double value = scalar_of(head->scalar, gather(chunk + i * size, size, head->big_endian));
            vn_volume_put(volume, begin + i, head->slope * value + head->intercept);
        }
        if (begin / CHUNK % 256 == 0) {
            VN_TRY(vn_poll());
        }
    }
    return VN_OK;
}

static vn_status take_bytes(vn_volume *volume, vn_bytes *bytes) {
    size_t part;
    for (size_t begin = 0; begin < volume->byte_size; begin += part) {
        part = volume->byte_size - begin < 1 << 20 ? volume->byte_size - begin : 1 << 20;
        VN_TRY(vn_bytes_take(bytes, (char *)volume->data + begin, part, "voxels"));
        VN_TRY(vn_poll());
    }
    return VN_OK;
}

vn_status vn_volume_take(vn_volume *volume, vn_bytes *bytes, const vn_volume_head *head) {
    VN_TRY(check_size(bytes, head));
    VN_TRY(check_held(bytes, head));
    VN_TRY(vn_volume_make(volume, bytes, head));
    size_t voxels = volume->byte_size / vn_voxel_size(volume->type);
    if (head->text) {
        return take_numbers(volume, bytes, head, voxels);
    }
    VN_TRY(volume->type == VN_VOXEL_U8 ? take_bytes(volume, bytes)
                                       : take_scalars(volume, bytes, head, voxels));
    return vn_bytes_end(bytes);
}

// ---- Files ----

typedef struct format {
    const char *extension;
    vn_status (*read)(vn_volume *volume, vn_bytes *bytes);
} format;

static const format formats[] = {
    {".nii", vn_nifti_read}, {".nii.gz", vn_nifti_read}, {".nrrd", vn_nrrd_read},
    {".vol", vn_vol_read},   {".png", vn_png_read},      {".pgm", vn_pgm_read},
};

static const format *format_of(const char *path) {
    size_t length = strlen(path);
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        size_t tail = strlen(formats[i].extension);
        if (length > tail && strcasecmp(path + length - tail, formats[i].extension) == 0) {
            return &formats[i];
        }
    }
    return NULL;
}

vn_status vn_volume_read(vn_volume *volume, const char *path) {
    *volume = (vn_volume){0};
    const format *found = format_of(path);
    if (found == NULL) {
        return vn_fail(VN_INVALID,
                       "%s: a volume is read from .nii, .nii.gz, .nrrd or .vol, an image from .png or .pgm",
                       path);
    }
    vn_bytes *bytes;
    VN_TRY(vn_bytes_open(&bytes, path));
    vn_status status = found->read(volume, bytes);
    vn_bytes_close(bytes);
    if (status != VN_OK) {
        vn_volume_free(volume);
    }
    return status;
}
