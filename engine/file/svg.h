/// Outlines from SVG files, for the engine's own files: options, and the rings before they become a domain.
#ifndef VN_FILE_SVG_H
#define VN_FILE_SVG_H

#include "base/schema.h"
#include "domain/rings.h"
#include "venule/output.h"

extern const vn_schema vn_svg_schema;

/// The outline that vn_domain_svg() makes a domain of, in final coordinates and resolved; @p unit is "mm"
/// or "".
vn_status vn_svg_read_rings(vn_rings *out, const char **unit, const char *path, const vn_svg_def *def);

#endif
