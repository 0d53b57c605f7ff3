/// Flow from inside: pipes, and what the solver hands to the audit.
#ifndef VN_NETWORK_FLOW_H
#define VN_NETWORK_FLOW_H

#include "network/network.h"
#include "venule/flow.h"

extern const vn_schema vn_flow_schema;

/// An edge as water sees it. Pipe e is that of node e (a: its parent) where e is a node, and join e - nodes
/// otherwise, whose ends are those that it was given.
typedef struct vn_pipe {
    int32_t a, b;
    double length, radius;
} vn_pipe;

static inline int32_t vn_pipe_count(const vn_network *network) {
    return network->x.count + network->joins.count;
}

/// False at a root.
bool vn_pipe_get(const vn_network *network, int32_t edge, vn_pipe *pipe);
/// 8 μ ℓ / (π r⁴), 0 where there is no length; or what is wrong with it.
vn_status vn_pipe_resistance(const vn_network *network, int32_t edge, const vn_pipe *pipe, double viscosity,
                             double *resistance);
/// Whether this network has radii, and edges that can be counted.
vn_status vn_flow_check_network(const vn_network *network);

/// Of each node that a single edge leads to, roots apart.
bool vn_is_terminal(const vn_network *network, const uint8_t *degree, int32_t node);
/// How many edges lead to each node, 2 standing for more; @p degree has room for all and is zeroed.
void vn_flow_degrees(const vn_network *network, uint8_t *degree);

/// One entry a pipe, from a to b; at a root, what enters there.
typedef struct vn_flow_state {
    VN_ARRAY(double) flow;
    VN_ARRAY(double) pressure; ///< one entry a node
} vn_flow_state;
void vn_flow_state_free(vn_flow_state *state);

/// The state that this network is in by Poiseuille's law.
vn_status vn_flow_solve(vn_flow_state *state, const vn_network *network, const vn_flow_def *def);

/// What can be said of a state.
vn_status vn_flow_describe(vn_flow_report *report, const vn_network *network, const vn_flow_def *def,
                           const vn_flow_state *state);

/// Whether a join's ends are the other way round in vn_network_join_ends().
bool vn_network_join_flipped(const vn_network *network, int32_t join);

#endif
