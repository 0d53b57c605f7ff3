// Pictures: what is painted is measured in pixels read back from the files, and in the markup of the SVG.
#include "draw/canvas.h"

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

static vn_canvas *canvas_of(double width, double height) {
    vn_canvas_def def = vn_canvas_def_default();
    vn_canvas *canvas = NULL;
    def.width = width;
    def.height = height;
    assert_ok(vn_canvas_create(&canvas, &def));
    return canvas;
}

static vn_network *empty_network(void) {
    vn_network_def def = vn_network_def_default();
    vn_network *network = NULL;
    assert_ok(vn_network_create(&network, &def));
    return network;
}

static int32_t root_at(vn_network *network, double x, double y) {
    int32_t node = -1;
    double p[3] = {x, y, 0};
    assert_ok(vn_network_root(network, p, &node));
    return node;
}

static int32_t child_at(vn_network *network, int32_t parent, double x, double y) {
    int32_t node = -1;
    double p[3] = {x, y, 0};
    assert_ok(vn_network_add(network, parent, p, &node));
    return node;
}

// 0-1-2 straight, where 3 and 4 leave; 5 goes on from 3; a join from 4 to 5.
static vn_network *forked_network(void) {
    vn_network *network = empty_network();
    vn_murray_def law = vn_murray_def_default();
    assert_ok(vn_network_murray(network, &law));
    int32_t node = child_at(network, root_at(network, 100, 20), 100, 50);
    int32_t fork = child_at(network, node, 100, 80);
    int32_t left = child_at(network, fork, 80, 120);
    int32_t right = child_at(network, fork, 130, 120);
    int32_t tip = child_at(network, left, 70, 160);
    assert_ok(vn_network_join(network, right, tip, 0.5));
    return network;
}

static vn_network *random_tree(int32_t nodes) {
    vn_network *network = empty_network();
    vn_rng rng = vn_rng_make(7);
    root_at(network, 100, 100);
    for (int32_t i = 1; i < nodes; i++) {
        int32_t parent = (int32_t)vn_rng_integer(&rng, i > 9 ? i - 9 : 0, i - 1);
        child_at(network, parent, vn_rng_uniform(&rng, 10, 190), vn_rng_uniform(&rng, 10, 190));
    }
    return network;
}

typedef struct picture {
    png_image head;
    unsigned char *rgba;
} picture;

static picture read_picture(const char *path) {
    picture made = {.head = {.version = PNG_IMAGE_VERSION}};
    assert_true(png_image_begin_read_from_file(&made.head, path));
    made.head.format = PNG_FORMAT_RGBA;
    made.rgba = malloc(PNG_IMAGE_SIZE(made.head));
    assert_non_null(made.rgba);
    assert_true(png_image_finish_read(&made.head, NULL, made.rgba, 0, NULL));
    return made;
}

static unsigned char alpha_at(const picture *from, int x, int y) {
    return from->rgba[4 * ((size_t)y * from->head.width + (size_t)x) + 3];
}

static picture save_picture(const vn_canvas *canvas) {
    assert_ok(vn_canvas_save(canvas, "test_draw.png", NULL));
    picture made = read_picture("test_draw.png");
    remove("test_draw.png");
    return made;
}

// How many pixels are covered, each by its share.
static double covered(const vn_canvas *canvas) {
    picture from = save_picture(canvas);
    double sum = 0;
    for (size_t i = 0; i < (size_t)from.head.width * from.head.height; i++) {
        sum += from.rgba[4 * i + 3] / 255.0;
    }
    free(from.rgba);
    return sum;
}

static char *read_bytes(const char *path, size_t *size) {
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
    return bytes;
}

static bool exists(const char *path) {
    FILE *file = fopen(path, "rb");
    if (file != NULL) {
        fclose(file);
    }
    return file != NULL;
}

static xmlDocPtr save_svg(const vn_canvas *canvas, const char *manifest) {
    assert_ok(vn_canvas_save(canvas, "test_draw.svg", manifest));
    xmlDocPtr document = xmlReadFile("test_draw.svg", NULL, 0);
    remove("test_draw.svg");
    assert_non_null(document);
    return document;
}

static bool has_attribute(xmlNodePtr node, const char *name, const char *value) {
    xmlChar *text = xmlGetProp(node, (const xmlChar *)name);
    bool same = text != NULL && (value == NULL || strcmp((const char *)text, value) == 0);
    xmlFree(text);
    return same;
}

