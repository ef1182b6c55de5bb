#include "runner/page/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "contract/errors.h"
#include "runner/page/figure.h"
#include "runner/page/package_module.h"

namespace peclet::runner {
namespace {

// A law's quantities, of which `--quantity` replaces the last one, and its axes. "" is the target, or the
// axis with the most values.
struct LawNeeds {
  std::string name;
  std::vector<std::string> quantities;
  std::string over;
  std::string beside;  // pointer of a second axis
};

const std::vector<LawNeeds>& laws() {
  static const std::vector<LawNeeds> all{
      {"divergence", {""}, "volume_fraction", ""},
      {"wyart-cates", {""}, "volume_fraction", "/flow/stress"},
      {"mu-of-j", {"relative_viscosity", "pressure"}, "volume_fraction", ""},
      {"herschel-bulkley", {""}, "", ""},
      {"cross", {""}, "", ""},
      {"maxwell", {"storage_modulus", "loss_modulus"}, "frequency", ""}};
  return all;
}

Json fixed_parameters(const std::vector<std::string>& texts) {
  Json fixed = Json::object();
  for (const std::string& text : texts) {
    const std::size_t sign = text.find('=');
    std::istringstream number(sign == std::string::npos ? "" : text.substr(sign + 1));
    double value = 0;
    if (!(number >> value) || !number.eof() || !std::isfinite(value))
      throw InputError("", "--fix", text, "must be NAME=VALUE, such as exponent=2");
    fixed[text.substr(0, sign)] = value;
  }
  return fixed;
}

}  // namespace

std::vector<std::string> law_names() {
  std::vector<std::string> names;
  for (const LawNeeds& law : laws()) names.push_back(law.name);
  return names;
}

FitAnswer fit_law(Database& database, const FitChoice& choice, bool in_json) {
  const auto law =
      std::find_if(laws().begin(), laws().end(), [&](const LawNeeds& one) { return one.name == choice.law; });
  std::vector<std::string> quantities = law->quantities;
  if (!choice.quantity.empty()) quantities.back() = choice.quantity;
  FigureChoice figure;
  figure.over = choice.over.empty() ? law->over : choice.over;
  Json document = {{"law", law->name},
                   {"beside", law->beside},
                   {"fixed", fixed_parameters(choice.fixed)},
                   {"free", choice.free},
                   {"from", json_or_null(choice.from)},
                   {"to", json_or_null(choice.to)},
                   {"json", in_json},
                   {"quantities", Json::array()}};
  for (const std::string& quantity : quantities) {
    figure.quantities.clear();
    if (!quantity.empty()) figure.quantities.push_back(quantity);
    const Json data = figure_data(database, figure);
    if (data.contains("axis")) {
      throw InputError("", "--quantity", quantity,
                       "has an axis of its own: a law is fitted to numbers over a swept parameter");
    }
    document["quantities"].push_back(data);
  }
  document["campaign"] = document["quantities"][0]["campaign"];
  document["over"] = document["quantities"][0]["over"];
  const Json found = answer_of_package("fit", "laws_report",
                                       "NumPy and SciPy (Debian: python3-numpy, python3-scipy)", document);
  return {found.at("text").get<std::string>(), found.at("figure")};
}

}  // namespace peclet::runner
