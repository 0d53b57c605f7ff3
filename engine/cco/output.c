// A tree as a network.
#include "cco/cco.h"

/// Columns that a network is made of.
typedef struct columns {
    VN_ARRAY(double) x;
    VN_ARRAY(double) y;
    VN_ARRAY(double) z;
    VN_ARRAY(double) radius;
    VN_ARRAY(double) flow;
    VN_ARRAY(double) pressure;
    VN_ARRAY(int32_t) parent;
    VN_ARRAY(int32_t) birth;
} columns;

static void free_columns(columns *c) {
    vn_array_free(&c->x);
    vn_array_free(&c->y);
    vn_array_free(&c->z);
    vn_array_free(&c->radius);
    vn_array_free(&c->flow);
    vn_array_free(&c->pressure);
    vn_array_free(&c->parent);
    vn_array_free(&c->birth);
}

static vn_status reserve(columns *c, int32_t count) {
    VN_TRY(vn_array_reserve(&c->x, count));
    VN_TRY(vn_array_reserve(&c->y, count));
    VN_TRY(vn_array_reserve(&c->z, count));
    VN_TRY(vn_array_reserve(&c->radius, count));
    VN_TRY(vn_array_reserve(&c->parent, count));
    return vn_array_reserve(&c->birth, count);
}

// Nodes of `from` come first, then the root's first terminal, then pairs.
static int32_t birth_of(int32_t first, int32_t node) {
    return node < first ? 0 : (node - first) / 2 + 1;
}

static void fill_places(const vn_grower *g, columns *c) {
    for (int32_t i = 0; i < g->tree.vessels.count; i++) {
        const vn_vessel *v = vn_vessel_of(g, i);
        c->x.data[i] = v->p[0];
        c->y.data[i] = v->p[1];
        c->z.data[i] = v->p[2];
        c->parent.data[i] = v->parent;
        c->birth.data[i] = birth_of(g->first_born, i);
    }
}

// Parents before children, from the root down.
static void fill_radii(const vn_grower *g, const vn_network *network, double *radius) {
    for (int32_t k = 0; k < g->tree.vessels.count; k++) {
        int32_t node = vn_network_nth(network, k);
        vn_fork fork = vn_tree_fork(&g->tree, node, -1, NULL);
        const vn_vessel *v = vn_vessel_of(g, node);
        double thickest = 0;
        for (int32_t child = v->first_child; child >= 0; child = vn_vessel_of(g, child)->next_child) {
            const vn_vessel *c = vn_vessel_of(g, child);
            radius[child] = v->parent < 0 ? sqrt(sqrt(g->tree.factor * c->flow * c->resistance))
                                          : radius[node] * vn_tree_beta(&g->tree, child, &fork);
            thickest = fmax(thickest, radius[child]);
        }
        radius[node] = v->parent < 0 ? thickest : radius[node];
    }
}

static void fill_flow(const vn_grower *g, const vn_network *network, const double *radius, columns *c) {
    double drop = g->pressure_in - g->pressure_out, sign = g->venous ? -1 : 1;
    for (int32_t k = 0; k < g->tree.vessels.count; k++) {
        int32_t node = vn_network_nth(network, k);
        const vn_vessel *v = vn_vessel_of(g, node);
        double square = radius[node] * radius[node];
        c->flow.data[node] = sign * v->flow;
        c->pressure.data[node] = v->parent < 0
                                     ? (g->venous ? g->pressure_out : g->pressure_in)
                                     : c->pressure.data[v->parent] - sign * g->tree.factor * drop * v->flow *
                                                                         v->length / (square * square);
    }
}

static vn_status make(const vn_cco *cco, const vn_grower *g, columns *c, vn_network **out) {
    int32_t count = g->tree.vessels.count;
    VN_TRY(reserve(c, count));
    fill_places(g, c);
    vn_network_columns whole = {.dim = cco->dim,
                                .count = count,
                                .x = c->x.data,
                                .y = c->y.data,
                                .z = c->z.data,
                                .parent = c->parent.data,
                                .birth = c->birth.data,
                                .unit = vn_domain_unit(cco->def.domain)};
    whole.unit = whole.unit[0] != '\0' ? whole.unit : "mm";
    VN_TRY(vn_network_from_columns(out, &whole));
    fill_radii(g, *out, c->radius.data);
    VN_TRY(vn_network_set_radii(*out, c->radius.data));
    VN_TRY(vn_array_reserve(&c->flow, count));
    VN_TRY(vn_array_reserve(&c->pressure, count));
    fill_flow(g, *out, c->radius.data, c);
    return vn_network_set_flow(*out, c->flow.data, c->pressure.data);
}

vn_status vn_cco_network(const vn_cco *cco, int32_t tree, vn_network **out) {
    columns c = {0};
    *out = NULL;
    vn_status status = make(cco, vn_cco_tree_at(cco, tree), &c, out);
    free_columns(&c);
    if (status != VN_OK) {
        vn_network_destroy(*out);
        *out = NULL;
    }
    return status;
}
