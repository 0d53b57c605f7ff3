#include "file/svg_tree.h"

#include <errno.h>
#include <libxml/xmlreader.h>
#include <stdio.h>
#include <stdlib.h>

enum { LARGEST_FILE = 64 << 20, MOST_ELEMENTS = 1000000, BYTES_BETWEEN_POLLS = 1 << 20 };

static const char *const attribute_names[VN_SVG_NAME_COUNT] = {
    [VN_SVG_ID] = "id",
    [VN_SVG_CLASS] = "class",
    [VN_SVG_STYLE] = "style",
    [VN_SVG_TRANSFORM] = "transform",
    [VN_SVG_D] = "d",
    [VN_SVG_POINTS] = "points",
    [VN_SVG_X] = "x",
    [VN_SVG_Y] = "y",
    [VN_SVG_WIDTH] = "width",
    [VN_SVG_HEIGHT] = "height",
    [VN_SVG_RX] = "rx",
    [VN_SVG_RY] = "ry",
    [VN_SVG_CX] = "cx",
    [VN_SVG_CY] = "cy",
    [VN_SVG_R] = "r",
    [VN_SVG_X1] = "x1",
    [VN_SVG_Y1] = "y1",
    [VN_SVG_X2] = "x2",
    [VN_SVG_Y2] = "y2",
    [VN_SVG_VIEW_BOX] = "viewBox",
    [VN_SVG_PRESERVE_ASPECT_RATIO] = "preserveAspectRatio",
    [VN_SVG_HREF] = "href",
    [VN_SVG_REQUIRED_EXTENSIONS] = "requiredExtensions",
    [VN_SVG_FILL] = "fill",
    [VN_SVG_FILL_RULE] = "fill-rule",
    [VN_SVG_FILL_OPACITY] = "fill-opacity",
    [VN_SVG_STROKE] = "stroke",
    [VN_SVG_OPACITY] = "opacity",
    [VN_SVG_DISPLAY] = "display",
    [VN_SVG_VISIBILITY] = "visibility",
};

static const struct {
    const char *tag;
    vn_svg_kind kind;
} tag_kinds[] = {
    {"svg", VN_SVG_ROOT},
    {"g", VN_SVG_GROUP},
    {"a", VN_SVG_GROUP},
    {"switch", VN_SVG_SWITCH},
    {"use", VN_SVG_USE},
    {"symbol", VN_SVG_SYMBOL},
    {"defs", VN_SVG_DEFINITIONS},
    {"clipPath", VN_SVG_DEFINITIONS},
    {"mask", VN_SVG_DEFINITIONS},
    {"pattern", VN_SVG_DEFINITIONS},
    {"marker", VN_SVG_DEFINITIONS},
    {"path", VN_SVG_PATH},
    {"rect", VN_SVG_RECT},
    {"circle", VN_SVG_CIRCLE},
    {"ellipse", VN_SVG_ELLIPSE},
    {"polygon", VN_SVG_POLYGON},
    {"polyline", VN_SVG_POLYLINE},
    {"line", VN_SVG_LINE},
};

/// One reading of a file. libxml2 calls back with it.
typedef struct svg_source {
    vn_svg_tree *tree;
    FILE *file;
    xmlTextReaderPtr reader;
    int64_t bytes, polled;
    int read_error; ///< errno
    bool too_large;
    bool failed; ///< error and error_line are of the first one that ends the reading
    int error_line;
    char error[200];
    VN_ARRAY(int32_t) open; ///< the element at each depth; -1 where it is not kept
    bool in_style;
    int style_depth;
    bool svg_is_bare; ///< the outermost svg has no namespace
} svg_source;

static int read_bytes(void *context, char *buffer, int size) {
    svg_source *source = context;
    size_t got = fread(buffer, 1, (size_t)size, source->file);
    if (ferror(source->file)) {
        source->read_error = errno;
        return -1;
    }
    source->bytes += (int64_t)got;
    source->too_large = source->bytes > LARGEST_FILE;
    return source->too_large ? -1 : (int)got;
}

