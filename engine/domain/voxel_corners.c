#include "domain/voxel_corners.h"

#include "base/array.h"
#include "base/parallel.h"

#include <math.h>
#include <stdatomic.h>

static const uint32_t NONE = UINT32_MAX;

/// One pass of the transform (Felzenszwalb and Huttenlocher 2012): along each line of corners the lower
/// envelope of parabolas, one over each corner that knows a nearest one from the passes before.
typedef struct pass {
    vn_voxel_corners *corners;
    const vn_voxel_bits *bits;
    const double *scale;
    int axis;
    int64_t first; ///< line of this slab
    atomic_bool failed;
} pass;

/// The envelope of a line: parabola i is over corner `over[i]`, and lowest from `from[i]` to the next one's.
typedef struct envelope {
    int32_t *over;
    double *from, *height;
    uint32_t *nearest;
} envelope;

static void place_of(const vn_voxel_corners *c, uint32_t number, int32_t at[3]) {
    uint32_t nx = (uint32_t)c->size[0], ny = (uint32_t)c->size[1], row = number / nx;
    at[0] = (int32_t)(number - row * nx);
    at[2] = (int32_t)(row / ny);
    at[1] = (int32_t)(row - (uint32_t)at[2] * ny);
}

static size_t number_of(const vn_voxel_corners *c, const int32_t at[3]) {
    return (size_t)at[0] + (size_t)c->size[0] * ((size_t)at[1] + (size_t)c->size[1] * (size_t)at[2]);
}

// Of a corner's nearest one, the square distance across the axes of the passes before.
static double height_of(const pass *p, uint32_t nearest, const int32_t at[3]) {
    int32_t to[3];
    double sum = 0;
    place_of(p->corners, nearest, to);
    for (int a = 0; a < p->axis; a++) {
        double d = p->scale[a] * (to[a] - at[a]);
        sum += d * d;
    }
    return sum;
}

// Where the parabola over @p i falls below that over @p j, which is left of it; in corners.
static double crossing(const envelope *e, double scale, int32_t i, int32_t j) {
    double s2 = scale * scale;
    return ((e->height[i] - e->height[j]) / s2 + (double)i * i - (double)j * j) / (2.0 * (i - j));
}

static int32_t raise_envelope(const pass *p, const envelope *e, int32_t count) {
    int32_t top = 0;
    double scale = p->scale[p->axis];
    for (int32_t i = 0; i < count; i++) {
        if (e->nearest[i] == NONE) {
            continue;
        }
        double from = -INFINITY;
        while (top > 0) {
            from = crossing(e, scale, i, e->over[top - 1]);
            if (from > e->from[top - 1]) {
                break;
            }
            top--;
            from = -INFINITY;
        }
        e->over[top] = i;
        e->from[top++] = from;
    }
    return top;
}

static void transform_line(const pass *p, const envelope *e, uint32_t *line, size_t stride,
                           const int32_t first[3]) {
    int32_t count = p->corners->size[p->axis], at[3] = {first[0], first[1], first[2]};
    for (int32_t i = 0; i < count; i++) {
        at[p->axis] = i;
        e->nearest[i] = line[(size_t)i * stride];
        e->height[i] = p->axis > 0 && e->nearest[i] != NONE ? height_of(p, e->nearest[i], at) : 0;
    }
    int32_t top = raise_envelope(p, e, count);
    for (int32_t i = 0, k = 0; i < count && top > 0; i++) {
        while (k + 1 < top && e->from[k + 1] < i) {
            k++;
        }
        line[(size_t)i * stride] = e->nearest[e->over[k]];
    }
}

