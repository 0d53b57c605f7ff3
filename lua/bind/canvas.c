#include "bind/bind.h"

#include "draw/canvas.h"

#include <math.h>
#include <string.h>

static void release_canvas(void *object) {
    vn_canvas_destroy(object);
}

static vn_canvas *check_canvas(lua_State *L) {
    return vnl_check(L, 1, &vnl_canvas_class);
}

// The view: bounds as domain:bounds() gives them, which may bring their unit.
static void read_view(lua_State *L, vn_canvas_def *def) {
    if (vnl_read_bounds(L, 1, "canvas", "view", &def->view)) {
        vnl_raw_field(L, 1, "view");
        vnl_raw_field(L, -1, "unit");
        if (lua_type(L, -1) == LUA_TSTRING && !vnl_has(L, 1, "unit")) {
            def->unit = lua_tostring(L, -1); // held by the view's own table
        }
        lua_pop(L, 2);
    }
}

static int make_canvas(lua_State *L) {
    vn_canvas_def def;
    vnl_read_options(L, 1, &vn_canvas_schema, &def);
    read_view(L, &def);
    void **box = vnl_push_box(L, &vnl_canvas_class);
    vnl_try(L, vn_canvas_create((vn_canvas **)box, &def));
    return 1;
}

static int canvas_fill(lua_State *L) {
    vn_fill_def def;
    vnl_read_options(L, 3, &vn_fill_schema, &def);
    vn_canvas *canvas = check_canvas(L);
    vnl_try(L, vn_canvas_fill(canvas, vnl_check_domain(L, 2), &def));
    return 0;
}

// width = function(node) … end: called once a node. What it does to the network meanwhile is seen afterwards.
static int32_t read_widths(lua_State *L, int source, double **widths) {
    int32_t count = vn_network_count(vnl_check(L, 2, &vnl_network_class));
    *widths = lua_newuserdatauv(L, ((size_t)count + 1) * sizeof **widths, 0);
    for (int32_t i = 0; i < count; i++) {
        lua_pushvalue(L, source);
        lua_pushinteger(L, i + 1);
        lua_call(L, 1, 1);
        double width = vnl_check_number(L, -1, "stroke.width");
        if (!(width >= 0 && width <= VN_HUGE)) { // the engine would count nodes from 0
            vnl_fail(L, "stroke.width: that of node %d is %g; give 0 or more", i + 1, width);
        }
        (*widths)[i] = width;
        lua_pop(L, 1);
    }
    return count;
}

static double constant_width(lua_State *L, int index) {
    bool radius = lua_type(L, index) == LUA_TSTRING && strcmp(lua_tostring(L, index), "radius") == 0;
    if (radius || lua_isnil(L, index)) {
        return 0;
    }
    if (lua_type(L, index) != LUA_TNUMBER) {
        vnl_fail(L, "stroke.width: \"radius\", a number or a function of the node expected, got %s",
                 lua_isstring(L, index) ? lua_tostring(L, index) : luaL_typename(L, index));
    }
    double width = lua_tonumber(L, index);
    if (!(width > 0 && width <= VN_HUGE)) {
        vnl_fail(L, "stroke.width = %g must be above 0 and finite (length)", width);
    }
    return width;
}

static int canvas_stroke(lua_State *L) {
    vn_stroke_def def;
    double *widths = NULL;
    int32_t count = 0;
    lua_settop(L, 3);
    vnl_read_options(L, 3, &vn_stroke_schema, &def);
    bool call = vnl_raw_field(L, 3, "width") == LUA_TFUNCTION;
    if (call) {
        count = read_widths(L, 4, &widths);
    } else {
        def.width = constant_width(L, 4);
    }
    def.widths = widths;
    vn_canvas *canvas = check_canvas(L);
    const vn_network *network = vnl_check(L, 2, &vnl_network_class);
    if (call && vn_network_count(network) != count) {
        return vnl_fail(L, "stroke.width: the function must not change the network");
    }
    vnl_try(L, vn_canvas_stroke(canvas, network, &def));
    return 0;
}

static int64_t count_points(lua_State *L, int index) {
    const vn_attractors *attractors = vnl_test(L, index, &vnl_attractors_class);
    if (attractors != NULL) {
        return vn_attractors_count(attractors);
    }
    luaL_checktype(L, index, LUA_TTABLE);
    return (int64_t)lua_rawlen(L, index);
}