// One line, without the line feed that libxml2 ends it with.
static void keep_error(void *context, xmlErrorPtr error) {
    svg_source *source = context;
    if (source->failed || error == NULL || error->level < XML_ERR_FATAL || error->message == NULL) {
        return;
    }
    source->failed = true;
    source->error_line = error->line;
    snprintf(source->error, sizeof source->error, "%s", error->message);
    source->error[strcspn(source->error, "\r\n")] = '\0';
}

static vn_status store_text(vn_svg_tree *tree, const char *value, int32_t *at) {
    size_t size = strlen(value);
    *at = tree->text.count;
    VN_TRY(vn_text_append(&tree->text, value, size + 1));
    for (char *c = tree->text.data + *at; *c != '\0'; c++) {
        *c = (unsigned char)*c < ' ' ? ' ' : *c; // messages that quote it stay on one line
    }
    return VN_OK;
}

static int name_index(const char *name) {
    for (int i = 0; i < VN_SVG_NAME_COUNT; i++) {
        if (strcmp(attribute_names[i], name) == 0) {
            return i;
        }
    }
    return -1;
}

// Illustrator writes its namespaces as entities, which libxml2 leaves as they are there.
static const char *namespace_of(xmlTextReaderPtr reader) {
    const char *space = (const char *)xmlTextReaderConstNamespaceUri(reader);
    xmlNodePtr node = xmlTextReaderCurrentNode(reader);
    char name[64];
    if (space == NULL || space[0] != '&' || node == NULL || sscanf(space, "&%63[^;];", name) != 1) {
        return space;
    }
    xmlEntityPtr entity = xmlGetDocEntity(node->doc, (const xmlChar *)name);
    return entity != NULL && entity->content != NULL ? (const char *)entity->content : space;
}

static bool is_plain_attribute(xmlTextReaderPtr reader, const char *name) {
    const char *space = namespace_of(reader);
    bool link = space != NULL && strcmp(space, "http://www.w3.org/1999/xlink") == 0;
    return space == NULL || (link && strcmp(name, "href") == 0);
}

static vn_status store_attribute(svg_source *source, vn_svg_element *element) {
    vn_svg_tree *tree = source->tree;
    const char *name = (const char *)xmlTextReaderConstLocalName(source->reader);
    const char *value = (const char *)xmlTextReaderConstValue(source->reader);
    if (name == NULL || value == NULL || !is_plain_attribute(source->reader, name)) {
        return VN_OK;
    }
    int index = name_index(name);
    bool always = index == VN_SVG_ID || index == VN_SVG_REQUIRED_EXTENSIONS;
    if (index < 0 || (element->kind == VN_SVG_OTHER && !always)) {
        return VN_OK;
    }
    vn_svg_attribute attribute = {.name = (vn_svg_name)index};
    VN_TRY(store_text(tree, value, &attribute.value));
    VN_TRY(vn_array_push(&tree->attributes, attribute));
    element->attribute_count++;
    return VN_OK;
}

static vn_status store_attributes(svg_source *source, vn_svg_element *element) {
    element->first_attribute = source->tree->attributes.count;
    while (xmlTextReaderMoveToNextAttribute(source->reader) == 1) {
        VN_TRY(store_attribute(source, element));
    }
    xmlTextReaderMoveToElement(source->reader);
    return VN_OK;
}

static vn_svg_kind kind_of(const char *tag) {
    for (size_t i = 0; i < sizeof tag_kinds / sizeof *tag_kinds; i++) {
        if (strcmp(tag_kinds[i].tag, tag) == 0) {
            return tag_kinds[i].kind;
        }
    }
    return VN_SVG_OTHER;
}

static bool has_children(vn_svg_kind kind) {
    return kind >= VN_SVG_ROOT && kind <= VN_SVG_DEFINITIONS && kind != VN_SVG_USE;
}

static void hang_below(vn_svg_tree *tree, int32_t parent, int32_t child) {
    vn_svg_element *above = &tree->elements.data[parent];
    if (above->last_child >= 0) {
        tree->elements.data[above->last_child].next = child;
    } else {
        above->first_child = child;
    }
    above->last_child = child;
}

