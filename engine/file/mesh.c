#include "file/mesh_repair.h"

static const vn_mesh_def mesh_default = {.check = true};

static const vn_field mesh_fields[] = {
    {"on", VN_CHOICE, 0, offsetof(vn_mesh_def, on), 0, 0, "", "surface|inside",
     "what of the mesh is the domain: its surface, or what it encloses"},
    {"check", VN_BOOL, 0, offsetof(vn_mesh_def, check), 0, 0, "", NULL,
     "of an inside: refuse a mesh that crosses itself; without, what is in two of its parts is outside"},
    {"repair", VN_BOOL, 0, offsetof(vn_mesh_def, repair), 0, 0, "", NULL,
     "mend vertices that nearly coincide, faces that are there twice, have no area or are turned, open seams "
     "and, "
     "for an inside, holes; otherwise such a mesh is refused"},
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

static vn_status make_domain(vn_domain **out, const vn_faces *faces, const vn_mesh_def *def) {
    return def->on == 0 ? vn_domain_faces(out, faces) : vn_domain_faces_inside(out, faces, def->check);
}

static vn_faces faces_of(const vn_polygons *polygons, const char *what, int32_t first) {
    return (vn_faces){.what = what,
                      .first = first,
                      .xyz = polygons->xyz.data,
                      .vertices = polygons->xyz.count / 3,
                      .corners = polygons->corners.data,
                      .sizes = polygons->sizes.data,
                      .count = polygons->sizes.count};
}

vn_status vn_domain_mesh_faces(vn_domain **out, const vn_faces *faces, const vn_mesh_def *def) {
    vn_polygons whole = {.xyz = {0}};
    vn_repairs repairs = {0};
    *out = NULL;
    VN_TRY(check_on(def));
    vn_status status = def->repair ? vn_mesh_repair(&whole, faces, def->on == 1, &repairs) : VN_OK;
    if (status == VN_OK) {
        vn_faces repaired = faces_of(&whole, faces->what, faces->first);
        status = make_domain(out, def->repair ? &repaired : faces, def);
    }
    vn_polygons_free(&whole);
    if (def->repairs != NULL) {
        *def->repairs = repairs;
    }
    return status;
}

vn_status vn_domain_mesh(vn_domain **out, const char *path, const vn_mesh_def *def) {
    *out = NULL;
    VN_TRY(check_on(def)); // before the file is read
    vn_polygons polygons = {0};
    vn_status status = vn_mesh_read(&polygons, path);
    if (status == VN_OK) {
        vn_faces faces = faces_of(&polygons, path, 1);
        status = vn_domain_mesh_faces(out, &faces, def);
    }
    vn_polygons_free(&polygons);
    return status;
}
