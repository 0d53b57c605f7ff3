#include "draw/canvas.h"

#include "domain/rings.h"
#include "draw/chains.h"

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
static const vn_stroke_def stroke_defaults = {.color = "#2f4f2a", .opacity = 1, .min_width = 0.3};
static const vn_field stroke_fields[] = {
    ROW(color, VN_TEXT, 0, 0, 0, "", NULL, "colour of the veins"),
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
};
const vn_schema vn_text_schema =
    VN_SCHEMA("text", "One line of text in DejaVu Sans", text_fields, text_defaults);
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

vn_status vn_canvas_create(vn_canvas **out, const vn_canvas_def *def) {
    *out = NULL;
    vn_canvas made = {0};
    VN_TRY(vn_check_def(&vn_canvas_schema, def));
    VN_TRY(vn_color_parse(&made.background, def->background, "canvas.background"));
    VN_TRY(check_view(&def->view));
    VN_TRY(set_size(&made, def));
    VN_TRY(fit_view(&made, def));
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

// Forget what a call that failed has already put on the list.
static vn_status roll_back(vn_canvas *canvas, int32_t pieces, int32_t points, vn_status status) {
    canvas->pieces.count = pieces;
    canvas->points.count = points;
    return status;
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
        vn_spot spot = vn_canvas_place(canvas, rings->x.data[i], rings->y.data[i]);
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

vn_status vn_canvas_fill(vn_canvas *canvas, const vn_domain *domain, const vn_fill_def *def) {
    int32_t pieces = canvas->pieces.count;
    int32_t points = canvas->points.count;
    vn_item item = {.kind = VN_ITEM_FILL, .opacity = def->opacity, .begin = pieces};
    VN_TRY(vn_check_def(&vn_fill_schema, def));
    VN_TRY(vn_color_parse(&item.color, def->color, "fill.color"));
    VN_TRY(vn_color_parse(&item.outline, def->stroke, "fill.stroke"));
    if (vn_domain_dim(domain) != 2) {
        return vn_fail(VN_INVALID, "fill: a domain of %d dimensions has no area to fill; give a flat one",
                       vn_domain_dim(domain));
    }
    item.size = def->line_width > 0 ? def->line_width * canvas->scale : 1;
    vn_status status = push_outline(canvas, domain);
    item.end = canvas->pieces.count;
    if (status == VN_OK) {
        status = vn_array_push(&canvas->items, item);
    }
    return status == VN_OK ? VN_OK : roll_back(canvas, pieces, points, status);
}

vn_status vn_canvas_stroke(vn_canvas *canvas, const vn_network *network, const vn_stroke_def *def) {
    int32_t pieces = canvas->pieces.count;
    int32_t points = canvas->points.count;
    vn_item item = {.kind = VN_ITEM_STROKE, .opacity = def->opacity, .begin = pieces};
    VN_TRY(vn_check_def(&vn_stroke_schema, def));
    if (!(def->width >= 0 && def->width <= VN_HUGE)) {
        return vn_fail(VN_INVALID, "stroke.width = %g must be 0 or more (length)", def->width);
    }
    VN_TRY(vn_color_parse(&item.color, def->color, "stroke.color"));
    vn_status status = vn_chains_build(canvas, network, def);
    item.end = canvas->pieces.count;
    item.layered = vn_network_orders(network) != NULL;
    if (status == VN_OK) {
        status = vn_array_push(&canvas->items, item);
    }
    return status == VN_OK ? VN_OK : roll_back(canvas, pieces, points, status);
}

static vn_status push_dots(vn_canvas *canvas, const double *x, const double *y, int32_t count) {
    VN_TRY(vn_array_reserve(&canvas->points, (int64_t)canvas->points.count + count));
    for (int32_t i = 0; i < count; i++) {
        if (!isfinite(x[i]) || !isfinite(y[i])) {
            return vn_fail(VN_INVALID, "dots: point %d = (%g, %g) is not finite", i, x[i], y[i]);
        }
        canvas->points.data[canvas->points.count++] = vn_canvas_place(canvas, x[i], y[i]);
    }
    return VN_OK;
}

vn_status vn_canvas_dots(vn_canvas *canvas, const double *x, const double *y, int32_t count,
                         const vn_dots_def *def) {
    int32_t points = canvas->points.count;
    vn_item item = {.kind = VN_ITEM_DOTS, .opacity = def->opacity, .begin = points};
    VN_TRY(vn_check_def(&vn_dots_schema, def));
    VN_TRY(vn_color_parse(&item.color, def->color, "dots.color"));
    item.size = def->radius > 0 ? def->radius * canvas->scale : 2;
    vn_status status = push_dots(canvas, x, y, count);
    item.end = canvas->points.count;
    if (status == VN_OK) {
        status = vn_array_push(&canvas->items, item);
    }
    return status == VN_OK ? VN_OK : roll_back(canvas, canvas->pieces.count, points, status);
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
    return vn_array_push(&canvas->items, *item);
}

vn_status vn_canvas_text(vn_canvas *canvas, const char *text, const vn_text_def *def) {
    int32_t points = canvas->points.count;
    vn_item item = {.kind = VN_ITEM_TEXT, .opacity = def->opacity, .size = def->size, .anchor = def->anchor};
    VN_TRY(vn_check_def(&vn_text_schema, def));
    VN_TRY(vn_color_parse(&item.color, def->color, "text.color"));
    if (!isfinite(def->at[0]) || !isfinite(def->at[1])) {
        return vn_fail(VN_INVALID, "text.at = (%g, %g) is not finite", def->at[0], def->at[1]);
    }
    if (def->anchor < 0 || def->anchor > 2) {
        return vn_fail(VN_INVALID, "text.anchor = %d must be 0 (start), 1 (middle) or 2 (end)", def->anchor);
    }
    item.begin = points;
    item.end = points + 1;
    VN_TRY(vn_array_push(&canvas->points, vn_canvas_place(canvas, def->at[0], def->at[1])));
    vn_status status = push_text(canvas, &item, text);
    if (status != VN_OK) {
        vn_free_text(item.text);
        return roll_back(canvas, canvas->pieces.count, points, status);
    }
    return VN_OK;
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
    return has_extension(path, ".pdf") ? vn_canvas_write_pdf : NULL;
}

vn_status vn_canvas_save(const vn_canvas *canvas, const char *path, const char *manifest) {
    vn_canvas_write_fn *write = writer_for(path);
    if (write == NULL) {
        return vn_fail(VN_INVALID, "%s: a picture is written as .png, .svg or .pdf", path);
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
