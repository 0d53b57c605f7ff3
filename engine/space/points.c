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
    for (int k = 0; k < dim; k++) {
        double t = size > 0 ? (p[k] - min[k]) / size * cells : 0;
        double inside = t > 0 ? t : 0;
        uint64_t bits = (uint64_t)(inside < cells - 1 ? inside : cells - 1);
        key |= (dim == 3 ? spread_by_3(bits) : spread_by_2(bits)) << k;
    }
    return key;
}
