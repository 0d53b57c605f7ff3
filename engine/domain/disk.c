#include "domain/domain.h"

#include "space/points.h"

static const double PI = 3.14159265358979323846;

static const vn_disk_def disk_default = {.radius = 1};

static const vn_field disk_fields[] = {
    {"center", VN_POINT, 0, offsetof(vn_disk_def, center), -VN_HUGE, VN_HUGE, "length", NULL, "its middle"},
    {"radius", VN_F64, VN_ABOVE_MIN, offsetof(vn_disk_def, radius), 0, 1e150, "length", NULL,
     "from the middle to the border"},
};
const vn_schema vn_disk_schema = VN_SCHEMA("disk", "A disk, or in 3D a ball", disk_fields, disk_default);

typedef struct disk {
    vn_domain base;
    double center[3];
    double radius;
} disk;

vn_disk_def vn_disk_def_default(void) {
    return disk_default;
}

static double from_center(const disk *d, const double p[3], double away[3]) {
    for (int k = 0; k < 3; k++) {
        away[k] = k < d->base.dim ? p[k] - d->center[k] : 0;
    }
    return sqrt(away[0] * away[0] + away[1] * away[1] + away[2] * away[2]);
}

static bool disk_contains(const vn_domain *domain, const double p[3]) {
    const disk *d = (const disk *)domain;
    double away[3];
    return from_center(d, p, away) < d->radius;
}

static double disk_closest(const vn_domain *domain, const double p[3], double q[3]) {
    const disk *d = (const disk *)domain;
    double away[3];
    double distance = from_center(d, p, away);
    for (int k = 0; k < 3; k++) {
        double direction = distance > 0 ? away[k] / distance : (k == 0 ? 1.0 : 0.0);
        q[k] = k < domain->dim ? d->center[k] + d->radius * direction : p[k];
    }
    return fabs(d->radius - distance);
}

static bool convex_sees(const vn_domain *domain, const double a[3], const double b[3]) {
    (void)domain;
    (void)a;
    (void)b;
    return true;
}

// Corners lie a little outside, so that the polygon has the circle's area.
static vn_status disk_outline(const vn_domain *domain, int32_t sides, vn_rings *out) {
    const disk *d = (const disk *)domain;
    double step = 2 * PI / sides;
    double radius = d->radius * sqrt(step / sin(step));
    for (int32_t i = 0; i < sides; i++) {
        VN_TRY(vn_rings_point(out, d->center[0] + radius * cos(i * step),
                              d->center[1] + radius * sin(i * step)));
    }
    return vn_rings_close(out);
}

enum { BALL_SIDES = 96 };

static vn_status push_parallel(const disk *d, int row, vn_triangles *out) {
    double above = PI * (2.0 * row / BALL_SIDES - 0.5);
    for (int i = 0; i < BALL_SIDES; i++) {
        double around = 2 * PI * i / BALL_SIDES;
        const double away[3] = {cos(above) * cos(around), sin(above), cos(above) * sin(around)};
        for (int k = 0; k < 3; k++) {
            VN_TRY(vn_array_push(&out->xyz, d->center[k] + d->radius * away[k]));
        }
    }
    return VN_OK;
}

// Two triangles between the parallels of @p row and the next, at each meridian.
static vn_status push_belt(int row, vn_triangles *out) {
    for (int i = 0; i < BALL_SIDES; i++) {
        int32_t a = row * BALL_SIDES + i, b = row * BALL_SIDES + (i + 1) % BALL_SIDES;
        const int32_t corners[6] = {a, a + BALL_SIDES, b, b, a + BALL_SIDES, b + BALL_SIDES};
        for (int k = 0; k < 6; k++) {
            VN_TRY(vn_array_push(&out->corners, corners[k]));
        }
    }
    return VN_OK;
}

static vn_status sphere_triangles(const vn_domain *domain, vn_triangles *out) {
    for (int row = 0; row <= BALL_SIDES / 2; row++) {
        VN_TRY(push_parallel((const disk *)domain, row, out));
    }
    for (int row = 0; row < BALL_SIDES / 2; row++) {
        VN_TRY(push_belt(row, out));
    }
    return VN_OK;
}

static const vn_domain_kind disk_kind = {.name = "disk",
                                         .contains = disk_contains,
                                         .closest = disk_closest,
                                         .sees = convex_sees,
                                         .outline = disk_outline};
static const vn_domain_kind sphere_kind = {.name = "sphere",
                                           .contains = disk_contains,
                                           .closest = disk_closest,
                                           .sees = convex_sees,
                                           .triangles = sphere_triangles};

static vn_status make(vn_domain **out, const vn_disk_def *def, const vn_domain_kind *kind, int dim) {
    *out = NULL;
    VN_TRY(vn_check_def(&vn_disk_schema, def));
    if (!vn_finite(def->center)) {
        return vn_fail(VN_INVALID, "%s.center must be finite", kind->name);
    }
    disk *d = vn_domain_new(kind, sizeof *d, dim);
    if (d == NULL) {
        return vn_fail_memory(kind->name, sizeof *d);
    }
    double r = def->radius;
    d->radius = r;
    for (int k = 0; k < dim; k++) {
        d->center[k] = def->center[k];
        d->base.bounds.min[k] = def->center[k] - r;
        d->base.bounds.max[k] = def->center[k] + r;
    }
    d->base.measure = dim == 2 ? PI * r * r : 4.0 / 3.0 * PI * r * r * r;
    *out = &d->base;
    return VN_OK;
}

vn_status vn_domain_disk(vn_domain **out, const vn_disk_def *def) {
    return make(out, def, &disk_kind, 2);
}

vn_status vn_domain_sphere(vn_domain **out, const vn_disk_def *def) {
    return make(out, def, &sphere_kind, 3);
}
