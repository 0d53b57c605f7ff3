// The ground floor: memory, text, numbers, sorting, randomness and files that appear whole.
#define _DEFAULT_SOURCE
#include "support.h"

#include "base/parallel.h"
#include "base/sink.h"
#include "base/sort.h"
#include "base/text.h"

#include <locale.h>
#include <sys/stat.h>
#include <unistd.h>

// ---- Memory ----

static void the_allocator_counts_every_byte(void **state) {
    (void)state;
    size_t before = vn_byte_count();
    char *block = vn_resize(NULL, 0, 100);
    vn_byte_peak_reset();
    assert_true(vn_byte_count() == before + 100 && vn_byte_peak() == before + 100);
    block = vn_resize(block, 100, 5000);
    assert_true(vn_byte_count() == before + 5000 && vn_byte_peak() == before + 5000);
    block = vn_resize(block, 5000, 10);
    assert_true(vn_byte_count() == before + 10 && vn_byte_peak() == before + 5000);
    assert_null(vn_resize(block, 10, 0));
    assert_true(vn_byte_count() == before);
    vn_byte_peak_reset();
    assert_true(vn_byte_peak() == before);
    assert_null(vn_resize(NULL, 0, 0));
}

static void a_budget_refuses_what_is_above_it(void **state) {
    (void)state;
    vn_set_memory_budget(vn_byte_count() + 1000);
    char *block = vn_resize(NULL, 0, 1000);
    assert_non_null(block);
    assert_null(vn_resize(NULL, 0, 1));
    assert_null(vn_resize(block, 1000, 1001));
    block = vn_resize(block, 1000, 500);
    char *other = vn_resize(NULL, 0, 500);
    assert_non_null(other);
    vn_set_memory_budget(0);
    block = vn_resize(block, 500, 100000);
    assert_non_null(block);
    vn_resize(block, 100000, 0);
    vn_resize(other, 500, 0);
}

static void allocations_fail_from_the_nth_on(void **state) {
    (void)state;
    void *blocks[3];
    vn_fail_allocations_from(2);
    blocks[0] = vn_resize(NULL, 0, 8);
    blocks[1] = vn_resize(NULL, 0, 8);
    blocks[2] = vn_resize(NULL, 0, 8);
    assert_true(blocks[0] != NULL && blocks[1] != NULL && blocks[2] == NULL);
    assert_null(vn_resize(blocks[0], 8, 16));
    blocks[0] = vn_resize(blocks[0], 8, 4); // shrinking never fails
    assert_non_null(blocks[0]);
    vn_fail_allocations_from(-1);
    vn_resize(blocks[0], 4, 0);
    vn_resize(blocks[1], 8, 0);
}

static void arrays_grow_and_fail_cleanly(void **state) {
    (void)state;
    VN_ARRAY(int32_t) numbers = {0};
    for (int32_t i = 0; i < 5000; i++) {
        assert_ok(vn_array_push(&numbers, i));
    }
    vn_fail_allocations_from(0);
    assert_int_equal(vn_array_reserve(&numbers, numbers.capacity + 1), VN_NO_MEMORY);
    vn_fail_allocations_from(-1);
    int64_t too_many = (int64_t)1 << 31;
    assert_int_equal(vn_array_reserve(&numbers, too_many), VN_LIMIT);
    for (int32_t i = 0; i < 5000; i++) {
        assert_int_equal(numbers.data[i], i);
    }
    assert_ok(vn_array_zero(&numbers, 70));
    assert_true(numbers.count == 70 && numbers.data[69] == 0);
    vn_array_free(&numbers);
    assert_null(numbers.data);
    assert_ok(vn_array_zero(&numbers, 0));
}

static void statuses_end_programs_as_promised(void **state) {
    (void)state;
    static const int expected[] = {0, 1, 3, 4, 5, 5, 130, 1, 1};
    for (int status = VN_OK; status <= VN_CALLBACK; status++) {
        assert_int_equal(vn_exit_status((vn_status)status), expected[status]);
    }
    assert_int_equal(vn_fail(VN_IO, "%s: %d", "what", 7), VN_IO);
    assert_string_equal(vn_message(), "what: 7");
    vn_interrupt();
    assert_int_equal(vn_poll(), VN_INTERRUPTED);
    assert_ok(vn_poll());
    vn_set_time_budget(1e-6);
    usleep(2000);
    assert_int_equal(vn_poll(), VN_LIMIT);
    assert_message("--time");
    vn_set_time_budget(0);
    assert_ok(vn_poll());
}

// ---- Numbers and text ----

