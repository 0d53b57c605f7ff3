// From what a JSON file said of a network to the network.
#include "file/json_reader.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

const json_row vn_json_rows[ROW_COUNT] = {
    [ROW_FORMAT] = {IN_TOP, "format", "format", A_TEXT, AT_START, false, 0},
    [ROW_VERSION] = {IN_TOP, "version", "version", A_NUMBER, AT_START, false, 0},
    [ROW_NETWORKS] = {IN_TOP, "networks", "networks", AN_OBJECT, IN_NETWORKS, false, 0},
    [ROW_MANIFEST] = {IN_TOP, "manifest", "manifest", AN_OBJECT, IN_MANIFEST, false, 0},
    [ROW_DIM] = {IN_NETWORK, "dim", "dim", A_NUMBER, AT_START, false, 0},
    [ROW_UNIT] = {IN_NETWORK, "unit", "unit", A_TEXT, AT_START, false, 0},
    [ROW_NODES] = {IN_NETWORK, "nodes", "nodes", AN_OBJECT, IN_NODES, false, 0},
    [ROW_JOINS] = {IN_NETWORK, "joins", "joins", AN_OBJECT, IN_JOINS, false, 0},
    [ROW_MURRAY] = {IN_NETWORK, "murray", "murray", AN_OBJECT, IN_MURRAY, false, 0},
    [ROW_EXPONENT] = {IN_MURRAY, "exponent", "murray.exponent", A_NUMBER, AT_START, false, 0},
    [ROW_TIP_RADIUS] = {IN_MURRAY, "tip_radius", "murray.tip_radius", A_NUMBER, AT_START, false, 0},
    [ROW_VEINLETS] = {IN_MURRAY, "veinlets", "murray.veinlets", A_NUMBER, AT_START, false, 0},
    [ROW_ORDER_RATIO] = {IN_NETWORK, "order_ratio", "order_ratio", A_NUMBER, AT_START, false, 0},
    [ROW_X] = {IN_NODES, "x", "nodes.x", A_LIST, IN_COLUMN, false, -HUGE_VAL},
    [ROW_Y] = {IN_NODES, "y", "nodes.y", A_LIST, IN_COLUMN, false, -HUGE_VAL},
    [ROW_Z] = {IN_NODES, "z", "nodes.z", A_LIST, IN_COLUMN, false, -HUGE_VAL},
    [ROW_PARENT] = {IN_NODES, "parent", "nodes.parent", A_LIST, IN_COLUMN, true, -1},
    [ROW_RADIUS] = {IN_NODES, "radius", "nodes.radius", A_LIST, IN_COLUMN, false, 0},
    [ROW_TREE] = {IN_NODES, "tree", "nodes.tree", A_LIST, IN_COLUMN, true, 0},
    [ROW_BIRTH] = {IN_NODES, "birth", "nodes.birth", A_LIST, IN_COLUMN, true, 0},
    [ROW_ORDER] = {IN_NODES, "order", "nodes.order", A_LIST, IN_COLUMN, true, 0},
    [ROW_FLOW] = {IN_NODES, "flow", "nodes.flow", A_LIST, IN_COLUMN, false, -HUGE_VAL},
    [ROW_PRESSURE] = {IN_NODES, "pressure", "nodes.pressure", A_LIST, IN_COLUMN, false, -HUGE_VAL},
    [ROW_JOIN_A] = {IN_JOINS, "a", "joins.a", A_LIST, IN_COLUMN, true, 0},
    [ROW_JOIN_B] = {IN_JOINS, "b", "joins.b", A_LIST, IN_COLUMN, true, 0},
    [ROW_JOIN_RADIUS] = {IN_JOINS, "radius", "joins.radius", A_LIST, IN_COLUMN, false, 0},
};

int32_t vn_json_column_count(json_reader *reader, row_id id) {
    const json_column *column = json_column_of(reader, id);
    return vn_json_rows[id].integers ? column->integers.count : column->numbers.count;
}

int vn_json_refuse(json_reader *reader, json_where where, const char *format, ...) {
    size_t size = sizeof reader->problem;
    int used = 0;
    if (reader->draft.name[0] != '\0') {
        used = snprintf(reader->problem, size, "network \"%.60s\": ", reader->draft.name);
    }
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(reader->problem + used, size - (size_t)used, format, arguments);
    va_end(arguments);
    for (char *at = reader->problem; *at != '\0'; at++) {
        *at = (unsigned char)*at < 0x20 ? '?' : *at;
    }
    reader->located = where == HERE;
    reader->status = VN_IO;
    return 0;
}

int vn_json_refuse_size(json_reader *reader, const char *what, int32_t limit) {
    vn_json_refuse(reader, HERE, "more than %d %s, which is the limit", limit, what);
    reader->status = VN_LIMIT;
    return 0;
}

