/// What a file calls its nodes, by text or by place, and their numbers in the order in which they are met.
#ifndef VN_FILE_NAMES_H
#define VN_FILE_NAMES_H

#include "base/array.h"
#include "file/slice.h"

/// A hash table of keys that the two below keep: `slots` hold a number, or -1.
typedef VN_ARRAY(int32_t) vn_slots;

typedef struct vn_names {
    vn_text text;
    VN_ARRAY(int32_t) ends; ///< of each name in `text`
    vn_slots slots;
} vn_names;

/// The number of a name; the next one when it is new.
vn_status vn_names_number(vn_names *names, vn_slice name, int32_t *number);
vn_slice vn_names_name(const vn_names *names, int32_t number);
void vn_names_free(vn_names *names);

typedef struct vn_sites {
    VN_ARRAY(double) coordinates; ///< three of each place
    vn_slots slots;
} vn_sites;

/// The number of a place; the next one when it is new. 0 and -0 are one.
vn_status vn_sites_number(vn_sites *places, const double p[3], int32_t *number);
int32_t vn_sites_count(const vn_sites *places);
void vn_sites_free(vn_sites *places);

#endif
