/// @file network.h
/// What grows: a forest of nodes, each with one parent or none, and joins, the extra edges that close loops.
#ifndef VENULE_NETWORK_H
#define VENULE_NETWORK_H

#include "venule/base.h"
#include "venule/domain.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Nodes are numbered from 0 in the order in which they were added.
typedef struct vn_network vn_network;

typedef struct vn_network_def {
    int32_t dim;       ///< 2 or 3; default 2
    int32_t max_nodes; ///< a network that grows beyond it fails with VN_LIMIT; default 100,000,000
    const char *unit;  ///< the length unit that files carry ("mm"), "" for none; copied
} vn_network_def;
VN_API vn_network_def vn_network_def_default(void);
VN_API vn_status vn_network_create(vn_network **out, const vn_network_def *def);
VN_API void vn_network_destroy(vn_network *network);

/// Radii by Murray's law (Runions §3.5): r_parent^exponent = Σ r_child^exponent, from the tips' radius up.
/// A node that several edges lead to, its own and those of joins, shares what its children carry equally
/// among these: r = (Σ r_child^exponent / parents)^(1/exponent). What leaves all nodes without a parent is
/// then what all tips take up.
typedef struct vn_murray_def {
    double exponent;   ///< > 0, at most 100; default 3
    double tip_radius; ///< > 0; default 1
    /// What each node of a primary or secondary vein takes up besides its children, as so many tips
    /// (tip_radius^exponent each): for veinlets that are not modeled. These veins are those of Hickey's
    /// orders 1 and 2 by the widths without widening; their tips stay as they are. 0 (the default) to 1e9.
    double veinlets;
} vn_murray_def;
VN_API vn_murray_def vn_murray_def_default(void);
/// From now on the radii follow the law, however the network grows.
VN_API vn_status vn_network_murray(vn_network *network, const vn_murray_def *def);

/// Add a root at @p p; its index into @p node (which may be NULL). VN_INVALID for a point that is not finite.
VN_API vn_status vn_network_root(vn_network *network, const double p[3], int32_t *node);
/// The direction that a root's first segment is to take (any length above 0), for what a root perceives.
/// VN_INVALID for a node that is no root, and for no direction.
VN_API vn_status vn_network_set_heading(vn_network *network, int32_t root, const double direction[3]);
/// Add a child of @p parent. VN_INVALID for a parent that does not exist.
VN_API vn_status vn_network_add(vn_network *network, int32_t parent, const double p[3], int32_t *node);
/// Put a new node at @p p into the edge between @p child and its parent: the new node is a child of that
/// parent, and @p child its only child. It was born when @p child was, and the edge's radius holds for both
/// halves. VN_INVALID for a root, which has no edge.
VN_API vn_status vn_network_split(vn_network *network, int32_t child, const double p[3], int32_t *node);
/// Close a loop: an extra edge between @p a, meant as the parent, and @p b, the child, whose own parent is
/// the first of those that meet in it. VN_INVALID when they are the same or connected already. @p radius is
/// what it has while no law is in force.
VN_API vn_status vn_network_join(vn_network *network, int32_t a, int32_t b, double radius);
/// The step that nodes added from now on were born in; 0 at first. vn_extend() counts it on.
VN_API void vn_network_set_step(vn_network *network, int32_t step);
VN_API int32_t vn_network_step(const vn_network *network);

VN_API int vn_network_dim(const vn_network *network);
VN_API const char *vn_network_unit(const vn_network *network);
VN_API int32_t vn_network_count(const vn_network *network);
VN_API int32_t vn_network_join_count(const vn_network *network);
/// The ends of a join and its radius: by Murray's law where it is in force, as given otherwise. By the law
/// @p a is the parent: a join that would make parents run in a circle is turned for it.
VN_API void vn_network_join_ends(const vn_network *network, int32_t join, int32_t *a, int32_t *b,
                                 double *radius);

