// Makes the scenes of all points from one scene and a sweep.
#pragma once

#include <string>
#include <vector>

#include "runner/campaign/campaign.h"

namespace peclet::runner {

// One axis of the grid: its pointers are set together, to one row of values after the other.
struct SweepEntry {
  std::vector<std::string> pointers;
  std::vector<std::vector<Json>> rows;  // rows[k][i] is a value of pointers[i]
};

// Returns the sweep of a document that campaign_keys() has validated with lists in the place of ranges, such
// as { "from": 0.01, "to": 1e4, "points": 7, "spaced": "log" }. Values between the ends have six digits.
// Throws InputError for logarithmic ranges with an end that is not above 0, for values that do not differ,
// for a range with several pointers, and for too many points.
Json without_ranges(Json sweep, const std::string& file);

// Reads the "sweep" of a document that campaign_keys() has validated, without ranges. Throws InputError for
// an invalid pointer, for a row that has not one value per pointer, and for pointers of which one contains
// the other.
std::vector<SweepEntry> read_sweep(const Json& sweep, const std::string& file);

// Sets the value at `pointer`. Absent objects on its way are created; elements of arrays must exist. Throws
// InputError with `pointer` and the step that leads nowhere.
void set_at(Json& scene, const std::string& pointer, const Json& value);

// Returns the points of the grid, the last entry varying fastest; without a sweep one point, labelled `name`.
// Throws InputError for pointers that lead nowhere, for equal points and for too many points.
std::vector<StatePoint> sweep_points(const Json& scene, const std::vector<SweepEntry>& sweep,
                                     const std::string& name, const std::string& file);

// Returns the curves along the entry of the sweep that sets `over`, for points made of this scene. Throws
// InputError at `pointer` if no entry sets it, for values that are no numbers or not different, and for fewer
// than fewest_of_curve.
std::vector<Curve> curves_over(const std::string& over, const Json& scene,
                               const std::vector<SweepEntry>& sweep, const std::string& file,
                               const std::string& pointer);

// Returns the sweep of a document with one more value of `over`, which an entry must set to numbers. The
// other pointers of the entry are set as in the row with the nearest value, on a logarithmic axis if all
// values are above 0. The row stands before the first larger value if the values ascend, and last otherwise.
Json with_value_along(Json sweep, const std::string& over, double value);

// Labels the points of a sweep for people: "peclet=10 volume_fraction=0.5".
class SweepLabels {
 public:
  // The sweep must outlive the labels.
  explicit SweepLabels(const std::vector<SweepEntry>& sweep);

  // Returns the label of the point with rows[row_of_entry[e]] of every entry e.
  std::string of(const std::vector<std::size_t>& row_of_entry) const;

 private:
  const std::vector<SweepEntry>& sweep_;
  std::vector<std::vector<std::string>> names_;  // of the pointers of every entry
};

}  // namespace peclet::runner
