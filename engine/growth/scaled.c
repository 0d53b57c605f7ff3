// Blades that are the given shape, scaled about the origin: marginal growth scales it step by step, isogonic
// growth once.

#include "growth/growth.h"

#include "space/points.h"

static const vn_growth *growth_of(const vn_domain *domain) {
    return (const vn_growth *)domain;
}

void vn_growth_to_shape(const vn_growth *growth, double length, const double p[3], double q[3]) {
    double scale = growth->own_length / length;
    for (int k = 0; k < 3; k++) {
        q[k] = k < growth->base.dim ? growth->origin[k] + (p[k] - growth->origin[k]) * scale : p[k];
    }
}

void vn_growth_resize(vn_growth *growth, double drawn) {
    double scale = drawn / growth->own_length;
    growth->drawn = drawn;
    growth->base.measure = growth->shape->measure * pow(scale, growth->base.dim);
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
    double scale = growth->drawn / growth->own_length;
    double in_shape[3], border[3];
    vn_growth_to_shape(growth, growth->drawn, p, in_shape);
    double d = growth->shape->kind->closest(growth->shape, in_shape, border);
    for (int k = 0; k < 3; k++) {
        q[k] = k < domain->dim ? growth->origin[k] + (border[k] - growth->origin[k]) * scale : p[k];
    }
    return d * scale;
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
