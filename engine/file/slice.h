/// A piece of somebody else's text, not ended by a zero byte.
#ifndef VN_FILE_SLICE_H
#define VN_FILE_SLICE_H

#include "base/text.h"

#include <math.h>
#include <strings.h>

typedef struct vn_slice {
    const char *text;
    size_t length;
} vn_slice;

/// For "%.*s" in messages: at most so much of it is shown.
#define VN_SLICE(slice) ((slice).length < 40 ? (int)(slice).length : 40), (slice).text

static inline bool vn_is_blank(char byte) {
    return byte == ' ' || byte == '\t' || byte == '\r' || byte == '\n';
}

/// Without the white space around it.
static inline vn_slice vn_slice_trim(vn_slice slice) {
    while (slice.length > 0 && vn_is_blank(slice.text[0])) {
        slice.text++;
        slice.length--;
    }
    while (slice.length > 0 && vn_is_blank(slice.text[slice.length - 1])) {
        slice.length--;
    }
    return slice;
}

/// Whether it says @p word, in capitals or not.
static inline bool vn_slice_is(vn_slice slice, const char *word) {
    return slice.length == strlen(word) && strncasecmp(slice.text, word, slice.length) == 0;
}

/// Whether the whole of it is one finite number.
static inline bool vn_slice_number(vn_slice slice, double *value) {
    const char *end = slice.text + slice.length;
    return slice.length > 0 && vn_parse_number(slice.text, end, value) == end && fabs(*value) <= 1e300;
}

/// Whether it is one whole number that an int32_t holds.
static inline bool vn_slice_integer(vn_slice slice, int32_t *value) {
    double number;
    if (!vn_slice_number(slice, &number) || number != floor(number) || fabs(number) >= INT32_MAX) {
        return false;
    }
    *value = (int32_t)number;
    return true;
}

#endif
