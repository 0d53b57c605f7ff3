// Meshes as they come, from memory and from files: every format gives the same surface, and nothing that is
// said of one is believed.
#include "mesh_support.h"

#include "file/mesh.h"

// ---- Meshes in memory ----

static const double corners3[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};

static vn_status try_mesh(const double *xyz, int32_t vertices, const int32_t *triangles, int32_t count) {
    vn_domain *domain;
    vn_status status = vn_domain_surface(&domain, xyz, vertices, triangles, count);
    assert_true((domain == NULL) == (status != VN_OK));
    vn_domain_release(domain);
    return status;
}

static void bad_meshes_are_refused_with_their_place(void **state) {
    (void)state;
    static const int32_t good[] = {0, 1, 2, 1, 3, 2};
    assert_ok(try_mesh(corners3, 4, good, 2));
    assert_int_equal(try_mesh(corners3, 4, good, 0), VN_INVALID);
    assert_message("surface: the mesh is empty: it has 4 vertices and 0 faces");
    assert_int_equal(try_mesh(corners3, 0, good, 2), VN_INVALID);
    assert_int_equal(try_mesh(corners3, -1, good, -1), VN_INVALID);
    assert_int_equal(try_mesh(corners3, 3, good, 2), VN_INVALID);
    assert_message("surface: face 1 has a corner at vertex 3, but the vertices are 0 to 2");
    assert_int_equal(try_mesh(corners3, 4, (int32_t[]){0, 1, 2, 0, -7, 1}, 2), VN_INVALID);
    assert_message("face 1 has a corner at vertex -7");
    assert_int_equal(try_mesh(corners3, 4, (int32_t[]){0, 1, 1}, 1), VN_INVALID);
    assert_message("surface: face 0 has no area");
    double xyz[12];
    static const double wrong[] = {NAN, INFINITY, -INFINITY, 1e61};
    for (int k = 0; k < 4; k++) {
        memcpy(xyz, corners3, sizeof xyz);
        xyz[7] = wrong[k];
        assert_int_equal(try_mesh(xyz, 4, good, 2), VN_INVALID);
        assert_message("surface: vertex 2: y = ");
    }
    memset(xyz, 0, sizeof xyz);
    assert_int_equal(try_mesh(xyz, 4, good, 2), VN_INVALID);
    assert_message("all at one place");
    for (int i = 0; i < 4; i++) {
        set(xyz + 3 * i, 1 + 0.1 * i, 2 + 0.2 * i, 3 + 0.3 * i); // on one line, but for rounding
    }
    assert_int_equal(try_mesh(xyz, 4, good, 2), VN_INVALID);
    assert_message("no area");
}

static vn_status cut(const double *xyz, int32_t vertices, int32_t size, vn_corners *out) {
    int32_t corners[1100];
    for (int32_t i = 0; i < size; i++) {
        corners[i] = i;
    }
    vn_faces faces = {.what = "f.obj",
                      .first = 1,
                      .xyz = xyz,
                      .vertices = vertices,
                      .corners = corners,
                      .sizes = &size,
                      .count = 1};
    return vn_faces_triangulate(&faces, out);
}

// The triangles of a face have its area, and turn as it does.
static void polygons_are_cut_into_triangles(void **state) {
    (void)state;
    vn_rng rng = vn_rng_make(3);
    for (int32_t size = 3; size <= 40; size++) {
        double xyz[3 * 40], area = 0, sum = 0, n[3];
        for (int32_t i = 0; i < size; i++) { // star-shaped about the origin, in a tilted plane
            double angle = 2 * pi * i / size, radius = uniform(&rng, size == 4 ? 0.2 : 0.5, 1.5);
            double x = radius * cos(angle), y = radius * sin(angle);
            set(xyz + 3 * i, x, y, 0.5 * x - 0.2 * y);
        }
        for (int32_t i = 0; i < size; i++) {
            const double *p = xyz + 3 * i, *q = xyz + 3 * ((i + 1) % size);
            area += 0.5 * (p[0] * q[1] - p[1] * q[0]);
        }
        vn_corners triangles = {0};
        assert_ok(cut(xyz, size, size, &triangles));
        assert_int_equal(triangles.count, 3 * (size - 2));
        for (int32_t t = 0; t < triangles.count; t += 3) {
            const int32_t *c = triangles.data + t;
            cross_of(xyz + 3 * c[0], xyz + 3 * c[1], xyz + 3 * c[2], n);
            assert_true(n[2] > 0);
            sum += 0.5 * n[2];
        }
        assert_near(sum, area, 1e-12);
        vn_array_free(&triangles);
    }
    vn_corners none = {0};
    static const double bow[] = {0, 0, 0, 1, 1, 0, 1, 0, 0, 0, 1, 0};
    double many[3 * 1001] = {1};
    assert_int_equal(cut(bow, 4, 4, &none), VN_INVALID);
    assert_message("f.obj: face 1 crosses itself");
    assert_int_equal(cut(bow, 4, 2, &none), VN_INVALID);
    assert_message("f.obj: face 1 has 2 corners");
    assert_int_equal(cut(many, 1001, 1001, &none), VN_INVALID);
    assert_message("more than 1000");
    vn_array_free(&none);
}

