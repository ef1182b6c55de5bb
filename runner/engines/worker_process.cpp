#include "runner/engines/worker_process.h"

#include <fmt/format.h>
#include <poll.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <system_error>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "contract/documents.h"
#include "contract/errors.h"
#include "contract/text.h"
#include "runner/campaign/quoting.h"
#include "runner/store/disk_room.h"
#include "runner/store/result_files.h"

namespace peclet::runner {

namespace {

// Returns the number of cores of the affinity mask. Tries larger and larger sets, because a machine may have
// more cores than a cpu_set_t has bits.
int cores_of_affinity() {
  for (std::size_t count = CPU_SETSIZE; count <= 1 << 16; count *= 2) {
    cpu_set_t* const set = CPU_ALLOC(count);
    if (set == nullptr) break;
    const std::size_t size = CPU_ALLOC_SIZE(count);
    const bool known = sched_getaffinity(0, size, set) == 0;
    const int cores = known ? CPU_COUNT_S(size, set) : 0;
    CPU_FREE(set);
    if (known) return cores;
  }
  return static_cast<int>(std::thread::hardware_concurrency());
}

std::optional<double> number_in(const fs::path& file) {
  double number = 0;
  return std::ifstream(file) >> number ? std::optional(number) : std::nullopt;
}

// Returns the quota of a control group [cores]. Version 2 of control groups has "QUOTA PERIOD" or "max
// PERIOD" [us] in one file. Version 1 has a file for each; a quota below 0 means no limit.
std::optional<double> quota_of(const fs::path& group) {
  std::string quota;
  double period = 0;
  if (std::ifstream(group / "cpu.max") >> quota >> period) {
    return quota == "max" || period <= 0 ? std::nullopt
                                         : std::optional(std::strtod(quota.c_str(), nullptr) / period);
  }
  const std::optional<double> time = number_in(group / "cpu.cfs_quota_us"),
                              of = number_in(group / "cpu.cfs_period_us");
  return time && of && *time > 0 && *of > 0 ? std::optional(*time / *of) : std::nullopt;
}

constexpr Awake longest_turn{1};

using Time = std::chrono::steady_clock;

// Time that an engine has to exit after it has closed its socket; then it is killed.
constexpr std::chrono::seconds leaving_patience{2};
// Interval of the checks whether a process that has closed its socket has ended.
constexpr std::chrono::milliseconds reaping_interval{2};

// Interval at which the output of engines is taken from their pipes. An engine that prints without end waits
// most of the time for its pipe, so that its logs stay small.
constexpr std::chrono::milliseconds log_interval{100};
constexpr std::uint64_t largest_log = 1 << 20;
constexpr int older_logs = 2;

int phase_number(const std::string& name) {
  return static_cast<int>(std::ranges::find(job_phases, name) - job_phases.begin());
}

Json job_frame(const Job& job) {
  return {{"type", "job"},
          {"job", job.attempt},
          {"point", job.point},
          {"seed", job.seed},
          {"scene", job.scene},
          {"threads", job.threads},
          {"checkpoint", job.checkpoint.string()},
          {"checkpoint_seconds", job.checkpoint_seconds},
          {"progress_seconds", job.progress_seconds},
          {"spool", job.spool.string()},
          {"files", left_file(job.spool, "").string()},
          {"failures", job.failures.string()}};
}

// Returns the event of a message. Throws FrameError for a message that workers do not send.
WorkerEvent as_event(int worker, Json given) {
  const Json message = checked_frame(std::move(given));
  const auto text = [&](const char* key) { return message[key].get<std::string>(); };
  const auto count = [&](const char* key) { return message[key].get<std::int64_t>(); };
  const std::string type = text("type");
  if (type == "hello")
    return Hello{worker, message["engine"], message["ahead"], message["capacity"].get<int>()};
  if (type == "progress") {
    return Progressed{worker,        count("job"),   phase_number(text("phase")),
                      count("step"), count("steps"), message["strain"].get<double>()};
  }
  if (type == "result") return ResultSpooled{worker, count("job"), text("spool"), text("sha256")};
  if (type == "failed") return JobFailed{worker, count("job"), plain(text("message"))};
  if (type == "drained") return Drained{worker, count("job"), count("step")};
  if (type == "carrying") return Carrying{worker, count("job")};
  if (type == "lost") return Lost{worker, plain(text("message")), text("cause")};
  if (type == "no-room")
    return ShortOfRoom{worker, count("job"), text("path"), static_cast<std::uint64_t>(count("bytes"))};
  throw FrameError("unexpected message: " + type);
}

}  // namespace

// Lines of `groups` are "0::/system.slice/job.scope" in version 2 and "4:cpu,cpuacct:/slurm/uid_1000/job_7"
// in version 1. Groups above set limits, too. In a container the files of its own group may be at the root.
std::optional<double> core_quota(const fs::path& root, const std::string& groups) {
  std::vector<std::pair<fs::path, fs::path>> places;  // where its kind is mounted, and the group in there
  std::istringstream lines(groups);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const fs::path group = fs::path(line.substr(second + 1)).relative_path();
    if (controllers.empty()) places.emplace_back(root, group);
    if ((',' + controllers + ',').find(",cpu,") != std::string::npos) {
      places.emplace_back(root / controllers, group);
      places.emplace_back(root / "cpu", group);
    }
  }
  std::optional<double> least;
  for (auto& [mount, group] : places) {
    for (;; group = group.parent_path()) {
      if (const std::optional<double> quota = quota_of(mount / group))
        least = std::min(least.value_or(*quota), *quota);
      if (group.empty()) break;
    }
  }
  return least;
}

