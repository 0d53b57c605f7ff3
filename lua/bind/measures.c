// Measures of vessels as tables.

#include "bind/bind.h"

#include "network/vessels.h"

static int free_vessels(lua_State *L) {
    vn_vessel_measures_free(lua_touserdata(L, 1));
    return 0;
}

static int free_tissue(lua_State *L) {
    vn_tissue_free(lua_touserdata(L, 1));
    return 0;
}

static void set_theory(lua_State *L, const vn_fork_angles *angles) {
    lua_createtable(L, 0, 3);
    vnl_set_number(L, "between", angles->between);
    vnl_set_number(L, "thick", angles->thick);
    vnl_set_number(L, "thin", angles->thin);
    lua_setfield(L, -2, "theory");
}

static void set_bins(lua_State *L, const vn_vessel_measures *m) {
    lua_createtable(L, m->bin_count, 0);
    for (int32_t k = 0; k < m->bin_count; k++) {
        const vn_fork_bin *bin = &m->bins[k];
        lua_createtable(L, 0, 8);
        vnl_set_number(L, "from", (double)k / m->bin_count);
        vnl_set_number(L, "to", (k + 1.0) / m->bin_count);
        vnl_set_integer(L, "count", bin->count);
        if (bin->count > 0) {
            vnl_set_number(L, "ratio", bin->ratio);
            vnl_set_spread(L, "between", &bin->between);
            vnl_set_spread(L, "thick", &bin->thick);
            vnl_set_spread(L, "thin", &bin->thin);
            set_theory(L, &bin->theory);
        }
        lua_rawseti(L, -2, k + 1);
    }
    lua_setfield(L, -2, "bins");
}

static void set_murray(lua_State *L, const vn_vessel_measures *m) {
    vnl_set_number(L, "exponent", m->exponent);
    vnl_set_statistics(L, "murray", &m->murray);
    lua_getfield(L, -1, "murray");
    vnl_set_number(L, "rms", m->murray_rms);
    if (m->murray_worst >= 0) {
        vnl_set_integer(L, "worst", m->murray_worst + 1);
    }
    lua_pop(L, 1);
    vnl_set_statistics(L, "fitted", &m->fitted);
}

static void set_forks(lua_State *L, const vn_vessel_measures *m) {
    vnl_set_integer(L, "bifurcations", m->bifurcations);
    vnl_set_integer(L, "furcations", m->furcations);
    vnl_set_statistics(L, "ratio", &m->ratio);
    vnl_set_statistics(L, "expansion", &m->expansion);
    lua_createtable(L, 0, 4);
    vnl_set_statistics(L, "between", &m->between);
    vnl_set_statistics(L, "thick", &m->thick);
    vnl_set_statistics(L, "thin", &m->thin);
    set_bins(L, m);
    lua_setfield(L, -2, "angles");
}

static void set_part(lua_State *L, const char *name, int32_t count, const vn_spread *diameter,
                     const vn_spread *length) {
    lua_createtable(L, 0, 3);
    vnl_set_integer(L, "count", count);
    vnl_set_spread(L, "diameter", diameter);
    vnl_set_spread(L, "length", length);
    lua_setfield(L, -2, name);
}

static void set_order_ratio(lua_State *L, const char *name, const vn_order_ratio *ratio) {
    lua_createtable(L, 0, 2);
    vnl_set_number(L, "ratio", ratio->ratio);
    vnl_set_number(L, "r2", ratio->r2);
    lua_setfield(L, -2, name);
}

static void set_orders(lua_State *L, const vn_vessel_measures *m) {
    lua_createtable(L, m->order_count, 0);
    for (int32_t k = 0; k < m->order_count; k++) {
        const vn_vessel_order *order = &m->orders[k];
        lua_createtable(L, 0, 2);
        set_part(L, "segments", order->segments, &order->segment_diameter, &order->segment_length);
        set_part(L, "elements", order->elements, &order->element_diameter, &order->element_length);
        lua_rawseti(L, -2, k + 1);
    }
    lua_setfield(L, -2, "orders");
    vnl_set_integer(L, "segments", m->segments);
    vnl_set_integer(L, "elements", m->elements);
    set_order_ratio(L, "bifurcation_ratio", &m->bifurcation_ratio);
    set_order_ratio(L, "diameter_ratio", &m->diameter_ratio);
    set_order_ratio(L, "length_ratio", &m->length_ratio);
}

