/// Colours as people write them.
#ifndef VN_DRAW_COLOR_H
#define VN_DRAW_COLOR_H

#include "base/status.h"

/// Not premultiplied; alpha 0 is "none": nothing is painted.
typedef struct vn_color {
    uint8_t red, green, blue, alpha;
} vn_color;

/// Read "#rgb", "#rgba", "#rrggbb", "#rrggbbaa", one of CSS's sixteen basic names, "orange", "none" or
/// "transparent"; NULL is "none". VN_INVALID for anything else; the message begins with @p what
/// ("stroke.color").
vn_status vn_color_parse(vn_color *out, const char *text, const char *what);

#endif
