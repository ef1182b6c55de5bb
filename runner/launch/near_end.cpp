#include "runner/launch/near_end.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <thread>

#include "contract/documents.h"
#include "contract/own_folder.h"
#include "runner/campaign/quoting.h"

namespace peclet::runner {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// Length of the greeting that a machine may print before the far end speaks [bytes].
constexpr std::size_t longest_greeting = std::size_t{64} << 10;
// Result, checkpoint, growing file, state of a failure, and the files beside the result.
constexpr std::size_t most_files = 4 + most_left_files;
constexpr milliseconds longest_turn{500};
constexpr seconds until_next_try{1}, carrying_interval{1};
// Time for the last files after the owner has gone, and for the launcher to leave.
constexpr seconds parting{60}, leaving{5};

// Returns the variables that concern the engine.
Json own_variables() {
  Json variables = Json::array();
  for (char** variable = environ; *variable != nullptr; ++variable) {
    if (std::string_view(*variable).starts_with("PECLET_")) variables.push_back(*variable);
  }
  return variables;
}

std::int64_t job_number(const Json& frame) {
  if (!frame.contains("job") || !frame.at("job").is_number_integer())
    throw FrameError("a message about a job lacks its number");
  return frame.at("job").get<std::int64_t>();
}

[[noreturn]] void die_of(int signal) {
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);  // the core, if any, is the engine's
  std::signal(signal, SIG_DFL);
  sigset_t one;
  sigemptyset(&one);
  sigaddset(&one, signal);
  sigprocmask(SIG_UNBLOCK, &one, nullptr);
  ::raise(signal);
  ::_exit(1);
}

}  // namespace

NearEnd::NearEnd(const WorkerOptions& options)
    : options_(options),
      owner_(duplicate(STDIN_FILENO), duplicate(STDIN_FILENO), largest_frame),
      launcher_(
          start_piped({"/bin/sh", "-c",
                       options.through + " " + shell_word((own_folder() / "peclet").string()) + " worker"})),
      far_(std::move(launcher_.output), std::move(launcher_.input), largest_answer, longest_greeting) {
  ::close(STDIN_FILENO);
  // The owner hears these signals, and says what is to be done.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_IGN);
  far_.send({{"type", "begin"},
             {"engine", options_.engine},
             {"folder", fs::current_path().string()},
             {"environment", own_variables()},
             {"silence_seconds", options_.silence_seconds}});
}

int NearEnd::run() {
  try {
    while (true) take_turn();
  } catch (const FrameError& error) {
    lose(error.what(), true);
  }
}

void NearEnd::take_turn() {
  outbox_.fill(far_);
  if (left_ && outbox_.is_empty()) far_.finish();
  const std::array links{&owner_, &far_};
  FrameLink::exchange(links, -1, longest_turn);
  hear_owner();
  hear_far_end();
  if (far_.has_ended() && !waiting_) leave();
  if (left_ && Clock::now() - *left_ > parting) lose("the far end did not leave");
  keep_in_touch();
}

void NearEnd::hear_owner() {
  while (std::optional<Json> frame = owner_.next()) {
    if (frame->at("type") == "job") {
      take_job(*frame);
    } else {
      outbox_.add(std::move(*frame));
    }
  }
  if (owner_.has_ended() && !left_) left_ = Clock::now();
}

void NearEnd::take_job(const Json& frame) {
  const std::int64_t job = job_number(frame);
  const CarriedJob& carried =
      jobs_.insert_or_assign(job, NearJob{CarriedJob::of_frame(frame)}).first->second.paths;
  outbox_.add_checkpoint(job, carried.checkpoint);
  outbox_.add(frame);
}

void NearEnd::hear_far_end() {
  if (waiting_) {
    if (Clock::now() - retried_ < until_next_try) return;
    if (!take(*waiting_)) return;
    waiting_.reset();
    far_.hold(false);
  }
  while (std::optional<Json> frame = far_.next()) {
    if (take(*frame)) continue;
    waiting_ = std::move(frame);
    far_.hold(true);
    return;
  }
}

