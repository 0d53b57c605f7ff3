/// The display list behind a canvas, and how it becomes a file.
#ifndef VN_DRAW_CANVAS_H
#define VN_DRAW_CANVAS_H

#include "base/array.h"
#include "base/schema.h"
#include "base/sink.h"
#include "base/text.h"
#include "draw/camera.h"
#include "draw/color.h"
#include "venule/output.h"

extern const vn_schema vn_canvas_schema, vn_fill_schema, vn_stroke_schema, vn_dots_schema, vn_text_schema,
    vn_line_schema;

/// A place on the canvas: pixels from the upper left corner, y down.
typedef struct vn_spot {
    double x, y;
} vn_spot;

/// A polyline of one width, or a taper: two points with a width each. Of a fill: one closed ring.
typedef struct vn_piece {
    int32_t begin, count;   ///< its points
    int32_t order;          ///< the vein order it belongs to, 0 without one
    float width, end_width; ///< pixels; they differ in a taper
    vn_color color;         ///< of a stroke whose edges have colours of their own
} vn_piece;

static inline bool vn_piece_is_like(const vn_piece *piece, const vn_piece *other) {
    return piece->width == other->width && vn_same_color(piece->color, other->color);
}

static inline bool vn_piece_tapers(const vn_piece *piece) {
    return piece->width != piece->end_width;
}

typedef enum vn_mark_kind { VN_MARK_TUBE, VN_MARK_BALL, VN_MARK_DOT, VN_MARK_FACE } vn_mark_kind;

/// A small solid thing that a camera saw: a stretch of a round vein, a ball, a flat dot, a triangle.
typedef struct vn_mark {
    double depth;    ///< of what is nearest of it, along the camera's `back`: what is less is painted first
    vn_spot at[3];   ///< a tube's ends, a ball's or dot's middle, a face's corners
    float radius[2]; ///< pixels: of a tube at both ends, of a ball or dot
    float slope;     ///< sine of the angle by which a tube comes nearer along its way
    float light;     ///< on a face, 0 to 1
    float haze;      ///< how much of the background covers it, 0 to 1
    vn_color color;  ///< in full light
    uint8_t kind;    ///< a vn_mark_kind
} vn_mark;

typedef enum vn_item_kind {
    VN_ITEM_FILL,
    VN_ITEM_STROKE,
    VN_ITEM_DOTS,
    VN_ITEM_TEXT,
    VN_ITEM_SCENE,
} vn_item_kind;

/// What one call drew. All of it is one film of paint: where its parts overlap they do not darken each other.
typedef struct vn_item {
    vn_item_kind kind;
    vn_color color;
    vn_color outline; ///< of a fill
    double opacity;   ///< of the whole item; the colour's own alpha comes on top
    double size; ///< pixels: a fill's or line's width, the dots' radius, the letters' height; 0: a network
    int32_t begin, end; ///< pieces of a fill or stroke; points of dots; the point of a text; marks of a scene
    bool layered;       ///< a stroke whose pieces have vein orders, sorted by them
    bool colored;       ///< a stroke whose pieces have colours of their own
    int anchor;         ///< of a text
    double angle;       ///< of a text, degrees counterclockwise
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
    VN_ARRAY(vn_mark) marks;   ///< shared by all items, of each one from far to near
    vn_camera camera;
};

/// Where a point of the view lies. Held within ±2^22 pixels: beyond twice that, cairo's 24.8 fixed point
/// wraps round.
vn_spot vn_canvas_place(const vn_canvas *canvas, double x, double y);
/// Where a point in space lies; without a camera, z is not looked at. False when it is behind the camera:
/// then @p out is somewhere in its direction.
bool vn_canvas_place_3(const vn_canvas *canvas, const double p[3], vn_spot *out);

/// Append @p text as valid UTF-8 of one line: control characters become spaces, what is malformed or not
/// allowed in XML becomes U+FFFD.
vn_status vn_clean_text(vn_text *out, const char *text);

/// Write the whole picture into @p sink. @p manifest is NULL or one clean line.
typedef vn_status vn_canvas_write_fn(const vn_canvas *canvas, vn_sink *sink, const char *manifest);
vn_canvas_write_fn vn_canvas_write_png, vn_canvas_write_pdf, vn_canvas_write_svg, vn_canvas_write_eps;

#endif