// Elements called @p name at and below @p node that have the attribute (NULL: any), of that value (NULL:
// any).
static int count_elements(xmlNodePtr node, const char *name, const char *attribute, const char *value) {
    int count = 0;
    for (; node != NULL; node = node->next) {
        bool named = node->type == XML_ELEMENT_NODE && strcmp((const char *)node->name, name) == 0;
        count += named && (attribute == NULL || has_attribute(node, attribute, value));
        count += count_elements(node->children, name, attribute, value);
    }
    return count;
}

static void assert_element_text(xmlNodePtr root, const char *name, const char *expected) {
    for (xmlNodePtr node = root->children; node != NULL; node = node->next) {
        if (node->type == XML_ELEMENT_NODE && strcmp((const char *)node->name, name) == 0) {
            xmlChar *text = xmlNodeGetContent(node);
            assert_string_equal((const char *)text, expected);
            xmlFree(text);
            return;
        }
    }
    fail_msg("no element %s", name);
}

static void every_default_is_within_its_range(void **state) {
    (void)state;
    const vn_schema *schemas[] = {&vn_canvas_schema, &vn_fill_schema, &vn_stroke_schema, &vn_dots_schema,
                                  &vn_text_schema};
    for (size_t i = 0; i < sizeof schemas / sizeof schemas[0]; i++) {
        assert_ok(vn_check_def(schemas[i], schemas[i]->defaults));
        for (int k = 0; k < schemas[i]->count; k++) {
            assert_true(schemas[i]->fields[k].doc[0] != '\0');
        }
    }
}

static void the_view_is_fitted_in_the_middle_with_y_up(void **state) {
    (void)state;
    vn_canvas_def def = vn_canvas_def_default();
    vn_canvas *canvas;
    def.width = def.height = 200;
    def.view = (vn_box){{-10, 5, 0}, {10, 15, 0}};
    assert_ok(vn_canvas_create(&canvas, &def));
    assert_near(vn_canvas_scale(canvas), 9, 1e-12);
    vn_spot low = vn_canvas_place(canvas, -10, 5);
    vn_spot high = vn_canvas_place(canvas, 10, 15);
    assert_near(low.x, 10, 1e-9);
    assert_near(low.y, 145, 1e-9);
    assert_near(high.x, 190, 1e-9);
    assert_near(high.y, 55, 1e-9);
    vn_canvas_destroy(canvas);
}

static void a_side_that_is_not_given_follows_the_view(void **state) {
    (void)state;
    vn_canvas_def def = vn_canvas_def_default();
    vn_canvas *canvas;
    def.view = (vn_box){{0, 0, 0}, {20, 10, 0}};
    assert_ok(vn_canvas_create(&canvas, &def));
    assert_near(vn_canvas_width(canvas), 800, 0);
    assert_near(vn_canvas_height(canvas), 410, 0);
    vn_canvas_destroy(canvas);
    def.height = 120;
    assert_ok(vn_canvas_create(&canvas, &def));
    assert_near(vn_canvas_width(canvas), 220, 0);
    vn_canvas_destroy(canvas);
}

static void a_canvas_without_a_view_begins_at_its_lower_left(void **state) {
    (void)state;
    vn_canvas *canvas = canvas_of(40, 30);
    vn_dots_def def = vn_dots_def_default();
    double x = 5, y = 4;
    assert_ok(vn_canvas_dots(canvas, &x, &y, NULL, 1, &def));
    picture made = save_picture(canvas);
    assert_int_equal(alpha_at(&made, 5, 26), 255);
    assert_int_equal(alpha_at(&made, 5, 4), 0);
    free(made.rgba);
    vn_canvas_destroy(canvas);
}

static void a_filled_disk_covers_its_area(void **state) {
    (void)state;
    vn_canvas *canvas = canvas_of(200, 200);
    vn_disk_def disk = {{100, 100, 0}, 80};
    vn_fill_def def = vn_fill_def_default();
    vn_domain *domain;
    assert_ok(vn_domain_disk(&domain, &disk));
    assert_ok(vn_canvas_fill(canvas, domain, &def));
    assert_near(covered(canvas), pi * 80 * 80, 0.001 * pi * 80 * 80);
    vn_domain_release(domain);
    vn_canvas_destroy(canvas);
}

