#include "space/box_grid.h"

#include <math.h>

// Cells beyond this are merged into the outermost one, so that huge coordinates cannot overflow an integer.
static const double FARTHEST_CELL = 1e9;

// A box in more cells than these is looked at by every visit instead.
enum { MOST_CELLS = 512 };

vn_status vn_box_grid_init(vn_box_grid *grid, int dim, double cell, const double origin[3], int32_t items) {
    int64_t buckets = 256;
    while (buckets < 2 * (int64_t)items && buckets < (1 << 30)) {
        buckets *= 2;
    }
    grid->cell = 0; // until it is ready
    grid->entries.count = 0;
    grid->heads.count = 0;
    VN_TRY(vn_array_reserve(&grid->heads, buckets));
    grid->heads.count = (int32_t)buckets;
    for (int64_t b = 0; b < buckets; b++) {
        grid->heads.data[b] = -1;
    }
    memcpy(grid->origin, origin, sizeof grid->origin);
    grid->dim = dim;
    grid->large = -1;
    grid->cell = cell;
    return VN_OK;
}

void vn_box_grid_free(vn_box_grid *grid) {
    vn_array_free(&grid->heads);
    vn_array_free(&grid->entries);
    grid->cell = 0;
}

static float to_float(double value) {
    return (float)(value < -3e38 ? -3e38 : value > 3e38 ? 3e38 : value);
}

// Not above, and not below: floats keep seven digits, of which the last is given away.
static float below(double value) {
    return to_float(value - 2e-7 * fabs(value));
}

static float above(double value) {
    return to_float(value + 2e-7 * fabs(value));
}

static vn_box_entry entry_of(const vn_box_grid *grid, int32_t item, const double low[3],
                             const double high[3]) {
    vn_box_entry entry = {.item = item};
    for (int k = 0; k < grid->dim; k++) {
        entry.low[k] = below(low[k] - grid->origin[k]);
        entry.high[k] = above(high[k] - grid->origin[k]);
    }
    return entry;
}

static bool overlap(const vn_box_entry *a, const vn_box_entry *b) {
    return a->low[0] <= b->high[0] && b->low[0] <= a->high[0] && a->low[1] <= b->high[1] &&
           b->low[1] <= a->high[1] && a->low[2] <= b->high[2] && b->low[2] <= a->high[2];
}

static int64_t cell_of(const vn_box_grid *grid, float coordinate) {
    double cell = (double)coordinate / grid->cell;
    cell = cell < -FARTHEST_CELL ? -FARTHEST_CELL : cell > FARTHEST_CELL ? FARTHEST_CELL : cell;
    int64_t whole = (int64_t)cell;
    return whole - (cell < (double)whole);
}

static int32_t bucket_of(const vn_box_grid *grid, const int64_t cell[3]) {
    uint64_t h = (uint64_t)cell[0] * 0x9E3779B97F4A7C15u ^ (uint64_t)cell[1] * 0xC2B2AE3D27D4EB4Fu ^
                 (uint64_t)cell[2] * 0x165667B19E3779F9u;
    h ^= h >> 29;
    h *= 0xBF58476D1CE4E5B9u;
    return (int32_t)((h >> 32) & (uint64_t)(grid->heads.count - 1));
}

/// The cells that a box touches.
typedef struct block {
    int64_t from[3], to[3];
    double cells;
} block;

static block block_of(const vn_box_grid *grid, const vn_box_entry *box) {
    block b = {.cells = 1};
    for (int k = 0; k < grid->dim; k++) {
        b.from[k] = cell_of(grid, box->low[k]);
        b.to[k] = cell_of(grid, box->high[k]);
        b.cells *= (double)(b.to[k] - b.from[k] + 1);
    }
    return b;
}

static bool next_cell(const block *b, int64_t cell[3]) {
    for (int k = 0; k < 3; k++) {
        if (cell[k] < b->to[k]) {
            cell[k]++;
            return true;
        }
        cell[k] = b->from[k];
    }
    return false;
}

static vn_status list(vn_box_grid *grid, vn_box_entry entry, int32_t *head) {
    entry.next = *head;
    VN_TRY(vn_array_push(&grid->entries, entry));
    *head = grid->entries.count - 1;
    return VN_OK;
}

vn_status vn_box_grid_insert(vn_box_grid *grid, int32_t item, const double low[3], const double high[3]) {
    vn_box_entry entry = entry_of(grid, item, low, high);
    block b = block_of(grid, &entry);
    if (!(b.cells <= MOST_CELLS)) {
        return list(grid, entry, &grid->large);
    }
    int64_t cell[3] = {b.from[0], b.from[1], b.from[2]};
    do {
        VN_TRY(list(grid, entry, &grid->heads.data[bucket_of(grid, cell)]));
    } while (next_cell(&b, cell));
    return VN_OK;
}

// Whether @p cell is the first that both boxes touch: in the others the same was seen before.
static bool is_first(const vn_box_grid *grid, const int64_t cell[3], const vn_box_entry *a,
                     const vn_box_entry *b) {
    bool first = true;
    for (int k = 0; k < grid->dim && first; k++) {
        first = cell[k] == cell_of(grid, a->low[k] > b->low[k] ? a->low[k] : b->low[k]);
    }
    return first;
}

static bool visit_all(const vn_box_grid *grid, const vn_box_entry *box, vn_box_visit_fn *visit,
                      void *payload) {
    for (int32_t at = 0; at < grid->entries.count; at++) {
        const vn_box_entry *entry = &grid->entries.data[at];
        if (overlap(entry, box) && !visit(entry->item, payload)) {
            return false;
        }
    }
    return true;
}

static bool visit_cell(const vn_box_grid *grid, const int64_t cell[3], const vn_box_entry *box,
                       vn_box_visit_fn *visit, void *payload) {
    for (int32_t at = grid->heads.data[bucket_of(grid, cell)]; at >= 0;) {
        const vn_box_entry *entry = &grid->entries.data[at];
        if (overlap(entry, box) && is_first(grid, cell, entry, box) && !visit(entry->item, payload)) {
            return false;
        }
        at = entry->next;
    }
    return true;
}

bool vn_box_grid_visit(const vn_box_grid *grid, const double low[3], const double high[3],
                       vn_box_visit_fn *visit, void *payload) {
    if (grid->entries.count == 0) {
        return true;
    }
    vn_box_entry box = entry_of(grid, 0, low, high);
    block b = block_of(grid, &box);
    if (!(b.cells <= grid->entries.count)) {
        return visit_all(grid, &box, visit, payload);
    }
    for (int32_t at = grid->large; at >= 0; at = grid->entries.data[at].next) {
        const vn_box_entry *entry = &grid->entries.data[at];
        if (overlap(entry, &box) && !visit(entry->item, payload)) {
            return false;
        }
    }
    int64_t cell[3] = {b.from[0], b.from[1], b.from[2]};
    do {
        if (!visit_cell(grid, cell, &box, visit, payload)) {
            return false;
        }
    } while (next_cell(&b, cell));
    return true;
}
