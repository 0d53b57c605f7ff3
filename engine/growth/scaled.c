// Blades that are the given shape, scaled about the origin: marginal growth scales it step by step, isogonic
// growth once.

#include "growth/growth.h"

#include "space/points.h"

static const vn_growth *growth_of(const vn_domain *domain) {
    return (const vn_growth *)domain;
}

void vn_growth_to_shape(const vn_growth *growth, double length, const double p[3], double q[3]) {
    double scale = length == growth->own_length ? 1 : growth->own_length / length;
    if (scale == 1) { // and no rounding: what is on a surface stays on it
        memcpy(q, p, 3 * sizeof *q);
        return;
    }
    for (int k = 0; k < 3; k++) {
        q[k] = k < growth->base.dim ? growth->origin[k] + (p[k] - growth->origin[k]) * scale : p[k];
    }
}

// A shape that is flat across y has a length of 0, and can only stay as it is.
static double scale_of(const vn_growth *growth) {
    return growth->drawn == growth->own_length ? 1 : growth->drawn / growth->own_length;
}

static void from_shape(const vn_growth *growth, const double p[3], double q[3]) {
    double scale = scale_of(growth);
    for (int k = 0; k < 3; k++) {
        bool stays = k >= growth->base.dim || scale == 1;
        q[k] = stays ? p[k] : growth->origin[k] + (p[k] - growth->origin[k]) * scale;
    }
}

void vn_growth_resize(vn_growth *growth, double drawn) {
    growth->drawn = drawn;
    double scale = scale_of(growth);
    int power = growth->shape->kind->snap != NULL ? 2 : growth->base.dim;
    growth->base.measure = growth->shape->measure * pow(scale, power);
    for (int k = 0; k < growth->base.dim; k++) {
        double origin = growth->origin[k];
        growth->base.bounds.min[k] = origin + (growth->shape->bounds.min[k] - origin) * scale;
        growth->base.bounds.max[k] = origin + (growth->shape->bounds.max[k] - origin) * scale;
    }
}

bool vn_scaled_contains(const vn_domain *domain, const double p[3]) {
    double q[3];
    vn_growth_to_shape(growth_of(domain), growth_of(domain)->drawn, p, q);
    return vn_domain_contains(growth_of(domain)->shape, q);
}

double vn_scaled_closest(const vn_domain *domain, const double p[3], double q[3]) {
    const vn_growth *growth = growth_of(domain);
    double in_shape[3], border[3];
    vn_growth_to_shape(growth, growth->drawn, p, in_shape);
    double d = growth->shape->kind->closest(growth->shape, in_shape, border);
    border[2] = domain->dim == 3 ? border[2] : p[2];
    from_shape(growth, border, q);
    return d * scale_of(growth);
}

double vn_scaled_value(const vn_domain *domain, const double p[3]) {
    double q[3];
    vn_growth_to_shape(growth_of(domain), growth_of(domain)->drawn, p, q);
    return vn_domain_value(growth_of(domain)->shape, q);
}

vn_status vn_scaled_triangles(const vn_domain *domain, vn_triangles *out) {
    VN_TRY(vn_domain_triangles(growth_of(domain)->shape, out));
    for (int32_t i = 0; i < out->xyz.count; i += 3) {
        double p[3];
        memcpy(p, out->xyz.data + i, sizeof p);
        from_shape(growth_of(domain), p, out->xyz.data + i);
    }
    return VN_OK;
}

vn_status vn_scaled_dart(const vn_domain *domain, vn_rng *rng, double p[3]) {
    double q[3];
    VN_TRY(vn_domain_dart(growth_of(domain)->shape, rng, q));
    from_shape(growth_of(domain), q, p);
    return VN_OK;
}

bool vn_scaled_snap(const vn_domain *domain, const double p[3], double q[3]) {
    const vn_growth *growth = growth_of(domain);
    double in_shape[3], on[3];
    vn_growth_to_shape(growth, growth->drawn, p, in_shape);
    bool found = growth->shape->kind->snap(growth->shape, in_shape, on);
    if (found) {
        from_shape(growth, on, q);
    }
    return found;
}

bool vn_scaled_sees(const vn_domain *domain, const double a[3], const double b[3]) {
    double qa[3], qb[3];
    vn_growth_to_shape(growth_of(domain), growth_of(domain)->drawn, a, qa);
    vn_growth_to_shape(growth_of(domain), growth_of(domain)->drawn, b, qb);
    return vn_domain_sees(growth_of(domain)->shape, qa, qb);
}

vn_status vn_scaled_outline(const vn_domain *domain, int32_t sides, vn_rings *out) {
    const vn_growth *growth = growth_of(domain);
    double scale = growth->drawn / growth->own_length;
    vn_rings rings = {0};
    vn_status status = vn_domain_outline(growth->shape, sides, &rings);
    for (int32_t i = 0; i < rings.x.count; i++) {
        rings.x.data[i] = growth->origin[0] + (rings.x.data[i] - growth->origin[0]) * scale;
        rings.y.data[i] = growth->origin[1] + (rings.y.data[i] - growth->origin[1]) * scale;
    }
    status = status == VN_OK ? vn_rings_append(out, &rings) : status;
    vn_rings_free(&rings);
    return status;
}
