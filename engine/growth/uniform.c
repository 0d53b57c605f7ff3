// Uniform anisotropic growth (Runions et al. 2005, section 3.3): one factor along x, one along y and, in 3D,
// one along z.

#include "growth/growth.h"

#include "domain/stretch.h"

typedef struct uniform {
    vn_growth growth;
    double factor[3];
    vn_stretch move;  ///< as prepared
    vn_rings outline; ///< of flat ones
} uniform;

static const vn_uniform_def uniform_default = {.x = 1, .y = 1, .z = 1, .steps = 100, .split = 2};

static const vn_field uniform_fields[] = {
    {"domain", VN_OBJECT, VN_REQUIRED, offsetof(vn_uniform_def, domain), 0, 0, "", "domain",
     "the shape of the blade at first"},
    {"origin", VN_POINT, VN_OPTIONAL, offsetof(vn_uniform_def, origin), -VN_HUGE, VN_HUGE, "length", NULL,
     "the petiole, which stays; left out: the lowest point of the outline, or in 3D the middle of the bottom "
     "(least y) of its bounds"},
    {"x", VN_F64, VN_ABOVE_MIN, offsetof(vn_uniform_def, x), 0, 1e6, "", NULL,
     "growth factor a step across; 1: none"},
    {"y", VN_F64, VN_ABOVE_MIN, offsetof(vn_uniform_def, y), 0, 1e6, "", NULL,
     "growth factor a step along; 1: none"},
    {"z", VN_F64, VN_ABOVE_MIN, offsetof(vn_uniform_def, z), 0, 1e6, "", NULL,
     "growth factor a step in depth, in 3D; 1: none"},
    {"steps", VN_I32, 0, offsetof(vn_uniform_def, steps), 1, 1e8, "steps", NULL, "how many steps it grows"},
    {"split", VN_F64, 0, offsetof(vn_uniform_def, split), 0, 1e150, "length", NULL,
     "edges that growth makes longer than this are split; about two vein segments; 0: none"},
};
const vn_schema vn_uniform_schema =
    VN_SCHEMA("uniform", "A blade that grows by one factor along each axis (Runions §3.3)", uniform_fields,
              uniform_default);

vn_uniform_def vn_uniform_def_default(void) {
    return uniform_default;
}

static vn_status uniform_prepare(vn_growth *growth, double t1, double t2) {
    uniform *u = (uniform *)growth;
    for (int k = 0; k < 3; k++) {
        u->move.origin[k] = growth->origin[k];
        u->move.factor[k] = pow(u->factor[k], t2 - t1);
    }
    return VN_OK;
}

static bool uniform_move(const vn_growth *growth, const double p[3], double q[3]) {
    vn_stretch_point(&((const uniform *)growth)->move, p, q);
    q[2] = growth->base.dim == 3 ? q[2] : p[2];
    return true;
}

static vn_status uniform_outline(vn_growth *growth, double time, vn_rings *out) {
    VN_TRY(uniform_prepare(growth, 0, time));
    return vn_today_push_moved(growth, &((uniform *)growth)->outline, time, out);
}

static void uniform_destroy(vn_growth *growth) {
    vn_rings_free(&((uniform *)growth)->outline);
}

static const vn_growth_kind uniform_kind = {.name = "uniform",
                                            .size = sizeof(uniform),
                                            .domain = VN_TODAY_DOMAIN,
                                            .step = vn_today_step,
                                            .destroy = uniform_destroy,
                                            .prepare = uniform_prepare,
                                            .move = uniform_move,
                                            .outline = uniform_outline};

// ---- In 3D: today's shape is the shape at first, stretched ----

static bool space_snap(const vn_domain *domain, const double p[3], double q[3]) {
    const vn_domain *today = ((const vn_growth *)domain)->today;
    return today->kind->snap(today, p, q);
}

static vn_status space_dart(const vn_domain *domain, vn_rng *rng, double p[3]) {
    return vn_domain_dart(((const vn_growth *)domain)->today, rng, p);
}

static vn_status space_triangles(const vn_domain *domain, vn_triangles *out) {
    return vn_domain_triangles(((const vn_growth *)domain)->today, out);
}