static vn_status add_element(svg_source *source, int32_t parent, const char *tag, int32_t *index) {
    vn_svg_tree *tree = source->tree;
    vn_svg_element element = {
        .kind = kind_of(tag), .parent = parent, .first_child = -1, .last_child = -1, .next = -1};
    element.line = xmlTextReaderGetParserLineNumber(source->reader);
    if (tree->elements.count >= MOST_ELEMENTS) {
        return vn_fail(VN_LIMIT, "%s: more than %d elements: keep only the outline in the file", tree->path,
                       MOST_ELEMENTS);
    }
    VN_TRY(store_text(tree, tag, &element.tag));
    VN_TRY(store_attributes(source, &element));
    *index = tree->elements.count;
    VN_TRY(vn_array_push(&tree->elements, element));
    if (parent >= 0) {
        hang_below(tree, parent, *index);
    }
    return VN_OK;
}

// Very old programs wrote no namespace; then everything without one is SVG. Prefixes of others keep theirs.
static bool is_svg_element(const svg_source *source) {
    const char *space = namespace_of(source->reader);
    return space == NULL ? source->svg_is_bare
                         : strstr(space, "/svg") != NULL || strstr(space, "/SVG") != NULL;
}

static vn_status check_root(svg_source *source, const char *tag) {
    source->svg_is_bare = namespace_of(source->reader) == NULL;
    if (strcmp(tag, "svg") == 0 && is_svg_element(source)) {
        return VN_OK;
    }
    return vn_fail(VN_IO, "%s: its outermost element is <%.40s>, not <svg>: this is no SVG file",
                   source->tree->path, tag);
}

static vn_status begin_element(svg_source *source) {
    int depth = xmlTextReaderDepth(source->reader);
    const char *tag = (const char *)xmlTextReaderConstLocalName(source->reader);
    int32_t index = -1;
    int32_t parent = depth > 0 && depth <= source->open.count ? source->open.data[depth - 1] : -1;
    if (depth == 0) {
        VN_TRY(check_root(source, tag));
    }
    if (!source->in_style && is_svg_element(source) && strcmp(tag, "style") == 0) {
        source->in_style = !xmlTextReaderIsEmptyElement(source->reader);
        source->style_depth = depth;
    } else if (is_svg_element(source) && (depth == 0 || parent >= 0)) {
        VN_TRY(add_element(source, parent, tag, &index));
        index = has_children(source->tree->elements.data[index].kind) ? index : -1;
    }
    source->open.count = depth < source->open.count ? depth : source->open.count;
    return vn_array_push(&source->open, index);
}

static vn_status append_css(svg_source *source) {
    const char *value = (const char *)xmlTextReaderConstValue(source->reader);
    if (!source->in_style || value == NULL) {
        return VN_OK;
    }
    return vn_text_append(&source->tree->css, value, strlen(value));
}

// Illustrator declares namespaces as entities; nobody honest declares entities made of entities.
static vn_status refuse_nested_entities(svg_source *source) {
    xmlNodePtr declarations = xmlTextReaderCurrentNode(source->reader);
    for (xmlNodePtr node = declarations != NULL ? declarations->children : NULL; node != NULL;
         node = node->next) {
        const xmlChar *content = node->type == XML_ENTITY_DECL ? ((xmlEntityPtr)node)->content : NULL;
        for (const xmlChar *at = xmlStrchr(content, '&'); at != NULL; at = xmlStrchr(at + 1, '&')) {
            if (at[1] != '#') {
                return vn_fail(VN_IO,
                               "%s: entity \"%.40s\" is made of other entities: save the file without them",
                               source->tree->path, (const char *)node->name);
            }
        }
    }
    return VN_OK;
}

static vn_status take_node(svg_source *source) {
    switch (xmlTextReaderNodeType(source->reader)) {
    case XML_READER_TYPE_ELEMENT:
        return begin_element(source);
    case XML_READER_TYPE_END_ELEMENT:
        source->in_style = source->in_style && xmlTextReaderDepth(source->reader) > source->style_depth;
        return VN_OK;
    case XML_READER_TYPE_TEXT:
    case XML_READER_TYPE_CDATA:
        return append_css(source);
    case XML_READER_TYPE_DOCUMENT_TYPE:
        return refuse_nested_entities(source);
    default:
        return VN_OK;
    }
}

