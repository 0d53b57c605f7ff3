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

// The same numbers as box_of() gives: the sides are powers of two of one another.
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

static box box_of(const vn_darts *darts, int32_t cell, int level) {
    uint64_t at = darts->cells.data[cell].at;
    box b = {.side = darts->side / (double)(1 << level), .level = level};
    for (int k = 0; k < 3; k++) {
        b.low[k] =
            darts->low[k] + (double)(at >> (VN_DART_LEVELS * k) & ((1 << VN_DART_LEVELS) - 1)) * b.side;
    }
    return b;
}

static uint64_t child_at(uint64_t at, int child) {
    return 2 * at + ((uint64_t)(child & 1) | (uint64_t)(child >> 1 & 1) << VN_DART_LEVELS |
                     (uint64_t)(child >> 2 & 1) << (2 * VN_DART_LEVELS));
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
    darts->mass[class] += volume * cell->mass / VN_DART_WHOLE;
}

static vn_status put(vn_darts *darts, int32_t cell, const box *b) {
    vn_dart_cell *c = &darts->cells.data[cell];
    int class = class_of(darts, c->bound);
    vn_dart_bin *bin = bin_of(darts, class, b->level);
    VN_TRY(vn_array_reserve_tightly(&bin->cells, (int64_t)bin->cells.count + 1));
    bin->cells.data[bin->cells.count++] = cell;
    darts->levels[class] |= 1u << b->level;
    c->link = bin->cells.count - 1;
    account(darts, class, c, b->side, 1);
    return VN_OK;
}

static void take(vn_darts *darts, int32_t cell, const box *b) {
    vn_dart_cell *c = &darts->cells.data[cell];
    int class = class_of(darts, c->bound);
    vn_dart_bin *bin = bin_of(darts, class, b->level);
    int32_t last = bin->cells.data[--bin->cells.count];
    bin->cells.data[c->link] = last;
    darts->cells.data[last].link = c->link;
    c->link = -1;
    account(darts, class, c, b->side, -1);
    if (bin->cells.count == 0) {
        darts->levels[class] &= ~(1u << b->level);
    }
    if (bin->cells.count < bin->cells.capacity / 2) {
        vn_array_trim(&bin->cells);
    }
    if (darts->levels[class] == 0) { // what rounding left of the sums
        darts->volume[class] = darts->mass[class] = 0;
    }
}

static float round_up(double value) {
    return (float)(value * (1 + 1e-6));
}

