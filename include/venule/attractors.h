/// @file attractors.h
/// Points that attract (auxin sources, oxygen drains), and the steps of space colonisation:
/// throw → influence → extend → consume (Runions et al. 2005, sections 3.3 and 3.4).
#ifndef VENULE_ATTRACTORS_H
#define VENULE_ATTRACTORS_H

#include "venule/domain.h"
#include "venule/growth.h"
#include "venule/network.h"

#ifdef __cplusplus
extern "C" {
#endif

/// A set of attractors, numbered from 0. Consumed ones leave the set, and those after them move up.
typedef struct vn_attractors vn_attractors;

typedef struct vn_attractors_def {
    int32_t dim;  ///< 2 or 3; default 2
    int64_t seed; ///< decides ties between nodes that are equally near (READINGS R3); default 0
} vn_attractors_def;
VN_API vn_attractors_def vn_attractors_def_default(void);
VN_API vn_status vn_attractors_create(vn_attractors **out, const vn_attractors_def *def);
VN_API void vn_attractors_destroy(vn_attractors *attractors);

/// Add one. VN_INVALID for a point that is not finite.
VN_API vn_status vn_attractors_add(vn_attractors *attractors, const double p[3]);
VN_API int vn_attractors_dim(const vn_attractors *attractors);
VN_API int32_t vn_attractors_count(const vn_attractors *attractors);
/// Where attractor @p index is, into @p p.
VN_API vn_status vn_attractors_position(vn_attractors *attractors, int32_t index, double p[3]);

/// Those that were given up so far, and why.
typedef struct vn_retired {
    int32_t hidden;  ///< no node sees them without leaving the domain
    int32_t circled; ///< veins grew for them many times and came no nearer (segments too long for the kill
                     ///< distance)
    int32_t barred;  ///< the vein that they drew alone would have crossed another one (VN_MEET_STOP), or
                     ///< what they drew many times would have come too near to networks to be avoided
} vn_retired;
VN_API vn_retired vn_attractors_retired(const vn_attractors *attractors);
/// Those that wait beyond a marginal blade's margin.
VN_API int32_t vn_attractors_dormant(const vn_attractors *attractors);

/// What part of the darts is kept at a point, 0 to 1, from whoever knows. VN_CALLBACK when it fails.
typedef vn_status vn_weight_fn(double *weight, const double p[3], void *payload);

typedef struct vn_throw_def {
    vn_domain *domain; ///< where; held by the set until it is destroyed when its margin grows
    int32_t count;     ///< darts; or
    double density;   ///< darts per area (volume) of the domain; what is less than one dart is carried to the
                      ///< next call
    double spacing;   ///< birth distance b_s: a dart this close to an attractor is refused; 0: none is
    double clearance; ///< birth distance b_v: a dart this close to a node of `network` is refused; 0: none is
    vn_network *network; ///< what to keep clear of; may be NULL
    vn_domain *weight; ///< a dart is kept with the probability vn_domain_value() of this where it falls; may
                       ///< be NULL
    vn_weight_fn *weight_at; ///< or with this one's; may be NULL. Called by one thread, dart after dart
    void *weight_payload;
    vn_rng *rng; ///< required; moves on by one
} vn_throw_def;
VN_API vn_throw_def vn_throw_def_default(void);
/// Throw darts, uniformly distributed over the domain. Each is kept with the probability that `weight` has
/// where it falls (the lesser, where both kinds of weight are given): so the darts are as dense as the
/// weight, and `count` or `density` where that is 1. One after another each of those is accepted when it is
/// farther than `spacing` from all attractors, those of this call included, and farther than `clearance` from
/// all nodes. Into a marginal growth, the darts of the whole grown shape's square are thrown once, and
/// weighed all over that square; each call releases those that the margin has passed since (READINGS R2). @p
/// accepted gets how many were added. VN_INFEASIBLE when no dart can hit the domain, VN_INVALID for a weight
/// that is not from 0 to 1.
VN_API vn_status vn_throw(vn_attractors *attractors, const vn_throw_def *def, int32_t *accepted);
/// Release the dormant attractors that the margin of the domain has passed; what vn_throw() does by itself.
VN_API vn_status vn_release(vn_attractors *attractors, vn_network *network, int32_t *released);

/// Move the attractors as the last step of @p growth moved the tissue; what each remembers of nodes is looked
/// for anew. None is dropped, and those that wait for a margin stay. Once a step, as vn_growth_carry().
VN_API vn_status vn_attractors_carry(vn_attractors *attractors, vn_growth *growth);

/// What the nodes of a vessel perceive (Rauch & Harders 2021, section 3).
typedef struct vn_perception {
    double angle; ///< γ, degrees, above 0, at most 360: a leaf perceives what lies within γ/2 of its own
                  ///< direction (Equation 2); 0 (the default): every node perceives all around
    bool lateral; ///< default true: inter-nodes, with one child, perceive what lies within γ/2 of Murray's
                  ///< optimal branch (Equations 1 and 3), and grow laterals
} vn_perception;
VN_API vn_perception vn_perception_default(void);

/// The shape of a node's perception volume, within the attraction distance of it.
typedef enum vn_zone_kind {
    VN_ZONE_NONE, ///< the node cannot grow any more
    VN_ZONE_BALL, ///< a root without a heading perceives all around (READINGS R17)
    VN_ZONE_CONE, ///< a leaf's, or a root's with a heading: around its direction
    VN_ZONE_BELT, ///< an inter-node's: what is between two cones around its direction
} vn_zone_kind;
typedef struct vn_zone_shape {
    vn_zone_kind kind;
    double direction[3]; ///< of the edge to the parent; 0 where there is none
    double angle;        ///< degrees from there to the middle of the zone: 0 in a cone, α in a belt
} vn_zone_shape;
/// What @p node perceives now. With an angle, VN_INVALID without Murray's
/// law, and where its exponent is not in (2, 4].
VN_API vn_status vn_network_zone(const vn_network *network, int32_t node, const vn_perception *perception,
                                 vn_zone_shape *out);

typedef struct vn_influence_def {
    int mode; ///< 0 "nearest": each attractor influences the node nearest to it; 1 "relative": its relative
              ///< neighbors among the nodes (Runions §4, READINGS R4), exactly; 2 "urquhart": those of its
              ///< Delaunay neighbors that no other one of them excludes (§5.2, R5)
    double
        within; ///< attraction distance: nodes farther away are not influenced; 0 (the default): any distance
    /// With an angle, in mode "nearest": each attractor influences the nearest node that can still grow, if
    /// that one perceives it, and otherwise none (READINGS R16). Needs Murray's law, with an exponent above 2
    /// and at most 4.
    vn_perception perception;
} vn_influence_def;
VN_API vn_influence_def vn_influence_def_default(void);

/// Which attractors influence which nodes: pairs sorted by attractor, then node.
typedef struct vn_influence vn_influence;
/// Find them. Equally near nodes are ranked by a hash of (seed, attractor, node): the step is
/// left out of READINGS R3's key, so that a rank does not depend on when it is asked for. The result is good
/// until the attractors or the network change; a later call may reuse @p *out, which is NULL at first.
VN_API vn_status vn_influence_find(vn_influence **out, vn_attractors *attractors, vn_network *network,
                                   const vn_influence_def *def);
VN_API void vn_influence_destroy(vn_influence *influence);
/// Bytes that it holds: for a host whose own garbage collector sees only a pointer.
VN_API size_t vn_influence_bytes(const vn_influence *influence);
VN_API int32_t vn_influence_count(const vn_influence *influence);
/// The attractor of a pair, as vn_attractors_position() numbers them; -1 when the influence is not current.
VN_API int32_t vn_influence_attractor(const vn_influence *influence, int32_t pair);
VN_API int32_t vn_influence_node(const vn_influence *influence, int32_t pair);
/// Whether neither the attractors nor the network changed since.
VN_API bool vn_influence_current(const vn_influence *influence);

enum { VN_MEET_CROSS, VN_MEET_JOIN, VN_MEET_STOP };
enum { VN_MOST_AVOIDED = 16 };

typedef struct vn_extend_def {
    double length;     ///< D, the length of a vein segment; > 0; default 1
    vn_domain *domain; ///< an edge that would leave it is not made, and new nodes are brought onto it where
                       ///< it is a surface; held by the attractors; may be NULL
    int meet;    ///< what a vein does that would cross another one: 0 "cross", as in the papers; 1 "join":
                 ///< it ends there, joined to the other vein; 2 "stop": it does not grow, and attractors that
                 ///< draw no other node are retired (both in 2D)
    double bias; ///< ω, 0 to 1, with perception: how much of the parent's direction, or of the optimal
                 ///< branch, is in the new segment's (Equation 4); default 0
    bool bias_mean;   ///< with perception: weigh ω against the mean of the directions to the attractors, of
                      ///< length 1; default false: against their sum, as printed (READINGS R18)
    double bifurcate; ///< φ, degrees, above 0, at most 180, with perception: a leaf forks symmetrically where
                      ///< its attractors deviate more from their mean direction (R19); 0 (the default): never
    /// Networks whose edges this one's never touch, each taken as a round tube: an edge is not made that
    /// would, nor one by which an edge above it would become thick enough to. With mode "nearest", on
    /// networks without joins and veinlets; not with VN_MEET_JOIN. Networks that grow by turns must each
    /// avoid the other: one that does not ask may grow into one that does. What overlaps already, or is made
    /// to (by nodes added or moved, by radii raised), stays so, and keeps clear of the rest.
    vn_network *avoid[VN_MOST_AVOIDED];
    int32_t avoid_count;
    double gap; ///< what a new edge leaves free beside it, beyond both radii, so that both can grow thicker;
                ///< nearer by, it may start and lead away; default -1: a quarter of `length`
} vn_extend_def;
VN_API vn_extend_def vn_extend_def_default(void);
/// Add a node to each influenced one, in the mean direction of its attractors (Equation 1). Where that
/// direction vanishes, or has a child already, the node grows toward its first-ranked attractor alone
/// (READINGS R3). Where the edge would leave the domain, each of the attractors is tried alone, then given to
/// the nearest node that sees it, or it waits for one; what still waits when nothing else can grow is
/// retired. Under perception a leaf grows one segment or forks in two, an inter-node gets one lateral, and a
/// node that cannot grow into its zone without leaving the domain lets its attractors idle. @p added gets how
/// many nodes and joins there are more, @p first the index of the first such node. Counts the network's step
/// on. A node whose step would come too near to networks to be avoided tries each attractor alone too; those
/// that nothing comes nearer to are given up after two dozen calls. VN_INVALID for a root without children
/// within a tube of such a network: nothing can grow from there.
/// When it adds none, and neither attractors nor domain change, no later call will; but where attractors
/// influence several nodes each, some may stand in each other's way until, after two dozen calls, they are
/// given up.
VN_API vn_status vn_extend(vn_network *network, vn_influence *influence, const vn_extend_def *def,
                           int32_t *added, int32_t *first);

enum { VN_CONSUME_ANY, VN_CONSUME_ALL, VN_CONSUME_TAGGED };

typedef struct vn_consume_def {
    double distance; ///< kill distance d_k; > 0; default 1
    int mode; ///< 0 "any": one node closer than the distance is enough; 1 "all": all nodes that it influences
              ///< are (Webb); 2 "tagged": all veins are that it drew when the first one came (Runions §4,
              ///< READINGS R6). With influence "nearest" these are the same
    vn_attractors *into; ///< consumed ones are added to this set; may be NULL
} vn_consume_def;
VN_API vn_consume_def vn_consume_def_default(void);
/// Remove the attractors that a node has reached. @p consumed gets how many. In the mode "tagged" the ends of
/// veins that came to one attractor and are within twice the segment length of one another (that of the last
/// vn_extend()) meet in one new node at the attractor, or amid themselves where it is farther off: a child of
/// the first that came, with joins from the others. A tagged vein that has not come nearer for
/// ⌈2 distance / length⌉ + 2 steps is waited for no longer.
VN_API vn_status vn_consume(vn_attractors *attractors, vn_network *network, const vn_consume_def *def,
                            int32_t *consumed);

#ifdef __cplusplus
}
#endif

#endif
