// Rooms asked for and given (network/berth.h). A new edge keeps a gap beside the radii; from then on whoever
// grows thicker first takes what is left.

#include "colonize/avoid.h"

#include "space/tube_grid.h"

// An edge that asks for room asks for so many times its radius, so that it need not ask for every tip. Half
// of what both leave free is not taken.
static const double FORESIGHT = 2;

// Distances are taken for a little shorter: rounding must not let tubes touch.
static const double LESS = 1 - 1e-9;

static vn_status check_networks(const vn_network *network, const vn_extend_def *def) {
    for (int32_t i = 0; i < def->avoid_count; i++) {
        const vn_network *other = def->avoid[i];
        if (other == network) {
            return vn_fail(VN_INVALID, "extend.avoid: a network cannot avoid itself: name the others");
        }
        if (other->dim != network->dim) {
            return vn_fail(VN_INVALID, "extend.avoid: a network of %d dimensions cannot avoid one of %d",
                           network->dim, other->dim);
        }
    }
    return VN_OK;
}

static vn_status check_avoid(const vn_network *network, const vn_extend_def *def) {
    if (def->avoid_count > VN_MOST_AVOIDED) {
        return vn_fail(VN_LIMIT, "extend.avoid: %d networks, at most %d", def->avoid_count, VN_MOST_AVOIDED);
    }
    VN_TRY(check_networks(network, def));
    if (def->meet == VN_MEET_JOIN || network->joins.count > 0 || network->law.veinlets > 0) {
        return vn_fail(VN_INVALID,
                       "extend.avoid is for networks without joins and veinlets: how thick their edges will "
                       "be cannot be foreseen");
    }
    return VN_OK;
}

// What an asker was told stays true as long as the other asks too, and nothing happens to it otherwise.
static vn_asked stamp_of(const vn_network *other, const vn_network *asker) {
    for (int32_t i = 0; i < other->berth.asked.count; i++) {
        if (other->berth.asked.data[i].serial == asker->serial) {
            return (vn_asked){other->serial, other->berth.epoch};
        }
    }
    return (vn_asked){other->serial, ~other->version};
}

static vn_status remember_asked(const vn_avoidance *v) {
    vn_berth *berth = &v->network->berth;
    bool same = berth->asked.count == v->count;
    VN_TRY(vn_array_reserve(&berth->asked, v->count));
    berth->asked.count = v->count;
    for (int32_t i = 0; i < v->count; i++) {
        vn_asked now = stamp_of(v->others[i], v->network), *then = &berth->asked.data[i];
        same = same && now.serial == then->serial && now.epoch == then->epoch;
        *then = now;
    }
    if (!same) {
        vn_berth_forget(v->network);
    }
    return VN_OK;
}

vn_status vn_avoid_begin(vn_avoidance *v, vn_network *network, const vn_extend_def *def) {
    VN_TRY(check_avoid(network, def));
    *v = (vn_avoidance){.network = network,
                        .others = def->avoid,
                        .count = def->avoid_count,
                        .gap = def->gap >= 0 ? def->gap : def->length / 4,
                        .tip_node = -1};
    VN_TRY(vn_berth_update(network, def->length, true));
    for (int32_t i = 0; i < v->count; i++) {
        VN_TRY(vn_berth_update(v->others[i], def->length, false));
    }
    return remember_asked(v);
}

// ---- Looking around ----

/// One tube that is, or is to be, and those of others near it.
typedef struct look {
    vn_avoidance *v;
    vn_network *other;
    int32_t node;       ///< where a new one starts; -1: it is there already
    double a[3], b[3];  ///< its axis
    double now, radius; ///< that it has (negative: none yet), and that it is to have
    double room;        ///< what it may take
    bool refused;
} look;

// Whether the other tube matters to one of radius @p reach: then how far the axes are apart, and how thick it
// is.
static bool is_near(const look *l, int32_t item, double reach, double *distance, double *radius) {
    double c[3], d[3];
    vn_berth_ends(l->other, item, c, d);
    *distance = sqrt(vn_segment_segment_distance2(l->a, l->b, c, d));
    if (*distance * LESS >= reach + vn_berth_room(l->other, item)) {
        return false;
    }
    *radius = vn_berth_radius(l->other, item);
    return l->now + *radius < *distance || l->now < 0; // what overlaps already cannot be helped
}

static double away_from(const look *l, int32_t item) {
    double c[3], d[3];
    vn_berth_ends(l->other, item, c, d);
    return sqrt(vn_point_segment_distance2(l->a, c, d));
}

static void note_buried(const look *l, double away, double needed) {
    vn_avoidance *v = l->v;
    const vn_network *network = v->network;
    if (!v->buried && network->parent.data[l->node] < 0 && network->first_child.data[l->node] < 0 &&
        away <= needed) {
        v->buried = true;
        v->root = l->node;
        v->away = away;
        v->needed = needed;
    }
}

// A new edge keeps the gap, or at least comes no nearer than the node that it starts from.
static bool keeps_away(int32_t item, void *payload) {
    look *l = payload;
    double distance, radius, gap = l->v->gap;
    if (!is_near(l, item, l->radius + gap, &distance, &radius) ||
        distance * LESS >= l->radius + radius + gap) {
        return true;
    }
    double away = away_from(l, item);
    bool fits = distance * LESS > l->radius + radius && distance >= away * LESS;
    if (!fits) {
        l->refused = true;
        note_buried(l, away, l->radius + radius);
    }
    return fits;
}