// Lines are numbered with the first of the other axes running fastest, so that neighbours share what is in
// the caches.
static void transform_lines(int64_t begin, int64_t end, void *payload) {
    pass *p = payload;
    const int32_t *size = p->corners->size;
    size_t length = (size_t)size[p->axis], stride = 1;
    size_t bytes = length * (2 * sizeof(double) + sizeof(int32_t) + sizeof(uint32_t));
    double *block = vn_resize(NULL, 0, bytes);
    if (block == NULL) {
        atomic_store(&p->failed, true);
        return;
    }
    envelope e = {.from = block, .height = block + length};
    e.over = (int32_t *)(block + 2 * length);
    e.nearest = (uint32_t *)(e.over + length);
    int fast = p->axis == 0 ? 1 : 0, slow = 3 - fast - p->axis;
    for (int a = 0; a < p->axis; a++) {
        stride *= (size_t)size[a];
    }
    for (int64_t i = p->first + begin; i < p->first + end; i++) {
        int32_t at[3] = {0};
        at[fast] = (int32_t)(i % size[fast]);
        at[slow] = (int32_t)(i / size[fast]);
        transform_line(p, &e, p->corners->nearest + number_of(p->corners, at), stride, at);
    }
    vn_resize(block, bytes, 0);
}

static int set_around(const vn_voxel_bits *bits, int32_t i, int32_t j, int32_t k, bool flat) {
    int count = 0;
    for (int b = j - 1; b <= j; b++) {
        for (int c = flat ? 0 : k - 1; c <= k; c++) {
            count += vn_voxel_exists(bits, i, b, c) && vn_voxel_is_set(bits, i, b, c);
        }
    }
    return count;
}

// A corner is on the border where the voxels around it differ.
static void mark_lines(int64_t begin, int64_t end, void *payload) {
    pass *p = payload;
    vn_voxel_corners *c = p->corners;
    bool flat = c->size[2] == 1;
    for (int64_t line = p->first + begin; line < p->first + end; line++) {
        int32_t j = (int32_t)(line % c->size[1]), k = (int32_t)(line / c->size[1]);
        int before = 0;
        for (int32_t i = 0; i < c->size[0]; i++) {
            int here = set_around(p->bits, i, j, k, flat);
            size_t number = (size_t)line * (size_t)c->size[0] + (size_t)i;
            bool border = before + here > 0 && before + here < (flat ? 4 : 8);
            c->nearest[number] = border ? (uint32_t)number : NONE;
            before = here;
        }
    }
}

static vn_status run(pass *p, int64_t lines, vn_range_fn *work) {
    enum { SLAB = 16384, GRAIN = 64 };
    for (p->first = 0; p->first < lines; p->first += SLAB) {
        int64_t count = lines - p->first < SLAB ? lines - p->first : SLAB;
        VN_TRY(vn_poll());
        vn_parallel_for(count, GRAIN, work, p);
        if (atomic_load(&p->failed)) {
            return vn_fail_memory("a distance transform", 0);
        }
    }
    return VN_OK;
}

vn_status vn_voxel_corners_build(vn_voxel_corners *corners, const vn_voxel_bits *bits, bool flat,
                                 const double scale[3]) {
    pass p = {.corners = corners, .bits = bits, .scale = scale};
    double count = 1;
    for (int a = 0; a < 3; a++) {
        corners->size[a] = bits->size[a] + (flat && a == 2 ? 0 : 1);
        count *= corners->size[a];
    }
    if (count >= (double)NONE) {
        return vn_fail(VN_LIMIT,
                       "a mask of %d x %d x %d voxels has more than 2^32 - 2 corners; make it coarser",
                       bits->size[0], bits->size[1], bits->size[2]);
    }
    corners->count = (size_t)count;
    corners->nearest = vn_resize(NULL, 0, corners->count * sizeof *corners->nearest);
    if (corners->nearest == NULL) {
        return vn_fail_memory("a mask", corners->count * sizeof *corners->nearest);
    }
    VN_TRY(run(&p, (int64_t)corners->size[1] * corners->size[2], mark_lines));
    for (p.axis = 0; p.axis < (flat ? 2 : 3); p.axis++) {
        VN_TRY(run(&p, (int64_t)(corners->count / (size_t)corners->size[p.axis]), transform_lines));
    }
    return VN_OK;
}

void vn_voxel_corners_free(vn_voxel_corners *corners) {
    vn_resize(corners->nearest, corners->nearest != NULL ? corners->count * sizeof *corners->nearest : 0, 0);
    *corners = (vn_voxel_corners){0};
}

