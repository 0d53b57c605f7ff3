#include "network/vessels.h"

#include "network/leaf.h"

static const vn_vessel_measures_def measures_default = {.bins = 10};

static const vn_field measures_fields[] = {
    {"exponent", VN_F64, VN_ABOVE_MIN | VN_OPTIONAL, offsetof(vn_vessel_measures_def, exponent), 0, 100, "",
     NULL, "κ in r_parent^κ = Σ r_child^κ, as murray's; left out: that of the law in force, or 3"},
    {"orders", VN_CHOICE, 0, offsetof(vn_vessel_measures_def, orders), 0, 0, "", "strahler|diameter",
     "by Strahler: tips 1, one more where two of the highest meet; by diameter: one more where a vessel is "
     "too "
     "thick for the order of its daughters (after Jiang, Kassab & Fung 1994)"},
    {"bins", VN_I32, 0, offsetof(vn_vessel_measures_def, bins), 1, 1000, "bins", NULL,
     "of the daughters' ratio r2/r1 from 0 to 1, for angles"},
};
const vn_schema vn_vessel_measures_schema =
    VN_SCHEMA("measure_vessels", "Measures of vessels", measures_fields, measures_default);

vn_vessel_measures_def vn_vessel_measures_def_default(void) {
    return measures_default;
}

// ---- Tortuosity ----

/// A segment or element as it is walked down.
typedef struct trace {
    bool begun;
    double start[3];
    int32_t end;
    double length;
    double last[3]; ///< the last edge that has a length
    double last_length;
    double turned; ///< Σ θ² / ℓ
} trace;

typedef VN_ARRAY(trace) trace_array;

static void walk_edge(trace *t, const vn_network *network, int32_t node) {
    double d[3], degrees;
    if (!t->begun) {
        vn_network_position(network, network->parent.data[node], t->start);
        t->begun = true;
    }
    t->end = node;
    vn_edge_direction(network, node, d);
    double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    if (!(length > 0)) {
        return;
    }
    if (t->last_length > 0 && vn_angle_between(t->last, d, &degrees)) {
        double turn = degrees / 57.29577951308232;
        t->turned += 2 * turn * turn / (t->last_length + length);
    }
    memcpy(t->last, d, sizeof d);
    t->last_length = length;
    t->length += length;
}

/// What traces are gathered to.
typedef struct curves {
    VN_ARRAY(double) tortuosity;
    VN_ARRAY(double) curvature;
} curves;

static vn_status add_trace(curves *c, const vn_network *network, const trace *t) {
    double p[3];
    vn_network_position(network, t->end, p);
    double chord = sqrt(vn_distance2(t->start, p));
    VN_TRY(chord > 0 ? vn_array_push(&c->tortuosity, t->length / chord) : VN_OK);
    return t->length > 0 ? vn_array_push(&c->curvature, t->turned / t->length) : VN_OK;
}

// @p path is the number of the path that each branch is part of.
static vn_status trace_paths(trace_array *traces, const vn_network *network, const vn_branches *branches,
                             const int32_t *path, int32_t count) {
    VN_TRY(vn_array_zero(traces, count));
    for (int32_t k = 0; k < network->x.count; k++) {
        int32_t node = vn_network_nth(network, k);
        if (network->parent.data[node] >= 0) {
            int32_t branch = branches->of.data[node];
            walk_edge(&traces->data[path != NULL ? path[branch] : branch], network, node);
        }
    }
    return VN_OK;
}

static vn_status describe_traces(curves *c, const vn_network *network, const trace_array *traces,
                                 vn_statistics *tortuosity, vn_statistics *curvature) {
    for (int32_t i = 0; i < traces->count; i++) {
        VN_TRY(add_trace(c, network, &traces->data[i]));
    }
    VN_TRY(vn_statistics_of(tortuosity, c->tortuosity.data, c->tortuosity.count));
    return vn_statistics_of(curvature, c->curvature.data, c->curvature.count);
}

static vn_status measure_curves(const vn_network *network, const vn_branches *branches, const int32_t *path,
                                int32_t count, vn_statistics *tortuosity, vn_statistics *curvature) {
    trace_array traces = {0};
    curves c = {0};
    vn_status status = trace_paths(&traces, network, branches, path, count);
    status = status == VN_OK ? describe_traces(&c, network, &traces, tortuosity, curvature) : status;
    vn_array_free(&traces);
    vn_array_free(&c.tortuosity);
    vn_array_free(&c.curvature);
    return status;
}

// ---- All ----

static vn_status measure_branches(vn_vessel_measures *out, const vn_network *network,
                                  const vn_branches *branches, int orders) {
    VN_ARRAY(int32_t) element = {0};
    VN_TRY(vn_array_zero(&element, branches->list.count));
    vn_status status = vn_vessels_measure_orders(out, network, branches, orders, element.data);
    status = status == VN_OK ? measure_curves(network, branches, NULL, branches->list.count,
                                              &out->segment_tortuosity, &out->segment_curvature)
                             : status;
    status = status == VN_OK ? measure_curves(network, branches, element.data, out->elements,
                                              &out->element_tortuosity, &out->element_curvature)
                             : status;
    vn_array_free(&element);
    return status;
}

static vn_status measure_all(vn_vessel_measures *out, const vn_network *network, int orders) {
    vn_branches branches = {0};
    VN_TRY(vn_vessels_measure_junctions(out, network));
    VN_TRY(vn_vessels_measure_forks(out, network));
    vn_status status = vn_branches_find(&branches, network);
    status = status == VN_OK ? measure_branches(out, network, &branches, orders) : status;
    vn_branches_free(&branches);
    return status;
}

vn_status vn_network_measure_vessels(const vn_network *network, const vn_vessel_measures_def *def,
                                     vn_vessel_measures *out) {
    vn_murray_def law;
    *out = (vn_vessel_measures){0};
    VN_TRY(vn_check_def(&vn_vessel_measures_schema, def));
    if (def->orders == VN_ORDERS_DIAMETER && network->x.count > 0 && !vn_network_has_radii(network)) {
        return vn_fail(VN_INVALID, "measure_vessels.orders = \"diameter\": the network has no radii; give it "
                                   "some by Murray's law (net:murray{…}), or ask for \"strahler\"");
    }
    VN_TRY(vn_check_places(network, "measure_vessels"));
    vn_network_murray_get(network, &law);
    vn_vessel_measures made = {.bin_count = def->bins};
    made.exponent = def->exponent > 0 ? def->exponent : law.exponent;
    vn_status status = measure_all(&made, network, def->orders);
    if (status != VN_OK) {
        vn_vessel_measures_free(&made);
        return status;
    }
    *out = made;
    return VN_OK;
}

void vn_vessel_measures_free(vn_vessel_measures *m) {
    vn_fork_bin *bins = m->bins;
    vn_vessel_order *orders = m->orders;
    vn_resize(bins, bins != NULL ? (size_t)m->bin_count * sizeof *bins : 0, 0);
    vn_resize(orders, orders != NULL ? (size_t)m->order_count * sizeof *orders : 0, 0);
    *m = (vn_vessel_measures){0};
}
