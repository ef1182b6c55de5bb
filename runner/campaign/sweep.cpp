#include "runner/campaign/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "contract/input_error.h"

namespace peclet::runner {
namespace {

const char* const pointer_rule =
    "must be a JSON pointer into the scene, such as \"/fluid/viscosity\", or an array of them";

bool is_pointer(const Json& set) {
  if (!set.is_string()) return false;
  const auto& text = set.get_ref<const std::string&>();
  if (text.size() < 2 || text.front() != '/') return false;
  try {
    const Json::json_pointer parsed(text);
    return true;
  } catch (const Json::exception&) {  // a ~ that escapes nothing
    return false;
  }
}

std::vector<std::string> read_pointers(const Json& set, const std::string& where, const std::string& file) {
  if (!set.is_array()) {
    if (!is_pointer(set)) throw InputError(file, where, shortened(set), pointer_rule);
    return {set.get<std::string>()};
  }
  if (set.empty()) throw InputError(file, where, "[]", pointer_rule);
  std::vector<std::string> pointers;
  for (const Json& pointer : set) {
    if (!is_pointer(pointer)) {
      throw InputError(file, fmt::format("{}/{}", where, pointers.size()), shortened(pointer), pointer_rule);
    }
    pointers.push_back(pointer.get<std::string>());
  }
  return pointers;
}

std::vector<std::vector<Json>> read_rows(const Json& entry, std::size_t pointers, const std::string& where,
                                         const std::string& file) {
  std::vector<std::vector<Json>> rows;
  for (const Json& value : entry.at("values")) {
    if (!entry.at("set").is_array()) {
      rows.push_back({value});
      continue;
    }
    if (!value.is_array() || value.size() != pointers) {
      throw InputError(file, fmt::format("{}/{}", where, rows.size()), shortened(value),
                       fmt::format("must be an array of {}, one for every pointer of set", pointers));
    }
    rows.emplace_back(value.begin(), value.end());
  }
  return rows;
}

// One names a part of what the other names, or the same.
bool overlap(const std::string& one, const std::string& other) {
  const auto [shorter, longer] = one.size() < other.size() ? std::pair(one, other) : std::pair(other, one);
  return longer.starts_with(shorter) && (longer.size() == shorter.size() || longer[shorter.size()] == '/');
}

void refuse_conflicts(const std::vector<SweepEntry>& sweep, const std::string& file) {
  std::vector<std::string> seen;
  for (std::size_t entry = 0; entry < sweep.size(); ++entry) {
    for (const std::string& pointer : sweep[entry].pointers) {
      const auto other =
          std::find_if(seen.begin(), seen.end(), [&](const auto& known) { return overlap(known, pointer); });
      if (other != seen.end()) {
        throw InputError(file, fmt::format("/sweep/{}/set", entry), pointer,
                         *other == pointer
                             ? "must be set once only"
                             : fmt::format("must not overlap with {}, which is set too", *other));
      }
      seen.push_back(pointer);
    }
  }
}

}  // namespace

std::vector<SweepEntry> read_sweep(const Json& sweep, const std::string& file) {
  std::vector<SweepEntry> entries;
  for (const Json& entry : sweep) {
    const std::string where = fmt::format("/sweep/{}", entries.size());
    SweepEntry read;
    read.pointers = read_pointers(entry.at("set"), where + "/set", file);
    read.rows = read_rows(entry, read.pointers.size(), where + "/values", file);
    entries.push_back(std::move(read));
  }
  refuse_conflicts(entries, file);
  return entries;
}

}  // namespace peclet::runner
