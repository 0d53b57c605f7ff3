// Hormann and Floater 2006, "Mean value coordinates for arbitrary planar polygons": the weight of a corner is
// (tan α_{i−1}/2 + tan α_i/2) / r_i, with α_i the signed angle at p between corners i and i + 1.

#include "growth/mean_value.h"

#include <math.h>

typedef struct spoke {
    double x, y, r; ///< from p to a corner, and its length
} spoke;

static spoke spoke_to(const vn_corners *corners, int32_t i, const double p[2]) {
    double x = corners->x[i] - p[0], y = corners->y[i] - p[1];
    return (spoke){x, y, sqrt(x * x + y * y)};
}

// tan α/2 from whichever form does not cancel; false when p is on the edge.
static bool half_tangent(const spoke *a, const spoke *b, double *tangent) {
    double along = a->x * b->x + a->y * b->y, across = a->x * b->y - a->y * b->x;
    double lengths = a->r * b->r;
    if (fabs(across) <= 1e-15 * lengths && along < 0) {
        return false;
    }
    *tangent = along > 0 ? across / (lengths + along) : (lengths - along) / across;
    return true;
}

static void put_on_edge(const vn_corners *before, const vn_corners *after, int32_t i, int32_t j, double s,
                        const double p[2], double q[2]) {
    double off_x = p[0] - (before->x[i] + s * (before->x[j] - before->x[i]));
    double off_y = p[1] - (before->y[i] + s * (before->y[j] - before->y[i]));
    q[0] = off_x + after->x[i] + s * (after->x[j] - after->x[i]);
    q[1] = off_y + after->y[i] + s * (after->y[j] - after->y[i]);
}

// Displacements are weighed, not places: what does not move stays to the last bit.
void vn_mean_value_move(const vn_corners *before, const vn_corners *after, const double p[2], double q[2]) {
    double weights = 0, dx = 0, dy = 0, last_tangent;
    int32_t count = before->count;
    spoke last = spoke_to(before, count - 1, p), here = spoke_to(before, 0, p);
    if (here.r == 0 || !half_tangent(&last, &here, &last_tangent)) {
        put_on_edge(before, after, count - 1, 0, last.r / (last.r + here.r), p, q);
        return;
    }
    for (int32_t i = 0; i < count; i++) {
        int32_t j = i + 1 < count ? i + 1 : 0;
        spoke next = spoke_to(before, j, p);
        double tangent;
        if (next.r == 0 || !half_tangent(&here, &next, &tangent)) {
            put_on_edge(before, after, i, j, here.r / (here.r + next.r), p, q);
            return;
        }
        double weight = (last_tangent + tangent) / here.r;
        weights += weight;
        dx += weight * (after->x[i] - before->x[i]);
        dy += weight * (after->y[i] - before->y[i]);
        here = next;
        last_tangent = tangent;
    }
    q[0] = p[0] + dx / weights;
    q[1] = p[1] + dy / weights;
}
