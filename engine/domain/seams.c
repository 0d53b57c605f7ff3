#include "domain/seams.h"

#include "base/sort.h"
#include "space/points.h"

static uint64_t sortable(double value) {
    uint64_t bits;
    value += 0.0; // -0 is 0
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static vn_status find_twins(const double *xyz, int32_t count, vn_keyed_array *order, vn_keyed_array *scratch,
                            vn_corners *first) {
    VN_TRY(vn_array_reserve(order, count));
    VN_TRY(vn_array_zero(first, count));
    order->count = count;
    for (int32_t i = 0; i < count; i++) {
        order->data[i].value = i;
    }
    for (int k = 0; k < 3; k++) {
        for (int32_t i = 0; i < count; i++) {
            order->data[i].key = sortable(xyz[3 * (int64_t)order->data[i].value + k]);
        }
        VN_TRY(vn_sort_keyed(order, scratch));
    }
    for (int32_t i = 0; i < count; i++) {
        int32_t v = order->data[i].value, before = i > 0 ? order->data[i - 1].value : v;
        bool twin = i > 0 && vn_distance2(xyz + 3 * (int64_t)v, xyz + 3 * (int64_t)before) == 0;
        first->data[v] = twin ? first->data[before] : v;
    }
    return VN_OK;
}

static uint64_t edge_key(const vn_corners *corners, const vn_corners *first, int32_t h) {
    // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): every vertex has a first one
    uint64_t a = (uint64_t)first->data[corners->data[h]];
    uint64_t b = (uint64_t)first->data[corners->data[h - h % 3 + (h + 1) % 3]];
    return a < b ? a << 32 | b : b << 32 | a;
}

static vn_status sort_edges(const vn_corners *corners, const vn_corners *first, vn_keyed_array *order,
                            vn_keyed_array *scratch) {
    VN_TRY(vn_array_reserve(order, corners->count));
    order->count = corners->count;
    for (int32_t h = 0; h < order->count; h++) {
        order->data[h] = (vn_keyed){edge_key(corners, first, h), h};
    }
    return vn_sort_keyed(order, scratch);
}

static vn_status close_circles(const vn_keyed_array *order, vn_corners *mate) {
    VN_TRY(vn_array_zero(mate, order->count));
    for (int32_t begin = 0, end; begin < order->count; begin = end) {
        for (end = begin + 1; end < order->count && order->data[end].key == order->data[begin].key; end++) {
            mate->data[order->data[end - 1].value] = order->data[end].value;
        }
        mate->data[order->data[end - 1].value] = order->data[begin].value;
    }
    return VN_OK;
}

vn_status vn_seams_link(const double *xyz, int32_t vertices, const vn_corners *corners, vn_corners *first,
                        vn_corners *mate) {
    vn_keyed_array order = {0}, scratch = {0};
    vn_status status = find_twins(xyz, vertices, &order, &scratch, first);
    status = status == VN_OK ? sort_edges(corners, first, &order, &scratch) : status;
    status = status == VN_OK ? close_circles(&order, mate) : status;
    vn_array_free(&order);
    vn_array_free(&scratch);
    return status;
}
