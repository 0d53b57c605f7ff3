#include "cco/darts.h"

#include "domain/domain.h"
#include "space/tube_grid.h"

// Bounds of one class are within this of one another.
static const double CLASS_RATIO = 0.9;
static const double ROOT3 = 1.7320508075688772;

typedef struct box {
    double low[3], side;
    int level;
} box;

static int children_of(const vn_darts *darts) {
    return darts->dim == 3 ? 8 : 4;
}

static double half_diagonal(const vn_darts *darts, double side) {
    return side / 2 * (darts->dim == 3 ? ROOT3 : 1.4142135623730951);
}

static double cell_volume(const vn_darts *darts, double side) {
    return darts->dim == 3 ? side * side * side : side * side;
}

static box child_box(const vn_darts *darts, const box *b, int child) {
    box c = {.side = b->side / 2, .level = b->level + 1};
    for (int k = 0; k < 3; k++) {
        c.low[k] = b->low[k] + (k < darts->dim && (child >> k & 1) ? c.side : 0);
    }
    return c;
}

static box outermost(const vn_darts *darts) {
    return (box){{darts->low[0], darts->low[1], darts->low[2]}, darts->side, 0};
}

static box box_of(const vn_darts *darts, int32_t cell) {
    int32_t way[VN_DART_LEVELS];
    int depth = 0;
    const vn_dart_cell *cells = darts->cells.data;
    for (; cells[cell].parent >= 0; cell = cells[cell].parent) {
        way[depth++] = cell - cells[cells[cell].parent].first_child;
    }
    box b = outermost(darts);
    while (depth > 0) {
        b = child_box(darts, &b, way[--depth]);
    }
    return b;
}

static void middle_of(const vn_darts *darts, const box *b, double p[3]) {
    for (int k = 0; k < 3; k++) {
        p[k] = b->low[k] + (k < darts->dim ? b->side / 2 : 0);
    }
}

static int class_of(const vn_darts *darts, double bound) {
    double span = 2 * half_diagonal(darts, darts->side);
    double class = bound > 0 ? log(bound / span) / log(CLASS_RATIO) : VN_DART_CLASSES;
    return (int)fmin(fmax(floor(class), 0), VN_DART_CLASSES - 1);
}

static vn_dart_bin *bin_of(const vn_darts *darts, int class, int level) {
    return &darts->bins[class * VN_DART_LEVELS + level];
}

static void account(vn_darts *darts, int class, const vn_dart_cell *cell, double side, double sign) {
    double volume = sign * cell_volume(darts, side);
    darts->volume[class] += volume;
    darts->mass[class] += volume * cell->mass;
}

static vn_status put(vn_darts *darts, int32_t cell, const box *b) {
    vn_dart_cell *c = &darts->cells.data[cell];
    int class = class_of(darts, c->bound);
    vn_dart_bin *bin = bin_of(darts, class, b->level);
    VN_TRY(vn_array_push(&bin->cells, cell));
    c->place = bin->cells.count - 1;
    account(darts, class, c, b->side, 1);
    return VN_OK;
}

static void take(vn_darts *darts, int32_t cell, const box *b) {
    vn_dart_cell *c = &darts->cells.data[cell];
    int class = class_of(darts, c->bound);
    vn_dart_bin *bin = bin_of(darts, class, b->level);
    int32_t last = bin->cells.data[--bin->cells.count];
    bin->cells.data[c->place] = last;
    darts->cells.data[last].place = c->place;
    c->place = -1;
    account(darts, class, c, b->side, -1);
    if (bin->cells.count == 0) { // what rounding left of the sums goes when a class is empty
        bool empty = true;
        for (int level = 0; level < VN_DART_LEVELS && empty; level++) {
            empty = bin_of(darts, class, level)->cells.count == 0;
        }
        darts->volume[class] = empty ? 0 : darts->volume[class];
        darts->mass[class] = empty ? 0 : darts->mass[class];
    }
}

static float round_up(double value) {
    return (float)(value * (1 + 1e-6));
}

