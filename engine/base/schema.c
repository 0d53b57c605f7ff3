#include "base/schema.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static void describe_limit(char *text, size_t size, const vn_field *field, double value) {
    const char *unit = field->unit;
    const char *space = unit[0] != '\0' ? " " : "";
    if (!(value <= field->max)) {
        snprintf(text, size, "at most %g%s%s", field->max, space, unit);
    } else if (field->flags & VN_ABOVE_MIN) {
        snprintf(text, size, "above %g%s%s", field->min, space, unit);
    } else {
        snprintf(text, size, "at least %g%s%s", field->min, space, unit);
    }
}

vn_status vn_check_number(const vn_schema *schema, const vn_field *field, double value) {
    bool low = field->flags & VN_ABOVE_MIN ? !(value > field->min) : !(value >= field->min);
    if (isnan(value)) {
        return vn_fail(VN_INVALID, "%s.%s is not a number (NaN): %s", schema->name, field->name, field->doc);
    }
    if (low || value > field->max) {
        char limit[96];
        describe_limit(limit, sizeof limit, field, value);
        return vn_fail(VN_INVALID, "%s.%s = %g must be %s: %s", schema->name, field->name, value, limit,
                       field->doc);
    }
    return VN_OK;
}

double vn_field_number(const vn_field *field, const void *def) {
    const char *slot = (const char *)def + field->offset;
    switch (field->type) {
    case VN_F64:
        return *(const double *)(const void *)slot;
    case VN_I32:
        return *(const int32_t *)(const void *)slot;
    case VN_I64:
        return (double)*(const int64_t *)(const void *)slot;
    default:
        return 0;
    }
}

static bool is_number(const vn_field *field) {
    return field->type == VN_F64 || field->type == VN_I32 || field->type == VN_I64;
}

vn_status vn_check_def(const vn_schema *schema, const void *def) {
    for (int i = 0; i < schema->count; i++) {
        const vn_field *field = &schema->fields[i];
        if (field->type == VN_OBJECT && (field->flags & VN_REQUIRED) &&
            *(void *const *)(const void *)((const char *)def + field->offset) == NULL) {
            return vn_fail(VN_INVALID, "%s: `%s` is missing: %s", schema->name, field->name, field->doc);
        }
        if (!is_number(field)) {
            continue;
        }
        double value = vn_field_number(field, def);
        bool absent = (field->flags & VN_OPTIONAL) && value == vn_field_number(field, schema->defaults);
        if (!absent) {
            VN_TRY(vn_check_number(schema, field, value));
        }
    }
    return VN_OK;
}

const vn_field *vn_find_field(const vn_schema *schema, const char *name) {
    for (int i = 0; i < schema->count; i++) {
        if (strcmp(schema->fields[i].name, name) == 0) {
            return &schema->fields[i];
        }
    }
    return NULL;
}

int vn_choice_index(const char *choices, const char *word) {
    size_t length = strlen(word);
    int index = 0;
    for (const char *at = choices; at != NULL; index++) {
        const char *end = strchr(at, '|');
        size_t size = end != NULL ? (size_t)(end - at) : strlen(at);
        if (size == length && memcmp(at, word, size) == 0) {
            return index;
        }
        at = end != NULL ? end + 1 : NULL;
    }
    return -1;
}

enum { LONGEST_NAME = 64 };

static int smallest(int a, int b, int c) {
    int least = a < b ? a : b;
    return least < c ? least : c;
}

// Levenshtein's distance, with a swap of neighbours counted once (names are mistyped so most often).
static int edit_distance(const char *a, const char *b) {
    int m = (int)strlen(a);
    int n = (int)strlen(b);
    if (m >= LONGEST_NAME || n >= LONGEST_NAME) {
        return INT_MAX;
    }
    int rows[3][LONGEST_NAME + 1];
    int *before = rows[0], *last = rows[1], *row = rows[2];
    for (int j = 0; j <= n; j++) {
        last[j] = j;
    }
    for (int i = 1; i <= m; i++) {
        row[0] = i;
        for (int j = 1; j <= n; j++) {
            row[j] = smallest(last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1]));
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] &&
                before[j - 2] + 1 < row[j]) {
                row[j] = before[j - 2] + 1;
            }
        }
        int *spare = before;
        before = last;
        last = row;
        row = spare;
    }
    return last[n];
}

const char *vn_closest_name(const char *word, const char *const *names, int count) {
    const char *best = NULL;
    int length = (int)strlen(word);
    int least = length < 2 ? 0 : (length < 6 ? 2 : length / 3 + 1); // a third may be wrong, and one in any
    for (int i = 0; i < count; i++) {
        int distance = edit_distance(word, names[i]);
        if (distance < least) {
            least = distance;
            best = names[i];
        }
    }
    return best;
}
