// What anatomists measure, as far as a network tells it without its domain.

#include "host/info.h"

#include <stdio.h>

static void print_statistics(const char *name, const vn_statistics *s, const char *note) {
    printf("  %-12s mean %g ± %g, median %g, quartiles %g to %g%s\n", name, s->mean, s->deviation, s->median,
           s->lower, s->upper, note);
}

static void print_murray(const vn_vessel_measures *m) {
    if (m->murray.count > 0) {
        printf("  Murray's law r^%g missed by %g in the mean, %g rms, at most %g (node %d)\n", m->exponent,
               m->murray.mean, m->murray_rms, m->murray.max, m->murray_worst);
    }
    if (m->fitted.count > 0) {
        printf("    fitted     exponents median %g, quartiles %g to %g   in arteries: 2.7 to 2.9 (Marchesi "
               "2026)\n",
               m->fitted.median, m->fitted.lower, m->fitted.upper);
    }
}

static void print_forks(const vn_vessel_measures *m) {
    if (m->ratio.count > 0) {
        print_statistics("daughters", &m->ratio, "   r2/r1; coronary casts: median 0.76 (Anat. Rec. 1998)");
        print_statistics("expansion", &m->expansion,
                         "   (r1² + r2²)/r0²; coronary casts: 0.93 ± 0.26 (Anat. Rec. 1998)");
    }
    if (m->between.count > 0) {
        print_statistics("daughters at", &m->between, " degrees   retina: 78 (Luo 2017)");
    }
    for (int32_t k = 0; k < m->bin_count; k++) {
        const vn_fork_bin *bin = &m->bins[k];
        if (bin->count > 0) {
            printf("    r2/r1 %.2g: %.4g° ± %.3g (%d)   Murray's %.4g°\n", bin->ratio, bin->between.mean,
                   bin->between.deviation, bin->count, bin->theory.between);
        }
    }
}

static void print_orders(const vn_vessel_measures *m) {
    for (int32_t k = 0; k < m->order_count; k++) {
        const vn_vessel_order *order = &m->orders[k];
        printf("    Strahler %-2d %d elements, diameter %g ± %g, length %g ± %g; %d segments of %g and %g\n",
               k + 1, order->elements, order->element_diameter.mean, order->element_diameter.deviation,
               order->element_length.mean, order->element_length.deviation, order->segments,
               order->segment_diameter.mean, order->segment_length.mean);
    }
    if (m->order_count > 1) {
        printf("  from order to order: counts by %.4g, diameters by %.4g, lengths by %.4g\n",
               m->bifurcation_ratio.ratio, m->diameter_ratio.ratio, m->length_ratio.ratio);
    }
}

vn_status vessel_info_measure(vessel_info *info, const vn_network *network) {
    vn_vessel_measures_def def = vn_vessel_measures_def_default();
    vn_boxes_def boxes = vn_boxes_def_default();
    info->boxes = (vn_boxes){0};
    vn_status status = vn_network_measure_vessels(network, &def, &info->measures);
    return status == VN_OK && info->measures.segments > 0
               ? vn_network_measure_boxes(network, &boxes, &info->boxes)
               : status;
}

void vessel_info_print(const vessel_info *info) {
    const vn_vessel_measures *m = &info->measures;
    const vn_boxes *boxes = &info->boxes;
    if (m->segments == 0) {
        return;
    }
    print_murray(m);
    print_forks(m);
    print_orders(m);
    print_statistics("tortuosity", &m->segment_tortuosity, "   arc by chord, of segments");
    printf("  dimension    %.4g by boxes of %g to %g, r² %.4g\n", boxes->dimension, boxes->side[0],
           boxes->side[boxes->sizes - 1], boxes->r2);
}

// ---- JSON, in the shape of net:measure_vessels() and net:measure_boxes(); nodes count from 0 ----

static void json_spread(const char *name, const vn_spread *spread) {
    printf(", \"%s\": {", name);
    json_number("", "mean", spread->mean);
    json_number(", ", "deviation", spread->deviation);
    printf("}");
}

