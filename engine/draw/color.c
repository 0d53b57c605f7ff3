#include "draw/color.h"

#include "base/schema.h"

// Rows of the same index. "none" and "transparent" have alpha 0.
static const char *const color_names[] = {
    "aqua",  "black",  "blue",   "fuchsia", "gray",   "green", "lime",  "maroon", "navy",       "none",
    "olive", "orange", "purple", "red",     "silver", "teal",  "white", "yellow", "transparent"};
static const vn_color color_values[] = {
    {0, 255, 255, 255}, {0, 0, 0, 255},       {0, 0, 255, 255},   {255, 0, 255, 255}, {128, 128, 128, 255},
    {0, 128, 0, 255},   {0, 255, 0, 255},     {128, 0, 0, 255},   {0, 0, 128, 255},   {0, 0, 0, 0},
    {128, 128, 0, 255}, {255, 165, 0, 255},   {128, 0, 128, 255}, {255, 0, 0, 255},   {192, 192, 192, 255},
    {0, 128, 128, 255}, {255, 255, 255, 255}, {255, 255, 0, 255}, {0, 0, 0, 0}};
enum { COLOR_NAMES = sizeof color_names / sizeof color_names[0] };

static char lower(char c) {
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

static bool same_name(const char *text, const char *name) {
    while (*text != '\0' && lower(*text) == *name) {
        text++;
        name++;
    }
    return *text == *name;
}

static int hex_digit(char c) {
    if (c >= '0' && c <= '9') {
        return c - '0';
    }
    char letter = lower(c);
    return letter >= 'a' && letter <= 'f' ? letter - 'a' + 10 : -1;
}

// Channel @p i of the digits after '#': one digit stands for itself twice.
static uint8_t hex_channel(const char *digits, size_t length, size_t i) {
    if (length <= 4) {
        return (uint8_t)(17 * hex_digit(digits[i]));
    }
    return (uint8_t)(16 * hex_digit(digits[2 * i]) + hex_digit(digits[2 * i + 1]));
}

static bool parse_hex(vn_color *out, const char *digits) {
    size_t length = 0;
    while (digits[length] != '\0') {
        if (length == 8 || hex_digit(digits[length]) < 0) {
            return false;
        }
        length++;
    }
    if (length != 3 && length != 4 && length != 6 && length != 8) {
        return false;
    }
    bool has_alpha = length == 4 || length == 8;
    out->red = hex_channel(digits, length, 0);
    out->green = hex_channel(digits, length, 1);
    out->blue = hex_channel(digits, length, 2);
    out->alpha = has_alpha ? hex_channel(digits, length, 3) : 255;
    return true;
}

static vn_status fail_color(const char *text, const char *what) {
    const char *close = text[0] == '#' ? NULL : vn_closest_name(text, color_names, COLOR_NAMES);
    return vn_fail(
        VN_INVALID,
        "%s = \"%.40s\" is no colour%s%s%s: give \"#rgb\", \"#rgba\", \"#rrggbb\", \"#rrggbbaa\", one of "
        "the basic CSS names such as \"teal\", or \"none\"",
        what, text, close != NULL ? " (did you mean \"" : "", close != NULL ? close : "",
        close != NULL ? "\"?)" : "");
}

vn_status vn_color_parse(vn_color *out, const char *text, const char *what) {
    *out = (vn_color){0};
    if (text == NULL) {
        return VN_OK;
    }
    if (text[0] == '#') {
        return parse_hex(out, text + 1) ? VN_OK : fail_color(text, what);
    }
    for (int i = 0; i < COLOR_NAMES; i++) {
        if (same_name(text, color_names[i])) {
            *out = color_values[i];
            return VN_OK;
        }
    }
    return fail_color(text, what);
}
