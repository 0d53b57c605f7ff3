// Networks as JSON files: exact both ways, and strict about files that say what cannot be.
#define _DEFAULT_SOURCE // mkdtemp
#include "base/memory.h"
#include "network/network.h"
#include "venule/output.h"

#include <dirent.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

static char folder[] = "/tmp/venule-json-XXXXXX";

static const char *in_folder(const char *name) {
    static char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static int make_folder(void **state) {
    (void)state;
    return mkdtemp(folder) != NULL ? mkdir(in_folder("folder.json"), 0700) : -1;
}

static int drop_folder(void **state) {
    (void)state;
    static const char *const names[] = {"a.json", "b.json", "lie.json"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        unlink(in_folder(names[i]));
    }
    return rmdir(in_folder("folder.json")) | rmdir(folder);
}

static void write_file(const char *path, const char *text, size_t size) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

// The bytes of a file with a zero byte after them; freed by the caller.
static char *read_file(const char *path) {
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    long size = ftell(file);
    rewind(file);
    char *bytes = calloc((size_t)size + 1, 1);
    assert_int_equal(fread(bytes, 1, (size_t)size, file), size);
    fclose(file);
    return bytes;
}

static void assert_same_files(const char *a, const char *b) {
    char *left = read_file(a);
    char path[128];
    snprintf(path, sizeof path, "%s", b);
    char *right = read_file(path);
    assert_string_equal(left, right);
    free(left);
    free(right);
}

static vn_network *random_network(int dim, uint64_t seed, int32_t count) {
    vn_network_def def = vn_network_def_default();
    def.dim = dim;
    def.unit = "mm";
    vn_network *network;
    assert_int_equal(vn_network_create(&network, &def), VN_OK);
    vn_rng rng = vn_rng_make(seed);
    for (int32_t i = 0; i < count; i++) {
        double exponent = vn_rng_uniform(&rng, -30, 30);
        double p[3] = {vn_rng_uniform(&rng, -1, 1) * pow(10, exponent), vn_rng_uniform(&rng, 0, 100),
                       dim == 3 ? vn_rng_normal(&rng, 0, 1) : 0};
        vn_network_set_step(network, i / 10);
        bool root = i == 0 || vn_rng_integer(&rng, 0, 40) == 0;
        int32_t parent = root ? -1 : (int32_t)vn_rng_integer(&rng, 0, i - 1);
        assert_int_equal(root ? vn_network_root(network, p, NULL) : vn_network_add(network, parent, p, NULL),
                         VN_OK);
    }
    return network;
}

static void add_random_joins(vn_network *network, uint64_t seed, int32_t tries) {
    vn_rng rng = vn_rng_make(seed);
    int32_t last = vn_network_count(network) - 1;
    for (int32_t i = 0; i < tries; i++) {
        int32_t a = (int32_t)vn_rng_integer(&rng, 0, last), b = (int32_t)vn_rng_integer(&rng, 0, last);
        vn_network_join(network, a, b, vn_rng_uniform(&rng, 0, 2)); // refused where they are neighbours
    }
}

static vn_network *load_one(const char *path) {
    vn_network_set set;
    vn_status status = vn_networks_load(&set, path);
    if (status != VN_OK) {
        fail_msg("%s", vn_message());
    }
    assert_int_equal(set.count, 1);
    assert_string_equal(set.names[0], "");
    vn_network *network = set.networks[0];
    set.networks[0] = NULL;
    vn_networks_free(&set);
    return network;
}

static void assert_same_columns(const vn_network *a, const vn_network *b) {
    size_t count = (size_t)vn_network_count(a);
    assert_int_equal(vn_network_dim(a), vn_network_dim(b));
    assert_int_equal(vn_network_count(a), vn_network_count(b));
    assert_string_equal(vn_network_unit(a), vn_network_unit(b));
    assert_memory_equal(vn_network_x(a), vn_network_x(b), count * sizeof(double));
    assert_memory_equal(vn_network_y(a), vn_network_y(b), count * sizeof(double));
    if (vn_network_dim(a) == 3) {
        assert_memory_equal(vn_network_z(a), vn_network_z(b), count * sizeof(double));
    }
    assert_memory_equal(vn_network_parent(a), vn_network_parent(b), count * sizeof(int32_t));
    assert_memory_equal(vn_network_tree(a), vn_network_tree(b), count * sizeof(int32_t));
    assert_memory_equal(vn_network_birth(a), vn_network_birth(b), count * sizeof(int32_t));
    assert_int_equal(vn_network_has_radii(a), vn_network_has_radii(b));
    for (int32_t i = 0; i < vn_network_count(a); i++) {
        assert_true(vn_network_radius(a, i) == vn_network_radius(b, i));
    }
}

static void assert_same_joins(const vn_network *a, const vn_network *b) {
    assert_int_equal(vn_network_join_count(a), vn_network_join_count(b));
    for (int32_t i = 0; i < vn_network_join_count(a); i++) {
        int32_t ends[4];
        double radii[2];
        vn_network_join_ends(a, i, &ends[0], &ends[1], &radii[0]);
        vn_network_join_ends(b, i, &ends[2], &ends[3], &radii[1]);
        assert_int_equal(ends[0], ends[2]);
        assert_int_equal(ends[1], ends[3]);
        assert_true(radii[0] == radii[1]);
    }
}

// Save, load, compare, save again, compare the bytes. Destroys the network.
static void check_round_trip(vn_network *network) {
    assert_int_equal(vn_network_save(network, in_folder("a.json"), "{\"seed\": 7}"), VN_OK);
    vn_network *again = load_one(in_folder("a.json"));
    assert_same_columns(network, again);
    assert_same_joins(network, again);
    vn_network_destroy(network);
    assert_int_equal(vn_network_save(again, in_folder("b.json"), "{\"seed\": 7}"), VN_OK);
    assert_same_files(in_folder("a.json"), in_folder("b.json"));
    vn_network_destroy(again);
}

static void a_round_trip_is_exact(void **state) {
    (void)state;
    size_t before = vn_byte_count();
    for (uint64_t seed = 0; seed < 20; seed++) {
        vn_network *network = random_network(seed % 2 == 0 ? 2 : 3, seed, 1 + (int32_t)(seed * seed * 17));
        if (seed > 3) {
            add_random_joins(network, seed, 30);
        }
        check_round_trip(network);
    }
    assert_int_equal(vn_byte_count(), before);
}

static void an_empty_network_survives(void **state) {
    (void)state;
    check_round_trip(random_network(2, 1, 0));
    check_round_trip(random_network(3, 1, 0));
}

static void the_law_of_the_radii_survives(void **state) {
    (void)state;
    vn_network *network = random_network(3, 5, 500);
    vn_murray_def def = {.exponent = 2.55, .tip_radius = 0.1};
    assert_int_equal(vn_network_murray(network, &def), VN_OK);
    assert_int_equal(vn_network_save(network, in_folder("a.json"), NULL), VN_OK);
    vn_network *again = load_one(in_folder("a.json"));
    vn_murray_def found;
    assert_true(vn_network_murray_get(again, &found));
    assert_true(found.exponent == def.exponent && found.tip_radius == def.tip_radius);
    vn_network_destroy(again);
    check_round_trip(network);
}

static void given_radii_survive(void **state) {
    (void)state;
    vn_network *network = random_network(2, 6, 300);
    double radii[300];
    for (int i = 0; i < 300; i++) {
        radii[i] = i / 7.0;
    }
    assert_int_equal(vn_network_set_radii(network, radii), VN_OK);
    check_round_trip(network);
}

static void computed_orders_survive(void **state) {
    (void)state;
    static const vn_order_kind kinds[] = {VN_STRAHLER, VN_HORTON, VN_HICKEY};
    for (int i = 0; i < 3; i++) {
        vn_network *network = random_network(2, 9, 400);
        assert_int_equal(vn_network_set_orders(network, kinds[i]), VN_OK);
        check_round_trip(network);
    }
}

static void several_networks_share_a_file(void **state) {
    (void)state;
    static const char *const names[] = {"arteries", "veins \"old\"\n", "é"};
    vn_network *networks[3];
    for (int i = 0; i < 3; i++) {
        networks[i] = random_network(2 + i % 2, (uint64_t)i, 50);
        add_random_joins(networks[i], (uint64_t)i, 5);
    }
    const vn_network *const *given = (const vn_network *const *)networks;
    assert_int_equal(vn_networks_save(given, names, 3, in_folder("a.json"), NULL), VN_OK);
    vn_network_set set;
    assert_int_equal(vn_networks_load(&set, in_folder("a.json")), VN_OK);
    assert_int_equal(set.count, 3);
    for (int i = 0; i < 3; i++) {
        assert_string_equal(set.names[i], names[i]);
        assert_same_columns(networks[i], set.networks[i]);
        assert_same_joins(networks[i], set.networks[i]);
        vn_network_destroy(networks[i]);
    }
    given = (const vn_network *const *)set.networks;
    assert_int_equal(
        vn_networks_save(given, (const char *const *)set.names, set.count, in_folder("b.json"), NULL), VN_OK);
    assert_same_files(in_folder("a.json"), in_folder("b.json"));
    vn_networks_free(&set);
}

static void names_are_needed_and_differ(void **state) {
    (void)state;
    static const char *const twice[] = {"veins", "veins"};
    static const char *const nameless[] = {"veins", ""};
    vn_network *network = random_network(2, 1, 2);
    const vn_network *both[] = {network, network};
    assert_int_equal(vn_networks_save(both, twice, 2, in_folder("lie.json"), NULL), VN_INVALID);
    assert_int_equal(vn_networks_save(both, nameless, 2, in_folder("lie.json"), NULL), VN_INVALID);
    assert_int_equal(vn_networks_save(both, NULL, 2, in_folder("lie.json"), NULL), VN_INVALID);
    assert_int_equal(vn_networks_save(both, NULL, 0, in_folder("lie.json"), NULL), VN_INVALID);
    assert_int_equal(vn_network_save(network, in_folder("lie.json"), "{\"seed\": }"), VN_INVALID);
    assert_int_equal(vn_network_save(network, in_folder("lie.json"), "7"), VN_INVALID);
    assert_int_equal(access(in_folder("lie.json"), F_OK), -1);
    vn_network_destroy(network);
}

static void the_format_is_the_documented_one(void **state) {
    (void)state;
    vn_network_def def = vn_network_def_default();
    def.unit = "mm";
    vn_network *network;
    assert_int_equal(vn_network_create(&network, &def), VN_OK);
    assert_int_equal(vn_network_root(network, (double[3]){0.1, 1e6, 0}, NULL), VN_OK);
    assert_int_equal(vn_network_add(network, 0, (double[3]){-3, 1e300, 0}, NULL), VN_OK);
    assert_int_equal(vn_network_add(network, 1, (double[3]){2.5, 0, 0}, NULL), VN_OK);
    assert_int_equal(vn_network_join(network, 2, 0, 0.5), VN_OK);
    assert_int_equal(vn_network_save(network, in_folder("a.json"), NULL), VN_OK);
    char *text = read_file(in_folder("a.json"));
    assert_string_equal(text,
                        "{\"format\": \"venule.network\", \"version\": 1, \"dim\": 2, \"unit\": \"mm\",\n"
                        "\"nodes\": {\"x\": [0.1,-3,2.5],\n\"y\": [1e+06,1e+300,0],\n"
                        "\"parent\": [-1,0,1],\n\"tree\": [0,0,0],\n\"birth\": [0,0,0]},\n"
                        "\"joins\": {\"a\": [2],\n\"b\": [0],\n\"radius\": [0.5]},\n\"manifest\": {}}\n");
    free(text);
    vn_network_destroy(network);
}

#define HEAD "\"format\": \"venule.network\", \"version\": 1"
#define NODES "\"nodes\": {\"x\": [0, 1, 2], \"y\": [0, 0, 0], \"parent\": [-1, 0, 1]}"

static void keys_may_come_in_any_order(void **state) {
    (void)state;
    static const char text[] =
        "\xEF\xBB\xBF{\"extra\": [1, {\"deep\": null}], \"joins\": {\"b\": [1.0], \"a\": [0]},\n"
        "\"nodes\": {\"note\": \"é\", \"parent\": [2, -1, 1e0], \"y\": [1, 2, 3],\n"
        "\"temperature\": [1], \"x\": [-0.5, 1E2, 3]},\n"
        "\"unit\": \"\\u00b5m\", \"dim\": 2, \"version\": 1, \"format\": \"venule.network\"}";
    write_file(in_folder("a.json"), text, sizeof text - 1);
    vn_network *network = load_one(in_folder("a.json"));
    assert_int_equal(vn_network_count(network), 3);
    assert_int_equal(vn_network_parent(network)[0], 2);
    assert_true(vn_network_x(network)[1] == 100);
    assert_string_equal(vn_network_unit(network), "µm");
    assert_int_equal(vn_network_join_count(network), 1);
    assert_false(vn_network_has_radii(network));
    vn_network_destroy(network);
}

typedef struct lie {
    const char *text;
    const char *reason; // what the message must say
} lie;

static const lie lies[] = {
    {"", "ends too early"},
    {"\n\n", "ends too early"},
    {"{" HEAD ", \"dim\": 2, \"nodes\": {\"x\": [0, 1", "ends too early"},
    {"leaf", "line 1, byte 1: not JSON"},
    {"{\"format\":\n\n: 1}", "line 3, byte 13: not JSON"},
    {"{" HEAD ", \"dim\": 2, " NODES "} true", "not JSON"},
    {"{" HEAD ", \"dim\": 2, \"nodes\": {\"x\": [NaN]}}", "not JSON"},
    {"{\"\xff\": 1}", "not JSON"},
    {"[1, 2]", "the whole is a list, but must be an object"},
    {"{}", "format is missing"},
    {"{\"format\": \"venule.network\", \"dim\": 2, " NODES "}", "version is missing"},
    {"{\"format\": \"geo\\njson\", \"version\": 2}", "format is \"geo?json\", not \"venule.network\""},
    {"{\"format\": 7}", "format is 7, but must be a text"},
    {"{\"version\": 2, \"format\": \"venule.network\"}", "version 2 is newer than this program reads (1)"},
    {"{\"format\": \"venule.network\", \"version\": 0.5}", "version 0.5 does not exist"},
    {"{" HEAD ", " NODES "}", "dim is missing"},
    {"{" HEAD ", \"dim\": 4, " NODES "}", "dim = 4 must be 2 or 3"},
    {"{" HEAD ", \"dim\": \"2\", " NODES "}", "dim is \"2\", but must be a number"},
    {"{" HEAD ", \"dim\": 2}", "nodes is missing"},
    {"{" HEAD ", \"dim\": 2, \"nodes\": [1]}", "nodes is a list, but must be an object"},
    {"{" HEAD ", \"dim\": 2, \"nodes\": {\"x\": [], \"y\": []}}", "nodes.parent is missing"},
    {"{" HEAD ", \"dim\": 2, \"nodes\": {\"y\": [], \"parent\": []}}", "nodes.x is missing"},
    {"{" HEAD ", \"dim\": 3, " NODES "}", "nodes.z is missing"},
    {"{" HEAD ", \"dim\": 2, \"nodes\": {\"x\": [], \"y\": [], \"z\": [], \"parent\": []}}",
     "nodes.z is given, but dim is 2"},
    {"{" HEAD ", \"dim\": 2, \"nodes\": {\"x\": [0, 1], \"y\": [0], \"parent\": [-1, 0]}}",
     "nodes.y has 1 entries, but nodes.x has 2"},
    {"{" HEAD ", \"dim\": 2, \"nodes\": {\"x\": [0], \"y\": [0], \"parent\": [-1], \"birth\": []}}",
     "nodes.birth has 0 entries, but nodes.x has 1"},
    {"{" HEAD ", \"dim\": 2, \"nodes\": {\"x\": [0, null]}}", "nodes.x[1] is null, but must be a number"},
    {"{" HEAD ", \"dim\": 2, \"nodes\": {\"x\": [0, \"1\"]}}", "nodes.x[1] is \"1\", but must be a number"},
    {"{" HEAD ", \"dim\": 2, \"nodes\": {\"x\": [[0]]}}", "nodes.x[0] is a list, but must be a number"},
    {"{" HEAD ", \"dim\": 2, \"nodes\": {\"x\": [1e999]}}", "nodes.x[0] = 1e999 is beyond the range"},
    {"{" HEAD ", \"dim\": 2, \"nodes\": {\"x\": 3}}", "nodes.x is 3, but must be a list"},
    {"{" HEAD ", \"dim\": 2, \"nodes\": {\"x\": [], \"x\": []}}", "nodes.x is given twice"},
    {"{" HEAD ", \"dim\": 2, \"nodes\": {\"parent\": [-2]}}", "nodes.parent[0] = -2 must be -1 or more"},
    {"{" HEAD ", \"dim\": 2, \"nodes\": {\"parent\": [0.5]}}",
     "nodes.parent[0] = 0.5 must be a whole number"},
    {"{" HEAD ", \"dim\": 2, \"nodes\": {\"parent\": [3000000000]}}",
     "nodes.parent[0] = 3e+09 must be a whole number"},
    {"{" HEAD ", \"dim\": 2, \"nodes\": {\"radius\": [-1]}}", "nodes.radius[0] = -1 must be 0 or more"},
    {"{" HEAD ", \"dim\": 2, \"nodes\": {\"x\": [0, 1], \"y\": [0, 1], \"parent\": [-1, 2]}}", "parent 2"},
    {"{" HEAD ", \"dim\": 2, \"nodes\": {\"x\": [0, 1], \"y\": [0, 1], \"parent\": [-1, 1]}}", "parent 1"},
    {"{" HEAD ", \"dim\": 2, \"nodes\": {\"x\": [0, 1, 2], \"y\": [0, 1, 2], \"parent\": [-1, 2, 1]}}",
     "circle"},
    {"{" HEAD ", \"dim\": 2, \"nodes\": {\"x\": [0], \"y\": [0], \"parent\": [0]}}", "parent 0"},
    {"{" HEAD ", \"dim\": 2, \"nodes\": {\"x\": [0], \"y\": [0], \"parent\": [-1], \"tree\": [1]}}",
     "nodes.tree[0] = 1, but it hangs from root number 0"},
    {"{" HEAD ", \"dim\": 2, \"nodes\": {\"x\": [0], \"y\": [0], \"parent\": [-1], \"order\": [5]}}",
     "nodes.order is neither"},
    {"{" HEAD ", \"dim\": 2, " NODES ", \"joins\": {\"a\": [0], \"b\": [3]}}", "joins.b[0] = 3"},
    {"{" HEAD ", \"dim\": 2, " NODES ", \"joins\": {\"a\": [0], \"b\": [0]}}",
     "joins.a[0] = 0 and joins.b[0] = 0"},
    {"{" HEAD ", \"dim\": 2, " NODES ", \"joins\": {\"a\": [0], \"b\": [1]}}", "joins.b[0] = 1"},
    {"{" HEAD ", \"dim\": 2, " NODES ", \"joins\": {\"a\": [0], \"b\": [-1]}}",
     "joins.b[0] = -1 must be 0 or more"},
    {"{" HEAD ", \"dim\": 2, " NODES ", \"joins\": {\"a\": [0]}}", "joins.b is missing"},
    {"{" HEAD ", \"dim\": 2, " NODES ", \"joins\": {\"a\": [0], \"b\": []}}",
     "joins.b has 0 entries, but joins.a has 1"},
    {"{" HEAD ", \"dim\": 2, " NODES ", \"joins\": {\"a\": [0], \"b\": [2], \"radius\": [-1]}}",
     "joins.radius[0] = -1"},
    {"{" HEAD ", \"dim\": 2, " NODES ", \"murray\": {\"exponent\": 0}}", "exponent"},
    {"{" HEAD
     ", \"dim\": 2, \"murray\": {}, \"nodes\": {\"x\": [0], \"y\": [0], \"parent\": [-1], \"radius\": [2]}}",
     "nodes.radius[0] = 2, but by murray it is"},
    {"{" HEAD ", \"networks\": {}, \"dim\": 2, " NODES "}", "holds networks, but its format is"},
    {"{\"format\": \"venule.networks\", \"version\": 1}", "holds no network"},
    {"{\"format\": \"venule.networks\", \"version\": 1, \"networks\": {}}", "holds no network"},
    {"{\"format\": \"venule.networks\", \"version\": 1, \"networks\": {\"\": {}}}", "needs a name"},
    {"{\"format\": \"venule.networks\", \"version\": 1, \"networks\": {\"a\": 1}}",
     "network \"a\": it is 1, but must be an object"},
    {"{\"format\": \"venule.networks\", \"version\": 1, \"networks\": {\"a\": {\"dim\": 2}}}",
     "network \"a\": nodes is missing"},
    {"{\"format\": \"venule.networks\", \"version\": 1, \"networks\": {\"a\": {\"dim\": 2, " NODES
     "}, \"a\": {}}}",
     "network \"a\": is given twice"},
    {"{\"format\": \"venule.networks\", \"version\": 1, " NODES ", \"networks\": {\"a\": {}}}",
     "holds nodes outside"},
    {"{\"format\": \"venule.networks\", \"version\": 1, \"networks\": {\"a\": {\"dim\": 2, " NODES
     "}}, " NODES "}",
     "holds nodes outside"},
    {"{" HEAD ", \"dim\": 2, \"nodes\": {\"x\": [0], \"y\": [0], \"parent\": [-1], \"flow\": []}}",
     "nodes.flow has 0 entries, but nodes.x has 1"},
    {"{" HEAD ", \"dim\": 2, \"nodes\": {\"x\": [0], \"y\": [0], \"parent\": [-1], \"pressure\": [1]}}",
     "nodes.pressure is given, but nodes.flow is missing"},
    {"{" HEAD ", \"manifest\": {\"a\": [", "ends too early"},
    {"{" HEAD ", \"unit\": \"a\\u0000b\"}", "unit must have less than 256 bytes, none of them zero"},
};

static void assert_refused(const char *text, size_t size, vn_status status, const char *reason) {
    size_t before = vn_byte_count();
    write_file(in_folder("lie.json"), text, size);
    vn_network_set set;
    vn_status found = vn_networks_load(&set, in_folder("lie.json"));
    if (found != status || strstr(vn_message(), reason) == NULL) {
        fail_msg("%.200s\n  gave %d \"%s\", not %d \"%s\"", text, (int)found,
                 found != VN_OK ? vn_message() : "", (int)status, reason);
    }
    assert_non_null(strstr(vn_message(), "lie.json: "));
    assert_null(strchr(vn_message(), '\n'));
    assert_null(set.networks);
    assert_int_equal(set.count, 0);
    assert_int_equal(vn_byte_count(), before);
}

static void a_file_that_lies_is_refused(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof lies / sizeof *lies; i++) {
        assert_refused(lies[i].text, strlen(lies[i].text), VN_IO, lies[i].reason);
    }
}

