#include "base/memory.h"
#include "base/sink.h"
#include "base/text.h"
#include "file/json.h"
#include "network/network.h"
#include "venule/output.h"

#include <yajl/yajl_parse.h>

static vn_status write_text(vn_sink *sink, const char *text) {
    return vn_sink_write(sink, text, strlen(text));
}

static vn_status write_quoted(vn_sink *sink, const char *value) {
    vn_text quoted = {0};
    vn_status status = vn_text_json(&quoted, value);
    if (status == VN_OK) {
        status = vn_sink_write(sink, quoted.data, (size_t)quoted.count);
    }
    vn_array_free(&quoted);
    return status;
}

// Not by vn_sink_number(), whose shortest form of a million is 1e+06.
static vn_status write_integer(vn_sink *sink, int32_t value) {
    char digits[VN_NUMBER_SIZE];
    char *at = digits + sizeof digits;
    uint32_t rest = value < 0 ? 0u - (uint32_t)value : (uint32_t)value;
    do {
        *--at = (char)('0' + rest % 10);
        rest /= 10;
    } while (rest > 0);
    if (value < 0) {
        *--at = '-';
    }
    return vn_sink_write(sink, at, (size_t)(digits + sizeof digits - at));
}

static vn_status write_comma(vn_sink *sink, int32_t index) {
    return index > 0 ? vn_sink_write(sink, ",", 1) : VN_OK;
}

// `key` comes with the punctuation around it: ",\n\"y\": [".
static vn_status write_numbers(vn_sink *sink, const char *key, const double *values, int32_t count) {
    VN_TRY(write_text(sink, key));
    for (int32_t i = 0; i < count; i++) {
        VN_TRY(write_comma(sink, i));
        VN_TRY(vn_sink_number(sink, values[i]));
    }
    return vn_sink_write(sink, "]", 1);
}

static vn_status write_integers(vn_sink *sink, const char *key, const int32_t *values, int32_t count) {
    VN_TRY(write_text(sink, key));
    for (int32_t i = 0; i < count; i++) {
        VN_TRY(write_comma(sink, i));
        VN_TRY(write_integer(sink, values[i]));
    }
    return vn_sink_write(sink, "]", 1);
}

static vn_status write_radii(vn_sink *sink, const vn_network *network) {
    VN_TRY(write_text(sink, ",\n\"radius\": ["));
    for (int32_t i = 0; i < vn_network_count(network); i++) {
        VN_TRY(write_comma(sink, i));
        VN_TRY(vn_sink_number(sink, vn_network_radius(network, i)));
    }
    return vn_sink_write(sink, "]", 1);
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
    return write_text(sink, "}");
}

static vn_join join_at(const vn_network *network, int32_t join) {
    vn_join found;
    vn_network_join_ends(network, join, &found.a, &found.b, &found.radius);
    return found;
}

static vn_status write_joins(vn_sink *sink, const vn_network *network) {
    int32_t count = vn_network_join_count(network);
    VN_TRY(write_text(sink, ",\n\"joins\": {\"a\": ["));
    for (int32_t i = 0; i < count; i++) {
        VN_TRY(write_comma(sink, i));
        VN_TRY(write_integer(sink, join_at(network, i).a));
    }
    VN_TRY(write_text(sink, "],\n\"b\": ["));
    for (int32_t i = 0; i < count; i++) {
        VN_TRY(write_comma(sink, i));
        VN_TRY(write_integer(sink, join_at(network, i).b));
    }
    VN_TRY(write_text(sink, "],\n\"radius\": ["));
    for (int32_t i = 0; i < count; i++) {
        VN_TRY(write_comma(sink, i));
        VN_TRY(vn_sink_number(sink, join_at(network, i).radius));
    }
    return write_text(sink, "]}");
}

static vn_status write_murray(vn_sink *sink, const vn_network *network) {
    vn_murray_def def;
    if (!vn_network_murray_get(network, &def)) {
        return VN_OK;
    }
    VN_TRY(write_text(sink, ",\n\"murray\": {\"exponent\": "));
    VN_TRY(vn_sink_number(sink, def.exponent));
    VN_TRY(write_text(sink, ", \"tip_radius\": "));
    VN_TRY(vn_sink_number(sink, def.tip_radius));
    if (def.veinlets > 0) {
        VN_TRY(write_text(sink, ", \"veinlets\": "));
        VN_TRY(vn_sink_number(sink, def.veinlets));
    }
    return write_text(sink, "}");
}

