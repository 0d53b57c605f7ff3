// DGtal's .vol: a header of lines "Key: value", ended by a line with a dot; then a byte for each voxel, in
// version 3 packed by zlib.

#include "file/volume_reader.h"

#include "base/memory.h"
#include "base/text.h"

#include <math.h>
#include <stdio.h>

typedef struct vol {
    double value[7]; ///< in the order of `keys`
    bool given[7];
} vol;

static const char *const keys[7] = {"X", "Y", "Z", "Center-X", "Center-Y", "Center-Z", "Version"};
enum { CENTER = 3, VERSION = 6 };

static vn_status read_key(vol *v, const char *line, const char *path) {
    const char *colon = strchr(line, ':');
    if (colon == NULL) {
        return vn_fail(VN_IO, "%s: is no .vol file: \"%.40s\" is no line \"Key: value\" of a header", path,
                       line);
    }
    for (int k = 0; k < 7; k++) {
        if (strlen(keys[k]) == (size_t)(colon - line) && memcmp(keys[k], line, strlen(keys[k])) == 0) {
            const char *text = colon + 1 + strspn(colon + 1, " \t"), *end = text + strcspn(text, " \t");
            if (vn_parse_number(text, end, &v->value[k]) != end || v->value[k] != floor(v->value[k])) {
                return vn_fail(VN_IO, "%s: %s: \"%.40s\" is no whole number", path, keys[k], text);
            }
            v->given[k] = true;
        }
    }
    return VN_OK;
}

static vn_status read_header(vol *v, vn_bytes *bytes) {
    char line[128];
    VN_TRY(vn_bytes_line(bytes, line, sizeof line));
    while (strcmp(line, ".") != 0) {
        VN_TRY(read_key(v, line, vn_bytes_path(bytes)));
        VN_TRY(vn_bytes_line(bytes, line, sizeof line));
    }
    for (int k = 0; k < 3; k++) {
        if (!v->given[k]) {
            return vn_fail(VN_IO, "%s: its header has no %s", vn_bytes_path(bytes), keys[k]);
        }
    }
    bool known = !v->given[VERSION] || v->value[VERSION] == 2 || v->value[VERSION] == 3;
    return known ? VN_OK
                 : vn_fail(VN_IO, "%s: Version: %g is not read: 2 and 3 are", vn_bytes_path(bytes),
                           v->value[VERSION]);
}

// A voxel is 1 wide, whatever else the header says; its own Voxel-Size counts bytes.
vn_status vn_vol_read(vn_volume *volume, vn_bytes *bytes) {
    vol v = {{0}, {0}};
    vn_volume_head head = vn_volume_head_default();
    VN_TRY(read_header(&v, bytes));
    for (int k = 0; k < 3; k++) {
        head.size[k] = v.value[k];
        if (v.given[CENTER + k]) {
            head.to_world[k][3] = v.value[CENTER + k] - trunc((v.value[k] - 1) / 2);
        }
    }
    head.white = 255;
    head.threshold = 128;
    if (v.value[VERSION] == 3) {
        VN_TRY(vn_bytes_unpack(bytes));
    }
    return vn_volume_take(volume, bytes, &head);
}
