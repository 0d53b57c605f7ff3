// SWC, as neuron morphologies are kept: "id type x y z radius parent" a line. Trees only.
#include "file/draft.h"
#include "file/lines.h"
#include "file/names.h"

#include <math.h>

enum { FIELDS = 7 };

static const char *const field_names[FIELDS] = {"id", "type", "x", "y", "z", "radius", "parent"};

typedef struct swc_reader {
    vn_draft draft;
    vn_names ids;
    VN_ARRAY(int32_t) node_of; // of each id; -1 while only a child spoke of it
    VN_ARRAY(int32_t) above;   // each node's parent as a number of `ids`, or -1
    vn_network_set *set;
    int64_t line;
} swc_reader;

static vn_status number_of(swc_reader *reader, int32_t id, int32_t *number) {
    char text[16];
    int length = snprintf(text, sizeof text, "%d", id); // "7" and "007" are one
    VN_TRY(vn_names_number(&reader->ids, (vn_slice){text, (size_t)length}, number));
    return *number == reader->node_of.count ? vn_array_push(&reader->node_of, -1) : VN_OK;
}

static vn_status refuse_field(const swc_reader *reader, int field, vn_slice word, const char *wanted) {
    if (word.length == 0) {
        return vn_fail(VN_INVALID, "line %lld: %s is missing; a line is: id type x y z radius parent",
                       (long long)reader->line, field_names[field]);
    }
    return vn_fail(VN_INVALID, "line %lld: %s = \"%.*s\" must be %s", (long long)reader->line,
                   field_names[field], VN_SLICE(word), wanted);
}

static vn_status add_node(swc_reader *reader, int32_t id, const double values[FIELDS], int32_t parent) {
    int32_t own, above = -1;
    VN_TRY(number_of(reader, id, &own));
    if (reader->node_of.data[own] >= 0) {
        return vn_fail(VN_INVALID, "line %lld: id %d is given twice", (long long)reader->line, id);
    }
    if (parent >= 0) {
        VN_TRY(number_of(reader, parent, &above));
    }
    VN_TRY(vn_array_push(&reader->above, above));
    VN_TRY(vn_draft_node(&reader->draft, values + 2));
    int32_t node = reader->draft.x.count - 1;
    reader->node_of.data[own] = node;
    reader->draft.radius.data[node] = values[5];
    return VN_OK;
}

static vn_status read_row(swc_reader *reader, vn_slice rest) {
    double values[FIELDS];
    int32_t whole[FIELDS] = {0};
    for (int i = 0; i < FIELDS; i++) {
        bool integer = i < 2 || i == FIELDS - 1;
        vn_slice word = vn_take_word(&rest);
        if (integer ? !vn_slice_integer(word, &whole[i]) : !vn_slice_number(word, &values[i])) {
            return refuse_field(reader, i, word, integer ? "a whole number" : "a number");
        }
    }
    if (whole[0] < 0) {
        return vn_fail(VN_INVALID, "line %lld: id = %d must be 0 or more", (long long)reader->line, whole[0]);
    }
    return add_node(reader, whole[0], values, whole[FIELDS - 1]);
}

// Ours say what the columns cannot: "# unit mm", "# dim 2", "# manifest {…}".
static vn_status read_comment(swc_reader *reader, vn_slice rest) {
    int32_t dim;
    vn_slice key = vn_take_word(&rest);
    vn_slice value = vn_slice_trim(rest);
    if (vn_slice_is(key, "unit")) {
        vn_draft_unit(&reader->draft, value);
    } else if (vn_slice_is(key, "dim") && vn_slice_integer(value, &dim) && (dim == 2 || dim == 3)) {
        reader->draft.dim = dim;
    } else if (vn_slice_is(key, "manifest")) {
        return vn_network_set_manifest(reader->set, value.text, value.length);
    }
    return VN_OK;
}

static vn_status read_lines(swc_reader *reader, vn_lines *lines) {
    for (;;) {
        vn_slice line;
        VN_TRY(vn_lines_next(lines, &line));
        if (line.text == NULL) {
            return VN_OK;
        }
        reader->line = lines->number;
        line = vn_slice_trim(line);
        if (line.length > 0 && line.text[0] == '#') {
            VN_TRY(read_comment(reader, (vn_slice){line.text + 1, line.length - 1}));
        } else if (line.length > 0) {
            VN_TRY(read_row(reader, line));
        }
    }
}

