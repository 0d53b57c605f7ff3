// The rows that options are read, checked and documented by.
#include "support.h"

#include "domain/domain.h"
#include "draw/canvas.h"
#include "draw/tubes.h"
#include "file/svg.h"
#include "growth/growth.h"

static const vn_schema *const schemas[] = {
    &vn_network_schema, &vn_murray_schema,   &vn_attractors_schema, &vn_throw_schema,   &vn_influence_schema,
    &vn_extend_schema,  &vn_consume_schema,  &vn_disk_schema,       &vn_box_schema,     &vn_profile_schema,
    &vn_none_schema,    &vn_marginal_schema, &vn_isogonic_schema,   &vn_uniform_schema, &vn_rerg_schema,
    &vn_morph_schema,   &vn_canvas_schema,   &vn_fill_schema,       &vn_stroke_schema,  &vn_dots_schema,
    &vn_text_schema,    &vn_svg_schema,      &vn_voxels_schema,
};
enum { SCHEMAS = sizeof schemas / sizeof *schemas };

static bool is_number(const vn_field *field) {
    return field->type == VN_F64 || field->type == VN_I32 || field->type == VN_I64;
}

static void every_default_is_within_its_range(void **state) {
    (void)state;
    for (int s = 0; s < SCHEMAS; s++) {
        for (int i = 0; i < schemas[s]->count; i++) {
            const vn_field *field = &schemas[s]->fields[i];
            if (is_number(field) && !(field->flags & VN_OPTIONAL)) {
                double value = vn_field_number(field, schemas[s]->defaults);
                if (vn_check_number(schemas[s], field, value) != VN_OK) {
                    fail_msg("%s", vn_message());
                }
            }
            assert_true(field->offset < schemas[s]->size);
            assert_true(!is_number(field) || field->min < field->max);
        }
        bool needs_object = false;
        for (int i = 0; i < schemas[s]->count; i++) {
            const vn_field *field = &schemas[s]->fields[i];
            needs_object = needs_object || (field->type == VN_OBJECT && (field->flags & VN_REQUIRED));
        }
        assert_int_equal(vn_check_def(schemas[s], schemas[s]->defaults), needs_object ? VN_INVALID : VN_OK);
    }
}

static void check_line(const char *schema, const char *name, const char *line) {
    size_t length = line != NULL ? strlen(line) : 0;
    if (length == 0 || line[length - 1] == '.' || strchr(line, '\n') != NULL) {
        fail_msg("%s.%s: \"%s\" should be one line without a full stop", schema, name,
                 length > 0 ? line : "");
    }
}

static void every_row_is_documented_in_one_line(void **state) {
    (void)state;
    for (int s = 0; s < SCHEMAS; s++) {
        check_line(schemas[s]->name, "", schemas[s]->doc);
        for (int i = 0; i < schemas[s]->count; i++) {
            const vn_field *field = &schemas[s]->fields[i];
            check_line(schemas[s]->name, field->name, field->doc);
            assert_non_null(field->unit);
            bool has_kind = field->type == VN_OBJECT || field->type == VN_CHOICE || field->type == VN_MIXED;
            assert_true(!has_kind || field->kind != NULL);
            assert_ptr_equal(vn_find_field(schemas[s], field->name), field); // no name twice
        }
    }
    assert_null(vn_find_field(schemas[0], "nonsense"));
}

static void limits_are_refused_with_value_and_remedy(void **state) {
    (void)state;
    for (int s = 0; s < SCHEMAS; s++) {
        for (int i = 0; i < schemas[s]->count; i++) {
            const vn_field *field = &schemas[s]->fields[i];
            if (!is_number(field)) {
                continue;
            }
            assert_int_equal(vn_check_number(schemas[s], field, NAN), VN_INVALID);
            assert_message(field->name);
            assert_int_equal(vn_check_number(schemas[s], field, -INFINITY), VN_INVALID);
            assert_message("must be");
            assert_int_equal(vn_check_number(schemas[s], field, INFINITY), VN_INVALID);
            assert_message("at most");
            bool above = field->flags & VN_ABOVE_MIN;
            assert_int_equal(vn_check_number(schemas[s], field, field->min), above ? VN_INVALID : VN_OK);
            assert_ok(vn_check_number(schemas[s], field, field->max));
        }
    }
}

static void choices_are_found_by_their_words(void **state) {
    (void)state;
    assert_int_equal(vn_choice_index("any|all|tagged", "any"), 0);
    assert_int_equal(vn_choice_index("any|all|tagged", "tagged"), 2);
    assert_int_equal(vn_choice_index("any|all|tagged", "tag"), -1);
    assert_int_equal(vn_choice_index("any|all|tagged", "any|all"), -1);
    assert_int_equal(vn_choice_index("any", ""), -1);
}

static void close_names_are_suggested(void **state) {
    (void)state;
    static const char *const names[] = {"spacing", "clearance", "density", "count", "rng"};
    static const char *const cases[][2] = {
        {"spaceing", "spacing"}, {"denisty", "density"}, {"cuont", "count"}, {"clearence", "clearance"},
        {"Spacing", "spacing"},  {"rgn", "rng"},         {"zebra", NULL},    {"kill_distance", NULL},
        {"counts", "count"}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const char *found = vn_closest_name(cases[k][0], names, 5);
        assert_ptr_equal(found == NULL, cases[k][1] == NULL);
        assert_true(found == NULL || strcmp(found, cases[k][1]) == 0);
    }
    char endless[300];
    memset(endless, 'a', sizeof endless);
    endless[299] = '\0';
    assert_null(vn_closest_name(endless, names, 5));
    assert_null(vn_closest_name("count", names, 0));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(every_default_is_within_its_range),
        counted_test(every_row_is_documented_in_one_line),
        counted_test(limits_are_refused_with_value_and_remedy),
        counted_test(choices_are_found_by_their_words),
        counted_test(close_names_are_suggested),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
