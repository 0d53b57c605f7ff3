// The networks that one file holds.
#include "base/memory.h"
#include "file/format.h"

#include <yajl/yajl_parse.h>

vn_status vn_network_set_extend(vn_network_set *set) {
    size_t old_size = (size_t)set->count * sizeof(void *);
    vn_network **networks = vn_resize(set->networks, old_size, old_size + sizeof(void *));
    if (networks == NULL) {
        return vn_fail_memory("a list of networks", sizeof(void *));
    }
    set->networks = networks;
    char **names = vn_resize(set->names, old_size, old_size + sizeof(void *));
    if (names == NULL) {
        set->networks = vn_resize(networks, old_size + sizeof(void *), old_size);
        return vn_fail_memory("a list of networks", sizeof(void *));
    }
    set->names = names;
    set->networks[set->count] = NULL;
    set->names[set->count] = NULL;
    set->count++;
    return VN_OK;
}

vn_status vn_network_set_add(vn_network_set *set, vn_network *network) {
    vn_status status = vn_network_set_extend(set);
    if (status != VN_OK) {
        vn_network_destroy(network);
        return status;
    }
    set->networks[set->count - 1] = network;
    set->names[set->count - 1] = vn_copy_text("");
    return set->names[set->count - 1] != NULL ? VN_OK : vn_fail_memory("a name", 1);
}

static bool is_json(const char *text, size_t length) {
    yajl_handle parser = yajl_alloc(NULL, NULL, NULL);
    bool good = parser != NULL && yajl_parse(parser, (const unsigned char *)text, length) == yajl_status_ok &&
                yajl_complete_parse(parser) == yajl_status_ok;
    if (parser != NULL) {
        yajl_free(parser);
    }
    return good;
}

bool vn_is_manifest(const char *text, size_t length) {
    size_t begin = 0;
    while (begin < length && strchr(" \t\r\n", text[begin]) != NULL) {
        begin++;
    }
    return begin < length && text[begin] == '{' && memchr(text, '\0', length) == NULL &&
           is_json(text, length);
}

vn_status vn_network_set_manifest(vn_network_set *set, const char *text, size_t length) {
    if (set->manifest != NULL || !vn_is_manifest(text, length)) {
        return VN_OK;
    }
    set->manifest = vn_resize(NULL, 0, length + 1);
    if (set->manifest == NULL) {
        return vn_fail_memory("a manifest", length + 1);
    }
    memcpy(set->manifest, text, length);
    set->manifest[length] = '\0';
    return VN_OK;
}

void vn_networks_free(vn_network_set *set) {
    for (int32_t i = 0; i < set->count; i++) {
        vn_network_destroy(set->networks[i]);
        vn_free_text(set->names[i]);
    }
    size_t size = (size_t)set->count * sizeof(void *);
    vn_resize(set->networks, size, 0);
    vn_resize(set->names, size, 0);
    vn_free_text(set->manifest);
    *set = (vn_network_set){0};
}
