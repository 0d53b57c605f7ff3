#include "bind/bind.h"

#include "colonize/attractors.h"
#include "network/flow.h"
#include "network/leaf.h"
#include "network/paths.h"
#include "network/vessels.h"

#include <string.h>

static void release_network(void *object) {
    vn_network_destroy(object);
}

static vn_network *check_network(lua_State *L) {
    return vnl_check(L, 1, &vnl_network_class);
}

static int32_t check_node(lua_State *L, int index, const vn_network *network, const char *what) {
    lua_Integer node = vnl_check_integer(L, index, what);
    if (node < 1 || node > vn_network_count(network)) {
        vnl_fail(L, "%s: node %lld is not one of the %d there are", what, (long long)node,
                 vn_network_count(network));
    }
    return (int32_t)(node - 1);
}

static void set_law(lua_State *L, int options, int index) {
    vn_murray_def def;
    vnl_read_options(L, options, &vn_murray_schema, &def);
    vnl_try(L, vn_network_murray(vnl_check(L, index, &vnl_network_class), &def));
}

static int make_network(lua_State *L) {
    vn_network_def def;
    vnl_read_options(L, 1, &vn_network_schema, &def);
    void **box = vnl_push_box(L, &vnl_network_class);
    vnl_try(L, vn_network_create((vn_network **)box, &def));
    if (vnl_raw_field(L, 1, "murray") != LUA_TNIL) {
        set_law(L, lua_gettop(L), lua_gettop(L) - 1);
    }
    lua_pop(L, 1);
    lua_pushvalue(L, -1);
    lua_setfield(L, LUA_REGISTRYINDEX, "venule.latest.network"); // what progress is shown of
    return 1;
}

static int network_root(lua_State *L) {
    vn_network *network = check_network(L);
    double p[3];
    int32_t node;
    vnl_check_coordinates(L, 2, vn_network_dim(network), p);
    vnl_try(L, vn_network_root(network, p, &node));
    lua_pushinteger(L, node + 1);
    return 1;
}

static int network_heading(lua_State *L) {
    vn_network *network = check_network(L);
    double d[3];
    int32_t root = check_node(L, 2, network, "heading");
    vnl_check_coordinates(L, 3, vn_network_dim(network), d);
    vnl_try(L, vn_network_set_heading(network, root, d));
    return 0;
}

static int network_zone(lua_State *L) {
    static const char *const kinds[] = {"none", "ball", "cone", "belt"};
    vn_perception perception;
    vn_zone_shape zone;
    vnl_read_options(L, 3, &vn_perception_schema, &perception);
    vn_network *network = check_network(L);
    vnl_try(L, vn_network_zone(network, check_node(L, 2, network, "zone"), &perception, &zone));
    lua_createtable(L, 0, 3);
    lua_pushstring(L, kinds[zone.kind]);
    lua_setfield(L, -2, "kind");
    vnl_set_number(L, "angle", zone.angle);
    vnl_set_list(L, "direction", zone.direction, vn_network_dim(network));
    return 1;
}

typedef vn_status put_fn(vn_network *network, int32_t at, const double p[3], int32_t *node);

// A new node at the coordinates from argument 3 on, hung on or put before node 2.
static int put_node(lua_State *L, const char *what, put_fn *put) {
    vn_network *network = check_network(L);
    double p[3];
    int32_t at = check_node(L, 2, network, what);
    int32_t node;
    vnl_check_coordinates(L, 3, vn_network_dim(network), p);
    vnl_try(L, put(network, at, p, &node));
    lua_pushinteger(L, node + 1);
    return 1;
}

static int network_add(lua_State *L) {
    return put_node(L, "network:add", vn_network_add);
}

static int network_split(lua_State *L) {
    return put_node(L, "network:split", vn_network_split);
}

static int network_join(lua_State *L) {
    vn_network *network = check_network(L);
    int32_t a = check_node(L, 2, network, "network:join");
    int32_t b = check_node(L, 3, network, "network:join");
    double radius = lua_isnoneornil(L, 4) ? 0 : vnl_check_number(L, 4, "network:join radius");
    vnl_try(L, vn_network_join(network, a, b, radius));
    return 0;
}

