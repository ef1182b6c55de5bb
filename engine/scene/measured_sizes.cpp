#include "engine/scene/measured_sizes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "contract/decimal.h"
#include "contract/errors.h"
#include "contract/json.h"
#include "contract/named_files.h"
#include "contract/text.h"
#include "engine/scene/composition.h"

namespace peclet::engine {
namespace {

// A limit far above the hundred sizes of instruments.
constexpr std::size_t most_sizes = 1024;

struct Line {
  std::size_t number;  // starts at 1
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
  if (fields.back().empty()) fields.pop_back();  // a separator at the end of the line
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
      refuse(lines_[most_sizes], "must be left out: a table has at most {} sizes", most_sizes);
    std::vector<MeasuredSize> sizes;
    for (const Line& line : lines_) sizes.push_back(size_in(line));
    refuse_cumulative(sizes);
    std::ranges::sort(sizes, {}, &MeasuredSize::size);
    const auto twice = std::ranges::adjacent_find(sizes, {}, &MeasuredSize::size);
    if (twice != sizes.end()) refuse(fmt::format("size {}", twice->size), "must be there once");
    std::erase_if(sizes, [](const MeasuredSize& one) { return one.share == 0; });
    if (sizes.empty()) refuse("", "must have a line of a size and its share");
    return sizes;
  }

 private:
  template <class... Arguments>
  [[noreturn]] void refuse(const std::string& value, fmt::format_string<Arguments...> rule,
                           Arguments&&... arguments) const {
    throw InputError(file_, "", value, fmt::format(rule, std::forward<Arguments>(arguments)...));
  }
  template <class... Arguments>
  [[noreturn]] void refuse(const Line& line, fmt::format_string<Arguments...> rule,
                           Arguments&&... arguments) const {
    refuse(fmt::format("line {}: \"{}\"", line.number, line.text), rule,
           std::forward<Arguments>(arguments)...);
  }

  static bool begins_with_number(std::string_view line) {
    line.remove_prefix(std::min(line.find_first_not_of(" \t\""), line.size()));
    if (line.starts_with('+')) line.remove_prefix(1);
    return !line.empty() && ((line[0] >= '0' && line[0] <= '9') || line[0] == '.' || line[0] == '-');
  }

  // Removes the lines before the first number, and finds the separator of fields.
  void skip_header() {
    const auto first = std::ranges::find_if(lines_, [](const Line& l) { return begins_with_number(l.text); });
    lines_.erase(lines_.begin(), first);
    for (const char candidate : {';', '\t', ' ', ','}) {
      separator_ = candidate;
      const auto is_parted = [&](const Line& line) {
        const std::vector<std::string_view> fields = fields_of(line.text, candidate);
        // In "1.0, 10" the comma is the separator, not the blank.
        return fields.size() > 1 && (candidate != ' ' || !fields[0].ends_with(','));
      };
      if (std::ranges::any_of(lines_, is_parted)) return;
    }
  }

  MeasuredSize size_in(const Line& line) const {
    const std::vector<std::string_view> fields = fields_of(line.text, separator_);
    const bool is_named = columns_.first > 0;
    if (!is_named && fields.size() < 2) refuse(line, "must be a size and its share");
    if (!is_named && fields.size() > 2) {
      refuse(line, "has {} columns: --columns must name those of size and share, such as 1,2{}",
             fields.size(), separator_ == ',' ? "; decimal fractions must not have commas as well" : "");
    }
    const auto [of_size, of_share] = is_named ? columns_ : std::pair<std::size_t, std::size_t>{1, 2};
    if (std::max(of_size, of_share) > fields.size()) {
      refuse(line, "must have {} columns", std::max(of_size, of_share));
    }
    const auto size = number_of(fields[of_size - 1], separator_),
               share = number_of(fields[of_share - 1], separator_);
    constexpr double least = 1e-30, most = 1e30;  // their cubes are normal numbers, too
    if (!size || !(*size > 0)) refuse(line, "must have a size > 0 in column {}", of_size);
    if (*size < least || *size > most)
      refuse(line, "must have sizes from {:g} to {:g} in column {}", least, most, of_size);
    if (!share || !(*share >= 0)) refuse(line, "must have a share >= 0 in column {}", of_share);
    if (*share > most) refuse(line, "must have shares up to {:g} in column {}", most, of_share);
    return {*size, *share};
  }

  // Throws InputError if the shares rise to 1 or 100, as those of a cumulative curve do.
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
             "must have the share of each size; these shares rise to the whole, as those of a cumulative "
             "curve");
    }
  }

  std::vector<Line> lines_;
  std::string file_;
  std::pair<std::size_t, std::size_t> columns_;
  char separator_ = ' ';
};

constexpr std::size_t most_choices = 12;  // number of lines that are shown

double cube(double x) { return x * x * x; }

