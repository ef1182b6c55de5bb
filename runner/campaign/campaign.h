// Reads and checks a campaign file: the scene, the state points, the target and the engine.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "contract/documents.h"
#include "contract/json.h"
#include "runner/campaign/tolerance.h"

namespace peclet::runner {

// One scene of the sweep. Its identity is the SHA-256 of the canonical JSON of the scene. The same scene in
// another campaign, or with its keys in another order, is therefore the same point.
struct StatePoint {
  std::string hash;
  Json scene;
  Json settings;      // the values that the sweep sets: {"/peclet": 10, "/volume_fraction": 0.5}
  std::string label;  // for people: "peclet=10 volume_fraction=0.5"
};

// Points of a sweep that differ in the rows of one entry only. A curve is estimated from four or more: its
// trend takes two, its amplitude and length two more.
constexpr std::size_t fewest_of_curve = 4;
struct Curve {
  std::vector<std::size_t> points;  // places in the sweep, in the order of the rows
  std::vector<double> axis;         // value of each point
  // Number of spheres of each point, /particles/count of its scene, which makes a step dear; 1 without the
  // key. Empty: alike.
  std::vector<double> spheres{};
};

// The defaults of a campaign's observable and of the confidence of its intervals.
constexpr const char* usual_observable = "relative_viscosity";
constexpr double usual_confidence = 0.95;

// An observable with its tolerance.
struct Criterion {
  std::string observable;  // path of a number in the result's "mean"
  Tolerance tolerance;     // of the interval's half-width
  friend bool operator==(const Criterion&, const Criterion&) = default;
};

// The criteria that each point is to meet. With a fixed number of realisations no criterion has a tolerance,
// and the observables are only shown.
struct Target {
  std::string observable;  // the leading one, which tables and charts show
  Tolerance tolerance;
  double confidence;  // of each two-sided interval

  std::vector<Criterion> also{};  // must be met, too

  bool has_tolerance() const { return tolerance.kind != Tolerance::Kind::none; }
  // Returns the pointer over which its criteria have curves, the same for all of them; "" without a curve.
  std::string over() const;

  // Returns the observables to be read from each result, each once: the leading one, those of `also`, then
  // those to which a tolerance is relative.
  std::vector<std::string> observables() const;
  // Returns all criteria, the leading one first.
  std::vector<Criterion> criteria() const;
  friend bool operator==(const Target&, const Target&) = default;
};

// Returns "relative_viscosity to 5 %, pressure to 0.1", or without tolerances "relative_viscosity, pressure".
std::string to_string(const std::vector<Criterion>& criteria);
std::string to_string(const Target& target);
// Returns the pointer at which a campaign names an observable: "/target/also/0/observable", "/show/1".
std::string pointer_of(const Target& target, const std::string& observable);

// Returns {"observable": ..., "relative_tolerance": 0.05, "confidence": 0.95, "also": [...]} as in a campaign
// file. "also" is left out if empty, and tolerances if there are none.
Json to_json(const Target& target);
// Returns to_json() without observable and confidence.
Json criterion_json(const Target& target);
// Returns the target with the tolerances and "also" of `criterion`. Throws InputError at /target of `file`.
Target target_of(const std::string& observable, const Json& criterion, double confidence,
                 const std::string& file = "");

struct Campaign {
  std::string name;
  Json document;                   // as read, with defaults
  std::vector<StatePoint> points;  // in the order of the sweep: the last entry varies fastest
  std::vector<Curve> curves{};     // if the target has any
  Target target;
  int minimum_realisations;
  int maximum_realisations;                  // equal to the minimum if the number is fixed
  std::vector<std::string> engine;           // program and arguments
  int seeds_with_files = most_realisations;  // first seeds of each point whose files are kept
  int most_values = 0;  // of the curves' axis, up to which a run chooses some; 0: it chooses none

  bool keeps_files_of(int seed) const { return seed < seeds_with_files; }
};

const KeyTable& campaign_keys();

// Returns the curves of a target in a campaign that has been read; none if it has no curve. Throws InputError
// as curves_over().
std::vector<Curve> curves_of(const Json& document, const Target& target, const std::string& file = "");

// Values of the curves' axis that runs choose (/choose) are kept in the stored document, at /choose/values.

// Returns the values that were chosen for the target's curves.
Json chosen_values(const Json& document);
// Returns the sweep of a document together with the values that were chosen for the target's curves.
Json whole_sweep(const Json& document, const Target& target);
// Returns the document with one more chosen value.
Json with_chosen_value(Json document, double value);
// Returns the document with the values that were chosen for `before`, if the sweep, the scene and the curve
// are those of `before` and it has no values of its own.
Json keeping_chosen_values(Json document, const Json& before);

// Reads and checks a campaign; the engine checks its scenes. Throws InputError with file, pointer, value and
// what is allowed.
Campaign read_campaign(const std::filesystem::path& path);
// Checks a campaign that has been read from `file`. Throws as read_campaign().
Campaign parse_campaign(const Json& written, const std::string& file);

// Throws InputError at /name of `file` unless the name is made of letters, digits, dots, underscores and
// hyphens.
void check_campaign_name(const std::string& name, const std::string& file);

}  // namespace peclet::runner
