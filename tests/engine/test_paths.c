// Lines from files, chains of single edges, and vessels that are laid along paths.
#include "files.h"
#include "mesh_support.h"

#include "domain/domain.h"
#include "network/paths.h"

static vn_paths *load(const char *name, const char *text) {
    vn_paths_def def = vn_paths_def_default();
    vn_paths *paths;
    const char *path = in_folder(name);
    put_text(path, text);
    if (vn_paths_load(&paths, path, &def) != VN_OK) {
        fail_msg("%s", vn_message());
    }
    return paths;
}

static void assert_point(const vn_paths *paths, int32_t path, int32_t point, double x, double y, double z) {
    double p[3];
    vn_paths_position(paths, path, point, p);
    assert_near(p[0], x, 1e-12);
    assert_near(p[1], y, 1e-12);
    assert_near(p[2], z, 1e-12);
}

#define PAGE "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 10 10'>"

static void svg_lines_stay_open(void **state) {
    (void)state;
    vn_paths *paths =
        load("open.svg", PAGE "<polyline points='1 1 3 1 3 1 3 2'/><line x1='4' y1='5' x2='4' y2='9'/>"
                              "<path d='M1 9h2m1 0h3'/></svg>");
    assert_int_equal(vn_paths_dim(paths), 2);
    assert_int_equal(vn_paths_count(paths), 4);
    assert_int_equal(vn_paths_size(paths, 0), 3); // the repeated point is one
    assert_point(paths, 0, 0, 1, 9, 0);           // y up
    assert_point(paths, 0, 2, 3, 8, 0);
    assert_point(paths, 1, 0, 4, 5, 0);
    assert_point(paths, 1, 1, 4, 1, 0);
    assert_point(paths, 2, 1, 3, 1, 0);
    assert_point(paths, 3, 0, 4, 1, 0);
    assert_point(paths, 3, 1, 7, 1, 0);
    vn_paths_destroy(paths);
}

static void svg_closed_shapes_end_where_they_begin(void **state) {
    static const char *const shapes[] = {"<path d='M1 1h2v2z'/>", "<polygon points='1 1 3 1 3 3'/>",
                                         "<rect x='1' y='1' width='3' height='2'/>",
                                         "<circle cx='5' cy='5' r='2'/>"};
    static const int least[] = {4, 4, 5, 20};
    (void)state;
    for (int i = 0; i < 4; i++) {
        char text[300];
        snprintf(text, sizeof text, PAGE "%s</svg>", shapes[i]);
        vn_paths *paths = load("closed.svg", text);
        int32_t size = vn_paths_size(paths, 0);
        double first[3], last[3];
        vn_paths_position(paths, 0, 0, first);
        vn_paths_position(paths, 0, size - 1, last);
        assert_int_equal(vn_paths_count(paths), 1);
        assert_true(i < 3 ? size == least[i] : size >= least[i]);
        assert_near(first[0], last[0], 1e-9);
        assert_near(first[1], last[1], 1e-9);
        vn_paths_destroy(paths);
    }
}

static void svg_curves_are_as_near_as_asked(void **state) {
    (void)state;
    const char *path = in_folder("curve.svg");
    vn_paths_def def = {.id = "a", .tolerance = 1e-3};
    vn_paths *paths;
    put_text(
        path, PAGE
        "<path d='M0 0h9'/><g id='a' transform='translate(5 5)'><path d='M-3 0A3 3 0 0 1 3 0'/></g></svg>");
    assert_ok(vn_paths_load(&paths, path, &def));
    assert_int_equal(vn_paths_count(paths), 1); // what is not in the group is left out
    int32_t size = vn_paths_size(paths, 0);
    assert_true(size > 20 && size < 200);
    for (int32_t i = 1; i < size; i++) {
        double a[3], b[3];
        vn_paths_position(paths, 0, i - 1, a);
        vn_paths_position(paths, 0, i, b);
        assert_near(hypot(b[0] - 5, b[1] - 5), 3, 1e-6);
        assert_near(hypot((a[0] + b[0]) / 2 - 5, (a[1] + b[1]) / 2 - 5), 3, 1e-3);
    }
    vn_paths_destroy(paths);
}

