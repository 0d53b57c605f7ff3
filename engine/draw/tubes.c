#include "draw/tubes.h"

#include "draw/digital_line.h"
#include "network/network.h"

#include <math.h>

enum { USUAL_SIZE = 128 };

int32_t vn_voxels_networks(const vn_voxels_def *def, const vn_network *const **networks) {
    *networks = def->network != NULL ? &def->network : def->networks;
    return def->network != NULL ? 1 : def->network_count;
}

// ---- where the voxels are

static bool is_given(const vn_box *box) {
    for (int k = 0; k < 3; k++) {
        if (box->min[k] != 0 || box->max[k] != 0) {
            return true;
        }
    }
    return false;
}

static void include(vn_box *box, const double p[3], double radius) {
    for (int k = 0; k < 3; k++) {
        box->min[k] = fmin(box->min[k], p[k] - radius);
        box->max[k] = fmax(box->max[k], p[k] + radius);
    }
}

static void include_edge(vn_box *box, const vn_network *network, int32_t edge, double radius) {
    double p[3];
    int32_t a, b;
    vn_network_edge_ends(network, edge, &a, &b);
    vn_network_position(network, b, p);
    include(box, p, radius);
    if (a >= 0) {
        vn_network_position(network, a, p);
        include(box, p, radius);
    }
}

static double join_radius(const vn_network *network, int32_t join) {
    int32_t a, b;
    double radius;
    vn_network_join_ends(network, join, &a, &b, &radius);
    return radius;
}

static vn_box bounds_of(const vn_network *const *networks, int32_t count) {
    vn_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (int32_t n = 0; n < count; n++) {
        for (int32_t i = 0; i < vn_network_count(networks[n]); i++) {
            include_edge(&box, networks[n], i, vn_network_radius(networks[n], i));
        }
        for (int32_t j = 0; j < vn_network_join_count(networks[n]); j++) {
            include_edge(&box, networks[n], -1 - j, join_radius(networks[n], j));
        }
    }
    return box;
}

static vn_status check_bounds(const vn_box *box, int dim, bool given) {
    static const char names[] = "xyz";
    for (int k = 0; k < dim; k++) {
        double extent = box->max[k] - box->min[k];
        if (!isfinite(extent) || (given && !(extent > 0))) {
            return vn_fail(VN_INVALID, "voxels.bounds go from %g to %g in %c: %s", box->min[k], box->max[k],
                           names[k],
                           given ? "give finite numbers, min below max"
                                 : "there is nothing to cover; give the network nodes, or `bounds`");
        }
    }
    return VN_OK;
}

static vn_status choose_side(vn_voxel_grid *grid, const vn_voxels_def *def, const vn_box *box,
                             int32_t margin) {
    double longest = 0;
    for (int k = 0; k < grid->dim; k++) {
        longest = fmax(longest, box->max[k] - box->min[k]);
    }
    int32_t size = def->size > 0 ? def->size : USUAL_SIZE;
    grid->side = def->resolution;
    if (!(grid->side > 0)) {
        if (size <= 2 * margin) {
            return vn_fail(VN_INVALID,
                           "voxels.margin = %d voxels on both sides leaves nothing of %d voxels: give "
                           "a larger voxels.size",
                           margin, size);
        }
        grid->side = longest > 0 ? longest / (size - 2 * margin) : 1;
    }
    return grid->side > 0
               ? VN_OK
               : vn_fail(VN_INVALID, "voxels: %g is too small to cut into %d voxels; use another unit",
                         longest, size);
}

// A side that is a whole number of voxels but for rounding has that number.
static vn_status choose_sizes(vn_voxel_grid *grid, const vn_box *box, int32_t margin) {
    double sizes[3] = {1, 1, 1};
    for (int k = 0; k < grid->dim; k++) {
        double voxels = ceil((box->max[k] - box->min[k]) / grid->side * (1 - 1e-12));
        sizes[k] = fmax(voxels, 1) + 2.0 * margin;
        grid->origin[k] = box->min[k] + (0.5 - margin) * grid->side;
    }
    for (int k = 0; k < 3; k++) {
        if (sizes[k] > VN_LINE_SIDE || sizes[0] * sizes[1] * sizes[2] > INT32_MAX) {
            return vn_fail(
                VN_LIMIT,
                "voxels.resolution = %g makes %.0f x %.0f x %.0f voxels, beyond 2^20 along a side or "
                "2^31 - 1 in all: give a coarser one, a `size`, or narrower `bounds`",
                grid->side, sizes[0], sizes[1], sizes[2]);
        }
        grid->size[k] = (int32_t)sizes[k];
    }
    return VN_OK;
}

