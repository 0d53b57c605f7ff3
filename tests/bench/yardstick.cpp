#include "yardstick.h"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <chrono>
#include <random>
#include <vector>

namespace {

using kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using triangulation = CGAL::Delaunay_triangulation_2<kernel>;

std::vector<kernel::Point_2> uniform_points(int count) {
    std::mt19937_64 generator(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<kernel::Point_2> points;
    points.reserve(static_cast<size_t>(count));
    for (int i = 0; i < count; i++) {
        double x = uniform(generator);
        double y = uniform(generator);
        points.emplace_back(x, y);
    }
    return points;
}

} // namespace

extern "C" double vn_yardstick(int points) try {
    std::vector<kernel::Point_2> places = uniform_points(points);
    auto begin = std::chrono::steady_clock::now();
    triangulation delaunay;
    delaunay.insert(places.begin(), places.end());
    std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    return delaunay.number_of_vertices() > 0 ? seconds.count() : -1;
} catch (...) {
    return -1;
}
