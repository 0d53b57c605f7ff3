// The `l` elements of Wavefront's OBJ. Faces and all the rest are passed over.
#include "file/lines.h"
#include "network/paths.h"

#include <errno.h>

/// What a statement is about, until its line ends without a backslash.
typedef enum obj_statement { OBJ_NONE, OBJ_OTHER, OBJ_VERTEX, OBJ_LINE } obj_statement;

typedef struct obj_reader {
    vn_wires *wires;
    long long line;
    obj_statement statement;
    int32_t words; ///< of the statement, without its name
    int32_t last;  ///< the vertex that an `l` has come to
} obj_reader;

static vn_status take_coordinate(obj_reader *reader, vn_slice word) {
    double value;
    if (reader->words >= 3) { // a weight, or colours
        return VN_OK;
    }
    if (!vn_slice_number(word, &value)) {
        return vn_fail(VN_INVALID, "line %lld: %c = \"%.*s\" must be a number; a vertex is: v x y z",
                       reader->line, 'x' + reader->words, VN_SLICE(word));
    }
    return vn_array_push(&reader->wires->xyz, value);
}

// "7", "7/3" with a texture's vertex, or "-1" for the last one so far; from 0.
static bool read_vertex(const obj_reader *reader, vn_slice word, int32_t *vertex) {
    int32_t there = reader->wires->xyz.count / 3;
    const char *slash = memchr(word.text, '/', word.length);
    word.length = slash != NULL ? (size_t)(slash - word.text) : word.length;
    bool whole = vn_slice_integer(word, vertex);
    if (whole) {
        *vertex += *vertex < 0 ? there : -1;
    }
    return whole && *vertex >= 0 && *vertex < there;
}

static vn_status take_vertex(obj_reader *reader, vn_slice word) {
    int32_t vertex;
    if (!read_vertex(reader, word, &vertex)) {
        return vn_fail(VN_INVALID,
                       "line %lld: l = \"%.*s\" must be the number of one of the %d vertices before it",
                       reader->line, VN_SLICE(word), reader->wires->xyz.count / 3);
    }
    if (reader->words > 0) {
        VN_TRY(vn_array_push(&reader->wires->from, reader->last));
        VN_TRY(vn_array_push(&reader->wires->to, vertex));
    }
    reader->last = vertex;
    return VN_OK;
}

static vn_status take_word(obj_reader *reader, vn_slice word) {
    if (reader->statement == OBJ_NONE) {
        reader->statement = vn_slice_is(word, "v")   ? OBJ_VERTEX
                            : vn_slice_is(word, "l") ? OBJ_LINE
                                                     : OBJ_OTHER;
        reader->words = 0;
        return VN_OK;
    }
    if (reader->statement == OBJ_VERTEX) {
        VN_TRY(take_coordinate(reader, word));
    } else if (reader->statement == OBJ_LINE) {
        VN_TRY(take_vertex(reader, word));
    }
    reader->words += reader->words < INT32_MAX;
    return VN_OK;
}

static vn_status end_statement(obj_reader *reader) {
    bool vertex = reader->statement == OBJ_VERTEX && reader->words < 3;
    bool line = reader->statement == OBJ_LINE && reader->words < 2;
    reader->statement = OBJ_NONE;
    if (vertex) {
        return vn_fail(VN_INVALID, "line %lld: a vertex is: v x y z", reader->line);
    }
    return line ? vn_fail(VN_INVALID, "line %lld: an l joins two vertices or more", reader->line) : VN_OK;
}

static vn_status take_line(obj_reader *reader, vn_slice line) {
    line = vn_slice_trim(line);
    bool goes_on = line.length > 0 && line.text[line.length - 1] == '\\';
    line.length -= goes_on;
    for (vn_slice word = vn_take_word(&line); word.length > 0; word = vn_take_word(&line)) {
        if (word.text[0] == '#') {
            break;
        }
        VN_TRY(take_word(reader, word));
    }
    return goes_on ? VN_OK : end_statement(reader);
}

static vn_status read_lines(obj_reader *reader, vn_lines *lines) {
    for (;;) {
        vn_slice line;
        VN_TRY(vn_lines_next(lines, &line));
        if (line.text == NULL) {
            return end_statement(reader);
        }
        reader->line = lines->number;
        VN_TRY(take_line(reader, line));
    }
}

vn_status vn_obj_read_wires(vn_wires *wires, const char *path) {
    obj_reader reader = {.wires = wires};
    vn_lines *lines;
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return vn_fail(VN_IO, "%s: cannot be read: %s", path, strerror(errno));
    }
    vn_status status = vn_lines_open(&lines, path, file);
    if (status == VN_OK) {
        status = read_lines(&reader, lines);
        vn_lines_close(lines);
    }
    fclose(file);
    return status == VN_OK && wires->from.count == 0
               ? vn_fail(VN_INVALID, "it has no `l` element: save the lines as edges or curves")
               : status;
}
