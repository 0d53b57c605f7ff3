/// The outline of a taper: the convex hull of two circles.
#ifndef VN_DRAW_TAPER_H
#define VN_DRAW_TAPER_H

#include "draw/canvas.h"

#include <math.h>

/// Two arcs and two tangents, in the order of growing angles (clockwise on a canvas, where y points
/// down): round the first circle from axis + turn to axis - turn, then round the second from axis - turn
/// to axis + turn.
typedef struct vn_taper {
    vn_spot center[2];
    double radius[2];
    double axis; ///< direction from the first centre to the second, radians
    double turn; ///< between the axis and the radii at the tangents' ends, radians
    int whole;   ///< the circle that holds the other one and is the whole hull, or -1
} vn_taper;

static inline vn_taper vn_taper_of(const vn_canvas *canvas, const vn_piece *piece) {
    const vn_spot *spots = canvas->points.data + piece->begin;
    vn_taper taper = {{spots[0], spots[1]}, {0.5 * piece->width, 0.5 * piece->end_width}, 0, 0, -1};
    double dx = spots[1].x - spots[0].x;
    double dy = spots[1].y - spots[0].y;
    double distance = hypot(dx, dy);
    double narrowing = taper.radius[0] - taper.radius[1];
    if (distance <= fabs(narrowing)) {
        taper.whole = narrowing > 0 ? 0 : 1;
    } else {
        taper.axis = atan2(dy, dx);
        taper.turn = acos(narrowing / distance);
    }
    return taper;
}

/// The point of circle @p i at @p angle.
static inline vn_spot vn_taper_spot(const vn_taper *taper, int i, double angle) {
    return (vn_spot){taper->center[i].x + taper->radius[i] * cos(angle),
                     taper->center[i].y + taper->radius[i] * sin(angle)};
}

#endif
