#include "file/svg_path.h"

#include <math.h>

enum { MOST_POINTS = 10000000, MOST_PIECES = 2048, POINTS_BETWEEN_POLLS = 1 << 16 };

static const double pi = 3.14159265358979323846;

vn_svg_pen vn_svg_pen_make(const vn_svg_matrix *matrix, vn_rings *rings, double tolerance) {
    return (vn_svg_pen){
        .matrix = *matrix,
        .rings = rings,
        .tolerance = tolerance,
        .min = {INFINITY, INFINITY},
        .max = {-INFINITY, -INFINITY},
    };
}

static void place(const vn_svg_pen *pen, const double p[2], double q[2]) {
    const vn_svg_matrix *m = &pen->matrix;
    q[0] = m->a * p[0] + m->c * p[1] + m->e;
    q[1] = m->b * p[0] + m->d * p[1] + m->f;
}

static int64_t points_held(const vn_svg_pen *pen) {
    return pen->rings != NULL ? pen->rings->x.count : pen->paths != NULL ? pen->paths->xyz.count / 3 : 0;
}

static vn_status check_limits(vn_svg_pen *pen) {
    pen->points++;
    if (pen->points % POINTS_BETWEEN_POLLS == 0) {
        VN_TRY(vn_poll());
    }
    if (pen->points > MOST_POINTS || points_held(pen) >= MOST_POINTS) {
        return vn_fail(VN_LIMIT, "more than %d points: simplify the drawing, or give a larger tolerance",
                       MOST_POINTS);
    }
    return VN_OK;
}

// A point in final coordinates.
static vn_status put(vn_svg_pen *pen, const double q[2]) {
    VN_TRY(check_limits(pen));
    for (int k = 0; k < 2; k++) {
        pen->min[k] = q[k] < pen->min[k] ? q[k] : pen->min[k];
        pen->max[k] = q[k] > pen->max[k] ? q[k] : pen->max[k];
    }
    if (pen->paths != NULL) {
        return vn_paths_draw(pen->paths, (double[3]){q[0], q[1], 0});
    }
    return pen->rings != NULL ? vn_rings_point(pen->rings, q[0], q[1]) : VN_OK;
}

static vn_status put_here(vn_svg_pen *pen, double x, double y) {
    pen->at[0] = x;
    pen->at[1] = y;
    place(pen, pen->at, pen->from);
    return put(pen, pen->from);
}

static vn_status end_ring(vn_svg_pen *pen) {
    if (pen->paths != NULL) {
        return vn_paths_lift(pen->paths);
    }
    return pen->rings != NULL ? vn_rings_close(pen->rings) : VN_OK;
}

vn_status vn_svg_pen_move(vn_svg_pen *pen, double x, double y) {
    VN_TRY(end_ring(pen));
    pen->start[0] = x;
    pen->start[1] = y;
    return put_here(pen, x, y);
}

vn_status vn_svg_pen_line(vn_svg_pen *pen, double x, double y) {
    return put_here(pen, x, y);
}

vn_status vn_svg_pen_close(vn_svg_pen *pen) {
    VN_TRY(pen->paths != NULL ? put_here(pen, pen->start[0], pen->start[1]) : VN_OK);
    return vn_svg_pen_move(pen, pen->start[0], pen->start[1]);
}

static double bend(const double a[2], const double b[2], const double c[2]) {
    return hypot(a[0] - 2 * b[0] + c[0], a[1] - 2 * b[1] + c[1]);
}

// Wang's bound: that many equal steps of the parameter keep the polyline within the tolerance of the curve.
static int count_pieces(double p[4][2], double tolerance) {
    double most = fmax(bend(p[0], p[1], p[2]), bend(p[1], p[2], p[3]));
    double pieces = ceil(sqrt(0.75 * most / tolerance));
    if (!(pieces < MOST_PIECES)) {
        return MOST_PIECES;
    }
    return pieces > 1 ? (int)pieces : 1;
}

