// Networks in the formats of other programs: what goes out comes back, and what those programs write is
// understood.
#include "files.h"

#include <unistd.h>

typedef struct kept {
    const char *extension;
    unsigned what;
    int32_t joins;
} kept;

// What each format keeps of a network.
static const kept formats[] = {
    {"json", ALL, 12},
    {"xml", RADII | FLOWS | PRESSURES | JOINS | UNITS, 12},
    {"gxl", RADII | FLOWS | PRESSURES | JOINS | UNITS, 12},
    {"vtp", ALL, 12},
    {"swc", RADII | UNITS, 0},
    {"csv", RADII | FLOWS | PRESSURES | BIRTHS, 0},
};

enum { FORMATS = sizeof formats / sizeof *formats };

static const char *named(const char *stem, const char *extension) {
    char name[32];
    snprintf(name, sizeof name, "%s.%s", stem, extension);
    return in_folder(name);
}

static void assert_same_files(const char *a, const char *b) {
    size_t sizes[2];
    char *left = take_file(a, &sizes[0]), *right = take_file(b, &sizes[1]);
    assert_int_equal(sizes[0], sizes[1]);
    assert_memory_equal(left, right, sizes[0]);
    free(left);
    free(right);
}

// Save, load, compare, save again, compare the bytes. Destroys the network.
static void check_round_trip(vn_network *network, const kept *format) {
    const char *first = named("a", format->extension), *second = named("b", format->extension);
    save_one(network, first, NULL);
    vn_network *again = load_one(first);
    assert_same_network(network, again, format->what);
    save_one(again, second, NULL);
    assert_same_files(first, second);
    vn_network_destroy(again);
    vn_network_destroy(network);
}

static void a_round_trip_is_exact(void **state) {
    (void)state;
    for (int i = 0; i < FORMATS; i++) {
        for (uint64_t seed = 0; seed < 12; seed++) {
            int32_t nodes = 1 + (int32_t)(seed * seed * 7);
            check_round_trip(full_forest(2 + (int)(seed % 2), nodes, seed > 3 ? formats[i].joins : 0, seed),
                             &formats[i]);
        }
    }
}

static void degenerate_networks_survive(void **state) {
    (void)state;
    for (int i = 0; i < FORMATS; i++) {
        for (int dim = 2; dim <= 3; dim++) {
            bool tells_dim = strcmp(formats[i].extension, "csv") != 0;
            check_round_trip(network_of(tells_dim ? dim : 2), &formats[i]);
            vn_network *network = network_of(dim); // roots without an edge, nothing known of radii
            put_root(network, 1e300, -1e-300, dim == 3 ? 5e-324 : 0);
            put_root(network, -0.0, 0.1, 0);
            check_round_trip(network, &formats[i]);
            network = network_of(dim); // nodes at one place, an edge without a length
            put_root(network, 1, 2, 0);
            put_child(network, 0, 1, 2, 0);
            put_child(network, 1, 1, 2, 0);
            put_root(network, 1, 2, 0);
            put_child(network, 3, 1, 2, 0);
            check_round_trip(network, &formats[i]);
        }
    }
}

// Radii by a law, and children before their parents.
static void split_edges_survive(void **state) {
    (void)state;
    for (int i = 0; i < FORMATS; i++) {
        vn_network *network = random_tree(3, 60, 3, 5);
        vn_murray_def law = {.exponent = 2.7, .tip_radius = 0.1};
        assert_ok(vn_network_murray(network, &law));
        for (int32_t child = 5; child < 50; child += 7) {
            assert_ok(vn_network_split(network, child, (double[3]){child, 0, 1}, NULL));
        }
        if (strcmp(formats[i].extension, "json") == 0 || strcmp(formats[i].extension, "swc") == 0) {
            vn_network_destroy(network); // the one keeps the law, the other numbers parents first: below
            continue;
        }
        check_round_trip(network, &formats[i]);
    }
}

