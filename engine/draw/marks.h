/// What a camera saw, as areas of one colour each: all that PNG, PDF, SVG and EPS have in common.
#ifndef VN_DRAW_MARKS_H
#define VN_DRAW_MARKS_H

#include "draw/canvas.h"

/// How much light falls on a surface with the unit normal @p n (right, up, towards the eye); below 0: none.
double vn_light_on(const double n[3]);

/// Paint one ring, over what was painted before.
typedef void vn_area_fn(void *payload, const vn_spot *ring, int32_t count, vn_color color);

/// The areas of one mark, in the order in which they are painted. Round things are bands of equal light, each
/// painted upon the one that is darker, so that there are no seams; they are as many as its size deserves.
void vn_mark_paint(const vn_canvas *canvas, const vn_mark *mark, vn_area_fn *area, void *payload);

#endif
