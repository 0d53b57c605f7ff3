// GXL as VascuSynth and OpenCCO write it, and as graph programs may: nodes and edges in any order, white
// space in names and values, information of whatever kind in between. What nodes say of their type is not
// believed: the edges tell.
#include "file/draft.h"
#include "file/names.h"
#include "file/xml.h"

#include <math.h>

enum { LONGEST_VALUE = 256 };

typedef enum gxl_item { NOTHING, A_NODE, AN_EDGE, THE_GRAPH } gxl_item;

typedef struct gxl_reader {
    vn_network_set *set;
    vn_draft draft;
    vn_names ids;
    VN_ARRAY(int32_t) node_of; // of each id; -1 while only edges spoke of it
    VN_ARRAY(int32_t) ids_of;  // of each node
    int depth;
    int graphs;
    bool undirected;
    gxl_item item;
    int item_depth;
    char attr[16]; // of the item, empty outside; those that matter are short
    int attr_depth;
    int32_t id;         // of the node
    vn_draft_edge edge; // between ids
    double position[3];
    int coordinates;
    double flow, radius, pressure; // of the node
    double root_pressure;
    int dim;
    char value[LONGEST_VALUE];
    size_t length;
} gxl_reader;

static vn_status number_of(gxl_reader *reader, vn_slice id, int32_t *number) {
    VN_TRY(vn_names_number(&reader->ids, id, number));
    return *number == reader->node_of.count ? vn_array_push(&reader->node_of, -1) : VN_OK;
}

static vn_status need(const vn_xml_tag *tag, const char *name, vn_slice *value) {
    return vn_xml_attribute(tag, name, value) ? VN_OK
                                              : vn_fail(VN_INVALID, "<%.20s> has no %s", tag->name, name);
}

// What ours say in the tag itself; unknown where it does not.
static vn_status tag_number(const vn_xml_tag *tag, const char *name, double *value) {
    vn_slice text;
    *value = NAN;
    if (!vn_xml_attribute(tag, name, &text) || vn_slice_number(text, value)) {
        return VN_OK;
    }
    return vn_fail(VN_INVALID, "%s = \"%.*s\" must be a number", name, VN_SLICE(text));
}

static vn_status begin_node(gxl_reader *reader, const vn_xml_tag *tag) {
    vn_slice id;
    VN_TRY(need(tag, "id", &id));
    VN_TRY(number_of(reader, id, &reader->id));
    if (reader->node_of.data[reader->id] >= 0) {
        return vn_fail(VN_INVALID, "node \"%.*s\" is given twice", VN_SLICE(id));
    }
    reader->coordinates = 0;
    VN_TRY(tag_number(tag, "flow", &reader->flow));
    VN_TRY(tag_number(tag, "radius", &reader->radius));
    return tag_number(tag, "pressure", &reader->pressure);
}

static vn_status begin_edge(gxl_reader *reader, const vn_xml_tag *tag) {
    vn_slice from, to, join;
    VN_TRY(need(tag, "from", &from));
    VN_TRY(need(tag, "to", &to));
    reader->edge = (vn_draft_edge){.radius = NAN, .flow = NAN};
    reader->edge.join = vn_xml_attribute(tag, "join", &join) && vn_slice_is(join, "true");
    VN_TRY(number_of(reader, from, &reader->edge.from));
    VN_TRY(number_of(reader, to, &reader->edge.to));
    if (reader->edge.from == reader->edge.to) {
        return vn_fail(VN_INVALID, "an edge leads from \"%.*s\" to itself; leave it out", VN_SLICE(from));
    }
    return VN_OK;
}

static vn_status begin_graph(gxl_reader *reader, const vn_xml_tag *tag) {
    vn_slice value;
    int32_t dim;
    if (++reader->graphs > 1) {
        return vn_fail(VN_INVALID, "a second <graph>; one is read from a file, so give each its own");
    }
    if (vn_xml_attribute(tag, "edgemode", &value)) {
        reader->undirected = vn_slice_is(value, "undirected") || vn_slice_is(value, "defaultundirected");
    }
    if (vn_xml_attribute(tag, "unit", &value)) {
        vn_draft_unit(&reader->draft, value);
    }
    if (vn_xml_attribute(tag, "dim", &value) && vn_slice_integer(value, &dim) && (dim == 2 || dim == 3)) {
        reader->draft.dim = dim;
    }
    return VN_OK;
}

static void begin_attr(gxl_reader *reader, const vn_xml_tag *tag) {
    vn_slice name;
    reader->attr_depth = reader->depth;
    if (vn_xml_attribute(tag, "name", &name) && name.length > 0 && name.length < sizeof reader->attr) {
        memcpy(reader->attr, name.text, name.length);
        reader->attr[name.length] = '\0';
    } else {
        strcpy(reader->attr, "?");
    }
}

