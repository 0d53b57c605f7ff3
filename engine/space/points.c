#include "space/points.h"

static uint64_t spread(uint64_t bits, int dim, int width) {
    uint64_t key = 0;
    for (int i = 0; i < width; i++) {
        key |= ((bits >> i) & 1u) << (i * dim);
    }
    return key;
}

uint64_t vn_morton(const double p[3], int dim, const double min[3], double size) {
    int width = dim == 3 ? 14 : 20;
    double cells = (double)(1 << width);
    uint64_t key = 0;
    for (int k = 0; k < dim; k++) {
        double t = size > 0 ? (p[k] - min[k]) / size * cells : 0;
        double inside = fmin(fmax(t, 0), cells - 1);
        key |= spread((uint64_t)inside, dim, width) << k;
    }
    return key;
}
