// VTK's XML PolyData for ParaView, VMTK and VessMorphoVis: a polyline for each unbranched chain, from the
// root up, and for each join; numbers as text, so that they read back the same on any machine.
#include "file/format.h"
#include "file/xml.h"

typedef struct vtp_writer {
    vn_sink *sink;
    const vn_network *network;
    int32_t chains, joins, lone; // lines, lines after them, roots without an edge
} vtp_writer;

static bool has_one_child(const vn_network *network, int32_t node) {
    int32_t child = vn_network_first_child(network, node);
    return child >= 0 && vn_network_next_child(network, child) < 0;
}

// A chain is called after its second node; its first is a root or a node where it branches off.
static bool begins_chain(const vn_network *network, int32_t node) {
    int32_t parent = vn_network_parent(network)[node];
    return parent >= 0 && (vn_network_parent(network)[parent] < 0 || !has_one_child(network, parent));
}

static bool is_lone(const vn_network *network, int32_t node) {
    return vn_network_parent(network)[node] < 0 && vn_network_first_child(network, node) < 0;
}

static vn_status open_array(const vtp_writer *writer, const char *type, const char *name, const char *more) {
    return vn_sink_print(writer->sink, "<DataArray type=\"%s\" Name=\"%s\"%s format=\"ascii\">\n", type, name,
                         more);
}

static vn_status close_array(const vtp_writer *writer) {
    return vn_sink_text(writer->sink, "</DataArray>\n");
}

static vn_status write_numbers(const vtp_writer *writer, const char *name, const double *values) {
    VN_TRY(open_array(writer, "Float64", name, ""));
    for (int32_t i = 0; i < vn_network_count(writer->network); i++) {
        VN_TRY(vn_sink_number(writer->sink, values[i]));
        VN_TRY(vn_sink_text(writer->sink, "\n"));
    }
    return close_array(writer);
}

static vn_status write_integers(const vtp_writer *writer, const char *name, const int32_t *values) {
    VN_TRY(open_array(writer, "Int32", name, ""));
    for (int32_t i = 0; i < vn_network_count(writer->network); i++) {
        VN_TRY(vn_sink_integer(writer->sink, values[i]));
        VN_TRY(vn_sink_text(writer->sink, "\n"));
    }
    return close_array(writer);
}

static vn_status write_radii(const vtp_writer *writer) {
    VN_TRY(open_array(writer, "Float64", "Radius", ""));
    for (int32_t i = 0; i < vn_network_count(writer->network); i++) {
        VN_TRY(vn_sink_number(writer->sink, vn_network_radius(writer->network, i)));
        VN_TRY(vn_sink_text(writer->sink, "\n"));
    }
    return close_array(writer);
}

static vn_status write_point_data(const vtp_writer *writer) {
    const vn_network *network = writer->network;
    const double *flow = vn_network_flow(network), *pressure = vn_network_pressure(network);
    VN_TRY(vn_sink_text(writer->sink, vn_network_has_radii(network) ? "<PointData Scalars=\"Radius\">\n"
                                                                    : "<PointData>\n"));
    VN_TRY(vn_network_has_radii(network) ? write_radii(writer) : VN_OK);
    VN_TRY(flow != NULL ? write_numbers(writer, "Flow", flow) : VN_OK);
    VN_TRY(pressure != NULL ? write_numbers(writer, "Pressure", pressure) : VN_OK);
    VN_TRY(vn_network_orders(network) != NULL ? write_integers(writer, "Order", vn_network_orders(network))
                                              : VN_OK);
    VN_TRY(write_integers(writer, "Tree", vn_network_tree(network)));
    VN_TRY(write_integers(writer, "Birth", vn_network_birth(network)));
    return vn_sink_text(writer->sink, "</PointData>\n");
}

// One entry a cell: the lone points come first, then the chains, then the joins.
static vn_status write_cell_data(const vtp_writer *writer) {
    int32_t others = writer->lone + writer->chains;
    if (writer->joins == 0) {
        return VN_OK;
    }
    VN_TRY(vn_sink_text(writer->sink, "<CellData>\n"));
    VN_TRY(open_array(writer, "Int32", "Join", ""));
    for (int32_t i = 0; i < others + writer->joins; i++) {
        VN_TRY(vn_sink_text(writer->sink, i < others ? "0\n" : "1\n"));
    }
    VN_TRY(close_array(writer));
    VN_TRY(open_array(writer, "Float64", "JoinRadius", ""));
    for (int32_t i = -others; i < writer->joins; i++) {
        int32_t a, b;
        double radius = 0;
        if (i >= 0) {
            vn_network_join_ends(writer->network, i, &a, &b, &radius);
        }
        VN_TRY(vn_sink_number(writer->sink, radius));
        VN_TRY(vn_sink_text(writer->sink, "\n"));
    }
    VN_TRY(close_array(writer));
    return vn_sink_text(writer->sink, "</CellData>\n");
}

static vn_status write_points(const vtp_writer *writer) {
    VN_TRY(vn_sink_text(writer->sink, "<Points>\n"));
    VN_TRY(open_array(writer, "Float64", "Points", " NumberOfComponents=\"3\""));
    for (int32_t i = 0; i < vn_network_count(writer->network); i++) {
        double p[3];
        vn_network_position(writer->network, i, p);
        for (int k = 0; k < 3; k++) {
            VN_TRY(vn_sink_number(writer->sink, p[k]));
            VN_TRY(vn_sink_text(writer->sink, k < 2 ? " " : "\n"));
        }
    }
    VN_TRY(close_array(writer));
    return vn_sink_text(writer->sink, "</Points>\n");
}

