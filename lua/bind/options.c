// The strict reader: one schema row says what a field may be, and this file says so to whoever got it wrong.

#include "bind/bind.h"

#include <stdio.h>
#include <string.h>

static const vnl_class *class_by_name(const char *name) {
    for (int i = 0; vnl_classes[i] != NULL; i++) {
        if (strcmp(vnl_classes[i]->name, name) == 0) {
            return vnl_classes[i];
        }
    }
    return NULL;
}

__attribute__((noreturn)) static void fail_type(lua_State *L, const vn_schema *schema, const vn_field *field,
                                                const char *wanted) {
    const char *got = lua_isuserdata(L, -1) ? luaL_tolstring(L, -1, NULL) : luaL_typename(L, -1);
    vnl_fail(L, "%s.%s: %s expected, got %s (%s)", schema->name, field->name, wanted, got, field->doc);
}

__attribute__((noreturn)) static void fail_unknown_field(lua_State *L, const vn_schema *schema,
                                                         const char *key) {
    const char *names[64];
    int count = 0;
    for (; count < schema->count && count < 64; count++) {
        names[count] = schema->fields[count].name;
    }
    const char *closest = vn_closest_name(key, names, count);
    if (closest != NULL) {
        vnl_fail(L, "%s: unknown field \"%s\", did you mean \"%s\"?", schema->name, key, closest);
    }
    vnl_fail(L, "%s: unknown field \"%s\"", schema->name, key);
}

// Of several unknown fields the first by alphabet is named: lua_next() walks in an order that changes
// from run to run.
static void check_names(lua_State *L, int index, const vn_schema *schema) {
    lua_pushnil(L); // the unknown name found so far
    int found = lua_gettop(L);
    for (lua_pushnil(L); lua_next(L, index) != 0; lua_pop(L, 1)) {
        const char *key = lua_type(L, -2) == LUA_TSTRING ? lua_tostring(L, -2) : NULL;
        if (key != NULL && vn_find_field(schema, key) != NULL) {
            continue;
        }
        // lua_tostring() would turn a number in place and confuse lua_next(); luaL_tolstring() makes a copy.
        const char *name = luaL_tolstring(L, -2, NULL);
        if (lua_isnil(L, found) || strcmp(name, lua_tostring(L, found)) < 0) {
            lua_copy(L, -1, found);
        }
        lua_pop(L, 1);
    }
    if (!lua_isnil(L, found)) {
        fail_unknown_field(L, schema, lua_tostring(L, found));
    }
    lua_pop(L, 1);
}

static void read_number(lua_State *L, const vn_schema *schema, const vn_field *field, void *slot) {
    if (lua_type(L, -1) != LUA_TNUMBER) {
        fail_type(L, schema, field, "number");
    }
    double value = lua_tonumber(L, -1);
    vnl_try(L, vn_check_number(schema, field, value));
    if (field->type == VN_F64) {
        *(double *)slot = value;
        return;
    }
    lua_Integer whole;
    int exact;
    whole = lua_tointegerx(L, -1, &exact);
    if (!exact) {
        vnl_fail(L, "%s.%s = %g must be a whole number: %s", schema->name, field->name, value, field->doc);
    }
    if (field->type == VN_I32) {
        *(int32_t *)slot = (int32_t)whole;
    } else {
        *(int64_t *)slot = whole;
    }
}

static void read_choice(lua_State *L, const vn_schema *schema, const vn_field *field, void *slot) {
    if (lua_type(L, -1) != LUA_TSTRING) {
        fail_type(L, schema, field, field->kind);
    }
    int choice = vn_choice_index(field->kind, lua_tostring(L, -1));
    if (choice < 0) {
        vnl_fail(L, "%s.%s = \"%s\" must be one of %s: %s", schema->name, field->name, lua_tostring(L, -1),
                 field->kind, field->doc);
    }
    *(int *)slot = choice;
}

static void read_object(lua_State *L, const vn_schema *schema, const vn_field *field, void *slot) {
    const vnl_class *class = class_by_name(field->kind);
    void *object = class == &vnl_domain_class ? (void *)vnl_test_domain(L, -1) : vnl_test(L, -1, class);
    if (object == NULL) {
        fail_type(L, schema, field, field->kind);
    }
    *(void **)slot = object;
}

