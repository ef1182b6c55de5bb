#include "runner/text/point_columns.h"

#include <algorithm>
#include <sstream>

namespace peclet::runner {
namespace {

struct Parts {
  std::vector<std::string> names, values;
};

// Nothing where the label is not made of name=value.
Parts split(const std::string& label) {
  Parts parts;
  std::istringstream words(label);
  for (std::string word; words >> word;) {
    const std::size_t sign = word.find('=');
    if (sign == std::string::npos) return {};
    parts.names.push_back(word.substr(0, sign));
    parts.values.push_back(word.substr(sign + 1));
  }
  return parts;
}

}  // namespace

PointColumns::PointColumns(const std::vector<std::string>& labels) {
  for (const std::string& label : labels) {
    Parts parts = split(label);
    if (cells_.empty()) titles_ = parts.names;
    if (parts.names.empty() || parts.names != titles_) {
      titles_ = {"point"};
      cells_.clear();
      for (const std::string& whole : labels) cells_.push_back({whole});
      return;
    }
    cells_.push_back(std::move(parts.values));
  }
  if (labels.empty()) titles_ = {"point"};
}

void PointColumns::add_to(TextTable& table) const {
  const bool is_whole = titles_.size() == 1 && titles_.front() == "point";
  for (const std::string& title : titles_) {
    table.add_column(title, is_whole ? TextTable::Align::left : TextTable::Align::right);
  }
}

}  // namespace peclet::runner
