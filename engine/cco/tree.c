#include "cco/tree.h"

#include "space/points.h"

static const double PI = 3.14159265358979323846;

void vn_tree_free(vn_tree *tree) {
    vn_array_free(&tree->vessels);
    vn_array_free(&tree->exponents);
}

double vn_tree_exponent(const vn_tree *tree, double flow) {
    const vn_exponent *e = tree->exponents.data;
    int32_t last = tree->exponents.count - 1;
    if (flow <= e[0].flow || last == 0) {
        return e[0].exponent;
    }
    for (int32_t i = 1; i <= last; i++) {
        if (flow < e[i].flow) {
            double t = log(flow / e[i - 1].flow) / log(e[i].flow / e[i - 1].flow);
            return e[i - 1].exponent + t * (e[i].exponent - e[i - 1].exponent);
        }
    }
    return e[last].exponent;
}

vn_fork vn_tree_fork(const vn_tree *tree, int32_t node, int32_t except, const vn_branch *instead) {
    const vn_vessel *v = tree->vessels.data;
    vn_fork fork = {.flow = instead != NULL ? instead->flow : 0};
    for (int32_t c = v[node].first_child; c >= 0; c = v[c].next_child) {
        fork.flow += c != except ? v[c].flow : 0;
    }
    if (fork.flow <= 0) {
        return fork;
    }
    double exponent = vn_tree_exponent(tree, fork.flow);
    double square = instead != NULL ? instead->flow * instead->resistance : 0;
    double weighed = instead != NULL ? sqrt(square) * instead->volume : 0;
    fork.sum = instead != NULL ? vn_branch_weight(exponent, square) : 0;
    for (int32_t c = v[node].first_child; c >= 0; c = v[c].next_child) {
        if (c != except) {
            double product = v[c].flow * v[c].resistance;
            fork.sum += vn_branch_weight(exponent, product);
            weighed += sqrt(product) * v[c].volume;
        }
    }
    fork.square = vn_branches_square(exponent, fork.sum);
    fork.resistance = fork.square * fork.square / fork.flow;
    fork.volume = weighed / fork.square;
    return fork;
}

double vn_tree_beta(const vn_tree *tree, int32_t node, const vn_fork *fork) {
    const vn_vessel *v = &tree->vessels.data[node];
    return sqrt(sqrt(v->flow * v->resistance) / fork->square);
}

static double stem_square(const vn_tree *tree, double flow, double resistance) {
    return sqrt(tree->factor * flow * resistance);
}

static double stem_volume(const vn_tree *tree, const vn_branch *b) {
    return PI * stem_square(tree, b->flow, b->resistance) * b->volume;
}

static vn_branch branch_of(const vn_vessel *v) {
    return (vn_branch){v->flow, v->resistance, v->volume};
}

/// How a branch further up follows the one that was changed.
typedef struct chain {
    double resistance_by_resistance, volume_by_resistance, volume_by_volume;
    double square; ///< (radius of the changed branch / radius here)^2
} chain;

// One step of the chain rule, over the fork that `b` is one branch of.
static void follow(chain *c, const vn_branch *b, const vn_fork *fork, double exponent) {
    double product = b->flow * b->resistance;
    double share = vn_branch_weight(exponent, product) / fork->sum;
    double beta2 = sqrt(product) / fork->square;
    double by_resistance = (beta2 * b->volume - fork->volume * share) / (2 * b->resistance);
    c->volume_by_resistance = by_resistance * c->resistance_by_resistance + beta2 * c->volume_by_resistance;
    c->volume_by_volume *= beta2;
    c->resistance_by_resistance *= fork->resistance * share / b->resistance;
    c->square *= beta2;
}

/// A branch on its way up: it hangs where the segment of `node` does.
typedef struct climber {
    int32_t node;
    vn_branch branch;
    chain chain;
} climber;

static void climb_one(const vn_tree *tree, climber *c) {
    const vn_vessel *v = tree->vessels.data;
    int32_t parent = v[c->node].parent;
    vn_fork fork = vn_tree_fork(tree, parent, c->node, &c->branch);
    follow(&c->chain, &c->branch, &fork, vn_tree_exponent(tree, fork.flow));
    c->branch = (vn_branch){fork.flow, v[parent].length + fork.resistance, v[parent].length + fork.volume};
    c->node = parent;
}

