#include "engine/output/summary.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <vector>

#include "engine/observables/production.h"
#include "engine/realisation/ending.h"

namespace peclet::engine {
namespace {

std::string line(const char* name, const std::string& text) { return fmt::format("{:<12}{}\n", name, text); }

// The standard error of the mean of a series that is correlated; no error of blocks that are all equal.
double standard_error(const std::vector<double>& series) {
  const auto n = static_cast<double>(series.size());
  double mean = 0, squares = 0;
  for (const double x : series) mean += x / n;
  for (const double x : series) squares += (x - mean) * (x - mean);
  return std::sqrt(statistical_inefficiency(series) * squares / (n - 1) / n);
}

std::string with_error(const Json& result, const char* name) {
  const double mean = result.at("mean").at(name).get<double>();
  std::vector<double> series;  // what has jammed has blocks of which nothing is known
  for (const Json& block : result.at("blocks").at(name)) {
    if (block.is_number()) series.push_back(block.get<double>());
  }
  if (series.size() < 2) return fmt::format("{:.4g}", mean);
  return fmt::format("{:.4g} ± {:.2g}", mean, standard_error(series));
}

std::string means(const Json& result) {
  const bool sheared = !result.at("mean").at("relative_viscosity").is_null();
  const auto value = [&](const char* name) { return with_error(result, name); };
  std::string text;
  if (sheared) {
    text += line("viscosity", fmt::format("{} relative to the solvent; {} of pairs alone",
                                          value("relative_viscosity"), value("relative_viscosity_pair")));
  }
  const Json& mean = result.at("mean");
  if (mean.contains("shear_rate")) {
    const Json& viscosity = mean.at("apparent_viscosity");
    const double stress = viscosity.at("stress").get<double>();
    const double viscous = viscosity.at("viscous_stress").get<double>();
    const std::string relative =
        viscous > 0 ? fmt::format("; viscosity {:.4g} relative to the solvent", stress / viscous) : "";
    const std::string rate = result.at("ending").at("cause") == name_of(Ending::Cause::jammed)
                                 ? fmt::format("{:.4g}", mean.at("shear_rate").get<double>())
                                 : value("shear_rate");
    text += line("shear rate", fmt::format("{} at a stress of {:.4g}{}", rate, stress, relative));
  }
  if (mean.value("loss_modulus", Json()).is_number()) {
    const auto number = [&](const char* name) { return mean.at(name).get<double>(); };
    text += line("moduli",
                 fmt::format("G' {:.4g}, G'' {:.4g}, in units of the scene; G''/(eta w) {:.4g}",
                             number("storage_modulus"), number("loss_modulus"), number("dynamic_viscosity")));
  }
  const char* const unit = sheared ? " viscosity * shear rate" : ", in units of the scene";
  text += line("N1, N2", fmt::format("{}, {}{}", value("first_normal_difference"),
                                     value("second_normal_difference"), unit));
  text += line("pressure", value("pressure") + unit);
  text += line("contacts", fmt::format("{} per sphere; overlaps {:.2g} radii in the mean, {:.2g} at most",
                                       value("contacts_per_particle"), mean.at("mean_overlap").get<double>(),
                                       result.at("largest_overlap").get<double>()));
  return text;
}

std::string steps(const Json& result) {
  const Json& strain = result.at("strain");
  return fmt::format("{} + {} {} ones of {:.4g}, a strain of {:.4g} + {:.4g}",
                     result.at("steps").at("equilibration").get<std::uint64_t>(),
                     result.at("steps").at("production").get<std::uint64_t>(),
                     result.at("method").get<std::string>(), result.at("timestep").get<double>(),
                     strain.at("equilibration").get<double>(), strain.at("production").get<double>());
}

std::string warnings(const Json& result) {
  std::string text;
  for (const Json& warning : result.at("warnings")) {
    text += line("warning", fmt::format("{}: {}", warning.at("code").get<std::string>(),
                                        warning.at("message").get<std::string>()));
  }
  return text.empty() ? line("warnings", "none") : text;
}

}  // namespace

std::string summary(const Json& result, const std::string& place) {
  const Json& cost = result.at("cost");
  return means(result) + line("errors", "± standard error within this run, of one seed") +
         line("steps", steps(result)) + warnings(result) +
         line("cost",
              fmt::format("{:.3g} s of processor time in {:.3g} s", cost.at("cpu_seconds").get<double>(),
                          cost.at("wall_seconds").get<double>())) +
         line("result", fmt::format("seed {}, {}", result.at("seed").get<std::uint64_t>(), place));
}

std::string result_text(const Json& result) {
  constexpr const char* first[] = {"schema_version",           "point",   "seed", "ending", "units", "mean",
                                   "statistical_inefficiency", "warnings"};
  constexpr const char* last = "blocks";
  nlohmann::ordered_json ordered = nlohmann::ordered_json::object();
  for (const char* name : first) ordered[name] = result.at(name);
  for (const auto& [name, value] : result.items()) {
    if (name != last && !ordered.contains(name)) ordered[name] = value;
  }
  ordered[last] = result.at(last);
  return ordered.dump(1) + "\n";
}

}  // namespace peclet::engine
