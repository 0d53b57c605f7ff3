// A smooth curve through points that overshoots none of them (Fritsch and Butland 1984): between two points
// it runs from one to the other without turning, so that growth factors above 0 stay above 0.

#include "growth/factors.h"

#include <math.h>

static vn_status check_points(const char *what, const double *yf, int32_t points) {
    if (points < 2) {
        return vn_fail(VN_INVALID, "%s: a spline needs 2 points {y0, f} or more, not %d", what, points);
    }
    for (int32_t i = 0; i < points; i++) {
        if (!isfinite(yf[2 * i]) || !isfinite(yf[2 * i + 1])) {
            return vn_fail(VN_INVALID, "%s: point %d of the spline is (%g, %g), which is not finite", what,
                           i + 1, yf[2 * i], yf[2 * i + 1]);
        }
        if (i > 0 && !(yf[2 * i] > yf[2 * i - 2])) {
            return vn_fail(VN_INVALID,
                           "%s: point %d of the spline is at height %g, not above the one before at %g: give "
                           "them upwards",
                           what, i + 1, yf[2 * i], yf[2 * i - 2]);
        }
    }
    return VN_OK;
}

static double slope_between(const double *yf, int32_t i) {
    return (yf[2 * i + 3] - yf[2 * i + 1]) / (yf[2 * i + 2] - yf[2 * i]);
}

// At an inner point the weighted harmonic mean of the slopes beside it, 0 at a peak; at an end that of the
// only slope.
static double slope_at(const double *yf, int32_t points, int32_t i) {
    if (i == 0 || i == points - 1) {
        return slope_between(yf, i == 0 ? 0 : points - 2);
    }
    double below = slope_between(yf, i - 1), above = slope_between(yf, i);
    double h = yf[2 * i] - yf[2 * i - 2], k = yf[2 * i + 2] - yf[2 * i];
    if (below * above <= 0) {
        return 0;
    }
    return 3 * (h + k) / ((2 * k + h) / below + (k + 2 * h) / above);
}

static double hermite(const double *yf, int32_t points, int32_t i, double y) {
    double h = yf[2 * i + 2] - yf[2 * i], s = (y - yf[2 * i]) / h;
    double a = yf[2 * i + 1], b = yf[2 * i + 3];
    double da = h * slope_at(yf, points, i), db = h * slope_at(yf, points, i + 1);
    return a + s * (da + s * (3 * (b - a) - 2 * da - db + s * (da + db - 2 * (b - a))));
}

static double spline_at(const double *yf, int32_t points, double y) {
    if (y <= yf[0] || y >= yf[2 * points - 2]) {
        return y <= yf[0] ? yf[1] : yf[2 * points - 1];
    }
    int32_t low = 0, high = points - 1;
    while (high - low > 1) {
        int32_t middle = low + (high - low) / 2;
        if (yf[2 * middle] <= y) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return hermite(yf, points, low, y);
}

vn_status vn_factors_spline(double *out, int32_t samples, const char *what, const double *yf, int32_t points,
                            double low, double high) {
    VN_TRY(check_points(what, yf, points));
    for (int32_t i = 0; i < samples; i++) {
        out[i] = spline_at(yf, points, low + (high - low) * i / (samples - 1));
    }
    return VN_OK;
}
