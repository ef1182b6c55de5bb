// Sampled second moments of a vector, and their deviation from expected ones.
#pragma once

#include <Eigen/Core>

namespace peclet::engine {

// The covariance of vectors whose mean is known to be zero.
class SampledCovariance {
 public:
  explicit SampledCovariance(Eigen::Index size)
      : sum_(Eigen::VectorXd::Zero(size)), products_(Eigen::MatrixXd::Zero(size, size)) {}

  void add(const Eigen::VectorXd& x) {
    sum_ += x;
    products_.noalias() += x * x.transpose();
    ++samples_;
  }

  // Returns the largest |sampled - expected C| in units of its standard deviation, which for normal vectors
  // is sqrt((C_aa C_bb + C_ab^2) / samples). Every C_aa must be positive.
  double largest_deviation(const Eigen::MatrixXd& expected) const {
    const Eigen::MatrixXd squares = expected.diagonal() * expected.diagonal().transpose();
    const Eigen::ArrayXXd variance = (squares.array() + expected.array().square()) / samples_;
    const Eigen::ArrayXXd difference = products_.array() / samples_ - expected.array();
    return (difference.abs() / variance.sqrt()).maxCoeff<Eigen::PropagateNaN>();
  }

  // Returns the largest |mean| in units of its standard deviation sqrt(C_aa / samples).
  double largest_mean(const Eigen::MatrixXd& expected) const {
    const Eigen::ArrayXd deviation = (samples_ * expected.diagonal().array()).sqrt();
    return (sum_.array().abs() / deviation).maxCoeff<Eigen::PropagateNaN>();
  }

 private:
  double samples_ = 0;
  Eigen::VectorXd sum_;
  Eigen::MatrixXd products_;
};

}  // namespace peclet::engine
