// A number that is not known yet.
#pragma once

namespace peclet::runner {

// What is expected, with the range that holds it 95 % of the time.
template <typename Number>
struct Expected {
  Number likely{}, lower{}, upper{};
};

}  // namespace peclet::runner
