// What flows through a network, and at which pressure.
#include "network/flow.h"

static const vn_flow_def flow_default = {
    .viscosity = 3.6e-3, .pressure_in = 13332.2, .pressure_out = 7999.32, .exponent = 3};

// Far beyond everything that flows, and near enough for products of such numbers.
#define MOST 1e30

static const vn_field flow_fields[] = {
    {"solve", VN_MIXED, 0, 0, 0, 0, "", "true or false",
     "false: leave flows and pressures as they are, and check them; left out: find them first"},
    {"viscosity", VN_F64, VN_ABOVE_MIN, offsetof(vn_flow_def, viscosity), 0, MOST, "Pa s", NULL,
     "of what flows: 3.6 cP is blood's"},
    {"pressure_in", VN_F64, 0, offsetof(vn_flow_def, pressure_in), -MOST, MOST, "Pa", NULL,
     "at every root: 13332.2 Pa is 100 mmHg"},
    {"pressure_out", VN_F64, 0, offsetof(vn_flow_def, pressure_out), -MOST, MOST, "Pa", NULL,
     "at every terminal, a node other than a root with a single edge: 7999.32 Pa is 60 mmHg"},
    {"inflow", VN_F64, VN_ABOVE_MIN | VN_OPTIONAL, offsetof(vn_flow_def, inflow), 0, MOST, "length³/s", NULL,
     "what enters in all, in place of the pressure where `share` says; left out: pressures hold"},
    {"share", VN_CHOICE, 0, offsetof(vn_flow_def, share), 0, 0, "", "roots|terminals",
     "who lets `inflow` through in equal shares; pressures hold at the others"},
    {"terminal_flow", VN_F64, VN_ABOVE_MIN | VN_OPTIONAL, offsetof(vn_flow_def, terminal_flow), 0, MOST,
     "length³/s", NULL, "what each terminal takes, in place of pressure_out; left out: pressures hold"},
    {"exponent", VN_F64, VN_ABOVE_MIN, offsetof(vn_flow_def, exponent), 0, 100, "", NULL,
     "of Murray's law, for its residual"},
};
const vn_schema vn_flow_schema = VN_SCHEMA("flow", "What flows through a network", flow_fields, flow_default);

vn_flow_def vn_flow_def_default(void) {
    return flow_default;
}

static vn_status check_finite(const double *values, int32_t count, const char *of, const char *what) {
    for (int32_t i = 0; i < count; i++) {
        if (!(fabs(values[i]) <= VN_HUGE)) {
            return vn_fail(VN_INVALID, "%s %d has the %s %g, which must be finite", of, i, what, values[i]);
        }
    }
    return VN_OK;
}

vn_status vn_network_set_flow(vn_network *network, const double *flow, const double *pressure) {
    int32_t count = network->x.count;
    VN_TRY(check_finite(flow, count, "node", "flow"));
    VN_TRY(pressure != NULL ? check_finite(pressure, count, "node", "pressure") : VN_OK);
    VN_TRY(vn_array_reserve(&network->flow, count));
    VN_TRY(pressure != NULL ? vn_array_reserve(&network->pressure, count) : VN_OK);
    if (count > 0) {
        memcpy(network->flow.data, flow, (size_t)count * sizeof *flow);
    }
    if (count > 0 && pressure != NULL) {
        memcpy(network->pressure.data, pressure, (size_t)count * sizeof *pressure);
    }
    network->flow.count = count;
    network->pressure.count = pressure != NULL ? count : 0;
    network->join_flow.count = 0; // was another flow's
    network->flow_version = network->version;
    return VN_OK;
}

static bool is_current(const vn_network *network, int32_t count) {
    return count > 0 && count == network->x.count && network->flow_version == network->version;
}

const double *vn_network_flow(const vn_network *network) {
    return is_current(network, network->flow.count) ? network->flow.data : NULL;
}

const double *vn_network_pressure(const vn_network *network) {
    return is_current(network, network->pressure.count) ? network->pressure.data : NULL;
}

// ---- Joins ----

bool vn_network_join_flipped(const vn_network *network, int32_t join) {
    return vn_demand_rules(network) && vn_network_demand(network)->flipped.data[join];
}

// Kept from the end that was given as a; a law of widths may come and turn it.
static vn_status keep_join_flow(vn_network *network, const double *flow, bool as_given) {
    int32_t count = network->joins.count;
    VN_TRY(check_finite(flow, count, "join", "flow"));
    VN_TRY(vn_array_reserve(&network->join_flow, count));
    for (int32_t j = 0; j < count; j++) {
        bool turn = !as_given && vn_network_join_flipped(network, j);
        network->join_flow.data[j] = turn ? -flow[j] : flow[j];
    }
    network->join_flow.count = count;
    network->join_flow_version = network->version;
    return VN_OK;
}

vn_status vn_network_set_join_flow(vn_network *network, const double *flow) {
    return keep_join_flow(network, flow, false);
}

