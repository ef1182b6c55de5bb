#include "engine/flow/deformation.h"

#include <cmath>
#include <numbers>

#include "engine/flow/shear.h"

namespace peclet::engine {
namespace {

// Returns a:b.
double contracted(const SymmetricTensor& a, const SymmetricTensor& b) {
  return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz + 2 * (a.xy * b.xy + a.xz * b.xz + a.yz * b.yz);
}

}  // namespace

ImposedFlow::ImposedFlow() : ImposedFlow(std::make_shared<SteadyShear>(0)) {}

void ImposedFlow::measure_from(double time) {
  steady_gradient_ = deformation_->steady_gradient(time);
  const SymmetricTensor strain = strain_of(steady_gradient_);
  steady_rate_ = std::sqrt(2 * contracted(strain, strain));
  const auto over = [&](double component) { return component / steady_rate_; };
  direction_ = {over(strain.xx), over(strain.yy), over(strain.zz),
                over(strain.xy), over(strain.xz), over(strain.yz)};
  if (steady_rate_ == 0) direction_ = {.xy = 0.5};
}

double ImposedFlow::shear_part(const SymmetricTensor& stress) const { return contracted(stress, direction_); }

std::optional<double> ImposedFlow::period() const {
  const std::optional<Swing> swing = deformation_->swing();
  return swing ? std::optional(2 * std::numbers::pi / swing->frequency) : std::nullopt;
}

}  // namespace peclet::engine
