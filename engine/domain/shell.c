#include "domain/domain.h"

typedef struct shell {
    vn_domain base;
    vn_domain *whole;
    double thickness;
    int64_t seen; ///< changes of a growing whole when bounds and measure were taken
} shell;

static const vn_shell_def shell_default = {0};

static const vn_field shell_fields[] = {
    {"domain", VN_OBJECT, VN_REQUIRED, offsetof(vn_shell_def, domain), 0, 0, "", "domain",
     "what it is the shell of"},
    {"thickness", VN_F64, VN_REQUIRED | VN_ABOVE_MIN, offsetof(vn_shell_def, thickness), 0, 1e150, "length",
     NULL, "how far it reaches inwards from the border"},
};
const vn_schema vn_shell_schema =
    VN_SCHEMA("shell", "What of a domain is near its border", shell_fields, shell_default);

vn_shell_def vn_shell_def_default(void) {
    return shell_default;
}

static const shell *shell_of(const vn_domain *domain) {
    return (const shell *)domain;
}

static void shell_destroy(vn_domain *domain) {
    vn_domain_release(((shell *)domain)->whole);
}

static bool shell_contains(const vn_domain *domain, const double p[3]) {
    const shell *s = shell_of(domain);
    return vn_domain_contains(s->whole, p) && vn_domain_is_near(s->whole, p, s->thickness);
}

// Outwards it is the whole's border. Beyond the shell's inner border, that is nearest on the way to it; in
// the shell, on the way from it, unless the distance stops growing before: then it is farther away than this
// says.
static double shell_closest(const vn_domain *domain, const double p[3], double q[3]) {
    const shell *s = shell_of(domain);
    double depth = s->whole->kind->closest(s->whole, p, q);
    double rest = fabs(depth - s->thickness);
    if (depth <= rest || !vn_domain_contains(s->whole, p)) {
        return depth;
    }
    for (int k = 0; k < domain->dim; k++) {
        q[k] += s->thickness / depth * (p[k] - q[k]);
    }
    return rest;
}

static vn_status shell_dart(const vn_domain *domain, vn_rng *rng, double p[3]) {
    const shell *s = shell_of(domain);
    for (int tries = 0; tries < 1000000; tries++) {
        VN_TRY(vn_domain_dart(s->whole, rng, p));
        if (vn_domain_is_near(s->whole, p, s->thickness)) {
            return VN_OK;
        }
    }
    return vn_domain_fail_dart(domain);
}

static vn_status shell_outline(const vn_domain *domain, int32_t sides, vn_rings *out) {
    const shell *s = shell_of(domain);
    vn_rings whole = {0}, inner = {0}, rings = {0};
    vn_status status = vn_domain_outline(s->whole, sides, &whole);
    status = status == VN_OK ? vn_rings_inset(&inner, &whole, s->thickness) : status;
    status = status == VN_OK ? vn_rings_combine(&rings, &whole, &inner, VN_DIFFERENCE) : status;
    status = status == VN_OK ? vn_rings_append(out, &rings) : status;
    vn_rings_free(&whole);
    vn_rings_free(&inner);
    vn_rings_free(&rings);
    return status;
}

static int64_t shell_changes(const vn_domain *domain) {
    return vn_domain_changes(shell_of(domain)->whole);
}

static vn_status take_measure(shell *s) {
    s->seen = shell_changes(&s->base);
    s->base.bounds = vn_domain_bounds(s->whole);
    if (s->base.dim == 2) {
        return vn_domain_measure_outline(&s->base);
    }
    s->base.measure = vn_domain_measure_by_points(&s->base);
    return VN_OK;
}

// A failure, for want of memory, leaves the bounds of before, and is tried again.
static void shell_refresh(vn_domain *domain) {
    shell *s = (shell *)domain;
    int64_t before = s->seen;
    if (before != shell_changes(domain) && take_measure(s) != VN_OK) {
        s->seen = before;
    }
}

static const vn_domain_kind flat_kind = {.name = "shell",
                                         .destroy = shell_destroy,
                                         .contains = shell_contains,
                                         .closest = shell_closest,
                                         .outline = shell_outline,
                                         .refresh = shell_refresh,
                                         .changes = shell_changes,
                                         .dart = shell_dart};
static const vn_domain_kind solid_kind = {.name = "shell",
                                          .destroy = shell_destroy,
                                          .contains = shell_contains,
                                          .closest = shell_closest,
                                          .refresh = shell_refresh,
                                          .changes = shell_changes,
                                          .dart = shell_dart};

static vn_status fill_shell(shell *s, const vn_shell_def *def) {
    s->whole = vn_domain_retain(def->domain);
    s->thickness = def->thickness;
    memcpy(s->base.unit, def->domain->unit, sizeof s->base.unit);
    VN_TRY(take_measure(s));
    if (!(s->base.measure > 0)) {
        return vn_fail(VN_INFEASIBLE, "shell.thickness = %g is too thin: nothing is left of the domain",
                       s->thickness);
    }
    return VN_OK;
}

vn_status vn_domain_shell(vn_domain **out, const vn_shell_def *def) {
    *out = NULL;
    VN_TRY(vn_check_def(&vn_shell_schema, def));
    if (def->domain->kind->snap != NULL) {
        return vn_fail(VN_INVALID,
                       "shell.domain is a surface, which has no inside: take its mesh with on = \"inside\"");
    }
    shell *s = vn_domain_new(def->domain->dim == 2 ? &flat_kind : &solid_kind, sizeof *s, def->domain->dim);
    if (s == NULL) {
        return vn_fail_memory("a shell", sizeof *s);
    }
    vn_status status = fill_shell(s, def);
    if (status != VN_OK) {
        vn_domain_release(&s->base);
        return status;
    }
    *out = &s->base;
    return VN_OK;
}
