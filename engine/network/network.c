#include "network/berth.h"

#include "base/memory.h"

static const vn_network_def network_default = {.dim = 2, .max_nodes = 100000000, .unit = ""};

static const vn_field network_fields[] = {
    {"dim", VN_I32, 0, offsetof(vn_network_def, dim), 2, 3, "", NULL, "dimensions: 2 or 3"},
    {"max_nodes", VN_I32, 0, offsetof(vn_network_def, max_nodes), 1, INT32_MAX, "nodes", NULL,
     "a network that would grow beyond it fails; guards against a script that runs away"},
    {"unit", VN_TEXT, 0, offsetof(vn_network_def, unit), 0, 0, "", NULL,
     "the script's length unit (\"mm\"), carried into files"},
    {"murray", VN_MIXED, 0, 0, 0, 0, "", "table {exponent=, tip_radius=, veinlets=}",
     "radii by Murray's law, kept up to date as the network grows"},
};
const vn_schema vn_network_schema = VN_SCHEMA("network", "An empty network", network_fields, network_default);

vn_network_def vn_network_def_default(void) {
    return network_default;
}

vn_status vn_network_create(vn_network **out, const vn_network_def *def) {
    *out = NULL;
    VN_TRY(vn_check_def(&vn_network_schema, def));
    vn_network *network = VN_NEW(vn_network);
    char *unit = vn_copy_text(def->unit != NULL ? def->unit : "");
    if (network == NULL || unit == NULL) {
        VN_DELETE(network);
        vn_free_text(unit);
        return vn_fail_memory("a network", sizeof *network);
    }
    network->dim = def->dim;
    network->max_nodes = def->max_nodes;
    network->unit = unit;
    network->serial = vn_next_serial();
    *out = network;
    return VN_OK;
}

void vn_network_destroy(vn_network *network) {
    if (network == NULL) {
        return;
    }
    vn_array_free(&network->x);
    vn_array_free(&network->y);
    vn_array_free(&network->z);
    vn_array_free(&network->parent);
    vn_array_free(&network->first_child);
    vn_array_free(&network->next_child);
    vn_array_free(&network->tree);
    vn_array_free(&network->birth);
    vn_array_free(&network->tips);
    vn_array_free(&network->pending);
    vn_array_free(&network->radius);
    vn_array_free(&network->joins);
    vn_array_free(&network->joined);
    vn_demand_free(&network->demand);
    vn_array_free(&network->orders);
    vn_array_free(&network->flow);
    vn_array_free(&network->pressure);
    vn_array_free(&network->join_flow);
    vn_array_free(&network->headings);
    vn_array_free(&network->sequence);
    vn_point_grid_free(&network->grid);
    vn_point_tree_free(&network->tree_of_points);
    vn_edge_grid_free(&network->edges);
    vn_berth_free(&network->berth);
    vn_delaunay_destroy(network->delaunay);
    vn_free_text(network->unit);
    VN_DELETE(network);
}

vn_status vn_network_reserve(vn_network *network, int64_t need) {
    VN_TRY(vn_array_reserve(&network->x, need));
    VN_TRY(vn_array_reserve(&network->y, need));
    if (network->dim == 3) {
        VN_TRY(vn_array_reserve(&network->z, need));
    }
    VN_TRY(vn_array_reserve(&network->parent, need));
    VN_TRY(vn_array_reserve(&network->first_child, need));
    VN_TRY(vn_array_reserve(&network->next_child, need));
    VN_TRY(vn_array_reserve(&network->tree, need));
    VN_TRY(vn_array_reserve(&network->birth, need));
    if (network->murray) {
        VN_TRY(vn_array_reserve(&network->tips, need));
        VN_TRY(vn_array_reserve(&network->pending, network->pending.count + 1));
    }
    if (vn_demand_rules(network)) {
        VN_TRY(vn_demand_reserve(network, need, network->joins.count));
    }
    if (network->radius.count > 0) {
        VN_TRY(vn_array_reserve(&network->radius, need));
    }
    if (network->sequence.count > 0) {
        VN_TRY(vn_array_reserve(&network->sequence, need));
    }
    return VN_OK;
}

