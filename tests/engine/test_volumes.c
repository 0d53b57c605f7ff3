// Volumes and images from files: every format gives the same voxels at the same places, and nothing that a
// file says of itself is believed.
#include "support.h"

#include "file/volume_reader.h"

#include <png.h>
#include <zlib.h>

enum { MOST_BYTES = 1 << 16 };

/// A file in the making.
typedef struct bytes {
    unsigned char data[MOST_BYTES];
    size_t count;
} bytes;

static void put(bytes *b, const void *data, size_t count) {
    assert_true(b->count + count <= MOST_BYTES);
    memcpy(b->data + b->count, data, count);
    b->count += count;
}

static void put_text(bytes *b, const char *text) {
    put(b, text, strlen(text));
}

static void set_number(bytes *b, size_t at, uint64_t bits, int size, bool big) {
    for (int k = 0; k < size; k++) {
        b->data[at + (size_t)(big ? size - 1 - k : k)] = (unsigned char)(bits >> 8 * k);
    }
}

static void set_float(bytes *b, size_t at, float value, bool big) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    set_number(b, at, bits, 4, big);
}

// As gzip (31) or zlib (15) do.
static void put_packed(bytes *b, const unsigned char *data, size_t count, int window) {
    z_stream z = {.next_in = (unsigned char *)data, .avail_in = (uInt)count};
    assert_int_equal(deflateInit2(&z, 9, Z_DEFLATED, window, 8, Z_DEFAULT_STRATEGY), Z_OK);
    z.next_out = b->data + b->count;
    z.avail_out = (uInt)(MOST_BYTES - b->count);
    assert_int_equal(deflate(&z, Z_FINISH), Z_STREAM_END);
    b->count = MOST_BYTES - z.avail_out;
    deflateEnd(&z);
}

static const char *put_file(const char *extension, const bytes *b) {
    static char name[64];
    snprintf(name, sizeof name, "volume%s", extension);
    FILE *file = fopen(name, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(b->data, 1, b->count, file), b->count);
    assert_int_equal(fclose(file), 0);
    return name;
}

static vn_status try_read(vn_volume *volume, const char *extension, const bytes *b) {
    vn_status status = vn_volume_read(volume, put_file(extension, b));
    assert_true((volume->data == NULL) == (status != VN_OK));
    assert_null(strchr(status != VN_OK ? vn_message() : "", '\n'));
    return status;
}

static void refuses(const char *extension, const bytes *b, vn_status expected, const char *message) {
    vn_volume volume;
    assert_int_equal(try_read(&volume, extension, b), expected);
    check_message(message, __FILE__, __LINE__);
}

static void check_voxels(const vn_volume *volume, const double *values, size_t count) {
    assert_int_equal((size_t)volume->size[0] * (size_t)volume->size[1] * (size_t)volume->size[2], count);
    for (size_t i = 0; i < count; i++) {
        assert_near(vn_volume_at(volume, i), values[i], 0);
    }
}

static void check_place(const vn_volume *volume, const double expected[3][4]) {
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 4; c++) {
            assert_near(volume->to_world[r][c], expected[r][c], 1e-6);
        }
    }
}

// Cut off anywhere it is refused; with any byte changed it is read or refused, and nothing else happens.
static void check_lies(const char *extension, const bytes *whole) {
    vn_volume volume;
    vn_rng rng = vn_rng_make(1);
    bytes b = *whole;
    for (b.count = 0; b.count < whole->count; b.count++) {
        vn_status status = try_read(&volume, extension, &b);
        assert_int_equal(status, VN_IO);
    }
    for (int round = 0; round < 100; round++) {
        b = *whole;
        b.data[vn_rng_integer(&rng, 0, (int64_t)b.count - 1)] = (unsigned char)vn_rng_integer(&rng, 0, 255);
        b.data[vn_rng_integer(&rng, 0, (int64_t)b.count - 1)] ^=
            (unsigned char)(1 << vn_rng_integer(&rng, 0, 7));
        if (try_read(&volume, extension, &b) == VN_OK) {
            vn_volume_free(&volume);
        }
    }
}

// ---- NIfTI ----

