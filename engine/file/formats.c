// One table of the formats, and what is the same for all of them.
#include "base/memory.h"
#include "file/format.h"

#include <errno.h>
#include <strings.h>

static const struct vn_format {
    const char *extension;
    vn_format_read *read;
    vn_format_write *write;
    bool several; ///< more networks than one, by name
    bool joins;
} formats[] = {
    {"json", vn_json_read, vn_json_write, true, true},          // ours
    {"xml", vn_gxl_read, vn_gxl_write, false, true},            // VascuSynth's and OpenCCO's
    {"gxl", vn_gxl_read, vn_gxl_write, false, true},            // the same
    {"vtp", vn_vtp_read, vn_vtp_write, false, true},            // ParaView's, VMTK's
    {"swc", vn_swc_read, vn_swc_write, false, false},           // neuron morphologies
    {"csv", vn_csv_read, vn_csv_write, false, false},           // a row a node
    {"txt", vn_segments_read, vn_segments_write, false, false}, // OpenCCO's -e: a row a segment
};

enum { FORMATS = sizeof formats / sizeof *formats };

const char *vn_network_format(int32_t index) {
    return index >= 0 && index < FORMATS ? formats[index].extension : NULL;
}

static const struct vn_format *find_format(const char *path) {
    const char *slash = strrchr(path, '/');
    const char *dot = strrchr(slash != NULL ? slash : path, '.');
    for (int i = 0; dot != NULL && i < FORMATS; i++) {
        if (strcasecmp(dot + 1, formats[i].extension) == 0) {
            return &formats[i];
        }
    }
    return NULL;
}

// ".json, .xml or .csv" of all, or of those that hold what the first that was asked for does not.
static const char *list_formats(char *text, size_t size, bool several, bool joins) {
    const char *names[FORMATS];
    int count = 0;
    size_t used = 0;
    for (int i = 0; i < FORMATS; i++) {
        if ((!several || formats[i].several) && (!joins || formats[i].joins)) {
            names[count++] = formats[i].extension;
        }
    }
    for (int i = 0; i < count && used < size; i++) {
        const char *before = i == 0 ? "" : (i == count - 1 ? " or " : ", ");
        used += (size_t)snprintf(text + used, size - used, "%s.%s", before, names[i]);
    }
    return text;
}

static vn_status fail_unknown(const char *path, const char *done) {
    char known[100];
    return vn_fail(VN_INVALID, "%s: networks are %s as %s; give such a name", path, done,
                   list_formats(known, sizeof known, false, false));
}

static vn_status check_names(const char *const *names, int32_t count) {
    if (names == NULL) {
        return vn_fail(VN_INVALID, "%d networks for one file need a name each", count);
    }
    for (int32_t i = 0; i < count; i++) {
        if (names[i] == NULL || names[i][0] == '\0') {
            return vn_fail(VN_INVALID, "network %d of %d for one file needs a name", i + 1, count);
        }
        for (int32_t j = 0; j < i; j++) {
            if (strcmp(names[i], names[j]) == 0) {
                return vn_fail(VN_INVALID, "two networks for one file are called \"%s\"; rename one",
                               names[i]);
            }
        }
    }
    return VN_OK;
}

// A manifest that is no JSON object would spoil the file around it.
static vn_status check_manifest(const char *manifest) {
    if (manifest == NULL || vn_is_manifest(manifest, strlen(manifest))) {
        return VN_OK;
    }
    return vn_fail(VN_INVALID, "the manifest must be a JSON object, not \"%.40s\"", manifest);
}

static bool is_single(const char *const *names, int32_t count) {
    return count == 1 && (names == NULL || names[0] == NULL || names[0][0] == '\0');
}

static vn_status check_joins(const vn_network *const *networks, int32_t count, const char *path) {
    char known[100];
    for (int32_t i = 0; i < count; i++) {
        int32_t joins = vn_network_join_count(networks[i]);
        if (joins > 0) {
            return vn_fail(VN_INVALID, "%s: such a file holds trees, but %d joins close loops; save it as %s",
                           path, joins, list_formats(known, sizeof known, false, true));
        }
    }
    return VN_OK;
}

vn_status vn_networks_check(const vn_network *const *networks, const char *const *names, int32_t count,
                            const char *path) {
    const struct vn_format *format = find_format(path);
    char known[100];
    if (format == NULL) {
        return fail_unknown(path, "written");
    }
    if (count < 1 || count > VN_MOST_NETWORKS) {
        return vn_fail(VN_INVALID, "%s: a file holds 1 to %d networks, not %d", path, VN_MOST_NETWORKS,
                       count);
    }
    if (count > 1 && !format->several) {
        return vn_fail(VN_INVALID,
                       "%s: such a file holds one network, not %d; save each to its own, or all as %s", path,
                       count, list_formats(known, sizeof known, true, false));
    }
    if (!is_single(names, count)) {
        VN_TRY(check_names(names, count));
    }
    return format->joins ? VN_OK : check_joins(networks, count, path);
}

vn_status vn_networks_save(const vn_network *const *networks, const char *const *names, int32_t count,
                           const char *path, const char *manifest) {
    VN_TRY(vn_networks_check(networks, names, count, path));
    VN_TRY(check_manifest(manifest));
    vn_networks_given given = {networks, is_single(names, count) ? NULL : names, count, manifest};
    vn_sink *sink;
    VN_TRY(vn_sink_open(&sink, path));
    return vn_sink_close(sink, find_format(path)->write(sink, &given));
}

vn_status vn_network_save(const vn_network *network, const char *path, const char *manifest) {
    return vn_networks_save(&network, NULL, 1, path, manifest);
}

// What a reader says of the file's contents does not name the file yet, and may quote any byte of it.
static vn_status name_file(const char *path, vn_status status) {
    if (status != VN_INVALID) {
        return status;
    }
    char message[500];
    snprintf(message, sizeof message, "%s", vn_message());
    for (char *at = message; *at != '\0'; at++) {
        *at = (unsigned char)*at < 0x20 || *at == 0x7F ? '?' : *at;
    }
    return vn_fail(VN_IO, "%s: %s", path, message);
}

vn_status vn_networks_load(vn_network_set *out, const char *path) {
    *out = (vn_network_set){0};
    const struct vn_format *format = find_format(path);
    if (format == NULL) {
        return fail_unknown(path, "read");
    }
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return vn_fail(VN_IO, "%s: cannot be read: %s", path, strerror(errno));
    }
    vn_status status = name_file(path, format->read(out, path, file));
    fclose(file);
    if (status != VN_OK) {
        vn_networks_free(out);
    }
    return status;
}
