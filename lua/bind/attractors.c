#include "bind/bind.h"

#include "colonize/attractors.h"

#include <string.h>

static void release_attractors(void *object) {
    vn_attractors_destroy(object);
}

static vn_attractors *check_attractors(lua_State *L) {
    return vnl_check(L, 1, &vnl_attractors_class);
}

static int make_attractors(lua_State *L) {
    vn_attractors_def def;
    vnl_read_options(L, 1, &vn_attractors_schema, &def);
    void **box = vnl_push_box(L, &vnl_attractors_class);
    vnl_try(L, vn_attractors_create((vn_attractors **)box, &def));
    return 1;
}

static int attractors_add(lua_State *L) {
    vn_attractors *attractors = check_attractors(L);
    double p[3];
    vnl_check_coordinates(L, 2, vn_attractors_dim(attractors), p);
    vnl_try(L, vn_attractors_add(attractors, p));
    return 0;
}

/// A throw under way, in stack indices: what its weight is asked with.
typedef struct throwing {
    lua_State *L;
    int dim, function, network, error;
} throwing;

// A script's own error travels as it was raised.
static vn_status ask_weight(double *weight, const double p[3], void *payload) {
    const throwing *t = payload;
    lua_State *L = t->L;
    lua_pushvalue(L, t->function);
    if (lua_pcall(L, vnl_push_coordinates(L, t->dim, p), 1, 0) != LUA_OK) {
        lua_replace(L, t->error);
        return vn_fail(VN_CALLBACK, "throw.weight failed");
    }
    bool number = lua_type(L, -1) == LUA_TNUMBER;
    const char *got = luaL_typename(L, -1);
    *weight = lua_tonumber(L, -1);
    lua_pop(L, 1);
    if (!number) {
        return vn_fail(VN_INVALID,
                       "throw.weight: the function has to return a number, got %s at (%g, %g, %g)", got, p[0],
                       p[1], p[2]);
    }
    if (!lua_isnil(L, t->network) && vnl_test(L, t->network, &vnl_network_class) == NULL) {
        return vn_fail(VN_INVALID, "throw.weight: the function has closed the network to keep clear of");
    }
    return VN_OK;
}

static void push_option(lua_State *L, const char *name) {
    if (lua_istable(L, 2)) {
        vnl_raw_field(L, 2, name);
    } else {
        lua_pushnil(L); // the reader says what is wrong with the options
    }
}

// Allocates nothing: what was open stays open.
static void set_weight(lua_State *L, throwing *t, vn_throw_def *def) {
    def->weight = vnl_test_domain(L, t->function);
    if (lua_isfunction(L, t->function)) {
        def->weight_at = ask_weight;
        def->weight_payload = t;
    } else if (!lua_isnil(L, t->function) && def->weight == NULL) {
        vnl_fail(L, "throw.weight: a function or a domain expected, got %s", luaL_typename(L, t->function));
    }
}

// While darts fly, the box is empty, and the domain is held once more: the function that weighs them can
// neither close nor fill what they fall into.
static vn_status throw_shut(void **box, const vn_throw_def *def, int32_t *accepted) {
    vn_attractors *attractors = *box;
    vn_domain *held = vn_domain_retain(def->domain);
    *box = NULL;
    vn_status status = vn_throw(attractors, def, accepted);
    *box = attractors;
    vn_domain_release(held);
    return status;
}

static int attractors_throw(lua_State *L) {
    vn_throw_def def;
    throwing t = {.L = L, .function = 3, .network = 4, .error = 5};
    int32_t accepted;
    lua_settop(L, 2);
    luaL_checkstack(L, 24, "throw");
    push_option(L, "weight");
    push_option(L, "network");
    lua_pushnil(L);
    vnl_read_options(L, 2, &vn_throw_schema, &def);
    set_weight(L, &t, &def);
    t.dim = vn_attractors_dim(check_attractors(L));
    vn_status status = throw_shut(lua_touserdata(L, 1), &def, &accepted);
    if (status == VN_CALLBACK) {
        lua_settop(L, t.error);
        return lua_error(L);
    }
    vnl_try(L, status);
    lua_pushinteger(L, accepted);
    return 1;
}

