#include "engine/state/sheared_box.h"

namespace peclet::engine {

std::int32_t ShearedBox::due_flips() const {
  return static_cast<std::int32_t>(std::floor(tilt_ / lengths_.x + 0.5));
}

Vector3 ShearedBox::widths() const {
  // The faces spanned by A2 and A3 are Lx cos(angle) apart, tan(angle) = tilt / Ly.
  const double slope = tilt_ / lengths_.y;
  return {lengths_.x / std::sqrt(1 + slope * slope), lengths_.y, lengths_.z};
}

}  // namespace peclet::engine
