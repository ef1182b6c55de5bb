// From one scene and a sweep to the scenes of all points.
#pragma once

#include <string>
#include <vector>

#include "runner/campaign/campaign.h"

namespace peclet::runner {

// One direction of the grid: its pointers are set together, one row of `rows` after the other.
struct SweepEntry {
  std::vector<std::string> pointers;
  std::vector<std::vector<Json>> rows;  // rows[k][i] is what pointers[i] is set to
};

// Reads the "sweep" of a document that campaign_keys() has validated.
// Throws InputError for what is no pointer, for rows of another length than their pointers, and for two
// pointers of which one is the other or lies inside it.
std::vector<SweepEntry> read_sweep(const Json& sweep, const std::string& file);

// Sets what `pointer` names. Objects are created on the way where a key is absent; an array's element must
// exist. Throws InputError with `pointer` and the place where it leads nowhere.
void set_at(Json& scene, const std::string& pointer, const Json& value);

// The grid, the last entry varying fastest. A campaign without a sweep has one point, labelled `name`.
// Throws InputError for pointers that lead nowhere, for two equal points and for too many of them.
std::vector<StatePoint> sweep_points(const Json& scene, const std::vector<SweepEntry>& sweep,
                                     const std::string& name, const std::string& file);

// What people call the points of a sweep: "peclet=10 volume_fraction=0.5".
class SweepLabels {
 public:
  // The sweep must outlive it.
  explicit SweepLabels(const std::vector<SweepEntry>& sweep);

  // Of the point made of rows[row_of_entry[e]] of every entry e.
  std::string of(const std::vector<std::size_t>& row_of_entry) const;

 private:
  const std::vector<SweepEntry>& sweep_;
  std::vector<std::vector<std::string>> names_;  // of the pointers of every entry
};

}  // namespace peclet::runner