static int network_murray(lua_State *L) {
    set_law(L, 2, 1);
    return 0;
}

// The engine lists the newest child first; people count upwards.
static int network_children(lua_State *L) {
    vn_network *network = check_network(L);
    int32_t node = check_node(L, 2, network, "network:children");
    int count = 0;
    for (int32_t c = vn_network_first_child(network, node); c >= 0; c = vn_network_next_child(network, c)) {
        count++;
    }
    lua_createtable(L, count, 0);
    for (int32_t c = vn_network_first_child(network, node); c >= 0; c = vn_network_next_child(network, c)) {
        lua_pushinteger(L, c + 1);
        lua_rawseti(L, -2, count--);
    }
    return 1;
}

static int network_joins(lua_State *L) {
    vn_network *network = check_network(L);
    int32_t count = vn_network_join_count(network);
    bool known = vn_network_has_join_flow(network);
    lua_createtable(L, count, 0);
    for (int32_t i = 0; i < count; i++) {
        int32_t a, b;
        double radius;
        vn_network_join_ends(network, i, &a, &b, &radius);
        double flow = vn_network_join_flow(network, i);
        lua_createtable(L, 0, 4);
        vnl_set_integer(L, "a", a + 1);
        vnl_set_integer(L, "b", b + 1);
        vnl_set_number(L, "radius", radius);
        if (known) {
            vnl_set_number(L, "flow", flow);
        }
        lua_rawseti(L, -2, i + 1);
    }
    return 1;
}

static int network_orders(lua_State *L) {
    vn_orders_def def;
    const char *word = luaL_checkstring(L, 2);
    lua_settop(L, 3);
    vnl_read_options(L, 3, &vn_orders_schema, &def);
    vn_network *network = check_network(L);
    int kind = vn_choice_index("strahler|horton|hickey", word);
    if (kind < 0) {
        return vnl_fail(L, "network:orders(\"%s\") must be one of strahler, horton, hickey", word);
    }
    def.kind = (vn_order_kind)kind;
    vnl_try(L, vn_network_set_orders_by(network, &def));
    return 0;
}

static int network_measure(lua_State *L) {
    vn_leaf_def def;
    vn_network_measures m;
    lua_settop(L, 2);
    vn_leaf_measures *leaf = vnl_push_leaf_measures(L);
    bool wanted = vnl_read_switch(L, 2, "measure", "leaf", false);
    vnl_read_options(L, 2, &vn_leaf_schema, &def);
    vn_network *network = check_network(L);
    vnl_try(L, vn_network_measure(network, &m));
    if (wanted) {
        vnl_try(L, vn_network_measure_leaf(network, &def, leaf));
    }
    lua_createtable(L, 0, 11);
    vnl_set_integer(L, "nodes", m.nodes);
    vnl_set_integer(L, "roots", m.roots);
    vnl_set_integer(L, "tips", m.tips);
    vnl_set_integer(L, "bifurcations", m.bifurcations);
    vnl_set_integer(L, "joins", m.joins);
    vnl_set_integer(L, "depth", m.depth);
    vnl_set_number(L, "length", m.length);
    vnl_set_number(L, "min_radius", m.min_radius);
    vnl_set_number(L, "max_radius", m.max_radius);
    vnl_push_bounds(L, vn_network_dim(network), &m.extent, vn_network_unit(network));
    lua_setfield(L, -2, "extent");
    if (wanted) {
        vnl_push_leaf_table(L, leaf);
        lua_setfield(L, -2, "leaf");
    }
    return 1;
}

static int network_scale(lua_State *L) {
    vn_network *network = check_network(L);
    vnl_try(L, vn_network_scale(network, vnl_check_number(L, 2, "network:scale")));
    return 0;
}

