// A leaf's measures as a table.

#include "bind/bind.h"

#include "network/leaf.h"

static int free_measures(lua_State *L) {
    vn_leaf_measures_free(lua_touserdata(L, 1));
    return 0;
}

vn_leaf_measures *vnl_push_leaf_measures(lua_State *L) {
    return vnl_push_owned(L, sizeof(vn_leaf_measures), free_measures);
}

static void set_hierarchy(lua_State *L, const vn_loop_hierarchy *h) {
    lua_createtable(L, 0, 5);
    vnl_set_integer(L, "merges", h->merge_count);
    vnl_set_integer(L, "height", h->height);
    vnl_set_integer(L, "strahler", h->strahler);
    vnl_set_number(L, "asymmetry", h->asymmetry);
    vnl_set_number(L, "nesting", h->nesting);
    lua_setfield(L, -2, "hierarchy");
}

static void set_angles(lua_State *L, const vn_branching_angles *angles) {
    lua_createtable(L, 0, 3);
    vnl_set_integer(L, "count", angles->count);
    vnl_set_number(L, "daughters", angles->daughters);
    lua_createtable(L, 5, 0);
    for (int k = 0; k < 5; k++) {
        lua_createtable(L, 0, 6);
        vnl_set_number(L, "from", k / 5.0);
        vnl_set_number(L, "to", (k + 1) / 5.0);
        vnl_set_integer(L, "count", angles->bins[k].count);
        vnl_set_number(L, "thick_middle", angles->bins[k].thick_middle);
        vnl_set_number(L, "thick_thin", angles->bins[k].thick_thin);
        vnl_set_number(L, "middle_thin", angles->bins[k].middle_thin);
        lua_rawseti(L, -2, k + 1);
    }
    lua_setfield(L, -2, "bins");
    lua_setfield(L, -2, "angles");
}

static void set_distance(lua_State *L, const vn_vein_distance *distance) {
    lua_createtable(L, 0, 5);
    vnl_set_number(L, "resolution", distance->resolution);
    vnl_set_integer(L, "points", distance->points);
    vnl_set_number(L, "mean", distance->mean);
    vnl_set_number(L, "max", distance->max);
    vnl_set_number(L, "mode", distance->mode);
    lua_setfield(L, -2, "distance");
}

static void set_counts(lua_State *L, const vn_leaf_measures *m) {
    vnl_set_integer(L, "tips", m->tips);
    vnl_set_integer(L, "free_ends", m->free_ends);
    vnl_set_integer(L, "degree3", m->degree3);
    vnl_set_integer(L, "degree4", m->degree4);
    vnl_set_integer(L, "degree_more", m->degree_more);
    vnl_set_integer(L, "loops", m->loops);
    vnl_set_integer(L, "crossings", m->crossings);
    vnl_set_integer(L, "areoles", m->areoles);
}

void vnl_push_leaf_table(lua_State *L, const vn_leaf_measures *m) {
    lua_createtable(L, 0, 22);
    vnl_set_number(L, "area", m->area);
    lua_pushstring(L, m->hull ? "hull" : "domain");
    lua_setfield(L, -2, "area_of");
    vnl_set_number(L, "length", m->length);
    vnl_set_number(L, "density", m->density);
    vnl_set_number(L, "tip_density", m->tip_density);
    vnl_set_number(L, "free_end_density", m->free_end_density);
    set_counts(L, m);
    vnl_set_list(L, "order_density", m->order_density, m->order_count);
    vnl_set_list(L, "areole_areas", m->areole_areas, m->areoles);
    vnl_set_list(L, "areole_quotients", m->areole_quotients, m->areoles);
    vnl_set_statistics(L, "areole_area", &m->areole_area);
    vnl_set_statistics(L, "areole_quotient", &m->areole_quotient);
    set_hierarchy(L, &m->hierarchy);
    set_angles(L, &m->angles);
    set_distance(L, &m->distance);
}
