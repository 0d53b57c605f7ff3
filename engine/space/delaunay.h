/// The Delaunay triangulation of a growing set of points, and whose neighbour another point would be in it.
#ifndef VN_SPACE_DELAUNAY_H
#define VN_SPACE_DELAUNAY_H

#include "space/points.h"

typedef struct vn_delaunay vn_delaunay;
typedef VN_ARRAY(int32_t) vn_indices;

/// An empty triangulation in 2 or 3 dimensions.
vn_status vn_delaunay_create(vn_delaunay **out, int dim);
void vn_delaunay_destroy(vn_delaunay *delaunay);
int32_t vn_delaunay_count(const vn_delaunay *delaunay);

/// Insert the points up to @p count that are not yet in it. @p near says, for each point, an earlier one that
/// is probably close (a network's parents), or a negative number; it only makes the insertion faster. After a
/// failure the triangulation is of no more use.
vn_status vn_delaunay_update(vn_delaunay *delaunay, const vn_points *points, const int32_t *near,
                             int32_t count);

/// The points that would be neighbours of @p p were it inserted, in no special order: the corners of its
/// conflict hole. When @p p is on a point, those there (and no others) are its neighbours. @p near is a
/// point close to @p p, or negative. @p circumradius gets an upper bound of the distance from @p p to the
/// corners of its Voronoi cell; INFINITY when the cell is unbounded.
vn_status vn_delaunay_neighbors(vn_delaunay *delaunay, const double p[3], int32_t near, vn_indices *neighbors,
                                double *circumradius);

/// Which of @p a and @p b is nearer to @p p: negative a, positive b, 0 neither. Exact.
int vn_compare_distances(const double p[3], const double a[3], const double b[3]);

#endif
