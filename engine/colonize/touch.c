// Attractors that draw several veins die when all of these have come, and where the veins meet they are
// joined (Runions et al. 2005, section 4; READINGS R6).

#include "colonize/attractors.h"
#include "domain/domain.h"

/// One call of vn_consume() in the modes "all" and "tagged".
typedef struct touch {
    vn_attractors *a;
    vn_network *network;
    const vn_consume_def *def;
    int32_t *consumed;
    bool stepped;     ///< the veins have grown since the last call
    int32_t patience; ///< steps in which a tagged vein may come no nearer
} touch;

static double distance_to(const touch *t, int32_t i, int32_t node) {
    return sqrt(vn_attractors_distance2(t->a, t->network, i, node));
}

static bool is_within_reach(const touch *t, int32_t i) {
    for (int32_t tie = t->a->first_tie.data[i]; tie >= 0; tie = t->a->ties.data[tie].next) {
        const vn_tie *one = &t->a->ties.data[tie];
        if (!(one->state & VN_GHOST) && distance_to(t, i, one->node) < t->def->distance) {
            return true;
        }
    }
    return false;
}

// The attractor is reached for the first time: from now on it waits for the veins that it draws now.
static vn_status touch_first(const touch *t, int32_t i) {
    vn_attractors *a = t->a;
    if (vn_is_gone(a, i) || (a->stage.data[i] & VN_TOUCHED) || !is_within_reach(t, i)) {
        return VN_OK;
    }
    VN_TRY(vn_array_push(&a->touched, i));
    a->stage.data[i] |= VN_TOUCHED;
    for (int32_t tie = a->first_tie.data[i]; tie >= 0; tie = a->ties.data[tie].next) {
        vn_tie *one = &a->ties.data[tie];
        one->state |= t->def->mode == VN_CONSUME_TAGGED ? VN_TAGGED : 0;
        one->best = INFINITY;
        one->idle = 0;
    }
    return VN_OK;
}

// A tagged vein comes nearer, arrives, or has left when it did neither for a while. True while it is awaited.
static bool await_vein(const touch *t, int32_t i, vn_tie *tie) {
    double distance = distance_to(t, i, tie->node);
    if (distance < t->def->distance) {
        tie->state |= VN_REACHED;
    } else if (distance < (double)tie->best - 1e-3 * t->a->last.length) {
        tie->best = (float)distance;
        tie->idle = 0;
    } else if (t->stepped && ++tie->idle > t->patience) {
        tie->state |= VN_LEFT;
    }
    return !(tie->state & (VN_REACHED | VN_LEFT));
}

static bool await_tagged(const touch *t, int32_t i) {
    bool awaited = false;
    for (int32_t tie = t->a->first_tie.data[i]; tie >= 0; tie = t->a->ties.data[tie].next) {
        vn_tie *one = &t->a->ties.data[tie];
        bool counts = (one->state & (VN_TAGGED | VN_REACHED | VN_LEFT | VN_GHOST)) == VN_TAGGED;
        awaited = (counts && await_vein(t, i, one)) || awaited;
    }
    return awaited;
}

// Webb's rule: all associated nodes within the kill distance.
static bool await_all(const touch *t, int32_t i) {
    for (int32_t tie = t->a->first_tie.data[i]; tie >= 0; tie = t->a->ties.data[tie].next) {
        const vn_tie *one = &t->a->ties.data[tie];
        if (!(one->state & VN_GHOST) && !(distance_to(t, i, one->node) < t->def->distance)) {
            return true;
        }
    }
    return false;
}

enum { MOST_ENDS = 32 };

/// The ends of the veins that came to one attractor.
typedef struct meeting_ends {
    int32_t node[MOST_ENDS];
    bool grew[MOST_ENDS];
    bool taken[MOST_ENDS];
    int count;
} meeting_ends;

static bool came_later(const vn_network *network, int32_t a, int32_t b) {
    int32_t ba = network->birth.data[a], bb = network->birth.data[b];
    return ba != bb ? ba > bb : a > b;
}