static int network_save(lua_State *L) {
    const char *path = luaL_checkstring(L, 2);
    const char *manifest = vnl_push_manifest(L);
    vnl_try(L, vn_network_save(check_network(L), path, manifest));
    return 0;
}

// A run that ends with attractors left says why (venule.stalled()).
static void remember_stall(lua_State *L, const vn_network *network, const vn_influence *influence,
                           int32_t added) {
    int32_t left = vn_attractors_count(influence->attractors);
    if (added > 0 || left == 0 || vn_gaze_is_open(&influence->attractors->gaze)) {
        lua_pushnil(L); // drains that no vessel perceives are nothing to tell of
    } else if (vn_network_count(network) == 0) {
        lua_pushliteral(L, "the network has no root to grow from: call net:root(x, y)");
    } else if (vn_influence_count(influence) == 0) {
        lua_pushfstring(
            L,
            "stalled with %d attractors left: no node is within their reach (raise `within`, add attractors "
            "in between, or place a root nearer)",
            left);
    } else {
        lua_pushfstring(L,
                        "stalled with %d attractors left: no node can grow nearer to them (is the segment "
                        "length too long "
                        "for the kill distance?)",
                        left);
    }
    lua_setfield(L, LUA_REGISTRYINDEX, "venule.stalled");
}

// The network, or the list of them, that the options at @p index name.
static void read_avoided(lua_State *L, int index, vn_extend_def *def) {
    int type = vnl_raw_field(L, index, "avoid"), list = lua_gettop(L);
    lua_Unsigned count = type == LUA_TTABLE ? lua_rawlen(L, list) : type != LUA_TNIL;
    if (count > VN_MOST_AVOIDED) {
        vnl_fail(L, "extend.avoid: a list of at most %d networks expected", VN_MOST_AVOIDED);
    }
    if (type == LUA_TTABLE && count == 0) {
        lua_pushnil(L);
        if (lua_next(L, list) != 0) {
            vnl_fail(L,
                     "extend.avoid: a network or a list {a, b, …} of them expected, not a table with names");
        }
    }
    for (lua_Unsigned i = 0; i < count; i++) {
        if (type == LUA_TTABLE) {
            lua_rawgeti(L, list, (lua_Integer)i + 1);
        }
        if (vnl_test(L, -1, &vnl_network_class) == NULL && lua_type(L, -1) != LUA_TUSERDATA) {
            vnl_fail(L, "extend.avoid: a network or a list {a, b, …} of them expected, got a %s",
                     luaL_typename(L, -1));
        }
        def->avoid[i] = vnl_check(L, -1, &vnl_network_class);
    }
    def->avoid_count = (int32_t)count;
    lua_settop(L, list - 1);
}

static int network_extend(lua_State *L) {
    vn_extend_def def;
    int32_t added, first;
    vnl_read_options(L, 3, &vn_extend_schema, &def);
    read_avoided(L, 3, &def);
    vn_network *network = check_network(L);
    vn_influence *influence = vnl_check_influence(L, 2);
    vnl_try(L, vn_extend(network, influence, &def, &added, &first));
    remember_stall(L, network, influence, added);
    lua_pushinteger(L, added);
    lua_pushinteger(L, first + 1);
    return 2;
}

