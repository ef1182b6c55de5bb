// Text and tables in HTML.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace peclet::runner {

// `text` as it is to be read, inside an element or an attribute in quotes. Control characters that HTML does
// not allow become U+FFFD.
std::string escaped(std::string_view text);

// A term of a list and what it means, both as plain text.
std::string list_item(const std::string& term, const std::string& meaning);

class HtmlTable {
 public:
  enum class Align { left, right };

  void add_column(std::string title, Align align = Align::right);
  // Requires a cell for every column, as plain text.
  void add_row(std::vector<std::string> cells);
  bool empty() const { return rows_.empty(); }
  std::string html() const;

 private:
  std::string row(const char* element, const std::vector<std::string>& cells) const;

  std::vector<Align> aligns_;
  std::vector<std::string> titles_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace peclet::runner
