#include "file/svg.h"

#include "domain/crossing.h"
#include "file/svg_shapes.h"

#include <math.h>
#include <stdio.h>

enum { MOST_SHAPES = 100000, MOST_VISITS = 1000000, MOST_NESTED_USES = 32, MOST_CROSSING_PAIRS = 64 };
enum { MOST_TOUCHES = 1000000 };

// Beyond this, areas would overflow.
#define LARGEST_SIZE 1e100

// Loops and overlaps of less than a thousandth of the size across come from rounding in drawing programs and
// from our own polylines; they are cleaned without a word.
static const double sloppiness = 1e-6;
static const double default_tolerance = 1e-4;

vn_svg_def vn_svg_def_default(void) {
    return (vn_svg_def){.id = NULL, .pick = 0, .tolerance = 0, .repair = false};
}

static const vn_svg_def svg_defaults = {.id = NULL, .pick = 0, .tolerance = 0, .repair = false};

static const vn_field svg_fields[] = {
    {"id", VN_TEXT, VN_OPTIONAL, offsetof(vn_svg_def, id), 0, 0, "", "",
     "id of the shape, or of a group of shapes, that is the outline; otherwise pick decides"},
    {"pick", VN_CHOICE, 0, offsetof(vn_svg_def, pick), 0, 1, "", "largest|all",
     "without an id: the filled shape of the largest area, or everything filled, united"},
    {"tolerance", VN_F64, 0, offsetof(vn_svg_def, tolerance), 0, VN_HUGE, "length", "",
     "curves become polylines that are within this of them; 0 for 1e-4 of the shape's size"},
    {"repair", VN_BOOL, 0, offsetof(vn_svg_def, repair), 0, 1, "", "",
     "accept outlines that cross themselves, and fill them as a painter would"},
};

const vn_schema vn_svg_schema =
    VN_SCHEMA("svg", "The outline of a shape in an SVG file", svg_fields, svg_defaults);

/// One shape as it was drawn: rings [first_ring, end_ring) of the reader.
typedef struct svg_outline {
    int32_t element;
    int32_t first_ring, end_ring;
    vn_fill rule;
    bool filled;
    double size, box_area, tolerance;
} svg_outline;

typedef struct svg_reader {
    const vn_svg_def *def;
    vn_paths *paths; ///< where lines go; NULL: outlines are read
    vn_svg_tree tree;
    vn_svg_sheet sheet;
    vn_rings rings;
    VN_ARRAY(svg_outline) outlines;
    VN_ARRAY(bool) open; ///< for each element, whether it is being walked
    int64_t visits;
    int32_t shapes;
    bool met, hidden; ///< the element that def->id names was drawn; it or what is in it was hidden
    bool broken;      ///< some path had no valid data: `complaint`
    char complaint[160];
} svg_reader;

/// What an element inherits.
typedef struct svg_state {
    vn_svg_matrix matrix;
    vn_svg_style style;
    vn_svg_viewport viewport;
    bool chosen; ///< in what def->id names
    int uses;
} svg_state;

// The message so far knows nothing of the file.
static vn_status name_file(const svg_reader *reader, vn_status status) {
    char message[400];
    snprintf(message, sizeof message, "%s", vn_message());
    return vn_fail(status, "%s: %s", reader->tree.path, message);
}

/// "path "blade"" or "the path in line 12".
static void describe(const svg_reader *reader, int32_t element, char *text, size_t size) {
    const char *id = vn_svg_value(&reader->tree, element, VN_SVG_ID);
    const char *tag = vn_svg_tag(&reader->tree, element);
    if (id != NULL && id[0] != '\0') {
        snprintf(text, size, "%s \"%.60s\"", tag, id);
    } else {
        snprintf(text, size, "the %s in line %d", tag, (int)reader->tree.elements.data[element].line);
    }
}