static void point_on_cubic(double p[4][2], double t, double q[2]) {
    double s = 1 - t;
    for (int k = 0; k < 2; k++) {
        q[k] = s * s * s * p[0][k] + 3 * s * s * t * p[1][k] + 3 * s * t * t * p[2][k] + t * t * t * p[3][k];
    }
}

vn_status vn_svg_pen_cubic(vn_svg_pen *pen, const double p1[2], const double p2[2], const double p3[2]) {
    double p[4][2] = {{pen->from[0], pen->from[1]}};
    place(pen, p1, p[1]);
    place(pen, p2, p[2]);
    place(pen, p3, p[3]);
    if (pen->rings == NULL && pen->paths == NULL) {
        VN_TRY(put(pen, p[1]));
        VN_TRY(put(pen, p[2]));
        return put_here(pen, p3[0], p3[1]);
    }
    int pieces = count_pieces(p, pen->tolerance);
    for (int i = 1; i < pieces; i++) {
        double q[2];
        point_on_cubic(p, (double)i / pieces, q);
        VN_TRY(put(pen, q));
    }
    return put_here(pen, p3[0], p3[1]);
}

/// An ellipse as the image of the unit circle.
typedef struct ellipse {
    double center[2], cos_axis[2], sin_axis[2];
} ellipse;

static void point_on_ellipse(const ellipse *e, double c, double s, double q[2]) {
    for (int k = 0; k < 2; k++) {
        q[k] = e->center[k] + c * e->cos_axis[k] + s * e->sin_axis[k];
    }
}

// As cubics of at most 15 degrees, which stay within 6e-9 of the radius.
vn_status vn_svg_pen_arc(vn_svg_pen *pen, const double center[2], const double radii[2], double turn,
                         double begin, double sweep) {
    ellipse e = {{center[0], center[1]},
                 {radii[0] * cos(turn), radii[0] * sin(turn)},
                 {-radii[1] * sin(turn), radii[1] * cos(turn)}};
    int pieces = (int)ceil(fmin(fabs(sweep), 2 * pi) / (pi / 12));
    for (int i = 0; i < pieces; i++) {
        double a = begin + sweep * i / pieces;
        double b = begin + sweep * (i + 1) / pieces;
        double reach = 4.0 / 3 * tan((b - a) / 4);
        double p1[2], p2[2], p3[2];
        point_on_ellipse(&e, cos(a) - reach * sin(a), sin(a) + reach * cos(a), p1);
        point_on_ellipse(&e, cos(b) + reach * sin(b), sin(b) - reach * cos(b), p2);
        point_on_ellipse(&e, cos(b), sin(b), p3);
        VN_TRY(vn_svg_pen_cubic(pen, p1, p2, p3));
    }
    return VN_OK;
}

/// What is left of path data, and what the next command depends on.
typedef struct path_reader {
    vn_svg_pen *pen;
    const char *at, *end;
    char command; ///< upper case
    bool relative;
    char before;       ///< the command before this one, upper case
    double control[2]; ///< of that, for S and T
} path_reader;

static void skip_separator(path_reader *reader) {
    reader->at = vn_svg_skip(reader->at);
}

static bool read_number(path_reader *reader, double *value) {
    skip_separator(reader);
    const char *next = vn_parse_number(reader->at, reader->end, value);
    if (next == NULL) {
        return false;
    }
    reader->at = next;
    return true;
}

// Flags are one digit each and need nothing between them.
static bool read_flag(path_reader *reader, bool *flag) {
    skip_separator(reader);
    if (*reader->at != '0' && *reader->at != '1') {
        return false;
    }
    *flag = *reader->at++ == '1';
    return true;
}

static bool read_point(path_reader *reader, double p[2]) {
    if (!read_number(reader, &p[0]) || !read_number(reader, &p[1])) {
        return false;
    }
    if (reader->relative) {
        p[0] += reader->pen->at[0];
        p[1] += reader->pen->at[1];
    }
    return true;
}

/// How drawing one segment ended: `bad` data end the path without an error.
typedef struct outcome {
    vn_status status;
    bool bad;
} outcome;

static outcome bad_data(void) {
    return (outcome){VN_OK, true};
}

static outcome drawn(vn_status status) {
    return (outcome){status, false};
}

