#include "colonize/attractors.h"

static const vn_attractors_def attractors_default = {.dim = 2};

static const vn_field attractors_fields[] = {
    {"dim", VN_I32, 0, offsetof(vn_attractors_def, dim), 2, 3, "", NULL, "dimensions: 2 or 3"},
    {"seed", VN_I64, 0, offsetof(vn_attractors_def, seed), -9e15, 9e15, "", NULL,
     "decides which of equally near nodes an attractor influences"},
};
const vn_schema vn_attractors_schema =
    VN_SCHEMA("attractors", "An empty set of attractors", attractors_fields, attractors_default);

vn_attractors_def vn_attractors_def_default(void) {
    return attractors_default;
}

vn_status vn_attractors_create(vn_attractors **out, const vn_attractors_def *def) {
    *out = NULL;
    VN_TRY(vn_check_def(&vn_attractors_schema, def));
    vn_attractors *a = VN_NEW(vn_attractors);
    if (a == NULL) {
        return vn_fail_memory("attractors", sizeof *a);
    }
    a->dim = def->dim;
    a->seed = (uint64_t)def->seed;
    a->serial = vn_next_serial();
    a->version = 1;
    a->free_tie = -1;
    *out = a;
    return VN_OK;
}

void vn_attractors_destroy(vn_attractors *a) {
    if (a == NULL) {
        return;
    }
    vn_array_free(&a->x);
    vn_array_free(&a->y);
    vn_array_free(&a->z);
    vn_array_free(&a->near2);
    vn_array_free(&a->node);
    vn_array_free(&a->id);
    vn_array_free(&a->best);
    vn_array_free(&a->idle);
    vn_reach_tree_free(&a->tree);
    vn_array_free(&a->hits);
    vn_array_free(&a->nodes);
    vn_array_free(&a->by_node);
    vn_array_free(&a->active);
    vn_array_free(&a->activated);
    vn_array_free(&a->scratch);
    vn_array_free(&a->fresh);
    vn_array_free(&a->present);
    vn_array_free(&a->dormant);
    vn_array_free(&a->waiting);
    vn_array_free(&a->first_tie);
    vn_array_free(&a->stage);
    vn_array_free(&a->guards);
    vn_array_free(&a->farthest2);
    vn_array_free(&a->ties);
    vn_array_free(&a->touched);
    vn_array_free(&a->outdated);
    vn_array_free(&a->news);
    vn_array_free(&a->candidates);
    vn_array_free(&a->near_nodes);
    vn_array_free(&a->refusers);
    vn_cover_free(&a->cover);
    vn_array_free(&a->sleep);
    vn_point_grid_free(&a->grid);
    vn_domain_release(a->last.domain);
    vn_domain_release(a->sight);
    vn_domain_release(a->margin);
    VN_DELETE(a);
}

static vn_status reserve(vn_attractors *a, int64_t need) {
    VN_TRY(vn_array_reserve(&a->x, need));
    VN_TRY(vn_array_reserve(&a->y, need));
    if (a->dim == 3) {
        VN_TRY(vn_array_reserve(&a->z, need));
    }
    VN_TRY(vn_array_reserve(&a->near2, need));
    VN_TRY(vn_array_reserve(&a->node, need));
    VN_TRY(vn_array_reserve(&a->id, need));
    VN_TRY(vn_array_reserve(&a->best, need));
    return vn_array_reserve(&a->idle, need);
}

static void set_count(vn_attractors *a, int32_t count) {
    a->x.count = a->y.count = a->near2.count = a->node.count = count;
    a->id.count = a->best.count = a->idle.count = count;
    a->z.count = a->dim == 3 ? count : 0;
}

vn_status vn_attractors_expect(vn_attractors *a, int64_t more) {
    return reserve(a, a->x.count + more);
}

static void trim(vn_attractors *a) {
    vn_array_trim(&a->x);
    vn_array_trim(&a->y);
    vn_array_trim(&a->z);
    vn_array_trim(&a->near2);
    vn_array_trim(&a->node);
    vn_array_trim(&a->id);
    vn_array_trim(&a->best);
    vn_array_trim(&a->idle);
    vn_array_trim(&a->active);
}

vn_status vn_attractors_add(vn_attractors *a, const double p[3]) {
    if (!vn_finite(p)) {
        return vn_fail(VN_INVALID, "an attractor at (%g, %g, %g) is not finite", p[0], p[1], p[2]);
    }
    int32_t i = a->x.count;
    VN_TRY(reserve(a, (int64_t)i + 1));
    set_count(a, i + 1);
    a->x.data[i] = p[0];
    a->y.data[i] = p[1];
    if (a->dim == 3) {
        a->z.data[i] = p[2];
    }
    a->near2.data[i] = INFINITY;
    a->node.data[i] = -1;
    a->id.data[i] = a->born++;
    a->best.data[i] = INFINITY;
    a->idle.data[i] = 0;
    a->version++;
    return VN_OK;
}

int vn_attractors_dim(const vn_attractors *a) {
    return a->dim;
}

