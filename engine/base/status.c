#include "base/status.h"

#include <stdarg.h>
#include <stdio.h>

#define VN_STRING_(x) #x
#define VN_STRING(x) VN_STRING_(x)

// One message a thread, in the manner of errno: a call that fails is followed by the question why in the same
// thread. Passing a context through every call for this alone was tried on paper and doubled the signatures.
static _Thread_local char vn_message_text[512];

const char *vn_version(void) {
    return VN_STRING(VN_VERSION_MAJOR) "." VN_STRING(VN_VERSION_MINOR) "." VN_STRING(VN_VERSION_PATCH);
}

vn_status(vn_fail)(vn_status status, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(vn_message_text, sizeof vn_message_text, format, arguments);
    va_end(arguments);
    return status;
}

const char *vn_message(void) {
    return vn_message_text;
}

int vn_exit_status(vn_status status) {
    switch (status) {
    case VN_OK:
        return 0;
    case VN_INFEASIBLE:
        return 3;
    case VN_IO:
        return 4;
    case VN_NO_MEMORY:
    case VN_LIMIT:
        return 5;
    case VN_INTERRUPTED:
        return 130;
    default:
        return 1;
    }
}

vn_status(vn_fail_memory)(const char *what, size_t bytes) {
    return vn_fail(VN_NO_MEMORY, "out of memory: %s needs %.3g %s more (raise --memory, or grow less)", what,
                   bytes < 1000000 ? (double)bytes / 1e3 : (double)bytes / 1e6,
                   bytes < 1000000 ? "kB" : "MB");
}
