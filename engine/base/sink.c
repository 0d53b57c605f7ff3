#define _GNU_SOURCE // O_TMPFILE
#include "base/sink.h"

#include "base/memory.h"
#include "base/text.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdarg.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

struct vn_sink {
    FILE *file;
    char *path;
    char *part;  // the name while it is being written
    bool named;  // `part` exists in the folder
    bool failed; // a write was refused
};

static vn_status fail_open(const char *path, int error) {
    return vn_fail(VN_IO, "%s: cannot be written: %s", path, strerror(error));
}

static char *folder_of(const char *path) {
    const char *slash = strrchr(path, '/');
    char *folder = vn_copy_text(slash == NULL ? "." : path);
    if (folder != NULL && slash != NULL) {
        size_t size = strlen(path) + 1;
        size_t length = slash == path ? 1 : (size_t)(slash - path);
        char *cut = vn_resize(folder, size, length + 1);
        cut[length] = '\0';
        return cut;
    }
    return folder;
}

static char *part_name(const char *path) {
    size_t size = strlen(path) + 32;
    char *name = vn_resize(NULL, 0, size);
    if (name == NULL) {
        return NULL;
    }
    snprintf(name, size, "%s.%ld.part", path, (long)getpid());
    return vn_resize(name, size, strlen(name) + 1);
}

// A file without a name where the file system has such, else one named `part`.
static int open_part(vn_sink *sink, const char *folder) {
    bool can_name_later = access("/proc/self/fd", X_OK) == 0;
    int fd = can_name_later ? open(folder, O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666) : -1;
    if (fd < 0 && (!can_name_later || errno == EOPNOTSUPP || errno == EISDIR || errno == EINVAL)) {
        unlink(sink->part); // of a process of this number that was killed
        fd = open(sink->part, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
        sink->named = fd >= 0;
    }
    return fd;
}

static void sink_free(vn_sink *sink) {
    vn_free_text(sink->path);
    vn_free_text(sink->part);
    VN_DELETE(sink);
}

static vn_status sink_begin(vn_sink *sink, const char *path) {
    struct stat info;
    if (stat(path, &info) == 0 && S_ISDIR(info.st_mode)) {
        return vn_fail(VN_IO, "%s: is a folder; give the name of a file in it", path);
    }
    char target[PATH_MAX];
    path = realpath(path, target) != NULL ? target : path; // what a link points at is written, the link stays
    sink->path = vn_copy_text(path);
    sink->part = part_name(path);
    char *folder = folder_of(path);
    if (sink->path == NULL || sink->part == NULL || folder == NULL) {
        vn_free_text(folder);
        return vn_fail_memory("a file name", strlen(path));
    }
    int fd = open_part(sink, folder);
    int error = errno;
    vn_free_text(folder);
    sink->file = fd >= 0 ? fdopen(fd, "wb") : NULL;
    if (sink->file == NULL && fd >= 0) {
        error = errno;
        close(fd);
        if (sink->named) {
            unlink(sink->part);
        }
    }
    return sink->file != NULL ? VN_OK : fail_open(path, error);
}

vn_status vn_sink_open(vn_sink **out, const char *path) {
    *out = NULL;
    vn_sink *sink = VN_NEW(vn_sink);
    if (sink == NULL) {
        return vn_fail_memory("a file", sizeof *sink);
    }
    vn_status status = sink_begin(sink, path);
    if (status != VN_OK) {
        sink_free(sink);
        return status;
    }
    *out = sink;
    return VN_OK;
}

static vn_status fail_write(vn_sink *sink) {
    sink->failed = true;
    return vn_fail(VN_IO, "%s: could not be written: %s", sink->path, strerror(errno));
}

vn_status vn_sink_write(vn_sink *sink, const void *bytes, size_t count) {
    return fwrite(bytes, 1, count, sink->file) == count ? VN_OK : fail_write(sink);
}

vn_status vn_sink_text(vn_sink *sink, const char *text) {
    return vn_sink_write(sink, text, strlen(text));
}

vn_status vn_sink_print(vn_sink *sink, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    int written = vfprintf(sink->file, format, arguments);
    va_end(arguments);
    return written >= 0 ? VN_OK : fail_write(sink);
}

vn_status vn_sink_number(vn_sink *sink, double value) {
    char text[VN_NUMBER_SIZE];
    return vn_sink_write(sink, text, (size_t)vn_format_number(text, value));
}

vn_status vn_sink_rounded(vn_sink *sink, double value, int decimals) {
    char text[VN_NUMBER_SIZE];
    return vn_sink_write(sink, text, (size_t)vn_format_rounded(text, value, decimals));
}

vn_status vn_sink_integer(vn_sink *sink, int64_t value) {
    char digits[VN_NUMBER_SIZE];
    char *at = digits + sizeof digits;
    uint64_t rest = value < 0 ? 0u - (uint64_t)value : (uint64_t)value;
    do {
        *--at = (char)('0' + rest % 10);
        rest /= 10;
    } while (rest > 0);
    if (value < 0) {
        *--at = '-';
    }
    return vn_sink_write(sink, at, (size_t)(digits + sizeof digits - at));
}

// linkat() does not replace a file, rename() does: so a nameless file is named `part` for one moment.
static bool give_name(vn_sink *sink) {
    int fd = fileno(sink->file);
    if (fflush(sink->file) != 0 || fsync(fd) != 0) {
        return false;
    }
    if (!sink->named) {
        char source[64];
        snprintf(source, sizeof source, "/proc/self/fd/%d", fd);
        unlink(sink->part);
        sink->named = linkat(AT_FDCWD, source, AT_FDCWD, sink->part, AT_SYMLINK_FOLLOW) == 0;
    }
    return sink->named && rename(sink->part, sink->path) == 0;
}

vn_status vn_sink_close(vn_sink *sink, vn_status status) {
    if (sink == NULL) {
        return status;
    }
    if (status == VN_OK && sink->failed) {
        status = vn_fail(VN_IO, "%s: could not be written whole (is the disk full?)", sink->path);
    }
    if (status == VN_OK) {
        status = give_name(sink) ? VN_OK : fail_write(sink);
    }
    fclose(sink->file);
    if (status != VN_OK && sink->named) {
        unlink(sink->part);
    }
    sink_free(sink);
    return status;
}
