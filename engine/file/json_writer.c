#include "base/memory.h"
#include "base/sink.h"
#include "base/text.h"
#include "file/json.h"
#include "network/network.h"

static vn_status write_quoted(vn_sink *sink, const char *value) {
    vn_text quoted = {0};
    vn_status status = vn_text_json(&quoted, value);
    if (status == VN_OK) {
        status = vn_sink_write(sink, quoted.data, (size_t)quoted.count);
    }
    vn_array_free(&quoted);
    return status;
}

static vn_status write_comma(vn_sink *sink, int32_t index) {
    return index > 0 ? vn_sink_write(sink, ",", 1) : VN_OK;
}

// `key` comes with the punctuation around it: ",\n\"y\": [".
static vn_status write_numbers(vn_sink *sink, const char *key, const double *values, int32_t count) {
    VN_TRY(vn_sink_text(sink, key));
    for (int32_t i = 0; i < count; i++) {
        VN_TRY(write_comma(sink, i));
        VN_TRY(vn_sink_number(sink, values[i]));
    }
    return vn_sink_write(sink, "]", 1);
}

static vn_status write_integers(vn_sink *sink, const char *key, const int32_t *values, int32_t count) {
    VN_TRY(vn_sink_text(sink, key));
    for (int32_t i = 0; i < count; i++) {
        VN_TRY(write_comma(sink, i));
        VN_TRY(vn_sink_integer(sink, values[i]));
    }
    return vn_sink_write(sink, "]", 1);
}

static vn_status write_radii(vn_sink *sink, const vn_network *network) {
    VN_TRY(vn_sink_text(sink, ",\n\"radius\": ["));
    for (int32_t i = 0; i < vn_network_count(network); i++) {
        VN_TRY(write_comma(sink, i));
        VN_TRY(vn_sink_number(sink, vn_network_radius(network, i)));
    }
    return vn_sink_write(sink, "]", 1);
}

static vn_status write_flow(vn_sink *sink, const vn_network *network) {
    int32_t count = vn_network_count(network);
    const double *flow = vn_network_flow(network), *pressure = vn_network_pressure(network);
    if (flow != NULL) {
        VN_TRY(write_numbers(sink, ",\n\"flow\": [", flow, count));
    }
    return pressure != NULL ? write_numbers(sink, ",\n\"pressure\": [", pressure, count) : VN_OK;
}

static vn_status write_nodes(vn_sink *sink, const vn_network *network) {
    int32_t count = vn_network_count(network);
    VN_TRY(write_numbers(sink, ",\n\"nodes\": {\"x\": [", vn_network_x(network), count));
    VN_TRY(write_numbers(sink, ",\n\"y\": [", vn_network_y(network), count));
    if (vn_network_dim(network) == 3) {
        VN_TRY(write_numbers(sink, ",\n\"z\": [", vn_network_z(network), count));
    }
    VN_TRY(write_integers(sink, ",\n\"parent\": [", vn_network_parent(network), count));
    if (vn_network_has_radii(network)) {
        VN_TRY(write_radii(sink, network));
    }
    VN_TRY(write_integers(sink, ",\n\"tree\": [", vn_network_tree(network), count));
    VN_TRY(write_integers(sink, ",\n\"birth\": [", vn_network_birth(network), count));
    if (vn_network_orders(network) != NULL) {
        VN_TRY(write_integers(sink, ",\n\"order\": [", vn_network_orders(network), count));
    }
    VN_TRY(write_flow(sink, network));
    return vn_sink_text(sink, "}");
}

static vn_join join_at(const vn_network *network, int32_t join) {
    vn_join found;
    vn_network_join_ends(network, join, &found.a, &found.b, &found.radius);
    return found;
}

