// A tree as a network, written straight into its columns: a tree of a million terminals has no room for
// copies.
#include "cco/cco.h"

// Nodes of `from` come first, then the root's first terminal, then pairs.
static int32_t birth_of(int32_t first, int32_t node) {
    return node < first ? 0 : (node - first) / 2 + 1;
}

static void fill_places(const vn_grower *g, vn_network *n) {
    for (int32_t i = 0; i < n->x.count; i++) {
        const vn_vessel *v = vn_vessel_of(g, i);
        n->x.data[i] = v->p[0];
        n->y.data[i] = v->p[1];
        if (n->dim == 3) {
            n->z.data[i] = v->p[2];
        }
        n->parent.data[i] = v->parent;
        n->birth.data[i] = birth_of(g->first_born, i);
    }
}

// Parents before children, from the root down.
static void fill_radii(const vn_grower *g, const vn_network *n, double *radius) {
    for (int32_t k = 0; k < n->x.count; k++) {
        int32_t node = vn_network_nth(n, k);
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

// What Poiseuille's law takes from the pressure along a vessel; kappa is the factor times the whole drop.
static double drop_along(const vn_grower *g, const vn_vessel *v, double radius) {
    double square = radius * radius;
    return g->tree.factor * (g->pressure_in - g->pressure_out) * v->flow * v->length / (square * square);
}

static void fill_flow(const vn_grower *g, vn_network *n) {
    double sign = g->venous ? -1 : 1, *pressure = n->pressure.data;
    for (int32_t k = 0; k < n->x.count; k++) {
        int32_t node = vn_network_nth(n, k);
        const vn_vessel *v = vn_vessel_of(g, node);
        double root = g->venous ? g->pressure_out : g->pressure_in;
        n->flow.data[node] = sign * v->flow;
        pressure[node] =
            v->parent < 0 ? root : pressure[v->parent] - sign * drop_along(g, v, n->radius.data[node]);
    }
}

static vn_status fill(const vn_grower *g, vn_network *n) {
    int32_t count = g->tree.vessels.count;
    VN_TRY(vn_network_allot(n, count));
    fill_places(g, n);
    VN_TRY(vn_network_hang(n));
    VN_TRY(vn_array_zero(&n->radius, count));
    VN_TRY(vn_array_zero(&n->flow, count));
    VN_TRY(vn_array_zero(&n->pressure, count));
    fill_radii(g, n, n->radius.data);
    fill_flow(g, n);
    n->version++;
    n->flow_version = n->version;
    return VN_OK;
}

vn_status vn_cco_network(const vn_cco *cco, int32_t tree, vn_network **out) {
    const char *unit = vn_domain_unit(cco->def.domain);
    vn_network_def def = vn_network_def_default();
    def.dim = cco->dim;
    def.unit = unit[0] != '\0' ? unit : "mm";
    VN_TRY(vn_network_create(out, &def));
    vn_status status = fill(vn_cco_tree_at(cco, tree), *out);
    if (status != VN_OK) {
        vn_network_destroy(*out);
        *out = NULL;
    }
    return status;
}