/// Of 2 x 3 x 2 voxels, numbered from 1.
static bytes nifti_of(int code, int size, bool big) {
    bytes b = {.count = 352};
    static const int dim[8] = {3, 2, 3, 2, 1, 1, 1, 1};
    set_number(&b, 0, 348, 4, big);
    for (int k = 0; k < 8; k++) {
        set_number(&b, 40 + 2 * (size_t)k, (uint64_t)dim[k], 2, big);
        set_float(&b, 76 + 4 * (size_t)k, k == 0 ? 1 : (float)(k + 1), big);
    }
    set_number(&b, 70, (uint64_t)code, 2, big);
    set_float(&b, 108, 352, big);
    b.data[123] = 2 + 8;
    memcpy(b.data + 344, "n+1", 4);
    for (uint64_t i = 0; i < 12; i++, b.count += (size_t)size) {
        float single = (float)(i + 1);
        double number = (double)(i + 1);
        uint64_t bits = i + 1;
        uint32_t word;
        memcpy(&word, &single, sizeof word);
        if (code == 64) {
            memcpy(&bits, &number, sizeof bits);
        }
        set_number(&b, b.count, code == 16 ? word : bits, size, big);
    }
    return b;
}

static const double counted[12] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};

static void nifti_of_every_type_is_read(void **state) {
    (void)state;
    static const int types[][2] = {{2, 1}, {4, 2}, {8, 4}, {16, 4}, {64, 8}, {256, 1}, {512, 2}, {768, 4}};
    static const double placed[3][4] = {{2, 0, 0, 0}, {0, 3, 0, 0}, {0, 0, 4, 0}};
    vn_volume volume;
    for (int t = 0; t < 8; t++) {
        for (int big = 0; big < 2; big++) {
            bytes b = nifti_of(types[t][0], types[t][1], big), packed = {.count = 0};
            put_packed(&packed, b.data, b.count, 31);
            assert_ok(try_read(&volume, ".nii", &b));
            check_voxels(&volume, counted, 12);
            check_place(&volume, placed);
            assert_string_equal(volume.unit, "mm");
            assert_int_equal(volume.type, t == 0 ? VN_VOXEL_U8 : t == 6 ? VN_VOXEL_U16 : VN_VOXEL_F32);
            vn_volume_free(&volume);
            assert_ok(try_read(&volume, ".nii.gz", &packed));
            check_voxels(&volume, counted, 12);
            vn_volume_free(&volume);
        }
    }
    bytes b = nifti_of(4, 2, false);
    set_number(&b, 352, 0xFFFE, 2, false); // -2
    set_float(&b, 112, 0.5f, false);
    set_float(&b, 116, 10, false);
    assert_ok(try_read(&volume, ".nii", &b));
    assert_near(vn_volume_at(&volume, 0), 9, 0);
    assert_near(vn_volume_at(&volume, 11), 16, 0);
    vn_volume_free(&volume);
    set_float(&b, 112, NAN, false); // as nibabel writes "none"
    assert_ok(try_read(&volume, ".nii", &b));
    assert_near(vn_volume_at(&volume, 0), -2, 0);
    vn_volume_free(&volume);
}

static void nifti_is_placed_by_its_sform_then_its_qform(void **state) {
    (void)state;
    vn_volume volume;
    bytes b = nifti_of(2, 1, false);
    // A turn by 90 degrees about z, and the third axis mirrored.
    static const double turned[3][4] = {{0, -3, 0, 7}, {2, 0, 0, 8}, {0, 0, -4, 9}};
    static const double rows[3][4] = {{0, 0, 1.5, -1}, {-2, 0, 0, -2}, {0, 1, 0, -3}};
    set_number(&b, 252, 1, 2, false);
    set_float(&b, 76, -1, false);
    set_float(&b, 264, (float)sqrt(0.5), false);
    for (int r = 0; r < 3; r++) {
        set_float(&b, 268 + 4 * (size_t)r, (float)(7 + r), false);
        for (int c = 0; c < 4; c++) {
            set_float(&b, 280 + 16 * (size_t)r + 4 * (size_t)c, (float)rows[r][c], false);
        }
    }
    assert_ok(try_read(&volume, ".nii", &b));
    check_place(&volume, turned);
    vn_volume_free(&volume);
    set_number(&b, 254, 2, 2, false);
    assert_ok(try_read(&volume, ".nii", &b));
    check_place(&volume, rows);
    vn_volume_free(&volume);
    bytes wrong = b;
    set_float(&wrong, 280 + 8, NAN, false);
    refuses(".nii", &wrong, VN_IO, "volume.nii: its voxel axis is (nan, 0, 0)");
    set_float(&wrong, 280 + 8, 0, false);
    refuses(".nii", &wrong, VN_IO,
            "volume.nii: its voxel axes (0, -2, 0), (0, 0, 1) and (0, 0, 0) span no volume");
    set_number(&wrong, 254, 0, 2, false);
    set_float(&wrong, 256, 1, false);
    refuses(".nii", &wrong, VN_IO, "is longer than 1");
    set_float(&wrong, 80, 0, false);
    refuses(".nii", &wrong, VN_IO, "pixdim[1] = 0");
}

