/// Growable arrays of anything: `VN_ARRAY(double) lengths = {0};`. The elements are `lengths.data[0 ..
/// count)`.
#ifndef VN_BASE_ARRAY_H
#define VN_BASE_ARRAY_H

#include "base/memory.h"

/// A zeroed one is empty and owns nothing.
#define VN_ARRAY(T)                                                                                          \
    struct {                                                                                                 \
        T *data;                                                                                             \
        int32_t count;                                                                                       \
        int32_t capacity;                                                                                    \
    }

/// Make room for @p need elements in all. VN_NO_MEMORY leaves the array as it was; VN_LIMIT past 2^31 - 1.
#define vn_array_reserve(array, need)                                                                        \
    ((int64_t)(need) <= (array)->capacity                                                                    \
         ? VN_OK                                                                                             \
         : vn_array_grow(&(array)->data, &(array)->capacity, (need), sizeof *(array)->data))

/// The same with little room to spare, for what is the largest part of a thing: the array is moved more
/// often.
#define vn_array_reserve_tightly(array, need)                                                                \
    ((int64_t)(need) <= (array)->capacity                                                                    \
         ? VN_OK                                                                                             \
         : vn_array_grow_tightly(&(array)->data, &(array)->capacity, (need), sizeof *(array)->data))

/// Append one element; a status.
#define vn_array_push(array, value)                                                                          \
    (vn_array_reserve((array), (int64_t)(array)->count + 1) == VN_OK                                         \
         ? ((void)((array)->data[(array)->count++] = (value)), VN_OK)                                        \
         : VN_NO_MEMORY)

/// Give the memory back and be empty again.
#define vn_array_free(array)                                                                                 \
    ((void)vn_resize((array)->data, (size_t)(array)->capacity * sizeof *(array)->data, 0),                   \
     (array)->data = NULL, (array)->count = 0, (array)->capacity = 0)

/// Give back the room that is not in use.
#define vn_array_trim(array)                                                                                 \
    vn_array_shrink(&(array)->data, &(array)->capacity, (array)->count, sizeof *(array)->data)

/// Set every element's room to @p need elements with value zero: count becomes @p need.
#define vn_array_zero(array, need)                                                                           \
    (vn_array_reserve((array), (need)) == VN_OK                                                              \
         ? ((array)->count = (int32_t)(need),                                                                \
            (void)((need) > 0 ? memset((array)->data, 0, (size_t)(need) * sizeof *(array)->data) : NULL),    \
            VN_OK)                                                                                           \
         : VN_NO_MEMORY)

/// What vn_array_reserve() calls: @p data_slot is the address of the array's data pointer.
vn_status vn_array_grow(void *data_slot, int32_t *capacity, int64_t need, size_t element_size);

/// What vn_array_reserve_tightly() calls.
vn_status vn_array_grow_tightly(void *data_slot, int32_t *capacity, int64_t need, size_t element_size);

/// What vn_array_trim() calls.
void vn_array_shrink(void *data_slot, int32_t *capacity, int32_t count, size_t element_size);

#endif