static void swc_numbers_parents_first(void **state) {
    (void)state;
    vn_network *network = random_tree(3, 60, 3, 5);
    assert_ok(vn_network_split(network, 9, (double[3]){0, 0, 1}, NULL));
    save_one(network, in_folder("a.swc"), NULL);
    vn_network *again = load_one(in_folder("a.swc"));
    assert_int_equal(vn_network_count(again), 61);
    for (int32_t k = 0; k < 61; k++) {
        int32_t node = vn_network_nth(network, k), parent = vn_network_parent(again)[k];
        assert_true(vn_network_x(again)[k] == vn_network_x(network)[node]);
        assert_true(parent < k);
        assert_int_equal(parent < 0 ? -1 : vn_network_nth(network, parent), vn_network_parent(network)[node]);
    }
    vn_network_destroy(network);
    vn_network_destroy(again);
}

static int compare_lines(const void *a, const void *b) {
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static int split_lines(char *text, char **lines, int most) {
    int count = 0;
    for (char *line = strtok(text, "\n"); line != NULL && count < most; line = strtok(NULL, "\n")) {
        lines[count++] = line;
    }
    qsort(lines, (size_t)count, sizeof *lines, compare_lines);
    return count;
}

// Which node is which, such a file does not say: the segments are the same, in another order.
static void segments_come_back(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 8; seed++) {
        vn_network *network = random_tree(2 + (int)(seed % 2), 2 + (int32_t)seed * 30, 1, seed);
        vn_murray_def law = vn_murray_def_default();
        char *lines[2][300];
        size_t size;
        assert_ok(vn_network_murray(network, &law));
        save_one(network, in_folder("a.txt"), NULL);
        vn_network *again = load_one(in_folder("a.txt"));
        assert_int_equal(vn_network_dim(again), vn_network_dim(network));
        assert_int_equal(vn_network_count(again), vn_network_count(network));
        save_one(again, in_folder("b.txt"), NULL);
        char *texts[2] = {take_file(in_folder("a.txt"), &size), take_file(in_folder("b.txt"), &size)};
        int count = split_lines(texts[0], lines[0], 300);
        assert_int_equal(count, vn_network_count(network) - 1);
        assert_int_equal(split_lines(texts[1], lines[1], 300), count);
        for (int i = 0; i < count; i++) {
            assert_string_equal(lines[0][i], lines[1][i]);
        }
        free(texts[0]);
        free(texts[1]);
        vn_network_destroy(network);
        vn_network_destroy(again);
    }
}

// As OpenCCO writes it: the root's own segments are missing.
static void segments_without_their_root_hang_together(void **state) {
    (void)state;
    put_text(in_folder("a.txt"),
             "4 0 1 2 1 0 0.5\n0 3 1 2 1 -0 0.25\r\n\n5 5 5 4 0 1 0.125\n3 -1 2 4 0 1 .125");
    vn_network *network = load_one(in_folder("a.txt"));
    static const int32_t parents[] = {-1, 0, 0, 1, 1};
    static const double radii[] = {0.5, 0.5, 0.25, 0.125, 0.125};
    assert_int_equal(vn_network_count(network), 5);
    assert_int_equal(vn_network_dim(network), 3);
    for (int i = 0; i < 5; i++) {
        assert_int_equal(vn_network_parent(network)[i], parents[i]);
        assert_true(vn_network_radius(network, i) == radii[i]);
    }
    vn_network_destroy(network);
}

static const char *fixture(const char *name) {
    static char path[300];
    snprintf(path, sizeof path, "%s/tests/files/gxl/%s", VN_SOURCE_DIR, name);
    return path;
}

static void a_file_of_opencco_is_understood(void **state) {
    (void)state;
    vn_network *network = load_one(fixture("opencco-2d.xml"));
    static const int32_t parents[] = {-1, 0, 1, 1};
    static const double y[] = {79.7885, 31.5, -12.75, 15}, flow[] = {16.66, 16.66, 8.33, 8.33};
    assert_int_equal(vn_network_dim(network), 2);
    assert_int_equal(vn_network_count(network), 4);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(vn_network_parent(network)[i], parents[i]);
        assert_true(vn_network_y(network)[i] == y[i]);
        assert_true(vn_network_flow(network)[i] == flow[i]);
    }
    assert_true(vn_network_radius(network, 3) == 1.29);
    assert_null(vn_network_pressure(network)); // known at two places only
    vn_network_destroy(network);
}

