#include "growth/growth.h"

#include "space/points.h"

static const vn_growth_def growth_default = {0};

static const vn_field none_fields[] = {
    {"domain", VN_OBJECT, VN_REQUIRED, offsetof(vn_growth_def, domain), 0, 0, "", "domain",
     "the shape, which stays as it is"},
};
const vn_schema vn_none_schema =
    VN_SCHEMA("none", "A domain that does not grow", none_fields, growth_default);

vn_growth_def vn_growth_def_default(void) {
    return growth_default;
}

void vn_growth_to_shape(const vn_growth *growth, double length, const double p[3], double q[3]) {
    double scale = growth->own_length / length;
    for (int k = 0; k < 3; k++) {
        q[k] = k < growth->base.dim ? growth->origin[k] + (p[k] - growth->origin[k]) * scale : p[k];
    }
}

void vn_growth_resize(vn_growth *growth, double length) {
    double scale = length / growth->own_length;
    growth->length = length;
    growth->base.measure = growth->shape->measure * pow(scale, growth->base.dim);
    for (int k = 0; k < growth->base.dim; k++) {
        double origin = growth->origin[k];
        growth->base.bounds.min[k] = origin + (growth->shape->bounds.min[k] - origin) * scale;
        growth->base.bounds.max[k] = origin + (growth->shape->bounds.max[k] - origin) * scale;
    }
}

void vn_growth_destroy(vn_domain *domain) {
    vn_domain_release(((vn_growth *)domain)->shape);
}

// The lowest point; of a flat base, its middle.
static void lowest_point(const vn_rings *rings, double origin[3]) {
    double lowest = INFINITY, left = 0, right = 0;
    for (int32_t i = 0; i < rings->y.count; i++) {
        double x = rings->x.data[i], y = rings->y.data[i];
        left = y < lowest ? x : (y == lowest ? fmin(left, x) : left);
        right = y < lowest ? x : (y == lowest ? fmax(right, x) : right);
        lowest = fmin(lowest, y);
    }
    origin[0] = 0.5 * (left + right);
    origin[1] = lowest;
}

static vn_status find_origin(vn_growth *growth, const vn_growth_def *def) {
    if (def->has_origin) {
        if (!vn_finite(def->origin)) {
            return vn_fail(VN_INVALID, "marginal.origin must be finite");
        }
        memcpy(growth->origin, def->origin, sizeof growth->origin);
        return VN_OK;
    }
    vn_rings rings = {0};
    vn_status status =
        growth->base.dim == 2 ? vn_domain_outline(growth->shape, VN_FINE_SIDES, &rings) : VN_OK;
    if (rings.y.count > 0) {
        lowest_point(&rings, growth->origin);
    }
    vn_rings_free(&rings);
    return status;
}

vn_status vn_growth_make(vn_growth **out, const vn_domain_kind *kind, const vn_growth_def *def) {
    *out = NULL;
    if (def->domain->kind->margin != NULL) {
        return vn_fail(VN_INVALID, "a growth of a growing domain: give the shape itself");
    }
    vn_growth *growth = vn_domain_new(kind, sizeof *growth, def->domain->dim);
    if (growth == NULL) {
        return vn_fail_memory("a growth", sizeof *growth);
    }
    growth->shape = vn_domain_retain(def->domain);
    growth->own_length = def->domain->bounds.max[1] - def->domain->bounds.min[1];
    memcpy(growth->base.unit, def->domain->unit, sizeof growth->base.unit);
    growth->from = growth->to = growth->own_length;
    vn_status status = find_origin(growth, def);
    if (status != VN_OK) {
        vn_growth_release(growth);
        return status;
    }
    vn_growth_resize(growth, growth->own_length);
    *out = growth;
    return VN_OK;
}

static bool still_contains(const vn_domain *domain, const double p[3]) {
    return vn_domain_contains(((const vn_growth *)domain)->shape, p);
}

static double still_closest(const vn_domain *domain, const double p[3], double q[3]) {
    const vn_domain *shape = ((const vn_growth *)domain)->shape;
    return shape->kind->closest(shape, p, q);
}

static bool still_sees(const vn_domain *domain, const double a[3], const double b[3]) {
    return vn_domain_sees(((const vn_growth *)domain)->shape, a, b);
}

static vn_status still_outline(const vn_domain *domain, int32_t sides, vn_rings *out) {
    return vn_domain_outline(((const vn_growth *)domain)->shape, sides, out);
}

static const vn_domain_kind still_kind = {.name = "blade",
                                          .destroy = vn_growth_destroy,
                                          .contains = still_contains,
                                          .closest = still_closest,
                                          .sees = still_sees,
                                          .outline = still_outline};

vn_status vn_growth_none(vn_growth **out, const vn_growth_def *def) {
    *out = NULL;
    VN_TRY(vn_check_def(&vn_none_schema, def));
    return vn_growth_make(out, &still_kind, def);
}

void vn_growth_release(vn_growth *growth) {
    if (growth != NULL) {
        vn_domain_release(&growth->base);
    }
}

bool vn_growth_advance(vn_growth *growth) {
    if (growth->length >= growth->to) {
        return false;
    }
    growth->time++;
    vn_growth_resize(growth, fmin(growth->from + growth->time * growth->step, growth->to));
    return true;
}

vn_domain *vn_growth_domain(vn_growth *growth) {
    return &growth->base;
}

int32_t vn_growth_time(const vn_growth *growth) {
    return growth->time;
}

double vn_growth_length(const vn_growth *growth) {
    return growth->length;
}

double vn_growth_final_length(const vn_growth *growth) {
    return growth->to;
}

double vn_growth_unit(const vn_growth *growth) {
    (void)growth;
    return 1;
}

void vn_growth_origin(const vn_growth *growth, double p[3]) {
    memcpy(p, growth->origin, sizeof growth->origin);
}
