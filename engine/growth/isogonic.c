// Isogonic growth (Runions et al. 2005, section 3.3; READINGS R7): the blade stays and the unit shrinks.

#include "growth/growth.h"

static const vn_growth_def isogonic_default = {0};

static const vn_field isogonic_fields[] = {
    {"domain", VN_OBJECT, VN_REQUIRED, offsetof(vn_growth_def, domain), 0, 0, "", "domain",
     "the shape of the blade, at any size"},
    {"origin", VN_POINT, VN_OPTIONAL, offsetof(vn_growth_def, origin), -VN_HUGE, VN_HUGE, "length", NULL,
     "the petiole, about which the shape is scaled to `from`; left out: the lowest point of the outline, or "
     "in 3D the middle of the bottom (least y) of its bounds"},
    VN_GROWTH_LENGTH_ROW("from", from,
                         "the blade's length at first, and that of its shape in the simulation; left "
                         "out: a twentieth of `to`"),
    VN_GROWTH_TO,
    VN_GROWTH_STEP,
    {"split", VN_F64, 0, offsetof(vn_growth_def, split), 0, 1e150, "length", NULL,
     "edges longer than this times the unit are split; 0: none, older edges stretch"},
};
const vn_schema vn_isogonic_schema =
    VN_SCHEMA("isogonic", "A blade that grows alike everywhere: the unit length shrinks (Runions §3.3)",
              isogonic_fields, isogonic_default);

static vn_status isogonic_step(vn_growth *growth, int32_t time) {
    growth->length = fmin(growth->from + time * growth->step, growth->to);
    growth->unit = growth->from / growth->length;
    return VN_OK;
}

static const vn_growth_kind isogonic_kind = {.name = "isogonic",
                                             .size = sizeof(vn_growth),
                                             .domain = {.name = "blade",
                                                        .destroy = vn_growth_destroy,
                                                        .contains = vn_scaled_contains,
                                                        .closest = vn_scaled_closest,
                                                        .sees = vn_scaled_sees,
                                                        .outline = vn_scaled_outline,
                                                        .triangles = vn_scaled_triangles,
                                                        .value = vn_scaled_value,
                                                        .is_grown = vn_growth_is_grown_domain},
                                             .step = isogonic_step};

static const vn_growth_kind isogonic_surface_kind = {.name = "isogonic",
                                                     .size = sizeof(vn_growth),
                                                     .domain = {.name = "blade",
                                                                .destroy = vn_growth_destroy,
                                                                .contains = vn_scaled_contains,
                                                                .closest = vn_scaled_closest,
                                                                .sees = vn_scaled_sees,
                                                                .dart = vn_scaled_dart,
                                                                .snap = vn_scaled_snap,
                                                                .triangles = vn_scaled_triangles,
                                                                .is_grown = vn_growth_is_grown_domain},
                                                     .step = isogonic_step};

vn_status vn_growth_isogonic(vn_growth **out, const vn_growth_def *def) {
    *out = NULL;
    VN_TRY(vn_check_def(&vn_isogonic_schema, def));
    vn_growth_base base = {def->domain, def->has_origin ? def->origin : NULL, def->split};
    vn_growth *growth;
    bool is_surface = def->domain->kind->snap != NULL;
    VN_TRY(vn_growth_make(&growth, is_surface ? &isogonic_surface_kind : &isogonic_kind, &base));
    vn_status status = vn_growth_set_lengths(growth, def);
    if (status != VN_OK) {
        vn_growth_release(growth);
        return status;
    }
    bool rescaled = fabs(growth->from - growth->own_length) > 1e-9 * growth->own_length;
    if (rescaled) {
        growth->base.unit[0] = '\0'; // coordinates are no longer those of the file
    }
    vn_growth_resize(growth, growth->from);
    *out = growth;
    return VN_OK;
}
