// A table: a header, then a row a node. Trees only.
#include "file/draft.h"
#include "file/lines.h"

#include <math.h>

typedef enum csv_column {
    X,
    Y,
    Z,
    PARENT,
    RADIUS,
    FLOW,
    PRESSURE,
    ORDER,
    TREE,
    BIRTH,
    COLUMNS,
    SKIPPED = COLUMNS, // nobody's
} csv_column;

static const char *const column_names[COLUMNS] = {"x",    "y",        "z",     "parent", "radius",
                                                  "flow", "pressure", "order", "tree",   "birth"};

enum { MOST_FIELDS = 4096 };

typedef struct csv_reader {
    vn_draft draft;
    char separator;
    uint8_t column_of[MOST_FIELDS]; // of each field of a row
    int fields;
    bool has[COLUMNS];
    long long line;
} csv_reader;

// What the header has most of.
static char find_separator(vn_slice header) {
    static const char separators[] = {',', ';', '\t'};
    int most = 0;
    char found = ',';
    for (size_t k = 0; k < sizeof separators; k++) {
        int count = 0;
        for (size_t i = 0; i < header.length; i++) {
            count += header.text[i] == separators[k];
        }
        found = count > most ? separators[k] : found;
        most = count > most ? count : most;
    }
    return found;
}

static vn_status read_name(csv_reader *reader, vn_slice name) {
    csv_column found = SKIPPED;
    for (csv_column i = X; i < COLUMNS; i++) {
        if (vn_slice_is(name, column_names[i])) {
            found = i;
        }
    }
    if (reader->fields == MOST_FIELDS) {
        return vn_fail(VN_INVALID, "the header has more than %d columns, which is the limit", MOST_FIELDS);
    }
    if (found != SKIPPED && reader->has[found]) {
        return vn_fail(VN_INVALID, "the header has the column %s twice", column_names[found]);
    }
    if (found != SKIPPED) {
        reader->has[found] = true;
    }
    reader->column_of[reader->fields++] = (uint8_t)found;
    return VN_OK;
}

static vn_status read_header(csv_reader *reader, vn_slice rest) {
    static const csv_column required[] = {X, Y, PARENT};
    vn_slice name;
    reader->separator = find_separator(rest);
    while (vn_take_field(&rest, reader->separator, &name)) {
        VN_TRY(read_name(reader, name));
    }
    for (size_t i = 0; i < sizeof required / sizeof *required; i++) {
        if (!reader->has[required[i]]) {
            return vn_fail(VN_INVALID, "the header has no column %s; the first line names the columns",
                           column_names[required[i]]);
        }
    }
    reader->draft.dim = reader->has[Z] ? 3 : 2;
    return VN_OK;
}

// Empty fields of what need not be known are unknown.
static vn_status read_field(const csv_reader *reader, vn_slice field, csv_column column, double *value) {
    int32_t whole = 0;
    bool integer = column == PARENT || column == BIRTH;
    if (field.length == 0 && column >= RADIUS && column <= PRESSURE) {
        *value = NAN;
        return VN_OK;
    }
    bool good = integer ? vn_slice_integer(field, &whole) : vn_slice_number(field, value);
    if (!good) {
        return vn_fail(VN_INVALID, "line %lld: %s = \"%.*s\" must be a %snumber", reader->line,
                       column_names[column], VN_SLICE(field), integer ? "whole " : "");
    }
    if (column == BIRTH && whole < 0) {
        return vn_fail(VN_INVALID, "line %lld: birth = %d must be 0 or more", reader->line, whole);
    }
    *value = integer ? whole : *value;
    return VN_OK;
}

static vn_status keep_row(csv_reader *reader, const double values[COLUMNS]) {
    vn_draft *draft = &reader->draft;
    VN_TRY(vn_draft_node(draft, values));
    int32_t node = draft->x.count - 1;
    draft->parent.data[node] = (int32_t)values[PARENT];
    draft->radius.data[node] = values[RADIUS];
    draft->flow.data[node] = values[FLOW];
    draft->pressure.data[node] = values[PRESSURE];
    return reader->has[BIRTH] ? vn_array_push(&draft->birth, (int32_t)values[BIRTH]) : VN_OK;
}

