/// Growth from inside.
#ifndef VN_GROWTH_GROWTH_H
#define VN_GROWTH_GROWTH_H

#include "domain/domain.h"
#include "venule/growth.h"

extern const vn_schema vn_none_schema;
extern const vn_schema vn_marginal_schema;

/// Today's shape is the grown one, scaled about the origin by length / (the grown shape's own length).
struct vn_growth {
    vn_domain base;
    vn_domain *shape; ///< as it was given
    double origin[3];
    double own_length; ///< of `shape` in its own coordinates
    double length, to, step, from;
    int32_t time;
};

vn_status vn_growth_make(vn_growth **out, const vn_domain_kind *kind, const vn_growth_def *def);

/// A point of today's blade in the coordinates of `shape`, at the given length.
void vn_growth_to_shape(const vn_growth *growth, double length, const double p[3], double q[3]);
/// Make bounds and measure those of today's length.
void vn_growth_resize(vn_growth *growth, double length);
void vn_growth_destroy(vn_domain *domain);

#endif
