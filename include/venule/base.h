/// @file base.h
/// What every part of Venule stands on: statuses and their one-line messages, memory with a budget,
/// the clock that stops a run, and random numbers that depend on nothing but their key.
///
/// Conventions of the whole API. An out parameter comes first and is owned by the caller; a returned
/// pointer is borrowed. A function that can fail returns a vn_status, sets its out parameters to NULL or
/// zero when it fails, and leaves one line in vn_message(). Indices are 0-based int32_t, -1 is none.
/// Angles are degrees, y points up, lengths are in the caller's own unit.
#ifndef VENULE_BASE_H
#define VENULE_BASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define VN_VERSION_MAJOR 0
#define VN_VERSION_MINOR 1
#define VN_VERSION_PATCH 0

#if defined(VN_STATIC)
#define VN_API
#elif defined(__GNUC__)
#define VN_API __attribute__((visibility("default")))
#else
#define VN_API
#endif

#if defined(__GNUC__)
#define VN_PRINTF(at, first) __attribute__((format(printf, at, first)))
#else
#define VN_PRINTF(at, first)
#endif

/// How a call ended. The program's exit status follows from it (vn_exit_status()).
typedef enum vn_status {
    VN_OK = 0,      ///< done
    VN_INVALID,     ///< a value that the caller gave is wrong; exit 1
    VN_INFEASIBLE,  ///< the values are legal, but nothing can satisfy them; exit 3
    VN_IO,          ///< a file could not be read or written; exit 4
    VN_NO_MEMORY,   ///< the memory budget, or the machine's memory, is used up; exit 5
    VN_LIMIT,       ///< a limit of time, nodes or size was reached; exit 5
    VN_INTERRUPTED, ///< somebody asked the run to stop; exit 130
    VN_EXTERNAL,    ///< a library failed in a way that has no better name; exit 1
    VN_CALLBACK,    ///< the caller's own callback failed; its reason travels outside the engine
} vn_status;

/// The version as "major.minor.patch".
VN_API const char *vn_version(void);

/// Set the calling thread's message and return @p status, so that `return vn_fail(...)` reads as one step.
/// Every failure passes here: it is the one place for a breakpoint.
VN_API vn_status vn_fail(vn_status status, const char *format, ...) VN_PRINTF(2, 3);

/// The message of the last failure in the calling thread: one line without a full stop or a newline; "" at
/// first. Borrowed; valid until the thread's next failure.
VN_API const char *vn_message(void);

/// The exit status of a program that ends with @p status: 0, 1, 3, 4, 5 or 130.
VN_API int vn_exit_status(vn_status status);

/// Allocate, resize or free, as Lua's allocator does. @p block is NULL with @p old_size 0, or came from here
/// with exactly that size. A @p new_size of 0 frees and returns NULL. Growing returns NULL, with @p block
/// intact, when the budget or the machine refuses; shrinking never fails.
VN_API void *vn_resize(void *block, size_t old_size, size_t new_size);

/// Bytes held by vn_resize() at this moment. 0 when every object was destroyed.
VN_API size_t vn_byte_count(void);

/// The largest vn_byte_count() since the process began or since vn_byte_peak_reset().
VN_API size_t vn_byte_peak(void);
VN_API void vn_byte_peak_reset(void);

/// Refuse allocations that would bring vn_byte_count() above @p bytes; 0 lifts the budget.
VN_API void vn_set_memory_budget(size_t bytes);

/// From the @p nth allocation on (counted from now, 0 is the next), refuse them all; a negative value stops
/// that. For tests.
VN_API void vn_fail_allocations_from(int64_t nth);

/// Let vn_poll() fail with VN_LIMIT once @p seconds of wall time have passed; 0 lifts the limit.
VN_API void vn_set_time_budget(double seconds);

/// Ask the running call to end at its next step. May be called from a signal handler.
VN_API void vn_interrupt(void);

/// VN_OK, or VN_INTERRUPTED after vn_interrupt() (which this call then forgets), or VN_LIMIT past the time
/// budget. Long loops of the engine ask once in a while; a host may ask too.
VN_API vn_status vn_poll(void);

/// Threads that parallel loops may use: 1 or more, 0 for as many as the machine has. Results never depend
/// on it.
VN_API void vn_set_threads(int threads);

/// A stream of random numbers that is a pure function of (seed, stream, counter): number k of a stream can be
/// had without the k-1 before it, so that results do not depend on threads. Copy it to fork it.
typedef struct vn_rng {
    uint64_t seed;
    uint64_t stream;
    uint64_t counter;
} vn_rng;

/// The rng of a seed, at its beginning.
VN_API vn_rng vn_rng_make(uint64_t seed);

/// A well-mixed 64-bit hash of four keys; what all randomness here is made of.
VN_API uint64_t vn_hash(uint64_t seed, uint64_t a, uint64_t b, uint64_t c);

/// A number in [0, 1) with 53 random bits: number @p counter of stream @p stream of @p seed.
VN_API double vn_random_at(uint64_t seed, uint64_t stream, uint64_t counter);

/// The next number in [low, high).
VN_API double vn_rng_uniform(vn_rng *rng, double low, double high);

/// The next normally distributed number; @p deviation is not negative.
VN_API double vn_rng_normal(vn_rng *rng, double mean, double deviation);

/// The next integer in [low, high], both included, without bias; @p low <= @p high.
VN_API int64_t vn_rng_integer(vn_rng *rng, int64_t low, int64_t high);

/// Set @p rng's next numbers apart: returns a fresh stream and moves @p rng on by one. A primitive that
/// needs many numbers takes a fork, so that the caller's own sequence does not depend on how many.
VN_API vn_rng vn_rng_fork(vn_rng *rng);

#ifdef __cplusplus
}
#endif

#endif
