/// The set of attractors from inside: what each remembers, and how that is kept current.
#ifndef VN_COLONIZE_ATTRACTORS_H
#define VN_COLONIZE_ATTRACTORS_H

#include "base/schema.h"
#include "colonize/perception.h"
#include "network/network.h"
#include "space/cover.h"
#include "space/reach_tree.h"
#include "venule/attractors.h"

extern const vn_schema vn_attractors_schema;
extern const vn_schema vn_throw_schema;
extern const vn_schema vn_influence_schema;
extern const vn_schema vn_perception_schema;
extern const vn_schema vn_extend_schema;
extern const vn_schema vn_consume_schema;

/// A dart beyond a growing margin, and the length of the blade at which the margin passes it.
typedef struct vn_dormant {
    double arrival;
    double p[3];
} vn_dormant;

/// One of the nodes that an attractor draws: a member of V(s), Runions §4.
typedef struct vn_tie {
    int32_t node, next;
    float best;   ///< the distance from which a tagged vein's progress is counted
    uint8_t idle; ///< steps without any
    uint8_t state;
} vn_tie;

/// The bits of a tie's `state`. A vein that grows hands all but the last on to its new node.
enum {
    VN_TAGGED = 1,  ///< the attractor was reached while this vein was drawn by it
    VN_REACHED = 2, ///< it is within the kill distance, and no longer drawn
    VN_LEFT = 4,    ///< tagged, but it does not come nearer any more
    VN_GREW = 8,    ///< it grew toward the attractor: it is no bystander
    VN_GHOST = 16,  ///< a member no more; kept until the step is over, for its children to ask, or as an end
                    ///< that came
};

/// An attractor is not perceived while its nearest node is this one, has this first child (-1: none), and
/// that one fewer tips than these.
typedef struct vn_sleep {
    int32_t node, child, tips;
} vn_sleep;

/// Nodes that keep most new ones from becoming neighbors of an attractor: its nearest neighbor, and what was
/// found in its lunes.
enum { VN_GUARDS = 4 };
typedef struct vn_guards {
    struct {
        double distance2; ///< from the attractor; INFINITY: nobody is posted
        double at[3];
    } post[VN_GUARDS];
    int32_t turn; ///< which of them gives way next
} vn_guards;

/// The stages of an attractor that draws several veins.
enum {
    VN_FREE = 0,
    VN_TOUCHED = 1, ///< a vein has reached it, and it waits for the others
};

/// How an attractor finds the nodes that it draws: "nearest", "relative", "urquhart".
enum { VN_NEAREST, VN_RELATIVE, VN_URQUHART };

/// Attractors keep their place here when one is consumed (`near2` turns negative), and move up only when more
/// than half are gone; the public numbering passes over the gaps.
///
/// Each remembers the node nearest to it. A new node is shown to those it may be nearer to (the reach tree),
/// a new attractor asks the network's grid: so a step costs what changed, not what there is.
struct vn_attractors {
    int dim;
    uint64_t seed;
    VN_ARRAY(double) x;
    VN_ARRAY(double) y;
    VN_ARRAY(double) z; ///< 3D only
    VN_ARRAY(double)
    near2; ///< squared distance of `node`, or of the reach while there is none; negative: gone
    VN_ARRAY(int32_t) node; ///< the nearest, or the nearest that sees it (VN_HIDDEN); -1: none within reach
    VN_ARRAY(uint32_t) id;  ///< by birth; what ties are hashed by
    VN_ARRAY(float) best;   ///< the distance from which progress is counted
    VN_ARRAY(uint8_t) idle; ///< how patient it still is: see VN_HIDDEN
    int32_t gone;
    uint32_t born;
    uint64_t serial; ///< which set this is, among all of the process
    uint64_t version;
    vn_retired retired;

    // The closed modes: `near2` is then the squared distance beyond which no new node matters, and `node` the
    // first of the ties.
    int mode;
    VN_ARRAY(int32_t) first_tie;
    VN_ARRAY(uint8_t) stage;
    VN_ARRAY(vn_guards) guards;
    VN_ARRAY(double) farthest2; ///< no neighbor is farther
    VN_ARRAY(vn_tie) ties;      ///< of all attractors, in lists
    uint64_t ties_serial;       ///< the network that they belong to
    int32_t free_tie;           ///< the first of those not in use, or -1
    VN_ARRAY(int32_t) touched;  ///< attractors that were reached and wait for other veins
    vn_keyed_array news;        ///< the attractors that new nodes may matter to, and these nodes
    VN_ARRAY(int32_t) outdated; ///< whose Urquhart neighbors have to be found anew
    vn_indices candidates;      ///< working memory
    vn_found_array near_nodes;
    int32_t minded_step; ///< the network's step of the last look at the touched ones
    bool tagging;        ///< touched ones wait for tagged veins, rather than for all

