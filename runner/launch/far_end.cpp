#include "runner/launch/far_end.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <system_error>
#include <thread>
#include <utility>

#include "contract/documents.h"
#include "contract/provenance.h"
#include "contract/sha256.h"
#include "runner/campaign/quoting.h"
#include "runner/store/campaign_directory.h"
#include "runner/store/result_files.h"

namespace peclet::runner {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::string_view folder_prefix = "peclet-worker-";
// A folder that is not locked belongs to a killed process, unless it is as young as this.
constexpr std::chrono::minutes young{1};
constexpr milliseconds turn{500};
constexpr seconds checkpoint_interval{1};
// Time that an engine has to write its checkpoints, and then the link to take them.
constexpr seconds to_write{30}, to_send{20};

// Removes the folders of processes of this user that were killed.
void remove_forgotten(const fs::path& base) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(base, error)) {
    if (!entry.path().filename().string().starts_with(folder_prefix)) continue;
    struct stat about {};
    const Descriptor folder = open_file(entry.path(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW);
    if (folder.number() < 0 || fstat(folder.number(), &about) != 0 || about.st_uid != ::geteuid()) continue;
    const auto age =
        std::chrono::system_clock::now() - std::chrono::system_clock::from_time_t(about.st_mtime);
    if (age > young && ::flock(folder.number(), LOCK_EX | LOCK_NB) == 0) fs::remove_all(entry.path(), error);
  }
}

Descriptor taken(int descriptor, int in_its_place) {
  Descriptor own = duplicate(descriptor);
  if (::dup2(in_its_place, descriptor) < 0) throw std::system_error(errno, std::generic_category(), "dup");
  return own;
}

// Takes standard input, which becomes empty.
Descriptor taken_input() {
  const Descriptor nothing = open_file("/dev/null", O_RDONLY);
  if (nothing.number() < 0) fail_to("cannot open", "/dev/null");
  return taken(STDIN_FILENO, nothing.number());
}

}  // namespace

FarFolder::FarFolder() {
  const char* const chosen = std::getenv("TMPDIR");
  const fs::path base = chosen != nullptr && *chosen != '\0' ? chosen : "/tmp";
  remove_forgotten(base);
  std::string name = (base / folder_prefix).string() + "XXXXXX";
  if (::mkdtemp(name.data()) == nullptr) fail_to("cannot make a folder in", base);
  path_ = name;
  Descriptor folder = open_file(path_, O_RDONLY | O_DIRECTORY);
  if (folder.number() < 0 || ::flock(folder.number(), LOCK_EX | LOCK_NB) != 0) fail_to("cannot lock", path_);
  lock_ = folder.take();
}

FarFolder::~FarFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  ::close(lock_);
}

FarEnd::FarEnd() : near_(taken_input(), taken(STDOUT_FILENO, STDERR_FILENO), largest_frame) {
  near_.send({{"type", "ready"}, {"protocol", 1}, {"version", version()}});
}

int FarEnd::run() {
  while (true) {
    listen();
    hear_near_end();
    if (engine_) {
      hear_engine();
      send_checkpoints();
    }
    if (hung_up_ && !engine_) return conclude({{}, stopped_by_.value_or(SIGKILL)});
    if (frames_ && frames_->has_ended()) hang_up();
    if (!hung_up_) continue;
    if (Clock::now() - *hung_up_ > to_write) engine_->kill();
    if (const std::optional<ExitStatus> ending = engine_->reap()) {
      engine_.reset();
      return conclude(stopped_by_ ? ExitStatus{{}, stopped_by_} : *ending);
    }
  }
}

void FarEnd::listen() {
  outbox_.fill(near_);
  std::vector<FrameLink*> links{&near_};
  if (frames_) links.push_back(&*frames_);
  FrameLink::exchange(links, signals_.descriptor(), hung_up_ ? milliseconds(2) : turn);
  if (signals_.take() && !stopped_by_) {
    stopped_by_ = SIGTERM;
    hang_up();
  }
  near_.keep_alive(silence_);
  if (near_.is_silent(silence_) && !hung_up_) {
    say_as_worker(fmt::format("nothing was heard of the owner for {:g} s", silence_.count()));
    hang_up();
  }
}

