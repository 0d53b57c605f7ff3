// What a closed mesh encloses. In or out is decided by counting triangles along a ray, with exact signs and a
// ray that is moved by next to nothing off all edges: on a mesh whose edges all have an even number of
// triangles that is right for every point, whichever way the triangles turn, and however many shells lie in
// one another. (The sign by the nearest triangle's pseudonormal was the other way: it needs triangles that
// turn alike and a nearest feature that is known exactly, and costs a nearest triangle for each question.)

#include "base/parallel.h"
#include "domain/closed.h"
#include "domain/domain.h"
#include "domain/faces.h"
#include "domain/seams.h"
#include "domain/stretch.h"
#include "space/exact.h"
#include "space/triangle_columns.h"
#include "space/triangle_meets.h"

typedef enum cell_state { CELL_OUT, CELL_IN, CELL_MIXED } cell_state;

/// The bounds in cells. Each knows a triangle near its middle, with which a search begins; and most know that
/// they are all inside, or all outside.
typedef struct cells {
    int32_t counts[3];
    double size[3];
    VN_ARRAY(int32_t) near;    ///< in the tree's order
    VN_ARRAY(uint8_t) state;   ///< a cell_state
    VN_ARRAY(int32_t) not_out; ///< cells that darts are thrown into
} cells;

typedef struct inside {
    vn_domain base;
    vn_triangle_tree tree;
    vn_triangle_columns columns; ///< of the tree's triangles, in its order
    cells cells;
} inside;

static const inside *inside_of(const vn_domain *domain) {
    return (const inside *)domain;
}

static int64_t cell_at(const inside *s, const double p[3]) {
    int64_t cell = 0;
    for (int k = 2; k >= 0; k--) {
        double at = (p[k] - s->base.bounds.min[k]) / s->cells.size[k];
        int32_t i = at > 0 ? (int32_t)fmin(at, s->cells.counts[k] - 1) : 0;
        cell = cell * s->cells.counts[k] + i;
    }
    return cell;
}

// ---- What a domain answers ----

static bool is_enclosed(const inside *s, const double p[3]) {
    bool touched = false;
    return vn_triangle_columns_odd(&s->columns, p, -1, &touched) || touched;
}

static bool inside_contains(const vn_domain *domain, const double p[3]) {
    const inside *s = inside_of(domain);
    for (int k = 0; k < 3; k++) {
        if (!(p[k] >= domain->bounds.min[k] && p[k] <= domain->bounds.max[k])) {
            return false;
        }
    }
    uint8_t state = s->cells.state.data[cell_at(s, p)];
    return state == CELL_MIXED ? is_enclosed(s, p) : state == CELL_IN;
}

// The search looks no farther than the triangle @p near is, but for rounding.
static double nearest_from(const inside *s, int32_t near, const double p[3], double q[3]) {
    double d2, reach2 = vn_triangle_closest(&s->tree.triangles.data[near], p, q);
    vn_triangle_tree_nearest(&s->tree, p, reach2 * (1 + 1e-9), &d2, q);
    return fmin(d2, reach2);
}

static double inside_closest(const vn_domain *domain, const double p[3], double q[3]) {
    const inside *s = inside_of(domain);
    return sqrt(nearest_from(s, s->cells.near.data[cell_at(s, p)], p, q));
}

static bool ends_the_search(int32_t triangle, void *payload) {
    (void)triangle, (void)payload;
    return false;
}

// Mostly the triangle near the cell's middle is near enough, or none is.
static bool inside_is_near(const vn_domain *domain, const double p[3], double reach) {
    const inside *s = inside_of(domain);
    const vn_triangle *near = &s->tree.triangles.data[s->cells.near.data[cell_at(s, p)]];
    double q[3], reach2 = reach * reach;
    return vn_triangle_closest(near, p, q) <= reach2 ||
           !vn_triangle_tree_around(&s->tree, p, reach2, ends_the_search, NULL);
}

/// The ends of a line.
typedef struct sight {
    const double *a, *b;
} sight;

