// The files of a job, carried between two machines in pieces of frames.
#pragma once

#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "contract/durable_file.h"
#include "contract/frames.h"
#include "contract/sha256.h"
#include "runner/campaign/paths.h"
#include "runner/launch/frame_link.h"

namespace peclet::runner {

// Returns a frame that only the two ends of a launched worker exchange, with its defaults; other frames as
// they are. Throws FrameError if it does not match its keys.
Json checked_relay_frame(Json message);

// Prints a line of a worker, which comes into the owner's log of it.
void say_as_worker(const std::string& text);

// The roles of files for their job: the result, the checkpoint, the growing file of the checkpoint, a file
// beside the result, the last state of a realisation that broke off. The last two have names.
namespace role {
constexpr const char *result = "result", *checkpoint = "checkpoint", *growing = "growing", *beside = "beside",
                     *failure = "failure";
}

// The paths of a job's files on this machine.
struct CarriedJob {
  fs::path spool, checkpoint, failures;
  std::string files;  // prefix of files beside the result

  // Reads the paths of a job frame.
  static CarriedJob of_frame(const Json& frame);
  // Returns the path of the file of a piece. Throws FrameError for a name that is not plain.
  fs::path path(const Json& piece) const;
};

// Frames and files to be sent in order. A file is read while it is sent, as it was when it was added.
class Outbox {
 public:
  void add(Json frame) {
    things_.emplace_back(std::move(frame));
    ++frames_;
  }
  // Adds a file, unless it is not there. Throws std::system_error.
  void add(std::int64_t job, const char* role, const std::string& name, const fs::path& path);
  // Adds a checkpoint, unless it is not there; before it what its growing file has beside the first `sent`
  // bytes, or all if it has fewer. Returns the size of the growing file [bytes].
  std::uint64_t add_checkpoint(std::int64_t job, const fs::path& path, std::uint64_t sent = 0);
  bool is_empty() const { return things_.empty(); }
  bool has_frames() const { return frames_ > 0; }
  // Gives the link as much as it should have before it has sent it.
  void fill(FrameLink& link);

 private:
  struct File {
    Json head;  // of each of its pieces
    fs::path path;
    Descriptor descriptor;
    std::uint64_t place, end;
    Sha256 hash{};
  };
  static std::optional<File> open(std::int64_t job, const char* role, const std::string& name,
                                  const fs::path& path);
  // Returns the next piece of a file, and whether it is the last.
  static std::pair<Json, bool> next_piece(File& file);

  std::deque<std::variant<Json, File>> things_;
  std::size_t frames_ = 0;
};

// The file that comes in pieces. It is written beside its place and renamed when it is whole; a growing file
// that is continued is written in place.
class Inbox {
 public:
  // Takes the next piece, of the file at `path`. Returns true if the file is whole and on disk. Throws
  // FrameError if the piece does not continue the file or its hash is wrong, NoRoomError if the same piece
  // shall be given again later, std::system_error.
  bool take(const Json& piece, const fs::path& path);
  // Removes what has come of an unfinished file.
  void discard();
  ~Inbox() { discard(); }
  Inbox() = default;
  Inbox& operator=(Inbox&&) = delete;

 private:
  void begin(const Json& piece, const fs::path& path);
  void add(const Json& piece, std::string_view bytes);

  struct File {
    fs::path path, written;  // the place, and where it is written
    Descriptor descriptor;
    std::uint64_t place, end;  // end of what was added to the hash, and largest size
    Sha256 hash{};
    bool is_whole = false;  // it has its hash, and may not be on disk yet
  };
  std::optional<File> file_;
};

}  // namespace peclet::runner