static vn_status write_joins(vn_sink *sink, const vn_network *network) {
    int32_t count = vn_network_join_count(network);
    VN_TRY(vn_sink_text(sink, ",\n\"joins\": {\"a\": ["));
    for (int32_t i = 0; i < count; i++) {
        VN_TRY(write_comma(sink, i));
        VN_TRY(vn_sink_integer(sink, join_at(network, i).a));
    }
    VN_TRY(vn_sink_text(sink, "],\n\"b\": ["));
    for (int32_t i = 0; i < count; i++) {
        VN_TRY(write_comma(sink, i));
        VN_TRY(vn_sink_integer(sink, join_at(network, i).b));
    }
    VN_TRY(vn_sink_text(sink, "],\n\"radius\": ["));
    for (int32_t i = 0; i < count; i++) {
        VN_TRY(write_comma(sink, i));
        VN_TRY(vn_sink_number(sink, join_at(network, i).radius));
    }
    return vn_sink_text(sink, "]}");
}

static vn_status write_murray(vn_sink *sink, const vn_network *network) {
    vn_murray_def def;
    if (!vn_network_murray_get(network, &def)) {
        return VN_OK;
    }
    VN_TRY(vn_sink_text(sink, ",\n\"murray\": {\"exponent\": "));
    VN_TRY(vn_sink_number(sink, def.exponent));
    VN_TRY(vn_sink_text(sink, ", \"tip_radius\": "));
    VN_TRY(vn_sink_number(sink, def.tip_radius));
    if (def.veinlets > 0) {
        VN_TRY(vn_sink_text(sink, ", \"veinlets\": "));
        VN_TRY(vn_sink_number(sink, def.veinlets));
    }
    return vn_sink_text(sink, "}");
}

// Without which a reader could not check Hickey's orders.
static vn_status write_order_ratio(vn_sink *sink, const vn_network *network) {
    if (vn_network_orders(network) == NULL || network->orders_ratio == 0) {
        return VN_OK;
    }
    VN_TRY(vn_sink_text(sink, ",\n\"order_ratio\": "));
    return vn_sink_number(sink, network->orders_ratio);
}

// The members that a network has alone in its file and among others alike.
static vn_status write_network(vn_sink *sink, const vn_network *network) {
    VN_TRY(vn_sink_text(sink, "\"dim\": "));
    VN_TRY(vn_sink_integer(sink, vn_network_dim(network)));
    VN_TRY(vn_sink_text(sink, ", \"unit\": "));
    VN_TRY(write_quoted(sink, vn_network_unit(network)));
    VN_TRY(write_murray(sink, network));
    VN_TRY(write_order_ratio(sink, network));
    VN_TRY(write_nodes(sink, network));
    return write_joins(sink, network);
}

static vn_status write_single(vn_sink *sink, const vn_network *network) {
    VN_TRY(vn_sink_print(sink, "{\"format\": \"%s\", \"version\": %d, ", VN_JSON_NETWORK, VN_JSON_VERSION));
    return write_network(sink, network);
}

static vn_status write_several(vn_sink *sink, const vn_network *const *networks, const char *const *names,
                               int32_t count) {
    VN_TRY(vn_sink_print(sink, "{\"format\": \"%s\", \"version\": %d, \"networks\": {", VN_JSON_NETWORKS,
                         VN_JSON_VERSION));
    for (int32_t i = 0; i < count; i++) {
        VN_TRY(vn_sink_text(sink, i > 0 ? ",\n" : "\n"));
        VN_TRY(write_quoted(sink, names[i]));
        VN_TRY(vn_sink_text(sink, ": {"));
        VN_TRY(write_network(sink, networks[i]));
        VN_TRY(vn_sink_text(sink, "}"));
    }
    return vn_sink_text(sink, "}");
}

static vn_status write_manifest(vn_sink *sink, const char *manifest) {
    VN_TRY(vn_sink_text(sink, ",\n\"manifest\": "));
    VN_TRY(vn_sink_text(sink, manifest == NULL ? "{}" : manifest));
    return vn_sink_text(sink, "}\n");
}

vn_status vn_json_write(vn_sink *sink, const vn_networks_given *given) {
    VN_TRY(given->names == NULL ? write_single(sink, given->networks[0])
                                : write_several(sink, given->networks, given->names, given->count));
    return write_manifest(sink, given->manifest);
}
