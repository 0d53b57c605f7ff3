// Outlines from SVG files: known areas, the laws of transforms and styles, and files that are wrong.
#define _DEFAULT_SOURCE // mkstemp
#include "base/memory.h"
#include "domain/crossing.h"
#include "file/svg.h"
#include "venule/output.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

// Where this repository lies.
#ifndef VN_SOURCE_DIR
#define VN_SOURCE_DIR "."
#endif

#define HEAD "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' "
#define PAGE HEAD "viewBox='0 0 100 100'>"
#define SQUARE "<path id='s' d='M10 10h20v20h-20z'/>"

static const double pi = 3.14159265358979323846;

static vn_svg_def fine(void) {
    vn_svg_def def = vn_svg_def_default();
    def.tolerance = 1e-6;
    return def;
}

static vn_svg_def named(const char *id) {
    vn_svg_def def = fine();
    def.id = id;
    return def;
}

static vn_status load_text(vn_domain **out, const char *text, const vn_svg_def *def) {
    char path[] = "/tmp/venule-svg-XXXXXX";
    int file = mkstemp(path);
    assert_true(file >= 0);
    size_t size = strlen(text);
    assert_int_equal(write(file, text, size), size);
    close(file);
    vn_status status = vn_domain_svg(out, path, def);
    unlink(path);
    return status;
}

static vn_domain *domain_of(const char *text, vn_svg_def def) {
    vn_domain *domain;
    vn_status status = load_text(&domain, text, &def);
    if (status != VN_OK) {
        fail_msg("%s", vn_message());
    }
    return domain;
}

static double area_of(const char *text, vn_svg_def def) {
    vn_domain *domain = domain_of(text, def);
    double area = vn_domain_measure(domain);
    vn_domain_release(domain);
    assert_int_equal(vn_byte_count(), 0);
    return area;
}

static void assert_near(double value, double expected, double error) {
    if (!(fabs(value - expected) <= error)) {
        fail_msg("%.12g is not %.12g", value, expected);
    }
}

static void assert_area(const char *shapes, double expected) {
    char text[4096];
    snprintf(text, sizeof text, PAGE "%s</svg>", shapes);
    assert_near(area_of(text, fine()), expected, 1e-6 * expected + 1e-9);
}

static void assert_bounds(const char *text, vn_svg_def def, double x0, double y0, double x1, double y1) {
    vn_domain *domain = domain_of(text, def);
    vn_box box = vn_domain_bounds(domain);
    vn_domain_release(domain);
    assert_near(box.min[0], x0, 1e-6);
    assert_near(box.min[1], y0, 1e-6);
    assert_near(box.max[0], x1, 1e-6);
    assert_near(box.max[1], y1, 1e-6);
    assert_int_equal(vn_byte_count(), 0);
}

static void assert_fails(const char *text, vn_svg_def def, vn_status expected, const char *part) {
    vn_domain *domain;
    vn_status status = load_text(&domain, text, &def);
    assert_null(domain);
    if (status != expected || strstr(vn_message(), part) == NULL || strchr(vn_message(), '\n') != NULL) {
        fail_msg("status %d: %s", (int)status, vn_message());
    }
    assert_int_equal(vn_byte_count(), 0);
}

static void assert_file_fails(const char *name, vn_svg_def def, vn_status expected, const char *part) {
    char path[512];
    vn_domain *domain;
    snprintf(path, sizeof path, VN_SOURCE_DIR "/tests/files/svg/%s", name);
    vn_status status = vn_domain_svg(&domain, path, &def);
    if (status != expected || strstr(vn_message(), part) == NULL || strstr(vn_message(), name) == NULL) {
        fail_msg("%s: status %d: %s", name, (int)status, vn_message());
    }
    assert_int_equal(vn_byte_count(), 0);
}

static vn_domain *domain_in(const char *name, vn_svg_def def) {
    char path[512];
    vn_domain *domain;
    snprintf(path, sizeof path, VN_SOURCE_DIR "/%s", name);
    if (vn_domain_svg(&domain, path, &def) != VN_OK) {
        fail_msg("%s", vn_message());
    }
    return domain;
}

