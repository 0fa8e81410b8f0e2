// One step of a tip in frictionless contact, by Gauss collocation (docs/algorithm.md, "Contact"). On the surface the
// tip has one degree of freedom, and nothing in its motion is fast but a nearly harmonic swing. A step is up to one
// turn of that swing. The Taylor series of slide_segment.h is the same motion to the last digits, for chatter and
// derivatives.
#pragma once

#include <cstddef>

#include "afm/spring_constants.h"
#include "slide_series.h"

namespace afm::detail {

constexpr std::size_t kGaussNodes = 8;  // two vector registers of four numbers
using AtGaussNodes = double[kGaussNodes];

// At a state on the surface: h, 1 + h'^2, x'' [a/tau^2], the reaction along y [a/tau^2], and -dx''/dx [1/tau^2].
struct ContactForces {
  double h, N2, force, reaction, stiffness;
};

// Where a step has come to.
struct ContactPoint {
  SlideState<double> state;
  double extension_integral;  // of x - xc since its start [a tau]
};

constexpr double kFinestStep = 2e-15;  // the smallest tolerance of a step [a]: rounding allows no finer one

class ContactStep {
 public:
  // Where the search for the length of a step begins. It changes the steps, but no error beyond the tolerance.
  struct Hint {
    int level = 2;           // number of the length, the longest is 0
    double stiffness = 0.0;  // of the swing [1/tau^2]; 0: that at the start
  };

  // Where the tip may leave within the error, a step that moves it is made to the last digits. A step that only looks
  // ahead is not.
  enum class Purpose { motion, look_ahead };

  // tolerance: error allowed at the end of the step in x [a], and in u over the rate of the swing. Precondition:
  // `start` is on the surface.
  ContactStep(const SpringConstants<double>& springs, double eta, const SlideState<double>& start, double tolerance,
              const Hint& hint, Purpose purpose = Purpose::motion);

  // Guarantee: the energy balances to rounding at every s in [0, length()].
  ContactPoint point(double s) const;
  SlideState<double> at(double s) const { return point(s).state; }
  double pressure(const SlideState<double>& q) const;  // the reaction along y [a/tau^2]
  Series<double> displacement() const;                 // x - x(start) in powers of the time

  // The first time in [0, length()] at which the reaction has fallen to -release_noise(), within a thousandth of that
  // or the last digit of the time. Negative if it does not fall so far.
  double find_release() const;

  // The first time in [0, length()] at which Bernstein's coefficients of the reaction, on 16ths of the step, fall below
  // `reaction`: within a 16th of the fall. Negative: it does not fall. A reaction that comes near may count as a fall.
  double first_below(double reaction) const;
  double impulse(double s) const;  // of the reaction over the first s [a/tau]

  double length() const { return length_; }          // [tau]
  bool is_accurate() const { return is_accurate_; }  // false: no length meets the tolerance, as of a corrupted state
  Hint hint() const { return hint_; }                // for the next step
  const SlideState<double>& start() const { return start_; }
  const SpringConstants<double>& springs() const { return m_; }
  double eta() const { return eta_; }

 private:
  int try_levels(double tolerance, const Hint& hint);  // returns the level of the step
  bool attempt(int level, double stiffness, double tolerance);
  bool is_close_call() const;
  ContactPoint end() const;
  ContactPoint balanced(double time, double d, double u, double integral) const;

  SpringConstants<double> m_;
  double eta_ = 0.0, tolerance_ = 0.0;
  SlideState<double> start_{};
  ContactForces first_{};  // at the start
  double length_ = 0.0;
  AtGaussNodes force_{}, reaction_{};
  double mean_displacement_ = 0.0;  // of x - x(start) over the step [a]
  double stiffness_ = 0.0;          // of the swing
  Hint hint_;
  bool is_accurate_ = false;
};

}  // namespace afm::detail
