// `venule test`: each test file in a state of its own, by luaunit, with everything of Lua open; after each,
// the engine must hold no memory.

#include "bind/bind.h"
#include "host/host.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

typedef VN_ARRAY(char *) path_list;

static int run_file(lua_State *L) {
    const char *path = lua_touserdata(L, 1);
    sandbox_open(L, path, true);
    luaL_requiref(L, "venule", luaopen_venule, 1);
    static const char script[] =
        "local path = ...\n"
        "local luaunit = require 'luaunit'\n"
        "local chunk = assert(loadfile(path, 't'))\n"
        "chunk(path)\n"
        "local runner = luaunit.LuaUnit.new()\n"
        "runner:setOutputType('text')\n"
        "local failures = runner:runSuite()\n"
        "if runner.result.runCount == 0 then error(path .. ': holds no tests', 0) end\n"
        "return failures\n";
    if (luaL_loadbufferx(L, script, sizeof script - 1, "=venule test", "t") != LUA_OK) {
        return lua_error(L);
    }
    lua_pushstring(L, path);
    lua_call(L, 1, 1);
    return 1;
}

static bool test_file(const char *path) {
    printf("%s\n", path);
    fflush(stdout);
    size_t before = vn_byte_count();
    lua_State *L = limits_new_state();
    if (L == NULL) {
        return false;
    }
    lua_pushcfunction(L, run_file);
    lua_pushlightuserdata(L, (void *)path);
    int code = lua_pcall(L, 1, 1, 0);
    bool passed = code == LUA_OK && lua_tointeger(L, -1) == 0;
    if (code != LUA_OK) {
        fprintf(stderr, "venule: %s\n", luaL_tolstring(L, -1, NULL));
    }
    lua_close(L);
    if (vn_byte_count() != before) {
        fprintf(stderr, "venule: %s: %zu bytes were not given back\n", path, vn_byte_count() - before);
        passed = false;
    }
    return passed;
}

static bool add_path(path_list *paths, const char *folder, const char *name) {
    size_t size = strlen(folder) + strlen(name) + 2;
    bool room = vn_array_reserve(paths, (int64_t)paths->count + 1) == VN_OK;
    char *path = room ? malloc(size) : NULL;
    if (path == NULL) {
        return false;
    }
    snprintf(path, size, "%s%s%s", folder, folder[0] != '\0' ? "/" : "", name);
    paths->data[paths->count++] = path;
    return true;
}

static int by_name(const void *a, const void *b) {
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static bool add_folder(path_list *paths, const char *folder) {
    DIR *dir = opendir(folder);
    int32_t first = paths->count;
    if (dir == NULL) {
        return false;
    }
    for (struct dirent *entry; (entry = readdir(dir)) != NULL;) {
        size_t length = strlen(entry->d_name);
        if (strncmp(entry->d_name, "test_", 5) == 0 && length > 9 &&
            strcmp(entry->d_name + length - 4, ".lua") == 0) {
            add_path(paths, folder, entry->d_name);
        }
    }
    closedir(dir);
    if (paths->count > first) {
        qsort(paths->data + first, (size_t)(paths->count - first), sizeof *paths->data, by_name);
    }
    return true;
}

static bool add_argument(path_list *paths, const char *argument) {
    struct stat info;
    if (stat(argument, &info) != 0) {
        fprintf(stderr, "venule: test: %s: there is no such file or folder\n", argument);
        return false;
    }
    return S_ISDIR(info.st_mode) ? add_folder(paths, argument) : add_path(paths, "", argument);
}

int test_command(int argc, char **argv) {
    path_list paths = {0};
    int status = 0;
    for (int i = 0; i < argc && status == 0; i++) {
        status = add_argument(&paths, argv[i]) ? 0 : vn_exit_status(VN_IO);
    }
    if (status == 0 && paths.count == 0) {
        fprintf(stderr, "venule: test: no tests (venule test FILE|FOLDER…; in folders, test_*.lua)\n");
        status = VN_EXIT_USAGE;
    }
    for (int32_t i = 0; i < paths.count; i++) {
        if (status <= 1 && !test_file(paths.data[i])) {
            status = 1;
        }
        free(paths.data[i]);
    }
    vn_array_free(&paths);
    return status;
}
