// A figure as a script of Python that holds its numbers and draws them with matplotlib.
#pragma once

#include <string>
#include <string_view>

#include "runner/figure/figure.h"

namespace peclet::runner {

// Ends with the SHA-256 of all before its last line. The same figure gives the same bytes.
std::string figure_script(const Figure& figure);

// Whether the text is what figure_script() once gave, and nobody has changed it.
bool is_own_script(std::string_view text);

}  // namespace peclet::runner
