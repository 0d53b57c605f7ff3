// Nodes put into edges: growth stretches edges, and a vein meets another one between two of its nodes.
// The new node comes after its own child, so parents no longer have the lower index: from the first split on
// the network keeps a sequence of its own, made anew when it is next walked.

#include "network/network.h"

int32_t vn_network_resequence(vn_network *network) {
    int32_t *sequence = network->sequence.data, count = 0;
    for (int32_t i = 0; i < network->x.count; i++) {
        if (network->parent.data[i] < 0) {
            sequence[count++] = i;
        }
    }
    for (int32_t k = 0; k < count; k++) {
        for (int32_t c = network->first_child.data[sequence[k]]; c >= 0; c = network->next_child.data[c]) {
            sequence[count++] = c;
        }
    }
    network->sequence.count = count;
    network->unordered = false;
    return count;
}

// The link of the children's list that leads to @p child.
static int32_t *link_to(vn_network *network, int32_t parent, int32_t child) {
    int32_t *link = &network->first_child.data[parent];
    while (*link != child) {
        link = &network->next_child.data[*link];
    }
    return link;
}

static void insert_node(vn_network *network, int32_t child, const double p[3]) {
    int32_t node = network->x.count, parent = network->parent.data[child];
    int32_t *link = link_to(network, parent, child);
    network->x.data[network->x.count++] = p[0];
    network->y.data[network->y.count++] = p[1];
    if (network->dim == 3) {
        network->z.data[network->z.count++] = p[2];
    }
    network->parent.data[network->parent.count++] = parent;
    network->first_child.data[network->first_child.count++] = child;
    network->next_child.data[network->next_child.count++] = network->next_child.data[child];
    network->tree.data[network->tree.count++] = network->tree.data[child];
    network->birth.data[network->birth.count++] = network->birth.data[child];
    *link = node;
    network->parent.data[child] = node;
    network->next_child.data[child] = -1;
    if (network->radius.count > 0) {
        network->radius.data[network->radius.count++] = network->radius.data[child];
    }
    if (network->murray) {
        network->tips.data[network->tips.count++] = network->tips.data[child];
    }
}

vn_status vn_network_split(vn_network *network, int32_t child, const double p[3], int32_t *node) {
    if (node != NULL) {
        *node = -1;
    }
    if (child < 0 || child >= network->x.count || network->parent.data[child] < 0) {
        return vn_fail(VN_INVALID, "a split needs a node with a parent: a root has no edge above it");
    }
    VN_TRY(vn_network_make_room(network, p));
    VN_TRY(vn_array_reserve(&network->sequence, (int64_t)network->x.count + 1));
    insert_node(network, child, p);
    network->sequence.count = network->x.count; // from now on it has room for every node
    network->unordered = true;
    network->turned++;
    network->version++;
    if (node != NULL) {
        *node = network->x.count - 1;
    }
    return VN_OK;
}