static void what_nifti_says_is_checked(void **state) {
    (void)state;
    static const struct {
        size_t at;
        int size;
        uint64_t bits;
        vn_status status;
        const char *message;
    } wrong[] = {
        {0, 4, 540, VN_IO, "is no NIfTI-1 file"},
        {40, 2, 0, VN_IO, "dim[0] = 0"},
        {42, 2, 0xFFFF, VN_IO, "claims -1 x 3 x 2 voxels"},
        {42, 2, 0, VN_IO, "claims 0 x 3 x 2 voxels"},
        {42, 2, 3, VN_IO, "claims 18 bytes of voxels, more than its own bytes can hold"},
        {70, 2, 128, VN_IO, "datatype = 128 is not read"},
        {70, 2, 1, VN_IO, "datatype = 1 is not read"},
        {108, 4, 0x7FC00000, VN_IO, "vox_offset = nan"},
        {108, 4, 0, VN_IO, "vox_offset = 0"},
        {108, 4, 0x4E000000, VN_IO, "more than its own bytes can hold"},
        {344, 4, 0x0031696E, VN_IO, "second file"},
        {344, 4, 0, VN_IO, "the mark \"n+1\" is missing"},
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        bytes b = nifti_of(2, 1, false);
        set_number(&b, wrong[k].at, wrong[k].bits, wrong[k].size, false);
        refuses(".nii", &b, wrong[k].status, wrong[k].message);
    }
    bytes b = nifti_of(2, 1, false);
    set_number(&b, 40, 4, 2, false);
    set_number(&b, 48, 5, 2, false);
    refuses(".nii", &b, VN_IO, "dim[4] = 5: it holds several volumes");
    for (size_t k = 0; k < 3; k++) {
        set_number(&b, 42 + 2 * k, 32767, 2, false);
    }
    set_number(&b, 48, 1, 2, false);
    refuses(".nii", &b, VN_LIMIT, "32767 x 32767 x 32767 voxels, beyond the limit of 2^31 - 1");
    for (int packed = 0; packed < 2; packed++) {
        bytes whole = nifti_of(16, 4, false), gz = {.count = 0};
        put_packed(&gz, whole.data, whole.count, 31);
        check_lies(packed ? ".nii.gz" : ".nii", packed ? &gz : &whole);
    }
}

static void a_broken_checksum_is_noticed(void **state) {
    (void)state;
    bytes b = nifti_of(2, 1, false), gz = {.count = 0};
    vn_volume volume;
    put_packed(&gz, b.data, 200, 31); // two members, as some programs write them
    put_packed(&gz, b.data + 200, b.count - 200, 31);
    assert_ok(try_read(&volume, ".nii.gz", &gz));
    check_voxels(&volume, counted, 12);
    vn_volume_free(&volume);
    gz.data[gz.count - 7] ^= 1;
    refuses(".nii.gz", &gz, VN_IO, "volume.nii.gz: its packed bytes are broken: zlib says");
    refuses(".tif", &gz, VN_INVALID,
            "a volume is read from .nii, .nii.gz, .nrrd or .vol, an image from .png or .pgm");
}

