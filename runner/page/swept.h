// What a sweep varies, as the axis and the curves of a figure.
#pragma once

#include <string>
#include <vector>

#include "contract/json.h"
#include "runner/page/page_data.h"

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

// The points of a campaign with what was measured there, over what is swept.
struct MeasuredSweep {
  CampaignStatus status;
  PagePoints page;           // in step with the points of `status`
  Json parameters;           // page_parameters()
  std::vector<Swept> swept;  // in step with these; the points by their labels where nothing is swept
};

// Throws IntegrityError.
MeasuredSweep read_sweep(Database& database);

// Returns the place of the number that is called so, by its path or by quantity and element. Throws
// InputError at --quantity, naming those that are measured.
std::size_t chosen_column(const std::vector<Drawable>& drawables, const std::string& name);

// The one called `name`, a pointer or a last step that no other has. Without a name the one with most values,
// numbers before words. Throws InputError at --over.
const Swept& chosen_axis(const std::vector<Swept>& swept, const std::string& name);

// Those that tell curves apart: which vary, and whose value does not follow from that on the axis.
std::vector<const Swept*> curves_by(const std::vector<Swept>& swept, const Swept& axis);

}  // namespace peclet::runner
