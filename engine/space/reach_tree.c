#include "space/reach_tree.h"

#include <float.h>

enum { FAN = VN_REACH_FAN };

static const unsigned ALL = (1U << FAN) - 1;

void vn_reach_tree_free(vn_reach_tree *tree) {
    vn_array_free(&tree->items);
    vn_array_free(&tree->packs);
    vn_array_free(&tree->watches);
    vn_array_free(&tree->runs);
    vn_array_free(&tree->places);
    tree->levels = 0;
}

// Rounded outwards, so that a box in single precision still holds its points.
static float float_below(double value) {
    float f = (float)value;
    return (double)f > value ? nextafterf(f, -INFINITY) : f;
}

static float float_above(double value) {
    float f = (float)value;
    return (double)f < value ? nextafterf(f, INFINITY) : f;
}

// One box and its bound, while packs are made from them.
typedef struct reach_box {
    float low[3], high[3];
    float reach2;
} reach_box;

static reach_box empty_box(void) {
    reach_box box = {.reach2 = -1};
    for (int k = 0; k < 3; k++) {
        box.low[k] = INFINITY;
        box.high[k] = -INFINITY;
    }
    return box;
}

static void include_point(reach_box *box, const vn_points *points, int32_t i, double reach2) {
    double p[3];
    vn_points_get(points, i, p);
    for (int k = 0; k < 3; k++) {
        box->low[k] = fminf(box->low[k], float_below(p[k]));
        box->high[k] = fmaxf(box->high[k], float_above(p[k]));
    }
    box->reach2 = fmaxf(box->reach2, float_above(reach2));
}

static reach_box box_of_pack(const vn_reach_pack *pack) {
    reach_box box = empty_box();
    for (int i = 0; i < FAN; i++) {
        for (int k = 0; k < 3; k++) {
            box.low[k] = fminf(box.low[k], pack->low[k][i]);
            box.high[k] = fmaxf(box.high[k], pack->high[k][i]);
        }
        box.reach2 = fmaxf(box.reach2, pack->reach2[i]);
    }
    return box;
}

static void set_box(vn_reach_pack *pack, int i, const reach_box *box) {
    for (int k = 0; k < 3; k++) {
        pack->low[k][i] = box->low[k];
        pack->high[k][i] = box->high[k];
    }
    pack->reach2[i] = box->reach2;
}

// The far-sighted, by the size of the whole, are kept apart, or every run that one of them is in would be
// looked at again and again.
static const double FAR = 0.05;

static vn_status sort_items(vn_reach_tree *tree, const vn_points *points, const double *reach2,
                            int32_t count) {
    double low[3], high[3];
    vn_keyed_array keys = {0}, scratch = {0};
    vn_status status = vn_array_reserve(&keys, count);
    for (int32_t i = 0; status == VN_OK && i < count; i++) {
        if (reach2[i] >= 0) {
            keys.data[keys.count++].value = i;
        }
    }
    double size = vn_points_extent(points, 0, count, low, high);
    for (int k = 0; k < 3; k++) {
        tree->middle[k] = 0.5 * (low[k] + high[k]);
    }
    tree->size = 2 * size;
    status = status == VN_OK ? vn_points_sort(points, tree->dim, low, size, &keys, &scratch) : status;
    status = status == VN_OK ? vn_array_reserve(&tree->items, keys.count) : status;
    tree->items.count = 0;
    for (int far = 1; status == VN_OK && far >= 0; far--) {
        for (int32_t i = 0; i < keys.count; i++) {
            int32_t item = keys.data[i].value;
            if (far == (reach2[item] > FAR * FAR * size * size)) {
                tree->items.data[tree->items.count++] = item;
            }
        }
    }
    vn_array_free(&keys);
    vn_array_free(&scratch);
    return status;
}

static reach_box box_of_run(const vn_reach_tree *tree, int32_t run, const vn_points *points,
                            const double *reach2) {
    reach_box box = empty_box();
    for (int32_t i = run * FAN; i < tree->items.count && i < (run + 1) * FAN; i++) {
        int32_t item = tree->items.data[i];
        include_point(&box, points, item, reach2[item]);
    }
    return box;
}

