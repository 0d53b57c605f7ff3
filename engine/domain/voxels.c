// A mask of voxels as a domain: the union of the boxes of its foreground. All is answered in the grid's own
// axes, where voxel (i, j, k) is the box from there to (i + 1, j + 1, k + 1), and the axes are at right
// angles.

#include "domain/voxels.h"

#include "domain/domain.h"
#include "domain/voxel_corners.h"
#include "domain/voxel_tree.h"

#include <stdio.h>
#include <stdlib.h>

typedef struct voxels {
    vn_domain base;
    vn_voxel_bits bits;
    double origin[3];  ///< corner (0, 0, 0) of the grid
    double axis[3][3]; ///< unit vectors along the grid's axes
    double side[3];    ///< of a voxel
    vn_voxel_tree tree;
    vn_voxel_corners corners;
    VN_ARRAY(int32_t) set_up_to; ///< foreground voxels in each word of `bits`, with all before it
    vn_volume volume;            ///< without data where all values inside are equal
    double gain, offset;         ///< a voxel's value is gain times it, plus offset
} voxels;

static const voxels *voxels_of(const vn_domain *domain) {
    return (const voxels *)domain;
}

// ---- Places ----

static void to_grid(const voxels *v, const double p[3], double u[3]) {
    for (int a = 0; a < 3; a++) {
        u[a] = 0;
        for (int r = 0; r < v->base.dim; r++) {
            u[a] += v->axis[a][r] * (p[r] - v->origin[r]);
        }
        u[a] /= v->side[a];
    }
    if (v->base.dim == 2) {
        u[2] = 0.5;
    }
}

static void to_world(const voxels *v, const double u[3], double p[3]) {
    int dim = v->base.dim == 2 ? 2 : 3;
    for (int r = 0; r < dim; r++) {
        p[r] = v->origin[r];
        for (int a = 0; a < dim; a++) {
            p[r] += v->axis[a][r] * (u[a] * v->side[a]);
        }
    }
}

// False where there is none.
static bool cell_of(const voxels *v, const double u[3], int32_t cell[3]) {
    for (int a = 0; a < 3; a++) {
        if (!(u[a] >= 0 && u[a] < v->bits.size[a])) {
            return false;
        }
        cell[a] = (int32_t)u[a];
    }
    return true;
}

static size_t index_of(const voxels *v, const int32_t cell[3]) {
    size_t row = (size_t)cell[1] + (size_t)v->bits.size[1] * (size_t)cell[2];
    return (size_t)cell[0] + (size_t)v->bits.size[0] * row;
}

static bool is_set(const voxels *v, const int32_t cell[3]) {
    return vn_voxel_is_set(&v->bits, cell[0], cell[1], cell[2]);
}

static bool cell_inside(const voxels *v, const double p[3], int32_t cell[3]) {
    double u[3];
    to_grid(v, p, u);
    return cell_of(v, u, cell) && is_set(v, cell);
}

// ---- What a domain answers ----

static bool voxels_contains(const vn_domain *domain, const double p[3]) {
    int32_t cell[3];
    return cell_inside(voxels_of(domain), p, cell);
}

// The grid's own border, beyond which nothing is inside: its nearest point to a point in it, where that is
// nearer than what there is.
static void look_at_walls(const voxels *v, vn_voxel_query *query, double near[3]) {
    const double *u = query->u;
    for (int a = 0; a < v->base.dim; a++) {
        double below = u[a], above = v->bits.size[a] - u[a];
        double gap = v->side[a] * fmin(below, above);
        if (gap * gap < query->best) {
            query->best = gap * gap;
            memcpy(near, u, 3 * sizeof *near);
            near[a] = below < above ? 0 : v->bits.size[a];
        }
    }
}

// The corners of a voxel are exact, and what they know leaves little to search for between them.
static void find_in_grid(const voxels *v, const int32_t cell[3], vn_voxel_query *query, double near[3]) {
    vn_voxel_ring ring;
    vn_voxel_corners_ask(&v->corners, query->u, v->side, &ring);
    query->best = ring.best;
    for (int a = 0; a < v->base.dim; a++) {
        near[a] = ring.at[a];
    }
    if (is_set(v, cell)) {
        query->what = VN_BACKGROUND;
        look_at_walls(v, query, near);
    }
    vn_voxel_corners_bound(&v->corners, &ring, query->u, v->side, query->best, query->low, query->high);
}

