#include "network/leaf.h"

typedef VN_ARRAY(int32_t) node_list;

static vn_status sort_by(vn_keyed_array *keys, vn_keyed_array *scratch, const double *values) {
    for (int32_t i = 0; i < keys->count; i++) {
        keys->data[i].key = vn_sortable(values[keys->data[i].value]);
    }
    return vn_sort_keyed(keys, scratch);
}

// Drop what the way to @p node does not leave to its left.
static void add_corner(const vn_network *network, node_list *hull, int32_t first, int32_t node) {
    const double *x = network->x.data, *y = network->y.data;
    while (hull->count >= first + 2) {
        int32_t a = hull->data[hull->count - 2], b = hull->data[hull->count - 1];
        if (vn_turn(x[a], y[a], x[b], y[b], x[node], y[node]) > 0) {
            break;
        }
        hull->count--;
    }
    hull->data[hull->count++] = node;
}

// Andrew's chains (1979): along the lower side, and back along the upper one.
static void find_chains(const vn_network *network, const vn_keyed_array *keys, node_list *hull) {
    for (int32_t i = 0; i < keys->count; i++) {
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): a key for every node
        add_corner(network, hull, 0, keys->data[i].value);
    }
    int32_t first = hull->count - 1;
    for (int32_t i = keys->count - 2; i >= 0; i--) {
        add_corner(network, hull, first, keys->data[i].value);
    }
    hull->count--; // the first corner again
}

static vn_status make_polygon(vn_domain **out, const vn_network *network, const node_list *hull) {
    VN_ARRAY(double) xy = {0};
    vn_status status = vn_array_reserve(&xy, 2 * (int64_t)hull->count);
    for (int32_t i = 0; status == VN_OK && i < hull->count; i++) {
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): there was memory for as many
        xy.data[2 * i] = network->x.data[hull->data[i]];
        xy.data[2 * i + 1] = network->y.data[hull->data[i]];
    }
    status = status == VN_OK ? vn_domain_polygon(out, xy.data, &hull->count, 1) : status;
    vn_array_free(&xy);
    return status;
}

static vn_status find_hull(vn_keyed_array *keys, vn_keyed_array *scratch, node_list *hull,
                           const vn_network *network) {
    VN_TRY(vn_array_zero(keys, network->x.count));
    VN_TRY(vn_array_reserve(hull, 2 * (int64_t)network->x.count));
    for (int32_t i = 0; i < network->x.count; i++) {
        keys->data[i].value = i;
    }
    VN_TRY(sort_by(keys, scratch, network->y.data));
    VN_TRY(sort_by(keys, scratch, network->x.data));
    if (keys->count > 0) {
        find_chains(network, keys, hull);
    }
    return VN_OK;
}

vn_status vn_network_hull(vn_domain **out, const vn_network *network) {
    *out = NULL;
    vn_keyed_array keys = {0}, scratch = {0};
    node_list hull = {0};
    vn_status status = find_hull(&keys, &scratch, &hull, network);
    if (status == VN_OK && hull.count > 2) {
        status = make_polygon(out, network, &hull);
    }
    vn_array_free(&keys);
    vn_array_free(&scratch);
    vn_array_free(&hull);
    return status;
}
