#include "space/triangle_columns.h"

#include "space/triangle_meets.h"

enum { MOST_COLUMNS = 2048 };

void vn_triangle_columns_free(vn_triangle_columns *columns) {
    vn_array_free(&columns->starts);
    vn_array_free(&columns->items);
}

// Never falls as @p value rises, so that what is between two values is in a column between theirs.
static int32_t column_of(const vn_triangle_columns *columns, int k, double value) {
    double at = (value - columns->low[k]) / columns->cell[k];
    return at > 0 ? (int32_t)fmin(at, columns->counts[k] - 1) : 0;
}

/// Columns [first, last] in each direction.
typedef struct span {
    int32_t first[2], last[2];
} span;

static span span_of(const vn_triangle_columns *columns, int32_t i) {
    const vn_triangle *t = &columns->triangles[i];
    span s;
    for (int k = 0; k < 2; k++) {
        s.first[k] = column_of(columns, k, fmin(fmin(t->a[k + 1], t->b[k + 1]), t->c[k + 1]));
        s.last[k] = column_of(columns, k, fmax(fmax(t->a[k + 1], t->b[k + 1]), t->c[k + 1]));
    }
    return s;
}

static int64_t count_entries(const vn_triangle_columns *columns, int32_t count) {
    int64_t entries = 0;
    for (int32_t i = 0; i < count; i++) {
        span s = span_of(columns, i);
        entries += (int64_t)(s.last[0] - s.first[0] + 1) * (s.last[1] - s.first[1] + 1);
    }
    return entries;
}

static void set_cells(vn_triangle_columns *columns, const double size[2], double cell) {
    for (int k = 0; k < 2; k++) {
        columns->counts[k] = (int32_t)fmin(fmax(ceil(size[k] / cell), 1), MOST_COLUMNS);
        columns->cell[k] = size[k] > 0 ? size[k] / columns->counts[k] : 1;
    }
}

static void find_bounds(vn_triangle_columns *columns, int32_t count, double size[2]) {
    for (int k = 0; k < 2; k++) {
        double low = INFINITY, high = -INFINITY;
        for (int32_t i = 0; i < count; i++) {
            const vn_triangle *t = &columns->triangles[i];
            low = fmin(low, fmin(fmin(t->a[k + 1], t->b[k + 1]), t->c[k + 1]));
            high = fmax(high, fmax(fmax(t->a[k + 1], t->b[k + 1]), t->c[k + 1]));
        }
        columns->low[k] = low;
        size[k] = high - low;
    }
}

// About a column a triangle; coarser where large triangles would fill too many.
static int64_t choose_cells(vn_triangle_columns *columns, int32_t count) {
    double size[2];
    find_bounds(columns, count, size);
    double cell = fmax(sqrt(size[0]) * sqrt(size[1] / count), fmax(size[0], size[1]) / MOST_COLUMNS);
    int64_t entries, most = 24 * (int64_t)count + 256;
    do {
        set_cells(columns, size, cell);
        entries = count_entries(columns, count);
        cell *= 2;
    } while (entries > most && columns->counts[0] * (int64_t)columns->counts[1] > 1);
    return entries;
}

static void put_triangle(vn_triangle_columns *columns, int32_t i, bool count) {
    span s = span_of(columns, i);
    for (int32_t row = s.first[1]; row <= s.last[1]; row++) {
        for (int32_t column = s.first[0]; column <= s.last[0]; column++) {
            int64_t c = row * (int64_t)columns->counts[0] + column;
            if (count) {
                columns->starts.data[c + 2]++;
            } else {
                columns->items.data[columns->starts.data[c + 1]++] = i;
            }
        }
    }
}

vn_status vn_triangle_columns_build(vn_triangle_columns *columns, const vn_triangle *triangles,
                                    int32_t count) {
    vn_triangle_columns_free(columns);
    columns->triangles = triangles;
    int64_t entries = choose_cells(columns, count);
    int64_t cells = columns->counts[0] * (int64_t)columns->counts[1];
    VN_TRY(vn_array_zero(&columns->starts, cells + 2));
    VN_TRY(vn_array_zero(&columns->items, entries));
    for (int32_t i = 0; i < count; i++) {
        put_triangle(columns, i, true);
    }
    for (int64_t c = 0; c < cells; c++) {
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): there is a column at least
        columns->starts.data[c + 1] += columns->starts.data[c];
    }
    for (int32_t i = 0; i < count; i++) {
        put_triangle(columns, i, false);
    }
    return VN_OK;
}

bool vn_triangle_columns_odd(const vn_triangle_columns *columns, const double p[3], int32_t skip,
                             bool *touched) {
    int64_t c = column_of(columns, 1, p[2]) * (int64_t)columns->counts[0] + column_of(columns, 0, p[1]);
    bool odd = false;
    for (int32_t k = columns->starts.data[c]; k < columns->starts.data[c + 1]; k++) {
        int32_t i = columns->items.data[k];
        odd ^= i != skip && vn_ray_passes(&columns->triangles[i], p, touched);
    }
    return odd;
}
