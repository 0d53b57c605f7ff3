#include "space/edge_grid.h"

#include "base/status.h"

#include <math.h>

// Cells beyond this are merged into the outermost one, so that huge coordinates cannot overflow an integer.
static const double FARTHEST_CELL = 1e15;

// An edge that covers more cells than these is a mistake of scale.
static const double MOST_CELLS = 1 << 20;

vn_status vn_edge_grid_init(vn_edge_grid *grid, double cell, int32_t edges) {
    int64_t buckets = 1024;
    while (buckets < edges / 4 && buckets < (1 << 30)) {
        buckets *= 2;
    }
    vn_edge_grid_free(grid);
    grid->cell = 0; // until it is ready
    VN_TRY(vn_array_reserve(&grid->heads, buckets));
    grid->cell = cell;
    grid->heads.count = (int32_t)buckets;
    for (int64_t b = 0; b < buckets; b++) {
        grid->heads.data[b] = -1;
    }
    return VN_OK;
}

void vn_edge_grid_free(vn_edge_grid *grid) {
    vn_array_free(&grid->heads);
    vn_array_free(&grid->blocks);
}

// In place of fmin(), fmax() and floor(), which are calls: half of the instructions of this file were theirs.
static double lesser(double a, double b) {
    return a < b ? a : b;
}

static double greater(double a, double b) {
    return a > b ? a : b;
}

static int64_t cell_of(const vn_edge_grid *grid, double coordinate) {
    double cell = lesser(greater(coordinate / grid->cell, -FARTHEST_CELL), FARTHEST_CELL);
    int64_t whole = (int64_t)cell;
    return whole - (cell < (double)whole);
}

// Cells of a square of four by four are side by side: a segment's cells are mostly in one line of the cache.
static int32_t bucket_of(const vn_edge_grid *grid, int64_t i, int64_t j) {
    uint64_t h = (uint64_t)(i >> 2) * 0x9E3779B97F4A7C15u ^ (uint64_t)(j >> 2) * 0xC2B2AE3D27D4EB4Fu;
    h ^= h >> 29;
    h *= 0xBF58476D1CE4E5B9u;
    uint32_t within = (uint32_t)(i & 3) | (uint32_t)(j & 3) << 2;
    return (int32_t)(((uint32_t)(h >> 32) << 4 | within) & (uint32_t)(grid->heads.count - 1));
}

// How much wider than it is a segment is taken, so that what comes as near as a hundred-thousandth of a cell
// is found; and what rounding makes of it far from the origin.
static double slack_of(const vn_edge_grid *grid, const vn_segment *s) {
    double far = greater(greater(fabs(s->x0), fabs(s->x1)), greater(fabs(s->y0), fabs(s->y1)));
    return 1e-5 * grid->cell + 1e-15 * far;
}

/// The cells of one row that a segment passes, a little too many rather than too few.
typedef struct vn_row {
    int64_t j, from, to;
} vn_row;

static vn_row row_of(const vn_edge_grid *grid, const vn_segment *s, int64_t j) {
    double slack = slack_of(grid, s), rise = s->y1 - s->y0;
    double low = lesser(s->x0, s->x1) - slack, high = greater(s->x0, s->x1) + slack;
    if (fabs(rise) > 0.5 * grid->cell) { // where it is flatter, all of it
        double slope = (s->x1 - s->x0) / rise;
        double a = s->x0 + ((double)j * grid->cell - s->y0) * slope;
        double b = s->x0 + ((double)(j + 1) * grid->cell - s->y0) * slope;
        double wide = slack * (1 + fabs(slope));
        low = greater(low, lesser(a, b) - wide);
        high = lesser(high, greater(a, b) + wide);
    }
    return (vn_row){j, cell_of(grid, low), cell_of(grid, high)};
}

typedef struct vn_edge_box {
    double low_x, low_y, high_x, high_y;
} vn_edge_box;

static vn_edge_box box_of(const vn_edge_grid *grid, const vn_segment *s) {
    double slack = slack_of(grid, s);
    return (vn_edge_box){lesser(s->x0, s->x1) - slack, lesser(s->y0, s->y1) - slack,
                         greater(s->x0, s->x1) + slack, greater(s->y0, s->y1) + slack};
}

