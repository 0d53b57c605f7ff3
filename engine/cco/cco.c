// Constrained constructive optimisation: the trees of an organ, and the turns that they take.
#include "cco/cco.h"

#include "domain/domain.h"
#include "space/points.h"

static const double PI = 3.14159265358979323846;

static const vn_cco_def cco_default = {.terminals = 1000,
                                       .seed = 1,
                                       .threshold = 0.9,
                                       .spacing = 1,
                                       .candidates = 20,
                                       .most_candidates = 640,
                                       .redraws = 200,
                                       .foresight = -1,
                                       .growing_domain = true};

static const vn_field cco_fields[] = {
    {"domain", VN_OBJECT, VN_REQUIRED, offsetof(vn_cco_def, domain), 0, 0, "", "domain",
     "where everything is to lie"},
    {"terminals", VN_I32, 0, offsetof(vn_cco_def, terminals), 1, 100000000, "terminals", NULL,
     "how many each tree is to have in the end; or a list {{x, y}, …} of where they are, in their order"},
    {"seed", VN_I64, 0, offsetof(vn_cco_def, seed), -9e18, 9e18, "", NULL, "of the random terminals"},
    {"placement", VN_CHOICE, 0, offsetof(vn_cco_def, placement), 0, 0, "", "segments|terminals",
     "what a new terminal keeps away from: vessels (section 3.3.2), or terminals and the insides of vessels "
     "(Algorithms 2 and 3)"},
    {"tries", VN_I32, VN_OPTIONAL, offsetof(vn_cco_def, tries), 1, 100000000, "darts", NULL,
     "before the threshold of Equation 15 is lowered; left out: 100, or 1000 with \"terminals\""},
    {"threshold", VN_F64, VN_ABOVE_MIN, offsetof(vn_cco_def, threshold), 0, 0.999, "", NULL,
     "what the threshold is multiplied by then"},
    {"spacing", VN_F64, VN_ABOVE_MIN, offsetof(vn_cco_def, spacing), 0, 100, "", NULL,
     "the threshold at first, in units of Equation 15"},
    {"candidates", VN_I32, 0, offsetof(vn_cco_def, candidates), 1, 100000, "segments", NULL,
     "nearest segments that are tried; twice as many while none will do"},
    {"most_candidates", VN_I32, 0, offsetof(vn_cco_def, most_candidates), 1, 100000000, "segments", NULL,
     "but no more than these for one terminal, which is then drawn anew"},
    {"redraws", VN_I32, 0, offsetof(vn_cco_def, redraws), 0, 100000000, "terminals", NULL,
     "terminals drawn anew before the domain counts as full"},
    {"foresight", VN_F64, VN_OPTIONAL, offsetof(vn_cco_def, foresight), 0, 100, "", NULL,
     "room that new vessels need to thicken later: so that a subtree of m terminals may come to 1 + "
     "foresight / √m "
     "times its share of the flow; left out: 4 in space, 1 in the plane, and 0 for a list of terminals"},
    {"bifurcation", VN_CHOICE, 0, offsetof(vn_cco_def, bifurcation), 0, 0, "", "least|kamiya|ceres",
     "the bifurcation point: of least volume; by Equations 8 to 13 alone; or these with the system (12) "
     "solved by Ceres"},
    {"border_distance", VN_F64, 0, offsetof(vn_cco_def, border_distance), 0, 1e150, "length", NULL,
     "that vessels keep from the border"},
    {"growing_domain", VN_BOOL, 0, offsetof(vn_cco_def, growing_domain), 0, 0, "", NULL,
     "sizes hold as if the domain grew with the tree (Equation 14)"},
    {"density", VN_MIXED, 0, offsetof(vn_cco_def, density), 0, 0, "", "a function (x, y[, z]), or a domain",
     "how dense terminals are at a point, 0 to 1: a function (x, y[, z]), or a domain whose values count"},
};
const vn_schema vn_cco_schema =
    VN_SCHEMA("cco", "Arterial trees by constrained constructive optimisation", cco_fields, cco_default);

static const vn_cco_tree_def tree_default = {.inflow = 500000.0 / 60,
                                             .viscosity = 3.6e-3,
                                             .pressure_in = 100 * 133.322,
                                             .pressure_out = 60 * 133.322,
                                             .exponent = 3};

