#include "space/cover.h"

#include <math.h>

static const double MOST_BITS = 1 << 24;

static double bits_of(int dim, const double low[3], const double high[3], double cell) {
    double bits = 1;
    for (int k = 0; k < dim; k++) {
        double cells = floor((high[k] - low[k]) / cell) + 2;
        bits *= k == 0 ? cells + 64 : cells;
    }
    return bits;
}

vn_status vn_cover_init(vn_cover *cover, int dim, const double low[3], const double high[3], double radius) {
    double cell = radius / (dim == 2 ? 6 : 3);
    while (cell <= 0.4 * radius && !(bits_of(dim, low, high, cell) <= MOST_BITS)) {
        cell *= 1.25;
    }
    cover->dim = dim;
    cover->cell = cover->per_cell = 0; // until there is room for it
    cover->radius = radius;
    cover->size[0] = cover->size[1] = cover->size[2] = 1;
    if (!(cell <= 0.4 * radius)) {
        return VN_OK;
    }
    for (int k = 0; k < dim; k++) {
        cover->low[k] = low[k];
        cover->size[k] = (int32_t)((high[k] - low[k]) / cell) + 2;
    }
    cover->words = (cover->size[0] + 63) / 64;
    int64_t words = (int64_t)cover->words * cover->size[1] * cover->size[2];
    VN_TRY(vn_array_reserve(&cover->bits, words));
    memset(cover->bits.data, 0, (size_t)words * sizeof *cover->bits.data);
    cover->bits.count = (int32_t)words;
    cover->cell = cell;
    cover->per_cell = 1 / cell;
    return VN_OK;
}

void vn_cover_free(vn_cover *cover) {
    vn_array_free(&cover->bits);
    cover->cell = 0;
}

static void set_bits(uint64_t *row, int32_t begin, int32_t end) {
    for (int32_t word = begin >> 6; word <= (end - 1) >> 6; word++) {
        int32_t from = begin > word * 64 ? begin - word * 64 : 0;
        int32_t to = end < word * 64 + 64 ? end - word * 64 : 64;
        uint64_t upper = to == 64 ? 0 : ~UINT64_C(0) << to;
        row[word] |= (~UINT64_C(0) << from) & ~upper;
    }
}

// Cells [*begin, *end) along axis @p k that an interval about @p p holds wholly. The border between two cells
// is known to some 1e-15 of the box: a cell so near to the end of the interval is left out.
static void cells_within(const vn_cover *cover, int k, double p, double half, int32_t *begin, int32_t *end) {
    double middle = (p - cover->low[k]) * cover->per_cell, reach = half * cover->per_cell - 1e-6;
    double first = middle - reach, last = middle + reach, size = cover->size[k];
    bool beyond = !(last > 0 && first < size);
    *begin = first > 0 && !beyond ? (int32_t)first + 1 : 0;
    *end = beyond ? 0 : last < size ? (int32_t)last : cover->size[k];
}

// The square of the distance from @p p to the far side of cell @p i.
static double farthest2(const vn_cover *cover, int k, double p, int32_t i) {
    double side = p - cover->low[k] - i * cover->cell, other = cover->cell - side;
    double far = side > other ? side : other;
    return far * far;
}

static void cover_row(vn_cover *cover, const double p[3], int32_t j, int32_t k, double half2) {
    int32_t begin, end;
    if (half2 > 0) {
        cells_within(cover, 0, p[0], sqrt(half2), &begin, &end);
        if (begin < end) {
            set_bits(cover->bits.data + ((int64_t)k * cover->size[1] + j) * cover->words, begin, end);
        }
    }
}

static void cover_slice(vn_cover *cover, const double p[3], int32_t k, double half2) {
    int32_t begin, end;
    cells_within(cover, 1, p[1], sqrt(half2), &begin, &end);
    for (int32_t j = begin; j < end; j++) {
        cover_row(cover, p, j, k, half2 - farthest2(cover, 1, p[1], j));
    }
}

void vn_cover_add(vn_cover *cover, const double p[3]) {
    double radius2 = cover->radius * cover->radius;
    int32_t begin = 0, end = 1;
    if (cover->dim == 3) {
        cells_within(cover, 2, p[2], cover->radius, &begin, &end);
    }
    for (int32_t k = begin; k < end; k++) {
        double half2 = cover->dim == 3 ? radius2 - farthest2(cover, 2, p[2], k) : radius2;
        if (half2 > 0) {
            cover_slice(cover, p, k, half2);
        }
    }
}
