#include "file/xml.h"

#include <errno.h>
#include <libxml/parser.h>
#include <libxml/xmlerror.h>

enum { CHUNK = 32768 };

static const char manifest_mark[] = " venule manifest ";

typedef struct xml_stream {
    const vn_xml_handler *handler;
    void *context;
    xmlParserCtxtPtr parser;
    vn_status status; // of the first call that failed
    bool broken;      // the first error of the XML itself
    bool ending;      // all of the file was fed
    int line;
    char error[200];
} xml_stream;

static void take(xml_stream *stream, vn_status status) {
    if (status == VN_OK || stream->status != VN_OK) {
        return;
    }
    stream->status = status;
    if (status == VN_INVALID) {
        char message[400];
        snprintf(message, sizeof message, "%s", vn_message());
        stream->status = vn_fail(status, "line %d: %s", xmlSAX2GetLineNumber(stream->parser), message);
    }
    xmlStopParser(stream->parser);
}

static bool is_over(const xml_stream *stream) {
    return stream->status != VN_OK || stream->broken;
}

static void on_begin(void *context, const xmlChar *name, const xmlChar *prefix, const xmlChar *space,
                     int spaces, const xmlChar **declared, int count, int defaulted,
                     const xmlChar **attributes) {
    (void)prefix, (void)space, (void)spaces, (void)declared, (void)defaulted;
    xml_stream *stream = context;
    vn_xml_tag tag = {(const char *)name, count, attributes};
    if (!is_over(stream)) {
        take(stream, stream->handler->begin(stream->context, &tag));
    }
}

static void on_end(void *context, const xmlChar *name, const xmlChar *prefix, const xmlChar *space) {
    (void)prefix, (void)space;
    xml_stream *stream = context;
    if (!is_over(stream)) {
        take(stream, stream->handler->end(stream->context, (const char *)name));
    }
}

static void on_text(void *context, const xmlChar *bytes, int count) {
    xml_stream *stream = context;
    if (!is_over(stream)) {
        take(stream, stream->handler->text(stream->context, (const char *)bytes, (size_t)count));
    }
}

static void on_comment(void *context, const xmlChar *text) {
    xml_stream *stream = context;
    if (!is_over(stream)) {
        take(stream, stream->handler->comment(stream->context, (const char *)text));
    }
}

// An entity that nobody declared is a mere warning where a document type is named: its text would be lost
// unseen.
static void on_error(void *context, xmlErrorPtr error) {
    xml_stream *stream = context;
    bool lost = error->code == XML_WAR_UNDECLARED_ENTITY || error->code == XML_ERR_UNDECLARED_ENTITY;
    if (is_over(stream) || (error->level < XML_ERR_ERROR && !lost)) {
        return;
    }
    stream->broken = true;
    stream->line = error->line;
    bool early = stream->ending && error->code == XML_ERR_DOCUMENT_END; // to libxml2, "extra content"
    const char *message = early ? "it ends too early" : error->message;
    snprintf(stream->error, sizeof stream->error, "%s", message != NULL ? message : "malformed");
    stream->error[strcspn(stream->error, "\r\n")] = '\0';
    xmlStopParser(stream->parser);
}

static vn_status state_of(const xml_stream *stream) {
    if (stream->status != VN_OK) {
        return stream->status;
    }
    return stream->broken ? vn_fail(VN_INVALID, "line %d: not XML: %s", stream->line, stream->error) : VN_OK;
}

static vn_status feed(xml_stream *stream, const char *path, FILE *file) {
    char chunk[CHUNK];
    size_t count, total = 0;
    while ((count = fread(chunk, 1, sizeof chunk, file)) > 0) {
        total += count;
        xmlParseChunk(stream->parser, chunk, (int)count, 0);
        VN_TRY(state_of(stream));
        VN_TRY(vn_poll());
    }
    if (ferror(file)) {
        return vn_fail(VN_IO, "%s: cannot be read: %s", path, strerror(errno));
    }
    if (total == 0) {
        return vn_fail(VN_INVALID, "the file is empty");
    }
    stream->ending = true;
    xmlParseChunk(stream->parser, chunk, 0, 1);
    return state_of(stream);
}