static vn_status set_bound(vn_darts *darts, int32_t cell, const box *b, double bound) {
    vn_dart_cell *c = &darts->cells.data[cell];
    bool same = class_of(darts, c->bound) == class_of(darts, round_up(bound));
    if (same || c->place < 0) {
        c->bound = round_up(bound);
        return VN_OK;
    }
    take(darts, cell, b);
    c->bound = round_up(bound);
    return put(darts, cell, b);
}

static vn_status density_at(const vn_darts *darts, const double p[3], double *density) {
    *density = 0;
    if (!vn_domain_contains(darts->region, p)) {
        return VN_OK;
    }
    *density = 1;
    VN_TRY(darts->density != NULL ? darts->density(density, p, darts->payload) : VN_OK);
    if (!(*density >= 0 && *density <= 1)) {
        return vn_fail(VN_INVALID, "cco.density is %g at (%g, %g, %g); it must be between 0 and 1", *density,
                       p[0], p[1], p[2]);
    }
    return VN_OK;
}

// At the middles of 8 x 8 or 4 x 4 x 4 parts: the mean decides only how many darts count as skipped.
static vn_status measure_mass(const vn_darts *darts, const box *b, float *mass) {
    int across = darts->dim == 3 ? 4 : 8, deep = darts->dim == 3 ? 4 : 1;
    double sum = 0, middle[3];
    middle_of(darts, b, middle);
    double border = vn_domain_distance(darts->region, middle), half = half_diagonal(darts, b->side);
    *mass = border > half ? 1 : 0;
    if ((border > half && darts->density == NULL) || border < -half) {
        return VN_OK;
    }
    for (int i = 0; i < across * across * deep; i++) {
        int at[3] = {i % across, i / across % across, i / (across * across)};
        double p[3] = {0, 0, 0}, density;
        for (int k = 0; k < darts->dim; k++) {
            p[k] = b->low[k] + b->side * (at[k] + 0.5) / across;
        }
        VN_TRY(density_at(darts, p, &density));
        sum += density;
    }
    sum = fmax(sum, 0.5); // something may be there that was missed
    *mass = (float)(sum / (across * across * deep));
    return VN_OK;
}

static vn_status add_cell(vn_darts *darts, int32_t parent, const box *b, double bound) {
    int32_t at = darts->cells.count;
    vn_dart_cell cell = {parent, -1, -1, round_up(bound), 0};
    VN_TRY(measure_mass(darts, b, &cell.mass));
    VN_TRY(vn_array_push(&darts->cells, cell));
    return cell.mass > 0 ? put(darts, at, b) : VN_OK;
}

static vn_status weigh_region(vn_darts *darts, vn_rng *rng) {
    enum { SAMPLES = 4096 };
    double sum = 0, p[3], density;
    darts->mean = 1;
    darts->total = vn_domain_measure(darts->region);
    for (int i = 0; i < SAMPLES && darts->density != NULL; i++) {
        VN_TRY(vn_domain_dart(darts->region, rng, p));
        VN_TRY(density_at(darts, p, &density));
        sum += density;
    }
    if (darts->density != NULL) {
        darts->mean = sum / SAMPLES;
    }
    darts->total *= darts->mean;
    return darts->total > 0
               ? VN_OK
               : vn_fail(VN_INFEASIBLE, "cco: the density is 0 all over the region for terminals");
}

vn_status vn_darts_init(vn_darts *darts, int dim, const vn_domain *region, vn_cco_value_fn *density,
                        void *payload, vn_rng *rng) {
    vn_darts_free(darts);
    *darts = (vn_darts){.dim = dim, .region = region, .density = density, .payload = payload};
    size_t bytes = VN_DART_CLASSES * VN_DART_LEVELS * sizeof *darts->bins;
    darts->bins = vn_resize(NULL, 0, bytes);
    if (darts->bins == NULL) {
        return vn_fail_memory("cells for terminals", bytes);
    }
    memset(darts->bins, 0, bytes);
    vn_box bounds = vn_domain_bounds(region);
    for (int k = 0; k < dim; k++) {
        darts->low[k] = bounds.min[k];
        darts->side = fmax(darts->side, bounds.max[k] - bounds.min[k]);
    }
    VN_TRY(weigh_region(darts, rng));
    box b = outermost(darts);
    return add_cell(darts, -1, &b, 2 * half_diagonal(darts, darts->side));
}

