#include "draw/marks.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

// Where the light comes from, a unit vector: over the viewer's left shoulder. y points down, z to the eye.
static const double LIGHT[3] = {-0.28, -0.35, 0.8939};

// What a surface shows that the light does not reach, and the share of white where it shines most.
static const double AMBIENT = 0.44, SHINE = 0.42, SHINE_FROM = 0.72;

double vn_light_on(const double n[3]) {
    return n[0] * LIGHT[0] - n[1] * LIGHT[1] + n[2] * LIGHT[2];
}

static const double LEAST_OVERLAP = 0.3, MORE_OVERLAP = 1;

enum { MOST_BANDS = 40, MOST_CORNERS = 48, MOST_ARC = 10 };

typedef struct brush {
    const vn_mark *mark;
    vn_color haze;
    vn_area_fn *area;
    void *payload;
} brush;

static uint8_t channel(double value) {
    return (uint8_t)(fmin(fmax(value, 0), 255) + 0.5);
}

static double lit(double base, double light) {
    double shine = fmax(0, (light - SHINE_FROM) / (1 - SHINE_FROM));
    double value = base * fmin(AMBIENT + 1.1 * (1 - AMBIENT) * light, 1);
    return value + SHINE * shine * shine * (255 - value);
}

static vn_color hazed(const brush *b, double red, double green, double blue) {
    double share = b->mark->haze;
    return (vn_color){channel(red + share * (b->haze.red - red)),
                      channel(green + share * (b->haze.green - green)),
                      channel(blue + share * (b->haze.blue - blue)), 255};
}

static vn_color in_light(const brush *b, double light) {
    vn_color base = b->mark->color;
    return hazed(b, lit(base.red, light), lit(base.green, light), lit(base.blue, light));
}

// A band is about as wide as a pixel, where there is room for so many.
static int bands_of(double radius) {
    return (int)fmin(fmax(1 + floor(1.2 * radius), 1), MOST_BANDS);
}

static double band_light(int band, int bands) {
    return bands == 1 ? 0.65 : (band + 0.5) / bands;
}

// ---- Tubes ----

// The surface of a round tube, seen from the front: at angle `turn` from the line nearest to the eye, its
// normal is sin(turn) across + cos(turn) towards.
typedef struct tube_look {
    double along[2];   ///< on the canvas, of unit length
    double across[2];  ///< on the canvas
    double towards[2]; ///< the canvas's part of it
    double light;      ///< on the brightest line
    double brightest;  ///< where that is
} tube_look;

static bool look_at_tube(tube_look *look, const vn_mark *mark) {
    double dx = mark->at[1].x - mark->at[0].x, dy = mark->at[1].y - mark->at[0].y;
    double length = hypot(dx, dy);
    double slope = mark->slope;
    if (!(length > 1e-6) || fabs(slope) >= 1) {
        return false; // seen from its end, which is a ball's to show
    }
    look->along[0] = dx / length;
    look->along[1] = dy / length;
    look->across[0] = -look->along[1];
    look->across[1] = look->along[0];
    look->towards[0] = -slope * look->along[0];
    look->towards[1] = -slope * look->along[1];
    double side = LIGHT[0] * look->across[0] + LIGHT[1] * look->across[1];
    double front =
        LIGHT[0] * look->towards[0] + LIGHT[1] * look->towards[1] + LIGHT[2] * sqrt(1 - slope * slope);
    look->light = hypot(side, front);
    look->brightest = atan2(side, front);
    return true;
}

// @p more: how far the tube goes on beyond its end, pixels.
static vn_spot tube_spot(const tube_look *look, const vn_mark *mark, int end, double turn, double more) {
    double s = sin(turn) * (double)mark->radius[end], c = cos(turn) * (double)mark->radius[end];
    double on = end == 0 ? -more : more;
    return (vn_spot){mark->at[end].x + s * look->across[0] + c * look->towards[0] + on * look->along[0],
                     mark->at[end].y + s * look->across[1] + c * look->towards[1] + on * look->along[1]};
}

// How many lines make the arc in which the tube ends.
static int arc_lines(const vn_mark *mark) {
    double radius = fmaxf(mark->radius[0], mark->radius[1]);
    double bulge = radius * fabs((double)mark->slope);
    return bulge < 0.25 ? 1 : (int)fmin(2 + sqrt(2 * radius), MOST_ARC);
}

