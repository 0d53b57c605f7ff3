// What vessels must not do (Kerautret et al. 2023, sections 3.3.3 and 4.4): be shorter than they are thick,
// leave the domain, or meet another vessel.
//
// Every segment has a cap, a radius up to which it breaks none of these: caps of segments that share no end
// do not overlap, and a segment is never thicker than its cap. A new terminal thickens and thins vessels all
// over the tree, but by the same factor in each subtree beside its way to the root: the slack of these tells
// in one look whether any cap is passed, and only where one is are neighbours asked.
#include "cco/cco.h"

#include "domain/domain.h"
#include "space/points.h"

// What a segment gets more than it needs, where there is room, so that it need not ask soon again.
static const double RESERVE = 1.2;

/// A segment that is to be, or one that is to become thicker, among all others.
typedef struct tube {
    vn_cco *cco;
    vn_grower *g;
    const double *a, *b; ///< upper and lower end
    int32_t node;        ///< in the tree already; or -1
    int32_t cut;         ///< the segment that the plan cuts: it is no obstacle
    int32_t ends[2];     ///< nodes of the tree at its ends, -1: none
    double radius;       ///< it needs this
    double room;         ///< and could have this
    vn_grower *other;    ///< whose vessels are looked at now
    vn_status status;
} tube;

// A subtree of m terminals will not keep its share of the flow: its segments are given room to thicken with
// it, the more the fewer there are in it and the longer the tree has still to grow. Without it, now and then
// vessels near the root stand in each other's way for good, and half of an organ stays empty: of 10 balls of
// 4,000 terminals, 4 did; to let vessels be too thick for a while instead made it 7.
static double foresight(const vn_cco *cco, const vn_grower *g, double flow) {
    if (!cco->provident || g->fixed) {
        return 1;
    }
    double ahead = log2((double)g->wanted / (g->terminals + 1));
    double most = cbrt(1 + cco->foresight / sqrt(fmax(flow / g->terminal_flow, 1)));
    return 1 + (most - 1) * fmin(ahead / 4, 1);
}

static bool is_at(const vn_vessel *v, int32_t node, int32_t end) {
    return end >= 0 && (node == end || v->parent == end);
}

static bool is_obstacle(const tube *t, int32_t node) {
    const vn_vessel *v = vn_vessel_of(t->other, node);
    if (v->parent < 0) {
        return false;
    }
    if (t->other != t->g) {
        return true;
    }
    return node != t->node && node != t->cut && !is_at(v, node, t->ends[0]) && !is_at(v, node, t->ends[1]);
}

// Of the tree that grows, as it will be once it has a terminal more: sizes fall a little with each.
static double radius_of(const tube *t, const vn_grower *g, int32_t node) {
    int32_t terminals = g->terminals + (g == t->g);
    return vn_cco_inflate(t->cco, terminals) * vn_tree_radius(&g->tree, node);
}

// Whether the other vessel can do with a cap of @p left. What it loses is taken once everybody has agreed:
// the cells that are being looked through hold it.
static bool can_squeeze(tube *t, int32_t node, double left) {
    double wide = (1 + 2e-7) * foresight(t->cco, t->other, vn_vessel_of(t->other, node)->flow);
    if (t->other->fixed || wide * radius_of(t, t->other, node) > left) {
        return false;
    }
    t->status = vn_array_push(&t->cco->squeezes, ((vn_squeeze){t->other, node, left}));
    return t->status == VN_OK;
}

static bool pass(int32_t node, void *payload) {
    tube *t = payload;
    if (!is_obstacle(t, node)) {
        return true;
    }
    const vn_vessel *v = vn_vessel_of(t->other, node);
    const double *end = vn_vessel_of(t->other, v->parent)->p;
    double distance = sqrt(vn_segment_segment_distance2(t->a, t->b, end, v->p)) * (1 - 1e-12);
    if (distance - v->cap >= t->room) {
        return true;
    }
    if (distance - v->cap > t->radius) {
        t->room = distance - v->cap;
        return true;
    }
    t->room = t->radius;
    return can_squeeze(t, node, (distance - t->radius) * (1 - 1e-9));
}

