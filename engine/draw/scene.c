#include "draw/scene.h"

#include "base/sort.h"
#include "domain/domain.h"
#include "draw/chains.h"
#include "draw/marks.h"

#include <math.h>

// A stretch of an edge comes nearer by at most so many pixels, or by its radius; no edge has more of them.
static const double LONGEST_RISE = 4;
enum { MOST_STRETCHES = 256, MOST_IN_REACH = 32, POLL_EVERY = 16384 };

// A bend is left without a ball where the gap on its outer side is no wider than this, pixels: stretches
// overlap a little.
static const double LARGEST_GAP = 0.8;

static double square(double x) {
    return x * x;
}

static bool is_off_canvas(const vn_canvas *canvas, const vn_mark *mark, int count) {
    double far = fmaxf(mark->radius[0], mark->radius[1]) + 2;
    bool left = true, right = true, above = true, below = true;
    for (int i = 0; i < count; i++) {
        left = left && mark->at[i].x < -far;
        right = right && mark->at[i].x > canvas->width + far;
        above = above && mark->at[i].y < -far;
        below = below && mark->at[i].y > canvas->height + far;
    }
    return left || right || above || below;
}

// @p count: how many of its places the mark has.
static vn_status push_mark(vn_canvas *canvas, const vn_mark *mark, int count) {
    if (is_off_canvas(canvas, mark, count)) {
        return VN_OK;
    }
    return vn_array_push(&canvas->marks, *mark);
}

static double hold_radius(double radius) {
    return fmin(radius, 1e5);
}

static vn_spot spot_of(const vn_camera *camera, const double seen[3]) {
    double at[2];
    vn_camera_project(camera, seen, at);
    return (vn_spot){fmin(fmax(at[0], -4e6), 4e6), fmin(fmax(at[1], -4e6), 4e6)};
}

// ---- Tubes ----

typedef struct tube {
    double a[3], b[3];             // its ends, as the camera sees them
    double start_width, end_width; // view units
    vn_color color;
    int32_t stretches;
} tube;

typedef struct scene_maker {
    vn_canvas *canvas;
    const vn_network *network;
    const vn_stroke_def *def;
    const int32_t *parent;
    vn_color color;
    vn_widths widths;
    vn_heirs heirs;
    VN_ARRAY(double) seen; // three a node
} scene_maker;

static const double *seen_at(const scene_maker *maker, int32_t node) {
    return maker->seen.data + 3 * (int64_t)node;
}

static vn_color color_of(const scene_maker *maker, int32_t node) {
    return maker->def->colors != NULL ? vn_color_of_rgb(maker->def->colors[node]) : maker->color;
}

static bool is_hidden(const scene_maker *maker, double width) {
    return width * maker->canvas->scale < maker->def->hide_below;
}

static double radius_on_canvas(const scene_maker *maker, double width, const double seen[3]) {
    double radius = 0.5 * width * vn_camera_scale_at(&maker->canvas->camera, seen);
    return hold_radius(fmax(radius, 0.5 * maker->def->min_width));
}

static void between(const double a[3], const double b[3], double t, double out[3]) {
    for (int k = 0; k < 3; k++) {
        out[k] = a[k] + t * (b[k] - a[k]);
    }
}

static double length_of(const tube *t) {
    return sqrt(square(t->b[0] - t->a[0]) + square(t->b[1] - t->a[1]) + square(t->b[2] - t->a[2]));
}

// Let the tube begin later or end earlier.
static void cut(tube *t, double from, double to) {
    tube whole = *t;
    between(whole.a, whole.b, from, t->a);
    between(whole.a, whole.b, to, t->b);
    t->start_width = whole.start_width + from * (whole.end_width - whole.start_width);
    t->end_width = whole.start_width + to * (whole.end_width - whole.start_width);
}

// Without what is too near the eye, or behind it. False when nothing is left.
static bool clip(tube *t, const vn_camera *camera) {
    double limit = vn_camera_limit(camera);
    bool a = t->a[2] <= limit, b = t->b[2] <= limit;
    if (a == b) {
        return a;
    }
    double at = (limit - t->a[2]) / (t->b[2] - t->a[2]);
    cut(t, a ? 0 : at, a ? at : 1);
    t->a[2] = fmin(t->a[2], limit);
    t->b[2] = fmin(t->b[2], limit);
    return true;
}

