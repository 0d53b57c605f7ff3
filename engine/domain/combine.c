#include "domain/domain.h"

typedef struct combination {
    vn_domain base;
    vn_domain *a, *b;
    vn_combination how;
    int64_t seen; ///< changes of the growing operands when bounds and measure were taken
} combination;

static void combination_destroy(vn_domain *domain) {
    combination *c = (combination *)domain;
    vn_domain_release(c->a);
    vn_domain_release(c->b);
}

static bool combination_contains(const vn_domain *domain, const double p[3]) {
    const combination *c = (const combination *)domain;
    bool in_a = vn_domain_contains(c->a, p);
    bool in_b = vn_domain_contains(c->b, p);
    switch (c->how) {
    case VN_DIFFERENCE:
        return in_a && !in_b;
    case VN_UNION:
        return in_a || in_b;
    default:
        return in_a && in_b;
    }
}

// The sign that each operand's distance has in the result; the result's distance is the least of a minimum,
// or of a maximum for the union. Where that is not the true distance it is below it, so nothing can step
// across a border.
static double combination_closest(const vn_domain *domain, const double p[3], double q[3]) {
    const combination *c = (const combination *)domain;
    double qa[3], qb[3];
    double a = c->a->kind->closest(c->a, p, qa);
    double b = c->b->kind->closest(c->b, p, qb);
    double da = vn_domain_contains(c->a, p) ? a : -a;
    double db = vn_domain_contains(c->b, p) ? b : -b;
    db = c->how == VN_DIFFERENCE ? -db : db;
    bool take_a = c->how == VN_UNION ? da >= db : da <= db;
    memcpy(q, take_a ? qa : qb, 3 * sizeof *q);
    return fabs(take_a ? da : db);
}

static vn_status combine_outlines(vn_rings *out, const vn_domain *a, const vn_domain *b, vn_combination how,
                                  int32_t sides) {
    vn_rings ra = {0}, rb = {0};
    vn_status status = vn_domain_outline(a, sides, &ra);
    status = status == VN_OK ? vn_domain_outline(b, sides, &rb) : status;
    status = status == VN_OK ? vn_rings_combine(out, &ra, &rb, how) : status;
    vn_rings_free(&ra);
    vn_rings_free(&rb);
    return status;
}

static vn_status combination_outline(const vn_domain *domain, int32_t sides, vn_rings *out) {
    const combination *c = (const combination *)domain;
    vn_rings rings = {0};
    vn_status status = combine_outlines(&rings, c->a, c->b, c->how, sides);
    status = status == VN_OK ? vn_rings_append(out, &rings) : status;
    vn_rings_free(&rings);
    return status;
}

static int64_t combination_changes(const vn_domain *domain) {
    const combination *c = (const combination *)domain;
    return vn_domain_changes(c->a) + vn_domain_changes(c->b);
}

// After a growing operand has grown. A failure, for want of memory, leaves them as they were, and is
// tried again.
static void combination_refresh(vn_domain *domain) {
    combination *c = (combination *)domain;
    int64_t changes = combination_changes(domain);
    if (domain->dim == 2 && changes != c->seen && vn_domain_measure_outline(domain) == VN_OK) {
        c->seen = changes;
    }
}

static const vn_domain_kind flat_kind = {.name = "combination",
                                         .destroy = combination_destroy,
                                         .contains = combination_contains,
                                         .closest = combination_closest,
                                         .outline = combination_outline,
                                         .refresh = combination_refresh,
                                         .changes = combination_changes};

static const vn_domain_kind solid_kind = {.name = "combination",
                                          .destroy = combination_destroy,
                                          .contains = combination_contains,
                                          .closest = combination_closest};

static vn_box combine_bounds(const vn_box *a, const vn_box *b, vn_combination how) {
    vn_box box = *a;
    for (int k = 0; k < 3 && how != VN_DIFFERENCE; k++) {
        bool both = how == VN_INTERSECTION;
        box.min[k] = both ? fmax(a->min[k], b->min[k]) : fmin(a->min[k], b->min[k]);
        box.max[k] = both ? fmin(a->max[k], b->max[k]) : fmax(a->max[k], b->max[k]);
    }
    return box;
}

static vn_status combine_kept(vn_domain **out, const vn_domain *a, const vn_domain *b, vn_combination how) {
    combination *c = vn_domain_new(a->dim == 2 ? &flat_kind : &solid_kind, sizeof *c, a->dim);
    if (c == NULL) {
        return vn_fail_memory("a combination", sizeof *c);
    }
    c->a = vn_domain_retain(a);
    c->b = vn_domain_retain(b);
    c->how = how;
    c->seen = combination_changes(&c->base);
    memcpy(c->base.unit, a->unit, sizeof c->base.unit);
    vn_status status = VN_OK;
    if (a->dim == 2) {
        status = vn_domain_measure_outline(&c->base);
    } else {
        c->base.bounds = combine_bounds(&a->bounds, &b->bounds, how);
        c->base.measure = vn_domain_measure_by_points(&c->base);
    }
    if (status == VN_OK && !(c->base.measure > 0)) {
        status = vn_fail(VN_INFEASIBLE, "the combination of these domains is empty: nothing is left of it");
    }
    if (status != VN_OK) {
        vn_domain_release(&c->base);
        return status;
    }
    *out = &c->base;
    return VN_OK;
}

static vn_status combine_polygons(vn_domain **out, const vn_domain *a, const vn_domain *b,
                                  vn_combination how) {
    vn_rings rings = {0};
    vn_status status = combine_outlines(&rings, a, b, how, VN_FINE_SIDES);
    if (status == VN_OK && rings.ends.count == 0) {
        status = vn_fail(VN_INFEASIBLE, "the combination of these domains is empty: nothing is left of it");
    }
    status = status == VN_OK ? vn_domain_from_rings(out, &rings, a->unit) : status;
    vn_rings_free(&rings);
    return status;
}

vn_status vn_domain_combine(vn_domain **out, const vn_domain *a, const vn_domain *b, vn_combination how) {
    *out = NULL;
    if (a->dim != b->dim) {
        return vn_fail(VN_INVALID, "a domain of %d dimensions cannot be combined with one of %d", a->dim,
                       b->dim);
    }
    if (a->kind->snap != NULL || b->kind->snap != NULL) {
        return vn_fail(VN_INVALID, "a surface cannot be combined with a domain: cut its mesh instead");
    }
    bool exact = a->polygonal && b->polygonal;
    return exact ? combine_polygons(out, a, b, how) : combine_kept(out, a, b, how);
}