static void a_ring_with_a_hole_covers_what_is_between(void **state) {
    (void)state;
    const double xy[] = {10, 10, 90, 10, 90, 90, 10, 90, 30, 30, 70, 30, 70, 70, 30, 70};
    const int32_t sizes[] = {4, 4};
    vn_canvas *canvas = canvas_of(100, 100);
    vn_fill_def def = vn_fill_def_default();
    vn_domain *domain;
    assert_ok(vn_domain_polygon(&domain, xy, sizes, 2));
    assert_ok(vn_canvas_fill(canvas, domain, &def));
    assert_near(covered(canvas), 80 * 80 - 40 * 40, 1e-6);
    vn_domain_release(domain);
    vn_canvas_destroy(canvas);
}

static void a_straight_vein_covers_its_length_and_two_half_disks(void **state) {
    (void)state;
    vn_canvas *canvas = canvas_of(200, 60);
    vn_network *network = empty_network();
    vn_stroke_def def = vn_stroke_def_default();
    int32_t middle = child_at(network, root_at(network, 30, 30.3), 90, 30.3);
    child_at(network, middle, 170, 30.3);
    def.width = 14;
    assert_ok(vn_canvas_stroke(canvas, network, &def));
    double area = 14 * 140 + pi * 14 * 14 / 4;
    assert_near(covered(canvas), area, 0.002 * area);
    vn_network_destroy(network);
    vn_canvas_destroy(canvas);
}

static void the_finest_veins_do_not_vanish(void **state) {
    (void)state;
    vn_canvas *canvas = canvas_of(200, 60);
    vn_network *network = empty_network();
    vn_stroke_def def = vn_stroke_def_default();
    const double widths[] = {0, 0};
    child_at(network, root_at(network, 10, 30), 190, 30);
    def.widths = widths;
    def.min_width = 0.5;
    assert_ok(vn_canvas_stroke(canvas, network, &def));
    assert_near(covered(canvas), 90, 8); // the scan converter has 15 lines a pixel
    vn_network_destroy(network);
    vn_canvas_destroy(canvas);
}

static void half_opaque_veins_that_cross_do_not_darken_each_other(void **state) {
    (void)state;
    vn_canvas *canvas = canvas_of(100, 100);
    vn_network *network = empty_network();
    vn_stroke_def def = vn_stroke_def_default();
    int32_t knot = child_at(network, root_at(network, 10, 50), 50, 50);
    child_at(network, knot, 90, 50);
    child_at(network, knot, 50, 90);
    child_at(network, root_at(network, 20, 20), 80, 80);
    def.width = 10;
    def.opacity = 0.5;
    assert_ok(vn_canvas_stroke(canvas, network, &def));
    picture made = save_picture(canvas);
    int most = 0;
    for (int i = 0; i < 100 * 100; i++) {
        most = made.rgba[4 * i + 3] > most ? made.rgba[4 * i + 3] : most;
    }
    assert_in_range(most, 127, 128);
    assert_int_equal(alpha_at(&made, 50, 50), most);
    assert_int_equal(alpha_at(&made, 20, 50), most);
    free(made.rgba);
    vn_network_destroy(network);
    vn_canvas_destroy(canvas);
}

// Two circles with their centres @p d apart.
static double hull_area(double r0, double r1, double d) {
    double turn = acos((r0 - r1) / d);
    return r0 * r0 * (pi - turn) + r1 * r1 * turn + (r0 + r1) * sqrt(d * d - (r0 - r1) * (r0 - r1));
}

static void a_taper_is_the_hull_of_two_circles(void **state) {
    (void)state;
    vn_canvas *canvas = canvas_of(200, 200);
    vn_network *network = empty_network();
    vn_stroke_def def = vn_stroke_def_default();
    const double widths[] = {0, 40, 16};
    int32_t start = child_at(network, root_at(network, 50, 60), 50.001, 60);
    child_at(network, start, 140, 130);
    def.widths = widths;
    assert_ok(vn_canvas_stroke(canvas, network, &def));
    double area = hull_area(20, 8, hypot(140 - 50.001, 70));
    assert_near(covered(canvas), area, 0.004 * area);
    vn_network_destroy(network);
    vn_canvas_destroy(canvas);
}