static void numbers_read_back_bit_for_bit(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(1);
    for (int n = 0; n < 200000; n++) {
        uint64_t bits = (uint64_t)whole(&rng, INT64_MIN, INT64_MAX);
        double value, back;
        char text[VN_NUMBER_SIZE];
        memcpy(&value, &bits, sizeof value);
        int length = vn_format_number(text, value);
        assert_true(length == (int)strlen(text) && length < VN_NUMBER_SIZE);
        if (isfinite(value)) {
            assert_ptr_equal(vn_parse_number(text, text + length, &back), text + length);
            assert_memory_equal(&back, &value, sizeof value);
            assert_true(strtod(text, NULL) == value);
        }
    }
}

static void numbers_are_as_short_as_can_be(void **state) {
    (void)state;
    static const struct {
        double value;
        const char *text;
    } cases[] = {{0.1, "0.1"}, {1e300, "1e+300"}, {-2.5, "-2.5"}, {0, "0"}, {1.0 / 3, "0.3333333333333333"},
                 {12, "12"}};
    char text[VN_NUMBER_SIZE];
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        vn_format_number(text, cases[k].value);
        assert_string_equal(text, cases[k].text);
    }
    assert_int_equal(vn_format_number(text, NAN), 3);
}

static void rounded_numbers_have_no_needless_signs(void **state) {
    (void)state;
    static const struct {
        double value;
        int decimals;
        const char *text;
    } cases[] = {{12.5, 3, "12.5"},     {-3, 2, "-3"},   {-0.0001, 2, "0"},  {0.125, 2, "0.12"},
                 {99.999, 2, "100"},    {100, 0, "100"}, {1200, 2, "1200"},  {-0.0, 0, "0"},
                 {1.05, 15, "1.05"},    {0.5, 0, "0"},   {1e15, 2, "1e+15"}, {-7.25, 1, "-7.2"},
                 {2.0 / 3, 4, "0.6667"}};
    char text[VN_NUMBER_SIZE];
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        assert_int_equal(vn_format_rounded(text, cases[k].value, cases[k].decimals), strlen(cases[k].text));
        assert_string_equal(text, cases[k].text);
    }
    assert_true(vn_format_rounded(text, -123456789012345.678, 15) < VN_NUMBER_SIZE);
}

static const char *rest_of(const char *text, double *value) {
    return vn_parse_number(text, text + strlen(text), value);
}

static void numbers_end_where_they_end(void **state) {
    (void)state;
    static const char *const wrong[] = {"",   "+",  "-",   ".",  "inf",   "nan", "-inf",
                                        "x1", "e5", "+-1", " 1", "1e999", "--1"};
    double value;
    assert_string_equal(rest_of("1.5e2mm", &value), "mm");
    assert_true(value == 150);
    assert_string_equal(rest_of("+.5-3", &value), "-3");
    assert_true(value == 0.5);
    assert_string_equal(rest_of("0x10", &value), "x10");
    assert_string_equal(rest_of("3,5", &value), ",5");
    assert_string_equal(rest_of("1.2.3", &value), ".3");
    assert_string_equal(rest_of("7e", &value), "e");
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        assert_null(rest_of(wrong[k], &value));
    }
    assert_null(vn_parse_number("12", "12", &value));
}

static void no_locale_changes_a_number(void **state) {
    (void)state;
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de_DE"};
    char text[VN_NUMBER_SIZE];
    double value;
    for (int k = 0; k < 4 && setlocale(LC_ALL, names[k]) == NULL; k++) {
    }
    vn_format_rounded(text, 2.25, 2);
    assert_string_equal(text, "2.25");
    assert_string_equal(rest_of("2.25", &value), "");
    assert_true(value == 2.25);
    setlocale(LC_ALL, "C");
}

static void text_is_quoted_for_json(void **state) {
    (void)state;
    static const char *const cases[][2] = {
        {"", "\"\""},
        {"a\"b\\c", "\"a\\\"b\\\\c\""},
        {"\n\t\x7F", "\"\\u000a\\u0009\\u007f\""},
        {"\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x8D\x83", "\"\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x8D\x83\""},
        {"\xFFz", "\"\xEF\xBF\xBDz\""},
        {"\xC3", "\"\xEF\xBF\xBD\""},
        {"\xC0\xAF", "\"\xEF\xBF\xBD\xEF\xBF\xBD\""},
        {"\xE2\x82", "\"\xEF\xBF\xBD\xEF\xBF\xBD\""},
        {"\xED\xA0\x80", "\"\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD\""},
        {"\xF4\x90\x80\x80", "\"\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD\""},
        {"\xE0\x80\x80", "\"\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD\""}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        vn_text text = {0};
        assert_ok(vn_text_json(&text, cases[k][0]));
        assert_string_equal(text.data, cases[k][1]);
        vn_array_free(&text);
    }
}

