// VTP as other programs write it: every coding of the arrays, lines of any direction, points of their own.
#include "files.h"

#include <zlib.h>

// --- a writer of our own, for what ours does not write

typedef struct coding {
    bool appended, packed, wide, big_endian, small_types;
} coding;

typedef struct page {
    char *text, *tail;
    size_t count, tail_count;
} page;

static void put(page *out, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    // NOLINTNEXTLINE(clang-analyzer-valist.Uninitialized): it was started above
    out->count += (size_t)vsnprintf(out->text + out->count, 1 << 16, format, arguments);
    va_end(arguments);
}

static void put_base64(char *to, size_t *count, const uint8_t *bytes, size_t size) {
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        uint32_t group = (uint32_t)bytes[i] << 16 | (uint32_t)(i + 1 < size ? bytes[i + 1] : 0) << 8 |
                         (i + 2 < size ? bytes[i + 2] : 0);
        for (size_t k = 0; k < 4; k++) {
            to[(*count)++] = k > 1 && i + k > size ? '=' : letters[group >> (18 - 6 * k) & 63];
        }
    }
    to[*count] = '\0';
}

static size_t put_bits(uint8_t *to, uint64_t bits, size_t size, bool big_endian) {
    for (size_t i = 0; i < size; i++) {
        to[big_endian ? size - 1 - i : i] = (uint8_t)(bits >> (8 * i));
    }
    return size;
}

static size_t put_number(uint8_t *to, double value, bool floating, const coding *c) {
    uint64_t bits;
    if (floating && c->small_types) {
        float small = (float)value;
        uint32_t half;
        memcpy(&half, &small, sizeof half);
        return put_bits(to, half, 4, c->big_endian);
    }
    if (floating) {
        memcpy(&bits, &value, sizeof bits);
    } else {
        bits = (uint64_t)(int64_t)value;
    }
    return put_bits(to, bits, c->small_types ? 2 : 8, c->big_endian);
}

// Blocks of so few bytes that there are several.
static void put_packed(char *to, size_t *count, const uint8_t *bytes, size_t size, const coding *c) {
    enum { BLOCK = 40 };
    uint8_t head[4096], body[65536];
    size_t word = c->wide ? 8 : 4, blocks = (size + BLOCK - 1) / BLOCK, head_size = 3 * word, body_size = 0;
    put_bits(head, blocks, word, c->big_endian);
    put_bits(head + word, BLOCK, word, c->big_endian);
    put_bits(head + 2 * word, size % BLOCK, word, c->big_endian);
    for (size_t i = 0; i < blocks; i++) {
        uLongf packed = sizeof body - body_size;
        size_t length = size - i * BLOCK < BLOCK ? size - i * BLOCK : BLOCK;
        assert_int_equal(compress(body + body_size, &packed, bytes + i * BLOCK, length), Z_OK);
        head_size += put_bits(head + head_size, packed, word, c->big_endian);
        body_size += packed;
    }
    put_base64(to, count, head, head_size);
    put_base64(to, count, body, body_size);
}

static void put_array(page *out, const char *name, int components, const double *values, size_t count,
                      bool floating, const coding *c) {
    uint8_t bytes[16384];
    size_t word = c->wide ? 8 : 4, size = word;
    for (size_t i = 0; i < count; i++) {
        size += put_number(bytes + size, values[i], floating, c);
    }
    put_bits(bytes, size - word, word, c->big_endian);
    put(out, "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"%s\"",
        floating ? (c->small_types ? "Float32" : "Float64") : (c->small_types ? "Int16" : "Int64"), name,
        components, c->appended ? "appended" : "binary");
    if (c->appended) {
        put(out, " offset=\"%zu\"/>\n", out->tail_count);
    } else {
        put(out, ">\n<InformationKey name=\"range\">7</InformationKey>\n");
    }
    char *to = c->appended ? out->tail : out->text;
    size_t *at = c->appended ? &out->tail_count : &out->count;
    if (c->packed) {
        put_packed(to, at, bytes + word, size - word, c);
    } else {
        put_base64(to, at, bytes, size);
    }
    if (!c->appended) {
        put(out, "\n</DataArray>\n");
    }
}

