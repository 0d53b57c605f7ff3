#include "bind/bind.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const STATUS_KEY = "venule.status";

// The metatable stands in the registry under the class's address. Looking it up allocates nothing, so that no
// garbage collection, and no finaliser of a script's, can run between the check of an object and its use.
static void **box_at(lua_State *L, int index, const vnl_class *class) {
    void **box = lua_touserdata(L, index);
    if (box == NULL || !lua_getmetatable(L, index)) {
        return NULL;
    }
    lua_rawgetp(L, LUA_REGISTRYINDEX, class);
    bool same = lua_rawequal(L, -1, -2);
    lua_pop(L, 2);
    return same ? box : NULL;
}

void *vnl_push_owned(lua_State *L, size_t size, lua_CFunction release) {
    void *block = lua_newuserdatauv(L, size, 0);
    memset(block, 0, size);
    lua_createtable(L, 0, 1);
    lua_pushcfunction(L, release);
    lua_setfield(L, -2, "__gc");
    lua_setmetatable(L, -2);
    return block;
}

void **vnl_push_box(lua_State *L, const vnl_class *class) {
    void **box = lua_newuserdatauv(L, sizeof *box, 1);
    *box = NULL;
    lua_rawgetp(L, LUA_REGISTRYINDEX, class);
    lua_setmetatable(L, -2);
    return box;
}

void *vnl_test(lua_State *L, int index, const vnl_class *class) {
    void **box = box_at(L, index, class);
    return box != NULL ? *box : NULL;
}

void *vnl_check(lua_State *L, int index, const vnl_class *class) {
    void **box = box_at(L, index, class);
    void *object = box != NULL ? *box : NULL;
    if (box == NULL) {
        luaL_typeerror(L, index, class->name);
    } else if (object == NULL) {
        vnl_fail(L, "this %s is closed", class->name);
    }
    return object;
}

vn_domain *vnl_test_domain(lua_State *L, int index) {
    vn_growth *growth = vnl_test(L, index, &vnl_growth_class);
    return growth != NULL ? vn_growth_domain(growth) : vnl_test(L, index, &vnl_domain_class);
}

vn_domain *vnl_check_domain(lua_State *L, int index) {
    if (box_at(L, index, &vnl_growth_class) != NULL) {
        return vn_growth_domain(vnl_check(L, index, &vnl_growth_class));
    }
    return vnl_check(L, index, &vnl_domain_class);
}

void vnl_keep(lua_State *L, int object, int value) {
    object = lua_absindex(L, object);
    lua_pushvalue(L, value);
    lua_setiuservalue(L, object, 1);
}

// The line of the script: the innermost function that is neither C nor one of our own Lua modules.
static void push_where(lua_State *L) {
    lua_Debug at;
    for (int level = 0; lua_getstack(L, level, &at); level++) {
        lua_getinfo(L, "Sl", &at);
        bool own = strncmp(at.source, "=venule.", 8) == 0; // a script's own name begins with '@'
        if (at.currentline > 0 && !own) {
            lua_pushfstring(L, "%s:%d: ", at.short_src, at.currentline);
            return;
        }
    }
    lua_pushliteral(L, "");
}

// Time is up, or somebody wants the run to end: the host's hook sees to it, at the next instruction, that no
// pcall() outlives the error on top of the stack.
static void stop_run(lua_State *L) {
    lua_pushvalue(L, -1);
    lua_setfield(L, LUA_REGISTRYINDEX, "venule.stopped");
    if (lua_gethook(L) != NULL) {
        lua_sethook(L, lua_gethook(L), LUA_MASKCOUNT, 1);
    }
}

void vnl_try(lua_State *L, vn_status status) {
    if (status == VN_OK) {
        return;
    }
    push_where(L);
    lua_pushstring(L, vn_message());
    lua_concat(L, 2);
    lua_pushinteger(L, status);
    lua_setfield(L, LUA_REGISTRYINDEX, STATUS_KEY);
    lua_pushvalue(L, -1);
    lua_setfield(L, LUA_REGISTRYINDEX, "venule.message");
    if (status == VN_INTERRUPTED || (status == VN_LIMIT && vn_poll() != VN_OK)) {
        stop_run(L);
    }
    lua_error(L);
}

