#include "network/berth.h"

// Pieces of an edge that are listed with boxes of their own are at most so many cells long.
static const double PIECE = 2;
enum { MOST_PIECES = 1024, MOST_LEVELS = 60 };

void vn_berth_free(vn_berth *berth) {
    vn_box_grid_free(&berth->grid);
    vn_array_free(&berth->room);
    vn_array_free(&berth->most);
    vn_array_free(&berth->level);
    vn_array_free(&berth->asked);
}

void vn_berth_ends(const vn_network *network, int32_t item, double a[3], double b[3]) {
    int32_t from, to;
    vn_network_edge_ends(network, item, &from, &to);
    vn_network_position(network, from >= 0 ? from : to, a);
    vn_network_position(network, to, b);
}

double vn_berth_radius(const vn_network *network, int32_t item) {
    if (item < 0) {
        int32_t a, b;
        double radius;
        vn_network_join_ends(network, -1 - item, &a, &b, &radius);
        return radius;
    }
    if (!network->berth.simple) {
        return vn_network_radius(network, item);
    }
    return vn_murray_radius(network, network->parent.data[item] >= 0 ? network->tips.data[item] : 1);
}

double vn_berth_room(const vn_network *network, int32_t item) {
    return item < 0 ? vn_berth_radius(network, item) : network->berth.room.data[item];
}

// ---- Where edges are listed ----

static double reach_of(const vn_berth *berth, int level) {
    return ldexp(berth->grid.cell / 4, level);
}

static int level_for(const vn_berth *berth, double room) {
    int level = 0;
    while (level < MOST_LEVELS && reach_of(berth, level) < room * (1 + 1e-9)) {
        level++;
    }
    return level;
}

static vn_status list_piece(vn_berth *berth, int32_t item, const double a[3], const double b[3],
                            double reach) {
    double low[3], high[3];
    for (int k = 0; k < 3; k++) {
        low[k] = fmin(a[k], b[k]) - reach;
        high[k] = fmax(a[k], b[k]) + reach;
    }
    return vn_box_grid_insert(&berth->grid, item, low, high);
}

static vn_status list(vn_network *network, int32_t item, int level) {
    vn_berth *berth = &network->berth;
    double a[3], b[3], reach = reach_of(berth, level), from[3], to[3];
    vn_berth_ends(network, item, a, b);
    double length = sqrt(vn_distance2(a, b));
    int pieces = (int)fmin(fmax(ceil(length / (PIECE * berth->grid.cell)), 1), MOST_PIECES);
    memcpy(from, a, sizeof from);
    for (int i = 1; i <= pieces; i++) {
        for (int k = 0; k < 3; k++) {
            to[k] = i < pieces ? a[k] + (b[k] - a[k]) * i / pieces : b[k];
        }
        VN_TRY(list_piece(berth, item, from, to, reach));
        memcpy(from, to, sizeof from);
    }
    return VN_OK;
}

static vn_status list_node(vn_network *network, int32_t node) {
    vn_berth *berth = &network->berth;
    int level = level_for(berth, berth->room.data[node]);
    berth->level.data[node] = (uint8_t)level;
    return list(network, node, level);
}

static vn_status list_all(vn_network *network, double length) {
    vn_berth *berth = &network->berth;
    int32_t count = network->x.count + network->joins.count;
    double origin[3] = {0, 0, 0};
    if (network->x.count > 0) {
        vn_network_position(network, 0, origin);
    }
    berth->items = count < INT32_MAX / 2 ? 2 * count + 512 : INT32_MAX;
    VN_TRY(vn_box_grid_init(&berth->grid, network->dim, length, origin, berth->items));
    for (int32_t i = 0; i < berth->room.count; i++) {
        VN_TRY(list_node(network, i));
    }
    for (int32_t j = 0; j < network->joins.count; j++) {
        VN_TRY(list(network, -1 - j, level_for(berth, vn_berth_radius(network, -1 - j))));
    }
    return VN_OK;
}

// ---- Rooms ----

static int32_t most_tips(const vn_network *network, double room) {
    if (!network->berth.simple) {
        return INT32_MAX;
    }
    const double less = 1 - 1e-12; // what rounding may make of a power
    double tips = less * pow(room / network->law.tip_radius, network->law.exponent);
    return tips < INT32_MAX ? (int32_t)tips : INT32_MAX;
}

static void set_bare_room(vn_network *network, int32_t node) {
    vn_berth *berth = &network->berth;
    berth->room.data[node] = vn_berth_radius(network, node);
    berth->most.data[node] = berth->simple ? network->tips.data[node] : INT32_MAX;
}