static void keep_complaint(svg_reader *reader, int32_t element) {
    char name[100];
    if (!reader->broken) {
        describe(reader, element, name, sizeof name);
        snprintf(reader->complaint, sizeof reader->complaint, "%s: %.56s", name, vn_message());
        reader->broken = true;
    }
}

static vn_status draw_outline(svg_reader *reader, int32_t element, const svg_state *state,
                              svg_outline *outline) {
    vn_svg_pen sketch = vn_svg_pen_make(&state->matrix, NULL, 1);
    vn_status status = vn_svg_draw_shape(&sketch, &reader->tree, element, &state->viewport);
    if (status == VN_INVALID) {
        keep_complaint(reader, element);
        return VN_OK;
    }
    VN_TRY(status);
    double width = sketch.max[0] - sketch.min[0];
    double height = sketch.max[1] - sketch.min[1];
    if (reader->paths != NULL ? !(fmax(width, height) > 0) : !(width > 0) || !(height > 0)) {
        return VN_OK;
    }
    outline->size = fmax(width, height);
    if (!(outline->size < LARGEST_SIZE)) {
        return vn_fail(VN_INVALID, "line %d: a shape larger than %g: scale it down in the drawing program",
                       (int)reader->tree.elements.data[element].line, LARGEST_SIZE);
    }
    outline->box_area = width * height;
    outline->tolerance =
        reader->def->tolerance > 0 ? reader->def->tolerance : default_tolerance * outline->size;
    vn_rings *rings = reader->paths == NULL ? &reader->rings : NULL;
    vn_svg_pen pen = vn_svg_pen_make(&state->matrix, rings, outline->tolerance);
    pen.paths = reader->paths;
    VN_TRY(vn_svg_draw_shape(&pen, &reader->tree, element, &state->viewport));
    return reader->paths != NULL ? vn_paths_lift(reader->paths) : VN_OK;
}

static vn_status take_shape(svg_reader *reader, int32_t element, const svg_state *state) {
    const bool *on = state->style.on;
    svg_outline outline = {
        .element = element,
        .first_ring = reader->rings.ends.count,
        .rule = on[VN_SVG_FILLS_EVEN_ODD] ? VN_FILL_EVEN_ODD : VN_FILL_NONZERO,
        .filled = on[VN_SVG_PAINTS_FILL] && on[VN_SVG_FILL_SHOWS],
    };
    bool wanted = reader->def->id != NULL ? state->chosen : outline.filled || on[VN_SVG_PAINTS_STROKE];
    if (!wanted || !on[VN_SVG_SHOWS]) {
        reader->hidden = reader->hidden || (state->chosen && !on[VN_SVG_SHOWS]);
        return VN_OK;
    }
    if (++reader->shapes > MOST_SHAPES) {
        return vn_fail(VN_LIMIT, "more than %d shapes: keep only the outline in the file", MOST_SHAPES);
    }
    VN_TRY(draw_outline(reader, element, state, &outline));
    outline.end_ring = reader->rings.ends.count;
    return outline.end_ring > outline.first_ring ? vn_array_push(&reader->outlines, outline) : VN_OK;
}

static vn_status walk(svg_reader *reader, int32_t element, int32_t use, const svg_state *above);

static vn_status walk_children(svg_reader *reader, int32_t element, const svg_state *state) {
    int32_t child = reader->tree.elements.data[element].first_child;
    for (; child >= 0; child = reader->tree.elements.data[child].next) {
        VN_TRY(walk(reader, child, -1, state));
    }
    return VN_OK;
}

// The first child that asks for no extension: Illustrator puts its private data before it.
static vn_status walk_switch(svg_reader *reader, int32_t element, const svg_state *state) {
    int32_t child = reader->tree.elements.data[element].first_child;
    while (child >= 0 && vn_svg_value(&reader->tree, child, VN_SVG_REQUIRED_EXTENSIONS) != NULL) {
        child = reader->tree.elements.data[child].next;
    }
    return child >= 0 ? walk(reader, child, -1, state) : VN_OK;
}

