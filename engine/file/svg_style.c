#include "file/svg_style.h"

#include <math.h>
#include <stdlib.h>

enum { MOST_RULES = 20000 };

static const double radians = 3.14159265358979323846 / 180;

static bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f';
}

static const char *skip_space(const char *at) {
    while (is_space(*at)) {
        at++;
    }
    return at;
}

const char *vn_svg_skip(const char *at) {
    at = skip_space(at);
    return *at == ',' ? skip_space(at + 1) : at;
}

const char *vn_svg_numbers(const char *at, int count, double *values) {
    for (int i = 0; i < count && at != NULL; i++) {
        at = i > 0 ? vn_svg_skip(at) : skip_space(at);
        at = vn_parse_number(at, at + strspn(at, "+-.0123456789eE"), &values[i]);
    }
    return at;
}

vn_svg_matrix vn_svg_identity(void) {
    return (vn_svg_matrix){1, 0, 0, 1, 0, 0};
}

vn_svg_matrix vn_svg_compose(const vn_svg_matrix *outer, const vn_svg_matrix *inner) {
    return (vn_svg_matrix){
        .a = outer->a * inner->a + outer->c * inner->b,
        .b = outer->b * inner->a + outer->d * inner->b,
        .c = outer->a * inner->c + outer->c * inner->d,
        .d = outer->b * inner->c + outer->d * inner->d,
        .e = outer->a * inner->e + outer->c * inner->f + outer->e,
        .f = outer->b * inner->e + outer->d * inner->f + outer->f,
    };
}

static vn_svg_matrix rotation(double degrees, double x, double y) {
    double c = cos(degrees * radians);
    double s = sin(degrees * radians);
    return (vn_svg_matrix){c, s, -s, c, x - c * x + s * y, y - s * x - c * y};
}

// One item of the list, from its name and arguments. False when their number is wrong.
static bool make_transform(const char *name, size_t length, const double *v, int count, vn_svg_matrix *out) {
    static const char *const names[] = {"matrix", "translate", "scale", "rotate", "skewX", "skewY"};
    int which = 0;
    while (which < 6 && (strlen(names[which]) != length || memcmp(names[which], name, length) != 0)) {
        which++;
    }
    bool one = count == 1;
    switch (which) {
    case 0:
        *out = (vn_svg_matrix){v[0], v[1], v[2], v[3], v[4], v[5]};
        return count == 6;
    case 1:
        *out = (vn_svg_matrix){1, 0, 0, 1, v[0], one ? 0 : v[1]};
        return one || count == 2;
    case 2:
        *out = (vn_svg_matrix){v[0], 0, 0, one ? v[0] : v[1], 0, 0};
        return one || count == 2;
    case 3:
        *out = rotation(v[0], one ? 0 : v[1], one ? 0 : v[2]);
        return one || count == 3;
    case 4:
        *out = (vn_svg_matrix){1, 0, tan(v[0] * radians), 1, 0, 0};
        return one;
    case 5:
        *out = (vn_svg_matrix){1, tan(v[0] * radians), 0, 1, 0, 0};
        return one;
    default:
        return false;
    }
}

// Up to six numbers and the closing parenthesis; NULL when there is something else.
static const char *read_arguments(const char *at, double *values, int *count) {
    *count = 0;
    for (at = skip_space(at); *at != ')'; at = vn_svg_skip(at)) {
        if (*count == 6) {
            return NULL;
        }
        at = vn_svg_numbers(at, 1, &values[*count]);
        if (at == NULL) {
            return NULL;
        }
        (*count)++;
    }
    return at + 1;
}

vn_svg_matrix vn_svg_transform(const char *text) {
    vn_svg_matrix all = vn_svg_identity();
    const char *at = text != NULL ? vn_svg_skip(text) : "";
    while (*at != '\0') {
        const char *name = at;
        size_t length = strspn(name, "abcdefghijklmnopqrstuvwxyzXY");
        at = skip_space(name + length);
        double values[6] = {0};
        int count;
        vn_svg_matrix one;
        at = *at == '(' ? read_arguments(at + 1, values, &count) : NULL;
        if (at == NULL || !make_transform(name, length, values, count, &one)) {
            return vn_svg_identity();
        }
        all = vn_svg_compose(&all, &one);
        at = vn_svg_skip(at);
    }
    return all;
}

