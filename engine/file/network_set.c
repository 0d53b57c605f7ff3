// The networks that one file holds.
#include "base/memory.h"
#include "file/json.h"

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

void vn_networks_free(vn_network_set *set) {
    for (int32_t i = 0; i < set->count; i++) {
        vn_network_destroy(set->networks[i]);
        vn_free_text(set->names[i]);
    }
    size_t size = (size_t)set->count * sizeof(void *);
    vn_resize(set->networks, size, 0);
    vn_resize(set->names, size, 0);
    *set = (vn_network_set){0};
}
