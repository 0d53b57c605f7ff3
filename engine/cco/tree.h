/// An arterial tree while it grows: the radii of Kerautret et al. 2023, Equations 1 to 7, kept so that what a
/// change somewhere does to the whole tree is found by one way up to the root.
///
/// A vessel is a node with the segment to its parent. Through it flows Q (`flow`); its reduced resistance R
/// (Equation 6) is kept divided by kappa = 8 mu / pi, and so is a length, as is its reduced volume
/// v = l + sum of beta^2 v over its children: the volume of a segment and all below it is pi r^2 v. With
/// h = (Q R)^(1/4) the radii of children are to one another as their h (Equation 4), beta = h / H where
/// H^gamma = sum of h^gamma (Equation 3), and the sum in Equation 6 comes to Q / H^4.
#ifndef VN_CCO_TREE_H
#define VN_CCO_TREE_H

#include "base/array.h"
#include "base/status.h"

#include <math.h>

typedef struct vn_vessel {
    double p[3];
    double length;     ///< of the segment; 0 at a root
    double flow;       ///< volume by time; at a root, what enters there
    double resistance; ///< R / kappa
    double volume;     ///< v
    float cap;         ///< the radius up to which the segment breaks no rule; never below its radius
    float bent;        ///< how far it is from where bounds of darts have it
    float slack;       ///< its radius up to which no segment below, itself included, passes its cap
    int32_t parent, first_child, next_child; ///< -1: none
} vn_vessel;

/// A point of the bifurcation exponent as a function of the flow of the parent segment.
typedef struct vn_exponent {
    double flow, exponent;
} vn_exponent;

typedef struct vn_tree {
    VN_ARRAY(vn_vessel) vessels;
    VN_ARRAY(vn_exponent) exponents; ///< by flow, one or more
    double factor;                   ///< kappa / (P_in - P_out): r^4 = factor Q R for a segment at the root
} vn_tree;

/// What hangs at an end: one branch with all below it.
typedef struct vn_branch {
    double flow, resistance, volume;
} vn_branch;

/// What a changed branch makes of the tree.
typedef struct vn_effect {
    double volume; ///< of the whole tree, less what it was
    double radius; ///< of the branch's own segment
    /// How fast the volume rises with the branch's resistance and volume.
    double by_resistance, by_volume;
} vn_effect;

void vn_tree_free(vn_tree *tree);

/// The bifurcation exponent gamma where so much flows in.
double vn_tree_exponent(const vn_tree *tree, double flow);

/// x^(2/3) to 2e-15: x times its inverse cube root, which needs no division, and starts from a third of the
/// exponent.
static inline double vn_two_thirds(double x) {
    uint64_t bits;
    double y;
    memcpy(&bits, &x, sizeof bits);
    bits = 0x553EF0FF289DD796u - bits / 3;
    memcpy(&y, &bits, sizeof y);
    double h = 1 - x * (y * y) * y, h2 = h * h;
    y += y * h * ((1.0 / 3 + h * (2.0 / 9)) + h2 * ((14.0 / 81) + h * (35.0 / 243) + h2 * (91.0 / 729)));
    h = 1 - x * (y * y) * y;
    y += y * h * (1.0 / 3 + h * (2.0 / 9));
    return x * y;
}

/// h^gamma of a branch, from its Q R; H^2 from the sum of these.
static inline double vn_branch_weight(double exponent, double flow_resistance) {
    double root = sqrt(flow_resistance);
    return exponent == 3 ? root * sqrt(root) : pow(flow_resistance, exponent / 4);
}
static inline double vn_branches_square(double exponent, double sum) {
    if (exponent == 3 && sum > 1e-300 && sum < 1e300) {
        return vn_two_thirds(sum);
    }
    double root = pow(sum, 1 / exponent);
    return root * root;
}

/// All branches below a node as one: flow, the resistance H^4 / Q and the volume sum of beta^2 v. Zero at a
/// terminal. @p except (or -1) is left out, and @p instead (or NULL) counts besides.
typedef struct vn_fork {
    double flow, sum, square; ///< of all branches; the sum of h^gamma; H^2
    double resistance, volume;
} vn_fork;
vn_fork vn_tree_fork(const vn_tree *tree, int32_t node, int32_t except, const vn_branch *instead);

static inline bool vn_is_stem(const vn_tree *tree, int32_t node) {
    return tree->vessels.data[tree->vessels.data[node].parent].parent < 0;
}

/// The effect of @p branch hanging where the segment of @p node hangs now (its upper end stays).
vn_effect vn_tree_effect(const vn_tree *tree, int32_t node, const vn_branch *branch);

/// How fast the volume of the whole tree rises with resistance, volume and flow of a node's branch as it is.
typedef struct vn_adjoint {
    int32_t node;
    uint32_t round; ///< in which this was worked out
    double by_resistance, by_volume, by_flow;
} vn_adjoint;

/// What was asked for since the tree last changed: candidates near one another share most of their ways up.
typedef struct vn_adjoints {
    VN_ARRAY(vn_adjoint) known; ///< hashed by node; a newer one takes the place of an older one
    uint32_t round;
} vn_adjoints;
void vn_adjoints_free(vn_adjoints *adjoints);
/// Forget everything: the tree has changed.
vn_status vn_adjoints_begin(vn_adjoints *adjoints);

/// Nearly vn_tree_effect(), in time that does not depend on the depth: once the flow is @p ratio times the
/// flow that is added, what happens further up is taken as linear. The radius is left out.
vn_effect vn_tree_estimate(const vn_tree *tree, vn_adjoints *adjoints, int32_t node, const vn_branch *branch,
                           double ratio);

/// Volume of the whole tree: the sum of pi r^2 l.
double vn_tree_volume(const vn_tree *tree);
/// Radius of a node's segment, by way of the root. At a root, that of its thickest segment.
double vn_tree_radius(const vn_tree *tree, int32_t node);
/// The ratio of a node's radius to its parent segment's; @p fork is its parent's.
double vn_tree_beta(const vn_tree *tree, int32_t node, const vn_fork *fork);

/// Add a node; what hangs together is told by vn_tree_update().
vn_status vn_tree_push(vn_tree *tree, int32_t parent, const double p[3], int32_t *node);
/// Put a new node at @p p into the segment of @p node; it becomes the parent.
vn_status vn_tree_split(vn_tree *tree, int32_t node, const double p[3], int32_t *middle);
/// Bring flow, resistance and volume of one node up to date with its children.
void vn_tree_refresh(vn_tree *tree, int32_t node);
/// The same from @p node up to its root. The flow of a terminal stays.
void vn_tree_update(vn_tree *tree, int32_t node);
/// Bring slack of one node up to date with its cap and its children.
void vn_tree_settle_one(vn_tree *tree, int32_t node);
/// The same from @p node up to its root.
void vn_tree_settle(vn_tree *tree, int32_t node);

#endif
