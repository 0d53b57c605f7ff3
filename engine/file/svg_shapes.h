/// The shapes of an SVG file, and the coordinate systems that its viewports make.
#ifndef VN_FILE_SVG_SHAPES_H
#define VN_FILE_SVG_SHAPES_H

#include "file/svg_path.h"

/// What percentages refer to.
typedef struct vn_svg_viewport {
    double width, height;
} vn_svg_viewport;

/// Draw one shape. VN_INVALID for path data without any point; a shape of no size draws nothing.
vn_status vn_svg_draw_shape(vn_svg_pen *pen, const vn_svg_tree *tree, int32_t element,
                            const vn_svg_viewport *viewport);

/// A length attribute in user units; @p whole is what 100 % means and @p absent what an absent one is.
double vn_svg_measure(const vn_svg_tree *tree, int32_t element, vn_svg_name name, double whole,
                      double absent);

/// From the content of an inner svg or a symbol to the coordinates around it; @p viewport becomes the inner
/// one.
/// @p use is the element that sets the size of a symbol, or -1.
vn_svg_matrix vn_svg_viewport_matrix(const vn_svg_tree *tree, int32_t element, int32_t use,
                                     vn_svg_viewport *viewport);

/// From the outermost user units to the final coordinates: y up, in millimetres when the file gives its size
/// so;
/// @p unit is then "mm", else "".
vn_svg_matrix vn_svg_page_matrix(const vn_svg_tree *tree, vn_svg_viewport *viewport, const char **unit);

#endif
