#include "draw/chains.h"

#include "network/network.h"

#include <math.h>

enum { POLL_EVERY = 65536 };

typedef struct chain_maker {
    vn_canvas *canvas;
    const vn_network *network;
    const vn_stroke_def *def;
    const double *x, *y;
    const int32_t *parent, *orders;
    int32_t count;
    vn_widths widths;
    vn_heirs heirs; // join_heir() where a join continues a node's vein
} chain_maker;

// The width on the canvas. A thousandth of a pixel nobody sees, so sums that differ in their last bits
// are one width.
static double true_width(const chain_maker *maker, double width) {
    return floor(width * maker->canvas->scale * 1000 + 0.5) / 1000;
}

static float drawn_width(const chain_maker *maker, double width) {
    return (float)fmin(fmax(true_width(maker, width), maker->def->min_width), 1e6);
}

static bool is_hidden(const chain_maker *maker, double width) {
    return true_width(maker, width) < maker->def->hide_below;
}

static float node_width(const chain_maker *maker, int32_t node) {
    return drawn_width(maker, maker->widths.data[node]);
}

static int32_t node_order(const chain_maker *maker, int32_t node) {
    return maker->orders != NULL ? maker->orders[node] : 0;
}

static vn_status edge_width(const vn_network *network, const vn_stroke_def *def, int32_t node,
                            double *width) {
    if (def->widths == NULL) {
        *width = def->width > 0 ? def->width : 2 * vn_network_radius(network, node);
        return VN_OK;
    }
    *width = def->widths[node];
    if (vn_network_parent(network)[node] >= 0 && !(isfinite(*width) && *width >= 0)) {
        return vn_fail(VN_INVALID, "stroke.widths: that of node %d is %g; give 0 or more", node, *width);
    }
    return VN_OK;
}

vn_status vn_stroke_widths(const vn_network *network, const vn_stroke_def *def, vn_widths *widths) {
    const int32_t *parent = vn_network_parent(network);
    int32_t count = vn_network_count(network);
    double widest = 0;
    int32_t edges = 0;
    VN_TRY(vn_array_zero(widths, count));
    for (int32_t i = 0; i < count; i++) {
        VN_TRY(edge_width(network, def, i, &widths->data[i]));
        if (parent[i] >= 0) {
            widest = fmax(widest, widths->data[i]);
            edges++;
        }
    }
    if (edges > 0 && widest == 0 && def->widths == NULL) {
        return vn_fail(VN_INVALID,
                       "stroke: the network's radii are not known; give stroke.width, or have radii by "
                       "Murray's law first");
    }
    return VN_OK;
}

vn_status vn_find_heirs(const vn_network *network, const vn_widths *widths, vn_heirs *heirs) {
    const int32_t *parents = vn_network_parent(network);
    int32_t count = vn_network_count(network);
    VN_TRY(vn_array_reserve(heirs, count));
    heirs->count = count;
    for (int32_t i = 0; i < count; i++) {
        heirs->data[i] = -1;
    }
    for (int32_t i = 0; i < count; i++) {
        int32_t parent = parents[i];
        if (parent >= 0 && (heirs->data[parent] < 0 || widths->data[i] > widths->data[heirs->data[parent]])) {
            heirs->data[parent] = i;
        }
    }
    return VN_OK;
}

vn_join_line vn_join_line_at(const vn_network *network, const vn_stroke_def *def, const vn_widths *widths,
                             int32_t join) {
    vn_join_line line;
    double radius;
    vn_network_join_ends(network, join, &line.a, &line.b, &radius);
    if (def->widths == NULL && def->width > 0) {
        line.width = def->width;
    } else if (def->widths == NULL && radius > 0) {
        line.width = 2 * radius;
    } else {
        line.width = fmin(widths->data[line.a], widths->data[line.b]);
    }
    return line;
}

// Whether the edge of @p node goes on the vein of the edge before it.
static bool continues(const chain_maker *maker, int32_t node) {
    int32_t parent = maker->parent[node];
    return maker->parent[parent] >= 0 && maker->heirs.data[parent] == node &&
           !is_hidden(maker, maker->widths.data[parent]);
}

static bool tapers(const chain_maker *maker, int32_t node) {
    return continues(maker, node) && node_width(maker, node) != node_width(maker, maker->parent[node]);
}

static vn_color node_color(const chain_maker *maker, int32_t node) {
    return maker->def->colors != NULL ? vn_color_of_rgb(maker->def->colors[node]) : (vn_color){0};
}

static bool same_color(const chain_maker *maker, int32_t a, int32_t b) {
    return maker->def->colors == NULL || maker->def->colors[a] == maker->def->colors[b];
}

// Whether the chain that the edge of @p node is part of also holds that of its heir.
static bool goes_on(const chain_maker *maker, int32_t node, int32_t heir) {
    return heir >= 0 && node_width(maker, heir) == node_width(maker, node) &&
           node_order(maker, heir) == node_order(maker, node) && same_color(maker, heir, node) &&
           !is_hidden(maker, maker->widths.data[heir]);
}

