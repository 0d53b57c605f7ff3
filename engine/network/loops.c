// The hierarchical loop decomposition: a minimal spanning tree of the areoles, neighbours across thin veins
// first (Kruskal 1956).

#include "network/leaf.h"

// A set of areoles that were merged, and the tree of merges in it.
typedef struct loop_set {
    int32_t above; // another areole of the set, or itself
    int32_t tree;  // an areole, or areoles + a merge
    int32_t loops, height, strahler;
} loop_set;

typedef struct decomposition {
    const vn_faces *faces;
    vn_loop_hierarchy *out;
    VN_ARRAY(loop_set) sets;
    vn_keyed_array veins, scratch;
    double weight;
} decomposition;

static int32_t find_set(loop_set *sets, int32_t areole) {
    while (sets[areole].above != areole) {
        sets[areole].above = sets[sets[areole].above].above;
        areole = sets[areole].above;
    }
    return areole;
}

static vn_status list_veins(decomposition *d) {
    for (int32_t e = 0; e < vn_faces_edges(d->faces); e++) {
        int32_t left = vn_faces_left(d->faces, 2 * e), right = vn_faces_left(d->faces, 2 * e + 1);
        if (left >= 0 && right >= 0 && left != right) {
            vn_keyed vein = {vn_sortable(d->faces->radius.data[e]), e};
            VN_TRY(vn_array_push(&d->veins, vein));
        }
    }
    return vn_sort_keyed(&d->veins, &d->scratch);
}

static void weigh(decomposition *d, double r, double s) {
    double weight = r + s - 1;
    d->weight += weight;
    d->out->asymmetry += r + s > 2 ? weight * fabs(r - s) / (r + s - 2) : 0;
    d->out->nesting += weight * fmin(r, s) / fmax(r, s);
}

static void merge(decomposition *d, loop_set *a, loop_set *b, double radius) {
    vn_loop_hierarchy *out = d->out;
    weigh(d, a->loops, b->loops);
    out->merges[out->merge_count] = (vn_loop_merge){a->tree, b->tree, a->loops + b->loops, radius};
    int32_t higher = a->strahler > b->strahler ? a->strahler : b->strahler;
    a->tree = d->sets.count + out->merge_count++;
    a->loops += b->loops;
    a->height = 1 + (a->height > b->height ? a->height : b->height);
    a->strahler = a->strahler == b->strahler ? higher + 1 : higher;
    b->above = a->above;
    out->height = a->height > out->height ? a->height : out->height;
    out->strahler = a->strahler > out->strahler ? a->strahler : out->strahler;
}

static vn_status decompose(decomposition *d) {
    int32_t areoles = d->faces->area.count;
    VN_TRY(vn_array_zero(&d->sets, areoles));
    VN_TRY(list_veins(d));
    d->out->merges = vn_new_block((size_t)areoles * sizeof *d->out->merges);
    if (d->out->merges == NULL) {
        return vn_fail_memory("merges of loops", (size_t)areoles * sizeof *d->out->merges);
    }
    for (int32_t i = 0; i < areoles; i++) {
        d->sets.data[i] = (loop_set){i, i, 1, 0, 1};
    }
    d->out->strahler = 1;
    for (int32_t i = 0; i < d->veins.count; i++) {
        int32_t e = d->veins.data[i].value;
        int32_t a = find_set(d->sets.data, vn_faces_left(d->faces, 2 * e));
        int32_t b = find_set(d->sets.data, vn_faces_left(d->faces, 2 * e + 1));
        if (a != b) {
            merge(d, &d->sets.data[a < b ? a : b], &d->sets.data[a < b ? b : a], d->faces->radius.data[e]);
        }
    }
    return VN_OK;
}

vn_status vn_loops_decompose(vn_loop_hierarchy *out, const vn_faces *faces) {
    *out = (vn_loop_hierarchy){0};
    if (!vn_network_has_radii(faces->network) || faces->area.count == 0) {
        return VN_OK;
    }
    decomposition d = {.faces = faces, .out = out};
    vn_status status = decompose(&d);
    out->asymmetry = d.weight > 0 ? out->asymmetry / d.weight : 0;
    out->nesting = d.weight > 0 ? out->nesting / d.weight : 0;
    vn_array_free(&d.sets);
    vn_array_free(&d.veins);
    vn_array_free(&d.scratch);
    return status;
}