static double nearest_border(const voxels *v, const double u[3], double near[3]) {
    vn_voxel_query query = {.what = VN_FOREGROUND, .u = u, .scale = v->side, .best = INFINITY};
    int32_t cell[3];
    memcpy(near, u, 3 * sizeof *near);
    if (cell_of(v, u, cell)) {
        find_in_grid(v, cell, &query, near);
    } else {
        for (int a = 0; a < 3; a++) {
            query.high[a] = v->bits.size[a];
        }
    }
    vn_voxel_tree_nearest(&v->tree, &query);
    for (int a = 0; a < 3 && query.found; a++) {
        near[a] = fmin(fmax(u[a], query.cell[a]), query.cell[a] + 1.0);
    }
    return sqrt(query.best);
}

static double voxels_closest(const vn_domain *domain, const double p[3], double q[3]) {
    const voxels *v = voxels_of(domain);
    double u[3], near[3];
    to_grid(v, p, u);
    double distance = nearest_border(v, u, near);
    memcpy(q, p, 3 * sizeof *q);
    to_world(v, near, q);
    return distance;
}

static double voxels_value(const vn_domain *domain, const double p[3]) {
    const voxels *v = voxels_of(domain);
    int32_t cell[3];
    if (!cell_inside(v, p, cell)) {
        return 0;
    }
    if (v->volume.data == NULL) {
        return v->offset;
    }
    return fmin(fmax(v->gain * vn_volume_at(&v->volume, index_of(v, cell)) + v->offset, 0), 1);
}

static int32_t word_of_rank(const voxels *v, int32_t rank) {
    int32_t low = 0, high = v->set_up_to.count - 1;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (v->set_up_to.data[middle] > rank) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    return low;
}

static vn_status voxels_dart(const vn_domain *domain, vn_rng *rng, double p[3]) {
    const voxels *v = voxels_of(domain);
    const int32_t *blocks = v->bits.blocks;
    int32_t rank = (int32_t)vn_rng_integer(rng, 0, v->set_up_to.data[v->set_up_to.count - 1] - 1);
    int32_t number = word_of_rank(v, rank);
    uint64_t word = v->bits.words[number];
    for (int32_t skip = rank - (number > 0 ? v->set_up_to.data[number - 1] : 0); skip > 0; skip--) {
        word &= word - 1;
    }
    int bit = __builtin_ctzll(word);
    int32_t row = number / blocks[0], layer = row / blocks[1];
    double u[3] = {4.0 * (number - row * blocks[0]) + (bit & 3),
                   4.0 * (row - layer * blocks[1]) + (bit >> 2 & 3), 4.0 * layer + (bit >> 4)};
    for (int a = 0; a < (domain->dim == 2 ? 2 : 3); a++) {
        u[a] += vn_rng_uniform(rng, 0, 1);
    }
    p[2] = 0;
    to_world(v, u, p);
    return VN_OK;
}

static vn_status voxels_outline(const vn_domain *domain, int32_t sides, vn_rings *out) {
    (void)sides;
    const voxels *v = voxels_of(domain);
    double step[2][2];
    for (int a = 0; a < 2; a++) {
        for (int r = 0; r < 2; r++) {
            step[a][r] = v->axis[a][r] * v->side[a];
        }
    }
    return vn_voxel_outline(&v->bits, v->origin, step, out);
}

// ---- Sight: from voxel to voxel along the line ----

typedef struct line {
    const double *from, *to;
    int32_t cell[3], left[3]; ///< where it is, and how many steps it has to make along each axis
    int32_t step[3];
} line;

// How much of the line is done where it passes into its next voxel along an axis.
static double next_crossing(const line *l, int a) {
    if (l->left[a] == 0) {
        return INFINITY;
    }
    double wall = l->cell[a] + (l->step[a] > 0 ? 1.0 : 0.0);
    return (wall - l->from[a]) / (l->to[a] - l->from[a]);
}

// A line through an edge or a corner of voxels touches all that meet there: all must be inside.
static bool pass(const voxels *v, line *l, unsigned axes) {
    for (unsigned some = 1; some <= axes; some++) {
        int32_t cell[3];
        if ((some & axes) != some) {
            continue;
        }
        for (int a = 0; a < 3; a++) {
            cell[a] = l->cell[a] + (some >> a & 1 ? l->step[a] : 0);
        }
        if (!is_set(v, cell)) {
            return false;
        }
    }
    for (int a = 0; a < 3; a++) {
        if (axes >> a & 1) {
            l->cell[a] += l->step[a];
            l->left[a]--;
        }
    }
    return true;
}

