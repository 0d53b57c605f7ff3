#include "file/mesh.h"

static const vn_mesh_def mesh_default = {.check = true};

static const vn_field mesh_fields[] = {
    {"on", VN_CHOICE, 0, offsetof(vn_mesh_def, on), 0, 0, "", "surface|inside",
     "what of the mesh is the domain: its surface, or what it encloses"},
    {"check", VN_BOOL, 0, offsetof(vn_mesh_def, check), 0, 0, "", NULL,
     "of an inside: refuse a mesh that crosses itself; without, what is in two of its parts is outside"},
};
const vn_schema vn_mesh_schema =
    VN_SCHEMA("mesh", "The surface or the inside of a mesh", mesh_fields, mesh_default);

vn_mesh_def vn_mesh_def_default(void) {
    return mesh_default;
}

void vn_polygons_free(vn_polygons *polygons) {
    vn_array_free(&polygons->xyz);
    vn_array_free(&polygons->corners);
    vn_array_free(&polygons->sizes);
}

static vn_status check_on(const vn_mesh_def *def) {
    if (def->on != 0 && def->on != 1) {
        return vn_fail(VN_INVALID, "mesh.on = %d must be 0 (surface) or 1 (inside)", def->on);
    }
    return VN_OK;
}

vn_status vn_domain_mesh_faces(vn_domain **out, const vn_faces *faces, const vn_mesh_def *def) {
    *out = NULL;
    VN_TRY(check_on(def));
    return def->on == 0 ? vn_domain_faces(out, faces) : vn_domain_faces_inside(out, faces, def->check);
}

vn_status vn_domain_mesh(vn_domain **out, const char *path, const vn_mesh_def *def) {
    *out = NULL;
    VN_TRY(check_on(def)); // before the file is read
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
        status = vn_domain_mesh_faces(out, &faces, def);
    }
    vn_polygons_free(&polygons);
    return status;
}
