// Where a new terminal is connected (Kerautret et al. 2023, sections 4.3 to 4.5, Algorithm 6): of the nearest
// segments, the one whose bifurcation adds least to the volume of the whole tree and breaks no rule.
#include "cco/cco.h"

#include "space/points.h"

#include <stdlib.h>

// The bifurcation point is known to this part of the triangle when candidates are compared, and to the last
// digit in the one that is taken: the volume is flat about its minimum.
static const double ROUGH = 1e-4, FINE = 1e-8;
// Estimates are within this part of the truth.
static const double DOUBT = 0.05;
enum { ROUGH_ROUNDS = 1, FINE_ROUNDS = 40, KAMIYA_ROUNDS = 500 };

static double inflate_after(const vn_cco *cco, const vn_grower *g) {
    return vn_cco_inflate(cco, g->terminals + 1);
}

static bool make_triangle(const vn_grower *g, int32_t node, const double terminal[3], double flow,
                          vn_triangle *t) {
    const vn_vessel *v = vn_vessel_of(g, node);
    vn_fork rest = vn_tree_fork(&g->tree, node, -1, NULL);
    *t = (vn_triangle){.flow1 = v->flow, .flow2 = flow};
    t->rest_resistance = rest.resistance;
    t->rest_volume = rest.volume;
    t->exponent = vn_tree_exponent(&g->tree, v->flow + flow);
    return vn_triangle_make(t, vn_vessel_of(g, v->parent)->p, v->p, terminal);
}

// A way to the foot of the terminal on the segment: a thin vessel leaves a thick one there.
static void start_near_foot(const vn_triangle *t, double x[2]) {
    double foot = fmin(fmax(t->across[0], 0.15 * t->distal), 0.85 * t->distal);
    x[0] = 0.85 * foot;
    x[1] = 0.15 * t->across[1];
}

static bool find_by_kamiya(const vn_cco *cco, const vn_grower *g, vn_candidate *c) {
    vn_kamiya_fn *solve = cco->def.bifurcation == VN_BIFURCATE_CERES ? vn_ceres_radii : vn_kamiya_radii;
    return vn_bifurcation_kamiya(&g->tree, c->node, &c->triangle, solve, 1e-12, KAMIYA_ROUNDS, c->x,
                                 &c->effect);
}

static bool find_roughly(const vn_cco *cco, vn_grower *g, vn_candidate *c) {
    if (cco->def.bifurcation != VN_BIFURCATE_LEAST) {
        return find_by_kamiya(cco, g, c);
    }
    start_near_foot(&c->triangle, c->x);
    return vn_bifurcation_least(&g->tree, &g->adjoints, c->node, &c->triangle, ROUGH, ROUGH_ROUNDS, c->x,
                                &c->effect);
}

// The exact volume at the point as it is known so far.
static void measure(const vn_cco *cco, const vn_grower *g, vn_candidate *c) {
    vn_branch branches[3];
    if (cco->def.bifurcation == VN_BIFURCATE_LEAST && !c->measured) {
        vn_triangle_branches(&c->triangle, c->x, branches);
        c->effect = vn_tree_effect(&g->tree, c->node, &branches[0]);
    }
    c->measured = true;
}

// To the last digit. What collapses only now is of no use: its volume is set beyond all others'.
static void refine(const vn_cco *cco, const vn_grower *g, vn_candidate *c) {
    if (cco->def.bifurcation == VN_BIFURCATE_LEAST &&
        !vn_bifurcation_refine(&g->tree, c->node, &c->triangle, FINE, FINE_ROUNDS, c->x, &c->effect)) {
        c->effect.volume = INFINITY;
    }
    c->refined = true;
}

static void count_refusal(vn_grower *g, vn_verdict verdict) {
    int64_t *const counts[] = {
        [VN_COLLAPSED] = &g->report.collapsed, [VN_SHORT] = &g->report.short_segments,
        [VN_OUTSIDE] = &g->report.outside,     [VN_CROSSING] = &g->report.crossing,
        [VN_CROWDING] = &g->report.crowding,   [VN_ASYMMETRIC] = &g->report.asymmetric};
    ++*counts[verdict];
}

