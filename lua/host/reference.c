// Writes lua/library/venule.lua (editor stubs) and docs/reference.md from the tables of the bindings, the
// schema rows and the rows of the systems written in Lua. A function without a sentence of documentation
// stops it.

#include "bind/bind.h"

#include <lualib.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct writer {
    FILE *stubs;
    FILE *page;
    int missing;
} writer;

static const char *lua_type_of(const vn_field *field) {
    static const char *const names[] = {"number",   "integer", "integer", "boolean", "string",
                                        "number[]", "string",  "",        "any"};
    return names[field->type];
}

static void capitalised(char *out, size_t size, const char *name) {
    snprintf(out, size, "venule.%c%s", name[0] - 'a' + 'A', name + 1);
}

static void type_of(char *out, size_t size, const vn_field *field) {
    if (field->type == VN_OBJECT) {
        capitalised(out, size, field->kind);
        if (strcmp(field->kind, "domain") == 0) {
            strncat(out, "|venule.Growth", size - strlen(out) - 1);
        }
    } else {
        snprintf(out, size, "%s", lua_type_of(field));
    }
}

static void choices_of(FILE *file, const vn_field *field) {
    for (const char *at = field->kind; at != NULL;) {
        const char *end = strchr(at, '|');
        int length = end != NULL ? (int)(end - at) : (int)strlen(at);
        fprintf(file, "%s\"%.*s\"", at > field->kind ? "|" : "", length, at);
        at = end != NULL ? end + 1 : NULL;
    }
}

static void default_of(char *out, size_t size, const vn_schema *schema, const vn_field *field) {
    const char *slot = (const char *)schema->defaults + field->offset;
    out[0] = '\0';
    if ((field->flags & (VN_REQUIRED | VN_OPTIONAL)) != 0) {
        return;
    }
    if (field->type == VN_F64 || field->type == VN_I32 || field->type == VN_I64) {
        snprintf(out, size, "%g", vn_field_number(field, schema->defaults));
    } else if (field->type == VN_BOOL) {
        snprintf(out, size, "%s", *(const bool *)slot ? "true" : "false");
    } else if (field->type == VN_TEXT) {
        const char *text = *(const char *const *)(const void *)slot;
        snprintf(out, size, "\"%s\"", text != NULL ? text : "");
    } else if (field->type == VN_CHOICE) {
        size_t length = strcspn(field->kind, "|"); // every default is the first choice
        snprintf(out, size, "\"%.*s\"", (int)length, field->kind);
    }
}

static void range_of(char *out, size_t size, const vn_field *field) {
    bool numeric = field->type == VN_F64 || field->type == VN_I32 || field->type == VN_I64;
    bool open = field->max >= 1e9;
    out[0] = '\0';
    if (!numeric) {
        return;
    }
    if (field->flags & VN_ABOVE_MIN) {
        snprintf(out, size, open ? "above %g" : "above %g, to %g", field->min, field->max);
    } else if (field->min > -1e9) {
        snprintf(out, size, open ? "%g or more" : "%g to %g", field->min, field->max);
    }
}

static void write_field(writer *w, const vn_schema *schema, const vn_field *field) {
    char type[96], value[96], range[96];
    bool required = field->flags & VN_REQUIRED;
    type_of(type, sizeof type, field);
    default_of(value, sizeof value, schema, field);
    range_of(range, sizeof range, field);
    fprintf(w->stubs, "---@field %s%s ", field->name, required ? "" : "?");
    fprintf(w->page, "| `%s` | ", field->name);
    if (field->type == VN_CHOICE) {
        choices_of(w->stubs, field);
        fprintf(w->page, "`%s`", field->kind);
    } else {
        fputs(type, w->stubs);
        fputs(field->type == VN_MIXED ? field->kind : type, w->page);
    }
    fprintf(w->stubs, " # %s%s%s%s%s%s\n", field->doc, field->unit[0] ? ", " : "", field->unit,
            value[0] ? " (default " : "", value, value[0] ? ")" : "");
    fprintf(w->page, " | %s | %s | %s | %s |\n", required ? "required" : value, range, field->unit,
            field->doc);
}

static void write_options(writer *w, const vn_schema *schema) {
    fprintf(w->stubs, "---@class (exact) venule.%s.Options\n", schema->name);
    fprintf(w->page, "\n| option | type | default | range | unit | |\n|---|---|---|---|---|---|\n");
    for (int i = 0; i < schema->count; i++) {
        write_field(w, schema, &schema->fields[i]);
    }
    fputs("\n", w->stubs);
}

