#include "domain/domain.h"

#include "base/hash.h"

#include "space/points.h"

void *vn_domain_new(const vn_domain_kind *kind, size_t size, int dim) {
    vn_domain *domain = vn_new_block(size);
    if (domain != NULL) {
        domain->kind = kind;
        domain->size = size;
        domain->dim = dim;
        atomic_init(&domain->references, 1);
    }
    return domain;
}

vn_domain *vn_domain_retain(const vn_domain *domain) {
    vn_domain *shared = (vn_domain *)domain; // what is counted is not part of its value
    atomic_fetch_add(&shared->references, 1);
    return shared;
}

void vn_domain_release(vn_domain *domain) {
    if (domain != NULL && atomic_fetch_sub(&domain->references, 1) == 1) {
        if (domain->kind->destroy != NULL) {
            domain->kind->destroy(domain);
        }
        vn_resize(domain, domain->size, 0);
    }
}

int vn_domain_dim(const vn_domain *domain) {
    return domain->dim;
}

const char *vn_domain_unit(const vn_domain *domain) {
    return domain->unit;
}

int64_t vn_domain_changes(const vn_domain *domain) {
    return domain->kind->changes != NULL ? domain->kind->changes(domain) : domain->changes;
}

static void refresh(const vn_domain *domain) {
    if (domain->kind->refresh != NULL) {
        domain->kind->refresh((vn_domain *)domain); // bounds and measure of a moving shape are a cache
    }
}

vn_box vn_domain_bounds(const vn_domain *domain) {
    refresh(domain);
    return domain->bounds;
}

double vn_domain_measure(const vn_domain *domain) {
    refresh(domain);
    return domain->measure;
}

int vn_domain_measure_dim(const vn_domain *domain) {
    return domain->kind->snap != NULL ? 2 : domain->dim;
}

bool vn_domain_contains(const vn_domain *domain, const double p[3]) {
    return domain->kind->contains(domain, p);
}

double vn_domain_distance(const vn_domain *domain, const double p[3]) {
    double q[3];
    double d = domain->kind->closest(domain, p, q);
    return domain->kind->contains(domain, p) ? d : -d;
}

void vn_domain_closest(const vn_domain *domain, const double p[3], double q[3]) {
    domain->kind->closest(domain, p, q);
}

bool vn_domain_is_near(const vn_domain *domain, const double p[3], double reach) {
    double q[3];
    return domain->kind->is_near != NULL ? domain->kind->is_near(domain, p, reach)
                                         : domain->kind->closest(domain, p, q) <= reach;
}

double vn_domain_value(const vn_domain *domain, const double p[3]) {
    if (domain->kind->value != NULL) {
        return domain->kind->value(domain, p);
    }
    return domain->kind->contains(domain, p) ? 1 : 0;
}

// No border lies within the distance to it, so each stride of that length stays inside. Strides end below a
// millionth of the bounds: something that thin is taken for closed.
static bool march(const vn_domain *domain, const double a[3], const double b[3]) {
    double length = sqrt(vn_distance2(a, b));
    double least = 1e-6 * sqrt(vn_distance2(domain->bounds.min, domain->bounds.max));
    double done = 0;
    while (done < length) {
        double p[3];
        for (int k = 0; k < 3; k++) {
            p[k] = a[k] + done / length * (b[k] - a[k]);
        }
        double free = vn_domain_distance(domain, p);
        if (free <= 0) {
            return false;
        }
        done += fmax(free, least);
    }
    return true;
}

// An end on the border, where a petiole is, counts as inside: the line is looked at from a millionth of
// the bounds on. False when it is farther from the border than that, or the line leaves there.
static bool step_off_border(const vn_domain *domain, const double from[3], const double to[3], double p[3]) {
    double q[3];
    double nudge = 1e-6 * sqrt(vn_distance2(domain->bounds.min, domain->bounds.max));
    double length = sqrt(vn_distance2(from, to));
    memcpy(p, from, 3 * sizeof *p);
    if (length <= nudge || domain->kind->closest(domain, from, q) > nudge) {
        return false;
    }
    for (int k = 0; k < 3; k++) {
        p[k] += nudge / length * (to[k] - from[k]);
    }
    return domain->kind->contains(domain, p);
}

