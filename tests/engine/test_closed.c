// Closed venation as whole runs: what must hold of every pattern, whatever was drawn at random.

#include "support.h"

#include "colonize/attractors.h"

/// One run: what it is made of, and its state.
typedef struct trial {
    int dim, influence, consume, meet;
    double length, kill, within;
    double shrink; ///< of length and kill distance, each step
    double grow;   ///< of the network, each step
    bool fickle;   ///< modes change
    int sources, early, roots;
    uint64_t seed;
    vn_domain *domain; ///< destroyed with the trial; may be NULL
    double low[2], high[2];

    vn_network *network;
    vn_attractors *alive, *eaten;
    vn_influence *found;
    vn_rng rng;
    int thrown, steps, idle;
    int pairs, joined; ///< of ends that came to one source, and how many of these are joined
    double longest;
} trial;

static void place_in(trial *t, double p[3]) {
    do {
        for (int k = 0; k < 3; k++) {
            p[k] = k < t->dim ? uniform(&t->rng, t->low[k % 2], t->high[k % 2]) : 0;
        }
    } while (t->domain != NULL && !vn_domain_contains(t->domain, p));
}

// One in eight is on a node, one in eight on the source before.
static void throw_one(trial *t) {
    double p[3];
    int kind = (int)whole(&t->rng, 0, 7);
    place_in(t, p);
    if (kind == 0) {
        vn_network_position(t->network, (int32_t)whole(&t->rng, 0, vn_network_count(t->network) - 1), p);
    } else if (kind == 1 && vn_attractors_count(t->alive) > 0) {
        assert_ok(vn_attractors_position(t->alive, vn_attractors_count(t->alive) - 1, p));
    }
    assert_ok(vn_attractors_add(t->alive, p));
    t->thrown++;
}

static void begin(trial *t) {
    t->network = network_of(t->dim);
    t->alive = attractors_of(t->dim, (int64_t)t->seed);
    t->eaten = attractors_of(t->dim, 0);
    t->rng = vn_rng_make(t->seed);
    for (int i = 0; i < t->roots; i++) {
        double p[3];
        place_in(t, p);
        assert_ok(vn_network_root(t->network, p, NULL));
    }
    while (t->thrown < t->early) {
        throw_one(t);
    }
}

static void end(trial *t) {
    vn_influence_destroy(t->found);
    vn_attractors_destroy(t->alive);
    vn_attractors_destroy(t->eaten);
    vn_network_destroy(t->network);
    vn_domain_release(t->domain);
}

static int32_t edge_count(const vn_network *network) {
    return vn_network_count(network) + vn_network_join_count(network);
}

// Edge e: of node e, or of join e - nodes. False where there is none.
static bool edge_of(const vn_network *network, int32_t e, int32_t *a, int32_t *b) {
    int32_t nodes = vn_network_count(network);
    double radius;
    if (e < nodes) {
        *a = vn_network_parent(network)[e];
        *b = e;
        return *a >= 0;
    }
    vn_network_join_ends(network, e - nodes, a, b, &radius);
    return true;
}

// --- which ends a source joins ----------------------------------------------------------------------------

enum { WAY = 8 }; // ends that are so few edges apart have met

/// Two reached ends at one source, close to one another, before it died.
typedef struct end_pair {
    int32_t source, a, b;
} end_pair;

// Edges between two nodes on the shortest way, up to @p most.
static int steps_between(const vn_network *network, int32_t a, int32_t b, int most) {
    int32_t count = vn_network_count(network), x, y;
    uint8_t *far = malloc((size_t)count);
    memset(far, 255, (size_t)count);
    far[a] = 0;
    for (int step = 0; step < most && far[b] == 255; step++) {
        for (int32_t e = 0; e < edge_count(network); e++) {
            if (edge_of(network, e, &x, &y) && (far[x] == step || far[y] == step)) {
                far[x] = far[x] == 255 ? (uint8_t)(step + 1) : far[x];
                far[y] = far[y] == 255 ? (uint8_t)(step + 1) : far[y];
            }
        }
    }
    int steps = far[b] == 255 ? most + 1 : far[b];
    free(far);
    return steps;
}

