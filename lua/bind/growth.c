#include "bind/bind.h"

#include "colonize/attractors.h"
#include "growth/factors.h"
#include "growth/growth.h"

#include <stdio.h>
#include <string.h>

static void release_growth(void *object) {
    vn_growth_release(object);
}

static bool has_origin(lua_State *L) {
    return lua_istable(L, 1) && vnl_has(L, 1, "origin");
}

// The box on top is what progress is shown of from now on.
static int finish(lua_State *L) {
    lua_pushvalue(L, -1);
    lua_setfield(L, LUA_REGISTRYINDEX, "venule.latest.growth");
    return 1;
}

typedef vn_status make_fn(vn_growth **out, const vn_growth_def *def);

static int make(lua_State *L, const vn_schema *schema, make_fn *engine_make) {
    vn_growth_def def;
    lua_settop(L, 1);
    void **box = vnl_push_box(L, &vnl_growth_class);
    bool given = has_origin(L);
    vnl_read_options(L, 1, schema, &def);
    def.has_origin = given;
    vnl_try(L, engine_make((vn_growth **)box, &def));
    return finish(L);
}

static int make_none(lua_State *L) {
    return make(L, &vn_none_schema, vn_growth_none);
}

static int make_marginal(lua_State *L) {
    return make(L, &vn_marginal_schema, vn_growth_marginal);
}

static int make_isogonic(lua_State *L) {
    return make(L, &vn_isogonic_schema, vn_growth_isogonic);
}

static int make_uniform(lua_State *L) {
    vn_uniform_def def;
    lua_settop(L, 1);
    void **box = vnl_push_box(L, &vnl_growth_class);
    bool given = has_origin(L);
    vnl_read_options(L, 1, &vn_uniform_schema, &def);
    def.has_origin = given;
    vnl_try(L, vn_growth_uniform((vn_growth **)box, &def));
    return finish(L);
}

/// Growth factors as a script gives them, turned into samples in a userdata.
typedef struct factor_reader {
    const char *what; ///< "rerg.x"
    double bottom, top;
    int32_t samples;
    double *out;
} factor_reader;

static double *new_numbers(lua_State *L, lua_Integer count) {
    return lua_newuserdatauv(L, (size_t)(count + 1) * sizeof(double), 0);
}

static void sample_function(lua_State *L, int source, factor_reader *r) {
    char what[80];
    r->out = new_numbers(L, r->samples);
    for (int32_t i = 0; i < r->samples; i++) {
        double y0 = r->bottom + (r->top - r->bottom) * i / (r->samples - 1);
        lua_pushvalue(L, source);
        lua_pushnumber(L, y0);
        lua_call(L, 1, 1);
        snprintf(what, sizeof what, "%s at height %g", r->what, y0);
        r->out[i] = vnl_check_number(L, -1, what);
        lua_pop(L, 1);
    }
}

static void copy_samples(lua_State *L, int source, factor_reader *r) {
    r->out = new_numbers(L, r->samples);
    for (int32_t i = 0; i < r->samples; i++) {
        lua_rawgeti(L, source, i + 1);
        r->out[i] = vnl_check_number(L, -1, r->what);
        lua_pop(L, 1);
    }
}

static void sample_spline(lua_State *L, int source, int32_t points, factor_reader *r) {
    r->out = new_numbers(L, r->samples);
    double *yf = new_numbers(L, 2 * (lua_Integer)points);
    for (int32_t i = 0; i < points; i++) {
        double p[3];
        lua_rawgeti(L, source, i + 1);
        if (vnl_read_point(L, -1, r->what, p) != 2) {
            vnl_fail(L, "%s: a point of a spline has two numbers {y0, f}", r->what);
        }
        lua_pop(L, 1);
        yf[2 * (size_t)i] = p[0];
        yf[2 * (size_t)i + 1] = p[1];
    }
    vnl_try(L, vn_factors_spline(r->out, r->samples, r->what, yf, points, r->bottom, r->top));
    lua_pop(L, 1);
}

static void read_table(lua_State *L, int source, factor_reader *r) {
    lua_Integer count = (lua_Integer)lua_rawlen(L, source);
    if (count < 2 || count > 10000000) {
        vnl_fail(L, "%s: a table of %lld entries, from 2 to 10,000,000 expected", r->what, (long long)count);
    }
    bool spline = lua_rawgeti(L, source, 1) == LUA_TTABLE;
    lua_pop(L, 1);
    if (spline) {
        sample_spline(L, source, (int32_t)count, r);
    } else {
        r->samples = (int32_t)count;
        copy_samples(L, source, r);
    }
}

