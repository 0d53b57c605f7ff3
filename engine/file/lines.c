#include "file/lines.h"

#include "base/memory.h"

#include <errno.h>

enum { LONGEST_LINE = 1 << 20 };

vn_status vn_lines_open(vn_lines **out, const char *path, FILE *file) {
    *out = VN_NEW(vn_lines);
    if (*out == NULL) {
        return vn_fail_memory("a text reader", sizeof **out);
    }
    (*out)->file = file;
    (*out)->path = path;
    return VN_OK;
}

void vn_lines_close(vn_lines *lines) {
    if (lines != NULL) {
        vn_array_free(&lines->line);
        VN_DELETE(lines);
    }
}

static vn_status refill(vn_lines *lines) {
    lines->begin = 0;
    lines->end = fread(lines->chunk, 1, sizeof lines->chunk, lines->file);
    if (lines->end == 0 && ferror(lines->file)) {
        return vn_fail(VN_IO, "%s: cannot be read: %s", lines->path, strerror(errno));
    }
    return vn_poll();
}

static vn_status append(vn_lines *lines, size_t count) {
    if ((size_t)lines->line.count + count > LONGEST_LINE) {
        return vn_fail(VN_INVALID, "line %lld: is longer than %d bytes, which is the limit",
                       (long long)lines->number, LONGEST_LINE);
    }
    VN_TRY(vn_text_append(&lines->line, lines->chunk + lines->begin, count));
    lines->begin += count;
    return VN_OK;
}

// Some editors on Windows begin a file with a byte order mark.
static vn_slice finish(const vn_lines *lines) {
    vn_slice line = {lines->line.data, (size_t)lines->line.count};
    if (line.length > 0 && line.text[line.length - 1] == '\r') {
        line.length--;
    }
    if (lines->number == 1 && line.length >= 3 && memcmp(line.text, "\xEF\xBB\xBF", 3) == 0) {
        line.text += 3;
        line.length -= 3;
    }
    return line;
}

vn_status vn_lines_next(vn_lines *lines, vn_slice *line) {
    *line = (vn_slice){NULL, 0};
    lines->line.count = 0;
    lines->number++;
    VN_TRY(vn_text_append(&lines->line, "", 0));
    for (;;) {
        if (lines->begin == lines->end) {
            VN_TRY(refill(lines));
        }
        if (lines->end == 0) { // a last line may lack its end
            *line = lines->line.count > 0 ? finish(lines) : *line;
            return VN_OK;
        }
        const char *from = lines->chunk + lines->begin;
        const char *stop = memchr(from, '\n', lines->end - lines->begin);
        VN_TRY(append(lines, stop != NULL ? (size_t)(stop - from) : lines->end - lines->begin));
        if (stop != NULL) {
            lines->begin++;
            *line = finish(lines);
            return VN_OK;
        }
    }
}

vn_slice vn_take_word(vn_slice *rest) {
    *rest = vn_slice_trim(*rest);
    vn_slice word = {rest->text, 0};
    while (word.length < rest->length && !vn_is_blank(word.text[word.length])) {
        word.length++;
    }
    rest->text += word.length;
    rest->length -= word.length;
    return word;
}

bool vn_take_field(vn_slice *rest, char separator, vn_slice *field) {
    if (rest->text == NULL) {
        return false;
    }
    const char *stop = rest->length > 0 ? memchr(rest->text, separator, rest->length) : NULL;
    size_t length = stop != NULL ? (size_t)(stop - rest->text) : rest->length;
    *field = vn_slice_trim((vn_slice){rest->text, length});
    if (field->length >= 2 && field->text[0] == '"' && field->text[field->length - 1] == '"') {
        *field = vn_slice_trim((vn_slice){field->text + 1, field->length - 2});
    }
    *rest = stop != NULL ? (vn_slice){stop + 1, rest->length - length - 1} : (vn_slice){NULL, 0};
    return true;
}
