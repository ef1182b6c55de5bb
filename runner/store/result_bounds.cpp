#include "runner/store/result_bounds.h"

#include <fmt/format.h>

namespace peclet::runner {

std::string excess_of(std::string_view text) {
  if (text.size() > largest_result) {
    return fmt::format("it has {} bytes, more than {}", text.size(), largest_result);
  }
  std::size_t values = 1, structures = 0;
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '\\') ++i;
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (c == ',') ++values;
    if (c == '[' || c == '{' || c == ':') ++structures;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > deepest_result) return fmt::format("it is nested more than {} deep", deepest_result);
  }
  if (structures > most_structures) {
    return fmt::format("it has more than {} lists, objects and keys", most_structures);
  }
  return values > most_values ? fmt::format("it has more than {} values", most_values) : "";
}

}  // namespace peclet::runner
