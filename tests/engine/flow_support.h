/// Networks to let something flow through, and the calls that tests of flow make.
#ifndef VN_TESTS_FLOW_SUPPORT_H
#define VN_TESTS_FLOW_SUPPORT_H

#include "support.h"

#include "network/flow.h"

enum { MOST_NODES = 80 };

static inline vn_flow_report solved(vn_network *network, const vn_flow_def *def) {
    vn_flow_report report;
    if (vn_network_solve_flow(network, def, &report) != VN_OK) {
        fail_msg("%s", vn_message());
    }
    return report;
}

static inline vn_flow_report audited(const vn_network *network, const vn_flow_def *def) {
    vn_flow_report report;
    if (vn_network_audit_flow(network, def, &report) != VN_OK) {
        fail_msg("%s", vn_message());
    }
    return report;
}

/// A node a point; the edge to each has its radius.
static inline vn_network *tree_of(int32_t count, const double (*xy)[2], const int32_t *parent,
                                  const double *radius) {
    vn_network *network = network_of(2);
    for (int32_t i = 0; i < count; i++) {
        if (parent[i] < 0) {
            put_root(network, xy[i][0], xy[i][1], 0);
        } else {
            put_child(network, parent[i], xy[i][0], xy[i][1], 0);
        }
    }
    assert_ok(vn_network_set_radii(network, radius));
    return network;
}

/// Radii over @p decades of conductance. Of the edges that are not of roots or tips a share @p flat has no
/// length.
static inline vn_network *random_network(uint64_t seed, int32_t joins, double decades, double flat) {
    vn_rng rng = vn_rng_make(seed);
    int32_t count = (int32_t)whole(&rng, 20, MOST_NODES), roots = 1 + (int32_t)(seed % 3);
    vn_network *network = random_tree(seed % 2 == 0 ? 2 : 3, count, roots, seed);
    double radius[MOST_NODES];
    for (int32_t i = 0; i < count; i++) {
        radius[i] = 0.3 * pow(10, uniform(&rng, 0, decades / 4));
    }
    for (int32_t i = 0; i < count; i++) {
        int32_t parent = vn_network_parent(network)[i];
        bool inner =
            parent >= 0 && vn_network_parent(network)[parent] >= 0 && vn_network_first_child(network, i) >= 0;
        if (inner && uniform(&rng, 0, 1) < flat) {
            network->x.data[i] = network->x.data[parent];
            network->y.data[i] = network->y.data[parent];
            if (network->dim == 3) {
                network->z.data[i] = network->z.data[parent];
            }
        }
    }
    assert_ok(vn_network_set_radii(network, radius));
    for (int32_t k = 0; k < joins; k++) { // some are refused
        vn_network_join(network, (int32_t)whole(&rng, 0, count - 1), (int32_t)whole(&rng, 0, count - 1),
                        0.3 * pow(10, uniform(&rng, 0, decades / 4)));
    }
    return network;
}

#endif
