#include "runner/statistics/prediction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace peclet::runner {
namespace {

constexpr double outside = 0.025;  // share of the futures on either side of the range
// Points have the streams 0, 1 ...; what they have in common is independent of each of them.
constexpr std::uint64_t common_stream = std::numeric_limits<std::uint64_t>::max();

// Values seen so far in one future: count, mean and sum of the squared deviations from it.
struct Sample {
  int count = 0;
  double mean = 0, squares = 0;
  Estimate::Values values = Estimate::Values::spread;

  // Two samples become one (Chan, Golub and LeVeque's update).
  void add(const Sample& other) {
    if (other.count == 0) return;
    const double difference = other.mean - mean;
    const int total = count + other.count;
    squares += other.squares + difference * difference * count * other.count / total;
    mean += difference * other.count / total;
    count = total;
  }
  Estimate estimate() const { return {count, mean, std::sqrt(squares / (count - 1) / count), values}; }
};

// What a point's first seeds say of each observable.
struct Pilot {
  int seeds = 0;
  std::vector<std::vector<double>> values{};  // of those that were not lost to it
  std::vector<bool> are_shares{};

  std::size_t fewest_values() const {
    return std::min_element(values.begin(), values.end(),
                            [](const auto& one, const auto& other) { return one.size() < other.size(); })
        ->size();
  }
  std::vector<Estimate> estimates() const {
    std::vector<Estimate> of_each;
    of_each.reserve(values.size());
    for (std::size_t place = 0; place < values.size(); ++place)
      of_each.push_back(estimate(values[place], are_shares[place]));
    return of_each;
  }
};

Pilot pilot_of(const std::vector<std::optional<Outcome>>& outcomes, std::size_t observables, int maximum) {
  Pilot pilot{0, std::vector<std::vector<double>>(observables), std::vector<bool>(observables)};
  for (const std::optional<Outcome>& outcome : outcomes) {
    if (!outcome || pilot.seeds == maximum) break;
    ++pilot.seeds;
    for (std::size_t place = 0; place < observables; ++place) {
      const Observation observation = outcome->of(place);
      if (std::isnan(observation.value)) continue;
      pilot.values[place].push_back(observation.value + observation.control);
      pilot.are_shares[place] = observation.is_share;
    }
  }
  return pilot;
}

Sample sample_of(const Estimate& known) {
  const double count = known.count;
  return {known.count, known.mean, known.standard_error * known.standard_error * count * (count - 1),
          known.values};
}

class Futures {
 public:
  Futures(const Pilot& pilot, const Target& target, int minimum, int maximum, std::uint64_t stream)
      : random_(stream),
        seeds_(pilot.seeds),
        rule_(target, minimum, maximum),
        first_(static_cast<std::size_t>(
            std::upper_bound(rule_.schedule().begin(), rule_.schedule().end(), seeds_) -
            rule_.schedule().begin())) {
    for (const Estimate& known : pilot.estimates()) known_.push_back(sample_of(known));
  }

  // Place of the deciding look in the schedule; without convergence the schedule's size. Variances are off by
  // `factor`, or each by a factor of its own.
  int draw(std::optional<double> factor = {}) {
    std::vector<Normal> population;
    for (const Sample& known : known_) {
      population.push_back(known.values == Estimate::Values::share ? draw_share(known)
                                                                   : draw_population(known, factor));
    }
    std::vector<Sample> samples = known_;
    std::vector<Estimate> estimates(samples.size());
    int seeds = seeds_;
    const std::vector<int>& schedule = rule_.schedule();
    for (std::size_t place = first_; place < schedule.size(); ++place) {
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const int count = survivors(known_[i], schedule[place] - seeds);
        samples[i].add(known_[i].values == Estimate::Values::share ? draw_ones(count, population[i].mean)
                                                                   : draw_values(count, population[i]));
        estimates[i] = samples[i].estimate();
      }
      seeds = schedule[place];
      if (is_reached(rule_.judge(seeds, estimates).verdict)) return static_cast<int>(place);
    }
    return static_cast<int>(schedule.size());
  }

 private:
  struct Normal {
    double mean = 0, deviation = 0;
  };

  double chi_squared(int degrees) {
    return std::chi_squared_distribution<double>(static_cast<double>(degrees))(random_);
  }

  Normal draw_population(const Sample& known, std::optional<double> factor) {
    const int degrees = known.count - 1;
    if (!factor) factor = degrees / chi_squared(degrees);
    const double deviation = std::sqrt(*factor * known.squares / degrees);
    return {known.mean + deviation / std::sqrt(known.count) * normal_(random_), deviation};
  }

  // What k of n leave open by Jeffreys' prior, Beta(k + 1/2, n - k + 1/2), as a ratio of gamma variates.
  Normal draw_share(const Sample& known) {
    const double ones = known.count * known.mean;
    const double above = std::gamma_distribution<double>(ones + 0.5)(random_);
    const double below = std::gamma_distribution<double>(known.count - ones + 0.5)(random_);
    return {above / (above + below), 0};
  }

  Sample draw_ones(int count, double share) {
    if (count == 0) return {};
    const double ones = std::binomial_distribution<int>(count, share)(random_);
    return {count, ones / count, ones * (1 - ones / count), Estimate::Values::share};
  }

  int survivors(const Sample& known, int seeds) {
    if (known.count == seeds_) return seeds;
    return std::binomial_distribution<int>(seeds, static_cast<double>(known.count) / seeds_)(random_);
  }

