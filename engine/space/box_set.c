#include "space/box_set.h"

void vn_box_set_free(vn_box_set *set) {
    vn_resize(set->bits, set->room * sizeof *set->bits, 0);
    *set = (vn_box_set){0};
}

vn_status vn_box_set_clear(vn_box_set *set, int dim, int64_t side) {
    int64_t boxes = side * side * (dim == 3 ? side : 1);
    size_t words = ((size_t)boxes + 63) / 64;
    if (words > set->room) {
        uint64_t *bits = vn_resize(set->bits, set->room * sizeof *bits, words * sizeof *bits);
        if (bits == NULL) {
            return vn_fail_memory("a grid of boxes", words * sizeof *bits);
        }
        set->bits = bits;
        set->room = words;
    }
    set->dim = dim;
    set->side = side;
    set->words = words;
    memset(set->bits, 0, words * sizeof *set->bits);
    return VN_OK;
}

static int64_t number_of(const vn_box_set *set, const int64_t box[3]) {
    return (box[2] * set->side + box[1]) * set->side + box[0];
}

static void take(vn_box_set *set, const int64_t box[3]) {
    int64_t number = number_of(set, box);
    set->bits[number / 64] |= UINT64_C(1) << number % 64;
}

bool vn_box_set_has(const vn_box_set *set, const int64_t box[3]) {
    int64_t number = number_of(set, box);
    return set->bits[number / 64] >> number % 64 & 1;
}

/// How far a line is on its way through the grid. Along axis k it is next to pass a face after way[k] /
/// size[k] of the whole, and passes `left` more.
typedef struct walk {
    int64_t box[3];
    int64_t way[3], size[3], left[3];
    int sign[3];
} walk;

// A rising line enters a box on the face between the two, a falling one leaves it there.
static void begin_axis(walk *w, int k, int64_t a, int64_t b) {
    int64_t last = b / VN_BOX_PARTS;
    w->box[k] = a / VN_BOX_PARTS;
    w->sign[k] = b < a ? -1 : 1;
    w->size[k] = b < a ? a - b : b - a;
    w->left[k] = last < w->box[k] ? w->box[k] - last : last - w->box[k];
    w->way[k] = b < a ? a - w->box[k] * VN_BOX_PARTS : (w->box[k] + 1) * VN_BOX_PARTS - a;
}

// Whether axis @p i passes its next face before axis @p j; both have one left. Fractions are compared by
// products, which stay below 2^63.
static bool is_before(const walk *w, int i, int j) {
    return w->way[i] * w->size[j] < w->way[j] * w->size[i];
}

static bool is_together(const walk *w, int i, int j) {
    return w->way[i] * w->size[j] == w->way[j] * w->size[i];
}

// The axis that passes a face first, at an equal place a rising one: there it is in the box ahead already
// while a falling one is in its own still. -1 at the end of the way.
static int next_axis(const walk *w) {
    int next = -1;
    for (int k = 0; k < 3; k++) {
        if (w->left[k] > 0 &&
            (next < 0 || is_before(w, k, next) || (is_together(w, k, next) && w->sign[k] > w->sign[next]))) {
            next = k;
        }
    }
    return next;
}

// All that pass a face at the same place in the same sense do it at once: no box lies between.
static void step(walk *w, int axis) {
    bool passes[3];
    for (int k = 0; k < 3; k++) {
        passes[k] = w->left[k] > 0 && w->sign[k] == w->sign[axis] && is_together(w, k, axis);
    }
    for (int k = 0; k < 3; k++) {
        if (passes[k]) {
            w->box[k] += w->sign[k];
            w->way[k] += VN_BOX_PARTS;
            w->left[k]--;
        }
    }
}

void vn_box_set_add(vn_box_set *set, const int64_t a[3], const int64_t b[3]) {
    walk w = {.box = {0}};
    for (int k = 0; k < set->dim; k++) {
        begin_axis(&w, k, a[k], b[k]);
    }
    take(set, w.box);
    for (int axis = next_axis(&w); axis >= 0; axis = next_axis(&w)) {
        step(&w, axis);
        take(set, w.box);
    }
}

static int ones(uint64_t word) {
    return __builtin_popcountll(word);
}

int64_t vn_box_set_count(const vn_box_set *set) {
    int64_t count = 0;
    for (size_t i = 0; i < set->words; i++) {
        count += ones(set->bits[i]);
    }
    return count;
}

static void take_parent(vn_box_set *out, const vn_box_set *set, int64_t number) {
    int64_t row = number / set->side;
    int64_t box[3] = {number % set->side / 2, row % set->side / 2, row / set->side / 2};
    take(out, box);
}

vn_status vn_box_set_double(vn_box_set *out, const vn_box_set *set) {
    VN_TRY(vn_box_set_clear(out, set->dim, set->side / 2));
    for (size_t i = 0; i < set->words; i++) {
        for (uint64_t word = set->bits[i]; word != 0; word &= word - 1) {
            take_parent(out, set, (int64_t)i * 64 + __builtin_ctzll(word));
        }
    }
    return VN_OK;
}