// A triangle whose plane the line is in hides nothing itself: where it ends, or bends, the next one does.
static bool lets_pass(const vn_triangle *triangle, int32_t number, void *payload) {
    (void)number;
    const sight *line = payload;
    return vn_line_meets(triangle, line->a, line->b) != VN_LINE_MEETS;
}

static bool inside_sees(const vn_domain *domain, const double a[3], const double b[3]) {
    sight line = {a, b};
    return vn_triangle_tree_along(&inside_of(domain)->tree, a, b, lets_pass, &line);
}

// Into one of the cells that are not outside: thin shells are hit, too.
static vn_status inside_dart(const vn_domain *domain, vn_rng *rng, double p[3]) {
    const inside *s = inside_of(domain);
    for (int tries = 0; tries < 1000000; tries++) {
        int32_t cell = s->cells.not_out.data[vn_rng_integer(rng, 0, s->cells.not_out.count - 1)];
        for (int k = 0, rest = cell; k < 3; rest /= s->cells.counts[k++]) {
            double at = vn_rng_uniform(rng, 0, 1) + rest % s->cells.counts[k];
            p[k] = domain->bounds.min[k] + at * s->cells.size[k];
        }
        if (s->cells.state.data[cell] == CELL_IN || inside_contains(domain, p)) {
            return VN_OK;
        }
    }
    return vn_domain_fail_dart(domain);
}

static void inside_destroy(vn_domain *domain) {
    inside *s = (inside *)domain;
    vn_triangle_tree_free(&s->tree);
    vn_triangle_columns_free(&s->columns);
    vn_array_free(&s->cells.near);
    vn_array_free(&s->cells.state);
    vn_array_free(&s->cells.not_out);
}

// Each triangle has corners of its own: vn_domain_inside() takes those at one place for one.
static vn_status inside_triangles(const vn_domain *domain, vn_triangles *out) {
    const vn_triangle_tree *tree = &inside_of(domain)->tree;
    int32_t count = tree->triangles.count;
    VN_TRY(vn_array_reserve(&out->xyz, 9 * (int64_t)count));
    VN_TRY(vn_array_reserve(&out->corners, 3 * (int64_t)count));
    out->xyz.count = 9 * count;
    out->corners.count = 3 * count;
    for (int32_t i = 0; i < count; i++) {
        const vn_triangle *t = &tree->triangles.data[i];
        int64_t number = tree->numbers.data[i];
        memcpy(out->xyz.data + 9 * number, t->a, sizeof t->a);
        memcpy(out->xyz.data + 9 * number + 3, t->b, sizeof t->b);
        memcpy(out->xyz.data + 9 * number + 6, t->c, sizeof t->c);
    }
    for (int32_t h = 0; h < 3 * count; h++) {
        out->corners.data[h] = h;
    }
    return VN_OK;
}

// What does not cross itself does not after.
static vn_status inside_stretched(vn_domain **out, const vn_domain *domain, const vn_stretch *stretch) {
    vn_triangles moved = {.xyz = {0}};
    vn_status status = vn_stretch_triangles(domain, stretch, &moved);
    if (status == VN_OK) {
        status = vn_domain_inside(out, moved.xyz.data, moved.xyz.count / 3, moved.corners.data,
                                  moved.corners.count / 3, false);
    }
    vn_triangles_free(&moved);
    return status;
}

static const vn_domain_kind inside_kind = {.name = "mesh",
                                           .destroy = inside_destroy,
                                           .contains = inside_contains,
                                           .closest = inside_closest,
                                           .is_near = inside_is_near,
                                           .sees = inside_sees,
                                           .dart = inside_dart,
                                           .triangles = inside_triangles,
                                           .stretched = inside_stretched};

// ---- Cells ----

enum { FEWEST_CELLS = 4096, MOST_CELLS = 1 << 18, MOST_CELLS_ALONG = 256 };

static void choose_cells(inside *s, int32_t triangles) {
    const vn_box *box = &s->base.bounds;
    double count = fmin(fmax(2.0 * triangles, FEWEST_CELLS), MOST_CELLS), volume = 1;
    for (int k = 0; k < 3; k++) {
        volume *= box->max[k] - box->min[k];
    }
    for (int k = 0; k < 3; k++) {
        double extent = box->max[k] - box->min[k];
        s->cells.counts[k] = (int32_t)fmin(ceil(extent / cbrt(volume / count)), MOST_CELLS_ALONG);
        s->cells.size[k] = extent / s->cells.counts[k];
    }
}

