#include "engine/observables/accumulators.h"

namespace peclet::engine {

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