std::pair<std::size_t, std::size_t> columns_named(const std::string& name) {
  if (name.empty()) return {0, 0};
  const std::string_view text = name;
  const std::size_t comma = text.find(',');
  if (comma != std::string_view::npos) {
    const auto size = number_in<std::size_t>(text.substr(0, comma)),
               share = number_in<std::size_t>(text.substr(comma + 1));
    if (size && share && *size > 0 && *share > 0 && *size != *share) return {*size, *share};
  }
  throw InputError("--columns", "", name, "must be the columns of size and share, such as 1,2");
}

std::vector<SizeClass> classes_of(const std::vector<MeasuredSize>& sizes, const SizesOptions& options) {
  std::vector<SizeClass> classes;
  double sum = 0;
  for (const MeasuredSize& one : sizes) {
    const double a = options.sizes == "diameter" ? one.size / 2 : one.size;
    classes.push_back({a, options.shares == "volume" ? one.share / cube(a) : one.share});
    sum += classes.back().number;
  }
  for (SizeClass& one : classes) one.number /= sum;
  return classes;
}

// Written holds radii and shares (in percent) with the six digits that a scene gets.
struct Written {
  std::vector<double> radii, shares;

  Written(const std::vector<SizeClass>& classes, bool by_volume) : by_volume_(by_volume) {
    double sum = 0;
    const auto weight = [&](const SizeClass& one) { return one.number * (by_volume ? cube(one.radius) : 1); };
    for (const SizeClass& one : classes) sum += weight(one);
    for (const SizeClass& one : classes) {
      radii.push_back(with_digits(one.radius, 6));
      shares.push_back(with_digits(100 * weight(one) / sum, 6));
    }
  }

  Particles particles() const {
    Particles all;
    all.shares = by_volume_ ? Particles::Shares::volume : Particles::Shares::number;
    for (std::size_t i = 0; i < radii.size(); ++i) all.species.push_back({radii[i], shares[i]});
    return all;
  }

  std::string block() const {
    const Json distribution = {{"form", "histogram"},
                               {"by", by_volume_ ? "volume" : "number"},
                               {"radii", radii},
                               {"shares", shares}};
    const Json species = Json::array({{{"distribution", distribution}}});
    return fmt::format("\"reference_radius\": {},\n\"species\": {}\n", Json(mean_radius()).dump(),
                       species.dump());
  }

 private:
  // Returns the mean by number, with four digits.
  double mean_radius() const {
    double number = 0, sum = 0;
    for (std::size_t i = 0; i < radii.size(); ++i) {
      const double own = shares[i] / (by_volume_ ? cube(radii[i]) : 1);
      number += own;
      sum += own * radii[i];
    }
    return with_digits(sum / number, 4);
  }

  bool by_volume_;
};

std::string spheres_text(std::size_t count) {
  return count == 0 ? fmt::format("more than {}", most_particles) : std::to_string(count);
}

}  // namespace

std::vector<MeasuredSize> measured_sizes(std::string_view text, const std::string& file,
                                         std::pair<std::size_t, std::size_t> columns) {
  return Table(text, file, columns).read();
}

std::vector<SizeClass> with_one_size_less(std::vector<SizeClass> classes) {
  const auto thinnest = std::ranges::min_element(classes, {}, &SizeClass::number);
  const auto end = classes.end();
  const bool has_left = thinnest != classes.begin(), has_right = thinnest + 1 != end;
  const bool takes_left = has_left && (!has_right || (thinnest - 1)->number <= (thinnest + 1)->number);
  const auto first = takes_left ? thinnest - 1 : thinnest, second = first + 1;
  const double number = first->number + second->number;
  const double volume = first->number * cube(first->radius) + second->number * cube(second->radius);
  *first = {std::cbrt(volume / number), number};
  classes.erase(second);
  return classes;
}

WrittenKeys choose_sizes(const SizesOptions& options) {
  const auto columns = columns_named(options.columns);
  std::vector<SizeClass> classes =
      classes_of(measured_sizes(read_input(options.file), options.file, columns), options);
  WrittenKeys answer;
  answer.remarks = fmt::format("{} sizes in {}. Number of sizes, and of spheres that give one of each:\n",
                               classes.size(), options.file);
  for (std::size_t shown = 0;; classes = with_one_size_less(std::move(classes))) {
    const Written written(classes, options.shares == "volume");
    const std::size_t spheres = smallest_count(written.particles());
    const bool is_enough = options.count == 0 || (spheres > 0 && spheres <= options.count);
    const bool is_chosen = answer.block.empty() && is_enough && classes.size() <= most_species;
    if (is_chosen) answer.block = written.block();
    if (is_chosen || shown < most_choices) {
      answer.remarks +=
          fmt::format("{:>6} {:>9}{}\n", classes.size(), spheres_text(spheres), is_chosen ? "  chosen" : "");
      ++shown;
    }
    if (classes.size() == 1) return answer;
  }
}

}  // namespace peclet::engine
