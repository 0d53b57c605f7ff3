// Constrained constructive optimisation. venule.cco{…} of lua/venule/cco.lua is what scripts call; it stands
// upon this.
#include "bind/bind.h"

#include "base/memory.h"
#include "cco/cco.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct organ organ;

/// Where a number comes from: a function of the script, at `slot` of the box's table, or a domain's values.
typedef struct source {
    organ *organ;
    const char *what; ///< "cco.density"
    lua_Integer slot; ///< 0 without a function
    vn_domain *domain;
    struct source *next;
} source;

/// What the box holds. While the engine runs, the box is empty: a function that it calls can neither close
/// nor grow what grows just then.
struct organ {
    vn_cco *cco;
    int dim;
    int32_t terminals; ///< that each tree is to have
    source *sources;
    // Of the call that is under way, in stack indices; engine calls nothing outside of one.
    lua_State *L;
    int functions, error;
};

static void release_organ(void *object) {
    organ *o = object;
    vn_cco_destroy(o->cco);
    while (o->sources != NULL) {
        source *next = o->sources->next;
        vn_domain_release(o->sources->domain);
        VN_DELETE(o->sources);
        o->sources = next;
    }
    VN_DELETE(o);
}

// ---- Calls that may come back to the script ----

// The table of functions, and room for an error, go on the stack, where callbacks find them.
static organ *enter(lua_State *L, int box) {
    organ *o = vnl_check(L, box, &vnl_cco_class);
    luaL_checkstack(L, 16, "cco");
    lua_getiuservalue(L, box, 1);
    o->functions = lua_gettop(L);
    lua_pushnil(L);
    o->error = lua_gettop(L);
    o->L = L;
    *(void **)lua_touserdata(L, box) = NULL;
    return o;
}

static void leave(lua_State *L, int box, organ *o) {
    *(void **)lua_touserdata(L, box) = o;
    o->L = NULL;
}

// A script's own error travels as it was raised.
static void raise(lua_State *L, const organ *o, vn_status status) {
    if (status == VN_CALLBACK) {
        lua_settop(L, o->error);
        lua_error(L);
    }
    vnl_try(L, status);
}

static vn_status call_function(double *value, const source *s, const double p[3]) {
    const organ *o = s->organ;
    lua_State *L = o->L;
    lua_rawgeti(L, o->functions, s->slot);
    for (int k = 0; k < o->dim; k++) {
        lua_pushnumber(L, p[k]);
    }
    if (lua_pcall(L, o->dim, 1, 0) != LUA_OK) {
        lua_replace(L, o->error);
        return vn_fail(VN_CALLBACK, "%s failed", s->what);
    }
    bool number = lua_type(L, -1) == LUA_TNUMBER;
    const char *got = luaL_typename(L, -1);
    *value = lua_tonumber(L, -1);
    lua_pop(L, 1);
    return number ? VN_OK
                  : vn_fail(VN_INVALID, "%s: the function has to return a number, got %s at (%g, %g, %g)",
                            s->what, got, p[0], p[1], p[2]);
}

static vn_status read_source(double *value, const double p[3], void *payload) {
    const source *s = payload;
    if (s->slot > 0) {
        return call_function(value, s, p);
    }
    *value = vn_domain_value(s->domain, p);
    return VN_OK;
}

// Keep the value on top of the stack with the box; its slot.
static lua_Integer keep_value(lua_State *L, int box) {
    lua_getiuservalue(L, box, 1);
    lua_Integer slot = (lua_Integer)lua_rawlen(L, -1) + 1;
    lua_pushvalue(L, -2);
    lua_rawseti(L, -2, slot);
    lua_pop(L, 1);
    return slot;
}

