#include "venule/base.h"

#include <math.h>

// The finaliser of MurmurHash3 with Stafford's thirteenth constants: every input bit reaches every output
// bit.
static uint64_t mix(uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
}

uint64_t vn_hash(uint64_t seed, uint64_t a, uint64_t b, uint64_t c) {
    uint64_t h = mix(seed + 0x9E3779B97F4A7C15u);
    h = mix(h ^ (a + 0x9E3779B97F4A7C15u));
    h = mix(h ^ (b + 0xC2B2AE3D27D4EB4Fu));
    return mix(h ^ (c + 0x165667B19E3779F9u));
}

static double unit_interval(uint64_t bits) {
    return (double)(bits >> 11) * 0x1p-53;
}

double vn_random_at(uint64_t seed, uint64_t stream, uint64_t counter) {
    return unit_interval(vn_hash(seed, stream, counter, 0));
}

vn_rng vn_rng_make(uint64_t seed) {
    return (vn_rng){.seed = seed};
}

static uint64_t next_bits(vn_rng *rng) {
    return vn_hash(rng->seed, rng->stream, rng->counter++, 0);
}

double vn_rng_uniform(vn_rng *rng, double low, double high) {
    double t = unit_interval(next_bits(rng));
    return low + t * (high - low);
}

double vn_rng_normal(vn_rng *rng, double mean, double deviation) {
    double u = 1.0 - unit_interval(next_bits(rng)); // in (0, 1], so that the logarithm is finite
    double angle = 6.283185307179586 * unit_interval(next_bits(rng));
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
