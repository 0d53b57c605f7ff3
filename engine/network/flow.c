// What flows through a network, and at which pressure.
#include "network/network.h"

static vn_status check_finite(const double *values, int32_t count, const char *what) {
    for (int32_t i = 0; i < count; i++) {
        if (!(fabs(values[i]) <= VN_HUGE)) {
            return vn_fail(VN_INVALID, "node %d has the %s %g, which must be finite", i, what, values[i]);
        }
    }
    return VN_OK;
}

vn_status vn_network_set_flow(vn_network *network, const double *flow, const double *pressure) {
    int32_t count = network->x.count;
    VN_TRY(check_finite(flow, count, "flow"));
    VN_TRY(pressure != NULL ? check_finite(pressure, count, "pressure") : VN_OK);
    VN_TRY(vn_array_reserve(&network->flow, count));
    VN_TRY(pressure != NULL ? vn_array_reserve(&network->pressure, count) : VN_OK);
    if (count > 0) {
        memcpy(network->flow.data, flow, (size_t)count * sizeof *flow);
    }
    if (count > 0 && pressure != NULL) {
        memcpy(network->pressure.data, pressure, (size_t)count * sizeof *pressure);
    }
    network->flow.count = count;
    network->pressure.count = pressure != NULL ? count : 0;
    network->flow_version = network->version;
    return VN_OK;
}

static bool is_current(const vn_network *network, int32_t count) {
    return count > 0 && count == network->x.count && network->flow_version == network->version;
}

const double *vn_network_flow(const vn_network *network) {
    return is_current(network, network->flow.count) ? network->flow.data : NULL;
}

const double *vn_network_pressure(const vn_network *network) {
    return is_current(network, network->pressure.count) ? network->pressure.data : NULL;
}
