#include "file/mask.h"

#include "domain/voxels.h"
#include "file/volume_reader.h"

#include <strings.h>

static const vn_image_def image_default = {.threshold = 0.5, .pixel = 1};
static const vn_volume_def volume_default = {.threshold = -VN_HUGE};

#define COMPONENT_ROW(def, sides)                                                                            \
    {                                                                                                        \
        "component", VN_CHOICE, 0, offsetof(def, component), 0, 0, "", "one|largest|all",                    \
            "what of a mask whose parts do not hang together by " sides                                      \
            ": nothing, unless the others are specks of a thousandth in all; the largest part; all"          \
    }

static const vn_field image_fields[] = {
    {"threshold", VN_F64, 0, offsetof(vn_image_def, threshold), 0, 1, "", NULL,
     "inside are pixels of this brightness or more: black is 0, white is 1"},
    {"invert", VN_BOOL, 0, offsetof(vn_image_def, invert), 0, 0, "", NULL,
     "inside are darker pixels instead, and values are those of the negative"},
    {"pixel", VN_F64, VN_ABOVE_MIN, offsetof(vn_image_def, pixel), 0, 1e30, "length", NULL,
     "the side of a pixel"},
    COMPONENT_ROW(vn_image_def, "sides of pixels"),
};
const vn_schema vn_image_schema =
    VN_SCHEMA("image", "What is bright in a picture", image_fields, image_default);

static const vn_field volume_fields[] = {
    {"threshold", VN_F64, VN_OPTIONAL, offsetof(vn_volume_def, threshold), -1e30, 1e30, "", NULL,
     "inside are voxels of this value or more; left out: 0.5, and 128 in a .vol"},
    {"invert", VN_BOOL, 0, offsetof(vn_volume_def, invert), 0, 0, "", NULL,
     "inside are voxels below it instead"},
    COMPONENT_ROW(vn_volume_def, "faces of voxels"),
};
const vn_schema vn_volume_schema =
    VN_SCHEMA("volume", "What is inside in a volume of voxels", volume_fields, volume_default);

vn_image_def vn_image_def_default(void) {
    return image_default;
}

vn_volume_def vn_volume_def_default(void) {
    return volume_default;
}

static bool ends_in(const char *path, const char *extension) {
    size_t length = strlen(path), tail = strlen(extension);
    return length > tail && strcasecmp(path + length - tail, extension) == 0;
}

static bool is_picture(const char *path) {
    return ends_in(path, ".png") || ends_in(path, ".pgm");
}

static vn_status check_component(const vn_schema *schema, int component) {
    if (component < VN_PARTS_ONE || component > VN_PARTS_ALL) {
        return vn_fail(VN_INVALID, "%s.component = %d must be 0 (one), 1 (largest) or 2 (all)", schema->name,
                       component);
    }
    return VN_OK;
}

vn_status vn_domain_image(vn_domain **out, const char *path, const vn_image_def *def) {
    *out = NULL;
    vn_volume volume;
    VN_TRY(vn_check_def(&vn_image_schema, def));
    VN_TRY(check_component(&vn_image_schema, def->component));
    if (!is_picture(path)) {
        return vn_fail(VN_INVALID,
                       "%s: an image is read from .png or .pgm (venule.domain.volume reads volumes)", path);
    }
    VN_TRY(vn_volume_read(&volume, path));
    for (int r = 0; r < 2; r++) {
        for (int c = 0; c < 4; c++) {
            volume.to_world[r][c] *= def->pixel;
        }
    }
    vn_mask mask = {.dim = 2,
                    .threshold = def->threshold,
                    .scale = volume.white,
                    .invert = def->invert,
                    .parts = (vn_parts)def->component,
                    .what = path};
    return vn_domain_voxels(out, &volume, &mask);
}

vn_status vn_domain_volume(vn_domain **out, const char *path, const vn_volume_def *def) {
    *out = NULL;
    vn_volume volume;
    VN_TRY(vn_check_def(&vn_volume_schema, def));
    VN_TRY(check_component(&vn_volume_schema, def->component));
    if (is_picture(path)) {
        return vn_fail(
            VN_INVALID,
            "%s: a volume is read from .nii, .nii.gz, .nrrd or .vol (venule.domain.image reads images)",
            path);
    }
    VN_TRY(vn_volume_read(&volume, path));
    bool given = def->threshold != volume_default.threshold;
    vn_mask mask = {.dim = 3,
                    .threshold = given ? def->threshold : volume.threshold,
                    .scale = 1,
                    .invert = def->invert,
                    .parts = (vn_parts)def->component,
                    .what = path};
    return vn_domain_voxels(out, &volume, &mask);
}
