#include "engine/sizes/measured_sizes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "contract/input_error.h"
#include "contract/text_lines.h"

namespace peclet::engine {
namespace {

// Instruments have a hundred.
constexpr std::size_t most_sizes = 1024;

struct Line {
  std::size_t number;  // from 1
  std::string_view text;
};

std::vector<Line> lines_of(std::string_view text) {
  std::vector<Line> lines;
  text = without_byte_order_mark(text);
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::string_view line = take_line(text);
    if (!is_blank(line)) lines.push_back({number, line});
  }
  return lines;
}

std::string_view trimmed(std::string_view field) {
  constexpr std::string_view around = " \t\"";
  field.remove_prefix(std::min(field.find_first_not_of(around), field.size()));
  field.remove_suffix(field.size() - field.find_last_not_of(around) - 1);
  return field;
}

std::vector<std::string_view> fields_of(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  if (separator == ' ') {
    for (std::string_view word = take_word(line); !word.empty(); word = take_word(line))
      fields.push_back(word);
    return fields;
  }
  for (;;) {
    const std::size_t end = line.find(separator);
    fields.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) break;
    line.remove_prefix(end + 1);
  }
  if (fields.back().empty()) fields.pop_back();  // some end each line with a separator
  return fields;
}

std::optional<double> number_of(std::string_view field, char separator) {
  std::string word(field);
  if (separator != ',' && std::ranges::count(word, ',') == 1 && word.find('.') == std::string::npos) {
    std::ranges::replace(word, ',', '.');
  }
  return number_in<double>(word);
}

class Table {
 public:
  Table(std::string_view text, std::string file, std::pair<std::size_t, std::size_t> columns)
      : lines_(lines_of(text)), file_(std::move(file)), columns_(columns) {}

  std::vector<MeasuredSize> read() {
    skip_header();
    if (lines_.size() > most_sizes)
      refuse(lines_[most_sizes], fmt::format("must be one of at most {}", most_sizes));
    std::vector<MeasuredSize> sizes;
    for (const Line& line : lines_) sizes.push_back(size_in(line));
    refuse_cumulative(sizes);
    std::ranges::sort(sizes, {}, &MeasuredSize::size);
    const auto twice = std::ranges::adjacent_find(sizes, {}, &MeasuredSize::size);
    if (twice != sizes.end()) refuse(fmt::format("size {}", twice->size), "must be there once");
    std::erase_if(sizes, [](const MeasuredSize& one) { return one.share == 0; });
    if (sizes.empty()) refuse("", "must have a line of a size and its share, and has none");
    return sizes;
  }

 private:
  [[noreturn]] void refuse(const std::string& value, const std::string& rule) const {
    throw InputError(file_, "", value, rule);
  }
  [[noreturn]] void refuse(const Line& line, const std::string& rule) const {
    refuse(fmt::format("line {}: \"{}\"", line.number, line.text), rule);
  }

  static bool begins_with_number(std::string_view line) {
    line.remove_prefix(std::min(line.find_first_not_of(" \t\""), line.size()));
    if (line.starts_with('+')) line.remove_prefix(1);
    return !line.empty() && ((line[0] >= '0' && line[0] <= '9') || line[0] == '.' || line[0] == '-');
  }

  // Leaves the lines from the first number on, and finds what parts their fields.
  void skip_header() {
    const auto first = std::ranges::find_if(lines_, [](const Line& l) { return begins_with_number(l.text); });
    lines_.erase(lines_.begin(), first);
    for (const char candidate : {';', '\t', ' ', ','}) {
      separator_ = candidate;
      const auto is_parted = [&](const Line& line) {
        const std::vector<std::string_view> fields = fields_of(line.text, candidate);
        // "1.0, 10" is parted by commas.
        return fields.size() > 1 && (candidate != ' ' || !fields[0].ends_with(','));
      };
      if (std::ranges::any_of(lines_, is_parted)) return;
    }
  }

  MeasuredSize size_in(const Line& line) const {
    const std::vector<std::string_view> fields = fields_of(line.text, separator_);
    const bool is_named = columns_.first > 0;
    if (!is_named && fields.size() != 2) {
      refuse(line,
             fields.size() < 2
                 ? "must be a size and its share"
                 : fmt::format(
                       "has {} columns: --columns must name those of size and share, such as 1,2{}",
                       fields.size(),
                       separator_ == ',' ? ", and commas must not be those of decimal fractions, too" : ""));
    }
    const auto [of_size, of_share] = is_named ? columns_ : std::pair<std::size_t, std::size_t>{1, 2};
    if (std::max(of_size, of_share) > fields.size()) {
      refuse(line, fmt::format("must have {} columns", std::max(of_size, of_share)));
    }
    const auto size = number_of(fields[of_size - 1], separator_),
               share = number_of(fields[of_share - 1], separator_);
    constexpr double least = 1e-30, most = 1e30;  // of which cubes are numbers, too
    if (!size || !(*size > 0)) refuse(line, fmt::format("must have a size > 0 in column {}", of_size));
    if (*size < least || *size > most)
      refuse(line, fmt::format("must have sizes from {:g} to {:g} in column {}", least, most, of_size));
    if (!share || !(*share >= 0)) refuse(line, fmt::format("must have a share >= 0 in column {}", of_share));
    if (*share > most) refuse(line, fmt::format("must have shares up to {:g} in column {}", most, of_share));
    return {*size, *share};
  }

  // Shares of classes that rise to 100 would add up to more.
  void refuse_cumulative(std::vector<MeasuredSize> sizes) const {
    std::ranges::sort(sizes, {}, &MeasuredSize::size);
    const auto rises = [](const auto& all) {
      const double last = all.back().share;
      return all.size() > 2 && std::ranges::is_sorted(all, {}, &MeasuredSize::share) &&
             (std::abs(last - 100) < 0.5 || last == 1);
    };
    bool is_cumulative = !sizes.empty() && rises(sizes);
    std::ranges::reverse(sizes);
    is_cumulative = is_cumulative || (!sizes.empty() && rises(sizes));
    if (is_cumulative) {
      refuse("",
             "has shares that rise to the whole, as those of a cumulative curve: must be the share of each "
             "size");
    }
  }

  std::vector<Line> lines_;
  std::string file_;
  std::pair<std::size_t, std::size_t> columns_;
  char separator_ = ' ';
};

}  // namespace

std::vector<MeasuredSize> measured_sizes(std::string_view text, const std::string& file,
                                         std::pair<std::size_t, std::size_t> columns) {
  return Table(text, file, columns).read();
}

}  // namespace peclet::engine
