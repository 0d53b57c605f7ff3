// Bifurcations: where an edge parts into two.

#include "network/leaf.h"
#include "network/vessels.h"

typedef VN_ARRAY(double) number_array;

typedef struct forks {
    const vn_network *network;
    vn_vessel_measures *out;
    number_array ratio, expansion, between, thick, thin;
} forks;

static void free_forks(forks *f) {
    vn_array_free(&f->ratio);
    vn_array_free(&f->expansion);
    vn_array_free(&f->between);
    vn_array_free(&f->thick);
    vn_array_free(&f->thin);
}

static double degrees_of(double cosine) {
    return 57.29577951308232 * acos(fmin(fmax(cosine, -1), 1));
}

// With r0⁴ - 1 and r0² exact near 1, where the thin branch hardly widens its parent.
vn_fork_angles vn_murray_angles(double ratio, double exponent) {
    double grown = log1p(pow(ratio, exponent)) / exponent; // ln r0
    double square = exp(2 * grown), excess = expm1(4 * grown), thin4 = pow(ratio, 4);
    vn_fork_angles angles = {0};
    if (exponent > 2) {
        angles.thick = degrees_of((excess + 2 - thin4) / (2 * square));
        angles.thin = degrees_of((excess + thin4) / (2 * square * ratio * ratio));
    }
    angles.between = angles.thick + angles.thin;
    return angles;
}

/// What meets in a bifurcation: daughter 1 is the thick one.
typedef struct parting {
    int32_t thick, thin;
    double r0, r1, r2; ///< all 0 where one of them is not known
} parting;

// At equal thickness the lower index leads; without radii too.
static parting fork_at(const forks *f, int32_t node) {
    int32_t c = f->network->first_child.data[node], d = f->network->next_child.data[c];
    double r0 = vn_network_radius(f->network, node);
    double rc = vn_network_radius(f->network, c), rd = vn_network_radius(f->network, d);
    bool first = rc > rd || (rc == rd && c < d);
    parting fork = {first ? c : d, first ? d : c, r0, fmax(rc, rd), fmin(rc, rd)};
    if (!(r0 > 0 && fork.r2 > 0)) {
        fork.r0 = fork.r1 = fork.r2 = 0;
    }
    return fork;
}

static bool find_angles(const forks *f, int32_t node, const parting *fork, vn_fork_angles *angles) {
    double u[3], v[3], w[3];
    vn_edge_direction(f->network, node, u);
    vn_edge_direction(f->network, fork->thick, v);
    vn_edge_direction(f->network, fork->thin, w);
    return vn_angle_between(v, w, &angles->between) && vn_angle_between(u, v, &angles->thick) &&
           vn_angle_between(u, w, &angles->thin);
}

static void add_to_bin(forks *f, double ratio, const vn_fork_angles *angles) {
    int32_t bins = f->out->bin_count, k = (int32_t)(ratio * bins);
    vn_fork_bin *bin = &f->out->bins[k < bins ? k : bins - 1];
    bin->count++;
    bin->ratio += (ratio - bin->ratio) / bin->count;
    vn_spread_add(&bin->between, bin->count, angles->between);
    vn_spread_add(&bin->thick, bin->count, angles->thick);
    vn_spread_add(&bin->thin, bin->count, angles->thin);
}

static vn_status add_angles(forks *f, const parting *fork, const vn_fork_angles *angles) {
    VN_TRY(vn_array_push(&f->between, angles->between));
    if (!(fork->r2 > 0)) {
        return VN_OK;
    }
    add_to_bin(f, fork->r2 / fork->r1, angles);
    VN_TRY(vn_array_push(&f->thick, angles->thick));
    return vn_array_push(&f->thin, angles->thin);
}

static vn_status add_fork(forks *f, int32_t node) {
    vn_fork_angles angles;
    parting fork = fork_at(f, node);
    f->out->bifurcations++;
    if (fork.r2 > 0) {
        double a = fork.r1 / fork.r0, b = fork.r2 / fork.r0;
        VN_TRY(vn_array_push(&f->ratio, fork.r2 / fork.r1));
        VN_TRY(vn_array_push(&f->expansion, a * a + b * b));
    }
    return find_angles(f, node, &fork, &angles) ? add_angles(f, &fork, &angles) : VN_OK;
}

static vn_status look_at_node(forks *f, int32_t node) {
    const int32_t *next = f->network->next_child.data;
    if (!vn_network_forks(f->network, node)) {
        return VN_OK;
    }
    bool more = next[next[f->network->first_child.data[node]]] >= 0;
    f->out->furcations += more;
    return more || f->network->parent.data[node] < 0 ? VN_OK : add_fork(f, node);
}

static vn_status new_bins(forks *f) {
    vn_vessel_measures *out = f->out;
    size_t size = (size_t)out->bin_count * sizeof *out->bins;
    out->bins = size > 0 ? vn_new_block(size) : NULL;
    return size > 0 && out->bins == NULL ? vn_fail_memory("bins of angles", size) : VN_OK;
}

static void end_bins(vn_vessel_measures *out) {
    for (int32_t k = 0; k < out->bin_count; k++) {
        vn_fork_bin *bin = &out->bins[k];
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): as many as were counted
        vn_spread_end(&bin->between, bin->count);
        vn_spread_end(&bin->thick, bin->count);
        vn_spread_end(&bin->thin, bin->count);
        bin->theory = bin->count > 0 ? vn_murray_angles(bin->ratio, out->exponent) : (vn_fork_angles){0};
    }
}

static vn_status describe(forks *f) {
    vn_vessel_measures *out = f->out;
    VN_TRY(new_bins(f));
    for (int32_t v = 0; v < f->network->x.count; v++) {
        VN_TRY(look_at_node(f, v));
    }
    end_bins(out);
    VN_TRY(vn_statistics_of(&out->ratio, f->ratio.data, f->ratio.count));
    VN_TRY(vn_statistics_of(&out->expansion, f->expansion.data, f->expansion.count));
    VN_TRY(vn_statistics_of(&out->between, f->between.data, f->between.count));
    VN_TRY(vn_statistics_of(&out->thick, f->thick.data, f->thick.count));
    return vn_statistics_of(&out->thin, f->thin.data, f->thin.count);
}

vn_status vn_vessels_measure_forks(vn_vessel_measures *out, const vn_network *network) {
    forks f = {.network = network, .out = out};
    out->bin_count = vn_network_has_radii(network) ? out->bin_count : 0;
    vn_status status = describe(&f);
    free_forks(&f);
    return status;
}
