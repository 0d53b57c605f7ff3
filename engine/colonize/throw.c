// Dart throwing (Runions et al. 2005, section 3.3; READINGS R1 and R2).

#include "colonize/attractors.h"

#include "base/hash.h"
#include "base/parallel.h"
#include "domain/domain.h"

#include <stdatomic.h>
#include <stdlib.h>

static const vn_throw_def throw_default = {0};

static const vn_field throw_fields[] = {
    {"domain", VN_OBJECT, VN_REQUIRED, offsetof(vn_throw_def, domain), 0, 0, "", "domain",
     "where the darts fall"},
    {"count", VN_I32, VN_OPTIONAL, offsetof(vn_throw_def, count), 0, INT32_MAX, "darts", NULL,
     "how many darts; or give `density`"},
    {"density", VN_F64, VN_OPTIONAL, offsetof(vn_throw_def, density), 0, VN_HUGE, "darts/length²", NULL,
     "darts per area (volume) of the domain; a fraction of a dart is carried to the next call"},
    {"spacing", VN_F64, VN_ABOVE_MIN | VN_OPTIONAL, offsetof(vn_throw_def, spacing), 0, 1e150, "length", NULL,
     "birth distance b_s: a dart this close to an attractor is refused; left out: none is"},
    {"clearance", VN_F64, VN_ABOVE_MIN | VN_OPTIONAL, offsetof(vn_throw_def, clearance), 0, 1e150, "length",
     NULL, "birth distance b_v: a dart this close to a node of `network` is refused; left out: none is"},
    {"network", VN_OBJECT, 0, offsetof(vn_throw_def, network), 0, 0, "", "network",
     "what `clearance` keeps clear of"},
    {"weight", VN_MIXED, 0, offsetof(vn_throw_def, weight), 0, 0, "", "a domain, or a function (x, y[, z])",
     "what part of the darts is kept at a place, 0 to 1: a map's values, or what the function returns; left "
     "out: all"},
    {"rng", VN_OBJECT, VN_REQUIRED, offsetof(vn_throw_def, rng), 0, 0, "", "rng",
     "the random numbers: venule.rng(seed)"},
};
const vn_schema vn_throw_schema = VN_SCHEMA(
    "throw", "Throw darts at a domain; those that stick become attractors", throw_fields, throw_default);

vn_throw_def vn_throw_def_default(void) {
    return throw_default;
}

enum { DARTS_AT_ONCE = 1 << 14 };

/// Darts that fly in parallel: each from random numbers of its own.
typedef struct volley {
    const vn_throw_def *def;
    vn_rng rng;
    int64_t first;        ///< the number of the first dart of this volley
    double (*at)[3];      ///< x is NAN where `weight` did not keep the dart
    atomic_bool hopeless; ///< one dart has missed a million times: the others need not try
} volley;

static vn_rng dart_rng(const volley *v, int64_t dart) {
    return (vn_rng){.seed = v->rng.seed,
                    .stream = vn_hash_here(v->rng.seed, v->rng.stream, (uint64_t)dart, 2)};
}

// By a number apart from the dart's own: the places are those of a throw without weight.
static void keep_by(const volley *v, int64_t k, double weight) {
    uint64_t stream = vn_hash(v->rng.seed, v->rng.stream, (uint64_t)(v->first + k), 3);
    if (!(vn_random_at(v->rng.seed, stream, 0) < weight)) {
        v->at[k][0] = NAN;
    }
}

static void fly(int64_t begin, int64_t end, void *payload) {
    volley *v = payload;
    for (int64_t k = begin; k < end; k++) {
        if (atomic_load_explicit(&v->hopeless, memory_order_relaxed)) {
            return;
        }
        vn_rng rng = dart_rng(v, v->first + k);
        if (vn_domain_dart(v->def->domain, &rng, v->at[k]) != VN_OK) {
            atomic_store_explicit(&v->hopeless, true, memory_order_relaxed);
        } else if (v->def->weight != NULL) {
            keep_by(v, k, vn_domain_value(v->def->weight, v->at[k]));
        }
    }
}

