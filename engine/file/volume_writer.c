// Volumes as files: NRRD, DGtal's .vol and PGM; NIfTI has a file of its own.

#include "file/volume_file.h"
#include "venule/voxels.h"

#include <math.h>

// ---- voxels as bytes

enum { CHUNK = 8192 };

static uint32_t bits_of(const vn_volume *volume, size_t index, int factor) {
    uint32_t bits;
    switch (volume->type) {
    case VN_VOXEL_U8:
        return (uint32_t)factor * ((const uint8_t *)volume->data)[index];
    case VN_VOXEL_U16:
        return ((const uint16_t *)volume->data)[index];
    default:
        memcpy(&bits, (const uint8_t *)volume->data + 4 * index, sizeof bits);
        return bits;
    }
}

vn_status vn_volume_pack(vn_packer *packer, const vn_volume *volume, size_t begin, size_t count,
                         vn_voxel_bytes order, int factor) {
    uint8_t bytes[4 * CHUNK];
    size_t size = vn_voxel_size(volume->type);
    for (size_t done = 0; done < count; done += CHUNK) {
        size_t part = count - done < CHUNK ? count - done : CHUNK;
        for (size_t i = 0; i < part; i++) {
            uint32_t bits = bits_of(volume, begin + done + i, factor);
            for (size_t k = 0; k < size; k++) {
                size_t shift = order == VN_LITTLE_ENDIAN ? k : size - 1 - k;
                bytes[i * size + k] = (uint8_t)(bits >> (8 * shift));
            }
        }
        VN_TRY(vn_packer_write(packer, bytes, part * size));
    }
    return VN_OK;
}

static vn_status write_voxels(vn_sink *sink, const vn_volume *volume, bool packs, int factor) {
    vn_packer *packer;
    VN_TRY(vn_packer_open(&packer, sink, packs));
    return vn_packer_close(
        packer, vn_volume_pack(packer, volume, 0, vn_volume_voxels(volume), VN_LITTLE_ENDIAN, factor));
}

// In formats whose bytes are grey levels, the 1 of a mask is white.
static int mask_factor(const vn_volume *volume) {
    if (volume->type != VN_VOXEL_U8) {
        return 1;
    }
    for (size_t i = 0; i < volume->byte_size; i++) {
        if (((const uint8_t *)volume->data)[i] > 1) {
            return 1;
        }
    }
    return UINT8_MAX;
}

// ---- NRRD

static vn_status write_text(vn_sink *sink, const char *text) {
    return vn_sink_write(sink, text, strlen(text));
}

// Column @p c of the matrix that takes voxels to the world.
static vn_status write_vector(vn_sink *sink, const vn_volume *volume, int c) {
    for (int r = 0; r < 3; r++) {
        VN_TRY(write_text(sink, r == 0 ? " (" : ","));
        VN_TRY(vn_sink_number(sink, volume->to_world[r][c]));
    }
    return write_text(sink, ")");
}

static vn_status write_nrrd_places(vn_sink *sink, const vn_volume *volume) {
    VN_TRY(write_text(sink, "space directions:"));
    for (int c = 0; c < 3; c++) {
        VN_TRY(write_vector(sink, volume, c));
    }
    VN_TRY(write_text(sink, "\nspace origin:"));
    VN_TRY(write_vector(sink, volume, 3));
    const char *unit = volume->unit;
    bool quotable = unit[0] != '\0' && unit[strcspn(unit, "\"\\\r\n")] == '\0';
    return quotable ? vn_sink_print(sink, "\nspace units: \"%s\" \"%s\" \"%s\"\n", unit, unit, unit)
                    : write_text(sink, "\n");
}

// A key and its value stand in one line.
static vn_status write_nrrd_manifest(vn_sink *sink, const char *manifest) {
    VN_TRY(write_text(sink, "venule:="));
    for (const char *at = manifest; *at != '\0'; at++) {
        if (*at == '\n' || *at == '\\') {
            VN_TRY(write_text(sink, *at == '\n' ? "\\n" : "\\\\"));
        } else if (*at != '\r') {
            VN_TRY(vn_sink_write(sink, at, 1));
        }
    }
    return write_text(sink, "\n");
}

static vn_status write_nrrd(vn_sink *sink, const vn_volume *volume, const char *path, const char *manifest) {
    static const char *const types[] = {[VN_VOXEL_U8] = "uint8",
                                        [VN_VOXEL_U16] = "uint16",
                                        [VN_VOXEL_U32] = "uint32",
                                        [VN_VOXEL_F32] = "float"};
    (void)path;
    VN_TRY(vn_sink_print(sink,
                         "NRRD0004\n# Venule %s\ntype: %s\ndimension: 3\nspace: right-anterior-superior\n"
                         "sizes: %d %d %d\n",
                         vn_version(), types[volume->type], volume->size[0], volume->size[1],
                         volume->size[2]));
    VN_TRY(write_nrrd_places(sink, volume));
    VN_TRY(write_text(sink, "kinds: domain domain domain\nendian: little\nencoding: gzip\n"));
    if (manifest != NULL) {
        VN_TRY(write_nrrd_manifest(sink, manifest));
    }
    VN_TRY(write_text(sink, "\n"));
    return write_voxels(sink, volume, true, 1);
}

// ---- DGtal's .vol

