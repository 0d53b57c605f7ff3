/// Solids and surfaces drawn out along the axes.
#ifndef VN_DOMAIN_STRETCH_H
#define VN_DOMAIN_STRETCH_H

#include "domain/domain.h"

/// What is at origin + d comes to origin + factor · d, along each axis.
struct vn_stretch {
    double origin[3];
    double factor[3]; ///< > 0
};

void vn_stretch_point(const vn_stretch *stretch, const double p[3], double q[3]);
void vn_stretch_point_back(const vn_stretch *stretch, const double q[3], double p[3]);
/// The domain's triangles where they come to, into an empty @p out that is to be freed in any case.
vn_status vn_stretch_triangles(const vn_domain *domain, const vn_stretch *stretch, vn_triangles *out);

/// A domain of 3 dimensions, stretched. Boxes and meshes become boxes and meshes, exact in all they answer.
/// Of others, contains() and sees() are exact, and so are samples, bounds and measure; closest() gives a
/// point of the border that is near, and distance() is the original's times the least factor: never more than
/// the true distance, and not less than that times the least over the greatest factor.
vn_status vn_domain_stretch(vn_domain **out, const vn_domain *domain, const vn_stretch *stretch);

#endif
