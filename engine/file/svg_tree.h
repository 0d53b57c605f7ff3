/// What an SVG file holds that can matter for outlines, kept in memory: `use` may point forwards.
#ifndef VN_FILE_SVG_TREE_H
#define VN_FILE_SVG_TREE_H

#include "base/text.h"

typedef enum vn_svg_kind {
    VN_SVG_OTHER, ///< draws nothing and contains nothing that does; kept for its id
    VN_SVG_ROOT,  ///< svg, at any depth
    VN_SVG_GROUP,
    VN_SVG_SWITCH,
    VN_SVG_USE,
    VN_SVG_SYMBOL,
    VN_SVG_DEFINITIONS, ///< not drawn itself, but `use` may point inside
    VN_SVG_PATH,
    VN_SVG_RECT,
    VN_SVG_CIRCLE,
    VN_SVG_ELLIPSE,
    VN_SVG_POLYGON,
    VN_SVG_POLYLINE,
    VN_SVG_LINE,
} vn_svg_kind;

typedef enum vn_svg_name {
    VN_SVG_ID,
    VN_SVG_CLASS,
    VN_SVG_STYLE,
    VN_SVG_TRANSFORM,
    VN_SVG_D,
    VN_SVG_POINTS,
    VN_SVG_X,
    VN_SVG_Y,
    VN_SVG_WIDTH,
    VN_SVG_HEIGHT,
    VN_SVG_RX,
    VN_SVG_RY,
    VN_SVG_CX,
    VN_SVG_CY,
    VN_SVG_R,
    VN_SVG_X1,
    VN_SVG_Y1,
    VN_SVG_X2,
    VN_SVG_Y2,
    VN_SVG_VIEW_BOX,
    VN_SVG_PRESERVE_ASPECT_RATIO,
    VN_SVG_HREF,
    VN_SVG_REQUIRED_EXTENSIONS,
    VN_SVG_FILL,
    VN_SVG_FILL_RULE,
    VN_SVG_FILL_OPACITY,
    VN_SVG_STROKE,
    VN_SVG_OPACITY,
    VN_SVG_DISPLAY,
    VN_SVG_VISIBILITY,
    VN_SVG_NAME_COUNT,
} vn_svg_name;

typedef struct vn_svg_element {
    vn_svg_kind kind;
    int32_t tag; ///< its name, in the text
    int32_t parent, first_child, last_child, next;
    int32_t first_attribute, attribute_count;
    int32_t line;
} vn_svg_element;

typedef struct vn_svg_attribute {
    vn_svg_name name;
    int32_t value; ///< in the text
} vn_svg_attribute;

typedef struct vn_svg_id {
    const char *id;
    int32_t element;
} vn_svg_id;

/// Element 0 is the outermost svg.
typedef struct vn_svg_tree {
    const char *path;
    VN_ARRAY(vn_svg_element) elements;
    VN_ARRAY(vn_svg_attribute) attributes;
    VN_ARRAY(vn_svg_id) ids; ///< sorted
    vn_text text;            ///< strings, each with its final zero byte
    vn_text css;             ///< the contents of all style elements
} vn_svg_tree;

/// Read a file; @p path is borrowed. VN_IO and VN_LIMIT come with the file's name and line. Also to be
/// freed on failure.
vn_status vn_svg_tree_read(vn_svg_tree *tree, const char *path);
void vn_svg_tree_free(vn_svg_tree *tree);

/// The value of an attribute, or NULL.
const char *vn_svg_value(const vn_svg_tree *tree, int32_t element, vn_svg_name name);
const char *vn_svg_tag(const vn_svg_tree *tree, int32_t element);
/// The first element with that id, or -1.
int32_t vn_svg_find(const vn_svg_tree *tree, const char *id);

#endif