// Takes a frame of the far end. Returns false if it is to be given again later, because the disk is full.
bool NearEnd::take(Json given) {
  const Json frame = checked_relay_frame(std::move(given));
  const auto type = frame.at("type").get<std::string>();
  if (!is_ready_ && type != "ready") throw FrameError("the far end began with a message of type " + type);
  if (type == "ready") {
    is_ready_ = true;
  } else if (type == "piece") {
    return take_piece(frame);
  } else if (type == "ended") {
    ended_ = ExitStatus{
        frame.at("status").is_null() ? std::nullopt : std::optional(frame.at("status").get<int>()),
        frame.at("signal").is_null() ? std::nullopt : std::optional(frame.at("signal").get<int>())};
  } else if (type == "result") {
    Json result = frame;
    result["spool"] = job_of(frame).paths.spool.string();
    owner_.send(result);
    jobs_.erase(job_number(frame));
  } else if (type == "carrying") {
    throw FrameError("only the near end knows what is carried");
  } else if (type != "alive") {
    owner_.send(frame);
    if (type == "failed" || type == "drained") jobs_.erase(job_number(frame));
  }
  return true;
}

bool NearEnd::take_piece(const Json& piece) {
  NearJob& job = job_of(piece);
  const fs::path path = job.paths.path(piece);
  // While the job runs its progress renews its lease, and checkpoints replace one another.
  const bool is_of_end = piece.at("role") != role::checkpoint && piece.at("role") != role::growing;
  bool& has_come = job.files[path];
  if (job.files.size() > most_files)
    throw FrameError(fmt::format("sends more than {} files of a job", most_files));
  if (has_come && is_of_end) throw FrameError("sends a file of a job twice");
  try {
    has_come = inbox_.take(piece, path);
    if (is_of_end && Clock::now() - said_carrying_ > carrying_interval) {
      said_carrying_ = Clock::now();
      owner_.send({{"type", "carrying"}, {"job", piece.at("job")}});
    }
    return true;
  } catch (const NoRoomError& error) {
    retried_ = Clock::now();
    owner_.send(
        {{"type", "no-room"}, {"job", piece.at("job")}, {"path", path.string()}, {"bytes", error.bytes()}});
    return false;
  }
}

NearEnd::NearJob& NearEnd::job_of(const Json& frame) {
  const auto found = jobs_.find(job_number(frame));
  if (found == jobs_.end())
    throw FrameError(fmt::format("spoke of job {}, which it does not have", job_number(frame)));
  return found->second;
}

void NearEnd::keep_in_touch() {
  const std::chrono::duration<double> silence(options_.silence_seconds);
  far_.keep_alive(silence);
  // Launchers may wait for a place before they start the far end; the owner judges that.
  if (is_ready_ && !waiting_ && far_.is_silent(silence))
    lose(fmt::format("nothing was heard of the far end for {:g} s", options_.silence_seconds));
}

void NearEnd::tell_owner() {
  while (owner_.unsent() > 0 && !owner_.has_ended()) {
    const std::array links{&owner_};
    FrameLink::exchange(links, -1, longest_turn);
  }
}

void NearEnd::leave() {
  tell_owner();
  int status = 0;
  pid_t gone = 0;
  for (const Clock::time_point until = Clock::now() + leaving; Clock::now() < until;) {
    gone = waitpid(launcher_.process, &status, WNOHANG);
    if (gone != 0) break;
    std::this_thread::sleep_for(milliseconds(2));
  }
  if (gone == 0) ::kill(-launcher_.process, SIGKILL);
  if (!ended_)
    lose(gone > 0 ? "the launcher ended: " + to_string(exit_status(status)) : "the far end is gone");
  if (ended_->signal) die_of(*ended_->signal);
  ::_exit(ended_->status.value_or(1));
}

void NearEnd::lose(const std::string& why, bool is_nonsense) {
  say_as_worker(why);
  inbox_.discard();
  ::kill(-launcher_.process, SIGKILL);
  owner_.send({{"type", "lost"}, {"message", why}, {"cause", is_nonsense ? "nonsense" : "link"}});
  tell_owner();
  die_of(SIGKILL);
}

}  // namespace peclet::runner
