#include "host/info.h"

#include "base/text.h"
#include "venule/output.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void print_range(const char *name, const double *min, const double *max, int dim) {
    printf("  %-13s", name);
    for (int k = 0; k < dim; k++) {
        printf("%s%g to %g", k > 0 ? ", " : "", min[k], max[k]);
    }
    putchar('\n');
}

// Millimetres to the network's unit; 0 where that is not known.
static double millimetres(const char *unit) {
    static const struct {
        const char *name;
        double mm;
    } units[] = {{"mm", 1}, {"cm", 10}, {"m", 1000}, {"um", 1e-3}, {"in", 25.4}, {"pt", 25.4 / 72}};
    for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
        if (strcmp(unit, units[i].name) == 0) {
            return units[i].mm;
        }
    }
    return 0;
}

static void print_density(const vn_leaf_measures *m, const char *unit) {
    double mm = millimetres(unit);
    printf("  vein density %g", m->density);
    if (mm > 0) {
        printf(" (%g mm/mm²)", m->density / mm);
    }
    printf("   in leaves: mean 8 in flowering plants, at most 25, others about 2 mm/mm² (Boyce 2009)\n");
    for (int32_t k = 0; k < m->order_count && k < 8; k++) {
        printf("    order %d    %g\n", k + 1, m->order_density[k]);
    }
}

static void print_statistics(const char *name, const vn_statistics *s) {
    printf("    %-10s %g ± %g, median %g, quartiles %g to %g\n", name, s->mean, s->deviation, s->median,
           s->lower, s->upper);
}

static void print_areoles(const vn_leaf_measures *m) {
    printf("  areoles      %d", m->areoles);
    if (m->crossings > 0) {
        printf("   not to be relied on: veins cross or touch in %d places", m->crossings);
    }
    putchar('\n');
    if (m->areoles > 0) {
        print_statistics("area", &m->areole_area);
        print_statistics("4πA/P²", &m->areole_quotient);
        printf(
            "    hierarchy  height %d, Strahler %d, asymmetry %g, nesting %g   (Katifori & Magnasco 2012)\n",
            m->hierarchy.height, m->hierarchy.strahler, m->hierarchy.asymmetry, m->hierarchy.nesting);
    }
    printf("  free ends    %d in areoles, %g by area; of %d tips, %g by area\n", m->free_ends,
           m->free_end_density, m->tips, m->tip_density);
}

static void print_junctions(const vn_leaf_measures *m) {
    int32_t all = m->degree3 + m->degree4 + m->degree_more;
    double more = all > 0 ? 100.0 * (m->degree4 + m->degree_more) / all : 0;
    printf("  junctions    %d of 3 edges, %d of 4, %d of more: %.3g%% above 3", m->degree3, m->degree4,
           m->degree_more, more);
    printf("   in real networks: 15%% and more (Meng 2026)\n");
    if (m->angles.count > 0) {
        printf("  angles       %.4g° between daughters   in leaves: 120° where equal veins meet, "
               "90° thin on thick (Bohn 2002)\n",
               m->angles.daughters);
    }
    for (int k = 0; k < 5; k++) {
        if (m->angles.bins[k].count > 0) {
            printf("    thin/thick %.1f to %.1f: %.4g° (%d)\n", k / 5.0, (k + 1) / 5.0,
                   m->angles.bins[k].thick_thin, m->angles.bins[k].count);
        }
    }
}

static vn_status print_leaf(const vn_network *network) {
    vn_leaf_measures m;
    vn_leaf_def def = vn_leaf_def_default();
    vn_status status = vn_network_measure_leaf(network, &def, &m);
    if (status != VN_OK) {
        return status;
    }
    printf("  area         %g, of the convex hull\n", m.area);
    print_density(&m, vn_network_unit(network));
    print_areoles(&m);
    print_junctions(&m);
    printf("  to a vein    mean %g, most frequent %g, at most %g; points %g apart\n", m.distance.mean,
           m.distance.mode, m.distance.max, m.distance.resolution);
    vn_leaf_measures_free(&m);
    return VN_OK;
}

static vn_status print_vessels(const vn_network *network) {
    vessel_info info;
    vn_status status = vessel_info_measure(&info, network);
    if (status == VN_OK) {
        vessel_info_print(&info);
    }
    vn_vessel_measures_free(&info.measures);
    return status;
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
    status = print_vessels(network);
    return status == VN_OK && vn_network_dim(network) == 2 ? print_leaf(network) : status;
}

void json_number(const char *before, const char *name, double value) {
    if (isfinite(value)) {
        printf("%s\"%s\": %.17g", before, name, value);
    } else {
        printf("%s\"%s\": null", before, name); // JSON has no infinity
    }
}

