#include "bind/bind.h"

#include "network/paths.h"

static int destroy_paths(lua_State *L) {
    vn_paths_destroy(*(vn_paths **)lua_touserdata(L, 1));
    return 0;
}

static vn_paths **push_holder(lua_State *L) {
    return vnl_push_owned(L, sizeof(vn_paths *), destroy_paths);
}

static void push_path(lua_State *L, const vn_paths *paths, int32_t path) {
    int32_t size = vn_paths_size(paths, path);
    int dim = vn_paths_dim(paths);
    lua_createtable(L, size, 0);
    for (int32_t i = 0; i < size; i++) {
        double p[3];
        vn_paths_position(paths, path, i, p);
        lua_createtable(L, dim, 0);
        for (int k = 0; k < dim; k++) {
            lua_pushnumber(L, p[k]);
            lua_rawseti(L, -2, k + 1);
        }
        lua_rawseti(L, -2, i + 1);
    }
}

static int read_paths(lua_State *L) {
    vn_paths_def def;
    lua_settop(L, 2);
    vnl_read_options(L, 2, &vn_paths_schema, &def);
    const char *path = lua_isuserdata(L, 1) ? NULL : vnl_push_path(L, 1);
    vn_paths **holder = push_holder(L);
    if (path != NULL) {
        vnl_try(L, vn_paths_load(holder, path, &def));
    } else {
        vnl_try(L, vn_paths_of_network(holder, vnl_check(L, 1, &vnl_network_class)));
    }
    lua_createtable(L, vn_paths_count(*holder), 0);
    for (int32_t i = 0; i < vn_paths_count(*holder); i++) {
        push_path(L, *holder, i);
        lua_rawseti(L, -2, i + 1);
    }
    return 1;
}

// What is flat lies at z = 0 in space; what is not does not fit into the plane.
static void read_point(lua_State *L, vn_paths *paths, const char *name, int32_t path, int32_t point) {
    char what[200];
    double p[3];
    snprintf(what, sizeof what, "%.150s[%d][%d]", name, path, point);
    vnl_read_point(L, -1, what, p);
    if (vn_paths_dim(paths) == 2 && p[2] != 0) {
        vnl_fail(L, "%s: z = %g, but the network is flat: give {x, y}", what, p[2]);
    }
    vn_status status = vn_paths_point(paths, p);
    if (status == VN_INVALID) {
        vnl_fail(L, "%s: (%g, %g, %g) is not finite", what, p[0], p[1], p[2]);
    }
    vnl_try(L, status);
}

static void read_given(lua_State *L, vn_paths *paths, const char *name, int32_t path) {
    if (!lua_istable(L, -1) || lua_rawlen(L, -1) == 0) {
        vnl_fail(L, "%s[%d]: a path is a list of points {{x, y}, …}, got %s", name, path,
                 lua_istable(L, -1) ? "an empty one" : luaL_typename(L, -1));
    }
    for (int32_t i = 1; lua_rawgeti(L, -1, i) != LUA_TNIL; i++, lua_pop(L, 1)) {
        read_point(L, paths, name, path, i);
    }
    lua_pop(L, 1);
    vnl_try(L, vn_paths_end(paths));
}

int vnl_network_follow(lua_State *L) {
    vn_follow_def def;
    int32_t added, first;
    lua_settop(L, 3);
    luaL_checktype(L, 2, LUA_TTABLE);
    vnl_read_options(L, 3, &vn_follow_schema, &def);
    vn_paths **holder = push_holder(L);
    vnl_try(L, vn_paths_create(holder, vn_network_dim(vnl_check(L, 1, &vnl_network_class))));
    for (int32_t i = 1; lua_rawgeti(L, 2, i) != LUA_TNIL; i++, lua_pop(L, 1)) {
        read_given(L, *holder, def.name, i);
    }
    vn_network *network = vnl_check(L, 1, &vnl_network_class);
    vnl_try(L, vn_network_follow(network, *holder, &def, &added, &first));
    lua_pushinteger(L, added);
    lua_pushinteger(L, first + 1);
    return 2;
}

const vnl_function vnl_paths_functions[] = {
    {"paths", read_paths, "(file: string|venule.Network, options?: venule.paths.Options): number[][][]", NULL,
     "The lines of a file as lists of points {x, y} or {x, y, z}, for vessels to follow: the shapes of an "
     "SVG "
     "file, open or closed, in the coordinates of venule.domain.svg; the `l` elements of an OBJ file; or the "
     "edges of a network, of a file or as it is. Those of the latter two are chains from end or branching to "
     "the next, root first.",
     &vn_paths_schema},
    {0},
};