static vn_status consider(vn_cco *cco, vn_grower *g, int32_t node, const double terminal[3], double flow) {
    vn_candidate c = {.node = node};
    g->report.tried++;
    if (!make_triangle(g, node, terminal, flow, &c.triangle) || !find_roughly(cco, g, &c)) {
        count_refusal(g, VN_COLLAPSED);
        return VN_OK;
    }
    return vn_array_push(&g->candidates, c);
}

static int by_volume(const void *a, const void *b) {
    const vn_candidate *c = a, *d = b;
    if (c->effect.volume != d->effect.volume) {
        return c->effect.volume < d->effect.volume ? -1 : 1;
    }
    return c->node < d->node ? -1 : 1;
}

static void make_plan(const vn_cco *cco, const vn_grower *g, const vn_candidate *c, const double terminal[3],
                      vn_plan *plan) {
    double inflate = inflate_after(cco, g);
    vn_branch b[3];
    *plan = (vn_plan){.node = c->node, .upper = vn_vessel_of(g, c->node)->parent};
    memcpy(plan->terminal, terminal, sizeof plan->terminal);
    vn_triangle_point(&c->triangle, c->x, plan->x);
    vn_triangle_branches(&c->triangle, c->x, b);
    plan->branch = b[0];
    for (int i = 0; i < 3; i++) {
        plan->flow[i] = b[i].flow;
    }
    plan->radius[0] = inflate * c->effect.radius;
    double lengths[3];
    vn_triangle_lengths(&c->triangle, c->x, lengths);
    double fork = b[0].flow * (b[0].resistance - lengths[0]); // H^4
    for (int i = 1; i < 3; i++) {
        plan->radius[i] = plan->radius[0] * sqrt(sqrt(b[i].flow * b[i].resistance / fork));
    }
}

static bool is_uneven(const vn_grower *g, const vn_plan *plan) {
    double thin = fmin(plan->radius[1], plan->radius[2]), thick = fmax(plan->radius[1], plan->radius[2]);
    return thin < g->symmetry * thick;
}

// Lengths alone tell of most candidates that they are too short, before anybody looks around. With @p margin:
// by so many times.
static bool is_short(const vn_grower *g, const vn_plan *plan, double margin) {
    const double *distal = vn_vessel_of(g, plan->node)->p, *start = vn_vessel_of(g, plan->upper)->p;
    double lengths[3] = {sqrt(vn_distance2(start, plan->x)), sqrt(vn_distance2(plan->x, distal)),
                         sqrt(vn_distance2(plan->x, plan->terminal))};
    for (int i = 0; i < 3; i++) {
        if (!vn_plan_is_given(g, plan, i) && vn_is_short(plan->radius[i], margin * lengths[i])) {
            return true;
        }
    }
    return false;
}

static vn_status judge_once(vn_cco *cco, vn_grower *g, vn_plan *plan, vn_verdict *verdict) {
    *verdict = is_short(g, plan, 1) ? VN_SHORT : is_uneven(g, plan) ? VN_ASYMMETRIC : VN_ALLOWED;
    return *verdict == VN_ALLOWED ? vn_rules_judge(cco, g, plan, verdict) : VN_OK;
}

// The first is the parent of the others.
static vn_status insert_all(vn_grower *g, const int32_t *nodes, const double *caps, int count) {
    for (int i = 0; i < count; i++) {
        vn_vessel_of(g, nodes[i])->cap = vn_cap_below(caps[i]);
        VN_TRY(vn_places_insert(g, nodes[i]));
    }
    for (int i = count - 1; i > 0; i--) {
        vn_tree_settle_one(&g->tree, nodes[i]);
    }
    vn_tree_settle(&g->tree, nodes[0]);
    return VN_OK;
}