static void obj_lines_are_joined_to_chains(void **state) {
    (void)state;
    // As Blender writes a curve, edge by edge; a face is nobody's business.
    vn_paths *paths = load("y.obj", "# a Y\nv 0 0 0\nv 1 0 0 1.0\nv 2 0 0\nv 3 1 0\nv 3 -1 .5\nf 1 2 3\n"
                                    "l 1 2\nl 2/7 3\nl 3 4\nl 3 \\\n -1\n");
    assert_int_equal(vn_paths_dim(paths), 3);
    assert_int_equal(vn_paths_count(paths), 3);
    assert_int_equal(vn_paths_size(paths, 0), 3);
    assert_point(paths, 0, 0, 0, 0, 0);
    assert_point(paths, 0, 2, 2, 0, 0);
    assert_point(paths, 1, 0, 2, 0, 0);
    assert_point(paths, 1, 1, 3, 1, 0);
    assert_point(paths, 2, 1, 3, -1, .5);
    vn_paths_destroy(paths);
}

static void networks_come_root_first(void **state) {
    (void)state;
    // The root has two children, and the file lists a tip first.
    vn_paths *paths = load(
        "tree.swc", "# dim 3\n5 0 3 3 1 1 3\n1 0 0 0 0 1 -1\n2 0 1 0 0 1 1\n3 0 2 2 2 1 2\n4 0 -1 0 0 1 1\n");
    double p[3];
    vn_paths_position(paths, 0, 0, p);
    assert_int_equal(vn_paths_count(paths), 2);
    assert_near(p[0], 0, 0);
    vn_paths_position(paths, 1, 0, p);
    assert_near(p[0], 0, 0);
    assert_int_equal(vn_paths_size(paths, 0) + vn_paths_size(paths, 1), 6);
    vn_paths_destroy(paths);
}

static void one_network_of_several_is_named(void **state) {
    vn_network *a = random_tree(2, 20, 1, 1), *b = random_tree(2, 30, 1, 2);
    const vn_network *both[] = {a, b};
    const char *names[] = {"arteries", "veins"}, *path = in_folder("both.json");
    vn_paths_def def = {.id = "veins"};
    vn_paths *paths;
    (void)state;
    assert_ok(vn_networks_save(both, names, 2, path, NULL));
    assert_ok(vn_paths_load(&paths, path, &def));
    vn_paths_destroy(paths);
    def.id = "vein";
    assert_int_equal(vn_paths_load(&paths, path, &def), VN_INVALID);
    assert_message("did you mean \"veins\"?");
    def.id = NULL;
    assert_int_equal(vn_paths_load(&paths, path, &def), VN_INVALID);
    assert_message("it holds 2 networks: say which by id");
    assert_null(paths);
    vn_network_destroy(a);
    vn_network_destroy(b);
}

typedef struct lie {
    const char *name, *text, *reason;
} lie;

