/// XML as a stream of tags and text: nothing of it is kept, entities are not expanded, nothing else is
/// opened.
#ifndef VN_FILE_XML_H
#define VN_FILE_XML_H

#include "base/sink.h"
#include "file/slice.h"

#include <stdio.h>

/// A begin tag, while it is being handled.
typedef struct vn_xml_tag {
    const char *name; ///< without its prefix
    int count;
    const unsigned char **attributes; ///< five a piece, as libxml2 gives them
} vn_xml_tag;

/// What is called, in the order of the file. VN_INVALID gets the line in front of its message.
typedef struct vn_xml_handler {
    vn_status (*begin)(void *context, const vn_xml_tag *tag);
    vn_status (*end)(void *context, const char *name);
    vn_status (*text)(void *context, const char *bytes, size_t count); ///< any piece of it; CDATA too
    vn_status (*comment)(void *context, const char *text);
} vn_xml_handler;

/// VN_INVALID for what is no XML: "line 3: …".
vn_status vn_xml_read(const char *path, FILE *file, const vn_xml_handler *handler, void *context);

/// The attribute's value without the white space around it; whether there is one.
bool vn_xml_attribute(const vn_xml_tag *tag, const char *name, vn_slice *value);

/// Write text for between tags or quotes; what XML cannot hold becomes U+FFFD.
vn_status vn_xml_text(vn_sink *sink, const char *text);
/// Write how a file was made as a comment; JSON that would end it early is written in other words.
vn_status vn_xml_manifest(vn_sink *sink, const char *manifest);
/// Whether a comment is of that kind; then what it says.
bool vn_xml_is_manifest(const char *comment, vn_slice *manifest);

#endif