static vn_status squeeze(vn_cco *cco) {
    for (int32_t i = 0; i < cco->squeezes.count; i++) {
        vn_squeeze s = cco->squeezes.data[i];
        VN_TRY(vn_places_set_cap(s.g, s.node, s.left));
        vn_tree_settle(&s.g->tree, s.node);
    }
    return VN_OK;
}

// Whether the segment can have its radius; `room` becomes what it can have besides.
static bool passes_others(tube *t) {
    t->cco->squeezes.count = 0;
    for (int32_t i = 0; i < t->cco->growers.count; i++) {
        t->other = &t->cco->growers.data[i];
        if (!vn_places_visit(t->other, t->a, t->b, t->room, pass, t)) {
            return false;
        }
    }
    t->status = squeeze(t->cco);
    return t->status == VN_OK;
}

static bool is_clear_of_border(const vn_cco *cco, const double a[3], const double b[3], double distance) {
    double length = sqrt(vn_distance2(a, b)), least = 1e-3 * distance + 1e-9 * length;
    for (double at = 0;;) {
        double p[3];
        for (int k = 0; k < 3; k++) {
            p[k] = a[k] + (length > 0 ? at / length : 0) * (b[k] - a[k]);
        }
        double clear = vn_domain_distance(cco->def.domain, p) - distance;
        if (clear < least) {
            return false;
        }
        if (at >= length) {
            return true;
        }
        at = fmin(at + clear, length); // all of it up to there is clear
    }
}

// A segment from a root begins on the border: only its axis has to be inside, and all of its lower end.
static bool is_inside(tube *t, bool stem) {
    const vn_cco *cco = t->cco;
    if (stem) {
        return vn_domain_sees(cco->def.domain, t->a, t->b) &&
               is_clear_of_border(cco, t->b, t->b, t->radius + cco->def.border_distance);
    }
    if (is_clear_of_border(cco, t->a, t->b, t->room + cco->def.border_distance)) {
        return true;
    }
    t->room = t->radius;
    return is_clear_of_border(cco, t->a, t->b, t->radius + cco->def.border_distance);
}

// All rules at once for a tube of length @p length; `room` is what it may be capped at. Those segments that
// were there before may be short and lie where they do.
static vn_verdict judge_tube(tube *t, double length, bool stem, bool given) {
    if ((!given && vn_is_short(t->radius, length)) || !(length > 0)) {
        return VN_SHORT;
    }
    t->room = given ? RESERVE * t->radius : fmin(RESERVE * t->radius, length / 2);
    if (!given && !is_inside(t, stem)) {
        return VN_OUTSIDE;
    }
    return passes_others(t) ? VN_ALLOWED : VN_CROSSING;
}

static bool is_root(const vn_grower *g, int32_t node) {
    return vn_vessel_of(g, node)->parent < 0;
}

/// The plan's segments in their order: upper, lower, new.
typedef struct plan_tubes {
    tube tubes[3];
    double length[3];
} plan_tubes;

static void lay_out(vn_cco *cco, vn_grower *g, const vn_plan *plan, plan_tubes *out) {
    const double *start = vn_vessel_of(g, plan->upper)->p;
    bool first = plan->node < 0;
    const double *ends[3][2] = {{start, plan->x},
                                {plan->x, first ? NULL : vn_vessel_of(g, plan->node)->p},
                                {first ? start : plan->x, plan->terminal}};
    int32_t nodes[3][2] = {{plan->upper, -1}, {plan->node, -1}, {first ? plan->upper : -1, -1}};
    for (int i = first ? 2 : 0; i < 3; i++) {
        tube *t = &out->tubes[i];
        *t = (tube){.cco = cco, .g = g, .a = ends[i][0], .b = ends[i][1], .node = -1, .cut = plan->node};
        memcpy(t->ends, nodes[i], sizeof t->ends);
        t->radius = plan->radius[i] * foresight(cco, g, plan->flow[i]);
        out->length[i] = sqrt(vn_distance2(t->a, t->b));
    }
}