static void a_taper_within_one_circle_is_that_circle(void **state) {
    (void)state;
    vn_canvas *canvas = canvas_of(100, 100);
    vn_network *network = empty_network();
    vn_stroke_def def = vn_stroke_def_default();
    const double widths[] = {0, 40, 10};
    int32_t start = child_at(network, root_at(network, 50, 50), 50.001, 50);
    child_at(network, start, 58, 50);
    def.widths = widths;
    assert_ok(vn_canvas_stroke(canvas, network, &def));
    assert_near(covered(canvas), pi * 400, 0.02 * pi * 400); // two coverings of one border
    xmlDocPtr document = save_svg(canvas, NULL);
    assert_int_equal(count_elements(xmlDocGetRootElement(document), "circle", "r", "20"), 1);
    xmlFreeDoc(document);
    vn_network_destroy(network);
    vn_canvas_destroy(canvas);
}

static void an_svg_has_one_path_a_chain_and_one_layer_an_order(void **state) {
    (void)state;
    vn_canvas *canvas = canvas_of(200, 200);
    vn_network *network = forked_network();
    vn_stroke_def def = vn_stroke_def_default();
    assert_ok(vn_network_set_orders(network, VN_HICKEY));
    assert_ok(vn_canvas_stroke(canvas, network, &def));
    xmlDocPtr document = save_svg(canvas, NULL);
    xmlNodePtr root = xmlDocGetRootElement(document);
    // 0-1-2, the taper 2-3, 3-5, the lateral 2-4 and over the join to 5
    assert_int_equal(count_elements(root, "path", NULL, NULL), 4);
    assert_int_equal(count_elements(root, "g", "label", "network"), 1);
    assert_int_equal(count_elements(root, "g", "label", "order 1"), 1);
    assert_int_equal(count_elements(root, "g", "label", "order 2"), 1);
    xmlFreeDoc(document);
    vn_network_destroy(network);
    vn_canvas_destroy(canvas);
}

static void veins_of_one_width_are_as_many_paths_as_there_are_tips(void **state) {
    (void)state;
    vn_canvas *canvas = canvas_of(200, 200);
    vn_network *network = random_tree(500);
    vn_stroke_def def = vn_stroke_def_default();
    vn_network_measures measures;
    def.width = 1;
    assert_ok(vn_network_measure(network, &measures));
    assert_ok(vn_canvas_stroke(canvas, network, &def));
    xmlDocPtr document = save_svg(canvas, NULL);
    assert_int_equal(count_elements(xmlDocGetRootElement(document), "path", NULL, NULL), measures.tips);
    xmlFreeDoc(document);
    vn_network_destroy(network);
    vn_canvas_destroy(canvas);
}

// Every edge is drawn exactly once, whatever the widths and orders are.
static void every_edge_is_in_exactly_one_piece(void **state) {
    (void)state;
    vn_canvas *canvas = canvas_of(200, 200);
    vn_network *network = random_tree(700);
    vn_murray_def law = vn_murray_def_default();
    vn_stroke_def def = vn_stroke_def_default();
    int32_t edges = 0;
    assert_ok(vn_network_murray(network, &law));
    assert_ok(vn_network_set_orders(network, VN_STRAHLER));
    assert_ok(vn_canvas_stroke(canvas, network, &def));
    for (int32_t i = 0; i < canvas->pieces.count; i++) {
        edges += canvas->pieces.data[i].count - 1;
    }
    assert_int_equal(edges, 699);
    vn_network_destroy(network);
    vn_canvas_destroy(canvas);
}

static void rounding_does_not_add_up_along_a_chain(void **state) {
    (void)state;
    vn_canvas *canvas = canvas_of(1000, 1000);
    vn_network *network = empty_network();
    vn_stroke_def def = vn_stroke_def_default();
    int32_t node = root_at(network, 0.003, 500);
    for (int i = 1; i <= 900; i++) {
        node = child_at(network, node, 0.003 + 1.0049 * i, 500 + 0.0049 * i);
    }
    def.width = 1;
    assert_ok(vn_canvas_stroke(canvas, network, &def));
    assert_ok(vn_canvas_save(canvas, "test_draw.svg", NULL));
    size_t size;
    char *bytes = read_bytes("test_draw.svg", &size);
    char *at = strstr(bytes, "d=\"M");
    assert_non_null(at);
    at += 4;
    double x = strtod(at, &at), y = strtod(at, &at);
    for (at++; *at != '"';) {
        x += strtod(at, &at);
        y += strtod(at, &at);
    }
    assert_near(x, 0.003 + 1.0049 * 900, 0.0051);
    assert_near(y, 500 - 0.0049 * 900, 0.0051);
    free(bytes);
    remove("test_draw.svg");
    vn_network_destroy(network);
    vn_canvas_destroy(canvas);
}

