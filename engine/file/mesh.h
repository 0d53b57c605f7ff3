/// Meshes from files, for the engine's own files.
#ifndef VN_FILE_MESH_H
#define VN_FILE_MESH_H

#include "base/schema.h"
#include "domain/faces.h"
#include "venule/output.h"

extern const vn_schema vn_mesh_schema;

/// A zeroed one is empty.
typedef struct vn_polygons {
    VN_ARRAY(double) xyz; ///< x, y, z of each vertex
    vn_corners corners;   ///< face after face; not checked
    VN_ARRAY(int32_t) sizes;
} vn_polygons;

void vn_polygons_free(vn_polygons *polygons);

/// The vertices and faces of a file (cgal_mesh_reader.cpp). VN_IO with what is wrong with it; @p polygons
/// then holds nothing of use, and is to be freed all the same.
vn_status vn_mesh_read(vn_polygons *polygons, const char *path);

/// Those of a glTF 2.0 file (tinygltf_reader.cpp), in its metres, as its scene places them.
vn_status vn_gltf_read(vn_polygons *polygons, const char *path);

/// What vn_domain_mesh() makes of a file's faces.
vn_status vn_domain_mesh_faces(vn_domain **out, const vn_faces *faces, const vn_mesh_def *def);

#endif
