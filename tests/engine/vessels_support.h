/// What the tests of vessels share.
#ifndef VN_TESTS_VESSELS_SUPPORT_H
#define VN_TESTS_VESSELS_SUPPORT_H

#include "support.h"

static const double DEGREES = 180 / 3.14159265358979323846;

static inline void place(const vn_network *net, int32_t node, double p[3]) {
    p[0] = vn_network_x(net)[node];
    p[1] = vn_network_y(net)[node];
    p[2] = vn_network_z(net) != NULL ? vn_network_z(net)[node] : 0;
}

static inline double angle_between(const double a[3], const double b[3]) {
    double dot = 0, aa = 0, bb = 0;
    for (int k = 0; k < 3; k++) {
        dot += a[k] * b[k];
        aa += a[k] * a[k];
        bb += b[k] * b[k];
    }
    return acos(fmin(fmax(dot / sqrt(aa * bb), -1), 1)) * DEGREES;
}

// Equation 1 for the branch r, where the other one is l.
static inline double branch_angle(double l, double r, double kappa) {
    double p = pow(pow(l, kappa) + pow(r, kappa), 1 / kappa);
    return acos((pow(p, 4) - pow(l, 4) + pow(r, 4)) / (2 * p * p * r * r)) * DEGREES;
}

static inline vn_network *vessel_of(int dim, double kappa) {
    vn_network *net = network_of(dim);
    vn_murray_def law = {.exponent = kappa, .tip_radius = 1};
    assert_ok(vn_network_murray(net, &law));
    return net;
}

static inline void grow_once(vn_network *net, vn_attractors *a, double gamma, const vn_extend_def *grow) {
    vn_influence *f = NULL;
    vn_influence_def def = vn_influence_def_default();
    int32_t added, first;
    def.within = 10;
    def.perception = (vn_perception){gamma, true};
    assert_ok(vn_influence_find(&f, a, net, &def));
    assert_ok(vn_extend(net, f, grow, &added, &first));
    vn_influence_destroy(f);
}

#endif