static vn_status begin_item(gxl_reader *reader, const vn_xml_tag *tag) {
    if (strcmp(tag->name, "graph") == 0) {
        return begin_graph(reader, tag);
    }
    static const char *const names[] = {[A_NODE] = "node", [AN_EDGE] = "edge", [THE_GRAPH] = "info_graph"};
    for (gxl_item item = A_NODE; item <= THE_GRAPH; item++) {
        if (strcmp(tag->name, names[item]) == 0) {
            reader->item = item;
            reader->item_depth = reader->depth;
        }
    }
    if (reader->item == A_NODE) {
        return begin_node(reader, tag);
    }
    return reader->item == AN_EDGE ? begin_edge(reader, tag) : VN_OK;
}

static vn_status on_begin(void *context, const vn_xml_tag *tag) {
    gxl_reader *reader = context;
    reader->length = 0;
    if (reader->depth++ == 0) {
        bool known = strcmp(tag->name, "gxl") == 0 || strcmp(tag->name, "graph") == 0;
        if (!known) {
            return vn_fail(VN_INVALID, "its outermost element is <%.40s>, not <gxl>: this is no GXL file",
                           tag->name);
        }
    }
    if (reader->item == NOTHING) {
        return begin_item(reader, tag);
    }
    if (reader->attr[0] == '\0' && strcmp(tag->name, "attr") == 0) {
        begin_attr(reader, tag);
    }
    return VN_OK;
}

static bool matters(const gxl_reader *reader) {
    static const char *const names[] = {"position", "flow", "radius", "pPerf"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (strcmp(reader->attr, names[i]) == 0) {
            return true;
        }
    }
    return false;
}

static vn_status on_text(void *context, const char *bytes, size_t count) {
    gxl_reader *reader = context;
    if (!matters(reader)) {
        return VN_OK;
    }
    while (count > 0 && reader->length == 0 && vn_is_blank(*bytes)) {
        bytes++;
        count--;
    }
    if (count > sizeof reader->value - reader->length) {
        return vn_fail(VN_INVALID, "%s is longer than %d bytes, which is the limit", reader->attr,
                       LONGEST_VALUE);
    }
    memcpy(reader->value + reader->length, bytes, count);
    reader->length += count;
    return VN_OK;
}

static vn_status take_number(gxl_reader *reader, vn_slice text) {
    double value;
    if (!vn_slice_number(text, &value)) {
        return vn_fail(VN_INVALID, "%s = \"%.*s\" must be a number", reader->attr, VN_SLICE(text));
    }
    if (strcmp(reader->attr, "position") == 0 && reader->item == A_NODE) {
        if (reader->coordinates == 3) {
            return vn_fail(VN_INVALID, "a position has more than three coordinates");
        }
        reader->position[reader->coordinates++] = value;
    } else if (reader->item == AN_EDGE && strcmp(reader->attr, "flow") == 0) {
        reader->edge.flow = value;
    } else if (reader->item == AN_EDGE && strcmp(reader->attr, "radius") == 0) {
        reader->edge.radius = value;
    } else if (reader->item == THE_GRAPH && strcmp(reader->attr, "pPerf") == 0) {
        reader->root_pressure = value;
    }
    return VN_OK;
}

static vn_status end_node(gxl_reader *reader) {
    vn_slice id = vn_names_name(&reader->ids, reader->id);
    if (reader->coordinates < 2) {
        return vn_fail(VN_INVALID, "node \"%.*s\" has no position of two or three numbers", VN_SLICE(id));
    }
    int before = reader->dim;
    reader->dim = reader->coordinates;
    if (before != 0 && before != reader->dim) {
        return vn_fail(VN_INVALID, "node \"%.*s\" has %d coordinates, but those before it have %d",
                       VN_SLICE(id), reader->dim, before);
    }
    reader->position[2] = reader->dim == 3 ? reader->position[2] : 0;
    VN_TRY(vn_array_push(&reader->ids_of, reader->id));
    VN_TRY(vn_draft_node(&reader->draft, reader->position));
    int32_t node = reader->draft.x.count - 1;
    reader->node_of.data[reader->id] = node;
    reader->draft.flow.data[node] = reader->flow;
    reader->draft.radius.data[node] = reader->radius;
    reader->draft.pressure.data[node] = reader->pressure;
    return VN_OK;
}

static vn_status on_end(void *context, const char *name) {
    gxl_reader *reader = context;
    vn_slice text = vn_slice_trim((vn_slice){reader->value, reader->length});
    vn_status status = VN_OK;
    (void)name;
    if (text.length > 0) {
        status = take_number(reader, text);
    }
    reader->length = 0;
    if (reader->attr[0] != '\0' && reader->depth == reader->attr_depth) {
        reader->attr[0] = '\0';
    }
    if (status == VN_OK && reader->item != NOTHING && reader->depth == reader->item_depth) {
        status = reader->item == A_NODE ? end_node(reader) : VN_OK;
        status = reader->item == AN_EDGE ? vn_draft_edge_add(&reader->draft, &reader->edge) : status;
        reader->item = NOTHING;
    }
    reader->depth--;
    return status;
}

