// budget_study [CAMPAIGNS]: what a budget of processor time buys with either allocation, as a CSV table.
//
// Each row simulates CAMPAIGNS campaigns of twelve points with the scheduler and the stop rule of
// `peclet run --budget`; the run times follow the population. Each campaign draws new coefficients of
// variation and costs of the points, log-uniform between 0.05 and 0.5, and 1 and the ratio of the row. Both
// allocations have the same ones. Sums are over the points; a point without a stop test counts as 1.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <queue>
#include <random>
#include <vector>

#include "runner/statistics/scheduler.h"

namespace peclet::runner {
namespace {

constexpr int points = 12, minimum = 8, maximum = 2000;
constexpr double tolerance = 0.03, confidence = 0.95;

struct Case {
  double cost_ratio = 1;  // largest over smallest cost of a seed
  double share = 0.5;     // budget over the processor time that all points need
  int workers = 1;
};

struct Population {
  double spread = 0;   // of values around 1
  double seconds = 0;  // of a seed
  double work = 0;     // the runner assumes costs proportional to it before it has measured them
};

std::vector<Population> draw_populations(const Case& about, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  std::normal_distribution<double> normal;
  std::vector<Population> all;
  for (int point = 0; point < points; ++point) {
    const double spread = 0.05 * std::pow(10, uniform(random));
    const double seconds = std::pow(about.cost_ratio, uniform(random));
    all.push_back({spread, seconds, seconds * std::exp(0.3 * normal(random))});
  }
  return all;
}

// Returns the processor time in which the true spreads would meet the tolerance.
double needed_seconds(const std::vector<Population>& populations) {
  double seconds = 0;
  for (const Population& of : populations) {
    seconds += of.seconds * std::max<double>(minimum, std::pow(1.959964 * of.spread / tolerance, 2));
  }
  return seconds;
}

// Returns the sum of the relative half-widths if the true spreads were known: each further stop test goes to
// the point that it helps most. Requires a budget for all first stop tests.
double width_of_known_spreads(const std::vector<Population>& populations, double budget) {
  const double level = adjusted_confidence(confidence, minimum, maximum);
  const std::vector<int> schedule = stop_test_schedule(minimum, maximum);
  const auto width = [&](std::size_t point, std::size_t stop_test) {
    const int seeds = schedule[stop_test];
    return student_quantile(seeds - 1, level) * populations[point].spread / std::sqrt(seeds);
  };
  std::vector<std::size_t> stop_tests(points, 0);
  for (const Population& of : populations) budget -= minimum * of.seconds;
  for (;;) {
    double best_fall = 0, best_price = 0;
    std::size_t best = 0;
    for (std::size_t point = 0; point < points; ++point) {
      const std::size_t stop_test = stop_tests[point];
      if (width(point, stop_test) <= tolerance || stop_test + 1 == schedule.size()) continue;
      const double price = (schedule[stop_test + 1] - schedule[stop_test]) * populations[point].seconds;
      const double fall = (width(point, stop_test) - width(point, stop_test + 1)) / price;
      if (price > budget || fall <= best_fall) continue;
      best_fall = fall, best_price = price, best = point;
    }
    if (best_fall == 0) break;
    budget -= best_price;
    ++stop_tests[best];
  }
  double sum = 0;
  for (std::size_t point = 0; point < points; ++point) sum += width(point, stop_tests[point]);
  return sum;
}

struct Running {
  double end = 0, seconds = 0;
  SeedId id;
  friend bool operator>(const Running& a, const Running& b) { return a.end > b.end; }
};

// Sums over the points; a point without a stop test counts as 1.
struct Outlay {
  double width = 0;  // relative half-widths of the last stop tests
  double error = 0;  // |mean - 1|
  double spent = 0;  // spent time over the budget
  double unseen = 0;