static const lie lies[] = {
    {"a.obj", "", "it has no `l` element"},
    {"a.obj", "v 0 0 0\nv 1 1 1\nf 1 2 2\n", "it has no `l` element"},
    {"a.obj", "l 1 2\n", "line 1: l = \"1\" must be the number of one of the 0 vertices before it"},
    {"a.obj", "v 0 0 0\nv 1 0 0\nl 1 0\n", "line 3: l = \"0\" must be"},
    {"a.obj", "v 0 0 0\nv 1 0 0\nl 1 -3\n", "line 3: l = \"-3\" must be"},
    {"a.obj", "v 0 0 0\nv 1 0 0\nl 1 2147483647\n", "must be the number of one of the 2 vertices"},
    {"a.obj", "v 0 0 0\nv 1 0 0\nl -2147483648 1\n", "must be the number of one of the 2 vertices"},
    {"a.obj", "v 0 0 0\nv 1 0 0\nl 1 1.5\n", "l = \"1.5\" must be"},
    {"a.obj", "v 0 0 0\nv 1 0 0\nl 1 /2\n", "l = \"/2\" must be"},
    {"a.obj", "v 0 0 0\nl 1\n", "line 2: an l joins two vertices or more"},
    {"a.obj", "v 0 0\n", "line 1: a vertex is: v x y z"},
    {"a.obj", "v 0 0", "line 1: a vertex is: v x y z"},
    {"a.obj", "v nan 0 0\n", "line 1: x = \"nan\" must be a number"},
    {"a.obj", "v 0 0 1e999\n", "line 1: z = \"1e999\" must be a number"},
    {"a.obj", "v 0 \x1b[2J 0\n", "y = \"?[2J\" must be a number"},
    {"a.obj", "v 0 0 0\nv 0 0 0\nl 1 2\n", "it has no line of any length"},
    {"a.obj", "v 0 0 0\nv 0 0 0\nl 1 1 1 1\n", "it has no line of any length"},
    {"a.svg", "", "empty"},
    {"a.svg", "<svg xmlns='http://www.w3.org/2000/svg'/>", "it has no line: draw a path"},
    {"a.svg", PAGE "<path d='M1 1L1 1'/></svg>", "it has no line: draw a path"},
    {"a.svg", PAGE "<path d='L1 1'/></svg>", "it has no line: draw a path; the path in line 1"},
    {"a.svg", PAGE "<path d='M1 1L2 2' display='none'/></svg>", "it has no line"},
    {"a.svg", PAGE "<path d='M1 1L2 2'/>", "line 1"},
    {"a.svg", PAGE "<path d='M0 0L1e300 1e300'/></svg>", "a shape larger than"},
    {"a.swc", "1 0 0 0 0 1 -1\n", "it has no line of any length"},
    {"a.swc", "1 0 0 0 0 1 2\n", "parent 2 of node 0 is no node of the file"},
    {"a.stl", "solid\n", "lines are read from .svg, .obj, .swc"},
};

static void lies_are_told_in_one_line(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof lies / sizeof *lies; i++) {
        vn_paths_def def = vn_paths_def_default();
        vn_paths *paths;
        const char *path = in_folder(lies[i].name);
        put_text(path, lies[i].text);
        if (vn_paths_load(&paths, path, &def) == VN_OK) {
            fail_msg("taken: %s", lies[i].text);
        }
        assert_null(paths);
        assert_message(lies[i].reason);
        assert_null(strchr(vn_message(), '\n'));
    }
}

static vn_status load_missing(const char *path) {
    vn_paths_def def = vn_paths_def_default();
    vn_paths *paths;
    return vn_paths_load(&paths, path, &def);
}

static void missing_files_and_wrong_options_are_refused(void **state) {
    (void)state;
    assert_int_equal(load_missing("nowhere.obj"), VN_IO);
    assert_int_equal(load_missing("nowhere.svg"), VN_IO);
    assert_int_equal(load_missing("nowhere.swc"), VN_IO);
    vn_paths_def def = {.tolerance = -1};
    vn_paths *paths;
    assert_int_equal(vn_paths_load(&paths, "a.svg", &def), VN_INVALID);
    assert_message("paths.tolerance = -1");
    assert_int_equal(vn_paths_create(&paths, 4), VN_INVALID);
}

// An SVG or OBJ file that ends anywhere is refused or read, and gives its memory back.
static void files_that_are_cut_off(void **state) {
    static const char *const names[] = {"cut.obj", "cut.svg"};
    static const char *const texts[] = {"v 0 0 0\nv 1 0 0\nv 2 0 0\nl 1 2 3\nl 1 \\\n-1\n",
                                        PAGE "<path d='M1 1C2 2 3 3 4 1z'/><line x2='4'/></svg>"};
    (void)state;
    for (int k = 0; k < 2; k++) {
        for (size_t length = 0; length <= strlen(texts[k]); length++) {
            vn_paths_def def = vn_paths_def_default();
            vn_paths *paths;
            const char *path = in_folder(names[k]);
            put_file(path, texts[k], length);
            bool whole = vn_paths_load(&paths, path, &def) == VN_OK;
            assert_true(whole || vn_message()[0] != '\0');
            vn_paths_destroy(paths);
        }
    }
}

