#include "space/exact.h"

#include <math.h>

// Grow a sum without rounding (Shewchuk 1997): parts do not overlap and increase; the last decides the sign.
// Parts that are 0 are left out: there are few parts where coordinates have few digits.
static int grow_sum(double *parts, int count, double value) {
    int kept = 0;
    for (int i = 0; i < count; i++) {
        double sum = value + parts[i];
        double virtual = sum - value;
        double rest = (value - (sum - virtual)) + (parts[i] - virtual);
        if (rest != 0) {
            parts[kept++] = rest;
        }
        value = sum;
    }
    if (value != 0) {
        parts[kept++] = value;
    }
    return kept;
}

// From the smallest up: the largest part decides.
static double sum_of(const double *parts, int count) {
    double sum = 0;
    for (int i = 0; i < count; i++) {
        sum += parts[i];
    }
    return sum;
}

static double exact_turn(double ax, double ay, double bx, double by, double cx, double cy) {
    const double products[6][2] = {{ax, by}, {-ax, cy}, {-cx, by}, {-ay, bx}, {ay, cx}, {cy, bx}};
    double parts[12];
    int count = 0;
    for (int i = 0; i < 6; i++) {
        double high = products[i][0] * products[i][1];
        double low = fma(products[i][0], products[i][1], -high);
        count = grow_sum(parts, count, low);
        count = grow_sum(parts, count, high);
    }
    return sum_of(parts, count);
}

double vn_turn(double ax, double ay, double bx, double by, double cx, double cy) {
    double left = (ax - cx) * (by - cy);
    double right = (ay - cy) * (bx - cx);
    double det = left - right;
    double bound = 3.3306690738754716e-16 * (fabs(left) + fabs(right));
    return fabs(det) > bound ? det : exact_turn(ax, ay, bx, by, cx, cy);
}

// x y z, to the last bit, in four parts.
static int grow_product(double *parts, int count, double x, double y, double z) {
    double high = x * y;
    double halves[2] = {fma(x, y, -high), high};
    for (int i = 0; i < 2; i++) {
        double product = halves[i] * z;
        count = grow_sum(parts, count, fma(halves[i], z, -product));
        count = grow_sum(parts, count, product);
    }
    return count;
}

// sign * det(p, q, r).
static int grow_determinant(double *parts, int count, double sign, const double p[3], const double q[3],
                            const double r[3]) {
    for (int k = 0; k < 3; k++) {
        int next = (k + 1) % 3, last = (k + 2) % 3;
        count = grow_product(parts, count, sign * p[k], q[next], r[last]);
        count = grow_product(parts, count, -sign * p[k], q[last], r[next]);
    }
    return count;
}

// The determinant is linear in each row, so no coordinate has to be subtracted from another first.
static double exact_turn_3(const double a[3], const double b[3], const double c[3], const double p[3]) {
    double parts[96];
    int count = grow_determinant(parts, 0, -1, a, b, c);
    count = grow_determinant(parts, count, 1, p, b, c);
    count = grow_determinant(parts, count, 1, a, p, c);
    count = grow_determinant(parts, count, 1, a, b, p);
    return sum_of(parts, count);
}

// The bound is Shewchuk's; the last addend is for products that have underflown.
double vn_turn_3(const double a[3], const double b[3], const double c[3], const double p[3]) {
    double u[3], v[3], w[3], det = 0, permanent = 0;
    for (int k = 0; k < 3; k++) {
        u[k] = a[k] - p[k];
        v[k] = b[k] - p[k];
        w[k] = c[k] - p[k];
    }
    for (int k = 0; k < 3; k++) {
        double left = v[(k + 1) % 3] * w[(k + 2) % 3], right = v[(k + 2) % 3] * w[(k + 1) % 3];
        det -= u[k] * (left - right);
        permanent += fabs(u[k]) * (fabs(left) + fabs(right));
    }
    return fabs(det) > 8e-16 * permanent + 1e-280 ? det : exact_turn_3(a, b, c, p);
}
