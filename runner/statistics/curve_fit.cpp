#include "runner/statistics/curve_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace peclet::runner {
namespace {

// The grid of lengths and amplitudes.
constexpr int lengths = 10, amplitudes = 10;
// Lengths reach from a share of the smallest distance between points to a multiple of the largest one.
constexpr double shortest = 0.5, longest = 3;
// Amplitudes reach from a share of the scatter of the y_i, or of their errors, to a multiple of it.
constexpr double of_scatter = 0.1, of_errors = 0.3, largest = 10;
// Models with a smaller share of the largest weight are left out.
constexpr double least_weight = 1e-4;
// Errors below a millionth would make the covariances singular.
constexpr double least_noise = 1e-12;
constexpr double level = 0.05;  // probability that a curve is refused although it is one

double geometric(double from, double to, int step, int steps) {
  return from * std::pow(to / from, static_cast<double>(step) / (steps - 1));
}

double median(Eigen::VectorXd values) {
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double smallest_axis(std::span<const CurveFit::Datum> data) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const CurveFit::Datum& datum : data) {
    if (datum.axis > 0) smallest = std::min(smallest, datum.axis);
  }
  return smallest;
}

// Returns the square of the difference between the datum at rest and the curve at the smallest axis; 0
// without a datum at rest.
double shift(std::span<const CurveFit::Datum> data) {
  const auto rest = std::ranges::find(data, 0.0, &CurveFit::Datum::axis);
  if (rest == data.end()) return 0;
  const double smallest = smallest_axis(data);
  double largest_shift = 0;
  for (const CurveFit::Datum& datum : data) {
    if (datum.axis <= smallest) continue;
    const double difference = std::abs(std::log(datum.mean / rest->mean)) +
                              2 * std::sqrt(CurveFit::variance(datum) + CurveFit::variance(*rest));
    largest_shift = std::max(largest_shift, difference * std::pow(smallest / datum.axis, 2));
  }
  return largest_shift * largest_shift;
}

double matern(double ratio) {
  const double r = std::sqrt(5.0) * ratio;
  return (1 + r + r * r / 3) * std::exp(-r);
}

}  // namespace

bool CurveFit::takes(const Estimate& estimate) {
  return estimate.count >= smallest_count && estimate.values == Estimate::Values::spread &&
         std::isfinite(estimate.mean) && estimate.mean > 0 && estimate.standard_error > 0 &&
         std::isfinite(variance({0, estimate.mean, estimate.standard_error, estimate.count}));
}

double CurveFit::variance(const Datum& datum) {
  const double error = datum.standard_error / datum.mean;
  return error * error * (datum.count - 1) / (datum.count - 3);
}

CurveFit::CurveFit(std::vector<Datum> data, bool is_even) {
  assert(data.size() >= fewest_points);
  is_logarithmic_ = std::ranges::all_of(
      data, [&](const Datum& datum) { return datum.axis > 0 || (is_even && datum.axis == 0); });
  if (is_even && is_logarithmic_) {
    smallest_ = smallest_axis(data);
    shift_ = shift(data);
  }
  const auto count = static_cast<Eigen::Index>(data.size());
  x_.resize(count);
  y_.resize(count);
  noise_.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Datum& datum = data[static_cast<std::size_t>(i)];
    assert(datum.count >= smallest_count && datum.mean > 0 && datum.standard_error > 0);
    x_[i] = place(datum.axis);
    y_[i] = std::log(datum.mean);
    noise_[i] = std::max(least_noise, variance(datum)) + (datum.axis == 0 ? shift_ : 0);
  }
  double nearest = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      if (x_[i] != x_[j]) nearest = std::min(nearest, std::abs(x_[i] - x_[j]));
    }
  }
  const double span = x_.maxCoeff() - x_.minCoeff();
  const double scatter = std::sqrt((y_.array() - y_.mean()).square().mean());
  const double smallest = std::max(of_scatter * scatter, of_errors * std::sqrt(median(noise_)));
  std::vector<double> likelihoods;
  for (int l = 0; l < lengths; ++l) {
    for (int a = 0; a < amplitudes; ++a) {
      Model model;
      model.length = geometric(shortest * nearest, longest * span, l, lengths);
      model.amplitude = geometric(smallest, largest * std::max(scatter, smallest), a, amplitudes);
      Eigen::MatrixXd all = covariance(model, x_, x_);
      all.diagonal() += noise_;
      const Eigen::LLT<Eigen::MatrixXd> factor(all);
      if (factor.info() != Eigen::Success) continue;
      model.inverse = factor.solve(Eigen::MatrixXd::Identity(count, count));
      model.trend = model.inverse * trend(x_);
      const Eigen::LLT<Eigen::MatrixXd> precision(trend(x_).transpose() * model.trend);
      model.uncertainty = precision.solve(Eigen::MatrixXd::Identity(2, 2));
      model.coefficients = model.uncertainty * (model.trend.transpose() * y_);
      const Eigen::VectorXd residual = y_ - trend(x_) * model.coefficients;
      model.rest = model.inverse * residual;
      const auto determinant = [](const Eigen::LLT<Eigen::MatrixXd>& of) {
        return 2 * of.matrixLLT().diagonal().array().log().sum();
      };
      likelihoods.push_back(-0.5 * (determinant(factor) + determinant(precision) + residual.dot(model.rest)));
      models_.push_back(std::move(model));
    }
  }
  find_residuals(data, likelihoods);
  const double best = *std::ranges::max_element(likelihoods);
  double sum = 0;
  for (std::size_t m = 0; m < models_.size(); ++m) {
    models_[m].weight = std::exp(likelihoods[m] - best);
    if (models_[m].weight < least_weight) models_[m].weight = 0;
    sum += models_[m].weight;
  }
  std::erase_if(models_, [](const Model& model) { return model.weight == 0; });
  for (Model& model : models_) model.weight /= sum;
}

