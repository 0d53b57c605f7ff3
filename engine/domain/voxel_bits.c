#include "domain/voxel_bits.h"

vn_status vn_voxel_bits_init(vn_voxel_bits *bits, const int32_t size[3]) {
    *bits = (vn_voxel_bits){.count = 1};
    for (int a = 0; a < 3; a++) {
        bits->size[a] = size[a];
        bits->blocks[a] = (size[a] - 1) / 4 + 1;
        bits->count *= (size_t)bits->blocks[a];
    }
    bits->words = vn_new_block(bits->count * sizeof *bits->words);
    return bits->words != NULL ? VN_OK : vn_fail_memory("a mask", bits->count * sizeof *bits->words);
}

void vn_voxel_bits_free(vn_voxel_bits *bits) {
    vn_resize(bits->words, bits->words != NULL ? bits->count * sizeof *bits->words : 0, 0);
    *bits = (vn_voxel_bits){0};
}
