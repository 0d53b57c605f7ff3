#include "space/point_grid.h"

// Cells beyond this are merged into the outermost one, so that huge coordinates cannot overflow an integer.
static const double FARTHEST_CELL = 1e15;

static int64_t cell_of(const vn_point_grid *grid, double coordinate) {
    double cell = coordinate / grid->cell;
    if (!(cell > -FARTHEST_CELL && cell < FARTHEST_CELL)) {
        return cell > 0 ? (int64_t)FARTHEST_CELL : -(int64_t)FARTHEST_CELL;
    }
    int64_t whole = (int64_t)cell; // toward 0; floor() and fmin() are calls on plain x86-64
    return whole - (cell < (double)whole);
}

static void cells_of(const vn_point_grid *grid, const double p[3], int64_t cell[3]) {
    cell[2] = 0;
    for (int k = 0; k < grid->dim; k++) {
        cell[k] = cell_of(grid, p[k]);
    }
}

static uint32_t bucket_of(const vn_point_grid *grid, int64_t i, int64_t j, int64_t k) {
    uint64_t h = (uint64_t)i * 0x9E3779B97F4A7C15u ^ (uint64_t)j * 0xC2B2AE3D27D4EB4Fu ^
                 (uint64_t)k * 0x165667B19E3779F9u;
    h ^= h >> 29;
    h *= 0xBF58476D1CE4E5B9u;
    return (uint32_t)(h >> 32) & (uint32_t)(grid->heads.count - 1);
}

void vn_point_grid_init(vn_point_grid *grid, int dim, double cell) {
    *grid = (vn_point_grid){.dim = dim, .cell = cell};
}

void vn_point_grid_free(vn_point_grid *grid) {
    vn_array_free(&grid->heads);
    vn_array_free(&grid->next);
}

static void link_point(vn_point_grid *grid, const vn_points *points, int32_t point) {
    double p[3];
    int64_t cell[3] = {0};
    vn_points_get(points, point, p);
    cells_of(grid, p, cell);
    uint32_t bucket = bucket_of(grid, cell[0], cell[1], cell[2]);
    grid->next.data[point] = grid->heads.data[bucket];
    grid->heads.data[bucket] = point;
    for (int k = 0; k < 3; k++) {
        grid->low[k] = point == 0 || cell[k] < grid->low[k] ? cell[k] : grid->low[k];
        grid->high[k] = point == 0 || cell[k] > grid->high[k] ? cell[k] : grid->high[k];
    }
}

static vn_status make_buckets(vn_point_grid *grid, int32_t count) {
    int64_t buckets = 64;
    while (buckets < count && buckets < (1 << 30)) {
        buckets *= 2;
    }
    if (buckets <= grid->heads.count) {
        return VN_OK;
    }
    VN_TRY(vn_array_reserve(&grid->heads, buckets));
    grid->heads.count = (int32_t)buckets;
    for (int64_t b = 0; b < buckets; b++) {
        grid->heads.data[b] = -1;
    }
    grid->next.count = 0; // all points are linked anew
    return VN_OK;
}

vn_status vn_point_grid_update(vn_point_grid *grid, const vn_points *points, int32_t count) {
    VN_TRY(vn_array_reserve(&grid->next, count));
    VN_TRY(make_buckets(grid, count));
    for (int32_t i = grid->next.count; i < count; i++) {
        link_point(grid, points, i);
    }
    grid->next.count = count > grid->next.count ? count : grid->next.count;
    return VN_OK;
}

// A box of cells, clipped to those in use.
typedef struct cell_box {
    int64_t low[3], high[3];
    bool empty;
} cell_box;

static cell_box clip_box(const vn_point_grid *grid, const int64_t low[3], const int64_t high[3]) {
    cell_box box = {.empty = grid->next.count == 0};
    for (int k = 0; k < 3; k++) {
        box.low[k] = low[k] > grid->low[k] ? low[k] : grid->low[k];
        box.high[k] = high[k] < grid->high[k] ? high[k] : grid->high[k];
        box.empty = box.empty || box.low[k] > box.high[k];
    }
    return box;
}

static cell_box box_around(const vn_point_grid *grid, const double p[3], double radius) {
    int64_t low[3] = {0}, high[3] = {0};
    for (int k = 0; k < grid->dim; k++) {
        low[k] = cell_of(grid, p[k] - radius);
        high[k] = cell_of(grid, p[k] + radius);
    }
    return clip_box(grid, low, high);
}

static double cells_in(const cell_box *box) {
    double cells = 1;
    for (int k = 0; k < 3; k++) {
        cells *= (double)(box->high[k] - box->low[k] + 1);
    }
    return cells;
}

typedef struct walk {
    const vn_point_grid *grid;
    const vn_points *points;
    const double *p;
    vn_nearest *query;
} walk;

// Something to ask of every point of a cell; true ends the walk. Walks are compiled for each question: a call
// for every point takes a third of their time.
typedef bool ask_fn(walk *w, int32_t point);
#define EACH static inline __attribute__((always_inline))

// Buckets are shared between cells: a point is asked only from a bucket, wherever it lies, since every
// question tests the distance itself; asking twice does not change an answer.
EACH bool ask_cell(walk *w, ask_fn *ask, int64_t i, int64_t j, int64_t k) {
    uint32_t bucket = bucket_of(w->grid, i, j, k);
    for (int32_t point = w->grid->heads.data[bucket]; point >= 0; point = w->grid->next.data[point]) {
        if (ask(w, point)) {
            return true;
        }
    }
    return false;
}

