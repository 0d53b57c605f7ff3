// Shim over tinygltf: the triangles of a glTF 2.0 file's scene, by its nodes' transforms. The library checks
// the JSON; that what it says of its buffers is true is checked here, before anything is read from them.
#include "base/guard.hpp"

extern "C" {
#include "file/mesh.h"
}

#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace {

namespace fs = std::filesystem;

/// What is wrong with a file.
struct Lie : std::runtime_error {
    using std::runtime_error::runtime_error;
};

using Matrix = std::array<double, 16>; // by columns, as glTF has it

const Matrix identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

Matrix operator*(const Matrix &a, const Matrix &b) {
    Matrix c{};
    for (std::size_t i = 0; i < 16; i++) {
        for (std::size_t k = 0; k < 4; k++) {
            c[i] += a[i % 4 + 4 * k] * b[k + i / 4 * 4];
        }
    }
    return c;
}

double entry(const std::vector<double> &numbers, std::size_t i, double otherwise) {
    return i < numbers.size() ? numbers[i] : otherwise;
}

// Translation, rotation (a quaternion) and scale, or all in one.
Matrix transform_of(const tinygltf::Node &node) {
    if (node.matrix.size() == 16) {
        Matrix m;
        std::copy(node.matrix.begin(), node.matrix.end(), m.begin());
        return m;
    }
    double x = entry(node.rotation, 0, 0), y = entry(node.rotation, 1, 0);
    double z = entry(node.rotation, 2, 0), w = entry(node.rotation, 3, 1);
    double s[3] = {entry(node.scale, 0, 1), entry(node.scale, 1, 1), entry(node.scale, 2, 1)};
    return {(1 - 2 * (y * y + z * z)) * s[0], 2 * (x * y + z * w) * s[0],
            2 * (x * z - y * w) * s[0],       0,
            2 * (x * y - z * w) * s[1],       (1 - 2 * (x * x + z * z)) * s[1],
            2 * (y * z + x * w) * s[1],       0,
            2 * (x * z + y * w) * s[2],       2 * (y * z - x * w) * s[2],
            (1 - 2 * (x * x + y * y)) * s[2], 0,
            entry(node.translation, 0, 0),    entry(node.translation, 1, 0),
            entry(node.translation, 2, 0),    1};
}

template <typename T>
const T &at(const std::vector<T> &list, int index, const char *what) {
    if (index < 0 || static_cast<std::size_t>(index) >= list.size()) {
        throw Lie(std::string("it names ") + what + " " + std::to_string(index) + ", and has " +
                  std::to_string(list.size()));
    }
    return list[static_cast<std::size_t>(index)];
}

/// The bytes of an accessor, known to be there.
struct Items {
    const unsigned char *first;
    std::size_t stride, count;
};

Items items_of(const tinygltf::Model &model, int index, std::size_t size) {
    const tinygltf::Accessor &accessor = at(model.accessors, index, "accessor");
    if (accessor.sparse.isSparse || accessor.bufferView < 0) {
        throw Lie("its accessors are sparse: save it without");
    }
    const tinygltf::BufferView &view = at(model.bufferViews, accessor.bufferView, "buffer view");
    const std::vector<unsigned char> &data = at(model.buffers, view.buffer, "buffer").data;
    std::size_t stride = view.byteStride > 0 ? view.byteStride : size;
    std::size_t room = view.byteOffset <= data.size() ? data.size() - view.byteOffset : 0;
    room = accessor.byteOffset <= room ? room - accessor.byteOffset : 0;
    if (accessor.count > 0 && (room < size || (room - size) / stride < accessor.count - 1)) {
        throw Lie("an accessor claims " + std::to_string(accessor.count) +
                  " items, more than its buffer's bytes");
    }
    return {data.data() + view.byteOffset + accessor.byteOffset, stride, accessor.count};
}

vn_status add_points(vn_polygons *out, const tinygltf::Model &model, int index, const Matrix &m) {
    const tinygltf::Accessor &accessor = at(model.accessors, index, "accessor");
    if (accessor.type != TINYGLTF_TYPE_VEC3 || accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT) {
        throw Lie("its positions are not three floats each: save it without quantization");
    }
    Items items = items_of(model, index, 12);
    for (std::size_t i = 0; i < items.count; i++) {
        float p[3];
        std::memcpy(p, items.first + i * items.stride, sizeof p);
        for (std::size_t k = 0; k < 3; k++) {
            VN_TRY(vn_array_push(&out->xyz, m[k] * p[0] + m[k + 4] * p[1] + m[k + 8] * p[2] + m[k + 12]));
        }
    }
    return VN_OK;
}

std::vector<std::uint32_t> corners_of(const tinygltf::Model &model, int index, std::size_t vertices) {
    std::vector<std::uint32_t> corners;
    if (index < 0) {
        for (std::size_t i = 0; i < vertices; i++) {
            corners.push_back(static_cast<std::uint32_t>(i));
        }
        return corners;
    }
    int type = at(model.accessors, index, "accessor").componentType;
    std::size_t size = type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE    ? 1
                       : type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? 2
                       : type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT   ? 4
                                                                        : 0;
    if (size == 0) {
        throw Lie("the corners of its triangles are no whole numbers");
    }
    Items items = items_of(model, index, size);
    for (std::size_t i = 0; i < items.count; i++) {
        std::uint32_t corner = 0; // both are little-endian
        std::memcpy(&corner, items.first + i * items.stride, size);
        if (corner >= vertices) {
            throw Lie("a triangle has corner " + std::to_string(corner) + " of " + std::to_string(vertices));
        }
        corners.push_back(corner);
    }
    return corners;
}

