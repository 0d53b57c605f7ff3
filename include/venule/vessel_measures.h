/// @file vessel_measures.h
/// What anatomists measure in vessels: Murray's law at junctions, angles, orders, tortuosity, the
/// box-counting dimension, and how far tissue is from a vessel. For networks in 2D and 3D.
#ifndef VENULE_VESSEL_MEASURES_H
#define VENULE_VESSEL_MEASURES_H

#include "venule/flow.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum vn_vessel_orders {
    VN_ORDERS_STRAHLER, ///< tips 1; one more where two of the highest order meet
    VN_ORDERS_DIAMETER, ///< one more where a vessel is too thick for the order of its daughters, after Jiang,
                        ///< Kassab & Fung 1994; see vn_network_measure_vessels()
} vn_vessel_orders;

typedef struct vn_vessel_measures_def {
    double exponent; ///< of Murray's law; > 0, at most 100; default 0: the law's in force, 3 where none is
    int orders;      ///< a vn_vessel_orders; default VN_ORDERS_STRAHLER
    int32_t bins;    ///< of the daughters' ratio r2 / r1 from 0 to 1; 1 to 1000, default 10
} vn_vessel_measures_def;
VN_API vn_vessel_measures_def vn_vessel_measures_def_default(void);

/// Angles at a bifurcation, in degrees: between the two daughters, and of the thick and of the thin one to
/// the parent's direction.
typedef struct vn_fork_angles {
    double between, thick, thin;
} vn_fork_angles;

/// Murray's optimal angles (Rauch & Harders 2021, Equation 1) of daughters of radii 1 and @p ratio (> 0, at
/// most 1) of a parent of radius (1 + ratio^exponent)^(1/exponent). 0 for exponents up to 2.
VN_API vn_fork_angles vn_murray_angles(double ratio, double exponent);

/// Bifurcations with a ratio r2 / r1 in [k / bins, (k + 1) / bins); the last bin has 1 too.
typedef struct vn_fork_bin {
    int32_t count;
    double ratio;                   ///< mean
    vn_spread between, thick, thin; ///< degrees
    vn_fork_angles theory;          ///< vn_murray_angles() at the mean ratio
} vn_fork_bin;

/// Segments run from a root or a fork to the next fork or tip; elements are segments of one order in series.
/// Where several daughters have their parent's order, the thickest goes on with its element (of equals the
/// one of the lowest index).
typedef struct vn_vessel_order {
    int32_t segments, elements;
    /// A segment or element has the mean diameter of its edges by their lengths; 0 where radii are not known.
    vn_spread segment_diameter, segment_length, element_diameter, element_length;
} vn_vessel_order;

/// By which factor something changes from order to order: exp |slope| of the line through its logarithms.
typedef struct vn_order_ratio {
    double ratio; ///< 0 where there are fewer than two orders
    double r2;    ///< coefficient of determination
} vn_order_ratio;

/// Segments, elements and forks are those of the forest: joins are nobody's children.
typedef struct vn_vessel_measures {
    double exponent; ///< that Murray's law was asked with
    /// |Σ r^exponent of what leads to a node - that of what leads away| / that of the parent's side, where
    /// three edges or more meet; joins count as edges. The parent's side is that of a single edge, or else
    /// what leads here. Edges without a radius are left out.
    vn_statistics murray;
    double murray_rms;
    int32_t murray_worst; ///< the node of the largest; the first of them, -1 where there is none
    vn_statistics fitted; ///< the exponents that make it 0, where one edge meets thinner ones

    /// Bifurcations: nodes with a parent and two children. Directions are those of the edges that meet in
    /// them; where one of these has no length, angles are left out.
    int32_t bifurcations, furcations; ///< the latter: with three children or more, which nothing here counts
    vn_statistics ratio;              ///< r2 / r1 of the daughters, at most 1
    vn_statistics expansion;          ///< (r1² + r2²) / r0²
    vn_statistics between, thick, thin; ///< degrees; without radii only `between`
    vn_fork_bin *bins;
    int32_t bin_count; ///< 0 where no radii are known

    vn_vessel_order *orders; ///< [k]: order k + 1
    int32_t order_count;
    int32_t segments, elements;
    /// Of elements: by how much there are fewer, they are thicker and they are longer, an order up.
    vn_order_ratio bifurcation_ratio, diameter_ratio, length_ratio;

    /// Arc by chord; what comes back to where it began is left out.
    vn_statistics segment_tortuosity, element_tortuosity;
    /// The mean squared curvature along it, radians²/length²: Σ θ² / ℓ over the turns θ between two edges, ℓ
    /// half the length of both, by the length of all. (The sum of squared turns by length, as Owen et al.
    /// 2008 write, depends on how finely a curve is drawn; this does not.) What has no length is left out.
    vn_statistics segment_curvature, element_curvature;
} vn_vessel_measures;

