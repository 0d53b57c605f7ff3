// New vein nodes (Runions et al. 2005, Equation 1), with the guards of READINGS R3: no child where one is,
// every run ends.

#include "colonize/extend.h"
#include "domain/domain.h"

static const vn_extend_def extend_default = {.length = 1, .gap = -1};

static const vn_field extend_fields[] = {
    {"length", VN_F64, VN_REQUIRED | VN_ABOVE_MIN, offsetof(vn_extend_def, length), 0, 1e150, "length", NULL,
     "D, the length of a new vein segment"},
    {"domain", VN_OBJECT, 0, offsetof(vn_extend_def, domain), 0, 0, "", "domain",
     "an edge that would leave it is not made; its attractor turns to the nearest node that sees it"},
    {"meet", VN_CHOICE, 0, offsetof(vn_extend_def, meet), 0, 0, "", "cross|join|stop",
     "what a vein does that would cross another one: go on across it, as in the papers, end there, joined to "
     "it, or not grow (both in 2D); what drew that vein alone is then given up"},
    {"bias", VN_F64, 0, offsetof(vn_extend_def, bias), 0, 1, "", NULL,
     "ω, with perception: how much of a vessel's own direction is in that of its next segment"},
    {"bias_mean", VN_BOOL, 0, offsetof(vn_extend_def, bias_mean), 0, 0, "", NULL,
     "weigh the mean of the directions to attractors against that, rather than their sum"},
    {"bifurcate", VN_F64, VN_ABOVE_MIN | VN_OPTIONAL, offsetof(vn_extend_def, bifurcate), 0, 180, "degrees",
     NULL,
     "φ, with perception: a leaf whose attractors lie farther apart forks symmetrically; left out: none "
     "does"},
    {"avoid", VN_MIXED, 0, offsetof(vn_extend_def, avoid), 0, 0, "",
     "a network, or a list {a, b, …} of up to 16",
     "networks whose edges this one's keep clear of, as round tubes, now and as they grow thicker; those "
     "that "
     "grow by turns must each avoid the other"},
    {"gap", VN_F64, VN_OPTIONAL, offsetof(vn_extend_def, gap), 0, 1e150, "length", NULL,
     "what a new edge leaves free beside those to be avoided, for both to grow thicker; left out: a quarter "
     "of `length`"},
};
const vn_schema vn_extend_schema =
    VN_SCHEMA("extend", "Grow the influenced nodes by one segment", extend_fields, extend_default);

vn_extend_def vn_extend_def_default(void) {
    return extend_default;
}

enum { PATIENCE = 24 }; // calls of extend that an attractor may pull in without a vein coming nearer

double vn_direction_to(const vn_extension *e, int32_t node, int32_t attractor, double n[3]) {
    double p[3], q[3];
    vn_network_position(e->network, node, p);
    vn_attractors_place(e->a, attractor, q);
    double length = sqrt(vn_distance2(p, q));
    for (int k = 0; k < 3; k++) {
        n[k] = length > 0 ? (q[k] - p[k]) / length : 0;
    }
    return length;
}

// The place @p p of a step from @p q, brought onto the surface. Where the surface bends away from the step,
// the chord shrinks, and is stretched to the step's length once. A step that leads past the border, or leaves
// the surface so steeply that hardly anything of it is left, keeps its place off the surface, where it is
// refused.
static void step_along_surface(const vn_extension *e, const double q[3], double p[3]) {
    double length = e->def->length, s[3] = {p[0], p[1], p[2]};
    double chord = vn_domain_snap(e->def->domain, s) ? sqrt(vn_distance2(s, q)) : 0;
    if (!(chord > 0.25 * length)) {
        return;
    }
    if (fabs(chord - length) > 0.02 * length) {
        for (int k = 0; k < 3; k++) {
            s[k] = q[k] + length / chord * (s[k] - q[k]);
        }
        vn_domain_snap(e->def->domain, s);
    }
    memcpy(p, s, sizeof s);
}

