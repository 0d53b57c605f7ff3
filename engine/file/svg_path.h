/// Path data, and the pen that all shapes are drawn with.
#ifndef VN_FILE_SVG_PATH_H
#define VN_FILE_SVG_PATH_H

#include "domain/rings.h"
#include "file/svg_style.h"
#include "network/paths.h"

/// Draws in an element's own coordinates, into rings in the file's final ones, whose subpaths are closed as a
/// fill does; or into paths, whose subpaths stay as open as they are drawn.
typedef struct vn_svg_pen {
    vn_svg_matrix matrix;
    vn_rings
        *rings; ///< NULL, and no paths: only the bounds are taken, of curves those of their control points
    vn_paths *paths;  ///< in place of rings, or NULL
    double tolerance; ///< > 0, in final coordinates
    double min[2], max[2];
    double start[2], at[2]; ///< of the subpath and the end of what was drawn, in the element's coordinates
    double from[2];         ///< `at` in final coordinates
    int64_t points;         ///< that it was asked to draw
} vn_svg_pen;

vn_svg_pen vn_svg_pen_make(const vn_svg_matrix *matrix, vn_rings *rings, double tolerance);
vn_status vn_svg_pen_move(vn_svg_pen *pen, double x, double y);
vn_status vn_svg_pen_line(vn_svg_pen *pen, double x, double y);
vn_status vn_svg_pen_cubic(vn_svg_pen *pen, const double p1[2], const double p2[2], const double p3[2]);
/// An elliptical arc around @p center, from angle @p begin over @p sweep (radians) on axes turned by @p turn.
vn_status vn_svg_pen_arc(vn_svg_pen *pen, const double center[2], const double radii[2], double turn,
                         double begin, double sweep);
/// End the subpath: back to its start.
vn_status vn_svg_pen_close(vn_svg_pen *pen);

/// Draw the data of a `d` attribute, up to its first error as SVG prescribes. VN_INVALID when not even one
/// point comes before that.
vn_status vn_svg_draw_path(vn_svg_pen *pen, const char *data);
/// Draw the data of a `points` attribute, up to its first error; @p closed goes back to the first of them.
vn_status vn_svg_draw_points(vn_svg_pen *pen, const char *data, bool closed);

#endif