// Its nodes are out of order, but numbered.
static void a_file_of_vascusynth_is_understood(void **state) {
    (void)state;
    vn_network *network = load_one(fixture("vascusynth-3d.xml"));
    static const int32_t parents[] = {-1, 0, 1, 1};
    static const double z[] = {50, 52.25, 30, 70}, radii[] = {0.0812, 0.0812, 0.064, 0.065};
    assert_int_equal(vn_network_dim(network), 3);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(vn_network_parent(network)[i], parents[i]);
        assert_true(vn_network_z(network)[i] == z[i]);
        assert_true(vn_network_radius(network, i) == radii[i]);
    }
    vn_network_destroy(network);
}

static void an_odd_graph_is_understood(void **state) {
    (void)state;
    vn_network *network = load_one(fixture("odd.gxl"));
    static const int32_t parents[] = {2, 2, 3, -1, 5, -1};
    int32_t a, b;
    double radius;
    assert_int_equal(vn_network_count(network), 6);
    for (int i = 0; i < 6; i++) {
        assert_int_equal(vn_network_parent(network)[i], parents[i]);
    }
    assert_true(vn_network_radius(network, 0) == 1.5);
    assert_int_equal(vn_network_join_count(network), 1);
    vn_network_join_ends(network, 0, &a, &b, &radius);
    assert_int_equal(a, 1);
    assert_int_equal(b, 0);
    assert_true(radius == 0.5);
    assert_null(vn_network_flow(network));
    vn_network_destroy(network);
}

// --- graphs that are no forests, against the slow and obvious

typedef struct graph {
    int32_t nodes, edges;
    int32_t from[64], to[64];
} graph;

// No two edges connect the same pair.
static graph random_graph(vn_rng *rng) {
    graph g = {.nodes = (int32_t)whole(rng, 2, 14)};
    bool taken[16][16] = {{false}};
    for (int32_t i = (int32_t)whole(rng, 1, 30); i > 0; i--) {
        int32_t a = (int32_t)whole(rng, 0, g.nodes - 1), b = (int32_t)whole(rng, 0, g.nodes - 1);
        if (a != b && !taken[a][b]) {
            taken[a][b] = taken[b][a] = true;
            g.from[g.edges] = a;
            g.to[g.edges++] = b;
        }
    }
    return g;
}

static void write_gxl(const graph *g, const char *path, const char *mode) {
    unlink(path);
    FILE *file = fopen(path, "wb");
    fprintf(file, "<gxl><graph edgemode=\"%s\">", mode);
    for (int32_t i = 0; i < g->nodes; i++) {
        fprintf(file,
                "<node id=\"n%d\"><attr "
                "name=\"position\"><tup><float>%d</float><float>0</float></tup></attr></node>",
                i, i);
    }
    for (int32_t i = 0; i < g->edges; i++) {
        fprintf(file, "<edge from=\"n%d\" to=\"n%d\"/>", g->from[i], g->to[i]);
    }
    fprintf(file, "</graph></gxl>");
    assert_int_equal(fclose(file), 0);
}

// Which nodes hang together over the edges up to `end`, named by the least of them.
static void find_parts(const graph *g, int32_t end, const bool *left_out, int32_t *part) {
    for (int32_t i = 0; i < g->nodes; i++) {
        part[i] = i;
    }
    for (int32_t round = 0; round < g->nodes; round++) {
        for (int32_t i = 0; i < end; i++) {
            if (!left_out[i]) {
                int32_t least = part[g->from[i]] < part[g->to[i]] ? part[g->from[i]] : part[g->to[i]];
                part[g->from[i]] = part[g->to[i]] = least;
            }
        }
    }
}

