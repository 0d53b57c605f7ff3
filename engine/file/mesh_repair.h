/// Broken meshes made whole.
#ifndef VN_FILE_MESH_REPAIR_H
#define VN_FILE_MESH_REPAIR_H

#include "file/mesh.h"

/// Repair a mesh of faces of any kind, into an empty @p out that is freed by the caller in any case: vertices
/// within 1e-7 of its extent become one, faces that are there twice or have no area go, faces are turned to
/// face one way and cut apart where more than two meet, borders at one place are sewn, and with @p close
/// holes of up to 500 edges are filled by the triangles that bend least. VN_INVALID for what is wrong with a
/// vertex or a corner, and where nothing is left.
vn_status vn_mesh_repair(vn_polygons *out, const vn_faces *faces, bool close, vn_repairs *repairs);

#endif
