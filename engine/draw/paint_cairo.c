#include "draw/eps_head.h"
#include "draw/marks.h"
#include "draw/png_writer.h"
#include "draw/taper.h"

#include <cairo-pdf.h>
#include <cairo-ps.h>
#include <math.h>

// Pieces of one width go into one path until it has this many points. A PDF of a million strokes took
// 230 s one by one and 5 s so; much longer paths are slower in an image, whose scan converter sorts all the
// edges of a path.
enum { BATCH_POINTS = 32, POLL_EVERY = 4096 };

static vn_status check_cairo(cairo_status_t status) {
    switch (status) {
    case CAIRO_STATUS_SUCCESS:
        return VN_OK;
    case CAIRO_STATUS_NO_MEMORY:
        return vn_fail(VN_NO_MEMORY,
                       "out of memory: cairo could not draw the picture; give a smaller canvas");
    default:
        return vn_fail(VN_EXTERNAL, "cairo could not draw the picture: %s", cairo_status_to_string(status));
    }
}

static void set_color(cairo_t *cr, vn_color color) {
    cairo_set_source_rgb(cr, color.red / 255.0, color.green / 255.0, color.blue / 255.0);
}

// Begin one film of paint. A half-transparent one is painted opaque on a sheet of its own first, so that
// parts that overlap do not darken each other.
static void begin_film(cairo_t *cr, double alpha) {
    if (alpha < 1) {
        cairo_push_group(cr);
    }
}

static void end_film(cairo_t *cr, double alpha) {
    if (alpha < 1) {
        cairo_pop_group_to_source(cr);
        cairo_paint_with_alpha(cr, alpha);
    }
}

static void trace(cairo_t *cr, const vn_canvas *canvas, const vn_piece *piece) {
    const vn_spot *spots = canvas->points.data + piece->begin;
    cairo_move_to(cr, spots[0].x, spots[0].y);
    for (int32_t i = 1; i < piece->count; i++) {
        cairo_line_to(cr, spots[i].x, spots[i].y);
    }
}

static void trace_rings(cairo_t *cr, const vn_canvas *canvas, const vn_item *item) {
    for (int32_t i = item->begin; i < item->end; i++) {
        trace(cr, canvas, &canvas->pieces.data[i]);
        cairo_close_path(cr);
    }
}

// One colour of a fill, either its inside or its outline.
static void paint_rings(cairo_t *cr, const vn_canvas *canvas, const vn_item *item, vn_color color,
                        bool outline) {
    double alpha = color.alpha / 255.0;
    if (alpha == 0) {
        return;
    }
    begin_film(cr, alpha);
    set_color(cr, color);
    trace_rings(cr, canvas, item);
    if (outline) {
        cairo_set_line_width(cr, item->size);
        cairo_stroke(cr);
    } else {
        cairo_set_fill_rule(cr, CAIRO_FILL_RULE_EVEN_ODD);
        cairo_fill(cr);
        cairo_set_fill_rule(cr, CAIRO_FILL_RULE_WINDING);
    }
    end_film(cr, alpha);
}

static vn_status paint_fill(cairo_t *cr, const vn_canvas *canvas, const vn_item *item) {
    paint_rings(cr, canvas, item, item->color, false);
    paint_rings(cr, canvas, item, item->outline, true);
    return VN_OK;
}

// All of one orientation, so that tapers of one path unite.
static void trace_taper(cairo_t *cr, const vn_canvas *canvas, const vn_piece *piece) {
    vn_taper taper = vn_taper_of(canvas, piece);
    const double full = 6.283185307179586;
    cairo_new_sub_path(cr);
    if (taper.whole >= 0) {
        vn_spot center = taper.center[taper.whole];
        cairo_arc(cr, center.x, center.y, taper.radius[taper.whole], 0, full);
    } else {
        cairo_arc(cr, taper.center[0].x, taper.center[0].y, taper.radius[0], taper.axis + taper.turn,
                  taper.axis - taper.turn + full);
        cairo_arc(cr, taper.center[1].x, taper.center[1].y, taper.radius[1], taper.axis - taper.turn,
                  taper.axis + taper.turn);
    }
    cairo_close_path(cr);
}