void vn_step_from(const vn_extension *e, int32_t node, const double n[3], double p[3]) {
    double q[3];
    vn_network_position(e->network, node, q);
    for (int k = 0; k < 3; k++) {
        p[k] = q[k] + e->def->length * n[k];
    }
    if (e->def->domain != NULL && e->def->domain->kind->snap != NULL) {
        step_along_surface(e, q, p);
    }
}

// Directions repeat when what draws the node does, to rounding. Lengths need not: where the unit shrinks, the
// new edge would lie on the old, longer one.
bool vn_has_child_toward(const vn_extension *e, int32_t node, const double p[3]) {
    const vn_network *network = e->network;
    const double same = 1e-6;
    double o[3], q[3];
    vn_network_position(network, node, o);
    double length = sqrt(vn_distance2(o, p));
    for (int32_t c = network->first_child.data[node]; c >= 0; c = network->next_child.data[c]) {
        double difference2 = 0;
        vn_network_position(network, c, q);
        double other = sqrt(vn_distance2(o, q));
        for (int k = 0; k < 3; k++) {
            double d = (p[k] - o[k]) / length - (q[k] - o[k]) / other;
            difference2 += d * d;
        }
        if (difference2 < same * same) {
            return true;
        }
    }
    return false;
}

bool vn_stays_inside(const vn_extension *e, int32_t node, const double p[3]) {
    const vn_domain *domain = e->def->domain;
    double q[3];
    vn_network_position(e->network, node, q);
    // Sight forgives an end that is on the border: a root may be there, a new node may not be beyond it.
    return domain == NULL || (vn_domain_contains(domain, p) && vn_domain_sees(domain, q, p));
}

bool vn_keeps_clear(const vn_extension *e, int32_t node, const double p[3], bool forks) {
    return e->avoidance == NULL || vn_avoid_allows(e->avoidance, node, p, forks);
}

void vn_sum_directions(const vn_extension *e, double sum[3]) {
    memset(sum, 0, 3 * sizeof *sum);
    for (const vn_keyed *pair = e->begin; pair < e->end; pair++) {
        double one[3];
        vn_direction_to(e, e->node, pair->value, one);
        for (int k = 0; k < 3; k++) {
            sum[k] += one[k];
        }
    }
}

static bool mean_direction(const vn_extension *e, double n[3]) {
    double sum[3];
    vn_sum_directions(e, sum);
    double length = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    bool vanishes = length <= 1e-12 * (double)(e->end - e->begin);
    for (int k = 0; k < 3; k++) {
        n[k] = vanishes ? 0 : sum[k] / length;
    }
    return !vanishes;
}

// Whether a step toward this attractor alone leads to a place of its own, nearer to it and inside.
static bool may_step_to(const vn_extension *e, int32_t node, int32_t attractor, double p[3]) {
    double n[3];
    double distance = vn_direction_to(e, node, attractor, n);
    vn_step_from(e, node, n, p);
    return e->def->length < 2 * distance && !vn_has_child_toward(e, node, p) && vn_stays_inside(e, node, p) &&
           vn_keeps_clear(e, node, p, false);
}

// The place toward the first-ranked attractor that a step can be made to.
static bool step_to_one(const vn_extension *e, double p[3]) {
    bool found = false;
    uint64_t least = 0;
    for (const vn_keyed *pair = e->begin; pair < e->end; pair++) {
        double q[3];
        uint64_t rank = vn_rank(e, pair->value);
        if ((!found || rank < least) && may_step_to(e, e->node, pair->value, q)) {
            found = true;
            least = rank;
            memcpy(p, q, sizeof q);
        }
    }
    return found;
}

typedef struct sight {
    const vn_extension *e;
    int32_t attractor;
    double at[3];
    int64_t tries; ///< nodes that may still be asked
    vn_nearest *query;
} sight;

// How many near nodes an attractor asks in passing, and how many all that wait may ask together at the
// last chance.
enum { GLANCE = 64, LAST_LOOKS = 1 << 21 };

static bool sees_and_may_grow(int32_t node, void *payload) {
    sight *s = payload;
    double q[3], p[3];
    if (s->tries-- <= 0) {
        s->query->stop = true;
        return false;
    }
    vn_network_position(s->e->network, node, q);
    return vn_domain_sees(s->e->def->domain, q, s->at) && may_step_to(s->e, node, s->attractor, p);
}