static void basic_shapes_have_their_areas(void **state) {
    (void)state;
    assert_area("<rect x='1' y='2' width='30' height='20'/>", 600);
    assert_area("<rect width='30' height='20' rx='5'/>", 600 - (4 - pi) * 25);
    assert_area("<rect width='30' height='20' rx='5' ry='2'/>", 600 - (4 - pi) * 10);
    assert_area("<rect width='30' height='20' rx='99' ry='99'/>", pi * 150);
    assert_area("<circle cx='50' cy='50' r='20'/>", pi * 400);
    assert_area("<ellipse cx='50' cy='50' rx='20' ry='10'/>", pi * 200);
    assert_area("<polygon points='0,0 10,0 10,10'/>", 50);
    assert_area("<polyline points='0 0,10 0 10 10 0,10'/>", 100);
    assert_area("<rect width='50%' height='10%'/>", 500);
    assert_area("<line x1='0' y1='0' x2='9' y2='9'/>" SQUARE, 400);
}

static void curves_have_their_areas(void **state) {
    (void)state;
    // Under a parabola with control point (a, h): two thirds of half the control triangle's base times
    // height.
    assert_area("<path d='M0 0Q10 30 20 0z'/>", 2.0 / 3 * 0.5 * 20 * 30);
    assert_area("<path d='M0 0C0 40 20 40 20 0z'/>", 0.75 * 20 * 40 * 0.8);
    assert_area("<path d='M10 50A20 20 0 0 1 50 50z'/>", pi * 200);
    assert_area("<path d='M10 50A20 10 0 1 0 50 50z'/>", pi * 100);
    assert_area("<path d='M30 50A20 20 0 0 1 50 70z'/>", pi * 100 - 200);
    assert_area("<path d='M30 50A20 20 0 1 0 50 70z'/>", pi * 300 + 200);
    assert_area("<path d='M10 50A1 1 0 0 1 50 50z'/>", pi * 200); // too small radii grow
}

static void absolute_and_relative_commands_agree(void **state) {
    (void)state;
    static const char *const pairs[][2] = {
        {"M10 10L30 10L30 30z", "m10 10l20 0l0 20z"},
        {"M10 10H30V30z", "m10 10h20v20z"},
        {"M10 10 30 10 30 30z", "m10 10 20 0 0 20z"},
        {"M10 10C10 40 40 40 40 10z", "m10 10c0 30 30 30 30 0z"},
        {"M10 10C10 20 20 30 30 30S50 20 50 10z", "m10 10c0 10 10 20 20 20s20-10 20-20z"},
        {"M10 10Q20 40 30 10z", "m10 10q10 30 20 0z"},
        {"M10 10Q20 30 30 20T50 10z", "m10 10q10 20 20 10t20-10z"},
        {"M10 10A20 10 30 0 1 40 20z", "m10 10a20 10 30 0130 10z"},
        {"M10 10L30 10L30 30zM50 50L60 50L60 60z", "m10 10 20 0 0 20zm40 40 10 0 0 10z"},
    };
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        double areas[2];
        for (int k = 0; k < 2; k++) {
            char text[512];
            snprintf(text, sizeof text, PAGE "<path d='%s'/></svg>", pairs[i][k]);
            areas[k] = area_of(text, fine());
        }
        assert_true(areas[0] > 10);
        assert_near(areas[1], areas[0], 1e-9 * areas[0]);
    }
}

static void compact_numbers_and_flags_are_read(void **state) {
    (void)state;
    assert_area("<path d='M.5.5 10.5.5 10.5 10.5.5 10.5'/>", 100);
    assert_area("<path d='M1e1,1E1l2e+1-0 0 2.e1-20,0'/>", 400);
    assert_area("<path d='M10 50a20 20 0 0140 0z'/>", pi * 200);
    assert_area("<path d='M10 50a20,20 0 01 40,0a20 20 0 01-40 0'/>", pi * 400);
    assert_area("<path d='m10-0 10 0 0 10-10 0'/>", 100);
}

static void paths_are_drawn_up_to_their_error(void **state) {
    (void)state;
    assert_area("<path d='M0 0H10V10H0z L5'/>", 100);
    assert_area("<path d='M0 0H10V10H0 X 99'/>", 100);
    assert_area("<path d='M0 0H10V10H0z5'/>", 100);
    assert_area("<path d='M0 0H10V10H0 L 50'/>", 100);
    assert_area("<path d='M0 0H10V10H0 A 5 5 0 2 0 9 9'/>", 100);
    assert_area("<polygon points='0 0 10 0 10 10 0 10 x 5'/>", 100);
    assert_area("<path d=''/>" SQUARE, 400);
}

