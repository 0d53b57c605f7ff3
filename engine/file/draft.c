#include "file/draft.h"

#include <math.h>

vn_status vn_draft_node(vn_draft *draft, const double p[3]) {
    int64_t need = (int64_t)draft->x.count + 1;
    int32_t most = vn_network_def_default().max_nodes;
    if (need > most) {
        return vn_fail(VN_LIMIT, "more than %d nodes, which is the limit of a network", most);
    }
    vn_numbers *columns[] = {&draft->x, &draft->y, &draft->z, &draft->radius, &draft->flow, &draft->pressure};
    double values[] = {p[0], p[1], p[2], NAN, NAN, NAN};
    VN_TRY(vn_array_reserve(&draft->parent, need));
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        VN_TRY(vn_array_reserve(columns[i], need));
    }
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        columns[i]->data[columns[i]->count++] = values[i];
    }
    draft->parent.data[draft->parent.count++] = -1;
    return VN_OK;
}

vn_status vn_draft_edge_add(vn_draft *draft, const vn_draft_edge *edge) {
    return vn_array_push(&draft->edges, *edge);
}

void vn_draft_unit(vn_draft *draft, vn_slice unit) {
    size_t length = unit.length < sizeof draft->unit ? unit.length : 0; // whatever it is, it is no unit
    if (length > 0) {
        memcpy(draft->unit, unit.text, length);
    }
    draft->unit[length] = '\0';
}

void vn_draft_free(vn_draft *draft) {
    vn_array_free(&draft->x);
    vn_array_free(&draft->y);
    vn_array_free(&draft->z);
    vn_array_free(&draft->parent);
    vn_array_free(&draft->birth);
    vn_array_free(&draft->radius);
    vn_array_free(&draft->flow);
    vn_array_free(&draft->pressure);
    vn_array_free(&draft->edges);
    vn_array_free(&draft->joins);
}

// Which nodes edges connect so far; paths are halved on the way up.
typedef VN_ARRAY(int32_t) parts_of;

static int32_t part_of(parts_of *parts, int32_t node) {
    while (parts->data[node] != node) {
        parts->data[node] = parts->data[parts->data[node]];
        node = parts->data[node];
    }
    return node;
}

static vn_status start_parts(parts_of *parts, int32_t count) {
    VN_TRY(vn_array_reserve(parts, count));
    for (int32_t i = 0; i < count; i++) {
        parts->data[i] = i;
    }
    parts->count = count;
    return VN_OK;
}

static void hang(vn_draft *draft, const vn_draft_edge *edge, int32_t parent, int32_t child) {
    draft->parent.data[child] = parent;
    draft->radius.data[child] = edge->radius;
    draft->flow.data[child] = edge->flow;
}

static vn_status keep_join(vn_draft *draft, const vn_draft_edge *edge) {
    vn_join join = {edge->from, edge->to, isnan(edge->radius) ? 0 : edge->radius};
    return vn_array_push(&draft->joins, join);
}

static vn_status link_directed(vn_draft *draft, parts_of *parts) {
    for (int32_t i = 0; i < draft->edges.count; i++) {
        const vn_draft_edge *edge = &draft->edges.data[i];
        int32_t from = part_of(parts, edge->from), to = part_of(parts, edge->to);
        if (edge->join || draft->parent.data[edge->to] >= 0 || from == to) {
            VN_TRY(keep_join(draft, edge));
        } else {
            hang(draft, edge, edge->from, edge->to);
            parts->data[to] = from;
        }
    }
    return VN_OK;
}

// Edges by the node that they end in, both ends of each: entry 2 i is edge i at its `from`, 2 i + 1 at its
// `to`.
typedef struct edge_ends {
    VN_ARRAY(int32_t) first; ///< of a node; -1 ends
    VN_ARRAY(int32_t) next;
    VN_ARRAY(int32_t) queue;
    VN_ARRAY(bool) reached;
} edge_ends;

