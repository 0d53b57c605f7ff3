/// The network from inside: columns, and what other engine folders may ask beyond the public header.
#ifndef VN_NETWORK_NETWORK_H
#define VN_NETWORK_NETWORK_H

#include "base/schema.h"
#include "space/box_grid.h"
#include "space/delaunay.h"
#include "space/edge_grid.h"
#include "space/point_grid.h"
#include "space/point_tree.h"
#include "venule/network.h"

extern const vn_schema vn_network_schema;
extern const vn_schema vn_murray_schema;
extern const vn_schema vn_orders_schema;

typedef struct vn_join {
    int32_t a, b;
    double radius;
} vn_join;

/// Murray's law where edges alone do not tell (demand.c); worked out when asked for, in memory that was
/// reserved before: 17 bytes a node.
typedef struct vn_demand {
    VN_ARRAY(double) share;   ///< what each parent edge of a node carries, in tips; at a source, its demand
    VN_ARRAY(int32_t) sorted; ///< nodes, parents before children over edges and joins
    VN_ARRAY(int32_t) first;  ///< each node's first join end (2 join at a, 2 join + 1 at b), or -1
    VN_ARRAY(int32_t) next;   ///< the next join end at the same node, or -1
    VN_ARRAY(bool) flipped;   ///< joins whose parent is b
    VN_ARRAY(uint8_t) major;  ///< nodes of primary and secondary veins; with veinlets only
    uint64_t version;         ///< of the network that it holds for
} vn_demand;

/// Where a root's first segment is to go, a unit vector.
typedef struct vn_heading {
    int32_t root;
    double direction[3];
} vn_heading;

/// Whom a network has asked for room, and when.
typedef struct vn_asked {
    uint64_t serial, epoch;
} vn_asked;

/// How networks keep clear of each other (berth.h); empty until they are asked to: 13 bytes a node, and the
/// grid.
typedef struct vn_berth {
    vn_box_grid grid;
    VN_ARRAY(double) room;   ///< the largest radius that an edge may have without asking
    VN_ARRAY(int32_t) most;  ///< as many tips; Murray only
    VN_ARRAY(uint8_t) level; ///< how far around its axis an edge is listed
    VN_ARRAY(vn_asked) asked;
    int32_t items;  ///< that the grid's cells were chosen for
    bool ready;     ///< all this holds, or did before what happened since
    bool rooms;     ///< some may be more than a radius
    uint64_t epoch; ///< changes when something did that has not asked
    uint64_t moved, version;
    int32_t joins;
    bool simple; ///< radii follow from numbers of tips alone, by this law
    vn_murray_def law;
} vn_berth;

/// One entry a node in every column that is in use: 44 bytes a node in 2D with Murray radii.
struct vn_network {
    int dim;
    int32_t max_nodes;
    char *unit;
    VN_ARRAY(double) x;
    VN_ARRAY(double) y;
    VN_ARRAY(double) z; ///< 3D only
    VN_ARRAY(int32_t) parent;
    VN_ARRAY(int32_t) first_child; ///< the newest
    VN_ARRAY(int32_t) next_child;
    VN_ARRAY(int32_t) tree;
    VN_ARRAY(int32_t) birth;
    VN_ARRAY(int32_t) tips;    ///< Murray only: tips at or below the node, once `pending` was carried up
    VN_ARRAY(int32_t) pending; ///< nodes that got one tip more, not yet told to those above
    bool recount;              ///< so much is pending that one pass over everything is cheaper
    VN_ARRAY(double) radius;   ///< given radii; empty when nobody gave any
    VN_ARRAY(vn_join) joins;
    VN_ARRAY(uint64_t) joined; ///< the pairs of nodes that have a join, hashed; 0: an empty place
    VN_ARRAY(int32_t) orders;
    double orders_ratio; ///< that Hickey's were computed with
    uint64_t orders_version;
    VN_ARRAY(double) flow;     ///< of each node's edge; empty when nobody said
    VN_ARRAY(double) pressure; ///< at each node; may be empty beside `flow`
    uint64_t flow_version;
    VN_ARRAY(double) join_flow; ///< from the ends that were given as `a`; empty when nobody said
    uint64_t join_flow_version;
    VN_ARRAY(int32_t) sequence; ///< parents first; empty while the indices themselves are such an order
    bool unordered;             ///< an edge was split since `sequence` was made; it has room for all nodes
    bool murray;
    vn_murray_def law;
    vn_demand demand;
    int32_t roots;
    VN_ARRAY(vn_heading) headings;
    int32_t step;
    uint64_t serial;  ///< which network this is, among all of the process
    uint64_t version; ///< changes with every change
    uint64_t moved;   ///< changes when nodes that were there moved
    uint64_t
        turned; ///< changes when a direction did that a node perceives along: of a heading, or a split edge
    vn_point_grid grid;
    uint64_t grid_moved;
    int32_t grid_count;           ///< nodes when its cells were chosen
    vn_point_tree tree_of_points; ///< of the nodes; empty until somebody asks
    uint64_t tree_moved;
    vn_delaunay *delaunay; ///< of the nodes; NULL until somebody asks
    uint64_t delaunay_moved;
    vn_edge_grid edges; ///< of a flat network; joins are listed as -1 - join
    uint64_t edges_moved;
    int32_t edge_nodes, edge_joins; ///< how many are listed
    int32_t edge_room;              ///< how many of both the buckets are meant for
    vn_berth berth;
};