static void read_point(lua_State *L, int index, int32_t i, double p[3]) {
    vn_attractors *attractors = vnl_test(L, index, &vnl_attractors_class);
    if (attractors != NULL) {
        vnl_try(L, vn_attractors_position(attractors, i, p));
        return;
    }
    lua_rawgeti(L, index, i + 1);
    vnl_read_point(L, -1, "dots", p);
    lua_pop(L, 1);
    if (!(fabs(p[0]) <= VN_HUGE && fabs(p[1]) <= VN_HUGE)) {
        vnl_fail(L, "dots: point %d = (%g, %g) is not finite", i + 1, p[0], p[1]);
    }
}

// Points of an attractors set or of a list {{x, y}, …}, copied into memory that Lua owns.
static int32_t read_points(lua_State *L, int index, double **x, double **y) {
    int64_t count = count_points(L, index);
    if (count > 100000000) {
        vnl_fail(L, "dots: %lld points are above the limit of 100,000,000", (long long)count);
    }
    *x = lua_newuserdatauv(L, (size_t)(2 * count + 1) * sizeof **x, 0);
    *y = *x + count;
    for (int32_t i = 0; i < count; i++) {
        double p[3];
        read_point(L, index, i, p);
        (*x)[i] = p[0];
        (*y)[i] = p[1];
    }
    return (int32_t)count;
}

static int canvas_dots(lua_State *L) {
    vn_dots_def def;
    double *x, *y;
    lua_settop(L, 3);
    vnl_read_options(L, 3, &vn_dots_schema, &def);
    int32_t count = read_points(L, 2, &x, &y);
    vnl_try(L, vn_canvas_dots(check_canvas(L), x, y, count, &def));
    return 0;
}

static int canvas_text(lua_State *L) {
    const char *text = luaL_checkstring(L, 2);
    vn_text_def def;
    vnl_read_options(L, 3, &vn_text_schema, &def);
    vnl_try(L, vn_canvas_text(check_canvas(L), text, &def));
    return 0;
}

static int canvas_save(lua_State *L) {
    const char *path = luaL_checkstring(L, 2);
    const char *manifest = vnl_push_manifest(L);
    vnl_try(L, vn_canvas_save(check_canvas(L), path, manifest));
    return 0;
}

static const vnl_function methods[] = {
    {"fill", canvas_fill, "(domain: venule.Domain|venule.Growth, options?: venule.fill.Options)", NULL,
     "Fill a domain, or today's shape of a growth.", &vn_fill_schema},
    {"stroke", canvas_stroke, "(network: venule.Network, options?: venule.stroke.Options)", NULL,
     "Draw a network with round ends, tapered where radii differ. `width` is \"radius\" (the default), a "
     "number, or a "
     "function of the node.",
     &vn_stroke_schema},
    {"dots", canvas_dots, "(points: venule.Attractors|number[][], options?: venule.dots.Options)", NULL,
     "A dot at each attractor, or at each point {x, y} of a list.", &vn_dots_schema},
    {"text", canvas_text, "(text: string, options: venule.text.Options)", NULL, "Write one line of text.",
     &vn_text_schema},
    {"save", canvas_save, "(path: string)", NULL,
     "Write the picture: .png, .svg or .pdf by the path's extension.", NULL},
    {0},
};

static int canvas_field(lua_State *L) {
    const vn_canvas *canvas = check_canvas(L);
    const char *key = lua_tostring(L, 2);
    if (strcmp(key, "width") == 0) {
        lua_pushnumber(L, vn_canvas_width(canvas));
    } else if (strcmp(key, "height") == 0) {
        lua_pushnumber(L, vn_canvas_height(canvas));
    } else if (strcmp(key, "scale") == 0) {
        lua_pushnumber(L, vn_canvas_scale(canvas));
    } else {
        return 0;
    }
    return 1;
}

static const char *const fields[] = {"width: number | pixels", "height: number | pixels",
                                     "scale: number | pixels to one unit of the view's length", NULL};

const vnl_class vnl_canvas_class = {
    .name = "canvas",
    .doc = "A picture: a list of what was drawn, which becomes a file when it is saved.",
    .methods = methods,
    .fields = fields,
    .field = canvas_field,
    .release = release_canvas,
};

const vnl_function vnl_canvas_functions[] = {
    {"canvas", make_canvas, NULL, "venule.Canvas", "An empty picture.", &vn_canvas_schema},
    {0},
};
