// Murray's law where edges meet, joins among them.

#include "network/leaf.h"
#include "network/sides.h"
#include "network/vessels.h"

typedef VN_ARRAY(int32_t) index_array;

typedef struct junctions {
    const vn_network *network;
    vn_vessel_measures *out;
    index_array starts; // node v has the join ends [starts[v], starts[v + 1]); empty without joins
    index_array ends;   // join j where v is the parent, -1 - j where it is the child
    vn_sides sides;
    VN_ARRAY(double) residuals;
    VN_ARRAY(double) fitted;
    double squares, most;
} junctions;

static void free_junctions(junctions *j) {
    vn_array_free(&j->starts);
    vn_array_free(&j->ends);
    vn_sides_free(&j->sides);
    vn_array_free(&j->residuals);
    vn_array_free(&j->fitted);
}

static void count_join_ends(junctions *j) {
    int32_t *starts = j->starts.data;
    for (int32_t i = 0; i < j->network->joins.count; i++) {
        starts[j->network->joins.data[i].a]++;
        starts[j->network->joins.data[i].b]++;
    }
    for (int32_t v = 0; v < j->network->x.count; v++) {
        starts[v + 1] += starts[v];
    }
}

static vn_status list_join_ends(junctions *j) {
    int32_t joins = j->network->joins.count;
    if (joins == 0) {
        return VN_OK;
    }
    VN_TRY(vn_array_zero(&j->starts, (int64_t)j->network->x.count + 1));
    VN_TRY(vn_array_zero(&j->ends, 2 * (int64_t)joins));
    count_join_ends(j);
    for (int32_t i = joins - 1; i >= 0; i--) { // from behind, so that starts[v] ends as the first
        int32_t a, b;
        double radius;
        vn_network_join_ends(j->network, i, &a, &b, &radius);
        j->ends.data[--j->starts.data[a]] = i;
        j->ends.data[--j->starts.data[b]] = -1 - i;
    }
    return VN_OK;
}

static vn_status add_in(junctions *j, double radius) {
    return radius > 0 ? vn_array_push(&j->sides.in, radius) : VN_OK;
}

static vn_status add_out(junctions *j, double radius) {
    return radius > 0 ? vn_array_push(&j->sides.out, radius) : VN_OK;
}

static vn_status add_joins(junctions *j, int32_t node) {
    for (int32_t k = j->starts.data[node]; k < j->starts.data[node + 1]; k++) {
        int32_t a, b, end = j->ends.data[k];
        double radius;
        vn_network_join_ends(j->network, end >= 0 ? end : -1 - end, &a, &b, &radius);
        VN_TRY(end >= 0 ? add_out(j, radius) : add_in(j, radius));
    }
    return VN_OK;
}

static vn_status find_sides(junctions *j, int32_t node) {
    const vn_network *network = j->network;
    j->sides.in.count = j->sides.out.count = 0;
    if (network->parent.data[node] >= 0) {
        VN_TRY(add_in(j, vn_network_radius(network, node)));
    }
    for (int32_t c = network->first_child.data[node]; c >= 0; c = network->next_child.data[c]) {
        VN_TRY(add_out(j, vn_network_radius(network, c)));
    }
    return j->starts.count > 0 ? add_joins(j, node) : VN_OK;
}

static vn_status look_at_node(junctions *j, int32_t node) {
    double exponent;
    VN_TRY(find_sides(j, node));
    if (!vn_sides_meet(&j->sides)) {
        return VN_OK;
    }
    double residual = vn_sides_residual(&j->sides, j->out->exponent);
    if (j->out->murray_worst < 0 || residual > j->most) {
        j->out->murray_worst = node;
        j->most = residual;
    }
    j->squares += residual * residual;
    VN_TRY(vn_array_push(&j->residuals, residual));
    return vn_sides_fit(&j->sides, &exponent) ? vn_array_push(&j->fitted, exponent) : VN_OK;
}

static vn_status look_at_nodes(junctions *j) {
    VN_TRY(list_join_ends(j));
    for (int32_t v = 0; v < j->network->x.count; v++) {
        VN_TRY(look_at_node(j, v));
    }
    VN_TRY(vn_statistics_of(&j->out->murray, j->residuals.data, j->residuals.count));
    j->out->murray_rms = j->residuals.count > 0 ? sqrt(j->squares / j->residuals.count) : 0;
    return vn_statistics_of(&j->out->fitted, j->fitted.data, j->fitted.count);
}

vn_status vn_vessels_measure_junctions(vn_vessel_measures *out, const vn_network *network) {
    out->murray_worst = -1;
    if (!vn_network_has_radii(network)) {
        return VN_OK;
    }
    junctions j = {.network = network, .out = out};
    vn_status status = look_at_nodes(&j);
    free_junctions(&j);
    return status;
}
