// Parts are found by the runs of foreground in each row: a run has the voxels [begin, end) of it. Runs of
// neighbouring rows that overlap are of one part, whose first run stands for it.

#include "domain/voxel_parts.h"

typedef struct run {
    int32_t begin, end;
    int32_t parent; ///< an earlier run of the same part, or itself
    int32_t voxels; ///< of the whole part, at the run that stands for it
} run;

typedef struct row_runs {
    VN_ARRAY(run) runs;
    VN_ARRAY(int32_t) ends; ///< of each row, in `runs`
} row_runs;

static vn_status find_runs(const vn_voxel_bits *bits, int32_t j, int32_t k, row_runs *r) {
    int32_t end;
    for (int32_t i = 0; i < bits->size[0]; i = end + 1) {
        while (i < bits->size[0] && !vn_voxel_is_set(bits, i, j, k)) {
            i++;
        }
        for (end = i; end < bits->size[0] && vn_voxel_is_set(bits, end, j, k); end++) {
        }
        if (end > i) {
            run found = {i, end, r->runs.count, end - i};
            VN_TRY(vn_array_push(&r->runs, found));
        }
    }
    return vn_array_push(&r->ends, r->runs.count);
}

// With every second step on the way made shorter.
static int32_t part_of(run *runs, int32_t at) {
    while (runs[at].parent != at) {
        runs[at].parent = runs[runs[at].parent].parent;
        at = runs[at].parent;
    }
    return at;
}

static void unite(run *runs, int32_t a, int32_t b) {
    int32_t first = part_of(runs, a), second = part_of(runs, b);
    if (first == second) {
        return;
    }
    if (second < first) {
        int32_t other = first;
        first = second;
        second = other;
    }
    runs[second].parent = first;
    runs[first].voxels += runs[second].voxels;
}

static int32_t row_begin(const row_runs *r, int64_t row) {
    return row > 0 ? r->ends.data[row - 1] : 0;
}

static void unite_rows(row_runs *r, int64_t row, int64_t other) {
    run *runs = r->runs.data;
    int32_t a = row_begin(r, row), b = row_begin(r, other);
    while (a < r->ends.data[row] && b < r->ends.data[other]) {
        if (runs[a].begin < runs[b].end && runs[b].begin < runs[a].end) {
            unite(runs, a, b);
        }
        if (runs[a].end < runs[b].end) {
            a++;
        } else {
            b++;
        }
    }
}

static vn_status find_parts(const vn_voxel_bits *bits, row_runs *r) {
    VN_TRY(vn_array_reserve(&r->ends, (int64_t)bits->size[1] * bits->size[2]));
    for (int32_t k = 0; k < bits->size[2]; k++) {
        VN_TRY(vn_poll());
        for (int32_t j = 0; j < bits->size[1]; j++) {
            int64_t row = j + (int64_t)bits->size[1] * k;
            VN_TRY(find_runs(bits, j, k, r));
            if (j > 0) {
                unite_rows(r, row, row - 1);
            }
            if (k > 0) {
                unite_rows(r, row, row - bits->size[1]);
            }
        }
    }
    return VN_OK;
}

static vn_status fail_parts(const row_runs *r, int32_t parts, int32_t largest, const char *what) {
    int32_t second = 0;
    for (int32_t i = 0; i < r->runs.count; i++) {
        const run *at = &r->runs.data[i];
        second = at->parent == i && i != largest && at->voxels > second ? at->voxels : second;
    }
    return vn_fail(VN_INVALID,
                   "%s: the mask has %d parts that do not hang together, the largest of %d and %d voxels: "
                   "take component = \"largest\" or \"all\"",
                   what, parts, r->runs.data[largest].voxels, second);
}

static void keep_part(vn_voxel_bits *bits, row_runs *r, int32_t part) {
    int32_t at = 0;
    for (int32_t row = 0; row < r->ends.count; row++) {
        int32_t j = row % bits->size[1], k = row / bits->size[1];
        for (; at < r->ends.data[row]; at++) {
            bool kept = part_of(r->runs.data, at) == part;
            for (int32_t i = r->runs.data[at].begin; !kept && i < r->runs.data[at].end; i++) {
                *vn_voxel_word(bits, i, j, k) &= ~vn_voxel_bit(i, j, k);
            }
        }
    }
}

// Scanners and thresholds leave specks, of which nobody wants to hear.
static bool are_specks(int64_t voxels, int64_t largest) {
    return 1000 * voxels <= largest;
}

static vn_status choose_part(vn_voxel_bits *bits, row_runs *r, vn_parts parts, const char *what) {
    int32_t largest = 0, count = 0;
    int64_t voxels = 0;
    for (int32_t i = 0; i < r->runs.count; i++) {
        const run *at = &r->runs.data[i];
        if (at->parent == i) {
            count++;
            voxels += at->voxels;
            largest = at->voxels > r->runs.data[largest].voxels ? i : largest;
        }
    }
    if (count == 0) {
        return vn_fail(
            VN_INVALID,
            "%s: the mask is empty: none of its %d x %d x %d voxels is inside (is the threshold right?)",
            what, bits->size[0], bits->size[1], bits->size[2]);
    }
    int32_t most = r->runs.data[largest].voxels;
    if (parts == VN_PARTS_ONE && !are_specks(voxels - most, most)) {
        return fail_parts(r, count, largest, what);
    }
    if (count > 1 && parts != VN_PARTS_ALL) {
        keep_part(bits, r, largest);
    }
    return VN_OK;
}

vn_status vn_voxel_parts(vn_voxel_bits *bits, vn_parts parts, const char *what) {
    row_runs r = {0};
    vn_status status = find_parts(bits, &r);
    status = status == VN_OK ? choose_part(bits, &r, parts, what) : status;
    vn_array_free(&r.runs);
    vn_array_free(&r.ends);
    return status;
}
