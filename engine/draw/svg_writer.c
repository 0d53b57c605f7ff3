#include "draw/marks.h"
#include "draw/taper.h"

// Points of chains are rounded to 0.01 pixels, tapers finer: where an arc is almost half a circle, its ends
// tell its centre badly. A canvas of few pixels is meant to be enlarged.
enum { SPOT_DECIMALS = 2, FINE_DECIMALS = 3, SMALL_SIDE = 500, POLL_EVERY = 16384 };

// Collects bytes for the sink; its status is sticky, so that writers need no checks of their own.
typedef struct svg_pen {
    vn_sink *sink;
    vn_status status;
    int decimals; // of a chain's points
    size_t count;
    char bytes[16384];
} svg_pen;

static void pen_flush(svg_pen *pen) {
    if (pen->status == VN_OK && pen->count > 0) {
        pen->status = vn_sink_write(pen->sink, pen->bytes, pen->count);
    }
    pen->count = 0;
}

static void put_byte(svg_pen *pen, char byte) {
    if (pen->count == sizeof pen->bytes) {
        pen_flush(pen);
    }
    pen->bytes[pen->count++] = byte;
}

static void put(svg_pen *pen, const char *text) {
    while (*text != '\0') {
        put_byte(pen, *text++);
    }
}

// Text between tags, where quotes may stand.
static void put_escaped(svg_pen *pen, const char *text) {
    for (; *text != '\0'; text++) {
        switch (*text) {
        case '&':
            put(pen, "&amp;");
            break;
        case '<':
            put(pen, "&lt;");
            break;
        case '>':
            put(pen, "&gt;");
            break;
        default:
            put_byte(pen, *text);
        }
    }
}

// An integer number of 10^-decimals, in its shortest form: "-.5", "12", "0".
static void put_steps(svg_pen *pen, int64_t steps, int decimals) {
    char digits[32];
    char *at = digits + sizeof digits;
    uint64_t left = steps < 0 ? -(uint64_t)steps : (uint64_t)steps;
    while (decimals > 0 && left % 10 == 0) {
        left /= 10;
        decimals--;
    }
    *--at = '\0';
    for (; decimals > 0; decimals--, left /= 10) {
        *--at = (char)('0' + left % 10);
        if (decimals == 1) {
            *--at = '.';
        }
    }
    for (; left > 0; left /= 10) {
        *--at = (char)('0' + left % 10);
    }
    if (steps < 0) {
        *--at = '-';
    }
    put(pen, steps == 0 ? "0" : at);
}

static int64_t steps_of(double value, int decimals) {
    static const double powers[] = {1, 10, 100, 1e3, 1e4, 1e5, 1e6};
    return (int64_t)floor(value * powers[decimals] + 0.5);
}

static void put_fixed(svg_pen *pen, double value, int decimals) {
    put_steps(pen, steps_of(value, decimals), decimals);
}

static void put_attribute(svg_pen *pen, const char *name, double value, int decimals) {
    put_byte(pen, ' ');
    put(pen, name);
    put(pen, "=\"");
    put_fixed(pen, value, decimals);
    put_byte(pen, '"');
}

static void put_color(svg_pen *pen, const char *name, vn_color color) {
    char text[48];
    snprintf(text, sizeof text, " %s=\"#%02x%02x%02x\"", name, color.red, color.green, color.blue);
    put(pen, color.alpha > 0 ? text : "");
}

// A pair that follows a letter: the sign of the second number separates them when it has one.
static void put_pair(svg_pen *pen, int64_t x, int64_t y, int decimals) {
    put_steps(pen, x, decimals);
    if (y >= 0) {
        put_byte(pen, ' ');
    }
    put_steps(pen, y, decimals);
}

static void put_spot(svg_pen *pen, vn_spot spot, int decimals) {
    put_pair(pen, steps_of(spot.x, decimals), steps_of(spot.y, decimals), decimals);
}

// "M x y l dx dy dx dy …". Places are rounded before differences are taken, so that rounding does not add up.
static void put_ring(svg_pen *pen, const vn_spot *spots, int32_t count) {
    int64_t x = steps_of(spots[0].x, pen->decimals);
    int64_t y = steps_of(spots[0].y, pen->decimals);
    bool moved = false;
    put_byte(pen, 'M');
    put_pair(pen, x, y, pen->decimals);
    for (int32_t i = 1; i < count; i++) {
        int64_t dx = steps_of(spots[i].x, pen->decimals) - x;
        int64_t dy = steps_of(spots[i].y, pen->decimals) - y;
        if (dx == 0 && dy == 0 && (moved || i + 1 < count)) {
            continue; // but one segment stays, if only for its round ends
        }
        if (!moved || dx >= 0) {
            put_byte(pen, moved ? ' ' : 'l');
        }
        put_pair(pen, dx, dy, pen->decimals);
        moved = true;
        x += dx;
        y += dy;
    }
}