static bool pull_inside(const vn_domain *domain, const double from[3], const double to[3], double p[3]) {
    memcpy(p, from, 3 * sizeof *p);
    return domain->kind->contains(domain, from) || step_off_border(domain, from, to, p);
}

static bool is_free(const vn_domain *domain, const double a[3], const double b[3]) {
    return domain->kind->sees != NULL ? domain->kind->sees(domain, a, b) : march(domain, a, b);
}

// contains() may say of a point on the border that it is inside: the line touches the border there all the
// same.
static bool sees_from_border(const vn_domain *domain, const double a[3], const double b[3]) {
    double p[3], q[3];
    bool from = step_off_border(domain, a, b, p), to = step_off_border(domain, b, a, q);
    return (from || to) && is_free(domain, from ? p : a, to ? q : b);
}

bool vn_domain_sees(const vn_domain *domain, const double a[3], const double b[3]) {
    double p[3], q[3];
    if (!pull_inside(domain, a, b, p) || !pull_inside(domain, b, a, q)) {
        return false;
    }
    return is_free(domain, p, q) || sees_from_border(domain, p, q);
}

vn_status vn_domain_fail_dart(const vn_domain *domain) {
    return vn_fail(
        VN_INFEASIBLE,
        "no dart of a million hit the %s: it fills less than a millionth of its bounds (is the outline "
        "right, and is it filled?)",
        domain->kind->name);
}

bool vn_domain_snap(const vn_domain *domain, double p[3]) {
    double q[3];
    if (domain->kind->snap == NULL) {
        return true;
    }
    bool on = domain->kind->snap(domain, p, q);
    if (on) {
        memcpy(p, q, sizeof q);
    }
    return on;
}

vn_status vn_domain_dart(const vn_domain *domain, vn_rng *rng, double p[3]) {
    if (domain->kind->dart != NULL) {
        return domain->kind->dart(domain, rng, p);
    }
    uint64_t begun = vn_hash_begin(rng->seed, rng->stream);
    for (int tries = 0; tries < 1000000; tries++) {
        p[2] = 0;
        for (int k = 0; k < domain->dim; k++) {
            p[k] = vn_uniform_here(rng, begun, domain->bounds.min[k], domain->bounds.max[k]);
        }
        if (domain->kind->contains(domain, p)) {
            return VN_OK;
        }
    }
    return vn_domain_fail_dart(domain);
}

vn_status vn_domain_outline(const vn_domain *domain, int32_t sides, vn_rings *out) {
    if (domain->kind->outline == NULL) {
        return vn_fail(VN_INVALID, "a %s has no flat outline to draw or to cut", domain->kind->name);
    }
    return domain->kind->outline(domain, sides, out);
}

vn_status vn_domain_measure_outline(vn_domain *domain) {
    vn_rings rings = {0};
    vn_status status = vn_domain_outline(domain, VN_FINE_SIDES, &rings);
    double area = 0;
    for (int32_t i = 0; status == VN_OK && i < rings.ends.count; i++) {
        area += vn_rings_area_of(&rings, i);
    }
    if (status == VN_OK) {
        domain->measure = area;
        domain->bounds = vn_rings_bounds(&rings);
    }
    vn_rings_free(&rings);
    return status;
}

double vn_domain_measure_by_points(const vn_domain *domain) {
    enum { POINTS = 1 << 18 };
    static const int32_t bases[3] = {2, 3, 5};
    const vn_box *box = &domain->bounds;
    int32_t inside = 0;
    double size = 1;
    for (int k = 0; k < domain->dim; k++) {
        size *= box->max[k] - box->min[k];
    }
    for (int32_t i = 1; i <= POINTS; i++) {
        double p[3] = {0};
        for (int k = 0; k < domain->dim; k++) {
            p[k] = box->min[k] + vn_halton(i, bases[k]) * (box->max[k] - box->min[k]);
        }
        inside += vn_domain_contains(domain, p);
    }
    return size * inside / POINTS;
}

void vn_triangles_free(vn_triangles *triangles) {
    vn_array_free(&triangles->xyz);
    vn_array_free(&triangles->corners);
}

vn_status vn_domain_triangles(const vn_domain *domain, vn_triangles *out) {
    if (domain->kind->triangles == NULL) {
        return vn_fail(
            VN_INVALID,
            "a domain of the kind \"%s\" has no surface of triangles; meshes, balls and boxes have",
            domain->kind->name);
    }
    return domain->kind->triangles(domain, out);
}
