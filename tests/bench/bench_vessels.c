// Speed and memory of vessels (Rauch & Harders 2021), by the loop of lua/venule/vessels.lua in C.
#include "bench_vessels.h"

#include "stopwatch.h"

#include <math.h>
#include <string.h>

/// One stage; lengths at the size that the tissue has at first.
typedef struct stage {
    int32_t steps, darts;
    double spacing, clearance, satisfaction, sight, vein_sight, length, angle, bias, kappa;
} stage;

typedef struct organ {
    vn_domain *domain;
    vn_network *net[2]; ///< arteries and veins
    vn_attractors *points[2];
    vn_influence *influence[2];
    vn_rng rng;
    double sigma; ///< size of the tissue, by its size at first
    bool veins;
} organ;

static organ organ_of(vn_domain *domain, bool veins) {
    organ o = {.domain = domain, .rng = vn_rng_make(2021), .sigma = 1, .veins = veins};
    for (int i = 0; i < 2; i++) {
        vn_network_def net = vn_network_def_default();
        vn_attractors_def set = vn_attractors_def_default();
        net.dim = set.dim = vn_domain_dim(domain);
        bench_must(vn_network_create(&o.net[i], &net));
        bench_must(vn_attractors_create(&o.points[i], &set));
    }
    return o;
}

static void end_organ(organ *o) {
    for (int i = 0; i < 2; i++) {
        vn_influence_destroy(o->influence[i]);
        vn_network_destroy(o->net[i]);
        vn_attractors_destroy(o->points[i]);
    }
    vn_domain_release(o->domain);
}

static void put_root(vn_network *net, double x, double y) {
    double p[3] = {x, y, 0};
    bench_must(vn_network_root(net, p, NULL));
}

static void throw_drains(organ *o, const stage *s, double unit) {
    vn_throw_def def = vn_throw_def_default();
    int32_t accepted;
    def.domain = o->domain;
    def.count = s->darts;
    def.spacing = s->spacing * unit;
    def.clearance = s->clearance * unit;
    def.network = o->net[0];
    def.rng = &o->rng;
    bench_must(vn_throw(o->points[0], &def, &accepted));
}

static void grow(organ *o, const stage *s, int kind, double unit) {
    vn_murray_def law = {.exponent = s->kappa, .tip_radius = 0.0005 * unit};
    vn_influence_def see = vn_influence_def_default();
    vn_extend_def extend = vn_extend_def_default();
    vn_consume_def consume = vn_consume_def_default();
    int32_t added, first, consumed;
    bench_must(vn_network_murray(o->net[kind], &law));
    see.within = (kind == 0 ? s->sight : s->vein_sight) * unit;
    see.perception = (vn_perception){s->angle, true};
    extend.length = s->length * unit;
    extend.domain = o->domain;
    extend.bias = s->bias;
    extend.bias_mean = true;
    extend.bifurcate = 15;
    consume.distance = s->satisfaction * unit;
    consume.into = kind == 0 && o->veins ? o->points[1] : NULL;
    bench_must(vn_influence_find(&o->influence[kind], o->points[kind], o->net[kind], &see));
    bench_must(vn_extend(o->net[kind], o->influence[kind], &extend, &added, &first));
    bench_must(vn_consume(o->points[kind], o->net[kind], &consume, &consumed));
}

static double step(organ *o, const stage *s) {
    double start = bench_now(), unit = 1 / o->sigma;
    throw_drains(o, s, unit);
    grow(o, s, 0, unit);
    if (o->veins) {
        grow(o, s, 1, unit);
    }
    o->sigma += 0.02;
    return bench_now() - start;
}

