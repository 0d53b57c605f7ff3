/// Voxels as a domain.
#ifndef VN_DOMAIN_VOXELS_H
#define VN_DOMAIN_VOXELS_H

#include "domain/voxel_parts.h"
#include "image/volume.h"

/// What of a volume is inside, and how it is spoken of.
typedef struct vn_mask {
    int dim;          ///< 2: a flat image, in the plane of x and y
    double threshold; ///< inside is what is this or above
    double scale;     ///< voxels are divided by this before they are compared
    bool invert;      ///< inside is what is below
    vn_parts parts;
    const char *what; ///< begins messages: its path
} vn_mask;

/// The boxes of a volume's voxels that are inside. NaN is never inside. @p volume is taken over (left empty,
/// also on failure). VN_INVALID for axes that are not at right angles (to within 0.001), for an empty mask
/// and for parts that do not hang together.
vn_status vn_domain_voxels(vn_domain **out, vn_volume *volume, const vn_mask *mask);

#endif
