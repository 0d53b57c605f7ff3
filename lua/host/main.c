#include "host/host.h"

#include "base/schema.h"

#include <cairo.h>
#include <locale.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const char help_text[] =
    "Venule grows veins: leaf venation, blood vessels, anything that branches to fill a space.\n"
    "\n"
    "  venule run SCRIPT [options]   run a scenario (`venule SCRIPT` is the same)\n"
    "      -o FILE                   write the result there: .svg, .png, .pdf, .eps, or a network's,\n"
    "                                as below; may be repeated\n"
    "      --set NAME=VALUE          set one of the script's parameters; may be repeated\n"
    "      --params FILE             set parameters from a JSON file {\"name\": value, ...}\n"
    "      --seed N                  the same as --set seed=N\n"
    "      --time SECONDS            stop after so long, with exit status 5\n"
    "      --memory SIZE             stop when more is needed (300M, 2G), with exit status 5\n"
    "      --threads N               use so many threads; results never depend on it\n"
    "      --trust                   give the script all of Lua: files, processes, C modules\n"
    "      --json                    print what was written as one line of JSON\n"
    "      --quiet                   print nothing but errors\n"
    "      --help                    list the script's parameters, with ranges\n"
    "  venule info FILE [--json]     what a saved network is: counts, bounds, measures\n"
    "  venule convert IN OUT         between all formats of networks: .json .xml .gxl .vtp .swc .csv .txt\n"
    "  venule test FILE|FOLDER...    run Lua tests (luaunit): test_*.lua\n"
    "  venule --version\n"
    "\n"
    "Exit status: 0 done, 1 script error, 2 usage, 3 infeasible, 4 input/output, 5 limit reached, 130 "
    "interrupted.\n";

static int help_command(int argc, char **argv) {
    (void)argc;
    (void)argv;
    fputs(help_text, stdout);
    return 0;
}

static int version_command(int argc, char **argv) {
    (void)argc;
    (void)argv;
    printf("venule %s (%s, cairo %s)\n", vn_version(), LUA_RELEASE, cairo_version_string());
    return 0;
}

static const struct {
    const char *name;
    int (*call)(int argc, char **argv);
} commands[] = {{"run", run_command},   {"info", info_command},       {"convert", convert_command},
                {"test", test_command}, {"help", help_command},       {"--help", help_command},
                {"-h", help_command},   {"version", version_command}, {"--version", version_command}};

enum { COMMANDS = sizeof commands / sizeof *commands };

static bool looks_like_script(const char *word) {
    size_t length = strlen(word);
    return (length > 4 && strcmp(word + length - 4, ".lua") == 0) || access(word, F_OK) == 0;
}

static int unknown_command(const char *word) {
    const char *names[COMMANDS];
    for (int i = 0; i < COMMANDS; i++) {
        names[i] = commands[i].name;
    }
    const char *closest = vn_closest_name(word, names, COMMANDS);
    fprintf(stderr, "venule: unknown command \"%s\"", word);
    if (closest != NULL) {
        fprintf(stderr, ", did you mean \"%s\"?\n", closest);
    } else {
        fprintf(stderr, " (venule --help lists them)\n");
    }
    return VN_EXIT_USAGE;
}

int main(int argc, char **argv) {
    setlocale(LC_CTYPE, ""); // file names and letters; numbers stay as they are everywhere
    if (argc < 2) {
        fputs(help_text, stderr);
        return VN_EXIT_USAGE;
    }
    int status = -1;
    for (int i = 0; status < 0 && i < COMMANDS; i++) {
        if (strcmp(argv[1], commands[i].name) == 0) {
            status = commands[i].call(argc - 2, argv + 2);
        }
    }
    if (status < 0) {
        status = looks_like_script(argv[1]) ? run_command(argc - 1, argv + 1) : unknown_command(argv[1]);
    }
    if (fflush(stdout) != 0 || ferror(stdout)) {
        fprintf(stderr, "venule: what it had to say could not be written to stdout (is the disk full?)\n");
        status = status == 0 ? vn_exit_status(VN_IO) : status;
    }
    return status;
}
