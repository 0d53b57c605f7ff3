#include "base/text.h"

#include <stdarg.h>
#include <stdio.h>

vn_status vn_text_append(vn_text *text, const char *bytes, size_t count) {
    VN_TRY(vn_array_reserve(text, (int64_t)text->count + (int64_t)count + 1));
    if (count > 0) {
        memcpy(text->data + text->count, bytes, count);
    }
    text->count += (int32_t)count;
    text->data[text->count] = '\0';
    return VN_OK;
}

vn_status vn_text_print(vn_text *text, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    VN_TRY(vn_array_reserve(text, (int64_t)text->count + length + 1));
    va_start(arguments, format);
    vsnprintf(text->data + text->count, (size_t)length + 1, format, arguments);
    va_end(arguments);
    text->count += length;
    return VN_OK;
}

vn_status vn_text_number(vn_text *text, double value) {
    char number[VN_NUMBER_SIZE];
    int length = vn_format_number(number, value);
    return vn_text_append(text, number, (size_t)length);
}

int vn_utf8_length(const char *text) {
    const unsigned char *s = (const unsigned char *)text;
    if (s[0] < 0x80) {
        return 1;
    }
    int length = s[0] >= 0xF0 ? 4 : (s[0] >= 0xE0 ? 3 : 2);
    if (s[0] < 0xC2 || s[0] > 0xF4) {
        return 0;
    }
    for (int i = 1; i < length; i++) {
        if ((s[i] & 0xC0) != 0x80) {
            return 0;
        }
    }
    bool overlong = (s[0] == 0xE0 && s[1] < 0xA0) || (s[0] == 0xF0 && s[1] < 0x90);
    bool outside = (s[0] == 0xED && s[1] > 0x9F) || (s[0] == 0xF4 && s[1] > 0x8F);
    return overlong || outside ? 0 : length;
}

vn_status vn_text_json(vn_text *text, const char *value) {
    VN_TRY(vn_text_append(text, "\"", 1));
    for (const char *at = value; *at != '\0';) {
        unsigned char byte = (unsigned char)*at;
        int length = vn_utf8_length(at);
        if (byte == '"' || byte == '\\') {
            VN_TRY(vn_text_print(text, "\\%c", byte));
        } else if (byte < 0x20 || byte == 0x7F) {
            VN_TRY(vn_text_print(text, "\\u%04x", byte));
        } else if (length == 0) {
            VN_TRY(vn_text_append(text, "\xEF\xBF\xBD", 3));
        } else {
            VN_TRY(vn_text_append(text, at, (size_t)length));
        }
        at += length > 0 ? length : 1;
    }
    return vn_text_append(text, "\"", 1);
}