// A function may be the script's: it is asked in order, by one thread.
static vn_status ask_weights(const volley *v, int32_t count) {
    const vn_throw_def *def = v->def;
    for (int32_t k = 0; def->weight_at != NULL && k < count; k++) {
        double weight = 0;
        const double *p = v->at[k];
        if (isnan(p[0])) {
            continue;
        }
        VN_TRY(def->weight_at(&weight, p, def->weight_payload));
        if (!(weight >= 0 && weight <= 1)) {
            return vn_fail(VN_INVALID, "throw.weight is %g at (%g, %g, %g); it must be between 0 and 1",
                           weight, p[0], p[1], p[2]);
        }
        keep_by(v, k, weight);
    }
    return VN_OK;
}

static bool is_present(int32_t i, void *payload) {
    return !vn_is_gone(payload, i);
}

// "Farther" is strict: a dart at exactly the birth distance is refused (READINGS R1).
static double beyond(double distance) {
    return nextafter(distance, INFINITY);
}

/// The nodes that attractors keep clear of, and where these are looked up: nowhere, if none need be.
typedef struct clearing {
    const vn_network *network;
    const vn_point_tree *tree;
    const vn_point_grid *grid;
    double reach;
} clearing;

// Where the relative neighbors are kept, their tree answers too: newcomers look around in it next, and then
// what is near them has come out of far memory already.
static vn_status prepare_clearing(clearing *c, vn_network *network, double clearance) {
    *c = (clearing){.network = network, .reach = beyond(clearance)};
    if (network == NULL || clearance <= 0) {
        return VN_OK;
    }
    return network->tree_of_points.cells.count > 0 ? vn_network_tree_of_points(network, &c->tree)
                                                   : vn_network_grid(network, clearance, &c->grid);
}

// The nodes have no number to give where a tree answers: then it is 0.
static bool is_clear(const clearing *c, const double p[3], int32_t *refuser) {
    *refuser = -1;
    if (c->tree == NULL && c->grid == NULL) {
        return true;
    }
    if (c->tree != NULL) {
        *refuser = vn_point_tree_any_within(c->tree, p, c->reach) ? 0 : -1;
    } else {
        vn_points nodes = vn_network_points(c->network);
        *refuser = vn_point_grid_any_within(c->grid, &nodes, p, c->reach, NULL, NULL);
    }
    return *refuser < 0;
}

/// Who refused the last dart that fell where the next ones do: near saturation almost every dart is refused
/// by the same few. A slot is shared by cells that are hashed alike; whoever is named in it is asked for his
/// distance, so a wrong name costs time and nothing else.
typedef struct refusals {
    const clearing *nodes;
    vn_attractors *a;
    double cell, spacing;
} refusals;

enum { FEWEST_SLOTS = 1 << 10, MOST_SLOTS = 1 << 20 };

static vn_status prepare_refusals(refusals *r, vn_attractors *a, const clearing *nodes, double spacing) {
    double nodes_reach = nodes->grid != NULL ? nodes->reach : 0,
           own_reach = spacing > 0 ? beyond(spacing) : 0;
    *r = (refusals){nodes, a, 0.8 * fmax(nodes_reach, own_reach), own_reach};
    if (r->cell == 0) {
        return VN_OK; // nothing is refused
    }
    int64_t points = (int64_t)a->x.count + (nodes->grid != NULL ? nodes->network->x.count : 0);
    int32_t slots = a->refusers.count > 0 ? a->refusers.count : FEWEST_SLOTS;
    while (slots < 4 * points && slots < MOST_SLOTS) {
        slots *= 2;
    }
    if (slots == a->refusers.count) {
        return VN_OK;
    }
    VN_TRY(vn_array_reserve(&a->refusers, slots));
    memset(a->refusers.data, 0, (size_t)slots * sizeof *a->refusers.data);
    a->refusers.count = slots;
    return VN_OK;
}