static void assert_joins_are(const vn_network *network, const graph *g, const bool *joins) {
    int32_t join = 0, a, b;
    double radius;
    for (int32_t i = 0; i < g->edges; i++) {
        if (joins[i]) {
            vn_network_join_ends(network, join++, &a, &b, &radius);
            assert_int_equal(a, g->from[i]);
            assert_int_equal(b, g->to[i]);
        }
    }
    assert_int_equal(vn_network_join_count(network), join);
}

static void directed_edges_make_parents_or_joins(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(4);
    for (int round = 0; round < 300; round++) {
        graph g = random_graph(&rng);
        int32_t parents[16], part[16];
        bool joins[64] = {false};
        memset(parents, 0xFF, sizeof parents);
        for (int32_t i = 0; i < g.edges; i++) {
            find_parts(&g, i, joins, part);
            joins[i] = parents[g.to[i]] >= 0 || part[g.from[i]] == part[g.to[i]];
            parents[g.to[i]] = joins[i] ? parents[g.to[i]] : g.from[i];
        }
        write_gxl(&g, in_folder("a.gxl"), " directed");
        vn_network *network = load_one(in_folder("a.gxl"));
        for (int32_t i = 0; i < g.nodes; i++) {
            assert_int_equal(vn_network_parent(network)[i], parents[i]);
        }
        assert_joins_are(network, &g, joins);
        vn_network_destroy(network);
    }
}

// The first of a part that no edge of the forest leads to, or its first.
static int32_t root_of(const graph *g, const bool *joins, const int32_t *part, int32_t name) {
    for (int32_t i = 0; i < g->nodes; i++) {
        bool led = false;
        for (int32_t k = 0; k < g->edges; k++) {
            led = led || (!joins[k] && g->to[k] == i);
        }
        if (part[i] == name && !led) {
            return i;
        }
    }
    return name;
}

static void undirected_edges_are_turned_away_from_a_root(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(5);
    for (int round = 0; round < 300; round++) {
        graph g = random_graph(&rng);
        int32_t part[16], tree_edges = 0, roots = 0;
        bool joins[64] = {false};
        for (int32_t i = 0; i < g.edges; i++) {
            find_parts(&g, i, joins, part);
            joins[i] = part[g.from[i]] == part[g.to[i]];
            tree_edges += !joins[i];
        }
        find_parts(&g, g.edges, joins, part);
        write_gxl(&g, in_folder("a.gxl"), "undirected");
        vn_network *network = load_one(in_folder("a.gxl"));
        for (int32_t i = 0; i < g.nodes; i++) {
            int32_t parent = vn_network_parent(network)[i];
            assert_true(parent >= 0 || root_of(&g, joins, part, part[i]) == i);
            roots += parent < 0;
            bool is_edge = parent < 0;
            for (int32_t k = 0; k < g.edges; k++) {
                is_edge = is_edge || (!joins[k] && ((g.from[k] == i && g.to[k] == parent) ||
                                                    (g.to[k] == i && g.from[k] == parent)));
            }
            assert_true(is_edge);
        }
        assert_int_equal(roots + tree_edges, g.nodes);
        assert_joins_are(network, &g, joins);
        vn_network_destroy(network);
    }
}

// --- what others must find in ours

static vn_network *small_tree(void) {
    vn_network_def def = {.dim = 2, .max_nodes = 10, .unit = "mm"};
    vn_network *network;
    assert_ok(vn_network_create(&network, &def));
    put_root(network, 0, 10, 0);
    put_child(network, 0, 0, 6, 0);
    put_child(network, 1, 3, 2, 0);
    put_child(network, 1, -1, 2, 0);
    assert_ok(vn_network_set_radii(network, (double[]){0.5, 0.5, 0.4, 0.3}));
    assert_ok(vn_network_set_flow(network, (double[]){3, 3, 2, 1}, (double[]){13300, 9000, 7980, 7980}));
    return network;
}

static void assert_in_text(const char *text, const char *part) {
    if (strstr(text, part) == NULL) {
        fail_msg("no \"%s\" in:\n%s", part, text);
    }
}