// A call of the engine failed: what it says of the network is the file's fault, all else is nobody's.
static int refuse_as_engine(json_reader *reader, vn_status status) {
    if (status == VN_INVALID || status == VN_LIMIT) {
        vn_json_refuse(reader, WHOLE, "%s", vn_message());
    }
    reader->status = status == VN_INVALID ? VN_IO : status;
    return 0;
}

void vn_json_reset(json_draft *draft) {
    for (int i = 0; i < COLUMN_COUNT; i++) {
        vn_array_free(&draft->columns[i].numbers);
        vn_array_free(&draft->columns[i].integers);
    }
    uint32_t of_the_file = 1u << ROW_FORMAT | 1u << ROW_VERSION | 1u << ROW_NETWORKS | 1u << ROW_MANIFEST;
    *draft = (json_draft){.seen = draft->seen & of_the_file, .murray = vn_murray_def_default()};
}

static int check_required(json_reader *reader) {
    static const row_id required[] = {ROW_DIM, ROW_NODES, ROW_X, ROW_Y, ROW_PARENT};
    for (size_t i = 0; i < sizeof required / sizeof *required; i++) {
        if (!json_seen(reader, required[i])) {
            return vn_json_refuse(reader, WHOLE, "%s is missing", vn_json_rows[required[i]].path);
        }
    }
    if (reader->draft.dim == 3 && !json_seen(reader, ROW_Z)) {
        return vn_json_refuse(reader, WHOLE, "nodes.z is missing, and dim is 3");
    }
    if (reader->draft.dim == 2 && json_seen(reader, ROW_Z)) {
        return vn_json_refuse(reader, WHOLE, "nodes.z is given, but dim is 2; leave it out or set dim to 3");
    }
    if (json_seen(reader, ROW_PRESSURE) && !json_seen(reader, ROW_FLOW)) {
        return vn_json_refuse(reader, WHOLE, "nodes.pressure is given, but nodes.flow is missing");
    }
    if (json_seen(reader, ROW_JOINS) && json_seen(reader, ROW_JOIN_A) != json_seen(reader, ROW_JOIN_B)) {
        return vn_json_refuse(reader, WHOLE, "joins.%s is missing",
                              json_seen(reader, ROW_JOIN_A) ? "b" : "a");
    }
    return 1;
}

static int check_lengths(json_reader *reader, row_id first, row_id last) {
    int32_t count = vn_json_column_count(reader, first);
    for (row_id id = first; id <= last; id++) {
        if (json_seen(reader, id) && vn_json_column_count(reader, id) != count) {
            return vn_json_refuse(reader, WHOLE, "%s has %d entries, but %s has %d", vn_json_rows[id].path,
                                  vn_json_column_count(reader, id), vn_json_rows[first].path, count);
        }
    }
    return 1;
}

static const double *numbers(json_reader *reader, row_id id) {
    return json_seen(reader, id) ? json_column_of(reader, id)->numbers.data : NULL;
}

static const int32_t *integers(json_reader *reader, row_id id) {
    return json_seen(reader, id) ? json_column_of(reader, id)->integers.data : NULL;
}

static vn_network_columns columns_of(json_reader *reader) {
    return (vn_network_columns){
        .dim = (int)reader->draft.dim,
        .count = vn_json_column_count(reader, ROW_X),
        .x = numbers(reader, ROW_X),
        .y = numbers(reader, ROW_Y),
        .z = numbers(reader, ROW_Z),
        .parent = integers(reader, ROW_PARENT),
        .radius = numbers(reader, ROW_RADIUS),
        .birth = integers(reader, ROW_BIRTH),
        .unit = reader->draft.unit,
    };
}

static int add_joins(json_reader *reader, vn_network *network) {
    const int32_t *a = integers(reader, ROW_JOIN_A), *b = integers(reader, ROW_JOIN_B);
    const double *radii = numbers(reader, ROW_JOIN_RADIUS);
    for (int32_t i = 0; i < vn_json_column_count(reader, ROW_JOIN_A); i++) {
        vn_status status = vn_network_join(network, a[i], b[i], radii != NULL ? radii[i] : 0);
        if (status == VN_INVALID) {
            return vn_json_refuse(reader, WHOLE, "joins.a[%d] = %d and joins.b[%d] = %d: %s", i, a[i], i,
                                  b[i], vn_message());
        }
        if (status != VN_OK) {
            return refuse_as_engine(reader, status);
        }
    }
    return 1;
}