/// Measure a network; let it go by vn_vessel_measures_free(). Orders by diameter begin with Strahler's. Then,
/// until no order's mean diameter changes by more than a hundredth (a hundred times at most), the limit above
/// an order is the mean of its own mean diameter + deviation and of the next one's mean - deviation (and no
/// less than the limit below); tips have order 1, and other segments the highest of their daughters' orders,
/// or the next one where they are thicker than its limit. VN_INVALID for these without radii,
/// and for coordinates beyond 1e150.
VN_API vn_status vn_network_measure_vessels(const vn_network *network, const vn_vessel_measures_def *def,
                                            vn_vessel_measures *out);
VN_API void vn_vessel_measures_free(vn_vessel_measures *measures);

/// The protocol: boxes have the sides extent / 2^k, where `extent` is the longest side of the nodes' bounds.
/// A box counts when an edge passes it, exactly (places are rounded to 1/32768 of the smallest box; a box has
/// its lower faces and not its upper ones). Of several grids, each shifted by a part of the largest box in
/// every direction (Halton's points in the bases 3, 5 and 7), the least count holds, for each size by itself.
/// The dimension is the slope of the least-squares line through ln count over ln 1 / side. By the default
/// range, in whatever direction they lie, straight lines have 1 to 1.05, filled squares 1.85 to 2.03, Koch's
/// curve (1.262) 1.27 to 1.33 and Sierpinski's triangle (1.585) 1.58 to 1.64. (Means over the grids are no
/// nearer: they miss as much the other way.)
typedef struct vn_boxes_def {
    int32_t coarsest; ///< k of the largest boxes; 0 to 14, default 2
    int32_t finest;   ///< k of the smallest boxes; above `coarsest`, at most 15, and in 3D 10; default 8
    int32_t offsets;  ///< grids; 1 to 1000, default 16
} vn_boxes_def;
VN_API vn_boxes_def vn_boxes_def_default(void);

enum { VN_MOST_BOX_SIZES = 16 };
typedef struct vn_boxes {
    double extent;
    double dimension;               ///< 0 for a network without extent
    double r2;                      ///< of the line; 1 where all counts are equal
    int32_t sizes;                  ///< how many
    double side[VN_MOST_BOX_SIZES]; ///< from the largest
    int64_t count[VN_MOST_BOX_SIZES];
} vn_boxes;
/// VN_INVALID for an empty network, for coordinates beyond 1e150, and for `finest` out of range.
VN_API vn_status vn_network_measure_boxes(const vn_network *network, const vn_boxes_def *def, vn_boxes *out);

typedef enum vn_vessel_part {
    VN_FROM_SURFACE, ///< of the nearest vessel: 0 inside it; where no radii are known, the center line
    VN_FROM_CENTERLINE,
} vn_vessel_part;

typedef struct vn_tissue_def {
    const vn_domain *domain; ///< the tissue, of the network's dimension; required
    int from;                ///< a vn_vessel_part; default VN_FROM_SURFACE
    double reach;            ///< what is at most this far is perfused; > 0; default 0: not asked
    double resolution; ///< between points, length; default 0: 40,000 points in an area, 262,144 in a volume
    int32_t bins;      ///< of the histogram, from 0 to the largest distance; 1 to 10,000, default 20
} vn_tissue_def;
VN_API vn_tissue_def vn_tissue_def_default(void);

/// How far tissue is from the nearest vessel. Points are the middles of a square or cubic grid that are
/// inside; on surfaces, points at random (always the same ones), evenly by area, and distances are straight
/// ones.
typedef struct vn_tissue {
    double resolution;
    int32_t points;
    vn_statistics distance;
    double furthest[3]; ///< where distance.max is; no point nearby, as far as the resolution goes, is much
                        ///< farther: distances differ by no more than the points are apart
    double mode;        ///< the most frequent distance, among quarter octaves
    double lumen;       ///< the share of points inside vessels; 0 from the center line
    double perfused;    ///< the share of points within `reach`; 0 where that was not asked
    double bin;         ///< width of a bin
    int32_t *histogram; ///< points by distance
    int32_t bins;
} vn_tissue;
/// VN_INVALID for an empty network, for coordinates beyond 1e150, for dimensions that differ, and for a
/// resolution that makes more than 1e8 points or none.
VN_API vn_status vn_network_measure_tissue(const vn_network *network, const vn_tissue_def *def,
                                           vn_tissue *out);
VN_API void vn_tissue_free(vn_tissue *tissue);

#ifdef __cplusplus
}
#endif

#endif