static const vn_field tree_fields[] = {
    {"root", VN_POINT, 0, offsetof(vn_cco_tree_def, root), -VN_HUGE, VN_HUGE, "length", NULL,
     "where the tree begins, in the domain or on its border"},
    {"from", VN_OBJECT, 0, offsetof(vn_cco_tree_def, from), 0, 0, "", "network",
     "a tree to grow on from instead: its nodes, not its radii"},
    {"inflow", VN_F64, VN_ABOVE_MIN, offsetof(vn_cco_tree_def, inflow), 0, 1e150, "mm³/s", NULL,
     "of the whole tree at the end, shared by its terminals; 500 mL/min"},
    {"terminal_flow", VN_MIXED, 0, offsetof(vn_cco_tree_def, terminal_flow), 0, 0, "mm³/s",
     "a number, a function (x, y[, z]), or a domain",
     "of each terminal, in place of inflow; or what a terminal's share of the inflow is multiplied by: a "
     "function (x, y[, z]), or a domain whose values count"},
    {"viscosity", VN_F64, VN_ABOVE_MIN, offsetof(vn_cco_tree_def, viscosity), 0, 1e150, "Pa·s", NULL,
     "of the blood"},
    {"pressure_in", VN_F64, 0, offsetof(vn_cco_tree_def, pressure_in), -1e150, 1e150, "Pa", NULL,
     "where blood enters; 100 mmHg"},
    {"pressure_out", VN_F64, 0, offsetof(vn_cco_tree_def, pressure_out), -1e150, 1e150, "Pa", NULL,
     "where it leaves; 60 mmHg"},
    {"exponent", VN_MIXED, 0, offsetof(vn_cco_tree_def, exponent), 0, 0, "",
     "a number, a list {{flow, exponent}, …}, or a function (flow)",
     "γ of Equation 4, 1 to 100; left out: 3. Or {{flow, exponent}, …} or function(flow): by the flow that "
     "comes to a bifurcation"},
    {"symmetry", VN_F64, 0, offsetof(vn_cco_tree_def, symmetry), 0, 1, "", NULL,
     "bifurcations whose thinner vessel is below this part of the thicker are refused"},
    {"venous", VN_BOOL, 0, offsetof(vn_cco_tree_def, venous), 0, 0, "", NULL,
     "blood enters at the terminals and leaves at the root"},
};
const vn_schema vn_cco_tree_schema =
    VN_SCHEMA("cco", "One tree of constrained constructive optimisation", tree_fields, tree_default);

vn_cco_def vn_cco_def_default(void) {
    return cco_default;
}

vn_cco_tree_def vn_cco_tree_def_default(void) {
    return tree_default;
}

double vn_cco_inflate(const vn_cco *cco, int32_t terminals) {
    if (!cco->def.growing_domain || terminals >= cco->def.terminals) {
        return 1;
    }
    return pow((double)terminals / cco->def.terminals, -0.75 / cco->dim);
}

static vn_status check_domain(const vn_domain *domain) {
    if (domain->kind->snap != NULL) {
        return vn_fail(VN_INVALID, "cco.domain is a surface, which has no inside: use on = \"inside\"");
    }
    return vn_domain_measure(domain) > 0 ? VN_OK : vn_fail(VN_INFEASIBLE, "cco.domain has nothing inside");
}

static vn_status check_choices(const vn_cco_def *def) {
    if (def->placement < 0 || def->placement > 1 || def->bifurcation < 0 || def->bifurcation > 2) {
        return vn_fail(VN_INVALID, "cco.placement = %d must be 0 or 1, and cco.bifurcation = %d 0, 1 or 2",
                       def->placement, def->bifurcation);
    }
    return VN_OK;
}

static vn_status check_list(const vn_cco_def *def) {
    if (def->list_count < 1) {
        return vn_fail(VN_INVALID, "cco.terminals: a list of %d points; it needs 1 or more", def->list_count);
    }
    for (int32_t i = 0; i < def->list_count; i++) {
        const double *p = &def->list[3 * (size_t)i];
        if (!vn_finite(p) || !vn_domain_contains(def->domain, p)) {
            return vn_fail(VN_INVALID, "cco.terminals: number %d at (%g, %g, %g) is outside the domain",
                           i + 1, p[0], p[1], p[2]);
        }
    }
    return VN_OK;
}

vn_status vn_cco_create(vn_cco **out, const vn_cco_def *def) {
    *out = NULL;
    VN_TRY(vn_check_def(&vn_cco_schema, def));
    VN_TRY(check_choices(def));
    VN_TRY(check_domain(def->domain));
    VN_TRY(def->list != NULL ? check_list(def) : VN_OK);
    vn_cco *cco = VN_NEW(vn_cco);
    if (cco == NULL) {
        return vn_fail_memory("a cco", sizeof *cco);
    }
    cco->def = *def;
    cco->def.terminals = def->list != NULL ? def->list_count : def->terminals;
    cco->def.tries = def->tries > 0 ? def->tries : def->placement == VN_PLACE_TERMINALS ? 1000 : 100;
    cco->def.domain = vn_domain_retain(def->domain);
    cco->part = vn_domain_retain(def->domain);
    cco->dim = vn_domain_dim(def->domain);
    cco->def.foresight = def->foresight >= 0 ? def->foresight : def->list != NULL ? 0 : cco->dim == 3 ? 4 : 1;
    vn_box bounds = vn_domain_bounds(def->domain);
    memcpy(cco->low, bounds.min, sizeof cco->low);
    memcpy(cco->high, bounds.max, sizeof cco->high);
    *out = cco;
    return VN_OK;
}