  // The mean of normal values and the sum of their squared deviations are independent.
  Sample draw_values(int count, const Normal& population) {
    if (count == 0) return {};
    const auto [mean, deviation] = population;
    const double own_mean = mean + deviation / std::sqrt(count) * normal_(random_);
    return {count, own_mean, count > 1 ? deviation * deviation * chi_squared(count - 1) : 0};
  }

  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  std::vector<Sample> known_;  // of each observable
  int seeds_;
  StopRule rule_;
  std::size_t first_;
};

// Whether the mean that a criterion's tolerance is a share of may be zero.
bool may_be_zero(const Target& target, const std::vector<Estimate>& estimates) {
  const std::vector<std::string> observables = target.observables();
  const std::vector<Criterion> criteria = target.criteria();
  return std::any_of(criteria.begin(), criteria.end(), [&](const Criterion& criterion) {
    if (!criterion.tolerance.needs_a_mean()) return false;
    const std::string& measure = criterion.tolerance.relative_to;
    const auto place =
        std::find(observables.begin(), observables.end(), measure.empty() ? criterion.observable : measure);
    const Estimate& known = estimates[static_cast<std::size_t>(place - observables.begin())];
    return 2 * known.standard_error >= std::abs(known.mean);
  });
}

// Whether all values of a criterion's observable are equal.
bool lacks_spread(const Target& target, const std::vector<Estimate>& estimates) {
  const std::vector<std::string> observables = target.observables();
  const std::vector<Criterion> criteria = target.criteria();
  return std::any_of(criteria.begin(), criteria.end(), [&](const Criterion& criterion) {
    const auto place = std::find(observables.begin(), observables.end(), criterion.observable);
    return estimates[static_cast<std::size_t>(place - observables.begin())].values == Estimate::Values::equal;
  });
}

std::size_t rank_of(double probability, std::size_t count) {
  return std::min(count - 1, static_cast<std::size_t>(probability * static_cast<double>(count)));
}

template <typename Number>
Expected<Number> middle_of(const std::vector<Number>& sorted) {
  const std::size_t below = rank_of(outside, sorted.size());
  return {sorted[rank_of(0.5, sorted.size())], sorted[below], sorted[sorted.size() - 1 - below]};
}

}  // namespace

Prediction predict(const std::vector<std::optional<Outcome>>& outcomes, const Target& target, int minimum,
                   int maximum, std::uint64_t stream) {
  const Pilot pilot = pilot_of(outcomes, target.observables().size(), maximum);
  Prediction prediction;
  prediction.pilot = pilot.seeds;
  prediction.lost = pilot.seeds - static_cast<int>(pilot.fewest_values());
  if (pilot.fewest_values() < 2) {
    prediction.obstacle = pilot.seeds < 2 ? Obstacle::too_few : Obstacle::lost;
    return prediction;
  }
  if (lacks_spread(target, pilot.estimates())) {
    prediction.obstacle = Obstacle::no_spread;
    return prediction;
  }
  if (may_be_zero(target, pilot.estimates())) {
    prediction.obstacle = Obstacle::near_zero;
    return prediction;
  }
  const std::vector<int> schedule = look_schedule(minimum, maximum);
  Futures drawn(pilot, target, minimum, maximum, stream);
  std::vector<int> seeds;
  for (int future = 0; future < futures; ++future) {
    const int place = drawn.draw();
    const bool capped = place == std::ssize(schedule);
    seeds.push_back(capped ? maximum : schedule[static_cast<std::size_t>(place)]);
    prediction.capped += capped ? 1.0 / futures : 0;
  }
  std::sort(seeds.begin(), seeds.end());
  prediction.seeds = middle_of(seeds);
  return prediction;
}

std::vector<double> common_factors(const std::vector<CostShare>& shares) {
  double sum = 0, squares = 0;
  for (const CostShare& share : shares) {
    sum += share.cost;
    squares += share.cost * share.cost / (share.values - 1);
  }
  const double degrees = sum * sum / squares;
  if (!(degrees > 0)) return std::vector<double>(futures, 1.0);  // nothing is open
  std::mt19937_64 random(common_stream);
  std::chi_squared_distribution<double> chi_squared(degrees);
  std::vector<double> factors(futures);
  for (double& factor : factors) factor = degrees / chi_squared(random);
  return factors;
}

std::vector<int> places_of_looks(const std::vector<std::optional<Outcome>>& outcomes, const Target& target,
                                 int minimum, int maximum, std::uint64_t stream,
                                 const std::vector<double>& factors) {
  Futures drawn(pilot_of(outcomes, target.observables().size(), maximum), target, minimum, maximum, stream);
  std::vector<int> places;
  places.reserve(factors.size());
  for (const double factor : factors) places.push_back(drawn.draw(factor));
  return places;
}

std::string obstacle_text(const Prediction& prediction) {
  switch (prediction.obstacle) {
    case Obstacle::none:
      break;
    case Obstacle::too_few:
      return "fewer than two seeds have ended";
    case Obstacle::lost:
      return fmt::format("{} of {} seeds are lost", prediction.lost, prediction.pilot);
    case Obstacle::no_spread:
      return fmt::format("the values of {} seeds are equal", prediction.pilot - prediction.lost);
    case Obstacle::near_zero:
      return fmt::format("the mean of {} seeds may be zero", prediction.pilot - prediction.lost);
  }
  return "";
}

Expected<double> middle(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return middle_of(values);
}

}  // namespace peclet::runner