static bool begins(const chain_maker *maker, int32_t node) {
    int32_t parent = maker->parent[node];
    return !continues(maker, node) || !goes_on(maker, parent, node) || tapers(maker, parent);
}

static vn_status push_point(chain_maker *maker, int32_t node) {
    vn_spot spot = vn_canvas_place(maker->canvas, maker->x[node], maker->y[node]);
    return vn_array_push(&maker->canvas->points, spot);
}

static vn_status push_piece(chain_maker *maker, vn_piece piece) {
    piece.count = maker->canvas->points.count - piece.begin;
    return vn_array_push(&maker->canvas->pieces, piece);
}

static vn_status push_taper(chain_maker *maker, int32_t node) {
    int32_t parent = maker->parent[node];
    vn_piece piece = {.begin = maker->canvas->points.count, .order = node_order(maker, node)};
    piece.color = node_color(maker, node);
    piece.width = node_width(maker, parent);
    piece.end_width = node_width(maker, node);
    VN_TRY(push_point(maker, parent));
    VN_TRY(push_point(maker, node));
    return push_piece(maker, piece);
}

// Its own inverse.
static int32_t join_heir(int32_t join) {
    return -2 - join;
}

static vn_join_line join_at(const chain_maker *maker, int32_t join) {
    return vn_join_line_at(maker->network, maker->def, &maker->widths, join);
}

// Whether the chain of the edge of @p node, drawn as one width, goes on over the join that continues its
// vein.
static bool takes_in(const chain_maker *maker, int32_t node, int32_t join) {
    vn_join_line line = join_at(maker, join);
    return !is_hidden(maker, line.width) && drawn_width(maker, line.width) == node_width(maker, node) &&
           vn_network_join_order(maker->network, join) == node_order(maker, node) &&
           same_color(maker, line.b, node) && !tapers(maker, node);
}

static vn_status push_chain(chain_maker *maker, int32_t node) {
    vn_piece piece = {.begin = maker->canvas->points.count, .order = node_order(maker, node)};
    piece.color = node_color(maker, node);
    piece.width = piece.end_width = node_width(maker, node);
    VN_TRY(push_point(maker, maker->parent[node]));
    VN_TRY(push_point(maker, node));
    for (int32_t heir = maker->heirs.data[node]; goes_on(maker, node, heir); heir = maker->heirs.data[node]) {
        VN_TRY(push_point(maker, heir));
        node = heir;
    }
    int32_t join = join_heir(maker->heirs.data[node]);
    if (join >= 0 && takes_in(maker, node, join)) {
        VN_TRY(push_point(maker, join_at(maker, join).b));
    }
    return push_piece(maker, piece);
}

static vn_status push_edges(chain_maker *maker) {
    const int32_t *order = NULL;
    VN_TRY(vn_network_order(maker->network, &order));
    for (int32_t i = 0; i < maker->count; i++) {
        int32_t node = order != NULL ? order[i] : i;
        if (i % POLL_EVERY == 0) {
            VN_TRY(vn_poll());
        }
        if (maker->parent[node] < 0 || is_hidden(maker, maker->widths.data[node])) {
            continue;
        }
        if (tapers(maker, node)) {
            VN_TRY(push_taper(maker, node));
        } else if (begins(maker, node)) {
            VN_TRY(push_chain(maker, node));
        }
    }
    return VN_OK;
}

// Whether the edges' widths follow a law, by which a join has a parent, its end a, and is what b's own edge
// is: then it may continue a vein.
static bool has_lawful_joins(const chain_maker *maker) {
    vn_murray_def law;
    bool by_radius = maker->def->widths == NULL && maker->def->width == 0;
    return by_radius && vn_network_murray_get(maker->network, &law);
}

// A join that is thicker than all children continues the vein that it leaves.
static vn_status push_join(chain_maker *maker, int32_t join, const vn_join_line *ends, bool continues) {
    vn_piece piece = {.begin = maker->canvas->points.count};
    piece.order = vn_network_join_order(maker->network, join);
    piece.color = node_color(maker, ends->b);
    piece.width = piece.end_width = drawn_width(maker, ends->width);
    if (continues) {
        piece.width = node_width(maker, ends->a);
    }
    VN_TRY(push_point(maker, ends->a));
    VN_TRY(push_point(maker, ends->b));
    return push_piece(maker, piece);
}

static vn_status push_joins(chain_maker *maker) {
    int32_t count = vn_network_join_count(maker->network);
    for (int32_t i = 0; i < count; i++) {
        vn_join_line ends = join_at(maker, i);
        if (is_hidden(maker, ends.width)) {
            continue;
        }
        bool is_heir = maker->heirs.data[ends.a] == join_heir(i);
        bool has_vein = maker->parent[ends.a] >= 0 && !is_hidden(maker, maker->widths.data[ends.a]);
        if (!is_heir || !has_vein || !takes_in(maker, ends.a, i)) {
            VN_TRY(push_join(maker, i, &ends, is_heir && has_vein));
        }
    }
    return VN_OK;
}