static void free_grower(vn_grower *g) {
    vn_tree_free(&g->tree);
    vn_tube_grid_free(&g->grid);
    vn_tube_grid_free(&g->thick_grid);
    vn_darts_free(&g->darts);
    vn_array_free(&g->nearest);
    vn_adjoints_free(&g->adjoints);
    vn_array_free(&g->candidates);
    vn_array_free(&g->path);
    vn_array_free(&g->crowded);
    vn_array_free(&g->stack);
}

void vn_cco_destroy(vn_cco *cco) {
    if (cco == NULL) {
        return;
    }
    for (int32_t i = 0; i < cco->growers.count; i++) {
        free_grower(&cco->growers.data[i]);
    }
    vn_array_free(&cco->growers);
    vn_array_free(&cco->squeezes);
    vn_domain_release(cco->part);
    vn_domain_release(cco->def.domain);
    VN_DELETE(cco);
}

// ---- Adding trees ----

static vn_status check_physics(const vn_cco_tree_def *def) {
    if (!(def->pressure_in > def->pressure_out)) {
        return vn_fail(
            VN_INVALID,
            "cco.pressure_in = %g Pa must be above pressure_out = %g Pa: blood flows down the pressure",
            def->pressure_in, def->pressure_out);
    }
    if (!(def->terminal_flow >= 0 && def->terminal_flow <= 1e150)) {
        return vn_fail(VN_INVALID, "cco.terminal_flow = %g mm³/s must be above 0", def->terminal_flow);
    }
    return VN_OK;
}

static vn_status add_exponent(vn_tree *tree, double flow, double exponent) {
    if (!(exponent >= 1 && exponent <= 100)) {
        return vn_fail(VN_INVALID, "cco.exponent = %g must be between 1 and 100 (3 is Murray's)", exponent);
    }
    int32_t last = tree->exponents.count - 1;
    if (!(flow > 0) || (last >= 0 && !(flow > tree->exponents.data[last].flow))) {
        return vn_fail(VN_INVALID,
                       "cco.exponent: the flow %g mm³/s of a pair must be above the one before, and 0", flow);
    }
    return vn_array_push(&tree->exponents, ((vn_exponent){flow, exponent}));
}

static vn_status set_exponents(vn_tree *tree, const vn_cco_tree_def *def) {
    if (def->exponent_count <= 0) {
        return add_exponent(tree, 1, def->exponent);
    }
    for (int32_t i = 0; i < def->exponent_count; i++) {
        VN_TRY(add_exponent(tree, def->exponents[2 * (size_t)i], def->exponents[2 * (size_t)i + 1]));
    }
    return VN_OK;
}

static vn_status flow_at(const vn_grower *g, const double p[3], double *flow) {
    double factor = 1;
    VN_TRY(g->flow != NULL ? g->flow(&factor, p, g->flow_payload) : VN_OK);
    *flow = g->terminal_flow * factor;
    if (!(*flow > 0 && *flow <= 1e150)) {
        return vn_fail(
            VN_INVALID,
            "cco.terminal_flow: a terminal at (%g, %g, %g) would have the flow %g mm³/s; it must be "
            "above 0",
            p[0], p[1], p[2], *flow);
    }
    return VN_OK;
}

static void widen(vn_cco *cco, const double p[3]) {
    for (int k = 0; k < cco->dim; k++) {
        cco->low[k] = fmin(cco->low[k], p[k]);
        cco->high[k] = fmax(cco->high[k], p[k]);
    }
}

// On the border counts as inside: within 1e-6 of the size, and wherever a nearby point is.
static vn_status add_root(vn_cco *cco, vn_grower *g, const double root[3]) {
    double p[3] = {root[0], root[1], cco->dim == 3 ? root[2] : 0};
    double size = 0;
    int32_t node;
    for (int k = 0; k < cco->dim; k++) {
        size = fmax(size, cco->high[k] - cco->low[k]);
    }
    if (!vn_finite(p) || vn_domain_distance(cco->def.domain, p) < -1e-6 * size) {
        return vn_fail(
            VN_INVALID,
            "cco.root at (%g, %g, %g) is outside the domain, %g from its border; put it inside or on the "
            "border",
            p[0], p[1], p[2], -vn_domain_distance(cco->def.domain, p));
    }
    widen(cco, p);
    g->first_born = 2; // the root and its first terminal
    return vn_tree_push(&g->tree, -1, p, &node);
}

