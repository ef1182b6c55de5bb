// A campaign as its author wrote it: what to simulate, over which state points, how well.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "contract/json.h"
#include "contract/key_table.h"
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

struct Target {
  std::string observable;  // a number in the result's "mean"
  Tolerance tolerance;     // of the interval's half-width
  double confidence;       // of the two-sided interval

  // Of the rule by which looks decide. The first one took every look within the tolerance for converged;
  // looks that were made by it are read by it.
  static constexpr int first_rule = 1, newest_rule = 2;
  int rule = newest_rule;
};

// The largest maximum that a campaign can have: seeds are below it.
constexpr int most_realisations = 1'000'000;

struct Campaign {
  std::string name;
  Json document;                   // as read, defaults filled
  std::vector<StatePoint> points;  // in the order of the sweep: the last entry varies fastest
  Target target;
  int minimum_realisations;
  int maximum_realisations;
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
