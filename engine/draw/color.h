/// Colours as people write them.
#ifndef VN_DRAW_COLOR_H
#define VN_DRAW_COLOR_H

#include "base/status.h"

/// Not premultiplied; alpha 0 is "none": nothing is painted.
typedef struct vn_color {
    uint8_t red, green, blue, alpha;
} vn_color;

/// Of 0xRRGGBB, opaque.
static inline vn_color vn_color_of_rgb(uint32_t rgb) {
    return (vn_color){(uint8_t)(rgb >> 16), (uint8_t)(rgb >> 8), (uint8_t)rgb, 255};
}

static inline bool vn_same_color(vn_color a, vn_color b) {
    return a.red == b.red && a.green == b.green && a.blue == b.blue && a.alpha == b.alpha;
}

/// Read "#rgb", "#rgba", "#rrggbb", "#rrggbbaa", one of CSS's sixteen basic names, "orange", "none" or
/// "transparent"; NULL is "none". VN_INVALID for anything else; the message begins with @p what
/// ("stroke.color").
vn_status vn_color_parse(vn_color *out, const char *text, const char *what);

#endif
