#include "draw/camera.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

// Where the eye is when nobody says: as one looks at a thing on a table, a little from the right and above.
static const double ASIDE = 30, ABOVE = 22;

#define ROW_DEF vn_camera_def
#define ROW(name, type, flags, min, max, unit, kind, doc)                                                    \
    { #name, type, flags, offsetof(ROW_DEF, name), min, max, unit, kind, doc }
static const vn_camera_def camera_defaults = {
    .from = {NAN, NAN, NAN}, .to = {NAN, NAN, NAN}, .up = {NAN, NAN, NAN}, .fov = 30, .zoom = 1};
static const vn_field camera_fields[] = {
    ROW(from, VN_POINT, 0, 0, 0, "length", NULL,
        "where the eye is; left out: a little from the right and above, as far away as shows the whole view"),
    ROW(to, VN_POINT, 0, 0, 0, "length", NULL,
        "what it looks at, in the middle of the picture; left out: the middle of the view"),
    ROW(up, VN_POINT, 0, 0, 0, "", NULL, "the direction that is up in the picture; left out: y"),
    ROW(fov, VN_F64, 0, 0, 150, "degrees", NULL,
        "angle that the canvas's shorter side shows, less its margins; 0: a parallel projection"),
    ROW(zoom, VN_F64, VN_ABOVE_MIN, 0, 1e6, "", NULL, "enlarges the picture about its middle"),
    ROW(fog, VN_F64, 0, 0, 1, "", NULL, "how much what is farthest in the view fades into the background"),
};
const vn_schema vn_camera_schema =
    VN_SCHEMA("camera", "How a canvas looks at space", camera_fields, camera_defaults);

vn_camera_def vn_camera_def_default(void) {
    return camera_defaults;
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(double n[3], const double a[3], const double b[3]) {
    n[0] = a[1] * b[2] - a[2] * b[1];
    n[1] = a[2] * b[0] - a[0] * b[2];
    n[2] = a[0] * b[1] - a[1] * b[0];
}

// Through the largest component, so that nothing overflows or vanishes on the way.
static bool scale_to_one(double v[3]) {
    double largest = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
    if (!(largest > 0)) {
        return false;
    }
    for (int k = 0; k < 3; k++) {
        v[k] /= largest;
    }
    double length = sqrt(dot(v, v));
    for (int k = 0; k < 3; k++) {
        v[k] /= length;
    }
    return true;
}

static bool is_given(const double p[3]) {
    return !isnan(p[0]) || !isnan(p[1]) || !isnan(p[2]);
}

static vn_status check_point(const double p[3], const char *name) {
    for (int k = 0; k < 3; k++) {
        if (is_given(p) && !(fabs(p[k]) <= 1e100)) {
            return vn_fail(VN_INVALID, "camera.%s = (%g, %g, %g) must be finite, and within 1e100", name,
                           p[0], p[1], p[2]);
        }
    }
    return VN_OK;
}

static bool is_box(const vn_box *view) {
    return view->max[0] > view->min[0] || view->max[1] > view->min[1] || view->max[2] > view->min[2];
}

static vn_status check_view(const vn_box *view) {
    for (int k = 0; k < 3; k++) {
        if (!(fabs(view->min[k]) <= 1e100 && fabs(view->max[k]) <= 1e100 && view->max[k] >= view->min[k])) {
            return vn_fail(VN_INVALID,
                           "canvas.view goes from %g to %g in %c: give finite numbers, min below max",
                           view->min[k], view->max[k], "xyz"[k]);
        }
    }
    return VN_OK;
}

// Seen from where the eye is when nobody says.
static void look_aside(vn_camera *camera, const double up[3]) {
    double right[3] = {1, 0, 0}, front[3];
    if (fabs(up[0]) > 0.9) {
        right[0] = 0;
        right[1] = 1;
    }
    cross(front, right, up);
    scale_to_one(front);
    cross(right, up, front);
    double aside = ASIDE * PI / 180, above = ABOVE * PI / 180;
    for (int k = 0; k < 3; k++) {
        camera->back[k] = cos(above) * (cos(aside) * front[k] + sin(aside) * right[k]) + sin(above) * up[k];
    }
    scale_to_one(camera->back);
}

static vn_status look_from(vn_camera *camera, const double from[3]) {
    for (int k = 0; k < 3; k++) {
        camera->back[k] = from[k] - camera->middle[k];
    }
    camera->distance = sqrt(dot(camera->back, camera->back));
    if (!(camera->distance > 0) || !scale_to_one(camera->back)) {
        return vn_fail(VN_INVALID,
                       "camera.from and camera.to are both (%g, %g, %g): the eye must be elsewhere", from[0],
                       from[1], from[2]);
    }
    return VN_OK;
}

static vn_status set_axes(vn_camera *camera, const vn_camera_def *def) {
    double up[3] = {0, 1, 0};
    if (is_given(def->up)) {
        memcpy(up, def->up, sizeof up);
    }
    if (!scale_to_one(up)) {
        return vn_fail(VN_INVALID, "camera.up = (0, 0, 0) is no direction");
    }
    if (is_given(def->from)) {
        VN_TRY(look_from(camera, def->from));
    } else {
        look_aside(camera, up);
    }
    if (!is_given(def->up) && fabs(camera->back[1]) > 1 - 1e-12) {
        up[1] = 0; // from right above or below: what is behind is up
        up[2] = camera->back[1] > 0 ? -1 : 1;
    }
    cross(camera->right, up, camera->back);
    if (dot(camera->right, camera->right) < 1e-18 || !scale_to_one(camera->right)) {
        return vn_fail(VN_INVALID,
                       "camera.up = (%g, %g, %g) is the direction from `to` to `from`: give another one",
                       def->up[0], def->up[1], def->up[2]);
    }
    cross(camera->up, camera->back, camera->right);
    return VN_OK;
}

static void corner_of(const vn_camera *camera, const vn_box *view, int corner, double seen[3]) {
    double p[3];
    for (int k = 0; k < 3; k++) {
        p[k] = corner >> k & 1 ? view->max[k] : view->min[k];
    }
    vn_camera_see(camera, p, seen);
}

// How far the eye must be, or how many units fit, so that all corners are within the room. @p tangents:
// half the room's sides over the focal length.
static void fit_corners(const vn_camera *camera, const vn_box *view, const double tangents[2],
                        double *distance, double *half) {
    *distance = *half = 0;
    for (int i = 0; i < 8; i++) {
        double seen[3];
        corner_of(camera, view, i, seen);
        double wide = fmax(fabs(seen[0]) / tangents[0], fabs(seen[1]) / tangents[1]);
        *half = fmax(*half, wide);
        *distance = fmax(*distance, seen[2] + wide);
    }
}

static void set_fog(vn_camera *camera, const vn_camera_def *def, const vn_box *view) {
    camera->fog = def->fog;
    for (int i = 0; i < 8; i++) {
        double seen[3];
        corner_of(camera, view, i, seen);
        camera->nearest = i == 0 ? seen[2] : fmax(camera->nearest, seen[2]);
        camera->farthest = i == 0 ? seen[2] : fmin(camera->farthest, seen[2]);
    }
}

// @p half is the room's shorter half, pixels.
static void set_scale(vn_camera *camera, const vn_camera_def *def, const vn_box *view, const double room[2]) {
    double half = 0.5 * fmin(room[0], room[1]);
    double tangent = def->fov > 0 ? tan(def->fov * PI / 360) : 1;
    double tangents[2] = {tangent * 0.5 * room[0] / half, tangent * 0.5 * room[1] / half};
    double distance, widest;
    fit_corners(camera, view, tangents, &distance, &widest);
    if (def->fov == 0) {
        camera->distance = INFINITY;
        camera->scale = def->zoom * half / widest;
        return;
    }
    if (!is_given(def->from)) {
        camera->distance = distance;
    }
    camera->scale = def->zoom * half / tangent / camera->distance;
}

static void set_middle(vn_camera *camera, const vn_camera_def *def, const vn_box *view) {
    for (int k = 0; k < 3; k++) {
        camera->middle[k] = is_given(def->to) ? def->to[k] : 0.5 * view->min[k] + 0.5 * view->max[k];
    }
}

static vn_status check_room(double width, double height, double margin) {
    if (!(width > 2 * margin && height > 2 * margin)) {
        return vn_fail(VN_INVALID, "canvas.margin = %g pixels leaves nothing of %g x %g pixels for the view",
                       margin, width, height);
    }
    return VN_OK;
}

static vn_status check_given(const vn_camera_def *def, const vn_box *view) {
    VN_TRY(vn_check_def(&vn_camera_schema, def));
    VN_TRY(check_point(def->from, "from"));
    VN_TRY(check_point(def->to, "to"));
    VN_TRY(check_point(def->up, "up"));
    VN_TRY(check_view(view));
    if (is_box(view)) {
        return VN_OK;
    }
    if (!is_given(def->from) || def->fov == 0) {
        return vn_fail(VN_INVALID, "canvas.camera: %s needs canvas.view, the bounds of what is to be seen",
                       def->fov == 0 ? "a parallel projection (fov = 0)" : "a camera without `from`");
    }
    if (def->fog > 0) {
        return vn_fail(VN_INVALID, "camera.fog = %g needs canvas.view, to say what is far", def->fog);
    }
    return VN_OK;
}

vn_status vn_camera_set(vn_camera *camera, const vn_camera_def *def, const vn_box *view, double margin,
                        double width, double height) {
    double room[2] = {width - 2 * margin, height - 2 * margin};
    *camera = (vn_camera){.on = true, .x = 0.5 * width, .y = 0.5 * height};
    VN_TRY(check_room(width, height, margin));
    VN_TRY(check_given(def, view));
    set_middle(camera, def, view);
    VN_TRY(set_axes(camera, def));
    set_scale(camera, def, view, room);
    set_fog(camera, def, view);
    if (!(camera->scale > 0) || !isfinite(camera->scale)) {
        return vn_fail(VN_INVALID, "canvas.view is too small or too large to draw: use another length unit");
    }
    return VN_OK;
}

void vn_camera_see(const vn_camera *camera, const double p[3], double seen[3]) {
    double away[3] = {p[0] - camera->middle[0], p[1] - camera->middle[1], p[2] - camera->middle[2]};
    seen[0] = dot(away, camera->right);
    seen[1] = dot(away, camera->up);
    seen[2] = dot(away, camera->back);
}

double vn_camera_scale_at(const vn_camera *camera, const double seen[3]) {
    bool parallel = isinf(camera->distance);
    return camera->scale * (parallel ? 1 : camera->distance / (camera->distance - seen[2]));
}

void vn_camera_project(const vn_camera *camera, const double seen[3], double spot[2]) {
    double scale = vn_camera_scale_at(camera, seen);
    spot[0] = camera->x + scale * seen[0];
    spot[1] = camera->y - scale * seen[1];
}

double vn_camera_limit(const vn_camera *camera) {
    return camera->distance * (1 - 1e-3);
}

double vn_camera_haze(const vn_camera *camera, double depth) {
    double range = camera->nearest - camera->farthest;
    if (camera->fog == 0 || !(range > 0)) {
        return 0;
    }
    return camera->fog * fmin(fmax((camera->nearest - depth) / range, 0), 1);
}
