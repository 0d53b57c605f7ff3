// How far a leaf's cells are from its veins, on a square grid of points.

#include "network/leaf.h"

enum {
    POINTS = 40000,
    MOST_POINTS = 100000000,
    STEPS = 4,     // bins of an octave
    LEAST = -1075, // no double has a lower exponent
    OCTAVES = 2 * 1075,
};

// The lower ends of the bins of [0.5, 1), and what is in their midst: powers of two.
static const double bin_ends[STEPS] = {0.5, 0.5946035575013605, 0.7071067811865476, 0.8408964152537145};
static const double bin_middles[STEPS] = {0.5452538663326288, 0.6484197773255048, 0.7711054127039704,
                                          0.9170040432046712};

typedef struct distance_map {
    vn_vein_distance *out;
    const vn_faces *faces;
    const vn_domain *area;
    VN_ARRAY(int32_t) bins;
} distance_map;

static int32_t bin_of(double distance) {
    int exponent, step = STEPS - 1;
    double mantissa = frexp(distance, &exponent);
    while (step > 0 && mantissa < bin_ends[step]) {
        step--;
    }
    return STEPS * (exponent - LEAST) + step;
}

static void add_point(distance_map *map, double x, double y) {
    double distance2, q[2], p[3] = {x, y, 0};
    if (!vn_domain_contains(map->area, p)) {
        return;
    }
    vn_segment_grid_nearest(&map->faces->grid, x, y, &distance2, q);
    double distance = sqrt(distance2);
    map->out->points++;
    map->out->mean += distance;
    map->out->max = fmax(map->out->max, distance);
    if (distance > 0) {
        map->bins.data[bin_of(distance)]++;
    }
}

static vn_status visit_points(distance_map *map, const vn_box *box, int32_t columns, int32_t rows) {
    double step = map->out->resolution;
    for (int32_t row = 0; row < rows; row++) {
        VN_TRY(vn_poll());
        for (int32_t column = 0; column < columns; column++) {
            add_point(map, box->min[0] + (column + 0.5) * step, box->min[1] + (row + 0.5) * step);
        }
    }
    return VN_OK;
}

static void find_mode(distance_map *map) {
    int32_t best = 0;
    for (int32_t i = 1; i < map->bins.count; i++) {
        best = map->bins.data[i] > map->bins.data[best] ? i : best;
    }
    bool any = map->bins.data[best] > 0;
    map->out->mode = any ? ldexp(bin_middles[best % STEPS], best / STEPS + LEAST) : 0;
}

vn_status vn_faces_measure_distance(vn_vein_distance *out, const vn_faces *faces, const vn_domain *area,
                                    double resolution) {
    *out = (vn_vein_distance){0};
    if (area == NULL || vn_faces_edges(faces) == 0) {
        return VN_OK;
    }
    vn_box box = vn_domain_bounds(area);
    out->resolution = resolution > 0 ? resolution : sqrt(vn_domain_measure(area) / POINTS);
    double columns = ceil((box.max[0] - box.min[0]) / out->resolution);
    double rows = ceil((box.max[1] - box.min[1]) / out->resolution);
    if (!(columns * rows <= MOST_POINTS)) {
        return vn_fail(VN_INVALID, "measure.resolution = %g makes %g points, and %g are the limit; give more",
                       out->resolution, columns * rows, (double)MOST_POINTS);
    }
    distance_map map = {.out = out, .faces = faces, .area = area};
    VN_TRY(vn_array_zero(&map.bins, STEPS * OCTAVES));
    vn_status status = visit_points(&map, &box, (int32_t)columns, (int32_t)rows);
    out->mean /= out->points > 0 ? out->points : 1;
    find_mode(&map);
    vn_array_free(&map.bins);
    return status;
}
