#include "runner/owner/campaign_state.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "runner/campaign/number_text.h"
#include "runner/campaign/quoting.h"
#include "runner/statistics/curve_proposal.h"
#include "runner/statistics/quantities.h"
#include "runner/store/blame.h"
#include "runner/store/bundle_store.h"
#include "runner/store/result_files.h"

namespace peclet::runner {
namespace {

constexpr std::size_t longest_list = 350;

struct Out {
  std::size_t seeds = 0;
  std::vector<std::string> bundles;
};

// Returns "a-0001, a-0002 and 3 more".
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t most = 3;
  const std::string text = fmt::format(
      "{}", fmt::join(names.begin(),
                      names.begin() + static_cast<std::ptrdiff_t>(std::min(most, names.size())), ", "));
  return names.size() > most ? fmt::format("{} and {} more", text, names.size() - most) : text;
}

constexpr std::size_t files_at_a_time = 64;
constexpr int most_told = 10;

double cost_of(const RealisationResult& result, const char* which) {
  return result.document["cost"][which].get<double>();
}

// True if the result itself is at fault, not a full or failing disk.
bool is_of_the_result(const std::exception& error) {
  if (const auto* const database = dynamic_cast<const DatabaseError*>(&error)) {
    return database->refuses_values();
  }
  return dynamic_cast<const ResultError*>(&error) != nullptr ||
         dynamic_cast<const Json::exception*>(&error) != nullptr ||
         dynamic_cast<const std::logic_error*>(&error) != nullptr;
}

}  // namespace

CampaignState::CampaignState(Database& database, Campaign campaign, CampaignDirectory directory,
                             RunListener& listener, int retries)
    : database_(database),
      seeds_(database),
      results_(database),
      rows_(database),
      events_(database.connection()),
      campaign_(std::move(campaign)),
      directory_(std::move(directory)),
      listener_(listener),
      retries_(retries) {
  move_intruders_aside(directory_, [&](const std::string& text) { listener_.warn(text); });
  point_states_.read_points(database_);
  ingest_spool();
  if (const int recovered = seeds_.recover(); recovered > 0) {
    listener_.note(fmt::format("{} seeds that an earlier run left unfinished are queued again", recovered));
  }
  remove_files_of_the_dead(database_, directory_);
  read_point_states();
  remove_late_checkpoints();
  Transaction booking(database_.connection());
  book_stop_tests();
  choose_values();
  booking.commit();
  after_commit();
}

// Removes checkpoints that a worker of a dead owner saved after the seed had ended elsewhere. The loop is
// over files, which are few where seeds are many.
void CampaignState::remove_late_checkpoints() {
  for (const fs::path& file : whole_files(directory_.checkpoints())) {
    const std::optional<SeedId> id = seed_of_checkpoint(checkpoint_of(file));
    if (id && has_ended(*id)) fs::remove(file);
  }
}

std::optional<SeedId> CampaignState::seed_of_checkpoint(const fs::path& file) const {
  const std::string name = file.filename().string();
  const std::size_t hyphen = name.find('-');
  if (hyphen == std::string::npos) return std::nullopt;
  const std::string_view hash = std::string_view(name).substr(0, hyphen);
  int seed = 0;
  std::from_chars(name.data() + hyphen + 1, name.data() + name.size(), seed);
  for (const PointRecord& known : point_states_.points()) {
    // Compares the whole name, because from_chars() also accepts other spellings of a seed.
    if (known.hash.starts_with(hash) && directory_.checkpoint(known.hash, seed) == file)
      return SeedId{*known.place, seed};
  }
  return std::nullopt;
}

void CampaignState::book_stop_tests() {
  for (int place = 0; place < point_states_.size(); ++place) {
    const std::vector<StopTestRecord> known = database_.stop_tests(point(place).id);
    const bool was_decided = !known.empty() && known.back().stop_test.verdict != Verdict::more;
    store_stop_tests({place, known.size(), was_decided});
    if (!scheduler().decided(place)) seeds_.enqueue(point(place).id, scheduler().wanted(place));
  }
}

void CampaignState::read_point_states() {
  suspects_.forget();
  point_states_.read_seeds(database_, campaign());
  for (int place = 0; place < point_states_.size(); ++place) leave_to_batch_system(place);
}

void CampaignState::roll_back() {
  changes_ = {};
  next_campaign_.reset();
  point_states_.read_points(database_);
  read_point_states();
}

