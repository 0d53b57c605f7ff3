#include "space/tube_grid.h"

#include "space/points.h"

enum { MOST_CELLS = 1 << 27 };

// Wider than rounding may shift where an axis passes from one cell to the next.
static const double SLACK = 1e-9;

static void choose_cells(vn_tube_grid *grid, const double extent[3], int32_t cells) {
    double measure = 1, longest = 0;
    int flat = 0;
    for (int k = 0; k < 3; k++) {
        longest = fmax(longest, extent[k]);
    }
    longest = longest > 0 ? longest : 1;
    for (int k = 0; k < 3; k++) { // a side that hardly is one counts as a cell thick
        flat += extent[k] < 1e-3 * longest;
        measure *= extent[k] < 1e-3 * longest ? 1 : extent[k];
    }
    double wanted = cells < 1 ? 1 : cells < MOST_CELLS / 8 ? cells : MOST_CELLS / 8;
    grid->cell = pow(measure / wanted, 1.0 / (flat < 3 ? 3 - flat : 1));
    for (int k = 0; k < 3; k++) {
        grid->size[k] = (int32_t)fmin(floor(extent[k] / grid->cell), 1e6) + 1;
    }
}

vn_status vn_tube_grid_init(vn_tube_grid *grid, int dim, const double low[3], const double high[3],
                            int32_t cells) {
    double extent[3] = {high[0] - low[0], high[1] - low[1], dim == 3 ? high[2] - low[2] : 0};
    grid->dim = dim;
    grid->entries.count = 0;
    grid->spare = -1;
    memcpy(grid->low, low, sizeof grid->low);
    choose_cells(grid, extent, cells);
    int64_t count = (int64_t)grid->size[0] * grid->size[1] * grid->size[2];
    VN_TRY(vn_array_reserve(&grid->heads, count));
    grid->heads.count = (int32_t)count;
    for (int64_t c = 0; c < count; c++) {
        grid->heads.data[c] = -1;
    }
    return VN_OK;
}

void vn_tube_grid_free(vn_tube_grid *grid) {
    vn_array_free(&grid->heads);
    vn_array_free(&grid->entries);
    *grid = (vn_tube_grid){.spare = -1};
}

static int32_t cell_of(const vn_tube_grid *grid, int k, double coordinate) {
    double cell = floor((coordinate - grid->low[k]) / grid->cell);
    return (int32_t)fmin(fmax(cell, 0), grid->size[k] - 1);
}

/// What is done in each cell that an axis passes.
typedef vn_status cell_fn(vn_tube_grid *grid, int32_t cell, int32_t tube);

typedef struct walk {
    vn_tube_grid *grid;
    const double *a, *b;
    int32_t tube;
    cell_fn *work;
} walk;

static double along(double a, double b, double t) {
    return a + t * (b - a);
}

// The part of [*from, *to] of the axis that lies in layer `cell` of direction k, a little too much.
static void clip(const walk *w, int k, int32_t cell, double *from, double *to) {
    const vn_tube_grid *g = w->grid;
    double rise = w->b[k] - w->a[k];
    if (fabs(rise) <= SLACK * g->cell) {
        return;
    }
    double low = g->low[k] + cell * g->cell, high = low + g->cell;
    double t0 = (low - w->a[k]) / rise, t1 = (high - w->a[k]) / rise;
    double enter = fmin(t0, t1), leave = fmax(t0, t1);
    bool first = cell == 0, last = cell == g->size[k] - 1; // these hold what lies beyond
    bool rising = rise > 0;
    *from = (rising ? first : last) ? *from : fmax(*from, enter - SLACK);
    *to = (rising ? last : first) ? *to : fmin(*to, leave + SLACK);
}

