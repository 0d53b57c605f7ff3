// Growth from outline to outline (Webb 2020). A step's mean value coordinates carry the tissue along; within
// a step it moves on straight lines, so that maps of parts of steps compose like those of whole ones.

#include "domain/crossing.h"
#include "growth/growth.h"
#include "growth/mean_value.h"

#include <stdio.h>
#include <stdlib.h>

typedef struct morph {
    vn_growth growth;
    int32_t keys, corners; ///< of each key outline
    VN_ARRAY(double) x;    ///< corner c of key k is x[k * corners + c]
    VN_ARRAY(double) y;
    // The step whose outlines are at hand, and which parts of it the prepared move begins and ends at.
    VN_ARRAY(double) around; ///< the outline before (x, y) and after (x, y) that step
    int32_t step;
    double begin, end;
} morph;

static const vn_morph_def morph_default = {.steps = 100, .samples = 512, .split = 2};

static const vn_field morph_fields[] = {
    {"domains", VN_MIXED, VN_REQUIRED, 0, 0, 0, "", "table of domains {a, b, …}",
     "the outlines from first to last, each of one ring"},
    {"origin", VN_POINT, VN_OPTIONAL, offsetof(vn_morph_def, origin), -VN_HUGE, VN_HUGE, "length", NULL,
     "outlines are matched from their points nearest to it; left out: from their lowest points"},
    {"steps", VN_I32, 0, offsetof(vn_morph_def, steps), 1, 1e8, "steps", NULL,
     "how many steps there are from the first outline to the last"},
    {"samples", VN_I32, 0, offsetof(vn_morph_def, samples), 8, 1e6, "points", NULL,
     "evenly spaced points that an outline is made of, besides its corners"},
    {"split", VN_F64, 0, offsetof(vn_morph_def, split), 0, 1e150, "length", NULL,
     "edges that growth makes longer than this are split; about two vein segments; 0: none"},
};
const vn_schema vn_morph_schema =
    VN_SCHEMA("morph", "A blade that grows from outline to outline", morph_fields, morph_default);

vn_morph_def vn_morph_def_default(void) {
    return morph_default;
}

// ---- Points at equal parts of every outline ----

/// A key outline as a way round it.
typedef struct track {
    vn_rings rings;
    VN_ARRAY(double) at; ///< the way from point 0 to each point, and round to point 0 again
    double round;        ///< the last of these
    double start;        ///< where on it the outlines are matched
} track;

static void free_track(track *t) {
    vn_rings_free(&t->rings);
    vn_array_free(&t->at);
}

static vn_status measure_track(track *t) {
    int32_t count = t->rings.x.count;
    const double *x = t->rings.x.data, *y = t->rings.y.data;
    double way = 0;
    VN_TRY(vn_array_push(&t->at, way));
    for (int32_t i = 0; i < count; i++) {
        int32_t j = vn_rings_next(0, count, i);
        way += hypot(x[j] - x[i], y[j] - y[i]);
        VN_TRY(vn_array_push(&t->at, way));
    }
    t->round = way;
    return VN_OK;
}

static vn_status find_start(track *t, const double *origin) {
    double lowest[3], d2, q[2];
    vn_segment_grid grid = {0};
    vn_growth_lowest_point(&t->rings, lowest);
    const double *from = origin != NULL ? origin : lowest;
    vn_status status = vn_rings_edges(&t->rings, &grid);
    status = status == VN_OK ? vn_segment_grid_build(&grid) : status;
    if (status == VN_OK) {
        int32_t i = vn_segment_grid_nearest(&grid, from[0], from[1], &d2, q);
        t->start = t->at.data[i] + hypot(q[0] - t->rings.x.data[i], q[1] - t->rings.y.data[i]);
    }
    vn_segment_grid_free(&grid);
    return status;
}

static vn_status make_track(track *t, const vn_domain *domain, int32_t number, const double *origin) {
    char what[48];
    snprintf(what, sizeof what, "morph.domains[%d]", number);
    if (domain->dim != 2 || domain->kind->is_grown != NULL) {
        return vn_fail(VN_INVALID, "%s must be flat and must not grow itself", what);
    }
    VN_TRY(vn_domain_outline(domain, VN_FINE_SIDES, &t->rings));
    if (t->rings.ends.count != 1) {
        return vn_fail(VN_INVALID, "%s has %d outlines; those between which a blade grows have one", what,
                       t->rings.ends.count);
    }
    VN_TRY(vn_rings_check_simple(&t->rings, what));
    VN_TRY(measure_track(t));
    return find_start(t, origin);
}