static bool is_drawn(const scene_maker *maker, int32_t node) {
    return node >= 0 && maker->parent[node] >= 0 && !is_hidden(maker, maker->widths.data[node]);
}

// The width of the vein at a node: that of its own edge, or at a root of its heir's.
static double width_at(const scene_maker *maker, int32_t node) {
    int32_t heir = maker->heirs.data[node];
    return maker->parent[node] >= 0 || heir < 0 ? maker->widths.data[node] : maker->widths.data[heir];
}

// A lateral begins where it comes out of the ball about the node that it leaves.
static bool trim(tube *t, double parent_width) {
    double hidden = 0.5 * sqrt(fmax(0, square(parent_width) - square(t->start_width)));
    double length = length_of(t);
    if (0.9 * hidden >= length) {
        return false;
    }
    cut(t, 0.9 * hidden / length, 1);
    return true;
}

static void count_stretches(const scene_maker *maker, tube *t) {
    double middle[3];
    between(t->a, t->b, 0.5, middle);
    double rise = fabs(t->b[2] - t->a[2]) * vn_camera_scale_at(&maker->canvas->camera, middle);
    double thick = radius_on_canvas(maker, fmin(t->start_width, t->end_width), middle);
    double stretches = ceil(rise / fmax(LONGEST_RISE, thick));
    t->stretches = (int32_t)fmin(fmax(stretches, 1), MOST_STRETCHES);
}

// The tube of a node's edge; false when nothing of it is seen.
static bool tube_of(const scene_maker *maker, int32_t node, tube *t) {
    if (!is_drawn(maker, node)) {
        return false;
    }
    int32_t parent = maker->parent[node];
    bool continues = maker->heirs.data[parent] == node;
    t->end_width = t->start_width = maker->widths.data[node];
    t->color = color_of(maker, node);
    memcpy(t->a, seen_at(maker, parent), sizeof t->a);
    memcpy(t->b, seen_at(maker, node), sizeof t->b);
    if (continues && is_drawn(maker, parent)) {
        t->start_width = maker->widths.data[parent];
    }
    if ((!continues && !trim(t, width_at(maker, parent))) || !clip(t, &maker->canvas->camera)) {
        return false;
    }
    count_stretches(maker, t);
    return true;
}

static double width_along(const tube *t, double at) {
    return t->start_width + at * (t->end_width - t->start_width);
}

static double depth_of(const tube *t, int32_t stretch) {
    double at = (stretch + 0.5) / t->stretches, middle[3];
    between(t->a, t->b, at, middle);
    return middle[2] + 0.5 * width_along(t, at);
}