static bool is_end(const trial *t, int32_t i, const vn_tie *tie) {
    double p[3], q[3];
    vn_points points = vn_attractors_points(t->alive);
    vn_points_get(&points, i, p);
    vn_network_position(t->network, tie->node, q);
    bool tagged = (t->alive->stage.data[i] & VN_TOUCHED) == 0 || (tie->state & VN_TAGGED);
    return tagged && !(tie->state & VN_GHOST) && sqrt(vn_distance2(p, q)) < t->kill;
}

static bool are_near(const trial *t, int32_t a, int32_t b) {
    double p[3], q[3];
    vn_network_position(t->network, a, p);
    vn_network_position(t->network, b, q);
    return sqrt(vn_distance2(p, q)) <= 2 * t->length;
}

static void list_pairs_of(const trial *t, int32_t i, end_pair pairs[], int *count, int most) {
    const vn_tie *ties = t->alive->ties.data;
    for (int32_t k = t->alive->first_tie.data[i]; k >= 0; k = ties[k].next) {
        for (int32_t j = ties[k].next; j >= 0 && *count < most; j = ties[j].next) {
            bool grew = (ties[k].state | ties[j].state) & VN_GREW;
            if (grew && is_end(t, i, &ties[k]) && is_end(t, i, &ties[j]) &&
                are_near(t, ties[k].node, ties[j].node) &&
                steps_between(t->network, ties[k].node, ties[j].node, WAY) > WAY) {
                pairs[(*count)++] = (end_pair){i, ties[k].node, ties[j].node};
            }
        }
    }
}

static vn_status consume_and_check(trial *t, const vn_consume_def *def, int32_t *consumed) {
    enum { MOST = 4000 };
    static end_pair pairs[MOST];
    int count = 0;
    vn_attractors *a = t->alive;
    VN_TRY(vn_attractors_sync(a, t->network, a->mode, def->distance));
    for (int32_t i = 0; i < a->first_tie.count; i++) {
        list_pairs_of(t, i, pairs, &count, MOST);
    }
    VN_TRY(vn_consume(a, t->network, def, consumed));
    for (int k = 0; k < count; k++) {
        if (vn_is_gone(a, pairs[k].source)) {
            t->pairs++;
            t->joined += steps_between(t->network, pairs[k].a, pairs[k].b, WAY) <= WAY;
        }
    }
    return VN_OK;
}

static vn_status step(trial *t) {
    int32_t added, first, consumed;
    vn_influence_def find = {.mode = t->influence, .within = t->within};
    vn_extend_def extend = {.length = t->length, .domain = t->domain, .meet = t->meet};
    vn_consume_def consume = {.distance = t->kill, .mode = t->consume, .into = t->eaten};
    int32_t before = vn_attractors_count(t->alive);
    VN_TRY(vn_influence_find(&t->found, t->alive, t->network, &find));
    VN_TRY(vn_extend(t->network, t->found, &extend, &added, &first));
    bool tagged = t->influence != VN_NEAREST && t->consume == VN_CONSUME_TAGGED;
    VN_TRY(tagged ? consume_and_check(t, &consume, &consumed)
                  : vn_consume(t->alive, t->network, &consume, &consumed));
    bool idle = added == 0 && vn_attractors_count(t->alive) == before;
    t->idle = idle ? t->idle + 1 : 0;
    t->longest = fmax(t->longest, t->length);
    return VN_OK;
}

static int patience(const trial *t) {
    return (int)ceil(2 * t->kill / t->length) + 40;
}

enum { EARLY_STEPS = 40 };

