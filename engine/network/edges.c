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

// Of the edge grid, in typical lengths: wide enough for an edge to be in one or two cells, and for a few
// edges to be in each.
static const double CELL = 5;

// New edges become shorter where the unit of length shrinks: cells that have become too wide for them, or too
// few, are made anew.
static vn_status renew_edges(vn_network *network, double typical) {
    const vn_edge_grid *grid = &network->edges;
    int32_t count = network->x.count + network->joins.count;
    double cell = CELL * typical;
    bool fits = grid->cell > 0 && grid->cell <= 2 * cell && cell <= 4 * grid->cell;
    if (!fits || count > network->edge_room || network->edges_moved != network->moved) {
        network->edge_nodes = network->edge_joins = 0;
        network->edge_room = count < INT32_MAX / 2 ? 2 * count + 512 : INT32_MAX;
        network->edges_moved = network->moved;
        VN_TRY(vn_edge_grid_init(&network->edges, cell, network->edge_room));
    }
    return list_edges(network);
}

typedef struct way {
    const vn_network *network;
    int32_t node, to;
    vn_segment segment;
    double
        near; ///< what comes this close is met: rounding must not decide on which side of an edge a node is
    vn_meeting *first;
    bool meets;
} way;

// The part of segment @p s at which it is nearest to a point, if that is near enough; else 2.
static double part_near(const vn_segment *s, double x, double y, double near) {
    double sx = s->x1 - s->x0, sy = s->y1 - s->y0;
    double length2 = sx * sx + sy * sy;
    double part = length2 > 0 ? ((x - s->x0) * sx + (y - s->y0) * sy) / length2 : 0;
    part = fmin(fmax(part, 0), 1);
    double dx = s->x0 + part * sx - x, dy = s->y0 + part * sy - y;
    return dx * dx + dy * dy <= near * near ? part : 2;
}

// The part of segment @p s up to the line of @p t; they cross. Parallel ones have ends that are met first.
static double part_until(const vn_segment *s, const vn_segment *t) {
    double sx = s->x1 - s->x0, sy = s->y1 - s->y0;
    double tx = t->x1 - t->x0, ty = t->y1 - t->y0;
    double ax = t->x0 - s->x0, ay = t->y0 - s->y0;
    double part = (ax * ty - ay * tx) / (sx * ty - sy * tx);
    return isfinite(part) ? fmin(fmax(part, 0), 1) : 1;
}

// The part of segment @p s at which it first meets @p t; 2 where it does not.
static double part_met(const vn_segment *s, const vn_segment *t, double near) {
    double part = vn_segments_touch(s, t) ? part_until(s, t) : 2;
    part = part_near(t, s->x0, s->y0, near) <= 1 ? 0 : part;
    part = part_near(t, s->x1, s->y1, near) <= 1 ? fmin(part, 1) : part;
    part = fmin(part, part_near(s, t->x0, t->y0, near));
    return fmin(part, part_near(s, t->x1, t->y1, near));
}

// Where they share the first end of @p s: whether one lies along the other beyond it.
static bool runs_along(const vn_segment *s, double ox, double oy, double near) {
    double forward = (ox - s->x0) * (s->x1 - s->x0) + (oy - s->y0) * (s->y1 - s->y0);
    double far2 = (ox - s->x0) * (ox - s->x0) + (oy - s->y0) * (oy - s->y0);
    vn_segment other = {s->x0, s->y0, ox, oy};
    return forward > 0 && far2 > near * near &&
           (part_near(s, ox, oy, near) <= 1 || part_near(&other, s->x1, s->y1, near) <= 1);
}

static void note_meeting(way *w, int32_t edge, const vn_segment *t, double part) {
    bool first = !w->meets || part < w->first->way || (part == w->first->way && edge < w->first->edge);
    if (first) {
        const vn_segment *s = &w->segment;
        double x = s->x0 + part * (s->x1 - s->x0), y = s->y0 + part * (s->y1 - s->y0);
        double on = part_near(t, x, y, INFINITY);
        *w->first = (vn_meeting){edge, part, {t->x0 + on * (t->x1 - t->x0), t->y0 + on * (t->y1 - t->y0), 0}};
        w->meets = true;
    }
}

// Whether the span of @p a and @p b begins beyond the end of that of @p c and @p d. (fmin() and fmax() are
// calls.)
static bool is_beyond(double a, double b, double c, double d, double near) {
    return (a < b ? a : b) > (c > d ? c : d) + near;
}

static bool are_apart(const vn_segment *s, const vn_segment *t, double near) {
    return is_beyond(s->x0, s->x1, t->x0, t->x1, near) || is_beyond(t->x0, t->x1, s->x0, s->x1, near) ||
           is_beyond(s->y0, s->y1, t->y0, t->y1, near) || is_beyond(t->y0, t->y1, s->y0, s->y1, near);
}

// An edge of the node itself, or of the node that the way leads to, is met only where the way runs along it.
static bool test_edge(int32_t edge, void *payload) {
    way *w = payload;
    const double *x = w->network->x.data, *y = w->network->y.data;
    vn_segment t = vn_network_segment(w->network, edge), s = w->segment;
    if (are_apart(&s, &t, w->near)) {
        return true;
    }
    int32_t a, b;
    vn_network_edge_ends(w->network, edge, &a, &b);
    vn_segment back = {s.x1, s.y1, s.x0, s.y0};
    if (a == w->node || b == w->node) {
        int32_t other = a == w->node ? b : a;
        if (other == w->to || runs_along(&s, x[other], y[other], w->near)) {
            note_meeting(w, edge, &t, 0);
        }
    } else if (a == w->to || b == w->to) {
        int32_t other = a == w->to ? b : a;
        double part = part_near(&s, x[other], y[other], INFINITY);
        if (runs_along(&back, x[other], y[other], w->near)) {
            note_meeting(w, edge, &t, part);
        }
    } else {
        double part = part_met(&s, &t, w->near);
        if (part <= 1) {
            note_meeting(w, edge, &t, part);
        }
    }
    return true;
}

vn_status vn_network_meets(vn_network *network, int32_t node, const double p[3], int32_t to, double typical,
                           bool *meets, vn_meeting *meeting) {
    *meets = false;
    VN_TRY(renew_edges(network, typical));
    vn_segment segment = {network->x.data[node], network->y.data[node], p[0], p[1]};
    way w = {network, node, to, segment, VN_NEAR_EDGE * typical, meeting, false};
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
