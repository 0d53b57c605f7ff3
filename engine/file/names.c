#include "file/names.h"

static vn_status clear_slots(vn_slots *slots, int64_t size) {
    VN_TRY(vn_array_reserve(slots, size));
    slots->count = (int32_t)size;
    memset(slots->data, 0xFF, (size_t)size * sizeof *slots->data);
    return VN_OK;
}

// At most half full, so that a free place is near; a power of two.
static int64_t slots_for(const vn_slots *slots, int32_t count) {
    int64_t size = slots->count > 0 ? slots->count : 64;
    while (size < 2 * ((int64_t)count + 1)) {
        size *= 2;
    }
    return size;
}

static uint64_t hash_name(vn_slice name) {
    uint64_t hash = name.length;
    for (size_t at = 0; at < name.length; at += 8) {
        uint64_t word = 0;
        memcpy(&word, name.text + at, name.length - at < 8 ? name.length - at : 8);
        hash = vn_hash(hash, word, 0, 0);
    }
    return hash;
}

vn_slice vn_names_name(const vn_names *names, int32_t number) {
    int32_t begin = number > 0 ? names->ends.data[number - 1] : 0;
    return (vn_slice){names->text.data + begin, (size_t)(names->ends.data[number] - begin)};
}

static bool same_name(vn_slice a, vn_slice b) {
    return a.length == b.length && (a.length == 0 || memcmp(a.text, b.text, a.length) == 0);
}

// Where the name is, or would be.
static int32_t *name_slot(vn_names *names, vn_slice name) {
    uint32_t mask = (uint32_t)names->slots.count - 1;
    uint32_t at = (uint32_t)hash_name(name) & mask;
    while (names->slots.data[at] >= 0 && !same_name(vn_names_name(names, names->slots.data[at]), name)) {
        at = (at + 1) & mask;
    }
    return &names->slots.data[at];
}

static vn_status names_make_room(vn_names *names) {
    int64_t size = slots_for(&names->slots, names->ends.count);
    if (size == names->slots.count) {
        return VN_OK;
    }
    VN_TRY(clear_slots(&names->slots, size));
    for (int32_t i = 0; i < names->ends.count; i++) {
        *name_slot(names, vn_names_name(names, i)) = i;
    }
    return VN_OK;
}

vn_status vn_names_number(vn_names *names, vn_slice name, int32_t *number) {
    VN_TRY(names_make_room(names));
    int32_t *slot = name_slot(names, name);
    if (*slot < 0) {
        VN_TRY(vn_array_reserve(&names->ends, (int64_t)names->ends.count + 1));
        VN_TRY(vn_text_append(&names->text, name.text, name.length));
        *slot = names->ends.count;
        names->ends.data[names->ends.count++] = names->text.count;
    }
    *number = *slot;
    return VN_OK;
}

void vn_names_free(vn_names *names) {
    vn_array_free(&names->text);
    vn_array_free(&names->ends);
    vn_array_free(&names->slots);
}

static uint64_t bits_of(double value) {
    uint64_t bits;
    value += 0.0; // -0 becomes 0
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

int32_t vn_sites_count(const vn_sites *places) {
    return places->coordinates.count / 3;
}

static int32_t *place_slot(vn_sites *places, const double p[3]) {
    uint32_t mask = (uint32_t)places->slots.count - 1;
    uint32_t at = (uint32_t)vn_hash(0, bits_of(p[0]), bits_of(p[1]), bits_of(p[2])) & mask;
    for (; places->slots.data[at] >= 0; at = (at + 1) & mask) {
        const double *q = places->coordinates.data + 3 * (size_t)places->slots.data[at];
        if (p[0] == q[0] && p[1] == q[1] && p[2] == q[2]) {
            break;
        }
    }
    return &places->slots.data[at];
}

static vn_status places_make_room(vn_sites *places) {
    int32_t count = vn_sites_count(places);
    int64_t size = slots_for(&places->slots, count);
    VN_TRY(vn_array_reserve(&places->coordinates, 3 * ((int64_t)count + 1)));
    if (size == places->slots.count) {
        return VN_OK;
    }
    VN_TRY(clear_slots(&places->slots, size));
    for (int32_t i = 0; i < count; i++) {
        *place_slot(places, places->coordinates.data + 3 * (size_t)i) = i;
    }
    return VN_OK;
}

vn_status vn_sites_number(vn_sites *places, const double p[3], int32_t *number) {
    VN_TRY(places_make_room(places));
    int32_t *slot = place_slot(places, p);
    if (*slot < 0) {
        *slot = vn_sites_count(places);
        memcpy(places->coordinates.data + places->coordinates.count, p, 3 * sizeof *p);
        places->coordinates.count += 3;
    }
    *number = *slot;
    return VN_OK;
}

void vn_sites_free(vn_sites *places) {
    vn_array_free(&places->coordinates);
    vn_array_free(&places->slots);
}
