#include "space/edge_grid.h"

#include "base/status.h"

#include <math.h>

// Cells beyond this are merged into the outermost one, so that huge coordinates cannot overflow an integer.
static const double FARTHEST_CELL = 1e15;

// An edge that covers more cells than these is a mistake of scale.
static const double MOST_CELLS = 1 << 20;

vn_status vn_edge_grid_init(vn_edge_grid *grid, double cell, int32_t edges) {
    int64_t buckets = 1024;
    while (buckets < 2 * (int64_t)edges && buckets < (1 << 30)) {
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
    vn_array_free(&grid->entries);
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

// Not above, and not below: floats keep seven digits, of which the last is given away.
static float below(double a, double b, double slack) {
    double low = (a < b ? a : b) - slack;
    return (float)(low - 1e-6 * fabs(low));
}

static float above(double a, double b, double slack) {
    double high = (a > b ? a : b) + slack;
    return (float)(high + 1e-6 * fabs(high));
}

static vn_edge_entry entry_of(const vn_edge_grid *grid, int32_t edge, const vn_segment *s) {
    double slack = slack_of(grid, s);
    return (vn_edge_entry){.edge = edge,
                           .low_x = below(s->x0, s->x1, slack),
                           .low_y = below(s->y0, s->y1, slack),
                           .high_x = above(s->x0, s->x1, slack),
                           .high_y = above(s->y0, s->y1, slack)};
}

static bool overlap(const vn_edge_entry *a, const vn_edge_entry *b) {
    return a->low_x <= b->high_x && b->low_x <= a->high_x && a->low_y <= b->high_y && b->low_y <= a->high_y;
}

static vn_status list_edge(vn_edge_grid *grid, vn_edge_entry entry, const vn_row *row) {
    for (int64_t i = row->from; i <= row->to; i++) {
        int32_t bucket = bucket_of(grid, i, row->j);
        entry.next = grid->heads.data[bucket];
        VN_TRY(vn_array_push(&grid->entries, entry));
        grid->heads.data[bucket] = grid->entries.count - 1;
    }
    return VN_OK;
}

vn_status vn_edge_grid_insert(vn_edge_grid *grid, int32_t edge, const vn_segment *s) {
    double cells = (fabs(s->x1 - s->x0) + fabs(s->y1 - s->y0)) / grid->cell;
    if (!(cells < MOST_CELLS)) {
        return vn_fail(VN_LIMIT, "an edge is %g times as long as the new ones: split edges as they grow",
                       cells);
    }
    double slack = slack_of(grid, s);
    int64_t last = cell_of(grid, greater(s->y0, s->y1) + slack);
    for (int64_t j = cell_of(grid, lesser(s->y0, s->y1) - slack); j <= last; j++) {
        vn_row row = row_of(grid, s, j);
        VN_TRY(list_edge(grid, entry_of(grid, edge, s), &row));
    }
    return VN_OK;
}

bool vn_edge_grid_visit(const vn_edge_grid *grid, const vn_segment *s, vn_segment_visit_fn *visit,
                        void *payload) {
    if (grid->heads.count == 0) {
        return true;
    }
    vn_edge_entry own = entry_of(grid, 0, s);
    double slack = slack_of(grid, s);
    int64_t last = cell_of(grid, greater(s->y0, s->y1) + slack);
    for (int64_t j = cell_of(grid, lesser(s->y0, s->y1) - slack); j <= last; j++) {
        vn_row row = row_of(grid, s, j);
        for (int64_t i = row.from; i <= row.to; i++) {
            int32_t next = grid->heads.data[bucket_of(grid, i, j)];
            while (next >= 0) {
                const vn_edge_entry *entry = &grid->entries.data[next];
                if (overlap(entry, &own) && !visit(entry->edge, payload)) {
                    return false;
                }
                next = entry->next;
            }
        }
    }
    return true;
}