vn_status vn_voxel_grid_lay(vn_voxel_grid *grid, const vn_voxels_def *def) {
    const vn_network *const *networks;
    int32_t count = vn_voxels_networks(def, &networks);
    bool given = is_given(&def->bounds);
    *grid = (vn_voxel_grid){.dim = vn_network_dim(networks[0])};
    vn_box box = given ? def->bounds : bounds_of(networks, count);
    VN_TRY(check_bounds(&box, grid->dim, given));
    int32_t margin = def->margin >= 0 ? def->margin : (given ? 0 : 1);
    VN_TRY(choose_side(grid, def, &box, margin));
    return choose_sizes(grid, &box, margin);
}

// ---- what the voxels of an edge say

typedef VN_ARRAY(int32_t) column;

typedef struct gathering {
    vn_tubes *tubes;
    const vn_voxel_grid *grid;
    double reach, most;
    int content;
    const vn_network *network; // the one at hand
    const int32_t *numbers;    // its orders, or the far ends of branches
    double base;               // what its first number is added to
} gathering;

// The node at which the branch of each node's edge ends.
static vn_status find_far_ends(const vn_network *network, column *far) {
    int32_t count = vn_network_count(network);
    VN_TRY(vn_array_zero(far, count));
    for (int32_t j = 0; j < vn_network_join_count(network); j++) {
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): a join has nodes
        far->data[network->joins.data[j].a] = far->data[network->joins.data[j].b] = 1;
    }
    for (int32_t k = count - 1; k >= 0; k--) {
        int32_t node = vn_network_nth(network, k);
        int32_t child = vn_network_first_child(network, node);
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): room for every node
        bool goes_on = child >= 0 && vn_network_next_child(network, child) < 0 && far->data[node] == 0;
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): room for every node
        far->data[node] = goes_on ? far->data[child] : node;
    }
    return VN_OK;
}

static vn_status find_numbers(gathering *g, column *own) {
    g->numbers = NULL;
    if (g->content == VN_VOXELS_SEGMENT) {
        VN_TRY(find_far_ends(g->network, own));
        g->numbers = own->data;
    } else if (g->content == VN_VOXELS_ORDER) {
        g->numbers = vn_network_orders(g->network);
        if (g->numbers == NULL) {
            vn_orders_def strahler = vn_orders_def_default();
            // NOLINTNEXTLINE(clang-analyzer-core.NonNullParamChecker): room for every node
            VN_TRY(vn_array_zero(own, vn_network_count(g->network)));
            VN_TRY(vn_network_compute_orders(g->network, &strahler, own->data));
            g->numbers = own->data;
        }
    }
    return VN_OK;
}

static double value_of(const gathering *g, int32_t edge, int32_t a, int32_t b, double radius) {
    switch (g->content) {
    case VN_VOXELS_LABEL:
        return g->base + 1;
    case VN_VOXELS_TREE:
        return g->base + 1 + vn_network_tree(g->network)[edge < 0 ? a : b];
    case VN_VOXELS_ORDER:
        return edge < 0 && g->numbers[a] > g->numbers[b] ? g->numbers[a] : g->numbers[b];
    case VN_VOXELS_SEGMENT:
        return g->base + 1 + (edge < 0 ? vn_network_count(g->network) - 1.0 - edge : g->numbers[b]);
    case VN_VOXELS_RADIUS:
        return radius;
    default:
        return 1;
    }
}

// How many numbers a network takes.
static double numbers_of(int content, const vn_network *network) {
    if (content == VN_VOXELS_LABEL) {
        return 1;
    }
    if (content == VN_VOXELS_TREE) {
        return network->roots;
    }
    return (double)vn_network_count(network) + vn_network_join_count(network);
}

// ---- tubes

