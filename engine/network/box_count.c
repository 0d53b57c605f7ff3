// The box-counting dimension. Results depend on the method more than on the vessels: so there is one protocol
// (vessel_measures.h), tested on fractals whose dimension is known.

#include "network/leaf.h"
#include "network/vessels.h"

#include "space/box_set.h"

static const vn_boxes_def boxes_default = {.coarsest = 2, .finest = 8, .offsets = 16};

static const vn_field boxes_fields[] = {
    {"coarsest", VN_I32, 0, offsetof(vn_boxes_def, coarsest), 0, 14, "", NULL,
     "the largest boxes have the longest side of the nodes' bounds by 2 to this power"},
    {"finest", VN_I32, 0, offsetof(vn_boxes_def, finest), 1, 15, "", NULL,
     "the smallest boxes likewise; above coarsest, and in 3D at most 10"},
    {"offsets", VN_I32, 0, offsetof(vn_boxes_def, offsets), 1, 1000, "grids", NULL,
     "each shifted by a part of the largest box; the least count holds"},
};
const vn_schema vn_boxes_schema = VN_SCHEMA("measure_boxes", "Box counting", boxes_fields, boxes_default);

vn_boxes_def vn_boxes_def_default(void) {
    return boxes_default;
}

typedef struct box_count {
    const vn_network *network;
    const vn_boxes_def *def;
    vn_boxes *out;
    double low[3], extent;
    double parts;     // that the extent has
    int64_t shift[3]; // in parts of the smallest boxes
    vn_box_set set, larger;
} box_count;

static void find_extent(box_count *c) {
    double high[3];
    vn_points points = vn_network_points(c->network);
    // The extent ends a part before the face of a box: on the face it would take one more in each direction,
    // and a line of 2^k boxes count as 2^k + 1.
    c->parts = ldexp(VN_BOX_PARTS, c->def->finest) - 1;
    c->extent = vn_points_extent(&points, 0, c->network->x.count, c->low, high);
}

static void place_of(const box_count *c, int32_t node, int64_t q[3]) {
    double p[3];
    vn_network_position(c->network, node, p);
    for (int k = 0; k < 3; k++) {
        double share = c->extent > 0 ? (p[k] - c->low[k]) / c->extent : 0;
        q[k] = (int64_t)floor(share * c->parts + 0.5) + c->shift[k];
    }
}

static void add_line(box_count *c, int32_t from, int32_t to) {
    int64_t a[3], b[3];
    place_of(c, from, a);
    place_of(c, to, b);
    vn_box_set_add(&c->set, a, b);
}

static void add_lines(box_count *c) {
    for (int32_t i = 0; i < c->network->x.count; i++) {
        int32_t parent = c->network->parent.data[i];
        add_line(c, parent >= 0 ? parent : i, i);
    }
    for (int32_t i = 0; i < c->network->joins.count; i++) {
        add_line(c, c->network->joins.data[i].a, c->network->joins.data[i].b);
    }
}

static void set_shift(box_count *c, int32_t offset) {
    static const int32_t bases[3] = {3, 5, 7}; // by powers of two, small boxes would not move
    double largest = ldexp(VN_BOX_PARTS, c->def->finest - c->def->coarsest);
    for (int k = 0; k < 3; k++) {
        c->shift[k] = k < c->network->dim ? (int64_t)floor(vn_halton(offset, bases[k]) * largest) : 0;
    }
}

static void note_count(vn_boxes *out, int32_t size, int32_t offset, int64_t count) {
    out->count[size] = offset == 0 || count < out->count[size] ? count : out->count[size];
}

// There is room for one of the largest boxes more than the extent takes.
static vn_status count_shifted(box_count *c, int32_t offset) {
    int64_t side = (INT64_C(1) << c->def->finest) + (INT64_C(1) << (c->def->finest - c->def->coarsest));
    VN_TRY(vn_poll());
    set_shift(c, offset);
    VN_TRY(vn_box_set_clear(&c->set, c->network->dim, side));
    add_lines(c);
    for (int32_t size = c->out->sizes - 1;; size--) {
        note_count(c->out, size, offset, vn_box_set_count(&c->set));
        if (size == 0) {
            return VN_OK;
        }
        VN_TRY(vn_box_set_double(&c->larger, &c->set));
        vn_box_set swapped = c->set;
        c->set = c->larger;
        c->larger = swapped;
    }
}

static void fit_line(vn_boxes *out) {
    vn_line_fit fit = {0};
    for (int32_t k = 0; k < out->sizes; k++) {
        vn_line_add(&fit, k * log(2), log((double)out->count[k]));
    }
    out->dimension = vn_line_slope(&fit);
    out->r2 = vn_line_r2(&fit);
}

static vn_status count_boxes(box_count *c) {
    find_extent(c);
    c->out->extent = c->extent;
    c->out->sizes = c->def->finest - c->def->coarsest + 1;
    for (int32_t k = 0; k < c->out->sizes; k++) {
        c->out->side[k] = ldexp(c->extent, -(c->def->coarsest + k));
    }
    for (int32_t offset = 0; offset < c->def->offsets; offset++) {
        VN_TRY(count_shifted(c, offset));
    }
    fit_line(c->out);
    return VN_OK;
}

static vn_status check_request(const vn_network *network, const vn_boxes_def *def) {
    enum { MOST_SOLID = 10 };
    VN_TRY(vn_check_def(&vn_boxes_schema, def));
    if (def->finest <= def->coarsest) {
        return vn_fail(VN_INVALID,
                       "measure_boxes.finest = %d must be above coarsest = %d: a line needs two sizes",
                       def->finest, def->coarsest);
    }
    if (network->dim == 3 && def->finest > MOST_SOLID) {
        return vn_fail(VN_INVALID,
                       "measure_boxes.finest = %d must be at most %d in 3D: there would be 2^%d boxes",
                       def->finest, MOST_SOLID, 3 * def->finest);
    }
    if (network->x.count == 0) {
        return vn_fail(VN_INVALID, "measure_boxes: the network is empty; grow or load it first");
    }
    return vn_check_places(network, "measure_boxes");
}

vn_status vn_network_measure_boxes(const vn_network *network, const vn_boxes_def *def, vn_boxes *out) {
    vn_boxes made = {0};
    *out = made;
    VN_TRY(check_request(network, def));
    box_count c = {.network = network, .def = def, .out = &made};
    vn_status status = count_boxes(&c);
    vn_box_set_free(&c.set);
    vn_box_set_free(&c.larger);
    *out = status == VN_OK ? made : *out;
    return status;
}
