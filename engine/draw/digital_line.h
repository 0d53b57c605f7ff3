/// Digital lines: which voxels stand for an edge, so that they hang together.
#ifndef VN_DRAW_DIGITAL_LINE_H
#define VN_DRAW_DIGITAL_LINE_H

#include <stdbool.h>
#include <stdint.h>

/// Along the axis in which it is longest, a line has one voxel a step, the one that its middle is nearest to;
/// to these come the voxels of its two ends. Positions are whole 1/1024ths of a voxel, so that all this is
/// exact: neighbours in a line differ by 1 at most in every coordinate, and lines that share an end share its
/// voxel. In floating point a diagonal's ties, rounded one up and one down, tear it.
typedef struct vn_digital_line {
    int64_t a[3], b[3]; ///< a[axis] <= b[axis]
    int axis;           ///< in which it is longest
    int32_t first, last;
} vn_digital_line;

enum { VN_LINE_SIDE = 1 << 20 };

/// A line between two points in voxels, the middle of voxel i at i; @p size is that of the volume, at most
/// VN_LINE_SIDE along each axis, and the ends lie at most a few voxels beyond it. What lies on the upper face
/// of a last voxel belongs to that voxel.
vn_digital_line vn_digital_line_make(const double a[3], const double b[3], const int32_t size[3]);

/// Its voxels are numbers first - 1 (the end a) to last + 1 (the end b).
void vn_digital_line_at(const vn_digital_line *line, int32_t number, int32_t voxel[3]);

/// Narrow [*begin, *end], numbers as above, to those whose coordinate along @p axis may lie in [low, high).
void vn_digital_line_range(const vn_digital_line *line, int axis, int32_t low, int32_t high, int32_t *begin,
                           int32_t *end);

#endif
