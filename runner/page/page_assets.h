// The files of runner/page/assets, and the script that draws figures.
#pragma once

#include <array>

namespace peclet::runner {

extern const char* const page_template;  // with @STYLE@, @SCRIPT@ and others where they go
extern const char* const page_style;
extern const std::array<const char*, 15> page_scripts;  // in this order
// python/peclet/drawing.py. With `FIGURE = ...` and `main(FIGURE)` behind it, it draws that figure.
extern const char* const drawing_script;

}  // namespace peclet::runner