// Radii that follow a law are computed from it; radii in the file that say otherwise would be lost unseen.
static int apply_murray(json_reader *reader, vn_network *network) {
    if (!json_seen(reader, ROW_MURRAY)) {
        return 1;
    }
    vn_status status = vn_network_murray(network, &reader->draft.murray);
    if (status != VN_OK) {
        return refuse_as_engine(reader, status);
    }
    const double *radii = numbers(reader, ROW_RADIUS);
    for (int32_t i = 0; radii != NULL && i < vn_network_count(network); i++) {
        double lawful = vn_network_radius(network, i);
        if (!(fabs(radii[i] - lawful) <= 1e-6 * lawful)) {
            return vn_json_refuse(reader, WHOLE,
                                  "nodes.radius[%d] = %g, but by murray it is %g; leave out one of the two",
                                  i, radii[i], lawful);
        }
    }
    return 1;
}

// `tree` and `order` follow from the rest; they are for other programs, but must not mislead anybody.
static int check_trees(json_reader *reader, const vn_network *network) {
    const int32_t *said = integers(reader, ROW_TREE);
    const int32_t *true_trees = vn_network_tree(network);
    for (int32_t i = 0; said != NULL && i < vn_network_count(network); i++) {
        if (said[i] != true_trees[i]) {
            return vn_json_refuse(
                reader, WHOLE,
                "nodes.tree[%d] = %d, but it hangs from root number %d; correct it or leave tree out", i,
                said[i], true_trees[i]);
        }
    }
    return 1;
}

static int restore_orders(json_reader *reader, vn_network *network) {
    static const vn_order_kind kinds[] = {VN_STRAHLER, VN_HORTON, VN_HICKEY};
    const int32_t *said = integers(reader, ROW_ORDER);
    size_t size = (size_t)vn_network_count(network) * sizeof *said;
    if (said == NULL || size == 0) {
        return 1;
    }
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        vn_orders_def def = {.kind = kinds[i], .ratio = reader->draft.order_ratio};
        vn_status status = vn_network_set_orders_by(network, &def);
        if (status != VN_OK) {
            return refuse_as_engine(reader, status);
        }
        if (memcmp(vn_network_orders(network), said, size) == 0) {
            return 1;
        }
    }
    return vn_json_refuse(reader, WHOLE,
                          "nodes.order is neither Strahler's nor Horton's nor Hickey's; leave it out");
}

static int restore_flow(json_reader *reader, vn_network *network) {
    const double *flow = numbers(reader, ROW_FLOW);
    if (flow == NULL) {
        return 1;
    }
    vn_status status = vn_network_set_flow(network, flow, numbers(reader, ROW_PRESSURE));
    return status == VN_OK ? 1 : refuse_as_engine(reader, status);
}

static vn_status set_append(json_reader *reader) {
    vn_network_set *set = reader->set;
    VN_TRY(vn_network_set_extend(set));
    set->names[set->count - 1] = vn_copy_text(reader->draft.name);
    if (set->names[set->count - 1] == NULL) {
        return vn_fail_memory("a name", strlen(reader->draft.name));
    }
    vn_network_columns columns = columns_of(reader);
    return vn_network_from_columns(&set->networks[set->count - 1], &columns);
}

int vn_json_finish_network(json_reader *reader) {
    if (!check_required(reader) || !check_lengths(reader, ROW_X, ROW_PRESSURE) ||
        !check_lengths(reader, ROW_JOIN_A, ROW_JOIN_RADIUS)) {
        return 0;
    }
    vn_status status = set_append(reader);
    if (status != VN_OK) {
        return refuse_as_engine(reader, status);
    }
    vn_network *network = reader->set->networks[reader->set->count - 1];
    int good = add_joins(reader, network) && apply_murray(reader, network) && check_trees(reader, network) &&
               restore_orders(reader, network) && restore_flow(reader, network);
    if (good) {
        vn_json_reset(&reader->draft);
    }
    return good;
}

int vn_json_finish_file(json_reader *reader) {
    if (!json_seen(reader, ROW_FORMAT)) {
        return vn_json_refuse(reader, WHOLE,
                              "format is missing; the file of a network says \"format\": \"%s\"",
                              VN_JSON_NETWORK);
    }
    if (!json_seen(reader, ROW_VERSION)) {
        return vn_json_refuse(reader, WHOLE, "version is missing; this program reads version %d",
                              VN_JSON_VERSION);
    }
    if (!reader->several) {
        return json_seen(reader, ROW_NETWORKS)
                   ? vn_json_refuse(reader, WHOLE, "holds networks, but its format is \"%s\", not \"%s\"",
                                    VN_JSON_NETWORK, VN_JSON_NETWORKS)
                   : vn_json_finish_network(reader);
    }
    if (json_seen(reader, ROW_NODES)) {
        return vn_json_refuse(reader, WHOLE, "holds nodes outside its networks");
    }
    return reader->set->count > 0 ? 1 : vn_json_refuse(reader, WHOLE, "holds no network");
}