static double number_after(const char *text, const char *mark) {
    const char *found = strstr(text, mark);
    assert_non_null(found);
    return strtod(strstr(found, "<float>") + 7, NULL);
}

// Resistances in series and side by side, 8 μ ℓ / (π r⁴) each.
static void gxl_is_what_its_readers_look_for(void **state) {
    (void)state;
    static const char manifest[] = "{\"parameters\": {\"viscosity\": 0.0036, \"name\": \"a--b->\"}}";
    vn_network *network = small_tree();
    size_t size;
    save_one(network, in_folder("a.xml"), manifest);
    char *text = take_file(in_folder("a.xml"), &size);
    assert_in_text(text, "<attr name=\" pPerf\">\n      <float>13300</float>");
    assert_in_text(text, "<attr name=\" pTerm\">\n      <float>7980</float>");
    assert_in_text(text, "<node id=\"n0\" flow=\"3\" radius=\"0.5\" pressure=\"13300\">");
    assert_in_text(text, "<string> root node </string>");
    assert_in_text(text, "<string> bifurication </string>");
    assert_in_text(text, "<string> terminal node </string>");
    assert_in_text(
        text, "<edge id=\"e2\" to=\"n2\" from=\"n1\">\n    <attr name=\" flow\">\n      <float>2</float>");
    assert_in_text(text, "<attr name=\" radius\">\n      <float>0.4</float>");
    double unit = 8 * 0.0036 / acos(-1.0);
    double r1 = unit * 4 / pow(0.5, 4), r2 = unit * 5 / pow(0.4, 4), r3 = unit * sqrt(17) / pow(0.3, 4);
    double reduced = number_after(strstr(text, "id=\"e1\""), " resistance");
    assert_near(reduced / pow(0.5, 4), r1 + 1 / (1 / r2 + 1 / r3), 1e-12 * r1);
    free(text);
    vn_network_set set;
    assert_ok(vn_networks_load(&set, in_folder("a.xml")));
    assert_string_equal(set.manifest,
                        "{\"parameters\": {\"viscosity\": 0.0036, \"name\": \"a-\\u002db->\"}}");
    vn_networks_free(&set);
    vn_network_destroy(network);
}

enum { TERMINALS = 150 };

static void save_cco_tree(const char *path) {
    vn_domain *disk = disk_of(0, 0, 80);
    vn_cco_def def = vn_cco_def_default();
    vn_cco_tree_def tree = vn_cco_tree_def_default();
    vn_cco *cco;
    vn_network *network;
    int32_t number;
    def.domain = disk;
    def.terminals = TERMINALS;
    tree.root[1] = 80;
    assert_ok(vn_cco_create(&cco, &def));
    assert_ok(vn_cco_add(cco, &tree, &number));
    assert_ok(vn_cco_grow(cco, TERMINALS, &number));
    assert_ok(vn_cco_network(cco, 0, &network));
    save_one(network, path, "{\"parameters\": {\"viscosity\": 0.0036}}");
    vn_network *again = load_one(path);
    assert_same_network(network, again, RADII | FLOWS | PRESSURES);
    vn_network_destroy(again);
    vn_network_destroy(network);
    vn_cco_destroy(cco);
    vn_domain_release(disk);
}

// From the text alone: what an edge carries through all that it feeds falls from its near node to the
// terminals.
static void the_physics_of_a_tree_can_be_read_from_its_gxl(void **state) {
    (void)state;
    double pressure[2 * TERMINALS], terminal;
    int from, edges = 0, node;
    size_t size;
    save_cco_tree(in_folder("a.xml"));
    char *text = take_file(in_folder("a.xml"), &size);
    terminal = number_after(text, " pTerm");
    assert_near(terminal, 60 * 133.322, 1e-2);
    assert_near(number_after(text, " pPerf"), 100 * 133.322, 1e-2);
    for (char *at = strstr(text, "<node"); at != NULL; at = strstr(at + 1, "<node")) {
        assert_int_equal(sscanf(at, "<node id=\"n%d\"", &node), 1);
        pressure[node] = strtod(strstr(at, "pressure=\"") + 10, NULL);
    }
    for (char *at = strstr(text, "<edge"); at != NULL; at = strstr(at + 1, "<edge"), edges++) {
        assert_int_equal(sscanf(at, "<edge id=\"e%d\" to=\"n%*d\" from=\"n%d\"", &node, &from), 2);
        double fall =
            number_after(at, " flow") * number_after(at, " resistance") / pow(number_after(at, " radius"), 4);
        assert_near(fall / (pressure[from] - terminal), 1, 1e-6);
    }
    assert_int_equal(edges, 2 * TERMINALS - 1);
    free(text);
}

