#include "host/host.h"

#include "venule/output.h"

#include <stdio.h>
#include <string.h>

// How the networks were made goes with them.
static vn_status convert(const char *in, const char *out) {
    vn_network_set set;
    vn_status status = vn_networks_load(&set, in);
    if (status == VN_OK) {
        status = vn_networks_save((const vn_network *const *)set.networks, (const char *const *)set.names,
                                  set.count, out, set.manifest);
    }
    vn_networks_free(&set);
    return status;
}

static void print_formats(FILE *to) {
    for (int32_t i = 0; vn_network_format(i) != NULL; i++) {
        fprintf(to, "%s.%s", i > 0 ? " " : "", vn_network_format(i));
    }
}

int convert_command(int argc, char **argv) {
    if (argc != 2 || argv[0][0] == '-' || argv[1][0] == '-') {
        fprintf(stderr, "venule: convert: two files expected (venule convert IN OUT), each of ");
        print_formats(stderr);
        fputc('\n', stderr);
        return VN_EXIT_USAGE;
    }
    vn_status status = convert(argv[0], argv[1]);
    if (status != VN_OK) {
        fprintf(stderr, "venule: %s\n", vn_message());
    }
    return vn_exit_status(status);
}