void FarEnd::hear_near_end() {
  while (std::optional<Json> given = near_.next()) {
    Json frame = checked_relay_frame(std::move(*given));
    const auto type = frame.at("type").get<std::string>();
    if (type == "begin") {
      begin(frame);
    } else if (type == "piece") {
      inbox_.take(frame, here(frame.at("job")).path(frame));
    } else if (type == "job") {
      take_job(std::move(frame));
    } else if (type != "alive" && frames_) {
      frames_->send(std::move(frame));
    }
  }
  if (near_.has_ended()) hang_up();
}

void FarEnd::begin(const Json& frame) {
  if (engine_) throw FrameError("the near end began twice");
  std::vector<std::string> words = frame.at("engine");
  if (words.empty()) throw FrameError("the near end named no engine");
  EngineCommand command;
  command.program = words.front();
  command.arguments = {words.begin() + 1, words.end()};
  const fs::path folder = frame.at("folder").get<std::string>();
  std::error_code absent;
  command.folder = fs::is_directory(folder, absent) ? folder : folder_.path();
  command.environment = frame.at("environment");
  command.blocked_signals = {SIGINT, SIGTERM, SIGHUP};  // this process gets them, too
  silence_ = std::chrono::duration<double>(frame.at("silence_seconds").get<double>());
  engine_.emplace(command, duplicate(STDERR_FILENO));
  frames_.emplace(duplicate(engine_->descriptor()), duplicate(engine_->descriptor()), largest_answer);
}

CarriedJob FarEnd::here(std::int64_t number) {
  const auto [known, is_new] = places_.try_emplace(number);
  fs::path& place = known->second;
  if (is_new && !free_places_.empty()) {
    place = free_places_.back();
    free_places_.pop_back();
  } else if (is_new) {
    place = folder_.path() / std::to_string(number);
    for (const char* const folder : {"failures", "files"}) fs::create_directories(place / folder);
  }
  return {place / "result.json", place / "checkpoint", place / "failures", (place / "files" / "").string()};
}

void FarEnd::take_job(Json frame) {
  if (!frames_) throw FrameError("a job came before the engine was named");
  const std::int64_t number = frame.at("job");
  const CarriedJob paths = here(number);
  FarJob job{CarriedJob::of_frame(frame)};
  std::error_code absent;
  job.checkpoint_time = fs::last_write_time(paths.checkpoint, absent);
  const std::uintmax_t growing = fs::file_size(growing_beside(paths.checkpoint), absent);
  job.growing_sent = absent ? 0 : growing;
  jobs_.insert_or_assign(number, std::move(job));
  frame["spool"] = paths.spool.string();
  frame["checkpoint"] = paths.checkpoint.string();
  frame["failures"] = paths.failures.string();
  frame["files"] = paths.files;
  frames_->send(std::move(frame));
}

void FarEnd::hear_engine() {
  try {
    while (frames_) {
      std::optional<Json> frame = frames_->next();
      if (!frame) return;
      pass_on(std::move(*frame));
    }
  } catch (const FrameError& error) {
    outbox_.add({{"type", "lost"}, {"message", error.what()}, {"cause", "nonsense"}});
    engine_->kill();
    hang_up();
  }
}

void FarEnd::pass_on(Json frame) {
  const auto type = frame.at("type").get<std::string>();
  const auto found = frame.contains("job") && frame.at("job").is_number_integer()
                         ? jobs_.find(frame.at("job").get<std::int64_t>())
                         : jobs_.end();
  if (found == jobs_.end()) return outbox_.add(std::move(frame));
  const std::int64_t number = found->first;
  if (type == "progress") {
    // It need not wait for a checkpoint, and is left out behind the end of another job.
    if (!outbox_.has_frames()) near_.send(frame);
  } else if (type == "no-room") {
    const std::string why =
        fmt::format("no room on the other machine: {} bytes for {}", frame.value("bytes", Json(0)).dump(),
                    frame.value("path", Json("")).dump());
    outbox_.add({{"type", "lost"}, {"message", why}, {"cause", "no-room"}});
    stopped_by_ = SIGKILL;
    engine_->kill();
    hang_up();
  } else if (type == "result") {
    send_result(frame);
    end_job(number);
  } else {
    if (type == "drained") send_checkpoint(number, found->second);
    outbox_.add(std::move(frame));
    if (type == "drained" || type == "failed") end_job(number);
  }
}

