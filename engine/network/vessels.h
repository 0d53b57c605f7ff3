/// What the measures of vessels are made of.
#ifndef VN_NETWORK_VESSELS_H
#define VN_NETWORK_VESSELS_H

#include "network/branches.h"
#include "venule/vessel_measures.h"

extern const vn_schema vn_vessel_measures_schema;
extern const vn_schema vn_boxes_schema;
extern const vn_schema vn_tissue_schema;

/// Murray's law at junctions: `murray` and `fitted` with what belongs to them.
vn_status vn_vessels_measure_junctions(vn_vessel_measures *out, const vn_network *network);

/// Angles, ratios and areas at bifurcations; allocates as many bins as `bin_count` says.
vn_status vn_vessels_measure_forks(vn_vessel_measures *out, const vn_network *network);

/// Orders and all that goes by them; @p element gets the element of each branch.
vn_status vn_vessels_measure_orders(vn_vessel_measures *out, const vn_network *network,
                                    const vn_branches *branches, int orders, int32_t *element);

/// Welford's running mean; `deviation` is a sum of squares until vn_spread_end(). @p count includes @p value.
static inline void vn_spread_add(vn_spread *spread, int32_t count, double value) {
    double off = value - spread->mean;
    spread->mean += off / count;
    spread->deviation += off * (value - spread->mean);
}

static inline void vn_spread_end(vn_spread *spread, int32_t count) {
    spread->deviation = count > 0 ? sqrt(spread->deviation / count) : 0;
}

/// The least-squares line through points that are added one by one.
typedef struct vn_line_fit {
    int32_t count;
    double x, y; ///< means
    double xx, xy, yy;
} vn_line_fit;

static inline void vn_line_add(vn_line_fit *fit, double x, double y) {
    double dx = x - fit->x, dy = y - fit->y;
    fit->count++;
    fit->x += dx / fit->count;
    fit->y += dy / fit->count;
    fit->xx += dx * (x - fit->x);
    fit->xy += dx * (y - fit->y);
    fit->yy += dy * (y - fit->y);
}

/// Of two or more points with different x.
static inline double vn_line_slope(const vn_line_fit *fit) {
    return fit->xy / fit->xx;
}

/// The part of the variance that the line explains; 1 where there is none.
static inline double vn_line_r2(const vn_line_fit *fit) {
    return fit->yy > 0 ? fit->xy * fit->xy / (fit->xx * fit->yy) : 1;
}

#endif
