// Uniform anisotropic growth (Runions et al. 2005, section 3.3): one factor along x, one along y.

#include "growth/growth.h"

typedef struct uniform {
    vn_growth growth;
    double factor[2];
    double scale[2]; ///< of the move that was prepared
    vn_rings outline;
} uniform;

static const vn_uniform_def uniform_default = {.x = 1, .y = 1, .steps = 100, .split = 2};

static const vn_field uniform_fields[] = {
    {"domain", VN_OBJECT, VN_REQUIRED, offsetof(vn_uniform_def, domain), 0, 0, "", "domain",
     "the shape of the blade at first"},
    {"origin", VN_POINT, VN_OPTIONAL, offsetof(vn_uniform_def, origin), -VN_HUGE, VN_HUGE, "length", NULL,
     "the petiole, which stays; left out: the lowest point of the outline"},
    {"x", VN_F64, VN_ABOVE_MIN, offsetof(vn_uniform_def, x), 0, 1e6, "", NULL,
     "growth factor a step across; 1: none"},
    {"y", VN_F64, VN_ABOVE_MIN, offsetof(vn_uniform_def, y), 0, 1e6, "", NULL,
     "growth factor a step along; 1: none"},
    {"steps", VN_I32, 0, offsetof(vn_uniform_def, steps), 1, 1e8, "steps", NULL, "how many steps it grows"},
    {"split", VN_F64, 0, offsetof(vn_uniform_def, split), 0, 1e150, "length", NULL,
     "edges that growth makes longer than this are split; about two vein segments; 0: none"},
};
const vn_schema vn_uniform_schema =
    VN_SCHEMA("uniform", "A blade that grows by one factor along x and one along y (Runions §3.3)",
              uniform_fields, uniform_default);

vn_uniform_def vn_uniform_def_default(void) {
    return uniform_default;
}

static vn_status uniform_prepare(vn_growth *growth, double t1, double t2) {
    uniform *u = (uniform *)growth;
    for (int k = 0; k < 2; k++) {
        u->scale[k] = pow(u->factor[k], t2 - t1);
    }
    return VN_OK;
}

static bool uniform_move(const vn_growth *growth, const double p[3], double q[3]) {
    const uniform *u = (const uniform *)growth;
    for (int k = 0; k < 2; k++) {
        q[k] = growth->origin[k] + (p[k] - growth->origin[k]) * u->scale[k];
    }
    q[2] = p[2];
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

vn_status vn_growth_uniform(vn_growth **out, const vn_uniform_def *def) {
    *out = NULL;
    VN_TRY(vn_check_def(&vn_uniform_schema, def));
    vn_growth_base base = {def->domain, def->has_origin ? def->origin : NULL, def->split};
    vn_growth *growth;
    VN_TRY(vn_growth_make(&growth, &uniform_kind, &base));
    uniform *u = (uniform *)growth;
    u->factor[0] = def->x;
    u->factor[1] = def->y;
    vn_status status = vn_domain_outline(def->domain, VN_FINE_SIDES, &u->outline);
    status = status == VN_OK ? vn_today_begin(growth, def->steps) : status;
    if (status != VN_OK) {
        vn_growth_release(growth);
        return status;
    }
    *out = growth;
    return VN_OK;
}
