#include "draw/digital_line.h"

#include <math.h>
#include <string.h>

// With 2^20 voxels along a side, twice the product of two lengths still fits 64 bits.
enum { PARTS = 1024 };

static int64_t floor_div(int64_t a, int64_t b) {
    return a / b - (a % b < 0 ? 1 : 0);
}

static int32_t voxel_of(int64_t position) {
    return (int32_t)floor_div(position + PARTS / 2, PARTS);
}

static void set_end(int64_t position[3], const double p[3], const int32_t size[3]) {
    for (int k = 0; k < 3; k++) {
        position[k] = (int64_t)floor((p[k] + 0.5) * PARTS) - PARTS / 2; // in the voxel that p is in
        if (position[k] == (int64_t)size[k] * PARTS - PARTS / 2) {
            position[k]--;
        }
    }
}

static int longest_axis(const vn_digital_line *line) {
    int axis = 0;
    int64_t most = -1;
    for (int k = 0; k < 3; k++) {
        int64_t length = line->b[k] > line->a[k] ? line->b[k] - line->a[k] : line->a[k] - line->b[k];
        if (length > most) {
            most = length;
            axis = k;
        }
    }
    return axis;
}

vn_digital_line vn_digital_line_make(const double a[3], const double b[3], const int32_t size[3]) {
    vn_digital_line line;
    set_end(line.a, a, size);
    set_end(line.b, b, size);
    line.axis = longest_axis(&line);
    if (line.a[line.axis] > line.b[line.axis]) {
        int64_t kept[3];
        memcpy(kept, line.a, sizeof kept);
        memcpy(line.a, line.b, sizeof kept);
        memcpy(line.b, kept, sizeof kept);
    }
    line.first = voxel_of(line.a[line.axis]);
    line.last = voxel_of(line.b[line.axis]);
    return line;
}

// Where it is `way` parts along its axis: rounded to the nearest voxel, halves up, as a whole number of a
// fraction.
static int32_t nearest_at(const vn_digital_line *line, int axis, int64_t way) {
    int64_t length = line->b[line->axis] - line->a[line->axis];
    if (length == 0) {
        return voxel_of(line->a[axis]);
    }
    int64_t rise = line->b[axis] - line->a[axis];
    return (int32_t)floor_div((line->a[axis] + PARTS / 2) * length + rise * way, PARTS * length);
}

static int64_t clamp(int64_t value, int64_t low, int64_t high) {
    return value < low ? low : (value > high ? high : value);
}

void vn_digital_line_at(const vn_digital_line *line, int32_t number, int32_t voxel[3]) {
    if (number < line->first || number > line->last) {
        const int64_t *end = number < line->first ? line->a : line->b;
        for (int k = 0; k < 3; k++) {
            voxel[k] = voxel_of(end[k]);
        }
        return;
    }
    int64_t low = line->a[line->axis], high = line->b[line->axis];
    int64_t way = clamp((int64_t)number * PARTS, low, high) - low;
    for (int k = 0; k < 3; k++) {
        voxel[k] = k == line->axis ? number : nearest_at(line, k, way);
    }
}

void vn_digital_line_range(const vn_digital_line *line, int axis, int32_t low, int32_t high, int32_t *begin,
                           int32_t *end) {
    double rise = (double)(line->b[axis] - line->a[axis]) / PARTS;
    double length = (double)(line->b[line->axis] - line->a[line->axis]) / PARTS;
    double from = (double)line->a[axis] / PARTS;
    if (fabs(rise) < 0.5) {
        return; // a part of it would be most of it
    }
    double at_low = (low - 2 - from) / rise * length, at_high = (high + 1 - from) / rise * length;
    double first = line->first + floor(fmin(at_low, at_high)) - 1;
    double last = line->first + ceil(fmax(at_low, at_high)) + 1;
    *begin = first > *begin ? (first < *end ? (int32_t)first : *end) : *begin;
    *end = last < *end ? (last > *begin ? (int32_t)last : *begin) : *end;
}
