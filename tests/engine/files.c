#define _DEFAULT_SOURCE // mkdtemp
#include "files.h"

#include <dirent.h>
#include <unistd.h>

static char folder[] = "/tmp/venule-files-XXXXXX";

int make_folder(void **state) {
    (void)state;
    return mkdtemp(folder) != NULL ? 0 : -1;
}

int drop_folder(void **state) {
    (void)state;
    DIR *entries = opendir(folder);
    for (struct dirent *entry = readdir(entries); entry != NULL; entry = readdir(entries)) {
        if (strstr(entry->d_name, ".part") == NULL && entry->d_name[0] != '.') {
            unlink(in_folder(entry->d_name));
        }
    }
    closedir(entries);
    return rmdir(folder);
}

const char *in_folder(const char *name) {
    static char paths[8][320];
    static int next;
    char *path = paths[next++ % 8];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}

void put_file(const char *path, const char *text, size_t size) {
    unlink(path); // some file systems wait for the disk when a file is emptied and written again
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

void put_text(const char *path, const char *text) {
    put_file(path, text, strlen(text));
}

char *take_file(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    char *bytes = calloc(*size + 1, 1);
    assert_int_equal(fread(bytes, 1, *size, file), *size);
    fclose(file);
    return bytes;
}

static void give_flow(vn_network *network, vn_rng *rng) {
    int32_t count = vn_network_count(network);
    double *flow = calloc((size_t)count + 1, sizeof *flow),
           *pressure = calloc((size_t)count + 1, sizeof *flow);
    for (int32_t i = 0; i < count; i++) {
        flow[i] = uniform(rng, -1, 9);
        pressure[i] = uniform(rng, 7000, 14000);
    }
    assert_ok(vn_network_set_flow(network, flow, pressure));
    free(flow);
    free(pressure);
}

// At a root the radius is that of the thickest child, so that no file says anything else.
static void give_radii(vn_network *network, vn_rng *rng) {
    int32_t count = vn_network_count(network);
    double *radius = calloc((size_t)count + 1, sizeof *radius);
    for (int32_t i = 0; i < count; i++) {
        bool root = vn_network_parent(network)[i] < 0;
        radius[i] = root ? 0 : pow(10, uniform(rng, -3, 1));
    }
    assert_ok(vn_network_set_radii(network, radius));
    free(radius);
}

vn_network *full_forest(int dim, int32_t nodes, int32_t joins, uint64_t seed) {
    vn_network_def def = {.dim = dim, .max_nodes = 1000000, .unit = "mm"};
    vn_network *network;
    assert_ok(vn_network_create(&network, &def));
    vn_rng rng = vn_rng_make(seed);
    for (int32_t i = 0; i < nodes; i++) {
        double size = pow(10, uniform(&rng, -20, 20));
        double x = uniform(&rng, -1, 1) * size, y = uniform(&rng, -100, 100);
        double z = dim == 3 ? uniform(&rng, -1, 1) : 0;
        vn_network_set_step(network, i / 7);
        bool root = i == 0 || whole(&rng, 0, 30) == 0;
        if (root) {
            put_root(network, x, y, z);
        } else {
            put_child(network, (int32_t)whole(&rng, i > 9 ? i - 9 : 0, i - 1), x, y, z);
        }
    }
    give_radii(network, &rng);
    for (int32_t i = 0; i < joins; i++) { // refused where they are neighbours
        vn_network_join(network, (int32_t)whole(&rng, 0, nodes - 1), (int32_t)whole(&rng, 0, nodes - 1),
                        uniform(&rng, 0, 2));
    }
    give_flow(network, &rng);
    return network;
}

vn_network *load_one(const char *path) {
    vn_network_set set;
    vn_status status = vn_networks_load(&set, path);
    if (status != VN_OK) {
        fail_msg("%s", vn_message());
    }
    assert_int_equal(set.count, 1);
    vn_network *network = set.networks[0];
    set.networks[0] = NULL;
    vn_networks_free(&set);
    return network;
}

void save_one(const vn_network *network, const char *path, const char *manifest) {
    if (vn_network_save(network, path, manifest) != VN_OK) {
        fail_msg("%s", vn_message());
    }
}

static void assert_same_numbers(const double *a, const double *b, int32_t count, const char *what) {
    assert_int_equal(a == NULL, b == NULL);
    for (int32_t i = 0; i < count && a != NULL && b != NULL; i++) {
        if (a[i] != b[i]) {
            fail_msg("%s of node %d was %.17g and is %.17g", what, i, a[i], b[i]);
        }
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

static void assert_same_radii(const vn_network *a, const vn_network *b) {
    for (int32_t i = 0; i < vn_network_count(a); i++) {
        assert_true(vn_network_radius(a, i) == vn_network_radius(b, i));
    }
}

void assert_same_network(const vn_network *a, const vn_network *b, unsigned what) {
    int32_t count = vn_network_count(a);
    assert_int_equal(vn_network_dim(a), vn_network_dim(b));
    assert_int_equal(count, vn_network_count(b));
    assert_same_numbers(vn_network_x(a), vn_network_x(b), count, "x");
    assert_same_numbers(vn_network_y(a), vn_network_y(b), count, "y");
    assert_same_numbers(vn_network_z(a), vn_network_z(b), count, "z");
    for (int32_t i = 0; i < count; i++) {
        assert_int_equal(vn_network_parent(a)[i], vn_network_parent(b)[i]);
        assert_int_equal(vn_network_tree(a)[i], vn_network_tree(b)[i]);
        assert_true((what & BIRTHS) == 0 || vn_network_birth(a)[i] == vn_network_birth(b)[i]);
    }
    if ((what & RADII) != 0) {
        assert_same_radii(a, b);
    }
    if ((what & FLOWS) != 0) {
        assert_same_numbers(vn_network_flow(a), vn_network_flow(b), count, "flow");
    }
    if ((what & PRESSURES) != 0) {
        assert_same_numbers(vn_network_pressure(a), vn_network_pressure(b), count, "pressure");
    }
    if ((what & JOINS) != 0) {
        assert_same_joins(a, b);
    }
    if ((what & UNITS) != 0) {
        assert_string_equal(vn_network_unit(a), vn_network_unit(b));
    }
}
