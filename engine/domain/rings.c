#include "domain/rings.h"

#include "domain/crossing.h"
#include "space/segment_grid.h"

#include <math.h>

enum { EDGES_BETWEEN_POLLS = 4096, CANDIDATES_BETWEEN_POLLS = 1 << 20 };

void vn_rings_free(vn_rings *rings) {
    vn_array_free(&rings->x);
    vn_array_free(&rings->y);
    vn_array_free(&rings->ends);
}

vn_status vn_rings_point(vn_rings *rings, double x, double y) {
    if (!isfinite(x) || !isfinite(y)) {
        return vn_fail(VN_INVALID,
                       "a point of an outline is (%g, %g): its coordinates must be finite numbers", x, y);
    }
    int64_t need = (int64_t)rings->x.count + 1;
    VN_TRY(vn_array_reserve(&rings->x, need));
    VN_TRY(vn_array_reserve(&rings->y, need));
    rings->x.data[rings->x.count++] = x;
    rings->y.data[rings->y.count++] = y;
    return VN_OK;
}

static bool same_point(const vn_rings *rings, int32_t i, int32_t j) {
    return rings->x.data[i] == rings->x.data[j] && rings->y.data[i] == rings->y.data[j];
}

static void set_point_count(vn_rings *rings, int32_t count) {
    rings->x.count = count;
    rings->y.count = count;
}

static void drop_repeated_points(vn_rings *rings, int32_t begin) {
    int32_t kept = begin;
    for (int32_t i = begin; i < rings->x.count; i++) {
        if (kept == begin || !same_point(rings, i, kept - 1)) {
            rings->x.data[kept] = rings->x.data[i];
            rings->y.data[kept] = rings->y.data[i];
            kept++;
        }
    }
    while (kept > begin + 1 && same_point(rings, kept - 1, begin)) {
        kept--;
    }
    set_point_count(rings, kept);
}

vn_status vn_rings_close(vn_rings *rings) {
    int32_t begin = vn_rings_begin(rings, rings->ends.count);
    drop_repeated_points(rings, begin);
    if (rings->x.count - begin < 3) {
        set_point_count(rings, begin);
        return VN_OK;
    }
    return vn_array_push(&rings->ends, rings->x.count);
}

vn_status vn_rings_append(vn_rings *rings, const vn_rings *more) {
    int32_t begin = rings->x.count;
    int64_t need = (int64_t)begin + more->x.count;
    VN_TRY(vn_array_reserve(&rings->x, need));
    VN_TRY(vn_array_reserve(&rings->y, need));
    VN_TRY(vn_array_reserve(&rings->ends, (int64_t)rings->ends.count + more->ends.count));
    for (int32_t i = 0; i < more->x.count; i++) {
        rings->x.data[begin + i] = more->x.data[i];
        rings->y.data[begin + i] = more->y.data[i];
    }
    for (int32_t i = 0; i < more->ends.count; i++) {
        rings->ends.data[rings->ends.count++] = begin + more->ends.data[i];
    }
    set_point_count(rings, (int32_t)need);
    return VN_OK;
}

// Measured from the ring's first point: far from the origin the products would swallow the area.
double vn_rings_area_of(const vn_rings *rings, int32_t ring) {
    int32_t begin = vn_rings_begin(rings, ring);
    int32_t end = rings->ends.data[ring];
    const double *x = rings->x.data;
    const double *y = rings->y.data;
    double twice = 0;
    for (int32_t i = begin + 1; i + 1 < end; i++) {
        twice += (x[i] - x[begin]) * (y[i + 1] - y[begin]) - (x[i + 1] - x[begin]) * (y[i] - y[begin]);
    }
    return 0.5 * twice;
}

