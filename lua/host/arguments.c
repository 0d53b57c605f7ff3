#include "host/host.h"

#include "base/schema.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef enum option_kind { FLAG, OUTPUT, SET, PARAMS, SEED, THREADS, TIME, MEMORY } option_kind;

static const struct {
    const char *name;
    option_kind kind;
    size_t offset; ///< of a FLAG
} known[] = {
    {"-o", OUTPUT, 0},
    {"--output", OUTPUT, 0},
    {"--set", SET, 0},
    {"--params", PARAMS, 0},
    {"--seed", SEED, 0},
    {"--threads", THREADS, 0},
    {"--time", TIME, 0},
    {"--memory", MEMORY, 0},
    {"--trust", FLAG, offsetof(run_options, trust)},
    {"--json", FLAG, offsetof(run_options, json)},
    {"--quiet", FLAG, offsetof(run_options, quiet)},
    {"--help", FLAG, offsetof(run_options, help)},
    {"-h", FLAG, offsetof(run_options, help)},
};

enum { KNOWN = sizeof known / sizeof *known };

static bool complain(const char *option, const char *value, const char *wanted) {
    fprintf(stderr, "venule: %s %s: %s\n", option, value, wanted);
    return false;
}

bool read_size(const char *text, size_t *bytes) {
    char *end;
    errno = 0;
    double value = strtod(text, &end);
    double factor = 1;
    switch (*end) {
    case 'k':
    case 'K':
        factor = 1024.0;
        break;
    case 'm':
    case 'M':
        factor = 1024.0 * 1024.0;
        break;
    case 'g':
    case 'G':
        factor = 1024.0 * 1024.0 * 1024.0;
        break;
    default:
        break;
    }
    end += factor > 1;
    bool fits = errno == 0 && end != text && *end == '\0' && value > 0 && value * factor < 1e18;
    *bytes = fits ? (size_t)(value * factor) : 0;
    return fits;
}

static bool read_positive(const char *text, double most, double *value) {
    char *end;
    errno = 0;
    *value = strtod(text, &end);
    return errno == 0 && end != text && *end == '\0' && *value > 0 && *value <= most;
}

static bool apply(run_options *options, option_kind kind, const char *name, const char *value) {
    double number;
    switch (kind) {
    case OUTPUT:
        return vn_array_push(&options->outputs, value) == VN_OK;
    case SET:
        return strchr(value, '=') != NULL && value[0] != '=' ? vn_array_push(&options->sets, value) == VN_OK
                                                             : complain(name, value, "give it as NAME=VALUE");
    case PARAMS:
        options->params = value;
        return true;
    case SEED:
        options->seed = value;
        return true;
    case THREADS:
        options->threads = read_positive(value, 4096, &number) && number == (int)number ? (int)number : 0;
        return options->threads > 0 ||
               complain(name, value, "a whole number of threads from 1 to 4096 expected");
    case TIME:
        return read_positive(value, 1e9, &options->time) || complain(name, value, "seconds above 0 expected");
    case MEMORY:
        return read_size(value, &options->memory) ||
               complain(name, value, "a size such as 300M or 2G expected");
    default:
        return true;
    }
}

static bool complain_unknown(const char *word) {
    const char *names[KNOWN];
    for (int i = 0; i < KNOWN; i++) {
        names[i] = known[i].name;
    }
    const char *closest = vn_closest_name(word, names, KNOWN);
    fprintf(stderr, "venule: unknown option %s", word);
    fprintf(stderr, closest != NULL ? ", did you mean %s?\n" : " (venule --help lists them)\n", closest);
    return false;
}

static int find_option(const char *word, size_t length) {
    for (int i = 0; i < KNOWN; i++) {
        if (strlen(known[i].name) == length && strncmp(known[i].name, word, length) == 0) {
            return i;
        }
    }
    return -1;
}

// Both `--time 3` and `--time=3`. Returns how many words were used, 0 after a complaint.
static int read_option(run_options *options, int argc, char **argv) {
    const char *word = argv[0];
    const char *equals = strncmp(word, "--", 2) == 0 ? strchr(word, '=') : NULL;
    int i = find_option(word, equals != NULL ? (size_t)(equals - word) : strlen(word));
    if (i < 0) {
        complain_unknown(word);
        return 0;
    }
    if (known[i].kind == FLAG) {
        *(bool *)((char *)options + known[i].offset) = true;
        return 1;
    }
    const char *value = equals != NULL ? equals + 1 : (argc > 1 ? argv[1] : NULL);
    if (value == NULL) {
        complain(known[i].name, "", "a value must follow");
        return 0;
    }
    return apply(options, known[i].kind, known[i].name, value) ? (equals != NULL ? 1 : 2) : 0;
}

bool read_run_options(run_options *options, int argc, char **argv) {
    *options = (run_options){0};
    for (int i = 0; i < argc;) {
        if (argv[i][0] == '-' && argv[i][1] != '\0') {
            int used = read_option(options, argc - i, argv + i);
            if (used == 0) {
                return false;
            }
            i += used;
        } else if (options->script == NULL) {
            options->script = argv[i++];
        } else {
            return complain(argv[i], "", "a second script; one runs at a time");
        }
    }
    return options->script != NULL || complain("run", "", "which script? (venule run SCRIPT)");
}

void free_run_options(run_options *options) {
    vn_array_free(&options->outputs);
    vn_array_free(&options->sets);
}