/// A box in 255ths of a cell, as far as it is in there.
typedef struct vn_edge_part {
    uint8_t low_x, low_y, high_x, high_y;
} vn_edge_part;

// What is not greater does not become greater by it: boxes that overlap do so in parts as well.
static uint8_t part_of(const vn_edge_grid *grid, double coordinate, int64_t cell) {
    double part = (coordinate - (double)cell * grid->cell) * (255 / grid->cell);
    return part > 0 ? (uint8_t)lesser(part, 255) : 0;
}

static vn_edge_part parts_of(const vn_edge_grid *grid, const vn_edge_box *box, int64_t i, int64_t j) {
    return (vn_edge_part){part_of(grid, box->low_x, i), part_of(grid, box->low_y, j),
                          part_of(grid, box->high_x, i), part_of(grid, box->high_y, j)};
}

static vn_status list_in_bucket(vn_edge_grid *grid, int32_t bucket, int32_t edge, vn_edge_part part) {
    int32_t head = grid->heads.data[bucket];
    if (head < 0 || grid->blocks.data[head].count == VN_EDGE_BLOCK) {
        VN_TRY(vn_array_push(&grid->blocks, (vn_edge_block){.next = head}));
        head = grid->heads.data[bucket] = grid->blocks.count - 1;
    }
    vn_edge_block *block = &grid->blocks.data[head];
    int k = block->count++;
    block->low_x[k] = part.low_x;
    block->low_y[k] = part.low_y;
    block->high_x[k] = part.high_x;
    block->high_y[k] = part.high_y;
    block->edges[k] = edge;
    return VN_OK;
}

vn_status vn_edge_grid_insert(vn_edge_grid *grid, int32_t edge, const vn_segment *s) {
    double cells = (fabs(s->x1 - s->x0) + fabs(s->y1 - s->y0)) / grid->cell;
    if (!(cells < MOST_CELLS)) {
        return vn_fail(VN_LIMIT, "an edge is %g times as long as the new ones: split edges as they grow",
                       cells);
    }
    vn_edge_box box = box_of(grid, s);
    int64_t last = cell_of(grid, box.high_y);
    for (int64_t j = cell_of(grid, box.low_y); j <= last; j++) {
        vn_row row = row_of(grid, s, j);
        for (int64_t i = row.from; i <= row.to; i++) {
            VN_TRY(list_in_bucket(grid, bucket_of(grid, i, j), edge, parts_of(grid, &box, i, j)));
        }
    }
    return VN_OK;
}

static bool overlaps(const vn_edge_block *block, int k, vn_edge_part part) {
    return (block->low_x[k] <= part.high_x) & (part.low_x <= block->high_x[k]) &
           (block->low_y[k] <= part.high_y) & (part.low_y <= block->high_y[k]);
}

static bool visit_bucket(const vn_edge_grid *grid, int32_t bucket, vn_edge_part part,
                         vn_segment_visit_fn *visit, void *payload) {
    for (int32_t at = grid->heads.data[bucket]; at >= 0; at = grid->blocks.data[at].next) {
        const vn_edge_block *block = &grid->blocks.data[at];
        for (int k = 0; k < block->count; k++) {
            if (overlaps(block, k, part) && !visit(block->edges[k], payload)) {
                return false;
            }
        }
    }
    return true;
}

bool vn_edge_grid_visit(const vn_edge_grid *grid, const vn_segment *s, vn_segment_visit_fn *visit,
                        void *payload) {
    if (grid->heads.count == 0) {
        return true;
    }
    vn_edge_box box = box_of(grid, s);
    int64_t last = cell_of(grid, box.high_y);
    for (int64_t j = cell_of(grid, box.low_y); j <= last; j++) {
        vn_row row = row_of(grid, s, j);
        for (int64_t i = row.from; i <= row.to; i++) {
            vn_edge_part part = parts_of(grid, &box, i, j);
            if (!visit_bucket(grid, bucket_of(grid, i, j), part, visit, payload)) {
                return false;
            }
        }
    }
    return true;
}
