// V(s), the nodes that an attractor draws where veins may close loops (Runions et al. 2005, section 4;
// READINGS R4 and R5).
//
// The relative neighbors are kept exactly and without a triangulation of their own: nodes only ever come, so
// V(s ∪ u) is V(s) without what u excludes, and u if nothing excludes it. Only an attractor that is new looks
// around. The Urquhart neighbors have no such law (a node that u pushes out of the conflict hole may have
// excluded another), and are found anew among the corners of the hole.

#include "colonize/attractors.h"

#include <stdlib.h>

// Which of a and b is nearer to p; in doubles where that decides, or else exactly.
static int compare(const double p[3], const double a[3], const double b[3]) {
    double da = vn_distance2(p, a), db = vn_distance2(p, b);
    double error = 1e-14 * (da + db);
    if (error > 1e-280 && da - db > error) {
        return 1;
    }
    if (error > 1e-280 && db - da > error) {
        return -1;
    }
    return vn_compare_distances(p, a, b);
}

// Whether u keeps v from being a relative neighbor of s: |u - s| < |v - s| and |u - v| <= |v - s|.
static bool excludes(const double u[3], const double v[3], const double s[3]) {
    return compare(s, u, v) < 0 && compare(v, u, s) <= 0;
}

static int32_t take_tie(vn_attractors *a) {
    int32_t tie = a->free_tie;
    if (tie >= 0) {
        a->free_tie = a->ties.data[tie].next;
        return tie;
    }
    bool room = vn_array_reserve(&a->ties, (int64_t)a->ties.count + 1) == VN_OK;
    return room ? a->ties.count++ : -1;
}

static void give_back(vn_attractors *a, int32_t tie) {
    a->ties.data[tie].next = a->free_tie;
    a->free_tie = tie;
}

static const vn_guards no_guards = {
    .post = {
        {.distance2 = INFINITY}, {.distance2 = INFINITY}, {.distance2 = INFINITY}, {.distance2 = INFINITY}}};

vn_status vn_ties_prepare(vn_attractors *a) {
    VN_TRY(vn_array_reserve(&a->first_tie, a->x.count));
    VN_TRY(vn_array_reserve(&a->stage, a->x.count));
    VN_TRY(vn_array_reserve(&a->guards, a->x.count));
    VN_TRY(vn_array_reserve(&a->farthest2, a->x.count));
    for (int32_t i = a->first_tie.count; i < a->x.count; i++) {
        a->first_tie.data[i] = -1;
        a->stage.data[i] = VN_FREE;
        a->guards.data[i] = no_guards;
        a->farthest2.data[i] = 0;
    }
    a->first_tie.count = a->stage.count = a->guards.count = a->farthest2.count = a->x.count;
    return VN_OK;
}

// A guard is certain, whatever doubles do to the last bits; what they cannot tell is decided by push_in().
static const double SURE = 1 - 1e-12;

bool vn_ties_keep_out(const vn_attractors *a, int32_t i, const double u[3], double d2, double guard[3]) {
    const vn_guards *guards = &a->guards.data[i];
    if (d2 <= a->farthest2.data[i]) {
        return false; // it might drive a neighbor out
    }
    for (int k = 0; k < VN_GUARDS; k++) {
        if (guards->post[k].distance2 < SURE * d2 && vn_distance2(guards->post[k].at, u) < SURE * d2) {
            memcpy(guard, guards->post[k].at, sizeof guards->post[k].at);
            return true;
        }
    }
    return false;
}

// The first guard is the nearest neighbor, the others take turns.
static void post_guard(vn_attractors *a, const vn_network *network, int32_t i, int32_t node, bool nearest) {
    vn_guards *guards = &a->guards.data[i];
    guards->turn = nearest ? guards->turn : guards->turn % (VN_GUARDS - 1) + 1;
    int k = nearest ? 0 : guards->turn;
    guards->post[k].distance2 = vn_attractors_distance2(a, network, i, node);
    vn_network_position(network, node, guards->post[k].at);
}

void vn_ties_drop(vn_attractors *a, int32_t i) {
    if (i >= a->first_tie.count) {
        return;
    }
    for (int32_t tie = a->first_tie.data[i]; tie >= 0;) {
        int32_t next = a->ties.data[tie].next;
        give_back(a, tie);
        tie = next;
    }
    a->first_tie.data[i] = -1;
}

