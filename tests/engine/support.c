#include "support.h"

static size_t bytes_before;

int count_bytes(void **state) {
    (void)state;
    bytes_before = vn_byte_count();
    return 0;
}

int check_bytes(void **state) {
    (void)state;
    if (vn_byte_count() == bytes_before) {
        return 0;
    }
    print_error("%zu bytes are held, and were %zu before\n", vn_byte_count(), bytes_before);
    return -1;
}

void check_message(const char *part, const char *file, int line) {
    if (strstr(vn_message(), part) == NULL) {
        print_error("\"%s\" lacks \"%s\"\n", vn_message(), part);
        _fail(file, line);
    }
}

void assert_near(double value, double expected, double tolerance) {
    if (!(fabs(value - expected) <= tolerance)) {
        fail_msg("%.17g is not within %g of %.17g", value, tolerance, expected);
    }
}

bool advance(vn_growth *growth) {
    bool growing = false;
    assert_ok(vn_growth_advance(growth, &growing));
    return growing;
}

vn_network *network_of(int dim) {
    vn_network_def def = vn_network_def_default();
    vn_network *network = NULL;
    def.dim = dim;
    assert_ok(vn_network_create(&network, &def));
    return network;
}

int32_t put_root(vn_network *network, double x, double y, double z) {
    int32_t node = -1;
    double p[3] = {x, y, z};
    assert_ok(vn_network_root(network, p, &node));
    return node;
}

int32_t put_child(vn_network *network, int32_t parent, double x, double y, double z) {
    int32_t node = -1;
    double p[3] = {x, y, z};
    assert_ok(vn_network_add(network, parent, p, &node));
    return node;
}

vn_network *random_tree(int dim, int32_t nodes, int32_t roots, uint64_t seed) {
    vn_network *network = network_of(dim);
    vn_rng rng = vn_rng_make(seed);
    for (int32_t i = 0; i < nodes; i++) {
        double x = uniform(&rng, -5, 5), y = uniform(&rng, -5, 5), z = dim == 3 ? uniform(&rng, -5, 5) : 0;
        if (i < roots) {
            put_root(network, x, y, z);
        } else {
            put_child(network, (int32_t)whole(&rng, i > 12 ? i - 12 : 0, i - 1), x, y, z);
        }
    }
    return network;
}

static uint64_t hash_number(uint64_t hash, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return vn_hash(hash, bits, 0, 0);
}

uint64_t network_hash(const vn_network *network) {
    uint64_t hash = (uint64_t)vn_network_count(network);
    vn_points points = vn_network_points(network);
    for (int32_t i = 0; i < vn_network_count(network); i++) {
        double p[3];
        vn_points_get(&points, i, p);
        hash = hash_number(hash_number(hash_number(hash, p[0]), p[1]), p[2]);
        hash = vn_hash(hash, (uint64_t)vn_network_parent(network)[i], 1, 0);
    }
    return hash;
}

vn_attractors *attractors_of(int dim, int64_t seed) {
    vn_attractors_def def = {.dim = dim, .seed = seed};
    vn_attractors *attractors = NULL;
    assert_ok(vn_attractors_create(&attractors, &def));
    return attractors;
}

void put_attractor(vn_attractors *attractors, double x, double y, double z) {
    double p[3] = {x, y, z};
    assert_ok(vn_attractors_add(attractors, p));
}

vn_domain *disk_of(double x, double y, double radius) {
    vn_disk_def def = {.center = {x, y, 0}, .radius = radius};
    vn_domain *domain = NULL;
    assert_ok(vn_domain_disk(&domain, &def));
    return domain;
}

vn_domain *ball_of(double x, double y, double z, double radius) {
    vn_disk_def def = {.center = {x, y, z}, .radius = radius};
    vn_domain *domain = NULL;
    assert_ok(vn_domain_sphere(&domain, &def));
    return domain;
}

vn_domain *box_of(double x0, double y0, double x1, double y1) {
    vn_box_def def = {.min = {x0, y0, 0}, .max = {x1, y1, 0}, .dim = 2};
    vn_domain *domain = NULL;
    assert_ok(vn_domain_box(&domain, &def));
    return domain;
}

