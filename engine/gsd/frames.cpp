#include "engine/gsd/frames.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "contract/sha256.h"

namespace peclet::engine::gsd {
namespace {

constexpr char application[] = "peclet-engine", schema[] = "hoomd";
constexpr std::uint32_t file_version = version(2, 0), schema_version = version(1, 4);

// Names end with a zero, and the list with at least one more.
std::string name_list(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += name + '\0';
  list.resize((list.size() / segment + 1) * segment, '\0');
  return list;
}

template <class Value>
std::vector<Value> get_counted(ArchiveReader& archive) {
  const auto count = archive.get<std::uint64_t>();
  return archive.get_vector<Value>(count);
}

template <class Value>
void put_counted(ArchiveWriter& archive, const std::vector<Value>& values) {
  archive.put(static_cast<std::uint64_t>(values.size()));
  archive.put(values);
}

}  // namespace

void Frames::add(const std::string& name, std::string_view bytes, std::uint64_t rows, std::uint32_t columns,
                 std::uint8_t type) {
  const auto known = std::find(names_.begin(), names_.end(), name);
  const auto number = static_cast<std::uint16_t>(known - names_.begin());
  if (known == names_.end()) names_.push_back(name);
  if (!index_.empty() && index_.back().frame == count() && index_.back().name >= number) {
    throw std::logic_error("the chunk " + name + " is out of order");
  }
  const auto location = static_cast<std::int64_t>(length() + current_.size());
  index_.push_back({count(), rows, location, columns, number, type, 0});
  current_ += bytes;
}

void Frames::end_frame() {
  const std::string sum = sha256(current_);
  FrameBytes frame{length(), length() + current_.size(), {}};
  std::ranges::copy(sum, frame.sha256.begin());
  frames_.push_back(frame);
  pending_ += current_;
  current_.clear();
}

std::string Frames::head() const {
  Header header{};
  header.magic = magic;
  header.names_location = length();
  header.names_segments = name_list(names_).size() / segment;
  header.index_location = header.names_location + header.names_segments * segment;
  header.index_entries = index_.size() + 1;
  header.schema_version = schema_version;
  header.file_version = file_version;
  std::memcpy(header.application, application, sizeof application);
  std::memcpy(header.schema, schema, sizeof schema);
  return {reinterpret_cast<const char*>(&header), sizeof header};
}

std::string Frames::tail() const {
  std::string tail = name_list(names_);
  tail.append(reinterpret_cast<const char*>(index_.data()), index_.size() * sizeof(IndexEntry));
  tail.append(sizeof(IndexEntry), '\0');
  return tail;
}

void Frames::save(ArchiveWriter& archive) const {
  archive.put(static_cast<std::uint64_t>(names_.size()));
  for (const std::string& name : names_) archive.put(name);
  put_counted(archive, index_);
  put_counted(archive, frames_);
  archive.put(pending_);
}

void Frames::load(ArchiveReader& archive) {
  names_.clear();
  for (auto left = archive.get<std::uint64_t>(); left > 0; --left) names_.push_back(archive.get_string());
  index_ = get_counted<IndexEntry>(archive);
  frames_ = get_counted<FrameBytes>(archive);
  pending_ = archive.get_string();
  current_.clear();
}

}  // namespace peclet::engine::gsd