static void a_file_that_was_cut_off_is_refused(void **state) {
    (void)state;
    vn_network *network = random_network(3, 3, 20);
    vn_murray_def def = vn_murray_def_default();
    assert_int_equal(vn_network_murray(network, &def), VN_OK);
    assert_int_equal(vn_network_save(network, in_folder("a.json"), NULL), VN_OK);
    vn_network_destroy(network);
    char *text = read_file(in_folder("a.json"));
    for (size_t size = 0; size + 2 < strlen(text); size++) {
        assert_refused(text, size, VN_IO, "");
    }
    free(text);
}

// `head`, then `count` times `body`, then what the parser never comes to.
static void assert_repeated_refused(const char *head, const char *body, size_t count, vn_status status,
                                    const char *reason) {
    size_t length = strlen(head), step = strlen(body);
    char *text = malloc(length + count * step + 1);
    memcpy(text, head, length + 1);
    for (size_t i = 0; i < count; i++) {
        memcpy(text + length + i * step, body, step);
    }
    text[length + count * step] = '\0';
    assert_refused(text, length + count * step, status, reason);
    free(text);
}

static void deep_nesting_and_endless_texts_are_refused(void **state) {
    (void)state;
    assert_repeated_refused("{\"deep\": ", "[", 100000, VN_IO, "nested more than 64 deep");
    assert_repeated_refused("{\"long\": \"", "abcdefgh", 1 << 20, VN_LIMIT, "a text of more than");
    assert_repeated_refused("{\"networks\": {\"", "abcdefgh", 40, VN_IO, "ends too early");
}