int vnl_fail(lua_State *L, const char *format, ...) {
    char text[400];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    vnl_try(L, vn_fail(VN_INVALID, "%s", text));
    abort(); // vnl_try() has left by now
}

vn_status vnl_status_of(lua_State *L, const char *message) {
    vn_status status = VN_INVALID;
    lua_getfield(L, LUA_REGISTRYINDEX, "venule.message");
    const char *last = lua_tostring(L, -1);
    // The message may have gained a traceback, or a position where it was raised again.
    if (last != NULL && message != NULL && strstr(message, last) != NULL) {
        lua_getfield(L, LUA_REGISTRYINDEX, STATUS_KEY);
        status = (vn_status)lua_tointeger(L, -1);
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    return status;
}

static const vnl_class *class_of(lua_State *L) {
    return lua_touserdata(L, lua_upvalueindex(1));
}

static int close_box(lua_State *L) {
    const vnl_class *class = class_of(L);
    void **box = box_at(L, 1, class);
    if (box != NULL && *box != NULL) {
        void *object = *box;
        *box = NULL;
        class->release(object);
    }
    return 0;
}

static int show_box(lua_State *L) {
    const vnl_class *class = class_of(L);
    void **box = box_at(L, 1, class);
    bool closed = box == NULL || *box == NULL;
    if (!closed && class->length != NULL) {
        lua_pushcfunction(L, class->length);
        lua_pushvalue(L, 1);
        lua_call(L, 1, 1);
        lua_pushfstring(L, "venule.%s of %d", class->name, (int)lua_tointeger(L, -1));
    } else {
        lua_pushfstring(L, "venule.%s%s", class->name, closed ? " (closed)" : "");
    }
    return 1;
}

static int count_names(const vnl_class *class, const char **names, int room) {
    int count = 0;
    for (const vnl_function *f = class->methods; f->name != NULL && count < room; f++) {
        names[count++] = f->name;
    }
    for (const vnl_function *f = class->extra; f != NULL && f->name != NULL && count < room; f++) {
        names[count++] = f->name;
    }
    names[count++] = "close";
    return count;
}

static int fail_unknown(lua_State *L, const vnl_class *class, const char *key) {
    const char *names[96];
    char fields[32][32];
    int count = count_names(class, names, 64);
    for (int i = 0; class->fields != NULL && class->fields[i] != NULL && i < 32; i++) {
        const char *end = strchr(class->fields[i], ':');
        snprintf(fields[i], sizeof fields[i], "%.*s", (int)(end - class->fields[i]), class->fields[i]);
        names[count++] = fields[i];
    }
    const char *closest = vn_closest_name(key, names, count);
    if (closest != NULL) {
        return vnl_fail(L, "%s has no \"%s\", did you mean \"%s\"?", class->name, key, closest);
    }
    return vnl_fail(L, "%s has no \"%s\"", class->name, key);
}

// Methods first, then the class's own fields; anything else is an error, not nil: `net.raduis` must not
// pass silently.
static int index_box(lua_State *L) {
    const vnl_class *class = class_of(L);
    lua_pushvalue(L, 2);
    if (lua_rawget(L, lua_upvalueindex(2)) != LUA_TNIL) {
        return 1;
    }
    if (class->field != NULL && lua_type(L, 2) == LUA_TSTRING) {
        lua_settop(L, 2);
        vnl_check(L, 1, class);
        int results = class->field(L);
        if (results > 0) {
            return results;
        }
    }
    return fail_unknown(L, class, luaL_tolstring(L, 2, NULL));
}

static int refuse_assignment(lua_State *L) {
    return vnl_fail(L, "%s.%s cannot be set", class_of(L)->name, luaL_tolstring(L, 2, NULL));
}

// Operators ("__add") go into the metatable, methods into its __index.
static void set_functions(lua_State *L, const vnl_function *functions, bool operators) {
    for (const vnl_function *f = functions; f != NULL && f->name != NULL; f++) {
        if (f->call != NULL && (strncmp(f->name, "__", 2) == 0) == operators) {
            lua_pushcfunction(L, f->call);
            lua_setfield(L, -2, f->name);
        }
    }
}

void vnl_push_functions(lua_State *L, const vnl_function *functions) {
    lua_newtable(L);
    set_functions(L, functions, false);
}

static void set_with_class(lua_State *L, const vnl_class *class, const char *name, lua_CFunction function) {
    lua_pushlightuserdata(L, (void *)class);
    lua_pushcclosure(L, function, 1);
    lua_setfield(L, -2, name);
}

void vnl_register(lua_State *L, const vnl_class *class) {
    lua_createtable(L, 0, 8);
    lua_pushvalue(L, -1);
    lua_rawsetp(L, LUA_REGISTRYINDEX, class);
    lua_pushfstring(L, "venule.%s", class->name);
    lua_setfield(L, -2, "__name");
    set_with_class(L, class, "__gc", close_box);
    set_with_class(L, class, "__close", close_box);
    set_with_class(L, class, "__tostring", show_box);
    set_with_class(L, class, "__newindex", refuse_assignment);
    if (class->length != NULL) {
        lua_pushcfunction(L, class->length);
        lua_setfield(L, -2, "__len");
    }
    set_functions(L, class->methods, true);
    set_functions(L, class->extra, true);
    lua_pushlightuserdata(L, (void *)class);
    vnl_push_functions(L, class->methods);
    set_functions(L, class->extra, false);
    set_with_class(L, class, "close", close_box);
    lua_pushcclosure(L, index_box, 2);
    lua_setfield(L, -2, "__index");
    lua_pop(L, 1);
}

/// A column seen from Lua. It fetches the data at each access, so that growth of the object does not
/// matter to it.
typedef struct view {
    const vnl_class *class;
    vnl_read_fn *read;
    vnl_count_fn *count;
    lua_CFunction call; // what the column does when it is called as a method; may be NULL
} view;

static void *view_object(lua_State *L, const view *v) {
    lua_getiuservalue(L, 1, 1);
    return vnl_check(L, -1, v->class);
}

static int view_index(lua_State *L) {
    const view *v = luaL_checkudata(L, 1, "venule.view");
    if (!lua_isinteger(L, 2)) {
        return vnl_fail(L, "a column is read by whole numbers from 1, not by %s", luaL_tolstring(L, 2, NULL));
    }
    void *object = view_object(L, v);
    lua_Integer i = lua_tointeger(L, 2);
    if (i < 1 || i > v->count(object)) {
        return 0; // nil, so that ipairs() ends
    }
    v->read(L, object, (int32_t)(i - 1));
    return 1;
}

static int view_length(lua_State *L) {
    const view *v = luaL_checkudata(L, 1, "venule.view");
    lua_pushinteger(L, v->count(view_object(L, v)));
    return 1;
}

// `net:flow{…}` beside `net.flow[i]`: what the column is called with begins with its object again.
static int view_call(lua_State *L) {
    const view *v = luaL_checkudata(L, 1, "venule.view");
    if (v->call == NULL) {
        return vnl_fail(L, "a column is read by [index], not called");
    }
    lua_remove(L, 1);
    return v->call(L);
}

static int view_assign(lua_State *L) {
    return vnl_fail(L, "columns cannot be written to");
}

void vnl_push_view(lua_State *L, int object, const vnl_class *class, vnl_read_fn *read, vnl_count_fn *count) {
    object = lua_absindex(L, object);
    view *v = lua_newuserdatauv(L, sizeof *v, 1);
    *v = (view){class, read, count, NULL};
    vnl_keep(L, -1, object);
    luaL_setmetatable(L, "venule.view");
}

void vnl_set_view_call(lua_State *L, lua_CFunction call) {
    view *v = lua_touserdata(L, -1);
    v->call = call;
}

void vnl_register_view(lua_State *L) {
    luaL_newmetatable(L, "venule.view");
    lua_pushcfunction(L, view_index);
    lua_setfield(L, -2, "__index");
    lua_pushcfunction(L, view_length);
    lua_setfield(L, -2, "__len");
    lua_pushcfunction(L, view_call);
    lua_setfield(L, -2, "__call");
    lua_pushcfunction(L, view_assign);
    lua_setfield(L, -2, "__newindex");
    lua_pop(L, 1);
}
