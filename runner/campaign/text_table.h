// A table for a terminal: aligned columns, two blanks between them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace peclet::runner {

// Text for terminals: how wide it is, and how it is broken into lines.
//
// Without a terminal, or on one where nothing has to be left out.
constexpr std::size_t unlimited_width = static_cast<std::size_t>(-1);

// Columns that a UTF-8 text takes: one each character, none a mark on the letter before it, as in γ̇ (U+0300
// to U+036F).
std::size_t width_of(std::string_view text);

// Every line of `text` broken at blanks into lines of no more than `width` characters; a word that is longer
// stands alone. Each ends with a newline.
std::string folded(std::string_view text, std::size_t width);

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

// The columns of a table that say which point a row is about.
//
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
