#include "domain/domain.h"

static const vn_profile_def profile_default = {.length = 1, .samples = 200};

static const vn_field profile_fields[] = {
    {"length", VN_F64, VN_ABOVE_MIN, offsetof(vn_profile_def, length), 0, 1e150, "length", NULL,
     "from the base at (0, 0) to the tip at (0, length)"},
    {"samples", VN_I32, 0, offsetof(vn_profile_def, samples), 3, 1000000, "points", NULL,
     "how many points of a half_width function are taken (a table is taken as it is)"},
    {"half_width", VN_MIXED, VN_REQUIRED, 0, 0, 0, "length",
     "function(t) with t from 0 (base) to 1 (tip), or a table of numbers from base to tip",
     "half the blade's width along its midrib; 0 or more"},
};
const vn_schema vn_profile_schema =
    VN_SCHEMA("profile", "A leaf blade by its half width along the midrib", profile_fields, profile_default);

vn_profile_def vn_profile_def_default(void) {
    return profile_default;
}

static vn_status add_side(vn_rings *rings, const vn_profile_def *def, int side) {
    int32_t last = def->samples - 1;
    for (int32_t k = 0; k <= last; k++) {
        int32_t i = side > 0 ? k : last - k; // up on the right, down on the left
        bool on_midrib = def->half_width[i] == 0 && side < 0;
        if (on_midrib) {
            continue; // the right side has this point already
        }
        double y = def->length * i / last;
        VN_TRY(vn_rings_point(rings, side * def->half_width[i], y));
    }
    return VN_OK;
}

static vn_status check_widths(const vn_profile_def *def) {
    VN_TRY(vn_check_number(&vn_profile_schema, vn_find_field(&vn_profile_schema, "length"), def->length));
    if (def->samples < 3) {
        return vn_fail(VN_INVALID, "profile.half_width has %d samples; a blade needs 3 or more",
                       def->samples);
    }
    for (int32_t i = 0; i < def->samples; i++) {
        double w = def->half_width[i];
        if (!(w >= 0 && w <= 1e150)) {
            return vn_fail(VN_INVALID, "profile.half_width = %g at t = %g must be 0 or more, and finite", w,
                           (double)i / (def->samples - 1));
        }
        if (w == 0 && i > 0 && i < def->samples - 1) {
            return vn_fail(VN_INVALID,
                           "profile.half_width = 0 at t = %g: a blade may be closed at its ends only",
                           (double)i / (def->samples - 1));
        }
    }
    return VN_OK;
}

vn_status vn_domain_profile(vn_domain **out, const vn_profile_def *def) {
    *out = NULL;
    VN_TRY(check_widths(def));
    vn_rings rings = {0};
    vn_status status = add_side(&rings, def, 1);
    status = status == VN_OK ? add_side(&rings, def, -1) : status;
    status = status == VN_OK ? vn_rings_close(&rings) : status;
    status = status == VN_OK ? vn_domain_from_rings(out, &rings, "") : status;
    vn_rings_free(&rings);
    return status;
}