static void free_ends(edge_ends *ends) {
    vn_array_free(&ends->first);
    vn_array_free(&ends->next);
    vn_array_free(&ends->queue);
    vn_array_free(&ends->reached);
}

static vn_status start_ends(edge_ends *ends, int32_t nodes, int32_t edges) {
    VN_TRY(vn_array_reserve(&ends->first, nodes));
    VN_TRY(vn_array_reserve(&ends->next, 2 * (int64_t)edges));
    VN_TRY(vn_array_reserve(&ends->queue, nodes));
    VN_TRY(vn_array_zero(&ends->reached, nodes));
    for (int32_t i = 0; i < nodes; i++) {
        ends->first.data[i] = -1;
    }
    return VN_OK;
}

static void list_end(edge_ends *ends, int32_t node, int32_t end) {
    // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): room for every node and edge
    ends->next.data[end] = ends->first.data[node];
    ends->first.data[node] = end;
}

// Hang all that is connected with a root from it, nearest first.
static void spread(vn_draft *draft, edge_ends *ends, int32_t root) {
    ends->queue.count = 0;
    ends->queue.data[ends->queue.count++] = root;
    ends->reached.data[root] = true;
    for (int32_t k = 0; k < ends->queue.count; k++) {
        int32_t node = ends->queue.data[k];
        for (int32_t end = ends->first.data[node]; end >= 0; end = ends->next.data[end]) {
            const vn_draft_edge *edge = &draft->edges.data[end / 2];
            int32_t other = end % 2 == 0 ? edge->to : edge->from;
            if (!ends->reached.data[other]) {
                ends->reached.data[other] = true;
                hang(draft, edge, node, other);
                ends->queue.data[ends->queue.count++] = other;
            }
        }
    }
}

// Nodes that an edge leads to are marked by themselves as parents until a root reaches them.
static vn_status link_undirected(vn_draft *draft, parts_of *parts, edge_ends *ends) {
    int32_t nodes = draft->x.count;
    VN_TRY(start_ends(ends, nodes, draft->edges.count));
    for (int32_t i = 0; i < draft->edges.count; i++) {
        const vn_draft_edge *edge = &draft->edges.data[i];
        int32_t from = part_of(parts, edge->from), to = part_of(parts, edge->to);
        if (edge->join || from == to) {
            VN_TRY(keep_join(draft, edge));
        } else {
            parts->data[to] = from;
            draft->parent.data[edge->to] = edge->to;
            list_end(ends, edge->from, 2 * i);
            list_end(ends, edge->to, 2 * i + 1);
        }
    }
    for (int32_t pass = 0; pass < 2; pass++) { // first those that no edge leads to, then whoever is left
        for (int32_t i = 0; i < nodes; i++) {
            if (!ends->reached.data[i] && (pass == 1 || draft->parent.data[i] < 0)) {
                draft->parent.data[i] = -1;
                spread(draft, ends, i);
            }
        }
    }
    return VN_OK;
}

vn_status vn_draft_link(vn_draft *draft, bool directed) {
    parts_of parts = {0};
    edge_ends ends = {0};
    vn_status status = start_parts(&parts, draft->x.count);
    if (status == VN_OK) {
        status = directed ? link_directed(draft, &parts) : link_undirected(draft, &parts, &ends);
    }
    free_ends(&ends);
    vn_array_free(&parts);
    return status;
}

// Whether a column is known: all edges have it or none has. Where there are no edges, roots decide.
static vn_status is_known(const vn_draft *draft, const vn_numbers *column, const char *what, bool *known) {
    int32_t with = -1, without = -1, root = -1; // the last of each
    for (int32_t i = 0; i < draft->x.count; i++) {
        bool unknown = isnan(column->data[i]);
        if (draft->parent.data[i] < 0) {
            root = unknown ? root : i;
        } else if (unknown) {
            without = i;
        } else {
            with = i;
        }
    }
    *known = with >= 0 || (root >= 0 && without < 0);
    if (with >= 0 && without >= 0) {
        return vn_fail(
            VN_INVALID,
            "the edge to node %d has a %s, but that to node %d has none; give it to all, or to none", with,
            what, without);
    }
    return VN_OK;
}