static void remember_sight(vn_attractors *a, const vn_domain *domain) {
    if (a->sight != domain) {
        vn_domain_release(a->sight);
        a->sight = vn_domain_retain(domain);
    }
}

static vn_status add_edge(const vn_extension *e, int32_t node, const double p[3]) {
    VN_TRY(vn_network_add(e->network, node, p, NULL));
    return e->avoidance != NULL ? vn_avoid_grown(e->avoidance, node) : VN_OK;
}

vn_status vn_grow_edge(const vn_extension *e, int32_t node, const double p[3]) {
    vn_outcome outcome;
    VN_TRY(vn_meet(e->network, node, p, -1, e->def, &outcome));
    return outcome == VN_CLEAR ? add_edge(e, node, p) : VN_OK;
}

static vn_status step_toward(const vn_extension *e, int32_t node, int32_t attractor) {
    double n[3], p[3];
    vn_direction_to(e, node, attractor, n);
    vn_step_from(e, node, n, p);
    return vn_grow_edge(e, node, p);
}

// The nearest node that sees the attractor gets it, and grows at once. @p found says whether there is one
// among the nearest
// @p tries.
static vn_status look_for_sight(const vn_extension *e, int32_t attractor, int64_t tries, bool *found) {
    vn_attractors *a = e->a;
    sight s = {e, attractor, {0, 0, 0}, tries, NULL};
    vn_points nodes = vn_network_points(e->network);
    const vn_point_grid *grid;
    vn_attractors_place(a, attractor, s.at);
    VN_TRY(vn_network_grid(e->network, 0, &grid));
    vn_nearest query = {.reach2 = a->reach2,
                        .seed = a->seed,
                        .id = a->id.data[attractor],
                        .accept = sees_and_may_grow,
                        .payload = &s};
    s.query = &query;
    vn_point_grid_nearest(grid, &nodes, s.at, &query);
    *found = query.point >= 0;
    if (!*found) {
        return VN_OK;
    }
    if (a->node.data[attractor] < 0) {
        VN_TRY(vn_array_push(&a->activated, ((vn_keyed){(uint64_t)attractor, attractor})));
    }
    a->node.data[attractor] = query.point;
    a->near2.data[attractor] = query.reach2;
    a->best.data[attractor] = INFINITY;
    vn_reach_tree_raise(&a->tree, s.at, query.reach2);
    return step_toward(e, query.point, attractor);
}

static void retire_hidden(vn_attractors *a, int32_t attractor) {
    a->retired.hidden++;
    vn_attractors_remove(a, attractor);
}

// The border is between this attractor and its node: it turns to the nearest node that sees it, or waits
// for one.
static vn_status turn_to_another(const vn_extension *e, int32_t attractor) {
    vn_attractors *a = e->a;
    bool found;
    if ((a->idle.data[attractor] & VN_TURNS) == VN_TURNS) {
        retire_hidden(a, attractor); // or two veins might pass it to and fro for ever
        return VN_OK;
    }
    remember_sight(a, e->def->domain);
    a->idle.data[attractor] = (uint8_t)((a->idle.data[attractor] | VN_HIDDEN) + VN_TURN);
    VN_TRY(look_for_sight(e, attractor, GLANCE, &found));
    if (!found) {
        VN_TRY(vn_array_push(&a->waiting, attractor));
        double p[3];
        vn_attractors_place(a, attractor, p);
        a->node.data[attractor] = -1;
        a->near2.data[attractor] = a->consumed2;
        vn_reach_tree_raise(&a->tree, p, a->consumed2);
    }
    return VN_OK;
}

// Those that wait look around again, among the nearest @p tries nodes.
static vn_status look_again(const vn_extension *e, int64_t tries) {
    vn_attractors *a = e->a;
    int32_t kept = 0;
    vn_status status = VN_OK;
    for (int32_t k = 0; k < a->waiting.count; k++) {
        int32_t i = a->waiting.data[k];
        bool found = vn_is_gone(a, i) || a->node.data[i] >= 0;
        if (!found && status == VN_OK) {
            status = look_for_sight(e, i, tries, &found);
        }
        if (!found) {
            a->waiting.data[kept++] = i;
        }
        status = status == VN_OK && k % 256 == 255 ? vn_poll() : status;
    }
    a->waiting.count = kept;
    return status;
}