// Level 0 boxes runs of items, every higher level the packs of the one below.
static vn_status build_level(vn_reach_tree *tree, int32_t parts, const vn_points *points,
                             const double *reach2) {
    int level = tree->levels;
    for (int32_t first = 0; first < parts; first += FAN) {
        vn_reach_pack pack;
        for (int i = 0; i < FAN; i++) {
            reach_box box = empty_box();
            if (first + i < parts) {
                box = level == 0 ? box_of_run(tree, first + i, points, reach2)
                                 : box_of_pack(&tree->packs.data[tree->starts[level - 1] + first + i]);
            }
            set_box(&pack, i, &box);
        }
        VN_TRY(vn_array_push(&tree->packs, pack));
    }
    tree->starts[level + 1] = tree->packs.count;
    tree->levels = level + 1;
    return VN_OK;
}

// Nobody is posted yet.
static void build_runs(vn_reach_tree *tree, const vn_points *points, const double *near2) {
    tree->runs.count = (tree->items.count + FAN - 1) / FAN;
    for (int32_t k = 0; k < tree->runs.count * FAN; k++) {
        vn_reach_run *run = &tree->runs.data[k / FAN];
        double p[3] = {0, 0, 0};
        bool is_there = k < tree->items.count;
        if (is_there) {
            vn_points_get(points, tree->items.data[k], p);
        }
        for (int d = 0; d < 3; d++) {
            run->at[d][k % FAN] = run->guard[d][k % FAN] = p[d];
        }
        run->guard2[k % FAN] = INFINITY;
        run->near2[k % FAN] = is_there ? near2[tree->items.data[k]] : INFINITY;
    }
}

static vn_status build_watches(vn_reach_tree *tree, const vn_points *points, const double *near2,
                               int32_t count) {
    VN_TRY(vn_array_reserve(&tree->watches, tree->packs.count));
    VN_TRY(vn_array_reserve(&tree->runs, (tree->items.count + FAN - 1) / FAN));
    VN_TRY(vn_array_reserve(&tree->places, count));
    tree->watches.count = tree->packs.count;
    tree->places.count = count;
    for (int32_t k = 0; k < tree->watches.count; k++) {
        vn_reach_watch *watch = &tree->watches.data[k];
        *watch = (vn_reach_watch){0};
        for (int j = 0; j < VN_REACH_GUARDS * FAN; j++) {
            watch->guards[j % FAN][j / FAN].excess = INFINITY;
        }
    }
    for (int32_t i = 0; i < count; i++) {
        tree->places.data[i] = -1;
    }
    for (int32_t k = 0; k < tree->items.count; k++) {
        tree->places.data[tree->items.data[k]] = k;
    }
    build_runs(tree, points, near2);
    return VN_OK;
}

vn_status vn_reach_tree_build(vn_reach_tree *tree, int dim, const vn_points *points, const double *reach2,
                              const vn_reach_filter *filter, int32_t count) {
    tree->dim = dim;
    tree->packs.count = 0;
    tree->levels = 0;
    tree->starts[0] = 0;
    VN_TRY(sort_items(tree, points, reach2, count));
    int32_t parts = (tree->items.count + FAN - 1) / FAN;
    VN_TRY(vn_array_reserve(&tree->packs, parts / 7 + VN_REACH_LEVELS)); // 1/8 + 1/64 + … = 1/7
    do {
        VN_TRY(build_level(tree, parts, points, reach2));
        parts = tree->starts[tree->levels] - tree->starts[tree->levels - 1];
    } while (parts > 1 && tree->levels < VN_REACH_LEVELS);
    tree->watches.count = tree->runs.count = tree->places.count = 0;
    return filter != NULL ? build_watches(tree, points, filter->near2, count) : VN_OK;
}