// The function or domain on top of the stack as a source; NULL when it is neither.
static source *add_source(lua_State *L, int box, const char *what) {
    lua_Integer slot = lua_isfunction(L, -1) ? keep_value(L, box) : 0;
    organ *o = vnl_check(L, box, &vnl_cco_class);
    vn_domain *domain = vnl_test_domain(L, -1);
    if (slot == 0 && domain == NULL) {
        return NULL;
    }
    if (domain != NULL && vn_domain_dim(domain) != o->dim) {
        vnl_fail(L, "%s has %d dimensions, and the domain %d", what, vn_domain_dim(domain), o->dim);
    }
    source *s = VN_NEW(source);
    if (s == NULL) {
        vnl_try(L, vn_fail(VN_NO_MEMORY, "out of memory (raise --memory, or make less)"));
        return NULL;
    }
    *s = (source){o, what, slot, domain != NULL ? vn_domain_retain(domain) : NULL, o->sources};
    o->sources = s;
    return s;
}

// ---- Making one ----

enum { MOST_TERMINALS = 100000000 };

// A list of points {{x, y}, …} as the engine wants it, in a block that lives with the box.
static double *read_list(lua_State *L, int list, lua_Integer count) {
    double *points = lua_newuserdatauv(L, (3 * (size_t)count + 1) * sizeof *points, 0);
    for (lua_Integer i = 0; i < count; i++, lua_pop(L, 1)) {
        char what[48];
        snprintf(what, sizeof what, "cco.terminals[%lld]", (long long)i + 1);
        lua_rawgeti(L, list, i + 1);
        vnl_read_point(L, -1, what, points + 3 * (size_t)i);
    }
    return points;
}

// A copy of the options in which a list of terminals is how many they are, so that one row reads both.
static int copy_options(lua_State *L, int options, lua_Integer count) {
    lua_newtable(L);
    int copy = lua_gettop(L);
    for (lua_pushnil(L); lua_next(L, options) != 0;) {
        lua_pushvalue(L, -2);
        lua_insert(L, -2);
        lua_rawset(L, copy);
    }
    lua_pushinteger(L, count);
    lua_setfield(L, copy, "terminals");
    return copy;
}

static lua_Integer list_length(lua_State *L, int list) {
    lua_Unsigned count = lua_rawlen(L, list);
    if (count > MOST_TERMINALS) {
        vnl_fail(L, "cco.terminals: %llu are above the limit of 100,000,000", (unsigned long long)count);
    }
    return (lua_Integer)count;
}

static organ *new_organ(lua_State *L, void **box) {
    organ *o = VN_NEW(organ);
    if (o == NULL) {
        vnl_try(L, vn_fail(VN_NO_MEMORY, "out of memory (raise --memory, or make less)"));
    }
    *box = o;
    return o;
}

static void check_still(lua_State *L) {
    if (vnl_raw_field(L, 1, "domain") != LUA_TNIL && vnl_test(L, -1, &vnl_growth_class) != NULL) {
        vnl_fail(L, "cco.domain: a domain that stays expected, got a growth");
    }
    lua_pop(L, 1);
}

static source *read_density(lua_State *L, int box) {
    source *density = NULL;
    if (vnl_raw_field(L, 1, "density") != LUA_TNIL) {
        density = add_source(L, box, "cco.density");
        if (density == NULL) {
            vnl_fail(L, "cco.density: a function or a domain expected, got %s", luaL_typename(L, -1));
        }
    }
    lua_pop(L, 1);
    return density;
}

static int make_cco(lua_State *L) {
    vn_cco_def def;
    lua_settop(L, 1);
    luaL_checktype(L, 1, LUA_TTABLE);
    void **box = vnl_push_box(L, &vnl_cco_class);
    lua_newtable(L);
    lua_setiuservalue(L, 2, 1);
    organ *o = new_organ(L, box);
    check_still(L);
    int options = 1;
    double *list = NULL;
    if (vnl_raw_field(L, 1, "terminals") == LUA_TTABLE) {
        lua_Integer count = list_length(L, 3);
        list = read_list(L, 3, count);
        keep_value(L, 2);
        options = copy_options(L, 1, count);
    }
    vnl_read_options(L, options, &vn_cco_schema, &def);
    o->dim = vn_domain_dim(def.domain);
    o->terminals = def.terminals;
    source *density = read_density(L, 2);
    vnl_read_options(L, options, &vn_cco_schema, &def); // again: the domain may be closed by now
    def.density = density != NULL ? read_source : NULL;
    def.density_payload = density;
    def.list = list;
    def.list_count = list != NULL ? def.terminals : 0;
    vnl_try(L, vn_cco_create(&o->cco, &def));
    lua_settop(L, 2);
    return 1;
}

