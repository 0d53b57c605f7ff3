/// What a camera sees, as marks that are painted from far to near.
///
/// Painting one thing over another is right where the nearer one is wholly nearer. So edges are cut into
/// stretches that come nearer by no more than they are thick (or by four pixels), and each is sorted by the
/// depth of its middle's near side. Things that cross nearer to one another than that, or are stuck in one
/// another, may be painted in the wrong order; within thick branchings one may see it.
#ifndef VN_DRAW_SCENE_H
#define VN_DRAW_SCENE_H

#include "draw/canvas.h"

/// Append a network as tubes and balls. @p colors has one entry a node, or is NULL: all have @p color.
vn_status vn_scene_stroke(vn_canvas *canvas, const vn_network *network, const vn_stroke_def *def,
                          vn_color color);

/// Append a ball of @p radius (view units; 0: a flat dot of two pixels) at each point. @p z may be NULL: 0.
vn_status vn_scene_dots(vn_canvas *canvas, const double *x, const double *y, const double *z, int32_t count,
                        double radius, vn_color color);

/// Append the triangles of a domain's surface; VN_INVALID where it has none.
vn_status vn_scene_fill(vn_canvas *canvas, const vn_domain *domain, vn_color color);

/// Take the marks from @p begin on into the list of items as one film of paint, from far to near. What
/// follows on another scene, both opaque, becomes one with it: so veins and arteries pass before and behind
/// each other.
vn_status vn_scene_close(vn_canvas *canvas, int32_t begin, double opacity);

#endif
