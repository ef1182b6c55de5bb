// Estimates a curve from the means of its points: a Gaussian process through the logarithms.
//
// With y = ln mean and x = ln axis (the axis itself if a value is not above 0), the values at the points are
//   y_i = f(x_i) + e_i,    e_i ~ N(0, v_i),    v_i = (standard error / mean)^2 (n - 1) / (n - 3),
// where the last factor is the variance of Student's distribution for the n values of a point. The curve is
//   f ~ N(b_0 + b_1 x, a^2 k(|x - x'| / l)),    k(r) = (1 + sqrt(5) r + 5 r^2 / 3) exp(-sqrt(5) r)
// (Matern, 5/2), with coefficients b of any size (C. Rasmussen and C. Williams, Gaussian Processes for
// Machine Learning, 2006, eqs. 2.41, 2.45 and 4.17). Amplitude a and length l are not known either: all
// results are averages over a grid of both, weighted by the marginal likelihood. A band with the best a and l
// alone would be too narrow.
//
// A curve knows nothing that lies between its points. If it turns within the distance of two points by about
// their errors, the band does not show it. If it turns by more, the likelihood prefers small l, and the band
// is as wide as the intervals of the points; or one point contradicts the others, and the curve is refused.
//
// A quantity that is even in the axis may have a datum at 0, among others above 0: at rest. There
//   y = y_0 + c axis^2 + ...,
// so that it counts as a datum at the smallest axis m above 0 if it differs from it by less than its own
// error. The difference is taken for the largest (|y_j - y_0| + 2 errors) (m / axis_j)^2 of the other data j.
// Its square is added to the variance. Where y levels off before the second smallest axis this is too little:
// the datum may then contradict the others, and is left out.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "runner/campaign/campaign.h"
#include "runner/statistics/statistics.h"

namespace peclet::runner {

class CurveFit {
 public:
  // The mean of a point over `count` values with its standard error. Requires at least smallest_count values,
  // a positive mean and a positive error.
  struct Datum {
    double axis = 0, mean = 0, standard_error = 0;
    int count = 0;
  };
  static constexpr int smallest_count = 4;
  // True if the estimate can be a datum.
  static bool takes(const Estimate& estimate);
  // Returns v_i.
  static double variance(const Datum& datum);
  static constexpr std::size_t fewest_points = fewest_of_curve;

  // Requires fewest_points data with different axes. `is_even`: a datum at 0 is at rest, and
  // serves_as_anchor().
  explicit CurveFit(std::vector<Datum> data, bool is_even = false);

  // True if the datum at 0, for a quantity that is even in the axis, differs so little from those above 0.
  static bool serves_as_anchor(std::span<const Datum> data);
  // The curve through all data. The one at rest of an even quantity is left out if it does not serve as an
  // anchor, and if the curve with it is refused. Nothing if fewer than fewest_points are left.
  struct Through;
  static std::optional<Through> through(std::span<const Datum> data, bool is_even);

  // The curve at one place: mean and standard deviation of ln y.
  struct Value {
    double mean = 0, deviation = 0;
  };
  std::vector<Value> at(std::span<const double> axes) const { return outlook(axes).values(); }

  // The distance of a datum from the curve that all others make, in standard deviations of its prediction,
  // and the largest one that is allowed: that of Student's distribution for the datum's values which the
  // largest of all distances exceeds with a probability of 5 % (Bonferroni).
  struct Residual {
    double distance = 0, allowed = 0;
    bool contradicts() const { return !(std::abs(distance) <= allowed); }
  };
  const std::vector<Residual>& residuals() const { return residuals_; }
  // True if a datum contradicts the others: the curve is refused.
  bool is_refused() const;

  // The curve at some places, and what further values would make of its variances.
  class Outlook {
   public:
    std::vector<Value> values() const;
    // Returns the variances of ln y.
    Eigen::VectorXd variances() const;
    // A value that could be had: `noise` is the variance of its logarithm. A mean of several counts as one.
    struct Offer {
      double noise = 0, cost = 1;
    };
    // Returns for each place the one whose value would lower the variance there most for its cost, the first
    // of equal ones; the place itself if no offer lowers it.
    std::vector<std::size_t> best(std::span<const std::optional<Offer>> offers) const;
    // Takes such a value for known, as if it were the mean of the curve. By how much the models differ at a
    // place is taken to fall with their own variance there.
    void take(std::size_t place, double noise);

   private:
    friend class CurveFit;
    struct Weighted {
      double weight = 0;
      Eigen::MatrixXd covariance;
    };
    std::vector<Weighted> models_;
    Eigen::VectorXd mean_, between_;  // of the models' means, and their variance
    Eigen::VectorXd shift_;           // shift_ of the fit at rest, 0 elsewhere
  };
  Outlook outlook(std::span<const double> axes) const;

 private:
  // The curve for one amplitude and length.
  struct Model {
    double weight = 0, amplitude = 0, length = 0;
    Eigen::MatrixXd inverse;       // of the covariance C of the y_i
    Eigen::MatrixXd trend;         // C^-1 H
    Eigen::MatrixXd uncertainty;   // of the coefficients b: (H' C^-1 H)^-1
    Eigen::VectorXd coefficients;  // b
    Eigen::VectorXd rest;          // C^-1 (y - H b)
  };
  double place(double axis) const;
  // Returns the functions of the trend at places: H, with a column for 1 and one for x.
  static Eigen::MatrixXd trend(const Eigen::VectorXd& places);
  // Returns the covariances of f at places with f at the data, or among places.
  Eigen::MatrixXd covariance(const Model& model, const Eigen::VectorXd& one,
                             const Eigen::VectorXd& other) const;
  // The mean of f at places, and its covariance, for one model.
  struct Posterior {
    Eigen::VectorXd mean;
    Eigen::MatrixXd covariance;
  };
  Posterior posterior(const Model& model, const Eigen::VectorXd& places) const;
  Eigen::VectorXd places(std::span<const double> axes) const;
  // `likelihoods` has the logarithm of that of each model.
  void find_residuals(const std::vector<Datum>& data, const std::vector<double>& likelihoods);

  bool is_logarithmic_ = true;
  double smallest_ = 0;  // place of a datum at rest
  double shift_ = 0;     // variance of its difference from the curve there
  Eigen::VectorXd x_, y_, noise_;
  std::vector<Model> models_;
  std::vector<Residual> residuals_;
};

struct CurveFit::Through {
  CurveFit fit;
  std::vector<std::size_t> data;  // the places of its data among those given
};

}  // namespace peclet::runner