static void set_curves(lua_State *L, const char *name, const vn_statistics *segments,
                       const vn_statistics *elements) {
    lua_createtable(L, 0, 2);
    vnl_set_statistics(L, "segments", segments);
    vnl_set_statistics(L, "elements", elements);
    lua_setfield(L, -2, name);
}

int vnl_network_measure_vessels(lua_State *L) {
    vn_vessel_measures_def def;
    lua_settop(L, 2);
    vn_vessel_measures *m = vnl_push_owned(L, sizeof *m, free_vessels);
    vnl_read_options(L, 2, &vn_vessel_measures_schema, &def);
    vnl_try(L, vn_network_measure_vessels(vnl_check(L, 1, &vnl_network_class), &def, m));
    lua_createtable(L, 0, 17);
    set_murray(L, m);
    set_forks(L, m);
    set_orders(L, m);
    set_curves(L, "tortuosity", &m->segment_tortuosity, &m->element_tortuosity);
    set_curves(L, "curvature", &m->segment_curvature, &m->element_curvature);
    return 1;
}

int vnl_network_measure_boxes(lua_State *L) {
    vn_boxes_def def;
    vn_boxes boxes;
    lua_settop(L, 2);
    vnl_read_options(L, 2, &vn_boxes_schema, &def);
    vnl_try(L, vn_network_measure_boxes(vnl_check(L, 1, &vnl_network_class), &def, &boxes));
    lua_createtable(L, 0, 4);
    vnl_set_number(L, "dimension", boxes.dimension);
    vnl_set_number(L, "r2", boxes.r2);
    vnl_set_number(L, "extent", boxes.extent);
    lua_createtable(L, boxes.sizes, 0);
    for (int32_t k = 0; k < boxes.sizes; k++) {
        lua_createtable(L, 0, 2);
        vnl_set_number(L, "side", boxes.side[k]);
        vnl_set_integer(L, "count", boxes.count[k]);
        lua_rawseti(L, -2, k + 1);
    }
    lua_setfield(L, -2, "boxes");
    return 1;
}

static void set_histogram(lua_State *L, const vn_tissue *tissue) {
    lua_createtable(L, tissue->bins, 0);
    for (int32_t i = 0; i < tissue->bins; i++) {
        lua_pushinteger(L, tissue->histogram[i]);
        lua_rawseti(L, -2, i + 1);
    }
    lua_setfield(L, -2, "histogram");
}

int vnl_network_measure_tissue(lua_State *L) {
    vn_tissue_def def;
    lua_settop(L, 2);
    vn_tissue *tissue = vnl_push_owned(L, sizeof *tissue, free_tissue);
    vnl_read_options(L, 2, &vn_tissue_schema, &def);
    vn_network *network = vnl_check(L, 1, &vnl_network_class);
    int dim = vn_network_dim(network);
    vnl_try(L, vn_network_measure_tissue(network, &def, tissue));
    lua_createtable(L, 0, 9);
    vnl_set_number(L, "resolution", tissue->resolution);
    vnl_set_integer(L, "points", tissue->points);
    vnl_set_statistics(L, "distance", &tissue->distance);
    vnl_set_point(L, "furthest", dim, tissue->furthest);
    vnl_set_number(L, "mode", tissue->mode);
    vnl_set_number(L, "lumen", tissue->lumen);
    if (def.reach > 0) {
        vnl_set_number(L, "perfused", tissue->perfused);
    }
    vnl_set_number(L, "bin", tissue->bin);
    set_histogram(L, tissue);
    return 1;
}