// Stores the stop tests of a point, and tells of the new ones.
void CampaignState::store_stop_tests(const Change& change) {
  const std::vector<StopTest>& stop_tests = scheduler().stop_tests(change.point);
  results_.store_stop_tests(point(change.point).id, stop_tests);
  for (std::size_t i = change.stop_tests; i < stop_tests.size(); ++i)
    changes_.after.tell(StopTestMade{point_name(change.point), stop_tests[i]});
  const bool is_new = stop_tests.size() > change.stop_tests || !change.decided;
  if (is_new && scheduler().decided(change.point)) {
    changes_.after.tell(Decided{point_name(change.point), stop_tests.back()});
  }
}

void CampaignState::book_outcome(SeedId id, const Outcome& outcome) {
  for (const Change& change : point_states_.scheduler().end(id, outcome)) book_change(change);
}

void CampaignState::book_change(const Change& change) {
  const PointRecord& about = point(change.point);
  store_stop_tests(change);
  if (!scheduler().decided(change.point)) {
    seeds_.enqueue(about.id, scheduler().wanted(change.point));
    return;
  }
  const StopTest& last = scheduler().stop_tests(change.point).back();
  const std::string message = fmt::format("{} after {} seeds", to_string(last.verdict), last.seeds);
  events_.write("decided", about.id, std::nullopt, message);
  changes_.after.note(fmt::format("{}: {}", about.label, message));
}

std::optional<SeedId> CampaignState::next_for(const Company& company) {
  if (company.capacity == 1) return next();
  suspects_.read(seeds_);
  if (!suspects_.any()) return next();
  if (!suspects_.may_grow(company)) return std::nullopt;
  const std::optional<double> budget = budget_left();
  const auto may_run = [&](KnownSeed seed) {
    const std::optional<SeedId> id = identify(seed.point, seed.seed);
    return id && scheduler().may_be_next(*id, budget);
  };
  if (const auto seed = suspects_.next_for(company, may_run)) return identify(seed->point, seed->seed);
  const auto is_no_suspect = [&](SeedId id) { return !suspects_.contains({point(id.point).id, id.seed}); };
  return budget ? scheduler().next_within(*budget, is_no_suspect) : scheduler().next(is_no_suspect);
}

std::optional<GivenSeed> CampaignState::give_out(int worker, std::int64_t process, std::int64_t engine,
                                                 const Company& company) {
  const std::optional<SeedId> id = next_for(company);
  if (!id) return std::nullopt;
  const PointRecord& about = point(id->point);
  GivenSeed given_seed{*id, about.id, {}};
  given_seed.job.attempt = seeds_.begin_attempt(about.id, id->seed, worker, process, engine);
  given_seed.job.point = about.hash;
  given_seed.job.seed = id->seed;
  given_seed.job.scene = about.scene;
  given_seed.job.checkpoint = directory_.checkpoint(about.hash, id->seed);
  given_seed.job.spool = directory_.spool_file(about.hash, id->seed, given_seed.job.attempt);
  given_seed.job.failures = directory_.failures();
  point_states_.begin(*id);
  return given_seed;
}

void CampaignState::end_attempt(const GivenSeed& given_seed, const AttemptEnd& end) {
  leave(given_seed);
  changes_.spent_seconds += end.held_seconds;
  seeds_.end_attempt(given_seed.job.attempt, end);
  const std::vector<PastAttempt> history = seeds_.history(given_seed.point_id, given_seed.id.seed);
  // Where any seed of an engine may have done it, none is given up.
  const SeedFate fate = end.company > 0 ? SeedFate{} : judge(history, retries_);
  if (!fate.quarantine) suspects_.note({given_seed.point_id, given_seed.id.seed}, history);
  if (fate.discard_checkpoint) changes_.after.discard(given_seed.job.checkpoint);
  if (end.blamed()) {
    changes_.after.warn(fmt::format("{}: {}{}{}; {}", name_of(given_seed), to_string(end.outcome),
                                    end.message.empty() ? "" : ": ", end.message,
                                    fate.quarantine ? "it is given up" : "it is tried again"));
  }
  changes_.after.tell(AttemptFailed{point_name(given_seed), given_seed.id.seed, end.outcome, end.message,
                                    fate.quarantine, end.blamed()});
  if (!fate.quarantine) {
    seeds_.requeue(given_seed.point_id, given_seed.id.seed);
    if (takes_part(given_seed.id)) point_states_.scheduler().give_back(given_seed.id);
    return;
  }
  seeds_.quarantine(given_seed.point_id, given_seed.id.seed, fate.cause);
  changes_.after.tell(
      SeedEnded{point_name(given_seed), given_seed.id.seed, fate.cause, std::nullopt, std::nullopt});
  if (takes_part(given_seed.id)) book_outcome(given_seed.id, Outcome{});
}