std::optional<int> cores_of_job() {
  struct System {
    const char *job, *cores;
  };
  constexpr System systems[] = {{"SLURM_JOB_ID", "SLURM_CPUS_ON_NODE"},
                                {"PBS_JOBID", "NCPUS"},
                                {"LSB_JOBID", "LSB_DJOB_NUMPROC"},  // of all nodes
                                {"SGE_TASK_ID", "NSLOTS"}};
  for (const System& system : systems) {
    const char* const cores = std::getenv(system.cores);
    if (std::getenv(system.job) == nullptr || cores == nullptr) continue;
    const std::optional<int> number = peclet::number_in<int>(cores);
    if (number && *number > 0) return number;
  }
  return std::nullopt;
}

int usable_cores() {
  std::ifstream file("/proc/self/cgroup");
  const std::string groups{std::istreambuf_iterator<char>(file), {}};
  const int cores = std::min(cores_of_affinity(), cores_of_job().value_or(std::numeric_limits<int>::max()));
  const std::optional<double> quota = core_quota("/sys/fs/cgroup", groups);
  return std::max(1, quota ? std::min(cores, static_cast<int>(std::ceil(*quota))) : cores);
}

void AwakeClock::end_turn(Time now) {
  awake_ += std::min<Awake>({now - heard_, longest_turn, lease_ / 2});
  heard_ = now;
}

void WorkerWatch::start(Awake now, Awake hello_patience) {
  *this = {};
  hello_patience_ = hello_patience;
  stage_ = Stage::starting;
  started_ = now;
}

void WorkerWatch::hear(const Progressed& progress, Awake now) {
  Course& job = jobs_.at(progress.job);
  if (std::tie(progress.phase, progress.step) > std::tie(job.progress.phase, job.progress.step)) {
    job.renewed = now;
    // Jobs that are packed or wait for a place make no steps. They have time as long as the engine gets on.
    for (auto& [number, other] : jobs_) {
      if (other.progress.phase == 0) other.renewed = now;
    }
  }
  job.progress = {progress.phase, progress.step, progress.steps, progress.strain};
}

void WorkerWatch::renew(Awake now) {
  for (auto& [number, job] : jobs_) job.renewed = now;
}

const WorkerWatch::Course& WorkerWatch::slowest() const {
  return std::ranges::min_element(jobs_, {}, [](const auto& job) { return job.second.renewed; })->second;
}

void WorkerWatch::condemn(AttemptReason reason) {
  if (!condemned_) condemned_ = std::move(reason);
}

bool WorkerWatch::is_overdue(Awake now, Awake lease) const {
  if (condemned_) return false;
  return (stage_ == Stage::starting && now - started_ > hello_patience_) ||
         (is_busy() && now - slowest().renewed > lease);
}

AttemptReason WorkerWatch::overdue(Awake lease, bool is_stopped) const {
  if (stage_ == Stage::starting) return {AttemptOutcome::hung, "it did not say hello"};
  const char* const why = is_recalled_ ? ": it was told to leave"
                          : is_stopped ? ": its process has been stopped"
                                       : "";
  return {is_recalled_ || is_stopped ? AttemptOutcome::killed : AttemptOutcome::hung,
          fmt::format("no new step after {} for {:g} s{}", slowest().progress.step, lease.count(), why)};
}

