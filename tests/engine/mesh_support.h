/// Meshes for tests, and the slow and obvious answers about triangles.
#ifndef VN_TESTS_MESH_SUPPORT_H
#define VN_TESTS_MESH_SUPPORT_H

#include "domain/faces.h"
#include "space/triangle_tree.h"
#include "support.h"

static const double pi = 3.141592653589793;

typedef struct mesh {
    VN_ARRAY(double) xyz;
    vn_corners corners;
} mesh;

int32_t put_vertex(mesh *m, const double p[3]);
void put_triangle(mesh *m, int32_t a, int32_t b, int32_t c);
void free_mesh(mesh *m);

/// A sheet over [0, 1]², n by m squares.
typedef void place_fn(double u, double v, double p[3]);
mesh sheet(place_fn *place, int n, int m);
/// An octahedron whose faces are cut and blown up.
mesh globe(int n, double radius);
/// A box with faces outwards.
void put_box(mesh *m, double x0, double y0, double z0, double x1, double y1, double z1);
mesh box_mesh(double low, double high);
/// The inside of scripts/data/liver.obj, lengths in mm.
vn_domain *liver(void);

void on_sphere(double x, double y, double z, double radius, double p[3]);

void set(double p[3], double x, double y, double z);
double dot_of(const double a[3], const double b[3]);
/// (a - o) x (b - o)
void cross_of(const double o[3], const double a[3], const double b[3], double n[3]);
double to_segment(const double p[3], const double a[3], const double b[3]);
/// The plane's distance over the triangle, elsewhere the nearest edge's.
double to_triangle(const double p[3], const vn_triangle *t);

#endif