void CampaignState::leave(const GivenSeed& given_seed) {
  suspects_.acquit({given_seed.point_id, given_seed.id.seed});
  if (takes_part(given_seed.id)) point_states_.leave(given_seed.id);
}

void CampaignState::renew_lease(const GivenSeed& given_seed, const JobProgress& progress) {
  seeds_.renew_lease(given_seed.job.attempt, phase_name(progress.phase), progress.step, progress.steps,
                     progress.strain);
}

void CampaignState::refuse_other_engine(const std::string& identity) const {
  for (const PointRecord& about : point_states_.points()) {
    if (point_states_.is_to_be_run(about) && !about.engine_identity.empty() &&
        about.engine_identity != identity) {
      throw OtherEngine(
          fmt::format("{}: has results of engine {}, but the engine now is {}; one point never mixes two",
                      about.label, about.engine_identity, identity));
    }
  }
}

std::int64_t CampaignState::admit_engine(const Json& engine) {
  std::string identity;
  try {
    identity = engine_identity(engine);
  } catch (const ResultError& error) {
    throw IntegrityError(fmt::format("the engine's hello does not say what it is: {}", error.what()));
  }
  if (has_engine() && engine_ != identity) {
    throw IntegrityError(
        fmt::format("the engine changed while the campaign ran: it was {}, now it is {}", engine_, identity));
  }
  refuse_other_engine(identity);
  engine_ = identity;
  return engine_row(database_, engine);
}

void CampaignState::Changes::add(Changes&& later) {
  after.add(std::move(later.after));
  spent_seconds += later.spent_seconds;
  if (later.lacking) lacking = std::move(later.lacking);
}

void CampaignState::after_commit() {
  if (next_campaign_) campaign_ = *std::exchange(next_campaign_, std::nullopt);
  committed_.add(std::exchange(changes_, {}));
  committed_.after.carry_out(listener_, removal_);
  if (const std::optional<Lacking>& lacking = committed_.lacking) {
    throw InputError(campaign_.name, pointer_of(campaign_.target, lacking->observable), lacking->observable,
                     "must be a number that the results have: " + plain(lacking->names, longest_list));
  }
}

RunReport CampaignState::report(int workers) {
  RunReport report;
  report.points = point_states_.size();
  report.has_target = campaign_.target.has_tolerance();
  for (int place = 0; place < report.points; ++place) {
    const std::vector<StopTest>& stop_tests = scheduler().stop_tests(place);
    const bool decided = scheduler().decided(place);
    const bool is_left_alone = !decided && scheduler().cancelled(place);
    report.cancelled += is_left_alone ? 1 : 0;
    report.decided += decided ? 1 : 0;
    report.converged += decided && is_reached(stop_tests.back().verdict) ? 1 : 0;
    report.seeds_ended += scheduler().ended(place);
    report.seeds_wanted += is_left_alone ? scheduler().ended(place) : scheduler().wanted(place);
  }
  report.spent_seconds = spent_seconds();
  report.budget_seconds = point_states_.bounds().budget_seconds;
  // A forecast assumes that every point will be decided, which a budget or a ceiling may prevent.
  if (point_states_.bounds().ceiling || report.budget_seconds) return report;
  report.to_go = point_states_.to_go(database_.unfinished(), campaign_, workers);
  return report;
}

std::string CampaignState::name(SeedId id) const {
  return fmt::format("{} seed {}", point(id.point).label, id.seed);
}

PointName CampaignState::point_name(int place) const { return {point(place).label, point(place).hash}; }

// Names a point that has left the sweep by its hash alone.
PointName CampaignState::point_name(const GivenSeed& given_seed) const {
  return {given_seed.id.point == nowhere ? given_seed.job.point : point(given_seed.id.point).label,
          given_seed.job.point};
}

