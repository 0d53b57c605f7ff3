#include "bind/bind.h"

#include "domain/domain.h"
#include "file/mask.h"
#include "file/mesh.h"
#include "file/svg.h"

#include <string.h>

// Samples are the darts of a throw that nothing else is in the way of.
static const vn_throw_def sample_default = {0};
static const vn_field sample_fields[] = {
    {"spacing", VN_F64, VN_ABOVE_MIN | VN_OPTIONAL, offsetof(vn_throw_def, spacing), 0, 1e150, "length", NULL,
     "a point this close to an earlier one is refused; left out: none is"},
    {"rng", VN_OBJECT, VN_REQUIRED, offsetof(vn_throw_def, rng), 0, 0, "", "rng",
     "the random numbers: venule.rng(seed)"},
};
static const vn_schema sample_schema =
    VN_SCHEMA("sample", "Uniformly distributed points", sample_fields, sample_default);

static void release_domain(void *object) {
    vn_domain_release(object);
}

static int make_disk(lua_State *L) {
    vn_disk_def def;
    vnl_read_options(L, 1, &vn_disk_schema, &def);
    void **box = vnl_push_box(L, &vnl_domain_class);
    vnl_try(L, vn_domain_disk((vn_domain **)box, &def));
    return 1;
}

static int make_sphere(lua_State *L) {
    vn_disk_def def;
    vn_schema schema = vn_disk_schema;
    schema.name = "sphere"; // as its errors call it
    vnl_read_options(L, 1, &schema, &def);
    void **box = vnl_push_box(L, &vnl_domain_class);
    vnl_try(L, vn_domain_sphere((vn_domain **)box, &def));
    return 1;
}

static int point_dim(lua_State *L, int index, const char *field) {
    double p[3];
    vnl_raw_field(L, index, field);
    int dim = vnl_read_point(L, -1, field, p);
    lua_pop(L, 1);
    return dim;
}

static int make_box(lua_State *L) {
    vn_box_def def;
    vnl_read_options(L, 1, &vn_box_schema, &def);
    def.dim = point_dim(L, 1, "min");
    if (point_dim(L, 1, "max") != def.dim) {
        return vnl_fail(L, "box: min and max must both have 2 coordinates, or both 3");
    }
    void **box = vnl_push_box(L, &vnl_domain_class);
    vnl_try(L, vn_domain_box((vn_domain **)box, &def));
    return 1;
}

