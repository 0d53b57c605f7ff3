// How far a leaf's cells are from its veins.

#include "network/distance_map.h"
#include "network/leaf.h"

static double nearest_vein(const void *payload, const double p[3]) {
    const vn_faces *faces = payload;
    double distance2, q[2];
    vn_segment_grid_nearest(&faces->grid, p[0], p[1], &distance2, q);
    return sqrt(distance2);
}

vn_status vn_faces_measure_distance(vn_vein_distance *out, const vn_faces *faces, const vn_domain *area,
                                    double resolution) {
    *out = (vn_vein_distance){0};
    if (area == NULL || vn_faces_edges(faces) == 0) {
        return VN_OK;
    }
    vn_distance_map map = {
        .what = "measure", .area = area, .resolution = resolution, .nearest = nearest_vein, .payload = faces};
    vn_status status = vn_distance_map_draw(&map);
    *out = (vn_vein_distance){map.resolution, map.points, map.mean, map.max, map.mode};
    return status;
}
