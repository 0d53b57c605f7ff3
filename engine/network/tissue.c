// How far tissue is from the nearest vessel.

#include "network/distance_map.h"
#include "network/leaf.h"
#include "network/vessels.h"
#include "space/triangle_tree.h"

static const vn_tissue_def tissue_default = {.bins = 20};

static const vn_field tissue_fields[] = {
    {"domain", VN_OBJECT, VN_REQUIRED, offsetof(vn_tissue_def, domain), 0, 0, "", "domain",
     "the tissue: flat, solid or a surface"},
    {"from", VN_CHOICE, 0, offsetof(vn_tissue_def, from), 0, 0, "", "surface|centerline",
     "of vessels; where no radii are known it is the center line"},
    {"reach", VN_F64, VN_ABOVE_MIN | VN_OPTIONAL, offsetof(vn_tissue_def, reach), 0, VN_HUGE, "length", NULL,
     "tissue at most this far from a vessel is perfused; left out: not asked"},
    {"resolution", VN_F64, VN_ABOVE_MIN | VN_OPTIONAL, offsetof(vn_tissue_def, resolution), 0, VN_HUGE,
     "length", NULL,
     "spacing of the points; left out: 40,000 in an area or on a surface, 262,144 in a volume"},
    {"bins", VN_I32, 0, offsetof(vn_tissue_def, bins), 1, 10000, "bins", NULL,
     "of the histogram, from 0 to the largest distance"},
};
const vn_schema vn_tissue_schema =
    VN_SCHEMA("measure_tissue", "Distance of tissue from vessels", tissue_fields, tissue_default);

vn_tissue_def vn_tissue_def_default(void) {
    return tissue_default;
}

typedef struct vessels {
    VN_ARRAY(vn_triangle) lines; // degenerate ones
    VN_ARRAY(double) radii;
    vn_triangle_tree tree;
} vessels;

static void free_vessels(vessels *v) {
    vn_array_free(&v->lines);
    vn_array_free(&v->radii);
    vn_triangle_tree_free(&v->tree);
}

static vn_status add_vessel(vessels *v, const vn_network *network, int32_t from, int32_t to, double radius) {
    vn_triangle line;
    vn_network_position(network, from, line.a);
    vn_network_position(network, to, line.b);
    memcpy(line.c, line.b, sizeof line.c);
    VN_TRY(vn_array_push(&v->lines, line));
    return vn_array_push(&v->radii, radius);
}

// A root is a point, which counts where nothing hangs from it.
static vn_status list_vessels(vessels *v, const vn_network *network) {
    for (int32_t i = 0; i < network->x.count; i++) {
        int32_t parent = network->parent.data[i];
        VN_TRY(parent >= 0 ? add_vessel(v, network, parent, i, vn_network_radius(network, i))
                           : add_vessel(v, network, i, i, 0));
    }
    for (int32_t i = 0; i < network->joins.count; i++) {
        int32_t a, b;
        double radius;
        vn_network_join_ends(network, i, &a, &b, &radius);
        VN_TRY(add_vessel(v, network, a, b, radius));
    }
    return VN_OK;
}

static double nearest_vessel(const void *payload, const double p[3]) {
    double d2, q[3];
    vn_triangle_tree_nearest(payload, p, INFINITY, &d2, q);
    return sqrt(d2);
}

// ---- What the distances say ----

static void fill_histogram(vn_tissue *out, const vn_distance_list *list) {
    out->bin = out->distance.max / out->bins;
    for (int32_t i = 0; i < list->count; i++) {
        double at = out->bin > 0 ? list->data[i] / out->bin : 0;
        out->histogram[at < out->bins ? (int32_t)at : out->bins - 1]++;
    }
}

static double share_within(const vn_distance_list *list, double reach) {
    int32_t within = 0;
    for (int32_t i = 0; i < list->count; i++) {
        within += list->data[i] <= reach;
    }
    return (double)within / list->count;
}

static vn_status describe(vn_tissue *out, const vn_tissue_def *def, const vn_distance_map *map, bool thick) {
    const vn_distance_list *list = map->list;
    if (map->points == 0) {
        return vn_fail(VN_INVALID, "measure_tissue.resolution = %g puts no point into the domain; give less",
                       map->resolution);
    }
    size_t size = (size_t)def->bins * sizeof *out->histogram;
    out->histogram = vn_new_block(size);
    if (out->histogram == NULL) {
        return vn_fail_memory("a histogram", size);
    }
    out->bins = def->bins;
    out->resolution = map->resolution;
    out->points = map->points;
    out->mode = map->mode;
    memcpy(out->furthest, map->furthest, sizeof out->furthest);
    VN_TRY(vn_statistics_of(&out->distance, list->data, list->count));
    fill_histogram(out, list);
    out->lumen = thick ? share_within(list, 0) : 0;
    out->perfused = def->reach > 0 ? share_within(list, def->reach) : 0;
    return VN_OK;
}

static vn_status measure(vn_tissue *out, const vn_network *network, const vn_tissue_def *def, vessels *v) {
    bool thick = def->from == VN_FROM_SURFACE && vn_network_has_radii(network);
    vn_distance_list list = {0};
    VN_TRY(list_vessels(v, network));
    VN_TRY(
        vn_triangle_tree_build_thick(&v->tree, v->lines.data, thick ? v->radii.data : NULL, v->lines.count));
    vn_distance_map map = {.what = "measure_tissue",
                           .area = def->domain,
                           .resolution = def->resolution,
                           .nearest = nearest_vessel,
                           .payload = &v->tree,
                           .list = &list};
    vn_status status = vn_distance_map_draw(&map);
    status = status == VN_OK ? describe(out, def, &map, thick) : status;
    vn_array_free(&list);
    return status;
}

static vn_status check_request(const vn_network *network, const vn_tissue_def *def) {
    VN_TRY(vn_check_def(&vn_tissue_schema, def));
    if (vn_domain_dim(def->domain) != network->dim) {
        return vn_fail(
            VN_INVALID,
            "measure_tissue.domain is in %dD and the network in %dD; both must be of one dimension",
            vn_domain_dim(def->domain), network->dim);
    }
    if (network->x.count == 0) {
        return vn_fail(VN_INVALID, "measure_tissue: the network is empty; grow or load it first");
    }
    return vn_check_places(network, "measure_tissue");
}

vn_status vn_network_measure_tissue(const vn_network *network, const vn_tissue_def *def, vn_tissue *out) {
    *out = (vn_tissue){0};
    VN_TRY(check_request(network, def));
    vessels v = {0};
    vn_tissue made = {0};
    vn_status status = measure(&made, network, def, &v);
    free_vessels(&v);
    if (status != VN_OK) {
        vn_tissue_free(&made);
        return status;
    }
    *out = made;
    return VN_OK;
}

void vn_tissue_free(vn_tissue *tissue) {
    int32_t *histogram = tissue->histogram;
    vn_resize(histogram, histogram != NULL ? (size_t)tissue->bins * sizeof *histogram : 0, 0);
    *tissue = (vn_tissue){0};
}