static bool find_room(int32_t item, void *payload) {
    look *l = payload;
    double distance, radius;
    if (!is_near(l, item, l->room, &distance, &radius)) {
        return true;
    }
    double left = distance * LESS - radius - l->radius;
    l->refused = left < 0;
    l->room = fmin(l->room, l->radius + left / 2);
    return !l->refused;
}

static bool take_room(int32_t item, void *payload) {
    look *l = payload;
    double distance, radius;
    if (is_near(l, item, l->room, &distance, &radius)) {
        vn_berth_yield(l->other, item, distance * LESS - l->room);
    }
    return true;
}

static bool look_around(look *l, double reach, vn_box_visit_fn *visit) {
    double low[3], high[3];
    for (int k = 0; k < 3; k++) {
        low[k] = fmin(l->a[k], l->b[k]) - reach;
        high[k] = fmax(l->a[k], l->b[k]) + reach;
    }
    for (int32_t i = 0; i < l->v->count && !l->refused; i++) {
        l->other = l->v->others[i];
        vn_box_grid_visit(&l->other->berth.grid, low, high, visit, l);
    }
    return !l->refused;
}

// ---- Edges that grow thicker ----

static look look_of(vn_avoidance *v, int32_t node, double now, double radius) {
    look l = {.v = v, .node = -1, .now = now, .radius = radius};
    vn_berth_ends(v->network, node, l.a, l.b);
    return l;
}

// Whether an edge can be as thick as so many tips make it.
static bool fits(vn_avoidance *v, int32_t node, int32_t tips) {
    double radius = vn_murray_radius(v->network, tips);
    if (radius <= vn_berth_room(v->network, node)) { // tips are thinner than when it asked
        return true;
    }
    look l = look_of(v, node, vn_berth_radius(v->network, node), radius);
    l.room = radius;
    return look_around(&l, radius, find_room);
}

static bool fits_another_tip(vn_avoidance *v, int32_t node) {
    const vn_network *network = v->network;
    if (!network->berth.simple) {
        return true;
    }
    if (v->tip_node == node && v->tip_version == network->version) {
        return v->tip_fits;
    }
    v->tip_fits = true;
    for (int32_t i = node; v->tip_fits && network->parent.data[i] >= 0; i = network->parent.data[i]) {
        int32_t tips = network->tips.data[i] + 1;
        v->tip_fits = tips <= vn_berth_most(network, i) || fits(v, i, tips);
    }
    v->tip_node = node;
    v->tip_version = network->version;
    return v->tip_fits;
}

// Take room for what an edge is now, and some more.
static vn_status widen(vn_avoidance *v, int32_t node, double now) {
    double radius = vn_berth_radius(v->network, node), room = vn_berth_room(v->network, node);
    if (radius > room) {
        look l = look_of(v, node, now, radius);
        l.room = FORESIGHT * radius;
        room = look_around(&l, l.room, find_room) ? l.room : radius;
        l.room = room;
        l.refused = false;
        look_around(&l, room, take_room);
    }
    return vn_berth_claim(v->network, node, room);
}

static vn_status widen_all(vn_avoidance *v, int32_t node) {
    const vn_network *network = v->network;
    vn_network_settle(network);
    for (int32_t i = node; network->parent.data[i] >= 0; i = network->parent.data[i]) {
        int32_t tips = network->tips.data[i];
        if (tips > vn_berth_most(network, i)) {
            VN_TRY(widen(v, i, vn_murray_radius(network, tips - 1)));
        }
    }
    return VN_OK;
}

// ---- New edges ----

static double radius_of_new(const vn_network *network, int32_t node) {
    return network->berth.simple ? network->law.tip_radius : vn_network_radius(network, node);
}

bool vn_avoid_allows(vn_avoidance *v, int32_t node, const double p[3], bool forks) {
    double radius = radius_of_new(v->network, node);
    look l = {.v = v, .node = node, .now = -1, .radius = radius, .b = {p[0], p[1], p[2]}};
    vn_network_position(v->network, node, l.a);
    bool adds_tip = forks || v->network->first_child.data[node] >= 0;
    bool allows = (!adds_tip || fits_another_tip(v, node)) && look_around(&l, radius + v->gap, keeps_away);
    v->refused = v->refused || !allows;
    return allows;
}

vn_status vn_avoid_grown(vn_avoidance *v, int32_t node) {
    vn_network *network = v->network;
    int32_t child = network->x.count - 1;
    double radius = radius_of_new(network, node);
    look l = look_of(v, child, -1, radius);
    l.room = FORESIGHT * radius;
    look_around(&l, l.room, find_room);
    l.room = fmax(l.room, radius);
    l.refused = false;
    look_around(&l, l.room, take_room);
    VN_TRY(vn_berth_append(network, l.room));
    v->refused = false;
    bool adds_tip = network->next_child.data[child] >= 0;
    return adds_tip && network->berth.simple ? widen_all(v, node) : VN_OK;
}

vn_status vn_avoid_end(const vn_avoidance *v) {
    double p[3];
    if (!v->buried) {
        return VN_OK;
    }
    vn_network_position(v->network, v->root, p);
    return vn_fail(
        VN_INVALID,
        "extend.avoid: the root at (%g, %g, %g) is %g from an edge or a root to be avoided, nearer "
        "than their radii together, %g: place it farther away",
        p[0], p[1], p[2], v->away, v->needed);
}
