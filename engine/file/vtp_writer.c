// VTK's XML PolyData for ParaView, VMTK and VessMorphoVis: a polyline for each unbranched chain, from the
// root up, and for each join; numbers as text, so that they read back the same on any machine.
#include "file/format.h"
#include "file/xml.h"

// A point besides the nodes' own: where a vein that is thinner than what it leaves begins, or a join ends.
// Without it each lateral would be drawn as a cone.
typedef struct vtp_point {
    int32_t node; // where it is
    int32_t edge; // whose radius it has: that of this node, or of join -1 - edge
} vtp_point;

typedef struct vtp_writer {
    vn_sink *sink;
    const vn_network *network;
    int32_t chains, joins, lone; // lines, lines after them, roots without an edge
    VN_ARRAY(vtp_point) more;    // in the order of the lines
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

// The nodes' own points come first, each with the node's number.
static vtp_point point_at(const vtp_writer *writer, int32_t i) {
    int32_t nodes = vn_network_count(writer->network);
    // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): as many as point_count() says
    return i < nodes ? (vtp_point){i, i} : writer->more.data[i - nodes];
}

static int32_t point_count(const vtp_writer *writer) {
    return vn_network_count(writer->network) + writer->more.count;
}

static double radius_of(const vn_network *network, int32_t edge) {
    int32_t a, b;
    double radius;
    if (edge >= 0) {
        return vn_network_radius(network, edge);
    }
    vn_network_join_ends(network, -1 - edge, &a, &b, &radius);
    return radius;
}

typedef enum vtp_column { RADIUS, FLOW, PRESSURE, ORDER, TREE, BIRTH, NODE, COLUMNS } vtp_column;

static const struct {
    const char *name;
    const char *type;
} columns[COLUMNS] = {
    [RADIUS] = {"Radius", "Float64"}, [FLOW] = {"Flow", "Float64"}, [PRESSURE] = {"Pressure", "Float64"},
    [ORDER] = {"Order", "Int32"},     [TREE] = {"Tree", "Int32"},   [BIRTH] = {"Birth", "Int32"},
    [NODE] = {"Node", "Int32"},
};

static bool is_there(const vn_network *network, vtp_column column) {
    switch (column) {
    case RADIUS:
        return vn_network_has_radii(network);
    case FLOW:
        return vn_network_flow(network) != NULL;
    case PRESSURE:
        return vn_network_pressure(network) != NULL;
    case ORDER:
        return vn_network_orders(network) != NULL;
    default:
        return true;
    }
}

static vn_status write_value(const vtp_writer *writer, vtp_column column, vtp_point point) {
    const vn_network *network = writer->network;
    int32_t edge = point.edge >= 0 ? point.edge : point.node; // what flows through joins, nobody knows
    switch (column) {
    case RADIUS:
        return vn_sink_number(writer->sink, radius_of(network, point.edge));
    case FLOW:
        return vn_sink_number(writer->sink, vn_network_flow(network)[edge]);
    case PRESSURE:
        return vn_sink_number(writer->sink, vn_network_pressure(network)[point.node]);
    case ORDER:
        return vn_sink_integer(writer->sink, point.edge >= 0
                                                 ? vn_network_orders(network)[edge]
                                                 : vn_network_join_order(network, -1 - point.edge));
    case TREE:
        return vn_sink_integer(writer->sink, vn_network_tree(network)[point.node]);
    case BIRTH:
        return vn_sink_integer(writer->sink, vn_network_birth(network)[point.node]);
    default:
        return vn_sink_integer(writer->sink, point.node);
    }
}

static vn_status write_column(const vtp_writer *writer, vtp_column column) {
    VN_TRY(open_array(writer, columns[column].type, columns[column].name, ""));
    for (int32_t i = 0; i < point_count(writer); i++) {
        VN_TRY(write_value(writer, column, point_at(writer, i)));
        VN_TRY(vn_sink_text(writer->sink, "\n"));
    }
    return close_array(writer);
}

static vn_status write_point_data(const vtp_writer *writer) {
    bool radii = vn_network_has_radii(writer->network);
    VN_TRY(vn_sink_text(writer->sink, radii ? "<PointData Scalars=\"Radius\">\n" : "<PointData>\n"));
    for (vtp_column column = RADIUS; column < COLUMNS; column++) {
        VN_TRY(is_there(writer->network, column) ? write_column(writer, column) : VN_OK);
    }
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
        VN_TRY(vn_sink_number(writer->sink, i >= 0 ? radius_of(writer->network, -1 - i) : 0));
        VN_TRY(vn_sink_text(writer->sink, "\n"));
    }
    VN_TRY(close_array(writer));
    return vn_sink_text(writer->sink, "</CellData>\n");
}

