#include "draw/ramp.h"

#include "base/schema.h"

#include <math.h>
#include <stdio.h>

enum { MOST_STOPS = 32, LONGEST_COLOR = 32 };

typedef struct stops {
    vn_color colors[MOST_STOPS];
    int count;
} stops;

static vn_status add_stop(stops *to, const char *word, size_t length) {
    char text[LONGEST_COLOR + 1];
    if (to->count == MOST_STOPS) {
        return vn_fail(VN_INVALID, "stroke.ramp: %d colours are the limit", MOST_STOPS);
    }
    snprintf(text, sizeof text, "%.*s", (int)(length < LONGEST_COLOR ? length : LONGEST_COLOR), word);
    vn_color *color = &to->colors[to->count++];
    VN_TRY(vn_color_parse(color, text, "stroke.ramp"));
    if (color->alpha != 255) {
        return vn_fail(VN_INVALID, "stroke.ramp: \"%s\" must be opaque; opacity holds for all", text);
    }
    return VN_OK;
}

static vn_status read_stops(stops *to, const char *ramp) {
    for (size_t length; *ramp != '\0'; ramp += length) {
        ramp += strspn(ramp, " ,");
        length = strcspn(ramp, " ,");
        if (length > 0) {
            VN_TRY(add_stop(to, ramp, length));
        }
    }
    if (to->count < 2) {
        return vn_fail(VN_INVALID, "stroke.ramp has %d colours: give two or more, between spaces", to->count);
    }
    return VN_OK;
}

static uint32_t mixed(uint8_t a, uint8_t b, double share) {
    return (uint32_t)(a + share * (b - a) + 0.5);
}

static uint32_t color_at(const stops *from, double share) {
    double at = share * (from->count - 1);
    int i = at < from->count - 1 ? (int)at : from->count - 2;
    const vn_color *a = &from->colors[i], *b = a + 1;
    at -= i;
    return mixed(a->red, b->red, at) << 16 | mixed(a->green, b->green, at) << 8 | mixed(a->blue, b->blue, at);
}

vn_status vn_ramp_colors(vn_rgb_array *out, const double *values, int32_t count, const char *ramp,
                         vn_color otherwise) {
    stops read = {.count = 0};
    double least = INFINITY, greatest = -INFINITY;
    VN_TRY(read_stops(&read, ramp));
    VN_TRY(vn_array_reserve(out, count));
    for (int32_t i = 0; i < count; i++) {
        least = isfinite(values[i]) ? fmin(least, values[i]) : least;
        greatest = isfinite(values[i]) ? fmax(greatest, values[i]) : greatest;
    }
    for (int32_t i = 0; i < count; i++) {
        double share = greatest > least ? (values[i] / 2 - least / 2) / (greatest / 2 - least / 2) : 0;
        uint32_t plain = (uint32_t)otherwise.red << 16 | (uint32_t)otherwise.green << 8 | otherwise.blue;
        out->data[i] = isfinite(values[i]) ? color_at(&read, share) : plain;
    }
    out->count = count;
    return VN_OK;
}

typedef struct columns {
    const int32_t *whole;
    const double *real;
} columns;

static bool has_radii(const vn_network *network) {
    for (int32_t i = 0; i < vn_network_count(network); i++) {
        if (vn_network_radius(network, i) > 0) {
            return true;
        }
    }
    return vn_network_count(network) == 0;
}

static vn_status find_column(columns *found, const vn_network *network, int which) {
    switch (which) {
    case 1:
        found->whole = vn_network_orders(network);
        return found->whole != NULL ? VN_OK
                                    : vn_fail(VN_INVALID, "stroke.color_by = \"order\": no orders are known; "
                                                          "compute them first");
    case 2:
        found->whole = vn_network_tree(network);
        return VN_OK;
    case 3:
        found->whole = vn_network_birth(network);
        return VN_OK;
    case 4:
        found->real = vn_network_flow(network);
        return found->real != NULL ? VN_OK
                                   : vn_fail(VN_INVALID, "stroke.color_by = \"flow\": no flow is known");
    case 5:
        found->real = vn_network_pressure(network);
        return found->real != NULL ? VN_OK
                                   : vn_fail(VN_INVALID, "stroke.color_by = \"pressure\": none is known");
    default:
        return has_radii(network) ? VN_OK
                                  : vn_fail(VN_INVALID, "stroke.color_by = \"radius\": no radii are known");
    }
}

static double value_of(const vn_network *network, const columns *from, int which, int32_t node) {
    if (from->whole != NULL) {
        return from->whole[node];
    }
    double value = from->real != NULL ? from->real[node] : vn_network_radius(network, node);
    return which == 0 || which == 4 ? log(value) : value;
}

vn_status vn_column_values(vn_values *out, const vn_network *network, const char *name) {
    static const char choices[] = "radius|order|tree|birth|flow|pressure";
    int which = vn_choice_index(choices, name);
    columns found = {0};
    if (which < 0) {
        return vn_fail(VN_INVALID, "stroke.color_by = \"%.40s\" must be one of %s", name, choices);
    }
    VN_TRY(find_column(&found, network, which));
    VN_TRY(vn_array_reserve(out, vn_network_count(network)));
    out->count = vn_network_count(network);
    for (int32_t i = 0; i < out->count; i++) {
        bool root = vn_network_parent(network)[i] < 0;
        out->data[i] = root ? NAN : value_of(network, &found, which, i);
    }
    return VN_OK;
}
