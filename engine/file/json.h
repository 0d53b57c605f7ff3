/// What the JSON reader and writer agree on (docs/formats.md).
#ifndef VN_FILE_JSON_H
#define VN_FILE_JSON_H

#include "file/format.h"

#define VN_JSON_NETWORK "venule.network"
#define VN_JSON_NETWORKS "venule.networks"

/// Raised when an older reader would misread what a newer writer means; not for keys that it may skip.
enum { VN_JSON_VERSION = 1 };

#endif
