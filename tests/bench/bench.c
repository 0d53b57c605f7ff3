// Speed and memory of open venation, in seconds and in yardsticks of the same run. Figures, never a test:
// nothing fails here for being slow.

#include "bench_cco.h"
#include "bench_vessels.h"
#include "report.h"
#include "stopwatch.h"
#include "yardstick.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Space colonisation of a square with one root in the middle, all attractors thrown at once.
typedef struct colony {
    double side;
    int32_t attractors; ///< darts, where there is a spacing
    double within, kill, segment;
    double spacing; ///< 0: none
    int mode;       ///< as vn_influence_def has it: 0 open, 1 closed
} colony;

typedef struct outcome {
    double seconds;
    int32_t nodes, left;
    double bytes_a_node;      ///< of the network alone, when it is grown
    double peak_bytes_a_node; ///< of everything at its peak: attractors, trees, working memory
} outcome;

static vn_domain *square(double side) {
    vn_box_def def = vn_box_def_default();
    vn_domain *domain;
    def.max[0] = def.max[1] = side;
    bench_must(vn_domain_box(&domain, &def));
    return domain;
}

static vn_attractors *thrown(const colony *c, vn_domain *domain) {
    vn_attractors_def set = vn_attractors_def_default();
    vn_attractors *attractors;
    vn_rng rng = vn_rng_make(2005);
    vn_throw_def def = {.domain = domain, .count = c->attractors, .spacing = c->spacing, .rng = &rng};
    int32_t accepted;
    bench_must(vn_attractors_create(&attractors, &set));
    bench_must(vn_throw(attractors, &def, &accepted));
    return attractors;
}

static vn_network *rooted(double side) {
    vn_network_def def = vn_network_def_default();
    vn_network *network;
    double middle[3] = {side / 2, side / 2, 0};
    bench_must(vn_network_create(&network, &def));
    bench_must(vn_network_root(network, middle, NULL));
    return network;
}

static void grow(const colony *c, vn_network *network, vn_attractors *attractors) {
    vn_influence *influence = NULL;
    bool closed = c->mode > 0;
    vn_influence_def find = {.mode = c->mode, .within = c->within};
    vn_extend_def extend = {.length = c->segment, .meet = closed ? VN_MEET_JOIN : VN_MEET_CROSS};
    vn_consume_def consume = {.distance = c->kill, .mode = closed ? VN_CONSUME_TAGGED : VN_CONSUME_ANY};
    int32_t added, first, consumed;
    do {
        bench_must(vn_influence_find(&influence, attractors, network, &find));
        bench_must(vn_extend(network, influence, &extend, &added, &first));
        bench_must(vn_consume(attractors, network, &consume, &consumed));
    } while (added > 0);
    vn_influence_destroy(influence);
}

static outcome run_once(const colony *c) {
    outcome result = {0};
    size_t base = vn_byte_count();
    vn_byte_peak_reset();
    vn_domain *domain = square(c->side);
    double begin = bench_now();
    vn_attractors *attractors = thrown(c, domain);
    begin = c->spacing > 0 ? bench_now() : begin; // there the sources are given
    vn_network *network = rooted(c->side);
    grow(c, network, attractors);
    result.seconds = bench_now() - begin;
    result.nodes = vn_network_count(network);
    result.left = vn_attractors_count(attractors);
    result.peak_bytes_a_node = (double)(vn_byte_peak() - base) / result.nodes;
    vn_attractors_destroy(attractors);
    vn_domain_release(domain);
    result.bytes_a_node = (double)(vn_byte_count() - base) / result.nodes;
    vn_network_destroy(network);
    return result;
}

// The least of several runs: what disturbs a run only ever adds to it.
static outcome run(const colony *c, int times) {
    outcome best = run_once(c);
    for (int i = 1; i < times; i++) {
        outcome next = run_once(c);
        best.seconds = next.seconds < best.seconds ? next.seconds : best.seconds;
    }
    return best;
}

