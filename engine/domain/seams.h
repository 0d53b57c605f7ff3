/// Which triangles of a mesh meet in which edge.
#ifndef VN_DOMAIN_SEAMS_H
#define VN_DOMAIN_SEAMS_H

#include "domain/faces.h"

/// Halfedge 3t + k leads from corner k of triangle t to the next one. @p first gets of each vertex the first
/// one at the very same place: files often give a vertex once for each face. @p mate gets of each halfedge
/// the next one at the same edge, in whatever direction: upwards, and from the last back to the first.
vn_status vn_seams_link(const double *xyz, int32_t vertices, const vn_corners *corners, vn_corners *first,
                        vn_corners *mate);

#endif
