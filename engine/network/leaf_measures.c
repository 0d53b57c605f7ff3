// The measures that botanists use. Where faces are the matter, faces.c has found them.

#include "network/leaf.h"

static const double pi = 3.141592653589793;

static const vn_leaf_def leaf_default = {0};

static const vn_field leaf_fields[] = {
    {"leaf", VN_MIXED, 0, 0, 0, 0, "", "true or false",
     "measure it as botanists measure leaves too (2D): the field `leaf` of what comes back"},
    {"domain", VN_OBJECT, 0, offsetof(vn_leaf_def, domain), 0, 0, "", "domain",
     "the blade, whose area counts; left out: the convex hull of the nodes"},
    {"resolution", VN_F64, VN_ABOVE_MIN | VN_OPTIONAL, offsetof(vn_leaf_def, resolution), 0, VN_HUGE,
     "length", NULL, "spacing of the points of the map of distances to veins; left out: 40,000 in the area"},
};
const vn_schema vn_leaf_schema = VN_SCHEMA("measure", "Measures of a network", leaf_fields, leaf_default);

vn_leaf_def vn_leaf_def_default(void) {
    return leaf_default;
}

// ---- Statistics ----

static double at_share(const vn_keyed_array *sorted, const double *values, double share) {
    double place = share * (sorted->count - 1);
    int32_t i = (int32_t)place, next = i + 1 < sorted->count ? i + 1 : i;
    double low = values[sorted->data[i].value], high = values[sorted->data[next].value];
    return low + (place - i) * (high - low);
}

static void describe(vn_statistics *out, const vn_keyed_array *sorted, const double *values) {
    out->count = sorted->count;
    for (int32_t i = 0; i < sorted->count; i++) {
        out->mean += values[i];
    }
    out->mean /= sorted->count;
    for (int32_t i = 0; i < sorted->count; i++) {
        out->deviation += (values[i] - out->mean) * (values[i] - out->mean);
    }
    out->deviation = sqrt(out->deviation / sorted->count);
    out->min = at_share(sorted, values, 0);
    out->lower = at_share(sorted, values, 0.25);
    out->median = at_share(sorted, values, 0.5);
    out->upper = at_share(sorted, values, 0.75);
    out->max = at_share(sorted, values, 1);
}

vn_status vn_statistics_of(vn_statistics *out, const double *values, int32_t count) {
    *out = (vn_statistics){0};
    vn_keyed_array keys = {0}, scratch = {0};
    vn_status status = vn_array_reserve(&keys, count);
    for (int32_t i = 0; status == VN_OK && i < count; i++) {
        keys.data[keys.count++] = (vn_keyed){vn_sortable(values[i]), i};
    }
    status = status == VN_OK ? vn_sort_keyed(&keys, &scratch) : status;
    if (status == VN_OK && count > 0) {
        describe(out, &keys, values);
    }
    vn_array_free(&keys);
    vn_array_free(&scratch);
    return status;
}

// ---- Lengths ----

static double by_area(const vn_leaf_measures *m, double value) {
    return m->area > 0 ? value / m->area : 0;
}

typedef struct vein_orders {
    const int32_t *of_nodes;
    VN_ARRAY(int32_t) computed;
} vein_orders;

static vn_status find_orders(vein_orders *orders, const vn_network *network) {
    orders->of_nodes = vn_network_orders(network);
    if (orders->of_nodes == NULL) {
        vn_orders_def def = {.kind = VN_HICKEY};
        VN_TRY(vn_array_zero(&orders->computed, network->x.count));
        VN_TRY(vn_network_compute_orders(network, &def, orders->computed.data));
        orders->of_nodes = orders->computed.data;
    }
    return VN_OK;
}

static double length_between(const vn_network *network, int32_t a, int32_t b) {
    double dx = network->x.data[a] - network->x.data[b], dy = network->y.data[a] - network->y.data[b];
    return sqrt(dx * dx + dy * dy);
}

static void add_lengths(vn_leaf_measures *m, const vn_network *network, const int32_t *orders) {
    for (int32_t i = 0; i < network->x.count; i++) {
        int32_t parent = network->parent.data[i];
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): an order for every node, and room for it
        m->order_density[orders[i] - 1] += parent >= 0 ? length_between(network, i, parent) : 0;
    }
    for (int32_t i = 0; i < network->joins.count; i++) {
        int32_t a = network->joins.data[i].a, b = network->joins.data[i].b;
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): a join has nodes
        int32_t order = orders[a] > orders[b] ? orders[a] : orders[b];
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): a join has nodes
        m->order_density[order - 1] += length_between(network, a, b);
    }
    for (int32_t k = 0; k < m->order_count; k++) {
        m->length += m->order_density[k];
        m->order_density[k] = by_area(m, m->order_density[k]);
    }
    m->density = by_area(m, m->length);
}

static vn_status new_list(double **list, int32_t count) {
    size_t size = (size_t)count * sizeof **list;
    *list = count > 0 ? vn_new_block(size) : NULL;
    return count > 0 && *list == NULL ? vn_fail_memory("a list of measures", size) : VN_OK;
}