static void transforms_compose(void **state) {
    (void)state;
    assert_area("<g transform='scale(2)'><rect width='5' height='5' transform='scale(1 3)'/></g>", 300);
    assert_area("<rect width='5' height='5' transform='matrix(2 0 1 2 0 0)'/>", 100);
    assert_area("<rect width='5' height='4' transform='skewX(30) skewY(0)'/>", 20);
    assert_area("<rect width='5' height='4' transform='translate(3),rotate(33 1 2)'/>", 20);
    vn_svg_def def = fine();
    assert_bounds(
        PAGE
        "<g transform='translate(50 50)'><rect width='10' height='20' transform='rotate(90)'/></g></svg>",
        def, 30, 40, 50, 50);
    assert_bounds(PAGE "<rect x='10' y='10' width='10' height='20' transform='rotate(180 15 20)'/></svg>",
                  def, 10, 70, 20, 90);
    assert_bounds(PAGE "<rect width='10' height='20' transform='translate(5,5)scale(2,1)'/></svg>", def, 5,
                  75, 25, 95);
    assert_bounds(PAGE "<rect width='10' height='20' transform='wobble(3)'/></svg>", def, 0, 80, 10, 100);
}

static void a_page_with_a_physical_width_is_measured_in_millimetres(void **state) {
    (void)state;
    static const char *const widths[] = {"50mm", "5cm", "1.9685039370078741in", "141.73228346456693pt"};
    for (size_t i = 0; i < sizeof widths / sizeof *widths; i++) {
        char text[512];
        snprintf(text, sizeof text, HEAD "width='%s' viewBox='0 0 100 100'>" SQUARE "</svg>", widths[i]);
        vn_domain *domain = domain_of(text, fine());
        assert_near(vn_domain_measure(domain), 100, 1e-6);
        assert_string_equal(vn_domain_unit(domain), "mm");
        vn_domain_release(domain);
    }
    vn_domain *plain = domain_of(PAGE SQUARE "</svg>", fine());
    assert_string_equal(vn_domain_unit(plain), "");
    vn_domain_release(plain);
    assert_near(area_of(HEAD "width='9in' height='9in'>" SQUARE "</svg>", fine()), 400 * pow(25.4 / 96, 2),
                1e-6);
    assert_int_equal(vn_byte_count(), 0);
}

static void the_view_box_puts_its_lower_left_at_the_origin(void **state) {
    (void)state;
    vn_svg_def def = fine();
    assert_bounds(HEAD "viewBox='5 5 100 200'>" SQUARE "</svg>", def, 5, 175, 25, 195);
    assert_bounds(HEAD "width='100' height='80'>" SQUARE "</svg>", def, 10, 50, 30, 70);
    assert_bounds(HEAD ">" SQUARE "</svg>", def, 10, -30, 30, -10);
    assert_bounds(PAGE "<svg x='10' y='10' width='40' height='20' viewBox='0 0 10 10'><rect width='10' "
                       "height='10'/></svg></svg>",
                  def, 20, 70, 40, 90);
    assert_bounds(PAGE
                  "<svg x='10' y='10' width='40' height='20' viewBox='0 0 10 10' preserveAspectRatio='none'>"
                  "<rect width='10' height='10'/></svg></svg>",
                  def, 10, 70, 50, 90);
}

static void use_draws_what_lies_before_or_behind_it(void **state) {
    (void)state;
    vn_svg_def def = fine();
    assert_bounds(PAGE
                  "<defs><rect id='r' width='10' height='10'/></defs><use href='#r' x='20' y='30'/></svg>",
                  def, 20, 60, 30, 70);
    assert_bounds(
        PAGE "<use xlink:href='#r' transform='scale(2)'/><defs><rect id='r' width='10' height='10'/></defs>"
             "</svg>",
        def, 0, 80, 20, 100);
    assert_bounds(PAGE "<symbol id='y' viewBox='0 0 10 10'><rect width='10' height='10'/></symbol>"
                       "<use href='#y' x='5' width='20' height='20'/></svg>",
                  def, 5, 80, 25, 100);
    assert_area("<use href='#nowhere'/><use href='other.svg#a'/>" SQUARE, 400);
}

