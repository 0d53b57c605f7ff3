/// `venule info`: what its files share.
#ifndef VN_HOST_INFO_H
#define VN_HOST_INFO_H

#include "host/host.h"

#include "venule/vessel_measures.h"

/// What anatomists measure, as far as a network tells it without its domain.
typedef struct vessel_info {
    vn_vessel_measures measures; ///< to be freed
    vn_boxes boxes;              ///< zeroed where there is no segment
} vessel_info;
vn_status vessel_info_measure(vessel_info *info, const vn_network *network);
void vessel_info_print(const vessel_info *info);
/// As fields after others.
void vessel_info_json(const vessel_info *info);

/// A field after others, and what is in its braces.
void json_statistics(const char *name, const vn_statistics *s);
void json_numbers(const vn_statistics *s);
/// null where it is not finite.
void json_number(const char *before, const char *name, double value);

#endif
