#include "mesh_support.h"

int32_t put_vertex(mesh *m, const double p[3]) {
    for (int k = 0; k < 3; k++) {
        assert_ok(vn_array_push(&m->xyz, p[k]));
    }
    return m->xyz.count / 3 - 1;
}

void put_triangle(mesh *m, int32_t a, int32_t b, int32_t c) {
    assert_ok(vn_array_push(&m->corners, a));
    assert_ok(vn_array_push(&m->corners, b));
    assert_ok(vn_array_push(&m->corners, c));
}

void free_mesh(mesh *m) {
    vn_array_free(&m->xyz);
    vn_array_free(&m->corners);
}

void set(double p[3], double x, double y, double z) {
    p[0] = x;
    p[1] = y;
    p[2] = z;
}

mesh sheet(place_fn *place, int n, int m) {
    mesh s = {0};
    for (int j = 0; j <= m; j++) {
        for (int i = 0; i <= n; i++) {
            double p[3];
            place((double)i / n, (double)j / m, p);
            put_vertex(&s, p);
        }
    }
    for (int j = 0; j < m; j++) {
        for (int i = 0; i < n; i++) {
            int32_t a = j * (n + 1) + i;
            put_triangle(&s, a, a + 1, a + n + 2);
            put_triangle(&s, a, a + n + 2, a + n + 1);
        }
    }
    return s;
}

void on_sphere(double x, double y, double z, double radius, double p[3]) {
    double length = sqrt(x * x + y * y + z * z);
    set(p, radius * x / length, radius * y / length, radius * z / length);
}

mesh globe(int n, double radius) {
    mesh m = {0};
    for (int octant = 0; octant < 8; octant++) {
        int sx = octant & 1 ? -1 : 1, sy = octant & 2 ? -1 : 1, sz = octant & 4 ? -1 : 1;
        for (int i = 0; i <= n; i++) {
            int32_t row = m.xyz.count / 3;
            for (int j = 0; j <= i; j++) {
                double p[3];
                on_sphere(sx * (n - i), sy * (i - j), sz * j, radius, p);
                put_vertex(&m, p);
            }
            for (int j = 0; i > 0 && j < i; j++) {
                put_triangle(&m, row + j, row + j + 1, row - i + j);
            }
            for (int j = 0; i > 0 && j < i - 1; j++) {
                put_triangle(&m, row - i + j, row - i + j + 1, row + j + 1);
            }
        }
    }
    return m;
}

double to_segment(const double p[3], const double a[3], const double b[3]) {
    double along = 0, length2 = vn_distance2(a, b), q[3];
    for (int k = 0; k < 3; k++) {
        along += (p[k] - a[k]) * (b[k] - a[k]);
    }
    along = fmin(fmax(along / length2, 0), 1);
    for (int k = 0; k < 3; k++) {
        q[k] = a[k] + along * (b[k] - a[k]);
    }
    return sqrt(vn_distance2(p, q));
}

void cross_of(const double o[3], const double a[3], const double b[3], double n[3]) {
    double u[3], v[3];
    for (int k = 0; k < 3; k++) {
        u[k] = a[k] - o[k];
        v[k] = b[k] - o[k];
    }
    set(n, u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
}

double dot_of(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double to_triangle(const double p[3], const vn_triangle *t) {
    double n[3], n1[3], n2[3], n3[3], ap[3];
    cross_of(t->a, t->b, t->c, n);
    cross_of(p, t->a, t->b, n1);
    cross_of(p, t->b, t->c, n2);
    cross_of(p, t->c, t->a, n3);
    if (dot_of(n, n1) > 0 && dot_of(n, n2) > 0 && dot_of(n, n3) > 0) {
        for (int k = 0; k < 3; k++) {
            ap[k] = p[k] - t->a[k];
        }
        return fabs(dot_of(ap, n)) / sqrt(dot_of(n, n));
    }
    return fmin(to_segment(p, t->a, t->b), fmin(to_segment(p, t->b, t->c), to_segment(p, t->c, t->a)));
}

void put_box(mesh *m, double x0, double y0, double z0, double x1, double y1, double z1) {
    static const int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    int32_t v[8];
    for (int i = 0; i < 8; i++) {
        v[i] = put_vertex(m, (double[3]){i & 1 ? x1 : x0, i & 2 ? y1 : y0, i & 4 ? z1 : z0});
    }
    for (int f = 0; f < 6; f++) {
        put_triangle(m, v[faces[f][0]], v[faces[f][1]], v[faces[f][2]]);
        put_triangle(m, v[faces[f][0]], v[faces[f][2]], v[faces[f][3]]);
    }
}

mesh box_mesh(double low, double high) {
    mesh m = {0};
    put_box(&m, low, low, low, high, high, high);
    return m;
}

vn_domain *liver(void) {
    vn_mesh_def def = vn_mesh_def_default();
    vn_domain *domain = NULL;
    def.on = 1;
    assert_ok(vn_domain_mesh(&domain, VN_SOURCE_DIR "/scripts/data/liver.obj", &def));
    return domain;
}
