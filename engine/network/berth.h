/// What networks that keep clear of each other know of their own edges: where these are, and how thick each
/// may become before others have to be asked again.
///
/// Every edge has a `room`, at least its radius. Networks that ask (colonize/avoid.c) see to it that for each
/// edge of one and each of another the rooms together are less than the distance of their axes. So an edge
/// that grows thicker within its room needs no look around, and one that wants more takes what the other's
/// radius leaves. What changes otherwise (nodes added by hand, moved, radii raised) did not ask: rooms are
/// then what radii are, and the `epoch` tells the others that what they asked for holds no longer.
#ifndef VN_NETWORK_BERTH_H
#define VN_NETWORK_BERTH_H

#include "network/network.h"

/// Bring it up to date. @p length is that of new edges, or of those of whoever asks first: cells are chosen
/// by it. @p own: this network is the one that is to grow.
vn_status vn_berth_update(vn_network *network, double length, bool own);
void vn_berth_free(vn_berth *berth);

/// Its items are edges by their lower nodes; roots, which are points; and joins, as -1 - join.
void vn_berth_ends(const vn_network *network, int32_t item, double a[3], double b[3]);
/// The radius now; of a root without children, that of a tip.
double vn_berth_radius(const vn_network *network, int32_t item);
double vn_berth_room(const vn_network *network, int32_t item);

/// List the newest node of a network that was up to date, with so much room.
vn_status vn_berth_append(vn_network *network, double room);
/// Let an edge have so much room, more or less than it had.
vn_status vn_berth_claim(vn_network *network, int32_t node, double room);
/// Let an item have no more than so much, but no less than its radius.
void vn_berth_yield(vn_network *network, int32_t item, double room);
/// All rooms are what radii are.
void vn_berth_forget(vn_network *network);

/// How many tips an edge of a network under Murray's law may carry within its room.
static inline int32_t vn_berth_most(const vn_network *network, int32_t node) {
    return network->berth.most.data[node];
}

#endif
