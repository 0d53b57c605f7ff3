/// How far points of a domain are from the nearest of something.
#ifndef VN_NETWORK_DISTANCE_MAP_H
#define VN_NETWORK_DISTANCE_MAP_H

#include "domain/domain.h"

typedef double vn_nearest_fn(const void *payload, const double p[3]);
typedef VN_ARRAY(double) vn_distance_list;

/// On a square or cubic grid of points, or on points at random, evenly, of a surface.
typedef struct vn_distance_map {
    const char *what; ///< begins messages; the resolution is a field of it
    const vn_domain *area;
    double resolution; ///< between points; 0 asks for a usual one
    vn_nearest_fn *nearest;
    const void *payload;
    vn_distance_list *list; ///< NULL, or gets the distance of each point

    int32_t points;
    double mean, max;
    double furthest[3]; ///< the first point at distance `max`
    double mode;        ///< the middle of the fullest quarter of an octave; 0 where all distances are
} vn_distance_map;

/// Fill the second half. VN_INVALID for a resolution that makes too many points.
vn_status vn_distance_map_draw(vn_distance_map *map);

#endif
