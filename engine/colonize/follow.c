// Vessels along paths that the user gives (Rauch & Harders 2021, Figure 4).
#include "domain/domain.h"
#include "network/network.h"
#include "network/paths.h"

#include <stdio.h>

static const vn_follow_def follow_default = {.name = "paths"};

static const vn_field follow_fields[] = {
    {"length", VN_F64, VN_REQUIRED | VN_ABOVE_MIN, offsetof(vn_follow_def, length), 0, 1e150, "length", NULL,
     "d, of the new edges: each path is cut into equal parts of about that length"},
    {"within", VN_F64, 0, offsetof(vn_follow_def, within), 0, 1e150, "length", NULL,
     "how far from the network a path may begin, and how far off a surface it may be; 0: length"},
    {"domain", VN_OBJECT, 0, offsetof(vn_follow_def, domain), 0, 0, "", "domain",
     "what paths have to stay in, or what surface they are brought onto; left out: anywhere"},
    {"name", VN_TEXT, 0, offsetof(vn_follow_def, name), 0, 0, "", "", "what errors call the paths"},
};
const vn_schema vn_follow_schema =
    VN_SCHEMA("follow", "Lay vessels along paths", follow_fields, follow_default);

vn_follow_def vn_follow_def_default(void) {
    return follow_default;
}

enum { MOST_PARTS = 100000000 };

static const double SLOPPY = 1e-6; // of the domain's size: so far out is on the border

/// One path on its way into a network.
typedef struct follower {
    vn_network *network;
    const vn_paths *paths;
    const vn_follow_def *def;
    double within, sloppy;
    int32_t path;
    double start[3];          ///< where the node is that it begins at
    VN_ARRAY(double) xyz;     ///< the way from there, on the surface where there is one
    VN_ARRAY(int32_t) toward; ///< for each place of it, the point of the path that comes next there
    double length;            ///< of the way
} follower;

static bool is_surface(const follower *f) {
    return f->def->domain != NULL && f->def->domain->kind->snap != NULL;
}

// How far @p p is outside; 0 where it may be. Onto a surface it is brought.
static double settle(const follower *f, double p[3]) {
    double q[3] = {p[0], p[1], p[2]};
    const vn_domain *domain = f->def->domain;
    if (domain == NULL || (!is_surface(f) && vn_domain_contains(domain, p))) {
        return 0;
    }
    if (!is_surface(f) || !vn_domain_snap(domain, q)) {
        double off = -vn_domain_distance(domain, p);
        return off > f->sloppy ? off : 0;
    }
    double off = sqrt(vn_distance2(p, q));
    memcpy(p, q, sizeof q);
    return off > f->within ? off : 0;
}

// "(0.1, 0.2)" as the user wrote it.
static const char *at(const follower *f, const double p[3], char *text, size_t size) {
    if (f->network->dim == 2) {
        snprintf(text, size, "(%g, %g)", p[0], p[1]);
    } else {
        snprintf(text, size, "(%g, %g, %g)", p[0], p[1], p[2]);
    }
    return text;
}

static vn_status get_point(const follower *f, int32_t point, double p[3]) {
    char place[80];
    double asked[3];
    vn_paths_position(f->paths, f->path, point, p);
    memcpy(asked, p, sizeof asked);
    double off = settle(f, p);
    if (off > 0) {
        return vn_fail(VN_INVALID, "%s[%d]: point %d at %s is outside the domain, by %g: move it inside",
                       f->def->name, f->path + 1, point + 1, at(f, asked, place, sizeof place), off);
    }
    return VN_OK;
}

static int children_of(const vn_network *network, int32_t node) {
    int count = 0;
    for (int32_t c = network->first_child.data[node]; c >= 0; c = network->next_child.data[c]) {
        count++;
    }
    return count;
}

// The node nearest to @p p that is at most @p reach away, or -1.
static vn_status nearest_node(const follower *f, const double p[3], double reach, int32_t *node,
                              double *distance) {
    const vn_point_grid *grid;
    VN_TRY(vn_network_grid(f->network, fmin(f->within, 4 * f->def->length), &grid));
    vn_points nodes = vn_network_points(f->network);
    vn_nearest query = {.reach2 = reach * reach};
    vn_point_grid_nearest(grid, &nodes, p, &query);
    *node = query.point;
    *distance = sqrt(query.reach2);
    return VN_OK;
}