static inline vn_points vn_network_points(const vn_network *network) {
    return (vn_points){network->x.data, network->y.data, network->dim == 3 ? network->z.data : NULL};
}

static inline void vn_network_position(const vn_network *network, int32_t node, double p[3]) {
    vn_points points = vn_network_points(network);
    vn_points_get(&points, node, p);
}

/// The nodes in a grid, brought up to date. @p reach says which distances will be asked for (0: unknown).
vn_status vn_network_grid(vn_network *network, double reach, const vn_point_grid **grid);

/// Room for @p need nodes in every column first, so that a failure leaves the network as it was.
vn_status vn_network_reserve(vn_network *network, int64_t need);
/// Room for one more node, at @p p; or why there is none.
vn_status vn_network_make_room(vn_network *network, const double p[3]);

/// The nodes in a tree, brought up to date.
vn_status vn_network_tree_of_points(vn_network *network, const vn_point_tree **tree);
/// The Delaunay triangulation of the nodes, brought up to date.
vn_status vn_network_delaunay(vn_network *network, vn_delaunay **delaunay);

/// Where edge @p edge of a flat network is: of a node and its parent, or of a join, as -1 - join.
vn_segment vn_network_segment(const vn_network *network, int32_t edge);
void vn_network_edge_ends(const vn_network *network, int32_t edge, int32_t *a, int32_t *b);

/// Where a straight way from a node first meets an edge.
typedef struct vn_meeting {
    int32_t edge; ///< as vn_network_segment() names it
    double way;   ///< the part of the way up to there, 0 to 1; 0 when it runs along an edge of its own node
    double p[3];  ///< on the edge
} vn_meeting;
/// How near a way has to come to an edge to meet it, in typical lengths.
#define VN_NEAR_EDGE 1e-6
/// Whether the way from @p node to @p p meets an edge of this flat network other than at @p node itself, or
/// at node @p to, which may be -1. @p typical is a length that most new edges have; the edge is met from
/// VN_NEAR_EDGE of it on.
vn_status vn_network_meets(vn_network *network, int32_t node, const double p[3], int32_t to, double typical,
                           bool *meets, vn_meeting *meeting);

/// The heading of a root; false where it has none.
bool vn_network_heading(const vn_network *network, int32_t root, double direction[3]);

/// Whether an edge or a join connects them.
bool vn_network_connected(const vn_network *network, int32_t a, int32_t b);

/// Carry pending tips up, so that `tips` holds everywhere.
void vn_network_settle(const vn_network *constant);

/// Make `sequence` anew, breadth first; how many nodes hang from a root.
int32_t vn_network_resequence(vn_network *network);

/// Node @p k of the traversal order, parents first.
static inline int32_t vn_network_nth(const vn_network *network, int32_t k) {
    if (network->unordered) {
        vn_network_resequence((vn_network *)network); // a cache: what it says was settled by the growth
    }
    return network->sequence.count > 0 ? network->sequence.data[k] : k;
}

/// What vn_network_set_orders_by() keeps; @p order has room for all nodes.
vn_status vn_network_compute_orders(const vn_network *network, const vn_orders_def *def, int32_t *order);

/// How many tips hang at or below each node; @p tips has room for all.
void vn_network_count_tips(const vn_network *network, int32_t *tips);

/// Whether widths follow from demands: there is a law, and joins or veinlets.
bool vn_demand_rules(const vn_network *network);
vn_status vn_demand_reserve(vn_network *network, int64_t nodes, int64_t joins);
void vn_demand_free(vn_demand *demand);
/// The demands, brought up to date; only where they rule.
const vn_demand *vn_network_demand(const vn_network *constant);
/// The largest share among a node's child edges.
double vn_demand_thickest(const vn_network *network, int32_t node);
/// The radius of an edge that carries the demand of so many tips, by the law in force.
double vn_murray_radius(const vn_network *network, double tips);

/// The law in force; false when there is none.
bool vn_network_murray_get(const vn_network *network, vn_murray_def *def);
/// Whether vn_network_radius() knows anything.
bool vn_network_has_radii(const vn_network *network);

/// Give every node's edge a radius of its own, in place of a law; @p radius has one entry a node, each 0
/// or more.
vn_status vn_network_set_radii(vn_network *network, const double *radius);

/// A whole network at once, for readers.
typedef struct vn_network_columns {
    int dim;
    int32_t count;
    const double *x, *y, *z;
    const int32_t *parent; ///< -1 at roots; in any order
    const double *radius;  ///< may be NULL
    const int32_t *birth;  ///< may be NULL
    const char *unit;
} vn_network_columns;
/// For those that fill the columns of an empty network themselves: make it @p count nodes, whose places,
/// parents and births are then to be written; and, once they are, hang what has a parent below it. VN_INVALID
/// for parents that run in a circle.
vn_status vn_network_allot(vn_network *network, int32_t count);
vn_status vn_network_hang(vn_network *network);
/// VN_INVALID for parents that do not exist or form a circle, and for numbers that are not finite.
vn_status vn_network_from_columns(vn_network **out, const vn_network_columns *columns);

#endif