static const vnl_function methods[] = {
    {"root", network_root, "(x: number, y: number, z?: number): integer", NULL, "Add a root; its index.",
     NULL},
    {"add", network_add, "(parent: integer, x: number, y: number, z?: number): integer", NULL,
     "Add a child of a node; its index.", NULL},
    {"split", network_split, "(node: integer, x: number, y: number, z?: number): integer", NULL,
     "Put a new node into the edge between a node and its parent; its index.", NULL},
    {"join", network_join, "(a: integer, b: integer, radius?: number)", NULL,
     "Close a loop by an edge from a to b, whose parent a becomes too. `radius` holds while no law does.",
     NULL},
    {"murray", network_murray, "(options: venule.murray.Options)", NULL,
     "Give the edges radii by Murray's law; from now on they follow it, however the network grows.",
     &vn_murray_schema},
    {"heading", network_heading, "(root: integer, x: number, y: number, z?: number)", NULL,
     "The direction that the first segment from a root is to take, for what the root perceives.", NULL},
    {"zone", network_zone,
     "(node: integer, options: venule.perception.Options): {kind: string, angle: number, direction: "
     "number[]}",
     NULL,
     "What a vessel's node perceives (Rauch & Harders, Equations 2 and 3): a \"cone\" around `direction`, a "
     "\"belt\" at `angle` degrees from it, the whole \"ball\", or \"none\" when it cannot grow any more.",
     &vn_perception_schema},
    {"extend", network_extend,
     "(influence: venule.Influence, options: venule.extend.Options): integer, integer", NULL,
     "Grow each influenced node by one segment in the mean direction of its attractors (Runions, Equation "
     "1). How many "
     "nodes were added, and the first of them; when it adds none and nothing else changes, no later call "
     "will. `avoid = other` keeps this network clear of others for good; those that grow by turns must each "
     "avoid the other.",
     &vn_extend_schema},
    {"follow", vnl_network_follow, "(paths: number[][][], options: venule.follow.Options): integer, integer",
     NULL,
     "Lay vessels along paths (Rauch & Harders, Figure 4): each is a list of points {x, y} or {x, y, z}, and "
     "begins at "
     "the node nearest to its first point, which an earlier path may have made; in an empty network that "
     "point is the root. How many nodes were added, and the first of them.",
     &vn_follow_schema},
    {"children", network_children, "(node: integer): integer[]", NULL,
     "The children of a node, in the order of birth.", NULL},
    {"joins", network_joins, "(): {a: integer, b: integer, radius: number, flow?: number}[]", NULL,
     "The extra edges that close loops, with their radii; by Murray's law a is the parent. `flow`, from a to "
     "b, once net:flow{…} was called.",
     NULL},
    {"orders", network_orders, "(kind: \"strahler\"|\"horton\"|\"hickey\", options?: venule.orders.Options)",
     NULL,
     "Compute the vein order of every edge, read as `net.order`. Pictures then have a layer an order. Joins "
     "are nobody's "
     "children; a join has the higher order of its ends.",
     &vn_orders_schema},
    {"measure", network_measure, "(options?: venule.measure.Options): venule.Measures", NULL,
     "Counts, length and extent: nodes, roots, tips, bifurcations, joins, depth, length, min_radius, "
     "max_radius, extent. With `leaf = true` also what botanists measure in leaves, as `leaf`: vein density, "
     "areoles, free ends, junctions, the hierarchy of loops, angles, distances to veins.",
     &vn_leaf_schema},
    {"measure_vessels", vnl_network_measure_vessels,
     "(options?: venule.measure_vessels.Options): venule.VesselMeasures", NULL,
     "What anatomists measure in vessels. By how much Murray's law is missed where three edges or more meet "
     "(`murray`), and the exponents that would keep it (`fitted`). At bifurcations, nodes with a parent and "
     "two children: the daughters' `ratio` r2/r1, their area by the parent's (`expansion`), `angles` in "
     "degrees between the daughters and of the thick and the thin one to the parent's direction, by bins of "
     "the ratio with Murray's optimal angles (`theory`). Diameter, length and count by order, of segments "
     "(from fork to fork) and of elements (segments of one order in series), and the ratios from order to "
     "order, by regression. `tortuosity` is arc by chord, `curvature` the mean squared curvature along "
     "(radians²/length²). Lengths are the network's. Joins are nobody's children: they count for Murray's "
     "law "
     "alone.",
     &vn_vessel_measures_schema},
    {"measure_boxes", vnl_network_measure_boxes, "(options?: venule.measure_boxes.Options): venule.Boxes",
     NULL,
     "The box-counting dimension, always by one protocol: boxes of the extent / 2^k, where the extent is the "
     "longest side of the nodes' bounds; a box counts when an edge passes it, exactly; of several grids, "
     "each "
     "shifted by a part of the largest box (Halton's points, bases 3, 5, 7), the least count of each size; "
     "the "
     "slope of the least-squares line of ln count over ln 1/side. By the default range, in whatever "
     "direction "
     "they lie, straight lines have 1 to 1.05, filled squares 1.85 to 2.03, Koch's curve (1.262) 1.27 to "
     "1.33 "
     "and Sierpinski's triangle (1.585) 1.58 to 1.64: dimensions compare with others by this protocol. Boxes "
     "smaller than the mesh of a network see lines only: let `finest` suit it, and look at `boxes`.",
     &vn_boxes_schema},
    {"measure_tissue", vnl_network_measure_tissue, "(options: venule.measure_tissue.Options): venule.Tissue",
     NULL,
     "How far the points of a domain are from the nearest vessel: statistics, the `furthest` point, the most "
     "frequent distance (`mode`), a `histogram`, the share of points in vessels (`lumen`, 0 away) and within "
     "`reach` (`perfused`). Points are on a square or cubic grid; on surfaces at random, evenly by area, "
     "with "
     "distances straight through space. No point is much farther than `furthest`: from one point to another "
     "distances differ by no more than these are apart.",
     &vn_tissue_schema},
    {"flow", NULL, "(options?: venule.flow.Options): venule.FlowReport", NULL,
     "Solve Poiseuille's law for the flow in every edge (then read as `net.flow`, joins' by net:joins()) and "
     "the pressure at every node (`net.pressure`), and say what can be said of them. Pressures are in Pa, "
     "lengths L in the network's unit, flows in L³/s (mm³/s for mm), shear stresses in Pa. Pressures hold at "
     "roots and terminals unless a flow is given. With `solve = false` the flows and pressures that the "
     "network has, from a file or from growth, are checked instead: each of `conservation`, `drop` "
     "(Poiseuille's, along edges) and `terminal` (pressures against pressure_out) is the largest relative "
     "error and the node or join where it is. print(report) is one line of it.",
     &vn_flow_schema},
    {"levels", vnl_network_levels, "(): venule.Levels", NULL,
     "Diameter, length and flow of segments by bifurcation level, from level 0 at the root: a list; in it "
     "also statistics of the daughters' symmetry (thinnest radius by thickest), of length by diameter, and "
     "of the angle between two daughters. A segment runs from fork to fork. Joins are nobody's children.",
     NULL},
    {"scale", network_scale, "(factor: number)", NULL, "Multiply all coordinates and radii.", NULL},
    {"voxels", vnl_network_voxels, "(options?: venule.voxels.Options): venule.Volume", NULL,
     "The network in voxels: `net:voxels {resolution = 0.5, content = \"radius\"}:save \"radius.nii.gz\"`. "
     "See "
     "venule.voxels.",
     NULL},
    {"save", network_save, "(path: string)", NULL,
     "Write the network by the extension: .json, .xml, .gxl, .vtp, .swc, .csv, .txt (docs/formats.md).",
     NULL},
    {0},
};