// A Y of five points: 0 to 1 to 2, and 1 to 3 to 4. All its numbers are exact in 32 bits.
static void write_y_from(const char *path, const coding *c, double first) {
    static const double points[] = {0, 0, 0, 0, 1, 0.5, -1, 2, 0, 1, 2, 0, 1.5, 3, -8};
    static const double radius[] = {3, 3, 1, 2, 0.5}, ends[] = {3, 6};
    const double lines[] = {first, 1, 2, 1, 3, 4};
    page out = {calloc(1 << 18, 1), calloc(1 << 18, 1), 0, 0};
    put(&out,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" byte_order=\"%s\" "
        "header_type=\"%s\"%s>\n<PolyData>\n",
        c->big_endian ? "BigEndian" : "LittleEndian", c->wide ? "UInt64" : "UInt32",
        c->packed ? " compressor=\"vtkZLibDataCompressor\"" : "");
    put(&out, "<Piece NumberOfPoints=\"5\" NumberOfLines=\"2\">\n<PointData>\n");
    put_array(&out, "Normals", 3, points, 15, true, c);
    put_array(&out, "MaximumInscribedSphereRadius", 1, radius, 5, true, c);
    put(&out, "</PointData>\n<Points>\n");
    put_array(&out, "p", 3, points, 15, true, c);
    put(&out, "</Points>\n<Lines>\n");
    put_array(&out, "connectivity", 1, lines, 6, false, c);
    put_array(&out, "offsets", 1, ends, 2, false, c);
    put(&out, "</Lines>\n</Piece>\n</PolyData>\n");
    if (c->appended) {
        put(&out, "<AppendedData encoding=\"base64\">\n_%s\n</AppendedData>\n", out.tail);
    }
    put(&out, "</VTKFile>\n");
    put_file(path, out.text, out.count);
    free(out.text);
    free(out.tail);
}

static void write_y(const char *path, const coding *c) {
    write_y_from(path, c, 0);
}

static void assert_y(const char *path) {
    static const double x[] = {0, 0, -1, 1, 1.5}, z[] = {0, 0.5, 0, 0, -8}, radius[] = {3, 3, 1, 2, 0.5};
    static const int32_t parents[] = {-1, 0, 1, 1, 3};
    vn_network *network = load_one(path);
    assert_int_equal(vn_network_count(network), 5);
    assert_int_equal(vn_network_dim(network), 3);
    for (int i = 0; i < 5; i++) {
        assert_true(vn_network_x(network)[i] == x[i] && vn_network_z(network)[i] == z[i]);
        assert_int_equal(vn_network_parent(network)[i], parents[i]);
        assert_near(vn_network_radius(network, i), radius[i], 0);
    }
    vn_network_destroy(network);
}

static void every_coding_is_read(void **state) {
    (void)state;
    for (unsigned bits = 0; bits < 32; bits++) {
        coding c = {(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0, (bits & 16) != 0};
        write_y(in_folder("a.vtp"), &c);
        assert_y(in_folder("a.vtp"));
        vn_network_set set;
        write_y_from(in_folder("a.vtp"), &c, -1);
        assert_int_equal(vn_networks_load(&set, in_folder("a.vtp")), VN_IO);
        assert_message("a line has point -1, but there are 5 points");
    }
}

static void cut_off_arrays_are_refused(void **state) {
    (void)state;
    for (unsigned bits = 0; bits < 4; bits++) {
        coding c = {(bits & 1) != 0, (bits & 2) != 0, false, false, false};
        size_t size;
        write_y(in_folder("a.vtp"), &c);
        char *text = take_file(in_folder("a.vtp"), &size);
        for (size_t cut = 0; cut + 2 < size; cut++) {
            vn_network_set set;
            put_file(in_folder("cut.vtp"), text, cut);
            assert_int_equal(vn_networks_load(&set, in_folder("cut.vtp")), VN_IO);
            assert_message("cut.vtp: ");
        }
        free(text);
    }
}

// Random bytes in place of random bytes: whatever comes of it, it is a network or a message.
static void spoiled_arrays_do_no_harm(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(7);
    int refused = 0;
    for (int round = 0; round < 2000; round++) {
        coding c = {(round & 1) != 0, (round & 2) != 0, (round & 4) != 0, false, (round & 8) != 0};
        size_t size;
        write_y(in_folder("a.vtp"), &c);
        char *text = take_file(in_folder("a.vtp"), &size);
        for (int i = 0; i < 3; i++) {
            text[whole(&rng, 0, (int64_t)size - 1)] = (char)whole(&rng, 33, 126);
        }
        vn_network_set set;
        put_file(in_folder("cut.vtp"), text, size);
        vn_status status = vn_networks_load(&set, in_folder("cut.vtp"));
        assert_true(status == VN_OK || status == VN_IO);
        refused += status != VN_OK;
        vn_networks_free(&set);
        free(text);
    }
    assert_true(refused > 500);
}

#define HEAD "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"%d\">"
#define POINTS                                                                                               \
    "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">%s</DataArray></Points>"
#define LINES                                                                                                \
    "<Lines><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">%s</DataArray>"                 \
    "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">%s</DataArray></Lines>"
#define END "</Piece></PolyData></VTKFile>"

static vn_network *network_from(int points, const char *coordinates, const char *lines, const char *ends) {
    char text[4096];
    int size = snprintf(text, sizeof text, HEAD POINTS LINES END, points, coordinates, lines, ends);
    put_file(in_folder("a.vtp"), text, (size_t)size);
    return load_one(in_folder("a.vtp"));
}

// Two lines from one inlet to two outlets, each with points of its own; they part at (0, 2).
static void lines_that_share_no_points_are_joined_by_place(void **state) {
    (void)state;
    vn_network *network =
        network_from(8, "0 0 0 0 1 0 0 2 0 -1 3 0  0 0 0 0 1 0 0 2 0 1 3 0", "0 1 2 3 4 5 6 7", "4 8");
    static const int32_t parents[] = {-1, 0, 1, 2, 2};
    assert_int_equal(vn_network_count(network), 5);
    assert_int_equal(vn_network_join_count(network), 0);
    for (int i = 0; i < 5; i++) {
        assert_int_equal(vn_network_parent(network)[i], parents[i]);
    }
    vn_network_destroy(network);
}

static void lines_may_run_either_way(void **state) {
    (void)state;
    vn_network *network = network_from(4, "0 0 0 0 1 0 -1 2 0 1 2 0", "0 1 2 1 3 1", "2 4 6");
    static const int32_t parents[] = {-1, 0, 1, 1};
    assert_int_equal(vn_network_dim(network), 2);
    assert_int_equal(vn_network_join_count(network), 0);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(vn_network_parent(network)[i], parents[i]);
    }
    vn_network_destroy(network);
}