// Coordinates of cells may be beyond any integer: their doubles are hashed.
static int32_t *slot_of(const refusals *r, const double p[3]) {
    uint64_t h = 0;
    for (int k = 0; k < r->a->dim; k++) {
        double cell = floor(p[k] / r->cell);
        uint64_t bits;
        memcpy(&bits, &cell, sizeof bits);
        h = vn_mix(h ^ bits); // small whole numbers differ in their high bits only
    }
    return &r->a->refusers.data[h & (uint64_t)(r->a->refusers.count - 1)];
}

// A node's number above 0, or an attractor's below; 0: nobody.
static bool is_refused_again(const refusals *r, int32_t refuser, const double p[3]) {
    if (refuser > 0 && r->nodes->grid != NULL && refuser <= r->nodes->network->x.count) {
        vn_points nodes = vn_network_points(r->nodes->network);
        return vn_points_distance2(&nodes, refuser - 1, p) < r->nodes->reach * r->nodes->reach;
    }
    int32_t i = -1 - refuser;
    vn_points points = vn_attractors_points(r->a);
    return refuser < 0 && i < r->a->x.count && vn_points_distance2(&points, i, p) < r->spacing * r->spacing &&
           !vn_is_gone(r->a, i);
}

// Where vessels look through the same grid, from farther off, its cells are for them.
static double cell_for(const vn_attractors *a, double spacing) {
    return fmax(spacing, vn_attractors_reach(a));
}

static vn_status find_neighbour(const refusals *r, const double p[3], int32_t *neighbour) {
    vn_attractors *a = r->a;
    *neighbour = -1;
    if (r->spacing > 0) {
        if (vn_point_grid_count(&a->grid) < a->x.count) {
            VN_TRY(vn_attractors_grid(a, cell_for(a, r->spacing)));
        }
        vn_points points = vn_attractors_points(a);
        *neighbour = vn_point_grid_any_within(&a->grid, &points, p, r->spacing, is_present, a);
    }
    return VN_OK;
}

static vn_status land_one(const refusals *r, const double p[3], int32_t *accepted) {
    int32_t refuser;
    int32_t *slot = r->cell > 0 ? slot_of(r, p) : NULL;
    if (slot != NULL && is_refused_again(r, *slot, p)) {
        return VN_OK;
    }
    if (!is_clear(r->nodes, p, &refuser)) {
        if (slot != NULL && r->nodes->grid != NULL) {
            *slot = refuser + 1;
        }
        return VN_OK;
    }
    VN_TRY(find_neighbour(r, p, &refuser));
    if (refuser >= 0 && slot != NULL) {
        *slot = -1 - refuser;
    }
    if (refuser >= 0) {
        return VN_OK;
    }
    VN_TRY(vn_attractors_add(r->a, p));
    ++*accepted;
    return VN_OK;
}

static bool covers(const vn_attractors *a, const vn_throw_def *def) {
    const vn_cover *cover = &a->cover;
    return a->cover_network == def->network->serial && a->cover_moved == def->network->moved &&
           cover->radius < def->clearance && cover->radius >= 0.7 * def->clearance;
}

// Where the clearance shrinks the cover is made for what it will shrink to.
static vn_status make_cover(vn_attractors *a, const vn_throw_def *def) {
    bool shrinks = a->cover_network == def->network->serial && a->cover.radius >= def->clearance;
    vn_box bounds = vn_domain_bounds(def->domain);
    a->cover_network = 0; // nobody's, should there be no memory for it
    a->cover_nodes = 0;
    a->cover_darts = 0;
    VN_TRY(
        vn_cover_init(&a->cover, a->dim, bounds.min, bounds.max, (shrinks ? 0.85 : 0.999) * def->clearance));
    a->cover_network = def->network->serial;
    a->cover_moved = def->network->moved;
    return VN_OK;
}