static vn_status write_points(const vtp_writer *writer) {
    VN_TRY(vn_sink_text(writer->sink, "<Points>\n"));
    VN_TRY(open_array(writer, "Float64", "Points", " NumberOfComponents=\"3\""));
    for (int32_t i = 0; i < point_count(writer); i++) {
        double p[3];
        vn_network_position(writer->network, point_at(writer, i).node, p);
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

static bool differs(const vtp_writer *writer, int32_t node, int32_t edge) {
    return vn_network_has_radii(writer->network) &&
           radius_of(writer->network, edge) != vn_network_radius(writer->network, node);
}

// The point of a line's end at @p node: the next of those besides, where it needs one.
static vn_status write_end(const vtp_writer *writer, int32_t node, int32_t edge, int32_t *used) {
    int32_t own = vn_network_count(writer->network) + *used;
    bool needs = differs(writer, node, edge);
    *used += needs;
    return vn_sink_print(writer->sink, "%d ", needs ? own : node);
}

static vn_status write_chain(const vtp_writer *writer, int32_t node, int32_t *used) {
    const vn_network *network = writer->network;
    VN_TRY(write_end(writer, vn_network_parent(network)[node], node, used));
    VN_TRY(vn_sink_print(writer->sink, "%d", node));
    while (has_one_child(network, node)) {
        node = vn_network_first_child(network, node);
        VN_TRY(vn_sink_print(writer->sink, " %d", node));
    }
    return vn_sink_text(writer->sink, "\n");
}

static vn_status write_join(const vtp_writer *writer, int32_t join, int32_t *used) {
    int32_t a, b;
    double radius;
    vn_network_join_ends(writer->network, join, &a, &b, &radius);
    VN_TRY(write_end(writer, a, -1 - join, used));
    VN_TRY(write_end(writer, b, -1 - join, used));
    return vn_sink_text(writer->sink, "\n");
}

static vn_status add_end(vtp_writer *writer, int32_t node, int32_t edge) {
    vtp_point point = {node, edge};
    return differs(writer, node, edge) ? vn_array_push(&writer->more, point) : VN_OK;
}

// In the order in which write_connectivity() meets them.
static vn_status find_points(vtp_writer *writer) {
    const vn_network *network = writer->network;
    for (int32_t i = 0; i < vn_network_count(network); i++) {
        VN_TRY(begins_chain(network, i) ? add_end(writer, vn_network_parent(network)[i], i) : VN_OK);
    }
    for (int32_t i = 0; i < writer->joins; i++) {
        int32_t a, b;
        double radius;
        vn_network_join_ends(network, i, &a, &b, &radius);
        VN_TRY(add_end(writer, a, -1 - i));
        VN_TRY(add_end(writer, b, -1 - i));
    }
    return VN_OK;
}

static int64_t chain_length(const vn_network *network, int32_t node) {
    int64_t length = 2;
    for (; has_one_child(network, node); length++) {
        node = vn_network_first_child(network, node);
    }
    return length;
}

static vn_status write_connectivity(const vtp_writer *writer) {
    int32_t used = 0;
    VN_TRY(open_array(writer, "Int32", "connectivity", ""));
    for (int32_t i = 0; i < vn_network_count(writer->network); i++) {
        VN_TRY(begins_chain(writer->network, i) ? write_chain(writer, i, &used) : VN_OK);
    }
    for (int32_t i = 0; i < writer->joins; i++) {
        VN_TRY(write_join(writer, i, &used));
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

static vn_status write_file(const vtp_writer *writer, const char *manifest) {
    VN_TRY(vn_sink_text(writer->sink, "<?xml version=\"1.0\"?>\n"));
    VN_TRY(vn_xml_manifest(writer->sink, manifest));
    VN_TRY(vn_sink_text(writer->sink,
                        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
                        "header_type=\"UInt64\">\n<PolyData>\n"));
    VN_TRY(write_field_data(writer));
    VN_TRY(vn_sink_print(writer->sink,
                         "<Piece NumberOfPoints=\"%d\" NumberOfVerts=\"%d\" NumberOfLines=\"%d\" "
                         "NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n",
                         point_count(writer), writer->lone, writer->chains + writer->joins));
    VN_TRY(write_piece(writer));
    return vn_sink_text(writer->sink, "</Piece>\n</PolyData>\n</VTKFile>\n");
}

vn_status vn_vtp_write(vn_sink *sink, const vn_networks_given *given) {
    vtp_writer writer = {.sink = sink, .network = given->networks[0]};
    for (int32_t i = 0; i < vn_network_count(writer.network); i++) {
        writer.chains += begins_chain(writer.network, i);
        writer.lone += is_lone(writer.network, i);
    }
    writer.joins = vn_network_join_count(writer.network);
    vn_status status = find_points(&writer);
    status = status == VN_OK ? write_file(&writer, given->manifest) : status;
    vn_array_free(&writer.more);
    return status;
}
