// VTK's XML PolyData: of all it may hold, points, lines, and what is known at points. Lines may run either
// way; the files of some programs give each line points of its own, which are one where they are at the same
// place.
#include "file/names.h"
#include "file/vtp.h"
#include "file/xml.h"

#include <math.h>

typedef enum vtp_slot {
    POINTS,
    LINES,
    LINE_ENDS,
    VERTS,
    RADIUS,
    FLOW,
    PRESSURE,
    BIRTH,
    NODE,
    JOIN,
    JOIN_RADIUS,
    DIM,
    UNIT,
    SLOTS,
} vtp_slot;

static const struct {
    const char *section;
    const char *name;  // NULL: whatever it is called
    const char *other; // VMTK's
    int components;
} slots[SLOTS] = {
    [POINTS] = {"Points", NULL, NULL, 3},
    [LINES] = {"Lines", "connectivity", NULL, 1},
    [LINE_ENDS] = {"Lines", "offsets", NULL, 1},
    [VERTS] = {"Verts", "connectivity", NULL, 1},
    [RADIUS] = {"PointData", "Radius", "MaximumInscribedSphereRadius", 1},
    [FLOW] = {"PointData", "Flow", NULL, 1},
    [PRESSURE] = {"PointData", "Pressure", NULL, 1},
    [BIRTH] = {"PointData", "Birth", NULL, 1},
    [NODE] = {"PointData", "Node", NULL, 1},
    [JOIN] = {"CellData", "Join", NULL, 1},
    [JOIN_RADIUS] = {"CellData", "JoinRadius", NULL, 1},
    [DIM] = {"FieldData", "dim", NULL, 1},
    [UNIT] = {"FieldData", "unit", NULL, 1},
};

typedef struct vtp_reader {
    vn_network_set *set;
    vn_draft draft;
    vn_vtp_coding coding;
    vn_vtp_array arrays[SLOTS];
    bool seen[SLOTS];
    int64_t offsets[SLOTS]; // into what is appended; -1: the array is where it stands
    char section[24];
    int depth;
    int pieces;
    double points, verts; // announced
    int array_depth; // of the array around here, 0 outside; VTK puts keys and values of its own into arrays
    vtp_slot open;   // the array whose text comes now
    bool base64;     // which it is
    bool appended;   // the text is what all of these share
    vn_text tail;
    VN_ARRAY(int32_t) node_of; // of each point; -1: no line has it
    vn_sites places;
} vtp_reader;

static vn_status begin_file(vtp_reader *reader, const vn_xml_tag *tag) {
    vn_slice value;
    if (strcmp(tag->name, "VTKFile") != 0) {
        return vn_fail(VN_INVALID, "its outermost element is <%.40s>, not <VTKFile>: this is no VTP file",
                       tag->name);
    }
    if (!vn_xml_attribute(tag, "type", &value) || !vn_slice_is(value, "PolyData")) {
        return vn_fail(VN_INVALID, "holds no PolyData; save lines as PolyData (.vtp)");
    }
    reader->coding.big_endian =
        vn_xml_attribute(tag, "byte_order", &value) && vn_slice_is(value, "BigEndian");
    reader->coding.wide = vn_xml_attribute(tag, "header_type", &value) && vn_slice_is(value, "UInt64");
    if (vn_xml_attribute(tag, "compressor", &value) && value.length > 0) {
        reader->coding.packed = true;
        if (!vn_slice_is(value, "vtkZLibDataCompressor")) {
            return vn_fail(VN_INVALID, "is packed by %.*s; save it with ZLib or without compression",
                           VN_SLICE(value));
        }
    }
    return VN_OK;
}

static vn_status begin_piece(vtp_reader *reader, const vn_xml_tag *tag) {
    vn_slice value;
    if (++reader->pieces > 1) {
        return vn_fail(VN_INVALID, "has several pieces; merge them into one");
    }
    if (!vn_xml_attribute(tag, "NumberOfPoints", &value) || !vn_slice_number(value, &reader->points)) {
        return vn_fail(VN_INVALID, "the piece has no NumberOfPoints");
    }
    bool known = vn_xml_attribute(tag, "NumberOfVerts", &value) && vn_slice_number(value, &reader->verts);
    reader->verts = known ? reader->verts : 0;
    return VN_OK;
}

static vtp_slot find_slot(const vtp_reader *reader, vn_slice name) {
    for (vtp_slot i = 0; i < SLOTS; i++) {
        bool named = slots[i].name == NULL || vn_slice_is(name, slots[i].name) ||
                     (slots[i].other != NULL && vn_slice_is(name, slots[i].other));
        if (named && strcmp(reader->section, slots[i].section) == 0 && !reader->seen[i]) {
            return i;
        }
    }
    return SLOTS;
}

