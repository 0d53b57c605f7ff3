#include "domain/domain.h"

#include "space/segment_grid.h"

#include <stdio.h>

/// Horizontal strips, each with the edges that reach into it: a point asks only those of its own strip.
typedef struct strips {
    double min_y, height;
    int32_t count;
    VN_ARRAY(int32_t) starts;
    VN_ARRAY(int32_t) edges;
} strips;

typedef struct polygon {
    vn_domain base;
    vn_rings rings;
    vn_segment_grid grid; ///< its segments are the edges
    strips strips;
} polygon;

// Not by fmin(), fmax() and floor(), which are calls: every node of a leaf asks several times.
static int32_t strip_of(const strips *s, double y) {
    double strip = (y - s->min_y) / s->height, last = s->count - 1;
    return strip > 0 ? (int32_t)(strip < last ? strip : last) : 0;
}

static void strips_of(const strips *s, const vn_segment *edge, int32_t *first, int32_t *last) {
    *first = strip_of(s, fmin(edge->y0, edge->y1));
    *last = strip_of(s, fmax(edge->y0, edge->y1));
}

static int64_t count_entries(const strips *s, const vn_segment_grid *grid) {
    int64_t entries = 0;
    for (int32_t e = 0; e < grid->segments.count; e++) {
        int32_t first, last;
        strips_of(s, &grid->segments.data[e], &first, &last);
        entries += last - first + 1;
    }
    return entries;
}

// As many strips as edges, but fewer where long edges would stand in too many of them.
static int64_t choose_strips(polygon *poly) {
    strips *s = &poly->strips;
    int32_t edges = poly->grid.segments.count;
    double span = poly->base.bounds.max[1] - poly->base.bounds.min[1];
    s->min_y = poly->base.bounds.min[1];
    s->count = edges < 4096 ? edges : 4096;
    for (;;) {
        s->height = span / s->count;
        int64_t entries = count_entries(s, &poly->grid);
        if (entries <= 16 * (int64_t)edges + 65536 || s->count == 1) {
            return entries;
        }
        s->count = (s->count + 1) / 2;
    }
}

static vn_status build_strips(polygon *poly) {
    strips *s = &poly->strips;
    int64_t entries = choose_strips(poly);
    VN_TRY(vn_array_zero(&s->starts, (int64_t)s->count + 2));
    VN_TRY(vn_array_zero(&s->edges, entries));
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t e = 0; e < poly->grid.segments.count; e++) {
            int32_t first, last;
            strips_of(s, &poly->grid.segments.data[e], &first, &last);
            for (int32_t i = first; i <= last; i++) {
                if (pass == 0) {
                    s->starts.data[i + 2]++;
                } else {
                    s->edges.data[s->starts.data[i + 1]++] = e;
                }
            }
        }
        for (int32_t i = 0; pass == 0 && i <= s->count; i++) {
            s->starts.data[i + 1] += s->starts.data[i];
        }
    }
    return VN_OK;
}

// Whether a ray from @p p to the right crosses an edge that it is level with, decided exactly.
static bool is_left_of(const vn_segment *e, bool upward, const double p[3]) {
    if (p[0] < e->x0 && p[0] < e->x1) {
        return true;
    }
    if (p[0] > e->x0 && p[0] > e->x1) {
        return false;
    }
    double turn = vn_turn(e->x0, e->y0, e->x1, e->y1, p[0], p[1]);
    return upward ? turn > 0 : turn < 0;
}

// A ray to the right crosses the border an odd number of times.
static bool polygon_contains(const vn_domain *domain, const double p[3]) {
    const polygon *poly = (const polygon *)domain;
    const strips *s = &poly->strips;
    if (!(p[1] >= domain->bounds.min[1] && p[1] <= domain->bounds.max[1])) {
        return false;
    }
    int32_t strip = strip_of(s, p[1]);
    bool inside = false;
    for (int32_t i = s->starts.data[strip]; i < s->starts.data[strip + 1]; i++) {
        const vn_segment *e = &poly->grid.segments.data[s->edges.data[i]];
        bool upward = e->y0 <= p[1];
        if (upward == (e->y1 <= p[1])) {
            continue;
        }
        inside ^= is_left_of(e, upward, p);
    }
    return inside;
}

static double polygon_closest(const vn_domain *domain, const double p[3], double q[3]) {
    const polygon *poly = (const polygon *)domain;
    double d2;
    q[2] = p[2];
    vn_segment_grid_nearest(&poly->grid, p[0], p[1], &d2, q);
    return sqrt(d2);
}