void vn_berth_forget(vn_network *network) {
    for (int32_t i = 0; network->berth.rooms && i < network->berth.room.count; i++) {
        set_bare_room(network, i);
    }
    network->berth.rooms = false;
}

vn_status vn_berth_claim(vn_network *network, int32_t node, double room) {
    vn_berth *berth = &network->berth;
    berth->rooms = true;
    berth->room.data[node] = room;
    berth->most.data[node] = most_tips(network, room);
    int level = level_for(berth, room);
    if (level <= berth->level.data[node]) {
        return VN_OK;
    }
    berth->level.data[node] = (uint8_t)level;
    return list(network, node, level);
}

void vn_berth_yield(vn_network *network, int32_t item, double room) {
    vn_berth *berth = &network->berth;
    if (item < 0 || room >= berth->room.data[item]) {
        return;
    }
    if (room > vn_berth_radius(network, item)) {
        berth->room.data[item] = room;
        berth->most.data[item] = most_tips(network, room);
    } else {
        set_bare_room(network, item);
    }
}

vn_status vn_berth_append(vn_network *network, double room) {
    vn_berth *berth = &network->berth;
    int32_t node = berth->room.count;
    VN_TRY(vn_array_reserve(&berth->room, (int64_t)node + 1));
    VN_TRY(vn_array_reserve(&berth->most, (int64_t)node + 1));
    VN_TRY(vn_array_reserve(&berth->level, (int64_t)node + 1));
    berth->room.data[node] = room;
    berth->most.data[node] = most_tips(network, room);
    berth->room.count = berth->most.count = berth->level.count = node + 1;
    berth->rooms = true;
    berth->version = network->version;
    return list_node(network, node);
}

// ---- What happened since ----

static bool has_new_edges(const vn_network *network) {
    bool has = false;
    for (int32_t i = network->berth.room.count; i < network->x.count && !has; i++) {
        has = network->parent.data[i] >= 0;
    }
    return has;
}

// Whether something changed that did not ask for room.
static bool is_outdated(const vn_network *network, bool simple) {
    const vn_berth *berth = &network->berth;
    const vn_murray_def *law = &network->law;
    return !berth->ready || berth->simple != simple || berth->moved != network->moved ||
           berth->joins != network->joins.count || (!simple && berth->version != network->version) ||
           (simple && (law->exponent != berth->law.exponent || law->tip_radius > berth->law.tip_radius)) ||
           has_new_edges(network);
}

static vn_status reset_rooms(vn_network *network) {
    vn_berth *berth = &network->berth;
    int32_t count = network->x.count;
    VN_TRY(vn_array_reserve(&berth->room, count));
    VN_TRY(vn_array_reserve(&berth->most, count));
    VN_TRY(vn_array_reserve(&berth->level, count));
    berth->room.count = berth->most.count = berth->level.count = count;
    for (int32_t i = 0; i < count; i++) {
        set_bare_room(network, i);
    }
    berth->rooms = false;
    return VN_OK;
}

static vn_status start_anew(vn_network *network, bool simple, double length) {
    vn_berth *berth = &network->berth;
    berth->ready = false; // until all is done
    berth->epoch++;
    berth->simple = simple;
    berth->law = network->law;
    VN_TRY(reset_rooms(network));
    VN_TRY(list_all(network, length));
    berth->moved = network->moved;
    berth->joins = network->joins.count;
    berth->ready = true;
    return VN_OK;
}

static vn_status add_roots(vn_network *network) {
    while (network->berth.room.count < network->x.count) {
        VN_TRY(vn_berth_append(network, vn_berth_radius(network, network->berth.room.count)));
        network->berth.epoch++;
    }
    return VN_OK;
}

vn_status vn_berth_update(vn_network *network, double length, bool own) {
    vn_berth *berth = &network->berth;
    bool simple = network->murray && !vn_demand_rules(network);
    if (simple && (network->recount || network->pending.count > 0)) {
        vn_network_settle(network);
    }
    double cell = berth->grid.cell;
    bool fits = cell > 0 && (!own || (cell <= 4 * length && length <= 4 * cell));
    if (is_outdated(network, simple)) {
        VN_TRY(start_anew(network, simple, fits ? cell : length));
    } else if (!fits || (int64_t)network->x.count + network->joins.count > berth->items) {
        VN_TRY(list_all(network, fits ? cell : length));
    }
    berth->law = network->law;
    VN_TRY(add_roots(network));
    berth->version = network->version;
    return VN_OK;
}
