/// @file paths.h
/// Polylines: from drawings and other files, and for vessels to follow.
#ifndef VENULE_PATHS_H
#define VENULE_PATHS_H

#include "venule/domain.h"
#include "venule/network.h"

#ifdef __cplusplus
extern "C" {
#endif

/// A list of polylines. Paths and their points are numbered from 0.
typedef struct vn_paths vn_paths;

/// An empty list, of points that have @p dim coordinates: 2 or 3.
VN_API vn_status vn_paths_create(vn_paths **out, int dim);
VN_API void vn_paths_destroy(vn_paths *paths);
/// Add a point to the path that is being made. VN_INVALID where a coordinate is not finite.
VN_API vn_status vn_paths_point(vn_paths *paths, const double p[3]);
/// End that path; nothing happens where it has no point yet.
VN_API vn_status vn_paths_end(vn_paths *paths);

VN_API int vn_paths_dim(const vn_paths *paths);
VN_API int32_t vn_paths_count(const vn_paths *paths);
/// How many points path @p path has.
VN_API int32_t vn_paths_size(const vn_paths *paths, int32_t path);
/// A point of it; @p p[2] is 0 in 2D.
VN_API void vn_paths_position(const vn_paths *paths, int32_t path, int32_t point, double p[3]);
/// The length unit of the file they are from, "" where it says none.
VN_API const char *vn_paths_unit(const vn_paths *paths);

typedef struct vn_paths_def {
    const char *id;   ///< of a shape or group in an SVG file, or the name of a network in a file of several;
                      ///< NULL (the default): all that is drawn, and the only network
    double tolerance; ///< curves become polylines that are within this of them, in the file's units; default
                      ///< 0: 1e-4 of the shape's size
} vn_paths_def;
VN_API vn_paths_def vn_paths_def_default(void);
/// The lines of a file: the shapes of an SVG file in the order in which they are drawn, as vn_domain_svg()
/// has their coordinates, closed ones ending where they began; the `l` elements of an OBJ file; or the
/// edges of a network (vn_networks_load()). Those of the latter two are chains from one end or branching to
/// the next, and every chain but the first of a connected part begins where an earlier one has been.
/// VN_IO for a file that is missing, broken or has no line.
VN_API vn_status vn_paths_load(vn_paths **out, const char *path, const vn_paths_def *def);
/// The chains of a network, from its roots on; without its joins.
VN_API vn_status vn_paths_of_network(vn_paths **out, const vn_network *network);

typedef struct vn_follow_def {
    double length; ///< of the new edges, about: each path is cut into equal parts; > 0; required
    double within; ///< how far from the network a path may begin; beside a surface also how far its points
                   ///< may lie off; default 0: `length`
    vn_domain *domain; ///< what points and edges have to be in; paths are brought onto it where it is a
                       ///< surface. Borrowed; NULL (the default): anywhere
    const char *name;  ///< what messages call the paths; default "paths"
} vn_follow_def;
VN_API vn_follow_def vn_follow_def_default(void);
/// Lay vessels along paths, as the guides of Rauch & Harders 2021, Figure 4. Each path begins at the node
/// nearest to its first point, which earlier paths may have made, and goes on along its points in edges of
/// equal length: straight to the first point where that is farther than half of `length`, else to a place one
/// `length` behind it. Where the network is empty, the first point becomes its root. No node gets more than
/// two children by it. @p added counts the new nodes, which are numbered from @p first; both may be NULL.
/// VN_INVALID, with the number of the path and the point from 1, for a path that is outside the domain, too
/// far off or a node's third; what was laid before stays.
VN_API vn_status vn_network_follow(vn_network *network, const vn_paths *paths, const vn_follow_def *def,
                                   int32_t *added, int32_t *first);

#ifdef __cplusplus
}
#endif

#endif