static int32_t count_nodes(void *object) {
    return vn_network_count(object);
}

static void read_x(lua_State *L, void *object, int32_t i) {
    lua_pushnumber(L, vn_network_x(object)[i]);
}

static void read_y(lua_State *L, void *object, int32_t i) {
    lua_pushnumber(L, vn_network_y(object)[i]);
}

static void read_z(lua_State *L, void *object, int32_t i) {
    const double *z = vn_network_z(object);
    lua_pushnumber(L, z != NULL ? z[i] : 0);
}

static void read_parent(lua_State *L, void *object, int32_t i) {
    lua_pushinteger(L, vn_network_parent(object)[i] + 1);
}

static void read_tree(lua_State *L, void *object, int32_t i) {
    lua_pushinteger(L, vn_network_tree(object)[i] + 1);
}

static void read_birth(lua_State *L, void *object, int32_t i) {
    lua_pushinteger(L, vn_network_birth(object)[i]);
}

static void read_radius(lua_State *L, void *object, int32_t i) {
    lua_pushnumber(L, vn_network_radius(object, i));
}

static void read_order(lua_State *L, void *object, int32_t i) {
    const int32_t *orders = vn_network_orders(object);
    if (orders == NULL) {
        vnl_fail(L, "network.order is not known: call net:orders(\"hickey\") after the last change");
    }
    lua_pushinteger(L, orders[i]);
}

