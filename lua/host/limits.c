// Memory and time. A hook asks the engine's clock while Lua runs, the engine asks it while C runs, and where
// neither can (one long call of a library) a timer ends the process a little later: files appear whole or not
// at all, so that is safe.

#include "host/host.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

static void *allocate(void *payload, void *block, size_t old_size, size_t new_size) {
    (void)payload;
    // Without a block, Lua passes a type tag where the old size would be.
    return vn_resize(block, block != NULL ? old_size : 0, new_size);
}

static int give_up(lua_State *L) {
    const char *message = lua_tostring(L, -1);
    fprintf(stderr, "venule: internal error: %s\n", message != NULL ? message : "an unprotected error");
    return 0; // Lua aborts
}

lua_State *limits_new_state(void) {
    lua_State *L = lua_newstate(allocate, NULL);
    if (L != NULL) {
        lua_atpanic(L, give_up);
    }
    return L;
}

enum { HOOK_EVERY = 10000 };

// Once the run has to end, every further instruction fails: no pcall() outlives that.
static void look_at_clock(lua_State *L, lua_Debug *at) {
    (void)at;
    lua_getfield(L, LUA_REGISTRYINDEX, "venule.stopped");
    bool stopped = lua_isstring(L, -1);
    if (!stopped) {
        lua_pop(L, 1);
        vn_status status = vn_poll();
        if (status == VN_OK) {
            return;
        }
        lua_pushinteger(L, status);
        lua_setfield(L, LUA_REGISTRYINDEX, "venule.status");
        lua_pushstring(L, vn_message());
        lua_pushvalue(L, -1);
        lua_setfield(L, LUA_REGISTRYINDEX, "venule.message");
        lua_pushvalue(L, -1);
        lua_setfield(L, LUA_REGISTRYINDEX, "venule.stopped");
    }
    lua_sethook(L, look_at_clock, LUA_MASKCOUNT, 1); // of each coroutine, as hooks are its own
    lua_error(L);
}

// The second Ctrl-C does what it does everywhere.
static void interrupt(int signal_number) {
    vn_interrupt(); // NOLINT(bugprone-signal-handler): made for this; it sets one sig_atomic_t
    signal(signal_number, SIG_DFL);
}

static void end_process(int signal_number) {
    static const char message[] = "venule: time is up, and a library did not return: the run was ended\n";
    (void)signal_number;
    ssize_t ignored = write(STDERR_FILENO, message, sizeof message - 1);
    (void)ignored;
    _exit(5);
}

static void start_timer(double seconds) {
    struct itimerval timer = {.it_value = {.tv_sec = (time_t)ceil(seconds)}};
    signal(SIGALRM, end_process);
    setitimer(ITIMER_REAL, &timer, NULL);
}

#if defined(__SANITIZE_ADDRESS__)
#define LIMITED_BY_SYSTEM 0 // shadow memory would count
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define LIMITED_BY_SYSTEM 0
#endif
#endif
#ifndef LIMITED_BY_SYSTEM
#define LIMITED_BY_SYSTEM 1
#endif

// What libraries allocate does not count in the engine; the process's own limit holds that, with room for
// what they need to be there at all.
static void limit_process(size_t memory) {
    enum { LIBRARIES = 256 << 20 };
    struct rlimit limit;
    if (LIMITED_BY_SYSTEM && getrlimit(RLIMIT_DATA, &limit) == 0) {
        limit.rlim_cur = memory + LIBRARIES < limit.rlim_max ? memory + LIBRARIES : limit.rlim_max;
        setrlimit(RLIMIT_DATA, &limit);
    }
}

void limits_arm(lua_State *L, const run_options *options) {
    static const double grace = 2;
    vn_set_threads(options->threads);
    vn_set_memory_budget(options->memory);
    vn_set_time_budget(options->time);
    if (options->memory > 0) {
        limit_process(options->memory);
    }
    if (options->time > 0) {
        start_timer(options->time + grace);
    }
    signal(SIGINT, interrupt);
    lua_sethook(L, look_at_clock, LUA_MASKCOUNT, HOOK_EVERY);
}

void limits_disarm(void) {
    struct itimerval none = {0};
    setitimer(ITIMER_REAL, &none, NULL);
    vn_set_memory_budget(0);
    vn_set_time_budget(0);
    signal(SIGINT, SIG_DFL);
}