static void definitions_are_not_drawn(void **state) {
    (void)state;
    assert_area(
        "<defs><rect width='90' height='90'/></defs><clipPath><rect width='90' height='90'/></clipPath>"
        "<mask><rect width='90' height='90'/></mask><pattern><rect width='90' height='90'/></pattern>"
        "<marker><rect width='90' height='90'/></marker><symbol><rect width='90' height='90'/></symbol>"
        "<metadata><rect width='90' height='90'/></metadata>" SQUARE,
        400);
}

static void styles_override_rules_which_override_attributes(void **state) {
    (void)state;
    static const char *const hidden[] = {
        "fill='none'",
        "fill='red' class='n'",
        "class='y' style='fill:none'",
        "id='big'",
        "class='y other n'",
        "style='display:none'",
        "display='none'",
        "visibility='hidden'",
        "opacity='0'",
        "fill-opacity='0'",
        "style=' FILL : None ;stroke:red'",
    };
    for (size_t i = 0; i < sizeof hidden / sizeof *hidden; i++) {
        char text[1024];
        snprintf(text, sizeof text,
                 "<style>/*{*/ @media print{.s{fill:none}} .y{fill:#000} .n, #big {fill:none;}</style>"
                 "<rect width='90' height='90' %s/>" SQUARE,
                 hidden[i]);
        assert_area(text, 400);
    }
    assert_area(
        "<style>rect.n{fill:none} .n{fill:red !important}</style><rect class='n' width='9' height='9'/>", 81);
    assert_area("<g fill='none'><rect width='9' height='9' fill='red'/><rect width='20' height='20'/></g>",
                81);
    assert_area("<g display='none'><rect display='inline' width='90' height='90'/></g>" SQUARE, 400);
}

static void unfilled_outlines_count_only_where_nothing_is_filled(void **state) {
    (void)state;
    assert_area("<rect width='90' height='90' fill='none' stroke='red'/>" SQUARE, 400);
    assert_area("<rect width='30' height='30' fill='none' stroke='red'/>", 900);
    assert_area("<rect width='90' height='90' fill='none'/><rect width='30' height='30' "
                "style='fill:none;stroke:#000'/>",
                900);
    assert_near(area_of(PAGE SQUARE "<rect id='o' width='30' height='30' fill='none'/></svg>", named("o")),
                900, 1e-6);
}

static void an_id_names_a_shape_or_a_group(void **state) {
    (void)state;
    const char *text =
        PAGE "<g id='leaf'><rect id='one' width='10' height='10'/><rect x='5' width='10' height='10'/>"
             "</g><rect width='90' height='90'/></svg>";
    assert_near(area_of(text, named("one")), 100, 1e-6);
    assert_near(area_of(text, named("leaf")), 150, 1e-6);
    assert_near(area_of(text, fine()), 8100, 1e-6);
    assert_fails(text, named("laef"), VN_INVALID, "did you mean \"leaf\"");
    assert_fails(text, named("something else"), VN_INVALID, "it has \"leaf\", \"one\"");
    assert_fails(PAGE "<rect width='1' height='1'/></svg>", named("a"), VN_INVALID,
                 "nothing in it has an id");
    assert_fails(PAGE "<text id='t'>leaf</text></svg>", named("t"), VN_INVALID, "is a <text>");
    assert_fails(PAGE "<defs>" SQUARE "</defs></svg>", named("s"), VN_INVALID, "not drawn");
    assert_fails(PAGE "<g style='display:none' id='h'>" SQUARE "</g></svg>", named("h"), VN_INVALID,
                 "hidden");
    assert_fails(PAGE "<g id='e'/></svg>", named("e"), VN_INVALID, "no area");
}

static void pick_all_unites_what_is_filled(void **state) {
    (void)state;
    vn_svg_def def = fine();
    def.pick = 1;
    assert_near(area_of(PAGE "<rect width='10' height='10'/><rect x='5' width='10' height='10'/>"
                             "<rect x='50' width='5' height='5'/><rect width='90' height='90' fill='none' "
                             "stroke='red'/></svg>",
                        def),
                175, 1e-6);
}

