// Statistics by bifurcation level.

#include "network/branches.h"
#include "network/flow.h"
#include "network/leaf.h"

typedef VN_ARRAY(double) number_array;

typedef struct survey {
    const vn_network *network;
    vn_levels *out;
    vn_branches branches;
    number_array symmetry, slenderness, angle;
} survey;

static void free_survey(survey *s) {
    vn_branches_free(&s->branches);
    vn_array_free(&s->symmetry);
    vn_array_free(&s->slenderness);
    vn_array_free(&s->angle);
}

// ---- Levels ----

static vn_status new_levels(survey *s) {
    int32_t deepest = -1;
    for (int32_t i = 0; i < s->branches.list.count; i++) {
        const vn_branch *one = &s->branches.list.data[i];
        deepest = one->level > deepest ? one->level : deepest;
    }
    s->out->count = deepest + 1;
    s->out->segments = s->branches.list.count;
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
    const double *flow = vn_network_flow(s->network);
    for (int32_t i = 0; i < s->branches.list.count; i++) {
        const vn_branch *one = &s->branches.list.data[i];
        vn_level *level = &levels[one->level];
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): the deepest was counted
        level->count++;
        level->diameter.mean += vn_branch_diameter(one);
        level->length.mean += one->length;
        level->flow.mean += flow != NULL ? flow[one->first] : 0;
    }
    for (int32_t k = 0; k < s->out->count; k++) {
        levels[k].diameter.mean /= levels[k].count;
        levels[k].length.mean /= levels[k].count;
        levels[k].flow.mean /= levels[k].count;
    }
    for (int32_t i = 0; i < s->branches.list.count; i++) {
        const vn_branch *one = &s->branches.list.data[i];
        add_square(&levels[one->level].diameter, vn_branch_diameter(one));
        add_square(&levels[one->level].length, one->length);
        add_square(&levels[one->level].flow, flow != NULL ? flow[one->first] : 0);
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

static vn_status add_angle(survey *s, int32_t node) {
    int32_t c = s->network->first_child.data[node], d = s->network->next_child.data[c];
    double u[3], v[3], degrees;
    if (s->network->next_child.data[d] >= 0) {
        return VN_OK;
    }
    vn_edge_direction(s->network, c, u);
    vn_edge_direction(s->network, d, v);
    return vn_angle_between(u, v, &degrees) ? vn_array_push(&s->angle, degrees) : VN_OK;
}

static vn_status look_at_forks(survey *s) {
    for (int32_t node = 0; node < s->network->x.count; node++) {
        if (vn_network_forks(s->network, node)) {
            VN_TRY(add_symmetry(s, node));
            VN_TRY(add_angle(s, node));
        }
    }
    return VN_OK;
}

static vn_status look_at_segments(survey *s) {
    for (int32_t i = 0; i < s->branches.list.count; i++) {
        const vn_branch *one = &s->branches.list.data[i];
        double diameter = vn_branch_diameter(one);
        VN_TRY(diameter > 0 ? vn_array_push(&s->slenderness, one->length / diameter) : VN_OK);
    }
    return VN_OK;
}

// ---- All ----

static vn_status look(survey *s) {
    VN_TRY(vn_branches_find(&s->branches, s->network));
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