static const struct {
    const char *name;
    double pixels;
    vn_svg_unit kind;
} length_units[] = {
    {"", 1, VN_SVG_USER},
    {"px", 1, VN_SVG_USER},
    {"em", 16, VN_SVG_USER}, // of the usual font size; a guess is all that can be had without the font
    {"rem", 16, VN_SVG_USER},
    {"ex", 8, VN_SVG_USER},
    {"%", 1, VN_SVG_PERCENT},
    {"mm", 96 / 25.4, VN_SVG_PHYSICAL},
    {"cm", 96 / 2.54, VN_SVG_PHYSICAL},
    {"Q", 96 / 101.6, VN_SVG_PHYSICAL},
    {"in", 96, VN_SVG_PHYSICAL},
    {"pt", 96.0 / 72, VN_SVG_PHYSICAL},
    {"pc", 16, VN_SVG_PHYSICAL},
};

vn_svg_unit vn_svg_length(const char *text, double *value) {
    double number;
    *value = 0;
    const char *at = text != NULL ? vn_svg_numbers(text, 1, &number) : NULL;
    if (at == NULL) {
        return VN_SVG_NO_LENGTH;
    }
    size_t length = 0;
    while (at[length] != '\0' && !is_space(at[length])) {
        length++;
    }
    for (size_t i = 0; i < sizeof length_units / sizeof *length_units; i++) {
        if (strlen(length_units[i].name) == length && memcmp(length_units[i].name, at, length) == 0) {
            *value = number * length_units[i].pixels;
            return length_units[i].kind;
        }
    }
    return VN_SVG_NO_LENGTH;
}

/// A value of a property and how strong the rule is that gave it; strength 0: none did.
typedef struct set_value {
    enum { VALUE_OFF, VALUE_ON, VALUE_INHERITED } value;
    int64_t strength;
} set_value;

typedef struct declarations {
    set_value set[VN_SVG_PROPERTY_COUNT];
} declarations;

/// `tag.key { declared }`; the key is ".class", "#id", a tag or "*".
struct vn_svg_rule {
    const char *key;
    const char *tag; ///< "" for any
    declarations declared;
};

static const struct {
    const char *name;
    vn_svg_name attribute;
    vn_svg_property property;
    bool inherited;
} properties[VN_SVG_PROPERTY_COUNT] = {
    {"fill", VN_SVG_FILL, VN_SVG_PAINTS_FILL, true},
    {"fill-rule", VN_SVG_FILL_RULE, VN_SVG_FILLS_EVEN_ODD, true},
    {"fill-opacity", VN_SVG_FILL_OPACITY, VN_SVG_FILL_SHOWS, true},
    {"stroke", VN_SVG_STROKE, VN_SVG_PAINTS_STROKE, true},
    {"visibility", VN_SVG_VISIBILITY, VN_SVG_SHOWS, true},
    {"opacity", VN_SVG_OPACITY, VN_SVG_IS_OPAQUE, false},
    {"display", VN_SVG_DISPLAY, VN_SVG_IS_IN_TREE, false},
};

// From the weakest to the strongest: a specificity lies between attribute and inline.
enum { STRENGTH_ATTRIBUTE = 1, STRENGTH_RULE = 2, STRENGTH_INLINE = 1000, STRENGTH_IMPORTANT = 2000 };
enum { RULE_ORDERS = 1 << 20 };

/// A piece of text that ends before `end`, without the white space around it.
typedef struct span {
    const char *begin, *end;
} span;

static span trimmed(const char *begin, const char *end) {
    while (begin < end && is_space(*begin)) {
        begin++;
    }
    while (end > begin && is_space(end[-1])) {
        end--;
    }
    return (span){begin, end};
}

