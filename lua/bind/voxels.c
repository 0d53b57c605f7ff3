#include "bind/bind.h"

#include "draw/tubes.h"

#include <limits.h>
#include <string.h>

static void release_volume(void *object) {
    vn_volume_destroy(object);
}

static vn_volume *check_volume(lua_State *L) {
    return vnl_check(L, 1, &vnl_volume_class);
}

// A list {A, V}, or {arteries = A, veins = V} by alphabet. Allocates nothing.
static int32_t list_networks(lua_State *L, int index, const vn_network **networks) {
    const char *names[VNL_MOST_NETWORKS];
    if (!lua_istable(L, index)) {
        vnl_fail(L, "voxels.networks: a table of networks expected, got %s", luaL_typename(L, index));
    }
    lua_Unsigned count = lua_rawlen(L, index);
    if (count == 0) {
        return vnl_named_networks(L, index, "voxels.networks", networks, names);
    }
    for (lua_Unsigned i = 0; i < count; i++) {
        lua_rawgeti(L, index, (lua_Integer)(i + 1));
        const vn_network *network = vnl_test(L, -1, &vnl_network_class);
        if (i == VNL_MOST_NETWORKS || network == NULL) {
            vnl_fail(L, "voxels.networks[%d]: a network expected, and at most %d", (int)(i + 1),
                     VNL_MOST_NETWORKS);
        }
        networks[i] = network;
        lua_pop(L, 1);
    }
    return (int32_t)count;
}

// Lua sees a few bytes of a volume that may be gigabytes: it is told, so that it looks for volumes to let go.
static void tell_collector(lua_State *L, const vn_volume *volume) {
    size_t kilobytes = volume->byte_size >> 10;
    lua_gc(L, LUA_GCSTEP, kilobytes < INT_MAX / 2 ? (int)kilobytes : INT_MAX / 2);
}

// The options are at the top of the stack; @p self is where the network is whose method this is, or 0.
static int push_voxels(lua_State *L, int self) {
    vn_voxels_def def;
    vn_box bounds = {{0}, {0}};
    const vn_network *networks[VNL_MOST_NETWORKS];
    int options = lua_gettop(L), box_at = options + 1, list_at = options + 2;
    void **box = vnl_push_box(L, &vnl_volume_class);
    lua_pushnil(L);
    if (lua_istable(L, options)) {
        vnl_raw_field(L, options, "networks");
        lua_replace(L, list_at);
        vnl_read_bounds(L, options, "voxels", "bounds", &bounds);
    }
    vnl_read_options(L, options, &vn_voxels_schema, &def); // the last thing that allocates
    def.bounds = bounds;
    def.networks = networks;
    def.network_count = lua_isnil(L, list_at) ? 0 : list_networks(L, list_at, networks);
    if (self != 0 && (def.network != NULL || def.network_count > 0)) {
        return vnl_fail(L,
                        "voxels: `network` and `networks` are options of venule.voxels, not of net:voxels");
    }
    def.network = self != 0 ? vnl_check(L, self, &vnl_network_class) : def.network;
    vnl_try(L, vn_voxelize((vn_volume **)box, &def));
    tell_collector(L, *box);
    lua_pushvalue(L, box_at);
    return 1;
}

static int make_voxels(lua_State *L) {
    lua_settop(L, 1);
    return push_voxels(L, 0);
}

int vnl_network_voxels(lua_State *L) {
    lua_settop(L, 2);
    vnl_check(L, 1, &vnl_network_class);
    return push_voxels(L, 1);
}

static void check_place(lua_State *L, const vn_volume *volume, int32_t voxel[3]) {
    static const char *const names[] = {"volume i", "volume j", "volume k"};
    for (int k = 0; k < 3; k++) {
        bool left_out = k == 2 && volume->size[2] == 1 && lua_isnoneornil(L, 4);
        lua_Integer at = left_out ? 1 : vnl_check_integer(L, k + 2, names[k]);
        if (at < 1 || at > volume->size[k]) {
            vnl_fail(L, "%s = %lld is not one of the %d voxels from 1", names[k], (long long)at,
                     volume->size[k]);
        }
        voxel[k] = (int32_t)(at - 1);
    }
}

