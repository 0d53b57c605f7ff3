#include "file/svg_shapes.h"

#include <math.h>

static const double pi = 3.14159265358979323846;
static const double mm_per_pixel = 25.4 / 96;

double vn_svg_measure(const vn_svg_tree *tree, int32_t element, vn_svg_name name, double whole,
                      double absent) {
    double value;
    switch (vn_svg_length(vn_svg_value(tree, element, name), &value)) {
    case VN_SVG_NO_LENGTH:
        return absent;
    case VN_SVG_PERCENT:
        return value / 100 * whole;
    default:
        return value;
    }
}

static vn_status draw_ellipse(vn_svg_pen *pen, double cx, double cy, double rx, double ry) {
    if (!(rx > 0) || !(ry > 0)) {
        return VN_OK;
    }
    double center[2] = {cx, cy};
    double radii[2] = {rx, ry};
    VN_TRY(vn_svg_pen_move(pen, cx + rx, cy));
    VN_TRY(vn_svg_pen_arc(pen, center, radii, 0, 0, 2 * pi));
    return vn_svg_pen_close(pen);
}

static vn_status draw_round(vn_svg_pen *pen, const vn_svg_tree *tree, int32_t element,
                            const vn_svg_viewport *viewport) {
    double w = viewport->width, h = viewport->height;
    double cx = vn_svg_measure(tree, element, VN_SVG_CX, w, 0);
    double cy = vn_svg_measure(tree, element, VN_SVG_CY, h, 0);
    if (tree->elements.data[element].kind == VN_SVG_CIRCLE) {
        double r = vn_svg_measure(tree, element, VN_SVG_R, hypot(w, h) / sqrt(2), 0);
        return draw_ellipse(pen, cx, cy, r, r);
    }
    double rx = vn_svg_measure(tree, element, VN_SVG_RX, w, -1);
    double ry = vn_svg_measure(tree, element, VN_SVG_RY, h, -1);
    return draw_ellipse(pen, cx, cy, rx < 0 ? ry : rx, ry < 0 ? rx : ry);
}

static vn_status draw_corner(vn_svg_pen *pen, double cx, double cy, const double radii[2], int quarter) {
    double center[2] = {cx, cy};
    double begin = quarter * pi / 2;
    VN_TRY(vn_svg_pen_line(pen, cx + radii[0] * cos(begin), cy + radii[1] * sin(begin)));
    return radii[0] > 0 && radii[1] > 0 ? vn_svg_pen_arc(pen, center, radii, 0, begin, pi / 2) : VN_OK;
}

static vn_status draw_rectangle(vn_svg_pen *pen, double x, double y, double w, double h,
                                const double radii[2]) {
    double left = x + radii[0], right = x + w - radii[0];
    double top = y + radii[1], bottom = y + h - radii[1];
    VN_TRY(vn_svg_pen_move(pen, x + w, bottom));
    VN_TRY(draw_corner(pen, right, bottom, radii, 0));
    VN_TRY(draw_corner(pen, left, bottom, radii, 1));
    VN_TRY(draw_corner(pen, left, top, radii, 2));
    VN_TRY(draw_corner(pen, right, top, radii, 3));
    return vn_svg_pen_close(pen);
}

static vn_status draw_rect(vn_svg_pen *pen, const vn_svg_tree *tree, int32_t element,
                           const vn_svg_viewport *viewport) {
    double w = vn_svg_measure(tree, element, VN_SVG_WIDTH, viewport->width, 0);
    double h = vn_svg_measure(tree, element, VN_SVG_HEIGHT, viewport->height, 0);
    if (!(w > 0) || !(h > 0)) {
        return VN_OK;
    }
    double x = vn_svg_measure(tree, element, VN_SVG_X, viewport->width, 0);
    double y = vn_svg_measure(tree, element, VN_SVG_Y, viewport->height, 0);
    double rx = vn_svg_measure(tree, element, VN_SVG_RX, viewport->width, -1);
    double ry = vn_svg_measure(tree, element, VN_SVG_RY, viewport->height, -1);
    double radii[2] = {rx < 0 ? ry : rx, ry < 0 ? rx : ry}; // one radius stands for both
    radii[0] = fmin(fmax(radii[0], 0), w / 2);
    radii[1] = fmin(fmax(radii[1], 0), h / 2);
    if (radii[0] == 0 || radii[1] == 0) {
        radii[0] = radii[1] = 0;
    }
    return draw_rectangle(pen, x, y, w, h, radii);
}

static vn_status draw_line(vn_svg_pen *pen, const vn_svg_tree *tree, int32_t element,
                           const vn_svg_viewport *viewport) {
    double w = viewport->width, h = viewport->height;
    VN_TRY(vn_svg_pen_move(pen, vn_svg_measure(tree, element, VN_SVG_X1, w, 0),
                           vn_svg_measure(tree, element, VN_SVG_Y1, h, 0)));
    return vn_svg_pen_line(pen, vn_svg_measure(tree, element, VN_SVG_X2, w, 0),
                           vn_svg_measure(tree, element, VN_SVG_Y2, h, 0));
}

vn_status vn_svg_draw_shape(vn_svg_pen *pen, const vn_svg_tree *tree, int32_t element,
                            const vn_svg_viewport *viewport) {
    const char *data;
    bool closed;
    switch (tree->elements.data[element].kind) {
    case VN_SVG_PATH:
        data = vn_svg_value(tree, element, VN_SVG_D);
        data = data != NULL ? vn_svg_skip(data) : "";
        return *data != '\0' ? vn_svg_draw_path(pen, data) : VN_OK;
    case VN_SVG_POLYGON:
    case VN_SVG_POLYLINE:
        data = vn_svg_value(tree, element, VN_SVG_POINTS);
        closed = tree->elements.data[element].kind == VN_SVG_POLYGON;
        return data != NULL ? vn_svg_draw_points(pen, data, closed) : VN_OK;
    case VN_SVG_LINE:
        return draw_line(pen, tree, element, viewport);
    case VN_SVG_RECT:
        return draw_rect(pen, tree, element, viewport);
    case VN_SVG_CIRCLE:
    case VN_SVG_ELLIPSE:
        return draw_round(pen, tree, element, viewport);
    default:
        return VN_OK;
    }
}

