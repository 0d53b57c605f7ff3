/// Bytes on their way into a file, packed by gzip or as they are.
#ifndef VN_FILE_PACKER_H
#define VN_FILE_PACKER_H

#include "base/sink.h"

typedef struct vn_packer vn_packer;

/// What is written to the packer is appended to @p sink, as one gzip member without a name or a time if it @p
/// packs. VN_NO_MEMORY.
vn_status vn_packer_open(vn_packer **out, vn_sink *sink, bool packs);
vn_status vn_packer_write(vn_packer *packer, const void *bytes, size_t count);
/// End the member, with @p status VN_OK, and let the packer go. Returns @p status, or the failure to write.
/// NULL is accepted.
vn_status vn_packer_close(vn_packer *packer, vn_status status);

#endif