static vn_status check_network(const vn_cco *cco, const vn_network *network, const char *what) {
    if (vn_network_dim(network) != cco->dim) {
        return vn_fail(VN_INVALID, "cco.%s has %d dimensions, and the domain %d", what,
                       vn_network_dim(network), cco->dim);
    }
    return VN_OK;
}

static vn_status copy_nodes(vn_cco *cco, vn_grower *g, const vn_network *network) {
    int32_t count = vn_network_count(network);
    VN_TRY(vn_array_reserve(&g->tree.vessels, count));
    g->tree.vessels.count = count;
    for (int32_t i = 0; i < count; i++) {
        vn_vessel *v = vn_vessel_of(g, i);
        *v = (vn_vessel){.parent = network->parent.data[i], .first_child = -1, .next_child = -1};
        vn_network_position(network, i, v->p);
        widen(cco, v->p);
    }
    for (int32_t i = 0; i < count; i++) {
        vn_vessel *v = vn_vessel_of(g, i);
        if (v->parent < 0) {
            continue;
        }
        vn_vessel *parent = vn_vessel_of(g, v->parent);
        v->length = sqrt(vn_distance2(v->p, parent->p));
        v->next_child = parent->first_child;
        parent->first_child = i;
    }
    return VN_OK;
}

static vn_status check_lengths(const vn_grower *g) {
    for (int32_t i = 0; i < g->tree.vessels.count; i++) {
        const vn_vessel *v = vn_vessel_of(g, i);
        if (v->parent >= 0 && !(v->length > 0)) {
            return vn_fail(VN_INVALID,
                           "cco.from: nodes %d and %d lie at the same point (%g, %g, %g); merge them", i,
                           v->parent, v->p[0], v->p[1], v->p[2]);
        }
    }
    return VN_OK;
}

static vn_status fill_from(vn_cco *cco, vn_grower *g, const vn_network *network) {
    VN_TRY(check_network(cco, network, "from"));
    if (vn_network_join_count(network) > 0) {
        return vn_fail(VN_INVALID, "cco.from has %d joins: only a tree can be grown on",
                       vn_network_join_count(network));
    }
    if (vn_network_count(network) < 2) {
        return vn_fail(VN_INVALID, "cco.from has %d nodes: it needs at least one segment (or give root)",
                       vn_network_count(network));
    }
    VN_TRY(copy_nodes(cco, g, network));
    VN_TRY(check_lengths(g));
    for (int32_t k = vn_network_count(network) - 1; k >= 0; k--) { // children first
        int32_t node = vn_network_nth(network, k);
        vn_vessel *v = vn_vessel_of(g, node);
        if (v->first_child < 0 && v->parent >= 0) {
            VN_TRY(flow_at(g, v->p, &v->flow));
            g->terminals++;
        }
        vn_tree_refresh(&g->tree, node);
    }
    g->given = g->first_born = vn_network_count(network);
    return VN_OK;
}

// What was grown by these rules keeps them; what was not (an organ's vessels from images) is taken as it is.
static bool keeps_rules(const vn_grower *g, double inflate) {
    for (int32_t i = 0; i < g->tree.vessels.count; i++) {
        const vn_vessel *v = vn_vessel_of(g, i);
        if (v->parent >= 0 && 2 * inflate * vn_tree_radius(&g->tree, i) > v->length) {
            return false;
        }
    }
    return true;
}

static void set_caps(const vn_cco *cco, vn_grower *g, const vn_network *network) {
    double inflate = vn_cco_inflate(cco, g->terminals);
    for (int32_t k = g->tree.vessels.count - 1; k >= 0; k--) { // children first
        int32_t node = vn_network_nth(network, k);
        vn_vessel *v = vn_vessel_of(g, node);
        if (v->parent >= 0) {
            v->cap = (float)(inflate * vn_tree_radius(&g->tree, node) * (1 + 2e-7));
            vn_tree_settle_one(&g->tree, node);
        }
    }
}

static vn_status make_darts(const vn_cco *cco, const vn_grower *g, int32_t tree, const vn_domain *part,
                            vn_darts *darts) {
    if (cco->def.list != NULL) {
        return VN_OK;
    }
    vn_rng rng = {.seed = (uint64_t)cco->def.seed,
                  .stream = vn_hash(2, (uint64_t)tree, (uint64_t)g->draws, 0)};
    double last = cco->def.spacing * pow(vn_domain_measure(part) / g->wanted, 1.0 / cco->dim);
    return vn_darts_init(darts, cco->dim, part, 0.02 * last, cco->def.density, cco->def.density_payload,
                         &rng);
}

