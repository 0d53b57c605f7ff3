/// A network as drawn pieces.
#ifndef VN_DRAW_CHAINS_H
#define VN_DRAW_CHAINS_H

#include "draw/canvas.h"

/// Append @p network's edges and joins to the canvas's points and pieces, in O(n).
///
/// A chain is a maximal run of edges that begins at a branching or a root and goes on through each node's
/// thickest child (of equal ones the lower index), while width and vein order stay the same. Where the width
/// changes along that way, the edge is a taper. A lateral begins with its own width; each join is a piece of
/// two points, a taper where by Murray's law it is what continues a vein. Edges below `hide_below` are left
/// out.
///
/// The new pieces are sorted: layers (vein orders) from the one whose thickest piece is thinnest, within a
/// layer tapers first, then by width.
vn_status vn_chains_build(vn_canvas *canvas, const vn_network *network, const vn_stroke_def *def);

typedef VN_ARRAY(double) vn_widths;

/// The width of each node's edge, view units. VN_INVALID where one is negative or not finite, or radii are
/// to be taken and none are known.
vn_status vn_stroke_widths(const vn_network *network, const vn_stroke_def *def, vn_widths *widths);

/// The ends of a join and its width in view units: where its radius is not known it is as thin as the thinner
/// of its ends.
typedef struct vn_join_line {
    int32_t a, b;
    double width;
} vn_join_line;
vn_join_line vn_join_line_at(const vn_network *network, const vn_stroke_def *def, const vn_widths *widths,
                             int32_t join);

typedef VN_ARRAY(int32_t) vn_heirs;

/// The child that continues each node's vein: the thickest, of equal ones the lower index; -1 where there is
/// none.
vn_status vn_find_heirs(const vn_network *network, const vn_widths *widths, vn_heirs *heirs);

#endif
