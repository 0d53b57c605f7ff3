#include "base/hash.h"

#include <math.h>

uint64_t vn_hash(uint64_t seed, uint64_t a, uint64_t b, uint64_t c) {
    return vn_hash_here(seed, a, b, c);
}

double vn_random_at(uint64_t seed, uint64_t stream, uint64_t counter) {
    return vn_unit_interval(vn_hash(seed, stream, counter, 0));
}

vn_rng vn_rng_make(uint64_t seed) {
    return (vn_rng){.seed = seed};
}

static uint64_t next_bits(vn_rng *rng) {
    return vn_hash_here(rng->seed, rng->stream, rng->counter++, 0);
}

double vn_rng_uniform(vn_rng *rng, double low, double high) {
    return vn_uniform_here(rng, vn_hash_begin(rng->seed, rng->stream), low, high);
}

double vn_rng_normal(vn_rng *rng, double mean, double deviation) {
    double u = 1.0 - vn_unit_interval(next_bits(rng)); // in (0, 1], so that the logarithm is finite
    double angle = 6.283185307179586 * vn_unit_interval(next_bits(rng));
    return mean + deviation * sqrt(-2.0 * log(u)) * cos(angle);
}

int64_t vn_rng_integer(vn_rng *rng, int64_t low, int64_t high) {
    uint64_t span = (uint64_t)high - (uint64_t)low + 1;
    if (span == 0) {
        return (int64_t)next_bits(rng); // all 2^64 values
    }
    uint64_t unbiased = UINT64_MAX - UINT64_MAX % span;
    uint64_t bits = next_bits(rng);
    while (bits >= unbiased) {
        bits = next_bits(rng);
    }
    return (int64_t)((uint64_t)low + bits % span);
}

vn_rng vn_rng_fork(vn_rng *rng) {
    return (vn_rng){.seed = rng->seed, .stream = vn_hash(rng->seed, rng->stream, rng->counter++, 1)};
}
