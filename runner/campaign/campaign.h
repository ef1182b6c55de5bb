// A campaign as its author wrote it: what to simulate, over which state points, how well.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "contract/documents.h"
#include "contract/json.h"
#include "runner/campaign/tolerance.h"

namespace peclet::runner {

// One scene of the sweep. Its identity is the SHA-256 of the canonical JSON of the scene, so the same scene
// in another campaign, or written with its keys in another order, is the same point.
struct StatePoint {
  std::string hash;
  Json scene;
  Json settings;      // what the sweep set: {"/peclet": 10, "/volume_fraction": 0.5}
  std::string label;  // for people: "peclet=10 volume_fraction=0.5"
};

// What a campaign aims at or shows unless it says otherwise, and its level of intervals.
constexpr const char* usual_observable = "relative_viscosity";
constexpr double usual_confidence = 0.95;

// How well one observable is to be known.
struct Criterion {
  std::string observable;  // a number in the result's "mean"
  Tolerance tolerance;     // of the interval's half-width
  friend bool operator==(const Criterion&, const Criterion&) = default;
};

// What is to be known of each point. In a campaign of a fixed number of realisations no criterion has a
// tolerance, and the observables are those that are shown.
struct Target {
  std::string observable;  // the one that tables and charts show
  Tolerance tolerance;
  double confidence;  // of each two-sided interval

  std::vector<Criterion> also{};  // must be met, too

  bool has_tolerance() const { return tolerance.kind != Tolerance::Kind::none; }

  // What is taken from each result: the observable, those of `also`, then whatever else a tolerance is a
  // share of. Each once.
  std::vector<std::string> observables() const;
  // Every criterion, the leading one first.
  std::vector<Criterion> criteria() const;
  friend bool operator==(const Target&, const Target&) = default;
};

// "relative_viscosity to 5 %, pressure to 0.1"; "relative_viscosity, pressure" without tolerances
std::string to_string(const std::vector<Criterion>& criteria);
std::string to_string(const Target& target);
// Where a campaign names one of Target::observables(): "/target/also/0/observable", "/show/1".
std::string pointer_of(const Target& target, const std::string& observable);

// {"observable": ..., "relative_tolerance": 0.05, "confidence": 0.95, "also": [...]}: as the campaign file
// has it, "also" only where it is not empty; without tolerances where it has none.
Json to_json(const Target& target);
// The same without observable and confidence.
Json criterion_json(const Target& target);
// A target of these, with the tolerances of `criterion` or none. Throws InputError at /target of `file`.
Target target_of(const std::string& observable, const Json& criterion, double confidence,
                 const std::string& file = "");

struct Campaign {
  std::string name;
  Json document;                   // as read, defaults filled
  std::vector<StatePoint> points;  // in the order of the sweep: the last entry varies fastest
  Target target;
  int minimum_realisations;
  int maximum_realisations;                  // equal to the minimum where the number is fixed
  std::vector<std::string> engine;           // program and arguments
  int seeds_with_files = most_realisations;  // of each point: what later ones leave beside their results goes

  bool keeps_files_of(int seed) const { return seed < seeds_with_files; }
};

const KeyTable& campaign_keys();

// Reads and checks a campaign. The scenes themselves are the engine's to judge.
// Throws InputError naming file, pointer, value and what is allowed.
Campaign read_campaign(const std::filesystem::path& path);
// The same of a document that has been read from `file`.
Campaign parse_campaign(const Json& written, const std::string& file);

// Throws InputError at /name of `file` unless the name is made of letters, digits, dots, underscores and
// hyphens.
void check_campaign_name(const std::string& name, const std::string& file);

}  // namespace peclet::runner