// What points outside the file, or nowhere, is not drawn.
static vn_status walk_use(svg_reader *reader, int32_t element, svg_state *state) {
    const char *link = vn_svg_value(&reader->tree, element, VN_SVG_HREF);
    int32_t target = link != NULL && link[0] == '#' ? vn_svg_find(&reader->tree, link + 1) : -1;
    if (target < 0) {
        return VN_OK;
    }
    if (reader->open.data[target] || state->uses >= MOST_NESTED_USES) {
        return vn_fail(VN_IO, "line %d: a <use> of \"%.60s\" %s: remove it in the drawing program",
                       (int)reader->tree.elements.data[element].line, link + 1,
                       reader->open.data[target] ? "contains itself" : "is nested too deeply");
    }
    vn_svg_matrix shift = vn_svg_identity();
    shift.e = vn_svg_measure(&reader->tree, element, VN_SVG_X, state->viewport.width, 0);
    shift.f = vn_svg_measure(&reader->tree, element, VN_SVG_Y, state->viewport.height, 0);
    state->matrix = vn_svg_compose(&state->matrix, &shift);
    state->uses++;
    return walk(reader, target, element, state);
}

static vn_status walk_viewport(svg_reader *reader, int32_t element, int32_t use, svg_state *state) {
    vn_svg_matrix inner = vn_svg_viewport_matrix(&reader->tree, element, use, &state->viewport);
    state->matrix = vn_svg_compose(&state->matrix, &inner);
    return walk_children(reader, element, state);
}

static vn_status walk_kind(svg_reader *reader, int32_t element, int32_t use, svg_state *state) {
    switch (reader->tree.elements.data[element].kind) {
    case VN_SVG_OTHER:
    case VN_SVG_DEFINITIONS:
        return VN_OK;
    case VN_SVG_ROOT:
        return element == 0 ? walk_children(reader, element, state)
                            : walk_viewport(reader, element, use, state);
    case VN_SVG_SYMBOL:
        return use >= 0 ? walk_viewport(reader, element, use, state) : VN_OK;
    case VN_SVG_GROUP:
        return walk_children(reader, element, state);
    case VN_SVG_SWITCH:
        return walk_switch(reader, element, state);
    case VN_SVG_USE:
        return walk_use(reader, element, state);
    default:
        return take_shape(reader, element, state);
    }
}

static void inherit(svg_reader *reader, int32_t element, svg_state *state) {
    const vn_svg_tree *tree = &reader->tree;
    const char *id = vn_svg_value(tree, element, VN_SVG_ID);
    vn_svg_matrix own = vn_svg_transform(vn_svg_value(tree, element, VN_SVG_TRANSFORM));
    state->matrix = vn_svg_compose(&state->matrix, &own);
    state->style = vn_svg_style_of(tree, &reader->sheet, element, &state->style);
    if (reader->def->id != NULL && id != NULL && strcmp(id, reader->def->id) == 0) {
        state->chosen = true;
        reader->met = true;
    }
}

// @p use is the element that points here, or -1.
static vn_status walk(svg_reader *reader, int32_t element, int32_t use, const svg_state *above) {
    if (++reader->visits > MOST_VISITS) {
        return vn_fail(VN_LIMIT, "draws more than %d elements: keep only the outline in the file",
                       MOST_VISITS);
    }
    if (reader->visits % 1024 == 0) {
        VN_TRY(vn_poll());
    }
    svg_state state = *above;
    inherit(reader, element, &state);
    if (!state.style.on[VN_SVG_IS_IN_TREE] || !state.style.on[VN_SVG_IS_OPAQUE]) {
        // What lies deeper is hidden too, and the id may be there: it is then known to the tree, but
        // never met.
        reader->hidden = reader->hidden || state.chosen;
        return VN_OK;
    }
    reader->open.data[element] = true;
    vn_status status = walk_kind(reader, element, use, &state);
    reader->open.data[element] = false;
    return status;
}

