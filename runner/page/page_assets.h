// The files of runner/page/assets, and the schema of scenes.
#pragma once

#include <array>

namespace peclet::runner {

extern const char* const page_template;  // with @STYLE@, @SCRIPT@ and others where they go
extern const char* const page_style;
extern const std::array<const char*, 16> page_scripts;  // in this order
extern const char* const scene_schema;                  // JSON

}  // namespace peclet::runner