// Fill tapers from @p begin on, as many as one path should hold; returns the next piece.
static int32_t fill_batch(cairo_t *cr, const vn_canvas *canvas, int32_t begin, int32_t end) {
    const vn_piece *pieces = canvas->pieces.data;
    int32_t i = begin;
    while (i < end && 2 * (i - begin) < BATCH_POINTS && vn_piece_tapers(&pieces[i]) &&
           vn_same_color(pieces[i].color, pieces[begin].color)) {
        trace_taper(cr, canvas, &pieces[i]);
        i++;
    }
    cairo_fill(cr);
    return i;
}

// Stroke pieces from @p begin on that have one width, as many as one path should hold; returns the next one.
static int32_t stroke_batch(cairo_t *cr, const vn_canvas *canvas, int32_t begin, int32_t end) {
    const vn_piece *pieces = canvas->pieces.data;
    int32_t points = 0;
    int32_t i = begin;
    do {
        trace(cr, canvas, &pieces[i]);
        points += pieces[i].count;
        i++;
    } while (i < end && points < BATCH_POINTS && !vn_piece_tapers(&pieces[i]) &&
             vn_piece_is_like(&pieces[i], &pieces[begin]));
    cairo_set_line_width(cr, pieces[begin].width);
    cairo_stroke(cr);
    return i;
}

static vn_status paint_pieces(cairo_t *cr, const vn_canvas *canvas, const vn_item *item) {
    int32_t polled = item->begin;
    for (int32_t i = item->begin; i < item->end;) {
        if (i - polled >= POLL_EVERY) {
            VN_TRY(vn_poll());
            polled = i;
        }
        bool tapers = vn_piece_tapers(&canvas->pieces.data[i]);
        if (item->colored) {
            set_color(cr, canvas->pieces.data[i].color);
        }
        i = tapers ? fill_batch(cr, canvas, i, item->end) : stroke_batch(cr, canvas, i, item->end);
    }
    return VN_OK;
}

static vn_status paint_dots(cairo_t *cr, const vn_canvas *canvas, const vn_item *item) {
    for (int32_t i = item->begin; i < item->end; i++) {
        if (i % POLL_EVERY == 0) {
            VN_TRY(vn_poll());
        }
        vn_spot spot = canvas->points.data[i];
        cairo_move_to(cr, spot.x, spot.y);
        cairo_close_path(cr);
        if (i % 64 == 63 || i + 1 == item->end) {
            cairo_set_line_width(cr, 2 * item->size);
            cairo_stroke(cr); // a round cap on a line without length
        }
    }
    return VN_OK;
}

static void fill_area(void *cr, const vn_spot *ring, int32_t count, vn_color color) {
    set_color(cr, color);
    cairo_move_to(cr, ring[0].x, ring[0].y);
    for (int32_t i = 1; i < count; i++) {
        cairo_line_to(cr, ring[i].x, ring[i].y);
    }
    cairo_fill(cr);
}

static vn_status paint_scene(cairo_t *cr, const vn_canvas *canvas, const vn_item *item) {
    for (int32_t i = item->begin; i < item->end; i++) {
        if (i % POLL_EVERY == 0) {
            VN_TRY(vn_poll());
        }
        vn_mark_paint(canvas, &canvas->marks.data[i], fill_area, cr);
    }
    return VN_OK;
}

static void choose_font(cairo_t *cr, double size) {
    cairo_select_font_face(cr, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cr, size);
}

