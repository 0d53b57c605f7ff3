/// A domain from inside: what each kind answers.
#ifndef VN_DOMAIN_DOMAIN_H
#define VN_DOMAIN_DOMAIN_H

#include "base/schema.h"
#include "domain/rings.h"

#include <math.h>
#include <stdatomic.h>

extern const vn_schema vn_disk_schema;
extern const vn_schema vn_box_schema;
extern const vn_schema vn_profile_schema;
extern const vn_schema vn_shell_schema;

/// What a domain with a moving margin answers besides.
typedef struct vn_margin {
    /// The length at which the margin passes @p p; INFINITY when it never does.
    double (*arrival)(const vn_domain *domain, const double p[3]);
    double (*length)(const vn_domain *domain);                               ///< today's
    void (*grown)(const vn_domain *domain, vn_box *bounds, double *measure); ///< the largest shape's
} vn_margin;

/// A surface: corners are numbers of points, three a triangle, in any orientation.
typedef struct vn_triangles {
    VN_ARRAY(double) xyz; ///< three numbers a point
    VN_ARRAY(int32_t) corners;
} vn_triangles;
void vn_triangles_free(vn_triangles *triangles);

typedef struct vn_stretch vn_stretch;

/// The functions of one kind of domain; those marked so may be NULL.
typedef struct vn_domain_kind {
    const char *name;
    void (*destroy)(vn_domain *domain); ///< what the kind itself holds; may be NULL
    bool (*contains)(const vn_domain *domain, const double p[3]);
    /// The nearest border point q; returns its distance, 0 or more (in or out is contains()'s to say).
    double (*closest)(const vn_domain *domain, const double p[3], double q[3]);
    /// Whether the border comes within @p reach of @p p, where that is found sooner than how near it comes;
    /// NULL: it is not.
    bool (*is_near)(const vn_domain *domain, const double p[3], double reach);
    /// Whether ends that are inside see each other; NULL: march along by the distance to the border.
    bool (*sees)(const vn_domain *domain, const double a[3], const double b[3]);
    /// NULL where there are no flat outlines.
    vn_status (*outline)(const vn_domain *domain, int32_t sides, vn_rings *out);
    const vn_margin *margin; ///< NULL: it does not move
    /// Whether a growing shape has come to its end; NULL: it does not grow.
    bool (*is_grown)(const vn_domain *domain);
    /// Bring bounds and measure up to date with what it is made of; NULL: they are always.
    void (*refresh)(vn_domain *domain);
    /// How often the shape of what it is made of has changed; NULL: `changes` says so.
    int64_t (*changes)(const vn_domain *domain);
    /// A uniformly distributed point; NULL: darts into the bounds that contains() takes.
    vn_status (*dart)(const vn_domain *domain, vn_rng *rng, double p[3]);
    /// Of surfaces: the nearest point @p q; false when @p p lies beyond the border. NULL: the domain is as
    /// thick as its space.
    bool (*snap)(const vn_domain *domain, const double p[3], double q[3]);
    /// The surface of what is in space, appended to an empty @p out; round ones to within a thousandth of
    /// their radius. NULL where nobody can tell.
    vn_status (*triangles)(const vn_domain *domain, vn_triangles *out);
    /// One of its own kind, stretched (domain/stretch.h); NULL: vn_domain_stretch() has another.
    vn_status (*stretched)(vn_domain **out, const vn_domain *domain, const vn_stretch *stretch);
    /// In [0, 1]; NULL: 1 inside and 0 outside.
    double (*value)(const vn_domain *domain, const double p[3]);
} vn_domain_kind;

/// The head of every kind's own structure.
struct vn_domain {
    const vn_domain_kind *kind;
    size_t size; ///< of the whole structure
    atomic_int references;
    int dim;
    bool polygonal; ///< its outline is exact
    vn_box bounds;
    double measure;
    int64_t changes; ///< how often its shape has changed; 0 where nothing grows
    char unit[8];
};

/// A zeroed structure of @p size bytes whose head is set; one reference. NULL when there is no memory.
void *vn_domain_new(const vn_domain_kind *kind, size_t size, int dim);

/// Set `measure` to the area of the outline.
vn_status vn_domain_measure_outline(vn_domain *domain);

/// Grows with every change of its shape; 0 where nothing grows.
int64_t vn_domain_changes(const vn_domain *domain);

/// The share of its bounds that a domain fills, by Halton's points, times their size: nothing else is exact
/// for every combination. Off by some 1e-4 of the bounds.
double vn_domain_measure_by_points(const vn_domain *domain);

/// Whether the border comes within @p reach of @p p.
bool vn_domain_is_near(const vn_domain *domain, const double p[3], double reach);

/// Bring @p p onto the domain where that is a surface; elsewhere, and where @p p is beyond the border,
/// nothing happens. Whether it is where it has to be.
bool vn_domain_snap(const vn_domain *domain, double p[3]);

/// Its surface as triangles, into an empty @p out that the caller frees even after a failure. VN_INVALID
/// where the kind has none to give.
vn_status vn_domain_triangles(const vn_domain *domain, vn_triangles *out);

/// What vn_domain_dart() fails with.
vn_status vn_domain_fail_dart(const vn_domain *domain);

/// Sides of a circle where an outline stands in for it: its area is kept, its border is off by 1e-6 of
/// the radius.
enum { VN_FINE_SIDES = 2048 };

#endif