static vn_status write_verts(const vtp_writer *writer) {
    VN_TRY(vn_sink_text(writer->sink, "<Verts>\n"));
    VN_TRY(open_array(writer, "Int32", "connectivity", ""));
    for (int32_t i = 0; i < vn_network_count(writer->network); i++) {
        VN_TRY(is_lone(writer->network, i) ? vn_sink_print(writer->sink, "%d\n", i) : VN_OK);
    }
    VN_TRY(close_array(writer));
    VN_TRY(open_array(writer, "Int32", "offsets", ""));
    for (int32_t i = 0; i < writer->lone; i++) {
        VN_TRY(vn_sink_print(writer->sink, "%d\n", i + 1));
    }
    VN_TRY(close_array(writer));
    return vn_sink_text(writer->sink, "</Verts>\n");
}

static vn_status write_chain(const vtp_writer *writer, int32_t node) {
    const vn_network *network = writer->network;
    VN_TRY(vn_sink_print(writer->sink, "%d %d", vn_network_parent(network)[node], node));
    while (has_one_child(network, node)) {
        node = vn_network_first_child(network, node);
        VN_TRY(vn_sink_print(writer->sink, " %d", node));
    }
    return vn_sink_text(writer->sink, "\n");
}

static int64_t chain_length(const vn_network *network, int32_t node) {
    int64_t length = 2;
    for (; has_one_child(network, node); length++) {
        node = vn_network_first_child(network, node);
    }
    return length;
}

static vn_status write_connectivity(const vtp_writer *writer) {
    VN_TRY(open_array(writer, "Int32", "connectivity", ""));
    for (int32_t i = 0; i < vn_network_count(writer->network); i++) {
        VN_TRY(begins_chain(writer->network, i) ? write_chain(writer, i) : VN_OK);
    }
    for (int32_t i = 0; i < writer->joins; i++) {
        int32_t a, b;
        double radius;
        vn_network_join_ends(writer->network, i, &a, &b, &radius);
        VN_TRY(vn_sink_print(writer->sink, "%d %d\n", a, b));
    }
    return close_array(writer);
}

static vn_status write_lines(const vtp_writer *writer) {
    int64_t end = 0;
    VN_TRY(vn_sink_text(writer->sink, "<Lines>\n"));
    VN_TRY(write_connectivity(writer));
    VN_TRY(open_array(writer, "Int64", "offsets", ""));
    for (int32_t i = 0; i < vn_network_count(writer->network); i++) {
        if (begins_chain(writer->network, i)) {
            end += chain_length(writer->network, i);
            VN_TRY(vn_sink_integer(writer->sink, end));
            VN_TRY(vn_sink_text(writer->sink, "\n"));
        }
    }
    for (int32_t i = 0; i < writer->joins; i++) {
        end += 2;
        VN_TRY(vn_sink_integer(writer->sink, end));
        VN_TRY(vn_sink_text(writer->sink, "\n"));
    }
    VN_TRY(close_array(writer));
    return vn_sink_text(writer->sink, "</Lines>\n");
}

// VTK keeps text as the numbers of its bytes, each text ended by 0.
static vn_status write_field_data(const vtp_writer *writer) {
    VN_TRY(vn_sink_text(writer->sink, "<FieldData>\n"));
    VN_TRY(open_array(writer, "Int32", "dim", " NumberOfTuples=\"1\""));
    VN_TRY(vn_sink_print(writer->sink, "%d\n", vn_network_dim(writer->network)));
    VN_TRY(close_array(writer));
    if (vn_network_unit(writer->network)[0] != '\0') {
        VN_TRY(open_array(writer, "String", "unit", " NumberOfTuples=\"1\""));
        for (const char *at = vn_network_unit(writer->network); *at != '\0'; at++) {
            VN_TRY(vn_sink_print(writer->sink, "%d ", (unsigned char)*at));
        }
        VN_TRY(vn_sink_text(writer->sink, "0\n"));
        VN_TRY(close_array(writer));
    }
    return vn_sink_text(writer->sink, "</FieldData>\n");
}

static vn_status write_piece(const vtp_writer *writer) {
    VN_TRY(write_point_data(writer));
    VN_TRY(write_cell_data(writer));
    VN_TRY(write_points(writer));
    VN_TRY(write_verts(writer));
    return write_lines(writer);
}

vn_status vn_vtp_write(vn_sink *sink, const vn_networks_given *given) {
    vtp_writer writer = {.sink = sink, .network = given->networks[0]};
    for (int32_t i = 0; i < vn_network_count(writer.network); i++) {
        writer.chains += begins_chain(writer.network, i);
        writer.lone += is_lone(writer.network, i);
    }
    writer.joins = vn_network_join_count(writer.network);
    VN_TRY(vn_sink_text(sink, "<?xml version=\"1.0\"?>\n"));
    VN_TRY(vn_xml_manifest(sink, given->manifest));
    VN_TRY(vn_sink_text(sink, "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
                              "header_type=\"UInt64\">\n<PolyData>\n"));
    VN_TRY(write_field_data(&writer));
    VN_TRY(vn_sink_print(sink,
                         "<Piece NumberOfPoints=\"%d\" NumberOfVerts=\"%d\" NumberOfLines=\"%d\" "
                         "NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n",
                         vn_network_count(writer.network), writer.lone, writer.chains + writer.joins));
    VN_TRY(write_piece(&writer));
    return vn_sink_text(sink, "</Piece>\n</PolyData>\n</VTKFile>\n");
}