static double space_value(const vn_domain *domain, const double p[3]) {
    return vn_domain_value(((const vn_growth *)domain)->today, p);
}

// Within what a mesh may have: nearest points are computed with fourth powers.
static vn_status check_range(const vn_growth *growth, const vn_stretch *stretch, int32_t time) {
    double p[3], q[3];
    vn_stretch_point(stretch, growth->shape->bounds.min, p);
    vn_stretch_point(stretch, growth->shape->bounds.max, q);
    for (int k = 0; k < 3; k++) {
        bool thick = growth->shape->bounds.max[k] > growth->shape->bounds.min[k];
        if (!(fabs(p[k]) <= 1e60 && fabs(q[k]) <= 1e60) || (thick && !(q[k] - p[k] >= 1e-60))) {
            return vn_fail(
                VN_INFEASIBLE,
                "%s: at step %d the shape is from %g to %g along %c, out of range: take fewer steps "
                "or factors nearer 1",
                growth->kind->name, time, p[k], q[k], "xyz"[k]);
        }
    }
    return VN_OK;
}

static vn_status space_step(vn_growth *growth, int32_t time) {
    uniform *u = (uniform *)growth;
    vn_domain *shape = NULL;
    VN_TRY(uniform_prepare(growth, 0, time));
    VN_TRY(check_range(growth, &u->move, time));
    VN_TRY(vn_domain_stretch(&shape, growth->shape, &u->move));
    vn_today_replace(growth, shape);
    return VN_OK;
}

static vn_status space_begin(vn_growth *growth, int32_t steps) {
    growth->steps = steps;
    VN_TRY(space_step(growth, 0));
    growth->from = growth->length;
    growth->to = growth->length * pow(((uniform *)growth)->factor[1], steps);
    return VN_OK;
}

#define SPACE_DOMAIN(snaps)                                                                                  \
    {                                                                                                        \
        .name = "blade", .destroy = vn_growth_destroy, .contains = vn_today_contains,                        \
        .closest = vn_today_closest, .sees = vn_today_sees, .dart = space_dart,                              \
        .triangles = space_triangles, .value = space_value, .snap = (snaps),                                 \
        .is_grown = vn_growth_is_grown_domain                                                                \
    }

static const vn_growth_kind space_kind = {.name = "uniform",
                                          .size = sizeof(uniform),
                                          .domain = SPACE_DOMAIN(NULL),
                                          .step = space_step,
                                          .prepare = uniform_prepare,
                                          .move = uniform_move};

static const vn_growth_kind space_surface_kind = {.name = "uniform",
                                                  .size = sizeof(uniform),
                                                  .domain = SPACE_DOMAIN(space_snap),
                                                  .step = space_step,
                                                  .prepare = uniform_prepare,
                                                  .move = uniform_move};

static const vn_growth_kind *kind_for(const vn_domain *domain) {
    return domain->dim == 2 ? &uniform_kind : domain->kind->snap != NULL ? &space_surface_kind : &space_kind;
}

vn_status vn_growth_uniform(vn_growth **out, const vn_uniform_def *def) {
    *out = NULL;
    VN_TRY(vn_check_def(&vn_uniform_schema, def));
    vn_growth_base base = {def->domain, def->has_origin ? def->origin : NULL, def->split};
    vn_growth *growth;
    if (def->domain->dim == 2 && def->z != 1) {
        return vn_fail(VN_INVALID, "uniform.z = %g: the domain is flat, and has no depth that could grow",
                       def->z);
    }
    VN_TRY(vn_growth_make(&growth, kind_for(def->domain), &base));
    uniform *u = (uniform *)growth;
    u->factor[0] = def->x;
    u->factor[1] = def->y;
    u->factor[2] = def->z;
    bool flat = growth->base.dim == 2;
    vn_status status = flat ? vn_domain_outline(def->domain, VN_FINE_SIDES, &u->outline) : VN_OK;
    if (status == VN_OK) {
        status = flat ? vn_today_begin(growth, def->steps) : space_begin(growth, def->steps);
    }
    if (status != VN_OK) {
        vn_growth_release(growth);
        return status;
    }
    *out = growth;
    return VN_OK;
}
