/// Stable sorting of integer keys.
#ifndef VN_BASE_SORT_H
#define VN_BASE_SORT_H

#include "base/array.h"

/// A key and what it stands for.
typedef struct vn_keyed {
    uint64_t key;
    int32_t value;
} vn_keyed;

typedef VN_ARRAY(vn_keyed) vn_keyed_array;

/// Sort by key, equal keys in their present order. @p scratch is working memory that the caller keeps.
vn_status vn_sort_keyed(vn_keyed_array *array, vn_keyed_array *scratch);

#endif