static vn_status start_darts(const vn_cco *cco, vn_grower *g, int32_t tree) {
    return make_darts(cco, g, tree, cco->part, &g->darts);
}

static vn_status fill_tree(vn_cco *cco, vn_grower *g, const vn_cco_tree_def *def, int32_t tree) {
    g->venous = def->venous;
    g->flow = def->flow;
    g->flow_payload = def->flow_payload;
    g->pressure_in = def->pressure_in;
    g->pressure_out = def->pressure_out;
    g->symmetry = def->symmetry;
    g->terminal_flow = def->terminal_flow > 0 ? def->terminal_flow : def->inflow / cco->def.terminals;
    g->tree.factor = 8 * def->viscosity / PI / (def->pressure_in - def->pressure_out);
    VN_TRY(set_exponents(&g->tree, def));
    VN_TRY(vn_array_reserve(&g->tree.vessels, 2 * (int64_t)cco->def.terminals));
    if (def->from == NULL) {
        VN_TRY(add_root(cco, g, def->root));
    } else {
        VN_TRY(fill_from(cco, g, def->from));
        set_caps(cco, g, def->from);
        g->given = keeps_rules(g, vn_cco_inflate(cco, g->terminals)) ? 0 : g->given;
    }
    g->wanted = cco->def.list != NULL ? g->terminals + cco->def.terminals : cco->def.terminals;
    g->draws = g->terminals;
    VN_TRY(vn_places_update(cco, g));
    return start_darts(cco, g, tree);
}

static vn_status check_elsewhere(const vn_cco *cco, const double root[3]) {
    double p[3] = {root[0], root[1], cco->dim == 3 ? root[2] : 0};
    for (int32_t i = 0; i < cco->growers.count; i++) {
        const vn_grower *g = &cco->growers.data[i];
        int32_t node;
        if (vn_places_seek(g, p, VN_SEEK_AXIS, &node) == 0 ||
            vn_places_inside(g, p, vn_cco_inflate(cco, g->terminals))) {
            return vn_fail(VN_INVALID, "cco.root at (%g, %g, %g) is in a vessel of another tree; move it",
                           p[0], p[1], p[2]);
        }
    }
    return VN_OK;
}

static vn_status keep(vn_cco *cco, vn_grower *g, vn_status status) {
    status = status == VN_OK ? vn_array_push(&cco->growers, *g) : status;
    if (status != VN_OK) {
        free_grower(g);
    }
    return status;
}

vn_status vn_cco_add(vn_cco *cco, const vn_cco_tree_def *def, int32_t *tree) {
    *tree = -1;
    VN_TRY(vn_check_def(&vn_cco_tree_schema, def));
    VN_TRY(check_physics(def));
    VN_TRY(def->from == NULL ? check_elsewhere(cco, def->root) : VN_OK);
    vn_grower g = {0};
    int32_t number = vn_cco_tree_count(cco);
    VN_TRY(keep(cco, &g, fill_tree(cco, &g, def, number)));
    *tree = number;
    return VN_OK;
}

static vn_status add_join(vn_grower *g, const vn_network *network, int32_t join) {
    int32_t a, b, node;
    double radius, p[3];
    vn_network_join_ends(network, join, &a, &b, &radius);
    vn_network_position(network, b, p);
    VN_TRY(vn_tree_push(&g->tree, a, p, &node));
    vn_vessel_of(g, node)->cap = (float)(radius * (1 + 2e-7));
    return VN_OK;
}

static vn_status fill_obstacle(vn_cco *cco, vn_grower *g, const vn_network *network) {
    g->fixed = true;
    VN_TRY(check_network(cco, network, "avoid"));
    VN_TRY(copy_nodes(cco, g, network));
    for (int32_t i = 0; i < vn_network_count(network); i++) {
        vn_vessel_of(g, i)->cap = (float)(vn_network_radius(network, i) * (1 + 2e-7));
    }
    for (int32_t i = 0; i < vn_network_join_count(network); i++) {
        VN_TRY(add_join(g, network, i));
    }
    return vn_places_update(cco, g);
}

vn_status vn_cco_avoid(vn_cco *cco, const vn_network *network) {
    vn_grower g = {0};
    return keep(cco, &g, fill_obstacle(cco, &g, network));
}

// ---- Growing ----

vn_grower *vn_cco_tree_at(const vn_cco *cco, int32_t tree) {
    for (int32_t i = 0; i < cco->growers.count; i++) {
        if (!cco->growers.data[i].fixed && tree-- == 0) {
            return &cco->growers.data[i];
        }
    }
    return NULL;
}

