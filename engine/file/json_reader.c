// The file streams through yajl in chunks; what is kept of it are the columns of the network being read.
#include "base/array.h"
#include "base/text.h"
#include "file/json.h"
#include "network/network.h"
#include "venule/output.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <yajl/yajl_parse.h>

enum {
    CHUNK = 32768,
    MAX_DEPTH = 64,        // yajl's own stack grows with the nesting, without a limit
    MAX_SILENCE = 1 << 22, // bytes of one text: yajl buffers it whole, and reads it again at each chunk
    MAX_TEXT = 256,        // of a name or a unit
};

typedef enum json_place {
    AT_START,
    IN_TOP,
    IN_NETWORKS,
    IN_NETWORK,
    IN_NODES,
    IN_JOINS,
    IN_MURRAY,
    IN_COLUMN,
    IN_UNKNOWN, // whatever an unknown key holds
} json_place;

typedef enum json_kind { A_NULL, A_BOOLEAN, A_NUMBER, A_TEXT, A_LIST, AN_OBJECT } json_kind;

static const char *const kind_names[] = {"null",   "true or false", "a number",
                                         "a text", "a list",        "an object"};

typedef enum json_where { HERE, WHOLE } json_where;

typedef struct json_token {
    json_kind kind;
    const char *text; // of a number or a text; not ended by a zero byte
    size_t length;
} json_token;

typedef enum row_id {
    ROW_FORMAT,
    ROW_VERSION,
    ROW_NETWORKS,
    ROW_DIM,
    ROW_UNIT,
    ROW_NODES,
    ROW_JOINS,
    ROW_MURRAY,
    ROW_EXPONENT,
    ROW_TIP_RADIUS,
    ROW_VEINLETS,
    ROW_ORDER_RATIO,
    ROW_X, // from here on: columns
    ROW_Y,
    ROW_Z,
    ROW_PARENT,
    ROW_RADIUS,
    ROW_TREE,
    ROW_BIRTH,
    ROW_ORDER,
    ROW_JOIN_A,
    ROW_JOIN_B,
    ROW_JOIN_RADIUS,
    ROW_COUNT,
    COLUMN_COUNT = ROW_COUNT - ROW_X,
} row_id;

// A key that is known, where it may stand, and what must follow it.
typedef struct json_row {
    json_place in;
    const char *name;
    const char *path;
    json_kind want;
    json_place inside; // of an object or a list
    bool integers;     // in a list
    double min;        // in a list
} json_row;

static const json_row rows[ROW_COUNT] = {
    [ROW_FORMAT] = {IN_TOP, "format", "format", A_TEXT, AT_START, false, 0},
    [ROW_VERSION] = {IN_TOP, "version", "version", A_NUMBER, AT_START, false, 0},
    [ROW_NETWORKS] = {IN_TOP, "networks", "networks", AN_OBJECT, IN_NETWORKS, false, 0},
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
    [ROW_JOIN_A] = {IN_JOINS, "a", "joins.a", A_LIST, IN_COLUMN, true, 0},
    [ROW_JOIN_B] = {IN_JOINS, "b", "joins.b", A_LIST, IN_COLUMN, true, 0},
    [ROW_JOIN_RADIUS] = {IN_JOINS, "radius", "joins.radius", A_LIST, IN_COLUMN, false, 0},
};

// One of the two is in use, as the row says.
typedef struct json_column {
    VN_ARRAY(double) numbers;
    VN_ARRAY(int32_t) integers;
} json_column;

// One network, as far as it was read.
typedef struct json_draft {
    uint32_t seen; // a bit a row
    double dim;
    char unit[MAX_TEXT];
    char name[MAX_TEXT];
    vn_murray_def murray;
    double order_ratio;
    json_column columns[COLUMN_COUNT];
} json_draft;

typedef struct json_reader {
    const char *path;
    vn_network_set *set;
    vn_status status;
    char problem[400];
    bool located; // the problem is where the parser stands now

    json_place places[MAX_DEPTH];
    int depth;
    row_id key;  // whose value comes next; ROW_COUNT: an unknown one's
    row_id open; // the column being read
    bool several;
    double version;
    int32_t max_nodes;
    json_draft draft;

    int64_t bytes, lines; // before the chunk
    size_t silence;       // bytes since the parser last called back
    unsigned char chunk[CHUNK];
} json_reader;