static vn_status paint_text(cairo_t *cr, const vn_canvas *canvas, const vn_item *item) {
    cairo_text_extents_t extents;
    vn_spot spot = canvas->points.data[item->begin];
    choose_font(cr, item->size);
    cairo_text_extents(cr, item->text, &extents);
    cairo_save(cr);
    cairo_translate(cr, spot.x, spot.y);
    cairo_rotate(cr, -item->angle * 3.14159265358979323846 / 180);
    cairo_move_to(cr, -0.5 * item->anchor * extents.x_advance, 0);
    cairo_show_text(cr, item->text);
    cairo_restore(cr);
    cairo_new_path(cr);
    return VN_OK;
}

static vn_status paint_parts(cairo_t *cr, const vn_canvas *canvas, const vn_item *item) {
    switch (item->kind) {
    case VN_ITEM_FILL:
        return paint_fill(cr, canvas, item);
    case VN_ITEM_STROKE:
        return paint_pieces(cr, canvas, item);
    case VN_ITEM_DOTS:
        return paint_dots(cr, canvas, item);
    case VN_ITEM_SCENE:
        return paint_scene(cr, canvas, item);
    default:
        return paint_text(cr, canvas, item);
    }
}

static vn_status paint_item(cairo_t *cr, const vn_canvas *canvas, const vn_item *item) {
    bool two_colors = item->kind == VN_ITEM_FILL; // each with an alpha of its own
    double alpha = item->opacity * (two_colors ? 1 : item->color.alpha / 255.0);
    VN_TRY(vn_poll());
    if (alpha == 0) {
        return VN_OK;
    }
    begin_film(cr, alpha);
    set_color(cr, item->color);
    vn_status status = paint_parts(cr, canvas, item);
    end_film(cr, alpha);
    return status;
}

static void paint_background(cairo_t *cr, const vn_canvas *canvas) {
    vn_color color = canvas->background;
    if (color.alpha > 0) {
        cairo_set_source_rgba(cr, color.red / 255.0, color.green / 255.0, color.blue / 255.0,
                              color.alpha / 255.0);
        cairo_rectangle(cr, 0, 0, canvas->width, canvas->height);
        cairo_fill(cr);
    }
}

// The desktop's settings must not show in a picture: no hinting, no colour fringes.
static void set_font_options(cairo_t *cr) {
    cairo_font_options_t *options = cairo_font_options_create();
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_set_font_options(cr, options);
    cairo_font_options_destroy(options);
}

// Paint everything onto @p surface, one canvas pixel being @p unit of the surface's own units.
static vn_status paint(cairo_surface_t *surface, const vn_canvas *canvas, double unit) {
    cairo_t *cr = cairo_create(surface);
    vn_status status = check_cairo(cairo_status(cr));
    cairo_scale(cr, unit, unit);
    cairo_set_tolerance(cr, 0.02 * unit);
    cairo_set_antialias(cr, CAIRO_ANTIALIAS_GOOD);
    cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
    cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
    set_font_options(cr);
    paint_background(cr, canvas);
    for (int32_t i = 0; status == VN_OK && i < canvas->items.count; i++) {
        status = paint_item(cr, canvas, &canvas->items.data[i]);
    }
    if (status == VN_OK) {
        status = check_cairo(cairo_status(cr));
    }
    cairo_destroy(cr);
    return status;
}

static vn_status paint_image(const vn_canvas *canvas, uint32_t *pixels) {
    cairo_surface_t *surface = cairo_image_surface_create_for_data( //
        (unsigned char *)pixels, CAIRO_FORMAT_ARGB32, canvas->width, canvas->height, canvas->width * 4);
    vn_status status = check_cairo(cairo_surface_status(surface));
    if (status == VN_OK) {
        status = paint(surface, canvas, 1);
        cairo_surface_flush(surface);
    }
    cairo_surface_destroy(surface);
    return status;
}

