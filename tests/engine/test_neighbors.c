// V(s) against its definition. Coordinates are whole numbers below 2^20, so that plain doubles are exact.

#include "support.h"

#include "colonize/attractors.h"

enum { MOST = 240 };

typedef struct scene {
    int dim, nodes;
    double node[MOST][3];
    double source[3];
} scene;

static double squared(const double p[3], const double q[3]) {
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        sum += (p[k] - q[k]) * (p[k] - q[k]);
    }
    return sum;
}

// READINGS R4, word for word.
static bool is_relative_neighbor(const scene *s, int v) {
    double d = squared(s->node[v], s->source);
    for (int u = 0; u < s->nodes; u++) {
        if (u != v && squared(s->node[u], s->source) < d && squared(s->node[u], s->node[v]) <= d) {
            return false;
        }
    }
    return true;
}

static void random_place(vn_rng *rng, int dim, int kind, double p[3]) {
    static const double ring[12][2] = {{25, 0},   {-25, 0},   {0, 25},  {0, -25},  {15, 20}, {-15, 20},
                                       {15, -20}, {-15, -20}, {20, 15}, {-20, 15}, {7, 24},  {24, 7}};
    double size = kind == 0 ? 1 << 20 : kind == 1 ? 6 : 40;
    for (int k = 0; k < 3; k++) {
        p[k] = k < dim ? floor(vn_rng_uniform(rng, 0, size)) : 0;
    }
    if (kind == 2) { // on one line
        p[1] = 2 * p[0];
        p[2] = dim == 3 ? 3 * p[0] : 0;
    } else if (kind == 3) { // on one circle
        const double *q = ring[(int)vn_rng_uniform(rng, 0, 12)];
        p[0] = q[0];
        p[1] = q[1];
        p[2] = 0;
    }
}

static vn_network *nodes_of(const scene *s, int nodes) {
    vn_network *network = network_of(s->dim);
    for (int i = 0; i < nodes; i++) {
        assert_ok(vn_network_root(network, s->node[i], NULL));
    }
    return network;
}

static int found(vn_influence **influence, vn_attractors *a, vn_network *network, int mode, bool seen[MOST]) {
    vn_influence_def def = {.mode = mode};
    assert_ok(vn_influence_find(influence, a, network, &def));
    memset(seen, 0, MOST * sizeof *seen);
    for (int32_t k = 0; k < vn_influence_count(*influence); k++) {
        assert_false(seen[vn_influence_node(*influence, k)]);
        seen[vn_influence_node(*influence, k)] = true;
    }
    return vn_influence_count(*influence);
}

static void assert_relative(const scene *s, const bool seen[MOST]) {
    for (int v = 0; v < s->nodes; v++) {
        if (seen[v] != is_relative_neighbor(s, v)) {
            print_message("dim %d, %d nodes, node %d: %d\n", s->dim, s->nodes, v, seen[v]);
        }
        assert_int_equal(seen[v], is_relative_neighbor(s, v));
    }
}

// A root, or the child of some node: of any, since no law of V(s) speaks of parents.
static void add_node(vn_network *network, const double p[3], vn_rng *rng) {
    int32_t count = vn_network_count(network);
    if (count == 0 || whole(rng, 0, 4) == 0) {
        assert_ok(vn_network_root(network, p, NULL));
    } else {
        assert_ok(vn_network_add(network, (int32_t)whole(rng, 0, count - 1), p, NULL));
    }
}

// The source comes first, last or half way; nodes come one at a time or in batches.
typedef void check_fn(const scene *s, const bool seen[MOST]);
static void check_scene(scene *s, vn_rng *rng, int mode, check_fn *check) {
    bool seen[MOST];
    int all = s->nodes, early = (int)vn_rng_uniform(rng, 0, all + 1);
    vn_network *network = nodes_of(s, early);
    vn_attractors *a = attractors_of(s->dim, 0);
    vn_influence *influence = NULL;
    assert_ok(vn_attractors_add(a, s->source));
    for (int count = early; count <= all;) {
        s->nodes = count;
        found(&influence, a, network, mode, seen);
        check(s, seen);
        int next = count + 1 + (int)vn_rng_uniform(rng, 0, 40);
        next = next > all && count < all ? all : next;
        for (int i = count; i < next && i < all; i++) {
            add_node(network, s->node[i], rng);
        }
        count = next;
    }
    s->nodes = all;
    vn_influence_destroy(influence);
    vn_attractors_destroy(a);
    vn_network_destroy(network);
}

