#include "domain/closed.h"

#include "base/parallel.h"
#include "space/triangle_meets.h"

static int32_t corner(const vn_closed *m, int32_t triangle, int k) {
    return m->corners->data[3 * (int64_t)triangle + k % 3];
}

static const double *place(const vn_closed *m, int32_t vertex) {
    return m->faces->xyz + 3 * (int64_t)vertex;
}

// ---- Edges ----

/// Edges with one triangle, and with 3, 5, … of them.
typedef struct odd_edges {
    int32_t count[2], first[2]; ///< first: a halfedge
} odd_edges;

// A circle of halfedges leads upwards, and from its last one back to its first.
static odd_edges find_odd_edges(const vn_closed *m) {
    odd_edges odd = {{0}, {0}};
    for (int32_t last = 0; last < m->mate->count; last++) {
        int32_t first = m->mate->data[last], size = 1;
        if (first > last) {
            continue;
        }
        for (int32_t h = first; h != last; h = m->mate->data[h]) {
            size++;
        }
        if (size % 2 == 1) {
            int kind = size > 1;
            odd.first[kind] = odd.count[kind]++ == 0 ? first : odd.first[kind];
        }
    }
    return odd;
}

/// Holes: border edges that hang together.
typedef struct holes {
    vn_corners root; ///< of each vertex: another one of its hole, and at the last itself
    vn_corners edges;
    int32_t count, largest;
} holes;

static int32_t root_of(holes *h, int32_t v) {
    while (h->root.data[v] != v) {
        v = h->root.data[v] = h->root.data[h->root.data[v]];
    }
    return v;
}

static vn_status count_holes(const vn_closed *m, holes *h) {
    VN_TRY(vn_array_zero(&h->root, m->faces->vertices));
    VN_TRY(vn_array_zero(&h->edges, m->faces->vertices));
    for (int32_t v = 0; v < m->faces->vertices; v++) {
        h->root.data[v] = v;
    }
    for (int32_t e = 0; e < m->mate->count; e++) {
        if (m->mate->data[e] == e) {
            h->root.data[root_of(h, corner(m, e / 3, e % 3))] = root_of(h, corner(m, e / 3, e % 3 + 1));
        }
    }
    for (int32_t e = 0; e < m->mate->count; e++) {
        if (m->mate->data[e] == e) {
            int32_t size = ++h->edges.data[root_of(h, corner(m, e / 3, e % 3))];
            h->count += size == 1;
            h->largest = size > h->largest ? size : h->largest;
        }
    }
    return VN_OK;
}

static vn_status fail_open(const vn_closed *m, const odd_edges *odd) {
    holes h = {.count = 0};
    vn_status status = count_holes(m, &h);
    vn_array_free(&h.root);
    vn_array_free(&h.edges);
    VN_TRY(status);
    int32_t a = corner(m, odd->first[0] / 3, odd->first[0] % 3);
    const double *p = place(m, a);
    return vn_fail(
        VN_INVALID,
        "%s: the mesh is not closed: edges with a triangle on one side only: %d, around %d hole%s, the "
        "largest of %d edges, the first at vertex %lld at (%.6g, %.6g, %.6g); give repair = true to close "
        "them, or take its surface (on = \"surface\")",
        m->faces->what, odd->count[0], h.count, h.count == 1 ? "" : "s", h.largest,
        (long long)a + m->faces->first, p[0], p[1], p[2]);
}

static vn_status fail_sheets(const vn_closed *m, const odd_edges *odd) {
    int32_t h = odd->first[1], a = corner(m, h / 3, h % 3), b = corner(m, h / 3, h % 3 + 1);
    const double *p = place(m, a);
    return vn_fail(
        VN_INVALID,
        "%s: the mesh has sheets inside: edges with an odd number of triangles, 3 or more: %d, the "
        "first from vertex %lld at (%.6g, %.6g, %.6g) to vertex %lld; remove the inner sheets, or "
        "take its surface (on = \"surface\")",
        m->faces->what, odd->count[1], (long long)a + m->faces->first, p[0], p[1], p[2],
        (long long)b + m->faces->first);
}

vn_status vn_closed_check_edges(const vn_closed *m) {
    odd_edges odd = find_odd_edges(m);
    if (odd.count[0] > 0) {
        return fail_open(m, &odd);
    }
    return odd.count[1] > 0 ? fail_sheets(m, &odd) : VN_OK;
}

// ---- Crossings ----

// Two triangles that have no plane in common share a point of an edge of one of them: so edges are looked
// after. Where an edge begins at a corner of a triangle and is not in its plane, it shares no more with it.