// Let t be what leads from the point to a place of the border, v from a corner to the point, and D the
// corner's distance to the border. Then |t + v| >= D, and what is to be nearer than B has |t| < B: so 2 t v >
// D2 - v2 - B2. Averaged over the four corners of a side of the voxel, as the point lies between them, only
// the component of v across the side is left, which bounds that component of t.
static void bound_axis(const vn_voxel_ring *r, double limit, double reach, int axis, double *low,
                       double *high) {
    double side[2] = {0};
    int b = axis == 0 ? 1 : 0, c = 3 - axis - b;
    for (int corner = 0; corner < 8; corner++) {
        side[corner >> axis & 1] +=
            r->share[b][corner >> b & 1] * r->share[c][corner >> c & 1] * r->slack[corner];
    }
    double below = fmin(side[0] - limit, 0) / (2 * r->away[axis][0]);
    double above = fmin(side[1] - limit, 0) / (2 * r->away[axis][1]);
    *low = below > -reach ? below : -reach; // also where the point is on that side, and nothing bounds it
    *high = above < reach ? above : reach;
}

// Where the corners of the point's voxel are, and how the point lies between them.
static void find_voxel(const vn_voxel_corners *c, const double u[3], const double scale[3],
                       vn_voxel_ring *r) {
    for (int a = 0; a < 3; a++) {
        bool flat = c->size[a] == 1;
        int32_t last = flat ? 0 : c->size[a] - 2;
        r->base[a] = u[a] < last ? (int32_t)u[a] : last;
        r->step[a] = flat ? 0 : 1;
        r->share[a][1] = flat ? 0.5 : u[a] - r->base[a];
        r->share[a][0] = 1 - r->share[a][1];
        r->away[a][0] = flat ? 0 : scale[a] * r->share[a][1];
        r->away[a][1] = flat ? 0 : -scale[a] * r->share[a][0];
        r->diagonal2 += scale[a] * scale[a];
    }
}

static void ask_corner(const vn_voxel_corners *c, const double scale[3], vn_voxel_ring *r, int corner) {
    double to_corner = 0, from_corner = 0, from_point = 0;
    int32_t here[3];
    for (int a = 0; a < 3; a++) {
        here[a] = r->base[a] + (corner >> a & 1) * r->step[a];
    }
    uint32_t nearest = c->nearest[number_of(c, here)];
    if (corner == 0 || nearest != r->nearest) { // neighbours mostly know the same one
        place_of(c, nearest, r->to);
        r->nearest = nearest;
    }
    for (int a = 0; a < 3; a++) {
        double v = r->away[a][corner >> a & 1], d = scale[a] * (r->to[a] - here[a]);
        to_corner += v * v;
        from_corner += d * d;
        from_point += (d - v) * (d - v);
    }
    r->slack[corner] = from_corner - to_corner;
    if (from_point < r->best) {
        r->best = from_point;
        memcpy(r->at, r->to, sizeof r->at);
    }
}

void vn_voxel_corners_ask(const vn_voxel_corners *corners, const double u[3], const double scale[3],
                          vn_voxel_ring *ring) {
    *ring = (vn_voxel_ring){.best = INFINITY};
    find_voxel(corners, u, scale, ring);
    for (int corner = 0; corner < 8; corner++) {
        ask_corner(corners, scale, ring, corner);
    }
}

void vn_voxel_corners_bound(const vn_voxel_corners *corners, const vn_voxel_ring *ring, const double u[3],
                            const double scale[3], double best, double low[3], double high[3]) {
    double limit = best + 1e-9 * (best + ring->diagonal2); // room for rounding
    double reach = sqrt(limit);
    for (int a = 0; a < 3; a++) {
        bool flat = corners->size[a] == 1;
        bound_axis(ring, limit, reach, a, &low[a], &high[a]);
        low[a] = flat ? 0 : u[a] + low[a] / scale[a];
        high[a] = flat ? 1 : u[a] + high[a] / scale[a];
    }
}
