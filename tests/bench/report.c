#include "report.h"

#include "venule/base.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <yajl/yajl_tree.h>

void report_add(report *r, const char *bench, const char *name, double value, const char *unit) {
    if (r->count == MOST_FIGURES) {
        return;
    }
    figure *f = &r->figures[r->count++];
    snprintf(f->bench, sizeof f->bench, "%s", bench);
    snprintf(f->name, sizeof f->name, "%s", name);
    snprintf(f->unit, sizeof f->unit, "%s", unit);
    f->value = value;
}

// The first line of a command's output, without quotes or backslashes.
static void first_line(char *out, size_t size, const char *command) {
    FILE *pipe = popen(command, "r");
    out[0] = '\0';
    if (pipe == NULL) {
        return;
    }
    if (fgets(out, (int)size, pipe) == NULL) {
        out[0] = '\0';
    }
    pclose(pipe);
    out[strcspn(out, "\n")] = '\0';
    for (char *c = out; *c != '\0'; c++) {
        *c = *c == '"' || *c == '\\' || *c == ',' ? ' ' : *c;
    }
}

typedef struct origin {
    char commit[64], machine[128];
} origin;

static origin find_origin(void) {
    origin o;
    first_line(o.commit, sizeof o.commit, "git describe --always --dirty --abbrev=12 2>/dev/null");
    first_line(o.machine, sizeof o.machine,
               "sed -n 's/^model name[^:]*: //p' /proc/cpuinfo 2>/dev/null | head -n 1");
    return o;
}

static bool write_json(const report *r, const origin *o, FILE *file) {
    fprintf(file, "{\"venule\": \"%s\", \"commit\": \"%s\", \"machine\": \"%s\", \"figures\": [\n",
            vn_version(), o->commit, o->machine);
    for (int i = 0; i < r->count; i++) {
        const figure *f = &r->figures[i];
        fprintf(file, "  {\"bench\": \"%s\", \"name\": \"%s\", \"value\": %.9g, \"unit\": \"%s\"}%s\n",
                f->bench, f->name, f->value, f->unit, i + 1 < r->count ? "," : "");
    }
    return fputs("]}\n", file) >= 0;
}

static bool write_csv(const report *r, const origin *o, FILE *file) {
    fputs("bench,name,value,unit,commit,machine\n", file);
    for (int i = 0; i < r->count; i++) {
        const figure *f = &r->figures[i];
        fprintf(file, "%s,%s,%.9g,%s,%s,%s\n", f->bench, f->name, f->value, f->unit, o->commit, o->machine);
    }
    return true;
}

static bool write_one(const report *r, const origin *o, const char *path,
                      bool (*write)(const report *, const origin *, FILE *)) {
    if (path == NULL) {
        return true;
    }
    FILE *file = fopen(path, "w");
    bool written = file != NULL && write(r, o, file);
    written = file != NULL && fclose(file) == 0 && written;
    if (!written) {
        fprintf(stderr, "bench: %s: cannot be written\n", path);
    }
    return written;
}

bool report_write(const report *r, const char *json, const char *csv) {
    origin o = find_origin();
    bool first = write_one(r, &o, json, write_json);
    return write_one(r, &o, csv, write_csv) && first;
}

static char *read_text(const char *path) {
    enum { LARGEST = 1 << 20 };
    FILE *file = fopen(path, "rb");
    char *text = file != NULL ? calloc(1, LARGEST) : NULL;
    if (text != NULL) {
        size_t count = fread(text, 1, LARGEST - 1, file);
        text[count] = '\0';
    }
    if (file != NULL) {
        fclose(file);
    }
    return text;
}

static const char *text_of(yajl_val object, const char *key) {
    const char *path[] = {key, NULL};
    yajl_val value = yajl_tree_get(object, path, yajl_t_string);
    return value != NULL ? YAJL_GET_STRING(value) : "";
}

static void compare_one(const report *r, yajl_val old) {
    const char *path[] = {"value", NULL};
    yajl_val value = yajl_tree_get(old, path, yajl_t_number);
    for (int i = 0; i < r->count && value != NULL; i++) {
        const figure *f = &r->figures[i];
        if (strcmp(f->bench, text_of(old, "bench")) == 0 && strcmp(f->name, text_of(old, "name")) == 0) {
            double before = YAJL_GET_DOUBLE(value);
            printf("%-18s %-12s %12.6g -> %12.6g %-10s x %.3f\n", f->bench, f->name, before, f->value,
                   f->unit, f->value / before);
        }
    }
}

bool report_compare(const report *r, const char *json) {
    char reason[200] = "it cannot be read";
    char *text = read_text(json);
    yajl_val tree = text != NULL ? yajl_tree_parse(text, reason, sizeof reason) : NULL;
    const char *path[] = {"figures", NULL};
    yajl_val figures = tree != NULL ? yajl_tree_get(tree, path, yajl_t_array) : NULL;
    free(text);
    if (figures == NULL) {
        fprintf(stderr, "bench: %s: no figures to compare with: %s\n", json, reason);
        yajl_tree_free(tree);
        return false;
    }
    printf("compared with %s of %s\n", text_of(tree, "commit"), text_of(tree, "machine"));
    for (size_t i = 0; i < figures->u.array.len; i++) {
        compare_one(r, figures->u.array.values[i]);
    }
    yajl_tree_free(tree);
    return true;
}