static vn_status on_comment(void *context, const char *text) {
    gxl_reader *reader = context;
    vn_slice manifest;
    if (!vn_xml_is_manifest(text, &manifest)) {
        return VN_OK;
    }
    return vn_network_set_manifest(reader->set, manifest.text, manifest.length);
}

// "n7" is node 7 when all ids are of that kind and none is left out; then the file's order does not matter.
static bool is_numbered(const gxl_reader *reader, int32_t *node_of) {
    int32_t count = reader->ids_of.count;
    for (int32_t i = 0; i < count; i++) {
        node_of[i] = -1;
    }
    for (int32_t i = 0; i < count; i++) {
        vn_slice id = vn_names_name(&reader->ids, reader->ids_of.data[i]);
        int32_t number = -1;
        bool good = id.length > 1 && id.text[0] == 'n' &&
                    vn_slice_integer((vn_slice){id.text + 1, id.length - 1}, &number) && number >= 0 &&
                    number < count && node_of[number] < 0;
        if (!good) {
            return false;
        }
        node_of[number] = i;
    }
    return true;
}

static void permute(vn_numbers *column, const int32_t *from, double *scratch) {
    for (int32_t i = 0; i < column->count; i++) {
        scratch[i] = column->data[from[i]];
    }
    if (column->count > 0) {
        memcpy(column->data, scratch, (size_t)column->count * sizeof *scratch);
    }
}

static void renumber(gxl_reader *reader, const int32_t *from, double *scratch) {
    vn_draft *draft = &reader->draft;
    vn_numbers *columns[] = {&draft->x, &draft->y, &draft->z, &draft->radius, &draft->flow, &draft->pressure};
    for (size_t i = 0; i < sizeof columns / sizeof *columns; i++) {
        permute(columns[i], from, scratch);
    }
    for (int32_t i = 0; i < draft->x.count; i++) {
        reader->node_of.data[reader->ids_of.data[from[i]]] = i;
    }
}

static vn_status order_by_number(gxl_reader *reader) {
    VN_ARRAY(int32_t) from = {0};
    vn_numbers scratch = {0};
    vn_status status = vn_array_reserve(&from, reader->ids_of.count);
    status = status == VN_OK ? vn_array_reserve(&scratch, reader->ids_of.count) : status;
    if (status == VN_OK && is_numbered(reader, from.data)) {
        renumber(reader, from.data, scratch.data);
    }
    vn_array_free(&from);
    vn_array_free(&scratch);
    return status;
}

static vn_status resolve(const gxl_reader *reader, int32_t *id, const char *leads) {
    int32_t node = reader->node_of.data[*id];
    if (node < 0) {
        vn_slice name = vn_names_name(&reader->ids, *id);
        return vn_fail(VN_INVALID, "an edge leads %s \"%.*s\", which is no node of the file", leads,
                       VN_SLICE(name));
    }
    *id = node;
    return VN_OK;
}

static void give_root_pressure(gxl_reader *reader) {
    vn_draft *draft = &reader->draft;
    for (int32_t i = 0; i < draft->x.count; i++) {
        if (draft->parent.data[i] < 0 && isnan(draft->pressure.data[i])) {
            draft->pressure.data[i] = reader->root_pressure;
        }
    }
}

// Of a node that has an edge, the edge says what it carries.
static void drop_own_values(vn_draft *draft) {
    for (int32_t i = 0; i < draft->edges.count; i++) {
        if (!draft->edges.data[i].join) {
            draft->radius.data[draft->edges.data[i].to] = NAN;
            draft->flow.data[draft->edges.data[i].to] = NAN;
        }
    }
}

static vn_status finish(gxl_reader *reader) {
    if (reader->graphs == 0) {
        return vn_fail(VN_INVALID, "holds no <graph>");
    }
    VN_TRY(order_by_number(reader));
    for (int32_t i = 0; i < reader->draft.edges.count; i++) {
        VN_TRY(resolve(reader, &reader->draft.edges.data[i].from, "from"));
        VN_TRY(resolve(reader, &reader->draft.edges.data[i].to, "to"));
    }
    reader->draft.dim = reader->dim != 0 ? reader->dim : reader->draft.dim;
    reader->draft.dim = reader->draft.dim != 0 ? reader->draft.dim : 2;
    drop_own_values(&reader->draft);
    VN_TRY(vn_draft_link(&reader->draft, !reader->undirected));
    give_root_pressure(reader);
    return vn_draft_finish(&reader->draft, reader->set);
}

vn_status vn_gxl_read(vn_network_set *set, const char *path, FILE *file) {
    static const vn_xml_handler handler = {on_begin, on_end, on_text, on_comment};
    gxl_reader reader = {.set = set, .root_pressure = NAN};
    vn_status status = vn_xml_read(path, file, &handler, &reader);
    status = status == VN_OK ? finish(&reader) : status;
    vn_draft_free(&reader.draft);
    vn_names_free(&reader.ids);
    vn_array_free(&reader.node_of);
    vn_array_free(&reader.ids_of);
    return status;
}