// Stretches overlap: where areas only touch, what is behind shines through. The lighter a band, the farther
// it reaches, or the darker ones' blurred ends would be seen as a line across the tube.
static void put_strip(const brush *b, const tube_look *look, double low, double high, double light) {
    vn_spot ring[2 * (MOST_ARC + 1)];
    int lines = arc_lines(b->mark);
    double more = LEAST_OVERLAP + MORE_OVERLAP * light;
    for (int i = 0; i <= lines; i++) {
        double turn = low + (high - low) * i / lines;
        ring[i] = tube_spot(look, b->mark, 0, turn, more);
        ring[2 * lines + 1 - i] = tube_spot(look, b->mark, 1, turn, more);
    }
    b->area(b->payload, ring, 2 * (lines + 1), in_light(b, light));
}

static void paint_tube(const brush *b) {
    tube_look look;
    if (!look_at_tube(&look, b->mark)) {
        return;
    }
    int bands = bands_of(fmaxf(b->mark->radius[0], b->mark->radius[1]));
    put_strip(b, &look, -0.5 * PI, 0.5 * PI, band_light(0, bands));
    for (int k = 1; k < bands && k < look.light * bands; k++) {
        double half = acos(k / (look.light * bands));
        double low = fmax(look.brightest - half, -0.5 * PI), high = fmin(look.brightest + half, 0.5 * PI);
        if (low < high) {
            put_strip(b, &look, low, high, band_light(k, bands));
        }
    }
}

// ---- Balls, dots and faces ----

static int corners_of(double radius) {
    return (int)fmin(8 + 4 * sqrt(radius), MOST_CORNERS);
}

static void put_disc(const brush *b, vn_color color) {
    vn_spot ring[MOST_CORNERS];
    int corners = corners_of(b->mark->radius[0]);
    for (int i = 0; i < corners; i++) {
        double angle = 2 * PI * i / corners;
        ring[i].x = b->mark->at[0].x + (double)b->mark->radius[0] * cos(angle);
        ring[i].y = b->mark->at[0].y + (double)b->mark->radius[0] * sin(angle);
    }
    b->area(b->payload, ring, corners, color);
}

// The part of a ball whose normals have at least @p level of the light: a cap, of which what is on the far
// side is pressed to the rim.
static void put_cap(const brush *b, double level, double light) {
    vn_spot ring[MOST_CORNERS];
    int corners = corners_of(b->mark->radius[0]);
    double flat = hypot(LIGHT[0], LIGHT[1]), wide = sqrt(1 - level * level);
    double qx = LIGHT[0] / flat, qy = LIGHT[1] / flat;
    for (int i = 0; i < corners; i++) {
        double angle = 2 * PI * i / corners;
        double c = wide * cos(angle), s = wide * sin(angle);
        double x = level * LIGHT[0] + c * qx * LIGHT[2] - s * qy;
        double y = level * LIGHT[1] + c * qy * LIGHT[2] + s * qx;
        double shrink = level * LIGHT[2] - c * flat < 0 ? hypot(x, y) : 1;
        ring[i].x = b->mark->at[0].x + (double)b->mark->radius[0] * x / shrink;
        ring[i].y = b->mark->at[0].y + (double)b->mark->radius[0] * y / shrink;
    }
    b->area(b->payload, ring, corners, in_light(b, light));
}

static void paint_ball(const brush *b) {
    int bands = bands_of(b->mark->radius[0]);
    put_disc(b, in_light(b, band_light(0, bands)));
    for (int k = 1; k < bands; k++) {
        put_cap(b, (double)k / bands, band_light(k, bands));
    }
}

static void paint_dot(const brush *b) {
    vn_color color = b->mark->color;
    put_disc(b, hazed(b, color.red, color.green, color.blue));
}

// Half a pixel larger to all sides, so that neighbours leave no seam.
static void paint_face(const brush *b) {
    const vn_spot *at = b->mark->at;
    vn_spot ring[3];
    double x = (at[0].x + at[1].x + at[2].x) / 3, y = (at[0].y + at[1].y + at[2].y) / 3;
    for (int i = 0; i < 3; i++) {
        double dx = at[i].x - x, dy = at[i].y - y;
        double length = hypot(dx, dy), more = length > 0 ? 0.6 / length : 0;
        ring[i] = (vn_spot){at[i].x + more * dx, at[i].y + more * dy};
    }
    b->area(b->payload, ring, 3, in_light(b, b->mark->light));
}

void vn_mark_paint(const vn_canvas *canvas, const vn_mark *mark, vn_area_fn *area, void *payload) {
    brush b = {mark, canvas->background, area, payload};
    if (b.haze.alpha == 0) {
        b.haze = (vn_color){255, 255, 255, 255};
    }
    switch ((vn_mark_kind)mark->kind) {
    case VN_MARK_TUBE:
        paint_tube(&b);
        break;
    case VN_MARK_BALL:
        paint_ball(&b);
        break;
    case VN_MARK_DOT:
        paint_dot(&b);
        break;
    default:
        paint_face(&b);
    }
}
