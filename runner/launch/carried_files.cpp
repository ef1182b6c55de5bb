#include "runner/launch/carried_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

#include "contract/documents.h"
#include "contract/errors.h"
#include "contract/guarded_file.h"
#include "contract/key_table.h"
#include "runner/campaign/quoting.h"
#include "runner/store/campaign_directory.h"
#include "runner/store/realisation_result.h"
#include "runner/store/result_files.h"

namespace peclet::runner {
namespace {

// Bytes in the link beyond which nothing is added to it.
constexpr std::size_t enough = 2 * largest_piece;

constexpr const char* relay_rows = R"(
-- ready | Far end: the first frame.
/protocol | integer = 1
/version | string | Version of peclet.

-- begin | Near end: start the engine.
/engine | array | The program and its arguments.
/engine/* | string
/folder | string | Folder in which the engine runs if it is there.
/environment | array | Variables as NAME=value.
/environment/* | string
/silence_seconds | number > 0 | Time without a frame after which the other end counts as lost.

-- piece | Both ends: bytes of a file. The pieces of a file follow one another, and the last one has the hash.
/job | count
/role | one of result, checkpoint, growing, beside, failure
/name | string; default "" | Name of the file, if it is beside the result or the state of a failure.
/offset | count | Place of the bytes in the file.
/bytes | count | Their number; they follow the frame, and a line break follows them.
/data | string | They themselves, in memory only.
/sha256? | hash | Hash of all bytes that were sent of the file.

-- alive | Both ends: nothing else was sent for a while.

-- ended | Far end: the engine has ended, and all of its files have been sent.
/status, /signal | integer >= 0 and <= 255 or null
)";

const KindTables& relay_keys() {
  static const KindTables tables("Frames between the two ends of a launched worker", "type", relay_rows,
                                 Unknown::ignored);
  return tables;
}

std::string text(const Json& object, const char* key) { return object.at(key).get<std::string>(); }

std::uint64_t largest_of(const std::string& role) {
  return role == role::result ? largest_result : largest_left_file;
}

[[noreturn]] void refuse(const Json& piece, const std::string& why) {
  throw FrameError(fmt::format("piece of the {} of job {}: {}", text(piece, "role"),
                               piece.at("job").get<std::int64_t>(), why));
}

}  // namespace

Json checked_relay_frame(Json message) {
  const std::string type = text(message, "type");
  if (type != "ready" && type != "begin" && type != "piece" && type != "alive" && type != "ended")
    return message;
  try {
    return relay_keys().validate(std::move(message), "");
  } catch (const InputError& error) {
    throw FrameError(fmt::format("wrong message: {}", error.what()));
  }
}

void say_as_worker(const std::string& text) {
  std::fputs(fmt::format("peclet worker: {}\n", plain(text)).c_str(), stderr);
  std::fflush(stderr);
}

CarriedJob CarriedJob::of_frame(const Json& frame) {
  return {text(frame, "spool"), text(frame, "checkpoint"), text(frame, "failures"), text(frame, "files")};
}

fs::path CarriedJob::path(const Json& piece) const {
  const std::string role = text(piece, "role"), name = text(piece, "name");
  if (role == role::result) return spool;
  if (role == role::checkpoint) return checkpoint;
  if (role == role::growing) return growing_beside(checkpoint);
  if (!is_plain_file_name(name)) throw FrameError("a file has a name that is not plain: " + plain(name));
  return role == role::beside ? fs::path(files + name) : failures / name;
}

std::optional<Outbox::File> Outbox::open(std::int64_t job, const char* role, const std::string& name,
                                         const fs::path& path) {
  Descriptor descriptor = open_file(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK);
  if (descriptor.number() < 0 && errno == ENOENT) return std::nullopt;
  if (descriptor.number() < 0) fail_to("cannot open", path);
  struct stat about {};
  if (fstat(descriptor.number(), &about) != 0) fail_to("cannot examine", path);
  if (!S_ISREG(about.st_mode)) return std::nullopt;
  const auto size = static_cast<std::uint64_t>(about.st_size);
  Json head = {{"type", "piece"}, {"job", job}, {"role", role}, {"name", name}};
  return File{std::move(head), path, std::move(descriptor), 0, size};
}

void Outbox::add(std::int64_t job, const char* role, const std::string& name, const fs::path& path) {
  if (std::optional<File> file = open(job, role, name, path)) things_.emplace_back(std::move(*file));
}

std::uint64_t Outbox::add_checkpoint(std::int64_t job, const fs::path& path, std::uint64_t sent) {
  std::optional<File> checkpoint = open(job, role::checkpoint, "", path);
  if (!checkpoint) return 0;
  // Opened after the checkpoint, so that it has all that the checkpoint refers to.
  std::optional<File> growing = open(job, role::growing, "", growing_beside(path));
  const std::uint64_t size = growing ? growing->end : 0;
  if (growing) growing->place = sent <= size ? sent : 0;
  if (growing && (growing->place < size || size == 0)) things_.emplace_back(std::move(*growing));
  things_.emplace_back(std::move(*checkpoint));
  return size;
}

std::pair<Json, bool> Outbox::next_piece(File& file) {
  std::string bytes(std::min<std::uint64_t>(largest_piece, file.end - file.place), '\0');
  const std::size_t count =
      read_at(file.descriptor.number(), file.place, std::as_writable_bytes(std::span(bytes)), file.path);
  if (count < bytes.size()) {  // it was cut meanwhile: the receiver will find fault with it
    bytes.resize(count);
    file.end = file.place + count;
  }
  file.hash.add(bytes);
  Json piece = file.head;
  piece["offset"] = file.place;
  piece["data"] = std::move(bytes);
  file.place += count;
  const bool is_last = file.place == file.end;
  if (is_last) piece["sha256"] = file.hash.hash();
  return {std::move(piece), is_last};
}

void Outbox::fill(FrameLink& link) {
  while (!things_.empty() && link.unsent() < enough) {
    if (auto* const file = std::get_if<File>(&things_.front())) {
      auto [piece, is_last] = next_piece(*file);
      link.send(std::move(piece));
      if (!is_last) continue;
    } else {
      link.send(std::move(std::get<Json>(things_.front())));
      --frames_;
    }
    things_.pop_front();
  }
}

void Inbox::discard() {
  std::error_code ignored;
  if (file_ && file_->written != file_->path) fs::remove(file_->written, ignored);
  file_.reset();
}

void Inbox::begin(const Json& piece, const fs::path& path) {
  static int count = 0;
  const std::string role = text(piece, "role");
  const auto offset = piece.at("offset").get<std::uint64_t>();
  const bool continues = offset > 0;
  if (continues && role != role::growing) refuse(piece, "does not begin at byte 0");
  const fs::path written =
      continues ? path : fs::path(fmt::format("{}.{}.{}.tmp", path.string(), getpid(), ++count));
  const int flags = O_WRONLY | O_NOFOLLOW | (continues ? 0 : O_CREAT | O_EXCL);
  Descriptor descriptor = open_file(written, flags);
  if (descriptor.number() < 0 && peclet::means_no_room(errno))
    throw NoRoomError(errno, "cannot create " + written.string(), written, 0);
  if (descriptor.number() < 0 && continues && errno == ENOENT)
    refuse(piece, "continues a file that is not there");
  if (descriptor.number() < 0) fail_to("cannot create", written);
  struct stat about {};
  if (fstat(descriptor.number(), &about) != 0) fail_to("cannot examine", written);
  if (continues && static_cast<std::uint64_t>(about.st_size) < offset)
    refuse(piece, fmt::format("begins at byte {}, and the file has {}", offset, about.st_size));
  file_.emplace(File{path, written, std::move(descriptor), offset, largest_of(role)});
}

bool Inbox::take(const Json& piece, const fs::path& path) {
  if (!file_) begin(piece, path);
  if (file_->path != path) refuse(piece, "comes before the file before it has ended");
  if (!file_->is_whole) add(piece, piece.at("data").get_ref<const std::string&>());
  if (!file_->is_whole) return false;
  if (file_->written == path) {
    synchronise(file_->descriptor.number(), path);
  } else {
    rename_durably(file_->written, path);
  }
  file_.reset();
  return true;
}

void Inbox::add(const Json& piece, std::string_view bytes) {
  const fs::path& path = file_->path;
  const auto offset = piece.at("offset").get<std::uint64_t>();
  if (offset != file_->place)
    refuse(piece, fmt::format("begins at byte {} instead of {}", offset, file_->place));
  if (bytes.size() > file_->end - std::min(file_->end, file_->place))
    refuse(piece, fmt::format("has more than {} bytes", file_->end));
  const int descriptor = file_->descriptor.number();
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count = ::pwrite(descriptor, bytes.data() + done, bytes.size() - done,
                                   static_cast<off_t>(file_->place + done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && peclet::means_no_room(errno))
      throw NoRoomError(errno, "cannot write " + path.string(), path, bytes.size());
    if (count < 0) fail_to("cannot write", path);
    done += static_cast<std::size_t>(count);
  }
  file_->hash.add(bytes);
  file_->place += bytes.size();
  if (!piece.contains("sha256")) return;
  if (file_->hash.hash() != text(piece, "sha256")) refuse(piece, "the file does not have its hash");
  if (::ftruncate(descriptor, static_cast<off_t>(file_->place)) != 0) fail_to("cannot cut", path);
  file_->is_whole = true;
}

}  // namespace peclet::runner
