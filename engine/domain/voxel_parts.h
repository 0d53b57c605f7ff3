/// Which voxels of a mask hang together, and what their border is.
#ifndef VN_DOMAIN_VOXEL_PARTS_H
#define VN_DOMAIN_VOXEL_PARTS_H

#include "domain/rings.h"
#include "domain/voxel_bits.h"

typedef enum vn_parts { VN_PARTS_ONE, VN_PARTS_LARGEST, VN_PARTS_ALL } vn_parts;

/// Find the parts that hang together by faces of voxels (sides of pixels).
/// With VN_PARTS_LARGEST all but the largest are cleared (of equal ones, the first stays), with VN_PARTS_ONE
/// too, where the others are a thousandth of it or less in all; more is VN_INVALID. VN_INVALID too where
/// there is no foreground. @p what begins messages.
vn_status vn_voxel_parts(vn_voxel_bits *bits, vn_parts parts, const char *what);

/// Push the outlines of a flat mask's foreground, where corner (i, j) of the pixels is at
/// origin + i step[0] + j step[1]: outer ones counter-clockwise, holes clockwise. Pixels that touch at a
/// corner only stay apart there.
vn_status vn_voxel_outline(const vn_voxel_bits *bits, const double origin[2], double step[2][2],
                           vn_rings *out);

#endif