static void the_memory_budget_holds_for_a_large_file(void **state) {
    (void)state;
    char head[] = "{" HEAD ", \"dim\": 2, \"nodes\": {\"x\": [0";
    size_t size = sizeof head + 2000000;
    char *text = malloc(size);
    memset(text, '1', size);
    memcpy(text, head, sizeof head - 1);
    for (size_t i = sizeof head - 1; i + 1 < size; i += 2) {
        text[i] = ',';
    }
    write_file(in_folder("a.json"), text, size);
    free(text);
    size_t before = vn_byte_count();
    vn_network_set set;
    vn_set_memory_budget(before + 1000000);
    vn_status status = vn_networks_load(&set, in_folder("a.json"));
    vn_set_memory_budget(0);
    assert_int_equal(status, VN_NO_MEMORY);
    assert_int_equal(vn_byte_count(), before);
}

static void a_missing_file_is_named(void **state) {
    (void)state;
    vn_network_set set;
    assert_int_equal(vn_networks_load(&set, in_folder("none.json")), VN_IO);
    assert_non_null(strstr(vn_message(), "none.json: cannot be read: No such file"));
    assert_int_equal(vn_networks_load(&set, in_folder("folder.json")), VN_IO);
    assert_non_null(strstr(vn_message(), "cannot be read"));
}

