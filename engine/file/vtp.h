/// The arrays of VTK's XML files: numbers as text, or as base64 of their bytes, which zlib may have packed.
#ifndef VN_FILE_VTP_H
#define VN_FILE_VTP_H

#include "file/draft.h"

/// How a file keeps bytes.
typedef struct vn_vtp_coding {
    bool big_endian;
    bool wide;   ///< sizes are of 64 bits
    bool packed; ///< by zlib
} vn_vtp_coding;

typedef struct vn_vtp_array {
    char kind;    ///< 'i', 'u', 'f': signed, unsigned, floating; 's': text
    size_t bytes; ///< of a number
    vn_numbers values;
    VN_ARRAY(uint8_t) raw; ///< what base64 gave
    char word[64];         ///< the number that a piece of text ended in
    size_t word_length;
    uint32_t group; ///< the base64 letters of the present group, six bits each
    int letters;
} vn_vtp_array;

/// Set the type ("Float64", "Int32", "String"); VN_INVALID for others.
vn_status vn_vtp_type(vn_vtp_array *array, vn_slice type);
/// Take the next piece of text, either kind.
vn_status vn_vtp_take_text(vn_vtp_array *array, const char *bytes, size_t count);
vn_status vn_vtp_take_base64(vn_vtp_array *array, const char *bytes, size_t count);
/// At the end of each kind.
vn_status vn_vtp_end_text(vn_vtp_array *array);
vn_status vn_vtp_end_base64(vn_vtp_array *array, const vn_vtp_coding *coding);
void vn_vtp_free(vn_vtp_array *array);

#endif
