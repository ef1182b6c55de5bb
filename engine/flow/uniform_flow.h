// A uniform flow for the loops over particles: plain data, because it is shared with files that are compiled
// for one processor only.
#pragma once

namespace peclet::engine {

struct alignas(32) UniformFlow {
  double gradient[3][4];  // columns, as rows of a VectorField
  double spin[4];
  bool is_simple_shear;  // nothing but du_x / dy
};

}  // namespace peclet::engine
