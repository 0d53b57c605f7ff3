#include "file/bytes.h"

#include "base/memory.h"
#include "base/text.h"

#include <errno.h>
#include <stdio.h>
#include <sys/stat.h>
#include <zlib.h>

enum { CHUNK = 65536 };

struct vn_bytes {
    const char *path;
    FILE *file;
    int64_t left;      ///< bytes of the file that were not read yet
    size_t begin, end; ///< of what is in `chunk` still to be taken
    bool unpacking, ended;
    bool refused; ///< there was no memory to unpack
    char broken[96];
    z_stream zlib;
    unsigned char chunk[CHUNK];
    unsigned char packed[CHUNK];
};

static vn_status open_file(vn_bytes *b) {
    struct stat about;
    b->file = fopen(b->path, "rb");
    if (b->file == NULL || fstat(fileno(b->file), &about) != 0) {
        return vn_fail(VN_IO, "%s: cannot be read: %s", b->path, strerror(errno));
    }
    if (!S_ISREG(about.st_mode)) {
        return vn_fail(VN_IO, "%s: cannot be read: it is no file", b->path);
    }
    b->left = about.st_size;
    return VN_OK;
}

vn_status vn_bytes_open(vn_bytes **out, const char *path) {
    *out = VN_NEW(vn_bytes);
    if (*out == NULL) {
        return vn_fail_memory("a file's bytes", sizeof **out);
    }
    (*out)->path = path;
    vn_status status = open_file(*out);
    if (status != VN_OK) {
        vn_bytes_close(*out);
        *out = NULL;
    }
    return status;
}

void vn_bytes_close(vn_bytes *bytes) {
    if (bytes == NULL) {
        return;
    }
    if (bytes->unpacking) {
        inflateEnd(&bytes->zlib);
    }
    if (bytes->file != NULL) {
        fclose(bytes->file);
    }
    VN_DELETE(bytes);
}

const char *vn_bytes_path(const vn_bytes *bytes) {
    return bytes->path;
}

// Returns how many bytes there were.
static size_t read_file(vn_bytes *b, unsigned char *to) {
    size_t count = fread(to, 1, CHUNK, b->file);
    b->left -= (int64_t)count < b->left ? (int64_t)count : b->left;
    if (count == 0 && ferror(b->file)) {
        snprintf(b->broken, sizeof b->broken, "cannot be read: %s", strerror(errno));
    }
    return count;
}

static void say_broken(vn_bytes *b, int code) {
    const char *message = b->zlib.msg != NULL ? b->zlib.msg : zError(code);
    b->refused = code == Z_MEM_ERROR;
    snprintf(b->broken, sizeof b->broken, "its packed bytes are broken: zlib says \"%s\"", message);
}

static bool has_input(vn_bytes *b) {
    if (b->zlib.avail_in == 0) {
        b->zlib.next_in = b->packed;
        b->zlib.avail_in = (uInt)read_file(b, b->packed);
    }
    return b->zlib.avail_in > 0;
}

// gzip files may follow each other in one: what they hold does so, too.
static bool begins_again(vn_bytes *b) {
    return has_input(b) && b->zlib.avail_in > 1 && b->zlib.next_in[0] == 0x1f && b->zlib.next_in[1] == 0x8b &&
           inflateReset(&b->zlib) == Z_OK;
}

static size_t unpack(vn_bytes *b) {
    b->zlib.next_out = b->chunk;
    b->zlib.avail_out = CHUNK;
    while (b->zlib.avail_out == CHUNK && !b->ended && has_input(b)) {
        int code = inflate(&b->zlib, Z_NO_FLUSH);
        if (code == Z_STREAM_END) {
            b->ended = !begins_again(b);
        } else if (code != Z_OK) {
            say_broken(b, code);
            b->ended = true;
        }
    }
    return CHUNK - b->zlib.avail_out;
}

// Whether there is a byte to take.
static bool fill(vn_bytes *b) {
    if (b->begin == b->end) {
        b->begin = 0;
        b->end = b->unpacking ? unpack(b) : read_file(b, b->chunk);
    }
    return b->begin < b->end;
}

bool vn_bytes_are_packed(vn_bytes *bytes) {
    return fill(bytes) && bytes->end - bytes->begin >= 2 && bytes->chunk[bytes->begin] == 0x1f &&
           bytes->chunk[bytes->begin + 1] == 0x8b;
}

static void *zlib_take(void *opaque, unsigned count, unsigned size) {
    (void)opaque;
    return vn_sized_block((size_t)count * size);
}

static void zlib_give_back(void *opaque, void *block) {
    (void)opaque;
    vn_free_sized(block);
}