static bool is_tie(const vn_attractors *a, int32_t i, int32_t node) {
    for (int32_t tie = a->first_tie.data[i]; tie >= 0; tie = a->ties.data[tie].next) {
        if (a->ties.data[tie].node == node && !(a->ties.data[tie].state & VN_GHOST)) {
            return true;
        }
    }
    return false;
}

// A vein that has come stays an end, although another one came between it and the attractor.
static bool is_end_of_old(const vn_attractors *a, int32_t i, const vn_tie *tie) {
    bool came = (tie->state & VN_TAGGED) && (tie->state & VN_REACHED);
    return came && (a->stage.data[i] & VN_TOUCHED) && !is_tie(a, i, tie->node);
}

void vn_ties_drop_ghosts(vn_attractors *a, const vn_network *network, int32_t i) {
    int32_t *link = &a->first_tie.data[i];
    double farthest2 = 0;
    while (*link >= 0) {
        int32_t at = *link;
        vn_tie *tie = &a->ties.data[at];
        bool ghost = tie->state & VN_GHOST;
        if (ghost && !is_end_of_old(a, i, tie)) {
            *link = tie->next;
            give_back(a, at);
            continue;
        }
        if (!ghost) {
            farthest2 = fmax(farthest2, vn_attractors_distance2(a, network, i, tie->node));
        }
        link = &tie->next;
    }
    a->farthest2.data[i] = farthest2;
}

void vn_ties_forget(vn_attractors *a, bool moved) {
    for (int32_t i = 0; i < a->first_tie.count; i++) {
        a->guards.data[i] = no_guards;
        a->farthest2.data[i] = 0;
        for (int32_t tie = a->first_tie.data[i]; tie >= 0; tie = a->ties.data[tie].next) {
            a->ties.data[tie].state |= VN_GHOST;
            a->ties.data[tie].best = moved ? INFINITY : a->ties.data[tie].best;
        }
    }
    a->outdated.count = 0;
    a->news.count = 0;
}

void vn_ties_leave(vn_attractors *a) {
    for (int32_t i = 0; i < a->first_tie.count; i++) {
        vn_ties_drop(a, i);
        a->stage.data[i] = VN_FREE;
    }
    a->touched.count = 0;
}

void vn_ties_move(vn_attractors *a, int32_t from, int32_t to) {
    if (from < a->first_tie.count) {
        int32_t first = a->first_tie.data[from];
        a->first_tie.data[from] = -1;
        a->first_tie.data[to] = first;
        a->stage.data[to] = a->stage.data[from];
        a->guards.data[to] = a->guards.data[from];
        a->farthest2.data[to] = a->farthest2.data[from];
    } else if (to < a->first_tie.count) { // a newcomer: what the place held before is none of its
        a->first_tie.data[to] = -1;
        a->stage.data[to] = VN_FREE;
        a->guards.data[to] = no_guards;
        a->farthest2.data[to] = 0;
    }
}

// What a new tie takes over: from a ghost of itself, or from the node's parent, whose tags it inherits.
// @p anew says that it was no member before.
static vn_tie inherit(const vn_attractors *a, const vn_network *network, int32_t i, int32_t node,
                      bool *anew) {
    vn_tie made = {.node = node, .best = INFINITY};
    *anew = true;
    int32_t parent = network->parent.data[node];
    while (parent > node) { // put into the edge since by a vein that met it: the node grew from the one above
        parent = network->parent.data[parent];
    }
    for (int32_t tie = a->first_tie.data[i]; tie >= 0; tie = a->ties.data[tie].next) {
        const vn_tie *other = &a->ties.data[tie];
        if (other->node == node || other->node == parent) {
            made.best = other->best;
            made.idle = other->idle;
            made.state = other->state & (other->node == node ? ~VN_GHOST : ~(VN_GHOST | VN_REACHED));
            made.state |= other->node == parent ? VN_GREW : 0;
        }
        if (other->node == node) {
            *anew = false;
            break;
        }
    }
    return made;
}