vn_domain *solid_box(double x0, double y0, double z0, double x1, double y1, double z1) {
    vn_box_def def = {.min = {x0, y0, z0}, .max = {x1, y1, z1}, .dim = 3};
    vn_domain *domain = NULL;
    assert_ok(vn_domain_box(&domain, &def));
    return domain;
}

vn_domain *polygon_of(const double *xy, int32_t points) {
    vn_domain *domain = NULL;
    assert_ok(vn_domain_polygon(&domain, xy, &points, 1));
    return domain;
}

vn_domain *u_shape(void) {
    static const double xy[] = {0, 0, 10, 0, 10, 10, 6, 10, 6, 3, 4, 3, 4, 10, 0, 10};
    return polygon_of(xy, 8);
}

vn_domain *comb_shape(void) {
    double xy[64];
    int n = 0;
    for (int tooth = 0; tooth < 5; tooth++) {
        double x = 2 * tooth;
        double outline[8] = {x, 1, x, 8, x + 1, 8, x + 1, 1};
        memcpy(xy + n, outline, sizeof outline);
        n += 8;
    }
    double back[4] = {9, 0, 0, 0};
    memcpy(xy + n, back, sizeof back);
    return polygon_of(xy, n / 2 + 2);
}

vn_domain *maple_shape(void) {
    enum { POINTS = 70 };
    double xy[2 * POINTS];
    for (int i = 0; i < POINTS; i++) {
        double angle = 2 * 3.14159265358979 * i / POINTS;
        double radius = 10 * (0.3 + 0.7 * pow(fabs(cos(3.5 * angle)), 3)) * (i % 2 == 0 ? 1 : 0.8);
        xy[2 * i] = radius * cos(angle);
        xy[2 * i + 1] = radius * sin(angle);
    }
    return polygon_of(xy, POINTS);
}

vn_domain *leaf_shape(void) {
    static const double half[] = {0, 2, 3, 3.2, 2.8, 1.8, 0.7, 0};
    vn_profile_def def = {.length = 12, .half_width = half, .samples = 8};
    vn_domain *domain = NULL;
    assert_ok(vn_domain_profile(&domain, &def));
    return domain;
}

vn_domain *cordate_shape(void) {
    static const double xy[] = {0, 0, 2, -2, 5, -2.5, 7, 1, 5, 6, 0, 11, -5, 6, -7, 1, -5, -2.5, -2, -2};
    return polygon_of(xy, 10);
}

vn_growth *uniform_blade(vn_domain *domain, double x, double y, int32_t steps) {
    vn_uniform_def def = vn_uniform_def_default();
    vn_growth *growth = NULL;
    def.domain = domain;
    def.x = x;
    def.y = y;
    def.steps = steps;
    def.has_origin = true;
    assert_ok(vn_growth_uniform(&growth, &def));
    return growth;
}

vn_growth *rerg_blade(vn_domain *domain, factor_fn *fx, factor_fn *fy, int32_t steps) {
    vn_rerg_def def = vn_rerg_def_default();
    vn_growth *growth = NULL;
    double bottom, top, *x = malloc(SAMPLES * sizeof *x), *y = malloc(SAMPLES * sizeof *y);
    assert_true(x != NULL && y != NULL && def.samples == SAMPLES);
    def.domain = domain;
    def.has_origin = true;
    def.steps = steps;
    def.x = x;
    def.y = y;
    def.x_samples = def.y_samples = SAMPLES;
    assert_ok(vn_growth_heights(&def, &bottom, &top));
    for (int32_t i = 0; i < SAMPLES; i++) {
        double y0 = bottom + (top - bottom) * i / (SAMPLES - 1);
        x[i] = fx(y0);
        y[i] = fy(y0);
    }
    assert_ok(vn_growth_rerg(&growth, &def));
    free(x);
    free(y);
    return growth;
}

void map_point(vn_growth *growth, double x, double y, double t1, double t2, double q[3]) {
    double p[3] = {x, y, 0};
    assert_ok(vn_growth_map(growth, p, t1, t2, q));
}