int32_t vn_cco_tree_count(const vn_cco *cco) {
    int32_t trees = 0;
    for (int32_t i = 0; i < cco->growers.count; i++) {
        trees += !cco->growers.data[i].fixed;
    }
    return trees;
}

bool vn_cco_done(const vn_cco *cco) {
    for (int32_t i = 0; i < vn_cco_tree_count(cco); i++) {
        const vn_grower *g = vn_cco_tree_at(cco, i);
        if (g->terminals < g->wanted) {
            return false;
        }
    }
    return true;
}

/// New darts, one of each tree.
typedef VN_ARRAY(vn_darts) darts_array;

static vn_status make_all_darts(const vn_cco *cco, const vn_domain *part, darts_array *darts) {
    for (int32_t i = 0; i < vn_cco_tree_count(cco); i++) {
        VN_TRY(vn_array_push(darts, ((vn_darts){0})));
        VN_TRY(make_darts(cco, vn_cco_tree_at(cco, i), i, part, &darts->data[i]));
    }
    return VN_OK;
}

// All trees change to the part, or none.
static vn_status change_part(vn_cco *cco, const vn_domain *part, int32_t terminals) {
    darts_array fresh = {0};
    vn_status status = make_all_darts(cco, part, &fresh);
    for (int32_t i = 0; i < fresh.count; i++) {
        vn_grower *g = vn_cco_tree_at(cco, i);
        vn_darts old = status == VN_OK ? g->darts : fresh.data[i];
        if (status == VN_OK) {
            g->darts = fresh.data[i];
            g->stage_start = g->terminals;
            g->wanted = g->terminals + terminals;
        }
        vn_darts_free(&old);
    }
    vn_array_free(&fresh);
    if (status == VN_OK) {
        vn_domain *before = cco->part;
        cco->part = vn_domain_retain(part);
        vn_domain_release(before);
    }
    return status;
}

vn_status vn_cco_stage(vn_cco *cco, vn_domain *part, int32_t terminals) {
    if (vn_cco_tree_count(cco) == 0) {
        return vn_fail(VN_INVALID, "cco.stage: add the trees first");
    }
    if (cco->def.list != NULL || terminals < 1) {
        return vn_fail(VN_INVALID, "cco.stage: %s",
                       terminals < 1 ? "it needs 1 terminal or more" : "the terminals are a list already");
    }
    VN_TRY(part != NULL ? check_domain(part) : VN_OK);
    if (part != NULL && vn_domain_dim(part) != cco->dim) {
        return vn_fail(VN_INVALID, "cco.stage: the part has %d dimensions, and the domain %d",
                       vn_domain_dim(part), cco->dim);
    }
    for (int32_t i = 0; i < vn_cco_tree_count(cco); i++) {
        const vn_grower *g = vn_cco_tree_at(cco, i);
        if (terminals > cco->def.terminals - g->terminals) {
            return vn_fail(
                VN_INVALID,
                "cco.stage: %d terminals more than the %d there are, and cco.terminals = %d in all",
                terminals, g->terminals, cco->def.terminals);
        }
    }
    return change_part(cco, part != NULL ? part : cco->def.domain, terminals);
}

/// One terminal that is looked for.
typedef struct draw {
    const vn_cco *cco;
    const vn_grower *g;
} draw;

static bool keeps_from_terminals(const draw *d) {
    return d->cco->def.placement == VN_PLACE_TERMINALS;
}

static double distance_to_tree(const double p[3], int32_t *vessel, void *payload) {
    const draw *d = payload;
    return vn_places_seek(d->g, p, keeps_from_terminals(d) ? VN_SEEK_TERMINAL : VN_SEEK_AXIS, vessel);
}

static double distance_to_vessel(const double p[3], int32_t vessel, void *payload) {
    const draw *d = payload;
    return vn_places_distance_to(d->g, p, vessel, keeps_from_terminals(d));
}

// Less than any vessel to here would need: with the whole drop of pressure at the nearest segment's upper
// end, and half the way. A terminal nearer to the border than that cannot be connected, and trying it takes
// longest.
static double least_radius(const vn_cco *cco, const vn_grower *g, const double p[3]) {
    int32_t node;
    double distance = vn_places_seek(g, p, VN_SEEK_SEGMENT, &node);
    if (node < 0) {
        return 0;
    }
    const vn_vessel *v = vn_vessel_of(g, node);
    double drop = v->flow * v->resistance / pow(vn_tree_radius(&g->tree, node), 4);
    double flow = g->flow != NULL ? 0 : g->terminal_flow;
    return vn_cco_inflate(cco, g->terminals + 1) * sqrt(sqrt(flow * distance / 2 / drop));
}