int32_t vn_attractors_count(const vn_attractors *a) {
    return a->x.count - a->gone;
}

vn_retired vn_attractors_retired(const vn_attractors *a) {
    return a->retired;
}

int32_t vn_attractors_dormant(const vn_attractors *a) {
    return a->dormant.count;
}

void vn_attractors_remove(vn_attractors *a, int32_t i) {
    a->near2.data[i] = -1;
    a->node.data[i] = -1;
    vn_ties_drop(a, i);
    a->gone++;
    a->version++;
}

static void move_attractor(vn_attractors *a, int32_t from, int32_t to) {
    a->x.data[to] = a->x.data[from];
    a->y.data[to] = a->y.data[from];
    if (a->dim == 3) {
        a->z.data[to] = a->z.data[from];
    }
    a->near2.data[to] = a->near2.data[from];
    a->node.data[to] = a->node.data[from];
    a->id.data[to] = a->id.data[from];
    a->best.data[to] = a->best.data[from];
    a->idle.data[to] = a->idle.data[from];
    if (to < a->sleep.count) {
        a->sleep.data[to] = from < a->sleep.count ? a->sleep.data[from] : (vn_sleep){.node = -1};
    }
    vn_ties_move(a, from, to);
}

// Everything that is listed by number is made again: the active ones at once, the rest when it is next
// asked for.
vn_status vn_attractors_tidy(vn_attractors *a) {
    if (a->gone <= a->x.count / 2 + 32) {
        return VN_OK;
    }
    int32_t kept = 0, seen = 0;
    VN_TRY(vn_array_reserve(&a->active, a->x.count - a->gone));
    a->active.count = 0;
    a->waiting.count = 0;
    a->activated.count = 0;
    a->touched.count = 0;
    a->fresh_all = a->fresh_all || a->fresh.count > 0;
    a->fresh.count = 0;
    for (int32_t i = 0; i < a->x.count; i++) {
        if (vn_is_gone(a, i)) {
            continue;
        }
        move_attractor(a, i, kept);
        seen += i < a->attractors_seen;
        if (a->node.data[kept] >= 0) {
            a->active.data[a->active.count++] = kept;
        } else if (a->idle.data[kept] & VN_HIDDEN) {
            a->waiting.data[a->waiting.count++] = kept;
        }
        if (kept < a->stage.count && (a->stage.data[kept] & VN_TOUCHED)) {
            a->touched.data[a->touched.count++] = kept; // no more of them than there were
        }
        kept++;
    }
    a->sleep.count = kept < a->sleep.count ? kept : a->sleep.count;
    set_count(a, kept);
    a->stage.count = kept < a->stage.count ? kept : a->stage.count;
    a->first_tie.count = a->guards.count = a->farthest2.count = a->stage.count;
    a->gone = 0;
    a->attractors_seen = seen;
    a->tree_count = 0;
    vn_reach_tree_free(&a->tree);
    vn_point_grid_free(&a->grid);
    a->grid.cell = 0;
    a->version++;
    trim(a);
    return VN_OK;
}

vn_status vn_attractors_grid(vn_attractors *a, double reach) {
    bool outgrown = a->born - a->grid_born > (uint32_t)a->x.count / 4 + 64;
    if (!vn_point_grid_fits(&a->grid, reach, outgrown)) {
        vn_point_grid_free(&a->grid);
        vn_point_grid_init(&a->grid, a->dim, reach);
        a->grid_born = a->born;
    }
    vn_points points = vn_attractors_points(a);
    return vn_point_grid_update(&a->grid, &points, a->x.count);
}

static vn_status list_present(vn_attractors *a) {
    if (a->present_version == a->version) {
        return VN_OK;
    }
    VN_TRY(vn_array_reserve(&a->present, a->x.count - a->gone));
    a->present.count = 0;
    for (int32_t i = 0; i < a->x.count; i++) {
        if (!vn_is_gone(a, i)) {
            a->present.data[a->present.count++] = i;
        }
    }
    a->present_version = a->version;
    return VN_OK;
}

vn_status vn_attractors_number(vn_attractors *a, int32_t index, int32_t *internal) {
    *internal = -1;
    if (index < 0 || index >= a->x.count - a->gone) {
        return vn_fail(VN_INVALID, "an attractor must be one of the %d there are", a->x.count - a->gone);
    }
    if (a->gone == 0) {
        *internal = index;
        return VN_OK;
    }
    VN_TRY(list_present(a));
    *internal = a->present.data[index];
    return VN_OK;
}

int32_t vn_attractors_public(vn_attractors *a, int32_t internal) {
    if (a->gone == 0) {
        return internal;
    }
    if (list_present(a) != VN_OK) {
        return -1;
    }
    int32_t low = 0, high = a->present.count;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (a->present.data[middle] < internal) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < a->present.count && a->present.data[low] == internal ? low : -1;
}

vn_status vn_attractors_position(vn_attractors *a, int32_t index, double p[3]) {
    int32_t i;
    VN_TRY(vn_attractors_number(a, index, &i));
    vn_attractors_place(a, i, p);
    return VN_OK;
}
