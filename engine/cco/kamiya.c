// Equations 8 to 13 of Kerautret et al. 2023.
#include "cco/bifurcation.h"

// f0 sum sqrt(f_i) (l_i / (D_i - y))^(3/2) - (f0 l0 / y)^(3/2), and its derivative: from (11) and (12) with
// r_i^4 = f_i l_i / (D_i - y).
static double monotone(const double flow[3], const double length[3], const double drop[2], double y,
                       double *derivative) {
    double head = flow[0] * length[0] / y, value = -head * sqrt(head);
    *derivative = -1.5 * value / y;
    for (int i = 0; i < 2; i++) {
        double part = length[i + 1] / (drop[i] - y);
        double term = flow[0] * sqrt(flow[i + 1]) * part * sqrt(part);
        value += term;
        *derivative += 1.5 * term / (drop[i] - y);
    }
    return value;
}

// Newton's method within a bracket that halves where a step would leave it.
static double find_root(const double flow[3], const double length[3], const double drop[2]) {
    double low = 0, high = fmin(drop[0], drop[1]), y = high / 2;
    for (int i = 0; i < 200; i++) {
        double derivative, value = monotone(flow, length, drop, y, &derivative);
        *(value > 0 ? &high : &low) = y;
        double next = y - value / derivative;
        next = next > low && next < high ? next : low + (high - low) / 2;
        if (fabs(next - y) <= 1e-15 * y) {
            return next;
        }
        y = next;
    }
    return y;
}

bool vn_kamiya_radii(const double flow[3], const double length[3], const double drop[2], double radius[3]) {
    if (!(drop[0] > 0 && drop[1] > 0)) {
        return false;
    }
    double y = find_root(flow, length, drop);
    radius[0] = sqrt(sqrt(flow[0] * length[0] / y));
    for (int i = 0; i < 2; i++) {
        radius[i + 1] = sqrt(sqrt(flow[i + 1] * length[i + 1] / (drop[i] - y)));
    }
    return true;
}

// The radii of the three segments in the whole tree, Equations 1 to 7.
static void tree_radii(const vn_triangle *t, const double x[2], const vn_effect *effect, double radius[3]) {
    vn_branch b[3];
    vn_triangle_branches(t, x, b);
    double lengths[3];
    vn_triangle_lengths(t, x, lengths);
    double fork = b[0].resistance - lengths[0];
    radius[0] = effect->radius;
    for (int i = 1; i < 3; i++) { // beta^4 = Q R / H^4, H^4 = Q0 times the fork's resistance
        radius[i] = effect->radius * sqrt(sqrt(b[i].flow * b[i].resistance / (b[0].flow * fork)));
    }
}

// One round: (9), (12), (13).
static bool move(const vn_triangle *t, vn_kamiya_fn *solve, const double radius[3], double x[2]) {
    double flow[3] = {t->flow1 + t->flow2, t->flow1, t->flow2}, lengths[3], drop[2], r[3];
    double ends[3][2] = {{0, 0}, {t->distal, 0}, {t->across[0], t->across[1]}};
    double sum = 0, mean[2] = {0, 0};
    vn_triangle_lengths(t, x, lengths);
    for (int i = 0; i < 2; i++) {
        drop[i] =
            flow[0] * lengths[0] / pow(radius[0], 4) + flow[i + 1] * lengths[i + 1] / pow(radius[i + 1], 4);
    }
    if (!solve(flow, lengths, drop, r)) {
        return false;
    }
    for (int i = 0; i < 3; i++) {
        double weight = r[i] * r[i] / lengths[i];
        sum += weight;
        mean[0] += weight * ends[i][0];
        mean[1] += weight * ends[i][1];
    }
    x[0] = mean[0] / sum;
    x[1] = mean[1] / sum;
    return isfinite(x[0]) && isfinite(x[1]);
}

bool vn_bifurcation_kamiya(const vn_tree *tree, int32_t node, const vn_triangle *t, vn_kamiya_fn *solve,
                           double tolerance, int rounds, double x[2], vn_effect *effect) {
    double whole = vn_tree_volume(tree), last = INFINITY;
    x[0] = t->distal / 2; // (8)
    x[1] = 0;
    for (int i = 0; i < rounds; i++) {
        vn_branch branches[3];
        vn_triangle_branches(t, x, branches);
        *effect = vn_tree_effect(tree, node, &branches[0]);
        if (fabs(effect->volume - last) <= tolerance * (whole + effect->volume)) {
            return true;
        }
        last = effect->volume;
        double radius[3];
        tree_radii(t, x, effect, radius);
        if (!move(t, solve, radius, x)) {
            return false;
        }
    }
    return true;
}