static void assert_page(const char *unit, const char *width, const char *height) {
    vn_canvas_def def = vn_canvas_def_default();
    vn_canvas *canvas;
    def.width = 720;
    def.height = 420;
    def.view = (vn_box){{0, 0, 0}, {70, 35, 0}};
    def.unit = unit;
    assert_ok(vn_canvas_create(&canvas, &def));
    xmlDocPtr document = save_svg(canvas, NULL);
    assert_true(has_attribute(xmlDocGetRootElement(document), "width", width));
    assert_true(has_attribute(xmlDocGetRootElement(document), "height", height));
    assert_true(has_attribute(xmlDocGetRootElement(document), "viewBox", "0 0 720 420"));
    xmlFreeDoc(document);
    vn_canvas_destroy(canvas);
}

static void a_page_is_at_true_scale_or_has_96_pixels_an_inch(void **state) {
    (void)state;
    assert_page("mm", "72mm", "42mm");
    assert_page("cm", "720mm", "420mm");
    assert_page("", "190.5mm", "111.125mm");
}

static void text_and_manifest_come_back_from_the_svg_as_they_were(void **state) {
    (void)state;
    const char *text = "<\"A\" & 'B'> \xC2\xB5m";
    const char *manifest = "{\"script\": \"a < b && c > d ]]>\"}";
    vn_canvas *canvas = canvas_of(100, 100);
    vn_text_def def = vn_text_def_default();
    assert_ok(vn_canvas_text(canvas, text, &def));
    xmlDocPtr document = save_svg(canvas, manifest);
    assert_element_text(xmlDocGetRootElement(document), "text", text);
    assert_element_text(xmlDocGetRootElement(document), "metadata", manifest);
    xmlFreeDoc(document);
    vn_canvas_destroy(canvas);
}

static void text_that_is_not_utf8_is_mended(void **state) {
    (void)state;
    vn_canvas *canvas = canvas_of(100, 100);
    vn_text_def def = vn_text_def_default();
    assert_ok(vn_canvas_text(canvas, "a\nb\xFF!\x01\xEF\xBF\xBF", &def));
    xmlDocPtr document = save_svg(canvas, NULL);
    assert_element_text(xmlDocGetRootElement(document), "text", "a b\xEF\xBF\xBD! \xEF\xBF\xBD");
    xmlFreeDoc(document);
    picture made = save_picture(canvas);
    free(made.rgba);
    vn_canvas_destroy(canvas);
}

static void text_stands_where_its_anchor_says(void **state) {
    (void)state;
    for (int anchor = 0; anchor < 3; anchor++) {
        vn_canvas *canvas = canvas_of(200, 40);
        vn_text_def def = vn_text_def_default();
        def.at[0] = 100;
        def.at[1] = 15;
        def.anchor = anchor;
        assert_ok(vn_canvas_text(canvas, "venule", &def));
        picture made = save_picture(canvas);
        double left = 0, right = 0;
        for (int i = 0; i < 200 * 40; i++) {
            *(i % 200 < 100 ? &left : &right) += made.rgba[4 * i + 3];
        }
        assert_true(left + right > 0);
        assert_int_equal(left > 0, anchor > 0);
        assert_int_equal(right > 0, anchor < 2);
        free(made.rgba);
        vn_canvas_destroy(canvas);
    }
}

// The chunks of @p path as libpng reads them: its text "venule" must be @p manifest.
static void assert_png_chunks(const char *path, const char *manifest, png_uint_32 a_meter) {
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    FILE *file = fopen(path, "rb");
    png_textp text = NULL;
    png_timep time = NULL;
    assert_non_null(file);
    png_init_io(png, file);
    png_read_info(png, info);
    assert_int_equal(png_get_text(png, info, &text, NULL), 1);
    assert_string_equal(text[0].key, "venule");
    assert_string_equal(text[0].text, manifest);
    assert_int_equal(png_get_x_pixels_per_meter(png, info), a_meter);
    assert_int_equal(png_get_tIME(png, info, &time), 0);
    png_destroy_read_struct(&png, &info, NULL);
    fclose(file);
}