vn_status vn_bytes_unpack(vn_bytes *bytes) {
    enum { ANY_HEADER = 32 + 15 };
    size_t count = bytes->end - bytes->begin;
    bytes->zlib = (z_stream){.zalloc = zlib_take, .zfree = zlib_give_back};
    if (inflateInit2(&bytes->zlib, ANY_HEADER) != Z_OK) {
        return vn_fail_memory("unpacking", 0);
    }
    memcpy(bytes->packed, bytes->chunk + bytes->begin, count);
    bytes->zlib.next_in = bytes->packed;
    bytes->zlib.avail_in = (uInt)count;
    bytes->begin = bytes->end = 0;
    bytes->unpacking = true;
    return VN_OK;
}

vn_status vn_bytes_fail(const vn_bytes *bytes, const char *what) {
    if (bytes->refused) {
        return vn_fail_memory("unpacking", CHUNK);
    }
    if (bytes->broken[0] != '\0') {
        return vn_fail(VN_IO, "%s: %s", bytes->path, bytes->broken);
    }
    return vn_fail(VN_IO, "%s: is cut off: it ends within its %s", bytes->path, what);
}

int vn_bytes_next(vn_bytes *bytes) {
    return fill(bytes) ? bytes->chunk[bytes->begin++] : -1;
}

// NULL: to nowhere.
static vn_status take(vn_bytes *b, unsigned char *to, size_t count, const char *what) {
    while (count > 0) {
        if (!fill(b)) {
            return vn_bytes_fail(b, what);
        }
        size_t part = b->end - b->begin < count ? b->end - b->begin : count;
        if (to != NULL) {
            memcpy(to, b->chunk + b->begin, part);
            to += part;
        }
        b->begin += part;
        count -= part;
    }
    return VN_OK;
}

vn_status vn_bytes_take(vn_bytes *bytes, void *to, size_t count, const char *what) {
    return take(bytes, to, count, what);
}

vn_status vn_bytes_skip(vn_bytes *bytes, size_t count, const char *what) {
    return take(bytes, NULL, count, what);
}

vn_status vn_bytes_line(vn_bytes *bytes, char *line, size_t size) {
    size_t length = 0;
    int c = vn_bytes_next(bytes);
    for (; c >= 0 && c != '\n'; c = vn_bytes_next(bytes)) {
        if (length + 1 < size) {
            line[length++] = (char)c;
        }
    }
    length -= length > 0 && line[length - 1] == '\r';
    line[length] = '\0';
    return c == '\n' ? VN_OK : vn_bytes_fail(bytes, "header");
}

static bool is_space(int c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

static int skip_to_word(vn_bytes *b) {
    int c = vn_bytes_next(b);
    while (is_space(c) || c == '#') {
        if (c == '#') {
            do {
                c = vn_bytes_next(b);
            } while (c >= 0 && c != '\n');
        }
        c = vn_bytes_next(b);
    }
    return c;
}

vn_status vn_bytes_word(vn_bytes *bytes, char *word, size_t size, const char *what) {
    size_t length = 0;
    int c = skip_to_word(bytes);
    for (; c >= 0 && !is_space(c); c = vn_bytes_next(bytes)) {
        if (length + 1 == size) {
            word[length] = '\0';
            return vn_fail(VN_IO, "%s: \"%s…\" is no number of its %s", bytes->path, word, what);
        }
        word[length++] = (char)c;
    }
    word[length] = '\0';
    return length > 0 && bytes->broken[0] == '\0' ? VN_OK : vn_bytes_fail(bytes, what);
}

vn_status vn_bytes_number(vn_bytes *bytes, double *value, const char *what) {
    char word[64];
    VN_TRY(vn_bytes_word(bytes, word, sizeof word, what));
    const char *end = word + strlen(word);
    if (vn_parse_number(word, end, value) != end) {
        return vn_fail(VN_IO, "%s: \"%s\" is no number of its %s", bytes->path, word, what);
    }
    return VN_OK;
}

vn_status vn_bytes_check(const vn_bytes *bytes, double count, bool packed, const char *what) {
    // Deflate makes at most 258 bytes of 2 bits, and keeps some to itself for a while.
    double ratio = packed || bytes->unpacking ? 1032 : 1;
    double here = (double)(bytes->end - bytes->begin), to_come = (double)bytes->left;
    if (bytes->unpacking) {
        here += CHUNK;
        to_come += (double)bytes->zlib.avail_in;
    } else {
        here *= ratio;
    }
    if (count > here + ratio * to_come) {
        return vn_fail(VN_IO, "%s: its header claims %.17g bytes of %s, more than its own bytes can hold",
                       bytes->path, count, what);
    }
    return VN_OK;
}

vn_status vn_bytes_end(vn_bytes *bytes) {
    if (!bytes->unpacking || bytes->begin < bytes->end || fill(bytes) ||
        (bytes->ended && !bytes->broken[0])) {
        return VN_OK;
    }
    return vn_bytes_fail(bytes, "checksum");
}