// What happens between two steps while the run is young.
static void change(trial *t) {
    if (t->steps >= EARLY_STEPS) {
        return;
    }
    t->length *= t->shrink;
    t->kill *= t->shrink;
    if (t->grow != 1) {
        assert_ok(vn_network_scale(t->network, t->grow));
        t->longest *= t->grow;
    }
    if (t->fickle && t->steps % 7 == 6) {
        t->influence = (int)whole(&t->rng, VN_NEAREST, VN_URQUHART);
        t->consume = (int)whole(&t->rng, VN_CONSUME_ANY, VN_CONSUME_TAGGED);
    }
}

// To the end, which must come; sources go on to appear for a while.
static void run(trial *t) {
    for (t->steps = 0; t->idle < patience(t); t->steps++) {
        assert_true(t->steps < 4000);
        for (int i = 0; i < 3 && t->thrown < t->sources; i++) {
            throw_one(t);
            t->idle = 0;
        }
        assert_ok(step(t));
        change(t);
    }
}

// --- what must hold ---------------------------------------------------------------------------------------

static vn_segment segment_between(const vn_network *network, int32_t a, int32_t b) {
    const double *x = vn_network_x(network), *y = vn_network_y(network);
    return (vn_segment){x[a], y[a], x[b], y[b]};
}

// Edges that share the node @p o, to @p a and @p b: whether one runs along the other.
static bool overlap(const vn_network *network, int32_t o, int32_t a, int32_t b) {
    const double *x = vn_network_x(network), *y = vn_network_y(network);
    double forward = (x[a] - x[o]) * (x[b] - x[o]) + (y[a] - y[o]) * (y[b] - y[o]);
    return a == b || (vn_turn(x[o], y[o], x[a], y[a], x[b], y[b]) == 0 && forward > 0);
}

static bool clash(const vn_network *network, const int32_t e[2], const int32_t f[2]) {
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) {
            if (e[i] == f[j]) {
                return overlap(network, e[i], e[!i], f[!j]);
            }
        }
    }
    vn_segment s = segment_between(network, e[0], e[1]), t = segment_between(network, f[0], f[1]);
    return vn_segments_touch(&s, &t);
}

static int count_clashes(const vn_network *network) {
    int32_t e[2], f[2], count = 0;
    for (int32_t i = 0; i < edge_count(network); i++) {
        for (int32_t j = 0; j < i && edge_of(network, i, &e[0], &e[1]); j++) {
            if (edge_of(network, j, &f[0], &f[1]) && clash(network, e, f)) {
                print_message("edges %d-%d and %d-%d clash\n", e[0], e[1], f[0], f[1]);
                count++;
            }
        }
    }
    return count;
}

static void check_sequence(const vn_network *network) {
    const int32_t *order;
    int32_t count = vn_network_count(network);
    bool *met = calloc((size_t)count + 1, 1);
    assert_ok(vn_network_order(network, &order));
    for (int32_t k = 0; k < count; k++) {
        int32_t node = order != NULL ? order[k] : k, parent = vn_network_parent(network)[node];
        assert_false(met[node]);
        assert_true(parent < 0 || met[parent]);
        met[node] = true;
    }
    free(met);
}

static double length_of(const vn_network *network, int32_t a, int32_t b) {
    double p[3], q[3];
    vn_network_position(network, a, p);
    vn_network_position(network, b, q);
    return sqrt(vn_distance2(p, q));
}

static void check_lengths(const trial *t) {
    int32_t a, b;
    for (int32_t e = 0; e < edge_count(t->network); e++) {
        if (edge_of(t->network, e, &a, &b) && length_of(t->network, a, b) > 2 * t->longest * (1 + 1e-6)) {
            fail_msg("seed %d: edge %d-%d is %g long", (int)t->seed, a, b, length_of(t->network, a, b));
        }
    }
}

static double nearest_node(const vn_network *network, const double p[3]) {
    double least2 = INFINITY;
    for (int32_t i = 0; i < vn_network_count(network); i++) {
        double q[3];
        vn_network_position(network, i, q);
        least2 = fmin(least2, vn_distance2(p, q));
    }
    return sqrt(least2);
}