static void a_png_carries_its_manifest_and_its_scale(void **state) {
    (void)state;
    const char *manifests[] = {"{\"seed\": 1}", "{\"unit\": \"\xC2\xB5m\"}"};
    vn_canvas *canvas = canvas_of(20, 20);
    for (int i = 0; i < 2; i++) {
        assert_ok(vn_canvas_save(canvas, "test_draw.png", manifests[i]));
        assert_png_chunks("test_draw.png", manifests[i], 3780);
        remove("test_draw.png");
    }
    vn_canvas_destroy(canvas);
}

static void a_half_transparent_colour_comes_back_from_the_png(void **state) {
    (void)state;
    vn_canvas_def def = vn_canvas_def_default();
    vn_canvas *canvas;
    def.width = def.height = 4;
    def.background = "#f0804080";
    assert_ok(vn_canvas_create(&canvas, &def));
    picture made = save_picture(canvas);
    const int expected[] = {0xf0, 0x80, 0x40, 0x80};
    for (int i = 0; i < 4; i++) {
        assert_in_range(made.rgba[i], expected[i] - 1, expected[i] + 1);
    }
    free(made.rgba);
    vn_canvas_destroy(canvas);
}

// Some of everything.
static vn_status draw_all(vn_canvas *canvas, const vn_network *network, const vn_domain *domain) {
    vn_fill_def fill = vn_fill_def_default();
    vn_stroke_def stroke = vn_stroke_def_default();
    vn_dots_def dots = vn_dots_def_default();
    vn_text_def text = vn_text_def_default();
    const double x[] = {20, 40}, y[] = {30, 50};
    fill.stroke = "teal";
    stroke.opacity = 0.7;
    VN_TRY(vn_canvas_fill(canvas, domain, &fill));
    VN_TRY(vn_canvas_stroke(canvas, network, &stroke));
    VN_TRY(vn_canvas_dots(canvas, x, y, NULL, 2, &dots));
    return vn_canvas_text(canvas, "fig. 1", &text);
}

static vn_status draw_and_save(const vn_network *network, const vn_domain *domain, const char *path) {
    vn_canvas_def def = vn_canvas_def_default();
    vn_canvas *canvas;
    def.width = def.height = 200;
    VN_TRY(vn_canvas_create(&canvas, &def));
    vn_status status = draw_all(canvas, network, domain);
    if (status == VN_OK) {
        status = vn_canvas_save(canvas, path, "{\"seed\": 1}");
    }
    vn_canvas_destroy(canvas);
    return status;
}

static vn_domain *round_domain(void) {
    vn_disk_def disk = {{100, 100, 0}, 90};
    vn_domain *domain = NULL;
    assert_ok(vn_domain_disk(&domain, &disk));
    return domain;
}

static void the_same_picture_is_the_same_bytes(void **state) {
    (void)state;
    const char *paths[] = {"test_draw.png", "test_draw.SVG", "test_draw.pdf"};
    vn_network *network = forked_network();
    vn_domain *domain = round_domain();
    for (int i = 0; i < 3; i++) {
        size_t size, again;
        assert_ok(draw_and_save(network, domain, paths[i]));
        char *first = read_bytes(paths[i], &size);
        assert_ok(draw_and_save(network, domain, paths[i]));
        char *second = read_bytes(paths[i], &again);
        assert_int_equal(size, again);
        assert_memory_equal(first, second, size);
        free(first);
        free(second);
        remove(paths[i]);
    }
    vn_domain_release(domain);
    vn_network_destroy(network);
}

static void a_file_that_cannot_be_written_says_why(void **state) {
    (void)state;
    vn_canvas *canvas = canvas_of(20, 20);
    assert_int_equal(vn_canvas_save(canvas, "test_draw.gif", NULL), VN_INVALID);
    assert_message(".svg");
    assert_int_equal(vn_canvas_save(canvas, "no/such/folder/leaf.png", NULL), VN_IO);
    assert_message("no/such/folder/leaf.png");
    assert_false(exists("test_draw.gif"));
    vn_canvas_destroy(canvas);
}