// Of an array that has not the components that are wanted nothing is taken.
static bool has_components(const vn_xml_tag *tag, int wanted) {
    vn_slice value;
    int32_t components = 1;
    if (vn_xml_attribute(tag, "NumberOfComponents", &value) && !vn_slice_integer(value, &components)) {
        return false;
    }
    return (components > 0 ? components : 1) == wanted;
}

static vn_status begin_array(vtp_reader *reader, const vn_xml_tag *tag) {
    reader->array_depth = reader->depth;
    vn_slice name = {"", 0}, value = {"", 0};
    double offset;
    vn_xml_attribute(tag, "Name", &name);
    vtp_slot slot = find_slot(reader, name);
    if (slot == SLOTS || !has_components(tag, slots[slot].components)) {
        return VN_OK;
    }
    vn_xml_attribute(tag, "type", &value);
    VN_TRY(vn_vtp_type(&reader->arrays[slot], value));
    bool formatted = vn_xml_attribute(tag, "format", &value);
    reader->seen[slot] = true;
    reader->offsets[slot] = -1;
    if (formatted && vn_slice_is(value, "appended")) {
        if (!vn_xml_attribute(tag, "offset", &value) || !vn_slice_number(value, &offset) || offset < 0 ||
            offset >= INT32_MAX) {
            return vn_fail(VN_INVALID, "array \"%.*s\" has no offset from 0 to %d", VN_SLICE(name),
                           INT32_MAX);
        }
        reader->offsets[slot] = (int64_t)offset;
        return VN_OK;
    }
    reader->open = slot;
    reader->base64 = formatted && vn_slice_is(value, "binary");
    return VN_OK;
}

static vn_status begin_appended(vtp_reader *reader, const vn_xml_tag *tag) {
    vn_slice value;
    if (!vn_xml_attribute(tag, "encoding", &value) || !vn_slice_is(value, "base64")) {
        return vn_fail(VN_INVALID,
                       "appends its data raw, which is no XML; save it as ASCII or with encoded data");
    }
    reader->appended = true;
    return VN_OK;
}

static vn_status on_begin(void *context, const vn_xml_tag *tag) {
    vtp_reader *reader = context;
    if (reader->depth++ == 0) {
        return begin_file(reader, tag);
    }
    if (reader->array_depth > 0) {
        return VN_OK;
    }
    if (strcmp(tag->name, "Piece") == 0) {
        return begin_piece(reader, tag);
    }
    if (strcmp(tag->name, "AppendedData") == 0) {
        return begin_appended(reader, tag);
    }
    if (strcmp(tag->name, "DataArray") == 0 || strcmp(tag->name, "Array") == 0) {
        return begin_array(reader, tag);
    }
    snprintf(reader->section, sizeof reader->section, "%s", tag->name);
    return VN_OK;
}

static vn_status on_text(void *context, const char *bytes, size_t count) {
    vtp_reader *reader = context;
    if (reader->appended) {
        return vn_text_append(&reader->tail, bytes, count);
    }
    if (reader->open == SLOTS || reader->depth != reader->array_depth) {
        return VN_OK;
    }
    vn_vtp_array *array = &reader->arrays[reader->open];
    return reader->base64 ? vn_vtp_take_base64(array, bytes, count) : vn_vtp_take_text(array, bytes, count);
}

static vn_status on_end(void *context, const char *name) {
    vtp_reader *reader = context;
    vtp_slot open = reader->open;
    bool ends = reader->depth == reader->array_depth;
    (void)name;
    reader->depth--;
    reader->appended = false;
    reader->array_depth = ends ? 0 : reader->array_depth;
    if (!ends || open == SLOTS) {
        return VN_OK;
    }
    reader->open = SLOTS;
    return reader->base64 ? vn_vtp_end_base64(&reader->arrays[open], &reader->coding)
                          : vn_vtp_end_text(&reader->arrays[open]);
}

static vn_status on_comment(void *context, const char *text) {
    vtp_reader *reader = context;
    vn_slice manifest;
    if (!vn_xml_is_manifest(text, &manifest)) {
        return VN_OK;
    }
    return vn_network_set_manifest(reader->set, manifest.text, manifest.length);
}

// An appended array reaches to where the next one begins.
static vn_status read_appended(vtp_reader *reader, vtp_slot slot, vn_slice tail) {
    int64_t begin = reader->offsets[slot], end = (int64_t)tail.length;
    if (begin > end) {
        return vn_fail(VN_INVALID, "an array begins at byte %lld of the %lld that are appended",
                       (long long)begin, (long long)end);
    }
    for (vtp_slot i = 0; i < SLOTS; i++) {
        if (reader->seen[i] && reader->offsets[i] > begin && reader->offsets[i] < end) {
            end = reader->offsets[i];
        }
    }
    VN_TRY(vn_vtp_take_base64(&reader->arrays[slot], tail.text + begin, (size_t)(end - begin)));
    return vn_vtp_end_base64(&reader->arrays[slot], &reader->coding);
}

