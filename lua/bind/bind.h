/// What the bindings share. A binding checks its arguments, calls the engine and pushes the result; geometry
/// and policy live elsewhere. Everything here may raise a Lua error, so nothing that owns memory may be held
/// across a call, except in a userdata.
#ifndef VN_BIND_BIND_H
#define VN_BIND_BIND_H

#include "base/schema.h"
#include "venule/venule.h"

#include <lauxlib.h>
#include <lua.h>

/// One bound function: everything that the stubs and the reference page say of it.
typedef struct vnl_function {
    const char *name;
    lua_CFunction call; ///< NULL: a column of that name is what is called
    const char
        *signature; ///< as LuaCATS writes it: "(x: number, y: number): boolean"; NULL: one table of options
    const char *returns;     ///< with options: the type of what comes back
    const char *doc;         ///< one or two sentences
    const vn_schema *schema; ///< the table of options, or NULL
} vnl_function;

/// A class of userdata: a box with one pointer, which is NULL once closed.
typedef struct vnl_class {
    const char *name; ///< "network"; the metatable is called "venule.network"
    const char *doc;
    const vnl_function *methods; ///< ended by a zeroed one
    const vnl_function *extra;   ///< more methods, shared with another class; may be NULL
    const char *const
        *fields;         ///< "x: number[] | each node's …", ended by NULL; for the reference; may be NULL
    lua_CFunction field; ///< reads a field: (object, key) → value, or nothing; may be NULL
    void (*release)(void *object);
    lua_CFunction length; ///< __len; may be NULL
} vnl_class;

extern const vnl_class vnl_domain_class;
extern const vnl_class vnl_growth_class;
extern const vnl_class vnl_network_class;
extern const vnl_class vnl_attractors_class;
extern const vnl_class vnl_influence_class;
extern const vnl_class vnl_rng_class;
extern const vnl_class vnl_canvas_class;
extern const vnl_class vnl_volume_class;
extern const vnl_class vnl_cco_class;

/// All classes, ended by NULL.
extern const vnl_class *const vnl_classes[];

/// The functions of `venule` itself, file by file, and of its tables, each ended by a zeroed one.
extern const vnl_function vnl_module_functions[];
extern const vnl_function vnl_network_functions[];
extern const vnl_function vnl_attractors_functions[];
extern const vnl_function vnl_canvas_functions[];
extern const vnl_function vnl_voxels_functions[];
extern const vnl_function vnl_cco_functions[];
extern const vnl_function vnl_paths_functions[];
extern const vnl_function vnl_domain_functions[];
extern const vnl_function vnl_growth_functions[];

/// A domain's methods, which a growth has too.
extern const vnl_function vnl_domain_methods[];

/// Register a class; its metatable is left in the registry.
void vnl_register(lua_State *L, const vnl_class *class);
/// Register what vnl_push_view() pushes.
void vnl_register_view(lua_State *L);
/// Push a table of functions.
void vnl_push_functions(lua_State *L, const vnl_function *functions);

/// Push an empty box of the class: an error between this and the engine's call leaves something harmless.
/// Returns the slot for the object. One user value is reserved for what the object must keep alive.
void **vnl_push_box(lua_State *L, const vnl_class *class);
/// The object at @p index, which must be an open one of the class.
void *vnl_check(lua_State *L, int index, const vnl_class *class);
/// The object at @p index or NULL when it is something else.
void *vnl_test(lua_State *L, int index, const vnl_class *class);
/// A domain or a growth.
vn_domain *vnl_check_domain(lua_State *L, int index);
vn_domain *vnl_test_domain(lua_State *L, int index);
/// Keep the value at @p value alive as long as the object at @p object.
void vnl_keep(lua_State *L, int object, int value);

/// Raise vn_message() as an error with the script's line, unless @p status is VN_OK.
void vnl_try(lua_State *L, vn_status status);
/// Raise an error of the script's own with its line: VN_INVALID.
int vnl_fail(lua_State *L, const char *format, ...) VN_PRINTF(2, 3) __attribute__((noreturn));
/// The status of the last raised error, and whether @p message is that error's text. For the host.
vn_status vnl_status_of(lua_State *L, const char *message);

/// Read the table of options at @p index into @p def, strictly: unknown fields are refused with a suggestion,
/// types and ranges checked, required fields demanded. VN_MIXED fields are left to the caller. Text stays
/// valid while the table lives.
void vnl_read_options(lua_State *L, int index, const vn_schema *schema, void *def);
// Options are read raw, and everything that may run Lua (callbacks, the manifest, an allocation that collects
// garbage) comes before the objects are fetched by vnl_check(): whatever Lua runs may close them.