static void an_interrupted_save_leaves_no_file(void **state) {
    (void)state;
    const char *paths[] = {"test_draw.png", "test_draw.svg", "test_draw.pdf"};
    vn_canvas *canvas = canvas_of(200, 200);
    vn_network *network = forked_network();
    vn_domain *domain = round_domain();
    assert_ok(draw_all(canvas, network, domain));
    for (int i = 0; i < 3; i++) {
        vn_interrupt();
        vn_status status = vn_canvas_save(canvas, paths[i], NULL);
        assert_int_equal(status, VN_INTERRUPTED);
        assert_false(exists(paths[i]));
    }
    vn_domain_release(domain);
    vn_network_destroy(network);
    vn_canvas_destroy(canvas);
}

static void colours_are_read_in_every_notation(void **state) {
    (void)state;
    const char *texts[] = {"#f80", "#ff8800", "#F80F", "#ff8800ff"};
    vn_color color;
    for (int i = 0; i < 4; i++) {
        assert_ok(vn_color_parse(&color, texts[i], "x"));
        assert_int_equal(color.red, 255);
        assert_int_equal(color.green, 0x88);
        assert_int_equal(color.blue, 0);
        assert_int_equal(color.alpha, 255);
    }
    assert_ok(vn_color_parse(&color, "Teal", "x"));
    assert_int_equal(color.green, 128);
    assert_ok(vn_color_parse(&color, "none", "x"));
    assert_int_equal(color.alpha, 0);
}

static void an_unknown_colour_is_refused_with_a_suggestion(void **state) {
    (void)state;
    vn_color color;
    assert_int_equal(vn_color_parse(&color, "gren", "fill.color"), VN_INVALID);
    assert_message("fill.color = \"gren\"");
    assert_message("\"green\"?");
    assert_int_equal(vn_color_parse(&color, "#12345", "x"), VN_INVALID);
    assert_int_equal(vn_color_parse(&color, "#ggg", "x"), VN_INVALID);
    assert_int_equal(vn_color_parse(&color, "", "x"), VN_INVALID);
}

static void a_wrong_canvas_is_refused(void **state) {
    (void)state;
    vn_canvas_def def = vn_canvas_def_default();
    vn_canvas *canvas = (vn_canvas *)&def;
    def.width = def.height = 30000;
    assert_int_equal(vn_canvas_create(&canvas, &def), VN_INVALID);
    assert_null(canvas);
    assert_message("2^28");
    def.width = nan("");
    assert_int_equal(vn_canvas_create(&canvas, &def), VN_INVALID);
    assert_message("canvas.width");
    def = vn_canvas_def_default();
    def.unit = "parsec";
    assert_int_equal(vn_canvas_create(&canvas, &def), VN_INVALID);
    assert_message("\"mm\"");
    def = vn_canvas_def_default();
    def.view = (vn_box){{0, 0, 0}, {INFINITY, 1, 0}};
    assert_int_equal(vn_canvas_create(&canvas, &def), VN_INVALID);
    def.view = (vn_box){{0, 0, 0}, {1, 1, 0}};
    def.width = def.height = 20;
    assert_int_equal(vn_canvas_create(&canvas, &def), VN_INVALID);
    assert_message("canvas.margin = 10");
}

static void what_cannot_be_drawn_leaves_the_list_as_it_was(void **state) {
    (void)state;
    vn_canvas *canvas = canvas_of(50, 50);
    vn_network *network = empty_network();
    vn_stroke_def stroke = vn_stroke_def_default();
    vn_dots_def dots = vn_dots_def_default();
    const double x[] = {1, NAN}, y[] = {1, 2}, widths[] = {0, NAN};
    child_at(network, root_at(network, 1, 1), 2, 2);
    assert_int_equal(vn_canvas_stroke(canvas, network, &stroke), VN_INVALID);
    assert_message("radii are not known");
    stroke.widths = widths;
    assert_int_equal(vn_canvas_stroke(canvas, network, &stroke), VN_INVALID);
    assert_int_equal(vn_canvas_dots(canvas, x, y, NULL, 2, &dots), VN_INVALID);
    assert_message("point 1");
    dots.opacity = 1.5;
    assert_int_equal(vn_canvas_dots(canvas, y, y, NULL, 2, &dots), VN_INVALID);
    assert_message("dots.opacity = 1.5");
    assert_int_equal(canvas->items.count, 0);
    assert_int_equal(canvas->pieces.count, 0);
    assert_int_equal(canvas->points.count, 0);
    vn_network_destroy(network);
    vn_canvas_destroy(canvas);
}

