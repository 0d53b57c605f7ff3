#include "bind/bind.h"

#include "draw/canvas.h"

#include <math.h>
#include <stdio.h>
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
    vn_camera_def camera;
    lua_settop(L, 1);
    vnl_read_options(L, 1, &vn_canvas_schema, &def);
    read_view(L, &def);
    if (vnl_raw_field(L, 1, "camera") != LUA_TNIL) {
        vnl_read_options(L, 2, &vn_camera_schema, &camera);
        def.camera = &camera;
    }
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

static uint32_t check_rgb(lua_State *L, int32_t node) {
    char what[64];
    vn_color color;
    snprintf(what, sizeof what, "stroke.color_by: that of node %d", node);
    if (lua_type(L, -1) != LUA_TSTRING) {
        vnl_fail(L, "%s: a colour expected, as before, got %s", what, luaL_typename(L, -1));
    }
    vnl_try(L, vn_color_parse(&color, lua_tostring(L, -1), what));
    if (color.alpha != 255) {
        vnl_fail(L, "%s = \"%.20s\" must be opaque; opacity holds for all", what, lua_tostring(L, -1));
    }
    return (uint32_t)color.red << 16 | (uint32_t)color.green << 8 | color.blue;
}

static void push_entry(lua_State *L, int source, int32_t i) {
    if (lua_isfunction(L, source)) {
        lua_pushvalue(L, source);
        lua_pushinteger(L, i + 1);
        lua_call(L, 1, 1);
    } else {
        lua_rawgeti(L, source, i + 1);
    }
}

// One number or one colour a node, from a function or a list; the first says which. As read_widths().
static void read_entries(lua_State *L, int source, int32_t count, vn_stroke_def *def) {
    double *values = lua_newuserdatauv(L, ((size_t)count + 1) * sizeof *values, 0);
    uint32_t *colors = lua_newuserdatauv(L, ((size_t)count + 1) * sizeof *colors, 0);
    bool colored = false;
    for (int32_t i = 0; i < count; i++) {
        push_entry(L, source, i);
        colored = i == 0 ? lua_type(L, -1) == LUA_TSTRING : colored;
        if (colored) {
            colors[i] = check_rgb(L, i + 1);
        } else {
            values[i] = vnl_check_number(L, -1, "stroke.color_by");
        }
        lua_pop(L, 1);
    }
    def->colors = colored ? colors : NULL;
    def->values = colored ? NULL : values;
}

