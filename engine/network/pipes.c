// Edges as water sees them, tree edges and joins alike.

#include "network/flow.h"

#include <stdio.h>

static const double pi = 3.141592653589793;

// Beyond these, products of resistances and flows leave the range of doubles.
#define LEAST_RESISTANCE 1e-150
#define MOST_RESISTANCE 1e150

bool vn_pipe_get(const vn_network *network, int32_t edge, vn_pipe *pipe) {
    int32_t nodes = network->x.count;
    if (edge < nodes) {
        pipe->a = network->parent.data[edge];
        pipe->b = edge;
        if (pipe->a < 0) {
            return false;
        }
        pipe->radius = vn_network_radius(network, edge);
    } else {
        int32_t a, b;
        vn_network_join_ends(network, edge - nodes, &a, &b, &pipe->radius);
        pipe->a = network->joins.data[edge - nodes].a;
        pipe->b = network->joins.data[edge - nodes].b;
    }
    double p[3], q[3];
    vn_network_position(network, pipe->a, p);
    vn_network_position(network, pipe->b, q);
    pipe->length = sqrt(vn_distance2(p, q));
    return true;
}

static void name_pipe(char *text, size_t size, const vn_network *network, int32_t edge, const vn_pipe *pipe) {
    double p[3];
    vn_network_position(network, pipe->b, p);
    if (edge < network->x.count) {
        snprintf(text, size, "the edge to node %d at (%g, %g, %g)", edge, p[0], p[1], p[2]);
    } else {
        snprintf(text, size, "join %d, from node %d to node %d at (%g, %g, %g)", edge - network->x.count,
                 pipe->a, pipe->b, p[0], p[1], p[2]);
    }
}

vn_status vn_pipe_resistance(const vn_network *network, int32_t edge, const vn_pipe *pipe, double viscosity,
                             double *resistance) {
    char name[160];
    double r2 = pipe->radius * pipe->radius;
    if (!(pipe->radius > 0)) {
        name_pipe(name, sizeof name, network, edge, pipe);
        return vn_fail(VN_INVALID, "flow: %s has the radius %g, which must be above 0 for anything to flow",
                       name, pipe->radius);
    }
    *resistance = 8 * viscosity / pi * (pipe->length / r2 / r2);
    bool fits = *resistance >= LEAST_RESISTANCE && *resistance <= MOST_RESISTANCE;
    if (pipe->length != 0 && !fits) {
        name_pipe(name, sizeof name, network, edge, pipe);
        return vn_fail(VN_INVALID,
                       "flow: %s, %g long and of radius %g, has the resistance %g, which must be from %g to "
                       "%g; use another length unit",
                       name, pipe->length, pipe->radius, *resistance, LEAST_RESISTANCE, MOST_RESISTANCE);
    }
    *resistance = pipe->length == 0 ? 0 : *resistance;
    return VN_OK;
}

vn_status vn_flow_check_network(const vn_network *network) {
    if ((int64_t)network->x.count + network->joins.count > INT32_MAX) {
        return vn_fail(VN_LIMIT, "flow: %d nodes and %d joins are more than the %d edges that can be counted",
                       network->x.count, network->joins.count, INT32_MAX);
    }
    if (network->x.count > 0 && !vn_network_has_radii(network)) {
        return vn_fail(VN_INVALID, "flow: the network has no radii: give it some by Murray's law "
                                   "(net:murray{…}), or load a file that has them");
    }
    return VN_OK;
}

void vn_flow_degrees(const vn_network *network, uint8_t *degree) {
    for (int32_t i = 0; i < network->x.count; i++) {
        int32_t parent = network->parent.data[i];
        if (parent >= 0) {
            degree[i] += degree[i] < 2;
            degree[parent] += degree[parent] < 2;
        }
    }
    for (int32_t j = 0; j < network->joins.count; j++) {
        uint8_t *a = &degree[network->joins.data[j].a], *b = &degree[network->joins.data[j].b];
        *a += *a < 2;
        *b += *b < 2;
    }
}

bool vn_is_terminal(const vn_network *network, const uint8_t *degree, int32_t node) {
    return network->parent.data[node] >= 0 && degree[node] == 1;
}

void vn_flow_state_free(vn_flow_state *state) {
    vn_array_free(&state->flow);
    vn_array_free(&state->pressure);
}
