/// @file domain.h
/// Where something may grow. A domain answers whether a point is inside, how far its border is, and gives
/// uniform samples; domains combine by difference, union and intersection.
#ifndef VENULE_DOMAIN_H
#define VENULE_DOMAIN_H

#include "venule/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Shared: many may hold one. Only a growth changes. Points are double[3] throughout; a 2D domain ignores
/// the third.
typedef struct vn_domain vn_domain;

/// An axis-parallel box. In 2D the third components are 0.
typedef struct vn_box {
    double min[3];
    double max[3];
} vn_box;

/// Hold the domain once more; returns it.
VN_API vn_domain *vn_domain_retain(const vn_domain *domain);
/// Let it go; the last one to do so destroys it. NULL is accepted.
VN_API void vn_domain_release(vn_domain *domain);

typedef struct vn_disk_def {
    double center[3]; ///< default the origin
    double radius;    ///< > 0; default 1
} vn_disk_def;
VN_API vn_disk_def vn_disk_def_default(void);
/// A disk in 2D. VN_INVALID for a radius of 0 or less.
VN_API vn_status vn_domain_disk(vn_domain **out, const vn_disk_def *def);
/// A ball in 3D, of the same definition.
VN_API vn_status vn_domain_sphere(vn_domain **out, const vn_disk_def *def);

typedef struct vn_box_def {
    double min[3]; ///< default {0, 0}
    double max[3]; ///< default {1, 1}; above min in every direction
    int32_t dim;   ///< 2 or 3; default 2
} vn_box_def;
VN_API vn_box_def vn_box_def_default(void);
VN_API vn_status vn_domain_box(vn_domain **out, const vn_box_def *def);

/// A polygon with holes. @p xy holds the rings one after another as x, y, x, y, …; ring i has @p
/// ring_sizes[i] points (3 or more, the first not repeated at the end). Orientation is free: a ring inside an
/// odd number of others is a hole. VN_INVALID for a ring that crosses itself or another (the message says
/// where), has no area or is not finite.
VN_API vn_status vn_domain_polygon(vn_domain **out, const double *xy, const int32_t *ring_sizes,
                                   int32_t rings);

typedef struct vn_profile_def {
    double length;            ///< from base (0, 0) to tip (0, length); > 0; default 1
    const double *half_width; ///< its half width at equal steps from base to tip, each 0 or more; borrowed
    int32_t samples;          ///< how many, 3 or more; default 200
} vn_profile_def;
VN_API vn_profile_def vn_profile_def_default(void);
/// A leaf blade that mirrors in its midrib, the y axis.
VN_API vn_status vn_domain_profile(vn_domain **out, const vn_profile_def *def);

/// The surface of a triangle mesh, in 3D. @p xyz holds its vertices as x, y, z, x, y, z, …, @p triangles
/// three vertices for each triangle, in any orientation; both are copied. Vertices at exactly the same place
/// count as one. Edges that one triangle has for itself are its border; a closed surface has none.
///
/// The surface is as thick as 1e-6 of the diagonal of its bounds to either side: what is in there is inside.
/// vn_domain_measure() is its area, and darts are spread evenly over that. On the surface,
/// vn_domain_closest() and vn_domain_distance() ask for the border (infinitely far, where there is none);
/// beside it, for the surface. vn_domain_sees() follows the section of the surface by the plane through the
/// line and the surface's mean normal at its ends, which must lead from the one to the other, across no
/// border, and be at most a fifth longer than the line; the line may rise from the surface by 60°, and the
/// surface turn by 90° from one end to the other. So the sheets of a fold do not see each other, however near
/// they are. There is no flat outline, and no combination.
///
/// All distances are straight ones in space. That is right where the surface does not come back to itself
/// within the distances that matter: the attraction, kill and birth distances should be below the distance of
/// the folds and below the radius of curvature. Where an attraction distance is not, sight keeps veins from
/// jumping, but sources beyond a fold still turn them.
///
/// VN_INVALID for an empty mesh, a vertex beyond ±1e60 or not finite, a corner out of range, a triangle
/// without area; the message numbers them from 0.
VN_API vn_status vn_domain_surface(vn_domain **out, const double *xyz, int32_t vertices,
                                   const int32_t *triangles, int32_t count);