// No handler for entities: those that a file declares are unknown where it uses them.
vn_status vn_xml_read(const char *path, FILE *file, const vn_xml_handler *handler, void *context) {
    xml_stream stream = {.handler = handler, .context = context};
    xmlSAXHandler sax = {
        .initialized = XML_SAX2_MAGIC,
        .startElementNs = on_begin,
        .endElementNs = on_end,
        .characters = on_text,
        .ignorableWhitespace = on_text,
        .cdataBlock = on_text,
        .comment = on_comment,
        .serror = on_error,
    };
    xmlInitParser();
    stream.parser = xmlCreatePushParserCtxt(&sax, &stream, NULL, 0, NULL);
    if (stream.parser == NULL) {
        return vn_fail_memory("an XML reader", sizeof stream);
    }
    xmlCtxtUseOptions(stream.parser, XML_PARSE_NONET);
    vn_status status = feed(&stream, path, file);
    xmlFreeDoc(stream.parser->myDoc); // it keeps the entities that a file declares, even unasked
    xmlFreeParserCtxt(stream.parser);
    return status;
}

bool vn_xml_attribute(const vn_xml_tag *tag, const char *name, vn_slice *value) {
    for (int i = 0; i < tag->count; i++) {
        const unsigned char **attribute = tag->attributes + 5 * (size_t)i;
        if (strcmp((const char *)attribute[0], name) == 0) {
            size_t length = (size_t)(attribute[4] - attribute[3]);
            *value = vn_slice_trim((vn_slice){(const char *)attribute[3], length});
            return true;
        }
    }
    return false;
}

// How many bytes the character at @p at has that XML can hold; 0 for none.
static int xml_length(const char *at) {
    unsigned char byte = (unsigned char)*at;
    bool control = byte < 0x20 && !vn_is_blank(*at);
    bool none = strncmp(at, "\xEF\xBF\xBE", 3) == 0 || strncmp(at, "\xEF\xBF\xBF", 3) == 0;
    return control || none ? 0 : vn_utf8_length(at);
}

static vn_status write_character(vn_sink *sink, const char *at, int length) {
    switch (*at) {
    case '&':
        return vn_sink_text(sink, "&amp;");
    case '<':
        return vn_sink_text(sink, "&lt;");
    case '>':
        return vn_sink_text(sink, "&gt;");
    case '"':
        return vn_sink_text(sink, "&quot;");
    case '\t':
    case '\n':
    case '\r':
        return vn_sink_print(sink, "&#%d;", *at); // a space, between quotes
    default:
        return length > 0 ? vn_sink_write(sink, at, (size_t)length) : vn_sink_text(sink, "\xEF\xBF\xBD");
    }
}

vn_status vn_xml_text(vn_sink *sink, const char *text) {
    for (const char *at = text; *at != '\0';) {
        int length = xml_length(at);
        VN_TRY(write_character(sink, at, length));
        at += length > 0 ? length : 1;
    }
    return VN_OK;
}

// "--" ends a comment; in JSON it can only stand in a string, where a hyphen has another spelling.
vn_status vn_xml_manifest(vn_sink *sink, const char *manifest) {
    if (manifest == NULL) {
        return VN_OK;
    }
    VN_TRY(vn_sink_print(sink, "<!--%s", manifest_mark));
    for (const char *at = manifest; *at != '\0';) {
        int length = xml_length(at);
        bool second = at > manifest && at[0] == '-' && at[-1] == '-';
        VN_TRY(second ? vn_sink_text(sink, "\\u002d")
                      : (length > 0 ? vn_sink_write(sink, at, (size_t)length)
                                    : vn_sink_text(sink, "\xEF\xBF\xBD")));
        at += length > 0 ? length : 1;
    }
    return vn_sink_text(sink, " -->\n");
}

bool vn_xml_is_manifest(const char *comment, vn_slice *manifest) {
    size_t mark = strlen(manifest_mark);
    if (strncmp(comment, manifest_mark, mark) != 0) {
        return false;
    }
    *manifest = vn_slice_trim((vn_slice){comment + mark, strlen(comment + mark)});
    return true;
}
