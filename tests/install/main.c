// What somebody else's program looks like: the smallest one that uses an installed Venule.
#include <stdio.h>
#include <venule/domain.h>

int main(void) {
    vn_disk_def def = vn_disk_def_default();
    vn_domain *disk;
    if (vn_domain_disk(&disk, &def) != VN_OK) {
        fprintf(stderr, "%s\n", vn_message());
        return 1;
    }
    printf("%.4f\n", vn_domain_measure(disk));
    vn_domain_release(disk);
    return 0;
}
