/// Polylines, from inside.
#ifndef VN_NETWORK_PATHS_H
#define VN_NETWORK_PATHS_H

#include "base/array.h"
#include "base/schema.h"
#include "venule/paths.h"

/// Path i has the points [i > 0 ? ends[i-1] : 0, ends[i]); what comes after the last end is being made.
struct vn_paths {
    int dim;
    VN_ARRAY(double) xyz; ///< three numbers a point
    VN_ARRAY(int32_t) ends;
    char unit[8];
};

extern const vn_schema vn_paths_schema;
extern const vn_schema vn_follow_schema;

/// Where the path begins that is being made.
static inline int32_t vn_paths_open(const vn_paths *paths) {
    return paths->ends.count > 0 ? paths->ends.data[paths->ends.count - 1] : 0;
}
/// Add a point as a pen does: not where it is already.
vn_status vn_paths_draw(vn_paths *paths, const double p[3]);
/// End the path as a pen does: a mere point is no line.
vn_status vn_paths_lift(vn_paths *paths);

/// Lines between vertices; each begins where `from` says.
typedef struct vn_wires {
    VN_ARRAY(double) xyz; ///< three numbers a vertex
    VN_ARRAY(int32_t) from;
    VN_ARRAY(int32_t) to;
} vn_wires;
void vn_wires_free(vn_wires *wires);
/// The wires as chains, from one end or branching to the next, in the order that vn_paths_load() promises.
/// A connected part begins at a vertex that no wire leads to, an end rather than a branching, or else at any
/// end.
vn_status vn_paths_from_wires(vn_paths *paths, const vn_wires *wires);

/// Append the `l` elements of an OBJ file. VN_INVALID, with a message that does not name the file yet.
vn_status vn_obj_read_wires(vn_wires *wires, const char *path);
/// Append the lines of an SVG file.
vn_status vn_svg_read_lines(vn_paths *paths, const char *path, const vn_paths_def *def);

#endif