// Little that claims to become much is not unpacked to see.
static void bombs_do_not_go_off(void **state) {
    (void)state;
    static unsigned char zeros[4 << 20];
    bytes b = nifti_of(2, 1, false), gz = {.count = 0};
    vn_volume volume;
    memcpy(zeros, b.data, b.count);
    set_number(&b, 42, 1000, 2, false);
    set_number(&b, 44, 1000, 2, false);
    set_number(&b, 46, 1000, 2, false);
    memcpy(zeros, b.data, 352);
    put_packed(&gz, zeros, sizeof zeros, 31);
    refuses(".nii.gz", &gz, VN_IO, "claims 1000000000 bytes of voxels, more than its own bytes can hold");
    gz.count = 0;
    memcpy(zeros, nifti_of(2, 1, false).data, 364);
    put_packed(&gz, zeros, sizeof zeros, 31);
    vn_byte_peak_reset();
    assert_ok(try_read(&volume, ".nii.gz", &gz));
    assert_true(vn_byte_peak() < 400000);
    vn_volume_free(&volume);
}

// ---- NRRD ----

static bytes nrrd_of(const char *fields, const char *encoding, const void *data, size_t count) {
    bytes b = {.count = 0};
    put_text(&b, "NRRD0004\n# somebody's\n");
    put_text(&b, fields);
    put_text(&b, "encoding: ");
    put_text(&b, encoding);
    put_text(&b, "\nmanifest:={\"seed\": 1}\n\n");
    if (strcmp(encoding, "gzip") == 0) {
        put_packed(&b, data, count, 31);
    } else {
        put(&b, data, count);
    }
    return b;
}

static void nrrd_of_every_encoding_is_read(void **state) {
    (void)state;
    static const unsigned char data[12] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
    static const char text[] = "1 2 3 4\n5 6 7 8\n9 10 11 12\n";
    static const char *const encodings[] = {"raw", "gzip", "ascii"};
    static const double placed[3][4] = {{-2, 0, 0, -10}, {0, 0, -3, -20}, {0, 4, 0, 30}};
    vn_volume volume;
    for (int k = 0; k < 3; k++) {
        bytes b = nrrd_of("type: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: 2 3 2\n"
                          "space directions: (2,0,0) (0,0,4) (0, 3, 0)\nspace origin: (10,20,30)\n"
                          "space units: \"mm\" \"mm\" \"mm\"\nkinds: domain domain domain\n",
                          encodings[k], k < 2 ? (const void *)data : text, k < 2 ? 12 : sizeof text - 1);
        assert_ok(try_read(&volume, ".nrrd", &b));
        check_voxels(&volume, counted, 12);
        check_place(&volume, placed);
        assert_string_equal(volume.unit, "mm");
        assert_int_equal(volume.type, VN_VOXEL_U8);
        vn_volume_free(&volume);
        if (k < 2) {
            check_lies(".nrrd", &b);
        }
    }
}

static void nrrd_of_every_type_is_read(void **state) {
    (void)state;
    static const struct {
        const char *name;
        int size;
        unsigned char data[16];
        double values[2];
    } types[] = {
        {"signed char", 1, {0xFF, 5}, {-1, 5}},
        {"unsigned char", 1, {0xFF, 5}, {255, 5}},
        {"short", 2, {0xFE, 0xFF, 1, 2}, {-2, 513}},
        {"uint16_t", 2, {0xFE, 0xFF, 1, 2}, {65534, 513}},
        {"int", 4, {0xFD, 0xFF, 0xFF, 0xFF, 0, 0, 1, 0}, {-3, 65536}},
        {"unsigned int", 4, {0, 0, 0, 0xFF, 0, 0, 1, 0}, {4278190080., 65536}},
        {"float", 4, {0, 0, 0xC0, 0x3F, 0, 0, 0, 0xC0}, {1.5, -2}},
        {"double", 8, {0, 0, 0, 0, 0, 0, 0xF8, 0x3F, 0, 0, 0, 0, 0, 0, 0, 0xC0}, {1.5, -2}},
    };
    vn_volume volume;
    for (size_t t = 0; t < sizeof types / sizeof *types; t++) {
        for (int big = 0; big < 2; big++) {
            char fields[160];
            unsigned char data[16];
            for (int i = 0; i < 2 * types[t].size; i++) {
                int at = i / types[t].size * types[t].size, k = i % types[t].size;
                data[i] = types[t].data[big ? at + types[t].size - 1 - k : i];
            }
            snprintf(fields, sizeof fields,
                     "type: %s\ndimension: 2\nsizes: 1 2\nendian: %s\nspacings: 0.5 0.25\n", types[t].name,
                     big ? "big" : "little");
            bytes b = nrrd_of(fields, "raw", data, 2 * (size_t)types[t].size);
            assert_ok(try_read(&volume, ".nrrd", &b));
            check_voxels(&volume, types[t].values, 2);
            assert_near(volume.to_world[1][1], 0.25, 0);
            assert_string_equal(volume.unit, "");
            vn_volume_free(&volume);
        }
    }
}