// A vein that comes nearer than it ever was renews the attractor's patience: one that goes to and fro about
// it does not. What was tagged is minded by vn_touch().
static void note_progress(vn_attractors *a, int32_t i, vn_tie *tie, double d2) {
    double distance = sqrt(d2);
    if ((tie->state & VN_TAGGED) && a->tagging) {
        return;
    }
    if ((tie->state & VN_GREW) && distance < (double)tie->best - 1e-3 * a->last.length) {
        a->idle.data[i] &= (uint8_t) ~(VN_IDLE | VN_HIDDEN);
    }
    tie->best = fminf(tie->best, (float)distance);
}

static vn_status add_tie(vn_attractors *a, const vn_network *network, int32_t i, int32_t node, double d2) {
    bool anew;
    vn_tie made = inherit(a, network, i, node, &anew);
    if (anew) {
        note_progress(a, i, &made, d2);
    }
    int32_t tie = take_tie(a);
    if (tie < 0) {
        return VN_NO_MEMORY;
    }
    if (a->node.data[i] < 0) {
        VN_TRY(vn_array_push(&a->activated, ((vn_keyed){(uint64_t)i, i})));
    }
    post_guard(a, network, i, node, d2 < a->guards.data[i].post[0].distance2);
    a->farthest2.data[i] = fmax(a->farthest2.data[i], d2);
    vn_points points = vn_attractors_points(a);
    vn_reach_tree_raise_near(&a->tree, &points, i, a->farthest2.data[i]);
    made.next = a->first_tie.data[i];
    a->ties.data[tie] = made;
    a->first_tie.data[i] = tie;
    a->node.data[i] = node;
    return vn_attractors_note_fresh(a, i, d2);
}

typedef struct lune_search {
    const vn_network *network;
    int32_t found;
} lune_search;

static bool is_in_lune(int32_t node, const vn_lune *lune, void *payload) {
    lune_search *search = payload;
    double u[3];
    vn_network_position(search->network, node, u);
    bool is_in = excludes(u, lune->v, lune->s);
    search->found = is_in ? node : -1;
    return is_in;
}

static void set_lune(vn_lune *lune, const double s[3], const double v[3]) {
    double d = sqrt(vn_distance2(s, v)) * (1 + 1e-9);
    lune->least = -INFINITY;
    for (int k = 0; k < 3; k++) {
        lune->normal[k] = 0;
        lune->s[k] = s[k];
        lune->v[k] = v[k];
        lune->low[k] = (s[k] > v[k] ? s[k] : v[k]) - d;
        lune->high[k] = (s[k] < v[k] ? s[k] : v[k]) + d;
    }
}

// Where v grew from a neighbor p whose lune was empty, what is in v's lune and was not in p's lies beyond the
// plane through s across the way from p to v: |w - p| > |p - s| and |w - v| <= |v - s| come to that. It is a
// cap of the ball round v, small when the vein grows toward s.
static void narrow_lune(vn_lune *lune, const double p[3]) {
    double step = sqrt(vn_distance2(p, lune->v)), along = 0;
    double d2 = vn_distance2(lune->s, lune->v);
    for (int k = 0; k < 3; k++) {
        along += (lune->v[k] - p[k]) / step * (lune->s[k] - lune->v[k]);
    }
    if (!(along > 0) || !(d2 < SURE * vn_distance2(p, lune->s))) {
        return;
    }
    double radius = sqrt(fmax(d2 - along * along, 0)) + 1e-6 * sqrt(d2);
    lune->least = -1e-6 * sqrt(d2);
    for (int k = 0; k < 3; k++) {
        lune->normal[k] = (lune->v[k] - p[k]) / step;
        lune->least += lune->normal[k] * lune->s[k];
        double center = lune->v[k] + along * (lune->v[k] - p[k]) / step;
        lune->low[k] = fmax(lune->low[k], center - radius);
        lune->high[k] = fmin(lune->high[k], center + radius);
    }
}

// Some node in the lune, or -1.
static int32_t find_in_lune(const vn_network *network, const vn_lune *lune) {
    lune_search search = {network, -1};
    vn_point_tree_any_in_lune(&network->tree_of_points, lune, is_in_lune, &search);
    return search.found;
}