static bool voxels_sees(const vn_domain *domain, const double a[3], const double b[3]) {
    const voxels *v = voxels_of(domain);
    double from[3], to[3];
    int32_t end[3];
    line l = {.from = from, .to = to};
    to_grid(v, a, from);
    to_grid(v, b, to);
    if (!cell_of(v, from, l.cell) || !cell_of(v, to, end) || !is_set(v, l.cell)) {
        return false;
    }
    for (int k = 0; k < 3; k++) {
        l.step[k] = end[k] < l.cell[k] ? -1 : 1;
        l.left[k] = abs(end[k] - l.cell[k]);
    }
    while (l.left[0] + l.left[1] + l.left[2] > 0) {
        double at[3] = {next_crossing(&l, 0), next_crossing(&l, 1), next_crossing(&l, 2)};
        double least = fmin(at[0], fmin(at[1], at[2]));
        unsigned axes = (at[0] == least ? 1u : 0u) | (at[1] == least ? 2u : 0u) | (at[2] == least ? 4u : 0u);
        if (!pass(v, &l, axes)) {
            return false;
        }
    }
    return true;
}

// ---- Construction ----

static void voxels_destroy(vn_domain *domain) {
    voxels *v = (voxels *)domain;
    vn_voxel_bits_free(&v->bits);
    vn_voxel_tree_free(&v->tree);
    vn_voxel_corners_free(&v->corners);
    vn_array_free(&v->set_up_to);
    vn_volume_free(&v->volume);
}

static const vn_domain_kind flat_kind = {.name = "image",
                                         .destroy = voxels_destroy,
                                         .contains = voxels_contains,
                                         .closest = voxels_closest,
                                         .sees = voxels_sees,
                                         .outline = voxels_outline,
                                         .dart = voxels_dart,
                                         .value = voxels_value};
static const vn_domain_kind solid_kind = {.name = "volume",
                                          .destroy = voxels_destroy,
                                          .contains = voxels_contains,
                                          .closest = voxels_closest,
                                          .sees = voxels_sees,
                                          .dart = voxels_dart,
                                          .value = voxels_value};

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// What is left of the right angles' error is taken out, so that distances in the grid are those in the world.
static vn_status square_axes(voxels *v, const char *what) {
    for (int a = 0; a < 3; a++) {
        for (int b = 0; b < a; b++) {
            double cosine = dot(v->axis[a], v->axis[b]);
            if (!(fabs(cosine) <= 1e-3)) {
                return vn_fail(
                    VN_INVALID,
                    "%s: its voxel axes %d and %d are %.4g degrees apart: a sheared volume has to be "
                    "resampled to right angles",
                    what, b, a, acos(fmin(fmax(cosine, -1), 1)) * 57.29577951308232);
            }
            for (int r = 0; r < 3; r++) {
                v->axis[a][r] -= cosine * v->axis[b][r];
            }
        }
        double length = sqrt(dot(v->axis[a], v->axis[a]));
        for (int r = 0; r < 3; r++) {
            v->axis[a][r] /= length;
        }
    }
    return VN_OK;
}

static vn_status place_grid(voxels *v, const vn_mask *mask) {
    double(*m)[4] = v->volume.to_world;
    for (int a = 0; a < 3; a++) {
        double column[3] = {m[0][a], m[1][a], m[2][a]};
        v->side[a] = sqrt(dot(column, column));
        for (int r = 0; r < 3; r++) {
            v->axis[a][r] = column[r] / v->side[a];
        }
    }
    VN_TRY(square_axes(v, mask->what));
    for (int r = 0; r < 3; r++) {
        v->origin[r] = m[r][3];
        for (int a = 0; a < 3; a++) {
            v->origin[r] -= 0.5 * v->side[a] * v->axis[a][r];
        }
    }
    return VN_OK;
}

static vn_status set_voxels(voxels *v, const vn_mask *mask) {
    const int32_t *size = v->bits.size;
    size_t index = 0;
    for (int32_t k = 0; k < size[2]; k++) {
        for (int32_t j = 0; j < size[1]; j++) {
            if (j % 256 == 0) {
                VN_TRY(vn_poll());
            }
            for (int32_t i = 0; i < size[0]; i++, index++) {
                double value = vn_volume_at(&v->volume, index) / mask->scale;
                if (mask->invert ? value < mask->threshold : value >= mask->threshold) {
                    *vn_voxel_word(&v->bits, i, j, k) |= vn_voxel_bit(i, j, k);
                }
            }
        }
    }
    return VN_OK;
}

/// What is found out of the foreground in one walk over it.
typedef struct survey {
    int32_t low[3], high[3]; ///< voxels
    double least, greatest;  ///< values
    int32_t count;
} survey;