static void what_nrrd_says_is_checked(void **state) {
    (void)state;
    static const struct {
        const char *fields, *encoding;
        vn_status status;
        const char *message;
    } wrong[] = {
        {"type: uint8\ndimension: 4\n", "raw", VN_IO, "dimension: \"4\" is not read"},
        {"type: uint8\ndimension: 3\n", "raw", VN_IO, "its header has no \"sizes\""},
        {"type: uint8\n", "raw", VN_IO, "its header has no \"dimension\""},
        {"dimension: 3\nsizes: 1 1 4\n", "raw", VN_IO, "its header has no \"type\""},
        {"type: short\ndimension: 3\nsizes: 1 1 2\n", "raw", VN_IO, "its header has no \"endian\""},
        {"type: uint8\nsizes: 1 1 4\n", "raw", VN_IO, "sizes: \"1 1 4\" is not read"},
        {"type: uint8\ndimension: 3\nsizes: 1 1\n", "raw", VN_IO, "sizes: \"1 1\" is not read"},
        {"type: uint8\ndimension: 3\nsizes: 1 1 4 7\n", "raw", VN_IO, "sizes: \"1 1 4 7\" is not read"},
        {"type: uint8\ndimension: 3\nsizes: 1 -1 4\n", "raw", VN_IO, "claims 1 x -1 x 4 voxels"},
        {"type: uint8\ndimension: 3\nsizes: 1 1.5 4\n", "raw", VN_IO, "claims 1 x 1.5 x 4 voxels"},
        {"type: uint8\ndimension: 3\nsizes: 1e9 1e9 1e9\n", "raw", VN_LIMIT, "beyond the limit of 2^31 - 1"},
        {"type: uint8\ndimension: 3\nsizes: 1e308 1e308 4\n", "raw", VN_LIMIT, "beyond the limit"},
        {"type: uint8\ndimension: 3\nsizes: 1 1 2147483647\n", "gzip", VN_IO,
         "more than its own bytes can hold"},
        {"type: uint8\ndimension: 3\nsizes: 1 1 2147483647\n", "ascii", VN_IO,
         "more than its own bytes can hold"},
        {"type: block\n", "raw", VN_IO, "type: \"block\" is not read"},
        {"type: int64\n", "raw", VN_IO, "type: \"int64\" is not read: whole numbers of 8, 16 or 32 bits"},
        {"", "bzip2", VN_IO, "encoding: \"bzip2\" is not read: raw, gzip and ascii are"},
        {"data file: other.raw\n", "raw", VN_IO, "voxels in another file are not"},
        {"byte skip: -1\n", "raw", VN_IO, "line skip or byte skip"},
        {"space: left-posterior-superior-time\n", "raw", VN_IO, "space: "},
        {"dimension: 3\nspace directions: none (1,0,0) (0,1,0)\n", "raw", VN_IO, "space directions: "},
        {"dimension: 3\nspace directions: (1,0,0) (0,1,0)\n", "raw", VN_IO, "space directions: "},
        {"dimension: 3\nsizes: 1 1 4\ntype: uint8\nspace directions: (1,0,0) (0,1,0) (1,1,0)\n", "raw", VN_IO,
         "span no volume"},
        {"dimension: 3\nsizes: 1 1 4\ntype: uint8\nspacings: 1 nan 1\n", "raw", VN_IO, "spacings: "},
        {"dimension: 3\nsizes: 1 1 4\ntype: uint8\nspacings: 1 0 1\n", "raw", VN_IO, "span no volume"},
        {"what is this\n", "raw", VN_IO, "is no line \"key: value\" of an NRRD header"},
        {"dimension: 3\nsizes: 1 1 2\ntype: uint8\n", "ascii", VN_IO, "\"....\" is no number of its voxels"},
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        bytes b = nrrd_of(wrong[k].fields, wrong[k].encoding, "....", 4);
        refuses(".nrrd", &b, wrong[k].status, wrong[k].message);
    }
    bytes b = nrrd_of("dimension: 3\nsizes: 1 1 2\ntype: uint8\n", "ascii", "12 300", 6);
    refuses(".nrrd", &b, VN_IO, "voxel 1 is 300: its type holds whole numbers from 0 to 255");
}

