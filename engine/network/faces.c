// Faces by the order of the edges round each node: the walk that always takes the next edge clockwise goes
// round the face on its left. All decisions are exact in sign.

#include "network/faces.h"

void vn_faces_free(vn_faces *faces) {
    vn_array_free(&faces->from);
    vn_array_free(&faces->radius);
    vn_array_free(&faces->starts);
    vn_array_free(&faces->spokes);
    vn_array_free(&faces->after);
    vn_array_free(&faces->walk);
    vn_array_free(&faces->region);
    vn_array_free(&faces->area);
    vn_array_free(&faces->perimeter);
    vn_segment_grid_free(&faces->grid);
}

// ---- Edges ----

static int32_t seat_of(int32_t *seats, int32_t node) {
    while (seats[node] != node) {
        seats[node] = seats[seats[node]];
        node = seats[node];
    }
    return node;
}

static bool same_place(const vn_network *network, int32_t a, int32_t b) {
    return network->x.data[a] == network->x.data[b] && network->y.data[a] == network->y.data[b];
}

typedef struct plain_edge {
    int32_t a, b;
    double radius;
} plain_edge;

// Tree edges by their child, then joins; a is -1 where there is none.
static plain_edge edge_at(const vn_network *network, int32_t i) {
    int32_t nodes = network->x.count;
    if (i >= nodes) {
        plain_edge join;
        vn_network_join_ends(network, i - nodes, &join.a, &join.b, &join.radius);
        return join;
    }
    int32_t parent = network->parent.data[i];
    return (plain_edge){parent, i, parent >= 0 ? vn_network_radius(network, i) : 0};
}

static void seat_nodes(const vn_network *network, int32_t *seats) {
    for (int32_t i = 0; i < network->x.count; i++) {
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): a seat for every node
        seats[i] = i;
    }
    for (int32_t i = 0; i < network->x.count + network->joins.count; i++) {
        plain_edge edge = edge_at(network, i);
        if (edge.a >= 0 && same_place(network, edge.a, edge.b)) {
            int32_t a = seat_of(seats, edge.a), b = seat_of(seats, edge.b);
            seats[a > b ? a : b] = a < b ? a : b;
        }
    }
}

static vn_status take_edges(vn_faces *faces, int32_t *seats) {
    const vn_network *network = faces->network;
    int64_t most = (int64_t)network->x.count + network->joins.count;
    VN_TRY(vn_array_reserve(&faces->from, 2 * most));
    VN_TRY(vn_array_reserve(&faces->radius, most));
    VN_TRY(vn_array_reserve(&faces->grid.segments, most));
    for (int32_t i = 0; i < (int32_t)most; i++) {
        plain_edge edge = edge_at(network, i);
        if (edge.a < 0 || same_place(network, edge.a, edge.b)) {
            continue;
        }
        int32_t a = seat_of(seats, edge.a), b = seat_of(seats, edge.b);
        faces->from.data[faces->from.count++] = a;
        faces->from.data[faces->from.count++] = b;
        faces->radius.data[faces->radius.count++] = edge.radius;
        faces->grid.segments.data[faces->grid.segments.count++] =
            (vn_segment){network->x.data[a], network->y.data[a], network->x.data[b], network->y.data[b]};
    }
    return VN_OK;
}

static vn_status find_edges(vn_faces *faces) {
    VN_ARRAY(int32_t) seats = {0};
    if (faces->network->x.count == 0) {
        return VN_OK;
    }
    // NOLINTNEXTLINE(clang-analyzer-core.NonNullParamChecker): there are nodes
    VN_TRY(vn_array_zero(&seats, faces->network->x.count));
    seat_nodes(faces->network, seats.data);
    vn_status status = take_edges(faces, seats.data);
    vn_array_free(&seats);
    return status == VN_OK ? vn_segment_grid_build(&faces->grid) : status;
}

// ---- The order round a node ----