// A node from which the triangulation is searched: a neighbor of old, or for a newcomer the nearest node.
static vn_status start_near(vn_attractors *a, vn_network *network, int32_t i, const double s[3],
                            int32_t *near) {
    *near = a->node.data[i];
    if (*near < 0) {
        const vn_point_grid *grid;
        vn_points nodes = vn_network_points(network);
        vn_nearest query = {.reach2 = INFINITY};
        VN_TRY(vn_network_grid(network, 0, &grid));
        vn_point_grid_nearest(grid, &nodes, s, &query);
        *near = query.point;
    }
    return VN_OK;
}

// The corners of the conflict hole, nearest first.
static vn_status find_hole(vn_attractors *a, vn_network *network, int32_t i, const double s[3],
                           double *circumradius) {
    vn_delaunay *delaunay;
    int32_t near;
    VN_TRY(start_near(a, network, i, s, &near));
    VN_TRY(vn_network_delaunay(network, &delaunay));
    VN_TRY(vn_delaunay_neighbors(delaunay, s, near, &a->candidates, circumradius));
    VN_TRY(vn_array_reserve(&a->near_nodes, a->candidates.count));
    vn_points nodes = vn_network_points(network);
    a->near_nodes.count = 0;
    for (int32_t k = 0; k < a->candidates.count; k++) {
        int32_t node = a->candidates.data[k];
        double d2 = vn_points_distance2(&nodes, node, s);
        int32_t at = a->near_nodes.count++;
        for (; at > 0 && a->near_nodes.data[at - 1].distance2 > d2; at--) {
            a->near_nodes.data[at] = a->near_nodes.data[at - 1];
        }
        a->near_nodes.data[at] = (vn_found){.point = node, .distance2 = d2};
    }
    return VN_OK;
}

// Whether a candidate excludes candidate @p k. Distances in doubles order them but for rounding, so what
// comes a little later is asked too.
static bool is_excluded_among(const vn_attractors *a, const vn_network *network, int32_t k,
                              const double s[3]) {
    double u[3], v[3];
    const vn_found *hits = a->near_nodes.data;
    vn_network_position(network, hits[k].point, v);
    double last = hits[k].distance2 * (1 + 1e-14);
    for (int32_t j = 0; j < a->near_nodes.count && hits[j].distance2 <= last; j++) {
        vn_network_position(network, hits[j].point, u);
        if (j != k && excludes(u, v, s)) {
            return true;
        }
    }
    return false;
}

static const double TURN = 6.283185307179586;

/// A direction in which something was found.
typedef struct bearing {
    double angle, x, y, distance;
} bearing;

static int by_angle(const void *left, const void *right) {
    const bearing *a = left, *b = right;
    return (a->angle > b->angle) - (a->angle < b->angle);
}

static bool is_in_room(const vn_attractors *a, double x, double y) {
    return x >= a->room.min[0] && x <= a->room.max[0] && y >= a->room.min[1] && y <= a->room.max[1];
}

// The distance from s at which a ray leaves the room.
static double way_out(const vn_attractors *a, const double s[3], double angle) {
    double direction[2] = {cos(angle), sin(angle)}, least = INFINITY;
    for (int k = 0; k < 2; k++) {
        double wall = direction[k] > 0 ? a->room.max[k] : a->room.min[k];
        double way = (wall - s[k]) / direction[k];
        least = way < least ? fmax(way, 0) : least;
    }
    return least;
}

// How far new nodes can be in the directions from one angle to another: to the walls of the room, farthest in
// a corner.
static double room_between(const vn_attractors *a, const double s[3], double from, double to) {
    if (to < from) {
        return 0;
    }
    if (!a->has_room || !is_in_room(a, s[0], s[1])) {
        return INFINITY;
    }
    double reach = fmax(way_out(a, s, from), way_out(a, s, to));
    for (int corner = 0; corner < 4; corner++) {
        double x = (corner & 1 ? a->room.max[0] : a->room.min[0]) - s[0];
        double y = (corner & 2 ? a->room.max[1] : a->room.min[1]) - s[1];
        double angle = atan2(y, x);
        angle += angle < from ? TURN : 0;
        reach = angle <= to ? fmax(reach, hypot(x, y)) : reach;
    }
    return reach;
}

