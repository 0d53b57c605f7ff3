/// Where outlines cross or touch themselves and each other.
#ifndef VN_DOMAIN_CROSSING_H
#define VN_DOMAIN_CROSSING_H

#include "domain/rings.h"

/// Edges of @p ring and @p other (which may be the same) share the point @p at. Return false to stop.
typedef bool vn_crossing_fn(int32_t ring, int32_t other, const double at[2], void *payload);

/// Visit each pair of edges that share a point and are not neighbours, and each pair of neighbours that fold
/// back onto each other. The order depends on nothing but @p rings.
vn_status vn_rings_visit_crossings(const vn_rings *rings, vn_crossing_fn *visit, void *payload);

#endif