static int entries_in(const char *path) {
    DIR *stream = opendir(path);
    assert_non_null(stream);
    int entries = 0;
    while (readdir(stream) != NULL) {
        entries++;
    }
    closedir(stream);
    return entries;
}

// Not by its permissions, which do not bind root: a folder that is gone, and a name that is too long for any.
static void a_file_that_cannot_be_written_leaves_nothing(void **state) {
    (void)state;
    vn_network *network = random_network(2, 1, 10);
    size_t before = vn_byte_count();
    int entries = entries_in(folder);
    char longest[400];
    memset(longest, 'x', sizeof longest);
    strcpy(longest + sizeof longest - 6, ".json");
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, longest);
    assert_int_equal(vn_network_save(network, in_folder("gone/a.json"), NULL), VN_IO);
    assert_non_null(strstr(vn_message(), "gone/a.json"));
    assert_int_equal(vn_network_save(network, path, NULL), VN_IO);
    assert_int_equal(vn_network_save(network, in_folder("folder.json"), NULL), VN_IO);
    assert_int_equal(entries_in(folder), entries);
    assert_int_equal(vn_byte_count(), before);
    vn_network_destroy(network);
}

static void a_read_only_folder_stays_as_it_is(void **state) {
    (void)state;
    if (geteuid() == 0) {
        skip(); // root may write everywhere
    }
    vn_network *network = random_network(2, 1, 10);
    int entries = entries_in(folder);
    assert_int_equal(chmod(folder, 0500), 0);
    vn_status status = vn_network_save(network, in_folder("lie2.json"), NULL);
    assert_int_equal(chmod(folder, 0700), 0);
    assert_int_equal(status, VN_IO);
    assert_int_equal(entries_in(folder), entries);
    vn_network_destroy(network);
}

