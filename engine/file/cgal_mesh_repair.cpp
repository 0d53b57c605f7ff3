// Shim over CGAL's Polygon Mesh Processing.
#include "base/guard.hpp"

extern "C" {
#include "file/mesh_repair.h"
}

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Halfedge = Mesh::Halfedge_index;
using Face = std::vector<std::size_t>;

constexpr int MOST_HOLE_EDGES = 500; // the best triangles of a hole take the cube of that

struct Soup {
    std::vector<Point> points;
    std::vector<Face> faces;
};

Soup read_soup(const vn_faces &faces) {
    Soup soup;
    for (int64_t i = 0; i < faces.vertices; i++) {
        const double *p = faces.xyz + 3 * i;
        soup.points.emplace_back(p[0], p[1], p[2]);
    }
    const int32_t *corners = faces.corners;
    for (int32_t i = 0; i < faces.count; i++) {
        int32_t size = faces.sizes != nullptr ? faces.sizes[i] : 3;
        soup.faces.emplace_back(corners, corners + size);
        corners += size;
    }
    return soup;
}

double extent_of(const Soup &soup) {
    CGAL::Bbox_3 box;
    for (const Point &p : soup.points) {
        box += p.bbox();
    }
    return std::sqrt(std::pow(box.x_span(), 2) + std::pow(box.y_span(), 2) + std::pow(box.z_span(), 2));
}

/// Points by cells as wide as the tolerance: what is near is in a cell or beside it.
class Near {
  public:
    explicit Near(double tolerance) : tolerance_(tolerance) {}

    /// The first point put before that is within the tolerance of @p p, or @p own, which is put.
    std::size_t first(const std::vector<Point> &points, std::size_t own) {
        const Point &p = points[own];
        Cell at{cell(p.x()), cell(p.y()), cell(p.z())};
        std::size_t found = own;
        for (int i = 0; i < 27; i++) {
            auto near = cells_.find({at[0] + i % 3 - 1, at[1] + i / 3 % 3 - 1, at[2] + i / 9 - 1});
            for (std::size_t other : near != cells_.end() ? near->second : none_) {
                if (CGAL::squared_distance(points[other], p) <= tolerance_ * tolerance_) {
                    found = std::min(found, other);
                }
            }
        }
        if (found == own) {
            cells_[at].push_back(own);
        }
        return found;
    }

  private:
    using Cell = std::array<double, 3>;
    double cell(double x) const {
        return std::floor(x / tolerance_);
    }
    double tolerance_;
    std::map<Cell, std::vector<std::size_t>> cells_;
    const std::vector<std::size_t> none_;
};

// The first of those that nearly coincide stands for all.
void merge_points(Soup &soup, vn_repairs &repairs) {
    Near near(1e-7 * extent_of(soup));
    std::vector<std::size_t> first(soup.points.size());
    for (std::size_t i = 0; i < first.size(); i++) {
        first[i] = near.first(soup.points, i);
        repairs.merged += first[i] != i;
    }
    for (Face &face : soup.faces) {
        for (std::size_t &corner : face) {
            corner = first[corner];
        }
    }
}

Kernel::Vector_3 normal_of(const std::vector<Point> &points, const Face &face) {
    Kernel::Vector_3 sum(0, 0, 0);
    for (std::size_t k = 1; k + 1 < face.size(); k++) {
        sum = sum +
              CGAL::cross_product(points[face[k]] - points[face[0]], points[face[k + 1]] - points[face[0]]);
    }
    return sum;
}

// Which way all face is open: of either way, the one with fewer to turn is what was wrong.
void orient(Soup &soup, vn_repairs &repairs) {
    std::vector<Kernel::Vector_3> before;
    int32_t turned = 0;
    for (const Face &face : soup.faces) {
        before.push_back(normal_of(soup.points, face));
    }
    PMP::orient_polygon_soup(soup.points, soup.faces);
    for (std::size_t i = 0; i < soup.faces.size(); i++) {
        turned += before[i] * normal_of(soup.points, soup.faces[i]) < 0;
    }
    repairs.turned = std::min(turned, static_cast<int32_t>(soup.faces.size()) - turned);
}

