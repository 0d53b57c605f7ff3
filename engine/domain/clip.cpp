// Shim over Clipper, which computes with integers: outlines are moved to the centre of their joint bounds and
// scaled by a power of two, so that what is representable stays exactly what it was.
#include "base/guard.hpp"

extern "C" {
#include "domain/rings.h"
}

#include <polyclipping/clipper.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace {

using ClipperLib::Clipper;
using ClipperLib::IntPoint;
using ClipperLib::Path;
using ClipperLib::Paths;

// Coordinates get 40 bits beside the sign: 1e-12 of the size, and far inside Clipper's 62.
constexpr int coordinate_bits = 40;

// Clipper's sweep gives up on some drawings with many horizontal edges, but hardly ever on the same ones
// turned.
struct Turn {
    double cosine, sine;
};
constexpr Turn turns[] = {{1, 0}, {0, 1}, {0.8, 0.6}, {-5.0 / 13, 12.0 / 13}, {20.0 / 29, -21.0 / 29}};

struct Scale {
    double center_x = 0;
    double center_y = 0;
    double factor = 1;
    Turn turn = turns[0];

    IntPoint to_integers(double x, double y) const {
        double dx = (x - center_x) * factor;
        double dy = (y - center_y) * factor;
        return IntPoint(std::llround(turn.cosine * dx - turn.sine * dy),
                        std::llround(turn.sine * dx + turn.cosine * dy));
    }
    double x_of(const IntPoint &p) const {
        return center_x +
               (turn.cosine * static_cast<double>(p.X) + turn.sine * static_cast<double>(p.Y)) / factor;
    }
    double y_of(const IntPoint &p) const {
        return center_y +
               (turn.cosine * static_cast<double>(p.Y) - turn.sine * static_cast<double>(p.X)) / factor;
    }
};

class Bounds {
  public:
    void add(const vn_rings &rings) {
        for (int32_t i = 0; i < rings.x.count; i++) {
            low_x_ = std::min(low_x_, rings.x.data[i]);
            high_x_ = std::max(high_x_, rings.x.data[i]);
            low_y_ = std::min(low_y_, rings.y.data[i]);
            high_y_ = std::max(high_y_, rings.y.data[i]);
        }
    }

    // Halves are added, because the sum of two coordinates may overflow.
    Scale scale() const {
        Scale scale;
        double half = std::max(high_x_ / 2 - low_x_ / 2, high_y_ / 2 - low_y_ / 2);
        if (!(half > 0)) {
            return scale;
        }
        scale.center_x = low_x_ / 2 + high_x_ / 2;
        scale.center_y = low_y_ / 2 + high_y_ / 2;
        scale.factor = std::ldexp(1.0, std::clamp(coordinate_bits - std::ilogb(half) - 1, -1000, 1000));
        return scale;
    }

  private:
    double low_x_ = std::numeric_limits<double>::infinity();
    double low_y_ = low_x_;
    double high_x_ = -low_x_;
    double high_y_ = -low_x_;
};

Paths paths_of(const vn_rings &rings, const Scale &scale) {
    Paths paths;
    paths.reserve(static_cast<size_t>(rings.ends.count));
    for (int32_t ring = 0; ring < rings.ends.count; ring++) {
        Path path;
        for (int32_t i = vn_rings_begin(&rings, ring); i < rings.ends.data[ring]; i++) {
            path.push_back(scale.to_integers(rings.x.data[i], rings.y.data[i]));
        }
        paths.push_back(std::move(path));
    }
    return paths;
}

vn_status store(vn_rings *out, const Paths &paths, const Scale &scale) {
    for (const Path &path : paths) {
        for (const IntPoint &p : path) {
            VN_TRY(vn_rings_point(out, scale.x_of(p), scale.y_of(p)));
        }
        VN_TRY(vn_rings_close(out));
    }
    return VN_OK;
}

/// `clip` may be null. At last, a margin is taken off.
struct Job {
    const vn_rings *subject;
    const vn_rings *clip;
    ClipperLib::ClipType type;
    ClipperLib::PolyFillType fill;
    double margin;
};

void inset(Paths &paths, double margin) {
    ClipperLib::ClipperOffset offset(2, 1e-6 * margin);
    offset.AddPaths(paths, ClipperLib::jtRound, ClipperLib::etClosedPolygon);
    offset.Execute(paths, -margin);
}

// Clipper calls it a failure when it was given nothing that has an area.
bool attempt(const Job &job, const Scale &scale, Paths &solution) {
    Clipper clipper;
    bool any = clipper.AddPaths(paths_of(*job.subject, scale), ClipperLib::ptSubject, true);
    if (job.clip != nullptr) {
        any |= clipper.AddPaths(paths_of(*job.clip, scale), ClipperLib::ptClip, true);
    }
    return !any || clipper.Execute(job.type, solution, job.fill, job.fill);
}

vn_status execute(vn_rings *out, const Job &job) {
    Bounds bounds;
    bounds.add(*job.subject);
    if (job.clip != nullptr) {
        bounds.add(*job.clip);
    }
    Scale scale = bounds.scale();
    for (const Turn &turn : turns) {
        Paths solution;
        scale.turn = turn;
        if (attempt(job, scale, solution)) {
            if (job.margin > 0) {
                inset(solution, job.margin * scale.factor);
            }
            return store(out, solution, scale);
        }
    }
    return vn_fail(VN_EXTERNAL, "Clipper could not combine the outlines");
}

// What was stored before a failure is given back.
template <typename Body>
vn_status into(vn_rings *out, Body &&body) noexcept {
    *out = vn_rings{};
    vn_status status = vn_guard("combining outlines", body);
    if (status != VN_OK) {
        vn_rings_free(out);
    }
    return status;
}

ClipperLib::ClipType type_of(vn_combination how) {
    switch (how) {
    case VN_DIFFERENCE:
        return ClipperLib::ctDifference;
    case VN_INTERSECTION:
        return ClipperLib::ctIntersection;
    default:
        return ClipperLib::ctUnion;
    }
}

} // namespace

extern "C" vn_status vn_rings_resolve(vn_rings *out, const vn_rings *rings, vn_fill fill) {
    auto rule = fill == VN_FILL_NONZERO ? ClipperLib::pftNonZero : ClipperLib::pftEvenOdd;
    return into(out, [&] { return execute(out, {rings, nullptr, ClipperLib::ctUnion, rule, 0}); });
}

extern "C" vn_status vn_rings_combine(vn_rings *out, const vn_rings *a, const vn_rings *b,
                                      vn_combination how) {
    return into(out, [&] { return execute(out, {a, b, type_of(how), ClipperLib::pftEvenOdd, 0}); });
}

extern "C" vn_status vn_rings_inset(vn_rings *out, const vn_rings *rings, double margin) {
    return into(out, [&] {
        return execute(out, {rings, nullptr, ClipperLib::ctUnion, ClipperLib::pftEvenOdd, margin});
    });
}