int vnl_read_point(lua_State *L, int index, const char *what, double p[3]) {
    index = lua_absindex(L, index);
    if (lua_type(L, index) != LUA_TTABLE) {
        vnl_fail(L, "%s: a point {x, y} expected, got %s", what, luaL_typename(L, index));
    }
    lua_Integer count = (lua_Integer)lua_rawlen(L, index);
    if (count < 2 || count > 3) {
        vnl_fail(L, "%s: a point has 2 or 3 coordinates, not %d", what, (int)count);
    }
    p[2] = 0;
    for (int k = 0; k < count; k++) {
        lua_rawgeti(L, index, k + 1);
        p[k] = vnl_check_number(L, -1, what);
        lua_pop(L, 1);
    }
    return (int)count;
}

static void read_corner(lua_State *L, const char *schema, const char *field, const char *corner,
                        double p[3]) {
    char what[96];
    snprintf(what, sizeof what, "%s.%s.%s", schema, field, corner);
    vnl_raw_field(L, -1, corner);
    vnl_read_point(L, -1, what, p);
    lua_pop(L, 1);
}

bool vnl_read_bounds(lua_State *L, int index, const char *schema, const char *field, vn_box *box) {
    bool given = vnl_raw_field(L, index, field) != LUA_TNIL;
    if (given && !lua_istable(L, -1)) {
        vnl_fail(L, "%s.%s: {min = {x, y}, max = {x, y}} expected, as domain:bounds() gives it, got %s",
                 schema, field, luaL_typename(L, -1));
    }
    if (given) {
        read_corner(L, schema, field, "min", box->min);
        read_corner(L, schema, field, "max", box->max);
    }
    lua_pop(L, 1);
    return given;
}

static void read_point(lua_State *L, const vn_schema *schema, const vn_field *field, double *slot) {
    char what[96];
    snprintf(what, sizeof what, "%s.%s", schema->name, field->name);
    vnl_read_point(L, -1, what, slot);
}

static void read_field(lua_State *L, const vn_schema *schema, const vn_field *field, void *def) {
    void *slot = (char *)def + field->offset;
    switch (field->type) {
    case VN_F64:
    case VN_I32:
    case VN_I64:
        read_number(L, schema, field, slot);
        break;
    case VN_BOOL:
        if (!lua_isboolean(L, -1)) {
            fail_type(L, schema, field, "true or false");
        }
        *(bool *)slot = lua_toboolean(L, -1);
        break;
    case VN_CHOICE:
        read_choice(L, schema, field, slot);
        break;
    case VN_POINT:
        read_point(L, schema, field, slot);
        break;
    case VN_TEXT:
        if (lua_type(L, -1) != LUA_TSTRING) {
            fail_type(L, schema, field, "string");
        }
        *(const char **)slot = lua_tostring(L, -1);
        break;
    case VN_OBJECT:
        read_object(L, schema, field, slot);
        break;
    case VN_MIXED:
        break;
    }
}

// Reading a field makes strings, which may run a script's finalisers, which may close what was read before.
// This pass allocates nothing: the objects it finds are open when it returns.
static void renew_objects(lua_State *L, int index, const vn_schema *schema, void *def) {
    for (lua_pushnil(L); lua_next(L, index) != 0; lua_pop(L, 1)) {
        const vn_field *field =
            vn_find_field(schema, lua_tostring(L, -2)); // every key is a known name by now
        if (field != NULL && field->type == VN_OBJECT) {
            read_object(L, schema, field, (char *)def + field->offset);
        }
    }
}