/// Columns, one entry a node; borrowed until the network next changes. `z` is NULL in 2D.
VN_API const double *vn_network_x(const vn_network *network);
VN_API const double *vn_network_y(const vn_network *network);
VN_API const double *vn_network_z(const vn_network *network);
/// -1 at a root.
VN_API const int32_t *vn_network_parent(const vn_network *network);
/// Which root a node hangs from, roots counted from 0.
VN_API const int32_t *vn_network_tree(const vn_network *network);
/// The step a node was born in.
VN_API const int32_t *vn_network_birth(const vn_network *network);
/// The children of a node: the first, and from each the next; -1 ends.
VN_API int32_t vn_network_first_child(const vn_network *network, int32_t node);
VN_API int32_t vn_network_next_child(const vn_network *network, int32_t child);

/// The radius of the edge between @p node and its parent; at a root, that of its thickest child. 0 where
/// nothing is known of radii: neither vn_network_murray() nor a file gave them.
VN_API double vn_network_radius(const vn_network *network, int32_t node);

/// The nodes so that every parent comes before its children; borrowed until the network next changes. The one
/// order in which everything walks the network. NULL means the order of the indices themselves.
VN_API vn_status vn_network_order(const vn_network *network, const int32_t **order);

/// Orders are those of the forest: joins are nobody's children.
typedef enum vn_order_kind {
    VN_STRAHLER, ///< tips 1; one more where two children of the highest order meet
    VN_HORTON,   ///< Strahler's, each vein keeping its highest order up its length
    VN_HICKEY,   ///< 1 from each root along the thickest child; a lateral has one more than what it leaves
} vn_order_kind;
typedef struct vn_orders_def {
    vn_order_kind kind;
    /// Hickey's: a lateral at least this many times as thick as the thickest child has that one's order, as
    /// primaries have that diverge from one point. Above 0, at most 1; 0 (the default): none has.
    double ratio;
} vn_orders_def;
VN_API vn_orders_def vn_orders_def_default(void);
/// Compute the order of every node's edge; read by vn_network_orders(). Thickness is the radius, or where no
/// radii are known the number of tips above; at equal thickness the lower index leads.
VN_API vn_status vn_network_set_orders(vn_network *network, vn_order_kind kind);
VN_API vn_status vn_network_set_orders_by(vn_network *network, const vn_orders_def *def);
/// The order of a join: the higher of its ends', so that of the thinner. 0 where no orders are known.
VN_API int32_t vn_network_join_order(const vn_network *network, int32_t join);
/// One entry a node, borrowed until the network next changes; NULL where orders were never computed, or
/// are outdated.
VN_API const int32_t *vn_network_orders(const vn_network *network);

/// Say what flows through each node's edge (volume by time; at a root, what enters there) and the pressure at
/// each node; one entry a node, copied. @p pressure may be NULL: unknown. Both hold until the network next
/// changes. What flows through joins is forgotten (vn_network_set_join_flow() comes after). VN_INVALID for
/// numbers that are not finite.
VN_API vn_status vn_network_set_flow(vn_network *network, const double *flow, const double *pressure);
/// One entry a node, borrowed until the network next changes; NULL where unknown or outdated.
VN_API const double *vn_network_flow(const vn_network *network);
VN_API const double *vn_network_pressure(const vn_network *network);

/// What a network measures.
typedef struct vn_network_measures {
    int32_t nodes, roots, tips, bifurcations, joins; ///< a bifurcation is a node with two children or more
    int32_t depth;                                   ///< edges from a root to the farthest tip
    double length;                                   ///< of all edges, joins included
    vn_box extent;                                   ///< of the nodes; all 0 when empty
    double min_radius, max_radius;                   ///< of the edges; 0 where radii are not known
} vn_network_measures;
VN_API vn_status vn_network_measure(const vn_network *network, vn_network_measures *out);

/// Of a list of numbers; all 0 when it is empty. Quartiles are interpolated between neighbours.
typedef struct vn_statistics {
    int32_t count;
    double mean, deviation; ///< of the whole list: divided by count
    double min, lower, median, upper, max;
} vn_statistics;

/// Two loops, or what loops were merged to before, that become one when their common veins are cut.
typedef struct vn_loop_merge {
    int32_t a, b;  ///< areoles (from 0), or `areoles` + the number of an earlier merge
    int32_t loops; ///< how many areoles are merged now
    double radius; ///< of the thickest vein cut so far between them
} vn_loop_merge;

