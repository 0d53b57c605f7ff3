/// What the two halves of the JSON reader share: json_reader.c follows the parser, json_draft.c makes
/// networks of what was read.
#ifndef VN_FILE_JSON_READER_H
#define VN_FILE_JSON_READER_H

#include "base/array.h"
#include "base/text.h"
#include "file/json.h"
#include "network/network.h"

#include <yajl/yajl_gen.h>

enum {
    JSON_CHUNK = 32768,
    MAX_DEPTH = 64,        // yajl's own stack grows with the nesting, without a limit
    MAX_SILENCE = 1 << 22, // bytes of one text: yajl buffers it whole, and reads it again at each chunk
    MAX_TEXT = 256,        // of a name or a unit
    MAX_MANIFEST = 1 << 24,
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
    IN_MANIFEST,
    IN_UNKNOWN, // whatever an unknown key holds
} json_place;

typedef enum json_kind { A_NULL, A_BOOLEAN, A_NUMBER, A_TEXT, A_LIST, AN_OBJECT } json_kind;

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
    ROW_MANIFEST,
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
    ROW_FLOW,
    ROW_PRESSURE,
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

extern const json_row vn_json_rows[ROW_COUNT];

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
    yajl_gen manifest; // writes again what the file says there

    int64_t bytes, lines; // before the chunk
    size_t silence;       // bytes since the parser last called back
    unsigned char chunk[JSON_CHUNK];
} json_reader;

static inline json_column *json_column_of(json_reader *reader, row_id id) {
    return &reader->draft.columns[id - ROW_X];
}

static inline bool json_seen(const json_reader *reader, row_id id) {
    return (reader->draft.seen >> id & 1) != 0;
}

int32_t vn_json_column_count(json_reader *reader, row_id id);

/// Problems: one line each, which the reader completes with the file's name. All return 0, which stops yajl.
/// `where` says whether the place where the parser stands is the place to look at.
int vn_json_refuse(json_reader *reader, json_where where, const char *format, ...) VN_PRINTF(3, 4);
int vn_json_refuse_size(json_reader *reader, const char *what, int32_t limit);

/// Forget the network that was read so far.
void vn_json_reset(json_draft *draft);
/// At its end: into the set; and at the end of the file.
int vn_json_finish_network(json_reader *reader);
int vn_json_finish_file(json_reader *reader);

#endif