std::string CampaignState::name_of(const GivenSeed& given_seed) const {
  if (given_seed.id.point != nowhere) return name(given_seed.id);
  return fmt::format("{} (no longer in the sweep) seed {}", given_seed.job.point.substr(0, 12),
                     given_seed.id.seed);
}

void CampaignState::set_bounds(Bounds bounds) { point_states_.set_bounds(std::move(bounds)); }

std::optional<double> CampaignState::wall_seconds(const GivenSeed& given_seed) const {
  return given_seed.id.point == nowhere ? std::nullopt : point_states_.wall_seconds(given_seed.id.point);
}

std::optional<double> CampaignState::budget_left() const {
  const std::optional<double> budget = point_states_.bounds().budget_seconds;
  if (!budget) return std::nullopt;
  return *budget - spent_seconds() - point_states_.expected_seconds();
}

std::optional<SeedId> CampaignState::next() const {
  const std::optional<double> budget = budget_left();
  return budget ? scheduler().next_within(*budget) : scheduler().next();
}

void CampaignState::ingest_spool() {
  removal_.finish();  // files of results taken earlier
  ingest_spool_of(directory_);
  const BundleStore book(database_.connection());
  std::map<std::string, Out> shared;
  for (const BundleRecord& bundle : book.open_bundles()) {
    Out& out = shared[bundle.shared];
    out.seeds += book.seeds_out(bundle.id).size();
    out.bundles.push_back(bundle.name);
  }
  // Tasks of a bundle that was given up may have left results since.
  for (const BundleRecord& bundle : book.forgotten_bundles()) shared[bundle.shared];
  for (const auto& [folder, out] : shared) {
    const CampaignDirectory there(folder);
    std::error_code unreachable;
    if (fs::is_directory(there.spool(), unreachable)) {
      away_.erase(folder);
      ingest_spool_of(there);
    } else if (out.seeds > 0 && away_.insert(folder).second) {
      listener_.warn(
          fmt::format("{}: {}, and {} seeds are out in it ({}). Put it back, and `peclet ingest` takes in "
                      "what it holds; if it is gone for good, `peclet ingest --forget {}` queues seeds again",
                      folder, unreachable ? unreachable.message() : "is not there", out.seeds,
                      listed(out.bundles), out.bundles.front()));
    }
  }
  removal_.finish();
}

void CampaignState::leave_to_batch_system(int place) {
  const BundleStore book(database_.connection());
  for (const int seed : book.seeds_out_of_point(point(place).id)) {
    // A seed beyond the maximum (it was larger once) has no part in the stop tests.
    if (seed < campaign().maximum_realisations && !has_ended({place, seed}))
      point_states_.scheduler().begin({place, seed});
  }
}

std::vector<SeedId> CampaignState::draw(bool ahead) {
  std::vector<SeedId> drawn;
  while (const std::optional<SeedId> id = scheduler().next()) {
    if (!ahead && id->seed >= scheduler().wanted(id->point)) break;
    point_states_.scheduler().begin(*id);
    drawn.push_back(*id);
  }
  return drawn;
}

std::optional<SeedId> CampaignState::identify(std::int64_t point_id, int seed) const {
  const std::optional<int> place = point_states_.place_of(point_id);
  return place ? std::optional(SeedId{*place, seed}) : std::nullopt;
}

bool CampaignState::has_ended(SeedId id) { return seeds_.has_ended(point(id.point).id, id.seed); }

void CampaignState::end_handed_over(SeedId id, int task, const AttemptReport& report,
                                    const fs::path& checkpoint) {
  const PointRecord& about = point(id.point);
  seeds_.attempt_elsewhere(about.id, id.seed, task, report);
  if (has_ended(id)) return;
  const SeedFate fate = report.company > 0 ? SeedFate{} : judge(seeds_.history(about.id, id.seed), retries_);
  if (fate.discard_checkpoint) changes_.after.discard(checkpoint);
  // A drained attempt with a message failed because a disk was full, which is not blamed.
  const bool is_excused = report.outcome == AttemptOutcome::drained && !report.message.empty();
  if (report.blamed() || is_excused) {
    changes_.after.warn(fmt::format("{} on {}: {}{}{}; {}", name(id), report.host, to_string(report.outcome),
                                    report.message.empty() ? "" : ": ", report.message,
                                    fate.quarantine ? "it is given up" : "it is tried again"));
  }
  if (!fate.quarantine) {
    take_back(id);
    return;
  }
  seeds_.quarantine(about.id, id.seed, fate.cause);
  book_outcome(id, Outcome{});
}

