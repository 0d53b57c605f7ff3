#include "base/sort.h"

enum { DIGIT_BITS = 8, BUCKETS = 1 << DIGIT_BITS, DIGITS = (64 + DIGIT_BITS - 1) / DIGIT_BITS };

static uint32_t digit_of(uint64_t key, int digit) {
    return (uint32_t)(key >> (digit * DIGIT_BITS)) & (BUCKETS - 1);
}

static void insertion_sort(vn_keyed *items, int32_t count) {
    for (int32_t i = 1; i < count; i++) {
        vn_keyed item = items[i];
        int32_t j = i;
        for (; j > 0 && items[j - 1].key > item.key; j--) {
            items[j] = items[j - 1];
        }
        items[j] = item;
    }
}

static void scatter(const vn_keyed *from, vn_keyed *to, int32_t count, int digit, int32_t *starts) {
    int32_t sum = 0;
    for (int b = 0; b < BUCKETS; b++) {
        int32_t size = starts[b];
        starts[b] = sum;
        sum += size;
    }
    for (int32_t i = 0; i < count; i++) {
        to[starts[digit_of(from[i].key, digit)]++] = from[i];
    }
}

static void count_digit(const vn_keyed *items, int32_t count, int digit, int32_t *sizes) {
    memset(sizes, 0, BUCKETS * sizeof *sizes);
    for (int32_t i = 0; i < count; i++) {
        sizes[digit_of(items[i].key, digit)]++;
    }
}

static uint64_t bits_that_differ(const vn_keyed *items, int32_t count) {
    uint64_t bits = 0;
    for (int32_t i = 1; i < count; i++) {
        bits |= items[i].key ^ items[0].key;
    }
    return bits;
}

vn_status vn_sort_keyed(vn_keyed_array *array, vn_keyed_array *scratch) {
    if (array->count < 64) {
        insertion_sort(array->data, array->count);
        return VN_OK;
    }
    VN_TRY(vn_array_reserve(scratch, array->count));
    vn_keyed *from = array->data;
    vn_keyed *to = scratch->data;
    uint64_t differ = bits_that_differ(from, array->count);
    for (int digit = 0; digit < DIGITS; digit++) {
        if (digit_of(differ, digit) == 0) {
            continue; // all keys share this digit
        }
        int32_t starts[BUCKETS];
        count_digit(from, array->count, digit, starts);
        scatter(from, to, array->count, digit, starts);
        vn_keyed *swap = from;
        from = to;
        to = swap;
    }
    if (from != array->data) {
        memcpy(array->data, from, (size_t)array->count * sizeof *from);
    }
    return VN_OK;
}
