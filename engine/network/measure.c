#include "network/leaf.h"

static void measure_node(const vn_network *network, int32_t node, vn_network_measures *m) {
    int32_t first = network->first_child.data[node];
    bool forks = first >= 0 && network->next_child.data[first] >= 0;
    int32_t parent = network->parent.data[node];
    double p[3];
    vn_network_position(network, node, p);
    for (int k = 0; k < 3; k++) {
        m->extent.min[k] = m->nodes == 0 ? p[k] : fmin(m->extent.min[k], p[k]);
        m->extent.max[k] = m->nodes == 0 ? p[k] : fmax(m->extent.max[k], p[k]);
    }
    m->nodes++;
    m->roots += parent < 0;
    m->tips += first < 0;
    m->bifurcations += forks;
    if (parent >= 0) {
        double q[3];
        double radius = vn_network_radius(network, node);
        bool is_first = m->nodes - m->roots == 1;
        vn_network_position(network, parent, q);
        m->length += sqrt(vn_distance2(p, q));
        m->min_radius = is_first ? radius : fmin(m->min_radius, radius);
        m->max_radius = fmax(m->max_radius, radius);
    }
}

static vn_status find_depth(const vn_network *network, int32_t *depth) {
    VN_ARRAY(int32_t) depths = {0};
    VN_TRY(vn_array_zero(&depths, network->x.count));
    *depth = 0;
    for (int32_t k = 0; k < network->x.count; k++) {
        int32_t node = vn_network_nth(network, k);
        int32_t parent = network->parent.data[node];
        depths.data[node] = parent < 0 ? 0 : depths.data[parent] + 1;
        *depth = depths.data[node] > *depth ? depths.data[node] : *depth;
    }
    vn_array_free(&depths);
    return VN_OK;
}

vn_status vn_network_measure(const vn_network *network, vn_network_measures *out) {
    *out = (vn_network_measures){0};
    VN_TRY(find_depth(network, &out->depth));
    for (int32_t k = 0; k < network->x.count; k++) {
        measure_node(network, vn_network_nth(network, k), out); // roots come before what hangs from them
    }
    for (int32_t i = 0; i < network->joins.count; i++) {
        double p[3], q[3];
        vn_network_position(network, network->joins.data[i].a, p);
        vn_network_position(network, network->joins.data[i].b, q);
        out->length += sqrt(vn_distance2(p, q));
    }
    out->joins = network->joins.count;
    return VN_OK;
}

vn_status vn_check_places(const vn_network *network, const char *what) {
    const double far = 1e150;
    for (int32_t i = 0; i < network->x.count; i++) {
        double p[3];
        vn_network_position(network, i, p);
        if (!(fabs(p[0]) <= far && fabs(p[1]) <= far && fabs(p[2]) <= far)) {
            return vn_fail(VN_INVALID, "%s: node %d at (%g, %g, %g) is beyond %g; use another length unit",
                           what, i, p[0], p[1], p[2], far);
        }
    }
    return VN_OK;
}