static vn_network *network_with_everything(void) {
    vn_network *network = random_network(3, 8, 200);
    add_random_joins(network, 8, 10);
    vn_murray_def def = vn_murray_def_default();
    assert_int_equal(vn_network_murray(network, &def), VN_OK);
    assert_int_equal(vn_network_set_orders(network, VN_HORTON), VN_OK);
    return network;
}

static void no_failed_allocation_while_loading_loses_memory(void **state) {
    (void)state;
    vn_network *network = network_with_everything();
    const vn_network *both[] = {network, network};
    static const char *const names[] = {"arteries", "veins"};
    assert_int_equal(vn_networks_save(both, names, 2, in_folder("a.json"), NULL), VN_OK);
    vn_network_destroy(network);
    size_t before = vn_byte_count();
    vn_status status = VN_NO_MEMORY;
    int refused = 0;
    for (; status != VN_OK && refused < 10000; refused++) {
        vn_network_set set;
        vn_fail_allocations_from(refused);
        status = vn_networks_load(&set, in_folder("a.json"));
        vn_fail_allocations_from(-1);
        assert_true(status == VN_OK || status == VN_NO_MEMORY);
        vn_networks_free(&set);
        assert_int_equal(vn_byte_count(), before);
    }
    assert_int_equal(status, VN_OK);
    assert_true(refused > 20);
}

