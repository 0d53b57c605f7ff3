/// @file growth.h
/// A domain that changes with time. A growth is itself a domain (today's) and is accepted wherever one is.
#ifndef VENULE_GROWTH_H
#define VENULE_GROWTH_H

#include "venule/domain.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vn_growth vn_growth;

typedef struct vn_growth_def {
    vn_domain *domain; ///< the grown shape; held, not taken over
    double origin[3];  ///< the petiole, which stays where it is; used when `has_origin`
    bool has_origin;   ///< false: the lowest point of the outline, or the middle of a flat base
    double from;       ///< length at first, > 0; 0: a twentieth of `to`
    double to;         ///< length when grown, at least `from`; 0: the domain's own length, its extent along y
    double step;       ///< length added by each vn_growth_advance(), > 0; 0: a hundredth of to - from
} vn_growth_def;
VN_API vn_growth_def vn_growth_def_default(void);

/// A domain that stays as it is.
VN_API vn_status vn_growth_none(vn_growth **out, const vn_growth_def *def);
/// Marginal growth (Runions §3.3, READINGS R2): only the margin moves, from a blade of length `from` to one
/// of `to`, both scaled about the origin. What lies inside stays where it is. Attractors thrown into it are
/// thrown over the largest shape at once, and released when the margin has passed them. VN_INVALID when the
/// outline is not star-shaped about the origin: its growth would erode the blade. Its unit is the domain's,
/// unless `to` gives it another length: then it has none.
VN_API vn_status vn_growth_marginal(vn_growth **out, const vn_growth_def *def);
VN_API void vn_growth_release(vn_growth *growth);

/// Grow by one step. False when it was grown already, and nothing changed.
VN_API bool vn_growth_advance(vn_growth *growth);
/// Today's shape as a domain; borrowed, and changing with the growth.
VN_API vn_domain *vn_growth_domain(vn_growth *growth);
/// Steps taken.
VN_API int32_t vn_growth_time(const vn_growth *growth);
/// Today's length, and that of the grown shape.
VN_API double vn_growth_length(const vn_growth *growth);
VN_API double vn_growth_final_length(const vn_growth *growth);
/// The petiole, which stays where it is.
VN_API void vn_growth_origin(const vn_growth *growth, double p[3]);
/// Today's unit length in the simulation's coordinates (READINGS R7): 1 under none and marginal growth.
VN_API double vn_growth_unit(const vn_growth *growth);

#ifdef __cplusplus
}
#endif

#endif