static void push_node(vn_network *network, int32_t parent, const double p[3]) {
    int32_t node = network->x.count;
    network->x.data[network->x.count++] = p[0];
    network->y.data[network->y.count++] = p[1];
    if (network->dim == 3) {
        network->z.data[network->z.count++] = p[2];
    }
    network->parent.data[network->parent.count++] = parent;
    network->first_child.data[network->first_child.count++] = -1;
    int32_t sibling = parent >= 0 ? network->first_child.data[parent] : -1;
    network->next_child.data[network->next_child.count++] = sibling;
    int32_t tree = parent >= 0 ? network->tree.data[parent] : network->roots++;
    network->tree.data[network->tree.count++] = tree;
    network->birth.data[network->birth.count++] = network->step;
    if (parent >= 0) {
        network->first_child.data[parent] = node;
    }
    if (network->sequence.count > 0) {
        network->sequence.data[network->sequence.count++] = node;
    }
    if (network->radius.count > 0) {
        double radius = parent >= 0 ? network->radius.data[parent] : 0;
        network->radius.data[network->radius.count++] = radius;
    }
    if (network->murray) {
        network->tips.data[network->tips.count++] = 1;
        if (sibling >= 0 && !network->recount) {
            network->pending.data[network->pending.count++] = parent;
            network->recount = network->pending.count > node / 1024 + 16;
        }
    }
    network->version++;
}

vn_status vn_network_make_room(vn_network *network, const double p[3]) {
    int32_t count = network->x.count;
    if (!vn_finite(p)) {
        return vn_fail(VN_INVALID, "a node at (%g, %g, %g) is not finite", p[0], p[1], p[2]);
    }
    if (count >= network->max_nodes) {
        return vn_fail(VN_LIMIT,
                       "the network has reached network.max_nodes = %d nodes (raise it, or grow less)",
                       network->max_nodes);
    }
    return vn_network_reserve(network, (int64_t)count + 1);
}

static vn_status add_node(vn_network *network, int32_t parent, const double p[3], int32_t *node) {
    int32_t count = network->x.count;
    if (node != NULL) {
        *node = -1;
    }
    VN_TRY(vn_network_make_room(network, p));
    push_node(network, parent, p);
    if (node != NULL) {
        *node = count;
    }
    return VN_OK;
}

vn_status vn_network_root(vn_network *network, const double p[3], int32_t *node) {
    return add_node(network, -1, p, node);
}

vn_status vn_network_add(vn_network *network, int32_t parent, const double p[3], int32_t *node) {
    if (parent < 0 || parent >= network->x.count) {
        if (node != NULL) {
            *node = -1;
        }
        return vn_fail(VN_INVALID, "a parent must be one of the %d nodes there are", network->x.count);
    }
    return add_node(network, parent, p, node);
}

vn_status vn_network_set_heading(vn_network *network, int32_t root, const double direction[3]) {
    double length = hypot(hypot(direction[0], direction[1]), direction[2]);
    if (root < 0 || root >= network->x.count || network->parent.data[root] >= 0) {
        return vn_fail(VN_INVALID, "heading: only a root has one, and this node has a parent");
    }
    if (!(length > 0 && length <= VN_HUGE)) {
        return vn_fail(VN_INVALID, "heading: (%g, %g, %g) is no direction", direction[0], direction[1],
                       direction[2]);
    }
    network->turned++;
    vn_heading heading = {root, {direction[0] / length, direction[1] / length, direction[2] / length}};
    network->version++;
    for (int32_t i = 0; i < network->headings.count; i++) {
        if (network->headings.data[i].root == root) {
            network->headings.data[i] = heading;
            return VN_OK;
        }
    }
    return vn_array_push(&network->headings, heading);
}

bool vn_network_heading(const vn_network *network, int32_t root, double direction[3]) {
    for (int32_t i = 0; i < network->headings.count; i++) {
        if (network->headings.data[i].root == root) {
            memcpy(direction, network->headings.data[i].direction, 3 * sizeof *direction);
            return true;
        }
    }
    return false;
}

void vn_network_set_step(vn_network *network, int32_t step) {
    network->step = step;
}

int32_t vn_network_step(const vn_network *network) {
    return network->step;
}

int vn_network_dim(const vn_network *network) {
    return network->dim;
}

const char *vn_network_unit(const vn_network *network) {
    return network->unit;
}

int32_t vn_network_count(const vn_network *network) {
    return network->x.count;
}

