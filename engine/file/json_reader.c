// The file streams through yajl in chunks; what is kept of it are the columns of the network being read.
#include "file/json_reader.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <yajl/yajl_parse.h>

static const char *const kind_names[] = {"null",   "true or false", "a number",
                                         "a text", "a list",        "an object"};

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
    return vn_json_refuse(reader, HERE, "%s is %s, but must be %s", what, found, kind_names[want]);
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
        snprintf(path.text, sizeof path.text, "%s[%d]", vn_json_rows[reader->open].path,
                 vn_json_column_count(reader, reader->open));
    } else {
        snprintf(path.text, sizeof path.text, "%s", vn_json_rows[reader->key].path);
    }
    return path;
}

static int enter(json_reader *reader, json_place place) {
    if (reader->depth == MAX_DEPTH) {
        return vn_json_refuse(reader, HERE, "is nested more than %d deep", MAX_DEPTH);
    }
    reader->places[reader->depth++] = place;
    return 1;
}

// A version is judged when both are known, so that somebody else's "version" is not taken for ours.
static int check_version(json_reader *reader) {
    if (!json_seen(reader, ROW_FORMAT) || !json_seen(reader, ROW_VERSION) ||
        reader->version == VN_JSON_VERSION) {
        return 1;
    }
    if (reader->version > VN_JSON_VERSION) {
        return vn_json_refuse(reader, HERE, "version %g is newer than this program reads (%d)",
                              reader->version, VN_JSON_VERSION);
    }
    return vn_json_refuse(reader, HERE, "version %g does not exist; this program reads %d", reader->version,
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
        return vn_json_refuse(reader, HERE, "format is %s, not \"%s\" or \"%s\"", found, VN_JSON_NETWORK,
                              VN_JSON_NETWORKS);
    }
    return check_version(reader);
}

// Into text[MAX_TEXT].
static int copy_text(json_reader *reader, char *text, const char *what, const json_token *token) {
    if (token->length >= MAX_TEXT || memchr(token->text, '\0', token->length) != NULL) {
        return vn_json_refuse(reader, HERE, "%s must have less than %d bytes, none of them zero", what,
                              MAX_TEXT);
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
    return vn_json_refuse(reader, HERE, "%s = %s is beyond the range of numbers", path_of(reader).text,
                          found);
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
        return value == 2 || value == 3 ? 1 : vn_json_refuse(reader, HERE, "dim = %g must be 2 or 3", value);
    }
}

// What stands in the manifest is kept as it stands there.
static int keep(json_reader *reader, yajl_gen_status written) {
    const unsigned char *text;
    size_t length;
    if (written != yajl_gen_status_ok && written != yajl_gen_generation_complete) {
        return vn_json_refuse(reader, HERE, "the manifest cannot be kept");
    }
    yajl_gen_get_buf(reader->manifest, &text, &length);
    return length <= MAX_MANIFEST ? 1 : vn_json_refuse_size(reader, "bytes in the manifest", MAX_MANIFEST);
}

static int enter_manifest(json_reader *reader, const json_token *token) {
    return enter(reader, IN_MANIFEST) &&
           keep(reader, token->kind == A_LIST ? yajl_gen_array_open(reader->manifest)
                                              : yajl_gen_map_open(reader->manifest));
}

static int take_manifest(json_reader *reader, const json_token *token) {
    switch (token->kind) {
    case A_NULL:
        return keep(reader, yajl_gen_null(reader->manifest));
    case A_BOOLEAN:
        return keep(reader, yajl_gen_bool(reader->manifest, token->length > 0));
    case A_NUMBER:
        return keep(reader, yajl_gen_number(reader->manifest, token->text, token->length));
    case A_TEXT:
        return keep(reader,
                    yajl_gen_string(reader->manifest, (const unsigned char *)token->text, token->length));
    default:
        return enter_manifest(reader, token);
    }
}