static vn_status fail_far(const follower *f, const double p[3]) {
    char place[80];
    double last[3], distance, unused;
    int32_t size = vn_paths_size(f->paths, f->path), node, turned;
    vn_paths_position(f->paths, f->path, size - 1, last);
    VN_TRY(nearest_node(f, p, INFINITY, &node, &distance));
    VN_TRY(nearest_node(f, last, f->within, &turned, &unused));
    return vn_fail(VN_INVALID,
                   "%s[%d]: it begins at %s, %g from the nearest vessel, and may be %g at most: %s",
                   f->def->name, f->path + 1, at(f, p, place, sizeof place), distance, f->within,
                   turned >= 0 && size > 1 ? "its end is near one, so give its points in reverse"
                                           : "begin it on a root or an earlier one, or place a root there");
}

// The node that the path begins at, for its first point @p p.
static vn_status find_start(const follower *f, const double p[3], int32_t *start) {
    char place[80];
    double distance, q[3];
    if (f->network->x.count == 0) {
        return vn_network_root(f->network, p, start);
    }
    VN_TRY(nearest_node(f, p, f->within, start, &distance));
    if (*start < 0) {
        return fail_far(f, p);
    }
    if (children_of(f->network, *start) < 2) {
        return VN_OK;
    }
    vn_network_position(f->network, *start, q);
    return vn_fail(VN_INVALID,
                   "%s[%d]: it would be the third vessel from the fork at %s: begin it %g or more away",
                   f->def->name, f->path + 1, at(f, q, place, sizeof place), f->def->length);
}

static vn_status fail_outside(const follower *f, int32_t toward, const double p[3]) {
    char place[80];
    return vn_fail(VN_INVALID, "%s[%d]: before point %d it leaves the domain, near %s: %s", f->def->name,
                   f->path + 1, toward + 1, at(f, p, place, sizeof place),
                   is_surface(f) ? "give more points along the surface" : "lead it round");
}

static const double *way_end(const follower *f) {
    return f->xyz.count > 0 ? f->xyz.data + f->xyz.count - 3 : f->start;
}

static vn_status go_to(follower *f, const double p[3], int32_t toward) {
    double step = sqrt(vn_distance2(way_end(f), p));
    if (step == 0) {
        return VN_OK;
    }
    f->length += step;
    VN_TRY(vn_array_reserve(&f->xyz, (int64_t)f->xyz.count + 3));
    memcpy(f->xyz.data + f->xyz.count, p, 3 * sizeof *p);
    f->xyz.count += 3;
    return vn_array_push(&f->toward, toward);
}

static vn_status check_parts(const follower *f, double parts) {
    return parts < MOST_PARTS
               ? VN_OK
               : vn_fail(VN_LIMIT, "%s[%d]: it is more than %d segments long: raise their length",
                         f->def->name, f->path + 1, MOST_PARTS);
}

// A straight line in space is a way through the organ: it is brought onto the surface in small parts.
static vn_status go_along_surface(follower *f, const double to[3], int32_t toward) {
    double from[3], p[3];
    memcpy(from, way_end(f), sizeof from);
    double parts = ceil(2 * sqrt(vn_distance2(from, to)) / f->def->length);
    VN_TRY(check_parts(f, parts));
    for (int32_t i = 1; i < (int32_t)parts; i++) {
        for (int k = 0; k < 3; k++) {
            p[k] = from[k] + i / parts * (to[k] - from[k]);
        }
        VN_TRY(settle(f, p) > 0 ? fail_outside(f, toward, p) : VN_OK);
        VN_TRY(go_to(f, p, toward));
    }
    return go_to(f, to, toward);
}

static vn_status go(follower *f, const double p[3], int32_t toward) {
    return is_surface(f) ? go_along_surface(f, p, toward) : go_to(f, p, toward);
}

// A first point that is hardly off the start is where the user meant to begin: the way joins the path one
// segment on, and does not run beside it.
static vn_status cut_in(follower *f, const double first[3]) {
    double p[3];
    VN_TRY(get_point(f, 1, p));
    double leg = sqrt(vn_distance2(first, p));
    double share = leg > f->def->length ? f->def->length / leg : 1;
    for (int k = 0; k < 3; k++) {
        p[k] = share < 1 ? first[k] + share * (p[k] - first[k]) : p[k];
    }
    VN_TRY(settle(f, p) > 0 ? fail_outside(f, 1, p) : VN_OK);
    return go(f, p, 1);
}

// From the start along all points.
static vn_status find_way(follower *f, int32_t start, const double first[3]) {
    double p[3];
    int32_t size = vn_paths_size(f->paths, f->path);
    f->xyz.count = f->toward.count = 0;
    f->length = 0;
    vn_network_position(f->network, start, f->start);
    bool cuts = size > 1 && sqrt(vn_distance2(f->start, first)) <= f->def->length / 2;
    VN_TRY(cuts ? cut_in(f, first) : go(f, first, 0));
    for (int32_t point = 1; point < size; point++) {
        VN_TRY(get_point(f, point, p));
        VN_TRY(go(f, p, point));
    }
    return VN_OK;
}