void vn_darts_free(vn_darts *darts) {
    if (darts->bins != NULL) {
        for (int i = 0; i < VN_DART_CLASSES * VN_DART_LEVELS; i++) {
            vn_array_free(&darts->bins[i].cells);
        }
        vn_resize(darts->bins, VN_DART_CLASSES * VN_DART_LEVELS * sizeof *darts->bins, 0);
    }
    vn_array_free(&darts->cells);
    *darts = (vn_darts){0};
}

static double farthest(const vn_darts *darts, const box *b, const double p[3]) {
    double square = 0;
    for (int k = 0; k < darts->dim; k++) {
        double away = fmax(fabs(p[k] - b->low[k]), fabs(p[k] - b->low[k] - b->side));
        square += away * away;
    }
    return sqrt(square);
}

static vn_status divide(vn_darts *darts, int32_t cell, const box *b, const double p[3], double distance) {
    double bound = darts->cells.data[cell].bound;
    int32_t first = darts->cells.count;
    VN_TRY(vn_array_reserve(&darts->cells, (int64_t)first + children_of(darts)));
    take(darts, cell, b);
    darts->cells.data[cell].first_child = first;
    for (int i = 0; i < children_of(darts); i++) {
        box c = child_box(darts, b, i);
        VN_TRY(add_cell(darts, cell, &c, fmin(bound, distance + farthest(darts, &c, p))));
    }
    return VN_OK;
}

// A dart in this cell was in vain: what it has shown bounds the cell, or its parts. Cells much smaller than
// the threshold would show little more, and there would be many.
static vn_status learn(vn_darts *darts, int32_t cell, const double p[3], double distance, double threshold) {
    box b = box_of(darts, cell);
    double bound = fmin(darts->cells.data[cell].bound, distance + farthest(darts, &b, p));
    if (bound > threshold && half_diagonal(darts, b.side) > 0.8 * threshold && b.level < VN_DART_LEVELS - 1) {
        return divide(darts, cell, &b, p, distance);
    }
    return set_bound(darts, cell, &b, bound);
}

// Of the classes that reach above the threshold, a leaf at random, as likely as it is large.
static int32_t pick(const vn_darts *darts, int last, double volume, vn_rng *rng) {
    double at = vn_rng_uniform(rng, 0, volume);
    int32_t found = -1;
    for (int class = 0; class <= last; class ++) {
        if (at >= darts->volume[class]) {
            at -= darts->volume[class];
            continue;
        }
        double side = darts->side;
        for (int level = 0; level < VN_DART_LEVELS; level++, side /= 2) {
            const vn_dart_bin *bin = bin_of(darts, class, level);
            double one = cell_volume(darts, side), all = one * bin->cells.count;
            if (bin->cells.count > 0) {
                int32_t i = (int32_t)fmin(floor(at / one), bin->cells.count - 1);
                found = bin->cells.data[i];
            }
            if (at < all) {
                return found;
            }
            at -= all;
        }
        return found; // rounding
    }
    return found;
}

static void point_in(const vn_darts *darts, int32_t cell, vn_rng *rng, double p[3]) {
    box b = box_of(darts, cell);
    for (int k = 0; k < 3; k++) {
        p[k] = k < darts->dim ? vn_rng_uniform(rng, b.low[k], b.low[k] + b.side) : 0;
    }
}

/// What may still be hit at a threshold.
typedef struct live {
    int last; ///< class
    double mass, volume;
} live;

static live live_above(const vn_darts *darts, double threshold) {
    live l = {.last = class_of(darts, threshold)};
    for (int class = 0; class <= l.last; class ++) {
        l.mass += darts->mass[class];
        l.volume += darts->volume[class];
    }
    return l;
}