void clean(Soup &soup, vn_repairs &repairs) {
    std::size_t count = soup.faces.size();
    merge_points(soup, repairs);
    PMP::repair_polygon_soup(soup.points, soup.faces);
    repairs.removed = static_cast<int32_t>(count - std::min(count, soup.faces.size()));
    orient(soup, repairs);
}

void sew(Mesh &mesh, vn_repairs &repairs) {
    repairs.sewn += static_cast<int32_t>(PMP::stitch_borders(mesh));
    PMP::triangulate_faces(mesh);
    std::vector<Mesh::Face_index> flat;
    PMP::degenerate_faces(mesh, std::back_inserter(flat));
    PMP::remove_degenerate_faces(mesh);
    repairs.removed += static_cast<int32_t>(flat.size());
}

int32_t length_of(const Mesh &mesh, Halfedge border) {
    int32_t length = 0;
    for (Halfedge h : CGAL::halfedges_around_face(border, mesh)) {
        (void)h;
        length++;
    }
    return length;
}

vn_status fill(Mesh &mesh, const char *what, vn_repairs &repairs) {
    std::vector<Halfedge> holes;
    PMP::extract_boundary_cycles(mesh, std::back_inserter(holes));
    for (Halfedge hole : holes) {
        int32_t length = length_of(mesh, hole);
        std::vector<Mesh::Face_index> patch;
        if (length > MOST_HOLE_EDGES) {
            return vn_fail(
                VN_INVALID,
                "%s: a hole of %d edges is above the limit of %d for repair: close it, or take the "
                "surface (on = \"surface\")",
                what, length, MOST_HOLE_EDGES);
        }
        // Delaunay triangulations are faster, but choose between equals by chance.
        PMP::triangulate_hole(mesh, hole, std::back_inserter(patch),
                              CGAL::parameters::use_delaunay_triangulation(false));
        repairs.holes += !patch.empty();
        repairs.largest_hole = std::max(repairs.largest_hole, patch.empty() ? 0 : length);
        VN_TRY(vn_poll());
    }
    return VN_OK;
}

vn_status store(vn_polygons *out, const Mesh &mesh) {
    std::vector<int32_t> number(mesh.num_vertices());
    int32_t next = 0;
    for (Mesh::Vertex_index v : mesh.vertices()) {
        number[v] = next++;
        for (int k = 0; k < 3; k++) {
            VN_TRY(vn_array_push(&out->xyz, mesh.point(v)[k]));
        }
    }
    for (Mesh::Face_index f : mesh.faces()) {
        VN_TRY(vn_array_push(&out->sizes, 3));
        for (Mesh::Vertex_index v : CGAL::vertices_around_face(mesh.halfedge(f), mesh)) {
            VN_TRY(vn_array_push(&out->corners, number[v]));
        }
    }
    return VN_OK;
}

vn_status repair(vn_polygons *out, const vn_faces &faces, bool close, vn_repairs &repairs) {
    Soup soup = read_soup(faces);
    Mesh mesh;
    clean(soup, repairs);
    VN_TRY(vn_poll());
    PMP::polygon_soup_to_polygon_mesh(soup.points, soup.faces, mesh);
    sew(mesh, repairs);
    if (mesh.number_of_faces() == 0) {
        return vn_fail(VN_INVALID, "%s: the mesh cannot be repaired: none of its %d faces has an area",
                       faces.what, faces.count);
    }
    VN_TRY(close ? fill(mesh, faces.what, repairs) : VN_OK);
    return store(out, mesh);
}

} // namespace

extern "C" vn_status vn_mesh_repair(vn_polygons *out, const vn_faces *faces, bool close,
                                    vn_repairs *repairs) {
    VN_TRY(vn_faces_check(faces));
    return vn_guard(faces->what, [&] { return repair(out, *faces, close, *repairs); });
}