static int take_member(json_reader *reader, const json_token *token) {
    bool opens = token->kind >= A_LIST;
    if (reader->key == ROW_COUNT) {
        return opens ? enter(reader, IN_UNKNOWN) : 1;
    }
    const json_row *row = &vn_json_rows[reader->key];
    if (reader->key == ROW_MANIFEST) {
        return opens ? enter_manifest(reader, token) : 1;
    }
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
    const json_row *row = &vn_json_rows[reader->open];
    json_column *column = json_column_of(reader, reader->open);
    if (!(value >= row->min)) {
        return vn_json_refuse(reader, HERE, "%s = %g must be %g or more", path_of(reader).text, value,
                              row->min);
    }
    if (row->integers && (value != floor(value) || value >= INT32_MAX)) {
        return vn_json_refuse(reader, HERE, "%s = %g must be a whole number below %d", path_of(reader).text,
                              value, INT32_MAX);
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
    if (vn_json_column_count(reader, reader->open) >= reader->max_nodes) {
        return vn_json_refuse_size(reader, "entries in a list", reader->max_nodes);
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
    case IN_MANIFEST:
        return take_manifest(reader, token);
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
        if (may_stand(vn_json_rows[id].in, here) && is_text(key, vn_json_rows[id].name)) {
            if (json_seen(reader, id)) {
                return vn_json_refuse(reader, HERE, "%s is given twice", vn_json_rows[id].path);
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
    if (json_seen(reader, ROW_NODES)) {
        return vn_json_refuse(reader, HERE, "holds nodes outside its networks");
    }
    if (reader->set->count >= VN_MOST_NETWORKS) {
        return vn_json_refuse_size(reader, "networks", VN_MOST_NETWORKS);
    }
    vn_json_reset(&reader->draft);
    if (!copy_text(reader, reader->draft.name, "the name of a network", name)) {
        return 0;
    }
    if (name->length == 0) {
        return vn_json_refuse(reader, HERE, "a network among others needs a name");
    }
    for (int32_t i = 0; i < reader->set->count; i++) {
        if (strcmp(reader->set->names[i], reader->draft.name) == 0) {
            return vn_json_refuse(reader, HERE, "is given twice");
        }
    }
    return 1;
}

static int on_null(void *context) {
    return take(context, &(json_token){A_NULL, "", 0});
}

static int on_boolean(void *context, int value) {
    return take(context, &(json_token){A_BOOLEAN, "true", value != 0 ? 4 : 0});
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
    case IN_MANIFEST:
        return keep(reader, yajl_gen_string(reader->manifest, text, length));
    case IN_NETWORKS:
        return begin_network(reader, &key);
    default:
        return take_key(reader, &key);
    }
}

static int leave(json_reader *reader, bool is_list) {
    json_place ended = place_of(reader);
    reader->silence = 0;
    reader->depth--;
    if (ended == IN_MANIFEST) {
        return keep(reader,
                    is_list ? yajl_gen_array_close(reader->manifest) : yajl_gen_map_close(reader->manifest));
    }
    if (ended == IN_TOP) {
        return vn_json_finish_file(reader);
    }
    return ended == IN_NETWORK ? vn_json_finish_network(reader) : 1;
}

static int on_object_end(void *context) {
    return leave(context, false);
}

static int on_list_end(void *context) {
    return leave(context, true);
}

static const yajl_callbacks callbacks = {
    .yajl_null = on_null,
    .yajl_boolean = on_boolean,
    .yajl_number = on_number,
    .yajl_string = on_string,
    .yajl_start_map = on_object,
    .yajl_map_key = on_key,
    .yajl_end_map = on_object_end,
    .yajl_start_array = on_list,
    .yajl_end_array = on_list_end,
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
        vn_json_refuse(reader, HERE, "the file ends too early; it is empty or was cut off");
    } else {
        vn_json_refuse(reader, HERE, "not JSON: %.*s", (int)strcspn(reason, "\n"), reason);
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
    while ((count = fread(reader->chunk, 1, JSON_CHUNK, file)) > 0) {
        blank_mark(reader, count);
        VN_TRY(parse_chunk(reader, parser, count));
    }
    if (ferror(file)) {
        return vn_fail(VN_IO, "%s: cannot be read: %s", reader->path, strerror(errno));
    }
    return parse_end(reader, parser);
}

static vn_status copy_manifest(json_reader *reader) {
    const unsigned char *text;
    size_t length;
    yajl_gen_get_buf(reader->manifest, &text, &length);
    if (length == 0) {
        return VN_OK;
    }
    reader->set->manifest = vn_copy_text((const char *)text);
    return reader->set->manifest != NULL ? VN_OK : vn_fail_memory("a manifest", length);
}

vn_status vn_json_read(vn_network_set *set, const char *path, FILE *file) {
    json_reader *reader = VN_NEW(json_reader);
    yajl_handle parser = yajl_alloc(&callbacks, NULL, reader);
    vn_status status = VN_OK;
    yajl_gen manifest = yajl_gen_alloc(NULL);
    if (reader != NULL && parser != NULL && manifest != NULL) {
        reader->manifest = manifest;
        reader->path = path;
        reader->set = set;
        reader->max_nodes = vn_network_def_default().max_nodes;
        vn_json_reset(&reader->draft);
        status = parse_file(reader, parser, file);
        status = status == VN_OK ? copy_manifest(reader) : status;
        vn_json_reset(&reader->draft);
    } else {
        status = vn_fail_memory("a JSON reader", sizeof *reader);
    }
    if (parser != NULL) {
        yajl_free(parser);
    }
    if (manifest != NULL) {
        yajl_gen_free(manifest);
    }
    VN_DELETE(reader);
    return status;
}
