#include "bind/bind.h"

#include "bind/embedded.h"

#include <string.h>
#include <unistd.h>

const vnl_class *const vnl_classes[] = {
    &vnl_domain_class, &vnl_growth_class, &vnl_network_class, &vnl_attractors_class, &vnl_influence_class,
    &vnl_canvas_class, &vnl_volume_class, &vnl_cco_class,     &vnl_rng_class,        NULL};

static int make_rng(lua_State *L) {
    lua_Integer seed = vnl_check_integer(L, 1, "rng seed");
    void **box = vnl_push_box(L, &vnl_rng_class);
    vn_rng *rng = vn_resize(NULL, 0, sizeof *rng);
    if (rng == NULL) {
        vnl_try(L, vn_fail(VN_NO_MEMORY, "out of memory (raise --memory, or make less)"));
        return 0;
    }
    *rng = vn_rng_make((uint64_t)seed);
    *box = rng;
    return 1;
}

static int smoothstep(lua_State *L) {
    double low = vnl_check_number(L, 1, "smoothstep low");
    double high = vnl_check_number(L, 2, "smoothstep high");
    double t = high != low ? (vnl_check_number(L, 3, "smoothstep t") - low) / (high - low) : 0;
    t = t < 0 ? 0 : (t > 1 ? 1 : t);
    lua_pushnumber(L, t * t * (3 - 2 * t));
    return 1;
}

static int stalled(lua_State *L) {
    lua_getfield(L, LUA_REGISTRYINDEX, "venule.stalled");
    return 1;
}

enum { MOST_NAMES = 256 };

static int closest_name(lua_State *L) {
    const char *names[MOST_NAMES];
    const char *word = luaL_checkstring(L, 1);
    luaL_checktype(L, 2, LUA_TTABLE);
    int count = 0;
    for (lua_Integer i = 1; count < MOST_NAMES && lua_rawgeti(L, 2, i) == LUA_TSTRING; i++, lua_pop(L, 1)) {
        names[count++] = lua_tostring(L, -1); // the table holds it
    }
    lua_pushstring(L, vn_closest_name(word, names, count));
    return 1;
}

const vnl_function vnl_module_functions[] = {
    {"rng", make_rng, "(seed: integer): venule.Rng", NULL,
     "Random numbers that depend on nothing but the seed.", NULL},
    {"smoothstep", smoothstep, "(low: number, high: number, t: number): number", NULL,
     "0 below `low`, 1 above `high`, and a smooth rise between.", NULL},
    {"stalled", stalled, "(): string?", NULL,
     "Why the last `extend` added nothing although attractors are left, or nil. `venule.result` says it on "
     "stderr.",
     NULL},
    {"closest", closest_name, "(word: string, names: string[]): string?", NULL,
     "Which of the names a mistyped word most likely means, or nil.", NULL},
    {0},
};

static void add_functions(lua_State *L, const vnl_function *functions) {
    for (const vnl_function *f = functions; f->name != NULL; f++) {
        lua_pushcfunction(L, f->call);
        lua_setfield(L, -2, f->name);
    }
}

const char *vnl_push_manifest(lua_State *L) {
    if (lua_getfield(L, LUA_REGISTRYINDEX, "venule.manifest") != LUA_TFUNCTION) {
        return NULL;
    }
    lua_call(L, 0, 1);
    return lua_tostring(L, -1);
}

const char *vnl_push_path(lua_State *L, int index) {
    const char *path = luaL_checkstring(L, index);
    lua_pushvalue(L, index);
    if (path[0] != '/' && lua_getfield(L, LUA_REGISTRYINDEX, "venule.folder") == LUA_TSTRING) {
        const char *beside = lua_pushfstring(L, "%s/%s", lua_tostring(L, -1), path);
        if (access(beside, R_OK) == 0) {
            return beside;
        }
    }
    return path;
}

static int set_manifest(lua_State *L) {
    luaL_checktype(L, 1, LUA_TFUNCTION);
    lua_settop(L, 1);
    lua_setfield(L, LUA_REGISTRYINDEX, "venule.manifest");
    return 0;
}

static const vn_embedded *find_embedded(const char *name) {
    for (int i = 0; i < vn_embedded_count; i++) {
        if (strcmp(vn_embedded_modules[i].name, name) == 0) {
            return &vn_embedded_modules[i];
        }
    }
    return NULL;
}

