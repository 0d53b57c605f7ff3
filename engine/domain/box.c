#include "domain/domain.h"
#include "domain/stretch.h"

#include "space/points.h"

static const vn_box_def box_default = {.max = {1, 1, 1}, .dim = 2};

static const vn_field box_fields[] = {
    {"min", VN_POINT, VN_REQUIRED, offsetof(vn_box_def, min), -VN_HUGE, VN_HUGE, "length", NULL,
     "its corner of least coordinates"},
    {"max", VN_POINT, VN_REQUIRED, offsetof(vn_box_def, max), -VN_HUGE, VN_HUGE, "length", NULL,
     "the opposite corner; two coordinates make a flat box, three a solid one"},
};
const vn_schema vn_box_schema = VN_SCHEMA("box", "An upright box", box_fields, box_default);

vn_box_def vn_box_def_default(void) {
    return box_default;
}

static bool box_contains(const vn_domain *domain, const double p[3]) {
    for (int k = 0; k < domain->dim; k++) {
        if (!(p[k] > domain->bounds.min[k] && p[k] < domain->bounds.max[k])) {
            return false;
        }
    }
    return true;
}

static double box_closest(const vn_domain *domain, const double p[3], double q[3]) {
    double least = INFINITY, outside = 0, at = 0;
    int axis = 0;
    memcpy(q, p, 3 * sizeof *q);
    for (int k = 0; k < domain->dim; k++) {
        double low = domain->bounds.min[k], high = domain->bounds.max[k];
        double below = p[k] - low, above = high - p[k];
        if (fmin(below, above) < least) {
            least = fmin(below, above);
            axis = k;
            at = below < above ? low : high;
        }
        q[k] = fmin(fmax(p[k], low), high);
        outside += (p[k] - q[k]) * (p[k] - q[k]);
    }
    if (outside > 0) {
        return sqrt(outside);
    }
    q[axis] = at;
    return fmax(least, 0);
}

static bool box_sees(const vn_domain *domain, const double a[3], const double b[3]) {
    (void)domain;
    (void)a;
    (void)b;
    return true;
}

static vn_status box_outline(const vn_domain *domain, int32_t sides, vn_rings *out) {
    (void)sides;
    const vn_box *b = &domain->bounds;
    VN_TRY(vn_rings_point(out, b->min[0], b->min[1]));
    VN_TRY(vn_rings_point(out, b->max[0], b->min[1]));
    VN_TRY(vn_rings_point(out, b->max[0], b->max[1]));
    VN_TRY(vn_rings_point(out, b->min[0], b->max[1]));
    return vn_rings_close(out);
}

// Corner i has the greatest x, y or z where its bits 1, 2 or 4 are set.
static vn_status box_triangles(const vn_domain *domain, vn_triangles *out) {
    static const int32_t corners[36] = {0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3, 0, 4, 5, 0, 5, 1,
                                        2, 3, 7, 2, 7, 6, 0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5};
    for (int i = 0; i < 24; i++) {
        bool high = i / 3 >> i % 3 & 1;
        double at = high ? domain->bounds.max[i % 3] : domain->bounds.min[i % 3];
        VN_TRY(vn_array_push(&out->xyz, at));
    }
    for (int i = 0; i < 36; i++) {
        VN_TRY(vn_array_push(&out->corners, corners[i]));
    }
    return VN_OK;
}

static vn_status box_stretched(vn_domain **out, const vn_domain *domain, const vn_stretch *stretch) {
    vn_box_def def = {.dim = 3};
    vn_stretch_point(stretch, domain->bounds.min, def.min);
    vn_stretch_point(stretch, domain->bounds.max, def.max);
    return vn_domain_box(out, &def);
}

static const vn_domain_kind flat_kind = {.name = "box",
                                         .contains = box_contains,
                                         .closest = box_closest,
                                         .sees = box_sees,
                                         .outline = box_outline};
static const vn_domain_kind solid_kind = {.name = "box",
                                          .contains = box_contains,
                                          .closest = box_closest,
                                          .sees = box_sees,
                                          .triangles = box_triangles,
                                          .stretched = box_stretched};

vn_status vn_domain_box(vn_domain **out, const vn_box_def *def) {
    *out = NULL;
    if (def->dim != 2 && def->dim != 3) {
        return vn_fail(VN_INVALID, "box: %d dimensions; give min and max two coordinates each, or three",
                       def->dim);
    }
    for (int k = 0; k < def->dim; k++) {
        if (!(def->max[k] > def->min[k]) || !isfinite(def->max[k] - def->min[k])) {
            return vn_fail(VN_INVALID,
                           "box.max = %g must be above box.min = %g in every direction, and finite",
                           def->max[k], def->min[k]);
        }
    }
    vn_domain *domain = vn_domain_new(def->dim == 2 ? &flat_kind : &solid_kind, sizeof *domain, def->dim);
    if (domain == NULL) {
        return vn_fail_memory("a box", sizeof *domain);
    }
    domain->polygonal = def->dim == 2;
    domain->measure = 1;
    for (int k = 0; k < def->dim; k++) {
        domain->bounds.min[k] = def->min[k];
        domain->bounds.max[k] = def->max[k];
        domain->measure *= def->max[k] - def->min[k];
    }
    *out = domain;
    return VN_OK;
}