// ------------------------------------------------------------------------------------------ chains

enum { MOST = 40 };

/// How often each pair of vertices is joined.
typedef struct pairs {
    int count[MOST][MOST];
    int degree[MOST];
} pairs;

static void join(pairs *p, int32_t a, int32_t b) {
    p->count[a < b ? a : b][a < b ? b : a]++;
    p->degree[a]++;
    p->degree[b]++;
}

// Vertex i is at x = i.
static int32_t vertex_at(const vn_paths *paths, int32_t path, int32_t point) {
    double p[3];
    vn_paths_position(paths, path, point, p);
    return (int32_t)p[0];
}

static void check_chains(const vn_paths *paths, const pairs *given) {
    pairs found = {0};
    int part[MOST]; // which part a vertex that was met belongs to
    int parts = 0;
    for (int i = 0; i < MOST; i++) {
        part[i] = -1;
    }
    for (int32_t path = 0; path < vn_paths_count(paths); path++) {
        int32_t size = vn_paths_size(paths, path), a = vertex_at(paths, path, 0);
        part[a] = part[a] < 0 ? parts++ : part[a];
        for (int32_t i = 1; i < size; i++) {
            int32_t b = vertex_at(paths, path, i);
            join(&found, a, b);
            // Nothing is reached from two parts, and only at ends and branchings a chain may end.
            assert_true(part[b] < 0 || part[b] == part[a]);
            assert_true(i == size - 1 || given->degree[b] == 2);
            part[b] = part[a];
            a = b;
        }
    }
    assert_memory_equal(found.count, given->count, sizeof found.count);
}

static void chains_are_the_wires(void **state) {
    vn_rng rng = vn_rng_make(7);
    (void)state;
    for (int round = 0; round < 400; round++) {
        vn_wires wires = {0};
        pairs given = {0};
        int32_t vertices = (int32_t)whole(&rng, 2, MOST), count = (int32_t)whole(&rng, 0, 60);
        for (int32_t i = 0; i < 3 * vertices; i++) {
            assert_ok(vn_array_push(&wires.xyz, i % 3 == 0 ? i / 3 : 0));
        }
        for (int32_t i = 0; i < count; i++) {
            // Mostly chains, some branchings, loops and double wires.
            int32_t a = (int32_t)whole(&rng, 0, vertices - 1);
            int32_t b = round % 2 == 0 ? (a + 1) % vertices : (int32_t)whole(&rng, 0, vertices - 1);
            if (a != b) {
                join(&given, a, b);
                assert_ok(vn_array_push(&wires.from, a));
                assert_ok(vn_array_push(&wires.to, b));
            }
        }
        vn_paths *paths;
        assert_ok(vn_paths_create(&paths, 3));
        assert_ok(vn_paths_from_wires(paths, &wires));
        check_chains(paths, &given);
        vn_paths_destroy(paths);
        vn_wires_free(&wires);
    }
}

// A star of a hundred thousand rays, and as many double wires: each is looked at once.
static void chains_of_a_star_take_no_longer(void **state) {
    enum { RAYS = 100000 };
    vn_wires wires = {0};
    vn_paths *paths;
    (void)state;
    for (int32_t i = 0; i < 3 * (RAYS + 2); i++) {
        assert_ok(vn_array_push(&wires.xyz, i));
    }
    for (int32_t i = 0; i < RAYS; i++) { // from vertex 0 by way of a ray's own vertex to vertex 1
        assert_ok(vn_array_push(&wires.from, 0));
        assert_ok(vn_array_push(&wires.to, i + 2));
        assert_ok(vn_array_push(&wires.from, i + 2));
        assert_ok(vn_array_push(&wires.to, 1));
    }
    assert_ok(vn_paths_create(&paths, 3));
    vn_set_time_budget(5); // by quadratic ways it would be minutes
    assert_ok(vn_paths_from_wires(paths, &wires));
    vn_set_time_budget(0);
    assert_int_equal(vn_paths_count(paths), RAYS);
    vn_paths_destroy(paths);
    vn_wires_free(&wires);
}