static void relative_neighbors_are_what_the_definition_says(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 12000; seed++) {
        vn_rng rng = vn_rng_make(seed);
        int kind = (int)(seed % 5);
        scene s = {.dim = seed % 3 == 2 ? 3 : 2};
        s.nodes = 1 + (int)vn_rng_uniform(&rng, 0, seed % 7 == 0 ? MOST - 1 : 70);
        for (int i = 0; i < s.nodes; i++) {
            random_place(&rng, s.dim, kind, s.node[i]);
        }
        random_place(&rng, s.dim, seed % 2 == 0 ? kind : 4, s.source);
        for (int k = 0; k < s.dim && seed % 11 == 0; k++) {
            s.source[k] = s.node[0][k]; // on a node
        }
        s.source[0] -= seed % 13 == 0 ? 1000 : 0; // outside the hull
        check_scene(&s, &rng, VN_RELATIVE, assert_relative);
    }
}

// --- Urquhart neighbors -----------------------------------------------------------------------------------

/// Whole numbers about the source: x, y, z and the squared distance from it.
typedef struct lifted {
    int64_t v[4];
} lifted;

static lifted lift(const scene *s, int node) {
    lifted l = {{0}};
    for (int k = 0; k < 3; k++) {
        l.v[k] = (int64_t)(s->node[node][k] - s->source[k]);
        l.v[3] += l.v[k] * l.v[k];
    }
    return l;
}

static int64_t det2(const lifted *a, const lifted *b, int i, int j) {
    return a->v[i] * b->v[j] - a->v[j] * b->v[i];
}

static int64_t det3(const lifted *a, const lifted *b, const lifted *c, int i, int j, int k) {
    return a->v[i] * det2(b, c, j, k) - a->v[j] * det2(b, c, i, k) + a->v[k] * det2(b, c, i, j);
}

static int64_t det4(const lifted *a, const lifted *b, const lifted *c, const lifted *d) {
    return -a->v[3] * det3(b, c, d, 0, 1, 2) + b->v[3] * det3(a, c, d, 0, 1, 2) -
           c->v[3] * det3(a, b, d, 0, 1, 2) + d->v[3] * det3(a, b, c, 0, 1, 2);
}

// The power of p to the circle (sphere) through the source and corners; negative inside. *flat: there is
// none.
static int64_t power(const lifted corner[], int dim, const lifted *p, bool *flat) {
    int64_t turn =
        dim == 2 ? det2(&corner[0], &corner[1], 0, 1) : det3(&corner[0], &corner[1], &corner[2], 0, 1, 2);
    int64_t value =
        dim == 2 ? det3(&corner[0], &corner[1], p, 0, 1, 3) : det4(&corner[0], &corner[1], &corner[2], p);
    *flat = turn == 0;
    return turn > 0 ? value : -value;
}

static bool is_empty(const scene *s, const lifted *all, const lifted corner[], const int index[], bool *tie) {
    for (int p = 0; p < s->nodes; p++) {
        bool flat, is_corner = p == index[0] || p == index[1] || (s->dim == 3 && p == index[2]);
        int64_t value = power(corner, s->dim, &all[p], &flat);
        *tie = *tie || flat || (value == 0 && !is_corner);
        if (flat || (value < 0 && !is_corner)) {
            return false;
        }
    }
    return true;
}

/// The source's triangles (tetrahedra), by brute force.
typedef struct cells_around {
    bool near[MOST];    ///< Delaunay neighbors
    bool longest[MOST]; ///< and the edge to them is the longest of some triangle: what the rule of 1980 drops
    bool degenerate;
} cells_around;

static void note_cell(const scene *s, cells_around *star, const int index[]) {
    for (int i = 0; i < s->dim; i++) {
        double d = squared(s->node[index[i]], s->source);
        star->near[index[i]] = true;
        for (int j = 0; j < s->dim; j++) {
            star->longest[index[i]] |= j != i && squared(s->node[index[j]], s->source) < d &&
                                       squared(s->node[index[j]], s->node[index[i]]) <= d;
        }
    }
}