vn_box vn_rings_bounds(const vn_rings *rings) {
    vn_box box = {{0}, {0}};
    for (int32_t i = 0; i < rings->x.count; i++) {
        double p[2] = {rings->x.data[i], rings->y.data[i]};
        for (int k = 0; k < 2; k++) {
            box.min[k] = i == 0 || p[k] < box.min[k] ? p[k] : box.min[k];
            box.max[k] = i == 0 || p[k] > box.max[k] ? p[k] : box.max[k];
        }
    }
    return box;
}

/// Edge i runs from point i to point next[i]; both have the grid's segment i.
typedef struct crossing_search {
    const vn_rings *rings;
    vn_segment_grid grid;
    VN_ARRAY(int32_t) next;
    vn_crossing_fn *visit;
    void *payload;
    int32_t edge;
    int64_t candidates;
    vn_status status; ///< of the last poll
} crossing_search;

static int32_t ring_of_point(const vn_rings *rings, int32_t point) {
    int32_t low = 0;
    int32_t high = rings->ends.count - 1;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (point < rings->ends.data[middle]) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    return low;
}

vn_status vn_rings_edges(const vn_rings *rings, vn_segment_grid *grid) {
    VN_TRY(vn_array_reserve(&grid->segments, rings->x.count));
    for (int32_t ring = 0; ring < rings->ends.count; ring++) {
        int32_t begin = vn_rings_begin(rings, ring);
        int32_t end = rings->ends.data[ring];
        for (int32_t i = begin; i < end; i++) {
            int32_t j = vn_rings_next(begin, end, i);
            vn_segment edge = {rings->x.data[i], rings->y.data[i], rings->x.data[j], rings->y.data[j]};
            VN_TRY(vn_array_push(&grid->segments, edge));
        }
    }
    return VN_OK;
}

static vn_status push_edges(crossing_search *search) {
    const vn_rings *rings = search->rings;
    VN_TRY(vn_rings_edges(rings, &search->grid));
    VN_TRY(vn_array_reserve(&search->next, rings->x.count));
    for (int32_t ring = 0; ring < rings->ends.count; ring++) {
        int32_t begin = vn_rings_begin(rings, ring);
        int32_t end = rings->ends.data[ring];
        for (int32_t i = begin; i < end; i++) {
            VN_TRY(vn_array_push(&search->next, vn_rings_next(begin, end, i)));
        }
    }
    return VN_OK;
}

// Two neighbours share their common point; they share more when the outline turns back on itself there.
static bool folds_back(const vn_segment *s, const vn_segment *t) {
    double along = (s->x1 - s->x0) * (t->x1 - t->x0) + (s->y1 - s->y0) * (t->y1 - t->y0);
    return along < 0 && vn_turn(s->x0, s->y0, s->x1, s->y1, t->x1, t->y1) == 0;
}

static double clamp_to_unit(double t) {
    return t > 0 ? (t < 1 ? t : 1) : 0;
}

// For people to read: rounding does not matter here.
static void place_crossing(const vn_segment *s, const vn_segment *t, double at[2]) {
    double ux = s->x1 - s->x0, uy = s->y1 - s->y0;
    double vx = t->x1 - t->x0, vy = t->y1 - t->y0;
    double across = ux * vy - uy * vx;
    double along = across != 0 ? ((t->x0 - s->x0) * vy - (t->y0 - s->y0) * vx) / across : 1;
    along = clamp_to_unit(along);
    at[0] = s->x0 + along * ux;
    at[1] = s->y0 + along * uy;
}

static bool visit_candidate(int32_t other, void *payload) {
    crossing_search *search = payload;
    int32_t edge = search->edge;
    if (++search->candidates % CANDIDATES_BETWEEN_POLLS == 0) {
        search->status = vn_poll();
        if (search->status != VN_OK) {
            return false;
        }
    }
    const vn_segment *s = &search->grid.segments.data[edge];
    const vn_segment *t = &search->grid.segments.data[other];
    bool before = search->next.data[edge] == other;
    bool after = search->next.data[other] == edge;
    bool crossing = false;
    if (before || after) {
        crossing =
            before ? folds_back(s, t) : false; // each pair of neighbours is looked at from its first edge
    } else {
        crossing = other > edge && vn_segments_touch(s, t);
    }
    if (!crossing) {
        return true;
    }
    double at[2];
    place_crossing(s, t, at);
    return search->visit(ring_of_point(search->rings, edge), ring_of_point(search->rings, other), at,
                         search->payload);
}

