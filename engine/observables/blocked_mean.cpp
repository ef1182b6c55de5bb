#include "engine/observables/blocked_mean.h"

#include <fmt/format.h>

#include <functional>
#include <numeric>
#include <string>

namespace peclet::engine {

Json rounded(const Json& number) {
  if (number.is_array()) {
    Json list = Json::array();
    for (const Json& element : number) list.push_back(rounded(element));
    return list;
  }
  if (!number.is_number()) return number;
  return std::stod(fmt::format("{:.5g}", number.get<double>()));
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

}  // namespace peclet::engine
