#include "runner/store/number_store.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "contract/decimal.h"
#include "contract/errors.h"
#include "contract/frames.h"
#include "runner/campaign/campaign.h"

namespace peclet::runner {
namespace {

// Writes each number with the fewest digits that give the same number again.
std::string text_of(const std::vector<double>& numbers) {
  std::string text = "[";
  for (const double number : numbers) {
    if (text.size() > 1) text += ',';
    text += std::isnan(number) ? "null" : fmt::format("{}", number);
  }
  return text + ']';
}

// Reads the first `most` numbers of a text of text_of(). Returns false if the text has another form.
bool read_numbers(std::string_view text, std::size_t most, std::vector<double>& numbers) {
  constexpr std::string_view null = "null";
  numbers.clear();
  if (!text.starts_with('[') || !text.ends_with(']')) return false;
  const char* place = text.data() + 1;
  const char* const end = text.data() + text.size() - 1;
  while (place < end && numbers.size() < most) {
    double number = std::numeric_limits<double>::quiet_NaN();
    if (std::string_view(place, end).starts_with(null)) {
      place += null.size();
    } else {
      const auto [after, error] = read_double(place, end, number);
      if (error != std::errc()) return false;
      place = after;
    }
    numbers.push_back(number);
    if (place < end && *place++ != ',') return false;
  }
  return true;
}

std::int64_t layout_row(Connection& connection, const std::string& text) {
  Statement known(connection, "SELECT layout_id FROM number_layout WHERE layout = ?", text);
  if (known.step()) return known.integer(0);
  connection.run("INSERT INTO number_layout (layout) VALUES (?)", text);
  return connection.last_insert_id();
}

}  // namespace

ResultNumbers numbers_of(const Json& result, const std::vector<std::string>& observables) {
  if (!result.at("mean").is_object()) return {};
  const NumberLayout layout(result, observables);
  const std::vector<double> numbers = layout.numbers(result);
  const Json& state = result.at("final_state_sha256");
  Outcome outcome = outcome_of(layout, numbers, state.is_string() ? state.get<std::string>() : "");
  for (const char* const phase : {"equilibration", "production"})
    outcome.steps += result.value("steps", Json::object()).value(phase, 0.0);
  return {layout.text(), text_of(numbers), std::move(outcome)};
}

void store_numbers(Connection& connection, std::int64_t point, int seed, const ResultNumbers& numbers) {
  if (numbers.numbers.empty()) return;
  connection.run("INSERT OR REPLACE INTO numbers (point_id, seed, layout_id, numbers) VALUES (?, ?, ?, ?)",
                 point, seed, layout_row(connection, numbers.layout), numbers.numbers);
}

Observation leading_observation(std::string_view text) {
  thread_local std::vector<double> numbers;
  if (text.empty()) return {};
  if (!read_numbers(text, numbers_of_observation, numbers) || numbers.size() < numbers_of_observation) {
    throw IntegrityError("the database holds invalid numbers: " + std::string(text.substr(0, 100)));
  }
  return observation_of(numbers, false);
}

const NumberLayout& NumberStore::layout(std::int64_t id) {
  if (const auto known = layouts_.find(id); known != layouts_.end()) return known->second;
  Statement query(connection_, "SELECT layout FROM number_layout WHERE layout_id = ?", id);
  if (!query.step()) throw IntegrityError("the database holds numbers without their layout");
  return layouts_.emplace(id, NumberLayout::of_text(query.text(0))).first->second;
}

void NumberStore::read(const NumberLayout& layout, int seed, std::string_view text) {
  if (read_numbers(text, layout.count() + 1, numbers_) && numbers_.size() == layout.count()) return;
  throw IntegrityError(fmt::format(
      "the stored numbers of seed {} are not those that their layout says; see `peclet doctor`", seed));
}

void NumberStore::for_each(std::int64_t point, int end, const Visit& visit) {
  Statement query(
      connection_,
      "SELECT seed, layout_id, numbers, cause FROM numbers JOIN realisation USING (point_id, seed) "
      "WHERE point_id = ? AND seed < ? ORDER BY seed",
      point, end);
  while (query.step()) {
    const int seed = query.number(0);
    const NumberLayout& about = layout(query.integer(1));
    read(about, seed, query.text(2));
    visit({seed, is_jam(query.text(3)), about, numbers_});
  }
}

std::vector<std::optional<Outcome>> NumberStore::outcomes(std::int64_t point) {
  Statement query(
      connection_,
      "SELECT seed, layout_id, numbers, final_state_sha256, coalesce(equilibration_steps, 0) + "
      "coalesce(production_steps, 0) FROM realisation LEFT JOIN numbers USING "
      "(point_id, seed) WHERE point_id = ? AND seed < ? AND state IN ('done', 'failed', 'quarantined') ORDER "
      "BY seed",
      point, most_realisations);
  std::vector<std::optional<Outcome>> outcomes;
  while (query.step()) {
    const int seed = query.number(0);
    outcomes.resize(static_cast<std::size_t>(seed) + 1);
    outcomes.back() = Outcome{};
    if (query.is_null(1)) continue;
    const NumberLayout& about = layout(query.integer(1));
    read(about, seed, query.text(2));
    outcomes.back() = outcome_of(about, numbers_, query.text(3));
    outcomes.back()->steps = query.real(4);
  }
  return outcomes;
}

bool NumberStore::agrees(std::int64_t point, int seed, const Json& result,
                         const std::vector<std::string>& observables) {
  Statement query(connection_,
                  "SELECT layout, numbers FROM numbers JOIN number_layout USING (layout_id) WHERE point_id = "
                  "? AND seed = ?",
                  point, seed);
  const bool has_numbers = query.step();
  const ResultNumbers numbers = numbers_of(result, observables);
  return has_numbers ? query.text(0) == numbers.layout && query.text(1) == numbers.numbers
                     : numbers.numbers.empty();
}

}  // namespace peclet::runner
