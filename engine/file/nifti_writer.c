// NIfTI-1: a head of 348 bytes, the manifest as a comment, voxels. All numbers are little-endian.

#include "file/volume_file.h"

#include <math.h>
#include <stdio.h>

enum {
    HEAD = 348,
    EXTENDER = 4,
    LONGEST_SIDE = INT16_MAX,
    COMMENT = 6,      // NIFTI_ECODE_COMMENT
    BLOCK = 16,       // what extensions are a multiple of
    SCANNER_ANAT = 1, // NIFTI_XFORM_SCANNER_ANAT: to the world's own coordinates
    LONGEST_COMMENT = 1 << 24,
};

// Where what stands in the head.
enum {
    AT_SIZE = 0,
    AT_REGULAR = 38,
    AT_DIM = 40,
    AT_DATATYPE = 70,
    AT_BITPIX = 72,
    AT_PIXDIM = 76,
    AT_VOX_OFFSET = 108,
    AT_SLOPE = 112,
    AT_UNITS = 123,
    AT_DESCRIPTION = 148,
    AT_QFORM_CODE = 252,
    AT_SFORM_CODE = 254,
    AT_QOFFSET = 268,
    AT_SROW = 280,
    AT_MAGIC = 344,
};

static void put_int(uint8_t *at, uint32_t value, int bytes) {
    for (int i = 0; i < bytes; i++) {
        at[i] = (uint8_t)(value >> (8 * i));
    }
}

static void put_float(uint8_t *at, double value) {
    float rounded = (float)value;
    uint32_t bits;
    memcpy(&bits, &rounded, sizeof bits);
    put_int(at, bits, 4);
}

// NIfTI knows metres, millimetres and micrometres: other units of length become millimetres, what is none has
// no unit there either.
static const struct {
    const char *name;
    uint8_t code;
    double factor;
} units[] = {{"m", 1, 1},   {"mm", 2, 1},    {"um", 3, 1},         {"µm", 3, 1},
             {"cm", 2, 10}, {"in", 2, 25.4}, {"pt", 2, 25.4 / 72}, {"nm", 3, 1e-3}};

static uint8_t find_unit(const char *name, double *factor) {
    *factor = 1;
    for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
        if (strcmp(units[i].name, name) == 0) {
            *factor = units[i].factor;
            return units[i].code;
        }
    }
    return 0;
}

static bool is_upright(const vn_volume *volume) {
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            double value = volume->to_world[r][c];
            if (r == c ? !(value > 0) : value != 0) {
                return false;
            }
        }
    }
    return true;
}

// The sform holds any grid; the qform, for those who read nothing else, an upright one: rotations are left
// out.
static void put_places(uint8_t *head, const vn_volume *volume, double factor) {
    bool upright = is_upright(volume);
    put_int(head + AT_SFORM_CODE, SCANNER_ANAT, 2);
    put_int(head + AT_QFORM_CODE, upright ? SCANNER_ANAT : 0, 2);
    put_float(head + AT_PIXDIM, 1);
    for (int k = 0; k < 3; k++) {
        const double(*m)[4] = volume->to_world;
        put_float(head + AT_PIXDIM + 4 * (k + 1),
                  factor * sqrt(m[0][k] * m[0][k] + m[1][k] * m[1][k] + m[2][k] * m[2][k]));
        put_float(head + AT_QOFFSET + 4 * k, upright ? factor * m[k][3] : 0);
        for (int c = 0; c < 4; c++) {
            put_float(head + AT_SROW + 16 * k + 4 * c, factor * m[k][c]);
        }
    }
}

static void put_head(uint8_t head[HEAD], const vn_volume *volume, uint32_t offset) {
    static const uint16_t datatypes[] = {
        [VN_VOXEL_U8] = 2, [VN_VOXEL_U16] = 512, [VN_VOXEL_U32] = 768, [VN_VOXEL_F32] = 16};
    double factor;
    memset(head, 0, HEAD);
    put_int(head + AT_SIZE, HEAD, 4);
    head[AT_REGULAR] = 'r';
    put_int(head + AT_DIM, 3, 2);
    for (int k = 0; k < 7; k++) {
        put_int(head + AT_DIM + 2 * (k + 1), k < 3 ? (uint32_t)volume->size[k] : 1, 2);
    }
    put_int(head + AT_DATATYPE, datatypes[volume->type], 2);
    put_int(head + AT_BITPIX, 8 * (uint32_t)vn_voxel_size(volume->type), 2);
    put_float(head + AT_VOX_OFFSET, offset);
    put_float(head + AT_SLOPE, 1);
    head[AT_UNITS] = find_unit(volume->unit, &factor);
    snprintf((char *)head + AT_DESCRIPTION, 80, "Venule %s", vn_version());
    put_places(head, volume, factor);
    memcpy(head + AT_MAGIC, "n+1", 4);
}

static vn_status write_comment(vn_packer *packer, const char *manifest, uint32_t size) {
    static const uint8_t zeros[BLOCK] = {0};
    uint8_t head[8];
    size_t length = strlen(manifest);
    put_int(head, size, 4);
    put_int(head + 4, COMMENT, 4);
    VN_TRY(vn_packer_write(packer, head, sizeof head));
    VN_TRY(vn_packer_write(packer, manifest, length));
    return vn_packer_write(packer, zeros, size - sizeof head - length);
}

static vn_status write_all(vn_packer *packer, const vn_volume *volume, const char *manifest,
                           uint32_t comment) {
    uint8_t head[HEAD], extender[EXTENDER] = {comment > 0, 0, 0, 0};
    put_head(head, volume, HEAD + EXTENDER + comment);
    VN_TRY(vn_packer_write(packer, head, sizeof head));
    VN_TRY(vn_packer_write(packer, extender, sizeof extender));
    if (comment > 0) {
        VN_TRY(write_comment(packer, manifest, comment));
    }
    return vn_volume_pack(packer, volume, 0, vn_volume_voxels(volume), VN_LITTLE_ENDIAN, 1);
}

vn_status vn_nifti_write(vn_sink *sink, const vn_volume *volume, const char *path, const char *manifest,
                         bool packs) {
    size_t length = manifest != NULL ? strlen(manifest) : 0;
    for (int k = 0; k < 3; k++) {
        if (volume->size[k] > LONGEST_SIDE) {
            return vn_fail(VN_LIMIT, "%s: %d voxels in %c are above NIfTI's limit of %d; write a .nrrd", path,
                           volume->size[k], "xyz"[k], LONGEST_SIDE);
        }
    }
    if (length > LONGEST_COMMENT) {
        return vn_fail(VN_LIMIT, "%s: a manifest of %zu bytes is above the limit of %d", path, length,
                       LONGEST_COMMENT);
    }
    uint32_t comment = length > 0 ? ((uint32_t)length + 8 + BLOCK - 1) / BLOCK * BLOCK : 0;
    vn_packer *packer;
    VN_TRY(vn_packer_open(&packer, sink, packs));
    return vn_packer_close(packer, write_all(packer, volume, manifest, comment));
}
