#include "bind/bind.h"
#include "host/host.h"

#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static double growth_fraction(lua_State *L) {
    lua_getfield(L, LUA_REGISTRYINDEX, "venule.latest.growth");
    const vn_growth *growth = vnl_test(L, -1, &vnl_growth_class);
    lua_pop(L, 1);
    double whole = growth != NULL ? vn_growth_final_length(growth) : 0;
    return whole > 0 ? vn_growth_length(growth) / whole : -1;
}

static int32_t latest_nodes(lua_State *L) {
    lua_getfield(L, LUA_REGISTRYINDEX, "venule.latest.network");
    const vn_network *network = vnl_test(L, -1, &vnl_network_class);
    lua_pop(L, 1);
    return network != NULL ? vn_network_count(network) : 0;
}

static void show_bar(run_progress *run, double fraction, int32_t nodes) {
    enum { WIDTH = 30 };
    static const char full[] = "##############################";
    static const char empty[] = "..............................";
    int done = fraction < 0 ? 0 : (int)(WIDTH * (fraction < 1 ? fraction : 1));
    if (fraction >= 0) {
        fprintf(stderr, "\r[%.*s%.*s] ", done, full, WIDTH - done, empty);
    } else {
        fprintf(stderr, "\r");
    }
    fprintf(stderr, "step %ld, %d nodes, %.1f s\033[K", run->steps, nodes, now() - run->started);
    fflush(stderr);
    run->visible = true;
}

// host.frame(fraction): the one place where a loop meets the user.
static int host_frame(lua_State *L) {
    run_options *options = lua_touserdata(L, lua_upvalueindex(1));
    run_progress *run = &options->progress;
    double fraction = lua_isnoneornil(L, 1) ? growth_fraction(L) : vnl_check_number(L, 1, "frame");
    vnl_try(L, vn_poll());
    run->steps++;
    if (!options->quiet && isatty(STDERR_FILENO) && now() - run->shown > 0.1) {
        run->shown = now();
        show_bar(run, fraction, latest_nodes(L));
    }
    return 0;
}

void progress_clear(run_options *options) {
    if (options->progress.visible) {
        fprintf(stderr, "\r\033[K");
        options->progress.visible = false;
    }
}

static int host_note(lua_State *L) {
    run_options *options = lua_touserdata(L, lua_upvalueindex(1));
    progress_clear(options);
    if (!options->quiet) {
        fprintf(stderr, "note: %s\n", luaL_checkstring(L, 1));
    }
    return 0;
}

static void print_json_text(const char *text) {
    putchar('"');
    for (; *text != '\0'; text++) {
        if ((unsigned char)*text < 0x20) {
            printf("\\u%04x", *text);
        } else {
            printf(*text == '"' || *text == '\\' ? "\\%c" : "%c", *text);
        }
    }
    putchar('"');
}

static double number_field(lua_State *L, const char *name) {
    lua_getfield(L, 2, name);
    double value = lua_tonumber(L, -1);
    lua_pop(L, 1);
    return value;
}

static void print_outputs(lua_State *L, bool json) {
    for (lua_Integer i = 1; lua_geti(L, 1, i) == LUA_TSTRING; i++, lua_pop(L, 1)) {
        const char *path = lua_tostring(L, -1);
        if (json) {
            fputs(i > 1 ? ", " : "", stdout);
            print_json_text(path);
        } else {
            puts(path);
        }
    }
    lua_pop(L, 1);
}

// host.finish(outputs, {nodes=, tips=, length=}): what was written and how much, on stdout.
static int host_finish(lua_State *L) {
    run_options *options = lua_touserdata(L, lua_upvalueindex(1));
    progress_clear(options);
    lua_pushboolean(L, true);
    lua_setfield(L, LUA_REGISTRYINDEX, "venule.finished");
    double nodes = number_field(L, "nodes"), tips = number_field(L, "tips"),
           length = number_field(L, "length");
    if (options->json) {
        fputs("{\"outputs\": [", stdout);
        print_outputs(L, true);
        printf("], \"nodes\": %.0f, \"tips\": %.0f, \"length\": %.17g, \"seconds\": %.3f}\n", nodes, tips,
               length, now() - options->progress.started);
    } else if (!options->quiet) {
        print_outputs(L, false);
        printf("%.0f nodes, %.0f tips, %.6g long, %.2f s\n", nodes, tips, length,
               now() - options->progress.started);
    }
    fflush(stdout);
    return 0;
}

static void add(lua_State *L, run_options *options, const char *name, lua_CFunction function) {
    lua_pushlightuserdata(L, options);
    lua_pushcclosure(L, function, 1);
    lua_setfield(L, -2, name);
}

void progress_push(lua_State *L, run_options *options) {
    options->progress = (run_progress){.started = now()};
    add(L, options, "frame", host_frame);
    add(L, options, "note", host_note);
    add(L, options, "finish", host_finish);
}
