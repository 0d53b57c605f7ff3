/// Whether a mesh has an inside.
#ifndef VN_DOMAIN_CLOSED_H
#define VN_DOMAIN_CLOSED_H

#include "domain/faces.h"
#include "space/triangle_tree.h"

/// Triangles that stand for @p faces: the corners are first vertices, and @p mate is what vn_seams_link()
/// gives.
typedef struct vn_closed {
    const vn_faces *faces;
    const vn_corners *corners, *mate;
    const vn_triangle_tree *tree; ///< of the triangles, by their numbers
} vn_closed;

/// Every edge has an even number of triangles; VN_INVALID says how many have not, and where the first is.
vn_status vn_closed_check_edges(const vn_closed *mesh);

/// No two triangles share a point but those of their common corners and edges; VN_INVALID says where two do.
vn_status vn_closed_check_crossings(const vn_closed *mesh);

#endif
