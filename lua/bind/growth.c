#include "bind/bind.h"

#include "colonize/attractors.h"
#include "growth/growth.h"

#include <string.h>

static void release_growth(void *object) {
    vn_growth_release(object);
}

typedef vn_status make_fn(vn_growth **out, const vn_growth_def *def);

static int make(lua_State *L, const vn_schema *schema, make_fn *engine_make) {
    vn_growth_def def;
    lua_settop(L, 1);
    void **box = vnl_push_box(L, &vnl_growth_class);
    bool has_origin = lua_istable(L, 1) && vnl_has(L, 1, "origin");
    vnl_read_options(L, 1, schema, &def);
    def.has_origin = has_origin;
    vnl_try(L, engine_make((vn_growth **)box, &def));
    lua_pushvalue(L, -1);
    lua_setfield(L, LUA_REGISTRYINDEX, "venule.latest.growth"); // what progress is shown of
    return 1;
}

static int make_none(lua_State *L) {
    return make(L, &vn_none_schema, vn_growth_none);
}

static int make_marginal(lua_State *L) {
    return make(L, &vn_marginal_schema, vn_growth_marginal);
}

const vnl_function vnl_growth_functions[] = {
    {"none", make_none, NULL, "venule.Growth", "A domain that stays as it is.", &vn_none_schema},
    {"marginal", make_marginal, NULL, "venule.Growth",
     "A blade of which only the margin moves, scaled about the petiole (Runions §3.3). Attractors thrown "
     "into it are thrown "
     "over the largest shape at once, and released as the margin passes them.",
     &vn_marginal_schema},
    {0},
};

static vn_network *first_network(lua_State *L) {
    for (int i = 2; i <= lua_gettop(L); i++) {
        vn_network *network = vnl_test(L, i, &vnl_network_class);
        if (network != NULL) {
            return network;
        }
    }
    return NULL;
}

static void check_handed(lua_State *L) {
    for (int i = 2; i <= lua_gettop(L); i++) {
        if (vnl_test(L, i, &vnl_network_class) == NULL && vnl_test(L, i, &vnl_attractors_class) == NULL) {
            vnl_fail(L, "growth:advance: networks and attractors expected, got %s", luaL_typename(L, i));
        }
    }
}

static int growth_advance(lua_State *L) {
    vn_growth *growth = vnl_check(L, 1, &vnl_growth_class);
    check_handed(L);
    vn_network *network = first_network(L);
    bool growing;
    vnl_try(L, vn_growth_advance(growth, &growing));
    for (int i = 2; i <= lua_gettop(L); i++) {
        vn_attractors *attractors = vnl_test(L, i, &vnl_attractors_class);
        int32_t released;
        if (attractors != NULL) {
            vnl_try(L, vn_release(attractors, network, &released));
        }
    }
    lua_pushboolean(L, growing);
    return 1;
}

static int growth_map(lua_State *L) {
    vn_growth *growth = vnl_check(L, 1, &vnl_growth_class);
    double p[3];
    vnl_check_coordinates(L, 2, vn_domain_dim(vn_growth_domain(growth)), p);
    int dim = vn_domain_dim(vn_growth_domain(growth));
    vnl_check_number(L, 2 + dim, "growth:map t1");
    vnl_check_number(L, 3 + dim, "growth:map t2");
    return vnl_push_coordinates(L, dim, p); // the tissue stays where it is under none and marginal growth
}

static const vnl_function methods[] = {
    {"advance", growth_advance, "(...: venule.Network|venule.Attractors): boolean", NULL,
     "Grow by one step; the attractors that the margin has passed are released, away from the network. False "
     "when it was "
     "grown already.",
     NULL},
    {"map", growth_map, "(x: number, y: number, t1: number, t2: number): number, number", NULL,
     "Where the tissue that is at (x, y) at time t1 is at time t2.", NULL},
    {0},
};

static int growth_field(lua_State *L) {
    const vn_growth *growth = vnl_check(L, 1, &vnl_growth_class);
    const char *key = lua_tostring(L, 2);
    if (strcmp(key, "time") == 0) {
        lua_pushinteger(L, vn_growth_time(growth));
    } else if (strcmp(key, "length") == 0) {
        lua_pushnumber(L, vn_growth_length(growth));
    } else if (strcmp(key, "final_length") == 0) {
        lua_pushnumber(L, vn_growth_final_length(growth));
    } else if (strcmp(key, "unit") == 0) {
        lua_pushnumber(L, vn_growth_unit(growth));
    } else if (strcmp(key, "origin") == 0) {
        double p[3];
        vn_growth_origin(growth, p);
        lua_createtable(L, 2, 0);
        for (int k = 0; k < growth->base.dim; k++) {
            lua_pushnumber(L, p[k]);
            lua_rawseti(L, -2, k + 1);
        }
    } else if (strcmp(key, "dim") == 0) {
        lua_pushinteger(L, growth->base.dim);
    } else {
        return 0;
    }
    return 1;
}

static const char *const fields[] = {
    "time: integer | steps taken",
    "length: number | today's length",
    "final_length: number | the length when grown",
    "unit: number | today's unit length in the simulation's coordinates: 1 at first (READINGS R7)",
    "origin: number[] | the petiole {x, y}, which stays where it is",
    "dim: integer | 2 or 3",
    NULL};

const vnl_class vnl_growth_class = {
    .name = "growth",
    .doc = "A domain that changes with time; accepted wherever a domain is.",
    .methods = methods,
    .extra = vnl_domain_methods,
    .fields = fields,
    .field = growth_field,
    .release = release_growth,
};
