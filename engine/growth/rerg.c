// Non-uniform anisotropic growth (Runions et al. 2005, section 3.3 and appendix; READINGS R-RERG).

#include "growth/factors.h"
#include "growth/growth.h"

typedef struct rerg {
    vn_growth growth;
    vn_factors x, y;
    vn_heights before, after; ///< of the move that was prepared
    vn_rings outline;         ///< at time 0, with points close enough for what growth makes of its edges
} rerg;

static const vn_rerg_def rerg_default = {.steps = 100, .samples = 16384, .split = 2};

static const char factor_kinds[] = "function(y0), {f, f, …} from bottom to top, {{y0, f}, …} or a number";

static const vn_field rerg_fields[] = {
    {"domain", VN_OBJECT, VN_REQUIRED, offsetof(vn_rerg_def, domain), 0, 0, "", "domain",
     "the shape of the blade at first"},
    {"origin", VN_POINT, VN_OPTIONAL, offsetof(vn_rerg_def, origin), -VN_HUGE, VN_HUGE, "length", NULL,
     "the petiole, which stays and from which heights count; left out: the lowest point of the outline"},
    {"x", VN_MIXED, 0, 0, 0, 0, "", factor_kinds,
     "growth factor a step across, by the height y0 at first; through points {y0, f} runs a monotone spline; "
     "1: none"},
    {"y", VN_MIXED, 0, 0, 0, 0, "", factor_kinds, "growth factor a step along, likewise"},
    {"steps", VN_I32, 0, offsetof(vn_rerg_def, steps), 1, 1e8, "steps", NULL, "how many steps it grows"},
    {"samples", VN_I32, 0, offsetof(vn_rerg_def, samples), 2, 1e7, "samples", NULL,
     "how many samples of a function or spline are taken, evenly spaced; f is linear in between"},
    {"split", VN_F64, 0, offsetof(vn_rerg_def, split), 0, 1e150, "length", NULL,
     "edges that growth makes longer than this are split; about two vein segments; 0: none"},
};
const vn_schema vn_rerg_schema = VN_SCHEMA(
    "rerg", "A blade whose growth varies along it (Runions §3.3 and appendix)", rerg_fields, rerg_default);

vn_rerg_def vn_rerg_def_default(void) {
    return rerg_default;
}

static vn_status table_of(vn_heights *heights, const vn_factors *factors, double time) {
    return heights->y.count > 0 && heights->time == time ? VN_OK : vn_heights_make(heights, factors, time);
}

// A step begins where the last one ended: its table is there already.
static vn_status rerg_prepare(vn_growth *growth, double t1, double t2) {
    rerg *r = (rerg *)growth;
    if (r->after.y.count > 0 && r->after.time == t1) {
        vn_heights spare = r->before;
        r->before = r->after;
        r->after = spare;
    }
    VN_TRY(table_of(&r->before, &r->y, t1));
    return table_of(&r->after, &r->y, t2);
}

static bool rerg_move(const vn_growth *growth, const double p[3], double q[3]) {
    const rerg *r = (const rerg *)growth;
    double y0 = vn_heights_invert(&r->before, p[1] - growth->origin[1]);
    double across = pow(vn_factors_at(&r->x, y0), r->after.time - r->before.time);
    q[0] = growth->origin[0] + (p[0] - growth->origin[0]) * across;
    q[1] = growth->origin[1] + vn_heights_at(&r->after, y0);
    q[2] = p[2];
    return true;
}

static vn_status rerg_outline(vn_growth *growth, double time, vn_rings *out) {
    VN_TRY(rerg_prepare(growth, 0, time));
    return vn_today_push_moved(growth, &((rerg *)growth)->outline, time, out);
}

static void rerg_destroy(vn_growth *growth) {
    rerg *r = (rerg *)growth;
    vn_factors_free(&r->x);
    vn_factors_free(&r->y);
    vn_heights_free(&r->before);
    vn_heights_free(&r->after);
    vn_rings_free(&r->outline);
}

static const vn_growth_kind rerg_kind = {.name = "rerg",
                                         .size = sizeof(rerg),
                                         .domain = VN_TODAY_DOMAIN,
                                         .step = vn_today_step,
                                         .destroy = rerg_destroy,
                                         .prepare = rerg_prepare,
                                         .move = rerg_move,
                                         .outline = rerg_outline};

