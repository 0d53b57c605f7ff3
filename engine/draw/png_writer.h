/// Pixels to PNG.
#ifndef VN_DRAW_PNG_WRITER_H
#define VN_DRAW_PNG_WRITER_H

#include "base/sink.h"

/// Rows from the top, 0xAARRGGBB with premultiplied alpha.
typedef struct vn_pixels {
    const uint32_t *data;
    int32_t width, height;
    double a_meter; ///< how many pixels are one on paper
} vn_pixels;

/// Write RGB where all is opaque, else RGBA. @p manifest (UTF-8, or NULL) becomes the text chunk "venule".
vn_status vn_png_write(vn_sink *sink, const vn_pixels *pixels, const char *manifest);

#endif
