/// A growing set of points hashed into square cells: near ones in time that does not depend on how many
/// there are.
#ifndef VN_SPACE_POINT_GRID_H
#define VN_SPACE_POINT_GRID_H

#include "space/points.h"

/// Holds the points 0 .. count-1 of columns that the caller keeps and passes to each call.
typedef struct vn_point_grid {
    int dim;
    double cell;             ///< width of a cell; a query costs about (radius / cell)^dim cells
    VN_ARRAY(int32_t) heads; ///< of the chain of each bucket; a power of two of them
    VN_ARRAY(int32_t) next;  ///< of each point
    int64_t low[3], high[3]; ///< the cells in use
} vn_point_grid;

/// An empty grid; @p cell > 0.
void vn_point_grid_init(vn_point_grid *grid, int dim, double cell);
void vn_point_grid_free(vn_point_grid *grid);
static inline int32_t vn_point_grid_count(const vn_point_grid *grid) {
    return grid->next.count;
}

/// Whether its cells are of use for queries of @p reach: up to eight times their width, and down to an eighth
/// of it. Where new cells would soon be paid for (@p thrifty), half as wide ones are asked for sooner.
static inline bool vn_point_grid_fits(const vn_point_grid *grid, double reach, bool thrifty) {
    return grid->cell > 0 && reach <= 8 * grid->cell && grid->cell <= (thrifty ? 1.5 : 8) * reach;
}

/// Insert the points up to @p count that are not yet in it.
vn_status vn_point_grid_update(vn_point_grid *grid, const vn_points *points, int32_t count);

/// Whether a point counts; called only for points that are near enough.
typedef bool vn_point_accept_fn(int32_t point, void *payload);

/// Some point strictly nearer to @p p than @p radius (which one is not said), or -1. @p accept may be NULL.
int32_t vn_point_grid_any_within(const vn_point_grid *grid, const vn_points *points, const double p[3],
                                 double radius, vn_point_accept_fn *accept, void *payload);

/// What vn_point_grid_nearest() looks for, and what it finds.
typedef struct vn_nearest {
    double reach2;     ///< in: squared reach, inclusive (INFINITY: any); out: the squared distance
    int32_t point;     ///< out: the nearest point, or -1
    uint64_t seed, id; ///< in: of equally near points, that of the least vn_hash(seed, id, point, 0) is taken
    vn_point_accept_fn *accept; ///< in: may be NULL
    void *payload;
    bool stop; ///< set by `accept` to end the search with what was found so far
} vn_nearest;
void vn_point_grid_nearest(const vn_point_grid *grid, const vn_points *points, const double p[3],
                           vn_nearest *query);

/// Whether point @p a ranks before @p b among points equally near to @p id.
static inline bool vn_ranks_before(uint64_t seed, uint64_t id, int32_t a, int32_t b) {
    uint64_t ra = vn_hash(seed, id, (uint64_t)a, 0);
    uint64_t rb = vn_hash(seed, id, (uint64_t)b, 0);
    return ra != rb ? ra < rb : a < b;
}

#endif
