#include "network/distance_map.h"

enum {
    POINTS = 40000,
    SOLID_POINTS = 262144,
    MOST_POINTS = 100000000,
    STEPS = 4,     // bins of an octave
    LEAST = -1075, // no double has a lower exponent
    OCTAVES = 2 * 1075,
};

// The lower ends of the bins of [0.5, 1), and what is in their midst: powers of two.
static const double bin_ends[STEPS] = {0.5, 0.5946035575013605, 0.7071067811865476, 0.8408964152537145};
static const double bin_middles[STEPS] = {0.5452538663326288, 0.6484197773255048, 0.7711054127039704,
                                          0.9170040432046712};

typedef struct survey {
    vn_distance_map *map;
    vn_box box;
    int32_t size[3]; // of the grid
    VN_ARRAY(int32_t) bins;
} survey;

static int32_t bin_of(double distance) {
    int exponent, step = STEPS - 1;
    double mantissa = frexp(distance, &exponent);
    while (step > 0 && mantissa < bin_ends[step]) {
        step--;
    }
    return STEPS * (exponent - LEAST) + step;
}

static vn_status add_point(survey *s, const double p[3]) {
    vn_distance_map *map = s->map;
    double distance = map->nearest(map->payload, p);
    if (map->points == 0 || distance > map->max) {
        map->max = distance;
        memcpy(map->furthest, p, sizeof map->furthest);
    }
    map->points++;
    map->mean += distance;
    if (distance > 0 && isfinite(distance)) {
        s->bins.data[bin_of(distance)]++;
    }
    return map->list != NULL ? vn_array_push(map->list, distance) : VN_OK;
}

static double middle_of(const survey *s, int axis, int32_t index) {
    return s->box.min[axis] + (index + 0.5) * s->map->resolution;
}

static vn_status visit_row(survey *s, double y, double z) {
    for (int32_t column = 0; column < s->size[0]; column++) {
        double p[3] = {middle_of(s, 0, column), y, z};
        if (vn_domain_contains(s->map->area, p)) {
            VN_TRY(add_point(s, p));
        }
    }
    return VN_OK;
}

static vn_status visit_grid(survey *s) {
    bool flat = s->map->area->dim == 2;
    for (int32_t layer = 0; layer < s->size[2]; layer++) {
        for (int32_t row = 0; row < s->size[1]; row++) {
            VN_TRY(vn_poll());
            VN_TRY(visit_row(s, middle_of(s, 1, row), flat ? 0 : middle_of(s, 2, layer)));
        }
    }
    return VN_OK;
}

static vn_status visit_surface(survey *s) {
    enum { SEED = 1, TURN = 1024 };
    vn_rng rng = vn_rng_make(SEED);
    for (int32_t i = 0; i < s->size[0]; i++) {
        double p[3];
        VN_TRY(i % TURN == 0 ? vn_poll() : VN_OK);
        VN_TRY(vn_domain_dart(s->map->area, &rng, p));
        VN_TRY(add_point(s, p));
    }
    return VN_OK;
}

static bool is_surface(const vn_domain *domain) {
    return domain->kind->snap != NULL;
}

static double usual_resolution(const vn_domain *area) {
    double measure = vn_domain_measure(area);
    bool solid = area->dim == 3 && !is_surface(area);
    return solid ? cbrt(measure / SOLID_POINTS) : sqrt(measure / POINTS);
}

// A surface's points are counted along the first axis.
static vn_status choose_size(survey *s) {
    vn_distance_map *map = s->map;
    double points = 1, size[3] = {1, 1, 1};
    s->box = vn_domain_bounds(map->area);
    map->resolution = map->resolution > 0 ? map->resolution : usual_resolution(map->area);
    if (is_surface(map->area)) {
        size[0] = ceil(vn_domain_measure(map->area) / map->resolution / map->resolution);
    }
    for (int k = 0; k < map->area->dim && !is_surface(map->area); k++) {
        size[k] = ceil((s->box.max[k] - s->box.min[k]) / map->resolution);
    }
    for (int k = 0; k < 3; k++) {
        points *= size[k];
    }
    if (!(points <= MOST_POINTS)) {
        return vn_fail(VN_INVALID, "%s.resolution = %g makes %g points, and %g are the limit; give more",
                       map->what, map->resolution, points, (double)MOST_POINTS);
    }
    for (int k = 0; k < 3; k++) {
        s->size[k] = (int32_t)size[k];
    }
    return VN_OK;
}

static void find_mode(survey *s) {
    int32_t best = 0;
    for (int32_t i = 1; i < s->bins.count; i++) {
        best = s->bins.data[i] > s->bins.data[best] ? i : best;
    }
    bool any = s->bins.data[best] > 0;
    s->map->mode = any ? ldexp(bin_middles[best % STEPS], best / STEPS + LEAST) : 0;
}

vn_status vn_distance_map_draw(vn_distance_map *map) {
    survey s = {.map = map};
    VN_TRY(choose_size(&s));
    VN_TRY(vn_array_zero(&s.bins, STEPS * OCTAVES));
    vn_status status = is_surface(map->area) ? visit_surface(&s) : visit_grid(&s);
    map->mean /= map->points > 0 ? map->points : 1;
    find_mode(&s);
    vn_array_free(&s.bins);
    return status;
}
