// Formats tables and texts for a terminal.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace peclet::runner {

// The width of a text that is not for a terminal: nothing is left out.
constexpr std::size_t unlimited_width = static_cast<std::size_t>(-1);

// Returns the columns that a UTF-8 text takes: one for each character, none for a mark on the letter before
// it, as in γ̇ (U+0300 to U+036F).
std::size_t width_of(std::string_view text);

// Returns `text` with its lines broken at blanks into lines of at most `width` characters; a longer word
// stands alone. Each line ends with a newline.
std::string folded(std::string_view text, std::size_t width);

// A table with aligned columns, separated by two blanks.
class TextTable {
 public:
  enum class Align { left, right };

  void add_column(std::string title, Align align = Align::right);
  // Adds a column that a narrow terminal may leave out; the lowest `importance` goes first.
  void add_column(std::string title, Align align, int importance);
  // Requires a cell for every column, in UTF-8.
  void add_row(std::vector<std::string> cells);
  // Returns all lines. Each begins with `indent` and has no blanks before its newline.
  std::string text(const std::string& indent = "") const;
  // Returns lines of at most `width` characters, if that is possible by leaving out columns and by folding
  // the last one.
  std::string text_within(std::size_t width) const;
  // Returns the titles of the columns that text_within() leaves out.
  std::vector<std::string> left_out(std::size_t width) const;

 private:
  struct Column {
    Align align;
    std::optional<int> importance;  // none for a column that is never left out
  };
  std::vector<std::size_t> widths() const;
  // Returns the indices of the columns that are shown, in their order.
  std::vector<std::size_t> shown(std::size_t width) const;

  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_{{}};  // the titles first
};

// The columns of a table that name the point of each row.
//
// Labels such as "peclet=10 volume_fraction=0.5" are split into one column for each name, which is narrower
// than the names in every row. Labels that do not all have the same names stay whole, in one column.
class PointColumns {
 public:
  explicit PointColumns(const std::vector<std::string>& labels);

  void add_to(TextTable& table) const;
  // Returns the first cells of the row of the i-th label.
  const std::vector<std::string>& cells(std::size_t i) const { return cells_[i]; }
  std::size_t count() const { return titles_.size(); }
  const std::vector<std::string>& titles() const { return titles_; }

 private:
  std::vector<std::string> titles_;
  std::vector<std::vector<std::string>> cells_;
};

}  // namespace peclet::runner