vn_effect vn_tree_effect(const vn_tree *tree, int32_t node, const vn_branch *branch) {
    climber c = {node, *branch, {1, 0, 1, 1}};
    while (!vn_is_stem(tree, c.node)) {
        climb_one(tree, &c);
    }
    vn_branch b = c.branch, before = branch_of(&tree->vessels.data[c.node]);
    double square = stem_square(tree, b.flow, b.resistance);
    return (vn_effect){
        .volume = PI * square * b.volume - stem_volume(tree, &before),
        .radius = sqrt(square * c.chain.square),
        .by_resistance =
            PI * square *
            (b.volume / (2 * b.resistance) * c.chain.resistance_by_resistance + c.chain.volume_by_resistance),
        .by_volume = PI * square * c.chain.volume_by_volume,
    };
}

// ---- To first order ----

enum { ADJOINTS_BITS = 9 };

void vn_adjoints_free(vn_adjoints *adjoints) {
    vn_array_free(&adjoints->known);
}

vn_status vn_adjoints_begin(vn_adjoints *adjoints) {
    if (adjoints->known.count == 0) {
        VN_TRY(vn_array_zero(&adjoints->known, 1 << ADJOINTS_BITS));
    }
    adjoints->round++;
    return VN_OK;
}

static vn_adjoint *slot_of(const vn_adjoints *adjoints, int32_t node) {
    return &adjoints->known.data[((uint32_t)node * 2654435761u) >> (32 - ADJOINTS_BITS)];
}

static vn_adjoint of_stem(const vn_tree *tree, int32_t node) {
    vn_branch b = branch_of(&tree->vessels.data[node]);
    double volume = stem_volume(tree, &b);
    return (vn_adjoint){.node = node,
                        .by_resistance = volume / (2 * b.resistance),
                        .by_volume = volume / b.volume,
                        .by_flow = volume / (2 * b.flow)};
}

// Of a branch, from that of the segment that it hangs from.
static vn_adjoint of_branch(const vn_tree *tree, int32_t node, const vn_adjoint *above) {
    vn_branch b = branch_of(&tree->vessels.data[node]);
    vn_fork fork = vn_tree_fork(tree, above->node, -1, NULL);
    chain c = {1, 0, 1, 1};
    follow(&c, &b, &fork, vn_tree_exponent(tree, fork.flow));
    double through =
        above->by_resistance * c.resistance_by_resistance + above->by_volume * c.volume_by_resistance;
    // Resistances and flows enter by their products, but for the fork's own flow, H^4 / Q.
    return (vn_adjoint){.node = node,
                        .by_resistance = through,
                        .by_volume = above->by_volume * c.volume_by_volume,
                        .by_flow = through * b.resistance / b.flow + above->by_flow -
                                   above->by_resistance * fork.resistance / fork.flow};
}

static vn_adjoint adjoint_of(const vn_tree *tree, vn_adjoints *adjoints, int32_t node) {
    enum { AT_ONCE = 64 };
    int32_t way[AT_ONCE];
    int count = 0;
    vn_adjoint at = {.node = -1};
    for (int32_t n = node; at.node < 0; n = tree->vessels.data[n].parent) {
        const vn_adjoint *known = slot_of(adjoints, n);
        if (known->round == adjoints->round && known->node == n) {
            at = *known;
        } else if (vn_is_stem(tree, n)) {
            at = of_stem(tree, n);
        } else if (count == AT_ONCE) { // a very long way is worked out in parts
            at = adjoint_of(tree, adjoints, n);
        } else {
            way[count++] = n;
        }
    }
    while (count > 0) {
        at = of_branch(tree, way[--count], &at);
        at.round = adjoints->round;
        *slot_of(adjoints, at.node) = at;
    }
    return at;
}

vn_effect vn_tree_estimate(const vn_tree *tree, vn_adjoints *adjoints, int32_t node, const vn_branch *branch,
                           double ratio) {
    double added = branch->flow - tree->vessels.data[node].flow;
    climber c = {node, *branch, {1, 0, 1, 1}};
    while (!vn_is_stem(tree, c.node) && c.branch.flow < ratio * added) {
        climb_one(tree, &c);
    }
    vn_adjoint a = adjoint_of(tree, adjoints, c.node);
    vn_branch before = branch_of(&tree->vessels.data[c.node]);
    return (vn_effect){
        .volume = a.by_resistance * (c.branch.resistance - before.resistance) +
                  a.by_volume * (c.branch.volume - before.volume) + a.by_flow * added,
        .by_resistance =
            a.by_resistance * c.chain.resistance_by_resistance + a.by_volume * c.chain.volume_by_resistance,
        .by_volume = a.by_volume * c.chain.volume_by_volume,
    };
}