static vn_status copy_rings(vn_rings *out, const svg_reader *reader, const svg_outline *outline) {
    const vn_rings *all = &reader->rings;
    for (int32_t ring = outline->first_ring; ring < outline->end_ring; ring++) {
        for (int32_t i = vn_rings_begin(all, ring); i < all->ends.data[ring]; i++) {
            VN_TRY(vn_rings_point(out, all->x.data[i], all->y.data[i]));
        }
        VN_TRY(vn_rings_close(out));
    }
    return VN_OK;
}

static double signed_area(const vn_rings *rings) {
    double area = 0;
    for (int32_t ring = 0; ring < rings->ends.count; ring++) {
        area += vn_rings_area_of(rings, ring);
    }
    return area;
}

static vn_status painted_area(const vn_rings *rings, vn_fill rule, double *area) {
    vn_rings clean = {0};
    VN_TRY(vn_rings_resolve(&clean, rings, rule));
    *area = signed_area(&clean);
    vn_rings_free(&clean);
    return VN_OK;
}

/// Two rings that share points, or one that does so with itself.
typedef struct ring_pair {
    int32_t ring, other;
    double at[2];
} ring_pair;

typedef struct crossing_pairs {
    VN_ARRAY(ring_pair) pairs;
    int32_t touches; ///< of edges; past MOST_TOUCHES nobody need weigh them
    vn_status status;
} crossing_pairs;

static bool keep_pair(int32_t ring, int32_t other, const double at[2], void *payload) {
    crossing_pairs *found = payload;
    if (++found->touches > MOST_TOUCHES) {
        return false;
    }
    for (int32_t i = 0; i < found->pairs.count; i++) {
        if (found->pairs.data[i].ring == ring && found->pairs.data[i].other == other) {
            return true;
        }
    }
    ring_pair pair = {ring, other, {at[0], at[1]}};
    found->status = vn_array_push(&found->pairs, pair);
    return found->status == VN_OK && found->pairs.count < MOST_CROSSING_PAIRS;
}

static vn_status one_ring(vn_rings *out, const vn_rings *rings, int32_t ring) {
    for (int32_t i = vn_rings_begin(rings, ring); i < rings->ends.data[ring]; i++) {
        VN_TRY(vn_rings_point(out, rings->x.data[i], rings->y.data[i]));
    }
    return vn_rings_close(out);
}

// How much of the plane one ring winds around twice, or both ways. Without crossings both rules paint what
// the formula for the signed area says.
static vn_status area_of_loops(const vn_rings *ring, double *area) {
    double odd, nonzero;
    VN_TRY(painted_area(ring, VN_FILL_EVEN_ODD, &odd));
    VN_TRY(painted_area(ring, VN_FILL_NONZERO, &nonzero));
    *area = fabs(nonzero - odd) + fabs(nonzero - fabs(signed_area(ring)));
    return VN_OK;
}

// Two rings cross when each has a part of its own and both share one: the least of the three.
static vn_status area_of_overlap(const vn_rings *a, const vn_rings *b, double *area) {
    vn_rings shared = {0};
    VN_TRY(vn_rings_combine(&shared, a, b, VN_INTERSECTION));
    double both = signed_area(&shared);
    vn_rings_free(&shared);
    double in_a, in_b;
    VN_TRY(painted_area(a, VN_FILL_EVEN_ODD, &in_a));
    VN_TRY(painted_area(b, VN_FILL_EVEN_ODD, &in_b));
    *area = fmin(both, fmin(in_a, in_b) - both);
    return VN_OK;
}

static vn_status weigh_pair(const vn_rings *rings, const ring_pair *pair, double *area) {
    vn_rings a = {0}, b = {0};
    vn_status status = one_ring(&a, rings, pair->ring);
    if (status == VN_OK && pair->ring == pair->other) {
        status = area_of_loops(&a, area);
    } else if (status == VN_OK) {
        status = one_ring(&b, rings, pair->other);
        status = status == VN_OK ? area_of_overlap(&a, &b, area) : status;
    }
    vn_rings_free(&a);
    vn_rings_free(&b);
    return status;
}

