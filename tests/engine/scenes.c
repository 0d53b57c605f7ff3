#include "scenes.h"

void set_point(double to[3], double x, double y, double z) {
    to[0] = x;
    to[1] = y;
    to[2] = z;
}

// From the front: x to the right, y up, z to the eye, one pixel a unit, (0, 0, 0) in the middle of 200 x 200.
vn_camera_def from_the_front(void) {
    vn_camera_def camera = vn_camera_def_default();
    set_point(camera.from, 0, 0, 1000);
    camera.fov = 0;
    return camera;
}

vn_canvas *canvas_with(const vn_camera_def *camera, const char *background) {
    vn_canvas_def def = vn_canvas_def_default();
    vn_canvas *canvas = NULL;
    def.width = def.height = 200;
    def.margin = 0;
    def.view = (vn_box){{-100, -100, -100}, {100, 100, 100}};
    def.background = background;
    def.camera = camera;
    assert_ok(vn_canvas_create(&canvas, &def));
    return canvas;
}

vn_network *edge(double x1, double y1, double z1, double x2, double y2, double z2) {
    vn_network *network = network_of(3);
    put_child(network, put_root(network, x1, y1, z1), x2, y2, z2);
    return network;
}

vn_network *tangled_tree(int32_t nodes, int dim) {
    vn_network *network = network_of(dim);
    vn_rng rng = vn_rng_make(7);
    vn_murray_def law = vn_murray_def_default();
    law.tip_radius = 0.5;
    assert_ok(vn_network_murray(network, &law));
    put_root(network, 0, 0, 0);
    for (int32_t i = 1; i < nodes; i++) {
        int32_t parent = (int32_t)vn_rng_integer(&rng, i > 9 ? i - 9 : 0, i - 1);
        double p[3] = {0};
        for (int k = 0; k < dim; k++) {
            p[k] = vn_rng_uniform(&rng, -90, 90);
        }
        put_child(network, parent, p[0], p[1], p[2]);
    }
    return network;
}

void stroke(vn_canvas *canvas, const vn_network *network, const char *color, double width) {
    vn_stroke_def def = vn_stroke_def_default();
    def.color = color;
    def.width = width;
    assert_ok(vn_canvas_stroke(canvas, network, &def));
}

// Each node is near its parent, as in what grows.
vn_network *grown_tree(int32_t nodes) {
    vn_network *network = network_of(3);
    vn_rng rng = vn_rng_make(9);
    put_root(network, 0, 0, 0);
    for (int32_t i = 1; i < nodes; i++) {
        int32_t parent = (int32_t)vn_rng_integer(&rng, 0, i - 1);
        double step[3], p[3] = {vn_network_x(network)[parent], vn_network_y(network)[parent],
                                vn_network_z(network)[parent]};
        for (int k = 0; k < 3; k++) {
            step[k] = vn_rng_uniform(&rng, -8, 8);
            p[k] += fabs(p[k] + step[k]) < 95 ? step[k] : -step[k];
        }
        put_child(network, parent, p[0], p[1], p[2]);
    }
    return network;
}

// Draw one edge and forget it.
void stroke_edge(vn_canvas *canvas, const char *color, double width, const double a[3], const double b[3]) {
    vn_network *network = edge(a[0], a[1], a[2], b[0], b[1], b[2]);
    stroke(canvas, network, color, width);
    vn_network_destroy(network);
}

picture take_picture(const vn_canvas *canvas) {
    picture made = {.head = {.version = PNG_IMAGE_VERSION}};
    assert_ok(vn_canvas_save(canvas, "test_camera.png", NULL));
    assert_true(png_image_begin_read_from_file(&made.head, "test_camera.png"));
    made.head.format = PNG_FORMAT_RGBA;
    made.rgba = malloc(PNG_IMAGE_SIZE(made.head));
    assert_non_null(made.rgba);
    assert_true(png_image_finish_read(&made.head, NULL, made.rgba, 0, NULL));
    remove("test_camera.png");
    return made;
}

// The pixel at (x, y) of from_the_front()'s canvas.
const unsigned char *pixel(const picture *from, int x, int y) {
    return from->rgba + 4 * ((size_t)(99 - y) * from->head.width + (size_t)(100 + x));
}

bool is_red(const unsigned char *rgba) {
    return rgba[3] == 255 && rgba[0] > 2 * rgba[2] && rgba[0] > 80;
}

bool is_blue(const unsigned char *rgba) {
    return rgba[3] == 255 && rgba[2] > 2 * rgba[0] && rgba[2] > 80;
}

double covered(const vn_canvas *canvas) {
    picture from = take_picture(canvas);
    double sum = 0;
    for (size_t i = 0; i < (size_t)from.head.width * from.head.height; i++) {
        sum += from.rgba[4 * i + 3] / 255.0;
    }
    free(from.rgba);
    return sum;
}

char *read_file(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    char *bytes = malloc(*size + 1);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, *size, file), *size);
    bytes[*size] = '\0';
    fclose(file);
    remove(path);
    return bytes;
}

char *bytes_of(const vn_canvas *canvas, const char *path, size_t *size) {
    assert_ok(vn_canvas_save(canvas, path, "{\"seed\": 1}"));
    return read_file(path, size);
}
