/// Text files, line by line.
#ifndef VN_FILE_LINES_H
#define VN_FILE_LINES_H

#include "file/slice.h"

#include <stdio.h>

typedef struct vn_lines {
    FILE *file;
    const char *path;
    int64_t number; ///< of the line that was read last, from 1
    vn_text line;
    size_t begin, end; ///< of what is in `chunk` still to be taken
    char chunk[32768];
} vn_lines;

/// Begin at the beginning of @p file; freed by vn_lines_close().
vn_status vn_lines_open(vn_lines **out, const char *path, FILE *file);
void vn_lines_close(vn_lines *lines);

/// The next line without its end; @p line->text is NULL after the last one. It holds until the next call.
vn_status vn_lines_next(vn_lines *lines, vn_slice *line);

/// Take the next word, which white space ends, from the front of @p rest; empty when there is none.
vn_slice vn_take_word(vn_slice *rest);
/// Take the next field, which @p separator ends; whether there was one. Without quotes and space around it.
bool vn_take_field(vn_slice *rest, char separator, vn_slice *field);

#endif
