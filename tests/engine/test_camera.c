// Space through a camera: places against matrices, depth and shades in pixels read back.
#include "domain/domain.h"
#include "scenes.h"

static const double pi = 3.141592653589793;

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

static void without_a_camera_depth_is_not_looked_at(void **state) {
    (void)state;
    vn_network *solid = tangled_tree(50, 3), *flat = network_of(2);
    vn_murray_def law = vn_murray_def_default();
    law.tip_radius = 0.5;
    assert_ok(vn_network_murray(flat, &law));
    const double *x = vn_network_x(solid), *y = vn_network_y(solid);
    put_root(flat, x[0], y[0], 0);
    for (int32_t i = 1; i < 50; i++) {
        put_child(flat, vn_network_parent(solid)[i], x[i], y[i], 0);
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
    vn_network *network = network_of(3);
    int32_t bend = put_child(network, put_root(network, -50, 0, 0), 0, 0, 0);
    put_child(network, bend, 0, 50, 0);
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
        vn_network *network = network_of(3);
        double widths[15];
        int32_t node = put_root(network, 0, 70, 0);
        for (int i = 0; i < 15; i++) {
            widths[i] = 60 - 2 * i;
        }
        for (int i = 1; i < 15; i++) {
            node = put_child(network, node, 0.3 * (i % 2), 70 - 8 * i, away * (6 * i + 0.3 * (i % 2)));
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
    vn_fill_def fill = vn_fill_def_default();
    fill.opacity = 0.5;
    vn_domain *domain = ball_of(0, 0, 0, 60);
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
    vn_fill_def fill = vn_fill_def_default();
    vn_domain *domain = ball_of(0, 0, 0, 60);
    assert_int_equal(vn_canvas_fill(canvas, domain, &fill), VN_INVALID);
    assert_message("camera");
    assert_int_equal(canvas->items.count, 0);
    vn_domain_release(domain);
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
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