AttemptReason WorkerWatch::ended(const ExitStatus& ending, bool all_recalled) const {
  if (condemned_) return *condemned_;
  const bool left = (all_recalled || is_recalled_) && ending.status == 0;
  return {left ? AttemptOutcome::drained : outcome_of(ending), to_string(ending)};
}

AttemptEnd end_with_engine(const AttemptReason& how, const ExitStatus& ending, std::int64_t job, int others) {
  if (how.job == 0) return {how.outcome, 0, ending, how.message, 0, others};
  if (how.job == job) return {how.outcome, 0, ending, how.message};
  return {AttemptOutcome::killed, 0, ending, "its engine was killed for another job", 0, others};
}

const char* phase_name(int phase) { return job_phases.at(static_cast<std::size_t>(phase)); }

bool is_file_of(const Job& job, const fs::path& path) {
  const fs::path folder = path.parent_path();
  const bool is_beside_result =
      folder == left_folder(job.spool) && path.filename().string().starts_with(left_stem(job.spool));
  return path == job.spool || checkpoint_of(path) == job.checkpoint || folder == job.failures ||
         is_beside_result;
}

std::optional<fs::path> unwritable_folder(const Job& job) {
  for (const fs::path& folder :
       {job.spool.parent_path(), left_folder(job.spool), job.checkpoint.parent_path(), job.failures}) {
    if (!fs::exists(folder) || !has_room(folder, 0)) return folder;
  }
  return std::nullopt;
}

void allow_open_files(int workers) {
  // Each worker has a socket, a pipe and a log. The others are the database, its copies and other files.
  constexpr rlim_t of_worker = 3, others = 64;
  const rlim_t needed = of_worker * static_cast<rlim_t>(workers) + others;
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0)
    throw std::system_error(errno, std::generic_category(), "getrlimit");
  if (limit.rlim_cur >= needed) return;
  if (limit.rlim_max < needed) {
    throw InputError(
        "", "--workers", std::to_string(workers),
        fmt::format("needs {} open files, and `ulimit -Hn` allows {}: at most {} workers", needed,
                    limit.rlim_max, limit.rlim_max > others ? (limit.rlim_max - others) / of_worker : 0));
  }
  limit.rlim_cur = needed;
  if (setrlimit(RLIMIT_NOFILE, &limit) != 0)
    throw std::system_error(errno, std::generic_category(), "setrlimit");
}

ProcessPool::ProcessPool(std::vector<EngineCommand> commands, CampaignDirectory directory,
                         StopSignals& signals)
    : commands_(std::move(commands)), directory_(std::move(directory)), signals_(signals) {
  workers_.resize(commands_.size());
  for (int worker = 0; worker < size(); ++worker) {
    logs_.push_back(std::make_unique<RotatingFile>(directory_.worker_log(worker), largest_log, older_logs));
    // `peclet doctor` finds workers that outlived their owner by these variables.
    EngineCommand& command = commands_[static_cast<std::size_t>(worker)];
    command.environment.push_back("PECLET_CAMPAIGN=" + directory_.root().string());
    command.environment.push_back(fmt::format("PECLET_OWNER={}", getpid()));
    if (std::getenv("PECLET_DEVICE") != nullptr)
      command.environment.push_back(fmt::format("PECLET_DEVICE_NUMBER={}", worker));
  }
  std::signal(SIGPIPE, SIG_IGN);
}

ProcessPool::~ProcessPool() {
  for (const std::unique_ptr<Worker>& worker : workers_) {
    if (worker) worker->process.hang_up();
  }
}

void ProcessPool::start(int worker) {
  workers_.at(static_cast<std::size_t>(worker)) =
      std::make_unique<Worker>(Worker{EngineProcess(commands_.at(static_cast<std::size_t>(worker)))});
}

std::int64_t ProcessPool::process(int worker) const {
  const std::unique_ptr<Worker>& running = workers_.at(static_cast<std::size_t>(worker));
  return running ? running->process.process() : 0;
}

void ProcessPool::assign(int worker, const Job& job) { send(worker, job_frame(job)); }

void ProcessPool::drain(int worker) { send(worker, {{"type", "drain"}}); }

void ProcessPool::kill(int worker) {
  if (const auto& running = workers_.at(static_cast<std::size_t>(worker))) running->process.kill();
}

bool ProcessPool::is_stopped(int worker) const {
  const std::unique_ptr<Worker>& running = workers_.at(static_cast<std::size_t>(worker));
  return running && running->process.is_stopped();
}