static void text_grows(void **state) {
    (void)state;
    vn_text text = {0};
    for (int i = 0; i < 300; i++) {
        assert_ok(vn_text_print(&text, "%d,", i % 10));
    }
    assert_ok(vn_text_number(&text, 0.5));
    assert_ok(vn_text_append(&text, "!", 1));
    assert_int_equal(text.count, 604);
    assert_string_equal(text.data + 598, "9,0.5!");
    vn_array_free(&text);
}

// ---- Sorting and randomness ----

static int by_key(const void *a, const void *b) {
    const vn_keyed *x = a, *y = b;
    int order = (x->key > y->key) - (x->key < y->key);
    return order != 0 ? order : x->value - y->value;
}

static void sorting_is_stable_and_right(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(4);
    vn_keyed_array array = {0}, expected = {0}, scratch = {0};
    for (int round = 0; round < 150; round++) {
        int32_t count = (int32_t)whole(&rng, 0, round % 3 == 0 ? 5000 : 130);
        int bits = (int)whole(&rng, 0, 63);
        array.count = expected.count = 0;
        for (int32_t i = 0; i < count; i++) {
            uint64_t key = vn_hash(1, (uint64_t)round, (uint64_t)i, 0) >> bits;
            assert_ok(vn_array_push(&array, ((vn_keyed){key, i})));
            assert_ok(vn_array_push(&expected, ((vn_keyed){key, i})));
        }
        assert_ok(vn_sort_keyed(&array, &scratch));
        if (count > 0) {
            qsort(expected.data, (size_t)count, sizeof *expected.data, by_key);
        }
        for (int32_t i = 0; i < count; i++) {
            assert_true(array.data[i].key == expected.data[i].key &&
                        array.data[i].value == expected.data[i].value);
        }
    }
    vn_array_free(&array);
    vn_array_free(&expected);
    vn_array_free(&scratch);
}

static void uniform_numbers_fill_their_range(void **state) {
    (void)state;
    enum { DRAWS = 200000 };
    vn_rng rng = vn_rng_make(11);
    double sum = 0, squares = 0, normal = 0, spread = 0;
    for (int n = 0; n < DRAWS; n++) {
        double u = vn_rng_uniform(&rng, -1, 3), g = vn_rng_normal(&rng, 2, 3);
        assert_true(u >= -1 && u < 3 && isfinite(g));
        sum += u;
        squares += (u - 1) * (u - 1);
        normal += g;
        spread += (g - 2) * (g - 2);
    }
    assert_near(sum / DRAWS, 1, 5 * 4 / sqrt(12.0 * DRAWS));
    assert_near(squares / DRAWS, 16.0 / 12, 0.02);
    assert_near(normal / DRAWS, 2, 5 * 3 / sqrt(DRAWS));
    assert_near(spread / DRAWS, 9, 0.2);
    assert_true(vn_random_at(11, 0, 0) == (vn_rng_uniform(&(vn_rng){.seed = 11}, 0, 1)));
}

static void integers_have_no_bias(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(12);
    int hits[7] = {0}, low = 0;
    for (int n = 0; n < 70000; n++) {
        hits[vn_rng_integer(&rng, -3, 3) + 3]++;
        low += vn_rng_integer(&rng, 0, (INT64_C(3) << 61) - 1) < INT64_C(3) << 60; // 3/8 of all
    }
    double chi2 = 0;
    for (int k = 0; k < 7; k++) {
        chi2 += pow(hits[k] - 10000, 2) / 10000;
    }
    assert_true(chi2 < 30);
    assert_near(low / 70000.0, 0.5, 0.01);
    assert_int_equal(vn_rng_integer(&rng, 5, 5), 5);
    int64_t any = vn_rng_integer(&rng, INT64_MIN, INT64_MAX);
    assert_true(any != vn_rng_integer(&rng, INT64_MIN, INT64_MAX));
}

static double correlation(vn_rng a, vn_rng b) {
    double sum = 0;
    for (int n = 0; n < 20000; n++) {
        sum += vn_rng_uniform(&a, -1, 1) * vn_rng_uniform(&b, -1, 1);
    }
    return fabs(sum) / 20000 * 3;
}

static void streams_and_forks_are_independent(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(1), same = rng;
    vn_rng fork = vn_rng_fork(&rng), second = vn_rng_fork(&rng);
    assert_int_equal(rng.counter, 2);
    assert_true(correlation(fork, second) < 0.04 && correlation(rng, fork) < 0.04);
    assert_true(correlation(vn_rng_make(1), vn_rng_make(2)) < 0.04);
    assert_true(correlation((vn_rng){1, 0, 0}, (vn_rng){1, 1, 0}) < 0.04);
    vn_rng again = vn_rng_fork(&same);
    assert_memory_equal(&again, &fork, sizeof fork);
    assert_true(vn_rng_uniform(&again, 0, 1) == vn_random_at(1, fork.stream, 0));
}

