/// @file venule.h
/// All of Venule's engine.
#ifndef VENULE_VENULE_H
#define VENULE_VENULE_H

#include "venule/attractors.h"
#include "venule/base.h"
#include "venule/cco.h"
#include "venule/domain.h"
#include "venule/flow.h"
#include "venule/growth.h"
#include "venule/network.h"
#include "venule/output.h"
#include "venule/paths.h"
#include "venule/vessel_measures.h"
#include "venule/voxels.h"

#endif
