/// Networks and canvases in space for tests, and pictures read back.
#ifndef VN_TESTS_SCENES_H
#define VN_TESTS_SCENES_H

#include "draw/canvas.h"
#include "support.h"

#include <png.h>

typedef struct picture {
    png_image head;
    unsigned char *rgba;
} picture;

void set_point(double to[3], double x, double y, double z);
/// From the front: x to the right, y up, z to the eye, one pixel a unit, (0, 0, 0) in the middle of 200 x
/// 200.
vn_camera_def from_the_front(void);
vn_canvas *canvas_with(const vn_camera_def *camera, const char *background);
vn_network *edge(double x1, double y1, double z1, double x2, double y2, double z2);
/// Its radii are known, its edges long and in a tangle.
vn_network *tangled_tree(int32_t nodes, int dim);
void stroke(vn_canvas *canvas, const vn_network *network, const char *color, double width);
/// Each node is near its parent, as in what grows.
vn_network *grown_tree(int32_t nodes);
/// Draw one edge and forget it.
void stroke_edge(vn_canvas *canvas, const char *color, double width, const double a[3], const double b[3]);
/// Saved as PNG, and read back.
picture take_picture(const vn_canvas *canvas);
/// The pixel at (x, y) of from_the_front()'s canvas.
const unsigned char *pixel(const picture *from, int x, int y);
/// Whether it is opaque and mostly of that colour.
bool is_red(const unsigned char *rgba);
bool is_blue(const unsigned char *rgba);
/// How many pixels are covered, each by its share.
double covered(const vn_canvas *canvas);
/// The bytes of a file, which is then removed; a zero byte follows.
char *read_file(const char *path, size_t *size);
/// The bytes that a canvas is saved as.
char *bytes_of(const vn_canvas *canvas, const char *path, size_t *size);

#endif