// ------------------------------------------------------------------------------------------ following

static vn_paths *path_of(int dim, const double *xyz, int32_t points) {
    vn_paths *paths;
    assert_ok(vn_paths_create(&paths, dim));
    for (int32_t i = 0; i < points; i++) {
        assert_ok(vn_paths_point(paths, xyz + 3 * i));
    }
    assert_ok(vn_paths_end(paths));
    return paths;
}

static double way_length(const double *xyz, int32_t points) {
    double length = 0;
    for (int32_t i = 1; i < points; i++) {
        const double *a = xyz + 3 * (i - 1), *b = xyz + 3 * i;
        length += sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                       (a[2] - b[2]) * (a[2] - b[2]));
    }
    return length;
}

// The slow way: where one is after `due` of the way.
static void place_on_way(const double *xyz, int32_t points, double due, double p[3]) {
    for (int32_t i = 1; i < points; i++) {
        double leg = way_length(xyz + 3 * (i - 1), 2);
        if (due <= leg || i == points - 1) {
            for (int k = 0; k < 3; k++) {
                p[k] = xyz[3 * (i - 1) + k] +
                       (leg > 0 ? fmin(1, due / leg) : 0) * (xyz[3 * i + k] - xyz[3 * (i - 1) + k]);
            }
            return;
        }
        due -= leg;
    }
}

static void nodes_lie_evenly_on_the_way(void **state) {
    vn_rng rng = vn_rng_make(3);
    (void)state;
    for (int turn = 0; turn < 300; turn++) {
        double xyz[3 * 12] = {0};
        int32_t points = (int32_t)whole(&rng, 2, 12), added, first;
        int dim = turn % 2 == 0 ? 2 : 3;
        for (int32_t i = 0; i < 3 * points; i++) {
            bool again = i >= 3 && whole(&rng, 0, 9) == 0; // corners of one coordinate, and repeated points
            xyz[i] = i % 3 >= dim ? 0 : again ? xyz[i - 3] : uniform(&rng, 0, 1);
        }
        vn_follow_def def = vn_follow_def_default();
        def.length = exp(uniform(&rng, log(1e-3), log(3)));
        vn_network *network = network_of(dim);
        vn_paths *paths = path_of(dim, xyz, points);
        assert_ok(vn_network_follow(network, paths, &def, &added, &first));
        double length = way_length(xyz, points);
        int32_t parts = (int32_t)fmax(1, round(length / def.length));
        assert_int_equal(first, 0);
        assert_int_equal(added, parts + 1);
        for (int32_t i = 0; i <= parts; i++) {
            double p[3] = {0};
            place_on_way(xyz, points, length * i / parts, p);
            assert_near(vn_network_x(network)[i], p[0], 1e-9);
            assert_near(vn_network_y(network)[i], p[1], 1e-9);
            assert_int_equal(vn_network_parent(network)[i], i - 1);
        }
        // The last node is the last point, to the bit.
        assert_true(vn_network_x(network)[parts] == xyz[3 * points - 3]);
        vn_paths_destroy(paths);
        vn_network_destroy(network);
    }
}

static vn_follow_def steps_of(double length, double within, vn_domain *domain) {
    vn_follow_def def = vn_follow_def_default();
    def.length = length;
    def.within = within;
    def.domain = domain;
    def.name = "guides";
    return def;
}

// Follow one path; the status.
static vn_status follow(vn_network *network, const vn_follow_def *def, const double *xyz, int32_t points) {
    vn_paths *paths = path_of(vn_network_dim(network), xyz, points);
    vn_status status = vn_network_follow(network, paths, def, NULL, NULL);
    vn_paths_destroy(paths);
    return status;
}