    vn_extend_def last; ///< how the veins grow; its domain is held
    vn_box room;        ///< where new nodes can be, while `has_room`
    bool has_room;

    VN_ARRAY(vn_sleep) sleep; ///< of attractors that were not perceived; may be shorter than the set
    uint64_t turned;          ///< the network's, when these fell asleep
    vn_gaze gaze;             ///< where it is open, `node` is the nearest that may still grow

    // What the remembered nodes were taken from.
    uint64_t network_serial, network_moved;
    double reach2;
    int32_t nodes_seen, attractors_seen;
    vn_reach_tree tree;
    int32_t tree_count; ///< attractors from here on are not in the tree yet
    vn_reach_hits hits; ///< working memory
    vn_keyed_array nodes;
    vn_keyed_array by_node;

    VN_ARRAY(int32_t)
    active; ///< those that have a node, ascending; gone ones are dropped when it is next read
    vn_keyed_array activated; ///< those that got their first node since
    vn_keyed_array scratch;
    vn_reach_hits fresh; ///< those that a node came nearer to since the last consume
    bool fresh_all;      ///< too many to list
    double consumed2;    ///< kill distance² up to which all the others were consumed

    vn_point_grid grid;        ///< of the attractors, for `spacing`, and for what vessels perceive
    uint32_t grid_born;        ///< the next `id` when its cells were chosen
    VN_ARRAY(int32_t) present; ///< the public numbering
    uint64_t present_version;

    VN_ARRAY(int32_t) refusers;          ///< of darts, by where these fell (throw.c)
    vn_cover cover;                      ///< of what is too near to nodes, so long as
    uint64_t cover_network, cover_moved; ///< these are those it was made of:
    int32_t cover_nodes;                 ///< so many
    int64_t cover_darts;                 ///< thrown since it was made
    double carry;                        ///< the fraction of a dart that is still to be thrown
    vn_domain *sight;                    ///< what hides nodes from attractors
    VN_ARRAY(int32_t) waiting;           ///< those that no node sees yet
    int32_t next_look;                   ///< the network's step at which they look again
    uint64_t roots_serial;               ///< the network whose roots were found inside the domain,
    int32_t roots_inside;                ///< and how many those were
    vn_domain *margin;                   ///< what the dormant ones wait for
    double margin_clearance;
    VN_ARRAY(vn_dormant) dormant; ///< by falling arrival: the next to wake is the last
};

/// The bits of `idle`: whether the border hid its nearest node, how often it turned to another one, steps
/// without progress.
enum { VN_HIDDEN = 0x80, VN_TURN = 0x20, VN_TURNS = 0x60, VN_IDLE = 0x1F };

static inline vn_points vn_attractors_points(const vn_attractors *a) {
    return (vn_points){a->x.data, a->y.data, a->dim == 3 ? a->z.data : NULL};
}

static inline void vn_attractors_place(const vn_attractors *a, int32_t i, double p[3]) {
    vn_points points = vn_attractors_points(a);
    vn_points_get(&points, i, p);
}

/// The squared distance of attractor @p i from a node.
static inline double vn_attractors_distance2(const vn_attractors *a, const vn_network *network, int32_t i,
                                             int32_t node) {
    double p[3], q[3];
    vn_attractors_place(a, i, p);
    vn_network_position(network, node, q);
    return vn_distance2(p, q);
}

/// Whether all attractors have to be asked if a node is within @p distance, rather than the fresh ones.
static inline bool vn_attractors_ask_all(const vn_attractors *a, double distance) {
    return a->fresh_all || distance * distance > a->consumed2;
}

static inline bool vn_is_gone(const vn_attractors *a, int32_t i) {
    return a->near2.data[i] < 0;
}

/// Take attractor @p i out; its place stays until vn_attractors_tidy().
void vn_attractors_remove(vn_attractors *a, int32_t i);

/// Make room for so many more at once, when it is known that all will come.
vn_status vn_attractors_expect(vn_attractors *a, int64_t more);

/// Close the gaps when they are more than half. What holds internal numbers must not be in use.
vn_status vn_attractors_tidy(vn_attractors *a);