static cells_around star_of(const scene *s) {
    cells_around star = {.degenerate = s->nodes <= s->dim};
    lifted all[MOST];
    for (int i = 0; i < s->nodes; i++) {
        all[i] = lift(s, i);
    }
    for (int i = 0; i < s->nodes; i++) {
        for (int j = 0; j < i; j++) {
            for (int k = 0; k < (s->dim == 3 ? j : 1); k++) {
                int index[3] = {i, j, k};
                lifted corner[3] = {all[i], all[j], all[k]};
                if (is_empty(s, all, corner, index, &star.degenerate)) {
                    note_cell(s, &star, index);
                }
            }
        }
    }
    return star;
}

static bool is_kept_among(const scene *s, const bool among[MOST], int v) {
    double d = squared(s->node[v], s->source);
    for (int u = 0; u < s->nodes; u++) {
        if (u != v && among[u] && squared(s->node[u], s->source) < d &&
            squared(s->node[u], s->node[v]) <= d) {
            return false;
        }
    }
    return true;
}

static int general_scenes, wider_scenes;

// READINGS R5: R4 among the Delaunay neighbors; and what lies between what.
static void assert_urquhart(const scene *s, const bool seen[MOST]) {
    cells_around star = star_of(s);
    if (star.degenerate) {
        return;
    }
    general_scenes++;
    bool wider = false;
    for (int v = 0; v < s->nodes; v++) {
        assert_int_equal(seen[v], star.near[v] && is_kept_among(s, star.near, v));
        assert_true(seen[v] || !is_relative_neighbor(s, v));
        assert_true(!seen[v] || !star.longest[v]);
        wider = wider || (seen[v] && !is_relative_neighbor(s, v));
    }
    wider_scenes += wider;
}

static void urquhart_neighbors_are_what_the_definition_says(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 4000; seed++) {
        vn_rng rng = vn_rng_make(seed);
        scene s = {.dim = seed % 4 == 3 ? 3 : 2};
        int64_t size = s.dim == 2 ? 8000 : 500;
        s.nodes = (int)vn_rng_integer(&rng, 3, s.dim == 2 ? 36 : 16);
        for (int i = 0; i <= s.nodes; i++) {
            double *p = i < s.nodes ? s.node[i] : s.source;
            for (int k = 0; k < s.dim; k++) {
                p[k] = (double)vn_rng_integer(&rng, 0, size - 1);
            }
        }
        s.source[1] -= seed % 13 == 0 && s.dim == 2 ? 6000 : 0; // outside the hull
        check_scene(&s, &rng, VN_URQUHART, assert_urquhart);
    }
    assert_true(general_scenes > 2000);
    assert_true(wider_scenes > 20);
}

// What moved is looked at anew.
static void neighbors_are_found_again_after_a_scaling(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 200; seed++) {
        vn_rng rng = vn_rng_make(seed);
        scene s = {.dim = 2, .nodes = 30, .source = {3001, 2999}};
        int mode = seed % 2 == 0 ? VN_RELATIVE : VN_URQUHART;
        bool seen[MOST];
        for (int i = 0; i < s.nodes; i++) {
            for (int k = 0; k < 2; k++) {
                s.node[i][k] = (double)vn_rng_integer(&rng, 0, 4000);
            }
        }
        vn_network *network = nodes_of(&s, s.nodes);
        vn_attractors *a = attractors_of(s.dim, 0);
        vn_influence *influence = NULL;
        assert_ok(vn_attractors_add(a, s.source));
        found(&influence, a, network, mode, seen);
        assert_ok(vn_network_scale(network, 2));
        for (int i = 0; i < s.nodes; i++) {
            s.node[i][0] *= 2;
            s.node[i][1] *= 2;
        }
        found(&influence, a, network, mode, seen);
        (mode == VN_RELATIVE ? assert_relative : assert_urquhart)(&s, seen);
        vn_influence_destroy(influence);
        vn_attractors_destroy(a);
        vn_network_destroy(network);
    }
}