static vn_status set_bound(vn_darts *darts, int32_t cell, const box *b, double bound) {
    vn_dart_cell *c = &darts->cells.data[cell];
    bool same = class_of(darts, c->bound) == class_of(darts, round_up(bound));
    if (same || c->link < 0) {
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
static vn_status measure_mass(const vn_darts *darts, const box *b, int *mass) {
    int across = darts->dim == 3 ? 4 : 8, deep = darts->dim == 3 ? 4 : 1;
    double sum = 0, middle[3];
    middle_of(darts, b, middle);
    double border = vn_domain_distance(darts->region, middle), half = half_diagonal(darts, b->side);
    *mass = border > half ? VN_DART_WHOLE : 0;
    if ((border > half && darts->density == NULL) || border < -half) {
        return VN_OK;
    }
    for (int i = 0; i < across * across * deep; i++) {
        int column = i % across, row = i / across % across, layer = i / (across * across);
        double part = b->side / across, density;
        double p[3] = {b->low[0] + part * (column + 0.5), b->low[1] + part * (row + 0.5), 0};
        if (darts->dim == 3) {
            p[2] = b->low[2] + part * (layer + 0.5);
        }
        VN_TRY(density_at(darts, p, &density));
        sum += density;
    }
    double part = round(sum / (across * across * deep) * VN_DART_WHOLE);
    *mass = (int)fmin(fmax(part, 1), VN_DART_WHOLE - 1); // some may be there, or not, that was missed
    return VN_OK;
}

static vn_status add_cell(vn_darts *darts, uint64_t code, int32_t witness, const box *b, double bound) {
    int32_t at = darts->cells.count;
    int mass;
    VN_TRY(measure_mass(darts, b, &mass));
    vn_dart_cell cell = {.at = code & ((UINT64_C(1) << 3 * VN_DART_LEVELS) - 1),
                         .mass = (unsigned)mass & VN_DART_WHOLE,
                         .link = -1,
                         .witness = {witness, -1},
                         .bound = round_up(bound)};
    VN_TRY(vn_array_push(&darts->cells, cell));
    return mass > 0 ? put(darts, at, b) : VN_OK;
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

vn_status vn_darts_init(vn_darts *darts, int dim, const vn_domain *region, double tolerance,
                        vn_cco_value_fn *density, void *payload, vn_rng *rng) {
    vn_darts_free(darts);
    *darts = (vn_darts){
        .dim = dim, .region = region, .tolerance = tolerance, .density = density, .payload = payload};
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
    for (int class = 0; class < VN_DART_CLASSES; class ++) {
        darts->bounds[class] = 2 * half_diagonal(darts, darts->side) * pow(CLASS_RATIO, class) * (1 + 1e-9);
    }
    VN_TRY(weigh_region(darts, rng));
    box b = outermost(darts);
    return add_cell(darts, 0, -1, &b, 2 * half_diagonal(darts, darts->side));
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

// By its middle and that of a vessel that is so far from it: no point is farther, and what is near the middle
// is as near as that.
static double farthest(const vn_darts *darts, const box *b, int32_t vessel, const vn_dart_search *search) {
    double middle[3];
    middle_of(darts, b, middle);
    return search->distance_to(middle, vessel, search->payload) + half_diagonal(darts, b->side);
}

static vn_status divide(vn_darts *darts, int32_t cell, const box *b, const vn_dart_search *search) {
    vn_dart_cell whole = darts->cells.data[cell];
    int32_t first = darts->cells.count;
    VN_TRY(vn_array_reserve_tightly(&darts->cells, (int64_t)first + children_of(darts)));
    take(darts, cell, b);
    darts->cells.data[cell].link = ~first;
    for (int i = 0; i < children_of(darts); i++) {
        box c = child_box(darts, b, i);
        double bound = fmin(whole.bound, farthest(darts, &c, whole.witness[0], search));
        VN_TRY(add_cell(darts, child_at(whole.at, i), whole.witness[0], &c, bound));
    }
    return VN_OK;
}

// Cells much smaller than the threshold would tell little more, and there would be many. In space their
// number would still leap whenever the threshold comes below a power of two.
static const double SMALLEST = 1.0;

// A dart in this cell was in vain: the vessel that refused it bounds the cell, or its parts.
static vn_status learn(vn_darts *darts, int32_t cell, const box *b, const vn_dart_search *search,
                       double threshold) {
    vn_dart_cell *c = &darts->cells.data[cell];
    double bound = fmin(c->bound, farthest(darts, b, c->witness[0], search));
    if (bound > threshold && half_diagonal(darts, b->side) > SMALLEST * threshold &&
        b->level < VN_DART_LEVELS - 1 && darts->cells.count < search->most_cells) {
        return divide(darts, cell, b, search);
    }
    return set_bound(darts, cell, b, bound);
}

/// What may still be hit at a threshold.
typedef struct live {
    int last; ///< class
    double mass, volume;
    double part, skip; ///< the chance that a dart anywhere hits it, and the log of that that it misses
    double lowest;     ///< no free point is nearer to where cells know their vessels
} live;

// Vessels may have moved by the tolerance untold: points may be as much farther from them than their cell's
// bound.
static void look_for_live(const vn_darts *darts, double threshold, live *l) {
    l->lowest = threshold - darts->tolerance;
    l->last = class_of(darts, l->lowest);
    l->mass = l->volume = 0;
    for (int class = 0; class <= l->last; class ++) {
        l->mass += darts->mass[class];
        l->volume += darts->volume[class];
    }
    l->part = l->volume > 0 ? l->mass / darts->total : 0;
    l->skip = l->part < 1 ? log1p(-l->part) : -INFINITY;
}

// Darts in vain before one falls into live cells: geometrically distributed.
static double skipped(const live *l, vn_rng *rng) {
    double chance = vn_rng_uniform(rng, 0, 1);
    return chance < l->part ? 0 : l->skip == 0 ? INFINITY : floor(log1p(-chance) / l->skip);
}

/// A dart into one of a class's cells of one level, that one not yet looked up.
typedef struct pick {
    int class, level; ///< -1: there is none
    int32_t i;        ///< of its bin
    double at[3];     ///< parts of the cell's side
} pick;

// One of a class, by how far @p at is along the volumes of its levels.
static void pick_in(const vn_darts *darts, double at, pick *p) {
    for (uint32_t levels = darts->levels[p->class]; levels != 0; levels &= levels - 1) {
        p->level = __builtin_ctz(levels);
        int32_t count = bin_of(darts, p->class, p->level)->cells.count;
        double one = cell_volume(darts, darts->side / (double)(1 << p->level)), all = one * count;
        p->i = (int32_t)fmin(at / one, count - 1);
        if (at < all || (levels & (levels - 1)) == 0) { // the last, where rounding leads beyond it
            return;
        }
        at -= all;
    }
}

// 32 bits for a coordinate are enough.
static void point_at(int dim, vn_rng *rng, double at[3]) {
    uint64_t bits = 0;
    for (int k = 0; k < 3; k++) {
        bits = k == 1 ? bits >> 32 : k < dim ? (uint64_t)vn_rng_integer(rng, INT64_MIN, INT64_MAX) : 0;
        at[k] = k < dim ? (double)(bits & 0xFFFFFFFF) * 0x1p-32 : 0;
    }
}

// Of the classes that reach above the threshold, a leaf at random, as likely as it is large. Most are hardly
// above it.
static pick pick_one(const vn_darts *darts, const live *l, vn_rng *rng) {
    pick p = {.class = l->last, .level = -1};
    double at = vn_rng_uniform(rng, 0, l->volume);
    while (p.class >= 0 && at >= darts->volume[p.class]) {
        at -= darts->volume[p.class --];
    }
    if (p.class >= 0) {
        pick_in(darts, at, &p);
        point_at(darts->dim, rng, p.at);
    }
    return p;
}

// Whether a dart is too near to the middle of its cell, @p bound being that of the cell: the nearest vessel
// is no farther from the middle than the bound less half the diagonal.
static bool is_near_middle(const vn_darts *darts, double side, double bound, double lowest,
                           const double at[3]) {
    double free = lowest - bound + half_diagonal(darts, side), square = 0;
    for (int k = 0; k < darts->dim; k++) {
        square += (at[k] - 0.5) * (at[k] - 0.5);
    }
    return free > 0 && square * side * side < free * free;
}

// Without looking the cell up, by what is known of its class.
static bool is_vain(const vn_darts *darts, const live *l, const pick *p) {
    return is_near_middle(darts, darts->side / (double)(1 << p->level), darts->bounds[p->class], l->lowest,
                          p->at);
}

// Where parts of a class's cells are outside the region, as many of the darts that are not looked up are
// taken to have fallen there.
static bool probably_lands(const vn_darts *darts, int class, vn_rng *rng) {
    double part = darts->mass[class] / darts->volume[class];
    return part > 1 - 1e-6 || vn_rng_uniform(rng, 0, 1) < part;
}

/// A dart on its way.
typedef struct dart {
    pick pick;
    double thrown; ///< darts at this threshold up to this one
    int32_t cell;  ///< where it fell; -1: in vain
    box box;
    double p[3];
    double away; ///< from the vessel that refused the last dart there
} dart;

// One of those that fall into live cells of the region, in vain or not; class -1: it certainly is.
static void aim(const vn_darts *darts, const live *l, vn_rng *rng, pick *p) {
    enum { MOST = 100000 };
    for (int i = 0; i < MOST; i++) {
        *p = pick_one(darts, l, rng);
        if (p->level < 0) {
            break;
        }
        if (!is_vain(darts, l, p)) {
            return;
        }
        if (probably_lands(darts, p->class, rng)) {
            break;
        }
    }
    p->class = -1;
}

static void find_cell(const vn_darts *darts, dart *d) {
    d->cell = d->pick.class >= 0 ? bin_of(darts, d->pick.class, d->pick.level)->cells.data[d->pick.i] : -1;
}

static vn_status lands(const vn_darts *darts, dart *d, vn_rng *rng, bool *yes) {
    double density = 1;
    d->box = box_of(darts, d->cell, d->pick.level);
    for (int k = 0; k < 3; k++) {
        d->p[k] = k < darts->dim ? d->box.low[k] + d->pick.at[k] * d->box.side : 0;
    }
    if (darts->cells.data[d->cell].mass < VN_DART_WHOLE || darts->density != NULL) {
        VN_TRY(density_at(darts, d->p, &density));
    }
    *yes = density >= 1 || (density > 0 && vn_rng_uniform(rng, 0, 1) < density);
    return VN_OK;
}

// What falls outside the region does not count, and is thrown again.
static vn_status land(const vn_darts *darts, const live *l, dart *d, vn_rng *rng) {
    enum { MOST = 100000 };
    for (int i = 0; i < MOST && d->cell >= 0; i++) {
        bool yes;
        VN_TRY(lands(darts, d, rng, &yes));
        if (yes) {
            float bound = darts->cells.data[d->cell].bound;
            d->cell = is_near_middle(darts, d->box.side, bound, l->lowest, d->pick.at) ? -1 : d->cell;
            return VN_OK;
        }
        aim(darts, l, rng, &d->pick);
        find_cell(darts, d);
    }
    d->cell = -1;
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

enum { AT_ONCE = 16 };

/// Darts that are in the air together: cells and vessels are all over the memory, and wait for one another
/// less so. One that sticks makes those after it not thrown.
typedef struct volley {
    dart darts[AT_ONCE];
    int count;
    double thrown; ///< at this threshold in all
    bool over;     ///< these were all tries
} volley;

static void throw_volley(const vn_darts *darts, const live *l, const vn_dart_search *search, vn_rng *rng,
                         volley *v) {
    int most = darts->density == NULL ? AT_ONCE : 1; // a density may be slow to ask
    for (v->count = 0; v->count < most;) {
        dart *d = &v->darts[v->count];
        v->thrown += skipped(l, rng) + 1;
        v->over = v->thrown > search->tries;
        if (v->over) {
            return;
        }
        aim(darts, l, rng, &d->pick);
        if (d->pick.class >= 0) {
            __builtin_prefetch(&bin_of(darts, d->pick.class, d->pick.level)->cells.data[d->pick.i]);
            d->thrown = v->thrown;
            v->count++;
        }
    }
}

static vn_status land_volley(const vn_darts *darts, const live *l, const vn_dart_search *search, vn_rng *rng,
                             volley *v) {
    for (int i = 0; i < v->count; i++) {
        find_cell(darts, &v->darts[i]);
        __builtin_prefetch(&darts->cells.data[v->darts[i].cell]);
    }
    for (int i = 0; i < v->count; i++) {
        VN_TRY(land(darts, l, &v->darts[i], rng));
    }
    for (int i = 0; i < v->count; i++) {
        dart *d = &v->darts[i];
        int32_t witness = d->cell >= 0 ? darts->cells.data[d->cell].witness[0] : -1;
        d->away = witness >= 0 ? search->distance_to(d->p, witness, search->payload) : INFINITY;
    }
    return VN_OK;
}

static void remember(vn_dart_cell *c, int32_t vessel) {
    c->witness[1] = c->witness[0] != vessel ? c->witness[0] : c->witness[1];
    c->witness[0] = vessel;
}

// Whether the dart sticks; what refused it is remembered, and asked first next time. A cell may have been
// divided by another dart of the volley.
static vn_status try_dart(vn_darts *darts, const vn_dart_search *search, const dart *d, double threshold,
                          bool *sticks, bool *news) {
    double here = threshold;
    VN_TRY(local_threshold(darts, d->p, &here));
    if (d->away <= here) {
        return VN_OK;
    }
    vn_dart_cell *c = &darts->cells.data[d->cell];
    int32_t nearest = c->witness[1];
    if (nearest < 0 || search->distance_to(d->p, nearest, search->payload) > here) {
        double distance = search->distance(d->p, &nearest, search->payload);
        if (distance > here) {
            *sticks = !search->refuse(d->p, search->payload);
            return VN_OK;
        }
    }
    remember(c, nearest);
    *news = true;
    return c->link >= 0 ? learn(darts, d->cell, &d->box, search, lowest(darts, threshold)) : VN_OK;
}

// Its number in the volley, if one sticks; or -1.
static vn_status try_volley(vn_darts *darts, const vn_dart_search *search, const volley *v, double threshold,
                            int *stuck, bool *news) {
    bool sticks = false;
    *stuck = -1;
    for (int i = 0; i < v->count && !sticks; i++) {
        VN_TRY(v->darts[i].cell >= 0 ? try_dart(darts, search, &v->darts[i], threshold, &sticks, news)
                                     : VN_OK);
        *stuck = sticks ? i : -1;
    }
    return VN_OK;
}

vn_status vn_darts_throw(vn_darts *darts, const vn_dart_search *search, vn_rng *rng, double p[3],
                         int64_t *darts_thrown) {
    double threshold = search->threshold;
    volley v = {0};
    live l;
    look_for_live(darts, lowest(darts, threshold), &l);
    while (threshold > 1e-6 * darts->side) {
        int stuck;
        bool news = false;
        throw_volley(darts, &l, search, rng, &v);
        VN_TRY(land_volley(darts, &l, search, rng, &v));
        VN_TRY(try_volley(darts, search, &v, threshold, &stuck, &news));
        if (stuck >= 0) {
            *darts_thrown += (int64_t)v.darts[stuck].thrown;
            memcpy(p, v.darts[stuck].p, sizeof v.darts[stuck].p);
            return VN_OK;
        }
        if (v.over) {
            *darts_thrown += search->tries;
            threshold *= search->factor;
            v.thrown = 0;
        }
        if (v.over || news) {
            look_for_live(darts, lowest(darts, threshold), &l);
        }
    }
    return vn_fail(VN_INFEASIBLE, "there is no room left between the vessels");
}

/// Segments that were added, and the box about them.
typedef struct news {
    const double (*ends)[2][3];
    const int32_t *vessels;
    int32_t count;
    double moved;
    double low[3], high[3];
} news;

static void enclose(news *n) {
    for (int k = 0; k < 3; k++) {
        n->low[k] = INFINITY;
        n->high[k] = -INFINITY;
        for (int32_t i = 0; i < 2 * n->count; i++) {
            n->low[k] = fmin(n->low[k], n->ends[i / 2][i % 2][k]);
            n->high[k] = fmax(n->high[k], n->ends[i / 2][i % 2][k]);
        }
    }
}

// At least this far from all of them.
static double from_box(const news *n, const double p[3]) {
    double square = 0;
    for (int k = 0; k < 3; k++) {
        double under = n->low[k] - p[k], over = p[k] - n->high[k];
        double away = under > over ? under : over;
        square += away > 0 ? away * away : 0;
    }
    return sqrt(square);
}

static double from_segments(const news *n, const double p[3], int32_t *vessel) {
    double nearest = INFINITY;
    for (int32_t i = 0; i < n->count; i++) {
        double square = vn_point_segment_distance2(p, n->ends[i][0], n->ends[i][1]);
        if (square < nearest) {
            nearest = square;
            *vessel = n->vessels[i];
        }
    }
    return sqrt(nearest);
}

static vn_status spread_leaf(vn_darts *darts, int32_t cell, const box *b, const double middle[3],
                             const news *n) {
    vn_dart_cell *c = &darts->cells.data[cell];
    double half = half_diagonal(darts, b->side), known = c->bound - half;
    int32_t vessel = -1;
    double nearest = from_segments(n, middle, &vessel);
    if (nearest > known + n->moved) {
        return VN_OK;
    }
    if (nearest < known) {
        remember(c, vessel);
    }
    return set_bound(darts, cell, b, fmin(known + n->moved, nearest) + half);
}

// Where another vessel is nearer to the middle of a cell, nothing changes there. Elsewhere bounds fall, or
// rise where vessels moved.
static vn_status spread(vn_darts *darts, int32_t cell, const box *b, const news *n) {
    vn_dart_cell *c = &darts->cells.data[cell];
    double middle[3], half = half_diagonal(darts, b->side);
    middle_of(darts, b, middle);
    if (from_box(n, middle) > c->bound + n->moved + (c->link >= -1 ? -half : half)) {
        return VN_OK;
    }
    if (c->link >= -1) {
        return spread_leaf(darts, cell, b, middle, n);
    }
    float bound = 0;
    int32_t first = ~c->link;
    for (int i = 0; i < children_of(darts); i++) {
        box child = child_box(darts, b, i);
        VN_TRY(spread(darts, first + i, &child, n));
        bound = fmaxf(bound, darts->cells.data[first + i].bound);
    }
    darts->cells.data[cell].bound = bound;
    return VN_OK;
}

vn_status vn_darts_tell(vn_darts *darts, const int32_t *vessels, const double (*ends)[2][3], int32_t count,
                        double moved) {
    news n = {.ends = ends, .vessels = vessels, .count = count, .moved = moved};
    box b = outermost(darts);
    enclose(&n);
    return darts->cells.count > 0 ? spread(darts, 0, &b, &n) : VN_OK;
}