// What was consumed had been reached; what lives is out of reach.
static void check_sources(const trial *t, double kill) {
    vn_retired retired = vn_attractors_retired(t->alive);
    int32_t eaten = vn_attractors_count(t->eaten), alive = vn_attractors_count(t->alive);
    assert_int_equal(eaten + alive + retired.hidden + retired.circled, t->thrown);
    for (int32_t i = 0; i < eaten; i++) {
        double p[3];
        assert_ok(vn_attractors_position(t->eaten, i, p));
        if (t->grow == 1 && !(nearest_node(t->network, p) < kill)) {
            fail_msg("seed %d: source %d was consumed, and never reached", (int)t->seed, i);
        }
    }
    for (int32_t i = 0; i < alive; i++) {
        double p[3];
        assert_ok(vn_attractors_position(t->alive, i, p));
        if (!(t->within > 0 && nearest_node(t->network, p) > t->within)) {
            fail_msg("seed %d: source %d lives on (%d steps)", (int)t->seed, i, t->steps);
        }
    }
}

// --- faces ------------------------------------------------------------------------------------------------

typedef struct ray {
    int32_t from, to;
    double angle;
} ray;

static int by_node_and_angle(const void *left, const void *right) {
    const ray *a = left, *b = right;
    if (a->from != b->from) {
        return a->from < b->from ? -1 : 1;
    }
    return (a->angle > b->angle) - (a->angle < b->angle);
}

static int list_rays(const vn_network *network, ray *rays) {
    const double *x = vn_network_x(network), *y = vn_network_y(network);
    int32_t ends[2];
    int count = 0;
    for (int32_t e = 0; e < edge_count(network); e++) {
        for (int k = 0; k < 2 && edge_of(network, e, &ends[0], &ends[1]); k++) {
            int32_t a = ends[k], b = ends[!k];
            rays[count++] = (ray){a, b, atan2(y[b] - y[a], x[b] - x[a])};
        }
    }
    qsort(rays, (size_t)count, sizeof *rays, by_node_and_angle);
    return count;
}

// After the ray r, the next one round the face on its left: at its far end, the one before the way back.
static int next_ray(const ray *rays, int count, int r) {
    int first = -1, last = -1, back = -1;
    for (int k = 0; k < count; k++) {
        if (rays[k].from == rays[r].to) {
            first = first < 0 ? k : first;
            last = k;
            back = rays[k].to == rays[r].from ? k : back;
        }
    }
    return back == first ? last : back - 1;
}

static int32_t leader(int32_t *to, int32_t i) {
    // NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): edges are between nodes there are
    while (to[i] != i) {
        i = to[i] = to[to[i]];
    }
    return i;
}

static int count_components(const vn_network *network, int *lone) {
    int32_t count = vn_network_count(network), a, b;
    int32_t *to = calloc((size_t)count + 1, sizeof *to);
    int components = count;
    assert_non_null(to);
    *lone = 0;
    for (int32_t i = 0; i < count; i++) {
        to[i] = i;
    }
    for (int32_t e = 0; e < edge_count(network); e++) {
        if (edge_of(network, e, &a, &b) && leader(to, a) != leader(to, b)) {
            to[leader(to, a)] = leader(to, b);
            components--;
        }
    }
    free(to);
    return components;
}

/// What tracing the faces says.
typedef struct faces {
    int walks, bounded;
    int small; ///< bounded ones of an area below a square of half a segment
    int triangles, quads;
} faces;