static vn_status fail_crossing(const svg_reader *reader, const svg_outline *outline, const ring_pair *pair) {
    char name[100];
    describe(reader, outline->element, name, sizeof name);
    return vn_fail(
        VN_INVALID,
        "%s: %s crosses itself near (%.6g, %.6g): unite it in the drawing program, or give repair = true",
        reader->tree.path, name, pair->at[0], pair->at[1]);
}

static vn_status weigh_pairs(const svg_reader *reader, const svg_outline *outline, const vn_rings *rings,
                             const crossing_pairs *found) {
    double tolerance = outline->tolerance;
    double limit = sloppiness * outline->size * outline->size + 16 * tolerance * tolerance;
    for (int32_t i = 0; i < found->pairs.count; i++) {
        double area = 0;
        VN_TRY(vn_poll());
        if (found->touches > MOST_TOUCHES) {
            return fail_crossing(reader, outline, &found->pairs.data[i]);
        }
        VN_TRY(weigh_pair(rings, &found->pairs.data[i], &area));
        if (area > limit || i + 1 == MOST_CROSSING_PAIRS) {
            return fail_crossing(reader, outline, &found->pairs.data[i]);
        }
    }
    return VN_OK;
}

static vn_status check_crossings(const svg_reader *reader, const svg_outline *outline,
                                 const vn_rings *rings) {
    crossing_pairs found = {0};
    vn_status status = vn_rings_visit_crossings(rings, keep_pair, &found);
    status = status == VN_OK ? found.status : status;
    status = status == VN_OK ? weigh_pairs(reader, outline, rings, &found) : status;
    vn_array_free(&found.pairs);
    return status;
}

static vn_status append_resolved(vn_rings *out, const vn_rings *rings, vn_fill rule) {
    vn_rings clean = {0};
    VN_TRY(vn_rings_resolve(&clean, rings, rule));
    vn_status status = vn_rings_append(out, &clean);
    vn_rings_free(&clean);
    return status;
}

static vn_status add_outline(const svg_reader *reader, const svg_outline *outline, vn_rings *out) {
    vn_rings rings = {0};
    vn_status status = copy_rings(&rings, reader, outline);
    if (status == VN_OK && !reader->def->repair) {
        status = check_crossings(reader, outline, &rings);
    }
    status = status == VN_OK ? append_resolved(out, &rings, outline->rule) : status;
    vn_rings_free(&rings);
    return status;
}

static vn_status outline_area(const svg_reader *reader, const svg_outline *outline, double *area) {
    vn_rings rings = {0};
    vn_status status = copy_rings(&rings, reader, outline);
    status = status == VN_OK ? painted_area(&rings, outline->rule, area) : status;
    vn_rings_free(&rings);
    return status;
}

// A shape whose box is smaller than the best so far need not be measured.
static vn_status find_largest(const svg_reader *reader, bool filled, int32_t *best) {
    double largest = 0;
    *best = 0;
    if (reader->outlines.count == 1 && reader->outlines.data[0].filled == filled) {
        return VN_OK;
    }
    *best = -1;
    for (int32_t i = 0; i < reader->outlines.count; i++) {
        const svg_outline *outline = &reader->outlines.data[i];
        if (outline->filled != filled || !(outline->box_area > largest)) {
            continue;
        }
        double area = 0;
        VN_TRY(vn_poll());
        VN_TRY(outline_area(reader, outline, &area));
        if (area > largest) {
            largest = area;
            *best = i;
        }
    }
    return VN_OK;
}

static vn_status unite(vn_rings *out) {
    vn_rings united = {0};
    VN_TRY(vn_rings_resolve(&united, out, VN_FILL_NONZERO));
    vn_rings_free(out);
    *out = united;
    return VN_OK;
}

