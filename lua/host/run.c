#include "bind/bind.h"
#include "host/host.h"

#include <errno.h>
#include <nettle/sha2.h>
#include <stdio.h>
#include <string.h>
#include <yajl/yajl_tree.h>

enum { LARGEST_TEXT = 16 << 20 };

// A whole small file into a Lua string; VN_IO says why not.
static vn_status push_file(lua_State *L, const char *path) {
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return vn_fail(VN_IO, "%s: cannot be read: %s", path, strerror(errno));
    }
    luaL_Buffer buffer;
    size_t count, total = 0;
    luaL_buffinit(L, &buffer);
    do {
        count = fread(luaL_prepbuffer(&buffer), 1, LUAL_BUFFERSIZE, file);
        luaL_addsize(&buffer, count);
        total += count;
    } while (count > 0 && total <= LARGEST_TEXT);
    bool failed = ferror(file) != 0;
    int error = errno;
    fclose(file);
    luaL_pushresult(&buffer);
    if (total > LARGEST_TEXT) {
        return vn_fail(VN_IO, "%s: is above the limit of 16 MB", path);
    }
    return failed ? vn_fail(VN_IO, "%s: cannot be read: %s", path, strerror(error)) : VN_OK;
}

static void push_sha256(lua_State *L, const char *bytes, size_t count) {
    struct sha256_ctx context;
    uint8_t digest[SHA256_DIGEST_SIZE];
    char text[2 * SHA256_DIGEST_SIZE + 1];
    sha256_init(&context);
    sha256_update(&context, count, (const uint8_t *)bytes);
    sha256_digest(&context, sizeof digest, digest);
    for (int i = 0; i < SHA256_DIGEST_SIZE; i++) {
        snprintf(text + 2 * i, 3, "%02x", digest[i]);
    }
    lua_pushlstring(L, text, 2 * SHA256_DIGEST_SIZE);
}

// The exit status that goes with the message on top of the stack. A script may swallow the error with
// pcall(): then another message ends the run, and its own status counts.
static void remember_exit(lua_State *L, int status) {
    lua_pushvalue(L, -1);
    lua_setfield(L, LUA_REGISTRYINDEX, "venule.exit.message");
    lua_pushinteger(L, status);
    lua_setfield(L, LUA_REGISTRYINDEX, "venule.exit");
}

static int exit_usage(lua_State *L) {
    luaL_checkstring(L, 1);
    lua_settop(L, 1);
    remember_exit(L, VN_EXIT_USAGE);
    return lua_error(L);
}

// The results are there, but less than what was asked for.
static int exit_infeasible(lua_State *L) {
    luaL_checkstring(L, 1);
    lua_settop(L, 1);
    remember_exit(L, vn_exit_status(VN_INFEASIBLE));
    return lua_error(L);
}

static const char *row_field(lua_State *L, const char *name) {
    lua_getfield(L, -1, name);
    const char *text = lua_isnil(L, -1) ? NULL : luaL_tolstring(L, -1, NULL);
    lua_setfield(L, LUA_REGISTRYINDEX, name); // keeps the text alive while the row is printed
    lua_settop(L, 2);
    return text;
}

static void show_row(lua_State *L) {
    lua_rawgeti(L, 2, 1);
    lua_rawgeti(L, 2, 2);
    printf("  %-20s %-10s", lua_tostring(L, 3), luaL_tolstring(L, 4, NULL));
    lua_settop(L, 2);
    static const char *const names[] = {"min", "max", "unit", "help"};
    static const char *const forms[] = {" from %s", " to %s", " %s", "  %s"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const char *text = row_field(L, names[i]);
        if (text != NULL) {
            printf(forms[i], text);
        }
    }
    putchar('\n');
}

