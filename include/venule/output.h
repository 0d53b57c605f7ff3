/// @file output.h
/// Pictures: a canvas is a list of what was drawn, which becomes a PNG, a PDF or an SVG when it is saved.
#ifndef VENULE_OUTPUT_H
#define VENULE_OUTPUT_H

#include "venule/attractors.h"
#include "venule/domain.h"
#include "venule/network.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vn_canvas vn_canvas;

/// How a canvas looks at space. Points whose coordinates are NaN are not given.
typedef struct vn_camera_def {
    double from[3]; ///< the eye; not given: a little from the right and above, as far as shows the whole view
    double to[3];   ///< what is in the middle of the picture; not given: the middle of the view
    double up[3];   ///< what is up in the picture; not given: y
    double fov;  ///< angle that the canvas's shorter side shows, less its margins: 0 to 150 degrees; default
                 ///< 30. 0: a parallel projection, which shows the whole view
    double zoom; ///< enlarges the picture about its middle; > 0; default 1
    double fog;  ///< how much of the background covers what is farthest in the view: 0 (the default) to 1
} vn_camera_def;
VN_API vn_camera_def vn_camera_def_default(void);

typedef struct vn_canvas_def {
    double width;  ///< pixels, 1 to 32,767; 0: from the height and the view's proportions, or 800
    double height; ///< likewise
    vn_box view;   ///< what is fitted, centred, into the canvas: a domain's bounds; empty: the canvas itself,
                   ///< with (0, 0) at its lower left
    double margin; ///< kept free around the view, pixels, 0 or more; default 10
    const char *background; ///< a colour, or "none"; default "none"
    const char *unit; ///< length unit of the view: "mm", "cm", "m", "um", "in", "pt". Pages (SVG, PDF) are
                      ///< then at true scale; "" (the default): 96 pixels an inch
    const vn_camera_def *camera; ///< NULL (the default): from straight above, without depth: x to the right
                                 ///< and y up, whatever z. With a camera the view has three dimensions, scale
                                 ///< and unit hold at the depth of what it looks at, and what is behind it
                                 ///< is not drawn
} vn_canvas_def;
VN_API vn_canvas_def vn_canvas_def_default(void);
VN_API vn_status vn_canvas_create(vn_canvas **out, const vn_canvas_def *def);
VN_API void vn_canvas_destroy(vn_canvas *canvas);
VN_API double vn_canvas_width(const vn_canvas *canvas);
VN_API double vn_canvas_height(const vn_canvas *canvas);
/// Pixels to one unit of the view's length; with a camera, of what it looks at.
VN_API double vn_canvas_scale(const vn_canvas *canvas);

/// Colours are "#rgb", "#rgba", "#rrggbb", "#rrggbbaa", or one of CSS's sixteen basic names.

typedef struct vn_fill_def {
    const char *color;  ///< default "#dfe9c8"
    double opacity;     ///< 0 to 1; default 1
    const char *stroke; ///< colour of the outline, or "none" (the default)
    double line_width;  ///< of the outline, in view units; default 0: one pixel
} vn_fill_def;
VN_API vn_fill_def vn_fill_def_default(void);
/// Fill a 2D domain. Through a camera also the surface of a solid one that has triangles (meshes, balls,
/// boxes), shaded; at an opacity below 1 one sees what was drawn before, but no back side.
VN_API vn_status vn_canvas_fill(vn_canvas *canvas, const vn_domain *domain, const vn_fill_def *def);

typedef struct vn_stroke_def {
    const char *color;      ///< default "#2f4f2a"
    double opacity;         ///< 0 to 1; default 1
    double width;           ///< of all edges, in view units; 0 (the default): twice each edge's radius
    const double *widths;   ///< or the width of each node's edge, one entry a node; borrowed during the call
    double min_width;       ///< no edge is drawn thinner than this, pixels; default 0.3
    double hide_below;      ///< edges thinner than this are left out, pixels, 0 or more; default 0: none is
    const uint32_t *colors; ///< or the colour of each node's edge, 0xRRGGBB, one entry a node; borrowed
    const double *values;   ///< or one number a node, whose edge has its colour in the ramp; what is not
                            ///< finite has `color`; borrowed
    const char *column;     ///< or the name of such a column: "radius" or "flow" (by their logarithm),
                            ///< "order", "tree", "birth", "pressure"
    const char *ramp;       ///< colours between spaces, from the least number's to the greatest's, evenly
} vn_stroke_def;
VN_API vn_stroke_def vn_stroke_def_default(void);
/// Draw a network's edges and joins with round ends, tapered where a vein's radius changes. Through a camera
/// they are tubes, shaded across their width and painted from far to near, together with other networks and
/// dots that were drawn right before, if all are opaque.
/// VN_INVALID when the width is to be the radius and no radii are known.
VN_API vn_status vn_canvas_stroke(vn_canvas *canvas, const vn_network *network, const vn_stroke_def *def);

