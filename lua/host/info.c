#include "host/host.h"

#include "base/text.h"
#include "venule/output.h"

#include <stdio.h>
#include <string.h>

static void print_range(const char *name, const double *min, const double *max, int dim) {
    printf("  %-13s", name);
    for (int k = 0; k < dim; k++) {
        printf("%s%g to %g", k > 0 ? ", " : "", min[k], max[k]);
    }
    putchar('\n');
}

static vn_status print_text(const vn_network *network, const char *name) {
    vn_network_measures m;
    vn_status status = vn_network_measure(network, &m);
    if (status != VN_OK) {
        return status;
    }
    const char *unit = vn_network_unit(network);
    printf("%s%snetwork in %dD%s%s\n", name, name[0] != '\0' ? ": " : "", vn_network_dim(network),
           unit[0] != '\0' ? ", lengths in " : "", unit);
    printf("  nodes        %d\n  roots        %d\n  tips         %d\n", m.nodes, m.roots, m.tips);
    printf("  bifurcations %d\n  joins        %d\n  depth        %d\n", m.bifurcations, m.joins, m.depth);
    printf("  length       %g\n", m.length);
    print_range("extent", m.extent.min, m.extent.max, vn_network_dim(network));
    print_range("radius", &m.min_radius, &m.max_radius, 1);
    return VN_OK;
}

static vn_status print_json(const vn_network *network, const char *name) {
    vn_network_measures m;
    vn_status status = vn_network_measure(network, &m);
    if (status != VN_OK) {
        return status;
    }
    vn_text quoted = {0};
    status = vn_text_json(&quoted, name);
    if (status != VN_OK) {
        return status;
    }
    printf("{\"name\": %s, \"dim\": %d, \"nodes\": %d, \"roots\": %d, \"tips\": %d, \"bifurcations\": "
           "%d, \"joins\": %d, "
           "\"depth\": %d, \"length\": %.17g, \"min_radius\": %.17g, \"max_radius\": %.17g}\n",
           quoted.data, vn_network_dim(network), m.nodes, m.roots, m.tips, m.bifurcations, m.joins, m.depth,
           m.length, m.min_radius, m.max_radius);
    vn_array_free(&quoted);
    return VN_OK;
}

int info_command(int argc, char **argv) {
    bool json = false;
    const char *path = NULL;
    for (int i = 0; i < argc; i++) {
        if (strcmp(argv[i], "--json") == 0) {
            json = true;
        } else if (argv[i][0] == '-' || path != NULL) {
            path = NULL;
            break;
        } else {
            path = argv[i];
        }
    }
    if (path == NULL) {
        fprintf(stderr, "venule: info: one saved network expected (venule info FILE.json [--json])\n");
        return VN_EXIT_USAGE;
    }
    vn_network_set set = {0};
    vn_status status = vn_networks_load(&set, path);
    for (int32_t i = 0; status == VN_OK && i < set.count; i++) {
        status = json ? print_json(set.networks[i], set.names[i]) : print_text(set.networks[i], set.names[i]);
    }
    vn_networks_free(&set);
    if (status != VN_OK) {
        fprintf(stderr, "venule: %s\n", vn_message());
    }
    return vn_exit_status(status);
}