// Whether anything of it can touch the volume; what cannot is cut off.
static bool cut(vn_tube *tube, const vn_voxel_grid *grid, double reach) {
    double from = 0, to = 1, a[3], d[3];
    for (int k = 0; k < 3; k++) {
        a[k] = tube->a[k];
        d[k] = tube->b[k] - tube->a[k];
        vn_narrow(a[k], d[k], -0.5 - reach, grid->size[k] - 0.5 + reach, &from, &to);
    }
    for (int k = 0; k < 3 && from <= to; k++) {
        tube->a[k] = from > 0 ? a[k] + from * d[k] : tube->a[k];
        tube->b[k] = to < 1 ? a[k] + to * d[k] : tube->b[k];
    }
    return from <= to;
}

static bool is_beside(const vn_tube *tube, const vn_voxel_grid *grid, double reach) {
    for (int k = 0; k < grid->dim; k++) {
        double low = fmin(tube->a[k], tube->b[k]), high = fmax(tube->a[k], tube->b[k]);
        if (high < -0.5 - reach || low > grid->size[k] - 0.5 + reach) {
            return true;
        }
    }
    return false;
}

static vn_status check_length(const vn_tube *tube, const vn_voxel_grid *grid) {
    for (int k = 0; k < grid->dim; k++) {
        double farthest = fmax(fabs(tube->a[k]), fabs(tube->b[k]));
        if (!(farthest <= 1e12)) {
            return vn_fail(VN_LIMIT,
                           "voxels.resolution = %g: an edge is %g voxels long, above 1e12; give a "
                           "coarser one",
                           grid->side, farthest);
        }
    }
    return VN_OK;
}

static void place(const vn_voxel_grid *grid, const vn_network *network, int32_t node, double p[3]) {
    vn_network_position(network, node, p);
    for (int k = 0; k < 3; k++) {
        p[k] = k < grid->dim ? (p[k] - grid->origin[k]) / grid->side : 0;
    }
}

static vn_status add_tube(gathering *g, int32_t edge, double radius) {
    int32_t a, b;
    vn_network_edge_ends(g->network, edge, &a, &b);
    if (a < 0 && vn_network_first_child(g->network, b) >= 0) {
        return VN_OK;
    }
    vn_tube tube = {.radius = radius / g->grid->side, .value = value_of(g, edge, a, b, radius)};
    double reach = tube.radius + g->reach + 2;
    place(g->grid, g->network, a < 0 ? b : a, tube.a);
    place(g->grid, g->network, b, tube.b);
    if (tube.value > g->most) {
        return vn_fail(VN_LIMIT,
                       "voxels: there would be number %.0f, and the largest that this content has is "
                       "%.0f: make volumes of parts of the network, or ask for another content",
                       tube.value, g->most);
    }
    if (is_beside(&tube, g->grid, reach)) {
        return VN_OK;
    }
    VN_TRY(check_length(&tube, g->grid));
    return cut(&tube, g->grid, reach) ? vn_array_push(g->tubes, tube) : VN_OK;
}

static vn_status gather_network(gathering *g) {
    int32_t count = vn_network_count(g->network);
    for (int32_t i = 0; i < count; i++) {
        VN_TRY(add_tube(g, i, vn_network_radius(g->network, i)));
    }
    for (int32_t j = 0; j < vn_network_join_count(g->network); j++) {
        VN_TRY(add_tube(g, -1 - j, join_radius(g->network, j)));
    }
    g->base += numbers_of(g->content, g->network);
    return VN_OK;
}

vn_status vn_tubes_gather(vn_tubes *tubes, const vn_voxel_grid *grid, const vn_voxels_def *def, double reach,
                          double most) {
    gathering g = {.tubes = tubes, .grid = grid, .reach = reach, .most = most, .content = def->content};
    const vn_network *const *networks;
    int32_t count = vn_voxels_networks(def, &networks);
    vn_status status = VN_OK;
    for (int32_t n = 0; n < count && status == VN_OK; n++) {
        column own = {0};
        g.network = networks[n];
        status = find_numbers(&g, &own);
        if (status == VN_OK) {
            status = gather_network(&g);
        }
        vn_array_free(&own);
    }
    return status;
}