// Nor may it lie in a vessel, of any tree, nor outside the whole domain where it falls into a part.
static bool is_taken(const double p[3], void *payload) {
    const draw *d = payload;
    for (int32_t i = 0; i < d->cco->growers.count; i++) {
        const vn_grower *g = &d->cco->growers.data[i];
        if (vn_places_inside(g, p, g->fixed ? 1 : vn_cco_inflate(d->cco, g->terminals))) {
            return true;
        }
    }
    double border = vn_domain_distance(d->cco->def.domain, p) - d->cco->def.border_distance;
    return border <= 0 || border < least_radius(d->cco, d->g, p);
}

// Where a terminal could not be connected, the next ones would fall again: the widest gap is there. So with
// every attempt they may come nearer to vessels. Growing elsewhere lowers the share of the flow that vessels
// to the gap have, and they can take more again.
static vn_status draw_terminal(const vn_cco *cco, vn_grower *g, int32_t tree, int32_t attempt, double p[3]) {
    enum { NEAREST = 20 };
    const double cells = 5.75; // a terminal: more take memory and bring next to nothing
    draw d = {cco, g};
    double share = vn_domain_measure(cco->part) / (g->terminals - g->stage_start + 1);
    double threshold = cco->def.spacing * pow(share, 1.0 / cco->dim); // (15), READINGS R11
    threshold *= pow(cco->def.threshold, attempt < NEAREST ? attempt : NEAREST);
    vn_dart_search search = {.threshold = threshold,
                             .factor = cco->def.threshold,
                             .tries = cco->def.tries,
                             .most_cells = (int32_t)fmin(cells * g->terminals + 64, INT32_MAX),
                             .distance = distance_to_tree,
                             .distance_to = distance_to_vessel,
                             .refuse = is_taken,
                             .payload = &d};
    vn_rng rng = {.seed = (uint64_t)cco->def.seed,
                  .stream = vn_hash(1, (uint64_t)tree, (uint64_t)g->draws++, 0)};
    return vn_darts_throw(&g->darts, &search, &rng, p, &g->report.darts);
}

// All reasons together are all refusals.
static vn_status fail_full(const vn_grower *g, int32_t draws, bool room) {
    const vn_cco_report *r = &g->report;
    int64_t refused =
        r->collapsed + r->short_segments + r->outside + r->crossing + r->crowding + r->asymmetric;
    return vn_fail(
        VN_INFEASIBLE,
        "cco: no place for terminal %d of %d after %d draws%s: of %lld connections refused so far %lld had "
        "their bifurcation in an end, %lld were shorter than thick, %lld left the domain, %lld met a vessel, "
        "%lld crowded one, %lld forked too unevenly (ask for fewer terminals, less inflow or a larger "
        "domain)",
        g->terminals + 1, g->wanted, draws, room ? "" : ", the last of which found no room between vessels",
        (long long)refused, (long long)r->collapsed, (long long)r->short_segments, (long long)r->outside,
        (long long)r->crossing, (long long)r->crowding, (long long)r->asymmetric);
}

// A small tree that stands in its own way is not worth keeping.
static vn_status begin_anew(vn_cco *cco, vn_grower *g, int32_t tree) {
    vn_vessel *root = vn_vessel_of(g, 0);
    root->first_child = -1;
    root->flow = root->resistance = root->volume = 0;
    g->tree.vessels.count = 1;
    g->terminals = 0;
    g->grid_count = 0;
    g->report.begun_anew++;
    VN_TRY(vn_places_update(cco, g));
    return start_darts(cco, g, tree);
}

// A disk with many terminals is so full that every other one fails: vessels cannot all have the room that
// they should. In space that does not come, and vessels would get stuck more often.
static double foresight_after(const vn_cco *cco, int32_t draws) {
    enum { FULL = 2 };
    bool eases = cco->dim == 2 && draws > FULL;
    return eases ? ldexp(cco->def.foresight, FULL - draws) : cco->def.foresight;
}

static vn_status try_random(vn_cco *cco, vn_grower *g, int32_t tree) {
    for (int32_t i = 0; i <= cco->def.redraws; i++) {
        double p[3], flow;
        bool done;
        vn_status found = draw_terminal(cco, g, tree, i, p);
        if (found == VN_INFEASIBLE) {
            return fail_full(g, i + 1, false);
        }
        VN_TRY(found);
        VN_TRY(flow_at(g, p, &flow));
        cco->patient = i < cco->def.redraws / 4 && cco->def.foresight > 0;
        cco->foresight = foresight_after(cco, i);
        VN_TRY(vn_connect(cco, g, p, flow, &done));
        if (done) {
            return VN_OK;
        }
        g->report.redrawn++;
        VN_TRY(vn_poll());
    }
    return fail_full(g, cco->def.redraws + 1, true);
}