static faces trace_faces(const vn_network *network, double length) {
    const double *x = vn_network_x(network), *y = vn_network_y(network);
    ray *rays = malloc(2 * (size_t)edge_count(network) * sizeof *rays + 1);
    int count = list_rays(network, rays);
    bool *done = calloc((size_t)count + 1, 1);
    faces f = {0};
    for (int begin = 0; begin < count; begin++) {
        double area = 0;
        int sides = 0;
        for (int r = begin; !done[r]; r = next_ray(rays, count, r), sides++) {
            int32_t a = rays[r].from, b = rays[r].to;
            done[r] = true;
            area += 0.5 * (x[a] * y[b] - x[b] * y[a]);
        }
        f.walks += sides > 0;
        f.bounded += area > 1e-13 * length * length;
        f.triangles += area > 0 && sides == 3;
        f.quads += area > 0 && sides == 4;
        f.small += area > 1e-13 * length * length && area < 0.25 * length * length;
    }
    free(done);
    free(rays);
    return f;
}

// Euler: the graph is drawn in the plane when its faces are as many as this.
static faces check_faces(const trial *t) {
    int lone, edges = 0;
    int32_t a, b;
    int components = count_components(t->network, &lone);
    bool *has_edge = calloc((size_t)vn_network_count(t->network), 1);
    for (int32_t e = 0; e < edge_count(t->network); e++) {
        if (edge_of(t->network, e, &a, &b)) {
            edges++;
            has_edge[a] = has_edge[b] = true;
        }
    }
    for (int32_t i = 0; i < vn_network_count(t->network); i++) {
        lone += !has_edge[i];
    }
    free(has_edge);
    faces f = trace_faces(t->network, t->longest);
    int bounded = edges - vn_network_count(t->network) + components;
    if (f.walks + lone - components != bounded) {
        fail_msg("seed %d: %d walks, %d lone, %d components, %d expected", (int)t->seed, f.walks, lone,
                 components, bounded);
    }
    return f;
}

static const double kills[] = {0.3, 1, 1.2, 3, 10};

// A trial in one of several shapes, with the segment 1.
static trial trial_of(uint64_t seed) {
    vn_rng rng = vn_rng_make(seed);
    trial t = {.dim = 2, .influence = VN_RELATIVE, .consume = VN_CONSUME_TAGGED, .meet = VN_MEET_JOIN};
    t.seed = seed;
    t.length = t.shrink = t.grow = 1;
    t.low[0] = t.low[1] = -10;
    t.high[0] = t.high[1] = 10;
    t.kill = kills[seed % 5];
    t.sources = (int)whole(&rng, 2, 80);
    t.early = (int)whole(&rng, 1, t.sources);
    t.roots = (int)whole(&rng, 1, 4);
    if (seed % 4 == 1) {
        t.domain = disk_of(0, 0, 10);
    } else if (seed % 4 == 2) {
        t.domain = maple_shape();
        t.length = 0.5;
    } else if (seed % 4 == 3) {
        t.domain = comb_shape();
        t.length = 0.3;
        t.low[0] = t.low[1] = 0;
    }
    t.kill *= t.length;
    t.within = seed % 7 == 0 ? 6 * t.length : 0;
    t.influence = seed % 3 == 0 ? VN_URQUHART : VN_RELATIVE;
    return t;
}

static void check_pattern(const trial *t) {
    check_sequence(t->network);
    check_sources(t, t->kill);
    if (t->meet == VN_MEET_JOIN && t->dim == 2) {
        if (count_clashes(t->network) > 0) {
            fail_msg("seed %d: edges clash", (int)t->seed);
        }
        check_lengths(t);
    }
}

static void closed_runs_end_and_never_cross(void **state) {
    (void)state;
    faces all = {0};
    int pairs = 0, joined = 0;
    for (uint64_t seed = 0; seed < 1000; seed++) {
        trial t = trial_of(seed);
        begin(&t);
        run(&t);
        check_pattern(&t);
        faces f = check_faces(&t);
        all.bounded += f.bounded;
        all.small += f.small;
        pairs += t.pairs;
        joined += t.joined;
        end(&t);
    }
    assert_true(pairs > 1000);
    assert_true(joined > 0.98 * pairs); // the others have an edge in between
    assert_true(all.bounded > 1000);
    assert_true(all.small < 0.01 * all.bounded);
}