static void mark(int64_t begin, int64_t end, void *payload) {
    for (int64_t i = begin; i < end; i++) {
        ((char *)payload)[i]++;
    }
}

static void a_parallel_loop_visits_each_index_once(void **state) {
    (void)state;
    for (int threads = 1; threads <= 8; threads *= 2) {
        char visits[1003] = {0};
        vn_set_threads(threads);
        vn_parallel_for(1003, 10, mark, visits);
        vn_parallel_for(0, 10, mark, visits);
        for (int i = 0; i < 1003; i++) {
            assert_int_equal(visits[i], 1);
        }
    }
    vn_set_threads(0);
}

// ---- Files ----

static void assert_content(const char *path, const char *content) {
    char text[64] = "";
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    assert_string_equal(text, content);
}

static vn_status write_file(const char *path, const char *content, vn_status end) {
    vn_sink *sink = NULL;
    VN_TRY(vn_sink_open(&sink, path));
    vn_sink_print(sink, "%s ", content);
    vn_sink_number(sink, 0.1);
    vn_sink_write(sink, " ", 1);
    vn_sink_rounded(sink, 2.499, 1);
    return vn_sink_close(sink, end);
}

static void a_file_appears_whole_or_not_at_all(void **state) {
    (void)state;
    char folder[] = "test_base_XXXXXX", path[64];
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/file.txt", folder);
    assert_int_equal(write_file(path, "no", VN_LIMIT), VN_LIMIT);
    assert_int_equal(access(path, F_OK), -1);
    assert_ok(write_file(path, "one", VN_OK));
    assert_content(path, "one 0.1 2.5");
    assert_int_equal(write_file(path, "two", VN_INTERRUPTED), VN_INTERRUPTED);
    assert_content(path, "one 0.1 2.5");
    assert_ok(write_file(path, "three", VN_OK));
    assert_content(path, "three 0.1 2.5");
    remove(path);
    assert_int_equal(rmdir(folder), 0); // nothing else was left in it
    assert_int_equal(vn_sink_close(NULL, VN_LIMIT), VN_LIMIT);
}

static void what_cannot_be_written_is_said_at_once(void **state) {
    (void)state;
    char folder[] = "test_base_XXXXXX", path[64];
    assert_non_null(mkdtemp(folder));
    assert_int_equal(write_file(folder, "x", VN_OK), VN_IO);
    assert_message("is a folder");
    snprintf(path, sizeof path, "%s/missing/file", folder);
    assert_int_equal(write_file(path, "x", VN_OK), VN_IO);
    assert_message("cannot be written: No such file");
    snprintf(path, sizeof path, "%s/file", folder);
    assert_int_equal(chmod(folder, 0555), 0);
    if (geteuid() != 0) { // whom no folder refuses
        assert_int_equal(write_file(path, "x", VN_OK), VN_IO);
        assert_message("Permission denied");
    }
    chmod(folder, 0755);
    vn_sink *sink = (vn_sink *)&state;
    for (int64_t n = 0; n < 3; n++) {
        vn_fail_allocations_from(n);
        assert_int_equal(vn_sink_open(&sink, path), VN_NO_MEMORY);
        vn_fail_allocations_from(-1);
        assert_null(sink);
    }
    remove(path);
    assert_int_equal(rmdir(folder), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(the_allocator_counts_every_byte),
        counted_test(a_budget_refuses_what_is_above_it),
        counted_test(allocations_fail_from_the_nth_on),
        counted_test(arrays_grow_and_fail_cleanly),
        counted_test(statuses_end_programs_as_promised),
        counted_test(numbers_read_back_bit_for_bit),
        counted_test(numbers_are_as_short_as_can_be),
        counted_test(rounded_numbers_have_no_needless_signs),
        counted_test(numbers_end_where_they_end),
        counted_test(no_locale_changes_a_number),
        counted_test(text_is_quoted_for_json),
        counted_test(text_grows),
        counted_test(sorting_is_stable_and_right),
        counted_test(uniform_numbers_fill_their_range),
        counted_test(integers_have_no_bias),
        counted_test(streams_and_forks_are_independent),
        counted_test(a_parallel_loop_visits_each_index_once),
        counted_test(a_file_appears_whole_or_not_at_all),
        counted_test(what_cannot_be_written_is_said_at_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
