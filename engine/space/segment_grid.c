#include "space/segment_grid.h"

#include "space/points.h"

void vn_segment_grid_free(vn_segment_grid *grid) {
    vn_array_free(&grid->segments);
    vn_array_free(&grid->starts);
    vn_array_free(&grid->items);
    grid->columns = grid->rows = 0;
}

// Rounded down. Not by fmin(), fmax() and floor(), which are calls: every step of a vein asks four times.
static int32_t clamp_cell(double cell, int32_t cells) {
    double last = cells - 1;
    return cell > 0 ? (int32_t)(cell < last ? cell : last) : 0;
}

typedef struct cell_range {
    int32_t x0, x1, y0, y1;
} cell_range;

static cell_range range_of(const vn_segment_grid *grid, double min_x, double min_y, double max_x,
                           double max_y) {
    return (cell_range){
        clamp_cell((min_x - grid->min_x) / grid->cell, grid->columns),
        clamp_cell((max_x - grid->min_x) / grid->cell, grid->columns),
        clamp_cell((min_y - grid->min_y) / grid->cell, grid->rows),
        clamp_cell((max_y - grid->min_y) / grid->cell, grid->rows),
    };
}

static double size_of(const vn_segment_grid *grid) {
    return grid->cell * (grid->columns > grid->rows ? grid->columns : grid->rows);
}

// The cells of the columns [range.x0, range.x1] that the segment passes: per column the span of y, one cell
// wider on either side than arithmetic can err.
static cell_range column_range(const vn_segment_grid *grid, const vn_segment *s, int32_t column) {
    // An edge that is all but upright turns a rounding of its column's sides into any length along it.
    double slack = 1e-9 * grid->cell + 1e-15 * (fabs(grid->min_x) + fabs(grid->min_y) + size_of(grid));
    double left = grid->min_x + column * grid->cell - slack;
    double right = grid->min_x + (column + 1) * grid->cell + slack;
    double dx = s->x1 - s->x0;
    double t0 = dx != 0 ? (left - s->x0) / dx : 0;
    double t1 = dx != 0 ? (right - s->x0) / dx : 1;
    double a = fmin(fmax(fmin(t0, t1), 0), 1);
    double b = fmin(fmax(fmax(t0, t1), 0), 1);
    double ya = s->y0 + a * (s->y1 - s->y0);
    double yb = s->y0 + b * (s->y1 - s->y0);
    cell_range range = range_of(grid, left, fmin(ya, yb) - slack, right, fmax(ya, yb) + slack);
    range.x0 = range.x1 = column;
    return range;
}

static cell_range segment_columns(const vn_segment_grid *grid, const vn_segment *s) {
    return range_of(grid, fmin(s->x0, s->x1), fmin(s->y0, s->y1), fmax(s->x0, s->x1), fmax(s->y0, s->y1));
}

// Counts into starts (fill == NULL) or places the segment at fill[cell]++.
static void spread_segment(vn_segment_grid *grid, int32_t segment, int32_t *fill) {
    const vn_segment *s = &grid->segments.data[segment];
    cell_range all = segment_columns(grid, s);
    for (int32_t column = all.x0; column <= all.x1; column++) {
        cell_range range = column_range(grid, s, column);
        for (int32_t row = range.y0; row <= range.y1; row++) {
            int32_t cell = row * grid->columns + column;
            if (fill == NULL) {
                grid->starts.data[cell + 1]++;
            } else {
                grid->items.data[fill[cell]++] = segment;
            }
        }
    }
}

static void choose_cells(vn_segment_grid *grid) {
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int32_t i = 0; i < grid->segments.count; i++) {
        const vn_segment *s = &grid->segments.data[i];
        low[0] = fmin(low[0], fmin(s->x0, s->x1));
        low[1] = fmin(low[1], fmin(s->y0, s->y1));
        high[0] = fmax(high[0], fmax(s->x0, s->x1));
        high[1] = fmax(high[1], fmax(s->y0, s->y1));
    }
    // About as many cells as segments: an outline then leaves most cells empty, and a step crosses few of
    // them.
    double size = fmax(high[0] - low[0], high[1] - low[1]);
    int32_t across = clamp_cell(ceil(sqrt(4.0 * grid->segments.count)), 2048) + 1;
    grid->min_x = low[0];
    grid->min_y = low[1];
    grid->cell = size > 0 ? size / across : 1;
    grid->columns = clamp_cell((high[0] - low[0]) / grid->cell, across + 1) + 1;
    grid->rows = clamp_cell((high[1] - low[1]) / grid->cell, across + 1) + 1;
}

vn_status vn_segment_grid_build(vn_segment_grid *grid) {
    if (grid->segments.count == 0) {
        return VN_OK;
    }
    choose_cells(grid);
    int32_t cells = grid->columns * grid->rows;
    VN_TRY(vn_array_zero(&grid->starts, (int64_t)cells + 1));
    for (int32_t i = 0; i < grid->segments.count; i++) {
        spread_segment(grid, i, NULL);
    }
    for (int32_t c = 0; c < cells; c++) {
        if (grid->starts.data[c + 1] > INT32_MAX - grid->starts.data[c]) {
            return vn_fail(VN_LIMIT, "%d segments are too long for their number", grid->segments.count);
        }
        grid->starts.data[c + 1] += grid->starts.data[c];
    }
    VN_TRY(vn_array_zero(&grid->items, grid->starts.data[cells]));
    VN_ARRAY(int32_t) fill = {0};
    VN_TRY(vn_array_reserve(&fill, cells));
    for (int32_t c = 0; c < cells; c++) {
        fill.data[c] = grid->starts.data[c];
    }
    for (int32_t i = 0; i < grid->segments.count; i++) {
        spread_segment(grid, i, fill.data);
    }
    vn_array_free(&fill);
    return VN_OK;
}

