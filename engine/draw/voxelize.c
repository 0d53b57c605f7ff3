#include "base/parallel.h"
#include "base/schema.h"
#include "draw/digital_line.h"
#include "draw/tubes.h"
#include "network/network.h"

#include <math.h>

#define ROW(name, type, flags, min, max, unit, kind, doc)                                                    \
    { #name, type, flags, offsetof(vn_voxels_def, name), min, max, unit, kind, doc }

static const vn_voxels_def voxels_defaults = {.margin = -1};
static const vn_field voxels_fields[] = {
    ROW(network, VN_OBJECT, VN_OPTIONAL, 0, 0, "", "network", "what becomes voxels"),
    ROW(networks, VN_MIXED, 0, 0, 0, "", "{arteries = A, veins = V}, numbered by alphabet, or {A, V}",
        "several networks of one unit"),
    ROW(content, VN_CHOICE, 0, 0, 0, "", "mask|label|tree|order|segment|radius|centerline|vesselness",
        "what a voxel says: whether there is a vessel, of which network, tree, vein order or branch (the "
        "node at "
        "its far end), of which radius; whether it is on the centre line; which part of it vessels fill"),
    ROW(resolution, VN_F64, VN_OPTIONAL | VN_ABOVE_MIN, 0, VN_HUGE, "length", NULL, "side of a voxel"),
    ROW(size, VN_I32, VN_OPTIONAL, 1, VN_LINE_SIDE, "voxels", NULL,
        "along the longest side, in place of a resolution; left out: 128"),
    ROW(margin, VN_I32, VN_OPTIONAL, 0, 65536, "voxels", NULL,
        "kept free on all sides; left out: 1, or 0 around bounds that are given"),
    ROW(bounds, VN_MIXED, 0, 0, 0, "length",
        "{min = {x, y, z}, max = {x, y, z}}, as domain:bounds() gives it",
        "what the volume covers, where vessels are cut; left out: all vessels"),
};
const vn_schema vn_voxels_schema =
    VN_SCHEMA("voxels", "What networks look like in voxels", voxels_fields, voxels_defaults);

vn_voxels_def vn_voxels_def_default(void) {
    return voxels_defaults;
}

static const struct {
    vn_voxel type;
    double most;
} contents[] = {
    [VN_VOXELS_MASK] = {VN_VOXEL_U8, 1},
    [VN_VOXELS_LABEL] = {VN_VOXEL_U16, UINT16_MAX},
    [VN_VOXELS_TREE] = {VN_VOXEL_U16, UINT16_MAX},
    [VN_VOXELS_ORDER] = {VN_VOXEL_U16, UINT16_MAX},
    [VN_VOXELS_SEGMENT] = {VN_VOXEL_U32, UINT32_MAX},
    [VN_VOXELS_RADIUS] = {VN_VOXEL_F32, INFINITY},
    [VN_VOXELS_CENTERLINE] = {VN_VOXEL_U8, 1},
    [VN_VOXELS_VESSELNESS] = {VN_VOXEL_F32, 1},
};

// ---- how much of a voxel a tube fills

#define PI 3.14159265358979323846

// A disc of a voxel's area: what a tube's section is laid over in 3D. In 2D it is an interval of its side.
static const double DISC = 0.56418958354775628695; // 1 / sqrt(pi)
static const double HALF = 0.5;

// The part of a disc of radius `r` on one side of a straight line, at signed distance `s` from its middle.
static double part_of_disc(double r, double s) {
    double x = fmin(fmax(s / r, -1), 1);
    return (acos(-x) + x * sqrt(1 - x * x)) / PI;
}

// The part of the disc that another one covers whose middle is `d` away. Where one is far larger, its border
// is straight: the squares of both would eat the digits.
static double part_of_discs(double r, double d) {
    if (d >= r + DISC || r <= 0) {
        return 0;
    }
    if (r > 1000) {
        return part_of_disc(DISC, r - d);
    }
    if (r < 1e-3) {
        return r / DISC * (r / DISC) * part_of_disc(r, DISC - d);
    }
    if (d <= fabs(r - DISC)) {
        return fmin(r / DISC, 1) * fmin(r / DISC, 1);
    }
    double near = (d * d + r * r - DISC * DISC) / (2 * d * r);
    double far = (d * d + DISC * DISC - r * r) / (2 * d * DISC);
    double kite = (r + DISC - d) * (d + r - DISC) * (d - r + DISC) * (d + r + DISC);
    double lens = r * r * acos(fmin(fmax(near, -1), 1)) + DISC * DISC * acos(fmin(fmax(far, -1), 1)) -
                  0.5 * sqrt(fmax(kite, 0));
    return fmin(fmax(lens, 0), 1);
}

static double part_of_interval(double r, double d) {
    return fmax(fmin(d + HALF, r) - fmax(d - HALF, -r), 0);
}

// ---- painting

typedef struct painter {
    const vn_voxel_grid *grid;
    const vn_tube *tubes;
    vn_volume *volume;
    float *depth; // how deep each voxel lies in the tube that has it; NULL where any tube will do
    int content;
    double soft;    // voxels this far from a tube are touched
    int axis;       // along which slabs lie: y when flat, else z
    int32_t height; // of a slab
    VN_ARRAY(int32_t) begin;
    VN_ARRAY(int32_t) listed; // the tubes of slab s are those from begin[s] to begin[s + 1]
} painter;

typedef struct slab {
    int32_t low[3], high[3]; // of its voxels; high is beyond
} slab;

typedef struct axis_of_tube {
    double d[3], inverse; // of the square of its length
} axis_of_tube;

static axis_of_tube axis_of(const vn_tube *tube) {
    axis_of_tube axis = {{0}, 0};
    double square = 0;
    for (int k = 0; k < 3; k++) {
        axis.d[k] = tube->b[k] - tube->a[k];
        square += axis.d[k] * axis.d[k];
    }
    axis.inverse = square > 0 ? 1 / square : 0;
    return axis;
}

static double distance_to(const vn_tube *tube, const axis_of_tube *axis, const int32_t voxel[3]) {
    double x = voxel[0] - tube->a[0], y = voxel[1] - tube->a[1], z = voxel[2] - tube->a[2];
    double t = (x * axis->d[0] + y * axis->d[1] + z * axis->d[2]) * axis->inverse;
    t = t > 0 ? (t < 1 ? t : 1) : 0;
    x -= t * axis->d[0];
    y -= t * axis->d[1];
    z -= t * axis->d[2];
    return sqrt(x * x + y * y + z * z);
}

static void put_part(const painter *p, size_t index, const vn_tube *tube, double distance) {
    double part =
        p->grid->dim == 3 ? part_of_discs(tube->radius, distance) : part_of_interval(tube->radius, distance);
    float *data = p->volume->data;
    data[index] = fmaxf(data[index], (float)part);
}

static void put(const painter *p, const vn_tube *tube, const int32_t voxel[3], double distance,
                bool on_line) {
    const int32_t *size = p->volume->size;
    size_t index =
        (size_t)voxel[0] + (size_t)size[0] * ((size_t)voxel[1] + (size_t)size[1] * (size_t)voxel[2]);
    if (p->content == VN_VOXELS_VESSELNESS) {
        put_part(p, index, tube,
                 on_line ? fmin(distance, p->soft) : distance); // no farther, so that it is not 0
        return;
    }
    float depth = (float)(tube->radius - distance);
    if (!on_line && !(depth >= 0)) {
        return;
    }
    if (p->depth != NULL) {
        if (!(depth > p->depth[index])) {
            return;
        }
        p->depth[index] = depth;
    }
    vn_volume_put(p->volume, index, tube->value);
}

// The whole numbers in [from - reach, to + reach] and [low, high).
static void span(double from, double to, double reach, int32_t low, int32_t high, int32_t *begin,
                 int32_t *end) {
    double first = ceil(fmin(from, to) - reach), last = floor(fmax(from, to) + reach);
    *begin = first > low ? (int32_t)fmin(first, high) : low;
    *end = last < high - 1 ? (int32_t)fmax(last + 1, low) : high;
}

// The part of the tube's axis that is near enough to a slice shrinks to what is near enough to a row of it:
// the voxels looked at are few times those touched, however the tube lies.
static void paint_row(const painter *p, const vn_tube *tube, const axis_of_tube *axis, double from, double to,
                      double reach, const slab *within, int32_t voxel[3]) {
    int32_t begin, end;
    vn_narrow(tube->a[1], axis->d[1], voxel[1] - reach, voxel[1] + reach, &from, &to);
    if (from > to) {
        return;
    }
    span(tube->a[0] + from * axis->d[0], tube->a[0] + to * axis->d[0], reach, within->low[0], within->high[0],
         &begin, &end);
    for (voxel[0] = begin; voxel[0] < end; voxel[0]++) {
        put(p, tube, voxel, distance_to(tube, axis, voxel), false);
    }
}

static void paint_tube(const painter *p, const vn_tube *tube, const axis_of_tube *axis, const slab *within) {
    double reach = (tube->radius + p->soft) * (1 + 1e-12) + 1e-9;
    int32_t voxel[3], begin, end, row_begin, row_end;
    span(tube->a[2], tube->b[2], reach, within->low[2], within->high[2], &begin, &end);
    for (voxel[2] = begin; voxel[2] < end; voxel[2]++) {
        double from = 0, to = 1;
        vn_narrow(tube->a[2], axis->d[2], voxel[2] - reach, voxel[2] + reach, &from, &to);
        if (from > to) {
            continue;
        }
        span(tube->a[1] + from * axis->d[1], tube->a[1] + to * axis->d[1], reach, within->low[1],
             within->high[1], &row_begin, &row_end);
        for (voxel[1] = row_begin; voxel[1] < row_end; voxel[1]++) {
            paint_row(p, tube, axis, from, to, reach, within, voxel);
        }
    }
}

static bool is_in(const slab *within, const int32_t voxel[3]) {
    for (int k = 0; k < 3; k++) {
        if (voxel[k] < within->low[k] || voxel[k] >= within->high[k]) {
            return false;
        }
    }
    return true;
}

static void paint_line(const painter *p, const vn_tube *tube, const axis_of_tube *axis, const slab *within) {
    double from = 0, to = 1, a[3], b[3];
    for (int k = 0; k < 3; k++) {
        vn_narrow(tube->a[k], axis->d[k], -2.5, p->grid->size[k] + 1.5, &from, &to);
    }
    if (from > to) {
        return;
    }
    for (int k = 0; k < 3; k++) {
        a[k] = from > 0 ? tube->a[k] + from * axis->d[k] : tube->a[k];
        b[k] = to < 1 ? tube->a[k] + to * axis->d[k] : tube->b[k];
    }
    vn_digital_line line = vn_digital_line_make(a, b, p->grid->size);
    int32_t begin = line.first - 1, end = line.last + 1, voxel[3];
    vn_digital_line_range(&line, p->axis, within->low[p->axis], within->high[p->axis], &begin, &end);
    for (int32_t number = begin; number <= end; number++) {
        vn_digital_line_at(&line, number, voxel);
        if (is_in(within, voxel)) {
            put(p, tube, voxel, distance_to(tube, axis, voxel), true);
        }
    }
}

static void paint_slab(const painter *p, int32_t number) {
    const int32_t *size = p->volume->size;
    slab within = {{0, 0, 0}, {size[0], size[1], size[2]}};
    within.low[p->axis] = number * p->height;
    within.high[p->axis] = number == p->begin.count - 2 ? size[p->axis] : within.low[p->axis] + p->height;
    if (p->depth != NULL) {
        size_t layer = (size_t)size[0] * (size_t)(p->axis == 2 ? size[1] : 1);
        for (size_t i = layer * (size_t)within.low[p->axis]; i < layer * (size_t)within.high[p->axis]; i++) {
            p->depth[i] = -INFINITY;
        }
    }
    for (int32_t i = p->begin.data[number]; i < p->begin.data[number + 1]; i++) {
        const vn_tube *tube = &p->tubes[p->listed.data[i]];
        axis_of_tube axis = axis_of(tube);
        if (p->content != VN_VOXELS_CENTERLINE) {
            paint_tube(p, tube, &axis, &within);
        }
        paint_line(p, tube, &axis, &within);
    }
}

// ---- slabs

enum {
    SLAB_VOXELS = 1 << 18, // about so many in a slab
    BATCH = 64,            // slabs between two looks at the clock
};

static void slabs_of(const painter *p, const vn_tube *tube, int32_t *first, int32_t *last) {
    double reach = tube->radius + p->soft + 2;
    int32_t begin, end;
    span(tube->a[p->axis], tube->b[p->axis], reach, 0, p->volume->size[p->axis], &begin, &end);
    *first = begin / p->height;
    *last = begin < end ? (end - 1) / p->height : *first - 1;
}

// Each slab's tubes, in the order of the tubes.
static vn_status list_tubes(painter *p, int32_t count) {
    int32_t slabs = (p->volume->size[p->axis] + p->height - 1) / p->height, first, last;
    VN_TRY(vn_array_zero(&p->begin, (int64_t)slabs + 1));
    int64_t total = 0;
    for (int32_t i = 0; i < count; i++) {
        slabs_of(p, &p->tubes[i], &first, &last);
        total += last - first + 1;
        VN_TRY(vn_array_reserve(&p->listed, total)); // a total beyond 2^31 - 1 ends here
        p->listed.count = (int32_t)total;
        for (int32_t s = first; s <= last; s++) {
            // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): a place for every slab
            p->begin.data[s + 1]++;
        }
    }
    for (int32_t s = 0; s < slabs; s++) {
        p->begin.data[s + 1] += p->begin.data[s];
    }
    for (int32_t i = count - 1; i >= 0; i--) {
        slabs_of(p, &p->tubes[i], &first, &last);
        for (int32_t s = first; s <= last; s++) {
            // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): as many as were counted
            p->listed.data[--p->begin.data[s + 1]] = i;
        }
    }
    // NOLINTNEXTLINE(clang-analyzer-core.NonNullParamChecker): a place for every slab
    memmove(p->begin.data, p->begin.data + 1, (size_t)slabs * sizeof *p->begin.data);
    p->begin.data[slabs] = p->listed.count;
    return VN_OK;
}

typedef struct batch {
    const painter *painter;
    int32_t first;
} batch;

static void paint_range(int64_t begin, int64_t end, void *payload) {
    const batch *these = payload;
    for (int64_t i = begin; i < end; i++) {
        paint_slab(these->painter, these->first + (int32_t)i);
    }
}

static vn_status paint_slabs(const painter *p) {
    int32_t slabs = p->begin.count - 1;
    for (int32_t first = 0; first < slabs; first += BATCH) {
        VN_TRY(vn_poll());
        batch these = {p, first};
        vn_parallel_for(slabs - first < BATCH ? slabs - first : BATCH, 1, paint_range, &these);
    }
    return VN_OK;
}

static vn_status paint(painter *p, int32_t count) {
    size_t voxels = p->volume->byte_size / vn_voxel_size(p->volume->type);
    size_t depths = p->content == VN_VOXELS_MASK || p->content == VN_VOXELS_CENTERLINE ||
                            p->content == VN_VOXELS_VESSELNESS
                        ? 0
                        : voxels * sizeof *p->depth;
    if (depths > 0) {
        p->depth = vn_resize(NULL, 0, depths);
        if (p->depth == NULL) {
            return vn_fail_memory("the depths of voxels", depths);
        }
    }
    size_t layer = voxels / (size_t)p->volume->size[p->axis];
    p->height = layer < SLAB_VOXELS ? (int32_t)(SLAB_VOXELS / layer) : 1;
    vn_status status = list_tubes(p, count);
    if (status == VN_OK) {
        status = paint_slabs(p);
    }
    vn_array_free(&p->begin);
    vn_array_free(&p->listed);
    vn_resize(p->depth, depths, 0);
    return status;
}

// ---- the whole

static vn_status check_network(const vn_network *network, const vn_network *first, int content) {
    if (vn_network_dim(network) != vn_network_dim(first)) {
        return vn_fail(VN_INVALID, "voxels.networks are of 2 and of 3 dimensions: give networks of one kind");
    }
    if (strcmp(vn_network_unit(network), vn_network_unit(first)) != 0) {
        return vn_fail(VN_INVALID,
                       "voxels.networks are in \"%.20s\" and in \"%.20s\": give networks of one unit",
                       vn_network_unit(first), vn_network_unit(network));
    }
    if (content != VN_VOXELS_CENTERLINE && vn_network_count(network) > 0 && !vn_network_has_radii(network)) {
        return vn_fail(VN_INVALID, "voxels: the network has no radii: call net:murray{…} first, or ask for "
                                   "content = \"centerline\"");
    }
    return VN_OK;
}

static vn_status check_request(const vn_voxels_def *def) {
    VN_TRY(vn_check_def(&vn_voxels_schema, def));
    const vn_network *const *networks;
    int32_t count = vn_voxels_networks(def, &networks);
    if (count < 1 || (def->network != NULL && def->network_count > 0)) {
        return vn_fail(VN_INVALID, "voxels: give `network` or `networks`, %s",
                       count < 1 ? "one at least" : "not both");
    }
    if (def->resolution > 0 && def->size > 0) {
        return vn_fail(VN_INVALID, "voxels: give `resolution` or `size`, not both");
    }
    if (def->content < 0 || def->content > VN_VOXELS_VESSELNESS) {
        return vn_fail(VN_INVALID, "voxels.content = %d is not one of the %d there are", def->content,
                       VN_VOXELS_VESSELNESS + 1);
    }
    for (int32_t i = 0; i < count; i++) {
        VN_TRY(check_network(networks[i], networks[0], def->content));
    }
    return VN_OK;
}

static double softness(const vn_voxels_def *def, int dim) {
    return def->content != VN_VOXELS_VESSELNESS ? 0 : (dim == 3 ? DISC : HALF);
}

static vn_status fill(vn_volume *volume, const vn_voxel_grid *grid, const vn_voxels_def *def) {
    const vn_network *const *networks;
    vn_voxels_networks(def, &networks);
    double spacing[3] = {grid->side, grid->side, grid->side}, soft = softness(def, grid->dim);
    VN_TRY(vn_volume_init(volume, contents[def->content].type, grid->size, spacing, grid->origin));
    const char *unit = vn_network_unit(networks[0]);
    if (strlen(unit) < sizeof volume->unit) {
        strcpy(volume->unit, unit);
    }
    vn_tubes tubes = {0};
    vn_status status = vn_tubes_gather(&tubes, grid, def, soft, contents[def->content].most);
    if (status == VN_OK) {
        painter p = {.grid = grid,
                     .tubes = tubes.data,
                     .volume = volume,
                     .content = def->content,
                     .soft = soft,
                     .axis = grid->dim - 1};
        status = paint(&p, tubes.count);
    }
    vn_array_free(&tubes);
    return status;
}

vn_status vn_voxelize(vn_volume **out, const vn_voxels_def *def) {
    vn_voxel_grid grid;
    *out = NULL;
    VN_TRY(check_request(def));
    VN_TRY(vn_voxel_grid_lay(&grid, def));
    vn_volume *volume = VN_NEW(vn_volume);
    if (volume == NULL) {
        return vn_fail_memory("a volume", sizeof *volume);
    }
    vn_status status = fill(volume, &grid, def);
    if (status != VN_OK) {
        vn_volume_destroy(volume);
        return status;
    }
    *out = volume;
    return VN_OK;
}