// Long vessels are cut again and again, and hardly bend: it is told only when it has come to something.
static vn_status tell_darts(vn_grower *g, bool terminals, const int32_t *nodes, int count, double moved) {
    double ends[3][2][3];
    if (terminals) { // these do not move
        const double *p = vn_vessel_of(g, nodes[count - 1])->p;
        memcpy(ends[0][0], p, sizeof ends[0][0]);
        memcpy(ends[0][1], p, sizeof ends[0][1]);
        return vn_darts_tell(&g->darts, &nodes[count - 1], (const double(*)[2][3])ends, 1, 0);
    }
    if (moved <= g->darts.tolerance) {
        nodes += count - 1;
        count = 1;
        moved = 0;
    }
    for (int i = 0; i < count; i++) {
        const vn_vessel *v = vn_vessel_of(g, nodes[i]);
        memcpy(ends[i][0], vn_vessel_of(g, v->parent)->p, sizeof ends[i][0]);
        memcpy(ends[i][1], v->p, sizeof ends[i][1]);
    }
    return vn_darts_tell(&g->darts, nodes, (const double(*)[2][3])ends, count, moved);
}

static vn_status grow_first(const vn_cco *cco, vn_grower *g, const vn_plan *plan, double flow) {
    int32_t node;
    VN_TRY(vn_tree_push(&g->tree, plan->upper, plan->terminal, &node));
    vn_vessel_of(g, node)->flow = flow;
    vn_tree_update(&g->tree, node);
    g->terminals++;
    VN_TRY(insert_all(g, &node, &plan->caps[2], 1));
    return tell_darts(g, cco->def.placement == VN_PLACE_TERMINALS, &node, 1, 0);
}

static vn_status grow_fork(const vn_cco *cco, vn_grower *g, const vn_plan *plan, double flow) {
    int32_t middle, leaf;
    VN_TRY(vn_array_reserve(&g->tree.vessels, (int64_t)g->tree.vessels.count + 2));
    const double *start = vn_vessel_of(g, plan->upper)->p, *end = vn_vessel_of(g, plan->node)->p;
    double moved = sqrt(vn_point_segment_distance2(plan->x, start, end)) + vn_vessel_of(g, plan->node)->bent;
    float bent = moved <= g->darts.tolerance ? (float)moved : 0;
    vn_places_remove(g, plan->node);
    VN_TRY(vn_tree_split(&g->tree, plan->node, plan->x, &middle));
    VN_TRY(vn_tree_push(&g->tree, middle, plan->terminal, &leaf));
    vn_vessel_of(g, leaf)->flow = flow;
    vn_tree_refresh(&g->tree, plan->node);
    vn_tree_update(&g->tree, leaf);
    g->terminals++;
    vn_vessel_of(g, middle)->bent = vn_vessel_of(g, plan->node)->bent = bent;
    int32_t nodes[3] = {middle, plan->node, leaf};
    VN_TRY(insert_all(g, nodes, plan->caps, 3));
    return tell_darts(g, cco->def.placement == VN_PLACE_TERMINALS, nodes, 3, moved);
}

static vn_status connect_first(vn_cco *cco, vn_grower *g, const double terminal[3], double flow, bool *done) {
    vn_plan plan = {.node = -1, .upper = 0};
    vn_verdict verdict;
    memcpy(plan.terminal, terminal, sizeof plan.terminal);
    double length = sqrt(vn_distance2(terminal, vn_vessel_of(g, 0)->p));
    plan.flow[2] = flow;
    plan.radius[2] = inflate_after(cco, g) * sqrt(sqrt(g->tree.factor * flow * length));
    VN_TRY(vn_rules_judge(cco, g, &plan, &verdict));
    *done = verdict == VN_ALLOWED;
    if (!*done) {
        count_refusal(g, verdict);
        return VN_OK;
    }
    return grow_first(cco, g, &plan, flow);
}