bool vn_segment_grid_visit(const vn_segment_grid *grid, double min_x, double min_y, double max_x,
                           double max_y, vn_segment_visit_fn *visit, void *payload) {
    if (grid->columns == 0) {
        return true;
    }
    cell_range range = range_of(grid, min_x, min_y, max_x, max_y);
    for (int32_t row = range.y0; row <= range.y1; row++) {
        for (int32_t column = range.x0; column <= range.x1; column++) {
            int32_t cell = row * grid->columns + column;
            for (int32_t i = grid->starts.data[cell]; i < grid->starts.data[cell + 1]; i++) {
                if (!visit(grid->items.data[i], payload)) {
                    return false;
                }
            }
        }
    }
    return true;
}

static double nearest_on(const vn_segment *s, double x, double y, double q[2]) {
    double dx = s->x1 - s->x0;
    double dy = s->y1 - s->y0;
    double length2 = dx * dx + dy * dy;
    double t = length2 > 0 ? ((x - s->x0) * dx + (y - s->y0) * dy) / length2 : 0;
    t = fmin(fmax(t, 0), 1);
    q[0] = s->x0 + t * dx;
    q[1] = s->y0 + t * dy;
    return (x - q[0]) * (x - q[0]) + (y - q[1]) * (y - q[1]);
}

typedef struct nearest_search {
    const vn_segment_grid *grid;
    double x, y;
    int32_t best;
    double distance2;
    double q[2];
} nearest_search;

static void try_cell(nearest_search *search, int32_t column, int32_t row) {
    const vn_segment_grid *grid = search->grid;
    if (column < 0 || row < 0 || column >= grid->columns || row >= grid->rows) {
        return;
    }
    int32_t cell = row * grid->columns + column;
    for (int32_t i = grid->starts.data[cell]; i < grid->starts.data[cell + 1]; i++) {
        int32_t segment = grid->items.data[i];
        double q[2];
        double d2 = nearest_on(&grid->segments.data[segment], search->x, search->y, q);
        if (d2 < search->distance2 || (d2 == search->distance2 && segment < search->best)) {
            search->best = segment;
            search->distance2 = d2;
            search->q[0] = q[0];
            search->q[1] = q[1];
        }
    }
}

static void try_ring(nearest_search *search, int32_t column, int32_t row, int32_t ring) {
    for (int32_t i = -ring; i <= ring; i++) {
        try_cell(search, column + i, row - ring);
        if (ring > 0) {
            try_cell(search, column + i, row + ring);
        }
    }
    for (int32_t j = 1 - ring; j < ring; j++) {
        try_cell(search, column - ring, row + j);
        try_cell(search, column + ring, row + j);
    }
}

int32_t vn_segment_grid_nearest(const vn_segment_grid *grid, double x, double y, double *distance2,
                                double q[2]) {
    nearest_search search = {grid, x, y, -1, INFINITY, {0, 0}};
    if (grid->columns > 0) {
        int32_t column = clamp_cell((x - grid->min_x) / grid->cell, grid->columns);
        int32_t row = clamp_cell((y - grid->min_y) / grid->cell, grid->rows);
        // From a point outside the grid, rings are counted from the nearest cell: a ring's cells are then at
        // least (ring - 1) cells away from the point too.
        int32_t last = grid->columns > grid->rows ? grid->columns : grid->rows;
        for (int32_t ring = 0; ring <= last; ring++) {
            double least = (ring - 1) * grid->cell;
            if (ring > 0 && least > 0 && least * least > search.distance2) {
                break;
            }
            try_ring(&search, column, row, ring);
        }
    }
    *distance2 = search.distance2;
    q[0] = search.q[0];
    q[1] = search.q[1];
    return search.best;
}

static bool within(double a, double b, double value) {
    return a <= b ? a <= value && value <= b : b <= value && value <= a;
}

// c lies on the line through s; is it on s?
static bool on_segment(const vn_segment *s, double x, double y) {
    return within(s->x0, s->x1, x) && within(s->y0, s->y1, y);
}

bool vn_segments_touch(const vn_segment *s, const vn_segment *t) {
    double a = vn_turn(s->x0, s->y0, s->x1, s->y1, t->x0, t->y0);
    double b = vn_turn(s->x0, s->y0, s->x1, s->y1, t->x1, t->y1);
    double c = vn_turn(t->x0, t->y0, t->x1, t->y1, s->x0, s->y0);
    double d = vn_turn(t->x0, t->y0, t->x1, t->y1, s->x1, s->y1);
    if (((a > 0 && b < 0) || (a < 0 && b > 0)) && ((c > 0 && d < 0) || (c < 0 && d > 0))) {
        return true;
    }
    return (a == 0 && on_segment(s, t->x0, t->y0)) || (b == 0 && on_segment(s, t->x1, t->y1)) ||
           (c == 0 && on_segment(t, s->x0, s->y0)) || (d == 0 && on_segment(t, s->x1, s->y1));
}