static vn_status judge_plan(vn_grower *g, vn_plan *plan, plan_tubes *p, vn_verdict *verdict) {
    for (int i = plan->node < 0 ? 2 : 0; i < 3; i++) {
        bool stem = i != 1 && is_root(g, plan->upper) && (i == 0 || plan->node < 0);
        *verdict = judge_tube(&p->tubes[i], p->length[i], stem, vn_plan_is_given(g, plan, i));
        VN_TRY(p->tubes[i].status);
        if (*verdict != VN_ALLOWED) {
            return VN_OK;
        }
        plan->caps[i] = p->tubes[i].room;
    }
    return VN_OK;
}

// ---- What the plan does to the vessels that there are ----

static vn_status push(vn_grower *g, int32_t node, double radius) {
    return vn_array_push(&g->stack, ((vn_thickness){node, radius}));
}

// The segments at and below a node that would pass their caps.
static vn_status collect(vn_grower *g, int32_t node, double radius, double inflate) {
    g->stack.count = 0;
    VN_TRY(push(g, node, radius));
    while (g->stack.count > 0) {
        vn_thickness at = g->stack.data[--g->stack.count];
        const vn_vessel *v = vn_vessel_of(g, at.node);
        if (at.radius * inflate <= v->slack) {
            continue;
        }
        if (at.radius * inflate > v->cap) {
            VN_TRY(vn_array_push(&g->crowded, at));
        }
        vn_fork fork = vn_tree_fork(&g->tree, at.node, -1, NULL);
        for (int32_t c = v->first_child; c >= 0; c = vn_vessel_of(g, c)->next_child) {
            VN_TRY(push(g, c, at.radius * vn_tree_beta(&g->tree, c, &fork)));
        }
    }
    return VN_OK;
}

static double symmetry_of(double a, double b) {
    return fmin(a, b) / fmax(a, b);
}

// Whether a fork on the way becomes less even than it may be, and than it was.
static bool is_too_uneven(const vn_grower *g, int32_t parent, int32_t child, const vn_branch *instead,
                          const vn_fork *fork) {
    vn_fork before = vn_tree_fork(&g->tree, parent, -1, NULL);
    double after = sqrt(sqrt(instead->flow * instead->resistance) / fork->square);
    double was = vn_tree_beta(&g->tree, child, &before);
    for (int32_t c = vn_vessel_of(g, parent)->first_child; c >= 0; c = vn_vessel_of(g, c)->next_child) {
        double now = symmetry_of(vn_tree_beta(&g->tree, c, fork), after);
        if (c != child && now < g->symmetry && now < symmetry_of(vn_tree_beta(&g->tree, c, &before), was)) {
            return true;
        }
    }
    return false;
}

// From the plan's upper node to the root, each node's new fork into `path`; and the new radius at the root.
static vn_status walk_up(vn_grower *g, const vn_plan *plan, double *stem, bool *uneven) {
    vn_branch b = plan->branch;
    int32_t child = plan->node, node = plan->upper;
    g->path.count = 0;
    *uneven = false;
    for (; !is_root(g, node); child = node, node = vn_vessel_of(g, node)->parent) {
        vn_fork fork = vn_tree_fork(&g->tree, node, child, &b);
        double beta = sqrt(sqrt(b.flow * b.resistance) / fork.square);
        *uneven = *uneven || (g->symmetry > 0 && is_too_uneven(g, node, child, &b, &fork));
        VN_TRY(vn_array_push(&g->path, ((vn_step){node, child, beta, fork.square})));
        double length = vn_vessel_of(g, node)->length;
        b = (vn_branch){fork.flow, length + fork.resistance, length + fork.volume};
    }
    *stem = sqrt(sqrt(g->tree.factor * b.flow * b.resistance));
    return VN_OK;
}

