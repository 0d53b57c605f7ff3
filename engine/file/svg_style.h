/// Transforms, lengths, and those properties of an SVG element that decide whether and how it is filled.
#ifndef VN_FILE_SVG_STYLE_H
#define VN_FILE_SVG_STYLE_H

#include "file/svg_tree.h"

/// x' = a x + c y + e, y' = b x + d y + f.
typedef struct vn_svg_matrix {
    double a, b, c, d, e, f;
} vn_svg_matrix;

vn_svg_matrix vn_svg_identity(void);
/// First @p inner, then @p outer.
vn_svg_matrix vn_svg_compose(const vn_svg_matrix *outer, const vn_svg_matrix *inner);
/// The list of a transform attribute. Like browsers, nothing is transformed when it is malformed or NULL.
vn_svg_matrix vn_svg_transform(const char *text);

typedef enum vn_svg_unit {
    VN_SVG_NO_LENGTH, ///< absent, "auto" or malformed
    VN_SVG_USER,      ///< user units or pixels, and what depends on a font
    VN_SVG_PERCENT,
    VN_SVG_PHYSICAL, ///< mm, cm, in, pt, pc, Q
} vn_svg_unit;

/// Read a length: user units (96 to the inch) or a percentage go to @p value.
vn_svg_unit vn_svg_length(const char *text, double *value);

/// Skip white space and at most one comma.
const char *vn_svg_skip(const char *at);
/// Read @p count numbers; returns the first byte after them, or NULL. @p at may be NULL.
const char *vn_svg_numbers(const char *at, int count, double *values);

typedef enum vn_svg_property {
    VN_SVG_PAINTS_FILL,
    VN_SVG_FILLS_EVEN_ODD,
    VN_SVG_FILL_SHOWS, ///< fill-opacity is not 0
    VN_SVG_PAINTS_STROKE,
    VN_SVG_SHOWS,      ///< visibility
    VN_SVG_IS_OPAQUE,  ///< opacity is not 0; not inherited, but it hides all below
    VN_SVG_IS_IN_TREE, ///< display is not none; likewise
    VN_SVG_PROPERTY_COUNT,
} vn_svg_property;

/// What an element is drawn with: the value of each property.
typedef struct vn_svg_style {
    bool on[VN_SVG_PROPERTY_COUNT];
} vn_svg_style;

vn_svg_style vn_svg_style_default(void);

typedef struct vn_svg_rule vn_svg_rule;

/// The rules of all style elements.
typedef struct vn_svg_sheet {
    VN_ARRAY(vn_svg_rule) rules; ///< sorted by what they select
    vn_text names;
} vn_svg_sheet;

vn_status vn_svg_sheet_read(vn_svg_sheet *sheet, const vn_text *css, const char *path);
void vn_svg_sheet_free(vn_svg_sheet *sheet);

/// The style of an element below one of style @p parent.
vn_svg_style vn_svg_style_of(const vn_svg_tree *tree, const vn_svg_sheet *sheet, int32_t element,
                             const vn_svg_style *parent);

#endif