// host.show_help(rows): the script's parameters, and the end of the run.
static int show_help(lua_State *L) {
    luaL_checktype(L, 1, LUA_TTABLE);
    lua_settop(L, 1);
    if (luaL_len(L, 1) == 0) {
        puts("This script has no parameters.");
    } else {
        puts("Parameters, for --set NAME=VALUE: name, default, range, meaning");
    }
    for (lua_Integer i = 1; lua_geti(L, 1, i) == LUA_TTABLE; i++, lua_settop(L, 1)) {
        show_row(L);
    }
    lua_pushliteral(L, "help was shown");
    remember_exit(L, 0);
    return lua_error(L);
}

static void read_sets(lua_State *L, const run_options *options) {
    for (int32_t i = 0; i < options->sets.count; i++) {
        const char *set = options->sets.data[i];
        const char *equals = strchr(set, '=');
        lua_pushlstring(L, set, (size_t)(equals - set));
        lua_pushstring(L, equals + 1);
        lua_settable(L, -3);
    }
    if (options->seed != NULL) {
        lua_pushstring(L, options->seed);
        lua_setfield(L, -2, "seed");
    }
}

static bool push_json_value(lua_State *L, yajl_val value) {
    if (YAJL_IS_STRING(value)) {
        lua_pushstring(L, YAJL_GET_STRING(value));
    } else if (YAJL_IS_INTEGER(value)) {
        lua_pushinteger(L, (lua_Integer)YAJL_GET_INTEGER(value));
    } else if (YAJL_IS_NUMBER(value)) {
        lua_pushnumber(L, YAJL_GET_DOUBLE(value));
    } else if (YAJL_IS_TRUE(value) || YAJL_IS_FALSE(value)) {
        lua_pushboolean(L, YAJL_IS_TRUE(value));
    } else {
        return false;
    }
    return true;
}

static vn_status read_params(lua_State *L, const char *path) {
    char reason[200] = "";
    VN_TRY(push_file(L, path));
    yajl_val tree = yajl_tree_parse(lua_tostring(L, -1), reason, sizeof reason);
    lua_pop(L, 1);
    if (tree == NULL || !YAJL_IS_OBJECT(tree)) {
        reason[strcspn(reason, "\n")] = '\0';
        yajl_tree_free(tree);
        return vn_fail(VN_IO, "%s: a JSON object {\"name\": value, …} expected%s%s", path,
                       reason[0] != '\0' ? ": " : "", reason);
    }
    vn_status status = VN_OK;
    for (size_t i = 0; i < tree->u.object.len && status == VN_OK; i++) {
        if (push_json_value(L, tree->u.object.values[i])) {
            lua_setfield(L, -2, tree->u.object.keys[i]);
        } else {
            status = vn_fail(VN_IO, "%s: \"%s\" must be a number, a string, true or false", path,
                             tree->u.object.keys[i]);
        }
    }
    yajl_tree_free(tree);
    return status;
}

// Parameters from the file first; --set has the last word.
static void push_set(lua_State *L, const run_options *options) {
    lua_newtable(L);
    if (options->params != NULL) {
        vnl_try(L, read_params(L, options->params));
    }
    read_sets(L, options);
}

static void push_outputs(lua_State *L, const run_options *options) {
    lua_createtable(L, options->outputs.count, 0);
    for (int32_t i = 0; i < options->outputs.count; i++) {
        lua_pushstring(L, options->outputs.data[i]);
        lua_rawseti(L, -2, i + 1);
    }
}

static void set_host(lua_State *L, run_options *options, size_t size, const char *text) {
    lua_newtable(L);
    progress_push(L, options);
    push_set(L, options);
    lua_setfield(L, -2, "set");
    push_outputs(L, options);
    lua_setfield(L, -2, "outputs");
    lua_pushstring(L, options->script);
    lua_setfield(L, -2, "script");
    push_sha256(L, text, size);
    lua_setfield(L, -2, "script_sha256");
    lua_pushboolean(L, options->help);
    lua_setfield(L, -2, "help");
    lua_pushcfunction(L, show_help);
    lua_setfield(L, -2, "show_help");
    lua_pushcfunction(L, exit_usage);
    lua_setfield(L, -2, "fail_usage");
    lua_pushcfunction(L, exit_infeasible);
    lua_setfield(L, -2, "fail_infeasible");
    lua_setfield(L, LUA_REGISTRYINDEX, "venule.host");
}

