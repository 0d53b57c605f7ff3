// Orders of segments, the elements that they make, and what changes from order to order.

#include "network/vessels.h"

typedef VN_ARRAY(int32_t) index_array;

typedef struct ordering {
    vn_vessel_measures *out;
    const vn_branches *branches;
    index_array order; // of each branch, from 1
    int32_t highest;
} ordering;

static int32_t highest_of(const index_array *order) {
    int32_t highest = 0;
    for (int32_t i = 0; i < order->count; i++) {
        highest = order->data[i] > highest ? order->data[i] : highest;
    }
    return highest;
}

// All edges of a segment have one order.
static vn_status order_by_strahler(ordering *o, const vn_network *network) {
    const vn_orders_def strahler = {.kind = VN_STRAHLER};
    index_array of_nodes = {0};
    VN_TRY(vn_array_zero(&o->order, o->branches->list.count));
    VN_TRY(vn_array_zero(&of_nodes, network->x.count));
    vn_status status = vn_network_compute_orders(network, &strahler, of_nodes.data);
    for (int32_t i = 0; status == VN_OK && i < o->branches->list.count; i++) {
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): an order for every node
        o->order.data[i] = of_nodes.data[o->branches->list.data[i].first];
    }
    vn_array_free(&of_nodes);
    o->highest = highest_of(&o->order);
    return status;
}

// ---- By diameter ----

// The limits go on creeping downwards for ever, until the highest order has swallowed most others: so it is
// that authors stop at a hundredth. (Tried: orders by those ranges alone, without regard to daughters. They
// creep faster, and may leave a single one.)
enum { MOST_ROUNDS = 100 };
static const double SETTLED = 0.01;

typedef struct diameter_class {
    int32_t count;
    vn_spread diameter;
    double limit;  // what is thicker is of a higher order
    double before; // the mean a round ago, or 0
} diameter_class;

typedef VN_ARRAY(diameter_class) class_array;

static void survey_classes(const ordering *o, class_array *classes) {
    for (int32_t k = 0; k < classes->count; k++) {
        classes->data[k] = (diameter_class){.before = classes->data[k].diameter.mean};
    }
    for (int32_t i = 0; i < o->order.count; i++) {
        diameter_class *one = &classes->data[o->order.data[i] - 1];
        one->count++;
        vn_spread_add(&one->diameter, one->count, vn_branch_diameter(&o->branches->list.data[i]));
    }
    for (int32_t k = 0; k < classes->count; k++) {
        vn_spread_end(&classes->data[k].diameter, classes->data[k].count);
    }
}

static bool is_settled(const class_array *classes) {
    for (int32_t k = 0; k < classes->count; k++) {
        double mean = classes->data[k].diameter.mean, before = classes->data[k].before;
        if (fabs(mean - before) > SETTLED * before) {
            return false;
        }
    }
    return true;
}

// Of several wide spreads the limits may be the wrong way round: a higher one is at least the one below.
static void set_limits(class_array *classes) {
    double least = -INFINITY;
    for (int32_t k = 0; k + 1 < classes->count; k++) {
        const vn_spread *low = &classes->data[k].diameter, *high = &classes->data[k + 1].diameter;
        double between = (low->mean + low->deviation + high->mean - high->deviation) / 2;
        least = fmax(least, between);
        classes->data[k].limit = least;
    }
    classes->data[classes->count - 1].limit = INFINITY;
}

// From the tips, which stay of order 1: a segment has the highest order of its daughters, or the next one
// when it is too thick for that.
static void assign_orders(ordering *o, const class_array *classes, index_array *below) {
    const vn_branch *list = o->branches->list.data;
    for (int32_t i = 0; i < below->count; i++) {
        below->data[i] = 0;
    }
    for (int32_t i = o->order.count - 1; i >= 0; i--) {
        int32_t highest = below->data[i], before = list[i].before;
        bool thicker = highest > 0 && vn_branch_diameter(&list[i]) > classes->data[highest - 1].limit;
        int32_t order = highest > 0 ? highest + thicker : 1;
        o->order.data[i] = order;
        if (before >= 0 && order > below->data[before]) {
            below->data[before] = order;
        }
    }
    o->highest = highest_of(&o->order);
}

static void settle_orders(ordering *o, class_array *classes, index_array *below) {
    for (int round = 0; round < MOST_ROUNDS; round++) {
        bool same = classes->count == o->highest; // the highest may have been lost
        classes->count = o->highest;
        survey_classes(o, classes);
        if (round > 0 && same && is_settled(classes)) {
            return;
        }
        set_limits(classes);
        assign_orders(o, classes, below);
    }
}

static vn_status order_by_diameter(ordering *o) {
    class_array classes = {0};
    index_array below = {0};
    if (o->highest == 0) {
        return VN_OK;
    }
    vn_status status = vn_array_zero(&below, o->order.count);
    status = status == VN_OK ? vn_array_zero(&classes, o->highest) : status;
    if (status == VN_OK) {
        settle_orders(o, &classes, &below);
    }
    vn_array_free(&classes);
    vn_array_free(&below);
    return status;
}

// ---- Elements ----

// The branch that goes on with the element of the one before: of its order, the thickest, then of the least
// index.
static bool leads(const ordering *o, int32_t branch, int32_t heir) {
    const vn_branch *list = o->branches->list.data;
    if (heir < 0) {
        return true;
    }
    double mine = vn_branch_diameter(&list[branch]), its = vn_branch_diameter(&list[heir]);
    return mine > its || (mine == its && list[branch].first < list[heir].first);
}

