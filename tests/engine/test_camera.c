// Space through a camera: places against matrices, depth and colours in pixels read back, and files that are
// well-formed.
#include "domain/domain.h"
#include "draw/canvas.h"
#include "draw/ramp.h"

#include <libxml/parser.h>
#include <libxml/tree.h>
#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const double pi = 3.141592653589793;

#define assert_ok(call) assert_int_equal((call), VN_OK)
#define assert_message(part) assert_non_null(strstr(vn_message(), (part)))

static void assert_near(double value, double expected, double tolerance) {
    if (!(fabs(value - expected) <= tolerance)) {
        fail_msg("%.9g is not within %g of %.9g", value, tolerance, expected);
    }
}

static void set_point(double to[3], double x, double y, double z) {
    to[0] = x;
    to[1] = y;
    to[2] = z;
}

// From the front: x to the right, y up, z to the eye, one pixel a unit, (0, 0, 0) in the middle of 200 x 200.
static vn_camera_def from_the_front(void) {
    vn_camera_def camera = vn_camera_def_default();
    set_point(camera.from, 0, 0, 1000);
    camera.fov = 0;
    return camera;
}

static vn_canvas *canvas_with(const vn_camera_def *camera, const char *background) {
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

static vn_network *empty_network(int dim) {
    vn_network_def def = vn_network_def_default();
    vn_network *network = NULL;
    def.dim = dim;
    assert_ok(vn_network_create(&network, &def));
    return network;
}

static int32_t root_at(vn_network *network, double x, double y, double z) {
    int32_t node = -1;
    const double p[3] = {x, y, z};
    assert_ok(vn_network_root(network, p, &node));
    return node;
}

static int32_t child_at(vn_network *network, int32_t parent, double x, double y, double z) {
    int32_t node = -1;
    const double p[3] = {x, y, z};
    assert_ok(vn_network_add(network, parent, p, &node));
    return node;
}

static vn_network *edge(double x1, double y1, double z1, double x2, double y2, double z2) {
    vn_network *network = empty_network(3);
    child_at(network, root_at(network, x1, y1, z1), x2, y2, z2);
    return network;
}

static vn_network *random_tree(int32_t nodes, int dim) {
    vn_network *network = empty_network(dim);
    vn_rng rng = vn_rng_make(7);
    vn_murray_def law = vn_murray_def_default();
    law.tip_radius = 0.5;
    assert_ok(vn_network_murray(network, &law));
    root_at(network, 0, 0, 0);
    for (int32_t i = 1; i < nodes; i++) {
        int32_t parent = (int32_t)vn_rng_integer(&rng, i > 9 ? i - 9 : 0, i - 1);
        double p[3] = {0};
        for (int k = 0; k < dim; k++) {
            p[k] = vn_rng_uniform(&rng, -90, 90);
        }
        child_at(network, parent, p[0], p[1], p[2]);
    }
    return network;
}

static void stroke(vn_canvas *canvas, const vn_network *network, const char *color, double width) {
    vn_stroke_def def = vn_stroke_def_default();
    def.color = color;
    def.width = width;
    assert_ok(vn_canvas_stroke(canvas, network, &def));
}

// Each node is near its parent, as in what grows.
static vn_network *grown_tree(int32_t nodes) {
    vn_network *network = empty_network(3);
    vn_rng rng = vn_rng_make(9);
    root_at(network, 0, 0, 0);
    for (int32_t i = 1; i < nodes; i++) {
        int32_t parent = (int32_t)vn_rng_integer(&rng, 0, i - 1);
        double step[3], p[3] = {vn_network_x(network)[parent], vn_network_y(network)[parent],
                                vn_network_z(network)[parent]};
        for (int k = 0; k < 3; k++) {
            step[k] = vn_rng_uniform(&rng, -8, 8);
            p[k] += fabs(p[k] + step[k]) < 95 ? step[k] : -step[k];
        }
        child_at(network, parent, p[0], p[1], p[2]);
    }
    return network;
}

// Draw one edge and forget it.
static void stroke_edge(vn_canvas *canvas, const char *color, double width, const double a[3],
                        const double b[3]) {
    vn_network *network = edge(a[0], a[1], a[2], b[0], b[1], b[2]);
    stroke(canvas, network, color, width);
    vn_network_destroy(network);
}

typedef struct picture {
    png_image head;
    unsigned char *rgba;
} picture;

static picture take_picture(const vn_canvas *canvas) {
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
static const unsigned char *pixel(const picture *from, int x, int y) {
    return from->rgba + 4 * ((size_t)(99 - y) * from->head.width + (size_t)(100 + x));
}

static bool is_red(const unsigned char *rgba) {
    return rgba[3] == 255 && rgba[0] > 2 * rgba[2] && rgba[0] > 80;
}

static bool is_blue(const unsigned char *rgba) {
    return rgba[3] == 255 && rgba[2] > 2 * rgba[0] && rgba[2] > 80;
}

static double covered(const vn_canvas *canvas) {
    picture from = take_picture(canvas);
    double sum = 0;
    for (size_t i = 0; i < (size_t)from.head.width * from.head.height; i++) {
        sum += from.rgba[4 * i + 3] / 255.0;
    }
    free(from.rgba);
    return sum;
}

// ---- Where things are ----

static void normalize(double v[3]) {
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3; k++) {
        v[k] /= length;
    }
}

static void cross(double n[3], const double a[3], const double b[3]) {
    n[0] = a[1] * b[2] - a[2] * b[1];
    n[1] = a[2] * b[0] - a[0] * b[2];
    n[2] = a[0] * b[1] - a[1] * b[0];
}

// The textbook's viewing matrix: rows side, up, back; then the translation to the eye.
static void viewing_matrix(double m[4][4], const vn_camera_def *camera) {
    double back[3], side[3], up[3];
    for (int k = 0; k < 3; k++) {
        back[k] = camera->from[k] - camera->to[k];
    }
    normalize(back);
    cross(side, camera->up, back);
    normalize(side);
    cross(up, back, side);
    memset(m, 0, 16 * sizeof(double));
    for (int k = 0; k < 3; k++) {
        m[0][k] = side[k];
        m[1][k] = up[k];
        m[2][k] = back[k];
        m[0][3] -= side[k] * camera->from[k];
        m[1][3] -= up[k] * camera->from[k];
        m[2][3] -= back[k] * camera->from[k];
    }
    m[3][3] = 1;
}

// The textbook's perspective matrix for the angle and the proportions of the picture.
static void perspective_matrix(double m[4][4], double fov, double width, double height) {
    double f = 1 / tan(fov * pi / 360); // of the shorter side
    double shorter = fmin(width, height);
    memset(m, 0, 16 * sizeof(double));
    m[0][0] = f * shorter / width;
    m[1][1] = f * shorter / height;
    m[2][2] = -1;
    m[3][2] = -1;
}

static void apply(double out[4], double m[4][4], const double in[4]) {
    for (int i = 0; i < 4; i++) {
        out[i] = 0;
        for (int k = 0; k < 4; k++) {
            out[i] += m[i][k] * in[k];
        }
    }
}

static void random_point(vn_rng *rng, double size, double p[3]) {
    for (int k = 0; k < 3; k++) {
        p[k] = vn_rng_uniform(rng, -size, size);
    }
}

static void assert_projected(const vn_canvas *canvas, const vn_camera_def *camera, const double p[3]) {
    double viewing[4][4], perspective[4][4], eye[4], clip[4];
    const double in[4] = {p[0], p[1], p[2], 1};
    viewing_matrix(viewing, camera);
    perspective_matrix(perspective, camera->fov, canvas->width, canvas->height);
    apply(eye, viewing, in);
    apply(clip, perspective, eye);
    vn_spot spot;
    bool before = vn_canvas_place_3(canvas, p, &spot);
    if (clip[3] < 1e-3 * canvas->camera.distance) {
        assert_false(before);
        return;
    }
    assert_true(before);
    assert_near(spot.x, canvas->width * (0.5 + 0.5 * clip[0] / clip[3]), 1e-6 * (1 + fabs(spot.x)));
    assert_near(spot.y, canvas->height * (0.5 - 0.5 * clip[1] / clip[3]), 1e-6 * (1 + fabs(spot.y)));
}

static void a_point_lies_where_the_matrices_say(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(3);
    for (int round = 0; round < 200; round++) {
        vn_camera_def camera = vn_camera_def_default();
        vn_canvas_def def = vn_canvas_def_default();
        vn_canvas *canvas;
        random_point(&rng, 100, camera.from);
        random_point(&rng, 100, camera.to);
        random_point(&rng, 1, camera.up);
        camera.fov = vn_rng_uniform(&rng, 1, 140);
        def.width = vn_rng_integer(&rng, 50, 900);
        def.height = vn_rng_integer(&rng, 50, 900);
        def.margin = 0;
        def.camera = &camera;
        assert_ok(vn_canvas_create(&canvas, &def));
        for (int i = 0; i < 20; i++) {
            double p[3];
            random_point(&rng, 200, p);
            assert_projected(canvas, &camera, p);
        }
        vn_canvas_destroy(canvas);
    }
}

static void a_parallel_camera_from_the_front_is_the_flat_canvas(void **state) {
    (void)state;
    vn_camera_def camera = from_the_front();
    vn_canvas *canvas = canvas_with(&camera, "none");
    vn_canvas *flat = canvas_with(NULL, "none");
    vn_rng rng = vn_rng_make(5);
    for (int i = 0; i < 100; i++) {
        double p[3];
        vn_spot spot;
        random_point(&rng, 100, p);
        assert_true(vn_canvas_place_3(canvas, p, &spot));
        vn_spot expected = vn_canvas_place(flat, p[0], p[1]);
        assert_near(spot.x, expected.x, 1e-9);
        assert_near(spot.y, expected.y, 1e-9);
    }
    vn_canvas_destroy(flat);
    vn_canvas_destroy(canvas);
}

// The corners' bounds on the canvas.
static void assert_fits(double fov, double width, double height) {
    vn_camera_def camera = vn_camera_def_default();
    vn_canvas_def def = vn_canvas_def_default();
    vn_canvas *canvas;
    double tightest = INFINITY;
    camera.fov = fov;
    def.width = width;
    def.height = height;
    def.view = (vn_box){{10, -3, 7}, {50, 8, 90}};
    def.camera = &camera;
    assert_ok(vn_canvas_create(&canvas, &def));
    for (int i = 0; i < 8; i++) {
        const double p[3] = {i & 1 ? 50 : 10, i & 2 ? 8 : -3, i & 4 ? 90 : 7};
        vn_spot spot;
        assert_true(vn_canvas_place_3(canvas, p, &spot));
        tightest = fmin(tightest, fmin(fmin(spot.x, spot.y), fmin(width - spot.x, height - spot.y)));
    }
    assert_near(tightest, 10, 1e-6);
    vn_canvas_destroy(canvas);
}

static void the_default_camera_shows_the_whole_view_and_no_more(void **state) {
    (void)state;
    for (int i = 0; i < 4; i++) {
        double fov = 40.0 * i;
        assert_fits(fov, 300, 300);
        assert_fits(fov, 900, 200);
        assert_fits(fov, 150, 800);
    }
}

static void assert_up(const double up[3], const double from[3]) {
    vn_camera_def camera = vn_camera_def_default();
    memcpy(camera.up, up, sizeof camera.up);
    memcpy(camera.from, from, sizeof camera.from);
    vn_canvas *canvas = canvas_with(&camera, "none");
    vn_spot middle, above;
    const double origin[3] = {0};
    assert_true(vn_canvas_place_3(canvas, origin, &middle));
    assert_true(vn_canvas_place_3(canvas, up, &above));
    assert_near(above.x, middle.x, 1e-9);
    assert_true(above.y < middle.y);
    vn_canvas_destroy(canvas);
}

static void up_is_up(void **state) {
    (void)state;
    const double free_eye[3] = {NAN, NAN, NAN}, eye[3] = {-300, -200, 500};
    vn_rng rng = vn_rng_make(8);
    for (int i = 0; i < 100; i++) {
        double up[3];
        random_point(&rng, 1, up);
        assert_up(up, free_eye);
        assert_up(up, eye);
    }
    for (int k = 0; k < 6; k++) {
        double up[3] = {0};
        up[k / 2] = k % 2 ? -1 : 1;
        assert_up(up, free_eye);
        assert_up(up, eye);
    }
}

static void from_right_above_what_is_behind_is_up(void **state) {
    (void)state;
    vn_camera_def camera = vn_camera_def_default();
    set_point(camera.from, 0, 500, 0);
    vn_canvas *canvas = canvas_with(&camera, "none");
    const double p[3] = {10, 0, -10};
    vn_spot spot;
    assert_true(vn_canvas_place_3(canvas, p, &spot));
    assert_true(spot.x > 100 && spot.y < 100);
    vn_canvas_destroy(canvas);
}

static void assert_refused(const vn_camera_def *camera, bool with_view, const char *part) {
    vn_canvas_def def = vn_canvas_def_default();
    vn_canvas *canvas = NULL;
    if (with_view) {
        def.view = (vn_box){{0, 0, 0}, {1, 1, 1}};
    }
    def.camera = camera;
    assert_int_equal(vn_canvas_create(&canvas, &def), VN_INVALID);
    assert_null(canvas);
    assert_message(part);
}

static void a_wrong_camera_is_refused(void **state) {
    (void)state;
    vn_camera_def camera = vn_camera_def_default();
    assert_refused(&camera, false, "canvas.view");
    camera.fov = 151;
    assert_refused(&camera, true, "camera.fov = 151");
    camera = from_the_front();
    assert_refused(&camera, false, "parallel");
    camera.fov = 30;
    camera.fog = 0.5;
    assert_refused(&camera, false, "camera.fog");
    set_point(camera.up, 0, 0, 2);
    camera.to[0] = camera.to[1] = camera.to[2] = 0;
    assert_refused(&camera, true, "camera.up");
    set_point(camera.up, 0, 0, 0);
    assert_refused(&camera, true, "camera.up");
    set_point(camera.from, 0, 0, 0);
    set_point(camera.up, 0, 1, 0);
    assert_refused(&camera, true, "must be elsewhere");
    set_point(camera.from, INFINITY, 0, 0);
    assert_refused(&camera, true, "camera.from");
    set_point(camera.from, 0, NAN, 0);
    assert_refused(&camera, true, "camera.from");
}

static void a_view_without_extent_is_refused(void **state) {
    (void)state;
    vn_camera_def camera = vn_camera_def_default();
    vn_canvas_def def = vn_canvas_def_default();
    vn_canvas *canvas = NULL;
    def.camera = &camera;
    def.view = (vn_box){{0, 0, 0}, {1, 1, -1}};
    assert_int_equal(vn_canvas_create(&canvas, &def), VN_INVALID);
    assert_message("in z");
    def.view = (vn_box){{0, 0, 0}, {1, INFINITY, 1}};
    assert_int_equal(vn_canvas_create(&canvas, &def), VN_INVALID);
    def.view = (vn_box){{0, 0, 0}, {0, 1e-320, 0}};
    assert_int_equal(vn_canvas_create(&canvas, &def), VN_INVALID);
}

static char *bytes_of(const vn_canvas *canvas, const char *path, size_t *size) {
    assert_ok(vn_canvas_save(canvas, path, "{\"seed\": 1}"));
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

static void without_a_camera_depth_is_not_looked_at(void **state) {
    (void)state;
    vn_network *solid = random_tree(50, 3), *flat = empty_network(2);
    vn_murray_def law = vn_murray_def_default();
    law.tip_radius = 0.5;
    assert_ok(vn_network_murray(flat, &law));
    const double *x = vn_network_x(solid), *y = vn_network_y(solid);
    root_at(flat, x[0], y[0], 0);
    for (int32_t i = 1; i < 50; i++) {
        child_at(flat, vn_network_parent(solid)[i], x[i], y[i], 0);
    }
    char *bytes[2];
    size_t sizes[2];
    for (int i = 0; i < 2; i++) {
        vn_canvas *canvas = canvas_with(NULL, "none");
        stroke(canvas, i == 0 ? solid : flat, "black", 0);
        bytes[i] = bytes_of(canvas, "test_camera.svg", &sizes[i]);
        vn_canvas_destroy(canvas);
    }
    assert_int_equal(sizes[0], sizes[1]);
    assert_memory_equal(bytes[0], bytes[1], sizes[0]);
    free(bytes[0]);
    free(bytes[1]);
    vn_network_destroy(flat);
    vn_network_destroy(solid);
}

// ---- What is before what ----

static void assert_crossing(double z, bool blue_first) {
    const double left[3] = {-80, 0, 0}, right[3] = {80, 0, 0}, low[3] = {0, -80, z}, high[3] = {0, 80, z};
    vn_camera_def camera = from_the_front();
    vn_canvas *canvas = canvas_with(&camera, "none");
    if (blue_first) {
        stroke_edge(canvas, "blue", 10, low, high);
    }
    stroke_edge(canvas, "red", 10, left, right);
    if (!blue_first) {
        stroke_edge(canvas, "blue", 10, low, high);
    }
    assert_int_equal(canvas->items.count, 1);
    picture made = take_picture(canvas);
    assert_true(z > 0 ? is_blue(pixel(&made, 0, 0)) : is_red(pixel(&made, 0, 0)));
    assert_true(is_red(pixel(&made, 40, 0)));
    assert_true(is_blue(pixel(&made, 0, 40)));
    free(made.rgba);
    vn_canvas_destroy(canvas);
}

static void of_two_that_cross_the_nearer_is_seen(void **state) {
    (void)state;
    for (int i = 0; i < 4; i++) {
        assert_crossing(i & 1 ? 12 : -12, i & 2);
    }
}

// One edge comes nearer all the way; what crosses it is before it at one end and behind it at the other.
static void a_long_edge_passes_behind_one_and_before_another(void **state) {
    (void)state;
    const double far[3] = {-90, 0, -90}, near[3] = {90, 0, 90};
    vn_camera_def camera = from_the_front();
    vn_canvas *canvas = canvas_with(&camera, "none");
    stroke_edge(canvas, "red", 4, far, near);
    for (int x = -80; x <= 80; x += 20) {
        const double low[3] = {x, -50, x < 0 ? x + 12 : x - 12}, high[3] = {x, 50, x < 0 ? x + 12 : x - 12};
        stroke_edge(canvas, "blue", 4, low, high);
    }
    picture made = take_picture(canvas);
    for (int x = -80; x <= 80; x += 20) {
        assert_true(x < 0 ? is_blue(pixel(&made, x, 0)) : is_red(pixel(&made, x, 0)));
    }
    free(made.rgba);
    vn_canvas_destroy(canvas);
}

// Slanted tubes in all directions against a z-buffer: where the axes' depths differ clearly, the nearer tube
// is seen.
static void random_crossings_show_the_nearer(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(11);
    vn_camera_def camera = from_the_front();
    for (int round = 0; round < 60; round++) {
        double angle = vn_rng_uniform(&rng, 0.4, 2.7), rise = vn_rng_uniform(&rng, -80, 80);
        double other = vn_rng_uniform(&rng, -80, 80), gap = vn_rng_uniform(&rng, 16, 40);
        const double a[3] = {-80, 0, -rise}, b[3] = {80, 0, rise};
        const double c[3] = {-80 * cos(angle), -80 * sin(angle), gap - other};
        const double d[3] = {80 * cos(angle), 80 * sin(angle), gap + other};
        vn_canvas *canvas = canvas_with(&camera, "none");
        stroke_edge(canvas, "blue", 8, c, d);
        stroke_edge(canvas, "red", 8, a, b);
        picture made = take_picture(canvas);
        assert_true(is_blue(pixel(&made, 0, 0)));
        free(made.rgba);
        vn_canvas_destroy(canvas);
    }
}

static void balls_and_tubes_are_sorted_together(void **state) {
    (void)state;
    const double left[3] = {-80, 0, 0}, right[3] = {80, 0, 0};
    const double x[] = {-40, 40}, y[] = {0, 0}, z[] = {-20, 20};
    vn_camera_def camera = from_the_front();
    vn_dots_def dots = vn_dots_def_default();
    vn_canvas *canvas = canvas_with(&camera, "none");
    dots.color = "blue";
    dots.radius = 5;
    stroke_edge(canvas, "red", 4, left, right);
    assert_ok(vn_canvas_dots(canvas, x, y, z, 2, &dots));
    picture made = take_picture(canvas);
    assert_true(is_red(pixel(&made, -40, 0)));
    assert_true(is_blue(pixel(&made, -40, 4)));
    assert_true(is_blue(pixel(&made, 40, 0)));
    free(made.rgba);
    vn_canvas_destroy(canvas);
}

static void what_is_half_transparent_is_a_film_of_its_own(void **state) {
    (void)state;
    const double left[3] = {-80, 0, 50}, right[3] = {80, 0, 50}, low[3] = {0, -80, 0}, high[3] = {0, 80, 0};
    vn_camera_def camera = from_the_front();
    vn_canvas *canvas = canvas_with(&camera, "none");
    stroke_edge(canvas, "red", 10, left, right);
    stroke_edge(canvas, "#0000ff80", 10, low, high);
    assert_int_equal(canvas->items.count, 2);
    picture made = take_picture(canvas);
    assert_in_range(pixel(&made, 0, 40)[3], 126, 130);
    assert_true(pixel(&made, 0, 0)[2] > 80 && pixel(&made, 0, 0)[0] > 80);
    free(made.rgba);
    vn_canvas_destroy(canvas);
}

// ---- What it looks like ----

static void a_tube_covers_its_width_and_has_round_ends(void **state) {
    (void)state;
    vn_camera_def camera = from_the_front();
    const double slopes[] = {0, 30, -60};
    for (int i = 0; i < 3; i++) {
        const double a[3] = {-50, 20, -slopes[i]}, b[3] = {50, 20, slopes[i]};
        vn_canvas *canvas = canvas_with(&camera, "none");
        stroke_edge(canvas, "red", 12, a, b);
        assert_near(covered(canvas), 100 * 12 + pi * 36, 8);
        vn_canvas_destroy(canvas);
    }
}

static void a_bent_tube_leaves_no_gap_and_no_blob(void **state) {
    (void)state;
    vn_camera_def camera = from_the_front();
    vn_network *network = empty_network(3);
    int32_t bend = child_at(network, root_at(network, -50, 0, 0), 0, 0, 0);
    child_at(network, bend, 0, 50, 0);
    vn_canvas *canvas = canvas_with(&camera, "none");
    stroke(canvas, network, "red", 12);
    // two arms without the square that they share, a quarter disc outside the bend, and two round ends
    assert_near(covered(canvas), 2 * 50 * 12 - 36 + pi * 9 + pi * 36, 8);
    vn_canvas_destroy(canvas);
    vn_network_destroy(network);
}

static void nearer_is_wider(void **state) {
    (void)state;
    const double a[3] = {-30, 0, -60}, b[3] = {30, 0, 60};
    vn_camera_def camera = vn_camera_def_default();
    set_point(camera.from, 0, 0, 200);
    vn_canvas *canvas = canvas_with(&camera, "none");
    stroke_edge(canvas, "red", 10, a, b);
    int least = 1 << 30, most = 0;
    for (int32_t i = 0; i < canvas->marks.count; i++) {
        const vn_mark *mark = &canvas->marks.data[i];
        if (mark->kind == VN_MARK_TUBE) {
            least = (int)fmin(least, 1000 * (double)mark->radius[0]);
            most = (int)fmax(most, 1000 * (double)mark->radius[1]);
        }
    }
    double scale = vn_canvas_scale(canvas);
    assert_near(least / 1000.0, 5 * scale * 200 / 260, 0.002);
    assert_near(most / 1000.0, 5 * scale * 200 / 140, 0.002);
    vn_canvas_destroy(canvas);
}

static int light_of(const unsigned char *rgba) {
    return rgba[0] + rgba[1] + rgba[2];
}

static void a_tube_is_shaded_across_its_width(void **state) {
    (void)state;
    const double a[3] = {-80, 0, 0}, b[3] = {80, 0, 0};
    vn_camera_def camera = from_the_front();
    vn_canvas *canvas = canvas_with(&camera, "none");
    stroke_edge(canvas, "#c04030", 40, a, b);
    picture made = take_picture(canvas);
    int brightest = -20;
    for (int y = -18; y < 18; y++) {
        for (int x = -60; x < 60; x += 7) { // and the same along it, without seams
            assert_int_equal(light_of(pixel(&made, x, y)), light_of(pixel(&made, 0, y)));
        }
        if (light_of(pixel(&made, 0, y)) > light_of(pixel(&made, 0, brightest))) {
            brightest = y;
        }
    }
    assert_in_range(brightest, 1, 15); // from above
    assert_true(light_of(pixel(&made, 0, -18)) < light_of(pixel(&made, 0, 17)));
    assert_true(light_of(pixel(&made, 0, 17)) < light_of(pixel(&made, 0, brightest)));
    free(made.rgba);
    vn_canvas_destroy(canvas);
}

// Edges shorter than they are thick, at a slant, that become thinner and turn a little at each node: the
// balls at the nodes must not show on what follows.
static void no_ball_shows_within_a_thick_vein(void **state) {
    (void)state;
    vn_camera_def camera = from_the_front();
    for (int away = -1; away <= 1; away += 2) {
        vn_network *network = empty_network(3);
        double widths[15];
        int32_t node = root_at(network, 0, 70, 0);
        for (int i = 0; i < 15; i++) {
            widths[i] = 60 - 2 * i;
        }
        for (int i = 1; i < 15; i++) {
            node = child_at(network, node, 0.3 * (i % 2), 70 - 8 * i, away * (6 * i + 0.3 * (i % 2)));
        }
        vn_stroke_def def = vn_stroke_def_default();
        def.color = "#c04030";
        def.widths = widths;
        vn_canvas *canvas = canvas_with(&camera, "none");
        assert_ok(vn_canvas_stroke(canvas, network, &def));
        picture made = take_picture(canvas);
        for (int y = 66; y > -36; y--) {
            int step = light_of(pixel(&made, 0, y)) - light_of(pixel(&made, 0, y - 1));
            assert_in_range(step + 70, 0, 140); // bands shine a little, a ball would by more
        }
        free(made.rgba);
        vn_canvas_destroy(canvas);
        vn_network_destroy(network);
    }
}

static void fog_fades_what_is_far_into_the_background(void **state) {
    (void)state;
    const double x[] = {-50, 50}, y[] = {0, 0}, z[] = {-100, 100};
    vn_camera_def camera = from_the_front();
    vn_dots_def dots = vn_dots_def_default();
    camera.fog = 0.75;
    dots.color = "black";
    vn_canvas *canvas = canvas_with(&camera, "#ffffff");
    assert_ok(vn_canvas_dots(canvas, x, y, z, 2, &dots));
    picture made = take_picture(canvas);
    assert_in_range(pixel(&made, -50, 0)[0], 189, 193);
    assert_in_range(pixel(&made, 50, 0)[0], 0, 2);
    free(made.rgba);
    vn_canvas_destroy(canvas);
}

static void nothing_behind_the_eye_is_drawn(void **state) {
    (void)state;
    const double x[] = {0}, y[] = {0}, z[] = {80}, behind[3] = {0, 0, 90}, farther[3] = {5, 5, 300};
    const double before[3] = {0, 3, -40};
    vn_camera_def camera = vn_camera_def_default();
    vn_dots_def dots = vn_dots_def_default();
    vn_text_def text = vn_text_def_default();
    set_point(camera.from, 0, 0, 60);
    vn_canvas *canvas = canvas_with(&camera, "none");
    assert_ok(vn_canvas_dots(canvas, x, y, z, 1, &dots));
    stroke_edge(canvas, "red", 4, behind, farther);
    memcpy(text.at, behind, sizeof text.at);
    assert_ok(vn_canvas_text(canvas, "behind", &text));
    assert_near(covered(canvas), 0, 0);
    stroke_edge(canvas, "red", 4, before, farther); // through the eye's plane
    assert_true(covered(canvas) > 10);
    vn_canvas_destroy(canvas);
}

static void a_solid_domain_is_a_shaded_film(void **state) {
    (void)state;
    vn_camera_def camera = from_the_front();
    vn_canvas *canvas = canvas_with(&camera, "none");
    vn_disk_def ball = {{0, 0, 0}, 60};
    vn_fill_def fill = vn_fill_def_default();
    vn_domain *domain;
    fill.opacity = 0.5;
    assert_ok(vn_domain_sphere(&domain, &ball));
    assert_ok(vn_canvas_fill(canvas, domain, &fill));
    assert_near(covered(canvas), 0.5 * pi * 3600, 0.02 * pi * 3600);
    picture made = take_picture(canvas);
    for (int x = -40; x < 40; x++) {
        assert_in_range(pixel(&made, x, x / 2)[3], 126, 129); // no seams
    }
    free(made.rgba);
    vn_domain_release(domain);
    vn_canvas_destroy(canvas);
}

// The volume that triangles enclose, if they all look outwards; of any orientation: their area.
static double area_of(const vn_triangles *from) {
    double sum = 0;
    for (int32_t i = 0; i < from->corners.count; i += 3) {
        const double *p[3];
        double u[3], v[3], n[3];
        for (int k = 0; k < 3; k++) {
            assert_in_range(from->corners.data[i + k], 0, from->xyz.count / 3 - 1);
            p[k] = from->xyz.data + 3 * (size_t)from->corners.data[i + k];
        }
        for (int k = 0; k < 3; k++) {
            u[k] = p[1][k] - p[0][k];
            v[k] = p[2][k] - p[0][k];
        }
        cross(n, u, v);
        sum += 0.5 * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    }
    return sum;
}

static void balls_boxes_and_meshes_have_triangles(void **state) {
    (void)state;
    vn_disk_def ball = {{1, 2, 3}, 2};
    vn_box_def box = {{0, 0, 0}, {1, 2, 3}, 3};
    const double xyz[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const int32_t corners[] = {0, 1, 2, 0, 1, 3};
    vn_domain *domains[4];
    const double areas[] = {4 * pi * 4, 22, 1};
    assert_ok(vn_domain_sphere(&domains[0], &ball));
    assert_ok(vn_domain_box(&domains[1], &box));
    assert_ok(vn_domain_surface(&domains[2], xyz, 4, corners, 2));
    assert_ok(vn_domain_combine(&domains[3], domains[0], domains[1], VN_UNION));
    for (int i = 0; i < 4; i++) {
        vn_triangles got = {0};
        assert_int_equal(vn_domain_triangles(domains[i], &got), i < 3 ? VN_OK : VN_INVALID);
        assert_near(area_of(&got), i < 3 ? areas[i] : 0, i < 3 ? 2e-3 * areas[i] : 0);
        vn_triangles_free(&got);
        vn_domain_release(domains[i]);
    }
    assert_message("no surface of triangles");
}

static void without_a_camera_a_solid_domain_is_refused(void **state) {
    (void)state;
    vn_canvas *canvas = canvas_with(NULL, "none");
    vn_disk_def ball = {{0, 0, 0}, 60};
    vn_fill_def fill = vn_fill_def_default();
    vn_domain *domain;
    assert_ok(vn_domain_sphere(&domain, &ball));
    assert_int_equal(vn_canvas_fill(canvas, domain, &fill), VN_INVALID);
    assert_message("camera");
    assert_int_equal(canvas->items.count, 0);
    vn_domain_release(domain);
    vn_canvas_destroy(canvas);
}

// ---- Colours that tell something ----

static void edges_have_colours_of_their_own(void **state) {
    (void)state;
    vn_camera_def camera = from_the_front();
    for (int i = 0; i < 2; i++) {
        vn_network *network = empty_network(3);
        const uint32_t colors[] = {0, 0xFF0000, 0x0000FF};
        int32_t middle = child_at(network, root_at(network, -80, 0, 0), 0, 0, 0);
        child_at(network, middle, 80, 0, 0);
        vn_stroke_def def = vn_stroke_def_default();
        def.width = 10;
        def.colors = colors;
        vn_canvas *canvas = canvas_with(i == 0 ? &camera : NULL, "none");
        assert_ok(vn_canvas_stroke(canvas, network, &def));
        picture made = take_picture(canvas);
        assert_true(is_red(pixel(&made, -40, 0)));
        assert_true(is_blue(pixel(&made, 40, 0)));
        free(made.rgba);
        size_t size;
        char *svg = bytes_of(canvas, "test_camera.svg", &size);
        assert_true(i == 0 || (strstr(svg, "\"#ff0000\"") != NULL && strstr(svg, "\"#0000ff\"") != NULL));
        free(svg);
        vn_canvas_destroy(canvas);
        vn_network_destroy(network);
    }
}

static void a_ramp_goes_evenly_from_the_least_to_the_greatest(void **state) {
    (void)state;
    const double values[] = {-1, 0, 1, 3, NAN, INFINITY};
    const vn_color other = {1, 2, 3, 255};
    vn_rgb_array got = {0};
    assert_ok(vn_ramp_colors(&got, values, 6, "#000000  #640000, #64c800", other));
    const uint32_t expected[] = {0x000000, 0x320000, 0x640000, 0x64c800, 0x010203, 0x010203};
    assert_int_equal(got.count, 6);
    assert_memory_equal(got.data, expected, sizeof expected);
    assert_ok(vn_ramp_colors(&got, values, 1, "red blue", other));
    assert_int_equal(got.data[0], 0xFF0000);
    assert_int_equal(vn_ramp_colors(&got, values, 6, "red", other), VN_INVALID);
    assert_message("two or more");
    assert_int_equal(vn_ramp_colors(&got, values, 6, "red none", other), VN_INVALID);
    assert_int_equal(vn_ramp_colors(&got, values, 6, "red rosso", other), VN_INVALID);
    vn_array_free(&got);
}

static void columns_are_values_of_the_edges(void **state) {
    (void)state;
    vn_network *network = random_tree(20, 3);
    vn_values got = {0};
    const char *known[] = {"radius", "tree", "birth"}, *unknown[] = {"order", "flow", "pressure", "colour"};
    for (int i = 0; i < 3; i++) {
        assert_ok(vn_column_values(&got, network, known[i]));
        assert_int_equal(got.count, 20);
        assert_true(isnan(got.data[0]) && isfinite(got.data[1]));
    }
    for (int i = 0; i < 4; i++) {
        assert_int_equal(vn_column_values(&got, network, unknown[i]), VN_INVALID);
    }
    assert_ok(vn_network_set_orders(network, VN_STRAHLER));
    assert_ok(vn_column_values(&got, network, "order"));
    assert_near(got.data[5], vn_network_orders(network)[5], 0);
    vn_array_free(&got);
    vn_network_destroy(network);
}

// ---- Files ----

// Some of everything.
static vn_status draw_all(vn_canvas *canvas, const vn_network *network) {
    vn_stroke_def stroke_def = vn_stroke_def_default();
    vn_dots_def dots = vn_dots_def_default();
    vn_fill_def fill = vn_fill_def_default();
    vn_text_def text = vn_text_def_default();
    vn_line_def line = vn_line_def_default();
    const double x[] = {20, 40}, y[] = {30, 50}, z[] = {3, -50};
    vn_disk_def disk = {{0, 0, 0}, 70};
    vn_domain *ball = NULL;
    stroke_def.column = "radius";
    fill.opacity = 0.2;
    text.angle = 30;
    line.fill = "teal";
    VN_TRY(vn_domain_sphere(&ball, &disk));
    vn_status status = vn_canvas_fill(canvas, ball, &fill);
    vn_domain_release(ball);
    VN_TRY(status);
    VN_TRY(vn_canvas_stroke(canvas, network, &stroke_def));
    VN_TRY(vn_canvas_dots(canvas, x, y, z, 2, &dots));
    VN_TRY(vn_canvas_line(canvas, x, y, z, 2, &line));
    return vn_canvas_text(canvas, "fig. 1", &text);
}

static vn_status draw_and_save(const vn_network *network, const char *path) {
    vn_canvas_def def = vn_canvas_def_default();
    vn_camera_def camera = vn_camera_def_default();
    vn_canvas *canvas;
    camera.fog = 0.4;
    def.width = def.height = 60;
    def.view = (vn_box){{-100, -100, -100}, {100, 100, 100}};
    def.camera = &camera;
    VN_TRY(vn_canvas_create(&canvas, &def));
    vn_status status = draw_all(canvas, network);
    if (status == VN_OK) {
        status = vn_canvas_save(canvas, path, "{\"seed\": 1}");
    }
    vn_canvas_destroy(canvas);
    return status;
}

static const char *const paths[] = {"test_camera.png", "test_camera.svg", "test_camera.pdf",
                                    "test_camera.eps"};

static char *read_file(const char *path, size_t *size) {
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

static void the_same_picture_is_the_same_bytes_at_any_thread_count(void **state) {
    (void)state;
    vn_network *network = random_tree(300, 3);
    for (int i = 0; i < 4; i++) {
        size_t size, again;
        vn_set_threads(1);
        assert_ok(draw_and_save(network, paths[i]));
        char *first = read_file(paths[i], &size);
        vn_set_threads(2);
        assert_ok(draw_and_save(network, paths[i]));
        char *second = read_file(paths[i], &again);
        assert_int_equal(size, again);
        assert_memory_equal(first, second, size);
        free(first);
        free(second);
    }
    vn_set_threads(0);
    vn_network_destroy(network);
}

static void an_svg_of_a_scene_is_well_formed(void **state) {
    (void)state;
    vn_network *network = random_tree(300, 3);
    assert_ok(draw_and_save(network, "test_camera.svg"));
    xmlDoc *doc = xmlReadFile("test_camera.svg", NULL, XML_PARSE_NONET);
    assert_non_null(doc);
    int scenes = 0, paths_in_scenes = 0;
    for (xmlNode *node = xmlDocGetRootElement(doc)->children; node != NULL; node = node->next) {
        bool scene = node->type == XML_ELEMENT_NODE && strcmp((const char *)node->name, "g") == 0;
        scenes += scene;
        paths_in_scenes += scene ? (int)xmlChildElementCount(node) : 0;
    }
    assert_int_equal(scenes, 2); // the film of the ball; veins and dots together
    assert_true(paths_in_scenes > 600);
    xmlFreeDoc(doc);
    remove("test_camera.svg");
    vn_network_destroy(network);
}

static void an_svg_of_8000_segments_is_below_10_megabytes(void **state) {
    (void)state;
    vn_network *network = grown_tree(8001);
    vn_camera_def camera = vn_camera_def_default();
    vn_canvas_def def = vn_canvas_def_default();
    vn_canvas *canvas;
    size_t size;
    def.width = def.height = 800;
    def.view = (vn_box){{-100, -100, -100}, {100, 100, 100}};
    def.camera = &camera;
    assert_ok(vn_canvas_create(&canvas, &def));
    stroke(canvas, network, "red", 1);
    free(bytes_of(canvas, "test_camera.svg", &size));
    print_message("8,000 segments: %zu bytes of SVG\n", size);
    assert_in_range(size, 1000000, 10000000);
    vn_canvas_destroy(canvas);
    vn_network_destroy(network);
}

static void assert_eps_page(const char *unit, double width, const char *box) {
    vn_canvas_def def = vn_canvas_def_default();
    vn_dots_def dots = vn_dots_def_default();
    const double x[] = {5}, y[] = {5};
    vn_canvas *canvas;
    size_t size;
    def.width = width;
    def.view = (vn_box){{0, 0, 0}, {100, 50, 0}};
    def.margin = 0;
    def.unit = unit;
    assert_ok(vn_canvas_create(&canvas, &def));
    assert_ok(vn_canvas_dots(canvas, x, y, NULL, 1, &dots));
    assert_ok(vn_canvas_save(canvas, "test_camera.eps", "{\"name\": \"blä\xF0\x9F\x8C\xBF\"}"));
    char *eps = read_file("test_camera.eps", &size);
    assert_int_equal(strncmp(eps, "%!PS-Adobe-3.0 EPSF-3.0\n", 24), 0);
    assert_non_null(strstr(eps, box));
    assert_null(strstr(eps, "CreationDate"));
    assert_non_null(strstr(eps, "\n%Venule: {\"name\": \"bl\\u00e4\\ud83c\\udf3f\"}\n"));
    assert_non_null(strstr(eps, "%%EOF"));
    for (size_t i = 0; i < size; i++) {
        assert_true((unsigned char)eps[i] < 0x80);
    }
    free(eps);
    vn_canvas_destroy(canvas);
}

static void an_eps_page_has_the_size_of_the_canvas_and_no_date(void **state) {
    (void)state;
    assert_eps_page("", 400, "\n%%BoundingBox: 0 0 300 150\n%%HiResBoundingBox: 0 0 300 150\n");
    assert_eps_page("mm", 400, "\n%%BoundingBox: 0 0 284 142\n%%HiResBoundingBox: 0 0 283.4646 141.7323\n");
}

static void a_line_is_one_stroke_and_with_an_inside_a_fill(void **state) {
    (void)state;
    const double x[] = {10, 60, 60, 10}, y[] = {10, 10, 40, 40};
    vn_canvas_def def = vn_canvas_def_default();
    vn_line_def line = vn_line_def_default();
    vn_canvas *canvas;
    def.width = def.height = 100;
    assert_ok(vn_canvas_create(&canvas, &def));
    line.width = 2;
    assert_ok(vn_canvas_line(canvas, x, y, NULL, 2, &line));
    assert_near(covered(canvas), 50 * 2 + pi, 0.5);
    line.fill = "red";
    line.color = "none";
    assert_ok(vn_canvas_line(canvas, x, y, NULL, 4, &line));
    assert_near(covered(canvas), 50 * 30 + 50 + 0.5 * pi + 2, 1);
    assert_int_equal(vn_canvas_line(canvas, x, y, NULL, 1, &line), VN_INVALID);
    assert_message("two or more");
    assert_int_equal(canvas->items.count, 2);
    vn_canvas_destroy(canvas);
}

static void text_is_as_wide_as_it_is_told(void **state) {
    (void)state;
    double once, twice;
    assert_ok(vn_text_width(&once, "venule", 20));
    assert_ok(vn_text_width(&twice, "venulevenule", 40));
    assert_true(once > 40 && once < 100);
    assert_near(twice, 4 * once, 0.5);
    assert_ok(vn_text_width(&once, "", 20));
    assert_near(once, 0, 0);
}

static void any_refused_allocation_is_a_status_and_leaks_nothing(void **state) {
    (void)state;
    vn_network *network = random_tree(40, 3);
    const int32_t *order;
    assert_ok(vn_network_order(network, &order));
    for (int i = 0; i < 4; i++) {
        size_t before = vn_byte_count();
        vn_status status = VN_NO_MEMORY;
        for (int64_t nth = 0; status != VN_OK; nth++) {
            assert_true(nth < 1000);
            vn_fail_allocations_from(nth);
            status = draw_and_save(network, paths[i]);
            vn_fail_allocations_from(-1);
            assert_true(status == VN_OK || status == VN_NO_MEMORY);
            assert_int_equal(vn_byte_count(), before);
        }
        remove(paths[i]);
    }
    vn_network_destroy(network);
}

static void an_empty_network_is_an_empty_scene(void **state) {
    (void)state;
    vn_camera_def camera = from_the_front();
    vn_canvas *canvas = canvas_with(&camera, "none");
    vn_network *network = empty_network(3);
    stroke(canvas, network, "red", 1);
    root_at(network, 0, 0, 0);
    stroke(canvas, network, "red", 1);
    child_at(network, 0, 0, 0, 0); // no length
    stroke(canvas, network, "red", 4);
    assert_near(covered(canvas), pi * 4, 3);
    vn_network_destroy(network);
    vn_canvas_destroy(canvas);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_point_lies_where_the_matrices_say),
        cmocka_unit_test(a_parallel_camera_from_the_front_is_the_flat_canvas),
        cmocka_unit_test(the_default_camera_shows_the_whole_view_and_no_more),
        cmocka_unit_test(up_is_up),
        cmocka_unit_test(from_right_above_what_is_behind_is_up),
        cmocka_unit_test(a_wrong_camera_is_refused),
        cmocka_unit_test(a_view_without_extent_is_refused),
        cmocka_unit_test(without_a_camera_depth_is_not_looked_at),
        cmocka_unit_test(of_two_that_cross_the_nearer_is_seen),
        cmocka_unit_test(a_long_edge_passes_behind_one_and_before_another),
        cmocka_unit_test(random_crossings_show_the_nearer),
        cmocka_unit_test(balls_and_tubes_are_sorted_together),
        cmocka_unit_test(what_is_half_transparent_is_a_film_of_its_own),
        cmocka_unit_test(a_tube_covers_its_width_and_has_round_ends),
        cmocka_unit_test(a_bent_tube_leaves_no_gap_and_no_blob),
        cmocka_unit_test(nearer_is_wider),
        cmocka_unit_test(a_tube_is_shaded_across_its_width),
        cmocka_unit_test(no_ball_shows_within_a_thick_vein),
        cmocka_unit_test(fog_fades_what_is_far_into_the_background),
        cmocka_unit_test(nothing_behind_the_eye_is_drawn),
        cmocka_unit_test(a_solid_domain_is_a_shaded_film),
        cmocka_unit_test(balls_boxes_and_meshes_have_triangles),
        cmocka_unit_test(without_a_camera_a_solid_domain_is_refused),
        cmocka_unit_test(edges_have_colours_of_their_own),
        cmocka_unit_test(a_ramp_goes_evenly_from_the_least_to_the_greatest),
        cmocka_unit_test(columns_are_values_of_the_edges),
        cmocka_unit_test(the_same_picture_is_the_same_bytes_at_any_thread_count),
        cmocka_unit_test(an_svg_of_a_scene_is_well_formed),
        cmocka_unit_test(an_svg_of_8000_segments_is_below_10_megabytes),
        cmocka_unit_test(an_eps_page_has_the_size_of_the_canvas_and_no_date),
        cmocka_unit_test(a_line_is_one_stroke_and_with_an_inside_a_fill),
        cmocka_unit_test(text_is_as_wide_as_it_is_told),
        cmocka_unit_test(any_refused_allocation_is_a_status_and_leaks_nothing),
        cmocka_unit_test(an_empty_network_is_an_empty_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
