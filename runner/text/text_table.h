// A table for a terminal: aligned columns, two blanks between them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runner/text/folded_text.h"

namespace peclet::runner {

class TextTable {
 public:
  enum class Align { left, right };

  void add_column(std::string title, Align align = Align::right);
  // A column that a narrow terminal may do without: those of the lowest `importance` go first.
  void add_column(std::string title, Align align, int importance);
  // Requires a cell for every column, in UTF-8.
  void add_row(std::vector<std::string> cells);
  // Each line begins with `indent` and ends with a newline, without blanks before it.
  std::string text(const std::string& indent = "") const;
  // In no more than `width` characters a line, if columns that can be done without and a last column that
  // goes on in further lines are enough for it.
  std::string text_within(std::size_t width) const;
  // The titles that text_within() leaves out.
  std::vector<std::string> left_out(std::size_t width) const;

 private:
  struct Column {
    Align align;
    std::optional<int> importance;  // nothing: it is never left out
  };
  std::vector<std::size_t> widths() const;
  // Indices of the columns that are shown, in their order.
  std::vector<std::size_t> shown(std::size_t width) const;

  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_{{}};  // the titles first
};

}  // namespace peclet::runner
