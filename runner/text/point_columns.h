// The columns of a table that say which point a row is about.
#pragma once

#include <string>
#include <vector>

#include "runner/text/text_table.h"

namespace peclet::runner {

// Labels such as "peclet=10 volume_fraction=0.5" fall apart into a column for each name, which is narrower
// than to repeat the names in every row. Labels that do not all have the same names stay whole, in one
// column.
class PointColumns {
 public:
  explicit PointColumns(const std::vector<std::string>& labels);

  void add_to(TextTable& table) const;
  // The first cells of the row of the i-th label.
  const std::vector<std::string>& cells(std::size_t i) const { return cells_[i]; }
  std::size_t count() const { return titles_.size(); }
  const std::vector<std::string>& titles() const { return titles_; }

 private:
  std::vector<std::string> titles_;
  std::vector<std::vector<std::string>> cells_;
};

}  // namespace peclet::runner