// ---- DGtal's .vol ----

static bytes vol_of(int version, const char *more) {
    static const unsigned char data[12] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
    bytes b = {.count = 0};
    char header[256];
    snprintf(header, sizeof header, "X: 2\nY: 3\nZ: 2\nVoxel-Size: 1\nAlpha-Color: 0\nVersion: %d\n%s.\n",
             version, more);
    put_text(&b, header);
    if (version == 3) {
        put_packed(&b, data, 12, 15);
    } else {
        put(&b, data, 12);
    }
    return b;
}

static void vol_of_both_versions_is_read(void **state) {
    (void)state;
    static const double placed[3][4] = {{1, 0, 0, -141}, {0, 1, 0, 6}, {0, 0, 1, 0}};
    vn_volume volume;
    for (int version = 2; version <= 3; version++) {
        bytes b = vol_of(version, "Center-X: -141\nCenter-Y: 7\nCenter-Z: 0\n");
        assert_ok(try_read(&volume, ".vol", &b));
        check_voxels(&volume, counted, 12);
        check_place(&volume, placed);
        assert_near(volume.threshold, 128, 0);
        vn_volume_free(&volume);
        check_lies(".vol", &b);
    }
    bytes b = vol_of(4, "");
    refuses(".vol", &b, VN_IO, "Version: 4 is not read");
    b = vol_of(2, "Z: x\n");
    refuses(".vol", &b, VN_IO, "Z: \"x\" is no whole number");
    b = vol_of(2, "Z: 9e99\n");
    refuses(".vol", &b, VN_LIMIT, "beyond the limit");
    b.count = 0;
    put_text(&b, "X: 2\nY: 2\n.\n    ");
    refuses(".vol", &b, VN_IO, "its header has no Z");
    b.count = 0;
    put_text(&b, "\x89PNG\n");
    refuses(".vol", &b, VN_IO, "is no .vol file");
}

// ---- Images ----

static void pgm_of_every_kind_is_read(void **state) {
    (void)state;
    static const double placed[3][4] = {{1, 0, 0, 0.5}, {0, -1, 0, 1.5}, {0, 0, 1, 0}};
    static const double values[4] = {0, 100, 7, 200}, wide[4] = {0, 256, 1000, 1};
    static const char *const texts[] = {"P2\n# made by hand\n2 2\n200\n0 100 7\n200\n", "P5 2 2 200\n"};
    vn_volume volume;
    for (int k = 0; k < 2; k++) {
        bytes b = {.count = 0};
        put_text(&b, texts[k]);
        put(&b, "\0d\7\310", k == 1 ? 4 : 0);
        assert_ok(try_read(&volume, ".pgm", &b));
        check_voxels(&volume, values, 4);
        check_place(&volume, placed);
        assert_near(volume.white, 200, 0);
        vn_volume_free(&volume);
        if (k == 1) {
            check_lies(".pgm", &b);
        }
    }
    bytes b = {.count = 0};
    put_text(&b, "P5\n2 2 # here\n1000\n");
    put(&b, "\0\0\1\0\3\350\0\1", 8);
    assert_ok(try_read(&volume, ".pgm", &b));
    check_voxels(&volume, wide, 4);
    vn_volume_free(&volume);
}

static void what_pgm_says_is_checked(void **state) {
    (void)state;
    static const char *const wrong[][2] = {
        {"P6 1 1 255\n...", "neither P2 nor P5"},
        {"P2 0 1 255\n1", "its width is 0"},
        {"P2 1 -1 255\n1", "its height is -1"},
        {"P2 1 1 65536\n1", "its greatest value is 65536"},
        {"P2 1 1 255\n-1", "voxel 0 is -1"},
        {"P2 1 1 9\n10", "pixel 0 is 10, above the greatest value of its header, 9"},
        {"P2 1 2 255\n1", "more than its own bytes can hold"},
        {"P2 1 2 255\n1 ", "more than its own bytes can hold"},
        {"P2 1 2 255\n1  ", "it ends within its voxels"},
        {"P5 2000000000 1 255\n1", "more than its own bytes can hold"},
        {"P5 2", "it ends within its header"},
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        bytes b = {.count = 0};
        put_text(&b, wrong[k][0]);
        refuses(".pgm", &b, VN_IO, wrong[k][1]);
    }
}