// The point at a part of the way round from the start, 0 to 1.
static void point_at(const track *t, double part, double *x, double *y) {
    double way = fmod(t->start + part * t->round, t->round);
    int32_t low = 0, high = t->at.count - 1;
    while (high - low > 1) {
        int32_t middle = low + (high - low) / 2;
        if (t->at.data[middle] <= way) {
            low = middle;
        } else {
            high = middle;
        }
    }
    int32_t next = vn_rings_next(0, t->rings.x.count, low);
    double edge = t->at.data[low + 1] - t->at.data[low];
    double s = edge > 0 ? (way - t->at.data[low]) / edge : 0;
    *x = t->rings.x.data[low] + s * (t->rings.x.data[next] - t->rings.x.data[low]);
    *y = t->rings.y.data[low] + s * (t->rings.y.data[next] - t->rings.y.data[low]);
}

typedef VN_ARRAY(double) parts;

// A turn by more than two degrees; between two samples it would be cut off.
static bool is_corner(const vn_rings *rings, int32_t i) {
    int32_t count = rings->x.count, j = vn_rings_next(0, count, i), h = i > 0 ? i - 1 : count - 1;
    const double *x = rings->x.data, *y = rings->y.data;
    double ux = x[i] - x[h], uy = y[i] - y[h], vx = x[j] - x[i], vy = y[j] - y[i];
    return ux * vx + uy * vy < 0.9994 * hypot(ux, uy) * hypot(vx, vy);
}

static vn_status push_corners(parts *p, const track *t) {
    for (int32_t i = 0; i < t->rings.x.count; i++) {
        double part = (t->at.data[i] - t->start) / t->round;
        if (is_corner(&t->rings, i)) {
            VN_TRY(vn_array_push(p, part < 0 ? part + 1 : part));
        }
    }
    return VN_OK;
}