static int attractors_influence(lua_State *L) {
    vn_influence_def def;
    lua_settop(L, 3);
    void **box = vnl_push_box(L, &vnl_influence_class);
    lua_createtable(L, 2, 0); // an influence looks at both: they must outlive it
    lua_pushvalue(L, 1);
    lua_rawseti(L, -2, 1);
    lua_pushvalue(L, 2);
    lua_rawseti(L, -2, 2);
    lua_setiuservalue(L, -2, 1);
    vnl_read_options(L, 3, &vn_influence_schema, &def);
    if (vnl_raw_field(L, 3, "perception") != LUA_TNIL) {
        vnl_read_options(L, lua_gettop(L), &vn_perception_schema, &def.perception);
    }
    lua_pop(L, 1);
    vn_attractors *attractors = check_attractors(L);
    vn_network *network = vnl_check(L, 2, &vnl_network_class);
    vnl_try(L, vn_influence_find((vn_influence **)box, attractors, network, &def));
    // Lua sees a small box, and one a step of them: it has to be told what hangs behind each, or they pile
    // up.
    int kilobytes = (int)(vn_influence_bytes(*box) >> 10);
    if (kilobytes > 0) {
        lua_gc(L, LUA_GCSTEP, kilobytes);
    }
    return 1;
}

static int attractors_consume(lua_State *L) {
    vn_consume_def def;
    int32_t consumed;
    vnl_read_options(L, 3, &vn_consume_schema, &def);
    vn_attractors *attractors = check_attractors(L);
    vn_network *network = vnl_check(L, 2, &vnl_network_class);
    vnl_try(L, vn_consume(attractors, network, &def, &consumed));
    lua_pushinteger(L, consumed);
    return 1;
}

static const vnl_function methods[] = {
    {"add", attractors_add, "(x: number, y: number, z?: number)", NULL, "Add one.", NULL},
    {"throw", attractors_throw, "(options: venule.throw.Options): integer", NULL,
     "Throw darts at a domain; how many stuck. Each is accepted when it is farther than `spacing` from all "
     "attractors and "
     "farther than `clearance` from all nodes of `network` (Runions §3.3). With a `weight`, first each is "
     "kept "
     "with that probability: a map's values (`venule.domain.image`, `venule.domain.volume`), 1 inside any "
     "other "
     "domain and 0 outside, or what a function of the place returns, from 0 to 1. A marginal growth's darts "
     "are "
     "weighed once, all over its square.",
     &vn_throw_schema},
    {"influence", attractors_influence,
     "(network: venule.Network, options?: venule.influence.Options): venule.Influence", NULL,
     "Which attractors influence which nodes; good until the attractors or the network change.",
     &vn_influence_schema},
    {"consume", attractors_consume, "(network: venule.Network, options: venule.consume.Options): integer",
     NULL, "Remove the attractors that the network has reached; how many.", &vn_consume_schema},
    {0},
};

static int32_t count_attractors(void *object) {
    return vn_attractors_count(object);
}

static void push_coordinate(lua_State *L, void *object, int32_t i, int k) {
    double p[3];
    vnl_try(L, vn_attractors_position(object, i, p));
    lua_pushnumber(L, p[k]);
}

static void read_x(lua_State *L, void *object, int32_t i) {
    push_coordinate(L, object, i, 0);
}

static void read_y(lua_State *L, void *object, int32_t i) {
    push_coordinate(L, object, i, 1);
}

static void read_z(lua_State *L, void *object, int32_t i) {
    push_coordinate(L, object, i, 2);
}

static int push_retired(lua_State *L, const vn_attractors *attractors) {
    vn_retired retired = vn_attractors_retired(attractors);
    lua_createtable(L, 0, 3);
    vnl_set_integer(L, "hidden", retired.hidden);
    vnl_set_integer(L, "circled", retired.circled);
    vnl_set_integer(L, "barred", retired.barred);
    return 1;
}

