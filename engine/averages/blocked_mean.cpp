#include "engine/averages/blocked_mean.h"

#include <fmt/format.h>

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

BlockedMean::BlockedMean(std::size_t elements, std::size_t kept, bool is_list)
    : is_list_(is_list), kept_(kept), sums_(elements), blocks_(kept_ * elements), block_weights_(kept_) {}

void BlockedMean::add(std::size_t block, std::size_t element, double value) {
  sums_[element] += value;
  if (kept_ > 0) blocks_[block * kept_ / count_of_blocks * sums_.size() + element] += value;
}

void BlockedMean::weigh(std::size_t block, double weight) {
  weight_ += weight;
  if (kept_ > 0) block_weights_[block * kept_ / count_of_blocks] += weight;
}

Json BlockedMean::ratio(std::span<const double> sums, double weight) const {
  if (!(weight > 0)) return nullptr;
  if (!is_list_) return sums.front() / weight;
  Json list = Json::array();
  for (const double sum : sums) list.push_back(sum / weight);
  return list;
}

Json BlockedMean::value() const { return ratio(sums_, weight_); }

Json BlockedMean::blocks() const {
  if (kept_ == 0) return nullptr;
  Json list = Json::array();
  for (std::size_t block = 0; block < kept_; ++block) {
    const std::span<const double> row(&blocks_[block * sums_.size()], sums_.size());
    list.push_back(rounded(ratio(row, block_weights_[block])));
  }
  return list;
}

void BlockedMean::save(ArchiveWriter& archive) const {
  archive.put(sums_);
  archive.put(blocks_);
  archive.put(weight_);
  archive.put(block_weights_);
}

void BlockedMean::load(ArchiveReader& archive) {
  sums_ = archive.get_vector<double>(sums_.size());
  blocks_ = archive.get_vector<double>(blocks_.size());
  weight_ = archive.get<double>();
  block_weights_ = archive.get_vector<double>(block_weights_.size());
}

Json values_of(std::span<const BlockedMean> means) {
  Json list = Json::array();
  for (const BlockedMean& mean : means) list.push_back(mean.value());
  return list;
}

Json blocks_of(std::span<const BlockedMean> means) {
  Json list(count_of_quarters, Json::array());
  for (const BlockedMean& mean : means) {
    const Json quarters = mean.blocks();
    for (std::size_t k = 0; k < count_of_quarters; ++k) list[k].push_back(quarters[k]);
  }
  return list;
}

}  // namespace peclet::engine
