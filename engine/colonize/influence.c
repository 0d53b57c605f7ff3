#include "colonize/attractors.h"

static const vn_influence_def influence_default = {.perception = {.lateral = true}};

static const vn_field influence_fields[] = {
    {"mode", VN_CHOICE, 0, offsetof(vn_influence_def, mode), 0, 0, "", "nearest|relative|urquhart",
     "which nodes an attractor influences: the nearest one (open venation, Runions §3), its relative "
     "neighbors (closed venation, §4), or the Urquhart approximation of these (§5.2)"},
    {"within", VN_F64, VN_ABOVE_MIN | VN_OPTIONAL, offsetof(vn_influence_def, within), 0, VN_HUGE, "length",
     NULL, "attraction distance: nodes farther away are not influenced; left out: any distance"},
    {"perception", VN_MIXED, 0, offsetof(vn_influence_def, perception), 0, 0, "", "table {angle=, lateral=}",
     "what the nodes of a vessel perceive (Rauch & Harders, Equations 2 and 3); left out: they look all "
     "around"},
};
const vn_schema vn_influence_schema =
    VN_SCHEMA("influence", "Which attractors influence which nodes", influence_fields, influence_default);

vn_influence_def vn_influence_def_default(void) {
    return influence_default;
}

// Drop what is gone, and what is listed as newly active although it is in the list: an attractor that lost
// its node and got another one within the same step.
static int32_t drop_idle(vn_attractors *a) {
    int32_t kept = 0;
    for (int32_t k = 0; k < a->active.count; k++) {
        int32_t i = a->active.data[k];
        if (a->node.data[i] >= 0) {
            a->active.data[kept++] = i;
        }
    }
    a->active.count = kept;
    int32_t fresh = 0, at = 0;
    for (int32_t k = 0; k < a->activated.count; k++) {
        vn_keyed one = a->activated.data[k];
        while (at < kept && a->active.data[at] < one.value) {
            at++;
        }
        bool listed = at < kept && a->active.data[at] == one.value;
        bool twice = fresh > 0 && a->activated.data[fresh - 1].value == one.value;
        if (!listed && !twice && a->node.data[one.value] >= 0) {
            a->activated.data[fresh++] = one;
        }
    }
    return fresh;
}

// Merge what became active since into the ascending list.
static vn_status renew_active(vn_attractors *a) {
    VN_TRY(vn_sort_keyed(&a->activated, &a->scratch));
    VN_TRY(vn_array_reserve(&a->active, (int64_t)a->active.count + a->activated.count));
    int32_t fresh = drop_idle(a);
    int32_t from = a->active.count - 1;
    int32_t to = a->active.count + fresh - 1;
    for (int32_t k = fresh - 1; k >= 0; k--) {
        int32_t i = a->activated.data[k].value;
        for (; from >= 0 && a->active.data[from] > i; from--) {
            a->active.data[to--] = a->active.data[from];
        }
        a->active.data[to--] = i;
    }
    a->active.count += fresh;
    a->activated.count = 0;
    return VN_OK;
}

static vn_status push_pair(vn_influence *influence, int32_t attractor, int32_t node) {
    VN_TRY(vn_array_push(&influence->attractor, attractor));
    return vn_array_push(&influence->node, node);
}

static vn_status push_to(void *influence, int32_t attractor, int32_t node) {
    return push_pair(influence, attractor, node);
}

// A touched attractor draws only the veins that it waits for.
static bool draws(const vn_attractors *a, int32_t i, const vn_tie *tie) {
    bool tagged = (a->stage.data[i] & VN_TOUCHED) && a->tagging;
    unsigned bits = tie->state & (VN_TAGGED | VN_REACHED | VN_LEFT);
    return !tagged || bits == VN_TAGGED;
}

static vn_status list_ties(vn_influence *influence, int32_t i, double within2) {
    vn_attractors *a = influence->attractors;
    int32_t begin = influence->node.count;
    vn_ties_drop_ghosts(a, influence->network, i);
    for (int32_t tie = a->first_tie.data[i]; tie >= 0; tie = a->ties.data[tie].next) {
        int32_t node = a->ties.data[tie].node;
        double d2 = vn_attractors_distance2(a, influence->network, i, node);
        if (draws(a, i, &a->ties.data[tie]) && d2 <= within2) {
            VN_TRY(push_pair(influence, i, node));
            int32_t at = influence->node.count - 1;
            for (; at > begin && influence->node.data[at - 1] > node; at--) {
                influence->node.data[at] = influence->node.data[at - 1];
            }
            influence->node.data[at] = node;
        }
    }
    return VN_OK;
}