// Without which a reader could not check Hickey's orders.
static vn_status write_order_ratio(vn_sink *sink, const vn_network *network) {
    if (vn_network_orders(network) == NULL || network->orders_ratio == 0) {
        return VN_OK;
    }
    VN_TRY(write_text(sink, ",\n\"order_ratio\": "));
    return vn_sink_number(sink, network->orders_ratio);
}

// The members that a network has alone in its file and among others alike.
static vn_status write_network(vn_sink *sink, const vn_network *network) {
    VN_TRY(write_text(sink, "\"dim\": "));
    VN_TRY(write_integer(sink, vn_network_dim(network)));
    VN_TRY(write_text(sink, ", \"unit\": "));
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
        VN_TRY(write_text(sink, i > 0 ? ",\n" : "\n"));
        VN_TRY(write_quoted(sink, names[i]));
        VN_TRY(write_text(sink, ": {"));
        VN_TRY(write_network(sink, networks[i]));
        VN_TRY(write_text(sink, "}"));
    }
    return write_text(sink, "}");
}

static vn_status write_manifest(vn_sink *sink, const char *manifest) {
    VN_TRY(write_text(sink, ",\n\"manifest\": "));
    VN_TRY(write_text(sink, manifest == NULL ? "{}" : manifest));
    return write_text(sink, "}\n");
}

static vn_status check_names(const char *const *names, int32_t count) {
    if (names == NULL) {
        return vn_fail(VN_INVALID, "%d networks for one file need a name each", count);
    }
    for (int32_t i = 0; i < count; i++) {
        if (names[i] == NULL || names[i][0] == '\0') {
            return vn_fail(VN_INVALID, "network %d of %d for one file needs a name", i + 1, count);
        }
        for (int32_t j = 0; j < i; j++) {
            if (strcmp(names[i], names[j]) == 0) {
                return vn_fail(VN_INVALID, "two networks for one file are called \"%s\"; rename one",
                               names[i]);
            }
        }
    }
    return VN_OK;
}

static bool is_json(const char *text) {
    yajl_handle parser = yajl_alloc(NULL, NULL, NULL);
    bool good = parser != NULL &&
                yajl_parse(parser, (const unsigned char *)text, strlen(text)) == yajl_status_ok &&
                yajl_complete_parse(parser) == yajl_status_ok;
    if (parser != NULL) {
        yajl_free(parser);
    }
    return good;
}

// A manifest that is no JSON object would spoil the file around it.
static vn_status check_manifest(const char *manifest) {
    if (manifest == NULL || (manifest[strspn(manifest, " \t\r\n")] == '{' && is_json(manifest))) {
        return VN_OK;
    }
    return vn_fail(VN_INVALID, "the manifest must be a JSON object, not \"%.40s\"", manifest);
}

static bool is_single(const char *const *names, int32_t count) {
    return count == 1 && (names == NULL || names[0] == NULL || names[0][0] == '\0');
}

static vn_status check_request(const char *const *names, int32_t count, const char *path,
                               const char *manifest) {
    if (count < 1 || count > VN_JSON_MAX_NETWORKS) {
        return vn_fail(VN_INVALID, "%s: a file holds 1 to %d networks, not %d", path, VN_JSON_MAX_NETWORKS,
                       count);
    }
    if (!is_single(names, count)) {
        VN_TRY(check_names(names, count));
    }
    return check_manifest(manifest);
}

vn_status vn_networks_save(const vn_network *const *networks, const char *const *names, int32_t count,
                           const char *path, const char *manifest) {
    VN_TRY(check_request(names, count, path, manifest));
    vn_sink *sink;
    VN_TRY(vn_sink_open(&sink, path));
    vn_status status = is_single(names, count) ? write_single(sink, networks[0])
                                               : write_several(sink, networks, names, count);
    if (status == VN_OK) {
        status = write_manifest(sink, manifest);
    }
    return vn_sink_close(sink, status);
}

vn_status vn_network_save(const vn_network *network, const char *path, const char *manifest) {
    return vn_networks_save(&network, NULL, 1, path, manifest);
}
