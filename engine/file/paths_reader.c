// Polylines from whatever file has lines.
#include "base/text.h"
#include "network/network.h"
#include "network/paths.h"
#include "venule/output.h"

#include <stdio.h>
#include <strings.h>

static const vn_paths_def paths_default = {0};

static const vn_field paths_fields[] = {
    {"id", VN_TEXT, VN_OPTIONAL, offsetof(vn_paths_def, id), 0, 0, "", "",
     "id of the shape or group of an SVG file, or name of the network in a file of several; left out: all "
     "that is drawn"},
    {"tolerance", VN_F64, 0, offsetof(vn_paths_def, tolerance), 0, VN_HUGE, "length", "",
     "curves become polylines that are within this of them; 0 for 1e-4 of each shape's size"},
};
const vn_schema vn_paths_schema = VN_SCHEMA("paths", "The lines of a file", paths_fields, paths_default);

vn_paths_def vn_paths_def_default(void) {
    return paths_default;
}

static bool ends_with(const char *path, const char *extension) {
    const char *slash = strrchr(path, '/');
    const char *dot = strrchr(slash != NULL ? slash : path, '.');
    return dot != NULL && strcasecmp(dot, extension) == 0;
}

static vn_status load_obj(vn_paths **out, const char *path) {
    vn_wires wires = {0};
    VN_TRY(vn_paths_create(out, 3));
    vn_status status = vn_obj_read_wires(&wires, path);
    if (status == VN_INVALID) {
        char message[400];
        snprintf(message, sizeof message, "%s", vn_message());
        for (char *at = message; *at != '\0'; at++) {
            *at = (unsigned char)*at < 0x20 || *at == 0x7F ? '?' : *at;
        }
        status = vn_fail(VN_IO, "%s: %s", path, message);
    }
    status = status == VN_OK ? vn_paths_from_wires(*out, &wires) : status;
    vn_wires_free(&wires);
    return status;
}

static vn_status load_svg(vn_paths **out, const char *path, const vn_paths_def *def) {
    VN_TRY(vn_paths_create(out, 2));
    return vn_svg_read_lines(*out, path, def);
}

static vn_status fail_choice(const vn_network_set *set, const char *path, const char *id) {
    const char *closest =
        id != NULL ? vn_closest_name(id, (const char *const *)set->names, set->count) : NULL;
    if (id == NULL) {
        return vn_fail(VN_INVALID, "%s: it holds %d networks: say which by id, \"%.60s\" or another", path,
                       set->count, set->names[0]);
    }
    return vn_fail(VN_INVALID, "%s: none of its networks is called \"%.60s\"%s%.60s%s", path, id,
                   closest != NULL ? ", did you mean \"" : "", closest != NULL ? closest : "",
                   closest != NULL ? "\"?" : "");
}

static vn_status chain_one(vn_paths **out, const vn_network_set *set, const char *path, const char *id) {
    for (int32_t i = 0; i < set->count; i++) {
        if (id != NULL ? strcmp(set->names[i], id) == 0 : set->count == 1) {
            return vn_paths_of_network(out, set->networks[i]);
        }
    }
    return fail_choice(set, path, id);
}

static vn_status load_network(vn_paths **out, const char *path, const char *id) {
    vn_network_set set;
    VN_TRY(vn_networks_load(&set, path));
    vn_status status = chain_one(out, &set, path, id);
    vn_networks_free(&set);
    return status;
}

static bool is_network(const char *path) {
    char extension[16] = ".";
    bool known = false;
    for (int32_t i = 0; vn_network_format(i) != NULL && !known; i++) {
        snprintf(extension + 1, sizeof extension - 1, "%s", vn_network_format(i));
        known = ends_with(path, extension);
    }
    return known;
}

static vn_status load_any(vn_paths **out, const char *path, const vn_paths_def *def) {
    VN_TRY(vn_check_def(&vn_paths_schema, def));
    if (ends_with(path, ".svg")) {
        return load_svg(out, path, def);
    }
    if (ends_with(path, ".obj")) {
        return load_obj(out, path);
    }
    if (is_network(path)) {
        return load_network(out, path, def->id);
    }
    return vn_fail(VN_INVALID,
                   "%s: lines are read from .svg, .obj, .swc, .vtp, .json and other networks' files", path);
}

vn_status vn_paths_load(vn_paths **out, const char *path, const vn_paths_def *def) {
    *out = NULL;
    vn_status status = load_any(out, path, def);
    if (status == VN_OK && vn_paths_count(*out) == 0) {
        status = vn_fail(VN_IO, "%s: it has no line of any length", path);
    }
    if (status != VN_OK) {
        vn_paths_destroy(*out);
        *out = NULL;
    }
    return status;
}
