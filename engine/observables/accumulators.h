// Registers the quantities that an observable measures, and accumulates them over the production window.
//
// A quantity is registered once: its description, with its accumulator or with a function that computes it.
// The numbers of the result, their blocks and descriptions, the targets of campaigns and the content of
// checkpoints follow from the registration.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "contract/json.h"
#include "engine/state/archive.h"
#include "engine/state/vector3.h"

namespace peclet::engine {

// The blocks that means keep besides the window: 32 for a number, the four quarters of the window (which the
// test for transients compares) for lists of up to 64 elements, none for longer lists.
constexpr std::size_t count_of_blocks = 32;
constexpr std::size_t count_of_quarters = 4;
constexpr std::size_t most_elements_with_blocks = 64;

// Returns the number of blocks that a mean of this shape keeps.
inline std::size_t blocks_kept(const std::vector<std::size_t>& shape) {
  if (shape.empty()) return count_of_blocks;
  return shape.back() > most_elements_with_blocks ? 0 : count_of_quarters;
}

// Rounds every number to five significant digits: far below the scatter of a block, and less than half as
// long as all seventeen. Other values stay as they are.
Json rounded(const Json& number);

// A mean over the production window and over its blocks: a sum of values over a sum of weights.
class BlockedMean {
 public:
  // Makes the mean of a number (no shape) or of nested lists of these lengths, the outermost first.
  explicit BlockedMean(const std::vector<std::size_t>& shape = {}) : BlockedMean(shape, blocks_kept(shape)) {}
  // Divides the window into `kept` equal blocks, at most 32.
  BlockedMean(const std::vector<std::size_t>& shape, std::size_t kept);

  // Adds to the sum of an element, numbered through all lists. `block` is 0 to 31.
  void add(std::size_t block, std::size_t element, double value);
  // Adds to the weight by which all elements are divided.
  void weigh(std::size_t block, double weight);

  // Returns the mean over the window, with null for a number or an innermost list without weight.
  Json value() const;
  // Returns a list with the mean of each block in five digits, or null if no blocks are kept.
  Json blocks() const;

  void save(ArchiveWriter& archive) const { archive.put_all(sums_, blocks_, weight_, block_weights_); }
  void load(ArchiveReader& archive) { archive.get_all(sums_, blocks_, weight_, block_weights_); }

 private:
  Json means(std::span<const double> sums, double weight, std::size_t axis = 0) const;

  std::vector<std::size_t> shape_;
  std::size_t kept_;
  std::vector<double> sums_;    // sums over the window
  std::vector<double> blocks_;  // a row of sums for each block
  double weight_ = 0;
  std::vector<double> block_weights_;
};

struct Axis {
  std::string name, unit;  // "1": a pure number
  Json values;             // numbers or words, one for each entry of the list
};

// Returns the axis of the values value_at(0), value_at(1) ...
template <class Value>
Axis axis_of(const std::string& name, const std::string& unit, std::size_t count, const Value& value_at) {
  Axis axis{name, unit, Json::array()};
  for (std::size_t k = 0; k < count; ++k) axis.values.push_back(value_at(k));
  return axis;
}

// Returns the axis of these lags [samples] in time, with samples `between` apart.
inline Axis axis_of_lags(const std::string& name, const std::vector<std::uint64_t>& lags, double between) {
  return axis_of(name, "time", lags.size(),
                 [&](std::size_t k) { return between * static_cast<double>(lags[k]); });
}

// Return the components of a symmetric tensor, in the order of every result, and their axis.
inline std::vector<double> components_of(const SymmetricTensor& t) {
  return {t.xx, t.yy, t.zz, t.xy, t.xz, t.yz};
}
inline Axis axis_of_components() { return {"component", "1", {"xx", "yy", "zz", "xy", "xz", "yz"}}; }

// A ratio of means. The quantity's object in the result has two members of these names, each a mean or a sum
// over the window. Both are averaged over the seeds before they are divided. One may be a number while the
// other has axes.
struct RatioOfMeans {
  std::string numerator, denominator;
};

struct Quantity {
  std::string name;          // its path in the result's "mean" (and "blocks"): "pressure", "stress/total"
  std::string symbol, unit;  // "1": a pure number
  std::vector<Axis> axes{};  // empty for a scalar; otherwise of nested lists, the outermost first
  std::optional<RatioOfMeans> ratio{};  // absent if its values are means
  bool is_share = false;                // a scalar that is 0 or 1 in each realisation
};

Json to_json(const Quantity& quantity);

// Returns the names that a campaign may target: that of a scalar, or "NAME/*" with a star for the index of
// each axis. Returns nothing for a ratio, which is not a mean over seeds.
std::vector<std::string> targets_in(const Quantity& quantity);

class Accumulators {
 public:
  using Numbers = std::function<Json()>;

  Accumulators() { keep(means_); }
  Accumulators(const Accumulators&) = delete;
  Accumulators& operator=(const Accumulators&) = delete;

  // Registers a mean of the shape of the quantity's axes, and its blocks.
  BlockedMean& mean(const Quantity& quantity) { return mean_if(true, quantity); }
  // Makes a mean that the result has only if `is_reported`, with `blocks` blocks or the usual number.
  BlockedMean& mean_if(bool is_reported, const Quantity& quantity, std::optional<std::size_t> blocks = {});
  // Registers a ratio of means and returns its numerator. `denominator` must have the same shape.
  BlockedMean& ratio(const Quantity& quantity, const BlockedMean& denominator);
  // Registers a quantity that `value` computes when the result is written; `blocks` may compute its blocks.
  void derive(const Quantity& quantity, Numbers value, Numbers blocks = nullptr);
  // Registers a value without a description, for example the points of an axis.
  void beside(const std::string& name, const Json& value);
  // Registers state that checkpoints must have besides the means.
  template <class... Parts>
  void keep(Parts&... parts) {
    saved_.emplace_back([&](ArchiveWriter& archive) { archive.put_all(parts...); });
    loaded_.emplace_back([&](ArchiveReader& archive) { archive.get_all(parts...); });
  }

  const std::vector<Quantity>& quantities() const { return quantities_; }
  // Adds all numbers to the result's means; their names are paths. Requires at least one sample.
  void add_to(Json& mean) const;
  // Adds the blocks of quantities that have them. Functions of lags up to the whole window have none.
  void add_blocks_to(Json& blocks) const;

  // Save and load all accumulated state, bit by bit.
  void save(ArchiveWriter& archive) const;
  void load(ArchiveReader& archive);

 private:
  struct Named {
    std::string name;
    Numbers numbers;
  };
  std::vector<Quantity> quantities_;
  std::vector<Named> values_, blocks_;
  std::deque<BlockedMean> means_;
  std::vector<std::function<void(ArchiveWriter&)>> saved_;
  std::vector<std::function<void(ArchiveReader&)>> loaded_;
};

}  // namespace peclet::engine