void json_numbers(const vn_statistics *s) {
    printf("\"count\": %d", s->count);
    json_number(", ", "mean", s->mean);
    json_number(", ", "deviation", s->deviation);
    json_number(", ", "min", s->min);
    json_number(", ", "lower", s->lower);
    json_number(", ", "median", s->median);
    json_number(", ", "upper", s->upper);
    json_number(", ", "max", s->max);
}

void json_statistics(const char *name, const vn_statistics *s) {
    printf(", \"%s\": {", name);
    json_numbers(s);
    printf("}");
}

static void json_angles(const vn_branching_angles *angles) {
    printf(", \"angles\": {\"count\": %d, \"daughters\": %.17g, \"bins\": [", angles->count,
           angles->daughters);
    for (int k = 0; k < 5; k++) {
        printf("%s{\"from\": %g, \"to\": %g, \"count\": %d, \"thick_middle\": %.17g, \"thick_thin\": %.17g, "
               "\"middle_thin\": %.17g}",
               k > 0 ? ", " : "", k / 5.0, (k + 1) / 5.0, angles->bins[k].count, angles->bins[k].thick_middle,
               angles->bins[k].thick_thin, angles->bins[k].middle_thin);
    }
    printf("]}");
}

static void json_leaf(const vn_leaf_measures *m) {
    const vn_loop_hierarchy *h = &m->hierarchy;
    printf(", \"leaf\": {\"area\": %.17g, \"area_of\": \"hull\", \"length\": %.17g, \"density\": %.17g, "
           "\"order_density\": [",
           m->area, m->length, m->density);
    for (int32_t k = 0; k < m->order_count; k++) {
        printf("%s%.17g", k > 0 ? ", " : "", m->order_density[k]);
    }
    printf("], \"tips\": %d, \"tip_density\": %.17g, \"free_ends\": %d, \"free_end_density\": %.17g, ",
           m->tips, m->tip_density, m->free_ends, m->free_end_density);
    printf("\"degree3\": %d, \"degree4\": %d, \"degree_more\": %d, \"loops\": %d, \"crossings\": %d, "
           "\"areoles\": %d",
           m->degree3, m->degree4, m->degree_more, m->loops, m->crossings, m->areoles);
    json_statistics("areole_area", &m->areole_area);
    json_statistics("areole_quotient", &m->areole_quotient);
    printf(", \"hierarchy\": {\"merges\": %d, \"height\": %d, \"strahler\": %d, \"asymmetry\": %.17g, "
           "\"nesting\": %.17g}",
           h->merge_count, h->height, h->strahler, h->asymmetry, h->nesting);
    json_angles(&m->angles);
    printf(", \"distance\": {\"resolution\": %.17g, \"points\": %d, \"mean\": %.17g, \"max\": %.17g, "
           "\"mode\": %.17g}}",
           m->distance.resolution, m->distance.points, m->distance.mean, m->distance.max, m->distance.mode);
}

static void json_basics(const vn_network *network, const char *name, const vn_network_measures *m) {
    printf("{\"name\": %s, \"dim\": %d, \"nodes\": %d, \"roots\": %d, \"tips\": %d, \"bifurcations\": %d, "
           "\"joins\": %d, "
           "\"depth\": %d, \"length\": %.17g, \"min_radius\": %.17g, \"max_radius\": %.17g",
           name, vn_network_dim(network), m->nodes, m->roots, m->tips, m->bifurcations, m->joins, m->depth,
           m->length, m->min_radius, m->max_radius);
}

static vn_status print_json(const vn_network *network, const char *name) {
    vn_network_measures m;
    vn_leaf_measures leaf = {0};
    vessel_info vessels = {0};
    vn_leaf_def def = vn_leaf_def_default();
    vn_text quoted = {0};
    bool flat = vn_network_dim(network) == 2;
    vn_status status = vn_network_measure(network, &m);
    status = status == VN_OK && flat ? vn_network_measure_leaf(network, &def, &leaf) : status;
    status = status == VN_OK ? vessel_info_measure(&vessels, network) : status;
    status = status == VN_OK ? vn_text_json(&quoted, name) : status;
    if (status == VN_OK) {
        json_basics(network, quoted.data, &m);
        vessel_info_json(&vessels);
        if (flat) {
            json_leaf(&leaf);
        }
        printf("}\n");
    }
    vn_array_free(&quoted);
    vn_leaf_measures_free(&leaf);
    vn_vessel_measures_free(&vessels.measures);
    return status;
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
        fprintf(stderr, "venule: info: one saved network expected (venule info FILE [--json])\n");
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
