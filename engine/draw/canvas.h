/// The display list behind a canvas, and how it becomes a file.
#ifndef VN_DRAW_CANVAS_H
#define VN_DRAW_CANVAS_H

#include "base/array.h"
#include "base/schema.h"
#include "base/sink.h"
#include "base/text.h"
#include "draw/color.h"
#include "venule/output.h"

extern const vn_schema vn_canvas_schema, vn_fill_schema, vn_stroke_schema, vn_dots_schema, vn_text_schema;

/// A place on the canvas: pixels from the upper left corner, y down.
typedef struct vn_spot {
    double x, y;
} vn_spot;

/// A polyline of one width, or a taper: two points with a width each. Of a fill: one closed ring.
typedef struct vn_piece {
    int32_t begin, count;   ///< its points
    int32_t order;          ///< the vein order it belongs to, 0 without one
    float width, end_width; ///< pixels; they differ in a taper
} vn_piece;

static inline bool vn_piece_tapers(const vn_piece *piece) {
    return piece->width != piece->end_width;
}

typedef enum vn_item_kind { VN_ITEM_FILL, VN_ITEM_STROKE, VN_ITEM_DOTS, VN_ITEM_TEXT } vn_item_kind;

/// What one call drew. All of it is one film of paint: where its parts overlap they do not darken each other.
typedef struct vn_item {
    vn_item_kind kind;
    vn_color color;
    vn_color outline;   ///< of a fill
    double opacity;     ///< of the whole item; the colour's own alpha comes on top
    double size;        ///< pixels: a fill's line width, the dots' radius, the letters' height
    int32_t begin, end; ///< pieces of a fill or stroke; points of dots; the point of a text
    bool layered;       ///< a stroke whose pieces have vein orders, sorted by them
    int anchor;         ///< of a text
    char *text;         ///< owned
} vn_item;

struct vn_canvas {
    int32_t width, height; ///< pixels
    double scale;          ///< pixels to one unit of the view
    double left, bottom;   ///< where the view's (0, 0) is, pixels
    double meters_a_pixel; ///< on paper
    vn_color background;
    VN_ARRAY(vn_item) items;   ///< painted in this order
    VN_ARRAY(vn_piece) pieces; ///< shared by all items
    VN_ARRAY(vn_spot) points;  ///< shared by all items
};

/// Where a point of the view lies. Held within ±2^22 pixels: beyond twice that, cairo's 24.8 fixed point
/// wraps round.
vn_spot vn_canvas_place(const vn_canvas *canvas, double x, double y);

/// Append @p text as valid UTF-8 of one line: control characters become spaces, what is malformed or not
/// allowed in XML becomes U+FFFD.
vn_status vn_clean_text(vn_text *out, const char *text);

/// Write the whole picture into @p sink. @p manifest is NULL or one clean line.
typedef vn_status vn_canvas_write_fn(const vn_canvas *canvas, vn_sink *sink, const char *manifest);
vn_canvas_write_fn vn_canvas_write_png, vn_canvas_write_pdf, vn_canvas_write_svg;

#endif