static void fill_roots(vn_draft *draft, vn_numbers *column) {
    for (int32_t i = 0; i < draft->x.count; i++) {
        if (draft->parent.data[i] < 0 && isnan(column->data[i])) {
            column->data[i] = 0;
        }
    }
}

// Children in the order of their numbers, so that writers can tell whether a root's flow says anything new.
static vn_status sum_root_flows(vn_draft *draft) {
    parts_of said = {0};
    VN_TRY(vn_array_zero(&said, draft->x.count));
    for (int32_t i = 0; i < draft->x.count; i++) {
        said.data[i] = draft->parent.data[i] < 0 && !isnan(draft->flow.data[i]);
    }
    fill_roots(draft, &draft->flow);
    for (int32_t i = 0; i < draft->x.count; i++) {
        int32_t parent = draft->parent.data[i];
        if (parent >= 0 && draft->parent.data[parent] < 0 && said.data[parent] == 0) {
            draft->flow.data[parent] += draft->flow.data[i];
        }
    }
    vn_array_free(&said);
    return VN_OK;
}

static bool all_known(const vn_numbers *column) {
    for (int32_t i = 0; i < column->count; i++) {
        if (isnan(column->data[i])) {
            return false;
        }
    }
    return column->count > 0;
}

static bool is_flat(const vn_numbers *z) {
    for (int32_t i = 0; i < z->count; i++) {
        if (z->data[i] != 0) {
            return false;
        }
    }
    return true;
}

static vn_status add_joins(const vn_draft *draft, vn_network *network) {
    for (int32_t i = 0; i < draft->joins.count; i++) {
        const vn_join *join = &draft->joins.data[i];
        if (draft->overlaps && vn_network_connected(network, join->a, join->b)) {
            continue;
        }
        if (join->a == join->b || vn_network_connected(network, join->a, join->b)) {
            return vn_fail(
                VN_INVALID,
                "two edges connect node %d with node %d; put a node into one of them, or leave it out",
                join->a, join->b);
        }
        VN_TRY(vn_network_join(network, join->a, join->b, join->radius));
    }
    return VN_OK;
}

static vn_status make_network(vn_draft *draft, bool has_radii, vn_network **out) {
    int dim = draft->dim != 0 ? draft->dim : (is_flat(&draft->z) ? 2 : 3);
    if (dim == 2 && !is_flat(&draft->z)) {
        return vn_fail(VN_INVALID, "it is said to be flat, but some z is not 0");
    }
    vn_network_columns columns = {
        .dim = dim,
        .count = draft->x.count,
        .x = draft->x.data,
        .y = draft->y.data,
        .z = draft->z.data,
        .parent = draft->parent.data,
        .radius = has_radii ? draft->radius.data : NULL,
        .birth = draft->birth.count > 0 ? draft->birth.data : NULL,
        .unit = draft->unit,
    };
    return vn_network_from_columns(out, &columns);
}

static vn_status set_flow(vn_draft *draft, vn_network *network) {
    VN_TRY(sum_root_flows(draft));
    const double *pressure = all_known(&draft->pressure) ? draft->pressure.data : NULL;
    return vn_network_set_flow(network, draft->flow.data, pressure);
}

vn_status vn_draft_finish(vn_draft *draft, vn_network_set *set) {
    bool has_radii, has_flow;
    vn_network *network;
    VN_TRY(is_known(draft, &draft->radius, "radius", &has_radii));
    VN_TRY(is_known(draft, &draft->flow, "flow", &has_flow));
    fill_roots(draft, &draft->radius);
    VN_TRY(make_network(draft, has_radii, &network));
    vn_status status = add_joins(draft, network);
    status = status == VN_OK && has_flow ? set_flow(draft, network) : status;
    if (status != VN_OK) {
        vn_network_destroy(network);
        return status;
    }
    return vn_network_set_add(set, network);
}
