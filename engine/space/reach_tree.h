/// Points that each remember a squared distance: "which of them is this new point nearer to than what
/// they remember?" A forest of boxes over the points along a space-filling curve answers in time
/// proportional to the answer.
#ifndef VN_SPACE_REACH_TREE_H
#define VN_SPACE_REACH_TREE_H

#include "base/sort.h"
#include "space/points.h"

enum { VN_REACH_FAN = 8, VN_REACH_LEVELS = 12, VN_REACH_GUARDS = 2 };

/// The boxes of eight runs of points, or of eight smaller packs, side by side so that they are tested
/// together; and the largest squared distance that each run remembers: an upper bound, negative when nothing
/// in it can answer any more.
typedef struct vn_reach_pack {
    float low[3][VN_REACH_FAN], high[3][VN_REACH_FAN];
    float reach2[VN_REACH_FAN];
} vn_reach_pack;

/// Keeps new points from all of a part at once, where the part is on its side of the bisector between the
/// two, and farther from the new point than it is.
typedef struct vn_reach_guard {
    double at[3];
    double excess; ///< by how much some point's near2 is more than its squared distance from here, at most;
                   ///< INFINITY: nobody is posted
} vn_reach_guard;

/// The guards of a pack's eight parts.
typedef struct vn_reach_watch {
    vn_reach_guard guards[VN_REACH_FAN][VN_REACH_GUARDS];
    uint8_t turn[VN_REACH_FAN]; ///< which of them gives way next
} vn_reach_watch;

/// The points of a run side by side, and who kept a new point from each of them last.
typedef struct vn_reach_run {
    double at[3][VN_REACH_FAN];
    double guard[3][VN_REACH_FAN];
    double guard2[VN_REACH_FAN]; ///< its squared distance from the point; INFINITY: nobody is posted
    double near2[VN_REACH_FAN];  ///< the filter's, or more
} vn_reach_run;

typedef struct vn_reach_tree {
    int dim;
    VN_ARRAY(int32_t) items; ///< the points along the curve, in runs of eight
    VN_ARRAY(vn_reach_pack) packs;
    VN_ARRAY(vn_reach_watch) watches; ///< of the packs, where there is a filter
    VN_ARRAY(vn_reach_run) runs;      ///< then too
    VN_ARRAY(int32_t) places;         ///< then, of each point among the items, or -1
    int32_t
        starts[VN_REACH_LEVELS + 1]; ///< level l has the packs [starts[l], starts[l + 1]); level 0 boxes runs
    int levels;
    double size; ///< no two of the points are farther apart
    double middle[3];
} vn_reach_tree;

void vn_reach_tree_free(vn_reach_tree *tree);

/// What new points do not matter to a point although they are within its reach: those that some guard keeps
/// out, being nearer to both than they are to one another.
typedef struct vn_reach_filter {
    /// Whether some guard keeps @p p, at @p distance2, from @p point, and where it stands.
    bool (*keeps_out)(const void *payload, int32_t point, const double p[3], double distance2,
                      double guard[3]);
    const void *payload;
    const double *near2; ///< of each point: what is no farther matters in any case
} vn_reach_filter;

/// Rebuild over the points [0, count) that still remember something (reach2 >= 0). @p filter, if not NULL, is
/// to be passed to each query.
vn_status vn_reach_tree_build(vn_reach_tree *tree, int dim, const vn_points *points, const double *reach2,
                              const vn_reach_filter *filter, int32_t count);

/// The point at @p p remembers more than it did: @p reach2. (Remembering less needs no word.)
void vn_reach_tree_raise(vn_reach_tree *tree, const double p[3], double reach2);

/// The filter's near2 of @p point is more than it was. (Less needs no word.)
void vn_reach_tree_raise_near(vn_reach_tree *tree, const vn_points *points, int32_t point, double near2);

typedef struct vn_reach_hit {
    int32_t point;
    double distance2;
} vn_reach_hit;
typedef VN_ARRAY(vn_reach_hit) vn_reach_hits;

/// Append to @p hits each point i of the tree with |p - i|² <= reach2[i], but for what the filter keeps out.
vn_status vn_reach_tree_query(vn_reach_tree *tree, const vn_points *points, const double *reach2,
                              const vn_reach_filter *filter, const double p[3], vn_reach_hits *hits);

#endif