static void report_outcome(report *r, const char *name, const outcome *o, double yard) {
    printf("%-18s %9d nodes %6d left %9.4f s %7.3f Y %9.0f nodes/s %6.1f bytes/node (peak of all %6.1f)\n",
           name, o->nodes, o->left, o->seconds, o->seconds / yard, o->nodes / o->seconds, o->bytes_a_node,
           o->peak_bytes_a_node);
    report_add(r, name, "seconds", o->seconds, "s");
    report_add(r, name, "yardsticks", o->seconds / yard, "Y");
    report_add(r, name, "nodes", o->nodes, "nodes");
    report_add(r, name, "speed", o->nodes / o->seconds, "nodes/s");
    report_add(r, name, "network", o->bytes_a_node, "bytes/node");
    report_add(r, name, "peak", o->peak_bytes_a_node, "bytes/node");
}

// The slope of log seconds against log attractors, by least squares.
static double fitted_exponent(const double *sizes, const double *seconds, int count) {
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (int i = 0; i < count; i++) {
        double x = log(sizes[i]), y = log(seconds[i]);
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
    }
    return (count * sxy - sx * sy) / (count * sxx - sx * sx);
}

static void goal(const char *what, double value, double most) {
    printf("  %-42s %8.3f  goal %g: %s\n", what, value, most, value <= most ? "met" : "missed");
}

// N attractors in the unit square: segment N^-½ / 2, kill N^-½, reach 8 N^-½.
static void bench_open(report *r, double yard, bool quick) {
    enum { SIZES = 4 };
    static const int32_t all[SIZES] = {1000, 10000, 100000, 1000000};
    static const int times[SIZES] = {20, 10, 5, 3};
    double sizes[SIZES], seconds[SIZES];
    int count = quick ? SIZES - 1 : SIZES;
    outcome last = {0};
    for (int i = 0; i < count; i++) {
        double unit = 1 / sqrt(all[i]);
        colony c = {1, all[i], 8 * unit, unit, unit / 2, 0, 0};
        char name[32];
        last = run(&c, times[i]);
        snprintf(name, sizeof name, "open-%d", all[i]);
        report_outcome(r, name, &last, yard);
        sizes[i] = all[i];
        seconds[i] = last.seconds;
    }
    double exponent = fitted_exponent(sizes, seconds, count);
    report_add(r, "open", "exponent", exponent, "");
    goal("exponent of seconds against attractors", exponent, 1.1);
    goal("bytes a node, network", last.bytes_a_node, 96);
    goal("bytes a node, peak of everything", last.peak_bytes_a_node, 96);
    if (!quick) {
        goal("10^6 attractors, yardsticks", last.seconds / yard, 4);
    }
}

// Webb's own case: 100,000 attractors in a square of 1000, reach 30, kill 5, segment 5.
static void bench_webb(report *r, double yard, bool quick) {
    colony c = {1000, 100000, 30, 5, 5, 0, 0};
    (void)quick;
    outcome o = run(&c, 10);
    report_outcome(r, "webb-100000", &o, yard);
    goal("Webb's case, yardsticks (his own: 18.6)", o.seconds / yard, 0.2);
}

// Sources two segments apart and more, in the density at which darts have become rare.
static void bench_closed(report *r, double yard, bool quick) {
    enum { SIZES = 3 };
    static const double sides[SIZES] = {134, 424, 1340};
    static const int times[SIZES] = {5, 3, 2};
    double sizes[SIZES], seconds[SIZES];
    int count = quick ? SIZES - 1 : SIZES;
    outcome last = {0};
    for (int i = 0; i < count; i++) {
        double side = sides[i];
        colony c = {side, (int32_t)(1.2 * side * side), 16, 1, 1, 2, 1};
        char name[32];
        last = run(&c, times[i]);
        snprintf(name, sizeof name, "closed-%.0f", side);
        report_outcome(r, name, &last, yard);
        sizes[i] = last.nodes;
        seconds[i] = last.seconds;
    }
    double exponent = fitted_exponent(sizes, seconds, count);
    report_add(r, "closed", "exponent", exponent, "");
    goal("closed: exponent of seconds against nodes", exponent, 1.1);
    if (!quick) {
        goal("closed: yardsticks for 10^6 nodes", last.seconds / yard * 1e6 / last.nodes, 10);
    }
}