static void keep_control(path_reader *reader, const double p[2]) {
    reader->control[0] = p[0];
    reader->control[1] = p[1];
}

static outcome draw_straight(path_reader *reader) {
    vn_svg_pen *pen = reader->pen;
    double p[2] = {pen->at[0], pen->at[1]};
    double value = 0;
    bool good;
    switch (reader->command) {
    case 'H':
        good = read_number(reader, &value);
        p[0] = reader->relative ? p[0] + value : value;
        break;
    case 'V':
        good = read_number(reader, &value);
        p[1] = reader->relative ? p[1] + value : value;
        break;
    default:
        good = read_point(reader, p);
    }
    return good ? drawn(vn_svg_pen_line(pen, p[0], p[1])) : bad_data();
}

// The last control point seen in the mirror of the current point, when the command before has one.
static void mirror_control(const path_reader *reader, const char *commands, double p[2]) {
    bool mirrored = reader->before != '\0' && strchr(commands, reader->before) != NULL;
    for (int k = 0; k < 2; k++) {
        double here = reader->pen->at[k];
        p[k] = mirrored ? 2 * here - reader->control[k] : here;
    }
}

static outcome draw_cubic(path_reader *reader) {
    double p1[2], p2[2], p3[2];
    if (reader->command == 'S') {
        mirror_control(reader, "CS", p1);
    } else if (!read_point(reader, p1)) {
        return bad_data();
    }
    if (!read_point(reader, p2) || !read_point(reader, p3)) {
        return bad_data();
    }
    keep_control(reader, p2);
    return drawn(vn_svg_pen_cubic(reader->pen, p1, p2, p3));
}

static outcome draw_quadratic(path_reader *reader) {
    double c[2], p3[2], p1[2], p2[2];
    if (reader->command == 'T') {
        mirror_control(reader, "QT", c);
    } else if (!read_point(reader, c)) {
        return bad_data();
    }
    if (!read_point(reader, p3)) {
        return bad_data();
    }
    for (int k = 0; k < 2; k++) {
        p1[k] = reader->pen->at[k] + 2.0 / 3 * (c[k] - reader->pen->at[k]);
        p2[k] = p3[k] + 2.0 / 3 * (c[k] - p3[k]);
    }
    keep_control(reader, c);
    return drawn(vn_svg_pen_cubic(reader->pen, p1, p2, p3));
}

// (Half the chord over the radius)²: below this an arc rises less than 3e-8 of its chord.
#define STRAIGHT 1e-14

/// An arc as it is written in path data.
typedef struct arc {
    double radii[2], turn; ///< the turn in radians
    bool large, positive;
    double to[2];
} arc;

// SVG 1.1, appendix F.6: from end points to the centre; radii that are too small grow until they reach.
static vn_status draw_arc_from(vn_svg_pen *pen, arc *a) {
    double c = cos(a->turn), s = sin(a->turn);
    double dx = (pen->at[0] - a->to[0]) / 2, dy = (pen->at[1] - a->to[1]) / 2;
    double x = (c * dx + s * dy) / a->radii[0], y = (c * dy - s * dx) / a->radii[1];
    double excess = sqrt(x * x + y * y);
    if (excess > 1) {
        a->radii[0] *= excess;
        a->radii[1] *= excess;
        x /= excess;
        y /= excess;
    }
    double square = x * x + y * y;
    if (!(square > STRAIGHT)) {
        return vn_svg_pen_line(pen, a->to[0], a->to[1]);
    }
    double apart = sqrt(fmax(0, 1 - square) / square) * (a->large == a->positive ? -1 : 1);
    double cx = apart * y, cy = -apart * x; // on the unit circle
    double ex = cx * a->radii[0], ey = cy * a->radii[1];
    double center[2] = {c * ex - s * ey + (pen->at[0] + a->to[0]) / 2,
                        s * ex + c * ey + (pen->at[1] + a->to[1]) / 2};
    double begin = atan2(y - cy, x - cx);
    double sweep = atan2(-y - cy, -x - cx) - begin;
    if (a->positive && sweep < 0) {
        sweep += 2 * pi;
    } else if (!a->positive && sweep > 0) {
        sweep -= 2 * pi;
    }
    VN_TRY(vn_svg_pen_arc(pen, center, a->radii, a->turn, begin, sweep));
    return vn_svg_pen_line(pen, a->to[0], a->to[1]); // exactly, whatever the rounding on the way
}