// Programs that know no radii write 0.
static void forget_zero_radii(vn_draft *draft) {
    bool any = false;
    for (int32_t i = 0; i < draft->radius.count; i++) {
        any = any || draft->radius.data[i] != 0;
    }
    for (int32_t i = 0; i < draft->radius.count && !any; i++) {
        draft->radius.data[i] = NAN;
    }
}

static vn_status finish(swc_reader *reader) {
    for (int32_t i = 0; i < reader->above.count; i++) {
        int32_t above = reader->above.data[i];
        if (above >= 0 && reader->node_of.data[above] < 0) {
            vn_slice id = vn_names_name(&reader->ids, above);
            return vn_fail(VN_INVALID, "parent %.*s of node %d is no node of the file", VN_SLICE(id), i);
        }
        reader->draft.parent.data[i] = above >= 0 ? reader->node_of.data[above] : -1;
    }
    forget_zero_radii(&reader->draft);
    return vn_draft_finish(&reader->draft, reader->set);
}

vn_status vn_swc_read(vn_network_set *set, const char *path, FILE *file) {
    swc_reader reader = {.set = set};
    vn_lines *lines;
    VN_TRY(vn_lines_open(&lines, path, file));
    vn_status status = read_lines(&reader, lines);
    status = status == VN_OK ? finish(&reader) : status;
    vn_lines_close(lines);
    vn_draft_free(&reader.draft);
    vn_names_free(&reader.ids);
    vn_array_free(&reader.node_of);
    vn_array_free(&reader.above);
    return status;
}

static vn_status write_head(vn_sink *sink, const vn_network *network, const char *manifest) {
    VN_TRY(vn_sink_print(sink, "# dim %d\n", vn_network_dim(network)));
    const char *unit = vn_network_unit(network);
    if (unit[0] != '\0' && unit[strcspn(unit, "\r\n")] == '\0') {
        VN_TRY(vn_sink_print(sink, "# unit %s\n", unit));
    }
    if (manifest != NULL) {
        VN_TRY(vn_sink_text(sink, "# manifest "));
        for (const char *at = manifest; *at != '\0';
             at++) { // on one line: JSON breaks lines between its parts
            VN_TRY(vn_sink_write(sink, *at == '\n' || *at == '\r' ? " " : at, 1));
        }
        VN_TRY(vn_sink_text(sink, "\n"));
    }
    return vn_sink_text(sink, "# id type x y z radius parent\n");
}

static vn_status write_row(vn_sink *sink, const vn_network *network, int32_t node, int32_t id,
                           int32_t parent) {
    double p[3];
    vn_network_position(network, node, p);
    VN_TRY(vn_sink_integer(sink, id));
    VN_TRY(vn_sink_text(sink, " 0")); // undefined: a vessel is neither soma nor axon
    for (int i = 0; i < 4; i++) {
        VN_TRY(vn_sink_text(sink, " "));
        VN_TRY(vn_sink_number(sink, i < 3 ? p[i] : vn_network_radius(network, node)));
    }
    VN_TRY(vn_sink_text(sink, " "));
    VN_TRY(vn_sink_integer(sink, parent));
    return vn_sink_text(sink, "\n");
}

// Many readers want parents before their children: rows and ids follow the one order of the network.
vn_status vn_swc_write(vn_sink *sink, const vn_networks_given *given) {
    const vn_network *network = given->networks[0];
    VN_ARRAY(int32_t) ids = {0};
    int32_t count = vn_network_count(network);
    vn_status status = write_head(sink, network, given->manifest);
    status = status == VN_OK ? vn_array_reserve(&ids, count) : status;
    for (int32_t k = 0; k < count && status == VN_OK; k++) {
        int32_t node = vn_network_nth(network, k);
        int32_t parent = vn_network_parent(network)[node];
        ids.data[node] = k + 1;
        status = write_row(sink, network, node, k + 1, parent >= 0 ? ids.data[parent] : -1);
    }
    vn_array_free(&ids);
    return status;
}