// Terminals of a tree that has found its way about.
enum { SETTLED = 200 };

// Its first vessels take many attempts where a domain is thin or bent; from then on, hardly one terminal in
// two is drawn anew. But where these vessels shut one another in, several are for each, the whole tree comes
// to lie in a part of the domain, and that takes ten times as long: of 12 trees in the shell of a liver, 3.
static bool is_stuck(const vn_grower *g) {
    enum { LEEWAY = 200, OFTEN = 1 };
    int64_t redrawn = g->report.redrawn - g->settled;
    return g->terminals > SETTLED && redrawn > LEEWAY + OFTEN * (int64_t)(g->terminals - SETTLED);
}

static vn_status add_random(vn_cco *cco, vn_grower *g, int32_t tree) {
    enum { MOST_BEGINNINGS = 8 };
    vn_status status = try_random(cco, g, tree);
    bool fresh = g->first_born == 2 && g->stage_start == 0 && g->report.begun_anew < MOST_BEGINNINGS;
    g->settled = g->terminals <= SETTLED ? g->report.redrawn : g->settled;
    bool full = status == VN_INFEASIBLE && g->terminals < g->wanted / 4;
    bool stuck = status == VN_OK && g->terminals < g->wanted / 2 && is_stuck(g);
    if (!fresh || !(full || stuck)) {
        return status;
    }
    return begin_anew(cco, g, tree);
}

static vn_status add_listed(vn_cco *cco, vn_grower *g) {
    const double *p = &cco->def.list[3 * (size_t)g->listed];
    double flow;
    bool done;
    VN_TRY(flow_at(g, p, &flow));
    cco->foresight = cco->def.foresight;
    VN_TRY(vn_connect(cco, g, p, flow, &done));
    if (!done) {
        return vn_fail(
            VN_INFEASIBLE,
            "cco: terminal %d of the list, at (%g, %g, %g), cannot be connected: every segment would be "
            "shorter than thick, leave the domain or meet another vessel",
            g->listed + 1, p[0], p[1], p[2]);
    }
    g->listed++;
    return VN_OK;
}

// Terminals of the one that has least, of those that are not done.
static int32_t smallest_tree(const vn_cco *cco) {
    int32_t least = INT32_MAX;
    for (int32_t i = 0; i < vn_cco_tree_count(cco); i++) {
        const vn_grower *g = vn_cco_tree_at(cco, i);
        least = g->terminals < g->wanted && g->terminals < least ? g->terminals : least;
    }
    return least;
}

static int32_t count_terminals(const vn_cco *cco) {
    int32_t count = 0;
    for (int32_t i = 0; i < vn_cco_tree_count(cco); i++) {
        count += vn_cco_tree_at(cco, i)->terminals;
    }
    return count;
}

// One terminal for each tree that has fewer than @p goal.
static vn_status take_turns(vn_cco *cco, int64_t goal) {
    for (int32_t tree = 0; tree < vn_cco_tree_count(cco); tree++) {
        vn_grower *g = vn_cco_tree_at(cco, tree);
        if (g->terminals < g->wanted && g->terminals < goal) {
            VN_TRY(cco->def.list != NULL ? add_listed(cco, g) : add_random(cco, g, tree));
        }
        if (g->terminals >= g->wanted) {
            vn_darts_free(&g->darts); // a stage begins with new ones
        }
    }
    return vn_poll();
}

vn_status vn_cco_grow(vn_cco *cco, int32_t count, int32_t *added) {
    *added = 0;
    if (vn_cco_tree_count(cco) == 0) {
        return vn_fail(VN_INVALID, "cco: there is no tree to grow; add one with a root");
    }
    int32_t before = count_terminals(cco);
    int64_t goal = (int64_t)smallest_tree(cco) + count; // a tree that begins anew catches up
    vn_status status = VN_OK;
    while (status == VN_OK && !vn_cco_done(cco) && smallest_tree(cco) < goal) {
        status = take_turns(cco, goal);
    }
    *added = count_terminals(cco) - before;
    return status;
}

vn_cco_report vn_cco_report_of(const vn_cco *cco, int32_t tree) {
    const vn_grower *g = vn_cco_tree_at(cco, tree);
    vn_cco_report report = g->report;
    report.terminals = g->terminals;
    report.wanted = g->wanted;
    report.volume = vn_tree_volume(&g->tree);
    for (int32_t i = 0; i < g->tree.vessels.count; i++) {
        report.inflow += vn_vessel_of(g, i)->parent < 0 ? vn_vessel_of(g, i)->flow : 0;
    }
    return report;
}