Eigen::MatrixXd CurveFit::trend(const Eigen::VectorXd& places) {
  Eigen::MatrixXd functions(places.size(), 2);
  functions << Eigen::VectorXd::Ones(places.size()), places;
  return functions;
}

double CurveFit::place(double axis) const {
  if (!is_logarithmic_) return axis;
  return std::log(axis == 0 ? smallest_ : axis);
}

bool CurveFit::serves_as_anchor(std::span<const Datum> data) {
  const auto rest = std::ranges::find(data, 0.0, &Datum::axis);
  return rest != data.end() && shift(data) <= variance(*rest);
}

std::optional<CurveFit::Through> CurveFit::through(std::span<const Datum> data, bool is_even) {
  std::vector<std::size_t> used(data.size());
  std::iota(used.begin(), used.end(), 0);
  const auto rest = std::ranges::find(data, 0.0, &Datum::axis) - data.begin();
  bool has_rest = is_even && rest < std::ssize(data);
  const auto leave_out_rest = [&] {
    used.erase(used.begin() + rest);
    has_rest = false;
  };
  const auto fit = [&] {
    std::vector<Datum> chosen;
    chosen.reserve(used.size());
    for (const std::size_t place : used) chosen.push_back(data[place]);
    return CurveFit(std::move(chosen), is_even);
  };
  if (has_rest && !serves_as_anchor(data)) leave_out_rest();
  if (used.size() < fewest_points) return {};
  CurveFit made = fit();
  if (made.is_refused() && has_rest && used.size() > fewest_points) {
    leave_out_rest();
    made = fit();
  }
  return Through{std::move(made), std::move(used)};
}

Eigen::VectorXd CurveFit::places(std::span<const double> axes) const {
  Eigen::VectorXd all(static_cast<Eigen::Index>(axes.size()));
  std::ranges::transform(axes, all.begin(), [this](double axis) { return place(axis); });
  return all;
}

Eigen::MatrixXd CurveFit::covariance(const Model& model, const Eigen::VectorXd& one,
                                     const Eigen::VectorXd& other) const {
  return Eigen::MatrixXd::NullaryExpr(one.size(), other.size(), [&](Eigen::Index i, Eigen::Index j) {
    return model.amplitude * model.amplitude * matern(std::abs(one[i] - other[j]) / model.length);
  });
}

// The constant's own variance, 1 / (1' C^-1 1), is part of the covariance (eq. 2.42 with b of infinite
// width).
CurveFit::Posterior CurveFit::posterior(const Model& model, const Eigen::VectorXd& places) const {
  const Eigen::MatrixXd known = covariance(model, places, x_);
  const Eigen::MatrixXd missed = trend(places) - known * model.trend;
  return {known * model.rest + trend(places) * model.coefficients,
          covariance(model, places, places) - known * model.inverse * known.transpose() +
              missed * model.uncertainty * missed.transpose()};
}