// ---- Trees ----

/// Pairs of flow and exponent, of which the engine makes a curve.
typedef struct exponents {
    double *pairs;
    int32_t count;
} exponents;

enum { SAMPLES = 64 };

static void read_pairs(lua_State *L, int list, exponents *out) {
    lua_Unsigned count = lua_rawlen(L, list);
    if (count < 1 || count > 100000) {
        vnl_fail(L, "cco.exponent: a list of 1 to 100,000 pairs {flow, exponent} expected, got %llu",
                 (unsigned long long)count);
    }
    out->count = (int32_t)count;
    out->pairs = lua_newuserdatauv(L, 2 * (size_t)count * sizeof(double), 0);
    for (int32_t i = 0; i < out->count; i++, lua_pop(L, 1)) {
        double pair[3];
        lua_rawgeti(L, list, i + 1);
        if (vnl_read_point(L, -1, "cco.exponent", pair) != 2) {
            vnl_fail(L, "cco.exponent[%d]: a pair {flow, exponent} expected", (int)i + 1);
        }
        memcpy(out->pairs + 2 * (size_t)i, pair, 2 * sizeof *pair);
    }
}

// function(flow) → exponent, between the flow of one terminal and that of all.
static void sample_exponents(lua_State *L, int function, double least, double most, exponents *out) {
    out->count = most > least ? SAMPLES : 1;
    out->pairs = lua_newuserdatauv(L, 2 * SAMPLES * sizeof(double), 0);
    for (int32_t i = 0; i < out->count; i++, lua_pop(L, 1)) {
        double flow = least * pow(most / least, (double)i / (SAMPLES - 1));
        lua_pushvalue(L, function);
        lua_pushnumber(L, flow);
        lua_call(L, 1, 1);
        out->pairs[2 * (size_t)i] = flow;
        out->pairs[2 * (size_t)i + 1] = vnl_check_number(L, -1, "cco.exponent, which the function returns");
    }
}

// Leaves two values on the stack.
static void read_exponent(lua_State *L, vn_cco_tree_def *def, int32_t terminals) {
    exponents read = {0};
    int type = vnl_raw_field(L, 2, "exponent");
    int given = lua_gettop(L);
    if (type == LUA_TNUMBER) {
        def->exponent = lua_tonumber(L, given);
    } else if (type == LUA_TTABLE) {
        read_pairs(L, given, &read);
    } else if (type == LUA_TFUNCTION) {
        double least = def->terminal_flow > 0 ? def->terminal_flow : def->inflow / terminals;
        sample_exponents(L, given, least, least * terminals, &read);
    } else if (type != LUA_TNIL) {
        vnl_fail(L, "cco.exponent: a number, a list {{flow, exponent}, …} or a function expected, got %s",
                 luaL_typename(L, given));
    }
    def->exponents = read.pairs;
    def->exponent_count = read.count;
}

static void read_terminal_flow(lua_State *L, vn_cco_tree_def *def) {
    int type = vnl_raw_field(L, 2, "terminal_flow");
    if (type == LUA_TNUMBER) {
        def->terminal_flow = lua_tonumber(L, -1);
        if (!(def->terminal_flow > 0)) { // the engine takes 0 for "not given"
            vnl_fail(L, "cco.terminal_flow = %g mm³/s must be above 0", def->terminal_flow);
        }
    } else if (type != LUA_TNIL) {
        def->flow_payload = add_source(L, 1, "cco.terminal_flow");
        def->flow = read_source;
        if (def->flow_payload == NULL) {
            vnl_fail(L, "cco.terminal_flow: a number, a function or a domain expected, got %s",
                     luaL_typename(L, -1));
        }
    }
    lua_pop(L, 1);
}