static void put_png(void *to, png_bytep data, size_t count) {
    put(to, data, count);
}

static void write_png(png_structp png, png_bytep data, size_t count) {
    put_png(png_get_io_ptr(png), data, count);
}

static void flush_png(png_structp png) {
    (void)png;
}

static bytes png_of(int width, int height, int depth, int type, bool interlaced, unsigned char *rows,
                    size_t row_size) {
    bytes b = {.count = 0};
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_color palette[2] = {{255, 0, 0}, {255, 255, 255}};
    png_set_write_fn(png, &b, write_png, flush_png);
    png_set_IHDR(png, info, (png_uint_32)width, (png_uint_32)height, depth, type,
                 interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (type == PNG_COLOR_TYPE_PALETTE) {
        png_set_PLTE(png, info, palette, 2);
    }
    png_write_info(png, info);
    for (int pass = png_set_interlace_handling(png); pass > 0; pass--) {
        for (int y = 0; y < height; y++) {
            png_write_row(png, rows + (size_t)y * row_size);
        }
    }
    png_write_end(png, NULL);
    png_destroy_write_struct(&png, &info);
    return b;
}

static void png_of_every_kind_becomes_brightness(void **state) {
    (void)state;
    static unsigned char gray[] = {0, 50, 100, 255}, alpha[] = {200, 255, 200, 128, 200, 0, 10, 255},
                         color[] = {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255},
                         wide[] = {1, 0, 0, 2, 0xFF, 0xFF, 0, 3}, bit[] = {0x40, 0x80};
    static unsigned char rgba[] = {255, 255, 255, 51, 0, 0, 0, 255, 255, 0, 0, 255, 9, 9, 9, 255};
    static const struct {
        int depth, type;
        unsigned char *rows;
        size_t row_size;
        double values[4];
    } kinds[] = {
        {8, PNG_COLOR_TYPE_GRAY, gray, 2, {0, 50, 100, 255}},
        {8, PNG_COLOR_TYPE_GRAY_ALPHA, alpha, 4, {200, 100, 0, 10}},
        {8, PNG_COLOR_TYPE_RGB, color, 6, {54, 182, 18, 255}},
        {8, PNG_COLOR_TYPE_RGBA, rgba, 8, {51, 0, 54, 9}},
        {16, PNG_COLOR_TYPE_GRAY, wide, 4, {256, 2, 65535, 3}},
        {1, PNG_COLOR_TYPE_GRAY, bit, 1, {0, 255, 255, 0}},
        {1, PNG_COLOR_TYPE_PALETTE, bit, 1, {54, 255, 255, 54}},
    };
    vn_volume volume;
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        for (int interlaced = 0; interlaced < 2; interlaced++) {
            bytes b =
                png_of(2, 2, kinds[k].depth, kinds[k].type, interlaced, kinds[k].rows, kinds[k].row_size);
            assert_ok(try_read(&volume, ".png", &b));
            check_voxels(&volume, kinds[k].values, 4);
            assert_near(volume.white, kinds[k].depth == 16 ? 65535 : 255, 0);
            assert_near(volume.to_world[1][3], 1.5, 0);
            vn_volume_free(&volume);
            check_lies(".png", &b);
        }
    }
    bytes b = png_of(2, 2, 8, PNG_COLOR_TYPE_GRAY, false, gray, 2);
    static const unsigned char ihdr[] = {'I', 'H',  'D',  'R', 0, 0, 0x75, 0x30, 0,
                                         0,   0x75, 0x30, 8,   0, 0, 0,    0};
    memcpy(b.data + 12, ihdr, sizeof ihdr); // 30,000 x 30,000
    set_number(&b, 29, crc32(0, ihdr, sizeof ihdr), 4, true);
    refuses(".png", &b, VN_IO,
            "volume.png: its header claims 900000000 bytes of pixels, more than its own bytes can hold");
    b.count = 0;
    put_text(&b, "no picture at all");
    refuses(".png", &b, VN_IO, "volume.png: is broken: libpng says \"Not a PNG file\"");
}