EACH bool ask_all(walk *w, ask_fn *ask) {
    for (int32_t point = 0; point < w->grid->next.count; point++) {
        if (ask(w, point)) {
            return true;
        }
    }
    return false;
}

EACH bool ask_box(walk *w, ask_fn *ask, const cell_box *box) {
    if (box->empty) {
        return false;
    }
    if (cells_in(box) > w->grid->next.count) {
        return ask_all(w, ask);
    }
    for (int64_t k = box->low[2]; k <= box->high[2]; k++) {
        for (int64_t j = box->low[1]; j <= box->high[1]; j++) {
            for (int64_t i = box->low[0]; i <= box->high[0]; i++) {
                if (ask_cell(w, ask, i, j, k)) {
                    return true;
                }
            }
        }
    }
    return false;
}

static bool accepted(const vn_nearest *query, int32_t point) {
    return query->accept == NULL || query->accept(point, query->payload);
}

EACH bool ask_within(walk *w, int32_t point) {
    double d2 = vn_points_distance2(w->points, point, w->p);
    if (d2 < w->query->reach2 && accepted(w->query, point)) {
        w->query->point = point;
        return true;
    }
    return false;
}

int32_t vn_point_grid_any_within(const vn_point_grid *grid, const vn_points *points, const double p[3],
                                 double radius, vn_point_accept_fn *accept, void *payload) {
    vn_nearest query = {.reach2 = radius * radius, .point = -1, .accept = accept, .payload = payload};
    walk w = {grid, points, p, &query};
    int64_t centre[3] = {0};
    cells_of(grid, p, centre);
    // Where most askers have a neighbour, they have one in their own cell.
    if (grid->next.count == 0 || !ask_cell(&w, ask_within, centre[0], centre[1], centre[2])) {
        cell_box box = box_around(grid, p, radius);
        ask_box(&w, ask_within, &box);
    }
    return query.point;
}

EACH bool ask_nearest(walk *w, int32_t point) {
    vn_nearest *query = w->query;
    double d2 = vn_points_distance2(w->points, point, w->p);
    bool nearer = d2 < query->reach2;
    if (!nearer && d2 == query->reach2 && point != query->point) {
        nearer = query->point < 0 || vn_ranks_before(query->seed, query->id, point, query->point);
    }
    if (nearer && accepted(query, point)) {
        query->reach2 = d2;
        query->point = point;
    }
    return query->stop;
}

// The faces of a cube of cells around the centre, `ring` cells away: what is new since the last ring.
static bool ask_ring(walk *w, const int64_t centre[3], int64_t ring) {
    const vn_point_grid *grid = w->grid;
    for (int axis = 0; axis < grid->dim; axis++) {
        for (int side = -1; side <= 1; side += 2) {
            int64_t low[3] = {0}, high[3] = {0};
            for (int k = 0; k < grid->dim; k++) {
                int64_t reach = k < axis ? ring - 1 : ring; // edges belong to the first axis only
                low[k] = k == axis ? centre[k] + side * ring : centre[k] - reach;
                high[k] = k == axis ? low[k] : centre[k] + reach;
            }
            cell_box box = clip_box(grid, low, high);
            if (ask_box(w, ask_nearest, &box)) {
                return true;
            }
        }
    }
    return false;
}

// How many rings the centre lies below the cells @p low, or above the cells @p high, on the axis where that
// is most.
static int64_t rings_to(const vn_point_grid *grid, const int64_t centre[3], const int64_t low[3],
                        const int64_t high[3]) {
    int64_t ring = 0;
    for (int k = 0; k < grid->dim; k++) {
        int64_t below = low[k] - centre[k];
        int64_t above = centre[k] - high[k];
        ring = below > ring ? below : ring;
        ring = above > ring ? above : ring;
    }
    return ring;
}

void vn_point_grid_nearest(const vn_point_grid *grid, const vn_points *points, const double p[3],
                           vn_nearest *query) {
    query->point = -1;
    if (grid->next.count == 0) {
        return;
    }
    walk w = {grid, points, p, query};
    int64_t centre[3] = {0};
    cells_of(grid, p, centre);
    int64_t last = rings_to(grid, centre, grid->high, grid->low);
    double asked = 0;
    for (int64_t ring = rings_to(grid, centre, grid->low, grid->high); ring <= last; ring++) {
        double nearest = (double)(ring - 1) * grid->cell; // a point of this ring is at least this far away
        if (ring > 0 && nearest > 0 && nearest * nearest > query->reach2) {
            return;
        }
        asked += grid->dim == 3 ? 24.0 * (double)ring * (double)ring + 1 : 8.0 * (double)ring + 1;
        if (asked > 4.0 * grid->next.count + 64) {
            ask_all(&w, ask_nearest); // sparse: walking empty cells costs more than asking everybody
            return;
        }
        bool stopped = ring == 0 ? ask_cell(&w, ask_nearest, centre[0], centre[1], centre[2])
                                 : ask_ring(&w, centre, ring);
        if (stopped) {
            return;
        }
    }
}
