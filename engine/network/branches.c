#include "network/branches.h"

#include "network/flow.h"

void vn_branches_free(vn_branches *branches) {
    vn_array_free(&branches->list);
    vn_array_free(&branches->of);
}

bool vn_network_forks(const vn_network *network, int32_t node) {
    int32_t first = network->first_child.data[node];
    return first >= 0 && network->next_child.data[first] >= 0;
}

static vn_status begin_branch(vn_branches *b, int32_t node, int32_t before) {
    vn_branch fresh = {.before = before, .first = node};
    fresh.level = before >= 0 ? b->list.data[before].level + 1 : 0;
    b->of.data[node] = b->list.count;
    return vn_array_push(&b->list, fresh);
}

static vn_status add_edge(vn_branches *b, const vn_network *network, int32_t node) {
    vn_pipe pipe;
    if (!vn_pipe_get(network, node, &pipe)) {
        return VN_OK;
    }
    bool from_root = network->parent.data[pipe.a] < 0;
    if (from_root || vn_network_forks(network, pipe.a)) {
        VN_TRY(begin_branch(b, node, from_root ? -1 : b->of.data[pipe.a]));
    } else {
        b->of.data[node] = b->of.data[pipe.a];
    }
    vn_branch *mine = &b->list.data[b->of.data[node]];
    mine->edges++;
    mine->length += pipe.length;
    mine->weighted += 2 * pipe.radius * pipe.length;
    mine->sum += 2 * pipe.radius;
    return VN_OK;
}

vn_status vn_branches_find(vn_branches *out, const vn_network *network) {
    VN_TRY(vn_array_zero(&out->of, network->x.count));
    for (int32_t k = 0; k < network->x.count; k++) {
        VN_TRY(add_edge(out, network, vn_network_nth(network, k)));
    }
    return VN_OK;
}

void vn_edge_direction(const vn_network *network, int32_t node, double d[3]) {
    double p[3];
    vn_network_position(network, network->parent.data[node], p);
    vn_network_position(network, node, d);
    for (int k = 0; k < 3; k++) {
        d[k] -= p[k];
    }
}

bool vn_angle_between(const double u[3], const double v[3], double *degrees) {
    double w[3];
    for (int k = 0; k < 3; k++) {
        w[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    }
    double cross = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    double dot = u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
    *degrees = 57.29577951308232 * atan2(cross, dot);
    return cross > 0 || dot < 0 || dot > 0;
}