// Leaves two values on the stack: what was given, and the samples that were made of it.
static void read_factors(lua_State *L, const char *field, factor_reader *r) {
    int type = vnl_raw_field(L, 1, field);
    int source = lua_gettop(L);
    if (type == LUA_TFUNCTION) {
        sample_function(L, source, r);
    } else if (type == LUA_TTABLE) {
        read_table(L, source, r);
    } else if (type == LUA_TNUMBER) {
        r->samples = 2;
        r->out = new_numbers(L, 2);
        r->out[0] = r->out[1] = lua_tonumber(L, source);
    } else if (type != LUA_TNIL) {
        vnl_fail(L, "%s: a function of y0, a table or a number expected, got %s", r->what,
                 luaL_typename(L, source));
    }
}

static int make_rerg(lua_State *L) {
    vn_rerg_def def;
    lua_settop(L, 1);
    bool given = has_origin(L);
    vnl_read_options(L, 1, &vn_rerg_schema, &def);
    factor_reader x = {.what = "rerg.x", .samples = def.samples},
                  y = {.what = "rerg.y", .samples = def.samples};
    def.has_origin = given;
    vnl_try(L, vn_growth_heights(&def, &x.bottom, &x.top));
    y.bottom = x.bottom;
    y.top = x.top;
    read_factors(L, "x", &x);
    read_factors(L, "y", &y);
    void **box = vnl_push_box(L, &vnl_growth_class);
    vnl_read_options(L, 1, &vn_rerg_schema, &def); // again: the functions may have closed the domain
    def.has_origin = given;
    def.x = x.out;
    def.x_samples = x.samples;
    def.y = y.out;
    def.y_samples = y.samples;
    vnl_try(L, vn_growth_rerg((vn_growth **)box, &def));
    return finish(L);
}

static lua_Integer count_domains(lua_State *L) {
    if (!lua_istable(L, 1) || vnl_raw_field(L, 1, "domains") == LUA_TNIL) {
        return 0; // the reader says what is missing
    }
    if (lua_type(L, -1) != LUA_TTABLE) {
        vnl_fail(L, "morph.domains: a table of domains {a, b, …} expected, got %s", luaL_typename(L, -1));
    }
    lua_Integer count = (lua_Integer)lua_rawlen(L, -1);
    if (count > 100000) {
        vnl_fail(L, "morph.domains: %lld outlines are above the limit of 100,000", (long long)count);
    }
    return count;
}

