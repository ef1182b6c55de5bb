#include "runner/campaign/sweep_labels.h"

#include <fmt/format.h>

#include <map>

#include "contract/printable.h"

namespace peclet::runner {
namespace {

std::string last_step(const std::string& pointer) { return pointer.substr(pointer.rfind('/') + 1); }

bool is_number(const std::string& step) { return step.find_first_not_of("0123456789") == std::string::npos; }

constexpr std::size_t longest_label = 100;

// A value that is too long to be read in a table, or that a terminal would obey, is called by its place among
// the values, from 1.
std::string value_text(const Json& value, std::size_t row) {
  constexpr std::size_t longest = 24;
  const std::string text = value.is_string() ? value.get<std::string>() : canonical_json(value);
  return text.size() <= longest && printable(text) == text ? text : fmt::format("#{}", row + 1);
}

}  // namespace

SweepLabels::SweepLabels(const std::vector<SweepEntry>& sweep) : sweep_(sweep) {
  std::map<std::string, int> uses;
  for (const SweepEntry& entry : sweep) {
    for (const std::string& pointer : entry.pointers) ++uses[last_step(pointer)];
  }
  for (const SweepEntry& entry : sweep) {
    std::vector<std::string>& names = names_.emplace_back();
    for (const std::string& pointer : entry.pointers) {
      const std::string step = last_step(pointer);
      names.push_back(printable(uses[step] == 1 && !is_number(step) ? step : pointer, longest_label));
    }
  }
}

std::string SweepLabels::of(const std::vector<std::size_t>& row_of_entry) const {
  std::string label;
  for (std::size_t entry = 0; entry < sweep_.size(); ++entry) {
    const std::size_t row = row_of_entry[entry];
    for (std::size_t i = 0; i < names_[entry].size(); ++i) {
      if (!label.empty()) label += ' ';
      label += names_[entry][i] + '=' + value_text(sweep_[entry].rows[row][i], row);
    }
  }
  return label;
}

}  // namespace peclet::runner
