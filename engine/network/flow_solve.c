// Poiseuille's law on a network. Edges without a length make their ends one place; of the places, those with
// one edge left are peeled off one by one into what they ask of their neighbour, which leaves roots and what
// lies on loops between them. That core is a sparse system; from its pressures the peeled places get theirs.
//
// Where only terminals hang from what is peeled, all terms of a sum have one sign: no digit is lost, however
// far apart conductances are. In the core a flow is the difference of two large pressures, and would be
// rounding where a wide edge follows a narrow one; so pressures are refined to twice the digits of a double.
// (Adding up the flows of the corrections instead conserves them as well, but leaves rounding going round
// loops of wide edges, where no node shows it.)

#include "network/flow.h"
#include "network/sparse.h"

enum { ROOT = 1, TERMINAL = 2 };

typedef struct place {
    double ground;  // conductance to the terminals behind what was peeled off here
    double sink;    // what that takes whatever the pressure
    double head;    // pressure above the solver's base
    int32_t degree; // edges that are left
    int32_t edges;  // their numbers, one xor the other: where one is left, its own
    uint8_t holds;  // ROOT, TERMINAL
    bool fixed;     // its head is given
} place;

typedef VN_ARRAY(int32_t) index_array;

typedef struct solver {
    const vn_network *network;
    const vn_flow_def *def;
    vn_flow_state *state;
    bool roots_fixed, terminals_fixed;
    double base;            // pressure
    double source, sink;    // what each root lets in, and what each terminal takes, where these are given
    int32_t terminals;      // how many
    bool merged;            // there are edges without a length
    VN_ARRAY(uint8_t) kind; // of each node: ROOT, TERMINAL or 0
    /// Of each pipe. 0: its ends are one place; INFINITY: a root's, or one that closes a circle within a
    /// place
    VN_ARRAY(double) resistance;
    index_array seat;       // the lowest node at each node's place
    VN_ARRAY(place) places; // by seat
    index_array peeled;     // seats in the order in which they went
    index_array part;       // of each tree: the lowest tree that it is joined to
    VN_ARRAY(bool) drained; // of each part: it has a terminal
} solver;

static void free_solver(solver *s) {
    vn_array_free(&s->kind);
    vn_array_free(&s->resistance);
    vn_array_free(&s->seat);
    vn_array_free(&s->places);
    vn_array_free(&s->peeled);
    vn_array_free(&s->part);
    vn_array_free(&s->drained);
}

// Ends as they were given; false at a root.
static bool ends_of(const solver *s, int32_t edge, int32_t *a, int32_t *b) {
    int32_t nodes = s->network->x.count;
    *a = edge < nodes ? s->network->parent.data[edge] : s->network->joins.data[edge - nodes].a;
    *b = edge < nodes ? edge : s->network->joins.data[edge - nodes].b;
    return *a >= 0;
}

// The places that an edge leads between; false when it leads nowhere else.
static bool places_of(const solver *s, int32_t edge, int32_t *a, int32_t *b) {
    if (!ends_of(s, edge, a, b)) {
        return false;
    }
    *a = s->seat.data[*a];
    *b = s->seat.data[*b];
    return *a != *b;
}

static int32_t other_place(const solver *s, int32_t edge, int32_t from) {
    int32_t a, b;
    places_of(s, edge, &a, &b);
    return a == from ? b : a;
}

// Disjoint sets, each with its lowest member on top.
static int32_t top_of(int32_t *sets, int32_t i) {
    while (sets[i] != i) {
        sets[i] = sets[sets[i]];
        i = sets[i];
    }
    return i;
}

static bool unite(int32_t *sets, int32_t a, int32_t b) {
    a = top_of(sets, a);
    b = top_of(sets, b);
    sets[a > b ? a : b] = a < b ? a : b;
    return a != b;
}

static vn_status start_sets(index_array *sets, int32_t count) {
    VN_TRY(vn_array_zero(sets, count));
    for (int32_t i = 0; i < count; i++) {
        sets->data[i] = i;
    }
    return VN_OK;
}

// ---- What is asked ----

