#include "file/packer.h"

#include "base/memory.h"

#include <limits.h>
#include <zlib.h>

struct vn_packer {
    vn_sink *sink;
    bool packs;
    z_stream stream;
    unsigned char out[1 << 16];
};

static voidpf take(voidpf unused, uInt items, uInt size) {
    (void)unused;
    return vn_sized_block((size_t)items * size); // both are 32 bits
}

static void give_back(voidpf unused, voidpf block) {
    (void)unused;
    vn_free_sized(block);
}

// The level is part of the format: the same volume has the same bytes. zlib's own gzip head carries no time.
enum { LEVEL = 6, GZIP_WINDOW = 15 + 16, MEMORY_LEVEL = 8 };

vn_status vn_packer_open(vn_packer **out, vn_sink *sink, bool packs) {
    *out = NULL;
    vn_packer *packer = VN_NEW(vn_packer);
    if (packer == NULL) {
        return vn_fail_memory("a packer", sizeof *packer);
    }
    packer->sink = sink;
    packer->packs = packs;
    packer->stream.zalloc = take;
    packer->stream.zfree = give_back;
    if (packs && deflateInit2(&packer->stream, LEVEL, Z_DEFLATED, GZIP_WINDOW, MEMORY_LEVEL,
                              Z_DEFAULT_STRATEGY) != Z_OK) {
        VN_DELETE(packer);
        return vn_fail_memory("packing", 1 << 18);
    }
    *out = packer;
    return VN_OK;
}

// Pack what is waiting; with Z_FINISH, to the end.
static vn_status pump(vn_packer *packer, int flush) {
    z_stream *stream = &packer->stream;
    do {
        stream->next_out = packer->out;
        stream->avail_out = sizeof packer->out;
        deflate(stream, flush); // cannot fail: the stream is whole and there is room
        VN_TRY(vn_sink_write(packer->sink, packer->out, sizeof packer->out - stream->avail_out));
    } while (stream->avail_out == 0);
    return VN_OK;
}

vn_status vn_packer_write(vn_packer *packer, const void *bytes, size_t count) {
    if (!packer->packs) {
        return vn_sink_write(packer->sink, bytes, count);
    }
    const unsigned char *at = bytes;
    while (count > 0) {
        uInt part = count < UINT_MAX ? (uInt)count : UINT_MAX;
        packer->stream.next_in = (Bytef *)at;
        packer->stream.avail_in = part;
        VN_TRY(pump(packer, Z_NO_FLUSH));
        at += part;
        count -= part;
    }
    return VN_OK;
}

vn_status vn_packer_close(vn_packer *packer, vn_status status) {
    if (packer == NULL) {
        return status;
    }
    if (packer->packs) {
        status = status == VN_OK ? pump(packer, Z_FINISH) : status;
        deflateEnd(&packer->stream);
    }
    VN_DELETE(packer);
    return status;
}
