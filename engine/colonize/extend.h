/// One call of vn_extend() from inside, for the two ways in which nodes grow: toward attractors from any
/// side (extend.c), or as vessels do, within what a node perceives (sprout.c).
#ifndef VN_COLONIZE_EXTEND_H
#define VN_COLONIZE_EXTEND_H

#include "colonize/attractors.h"
#include "colonize/avoid.h"

typedef struct vn_extension {
    vn_network *network;
    vn_influence *influence;
    vn_attractors *a;
    const vn_extend_def *def;
    int32_t node;                ///< the node that is to grow
    const vn_keyed *begin, *end; ///< its pairs; their values are attractors
    vn_avoidance *avoidance;     ///< NULL: nothing is avoided
} vn_extension;

/// The unit vector @p n from a node to an attractor (0 where they coincide), and how far that is.
double vn_direction_to(const vn_extension *e, int32_t node, int32_t attractor, double n[3]);
/// The sum of the unit vectors from e->node to its attractors.
void vn_sum_directions(const vn_extension *e, double sum[3]);
/// By this an attractor ranks among those of e->node: the least comes first (READINGS R3).
static inline uint64_t vn_rank(const vn_extension *e, int32_t attractor) {
    return vn_hash(e->a->seed, e->a->id.data[attractor], (uint64_t)e->node, 0);
}
/// Where a step from @p node along the unit vector @p n leads, brought onto the domain where that is a
/// surface.
void vn_step_from(const vn_extension *e, int32_t node, const double n[3], double p[3]);
/// Whether @p node has a child in the direction of @p p already.
bool vn_has_child_toward(const vn_extension *e, int32_t node, const double p[3]);
/// Whether the edge from @p node to @p p stays inside the domain.
bool vn_stays_inside(const vn_extension *e, int32_t node, const double p[3]);
/// Whether that edge keeps clear of the networks to be avoided; @p forks: the node gets two.
bool vn_keeps_clear(const vn_extension *e, int32_t node, const double p[3], bool forks);
/// Add the edge from @p node to @p p, unless it meets another one that it must not cross.
vn_status vn_grow_edge(const vn_extension *e, int32_t node, const double p[3]);

/// Grow e->node as a vessel.
vn_status vn_sprout(const vn_extension *e);

#endif
