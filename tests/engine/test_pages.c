// Pictures of space as files: colours that tell something, lines and texts, well-formed and always the same
// bytes.
#include "draw/ramp.h"
#include "scenes.h"

#include <libxml/parser.h>
#include <libxml/tree.h>

static const double pi = 3.141592653589793;

// ---- Colours that tell something ----

static void edges_have_colours_of_their_own(void **state) {
    (void)state;
    vn_camera_def camera = from_the_front();
    for (int i = 0; i < 2; i++) {
        vn_network *network = network_of(3);
        const uint32_t colors[] = {0, 0xFF0000, 0x0000FF};
        int32_t middle = put_child(network, put_root(network, -80, 0, 0), 0, 0, 0);
        put_child(network, middle, 80, 0, 0);
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
    vn_network *network = tangled_tree(20, 3);
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

static void the_same_picture_is_the_same_bytes_at_any_thread_count(void **state) {
    (void)state;
    vn_network *network = tangled_tree(300, 3);
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
    vn_network *network = tangled_tree(300, 3);
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
    vn_network *network = tangled_tree(40, 3);
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
    vn_network *network = network_of(3);
    stroke(canvas, network, "red", 1);
    put_root(network, 0, 0, 0);
    stroke(canvas, network, "red", 1);
    put_child(network, 0, 0, 0, 0); // no length
    stroke(canvas, network, "red", 4);
    assert_near(covered(canvas), pi * 4, 3);
    vn_network_destroy(network);
    vn_canvas_destroy(canvas);
}

int main(void) {
    const struct CMUnitTest tests[] = {
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