/// Katifori and Magnasco's hierarchical loop decomposition (PLoS ONE 7:e37994, 2012): veins are cut from the
/// thinnest up, and two areoles on either side of a cut become one. Veins to the outside are not cut.
typedef struct vn_loop_hierarchy {
    vn_loop_merge *merges;
    int32_t merge_count; ///< 0 where no radii are known
    int32_t height;      ///< merges on the longest way from the last one down
    int32_t strahler;    ///< Strahler's order of the tree of merges
    /// The mean of |r - s| / (r + s - 2) over the merges of r loops with s, weighted by r + s - 1: 0 where
    /// equals merge, 1 where single loops are added one by one.
    double asymmetry;
    double nesting; ///< the mean of the smaller of r, s by the larger, weighted alike
} vn_loop_hierarchy;

/// Angles in degrees between the three edges at nodes of degree 3, by how thin the thinnest is (Bohn et al.,
/// Phys. Rev. E 65:061914, 2002).
typedef struct vn_branching_angles {
    int32_t count;
    double daughters; ///< mean angle between the two thinner; where equal, the edge to the parent is thickest
    /// Of ratios thinnest / thickest in [k / 5, (k + 1) / 5): how many, and mean angles. Empty without radii.
    struct vn_angle_bin {
        int32_t count;
        double thick_middle, thick_thin, middle_thin;
    } bins[5];
} vn_branching_angles;

/// How far points of the area are from the nearest vein, on a square grid of points.
typedef struct vn_vein_distance {
    double resolution; ///< between points
    int32_t points;    ///< that lie in the area
    double mean, max;
    double mode; ///< the most frequent, among quarter octaves
} vn_vein_distance;

/// What botanists measure in a leaf. Lengths are in the network's unit, densities in lengths by areas.
typedef struct vn_leaf_measures {
    double area;            ///< of the domain that was handed over, or of the nodes' convex hull
    bool hull;              ///< the latter
    double length, density; ///< of veins; by area
    double *order_density;  ///< [k]: of veins of order k + 1: the network's orders, or else Hickey's
    int32_t order_count;
    int32_t tips; ///< free ends but for the roots
    double tip_density;
    int32_t free_ends; ///< tips within areoles: free-ending veinlets
    double free_end_density;
    int32_t degree3, degree4, degree_more; ///< junctions by how many edges meet in them
    int32_t loops;                         ///< edges - nodes + connected parts
    /// Pairs of edges that cross or touch elsewhere than in a node that both have; counted up to a million.
    /// Where there are any, areoles and what follows from them are not to be relied on.
    int32_t crossings;
    int32_t areoles;          ///< regions that veins close in; as many as loops where nothing crosses
    double *areole_areas;     ///< each one's, less islands of veins in it
    double *areole_quotients; ///< each one's isoperimetric quotient 4 π area / perimeter²: 1 for a disk
    vn_statistics areole_area, areole_quotient;
    vn_loop_hierarchy hierarchy;
    vn_branching_angles angles;
    vn_vein_distance distance;
} vn_leaf_measures;

typedef struct vn_leaf_def {
    const vn_domain *domain; ///< the blade, 2D; default NULL: the convex hull of the nodes
    double resolution;       ///< of the map of distances, length; default 0: 40,000 points in the area
} vn_leaf_def;
VN_API vn_leaf_def vn_leaf_def_default(void);
/// Measure a 2D network as a leaf; let it go by vn_leaf_measures_free(). VN_INVALID in 3D, and for
/// coordinates beyond 1e150.
VN_API vn_status vn_network_measure_leaf(const vn_network *network, const vn_leaf_def *def,
                                         vn_leaf_measures *out);
VN_API void vn_leaf_measures_free(vn_leaf_measures *measures);

/// Multiply all coordinates and all known radii by @p factor (> 0).
VN_API vn_status vn_network_scale(vn_network *network, double factor);

#ifdef __cplusplus
}
#endif

#endif
