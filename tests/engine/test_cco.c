// Arterial trees as a whole: what is written down obeys the physics and the rules, recomputed from the
// network alone.
#include "cco_support.h"

#include <time.h>

static vn_network *grown(vn_domain *domain, int32_t terminals, int64_t seed, const char *what) {
    vn_cco *cco = started(domain, terminals, seed);
    int32_t added;
    clock_t start = clock();
    if (vn_cco_grow(cco, terminals, &added) != VN_OK) {
        report(cco, what, 0);
        fail_msg("%s", vn_message());
    }
    report(cco, what, (double)(clock() - start) / CLOCKS_PER_SEC);
    assert_int_equal(added, terminals);
    assert_true(vn_cco_done(cco));
    vn_network *network = network_at(cco, 0);
    vn_cco_destroy(cco);
    return network;
}

static void trees_obey_all_laws(void **state) {
    (void)state;
    for (int i = 0; i < 6; i++) {
        int32_t terminals = (int32_t[]){1, 2, 10, 200, 1000, 1500}[i];
        vn_domain *domain = i % 2 ? ball_of_measure(20000) : disk_of_measure(20000);
        vn_network *n = grown(domain, terminals, 7 + i, i % 2 ? "ball" : "disk");
        laws l = laws_default();
        assert_int_equal(n->x.count, 2 * terminals);
        check_laws(n, domain, &l);
        vn_network_destroy(n);
        vn_domain_release(domain);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        counted_test(trees_obey_all_laws),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