// Whether the cover can be asked, with all nodes in it. To make it pays when it has been asked for at least
// every eighth node.
static vn_status renew_cover(vn_attractors *a, const vn_throw_def *def, int64_t darts, bool *use) {
    const vn_network *network = def->network;
    *use = false;
    if (network == NULL || def->clearance <= 0) {
        return VN_OK;
    }
    a->cover_darts += darts;
    if (!covers(a, def)) {
        if (8 * a->cover_darts < network->x.count) {
            return VN_OK;
        }
        VN_TRY(make_cover(a, def));
    }
    for (; a->cover.cell > 0 && a->cover_nodes < network->x.count; a->cover_nodes++) {
        double p[3];
        vn_network_position(network, a->cover_nodes, p);
        vn_cover_add(&a->cover, p);
    }
    *use = a->cover.cell > 0;
    return VN_OK;
}

static vn_status land(vn_attractors *a, const vn_throw_def *def, const volley *v, int32_t count,
                      int32_t *accepted) {
    clearing nodes;
    refusals r;
    bool covered;
    VN_TRY(renew_cover(a, def, count, &covered));
    VN_TRY(prepare_clearing(&nodes, def->network, def->clearance));
    VN_TRY(prepare_refusals(&r, a, &nodes, def->spacing));
    if (def->spacing > 0) {
        VN_TRY(vn_attractors_grid(a, cell_for(a, def->spacing)));
    }
    for (int32_t k = 0; k < count; k++) {
        bool kept = !isnan(v->at[k][0]);
        if (kept && !(covered && vn_cover_holds(&a->cover, v->at[k]))) {
            VN_TRY(land_one(&r, v->at[k], accepted));
        }
    }
    return vn_poll();
}

static vn_status throw_darts(vn_attractors *a, const vn_throw_def *def, int64_t darts, int32_t *accepted) {
    int64_t room = darts < DARTS_AT_ONCE ? darts : DARTS_AT_ONCE;
    volley v = {.def = def, .rng = vn_rng_fork(def->rng)};
    v.at = vn_resize(NULL, 0, (size_t)room * sizeof *v.at);
    bool weighed = def->weight != NULL || def->weight_at != NULL;
    bool all_stick = !weighed && def->spacing <= 0 && def->clearance <= 0;
    vn_status status = all_stick ? vn_attractors_expect(a, darts) : VN_OK;
    if (room > 0 && v.at == NULL) {
        status = vn_fail_memory("darts", (size_t)room * sizeof *v.at);
    }
    for (; status == VN_OK && v.first < darts; v.first += DARTS_AT_ONCE) {
        int32_t count = (int32_t)(darts - v.first < DARTS_AT_ONCE ? darts - v.first : DARTS_AT_ONCE);
        vn_parallel_for(count, 1024, fly, &v);
        status = v.hopeless ? vn_domain_fail_dart(def->domain) : ask_weights(&v, count);
        status = status == VN_OK ? land(a, def, &v, count, accepted) : status;
    }
    vn_resize(v.at, v.at != NULL ? (size_t)room * sizeof *v.at : 0, 0);
    return status;
}

// A large throw is laid along a space-filling curve, so that what is near in the plane is near in memory: a
// step then takes half the time. Its darts have no history yet that their order could show.
static vn_status lay_along_curve(vn_attractors *a, int32_t first, const vn_box *bounds) {
    int32_t count = a->x.count - first;
    vn_keyed_array keys = {0}, scratch = {0};
    VN_ARRAY(double) old = {0};
    double size = 0;
    for (int k = 0; k < a->dim; k++) {
        size = fmax(size, bounds->max[k] - bounds->min[k]);
    }
    vn_status status = vn_array_reserve(&keys, count);
    keys.count = status == VN_OK ? count : 0;
    for (int32_t k = 0; k < keys.count; k++) {
        keys.data[k].value = first + k;
    }
    vn_points points = vn_attractors_points(a);
    status = status == VN_OK ? vn_points_sort(&points, a->dim, bounds->min, size, &keys, &scratch) : status;
    status = status == VN_OK ? vn_array_reserve(&old, count) : status;
    double *columns[3] = {a->x.data, a->y.data, a->z.data};
    for (int c = 0; status == VN_OK && c < a->dim; c++) {
        for (int32_t k = 0; k < count; k++) {
            old.data[k] = columns[c][first + k];
        }
        for (int32_t k = 0; k < count; k++) {
            columns[c][first + k] = old.data[keys.data[k].value - first];
        }
    }
    vn_point_grid_free(&a->grid);
    a->grid.cell = 0;
    vn_array_free(&old);
    vn_array_free(&keys);
    vn_array_free(&scratch);
    return status;
}