// Down again: the segments on the way, all that hangs beside it, and what hangs below the segment that is
// cut.
static vn_status walk_down(vn_grower *g, const vn_plan *plan, double stem, double inflate) {
    double radius = stem;
    g->crowded.count = 0;
    for (int32_t i = g->path.count - 1; i >= 0; i--) {
        vn_step s = g->path.data[i];
        if (radius * inflate > vn_vessel_of(g, s.node)->cap) {
            VN_TRY(vn_array_push(&g->crowded, ((vn_thickness){s.node, radius})));
        }
        for (int32_t c = vn_vessel_of(g, s.node)->first_child; c >= 0; c = vn_vessel_of(g, c)->next_child) {
            double beta = sqrt(sqrt(vn_vessel_of(g, c)->flow * vn_vessel_of(g, c)->resistance) / s.square);
            VN_TRY(c != s.child ? collect(g, c, radius * beta, inflate) : VN_OK);
        }
        radius *= s.beta;
    }
    vn_fork below = vn_tree_fork(&g->tree, plan->node, -1, NULL);
    for (int32_t c = vn_vessel_of(g, plan->node)->first_child; c >= 0; c = vn_vessel_of(g, c)->next_child) {
        double beta = vn_tree_beta(&g->tree, c, &below);
        VN_TRY(collect(g, c, plan->radius[1] / inflate * beta, inflate));
    }
    return VN_OK;
}

// A segment that is to become thicker keeps clear of those planned, whose room may shrink to what they need.
static bool passes_planned(tube *t, vn_plan *plan, const plan_tubes *planned) {
    for (int i = 0; i < 3; i++) {
        const tube *new = &planned->tubes[i];
        int32_t shared = i == 0 ? plan->upper : i == 1 ? plan->node : -1;
        if (shared >= 0 && (t->ends[0] == shared || t->ends[1] == shared)) {
            continue;
        }
        double distance = sqrt(vn_segment_segment_distance2(t->a, t->b, new->a, new->b)) * (1 - 1e-9);
        if (distance - plan->caps[i] > t->radius) {
            t->room = fmin(t->room, distance - plan->caps[i]);
        } else if (distance - new->radius > t->radius) {
            t->room = t->radius;
            plan->caps[i] = distance - t->radius;
        } else {
            return false;
        }
    }
    return true;
}

static vn_status thicken(vn_cco *cco, vn_grower *g, vn_plan *plan, const plan_tubes *planned, vn_thickness at,
                         vn_verdict *verdict) {
    const vn_vessel *v = vn_vessel_of(g, at.node);
    tube t = {.cco = cco, .g = g, .a = vn_vessel_of(g, v->parent)->p, .b = v->p, .node = at.node};
    t.cut = plan->node;
    t.ends[0] = at.node;
    t.ends[1] = v->parent;
    t.radius = at.radius * (1 + 2e-7); // caps are floats
    bool fits = judge_tube(&t, v->length, is_root(g, v->parent), at.node < g->given) == VN_ALLOWED &&
                passes_planned(&t, plan, planned);
    VN_TRY(t.status);
    *verdict = fits ? VN_ALLOWED : VN_CROWDING;
    if (fits) {
        VN_TRY(vn_places_set_cap(g, at.node, t.room));
        vn_tree_settle(&g->tree, at.node);
    }
    return VN_OK;
}

static vn_status judge_crowding(vn_cco *cco, vn_grower *g, vn_plan *plan, const plan_tubes *planned,
                                vn_verdict *verdict) {
    enum { ROUNDS = 4 };
    double inflate = vn_cco_inflate(cco, g->terminals + 1), stem;
    bool uneven;
    VN_TRY(walk_up(g, plan, &stem, &uneven));
    *verdict = uneven ? VN_ASYMMETRIC : VN_ALLOWED;
    for (int round = 0; *verdict == VN_ALLOWED; round++) {
        VN_TRY(walk_down(g, plan, stem, inflate));
        if (g->crowded.count == 0) {
            return VN_OK;
        }
        *verdict = round == ROUNDS ? VN_CROWDING : VN_ALLOWED;
        for (int32_t i = 0; i < g->crowded.count && *verdict == VN_ALLOWED; i++) {
            vn_thickness at = g->crowded.data[i];
            at.radius *= inflate;
            VN_TRY(thicken(cco, g, plan, planned, at, verdict));
        }
    }
    return VN_OK;
}

vn_status vn_rules_judge(vn_cco *cco, vn_grower *g, vn_plan *plan, vn_verdict *verdict) {
    plan_tubes planned;
    lay_out(cco, g, plan, &planned);
    VN_TRY(judge_plan(g, plan, &planned, verdict));
    if (*verdict != VN_ALLOWED || plan->node < 0) {
        return VN_OK;
    }
    return judge_crowding(cco, g, plan, &planned, verdict);
}