// The first node, and all that are on one line, have no triangles; a source may be on one of them.
static void urquhart_neighbors_without_triangles(void **state) {
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        for (int nodes = 1; nodes <= 6; nodes++) {
            scene s = {.dim = dim, .nodes = nodes, .source = {4, 4}};
            bool seen[MOST];
            for (int i = 0; i < nodes; i++) {
                s.node[i][0] = s.node[i][1] = 2 * (i + 1);
            }
            for (int aside = 0; aside < 2; aside++) {
                s.source[0] += aside;
                vn_network *network = nodes_of(&s, nodes);
                vn_attractors *a = attractors_of(dim, 0);
                vn_influence *influence = NULL;
                assert_ok(vn_attractors_add(a, s.source));
                found(&influence, a, network, VN_URQUHART, seen);
                assert_relative(&s, seen);
                vn_influence_destroy(influence);
                vn_attractors_destroy(a);
                vn_network_destroy(network);
            }
        }
    }
}

/// Veins in a box that extend() knows: sources that come later count on new nodes being inside.
typedef struct walled {
    vn_domain *box;
    vn_network *network;
    vn_attractors *sources;
    vn_influence *influence;
    vn_rng rng;
} walled;

enum { WALL = 100 };

static bool excludes_exactly(const double u[3], const double v[3], const double s[3]) {
    return vn_compare_distances(s, u, v) < 0 && vn_compare_distances(v, u, s) <= 0;
}

static bool is_neighbor_by_definition(const vn_network *network, int32_t v, const double s[3]) {
    double p[3], q[3];
    vn_network_position(network, v, p);
    for (int32_t u = 0; u < vn_network_count(network); u++) {
        vn_network_position(network, u, q);
        if (u != v && excludes_exactly(q, p, s)) {
            return false;
        }
    }
    return true;
}

static int32_t count_by_definition(const walled *w) {
    int32_t pairs = 0;
    vn_points points = vn_attractors_points(w->sources);
    for (int32_t i = 0; i < vn_attractors_count(w->sources); i++) {
        double s[3];
        vn_points_get(&points, i, s);
        for (int32_t v = 0; v < vn_network_count(w->network); v++) {
            pairs += is_neighbor_by_definition(w->network, v, s);
        }
    }
    return pairs;
}

static void check_walled(walled *w) {
    vn_influence_def def = {.mode = VN_RELATIVE};
    vn_points points = vn_attractors_points(w->sources);
    assert_ok(vn_influence_find(&w->influence, w->sources, w->network, &def));
    for (int32_t k = 0; k < vn_influence_count(w->influence); k++) {
        double s[3];
        vn_points_get(&points, vn_influence_attractor(w->influence, k), s);
        assert_true(is_neighbor_by_definition(w->network, vn_influence_node(w->influence, k), s));
    }
    assert_int_equal(vn_influence_count(w->influence), count_by_definition(w));
}

static void extend_walled(walled *w, int steps) {
    vn_extend_def def = {.length = 3, .domain = w->box, .meet = VN_MEET_JOIN};
    int32_t added, first;
    for (int step = 0; step < steps; step++) {
        assert_ok(vn_extend(w->network, w->influence, &def, &added, &first));
        check_walled(w);
    }
}

static void place_in(vn_rng *rng, double low, double high, double p[3]) {
    p[0] = uniform(rng, low, high);
    p[1] = uniform(rng, low, high);
    p[2] = 0;
}

// By hand: in the box mostly, or beyond one of its walls, where no source looks for it.
static void add_by_hand(walled *w, bool outside) {
    double p[3];
    place_in(&w->rng, 0, WALL, p);
    int side = (int)whole(&w->rng, 0, 3);
    if (outside) {
        p[side / 2] = side % 2 ? WALL + uniform(&w->rng, 0, WALL) : -uniform(&w->rng, 0, WALL);
    }
    int32_t parent = (int32_t)whole(&w->rng, 0, vn_network_count(w->network) - 1);
    assert_ok(vn_network_add(w->network, parent, p, NULL));
}

static void sow_walled(walled *w, int sources) {
    for (int i = 0; i < sources; i++) {
        double s[3];
        place_in(&w->rng, 0, WALL, s);
        assert_ok(vn_attractors_add(w->sources, s));
    }
}

