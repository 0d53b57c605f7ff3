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

void vn_growth_destroy(vn_domain *domain) {
    vn_growth *growth = (vn_growth *)domain;
    if (growth->kind->destroy != NULL) {
        growth->kind->destroy(growth);
    }
    vn_domain_release(growth->shape);
    vn_domain_release(growth->today);
    vn_array_free(&growth->carried);
}

void vn_growth_lowest_point(const vn_rings *rings, double origin[3]) {
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

static vn_status find_origin(vn_growth *growth, const double *given) {
    if (given != NULL) {
        if (!vn_finite(given)) {
            return vn_fail(VN_INVALID, "%s.origin must be finite", growth->kind->name);
        }
        memcpy(growth->origin, given, sizeof growth->origin);
        return VN_OK;
    }
    if (growth->base.dim == 3) {
        vn_box bounds = vn_domain_bounds(growth->shape);
        for (int k = 0; k < 3; k++) {
            growth->origin[k] = k == 1 ? bounds.min[1] : 0.5 * (bounds.min[k] + bounds.max[k]);
        }
        return VN_OK;
    }
    vn_rings rings = {0};
    vn_status status = vn_domain_outline(growth->shape, VN_FINE_SIDES, &rings);
    if (rings.y.count > 0) {
        vn_growth_lowest_point(&rings, growth->origin);
    }
    vn_rings_free(&rings);
    return status;
}

static vn_status check_shape(const vn_growth_kind *kind, const vn_domain *domain) {
    if (domain->kind->is_grown != NULL) {
        return vn_fail(VN_INVALID, "a growth of a growing domain: give the shape itself");
    }
    if (domain->kind->snap != NULL && kind->domain.snap == NULL) {
        return vn_fail(VN_INVALID,
                       "%s.domain is a surface, which it does not move: use venule.growth.uniform, isogonic "
                       "or none",
                       kind->name);
    }
    bool flat = kind->domain.outline != NULL && (kind->move != NULL || kind->domain.margin != NULL);
    if (flat && domain->dim != 2) {
        return vn_fail(VN_INVALID,
                       "%s.domain has %d dimensions, and this growth is of the plane: use "
                       "venule.growth.uniform or isogonic",
                       kind->name, domain->dim);
    }
    return VN_OK;
}

vn_status vn_growth_make(vn_growth **out, const vn_growth_kind *kind, const vn_growth_base *base) {
    *out = NULL;
    VN_TRY(check_shape(kind, base->domain));
    vn_growth *growth = vn_domain_new(&kind->domain, kind->size, base->domain->dim);
    if (growth == NULL) {
        return vn_fail_memory("a growth", kind->size);
    }
    growth->kind = kind;
    growth->shape = vn_domain_retain(base->domain);
    growth->own_length = base->domain->bounds.max[1] - base->domain->bounds.min[1];
    memcpy(growth->base.unit, base->domain->unit, sizeof growth->base.unit);
    growth->length = growth->from = growth->to = growth->own_length;
    growth->unit = 1;
    growth->split = base->split;
    vn_status status = find_origin(growth, base->origin);
    if (status != VN_OK) {
        vn_growth_release(growth);
        return status;
    }
    vn_growth_resize(growth, growth->own_length);
    *out = growth;
    return VN_OK;
}

vn_status vn_growth_set_lengths(vn_growth *growth, const vn_growth_def *def) {
    const char *name = growth->kind->name;
    if (!(growth->own_length > 0)) {
        return vn_fail(VN_INVALID,
                       "%s.domain is flat across y, along which its length is measured: turn it, or use "
                       "venule.growth.uniform",
                       name);
    }
    growth->to = def->to > 0 ? def->to : growth->own_length;
    growth->from = def->from > 0 ? def->from : growth->to / 20;
    growth->step = def->step > 0 ? def->step : (growth->to - growth->from) / 100;
    growth->length = growth->from;
    if (growth->from > growth->to) {
        return vn_fail(VN_INVALID, "%s.from = %g must not be above %s.to = %g: a %s cannot shrink", name,
                       growth->from, name, growth->to,
                       growth->base.kind->margin != NULL ? "margin" : "blade");
    }
    double steps = growth->to > growth->from ? ceil((growth->to - growth->from) / growth->step) : 0;
    if (steps > 1e8) {
        return vn_fail(VN_INVALID, "%s.step = %g takes more than 1e8 steps from %g to %g; give a longer one",
                       name, growth->step, growth->from, growth->to);
    }
    growth->steps = (int32_t)steps;
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

static vn_status still_dart(const vn_domain *domain, vn_rng *rng, double p[3]) {
    return vn_domain_dart(((const vn_growth *)domain)->shape, rng, p);
}

static vn_status still_triangles(const vn_domain *domain, vn_triangles *out) {
    return vn_domain_triangles(((const vn_growth *)domain)->shape, out);
}

static double still_value(const vn_domain *domain, const double p[3]) {
    return vn_domain_value(((const vn_growth *)domain)->shape, p);
}

static const vn_growth_kind still_kind = {.name = "none",
                                          .size = sizeof(vn_growth),
                                          .domain = {.name = "blade",
                                                     .destroy = vn_growth_destroy,
                                                     .contains = still_contains,
                                                     .closest = still_closest,
                                                     .sees = still_sees,
                                                     .dart = still_dart,
                                                     .outline = still_outline,
                                                     .triangles = still_triangles,
                                                     .value = still_value}};

static bool still_snap(const vn_domain *domain, const double p[3], double q[3]) {
    const vn_domain *shape = ((const vn_growth *)domain)->shape;
    return shape->kind->snap(shape, p, q);
}

static const vn_growth_kind still_surface_kind = {.name = "none",
                                                  .size = sizeof(vn_growth),
                                                  .domain = {.name = "blade",
                                                             .destroy = vn_growth_destroy,
                                                             .contains = still_contains,
                                                             .closest = still_closest,
                                                             .sees = still_sees,
                                                             .dart = still_dart,
                                                             .snap = still_snap,
                                                             .triangles = still_triangles}};

vn_status vn_growth_none(vn_growth **out, const vn_growth_def *def) {
    *out = NULL;
    VN_TRY(vn_check_def(&vn_none_schema, def));
    vn_growth_base base = {def->domain, def->has_origin ? def->origin : NULL, 0};
    bool is_surface = def->domain->kind->snap != NULL;
    return vn_growth_make(out, is_surface ? &still_surface_kind : &still_kind, &base);
}

void vn_growth_release(vn_growth *growth) {
    if (growth != NULL) {
        vn_domain_release(&growth->base);
    }
}

// Lengths decide where they are what grows: how many steps they take is rounded.
bool vn_growth_is_grown(const vn_growth *growth) {
    return vn_growth_moves(growth) ? growth->time >= growth->steps : growth->length >= growth->to;
}

bool vn_growth_is_grown_domain(const vn_domain *domain) {
    return vn_growth_is_grown((const vn_growth *)domain);
}

vn_status vn_growth_advance(vn_growth *growth, bool *growing) {
    *growing = false;
    growth->stepped = false;
    if (vn_growth_is_grown(growth)) {
        return VN_OK;
    }
    VN_TRY(growth->kind->step(growth, growth->time + 1));
    growth->time++;
    growth->base.changes++;
    growth->stepped = true;
    growth->carried.count = 0;
    *growing = true;
    return VN_OK;
}

static vn_status check_time(const vn_growth *growth, double time) {
    if (!(time >= 0 && time <= 1e9)) {
        return vn_fail(VN_INVALID, "growth:map of %s: the time %g must be from 0 to 1e9", growth->kind->name,
                       time);
    }
    return VN_OK;
}

static vn_status move(vn_growth *growth, double p[3], double t1, double t2) {
    double q[3];
    VN_TRY(growth->kind->prepare(growth, t1, t2));
    if (!growth->kind->move(growth, p, q) || !vn_finite(q)) {
        return vn_fail(VN_INFEASIBLE, "growth:map of %s: what is at (%g, %g) at time %g has no place at %g",
                       growth->kind->name, p[0], p[1], t1, t2);
    }
    memcpy(p, q, 3 * sizeof *p);
    return VN_OK;
}

// Where a stepwise move from @p t1 to @p t2 stops first.
static double next_stop(double t1, double t2) {
    return t1 < t2 ? fmin(floor(t1) + 1, t2) : fmax(ceil(t1) - 1, t2);
}

static vn_status move_through(vn_growth *growth, double p[3], double t1, double t2) {
    while (t1 != t2) {
        double next = growth->kind->stepwise ? next_stop(t1, t2) : t2;
        VN_TRY(move(growth, p, t1, next));
        t1 = next;
    }
    return VN_OK;
}

vn_status vn_growth_map(vn_growth *growth, const double p[3], double t1, double t2, double q[3]) {
    double moved[3] = {p[0], p[1], p[2]};
    q[0] = q[1] = q[2] = 0;
    if (!vn_finite(moved)) {
        return vn_fail(VN_INVALID, "growth:map: the point (%g, %g) is not finite", moved[0], moved[1]);
    }
    VN_TRY(check_time(growth, t1));
    VN_TRY(check_time(growth, t2));
    if (vn_growth_moves(growth)) {
        VN_TRY(move_through(growth, moved, t1, t2));
    }
    memcpy(q, moved, sizeof moved);
    return VN_OK;
}

vn_domain *vn_growth_domain(vn_growth *growth) {
    return &growth->base;
}

const char *vn_growth_kind_name(const vn_growth *growth) {
    return growth->kind->name;
}

int32_t vn_growth_time(const vn_growth *growth) {
    return growth->time;
}

int32_t vn_growth_steps(const vn_growth *growth) {
    return growth->steps;
}

double vn_growth_length(const vn_growth *growth) {
    return growth->length;
}

double vn_growth_final_length(const vn_growth *growth) {
    return growth->to;
}

double vn_growth_unit(const vn_growth *growth) {
    return growth->unit;
}

void vn_growth_origin(const vn_growth *growth, double p[3]) {
    memcpy(p, growth->origin, sizeof growth->origin);
}