static void check_from(lua_State *L) {
    if (vnl_raw_field(L, 2, "root") == LUA_TNIL && vnl_raw_field(L, 2, "from") == LUA_TNIL) {
        vnl_fail(L, "cco: `root` is missing: where the tree begins (or `from`: a tree to grow on from)");
    }
    lua_settop(L, 2);
}

// `from`, whose box is at the index, is out of the script's reach while functions of the script are called
// for its terminals.
static vn_status add_tree(lua_State *L, const organ *o, const vn_cco_tree_def *def, int index,
                          int32_t *tree) {
    void **from = def->from != NULL ? lua_touserdata(L, index) : NULL;
    if (from == NULL) {
        return vn_cco_add(o->cco, def, tree);
    }
    void *network = *from;
    *from = NULL;
    vn_status status = vn_cco_add(o->cco, def, tree);
    *from = network;
    return status;
}

static int cco_add(lua_State *L) {
    vn_cco_tree_def def;
    int32_t tree;
    lua_settop(L, 2);
    const organ *checked = vnl_check(L, 1, &vnl_cco_class);
    int32_t terminals = checked->terminals;
    vnl_read_options(L, 2, &vn_cco_tree_schema, &def);
    check_from(L);
    read_terminal_flow(L, &def);
    read_exponent(L, &def, terminals);
    bool given = vnl_raw_field(L, 2, "from") != LUA_TNIL;
    int index = lua_gettop(L);
    def.from = given ? vnl_check(L, index, &vnl_network_class) : NULL;
    organ *o = enter(L, 1);
    vn_status status = add_tree(L, o, &def, index, &tree);
    leave(L, 1, o);
    raise(L, o, status);
    lua_pushinteger(L, tree + 1);
    return 1;
}

static int cco_avoid(lua_State *L) {
    const organ *o = vnl_check(L, 1, &vnl_cco_class);
    vnl_try(L, vn_cco_avoid(o->cco, vnl_check(L, 2, &vnl_network_class)));
    return 0;
}

// ---- Growing ----

typedef struct stage_def {
    vn_domain *domain;
    int32_t terminals;
} stage_def;

static const stage_def stage_default = {0};
static const vn_field stage_fields[] = {
    {"domain", VN_OBJECT, 0, offsetof(stage_def, domain), 0, 0, "", "domain",
     "the part that terminals fall into; left out: the whole domain"},
    {"terminals", VN_I32, VN_REQUIRED | VN_OPTIONAL, offsetof(stage_def, terminals), 1, MOST_TERMINALS,
     "terminals", NULL, "how many more each tree is to have then"},
};
static const vn_schema stage_schema =
    VN_SCHEMA("cco.stage", "Growth in a part of the domain", stage_fields, stage_default);

static int cco_stage(lua_State *L) {
    stage_def def;
    lua_settop(L, 2);
    vnl_read_options(L, 2, &stage_schema, &def);
    organ *o = enter(L, 1);
    vn_status status = vn_cco_stage(o->cco, def.domain, def.terminals);
    leave(L, 1, o);
    raise(L, o, status);
    return 0;
}

static int cco_grow(lua_State *L) {
    lua_Integer count = vnl_check_integer(L, 2, "cco:grow n");
    int32_t added;
    if (count < 1) {
        return vnl_fail(L, "cco:grow(%lld): 1 terminal or more expected", (long long)count);
    }
    organ *o = enter(L, 1);
    vn_status status = vn_cco_grow(o->cco, count < INT32_MAX ? (int32_t)count : INT32_MAX, &added);
    leave(L, 1, o);
    if (status == VN_INFEASIBLE) {
        lua_pushnil(L);
        lua_pushstring(L, vn_message());
        lua_pushinteger(L, added);
        return 3;
    }
    raise(L, o, status);
    lua_pushinteger(L, added);
    return 1;
}

static int cco_done(lua_State *L) {
    const organ *o = vnl_check(L, 1, &vnl_cco_class);
    lua_pushboolean(L, vn_cco_done(o->cco));
    return 1;
}

