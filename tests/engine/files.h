/// What the tests of file formats share: a folder of their own, files in it, and networks that have
/// everything.
#ifndef VN_TESTS_FILES_H
#define VN_TESTS_FILES_H

#include "support.h"

#include "network/network.h"

int make_folder(void **state);
/// Fails unless every file in it was made by in_folder().
int drop_folder(void **state);
/// The path of a file there; the last eight answers stay as they are.
const char *in_folder(const char *name);

void put_file(const char *path, const char *text, size_t size);
void put_text(const char *path, const char *text);
/// The bytes with a zero byte after them, freed by the caller.
char *take_file(const char *path, size_t *size);

/// A forest of several trees with radii, flows, pressures and births, all of them numbers with many digits.
vn_network *full_forest(int dim, int32_t nodes, int32_t joins, uint64_t seed);
vn_network *load_one(const char *path);
/// VN_OK or a failure of the test that says why.
void save_one(const vn_network *network, const char *path, const char *manifest);

/// What a comparison looks at.
enum { RADII = 1, FLOWS = 2, PRESSURES = 4, BIRTHS = 8, JOINS = 16, UNITS = 32, ALL = 63 };
void assert_same_network(const vn_network *a, const vn_network *b, unsigned what);

#endif