static void write_signature(writer *w, const vnl_function *f) {
    if (f->signature == NULL) {
        const char *options = f->schema != NULL ? f->schema->name : "?";
        fprintf(w->stubs, "---@param options venule.%s.Options\n---@return %s\n", options, f->returns);
        return;
    }
    // "(a: integer, b?: number): number" becomes a @param a line, and what follows the parenthesis a @return.
    const char *at = f->signature + 1;
    int depth = 0;
    while (*at != ')' || depth > 0) {
        const char *end = at;
        for (; (*end != ',' && *end != ')') || depth > 0; end++) {
            depth +=
                (*end == '(' || *end == '{' || *end == '<') - (*end == ')' || *end == '}' || *end == '>');
        }
        const char *colon = memchr(at, ':', (size_t)(end - at));
        if (colon != NULL) {
            fprintf(w->stubs, "---@param %.*s%.*s\n", (int)(colon - at), at, (int)(end - colon - 1),
                    colon + 1);
        }
        at = *end == ',' ? end + 2 : end;
    }
    if (at[1] == ':') {
        fprintf(w->stubs, "---@return %s\n", at + 3);
    }
}

static void write_parameters(FILE *file, const vnl_function *f) {
    if (f->signature == NULL) {
        fputs("(options)", file);
        return;
    }
    char list[256] = "(";
    bool in_name = true;
    int depth = 0;
    for (const char *c = f->signature + 1; *c != ')' || depth > 0; c++) {
        depth += (*c == '(' || *c == '{' || *c == '<') - (*c == ')' || *c == '}' || *c == '>');
        if (*c == ',' && depth == 0) {
            in_name = true;
        } else if (*c == ':') {
            in_name = false;
        }
        if (in_name && *c != '?') {
            strncat(list, c, 1);
        }
    }
    fprintf(file, "%s)", list);
}

static const char *operator_sign(const char *name) {
    static const char *const signs[][2] = {{"__sub", "-"}, {"__add", "+"}, {"__mul", "*"}};
    for (size_t i = 0; i < sizeof signs / sizeof *signs; i++) {
        if (strcmp(name, signs[i][0]) == 0) {
            return signs[i][1];
        }
    }
    return NULL;
}

static void write_function(writer *w, const vnl_function *f, const char *owner, char separator) {
    if (f->doc == NULL || f->doc[0] == '\0') {
        fprintf(stderr, "venule_reference: %s%c%s has no documentation\n", owner, separator, f->name);
        w->missing++;
        return;
    }
    const char *sign = operator_sign(f->name);
    if (sign != NULL) {
        fprintf(w->page, "\n### `a %s b`\n\n%s\n", sign, f->doc);
        return;
    }
    fprintf(w->page, "\n### `%s%c%s%s`\n\n%s\n", owner, separator, f->name,
            f->signature != NULL ? f->signature : "{…}", f->doc);
    if (f->schema != NULL) {
        write_options(w, f->schema);
    }
    fprintf(w->stubs, "---%s\n", f->doc);
    write_signature(w, f);
    fprintf(w->stubs, "function %s%c%s", owner, separator, f->name);
    write_parameters(w->stubs, f);
    fputs(" end\n\n", w->stubs);
}

static void write_functions(writer *w, const vnl_function *functions, const char *owner, char separator) {
    for (const vnl_function *f = functions; f != NULL && f->name != NULL; f++) {
        write_function(w, f, owner, separator);
    }
}

static void write_class_fields(writer *w, const vnl_class *class) {
    for (int i = 0; class->fields != NULL && class->fields[i] != NULL; i++) {
        const char *field = class->fields[i];
        const char *colon = strchr(field, ':');
        const char *bar = strstr(field, " | ");
        fprintf(w->stubs, "---@field %.*s %.*s # %s\n", (int)(colon - field), field, (int)(bar - colon - 2),
                colon + 2, bar + 3);
        fprintf(w->page, "%s| `%.*s` | %.*s | %s |\n", i == 0 ? "\n| field | type | |\n|---|---|---|\n" : "",
                (int)(colon - field), field, (int)(bar - colon - 2), colon + 2, bar + 3);
    }
}

static void write_class(writer *w, const vnl_class *class) {
    char name[64];
    capitalised(name, sizeof name, class->name);
    fprintf(w->page, "\n## %s\n\n%s\n", name, class->doc);
    fprintf(w->stubs, "---%s\n---@class %s%s\n", class->doc, name,
            class == &vnl_growth_class ? ": venule.Domain" : "");
    for (const vnl_function *f = class->methods; f->name != NULL; f++) {
        if (operator_sign(f->name) != NULL) {
            fprintf(w->stubs, "---@operator %s(venule.Domain): venule.Domain\n", f->name + 2);
        }
    }
    write_class_fields(w, class);
    fprintf(w->stubs, "local %c%s = {}\n\n", class->name[0] - 'a' + 'A', class->name + 1);
    write_functions(w, class->methods, name + strlen("venule."), ':');
}