static vn_status check_request(const vn_flow_def *def) {
    VN_TRY(vn_check_def(&vn_flow_schema, def));
    if (def->inflow > 0 && def->terminal_flow > 0) {
        return vn_fail(VN_INVALID,
                       "flow: inflow = %g and terminal_flow = %g are both given; give one, the other follows "
                       "from it",
                       def->inflow, def->terminal_flow);
    }
    if (def->share == VN_SHARE_TERMINALS && !(def->inflow > 0)) {
        return vn_fail(VN_INVALID, "flow: share = \"terminals\" needs an inflow that they share");
    }
    return VN_OK;
}

static vn_status check_pressures(const vn_flow_def *def) {
    if (!(def->pressure_in > def->pressure_out)) {
        return vn_fail(VN_INVALID,
                       "flow: pressure_in = %g Pa must be above pressure_out = %g Pa for anything to flow",
                       def->pressure_in, def->pressure_out);
    }
    return VN_OK;
}

static vn_status find_kinds(solver *s) {
    const vn_network *network = s->network;
    VN_TRY(vn_array_zero(&s->kind, network->x.count));
    vn_flow_degrees(network, s->kind.data);
    for (int32_t i = 0; i < network->x.count; i++) {
        bool terminal = vn_is_terminal(network, s->kind.data, i);
        s->kind.data[i] = network->parent.data[i] < 0 ? ROOT : terminal ? TERMINAL : 0;
        s->terminals += terminal;
    }
    return VN_OK;
}

static vn_status set_boundary(solver *s) {
    const vn_flow_def *def = s->def;
    bool by_roots = def->inflow > 0 && def->share == VN_SHARE_ROOTS;
    bool by_terminals = def->terminal_flow > 0 || def->share == VN_SHARE_TERMINALS;
    s->roots_fixed = !by_roots;
    s->terminals_fixed = !by_terminals;
    if (by_roots) {
        s->source = def->inflow / s->network->roots;
    }
    if (by_terminals && s->terminals > 0) {
        s->sink = def->terminal_flow > 0 ? def->terminal_flow : def->inflow / s->terminals;
    }
    if (by_terminals && s->terminals == 0) {
        return vn_fail(VN_INVALID, "flow: the network has no terminal to take any flow (a node other than a "
                                   "root, with a single edge)");
    }
    s->base = s->terminals_fixed ? def->pressure_out : def->pressure_in;
    return s->roots_fixed && s->terminals_fixed ? check_pressures(def) : VN_OK;
}

// Trees that joins connect are one part. What enters a part without a terminal can leave nowhere.
static vn_status find_parts(solver *s) {
    const vn_network *network = s->network;
    const int32_t *tree = network->tree.data;
    VN_TRY(start_sets(&s->part, network->roots));
    VN_TRY(vn_array_zero(&s->drained, network->roots));
    for (int32_t j = 0; j < network->joins.count; j++) {
        unite(s->part.data, tree[network->joins.data[j].a], tree[network->joins.data[j].b]);
    }
    for (int32_t i = 0; i < network->x.count; i++) {
        s->drained.data[top_of(s->part.data, tree[i])] |= s->kind.data[i] == TERMINAL;
    }
    for (int32_t i = 0; i < network->x.count && !s->roots_fixed; i++) {
        if (s->kind.data[i] == ROOT && !s->drained.data[top_of(s->part.data, tree[i])]) {
            return vn_fail(VN_INVALID,
                           "flow: what enters at root %d can leave nowhere, as no terminal hangs from it: "
                           "leave inflow out, or remove this root",
                           i);
        }
    }
    return VN_OK;
}

// ---- Places ----

static vn_status measure_pipes(solver *s) {
    int32_t count = vn_pipe_count(s->network);
    VN_TRY(vn_array_reserve(&s->resistance, count));
    VN_TRY(start_sets(&s->seat, s->network->x.count));
    for (int32_t e = 0; e < count; e++) {
        vn_pipe pipe;
        double *resistance = &s->resistance.data[e];
        *resistance = INFINITY;
        if (!vn_pipe_get(s->network, e, &pipe)) {
            continue;
        }
        VN_TRY(vn_pipe_resistance(s->network, e, &pipe, s->def->viscosity, resistance));
        if (*resistance == 0) {
            s->merged = true;
            *resistance = unite(s->seat.data, pipe.a, pipe.b) ? 0 : INFINITY;
        }
    }
    for (int32_t i = 0; i < s->network->x.count; i++) {
        s->seat.data[i] = s->seat.data[s->seat.data[i]]; // seats are lower: theirs are settled
    }
    return VN_OK;
}