typedef struct reach_query {
    vn_reach_tree *tree;
    const vn_points *points;
    const double *reach2;
    const vn_reach_filter *filter;
    double p[3];
    float low[3], high[3]; ///< p, rounded down and up
    double margin;         ///< what rounding may do to squares, and more
    vn_reach_hits *hits;
    double guard[3]; ///< that kept p out last, while
    bool guarded;
} reach_query;

// Bit i: part i may hold an answer, as it is no nearer than @p nearest2 says. In single precision, on the
// safe side: p lies between low and high, and the factor outweighs the rounding of squares and sums. The
// loops have no branches, so that a compiler makes vectors of them.
static unsigned may_answer(const vn_reach_pack *pack, const reach_query *q, float nearest2[FAN]) {
    float d2[FAN] = {0};
    for (int k = 0; k < q->tree->dim; k++) {
#pragma omp simd
        for (int i = 0; i < FAN; i++) {
            float below = pack->low[k][i] - q->high[k];
            float above = q->low[k] - pack->high[k][i];
            float d = below > above ? below : above;
            d = d > 0 ? d : 0;
            d2[i] += d * d;
        }
    }
    unsigned bits = 0;
#pragma omp simd reduction(| : bits)
    for (int i = 0; i < FAN; i++) {
        nearest2[i] = d2[i] * 0.999999F;
        bits |= nearest2[i] <= pack->reach2[i] ? 1U << i : 0U;
    }
    return bits;
}

/// A part of a pack that is being visited, and its items.
typedef struct reach_part {
    vn_reach_pack *pack;
    vn_reach_watch *watch;
    int i;
    int32_t begin, end;
    float nearest2;
} reach_part;

// How much nearer every point s of the part is to a guard than to p, in squares, at least; or not at all when
// the guard is no nearer to p than the part may be. With all places relative to p it is 2 g·s - g².
static inline double gain_in(int dim, const reach_query *q, const reach_part *part, const double guard[3]) {
    double gain = 0, way2 = 0;
    for (int k = 0; k < dim; k++) {
        double way = guard[k] - q->p[k];
        double low = way * ((double)part->pack->low[k][part->i] - q->p[k]);
        double high = way * ((double)part->pack->high[k][part->i] - q->p[k]);
        gain += low < high ? low : high;
        way2 += way * way;
    }
    bool nearer = way2 + q->margin < (double)part->nearest2 && part->nearest2 <= FLT_MAX; // or it overflowed
    return nearer ? 2 * gain - way2 - q->margin : -1;
}

// Dimensions that the compiler knows of halve its instructions; half a hundred guards are asked for a node.
static double gain_of(const reach_query *q, const reach_part *part, const double guard[3]) {
    return q->tree->dim == 2 ? gain_in(2, q, part, guard) : gain_in(3, q, part, guard);
}

static bool is_kept_out(const reach_query *q, const reach_part *part) {
    for (int g = 0; g < VN_REACH_GUARDS; g++) {
        const vn_reach_guard *guard = &part->watch->guards[part->i][g];
        if (gain_of(q, part, guard->at) > guard->excess) {
            return true;
        }
    }
    return false;
}

static double excess_of(const vn_points *points, int32_t item, double near2, const double at[3]) {
    double d2 = vn_points_distance2(points, item, at);
    return near2 - d2 + 1e-12 * (near2 + d2);
}

// Whether a guard at @p at would have kept p from the part; then it is posted there.
static bool post_guard(reach_query *q, const reach_part *part) {
    const double *at = q->guard;
    double gain = gain_of(q, part, at), excess = 0;
    for (int32_t k = part->begin; k < part->end && excess < gain; k++) {
        int32_t item = q->tree->items.data[k];
        if (q->reach2[item] >= 0) {
            double own = excess_of(q->points, item, q->filter->near2[item], at);
            excess = own > excess ? own : excess;
        }
    }
    if (!(excess < gain)) {
        return false;
    }
    vn_reach_watch *watch = part->watch;
    int g = watch->turn[part->i];
    watch->turn[part->i] = (uint8_t)((g + 1) % VN_REACH_GUARDS);
    watch->guards[part->i][g] = (vn_reach_guard){{at[0], at[1], at[2]}, excess};
    return true;
}

