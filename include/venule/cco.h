/// @file cco.h
/// Arterial trees by constrained constructive optimisation: the whole of Kerautret et al. 2023 (OpenCCO),
/// after Schreiner and Buxbaum 1993 and Karch et al. 1999. Terminals are placed one by one; each is connected
/// where the whole tree's volume stays least, and every radius follows from the flows and pressures.
///
/// Units are millimetres, Pascal, mm³/s and Pa·s; any others do that are as consistent.
#ifndef VENULE_CCO_H
#define VENULE_CCO_H

#include "venule/domain.h"
#include "venule/network.h"

#ifdef __cplusplus
extern "C" {
#endif

/// One or several trees that grow in one domain.
typedef struct vn_cco vn_cco;

enum { VN_PLACE_SEGMENTS, VN_PLACE_TERMINALS };
enum { VN_BIFURCATE_LEAST, VN_BIFURCATE_KAMIYA, VN_BIFURCATE_CERES };

/// A number at a point, from whoever knows: a density, a flow. VN_CALLBACK when it fails.
typedef vn_status vn_cco_value_fn(double *value, const double p[3], void *payload);

typedef struct vn_cco_def {
    vn_domain *domain;  ///< where everything is to lie; held; not one that grows
    int32_t terminals;  ///< k: how many each tree is to have in the end, those it had at first included; 1 or
                        ///< more; default 1000
    const double *list; ///< x, y, z of the terminals in their order, instead of random ones; borrowed until
                        ///< the last of them was placed; NULL (the default): random
    int32_t list_count; ///< how many
    int64_t seed;       ///< of the random numbers; default 1
    int placement; ///< what a new terminal keeps away from: 0 "segments" (§3.3.2), 1 "terminals" and the
                   ///< insides of vessels (Algorithms 2 and 3); READINGS R11
    int32_t
        tries; ///< darts before the threshold of (15) is lowered; default 0: 100, or 1000 with "terminals"
    double threshold;   ///< what it is multiplied by then; above 0, below 1; default 0.9
    double spacing;     ///< of terminals from vessels, in units of (15); above 0; default 1
    int32_t candidates; ///< nearest segments that are tried first; doubled while none will do; default 20
    int32_t
        most_candidates; ///< but no more than these; default 640, beyond which next to nothing is ever found
    int32_t redraws;     ///< terminals drawn anew before the tree counts as full; default 200
    /// New vessels need room to thicken later: so that a subtree of m terminals may come to 1 + foresight /
    /// sqrt(m) times its share of the flow; less where draw after draw fails in the plane. Without it
    /// vessels near the root get stuck between others now and then, and part of the organ stays empty. 0:
    /// none is asked for; default -1: 4 in space, 1 in the plane, where it hardly happens, 0 for a
    /// list of terminals.
    double foresight;
    int bifurcation;        ///< 0 "least": the point of least volume; 1 "kamiya": Equations 8 to 13 alone; 2
                            ///< "ceres": these with (12) handed to Ceres' tiny solver
    double border_distance; ///< that vessels keep from the border; 0 (the default) or more; length
    bool growing_domain;    ///< sizes hold as if the domain grew with the tree (14); default true
    vn_cco_value_fn *density; ///< how dense the terminals are at a point, 0 to 1; NULL: the same everywhere
    void *density_payload;
} vn_cco_def;
VN_API vn_cco_def vn_cco_def_default(void);

typedef struct vn_cco_tree_def {
    double root[3];         ///< where blood enters, in the domain or on its border
    const vn_network *from; ///< a tree to grow on from instead: its nodes, not its radii; borrowed during
                            ///< the call; may be NULL
    double inflow;          ///< of the whole tree at the end; default 500 mL/min = 8333.33 mm³/s
    double terminal_flow;   ///< of each terminal, instead; 0 (the default): inflow / terminals
    vn_cco_value_fn *flow;  ///< what a terminal's flow is multiplied by where it is; NULL: 1
    void *flow_payload;
    double viscosity;        ///< default 3.6e-3 Pa·s
    double pressure_in;      ///< where blood enters; default 100 mmHg = 13332.2 Pa
    double pressure_out;     ///< where it leaves; default 60 mmHg = 7999.32 Pa
    double exponent;         ///< gamma; 1 to 100; default 3
    const double *exponents; ///< or flow, gamma, flow, gamma, …, rising in flow: gamma by the flow that comes
                             ///< to the bifurcation, between them by its logarithm; borrowed during the call
    int32_t exponent_count; ///< how many pairs
    double symmetry;        ///< a bifurcation whose thinner vessel is below this part of the thicker is
                            ///< refused; 0 (the default) to 1
    bool venous;            ///< blood enters at the terminals and leaves at the root; default false
} vn_cco_tree_def;
VN_API vn_cco_tree_def vn_cco_tree_def_default(void);

/// VN_INVALID for values out of range; VN_INFEASIBLE for a domain without inside.
VN_API vn_status vn_cco_create(vn_cco **out, const vn_cco_def *def);
VN_API void vn_cco_destroy(vn_cco *cco);
/// Add a tree. VN_INVALID when its root is outside the domain or in another tree's vessel, for pressures the
/// wrong way round, flows that are not above 0, a network with joins or without extent.
VN_API vn_status vn_cco_add(vn_cco *cco, const vn_cco_tree_def *def, int32_t *tree);

/// Keep clear of a network that does not grow here: its edges as tubes of their radii.
VN_API vn_status vn_cco_avoid(vn_cco *cco, const vn_network *network);

/// From now on terminals fall into @p part (NULL: the whole domain), until there are @p terminals more of
/// them in each tree: staged growth. Vessels may still pass anywhere in the domain. All stages together
/// cannot have more terminals than the definition says. VN_INVALID with a list.
VN_API vn_status vn_cco_stage(vn_cco *cco, vn_domain *part, int32_t terminals);

/// Add up to @p count terminals to each tree, in turns; @p added gets how many came in all. VN_INFEASIBLE
/// when no place is found for another: the message says how many there are and why; what has grown stays
/// good.
VN_API vn_status vn_cco_grow(vn_cco *cco, int32_t count, int32_t *added);
/// Whether every tree has the terminals it was to have.
VN_API bool vn_cco_done(const vn_cco *cco);
VN_API int32_t vn_cco_tree_count(const vn_cco *cco);

/// What a tree has come to, and what was refused on the way.
typedef struct vn_cco_report {
    int32_t terminals, wanted;
    double volume;          ///< sum of pi r² l of the tree as its network has it
    double inflow;          ///< into its root
    int64_t darts;          ///< tries for terminals, those included that could be skipped as hopeless
    int32_t begun_anew;     ///< times that a tree below a quarter of its size could not go on
    int64_t redrawn;        ///< terminals that could not be connected
    int64_t tried;          ///< candidates whose volume was computed
    int64_t collapsed;      ///< of these: the bifurcation point ran into an end
    int64_t short_segments; ///< shorter than their diameter
    int64_t outside;        ///< not within the domain
    int64_t crossing;       ///< met another vessel
    int64_t crowding;       ///< would have made an older vessel too thick for its place
    int64_t asymmetric;
} vn_cco_report;
VN_API vn_cco_report vn_cco_report_of(const vn_cco *cco, int32_t tree);

/// The tree as a network of its own, in the whole domain, with radius, flow and pressure of the terminals it
/// has now: node 0 is the root, 1 the first terminal, then each bifurcation and its terminal (after the nodes
/// of `from`, which keep their numbers). Of a venous tree flows are negative: they run from child to parent.
VN_API vn_status vn_cco_network(const vn_cco *cco, int32_t tree, vn_network **out);

#ifdef __cplusplus
}
#endif

#endif