const double *vn_network_x(const vn_network *network) {
    return network->x.data;
}

const double *vn_network_y(const vn_network *network) {
    return network->y.data;
}

const double *vn_network_z(const vn_network *network) {
    return network->dim == 3 ? network->z.data : NULL;
}

const int32_t *vn_network_parent(const vn_network *network) {
    return network->parent.data;
}

const int32_t *vn_network_tree(const vn_network *network) {
    return network->tree.data;
}

const int32_t *vn_network_birth(const vn_network *network) {
    return network->birth.data;
}

int32_t vn_network_first_child(const vn_network *network, int32_t node) {
    return network->first_child.data[node];
}

int32_t vn_network_next_child(const vn_network *network, int32_t child) {
    return network->next_child.data[child];
}

vn_status vn_network_order(const vn_network *network, const int32_t **order) {
    *order = NULL;
    if (network->sequence.count > 0) {
        vn_network_nth(network, 0);
        *order = network->sequence.data;
    }
    return VN_OK;
}

static vn_status check_columns(const vn_network_columns *columns) {
    for (int32_t i = 0; i < columns->count; i++) {
        double p[3] = {columns->x[i], columns->y[i], columns->dim == 3 ? columns->z[i] : 0};
        int32_t parent = columns->parent[i];
        if (!vn_finite(p)) {
            return vn_fail(VN_INVALID, "node %d at (%g, %g, %g) is not finite", i, p[0], p[1], p[2]);
        }
        if (parent < -1 || parent >= columns->count || parent == i) {
            return vn_fail(VN_INVALID,
                           "node %d has the parent %d, which must be -1 or another of the %d nodes", i,
                           parent, columns->count);
        }
        if (columns->radius != NULL && !(columns->radius[i] >= 0 && columns->radius[i] <= VN_HUGE)) {
            return vn_fail(VN_INVALID, "node %d has the radius %g, which must be 0 or more", i,
                           columns->radius[i]);
        }
    }
    return VN_OK;
}

static vn_status copy_columns(vn_network *network, const vn_network_columns *columns) {
    VN_TRY(vn_network_allot(network, columns->count));
    for (int32_t i = 0; i < columns->count; i++) {
        network->x.data[i] = columns->x[i];
        network->y.data[i] = columns->y[i];
        if (network->dim == 3) {
            network->z.data[i] = columns->z[i];
        }
        network->parent.data[i] = columns->parent[i];
        network->birth.data[i] = columns->birth != NULL ? columns->birth[i] : 0;
    }
    return VN_OK;
}

vn_status vn_network_allot(vn_network *network, int32_t count) {
    VN_TRY(vn_network_reserve(network, count));
    network->x.count = network->y.count = network->parent.count = count;
    network->z.count = network->dim == 3 ? count : 0;
    network->first_child.count = network->next_child.count = network->tree.count = network->birth.count =
        count;
    return VN_OK;
}

static void hang_children(vn_network *network) {
    int32_t count = network->x.count;
    for (int32_t i = 0; i < count; i++) {
        network->first_child.data[i] = -1;
        network->next_child.data[i] = -1;
        network->tree.data[i] = -1;
        network->step = network->birth.data[i] > network->step ? network->birth.data[i] : network->step;
    }
    for (int32_t i = 0; i < count; i++) {
        int32_t parent = network->parent.data[i];
        if (parent >= 0) {
            network->next_child.data[i] = network->first_child.data[parent];
            network->first_child.data[parent] = i;
        }
    }
}

// Nodes that a circle of parents keeps out of reach of every root are missed: then it is no forest.
vn_status vn_network_hang(vn_network *network) {
    int32_t count = network->x.count;
    bool sorted = true;
    hang_children(network);
    VN_TRY(vn_array_reserve(&network->sequence, count));
    for (int32_t i = 0; i < count; i++) {
        sorted = sorted && network->parent.data[i] < i;
        if (network->parent.data[i] < 0) {
            network->tree.data[i] = network->roots++;
        }
    }
    int32_t reached = vn_network_resequence(network);
    for (int32_t k = 0; k < reached; k++) {
        int32_t node = network->sequence.data[k];
        int32_t parent = network->parent.data[node];
        network->tree.data[node] = parent >= 0 ? network->tree.data[parent] : network->tree.data[node];
    }
    if (reached < count) {
        return vn_fail(VN_INVALID, "%d of the %d nodes hang from no root: their parents run in a circle",
                       count - reached, count);
    }
    if (sorted) {
        vn_array_free(&network->sequence);
    }
    return VN_OK;
}