/// Work on the cells: the place of each triangle in the tree's order.
typedef struct cell_work {
    inside *s;
    const int32_t *places;
    int64_t first; ///< row
} cell_work;

static void fill_cell(const cell_work *work, int64_t cell, int32_t *near) {
    inside *s = work->s;
    double p[3], q[3], d2, half2 = 0;
    int64_t rest = cell;
    for (int k = 0; k < 3; rest /= s->cells.counts[k++]) {
        p[k] = s->base.bounds.min[k] + ((double)(rest % s->cells.counts[k]) + 0.5) * s->cells.size[k];
        half2 += 0.25 * s->cells.size[k] * s->cells.size[k];
    }
    double reach2 = vn_triangle_closest(&s->tree.triangles.data[*near], p, q) * (1 + 1e-9);
    int32_t number = vn_triangle_tree_nearest(&s->tree, p, reach2, &d2, q);
    *near = number >= 0 ? work->places[number] : *near;
    s->cells.near.data[cell] = *near;
    bool mixed = d2 <= half2 * (1 + 1e-9);
    s->cells.state.data[cell] = mixed ? CELL_MIXED : is_enclosed(s, p) ? CELL_IN : CELL_OUT;
}

// Each row begins anew, so that it does not matter who filled the one before.
static void fill_rows(int64_t begin, int64_t end, void *payload) {
    const cell_work *work = payload;
    int64_t length = work->s->cells.counts[0];
    for (int64_t row = work->first + begin; row < work->first + end; row++) {
        int32_t near = 0;
        for (int64_t i = 0; i < length; i++) {
            fill_cell(work, row * length + i, &near);
        }
    }
}

static vn_status find_places(const inside *s, vn_corners *places) {
    VN_TRY(vn_array_zero(places, s->tree.numbers.count));
    for (int32_t i = 0; i < places->count; i++) {
        places->data[s->tree.numbers.data[i]] = i;
    }
    return VN_OK;
}

static vn_status fill_cells(inside *s, const vn_corners *places) {
    int64_t rows = (int64_t)s->cells.counts[1] * s->cells.counts[2], count = rows * s->cells.counts[0];
    VN_TRY(vn_array_zero(&s->cells.near, count));
    VN_TRY(vn_array_zero(&s->cells.state, count));
    cell_work work = {s, places->data, 0};
    for (int64_t begin = 0, end; begin < rows; begin = end) {
        end = begin + 1024 < rows ? begin + 1024 : rows;
        VN_TRY(vn_poll());
        work.first = begin;
        vn_parallel_for(end - begin, 16, fill_rows, &work);
    }
    for (int32_t cell = 0; cell < count; cell++) {
        if (s->cells.state.data[cell] != CELL_OUT) {
            VN_TRY(vn_array_push(&s->cells.not_out, cell));
        }
    }
    return VN_OK;
}

static vn_status build_cells(inside *s) {
    vn_corners places = {0};
    choose_cells(s, s->tree.triangles.count);
    vn_status status = find_places(s, &places);
    status = status == VN_OK ? fill_cells(s, &places) : status;
    vn_array_free(&places);
    return status;
}

// ---- Construction ----

static void find_bounds(inside *s) {
    vn_box *box = &s->base.bounds;
    for (int k = 0; k < 3; k++) {
        box->min[k] = INFINITY;
        box->max[k] = -INFINITY;
        for (int32_t i = 0; i < s->tree.triangles.count; i++) {
            const vn_triangle *t = &s->tree.triangles.data[i];
            box->min[k] = fmin(box->min[k], fmin(fmin(t->a[k], t->b[k]), t->c[k]));
            box->max[k] = fmax(box->max[k], fmax(fmax(t->a[k], t->b[k]), t->c[k]));
        }
    }
}