static void without_a_viscosity_there_is_no_resistance(void **state) {
    (void)state;
    static const char *const manifests[] = {NULL, "{}", "{\"viscosity\": \"thick\"}", "{\"viscosity\": -1}"};
    vn_network *network = small_tree();
    for (size_t i = 0; i < sizeof manifests / sizeof *manifests; i++) {
        size_t size;
        save_one(network, in_folder("a.xml"), manifests[i]);
        char *text = take_file(in_folder("a.xml"), &size);
        assert_null(strstr(text, "resistance"));
        free(text);
    }
    vn_network_destroy(network);
}

static void assert_file_is(const char *path, const char *expected) {
    size_t size;
    char *text = take_file(path, &size);
    assert_string_equal(text, expected);
    free(text);
}

static void tables_are_the_documented_ones(void **state) {
    (void)state;
    vn_network *network = small_tree();
    assert_ok(vn_network_set_orders(network, VN_STRAHLER));
    save_one(network, in_folder("a.csv"), "{}");
    assert_file_is(in_folder("a.csv"), "x,y,parent,radius,flow,pressure,order,tree,birth\n"
                                       "0,10,-1,0.5,3,13300,2,0,0\n0,6,0,0.5,3,9000,2,0,0\n"
                                       "3,2,1,0.4,2,7980,1,0,0\n-1,2,1,0.3,1,7980,1,0,0\n");
    save_one(network, in_folder("a.swc"), "{\"seed\":\n 7}");
    assert_file_is(in_folder("a.swc"), "# dim 2\n# unit mm\n# manifest {\"seed\":  7}\n"
                                       "# id type x y z radius parent\n1 0 0 10 0 0.5 -1\n2 0 0 6 0 0.5 1\n"
                                       "3 0 3 2 0 0.4 2\n4 0 -1 2 0 0.3 2\n");
    save_one(network, in_folder("a.txt"), NULL);
    assert_file_is(in_folder("a.txt"), "0 6 0 0 10 0 0.5\n3 2 0 0 6 0 0.4\n-1 2 0 0 6 0 0.3\n");
    vn_network_destroy(network);
}

static void a_manifest_comes_back_where_there_is_a_place_for_it(void **state) {
    (void)state;
    static const char *const extensions[] = {"json", "xml", "vtp", "swc"};
    static const char manifest[] = "{\"a\":[1,2.50,null,true,false,{\"b\":\"\\\"\\u0001<&é\"}],\"c\":{}}";
    vn_network *network = small_tree();
    for (size_t i = 0; i < sizeof extensions / sizeof *extensions; i++) {
        vn_network_set set;
        save_one(network, named("a", extensions[i]), manifest);
        assert_ok(vn_networks_load(&set, named("a", extensions[i])));
        assert_string_equal(set.manifest, manifest);
        vn_networks_free(&set);
    }
    vn_network_destroy(network);
}

