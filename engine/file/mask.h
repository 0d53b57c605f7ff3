/// Masks from files, for the engine's own files.
#ifndef VN_FILE_MASK_H
#define VN_FILE_MASK_H

#include "base/schema.h"
#include "venule/output.h"

extern const vn_schema vn_image_schema;
extern const vn_schema vn_volume_schema;

#endif