// The divergence theorem for the field (x, 0, 0). Which side of a triangle is outside is found as for a
// point: how a file's triangles turn does not matter.
static vn_status measure(inside *s, const char *what) {
    double volume = 0, area = 0, middle = 0.5 * s->base.bounds.min[0] + 0.5 * s->base.bounds.max[0];
    for (int32_t i = 0; i < s->tree.triangles.count; i++) {
        const vn_triangle *t = &s->tree.triangles.data[i];
        double part = 0.5 * fabs(vn_turn(t->a[1], t->a[2], t->b[1], t->b[2], t->c[1], t->c[2])), p[3];
        bool touched = false;
        for (int k = 0; k < 3; k++) {
            p[k] = t->a[k] / 3 + t->b[k] / 3 + t->c[k] / 3;
        }
        bool inner = part > 0 && vn_triangle_columns_odd(&s->columns, p, i, &touched);
        volume += (inner ? -part : part) * (p[0] - middle);
        area += part;
    }
    if (!(volume > 1e-12 * area * (s->base.bounds.max[0] - s->base.bounds.min[0]))) {
        return vn_fail(VN_INVALID,
                       "%s: the mesh encloses no volume: its triangles lie on one another; take its surface "
                       "(on = \"surface\"), or give it thickness",
                       what);
    }
    s->base.measure = volume;
    return VN_OK;
}

/// What is needed while a mesh is made a domain.
typedef struct making {
    vn_corners corners, first, mate;
    VN_ARRAY(vn_triangle) triangles;
} making;

static void free_making(making *m) {
    vn_array_free(&m->corners);
    vn_array_free(&m->first);
    vn_array_free(&m->mate);
    vn_array_free(&m->triangles);
}

static vn_status join_triangles(making *m, const vn_faces *faces) {
    VN_TRY(vn_faces_triangulate(faces, &m->corners));
    VN_TRY(vn_seams_link(faces->xyz, faces->vertices, &m->corners, &m->first, &m->mate));
    VN_TRY(vn_array_zero(&m->triangles, m->corners.count / 3));
    for (int32_t h = 0; h < m->corners.count; h++) {
        vn_triangle *t = &m->triangles.data[h / 3];
        m->corners.data[h] = m->first.data[m->corners.data[h]];
        memcpy(h % 3 == 0   ? t->a
               : h % 3 == 1 ? t->b
                            : t->c,
               faces->xyz + 3 * (int64_t)m->corners.data[h], sizeof t->a);
    }
    return VN_OK;
}

static vn_status fill_inside(inside *s, making *m, const vn_faces *faces, bool check) {
    vn_closed closed = {faces, &m->corners, &m->mate, &s->tree};
    VN_TRY(join_triangles(m, faces));
    VN_TRY(vn_closed_check_edges(&closed));
    VN_TRY(vn_triangle_tree_build(&s->tree, m->triangles.data, m->triangles.count));
    VN_TRY(check ? vn_closed_check_crossings(&closed) : VN_OK);
    VN_TRY(vn_triangle_columns_build(&s->columns, s->tree.triangles.data, s->tree.triangles.count));
    find_bounds(s);
    VN_TRY(measure(s, faces->what));
    return build_cells(s);
}

vn_status vn_domain_faces_inside(vn_domain **out, const vn_faces *faces, bool check) {
    *out = NULL;
    inside *s = vn_domain_new(&inside_kind, sizeof *s, 3);
    if (s == NULL) {
        return vn_fail_memory("the inside of a mesh", sizeof *s);
    }
    making m = {.corners = {0}};
    vn_status status = fill_inside(s, &m, faces, check);
    free_making(&m);
    if (status != VN_OK) {
        vn_domain_release(&s->base);
        return status;
    }
    *out = &s->base;
    return VN_OK;
}

vn_status vn_domain_inside(vn_domain **out, const double *xyz, int32_t vertices, const int32_t *triangles,
                           int32_t count, bool check) {
    vn_faces faces = {
        .what = "inside", .xyz = xyz, .vertices = vertices, .corners = triangles, .count = count};
    return vn_domain_faces_inside(out, &faces, check);
}