static void a_mesh_loses_nothing_when_memory_runs_out(void **state) {
    (void)state;
    static const int32_t good[] = {0, 1, 2, 1, 3, 2};
    vn_status status = VN_NO_MEMORY;
    for (int64_t nth = 0; status == VN_NO_MEMORY; nth++) {
        vn_fail_allocations_from(nth);
        status = try_mesh(corners3, 4, good, 2);
        vn_fail_allocations_from(-1);
        assert_true(nth < 100);
    }
    assert_ok(status);
}

// ---- Files ----

static const char *const file_name[] = {"mesh.obj", "mesh.off", "mesh.ply", "mesh.stl"};
enum { OBJ, OFF, PLY, STL };

static const char *put_file(int format, const void *bytes, size_t size) {
    FILE *file = fopen(file_name[format], "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    return file_name[format];
}

static vn_status load(int format, const void *bytes, size_t size, vn_domain **domain) {
    vn_mesh_def def = vn_mesh_def_default();
    vn_status status = vn_domain_mesh(domain, put_file(format, bytes, size), &def);
    assert_true((*domain == NULL) == (status != VN_OK));
    return status;
}

static vn_status try_text(int format, const char *text) {
    vn_domain *domain;
    vn_status status = load(format, text, strlen(text), &domain);
    vn_domain_release(domain);
    return status;
}

// A roof: a quadrangle of 2 x 1 that rises to z = 1, and a triangle that falls again.
static const double roof_area = 5.0644951022459797; // 2√2 + √5

static const char obj[] = "# a roof\nmtllib none.mtl\no roof\nv 0 0 0\nv 2 0 0\nv 2 1 1\nv 0 1 1\r\nv 1 3 0\n"
                          "vt 0 0\nvn 0 0 1\ng side\ns off\nf 1/1/1 2/1/1 3/1/1 4/1/1\nf -3 -2 -1\n";
static const char off[] =
    "OFF\n# a roof\n5 2 0\n0 0 0\n2 0 0\n2 1 1\n0 1 1\n1 3 0\n4 0 1 2 3\n3 2 3 4 255 0 0\n";
static const char ply[] = "ply\nformat ascii 1.0\ncomment a roof\nelement vertex 5\nproperty float x\n"
                          "property double y\nproperty float z\nproperty uchar red\nelement face 2\n"
                          "property list uchar int vertex_indices\nend_header\n0 0 0 9\n2 0 0 9\n2 1 1 9\n"
                          "0 1 1 9\n1 3 0 9\n4 0 1 2 3\n3 2 3 4\n";
static const char stl[] =
    "solid roof\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 2 0 0\nvertex 2 1 "
    "1\nendloop\nendfacet\n"
    "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 2 1 1\nvertex 0 1 1\nendloop\nendfacet\n"
    "facet normal 0 0 0\nouter loop\nvertex 2 1 1\nvertex 0 1 1\nvertex 1 3 0\nendloop\nendfacet\n"
    "endsolid roof\n";
static const char *const texts[] = {obj, off, ply, stl};

typedef struct bytes {
    unsigned char data[1024];
    size_t size;
} bytes;

static void put(bytes *b, const void *data, size_t size) {
    memcpy(b->data + b->size, data, size);
    b->size += size;
}

static const float roof[5][3] = {{0, 0, 0}, {2, 0, 0}, {2, 1, 1}, {0, 1, 1}, {1, 3, 0}};
static const int32_t roof_faces[2][4] = {{0, 1, 2, 3}, {2, 3, 4, -1}};

static bytes binary_ply(void) {
    static const char head[] = "ply\nformat binary_little_endian 1.0\nelement vertex 5\nproperty float x\n"
                               "property float y\nproperty float z\nelement face 2\n"
                               "property list uchar int vertex_index\nend_header\n";
    bytes b = {.size = 0};
    put(&b, head, strlen(head));
    put(&b, roof, sizeof roof);
    for (int f = 0; f < 2; f++) {
        unsigned char size = f == 0 ? 4 : 3;
        put(&b, &size, 1);
        put(&b, roof_faces[f], size * sizeof(int32_t));
    }
    return b;
}

static bytes binary_stl(uint32_t claimed) {
    static const int corners[3][3] = {{0, 1, 2}, {0, 2, 3}, {2, 3, 4}};
    static const char head[80] = "solid_works calls its binary files so, too";
    static const float normal[3] = {0, 0, 1};
    bytes b = {.size = 0};
    put(&b, head, sizeof head);
    put(&b, &claimed, sizeof claimed);
    for (int t = 0; t < 3; t++) {
        put(&b, normal, sizeof normal);
        for (int k = 0; k < 3; k++) {
            put(&b, roof[corners[t][k]], sizeof roof[0]);
        }
        put(&b, "\0", 2);
    }
    return b;
}

static void check_roof(int format, const void *data, size_t size) {
    vn_domain *domain;
    assert_ok(load(format, data, size, &domain));
    assert_near(vn_domain_measure(domain), roof_area, 1e-12);
    double slope[3] = {1, 2, 0.5}, eaves[3] = {1, 0, 0}, a[3] = {0.5, 0.99, 0.99}, b[3] = {1.5, 1.02, 0.99};
    assert_true(vn_domain_contains(domain, slope));
    assert_near(vn_domain_distance(domain, eaves), 0, 1e-12); // an edge of the border
    assert_true(vn_domain_sees(domain, a, b));                // across an edge that is none
    vn_domain_release(domain);
}

static void every_format_gives_the_same_surface(void **state) {
    (void)state;
    bytes p = binary_ply(), s = binary_stl(3);
    for (int format = OBJ; format <= STL; format++) {
        check_roof(format, texts[format], strlen(texts[format]));
    }
    check_roof(PLY, p.data, p.size);
    check_roof(STL, s.data, s.size);
}

static void files_that_lie_are_refused(void **state) {
    (void)state;
    static const struct {
        int format;
        const char *text, *message;
    } lies[] = {
        {OBJ, "", "mesh.obj: broken or cut off, or no mesh"},
        {OBJ, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "mesh.obj: face 1 has a corner that is no vertex"},
        {OBJ, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n", "mesh.obj: broken or cut off"},
        {OBJ, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -2147483648\n", "mesh.obj: "},
        {OBJ, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n", "mesh.obj: face 1 has 2 corners"},
        {OBJ, "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "mesh.obj: face 1 has no area"},
        {OBJ, "v 0 0 nan\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "mesh.obj: "},
        {OBJ, "v 0 0 1e400\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "mesh.obj: "},
        {OBJ, "<svg/>\n", "mesh.obj: broken"},
        {OFF, "OFF\n4000000000 1 0\n0 0 0\n", "claims 4000000000 of vertices, more than its bytes"},
        {OFF, "OFF\n3 99999999999999999999 0\n0 0 0\n", "gives no number of faces"},
        {OFF, "OFF\n-3 1 0\n0 0 0\n", "gives no number of vertices"},
        {OFF, "COFF\n3 1 0\n0 0 0 1\n1 0 0 1\n0 1 0 1\n3 0 1 2\n", "only the plain OFF"},
        {OFF, "OFF BINARY\nxxxxxxxxxxxxxxxxx", "gives no number of vertices"},
        {OFF, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n", "corners"},
        {OFF, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "mesh.off: "},
        {PLY, "ply\nformat ascii 1.0\nelement vertex 99999999\nproperty float x\nend_header\n",
         "claims 99999999 of vertex, more than its bytes"},
        {PLY,
         "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nelement face 1\n"
         "property list uchar int vertex_indices\nend_header\n0 0\n1 0\n0 1\n3 0 1 2\n",
         "names no vertices with x, y and z"},
        {PLY,
         "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 1\nproperty list uint int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n"
         "4000000000 0 1 2\n",
         "as long as a uint says"},
        {PLY,
         "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 1\nproperty list uchar short vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n"
         "3 0 1 2\n",
         "of the type short"},
        {PLY,
         "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n"
         "3 0 1 -2\n",
         "mesh.ply: face 1 has a corner that is no vertex"},
        {PLY, "not a ply\n", "mesh.ply: "},
        {STL,
         "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\nendsolid\n",
         "mesh.stl: broken"},
        {STL, "solid\nendsolid\n", "mesh.stl: the mesh is empty"},
    };
    for (size_t i = 0; i < sizeof lies / sizeof *lies; i++) {
        vn_status status = try_text(lies[i].format, lies[i].text);
        assert_true(status == VN_IO || status == VN_INVALID);
        assert_message(lies[i].message);
    }
    bytes s = binary_stl(4000000000U);
    vn_domain *domain;
    assert_int_equal(load(STL, s.data, s.size, &domain), VN_IO);
    assert_message("mesh.stl: its header claims 4000000000 triangles, more than its bytes");
    vn_mesh_def def = vn_mesh_def_default();
    assert_int_equal(vn_domain_mesh(&domain, "no-such.obj", &def), VN_IO);
    assert_message("no-such.obj: cannot be read");
    assert_int_equal(vn_domain_mesh(&domain, "mesh.3ds", &def), VN_INVALID);
    assert_int_equal(vn_domain_mesh(&domain, ".", &def), VN_INVALID);
    def.on = 2;
    assert_int_equal(vn_domain_mesh(&domain, "mesh.obj", &def), VN_INVALID);
}

// Cut off anywhere, a file is refused, or has its first face only; with a byte changed it is anything but
// fatal.
static void files_that_are_cut_off_or_damaged_do_no_harm(void **state) {
    (void)state;
    bytes all[6] = {binary_ply(), binary_stl(3)};
    static const int formats[6] = {PLY, STL, OBJ, OFF, PLY, STL};
    vn_rng rng = vn_rng_make(3);
    for (int k = 0; k < 6; k++) {
        if (k >= 2) {
            put(&all[k], texts[k - 2], strlen(texts[k - 2]));
        }
        vn_domain *domain;
        for (size_t size = 0; size < all[k].size; size++) {
            if (load(formats[k], all[k].data, size, &domain) == VN_OK) {
                assert_true(size + 40 > all[k].size || vn_domain_measure(domain) < roof_area);
            }
            vn_domain_release(domain);
        }
        for (int trial = 0; trial < 400; trial++) {
            bytes damaged = all[k];
            damaged.data[whole(&rng, 0, (int64_t)damaged.size - 1)] = (unsigned char)whole(&rng, 0, 255);
            load(formats[k], damaged.data, damaged.size, &domain);
            vn_domain_release(domain);
        }
    }
}

static void a_file_loses_nothing_when_memory_runs_out(void **state) {
    (void)state;
    for (int format = OBJ; format <= STL; format++) {
        vn_status status = VN_NO_MEMORY;
        for (int64_t nth = 0; status == VN_NO_MEMORY; nth++) {
            vn_fail_allocations_from(nth);
            status = try_text(format, texts[format]);
            vn_fail_allocations_from(-1);
            assert_true(nth < 100);
        }
        assert_ok(status);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(bad_meshes_are_refused_with_their_place),
        counted_test(polygons_are_cut_into_triangles),
        counted_test(a_mesh_loses_nothing_when_memory_runs_out),
        counted_test(every_format_gives_the_same_surface),
        counted_test(files_that_lie_are_refused),
        counted_test(files_that_are_cut_off_or_damaged_do_no_harm),
        counted_test(a_file_loses_nothing_when_memory_runs_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