#define FOLLOW(network, def, ...)                                                                            \
    follow((network), (def), (const double[]){__VA_ARGS__}, (int32_t)(sizeof((double[]){__VA_ARGS__}) / 24))

static void later_paths_begin_at_earlier_ones(void **state) {
    vn_network *network = network_of(2);
    vn_murray_def law = {.exponent = 3, .tip_radius = 1};
    vn_follow_def def = steps_of(0.1, 0.3, NULL);
    (void)state;
    assert_ok(vn_network_murray(network, &law));
    assert_ok(FOLLOW(network, &def, 0, 0, 0, 1, 0, 0));
    assert_ok(FOLLOW(network, &def, 0.5, 0, 0, 0.5, 1, 0));    // on node 5
    assert_ok(FOLLOW(network, &def, 0.73, 0, 0, 0.73, -1, 0)); // nearer to node 7 than half a segment
    assert_ok(FOLLOW(network, &def, 1, 0.2, 0, 1, 1, 0));      // a gap of two segments
    const int32_t *parent = vn_network_parent(network);
    int32_t count = vn_network_count(network);
    assert_int_equal(parent[11], 5);
    assert_int_equal(parent[21], 7);
    assert_near(vn_network_y(network)[22], -0.2, 0.01);
    assert_int_equal(count, 11 + 10 + 10 + 10);
    assert_int_equal(parent[31], 10);
    assert_near(vn_network_y(network)[31], 0.1, 1e-9);
    assert_near(vn_network_radius(network, 1), cbrt(3), 1e-9);
    vn_network_destroy(network);
}

static void what_cannot_be_followed_is_refused(void **state) {
    vn_network *network = network_of(2);
    vn_domain *disk = disk_of(0, 0, 1);
    vn_follow_def def = steps_of(0.1, 0.3, disk);
    (void)state;
    assert_int_equal(FOLLOW(network, &def, 0, 0, 0, 2, 0, 0), VN_INVALID);
    assert_message("guides[1]: point 2 at (2, 0) is outside the domain, by 1");
    assert_int_equal(vn_network_count(network), 1); // the root that it made stays
    assert_ok(FOLLOW(network, &def, 0.2, 0, 0));    // a mere point is gone to
    assert_int_equal(vn_network_count(network), 3);
    assert_ok(FOLLOW(network, &def, 0.2, 0, 0)); // and no more than once
    assert_int_equal(vn_network_count(network), 3);
    vn_network_destroy(network);

    network = network_of(2);
    assert_ok(FOLLOW(network, &def, -1, 0, 0, 0, 0, 0, 0.5, 0, 0)); // from the border itself
    assert_int_equal(FOLLOW(network, &def, 0, 0.9, 0, 0, 0.5, 0), VN_INVALID);
    assert_message(
        "guides[1]: it begins at (0, 0.9), 0.9 from the nearest vessel, and may be 0.3 at most: begin it");
    assert_int_equal(FOLLOW(network, &def, 0, 0.9, 0, 0, 0.1, 0), VN_INVALID);
    assert_message("its end is near one, so give its points in reverse");
    assert_ok(FOLLOW(network, &def, 0, 0, 0, 0, 0.5, 0));
    assert_int_equal(FOLLOW(network, &def, 0, 0, 0, 0, -0.5, 0), VN_INVALID);
    assert_message("it would be the third vessel from the fork at (0, 0): begin it 0.1 or more away");
    assert_int_equal(FOLLOW(network, &def, 0.2, 0, 0, 0.5, 0, 0), VN_INVALID);
    assert_message("from (0.2, 0) on it lies on another one");
    def.length = 1e-12;
    assert_int_equal(FOLLOW(network, &def, 0.3, 0, 0, 0.3, 0.5, 0), VN_LIMIT);
    assert_message("more than 100000000 segments long");
    def.length = 0;
    assert_int_equal(FOLLOW(network, &def, 0, 0, 0, 1, 0, 0), VN_INVALID);
    def = steps_of(1, 1e150, NULL);
    assert_int_equal(FOLLOW(network, &def, -1e200, 0, 0, 1e200, 1, 0),
                     VN_INVALID); // farther than is measured
    vn_network_destroy(network);
    network = network_of(2);
    assert_int_equal(FOLLOW(network, &def, -1e200, 0, 0, 1e200, 1, 0), VN_LIMIT);
    vn_network_destroy(network);
    network = network_of(3);
    def.domain = disk;
    assert_int_equal(FOLLOW(network, &def, 0, 0, 0, 1, 0, 0), VN_INVALID);
    assert_message("follow.domain has 2 dimensions, the network 3");
    vn_network_destroy(network);
    vn_domain_release(disk);
}