static void json_angles_of(const vn_fork_bin *bin) {
    printf(", \"ratio\": %.17g", bin->ratio);
    json_spread("between", &bin->between);
    json_spread("thick", &bin->thick);
    json_spread("thin", &bin->thin);
    printf(", \"theory\": {\"between\": %.17g, \"thick\": %.17g, \"thin\": %.17g}", bin->theory.between,
           bin->theory.thick, bin->theory.thin);
}

static void json_bins(const vn_vessel_measures *m) {
    printf(", \"bins\": [");
    for (int32_t k = 0; k < m->bin_count; k++) {
        const vn_fork_bin *bin = &m->bins[k];
        printf("%s{\"from\": %.17g, \"to\": %.17g, \"count\": %d", k > 0 ? ", " : "",
               (double)k / m->bin_count, (k + 1.0) / m->bin_count, bin->count);
        if (bin->count > 0) {
            json_angles_of(bin);
        }
        printf("}");
    }
    printf("]");
}

static void json_part(const char *name, int32_t count, const vn_spread *diameter, const vn_spread *length) {
    printf("\"%s\": {\"count\": %d", name, count);
    json_spread("diameter", diameter);
    json_spread("length", length);
    printf("}");
}

static void json_orders(const vn_vessel_measures *m) {
    printf(", \"orders\": [");
    for (int32_t k = 0; k < m->order_count; k++) {
        const vn_vessel_order *order = &m->orders[k];
        printf(k > 0 ? ", {" : "{");
        json_part("segments", order->segments, &order->segment_diameter, &order->segment_length);
        printf(", ");
        json_part("elements", order->elements, &order->element_diameter, &order->element_length);
        printf("}");
    }
    printf("]");
}

static void json_order_ratio(const char *name, const vn_order_ratio *ratio) {
    printf(", \"%s\": {", name);
    json_number("", "ratio", ratio->ratio);
    json_number(", ", "r2", ratio->r2);
    printf("}");
}

static void json_boxes(const vn_boxes *boxes) {
    printf(", \"boxes\": {\"dimension\": %.17g, \"r2\": %.17g, \"extent\": %.17g, \"boxes\": [",
           boxes->dimension, boxes->r2, boxes->extent);
    for (int32_t k = 0; k < boxes->sizes; k++) {
        printf("%s{\"side\": %.17g, \"count\": %lld}", k > 0 ? ", " : "", boxes->side[k],
               (long long)boxes->count[k]);
    }
    printf("]}");
}

static void json_angles(const vn_vessel_measures *m) {
    printf(", \"angles\": {\"between\": {");
    json_numbers(&m->between);
    printf("}");
    json_statistics("thick", &m->thick);
    json_statistics("thin", &m->thin);
    json_bins(m);
    printf("}");
}

static void json_curves(const char *name, const vn_statistics *segments, const vn_statistics *elements) {
    printf(", \"%s\": {\"segments\": {", name);
    json_numbers(segments);
    printf("}");
    json_statistics("elements", elements);
    printf("}");
}

static void json_measures(const vn_vessel_measures *m) {
    printf(", \"vessels\": {\"exponent\": %.17g, \"bifurcations\": %d, \"furcations\": %d, \"segments\": %d, "
           "\"elements\": %d",
           m->exponent, m->bifurcations, m->furcations, m->segments, m->elements);
    printf(", \"murray\": {");
    json_number("", "rms", m->murray_rms);
    printf(", ");
    if (m->murray_worst >= 0) {
        printf("\"worst\": %d, ", m->murray_worst);
    }
    json_numbers(&m->murray);
    printf("}");
    json_statistics("fitted", &m->fitted);
    json_statistics("ratio", &m->ratio);
    json_statistics("expansion", &m->expansion);
    json_angles(m);
    json_orders(m);
    json_order_ratio("bifurcation_ratio", &m->bifurcation_ratio);
    json_order_ratio("diameter_ratio", &m->diameter_ratio);
    json_order_ratio("length_ratio", &m->length_ratio);
    json_curves("tortuosity", &m->segment_tortuosity, &m->element_tortuosity);
    json_curves("curvature", &m->segment_curvature, &m->element_curvature);
    printf("}");
}

void vessel_info_json(const vessel_info *info) {
    json_measures(&info->measures);
    json_boxes(&info->boxes);
}