static vn_status list_pairs(vn_influence *influence, double within) {
    vn_attractors *a = influence->attractors;
    double within2 = within * within;
    VN_TRY(vn_array_reserve(&influence->attractor, a->active.count));
    VN_TRY(vn_array_reserve(&influence->node, a->active.count));
    for (int32_t k = 0; k < a->active.count; k++) {
        int32_t i = a->active.data[k];
        if (a->node.data[i] < 0) {
            continue;
        }
        if (a->mode != VN_NEAREST) {
            VN_TRY(list_ties(influence, i, within2));
        } else if (a->near2.data[i] <= within2) {
            VN_TRY(push_pair(influence, i, a->node.data[i]));
        }
    }
    return VN_OK;
}

// Other options change what each attractor has to remember.
static vn_status open_gaze(vn_attractors *a, const vn_network *network, const vn_perception *perception) {
    bool open = vn_gaze_is_open(&a->gaze), lateral = a->gaze.perception.lateral, changed;
    VN_TRY(vn_gaze_prepare(&a->gaze, network, perception, &changed));
    if (open != vn_gaze_is_open(&a->gaze) || (open && lateral != perception->lateral)) {
        vn_attractors_forget(a);
    }
    if (vn_gaze_is_open(&a->gaze) && (changed || a->network_serial != network->serial)) {
        a->version++; // what was found with other eyes, or for another network, is out of date
    }
    a->sleep.count = changed || a->turned != network->turned ? 0 : a->sleep.count;
    a->turned = network->turned;
    if (vn_gaze_is_open(&a->gaze) && (network->recount || network->pending.count > 0)) {
        vn_network_settle(network);
    }
    return VN_OK;
}

static vn_status find(vn_influence *influence, vn_attractors *a, vn_network *network,
                      const vn_influence_def *def) {
    double within = def->within > 0 ? def->within : INFINITY;
    influence->attractor.count = influence->node.count = 0;
    influence->attractors = a;
    influence->network = network;
    influence->attractors_version = 0; // no set has it: not current until all is found
    VN_TRY(vn_poll());
    VN_TRY(vn_attractors_tidy(a));
    VN_TRY(open_gaze(a, network, &def->perception));
    VN_TRY(vn_attractors_sync(a, network, def->mode, within));
    VN_TRY(renew_active(a));
    VN_TRY(vn_gaze_is_open(&a->gaze) ? vn_attractors_turn(a, network, within, push_to, influence)
                                     : list_pairs(influence, within));
    influence->attractors_version = a->version;
    influence->network_version = network->version;
    influence->network_serial = network->serial;
    return VN_OK;
}

vn_status vn_influence_find(vn_influence **out, vn_attractors *attractors, vn_network *network,
                            const vn_influence_def *def) {
    VN_TRY(vn_check_def(&vn_influence_schema, def));
    if (def->perception.angle > 0 && def->mode != VN_NEAREST) {
        return vn_fail(VN_INVALID, "influence.perception goes with mode = \"nearest\" alone");
    }
    bool made = *out == NULL;
    if (made) {
        *out = VN_NEW(vn_influence);
        if (*out == NULL) {
            return vn_fail_memory("an influence", sizeof **out);
        }
    }
    vn_status status = find(*out, attractors, network, def);
    if (status != VN_OK && made) {
        vn_influence_destroy(*out);
        *out = NULL;
    }
    return status;
}

void vn_influence_destroy(vn_influence *influence) {
    if (influence != NULL) {
        vn_array_free(&influence->attractor);
        vn_array_free(&influence->node);
        VN_DELETE(influence);
    }
}

size_t vn_influence_bytes(const vn_influence *influence) {
    int64_t pairs = (int64_t)influence->attractor.capacity + influence->node.capacity;
    return sizeof *influence + (size_t)pairs * sizeof(int32_t);
}

int32_t vn_influence_count(const vn_influence *influence) {
    return influence->attractor.count;
}

int32_t vn_influence_attractor(const vn_influence *influence, int32_t pair) {
    bool current = vn_influence_current(influence);
    return current ? vn_attractors_public(influence->attractors, influence->attractor.data[pair]) : -1;
}

int32_t vn_influence_node(const vn_influence *influence, int32_t pair) {
    return influence->node.data[pair];
}

bool vn_influence_current(const vn_influence *influence) {
    return influence->attractors_version == influence->attractors->version &&
           influence->network_version == influence->network->version;
}