// Of everything when an id chose it, else of what is filled, or of mere lines where nothing is.
static vn_status take_all(const svg_reader *reader, bool everything, bool filled, vn_rings *out) {
    int32_t taken = 0;
    for (int32_t i = 0; i < reader->outlines.count; i++) {
        const svg_outline *outline = &reader->outlines.data[i];
        if (everything || outline->filled == filled) {
            VN_TRY(vn_poll());
            VN_TRY(add_outline(reader, outline, out));
            taken++;
        }
    }
    return taken > 1 ? unite(out) : VN_OK;
}

static vn_status take_largest(const svg_reader *reader, bool filled, vn_rings *out) {
    int32_t best;
    VN_TRY(find_largest(reader, filled, &best));
    return best >= 0 ? add_outline(reader, &reader->outlines.data[best], out) : VN_OK;
}

static vn_status take_picked(const svg_reader *reader, vn_rings *out) {
    for (int filled = 1; filled >= 0 && out->ends.count == 0; filled--) {
        VN_TRY(reader->def->pick == 0 ? take_largest(reader, filled, out)
                                      : take_all(reader, false, filled, out));
    }
    if (out->ends.count > 0) {
        return VN_OK;
    }
    if (reader->broken) {
        return vn_fail(VN_IO, "%s: it has no shape with an area; %s", reader->tree.path, reader->complaint);
    }
    return vn_fail(VN_IO, "%s: it has no shape with an area: draw a closed path and fill it",
                   reader->tree.path);
}

static vn_status suggest_ids(const svg_reader *reader, const char *const *names, int count) {
    const char *path = reader->tree.path;
    const char *id = reader->def->id;
    const char *closest = vn_closest_name(id, names, count);
    if (closest != NULL) {
        return vn_fail(VN_INVALID, "%s: nothing in it has the id \"%.60s\": did you mean \"%.60s\"?", path,
                       id, closest);
    }
    if (count == 0) {
        return vn_fail(VN_INVALID, "%s: nothing in it has an id: leave \"%.60s\" out and use pick", path, id);
    }
    return vn_fail(VN_INVALID, "%s: nothing in it has the id \"%.60s\": it has \"%.60s\"%s%.60s%s%s", path,
                   id, names[0], count > 1 ? ", \"" : "", count > 1 ? names[1] : "", count > 1 ? "\"" : "",
                   count > 2 ? " and more" : "");
}

static vn_status fail_unknown_id(const svg_reader *reader) {
    const vn_svg_tree *tree = &reader->tree;
    VN_ARRAY(const char *) names = {0};
    vn_status status = VN_OK;
    for (int32_t i = 0; i < tree->ids.count && status == VN_OK; i++) {
        bool drawable = tree->elements.data[tree->ids.data[i].element].kind != VN_SVG_OTHER;
        status = drawable ? vn_array_push(&names, tree->ids.data[i].id) : VN_OK;
    }
    status = status == VN_OK ? suggest_ids(reader, names.data, names.count) : status;
    vn_array_free(&names);
    return status;
}

// The id is known, but nothing came of it.
static vn_status fail_empty_id(const svg_reader *reader, int32_t element) {
    const char *path = reader->tree.path;
    const char *id = reader->def->id;
    if (reader->broken) {
        return vn_fail(VN_INVALID, "%s: %s: draw it again", path, reader->complaint);
    }
    if (reader->tree.elements.data[element].kind == VN_SVG_OTHER) {
        return vn_fail(VN_INVALID, "%s: \"%.60s\" is a <%.30s>, which has no outline: convert it to a path",
                       path, id, vn_svg_tag(&reader->tree, element));
    }
    if (reader->hidden) {
        return vn_fail(VN_INVALID,
                       "%s: \"%.60s\" is hidden: show it in the drawing program, or choose another id", path,
                       id);
    }
    if (!reader->met) {
        return vn_fail(VN_INVALID,
                       "%s: \"%.60s\" is not drawn: it is hidden, or a definition that nothing uses", path,
                       id);
    }
    return vn_fail(VN_INVALID, "%s: \"%.60s\" has no %s: name a %s, or a group of some", path, id,
                   reader->paths != NULL ? "length" : "area",
                   reader->paths != NULL ? "path" : "closed shape");
}

