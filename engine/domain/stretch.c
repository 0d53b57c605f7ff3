#include "domain/stretch.h"

typedef struct stretched {
    vn_domain base;
    vn_domain *shape;
    vn_stretch stretch;
    double least; ///< of the factors
} stretched;

void vn_stretch_point(const vn_stretch *stretch, const double p[3], double q[3]) {
    for (int k = 0; k < 3; k++) {
        q[k] = stretch->origin[k] + (p[k] - stretch->origin[k]) * stretch->factor[k];
    }
}

void vn_stretch_point_back(const vn_stretch *stretch, const double q[3], double p[3]) {
    for (int k = 0; k < 3; k++) {
        p[k] = stretch->origin[k] + (q[k] - stretch->origin[k]) / stretch->factor[k];
    }
}

vn_status vn_stretch_triangles(const vn_domain *domain, const vn_stretch *stretch, vn_triangles *out) {
    VN_TRY(vn_domain_triangles(domain, out));
    for (int32_t i = 0; i < out->xyz.count; i += 3) {
        double p[3];
        memcpy(p, out->xyz.data + i, sizeof p);
        vn_stretch_point(stretch, p, out->xyz.data + i);
    }
    return VN_OK;
}

static const stretched *stretched_of(const vn_domain *domain) {
    return (const stretched *)domain;
}

static void stretched_destroy(vn_domain *domain) {
    vn_domain_release(((stretched *)domain)->shape);
}

static bool stretched_contains(const vn_domain *domain, const double p[3]) {
    const stretched *s = stretched_of(domain);
    double in_shape[3];
    vn_stretch_point_back(&s->stretch, p, in_shape);
    return vn_domain_contains(s->shape, in_shape);
}

// No border is nearer than the original's is, drawn out by the least factor.
static double stretched_closest(const vn_domain *domain, const double p[3], double q[3]) {
    const stretched *s = stretched_of(domain);
    double in_shape[3], border[3];
    vn_stretch_point_back(&s->stretch, p, in_shape);
    double distance = s->shape->kind->closest(s->shape, in_shape, border);
    vn_stretch_point(&s->stretch, border, q);
    return distance * s->least;
}

// Lines stay lines.
static bool stretched_sees(const vn_domain *domain, const double a[3], const double b[3]) {
    const stretched *s = stretched_of(domain);
    double from[3], to[3];
    vn_stretch_point_back(&s->stretch, a, from);
    vn_stretch_point_back(&s->stretch, b, to);
    return vn_domain_sees(s->shape, from, to);
}

// What is spread evenly stays so.
static vn_status stretched_dart(const vn_domain *domain, vn_rng *rng, double p[3]) {
    const stretched *s = stretched_of(domain);
    double in_shape[3];
    VN_TRY(vn_domain_dart(s->shape, rng, in_shape));
    vn_stretch_point(&s->stretch, in_shape, p);
    return VN_OK;
}

static vn_status stretched_triangles(const vn_domain *domain, vn_triangles *out) {
    return vn_stretch_triangles(stretched_of(domain)->shape, &stretched_of(domain)->stretch, out);
}

static double stretched_value(const vn_domain *domain, const double p[3]) {
    const stretched *s = stretched_of(domain);
    double in_shape[3];
    vn_stretch_point_back(&s->stretch, p, in_shape);
    return vn_domain_value(s->shape, in_shape);
}

static const vn_domain_kind stretched_kind = {.name = "stretched domain",
                                              .destroy = stretched_destroy,
                                              .contains = stretched_contains,
                                              .closest = stretched_closest,
                                              .sees = stretched_sees,
                                              .dart = stretched_dart,
                                              .triangles = stretched_triangles,
                                              .value = stretched_value};

static vn_status wrap(vn_domain **out, const vn_domain *shape, const vn_stretch *stretch) {
    vn_box bounds = vn_domain_bounds(shape);
    stretched *s = vn_domain_new(&stretched_kind, sizeof *s, 3);
    if (s == NULL) {
        return vn_fail_memory("a stretched domain", sizeof *s);
    }
    s->shape = vn_domain_retain(shape);
    s->stretch = *stretch;
    s->least = fmin(fmin(stretch->factor[0], stretch->factor[1]), stretch->factor[2]);
    vn_stretch_point(stretch, bounds.min, s->base.bounds.min);
    vn_stretch_point(stretch, bounds.max, s->base.bounds.max);
    s->base.measure = vn_domain_measure(shape) * stretch->factor[0] * stretch->factor[1] * stretch->factor[2];
    *out = &s->base;
    return VN_OK;
}

vn_status vn_domain_stretch(vn_domain **out, const vn_domain *domain, const vn_stretch *stretch) {
    *out = NULL;
    VN_TRY(domain->kind->stretched != NULL ? domain->kind->stretched(out, domain, stretch)
                                           : wrap(out, domain, stretch));
    memcpy((*out)->unit, domain->unit, sizeof domain->unit);
    return VN_OK;
}