// Everything that may raise runs in here.
static int run_protected(lua_State *L) {
    run_options *options = lua_touserdata(L, 1);
    size_t size;
    vnl_try(L, push_file(L, options->script));
    const char *text = lua_tolstring(L, -1, &size);
    set_host(L, options, size, text);
    sandbox_open(L, options->script, options->trust);
    luaL_requiref(L, "venule", luaopen_venule, 0);
    lua_pop(L, 1);
    if (size > 0 && text[0] == LUA_SIGNATURE[0]) {
        vnl_try(L, vn_fail(VN_INVALID, "%s: is bytecode; a script is text", options->script));
    }
    const char *chunk = lua_pushfstring(L, "@%s", options->script);
    if (luaL_loadbufferx(L, text, size, chunk, "t") != LUA_OK) {
        return lua_error(L);
    }
    limits_arm(L, options);
    lua_call(L, 0, 0);
    lua_getfield(L, LUA_REGISTRYINDEX, "venule.finished");
    if (options->outputs.count > 0 && !lua_toboolean(L, -1)) {
        vnl_try(L, vn_fail(VN_INVALID, "%s: -o %s was not written: the script never calls venule.result{…}",
                           options->script, options->outputs.data[0]));
    }
    return 0;
}

static int remembered_exit(lua_State *L, const char *message) {
    lua_getfield(L, LUA_REGISTRYINDEX, "venule.exit.message");
    lua_getfield(L, LUA_REGISTRYINDEX, "venule.exit");
    const char *last = lua_tostring(L, -2);
    int status = last != NULL && strcmp(last, message) == 0 ? (int)lua_tointeger(L, -1) : -1;
    lua_pop(L, 2);
    return status;
}

static int exit_of(lua_State *L, int code, const char *message) {
    int status = remembered_exit(L, message);
    if (status >= 0) {
        return status;
    }
    return code == LUA_ERRMEM ? vn_exit_status(VN_NO_MEMORY) : vn_exit_status(vnl_status_of(L, message));
}

// The message of the error on top. Metamethods are not asked: they are the script's, and nothing protects
// us here.
static const char *message_of(lua_State *L, char *text, size_t size) {
    if (lua_type(L, -1) == LUA_TSTRING) {
        return lua_tostring(L, -1);
    }
    snprintf(text, size, "the script raised a %s, not a message", luaL_typename(L, -1));
    return text;
}

static int report(lua_State *L, int code, run_options *options) {
    char text[80];
    vn_set_memory_budget(0); // what is left of memory must do for the message
    progress_clear(options);
    const char *message = message_of(L, text, sizeof text);
    int status = exit_of(L, code, message);
    if (status == 130) {
        fprintf(stderr, "venule: interrupted; what was not written yet is lost\n");
    } else if (code == LUA_ERRMEM) {
        fprintf(stderr, "venule: out of memory in the script (raise --memory, or make less)\n");
    } else if (status != 0) {
        fprintf(stderr, "venule: %s\n", message);
    }
    vn_set_memory_budget(options->memory);
    return status;
}

static int run_script(run_options *options) {
    lua_State *L = limits_new_state();
    if (L == NULL) {
        fprintf(stderr, "venule: out of memory\n");
        return vn_exit_status(VN_NO_MEMORY);
    }
    lua_pushcfunction(L, run_protected);
    lua_pushlightuserdata(L, options);
    int code = lua_pcall(L, 1, 0, 0);
    int status = code == LUA_OK ? 0 : report(L, code, options);
    progress_clear(options);
    lua_close(L); // finalisers are the script's too: the limits hold until they are done
    limits_disarm();
    return status;
}

int run_command(int argc, char **argv) {
    run_options options;
    int status = VN_EXIT_USAGE;
    if (read_run_options(&options, argc, argv)) {
        status = run_script(&options);
    }
    free_run_options(&options);
    return status;
}