static void the_fill_rule_decides_about_holes(void **state) {
    (void)state;
    const char *rings = "d='M0 0H30V30H0zM10 10H20V20H10z'";
    char text[256];
    snprintf(text, sizeof text, "<path %s/>", rings);
    assert_area(text, 900);
    snprintf(text, sizeof text, "<path fill-rule='evenodd' %s/>", rings);
    assert_area(text, 800);
    assert_area("<path d='M0 0H30V30H0zM10 10V20H20V10z'/>", 800);
    vn_domain *ring =
        domain_of(PAGE "<path fill-rule='evenodd' d='M0 0H30V30H0zM10 10H20V20H10z'/></svg>", fine());
    double hole[3] = {15, 85, 0};
    double flesh[3] = {5, 95, 0};
    assert_false(vn_domain_contains(ring, hole));
    assert_true(vn_domain_contains(ring, flesh));
    vn_domain_release(ring);
    assert_int_equal(vn_byte_count(), 0);
}

static void outlines_that_cross_are_refused_or_repaired(void **state) {
    (void)state;
    vn_svg_def def = fine();
    const char *bow = PAGE "<path id='blade' d='M0 0L10 10L10 0L0 10z'/></svg>";
    assert_fails(bow, def, VN_INVALID, "path \"blade\" crosses itself near (5, 95): unite it");
    assert_fails(PAGE "\n<path d='M0 0L10 10L10 0L0 10z'/></svg>", def, VN_INVALID,
                 "the path in line 2 crosses");
    assert_fails(PAGE "<path d='M0 0H20V20H0zM10 10H30V30H10z'/></svg>", def, VN_INVALID, "crosses itself");
    assert_fails(PAGE "<path d='M0 0H20V20H0V0H20V20H0z'/></svg>", def, VN_INVALID, "crosses itself");
    def.repair = true;
    assert_near(area_of(bow, def), 50, 1e-6);
}

static void rounding_is_not_taken_for_a_crossing(void **state) {
    (void)state;
    assert_area("<path d='M0 0H20V20H0L0 0L0 0z'/>", 400);
    assert_area("<path d='M0 0H20V20L20.00001 19.99999 20 20.00001H0z'/>", 400);
    assert_area("<path d='M0 0H20V20H0zM20 20H30V30H20z'/>", 500); // touch in a point
    assert_area("<path d='M0 0H20V20H0zM40 0H60V20H40z'/>", 800);
    assert_area("<path d='M0 0H20V20H10V30V20H0z'/>", 400); // a spike
}

static void crossings_of_rings_are_found_exactly(void **state) {
    (void)state;
    static const double folded[][2] = {{0, 0}, {4, 0}, {2, 0}, {2, 3}};
    vn_rings rings = {0};
    for (int i = 0; i < 4; i++) {
        assert_int_equal(vn_rings_point(&rings, folded[i][0], folded[i][1]), VN_OK);
    }
    assert_int_equal(vn_rings_close(&rings), VN_OK);
    assert_int_equal(vn_rings_check_simple(&rings, "here"), VN_INVALID);
    assert_non_null(strstr(vn_message(), "here: the outline crosses itself near"));
    assert_int_equal(vn_rings_point(&rings, NAN, 0), VN_INVALID);
    vn_rings_free(&rings);
    assert_int_equal(vn_byte_count(), 0);
}

static void combining_nothing_gives_nothing(void **state) {
    (void)state;
    vn_rings line = {0}, empty = {0}, out;
    for (int i = 0; i < 4; i++) {
        assert_int_equal(vn_rings_point(&line, i % 3, 2 * (i % 3)), VN_OK);
    }
    assert_int_equal(vn_rings_close(&line), VN_OK);
    assert_int_equal(vn_rings_resolve(&out, &empty, VN_FILL_NONZERO), VN_OK);
    assert_int_equal(out.ends.count, 0);
    assert_int_equal(vn_rings_resolve(&out, &line, VN_FILL_NONZERO), VN_OK);
    assert_int_equal(out.ends.count, 0);
    assert_int_equal(vn_rings_combine(&out, &line, &empty, VN_UNION), VN_OK);
    assert_int_equal(out.ends.count, 0);
    vn_rings_free(&line);
    assert_int_equal(vn_byte_count(), 0);
}

