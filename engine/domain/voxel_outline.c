// The sides between foreground and background, walked with the foreground on the left (where j goes up).

#include "domain/voxel_parts.h"

typedef struct tracing {
    const vn_voxel_bits *bits;
    uint64_t *walked; ///< a bit for the lower side of each pixel
    size_t words;
    const double *origin;
    double (*step)[2];
    vn_rings *out;
} tracing;

static bool is_inside(const tracing *t, int32_t i, int32_t j) {
    return i >= 0 && j >= 0 && i < t->bits->size[0] && j < t->bits->size[1] &&
           vn_voxel_is_set(t->bits, i, j, 0);
}

static uint64_t *walked_word(const tracing *t, int32_t i, int32_t j, uint64_t *bit) {
    size_t side = (size_t)i + (size_t)t->bits->size[0] * (size_t)j;
    *bit = (uint64_t)1 << side % 64;
    return &t->walked[side / 64];
}

static vn_status push_corner(tracing *t, int32_t i, int32_t j) {
    return vn_rings_point(t->out, t->origin[0] + i * t->step[0][0] + j * t->step[1][0],
                          t->origin[1] + i * t->step[0][1] + j * t->step[1][1]);
}

// Of the pixels ahead: around the one on the left first, so that pixels which touch at a corner stay apart.
static int next_direction(const tracing *t, const int32_t at[2], int direction) {
    static const int32_t left[4][2] = {{0, 0}, {-1, 0}, {-1, -1}, {0, -1}};
    const int32_t *l = left[direction], *r = left[(direction + 3) % 4];
    if (!is_inside(t, at[0] + l[0], at[1] + l[1])) {
        return (direction + 1) % 4;
    }
    return is_inside(t, at[0] + r[0], at[1] + r[1]) ? (direction + 3) % 4 : direction;
}

static void reverse_from(vn_rings *rings, int32_t begin) {
    for (int32_t a = begin, b = rings->x.count - 1; a < b; a++, b--) {
        double x = rings->x.data[a], y = rings->y.data[a];
        rings->x.data[a] = rings->x.data[b];
        rings->y.data[a] = rings->y.data[b];
        rings->x.data[b] = x;
        rings->y.data[b] = y;
    }
}

// Along the lower side of pixel (i, j) and on, until that side comes again.
static vn_status walk_ring(tracing *t, int32_t i, int32_t j) {
    static const int32_t ahead[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    int32_t begin = t->out->x.count, at[2] = {i, j};
    int direction = 0;
    do {
        uint64_t bit;
        if (direction == 0) {
            uint64_t *word = walked_word(t, at[0], at[1], &bit);
            *word |= bit;
        }
        at[0] += ahead[direction][0];
        at[1] += ahead[direction][1];
        int next = next_direction(t, at, direction);
        if (next != direction) {
            VN_TRY(push_corner(t, at[0], at[1]));
        }
        direction = next;
    } while (at[0] != i || at[1] != j || direction != 0);
    if (t->step[0][0] * t->step[1][1] < t->step[0][1] * t->step[1][0]) {
        reverse_from(t->out, begin);
    }
    return vn_rings_close(t->out);
}

static vn_status walk_all(tracing *t) {
    for (int32_t j = 0; j < t->bits->size[1]; j++) {
        VN_TRY(vn_poll());
        for (int32_t i = 0; i < t->bits->size[0]; i++) {
            uint64_t bit;
            bool border = is_inside(t, i, j) && !is_inside(t, i, j - 1);
            if (border && !(*walked_word(t, i, j, &bit) & bit)) {
                VN_TRY(walk_ring(t, i, j));
            }
        }
    }
    return VN_OK;
}

vn_status vn_voxel_outline(const vn_voxel_bits *bits, const double origin[2], double step[2][2],
                           vn_rings *out) {
    tracing t = {.bits = bits, .origin = origin, .step = step, .out = out};
    t.words = ((size_t)bits->size[0] * (size_t)bits->size[1] - 1) / 64 + 1;
    t.walked = vn_new_block(t.words * sizeof *t.walked);
    if (t.walked == NULL) {
        return vn_fail_memory("an outline", t.words * sizeof *t.walked);
    }
    vn_status status = walk_all(&t);
    vn_resize(t.walked, t.words * sizeof *t.walked, 0);
    return status;
}