void CampaignState::take_back(SeedId id) {
  if (id.seed < campaign().maximum_realisations && !has_ended(id)) point_states_.scheduler().give_back(id);
}

void CampaignState::take_over(const Campaign& campaign) {
  rows_.take_over(campaign);
  next_campaign_ = campaign;
}

void CampaignState::read_again() {
  point_states_.read_points(database_);
  read_point_states();
  book_stop_tests();
}

void CampaignState::refresh() {
  read_again();
  choose_values();
  if (has_engine()) refuse_other_engine(engine_);
}

bool CampaignState::choose_values() {
  bool any = false;
  while (const std::optional<ChosenValue> chosen = choose_value(scheduler(), campaign())) {
    const std::string message =
        fmt::format("{} = {:g}: seeds there narrow the widest band of {}, {}, most", campaign().target.over(),
                    chosen->value, chosen->observable, percent(chosen->width));
    take_over(parse_campaign(with_chosen_value(campaign().document, chosen->value), campaign().name));
    read_again();
    events_.write("chosen", message);
    changes_.after.note("a new value, " + message);
    changes_.after.tell(
        ValueChosen{campaign().target.over(), chosen->value, chosen->observable, chosen->width});
    any = true;
  }
  return any;
}

bool CampaignState::find_place(GivenSeed& given_seed) const {
  given_seed.id.point = point_states_.place_of(given_seed.job.point).value_or(nowhere);
  return takes_part(given_seed.id) && !scheduler().cancelled(given_seed.id.point);
}

int CampaignState::accept_engine(const std::string& identity) {
  int points = 0;
  std::set<std::string> folders{directory_.root().string()};
  const BundleStore book(database_.connection());
  if (const std::string shared = book.last_shared(); !shared.empty()) folders.insert(shared);
  for (const BundleRecord& bundle : book.open_bundles()) folders.insert(bundle.shared);
  Transaction booking(database_.connection());
  for (const PointRecord& about : point_states_.points()) {
    if (!point_states_.is_to_be_run(about) || about.engine_identity.empty() ||
        about.engine_identity == identity)
      continue;
    rows_.set_aside(about, identity);
    changes_.after.note(
        fmt::format("{}: results of engine {} are set aside", about.label, about.engine_identity));
    ++points;
    // Another engine cannot continue from these checkpoints.
    for (const RealisationRecord& record : database_.realisations(about.id)) {
      for (const std::string& folder : folders) {
        changes_.after.discard(CampaignDirectory(folder).checkpoint(about.hash, record.seed));
      }
    }
  }
  refresh();
  booking.commit();
  after_commit();
  return points;
}

// A result comes from outside. Booking it changes six tables, the scheduler and the effects that follow the
// commit. After a failure none of these changes may stay, because a half-stored result would be counted.
std::string CampaignState::take_whole(const fs::path& spool, const Reading& read, const Booking& book) {
  Changes of_others = std::exchange(changes_, {});
  bool is_taken = false;
  std::string why;
  try {
    const RealisationResult result = read();
    Savepoint booking(database_.connection());
    book(result);
    booking.keep();
    is_taken = true;
  } catch (const std::exception& error) {
    if (!is_of_the_result(error)) throw;
    why = plain(error.what());
  }
  Changes of_result = std::exchange(changes_, std::move(of_others));
  if (is_taken) {
    changes_.add(std::move(of_result));
    return "";
  }
  if (of_result.have_changed_points) read_point_states();
  turn_down(spool, why);
  return why;
}