// Points may be inside while the way between them is not, and corners may be cut across a notch.
static void a_way_outside_is_refused(void **state) {
    vn_network *network = network_of(2);
    vn_domain *u = u_shape(); // a slot from above
    vn_follow_def def = steps_of(0.5, 1, u);
    (void)state;
    assert_int_equal(FOLLOW(network, &def, 1, 9, 0, 9, 9, 0), VN_INVALID);
    assert_message("guides[1]: before point 2 it leaves the domain, near");
    vn_network_destroy(network);
    network = network_of(2);
    assert_ok(FOLLOW(network, &def, 1, 9, 0, 1, 1, 0, 9, 1, 0, 9, 9, 0));
    for (int32_t i = 1; i < vn_network_count(network); i++) {
        double p[3], q[3];
        vn_network_position(network, i, p);
        vn_network_position(network, vn_network_parent(network)[i], q);
        assert_true(vn_domain_contains(u, p) && vn_domain_sees(u, q, p));
    }
    vn_network_destroy(network);
    vn_domain_release(u);
}

static vn_domain *globe_surface(double radius) {
    mesh m = globe(30, radius);
    vn_domain *domain = NULL;
    assert_ok(vn_domain_surface(&domain, m.xyz.data, m.xyz.count / 3, m.corners.data, m.corners.count / 3));
    free_mesh(&m);
    return domain;
}

// Three points a quarter of a globe apart: the chords go through it, the vessels do not.
static void paths_are_brought_onto_a_surface(void **state) {
    vn_domain *surface = globe_surface(1);
    vn_network *network = network_of(3);
    vn_follow_def def = steps_of(0.05, 0.35, surface);
    (void)state;
    assert_ok(FOLLOW(network, &def, 1.1, 0, 0, 0, 0.95, 0, -1, 0, 0.01));
    int32_t count = vn_network_count(network);
    double half = pi * 1 / 0.05; // half a great circle in segments
    assert_true(count > 0.95 * half && count < 1.1 * half);
    for (int32_t i = 1; i < count; i++) {
        double p[3], q[3];
        vn_network_position(network, i, p);
        vn_network_position(network, vn_network_parent(network)[i], q);
        assert_true(vn_domain_contains(surface, p));
        assert_true(vn_domain_sees(surface, q, p));
        assert_near(sqrt(vn_distance2(p, q)), 0.05, 0.01);
    }
    assert_int_equal(FOLLOW(network, &def, 0, 1, 0, 0, 1.5, 0), VN_INVALID);
    assert_message("guides[1]: point 2 at (0, 1.5, 0) is outside the domain, by 0.5");
    assert_int_equal(FOLLOW(network, &def, 0, 1, 0, 0, 0, 1), VN_OK);
    def.within = 0.1;
    assert_int_equal(FOLLOW(network, &def, 0, 0, 1, 1, 0, 0), VN_INVALID);
    assert_message("it leaves the domain, near");
    assert_message("give more points along the surface");
    vn_network_destroy(network);
    vn_domain_release(surface);
}

