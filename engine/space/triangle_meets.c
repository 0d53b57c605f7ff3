#include "space/triangle_meets.h"

#include "space/exact.h"
#include "space/segment_grid.h"

static int sign_of(double value) {
    return (value > 0) - (value < 0);
}

// All on one side, where 0 is either.
static bool agree(double u, double v, double w) {
    return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

vn_line_meeting vn_line_meets(const vn_triangle *t, const double a[3], const double b[3]) {
    int from = sign_of(vn_turn_3(t->a, t->b, t->c, a)), to = sign_of(vn_turn_3(t->a, t->b, t->c, b));
    if (from * to > 0) {
        return VN_LINE_APART;
    }
    if (from == 0 && to == 0) {
        return VN_LINE_COPLANAR;
    }
    bool through =
        agree(vn_turn_3(a, b, t->a, t->b), vn_turn_3(a, b, t->b, t->c), vn_turn_3(a, b, t->c, t->a));
    return through ? VN_LINE_MEETS : VN_LINE_APART;
}

/// A triangle seen along the axis that shows it largest.
typedef struct flat {
    int i, j; ///< the axes that are left
    double turn;
} flat;

static double turn_in(const flat *f, const double a[3], const double b[3], const double c[3]) {
    return vn_turn(a[f->i], a[f->j], b[f->i], b[f->j], c[f->i], c[f->j]);
}

static flat flatten(const vn_triangle *t) {
    flat best = {0, 1, 0};
    for (int k = 0; k < 3; k++) {
        flat f = {(k + 1) % 3, (k + 2) % 3, 0};
        f.turn = turn_in(&f, t->a, t->b, t->c);
        best = fabs(f.turn) > fabs(best.turn) ? f : best;
    }
    return best;
}

static vn_segment segment_in(const flat *f, const double a[3], const double b[3]) {
    return (vn_segment){a[f->i], a[f->j], b[f->i], b[f->j]};
}

bool vn_coplanar_line_meets(const vn_triangle *t, const double a[3], const double b[3]) {
    flat f = flatten(t);
    vn_segment line = segment_in(&f, a, b),
               sides[3] = {segment_in(&f, t->a, t->b), segment_in(&f, t->b, t->c),
                           segment_in(&f, t->c, t->a)};
    for (int k = 0; k < 3; k++) {
        if (vn_segments_touch(&line, &sides[k])) {
            return true;
        }
    }
    return agree(turn_in(&f, t->a, t->b, a), turn_in(&f, t->b, t->c, a), turn_in(&f, t->c, t->a, a));
}

bool vn_line_enters(const vn_triangle *t, const double b[3]) {
    if (vn_turn_3(t->a, t->b, t->c, b) != 0) {
        return false;
    }
    flat f = flatten(t);
    return agree(f.turn, turn_in(&f, t->a, t->b, b), turn_in(&f, t->a, b, t->c));
}

// The side of p at the projection of the edge from a to b onto the plane of y and z. Where that is 0, the
// sign of what moving p changes in it; 0 only for an edge along x.
static int side_of_edge(const double a[3], const double b[3], const double p[3]) {
    double turn = vn_turn(a[1], a[2], b[1], b[2], p[1], p[2]);
    if (turn != 0) {
        return sign_of(turn);
    }
    return a[2] != b[2] ? sign_of(a[2] - b[2]) : sign_of(b[1] - a[1]);
}

bool vn_ray_passes(const vn_triangle *t, const double p[3], bool *touched) {
    for (int k = 1; k < 3; k++) {
        if (fmax(fmax(t->a[k], t->b[k]), t->c[k]) < p[k] || fmin(fmin(t->a[k], t->b[k]), t->c[k]) > p[k]) {
            return false;
        }
    }
    if (fmax(fmax(t->a[0], t->b[0]), t->c[0]) < p[0]) {
        return false;
    }
    int side = side_of_edge(t->a, t->b, p);
    if (side == 0 || side_of_edge(t->b, t->c, p) != side || side_of_edge(t->c, t->a, p) != side) {
        return false;
    }
    double above = side * vn_turn_3(t->a, t->b, t->c, p);
    *touched = *touched || above == 0;
    return above < 0;
}