static bool is_fixed(const solver *s, int32_t node) {
    uint8_t kind = s->kind.data[node];
    return (kind == ROOT && s->roots_fixed) || (kind == TERMINAL && s->terminals_fixed);
}

static vn_status fill_place(solver *s, int32_t node) {
    place *p = &s->places.data[s->seat.data[node]];
    uint8_t kind = s->kind.data[node];
    p->holds |= kind;
    p->sink += kind == TERMINAL ? s->sink : kind == ROOT ? -s->source : 0;
    if (is_fixed(s, node)) {
        double pressure = kind == ROOT ? s->def->pressure_in : s->def->pressure_out;
        p->head = pressure - s->base;
        p->fixed = true;
    }
    if (p->holds == (ROOT | TERMINAL) && s->roots_fixed && s->terminals_fixed) {
        return vn_fail(VN_INVALID,
                       "flow: node %d, a %s, is at the same place as a %s, with only edges without a length "
                       "between them: the flow has no limit; move it, or remove such edges",
                       node, kind == ROOT ? "root" : "terminal", kind == ROOT ? "terminal" : "root");
    }
    return VN_OK;
}

static void link_places(solver *s) {
    for (int32_t e = 0; e < vn_pipe_count(s->network); e++) {
        int32_t ends[2];
        if (places_of(s, e, &ends[0], &ends[1])) {
            for (int k = 0; k < 2; k++) {
                s->places.data[ends[k]].degree++;
                s->places.data[ends[k]].edges ^= e;
            }
        }
    }
}

static vn_status make_places(solver *s) {
    VN_TRY(vn_array_zero(&s->places, s->network->x.count));
    for (int32_t i = 0; i < s->network->x.count; i++) {
        VN_TRY(fill_place(s, i));
    }
    link_places(s);
    return VN_OK;
}

// ---- Peeling ----

// Take off a place with one edge; its neighbour. A terminal's head is 0 by now, so it is all ground.
static int32_t peel_one(solver *s, int32_t v) {
    place *p = &s->places.data[v];
    int32_t e = p->edges, u = other_place(s, e, v);
    place *q = &s->places.data[u];
    double resistance = s->resistance.data[e], loss = 1 + p->ground * resistance;
    q->ground += p->fixed ? 1 / resistance : p->ground / loss;
    q->sink += p->fixed ? 0 : p->sink / loss;
    q->degree--;
    q->edges ^= e;
    p->degree = 0;
    s->peeled.data[s->peeled.count++] = v;
    return u;
}

// Roots stay: so every part keeps a place, and what is peeled has only terminals behind it.
static vn_status peel(solver *s) {
    VN_TRY(vn_array_reserve(&s->peeled, s->network->x.count));
    for (int32_t i = s->network->x.count - 1; i >= 0; i--) {
        int32_t v = i;
        while (s->places.data[v].degree == 1 && !(s->places.data[v].holds & ROOT)) {
            v = peel_one(s, v);
        }
    }
    return VN_OK;
}

static void unpeel(solver *s) {
    for (int32_t k = s->peeled.count - 1; k >= 0; k--) {
        int32_t v = s->peeled.data[k];
        place *p = &s->places.data[v];
        int32_t e = p->edges, a, b;
        places_of(s, e, &a, &b);
        double head = s->places.data[a == v ? b : a].head, resistance = s->resistance.data[e];
        double loss = 1 + p->ground * resistance;
        double flow = p->fixed ? head / resistance : (p->ground * head + p->sink) / loss;
        p->head = p->fixed ? p->head : (head - resistance * p->sink) / loss;
        s->state->flow.data[e] = b == v ? flow : -flow;
    }
}

// What is left with no edge: roots of trees, whole in themselves.
static void settle_roots(solver *s) {
    for (int32_t v = 0; v < s->network->x.count; v++) {
        place *p = &s->places.data[v];
        if (p->holds & ROOT && p->degree == 0 && !p->fixed) {
            p->head = -p->sink / p->ground;
        }
    }
}