void vnl_read_options(lua_State *L, int index, const vn_schema *schema, void *def) {
    index = lua_absindex(L, index);
    luaL_checkstack(L, 16, "options");
    memcpy(def, schema->defaults, schema->size);
    if (lua_isnoneornil(L, index)) {
        lua_settop(L, index > lua_gettop(L) ? index : lua_gettop(L));
        lua_newtable(L);
        lua_replace(L, index);
    }
    if (!lua_istable(L, index)) {
        vnl_fail(L, "%s: a table of options {…} expected, got %s", schema->name, luaL_typename(L, index));
    }
    check_names(L, index, schema);
    for (int i = 0; i < schema->count; i++) {
        if (vnl_raw_field(L, index, schema->fields[i].name) != LUA_TNIL) {
            read_field(L, schema, &schema->fields[i], def);
        }
        lua_pop(L, 1);
    }
    for (int i = 0; i < schema->count; i++) {
        const vn_field *field = &schema->fields[i];
        if ((field->flags & VN_REQUIRED) && !vnl_has(L, index, field->name)) {
            vnl_fail(L, "%s: `%s` is missing: %s", schema->name, field->name, field->doc);
        }
    }
    renew_objects(L, index, schema, def);
}

bool vnl_has(lua_State *L, int index, const char *field) {
    bool has = vnl_raw_field(L, index, field) != LUA_TNIL;
    lua_pop(L, 1);
    return has;
}

int vnl_raw_field(lua_State *L, int index, const char *field) {
    index = lua_absindex(L, index);
    lua_pushstring(L, field);
    return lua_rawget(L, index);
}

bool vnl_read_switch(lua_State *L, int index, const char *verb, const char *field, bool otherwise) {
    if (!lua_istable(L, index)) {
        return otherwise;
    }
    int type = vnl_raw_field(L, index, field);
    if (type != LUA_TNIL && type != LUA_TBOOLEAN) {
        vnl_fail(L, "%s.%s: true or false expected, got %s", verb, field, luaL_typename(L, -1));
    }
    bool value = type == LUA_TNIL ? otherwise : lua_toboolean(L, -1);
    lua_pop(L, 1);
    return value;
}

lua_Integer vnl_check_integer(lua_State *L, int index, const char *what) {
    if (!lua_isinteger(L, index)) {
        double value = vnl_check_number(L, index, what);
        vnl_fail(L, "%s: whole number expected, got %g", what, value);
    }
    return lua_tointeger(L, index);
}

double vnl_check_number(lua_State *L, int index, const char *what) {
    if (lua_type(L, index) != LUA_TNUMBER) {
        vnl_fail(L, "%s: number expected, got %s", what, luaL_typename(L, index));
    }
    return lua_tonumber(L, index);
}

void vnl_check_coordinates(lua_State *L, int index, int dim, double p[3]) {
    static const char *const names[3] = {"x", "y", "z"};
    p[2] = 0;
    for (int k = 0; k < dim && k < 3; k++) {
        p[k] = vnl_check_number(L, index + k, names[k]);
    }
}

void vnl_set_integer(lua_State *L, const char *name, lua_Integer value) {
    lua_pushinteger(L, value);
    lua_setfield(L, -2, name);
}

void vnl_set_number(lua_State *L, const char *name, double value) {
    lua_pushnumber(L, value);
    lua_setfield(L, -2, name);
}

void vnl_set_list(lua_State *L, const char *name, const double *values, int32_t count) {
    lua_createtable(L, count, 0);
    for (int32_t i = 0; i < count; i++) {
        lua_pushnumber(L, values[i]);
        lua_rawseti(L, -2, i + 1);
    }
    lua_setfield(L, -2, name);
}

void vnl_set_statistics(lua_State *L, const char *name, const vn_statistics *s) {
    lua_createtable(L, 0, 8);
    vnl_set_integer(L, "count", s->count);
    vnl_set_number(L, "mean", s->mean);
    vnl_set_number(L, "deviation", s->deviation);
    vnl_set_number(L, "min", s->min);
    vnl_set_number(L, "lower", s->lower);
    vnl_set_number(L, "median", s->median);
    vnl_set_number(L, "upper", s->upper);
    vnl_set_number(L, "max", s->max);
    lua_setfield(L, -2, name);
}

void vnl_set_spread(lua_State *L, const char *name, const vn_spread *spread) {
    lua_createtable(L, 0, 2);
    vnl_set_number(L, "mean", spread->mean);
    vnl_set_number(L, "deviation", spread->deviation);
    lua_setfield(L, -2, name);
}