static int32_t check_tree(lua_State *L, const organ *o) {
    lua_Integer tree = vnl_check_integer(L, 2, "cco: number of the tree");
    if (tree < 1 || tree > vn_cco_tree_count(o->cco)) {
        vnl_fail(L, "cco: there is no tree %lld; there are %d", (long long)tree, vn_cco_tree_count(o->cco));
    }
    return (int32_t)(tree - 1);
}

static int cco_network(lua_State *L) {
    lua_settop(L, 2);
    void **box = vnl_push_box(L, &vnl_network_class);
    const organ *o = vnl_check(L, 1, &vnl_cco_class);
    vnl_try(L, vn_cco_network(o->cco, check_tree(L, o), (vn_network **)box));
    return 1;
}

static int cco_report(lua_State *L) {
    const organ *o = vnl_check(L, 1, &vnl_cco_class);
    vn_cco_report report = vn_cco_report_of(o->cco, check_tree(L, o));
    lua_createtable(L, 0, 14);
    vnl_set_integer(L, "terminals", report.terminals);
    vnl_set_integer(L, "wanted", report.wanted);
    vnl_set_number(L, "volume", report.volume);
    vnl_set_number(L, "inflow", report.inflow);
    vnl_set_integer(L, "darts", report.darts);
    vnl_set_integer(L, "redrawn", report.redrawn);
    vnl_set_integer(L, "tried", report.tried);
    vnl_set_integer(L, "begun_anew", report.begun_anew);
    vnl_set_integer(L, "collapsed", report.collapsed);
    vnl_set_integer(L, "short_segments", report.short_segments);
    vnl_set_integer(L, "outside", report.outside);
    vnl_set_integer(L, "crossing", report.crossing);
    vnl_set_integer(L, "crowding", report.crowding);
    vnl_set_integer(L, "asymmetric", report.asymmetric);
    return 1;
}

static int cco_length(lua_State *L) {
    const organ *o = vnl_check(L, 1, &vnl_cco_class);
    lua_pushinteger(L, vn_cco_tree_count(o->cco));
    return 1;
}

static const vnl_function methods[] = {
    {"add", cco_add, "(options: table): integer", NULL,
     "Add a tree, by the options of one in venule.cco{…} (`root` or `from`, `inflow`, …); its number.", NULL},
    {"avoid", cco_avoid, "(network: venule.Network)", NULL,
     "Keep clear of a network that does not grow here: its edges as tubes of their radii.", NULL},
    {"stage", cco_stage, "(options: {domain?: venule.Domain, terminals: integer})", NULL,
     "From now on terminals fall into that part of the domain, until each tree has so many more.", NULL},
    {"grow", cco_grow, "(n: integer): integer?, string?, integer?", NULL,
     "Add up to n terminals to each tree, in turns; how many came in all. Where no place is found for "
     "another: nil, why, and how many came before.",
     NULL},
    {"done", cco_done, "(): boolean", NULL, "Whether every tree has the terminals it was to have.", NULL},
    {"network", cco_network, "(tree: integer): venule.Network", NULL,
     "A tree as a network of its own, with radius, flow and pressure of the terminals it has now.", NULL},
    {"report", cco_report, "(tree: integer): venule.CcoReport", NULL,
     "What a tree has come to, and what was refused on the way.", NULL},
    {0},
};

const vnl_class vnl_cco_class = {
    .name = "cco",
    .doc = "What `venule.cco{…}` grows with, as its field `engine`: `#c` trees, numbered from 1.",
    .methods = methods,
    .release = release_organ,
    .length = cco_length,
};

// ---- For lua/venule/cco.lua ----

static int cco_rows(lua_State *L) {
    vnl_push_rows(L, &vn_cco_schema);
    vnl_push_rows(L, &vn_cco_tree_schema);
    return 2;
}

// venule.cco itself is made of these two by lua/venule/cco.lua.
const vnl_function vnl_cco_functions[] = {
    {"cco", make_cco, NULL, "venule.Cco", "The engine of venule.cco{…}.", &vn_cco_schema},
    {"cco_rows", cco_rows, "(): table[], table[]", NULL, "The options, as rows.", NULL},
    {0},
};
