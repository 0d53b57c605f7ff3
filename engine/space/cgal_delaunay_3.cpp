// Shim over CGAL's Delaunay triangulation in space.
#include "base/guard.hpp"
#include "space/delaunay.hpp"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <iterator>

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

using Vertices = CGAL::Triangulation_vertex_base_with_info_3<Number, Kernel>;
using Cells = CGAL::Delaunay_triangulation_cell_base_3<Kernel>;
using Structure = CGAL::Triangulation_data_structure_3<Vertices, Cells>;
using Triangulation = CGAL::Delaunay_triangulation_3<Kernel, Structure>;

class Delaunay3 final : public Delaunay<Triangulation> {
  public:
    void insert(const double p[3], int32_t near) override {
        append(triangulation.insert(Point(p[0], p[1], p[2]), cell_near(near)));
    }

    double neighbors(const double p[3], int32_t near) override {
        Point point(p[0], p[1], p[2]);
        found.clear();
        Triangulation::Locate_type type;
        int li, lj;
        Triangulation::Cell_handle cell = triangulation.locate(point, type, li, lj, cell_near(near));
        if (type == Triangulation::VERTEX) {
            find_all_at(cell->vertex(li));
            return 0;
        }
        if (triangulation.dimension() < 3) {
            return find_everybody();
        }
        facets.clear();
        triangulation.find_conflicts(point, cell, std::back_inserter(facets), CGAL::Emptyset_iterator());
        for (const Triangulation::Facet &facet : facets) {
            for (int k = 1; k < 4; k++) {
                Vertex corner = facet.first->vertex((facet.second + k) % 4);
                if (!triangulation.is_infinite(corner)) {
                    corners.push_back(corner->info());
                }
            }
        }
        find_corners();
        return std::numeric_limits<double>::infinity();
    }

  private:
    Triangulation::Cell_handle cell_near(int32_t near) const {
        bool known = near >= 0 && near < count();
        return known ? vertices[static_cast<size_t>(near)]->cell() : Triangulation::Cell_handle();
    }

    // Each corner is on several facets of the hole.
    void find_corners() {
        std::sort(corners.begin(), corners.end());
        corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
        for (int32_t corner : corners) {
            find_all_at(vertices[static_cast<size_t>(corner)]);
        }
        corners.clear();
    }

    std::vector<Triangulation::Facet> facets;
    std::vector<int32_t> corners;
};

} // namespace

std::unique_ptr<vn_delaunay> vn_delaunay_make_3() {
    return std::make_unique<Delaunay3>();
}
