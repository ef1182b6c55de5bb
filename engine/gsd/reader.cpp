#include "engine/gsd/reader.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "contract/input_error.h"

namespace peclet::engine::gsd {
namespace {

// Of an index in memory: 128 MB. Trajectories of this program have a tenth of it at most.
constexpr std::uint64_t most_entries = std::uint64_t{4} << 20, most_segments = std::uint64_t{1} << 16;
// An entry of the index has 16 bits for its name.
constexpr std::size_t most_names = 65536;

// Not opened as a person's other input is: chunks are read where they are, and a trajectory need not fit into
// memory. A FIFO would wait for ever.
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

Reader::Reader(const std::filesystem::path& path) : path_(path), file_(opened(path)) {
  struct stat about {};
  if (fstat(file_.number(), &about) != 0) fail_to("cannot examine", path_);
  length_ = static_cast<std::uint64_t>(about.st_size);
  const Header header = checked_header();
  read_names(header);
  read_index(header);
}

void Reader::refuse(const std::string& value, const std::string& allowed) const {
  throw InputError(path_.string(), "", value, allowed);
}

void Reader::read(std::uint64_t place, std::span<std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t more = ::pread(file_.number(), bytes.data(), bytes.size(), static_cast<off_t>(place));
    if (more < 0 && errno == EINTR) continue;
    if (more < 0) fail_to("cannot read", path_);
    if (more == 0) refuse(fmt::format("byte {}", place), "is missing: the file has been cut");
    place += static_cast<std::uint64_t>(more);
    bytes = bytes.subspan(static_cast<std::size_t>(more));
  }
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
    refuse(fmt::format("begins with {:#018x}", header.magic),
           fmt::format("must be a GSD file, {:#018x}", magic));
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
           fmt::format("must lie within the {} bytes of the file", length_));
  }
  const std::string list = read_text(header.names_location, header.names_segments * segment);
  for (std::size_t at = 0; at < list.size() && list[at] != '\0';) {
    const std::size_t end = list.find('\0', at);
    if (end == std::string::npos) refuse("the list of names", "must end with a zero");
    std::string name = list.substr(at, end - at);
    if (names_.size() == most_names)
      refuse("the list of names", fmt::format("must have at most {}", most_names));
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
           fmt::format("must be at most {} within the {} bytes of the file", most_entries, length_));
  }
  index_.resize(header.index_entries);
  read(header.index_location, std::as_writable_bytes(std::span(index_)));
  index_.erase(std::ranges::find(index_, 0, &IndexEntry::location), index_.end());
  for (std::size_t k = 0; k < index_.size(); ++k) {
    const IndexEntry& entry = index_[k];
    const auto refuse_entry = [&](const std::string& why) {
      refuse(fmt::format("entry {} of the index", k), why);
    };
    if (entry.name >= names_.size())
      refuse_entry(fmt::format("has name {} of {}", entry.name, names_.size()));
    // Frames are counted by the last entry: none may be far from the one before it.
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
             fmt::format("must lie within the {} bytes of the file", length_));
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
         fmt::format("must be {} of type {}", columns, type));
}

bool begins_as_gsd(const std::filesystem::path& path) {
  const Descriptor file = open_file(path, O_RDONLY | O_NONBLOCK | O_NOCTTY);
  std::uint64_t first = 0;
  return file.number() >= 0 && ::pread(file.number(), &first, sizeof first, 0) == sizeof first &&
         first == magic;
}

}  // namespace peclet::engine::gsd