/// Push the schema as rows of lua/venule/options.lua.
void vnl_push_rows(lua_State *L, const vn_schema *schema);
/// Push a field of the table at @p index without asking its metatable; returns its type.
int vnl_raw_field(lua_State *L, int index, const char *field);
/// Whether the table at @p index has the field; used where "not given" differs from every value.
bool vnl_has(lua_State *L, int index, const char *field);
/// A VN_MIXED field that is true or false; @p otherwise where it, or the table, was not given.
bool vnl_read_switch(lua_State *L, int index, const char *verb, const char *field, bool otherwise);
/// A whole number that is not a string that looks like one.
lua_Integer vnl_check_integer(lua_State *L, int index, const char *what);
/// The influence at @p index, whose attractors and network are open, and unchanged since.
vn_influence *vnl_check_influence(lua_State *L, int index);
/// Read a point {x, y[, z]}; returns how many coordinates it has. @p what names it in errors.
int vnl_read_point(lua_State *L, int index, const char *what, double p[3]);
/// Read the field {min = …, max = …} of the table at @p index, as domain:bounds() gives it; whether it is
/// there.
bool vnl_read_bounds(lua_State *L, int index, const char *schema, const char *field, vn_box *box);
/// The coordinates x, y[, z] given as arguments from @p index on, for something of @p dim dimensions.
void vnl_check_coordinates(lua_State *L, int index, int dim, double p[3]);
/// A number that is not a string that looks like one.
double vnl_check_number(lua_State *L, int index, const char *what);
/// Set a field of the table on top of the stack.
void vnl_set_integer(lua_State *L, const char *name, lua_Integer value);
void vnl_set_number(lua_State *L, const char *name, double value);
/// A field with a list of numbers, and one with what describes such a list.
void vnl_set_list(lua_State *L, const char *name, const double *values, int32_t count);
void vnl_set_statistics(lua_State *L, const char *name, const vn_statistics *statistics);
/// A field {mean = …, deviation = …}, and one with coordinates.
void vnl_set_spread(lua_State *L, const char *name, const vn_spread *spread);
void vnl_set_point(lua_State *L, const char *name, int dim, const double p[3]);
/// Push @p size zeroed bytes of Lua's own, which @p release frees what hangs from even when Lua runs out of
/// memory half way.
void *vnl_push_owned(lua_State *L, size_t size, lua_CFunction release);
/// Push coordinates.
int vnl_push_coordinates(lua_State *L, int dim, const double p[3]);
/// Push {min = {…}, max = {…}}.
void vnl_push_bounds(lua_State *L, int dim, const vn_box *box, const char *unit);

/// The file that a script means by argument @p index: a relative path is looked for beside the script, then
/// in the working folder. Valid while it is on the stack, where it is left.
const char *vnl_push_path(lua_State *L, int index);
/// Push the JSON that files carry about how they were made; valid while it is on the stack, NULL where
/// nobody knows.
const char *vnl_push_manifest(lua_State *L);

/// Push an empty holder of a leaf's measures, which frees them.
vn_leaf_measures *vnl_push_leaf_measures(lua_State *L);
/// Push what was measured as a table.
void vnl_push_leaf_table(lua_State *L, const vn_leaf_measures *measures);

enum { VNL_MOST_NETWORKS = 256 };
/// The networks of the table {name = network, …} at @p index, by alphabet; how many. Allocates nothing. The
/// names are the table's.
int32_t vnl_named_networks(lua_State *L, int index, const char *what, const vn_network **networks,
                           const char **names);
/// net:voxels{…}
int vnl_network_voxels(lua_State *L);
/// net:follow(paths, {…})
int vnl_network_follow(lua_State *L);
/// net:flow{…} and net:levels().
int vnl_network_flow(lua_State *L);
int vnl_network_levels(lua_State *L);
/// net:measure_vessels{…}, net:measure_boxes{…} and net:measure_tissue{…}
int vnl_network_measure_vessels(lua_State *L);
int vnl_network_measure_boxes(lua_State *L);
int vnl_network_measure_tissue(lua_State *L);

/// Push a view of one column of the object at stack index @p object: read by integers from 1, `#`, and
/// ipairs().
/// @p read pushes entry @p i (0-based) of it.
typedef void vnl_read_fn(lua_State *L, void *object, int32_t i);
typedef int32_t vnl_count_fn(void *object);
void vnl_push_view(lua_State *L, int object, const vnl_class *class, vnl_read_fn *read, vnl_count_fn *count);
/// Let the column on top of the stack be a method too: @p call gets the arguments of a method.
void vnl_set_view_call(lua_State *L, lua_CFunction call);

int luaopen_venule(lua_State *L) __attribute__((visibility("default")));

#endif