static void a_long_outline_is_checked_fast(void **state) {
    (void)state;
    enum { COUNT = 200000 };
    vn_rings rings = {0};
    for (int i = 0; i < COUNT; i++) {
        double angle = 2 * pi * i / COUNT;
        double r = 10 + 0.5 * sin(700 * angle);
        assert_int_equal(vn_rings_point(&rings, r * cos(angle), r * sin(angle)), VN_OK);
    }
    assert_int_equal(vn_rings_close(&rings), VN_OK);
    vn_set_time_budget(20); // of sanitized builds on slow machines; a quadratic search takes minutes
    assert_int_equal(vn_rings_check_simple(&rings, "here"), VN_OK);
    vn_set_time_budget(0);
    vn_rings_free(&rings);
    assert_int_equal(vn_byte_count(), 0);
}

static void files_of_drawing_programs_load(void **state) {
    (void)state;
    vn_domain *inkscape = domain_in("tests/files/svg/inkscape.svg", vn_svg_def_default());
    assert_near(vn_domain_measure(inkscape), 1200, 1e-6);
    assert_near(vn_domain_bounds(inkscape).min[1], 30, 1e-6);
    assert_string_equal(vn_domain_unit(inkscape), "mm");
    vn_domain_release(inkscape);
    vn_domain *illustrator = domain_in("tests/files/svg/illustrator.svg", vn_svg_def_default());
    assert_near(vn_domain_measure(illustrator), 6400 - 1600, 1e-6);
    vn_domain_release(illustrator);
    vn_domain *fifty = domain_in("tests/files/svg/fifty.svg", vn_svg_def_default());
    assert_near(vn_domain_measure(fifty), 42 * 42, 1e-6);
    vn_domain_release(fifty);
    assert_int_equal(vn_byte_count(), 0);
}

static void our_outlines_load(void **state) {
    (void)state;
    vn_domain *ivy = domain_in("scripts/outlines/leaf-ivy.svg", vn_svg_def_default());
    assert_true(vn_domain_measure(ivy) > 7000);
    vn_domain_release(ivy);
    vn_domain *maple = domain_in("scripts/outlines/leaf-maple-autumn.svg", vn_svg_def_default());
    assert_true(vn_domain_measure(maple) > 40000);
    vn_domain_release(maple);
    vn_domain *poplar = domain_in("scripts/outlines/poplar.svg", named("blade"));
    assert_near(vn_domain_bounds(poplar).max[1] - vn_domain_bounds(poplar).min[1], 80, 0.1);
    assert_string_equal(vn_domain_unit(poplar), "mm");
    vn_domain_release(poplar);
    assert_int_equal(vn_byte_count(), 0);
}

static void broken_files_are_told_from_each_other(void **state) {
    (void)state;
    vn_svg_def def = vn_svg_def_default();
    assert_file_fails("nothing-here.svg", def, VN_IO, "cannot be opened");
    assert_file_fails("empty.svg", def, VN_IO, "the file is empty");
    assert_file_fails("unclosed.svg", def, VN_IO, "line 2");
    assert_file_fails("page.svg", def, VN_IO, "<html>, not <svg>");
    assert_file_fails("no-shapes.svg", def, VN_IO, "no shape with an area");
    assert_file_fails("bad-path.svg", def, VN_IO, "begin with no point");
    assert_file_fails("compressed.svg", def, VN_IO, "gunzip");
    assert_file_fails("crossing.svg", def, VN_INVALID, "crosses itself");
    assert_file_fails("entity-bomb.svg", def, VN_IO, "entity");
    assert_fails("<!DOCTYPE svg [<!ENTITY a 'x'><!ENTITY b '&a;&a;'>]>" PAGE SQUARE "</svg>", def, VN_IO,
                 "\"b\" is made of other entities");
    assert_file_fails("cyclic-use.svg", def, VN_IO, "contains itself");
}

