/// The hash that all randomness is made of, for loops where it must not be a call.
#ifndef VN_BASE_HASH_H
#define VN_BASE_HASH_H

#include "venule/base.h"

// The finaliser of MurmurHash3 with Stafford's thirteenth constants: every input bit reaches every output
// bit.
static inline uint64_t vn_mix(uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
}

/// What vn_hash() makes of its first two numbers.
static inline uint64_t vn_hash_begin(uint64_t seed, uint64_t a) {
    uint64_t h = vn_mix(seed + 0x9E3779B97F4A7C15u);
    return vn_mix(h ^ (a + 0x9E3779B97F4A7C15u));
}

/// And then of the others.
static inline uint64_t vn_hash_end(uint64_t begun, uint64_t b, uint64_t c) {
    uint64_t h = vn_mix(begun ^ (b + 0xC2B2AE3D27D4EB4Fu));
    return vn_mix(h ^ (c + 0x165667B19E3779F9u));
}

/// vn_hash().
static inline uint64_t vn_hash_here(uint64_t seed, uint64_t a, uint64_t b, uint64_t c) {
    return vn_hash_end(vn_hash_begin(seed, a), b, c);
}

static inline double vn_unit_interval(uint64_t bits) {
    return (double)(bits >> 11) * 0x1p-53;
}

/// The next of vn_rng_uniform()'s numbers in [low, high], where many come from one stream: @p begun is
/// vn_hash_begin(rng->seed, rng->stream).
static inline double vn_uniform_here(vn_rng *rng, uint64_t begun, double low, double high) {
    double t = vn_unit_interval(vn_hash_end(begun, rng->counter++, 0));
    return low + t * (high - low);
}

#endif