static int volume_at(lua_State *L) {
    const vn_volume *volume = check_volume(L);
    int32_t at[3];
    check_place(L, volume, at);
    size_t row = (size_t)at[1] + (size_t)volume->size[1] * (size_t)at[2];
    double value = vn_volume_at(volume, (size_t)at[0] + (size_t)volume->size[0] * row);
    if (volume->type == VN_VOXEL_F32) {
        lua_pushnumber(L, value);
    } else {
        lua_pushinteger(L, (lua_Integer)value);
    }
    return 1;
}

static int volume_position(lua_State *L) {
    const vn_volume *volume = check_volume(L);
    int32_t at[3];
    double p[3];
    check_place(L, volume, at);
    vn_volume_position(volume, at, p);
    return vnl_push_coordinates(L, 3, p);
}

static int volume_count(lua_State *L) {
    lua_pushinteger(L, vn_volume_count(check_volume(L)));
    return 1;
}

static int volume_save(lua_State *L) {
    const char *path = luaL_checkstring(L, 2);
    const char *manifest = vnl_push_manifest(L);
    vnl_try(L, vn_volume_write(check_volume(L), path, manifest));
    return 0;
}

static const vnl_function methods[] = {
    {"at", volume_at, "(i: integer, j: integer, k?: integer): number", NULL,
     "What a voxel says; they are counted from 1. A flat volume needs no `k`.", NULL},
    {"position", volume_position, "(i: integer, j: integer, k?: integer): number, number, number", NULL,
     "Where the middle of a voxel is: x, y, z.", NULL},
    {"count", volume_count, "(): integer", NULL, "How many voxels are not 0.", NULL},
    {"save", volume_save, "(path: string)", NULL,
     "Write the volume: .nii, .nii.gz, .nrrd, .vol (masks and centre lines) or, of a 2D network, .pgm, by "
     "the "
     "path's extension.",
     NULL},
    {0},
};

static int push_size(lua_State *L, const vn_volume *volume) {
    lua_createtable(L, 3, 0);
    for (int k = 0; k < 3; k++) {
        lua_pushinteger(L, volume->size[k]);
        lua_rawseti(L, -2, k + 1);
    }
    return 1;
}

static int volume_field(lua_State *L) {
    static const char *const types[] = {
        [VN_VOXEL_U8] = "u8", [VN_VOXEL_U16] = "u16", [VN_VOXEL_U32] = "u32", [VN_VOXEL_F32] = "f32"};
    const vn_volume *volume = check_volume(L);
    const char *key = lua_tostring(L, 2);
    if (strcmp(key, "size") == 0) {
        return push_size(L, volume);
    }
    if (strcmp(key, "resolution") == 0) {
        lua_pushnumber(L, volume->to_world[0][0]);
    } else if (strcmp(key, "type") == 0) {
        lua_pushstring(L, types[volume->type]);
    } else if (strcmp(key, "unit") == 0) {
        lua_pushstring(L, volume->unit);
    } else {
        return 0;
    }
    return 1;
}

static const char *const fields[] = {
    "size: integer[] | voxels in x, y and z; 1 in z when flat", "resolution: number | side of a voxel",
    "type: string | \"u8\", \"u16\", \"u32\" or \"f32\"", "unit: string | of the resolution", NULL};

const vnl_class vnl_volume_class = {
    .name = "volume",
    .doc =
        "Voxels of networks: masks, labels, radii. `volume:close()` gives a large one's memory back at once.",
    .methods = methods,
    .fields = fields,
    .field = volume_field,
    .release = release_volume,
};

const vnl_function vnl_voxels_functions[] = {
    {"voxels", make_voxels, NULL, "venule.Volume",
     "Make voxels of one network or of several: cubes, or squares in 2D. What hangs together in a network "
     "hangs "
     "together in voxels, however thin it is; where tubes overlap, the one that a voxel lies deepest in has "
     "it. "
     "`networks` by name are numbered by alphabet: arteries 1, veins 2.",
     &vn_voxels_schema},
    {0},
};
