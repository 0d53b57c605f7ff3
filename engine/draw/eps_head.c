#include "draw/eps_head.h"

#include <cairo-ps.h>
#include <math.h>

// DSC allows 255 bytes a line.
enum { LONGEST_LINE = 240 };

static uint32_t code_of(const unsigned char *s, int length) {
    if (length == 1) {
        return s[0];
    }
    uint32_t code = s[0] & (0x7Fu >> length);
    for (int i = 1; i < length; i++) {
        code = code << 6 | (s[i] & 0x3Fu);
    }
    return code;
}

// PostScript's comments are ASCII, and so may JSON be.
static vn_status append_ascii(vn_text *out, const char *clean) {
    for (int length; *clean != '\0'; clean += length) {
        length = vn_utf8_length(clean);
        uint32_t code = code_of((const unsigned char *)clean, length > 0 ? length : 1);
        length = length > 0 ? length : 1;
        if (code < 0x80) {
            VN_TRY(vn_text_append(out, clean, 1));
        } else if (code < 0x10000) {
            VN_TRY(vn_text_print(out, "\\u%04x", (unsigned)code));
        } else {
            VN_TRY(vn_text_print(out, "\\u%04x\\u%04x", (unsigned)(0xD800 + ((code - 0x10000) >> 10)),
                                 (unsigned)(0xDC00 + ((code - 0x10000) & 0x3FF))));
        }
    }
    return VN_OK;
}

static void put_lines(cairo_surface_t *surface, const vn_text *text) {
    for (int32_t at = 0; at < text->count; at += LONGEST_LINE) {
        char line[LONGEST_LINE + 16];
        snprintf(line, sizeof line, "%%Venule: %.*s", (int)LONGEST_LINE, text->data + at);
        cairo_ps_surface_dsc_comment(surface, line);
    }
}

static void put_box(cairo_surface_t *surface, double width, double height) {
    char line[128], w[VN_NUMBER_SIZE], h[VN_NUMBER_SIZE];
    vn_format_rounded(w, ceil(width), 0);
    vn_format_rounded(h, ceil(height), 0);
    snprintf(line, sizeof line, "%%%%BoundingBox: 0 0 %s %s", w, h);
    cairo_ps_surface_dsc_comment(surface, line);
    vn_format_rounded(w, width, 4);
    vn_format_rounded(h, height, 4);
    snprintf(line, sizeof line, "%%%%HiResBoundingBox: 0 0 %s %s", w, h);
    cairo_ps_surface_dsc_comment(surface, line);
}

vn_status vn_eps_comment(cairo_surface_t *surface, double width, double height, const char *manifest) {
    vn_text ascii = {0};
    vn_status status = manifest != NULL ? append_ascii(&ascii, manifest) : VN_OK;
    cairo_ps_surface_dsc_comment(surface, "%%Title: Venule");
    put_box(surface, width, height);
    if (status == VN_OK) {
        put_lines(surface, &ascii);
    }
    vn_array_free(&ascii);
    return status;
}

// Cairo's head is text, so no zero byte is within it.
// The head up to the line of the date, and what follows it.
static vn_status pass_date(vn_eps_filter *filter) {
    const char *date = strstr(filter->head.data, "%%CreationDate");
    const char *end = date != NULL ? strchr(date, '\n') : NULL;
    if (end == NULL) {
        return VN_OK;
    }
    filter->passed = true;
    VN_TRY(vn_sink_write(filter->sink, filter->head.data, (size_t)(date - filter->head.data)));
    return vn_sink_write(filter->sink, end + 1, strlen(end + 1));
}

vn_status vn_eps_write(vn_eps_filter *filter, const char *bytes, size_t count) {
    if (filter->passed) {
        return vn_sink_write(filter->sink, bytes, count);
    }
    VN_TRY(vn_text_append(&filter->head, bytes, count));
    return pass_date(filter);
}

vn_status vn_eps_end(vn_eps_filter *filter, vn_status status) {
    if (status == VN_OK && !filter->passed && filter->head.count > 0) {
        status = vn_sink_write(filter->sink, filter->head.data, (size_t)filter->head.count);
    }
    vn_array_free(&filter->head);
    return status;
}
