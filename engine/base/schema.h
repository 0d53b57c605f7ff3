/// One row for each option field. From it come the range check, the strict Lua reader with its suggestions,
/// the editor stubs, the reference tables and the metadata in exported files.
#ifndef VN_BASE_SCHEMA_H
#define VN_BASE_SCHEMA_H

#include "base/status.h"

typedef enum vn_type {
    VN_F64,    ///< double
    VN_I32,    ///< int32_t
    VN_I64,    ///< int64_t
    VN_BOOL,   ///< bool
    VN_CHOICE, ///< int: the index of one of `choices`
    VN_POINT,  ///< double[3]; Lua gives {x, y} or {x, y, z}
    VN_TEXT,   ///< const char *, borrowed
    VN_OBJECT, ///< a pointer to an object of the class `kind`
    VN_MIXED,  ///< read by the binding itself; `kind` says in words what it may be
} vn_type;

enum {
    VN_REQUIRED = 1,  ///< must be given
    VN_ABOVE_MIN = 2, ///< the minimum itself is excluded
    VN_OPTIONAL = 4,  ///< the default means "not given" and need not lie within the range
};

typedef struct vn_field {
    const char *name;
    vn_type type;
    unsigned flags;
    size_t offset;
    double min, max;
    const char *unit; ///< "length", "1/length²", "degrees", "steps", "" …
    const char *kind; ///< VN_OBJECT: the class; VN_CHOICE: "any|all|tagged"; VN_MIXED: in words
    const char *doc;  ///< one line, no full stop
} vn_field;

/// All the options of one verb: `name` is what errors begin with ("throw", "marginal").
typedef struct vn_schema {
    const char *name;
    const char *doc;
    const vn_field *fields;
    int count;
    size_t size;          ///< of the def structure
    const void *defaults; ///< a def structure
} vn_schema;

/// The schema of a row table and of the def structure with its defaults; the rows are counted here and
/// nowhere else.
#define VN_SCHEMA(name, doc, fields, defaults)                                                               \
    { name, doc, fields, (int)(sizeof(fields) / sizeof((fields)[0])), sizeof(defaults), &(defaults) }

#define VN_HUGE 1e300

/// Check one number against its row: "throw.spacing = -1 must be above 0 length: …".
vn_status vn_check_number(const vn_schema *schema, const vn_field *field, double value);

/// Check every number of @p def. What is optional and still at its default passes.
vn_status vn_check_def(const vn_schema *schema, const void *def);

/// The row called @p name, or NULL.
const vn_field *vn_find_field(const vn_schema *schema, const char *name);

/// The number that @p def holds in a numeric row.
double vn_field_number(const vn_field *field, const void *def);

/// The index of @p word among "a|b|c", or -1.
int vn_choice_index(const char *choices, const char *word);

/// Which of @p count names is most like @p word, or NULL when none is like it. For "did you mean".
const char *vn_closest_name(const char *word, const char *const *names, int count);

#endif
