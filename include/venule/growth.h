/// @file growth.h
/// A domain that changes with time. A growth is itself a domain (today's) and is accepted wherever one is.
///
/// Time counts steps. Under none, marginal and isogonic growth the tissue keeps its coordinates. Under
/// uniform, RERG and morph growth it moves: what lies in it is moved along by vn_growth_carry() and
/// vn_attractors_carry(), and today's shape is a polygon made of the moved outline. None, isogonic and
/// uniform growth work in 3D, of solids and of surfaces; the others are of the plane.
#ifndef VENULE_GROWTH_H
#define VENULE_GROWTH_H

#include "venule/domain.h"
#include "venule/network.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vn_growth vn_growth;

typedef struct vn_growth_def {
    vn_domain *domain; ///< the grown shape; held, not taken over
    double origin[3];  ///< the petiole, which stays where it is; used when `has_origin`
    bool has_origin;   ///< false: the lowest point of the outline, or the middle of a flat base; in 3D the
                       ///< middle of its bounds where y is least
    double from;       ///< length at first, > 0; 0: a twentieth of `to`
    double to;         ///< length when grown, at least `from`; 0: the domain's own length, its extent along y
    double step;       ///< length added by each vn_growth_advance(), > 0; 0: a hundredth of to - from
    double split;      ///< isogonic: vn_growth_carry() splits edges longer than this times the unit; 0: none
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
/// Isogonic growth (Runions §3.3, READINGS R7): everything grows alike, so nothing has to move; the unit
/// length shrinks instead, λ_t = λ₀σ₀/σ_t. The shape is scaled about the origin to the length `from`, and
/// stays; vn_growth_length() runs from `from` to `to`, and vn_growth_unit() is from / length. A script
/// multiplies its lengths by the unit and divides its densities by the unit's square (cube). For a picture at
/// the grown size, scale by to / from. Its unit is the domain's only when `from` is the domain's own length.
VN_API vn_status vn_growth_isogonic(vn_growth **out, const vn_growth_def *def);

typedef struct vn_uniform_def {
    vn_domain *domain; ///< the shape at first, flat or in 3D; held, not taken over
    double origin[3];  ///< the petiole, as in vn_growth_def
    bool has_origin;
    double x, y,
        z; ///< growth factors a step along the axes, > 0, at most 1e6; 1 (the default): none; z in 3D only
    int32_t steps; ///< 1 or more; default 100
    double split;  ///< vn_growth_carry() splits edges longer than this (0: none); default 2 lengths
} vn_uniform_def;
VN_API vn_uniform_def vn_uniform_def_default(void);
/// Uniform anisotropic growth: x(t) = x₀ · x^t, y(t) = y₀ · y^t and, in 3D, z(t) = z₀ · z^t, measured from
/// the origin. In 3D today's shape is the one at first, stretched: boxes and meshes, surfaces among them,
/// stay such and are exact; of others, contains(), sees(), samples, bounds and measure are exact, and
/// distance() is never more than the true distance, nor less than that times the least over the greatest of
/// x^t, y^t and z^t. VN_INVALID for a z in the plane.
VN_API vn_status vn_growth_uniform(vn_growth **out, const vn_uniform_def *def);

typedef struct vn_rerg_def {
    vn_domain *domain; ///< the shape at first, flat; held, not taken over
    double origin[3];  ///< the petiole, as in vn_growth_def
    bool has_origin;
    const double *x;   ///< growth factors along x at evenly spaced heights from vn_growth_heights()'s bottom
                       ///< to its top, each in [1e-100, 1e100]; borrowed; NULL: 1 everywhere
    int32_t x_samples; ///< how many, 2 or more
    const double *y;   ///< growth factors along y, likewise
    int32_t y_samples;
    int32_t steps;   ///< 1 or more; default 100
    int32_t samples; ///< how often a function is sampled by who has one; default 16384
    double split;    ///< vn_growth_carry() splits edges longer than this (0: none); default 2 lengths
} vn_rerg_def;
VN_API vn_rerg_def vn_rerg_def_default(void);
/// The lowest and highest point of the domain, relative to the origin: where `x` and `y` are to be sampled.
VN_API vn_status vn_growth_heights(const vn_rerg_def *def, double *bottom, double *top);
/// Non-uniform anisotropic growth (Runions §3.3 and appendix, READINGS R-RERG). With f_x and f_y the growth
/// factors a unit of time as functions of the height y₀ at first, all relative to the origin:
/// x(t) = x₀ f_x(y₀)^t and y(t) = ∫₀^{y₀} f_y^t dy, downward where y₀ < 0. Between samples f is linear,
/// beyond the first and last it stays; of this f the map is exact at every time, so for a smooth f the
/// default samples keep it within 1e-6 of the blade's height, and a jump is spread over one sample's width.
/// VN_INVALID for a factor that is not above 0.
VN_API vn_status vn_growth_rerg(vn_growth **out, const vn_rerg_def *def);

typedef struct vn_morph_def {
    vn_domain *const *domains; ///< the outlines in the order of time, flat, of one ring each; borrowed
    int32_t count;             ///< 2 or more
    double origin[3];          ///< outlines are matched from their points nearest to it; used when has_origin
    bool has_origin;           ///< false: each from its lowest point, or the middle of its flat base
    int32_t steps;             ///< from the first outline to the last, at least count - 1; default 100
    int32_t samples; ///< evenly spaced points of an outline, 8 or more, besides its corners; default 512
    double split;    ///< vn_growth_carry() splits edges longer than this (0: none); default 2 lengths
} vn_morph_def;
VN_API vn_morph_def vn_morph_def_default(void);
/// Growth from outline to outline (Webb 2020): points at equal parts of the outlines' lengths go to each
/// other along straight lines. Inside, the mean value coordinates of the outline before a step (Hormann and
/// Floater 2006) say where a point is after it: exact on the outline, the identity when outlines are equal,
/// any translation, scaling or shear when they differ by one, and smooth in between.
VN_API vn_status vn_growth_morph(vn_growth **out, const vn_morph_def *def);

VN_API void vn_growth_release(vn_growth *growth);

/// Grow by one step. @p growing becomes false when it was grown already, and nothing changed. VN_INFEASIBLE
/// when the step would make the outline cross itself or leave the range of numbers: then it stays at the
/// last good step.
VN_API vn_status vn_growth_advance(vn_growth *growth, bool *growing);
/// Whether vn_growth_advance() has nothing left to do.
VN_API bool vn_growth_is_grown(const vn_growth *growth);
/// Move the nodes of @p network as the last step moved the tissue, then split edges that are longer than
/// `split` times vn_growth_unit() into equal parts (joins stay as they are). Once a step: a network that was
/// carried since the last vn_growth_advance() is left as it is. VN_LIMIT where its max_nodes has no room for
/// the parts; on failure nothing has moved.
VN_API vn_status vn_growth_carry(vn_growth *growth, vn_network *network);
/// Where the tissue that is at @p p at time @p t1 is at time @p t2, into @p q. Times may be fractions of
/// steps, 0 or more; a morph's end with its steps. The identity under none, marginal and isogonic growth:
/// there the tissue keeps the coordinates of the simulation.
VN_API vn_status vn_growth_map(vn_growth *growth, const double p[3], double t1, double t2, double q[3]);

/// Today's shape as a domain; borrowed, and changing with the growth.
VN_API vn_domain *vn_growth_domain(vn_growth *growth);
/// "none", "marginal", "isogonic", "uniform", "rerg" or "morph".
VN_API const char *vn_growth_kind_name(const vn_growth *growth);
/// Steps taken, and steps from first to grown.
VN_API int32_t vn_growth_time(const vn_growth *growth);
VN_API int32_t vn_growth_steps(const vn_growth *growth);
/// Today's length, its extent along y, and that of the grown shape.
VN_API double vn_growth_length(const vn_growth *growth);
VN_API double vn_growth_final_length(const vn_growth *growth);
/// The petiole, which stays where it is; of a morph, the point that outlines are matched from today.
VN_API void vn_growth_origin(const vn_growth *growth, double p[3]);
/// Today's unit length in the simulation's coordinates (READINGS R7): 1, but from / length under isogonic
/// growth.
VN_API double vn_growth_unit(const vn_growth *growth);

#ifdef __cplusplus
}
#endif

#endif
