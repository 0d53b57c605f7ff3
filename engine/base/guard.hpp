/// The door between C and the C++ libraries behind our shims: nothing that is thrown passes it.
#ifndef VN_BASE_GUARD_HPP
#define VN_BASE_GUARD_HPP

extern "C" {
#include "venule/base.h"
}

#include <exception>
#include <new>

/// Run @p body, which returns a vn_status; what it throws becomes a status and a message that begins with
/// @p what.
template <typename Body>
vn_status vn_guard(const char *what, Body &&body) noexcept {
    try {
        return body();
    } catch (const std::bad_alloc &) {
        return vn_fail(VN_NO_MEMORY, "out of memory: %s (raise --memory, or grow less)", what);
    } catch (const std::exception &error) {
        return vn_fail(VN_EXTERNAL, "%s: %s", what, error.what());
    } catch (...) {
        return vn_fail(VN_EXTERNAL, "%s: an unknown failure", what);
    }
}

#endif
