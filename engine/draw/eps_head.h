/// What stands at the beginning of an EPS file.
#ifndef VN_DRAW_EPS_HEAD_H
#define VN_DRAW_EPS_HEAD_H

#include "base/sink.h"
#include "base/text.h"

#include <cairo.h>

/// Say of the page how large it is (points), and how it was made: @p manifest is NULL or one line of JSON.
/// The box is the whole page's; cairo would take that of the ink.
vn_status vn_eps_comment(cairo_surface_t *surface, double width, double height, const char *manifest);

/// Takes the date out of what cairo writes, which has no other way to keep the clock out of a file.
typedef struct vn_eps_filter {
    vn_sink *sink;
    vn_text head; ///< until the date has gone by
    bool passed;
} vn_eps_filter;
vn_status vn_eps_write(vn_eps_filter *filter, const char *bytes, size_t count);
/// Write what is left of the head, and free it.
vn_status vn_eps_end(vn_eps_filter *filter, vn_status status);

#endif