static int by_size(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static int32_t nodes_of(const organ *o) {
    return vn_network_count(o->net[0]) + (o->veins ? vn_network_count(o->net[1]) : 0);
}

enum { LATE = 25 }; // the last steps are those of the live model

typedef struct outcome {
    double seconds, late; ///< of the whole run; the median of the last steps
    int32_t nodes;
} outcome;

static outcome run(organ *o, const stage *stages, int count) {
    outcome out = {0};
    double late[LATE] = {0};
    int64_t n = 0;
    for (int k = 0; k < count; k++) {
        for (int32_t i = 0; i < stages[k].steps; i++, n++) {
            late[n % LATE] = step(o, &stages[k]);
            out.seconds += late[n % LATE];
        }
    }
    qsort(late, LATE, sizeof *late, by_size);
    out.late = late[LATE / 2];
    out.nodes = nodes_of(o);
    return out;
}

static organ disk(bool veins) {
    vn_disk_def def = vn_disk_def_default();
    vn_domain *domain;
    def.radius = 0.5;
    bench_must(vn_domain_disk(&domain, &def));
    organ o = organ_of(domain, veins);
    put_root(o.net[0], -0.5, 0);
    put_root(o.net[1], -0.49, -0.09);
    return o;
}

// Figure 5 of the paper: scripts/vessels_disk.lua.
static outcome figure5(bool veins, int32_t steps) {
    stage s = {steps, 1000, 0.03, 0.04, 0.03, 0.065, 0.1, veins ? 0.022 : 0.03, 90, 0.5, 2.55};
    organ o = disk(veins);
    outcome out = run(&o, &s, 1);
    end_organ(&o);
    return out;
}

// scripts/retina.lua, in units of its 3 mm.
static outcome retina(void) {
    static const stage stages[2] = {
        {100, 2000, 0.045, 0.06, 0.045, 0.0975, 0.195, 0.1 / 3, 50, 0.3, 2.55},
        {150, 2000, 0.0225, 0.03, 0.0225, 0.04875, 0.0975, 0.1 / 3, 90, 0, 2.9},
    };
    vn_box_def slab = {.dim = 3, .min = {-0.5, -0.5, -0.00655}, .max = {0.5, 0.5, 0.00655}};
    vn_disk_def middle = {.radius = 0.44 / 3};
    vn_domain *box, *fovea, *tissue;
    bench_must(vn_domain_box(&box, &slab));
    bench_must(vn_domain_sphere(&fovea, &middle));
    bench_must(vn_domain_combine(&tissue, box, fovea, VN_DIFFERENCE));
    vn_domain_release(box);
    vn_domain_release(fovea);
    organ o = organ_of(tissue, true);
    for (int i = 0; i < 16; i++) {
        double x = 0.5 * ((i % 4 + 0.5) / 2 - 1), y = -0.5;
        for (int turn = 0; turn < i / 4; turn++) {
            double t = x;
            x = -y;
            y = t;
        }
        put_root(o.net[i % 2], x, y);
    }
    outcome out = run(&o, stages, 2);
    end_organ(&o);
    return out;
}

// Arteries that fill a ball as it grows, until there are so many nodes.
static outcome ball(int32_t nodes, double *bytes) {
    vn_disk_def def = vn_disk_def_default();
    vn_domain *domain;
    outcome out = {0};
    def.radius = 0.5;
    bench_must(vn_domain_sphere(&domain, &def));
    size_t base = vn_byte_count();
    vn_byte_peak_reset();
    organ o = organ_of(domain, false);
    put_root(o.net[0], -0.5, 0);
    while (nodes_of(&o) < nodes && o.sigma < 100) {
        stage s = {1,    1000 + (int32_t)(100 * o.sigma * o.sigma * o.sigma),
                   0.03, 0.04,
                   0.03, 0.065,
                   0,    0.03,
                   90,   0.5,
                   2.55};
        out.late = step(&o, &s);
        out.seconds += out.late;
    }
    out.nodes = nodes_of(&o);
    *bytes = (double)(vn_byte_peak() - base) / out.nodes;
    end_organ(&o);
    return out;
}

static void show(report *r, const char *name, const outcome *o, double yard, double goal) {
    report_add(r, name, "seconds", o->seconds, "s");
    report_add(r, name, "yardsticks", o->seconds / yard, "Y");
    report_add(r, name, "nodes", o->nodes, "");
    report_add(r, name, "late step", 1000 * o->late, "ms");
    printf("%-18s %8.4f s %8.4f Y (goal %g) %9d nodes %6.2f us/node, a late step %.3f ms\n", name, o->seconds,
           o->seconds / yard, goal, o->nodes, 1e6 * o->seconds / o->nodes, 1000 * o->late);
}

static outcome best_disk(bool veins, int32_t steps, int times) {
    outcome best = figure5(veins, steps);
    for (int i = 1; i < times; i++) {
        outcome one = figure5(veins, steps);
        best = one.seconds < best.seconds ? one : best;
    }
    return best;
}

static void bench_balls(report *r, double yard, bool quick) {
    static const int32_t sizes[] = {10000, 100000, 1000000};
    outcome first = {0}, last = {0};
    for (int i = 0; i < (quick ? 2 : 3); i++) {
        char name[32];
        double bytes;
        last = ball(sizes[i], &bytes);
        first = i == 0 ? last : first;
        snprintf(name, sizeof name, "vessels-ball-%d", sizes[i]);
        show(r, name, &last, yard, i == 2 ? 20 : 2 * pow(10, i - 1));
        report_add(r, name, "peak bytes/node", bytes, "B");
        printf("%-18s %.0f bytes/node at the peak, drains included\n", name, bytes);
    }
    double exponent = log(last.seconds / first.seconds) / log((double)last.nodes / first.nodes);
    report_add(r, "vessels-ball", "exponent", exponent, "");
    printf("%-18s exponent %.3f from %d to %d nodes (goal at most 1.1)\n", "vessels-ball", exponent,
           first.nodes, last.nodes);
}

void bench_vessels(report *r, double yard, bool quick) {
    outcome o = best_disk(true, 100, 9);
    show(r, "vessels-disk", &o, yard, 0.02);
    o = best_disk(false, 100, 9);
    show(r, "vessels-arteries", &o, yard, 0.02);
    o = best_disk(false, 800, 3);
    show(r, "vessels-disk-800", &o, yard, 0.12);
    o = best_disk(true, 800, 3);
    show(r, "vessels-both-800", &o, yard, 0.24);
    o = retina();
    show(r, "vessels-retina", &o, yard, 0.15);
    bench_balls(r, yard, quick);
}
