#include "draw/canvas.h"

#include "domain/rings.h"
#include "draw/chains.h"
#include "draw/ramp.h"
#include "draw/scene.h"

#include <math.h>

#define ROW(name, type, flags, min, max, unit, kind, doc)                                                    \
    { #name, type, flags, offsetof(ROW_DEF, name), min, max, unit, kind, doc }

// cairo's images end at 32,767; 2^28 pixels are one gigabyte.
#define LARGEST_SIDE 32767.0
#define LARGEST_MARGIN 16383.0
#define MOST_PIXELS 268435456.0
#define DEFAULT_SIDE 800.0

#define ROW_DEF vn_canvas_def
static const vn_canvas_def canvas_defaults = {.margin = 10, .background = "none", .unit = ""};
static const vn_field canvas_fields[] = {
    ROW(width, VN_F64, VN_OPTIONAL, 1, LARGEST_SIDE, "pixels", NULL,
        "width of the picture; left out: from the height and the view's proportions, or 800"),
    ROW(height, VN_F64, VN_OPTIONAL, 1, LARGEST_SIDE, "pixels", NULL,
        "height of the picture; left out: from the width and the view's proportions, or 800"),
    ROW(view, VN_MIXED, 0, 0, 0, "length", "{min = {x, y}, max = {x, y}}, as domain:bounds() gives it",
        "what is fitted, centred, into the canvas; without it, 1 pixel is 1 unit and (0, 0) the lower left "
        "corner"),
    ROW(margin, VN_F64, 0, 0, LARGEST_MARGIN, "pixels", NULL, "kept free around the view"),
    ROW(background, VN_TEXT, 0, 0, 0, "", NULL, "a colour, or \"none\""),
    ROW(unit, VN_TEXT, 0, 0, 0, "", NULL,
        "length unit of the view: \"mm\", \"cm\", \"m\", \"um\", \"in\" or \"pt\"; pages (SVG, PDF) are then "
        "at true "
        "scale; \"\": 96 pixels an inch"),
    ROW(camera, VN_MIXED, 0, 0, 0, "",
        "{from = {x, y, z}, to = {x, y, z}, up = {x, y, z}, fov = 30, zoom = 1, fog = 0}",
        "how to look at space: the eye, what it looks at and what is up (each has a good default), the angle "
        "that is seen in degrees (0: a parallel projection), and how much what is far fades (0 to 1); "
        "without it, from straight above"),
};
const vn_schema vn_canvas_schema =
    VN_SCHEMA("canvas", "A picture to draw on", canvas_fields, canvas_defaults);
#undef ROW_DEF

#define ROW_DEF vn_fill_def
static const vn_fill_def fill_defaults = {.color = "#dfe9c8", .opacity = 1, .stroke = "none"};
static const vn_field fill_fields[] = {
    ROW(color, VN_TEXT, 0, 0, 0, "", NULL, "colour of the inside, or \"none\""),
    ROW(opacity, VN_F64, 0, 0, 1, "", NULL, "0 is invisible, 1 hides what is behind"),
    ROW(stroke, VN_TEXT, 0, 0, 0, "", NULL, "colour of the outline, or \"none\""),
    ROW(line_width, VN_F64, 0, 0, VN_HUGE, "length", NULL, "width of the outline; 0: one pixel"),
};
const vn_schema vn_fill_schema = VN_SCHEMA("fill", "Fill a domain", fill_fields, fill_defaults);
#undef ROW_DEF

#define ROW_DEF vn_stroke_def
static const vn_stroke_def stroke_defaults = {
    .color = "#2f4f2a", .opacity = 1, .min_width = 0.3, .ramp = "#3b5ba5 #5fa8a0 #e3c565 #d9733c #a4262c"};
static const vn_field stroke_fields[] = {
    ROW(color, VN_TEXT, 0, 0, 0, "", NULL, "colour of the veins"),
    {"color_by", VN_MIXED, 0, offsetof(vn_stroke_def, values), 0, 0, "",
     "\"radius\", \"flow\", \"order\", \"tree\", \"birth\", \"pressure\", a list, or a function of the node",
     "what each edge's colour tells, instead of `color`: a column of the network (radius and flow by their "
     "logarithm), or one number or colour a node; numbers have their colour in `ramp`"},
    ROW(ramp, VN_TEXT, 0, 0, 0, "", NULL,
        "colours between spaces, from that of the least number to that of the greatest"),
    ROW(opacity, VN_F64, 0, 0, 1, "", NULL,
        "0 is invisible, 1 hides what is behind; veins that cross do not darken each other"),
    ROW(width, VN_MIXED, 0, 0, 0, "length", "\"radius\", a number, or a function of the node",
        "width of the edges; \"radius\", the default, is twice each edge's radius"),
    ROW(min_width, VN_F64, 0, 0, LARGEST_SIDE, "pixels", NULL,
        "no edge is drawn thinner than this, so that the finest veins do not vanish"),
    ROW(hide_below, VN_F64, 0, 0, LARGEST_SIDE, "pixels", NULL,
        "edges thinner than this are left out, so that a large network makes a small file; 0: none is"),
};
const vn_schema vn_stroke_schema =
    VN_SCHEMA("stroke", "Draw a network's edges", stroke_fields, stroke_defaults);
#undef ROW_DEF

#define ROW_DEF vn_dots_def
static const vn_dots_def dots_defaults = {.color = "#c0392b", .opacity = 1};
static const vn_field dots_fields[] = {
    ROW(color, VN_TEXT, 0, 0, 0, "", NULL, "colour of the dots"),
    ROW(opacity, VN_F64, 0, 0, 1, "", NULL,
        "0 is invisible, 1 hides what is behind; dots that overlap do not darken each other"),
    ROW(radius, VN_F64, 0, 0, VN_HUGE, "length", NULL, "of each dot; 0: two pixels"),
};
const vn_schema vn_dots_schema = VN_SCHEMA("dots", "A dot at each point", dots_fields, dots_defaults);
#undef ROW_DEF

#define ROW_DEF vn_text_def
static const vn_text_def text_defaults = {.color = "#222222", .size = 14, .opacity = 1};
static const vn_field text_fields[] = {
    ROW(at, VN_POINT, 0, 0, 0, "length", NULL, "where the line of text stands, in the view's coordinates"),
    ROW(color, VN_TEXT, 0, 0, 0, "", NULL, "colour of the letters"),
    ROW(size, VN_F64, VN_ABOVE_MIN, 0, LARGEST_SIDE, "pixels", NULL, "height of the letters"),
    ROW(opacity, VN_F64, 0, 0, 1, "", NULL, "0 is invisible, 1 hides what is behind"),
    ROW(anchor, VN_CHOICE, 0, 0, 2, "", "start|middle|end", "which part of the text is at `at`"),
    ROW(angle, VN_F64, 0, -360, 360, "degrees", NULL, "by which the line is turned, counterclockwise"),
};
const vn_schema vn_text_schema =
    VN_SCHEMA("text", "One line of text in DejaVu Sans", text_fields, text_defaults);
#undef ROW_DEF

#define ROW_DEF vn_line_def
static const vn_line_def line_defaults = {.color = "#222222", .opacity = 1, .width = 1, .fill = "none"};
static const vn_field line_fields[] = {
    ROW(color, VN_TEXT, 0, 0, 0, "", NULL, "colour of the line, or \"none\""),
    ROW(opacity, VN_F64, 0, 0, 1, "", NULL, "0 is invisible, 1 hides what is behind"),
    ROW(width, VN_F64, VN_ABOVE_MIN, 0, LARGEST_SIDE, "pixels", NULL, "of the line"),
    ROW(fill, VN_TEXT, 0, 0, 0, "", NULL, "colour of the inside of a line that is then closed, or \"none\""),
};
const vn_schema vn_line_schema = VN_SCHEMA("line", "A line through points", line_fields, line_defaults);
#undef ROW_DEF

vn_canvas_def vn_canvas_def_default(void) {
    return canvas_defaults;
}

vn_fill_def vn_fill_def_default(void) {
    return fill_defaults;
}

vn_stroke_def vn_stroke_def_default(void) {
    return stroke_defaults;
}

vn_dots_def vn_dots_def_default(void) {
    return dots_defaults;
}

vn_text_def vn_text_def_default(void) {
    return text_defaults;
}

vn_line_def vn_line_def_default(void) {
    return line_defaults;
}

typedef struct vn_paper_unit {
    const char *name;
    double meters;
} vn_paper_unit;

static const vn_paper_unit paper_units[] = {{"mm", 1e-3}, {"cm", 1e-2},   {"m", 1},
                                            {"um", 1e-6}, {"in", 0.0254}, {"pt", 0.0254 / 72}};
static const double screen_pixel = 0.0254 / 96;

static vn_status set_paper(vn_canvas *canvas, const char *unit) {
    canvas->meters_a_pixel = screen_pixel;
    if (unit == NULL || unit[0] == '\0') {
        return VN_OK;
    }
    for (size_t i = 0; i < sizeof paper_units / sizeof paper_units[0]; i++) {
        if (strcmp(unit, paper_units[i].name) == 0) {
            canvas->meters_a_pixel = paper_units[i].meters / canvas->scale;
            return VN_OK;
        }
    }
    return vn_fail(
        VN_INVALID,
        "canvas.unit = \"%.40s\" is no length unit of a page: give \"mm\", \"cm\", \"m\", \"um\", \"in\", "
        "\"pt\" or \"\"",
        unit);
}

static bool is_view(const vn_box *view) {
    return view->max[0] > view->min[0] || view->max[1] > view->min[1];
}

static vn_status check_view(const vn_box *view) {
    for (int i = 0; i < 2; i++) {
        double extent = view->max[i] - view->min[i];
        if (!isfinite(extent) || extent < 0) {
            return vn_fail(VN_INVALID,
                           "canvas.view goes from %g to %g in %s: give finite numbers, min below max",
                           view->min[i], view->max[i], i == 0 ? "x" : "y");
        }
    }
    return VN_OK;
}

// The side that was not given: as long as the view is, to the scale that the given one sets.
static double proportional_side(const vn_canvas_def *def, double given, int given_axis) {
    double given_extent = def->view.max[given_axis] - def->view.min[given_axis];
    double extent = def->view.max[1 - given_axis] - def->view.min[1 - given_axis];
    if (!(given_extent > 0)) {
        return DEFAULT_SIDE;
    }
    return fmax(1, 2 * def->margin + (given - 2 * def->margin) * extent / given_extent);
}

static vn_status set_size(vn_canvas *canvas, const vn_canvas_def *def) {
    double width = def->width;
    double height = def->height;
    if (width == 0 && height == 0) {
        width = DEFAULT_SIDE;
    }
    if (def->camera != NULL) { // what it shows has no proportions that are known before
        width = width == 0 ? height : width;
        height = height == 0 ? width : height;
    }
    if (width == 0) {
        width = is_view(&def->view) ? proportional_side(def, height, 1) : DEFAULT_SIDE;
    } else if (height == 0) {
        height = is_view(&def->view) ? proportional_side(def, width, 0) : DEFAULT_SIDE;
    }
    width = floor(width + 0.5);
    height = floor(height + 0.5);
    if (!(width <= LARGEST_SIDE && height <= LARGEST_SIDE && width * height <= MOST_PIXELS)) {
        return vn_fail(
            VN_INVALID,
            "a canvas of %.0f x %.0f pixels is too large: each side may have %.0f, and both together %.0f "
            "(2^28); give a smaller width or height",
            width, height, LARGEST_SIDE, MOST_PIXELS);
    }
    canvas->width = (int32_t)width;
    canvas->height = (int32_t)height;
    return VN_OK;
}

static double side_scale(double room, double extent) {
    return extent > 0 ? room / extent : INFINITY;
}

static vn_status fit_view(vn_canvas *canvas, const vn_canvas_def *def) {
    const vn_box *view = &def->view;
    if (!is_view(view)) {
        canvas->scale = 1;
        canvas->bottom = canvas->height;
        return VN_OK;
    }
    double room_x = canvas->width - 2 * def->margin;
    double room_y = canvas->height - 2 * def->margin;
    if (!(room_x > 0 && room_y > 0)) {
        return vn_fail(VN_INVALID, "canvas.margin = %g pixels leaves nothing of %d x %d pixels for the view",
                       def->margin, canvas->width, canvas->height);
    }
    canvas->scale = fmin(side_scale(room_x, view->max[0] - view->min[0]), //
                         side_scale(room_y, view->max[1] - view->min[1]));
    canvas->left = 0.5 * canvas->width - canvas->scale * (0.5 * view->min[0] + 0.5 * view->max[0]);
    canvas->bottom = 0.5 * canvas->height + canvas->scale * (0.5 * view->min[1] + 0.5 * view->max[1]);
    if (!(canvas->scale > 0) || !isfinite(canvas->scale) || !isfinite(canvas->left) ||
        !isfinite(canvas->bottom)) {
        return vn_fail(VN_INVALID, "canvas.view is too small or too large to draw: use another length unit");
    }
    return VN_OK;
}

static vn_status set_camera(vn_canvas *canvas, const vn_canvas_def *def) {
    VN_TRY(
        vn_camera_set(&canvas->camera, def->camera, &def->view, def->margin, canvas->width, canvas->height));
    canvas->scale = canvas->camera.scale;
    return VN_OK;
}

vn_status vn_canvas_create(vn_canvas **out, const vn_canvas_def *def) {
    *out = NULL;
    vn_canvas made = {0};
    VN_TRY(vn_check_def(&vn_canvas_schema, def));
    VN_TRY(vn_color_parse(&made.background, def->background, "canvas.background"));
    VN_TRY(check_view(&def->view));
    VN_TRY(set_size(&made, def));
    VN_TRY(def->camera != NULL ? set_camera(&made, def) : fit_view(&made, def));
    VN_TRY(set_paper(&made, def->unit));
    vn_canvas *canvas = VN_NEW(vn_canvas);
    if (canvas == NULL) {
        return vn_fail_memory("a canvas", sizeof *canvas);
    }
    *canvas = made;
    *out = canvas;
    return VN_OK;
}

void vn_canvas_destroy(vn_canvas *canvas) {
    if (canvas == NULL) {
        return;
    }
    for (int32_t i = 0; i < canvas->items.count; i++) {
        vn_free_text(canvas->items.data[i].text);
    }
    vn_array_free(&canvas->items);
    vn_array_free(&canvas->pieces);
    vn_array_free(&canvas->points);
    vn_array_free(&canvas->marks);
    VN_DELETE(canvas);
}

double vn_canvas_width(const vn_canvas *canvas) {
    return canvas->width;
}

double vn_canvas_height(const vn_canvas *canvas) {
    return canvas->height;
}

double vn_canvas_scale(const vn_canvas *canvas) {
    return canvas->scale;
}

static double hold(double value) {
    const double far = 4194304;
    return value < -far ? -far : (value > far ? far : value);
}

vn_spot vn_canvas_place(const vn_canvas *canvas, double x, double y) {
    return (vn_spot){hold(canvas->left + canvas->scale * x), hold(canvas->bottom - canvas->scale * y)};
}

bool vn_canvas_place_3(const vn_canvas *canvas, const double p[3], vn_spot *out) {
    if (!canvas->camera.on) {
        *out = vn_canvas_place(canvas, p[0], p[1]);
        return true;
    }
    double seen[3], at[2], limit = vn_camera_limit(&canvas->camera);
    vn_camera_see(&canvas->camera, p, seen);
    bool before = seen[2] <= limit;
    seen[2] = fmin(seen[2], limit);
    vn_camera_project(&canvas->camera, seen, at);
    *out = (vn_spot){hold(at[0]), hold(at[1])};
    return before;
}

static bool replaced_in_xml(const unsigned char *s, int length) {
    return length == 3 && s[0] == 0xEF && s[1] == 0xBF && s[2] >= 0xBE; // U+FFFE and U+FFFF
}

vn_status vn_clean_text(vn_text *out, const char *text) {
    VN_TRY(vn_text_append(out, "", 0));
    while (*text != '\0') {
        const unsigned char *at = (const unsigned char *)text;
        int length = vn_utf8_length(text);
        if (length == 0 || replaced_in_xml(at, length)) {
            VN_TRY(vn_text_append(out, "\xEF\xBF\xBD", 3));
        } else if (at[0] < 0x20 || at[0] == 0x7F) {
            VN_TRY(vn_text_append(out, " ", 1));
        } else {
            VN_TRY(vn_text_append(out, text, (size_t)length));
        }
        text += length > 0 ? length : 1;
    }
    return VN_OK;
}

// How long the lists were before a call.
typedef struct list_ends {
    int32_t pieces, points, marks;
} list_ends;

static list_ends ends_of(const vn_canvas *canvas) {
    return (list_ends){canvas->pieces.count, canvas->points.count, canvas->marks.count};
}

// Take in the item, or forget what a call that failed has already put on the lists.
static vn_status close_item(vn_canvas *canvas, const vn_item *item, list_ends before, vn_status status) {
    if (status == VN_OK) {
        status = item->kind == VN_ITEM_SCENE ? vn_scene_close(canvas, before.marks, item->opacity)
                                             : vn_array_push(&canvas->items, *item);
    }
    if (status != VN_OK) {
        canvas->pieces.count = before.pieces;
        canvas->points.count = before.points;
        canvas->marks.count = before.marks;
    }
    return status;
}

// What a camera sees is one film of the call's opacity and its colour's.
static vn_item scene_of(double opacity, vn_color color) {
    return (vn_item){.kind = VN_ITEM_SCENE, .opacity = opacity * color.alpha / 255.0};
}

static int32_t outline_sides(const vn_canvas *canvas, const vn_domain *domain) {
    vn_box box = vn_domain_bounds(domain);
    double radius = 0.5 * canvas->scale * hypot(box.max[0] - box.min[0], box.max[1] - box.min[1]);
    double sides = 32 + 22 * sqrt(radius); // within about a hundredth of a pixel of the curve
    return sides < 8192 ? (int32_t)sides : 8192;
}

static vn_status push_ring(vn_canvas *canvas, const vn_rings *rings, int32_t ring) {
    vn_piece piece = {.begin = canvas->points.count};
    for (int32_t i = vn_rings_begin(rings, ring); i < rings->ends.data[ring]; i++) {
        const double p[3] = {rings->x.data[i], rings->y.data[i], 0};
        vn_spot spot;
        (void)vn_canvas_place_3(canvas, p, &spot);
        VN_TRY(vn_array_push(&canvas->points, spot));
    }
    piece.count = canvas->points.count - piece.begin;
    return vn_array_push(&canvas->pieces, piece);
}

static vn_status push_outline(vn_canvas *canvas, const vn_domain *domain) {
    vn_rings rings = {0};
    vn_status status = vn_domain_outline(domain, outline_sides(canvas, domain), &rings);
    for (int32_t ring = 0; status == VN_OK && ring < rings.ends.count; ring++) {
        status = push_ring(canvas, &rings, ring);
    }
    vn_rings_free(&rings);
    return status;
}

static vn_status fill_flat(vn_canvas *canvas, const vn_domain *domain, const vn_fill_def *def,
                           vn_item *item) {
    list_ends before = ends_of(canvas);
    item->size = def->line_width > 0 ? def->line_width * canvas->scale : 1;
    item->begin = before.pieces;
    vn_status status = push_outline(canvas, domain);
    item->end = canvas->pieces.count;
    return close_item(canvas, item, before, status);
}

static vn_status fill_solid(vn_canvas *canvas, const vn_domain *domain, const vn_item *item) {
    list_ends before = ends_of(canvas);
    if (!canvas->camera.on) {
        return vn_fail(
            VN_INVALID,
            "fill: a domain of %d dimensions has no area to fill; give a flat one, or the canvas a "
            "camera",
            vn_domain_dim(domain));
    }
    vn_item scene = scene_of(item->opacity, item->color);
    return close_item(canvas, &scene, before, vn_scene_fill(canvas, domain, item->color));
}

vn_status vn_canvas_fill(vn_canvas *canvas, const vn_domain *domain, const vn_fill_def *def) {
    vn_item item = {.kind = VN_ITEM_FILL, .opacity = def->opacity};
    VN_TRY(vn_check_def(&vn_fill_schema, def));
    VN_TRY(vn_color_parse(&item.color, def->color, "fill.color"));
    VN_TRY(vn_color_parse(&item.outline, def->stroke, "fill.stroke"));
    return vn_domain_dim(domain) == 2 ? fill_flat(canvas, domain, def, &item)
                                      : fill_solid(canvas, domain, &item);
}

static vn_status check_stroke(const vn_stroke_def *def) {
    VN_TRY(vn_check_def(&vn_stroke_schema, def));
    if (!(def->width >= 0 && def->width <= VN_HUGE)) {
        return vn_fail(VN_INVALID, "stroke.width = %g must be 0 or more (length)", def->width);
    }
    return VN_OK;
}

static vn_status stroke_flat(vn_canvas *canvas, const vn_network *network, const vn_stroke_def *def,
                             vn_color color) {
    list_ends before = ends_of(canvas);
    vn_item item = {.kind = VN_ITEM_STROKE, .opacity = def->opacity, .begin = before.pieces, .color = color};
    vn_status status = vn_chains_build(canvas, network, def);
    item.end = canvas->pieces.count;
    item.layered = vn_network_orders(network) != NULL;
    item.colored = def->colors != NULL;
    return close_item(canvas, &item, before, status);
}

static vn_status stroke_solid(vn_canvas *canvas, const vn_network *network, const vn_stroke_def *def,
                              vn_color color) {
    list_ends before = ends_of(canvas);
    vn_item scene = scene_of(def->opacity, color);
    return close_item(canvas, &scene, before, vn_scene_stroke(canvas, network, def, color));
}

// The colours that numbers stand for, if any; @p def then has them.
static vn_status find_colors(vn_stroke_def *def, const vn_network *network, vn_color color,
                             vn_rgb_array *colors) {
    vn_values values = {0};
    vn_status status = VN_OK;
    if (def->column != NULL) {
        status = vn_column_values(&values, network, def->column);
        def->values = values.data;
    }
    if (status == VN_OK && def->values != NULL) {
        status = vn_ramp_colors(colors, def->values, vn_network_count(network), def->ramp, color);
        def->colors = colors->data;
    }
    vn_array_free(&values);
    return status;
}

vn_status vn_canvas_stroke(vn_canvas *canvas, const vn_network *network, const vn_stroke_def *def) {
    vn_stroke_def with_colors = *def;
    vn_rgb_array colors = {0};
    vn_color color;
    VN_TRY(check_stroke(def));
    VN_TRY(vn_color_parse(&color, def->color, "stroke.color"));
    vn_status status = find_colors(&with_colors, network, color, &colors);
    if (status == VN_OK) {
        status = (canvas->camera.on ? stroke_solid : stroke_flat)(canvas, network, &with_colors, color);
    }
    vn_array_free(&colors);
    return status;
}

static vn_status check_points(const char *what, const double *x, const double *y, const double *z,
                              int32_t count) {
    for (int32_t i = 0; i < count; i++) {
        if (!isfinite(x[i]) || !isfinite(y[i])) {
            return vn_fail(VN_INVALID, "%s: point %d = (%g, %g) is not finite", what, i, x[i], y[i]);
        }
        if (z != NULL && !isfinite(z[i])) {
            return vn_fail(VN_INVALID, "%s: point %d has z = %g, which is not finite", what, i, z[i]);
        }
    }
    return VN_OK;
}

// Those before the camera.
static vn_status push_points(vn_canvas *canvas, const double *x, const double *y, const double *z,
                             int32_t count) {
    VN_TRY(vn_array_reserve(&canvas->points, (int64_t)canvas->points.count + count));
    for (int32_t i = 0; i < count; i++) {
        const double p[3] = {x[i], y[i], z != NULL ? z[i] : 0};
        vn_spot spot;
        if (vn_canvas_place_3(canvas, p, &spot)) {
            canvas->points.data[canvas->points.count++] = spot;
        }
    }
    return VN_OK;
}

vn_status vn_canvas_dots(vn_canvas *canvas, const double *x, const double *y, const double *z, int32_t count,
                         const vn_dots_def *def) {
    list_ends before = ends_of(canvas);
    vn_item item = {.kind = VN_ITEM_DOTS, .opacity = def->opacity, .begin = before.points};
    VN_TRY(vn_check_def(&vn_dots_schema, def));
    VN_TRY(vn_color_parse(&item.color, def->color, "dots.color"));
    VN_TRY(check_points("dots", x, y, z, count));
    if (canvas->camera.on) {
        vn_item scene = scene_of(def->opacity, item.color);
        return close_item(canvas, &scene, before,
                          vn_scene_dots(canvas, x, y, z, count, def->radius, item.color));
    }
    item.size = def->radius > 0 ? def->radius * canvas->scale : 2;
    vn_status status = push_points(canvas, x, y, z, count);
    item.end = canvas->points.count;
    return close_item(canvas, &item, before, status);
}

// A line is a stroke of one piece; one with an inside is a fill with an outline.
vn_status vn_canvas_line(vn_canvas *canvas, const double *x, const double *y, const double *z, int32_t count,
                         const vn_line_def *def) {
    list_ends before = ends_of(canvas);
    vn_item item = {.kind = VN_ITEM_STROKE, .opacity = def->opacity, .size = def->width};
    vn_piece piece = {.begin = before.points, .width = (float)def->width, .end_width = (float)def->width};
    vn_color inside;
    VN_TRY(vn_check_def(&vn_line_schema, def));
    VN_TRY(vn_color_parse(&item.color, def->color, "line.color"));
    VN_TRY(vn_color_parse(&inside, def->fill, "line.fill"));
    VN_TRY(check_points("line", x, y, z, count));
    if (count < 2) {
        return vn_fail(VN_INVALID, "line: %d points are no line; give two or more", count);
    }
    if (inside.alpha > 0) {
        item.kind = VN_ITEM_FILL;
        item.outline = item.color;
        item.color = inside;
    }
    vn_status status = push_points(canvas, x, y, z, count);
    piece.count = canvas->points.count - before.points;
    if (status == VN_OK && piece.count >= 2) {
        status = vn_array_push(&canvas->pieces, piece);
    }
    item.begin = before.pieces;
    item.end = canvas->pieces.count;
    return close_item(canvas, &item, before, status);
}

// An owned copy of @p text, cleaned; NULL when there is no memory for it.
static char *clean_copy(const char *text) {
    vn_text clean = {0};
    char *copy = vn_clean_text(&clean, text) == VN_OK ? vn_copy_text(clean.data) : NULL;
    vn_array_free(&clean);
    return copy;
}

static vn_status push_text(vn_canvas *canvas, vn_item *item, const char *text) {
    item->text = clean_copy(text);
    if (item->text == NULL) {
        return vn_fail_memory("a text", strlen(text));
    }
    vn_status status = vn_array_push(&canvas->items, *item);
    if (status != VN_OK) {
        vn_free_text(item->text);
    }
    return status;
}

static vn_status check_text(const vn_text_def *def) {
    VN_TRY(vn_check_def(&vn_text_schema, def));
    if (!isfinite(def->at[0]) || !isfinite(def->at[1]) || !isfinite(def->at[2])) {
        return vn_fail(VN_INVALID, "text.at = (%g, %g) is not finite", def->at[0], def->at[1]);
    }
    if (def->anchor < 0 || def->anchor > 2) {
        return vn_fail(VN_INVALID, "text.anchor = %d must be 0 (start), 1 (middle) or 2 (end)", def->anchor);
    }
    return VN_OK;
}

vn_status vn_canvas_text(vn_canvas *canvas, const char *text, const vn_text_def *def) {
    int32_t points = canvas->points.count;
    vn_item item = {.kind = VN_ITEM_TEXT,
                    .opacity = def->opacity,
                    .size = def->size,
                    .anchor = def->anchor,
                    .angle = def->angle,
                    .begin = points,
                    .end = points + 1};
    vn_spot spot;
    VN_TRY(check_text(def));
    VN_TRY(vn_color_parse(&item.color, def->color, "text.color"));
    if (!vn_canvas_place_3(canvas, def->at, &spot)) {
        return VN_OK;
    }
    VN_TRY(vn_array_push(&canvas->points, spot));
    vn_status status = push_text(canvas, &item, text);
    if (status != VN_OK) {
        canvas->points.count = points;
    }
    return status;
}

static bool has_extension(const char *path, const char *extension) {
    size_t length = strlen(path);
    size_t size = strlen(extension);
    if (length <= size || path[length - size - 1] == '/') {
        return false; // a name that is nothing but ".png" has no extension
    }
    for (size_t i = 0; i < size; i++) {
        char c = path[length - size + i];
        if ((c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c) != extension[i]) {
            return false;
        }
    }
    return true;
}

static vn_canvas_write_fn *writer_for(const char *path) {
    if (has_extension(path, ".png")) {
        return vn_canvas_write_png;
    }
    if (has_extension(path, ".svg")) {
        return vn_canvas_write_svg;
    }
    if (has_extension(path, ".eps")) {
        return vn_canvas_write_eps;
    }
    return has_extension(path, ".pdf") ? vn_canvas_write_pdf : NULL;
}

vn_status vn_canvas_save(const vn_canvas *canvas, const char *path, const char *manifest) {
    vn_canvas_write_fn *write = writer_for(path);
    if (write == NULL) {
        return vn_fail(VN_INVALID, "%s: a picture is written as .png, .svg, .pdf or .eps", path);
    }
    vn_text clean = {0};
    vn_sink *sink = NULL;
    vn_status status = manifest != NULL ? vn_clean_text(&clean, manifest) : VN_OK;
    if (status == VN_OK) {
        status = vn_sink_open(&sink, path);
    }
    if (status == VN_OK) {
        status = write(canvas, sink, clean.data);
    }
    status = vn_sink_close(sink, status);
    vn_array_free(&clean);
    return status;
}