// How far from s a relative neighbor may be in the directions between two found points: a point hides what
// is farther than itself up to 60° from its own direction, and beyond the bisector up to 90°.
static double reach_between(const vn_attractors *a, const double s[3], const bearing *p, const bearing *q) {
    double gap = q->angle - p->angle + (q->angle <= p->angle ? TURN : 0);
    double farther = fmax(p->distance, q->distance);
    if (gap <= 2.09) { // a little less than 120°
        return farther;
    }
    double area = fabs(p->x * q->y - p->y * q->x);
    double sides = p->distance * q->distance * hypot(p->x - q->x, p->y - q->y);
    if (gap < 3.14 && area > 1e-9 * p->distance * q->distance) {
        return fmax(farther, sides / (2 * area));
    }
    return fmax(farther, room_between(a, s, p->angle + 1.04, p->angle + gap - 1.04));
}

// How far from s a new node may be and still become a neighbor, or drive one out.
static double interest_of(const vn_attractors *a, const vn_network *network, const double s[3]) {
    enum { MOST = 64 };
    bearing bearings[MOST];
    double q[3], reach = 0;
    int32_t count = a->near_nodes.count;
    if (a->dim == 3 || count < 1 || count > MOST || a->near_nodes.data[0].distance2 == 0) {
        return INFINITY;
    }
    for (int32_t k = 0; k < count; k++) {
        vn_network_position(network, a->near_nodes.data[k].point, q);
        double x = q[0] - s[0], y = q[1] - s[1];
        bearings[k] = (bearing){atan2(y, x), x, y, sqrt(a->near_nodes.data[k].distance2)};
    }
    qsort(bearings, (size_t)count, sizeof *bearings, by_angle);
    for (int32_t k = 0; k < count; k++) {
        reach = fmax(reach, reach_between(a, s, &bearings[k], &bearings[(k + 1) % count]));
    }
    return reach;
}

static vn_status find_around(vn_attractors *a, vn_network *network, int32_t i, const double s[3]) {
    double reach;
    if (a->mode == VN_RELATIVE) {
        const vn_point_tree *tree;
        VN_TRY(vn_network_tree_of_points(network, &tree));
        VN_TRY(vn_point_tree_around(tree, s, a->reach2, &a->near_nodes));
        reach = interest_of(a, network, s);
    } else {
        VN_TRY(find_hole(a, network, i, s, &reach));
        reach *= 2; // what pushes a corner out of the hole is in one of the circles round it
    }
    a->near2.data[i] = fmin(reach * reach * (1 + 1e-6), a->reach2);
    return VN_OK;
}

bool vn_ties_have_room(const vn_attractors *a, const vn_network *network, int32_t begin) {
    for (int32_t node = begin; node < network->x.count && a->has_room && a->dim == 2; node++) {
        if (!is_in_room(a, network->x.data[node], network->y.data[node])) {
            return false;
        }
    }
    return true;
}

vn_status vn_ties_look(vn_attractors *a, vn_network *network, int32_t i) {
    double s[3], v[3];
    vn_attractors_place(a, i, s);
    VN_TRY(find_around(a, network, i, s));
    // Farthest first, so that the nearest becomes the head of the list, where it is asked first.
    for (int32_t k = a->near_nodes.count - 1; k >= 0; k--) {
        vn_found found = a->near_nodes.data[k];
        vn_network_position(network, found.point, v);
        vn_lune lune;
        set_lune(&lune, s, v);
        if (found.distance2 <= a->reach2 && !is_excluded_among(a, network, k, s) &&
            (a->mode == VN_URQUHART || find_in_lune(network, &lune) < 0) && !is_tie(a, i, found.point)) {
            VN_TRY(add_tie(a, network, i, found.point, found.distance2));
        }
    }
    return VN_OK;
}

// In the key of a new node beside the attractor's number: it grew from a member.
static const uint64_t OF_MEMBER = (uint64_t)1 << 63;

