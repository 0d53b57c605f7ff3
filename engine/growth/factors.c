// Runions et al. 2005, appendix, Equation 4: y(t) = ∫₀^{y₀} f^t dy. Where f runs from f₀ to f₁ = f₀(1 + u)
// over a cell of width h, the part of it below the fraction s of the cell is
//     h f₀^t ((1 + us)^{t+1} − 1) / ((t+1) u),
// which can be solved for s. So the table and its inverse are exact at and between its entries.

#include "growth/factors.h"

#include <math.h>

enum { LEAST_SAMPLES = 2 };

static vn_status check_factor(const char *what, double f, double height) {
    if (!(f >= 1e-100 && f <= 1e100)) {
        return vn_fail(
            VN_INVALID,
            "%s = %g at height %g above the origin: a growth factor must be above 0 and finite (1: "
            "no growth)",
            what, f, height);
    }
    return VN_OK;
}

vn_status vn_factors_set(vn_factors *factors, const char *what, const double *samples, int32_t count,
                         double low, double high) {
    count = samples != NULL ? count : LEAST_SAMPLES;
    if (count < LEAST_SAMPLES) {
        return vn_fail(VN_INVALID, "%s has %d samples; growth factors need 2 or more", what, count);
    }
    VN_TRY(vn_array_reserve(&factors->f, count));
    factors->low = low;
    factors->cell = (high - low) / (count - 1);
    for (int32_t i = 0; i < count; i++) {
        double f = samples != NULL ? samples[i] : 1;
        VN_TRY(check_factor(what, f, low + i * factors->cell));
        factors->f.data[i] = f;
    }
    factors->f.count = count;
    return VN_OK;
}

void vn_factors_free(vn_factors *factors) {
    vn_array_free(&factors->f);
}

// The cell of a height, and how far up it the height is: below 0 under the first cell, above 1 over the last.
static int32_t cell_of(const vn_factors *factors, double y0, double *s) {
    double place = (y0 - factors->low) / factors->cell;
    int32_t cell = (int32_t)fmin(fmax(floor(place), 0), factors->f.count - 2);
    *s = place - cell;
    return cell;
}

double vn_factors_at(const vn_factors *factors, double y0) {
    double s;
    int32_t cell = cell_of(factors, y0, &s);
    const double *f = &factors->f.data[cell];
    return s <= 0 ? f[0] : (s >= 1 ? f[1] : f[0] + s * (f[1] - f[0]));
}

// ∫ f^t over the fraction @p s of a cell; beyond its ends f stays.
static double part_below(const vn_factors *factors, int32_t cell, double t, double s) {
    const double *f = &factors->f.data[cell];
    double width = factors->cell * pow(f[0], t);
    double u = f[1] / f[0] - 1, inside = fmin(s, 1);
    if (s < 0 || u == 0) {
        return width * s;
    }
    double part = width * expm1((t + 1) * log1p(u * inside)) / ((t + 1) * u);
    return s > 1 ? part + factors->cell * pow(f[1], t) * (s - 1) : part;
}

static double fraction_of(const vn_factors *factors, int32_t cell, double t, double part) {
    const double *f = &factors->f.data[cell];
    double width = factors->cell * pow(f[0], t);
    double u = f[1] / f[0] - 1;
    if (part < 0 || u == 0) {
        return part / width;
    }
    return expm1(log1p(part * (t + 1) * u / width) / (t + 1)) / u;
}

static vn_status check_rising(const vn_heights *heights) {
    const vn_factors *factors = heights->factors;
    for (int32_t i = 1; i < heights->y.count; i++) {
        const double *y = &heights->y.data[i];
        if (!(y[0] > y[-1] && y[0] - y[-1] <= 1e150)) {
            return vn_fail(VN_INFEASIBLE,
                           "rerg: at time %g the tissue at height %g has shrunk to nothing or left the range "
                           "of numbers: take fewer steps or factors nearer 1",
                           heights->time, factors->low + i * factors->cell);
        }
    }
    return VN_OK;
}

// Thousands of roundings in one direction would add up: each is kept and given back (Kahan).
static void add_up(const vn_factors *factors, double time, double *y) {
    double lost = 0;
    y[0] = 0;
    for (int32_t i = 1; i < factors->f.count; i++) {
        double part = part_below(factors, i - 1, time, 1) - lost;
        y[i] = y[i - 1] + part;
        lost = (y[i] - y[i - 1]) - part;
    }
}

vn_status vn_heights_make(vn_heights *heights, const vn_factors *factors, double time) {
    int32_t count = factors->f.count;
    VN_TRY(vn_array_reserve(&heights->y, count));
    heights->factors = factors;
    heights->time = time;
    heights->y.count = count;
    add_up(factors, time, heights->y.data);
    double origin = vn_heights_at(heights, 0);
    for (int32_t i = 0; i < count; i++) {
        heights->y.data[i] -= origin;
    }
    vn_status status = check_rising(heights);
    heights->time = status == VN_OK ? time : NAN; // never taken for a table of that time
    return status;
}

void vn_heights_free(vn_heights *heights) {
    vn_array_free(&heights->y);
}

double vn_heights_at(const vn_heights *heights, double y0) {
    double s;
    int32_t cell = cell_of(heights->factors, y0, &s);
    return heights->y.data[cell] + part_below(heights->factors, cell, heights->time, s);
}

double vn_heights_invert(const vn_heights *heights, double y) {
    const vn_factors *factors = heights->factors;
    const double *table = heights->y.data;
    int32_t low = 0, high = heights->y.count - 1;
    while (high - low > 1) {
        int32_t middle = low + (high - low) / 2;
        if (table[middle] <= y) {
            low = middle;
        } else {
            high = middle;
        }
    }
    double top = table[heights->y.count - 1];
    if (y > top) {
        double stretched = pow(factors->f.data[heights->y.count - 1], heights->time);
        return factors->low + (heights->y.count - 1) * factors->cell + (y - top) / stretched;
    }
    return factors->low + (low + fraction_of(factors, low, heights->time, y - table[low])) * factors->cell;
}