static vn_status measure_lengths(vn_leaf_measures *m, const vn_network *network) {
    vein_orders orders = {0};
    vn_status status = find_orders(&orders, network);
    int32_t highest = 0;
    for (int32_t i = 0; status == VN_OK && i < network->x.count; i++) {
        highest = orders.of_nodes[i] > highest ? orders.of_nodes[i] : highest;
    }
    status = status == VN_OK ? new_list(&m->order_density, highest) : status;
    if (status == VN_OK) {
        m->order_count = highest;
        add_lengths(m, network, orders.of_nodes);
    }
    vn_array_free(&orders.computed);
    return status;
}

// ---- Nodes ----

static void count_node(vn_leaf_measures *m, const vn_faces *faces, int32_t node) {
    int32_t degree = faces->starts.data[node + 1] - faces->starts.data[node];
    m->degree3 += degree == 3;
    m->degree4 += degree == 4;
    m->degree_more += degree > 4;
    if (degree == 1 && faces->network->parent.data[node] >= 0) {
        int32_t half = faces->spokes.data[faces->starts.data[node]];
        m->tips++;
        m->free_ends += vn_faces_left(faces, half) >= 0;
    }
}

static void count_nodes(vn_leaf_measures *m, const vn_faces *faces) {
    const vn_network *network = faces->network;
    for (int32_t v = 0; v < network->x.count; v++) {
        count_node(m, faces, v);
    }
    m->tip_density = by_area(m, m->tips);
    m->free_end_density = by_area(m, m->free_ends);
    m->loops = network->joins.count - network->roots + faces->components;
    m->crossings = faces->crossings;
}

// ---- Areoles ----

static vn_status measure_areoles(vn_leaf_measures *m, const vn_faces *faces) {
    int32_t count = faces->area.count;
    m->areoles = count; // before the lists, which are freed by it
    VN_TRY(new_list(&m->areole_areas, count));
    VN_TRY(new_list(&m->areole_quotients, count));
    for (int32_t i = 0; i < count; i++) {
        double around = faces->perimeter.data[i];
        m->areole_areas[i] = fmax(faces->area.data[i], 0);
        m->areole_quotients[i] = around > 0 ? 4 * pi * m->areole_areas[i] / around / around : 0;
    }
    VN_TRY(vn_statistics_of(&m->areole_area, m->areole_areas, count));
    return vn_statistics_of(&m->areole_quotient, m->areole_quotients, count);
}

// ---- All ----

static vn_status check_request(const vn_network *network, const vn_leaf_def *def) {
    VN_TRY(vn_check_def(&vn_leaf_schema, def));
    if (network->dim != 2 || (def->domain != NULL && vn_domain_dim(def->domain) != 2)) {
        return vn_fail(VN_INVALID, "measure: a leaf is flat; give a network and a domain in 2D");
    }
    return vn_check_places(network, "measure");
}

static vn_status measure_in(vn_leaf_measures *m, const vn_network *network, const vn_domain *area,
                            double resolution) {
    vn_faces faces = {0};
    m->area = area != NULL ? vn_domain_measure(area) : 0;
    vn_status status = measure_lengths(m, network);
    status = status == VN_OK ? vn_faces_find(&faces, network) : status;
    if (status == VN_OK) {
        count_nodes(m, &faces);
        vn_faces_measure_angles(&m->angles, &faces);
        status = measure_areoles(m, &faces);
    }
    status = status == VN_OK ? vn_loops_decompose(&m->hierarchy, &faces) : status;
    status = status == VN_OK ? vn_faces_measure_distance(&m->distance, &faces, area, resolution) : status;
    vn_faces_free(&faces);
    return status;
}

vn_status vn_network_measure_leaf(const vn_network *network, const vn_leaf_def *def, vn_leaf_measures *out) {
    *out = (vn_leaf_measures){0};
    VN_TRY(check_request(network, def));
    vn_domain *hull = NULL;
    if (def->domain == NULL) {
        VN_TRY(vn_network_hull(&hull, network));
    }
    vn_leaf_measures made = {.hull = def->domain == NULL};
    vn_status status = measure_in(&made, network, hull != NULL ? hull : def->domain, def->resolution);
    vn_domain_release(hull);
    if (status != VN_OK) {
        vn_leaf_measures_free(&made);
        return status;
    }
    *out = made;
    return VN_OK;
}

static void free_list(double *list, int32_t count) {
    vn_resize(list, list != NULL ? (size_t)count * sizeof *list : 0, 0);
}

void vn_leaf_measures_free(vn_leaf_measures *m) {
    vn_loop_merge *merges = m->hierarchy.merges;
    free_list(m->order_density, m->order_count);
    free_list(m->areole_areas, m->areoles);
    free_list(m->areole_quotients, m->areoles);
    vn_resize(merges, merges != NULL ? (size_t)m->areoles * sizeof *merges : 0, 0);
    *m = (vn_leaf_measures){0};
}
