// Whether a network is a drawing in the plane: pairs of edges that cross, touch or lie on each other.

#include "base/sort.h"
#include "network/faces.h"

typedef struct crossing_search {
    const vn_faces *faces;
    vn_keyed_array found, scratch; // by pair; a pair that shares several cells is found in each
} crossing_search;

static bool on_one_side(double v, double p, double q) {
    return (p > v && q > v) || (p < v && q < v);
}

// Whether edges that both end at v lie on each other beyond it.
static bool overlap(const vn_faces *faces, int32_t v, int32_t p, int32_t q) {
    const double *x = faces->network->x.data, *y = faces->network->y.data;
    return (on_one_side(x[v], x[p], x[q]) || on_one_side(y[v], y[p], y[q])) &&
           vn_turn(x[p], y[p], x[q], y[q], x[v], y[v]) == 0;
}

static bool cross(const vn_faces *faces, int32_t e, int32_t g) {
    const int32_t *from = faces->from.data;
    for (int32_t h = 2 * e; h <= 2 * e + 1; h++) {
        for (int32_t k = 2 * g; k <= 2 * g + 1; k++) {
            if (from[h] == from[k]) {
                return overlap(faces, from[h], from[h ^ 1], from[k ^ 1]);
            }
        }
    }
    return vn_segments_touch(&faces->grid.segments.data[e], &faces->grid.segments.data[g]);
}

static vn_status drop_repeats(crossing_search *search) {
    VN_TRY(vn_sort_keyed(&search->found, &search->scratch));
    int32_t kept = 0;
    for (int32_t i = 0; i < search->found.count; i++) {
        vn_keyed pair = search->found.data[i];
        if (kept == 0 || search->found.data[kept - 1].key != pair.key) {
            search->found.data[kept++] = pair;
        }
    }
    search->found.count = kept;
    return VN_OK;
}

static vn_status keep_pair(crossing_search *search, int32_t e, int32_t g) {
    uint64_t low = (uint64_t)(e < g ? e : g), high = (uint64_t)(e < g ? g : e);
    vn_keyed pair = {low << 32 | high, 0};
    VN_TRY(vn_array_push(&search->found, pair));
    return search->found.count >= 2 * VN_MOST_CROSSINGS ? drop_repeats(search) : VN_OK;
}

static vn_status search_cell(crossing_search *search, const int32_t *items, int32_t count) {
    for (int32_t i = 0; i < count; i++) {
        if (i % 1024 == 1023) {
            VN_TRY(vn_poll());
        }
        for (int32_t j = 0; j < i; j++) {
            if (cross(search->faces, items[i], items[j])) {
                VN_TRY(keep_pair(search, items[i], items[j]));
            }
        }
    }
    return VN_OK;
}

static vn_status search_cells(crossing_search *search) {
    const vn_segment_grid *grid = &search->faces->grid;
    int32_t cells = grid->columns * grid->rows;
    for (int32_t c = 0; c < cells && search->found.count < VN_MOST_CROSSINGS; c++) {
        int32_t begin = grid->starts.data[c];
        VN_TRY(search_cell(search, grid->items.data + begin, grid->starts.data[c + 1] - begin));
    }
    return drop_repeats(search);
}

vn_status vn_faces_count_crossings(vn_faces *faces) {
    crossing_search search = {.faces = faces};
    vn_status status = search_cells(&search);
    int32_t found = search.found.count;
    faces->crossings = found < VN_MOST_CROSSINGS ? found : VN_MOST_CROSSINGS;
    vn_array_free(&search.found);
    vn_array_free(&search.scratch);
    return status;
}