// Without datum i the prediction of y_i has the mean y_i - (P y)_i / P_ii and the variance 1 / P_ii, where P
// is the precision of the y_i for unknown coefficients (eqs. 5.12 and 2.41). The likelihood of the others is
// that of all over that of this prediction.
void CurveFit::find_residuals(const std::vector<Datum>& data, const std::vector<double>& likelihoods) {
  const auto count = static_cast<Eigen::Index>(models_.size());
  Eigen::ArrayXXd variances(y_.size(), count), residuals(y_.size(), count);
  for (Eigen::Index m = 0; m < count; ++m) {
    const Model& model = models_[static_cast<std::size_t>(m)];
    const Eigen::MatrixXd precision =
        model.inverse - model.trend * model.uncertainty * model.trend.transpose();
    variances.col(m) = precision.diagonal().array().inverse();
    residuals.col(m) = (precision * y_).array() * variances.col(m);
  }
  const Eigen::Map<const Eigen::ArrayXd> of_all(likelihoods.data(), count);
  for (Eigen::Index i = 0; i < y_.size(); ++i) {
    const Eigen::ArrayXd variance = variances.row(i), residual = residuals.row(i);
    const Eigen::ArrayXd of_others = of_all + 0.5 * (variance.log() + residual.square() / variance);
    Eigen::ArrayXd weight = (of_others - of_others.maxCoeff()).exp();
    weight /= weight.sum();
    const double mean = (weight * residual).sum();
    const double square = (weight * (variance + residual.square())).sum();
    const int values = data[static_cast<std::size_t>(i)].count;
    const double quantile = student_quantile(values - 1, 1 - level / static_cast<double>(data.size()));
    residuals_.push_back(
        {mean / std::sqrt(square - mean * mean), quantile * std::sqrt((values - 3.0) / (values - 1.0))});
  }
}

bool CurveFit::is_refused() const { return std::ranges::any_of(residuals_, &Residual::contradicts); }

CurveFit::Outlook CurveFit::outlook(std::span<const double> axes) const {
  const Eigen::VectorXd places = this->places(axes);
  Outlook outlook;
  Eigen::ArrayXd mean = Eigen::ArrayXd::Zero(places.size()), square = mean;
  for (const Model& model : models_) {
    Posterior found = posterior(model, places);
    mean += model.weight * found.mean.array();
    square += model.weight * found.mean.array().square();
    outlook.models_.push_back({model.weight, std::move(found.covariance)});
  }
  outlook.mean_ = mean;
  outlook.between_ = (square - mean.square()).max(0);
  outlook.shift_.resize(places.size());
  std::ranges::transform(axes, outlook.shift_.begin(),
                         [this](double axis) { return axis == 0 ? shift_ : 0; });
  return outlook;
}

std::vector<CurveFit::Value> CurveFit::Outlook::values() const {
  const Eigen::VectorXd deviation = (variances() + shift_).cwiseMax(0).cwiseSqrt();
  std::vector<Value> values;
  values.reserve(static_cast<std::size_t>(mean_.size()));
  for (Eigen::Index i = 0; i < mean_.size(); ++i) values.push_back({mean_[i], deviation[i]});
  return values;
}

Eigen::VectorXd CurveFit::Outlook::variances() const {
  Eigen::VectorXd variances = between_;
  for (const auto& [weight, covariance] : models_) variances += weight * covariance.diagonal();
  return variances;
}

// A value of variance u at place q lowers the variance at place i by cov(i, q)^2 / (cov(q, q) + u).
std::vector<std::size_t> CurveFit::Outlook::best(std::span<const std::optional<Offer>> offers) const {
  std::vector<std::size_t> best(offers.size());
  std::iota(best.begin(), best.end(), 0);
  std::vector<double> most(offers.size());
  for (std::size_t offered = 0; offered < offers.size(); ++offered) {
    if (!offers[offered]) continue;
    const auto& [noise, cost] = *offers[offered];
    const auto q = static_cast<Eigen::Index>(offered);
    Eigen::VectorXd gain = Eigen::VectorXd::Zero(between_.size());
    for (const auto& [weight, covariance] : models_)
      gain += weight / (covariance(q, q) + noise) * covariance.col(q).cwiseAbs2();
    for (std::size_t place = 0; place < best.size(); ++place) {
      const double per_cost = gain[static_cast<Eigen::Index>(place)] / cost;
      if (!(per_cost > most[place])) continue;
      most[place] = per_cost;
      best[place] = offered;
    }
  }
  return best;
}

void CurveFit::Outlook::take(std::size_t place, double noise) {
  const auto q = static_cast<Eigen::Index>(place);
  const Eigen::VectorXd before = variances() - between_;
  for (auto& [weight, covariance] : models_) {
    const Eigen::VectorXd column = covariance.col(q);
    covariance -= column * column.transpose() / (column[q] + noise);
  }
  const Eigen::VectorXd after = variances() - between_;
  between_ = between_.cwiseProduct((before.array() > 0).select(after.cwiseQuotient(before), 1.0).matrix());
}

}  // namespace peclet::runner
