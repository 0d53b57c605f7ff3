#include "network/sides.h"

#include <math.h>

void vn_sides_free(vn_sides *sides) {
    vn_array_free(&sides->in);
    vn_array_free(&sides->out);
}

bool vn_sides_meet(const vn_sides *s) {
    return s->in.count > 0 && s->out.count > 0 && (int64_t)s->in.count + s->out.count > 2;
}

static bool parent_is_in(const vn_sides *s) {
    return s->in.count == 1 || s->out.count != 1;
}

static double thickest(const double *radii, int32_t count) {
    double most = 0;
    for (int32_t i = 0; i < count; i++) {
        most = fmax(most, radii[i]);
    }
    return most;
}

static double thickest_parent(const vn_sides *s) {
    return parent_is_in(s) ? thickest(s->in.data, s->in.count) : thickest(s->out.data, s->out.count);
}

static double sum_powers(const double *radii, int32_t count, double unit, double exponent) {
    double sum = 0;
    for (int32_t i = 0; i < count; i++) {
        sum += pow(radii[i] / unit, exponent);
    }
    return sum;
}

// Radii are taken by that of the thickest on the parent's side, so that no power leaves the range of doubles
// where the law holds.
double vn_sides_residual(const vn_sides *s, double exponent) {
    double unit = thickest_parent(s);
    double in = sum_powers(s->in.data, s->in.count, unit, exponent);
    double out = sum_powers(s->out.data, s->out.count, unit, exponent);
    return fabs(in - out) / (parent_is_in(s) ? in : out);
}

// Σ (r_child / r_parent)^x = 1 falls in x and is convex: Newton's steps from 0 come from below and never
// pass the root.
static double fit(const double *radii, int32_t count, double parent) {
    enum { STEPS = 100 };
    double x = 0;
    for (int step = 0; step < STEPS; step++) {
        double f = -1, slope = 0;
        for (int32_t k = 0; k < count; k++) {
            double ratio = log(radii[k] / parent), power = exp(x * ratio);
            f += power;
            slope += ratio * power;
        }
        double next = x - f / slope;
        if (!(next > x * (1 + 1e-14))) {
            break;
        }
        x = next;
    }
    return x;
}

bool vn_sides_fit(const vn_sides *s, double *exponent) {
    bool in = parent_is_in(s);
    const double *radii = in ? s->out.data : s->in.data;
    int32_t count = in ? s->out.count : s->in.count;
    double parent = thickest_parent(s);
    *exponent = 0;
    if (s->in.count != 1 && s->out.count != 1) {
        return false;
    }
    if (!(thickest(radii, count) < parent)) {
        return false;
    }
    *exponent = fit(radii, count, parent);
    return true;
}
