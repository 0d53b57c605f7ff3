// Statistics by bifurcation level.

#include "network/flow.h"
#include "network/leaf.h"

typedef struct segment {
    int32_t level, edges;
    double length;
    double weighted; // Σ diameter · length
    double sum;      // Σ diameter, for segments without a length
    double flow;     // of its first edge
} segment;

typedef VN_ARRAY(double) number_array;

typedef struct survey {
    const vn_network *network;
    vn_levels *out;
    VN_ARRAY(segment) segments;
    VN_ARRAY(int32_t) of; // the segment that each node's edge is part of
    number_array symmetry, slenderness, angle;
} survey;

static void free_survey(survey *s) {
    vn_array_free(&s->segments);
    vn_array_free(&s->of);
    vn_array_free(&s->symmetry);
    vn_array_free(&s->slenderness);
    vn_array_free(&s->angle);
}

static bool forks(const vn_network *network, int32_t node) {
    int32_t first = network->first_child.data[node];
    return first >= 0 && network->next_child.data[first] >= 0;
}

static vn_status add_edge(survey *s, int32_t node) {
    vn_pipe pipe;
    if (!vn_pipe_get(s->network, node, &pipe)) {
        return VN_OK;
    }
    bool from_root = s->network->parent.data[pipe.a] < 0;
    if (from_root || forks(s->network, pipe.a)) {
        const double *flow = vn_network_flow(s->network);
        segment fresh = {.flow = flow != NULL ? flow[node] : 0};
        fresh.level = from_root ? 0 : s->segments.data[s->of.data[pipe.a]].level + 1;
        s->of.data[node] = s->segments.count;
        VN_TRY(vn_array_push(&s->segments, fresh));
    } else {
        s->of.data[node] = s->of.data[pipe.a];
    }
    segment *mine = &s->segments.data[s->of.data[node]];
    mine->edges++;
    mine->length += pipe.length;
    mine->weighted += 2 * pipe.radius * pipe.length;
    mine->sum += 2 * pipe.radius;
    return VN_OK;
}

static double diameter_of(const segment *s) {
    return s->length > 0 ? s->weighted / s->length : s->sum / s->edges;
}

// ---- Levels ----

static vn_status new_levels(survey *s) {
    int32_t deepest = -1;
    for (int32_t i = 0; i < s->segments.count; i++) {
        deepest = s->segments.data[i].level > deepest ? s->segments.data[i].level : deepest;
    }
    s->out->count = deepest + 1;
    s->out->segments = s->segments.count;
    size_t size = (size_t)s->out->count * sizeof *s->out->levels;
    s->out->levels = size > 0 ? vn_new_block(size) : NULL;
    return size > 0 && s->out->levels == NULL ? vn_fail_memory("levels", size) : VN_OK;
}

static void add_square(vn_spread *spread, double value) {
    spread->deviation += (value - spread->mean) * (value - spread->mean);
}

// Means first, then how far from them.
static void fill_levels(survey *s) {
    vn_level *levels = s->out->levels;
    for (int32_t i = 0; i < s->segments.count; i++) {
        const segment *one = &s->segments.data[i];
        vn_level *level = &levels[one->level];
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): the deepest was counted
        level->count++;
        level->diameter.mean += diameter_of(one);
        level->length.mean += one->length;
        level->flow.mean += one->flow;
    }
    for (int32_t k = 0; k < s->out->count; k++) {
        levels[k].diameter.mean /= levels[k].count;
        levels[k].length.mean /= levels[k].count;
        levels[k].flow.mean /= levels[k].count;
    }
    for (int32_t i = 0; i < s->segments.count; i++) {
        const segment *one = &s->segments.data[i];
        add_square(&levels[one->level].diameter, diameter_of(one));
        add_square(&levels[one->level].length, one->length);
        add_square(&levels[one->level].flow, one->flow);
    }
    for (int32_t k = 0; k < s->out->count; k++) {
        levels[k].diameter.deviation = sqrt(levels[k].diameter.deviation / levels[k].count);
        levels[k].length.deviation = sqrt(levels[k].length.deviation / levels[k].count);
        levels[k].flow.deviation = sqrt(levels[k].flow.deviation / levels[k].count);
    }
}

// ---- Bifurcations ----

static vn_status add_symmetry(survey *s, int32_t node) {
    double thin = INFINITY, thick = 0;
    for (int32_t c = s->network->first_child.data[node]; c >= 0; c = s->network->next_child.data[c]) {
        double radius = vn_network_radius(s->network, c);
        thin = fmin(thin, radius);
        thick = fmax(thick, radius);
    }
    return thick > 0 ? vn_array_push(&s->symmetry, thin / thick) : VN_OK;
}

static void direction_to(const vn_network *network, int32_t child, double d[3]) {
    double p[3];
    vn_network_position(network, network->parent.data[child], p);
    vn_network_position(network, child, d);
    for (int k = 0; k < 3; k++) {
        d[k] -= p[k];
    }
}

static vn_status add_angle(survey *s, int32_t node) {
    const double degrees = 57.29577951308232;
    const vn_network *network = s->network;
    int32_t c = network->first_child.data[node], d = network->next_child.data[c];
    double u[3], v[3], w[3];
    if (network->next_child.data[d] >= 0) {
        return VN_OK;
    }
    direction_to(network, c, u);
    direction_to(network, d, v);
    for (int k = 0; k < 3; k++) {
        w[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    }
    double cross = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    double dot = u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
    return cross > 0 || dot < 0 || dot > 0 ? vn_array_push(&s->angle, degrees * atan2(cross, dot)) : VN_OK;
}

static vn_status look_at_forks(survey *s) {
    for (int32_t node = 0; node < s->network->x.count; node++) {
        if (forks(s->network, node)) {
            VN_TRY(add_symmetry(s, node));
            VN_TRY(add_angle(s, node));
        }
    }
    return VN_OK;
}

static vn_status look_at_segments(survey *s) {
    for (int32_t i = 0; i < s->segments.count; i++) {
        const segment *one = &s->segments.data[i];
        double diameter = diameter_of(one);
        VN_TRY(diameter > 0 ? vn_array_push(&s->slenderness, one->length / diameter) : VN_OK);
    }
    return VN_OK;
}

// ---- All ----

static vn_status look(survey *s) {
    VN_TRY(vn_array_zero(&s->of, s->network->x.count));
    for (int32_t k = 0; k < s->network->x.count; k++) {
        VN_TRY(add_edge(s, vn_network_nth(s->network, k)));
    }
    VN_TRY(new_levels(s));
    fill_levels(s);
    VN_TRY(look_at_forks(s));
    VN_TRY(look_at_segments(s));
    VN_TRY(vn_statistics_of(&s->out->symmetry, s->symmetry.data, s->symmetry.count));
    VN_TRY(vn_statistics_of(&s->out->slenderness, s->slenderness.data, s->slenderness.count));
    return vn_statistics_of(&s->out->angle, s->angle.data, s->angle.count);
}

vn_status vn_network_levels(const vn_network *network, vn_levels *out) {
    *out = (vn_levels){.has_flow = vn_network_flow(network) != NULL};
    survey s = {.network = network, .out = out};
    vn_status status = look(&s);
    free_survey(&s);
    if (status != VN_OK) {
        vn_levels_free(out);
    }
    return status;
}

void vn_levels_free(vn_levels *levels) {
    vn_level *list = levels->levels;
    vn_resize(list, list != NULL ? (size_t)levels->count * sizeof *list : 0, 0);
    *levels = (vn_levels){0};
}
