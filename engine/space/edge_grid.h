/// A growing set of edges in the plane, for "does this new one meet another".
#ifndef VN_SPACE_EDGE_GRID_H
#define VN_SPACE_EDGE_GRID_H

#include "base/array.h"
#include "space/segment_grid.h"

enum { VN_EDGE_BLOCK = 7 };

/// Edges in one cell, and the part of it that the box of each takes up, in 255ths: most questions are
/// answered by that, without a look at the edge. A block is a line of the cache.
typedef struct vn_edge_block {
    uint8_t low_x[VN_EDGE_BLOCK], low_y[VN_EDGE_BLOCK], high_x[VN_EDGE_BLOCK], high_y[VN_EDGE_BLOCK];
    int32_t edges[VN_EDGE_BLOCK];
    int32_t next; ///< the next of its chain, which is full; or -1
    uint8_t count;
} vn_edge_block;

/// Edges hashed into square cells. Where an edge is now is asked of the caller: one that has become shorter
/// stays listed where it was.
typedef struct vn_edge_grid {
    double cell;
    VN_ARRAY(int32_t) heads; ///< of the chain of each bucket; a power of two of them
    VN_ARRAY(vn_edge_block) blocks;
} vn_edge_grid;

/// Empty the grid and make it ready for about @p edges edges; @p cell > 0, best a few times as long as most
/// of them.
vn_status vn_edge_grid_init(vn_edge_grid *grid, double cell, int32_t edges);
void vn_edge_grid_free(vn_edge_grid *grid);

/// List @p edge, which is where @p segment says.
vn_status vn_edge_grid_insert(vn_edge_grid *grid, int32_t edge, const vn_segment *segment);

/// Visit every edge listed in a cell that @p segment passes and whose box overlaps its own; some may be
/// visited several times, and some that are elsewhere. False when stopped by @p visit, which returns false to
/// stop.
bool vn_edge_grid_visit(const vn_edge_grid *grid, const vn_segment *segment, vn_segment_visit_fn *visit,
                        void *payload);

#endif