// The sine of the angle by which the way from @p a to @p b comes nearer to the eye.
static double slope_of(const vn_camera *camera, const double a[3], const double b[3]) {
    double d[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, eye[3] = {0, 0, 1};
    if (!isinf(camera->distance)) {
        between(a, b, 0.5, eye);
        eye[0] = -eye[0];
        eye[1] = -eye[1];
        eye[2] = camera->distance - eye[2];
    }
    double length = sqrt((d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) *
                         (eye[0] * eye[0] + eye[1] * eye[1] + eye[2] * eye[2]));
    return length > 0 ? (d[0] * eye[0] + d[1] * eye[1] + d[2] * eye[2]) / length : 0;
}

static vn_status push_stretch(scene_maker *maker, const tube *t, int32_t stretch) {
    const vn_camera *camera = &maker->canvas->camera;
    double ends[2] = {(double)stretch / t->stretches, (stretch + 1.0) / t->stretches}, seen[2][3];
    vn_mark mark = {.kind = VN_MARK_TUBE, .color = t->color, .depth = depth_of(t, stretch)};
    for (int i = 0; i < 2; i++) {
        between(t->a, t->b, ends[i], seen[i]);
        mark.at[i] = spot_of(camera, seen[i]);
        mark.radius[i] = (float)radius_on_canvas(maker, width_along(t, ends[i]), seen[i]);
    }
    mark.slope = (float)slope_of(camera, seen[0], seen[1]);
    mark.haze = (float)vn_camera_haze(camera, 0.5 * seen[0][2] + 0.5 * seen[1][2]);
    return push_mark(maker->canvas, &mark, 2);
}

static vn_status push_tube(scene_maker *maker, const tube *t) {
    for (int32_t i = 0; i < t->stretches; i++) {
        VN_TRY(push_stretch(maker, t, i));
    }
    return VN_OK;
}

// Whether two tubes that follow one another leave no gap that anybody would see.
static bool is_straight(const tube *in, const tube *out, double radius) {
    double turn = 0, lengths[2] = {length_of(in), length_of(out)};
    for (int k = 0; k < 3; k++) {
        turn += square((in->b[k] - in->a[k]) / lengths[0] - (out->b[k] - out->a[k]) / lengths[1]);
    }
    return radius * sqrt(turn) < LARGEST_GAP;
}

static double distance2(const double a[3], const double b[3]) {
    return square(a[0] - b[0]) + square(a[1] - b[1]) + square(a[2] - b[2]);
}

// The least depth of what a vein has within @p reach of a node on its way on, or on its way back. Where edges
// are much shorter than they are thick, some of it is not looked at.
static double depth_in_reach(const scene_maker *maker, int32_t node, bool back, double reach) {
    const double *middle = seen_at(maker, node);
    double least = INFINITY;
    for (int i = 0; i < MOST_IN_REACH; i++) {
        int32_t next = back ? maker->parent[node] : maker->heirs.data[node];
        int32_t edge = back ? node : next;
        if (!is_drawn(maker, edge)) {
            break;
        }
        const double *a = seen_at(maker, node), *b = seen_at(maker, next);
        least = fmin(least, fmin(a[2], b[2]) + 0.5 * maker->widths.data[edge]);
        if (distance2(b, middle) > square(reach) || (back && maker->heirs.data[next] != node)) {
            break;
        }
        node = next;
    }
    return least;
}

// A ball in a bend comes before one at an end that is near: what of it is beyond that end is not seen.
static double ball_depth(const scene_maker *maker, int32_t node, bool bend) {
    double reach = (bend ? 1 : 0.5) * width_at(maker, node);
    double least = fmin(depth_in_reach(maker, node, true, reach), depth_in_reach(maker, node, false, reach));
    least = nextafter(least, -INFINITY);
    return bend ? nextafter(least, -INFINITY) : least;
}

// The ball in which a vein turns or ends. It is painted before what the vein has in the ball's reach, and
// that leaves just so much of it uncovered as is seen; what shines there is in the same light as the tubes
// are.
static vn_status push_ball(scene_maker *maker, int32_t node) {
    const double *seen = seen_at(maker, node);
    double width = width_at(maker, node);
    int32_t heir = maker->heirs.data[node];
    tube in, out;
    bool comes = tube_of(maker, node, &in), goes = tube_of(maker, heir, &out);
    if ((!comes && !goes) || seen[2] > vn_camera_limit(&maker->canvas->camera)) {
        return VN_OK;
    }
    double radius = radius_on_canvas(maker, width, seen);
    if (comes && goes && is_straight(&in, &out, radius)) {
        return VN_OK;
    }
    vn_mark mark = {.kind = VN_MARK_BALL, .radius = {(float)radius, (float)radius}};
    mark.depth = ball_depth(maker, node, comes && goes);
    mark.at[0] = spot_of(&maker->canvas->camera, seen);
    mark.color = comes ? in.color : out.color;
    mark.haze = (float)vn_camera_haze(&maker->canvas->camera, seen[2]);
    return push_mark(maker->canvas, &mark, 1);
}

static vn_status push_nodes(scene_maker *maker) {
    tube t;
    for (int32_t i = 0; i < maker->heirs.count; i++) {
        if (i % POLL_EVERY == 0) {
            VN_TRY(vn_poll());
        }
        VN_TRY(push_ball(maker, i));
        if (tube_of(maker, i, &t)) {
            VN_TRY(push_tube(maker, &t));
        }
    }
    return VN_OK;
}

static vn_status push_joins(scene_maker *maker) {
    int32_t count = vn_network_join_count(maker->network);
    for (int32_t i = 0; i < count; i++) {
        vn_join_line line = vn_join_line_at(maker->network, maker->def, &maker->widths, i);
        tube t = {.start_width = line.width, .end_width = line.width, .color = color_of(maker, line.b)};
        memcpy(t.a, seen_at(maker, line.a), sizeof t.a);
        memcpy(t.b, seen_at(maker, line.b), sizeof t.b);
        if (!is_hidden(maker, line.width) && clip(&t, &maker->canvas->camera)) {
            count_stretches(maker, &t);
            VN_TRY(push_tube(maker, &t));
        }
    }
    return VN_OK;
}

static vn_status see_nodes(scene_maker *maker) {
    const double *x = vn_network_x(maker->network), *y = vn_network_y(maker->network);
    const double *z = vn_network_z(maker->network);
    int32_t count = vn_network_count(maker->network);
    VN_TRY(vn_array_reserve(&maker->seen, 3 * (int64_t)count));
    for (int32_t i = 0; i < count; i++) {
        const double p[3] = {x[i], y[i], z != NULL ? z[i] : 0};
        vn_camera_see(&maker->canvas->camera, p, maker->seen.data + 3 * (int64_t)i);
    }
    return VN_OK;
}

static vn_status make_scene(scene_maker *maker) {
    VN_TRY(vn_stroke_widths(maker->network, maker->def, &maker->widths));
    VN_TRY(vn_find_heirs(maker->network, &maker->widths, &maker->heirs));
    VN_TRY(see_nodes(maker));
    VN_TRY(push_nodes(maker));
    return push_joins(maker);
}

vn_status vn_scene_stroke(vn_canvas *canvas, const vn_network *network, const vn_stroke_def *def,
                          vn_color color) {
    scene_maker maker = {.canvas = canvas, .network = network, .def = def, .color = color};
    maker.parent = vn_network_parent(network);
    vn_status status = make_scene(&maker);
    vn_array_free(&maker.widths);
    vn_array_free(&maker.heirs);
    vn_array_free(&maker.seen);
    return status;
}

// ---- Dots and surfaces ----

static vn_status push_dot(vn_canvas *canvas, const double p[3], double radius, vn_color color) {
    vn_mark mark = {.kind = radius > 0 ? VN_MARK_BALL : VN_MARK_DOT, .color = color};
    double seen[3];
    vn_camera_see(&canvas->camera, p, seen);
    if (seen[2] > vn_camera_limit(&canvas->camera)) {
        return VN_OK;
    }
    double pixels = radius > 0 ? hold_radius(radius * vn_camera_scale_at(&canvas->camera, seen)) : 2;
    mark.depth = seen[2] + radius;
    mark.at[0] = spot_of(&canvas->camera, seen);
    mark.radius[0] = mark.radius[1] = (float)pixels;
    mark.haze = (float)vn_camera_haze(&canvas->camera, seen[2]);
    return push_mark(canvas, &mark, 1);
}

vn_status vn_scene_dots(vn_canvas *canvas, const double *x, const double *y, const double *z, int32_t count,
                        double radius, vn_color color) {
    for (int32_t i = 0; i < count; i++) {
        const double p[3] = {x[i], y[i], z != NULL ? z[i] : 0};
        if (i % POLL_EVERY == 0) {
            VN_TRY(vn_poll());
        }
        VN_TRY(push_dot(canvas, p, radius, color));
    }
    return VN_OK;
}

// Both sides of a triangle are lit: surfaces may be open, and turned either way.
static double light_on(const double a[3], const double b[3], const double c[3]) {
    double u[3], v[3];
    for (int k = 0; k < 3; k++) {
        u[k] = b[k] - a[k];
        v[k] = c[k] - a[k];
    }
    double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    double length = sqrt(square(n[0]) + square(n[1]) + square(n[2]));
    for (int k = 0; k < 3; k++) {
        n[k] /= n[2] < 0 ? -length : length;
    }
    return length > 0 ? fmax(0, vn_light_on(n)) : 0;
}

static vn_status push_face(vn_canvas *canvas, const vn_triangles *from, int32_t face, vn_color color) {
    vn_mark mark = {.kind = VN_MARK_FACE, .color = color};
    double seen[3][3], depth = 0;
    for (int i = 0; i < 3; i++) {
        int64_t corner = from->corners.data[3 * (int64_t)face + i];
        vn_camera_see(&canvas->camera, from->xyz.data + 3 * corner, seen[i]);
        if (seen[i][2] > vn_camera_limit(&canvas->camera)) {
            return VN_OK;
        }
        mark.at[i] = spot_of(&canvas->camera, seen[i]);
        depth += seen[i][2] / 3;
    }
    mark.depth = depth;
    mark.light = (float)light_on(seen[0], seen[1], seen[2]);
    mark.haze = (float)vn_camera_haze(&canvas->camera, depth);
    return push_mark(canvas, &mark, 3);
}

static vn_status push_faces(vn_canvas *canvas, const vn_triangles *from, vn_color color) {
    for (int32_t i = 0; i < from->corners.count / 3; i++) {
        if (i % POLL_EVERY == 0) {
            VN_TRY(vn_poll());
        }
        VN_TRY(push_face(canvas, from, i, color));
    }
    return VN_OK;
}

vn_status vn_scene_fill(vn_canvas *canvas, const vn_domain *domain, vn_color color) {
    vn_triangles triangles = {0};
    vn_status status = vn_domain_triangles(domain, &triangles);
    if (status == VN_OK) {
        status = push_faces(canvas, &triangles, color);
    }
    vn_triangles_free(&triangles);
    return status;
}

// ---- From far to near ----

// Keys that compare as the numbers do.
static uint64_t key_of(double depth) {
    uint64_t bits;
    const uint64_t sign = (uint64_t)1 << 63;
    double value = depth + 0.0; // without -0
    memcpy(&bits, &value, sizeof bits);
    return bits & sign ? ~bits : bits | sign;
}

static vn_status sort_keys(vn_keyed_array *order, const vn_mark *marks, int32_t count) {
    vn_keyed_array scratch = {0};
    VN_TRY(vn_array_reserve(order, count));
    for (int32_t i = 0; i < count; i++) {
        order->data[order->count++] = (vn_keyed){key_of(marks[i].depth), i};
    }
    vn_status status = vn_sort_keyed(order, &scratch);
    vn_array_free(&scratch);
    return status;
}

static vn_status permute_marks(vn_mark *marks, const vn_keyed_array *order) {
    VN_ARRAY(vn_mark) sorted = {0};
    VN_TRY(vn_array_reserve(&sorted, order->count));
    for (int32_t i = 0; i < order->count; i++) {
        sorted.data[i] = marks[order->data[i].value];
    }
    // NOLINTNEXTLINE(clang-analyzer-core.NonNullParamChecker): there are marks, so there is room for them
    memcpy(marks, sorted.data, (size_t)order->count * sizeof *marks);
    vn_array_free(&sorted);
    return VN_OK;
}

static vn_status sort_marks(vn_mark *marks, int32_t count) {
    vn_keyed_array order = {0};
    if (count == 0) {
        return VN_OK;
    }
    vn_status status = sort_keys(&order, marks, count);
    if (status == VN_OK) {
        status = permute_marks(marks, &order);
    }
    vn_array_free(&order);
    return status;
}

vn_status vn_scene_close(vn_canvas *canvas, int32_t begin, double opacity) {
    vn_item *last = canvas->items.count > 0 ? &canvas->items.data[canvas->items.count - 1] : NULL;
    bool one = last != NULL && last->kind == VN_ITEM_SCENE && last->opacity == 1 && opacity == 1;
    if (one) {
        VN_TRY(sort_marks(canvas->marks.data + last->begin, canvas->marks.count - last->begin));
        last->end = canvas->marks.count;
        return VN_OK;
    }
    vn_item item = {.kind = VN_ITEM_SCENE, .opacity = opacity, .begin = begin, .end = canvas->marks.count};
    item.color.alpha = 255;
    VN_TRY(sort_marks(canvas->marks.data + begin, canvas->marks.count - begin));
    // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): pushing makes the room
    return vn_array_push(&canvas->items, item);
}