static vn_status read_row(csv_reader *reader, vn_slice rest) {
    double values[COLUMNS + 1] = {[RADIUS] = NAN, [FLOW] = NAN, [PRESSURE] = NAN};
    vn_slice field;
    int fields = 0;
    for (; vn_take_field(&rest, reader->separator, &field); fields++) {
        csv_column column = fields < reader->fields ? (csv_column)reader->column_of[fields] : SKIPPED;
        if (column != SKIPPED && column != ORDER && column != TREE) { // these two follow from the rest
            VN_TRY(read_field(reader, field, column, &values[column]));
        }
    }
    if (fields != reader->fields) {
        return vn_fail(VN_INVALID, "line %lld: has %d fields, but the header has %d", reader->line, fields,
                       reader->fields);
    }
    return keep_row(reader, values);
}

static vn_status read_lines(csv_reader *reader, vn_lines *lines) {
    for (;;) {
        vn_slice line;
        VN_TRY(vn_lines_next(lines, &line));
        if (line.text == NULL) {
            break;
        }
        reader->line = lines->number;
        if (reader->fields == 0) {
            VN_TRY(read_header(reader, line));
        } else if (vn_slice_trim(line).length > 0) {
            VN_TRY(read_row(reader, line));
        }
    }
    return reader->fields > 0 ? VN_OK : vn_fail(VN_INVALID, "the file is empty");
}

static vn_status read_table(csv_reader *reader, vn_network_set *set, vn_lines *lines) {
    VN_TRY(read_lines(reader, lines));
    return vn_draft_finish(&reader->draft, set);
}

vn_status vn_csv_read(vn_network_set *set, const char *path, FILE *file) {
    csv_reader reader = {0};
    vn_lines *lines;
    VN_TRY(vn_lines_open(&lines, path, file));
    vn_status status = read_table(&reader, set, lines);
    vn_lines_close(lines);
    vn_draft_free(&reader.draft);
    return status;
}

static bool is_there(const vn_network *network, csv_column column) {
    switch (column) {
    case Z:
        return vn_network_dim(network) == 3;
    case RADIUS:
        return vn_network_has_radii(network);
    case FLOW:
        return vn_network_flow(network) != NULL;
    case PRESSURE:
        return vn_network_pressure(network) != NULL;
    case ORDER:
        return vn_network_orders(network) != NULL;
    default:
        return true;
    }
}

static vn_status write_value(vn_sink *sink, const vn_network *network, csv_column column, int32_t node) {
    switch (column) {
    case X:
        return vn_sink_number(sink, vn_network_x(network)[node]);
    case Y:
        return vn_sink_number(sink, vn_network_y(network)[node]);
    case Z:
        return vn_sink_number(sink, vn_network_z(network)[node]);
    case PARENT:
        return vn_sink_integer(sink, vn_network_parent(network)[node]);
    case RADIUS:
        return vn_sink_number(sink, vn_network_radius(network, node));
    case FLOW:
        return vn_sink_number(sink, vn_network_flow(network)[node]);
    case PRESSURE:
        return vn_sink_number(sink, vn_network_pressure(network)[node]);
    case ORDER:
        return vn_sink_integer(sink, vn_network_orders(network)[node]);
    case TREE:
        return vn_sink_integer(sink, vn_network_tree(network)[node]);
    default:
        return vn_sink_integer(sink, vn_network_birth(network)[node]);
    }
}

// Node -1 is the header.
static vn_status write_row(vn_sink *sink, const vn_network *network, int32_t node) {
    for (csv_column column = X; column < COLUMNS; column++) {
        if (is_there(network, column)) {
            VN_TRY(column > X ? vn_sink_text(sink, ",") : VN_OK);
            VN_TRY(node < 0 ? vn_sink_text(sink, column_names[column])
                            : write_value(sink, network, column, node));
        }
    }
    return vn_sink_text(sink, "\n");
}

vn_status vn_csv_write(vn_sink *sink, const vn_networks_given *given) {
    for (int32_t i = -1; i < vn_network_count(given->networks[0]); i++) {
        VN_TRY(write_row(sink, given->networks[0], i));
    }
    return VN_OK;
}
