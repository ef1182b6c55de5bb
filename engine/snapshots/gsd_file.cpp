#include "engine/snapshots/gsd_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "contract/sha256.h"

namespace peclet::engine::gsd {
namespace {

constexpr char application[] = "peclet-engine", schema[] = "hoomd";
constexpr std::uint32_t file_version = version(2, 0), schema_version = version(1, 4);

// Returns the list of names. Names end with a zero, and the list with at least one more.
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

// Limits of the index (128 MiB in memory) and of the names. Trajectories of this program need less than half.
constexpr std::uint64_t most_entries = std::uint64_t{4} << 20, most_segments = std::uint64_t{1} << 16;
// The limit by the 16 bits of a name in the index.
constexpr std::size_t most_names = 65536;

// Opens a file whose chunks are read in place, as it need not fit into memory. Does not wait for a FIFO.
Descriptor opened(const std::filesystem::path& path) {
  Descriptor file = open_file(path, O_RDONLY | O_NONBLOCK | O_NOCTTY);
  if (file.number() < 0) {
    throw InputError(path.string(), "", "",
                     "cannot be read: " + std::generic_category().message(std::exchange(errno, 0)));
  }
  struct stat about {};
  if (fstat(file.number(), &about) != 0) fail_to("cannot examine", path);
  if (!S_ISREG(about.st_mode)) throw InputError(path.string(), "", "", "must be a regular file");
  return file;
}

std::uint64_t size_of_value(std::uint8_t type) {
  constexpr std::array<std::uint8_t, 11> sizes = {0, 1, 2, 4, 8, 1, 2, 4, 8, 4, 8};
  return type < sizes.size() ? sizes[type] : 0;
}

std::string text_in(const char (&field)[64]) { return {field, strnlen(field, sizeof field)}; }

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

Reader::Reader(const std::filesystem::path& path) : path_(path), file_(opened(path)) {
  struct stat about {};
  if (fstat(file_.number(), &about) != 0) fail_to("cannot examine", path_);
  length_ = static_cast<std::uint64_t>(about.st_size);
  const Header header = checked_header();
  read_names(header);
  read_index(header);
}

void Reader::read(std::uint64_t place, std::span<std::byte> bytes) const {
  const std::size_t count = read_at(file_.number(), place, bytes, path_);
  if (count < bytes.size())
    refuse(fmt::format("byte {}", place + count), "is missing: the file has been cut");
}

std::string Reader::read_text(std::uint64_t place, std::uint64_t length) const {
  std::string text(length, '\0');
  read(place, std::as_writable_bytes(std::span(text)));
  return text;
}

Header Reader::checked_header() const {
  Header header{};
  if (!holds(0, sizeof header))
    refuse(fmt::format("{} bytes", length_), "must be a GSD file: 256 bytes or more");
  read(0, std::as_writable_bytes(std::span(&header, 1)));
  if (header.magic != magic) {
    refuse(fmt::format("begins with {:#018x}", header.magic), "must be a GSD file, {:#018x}", magic);
  }
  if (header.file_version >> 16 != 2) {
    refuse(fmt::format("layout {}.{}", header.file_version >> 16, header.file_version & 0xffff),
           "must be layout 2 of GSD");
  }
  if (text_in(header.schema) != "hoomd" || header.schema_version >> 16 != 1) {
    refuse(fmt::format("schema {} {}", text_in(header.schema), header.schema_version >> 16),
           "must be the schema hoomd 1");
  }
  return header;
}

void Reader::read_names(const Header& header) {
  if (header.names_segments > most_segments ||
      !holds(header.names_location, header.names_segments * segment)) {
    refuse(fmt::format("{} segments of names at byte {}", header.names_segments, header.names_location),
           "must lie within the {} bytes of the file", length_);
  }
  const std::string list = read_text(header.names_location, header.names_segments * segment);
  for (std::size_t at = 0; at < list.size() && list[at] != '\0';) {
    const std::size_t end = list.find('\0', at);
    if (end == std::string::npos) refuse("the list of names", "must end with a zero");
    std::string name = list.substr(at, end - at);
    if (names_.size() == most_names) refuse("the list of names", "must have at most {}", most_names);
    const bool is_new = number_of_name_.emplace(name, static_cast<std::uint16_t>(names_.size())).second;
    if (!is_new) refuse(name, "must be in the list of names once");
    names_.push_back(std::move(name));
    at = end + 1;
  }
}

void Reader::read_index(const Header& header) {
  if (header.index_entries > most_entries ||
      !holds(header.index_location, header.index_entries * sizeof(IndexEntry))) {
    refuse(fmt::format("{} entries of the index at byte {}", header.index_entries, header.index_location),
           "must be at most {} entries within the {} bytes of the file", most_entries, length_);
  }
  index_.resize(header.index_entries);
  read(header.index_location, std::as_writable_bytes(std::span(index_)));
  index_.erase(std::ranges::find(index_, 0, &IndexEntry::location), index_.end());
  for (std::size_t k = 0; k < index_.size(); ++k) {
    const IndexEntry& entry = index_[k];
    const auto refuse_entry = [&](const std::string& why) {
      refuse(fmt::format("entry {} of the index", k), "{}", why);
    };
    if (entry.name >= names_.size())
      refuse_entry(fmt::format("has name {} of {}", entry.name, names_.size()));
    // The last entry gives the number of frames, so no number may be left out.
    const std::uint64_t before = k == 0 ? 0 : index_[k - 1].frame;
    const bool is_in_order =
        k == 0 || std::pair(before, index_[k - 1].name) < std::pair(entry.frame, entry.name);
    if (!is_in_order || entry.frame > before + 1) refuse_entry("is out of order");
    const std::uint64_t size = size_of_value(entry.type);
    if (size == 0) refuse_entry(fmt::format("has type {}: must be 1 to 10", entry.type));
    const std::uint64_t width = size * entry.columns;  // below 2^36
    const bool has_place = entry.location > 0 && entry.columns > 0 && entry.rows <= length_ / width &&
                           holds(static_cast<std::uint64_t>(entry.location), entry.rows * width);
    if (!has_place) {
      refuse(fmt::format("{} of frame {}: {} rows of {} bytes at byte {}", names_[entry.name], entry.frame,
                         entry.rows, width, entry.location),
             "must lie within the {} bytes of the file", length_);
    }
  }
}

const IndexEntry* Reader::find(std::uint64_t frame, std::string_view name) const {
  const auto known = number_of_name_.find(name);
  if (known == number_of_name_.end()) return nullptr;
  const std::pair wanted(frame, known->second);
  const auto key = [](const IndexEntry& entry) { return std::pair(entry.frame, entry.name); };
  const auto found = std::ranges::lower_bound(index_, wanted, {}, key);
  return found != index_.end() && key(*found) == wanted ? &*found : nullptr;
}

std::span<const IndexEntry> Reader::chunks(std::uint64_t frame) const {
  const auto begin = std::ranges::lower_bound(index_, frame, {}, &IndexEntry::frame);
  return {begin, std::ranges::upper_bound(begin, index_.end(), frame, {}, &IndexEntry::frame)};
}

void Reader::check(const IndexEntry& chunk, std::uint8_t type, std::uint32_t columns) const {
  if (chunk.type == type && chunk.columns == columns) return;
  refuse(fmt::format("{} of frame {}: {} columns of type {}", names_[chunk.name], chunk.frame, chunk.columns,
                     chunk.type),
         "must be {} of type {}", columns, type);
}

bool begins_as_gsd(const std::filesystem::path& path) {
  const Descriptor file = open_file(path, O_RDONLY | O_NONBLOCK | O_NOCTTY);
  std::uint64_t first = 0;
  return file.number() >= 0 && ::pread(file.number(), &first, sizeof first, 0) == sizeof first &&
         first == magic;
}

}  // namespace peclet::engine::gsd
