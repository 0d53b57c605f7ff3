// Shim over CGAL's Delaunay triangulation in the plane.
#include "base/guard.hpp"
#include "space/delaunay.hpp"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;

using Vertices = CGAL::Triangulation_vertex_base_with_info_2<Number, Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<Vertices, CGAL::Triangulation_ds_face_base_2<>>;
using Triangulation = CGAL::Delaunay_triangulation_2<Kernel, Structure>;

// Of the triangle p, a, b; INFINITY when it is flat to rounding.
double circumradius(const Point &p, const Point &a, const Point &b) {
    double ax = a.x() - p.x(), ay = a.y() - p.y(), bx = b.x() - p.x(), by = b.y() - p.y();
    double area = std::fabs(ax * by - ay * bx);
    double sides = std::hypot(ax, ay) * std::hypot(bx, by) * std::hypot(ax - bx, ay - by);
    double least = 1e-12 * (std::fabs(ax * by) + std::fabs(ay * bx));
    return area > least ? sides / (2 * area) * (1 + 1e-3) : std::numeric_limits<double>::infinity();
}

class Delaunay2 final : public Delaunay<Triangulation> {
  public:
    void insert(const double p[3], int32_t near) override {
        append(triangulation.insert(Point(p[0], p[1]), face_near(near)));
    }

    double neighbors(const double p[3], int32_t near) override {
        Point point(p[0], p[1]);
        found.clear();
        if (triangulation.dimension() < 1) {
            return find_everybody(); // one place has no face to be found in
        }
        Triangulation::Locate_type type;
        int li;
        Triangulation::Face_handle face = triangulation.locate(point, type, li, face_near(near));
        if (type == Triangulation::VERTEX) {
            find_all_at(face->vertex(li));
            return 0;
        }
        if (triangulation.dimension() < 2) {
            return find_everybody();
        }
        border.clear();
        triangulation.get_boundary_of_conflicts(point, std::back_inserter(border), face);
        double farthest = 0;
        for (const Triangulation::Edge &edge : border) {
            farthest = std::max(farthest, visit(point, edge));
        }
        return farthest;
    }

  private:
    Triangulation::Face_handle face_near(int32_t near) const {
        bool known = near >= 0 && near < count();
        return known ? vertices[static_cast<size_t>(near)]->face() : Triangulation::Face_handle();
    }

    // The border is a closed polygon: each of its corners is the first end of one edge.
    double visit(const Point &point, const Triangulation::Edge &edge) {
        Vertex a = edge.first->vertex(Triangulation::cw(edge.second));
        Vertex b = edge.first->vertex(Triangulation::ccw(edge.second));
        if (!triangulation.is_infinite(a)) {
            find_all_at(a);
        }
        bool unbounded = triangulation.is_infinite(a) || triangulation.is_infinite(b);
        return unbounded ? std::numeric_limits<double>::infinity()
                         : circumradius(point, a->point(), b->point());
    }

    std::vector<Triangulation::Edge> border;
};

} // namespace

std::unique_ptr<vn_delaunay> vn_delaunay_make_2() {
    return std::make_unique<Delaunay2>();
}

extern "C" vn_status vn_delaunay_create(vn_delaunay **out, int dim) {
    *out = nullptr;
    return vn_guard("a triangulation", [&] {
        *out = (dim == 2 ? vn_delaunay_make_2() : vn_delaunay_make_3()).release();
        return VN_OK;
    });
}

extern "C" void vn_delaunay_destroy(vn_delaunay *delaunay) {
    delete delaunay;
}

extern "C" int32_t vn_delaunay_count(const vn_delaunay *delaunay) {
    return delaunay->count();
}

extern "C" vn_status vn_delaunay_update(vn_delaunay *delaunay, const vn_points *points, const int32_t *near,
                                        int32_t count) {
    return vn_guard("a triangulation", [&] {
        for (int32_t i = delaunay->count(); i < count; i++) {
            double p[3];
            vn_points_get(points, i, p);
            delaunay->insert(p, near[i]);
        }
        return VN_OK;
    });
}

extern "C" vn_status vn_delaunay_neighbors(vn_delaunay *delaunay, const double p[3], int32_t near,
                                           vn_indices *neighbors, double *radius) {
    return vn_guard("a triangulation's neighbors", [&] {
        *radius = delaunay->neighbors(p, near);
        VN_TRY(vn_array_reserve(neighbors, static_cast<int64_t>(delaunay->found.size())));
        std::copy(delaunay->found.begin(), delaunay->found.end(), neighbors->data);
        neighbors->count = static_cast<int32_t>(delaunay->found.size());
        return VN_OK;
    });
}

extern "C" int vn_compare_distances(const double p[3], const double a[3], const double b[3]) {
    using Point3 = Kernel::Point_3;
    return CGAL::compare_distance(Point3(p[0], p[1], p[2]), Point3(a[0], a[1], a[2]),
                                  Point3(b[0], b[1], b[2]));
}
