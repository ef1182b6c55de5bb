// Names as figures write them: pieces of text on the line, below it and above it.
#pragma once

#include <string>
#include <vector>

#include "contract/json.h"
#include "runner/page/page_parts.h"

namespace peclet::runner {

struct LabelPart {
  std::string text;
  int level = 0;  // -1 lowered, 1 raised
  friend bool operator==(const LabelPart&, const LabelPart&) = default;
};
using Label = std::vector<LabelPart>;

// "N_1^noise" as N, "1" lowered, "noise" raised. What is raised may be the name of a term, with underscores
// of its own; a letter or two behind its last one are lowered: sigma^noise_xy. With an `element` all of it is
// the name, and the element is lowered. Names of Greek letters become the letters.
Label symbol_label(const std::string& symbol, const std::string& element = "");

// "relative viscosity η_r [unit]": words, symbol and unit, as the title of an axis.
Label title_of(const Drawable& quantity);
// The same of what a sweep sets, as page_parameters() has it.
Label title_of(const Json& parameter);
// What stands before " = 0.45": the symbol; without one the words.
Label short_name_of(const Json& parameter);

// As plain text, without the levels.
std::string text_of(const Label& label);
// As matplotlib reads it.
std::string mathtext_of(const Label& label);

// "0.01", "2000", "5·10⁶"; four digits at most.
std::string plain_number(double value);

}  // namespace peclet::runner
