// The table of a campaign's keys: what schema/campaign.schema.json and the manual are printed from.
#include "runner/campaign/campaign.h"

namespace peclet::runner {
namespace {

constexpr std::size_t most_further_targets = 100;
constexpr std::size_t most_shown = 1 + most_further_targets;

Key relative_tolerance(const char* pointer) {
  return {.pointer = pointer,
          .kind = KeyKind::number,
          .meaning = "Half-width of the confidence interval over |mean| that is good enough; 0.05 is 5 %.",
          .required = true,
          .minimum = 0,
          .maximum = 1,
          .above_minimum = true,
          .below_maximum = true};
}

Key absolute_tolerance(const char* pointer) {
  return {.pointer = pointer,
          .kind = KeyKind::number,
          .meaning = "Half-width that is good enough, in the observable's own unit; for what may be zero.",
          .instead_of = "relative_tolerance",
          .minimum = 0,
          .maximum = 1e100,
          .above_minimum = true};
}

Key absolute_floor(const char* pointer) {
  return {
      .pointer = pointer,
      .kind = KeyKind::number,
      .meaning =
          "Half-width that is good enough however small the mean is that relative_tolerance is a share of.",
      .minimum = 0,
      .maximum = 1e100,
      .above_minimum = true};
}

std::vector<Key> keys() {
  return {
      {.pointer = "/name",
       .kind = KeyKind::string,
       .meaning = "What people call it: at most 100 letters, digits, dots, underscores and hyphens.",
       .required = true},
      {.pointer = "/scene",
       .kind = KeyKind::object,
       .meaning = "The scene that all points share; the engine is its judge.",
       .required = true},
      {.pointer = "/sweep",
       .kind = KeyKind::array,
       .meaning = "What differs between the points. Several entries make a grid; the last varies fastest.",
       .default_value = Json::array()},
      {.pointer = "/sweep/*", .kind = KeyKind::object, .meaning = "One direction of the grid."},
      {.pointer = "/sweep/*/set",
       .kind = KeyKind::any,
       .meaning = "JSON pointer into the scene, or an array of pointers that are set in step.",
       .required = true},
      {.pointer = "/sweep/*/values",
       .kind = KeyKind::array,
       .meaning = "One per point; with several pointers each is an array with a value for every pointer.",
       .required = true,
       .minimum_items = 1},
      {.pointer = "/target",
       .kind = KeyKind::object,
       .meaning = "When a point is done. Required, unless the number of realisations is fixed."},
      {.pointer = "/target/observable",
       .kind = KeyKind::string,
       .meaning = "A number in the result's mean.",
       .default_value = usual_observable},
      relative_tolerance("/target/relative_tolerance"),
      absolute_tolerance("/target/absolute_tolerance"),
      {.pointer = "/target/relative_to",
       .kind = KeyKind::string,
       .meaning = "Another number in the result's mean, of whose |mean| relative_tolerance is a share."},
      absolute_floor("/target/absolute_floor"),
      {.pointer = "/target/also",
       .kind = KeyKind::array,
       .meaning = "Further observables; a point is done when all of them are known well enough.",
       .maximum_items = most_further_targets},
      {.pointer = "/target/also/*", .kind = KeyKind::object, .meaning = "One of them."},
      {.pointer = "/target/also/*/observable",
       .kind = KeyKind::string,
       .meaning = "A number in the result's mean.",
       .required = true},
      relative_tolerance("/target/also/*/relative_tolerance"),
      absolute_tolerance("/target/also/*/absolute_tolerance"),
      {.pointer = "/target/also/*/relative_to", .kind = KeyKind::string, .meaning = "As for the target."},
      absolute_floor("/target/also/*/absolute_floor"),
      {.pointer = "/target/confidence",
       .kind = KeyKind::number,
       .meaning = "Of the two-sided interval: Student's t, and of shares Clopper and Pearson's.",
       .default_value = usual_confidence,
       .minimum = 0.5,
       .maximum = 1,
       .above_minimum = true,
       .below_maximum = true},
      {.pointer = "/realisations",
       .kind = KeyKind::integer_or_object,
       .meaning = "How many seeds a point may take; a number without a target: how many every point gets.",
       .required = true,
       .minimum = 1,
       .maximum = most_realisations},
      {.pointer = "/realisations/minimum",
       .kind = KeyKind::integer,
       .meaning =
           "Seeds before the first look: 8 or more, because the spread of fewer is itself too uncertain to "
           "stop by; 2 or more where it equals maximum, so that there is only one look.",
       .required = true,
       .minimum = 2,
       .maximum = most_realisations},
      {.pointer = "/realisations/maximum",
       .kind = KeyKind::integer,
       .meaning = "Seeds after which a point is capped; not below the minimum.",
       .required = true,
       .minimum = 2,
       .maximum = most_realisations},
      {.pointer = "/show",
       .kind = KeyKind::array,
       .meaning = "Where the number of realisations is fixed: numbers in the result's mean that tables show, "
                  "the first one also charts; relative_viscosity unless given.",
       .minimum_items = 1,
       .maximum_items = most_shown},
      {.pointer = "/show/*", .kind = KeyKind::string, .meaning = "One of them."},
      {.pointer = "/keep_files",
       .kind = KeyKind::any,
       .meaning = "Which of the files are kept that realisations leave beside their results: \"all\" (unless "
                  "given), \"none\", or those of so many first seeds of each point."},
      {.pointer = "/engine",
       .kind = KeyKind::array,
       .meaning =
           "Program and arguments. Without a slash it is looked for beside peclet, then on PATH, "
           "then among peclet's own adapters (lammps_engine.py); a relative path starts at the campaign "
           "file, in whose folder it runs.",
       .default_value = Json::array({"peclet-engine", "serve"}),
       .minimum_items = 1},
      {.pointer = "/engine/*", .kind = KeyKind::string, .meaning = "A word of the command."},
  };
}

}  // namespace

const KeyTable& campaign_keys() {
  static const KeyTable table("A campaign of peclet", keys());
  return table;
}

}  // namespace peclet::runner
