// Files of this folder that are part of the program.
#pragma once

namespace peclet::runner {

extern const char* const figure_script_template;  // assets/figure.py; @FIGURE@ is where its data go

}  // namespace peclet::runner