// The systems of lua/venule/ give their functions and rows as a table: see lua/venule/reference.lua.
static void write_lua_part(lua_State *L, const char *field, FILE *file) {
    lua_getfield(L, -1, field);
    fputs(lua_tostring(L, -1), file);
    lua_pop(L, 1);
}

static void write_vessel_classes(FILE *stubs) {
    fputs(
        "---@class venule.VesselParts\n---@field count integer\n---@field diameter venule.Spread\n---@field "
        "length venule.Spread\n\n"
        "---@class venule.OrderRatio\n---@field ratio number # 0 with fewer than two orders\n---@field r2 "
        "number\n\n"
        "---@class venule.ForkBin\n---@field from number # r2/r1\n---@field to number\n---@field count "
        "integer\n---@field ratio? number # mean; this and the following where count > 0\n---@field between? "
        "venule.Spread\n---@field thick? venule.Spread\n---@field thin? venule.Spread\n---@field theory? "
        "{between: number, thick: number, thin: number} # Murray's, at the mean ratio\n\n"
        "---@class venule.MurrayResidual: venule.Statistics\n---@field rms number\n---@field worst? integer "
        "# "
        "the node of the largest\n\n"
        "---@class venule.VesselMeasures\n---@field exponent number # that `murray` is of\n---@field murray "
        "venule.MurrayResidual # |r_parent^exponent - Σ r_child^exponent| / r_parent^exponent\n---@field "
        "fitted venule.Statistics # the exponents that make it 0\n---@field bifurcations integer # nodes "
        "with "
        "a parent and two children\n---@field furcations integer # nodes with three children or more\n"
        "---@field ratio venule.Statistics # r2/r1\n---@field expansion venule.Statistics # (r1² + r2²) / "
        "r0²\n---@field angles {between: venule.Statistics, thick: venule.Statistics, thin: "
        "venule.Statistics, bins: venule.ForkBin[]} # degrees\n---@field orders {segments: "
        "venule.VesselParts, elements: venule.VesselParts}[]\n---@field segments integer\n---@field elements "
        "integer\n---@field bifurcation_ratio venule.OrderRatio # by how much there are fewer elements an "
        "order up\n---@field diameter_ratio venule.OrderRatio # and they are thicker\n---@field length_ratio "
        "venule.OrderRatio # and longer\n---@field tortuosity {segments: venule.Statistics, elements: "
        "venule.Statistics} # arc by chord\n---@field curvature {segments: venule.Statistics, elements: "
        "venule.Statistics} # mean square, radians²/length²\n\n"
        "---@class venule.Boxes\n---@field dimension number\n---@field r2 number # of the line\n---@field "
        "extent number\n---@field boxes {side: number, count: integer}[] # from the largest\n\n"
        "---@class venule.Tissue\n---@field resolution number\n---@field points integer\n---@field distance "
        "venule.Statistics\n---@field furthest number[] # where distance.max is\n---@field mode number\n"
        "---@field lumen number # share of points inside vessels\n---@field perfused? number # share within "
        "reach\n---@field bin number # width of a bin\n---@field histogram integer[] # points\n\n",
        stubs);
}

