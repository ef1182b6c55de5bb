#include "engine/sizes/size_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "contract/input_error.h"
#include "contract/input_file.h"
#include "contract/json.h"
#include "contract/text_lines.h"
#include "engine/scene/smallest_count.h"
#include "engine/scene/species_list.h"
#include "engine/sizes/measured_sizes.h"

namespace peclet::engine {
namespace {

constexpr std::size_t most_choices = 12;  // that are shown

double cube(double x) { return x * x * x; }

double six_digits(double value) { return std::stod(fmt::format("{:.6g}", value)); }

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

// Sizes with the digits with which a scene gets them: radii, and shares of 100.
struct Written {
  std::vector<double> radii, shares;

  Written(const std::vector<SizeClass>& classes, bool by_volume) : by_volume_(by_volume) {
    double sum = 0;
    const auto weight = [&](const SizeClass& one) { return one.number * (by_volume ? cube(one.radius) : 1); };
    for (const SizeClass& one : classes) sum += weight(one);
    for (const SizeClass& one : classes) {
      radii.push_back(six_digits(one.radius));
      shares.push_back(six_digits(100 * weight(one) / sum));
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
    return "\"species\": " + species.dump() + '\n';
  }

 private:
  bool by_volume_;
};

std::string spheres_text(std::size_t count) {
  return count == 0 ? fmt::format("more than {}", most_particles) : std::to_string(count);
}

}  // namespace

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

SizesAnswer choose_sizes(const SizesOptions& options) {
  const auto columns = columns_named(options.columns);
  std::vector<SizeClass> classes =
      classes_of(measured_sizes(read_input(options.file), options.file, columns), options);
  SizesAnswer answer;
  answer.remarks = fmt::format("{} sizes in {}. So many sizes take so many spheres for one of each:\n",
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