static void missing_files_and_folders_are_named(void **state) {
    (void)state;
    vn_volume volume;
    vn_domain *domain;
    vn_image_def image = vn_image_def_default();
    vn_volume_def def = vn_volume_def_default();
    assert_int_equal(vn_volume_read(&volume, "no-such.nii"), VN_IO);
    assert_message("no-such.nii: cannot be read: No such file or directory");
    assert_int_equal(vn_domain_image(&domain, "liver.nii.gz", &image), VN_INVALID);
    assert_message("liver.nii.gz: an image is read from .png or .pgm (venule.domain.volume reads volumes)");
    assert_int_equal(vn_domain_volume(&domain, "mask.png", &def), VN_INVALID);
    assert_message(
        "mask.png: a volume is read from .nii, .nii.gz, .nrrd or .vol (venule.domain.image reads images)");
    def.component = 3;
    assert_int_equal(vn_domain_volume(&domain, "mask.nii", &def), VN_INVALID);
    assert_message("volume.component = 3 must be 0 (one), 1 (largest) or 2 (all)");
    image.threshold = NAN;
    assert_int_equal(vn_domain_image(&domain, "mask.png", &image), VN_INVALID);
}

static void files_lose_nothing_when_memory_runs_out(void **state) {
    (void)state;
    static unsigned char gray[] = {0, 50, 100, 255};
    bytes packed = {.count = 0}, plain = nifti_of(16, 4, false);
    put_packed(&packed, plain.data, plain.count, 31);
    bytes picture = png_of(2, 2, 8, PNG_COLOR_TYPE_GRAY, true, gray, 2);
    for (int k = 0; k < 2; k++) {
        const char *path = put_file(k ? ".png" : ".nii.gz", k ? &picture : &packed);
        vn_status status = VN_NO_MEMORY;
        for (int64_t nth = 0; status == VN_NO_MEMORY; nth++) {
            vn_volume volume;
            vn_fail_allocations_from(nth);
            status = vn_volume_read(&volume, path);
            vn_fail_allocations_from(-1);
            vn_volume_free(&volume);
            assert_true(nth < 1000);
        }
        assert_ok(status);
    }
}

// 108 x 92 x 97 voxels of 2 mm, as their surface has it; the only part of any size.
static void the_liver_is_as_large_as_its_surface(void **state) {
    (void)state;
    vn_domain *liver;
    vn_volume_def def = vn_volume_def_default();
    assert_ok(vn_domain_volume(&liver, VN_SOURCE_DIR "/tests/files/volumes/liver.nii.gz", &def));
    assert_near(vn_domain_measure(liver), 1741606, 0.005 * 1741606); // what the faces of the mesh enclose
    assert_near(vn_domain_measure(liver), 218736 * 8, 0);
    assert_string_equal(vn_domain_unit(liver), "mm");
    vn_box box = vn_domain_bounds(liver);
    static const double low[3] = {5, 5, 5}, high[3] = {209, 177, 187};
    for (int k = 0; k < 3; k++) {
        assert_near(box.min[k], low[k], 0);
        assert_near(box.max[k], high[k], 0);
    }
    vn_domain_release(liver);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(nifti_of_every_type_is_read),
        counted_test(nifti_is_placed_by_its_sform_then_its_qform),
        counted_test(what_nifti_says_is_checked),
        counted_test(a_broken_checksum_is_noticed),
        counted_test(bombs_do_not_go_off),
        counted_test(nrrd_of_every_encoding_is_read),
        counted_test(nrrd_of_every_type_is_read),
        counted_test(what_nrrd_says_is_checked),
        counted_test(vol_of_both_versions_is_read),
        counted_test(pgm_of_every_kind_is_read),
        counted_test(what_pgm_says_is_checked),
        counted_test(png_of_every_kind_becomes_brightness),
        counted_test(missing_files_and_folders_are_named),
        counted_test(files_lose_nothing_when_memory_runs_out),
        counted_test(the_liver_is_as_large_as_its_surface),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