// An ovate blade with a pointed tip, of about as many nodes as the paper has.
static vn_domain *poplar_blade(void) {
    enum { SAMPLES = 200 };
    double half_width[SAMPLES];
    for (int i = 0; i < SAMPLES; i++) {
        double t = (double)i / (SAMPLES - 1);
        half_width[i] = 0.41 * pow(sin(3.14159265358979 * pow(t, 0.55)), 0.8);
    }
    vn_profile_def def = vn_profile_def_default();
    vn_domain *blade;
    def.half_width = half_width;
    def.samples = SAMPLES;
    bench_must(vn_domain_profile(&blade, &def));
    return blade;
}

/// The poplar of Table 1, as READINGS R7 reads it.
typedef struct poplar {
    vn_growth *growth;
    vn_network *network;
    vn_attractors *auxin;
    vn_influence *influence;
    vn_rng rng;
    int mode;
} poplar;

static int32_t poplar_vein_step(poplar *p) {
    double unit = vn_growth_unit(p->growth);
    vn_influence_def find = {.mode = p->mode};
    vn_extend_def extend = {.length = unit, .domain = vn_growth_domain(p->growth), .meet = VN_MEET_JOIN};
    vn_consume_def consume = {.distance = unit, .mode = VN_CONSUME_TAGGED};
    int32_t added, first, consumed;
    bench_must(vn_influence_find(&p->influence, p->auxin, p->network, &find));
    bench_must(vn_extend(p->network, p->influence, &extend, &added, &first));
    bench_must(vn_consume(p->auxin, p->network, &consume, &consumed));
    return added;
}

static bool poplar_step(poplar *p) {
    bool growing;
    int32_t added = 0, accepted;
    bench_must(vn_growth_advance(p->growth, &growing));
    if (growing) {
        double unit = vn_growth_unit(p->growth);
        vn_throw_def throw = {.domain = vn_growth_domain(p->growth),
                              .density = 200e-6 / (unit * unit),
                              .spacing = 2 * unit,
                              .clearance = 2 * unit,
                              .network = p->network,
                              .rng = &p->rng};
        bench_must(vn_throw(p->auxin, &throw, &accepted));
    }
    for (int i = 0; i < 3; i++) {
        added += poplar_vein_step(p);
    }
    return growing || added > 0;
}

static outcome grow_poplar(int mode) {
    outcome result = {0};
    poplar p = {.rng = vn_rng_make(2005), .mode = mode};
    vn_growth_def def = vn_growth_def_default();
    vn_network_def net = vn_network_def_default();
    vn_attractors_def set = vn_attractors_def_default();
    double petiole[3] = {0, 0, 0};
    size_t base = vn_byte_count();
    vn_byte_peak_reset();
    def.domain = poplar_blade();
    def.from = 115;
    def.to = 3500;
    def.step = 9;
    bench_must(vn_growth_isogonic(&p.growth, &def));
    bench_must(vn_network_create(&p.network, &net));
    bench_must(vn_network_root(p.network, petiole, NULL));
    bench_must(vn_attractors_create(&p.auxin, &set));
    double begin = bench_now();
    while (poplar_step(&p)) {
    }
    result.seconds = bench_now() - begin;
    result.nodes = vn_network_count(p.network);
    result.left = vn_attractors_count(p.auxin);
    result.peak_bytes_a_node = (double)(vn_byte_peak() - base) / result.nodes;
    vn_influence_destroy(p.influence);
    vn_attractors_destroy(p.auxin);
    vn_growth_release(p.growth);
    vn_domain_release(def.domain);
    result.bytes_a_node = (double)(vn_byte_count() - base) / result.nodes;
    vn_network_destroy(p.network);
    return result;
}

