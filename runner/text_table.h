// A table for a terminal: aligned columns, two blanks between them.
#pragma once

#include <string>
#include <vector>

namespace peclet::runner {

class TextTable {
 public:
  enum class Align { left, right };

  void add_column(std::string title, Align align = Align::right);
  // Requires a cell for every column, in UTF-8.
  void add_row(std::vector<std::string> cells);
  // Each line begins with `indent` and ends with a newline, without blanks before it.
  std::string text(const std::string& indent = "") const;

 private:
  std::vector<Align> aligns_;
  std::vector<std::vector<std::string>> rows_{{}};  // the titles first
};

}  // namespace peclet::runner
