/// Colours that stand for numbers.
#ifndef VN_DRAW_RAMP_H
#define VN_DRAW_RAMP_H

#include "base/array.h"
#include "draw/color.h"
#include "venule/network.h"

typedef VN_ARRAY(uint32_t) vn_rgb_array;

/// The colours 0xRRGGBB of @p count numbers, from @p ramp's first colour at the least to its last at the
/// greatest, evenly between. @p ramp: two opaque colours or more, between spaces. What is not finite has
/// @p otherwise.
vn_status vn_ramp_colors(vn_rgb_array *out, const double *values, int32_t count, const char *ramp,
                         vn_color otherwise);

/// One number for each node's edge: "order", "tree", "birth" or "pressure", or the logarithm of "radius" or
/// "flow"; NaN at roots. VN_INVALID for another name, or where it is not known.
typedef VN_ARRAY(double) vn_values;
vn_status vn_column_values(vn_values *out, const vn_network *network, const char *name);

#endif
