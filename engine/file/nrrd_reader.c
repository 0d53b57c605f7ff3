// NRRD with its voxels in the same file: a header of lines "key: value", ended by an empty line; then the
// voxels.

#include "file/volume_reader.h"

#include "base/memory.h"
#include "base/text.h"

#include <math.h>
#include <stdio.h>

enum { RAW, GZIP, TEXT };

typedef struct nrrd {
    const char *path;
    vn_volume_head head;
    int axes;     ///< 0: not given yet
    int encoding; ///< of the enumeration above; -1: not given
    int sizes;    ///< how many were given
    bool has_type, has_endian, has_directions;
    double mirror[3]; ///< -1 where the file's space goes the other way than right, anterior, superior
} nrrd;

static const char *skip_spaces(const char *text) {
    return text + strspn(text, " \t");
}

static bool is_one_of(const char *word, const char *const *names) {
    while (*names != NULL && strcmp(*names, word) != 0) {
        names++;
    }
    return *names != NULL;
}

static vn_status fail_value(const nrrd *n, const char *key, const char *text, const char *wanted) {
    return vn_fail(VN_IO, "%s: %s: \"%.60s\" is not read: %s", n->path, key, text, wanted);
}

/// Up to @p count numbers, parted by white space or, in "(x,y,z)", by commas; returns what follows, or NULL.
static const char *read_numbers(const char *text, char parting, int count, double *values) {
    for (int k = 0; k < count; k++) {
        text = skip_spaces(text);
        if (parting == ',' && *text++ != (k == 0 ? '(' : ',')) {
            return NULL;
        }
        text = skip_spaces(text);
        text = vn_parse_number(text, text + strlen(text), &values[k]);
        if (text == NULL) {
            return NULL;
        }
    }
    text = skip_spaces(text);
    if (parting == ',') {
        return *text == ')' ? text + 1 : NULL;
    }
    return text;
}

static vn_status set_dimension(nrrd *n, const char *text) {
    if (strcmp(text, "2") != 0 && strcmp(text, "3") != 0) {
        return fail_value(n, "dimension", text,
                          "volumes of 2 or 3 dimensions are; save one of several, without colors");
    }
    n->axes = text[0] - '0';
    return VN_OK;
}

static vn_status set_sizes(nrrd *n, const char *text) {
    const char *rest = n->axes > 0 ? read_numbers(text, ' ', n->axes, n->head.size) : NULL;
    n->sizes = n->axes;
    return rest != NULL && *rest == '\0'
               ? VN_OK
               : fail_value(n, "sizes", text, "a number for each dimension is needed");
}

