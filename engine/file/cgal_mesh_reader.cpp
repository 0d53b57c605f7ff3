// Shim over CGAL's readers of OBJ, OFF, PLY and STL. They believe what a file says of its own sizes, and in
// some variants of the formats read past their buffers: headers are looked at first, and what is read counts
// against the memory budget and the size of the file.
#include "base/guard.hpp"

extern "C" {
#include "file/mesh.h"
}

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/OBJ.h>
#include <CGAL/IO/OFF.h>
#include <CGAL/IO/PLY.h>
#include <CGAL/IO/STL.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace {

/// Memory within the budget.
template <typename T>
struct Budgeted {
    using value_type = T;
    Budgeted() = default;
    template <typename U>
    Budgeted(const Budgeted<U> &) {}
    T *allocate(std::size_t count) {
        void *block = count < SIZE_MAX / sizeof(T) ? vn_resize(nullptr, 0, count * sizeof(T)) : nullptr;
        if (block == nullptr) {
            throw std::bad_alloc();
        }
        return static_cast<T *>(block);
    }
    void deallocate(T *block, std::size_t count) {
        vn_resize(block, count * sizeof(T), 0);
    }
    friend bool operator==(const Budgeted &, const Budgeted &) {
        return true;
    }
    friend bool operator!=(const Budgeted &, const Budgeted &) {
        return false;
    }
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Points = std::vector<Point, Budgeted<Point>>;

/// What is wrong with a file.
struct Lie : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A face that does not take any number of corners that a file claims.
struct Face : std::vector<std::size_t, Budgeted<std::size_t>> {
    using Base = std::vector<std::size_t, Budgeted<std::size_t>>;
    void resize(std::size_t count) {
        if (count > 1000000) {
            throw Lie("a face claims " + std::to_string(count) + " corners");
        }
        Base::resize(count);
    }
};
using Faces = std::vector<Face, Budgeted<Face>>;

struct File {
    const char *path;
    std::uintmax_t size;
    std::ifstream stream;
};

void rewind(File &file) {
    file.stream.clear();
    file.stream.seekg(0);
}

// A vertex or a face takes a byte at least.
void check_count(const File &file, const std::string &what, const std::string &word) {
    bool digits = !word.empty() && word.size() < 19 &&
                  std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isdigit(c); });
    if (!digits) {
        throw Lie("its header gives no number of " + what);
    }
    if (std::stoull(word) > file.size) {
        throw Lie("its header claims " + word + " of " + what + ", more than its bytes");
    }
}

// Only the plain text variant: CGAL reads past the line where textures or colors are missing, and asserts on
// homogeneous coordinates.
void check_off(File &file) {
    std::string word, words[3];
    int found = 0;
    while (found < 3 && file.stream >> word) {
        if (word[0] == '#') {
            std::getline(file.stream, word);
        } else {
            words[found++] = word;
        }
    }
    if (words[0] != "OFF") {
        throw Lie("only the plain OFF in text is read: its first word has to be OFF; save it without colors "
                  "and normals");
    }
    check_count(file, "vertices", words[1]);
    check_count(file, "faces", words[2]);
}

bool is_one_of(const std::string &word, std::initializer_list<const char *> names) {
    return std::any_of(names.begin(), names.end(), [&](const char *name) { return word == name; });
}

// Lists say by a small integer how long they are: CGAL makes room for whatever a large one claims.
void check_ply_property(std::istringstream &words, const std::string &element, int &coordinates) {
    std::string type, name, of;
    words >> type >> name;
    if (type != "list") {
        bool real = is_one_of(type, {"float", "float32", "double", "float64"});
        coordinates += real && element == "vertex" && is_one_of(name, {"x", "y", "z"});
        return;
    }
    if (!is_one_of(name, {"uchar", "uint8", "ushort", "uint16"})) {
        throw Lie("its lists are as long as a " + name + " says: save it with uchar");
    }
    words >> of >> name;
    if (element == "face" && is_one_of(name, {"vertex_indices", "vertex_index"}) &&
        !is_one_of(of, {"int", "int32", "uint", "uint32"})) {
        throw Lie("the corners of its faces are of the type " + of + ": save it with int");
    }
}

void check_ply(File &file) {
    std::string line, element;
    int coordinates = 0;
    bool has_faces = false;
    while (std::getline(file.stream, line)) {
        std::istringstream words(line);
        std::string keyword, count;
        words >> keyword;
        if (keyword == "element") {
            words >> element >> count;
            check_count(file, element, count);
            has_faces = has_faces || element == "face";
        } else if (keyword == "property") {
            check_ply_property(words, element, coordinates);
        } else if (keyword == "end_header") {
            break;
        }
    }
    if (coordinates != 3 || !has_faces) {
        throw Lie("its header names no vertices with x, y and z of the type float or double, or no faces");
    }
}