// Ten times as many guides, ten times as many nodes in the way: no more for each.
static void many_paths_cost_no_more_each(void **state) {
    enum { PATHS = 100000 };
    vn_network *network = network_of(2);
    vn_paths *paths;
    vn_follow_def def = steps_of(1, 2, NULL);
    (void)state;
    assert_ok(vn_paths_create(&paths, 2));
    for (int32_t i = 0; i < PATHS; i++) { // a comb whose back is as long as there are teeth
        double a[3] = {i, 0, 0}, b[3] = {i + 1, 0, 0}, tip[3] = {i + 1, 3, 0};
        assert_ok(vn_paths_point(paths, a));
        assert_ok(vn_paths_point(paths, b));
        assert_ok(vn_paths_end(paths));
        assert_ok(vn_paths_point(paths, b));
        assert_ok(vn_paths_point(paths, tip));
        assert_ok(vn_paths_end(paths));
    }
    vn_set_time_budget(10);
    assert_ok(vn_network_follow(network, paths, &def, NULL, NULL));
    vn_set_time_budget(0);
    assert_int_equal(vn_network_count(network), 1 + 4 * PATHS);
    vn_paths_destroy(paths);
    vn_network_destroy(network);
}

static vn_status load_and_follow(const char *path) {
    vn_paths_def how = vn_paths_def_default();
    vn_follow_def def = steps_of(0.1, 1, NULL);
    vn_network_def blank = vn_network_def_default();
    vn_paths *paths = NULL;
    vn_network *network = NULL;
    vn_status status = vn_paths_load(&paths, path, &how);
    if (status == VN_OK) {
        blank.dim = vn_paths_dim(paths);
        status = vn_network_create(&network, &blank);
    }
    status = status == VN_OK ? vn_network_follow(network, paths, &def, NULL, NULL) : status;
    vn_network_destroy(network);
    vn_paths_destroy(paths);
    return status;
}

static void no_failed_allocation_loses_memory(void **state) {
    static const char *const names[] = {"y.obj", "line.svg", "y.swc"};
    static const char *const texts[] = {"v 0 0 0\nv 1 0 0\nv 2 1 0\nv 2 -1 0\nl 1 2 3\nl 2 4\n",
                                        PAGE "<path d='M1 1C2 2 3 3 4 1'/></svg>",
                                        "1 0 0 0 0 1 -1\n2 0 1 0 0 1 1\n3 0 2 1 0 1 2\n4 0 2 -1 0 1 2\n"};
    (void)state;
    for (int k = 0; k < 3; k++) {
        const char *path = in_folder(names[k]);
        vn_status status = VN_NO_MEMORY;
        int refused = 0;
        put_text(path, texts[k]);
        for (; status != VN_OK && refused < 10000; refused++) {
            size_t before = vn_byte_count();
            vn_fail_allocations_from(refused);
            status = load_and_follow(path);
            vn_fail_allocations_from(-1);
            assert_true(status == VN_OK || status == VN_NO_MEMORY);
            assert_int_equal(vn_byte_count(), before);
        }
        assert_int_equal(status, VN_OK);
        assert_true(refused > 10);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(svg_lines_stay_open),
        counted_test(svg_closed_shapes_end_where_they_begin),
        counted_test(svg_curves_are_as_near_as_asked),
        counted_test(obj_lines_are_joined_to_chains),
        counted_test(networks_come_root_first),
        counted_test(one_network_of_several_is_named),
        counted_test(lies_are_told_in_one_line),
        counted_test(missing_files_and_wrong_options_are_refused),
        counted_test(files_that_are_cut_off),
        counted_test(chains_are_the_wires),
        counted_test(chains_of_a_star_take_no_longer),
        counted_test(nodes_lie_evenly_on_the_way),
        counted_test(later_paths_begin_at_earlier_ones),
        counted_test(what_cannot_be_followed_is_refused),
        counted_test(a_way_outside_is_refused),
        counted_test(paths_are_brought_onto_a_surface),
        counted_test(many_paths_cost_no_more_each),
        counted_test(no_failed_allocation_loses_memory),
    };
    return cmocka_run_group_tests(tests, make_folder, drop_folder);
}
