/// @file flow.h
/// What flows through a network: Poiseuille's law on every edge, the audit of what somebody else says flows,
/// and statistics by bifurcation level.
///
/// Pressures are in Pa, the viscosity in Pa s. Lengths are in the network's own unit L, so that flows are in
/// L³/s: with millimetres mm³/s, and a wall shear stress in Pa whatever L is.
#ifndef VENULE_FLOW_H
#define VENULE_FLOW_H

#include "venule/network.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Flow enters at the roots and leaves at the terminals: nodes other than roots that a single edge leads to,
/// joins counted. Pressures are given at both unless a flow is.
typedef enum vn_flow_share {
    VN_SHARE_ROOTS,     ///< every root lets in the same
    VN_SHARE_TERMINALS, ///< every terminal takes the same
} vn_flow_share;

typedef struct vn_flow_def {
    double viscosity;     ///< Pa s, > 0; default 3.6e-3, blood's
    double pressure_in;   ///< Pa, at every root; default 13332.2 (100 mmHg)
    double pressure_out;  ///< Pa, at every terminal, below `pressure_in`; default 7999.32 (60 mmHg)
    double inflow;        ///< L³/s, in all, in place of a pressure where it is shared; default 0: not given
    int share;            ///< of `inflow`, a vn_flow_share: in place of `pressure_in` or of `pressure_out`
    double terminal_flow; ///< L³/s, what each terminal takes in place of `pressure_out`; default 0: not given
    double exponent;      ///< of Murray's law, for its residual; > 0, at most 100; default 3
} vn_flow_def;
VN_API vn_flow_def vn_flow_def_default(void);

/// Where something is the farthest from what it should be.
typedef struct vn_flow_worst {
    double error; ///< relative; 0 or more
    int32_t node; ///< the node, or the node whose edge it is; -1 where nothing was checked, and for joins
    int32_t join; ///< the join, or -1
} vn_flow_worst;

typedef struct vn_terminal {
    int32_t node;
    double pressure; ///< Pa
    double flow;     ///< L³/s, out of the network
} vn_terminal;

/// What vn_network_solve_flow() and vn_network_audit_flow() say; let it go by vn_flow_report_free().
typedef struct vn_flow_report {
    double inflow, outflow; ///< L³/s, at all roots and at all terminals
    double volume;          ///< L³, Σ π r² ℓ over all edges
    double power;           ///< Pa L³/s, Σ R Q²: what the flow dissipates
    double resistance;      ///< Pa s/L³, power / inflow²: for one root ΔP / inflow; 0 where nothing flows
    /// What enters a node less what leaves it, by what passes; where less than 1e-12 of the inflow passes, by
    /// that. Terminals are not asked.
    vn_flow_worst conservation;
    /// An edge's loss of pressure less what Poiseuille's law says, by the span of all pressures.
    vn_flow_worst drop;
    /// A terminal's pressure less `pressure_out`, by `pressure_out` (by the loss from `pressure_in` when that
    /// is 0).
    vn_flow_worst terminal;
    vn_statistics terminal_pressure, terminal_flow;
    vn_statistics wall_shear; ///< Pa, over all edges: 4 μ |Q| / (π r³)
    /// |Σ r^exponent of what leads here - Σ r^exponent of what leads away| / r_parent^exponent at nodes where
    /// three edges or more carry flow; the parent is the one edge on its side, or all that lead here.
    vn_statistics murray;
    vn_statistics fitted; ///< the exponents that make it 0, where one edge meets thinner ones
    vn_terminal *terminals;
    int32_t terminal_count;
    double *edge_shear; ///< Pa, of each node's edge (0 at a root), then of each join
    int32_t edge_count; ///< nodes + joins
} vn_flow_report;
VN_API void vn_flow_report_free(vn_flow_report *report);

/// Solve for the flow in all edges and the pressure at all nodes, and keep them in the network
/// (vn_network_flow(), vn_network_pressure(), vn_network_join_flow()). An edge has the resistance 8 μ ℓ / (π
/// r⁴); the ends of one without a length have one pressure, and what cannot be told of the flow in these is
/// shared equally, or 0 round a circle of them. Trees take one pass up and one down; where joins close loops,
/// a sparse system is left. Parts without a terminal stand still at `pressure_in`.
/// VN_INVALID where an edge has no radius or no finite resistance, pressures are the wrong way round, both
/// flows are given, an inflow can leave nowhere, or a root and a terminal are one place; VN_INFEASIBLE where
/// conductances are too far apart for 1e-9.
VN_API vn_status vn_network_solve_flow(vn_network *network, const vn_flow_def *def, vn_flow_report *report);

/// Say the same of the flows and pressures that the network has, from whomever. Where pressures are not known
/// they follow from the flows, from `pressure_in` at the roots down the trees. Where joins' flows are not
/// known they follow from the pressures. `inflow`, `share` and `terminal_flow` are not asked for. VN_INVALID
/// where flows are not known, or joins' cannot be, or an edge has no radius.
VN_API vn_status vn_network_audit_flow(const vn_network *network, const vn_flow_def *def,
                                       vn_flow_report *report);

/// What flows through a join, from its end `a` to its end `b` as vn_network_join_ends() has them; one entry a
/// join, copied. Holds until the network next changes. VN_INVALID for numbers that are not finite.
VN_API vn_status vn_network_set_join_flow(vn_network *network, const double *flow);
/// Whether anybody said.
VN_API bool vn_network_has_join_flow(const vn_network *network);
/// 0 where nobody did.
VN_API double vn_network_join_flow(const vn_network *network, int32_t join);

typedef struct vn_spread {
    double mean, deviation; ///< of all: divided by how many
} vn_spread;

/// Segments run from a root or a bifurcation (a node with two children or more) to the next bifurcation or
/// tip. Their level is the number of bifurcations on the way from the root to them, the root not counted.
typedef struct vn_level {
    int32_t count;
    vn_spread diameter; ///< L; a segment has the mean diameter of its edges by their lengths
    vn_spread length;   ///< L
    vn_spread flow;     ///< L³/s, of a segment's first edge; 0 where flows are not known
} vn_level;

/// Statistics by level, of the forest: joins are nobody's children. vn_levels_free() lets it go.
typedef struct vn_levels {
    vn_level *levels; ///< from 0
    int32_t count, segments;
    bool has_flow;
    vn_statistics symmetry;    ///< of bifurcations: radius of the thinnest child by that of the thickest
    vn_statistics slenderness; ///< of segments: length by diameter
    vn_statistics angle;       ///< degrees, between the first edges of the two where two leave
} vn_levels;
VN_API vn_status vn_network_levels(const vn_network *network, vn_levels *out);
VN_API void vn_levels_free(vn_levels *levels);

#ifdef __cplusplus
}
#endif

#endif
