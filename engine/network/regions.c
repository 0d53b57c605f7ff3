// From walks to regions: each connected part has one walk round its outside, and lies as a whole in a region
// of another part or outside of them all. What is nearest to the left of its leftmost node tells which.

#include "network/leaf.h"

typedef struct part {
    int32_t leftmost; // node; of equal x the lowest
    int32_t outside;  // the walk round it
} part;

typedef VN_ARRAY(part) part_list;

// Twice the area that the walk runs round to the left, from its first node for the sake of precision.
static double trace(vn_faces *faces, int32_t first, int32_t walk) {
    const double *x = faces->network->x.data, *y = faces->network->y.data;
    double x0 = x[faces->from.data[first]], y0 = y[faces->from.data[first]], area = 0;
    int32_t h = first;
    do {
        int32_t v = faces->from.data[h], w = faces->from.data[h ^ 1];
        area += (x[v] - x0) * (y[w] - y0) - (x[w] - x0) * (y[v] - y0);
        faces->walk.data[h] = walk;
        h = faces->after.data[h];
    } while (h != first);
    return area;
}

typedef VN_ARRAY(double) double_list;

static vn_status trace_walks(vn_faces *faces, double_list *areas) {
    int32_t halves = faces->from.count;
    VN_TRY(vn_array_zero(&faces->walk, halves));
    for (int32_t h = 0; h < halves; h++) {
        faces->walk.data[h] = -1;
    }
    for (int32_t h = 0; h < halves; h++) {
        if (faces->walk.data[h] < 0) {
            double area = 0.5 * trace(faces, h, areas->count);
            VN_TRY(vn_array_push(areas, area));
        }
    }
    return VN_OK;
}

// ---- Parts ----

static int32_t part_of(int32_t *above, int32_t tree) {
    while (above[tree] != tree) {
        above[tree] = above[above[tree]];
        tree = above[tree];
    }
    return tree;
}

static void unite_trees(vn_faces *faces, int32_t *above) {
    const vn_network *network = faces->network;
    faces->components = network->roots;
    for (int32_t i = 0; i < network->roots; i++) {
        above[i] = i;
    }
    for (int32_t i = 0; i < network->joins.count; i++) {
        int32_t a = part_of(above, network->tree.data[network->joins.data[i].a]);
        int32_t b = part_of(above, network->tree.data[network->joins.data[i].b]);
        above[a > b ? a : b] = a < b ? a : b;
        faces->components -= a != b;
    }
}

static bool is_left_of(const vn_network *network, int32_t a, int32_t b) {
    const double *x = network->x.data, *y = network->y.data;
    return x[a] < x[b] || (x[a] == x[b] && y[a] < y[b]);
}

// Of the leftmost node all spokes point to the right: beyond the last of them is the outside.
static int32_t outside_at(const vn_faces *faces, int32_t node) {
    const double *x = faces->network->x.data, *y = faces->network->y.data;
    int32_t last = faces->spokes.data[faces->starts.data[node]];
    for (int32_t k = faces->starts.data[node] + 1; k < faces->starts.data[node + 1]; k++) {
        int32_t p = faces->from.data[last ^ 1], q = faces->from.data[faces->spokes.data[k] ^ 1];
        if (vn_turn(x[p], y[p], x[q], y[q], x[node], y[node]) > 0) {
            last = faces->spokes.data[k];
        }
    }
    return faces->walk.data[last];
}

static vn_status list_parts(vn_faces *faces, int32_t *above, int32_t *leftmost, part_list *parts) {
    const vn_network *network = faces->network;
    for (int32_t i = 0; i < network->roots; i++) {
        leftmost[i] = -1;
    }
    unite_trees(faces, above);
    for (int32_t v = 0; v < network->x.count; v++) {
        int32_t *found = &leftmost[part_of(above, network->tree.data[v])];
        bool has_edges = faces->starts.data[v + 1] > faces->starts.data[v];
        if (has_edges && (*found < 0 || is_left_of(network, v, *found))) {
            *found = v;
        }
    }
    for (int32_t i = 0; i < network->roots; i++) {
        if (leftmost[i] >= 0) {
            part next = {leftmost[i], outside_at(faces, leftmost[i])};
            VN_TRY(vn_array_push(parts, next));
        }
    }
    return VN_OK;
}

static vn_status find_parts(vn_faces *faces, part_list *parts) {
    VN_ARRAY(int32_t) trees = {0};
    VN_TRY(vn_array_zero(&trees, 2 * (int64_t)faces->network->roots));
    vn_status status = VN_OK;
    if (trees.count > 0) {
        status = list_parts(faces, trees.data, trees.data + faces->network->roots, parts);
    }
    vn_array_free(&trees);
    return status;
}

// By x, then by y: the part that a part lies in comes before it.
static vn_status sort_parts(const vn_network *network, part_list *parts) {
    vn_keyed_array keys = {0}, scratch = {0};
    part_list sorted = {0};
    vn_status status = vn_array_reserve(&sorted, parts->count);
    for (int32_t i = 0; status == VN_OK && i < parts->count; i++) {
        vn_keyed key = {vn_sortable(network->y.data[parts->data[i].leftmost]), i};
        status = vn_array_push(&keys, key);
    }
    status = status == VN_OK ? vn_sort_keyed(&keys, &scratch) : status;
    for (int32_t i = 0; i < keys.count; i++) {
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): a key for every part
        keys.data[i].key = vn_sortable(network->x.data[parts->data[keys.data[i].value].leftmost]);
    }
    status = status == VN_OK ? vn_sort_keyed(&keys, &scratch) : status;
    for (int32_t i = 0; status == VN_OK && i < keys.count; i++) {
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): room for every part
        sorted.data[sorted.count++] = parts->data[keys.data[i].value];
    }
    for (int32_t i = 0; i < sorted.count; i++) {
        parts->data[i] = sorted.data[i];
    }
    vn_array_free(&keys);
    vn_array_free(&scratch);
    vn_array_free(&sorted);
    return status;
}