// A ring is a list of points; a list of rings has a list of points as its first element.
static bool is_ring(lua_State *L, int index) {
    bool ring = false;
    if (lua_rawgeti(L, index, 1) == LUA_TTABLE) {
        ring = lua_rawgeti(L, -1, 1) == LUA_TNUMBER;
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    return ring;
}

static void read_ring(lua_State *L, int index, double *xy, lua_Integer count) {
    for (lua_Integer i = 0; i < count; i++) {
        double p[3];
        lua_rawgeti(L, index, i + 1);
        vnl_read_point(L, -1, "polygon", p);
        lua_pop(L, 1);
        xy[2 * i] = p[0];
        xy[2 * i + 1] = p[1];
    }
}

static lua_Integer ring_size(lua_State *L, int index) {
    if (lua_type(L, index) != LUA_TTABLE) {
        vnl_fail(L, "polygon: a ring {{x, y}, …} expected, got %s", luaL_typename(L, index));
    }
    lua_Integer size = (lua_Integer)lua_rawlen(L, index);
    if (size > 10000000) {
        vnl_fail(L, "polygon: a ring of %lld points is above the limit of 10,000,000", (long long)size);
    }
    return size;
}

static int make_polygon(lua_State *L) {
    luaL_checktype(L, 1, LUA_TTABLE);
    if (is_ring(L, 1)) { // polygon{{x, y}, …}: one ring and no braces to spare
        lua_createtable(L, 1, 0);
        lua_pushvalue(L, 1);
        lua_rawseti(L, -2, 1);
        lua_replace(L, 1);
    }
    lua_Integer rings = (lua_Integer)lua_rawlen(L, 1);
    if (rings > 100000) {
        return vnl_fail(L, "polygon: %lld rings are above the limit of 100,000", (long long)rings);
    }
    lua_Integer total = 0;
    int32_t *sizes = lua_newuserdatauv(L, (size_t)(rings + 1) * sizeof *sizes, 0);
    for (lua_Integer r = 0; r < rings; r++, lua_pop(L, 1)) {
        lua_rawgeti(L, 1, r + 1);
        sizes[r] = (int32_t)ring_size(L, lua_gettop(L));
        total += sizes[r];
    }
    double *xy = lua_newuserdatauv(L, (size_t)(2 * total + 1) * sizeof *xy, 0);
    double *at = xy;
    for (lua_Integer r = 0; r < rings; r++, lua_pop(L, 1)) {
        lua_rawgeti(L, 1, r + 1);
        read_ring(L, lua_gettop(L), at, sizes[r]);
        at += 2 * sizes[r];
    }
    void **box = vnl_push_box(L, &vnl_domain_class);
    vnl_try(L, vn_domain_polygon((vn_domain **)box, xy, sizes, (int32_t)rings));
    return 1;
}

static void read_samples(lua_State *L, int index, double *samples, int32_t count) {
    bool call = lua_isfunction(L, index);
    for (int32_t i = 0; i < count; i++) {
        if (call) {
            lua_pushvalue(L, index);
            lua_pushnumber(L, (double)i / (count - 1));
            lua_call(L, 1, 1);
        } else {
            lua_rawgeti(L, index, i + 1);
        }
        samples[i] = vnl_check_number(L, -1, "profile.half_width");
        lua_pop(L, 1);
    }
}

static int make_profile(lua_State *L) {
    vn_profile_def def;
    vnl_read_options(L, 1, &vn_profile_schema, &def);
    vnl_raw_field(L, 1, "half_width");
    int source = lua_gettop(L);
    if (lua_istable(L, source)) {
        lua_Integer count = (lua_Integer)lua_rawlen(L, source);
        def.samples = count < 1000000 ? (int32_t)count : 1000000;
    } else if (!lua_isfunction(L, source)) {
        return vnl_fail(L, "profile.half_width: a function of t or a table of numbers expected, got %s",
                        luaL_typename(L, source));
    }
    double *samples = lua_newuserdatauv(L, (size_t)(def.samples + 1) * sizeof *samples, 0);
    read_samples(L, source, samples, def.samples);
    def.half_width = samples;
    void **box = vnl_push_box(L, &vnl_domain_class);
    vnl_try(L, vn_domain_profile((vn_domain **)box, &def));
    return 1;
}

static int make_svg(lua_State *L) {
    vn_svg_def def;
    lua_settop(L, 2);
    vnl_read_options(L, 2, &vn_svg_schema, &def);
    const char *path = vnl_push_path(L, 1);
    void **box = vnl_push_box(L, &vnl_domain_class);
    vnl_try(L, vn_domain_svg((vn_domain **)box, path, &def));
    return 1;
}

static int make_image(lua_State *L) {
    vn_image_def def;
    lua_settop(L, 2);
    vnl_read_options(L, 2, &vn_image_schema, &def);
    const char *path = vnl_push_path(L, 1);
    void **box = vnl_push_box(L, &vnl_domain_class);
    vnl_try(L, vn_domain_image((vn_domain **)box, path, &def));
    return 1;
}

static int make_volume(lua_State *L) {
    vn_volume_def def;
    lua_settop(L, 2);
    vnl_read_options(L, 2, &vn_volume_schema, &def);
    const char *path = vnl_push_path(L, 1);
    void **box = vnl_push_box(L, &vnl_domain_class);
    vnl_try(L, vn_domain_volume((vn_domain **)box, path, &def));
    return 1;
}

// Push the list of a mesh table, and say how long it is.
static int32_t push_list(lua_State *L, const char *field) {
    if (vnl_raw_field(L, 1, field) != LUA_TTABLE) {
        vnl_fail(L, "mesh.%s: a list expected, got %s", field, luaL_typename(L, -1));
    }
    lua_Integer count = (lua_Integer)lua_rawlen(L, -1);
    if (count > 100000000) {
        vnl_fail(L, "mesh.%s: %lld are above the limit of 100,000,000", field, (long long)count);
    }
    return (int32_t)count;
}

static double *read_vertices(lua_State *L, int32_t *count) {
    *count = push_list(L, "vertices");
    int list = lua_gettop(L);
    double *xyz = lua_newuserdatauv(L, (3 * (size_t)*count + 1) * sizeof *xyz, 0);
    for (int32_t i = 0; i < *count; i++, lua_pop(L, 1)) {
        lua_rawgeti(L, list, i + 1);
        if (vnl_read_point(L, -1, "mesh.vertices", xyz + 3 * (size_t)i) != 3) {
            vnl_fail(L, "mesh.vertices[%d]: a point {x, y, z} expected, of 3 coordinates", (int)i + 1);
        }
    }
    return xyz;
}

static int32_t *read_sizes(lua_State *L, int list, int32_t count, int64_t *corners) {
    int32_t *sizes = lua_newuserdatauv(L, ((size_t)count + 1) * sizeof *sizes, 0);
    *corners = 0;
    for (int32_t i = 0; i < count; i++, lua_pop(L, 1)) {
        if (lua_rawgeti(L, list, i + 1) != LUA_TTABLE) {
            vnl_fail(L, "mesh.faces[%d]: a list of vertex numbers expected, got %s", (int)i + 1,
                     luaL_typename(L, -1));
        }
        lua_Unsigned size = lua_rawlen(L, -1);
        sizes[i] = size < 100000 ? (int32_t)size : 100000;
        *corners += sizes[i];
    }
    return sizes;
}

// The engine counts from 0. What is out of its numbers' range becomes -1, which is out of every range.
static int32_t *read_corners(lua_State *L, int list, const int32_t *sizes, int32_t count, int64_t corners) {
    int32_t *all = lua_newuserdatauv(L, ((size_t)corners + 1) * sizeof *all, 0), *at = all;
    for (int32_t i = 0; i < count; i++, lua_pop(L, 1)) {
        lua_rawgeti(L, list, i + 1);
        for (int32_t k = 0; k < sizes[i]; k++, lua_pop(L, 1)) {
            lua_rawgeti(L, -1, k + 1);
            lua_Integer number = vnl_check_integer(L, -1, "mesh.faces");
            *at++ = number >= 1 && number <= INT32_MAX ? (int32_t)(number - 1) : -1;
        }
    }
    return all;
}

static void make_faces(lua_State *L, vn_domain **domain, const vn_mesh_def *def) {
    vn_faces faces = {.what = "mesh", .first = 1};
    int64_t corners;
    faces.xyz = read_vertices(L, &faces.vertices);
    faces.count = push_list(L, "faces");
    int list = lua_gettop(L);
    int32_t *sizes = read_sizes(L, list, faces.count, &corners);
    faces.sizes = sizes;
    faces.corners = read_corners(L, list, sizes, faces.count, corners);
    vnl_try(L, vn_domain_mesh_faces(domain, &faces, def));
}

static void push_repairs(lua_State *L, const vn_repairs *repairs) {
    lua_createtable(L, 0, 6);
    vnl_set_integer(L, "merged", repairs->merged);
    vnl_set_integer(L, "removed", repairs->removed);
    vnl_set_integer(L, "turned", repairs->turned);
    vnl_set_integer(L, "sewn", repairs->sewn);
    vnl_set_integer(L, "holes", repairs->holes);
    vnl_set_integer(L, "largest_hole", repairs->largest_hole);
}

static int make_mesh(lua_State *L) {
    vn_mesh_def def;
    vn_repairs repairs;
    lua_settop(L, 2);
    vnl_read_options(L, 2, &vn_mesh_schema, &def);
    def.repairs = &repairs;
    void **box = vnl_push_box(L, &vnl_domain_class);
    int result = lua_gettop(L);
    if (lua_istable(L, 1)) {
        make_faces(L, (vn_domain **)box, &def);
    } else {
        const char *path = vnl_push_path(L, 1);
        vnl_try(L, vn_domain_mesh((vn_domain **)box, path, &def));
    }
    lua_settop(L, result);
    if (!def.repair) {
        return 1;
    }
    push_repairs(L, &repairs);
    return 2;
}

static int make_shell(lua_State *L) {
    vn_shell_def def;
    lua_settop(L, 1);
    void **box = vnl_push_box(L, &vnl_domain_class);
    vnl_read_options(L, 1, &vn_shell_schema, &def);
    vnl_try(L, vn_domain_shell((vn_domain **)box, &def));
    return 1;
}

const vnl_function vnl_domain_functions[] = {
    {"disk", make_disk, NULL, "venule.Domain", "A disk.", &vn_disk_schema},
    {"sphere", make_sphere, NULL, "venule.Domain", "A ball in 3D.", &vn_disk_schema},
    {"box", make_box, NULL, "venule.Domain", "An upright rectangle, or in 3D a box.", &vn_box_schema},
    {"polygon", make_polygon, "(rings: number[][][]): venule.Domain", NULL,
     "A polygon with holes: `polygon{outer, hole, …}`, each ring a list of points {x, y}; a single ring may "
     "stand without "
     "the outer braces. Orientation is free; a ring inside another is a hole.",
     NULL},
    {"profile", make_profile, NULL, "venule.Domain",
     "A leaf blade by its half width along the midrib, the y axis.", &vn_profile_schema},
    {"svg", make_svg, "(path: string, options?: venule.svg.Options): venule.Domain", NULL,
     "The outline of a shape in an SVG file, y up: in the user units of its viewBox, whose lower left corner "
     "becomes "
     "(0, 0), or in mm when the file gives its width in mm, cm, in or pt.",
     &vn_svg_schema},
    {"image", make_image, "(path: string, options?: venule.image.Options): venule.Domain", NULL,
     "What is bright in a picture (.png, .pgm), y up, with its lower left corner at (0, 0): the squares of "
     "its "
     "pixels, whose values `d:value` gives. With `threshold = 0` the whole picture is a map of density.",
     &vn_image_schema},
    {"volume", make_volume, "(path: string, options?: venule.volume.Options): venule.Domain", NULL,
     "What is inside in a volume of voxels, in 3D: NIfTI (.nii, .nii.gz), NRRD (.nrrd) or DGtal's .vol, in "
     "the "
     "file's own coordinates and unit (NRRD's turned to right, anterior, superior as NIfTI has them). "
     "`d:value` "
     "is a voxel's value over the greatest inside.",
     &vn_volume_schema},
    {"mesh", make_mesh,
     "(mesh: string|{vertices: number[][], faces: integer[][]}, options?: venule.mesh.Options): "
     "venule.Domain, table?",
     NULL,
     "The surface of a mesh in 3D, or with `on = \"inside\"` what it encloses: of an .obj, .off, .ply, .glb, "
     ".gltf or "
     ".stl file, or of a table of vertices {x, y, z} and of faces {a, b, c, …}, which count the vertices "
     "from 1. Veins grow along a surface: new nodes are brought onto it, no edge crosses its border or "
     "jumps from one sheet of a fold to another. Distances are straight ones in space: `within` should be "
     "below the distance of folds. For an inside the mesh has to be closed; a shell in a shell bounds a "
     "cavity, whichever way their faces turn. With `repair = true` broken meshes are mended as far as that "
     "can "
     "be, and a second result says how much: {merged = vertices that nearly coincided, removed = faces that "
     "were "
     "there twice or had no area, turned = faces, sewn = pairs of edges, holes =, largest_hole = edges}.",
     &vn_mesh_schema},
    {"shell", make_shell, NULL, "venule.Domain",
     "What of a domain is near its border: everything but a core that is `thickness` inside. Of a growing "
     "domain, always of today's shape.",
     &vn_shell_schema},
    {0},
};

// The domain and the point that `d:contains(x, y[, z])` and its like are given.
static vn_domain *check_place(lua_State *L, double p[3]) {
    vn_domain *domain = vnl_check_domain(L, 1);
    vnl_check_coordinates(L, 2, vn_domain_dim(domain), p);
    return domain;
}

static int domain_contains(lua_State *L) {
    double p[3];
    lua_pushboolean(L, vn_domain_contains(check_place(L, p), p));
    return 1;
}

static int domain_distance(lua_State *L) {
    double p[3];
    lua_pushnumber(L, vn_domain_distance(check_place(L, p), p));
    return 1;
}

static int domain_closest(lua_State *L) {
    double p[3], q[3];
    vn_domain *domain = check_place(L, p);
    vn_domain_closest(domain, p, q);
    return vnl_push_coordinates(L, vn_domain_dim(domain), q);
}

static int domain_value(lua_State *L) {
    double p[3];
    lua_pushnumber(L, vn_domain_value(check_place(L, p), p));
    return 1;
}

static int domain_bounds(lua_State *L) {
    vn_domain *domain = vnl_check_domain(L, 1);
    vn_box bounds = vn_domain_bounds(domain);
    vnl_push_bounds(L, vn_domain_dim(domain), &bounds, vn_domain_unit(domain));
    return 1;
}

static int domain_measure(lua_State *L) {
    lua_pushnumber(L, vn_domain_measure(vnl_check_domain(L, 1)));
    return 1;
}

static void push_points(lua_State *L, vn_attractors *points, int32_t count, int dim) {
    lua_createtable(L, count, 0);
    for (int32_t i = 0; i < count; i++) {
        double p[3];
        vnl_try(L, vn_attractors_position(points, i, p));
        lua_createtable(L, dim, 0);
        for (int k = 0; k < dim; k++) {
            lua_pushnumber(L, p[k]);
            lua_rawseti(L, -2, k + 1);
        }
        lua_rawseti(L, -2, i + 1);
    }
}

static int domain_sample(lua_State *L) {
    lua_Integer count = vnl_check_integer(L, 2, "domain:sample n");
    if (count < 1 || count > 100000000) {
        return vnl_fail(L, "domain:sample(%lld): from 1 to 100,000,000 points", (long long)count);
    }
    vn_attractors_def set = vn_attractors_def_default();
    vn_throw_def def;
    int32_t accepted;
    lua_settop(L, 3);
    void **box = vnl_push_box(L, &vnl_attractors_class);
    vnl_read_options(L, 3, &sample_schema, &def);
    def.domain = vnl_check_domain(L, 1);
    def.count = (int32_t)count;
    set.dim = vn_domain_dim(def.domain);
    vnl_try(L, vn_attractors_create((vn_attractors **)box, &set));
    vnl_try(L, vn_throw(*box, &def, &accepted));
    push_points(L, *box, accepted, set.dim);
    return 1;
}

static int combine(lua_State *L, vn_combination how) {
    void **box = vnl_push_box(L, &vnl_domain_class);
    const vn_domain *a = vnl_check_domain(L, 1);
    const vn_domain *b = vnl_check_domain(L, 2);
    vnl_try(L, vn_domain_combine((vn_domain **)box, a, b, how));
    return 1;
}

static int domain_minus(lua_State *L) {
    return combine(L, VN_DIFFERENCE);
}

static int domain_plus(lua_State *L) {
    return combine(L, VN_UNION);
}

static int domain_times(lua_State *L) {
    return combine(L, VN_INTERSECTION);
}

static int domain_field(lua_State *L) {
    const vn_domain *domain = vnl_check(L, 1, &vnl_domain_class);
    const char *key = lua_tostring(L, 2);
    if (strcmp(key, "dim") == 0) {
        lua_pushinteger(L, vn_domain_dim(domain));
        return 1;
    }
    if (strcmp(key, "measure_dim") == 0) {
        lua_pushinteger(L, vn_domain_measure_dim(domain));
        return 1;
    }
    if (strcmp(key, "unit") == 0) {
        lua_pushstring(L, vn_domain_unit(domain));
        return 1;
    }
    return 0;
}

static const char *const fields[] = {
    "dim: integer | 2 or 3", "measure_dim: integer | 2 where its measure is an area, 3 where it is a volume",
    "unit: string | the length unit of its file, or \"\"", NULL};

const vnl_function vnl_domain_methods[] = {
    {"contains", domain_contains, "(x: number, y: number, z?: number): boolean", NULL,
     "Whether a point is inside.", NULL},
    {"distance", domain_distance, "(x: number, y: number, z?: number): number", NULL,
     "The distance to the border: positive inside, negative outside. Beside a surface: to the surface.",
     NULL},
    {"closest", domain_closest, "(x: number, y: number, z?: number): number, number, number?", NULL,
     "The border's nearest point. Beside a surface: the surface's.", NULL},
    {"value", domain_value, "(x: number, y: number, z?: number): number", NULL,
     "Its value there, in [0, 1]: 1 inside and 0 outside where it has no values of its own.", NULL},
    {"bounds", domain_bounds, "(): venule.Bounds", NULL, "The box around it: {min = {…}, max = {…}}.", NULL},
    {"measure", domain_measure, "(): number", NULL, "Its area, or in 3D its volume; of a surface its area.",
     NULL},
    {"sample", domain_sample, "(n: integer, options: venule.sample.Options): number[][]", NULL,
     "Throw n darts, uniformly distributed; the points {x, y} of those that stick. `rng` is required; with "
     "`spacing` a "
     "dart that close to an earlier one is refused.",
     &sample_schema},
    {"__sub", domain_minus, "(other: venule.Domain): venule.Domain", NULL,
     "`a - b`: what is in a and not in b.", NULL},
    {"__add", domain_plus, "(other: venule.Domain): venule.Domain", NULL, "`a + b`: what is in a or in b.",
     NULL},
    {"__mul", domain_times, "(other: venule.Domain): venule.Domain", NULL, "`a * b`: what is in both.", NULL},
    {0},
};

const vnl_class vnl_domain_class = {
    .name = "domain",
    .doc = "Where something may grow. Domains combine: `blade - hole`, `a + b`, `a * b`.",
    .methods = vnl_domain_methods,
    .fields = fields,
    .field = domain_field,
    .release = release_domain,
};
