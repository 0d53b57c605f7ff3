/// Murray's law at a single node: the radii of the edges on either side of it.
#ifndef VN_NETWORK_SIDES_H
#define VN_NETWORK_SIDES_H

#include "base/array.h"

/// Radii of what leads to a node and of what leads away, all above 0 on the parent's side. The parent's side
/// is that of the one edge, or else what leads here.
typedef struct vn_sides {
    VN_ARRAY(double) in;
    VN_ARRAY(double) out;
} vn_sides;
void vn_sides_free(vn_sides *sides);

/// Whether three edges or more meet, with some on either side.
bool vn_sides_meet(const vn_sides *sides);

/// |Σ r^exponent of the parent's side - that of the other| / the former, where they meet.
double vn_sides_residual(const vn_sides *sides, double exponent);

/// The exponent that makes it 0; false where there are several on either side, or one of several is as thick
/// as the one across: there is none then.
bool vn_sides_fit(const vn_sides *sides, double *exponent);

#endif
