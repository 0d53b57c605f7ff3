/// The figures of a bench run, with what is needed to compare them later: unit, commit, machine.
#ifndef VN_BENCH_REPORT_H
#define VN_BENCH_REPORT_H

#include <stdbool.h>

typedef struct figure {
    char bench[32];
    char name[32];
    char unit[16];
    double value;
} figure;

enum { MOST_FIGURES = 256 };

typedef struct report {
    figure figures[MOST_FIGURES];
    int count;
} report;

void report_add(report *r, const char *bench, const char *name, double value, const char *unit);

/// Write JSON and CSV; a NULL path is passed over. False after saying what could not be written.
bool report_write(const report *r, const char *json, const char *csv);

/// Print each figure beside that of an earlier JSON file, and their ratio.
bool report_compare(const report *r, const char *json);

#endif
