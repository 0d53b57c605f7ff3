#include "file/vtp.h"

#include <zlib.h>

vn_status vn_vtp_type(vn_vtp_array *array, vn_slice type) {
    static const struct {
        const char *name;
        char kind;
        size_t bytes;
    } types[] = {{"Float32", 'f', 4}, {"Float64", 'f', 8}, {"Int8", 'i', 1},   {"Int16", 'i', 2},
                 {"Int32", 'i', 4},   {"Int64", 'i', 8},   {"UInt8", 'u', 1},  {"UInt16", 'u', 2},
                 {"UInt32", 'u', 4},  {"UInt64", 'u', 8},  {"String", 's', 1}, {"vtkIdType", 'i', 8}};
    for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
        if (vn_slice_is(type, types[i].name)) {
            array->kind = types[i].kind;
            array->bytes = types[i].bytes;
            return VN_OK;
        }
    }
    return vn_fail(VN_INVALID, "an array has the type \"%.*s\", which is not known", VN_SLICE(type));
}

void vn_vtp_free(vn_vtp_array *array) {
    vn_array_free(&array->values);
    vn_array_free(&array->raw);
}

vn_status vn_vtp_end_text(vn_vtp_array *array) {
    double value;
    vn_slice word = {array->word, array->word_length};
    if (word.length == 0) {
        return VN_OK;
    }
    array->word_length = 0;
    if (!vn_slice_number(word, &value)) {
        return vn_fail(VN_INVALID, "\"%.*s\" in an array must be a number", VN_SLICE(word));
    }
    return vn_array_push(&array->values, value);
}

vn_status vn_vtp_take_text(vn_vtp_array *array, const char *bytes, size_t count) {
    for (size_t i = 0; i < count; i++) {
        if (vn_is_blank(bytes[i])) {
            VN_TRY(vn_vtp_end_text(array));
        } else if (array->word_length == sizeof array->word) {
            return vn_fail(VN_INVALID, "\"%.20s…\" in an array must be a number", array->word);
        } else {
            array->word[array->word_length++] = bytes[i];
        }
    }
    return VN_OK;
}

static int value_of(char letter) {
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *found = letter != '\0' ? strchr(letters, letter) : NULL;
    return found != NULL ? (int)(found - letters) : -1;
}

static vn_status end_group(vn_vtp_array *array) {
    for (int shift = 16; shift > 16 - 8 * (array->letters - 1); shift -= 8) {
        VN_TRY(vn_array_push(&array->raw, (uint8_t)(array->group >> shift)));
    }
    array->group = 0;
    array->letters = 0;
    return VN_OK;
}

// Sizes and data are coded one after the other, so that padding ends a group, not all.
vn_status vn_vtp_take_base64(vn_vtp_array *array, const char *bytes, size_t count) {
    for (size_t i = 0; i < count; i++) {
        int value = value_of(bytes[i]);
        if (bytes[i] == '=') {
            VN_TRY(array->letters > 1 ? end_group(array) : VN_OK);
        } else if (value >= 0) {
            array->group |= (uint32_t)value << (18 - 6 * array->letters++);
            VN_TRY(array->letters == 4 ? end_group(array) : VN_OK);
        } else if (!vn_is_blank(bytes[i])) {
            return vn_fail(VN_INVALID, "an array holds the byte %d, which is not base64",
                           (unsigned char)bytes[i]);
        }
    }
    return VN_OK;
}

static uint64_t bits_at(const uint8_t *bytes, size_t size, bool big_endian) {
    uint64_t bits = 0;
    for (size_t i = 0; i < size; i++) {
        bits |= (uint64_t)bytes[big_endian ? size - 1 - i : i] << (8 * i);
    }
    return bits;
}

static double number_at(const vn_vtp_array *array, const uint8_t *bytes, bool big_endian) {
    uint64_t bits = bits_at(bytes, array->bytes, big_endian);
    if (array->kind == 'f' && array->bytes == 4) {
        float value;
        uint32_t half = (uint32_t)bits;
        memcpy(&value, &half, sizeof value);
        return value;
    }
    if (array->kind == 'f') {
        double value;
        memcpy(&value, &bits, sizeof value);
        return value;
    }
    uint64_t sign = 1ull << (8 * array->bytes - 1);
    bool negative = array->kind == 'i' && (bits & sign) != 0;
    return negative ? -(double)((~bits & (sign - 1)) + 1) : (double)bits;
}