static vn_status read_all_appended(vtp_reader *reader) {
    vn_slice tail = vn_slice_trim((vn_slice){reader->tail.data, (size_t)reader->tail.count});
    if (tail.length > 0 && tail.text[0] == '_') {
        tail.text++;
        tail.length--;
    }
    for (vtp_slot i = 0; i < SLOTS; i++) {
        if (reader->seen[i] && reader->offsets[i] >= 0) {
            VN_TRY(read_appended(reader, i, tail));
        }
    }
    return VN_OK;
}

static int32_t count_of(const vtp_reader *reader, vtp_slot slot) {
    return reader->arrays[slot].values.count;
}

static vn_status check_counts(const vtp_reader *reader) {
    int32_t points = count_of(reader, POINTS) / 3;
    if (reader->pieces == 0) {
        return vn_fail(VN_INVALID, "holds no <Piece>");
    }
    if (count_of(reader, POINTS) % 3 != 0 || reader->points != points) {
        return vn_fail(VN_INVALID, "says that it has %g points, but holds %d coordinates", reader->points,
                       count_of(reader, POINTS));
    }
    for (vtp_slot slot = RADIUS; slot <= NODE; slot++) {
        if (reader->seen[slot] && count_of(reader, slot) != points) {
            return vn_fail(VN_INVALID, "%s has %d entries, but there are %d points", slots[slot].name,
                           count_of(reader, slot), points);
        }
    }
    for (vtp_slot slot = JOIN; slot <= JOIN_RADIUS; slot++) {
        double cells = reader->verts + count_of(reader, LINE_ENDS);
        if (reader->seen[slot] && count_of(reader, slot) != cells) {
            return vn_fail(VN_INVALID, "%s has %d entries, but there are %g cells", slots[slot].name,
                           count_of(reader, slot), cells);
        }
    }
    return VN_OK;
}

static vn_status check_index(double value, int32_t count, int32_t *index) {
    if (!(value >= 0 && value < count) || value != floor(value)) {
        return vn_fail(VN_INVALID, "a line has point %g, but there are %d points, counted from 0", value,
                       count);
    }
    *index = (int32_t)value;
    return VN_OK;
}

// Whether some point belongs to two lines; then points that belong to one stay apart wherever they are.
static vn_status lines_share_points(vtp_reader *reader, bool *share) {
    int32_t points = count_of(reader, POINTS) / 3, line = 0;
    VN_TRY(vn_array_reserve(&reader->node_of, points));
    reader->node_of.count = points;
    for (int32_t i = 0; i < points; i++) {
        reader->node_of.data[i] = -1;
    }
    *share = false;
    for (int32_t i = 0; i < count_of(reader, LINES); i++) {
        int32_t point = 0;
        while (line < count_of(reader, LINE_ENDS) && reader->arrays[LINE_ENDS].values.data[line] <= i) {
            line++;
        }
        VN_TRY(check_index(reader->arrays[LINES].values.data[i], points, &point));
        *share = *share || (reader->node_of.data[point] >= 0 && reader->node_of.data[point] != line);
        reader->node_of.data[point] = line;
    }
    return VN_OK;
}

static double value_at(const vtp_reader *reader, vtp_slot slot, int32_t i) {
    return reader->seen[slot] && i < count_of(reader, slot) ? reader->arrays[slot].values.data[i] : NAN;
}

// Ours say which node a point belongs to: each node's own point comes before any other of it.
static vn_status named_node(const vtp_reader *reader, int32_t point, int32_t *node) {
    double value = value_at(reader, NODE, point);
    if (!(value >= 0 && value <= reader->draft.x.count) || value != floor(value)) {
        return vn_fail(VN_INVALID, "Node[%d] = %g must be from 0 to %d", point, value, reader->draft.x.count);
    }
    *node = (int32_t)value;
    return VN_OK;
}