bool vn_network_has_join_flow(const vn_network *network) {
    return network->join_flow.count > 0 && network->join_flow.count == network->joins.count &&
           network->join_flow_version == network->version;
}

double vn_network_join_flow(const vn_network *network, int32_t join) {
    if (!vn_network_has_join_flow(network)) {
        return 0;
    }
    double flow = network->join_flow.data[join];
    return vn_network_join_flipped(network, join) ? -flow : flow;
}

// ---- Solving ----

static vn_status keep_state(vn_network *network, const vn_flow_state *state) {
    int32_t nodes = network->x.count;
    VN_TRY(vn_array_reserve(&network->join_flow, network->joins.count)); // before anything changes
    VN_TRY(vn_network_set_flow(network, state->flow.data, state->pressure.data));
    return keep_join_flow(network, state->flow.data + nodes, true);
}

vn_status vn_network_solve_flow(vn_network *network, const vn_flow_def *def, vn_flow_report *report) {
    vn_flow_state state = {0};
    *report = (vn_flow_report){0};
    vn_status status = vn_flow_solve(&state, network, def);
    status = status == VN_OK ? vn_flow_describe(report, network, def, &state) : status;
    if (status == VN_OK && network->x.count > 0) {
        status = keep_state(network, &state);
    }
    vn_flow_state_free(&state);
    if (status != VN_OK) {
        vn_flow_report_free(report);
    }
    return status;
}

// ---- Auditing what is there ----

static vn_status follow_pressures(vn_flow_state *state, const vn_network *network, const vn_flow_def *def) {
    for (int32_t k = 0; k < network->x.count; k++) {
        int32_t node = vn_network_nth(network, k);
        vn_pipe pipe;
        double resistance;
        double *pressure = &state->pressure.data[node];
        *pressure = def->pressure_in;
        if (vn_pipe_get(network, node, &pipe)) {
            VN_TRY(vn_pipe_resistance(network, node, &pipe, def->viscosity, &resistance));
            *pressure = state->pressure.data[pipe.a] - resistance * state->flow.data[node];
        }
    }
    return VN_OK;
}

static vn_status follow_join(vn_flow_state *state, const vn_network *network, const vn_flow_def *def,
                             int32_t join) {
    int32_t edge = network->x.count + join;
    const double *pressure = state->pressure.data;
    vn_pipe pipe;
    double resistance;
    vn_pipe_get(network, edge, &pipe);
    VN_TRY(vn_pipe_resistance(network, edge, &pipe, def->viscosity, &resistance));
    if (resistance == 0) {
        return vn_fail(
            VN_INVALID,
            "flow: join %d has no length, so that pressures do not tell what flows through it; say "
            "it, or solve",
            join);
    }
    state->flow.data[edge] = (pressure[pipe.a] - pressure[pipe.b]) / resistance;
    return VN_OK;
}

static vn_status take_joins(vn_flow_state *state, const vn_network *network, const vn_flow_def *def) {
    int32_t nodes = network->x.count;
    if (network->joins.count > 0 && !vn_network_has_join_flow(network) &&
        vn_network_pressure(network) == NULL) {
        return vn_fail(VN_INVALID,
                       "flow: neither the pressures nor the flows through the %d joins are known: "
                       "solve for them (net:flow{…} without solve = false)",
                       network->joins.count);
    }
    for (int32_t j = 0; j < network->joins.count; j++) {
        if (vn_network_has_join_flow(network)) {
            // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): one for every pipe
            state->flow.data[nodes + j] = network->join_flow.data[j];
        } else {
            VN_TRY(follow_join(state, network, def, j));
        }
    }
    return VN_OK;
}

static vn_status take_state(vn_flow_state *state, const vn_network *network, const vn_flow_def *def) {
    int32_t nodes = network->x.count;
    const double *flow = vn_network_flow(network), *pressure = vn_network_pressure(network);
    if (nodes > 0 && flow == NULL) {
        return vn_fail(VN_INVALID,
                       "flow: the network's flows are not known, or have changed since: solve for "
                       "them (net:flow{…} without solve = false)");
    }
    VN_TRY(vn_array_zero(&state->flow, vn_pipe_count(network)));
    VN_TRY(vn_array_zero(&state->pressure, nodes));
    for (int32_t i = 0; i < nodes; i++) {
        state->flow.data[i] = flow[i];
        state->pressure.data[i] = pressure != NULL ? pressure[i] : 0;
    }
    VN_TRY(pressure == NULL ? follow_pressures(state, network, def) : VN_OK);
    return take_joins(state, network, def);
}

vn_status vn_network_audit_flow(const vn_network *network, const vn_flow_def *def, vn_flow_report *report) {
    vn_flow_state state = {0};
    *report = (vn_flow_report){0};
    VN_TRY(vn_check_def(&vn_flow_schema, def));
    VN_TRY(vn_flow_check_network(network));
    vn_status status = take_state(&state, network, def);
    status = status == VN_OK ? vn_flow_describe(report, network, def, &state) : status;
    vn_flow_state_free(&state);
    return status;
}