static vn_status count_darts(vn_attractors *a, const vn_throw_def *def, double measure, int64_t *darts) {
    *darts = def->count;
    if (def->density > 0) {
        double exact = def->density * measure + a->carry;
        if (!(exact < INT32_MAX)) {
            return vn_fail(VN_LIMIT,
                           "throw.density = %g makes %g darts over an area of %g: more than %d; lower it",
                           def->density, exact, measure, INT32_MAX);
        }
        *darts = (int64_t)exact;
        a->carry = exact - (double)*darts;
    }
    return VN_OK;
}

static int by_falling_arrival(const void *left, const void *right) {
    const vn_dormant *a = left, *b = right;
    if (a->arrival != b->arrival) {
        return a->arrival < b->arrival ? 1 : -1;
    }
    int by_x = (a->p[0] > b->p[0]) - (a->p[0] < b->p[0]);
    return by_x != 0 ? by_x : (a->p[1] > b->p[1]) - (a->p[1] < b->p[1]);
}

static vn_status keep_dormant(vn_attractors *a, const vn_attractors *sown, const vn_domain *domain) {
    const vn_margin *margin = domain->kind->margin;
    vn_points points = vn_attractors_points(sown);
    a->dormant.count = 0;
    for (int32_t i = 0; i < sown->x.count; i++) {
        vn_dormant dormant;
        vn_points_get(&points, i, dormant.p);
        dormant.arrival = margin->arrival(domain, dormant.p);
        if (isfinite(dormant.arrival)) {
            VN_TRY(vn_array_push(&a->dormant, dormant));
        }
        if (i % 4096 == 4095) {
            VN_TRY(vn_poll());
        }
    }
    if (a->dormant.count > 0) {
        qsort(a->dormant.data, (size_t)a->dormant.count, sizeof *a->dormant.data, by_falling_arrival);
    }
    return VN_OK;
}

// The square round the grown blade.
static vn_status square_of(vn_domain **out, const vn_box *bounds) {
    vn_box_def def = vn_box_def_default();
    double side = fmax(bounds->max[0] - bounds->min[0], bounds->max[1] - bounds->min[1]);
    for (int k = 0; k < 2; k++) {
        double middle = 0.5 * (bounds->min[k] + bounds->max[k]);
        def.min[k] = middle - 0.5 * side;
        def.max[k] = middle + 0.5 * side;
    }
    return vn_domain_box(out, &def);
}

// All darts of the grown shape's square at once, accepted among themselves (READINGS R2).
static vn_status sow(vn_attractors *a, const vn_throw_def *def) {
    vn_box bounds;
    double grown;
    def->domain->kind->margin->grown(def->domain, &bounds, &grown);
    vn_throw_def all = *def;
    all.domain = NULL;
    all.network = NULL;
    all.clearance = 0;
    all.count = 0;
    vn_attractors_def set = {.dim = 2};
    vn_attractors *sown = NULL;
    vn_status status = square_of(&all.domain, &bounds);
    status = status == VN_OK ? vn_attractors_create(&sown, &set) : status;
    if (status == VN_OK) {
        double square = vn_domain_measure(all.domain);
        all.density = def->density > 0 ? def->density : def->count / grown;
        int64_t darts;
        int32_t accepted = 0;
        status = count_darts(sown, &all, square, &darts);
        status = status == VN_OK ? throw_darts(sown, &all, darts, &accepted) : status;
    }
    // Until all of them lie in order, the set waits for no margin: a throw that failed can be made again.
    vn_domain_release(a->margin);
    a->margin = NULL;
    status = status == VN_OK ? keep_dormant(a, sown, def->domain) : status;
    if (status == VN_OK) {
        a->margin = vn_domain_retain(def->domain);
        a->margin_clearance = def->clearance;
    }
    vn_attractors_destroy(sown);
    vn_domain_release(all.domain);
    return status;
}

