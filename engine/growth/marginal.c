// Marginal growth (Runions et al. 2005, section 3.3): the margin is scaled about the petiole, the tissue
// stays.

#include "growth/growth.h"

#include "space/points.h"
#include "space/segment_grid.h"

static const vn_growth_def marginal_default = {0};

static const vn_field marginal_fields[] = {
    {"domain", VN_OBJECT, VN_REQUIRED, offsetof(vn_growth_def, domain), 0, 0, "", "domain",
     "the shape of the blade"},
    {"origin", VN_POINT, VN_OPTIONAL, offsetof(vn_growth_def, origin), -VN_HUGE, VN_HUGE, "length", NULL,
     "the petiole, about which the margin is scaled; left out: the lowest point of the outline"},
    VN_GROWTH_LENGTH_ROW("from", from, "the blade's length at first; left out: a twentieth of `to`"),
    VN_GROWTH_TO,
    VN_GROWTH_STEP,
};
const vn_schema vn_marginal_schema = VN_SCHEMA(
    "marginal", "A blade of which only the margin moves (Runions §3.3)", marginal_fields, marginal_default);

static const vn_growth *growth_of(const vn_domain *domain) {
    return (const vn_growth *)domain;
}

// Star-shaped, so a point once inside stays inside: the moment is found by halving.
static double marginal_arrival(const vn_domain *domain, const double p[3]) {
    const vn_growth *growth = growth_of(domain);
    double q[3];
    double low = 0, high = growth->to;
    vn_growth_to_shape(growth, high, p, q);
    if (!vn_domain_contains(growth->shape, q)) {
        return INFINITY;
    }
    for (int i = 0; i < 50; i++) {
        double middle = 0.5 * (low + high);
        vn_growth_to_shape(growth, middle, p, q);
        if (vn_domain_contains(growth->shape, q)) {
            high = middle;
        } else {
            low = middle;
        }
    }
    return high;
}

static double marginal_length(const vn_domain *domain) {
    return growth_of(domain)->length;
}

static void marginal_grown(const vn_domain *domain, vn_box *bounds, double *measure) {
    vn_growth grown = *growth_of(domain);
    vn_growth_resize(&grown, grown.to);
    *bounds = grown.base.bounds;
    *measure = grown.base.measure;
}

static vn_status marginal_step(vn_growth *growth, int32_t time) {
    growth->length = fmin(growth->from + time * growth->step, growth->to);
    vn_growth_resize(growth, growth->length);
    return VN_OK;
}

static const vn_margin marginal_margin = {marginal_arrival, marginal_length, marginal_grown};

static const vn_growth_kind marginal_kind = {.name = "marginal",
                                             .size = sizeof(vn_growth),
                                             .domain = {.name = "blade",
                                                        .destroy = vn_growth_destroy,
                                                        .contains = vn_scaled_contains,
                                                        .closest = vn_scaled_closest,
                                                        .sees = vn_scaled_sees,
                                                        .outline = vn_scaled_outline,
                                                        .value = vn_scaled_value,
                                                        .margin = &marginal_margin,
                                                        .is_grown = vn_growth_is_grown_domain},
                                             .step = marginal_step};

// Every edge must turn left as seen from the origin. An edge whose line passes the origin on the wrong side
// by less than a millionth of the blade is the rounding of whoever drew it.
static vn_status check_star(const vn_growth *growth, const vn_rings *rings) {
    double tolerance = 1e-6 * growth->own_length;
    const double *o = growth->origin;
    for (int32_t r = 0; r < rings->ends.count; r++) {
        int32_t begin = vn_rings_begin(rings, r), end = rings->ends.data[r];
        for (int32_t i = begin; i < end; i++) {
            int32_t j = i + 1 < end ? i + 1 : begin;
            const double *x = rings->x.data, *y = rings->y.data;
            if (vn_turn(o[0], o[1], x[i], y[i], x[j], y[j]) < -tolerance * hypot(x[j] - x[i], y[j] - y[i])) {
                return vn_fail(
                    VN_INVALID,
                    "marginal: the blade is not star-shaped about its origin (%g, %g), so growth would erode "
                    "it near (%g, %g): name another `origin`, one that sees the whole margin",
                    o[0], o[1], x[i], y[i]);
            }
        }
    }
    return VN_OK;
}

static vn_status check_outline(const vn_growth *growth) {
    vn_rings rings = {0};
    vn_status status = vn_domain_outline(growth->shape, VN_FINE_SIDES, &rings);
    status = status == VN_OK ? check_star(growth, &rings) : status;
    vn_rings_free(&rings);
    return status;
}

vn_status vn_growth_marginal(vn_growth **out, const vn_growth_def *def) {
    *out = NULL;
    VN_TRY(vn_check_def(&vn_marginal_schema, def));
    vn_growth_base base = {def->domain, def->has_origin ? def->origin : NULL, 0};
    vn_growth *growth;
    VN_TRY(vn_growth_make(&growth, &marginal_kind, &base));
    vn_status status = vn_growth_set_lengths(growth, def);
    status = status == VN_OK ? check_outline(growth) : status;
    if (status != VN_OK) {
        vn_growth_release(growth);
        return status;
    }
    bool rescaled = fabs(growth->to - growth->own_length) > 1e-9 * growth->own_length;
    if (rescaled) {
        growth->base.unit[0] = '\0'; // lengths are the script's own from here on, no longer those of the file
    }
    vn_growth_resize(growth, growth->from);
    *out = growth;
    return VN_OK;
}