// What tells the colours, at stack index @p source; how many nodes were asked, or -1.
static int32_t read_colors(lua_State *L, int source, vn_stroke_def *def) {
    if (lua_type(L, source) == LUA_TSTRING) {
        def->column = lua_tostring(L, source);
        return -1;
    }
    if (lua_isnil(L, source)) {
        return -1;
    }
    if (!lua_isfunction(L, source) && !lua_istable(L, source)) {
        vnl_fail(L,
                 "stroke.color_by: the name of a column, a list or a function of the node expected, got %s",
                 luaL_typename(L, source));
    }
    int32_t count = vn_network_count(vnl_check(L, 2, &vnl_network_class));
    read_entries(L, source, count, def);
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
    int32_t asked[2] = {-1, -1};
    lua_settop(L, 3);
    vnl_read_options(L, 3, &vn_stroke_schema, &def);
    vnl_raw_field(L, 3, "width");
    vnl_raw_field(L, 3, "color_by");
    if (lua_isfunction(L, 4)) {
        asked[0] = read_widths(L, 4, &widths);
    } else {
        def.width = constant_width(L, 4);
    }
    asked[1] = read_colors(L, 5, &def);
    def.widths = widths;
    vn_canvas *canvas = check_canvas(L);
    const vn_network *network = vnl_check(L, 2, &vnl_network_class);
    for (int i = 0; i < 2; i++) {
        if (asked[i] >= 0 && vn_network_count(network) != asked[i]) {
            return vnl_fail(L, "stroke.%s: the function must not change the network",
                            i == 0 ? "width" : "color_by");
        }
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

static void read_point(lua_State *L, int index, const char *what, int32_t i, double p[3]) {
    vn_attractors *attractors = vnl_test(L, index, &vnl_attractors_class);
    if (attractors != NULL) {
        vnl_try(L, vn_attractors_position(attractors, i, p));
        return;
    }
    lua_rawgeti(L, index, i + 1);
    vnl_read_point(L, -1, what, p);
    lua_pop(L, 1);
    if (!(fabs(p[0]) <= VN_HUGE && fabs(p[1]) <= VN_HUGE && fabs(p[2]) <= VN_HUGE)) {
        vnl_fail(L, "%s: point %d = (%g, %g) is not finite", what, i + 1, p[0], p[1]);
    }
}

// Points in columns, in memory that Lua owns.
typedef struct point_columns {
    double *x, *y, *z;
    int32_t count;
} point_columns;

// Those of an attractors set or of a list {{x, y[, z]}, …}.
static point_columns read_points(lua_State *L, int index, const char *what) {
    int64_t count = count_points(L, index);
    if (count > 100000000) {
        vnl_fail(L, "%s: %lld points are above the limit of 100,000,000", what, (long long)count);
    }
    point_columns read = {.count = (int32_t)count};
    read.x = lua_newuserdatauv(L, (size_t)(3 * count + 1) * sizeof *read.x, 0);
    read.y = read.x + count;
    read.z = read.y + count;
    for (int32_t i = 0; i < count; i++) {
        double p[3];
        read_point(L, index, what, i, p);
        read.x[i] = p[0];
        read.y[i] = p[1];
        read.z[i] = p[2];
    }
    return read;
}

static int canvas_dots(lua_State *L) {
    vn_dots_def def;
    lua_settop(L, 3);
    vnl_read_options(L, 3, &vn_dots_schema, &def);
    point_columns read = read_points(L, 2, "dots");
    vnl_try(L, vn_canvas_dots(check_canvas(L), read.x, read.y, read.z, read.count, &def));
    return 0;
}

static int canvas_line(lua_State *L) {
    vn_line_def def;
    lua_settop(L, 3);
    luaL_checktype(L, 2, LUA_TTABLE);
    vnl_read_options(L, 3, &vn_line_schema, &def);
    point_columns read = read_points(L, 2, "line");
    vnl_try(L, vn_canvas_line(check_canvas(L), read.x, read.y, read.z, read.count, &def));
    return 0;
}

static int text_width(lua_State *L) {
    double width, size = vnl_check_number(L, 2, "text_width: size");
    vnl_try(L, vn_text_width(&width, luaL_checkstring(L, 1), size));
    lua_pushnumber(L, width);
    return 1;
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
     "Fill a domain, or today's shape of a growth; through a camera also the surface of a mesh, a ball or a "
     "box.",
     &vn_fill_schema},
    {"stroke", canvas_stroke, "(network: venule.Network, options?: venule.stroke.Options)", NULL,
     "Draw a network with round ends, tapered where radii differ. `width` is \"radius\" (the default), a "
     "number, or a function of the node. Through a camera veins are tubes, painted from far to near together "
     "with the networks and dots that are drawn right before and after.",
     &vn_stroke_schema},
    {"dots", canvas_dots, "(points: venule.Attractors|number[][], options?: venule.dots.Options)", NULL,
     "A dot at each attractor, or at each point {x, y} of a list. Through a camera, dots with a radius are "
     "balls.",
     &vn_dots_schema},
    {"line", canvas_line, "(points: number[][], options?: venule.line.Options)", NULL,
     "A line through the points {x, y} of a list. With a `fill` it is closed.", &vn_line_schema},
    {"text", canvas_text, "(text: string, options: venule.text.Options)", NULL, "Write one line of text.",
     &vn_text_schema},
    {"save", canvas_save, "(path: string)", NULL,
     "Write the picture: .png, .svg, .pdf or .eps by the path's extension.", NULL},
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
    {"text_width", text_width, "(text: string, size: number): number", NULL,
     "How long a line of text is at a size in pixels.", NULL},
    {0},
};