// ---- The core ----

typedef struct core {
    solver *s;
    index_array unknown; // seats
    index_array number;  // of each seat among them, or -1
    index_array edges;
    VN_ARRAY(double) residual;
    VN_ARRAY(double) passing; // at each unknown
    VN_ARRAY(double) low;     // what its head lacks, below the last digit
    VN_ARRAY(vn_sparse_entry) entries;
    double least, most; // conductances
    vn_sparse *factor;
} core;

static void free_core(core *c) {
    vn_array_free(&c->unknown);
    vn_array_free(&c->number);
    vn_array_free(&c->edges);
    vn_array_free(&c->residual);
    vn_array_free(&c->passing);
    vn_array_free(&c->low);
    vn_array_free(&c->entries);
    vn_sparse_destroy(c->factor);
}

// In a part without a terminal nothing moves; its pressures are known, and its matrix would be singular but
// for the roots.
static void still_water(solver *s, int32_t v) {
    place *p = &s->places.data[v];
    if (!p->fixed && !s->drained.data[top_of(s->part.data, s->network->tree.data[v])]) {
        p->fixed = true;
        p->head = s->def->pressure_in - s->base;
    }
}

static vn_status list_unknowns(core *c) {
    solver *s = c->s;
    VN_TRY(vn_array_zero(&c->number, s->network->x.count));
    for (int32_t v = 0; v < s->network->x.count; v++) {
        c->number.data[v] = -1;
        if (s->places.data[v].degree > 0) {
            still_water(s, v);
        }
        if (s->places.data[v].degree > 0 && !s->places.data[v].fixed) {
            c->number.data[v] = c->unknown.count;
            VN_TRY(vn_array_push(&c->unknown, v));
        }
    }
    return VN_OK;
}

static vn_status list_edges(core *c) {
    solver *s = c->s;
    for (int32_t e = 0; e < vn_pipe_count(s->network); e++) {
        int32_t a, b;
        if (places_of(s, e, &a, &b) && s->places.data[a].degree > 0 && s->places.data[b].degree > 0) {
            VN_TRY(vn_array_push(&c->edges, e));
        }
    }
    return VN_OK;
}

// Up to 24 decades, trials against 113-bit numbers were right to 1e-12 or did not converge; from 32 on some
// were wrong and looked right.
#define WIDEST 1e24

static vn_status fail_range(const core *c) {
    return vn_fail(VN_INFEASIBLE,
                   "flow: where joins close loops, conductances from %g to %g are too far apart for doubles; "
                   "is a radius or a length there far off?",
                   c->least, c->most);
}

static vn_status fill_matrix(core *c) {
    solver *s = c->s;
    c->least = INFINITY;
    VN_TRY(vn_array_reserve(&c->entries, (int64_t)c->unknown.count + c->edges.count));
    for (int32_t k = 0; k < c->unknown.count; k++) {
        c->entries.data[k] = (vn_sparse_entry){k, k, s->places.data[c->unknown.data[k]].ground};
    }
    c->entries.count = c->unknown.count;
    for (int32_t k = 0; k < c->edges.count; k++) {
        int32_t e = c->edges.data[k], a, b;
        places_of(s, e, &a, &b);
        double conductance = 1 / s->resistance.data[e];
        c->least = fmin(c->least, conductance);
        c->most = fmax(c->most, conductance);
        a = c->number.data[a];
        b = c->number.data[b];
        if (a >= 0) {
            c->entries.data[a].value += conductance;
        }
        if (b >= 0) {
            c->entries.data[b].value += conductance;
        }
        if (a >= 0 && b >= 0) {
            vn_sparse_entry entry = {a > b ? a : b, a > b ? b : a, -conductance};
            c->entries.data[c->entries.count++] = entry;
        }
    }
    return c->most <= WIDEST * c->least ? VN_OK : fail_range(c);
}

static double low_of(const core *c, int32_t seat) {
    int32_t number = c->number.data[seat];
    return number >= 0 ? c->low.data[number] : 0;
}

static void find_flows(core *c) {
    solver *s = c->s;
    for (int32_t k = 0; k < c->edges.count; k++) {
        int32_t e = c->edges.data[k], a, b;
        places_of(s, e, &a, &b);
        double high = s->places.data[a].head - s->places.data[b].head;
        s->state->flow.data[e] = (high + (low_of(c, a) - low_of(c, b))) / s->resistance.data[e];
    }
}