  void add(const Scheduler& scheduler) {
    for (int point = 0; point < points; ++point) {
      const std::vector<StopTest>& stop_tests = scheduler.stop_tests(point);
      width += stop_tests.empty() ? 1 : relative_width(stop_tests.back());
      error += stop_tests.empty() ? 1 : std::abs(stop_tests.back().controlled.mean - 1);
      unseen += stop_tests.empty() ? 1 : 0;
    }
  }
};

class Trial {
 public:
  Trial(const Case& about, const std::vector<Population>& populations, Allocation allocation, unsigned start)
      : about_(about),
        populations_(populations),
        random_(start),
        scheduler_(std::vector<std::vector<std::optional<Outcome>>>(points),
                   {"relative_viscosity", tolerance, confidence}, minimum, maximum),
        costs_(points) {
    scheduler_.set_allocation(allocation);
    for (int point = 0; point < points; ++point) {
      scheduler_.set_work(point, populations[static_cast<std::size_t>(point)].work);
    }
    budget_ = about.share * needed_seconds(populations);
  }

  void run(Outlay& outlay) {
    for (;;) {
      give_out();
      if (running_.empty()) break;
      const Running ended = running_.top();
      running_.pop();
      now_ = ended.end;
      spent_ += ended.seconds;
      take(ended);
    }
    outlay.add(scheduler_);
    outlay.spent += spent_ / budget_;
  }

 private:
  double seconds_left() const {
    std::vector<int> running;
    for (const auto& cost : costs_) running.push_back(cost.out);
    return budget_ - spent_ - scheduler_.expected_seconds(running);
  }

  void give_out() {
    while (static_cast<int>(running_.size()) < about_.workers && !scheduler_.finished()) {
      const std::optional<SeedId> next = scheduler_.next_within(seconds_left());
      if (!next) return;
      scheduler_.begin(*next);
      const auto point = static_cast<std::size_t>(next->point);
      ++costs_[point].out;
      const double seconds = populations_[point].seconds * std::exp(0.2 * normal_(random_));
      running_.push({now_ + seconds, seconds, *next});
    }
  }

  void take(const Running& ended) {
    const auto point = static_cast<std::size_t>(ended.id.point);
    Costs& costs = costs_[point];
    --costs.out;
    costs.sum += ended.seconds;
    ++costs.count;
    scheduler_.set_cost(ended.id.point, costs.sum / costs.count);
    scheduler_.end(ended.id, {{1 + populations_[point].spread * normal_(random_)}});
  }

  struct Costs {
    int out = 0, count = 0;
    double sum = 0;
  };

  const Case& about_;
  const std::vector<Population>& populations_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  Scheduler scheduler_;
  std::vector<Costs> costs_;
  std::priority_queue<Running, std::vector<Running>, std::greater<>> running_;
  double budget_ = 0, spent_ = 0, now_ = 0;
};

}  // namespace
}  // namespace peclet::runner

int main(int argc, char** argv) {
  using namespace peclet::runner;
  const int campaigns = argc > 1 ? std::atoi(argv[1]) : 1000;
  if (campaigns < 1) {
    fmt::print(stderr, "budget_study [CAMPAIGNS]: an integer from 1 on\n");
    return 2;
  }
  fmt::print(
      "cost_ratio,budget_share,workers,campaigns,width_longest,width_steepest,width_of_known_spreads,"
      "error_longest,error_steepest,unseen_longest,unseen_steepest,spent_longest,spent_steepest\n");
  unsigned row = 0;
  for (const double cost_ratio : {1.0, 100.0}) {
    for (const double share : {0.1, 0.2, 0.4, 0.6, 0.8}) {
      for (const int workers : {1, 8}) {
        const Case about{cost_ratio, share, workers};
        std::mt19937_64 random(++row);
        Outlay longest, steepest;
        double known = 0;
        for (int campaign = 0; campaign < campaigns; ++campaign) {
          const std::vector<Population> populations = draw_populations(about, random);
          const auto start = static_cast<unsigned>(random());
          known += width_of_known_spreads(populations, share * needed_seconds(populations));
          Trial(about, populations, Allocation::longest_first, start).run(longest);
          Trial(about, populations, Allocation::steepest_first, start).run(steepest);
        }
        const auto mean = [&](double sum) { return sum / campaigns; };
        fmt::print("{:g},{:g},{},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.2f},{:.2f},{:.3f},{:.3f}\n",
                   cost_ratio, share, workers, campaigns, mean(longest.width), mean(steepest.width),
                   mean(known), mean(longest.error), mean(steepest.error), mean(longest.unseen),
                   mean(steepest.unseen), mean(longest.spent), mean(steepest.spent));
      }
    }
  }
  return 0;
}