// A module of lua/venule/ is a chunk that is given `venule`, what the program says, and a way to set the
// manifest.
static int load_embedded(lua_State *L) {
    const vn_embedded *module = find_embedded(lua_tostring(L, lua_upvalueindex(1)));
    char chunk[80];
    strcpy(chunk, "=");
    strncat(chunk, module->name, sizeof chunk - 2);
    if (luaL_loadbufferx(L, (const char *)module->data, module->size, chunk, "t") != LUA_OK) {
        return lua_error(L);
    }
    lua_getfield(L, LUA_REGISTRYINDEX, "venule.module");
    lua_getfield(L, LUA_REGISTRYINDEX, "venule.host");
    lua_pushcfunction(L, set_manifest);
    lua_call(L, 3, 1);
    return 1;
}

static void push_loader(lua_State *L, const char *name) {
    lua_pushstring(L, name);
    lua_pushcclosure(L, load_embedded, 1);
}

static void preload_embedded(lua_State *L) {
    luaL_getsubtable(L, LUA_REGISTRYINDEX, LUA_PRELOAD_TABLE);
    for (int i = 0; i < vn_embedded_count; i++) {
        push_loader(L, vn_embedded_modules[i].name);
        lua_setfield(L, -2, vn_embedded_modules[i].name);
    }
    lua_pop(L, 1);
}

// What the Lua module returns becomes part of `venule`.
static void merge_embedded(lua_State *L, const char *name) {
    push_loader(L, name);
    lua_call(L, 0, 1);
    for (lua_pushnil(L); lua_next(L, -2) != 0;) {
        lua_pushvalue(L, -2);
        lua_insert(L, -2);
        lua_settable(L, -5);
    }
    lua_pop(L, 1);
}

// `venule.fram` is an error with a suggestion, not nil.
static int refuse_name(lua_State *L) {
    const char *names[MOST_NAMES];
    const char *key = luaL_tolstring(L, 2, NULL);
    int count = 0;
    for (lua_pushnil(L); lua_next(L, 1) != 0; lua_pop(L, 1)) {
        if (lua_type(L, -2) == LUA_TSTRING && count < MOST_NAMES) {
            names[count++] = lua_tostring(L, -2);
        }
    }
    const char *closest = vn_closest_name(key, names, count);
    const char *table = lua_tostring(L, lua_upvalueindex(1));
    if (closest != NULL) {
        return vnl_fail(L, "%s has no \"%s\", did you mean \"%s\"?", table, key, closest);
    }
    return vnl_fail(L, "%s has no \"%s\"", table, key);
}

static void make_strict(lua_State *L, const char *name) {
    lua_createtable(L, 0, 1);
    lua_pushstring(L, name);
    lua_pushcclosure(L, refuse_name, 1);
    lua_setfield(L, -2, "__index");
    lua_setmetatable(L, -2);
}

int luaopen_venule(lua_State *L) {
    for (int i = 0; vnl_classes[i] != NULL; i++) {
        vnl_register(L, vnl_classes[i]);
    }
    vnl_register_view(L);
    vnl_push_functions(L, vnl_module_functions);
    add_functions(L, vnl_network_functions);
    add_functions(L, vnl_attractors_functions);
    add_functions(L, vnl_canvas_functions);
    add_functions(L, vnl_voxels_functions);
    add_functions(L, vnl_cco_functions);
    add_functions(L, vnl_paths_functions);
    vnl_push_functions(L, vnl_domain_functions);
    make_strict(L, "venule.domain");
    lua_setfield(L, -2, "domain");
    vnl_push_functions(L, vnl_growth_functions);
    make_strict(L, "venule.growth");
    lua_setfield(L, -2, "growth");
    lua_pushstring(L, vn_version());
    lua_setfield(L, -2, "version");
    lua_pushvalue(L, -1);
    lua_setfield(L, LUA_REGISTRYINDEX, "venule.module");
    preload_embedded(L);
    merge_embedded(L, "venule.scenario");
    merge_embedded(L, "venule.leaf");
    merge_embedded(L, "venule.plot");
    merge_embedded(L, "venule.veinlets");
    merge_embedded(L, "venule.venation");
    merge_embedded(L, "venule.brochidodromous");
    merge_embedded(L, "venule.cco");
    merge_embedded(L, "venule.vessels");
    make_strict(L, "venule");
    return 1;
}