static double lesser(double a, double b) {
    return a < b ? a : b;
}

static double greater(double a, double b) {
    return a > b ? a : b;
}

static vn_status search_all_edges(crossing_search *search) {
    for (int32_t i = 0; i < search->grid.segments.count; i++) {
        const vn_segment *s = &search->grid.segments.data[i];
        search->edge = i;
        if (i % EDGES_BETWEEN_POLLS == 0) {
            VN_TRY(vn_poll());
        }
        bool more =
            vn_segment_grid_visit(&search->grid, lesser(s->x0, s->x1), lesser(s->y0, s->y1),
                                  greater(s->x0, s->x1), greater(s->y0, s->y1), visit_candidate, search);
        if (!more) {
            break;
        }
    }
    return search->status;
}

static vn_status run_search(crossing_search *search) {
    VN_TRY(push_edges(search));
    VN_TRY(vn_segment_grid_build(&search->grid));
    return search_all_edges(search);
}

vn_status vn_rings_visit_crossings(const vn_rings *rings, vn_crossing_fn *visit, void *payload) {
    if (rings->ends.count == 0) {
        return VN_OK;
    }
    crossing_search search = {.rings = rings, .visit = visit, .payload = payload};
    vn_status status = run_search(&search);
    vn_segment_grid_free(&search.grid);
    vn_array_free(&search.next);
    return status;
}

typedef struct first_crossing {
    bool found;
    int32_t ring, other;
    double at[2];
} first_crossing;

static bool keep_first(int32_t ring, int32_t other, const double at[2], void *payload) {
    first_crossing *first = payload;
    *first = (first_crossing){true, ring, other, {at[0], at[1]}};
    return false;
}

// An area of 0 does not say so: the halves of a bow tie cancel.
static bool lies_on_line(const vn_rings *rings, int32_t ring) {
    int32_t begin = vn_rings_begin(rings, ring);
    const double *x = rings->x.data, *y = rings->y.data;
    for (int32_t i = begin + 2; i < rings->ends.data[ring]; i++) {
        if (vn_turn(x[begin], y[begin], x[begin + 1], y[begin + 1], x[i], y[i]) != 0) {
            return false;
        }
    }
    return true;
}

static vn_status check_areas(const vn_rings *rings, const char *what) {
    for (int32_t ring = 0; ring < rings->ends.count; ring++) {
        if (lies_on_line(rings, ring)) {
            int32_t begin = vn_rings_begin(rings, ring);
            return vn_fail(VN_INVALID,
                           "%s: the outline at (%.6g, %.6g) has no area: its points lie on a line", what,
                           rings->x.data[begin], rings->y.data[begin]);
        }
    }
    return VN_OK;
}

vn_status vn_rings_check_simple(const vn_rings *rings, const char *what) {
    VN_TRY(check_areas(rings, what));
    first_crossing first = {0};
    VN_TRY(vn_rings_visit_crossings(rings, keep_first, &first));
    if (!first.found) {
        return VN_OK;
    }
    if (first.ring == first.other) {
        return vn_fail(
            VN_INVALID,
            "%s: the outline crosses itself near (%.6g, %.6g): its edges may share no point but the "
            "ends of neighbours",
            what, first.at[0], first.at[1]);
    }
    return vn_fail(
        VN_INVALID,
        "%s: two outlines cross near (%.6g, %.6g): keep holes and parts apart, or combine domains with "
        "+ and -",
        what, first.at[0], first.at[1]);
}