static vn_status fail_reading(const svg_source *source) {
    const char *path = source->tree->path;
    if (source->too_large) {
        return vn_fail(VN_LIMIT, "%s: larger than %d MB: keep only the outline in the file", path,
                       LARGEST_FILE >> 20);
    }
    if (source->read_error != 0) {
        return vn_fail(VN_IO, "%s: cannot be read: %s", path, strerror(source->read_error));
    }
    if (source->bytes == 0) {
        return vn_fail(VN_IO, "%s: the file is empty", path);
    }
    return vn_fail(VN_IO, "%s: line %d: %s: save it again from the drawing program", path, source->error_line,
                   source->failed ? source->error : "malformed XML");
}

static vn_status take_all_nodes(svg_source *source) {
    int more;
    while ((more = xmlTextReaderRead(source->reader)) == 1) {
        VN_TRY(take_node(source));
        if (source->bytes - source->polled > BYTES_BETWEEN_POLLS) {
            source->polled = source->bytes;
            VN_TRY(vn_poll());
        }
    }
    bool bad = more < 0 || source->failed || source->too_large || source->read_error != 0;
    return bad || source->tree->elements.count == 0 ? fail_reading(source) : VN_OK;
}

static vn_status read_opened(svg_source *source) {
    int first = getc(source->file);
    if (first == 0x1F) {
        return vn_fail(VN_IO, "%s: is compressed (.svgz): unpack it with gunzip first", source->tree->path);
    }
    ungetc(first, source->file);
    xmlInitParser();
    source->reader = xmlReaderForIO(read_bytes, NULL, source, source->tree->path, NULL, XML_PARSE_NONET);
    if (source->reader == NULL) {
        return vn_fail(VN_NO_MEMORY, "%s: out of memory: no room for the XML reader", source->tree->path);
    }
    xmlTextReaderSetStructuredErrorHandler(source->reader, keep_error, source);
    vn_status status = take_all_nodes(source);
    xmlFreeTextReader(source->reader);
    return status;
}

static int compare_ids(const void *a, const void *b) {
    const vn_svg_id *one = a, *two = b;
    int order = strcmp(one->id, two->id);
    return order != 0 ? order : (one->element > two->element) - (one->element < two->element);
}

static vn_status sort_ids(vn_svg_tree *tree) {
    for (int32_t i = 0; i < tree->elements.count; i++) {
        vn_svg_id entry = {vn_svg_value(tree, i, VN_SVG_ID), i};
        if (entry.id != NULL && entry.id[0] != '\0') {
            VN_TRY(vn_array_push(&tree->ids, entry));
        }
    }
    if (tree->ids.count > 0) {
        qsort(tree->ids.data, (size_t)tree->ids.count, sizeof *tree->ids.data, compare_ids);
    }
    return VN_OK;
}

vn_status vn_svg_tree_read(vn_svg_tree *tree, const char *path) {
    *tree = (vn_svg_tree){.path = path};
    svg_source source = {.tree = tree, .file = fopen(path, "rb")};
    if (source.file == NULL) {
        return vn_fail(VN_IO, "%s: cannot be opened: %s", path, strerror(errno));
    }
    vn_status status = read_opened(&source);
    fclose(source.file);
    vn_array_free(&source.open);
    return status != VN_OK ? status : sort_ids(tree);
}

void vn_svg_tree_free(vn_svg_tree *tree) {
    vn_array_free(&tree->elements);
    vn_array_free(&tree->attributes);
    vn_array_free(&tree->ids);
    vn_array_free(&tree->text);
    vn_array_free(&tree->css);
}

const char *vn_svg_value(const vn_svg_tree *tree, int32_t element, vn_svg_name name) {
    const vn_svg_element *e = &tree->elements.data[element];
    for (int32_t i = e->first_attribute; i < e->first_attribute + e->attribute_count; i++) {
        if (tree->attributes.data[i].name == name) {
            return tree->text.data + tree->attributes.data[i].value;
        }
    }
    return NULL;
}

const char *vn_svg_tag(const vn_svg_tree *tree, int32_t element) {
    return tree->text.data + tree->elements.data[element].tag;
}

int32_t vn_svg_find(const vn_svg_tree *tree, const char *id) {
    int32_t low = 0;
    int32_t high = tree->ids.count;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (strcmp(tree->ids.data[middle].id, id) < 0) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    bool found = low < tree->ids.count && strcmp(tree->ids.data[low].id, id) == 0;
    return found ? tree->ids.data[low].element : -1;
}