// The veins start in a corner, so that most sources see them on one side alone.
static void start_walled(walled *w, uint64_t seed) {
    *w = (walled){.rng = vn_rng_make(seed), .box = box_of(0, 0, WALL, WALL)};
    w->network = network_of(2);
    w->sources = attractors_of(2, 0);
    double width = uniform(&w->rng, 5, WALL);
    for (int64_t k = whole(&w->rng, 1, 12); k > 0; k--) {
        double p[3];
        place_in(&w->rng, 0, width, p);
        assert_ok(vn_network_root(w->network, p, NULL));
    }
    sow_walled(w, 3);
    check_walled(w);
}

static void neighbors_inside_walls_and_beyond(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 400; seed++) {
        walled w;
        start_walled(&w, seed);
        extend_walled(&w, 3);
        sow_walled(&w, 5);
        check_walled(&w);
        extend_walled(&w, (int)whole(&w.rng, 1, 4));
        add_by_hand(&w, false);
        check_walled(&w);
        add_by_hand(&w, true);
        check_walled(&w);
        extend_walled(&w, 2);
        sow_walled(&w, 3);
        check_walled(&w);
        add_by_hand(&w, true);
        check_walled(&w);
        vn_influence_destroy(w.influence);
        vn_attractors_destroy(w.sources);
        vn_network_destroy(w.network);
        vn_domain_release(w.box);
    }
}

static void assert_golden(const double (*node)[2], int nodes, double x, double y, int mode,
                          unsigned expected) {
    scene s = {.dim = 2, .nodes = nodes, .source = {x, y}};
    for (int i = 0; i < nodes; i++) {
        s.node[i][0] = node[i][0];
        s.node[i][1] = node[i][1];
    }
    // Enough far nodes that the triangulation is asked, on a circle round everything.
    for (int i = 0; i < 60 && mode >= 0; i++) {
        s.node[s.nodes][0] = 1000 * cos(0.1 * i);
        s.node[s.nodes++][1] = 1000 * sin(0.1 * i);
    }
    bool seen[MOST];
    vn_network *network = nodes_of(&s, s.nodes);
    vn_attractors *a = attractors_of(s.dim, 0);
    vn_influence *influence = NULL;
    assert_ok(vn_attractors_add(a, s.source));
    found(&influence, a, network, mode, seen);
    for (int i = 0; i < nodes; i++) {
        assert_int_equal(seen[i], expected >> i & 1);
    }
    vn_influence_destroy(influence);
    vn_attractors_destroy(a);
    vn_network_destroy(network);
}

static void golden_neighbors(void **state) {
    (void)state;
    static const double first[][2] = {{.38, .18}, {.94, .56}, {.58, .81}, {.62, .33}, {.49, .29}};
    static const double second[][2] = {{.29, .29}, {.53, .56}, {.39, .32}, {.52, .73}};
    static const double tie[][2] = {{3, 4}, {5, 0}}, twice[][2] = {{2, 0}, {2, 0}},
                        not_tie[][2] = {{1, 3}, {5, 0}};
    assert_golden(first, 5, .2, .5, VN_RELATIVE, 1 << 4);
    assert_golden(first, 5, .2, .5, VN_URQUHART, 1 << 2 | 1 << 4);
    assert_golden(second, 4, .22, .70, VN_RELATIVE, 1 << 3);
    assert_golden(second, 4, .22, .70, VN_URQUHART, 1 << 3);
    for (int mode = VN_RELATIVE; mode <= VN_URQUHART; mode++) {
        assert_golden(tie, 2, 0, 0, mode, 3);
        assert_golden(twice, 2, 0, 0, mode, 3);
        assert_golden(not_tie, 2, 0, 0, mode, 1);
    }
}