vn_status vn_network_set_radii(vn_network *network, const double *radius) {
    VN_TRY(vn_array_reserve(&network->radius, network->x.count));
    memcpy(network->radius.data, radius, (size_t)network->x.count * sizeof *radius);
    network->radius.count = network->x.count;
    network->murray = false;
    network->recount = false;
    vn_array_free(&network->tips);
    vn_array_free(&network->pending);
    vn_demand_free(&network->demand);
    network->demand.version = 0;
    network->version++;
    return VN_OK;
}

vn_status vn_network_from_columns(vn_network **out, const vn_network_columns *columns) {
    *out = NULL;
    vn_network_def def = network_default;
    def.dim = columns->dim;
    def.unit = columns->unit;
    VN_TRY(check_columns(columns));
    vn_network *network;
    VN_TRY(vn_network_create(&network, &def));
    vn_status status = copy_columns(network, columns);
    status = status == VN_OK ? vn_network_hang(network) : status;
    if (status == VN_OK && columns->radius != NULL && columns->count > 0) {
        status = vn_network_set_radii(network, columns->radius);
    }
    if (status != VN_OK) {
        vn_network_destroy(network);
        return status;
    }
    *out = network;
    return VN_OK;
}

static double largest_number(const vn_network *network) {
    double largest = network->law.tip_radius;
    for (int32_t i = 0; i < network->x.count; i++) {
        double p[3];
        vn_network_position(network, i, p);
        largest = fmax(largest, fmax(fabs(p[0]), fmax(fabs(p[1]), fabs(p[2]))));
    }
    for (int32_t i = 0; i < network->radius.count; i++) {
        largest = fmax(largest, network->radius.data[i]);
    }
    return largest;
}

vn_status vn_network_scale(vn_network *network, double factor) {
    if (!(factor > 0 && factor <= VN_HUGE)) {
        return vn_fail(VN_INVALID, "network.scale: the factor %g must be above 0", factor);
    }
    if (!(largest_number(network) * factor <= VN_HUGE)) {
        return vn_fail(VN_INVALID, "network.scale: the factor %g takes coordinates beyond %g", factor,
                       VN_HUGE);
    }
    for (int32_t i = 0; i < network->x.count; i++) {
        network->x.data[i] *= factor;
        network->y.data[i] *= factor;
        if (network->dim == 3) {
            network->z.data[i] *= factor;
        }
    }
    for (int32_t i = 0; i < network->radius.count; i++) {
        network->radius.data[i] *= factor;
    }
    for (int32_t i = 0; i < network->joins.count; i++) {
        network->joins.data[i].radius *= factor;
    }
    network->law.tip_radius *= factor;
    network->version++;
    network->moved++;
    return VN_OK;
}

static double typical_spacing(const vn_network *network) {
    double low[3], high[3];
    vn_points points = vn_network_points(network);
    double size = vn_points_extent(&points, 0, network->x.count, low, high);
    double cells = network->dim == 3 ? cbrt((double)network->x.count) : sqrt((double)network->x.count);
    return size > 0 ? 2 * size / cells : 1;
}

vn_status vn_network_grid(vn_network *network, double reach, const vn_point_grid **grid) {
    vn_point_grid *g = &network->grid;
    bool grown = network->x.count > network->grid_count + network->grid_count / 4 + 64;
    bool fits = reach <= 0 ? g->cell > 0 : vn_point_grid_fits(g, reach, grown);
    bool outgrown = g->cell > 0 && reach <= 0 && network->x.count > 16 * ((int64_t)network->grid_count + 4);
    if (!fits || outgrown || network->grid_moved != network->moved) {
        vn_point_grid_free(g);
        vn_point_grid_init(g, network->dim, reach > 0 ? reach : typical_spacing(network));
        network->grid_moved = network->moved;
        network->grid_count = network->x.count;
    }
    vn_points points = vn_network_points(network);
    *grid = g;
    return vn_point_grid_update(g, &points, network->x.count);
}