static int attractors_field(lua_State *L) {
    const vn_attractors *attractors = check_attractors(L);
    static vnl_read_fn *const reads[3] = {read_x, read_y, read_z};
    const char *key = lua_tostring(L, 2);
    if (key[0] >= 'x' && key[0] <= 'z' && key[1] == '\0') {
        vnl_push_view(L, 1, &vnl_attractors_class, reads[key[0] - 'x'], count_attractors);
        return 1;
    }
    if (strcmp(key, "dim") == 0) {
        lua_pushinteger(L, vn_attractors_dim(attractors));
        return 1;
    }
    if (strcmp(key, "dormant") == 0) {
        lua_pushinteger(L, vn_attractors_dormant(attractors));
        return 1;
    }
    return strcmp(key, "retired") == 0 ? push_retired(L, attractors) : 0;
}

static int attractors_length(lua_State *L) {
    lua_pushinteger(L, vn_attractors_count(check_attractors(L)));
    return 1;
}

static const char retired_field[] =
    "retired: {hidden: integer, circled: integer, barred: integer} | how many "
    "were given up: hidden, as no node sees them without leaving the domain; "
    "circled, as veins grew for them and came no nearer; barred, as the vein "
    "would have crossed another one, or come too near to a network to be avoided";
static const char *const fields[] = {"x: number[] | the attractors' coordinates",
                                     "y: number[] | the attractors' coordinates",
                                     "z: number[] | the attractors' coordinates; 0 in 2D",
                                     "dim: integer | 2 or 3",
                                     "dormant: integer | how many wait beyond a growing margin",
                                     retired_field,
                                     NULL};

const vnl_class vnl_attractors_class = {
    .name = "attractors",
    .doc = "Points that attract: auxin sources, oxygen drains. `#a` of them, numbered from 1.",
    .methods = methods,
    .fields = fields,
    .field = attractors_field,
    .release = release_attractors,
    .length = attractors_length,
};

static void release_influence(void *object) {
    vn_influence_destroy(object);
}

vn_influence *vnl_check_influence(lua_State *L, int index) {
    index = lua_absindex(L, index);
    vn_influence *influence = vnl_check(L, index, &vnl_influence_class);
    lua_getiuservalue(L, index, 1);
    for (int i = 1; i <= 2; i++) {
        lua_rawgeti(L, -1, i);
        vnl_check(L, -1, i == 1 ? &vnl_attractors_class : &vnl_network_class);
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    if (!vn_influence_current(influence)) {
        vnl_fail(L, "this influence is out of date: call influence() again after anything has changed");
    }
    return influence;
}

static int next_pair(lua_State *L) {
    const vn_influence *influence = vnl_check_influence(L, lua_upvalueindex(1));
    int32_t pair = (int32_t)lua_tointeger(L, lua_upvalueindex(2));
    if (pair >= vn_influence_count(influence)) {
        return 0;
    }
    lua_pushinteger(L, pair + 1);
    lua_replace(L, lua_upvalueindex(2));
    lua_pushinteger(L, vn_influence_attractor(influence, pair) + 1);
    lua_pushinteger(L, vn_influence_node(influence, pair) + 1);
    return 2;
}

static int influence_pairs(lua_State *L) {
    vnl_check_influence(L, 1);
    lua_pushvalue(L, 1);
    lua_pushinteger(L, 0);
    lua_pushcclosure(L, next_pair, 2);
    return 1;
}

static int influence_length(lua_State *L) {
    lua_pushinteger(L, vn_influence_count(vnl_check(L, 1, &vnl_influence_class)));
    return 1;
}

static const vnl_function influence_methods[] = {
    {"pairs", influence_pairs, "(): fun(): integer, integer", NULL,
     "Iterate: `for attractor, node in f:pairs() do … end`, by attractor, then node.", NULL},
    {0},
};

const vnl_class vnl_influence_class = {
    .name = "influence",
    .doc = "Which attractors influence which nodes; `#f` pairs.",
    .methods = influence_methods,
    .release = release_influence,
    .length = influence_length,
};

const vnl_function vnl_attractors_functions[] = {
    {"attractors", make_attractors, NULL, "venule.Attractors", "An empty set of attractors.",
     &vn_attractors_schema},
    {0},
};