static outcome draw_arc(path_reader *reader) {
    arc a;
    double degrees;
    if (!read_number(reader, &a.radii[0]) || !read_number(reader, &a.radii[1]) ||
        !read_number(reader, &degrees) || !read_flag(reader, &a.large) || !read_flag(reader, &a.positive) ||
        !read_point(reader, a.to)) {
        return bad_data();
    }
    vn_svg_pen *pen = reader->pen;
    bool nowhere = a.to[0] == pen->at[0] && a.to[1] == pen->at[1];
    a.radii[0] = fabs(a.radii[0]);
    a.radii[1] = fabs(a.radii[1]);
    a.turn = degrees * pi / 180;
    if (nowhere || a.radii[0] == 0 || a.radii[1] == 0) {
        return drawn(vn_svg_pen_line(pen, a.to[0], a.to[1]));
    }
    return drawn(draw_arc_from(pen, &a));
}

static outcome draw_move(path_reader *reader) {
    double p[2];
    if (!read_point(reader, p)) {
        return bad_data();
    }
    reader->command = 'L'; // pairs that follow are lines
    return drawn(vn_svg_pen_move(reader->pen, p[0], p[1]));
}

static outcome draw_segment(path_reader *reader) {
    switch (reader->command) {
    case 'M':
        return draw_move(reader);
    case 'L':
    case 'H':
    case 'V':
        return draw_straight(reader);
    case 'C':
    case 'S':
        return draw_cubic(reader);
    case 'Q':
    case 'T':
        return draw_quadratic(reader);
    case 'A':
        return draw_arc(reader);
    default:
        return bad_data(); // numbers after Z, or before anything
    }
}

// Take a command letter, if there is one. False for a letter that is none.
static bool read_command(path_reader *reader) {
    char letter = *reader->at;
    bool lower = letter >= 'a' && letter <= 'z';
    bool upper = letter >= 'A' && letter <= 'Z';
    if (!lower && !upper) {
        return true;
    }
    reader->command = lower ? (char)(letter - 'a' + 'A') : letter;
    reader->relative = lower;
    reader->at++;
    return strchr("MLHVCSQTAZ", reader->command) != NULL;
}

static outcome draw_next(path_reader *reader) {
    const char *begin = reader->at;
    if (!read_command(reader) || (reader->pen->points == 0 && reader->command != 'M')) {
        return bad_data();
    }
    char command = reader->command;
    bool closing = command == 'Z' && reader->at != begin;
    outcome result = closing ? drawn(vn_svg_pen_close(reader->pen)) : draw_segment(reader);
    reader->before = command;
    return result;
}

vn_status vn_svg_draw_path(vn_svg_pen *pen, const char *data) {
    path_reader reader = {.pen = pen, .at = data, .end = data + strlen(data)};
    skip_separator(&reader);
    while (*reader.at != '\0') {
        outcome result = draw_next(&reader);
        VN_TRY(result.status);
        if (result.bad) {
            break;
        }
        skip_separator(&reader);
    }
    if (pen->points == 0) {
        return vn_fail(VN_INVALID, "its path data \"%.24s\" begin with no point", data);
    }
    return end_ring(pen);
}

vn_status vn_svg_draw_points(vn_svg_pen *pen, const char *data, bool closed) {
    path_reader reader = {.pen = pen, .at = data, .end = data + strlen(data)};
    double p[2];
    while (read_point(&reader, p)) {
        VN_TRY(pen->points == 0 ? vn_svg_pen_move(pen, p[0], p[1]) : vn_svg_pen_line(pen, p[0], p[1]));
    }
    VN_TRY(closed && pen->points > 0 ? vn_svg_pen_close(pen) : VN_OK);
    return end_ring(pen);
}