// New nodes drive out the members that they exclude, even where they are no members themselves: that is what
// sets the relative neighbors apart from the Urquhart ones (Figure 8). What a member excludes gets the node
// -1 - node in the list.
static void push_in(vn_attractors *a, const vn_network *network, int32_t i, const double s[3], vn_keyed *news,
                    int32_t count) {
    for (int32_t tie = a->first_tie.data[i]; tie >= 0; tie = a->ties.data[tie].next) {
        double v[3], u[3];
        if (a->ties.data[tie].state & VN_GHOST) {
            continue;
        }
        vn_network_position(network, a->ties.data[tie].node, v);
        for (int32_t k = 0; k < count; k++) {
            int32_t node = news[k].value;
            vn_network_position(network, node < 0 ? -1 - node : node, u);
            if (node >= 0 && excludes(v, u, s)) {
                news[k].value = -1 - node;
            } else if (excludes(u, v, s)) {
                a->ties.data[tie].state |= VN_GHOST;
            }
        }
    }
}

static bool is_excluded_by_new(const vn_network *network, const double s[3], const vn_keyed *news,
                               int32_t count, int32_t k) {
    double u[3], w[3];
    vn_network_position(network, news[k].value, u);
    for (int32_t j = 0; j < count; j++) {
        int32_t node = news[j].value;
        vn_network_position(network, node < 0 ? -1 - node : node, w);
        if (j != k && excludes(w, u, s)) {
            return true;
        }
    }
    return false;
}

static vn_status welcome(vn_attractors *a, const vn_network *network, int32_t i, const double s[3],
                         const vn_keyed *news) {
    double u[3], p[3];
    vn_lune lune;
    int32_t node = news->value;
    vn_network_position(network, node, u);
    set_lune(&lune, s, u);
    if (news->key & OF_MEMBER) {
        vn_network_position(network, network->parent.data[node], p);
        narrow_lune(&lune, p);
    }
    int32_t between = find_in_lune(network, &lune);
    if (between >= 0) {
        post_guard(a, network, i, between, false);
        return VN_OK;
    }
    return is_tie(a, i, node) ? VN_OK : add_tie(a, network, i, node, vn_distance2(s, u));
}

// Asked before any of them drives another one out.
static void mark_children_of_members(const vn_attractors *a, const vn_network *network, int32_t i,
                                     vn_keyed *news, int32_t count) {
    for (int32_t k = 0; k < count; k++) {
        int32_t parent = network->parent.data[news[k].value];
        news[k].key |= parent >= 0 && is_tie(a, i, parent) ? OF_MEMBER : 0;
    }
}

static vn_status show_group(vn_attractors *a, const vn_network *network, vn_keyed *news, int32_t count) {
    int32_t i = (int32_t)news[0].key;
    double s[3];
    if (a->mode == VN_URQUHART) {
        return vn_array_push(&a->outdated, i);
    }
    vn_attractors_place(a, i, s);
    mark_children_of_members(a, network, i, news, count);
    push_in(a, network, i, s, news, count);
    vn_status status = VN_OK;
    for (int32_t k = 0; k < count && status == VN_OK; k++) {
        if (news[k].value >= 0 && !is_excluded_by_new(network, s, news, count, k)) {
            status = welcome(a, network, i, s, &news[k]);
        }
    }
    return status;
}

vn_status vn_ties_show(vn_attractors *a, const vn_network *network) {
    VN_TRY(vn_sort_keyed(&a->news, &a->scratch));
    for (int32_t begin = 0, end; begin < a->news.count; begin = end) {
        end = begin + 1;
        while (end < a->news.count && a->news.data[end].key == a->news.data[begin].key) {
            end++;
        }
        VN_TRY(show_group(a, network, a->news.data + begin, end - begin));
    }
    a->news.count = 0;
    return VN_OK;
}

vn_status vn_ties_renew(vn_attractors *a, vn_network *network) {
    for (int32_t k = 0; k < a->outdated.count; k++) {
        int32_t i = a->outdated.data[k];
        for (int32_t tie = a->first_tie.data[i]; tie >= 0; tie = a->ties.data[tie].next) {
            a->ties.data[tie].state |= VN_GHOST;
        }
        if (!vn_is_gone(a, i)) {
            VN_TRY(vn_ties_look(a, network, i));
        }
    }
    a->outdated.count = 0;
    return VN_OK;
}