static const char not_solved[] = "is not known: call net:flow{…} after the last change";

static void read_flow(lua_State *L, void *object, int32_t i) {
    const double *flow = vn_network_flow(object);
    if (flow == NULL) {
        vnl_fail(L, "network.flow %s", not_solved);
    }
    lua_pushnumber(L, flow[i]);
}

static void read_pressure(lua_State *L, void *object, int32_t i) {
    const double *pressure = vn_network_pressure(object);
    if (pressure == NULL) {
        vnl_fail(L, "network.pressure %s", not_solved);
    }
    lua_pushnumber(L, pressure[i]);
}

static const struct {
    const char *name;
    vnl_read_fn *read;
    lua_CFunction call; // of a column that is a method as well
} columns[] = {{"x", read_x, NULL},
               {"y", read_y, NULL},
               {"z", read_z, NULL},
               {"parent", read_parent, NULL},
               {"tree", read_tree, NULL},
               {"birth", read_birth, NULL},
               {"radius", read_radius, NULL},
               {"order", read_order, NULL},
               {"flow", read_flow, vnl_network_flow},
               {"pressure", read_pressure, NULL}};

static int network_field(lua_State *L) {
    const vn_network *network = check_network(L);
    const char *key = lua_tostring(L, 2);
    for (size_t i = 0; i < sizeof columns / sizeof *columns; i++) {
        if (strcmp(key, columns[i].name) == 0) {
            vnl_push_view(L, 1, &vnl_network_class, columns[i].read, count_nodes);
            vnl_set_view_call(L, columns[i].call);
            return 1;
        }
    }
    if (strcmp(key, "dim") == 0) {
        lua_pushinteger(L, vn_network_dim(network));
        return 1;
    }
    if (strcmp(key, "unit") == 0) {
        lua_pushstring(L, vn_network_unit(network));
        return 1;
    }
    return 0;
}

static int network_length(lua_State *L) {
    lua_pushinteger(L, vn_network_count(check_network(L)));
    return 1;
}

static const char *const fields[] = {
    "x: number[] | the nodes' coordinates",
    "y: number[] | the nodes' coordinates",
    "z: number[] | the nodes' coordinates; 0 in 2D",
    "parent: integer[] | each node's parent, 0 at a root",
    "radius: number[] | of the edge to the parent; at a root, of its thickest child",
    "order: integer[] | of that edge, once net:orders(…) was called",
    "flow: number[] | through that edge (length³/s), what enters at a root; once net:flow{…} was called",
    "pressure: number[] | at the nodes (Pa), likewise",
    "tree: integer[] | which root each node hangs from, counted from 1",
    "birth: integer[] | the step each node was born in",
    "dim: integer | 2 or 3",
    "unit: string | the length unit that files carry",
    NULL};

const vnl_class vnl_network_class = {
    .name = "network",
    .doc = "What grows: a forest of nodes, and joins that close loops. `#net` nodes, numbered from 1.",
    .methods = methods,
    .fields = fields,
    .field = network_field,
    .release = release_network,
    .length = network_length,
};

static int free_set(lua_State *L) {
    vn_networks_free(lua_touserdata(L, 1));
    return 0;
}

static int load_networks(lua_State *L) {
    const char *path = vnl_push_path(L, 1);
    vn_network_set *set = vnl_push_owned(L, sizeof *set, free_set);
    vnl_try(L, vn_networks_load(set, path));
    bool single = set->count == 1 && set->names[0][0] == '\0';
    if (!single) {
        lua_createtable(L, 0, set->count);
    }
    for (int32_t i = 0; i < set->count; i++) {
        void **box = vnl_push_box(L, &vnl_network_class);
        *box = set->networks[i];
        set->networks[i] = NULL;
        if (!single) {
            lua_setfield(L, -2, set->names[i]);
        }
    }
    vn_networks_free(set);
    return 1;
}

