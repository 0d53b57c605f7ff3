/// What several tests share: cmocka with its headers, objects made in one line, and bytes that must come
/// back.
#ifndef VN_TESTS_SUPPORT_H
#define VN_TESTS_SUPPORT_H

#include "colonize/attractors.h"
#include "venule/venule.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define assert_ok(call) assert_int_equal((call), VN_OK)
#define assert_message(part) check_message((part), __FILE__, __LINE__)

/// A test after which as many bytes are held as before it.
#define counted_test(name) cmocka_unit_test_setup_teardown(name, count_bytes, check_bytes)
int count_bytes(void **state);
int check_bytes(void **state);

void check_message(const char *part, const char *file, int line);
void assert_near(double value, double expected, double tolerance);

/// One step; whether it grew.
bool advance(vn_growth *growth);

vn_network *network_of(int dim);
int32_t put_root(vn_network *network, double x, double y, double z);
int32_t put_child(vn_network *network, int32_t parent, double x, double y, double z);
/// Every node hangs from one of the last few before it.
vn_network *random_tree(int dim, int32_t nodes, int32_t roots, uint64_t seed);
/// Of the bits of all coordinates and parents.
uint64_t network_hash(const vn_network *network);

vn_attractors *attractors_of(int dim, int64_t seed);
void put_attractor(vn_attractors *attractors, double x, double y, double z);

vn_domain *disk_of(double x, double y, double radius);
vn_domain *ball_of(double x, double y, double z, double radius);
vn_domain *box_of(double x0, double y0, double x1, double y1);
vn_domain *solid_box(double x0, double y0, double z0, double x1, double y1, double z1);
/// One ring.
vn_domain *polygon_of(const double *xy, int32_t points);
/// A 10 × 10 square with a slot from above.
vn_domain *u_shape(void);
/// Five teeth on a back.
vn_domain *comb_shape(void);
/// A leaf of deep lobes about (0, 0), of radius 10 at most.
vn_domain *maple_shape(void);

/// A pointed blade 12 long, of seven parts.
vn_domain *leaf_shape(void);
/// A blade whose petiole is at (0, 0), and whose lobes hang below.
vn_domain *cordate_shape(void);

vn_growth *uniform_blade(vn_domain *domain, double x, double y, int32_t steps);
/// A function of the height at first, by which a blade grows.
typedef double factor_fn(double y0);
enum { SAMPLES = 16384 };
/// A blade of the default number of samples about (0, 0).
vn_growth *rerg_blade(vn_domain *domain, factor_fn *fx, factor_fn *fy, int32_t steps);
void map_point(vn_growth *growth, double x, double y, double t1, double t2, double q[3]);

static inline double uniform(vn_rng *rng, double low, double high) {
    return vn_rng_uniform(rng, low, high);
}

static inline int64_t whole(vn_rng *rng, int64_t low, int64_t high) {
    return vn_rng_integer(rng, low, high);
}

#endif