// By arrival; once, where the node is a member again that was none for a while.
static void note_end(meeting_ends *ends, const vn_network *network, const vn_tie *tie) {
    for (int k = 0; k < ends->count; k++) {
        if (ends->node[k] == tie->node) {
            return;
        }
    }
    if (ends->count == MOST_ENDS) {
        return;
    }
    int at = ends->count++;
    for (; at > 0 && came_later(network, ends->node[at - 1], tie->node); at--) {
        ends->node[at] = ends->node[at - 1];
        ends->grew[at] = ends->grew[at - 1];
    }
    ends->node[at] = tie->node;
    ends->grew[at] = tie->state & VN_GREW;
}

// Of one vein the last node is its end.
static void drop_nodes_behind(meeting_ends *ends, const vn_network *network, int32_t steps) {
    for (int k = 0; k < ends->count; k++) {
        int32_t node = network->parent.data[ends->node[k]];
        for (int32_t s = 0; s < steps && node >= 0; s++, node = network->parent.data[node]) {
            for (int j = 0; j < ends->count; j++) {
                ends->taken[j] = ends->taken[j] || ends->node[j] == node;
            }
        }
    }
    int kept = 0;
    for (int k = 0; k < ends->count; k++) {
        ends->node[kept] = ends->node[k];
        ends->grew[kept] = ends->grew[k];
        kept += !ends->taken[k];
    }
    memset(ends->taken, 0, sizeof ends->taken);
    ends->count = kept;
}

static void collect_ends(const touch *t, int32_t i, meeting_ends *ends) {
    *ends = (meeting_ends){0};
    for (int32_t tie = t->a->first_tie.data[i]; tie >= 0; tie = t->a->ties.data[tie].next) {
        const vn_tie *one = &t->a->ties.data[tie];
        if ((one->state & VN_TAGGED) && (one->state & VN_REACHED)) {
            note_end(ends, t->network, one);
        }
    }
    drop_nodes_behind(ends, t->network, 2 * t->patience + 8);
}

static bool is_short(const touch *t, double way) {
    return way <= 2 * t->a->last.length * (1 + 1e-9);
}

static bool are_close(const touch *t, int32_t a, int32_t b) {
    double p[3], q[3];
    vn_network_position(t->network, a, p);
    vn_network_position(t->network, b, q);
    return is_short(t, sqrt(vn_distance2(p, q)));
}

// Ends that are all near the attractor meet there when each is close to some other: a ring of five is one
// junction, not two and a near miss. Ends farther from it have to be close to one another.
static bool may_join_group(const touch *t, int32_t i, const int32_t *group, int count, int32_t end) {
    int close = 0;
    bool near = is_short(t, distance_to(t, i, end));
    for (int k = 0; k < count; k++) {
        if (vn_met_before(t->network, group[k], end)) {
            return false;
        }
        close += are_close(t, group[k], end);
        near = near && is_short(t, distance_to(t, i, group[k]));
    }
    return count == 0 || close == count || (near && close > 0);
}

// The group of ends that the first free end belongs to; into @p group.
static int next_group(const touch *t, int32_t i, meeting_ends *ends, int32_t group[MOST_ENDS], bool *grew) {
    int count = 0, before = -1;
    *grew = false;
    while (count > before) { // who came late may bring others nearer
        before = count;
        for (int k = 0; k < ends->count; k++) {
            if (!ends->taken[k] && may_join_group(t, i, group, count, ends->node[k])) {
                ends->taken[k] = true;
                *grew = *grew || ends->grew[k];
                group[count++] = ends->node[k];
            }
        }
    }
    return count;
}

// At the attractor; or amid the ends, where one is too far from it for a short edge.
static void place_junction(const touch *t, int32_t i, const int32_t *group, int count, bool first,
                           double p[3]) {
    double mean[3] = {0}, farthest = 0;
    vn_attractors_place(t->a, i, p);
    for (int k = 0; k < count; k++) {
        double q[3];
        vn_network_position(t->network, group[k], q);
        farthest = fmax(farthest, sqrt(vn_distance2(p, q)));
        for (int c = 0; c < 3; c++) {
            mean[c] += q[c] / count;
        }
    }
    if (!first || farthest > 2 * t->a->last.length * (1 + 1e-9)) {
        memcpy(p, mean, sizeof mean);
        if (t->a->last.domain != NULL) {
            vn_domain_snap(t->a->last.domain, p);
        }
    }
}