static void put_polyline(svg_pen *pen, const vn_canvas *canvas, const vn_piece *piece) {
    put_ring(pen, canvas->points.data + piece->begin, piece->count);
}

static void put_chain(svg_pen *pen, const vn_canvas *canvas, const vn_piece *piece, bool with_width) {
    put(pen, "<path");
    if (with_width) {
        put_attribute(pen, "stroke-width", piece->width, FINE_DECIMALS);
    }
    put(pen, " d=\"");
    put_polyline(pen, canvas, piece);
    put(pen, "\"/>\n");
}

static void put_arc(svg_pen *pen, double radius, bool large, vn_spot to) {
    put_byte(pen, 'A');
    put_pair(pen, steps_of(radius, FINE_DECIMALS), steps_of(radius, FINE_DECIMALS), FINE_DECIMALS);
    put(pen, large ? " 0 1 1 " : " 0 0 1 ");
    put_spot(pen, to, FINE_DECIMALS);
}

static void put_circle(svg_pen *pen, vn_spot center, double radius, vn_color color) {
    put(pen, "<circle");
    put_color(pen, "fill", color);
    put_attribute(pen, "cx", center.x, FINE_DECIMALS);
    put_attribute(pen, "cy", center.y, FINE_DECIMALS);
    put_attribute(pen, "r", radius, FINE_DECIMALS);
    put(pen, "/>\n");
}

static void put_taper(svg_pen *pen, const vn_canvas *canvas, const vn_piece *piece) {
    vn_taper taper = vn_taper_of(canvas, piece);
    if (taper.whole >= 0) {
        put_circle(pen, taper.center[taper.whole], taper.radius[taper.whole], piece->color);
        return;
    }
    bool narrows = taper.radius[0] > taper.radius[1];
    put(pen, "<path");
    put_color(pen, "fill", piece->color);
    put(pen, " d=\"M");
    put_spot(pen, vn_taper_spot(&taper, 0, taper.axis + taper.turn), FINE_DECIMALS);
    put_arc(pen, taper.radius[0], narrows, vn_taper_spot(&taper, 0, taper.axis - taper.turn));
    put_byte(pen, 'L');
    put_spot(pen, vn_taper_spot(&taper, 1, taper.axis - taper.turn), FINE_DECIMALS);
    put_arc(pen, taper.radius[1], !narrows, vn_taper_spot(&taper, 1, taper.axis + taper.turn));
    put(pen, "z\"/>\n");
}

// Chains [begin, end) of one width: several share a group, which is shorter than a width on each.
static vn_status put_run(svg_pen *pen, const vn_canvas *canvas, int32_t begin, int32_t end) {
    const vn_piece *pieces = canvas->pieces.data;
    bool grouped = end - begin > 1 || pieces[begin].color.alpha > 0;
    if (grouped) {
        put(pen, "<g");
        put_attribute(pen, "stroke-width", pieces[begin].width, FINE_DECIMALS);
        put_color(pen, "stroke", pieces[begin].color);
        put(pen, ">\n");
    }
    for (int32_t i = begin; i < end && pen->status == VN_OK; i++) {
        if (i % POLL_EVERY == 0) {
            VN_TRY(vn_poll());
        }
        put_chain(pen, canvas, &pieces[i], !grouped);
    }
    put(pen, grouped ? "</g>\n" : "");
    return pen->status;
}

static vn_status put_chains(svg_pen *pen, const vn_canvas *canvas, int32_t begin, int32_t end) {
    const vn_piece *pieces = canvas->pieces.data;
    while (begin < end) {
        int32_t run = begin + 1;
        while (run < end && vn_piece_is_like(&pieces[run], &pieces[begin])) {
            run++;
        }
        VN_TRY(put_run(pen, canvas, begin, run));
        begin = run;
    }
    return VN_OK;
}

// Tapers [begin, end): areas, not lines, though in the lines' colour.
static vn_status put_tapers(svg_pen *pen, const vn_canvas *canvas, vn_color color, int32_t begin,
                            int32_t end) {
    if (begin == end) {
        return VN_OK;
    }
    put(pen, "<g stroke=\"none\"");
    put_color(pen, "fill", color);
    put(pen, ">\n");
    for (int32_t i = begin; i < end && pen->status == VN_OK; i++) {
        if (i % POLL_EVERY == 0) {
            VN_TRY(vn_poll());
        }
        put_taper(pen, canvas, &canvas->pieces.data[i]);
    }
    put(pen, "</g>\n");
    return pen->status;
}

