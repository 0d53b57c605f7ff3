/// A flat network as a drawing in the plane: its crossings, the faces between its veins, and which of them
/// are areoles.
#ifndef VN_NETWORK_FACES_H
#define VN_NETWORK_FACES_H

#include "network/network.h"
#include "space/segment_grid.h"

/// Edge e has the half-edges 2e, which leaves its parent, and 2e + 1, which leaves its child. Edges without a
/// length are left out; the nodes at their ends are one node.
typedef struct vn_faces {
    const vn_network *network;
    VN_ARRAY(int32_t) from;     ///< the node that each half-edge leaves
    VN_ARRAY(double) radius;    ///< of each edge
    VN_ARRAY(int32_t) starts;   ///< node v is left by spokes [starts[v], starts[v + 1])
    VN_ARRAY(int32_t) spokes;   ///< half-edges, counter-clockwise round each node
    VN_ARRAY(int32_t) after;    ///< the half-edge that follows round the face on the left
    VN_ARRAY(int32_t) walk;     ///< which walk round a face each half-edge is part of
    VN_ARRAY(int32_t) region;   ///< of each walk: the areole that it bounds, or -1 for the outside
    VN_ARRAY(double) area;      ///< of each areole, without the islands in it
    VN_ARRAY(double) perimeter; ///< of each areole: edges with something else behind them, islands' too
    vn_segment_grid grid;       ///< segment e is edge e
    int32_t components;         ///< connected parts of the network, single nodes too
    int32_t crossings;          ///< pairs of edges that share more than an end that both have; see below
} vn_faces;

/// Counting stops there: the network is no drawing in the plane, by far.
enum { VN_MOST_CROSSINGS = 1000000 };

/// Everything above, of a 2D network. Free it also after a failure.
vn_status vn_faces_find(vn_faces *faces, const vn_network *network);
void vn_faces_free(vn_faces *faces);

static inline int32_t vn_faces_edges(const vn_faces *faces) {
    return faces->radius.count;
}

/// The region on the left of a half-edge.
static inline int32_t vn_faces_left(const vn_faces *faces, int32_t half) {
    return faces->region.data[faces->walk.data[half]];
}

/// vn_faces_find() is made of these.
vn_status vn_faces_count_crossings(vn_faces *faces);
vn_status vn_faces_find_regions(vn_faces *faces);

#endif