int vnl_push_coordinates(lua_State *L, int dim, const double p[3]) {
    for (int k = 0; k < dim; k++) {
        lua_pushnumber(L, p[k]);
    }
    return dim;
}

void vnl_set_point(lua_State *L, const char *name, int dim, const double p[3]) {
    lua_createtable(L, dim, 0);
    for (int k = 0; k < dim; k++) {
        lua_pushnumber(L, p[k]);
        lua_rawseti(L, -2, k + 1);
    }
    lua_setfield(L, -2, name);
}

void vnl_push_bounds(lua_State *L, int dim, const vn_box *box, const char *unit) {
    lua_createtable(L, 0, 3);
    vnl_set_point(L, "min", dim, box->min);
    vnl_set_point(L, "max", dim, box->max);
    if (unit != NULL && unit[0] != '\0') {
        lua_pushstring(L, unit);
        lua_setfield(L, -2, "unit");
    }
}

// ---- A schema for the reader in Lua ----

static bool is_number(const vn_field *field) {
    return field->type == VN_F64 || field->type == VN_I32 || field->type == VN_I64;
}

static void push_choices(lua_State *L, const char *choices) {
    lua_newtable(L);
    for (lua_Integer i = 1; choices != NULL; i++) {
        const char *end = strchr(choices, '|');
        lua_pushlstring(L, choices, end != NULL ? (size_t)(end - choices) : strlen(choices));
        lua_rawseti(L, -2, i);
        choices = end != NULL ? end + 1 : NULL;
    }
}

static void push_default(lua_State *L, const vn_schema *schema, const vn_field *field) {
    const void *slot = (const char *)schema->defaults + field->offset;
    bool given = (field->flags & (VN_OPTIONAL | VN_REQUIRED)) == 0;
    if (given && field->type == VN_F64) {
        lua_pushnumber(L, *(const double *)slot);
    } else if (given && is_number(field)) {
        lua_pushinteger(L, (lua_Integer)vn_field_number(field, schema->defaults));
    } else if (given && field->type == VN_BOOL) {
        lua_pushboolean(L, *(const bool *)slot);
    } else if (given && field->type == VN_CHOICE) {
        push_choices(L, field->kind);
        lua_rawgeti(L, -1, *(const int *)slot + 1);
        lua_remove(L, -2);
    } else {
        lua_pushnil(L);
    }
}

static void set_range(lua_State *L, const vn_field *field) {
    static const double open = 1e15; // beyond it a limit is there for the arithmetic, and not for the reader
    if (field->min > -open) {
        vnl_set_number(L, field->flags & VN_ABOVE_MIN ? "above" : "min", field->min);
    }
    if (field->max < open) {
        vnl_set_number(L, "max", field->max);
    }
}

static void set_text(lua_State *L, const char *name, const char *text) {
    lua_pushstring(L, text);
    lua_setfield(L, -2, name);
}

static void push_row(lua_State *L, const vn_schema *schema, const vn_field *field) {
    static const char *const types[] = {"number", "integer", "integer",  "boolean", "string",
                                        "table",  "string",  "userdata", "any"};
    lua_createtable(L, 2, 6);
    lua_pushstring(L, field->name);
    lua_rawseti(L, -2, 1);
    push_default(L, schema, field);
    lua_rawseti(L, -2, 2);
    set_text(L, "type", types[field->type]);
    set_text(L, "unit", field->unit);
    set_text(L, "doc", field->doc);
    lua_pushboolean(L, (field->flags & VN_REQUIRED) != 0);
    lua_setfield(L, -2, "required");
    if (is_number(field)) {
        set_range(L, field);
    }
    if (field->type == VN_CHOICE) {
        push_choices(L, field->kind);
        lua_setfield(L, -2, "choices");
    }
}

void vnl_push_rows(lua_State *L, const vn_schema *schema) {
    lua_createtable(L, schema->count, 0);
    for (int i = 0; i < schema->count; i++) {
        push_row(L, schema, &schema->fields[i]);
        lua_rawseti(L, -2, i + 1);
    }
}
