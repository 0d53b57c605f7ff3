/// The bytes of a binary file, one after the other, unpacked where they are packed. Nothing is read beyond
/// what is asked for, and nothing is believed that the file's size cannot hold.
#ifndef VN_FILE_BYTES_H
#define VN_FILE_BYTES_H

#include "base/status.h"

typedef struct vn_bytes vn_bytes;

/// VN_IO for what is missing or no file.
vn_status vn_bytes_open(vn_bytes **out, const char *path);
/// NULL is accepted.
void vn_bytes_close(vn_bytes *bytes);
const char *vn_bytes_path(const vn_bytes *bytes);

/// Whether gzip's mark comes next.
bool vn_bytes_are_packed(vn_bytes *bytes);
/// What comes from here on is packed, by gzip or zlib.
vn_status vn_bytes_unpack(vn_bytes *bytes);

/// The next byte, or -1 at the end and after a failure.
int vn_bytes_next(vn_bytes *bytes);
/// The next @p count bytes; VN_IO where there are fewer: the file is cut off in its @p what.
vn_status vn_bytes_take(vn_bytes *bytes, void *to, size_t count, const char *what);
vn_status vn_bytes_skip(vn_bytes *bytes, size_t count, const char *what);
/// The next line without its end; what is beyond @p size - 1 bytes of it is dropped.
vn_status vn_bytes_line(vn_bytes *bytes, char *line, size_t size);
/// The next word, of at most @p size - 1 bytes, and the one white space after it; comments from # to the end
/// of a line are no words.
vn_status vn_bytes_word(vn_bytes *bytes, char *word, size_t size, const char *what);
/// Like vn_bytes_word(), and what the word is as a number.
vn_status vn_bytes_number(vn_bytes *bytes, double *value, const char *what);

/// VN_IO where what is left of the file cannot be @p count bytes, even unpacked by deflate (@p packed, or
/// after vn_bytes_unpack()), of its @p what.
vn_status vn_bytes_check(const vn_bytes *bytes, double count, bool packed, const char *what);
/// After the last byte that was of interest: whether the checksum is right, where one comes next.
vn_status vn_bytes_end(vn_bytes *bytes);
/// The failure behind a byte that did not come: a broken file, or one that is cut off in its @p what.
vn_status vn_bytes_fail(const vn_bytes *bytes, const char *what);

#endif