static bool lies_on_sibling(const follower *f, int32_t node, const double p[3]) {
    const double same = 1e-6 * f->def->length;
    for (int32_t c = f->network->first_child.data[node]; c >= 0; c = f->network->next_child.data[c]) {
        double q[3];
        vn_network_position(f->network, c, q);
        if (vn_distance2(p, q) < same * same) {
            return true;
        }
    }
    return false;
}

static vn_status lay_edge(const follower *f, int32_t *node, double p[3], int32_t toward) {
    double q[3];
    vn_network_position(f->network, *node, q);
    VN_TRY(settle(f, p) > 0 ? fail_outside(f, toward, p) : VN_OK);
    if (f->def->domain != NULL && !vn_domain_sees(f->def->domain, q, p)) {
        return fail_outside(f, toward, p);
    }
    if (lies_on_sibling(f, *node, p)) {
        char place[80];
        return vn_fail(VN_INVALID, "%s[%d]: from %s on it lies on another one: begin it where they part",
                       f->def->name, f->path + 1, at(f, q, place, sizeof place));
    }
    return vn_network_add(f->network, *node, p, node);
}

// Edges that are equally long along the way; none where it leads nowhere.
static vn_status lay_edges(const follower *f, int32_t node) {
    if (f->xyz.data == NULL || f->length == 0) {
        return VN_OK;
    }
    VN_TRY(check_parts(f, f->length / f->def->length));
    int32_t parts = (int32_t)fmax(1, round(f->length / f->def->length));
    const double *from = f->start, *to = f->xyz.data;
    double behind = 0, step = sqrt(vn_distance2(from, to));
    for (int32_t i = 1, leg = 0; i <= parts; i++) {
        double due = f->length * i / parts, p[3];
        while (leg + 1 < f->toward.count && (behind + step < due || i == parts)) {
            behind += step;
            leg++;
            from = to;
            to += 3;
            step = sqrt(vn_distance2(from, to));
        }
        double share = i < parts ? fmin(1, (due - behind) / step) : 1;
        for (int k = 0; k < 3; k++) {
            p[k] = share < 1 ? from[k] + share * (to[k] - from[k]) : to[k];
        }
        VN_TRY(lay_edge(f, &node, p, f->toward.data[leg]));
        VN_TRY(i % 1024 == 0 ? vn_poll() : VN_OK);
    }
    return VN_OK;
}

static vn_status follow_path(follower *f) {
    double first[3];
    int32_t start;
    VN_TRY(get_point(f, 0, first));
    VN_TRY(find_start(f, first, &start));
    VN_TRY(find_way(f, start, first));
    return lay_edges(f, start);
}

static vn_status check_follow(const vn_network *network, const vn_paths *paths, const vn_follow_def *def) {
    VN_TRY(vn_check_def(&vn_follow_schema, def));
    if (paths->dim != network->dim) {
        return vn_fail(VN_INVALID, "follow: %s have %d dimensions, the network %d", def->name, paths->dim,
                       network->dim);
    }
    if (def->domain != NULL && vn_domain_dim(def->domain) != network->dim) {
        return vn_fail(VN_INVALID, "follow.domain has %d dimensions, the network %d",
                       vn_domain_dim(def->domain), network->dim);
    }
    return VN_OK;
}

vn_status vn_network_follow(vn_network *network, const vn_paths *paths, const vn_follow_def *def,
                            int32_t *added, int32_t *first) {
    int32_t before = network->x.count;
    vn_status status = check_follow(network, paths, def);
    follower f = {.network = network, .paths = paths, .def = def};
    f.within = def->within > 0 ? def->within : def->length;
    if (def->domain != NULL) {
        vn_box bounds = vn_domain_bounds(def->domain);
        f.sloppy = SLOPPY * sqrt(vn_distance2(bounds.min, bounds.max));
    }
    for (; f.path < paths->ends.count && status == VN_OK; f.path++) {
        status = follow_path(&f);
        status = status == VN_OK && f.path % 1024 == 1023 ? vn_poll() : status;
    }
    vn_array_free(&f.xyz);
    vn_array_free(&f.toward);
    if (added != NULL) {
        *added = network->x.count - before;
    }
    if (first != NULL) {
        *first = before;
    }
    return status;
}