void FarEnd::send_files(std::int64_t number) {
  const CarriedJob paths = here(number);
  for (const auto& [role, folder] :
       {std::pair(role::beside, fs::path(paths.files)), std::pair(role::failure, paths.failures)}) {
    std::error_code absent;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, absent)) {
      const std::string name = entry.path().filename().string();
      if (is_plain_file_name(name)) outbox_.add(number, role, name, entry.path());
    }
  }
}

void FarEnd::send_result(const Json& given) {
  Json frame = checked_frame(given);
  const std::int64_t number = frame.at("job");
  const CarriedJob paths = here(number);
  send_files(number);
  if (is_there(paths.spool) && !fs::is_empty(paths.failures)) name_state_at_home(number, frame);
  outbox_.add(number, role::result, "", paths.spool);
  outbox_.add(std::move(frame));
}

// The state of a failure is in the owner's folder when the owner reads the result.
void FarEnd::name_state_at_home(std::int64_t number, Json& frame) {
  const CarriedJob paths = here(number);
  const std::string far = paths.failures.string() + "/", near = jobs_.at(number).near.failures.string() + "/";
  std::string text = read_file(paths.spool);
  const std::size_t place = text.find(far);
  if (place == std::string::npos || frame.at("sha256") != sha256(text)) return;
  text.replace(place, far.size(), near);
  write_durably(paths.spool, text);
  frame["sha256"] = sha256(text);
}

void FarEnd::send_checkpoint(std::int64_t number, FarJob& job) {
  const CarriedJob paths = here(number);
  std::error_code absent;
  const fs::file_time_type time = fs::last_write_time(paths.checkpoint, absent);
  if (absent || time == job.checkpoint_time) return;
  job.checkpoint_time = time;
  job.growing_sent = outbox_.add_checkpoint(number, paths.checkpoint, job.growing_sent);
}

// A new checkpoint waits until earlier files have been sent, so that a slow link is not filled with them.
void FarEnd::send_checkpoints() {
  if (!outbox_.is_empty() || Clock::now() - checkpoints_seen_ < checkpoint_interval) return;
  checkpoints_seen_ = Clock::now();
  for (auto& [number, job] : jobs_) send_checkpoint(number, job);
}

void FarEnd::end_job(std::int64_t number) {
  jobs_.erase(number);
  fs::path place = std::move(places_.extract(number).mapped());
  for (const fs::path& folder : {place / "failures", place / "files", place}) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      if (folder != place || !entry.is_directory()) fs::remove_all(entry.path());
    }
  }
  free_places_.push_back(std::move(place));
}

void FarEnd::hang_up() {
  if (hung_up_) return;
  hung_up_ = Clock::now();
  frames_.reset();
  if (engine_) engine_->hang_up();
}

int FarEnd::conclude(const ExitStatus& ending) {
  for (auto& [number, job] : jobs_) {
    send_files(number);
    outbox_.add(number, role::result, "", here(number).spool);  // the engine could not announce it
    send_checkpoint(number, job);
  }
  const auto or_null = [](const std::optional<int>& value) { return value ? Json(*value) : Json(); };
  outbox_.add({{"type", "ended"}, {"status", or_null(ending.status)}, {"signal", or_null(ending.signal)}});
  const Clock::time_point until = Clock::now() + to_send;
  while ((!outbox_.is_empty() || near_.unsent() > 0) && Clock::now() < until) {
    outbox_.fill(near_);
    const std::array links{&near_};
    FrameLink::exchange(links, -1, turn);
  }
  return 0;
}

}  // namespace peclet::runner