void ProcessPool::send(int number, const Json& message) {
  const auto& worker = workers_.at(static_cast<std::size_t>(number));
  if (!worker || worker->deaf) return;
  worker->unsent += encode_frame(message);
  flush(*worker);
}

void ProcessPool::flush(Worker& worker) {
  while (!worker.unsent.empty()) {
    const ssize_t sent = ::send(worker.process.descriptor(), worker.unsent.data(), worker.unsent.size(),
                                MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return;
    if (sent < 0) {  // the worker has gone; the end of its stream and its exit status follow
      worker.unsent.clear();
      return;
    }
    worker.unsent.erase(0, static_cast<std::size_t>(sent));
  }
}

std::vector<WorkerEvent> ProcessPool::wait(std::chrono::milliseconds patience) {
  std::vector<pollfd> watched{{signals_.descriptor(), POLLIN, 0}};
  std::vector<int> numbers{-1};
  for (int number = 0; number < size(); ++number) {
    const auto& worker = workers_[static_cast<std::size_t>(number)];
    if (!worker) continue;
    if (worker->deaf) {
      patience = std::min(patience, reaping_interval);
      continue;
    }
    const short what = static_cast<short>(worker->unsent.empty() ? POLLIN : POLLIN | POLLOUT);
    watched.push_back({worker->process.descriptor(), what, 0});
    numbers.push_back(number);
  }
  const int ready = poll(watched.data(), watched.size(), static_cast<int>(patience.count()));
  if (ready < 0 && errno != EINTR) throw std::system_error(errno, std::generic_category(), "poll");

  std::vector<WorkerEvent> events;
  if (ready > 0) {
    while (signals_.take()) events.emplace_back(StopSignal{});
    for (std::size_t i = 1; i < watched.size(); ++i) {
      if ((watched[i].revents & POLLOUT) != 0) flush(*workers_[static_cast<std::size_t>(numbers[i])]);
      if ((watched[i].revents & ~POLLOUT) != 0) receive(numbers[i], events);
    }
  }
  keep_what_is_printed();
  for (int number = 0; number < size(); ++number) reap(number, events);
  return events;
}

void ProcessPool::keep_what_is_printed() {
  if (Time::now() - logs_kept_ < log_interval) return;
  logs_kept_ = Time::now();
  for (std::size_t number = 0; number < workers_.size(); ++number) {
    if (!workers_[number]) continue;
    const std::string text = workers_[number]->process.printed();
    if (!text.empty()) logs_[number]->append(text);
  }
}

// Reads everything that has come, so that leases are judged by the latest messages. The number of reads is
// bounded (a socket holds less), so that one worker cannot keep the owner from the others.
void ProcessPool::receive(int number, std::vector<WorkerEvent>& events) {
  Worker& worker = *workers_[static_cast<std::size_t>(number)];
  std::array<char, 65536> bytes;
  for (int reads = 0; reads < 64 && !worker.deaf; ++reads) {
    const ssize_t count = recv(worker.process.descriptor(), bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return;
    if (count <= 0) {
      worker.deaf = true;
      worker.grace = Time::now() + leaving_patience;
      return;
    }
    worker.decoder.feed(bytes.data(), static_cast<std::size_t>(count));
    hear(number, events);
  }
}

void ProcessPool::hear(int number, std::vector<WorkerEvent>& events) {
  Worker& worker = *workers_[static_cast<std::size_t>(number)];
  try {
    while (std::optional<Json> message = worker.decoder.next())
      events.push_back(as_event(number, std::move(*message)));
    return;
  } catch (const FrameError& error) {
    events.emplace_back(Garbled{number, plain(error.what())});
  }
  worker.process.kill();
  worker.deaf = true;
}

void ProcessPool::reap(int number, std::vector<WorkerEvent>& events) {
  std::unique_ptr<Worker>& worker = workers_[static_cast<std::size_t>(number)];
  if (!worker || !worker->deaf) return;
  if (const std::optional<ExitStatus> ending = worker->process.reap()) {
    events.emplace_back(Exited{number, *ending});
    // The last output says why the process ended.
    const std::string text = worker->process.printed();
    if (!text.empty()) logs_[static_cast<std::size_t>(number)]->append(text);
    worker.reset();
  } else if (worker->grace && Time::now() > *worker->grace) {
    worker->process.kill();
  }
}

}  // namespace peclet::runner
