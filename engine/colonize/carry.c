// Attractors lie in the tissue and move with it.

#include "colonize/attractors.h"
#include "growth/growth.h"

// The next sync finds a network that it does not know, and looks for every node anew. Distances have changed
// for all: progress toward a node is counted from here.
static void forget_nodes(vn_attractors *a) {
    a->network_serial = 0;
    a->fresh.count = 0;
    a->fresh_all = true;
    for (int32_t i = 0; i < a->x.count; i++) {
        a->best.data[i] = INFINITY;
    }
    vn_point_grid_free(&a->grid);
    a->grid.cell = 0;
    a->version++;
}

vn_status vn_attractors_carry(vn_attractors *a, vn_growth *growth) {
    bool first;
    if (!vn_growth_moves(growth)) {
        return VN_OK;
    }
    VN_TRY(vn_growth_check_dim(growth, "attractors", a->dim));
    VN_TRY(vn_growth_note_carried(growth, a->serial, &first));
    if (!first) {
        return VN_OK;
    }
    double *columns[3] = {a->x.data, a->y.data, a->z.data};
    vn_status status = vn_growth_move_points(growth, columns, a->x.count);
    if (status == VN_OK) {
        forget_nodes(a);
    } else {
        growth->carried.count--;
    }
    return status;
}
