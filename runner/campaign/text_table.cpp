#include "runner/campaign/text_table.h"

#include <algorithm>
#include <cassert>
#include <sstream>
#include <utility>

namespace peclet::runner {
namespace {

// Returns the next line of at most `width` characters and removes it, with the blank after it, from `rest`.
std::string_view taken_line(std::string_view& rest, std::size_t width) {
  std::size_t end = std::min(rest.find(' '), rest.size());
  while (end < rest.size()) {
    const std::size_t next = std::min(rest.find(' ', end + 1), rest.size());
    if (width_of(rest.substr(0, next)) > width) break;
    end = next;
  }
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return line;
}

}  // namespace

std::size_t width_of(std::string_view text) {
  std::size_t width = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const bool is_continued = (byte & 0xC0U) == 0x80U;
    const bool is_mark = byte == 0xCCU || (byte == 0xCDU && i + 1 < text.size() &&
                                           static_cast<unsigned char>(text[i + 1]) < 0xB0U);
    width += is_continued || is_mark ? 0 : 1;
  }
  return width;
}

std::string folded(std::string_view text, std::size_t width) {
  std::string lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (width_of(line) <= width) {
      lines += std::string(line) + '\n';
      continue;
    }
    while (!line.empty()) lines += std::string(taken_line(line, width)) + '\n';
  }
  return lines;
}

namespace {

constexpr std::size_t gap = 2;

std::size_t total(const std::vector<std::size_t>& widths, const std::vector<std::size_t>& columns) {
  std::size_t sum = 0;
  for (const std::size_t column : columns) sum += widths[column] + (sum > 0 ? gap : 0);
  return sum;
}

std::size_t longest_word(const std::string& text) {
  std::istringstream words(text);
  std::size_t longest = 0;
  for (std::string word; words >> word;) longest = std::max(longest, width_of(word));
  return longest;
}

}  // namespace

void TextTable::add_column(std::string title, Align align) {
  columns_.push_back({align, std::nullopt});
  rows_.front().push_back(std::move(title));
}

void TextTable::add_column(std::string title, Align align, int importance) {
  columns_.push_back({align, importance});
  rows_.front().push_back(std::move(title));
}

void TextTable::add_row(std::vector<std::string> cells) {
  assert(cells.size() == columns_.size());
  rows_.push_back(std::move(cells));
}

std::vector<std::size_t> TextTable::widths() const {
  std::vector<std::size_t> widths(columns_.size());
  for (const std::vector<std::string>& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width_of(row[i]));
  }
  return widths;
}

std::vector<std::size_t> TextTable::shown(std::size_t width) const {
  const std::vector<std::size_t> all = widths();
  std::vector<std::size_t> columns(columns_.size());
  for (std::size_t i = 0; i < columns.size(); ++i) columns[i] = i;
  const auto matters_less = [this](std::size_t a, std::size_t b) {
    const std::optional<int>&first = columns_[a].importance, &second = columns_[b].importance;
    return first && (!second || *first < *second);
  };
  while (total(all, columns) > width) {
    const auto least = std::min_element(columns.begin(), columns.end(), matters_less);
    if (!columns_[*least].importance) break;
    columns.erase(least);
  }
  return columns;
}

std::vector<std::string> TextTable::left_out(std::size_t width) const {
  const std::vector<std::size_t> columns = shown(width);
  std::vector<std::string> titles;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (std::find(columns.begin(), columns.end(), i) == columns.end()) titles.push_back(rows_.front()[i]);
  }
  return titles;
}

std::string TextTable::text(const std::string& indent) const {
  std::istringstream lines(text_within(unlimited_width));
  std::string all;
  for (std::string line; std::getline(lines, line);) all += indent + line + '\n';
  return all;
}

std::string TextTable::text_within(std::size_t width) const {
  const std::vector<std::size_t> all = widths(), columns = shown(width);
  if (columns.empty()) return "";
  const std::size_t before_last = total(all, columns) - all[columns.back()];
  std::size_t least_width = 0;
  for (const std::vector<std::string>& row : rows_) {
    least_width = std::max(least_width, longest_word(row[columns.back()]));
  }
  // The last column goes below the row if its longest word has no room beside it.
  const bool beside = least_width <= width && before_last <= width - least_width;
  const std::size_t room = beside ? width - before_last : width - std::min(width, gap);
  std::string text;
  for (const std::vector<std::string>& row : rows_) {
    std::string line;
    for (const std::size_t i : columns) {
      if (i == columns.back()) break;
      const std::string blanks(all[i] - width_of(row[i]), ' ');
      line += columns_[i].align == Align::left ? row[i] + blanks : blanks + row[i];
      line += std::string(gap, ' ');
    }
    const std::string& last = row[columns.back()];
    const std::size_t spare = std::min(all[columns.back()], room);
    const bool is_left = columns_[columns.back()].align == Align::left;
    std::istringstream parts(folded(last.empty() ? " " : last, room));
    for (std::string part; std::getline(parts, part);) {
      if (!beside && width_of(line) > 0) text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
      if (!beside) line = std::string(gap, ' ');
      const std::size_t used = width_of(part);
      line += is_left || used >= spare ? part : std::string(spare - used, ' ') + part;
      line.erase(line.find_last_not_of(' ') + 1);
      text += line + '\n';
      line = beside ? std::string(before_last, ' ') : "";
    }
  }
  return text;
}

namespace {

struct Parts {
  std::vector<std::string> names, values;
};

// Returns the names and values of a label; nothing if a word of it is not name=value.
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