// The pieces of one vein order, [begin, end): tapers come first.
static vn_status put_order(svg_pen *pen, const vn_canvas *canvas, vn_color color, int32_t begin,
                           int32_t end) {
    int32_t chains = begin;
    while (chains < end && vn_piece_tapers(&canvas->pieces.data[chains])) {
        chains++;
    }
    VN_TRY(put_tapers(pen, canvas, color, begin, chains));
    return put_chains(pen, canvas, chains, end);
}

static void open_layer(svg_pen *pen, const char *label) {
    put(pen, "<g inkscape:groupmode=\"layer\" inkscape:label=\"");
    put(pen, label);
    put_byte(pen, '"');
}

static vn_status put_layer(svg_pen *pen, const vn_canvas *canvas, vn_color color, int32_t begin,
                           int32_t end) {
    char label[32];
    snprintf(label, sizeof label, "order %d", canvas->pieces.data[begin].order);
    open_layer(pen, canvas->pieces.data[begin].order > 0 ? label : "joins");
    put(pen, ">\n");
    VN_TRY(put_order(pen, canvas, color, begin, end));
    put(pen, "</g>\n");
    return pen->status;
}

static vn_status put_layers(svg_pen *pen, const vn_canvas *canvas, const vn_item *item) {
    const vn_piece *pieces = canvas->pieces.data;
    for (int32_t begin = item->begin, end; begin < item->end; begin = end) {
        end = begin + 1;
        while (end < item->end && pieces[end].order == pieces[begin].order) {
            end++;
        }
        VN_TRY(put_layer(pen, canvas, item->color, begin, end));
    }
    return VN_OK;
}

static void put_opacity(svg_pen *pen, double opacity) {
    if (opacity < 1) {
        put_attribute(pen, "opacity", opacity, 4);
    }
}

static double alpha_of(const vn_item *item) {
    return item->opacity * item->color.alpha / 255.0;
}

static vn_status put_stroke(svg_pen *pen, const vn_canvas *canvas, const vn_item *item) {
    open_layer(pen, item->size > 0 ? "line" : "network");
    put(pen, " fill=\"none\"");
    put_color(pen, "stroke", item->color);
    put(pen, " stroke-linecap=\"round\" stroke-linejoin=\"round\"");
    put_opacity(pen, alpha_of(item));
    put(pen, ">\n");
    VN_TRY(item->layered ? put_layers(pen, canvas, item)
                         : put_order(pen, canvas, item->color, item->begin, item->end));
    put(pen, "</g>\n");
    return pen->status;
}

static void put_outline_style(svg_pen *pen, const vn_item *item) {
    if (item->outline.alpha == 0) {
        return;
    }
    put_color(pen, "stroke", item->outline);
    put_attribute(pen, "stroke-width", item->size, FINE_DECIMALS);
    put(pen, " stroke-linejoin=\"round\"");
    if (item->outline.alpha < 255) {
        put_attribute(pen, "stroke-opacity", item->outline.alpha / 255.0, 4);
    }
}

static vn_status put_fill(svg_pen *pen, const vn_canvas *canvas, const vn_item *item) {
    put(pen, "<path fill-rule=\"evenodd\"");
    put_color(pen, "fill", item->color);
    put(pen, item->color.alpha == 0 ? " fill=\"none\"" : "");
    if (item->color.alpha > 0 && item->color.alpha < 255) {
        put_attribute(pen, "fill-opacity", item->color.alpha / 255.0, 4);
    }
    put_outline_style(pen, item);
    put_opacity(pen, item->opacity);
    put(pen, " d=\"");
    for (int32_t i = item->begin; i < item->end; i++) {
        put_polyline(pen, canvas, &canvas->pieces.data[i]);
        put_byte(pen, 'z');
    }
    put(pen, "\"/>\n");
    return pen->status;
}

static vn_status put_dots(svg_pen *pen, const vn_canvas *canvas, const vn_item *item) {
    open_layer(pen, "dots");
    put_color(pen, "fill", item->color);
    put_opacity(pen, alpha_of(item));
    put(pen, ">\n");
    for (int32_t i = item->begin; i < item->end && pen->status == VN_OK; i++) {
        if (i % POLL_EVERY == 0) {
            VN_TRY(vn_poll());
        }
        put_circle(pen, canvas->points.data[i], item->size, (vn_color){0});
    }
    put(pen, "</g>\n");
    return pen->status;
}

// One area of a scene: "<path fill="#…" d="M…z"/>".
static void put_area(void *payload, const vn_spot *ring, int32_t count, vn_color color) {
    svg_pen *pen = payload;
    put(pen, "<path");
    put_color(pen, "fill", color);
    put(pen, " d=\"");
    put_ring(pen, ring, count);
    put(pen, "z\"/>\n");
}

