#include "space/points.h"

// Put a zero between any two of the low 32 bits; two zeros between any two of the low 21.
static uint64_t spread_by_2(uint64_t bits) {
    bits = (bits | bits << 16) & 0x0000FFFF0000FFFFu;
    bits = (bits | bits << 8) & 0x00FF00FF00FF00FFu;
    bits = (bits | bits << 4) & 0x0F0F0F0F0F0F0F0Fu;
    bits = (bits | bits << 2) & 0x3333333333333333u;
    return (bits | bits << 1) & 0x5555555555555555u;
}

static uint64_t spread_by_3(uint64_t bits) {
    bits = (bits | bits << 32) & 0x001F00000000FFFFu;
    bits = (bits | bits << 16) & 0x001F0000FF0000FFu;
    bits = (bits | bits << 8) & 0x100F00F00F00F00Fu;
    bits = (bits | bits << 4) & 0x10C30C30C30C30C3u;
    return (bits | bits << 2) & 0x1249249249249249u;
}

uint64_t vn_morton(const double p[3], int dim, const double min[3], double size) {
    int width = dim == 3 ? 14 : 20;
    double cells = (double)(1 << width);
    uint64_t key = 0;
    for (int k = 0; k < dim && k < 3; k++) {
        double t = size > 0 ? (p[k] - min[k]) / size * cells : 0;
        double inside = t > 0 ? t : 0;
        uint64_t bits = (uint64_t)(inside < cells - 1 ? inside : cells - 1);
        key |= (dim == 3 ? spread_by_3(bits) : spread_by_2(bits)) << k;
    }
    return key;
}

double vn_halton(int32_t index, int32_t base) {
    double value = 0, part = 1;
    for (int32_t i = index; i > 0; i /= base) {
        part /= base;
        value += part * (i % base);
    }
    return value;
}

double vn_points_extent(const vn_points *points, int32_t begin, int32_t end, double low[3], double high[3]) {
    double size = -INFINITY;
    for (int k = 0; k < 3; k++) {
        low[k] = INFINITY;
        high[k] = -INFINITY;
    }
    for (int32_t i = begin; i < end; i++) {
        double p[3];
        vn_points_get(points, i, p);
        for (int k = 0; k < 3; k++) {
            low[k] = p[k] < low[k] ? p[k] : low[k];
            high[k] = p[k] > high[k] ? p[k] : high[k];
        }
    }
    for (int k = 0; k < 3; k++) {
        size = fmax(size, high[k] - low[k]);
    }
    return size;
}

// Keys as fine as the points are many: about sixteen cells for each, so that a small set is sorted in few
// passes.
static int spare_bits(int dim, int32_t count) {
    int width = dim == 3 ? 14 : 20;
    int wanted = 2;
    while (wanted < width && (int64_t)1 << (wanted * dim) < 16 * (int64_t)count) {
        wanted++;
    }
    return (width - wanted) * dim;
}

vn_status vn_points_sort(const vn_points *points, int dim, const double low[3], double size,
                         vn_keyed_array *items, vn_keyed_array *scratch) {
    int spare = spare_bits(dim, items->count);
    for (int32_t i = 0; i < items->count; i++) {
        double p[3];
        vn_points_get(points, items->data[i].value, p);
        items->data[i].key = vn_morton(p, dim, low, size) >> spare;
    }
    return vn_sort_keyed(items, scratch);
}
