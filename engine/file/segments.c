// The text of OpenCCO's `generateTree3D -e`: "xd yd zd xp yp zp r" a line, the far end of a segment, its near
// end, its radius. Segments are connected where they begin and end at the same place; a file of OpenCCO's
// lacks the root's own, so that its tree begins at the first bifurcation.
#include "file/draft.h"
#include "file/lines.h"
#include "file/names.h"

#include <math.h>

enum { FIELDS = 7 };

static const char *const field_names[FIELDS] = {"xd", "yd", "zd", "xp", "yp", "zp", "r"};

static vn_status node_at(vn_draft *draft, vn_sites *places, const double p[3], int32_t *node) {
    VN_TRY(vn_sites_number(places, p, node));
    return *node == draft->x.count ? vn_draft_node(draft, p) : VN_OK;
}

static vn_status read_row(vn_draft *draft, vn_sites *places, vn_slice rest, long long line) {
    double values[FIELDS];
    vn_draft_edge edge = {.flow = NAN};
    for (int i = 0; i < FIELDS; i++) {
        vn_slice word = vn_take_word(&rest);
        if (!vn_slice_number(word, &values[i])) {
            return vn_fail(VN_INVALID,
                           "line %lld: %s = \"%.*s\" must be a number; a line is: xd yd zd xp yp zp r", line,
                           field_names[i], VN_SLICE(word));
        }
    }
    if (vn_slice_trim(rest).length > 0) {
        return vn_fail(VN_INVALID, "line %lld: has more than the seven numbers xd yd zd xp yp zp r", line);
    }
    VN_TRY(node_at(draft, places, values + 3, &edge.from));
    VN_TRY(node_at(draft, places, values, &edge.to));
    if (edge.from == edge.to) {
        return vn_fail(VN_INVALID, "line %lld: the segment has no length; leave it out", line);
    }
    edge.radius = values[6];
    return vn_draft_edge_add(draft, &edge);
}

static vn_status read_lines(vn_draft *draft, vn_sites *places, vn_lines *lines) {
    for (;;) {
        vn_slice line;
        VN_TRY(vn_lines_next(lines, &line));
        if (line.text == NULL) {
            return VN_OK;
        }
        line = vn_slice_trim(line);
        if (line.length > 0 && line.text[0] != '#') {
            VN_TRY(read_row(draft, places, line, lines->number));
        }
    }
}

static void forget_zero_radii(vn_draft *draft) {
    bool any = false;
    for (int32_t i = 0; i < draft->edges.count; i++) {
        any = any || draft->edges.data[i].radius != 0;
    }
    for (int32_t i = 0; i < draft->edges.count && !any; i++) {
        draft->edges.data[i].radius = NAN;
    }
}

vn_status vn_segments_read(vn_network_set *set, const char *path, FILE *file) {
    vn_draft draft = {0};
    vn_sites places = {0};
    vn_lines *lines;
    VN_TRY(vn_lines_open(&lines, path, file));
    vn_status status = read_lines(&draft, &places, lines);
    if (status == VN_OK) {
        forget_zero_radii(&draft);
        status = vn_draft_link(&draft, true);
    }
    status = status == VN_OK ? vn_draft_finish(&draft, set) : status;
    vn_lines_close(lines);
    vn_sites_free(&places);
    vn_draft_free(&draft);
    return status;
}

// What a reader could not connect again as it was, it must not be given.
static vn_status check_node(const vn_network *network, vn_sites *places, int32_t node) {
    double p[3];
    int32_t number;
    vn_network_position(network, node, p);
    VN_TRY(vn_sites_number(places, p, &number));
    if (number != node) {
        return vn_fail(VN_INVALID,
                       "nodes %d and %d are at one place, which such a file cannot tell; save it as .json",
                       number, node);
    }
    if (vn_network_parent(network)[node] < 0 && vn_network_first_child(network, node) < 0) {
        return vn_fail(VN_INVALID, "root %d has no segment, which is all such a file holds; save it as .json",
                       node);
    }
    return VN_OK;
}

static vn_status check_nodes(const vn_network *network) {
    vn_sites places = {0};
    vn_status status = VN_OK;
    for (int32_t i = 0; i < vn_network_count(network) && status == VN_OK; i++) {
        status = check_node(network, &places, i);
    }
    vn_sites_free(&places);
    return status;
}

static vn_status write_row(vn_sink *sink, const vn_network *network, int32_t node) {
    double values[FIELDS];
    vn_network_position(network, node, values);
    vn_network_position(network, vn_network_parent(network)[node], values + 3);
    values[6] = vn_network_radius(network, node);
    for (int i = 0; i < FIELDS; i++) {
        VN_TRY(vn_sink_number(sink, values[i]));
        VN_TRY(vn_sink_text(sink, i < FIELDS - 1 ? " " : "\n"));
    }
    return VN_OK;
}

vn_status vn_segments_write(vn_sink *sink, const vn_networks_given *given) {
    const vn_network *network = given->networks[0];
    VN_TRY(check_nodes(network));
    for (int32_t i = 0; i < vn_network_count(network); i++) {
        if (vn_network_parent(network)[i] >= 0) {
            VN_TRY(write_row(sink, network, i));
        }
    }
    return VN_OK;
}