static vn_status find_elements(ordering *o, int32_t *element) {
    const vn_branches *b = o->branches;
    index_array heirs = {0};
    VN_TRY(vn_array_reserve(&heirs, b->list.count));
    for (int32_t i = 0; i < b->list.count; i++) {
        heirs.data[i] = -1;
    }
    for (int32_t i = 0; i < b->list.count; i++) {
        int32_t before = b->list.data[i].before;
        if (before >= 0 && o->order.data[before] == o->order.data[i] && leads(o, i, heirs.data[before])) {
            heirs.data[before] = i;
        }
    }
    for (int32_t i = 0; i < b->list.count; i++) {
        int32_t before = b->list.data[i].before;
        bool goes_on = before >= 0 && heirs.data[before] == i;
        element[i] = goes_on ? element[before] : o->out->elements++;
    }
    vn_array_free(&heirs);
    return VN_OK;
}

// ---- Order by order ----

static vn_status new_orders(ordering *o) {
    size_t size = (size_t)o->highest * sizeof *o->out->orders;
    o->out->orders = size > 0 ? vn_new_block(size) : NULL;
    if (size > 0 && o->out->orders == NULL) {
        return vn_fail_memory("orders", size);
    }
    o->out->order_count = o->highest;
    o->out->segments = o->order.count;
    return VN_OK;
}

static void add_segments(ordering *o) {
    for (int32_t i = 0; i < o->order.count; i++) {
        const vn_branch *branch = &o->branches->list.data[i];
        vn_vessel_order *order = &o->out->orders[o->order.data[i] - 1];
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): as many as the highest order
        order->segments++;
        vn_spread_add(&order->segment_diameter, order->segments, vn_branch_diameter(branch));
        vn_spread_add(&order->segment_length, order->segments, branch->length);
    }
}

typedef VN_ARRAY(vn_branch) branch_array;

// An element measures like one long segment; `level` stands for its order.
static vn_status join_elements(const ordering *o, const int32_t *element, branch_array *elements) {
    VN_TRY(vn_array_zero(elements, o->out->elements));
    for (int32_t i = 0; i < o->order.count; i++) {
        const vn_branch *branch = &o->branches->list.data[i];
        vn_branch *whole = &elements->data[element[i]];
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): every segment is part of one
        whole->level = o->order.data[i];
        whole->edges += branch->edges;
        whole->length += branch->length;
        whole->weighted += branch->weighted;
        whole->sum += branch->sum;
    }
    return VN_OK;
}

static void add_elements(vn_vessel_measures *out, const branch_array *elements) {
    for (int32_t i = 0; i < elements->count; i++) {
        const vn_branch *whole = &elements->data[i];
        vn_vessel_order *order = &out->orders[whole->level - 1];
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): as many as the highest order
        order->elements++;
        vn_spread_add(&order->element_diameter, order->elements, vn_branch_diameter(whole));
        vn_spread_add(&order->element_length, order->elements, whole->length);
    }
}

static void end_orders(vn_vessel_measures *out) {
    for (int32_t k = 0; k < out->order_count; k++) {
        vn_vessel_order *order = &out->orders[k];
        vn_spread_end(&order->segment_diameter, order->segments);
        vn_spread_end(&order->segment_length, order->segments);
        vn_spread_end(&order->element_diameter, order->elements);
        vn_spread_end(&order->element_length, order->elements);
    }
}

// ---- From order to order ----

typedef double order_fn(const vn_vessel_order *order);

static double count_of(const vn_vessel_order *order) {
    return order->elements;
}

static double diameter_of(const vn_vessel_order *order) {
    return order->element_diameter.mean;
}

static double length_of(const vn_vessel_order *order) {
    return order->element_length.mean;
}

static vn_order_ratio ratio_by(const vn_vessel_measures *out, order_fn *value) {
    vn_line_fit fit = {0};
    for (int32_t k = 0; k < out->order_count; k++) {
        double v = value(&out->orders[k]);
        if (v > 0) {
            vn_line_add(&fit, k, log(v));
        }
    }
    return fit.count < 2 ? (vn_order_ratio){0}
                         : (vn_order_ratio){exp(fabs(vn_line_slope(&fit))), vn_line_r2(&fit)};
}

static vn_status describe(ordering *o, const vn_network *network, int orders, int32_t *element) {
    branch_array elements = {0};
    VN_TRY(order_by_strahler(o, network));
    VN_TRY(orders == VN_ORDERS_DIAMETER ? order_by_diameter(o) : VN_OK);
    VN_TRY(find_elements(o, element));
    VN_TRY(new_orders(o));
    vn_status status = join_elements(o, element, &elements);
    if (status == VN_OK) {
        add_segments(o);
        add_elements(o->out, &elements);
        end_orders(o->out);
        o->out->bifurcation_ratio = ratio_by(o->out, count_of);
        o->out->diameter_ratio = ratio_by(o->out, diameter_of);
        o->out->length_ratio = ratio_by(o->out, length_of);
    }
    vn_array_free(&elements);
    return status;
}

vn_status vn_vessels_measure_orders(vn_vessel_measures *out, const vn_network *network,
                                    const vn_branches *branches, int orders, int32_t *element) {
    ordering o = {.out = out, .branches = branches};
    vn_status status = describe(&o, network, orders, element);
    vn_array_free(&o.order);
    return status;
}
