/// Where a new segment best leaves an old one: the bifurcation point (Kerautret et al. 2023, section 3.2).
#ifndef VN_CCO_BIFURCATION_H
#define VN_CCO_BIFURCATION_H

#include "cco/tree.h"

/// The problem in the plane of its three points: the proximal end x0 of the old segment is the origin, its
/// distal end x1 = (distal, 0), and x2 = (across[0], across[1]) the new terminal, across[1] > 0.
typedef struct vn_triangle {
    double distal, across[2];
    double axes[2][3]; ///< the plane's directions in space
    double origin[3];
    double flow1, flow2;    ///< through the distal part and into the terminal
    double rest_resistance; ///< of what hangs at the distal end, R / kappa
    double rest_volume;
    double exponent; ///< of the new bifurcation
} vn_triangle;

/// False when the three points lie on one line: then there is no plane, and no inner bifurcation point.
bool vn_triangle_make(vn_triangle *t, const double proximal[3], const double distal[3],
                      const double terminal[3]);
void vn_triangle_point(const vn_triangle *t, const double x[2], double p[3]);
/// Distances from @p x to the three points.
void vn_triangle_lengths(const vn_triangle *t, const double x[2], double lengths[3]);

/// The two branches that part in @p x, and the one that both hang from.
void vn_triangle_branches(const vn_triangle *t, const double x[2], vn_branch branches[3]);

/// Move @p x to where by_resistance R + by_volume v of the branch is least: for weights from
/// vn_tree_effect() that is the least volume of the tree, to first order in what the change does farther up.
/// @p tolerance is in parts of the size. False when it runs into one of the points, which then absorbs it.
bool vn_triangle_minimum(const vn_triangle *t, double by_resistance, double by_volume, double tolerance,
                         double x[2]);

/// The whole: the point of least tree volume. @p node is the distal end of the old segment. Each round finds
/// the minimum for the weights at the last point, until it moves less than @p tolerance of the size, or
/// @p rounds are done. @p x is where to start and what was found; @p effect is that at the point. With
/// @p adjoints (NULL: exactly) what happens far up the tree is estimated.
bool vn_bifurcation_least(const vn_tree *tree, vn_adjoints *adjoints, int32_t node, const vn_triangle *t,
                          double tolerance, int rounds, double x[2], vn_effect *effect);

/// The same, exactly, from a point whose vn_tree_effect() is known: @p effect.
bool vn_bifurcation_refine(const vn_tree *tree, int32_t node, const vn_triangle *t, double tolerance,
                           int rounds, double x[2], vn_effect *effect);

/// Equations 8 to 13 of the paper, after Kamiya and Togawa: rounds of radii from the whole tree, pressure
/// drops (9), the system (12), the weighted mean (13); until the tree's volume stands still to @p tolerance,
/// relative, or @p rounds are done. Its point is not quite that of least volume (READINGS R13). @p solve
/// finds the radii of (12).
typedef bool vn_kamiya_fn(const double flow[3], const double length[3], const double drop[2],
                          double radius[3]);
bool vn_bifurcation_kamiya(const vn_tree *tree, int32_t node, const vn_triangle *t, vn_kamiya_fn *solve,
                           double tolerance, int rounds, double x[2], vn_effect *effect);

/// Solve (11) and (12) for the radii: with y = f0 l0 / r0^4 they become one monotone equation in y, which has
/// exactly one root between 0 and the smaller drop (READINGS R13). False for drops that are not above 0.
vn_kamiya_fn vn_kamiya_radii;
/// The same by the tiny solver of Ceres, as the paper does it.
vn_kamiya_fn vn_ceres_radii;

#endif