// Nodes come in the order of the points; those that no line and no vertex has are left out.
static vn_status make_node(vtp_reader *reader, int32_t point, bool merge) {
    const double *p = reader->arrays[POINTS].values.data + 3 * (size_t)point;
    int32_t node = reader->draft.x.count;
    if (reader->seen[NODE]) {
        VN_TRY(named_node(reader, point, &node));
    } else if (merge) {
        VN_TRY(vn_sites_number(&reader->places, p, &node));
    }
    reader->node_of.data[point] = node;
    if (node < reader->draft.x.count) {
        return VN_OK;
    }
    VN_TRY(vn_draft_node(&reader->draft, p));
    reader->draft.pressure.data[node] = value_at(reader, PRESSURE, point);
    reader->draft.radius.data[node] = value_at(reader, RADIUS, point);
    reader->draft.flow.data[node] = value_at(reader, FLOW, point);
    double birth = value_at(reader, BIRTH, point);
    bool good = birth >= 0 && birth < INT32_MAX && birth == floor(birth);
    return reader->seen[BIRTH] ? vn_array_push(&reader->draft.birth, good ? (int32_t)birth : 0) : VN_OK;
}

static vn_status make_nodes(vtp_reader *reader) {
    int32_t points = count_of(reader, POINTS) / 3;
    bool share;
    VN_TRY(lines_share_points(reader, &share));
    for (int32_t i = 0; i < count_of(reader, VERTS); i++) {
        int32_t point = 0;
        VN_TRY(check_index(reader->arrays[VERTS].values.data[i], points, &point));
        reader->node_of.data[point] = 0;
    }
    bool merge = !share && count_of(reader, LINE_ENDS) > 1;
    reader->draft.overlaps = merge && !reader->seen[NODE]; // VMTK's lines run from the inlet to each outlet
    for (int32_t i = 0; i < points; i++) {
        bool wanted = reader->seen[NODE] || reader->node_of.data[i] >= 0;
        VN_TRY(wanted ? make_node(reader, i, merge) : VN_OK);
    }
    return VN_OK;
}

// A radius of a point is that of the edge before it.
static vn_status make_edges(vtp_reader *reader, int32_t line, int32_t begin, int32_t end) {
    int32_t cell = (int32_t)reader->verts + line;
    bool join = value_at(reader, JOIN, cell) == 1;
    for (int32_t i = begin + 1; i < end; i++) {
        int32_t point = (int32_t)reader->arrays[LINES].values.data[i];
        int32_t near = reader->node_of.data[(int32_t)reader->arrays[LINES].values.data[i - 1]];
        int32_t far = reader->node_of.data[point];
        vn_draft_edge edge = {near, far, value_at(reader, RADIUS, point), value_at(reader, FLOW, point),
                              join};
        edge.radius = join ? value_at(reader, JOIN_RADIUS, cell) : edge.radius;
        VN_TRY(near != far ? vn_draft_edge_add(&reader->draft, &edge) : VN_OK);
    }
    return VN_OK;
}

static vn_status make_lines(vtp_reader *reader) {
    int32_t begin = 0, count = count_of(reader, LINES);
    for (int32_t line = 0; line < count_of(reader, LINE_ENDS); line++) {
        double end = reader->arrays[LINE_ENDS].values.data[line];
        if (!(end >= begin && end <= count) || end != floor(end)) {
            return vn_fail(VN_INVALID, "line %d ends at %g, but must from %d to %d", line, end, begin, count);
        }
        VN_TRY(make_edges(reader, line, begin, (int32_t)end));
        begin = (int32_t)end;
    }
    return VN_OK;
}

static void read_unit(vtp_reader *reader) {
    char text[sizeof reader->draft.unit];
    size_t length = 0;
    for (int32_t i = 0; i < count_of(reader, UNIT) && length < sizeof text; i++) {
        double letter = reader->arrays[UNIT].values.data[i];
        if (!(letter >= 1 && letter <= 255)) {
            break;
        }
        text[length++] = (char)(unsigned char)letter;
    }
    vn_draft_unit(&reader->draft, (vn_slice){text, length});
}

static vn_status finish(vtp_reader *reader) {
    VN_TRY(read_all_appended(reader));
    double dim = value_at(reader, DIM, 0);
    VN_TRY(check_counts(reader));
    VN_TRY(make_nodes(reader));
    VN_TRY(make_lines(reader));
    read_unit(reader);
    reader->draft.dim = dim == 2 || dim == 3 ? (int)dim : 0;
    VN_TRY(vn_draft_link(&reader->draft, false));
    return vn_draft_finish(&reader->draft, reader->set);
}

vn_status vn_vtp_read(vn_network_set *set, const char *path, FILE *file) {
    static const vn_xml_handler handler = {on_begin, on_end, on_text, on_comment};
    vtp_reader reader = {.set = set, .open = SLOTS};
    vn_status status = vn_xml_read(path, file, &handler, &reader);
    status = status == VN_OK ? finish(&reader) : status;
    for (vtp_slot i = 0; i < SLOTS; i++) {
        vn_vtp_free(&reader.arrays[i]);
    }
    vn_draft_free(&reader.draft);
    vn_sites_free(&reader.places);
    vn_array_free(&reader.node_of);
    vn_array_free(&reader.tail);
    return status;
}