// ---- The outline at first ----

enum { FINEST_PIECES = 2048, MOST_POINTS = 1 << 20 };

static int32_t pieces_of(double y0, double y1, double width) {
    return (int32_t)ceil(fmax(fabs(y1 - y0) / width, 1));
}

static int64_t count_points(const vn_rings *rings, double width) {
    int64_t points = 0;
    for (int32_t ring = 0; ring < rings->ends.count; ring++) {
        int32_t begin = vn_rings_begin(rings, ring), end = rings->ends.data[ring];
        for (int32_t i = begin; i < end; i++) {
            points += pieces_of(rings->y.data[i], rings->y.data[vn_rings_next(begin, end, i)], width);
        }
    }
    return points;
}

static vn_status push_edge(const vn_rings *rings, int32_t i, int32_t j, double width, vn_rings *out) {
    const double *x = rings->x.data, *y = rings->y.data;
    int32_t pieces = pieces_of(y[i], y[j], width);
    for (int32_t k = 0; k < pieces; k++) {
        double s = (double)k / pieces;
        VN_TRY(vn_rings_point(out, x[i] + s * (x[j] - x[i]), y[i] + s * (y[j] - y[i])));
    }
    return VN_OK;
}

// Growth bends straight edges. Pieces of 1/2048 of the height stay straight enough; an outline that runs up
// and down very often has to do with coarser ones.
static vn_status refine(const vn_rings *rings, double height, vn_rings *out) {
    double width = height / FINEST_PIECES;
    while (count_points(rings, width) > MOST_POINTS + 2 * (int64_t)rings->x.count) {
        width *= 2;
    }
    for (int32_t ring = 0; ring < rings->ends.count; ring++) {
        int32_t begin = vn_rings_begin(rings, ring), end = rings->ends.data[ring];
        for (int32_t i = begin; i < end; i++) {
            VN_TRY(push_edge(rings, i, vn_rings_next(begin, end, i), width, out));
        }
        VN_TRY(vn_rings_close(out));
    }
    return VN_OK;
}

static vn_status take_outline(rerg *r) {
    vn_rings rings = {0};
    vn_status status = vn_domain_outline(r->growth.shape, VN_FINE_SIDES, &rings);
    status = status == VN_OK ? refine(&rings, r->growth.own_length, &r->outline) : status;
    vn_rings_free(&rings);
    return status;
}

static vn_status begin(rerg *r, const vn_rerg_def *def) {
    double origin = r->growth.origin[1];
    double low = r->growth.shape->bounds.min[1] - origin, high = r->growth.shape->bounds.max[1] - origin;
    VN_TRY(vn_factors_set(&r->x, "rerg.x", def->x, def->x_samples, low, high));
    VN_TRY(vn_factors_set(&r->y, "rerg.y", def->y, def->y_samples, low, high));
    VN_TRY(take_outline(r));
    return vn_today_begin(&r->growth, def->steps);
}

static vn_status make(vn_growth **out, const vn_rerg_def *def) {
    *out = NULL;
    VN_TRY(vn_check_def(&vn_rerg_schema, def));
    vn_growth_base base = {def->domain, def->has_origin ? def->origin : NULL, def->split};
    return vn_growth_make(out, &rerg_kind, &base);
}

vn_status vn_growth_rerg(vn_growth **out, const vn_rerg_def *def) {
    vn_growth *growth;
    *out = NULL;
    VN_TRY(make(&growth, def));
    vn_status status = begin((rerg *)growth, def);
    if (status != VN_OK) {
        vn_growth_release(growth);
        return status;
    }
    *out = growth;
    return VN_OK;
}

vn_status vn_growth_heights(const vn_rerg_def *def, double *bottom, double *top) {
    vn_growth *growth;
    *bottom = *top = 0;
    VN_TRY(make(&growth, def));
    *bottom = growth->shape->bounds.min[1] - growth->origin[1];
    *top = growth->shape->bounds.max[1] - growth->origin[1];
    vn_growth_release(growth);
    return VN_OK;
}
