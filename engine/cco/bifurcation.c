#include "cco/bifurcation.h"

#include "space/points.h"

static double norm(const double a[3]) {
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

bool vn_triangle_make(vn_triangle *t, const double proximal[3], const double distal[3],
                      const double terminal[3]) {
    double along[3], to[3];
    for (int k = 0; k < 3; k++) {
        t->origin[k] = proximal[k];
        along[k] = distal[k] - proximal[k];
        to[k] = terminal[k] - proximal[k];
    }
    t->distal = norm(along);
    double forward = 0, size = norm(to) + t->distal;
    for (int k = 0; k < 3; k++) {
        t->axes[0][k] = along[k] / t->distal;
        forward += t->axes[0][k] * to[k];
    }
    for (int k = 0; k < 3; k++) {
        to[k] -= forward * t->axes[0][k];
    }
    t->across[0] = forward;
    t->across[1] = norm(to);
    for (int k = 0; k < 3; k++) {
        t->axes[1][k] = to[k] / t->across[1];
    }
    return t->distal > 0 && t->across[1] > 1e-9 * size;
}

void vn_triangle_point(const vn_triangle *t, const double x[2], double p[3]) {
    for (int k = 0; k < 3; k++) {
        p[k] = t->origin[k] + x[0] * t->axes[0][k] + x[1] * t->axes[1][k];
    }
}

void vn_triangle_lengths(const vn_triangle *t, const double x[2], double lengths[3]) {
    double d1 = x[0] - t->distal, d2x = x[0] - t->across[0], d2y = x[1] - t->across[1];
    lengths[0] = sqrt(x[0] * x[0] + x[1] * x[1]);
    lengths[1] = sqrt(d1 * d1 + x[1] * x[1]);
    lengths[2] = sqrt(d2x * d2x + d2y * d2y);
}

/// Everything at one point x: the two branches below it, and their fork.
typedef struct place {
    double length[3];
    vn_branch below[2]; ///< the distal part and the new segment
    double share[2];    ///< of h^gamma
    double beta2[2];
    double resistance, volume; ///< of the fork
} place;

static void look(const vn_triangle *t, const double x[2], place *at) {
    vn_triangle_lengths(t, x, at->length);
    at->below[0] = (vn_branch){t->flow1, at->length[1] + t->rest_resistance, at->length[1] + t->rest_volume};
    at->below[1] = (vn_branch){t->flow2, at->length[2], at->length[2]};
    double product[2], weight[2];
    for (int i = 0; i < 2; i++) {
        product[i] = at->below[i].flow * at->below[i].resistance;
        weight[i] = vn_branch_weight(t->exponent, product[i]);
    }
    double sum = weight[0] + weight[1];
    double square = vn_branches_square(t->exponent, sum);
    at->volume = 0;
    for (int i = 0; i < 2; i++) {
        at->share[i] = weight[i] / sum;
        at->beta2[i] = sqrt(product[i]) / square;
        at->volume += at->beta2[i] * at->below[i].volume;
    }
    at->resistance = square * square / (t->flow1 + t->flow2);
}

void vn_triangle_branches(const vn_triangle *t, const double x[2], vn_branch branches[3]) {
    place at;
    look(t, x, &at);
    branches[0] = (vn_branch){t->flow1 + t->flow2, at.length[0] + at.resistance, at.length[0] + at.volume};
    branches[1] = at.below[0];
    branches[2] = at.below[1];
}

/// F = a R + b v of the upper branch, by the three lengths.
typedef struct slope {
    double value, by_length[3];
    double by_lengths[2][2]; ///< second derivatives by the lengths of the two lower segments
} slope;

static double delta(int i, int j) {
    return i == j ? 1 : 0;
}

// Both R and v of a lower branch rise with its length. With shares s, u = beta^2 v and U = u0 + u1:
// dK / dR_i = K s_i / R_i and dU / dR_i = (u_i - U s_i) / (2 R_i), dU / dv_i = beta_i^2.
static void differentiate(const vn_triangle *t, const place *at, double a, double b, slope *s) {
    double u[2], k_by[2], u_by[2];
    double K = at->resistance, U = at->volume;
    for (int i = 0; i < 2; i++) {
        u[i] = at->beta2[i] * at->below[i].volume;
        k_by[i] = K * at->share[i] / at->below[i].resistance;
        u_by[i] = (u[i] - U * at->share[i]) / (2 * at->below[i].resistance) + at->beta2[i];
        s->by_length[i + 1] = a * k_by[i] + b * u_by[i];
    }
    s->value = a * (at->length[0] + K) + b * (at->length[0] + U);
    s->by_length[0] = a + b;
    for (int i = 0; i < 2; i++) {
        double r = at->below[i].resistance, v = at->below[i].volume;
        for (int j = 0; j < 2; j++) {
            double rj = at->below[j].resistance, vj = at->below[j].volume, same = delta(i, j);
            double share_by = t->exponent / 4 * at->share[i] * (same - at->share[j]) / rj;
            double part_by = u[i] * (same - at->share[j]) / (2 * rj) + same * u[i] / vj;
            double k = k_by[j] * at->share[i] / r + K * share_by / r - same * K * at->share[i] / (r * r);
            double p = (part_by - u_by[j] * at->share[i] - U * share_by) / (2 * r) -
                       same * (u[i] - U * at->share[i]) / (2 * r * r) + part_by / v - same * u[i] / (v * v);
            s->by_lengths[i][j] = a * k + b * p;
        }
    }
}

/// Gradient and second derivatives in the plane, with and without those of the weights themselves.
typedef struct curvature {
    double gradient[2];
    double full[3], plain[3]; ///< xx, xy, yy
} curvature;

static void bend(const vn_triangle *t, const double x[2], const place *at, const slope *s, curvature *c) {
    double ends[3][2] = {{0, 0}, {t->distal, 0}, {t->across[0], t->across[1]}};
    double unit[3][2];
    *c = (curvature){0};
    for (int i = 0; i < 3; i++) {
        double w = s->by_length[i], stiff = w / at->length[i];
        for (int k = 0; k < 2; k++) {
            unit[i][k] = (x[k] - ends[i][k]) / at->length[i];
            c->gradient[k] += w * unit[i][k];
        }
        c->plain[0] += stiff * (1 - unit[i][0] * unit[i][0]);
        c->plain[1] -= stiff * unit[i][0] * unit[i][1];
        c->plain[2] += stiff * (1 - unit[i][1] * unit[i][1]);
    }
    memcpy(c->full, c->plain, sizeof c->full);
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) {
            double second = s->by_lengths[i][j];
            c->full[0] += second * unit[i + 1][0] * unit[j + 1][0];
            c->full[1] += second * unit[i + 1][0] * unit[j + 1][1];
            c->full[2] += second * unit[i + 1][1] * unit[j + 1][1];
        }
    }
}