static void every_mode_ends(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 1600; seed++) {
        trial t = trial_of(seed);
        t.influence = (int)(seed / 3 % 3);
        t.consume = (int)(seed / 9 % 3);
        t.meet = seed % 2 == 0 ? VN_MEET_JOIN : VN_MEET_CROSS;
        t.fickle = seed % 5 < 2;
        begin(&t);
        run(&t);
        check_pattern(&t);
        end(&t);
    }
}

static void runs_whose_unit_shrinks_or_whose_nodes_move_end(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 400; seed++) {
        trial t = trial_of(seed);
        t.shrink = seed % 2 == 0 ? 0.99 : 1;
        t.grow = seed % 3 == 0 && t.domain == NULL ? 1.01 : 1;
        double kill = t.kill;
        begin(&t);
        run(&t);
        t.kill = kill;
        check_pattern(&t);
        end(&t);
    }
}

static void runs_in_space_end_and_close_loops(void **state) {
    (void)state;
    int joins = 0, pairs = 0, joined = 0;
    for (uint64_t seed = 0; seed < 100; seed++) {
        trial t = trial_of(4 * seed);
        t.dim = 3;
        t.within = 0;
        begin(&t);
        run(&t);
        check_pattern(&t);
        joins += vn_network_join_count(t.network);
        pairs += t.pairs;
        joined += t.joined;
        end(&t);
    }
    assert_true(joins > 100);
    assert_true(joined > 0.98 * pairs);
}

static uint64_t hash_of_run(uint64_t seed) {
    trial t = trial_of(seed);
    begin(&t);
    run(&t);
    uint64_t hash = network_hash(t.network);
    for (int32_t j = 0; j < vn_network_join_count(t.network); j++) {
        int32_t a, b;
        double radius;
        vn_network_join_ends(t.network, j, &a, &b, &radius);
        hash = vn_hash(hash, (uint64_t)a, (uint64_t)b, 0);
    }
    end(&t);
    return hash;
}

static void the_same_run_gives_the_same_bytes(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 60; seed++) {
        vn_set_threads(1);
        uint64_t once = hash_of_run(seed);
        assert_true(hash_of_run(seed) == once);
        vn_set_threads(2);
        assert_true(hash_of_run(seed) == once);
        vn_set_threads(0);
    }
}

// Nodes in another order, so that parents come after their children.
static vn_network *shuffled(const vn_network *from) {
    int32_t count = vn_network_count(from), *to = malloc((size_t)count * sizeof *to);
    int32_t *parent = malloc((size_t)count * sizeof *parent);
    double *x = malloc((size_t)count * sizeof *x), *y = malloc((size_t)count * sizeof *y);
    for (int32_t i = 0; i < count; i++) {
        to[i] = (int32_t)(((int64_t)i * 7919 + count / 2) % count);
    }
    assert_true(count % 7919 != 0);
    for (int32_t i = 0; i < count; i++) {
        int32_t above = vn_network_parent(from)[i];
        parent[to[i]] = above < 0 ? -1 : to[above];
        x[to[i]] = vn_network_x(from)[i];
        y[to[i]] = vn_network_y(from)[i];
    }
    vn_network_columns columns = {.dim = 2, .count = count, .x = x, .y = y, .parent = parent};
    vn_network *made = NULL;
    assert_ok(vn_network_from_columns(&made, &columns));
    for (int32_t j = 0; j < vn_network_join_count(from); j++) {
        int32_t a, b;
        double radius;
        vn_network_join_ends(from, j, &a, &b, &radius);
        assert_ok(vn_network_join(made, to[a], to[b], radius));
    }
    free(to);
    free(parent);
    free(x);
    free(y);
    return made;
}