static void loops_become_joins_and_idle_points_go(void **state) {
    (void)state;
    vn_network *network = network_from(5, "9 9 9 0 0 0 1 0 0 1 1 0 0 1 0", "1 2 3 4 1", "5");
    assert_int_equal(vn_network_count(network), 4);
    assert_int_equal(vn_network_join_count(network), 1);
    vn_network_destroy(network);
}

static void assert_holds(const char *path, const char *part) {
    size_t size;
    char *text = take_file(path, &size);
    if (strstr(text, part) == NULL) {
        fail_msg("no \"%s\" in:\n%s", part, text);
    }
    free(text);
}

// Else each would be drawn as a cone.
static void laterals_and_joins_begin_at_their_own_radius(void **state) {
    (void)state;
    vn_network *network = network_of(2);
    put_root(network, 0, 10, 0);
    put_child(network, 0, 0, 6, 0);
    put_child(network, 1, 3, 2, 0);
    put_child(network, 1, -1, 2, 0);
    assert_ok(vn_network_set_radii(network, (double[]){0.5, 0.5, 0.5, 0.25}));
    assert_ok(vn_network_join(network, 2, 3, 0.25));
    save_one(network, in_folder("a.vtp"), NULL);
    assert_holds(in_folder("a.vtp"), "NumberOfPoints=\"6\" NumberOfVerts=\"0\" NumberOfLines=\"4\"");
    assert_holds(in_folder("a.vtp"), "format=\"ascii\">\n0 1\n1 2\n4 3\n5 3 \n</DataArray>");
    assert_holds(in_folder("a.vtp"), "Name=\"Radius\" format=\"ascii\">\n0.5\n0.5\n0.5\n0.25\n0.25\n0.25\n<");
    assert_holds(in_folder("a.vtp"), "Name=\"Node\" format=\"ascii\">\n0\n1\n2\n3\n1\n2\n<");
    assert_holds(in_folder("a.vtp"), "0 6 0\n3 2 0\n</DataArray>");
    vn_network *again = load_one(in_folder("a.vtp"));
    assert_same_network(network, again, ALL);
    vn_network_destroy(network);
    vn_network_destroy(again);
}

// A text of more than libxml2 keeps in one piece.
static void long_arrays_are_no_matter(void **state) {
    (void)state;
    enum { NODES = 900000 };
    vn_network *network = network_of(3);
    put_root(network, 0.123456789, 0, 0);
    for (int32_t i = 1; i < NODES; i++) {
        put_child(network, i - 1, i * 0.123456789, i * 1e-7, -i);
    }
    save_one(network, in_folder("a.vtp"), NULL);
    vn_network *again = load_one(in_folder("a.vtp"));
    assert_same_network(network, again, ALL);
    vn_network_destroy(network);
    vn_network_destroy(again);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(every_coding_is_read),
        counted_test(cut_off_arrays_are_refused),
        counted_test(spoiled_arrays_do_no_harm),
        counted_test(lines_that_share_no_points_are_joined_by_place),
        counted_test(lines_may_run_either_way),
        counted_test(loops_become_joins_and_idle_points_go),
        counted_test(laterals_and_joins_begin_at_their_own_radius),
        counted_test(long_arrays_are_no_matter),
    };
    return cmocka_run_group_tests(tests, make_folder, drop_folder);
}