static vn_status take_named(const svg_reader *reader, vn_rings *out) {
    int32_t element = vn_svg_find(&reader->tree, reader->def->id);
    if (element < 0) {
        return fail_unknown_id(reader);
    }
    VN_TRY(take_all(reader, true, true, out));
    return out->ends.count > 0 ? VN_OK : fail_empty_id(reader, element);
}

static vn_status walk_page(svg_reader *reader, const char **unit) {
    svg_state state = {.style = vn_svg_style_default()};
    state.matrix = vn_svg_page_matrix(&reader->tree, &state.viewport, unit);
    VN_TRY(vn_svg_sheet_read(&reader->sheet, &reader->tree.css, reader->tree.path));
    VN_TRY(vn_array_zero(&reader->open, reader->tree.elements.count));
    vn_status status = walk(reader, 0, -1, &state);
    bool ours = status == VN_INVALID || status == VN_IO || status == VN_LIMIT;
    return ours ? name_file(reader, status) : status;
}

static vn_status take_lines(const svg_reader *reader) {
    int32_t element = reader->def->id != NULL ? vn_svg_find(&reader->tree, reader->def->id) : 0;
    if (element < 0) {
        return fail_unknown_id(reader);
    }
    if (reader->paths->ends.count > 0) {
        return VN_OK;
    }
    return reader->def->id != NULL
               ? fail_empty_id(reader, element)
               : vn_fail(VN_IO, "%s: it has no line: draw a path%s%s", reader->tree.path,
                         reader->broken ? "; " : "", reader->broken ? reader->complaint : "");
}

static vn_status read_file(svg_reader *reader, vn_rings *out, const char **unit, const char *path) {
    VN_TRY(vn_svg_tree_read(&reader->tree, path));
    VN_TRY(walk_page(reader, unit));
    return reader->def->id != NULL ? take_named(reader, out) : take_picked(reader, out);
}

static void free_reader(svg_reader *reader) {
    vn_svg_tree_free(&reader->tree);
    vn_svg_sheet_free(&reader->sheet);
    vn_rings_free(&reader->rings);
    vn_array_free(&reader->outlines);
    vn_array_free(&reader->open);
}

vn_status vn_svg_read_rings(vn_rings *out, const char **unit, const char *path, const vn_svg_def *def) {
    *out = (vn_rings){0};
    *unit = "";
    VN_TRY(vn_check_def(&vn_svg_schema, def));
    if (def->pick != 0 && def->pick != 1) {
        return vn_fail(VN_INVALID, "svg.pick = %d must be 0 (largest) or 1 (all)", def->pick);
    }
    svg_reader reader = {.def = def};
    vn_status status = read_file(&reader, out, unit, path);
    free_reader(&reader);
    if (status != VN_OK) {
        vn_rings_free(out);
    }
    return status;
}

vn_status vn_svg_read_lines(vn_paths *paths, const char *path, const vn_paths_def *def) {
    const vn_svg_def shapes = {.id = def->id, .tolerance = def->tolerance};
    const char *unit = "";
    svg_reader reader = {.def = &shapes, .paths = paths};
    vn_status status = vn_svg_tree_read(&reader.tree, path);
    status = status == VN_OK ? walk_page(&reader, &unit) : status;
    status = status == VN_OK ? take_lines(&reader) : status;
    strcpy(paths->unit, unit);
    free_reader(&reader);
    return status;
}

vn_status vn_domain_svg(vn_domain **out, const char *path, const vn_svg_def *def) {
    *out = NULL;
    vn_rings rings;
    const char *unit;
    VN_TRY(vn_svg_read_rings(&rings, &unit, path, def));
    return vn_domain_from_rings(out, &rings, unit);
}