static bool newton(const double h[3], const double gradient[2], double step[2]) {
    double determinant = h[0] * h[2] - h[1] * h[1];
    if (!(determinant > 1e-12 * (h[0] * h[0] + h[2] * h[2])) || !(h[0] + h[2] > 0)) {
        return false;
    }
    step[0] = -(h[2] * gradient[0] - h[1] * gradient[1]) / determinant;
    step[1] = -(h[0] * gradient[1] - h[1] * gradient[0]) / determinant;
    return true;
}

// Half the way until it goes down. A step that is too small to tell is taken.
static bool descend(const vn_triangle *t, const slope *s, double a, double b, const double step[2],
                    double x[2]) {
    double part = 1;
    for (int halvings = 0; halvings < 20; halvings++, part /= 2) {
        double y[2] = {x[0] + part * step[0], x[1] + part * step[1]};
        place at;
        look(t, y, &at);
        double value = a * (at.length[0] + at.resistance) + b * (at.length[0] + at.volume);
        if (value <= s->value * (1 + 4e-16)) {
            memcpy(x, y, sizeof y);
            return true;
        }
    }
    return false;
}

enum { MOST_STEPS = 40 };

// Whether moving away from the end x0 (or x1, with all that hangs there) makes the volume rise in every
// direction: the pull of the other two is no more than the end's own weight (READINGS R13).
static bool absorbs(const vn_triangle *t, int end, double a, double b) {
    double x[2] = {end == 0 ? 0 : t->distal, 0}, pull[2] = {0, 0};
    double ends[3][2] = {{0, 0}, {t->distal, 0}, {t->across[0], t->across[1]}};
    place at;
    slope s;
    look(t, x, &at);
    differentiate(t, &at, a, b, &s);
    for (int i = 0; i < 3; i++) {
        if (i != end) {
            pull[0] += s.by_length[i] * (ends[i][0] - x[0]) / at.length[i];
            pull[1] += s.by_length[i] * (ends[i][1] - x[1]) / at.length[i];
        }
    }
    return s.by_length[end] >= sqrt(pull[0] * pull[0] + pull[1] * pull[1]);
}

