#include "file/mesh.h"

static const vn_mesh_def mesh_default = {0};

static const vn_field mesh_fields[] = {
    {"on", VN_CHOICE, 0, offsetof(vn_mesh_def, on), 0, 0, "", "surface",
     "what of the mesh is the domain: its surface"},
};
const vn_schema vn_mesh_schema = VN_SCHEMA("mesh", "The surface of a mesh", mesh_fields, mesh_default);

vn_mesh_def vn_mesh_def_default(void) {
    return mesh_default;
}

void vn_polygons_free(vn_polygons *polygons) {
    vn_array_free(&polygons->xyz);
    vn_array_free(&polygons->corners);
    vn_array_free(&polygons->sizes);
}

vn_status vn_domain_mesh(vn_domain **out, const char *path, const vn_mesh_def *def) {
    *out = NULL;
    if (def->on != 0) {
        return vn_fail(VN_INVALID, "mesh.on = %d must be 0 (surface)", def->on);
    }
    vn_polygons polygons = {0};
    vn_status status = vn_mesh_read(&polygons, path);
    if (status == VN_OK) {
        vn_faces faces = {.what = path,
                          .first = 1,
                          .xyz = polygons.xyz.data,
                          .vertices = polygons.xyz.count / 3,
                          .corners = polygons.corners.data,
                          .sizes = polygons.sizes.data,
                          .count = polygons.sizes.count};
        status = vn_domain_faces(out, &faces);
    }
    vn_polygons_free(&polygons);
    return status;
}