vn_status add_triangle(vn_polygons *out, int32_t base, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    VN_TRY(vn_array_push(&out->sizes, 3));
    for (std::uint32_t corner : {a, b, c}) {
        VN_TRY(vn_array_push(&out->corners, base + static_cast<int32_t>(corner)));
    }
    return VN_OK;
}

// Lists, strips and fans of triangles; points and lines have no area.
vn_status add_primitive(vn_polygons *out, const tinygltf::Model &model, const tinygltf::Primitive &primitive,
                        const Matrix &m) {
    int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
    auto position = primitive.attributes.find("POSITION");
    if (mode < TINYGLTF_MODE_TRIANGLES || position == primitive.attributes.end()) {
        return VN_OK;
    }
    int32_t base = out->xyz.count / 3;
    VN_TRY(add_points(out, model, position->second, m));
    std::vector<std::uint32_t> c =
        corners_of(model, primitive.indices, static_cast<std::size_t>(out->xyz.count / 3 - base));
    std::size_t step = mode == TINYGLTF_MODE_TRIANGLES ? 3 : 1;
    for (std::size_t i = 0; i + 2 < c.size(); i += step) {
        bool fan = mode == TINYGLTF_MODE_TRIANGLE_FAN, odd = step == 1 && !fan && i % 2 == 1;
        VN_TRY(add_triangle(out, base, fan ? c[0] : c[i], c[i + (odd ? 2 : 1)], c[i + (odd ? 1 : 2)]));
    }
    return VN_OK;
}

// A tree: a node that is met twice would be one of a circle.
vn_status add_node(vn_polygons *out, const tinygltf::Model &model, int index, const Matrix &above,
                   std::vector<bool> &met, int depth) {
    const tinygltf::Node &node = at(model.nodes, index, "node");
    if (met[static_cast<std::size_t>(index)] || depth > 1000) {
        throw Lie("its nodes are no tree: node " + std::to_string(index) +
                  " hangs from two, or a thousand deep");
    }
    met[static_cast<std::size_t>(index)] = true;
    Matrix m = above * transform_of(node);
    if (node.mesh >= 0) {
        for (const tinygltf::Primitive &primitive : at(model.meshes, node.mesh, "mesh").primitives) {
            VN_TRY(add_primitive(out, model, primitive, m));
        }
    }
    for (int child : node.children) {
        VN_TRY(add_node(out, model, child, m, met, depth + 1));
    }
    return VN_OK;
}

// Buffers are read from files beside this one, and nowhere else: it may come from a stranger.
bool read_beside(std::vector<unsigned char> *bytes, std::string *why, const std::string &path, void *folder) {
    fs::path place = fs::path(path).lexically_normal();
    if (place.parent_path() != static_cast<fs::path *>(folder)->lexically_normal()) {
        *why = path + " is not beside the file";
        return false;
    }
    std::ifstream in(place, std::ios::binary);
    bytes->assign(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    if (!in && bytes->empty()) {
        *why = path + " cannot be read";
    }
    return !bytes->empty();
}

tinygltf::FsCallbacks beside(fs::path &folder) {
    return {[](const std::string &path, void *) { return fs::is_regular_file(path); },
            [](const std::string &path, void *) { return path; }, read_beside, nullptr, &folder};
}

void load(tinygltf::Model &model, const char *path) {
    fs::path folder = fs::path(path).parent_path().empty() ? fs::path(".") : fs::path(path).parent_path();
    std::ifstream in(path, std::ios::binary);
    std::vector<unsigned char> bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    if (!in.good() && bytes.empty()) {
        throw Lie("cannot be read, or is empty");
    }
    tinygltf::TinyGLTF reader;
    std::string why, warning;
    reader.SetFsCallbacks(beside(folder));
    reader.SetImageLoader([](tinygltf::Image *, int, std::string *, std::string *, int, int,
                             const unsigned char *, int, void *) { return true; },
                          nullptr);
    auto size = static_cast<unsigned int>(bytes.size());
    bool binary = bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
    bool read =
        binary ? reader.LoadBinaryFromMemory(&model, &why, &warning, bytes.data(), size, folder.string())
               : reader.LoadASCIIFromString(&model, &why, &warning, reinterpret_cast<char *>(bytes.data()),
                                            size, folder.string());
    if (!read) {
        std::replace(why.begin(), why.end(), '\n', ' ');
        throw Lie("no glTF, or a broken one: " + why);
    }
    if (!model.extensionsRequired.empty()) {
        throw Lie("it needs " + model.extensionsRequired[0] + ", which is not read: save it without");
    }
}

vn_status read(vn_polygons *out, const char *path) {
    tinygltf::Model model;
    load(model, path);
    std::vector<bool> met(model.nodes.size());
    std::vector<int> roots;
    if (!model.scenes.empty()) {
        roots = at(model.scenes, model.defaultScene < 0 ? 0 : model.defaultScene, "scene").nodes;
    }
    for (int root : roots) {
        VN_TRY(add_node(out, model, root, identity, met, 0));
    }
    if (out->sizes.count == 0) {
        throw Lie("its scene has no triangles");
    }
    return VN_OK;
}

} // namespace

extern "C" vn_status vn_gltf_read(vn_polygons *polygons, const char *path) {
    return vn_guard(path, [&]() -> vn_status {
        try {
            return read(polygons, path);
        } catch (const std::bad_alloc &) {
            throw;
        } catch (const std::exception &error) {
            return vn_fail(VN_IO, "%s: %s", path, error.what());
        }
    });
}
