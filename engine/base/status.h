/// Passing statuses up, for the engine's own files.
#ifndef VN_BASE_STATUS_H
#define VN_BASE_STATUS_H

#include "venule/base.h"

/// Return from the calling function when @p call fails.
#define VN_TRY(call)                                                                                         \
    do {                                                                                                     \
        vn_status vn_try_status = (call);                                                                    \
        if (vn_try_status != VN_OK) {                                                                        \
            return vn_try_status;                                                                            \
        }                                                                                                    \
    } while (0)

/// The failure of an allocation of @p bytes for @p what.
vn_status vn_fail_memory(const char *what, size_t bytes);

#ifdef __clang_analyzer__
// The analyzer sees one file at a time: what returns the status of a failure never returns VN_OK.
#define vn_fail(status, ...) (vn_fail((status), __VA_ARGS__), (status))
#define vn_fail_memory(what, bytes) (vn_fail_memory((what), (bytes)), VN_NO_MEMORY)
#endif

#endif