bool vn_triangle_minimum(const vn_triangle *t, double by_resistance, double by_volume, double tolerance,
                         double x[2]) {
    double size = t->distal + t->across[1];
    for (int i = 0; i < MOST_STEPS; i++) {
        place at;
        slope s;
        curvature c;
        double step[2];
        look(t, x, &at);
        if (!(fmin(fmin(at.length[0], at.length[1]), at.length[2]) > 1e-7 * size)) {
            return false;
        }
        differentiate(t, &at, by_resistance, by_volume, &s);
        bend(t, x, &at, &s, &c);
        if (!newton(c.full, c.gradient, step) && !newton(c.plain, c.gradient, step)) {
            return false;
        }
        double moved = fmax(fabs(step[0]), fabs(step[1]));
        if (moved <= 1e-12 * size || !descend(t, &s, by_resistance, by_volume, step, x)) {
            return moved <= 1e-4 * size;
        }
        if (moved * moved <= tolerance * size * size) { // Newton's next step is about its square
            return true;
        }
    }
    return false;
}

// Estimates are linear from where the flow is this many times that of the terminal.
static const double LINEAR_FROM = 24;

// `known`: the effect at x is.
static bool least_from(const vn_tree *tree, vn_adjoints *adjoints, int32_t node, const vn_triangle *t,
                       double tolerance, int rounds, bool known, double x[2], vn_effect *effect) {
    double size = t->distal + t->across[1];
    for (int i = 0;; i++) {
        vn_branch branches[3];
        if (i > 0 || !known) {
            vn_triangle_branches(t, x, branches);
            *effect = adjoints != NULL ? vn_tree_estimate(tree, adjoints, node, &branches[0], LINEAR_FROM)
                                       : vn_tree_effect(tree, node, &branches[0]);
        }
        if (i == rounds) {
            return true;
        }
        double before[2] = {x[0], x[1]}, a = effect->by_resistance, b = effect->by_volume;
        if (i == 0 && (absorbs(t, 0, a, b) || (t->rest_resistance > 0 && absorbs(t, 1, a, b)))) {
            return false;
        }
        if (!vn_triangle_minimum(t, a, b, tolerance, x)) {
            return false;
        }
        if (fabs(x[0] - before[0]) + fabs(x[1] - before[1]) <= tolerance * size) {
            return true;
        }
    }
}

// A new vessel of no length has no resistance, so both ends of thin vessels are minima as well: a way that
// runs into one is no proof that there is none inside, and another start, near Equation 8's, may find it.
static bool least_elsewhere(const vn_tree *tree, vn_adjoints *adjoints, int32_t node, const vn_triangle *t,
                            double tolerance, int rounds, double x[2], vn_effect *effect) {
    x[0] = t->distal / 2;
    x[1] = t->across[1] / 4;
    return least_from(tree, adjoints, node, t, tolerance, rounds, false, x, effect);
}

bool vn_bifurcation_least(const vn_tree *tree, vn_adjoints *adjoints, int32_t node, const vn_triangle *t,
                          double tolerance, int rounds, double x[2], vn_effect *effect) {
    return least_from(tree, adjoints, node, t, tolerance, rounds, false, x, effect) ||
           least_elsewhere(tree, adjoints, node, t, tolerance, rounds, x, effect);
}

bool vn_bifurcation_refine(const vn_tree *tree, int32_t node, const vn_triangle *t, double tolerance,
                           int rounds, double x[2], vn_effect *effect) {
    return least_from(tree, NULL, node, t, tolerance, rounds, true, x, effect) ||
           least_elsewhere(tree, NULL, node, t, tolerance, rounds, x, effect);
}