static vn_status put_scene(svg_pen *pen, const vn_canvas *canvas, const vn_item *item) {
    open_layer(pen, "scene");
    put_opacity(pen, item->opacity);
    put(pen, ">\n");
    for (int32_t i = item->begin; i < item->end && pen->status == VN_OK; i++) {
        if (i % POLL_EVERY == 0) {
            VN_TRY(vn_poll());
        }
        vn_mark_paint(canvas, &canvas->marks.data[i], put_area, pen);
    }
    put(pen, "</g>\n");
    return pen->status;
}

static void put_turn(svg_pen *pen, const vn_canvas *canvas, const vn_item *item) {
    if (item->angle != 0) {
        put(pen, " transform=\"rotate(");
        put_fixed(pen, -item->angle, FINE_DECIMALS);
        put_byte(pen, ' ');
        put_spot(pen, canvas->points.data[item->begin], FINE_DECIMALS);
        put(pen, ")\"");
    }
}

static vn_status put_text(svg_pen *pen, const vn_canvas *canvas, const vn_item *item) {
    static const char *const anchors[] = {"start", "middle", "end"};
    put(pen, "<text xml:space=\"preserve\" font-family=\"DejaVu Sans, sans-serif\" text-anchor=\"");
    put(pen, anchors[item->anchor]);
    put_byte(pen, '"');
    put_attribute(pen, "font-size", item->size, FINE_DECIMALS);
    put_attribute(pen, "x", canvas->points.data[item->begin].x, FINE_DECIMALS);
    put_attribute(pen, "y", canvas->points.data[item->begin].y, FINE_DECIMALS);
    put_turn(pen, canvas, item);
    put_color(pen, "fill", item->color);
    put_opacity(pen, alpha_of(item));
    put_byte(pen, '>');
    put_escaped(pen, item->text);
    put(pen, "</text>\n");
    return pen->status;
}

static vn_status put_item(svg_pen *pen, const vn_canvas *canvas, const vn_item *item) {
    VN_TRY(vn_poll());
    switch (item->kind) {
    case VN_ITEM_FILL:
        return item->opacity > 0 ? put_fill(pen, canvas, item) : VN_OK;
    case VN_ITEM_STROKE:
        return alpha_of(item) > 0 ? put_stroke(pen, canvas, item) : VN_OK;
    case VN_ITEM_DOTS:
        return alpha_of(item) > 0 ? put_dots(pen, canvas, item) : VN_OK;
    case VN_ITEM_SCENE:
        return item->opacity > 0 ? put_scene(pen, canvas, item) : VN_OK;
    default:
        return alpha_of(item) > 0 ? put_text(pen, canvas, item) : VN_OK;
    }
}

static void put_page_side(svg_pen *pen, const char *name, double meters) {
    char number[VN_NUMBER_SIZE];
    vn_format_rounded(number, meters * 1000, 6);
    put_byte(pen, ' ');
    put(pen, name);
    put(pen, "=\"");
    put(pen, number);
    put(pen, "mm\"");
}

static void put_head(svg_pen *pen, const vn_canvas *canvas, const char *manifest) {
    char view[64];
    put(pen, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
             "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" version=\"1.1\"");
    put_page_side(pen, "width", canvas->width * canvas->meters_a_pixel);
    put_page_side(pen, "height", canvas->height * canvas->meters_a_pixel);
    snprintf(view, sizeof view, " viewBox=\"0 0 %d %d\">\n", canvas->width, canvas->height);
    put(pen, view);
    put(pen, "<title>Venule</title>\n");
    if (manifest != NULL) {
        put(pen, "<metadata>");
        put_escaped(pen, manifest);
        put(pen, "</metadata>\n");
    }
}

static void put_background(svg_pen *pen, const vn_canvas *canvas) {
    if (canvas->background.alpha == 0) {
        return;
    }
    put(pen, "<rect");
    put_attribute(pen, "width", canvas->width, 0);
    put_attribute(pen, "height", canvas->height, 0);
    put_color(pen, "fill", canvas->background);
    put_opacity(pen, canvas->background.alpha / 255.0);
    put(pen, "/>\n");
}

vn_status vn_canvas_write_svg(const vn_canvas *canvas, vn_sink *sink, const char *manifest) {
    svg_pen pen = {.sink = sink};
    bool small = canvas->width < SMALL_SIDE && canvas->height < SMALL_SIDE;
    pen.decimals = small ? FINE_DECIMALS : SPOT_DECIMALS;
    put_head(&pen, canvas, manifest);
    put_background(&pen, canvas);
    for (int32_t i = 0; pen.status == VN_OK && i < canvas->items.count; i++) {
        VN_TRY(put_item(&pen, canvas, &canvas->items.data[i]));
    }
    put(&pen, "</svg>\n");
    pen_flush(&pen);
    return pen.status;
}