static vn_status convert(vn_vtp_array *array, const uint8_t *bytes, size_t count, bool big_endian) {
    if (count % array->bytes != 0) {
        return vn_fail(VN_INVALID, "an array of %zu bytes does not hold numbers of %zu", count, array->bytes);
    }
    for (size_t at = 0; at < count; at += array->bytes) {
        double value = number_at(array, bytes + at, big_endian);
        if (!(fabs(value) <= 1e300)) {
            return vn_fail(VN_INVALID, "an array holds %g; numbers must be finite", value);
        }
        VN_TRY(vn_array_push(&array->values, value));
    }
    return VN_OK;
}

static vn_status fail_short(void) {
    return vn_fail(VN_INVALID,
                   "an array is shorter than it says; the file was cut off, or offsets are wrong");
}

// No block that zlib makes grows more than about a thousandfold.
static vn_status unpack_block(const uint8_t *packed, size_t packed_size, uint64_t size, uint8_t *block) {
    uLongf got = (uLongf)size;
    if (uncompress(block, &got, packed, (uLong)packed_size) != Z_OK || got != size) {
        return vn_fail(VN_INVALID, "an array's packed block cannot be unpacked");
    }
    return VN_OK;
}

typedef VN_ARRAY(uint8_t) byte_array;

// {blocks, bytes of each, bytes of the last or 0, packed bytes of each …}, then the blocks.
static vn_status unpack(const vn_vtp_array *array, const vn_vtp_coding *coding, byte_array *out) {
    size_t word = coding->wide ? 8 : 4, end = (size_t)array->raw.count;
    const uint8_t *raw = array->raw.data;
    if (end == 0) {
        return VN_OK;
    }
    uint64_t blocks = end >= word ? bits_at(raw, word, coding->big_endian) : 1;
    if (blocks == 0) {
        return VN_OK;
    }
    if (blocks > end / word || (blocks + 3) * word > end) {
        return fail_short();
    }
    uint64_t each = bits_at(raw + word, word, coding->big_endian);
    uint64_t last = bits_at(raw + 2 * word, word, coding->big_endian);
    size_t at = (size_t)(blocks + 3) * word;
    for (uint64_t i = 0; i < blocks; i++) {
        uint64_t packed = bits_at(raw + (3 + i) * word, word, coding->big_endian);
        uint64_t size = i == blocks - 1 && last > 0 ? last : each;
        if (packed > end - at || size > 1100 * packed + 1024) {
            return fail_short();
        }
        VN_TRY(vn_array_reserve(out, out->count + (int64_t)size));
        VN_TRY(unpack_block(raw + at, (size_t)packed, size, out->data + out->count));
        out->count += (int32_t)size;
        at += (size_t)packed;
    }
    return VN_OK;
}

static vn_status end_packed(vn_vtp_array *array, const vn_vtp_coding *coding) {
    byte_array bytes = {0};
    vn_status status = unpack(array, coding, &bytes);
    status = status == VN_OK ? convert(array, bytes.data, (size_t)bytes.count, coding->big_endian) : status;
    vn_array_free(&bytes);
    return status;
}

static vn_status end_plain(vn_vtp_array *array, const vn_vtp_coding *coding) {
    size_t word = coding->wide ? 8 : 4, end = (size_t)array->raw.count;
    if (end == 0) {
        return VN_OK;
    }
    uint64_t size = end >= word ? bits_at(array->raw.data, word, coding->big_endian) : UINT64_MAX;
    if (end < word || size > end - word) {
        return fail_short();
    }
    return convert(array, array->raw.data + word, (size_t)size, coding->big_endian);
}

vn_status vn_vtp_end_base64(vn_vtp_array *array, const vn_vtp_coding *coding) {
    VN_TRY(array->letters > 1 ? end_group(array) : VN_OK);
    vn_status status = coding->packed ? end_packed(array, coding) : end_plain(array, coding);
    vn_array_free(&array->raw);
    return status;
}
