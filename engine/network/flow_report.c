// The audit: what can be said of flows and pressures, whoever found them. Nothing of the solver's is used.

#include "network/flow.h"
#include "network/leaf.h"
#include "network/sides.h"

static const double pi = 3.141592653589793;

// Less than this part of the inflow is rounding: it has no direction, and need not be conserved to its last
// digit.
#define ROUNDING 1e-12

typedef VN_ARRAY(double) number_array;

typedef struct audit {
    const vn_network *network;
    const vn_flow_def *def;
    const vn_flow_state *state;
    vn_flow_report *report;
    double entering; // Σ |flow| at the roots
    double span;     // of the pressures
    VN_ARRAY(vn_pipe) pipes;
    VN_ARRAY(uint8_t) degree;
    VN_ARRAY(int32_t) starts; // node v is met by spokes [starts[v], starts[v + 1])
    VN_ARRAY(int32_t) spokes; // pipes
    number_array list, murray, fitted;
    vn_sides sides; // of the node that is looked at
} audit;

static void free_audit(audit *a) {
    vn_array_free(&a->pipes);
    vn_array_free(&a->degree);
    vn_array_free(&a->starts);
    vn_array_free(&a->spokes);
    vn_array_free(&a->list);
    vn_array_free(&a->murray);
    vn_array_free(&a->fitted);
    vn_sides_free(&a->sides);
}

static void note_worst(vn_flow_worst *worst, double error, int32_t node, int32_t join) {
    bool first = worst->node < 0 && worst->join < 0;
    if (first || error > worst->error) {
        *worst = (vn_flow_worst){error, node, join};
    }
}

// ---- Pipes ----

static void find_scales(audit *a) {
    const double *pressure = a->state->pressure.data;
    double low = INFINITY, high = -INFINITY;
    for (int32_t i = 0; i < a->network->x.count; i++) {
        low = fmin(low, pressure[i]);
        high = fmax(high, pressure[i]);
        a->entering += a->network->parent.data[i] < 0 ? fabs(a->state->flow.data[i]) : 0;
        a->report->inflow += a->network->parent.data[i] < 0 ? a->state->flow.data[i] : 0;
    }
    a->span = high > low ? high - low : fmax(fabs(high), fabs(low));
    a->span = a->span > 0 ? a->span : 1;
}

static void note_pipe(audit *a, int32_t edge, const vn_pipe *pipe, double resistance) {
    vn_flow_report *report = a->report;
    const double *pressure = a->state->pressure.data;
    int32_t nodes = a->network->x.count;
    double flow = a->state->flow.data[edge], r = pipe->radius;
    double drop = pressure[pipe->a] - pressure[pipe->b] - resistance * flow;
    report->edge_shear[edge] = 4 * a->def->viscosity * fabs(flow) / (pi * r * r * r);
    report->volume += pi * r * r * pipe->length;
    report->power += resistance * flow * flow;
    note_worst(&report->drop, fabs(drop) / a->span, edge < nodes ? edge : -1,
               edge < nodes ? -1 : edge - nodes);
}

static vn_status look_at_pipes(audit *a) {
    int32_t count = vn_pipe_count(a->network);
    VN_TRY(vn_array_reserve(&a->list, count));
    VN_TRY(vn_array_zero(&a->pipes, count));
    for (int32_t e = 0; e < count; e++) {
        double resistance;
        vn_pipe *pipe = &a->pipes.data[e];
        if (!vn_pipe_get(a->network, e, pipe)) {
            continue;
        }
        VN_TRY(vn_pipe_resistance(a->network, e, pipe, a->def->viscosity, &resistance));
        note_pipe(a, e, pipe, resistance);
        a->list.data[a->list.count++] = a->report->edge_shear[e];
    }
    double inflow2 = a->report->inflow * a->report->inflow;
    a->report->resistance = inflow2 > 0 ? a->report->power / inflow2 : 0;
    return vn_statistics_of(&a->report->wall_shear, a->list.data, a->list.count);
}

// ---- Terminals ----

static vn_status list_terminals(audit *a) {
    vn_flow_report *report = a->report;
    int32_t count = 0;
    VN_TRY(vn_array_zero(&a->degree, a->network->x.count));
    vn_flow_degrees(a->network, a->degree.data);
    for (int32_t i = 0; i < a->network->x.count; i++) {
        count += vn_is_terminal(a->network, a->degree.data, i);
    }
    size_t size = (size_t)count * sizeof *report->terminals;
    report->terminals = count > 0 ? vn_new_block(size) : NULL;
    if (count > 0 && report->terminals == NULL) {
        return vn_fail_memory("a list of terminals", size);
    }
    report->terminal_count = count;
    int32_t k = 0;
    for (int32_t i = 0; i < a->network->x.count; i++) {
        if (vn_is_terminal(a->network, a->degree.data, i)) {
            // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): as many as were counted
            report->terminals[k++] = (vn_terminal){i, a->state->pressure.data[i], a->state->flow.data[i]};
        }
    }
    return VN_OK;
}

// A terminal's one edge may be a join only where it is a root: its own edge tells what leaves.
static vn_status look_at_terminals(audit *a) {
    vn_flow_report *report = a->report;
    double out = a->def->pressure_out, scale = fabs(out > 0 || out < 0 ? out : a->def->pressure_in);
    VN_TRY(vn_array_reserve(&a->list, report->terminal_count));
    a->list.count = report->terminal_count;
    for (int32_t k = 0; k < report->terminal_count; k++) {
        const vn_terminal *terminal = &report->terminals[k];
        a->list.data[k] = terminal->pressure;
        report->outflow += terminal->flow;
        note_worst(&report->terminal, fabs(terminal->pressure - out) / (scale > 0 ? scale : 1),
                   terminal->node, -1);
    }
    VN_TRY(vn_statistics_of(&report->terminal_pressure, a->list.data, a->list.count));
    for (int32_t k = 0; k < report->terminal_count; k++) {
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): room for every terminal
        a->list.data[k] = report->terminals[k].flow;
    }
    return vn_statistics_of(&report->terminal_flow, a->list.data, a->list.count);
}