static bool still_grows(const vn_domain *domain) {
    return domain->kind->is_grown != NULL && !domain->kind->is_grown(domain);
}

// Seldom while veins grow elsewhere, and thoroughly when nothing else does. What even then no node sees is
// retired, unless the margin still moves.
static vn_status mind_waiting(const vn_extension *e, int32_t first) {
    vn_attractors *a = e->a;
    bool grew = e->network->x.count > first;
    if (a->waiting.count == 0 || (grew && e->network->step < a->next_look)) {
        return VN_OK;
    }
    int64_t share = LAST_LOOKS / a->waiting.count;
    a->next_look = e->network->step + 8 + e->network->step / 16;
    VN_TRY(look_again(e, grew || share < GLANCE ? GLANCE : share));
    if (e->network->x.count > first || still_grows(e->def->domain)) {
        return VN_OK;
    }
    for (int32_t k = 0; k < a->waiting.count; k++) {
        retire_hidden(a, a->waiting.data[k]);
    }
    a->waiting.count = 0;
    return VN_OK;
}

// An attractor that no vein comes nearer to, however often it pulls, is let go, or some run would never end.
static void lose_patience(const vn_extension *e) {
    vn_attractors *a = e->a;
    bool barred = e->avoidance != NULL && e->avoidance->refused;
    for (const vn_keyed *pair = e->begin; pair < e->end; pair++) {
        int32_t i = pair->value;
        double distance = sqrt(a->near2.data[i]);
        if (vn_is_gone(a, i)) {
            continue;
        }
        if (distance < (double)a->best.data[i] - 1e-3 * e->def->length) {
            bool counted =
                isfinite(a->best.data[i]); // else it only starts to count: its patience is not renewed
            a->best.data[i] = (float)distance;
            a->idle.data[i] &= counted ? VN_HIDDEN | VN_TURNS : 0xFF;
        } else if ((++a->idle.data[i] & VN_IDLE) > PATIENCE) {
            a->retired.barred += barred;
            a->retired.circled += !barred;
            vn_attractors_remove(a, i);
        }
    }
}

static vn_status check_root(const vn_network *network, int32_t node, const vn_domain *domain) {
    double p[3];
    vn_network_position(network, node, p);
    double outside = -vn_domain_distance(domain, p);
    vn_box bounds = vn_domain_bounds(domain);
    if (outside > 1e-6 * sqrt(vn_distance2(bounds.min, bounds.max))) {
        return vn_fail(
            VN_INVALID,
            "extend: the root at (%g, %g, %g) is outside the domain, by %g: place it inside or on the "
            "border",
            p[0], p[1], p[2], outside);
    }
    return VN_OK;
}

// A seed beyond the border would have every edge refused, and its attractors given up one by one. Roots are
// looked at once.
static vn_status check_roots(const vn_extension *e) {
    vn_attractors *a = e->a;
    const vn_network *network = e->network;
    if (e->def->domain == NULL || (a->roots_serial == network->serial && a->roots_inside == network->roots)) {
        return VN_OK;
    }
    for (int32_t node = 0; node < network->x.count; node++) {
        if (network->parent.data[node] < 0) {
            VN_TRY(check_root(network, node, e->def->domain));
        }
    }
    a->roots_serial = network->serial;
    a->roots_inside = network->roots;
    return VN_OK;
}

static void retire_barred(const vn_extension *e) {
    for (const vn_keyed *pair = e->begin; pair < e->end; pair++) {
        e->a->retired.barred++;
        vn_attractors_remove(e->a, pair->value);
    }
}

