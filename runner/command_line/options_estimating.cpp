// The verb that makes one number of the points of a curve.
#include <memory>

#include "runner/command_line/print.h"
#include "runner/command_line/verb_set.h"
#include "runner/jamming/find_jamming.h"

namespace peclet::runner {
namespace {

void show_jamming(const JammingOptions& options) {
  const JammingAnswer answer = find_jamming(options);
  print(answer.text);
  if (!answer.message.empty()) say(answer.message);
}

void add_law_options(CLI::App* verb, JammingOptions& options) {
  verb->add_option("--by", options.by, "Definition of the jamming point; both unless given")
      ->type_name("DEFINITION")
      ->check(CLI::IsMember({"law", "steepest"}));
  add_number(verb, "--exponent", options.exponent, number_above(0),
             "Exponent of the law; fitted unless given");
  verb->add_flag("--common-exponent", options.common_exponent, "One exponent, fitted, for all curves");
  verb->add_flag("--unit-prefactor", options.unit_prefactor,
                 "A law that is 1 without particles, (1 - phi / phi_m)^-exponent");
  add_number(verb, "--above", options.above, number_from(0),
             "The law is of the points whose viscosity is above")
      ->capture_default_str();
  add_number(verb, "--softest", options.curves.softest, number_above(0),
             "Mean overlap of contacts, in radii, up to which spheres are taken for hard")
      ->capture_default_str();
}

void add_proposing_options(CLI::App* verb, JammingOptions& options) {
  verb->add_flag("--propose", options.propose,
                 "Say which fractions to run next, with a patch of the campaign file");
  add_number(verb, "--budget", options.budget, number_above(0),
             "Processor time for what is proposed; one point a curve unless given")
      ->type_name("SECONDS");
  verb->add_option("--write", options.write,
                   "New campaign file with the proposed points; a file that is there is never replaced")
      ->type_name(value_name::file);
}

}  // namespace

void add_estimating_verbs(VerbSet& verbs) {
  const auto options = std::make_shared<JammingOptions>();
  CLI::App* const verb = verbs.add(
      "jamming", "Estimate the volume fraction of jamming from the points of a sweep",
      "peclet jamming friction.json",
      page(
          R"(
Makes a curve of viscosity over volume fraction for each value of what else is swept, and gives its jamming
point phi_m by two definitions: where a power law A (1 - phi / phi_m)^-beta through the flowing points above
a viscosity of 10 diverges, and where the viscosity rises most steeply. Errors are of the seeds; where the
points leave phi_m open it is not determined, and the reason is said.

A point is jammed when half of its seeds or more ended so: the engine's causes overlap, packing and jammed.
It is soft, and no part of the law, when its contacts overlap by more than 0.1 % of a radius in the mean; of
results without that mean, when the largest overlap is above ten times as much.

--propose says which fraction would tell most: the one that lessens the error of the law, or where there is no
law yet the one half-way between what flows and what is jammed. Fractions go into the sweep, for all curves.
Points are known by their scenes: what has been run is not run again.

The fits are made by python3 of PATH with NumPy, and by the package peclet that is installed with this program.
Without one of them the verb ends with 1, and says what is missing and what it would have run.
)",
          {{"peclet jamming friction.json --unit-prefactor --above 1", "the law that holds at all fractions"},
           {"peclet jamming friction.json --by law --exponent 2 --json", "for programs; schema/README.md"},
           {"peclet jamming friction.json --propose --budget 3600 --write next.json",
            "a campaign file with points for an hour of processor time"}},
          {0, 1, 2, 6}));
  add_file_or_folder(verb, options->campaign);
  add_directory(verb, options->directory);
  verb->add_option("--over", options->curves.over,
                   "Swept volume fraction: its pointer or the last word of it")
      ->type_name("PARAMETER")
      ->capture_default_str();
  verb->add_option("--quantity", options->curves.quantity, "Viscosity, as `export` calls it")
      ->type_name("NAME")
      ->capture_default_str();
  add_law_options(verb, *options);
  add_proposing_options(verb, *options);
  verb->add_flag("--json", options->json, "For programs");
  verbs.choose(verb, options, show_jamming);
}

}  // namespace peclet::runner
