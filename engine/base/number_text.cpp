// Shim over <charconv>: the C library's printf and strtod follow the locale of whoever embeds us.
extern "C" {
#include "base/text.h"
}

#include <charconv>
#include <cmath>
#include <cstring>

namespace {

int finish(char *text, std::to_chars_result result) {
    *result.ptr = '\0';
    return static_cast<int>(result.ptr - text);
}

bool starts_number(const char *text, const char *end) {
    if (text < end && (*text == '-' || *text == '+')) {
        text++;
    }
    if (text < end && *text == '.') {
        text++;
    }
    return text < end && *text >= '0' && *text <= '9';
}

} // namespace

extern "C" int vn_format_number(char *text, double value) {
    return finish(text, std::to_chars(text, text + VN_NUMBER_SIZE - 1, value));
}

extern "C" int vn_format_rounded(char *text, double value, int decimals) {
    if (!(std::fabs(value) < 1e15) || decimals < 0 || decimals > 15) {
        return vn_format_number(text, value);
    }
    auto result = std::to_chars(text, text + VN_NUMBER_SIZE - 1, value, std::chars_format::fixed, decimals);
    if (result.ec != std::errc()) {
        return vn_format_number(text, value);
    }
    if (decimals > 0) {
        while (result.ptr[-1] == '0') {
            result.ptr--;
        }
        if (result.ptr[-1] == '.') {
            result.ptr--;
        }
    }
    int length = finish(text, result);
    if (std::strcmp(text, "-0") == 0) {
        std::memcpy(text, "0", 2);
        length = 1;
    }
    return length;
}

extern "C" const char *vn_parse_number(const char *text, const char *end, double *value) {
    if (!starts_number(text, end)) {
        return nullptr;
    }
    if (*text == '+') {
        text++;
    }
    auto result = std::from_chars(text, end, *value);
    return result.ec == std::errc() ? result.ptr : nullptr;
}
