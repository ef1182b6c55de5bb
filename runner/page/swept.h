// What a sweep varies, as the axis and the curves of a figure.
#pragma once

#include <string>
#include <vector>

#include "contract/json.h"
namespace peclet::runner {

// One parameter: its value at each point, as a number or as a word.
struct Swept {
  std::string pointer;  // "" of the points themselves, where nothing is swept
  std::string name;     // its symbol, or the last step of the pointer
  bool numeric = false;
  std::vector<double> numbers{};      // of each point; of words their places among `values`
  std::vector<std::string> words{};   // of each point, as they are read
  std::vector<std::string> values{};  // each word once, in the order of the points

  std::size_t distinct() const { return values.size(); }
};

// Of page_parameters() and the points of page_points(); the points by their labels where nothing is swept.
std::vector<Swept> swept_parameters(const Json& parameters, const Json& points);

// The one called `name`, a pointer or a last step that no other has. Without a name the one with most values,
// numbers before words. Throws InputError at `option`.
const Swept& chosen_axis(const std::vector<Swept>& swept, const std::string& name, const std::string& option);

// Those that tell curves apart: which vary, and whose value does not follow from that on the axis.
std::vector<const Swept*> curves_by(const std::vector<Swept>& swept, const Swept& axis);

}  // namespace peclet::runner