// Attractors on both sides of a vein draw along it or across it: one of them alone may still be reached.
static vn_status grow_or_stop(const vn_extension *e, double p[3]) {
    vn_outcome outcome;
    VN_TRY(vn_meet(e->network, e->node, p, -1, e->def, &outcome));
    bool stopped = e->def->meet == VN_MEET_STOP && outcome == VN_BARRED;
    if (stopped && step_to_one(e, p)) {
        VN_TRY(vn_meet(e->network, e->node, p, -1, e->def, &outcome));
        stopped = outcome == VN_BARRED;
    }
    if (stopped && e->a->mode == VN_NEAREST) {
        retire_barred(e);
    }
    return outcome == VN_CLEAR ? add_edge(e, e->node, p) : VN_OK;
}

// In the closed modes an attractor that the border hides waits for other veins.
static void note_hidden(const vn_extension *e, bool inside) {
    for (const vn_keyed *pair = e->begin; !inside && pair < e->end; pair++) {
        e->a->idle.data[pair->value] |= VN_HIDDEN;
    }
}

// Where an attractor draws several veins its patience is renewed by any that comes nearer (vn_ties_show).
// What waits for tagged veins is minded by vn_touch().
static void count_idle_steps(const vn_extension *e) {
    vn_attractors *a = e->a;
    const vn_influence *influence = e->influence;
    for (int32_t k = 0; k < influence->attractor.count; k++) {
        int32_t i = influence->attractor.data[k];
        bool again = k > 0 && influence->attractor.data[k - 1] == i;
        bool minded = a->tagging && (a->stage.data[i] & VN_TOUCHED);
        if (again || minded || (++a->idle.data[i] & VN_IDLE) <= PATIENCE) {
            continue;
        }
        a->retired.hidden += a->idle.data[i] & VN_HIDDEN ? 1 : 0;
        a->retired.circled += a->idle.data[i] & VN_HIDDEN ? 0 : 1;
        vn_attractors_remove(a, i);
    }
}

static bool same_box(const vn_box *a, const vn_box *b) {
    bool same = true;
    for (int k = 0; k < 3; k++) {
        same = same && a->min[k] == b->min[k] && a->max[k] == b->max[k];
    }
    return same;
}

// Veins stay inside a domain that stays, and inside what a margin grows to.
static void remember_room(vn_attractors *a, const vn_domain *domain) {
    vn_box room = {{0}, {0}};
    bool stays = domain != NULL;
    if (domain != NULL && domain->kind->margin != NULL) {
        double measure;
        domain->kind->margin->grown(domain, &room, &measure);
    } else if (domain != NULL) {
        room = vn_domain_bounds(domain);
        stays = a->last.domain == domain && same_box(&room, &a->room);
    }
    a->room = room;
    a->has_room = stays;
}

static void remember_extension(vn_attractors *a, const vn_extend_def *def) {
    remember_room(a, def->domain);
    vn_domain *held = def->domain != NULL ? vn_domain_retain(def->domain) : NULL;
    vn_domain_release(a->last.domain);
    a->last = *def;
    a->last.domain = held;
    a->last.avoid_count = 0; // they are not held
}

// Whether some attractor is so far off that a step does not lead past it. Where each draws several veins, two
// nodes on either side of one would take turns to grow where the other is, and be twice as many each time.
static bool leads_somewhere(const vn_extension *e) {
    double n[3];
    bool leads = e->a->mode == VN_NEAREST;
    for (const vn_keyed *pair = e->begin; !leads && pair < e->end; pair++) {
        leads = e->def->length < 2 * vn_direction_to(e, e->node, pair->value, n);
    }
    return leads;
}

static vn_status grow_vessel(const vn_extension *e) {
    VN_TRY(vn_sprout(e));
    lose_patience(e);
    return VN_OK;
}

static vn_status grow_node(const vn_extension *e) {
    double n[3], p[3];
    bool has_mean = mean_direction(e, n);
    vn_step_from(e, e->node, n, p);
    bool free = has_mean && leads_somewhere(e) && !vn_has_child_toward(e, e->node, p);
    bool inside = !free || vn_stays_inside(e, e->node, p);
    if ((free && inside && vn_keeps_clear(e, e->node, p, false)) || step_to_one(e, p)) {
        VN_TRY(grow_or_stop(e, p));
    } else if (e->a->mode != VN_NEAREST) {
        note_hidden(e, inside);
    } else if (!inside || (e->def->domain != NULL && !has_mean)) {
        for (const vn_keyed *pair = e->begin; pair < e->end; pair++) {
            VN_TRY(turn_to_another(e, pair->value));
        }
    }
    if (e->a->mode == VN_NEAREST) {
        lose_patience(e);
    }
    return VN_OK;
}