static bool sees(const touch *t, int32_t node, const double p[3]) {
    double q[3];
    vn_network_position(t->network, node, q);
    return t->a->last.domain == NULL || vn_domain_sees(t->a->last.domain, q, p);
}

// Connect @p end with the junction @p to, which is made at @p p when it is not there yet (-1).
static vn_status connect_end(const touch *t, int32_t end, const double p[3], int32_t *to) {
    vn_network *network = t->network;
    vn_outcome outcome = VN_CLEAR;
    if (end == *to || !sees(t, end, p) || (*to >= 0 && vn_network_connected(network, end, *to))) {
        return VN_OK;
    }
    if (t->a->last.meet == VN_MEET_JOIN) {
        VN_TRY(vn_meet(network, end, p, *to, &t->a->last, &outcome));
    }
    if (outcome != VN_CLEAR) {
        return VN_OK;
    }
    return *to < 0 ? vn_network_add(network, end, p, to) : vn_network_join(network, end, *to, 0);
}

static vn_status join_group(const touch *t, int32_t i, const int32_t *group, int count, bool first) {
    double p[3], q[3];
    int32_t junction = -1;
    place_junction(t, i, group, count, first, p);
    for (int k = 0; k < count; k++) {
        vn_network_position(t->network, group[k], q);
        bool there = vn_distance2(p, q) <= 1e-12 * t->a->last.length * t->a->last.length;
        junction = there && junction < 0 ? group[k] : junction;
    }
    if (junction >= 0) {
        vn_network_position(t->network, junction, p);
    }
    for (int k = 0; k < count; k++) {
        VN_TRY(connect_end(t, group[k], p, &junction));
    }
    return VN_OK;
}

static vn_status join_ends(const touch *t, int32_t i) {
    meeting_ends ends;
    int32_t group[MOST_ENDS];
    bool grew, first = true;
    collect_ends(t, i, &ends);
    for (int count; (count = next_group(t, i, &ends, group, &grew)) > 0;) {
        if (count > 1 && grew) {
            VN_TRY(join_group(t, i, group, count, first));
            first = false;
        }
    }
    return VN_OK;
}

static vn_status mind_touched(const touch *t) {
    vn_attractors *a = t->a;
    int32_t kept = 0;
    for (int32_t k = 0; k < a->touched.count; k++) {
        int32_t i = a->touched.data[k];
        if (vn_is_gone(a, i)) {
            continue;
        }
        bool tagged = t->def->mode == VN_CONSUME_TAGGED;
        if (tagged ? await_tagged(t, i) : await_all(t, i)) {
            a->touched.data[kept++] = i;
            continue;
        }
        if (tagged) {
            VN_TRY(join_ends(t, i));
        }
        VN_TRY(vn_consume_one(a, i, t->def->into, t->consumed));
    }
    a->touched.count = kept;
    return VN_OK;
}

static vn_status touch_all(const touch *t) {
    for (int32_t i = 0; i < t->a->first_tie.count; i++) {
        VN_TRY(touch_first(t, i));
    }
    return VN_OK;
}

static vn_status touch_fresh(const touch *t) {
    vn_attractors *a = t->a;
    double distance2 = t->def->distance * t->def->distance;
    for (int32_t k = 0; k < a->fresh.count; k++) {
        if (a->fresh.data[k].distance2 < distance2) {
            VN_TRY(touch_first(t, a->fresh.data[k].point));
        }
    }
    return VN_OK;
}

vn_status vn_touch(vn_attractors *a, vn_network *network, const vn_consume_def *def, int32_t *consumed) {
    touch t = {.a = a, .network = network, .def = def, .consumed = consumed};
    a->tagging = def->mode == VN_CONSUME_TAGGED;
    t.stepped = a->minded_step != network->step;
    a->minded_step = network->step;
    t.patience = (int32_t)fmin(ceil(2 * def->distance / a->last.length) + 2, 250);
    VN_TRY(vn_attractors_ask_all(a, def->distance) ? touch_all(&t) : touch_fresh(&t));
    return mind_touched(&t);
}