// ---- What is to the left ----

typedef struct left_search {
    const vn_faces *faces;
    double x, y;
    int32_t best; // the half-edge that runs up, or -1
} left_search;

static vn_segment upward(const vn_faces *faces, int32_t half) {
    vn_segment s = faces->grid.segments.data[half / 2];
    return half % 2 == 0 ? s : (vn_segment){s.x1, s.y1, s.x0, s.y0};
}

// Which of two edges, which run up through one height and do not cross, is to the right there.
static bool is_right_of(const vn_segment *s, const vn_segment *t) {
    if (s->y0 < t->y0) {
        return !is_right_of(t, s);
    }
    double turn = vn_turn(t->x0, t->y0, t->x1, t->y1, s->x0, s->y0);
    if (turn != 0) {
        return turn < 0;
    }
    return s->y1 <= t->y1 ? vn_turn(t->x0, t->y0, t->x1, t->y1, s->x1, s->y1) < 0
                          : vn_turn(s->x0, s->y0, s->x1, s->y1, t->x1, t->y1) > 0;
}

// A node at the very height counts as below it.
static bool try_left(int32_t edge, void *payload) {
    left_search *search = payload;
    const vn_segment *given = &search->faces->grid.segments.data[edge];
    int32_t half = 2 * edge + (given->y0 > given->y1);
    vn_segment s = upward(search->faces, half);
    bool passes = s.y0 <= search->y && search->y < s.y1;
    if (passes && vn_turn(s.x0, s.y0, s.x1, s.y1, search->x, search->y) < 0) {
        vn_segment best = search->best >= 0 ? upward(search->faces, search->best) : s;
        if (search->best < 0 || is_right_of(&s, &best)) {
            search->best = half;
        }
    }
    return true;
}

// Cell by cell to the left, until what was found lies in a column that was searched.
static int32_t region_at(const vn_faces *faces, int32_t node) {
    const vn_segment_grid *grid = &faces->grid;
    left_search search = {faces, faces->network->x.data[node], faces->network->y.data[node], -1};
    for (int32_t column = (int32_t)((search.x - grid->min_x) / grid->cell); column >= 0; column--) {
        double x = grid->min_x + (column + 0.5) * grid->cell;
        vn_segment_grid_visit(grid, x, search.y, x, search.y, try_left, &search);
        if (search.best >= 0) {
            vn_segment s = upward(faces, search.best);
            double found = s.x0 + (search.y - s.y0) / (s.y1 - s.y0) * (s.x1 - s.x0);
            if (found > grid->min_x + (column + 1e-6) * grid->cell) {
                break;
            }
        }
    }
    return search.best >= 0 ? vn_faces_left(faces, search.best ^ 1) : -1;
}

// ---- Regions ----

static vn_status number_regions(vn_faces *faces, const part_list *parts, const double_list *areas) {
    enum { INSIDE = 0, OUTSIDE = -1 };
    int32_t count = 0;
    VN_TRY(vn_array_zero(&faces->region, areas->count));
    for (int32_t i = 0; i < parts->count; i++) {
        faces->region.data[parts->data[i].outside] = OUTSIDE;
    }
    for (int32_t w = 0; w < areas->count; w++) {
        if (faces->region.data[w] == INSIDE) {
            faces->region.data[w] = count++;
        }
    }
    for (int32_t i = 1; i < parts->count; i++) {
        faces->region.data[parts->data[i].outside] = region_at(faces, parts->data[i].leftmost);
    }
    VN_TRY(vn_array_zero(&faces->area, count));
    return vn_array_zero(&faces->perimeter, count);
}

static void measure_regions(vn_faces *faces, const double_list *areas) {
    for (int32_t w = 0; w < areas->count; w++) {
        if (faces->region.data[w] >= 0) {
            faces->area.data[faces->region.data[w]] += areas->data[w];
        }
    }
    for (int32_t h = 0; h < faces->from.count; h++) {
        const vn_segment *s = &faces->grid.segments.data[h / 2];
        int32_t region = vn_faces_left(faces, h);
        if (region >= 0 && vn_faces_left(faces, h ^ 1) != region) {
            double dx = s->x1 - s->x0, dy = s->y1 - s->y0;
            faces->perimeter.data[region] += sqrt(dx * dx + dy * dy);
        }
    }
}

vn_status vn_faces_find_regions(vn_faces *faces) {
    double_list areas = {0};
    part_list parts = {0};
    vn_status status = trace_walks(faces, &areas);
    status = status == VN_OK ? find_parts(faces, &parts) : status;
    status = status == VN_OK ? sort_parts(faces->network, &parts) : status;
    status = status == VN_OK ? number_regions(faces, &parts, &areas) : status;
    if (status == VN_OK) {
        measure_regions(faces, &areas);
    }
    vn_array_free(&areas);
    vn_array_free(&parts);
    return status;
}