static char lower(char c) {
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

static bool span_is(span s, const char *word) {
    while (s.begin < s.end && *word != '\0' && lower(*s.begin) == *word) {
        s.begin++;
        word++;
    }
    return s.begin == s.end && *word == '\0';
}

static bool is_zero(span value) {
    double number = 1;
    return vn_parse_number(value.begin, value.end, &number) != NULL && number <= 0;
}

static bool is_on(vn_svg_property property, span value) {
    switch (property) {
    case VN_SVG_PAINTS_FILL:
    case VN_SVG_PAINTS_STROKE:
        return !span_is(value, "none") && !span_is(value, "transparent");
    case VN_SVG_FILLS_EVEN_ODD:
        return span_is(value, "evenodd");
    case VN_SVG_SHOWS:
        return !span_is(value, "hidden") && !span_is(value, "collapse");
    case VN_SVG_IS_IN_TREE:
        return !span_is(value, "none");
    default:
        return !is_zero(value);
    }
}

// Later ones of equal strength win.
static void set_property(declarations *d, vn_svg_property property, span value, int64_t strength) {
    set_value *set = &d->set[property];
    if (value.begin == value.end || strength < set->strength) {
        return;
    }
    set->strength = strength;
    set->value =
        span_is(value, "inherit") ? VALUE_INHERITED : (is_on(property, value) ? VALUE_ON : VALUE_OFF);
}

static span cut_important(span value, int64_t *strength) {
    for (const char *at = value.begin; at < value.end; at++) {
        if (*at == '!') {
            *strength += (int64_t)STRENGTH_IMPORTANT * RULE_ORDERS;
            return trimmed(value.begin, at);
        }
    }
    return value;
}

static void read_declaration(declarations *d, const char *at, const char *end, int64_t strength) {
    const char *colon = memchr(at, ':', (size_t)(end - at));
    if (colon == NULL) {
        return;
    }
    span name = trimmed(at, colon);
    span value = cut_important(trimmed(colon + 1, end), &strength);
    for (int i = 0; i < VN_SVG_PROPERTY_COUNT; i++) {
        if (span_is(name, properties[i].name)) {
            set_property(d, properties[i].property, value, strength);
        }
    }
}

static void read_declarations(declarations *d, const char *at, const char *end, int64_t strength) {
    while (at < end) {
        const char *stop = memchr(at, ';', (size_t)(end - at));
        stop = stop != NULL ? stop : end;
        read_declaration(d, at, stop, strength);
        at = stop + 1;
    }
}

static bool is_name(span s) {
    for (const char *c = s.begin; c < s.end; c++) {
        bool letter = lower(*c) >= 'a' && lower(*c) <= 'z';
        bool other = (*c >= '0' && *c <= '9') || *c == '-' || *c == '_' || (unsigned char)*c >= 0x80;
        if (!letter && !other) {
            return false;
        }
    }
    return s.begin < s.end;
}

static int32_t store_name(vn_svg_sheet *sheet, span name, vn_status *status) {
    int32_t at = sheet->names.count;
    *status = vn_text_append(&sheet->names, name.begin, (size_t)(name.end - name.begin));
    if (*status == VN_OK) {
        *status = vn_text_append(&sheet->names, "", 1);
    }
    return at;
}

/// The style sheet while it is read: names move as they grow, so that rules get theirs at the end.
typedef struct sheet_reader {
    vn_svg_sheet *sheet;
    const char *path;
    VN_ARRAY(int32_t) keys;
    VN_ARRAY(int32_t) tags;
    vn_text css; ///< without comments
} sheet_reader;

static vn_status add_rule(sheet_reader *reader, span key, span tag, span block) {
    vn_svg_rule rule = {0};
    int32_t order = reader->sheet->rules.count;
    if (order >= MOST_RULES) {
        return vn_fail(VN_LIMIT, "%s: more than %d style rules: keep only the outline in the file",
                       reader->path, MOST_RULES);
    }
    int specificity = (*key.begin == '#' ? 100 : (*key.begin == '.' ? 10 : 1)) + (tag.begin < tag.end);
    specificity = *key.begin == '*' ? 0 : specificity;
    read_declarations(&rule.declared, block.begin, block.end,
                      (int64_t)(STRENGTH_RULE + specificity) * RULE_ORDERS + order);
    vn_status status;
    int32_t key_at = store_name(reader->sheet, key, &status);
    VN_TRY(status);
    int32_t tag_at = store_name(reader->sheet, tag, &status);
    VN_TRY(status);
    VN_TRY(vn_array_push(&reader->keys, key_at));
    VN_TRY(vn_array_push(&reader->tags, tag_at));
    return vn_array_push(&reader->sheet->rules, rule);
}

// `tag`, `*`, `.class`, `#id`, `tag.class` or `tag#id`; drawing programs write no others for shapes.
static vn_status read_selector(sheet_reader *reader, span selector, span block) {
    const char *mark = selector.begin;
    while (mark < selector.end && *mark != '.' && *mark != '#') {
        mark++;
    }
    span tag = {selector.begin, mark};
    span key = {mark, selector.end};
    bool any = span_is(tag, "*");
    if (tag.begin < tag.end && !any && !is_name(tag)) {
        return VN_OK;
    }
    if (mark == selector.end) {
        return tag.begin < tag.end ? add_rule(reader, tag, (span){mark, mark}, block) : VN_OK;
    }
    if (!is_name((span){mark + 1, selector.end})) {
        return VN_OK;
    }
    return add_rule(reader, key, any ? (span){mark, mark} : tag, block);
}

static vn_status read_selectors(sheet_reader *reader, const char *at, const char *end, span block) {
    while (at < end) {
        const char *stop = memchr(at, ',', (size_t)(end - at));
        stop = stop != NULL ? stop : end;
        VN_TRY(read_selector(reader, trimmed(at, stop), block));
        at = stop + 1;
    }
    return VN_OK;
}

static vn_status copy_without_comments(vn_text *out, const vn_text *css) {
    const char *at = css->data;
    const char *end = at + css->count;
    while (at < end) {
        const char *open = strstr(at, "/*");
        const char *stop = open != NULL ? open : end;
        VN_TRY(vn_text_append(out, at, (size_t)(stop - at)));
        const char *close = open != NULL ? strstr(open + 2, "*/") : NULL;
        at = close != NULL ? close + 2 : end;
    }
    return vn_text_append(out, "", 0);
}

// What follows the block that opens at @p at; blocks nest in @media.
static const char *skip_block(const char *at) {
    int depth = 0;
    do {
        depth += (*at == '{') - (*at == '}');
        at++;
    } while (depth > 0 && *at != '\0');
    return at;
}

// Rules for some media and imports are passed over.
static const char *skip_at_rule(const char *at) {
    at += strcspn(at, ";{");
    return *at == '{' ? skip_block(at) : (*at == ';' ? at + 1 : at);
}

static vn_status read_rules(sheet_reader *reader) {
    const char *at = skip_space(reader->css.data);
    while (*at != '\0') {
        if (*at == '@') {
            at = skip_space(skip_at_rule(at));
            continue;
        }
        const char *open = at + strcspn(at, "{");
        if (*open == '\0') {
            return VN_OK;
        }
        const char *close = open + strcspn(open, "}");
        VN_TRY(read_selectors(reader, at, open, (span){open + 1, close}));
        at = skip_space(*close != '\0' ? close + 1 : close);
    }
    return VN_OK;
}

static int compare_rules(const void *a, const void *b) {
    return strcmp(((const vn_svg_rule *)a)->key, ((const vn_svg_rule *)b)->key);
}

static void finish_rules(sheet_reader *reader) {
    vn_svg_sheet *sheet = reader->sheet;
    for (int32_t i = 0; i < sheet->rules.count; i++) {
        sheet->rules.data[i].key = sheet->names.data + reader->keys.data[i];
        sheet->rules.data[i].tag = sheet->names.data + reader->tags.data[i];
    }
    if (sheet->rules.count > 0) {
        qsort(sheet->rules.data, (size_t)sheet->rules.count, sizeof *sheet->rules.data, compare_rules);
    }
}

vn_status vn_svg_sheet_read(vn_svg_sheet *sheet, const vn_text *css, const char *path) {
    *sheet = (vn_svg_sheet){0};
    if (css->count == 0) {
        return VN_OK;
    }
    sheet_reader reader = {.sheet = sheet, .path = path};
    vn_status status = copy_without_comments(&reader.css, css);
    status = status == VN_OK ? read_rules(&reader) : status;
    if (status == VN_OK) {
        finish_rules(&reader);
    }
    vn_array_free(&reader.css);
    vn_array_free(&reader.keys);
    vn_array_free(&reader.tags);
    return status;
}

void vn_svg_sheet_free(vn_svg_sheet *sheet) {
    vn_array_free(&sheet->rules);
    vn_array_free(&sheet->names);
}

vn_svg_style vn_svg_style_default(void) {
    vn_svg_style style;
    for (int i = 0; i < VN_SVG_PROPERTY_COUNT; i++) {
        style.on[i] = i != VN_SVG_FILLS_EVEN_ODD && i != VN_SVG_PAINTS_STROKE;
    }
    return style;
}

static void take_stronger(declarations *d, const declarations *more) {
    for (int i = 0; i < VN_SVG_PROPERTY_COUNT; i++) {
        if (more->set[i].strength > d->set[i].strength) {
            d->set[i] = more->set[i];
        }
    }
}

// How the text [word, end) after @p mark compares with a rule's key.
static int compare_key(const char *key, char mark, span word) {
    if (mark != '\0') {
        if (*key != mark) {
            return (unsigned char)*key < (unsigned char)mark ? -1 : 1;
        }
        key++;
    }
    size_t length = (size_t)(word.end - word.begin);
    int order = strncmp(key, word.begin, length);
    return order != 0 ? order : key[length] != '\0';
}

static void apply_rules(declarations *d, const vn_svg_sheet *sheet, const char *tag, char mark, span word) {
    int32_t low = 0;
    int32_t high = sheet->rules.count;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (compare_key(sheet->rules.data[middle].key, mark, word) < 0) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    for (; low < sheet->rules.count && compare_key(sheet->rules.data[low].key, mark, word) == 0; low++) {
        const vn_svg_rule *rule = &sheet->rules.data[low];
        if (rule->tag[0] == '\0' || strcmp(rule->tag, tag) == 0) {
            take_stronger(d, &rule->declared);
        }
    }
}

static void apply_word(declarations *d, const vn_svg_sheet *sheet, const char *tag, char mark,
                       const char *word) {
    if (word != NULL && word[0] != '\0') {
        apply_rules(d, sheet, tag, mark, (span){word, word + strlen(word)});
    }
}

static void apply_sheet(declarations *d, const vn_svg_tree *tree, const vn_svg_sheet *sheet,
                        int32_t element) {
    const char *tag = vn_svg_tag(tree, element);
    apply_word(d, sheet, tag, '\0', "*");
    apply_word(d, sheet, tag, '\0', tag);
    apply_word(d, sheet, tag, '#', vn_svg_value(tree, element, VN_SVG_ID));
    const char *at = vn_svg_value(tree, element, VN_SVG_CLASS);
    while (at != NULL && *(at = skip_space(at)) != '\0') {
        const char *end = at + strcspn(at, " \t\r\n\f");
        apply_rules(d, sheet, tag, '.', (span){at, end});
        at = end;
    }
}

static declarations declarations_of(const vn_svg_tree *tree, const vn_svg_sheet *sheet, int32_t element) {
    declarations d = {0};
    for (int i = 0; i < VN_SVG_PROPERTY_COUNT; i++) {
        const char *value = vn_svg_value(tree, element, properties[i].attribute);
        if (value != NULL) {
            set_property(&d, properties[i].property, trimmed(value, value + strlen(value)),
                         STRENGTH_ATTRIBUTE);
        }
    }
    if (sheet->rules.count > 0) {
        apply_sheet(&d, tree, sheet, element);
    }
    const char *own = vn_svg_value(tree, element, VN_SVG_STYLE);
    if (own != NULL) {
        read_declarations(&d, own, own + strlen(own), (int64_t)STRENGTH_INLINE * RULE_ORDERS);
    }
    return d;
}

vn_svg_style vn_svg_style_of(const vn_svg_tree *tree, const vn_svg_sheet *sheet, int32_t element,
                             const vn_svg_style *parent) {
    declarations d = declarations_of(tree, sheet, element);
    vn_svg_style style = *parent;
    for (int i = 0; i < VN_SVG_PROPERTY_COUNT; i++) {
        const set_value *set = &d.set[i];
        if (set->strength > 0 && set->value != VALUE_INHERITED) {
            bool on = set->value == VALUE_ON;
            style.on[i] = on && (properties[i].inherited || parent->on[i]);
        }
    }
    return style;
}