static void write_all(writer *w, lua_State *L) {
    fputs(
        "---@meta venule\n-- Generated from the bindings (the target `generate`); not to be edited.\n\n"
        "---@class venule\n---@field version string\nlocal venule = {domain = {}, growth = {}, leaf = {}}\n\n"
        "---@class venule.Bounds\n---@field min number[]\n---@field max number[]\n---@field unit? string\n\n"
        "---@class venule.Measures\n---@field nodes integer\n---@field roots integer\n---@field tips "
        "integer\n"
        "---@field bifurcations integer\n---@field joins integer\n---@field depth integer\n---@field length "
        "number\n"
        "---@field min_radius number\n---@field max_radius number\n---@field extent venule.Bounds\n"
        "---@field leaf? venule.LeafMeasures\n\n",
        w->stubs);
    fputs(
        "---@class venule.Statistics\n---@field count integer\n---@field mean number\n---@field deviation "
        "number\n---@field min number\n---@field lower number\n---@field median number\n---@field upper "
        "number\n---@field max number\n\n"
        "---@class venule.LeafMeasures\n---@field area number\n---@field area_of \"domain\"|\"hull\"\n"
        "---@field length number\n---@field density number # length by area\n---@field order_density "
        "number[] # of each vein order\n---@field tips integer # free ends but for roots\n---@field "
        "tip_density number\n---@field free_ends integer # tips within areoles\n---@field free_end_density "
        "number\n---@field degree3 integer # junctions of three edges\n---@field degree4 integer\n---@field "
        "degree_more integer\n---@field loops integer # edges - nodes + connected parts\n---@field crossings "
        "integer # where there are any, areoles say little\n---@field areoles integer\n---@field "
        "areole_areas number[]\n---@field areole_quotients number[] # 4 π area / perimeter²\n---@field "
        "areole_area venule.Statistics\n---@field areole_quotient venule.Statistics\n---@field hierarchy "
        "{merges: integer, height: integer, strahler: integer, asymmetry: number, nesting: number}\n"
        "---@field angles {count: integer, daughters: number, bins: {from: number, to: number, count: "
        "integer, thick_middle: number, thick_thin: number, middle_thin: number}[]}\n---@field distance "
        "{resolution: number, points: integer, mean: number, max: number, mode: number}\n\n",
        w->stubs);
    fputs(
        "---@class venule.FlowWorst\n---@field error number # relative\n---@field node? integer # where: the "
        "node, or the node whose edge it is\n---@field join? integer # or the join\n\n"
        "---@class venule.FlowReport\n---@field inflow number # at all roots, length³/s\n---@field outflow "
        "number # at all terminals, length³/s\n---@field volume number # Σ π r² ℓ, length³\n---@field "
        "resistance number # power / inflow², Pa s/length³\n---@field power number # Σ R Q², Pa "
        "length³/s\n---@field conservation venule.FlowWorst # in less out, by what passes a node\n---@field "
        "drop venule.FlowWorst # loss along an edge less Poiseuille's, by the span of "
        "pressures\n---@field terminal venule.FlowWorst # pressure less pressure_out, by it\n---@field "
        "terminal_pressure venule.Statistics # Pa\n---@field terminal_flow venule.Statistics # "
        "length³/s\n---@field wall_shear venule.Statistics # of edges, 4 μ |Q| / (π r³), Pa\n---@field "
        "murray venule.Statistics # |r_parent^exponent - Σ r_child^exponent| / r_parent^exponent at "
        "forks\n---@field fitted venule.Statistics # the exponents that make it 0\n---@field terminals "
        "{node: integer[], pressure: number[], flow: number[]}\n---@field edge_shear number[] # Pa, of each "
        "node's edge; 0 at a root\n---@field join_shear number[] # Pa, of each join\n\n"
        "---@class venule.Spread\n---@field mean number\n---@field deviation number\n\n"
        "---@class venule.Level\n---@field level integer # forks between the root and it\n---@field count "
        "integer # segments\n---@field diameter venule.Spread\n---@field length venule.Spread\n---@field "
        "flow? venule.Spread # where flows are known\n\n"
        "---@class venule.Levels\n---@field [integer] venule.Level\n---@field segments integer\n---@field "
        "symmetry venule.Statistics # thinnest daughter's radius by the thickest's\n---@field slenderness "
        "venule.Statistics # length by diameter\n---@field angle venule.Statistics # degrees, between two "
        "daughters\n\n",
        w->stubs);
    write_vessel_classes(w->stubs);
    fputs("# Lua reference\n\nGenerated from the bindings (the target `generate`); not to be edited. Options "
          "marked *required* "
          "must be given; an option without a default may be left out. Indices count from 1, angles are "
          "degrees, y points "
          "up.\n\n```lua\nlocal venule = require \"venule\"\n```\n\n## venule\n",
          w->page);
    write_functions(w, vnl_network_functions, "venule", '.');
    write_functions(w, vnl_attractors_functions, "venule", '.');
    write_functions(w, vnl_canvas_functions, "venule", '.');
    write_functions(w, vnl_voxels_functions, "venule", '.');
    write_functions(w, vnl_module_functions, "venule", '.');
    write_lua_part(L, "stubs", w->stubs);
    write_lua_part(L, "page", w->page);
    fputs("\n## venule.domain\n", w->page);
    write_functions(w, vnl_domain_functions, "venule.domain", '.');
    fputs("\n## venule.growth\n", w->page);
    write_functions(w, vnl_growth_functions, "venule.growth", '.');
    for (int i = 0; vnl_classes[i] != NULL; i++) {
        write_class(w, vnl_classes[i]);
    }
    fputs("return venule\n", w->stubs);
}

int main(int argc, char **argv) {
    if (argc != 3) {
        fprintf(stderr, "venule_reference STUBS.lua PAGE.md\n");
        return 2;
    }
    lua_State *L = luaL_newstate();
    luaL_openlibs(L);
    luaL_requiref(L, "venule", luaopen_venule, 0);
    if (luaL_dostring(L, "return (require 'venule.reference')") != LUA_OK) {
        fprintf(stderr, "venule_reference: %s\n", lua_tostring(L, -1));
        return 1;
    }
    writer w = {fopen(argv[1], "w"), fopen(argv[2], "w"), 0};
    if (w.stubs == NULL || w.page == NULL) {
        perror("venule_reference");
        return 4;
    }
    write_all(&w, L);
    bool failed = fclose(w.stubs) != 0 || fclose(w.page) != 0;
    lua_close(L);
    return failed || w.missing > 0;
}
