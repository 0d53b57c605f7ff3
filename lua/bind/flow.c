// What flows through a network, and its levels, as tables.

#include "bind/bind.h"

#include "network/flow.h"

#include <stdio.h>

static int free_report(lua_State *L) {
    vn_flow_report_free(lua_touserdata(L, 1));
    return 0;
}

static int free_levels(lua_State *L) {
    vn_levels_free(lua_touserdata(L, 1));
    return 0;
}

static void set_worst(lua_State *L, const char *name, const vn_flow_worst *worst) {
    lua_createtable(L, 0, 2);
    vnl_set_number(L, "error", worst->error);
    if (worst->node >= 0) {
        vnl_set_integer(L, "node", worst->node + 1);
    } else if (worst->join >= 0) {
        vnl_set_integer(L, "join", worst->join + 1);
    }
    lua_setfield(L, -2, name);
}

static void set_terminals(lua_State *L, const vn_flow_report *report) {
    int32_t count = report->terminal_count;
    lua_createtable(L, 0, 3);
    lua_createtable(L, count, 0);
    lua_createtable(L, count, 0);
    lua_createtable(L, count, 0);
    for (int32_t i = 0; i < count; i++) {
        const vn_terminal *terminal = &report->terminals[i];
        lua_pushinteger(L, terminal->node + 1);
        lua_rawseti(L, -4, i + 1);
        lua_pushnumber(L, terminal->pressure);
        lua_rawseti(L, -3, i + 1);
        lua_pushnumber(L, terminal->flow);
        lua_rawseti(L, -2, i + 1);
    }
    lua_setfield(L, -4, "flow");
    lua_setfield(L, -3, "pressure");
    lua_setfield(L, -2, "node");
    lua_setfield(L, -2, "terminals");
}

static int tell_text(lua_State *L) {
    lua_pushvalue(L, lua_upvalueindex(1));
    return 1;
}

// print(report) says the most of it in one line.
static void set_text(lua_State *L, const vn_flow_report *r, const char *unit) {
    char text[400];
    snprintf(text, sizeof text,
             "flow in %g, out %g %s³/s; %d terminals at %g to %g Pa; wall shear %g to %g Pa; errors: "
             "conservation %.1e, drop %.1e, terminals %.1e, Murray %.1e (median)",
             r->inflow, r->outflow, unit[0] != '\0' ? unit : "length", r->terminal_count,
             r->terminal_pressure.min, r->terminal_pressure.max, r->wall_shear.min, r->wall_shear.max,
             r->conservation.error, r->drop.error, r->terminal.error, r->murray.median);
    lua_createtable(L, 0, 1);
    lua_pushstring(L, text);
    lua_pushcclosure(L, tell_text, 1);
    lua_setfield(L, -2, "__tostring");
    lua_setmetatable(L, -2);
}

static void push_report(lua_State *L, const vn_flow_report *r, int32_t nodes) {
    lua_createtable(L, 0, 17);
    vnl_set_number(L, "inflow", r->inflow);
    vnl_set_number(L, "outflow", r->outflow);
    vnl_set_number(L, "volume", r->volume);
    vnl_set_number(L, "resistance", r->resistance);
    vnl_set_number(L, "power", r->power);
    set_worst(L, "conservation", &r->conservation);
    set_worst(L, "drop", &r->drop);
    set_worst(L, "terminal", &r->terminal);
    vnl_set_statistics(L, "terminal_pressure", &r->terminal_pressure);
    vnl_set_statistics(L, "terminal_flow", &r->terminal_flow);
    vnl_set_statistics(L, "wall_shear", &r->wall_shear);
    vnl_set_statistics(L, "murray", &r->murray);
    vnl_set_statistics(L, "fitted", &r->fitted);
    set_terminals(L, r);
    vnl_set_list(L, "edge_shear", r->edge_shear, nodes);
    vnl_set_list(L, "join_shear", r->edge_count > nodes ? r->edge_shear + nodes : NULL,
                 r->edge_count - nodes);
}

int vnl_network_flow(lua_State *L) {
    vn_flow_def def;
    lua_settop(L, 2);
    vn_flow_report *report = vnl_push_owned(L, sizeof *report, free_report);
    bool solve = vnl_read_switch(L, 2, "flow", "solve", true);
    vnl_read_options(L, 2, &vn_flow_schema, &def);
    vn_network *network = vnl_check(L, 1, &vnl_network_class);
    vnl_try(L, solve ? vn_network_solve_flow(network, &def, report)
                     : vn_network_audit_flow(network, &def, report));
    int32_t nodes = vn_network_count(network);
    char unit[32];
    snprintf(unit, sizeof unit, "%s", vn_network_unit(network)); // a finaliser may close the network below
    push_report(L, report, nodes);
    set_text(L, report, unit);
    return 1;
}

static void push_levels(lua_State *L, const vn_levels *levels) {
    lua_createtable(L, levels->count, 4);
    for (int32_t k = 0; k < levels->count; k++) {
        const vn_level *level = &levels->levels[k];
        lua_createtable(L, 0, 5);
        vnl_set_integer(L, "level", k);
        vnl_set_integer(L, "count", level->count);
        vnl_set_spread(L, "diameter", &level->diameter);
        vnl_set_spread(L, "length", &level->length);
        if (levels->has_flow) {
            vnl_set_spread(L, "flow", &level->flow);
        }
        lua_rawseti(L, -2, k + 1);
    }
    vnl_set_integer(L, "segments", levels->segments);
    vnl_set_statistics(L, "symmetry", &levels->symmetry);
    vnl_set_statistics(L, "slenderness", &levels->slenderness);
    vnl_set_statistics(L, "angle", &levels->angle);
}

int vnl_network_levels(lua_State *L) {
    lua_settop(L, 1);
    vn_levels *levels = vnl_push_owned(L, sizeof *levels, free_levels);
    vnl_try(L, vn_network_levels(vnl_check(L, 1, &vnl_network_class), levels));
    push_levels(L, levels);
    return 1;
}