/// The edge from @p a to @p b, and the triangle it meets or -1.
typedef struct edge_query {
    const vn_closed *mesh;
    int32_t a, b, found;
} edge_query;

// Turned so that `a` is the corner that is @p vertex.
static vn_triangle triangle_from(const vn_closed *m, int32_t triangle, int32_t vertex) {
    vn_triangle t;
    int k = 0;
    while (k < 2 && corner(m, triangle, k) != vertex) {
        k++;
    }
    memcpy(t.a, place(m, corner(m, triangle, k)), sizeof t.a);
    memcpy(t.b, place(m, corner(m, triangle, k + 1)), sizeof t.b);
    memcpy(t.c, place(m, corner(m, triangle, k + 2)), sizeof t.c);
    return t;
}

static bool has_corner(const vn_closed *m, int32_t triangle, int32_t vertex) {
    return corner(m, triangle, 0) == vertex || corner(m, triangle, 1) == vertex ||
           corner(m, triangle, 2) == vertex;
}

static bool is_crossed(const edge_query *e, int32_t triangle) {
    bool at_a = has_corner(e->mesh, triangle, e->a), at_b = has_corner(e->mesh, triangle, e->b);
    if (at_a && at_b) {
        return false;
    }
    const double *a = place(e->mesh, e->a), *b = place(e->mesh, e->b);
    vn_triangle t = triangle_from(e->mesh, triangle, at_b ? e->b : e->a);
    if (at_a || at_b) {
        return vn_line_enters(&t, at_b ? a : b);
    }
    vn_line_meeting meeting = vn_line_meets(&t, a, b);
    return meeting == VN_LINE_MEETS || (meeting == VN_LINE_COPLANAR && vn_coplanar_line_meets(&t, a, b));
}

static bool look_at(const vn_triangle *triangle, int32_t number, void *payload) {
    (void)triangle; // its corners are known by their numbers
    edge_query *e = payload;
    if (is_crossed(e, number)) {
        e->found = number;
    }
    return e->found < 0;
}

enum { RANGE = 256, RANGES = 256 };

/// Of each range of halfedges the first one that meets a triangle, and that triangle; or -1.
typedef struct crossing_search {
    const vn_closed *mesh;
    int32_t begin;
    int32_t halfedge[RANGES], triangle[RANGES];
} crossing_search;

static void search_range(int64_t begin, int64_t end, void *payload) {
    crossing_search *search = payload;
    const vn_closed *m = search->mesh;
    int64_t range = begin / RANGE;
    search->triangle[range] = -1;
    for (int64_t i = begin; i < end && search->triangle[range] < 0; i++) {
        int32_t h = (int32_t)(search->begin + i);
        if (m->mate->data[h] > h) { // once for each edge, or a few times where more than two triangles meet
            edge_query e = {m, corner(m, h / 3, h % 3), corner(m, h / 3, h % 3 + 1), -1};
            vn_triangle_tree_along(m->tree, place(m, e.a), place(m, e.b), look_at, &e);
            search->triangle[range] = e.found;
            search->halfedge[range] = h;
        }
    }
}

static vn_status fail_crossing(const vn_closed *m, int32_t h, int32_t triangle) {
    int32_t a = corner(m, h / 3, h % 3), b = corner(m, h / 3, h % 3 + 1), c = corner(m, triangle, 0);
    const double *p = place(m, a), *q = place(m, c);
    return vn_fail(
        VN_INVALID,
        "%s: the mesh crosses or touches itself: the edge from vertex %lld at (%.6g, %.6g, %.6g) to "
        "vertex %lld meets a triangle at vertex %lld at (%.6g, %.6g, %.6g); repair it, or say check = "
        "false: then what is inside two of its parts is outside",
        m->faces->what, (long long)a + m->faces->first, p[0], p[1], p[2], (long long)b + m->faces->first,
        (long long)c + m->faces->first, q[0], q[1], q[2]);
}

vn_status vn_closed_check_crossings(const vn_closed *m) {
    crossing_search search = {.mesh = m};
    for (int32_t begin = 0; begin < m->mate->count; begin += RANGE * RANGES) {
        int32_t count = m->mate->count - begin < RANGE * RANGES ? m->mate->count - begin : RANGE * RANGES;
        VN_TRY(vn_poll());
        search.begin = begin;
        vn_parallel_for(count, RANGE, search_range, &search);
        for (int32_t range = 0; range * RANGE < count; range++) {
            if (search.triangle[range] >= 0) {
                return fail_crossing(m, search.halfedge[range], search.triangle[range]);
            }
        }
        if (count < RANGE * RANGES) {
            break; // nor may the sum overflow
        }
    }
    return VN_OK;
}