void CampaignState::take(const RealisationResult& result, const fs::path& spool) {
  const StoredResult stored = results_.store(result, campaign_.target);
  const auto take_in = [&] {
    take_files(database_.connection(), directory_, result, spool, stored,
               campaign_.keeps_files_of(result.seed), changes_.after);
    changes_.after.remove(spool);
  };
  switch (stored.what) {
    case Stored::stored_apart:
      take_in();
      return;
    case Stored::stored:
    case Stored::duplicate:
      take_in();
      for (const fs::path& checkpoint :
           std::set{directory_.checkpoint(result.point, result.seed),
                    home_of_spool_file(spool).checkpoint(result.point, result.seed)}) {
        changes_.after.remove(checkpoint);
        changes_.after.remove(growing_beside(checkpoint));
      }
      break;
    case Stored::conflict:
      turn_down(spool, "another run of the same seed gave another result");
      return;
    case Stored::mixed_engine:
      turn_down(spool, "its point has results of another engine");
      return;
    case Stored::unknown_point:
      turn_down(spool, "it belongs to no point of this campaign");
      return;
  }
  const std::optional<int> place = point_states_.place_of(result.point);
  if (stored.what == Stored::duplicate || !place) return;
  if (result.completed()) note_lacking(result);
  const bool is_lost = stored.outcome.is_lost();
  const std::optional<double> value = is_lost ? std::nullopt : std::optional(stored.outcome.value);
  const double cpu_seconds = cost_of(result, "cpu_seconds");
  changes_.after.tell(SeedEnded{point_name(*place), result.seed, stored.cause, value, cpu_seconds});
  if (!point_states_.has_seeds()) return;  // read_point_states() reads it with the others
  changes_.have_changed_points = true;
  point_states_.add_cost(*place, cost_of(result, "wall_seconds"), cpu_seconds);
  if (is_lost) {
    changes_.after.note(fmt::format("{}: ended with {}{}{}", name({*place, result.seed}), stored.cause,
                                    stored.reason.empty() ? "" : ": ", stored.reason));
  }
  book_outcome({*place, result.seed}, stored.outcome);
}

void CampaignState::note_lacking(const RealisationResult& result) {
  const std::string name = lacking_in(result.document, campaign_.target.observables());
  if (name.empty()) return;
  const std::string names = names_of_targets(result.document);
  changes_.lacking = {name, names.empty() ? "none" : names};
}

void CampaignState::turn_down(const fs::path& spool, const std::string& why) {
  const std::string message = fmt::format("{} is not taken: {}", plain_name(spool), why);
  events_.write("rejected", message);
  // Only the first few are told of; the table `event` has all.
  if (++turned_down_ <= most_told) {
    changes_.after.warn(
        fmt::format("{}; it is kept in {}", message, home_of_spool_file(spool).rejected().string()));
  }
  if (is_there(spool)) changes_.after.reject(spool);
}

void CampaignState::ingest_spool_of(const CampaignDirectory& directory) {
  turned_down_ = 0;
  // Each commit waits for the disk, so files are booked in groups. After a crash the rest is still there.
  const std::vector<fs::path> files = spool_files(directory);
  for (std::size_t next = 0; next < files.size();) {
    const std::size_t end = std::min(files.size(), next + files_at_a_time);
    Transaction booking(database_.connection());
    for (; next < end; ++next) ingest(files[next]);
    if (point_states_.has_seeds()) choose_values();
    booking.commit();
    after_commit();
  }
  if (const int told = std::exchange(turned_down_, 0); told > most_told) {
    listener_.warn(fmt::format("{} more files in {} are not taken: the table `event` says why",
                               told - most_told, directory.spool().string()));
  }
}

void CampaignState::ingest(const fs::path& file) {
  const auto read = [&file] {
    RealisationResult result = read_spool_file(file, "");
    // An engine that answered with another seed's result may have died before that was noticed.
    if (belongs_to_another(file, result)) throw ResultError("it is named for another point or seed");
    return result;
  };
  take_whole(file, read, [&](const RealisationResult& result) { take(result, file); });
}

bool CampaignState::take_result(const GivenSeed& given_seed, const std::string& sha256, std::int64_t step,
                                double held_seconds, std::string& why) {
  turned_down_ = 0;
  const auto read = [&] {
    RealisationResult result = read_spool_file(given_seed.job.spool, sha256);
    if (result.point != given_seed.job.point || result.seed != given_seed.job.seed) {
      throw ResultError("it is of another point or seed than the job");
    }
    if (result.engine != engine_) throw ResultError("it names another engine than the worker's hello");
    return result;
  };
  why = take_whole(given_seed.job.spool, read, [&](const RealisationResult& result) {
    take(result, given_seed.job.spool);
    seeds_.end_attempt(given_seed.job.attempt, {AttemptOutcome::result, step});
    changes_.spent_seconds += std::min(held_seconds, cost_of(result, "cpu_seconds"));
    leave(given_seed);
  });
  return why.empty();
}

}  // namespace peclet::runner