static void a_network_whose_parents_come_late_goes_on(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 200; seed++) {
        trial t = trial_of(seed);
        t.sources /= 2;
        t.early = t.early < t.sources ? t.early : t.sources;
        begin(&t);
        run(&t);
        vn_network *other = shuffled(t.network);
        vn_network_destroy(t.network);
        t.network = other;
        t.sources += 30;
        t.idle = 0;
        run(&t);
        check_pattern(&t);
        check_faces(&t);
        end(&t);
    }
}

// Two sets, of different segments, take turns on one network; each eats its own.
static void two_sets_share_a_network(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 100; seed++) {
        trial t = trial_of(seed), u = trial_of(seed + 1000);
        begin(&t);
        begin(&u);
        vn_network *own = u.network;
        u.network = t.network;
        u.length = 0.2 * t.length;
        u.kill = t.kill;
        vn_domain_release(u.domain);
        u.domain = t.domain == NULL ? NULL : vn_domain_retain(t.domain);
        while (t.idle < patience(&t) || u.idle < patience(&u)) {
            assert_true(++t.steps < 8000);
            assert_ok(step(&t));
            assert_ok(step(&u));
        }
        t.sources = t.thrown;
        check_pattern(&t);
        u.network = own;
        end(&u);
        end(&t);
    }
}

// Sources that go on to another network draw there what new ones draw, whatever waited on the first.
static void sources_that_change_networks_start_anew(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 100; seed++) {
        trial t = trial_of(seed), u = trial_of(seed + 1000);
        t.influence = VN_RELATIVE;
        t.early = t.sources;
        begin(&t);
        for (int k = 0; k < 12; k++) {
            assert_ok(step(&t));
        }
        begin(&u);
        run(&u);
        vn_attractors *fresh = attractors_of(2, (int64_t)t.seed);
        for (int32_t i = 0; i < vn_attractors_count(t.alive); i++) {
            double p[3];
            assert_ok(vn_attractors_position(t.alive, i, p));
            assert_ok(vn_attractors_add(fresh, p));
        }
        vn_influence_def find = {.mode = t.influence};
        vn_influence *expected = NULL;
        assert_ok(vn_influence_find(&t.found, t.alive, u.network, &find));
        assert_ok(vn_influence_find(&expected, fresh, u.network, &find));
        assert_int_equal(vn_influence_count(t.found), vn_influence_count(expected));
        for (int32_t k = 0; k < vn_influence_count(expected); k++) {
            assert_int_equal(vn_influence_attractor(t.found, k), vn_influence_attractor(expected, k));
            assert_int_equal(vn_influence_node(t.found, k), vn_influence_node(expected, k));
        }
        vn_influence_destroy(expected);
        vn_attractors_destroy(fresh);
        end(&u);
        end(&t);
    }
}

// Memory runs out once, at every allocation in turn; then the run goes on to its end.
static void a_refused_allocation_spoils_nothing(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 24; seed++) {
        bool refused = true;
        for (int nth = 0; refused; nth += 1 + nth / 16) {
            trial t = trial_of(seed);
            t.early = t.sources;
            refused = false;
            begin(&t);
            vn_fail_allocations_from(nth);
            for (int k = 0; k < 30 && !refused; k++) {
                vn_status status = step(&t);
                assert_true(status == VN_OK || status == VN_NO_MEMORY);
                refused = status != VN_OK;
            }
            vn_fail_allocations_from(-1);
            check_sequence(t.network);
            run(&t);
            check_pattern(&t);
            end(&t);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(closed_runs_end_and_never_cross),
        counted_test(every_mode_ends),
        counted_test(runs_whose_unit_shrinks_or_whose_nodes_move_end),
        counted_test(runs_in_space_end_and_close_loops),
        counted_test(the_same_run_gives_the_same_bytes),
        counted_test(a_network_whose_parents_come_late_goes_on),
        counted_test(two_sets_share_a_network),
        counted_test(sources_that_change_networks_start_anew),
        counted_test(a_refused_allocation_spoils_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