// ---- Nodes ----

static vn_status link_spokes(audit *a) {
    int32_t nodes = a->network->x.count, edges = vn_pipe_count(a->network);
    VN_TRY(vn_array_zero(&a->starts, (int64_t)nodes + 1));
    VN_TRY(vn_array_zero(&a->spokes, 2 * (int64_t)edges));
    for (int32_t e = 0; e < edges; e++) {
        const vn_pipe *pipe = &a->pipes.data[e];
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): filled for every edge
        if (pipe->radius > 0) { // not a root's
            a->starts.data[pipe->a]++;
            a->starts.data[pipe->b]++;
        }
    }
    for (int32_t v = 0; v < nodes; v++) {
        a->starts.data[v + 1] += a->starts.data[v];
    }
    for (int32_t e = edges - 1; e >= 0; e--) { // from behind, so that starts[v] ends as the first
        const vn_pipe *pipe = &a->pipes.data[e];
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): filled for every edge
        if (pipe->radius > 0) {
            a->spokes.data[--a->starts.data[pipe->a]] = e;
            a->spokes.data[--a->starts.data[pipe->b]] = e;
        }
    }
    return VN_OK;
}

// Into node @p v.
static double flow_into(const audit *a, int32_t v, int32_t edge) {
    double flow = a->state->flow.data[edge];
    return a->pipes.data[edge].b == v ? flow : -flow;
}

static void check_conservation(audit *a, int32_t v) {
    double into = 0, passing = 0;
    if (a->network->parent.data[v] < 0) {
        into = a->state->flow.data[v];
        passing = fabs(into);
    }
    for (int32_t k = a->starts.data[v]; k < a->starts.data[v + 1]; k++) {
        double flow = flow_into(a, v, a->spokes.data[k]);
        into += flow;
        passing += fabs(flow);
    }
    passing = fmax(passing / 2, ROUNDING * a->entering);
    note_worst(&a->report->conservation, passing > 0 ? fabs(into) / passing : 0, v, -1);
}

static bool carries(const audit *a, double flow) {
    return fabs(flow) > ROUNDING * a->entering;
}

static vn_status find_sides(audit *a, int32_t v) {
    a->sides.in.count = a->sides.out.count = 0;
    for (int32_t k = a->starts.data[v]; k < a->starts.data[v + 1]; k++) {
        int32_t e = a->spokes.data[k];
        double flow = flow_into(a, v, e), radius = a->pipes.data[e].radius;
        if (carries(a, flow)) {
            VN_TRY(flow > 0 ? vn_array_push(&a->sides.in, radius) : vn_array_push(&a->sides.out, radius));
        }
    }
    return VN_OK;
}

static vn_status look_at_node(audit *a, int32_t v) {
    if (!vn_is_terminal(a->network, a->degree.data, v)) {
        check_conservation(a, v);
    }
    VN_TRY(find_sides(a, v));
    if (!vn_sides_meet(&a->sides)) {
        return VN_OK;
    }
    double exponent;
    VN_TRY(vn_array_push(&a->murray, vn_sides_residual(&a->sides, a->def->exponent)));
    return vn_sides_fit(&a->sides, &exponent) ? vn_array_push(&a->fitted, exponent) : VN_OK;
}

static vn_status look_at_nodes(audit *a) {
    VN_TRY(link_spokes(a));
    for (int32_t v = 0; v < a->network->x.count; v++) {
        VN_TRY(look_at_node(a, v));
    }
    VN_TRY(vn_statistics_of(&a->report->murray, a->murray.data, a->murray.count));
    return vn_statistics_of(&a->report->fitted, a->fitted.data, a->fitted.count);
}

// ---- All ----

static vn_status describe(audit *a) {
    vn_flow_report *report = a->report;
    int32_t count = vn_pipe_count(a->network);
    report->edge_shear = count > 0 ? vn_new_block((size_t)count * sizeof *report->edge_shear) : NULL;
    if (count > 0 && report->edge_shear == NULL) {
        return vn_fail_memory("wall shear stresses", (size_t)count * sizeof *report->edge_shear);
    }
    report->edge_count = count;
    find_scales(a);
    VN_TRY(look_at_pipes(a));
    VN_TRY(list_terminals(a));
    VN_TRY(look_at_terminals(a));
    return look_at_nodes(a);
}

vn_status vn_flow_describe(vn_flow_report *report, const vn_network *network, const vn_flow_def *def,
                           const vn_flow_state *state) {
    const vn_flow_worst none = {0, -1, -1};
    *report = (vn_flow_report){.conservation = none, .drop = none, .terminal = none};
    audit a = {.network = network, .def = def, .state = state, .report = report};
    vn_status status = describe(&a);
    free_audit(&a);
    if (status != VN_OK) {
        vn_flow_report_free(report);
    }
    return status;
}

void vn_flow_report_free(vn_flow_report *report) {
    vn_terminal *terminals = report->terminals;
    double *shear = report->edge_shear;
    vn_resize(terminals, terminals != NULL ? (size_t)report->terminal_count * sizeof *terminals : 0, 0);
    vn_resize(shear, shear != NULL ? (size_t)report->edge_count * sizeof *shear : 0, 0);
    *report = (vn_flow_report){0};
}
