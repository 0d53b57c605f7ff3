/// Writing a file so that it appears whole or not at all: the bytes go to a nameless file in the same folder,
/// which gets its name only when all of them are on the disk.
#ifndef VN_BASE_SINK_H
#define VN_BASE_SINK_H

#include "base/status.h"

#include <stdio.h>

typedef struct vn_sink vn_sink;

/// Begin to write @p path. VN_IO when the folder is missing or may not be written to.
vn_status vn_sink_open(vn_sink **out, const char *path);

/// Append bytes. A failure (disk full) is remembered and reported by vn_sink_close() too.
vn_status vn_sink_write(vn_sink *sink, const void *bytes, size_t count);
vn_status vn_sink_text(vn_sink *sink, const char *text);
vn_status vn_sink_print(vn_sink *sink, const char *format, ...) VN_PRINTF(2, 3);

/// Append the shortest decimal that reads back as @p value; or @p value rounded to @p decimals places.
vn_status vn_sink_number(vn_sink *sink, double value);
vn_status vn_sink_rounded(vn_sink *sink, double value, int decimals);

/// Append an integer with all its digits: vn_sink_number()'s shortest form of a million is 1e+06.
vn_status vn_sink_integer(vn_sink *sink, int64_t value);

/// End: with @p status VN_OK, flush, sync and give the file its name; else drop it. Returns @p status, or the
/// failure of the writing itself. NULL is accepted and returns @p status.
vn_status vn_sink_close(vn_sink *sink, vn_status status);

#endif
