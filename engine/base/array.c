#include "base/array.h"

// Half as much again: a third of the room idle at worst, while doubling would leave half of a network idle.
static const int LOOSE = 2, TIGHT = 16;

static int64_t next_capacity(int64_t capacity, int64_t need, int part) {
    int64_t grown = capacity + capacity / part + 8;
    int64_t wanted = grown > need ? grown : need;
    return wanted > INT32_MAX ? INT32_MAX : wanted;
}

static vn_status grow(void *data_slot, int32_t *capacity, int64_t need, size_t element_size, int part) {
    if (need > INT32_MAX || need < 0) {
        return vn_fail(VN_LIMIT, "an array of %lld elements is above the limit of %d", (long long)need,
                       INT32_MAX);
    }
    int64_t wanted = next_capacity(*capacity, need, part);
    void *data;
    memcpy(&data, data_slot, sizeof data); // the slot is a T**, which must not be read as a void**
    void *grown = vn_resize(data, (size_t)*capacity * element_size, (size_t)wanted * element_size);
    if (grown == NULL && wanted > need) {
        wanted = need;
        grown = vn_resize(data, (size_t)*capacity * element_size, (size_t)wanted * element_size);
    }
    if (grown == NULL) {
        return vn_fail_memory("an array", ((size_t)wanted - (size_t)*capacity) * element_size);
    }
    memcpy(data_slot, &grown, sizeof grown);
    *capacity = (int32_t)wanted;
    return VN_OK;
}

vn_status vn_array_grow(void *data_slot, int32_t *capacity, int64_t need, size_t element_size) {
    return grow(data_slot, capacity, need, element_size, LOOSE);
}

vn_status vn_array_grow_tightly(void *data_slot, int32_t *capacity, int64_t need, size_t element_size) {
    return grow(data_slot, capacity, need, element_size, TIGHT);
}

void vn_array_shrink(void *data_slot, int32_t *capacity, int32_t count, size_t element_size) {
    void *data;
    memcpy(&data, data_slot, sizeof data);
    data = vn_resize(data, (size_t)*capacity * element_size, (size_t)count * element_size);
    memcpy(data_slot, &data, sizeof data);
    *capacity = count;
}