static int make_morph(lua_State *L) {
    vn_morph_def def;
    lua_settop(L, 1);
    bool given = has_origin(L);
    lua_Integer count = count_domains(L);
    vn_domain **domains = lua_newuserdatauv(L, (size_t)(count + 1) * sizeof(vn_domain *), 0);
    void **box = vnl_push_box(L, &vnl_growth_class);
    vnl_read_options(L, 1, &vn_morph_schema, &def);
    vnl_raw_field(L, 1, "domains");
    for (lua_Integer i = 0; i < count; i++) { // nothing here allocates, so they are open until they are used
        lua_rawgeti(L, -1, i + 1);
        domains[i] = vnl_test_domain(L, -1);
        if (domains[i] == NULL) {
            vnl_fail(L, "morph.domains[%d]: domain expected, got %s", (int)i + 1, luaL_typename(L, -1));
        }
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    def.has_origin = given;
    def.domains = domains;
    def.count = (int32_t)count;
    vnl_try(L, vn_growth_morph((vn_growth **)box, &def));
    return finish(L);
}

const vnl_function vnl_growth_functions[] = {
    {"none", make_none, NULL, "venule.Growth", "A domain that stays as it is.", &vn_none_schema},
    {"marginal", make_marginal, NULL, "venule.Growth",
     "A blade of which only the margin moves, scaled about the petiole (Runions §3.3). Attractors thrown "
     "into it are thrown "
     "over the largest shape at once, and released as the margin passes them.",
     &vn_marginal_schema},
    {"isogonic", make_isogonic, NULL, "venule.Growth",
     "A blade that grows alike everywhere, computed by shrinking the unit (READINGS R7): its shape has the "
     "length `from` and stays, `length` runs from `from` to `to`, and `unit` is from / length. Multiply "
     "lengths by `unit` and divide densities by its square.",
     &vn_isogonic_schema},
    {"uniform", make_uniform, NULL, "venule.Growth",
     "A blade that grows by one factor a step across, one along and, in 3D, one in depth; its tissue moves. "
     "In "
     "3D boxes and meshes are exact in all they answer; the distance to the border of others is never more "
     "than "
     "the true one.",
     &vn_uniform_schema},
    {"rerg", make_rerg, NULL, "venule.Growth",
     "A blade that grows by factors that vary along it (Runions, appendix): x(t) = x0 f_x(y0)^t and y(t) = "
     "∫ f_y^t dy from 0 to y0, where y0 is the height above the origin at first. Its tissue moves.",
     &vn_rerg_schema},
    {"morph", make_morph, NULL, "venule.Growth",
     "A blade that grows from outline to outline (Webb 2020); its tissue moves, by mean value coordinates.",
     &vn_morph_schema},
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

// All are checked before anything moves; what is open stays open, as nothing here runs Lua until an error.
static int growth_advance(lua_State *L) {
    vn_growth *growth = vnl_check(L, 1, &vnl_growth_class);
    check_handed(L);
    vn_network *network = first_network(L);
    bool growing;
    int32_t released;
    vnl_try(L, vn_growth_advance(growth, &growing));
    for (int i = 2; i <= lua_gettop(L); i++) {
        vn_network *carried = vnl_test(L, i, &vnl_network_class);
        vnl_try(L, carried != NULL ? vn_growth_carry(growth, carried) : VN_OK);
    }
    for (int i = 2; i <= lua_gettop(L); i++) {
        vn_attractors *attractors = vnl_test(L, i, &vnl_attractors_class);
        if (attractors != NULL) {
            vnl_try(L, vn_attractors_carry(attractors, growth));
            vnl_try(L, vn_release(attractors, network, &released));
        }
    }
    lua_pushboolean(L, growing);
    return 1;
}

static int growth_map(lua_State *L) {
    vn_growth *growth = vnl_check(L, 1, &vnl_growth_class);
    int dim = vn_domain_dim(vn_growth_domain(growth));
    double p[3], q[3];
    vnl_check_coordinates(L, 2, dim, p);
    double t1 = vnl_check_number(L, 2 + dim, "growth:map t1");
    double t2 = vnl_check_number(L, 3 + dim, "growth:map t2");
    vnl_try(L, vn_growth_map(growth, p, t1, t2, q));
    return vnl_push_coordinates(L, dim, q);
}

static const vnl_function methods[] = {
    {"advance", growth_advance, "(...: venule.Network|venule.Attractors): boolean", NULL,
     "Grow by one step. Networks and attractors move with the tissue, edges stretched beyond `split` are "
     "split, and the attractors that a margin has passed are released, away from the network. False when it "
     "was grown already.",
     NULL},
    {"map", growth_map, "(x: number, y: number, ...: number): number, number, number?", NULL,
     "`g:map(x, y[, z], t1, t2)`: where the tissue that is there at time t1 is at time t2; times are steps, "
     "and may be fractions. "
     "Under none, marginal and isogonic growth it keeps its coordinates.",
     NULL},
    {0},
};

static int growth_field(lua_State *L) {
    const vn_growth *growth = vnl_check(L, 1, &vnl_growth_class);
    const char *key = lua_tostring(L, 2);
    if (strcmp(key, "kind") == 0) {
        lua_pushstring(L, vn_growth_kind_name(growth));
    } else if (strcmp(key, "steps") == 0) {
        lua_pushinteger(L, vn_growth_steps(growth));
    } else if (strcmp(key, "grown") == 0) {
        lua_pushboolean(L, vn_growth_is_grown(growth));
    } else if (strcmp(key, "time") == 0) {
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
    } else if (strcmp(key, "measure_dim") == 0) {
        lua_pushinteger(L, vn_domain_measure_dim(&growth->base));
    } else {
        return 0;
    }
    return 1;
}

static const char *const fields[] = {
    "kind: string | none, marginal, isogonic, uniform, rerg or morph",
    "time: integer | steps taken",
    "steps: integer | steps from first to grown",
    "grown: boolean | whether advance() has nothing left to do",
    "measure_dim: integer | 2 where its measure is an area, 3 where it is a volume",
    "length: number | today's length",
    "final_length: number | the length when grown",
    "unit: number | today's unit length in the simulation's coordinates: 1 at first (READINGS R7)",
    "origin: number[] | the petiole {x, y}, which stays where it is; a morph's moves with its outline",
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