static void an_empty_network_draws_nothing(void **state) {
    (void)state;
    vn_canvas *canvas = canvas_of(50, 50);
    vn_network *network = empty_network();
    vn_stroke_def stroke = vn_stroke_def_default();
    assert_ok(vn_canvas_stroke(canvas, network, &stroke));
    root_at(network, 10, 10);
    assert_ok(vn_canvas_stroke(canvas, network, &stroke));
    assert_near(covered(canvas), 0, 0);
    xmlFreeDoc(save_svg(canvas, NULL));
    vn_network_destroy(network);
    vn_canvas_destroy(canvas);
}

static void any_refused_allocation_is_a_status_and_leaks_nothing(void **state) {
    (void)state;
    const char *paths[] = {"test_draw.png", "test_draw.svg", "test_draw.pdf"};
    vn_network *network = forked_network();
    vn_domain *domain = round_domain();
    assert_ok(vn_network_set_orders(network, VN_HORTON));
    for (int i = 0; i < 3; i++) {
        size_t before = vn_byte_count();
        vn_status status = VN_NO_MEMORY;
        for (int64_t nth = 0; status != VN_OK; nth++) {
            assert_true(nth < 1000);
            vn_fail_allocations_from(nth);
            status = draw_and_save(network, domain, paths[i]);
            vn_fail_allocations_from(-1);
            assert_true(status == VN_OK || status == VN_NO_MEMORY);
            assert_int_equal(vn_byte_count(), before);
            assert_int_equal(exists(paths[i]), status == VN_OK);
        }
        remove(paths[i]);
    }
    vn_domain_release(domain);
    vn_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_default_is_within_its_range),
        cmocka_unit_test(the_view_is_fitted_in_the_middle_with_y_up),
        cmocka_unit_test(a_side_that_is_not_given_follows_the_view),
        cmocka_unit_test(a_canvas_without_a_view_begins_at_its_lower_left),
        cmocka_unit_test(a_filled_disk_covers_its_area),
        cmocka_unit_test(a_ring_with_a_hole_covers_what_is_between),
        cmocka_unit_test(a_straight_vein_covers_its_length_and_two_half_disks),
        cmocka_unit_test(the_finest_veins_do_not_vanish),
        cmocka_unit_test(half_opaque_veins_that_cross_do_not_darken_each_other),
        cmocka_unit_test(a_taper_is_the_hull_of_two_circles),
        cmocka_unit_test(a_taper_within_one_circle_is_that_circle),
        cmocka_unit_test(an_svg_has_one_path_a_chain_and_one_layer_an_order),
        cmocka_unit_test(veins_of_one_width_are_as_many_paths_as_there_are_tips),
        cmocka_unit_test(every_edge_is_in_exactly_one_piece),
        cmocka_unit_test(rounding_does_not_add_up_along_a_chain),
        cmocka_unit_test(a_page_is_at_true_scale_or_has_96_pixels_an_inch),
        cmocka_unit_test(text_and_manifest_come_back_from_the_svg_as_they_were),
        cmocka_unit_test(text_that_is_not_utf8_is_mended),
        cmocka_unit_test(text_stands_where_its_anchor_says),
        cmocka_unit_test(a_png_carries_its_manifest_and_its_scale),
        cmocka_unit_test(a_half_transparent_colour_comes_back_from_the_png),
        cmocka_unit_test(the_same_picture_is_the_same_bytes),
        cmocka_unit_test(a_file_that_cannot_be_written_says_why),
        cmocka_unit_test(an_interrupted_save_leaves_no_file),
        cmocka_unit_test(colours_are_read_in_every_notation),
        cmocka_unit_test(an_unknown_colour_is_refused_with_a_suggestion),
        cmocka_unit_test(a_wrong_canvas_is_refused),
        cmocka_unit_test(what_cannot_be_drawn_leaves_the_list_as_it_was),
        cmocka_unit_test(an_empty_network_draws_nothing),
        cmocka_unit_test(any_refused_allocation_is_a_status_and_leaks_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