static void no_failed_allocation_while_saving_loses_memory(void **state) {
    (void)state;
    vn_network *network = network_with_everything();
    size_t before = vn_byte_count();
    int entries = entries_in(folder);
    vn_status status = VN_NO_MEMORY;
    for (int refused = 0; status != VN_OK && refused < 10000; refused++) {
        assert_int_equal(entries_in(folder), entries);
        vn_fail_allocations_from(refused);
        status = vn_network_save(network, in_folder("b.json"), NULL);
        vn_fail_allocations_from(-1);
        assert_true(status == VN_OK || status == VN_NO_MEMORY);
        assert_int_equal(vn_byte_count(), before);
    }
    assert_int_equal(status, VN_OK);
    vn_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_round_trip_is_exact),
        cmocka_unit_test(an_empty_network_survives),
        cmocka_unit_test(the_law_of_the_radii_survives),
        cmocka_unit_test(given_radii_survive),
        cmocka_unit_test(computed_orders_survive),
        cmocka_unit_test(several_networks_share_a_file),
        cmocka_unit_test(names_are_needed_and_differ),
        cmocka_unit_test(the_format_is_the_documented_one),
        cmocka_unit_test(keys_may_come_in_any_order),
        cmocka_unit_test(a_file_that_lies_is_refused),
        cmocka_unit_test(a_file_that_was_cut_off_is_refused),
        cmocka_unit_test(deep_nesting_and_endless_texts_are_refused),
        cmocka_unit_test(the_memory_budget_holds_for_a_large_file),
        cmocka_unit_test(a_missing_file_is_named),
        cmocka_unit_test(a_file_that_cannot_be_written_leaves_nothing),
        cmocka_unit_test(a_read_only_folder_stays_as_it_is),
        cmocka_unit_test(no_failed_allocation_while_loading_loses_memory),
        cmocka_unit_test(no_failed_allocation_while_saving_loses_memory),
    };
    return cmocka_run_group_tests(tests, make_folder, drop_folder);
}
