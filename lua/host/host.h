/// The `venule` program.
#ifndef VN_HOST_HOST_H
#define VN_HOST_HOST_H

#include "base/array.h"
#include "venule/base.h"

#include <lauxlib.h>
#include <lua.h>
#include <lualib.h>

enum { VN_EXIT_USAGE = 2 };

/// How a run goes, for the line on the terminal.
typedef struct run_progress {
    double started, shown; ///< seconds of the monotonic clock
    long steps;
    bool visible;
} run_progress;

/// What the command line of a run says.
typedef struct run_options {
    const char *script;
    VN_ARRAY(const char *) outputs; ///< each -o
    VN_ARRAY(const char *) sets;    ///< each NAME=VALUE
    const char *params;             ///< a JSON file of parameters
    const char *seed;               ///< of --seed; NULL without
    double time;                    ///< seconds; 0: no limit
    size_t memory;                  ///< bytes; 0: no limit
    int threads;                    ///< 0: all
    bool trust, json, quiet, help;
    run_progress progress;
} run_options;

/// Read the arguments after the command; false after saying on stderr what is wrong.
bool read_run_options(run_options *options, int argc, char **argv);
void free_run_options(run_options *options);

/// A size such as 300M, 2G, 65536; false when it is none.
bool read_size(const char *text, size_t *bytes);

/// Each returns the exit status.
int run_command(int argc, char **argv);
int info_command(int argc, char **argv);
int convert_command(int argc, char **argv);
int test_command(int argc, char **argv);

/// limits.c: a state whose memory counts against the budget, and that Ctrl-C and the time budget stop.
lua_State *limits_new_state(void);
void limits_arm(lua_State *L, const run_options *options);
void limits_disarm(void);

/// sandbox.c: the libraries that a script may have; all of them when it is trusted. `require` finds modules
/// beside @p script.
void sandbox_open(lua_State *L, const char *script, bool trust);

/// progress.c: the functions of `host` that show how a run goes.
void progress_push(lua_State *L, run_options *options);
/// Take the progress line away.
void progress_clear(run_options *options);

#endif