static void bench_poplar(report *r, double yard, bool quick) {
    outcome best[2];
    for (int i = 0; i < (quick ? 1 : 2); i++) {
        for (int mode = 1; mode <= 2; mode++) {
            outcome one = grow_poplar(mode);
            bool better = i == 0 || one.seconds < best[mode - 1].seconds;
            best[mode - 1] = better ? one : best[mode - 1];
        }
    }
    report_outcome(r, "poplar-relative", &best[0], yard);
    report_outcome(r, "poplar-urquhart", &best[1], yard);
    goal("poplar, relative neighbors, yardsticks", best[0].seconds / yard, 5);
    goal("poplar, relative against Urquhart", best[0].seconds / best[1].seconds, 1.2);
    report_add(r, "poplar", "relative/urquhart", best[0].seconds / best[1].seconds, "");
}

static const struct {
    const char *name;
    void (*run)(report *r, double yard, bool quick);
} benches[] = {{"open", bench_open},     {"webb", bench_webb}, {"closed", bench_closed},
               {"poplar", bench_poplar}, {"cco", bench_cco},   {"vessels", bench_vessels}};

enum { BENCHES = sizeof benches / sizeof *benches };

typedef struct bench_options {
    const char *json, *csv, *compare;
    bool quick;
    const char *names[BENCHES];
    int count;
} bench_options;

static bool is_bench(const char *name) {
    for (int i = 0; i < BENCHES; i++) {
        if (strcmp(benches[i].name, name) == 0) {
            return true;
        }
    }
    return false;
}

static bool read_options(bench_options *o, int argc, char **argv) {
    for (int i = 1; i < argc; i++) {
        const char **file = strcmp(argv[i], "--json") == 0      ? &o->json
                            : strcmp(argv[i], "--csv") == 0     ? &o->csv
                            : strcmp(argv[i], "--compare") == 0 ? &o->compare
                                                                : NULL;
        if (file != NULL && i + 1 < argc) {
            *file = argv[++i];
        } else if (strcmp(argv[i], "--quick") == 0) {
            o->quick = true;
        } else if (is_bench(argv[i]) && o->count < BENCHES) {
            o->names[o->count++] = argv[i];
        } else {
            fprintf(stderr,
                    "bench: unknown word %s (venule-bench [open] [webb] [closed] [poplar] [cco] [vessels] "
                    "[--quick] "
                    "[--json "
                    "FILE] "
                    "[--csv FILE] "
                    "[--compare FILE.json])\n",
                    argv[i]);
            return false;
        }
    }
    return true;
}

static bool wanted(const bench_options *o, const char *name) {
    for (int i = 0; i < o->count; i++) {
        if (strcmp(o->names[i], name) == 0) {
            return true;
        }
    }
    return o->count == 0;
}

int main(int argc, char **argv) {
    bench_options options = {0};
    report r = {0};
    if (!read_options(&options, argc, argv)) {
        return 2;
    }
    vn_set_threads(1);
    double yard = vn_yardstick(1000000);
    if (yard <= 0) {
        fprintf(stderr, "bench: the yardstick failed\n");
        return 1;
    }
    printf("yardstick Y: CGAL's Delaunay triangulation of 1,000,000 points took %.3f s\n", yard);
    report_add(&r, "yardstick", "seconds", yard, "s");
    for (int i = 0; i < BENCHES; i++) {
        if (wanted(&options, benches[i].name)) {
            benches[i].run(&r, yard, options.quick);
        }
    }
    bool written = report_write(&r, options.json, options.csv);
    bool compared = options.compare == NULL || report_compare(&r, options.compare);
    return written && compared ? 0 : 4;
}
