// Moving tissue: today's shape is the polygon of the moved outline. A new one takes the place of the last, so
// that a step which goes wrong leaves the blade as it was.

#include "growth/growth.h"

#include <stdio.h>

static const vn_domain *today_of(const vn_domain *domain) {
    return ((const vn_growth *)domain)->today;
}

bool vn_today_contains(const vn_domain *domain, const double p[3]) {
    return vn_domain_contains(today_of(domain), p);
}

double vn_today_closest(const vn_domain *domain, const double p[3], double q[3]) {
    return today_of(domain)->kind->closest(today_of(domain), p, q);
}

bool vn_today_sees(const vn_domain *domain, const double a[3], const double b[3]) {
    return vn_domain_sees(today_of(domain), a, b);
}

vn_status vn_today_outline(const vn_domain *domain, int32_t sides, vn_rings *out) {
    return vn_domain_outline(today_of(domain), sides, out);
}

static vn_status push_moved(const vn_growth *growth, const double p[3], double time, vn_rings *out) {
    double q[3];
    if (!growth->kind->move(growth, p, q) || !(fabs(q[0]) <= 1e150 && fabs(q[1]) <= 1e150)) {
        return vn_fail(
            VN_INFEASIBLE,
            "%s: at step %g the outline's (%g, %g) comes to (%g, %g), out of range: take fewer steps "
            "or factors nearer 1",
            growth->kind->name, time, p[0], p[1], q[0], q[1]);
    }
    return vn_rings_point(out, q[0], q[1]);
}

vn_status vn_today_push_moved(const vn_growth *growth, const vn_rings *rings, double time, vn_rings *out) {
    for (int32_t ring = 0; ring < rings->ends.count; ring++) {
        for (int32_t i = vn_rings_begin(rings, ring); i < rings->ends.data[ring]; i++) {
            double p[3] = {rings->x.data[i], rings->y.data[i], 0};
            VN_TRY(push_moved(growth, p, time, out));
        }
        VN_TRY(vn_rings_close(out));
    }
    return VN_OK;
}

static vn_status check_simple(const vn_growth *growth, const vn_rings *rings, int32_t time) {
    char what[48];
    snprintf(what, sizeof what, "%s: at step %d", growth->kind->name, time);
    vn_status status = growth->simple ? vn_rings_check_simple(rings, what) : VN_OK;
    return status == VN_INVALID ? VN_INFEASIBLE : status;
}

void vn_today_replace(vn_growth *growth, vn_domain *shape) {
    vn_domain_release(growth->today);
    growth->today = shape;
    growth->base.bounds = shape->bounds;
    growth->base.measure = shape->measure;
    growth->length = shape->bounds.max[1] - shape->bounds.min[1];
}

vn_status vn_today_step(vn_growth *growth, int32_t time) {
    vn_rings rings = {0};
    vn_domain *shape = NULL;
    vn_status status = growth->kind->outline(growth, time, &rings);
    status = status == VN_OK ? check_simple(growth, &rings, time) : status;
    status = status == VN_OK ? vn_domain_from_rings(&shape, &rings, growth->base.unit) : status;
    vn_rings_free(&rings);
    if (status == VN_OK) {
        vn_today_replace(growth, shape);
    }
    return status;
}

// A shape whose outlines touch is none that growth spoilt.
static vn_status look_whether_simple(vn_growth *growth) {
    vn_rings rings = {0};
    vn_status status = growth->kind->outline(growth, 0, &rings);
    vn_status simple = status == VN_OK ? vn_rings_check_simple(&rings, growth->kind->name) : status;
    growth->simple = simple == VN_OK;
    vn_rings_free(&rings);
    return status == VN_OK && simple != VN_INVALID ? simple : status;
}

static vn_status find_final_length(vn_growth *growth) {
    vn_rings rings = {0};
    vn_status status = growth->kind->outline(growth, growth->steps, &rings);
    vn_box box = vn_rings_bounds(&rings);
    growth->to = box.max[1] - box.min[1];
    vn_rings_free(&rings);
    return status;
}

vn_status vn_today_begin(vn_growth *growth, int32_t steps) {
    growth->steps = steps;
    VN_TRY(look_whether_simple(growth));
    VN_TRY(vn_today_step(growth, 0));
    growth->from = growth->length;
    return find_final_length(growth);
}