/// min x, min y, width, height.
typedef struct view_box {
    double v[4];
    bool given;
} view_box;

static view_box view_box_of(const vn_svg_tree *tree, int32_t element) {
    view_box box = {{0}, false};
    const char *text = vn_svg_value(tree, element, VN_SVG_VIEW_BOX);
    box.given = text != NULL && vn_svg_numbers(text, 4, box.v) != NULL && box.v[2] > 0 && box.v[3] > 0;
    return box;
}

/// preserveAspectRatio: where the view box lies in its viewport.
typedef struct fit {
    bool stretch, slice;
    double align_x, align_y; ///< 0 at the beginning, 0.5 in the middle, 1 at the end
} fit;

static double alignment(const char *text, const char *axis) {
    const char *at = strstr(text, axis);
    if (at == NULL || strncmp(at + 1, "Mid", 3) == 0) {
        return 0.5;
    }
    return strncmp(at + 1, "Max", 3) == 0 ? 1 : 0;
}

static fit fit_of(const vn_svg_tree *tree, int32_t element) {
    const char *text = vn_svg_value(tree, element, VN_SVG_PRESERVE_ASPECT_RATIO);
    text = text != NULL ? text : "";
    return (fit){
        .stretch = strstr(text, "none") != NULL,
        .slice = strstr(text, "slice") != NULL,
        .align_x = alignment(text, "xM"),
        .align_y = alignment(text, "YM"),
    };
}

static void choose_scale(const fit *f, double *sx, double *sy) {
    if (!f->stretch) {
        double s = f->slice ? fmax(*sx, *sy) : fmin(*sx, *sy);
        *sx = s;
        *sy = s;
    }
}

vn_svg_matrix vn_svg_viewport_matrix(const vn_svg_tree *tree, int32_t element, int32_t use,
                                     vn_svg_viewport *viewport) {
    double w = vn_svg_measure(tree, element, VN_SVG_WIDTH, viewport->width, viewport->width);
    double h = vn_svg_measure(tree, element, VN_SVG_HEIGHT, viewport->height, viewport->height);
    bool is_svg = tree->elements.data[element].kind == VN_SVG_ROOT;
    double x = is_svg ? vn_svg_measure(tree, element, VN_SVG_X, viewport->width, 0) : 0;
    double y = is_svg ? vn_svg_measure(tree, element, VN_SVG_Y, viewport->height, 0) : 0;
    if (use >= 0) {
        w = vn_svg_measure(tree, use, VN_SVG_WIDTH, viewport->width, w);
        h = vn_svg_measure(tree, use, VN_SVG_HEIGHT, viewport->height, h);
    }
    view_box box = view_box_of(tree, element);
    if (!box.given) {
        *viewport = (vn_svg_viewport){w, h};
        return (vn_svg_matrix){1, 0, 0, 1, x, y};
    }
    fit f = fit_of(tree, element);
    double sx = w / box.v[2], sy = h / box.v[3];
    choose_scale(&f, &sx, &sy);
    *viewport = (vn_svg_viewport){box.v[2], box.v[3]};
    x += f.stretch ? 0 : f.align_x * (w - box.v[2] * sx);
    y += f.stretch ? 0 : f.align_y * (h - box.v[3] * sy);
    return (vn_svg_matrix){sx, 0, 0, sy, x - box.v[0] * sx, y - box.v[1] * sy};
}

/// One side of the page: its size in user units (0: unknown) and the millimetres of one of them (0: unknown).
typedef struct page_side {
    double size, mm;
} page_side;

static page_side side_of(const vn_svg_tree *tree, vn_svg_name name, const view_box *box, int index) {
    double pixels;
    vn_svg_unit kind = vn_svg_length(vn_svg_value(tree, 0, name), &pixels);
    bool sized = (kind == VN_SVG_USER || kind == VN_SVG_PHYSICAL) && pixels > 0;
    page_side side = {sized ? pixels : 0, 0};
    if (box->given) {
        side.size = box->v[index];
    }
    if (kind == VN_SVG_PHYSICAL && sized) {
        side.mm = pixels * mm_per_pixel / side.size;
    }
    return side;
}

vn_svg_matrix vn_svg_page_matrix(const vn_svg_tree *tree, vn_svg_viewport *viewport, const char **unit) {
    view_box box = view_box_of(tree, 0);
    page_side width = side_of(tree, VN_SVG_WIDTH, &box, 2);
    page_side height = side_of(tree, VN_SVG_HEIGHT, &box, 3);
    *viewport = (vn_svg_viewport){width.size, height.size};
    *unit = width.mm > 0 ? "mm" : "";
    double sx = 1, sy = 1;
    if (width.mm > 0) {
        fit f = fit_of(tree, 0);
        sx = width.mm;
        sy = height.mm > 0 ? height.mm : sx;
        choose_scale(&f, &sx, &sy);
    }
    double bottom = box.given || height.size > 0 ? box.v[1] + height.size : 0;
    double left = box.given ? box.v[0] : 0;
    return (vn_svg_matrix){sx, 0, 0, -sy, -left * sx, bottom * sy};
}