static vn_status set_type(nrrd *n, const char *text) {
    static const char *const names[][9] = {
        {"signed char", "int8", "int8_t", NULL},
        {"uchar", "unsigned char", "uint8", "uint8_t", NULL},
        {"short", "short int", "signed short", "signed short int", "int16", "int16_t", NULL},
        {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t", NULL},
        {"int", "signed int", "int32", "int32_t", NULL},
        {"uint", "unsigned int", "uint32", "uint32_t", NULL},
        {"float", NULL},
        {"double", NULL},
    };
    for (int scalar = VN_SCALAR_I8; scalar <= VN_SCALAR_F64; scalar++) {
        if (is_one_of(text, names[scalar])) {
            n->head.scalar = (vn_scalar)scalar;
            n->has_type = true;
            return VN_OK;
        }
    }
    return fail_value(n, "type", text, "whole numbers of 8, 16 or 32 bits, float and double are");
}

static vn_status set_encoding(nrrd *n, const char *text) {
    static const char *const names[][4] = {
        {"raw", NULL}, {"gzip", "gz", NULL}, {"ascii", "text", "txt", NULL}};
    for (int k = RAW; k <= TEXT; k++) {
        n->encoding = is_one_of(text, names[k]) ? k : n->encoding;
    }
    n->head.text = n->encoding == TEXT;
    return n->encoding >= 0 ? VN_OK : fail_value(n, "encoding", text, "raw, gzip and ascii are");
}

static vn_status set_endian(nrrd *n, const char *text) {
    n->head.big_endian = strcmp(text, "big") == 0;
    n->has_endian = true;
    return n->head.big_endian || strcmp(text, "little") == 0
               ? VN_OK
               : fail_value(n, "endian", text, "little and big are");
}

// Patients are looked at from either side. NIfTI's way is taken: right, anterior and superior are positive.
static vn_status set_space(nrrd *n, const char *text) {
    static const char *const lps[] = {"left-posterior-superior", "LPS", NULL};
    static const char *const las[] = {"left-anterior-superior", "LAS", NULL};
    static const char *const same[] = {"right-anterior-superior", "RAS", "scanner-xyz", "3D-right-handed",
                                       "3D-left-handed",          NULL};
    n->mirror[0] = is_one_of(text, lps) || is_one_of(text, las) ? -1 : 1;
    n->mirror[1] = is_one_of(text, lps) ? -1 : 1;
    bool known = n->mirror[0] < 0 || is_one_of(text, same);
    return known ? VN_OK : fail_value(n, "space", text, "spaces of three dimensions without time are");
}

// A flat one in space has two directions of three components.
static vn_status set_directions(nrrd *n, const char *text) {
    const char *at = text;
    double direction[3][3] = {{0}};
    int components = 1;
    for (const char *c = text; *c != '\0' && *c != ')'; c++) {
        components += *c == ',';
    }
    for (int a = 0; a < n->axes; a++) {
        at = components == 2 || components == 3 ? read_numbers(at, ',', components, direction[a]) : NULL;
        if (at == NULL) {
            return fail_value(n, "space directions", text, "a vector (x,y,z) for each dimension is needed");
        }
    }
    if (n->axes == 2) { // the third at a right angle to both, of the length of the first
        const double *p = direction[0], *q = direction[1];
        double across[3] = {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
        double length = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        double area = sqrt(across[0] * across[0] + across[1] * across[1] + across[2] * across[2]);
        for (int r = 0; r < 3; r++) {
            direction[2][r] = across[r] / area * length;
        }
    }
    for (int a = 0; a < 3; a++) {
        for (int r = 0; r < 3; r++) {
            n->head.to_world[r][a] = direction[a][r];
        }
    }
    n->has_directions = true;
    return VN_OK;
}

static vn_status set_origin(nrrd *n, const char *text) {
    double origin[3] = {0};
    if (read_numbers(text, ',', 3, origin) == NULL && read_numbers(text, ',', 2, origin) == NULL) {
        return fail_value(n, "space origin", text, "a point (x,y,z) is needed");
    }
    for (int r = 0; r < 3; r++) {
        n->head.to_world[r][3] = origin[r];
    }
    return VN_OK;
}

static vn_status set_spacings(nrrd *n, const char *text) {
    double spacing[3] = {1, 1, 1};
    if (n->axes == 0 || read_numbers(text, ' ', n->axes, spacing) == NULL) {
        return fail_value(n, "spacings", text, "a number for each dimension is needed");
    }
    for (int a = 0; a < 3 && !n->has_directions; a++) {
        n->head.to_world[a][a] = spacing[a];
    }
    return VN_OK;
}

// One name for all axes, or none that is known.
static vn_status set_units(nrrd *n, const char *text) {
    static const struct {
        const char *name, *unit;
    } units[] = {{"\"mm\"", "mm"},      {"\"millimeter\"", "mm"}, {"\"millimeters\"", "mm"},
                 {"\"um\"", "um"},      {"\"\302\265m\"", "um"},  {"\"\316\274m\"", "um"},
                 {"\"microns\"", "um"}, {"\"micrometer\"", "um"}, {"\"m\"", "m"}};
    size_t length = strcspn(text, " \t");
    for (const char *at = text; *at != '\0'; at = skip_spaces(at + length)) {
        if (strncmp(at, text, length) != 0) {
            return VN_OK;
        }
    }
    for (size_t k = 0; k < sizeof units / sizeof *units; k++) {
        if (strlen(units[k].name) == length && memcmp(units[k].name, text, length) == 0) {
            snprintf(n->head.unit, sizeof n->head.unit, "%s", units[k].unit);
        }
    }
    return VN_OK;
}

static vn_status refuse_file(nrrd *n, const char *text) {
    return fail_value(n, "data file", text,
                      "voxels in another file are not; save header and voxels in one .nrrd");
}

static vn_status refuse_skip(nrrd *n, const char *text) {
    return strcmp(text, "0") == 0 ? VN_OK : fail_value(n, "line skip or byte skip", text, "only 0 is");
}

static const struct {
    const char *key;
    vn_status (*set)(nrrd *n, const char *text);
} fields[] = {
    {"dimension", set_dimension}, {"sizes", set_sizes},
    {"type", set_type},           {"encoding", set_encoding},
    {"endian", set_endian},       {"space", set_space},
    {"spacings", set_spacings},   {"space directions", set_directions},
    {"space origin", set_origin}, {"space units", set_units},
    {"units", set_units},         {"data file", refuse_file},
    {"datafile", refuse_file},    {"line skip", refuse_skip},
    {"lineskip", refuse_skip},    {"byte skip", refuse_skip},
    {"byteskip", refuse_skip},
};

// "key: value" is a field; "key:=value" is somebody's own, and so is what has another name.
static vn_status read_field(nrrd *n, char *line) {
    char *colon = strchr(line, ':');
    if (line[0] == '#' || (colon != NULL && colon[1] == '=')) {
        return VN_OK;
    }
    if (colon == NULL) {
        return vn_fail(VN_IO, "%s: \"%.60s\" is no line \"key: value\" of an NRRD header", n->path, line);
    }
    *colon = '\0';
    char *text = colon + 1 + strspn(colon + 1, " \t"), *end = text + strlen(text);
    while (end > text && (end[-1] == ' ' || end[-1] == '\t')) {
        *--end = '\0';
    }
    for (size_t k = 0; k < sizeof fields / sizeof *fields; k++) {
        if (strcmp(fields[k].key, line) == 0) {
            return fields[k].set(n, text);
        }
    }
    return VN_OK;
}

static vn_status read_header(nrrd *n, vn_bytes *bytes) {
    char line[1024];
    VN_TRY(vn_bytes_line(bytes, line, sizeof line));
    if (strncmp(line, "NRRD000", 7) != 0) {
        return vn_fail(VN_IO, "%s: is no NRRD file: it does not begin with NRRD000", n->path);
    }
    VN_TRY(vn_bytes_line(bytes, line, sizeof line));
    while (line[0] != '\0') {
        VN_TRY(read_field(n, line));
        VN_TRY(vn_bytes_line(bytes, line, sizeof line));
    }
    const char *missing = n->axes == 0          ? "dimension"
                          : n->sizes != n->axes ? "sizes"
                          : !n->has_type        ? "type"
                          : n->encoding < 0     ? "encoding"
                                                : NULL;
    bool one_byte = n->head.scalar == VN_SCALAR_I8 || n->head.scalar == VN_SCALAR_U8;
    if (missing == NULL && !n->has_endian && !one_byte && n->encoding != TEXT) {
        missing = "endian";
    }
    return missing == NULL ? VN_OK : vn_fail(VN_IO, "%s: its header has no \"%s\"", n->path, missing);
}

vn_status vn_nrrd_read(vn_volume *volume, vn_bytes *bytes) {
    nrrd n = {
        .path = vn_bytes_path(bytes), .head = vn_volume_head_default(), .encoding = -1, .mirror = {1, 1, 1}};
    VN_TRY(read_header(&n, bytes));
    for (int r = 0; r < 2; r++) {
        for (int c = 0; c < 4; c++) {
            n.head.to_world[r][c] *= n.mirror[r];
        }
    }
    if (n.encoding == GZIP) {
        VN_TRY(vn_bytes_unpack(bytes));
    }
    return vn_volume_take(volume, bytes, &n.head);
}