static vn_status group_by_node(vn_influence *influence) {
    vn_attractors *a = influence->attractors;
    int32_t count = influence->node.count;
    VN_TRY(vn_array_reserve(&a->by_node, count));
    for (int32_t k = 0; k < count; k++) {
        a->by_node.data[k] = (vn_keyed){(uint64_t)influence->node.data[k], influence->attractor.data[k]};
    }
    a->by_node.count = count;
    return vn_sort_keyed(&a->by_node, &a->scratch);
}

static vn_status grow_nodes(vn_extension *e) {
    const vn_keyed *pairs = e->a->by_node.data;
    int32_t count = e->a->by_node.count;
    bool vessels = vn_gaze_is_open(&e->a->gaze);
    for (int32_t begin = 0, end; begin < count; begin = end) {
        end = begin + 1;
        while (end < count && pairs[end].key == pairs[begin].key) {
            end++;
        }
        e->node = (int32_t)pairs[begin].key;
        e->begin = pairs + begin;
        e->end = pairs + end;
        if (e->avoidance != NULL) {
            e->avoidance->refused = false;
        }
        VN_TRY(vessels ? grow_vessel(e) : grow_node(e));
    }
    return VN_OK;
}

static vn_status check_extend(const vn_network *network, const vn_influence *influence,
                              const vn_extend_def *def) {
    VN_TRY(vn_check_def(&vn_extend_schema, def));
    bool same = influence->network == network && influence->network_serial == network->serial;
    if (!same || !vn_influence_current(influence)) {
        return vn_fail(VN_INVALID,
                       "extend: the influence is out of date, or of another network: call influence() "
                       "again after anything has changed");
    }
    bool vessel = def->bias > 0 || def->bias_mean || def->bifurcate > 0;
    if (vessel && !vn_gaze_is_open(&influence->attractors->gaze)) {
        return vn_fail(VN_INVALID, "extend.%s is for vessels: give the influence perception = {angle=}",
                       def->bifurcate > 0 ? "bifurcate" : "bias");
    }
    if (def->gap > 0 && def->avoid_count == 0) {
        return vn_fail(VN_INVALID, "extend.gap is kept from other networks: name them in extend.avoid");
    }
    if (def->avoid_count > 0 && influence->attractors->mode != VN_NEAREST) {
        return vn_fail(VN_INVALID, "extend.avoid goes with influence.mode = \"nearest\" alone");
    }
    if (def->domain != NULL && vn_domain_dim(def->domain) != network->dim) {
        return vn_fail(VN_INVALID, "extend.domain has %d dimensions, the network %d",
                       vn_domain_dim(def->domain), network->dim);
    }
    return VN_OK;
}

vn_status vn_extend(vn_network *network, vn_influence *influence, const vn_extend_def *def, int32_t *added,
                    int32_t *first) {
    *added = 0;
    *first = network->x.count;
    VN_TRY(check_extend(network, influence, def));
    vn_extension e = {.network = network, .influence = influence, .a = influence->attractors, .def = def};
    VN_TRY(check_roots(&e));
    vn_avoidance avoidance;
    if (def->avoid_count > 0) {
        VN_TRY(vn_avoid_begin(&avoidance, network, def));
        e.avoidance = &avoidance;
    }
    remember_extension(e.a, def);
    int32_t joins = network->joins.count;
    network->step++;
    VN_TRY(group_by_node(influence));
    vn_status status = grow_nodes(&e);
    status = status == VN_OK && def->domain != NULL ? mind_waiting(&e, *first) : status;
    if (e.a->mode != VN_NEAREST) {
        count_idle_steps(&e);
    }
    status = status == VN_OK && e.avoidance != NULL ? vn_avoid_end(e.avoidance) : status;
    *added = status == VN_OK ? network->x.count - *first + network->joins.count - joins : 0;
    return status;
}