static vn_status walk_cells(const walk *w, int k, int32_t base, double from, double to) {
    vn_tube_grid *g = w->grid;
    double s = along(w->a[k], w->b[k], from), e = along(w->a[k], w->b[k], to);
    double slack = SLACK * (g->cell + fabs(s) + fabs(e));
    int32_t first = cell_of(g, k, fmin(s, e) - slack), last = cell_of(g, k, fmax(s, e) + slack);
    for (int32_t c = first; c <= last; c++) {
        int32_t cell = base * g->size[k] + c;
        if (k == 0) {
            VN_TRY(w->work(g, cell, w->tube));
            continue;
        }
        double t0 = from, t1 = to;
        clip(w, k, c, &t0, &t1);
        VN_TRY(walk_cells(w, k - 1, cell, t0, t1 < t0 ? t0 : t1));
    }
    return VN_OK;
}

static vn_status list(vn_tube_grid *grid, int32_t cell, int32_t tube) {
    int32_t at = grid->spare;
    if (at >= 0) {
        grid->spare = grid->entries.data[at].next;
    } else {
        VN_TRY(vn_array_reserve_tightly(&grid->entries, (int64_t)grid->entries.count + 1));
        at = grid->entries.count++;
    }
    grid->entries.data[at] = (vn_tube_entry){tube, grid->heads.data[cell]};
    grid->heads.data[cell] = at;
    return VN_OK;
}

static vn_status unlist(vn_tube_grid *grid, int32_t cell, int32_t tube) {
    for (int32_t *link = &grid->heads.data[cell]; *link >= 0; link = &grid->entries.data[*link].next) {
        int32_t at = *link;
        if (grid->entries.data[at].tube == tube) {
            *link = grid->entries.data[at].next;
            grid->entries.data[at].next = grid->spare;
            grid->spare = at;
            return VN_OK;
        }
    }
    return VN_OK;
}

vn_status vn_tube_grid_insert(vn_tube_grid *grid, int32_t tube, const double a[3], const double b[3]) {
    walk w = {grid, a, b, tube, list};
    return walk_cells(&w, grid->dim - 1, 0, 0, 1);
}

void vn_tube_grid_remove(vn_tube_grid *grid, int32_t tube, const double a[3], const double b[3]) {
    walk w = {grid, a, b, tube, unlist};
    (void)walk_cells(&w, grid->dim - 1, 0, 0, 1); // takes no memory, so it cannot fail
}

static bool visit_cell(const vn_tube_grid *grid, int32_t cell, vn_tube_visit_fn *visit, void *payload) {
    for (int32_t at = grid->heads.data[cell]; at >= 0; at = grid->entries.data[at].next) {
        if (!visit(grid->entries.data[at].tube, payload)) {
            return false;
        }
    }
    return true;
}

static bool visit_row(const vn_tube_grid *grid, int32_t first, int32_t last, vn_tube_visit_fn *visit,
                      void *payload) {
    for (int32_t cell = first; cell <= last; cell++) {
        if (!visit_cell(grid, cell, visit, payload)) {
            return false;
        }
    }
    return true;
}

bool vn_tube_grid_visit(const vn_tube_grid *grid, const double low[3], const double high[3],
                        vn_tube_visit_fn *visit, void *payload) {
    int32_t from[3] = {0}, to[3] = {0};
    for (int k = 0; k < grid->dim; k++) {
        from[k] = cell_of(grid, k, low[k]);
        to[k] = cell_of(grid, k, high[k]);
    }
    for (int32_t z = from[2]; z <= to[2]; z++) {
        for (int32_t y = from[1]; y <= to[1]; y++) {
            int32_t row = (z * grid->size[1] + y) * grid->size[0];
            if (!visit_row(grid, row + from[0], row + to[0], visit, payload)) {
                return false;
            }
        }
    }
    return true;
}

/// The block of cells that are at most `ring` away from a point's own, cut to the grid.
typedef struct block {
    int32_t middle[3], from[3], to[3];
} block;