// Knuth's sum of two: head + low grows by @p step, and what head's rounding loses stays in low.
static void add_to_head(double *head, double *low, double step) {
    double sum = *head + step, part = sum - *head;
    *low += (*head - (sum - part)) + (step - part);
    *head = sum + *low;
    *low -= *head - sum;
}

// What is left at each unknown; the largest by what passes there.
static double find_residuals(core *c) {
    solver *s = c->s;
    double most = 0, worst = 0;
    for (int32_t k = 0; k < c->unknown.count; k++) {
        const place *p = &s->places.data[c->unknown.data[k]];
        c->residual.data[k] = -(p->ground * p->head + p->sink);
        c->passing.data[k] = fabs(c->residual.data[k]);
    }
    for (int32_t k = 0; k < c->edges.count; k++) {
        int32_t e = c->edges.data[k], a, b;
        double flow = s->state->flow.data[e];
        places_of(s, e, &a, &b);
        a = c->number.data[a];
        b = c->number.data[b];
        if (a >= 0) {
            c->residual.data[a] -= flow;
            c->passing.data[a] += fabs(flow);
        }
        if (b >= 0) {
            c->residual.data[b] += flow;
            c->passing.data[b] += fabs(flow);
        }
    }
    for (int32_t k = 0; k < c->unknown.count; k++) {
        most = fmax(most, c->passing.data[k]);
    }
    for (int32_t k = 0; k < c->unknown.count && most > 0; k++) {
        double error = 2 * fabs(c->residual.data[k]) / fmax(c->passing.data[k], 1e-12 * most);
        worst = error <= worst || isnan(worst) ? worst : error;
    }
    return worst >= 0 && worst <= VN_HUGE ? worst : INFINITY;
}

// The first round solves from nothing, the others refine.
static vn_status refine(core *c) {
    enum { ROUNDS = 40 };
    solver *s = c->s;
    double before = INFINITY, worst = INFINITY;
    for (int round = 0; round < ROUNDS; round++) {
        VN_TRY(vn_poll());
        worst = find_residuals(c);
        if (worst <= 1e-15 || (worst <= 1e-12 && worst > before / 2)) {
            break;
        }
        before = worst;
        VN_TRY(vn_sparse_solve(c->factor, c->residual.data, c->residual.data));
        for (int32_t k = 0; k < c->unknown.count; k++) {
            add_to_head(&s->places.data[c->unknown.data[k]].head, &c->low.data[k], c->residual.data[k]);
        }
        find_flows(c);
    }
    return worst <= 1e-9 ? VN_OK : fail_range(c);
}

static vn_status solve_core_in(core *c) {
    VN_TRY(list_unknowns(c));
    VN_TRY(list_edges(c));
    int32_t count = c->unknown.count;
    VN_TRY(vn_array_zero(&c->residual, count));
    VN_TRY(vn_array_zero(&c->passing, count));
    VN_TRY(vn_array_zero(&c->low, count));
    find_flows(c);
    if (count == 0) {
        return VN_OK;
    }
    VN_TRY(fill_matrix(c));
    VN_TRY(vn_poll());
    vn_status status = vn_sparse_factor(&c->factor, count, c->entries.data, c->entries.count);
    vn_array_free(&c->entries);
    return status == VN_OK ? refine(c) : status == VN_INFEASIBLE ? fail_range(c) : status;
}

static vn_status solve_core(solver *s) {
    core c = {.s = s};
    bool whole = true;
    for (int32_t v = 0; v < s->network->x.count && whole; v++) {
        whole = s->places.data[v].degree == 0;
    }
    vn_status status = whole ? VN_OK : solve_core_in(&c);
    free_core(&c);
    return status;
}

// ---- Edges without a length ----

typedef struct corner {
    double excess;         // what comes to a node by other edges and must go on
    double left;           // of a place: what its nodes have too much
    int32_t fixed;         // of a place: nodes that take it
    int32_t degree, edges; // as in places, of edges without a length
} corner;

