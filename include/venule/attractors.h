/// @file attractors.h
/// Points that attract: auxin sources, oxygen drains.
#ifndef VENULE_ATTRACTORS_H
#define VENULE_ATTRACTORS_H

#include "venule/domain.h"
#include "venule/network.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vn_attractors vn_attractors;

#ifdef __cplusplus
}
#endif

#endif
