/// What the triangulations of two and of three dimensions have in common.
#ifndef VN_SPACE_DELAUNAY_HPP
#define VN_SPACE_DELAUNAY_HPP

extern "C" {
#include "space/delaunay.h"
}

#include <limits>
#include <memory>
#include <vector>

struct vn_delaunay {
    vn_delaunay() = default;
    vn_delaunay(const vn_delaunay &) = delete;
    vn_delaunay &operator=(const vn_delaunay &) = delete;
    virtual ~vn_delaunay() = default;
    virtual void insert(const double p[3], int32_t near) = 0;
    virtual int32_t count() const = 0;
    /// Into `found`; returns the circumradius.
    virtual double neighbors(const double p[3], int32_t near) = 0;

    std::vector<int32_t> found;
};

std::unique_ptr<vn_delaunay> vn_delaunay_make_2();
std::unique_ptr<vn_delaunay> vn_delaunay_make_3();

/// A vertex knows its point's number; -1 until it has one.
struct Number {
    int32_t value = -1;
    operator int32_t() const {
        return value;
    }
    Number &operator=(int32_t other) {
        value = other;
        return *this;
    }
};

/// The part that does not depend on the dimension.
template <typename Triangulation>
class Delaunay : public vn_delaunay {
  public:
    using Vertex = typename Triangulation::Vertex_handle;

    int32_t count() const override {
        return static_cast<int32_t>(vertices.size());
    }

  protected:
    /// Coincident points share a vertex: `twin` leads from each to the next one there, in a circle.
    void append(Vertex vertex) {
        auto point = static_cast<int32_t>(vertices.size());
        twin.push_back(point);
        int32_t first = vertex->info();
        if (first < 0) {
            vertex->info() = point;
        } else {
            std::swap(twin[static_cast<size_t>(point)], twin[static_cast<size_t>(first)]);
        }
        vertices.push_back(vertex);
    }

    void find_all_at(Vertex vertex) {
        int32_t point = vertex->info();
        do {
            found.push_back(point);
            point = twin[static_cast<size_t>(point)];
        } while (point != vertex->info());
    }

    /// While the points are on one line, or in one plane in 3D: everybody.
    double find_everybody() {
        for (auto v = triangulation.finite_vertices_begin(); v != triangulation.finite_vertices_end(); ++v) {
            find_all_at(v);
        }
        return std::numeric_limits<double>::infinity();
    }

    Triangulation triangulation;
    std::vector<Vertex> vertices;
    std::vector<int32_t> twin;
};

#endif
