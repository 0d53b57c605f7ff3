/// The camera of a canvas: where a point in space lies on it, how large things are there, and how hazy.
#ifndef VN_DRAW_CAMERA_H
#define VN_DRAW_CAMERA_H

#include "base/schema.h"
#include "venule/output.h"

extern const vn_schema vn_camera_schema;

/// A zeroed one is none.
typedef struct vn_camera {
    bool on;
    double middle[3];                ///< what it looks at, which is the origin of what it sees
    double right[3], up[3], back[3]; ///< unit vectors; `back` points from the middle to the eye
    double distance;                 ///< from the middle to the eye; INFINITY: a parallel projection
    double scale;                    ///< pixels to a unit at the middle
    double x, y;                     ///< of the middle on the canvas, pixels, y down
    double fog;                      ///< how much of the background covers what is farthest, 0 to 1
    double nearest, farthest;        ///< of the view, along `back`
} vn_camera;

/// Set up @p camera by @p def for a canvas of @p width by @p height pixels. @p view is what the canvas is to
/// show; an empty one has the same min and max.
vn_status vn_camera_set(vn_camera *camera, const vn_camera_def *def, const vn_box *view, double margin,
                        double width, double height);

/// Point @p p as the camera sees it: along right, up and back, from the middle.
void vn_camera_see(const vn_camera *camera, const double p[3], double seen[3]);

/// Pixels to a unit at depth @p seen[2], which must not be beyond vn_camera_limit().
double vn_camera_scale_at(const vn_camera *camera, const double seen[3]);

/// Where what is seen lies on the canvas, pixels, y down. Not held within any bounds.
void vn_camera_project(const vn_camera *camera, const double seen[3], double spot[2]);

/// The depth beyond which things are too near the eye, or behind it: nothing there is drawn.
double vn_camera_limit(const vn_camera *camera);

/// How much of the background covers what is seen at @p depth, 0 to 1.
double vn_camera_haze(const vn_camera *camera, double depth);

#endif