// What is certain, whatever doubles do to the last bits.
static const double SURE = 1 - 1e-12;

// Bit i: nobody is known to keep p from point i of the run. The loops have no branches, so that a compiler
// makes vectors of them: where points are few and far between, a new one is asked of half a hundred.
static inline unsigned open_to(int dim, const vn_reach_run *run, const double p[3]) {
    double d2[FAN] = {0}, way2[FAN] = {0};
    for (int k = 0; k < dim; k++) {
#pragma omp simd
        for (int i = 0; i < FAN; i++) {
            double d = run->at[k][i] - p[k], way = run->guard[k][i] - p[k];
            d2[i] += d * d;
            way2[i] += way * way;
        }
    }
    unsigned bits = 0;
#pragma omp simd reduction(| : bits)
    for (int i = 0; i < FAN; i++) {
        double sure2 = SURE * d2[i], farther2 = run->guard2[i] > way2[i] ? run->guard2[i] : way2[i];
        bits |= d2[i] > run->near2[i] && farther2 < sure2 ? 0U : 1U << i;
    }
    return bits;
}

// Where one of those stands that kept p out already.
static void note_guard(reach_query *q, const vn_reach_run *run, unsigned kept) {
    int i = 0;
    while (!(kept >> i & 1)) {
        i++;
    }
    for (int k = 0; k < 3; k++) {
        q->guard[k] = run->guard[k][i];
    }
    q->guarded = true;
}

// Whether some guard keeps p, at @p d2, from point @p i of the run; it is asked first from then on.
static bool is_item_kept_out(reach_query *q, vn_reach_run *run, int i, int32_t item, double d2) {
    if (q->filter == NULL || !q->filter->keeps_out(q->filter->payload, item, q->p, d2, q->guard)) {
        return false;
    }
    run->guard2[i] = 0;
    for (int k = 0; k < q->tree->dim; k++) {
        double d = q->guard[k] - run->at[k][i];
        run->guard[k][i] = q->guard[k];
        run->guard2[i] += d * d;
    }
    q->guarded = true;
    return true;
}

// The hits have room for a run more. Returns what the run remembers at most.
static float query_run(reach_query *q, const reach_part *part) {
    double most = -1;
    vn_reach_run *run = q->filter != NULL ? &q->tree->runs.data[part->begin / FAN] : NULL;
    unsigned open = run == NULL ? ALL : q->tree->dim == 2 ? open_to(2, run, q->p) : open_to(3, run, q->p);
    if (open != ALL) {
        note_guard(q, run, ~open);
    }
    for (int32_t i = part->begin; i < part->end; i++, open >>= 1) {
        int32_t item = q->tree->items.data[i];
        double remembered = q->reach2[item];
        most = remembered > most ? remembered : most;
        if (!(open & 1)) {
            continue;
        }
        double d2 = vn_points_distance2(q->points, item, q->p);
        if (d2 <= remembered && !is_item_kept_out(q, run, i % FAN, item, d2)) {
            q->hits->data[q->hits->count++] = (vn_reach_hit){item, d2};
        }
    }
    return float_above(most);
}

static float most_of(const vn_reach_pack *pack) {
    float most = -1;
    for (int i = 0; i < FAN; i++) {
        most = pack->reach2[i] > most ? pack->reach2[i] : most;
    }
    return most;
}

static vn_status query_pack(reach_query *q, int level, int32_t index);

// Items of the part that are kept out one by one might have been kept out together.
static vn_status query_part(reach_query *q, int level, int32_t index, reach_part *part) {
    const vn_reach_tree *tree = q->tree;
    int32_t before = q->hits->count;
    int64_t items = (int64_t)FAN << (3 * level), end = (index + 1) * items;
    part->begin = (int32_t)(index * items);
    part->end = (int32_t)(end < tree->items.count ? end : tree->items.count);
    if (level == 0) {
        VN_TRY(vn_array_reserve(q->hits, before + FAN));
        q->guarded = false;
        part->pack->reach2[part->i] = query_run(q, part);
    } else {
        VN_TRY(query_pack(q, level - 1, index));
        part->pack->reach2[part->i] = most_of(&tree->packs.data[tree->starts[level - 1] + index]);
    }
    q->guarded = q->guarded && part->watch != NULL && q->hits->count == before && post_guard(q, part);
    return VN_OK;
}

