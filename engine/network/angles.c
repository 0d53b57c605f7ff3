#include "network/leaf.h"

// Thicker first; of equals the edge to the parent, then the lower half-edge.
static bool is_thicker(const vn_faces *faces, int32_t h, int32_t g) {
    double a = faces->radius.data[h / 2], b = faces->radius.data[g / 2];
    if (a != b) {
        return a > b;
    }
    return h % 2 != g % 2 ? h % 2 == 1 : h < g;
}

static void sort_by_thickness(const vn_faces *faces, int32_t spokes[3]) {
    for (int i = 1; i < 3; i++) {
        int32_t spoke = spokes[i];
        int j = i;
        for (; j > 0 && is_thicker(faces, spoke, spokes[j - 1]); j--) {
            spokes[j] = spokes[j - 1];
        }
        spokes[j] = spoke;
    }
}

static void direction_of(const vn_faces *faces, int32_t half, double d[2]) {
    const vn_segment *s = &faces->grid.segments.data[half / 2];
    double sign = half % 2 == 0 ? 1 : -1;
    d[0] = sign * (s->x1 - s->x0);
    d[1] = sign * (s->y1 - s->y0);
}

static double angle_between(const vn_faces *faces, int32_t h, int32_t g) {
    const double degrees = 57.29577951308232;
    double p[2], q[2];
    direction_of(faces, h, p);
    direction_of(faces, g, q);
    return degrees * atan2(fabs(p[0] * q[1] - p[1] * q[0]), p[0] * q[0] + p[1] * q[1]);
}

static void add_junction(vn_branching_angles *out, const vn_faces *faces, const int32_t *at) {
    int32_t spokes[3] = {at[0], at[1], at[2]};
    sort_by_thickness(faces, spokes);
    double thick = faces->radius.data[spokes[0] / 2], thin = faces->radius.data[spokes[2] / 2];
    double middle_thin = angle_between(faces, spokes[1], spokes[2]);
    out->count++;
    out->daughters += middle_thin;
    if (thick > 0) {
        int k = (int)(5 * thin / thick);
        struct vn_angle_bin *bin = &out->bins[k < 4 ? k : 4];
        bin->count++;
        bin->thick_middle += angle_between(faces, spokes[0], spokes[1]);
        bin->thick_thin += angle_between(faces, spokes[0], spokes[2]);
        bin->middle_thin += middle_thin;
    }
}

void vn_faces_measure_angles(vn_branching_angles *out, const vn_faces *faces) {
    *out = (vn_branching_angles){0};
    for (int32_t v = 0; v < faces->network->x.count; v++) {
        if (faces->starts.data[v + 1] - faces->starts.data[v] == 3) {
            add_junction(out, faces, faces->spokes.data + faces->starts.data[v]);
        }
    }
    out->daughters /= out->count > 0 ? out->count : 1;
    for (int k = 0; k < 5; k++) {
        struct vn_angle_bin *bin = &out->bins[k];
        double count = bin->count > 0 ? bin->count : 1;
        bin->thick_middle /= count;
        bin->thick_thin /= count;
        bin->middle_thin /= count;
    }
}
