/// @file embedded.h
/// The Lua modules that were compiled in; cmake/embed.cmake makes the table from the files in lua/.
#ifndef VN_BIND_EMBEDDED_H
#define VN_BIND_EMBEDDED_H

typedef struct vn_embedded {
    const char *name;          ///< as `require` has it: "venule.venation"
    const unsigned char *data; ///< the file's bytes, and a zero that `size` does not count
    unsigned size;
} vn_embedded;

extern const vn_embedded vn_embedded_modules[];
extern const int vn_embedded_count;

#endif