// lua_next() walks in an order of hashes; a file must not.
static void sort_by_name(const vn_network **networks, const char **names, int32_t count) {
    for (int32_t i = 1; i < count; i++) {
        for (int32_t j = i; j > 0 && strcmp(names[j - 1], names[j]) > 0; j--) {
            const char *name = names[j];
            const vn_network *network = networks[j];
            names[j] = names[j - 1];
            networks[j] = networks[j - 1];
            names[j - 1] = name;
            networks[j - 1] = network;
        }
    }
}

int32_t vnl_named_networks(lua_State *L, int index, const char *what, const vn_network **networks,
                           const char **names) {
    int32_t count = 0;
    for (lua_pushnil(L); lua_next(L, index) != 0; lua_pop(L, 1), count++) {
        if (lua_type(L, -2) != LUA_TSTRING || count == VNL_MOST_NETWORKS) {
            vnl_fail(L, "%s: a table {name = network, …} of at most %d expected", what, VNL_MOST_NETWORKS);
        }
        names[count] = lua_tostring(L, -2);
        networks[count] = vnl_check(L, -1, &vnl_network_class);
    }
    sort_by_name(networks, names, count);
    return count;
}

/// Networks as they are given to a file; without names when it is one alone.
typedef struct given_networks {
    const vn_network *networks[VNL_MOST_NETWORKS];
    const char *names[VNL_MOST_NETWORKS];
    int32_t count;
    bool single;
} given_networks;

// The network, or the table of them by name, at index 2.
static void read_given(lua_State *L, const char *what, given_networks *given) {
    given->count = 1;
    given->single = lua_isuserdata(L, 2);
    if (given->single) {
        given->networks[0] = vnl_check(L, 2, &vnl_network_class);
        return;
    }
    luaL_checktype(L, 2, LUA_TTABLE);
    given->count = vnl_named_networks(L, 2, what, given->networks, given->names);
}

static int save_networks(lua_State *L) {
    given_networks given;
    const char *path = luaL_checkstring(L, 1);
    lua_settop(L, 2);
    const char *manifest = vnl_push_manifest(L);
    read_given(L, "save", &given);
    vnl_try(L,
            vn_networks_save(given.networks, given.single ? NULL : given.names, given.count, path, manifest));
    return 0;
}

static int can_save_networks(lua_State *L) {
    given_networks given;
    const char *path = luaL_checkstring(L, 1);
    lua_settop(L, 2);
    read_given(L, "can_save", &given);
    bool can =
        vn_networks_check(given.networks, given.single ? NULL : given.names, given.count, path) == VN_OK;
    lua_pushboolean(L, can);
    if (can) {
        return 1;
    }
    lua_pushstring(L, vn_message());
    return 2;
}

static int list_formats(lua_State *L) {
    lua_newtable(L);
    for (int32_t i = 0; vn_network_format(i) != NULL; i++) {
        lua_pushstring(L, vn_network_format(i));
        lua_rawseti(L, -2, i + 1);
    }
    return 1;
}

const vnl_function vnl_network_functions[] = {
    {"network", make_network, NULL, "venule.Network", "An empty network.", &vn_network_schema},
    {"load", load_networks, "(path: string): venule.Network|table<string, venule.Network>", NULL,
     "Read a network from a file, by its extension; or, where it holds several (.json), a table of them by "
     "name.",
     NULL},
    {"save", save_networks, "(path: string, networks: venule.Network|table<string, venule.Network>)", NULL,
     "Write one network, or several by name (.json), by the extension.", NULL},
    {"can_save", can_save_networks,
     "(path: string, networks: venule.Network|table<string, venule.Network>): boolean, string?", NULL,
     "Whether a file of that name can hold them; if not, why.", NULL},
    {"formats", list_formats, "(): string[]", NULL, "The extensions that networks are written and read by.",
     NULL},
    {0},
};
