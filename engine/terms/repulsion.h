// RepulsionOfPair is the repulsion of two surfaces.
#pragma once

#include "engine/terms/pair.h"

namespace peclet::engine {

struct RepulsionParameters {
  enum class Form { exponential, screened };

  double strength = 0, relative_length = 0.01;  // exponential: A [energy] and kappa / (a_i + a_j)
  double cutoff_lengths = 20;
  Form form = Form::exponential;
  double force = 0, debye_length = 0, reference_radius = 0;  // screened: F_ER, lambda, a_0
};

// The law of two radii, as a function of the surface distance h, up to cutoff_lengths kappa or lambda:
//   exponential  F_i = V' n = -(A / kappa) exp(-h / kappa) n,  kappa = relative_length (a_i + a_j)
//                V = A exp(-h / kappa)
//   screened     F_i = V' n = -F exp(-max(h, 0) / lambda) n,  F = F_ER a / a_0,  a = 2 a_i a_j / (a_i + a_j)
//                V = F lambda exp(-h / lambda), in overlap F (lambda - h)
// Li, Royer & Ness (2023) eq. 34 prints the exponential force on j; it keeps growing in overlap. The screened
// form is eq. 6 of Monti et al. (2021).
struct RepulsionOfPair {
  double range = 0;  // centre distance where it ends
  double energy_at_contact = 0, slope_at_contact = 0, stiffness_at_contact = 0;
  double decay = 0;  // 1 / kappa or 1 / lambda
  RepulsionParameters::Form form = RepulsionParameters::Form::exponential;

  double energy(double h) const {
    const double inside = h - where_it_decays(h);
    return energy_at_contact * exponential(-decay * where_it_decays(h)) + slope_at_contact * inside;
  }
  // V'
  template <class Real>
  PECLET_ALWAYS_INLINE Real slope(const Real& h) const {
    return slope_at_contact * exponential(-decay * where_it_decays(h));
  }
  // V''
  template <class Real>
  PECLET_ALWAYS_INLINE Real stiffness(const Real& h) const {
    const Real curved = stiffness_at_contact * exponential(-decay * h);
    return form == RepulsionParameters::Form::screened ? select(h < 0.0, Real{0.0}, curved) : curved;
  }
  // Returns the largest |V''| at surface distances from h >= 0 on.
  double largest_stiffness(double h) const { return stiffness(h); }

 private:
  template <class Real>
  PECLET_ALWAYS_INLINE Real where_it_decays(const Real& h) const {
    return form == RepulsionParameters::Form::screened ? larger(h, Real{0.0}) : h;
  }
};

inline RepulsionOfPair of_pair(const RepulsionParameters& repulsion, double radius_first,
                               double radius_second) {
  const double sum = radius_first + radius_second;
  RepulsionOfPair of_radii;
  double length = repulsion.relative_length * sum;
  if (repulsion.form == RepulsionParameters::Form::screened) {
    length = repulsion.debye_length;
    const double mean = 2 * radius_first * radius_second / sum;
    const double force = repulsion.force * mean / repulsion.reference_radius;
    of_radii.energy_at_contact = force * length;
    of_radii.slope_at_contact = -force;
    of_radii.stiffness_at_contact = force / length;
  } else {
    of_radii.energy_at_contact = repulsion.strength;
    of_radii.slope_at_contact = -(repulsion.strength / length);
    of_radii.stiffness_at_contact = repulsion.strength / (length * length);
  }
  of_radii.range = sum + repulsion.cutoff_lengths * length;
  of_radii.decay = 1 / length;
  of_radii.form = repulsion.form;
  return of_radii;
}

}  // namespace peclet::engine