/// Bring the remembered nodes of @p mode up to date with @p network, for all nodes up to @p reach away.
vn_status vn_attractors_sync(vn_attractors *a, vn_network *network, int mode, double reach);
/// Drop all that is remembered of nodes; the next sync looks anew.
void vn_attractors_forget(vn_attractors *a);

// turn.c: the attractors of vessels, where the gaze is open.
/// How far they look, or 0 where that is anywhere.
double vn_attractors_reach(const vn_attractors *a);
/// Let attractor @p i remember the nearest node that can still grow.
vn_status vn_look_for_grower(vn_attractors *a, vn_network *network, int32_t i);
/// Hand every attractor of the active ones that is perceived to @p push, with its node, both within @p within
/// of each other. Those whose node cannot grow any more turn to another one.
vn_status vn_attractors_turn(vn_attractors *a, vn_network *network, double within,
                             vn_status (*push)(void *payload, int32_t attractor, int32_t node),
                             void *payload);

/// Remember that attractor @p i has a node at squared distance @p d2 that it did not have before.
vn_status vn_attractors_note_fresh(vn_attractors *a, int32_t i, double d2);

// neighbors.c: V(s), in the closed modes.
vn_status vn_ties_prepare(vn_attractors *a);
/// Turn all ties into ghosts: V(s) is to be found anew, and veins keep their tags; but not how near they
/// came, when nodes moved.
void vn_ties_forget(vn_attractors *a, bool moved);
/// Drop all ties, and what waited for them: those of another network say nothing of this one's nodes.
void vn_ties_leave(vn_attractors *a);
void vn_ties_drop(vn_attractors *a, int32_t i);
void vn_ties_drop_ghosts(vn_attractors *a, const vn_network *network, int32_t i);
void vn_ties_move(vn_attractors *a, int32_t from, int32_t to);
/// Find V(s) of attractor @p i among all nodes.
vn_status vn_ties_look(vn_attractors *a, vn_network *network, int32_t i);
/// Whether a new node at @p u is neither to become a neighbor nor to drive one out: for certain, and at once;
/// and the place of the node that keeps it out.
bool vn_ties_keep_out(const vn_attractors *a, int32_t i, const double u[3], double d2, double guard[3]);
/// Whether the nodes from @p begin on are where new ones were expected to be.
bool vn_ties_have_room(const vn_attractors *a, const vn_network *network, int32_t begin);
/// Look at the new nodes in `news`.
vn_status vn_ties_show(vn_attractors *a, const vn_network *network);
/// Find anew what new nodes have outdated.
vn_status vn_ties_renew(vn_attractors *a, vn_network *network);

// touch.c: attractors die when all the veins that they draw have come.
vn_status vn_touch(vn_attractors *a, vn_network *network, const vn_consume_def *def, int32_t *consumed);
vn_status vn_consume_one(vn_attractors *a, int32_t i, vn_attractors *into, int32_t *consumed);

// meet.c: an edge that stays clear of others, or ends in the first one that it meets.
typedef enum vn_outcome { VN_CLEAR, VN_MET, VN_BARRED } vn_outcome;
/// Whether a join of @p a and @p b would close a loop of a few edges, no wider than an edge is long: they are
/// connected, twigs of one fork, or one has met the other's neighbor.
bool vn_met_before(const vn_network *network, int32_t a, int32_t b);
/// Whether an edge from @p node to @p p (which is node @p to, or is to be one: -1) is clear of the others, as
/// far as @p def minds what it meets. Where it has veins joined and that can be done, @p node is joined to
/// it.
vn_status vn_meet(vn_network *network, int32_t node, const double p[3], int32_t to, const vn_extend_def *def,
                  vn_outcome *outcome);

/// The attractors in a grid for queries of @p reach; gone ones are in it too.
vn_status vn_attractors_grid(vn_attractors *a, double reach);

/// The internal number of public number @p index, or -1; and back.
vn_status vn_attractors_number(vn_attractors *a, int32_t index, int32_t *internal);
int32_t vn_attractors_public(vn_attractors *a, int32_t internal);

/// Pairs of attractors (internal numbers) and nodes.
struct vn_influence {
    vn_attractors *attractors;
    vn_network *network;
    uint64_t attractors_version, network_version;
    uint64_t network_serial;
    VN_ARRAY(int32_t) attractor;
    VN_ARRAY(int32_t) node;
};

#endif