// Darts in vain before one falls into live cells: geometrically distributed.
static double skipped(const vn_darts *darts, const live *l, vn_rng *rng) {
    double part = l->mass / darts->total;
    if (part >= 1) {
        return 0;
    }
    return part <= 0 || l->volume <= 0 ? INFINITY : floor(log1p(-vn_rng_uniform(rng, 0, 1)) / log1p(-part));
}

// One dart into live cells that lands in the region.
static vn_status land(vn_darts *darts, const live *l, vn_rng *rng, int32_t *cell, double p[3]) {
    enum { MOST = 100000 };
    for (int i = 0; i < MOST; i++) {
        double density;
        *cell = pick(darts, l->last, l->volume, rng);
        if (*cell < 0) {
            return VN_OK;
        }
        point_in(darts, *cell, rng, p);
        VN_TRY(density_at(darts, p, &density));
        if (density > 0 && (density >= 1 || vn_rng_uniform(rng, 0, 1) < density)) {
            return VN_OK;
        }
    }
    *cell = -1;
    return VN_OK;
}

// Where terminals are sparse they are farther apart.
static vn_status local_threshold(const vn_darts *darts, const double p[3], double *threshold) {
    double density;
    if (darts->density != NULL) {
        VN_TRY(density_at(darts, p, &density));
        *threshold *= pow(darts->mean / density, 1.0 / darts->dim);
    }
    return VN_OK;
}

// The lowest threshold that is in force anywhere while it is @p threshold on average.
static double lowest(const vn_darts *darts, double threshold) {
    return threshold * pow(darts->mean, 1.0 / darts->dim);
}

vn_status vn_darts_throw(vn_darts *darts, const vn_dart_search *search, vn_rng *rng, double p[3],
                         int64_t *darts_thrown) {
    double threshold = search->threshold, thrown = 0;
    while (threshold > 1e-6 * darts->side) {
        live l = live_above(darts, lowest(darts, threshold));
        thrown += skipped(darts, &l, rng) + 1;
        if (thrown > search->tries) {
            *darts_thrown += search->tries;
            threshold *= search->factor;
            thrown = 0;
            continue;
        }
        int32_t cell;
        double here = threshold;
        VN_TRY(land(darts, &l, rng, &cell, p));
        if (cell < 0) {
            continue;
        }
        VN_TRY(local_threshold(darts, p, &here));
        double distance = search->distance(p, search->payload);
        if (distance > here && !search->refuse(p, search->payload)) {
            *darts_thrown += (int64_t)thrown;
            return VN_OK;
        }
        VN_TRY(learn(darts, cell, p, distance, lowest(darts, threshold)));
    }
    return vn_fail(VN_INFEASIBLE, "there is no room left between the vessels");
}

/// Segments that were added.
typedef struct news {
    const double (*ends)[2][3];
    int32_t count;
    double moved;
} news;

static vn_status spread(vn_darts *darts, int32_t cell, const box *b, const news *n) {
    vn_dart_cell *c = &darts->cells.data[cell];
    double middle[3], half = half_diagonal(darts, b->side), nearest = INFINITY;
    middle_of(darts, b, middle);
    for (int32_t i = 0; i < n->count; i++) {
        double square = vn_point_segment_distance2(middle, n->ends[i][0], n->ends[i][1]);
        nearest = fmin(nearest, square);
    }
    nearest = sqrt(nearest);
    if (nearest - half - n->moved > c->bound) {
        return VN_OK; // another vessel is nearer to all of it
    }
    if (c->first_child < 0) {
        return set_bound(darts, cell, b, fmin(c->bound + n->moved, nearest + half));
    }
    float bound = 0;
    int32_t first = c->first_child;
    for (int i = 0; i < children_of(darts); i++) {
        box child = child_box(darts, b, i);
        VN_TRY(spread(darts, first + i, &child, n));
        bound = fmaxf(bound, darts->cells.data[first + i].bound);
    }
    darts->cells.data[cell].bound = bound;
    return VN_OK;
}

vn_status vn_darts_tell(vn_darts *darts, const double (*ends)[2][3], int32_t count, double moved) {
    news n = {ends, count, moved};
    box b = outermost(darts);
    return darts->cells.count > 0 ? spread(darts, 0, &b, &n) : VN_OK;
}