vn_status vn_release(vn_attractors *a, vn_network *network, int32_t *released) {
    *released = 0;
    if (a->margin == NULL) {
        return VN_OK;
    }
    if (a->margin_clearance > 0 && network == NULL) {
        return vn_fail(VN_INVALID,
                       "these attractors are to keep clear of a network: hand it over beside them");
    }
    clearing nodes;
    double length = a->margin->kind->margin->length(a->margin);
    VN_TRY(prepare_clearing(&nodes, network, a->margin_clearance));
    int32_t count = 0;
    while (a->dormant.count > 0 && a->dormant.data[a->dormant.count - 1].arrival <= length) {
        const vn_dormant *next = &a->dormant.data[a->dormant.count - 1];
        int32_t refuser;
        if (is_clear(&nodes, next->p, &refuser)) {
            VN_TRY(vn_attractors_add(a, next->p));
            count++;
        }
        a->dormant.count--;
    }
    *released = count;
    return VN_OK;
}

static vn_status check_throw(const vn_attractors *a, const vn_throw_def *def) {
    VN_TRY(vn_check_def(&vn_throw_schema, def));
    if ((def->count > 0) == (def->density > 0)) {
        return vn_fail(VN_INVALID, "throw: give how many darts either as `count` or as `density`, above 0");
    }
    if (vn_domain_dim(def->domain) != a->dim) {
        return vn_fail(VN_INVALID, "throw.domain has %d dimensions, the attractors %d",
                       vn_domain_dim(def->domain), a->dim);
    }
    if (def->weight != NULL && vn_domain_dim(def->weight) != a->dim) {
        return vn_fail(VN_INVALID, "throw.weight has %d dimensions, the attractors %d",
                       vn_domain_dim(def->weight), a->dim);
    }
    if (def->clearance > 0 && def->network == NULL) {
        return vn_fail(VN_INVALID, "throw.clearance needs throw.network: the nodes to keep clear of");
    }
    if (def->network != NULL && vn_network_dim(def->network) != a->dim) {
        return vn_fail(VN_INVALID, "throw.network has %d dimensions, the attractors %d",
                       vn_network_dim(def->network), a->dim);
    }
    return VN_OK;
}

static vn_status throw_or_release(vn_attractors *a, const vn_throw_def *def, int32_t *accepted) {
    VN_TRY(check_throw(a, def));
    if (def->domain->kind->margin != NULL) {
        if (a->margin != def->domain && a->dormant.count > 0) {
            return vn_fail(VN_INVALID,
                           "throw: %d of these attractors wait for the margin of another blade: use one set "
                           "for each blade",
                           a->dormant.count);
        }
        if (a->margin != def->domain) {
            VN_TRY(sow(a, def));
        }
        return vn_release(a, def->network, accepted);
    }
    int64_t darts;
    int32_t first = a->x.count;
    vn_box bounds = vn_domain_bounds(def->domain); // of today, where it grows
    VN_TRY(count_darts(a, def, vn_domain_measure(def->domain), &darts));
    VN_TRY(throw_darts(a, def, darts, accepted));
    if (*accepted >= 1024) {
        VN_TRY(lay_along_curve(a, first, &bounds));
    }
    return VN_OK;
}

vn_status vn_throw(vn_attractors *a, const vn_throw_def *def, int32_t *accepted) {
    *accepted = 0;
    vn_status status = throw_or_release(a, def, accepted);
    *accepted = status == VN_OK ? *accepted : 0;
    return status;
}