typedef struct sight {
    const polygon *poly;
    vn_segment line;
} sight;

static bool is_free(int32_t edge, void *payload) {
    const sight *s = payload;
    return !vn_segments_touch(&s->line, &s->poly->grid.segments.data[edge]);
}

static bool polygon_sees(const vn_domain *domain, const double a[3], const double b[3]) {
    const polygon *poly = (const polygon *)domain;
    sight s = {poly, {a[0], a[1], b[0], b[1]}};
    return vn_segment_grid_visit(&poly->grid, fmin(a[0], b[0]), fmin(a[1], b[1]), fmax(a[0], b[0]),
                                 fmax(a[1], b[1]), is_free, &s);
}

static vn_status polygon_outline(const vn_domain *domain, int32_t sides, vn_rings *out) {
    (void)sides;
    return vn_rings_append(out, &((const polygon *)domain)->rings);
}

static void polygon_destroy(vn_domain *domain) {
    polygon *poly = (polygon *)domain;
    vn_rings_free(&poly->rings);
    vn_segment_grid_free(&poly->grid);
    vn_array_free(&poly->strips.starts);
    vn_array_free(&poly->strips.edges);
}

static const vn_domain_kind polygon_kind = {.name = "polygon",
                                            .destroy = polygon_destroy,
                                            .contains = polygon_contains,
                                            .closest = polygon_closest,
                                            .sees = polygon_sees,
                                            .outline = polygon_outline};

static vn_status fill_polygon(polygon *poly) {
    poly->base.polygonal = true;
    poly->base.bounds = vn_rings_bounds(&poly->rings);
    for (int32_t r = 0; r < poly->rings.ends.count; r++) {
        poly->base.measure += vn_rings_area_of(&poly->rings, r);
    }
    if (!(poly->base.measure > 0)) {
        return vn_fail(VN_INFEASIBLE, "polygon: the outline is empty, it has no area");
    }
    VN_TRY(vn_rings_edges(&poly->rings, &poly->grid));
    VN_TRY(vn_segment_grid_build(&poly->grid));
    return build_strips(poly);
}

vn_status vn_domain_from_rings(vn_domain **out, vn_rings *rings, const char *unit) {
    *out = NULL;
    polygon *poly = vn_domain_new(&polygon_kind, sizeof *poly, 2);
    if (poly == NULL) {
        vn_rings_free(rings);
        return vn_fail_memory("a polygon", sizeof *poly);
    }
    poly->rings = *rings;
    *rings = (vn_rings){0};
    snprintf(poly->base.unit, sizeof poly->base.unit, "%s", unit);
    vn_status status = fill_polygon(poly);
    if (status != VN_OK) {
        vn_domain_release(&poly->base);
        return status;
    }
    *out = &poly->base;
    return VN_OK;
}

// Checked as drawn, then cleaned: orientation of rings is free in what comes, and outer rings turn left in
// what leaves.
static vn_status polygon_from_drawn(vn_domain **out, vn_rings *drawn) {
    vn_rings clean = {0};
    vn_status status = vn_rings_check_simple(drawn, "polygon");
    status = status == VN_OK ? vn_rings_resolve(&clean, drawn, VN_FILL_EVEN_ODD) : status;
    status = status == VN_OK ? vn_domain_from_rings(out, &clean, "") : status;
    vn_rings_free(&clean);
    return status;
}

vn_status vn_domain_polygon(vn_domain **out, const double *xy, const int32_t *ring_sizes, int32_t rings) {
    *out = NULL;
    vn_rings drawn = {0};
    vn_status status =
        rings > 0 ? VN_OK : vn_fail(VN_INVALID, "polygon: the outline is empty; give 3 points or more");
    int64_t at = 0;
    for (int32_t r = 0; status == VN_OK && r < rings; r++) {
        if (ring_sizes[r] < 3) {
            status = vn_fail(VN_INVALID, "polygon: ring %d has %d points; an outline needs 3 or more", r + 1,
                             ring_sizes[r]);
        }
        for (int32_t i = 0; status == VN_OK && i < ring_sizes[r]; i++, at++) {
            status = vn_rings_point(&drawn, xy[2 * at], xy[2 * at + 1]);
        }
        status = status == VN_OK ? vn_rings_close(&drawn) : status;
    }
    status = status == VN_OK ? polygon_from_drawn(out, &drawn) : status;
    vn_rings_free(&drawn);
    return status;
}