vn_status vn_canvas_write_png(const vn_canvas *canvas, vn_sink *sink, const char *manifest) {
    size_t size = (size_t)canvas->width * (size_t)canvas->height * sizeof(uint32_t);
    uint32_t *pixels = vn_new_block(size);
    if (pixels == NULL) {
        return vn_fail_memory("a picture", size);
    }
    vn_status status = paint_image(canvas, pixels);
    if (status == VN_OK) {
        vn_pixels image = {pixels, canvas->width, canvas->height, 1 / canvas->meters_a_pixel};
        status = vn_png_write(sink, &image, manifest);
    }
    vn_resize(pixels, size, 0);
    return status;
}

vn_status vn_text_width(double *out, const char *text, double size) {
    *out = 0;
    vn_text clean = {0};
    VN_TRY(vn_clean_text(&clean, text));
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1);
    cairo_t *cr = cairo_create(surface);
    cairo_text_extents_t extents = {0};
    set_font_options(cr);
    choose_font(cr, size);
    cairo_text_extents(cr, clean.data, &extents);
    vn_status status = check_cairo(cairo_status(cr));
    *out = extents.x_advance;
    cairo_destroy(cr);
    cairo_surface_destroy(surface);
    vn_array_free(&clean);
    return status;
}

static cairo_status_t write_bytes(void *sink, const unsigned char *bytes, unsigned count) {
    return vn_sink_write(sink, bytes, count) == VN_OK ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

// The date is fixed: the same picture is the same bytes.
static void set_metadata(cairo_surface_t *surface, const char *manifest) {
    char creator[64];
    snprintf(creator, sizeof creator, "Venule %s", vn_version());
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_TITLE, "Venule");
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATOR, creator);
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
    if (manifest != NULL) {
        cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_SUBJECT, manifest);
    }
}

// Paint the pages' one and only, and destroy the surface.
static vn_status finish_page(cairo_surface_t *surface, const vn_canvas *canvas, double point,
                             vn_status status) {
    if (status == VN_OK) {
        status = paint(surface, canvas, point);
    }
    cairo_surface_finish(surface);
    if (status == VN_OK && cairo_surface_status(surface) != CAIRO_STATUS_WRITE_ERROR) {
        status = check_cairo(cairo_surface_status(surface)); // a failed write is the sink's to report
    }
    cairo_surface_destroy(surface);
    return status;
}

static double points_a_pixel(const vn_canvas *canvas) {
    return canvas->meters_a_pixel * 72 / 0.0254;
}

vn_status vn_canvas_write_pdf(const vn_canvas *canvas, vn_sink *sink, const char *manifest) {
    double point = points_a_pixel(canvas);
    cairo_surface_t *surface =
        cairo_pdf_surface_create_for_stream(write_bytes, sink, canvas->width * point, canvas->height * point);
    vn_status status = check_cairo(cairo_surface_status(surface));
    if (status == VN_OK) {
        set_metadata(surface, manifest);
    }
    return finish_page(surface, canvas, point, status);
}

static cairo_status_t filter_bytes(void *filter, const unsigned char *bytes, unsigned count) {
    return vn_eps_write(filter, (const char *)bytes, count) == VN_OK ? CAIRO_STATUS_SUCCESS
                                                                     : CAIRO_STATUS_WRITE_ERROR;
}

vn_status vn_canvas_write_eps(const vn_canvas *canvas, vn_sink *sink, const char *manifest) {
    vn_eps_filter filter = {.sink = sink};
    double point = points_a_pixel(canvas), width = canvas->width * point, height = canvas->height * point;
    cairo_surface_t *surface = cairo_ps_surface_create_for_stream(filter_bytes, &filter, width, height);
    vn_status status = check_cairo(cairo_surface_status(surface));
    if (status == VN_OK) {
        cairo_ps_surface_set_eps(surface, 1);
        status = vn_eps_comment(surface, width, height, manifest);
    }
    return vn_eps_end(&filter, finish_page(surface, canvas, point, status));
}