static json_column *column_of(json_reader *reader, row_id id) {
    return &reader->draft.columns[id - ROW_X];
}

static bool seen(const json_reader *reader, row_id id) {
    return (reader->draft.seen >> id & 1) != 0;
}

static int32_t column_count(json_reader *reader, row_id id) {
    const json_column *column = column_of(reader, id);
    return rows[id].integers ? column->integers.count : column->numbers.count;
}

// Problems: one line each, which vn_networks_load() completes with the file's name. All return 0, which
// stops yajl.

// `where` says whether the place where the parser stands is the place to look at.
VN_PRINTF(3, 4) static int refuse(json_reader *reader, json_where where, const char *format, ...) {
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

static int refuse_size(json_reader *reader, const char *what, int32_t limit) {
    refuse(reader, HERE, "more than %d %s, which is the limit", limit, what);
    reader->status = VN_LIMIT;
    return 0;
}

// A call of the engine failed: what it says of the network is the file's fault, all else is nobody's.
static int refuse_as_engine(json_reader *reader, vn_status status) {
    if (status == VN_INVALID || status == VN_LIMIT) {
        refuse(reader, WHOLE, "%s", vn_message());
    }
    reader->status = status == VN_INVALID ? VN_IO : status;
    return 0;
}

static void describe(char *text, size_t size, const json_token *token) {
    int shown = token->length > 40 ? 40 : (int)token->length;
    if (token->kind == A_NUMBER) {
        snprintf(text, size, "%.*s", shown, token->text);
    } else if (token->kind == A_TEXT) {
        snprintf(text, size, "\"%.*s\"", shown, token->text);
    } else {
        snprintf(text, size, "%s", kind_names[token->kind]);
    }
}

static int refuse_kind(json_reader *reader, const char *what, json_kind want, const json_token *token) {
    char found[64];
    describe(found, sizeof found, token);
    return refuse(reader, HERE, "%s is %s, but must be %s", what, found, kind_names[want]);
}

static void draft_reset(json_draft *draft) {
    for (int i = 0; i < COLUMN_COUNT; i++) {
        vn_array_free(&draft->columns[i].numbers);
        vn_array_free(&draft->columns[i].integers);
    }
    uint32_t of_the_file = 1u << ROW_FORMAT | 1u << ROW_VERSION | 1u << ROW_NETWORKS;
    *draft = (json_draft){.seen = draft->seen & of_the_file, .murray = vn_murray_def_default()};
}

static int check_required(json_reader *reader) {
    static const row_id required[] = {ROW_DIM, ROW_NODES, ROW_X, ROW_Y, ROW_PARENT};
    for (size_t i = 0; i < sizeof required / sizeof *required; i++) {
        if (!seen(reader, required[i])) {
            return refuse(reader, WHOLE, "%s is missing", rows[required[i]].path);
        }
    }
    if (reader->draft.dim == 3 && !seen(reader, ROW_Z)) {
        return refuse(reader, WHOLE, "nodes.z is missing, and dim is 3");
    }
    if (reader->draft.dim == 2 && seen(reader, ROW_Z)) {
        return refuse(reader, WHOLE, "nodes.z is given, but dim is 2; leave it out or set dim to 3");
    }
    if (seen(reader, ROW_JOINS) && seen(reader, ROW_JOIN_A) != seen(reader, ROW_JOIN_B)) {
        return refuse(reader, WHOLE, "joins.%s is missing", seen(reader, ROW_JOIN_A) ? "b" : "a");
    }
    return 1;
}

static int check_lengths(json_reader *reader, row_id first, row_id last) {
    int32_t count = column_count(reader, first);
    for (row_id id = first; id <= last; id++) {
        if (seen(reader, id) && column_count(reader, id) != count) {
            return refuse(reader, WHOLE, "%s has %d entries, but %s has %d", rows[id].path,
                          column_count(reader, id), rows[first].path, count);
        }
    }
    return 1;
}

static const double *numbers(json_reader *reader, row_id id) {
    return seen(reader, id) ? column_of(reader, id)->numbers.data : NULL;
}

static const int32_t *integers(json_reader *reader, row_id id) {
    return seen(reader, id) ? column_of(reader, id)->integers.data : NULL;
}

static vn_network_columns columns_of(json_reader *reader) {
    return (vn_network_columns){
        .dim = (int)reader->draft.dim,
        .count = column_count(reader, ROW_X),
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
    for (int32_t i = 0; i < column_count(reader, ROW_JOIN_A); i++) {
        vn_status status = vn_network_join(network, a[i], b[i], radii != NULL ? radii[i] : 0);
        if (status == VN_INVALID) {
            return refuse(reader, WHOLE, "joins.a[%d] = %d and joins.b[%d] = %d: %s", i, a[i], i, b[i],
                          vn_message());
        }
        if (status != VN_OK) {
            return refuse_as_engine(reader, status);
        }
    }
    return 1;
}

// Radii that follow a law are computed from it; radii in the file that say otherwise would be lost unseen.
static int apply_murray(json_reader *reader, vn_network *network) {
    if (!seen(reader, ROW_MURRAY)) {
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
            return refuse(reader, WHOLE,
                          "nodes.radius[%d] = %g, but by murray it is %g; leave out one of the two", i,
                          radii[i], lawful);
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
            return refuse(
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
    return refuse(reader, WHOLE, "nodes.order is neither Strahler's nor Horton's nor Hickey's; leave it out");
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

static int finish_network(json_reader *reader) {
    if (!check_required(reader) || !check_lengths(reader, ROW_X, ROW_ORDER) ||
        !check_lengths(reader, ROW_JOIN_A, ROW_JOIN_RADIUS)) {
        return 0;
    }
    vn_status status = set_append(reader);
    if (status != VN_OK) {
        return refuse_as_engine(reader, status);
    }
    vn_network *network = reader->set->networks[reader->set->count - 1];
    int good = add_joins(reader, network) && apply_murray(reader, network) && check_trees(reader, network) &&
               restore_orders(reader, network);
    if (good) {
        draft_reset(&reader->draft);
    }
    return good;
}

static int finish_file(json_reader *reader) {
    if (!seen(reader, ROW_FORMAT)) {
        return refuse(reader, WHOLE, "format is missing; the file of a network says \"format\": \"%s\"",
                      VN_JSON_NETWORK);
    }
    if (!seen(reader, ROW_VERSION)) {
        return refuse(reader, WHOLE, "version is missing; this program reads version %d", VN_JSON_VERSION);
    }
    if (!reader->several) {
        return seen(reader, ROW_NETWORKS)
                   ? refuse(reader, WHOLE, "holds networks, but its format is \"%s\", not \"%s\"",
                            VN_JSON_NETWORK, VN_JSON_NETWORKS)
                   : finish_network(reader);
    }
    if (seen(reader, ROW_NODES)) {
        return refuse(reader, WHOLE, "holds nodes outside its networks");
    }
    return reader->set->count > 0 ? 1 : refuse(reader, WHOLE, "holds no network");
}

static json_place place_of(const json_reader *reader) {
    return reader->depth > 0 ? reader->places[reader->depth - 1] : AT_START;
}

// The value that comes now, as messages call it: "nodes.x[3]".
typedef struct json_path {
    char text[48];
} json_path;

static json_path path_of(json_reader *reader) {
    json_path path;
    if (place_of(reader) == IN_COLUMN) {
        snprintf(path.text, sizeof path.text, "%s[%d]", rows[reader->open].path,
                 column_count(reader, reader->open));
    } else {
        snprintf(path.text, sizeof path.text, "%s", rows[reader->key].path);
    }
    return path;
}

static int enter(json_reader *reader, json_place place) {
    if (reader->depth == MAX_DEPTH) {
        return refuse(reader, HERE, "is nested more than %d deep", MAX_DEPTH);
    }
    reader->places[reader->depth++] = place;
    return 1;
}

// A version is judged when both are known, so that somebody else's "version" is not taken for ours.
static int check_version(json_reader *reader) {
    if (!seen(reader, ROW_FORMAT) || !seen(reader, ROW_VERSION) || reader->version == VN_JSON_VERSION) {
        return 1;
    }
    if (reader->version > VN_JSON_VERSION) {
        return refuse(reader, HERE, "version %g is newer than this program reads (%d)", reader->version,
                      VN_JSON_VERSION);
    }
    return refuse(reader, HERE, "version %g does not exist; this program reads %d", reader->version,
                  VN_JSON_VERSION);
}

static bool is_text(const json_token *token, const char *text) {
    return token->length == strlen(text) && memcmp(token->text, text, token->length) == 0;
}

static int take_format(json_reader *reader, const json_token *token) {
    reader->several = is_text(token, VN_JSON_NETWORKS);
    if (!reader->several && !is_text(token, VN_JSON_NETWORK)) {
        char found[64];
        describe(found, sizeof found, token);
        return refuse(reader, HERE, "format is %s, not \"%s\" or \"%s\"", found, VN_JSON_NETWORK,
                      VN_JSON_NETWORKS);
    }
    return check_version(reader);
}

// Into text[MAX_TEXT].
static int copy_text(json_reader *reader, char *text, const char *what, const json_token *token) {
    if (token->length >= MAX_TEXT || memchr(token->text, '\0', token->length) != NULL) {
        return refuse(reader, HERE, "%s must have less than %d bytes, none of them zero", what, MAX_TEXT);
    }
    memcpy(text, token->text, token->length);
    text[token->length] = '\0';
    return 1;
}

static int read_number(json_reader *reader, const json_token *token, double *value) {
    const char *end = token->text + token->length;
    if (vn_parse_number(token->text, end, value) == end) {
        return 1;
    }
    char found[64];
    describe(found, sizeof found, token);
    return refuse(reader, HERE, "%s = %s is beyond the range of numbers", path_of(reader).text, found);
}

static int take_number(json_reader *reader, const json_token *token) {
    double value;
    if (!read_number(reader, token, &value)) {
        return 0;
    }
    switch (reader->key) {
    case ROW_VERSION:
        reader->version = value;
        return check_version(reader);
    case ROW_EXPONENT:
        reader->draft.murray.exponent = value;
        return 1;
    case ROW_TIP_RADIUS:
        reader->draft.murray.tip_radius = value;
        return 1;
    case ROW_VEINLETS:
        reader->draft.murray.veinlets = value;
        return 1;
    case ROW_ORDER_RATIO:
        reader->draft.order_ratio = value;
        return 1;
    default:
        reader->draft.dim = value;
        return value == 2 || value == 3 ? 1 : refuse(reader, HERE, "dim = %g must be 2 or 3", value);
    }
}

static int take_member(json_reader *reader, const json_token *token) {
    bool opens = token->kind >= A_LIST;
    if (reader->key == ROW_COUNT) {
        return opens ? enter(reader, IN_UNKNOWN) : 1;
    }
    const json_row *row = &rows[reader->key];
    if (token->kind != row->want) {
        return refuse_kind(reader, row->path, row->want, token);
    }
    if (opens) {
        reader->open = reader->key;
        return enter(reader, row->inside);
    }
    if (token->kind == A_NUMBER) {
        return take_number(reader, token);
    }
    return reader->key == ROW_FORMAT ? take_format(reader, token)
                                     : copy_text(reader, reader->draft.unit, row->path, token);
}

static int push_entry(json_reader *reader, double value) {
    const json_row *row = &rows[reader->open];
    json_column *column = column_of(reader, reader->open);
    if (!(value >= row->min)) {
        return refuse(reader, HERE, "%s = %g must be %g or more", path_of(reader).text, value, row->min);
    }
    if (row->integers && (value != floor(value) || value >= INT32_MAX)) {
        return refuse(reader, HERE, "%s = %g must be a whole number below %d", path_of(reader).text, value,
                      INT32_MAX);
    }
    reader->status = row->integers ? vn_array_push(&column->integers, (int32_t)value)
                                   : vn_array_push(&column->numbers, value);
    return reader->status == VN_OK;
}

static int take_entry(json_reader *reader, const json_token *token) {
    double value;
    if (token->kind != A_NUMBER) {
        return refuse_kind(reader, path_of(reader).text, A_NUMBER, token);
    }
    if (column_count(reader, reader->open) >= reader->max_nodes) {
        return refuse_size(reader, "entries in a list", reader->max_nodes);
    }
    return read_number(reader, token, &value) && push_entry(reader, value);
}

static int take(void *context, const json_token *token) {
    json_reader *reader = context;
    reader->silence = 0;
    switch (place_of(reader)) {
    case AT_START:
        return token->kind == AN_OBJECT ? enter(reader, IN_TOP)
                                        : refuse_kind(reader, "the whole", AN_OBJECT, token);
    case IN_NETWORKS:
        return token->kind == AN_OBJECT ? enter(reader, IN_NETWORK)
                                        : refuse_kind(reader, "it", AN_OBJECT, token);
    case IN_COLUMN:
        return take_entry(reader, token);
    case IN_UNKNOWN:
        return token->kind >= A_LIST ? enter(reader, IN_UNKNOWN) : 1;
    default:
        return take_member(reader, token);
    }
}

// The whole file may be a network itself, so its keys are a network's too.
static bool may_stand(json_place in, json_place here) {
    return in == here || (in == IN_NETWORK && here == IN_TOP);
}

static int take_key(json_reader *reader, const json_token *key) {
    json_place here = place_of(reader);
    for (row_id id = 0; id < ROW_COUNT; id++) {
        if (may_stand(rows[id].in, here) && is_text(key, rows[id].name)) {
            if (seen(reader, id)) {
                return refuse(reader, HERE, "%s is given twice", rows[id].path);
            }
            reader->draft.seen |= 1u << id;
            reader->key = id;
            return 1;
        }
    }
    reader->key = ROW_COUNT;
    return 1;
}

static int begin_network(json_reader *reader, const json_token *name) {
    if (seen(reader, ROW_NODES)) {
        return refuse(reader, HERE, "holds nodes outside its networks");
    }
    if (reader->set->count >= VN_JSON_MAX_NETWORKS) {
        return refuse_size(reader, "networks", VN_JSON_MAX_NETWORKS);
    }
    draft_reset(&reader->draft);
    if (!copy_text(reader, reader->draft.name, "the name of a network", name)) {
        return 0;
    }
    if (name->length == 0) {
        return refuse(reader, HERE, "a network among others needs a name");
    }
    for (int32_t i = 0; i < reader->set->count; i++) {
        if (strcmp(reader->set->names[i], reader->draft.name) == 0) {
            return refuse(reader, HERE, "is given twice");
        }
    }
    return 1;
}

static int on_null(void *context) {
    return take(context, &(json_token){A_NULL, "", 0});
}

static int on_boolean(void *context, int value) {
    (void)value;
    return take(context, &(json_token){A_BOOLEAN, "", 0});
}

static int on_number(void *context, const char *text, size_t length) {
    return take(context, &(json_token){A_NUMBER, text, length});
}

static int on_string(void *context, const unsigned char *text, size_t length) {
    return take(context, &(json_token){A_TEXT, (const char *)text, length});
}

static int on_object(void *context) {
    return take(context, &(json_token){AN_OBJECT, "", 0});
}

static int on_list(void *context) {
    return take(context, &(json_token){A_LIST, "", 0});
}

static int on_key(void *context, const unsigned char *text, size_t length) {
    json_reader *reader = context;
    json_token key = {A_TEXT, (const char *)text, length};
    reader->silence = 0;
    switch (place_of(reader)) {
    case IN_UNKNOWN:
        return 1;
    case IN_NETWORKS:
        return begin_network(reader, &key);
    default:
        return take_key(reader, &key);
    }
}

static int on_end(void *context) {
    json_reader *reader = context;
    json_place ended = place_of(reader);
    reader->silence = 0;
    reader->depth--;
    if (ended == IN_TOP) {
        return finish_file(reader);
    }
    return ended == IN_NETWORK ? finish_network(reader) : 1;
}

static const yajl_callbacks callbacks = {
    .yajl_null = on_null,
    .yajl_boolean = on_boolean,
    .yajl_number = on_number,
    .yajl_string = on_string,
    .yajl_start_map = on_object,
    .yajl_map_key = on_key,
    .yajl_end_map = on_end,
    .yajl_start_array = on_list,
    .yajl_end_array = on_end,
};

static int64_t lines_in(const unsigned char *bytes, size_t count) {
    int64_t lines = 0;
    for (size_t i = 0; i < count; i++) {
        lines += bytes[i] == '\n';
    }
    return lines;
}

static void refuse_syntax(json_reader *reader, yajl_handle parser) {
    unsigned char *said = yajl_get_error(parser, 0, NULL, 0);
    const char *reason = said != NULL ? (const char *)said : "";
    if (strstr(reason, "premature EOF") != NULL) {
        refuse(reader, HERE, "the file ends too early; it is empty or was cut off");
    } else {
        refuse(reader, HERE, "not JSON: %.*s", (int)strcspn(reason, "\n"), reason);
    }
    yajl_free_error(parser, said);
}

static vn_status fail_parse(json_reader *reader, yajl_handle parser, yajl_status parsed) {
    if (parsed == yajl_status_error) {
        refuse_syntax(reader, parser);
    }
    if (reader->problem[0] == '\0') {
        return reader->status; // its message is set
    }
    if (!reader->located) {
        return vn_fail(reader->status, "%s: %s", reader->path, reader->problem);
    }
    size_t consumed = yajl_get_bytes_consumed(parser);
    long long line = (long long)(reader->lines + lines_in(reader->chunk, consumed)) + 1;
    long long byte = (long long)reader->bytes + (long long)consumed;
    return vn_fail(reader->status, "%s: line %lld, byte %lld: %s", reader->path, line, byte, reader->problem);
}

static vn_status parse_chunk(json_reader *reader, yajl_handle parser, size_t count) {
    reader->silence += count;
    yajl_status parsed = yajl_parse(parser, reader->chunk, count);
    if (parsed != yajl_status_ok) {
        return fail_parse(reader, parser, parsed);
    }
    if (reader->silence > MAX_SILENCE) {
        return vn_fail(VN_LIMIT, "%s: byte %lld: a text of more than %d bytes, which is the limit",
                       reader->path, (long long)reader->bytes, MAX_SILENCE);
    }
    reader->bytes += (int64_t)count;
    reader->lines += lines_in(reader->chunk, count);
    return vn_poll();
}

static vn_status parse_end(json_reader *reader, yajl_handle parser) {
    reader->chunk[0] = ' '; // which is what yajl now feeds itself
    yajl_status parsed = yajl_complete_parse(parser);
    return parsed == yajl_status_ok ? VN_OK : fail_parse(reader, parser, parsed);
}

// Some editors on Windows begin a file with a byte order mark.
static void blank_mark(json_reader *reader, size_t count) {
    if (reader->bytes == 0 && count >= 3 && memcmp(reader->chunk, "\xEF\xBB\xBF", 3) == 0) {
        memset(reader->chunk, ' ', 3);
    }
}

static vn_status parse_file(json_reader *reader, yajl_handle parser, FILE *file) {
    size_t count;
    while ((count = fread(reader->chunk, 1, CHUNK, file)) > 0) {
        blank_mark(reader, count);
        VN_TRY(parse_chunk(reader, parser, count));
    }
    if (ferror(file)) {
        return vn_fail(VN_IO, "%s: cannot be read: %s", reader->path, strerror(errno));
    }
    return parse_end(reader, parser);
}

static vn_status read_file(vn_network_set *set, const char *path, FILE *file) {
    json_reader *reader = VN_NEW(json_reader);
    yajl_handle parser = yajl_alloc(&callbacks, NULL, reader);
    vn_status status = VN_OK;
    if (reader != NULL && parser != NULL) {
        reader->path = path;
        reader->set = set;
        reader->max_nodes = vn_network_def_default().max_nodes;
        draft_reset(&reader->draft);
        status = parse_file(reader, parser, file);
        draft_reset(&reader->draft);
    } else {
        status = vn_fail_memory("a JSON reader", sizeof *reader);
    }
    if (parser != NULL) {
        yajl_free(parser);
    }
    VN_DELETE(reader);
    return status;
}

vn_status vn_networks_load(vn_network_set *out, const char *path) {
    *out = (vn_network_set){0};
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return vn_fail(VN_IO, "%s: cannot be read: %s", path, strerror(errno));
    }
    vn_status status = read_file(out, path, file);
    fclose(file);
    if (status != VN_OK) {
        vn_networks_free(out);
    }
    return status;
}
