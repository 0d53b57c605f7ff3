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

#endif
