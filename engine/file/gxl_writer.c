// GXL that the programs of VascuSynth's and OpenCCO's users read. These compare names as their own files have
// them, with a space in front (" radius"), and one takes every <float> of a node for a coordinate: so attr
// elements are written as they write them, and what those files do not know is said in the tags themselves,
// where it is passed over.
#include "file/draft.h"
#include "file/xml.h"

#include <math.h>
#include <yajl/yajl_tree.h>

typedef struct gxl_writer {
    vn_sink *sink;
    const vn_network *network;
    const double *flow, *pressure;
    bool has_radii;
    vn_numbers resistance; // reduced, of each node's edge; empty: unknown
} gxl_writer;

static vn_status write_attr(const gxl_writer *writer, const char *name, double value) {
    VN_TRY(vn_sink_print(writer->sink, "    <attr name=\" %s\">\n      <float>", name));
    VN_TRY(vn_sink_number(writer->sink, value));
    return vn_sink_text(writer->sink, "</float>\n    </attr>\n");
}

static vn_status write_tag_number(const gxl_writer *writer, const char *name, double value) {
    VN_TRY(vn_sink_print(writer->sink, " %s=\"", name));
    VN_TRY(vn_sink_number(writer->sink, value));
    return vn_sink_text(writer->sink, "\"");
}

static bool is_terminal(const vn_network *network, int32_t node) {
    return vn_network_parent(network)[node] >= 0 && vn_network_first_child(network, node) < 0;
}

// The pressure that all terminals have, as far as numbers tell; NAN where they differ or are not known.
static double terminal_pressure(const gxl_writer *writer) {
    double found = NAN;
    for (int32_t i = 0; writer->pressure != NULL && i < vn_network_count(writer->network); i++) {
        double here = writer->pressure[i];
        if (!is_terminal(writer->network, i)) {
            continue;
        }
        found = isnan(found) ? here : found;
        if (!(fabs(here - found) <= 1e-6 * fabs(found))) {
            return NAN;
        }
    }
    return found;
}

static double root_pressure(const gxl_writer *writer) {
    for (int32_t i = 0; writer->pressure != NULL && i < vn_network_count(writer->network); i++) {
        if (vn_network_parent(writer->network)[i] < 0) {
            return writer->pressure[i];
        }
    }
    return NAN;
}

static vn_status write_info(const gxl_writer *writer) {
    double root = root_pressure(writer), terminal = terminal_pressure(writer);
    if (isnan(root)) {
        return VN_OK;
    }
    VN_TRY(vn_sink_text(writer->sink, "<info_graph>\n"));
    VN_TRY(write_attr(writer, "pPerf", root));
    VN_TRY(isnan(terminal) ? VN_OK : write_attr(writer, "pTerm", terminal));
    return vn_sink_text(writer->sink, "</info_graph>\n");
}

// In the words, and the spelling, of VascuSynth.
static const char *type_of(const vn_network *network, int32_t node) {
    int32_t child = vn_network_first_child(network, node);
    if (vn_network_parent(network)[node] < 0) {
        return "root node";
    }
    if (child < 0) {
        return "terminal node";
    }
    return vn_network_next_child(network, child) >= 0 ? "bifurication" : "unknown type";
}

static vn_status write_position(const gxl_writer *writer, int32_t node) {
    double p[3];
    vn_network_position(writer->network, node, p);
    VN_TRY(vn_sink_text(writer->sink, "    <attr name=\" position\">\n      <tup>\n"));
    for (int k = 0; k < vn_network_dim(writer->network) && k < 3; k++) {
        VN_TRY(vn_sink_text(writer->sink, "        <float>"));
        VN_TRY(vn_sink_number(writer->sink, p[k]));
        VN_TRY(vn_sink_text(writer->sink, "</float>\n"));
    }
    return vn_sink_text(writer->sink, "      </tup>\n    </attr>\n");
}

// Roots have no edge that could say what enters there.
static vn_status write_node(const gxl_writer *writer, int32_t node) {
    bool root = vn_network_parent(writer->network)[node] < 0;
    VN_TRY(vn_sink_print(writer->sink, "  <node id=\"n%d\"", node));
    if (root && writer->flow != NULL) {
        VN_TRY(write_tag_number(writer, "flow", writer->flow[node]));
    }
    if (root && writer->has_radii) {
        VN_TRY(write_tag_number(writer, "radius", vn_network_radius(writer->network, node)));
    }
    if (writer->pressure != NULL) {
        VN_TRY(write_tag_number(writer, "pressure", writer->pressure[node]));
    }
    VN_TRY(vn_sink_print(writer->sink,
                         ">\n    <attr name=\" nodeType\">\n      <string> %s </string>\n    </attr>\n",
                         type_of(writer->network, node)));
    VN_TRY(write_position(writer, node));
    return vn_sink_text(writer->sink, "  </node>\n");
}

// The edge is called after the node that it leads to.
static vn_status write_edge(const gxl_writer *writer, int32_t node) {
    VN_TRY(vn_sink_print(writer->sink, "  <edge id=\"e%d\" to=\"n%d\" from=\"n%d\">\n", node, node,
                         vn_network_parent(writer->network)[node]));
    VN_TRY(writer->flow != NULL ? write_attr(writer, "flow", writer->flow[node]) : VN_OK);
    VN_TRY(writer->resistance.count > 0 ? write_attr(writer, "resistance", writer->resistance.data[node])
                                        : VN_OK);
    VN_TRY(writer->has_radii ? write_attr(writer, "radius", vn_network_radius(writer->network, node))
                             : VN_OK);
    return vn_sink_text(writer->sink, "  </edge>\n");
}