typedef struct vn_dots_def {
    const char *color; ///< default "#c0392b"
    double opacity;    ///< 0 to 1; default 1
    double radius;     ///< view units; default 0: two pixels
} vn_dots_def;
VN_API vn_dots_def vn_dots_def_default(void);
/// A dot at each of @p count points; @p z may be NULL, and is only looked at by a camera. Through one, dots
/// with a radius are balls.
VN_API vn_status vn_canvas_dots(vn_canvas *canvas, const double *x, const double *y, const double *z,
                                int32_t count, const vn_dots_def *def);

typedef struct vn_line_def {
    const char *color; ///< default "#222222"; "none": only the inside is painted
    double opacity;    ///< 0 to 1; default 1
    double width;      ///< pixels, > 0; default 1
    const char *fill;  ///< colour of the inside of a line that is then closed; default "none"
} vn_line_def;
VN_API vn_line_def vn_line_def_default(void);
/// A line through @p count points with round ends and corners; @p z may be NULL. Two points or more.
VN_API vn_status vn_canvas_line(vn_canvas *canvas, const double *x, const double *y, const double *z,
                                int32_t count, const vn_line_def *def);

typedef struct vn_text_def {
    double at[3];      ///< where, in view units
    const char *color; ///< default "#222222"
    double size;       ///< height of the letters, pixels; default 14
    double opacity;    ///< 0 to 1; default 1
    int anchor;        ///< 0 start, 1 middle, 2 end
    double angle;      ///< the line of text is turned by it counterclockwise, degrees; default 0
} vn_text_def;
VN_API vn_text_def vn_text_def_default(void);
/// One line of UTF-8 in DejaVu Sans.
VN_API vn_status vn_canvas_text(vn_canvas *canvas, const char *text, const vn_text_def *def);

/// How long a text of vn_canvas_text() is at @p size, pixels.
VN_API vn_status vn_text_width(double *out, const char *text, double size);

/// Write the picture: .png, .svg, .pdf or .eps by the extension of @p path. In EPS what is half-transparent
/// becomes pixels, 300 an inch; all else stays lines and areas. @p manifest (JSON, may be NULL) goes inside.
/// VN_INVALID for another extension, VN_IO when it cannot be written; then no file is left behind.
VN_API vn_status vn_canvas_save(const vn_canvas *canvas, const char *path, const char *manifest);

/// Write a network by the extension of @p path (docs/formats.md): .json, .xml and .gxl (as VascuSynth and
/// OpenCCO do), .vtp (ParaView, VMTK), .swc, .csv, .txt (a segment a line). Several at once, which only JSON
/// holds, when
/// @p count is not 1 or names are given. @p manifest (a JSON object, may be NULL) goes inside where the
/// format has a place for it. VN_INVALID for what the format cannot hold, with one that can; VN_IO when the
/// file cannot be written; then none is left behind.
VN_API vn_status vn_network_save(const vn_network *network, const char *path, const char *manifest);
VN_API vn_status vn_networks_save(const vn_network *const *networks, const char *const *names, int32_t count,
                                  const char *path, const char *manifest);
/// Whether a file of that name could hold them; vn_message() says why not.
VN_API vn_status vn_networks_check(const vn_network *const *networks, const char *const *names, int32_t count,
                                   const char *path);
/// The extensions of networks, "json" first; NULL beyond the last.
VN_API const char *vn_network_format(int32_t index);

/// Networks read from one file; names[i] is "" when it held a single one. Destroy each, then
/// vn_networks_free().
typedef struct vn_network_set {
    vn_network **networks;
    char **names;
    int32_t count;
    char *manifest; ///< the JSON object that the file says how it was made by; NULL without
} vn_network_set;
/// By the extension of @p path, as vn_network_save(). VN_INVALID for another extension, VN_IO for a missing
/// file or one that is no network; the message says what and where.
VN_API vn_status vn_networks_load(vn_network_set *out, const char *path);
/// Free the set and the networks that are still in it (not NULL).
VN_API void vn_networks_free(vn_network_set *set);

typedef struct vn_svg_def {
    const char *id;   ///< of a shape or of a group of shapes; NULL: pick
    int pick;         ///< 0 "largest": the shape of the largest area; 1 "all": everything filled, united
    double tolerance; ///< curves become polylines that are within this of them, in the file's units; default
                      ///< 0: 1e-4 of the shape's size
    bool repair; ///< accept outlines that cross themselves, and fill them as a painter would; default false
} vn_svg_def;
VN_API vn_svg_def vn_svg_def_default(void);
/// The outline of a shape in an SVG file, y up. Coordinates are user units of the outermost viewBox with its
/// lower left corner at (0, 0), or millimetres when the file gives its width in mm, cm, in or pt.
VN_API vn_status vn_domain_svg(vn_domain **out, const char *path, const vn_svg_def *def);