/// What a closed triangle mesh encloses, in 3D; the mesh is given as to vn_domain_surface(). A point is
/// inside when an odd number of its shells are around it: so a shell inside another one bounds a cavity, one
/// inside that is solid again, and separate parts are all inside. Which way the triangles turn does not
/// matter.
///
/// All answers are exact but for the rounding of a distance, and contains() even without that: also where a
/// point is on a line with edges or vertices of the mesh. vn_domain_sees() is false for lines that touch the
/// border; those along a flat part of it, from end to end, are free. vn_domain_measure() is the volume. Parts
/// may touch in vertices and edges they have in common.
///
/// VN_INVALID as for vn_domain_surface(), and for a mesh that is not closed (an edge with a triangle on one
/// side only, or with 3, 5, … of them), that encloses no volume, or, if @p check is true, where two triangles
/// meet elsewhere than in a common corner or edge. Without that check, what lies in two parts that overlap is
/// outside, by the same rule, and the measure is an estimate.
VN_API vn_status vn_domain_inside(vn_domain **out, const double *xyz, int32_t vertices,
                                  const int32_t *triangles, int32_t count, bool check);

typedef enum vn_combination { VN_DIFFERENCE, VN_UNION, VN_INTERSECTION } vn_combination;
/// a − b, a + b or a · b. Of two flat domains with polygonal borders the result is a polygon, exact in every
/// answer. Of others, contains() is exact, and distance() is exact inside − and ·, and outside +; elsewhere
/// it is never more than the true distance. Of a growing operand, it is always today's shape. VN_INVALID when
/// the dimensions differ; VN_INFEASIBLE when nothing is left.
VN_API vn_status vn_domain_combine(vn_domain **out, const vn_domain *a, const vn_domain *b,
                                   vn_combination how);

typedef struct vn_shell_def {
    vn_domain *domain; ///< held, not taken over; required
    double thickness;  ///< > 0; required
} vn_shell_def;
VN_API vn_shell_def vn_shell_def_default(void);
/// What of a domain is at most `thickness` from its border; a wall thinner than that is whole. Flat or solid;
/// of a growing domain, always of today's shape. contains() is exact, and so is distance() outside the shell,
/// on either side of it. In the shell it is the lesser of the distances to the outer and to the inner border,
/// where the latter, `thickness` less the former, is never more than the true distance: it is exact unless
/// the way inwards ends before, at an edge that points outwards or in the middle of a thin wall. In 3D it is
/// measured to some 1e-4 of its bounds. VN_INVALID for a surface; VN_INFEASIBLE when it is too thin to be
/// measured.
VN_API vn_status vn_domain_shell(vn_domain **out, const vn_shell_def *def);

/// 2 or 3.
VN_API int vn_domain_dim(const vn_domain *domain);
/// The length unit of its coordinates as its file gave it ("mm"), or "".
VN_API const char *vn_domain_unit(const vn_domain *domain);
VN_API vn_box vn_domain_bounds(const vn_domain *domain);
/// Its area (2D, and surfaces) or volume (3D). Combinations and shells of solids are measured to some 1e-4 of
/// the volume of their bounds.
VN_API double vn_domain_measure(const vn_domain *domain);
/// Of what the measure is: 2 for an area (also of a surface in space), 3 for a volume.
VN_API int vn_domain_measure_dim(const vn_domain *domain);
/// Whether @p p is inside. Points on the border itself may be either, but always the same.
VN_API bool vn_domain_contains(const vn_domain *domain, const double p[3]);
/// The distance to the border: positive inside, negative outside.
VN_API double vn_domain_distance(const vn_domain *domain, const double p[3]);
/// The point @p q of the border that is nearest to @p p.
VN_API void vn_domain_closest(const vn_domain *domain, const double p[3], double q[3]);
/// Whether the straight line from @p a to @p b stays inside from end to end. An end on the border (within
/// 1e-6 of the size of the bounds) counts as inside: veins start at a petiole.
VN_API bool vn_domain_sees(const vn_domain *domain, const double a[3], const double b[3]);
/// The domain's value at @p p, in [0, 1]: 1 inside and 0 outside where it has no values of its own.
VN_API double vn_domain_value(const vn_domain *domain, const double p[3]);

/// A uniformly distributed point inside, into @p p. VN_INFEASIBLE when a million darts into its bounds
/// all miss.
VN_API vn_status vn_domain_dart(const vn_domain *domain, vn_rng *rng, double p[3]);

#ifdef __cplusplus
}
#endif

#endif