static vn_status write_join(const gxl_writer *writer, int32_t join) {
    int32_t a, b;
    double radius;
    vn_network_join_ends(writer->network, join, &a, &b, &radius);
    VN_TRY(vn_sink_print(writer->sink, "  <edge id=\"j%d\" to=\"n%d\" from=\"n%d\" join=\"true\">\n", join, b,
                         a));
    VN_TRY(write_attr(writer, "radius", radius));
    return vn_sink_text(writer->sink, "  </edge>\n");
}

static vn_status write_graph(const gxl_writer *writer) {
    const vn_network *network = writer->network;
    VN_TRY(vn_sink_text(writer->sink, "<gxl><graph id=\"network\" edgeids=\"true\" edgemode=\"directed\" "
                                      "hypergraph=\"false\""));
    VN_TRY(vn_sink_print(writer->sink, " dim=\"%d\"", vn_network_dim(network)));
    if (vn_network_unit(network)[0] != '\0') {
        VN_TRY(vn_sink_text(writer->sink, " unit=\""));
        VN_TRY(vn_xml_text(writer->sink, vn_network_unit(network)));
        VN_TRY(vn_sink_text(writer->sink, "\""));
    }
    VN_TRY(vn_sink_text(writer->sink, ">\n"));
    VN_TRY(write_info(writer));
    for (int32_t i = 0; i < vn_network_count(network); i++) {
        VN_TRY(write_node(writer, i));
    }
    for (int32_t i = 0; i < vn_network_count(network); i++) {
        VN_TRY(vn_network_parent(network)[i] >= 0 ? write_edge(writer, i) : VN_OK);
    }
    for (int32_t i = 0; i < vn_network_join_count(network); i++) {
        VN_TRY(write_join(writer, i));
    }
    return vn_sink_text(writer->sink, "</graph></gxl>\n");
}

static double positive(yajl_val value) {
    double number;
    const char *text = YAJL_IS_NUMBER(value) ? YAJL_GET_NUMBER(value) : "";
    vn_slice slice = {text, strlen(text)};
    return vn_slice_number(slice, &number) && number > 0 ? number : 0;
}

// Pa·s, of the manifest or of the parameters in it; 0 where it is not known.
static double viscosity_of(const char *manifest) {
    static const char *deep[] = {"parameters", "viscosity", NULL};
    static const char *flat[] = {"viscosity", NULL};
    char reason[2];
    yajl_val tree = manifest != NULL ? yajl_tree_parse(manifest, reason, sizeof reason) : NULL;
    if (tree == NULL) {
        return 0;
    }
    double found = positive(yajl_tree_get(tree, deep, yajl_t_number));
    found = found > 0 ? found : positive(yajl_tree_get(tree, flat, yajl_t_number));
    yajl_tree_free(tree);
    return found;
}

static double length_of(const vn_network *network, int32_t node) {
    double p[3], q[3];
    vn_network_position(network, node, p);
    vn_network_position(network, vn_network_parent(network)[node], q);
    return sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) +
                (p[2] - q[2]) * (p[2] - q[2]));
}

// OpenCCO's: R = 8 μ ℓ / π + 1 / Σ β⁴ / R_child, β a child's radius by this edge's; times r^-4 it is the
// resistance of all that the edge feeds.
static double reduced_resistance(const gxl_writer *writer, int32_t node, double viscosity) {
    const vn_network *network = writer->network;
    double own = 8 * viscosity * length_of(network, node) / acos(-1.0), conductance = 0;
    int32_t child = vn_network_first_child(network, node);
    if (child < 0) {
        return own;
    }
    for (; child >= 0; child = vn_network_next_child(network, child)) {
        double beta = vn_network_radius(network, child) / vn_network_radius(network, node);
        conductance += beta * beta * beta * beta / writer->resistance.data[child];
    }
    return own + 1 / conductance;
}

// Only of trees: what loops feed, no reduced resistance tells.
static vn_status find_resistances(gxl_writer *writer, const char *manifest) {
    const vn_network *network = writer->network;
    double viscosity = viscosity_of(manifest);
    if (viscosity == 0 || !writer->has_radii || vn_network_join_count(network) > 0) {
        return VN_OK;
    }
    // NOLINTNEXTLINE(clang-analyzer-core.NonNullParamChecker): cleared only where there is something
    VN_TRY(vn_array_zero(&writer->resistance, vn_network_count(network)));
    for (int32_t k = vn_network_count(network) - 1; k >= 0; k--) {
        int32_t node = vn_network_nth(network, k);
        if (vn_network_parent(network)[node] < 0) {
            continue;
        }
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): one of each node
        writer->resistance.data[node] = reduced_resistance(writer, node, viscosity);
        if (!(writer->resistance.data[node] <= VN_HUGE)) { // an edge without a radius lets nothing through
            vn_array_free(&writer->resistance);
            return VN_OK;
        }
    }
    return VN_OK;
}

vn_status vn_gxl_write(vn_sink *sink, const vn_networks_given *given) {
    gxl_writer writer = {.sink = sink, .network = given->networks[0]};
    writer.flow = vn_network_flow(writer.network);
    writer.pressure = vn_network_pressure(writer.network);
    writer.has_radii = vn_network_has_radii(writer.network);
    vn_status status = find_resistances(&writer, given->manifest);
    status = status == VN_OK ? vn_xml_manifest(sink, given->manifest) : status;
    status = status == VN_OK ? write_graph(&writer) : status;
    vn_array_free(&writer.resistance);
    return status;
}