// Where DGtal's middle of the volume is, if its whole coordinates can be the world's divided by a voxel's
// side.
static bool find_center(const vn_volume *volume, int64_t center[3]) {
    double side = volume->to_world[0][0];
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            if (volume->to_world[r][c] != (r == c ? side : 0)) {
                return false;
            }
        }
        double first = volume->to_world[r][3] / side;
        if (!(fabs(first) <= INT32_MAX / 2.0) || fabs(first - round(first)) > 1e-6) {
            return false;
        }
        center[r] = (int64_t)round(first) + (volume->size[r] - 1) / 2;
    }
    return side > 0;
}

// Version 2, since readers of older DGtals take the packed bytes of version 3 for voxels.
static vn_status write_vol(vn_sink *sink, const vn_volume *volume, const char *path, const char *manifest) {
    int64_t center[3];
    (void)manifest;
    if (volume->type != VN_VOXEL_U8) {
        return vn_fail(VN_INVALID,
                       "%s: .vol holds bytes, such as content = \"mask\" or \"centerline\"; write a "
                       ".nii.gz or a .nrrd",
                       path);
    }
    VN_TRY(vn_sink_print(
        sink,
        "X: %d\nY: %d\nZ: %d\nVoxel-Size: 1\nAlpha-Color: 0\nInt-Endian: 0123\nVoxel-Endian: 0\n"
        "Version: 2\n",
        volume->size[0], volume->size[1], volume->size[2]));
    if (find_center(volume, center)) {
        VN_TRY(vn_sink_print(sink, "Center-X: %lld\nCenter-Y: %lld\nCenter-Z: %lld\n", (long long)center[0],
                             (long long)center[1], (long long)center[2]));
    }
    VN_TRY(write_text(sink, ".\n"));
    return write_voxels(sink, volume, false, mask_factor(volume));
}

// ---- PGM

static vn_status write_pgm_head(vn_sink *sink, const vn_volume *volume, const char *manifest) {
    VN_TRY(vn_sink_print(sink, "P5\n# Venule %s\n", vn_version()));
    for (const char *at = manifest; at != NULL && *at != '\0';) {
        size_t length = strcspn(at, "\r\n");
        VN_TRY(write_text(sink, "# "));
        VN_TRY(vn_sink_write(sink, at, length));
        VN_TRY(write_text(sink, "\n"));
        at += length;
        at += strspn(at, "\r\n");
    }
    return vn_sink_print(sink, "%d %d\n%d\n", volume->size[0], volume->size[1],
                         volume->type == VN_VOXEL_U8 ? UINT8_MAX : UINT16_MAX);
}

// The highest row comes first.
static vn_status write_rows(vn_packer *packer, const vn_volume *volume, int factor) {
    size_t width = (size_t)volume->size[0];
    for (size_t row = (size_t)volume->size[1]; row-- > 0;) {
        VN_TRY(vn_volume_pack(packer, volume, row * width, width, VN_BIG_ENDIAN, factor));
    }
    return VN_OK;
}

static vn_status write_pgm(vn_sink *sink, const vn_volume *volume, const char *path, const char *manifest) {
    vn_packer *packer;
    if (volume->size[2] != 1) {
        return vn_fail(VN_INVALID,
                       "%s: a .pgm is flat, and the volume has %d voxels in z; write a .nii.gz or a .nrrd",
                       path, volume->size[2]);
    }
    if (volume->type != VN_VOXEL_U8 && volume->type != VN_VOXEL_U16) {
        return vn_fail(VN_INVALID,
                       "%s: a .pgm holds whole numbers to 65,535, such as content = \"mask\", \"label\" or "
                       "\"order\"; write a .nii.gz or a .nrrd",
                       path);
    }
    VN_TRY(write_pgm_head(sink, volume, manifest));
    VN_TRY(vn_packer_open(&packer, sink, false));
    return vn_packer_close(packer, write_rows(packer, volume, mask_factor(volume)));
}

// ---- by extension

static vn_status write_nii(vn_sink *sink, const vn_volume *volume, const char *path, const char *manifest) {
    return vn_nifti_write(sink, volume, path, manifest, false);
}

static vn_status write_nii_gz(vn_sink *sink, const vn_volume *volume, const char *path,
                              const char *manifest) {
    return vn_nifti_write(sink, volume, path, manifest, true);
}

typedef vn_status write_fn(vn_sink *sink, const vn_volume *volume, const char *path, const char *manifest);

static const struct {
    const char *extension;
    write_fn *write;
} formats[] = {{".nii", write_nii},
               {".nii.gz", write_nii_gz},
               {".nrrd", write_nrrd},
               {".vol", write_vol},
               {".pgm", write_pgm}};

static write_fn *find_format(const char *path) {
    size_t length = strlen(path);
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        size_t tail = strlen(formats[i].extension);
        if (length > tail && strcmp(path + length - tail, formats[i].extension) == 0) {
            return formats[i].write;
        }
    }
    return NULL;
}

vn_status vn_volume_write(const vn_volume *volume, const char *path, const char *manifest) {
    write_fn *write = find_format(path);
    vn_sink *sink;
    if (write == NULL) {
        return vn_fail(VN_INVALID,
                       "%s: volumes are written as .nii, .nii.gz, .nrrd, .vol or, flat ones, .pgm; give "
                       "such a name",
                       path);
    }
    VN_TRY(vn_sink_open(&sink, path));
    return vn_sink_close(sink, write(sink, volume, path, manifest));
}
