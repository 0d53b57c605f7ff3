/// Growth from inside.
#ifndef VN_GROWTH_GROWTH_H
#define VN_GROWTH_GROWTH_H

#include "domain/domain.h"
#include "venule/growth.h"

extern const vn_schema vn_none_schema;
extern const vn_schema vn_marginal_schema;
extern const vn_schema vn_isogonic_schema;
extern const vn_schema vn_uniform_schema;
extern const vn_schema vn_rerg_schema;
extern const vn_schema vn_morph_schema;

/// One kind of growth. Those of moving tissue have the functions from `prepare` on; the others none.
typedef struct vn_growth_kind {
    const char *name;
    size_t size; ///< of its own structure
    vn_domain_kind domain;
    bool stepwise; ///< moves are prepared from one step to the next only
    /// Make the shape that of @p time; on failure nothing has changed. NULL: it never changes.
    vn_status (*step)(vn_growth *growth, int32_t time);
    void (*destroy)(vn_growth *growth); ///< what the kind itself holds; may be NULL
    /// Get ready to move points from @p t1 to @p t2; fails for times that make no sense.
    vn_status (*prepare)(vn_growth *growth, double t1, double t2);
    /// As prepared; several threads may ask. False where it finds no answer.
    bool (*move)(const vn_growth *growth, const double p[3], double q[3]);
    /// The outline at a time, pushed into @p out.
    vn_status (*outline)(vn_growth *growth, double time, vn_rings *out);
} vn_growth_kind;

struct vn_growth {
    vn_domain base;
    const vn_growth_kind *kind;
    vn_domain *shape; ///< as it was given
    double origin[3];
    double own_length; ///< of `shape` in its own coordinates
    /// Scaled kinds: today's shape is `shape`, scaled about the origin by drawn / own_length.
    double drawn;
    vn_domain *today; ///< moving tissue: today's shape, a polygon or, in 3D, a stretched one
    double length, to, step, from;
    double unit, split;
    int32_t time, steps;
    bool simple;  ///< moving tissue: the outline did not cross itself at first, and must not later
    bool stepped; ///< the last vn_growth_advance() changed something
    VN_ARRAY(uint64_t) carried; ///< serials of what was carried since
};

/// What growths are made of: the common part of every def.
typedef struct vn_growth_base {
    const vn_domain *domain;
    const double *origin; ///< NULL: the lowest point of the outline
    double split;
} vn_growth_base;
vn_status vn_growth_make(vn_growth **out, const vn_growth_kind *kind, const vn_growth_base *base);

/// The lowest point of the outline; of a flat base, its middle.
void vn_growth_lowest_point(const vn_rings *rings, double origin[3]);
void vn_growth_destroy(vn_domain *domain);
bool vn_growth_is_grown_domain(const vn_domain *domain);

/// Rows of vn_growth_def.
#define VN_GROWTH_LENGTH_ROW(name, field, doc)                                                               \
    {                                                                                                        \
        name, VN_F64, VN_ABOVE_MIN | VN_OPTIONAL, offsetof(vn_growth_def, field), 0, 1e150, "length", NULL,  \
            doc                                                                                              \
    }
#define VN_GROWTH_TO                                                                                         \
    VN_GROWTH_LENGTH_ROW("to", to,                                                                           \
                         "its length when grown; left out: the domain's own length, its extent along y")
#define VN_GROWTH_STEP                                                                                       \
    VN_GROWTH_LENGTH_ROW("step", step, "the length that each step adds; left out: a hundredth of to - from")

/// Set from, to and step, with their defaults, for a growth that is called @p name in errors.
vn_status vn_growth_set_lengths(vn_growth *growth, const vn_growth_def *def);

/// A point of a blade of the given length in the coordinates of `shape`, and back.
void vn_growth_to_shape(const vn_growth *growth, double length, const double p[3], double q[3]);
/// Make today's shape that of this length.
void vn_growth_resize(vn_growth *growth, double drawn);

// What a scaled shape answers.
bool vn_scaled_contains(const vn_domain *domain, const double p[3]);
double vn_scaled_closest(const vn_domain *domain, const double p[3], double q[3]);
bool vn_scaled_sees(const vn_domain *domain, const double a[3], const double b[3]);
double vn_scaled_value(const vn_domain *domain, const double p[3]);
vn_status vn_scaled_triangles(const vn_domain *domain, vn_triangles *out);
/// Of scaled surfaces.
vn_status vn_scaled_dart(const vn_domain *domain, vn_rng *rng, double p[3]);
bool vn_scaled_snap(const vn_domain *domain, const double p[3], double q[3]);
vn_status vn_scaled_outline(const vn_domain *domain, int32_t sides, vn_rings *out);

// What today's shape answers, for the kinds of moving tissue.
bool vn_today_contains(const vn_domain *domain, const double p[3]);
double vn_today_closest(const vn_domain *domain, const double p[3], double q[3]);
bool vn_today_sees(const vn_domain *domain, const double a[3], const double b[3]);
vn_status vn_today_outline(const vn_domain *domain, int32_t sides, vn_rings *out);
/// Let @p shape be today's.
void vn_today_replace(vn_growth *growth, vn_domain *shape);
/// The `step` of moving tissue: the polygon of kind->outline() takes the place of the last one.
vn_status vn_today_step(vn_growth *growth, int32_t time);
/// What a new growth of moving tissue begins with: today's polygon, and the length after all steps.
vn_status vn_today_begin(vn_growth *growth, int32_t steps);
/// Push what the prepared move makes of @p rings, point by point; @p time is for the message when that fails.
vn_status vn_today_push_moved(const vn_growth *growth, const vn_rings *rings, double time, vn_rings *out);

/// Note that the bearer of @p serial is carried by the last step; false when it was before, or when there is
/// nothing to carry it by.
vn_status vn_growth_note_carried(vn_growth *growth, uint64_t serial, bool *first);
/// Whether the tissue moves at all.
static inline bool vn_growth_moves(const vn_growth *growth) {
    return growth->kind->move != NULL;
}
/// Move points by the last step: all of them or, on failure, none. @p columns: x, y and, in 3D, z.
vn_status vn_growth_move_points(vn_growth *growth, double *const columns[3], int32_t count);
/// VN_INVALID where @p what ("a network") has not the dimensions of the tissue that moves it.
vn_status vn_growth_check_dim(const vn_growth *growth, const char *what, int dim);

#define VN_TODAY_DOMAIN                                                                                      \
    {                                                                                                        \
        .name = "blade", .destroy = vn_growth_destroy, .contains = vn_today_contains,                        \
        .closest = vn_today_closest, .sees = vn_today_sees, .outline = vn_today_outline,                     \
        .is_grown = vn_growth_is_grown_domain                                                                \
    }

#endif