static double heir_width(const chain_maker *maker, int32_t node) {
    int32_t heir = maker->heirs.data[node];
    if (heir == -1) {
        return -1;
    }
    return heir >= 0 ? maker->widths.data[heir] : join_at(maker, join_heir(heir)).width;
}

// Where a join continues a vein, the children that leave there are laterals.
static void find_join_heirs(chain_maker *maker) {
    int32_t count = has_lawful_joins(maker) ? vn_network_join_count(maker->network) : 0;
    for (int32_t i = 0; i < count; i++) {
        vn_join_line ends = join_at(maker, i);
        if (ends.width > heir_width(maker, ends.a)) {
            maker->heirs.data[ends.a] = join_heir(i);
        }
    }
}

typedef VN_ARRAY(float) layer_widths;

typedef struct piece_sorter {
    const float *layers; // the width of each vein order's thickest piece
    vn_piece *from, *to;
} piece_sorter;

static float thicker_end(const vn_piece *piece) {
    return piece->width > piece->end_width ? piece->width : piece->end_width;
}

static bool before(const piece_sorter *sorter, const vn_piece *a, const vn_piece *b) {
    if (a->order != b->order) {
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): there are orders only where there are layers
        float layer_a = sorter->layers[a->order];
        float layer_b = sorter->layers[b->order];
        return layer_a != layer_b ? layer_a < layer_b : a->order < b->order;
    }
    if (vn_piece_tapers(a) != vn_piece_tapers(b)) {
        return vn_piece_tapers(a);
    }
    return a->end_width < b->end_width;
}

static void merge(const piece_sorter *sorter, int64_t begin, int64_t middle, int64_t end) {
    const vn_piece *from = sorter->from;
    int64_t left = begin;
    int64_t right = middle;
    for (int64_t i = begin; i < end; i++) {
        bool take_right = left == middle || (right < end && before(sorter, &from[right], &from[left]));
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): as many places as pieces
        sorter->to[i] = from[take_right ? right++ : left++];
    }
}

// A stable merge sort: qsort() is not stable, and takes memory that no budget counts. Returns where the
// result is.
static vn_piece *sort_pieces(piece_sorter *sorter, int64_t count) {
    for (int64_t run = 1; run < count; run *= 2) {
        for (int64_t begin = 0; begin < count; begin += 2 * run) {
            int64_t middle = begin + run < count ? begin + run : count;
            int64_t end = middle + run < count ? middle + run : count;
            merge(sorter, begin, middle, end);
        }
        vn_piece *sorted = sorter->to;
        sorter->to = sorter->from;
        sorter->from = sorted;
    }
    return sorter->from;
}

static vn_status find_layers(layer_widths *layers, const vn_piece *pieces, int32_t count) {
    int32_t highest = 0;
    for (int32_t i = 0; i < count; i++) {
        highest = pieces[i].order > highest ? pieces[i].order : highest;
    }
    VN_TRY(vn_array_zero(layers, (int64_t)highest + 1));
    for (int32_t i = 0; i < count; i++) {
        layers->data[pieces[i].order] = fmaxf(layers->data[pieces[i].order], thicker_end(&pieces[i]));
    }
    return VN_OK;
}

static vn_status sort_layers(vn_piece *pieces, int32_t count) {
    layer_widths layers = {0};
    size_t size = (size_t)count * sizeof *pieces;
    vn_piece *spare = vn_resize(NULL, 0, size);
    vn_status status =
        spare == NULL ? vn_fail_memory("sorting veins", size) : find_layers(&layers, pieces, count);
    if (status == VN_OK) {
        piece_sorter sorter = {layers.data, pieces, spare};
        const vn_piece *sorted = sort_pieces(&sorter, count);
        if (sorted != pieces) {
            memcpy(pieces, sorted, size);
        }
    }
    vn_array_free(&layers);
    vn_resize(spare, spare != NULL ? size : 0, 0);
    return status;
}

static vn_status make_chains(chain_maker *maker) {
    VN_TRY(vn_stroke_widths(maker->network, maker->def, &maker->widths));
    VN_TRY(vn_find_heirs(maker->network, &maker->widths, &maker->heirs));
    find_join_heirs(maker);
    VN_TRY(push_edges(maker));
    return push_joins(maker);
}

vn_status vn_chains_build(vn_canvas *canvas, const vn_network *network, const vn_stroke_def *def) {
    int32_t first = canvas->pieces.count;
    chain_maker maker = {.canvas = canvas, .network = network, .def = def};
    maker.x = vn_network_x(network);
    maker.y = vn_network_y(network);
    maker.parent = vn_network_parent(network);
    maker.orders = vn_network_orders(network);
    maker.count = vn_network_count(network);
    vn_status status = make_chains(&maker);
    vn_array_free(&maker.widths);
    vn_array_free(&maker.heirs);
    if (status != VN_OK || canvas->pieces.count == first) {
        return status;
    }
    return sort_layers(canvas->pieces.data + first, canvas->pieces.count - first);
}