// In the order of their volumes: exactly among those that may be best, by the estimates among the rest.
static void sort_candidates(const vn_cco *cco, vn_grower *g) {
    vn_candidate *c = g->candidates.data;
    int32_t count = g->candidates.count, few = 0;
    if (count == 0) {
        return;
    }
    qsort(c, (size_t)count, sizeof *c, by_volume);
    double limit = c[0].effect.volume + DOUBT * fabs(c[0].effect.volume);
    while (few < count && c[few].effect.volume <= limit) {
        few++;
    }
    for (int32_t i = 0; i < few && few > 1; i++) {
        measure(cco, g, &c[i]);
    }
    qsort(c, (size_t)few, sizeof *c, by_volume);
}

// What is short at the rough point need not be at the fine one. By a wide margin it nearly always is, and not
// worth being refined: of 4,000 terminals 6 would have got another vessel. Small trees are looked at closely.
static bool is_hopeless(const vn_cco *cco, const vn_grower *g, const vn_candidate *c,
                        const double terminal[3]) {
    enum { SMALL = 100 };
    const double margin = 1.25;
    vn_plan plan;
    make_plan(cco, g, c, terminal, &plan);
    return g->terminals >= SMALL && is_short(g, &plan, margin);
}

static vn_status try_candidate(vn_cco *cco, vn_grower *g, vn_candidate *c, const double terminal[3],
                               double flow, bool *done) {
    vn_plan plan;
    vn_verdict verdict = VN_COLLAPSED;
    if (!c->refined) {
        measure(cco, g, c);
        c->hopeless = is_hopeless(cco, g, c, terminal);
        if (c->hopeless) {
            c->effect.volume = INFINITY;
            c->refined = true;
        } else {
            refine(cco, g, c);
        }
    }
    verdict = c->hopeless ? VN_SHORT : verdict;
    if (c->effect.volume < INFINITY) {
        make_plan(cco, g, c, terminal, &plan);
        VN_TRY(judge_once(cco, g, &plan, &verdict));
    }
    if (verdict != VN_ALLOWED) {
        count_refusal(g, verdict);
        return VN_OK;
    }
    *done = true;
    return grow_fork(cco, g, &plan, flow);
}

// The best of the candidates that keeps the rules, if any: at first with room to thicken.
static vn_status choose(vn_cco *cco, vn_grower *g, const double terminal[3], double flow, bool *done) {
    bool provident = cco->def.foresight > 0;
    int32_t count = g->candidates.count, tries = cco->patient || !provident ? count : 2 * count;
    sort_candidates(cco, g);
    for (int32_t i = 0; i < tries && !*done; i++) {
        cco->provident = provident && i < count;
        VN_TRY(try_candidate(cco, g, &g->candidates.data[i % count], terminal, flow, done));
    }
    return VN_OK;
}

// Where another terminal can be drawn instead, only the first lot is looked at: beyond it hardly anything is
// found, and that is long and costs volume.
static vn_status connect_near(vn_cco *cco, vn_grower *g, const double terminal[3], double flow, bool *done) {
    int32_t looked = 0, count = cco->def.candidates;
    int32_t most = cco->patient ? count : cco->def.most_candidates;
    for (;; count = count > INT32_MAX / 2 ? INT32_MAX : 2 * count) {
        int32_t all = g->tree.vessels.count;
        VN_TRY(vn_places_nearest(g, terminal, count < all ? count : all));
        g->candidates.count = 0;
        for (int32_t i = looked; i < g->nearest.count; i++) {
            VN_TRY(consider(cco, g, g->nearest.data[i].node, terminal, flow));
        }
        VN_TRY(choose(cco, g, terminal, flow, done));
        if (*done || g->nearest.count < count || count >= most) {
            return VN_OK;
        }
        looked = g->nearest.count;
        VN_TRY(vn_poll());
    }
}

vn_status vn_connect(vn_cco *cco, vn_grower *g, const double terminal[3], double flow, bool *done) {
    *done = false;
    VN_TRY(vn_places_update(cco, g));
    VN_TRY(vn_adjoints_begin(&g->adjoints));
    if (g->tree.vessels.count == 1) {
        return connect_first(cco, g, terminal, flow, done);
    }
    return connect_near(cco, g, terminal, flow, done);
}
