/// Trees in their organ, from inside.
#ifndef VN_CCO_CCO_H
#define VN_CCO_CCO_H

#include "base/schema.h"
#include "cco/bifurcation.h"
#include "cco/darts.h"
#include "cco/tree.h"
#include "network/network.h"
#include "space/tube_grid.h"
#include "venule/cco.h"

extern const vn_schema vn_cco_schema;
extern const vn_schema vn_cco_tree_schema;

/// A segment near a new terminal.
typedef struct vn_near {
    int32_t node;
    double distance2;
} vn_near;

/// A segment that may connect a new terminal, and how.
typedef struct vn_candidate {
    int32_t node; ///< whose segment
    double x[2];  ///< the bifurcation, in the triangle's plane
    vn_effect effect;
    bool measured; ///< the effect is exact
    bool refined;  ///< x is the point of least volume to the last digit
    bool hopeless; ///< far too short to be refined
    vn_triangle triangle;
} vn_candidate;

/// A node and the radius of its segment.
typedef struct vn_thickness {
    int32_t node;
    double radius;
} vn_thickness;

/// A fork on the way from a new bifurcation to the root, as it will be.
typedef struct vn_step {
    int32_t node, child; ///< the fork, and the branch that the way comes by
    double beta, square; ///< of that branch; H^2
} vn_step;

/// One tree, or, when `fixed`, vessels that only stand in the way.
typedef struct vn_grower {
    vn_tree tree;
    bool fixed, venous;
    int32_t first_born; ///< nodes before it were there, or came with the first terminal
    int32_t given;      ///< the first so many nodes were there before: their segments may be short
    int32_t terminals;  ///< of the tree as it is
    int32_t wanted;     ///< and when it is done, or the stage is
    int32_t listed;     ///< how many of the list have been placed
    double terminal_flow;
    vn_cco_value_fn *flow;
    void *flow_payload;
    double pressure_in, pressure_out, symmetry;
    vn_tube_grid grid;       ///< all segments, and the roots as points
    vn_tube_grid thick_grid; ///< those with a cap above `thin` once more
    double thin, thickest;   ///< and the largest cap that ever was
    int32_t grid_count;      ///< nodes when the cells were chosen
    vn_darts darts;
    int32_t stage_start; ///< terminals when the stage began
    int32_t draws;       ///< random terminals so far, those drawn anew included
    int64_t settled;     ///< how many were drawn anew until the tree had found its way about
    VN_ARRAY(vn_near) nearest;
    vn_adjoints adjoints;
    VN_ARRAY(vn_candidate) candidates;
    VN_ARRAY(vn_step) path; ///< working memory of rules.c
    VN_ARRAY(vn_thickness) crowded;
    VN_ARRAY(vn_thickness) stack;
    vn_cco_report report;
} vn_grower;

/// A vessel that is to do with less room.
typedef struct vn_squeeze {
    vn_grower *g;
    int32_t node;
    double left;
} vn_squeeze;

struct vn_cco {
    vn_cco_def def;
    int dim;
    double low[3], high[3]; ///< of everything
    vn_domain *part;        ///< where terminals fall now; the domain itself or a part
    bool patient;           ///< another terminal will be drawn if this one does not fit well
    bool provident;         ///< vessels are to have room to thicken
    double foresight;       ///< how much: less with every terminal that was drawn in vain
    VN_ARRAY(vn_grower) growers;
    VN_ARRAY(vn_squeeze) squeezes; ///< working memory of rules.c
};

static inline vn_vessel *vn_vessel_of(const vn_grower *g, int32_t node) {
    return &g->tree.vessels.data[node];
}

/// A cap as it is kept: rounded to a float, never up.
static inline float vn_cap_below(double cap) {
    return (float)(cap * (1 - 1e-7));
}

/// Tree number @p tree of those that grow.
vn_grower *vn_cco_tree_at(const vn_cco *cco, int32_t tree);

/// How much thicker, against the whole domain, vessels are while the domain is small (14): lengths are s
/// times those in the whole one, so radii s^(1/4) times, with @p terminals of all those wanted.
double vn_cco_inflate(const vn_cco *cco, int32_t terminals);

// ---- places.c: where vessels are ----

/// Choose cells anew when there are many more vessels than they were made for.
vn_status vn_places_update(const vn_cco *cco, vn_grower *g);
vn_status vn_places_insert(vn_grower *g, int32_t node);
void vn_places_remove(vn_grower *g, int32_t node);
/// Set a segment's cap; slack is to be settled by the caller.
vn_status vn_places_set_cap(vn_grower *g, int32_t node, double cap);
typedef enum vn_seek {
    VN_SEEK_AXIS,    ///< of any vessel; a root that has none yet counts
    VN_SEEK_SEGMENT, ///< roots do not count
    VN_SEEK_TERMINAL,
} vn_seek;
/// The distance from @p p to the nearest, and its node; INFINITY and -1 when there is none.
double vn_places_seek(const vn_grower *g, const double p[3], vn_seek seek, int32_t *node);
/// The distance to the axis of one vessel; or, with @p terminals, to its lower end.
double vn_places_distance_to(const vn_grower *g, const double p[3], int32_t node, bool terminals);
/// Whether @p p is in a vessel of a tree inflated by @p inflate.
bool vn_places_inside(const vn_grower *g, const double p[3], double inflate);
/// Fill `nearest` with the @p count segments nearest to @p p, nearest first.
vn_status vn_places_nearest(vn_grower *g, const double p[3], int32_t count);
/// Visit the tubes of a tree that may come within @p reach of the segment; some twice.
bool vn_places_visit(const vn_grower *g, const double a[3], const double b[3], double reach,
                     vn_tube_visit_fn *visit, void *payload);

// ---- rules.c: what a tree must not do (section 3.3) ----

typedef enum vn_verdict {
    VN_ALLOWED,
    VN_COLLAPSED,
    VN_SHORT,
    VN_OUTSIDE,
    VN_CROSSING,
    VN_CROWDING,
    VN_ASYMMETRIC,
} vn_verdict;

/// The three segments of a new bifurcation, or the one of a first terminal.
typedef struct vn_plan {
    int32_t node;  ///< whose segment is cut; or -1
    int32_t upper; ///< the node that the upper segment, or the first, starts from
    double x[3];   ///< the bifurcation
    double terminal[3];
    double radius[3]; ///< of the upper, the lower and the new segment, for the tree's size now; [2] alone of
                      ///< a first
    double flow[3];   ///< through them
    vn_branch branch; ///< that hangs from `upper` then
    double caps[3];   ///< found by vn_rules_judge()
} vn_plan;

/// Whether segment @p i of the plan is the rest of one that was there before: it may be short.
static inline bool vn_plan_is_given(const vn_grower *g, const vn_plan *plan, int i) {
    return i == 1 && plan->node < g->given;
}
static inline bool vn_is_short(double radius, double length) {
    return radius > length / 2;
}

/// Whether the plan keeps all rules. Room that other vessels hold but do not need is taken from them.
vn_status vn_rules_judge(vn_cco *cco, vn_grower *g, vn_plan *plan, vn_verdict *verdict);

// ---- connect.c ----

/// Connect a terminal where that is best; false in @p done when no segment will do.
vn_status vn_connect(vn_cco *cco, vn_grower *g, const double terminal[3], double flow, bool *done);

#endif
