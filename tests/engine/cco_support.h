/// What the tests of arterial trees share: organs, trees in them, and the laws that a tree must obey as its
/// network has it, recomputed from that alone.
#ifndef VN_TESTS_CCO_SUPPORT_H
#define VN_TESTS_CCO_SUPPORT_H

#include "support.h"

#include "domain/domain.h"
#include "network/network.h"
#include "space/tube_grid.h"

vn_domain *disk_of_measure(double area);
vn_domain *ball_of_measure(double volume);
double top_of(const vn_domain *domain);

/// No trees yet.
vn_cco *organ_of(vn_domain *domain, int32_t terminals, int64_t seed);
/// With a tree of default physics from the top of the domain.
vn_cco *started(vn_domain *domain, int32_t terminals, int64_t seed);
int32_t add_tree(vn_cco *cco, const vn_cco_tree_def *def);
/// Until every tree has its terminals.
void grow_all(vn_cco *cco);
vn_network *network_at(const vn_cco *cco, int32_t tree);
void report(const vn_cco *cco, const char *what, double seconds);

/// What a tree was grown by.
typedef struct laws {
    double inflow; ///< 0: not known
    double pressure_in, pressure_out;
    double exponent;
    const double *exponents; ///< flow, exponent, …; or NULL
    int32_t exponent_count;
    double border, symmetry;
    int32_t given; ///< the first so many nodes may lie anyhow
    bool venous;
} laws;
laws laws_default(void);

/// Distance between a node and its parent.
double length_of(const vn_network *n, int32_t node);
/// Flows add up, pressures follow Poiseuille's law and end at P_out.
void check_flow(const vn_network *n, const laws *l);
/// No two tubes meet that share no end; the networks may be the same.
void check_pairs(const vn_network *a, const vn_network *b);
/// All laws: flow, Equations 3 to 6, no crossings, 2 r <= l, inside, symmetry.
void check_laws(const vn_network *n, const vn_domain *domain, const laws *l);

/// Two counts of the same classes: how many standard deviations their chi-square is above what is expected of
/// samples of one distribution.
double two_sample_excess(const int32_t *a, const int32_t *b, int32_t classes);

#endif
