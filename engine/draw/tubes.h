/// Networks as tubes in a grid of voxels.
#ifndef VN_DRAW_TUBES_H
#define VN_DRAW_TUBES_H

#include "base/array.h"
#include "base/schema.h"
#include "image/volume.h"
#include "venule/voxels.h"

extern const vn_schema vn_voxels_schema;

/// The voxels: cubes, or squares when flat.
typedef struct vn_voxel_grid {
    int dim;
    int32_t size[3];
    double side;
    double origin[3]; ///< the middle of the first
} vn_voxel_grid;

/// An edge; coordinates and the radius in voxels, the middle of voxel i at i.
typedef struct vn_tube {
    double a[3], b[3]; ///< cut where nothing beyond can touch the volume
    double radius;
    double value; ///< what its voxels say
} vn_tube;

typedef VN_ARRAY(vn_tube) vn_tubes;

/// The networks that @p def names; how many.
int32_t vn_voxels_networks(const vn_voxels_def *def, const vn_network *const **networks);

/// Where the voxels are, after what @p def asks for.
vn_status vn_voxel_grid_lay(vn_voxel_grid *grid, const vn_voxels_def *def);

/// The edges and joins that come within @p reach voxels of touching the volume, network by network, joins
/// last; a root without edges is a ball. VN_LIMIT for a value above @p most.
vn_status vn_tubes_gather(vn_tubes *tubes, const vn_voxel_grid *grid, const vn_voxels_def *def, double reach,
                          double most);

/// Narrow the part [*from, *to] of a way that begins at @p a and is @p d long to where it lies in [low, high]
/// along one axis; from > to when it never does.
static inline void vn_narrow(double a, double d, double low, double high, double *from, double *to) {
    if (d == 0) {
        *to = a >= low && a <= high ? *to : -1;
        return;
    }
    double t0 = (low - a) / d, t1 = (high - a) / d;
    double first = t0 < t1 ? t0 : t1, last = t0 < t1 ? t1 : t0;
    *from = first > *from ? first : *from;
    *to = last < *to ? last : *to;
}

#endif
