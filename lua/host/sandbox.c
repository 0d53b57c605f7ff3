// What a script may have: Lua without files, processes, C modules, bytecode and random numbers that would not
// repeat. What it writes through `save` is not confined yet to the folders that the command line names.

#include "host/host.h"

#include <stdio.h>
#include <string.h>

static const luaL_Reg plain_libraries[] = {
    {LUA_GNAME, luaopen_base},       {LUA_LOADLIBNAME, luaopen_package}, {LUA_COLIBNAME, luaopen_coroutine},
    {LUA_TABLIBNAME, luaopen_table}, {LUA_STRLIBNAME, luaopen_string},   {LUA_MATHLIBNAME, luaopen_math},
    {LUA_UTF8LIBNAME, luaopen_utf8}, {LUA_OSLIBNAME, luaopen_os},
};

static void keep_only(lua_State *L, const char *library, const char *const *names) {
    lua_getglobal(L, library);
    lua_newtable(L);
    for (; *names != NULL; names++) {
        lua_getfield(L, -2, *names);
        lua_setfield(L, -2, *names);
    }
    lua_pushvalue(L, -1);
    lua_setglobal(L, library);
    luaL_getsubtable(L, LUA_REGISTRYINDEX, LUA_LOADED_TABLE);
    lua_pushvalue(L, -2);
    lua_setfield(L, -2, library);
    lua_pop(L, 3);
}

// load() of text only: hand-made bytecode can crash the interpreter.
static int load_text(lua_State *L) {
    const char *chunk = luaL_checkstring(L, 1);
    const char *name = luaL_optstring(L, 2, "=(load)");
    int environment = lua_isnone(L, 4) ? 0 : 4;
    if (luaL_loadbufferx(L, chunk, lua_rawlen(L, 1), name, "t") != LUA_OK) {
        lua_pushnil(L);
        lua_insert(L, -2);
        return 2;
    }
    if (environment != 0) {
        lua_pushvalue(L, environment);
        lua_setupvalue(L, -2, 1);
    }
    return 1;
}

static int refuse_random(lua_State *L) {
    return luaL_error(
        L, "math.random() would not repeat; use venule.rng(seed): r:uniform(a, b), r:integer(a, b)");
}

static bool is_module_name(const char *name) {
    for (const char *c = name; *c != '\0'; c++) {
        bool plain =
            (*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') || (*c >= '0' && *c <= '9') || *c == '_';
        if (!plain && !(*c == '.' && c > name && c[1] != '.' && c[1] != '\0')) {
            return false;
        }
    }
    return name[0] != '\0';
}

// Modules beside the script, as text; the upvalue is the script's folder.
static int search_beside(lua_State *L) {
    const char *name = luaL_checkstring(L, 1);
    if (!is_module_name(name)) {
        lua_pushfstring(L, "'%s' is no module name", name);
        return 1;
    }
    const char *path = luaL_gsub(L, name, ".", "/");
    path = lua_pushfstring(L, "%s/%s.lua", lua_tostring(L, lua_upvalueindex(1)), path);
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        lua_pushfstring(L, "no file '%s'", path);
        return 1;
    }
    fclose(file);
    if (luaL_loadfilex(L, path, "t") != LUA_OK) {
        return lua_error(L);
    }
    lua_pushstring(L, path);
    return 2;
}

static void push_folder(lua_State *L, const char *script) {
    const char *slash = strrchr(script, '/');
    if (slash == NULL) {
        lua_pushliteral(L, ".");
    } else {
        lua_pushlstring(L, script, slash == script ? 1 : (size_t)(slash - script));
    }
}

static void set_searchers(lua_State *L, const char *script, bool trust) {
    lua_getglobal(L, "package");
    lua_getfield(L, -1, "searchers");
    int searchers = lua_gettop(L);
    push_folder(L, script);
    lua_pushvalue(L, -1);
    lua_setfield(L, LUA_REGISTRYINDEX, "venule.folder");
    lua_pushcclosure(L, search_beside, 1);
    if (trust) { // after the preloaded ones, before Lua's own paths
        for (lua_Integer i = luaL_len(L, searchers); i >= 2; i--) {
            lua_rawgeti(L, searchers, i);
            lua_rawseti(L, searchers, i + 1);
        }
        lua_rawseti(L, searchers, 2);
        lua_settop(L, searchers - 2);
        return;
    }
    lua_rawseti(L, searchers, 2);
    for (lua_Integer i = luaL_len(L, searchers); i >= 3; i--) {
        lua_pushnil(L);
        lua_rawseti(L, searchers, i);
    }
    static const char *const dropped[] = {"loadlib", "searchpath", "cpath", "path", "config", "searchers"};
    for (size_t i = 0; i < sizeof dropped / sizeof *dropped; i++) {
        lua_pushnil(L); // require() keeps the searchers as they are now
        lua_setfield(L, searchers - 1, dropped[i]);
    }
    lua_pushvalue(L, searchers);
    lua_setfield(L, searchers - 1, "searchers");
    lua_settop(L, searchers - 2);
}

static void drop_globals(lua_State *L) {
    static const char *const dropped[] = {"dofile", "loadfile", "collectgarbage"};
    for (size_t i = 0; i < sizeof dropped / sizeof *dropped; i++) {
        lua_pushnil(L);
        lua_setglobal(L, dropped[i]);
    }
    lua_pushcfunction(L, load_text);
    lua_setglobal(L, "load");
    lua_getglobal(L, "string");
    lua_pushnil(L);
    lua_setfield(L, -2, "dump");
    lua_getglobal(L, "math");
    lua_pushcfunction(L, refuse_random);
    lua_setfield(L, -2, "random");
    lua_pushcfunction(L, refuse_random);
    lua_setfield(L, -2, "randomseed");
    lua_pop(L, 2);
}

void sandbox_open(lua_State *L, const char *script, bool trust) {
    if (trust) {
        luaL_openlibs(L);
    } else {
        for (size_t i = 0; i < sizeof plain_libraries / sizeof *plain_libraries; i++) {
            luaL_requiref(L, plain_libraries[i].name, plain_libraries[i].func, 1);
            lua_pop(L, 1);
        }
        static const char *const os_names[] = {"clock", "date", "difftime", "time", NULL};
        keep_only(L, "os", os_names);
        drop_globals(L);
    }
    set_searchers(L, script, trust);
}