/// What was wrong with a mesh and has been repaired: counts.
typedef struct vn_repairs {
    int32_t merged;       ///< vertices that nearly coincided with others, within 1e-7 of the extent
    int32_t removed;      ///< faces that were there twice or had no area
    int32_t turned;       ///< faces that faced the other way than those around them
    int32_t sewn;         ///< pairs of edges at one place
    int32_t holes;        ///< that were closed
    int32_t largest_hole; ///< edges round the largest one
} vn_repairs;

typedef struct vn_mesh_def {
    int on;      ///< 0 "surface": the domain is the mesh's surface (vn_domain_surface()); 1 "inside": what it
                 ///< encloses (vn_domain_inside())
    bool check;  ///< of an inside, whether to look for crossings; default true
    bool repair; ///< mend what can be: vertices that nearly coincide, faces that are there twice, have no
                 ///< area or are turned, open seams, and, of an inside, holes of up to 500 edges; default
                 ///< false: refuse
    vn_repairs *repairs; ///< gets what was repaired; may be NULL
} vn_mesh_def;
VN_API vn_mesh_def vn_mesh_def_default(void);
/// The surface or the inside of a mesh in an .obj, .off (plain, in text), .ply or .stl file. Faces of more
/// than three corners are cut into triangles. VN_IO for a file that is missing or no mesh, VN_INVALID for a
/// mesh that vn_domain_surface() or vn_domain_inside() refuses; messages count vertices and faces from 1.
VN_API vn_status vn_domain_mesh(vn_domain **out, const char *path, const vn_mesh_def *def);

typedef struct vn_image_def {
    double threshold; ///< inside are pixels of this brightness or more, 0 (black) to 1 (white); default 0.5
    bool invert;      ///< inside are darker ones instead; default false
    double pixel;     ///< the side of a pixel, length, > 0; default 1
    int component; ///< of a mask whose parts do not hang together by sides of pixels: 0 "one" (the default):
                   ///< refuse it, unless all but the largest part are specks, of a thousandth of it in all,
                   ///< which are left out; 1 "largest": take the largest; 2 "all"
} vn_image_def;
VN_API vn_image_def vn_image_def_default(void);
/// What is bright in a .png or .pgm file of 8 or 16 bits, as a 2D domain: the union of the squares of its
/// pixels, y up, with the image's lower left corner at (0, 0). Brightness is luminance (0.2126 R + 0.7152 G +
/// 0.0722 B of the values as they are stored) times opacity.
///
/// All answers are exact for that union; it combines with other domains as a polygon does.
/// vn_domain_value() is a pixel's brightness (inverted: 1 less that), the same all over the pixel, and 0
/// outside: with a threshold of 0, the whole image is a map of density.
///
/// VN_IO for a file that is missing, broken or cut off; VN_LIMIT beyond 2^31 - 1 pixels; VN_INVALID for a
/// mask that is empty, or has several parts where one is asked for.
VN_API vn_status vn_domain_image(vn_domain **out, const char *path, const vn_image_def *def);

typedef struct vn_volume_def {
    double threshold; ///< inside are voxels of this value or more; default (-1e300, "not given"): 0.5, and
                      ///< 128 in a .vol
    bool invert;      ///< inside are voxels below it instead; default false
    int component;    ///< as of vn_image_def, by faces of voxels
} vn_volume_def;
VN_API vn_volume_def vn_volume_def_default(void);
/// What is inside in a volume of voxels, as a 3D domain: the union of the boxes of voxels at or above a
/// threshold. Files are NIfTI-1 (.nii, .nii.gz; placed by its sform, else its qform, else by the sizes of its
/// voxels), NRRD (.nrrd with its data attached: raw, gzip or ascii; from left-posterior-superior and
/// left-anterior-superior spaces turned to NIfTI's right-anterior-superior) and DGtal's .vol (voxels 1 wide,
/// the first one's middle at the origin, or where Center-X, -Y and -Z put it). Voxels are whole numbers of 8,
/// 16 or 32 bits, float or double; NIfTI's slope and intercept are applied. The unit is the file's.
///
/// All answers are exact for that union. The grid may be turned, mirrored and of different spacings, but its
/// axes have to be at right angles (to within 0.001). vn_domain_value() is a voxel's value over the greatest
/// inside (in a .vol over 255), within [0, 1] (inverted: 1 less that), the same all over the voxel.
///
/// A mask takes 4.3 bytes a voxel, and 1, 2 or 4 more where the values inside differ. Errors as of
/// vn_domain_image(); VN_INVALID for a sheared grid too.
VN_API vn_status vn_domain_volume(vn_domain **out, const char *path, const vn_volume_def *def);

#ifdef __cplusplus
}
#endif

#endif
