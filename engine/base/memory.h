/// Small helpers over vn_resize().
#ifndef VN_BASE_MEMORY_H
#define VN_BASE_MEMORY_H

#include "base/status.h"

#include <string.h>

/// @p size zeroed bytes, or NULL. Freed by vn_resize(block, size, 0).
void *vn_new_block(size_t size);

/// A zeroed T, or NULL; freed by VN_DELETE().
#define VN_NEW(T) ((T *)vn_new_block(sizeof(T)))
#define VN_DELETE(object) ((void)vn_resize((object), (object) != NULL ? sizeof *(object) : 0, 0))

/// A block that knows its own size, for libraries that free without saying it; or NULL. Freed by
/// vn_free_sized(), which accepts NULL.
void *vn_sized_block(size_t size);
void vn_free_sized(void *block);

/// A copy of @p text, or NULL; freed by vn_free_text(), which accepts NULL.
char *vn_copy_text(const char *text);
void vn_free_text(char *text);

/// A number that no object of this process had before: identity that outlives a pointer.
uint64_t vn_next_serial(void);

#endif
