/// The faces of a mesh as they come from a script or a file: nothing about them is believed.
#ifndef VN_DOMAIN_FACES_H
#define VN_DOMAIN_FACES_H

#include "base/array.h"
#include "venule/domain.h"

typedef struct vn_faces {
    const char *what;       ///< what errors begin with
    int32_t first;          ///< the number of the first vertex and of the first face in errors: 0 or 1
    const double *xyz;      ///< x, y, z of each vertex
    int32_t vertices;       ///< how many
    const int32_t *corners; ///< face after face; vertices count from 0
    const int32_t *sizes;   ///< how many corners each face has; NULL: 3
    int32_t count;
} vn_faces;

/// Three corners each.
typedef VN_ARRAY(int32_t) vn_corners;

/// Check the numbers: VN_INVALID for no faces at all, a vertex or a corner out of range, and faces of too few
/// or too many corners.
vn_status vn_faces_check(const vn_faces *faces);

/// Check everything, and cut the faces into triangles (of a quadrangle, along the shorter diagonal that is
/// inside). VN_INVALID with the first thing that is wrong.
vn_status vn_faces_triangulate(const vn_faces *faces, vn_corners *triangles);

/// A surface (vn_domain_surface()) of such faces.
vn_status vn_domain_faces(vn_domain **out, const vn_faces *faces);

/// What such faces enclose (vn_domain_inside()).
vn_status vn_domain_faces_inside(vn_domain **out, const vn_faces *faces, bool check);

#endif
