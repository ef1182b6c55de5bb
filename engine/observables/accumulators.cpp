#include "engine/observables/accumulators.h"

#include <numeric>

#include "contract/decimal.h"

namespace peclet::engine {

Json rounded(const Json& number) {
  if (number.is_array()) {
    Json list = Json::array();
    for (const Json& element : number) list.push_back(rounded(element));
    return list;
  }
  if (!number.is_number()) return number;
  return with_digits(number.get<double>(), 5);
}

BlockedMean::BlockedMean(const std::vector<std::size_t>& shape, std::size_t kept)
    : shape_(shape),
      kept_(kept),
      sums_(std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>())),
      blocks_(kept_ * sums_.size()),
      block_weights_(kept_) {}

void BlockedMean::add(std::size_t block, std::size_t element, double value) {
  sums_[element] += value;
  if (kept_ > 0) blocks_[block * kept_ / count_of_blocks * sums_.size() + element] += value;
}

void BlockedMean::weigh(std::size_t block, double weight) {
  weight_ += weight;
  if (kept_ > 0) block_weights_[block * kept_ / count_of_blocks] += weight;
}

Json BlockedMean::means(std::span<const double> sums, double weight, std::size_t axis) const {
  Json list = Json::array();
  if (axis + 1 < shape_.size()) {
    const std::size_t length = sums.size() / shape_[axis];
    for (std::size_t k = 0; k < shape_[axis]; ++k)
      list.push_back(means(sums.subspan(k * length, length), weight, axis + 1));
    return list;
  }
  if (!(weight > 0)) return nullptr;
  if (shape_.empty()) return sums.front() / weight;
  for (const double sum : sums) list.push_back(sum / weight);
  return list;
}

Json BlockedMean::value() const { return means(sums_, weight_); }

Json BlockedMean::blocks() const {
  if (kept_ == 0) return nullptr;
  Json list = Json::array();
  for (std::size_t block = 0; block < kept_; ++block) {
    const std::span<const double> row(&blocks_[block * sums_.size()], sums_.size());
    list.push_back(rounded(means(row, block_weights_[block])));
  }
  return list;
}

namespace {

std::vector<std::size_t> shape_of(const Quantity& quantity) {
  std::vector<std::size_t> shape;
  for (const Axis& axis : quantity.axes) shape.push_back(axis.values.size());
  return shape;
}

}  // namespace

Json to_json(const Quantity& quantity) {
  Json json = {{"symbol", quantity.symbol},
               {"unit", quantity.unit},
               {"estimator", quantity.is_share ? "share" : "mean"}};
  for (const Axis& axis : quantity.axes) {
    json["axes"].push_back({{"name", axis.name}, {"unit", axis.unit}, {"values", axis.values}});
  }
  if (quantity.ratio) {
    json["estimator"] = "ratio";
    json["numerator"] = quantity.ratio->numerator;
    json["denominator"] = quantity.ratio->denominator;
  }
  return json;
}

std::vector<std::string> targets_in(const Quantity& quantity) {
  if (quantity.ratio) return {};
  std::string name = quantity.name;
  for (std::size_t axis = 0; axis < quantity.axes.size(); ++axis) name += "/*";
  return {name};
}

BlockedMean& Accumulators::mean_if(bool is_reported, const Quantity& quantity,
                                   std::optional<std::size_t> blocks) {
  const std::vector<std::size_t> shape = shape_of(quantity);
  BlockedMean& mean = means_.emplace_back(shape, blocks.value_or(blocks_kept(shape)));
  if (is_reported) {
    derive(
        quantity, [&mean] { return mean.value(); }, [&mean] { return mean.blocks(); });
  }
  return mean;
}

BlockedMean& Accumulators::ratio(const Quantity& quantity, const BlockedMean& denominator) {
  BlockedMean& numerator = means_.emplace_back(shape_of(quantity));
  const RatioOfMeans names = *quantity.ratio;
  const auto both = [=](const Json& above, const Json& below) {
    return above.is_null() ? Json() : Json{{names.numerator, above}, {names.denominator, below}};
  };
  derive(
      quantity, [=, &numerator, &denominator] { return both(numerator.value(), denominator.value()); },
      [=, &numerator, &denominator] { return both(numerator.blocks(), denominator.blocks()); });
  return numerator;
}

void Accumulators::derive(const Quantity& quantity, Numbers value, Numbers blocks) {
  quantities_.push_back(quantity);
  values_.push_back({quantity.name, std::move(value)});
  if (blocks) blocks_.push_back({quantity.name, std::move(blocks)});
}

void Accumulators::beside(const std::string& name, const Json& value) {
  values_.push_back({name, [value] { return value; }});
}

void Accumulators::add_to(Json& mean) const {
  for (const Named& one : values_) mean[Json::json_pointer('/' + one.name)] = one.numbers();
}

void Accumulators::add_blocks_to(Json& blocks) const {
  for (const Named& one : blocks_) {
    if (Json lists = one.numbers(); !lists.is_null()) {
      blocks[Json::json_pointer('/' + one.name)] = std::move(lists);
    }
  }
}

void Accumulators::save(ArchiveWriter& archive) const {
  for (const auto& put : saved_) put(archive);
}

void Accumulators::load(ArchiveReader& archive) {
  for (const auto& get : loaded_) get(archive);
}

}  // namespace peclet::engine
