/// The formats that networks are kept in: one row each, found by a file's extension.
#ifndef VN_FILE_FORMAT_H
#define VN_FILE_FORMAT_H

#include "base/sink.h"
#include "network/network.h"
#include "venule/output.h"

#include <stdio.h>

/// In one file.
enum { VN_MOST_NETWORKS = 4096 };

/// What is to be written into one file.
typedef struct vn_networks_given {
    const vn_network *const *networks;
    const char *const *names; ///< NULL: a single one without a name
    int32_t count;
    const char *manifest; ///< a JSON object, or NULL
} vn_networks_given;

/// Append all of the file to @p sink.
typedef vn_status vn_format_write(vn_sink *sink, const vn_networks_given *given);
/// Append the networks of @p file to the empty @p set, and its manifest. VN_INVALID, with a message that does
/// not name the file yet, or any other status with a whole message; the caller frees the set in every case.
typedef vn_status vn_format_read(vn_network_set *set, const char *path, FILE *file);

vn_format_write vn_json_write, vn_gxl_write, vn_vtp_write, vn_swc_write, vn_csv_write, vn_segments_write;
vn_format_read vn_json_read, vn_gxl_read, vn_vtp_read, vn_swc_read, vn_csv_read, vn_segments_read;

/// Make room for one more network, whose two slots are then NULL.
vn_status vn_network_set_extend(vn_network_set *set);
/// Append @p network, which from now on is the set's, without a name.
vn_status vn_network_set_add(vn_network_set *set, vn_network *network);
/// Keep @p text as the manifest when it is one; else, and where there is one already, nothing happens.
vn_status vn_network_set_manifest(vn_network_set *set, const char *text, size_t length);

/// Whether a text is one JSON object.
bool vn_is_manifest(const char *text, size_t length);

#endif
