// The network's edges where they lie in the plane: which of them a new one would cross.

#include "network/network.h"

void vn_network_edge_ends(const vn_network *network, int32_t edge, int32_t *a, int32_t *b) {
    bool is_join = edge < 0;
    *a = is_join ? network->joins.data[-1 - edge].a : network->parent.data[edge];
    *b = is_join ? network->joins.data[-1 - edge].b : edge;
}

vn_segment vn_network_segment(const vn_network *network, int32_t edge) {
    int32_t a, b;
    vn_network_edge_ends(network, edge, &a, &b);
    const double *x = network->x.data, *y = network->y.data;
    return (vn_segment){x[a], y[a], x[b], y[b]};
}

static vn_status list_edges(vn_network *network) {
    for (; network->edge_nodes < network->x.count; network->edge_nodes++) {
        if (network->parent.data[network->edge_nodes] >= 0) {
            vn_segment segment = vn_network_segment(network, network->edge_nodes);
            VN_TRY(vn_edge_grid_insert(&network->edges, network->edge_nodes, &segment));
        }
    }
    for (; network->edge_joins < network->joins.count; network->edge_joins++) {
        vn_segment segment = vn_network_segment(network, -1 - network->edge_joins);
        VN_TRY(vn_edge_grid_insert(&network->edges, -1 - network->edge_joins, &segment));
    }
    return VN_OK;
}

// New edges become shorter where the unit of length shrinks: cells that have become too wide for them, or too
// few, are made anew.
static vn_status renew_edges(vn_network *network, double typical) {
    const vn_edge_grid *grid = &network->edges;
    int32_t count = network->x.count + network->joins.count;
    bool fits = grid->cell > 0 && grid->cell <= 4 * typical && typical <= 4 * grid->cell;
    if (!fits || count > network->edge_room || network->edges_moved != network->moved) {
        network->edge_nodes = network->edge_joins = 0;
        network->edge_room = count < INT32_MAX / 2 ? 2 * count + 512 : INT32_MAX;
        network->edges_moved = network->moved;
        VN_TRY(vn_edge_grid_init(&network->edges, typical, network->edge_room));
    }
    return list_edges(network);
}

typedef struct way {
    const vn_network *network;
    int32_t node, to;
    vn_segment segment;
    vn_meeting *first;
    bool meets;
} way;

// The part of segment @p s up to the line of @p t; they touch. Where they are parallel they share a line, and
// one of t's ends is what is met first.
static double part_until(const vn_segment *s, const vn_segment *t) {
    double sx = s->x1 - s->x0, sy = s->y1 - s->y0;
    double tx = t->x1 - t->x0, ty = t->y1 - t->y0;
    double ax = t->x0 - s->x0, ay = t->y0 - s->y0;
    double across = sx * ty - sy * tx;
    double length2 = sx * sx + sy * sy;
    double part = (ax * ty - ay * tx) / across;
    if (!isfinite(part)) {
        double bx = t->x1 - s->x0, by = t->y1 - s->y0;
        part = fmin(ax * sx + ay * sy, bx * sx + by * sy) / length2;
    }
    return fmin(fmax(part, 0), 1);
}

static void note_meeting(way *w, int32_t edge, double part) {
    bool first = !w->meets || part < w->first->way || (part == w->first->way && edge < w->first->edge);
    if (first) {
        const vn_segment *s = &w->segment;
        double x = s->x0 + part * (s->x1 - s->x0), y = s->y0 + part * (s->y1 - s->y0);
        *w->first = (vn_meeting){edge, part, {x, y, 0}};
        w->meets = true;
    }
}

// An edge of the node itself is met only where the way runs along it.
static bool runs_along(const vn_segment *s, const vn_segment *t, bool from_first) {
    double ox = from_first ? t->x1 : t->x0, oy = from_first ? t->y1 : t->y0;
    double forward = (ox - s->x0) * (s->x1 - s->x0) + (oy - s->y0) * (s->y1 - s->y0);
    return forward > 0 && vn_turn(s->x0, s->y0, s->x1, s->y1, ox, oy) == 0;
}

static bool test_edge(int32_t edge, void *payload) {
    way *w = payload;
    int32_t a, b;
    vn_segment segment = vn_network_segment(w->network, edge);
    vn_network_edge_ends(w->network, edge, &a, &b);
    if (a == w->node || b == w->node) {
        if (runs_along(&w->segment, &segment, a == w->node)) {
            note_meeting(w, edge, 0);
        }
    } else if (a != w->to && b != w->to && vn_segments_touch(&w->segment, &segment)) {
        note_meeting(w, edge, part_until(&w->segment, &segment));
    }
    return true;
}

vn_status vn_network_meets(vn_network *network, int32_t node, const double p[3], int32_t to, double typical,
                           bool *meets, vn_meeting *meeting) {
    *meets = false;
    VN_TRY(renew_edges(network, typical));
    vn_segment segment = {network->x.data[node], network->y.data[node], p[0], p[1]};
    way w = {network, node, to, segment, meeting, false};
    vn_edge_grid_visit(&network->edges, &segment, test_edge, &w);
    *meets = w.meets;
    return VN_OK;
}

vn_status vn_network_tree_of_points(vn_network *network, const vn_point_tree **tree) {
    if (network->tree_moved != network->moved) {
        vn_point_tree_free(&network->tree_of_points);
        network->tree_moved = network->moved;
    }
    vn_points points = vn_network_points(network);
    *tree = &network->tree_of_points;
    return vn_point_tree_update(&network->tree_of_points, network->dim, &points, network->x.count);
}

vn_status vn_network_delaunay(vn_network *network, vn_delaunay **delaunay) {
    if (network->delaunay != NULL && network->delaunay_moved != network->moved) {
        vn_delaunay_destroy(network->delaunay);
        network->delaunay = NULL;
    }
    if (network->delaunay == NULL) {
        VN_TRY(vn_delaunay_create(&network->delaunay, network->dim));
        network->delaunay_moved = network->moved;
    }
    vn_points points = vn_network_points(network);
    vn_status status = vn_delaunay_update(network->delaunay, &points, network->parent.data, network->x.count);
    if (status != VN_OK) {
        vn_delaunay_destroy(network->delaunay);
        network->delaunay = NULL;
    }
    *delaunay = network->delaunay;
    return status;
}
