#include "engine/stability/spectral_bound.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/random/keyed_random.h"

namespace peclet::engine {
namespace {

// Far more than any packing has needed.
constexpr int most_iterations = 200;
constexpr int iterations_between_looks = 4;

double inner_product(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

std::vector<double> start_vector(std::size_t rows) {
  const KeyedRandom random(/*seed=*/0, Purpose::initial_velocity);  // any numbers will do
  std::vector<double> vector;
  vector.reserve(rows);
  for (std::uint32_t i = 0; vector.size() < rows; ++i) {
    const NormalPair normals = random.normals(0, i);
    for (const Vector3& part : {normals.first, normals.second}) {
      vector.insert(vector.end(), {part.x, part.y, part.z});
    }
  }
  return vector;
}

// The symmetric tridiagonal matrix that the iterations build.
struct Tridiagonal {
  std::vector<double> diagonal, beside;  // beside[k] couples k and k + 1; the last one leads out

  // Whether an eigenvalue lies above x: signs of the pivots of T - x.
  bool reaches_beyond(double x) const {
    double pivot = diagonal[0] - x;
    for (std::size_t k = 1; k < diagonal.size() && pivot < 0; ++k) {
      pivot = diagonal[k] - x - beside[k - 1] * beside[k - 1] / pivot;
    }
    return !(pivot < 0);
  }

  double largest_eigenvalue() const {
    double low = *std::max_element(diagonal.begin(), diagonal.end());
    double high = low + 2 * *std::max_element(beside.begin(), beside.end());
    while (true) {
      const double middle = 0.5 * (low + high);
      if (!(low < middle && middle < high)) {
        return high;
      }
      (reaches_beyond(middle) ? low : high) = middle;
    }
  }

  // Of the unit eigenvector for the largest eigenvalue: |last component|, from the ratios of neighbours.
  double last_component(double eigenvalue) const {
    double component = 1, squared = 1, pivot = diagonal[0] - eigenvalue;
    for (std::size_t k = 1; k < diagonal.size(); ++k) {
      component *= -pivot / beside[k - 1];
      squared += component * component;
      pivot = diagonal[k] - eigenvalue - beside[k - 1] * beside[k - 1] / pivot;
    }
    return std::abs(component) / std::sqrt(squared);
  }
};

}  // namespace

SpectralBound largest_eigenvalue(const PackingMatrix& matrix, double tolerance) {
  const std::size_t rows = matrix.rows();
  std::vector<double> vector = start_vector(rows), before(rows), product(rows);
  double length = std::sqrt(inner_product(vector, vector));
  Tridiagonal tridiagonal;
  SpectralBound bound;
  while (bound.iterations < most_iterations) {
    for (double& entry : vector) {
      entry /= length;
    }
    matrix.multiply(vector, product);
    const double diagonal = inner_product(vector, product);
    const double back = tridiagonal.beside.empty() ? 0 : tridiagonal.beside.back();
    for (std::size_t row = 0; row < rows; ++row) {
      product[row] -= diagonal * vector[row] + back * before[row];
    }
    length = std::sqrt(inner_product(product, product));
    tridiagonal.diagonal.push_back(diagonal);
    tridiagonal.beside.push_back(length);
    ++bound.iterations;
    // The vectors span everything that the start vector reaches: nothing is left but rounding.
    const bool exhausted = !(length > 1e-12 * diagonal);
    if (exhausted || bound.iterations % iterations_between_looks == 0) {
      bound.value = tridiagonal.largest_eigenvalue();
      bound.residual = exhausted ? 0 : length * tridiagonal.last_component(bound.value);
      if (bound.residual <= tolerance * bound.value) {
        break;
      }
    }
    before.swap(vector);
    vector.swap(product);
  }
  return bound;
}

}  // namespace peclet::engine