static block block_of(const vn_tube_grid *grid, const double p[3], int32_t ring) {
    block b = {0};
    for (int k = 0; k < grid->dim; k++) {
        b.middle[k] = cell_of(grid, k, p[k]);
        b.from[k] = b.middle[k] - ring > 0 ? b.middle[k] - ring : 0;
        b.to[k] = b.middle[k] + ring < grid->size[k] - 1 ? b.middle[k] + ring : grid->size[k] - 1;
    }
    return b;
}

static double reach_of(const vn_tube_grid *grid, const double p[3], const block *b) {
    double reach = INFINITY;
    for (int k = 0; k < grid->dim; k++) {
        double low = grid->low[k] + b->from[k] * grid->cell;
        double high = grid->low[k] + (b->to[k] + 1) * grid->cell;
        reach = b->from[k] > 0 ? fmin(reach, p[k] - low) : reach;
        reach = b->to[k] < grid->size[k] - 1 ? fmin(reach, high - p[k]) : reach;
    }
    return reach - SLACK * grid->cell;
}

static bool on_ring(int32_t cell, int32_t middle, int32_t ring) {
    return cell == middle - ring || cell == middle + ring;
}

double vn_tube_grid_visit_ring(const vn_tube_grid *grid, const double p[3], int32_t ring,
                               vn_tube_visit_fn *visit, void *payload) {
    block b = block_of(grid, p, ring);
    bool all = true;
    for (int32_t z = b.from[2]; all && z <= b.to[2]; z++) {
        for (int32_t y = b.from[1]; all && y <= b.to[1]; y++) {
            int32_t row = (z * grid->size[1] + y) * grid->size[0];
            bool face = on_ring(y, b.middle[1], ring) || (grid->dim == 3 && on_ring(z, b.middle[2], ring));
            if (face) {
                all = visit_row(grid, row + b.from[0], row + b.to[0], visit, payload);
                continue;
            }
            if (b.middle[0] - ring >= 0) {
                all = visit_cell(grid, row + b.middle[0] - ring, visit, payload);
            }
            if (all && ring > 0 && b.middle[0] + ring < grid->size[0]) {
                all = visit_cell(grid, row + b.middle[0] + ring, visit, payload);
            }
        }
    }
    return reach_of(grid, p, &b);
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double vn_point_segment_distance2(const double p[3], const double a[3], const double b[3]) {
    double ab[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    double ap[3] = {p[0] - a[0], p[1] - a[1], p[2] - a[2]};
    double square = dot(ab, ab);
    double t = square > 0 ? fmin(fmax(dot(ap, ab) / square, 0), 1) : 0;
    double q[3] = {a[0] + t * ab[0], a[1] + t * ab[1], a[2] + t * ab[2]};
    return vn_distance2(p, q);
}

// Where the lines come nearest, if that is within both segments; otherwise an end is nearest.
static double between_inner_points2(const double a[3], const double b[3], const double c[3],
                                    const double d[3]) {
    double u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, v[3] = {d[0] - c[0], d[1] - c[1], d[2] - c[2]};
    double w[3] = {a[0] - c[0], a[1] - c[1], a[2] - c[2]};
    double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
    double determinant = uu * vv - uv * uv;
    if (!(determinant > 1e-14 * uu * vv)) {
        return INFINITY;
    }
    double s = (uv * vw - vv * uw) / determinant, t = (uu * vw - uv * uw) / determinant;
    if (s < 0 || s > 1 || t < 0 || t > 1) {
        return INFINITY;
    }
    double p[3], q[3];
    for (int k = 0; k < 3; k++) {
        p[k] = a[k] + s * u[k];
        q[k] = c[k] + t * v[k];
    }
    return vn_distance2(p, q);
}

double vn_segment_segment_distance2(const double a[3], const double b[3], const double c[3],
                                    const double d[3]) {
    double ends = fmin(fmin(vn_point_segment_distance2(a, c, d), vn_point_segment_distance2(b, c, d)),
                       fmin(vn_point_segment_distance2(c, a, b), vn_point_segment_distance2(d, a, b)));
    return fmin(ends, between_inner_points2(a, b, c, d));
}
