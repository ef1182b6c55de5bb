#include "runner/text/html.h"

#include <cassert>
#include <utility>

namespace peclet::runner {

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      default: {
        const bool is_control = static_cast<unsigned char>(c) < 0x20U && c != '\n' && c != '\t';
        safe += is_control || c == '\x7f' ? std::string("\xEF\xBF\xBD") : std::string(1, c);
      }
    }
  }
  return safe;
}

std::string list_item(const std::string& term, const std::string& meaning) {
  return "<dt>" + escaped(term) + "</dt><dd>" + escaped(meaning) + "</dd>\n";
}

void HtmlTable::add_column(std::string title, Align align) {
  aligns_.push_back(align);
  titles_.push_back(std::move(title));
}

void HtmlTable::add_row(std::vector<std::string> cells) {
  assert(cells.size() == aligns_.size());
  rows_.push_back(std::move(cells));
}

namespace {

// A title may go on in a further line after an underscore: numbers below it are narrower.
std::string breakable(const std::string& title) {
  std::string text;
  for (const char c : escaped(title)) text += c == '_' ? std::string("_<wbr>") : std::string(1, c);
  return text;
}

}  // namespace

std::string HtmlTable::row(const char* element, const std::vector<std::string>& cells) const {
  std::string line = "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    line += std::string("<") + element + (aligns_[i] == Align::left ? " class=\"text\">" : ">") +
            (element == std::string_view("th") ? breakable(cells[i]) : escaped(cells[i])) + "</" + element +
            ">";
  }
  return line + "</tr>\n";
}

std::string HtmlTable::html() const {
  std::string text = "<div class=\"wide\"><table>\n<thead>" + row("th", titles_) + "</thead>\n<tbody>\n";
  for (const std::vector<std::string>& cells : rows_) text += row("td", cells);
  return text + "</tbody>\n</table></div>\n";
}

}  // namespace peclet::runner
