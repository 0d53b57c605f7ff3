// Speed and memory of arterial trees by constrained constructive optimisation.
#include "bench_cco.h"

#include "stopwatch.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

// The default domain: 20,000 mm² or mm³ about the origin.
static vn_domain *organ(int dim) {
    vn_disk_def def = vn_disk_def_default();
    vn_domain *domain;
    def.radius = dim == 2 ? sqrt(20000 / PI) : cbrt(3 * 20000 / (4 * PI));
    bench_must(dim == 2 ? vn_domain_disk(&domain, &def) : vn_domain_sphere(&domain, &def));
    return domain;
}

typedef struct outcome {
    double seconds, volume, bytes; ///< at the peak, a terminal, the finished network included
} outcome;

static outcome grow(int dim, int32_t terminals) {
    vn_cco_def def = vn_cco_def_default();
    vn_cco_tree_def tree = vn_cco_tree_def_default();
    int32_t number, added;
    vn_cco *cco;
    vn_network *network;
    outcome result;
    size_t base = vn_byte_count();
    def.domain = organ(dim);
    def.terminals = terminals;
    tree.root[1] = vn_domain_bounds(def.domain).max[1];
    vn_byte_peak_reset();
    double start = bench_now();
    bench_must(vn_cco_create(&cco, &def));
    bench_must(vn_cco_add(cco, &tree, &number));
    bench_must(vn_cco_grow(cco, terminals, &added));
    bench_must(vn_cco_network(cco, 0, &network));
    result.seconds = bench_now() - start;
    result.volume = vn_cco_report_of(cco, 0).volume;
    result.bytes = (double)(vn_byte_peak() - base) / terminals;
    if (added != terminals || vn_network_count(network) != 2 * terminals) {
        fprintf(stderr, "bench: %d of %d terminals came\n", added, terminals);
        exit(1);
    }
    vn_network_destroy(network);
    vn_cco_destroy(cco);
    vn_domain_release(def.domain);
    return result;
}

static void bench_organ(report *r, double yard, bool quick, int dim) {
    static const int32_t sizes[] = {1000, 4000, 10000, 100000, 1000000};
    int count = quick ? 3 : 5;
    double first = 0, last = 0;
    for (int i = 0; i < count; i++) {
        char name[32];
        outcome best = grow(dim, sizes[i]);
        for (int again = 0; again < 2 && sizes[i] <= 10000; again++) {
            outcome one = grow(dim, sizes[i]);
            best.seconds = fmin(best.seconds, one.seconds);
        }
        snprintf(name, sizeof name, "cco-%s-%d", dim == 2 ? "disk" : "ball", sizes[i]);
        report_add(r, name, "seconds", best.seconds, "s");
        report_add(r, name, "yardsticks", best.seconds / yard, "Y");
        report_add(r, name, "microseconds/terminal", 1e6 * best.seconds / sizes[i], "us");
        report_add(r, name, "bytes/terminal", best.bytes, "B");
        report_add(r, name, "volume", best.volume, "mm3");
        printf("%-18s %8.3f s %8.2f Y %8.1f us/terminal %7.1f B/terminal, volume %.6g mm³\n", name,
               best.seconds, best.seconds / yard, 1e6 * best.seconds / sizes[i], best.bytes, best.volume);
        first = i == 0 ? best.seconds : first;
        last = best.seconds;
    }
    double exponent = log(last / first) / log((double)sizes[count - 1] / sizes[0]);
    report_add(r, dim == 2 ? "cco-disk" : "cco-ball", "exponent", exponent, "");
    printf("%-18s exponent %.3f from %d to %d terminals (goal at most 1.15)\n",
           dim == 2 ? "cco-disk" : "cco-ball", exponent, sizes[0], sizes[count - 1]);
}

void bench_cco(report *r, double yard, bool quick) {
    bench_organ(r, yard, quick, 2);
    bench_organ(r, yard, quick, 3);
}