// What is remembered only shrinks between builds (but for vn_reach_tree_raise()), so a bound may be stale but
// never wrong; each visit renews it.
static vn_status query_pack(reach_query *q, int level, int32_t index) {
    vn_reach_tree *tree = q->tree;
    vn_reach_pack *pack = &tree->packs.data[tree->starts[level] + index];
    vn_reach_watch *watch = q->filter != NULL ? &tree->watches.data[tree->starts[level] + index] : NULL;
    float nearest2[FAN];
    unsigned bits = may_answer(pack, q, nearest2);
    for (int i = 0; bits != 0; i++, bits >>= 1) {
        reach_part part = {pack, watch, i, 0, 0, nearest2[i]};
        if ((bits & 1) && (watch == NULL || !is_kept_out(q, &part))) {
            VN_TRY(query_part(q, level, index * FAN + i, &part));
        }
    }
    return VN_OK;
}

vn_status vn_reach_tree_query(vn_reach_tree *tree, const vn_points *points, const double *reach2,
                              const vn_reach_filter *filter, const double p[3], vn_reach_hits *hits) {
    if (tree->levels == 0 || tree->items.count == 0) {
        return VN_OK;
    }
    reach_query q = {.tree = tree, .points = points, .reach2 = reach2, .filter = filter, .hits = hits};
    for (int k = 0; k < 3; k++) {
        q.p[k] = p[k];
        q.low[k] = float_below(p[k]);
        q.high[k] = float_above(p[k]);
    }
    double widest = sqrt(vn_distance2(p, tree->middle)) + tree->size;
    q.margin = 1e-12 * widest * widest;
    return query_pack(&q, tree->levels - 1, 0);
}

// Every box that the point may be in: which one it is in is not kept, and a bound too high is only slower.
static void raise_pack(vn_reach_tree *tree, int level, int32_t index, const double p[3], float reach2) {
    vn_reach_pack *pack = &tree->packs.data[tree->starts[level] + index];
    for (int i = 0; i < FAN; i++) {
        bool inside = true;
        for (int k = 0; k < tree->dim; k++) {
            inside = inside && p[k] >= (double)pack->low[k][i] && p[k] <= (double)pack->high[k][i];
        }
        if (inside) {
            pack->reach2[i] = fmaxf(pack->reach2[i], reach2);
            if (level > 0) {
                raise_pack(tree, level - 1, index * FAN + i, p, reach2);
            }
        }
    }
}

void vn_reach_tree_raise(vn_reach_tree *tree, const double p[3], double reach2) {
    if (tree->levels > 0 && tree->items.count > 0) {
        raise_pack(tree, tree->levels - 1, 0, p, float_above(reach2));
    }
}

void vn_reach_tree_raise_near(vn_reach_tree *tree, const vn_points *points, int32_t point, double near2) {
    if (point >= tree->places.count || tree->places.data[point] < 0) {
        return;
    }
    int32_t place = tree->places.data[point], part = place / FAN;
    double *own = &tree->runs.data[part].near2[place % FAN];
    *own = near2 > *own ? near2 : *own;
    for (int level = 0; level < tree->levels; level++, part /= FAN) {
        vn_reach_watch *watch = &tree->watches.data[tree->starts[level] + part / FAN];
        for (int g = 0; g < VN_REACH_GUARDS; g++) {
            vn_reach_guard *guard = &watch->guards[part % FAN][g];
            double excess = excess_of(points, point, near2, guard->at);
            guard->excess = excess > guard->excess ? excess : guard->excess;
        }
    }
}