static vn_status list_spokes(vn_faces *faces) {
    int32_t nodes = faces->network->x.count;
    VN_TRY(vn_array_zero(&faces->starts, (int64_t)nodes + 2));
    VN_TRY(vn_array_zero(&faces->spokes, faces->from.count));
    int32_t *starts = faces->starts.data;
    for (int32_t h = 0; h < faces->from.count; h++) {
        starts[faces->from.data[h] + 2]++;
    }
    for (int32_t v = 0; v < nodes; v++) {
        starts[v + 2] += starts[v + 1];
    }
    for (int32_t h = 0; h < faces->from.count; h++) {
        faces->spokes.data[starts[faces->from.data[h] + 1]++] = h;
    }
    return VN_OK;
}

static bool points_up(const vn_faces *faces, int32_t half) {
    const double *x = faces->network->x.data, *y = faces->network->y.data;
    int32_t v = faces->from.data[half], w = faces->from.data[half ^ 1];
    return y[w] > y[v] || (y[w] == y[v] && x[w] > x[v]);
}

// Whether spoke g is to the left of spoke h, both of one node: positive, or 0 when they point the same way or
// against each other.
static double turn_between(const vn_faces *faces, int32_t h, int32_t g) {
    const double *x = faces->network->x.data, *y = faces->network->y.data;
    int32_t v = faces->from.data[h], p = faces->from.data[h ^ 1], q = faces->from.data[g ^ 1];
    return vn_turn(x[p], y[p], x[q], y[q], x[v], y[v]);
}

// Counter-clockwise from due east; of spokes that lie on each other the lower first.
static bool comes_first(const vn_faces *faces, int32_t h, int32_t g) {
    bool h_up = points_up(faces, h), g_up = points_up(faces, g);
    if (h_up != g_up) {
        return h_up;
    }
    double turn = turn_between(faces, h, g);
    return turn != 0 ? turn > 0 : h < g;
}

static void sift(const vn_faces *faces, int32_t *spokes, int32_t count, int32_t at) {
    for (int32_t child = 2 * at + 1; child < count; child = 2 * at + 1) {
        child += child + 1 < count && comes_first(faces, spokes[child], spokes[child + 1]);
        if (!comes_first(faces, spokes[at], spokes[child])) {
            return;
        }
        int32_t swap = spokes[at];
        spokes[at] = spokes[child];
        spokes[child] = swap;
        at = child;
    }
}

// Heap sort: the order is total, so none of equals can come in another order.
static void sort_spokes(const vn_faces *faces, int32_t *spokes, int32_t count) {
    for (int32_t i = count / 2 - 1; i >= 0; i--) {
        sift(faces, spokes, count, i);
    }
    for (int32_t last = count - 1; last > 0; last--) {
        int32_t swap = spokes[0];
        spokes[0] = spokes[last];
        spokes[last] = swap;
        sift(faces, spokes, last, 0);
    }
}

static vn_status find_after(vn_faces *faces) {
    VN_TRY(vn_array_zero(&faces->after, faces->from.count));
    for (int32_t v = 0; v < faces->network->x.count; v++) {
        int32_t *spokes = faces->spokes.data + faces->starts.data[v];
        int32_t count = faces->starts.data[v + 1] - faces->starts.data[v];
        if (count > 2) {
            sort_spokes(faces, spokes, count); // one or two are in order as they are
        }
        for (int32_t k = 0; k < count; k++) {
            faces->after.data[spokes[k] ^ 1] = spokes[k > 0 ? k - 1 : count - 1];
        }
    }
    return VN_OK;
}

vn_status vn_faces_find(vn_faces *faces, const vn_network *network) {
    *faces = (vn_faces){.network = network};
    VN_TRY(find_edges(faces));
    VN_TRY(vn_poll());
    VN_TRY(vn_faces_count_crossings(faces));
    VN_TRY(list_spokes(faces));
    VN_TRY(find_after(faces));
    VN_TRY(vn_poll());
    return vn_faces_find_regions(faces);
}