double vn_tree_volume(const vn_tree *tree) {
    double volume = 0;
    for (int32_t i = 0; i < tree->vessels.count; i++) {
        if (tree->vessels.data[i].parent >= 0 && vn_is_stem(tree, i)) {
            vn_branch b = branch_of(&tree->vessels.data[i]);
            volume += stem_volume(tree, &b);
        }
    }
    return volume;
}

static double thickest_stem(const vn_tree *tree, int32_t root) {
    const vn_vessel *v = tree->vessels.data;
    double square = 0;
    for (int32_t c = v[root].first_child; c >= 0; c = v[c].next_child) {
        square = fmax(square, stem_square(tree, v[c].flow, v[c].resistance));
    }
    return sqrt(square);
}

double vn_tree_radius(const vn_tree *tree, int32_t node) {
    const vn_vessel *v = tree->vessels.data;
    double square = 1;
    if (v[node].parent < 0) {
        return thickest_stem(tree, node);
    }
    for (; !vn_is_stem(tree, node); node = v[node].parent) {
        vn_fork fork = vn_tree_fork(tree, v[node].parent, -1, NULL);
        square *= sqrt(v[node].flow * v[node].resistance) / fork.square;
    }
    return sqrt(square * stem_square(tree, v[node].flow, v[node].resistance));
}

vn_status vn_tree_push(vn_tree *tree, int32_t parent, const double p[3], int32_t *node) {
    VN_TRY(vn_array_reserve(&tree->vessels, (int64_t)tree->vessels.count + 1));
    vn_vessel *v = tree->vessels.data;
    int32_t at = tree->vessels.count++;
    v[at] = (vn_vessel){.p = {p[0], p[1], p[2]}, .parent = parent, .first_child = -1, .next_child = -1};
    if (parent >= 0) {
        v[at].length = sqrt(vn_distance2(p, v[parent].p));
        v[at].next_child = v[parent].first_child;
        v[parent].first_child = at;
    }
    *node = at;
    return VN_OK;
}

vn_status vn_tree_split(vn_tree *tree, int32_t node, const double p[3], int32_t *middle) {
    int32_t parent = tree->vessels.data[node].parent;
    VN_TRY(vn_tree_push(tree, parent, p, middle));
    vn_vessel *v = tree->vessels.data;
    v[parent].first_child = v[*middle].next_child; // out again: it takes the place of `node`
    for (int32_t *link = &v[parent].first_child;; link = &v[*link].next_child) {
        if (*link == node) {
            v[*middle].next_child = v[node].next_child;
            *link = *middle;
            break;
        }
    }
    v[*middle].first_child = node;
    v[node].next_child = -1;
    v[node].parent = *middle;
    v[node].length = sqrt(vn_distance2(v[node].p, p));
    return VN_OK;
}

void vn_tree_refresh(vn_tree *tree, int32_t node) {
    vn_vessel *v = &tree->vessels.data[node];
    vn_fork fork = vn_tree_fork(tree, node, -1, NULL);
    v->flow = v->first_child >= 0 ? fork.flow : v->flow;
    v->resistance = v->length + fork.resistance;
    v->volume = v->length + fork.volume;
}

void vn_tree_update(vn_tree *tree, int32_t node) {
    for (; node >= 0; node = tree->vessels.data[node].parent) {
        vn_tree_refresh(tree, node);
    }
}

void vn_tree_settle_one(vn_tree *tree, int32_t node) {
    vn_vessel *v = tree->vessels.data;
    double slack = v[node].cap;
    vn_fork fork = vn_tree_fork(tree, node, -1, NULL);
    for (int32_t c = v[node].first_child; c >= 0; c = v[c].next_child) {
        slack = fmin(slack, v[c].slack / vn_tree_beta(tree, c, &fork));
    }
    v[node].slack = (float)(slack * (1 - 1e-7));
}

void vn_tree_settle(vn_tree *tree, int32_t node) {
    for (; tree->vessels.data[node].parent >= 0; node = tree->vessels.data[node].parent) {
        vn_tree_settle_one(tree, node);
    }
}