static void find_excess(solver *s, corner *corners) {
    for (int32_t e = 0; e < vn_pipe_count(s->network); e++) {
        int32_t a, b;
        if (!ends_of(s, e, &a, &b)) {
            continue;
        }
        double flow = s->state->flow.data[e];
        bool open = s->resistance.data[e] == 0;
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): a corner for every node
        corners[a].excess -= flow;
        corners[b].excess += flow;
        corners[a].degree += open;
        corners[b].degree += open;
        corners[a].edges ^= open ? e : 0;
        corners[b].edges ^= open ? e : 0;
    }
    for (int32_t i = 0; i < s->network->x.count; i++) {
        uint8_t kind = s->kind.data[i];
        corners[i].excess += kind == ROOT ? s->source : kind == TERMINAL ? -s->sink : 0;
        corners[s->seat.data[i]].left += corners[i].excess;
        corners[s->seat.data[i]].fixed += is_fixed(s, i);
    }
}

// Nodes of given pressure at one place share what leaves there equally. The edges that made nodes one place
// are a tree of it, and carry what is left.
static vn_status share_out(solver *s) {
    VN_ARRAY(corner) corners = {0};
    int32_t count = s->network->x.count;
    VN_TRY(vn_array_zero(&corners, count));
    find_excess(s, corners.data);
    for (int32_t i = 0; i < count; i++) {
        const corner *whole = &corners.data[s->seat.data[i]];
        corners.data[i].excess -= is_fixed(s, i) ? whole->left / whole->fixed : 0;
    }
    for (int32_t i = count - 1; i >= 0; i--) {
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): a corner for every node
        for (int32_t v = i; corners.data[v].degree == 1;) {
            corner *from = &corners.data[v];
            int32_t e = from->edges, a, b;
            ends_of(s, e, &a, &b);
            int32_t u = a == v ? b : a;
            s->state->flow.data[e] = a == v ? from->excess : -from->excess;
            corners.data[u].excess += from->excess;
            corners.data[u].degree--;
            corners.data[u].edges ^= e;
            from->degree = 0;
            v = u;
        }
    }
    vn_array_free(&corners);
    return VN_OK;
}

// ---- The result ----

static void find_entering(solver *s) {
    double *flow = s->state->flow.data;
    for (int32_t e = 0; e < vn_pipe_count(s->network); e++) {
        int32_t a, b;
        if (ends_of(s, e, &a, &b)) {
            flow[a] += s->kind.data[a] == ROOT ? flow[e] : 0;
            flow[b] -= s->kind.data[b] == ROOT ? flow[e] : 0;
        }
    }
    for (int32_t i = 0; i < s->network->x.count && !s->roots_fixed; i++) {
        flow[i] = s->kind.data[i] == ROOT ? s->source : flow[i];
    }
}

static void find_pressures(solver *s) {
    for (int32_t i = 0; i < s->network->x.count; i++) {
        const place *p = &s->places.data[s->seat.data[i]];
        double pressure = s->base + p->head;
        pressure = p->holds & ROOT && s->roots_fixed ? s->def->pressure_in : pressure;
        s->state->pressure.data[i] = pressure;
    }
}

static vn_status solve(solver *s) {
    VN_TRY(find_kinds(s));
    VN_TRY(set_boundary(s));
    VN_TRY(find_parts(s));
    VN_TRY(measure_pipes(s));
    VN_TRY(make_places(s));
    VN_TRY(vn_array_zero(&s->state->flow, vn_pipe_count(s->network)));
    VN_TRY(vn_array_zero(&s->state->pressure, s->network->x.count));
    VN_TRY(peel(s));
    VN_TRY(vn_poll());
    settle_roots(s);
    VN_TRY(solve_core(s));
    unpeel(s);
    VN_TRY(s->merged ? share_out(s) : VN_OK);
    find_entering(s);
    find_pressures(s);
    return VN_OK;
}

vn_status vn_flow_solve(vn_flow_state *state, const vn_network *network, const vn_flow_def *def) {
    solver s = {.network = network, .def = def, .state = state};
    VN_TRY(check_request(def));
    VN_TRY(vn_flow_check_network(network));
    vn_status status = network->x.count > 0 ? solve(&s) : VN_OK;
    free_solver(&s);
    return status;
}