static void survey_word(const voxels *v, uint64_t word, const int32_t block[3], survey *s) {
    for (; word != 0; word &= word - 1) {
        int bit = __builtin_ctzll(word);
        int32_t cell[3] = {4 * block[0] + (bit & 3), 4 * block[1] + (bit >> 2 & 3),
                           4 * block[2] + (bit >> 4)};
        double value = vn_volume_at(&v->volume, index_of(v, cell));
        s->least = fmin(s->least, value);
        s->greatest = fmax(s->greatest, value);
        for (int a = 0; a < 3; a++) {
            s->low[a] = cell[a] < s->low[a] ? cell[a] : s->low[a];
            s->high[a] = cell[a] > s->high[a] ? cell[a] : s->high[a];
        }
        s->count++;
    }
}

static vn_status survey_foreground(voxels *v, survey *s) {
    const int32_t *blocks = v->bits.blocks;
    int32_t at[3];
    const uint64_t *word = v->bits.words;
    *s = (survey){{INT32_MAX, INT32_MAX, INT32_MAX}, {0, 0, 0}, INFINITY, -INFINITY, 0};
    VN_TRY(vn_array_reserve(&v->set_up_to, (int64_t)v->bits.count));
    for (at[2] = 0; at[2] < blocks[2]; at[2]++) {
        VN_TRY(vn_poll());
        for (at[1] = 0; at[1] < blocks[1]; at[1]++) {
            for (at[0] = 0; at[0] < blocks[0]; at[0]++, word++) {
                survey_word(v, *word, at, s);
                v->set_up_to.data[v->set_up_to.count++] = s->count;
            }
        }
    }
    return VN_OK;
}

static void set_bounds(voxels *v, const survey *s) {
    vn_box *box = &v->base.bounds;
    for (int corner = 0; corner < 8; corner++) {
        double u[3], p[3] = {0};
        for (int a = 0; a < 3; a++) {
            u[a] = corner >> a & 1 ? s->high[a] + 1.0 : s->low[a];
        }
        to_world(v, u, p);
        for (int r = 0; r < 3; r++) {
            box->min[r] = corner > 0 ? fmin(box->min[r], p[r]) : p[r];
            box->max[r] = corner > 0 ? fmax(box->max[r], p[r]) : p[r];
        }
    }
}

// Scaled by the white of the format or, where it has none, by the greatest value inside. Values that are all
// the same need not be kept.
static void scale_values(voxels *v, const survey *s, bool invert) {
    double white = v->volume.white > 0 ? v->volume.white : s->greatest;
    bool has_values = white > 0;
    v->gain = has_values ? (invert ? -1 : 1) / white : 0;
    v->offset = has_values && !invert ? 0 : 1;
    if (!has_values || s->least == s->greatest) {
        v->offset = fmin(fmax(v->gain * s->greatest + v->offset, 0), 1);
        vn_volume_free(&v->volume);
    }
}

static vn_status fill_voxels(voxels *v, const vn_mask *mask) {
    survey s;
    VN_TRY(place_grid(v, mask));
    VN_TRY(vn_voxel_bits_init(&v->bits, v->volume.size));
    VN_TRY(set_voxels(v, mask));
    VN_TRY(vn_voxel_parts(&v->bits, mask->parts, mask->what));
    VN_TRY(vn_voxel_tree_build(&v->tree, &v->bits));
    VN_TRY(vn_voxel_corners_build(&v->corners, &v->bits, mask->dim == 2, v->side));
    VN_TRY(survey_foreground(v, &s));
    set_bounds(v, &s);
    v->base.polygonal = mask->dim == 2;
    v->base.measure = s.count;
    for (int a = 0; a < mask->dim; a++) {
        v->base.measure *= v->side[a];
    }
    snprintf(v->base.unit, sizeof v->base.unit, "%s", v->volume.unit);
    scale_values(v, &s, mask->invert);
    return VN_OK;
}

vn_status vn_domain_voxels(vn_domain **out, vn_volume *volume, const vn_mask *mask) {
    *out = NULL;
    voxels *v = vn_domain_new(mask->dim == 2 ? &flat_kind : &solid_kind, sizeof *v, mask->dim);
    if (v == NULL) {
        vn_volume_free(volume);
        return vn_fail_memory("a mask", sizeof *v);
    }
    v->volume = *volume;
    *volume = (vn_volume){0};
    vn_status status = fill_voxels(v, mask);
    if (status != VN_OK) {
        vn_domain_release(&v->base);
        return status;
    }
    *out = &v->base;
    return VN_OK;
}