static void foreign_tables_are_understood(void **state) {
    (void)state;
    put_text(in_folder("a.csv"), "\xEF\xBB\xBF"
                                 "\"Parent\"; note; Y; X; z\r\n1; \"a\"; 2; 1; 0\r\n-1;;4;3;0\r\n\r\n");
    vn_network *network = load_one(in_folder("a.csv"));
    assert_int_equal(vn_network_count(network), 2);
    assert_int_equal(vn_network_dim(network), 3);
    assert_int_equal(vn_network_parent(network)[0], 1);
    assert_true(vn_network_y(network)[1] == 4);
    assert_false(vn_network_has_radii(network));
    vn_network_destroy(network);
    put_text(in_folder("a.swc"),
             "# ORIGINAL_SOURCE somebody\n\n 12 3 1.0 2.0 3.0 .5 007 # of a child\n7 1 0 0 1 1 -1\n");
    network = load_one(in_folder("a.swc"));
    assert_int_equal(vn_network_count(network), 2);
    assert_int_equal(vn_network_dim(network), 3);
    assert_int_equal(vn_network_parent(network)[0], 1);
    assert_true(vn_network_radius(network, 0) == 0.5);
    vn_network_destroy(network);
}

// --- what formats cannot hold

static void assert_unsaved(const vn_network *network, const char *name, const char *reason) {
    assert_int_equal(vn_network_save(network, in_folder(name), NULL), VN_INVALID);
    assert_message(reason);
    assert_int_equal(access(in_folder(name), F_OK), -1);
}

static void what_a_format_cannot_hold_is_refused(void **state) {
    (void)state;
    vn_network *network = full_forest(3, 40, 5, 1);
    assert_unsaved(network, "no.swc", "such a file holds trees, but");
    assert_unsaved(network, "no.csv", "joins close loops; save it as .json, .xml, .gxl or .vtp");
    assert_unsaved(network, "no.txt", "such a file holds trees");
    assert_unsaved(network, "no.stl", "networks are written as .json, .xml, .gxl, .vtp, .swc, .csv or .txt");
    assert_unsaved(network, "no", "give such a name");
    const vn_network *both[] = {network, network};
    static const char *const names[] = {"a", "b"};
    assert_int_equal(vn_networks_save(both, names, 2, in_folder("no.vtp"), NULL), VN_INVALID);
    assert_message("such a file holds one network, not 2; save each to its own, or all as .json");
    vn_network_destroy(network);
    network = network_of(2);
    put_root(network, 1, 2, 0);
    assert_unsaved(network, "no.txt", "root 0 has no segment");
    put_child(network, 0, 1, 2, 0);
    assert_unsaved(network, "no.txt", "nodes 0 and 1 are at one place");
    vn_network_destroy(network);
    vn_network_set set;
    assert_int_equal(vn_networks_load(&set, in_folder("no.stl")), VN_INVALID);
    assert_message("networks are read as .json");
}

static void extensions_may_be_capitals(void **state) {
    (void)state;
    vn_network *network = full_forest(2, 30, 0, 1);
    save_one(network, in_folder("a.XML"), NULL);
    vn_network *again = load_one(in_folder("a.XML"));
    assert_same_network(network, again, RADII | FLOWS);
    vn_network_destroy(network);
    vn_network_destroy(again);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(a_round_trip_is_exact),
        counted_test(degenerate_networks_survive),
        counted_test(split_edges_survive),
        counted_test(swc_numbers_parents_first),
        counted_test(segments_come_back),
        counted_test(segments_without_their_root_hang_together),
        counted_test(a_file_of_opencco_is_understood),
        counted_test(a_file_of_vascusynth_is_understood),
        counted_test(an_odd_graph_is_understood),
        counted_test(directed_edges_make_parents_or_joins),
        counted_test(undirected_edges_are_turned_away_from_a_root),
        counted_test(gxl_is_what_its_readers_look_for),
        counted_test(the_physics_of_a_tree_can_be_read_from_its_gxl),
        counted_test(without_a_viscosity_there_is_no_resistance),
        counted_test(tables_are_the_documented_ones),
        counted_test(a_manifest_comes_back_where_there_is_a_place_for_it),
        counted_test(foreign_tables_are_understood),
        counted_test(what_a_format_cannot_hold_is_refused),
        counted_test(extensions_may_be_capitals),
    };
    return cmocka_run_group_tests(tests, make_folder, drop_folder);
}
