/// Numbers as text that no locale can change, and text that grows.
#ifndef VN_BASE_TEXT_H
#define VN_BASE_TEXT_H

#include "base/array.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { VN_NUMBER_SIZE = 32 };

/// Write the shortest decimal that reads back as @p value ("0.1", "1e+300", "nan"); returns its length.
/// @p text has room for VN_NUMBER_SIZE bytes and gets a final zero byte.
int vn_format_number(char *text, double value);

/// Write @p value rounded to @p decimals places (0 to 15) without needless zeros ("12.5", "-3", never "-0").
/// |value| must be below 1e15; larger ones are written by vn_format_number().
int vn_format_rounded(char *text, double value, int decimals);

/// Read a decimal number at the beginning of [text, end). Returns the first byte after it, or NULL if there
/// is none or it does not fit a double. Accepts a leading '+' and ".5"; not "inf", "nan" or hexadecimal.
const char *vn_parse_number(const char *text, const char *end, double *value);

#ifdef __cplusplus
}
#endif

/// Text that grows; `data` has a final zero byte after `count` bytes once something was appended.
typedef VN_ARRAY(char) vn_text;

vn_status vn_text_append(vn_text *text, const char *bytes, size_t count);
vn_status vn_text_print(vn_text *text, const char *format, ...) VN_PRINTF(2, 3);
vn_status vn_text_number(vn_text *text, double value);

/// The length of the UTF-8 sequence at @p text, 1 to 4; 0 where it is malformed (overlong, a surrogate, cut
/// off, too large).
int vn_utf8_length(const char *text);

/// Append @p value as a JSON string, quotes included; bytes that are not UTF-8 become U+FFFD.
vn_status vn_text_json(vn_text *text, const char *value);

#endif