// READINGS, golden cases: two veins meet at one source.
static void golden_meeting(void **state) {
    (void)state;
    scene s = {.dim = 2, .nodes = 2, .node = {{-3, 0}, {4, 0}}};
    vn_network *network = nodes_of(&s, 2);
    vn_attractors *a = attractors_of(s.dim, 0);
    vn_influence *influence = NULL;
    vn_influence_def find = {.mode = VN_RELATIVE};
    vn_extend_def extend = {.length = 1, .meet = VN_MEET_JOIN};
    vn_consume_def consume = {.distance = 1.2, .mode = VN_CONSUME_TAGGED};
    assert_ok(vn_attractors_add(a, s.source));
    static const int32_t added[] = {2, 2, 1}, died[] = {0, 0, 1};
    for (int step = 0; step < 3; step++) {
        int32_t more, first, consumed;
        assert_ok(vn_influence_find(&influence, a, network, &find));
        assert_ok(vn_extend(network, influence, &extend, &more, &first));
        assert_ok(vn_consume(a, network, &consume, &consumed));
        assert_int_equal(more, added[step]);
        assert_int_equal(consumed, died[step]);
    }
    assert_int_equal(vn_attractors_count(a), 0);
    assert_int_equal(vn_network_count(network), 8);
    assert_int_equal(vn_network_join_count(network), 1);
    int32_t end, junction;
    double radius;
    vn_network_join_ends(network, 0, &end, &junction, &radius);
    assert_true(vn_network_x(network)[junction] == 0 && vn_network_y(network)[junction] == 0);
    assert_true(vn_network_x(network)[end] == 1);
    assert_true(vn_network_x(network)[vn_network_parent(network)[junction]] == -1);
    vn_influence_destroy(influence);
    vn_attractors_destroy(a);
    vn_network_destroy(network);
}

static int32_t grow_among_walls(int meet, uint64_t seed, vn_retired *retired) {
    vn_network *network = network_of(2);
    vn_attractors *a = attractors_of(2, seed);
    vn_influence *influence = NULL;
    vn_rng rng = vn_rng_make(seed);
    vn_leaf_measures measures;
    for (int wall = 0; wall < 12; wall++) {
        double p[3] = {4 * wall, 0, 0}, q[3] = {4 * wall, 20, 0};
        int32_t root;
        assert_ok(vn_network_root(network, p, &root));
        assert_ok(vn_network_add(network, root, q, NULL));
    }
    for (int k = 0; k < 150; k++) {
        double p[3] = {vn_rng_uniform(&rng, -2, 46), vn_rng_uniform(&rng, 0, 20), 0};
        assert_ok(vn_attractors_add(a, p));
    }
    for (int step = 0; vn_attractors_count(a) > 0; step++) {
        int32_t added, first, consumed;
        assert_true(step < 2000);
        assert_ok(vn_influence_find(&influence, a, network, &(vn_influence_def){.mode = VN_NEAREST}));
        assert_ok(vn_extend(network, influence, &(vn_extend_def){.length = 1, .meet = meet}, &added, &first));
        assert_ok(vn_consume(a, network, &(vn_consume_def){.distance = 0.8}, &consumed));
    }
    vn_leaf_def whole = vn_leaf_def_default();
    assert_ok(vn_network_measure_leaf(network, &whole, &measures));
    int32_t crossings = measures.crossings;
    assert_int_equal(vn_network_join_count(network), 0);
    *retired = vn_attractors_retired(a);
    vn_leaf_measures_free(&measures);
    vn_influence_destroy(influence);
    vn_attractors_destroy(a);
    vn_network_destroy(network);
    return crossings;
}

// Walls of one long edge each, whose ends alone are nodes: veins from there would pass through them.
static void a_vein_stops_before_it_crosses(void **state) {
    (void)state;
    vn_retired retired;
    for (uint64_t seed = 1; seed <= 20; seed++) {
        assert_true(grow_among_walls(VN_MEET_CROSS, seed, &retired) > 0);
        assert_int_equal(retired.barred, 0);
        assert_int_equal(grow_among_walls(VN_MEET_STOP, seed, &retired), 0);
        assert_true(retired.barred > 0 && retired.barred < 100);
        assert_int_equal(retired.hidden, 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(relative_neighbors_are_what_the_definition_says),
        cmocka_unit_test(urquhart_neighbors_are_what_the_definition_says),
        cmocka_unit_test(urquhart_neighbors_without_triangles),
        cmocka_unit_test(neighbors_are_found_again_after_a_scaling),
        cmocka_unit_test(neighbors_inside_walls_and_beyond),
        cmocka_unit_test(golden_neighbors),
        cmocka_unit_test(golden_meeting),
        cmocka_unit_test(a_vein_stops_before_it_crosses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
