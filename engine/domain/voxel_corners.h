/// The corners of voxels, and which corner on the border of a mask is nearest to each: an exact distance
/// transform. Nothing of the border is nearer to a corner than that, for where two corners bound a face, its
/// nearest point is a corner too.
#ifndef VN_DOMAIN_VOXEL_CORNERS_H
#define VN_DOMAIN_VOXEL_CORNERS_H

#include "domain/voxel_bits.h"

/// Corner (i, j, k) of the grid is number i + size[0] (j + size[1] k); a flat one has size[2] 1. A zeroed one
/// is empty and owns nothing.
typedef struct vn_voxel_corners {
    int32_t size[3];
    size_t count;
    uint32_t *nearest; ///< the number of the border's nearest corner
} vn_voxel_corners;

/// Axis a is scaled by @p scale[a]. Something must be set. VN_LIMIT beyond 2^32 - 2 corners.
vn_status vn_voxel_corners_build(vn_voxel_corners *corners, const vn_voxel_bits *bits, bool flat,
                                 const double scale[3]);
void vn_voxel_corners_free(vn_voxel_corners *corners);

/// What the eight corners of a voxel know (of a flat one four, each twice).
typedef struct vn_voxel_ring {
    int32_t base[3], step[3]; ///< the least corner, and from there to the others
    double share[3][2];       ///< how near the point is to the corners, along each axis
    double away[3][2];        ///< from the corners to the point, scaled
    double diagonal2;         ///< of a voxel
    double slack[8];  ///< of corner x + 2 y + 4 z: the square of its distance to the border, less that to the
                      ///< point
    uint32_t nearest; ///< of the corner that was asked last
    int32_t to[3];    ///< where that is
    double best;      ///< the least square distance from the point to what these are nearest to
    int32_t at[3];    ///< where that is
} vn_voxel_ring;

/// Ask the corners of the voxel of the point @p u, which is within the grid.
void vn_voxel_corners_ask(const vn_voxel_corners *corners, const double u[3], const double scale[3],
                          vn_voxel_ring *ring);
/// The box outside of which nothing of the border is within the square distance @p best of @p u, for all that
/// its voxel's corners know. @p best is at most the ring's.
void vn_voxel_corners_bound(const vn_voxel_corners *corners, const vn_voxel_ring *ring, const double u[3],
                            const double scale[3], double best, double low[3], double high[3]);

#endif