static int by_value(const void *left, const void *right) {
    double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

// Equal parts and the corners of all keys, ascending, those that coincide once.
static vn_status choose_parts(parts *p, const track *tracks, int32_t keys, int32_t samples) {
    for (int32_t i = 0; i < samples; i++) {
        VN_TRY(vn_array_push(p, (double)i / samples));
    }
    for (int32_t k = 0; k < keys; k++) {
        VN_TRY(push_corners(p, &tracks[k]));
    }
    if (p->count == 0) {
        return VN_OK; // never: there are samples
    }
    qsort(p->data, (size_t)p->count, sizeof *p->data, by_value);
    int32_t kept = 1;
    for (int32_t i = 1; i < p->count; i++) {
        if (p->data[i] - p->data[kept - 1] > 1e-9 && p->data[i] < 1 - 1e-9) {
            p->data[kept++] = p->data[i];
        }
    }
    p->count = kept;
    return VN_OK;
}

static vn_status place_corners(morph *m, const track *tracks, const parts *p) {
    m->corners = p->count;
    for (int32_t k = 0; k < m->keys; k++) {
        for (int32_t c = 0; c < p->count; c++) {
            double x, y;
            point_at(&tracks[k], p->data[c], &x, &y);
            VN_TRY(vn_array_push(&m->x, x));
            VN_TRY(vn_array_push(&m->y, y));
        }
    }
    return vn_array_zero(&m->around, 4 * (int64_t)m->corners);
}

static vn_status take_keys(morph *m, const vn_morph_def *def) {
    VN_ARRAY(track) tracks = {0};
    parts p = {0};
    vn_status status = vn_array_zero(&tracks, m->keys);
    for (int32_t k = 0; status == VN_OK && k < m->keys; k++) {
        status = make_track(&tracks.data[k], def->domains[k], k + 1, def->has_origin ? def->origin : NULL);
    }
    status = status == VN_OK ? choose_parts(&p, tracks.data, m->keys, def->samples) : status;
    status = status == VN_OK ? place_corners(m, tracks.data, &p) : status;
    for (int32_t k = 0; k < tracks.count; k++) {
        free_track(&tracks.data[k]);
    }
    vn_array_free(&tracks);
    vn_array_free(&p);
    return status;
}

// ---- Shapes and moves ----

// Corner @p c at a whole step.
static void corner_at(const morph *m, int32_t step, int32_t c, double *x, double *y) {
    double at = (double)step / m->growth.steps * (m->keys - 1);
    int32_t key = (int32_t)fmin(floor(at), m->keys - 2);
    int32_t a = key * m->corners + c, b = a + m->corners;
    *x = m->x.data[a] + (at - key) * (m->x.data[b] - m->x.data[a]);
    *y = m->y.data[a] + (at - key) * (m->y.data[b] - m->y.data[a]);
}

static vn_status morph_outline(vn_growth *growth, double time, vn_rings *out) {
    const morph *m = (const morph *)growth;
    for (int32_t c = 0; c < m->corners; c++) {
        double x, y;
        corner_at(m, (int32_t)time, c, &x, &y);
        VN_TRY(vn_rings_point(out, x, y));
    }
    return vn_rings_close(out);
}

static vn_status morph_step(vn_growth *growth, int32_t time) {
    VN_TRY(vn_today_step(growth, time));
    corner_at((const morph *)growth, time, 0, &growth->origin[0], &growth->origin[1]);
    return VN_OK;
}

static void bring_step(morph *m, int32_t step) {
    double *columns = m->around.data;
    for (int32_t k = 0; k < 2; k++, columns += 2 * (int64_t)m->corners) {
        for (int32_t c = 0; c < m->corners; c++) {
            corner_at(m, step + k, c, &columns[c], &columns[m->corners + c]);
        }
    }
    m->step = step;
}

// Both times lie in one step: vn_growth_map() goes from step to step.
static vn_status morph_prepare(vn_growth *growth, double t1, double t2) {
    morph *m = (morph *)growth;
    if (fmax(t1, t2) > growth->steps) {
        return vn_fail(VN_INVALID, "growth:map of morph: the time %g is after its last step, %d",
                       fmax(t1, t2), growth->steps);
    }
    int32_t step = (int32_t)floor(fmin(t1, t2));
    if (step != m->step) {
        bring_step(m, step);
    }
    m->begin = t1 - step;
    m->end = t2 - step;
    return VN_OK;
}

static void displacement(const morph *m, const double p[2], double d[2]) {
    const double *columns = m->around.data;
    vn_corners before = {columns, columns + m->corners, m->corners};
    vn_corners after = {columns + 2 * m->corners, columns + 3 * m->corners, m->corners};
    vn_mean_value_move(&before, &after, p, d);
    d[0] -= p[0];
    d[1] -= p[1];
}

enum { MOST_ROUNDS = 500 };

// Where what is at @p p was at the beginning of the step: x = p − s d(x), which a step that is no leap makes
// smaller with each round.
static bool go_back(const morph *m, const double p[2], double s, double x[2]) {
    double size = m->growth.base.bounds.max[1] - m->growth.base.bounds.min[1];
    x[0] = p[0];
    x[1] = p[1];
    for (int round = 0; round < MOST_ROUNDS; round++) {
        double d[2];
        displacement(m, x, d);
        double next[2] = {p[0] - s * d[0], p[1] - s * d[1]};
        double change = hypot(next[0] - x[0], next[1] - x[1]);
        x[0] = next[0];
        x[1] = next[1];
        if (change <= 1e-15 * size) {
            return true;
        }
    }
    return false;
}

static bool morph_move(const vn_growth *growth, const double p[3], double q[3]) {
    const morph *m = (const morph *)growth;
    double x[2] = {p[0], p[1]}, d[2];
    if (m->begin > 0 && !go_back(m, p, m->begin, x)) {
        return false;
    }
    displacement(m, x, d);
    q[0] = x[0] + m->end * d[0];
    q[1] = x[1] + m->end * d[1];
    q[2] = p[2];
    return true;
}

static void morph_destroy(vn_growth *growth) {
    morph *m = (morph *)growth;
    vn_array_free(&m->x);
    vn_array_free(&m->y);
    vn_array_free(&m->around);
}

static const vn_growth_kind morph_kind = {.name = "morph",
                                          .size = sizeof(morph),
                                          .domain = VN_TODAY_DOMAIN,
                                          .stepwise = true,
                                          .step = morph_step,
                                          .destroy = morph_destroy,
                                          .prepare = morph_prepare,
                                          .move = morph_move,
                                          .outline = morph_outline};

static vn_status check_def(const vn_morph_def *def) {
    VN_TRY(vn_check_def(&vn_morph_schema, def));
    if (def->count < 2) {
        return vn_fail(VN_INVALID, "morph.domains has %d outlines; a blade grows between 2 or more",
                       def->count);
    }
    if (def->steps < def->count - 1) {
        return vn_fail(VN_INVALID, "morph.steps = %d must be %d or more: one from each outline to the next",
                       def->steps, def->count - 1);
    }
    return VN_OK;
}

static vn_status begin(morph *m, const vn_morph_def *def, int32_t keys) {
    m->keys = keys;
    m->step = -1;
    m->growth.steps = def->steps;
    VN_TRY(take_keys(m, def));
    VN_TRY(vn_today_begin(&m->growth, def->steps));
    corner_at(m, 0, 0, &m->growth.origin[0], &m->growth.origin[1]);
    return VN_OK;
}

vn_status vn_growth_morph(vn_growth **out, const vn_morph_def *def) {
    *out = NULL;
    VN_TRY(check_def(def));
    vn_growth_base base = {def->domains[0], def->has_origin ? def->origin : NULL, def->split};
    int32_t keys = def->count;
    vn_growth *growth;
    VN_TRY(vn_growth_make(&growth, &morph_kind, &base));
    vn_status status = begin((morph *)growth, def, keys);
    if (status != VN_OK) {
        vn_growth_release(growth);
        return status;
    }
    *out = growth;
    return VN_OK;
}