static void a_doubling_chain_of_uses_ends(void **state) {
    (void)state;
    char text[4096] = PAGE "<g id='g0'><path d='M0 0'/></g>";
    for (int i = 1; i < 30; i++) {
        char line[128];
        snprintf(line, sizeof line, "<g id='g%d'><use href='#g%d'/><use href='#g%d'/></g>", i, i - 1, i - 1);
        strcat(text, line);
    }
    strcat(text, "</svg>");
    assert_fails(text, fine(), VN_LIMIT, "more than");
}

static void wrong_options_are_refused(void **state) {
    (void)state;
    vn_svg_def def = vn_svg_def_default();
    def.tolerance = -1;
    assert_fails(PAGE SQUARE "</svg>", def, VN_INVALID, "svg.tolerance");
    def = vn_svg_def_default();
    def.pick = 7;
    assert_fails(PAGE SQUARE "</svg>", def, VN_INVALID, "svg.pick");
}

static void a_tolerance_is_kept(void **state) {
    (void)state;
    static const double tolerances[] = {1, 0.1, 0.001};
    for (size_t i = 0; i < sizeof tolerances / sizeof *tolerances; i++) {
        vn_svg_def def = vn_svg_def_default();
        def.tolerance = tolerances[i];
        double area = area_of(PAGE "<circle cx='50' cy='50' r='20'/></svg>", def);
        double inner = 20 - tolerances[i];
        assert_true(area <= pi * 400 + 1e-6 && area >= pi * inner * inner);
    }
}

static void running_out_of_memory_is_a_clean_failure(void **state) {
    (void)state;
    const char *text =
        PAGE "<style>.a,.b{fill:red}</style><g id='g'><path class='a' d='M0 0C0 40 20 40 20 0z'/>"
             "<rect class='b' x='5' width='30' height='10'/><path d='M0 60h9v9l.00001.00001-.00001 "
             "0h-9z'/></g></svg>";
    vn_svg_def def = vn_svg_def_default();
    def.id = "g";
    vn_status status = VN_NO_MEMORY;
    int64_t n = 0;
    for (; status != VN_OK; n++) {
        vn_domain *domain;
        vn_fail_allocations_from(n);
        status = load_text(&domain, text, &def);
        vn_fail_allocations_from(-1);
        assert_true(status == VN_OK ? domain != NULL : status == VN_NO_MEMORY && domain == NULL);
        vn_domain_release(domain);
        assert_int_equal(vn_byte_count(), 0);
        assert_true(n < 10000);
    }
    assert_true(n > 20);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(basic_shapes_have_their_areas),
        cmocka_unit_test(curves_have_their_areas),
        cmocka_unit_test(absolute_and_relative_commands_agree),
        cmocka_unit_test(compact_numbers_and_flags_are_read),
        cmocka_unit_test(paths_are_drawn_up_to_their_error),
        cmocka_unit_test(transforms_compose),
        cmocka_unit_test(a_page_with_a_physical_width_is_measured_in_millimetres),
        cmocka_unit_test(the_view_box_puts_its_lower_left_at_the_origin),
        cmocka_unit_test(use_draws_what_lies_before_or_behind_it),
        cmocka_unit_test(definitions_are_not_drawn),
        cmocka_unit_test(styles_override_rules_which_override_attributes),
        cmocka_unit_test(unfilled_outlines_count_only_where_nothing_is_filled),
        cmocka_unit_test(an_id_names_a_shape_or_a_group),
        cmocka_unit_test(pick_all_unites_what_is_filled),
        cmocka_unit_test(the_fill_rule_decides_about_holes),
        cmocka_unit_test(outlines_that_cross_are_refused_or_repaired),
        cmocka_unit_test(rounding_is_not_taken_for_a_crossing),
        cmocka_unit_test(crossings_of_rings_are_found_exactly),
        cmocka_unit_test(combining_nothing_gives_nothing),
        cmocka_unit_test(a_long_outline_is_checked_fast),
        cmocka_unit_test(files_of_drawing_programs_load),
        cmocka_unit_test(our_outlines_load),
        cmocka_unit_test(broken_files_are_told_from_each_other),
        cmocka_unit_test(a_doubling_chain_of_uses_ends),
        cmocka_unit_test(wrong_options_are_refused),
        cmocka_unit_test(a_tolerance_is_kept),
        cmocka_unit_test(running_out_of_memory_is_a_clean_failure),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