void check_stl(File &file) {
    char head[84] = {0};
    file.stream.read(head, sizeof head);
    if (std::strncmp(head, "solid", 5) == 0 && std::isspace(static_cast<unsigned char>(head[5]))) {
        return;
    }
    std::uint32_t count;
    std::memcpy(&count, head + 80, sizeof count);
    if (file.size < 84 || (file.size - 84) / 50 < count) {
        throw Lie("its header claims " + std::to_string(count) + " triangles, more than its bytes");
    }
}

struct Format {
    const char *extension;
    void (*check)(File &);
    bool (*read)(std::istream &, Points &, Faces &);
};

auto quiet() {
    return CGAL::parameters::verbose(false);
}

const Format formats[] = {
    {".obj", nullptr,
     [](std::istream &in, Points &p, Faces &f) { return CGAL::IO::read_OBJ(in, p, f, quiet()); }},
    {".off", check_off,
     [](std::istream &in, Points &p, Faces &f) { return CGAL::IO::read_OFF(in, p, f, quiet()); }},
    {".ply", check_ply,
     [](std::istream &in, Points &p, Faces &f) { return CGAL::IO::read_PLY(in, p, f, quiet()); }},
    {".stl", check_stl,
     [](std::istream &in, Points &p, Faces &f) { return CGAL::IO::read_STL(in, p, f, quiet()); }},
};

std::string extension_of(const char *path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

const Format *format_of(const std::string &extension) {
    for (const Format &format : formats) {
        if (extension == format.extension) {
            return &format;
        }
    }
    return nullptr;
}

vn_status open(File &file) {
    std::error_code error;
    file.size = std::filesystem::file_size(file.path, error);
    if (error) {
        return vn_fail(VN_IO, "%s: cannot be read: %s", file.path, error.message().c_str());
    }
    file.stream.open(file.path, std::ios::binary);
    if (!file.stream) {
        return vn_fail(VN_IO, "%s: cannot be read: %s", file.path, std::strerror(errno));
    }
    return VN_OK;
}

vn_status store(vn_polygons *out, const File &file, const Points &points, const Faces &faces) {
    VN_TRY(vn_array_reserve(&out->xyz, 3 * static_cast<int64_t>(points.size())));
    VN_TRY(vn_array_reserve(&out->sizes, static_cast<int64_t>(faces.size())));
    for (const Point &p : points) {
        for (int k = 0; k < 3; k++) {
            VN_TRY(vn_array_push(&out->xyz, p[k]));
        }
    }
    for (const Face &face : faces) {
        VN_TRY(vn_array_push(&out->sizes, static_cast<int32_t>(face.size())));
        for (std::size_t corner : face) {
            if (corner >= points.size()) {
                return vn_fail(VN_IO, "%s: face %d has a corner that is no vertex: there are %zu", file.path,
                               out->sizes.count, points.size());
            }
            VN_TRY(vn_array_push(&out->corners, static_cast<int32_t>(corner)));
        }
    }
    return VN_OK;
}

vn_status read(vn_polygons *out, File &file, const Format &format) {
    Points points;
    Faces faces;
    if (format.check != nullptr) {
        format.check(file);
        rewind(file);
    }
    if (!format.read(file.stream, points, faces)) {
        throw Lie("broken or cut off, or no mesh: CGAL's reader gave up after " +
                  std::to_string(points.size()) + " vertices and " + std::to_string(faces.size()) + " faces");
    }
    return store(out, file, points, faces);
}

// What CGAL finds wrong is a matter of the file.
vn_status read_guarded(vn_polygons *out, File &file, const Format &format) {
    try {
        return read(out, file, format);
    } catch (const std::bad_alloc &) {
        throw;
    } catch (const std::exception &error) {
        return vn_fail(VN_IO, "%s: %s", file.path, error.what());
    }
}

} // namespace

extern "C" vn_status vn_mesh_read(vn_polygons *polygons, const char *path) {
    return vn_guard(path, [&] {
        std::string extension = extension_of(path);
        if (extension == ".glb" || extension == ".gltf") {
            return vn_gltf_read(polygons, path);
        }
        const Format *format = format_of(extension);
        if (format == nullptr) {
            return vn_fail(VN_INVALID, "%s: a mesh is read from .obj, .off, .ply, .stl, .glb or .gltf", path);
        }
        File file{path, 0, {}};
        vn_status status = open(file);
        return status == VN_OK ? read_guarded(polygons, file, *format) : status;
    });
}
