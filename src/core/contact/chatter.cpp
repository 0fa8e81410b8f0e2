#include "afm/detail/chatter.h"

#include <algorithm>
#include <cmath>

#include "chatter_law.h"
#include "projection.h"

namespace afm::detail {
namespace {

// M of a constant loss: -w/ln(1 - w).
double w_over_log(double w) {
  constexpr double kAlmostElastic = 1e-8;  // below it the quotient is 1 to the last digit but one
  if (w < kAlmostElastic) return 1.0;
  return w < 1.0 ? -w / portable_log(1.0 - w) : 0.0;
}

// Does the reaction along the slide from `at` stay above `least` until its impulse is J? By its two derivatives where
// they are sure, or say no; else on the slide.
bool stays_above(double least, double J, const SpringConstants<double>& springs, double eta,
                 const SlideState<double>& at, const ReferenceForces<double>& f) {
  constexpr double kSureChange = 0.3, kSureFall = kSureChange + 0.5 * kSureChange * kSureChange;
  const double low = (1.0 - kSureFall) * f.P;
  if (low > least && J / low * change_rates(springs, at.u, f).change < kSureChange) return true;
  const double t = J / f.P, turns = -f.P1 / f.P2;  // the parabola turns there
  const double at_turn = turns > 0.0 && turns < t ? f.P + 0.5 * f.P1 * turns : f.P;
  if (!(std::min(at_turn, f.P + t * (f.P1 + 0.5 * t * f.P2)) > least)) return false;
  constexpr double kTolerance = 1e-5;  // [a] a choice: a hundredth of the default contact tolerance
  constexpr int kMaxSteps = 2;         // a choice: a longer sequence is made
  // its reaction is along y, and never above P: that is on the safe side
  ContactStep step(springs, eta, at, kTolerance, {}, ContactStep::Purpose::look_ahead);
  for (int i = 1; step.is_accurate(); ++i) {
    const double below = step.first_below(least);
    J -= step.impulse(below < 0.0 ? step.length() : below);
    if (J <= 0.0) return true;
    if (below >= 0.0 || i == kMaxSteps) return false;
    step = ContactStep(springs, eta, step.at(step.length()), kTolerance, step.hint(), ContactStep::Purpose::look_ahead);
  }
  return false;
}

}  // namespace

double chatter_threshold(double contact_tolerance) {
  // the flight to the next impact enlarges an error; with this the one there stays below the tolerance
  // (docs/stability.md)
  constexpr double kErrorGrowth = 100.0;
  return contact_tolerance / kErrorGrowth;
}

// Chosen with the limits of the ratio and the loss (docs/stability.md). Square roots give the same bits on every
// machine.
double chatter_entry_speed(double contact_tolerance) {
  return 2.0 * std::sqrt(contact_tolerance * std::sqrt(std::sqrt(contact_tolerance)));
}

ChatterLaw::ChatterLaw(const Model& model, double contact_tolerance)
    : constants_{}, loss_(1.0 - model.gamma), cutoff_(model.v_c) {
  constexpr double kLeastThreshold = 1e-300;  // a logarithm follows
  const double threshold = chatter_threshold(contact_tolerance);
  ChatterConstants& c = constants_;
  c.max_entry_speed = chatter_entry_speed(contact_tolerance);
  c.threshold = std::max(threshold, kLeastThreshold);
  c.constant_loss = !(model.v_c > threshold);
  // the error of v at a given bounce is of the third order in what the limits are for; that of the time is of the
  // second, and the entry speed falls faster
  const double part = c.threshold / ChatterLimits::kDefaultThreshold;
  c.fineness = part < 1.0 ? portable_exp(portable_log(part) * (1.0 / 3)) : 1.0;
  const double end_speed = ChatterLimits::kEndSpeed * c.threshold;
  if (c.constant_loss) {
    c.w = loss_;
    c.M = w_over_log(loss_);
    c.end_x = end_speed;
  } else {
    const double max_loss = ChatterLimits::kMaxLoss * c.fineness;
    c.max_entry_speed = std::min(c.max_entry_speed, model.v_c * (loss_ > max_loss ? max_loss / loss_ : 1.0));
    c.dw_dv = loss_ / model.v_c;
    c.end_x = portable_log(end_speed);
  }
}

double turn_of(const Flight<double>& bounce) {
  const GapJet<double>& start = bounce.start();
  return 2.0 * start.g1 * std::max(bounce.springs().ratio, std::abs(bounce.launch().u)) / -start.g2;
}

bool ChatterLaw::holds(const Flight<double>& bounce) const {
  const TipState& launch = bounce.launch();
  const GapJet<double>& start = bounce.start();
  const double v = start.g1;
  if (!(start.g2 < 0.0)) return false;
  if (v <= constants_.threshold) return true;
  if (v > constants_.max_entry_speed) return false;
  const SpringConstants<double>& m = bounce.springs();
  const double limit = ChatterLimits::kMaxRatioAtEntry * constants_.fineness;
  if (turn_of(bounce) > limit) return false;  // most bounces are refused by this faster test
  const auto p = projected<double>(m.is_free_along_x, m.H, {launch.phase, launch.X, launch.u, start.g1});
  const ReferenceForces<double> f = reference_forces(m, bounce.eta(), p.reference);
  return f.P > 0.0 && 2.0 * p.normal_speed * change_rates(m, p.reference.u, f).fastest <= limit * f.P;
}

ChatterRun ChatterLaw::run(const SlideSegment<double>& reference, double until, const Chatter& start) const {
  return ChatterIntegration<double>(constants_, reference).follow(until, start, true);
}

Chatter ChatterLaw::at(const SlideSegment<double>& reference, double s, const Chatter& start) const {
  return ChatterIntegration<double>(constants_, reference).follow(s, start, false).chatter;
}

ChatterRun ChatterLaw::last_bounce(const SlideSegment<double>& reference, double s, const Chatter& start) const {
  const ChatterIntegration<double> law(constants_, reference);
  const ChatterPoint<double> now = law.begin(s, law.follow(s, start, false).chatter);
  return law.exit_at(now, std::floor(now.y.n));
}

// The averaged law at its lowest order (docs/algorithm.md, "Collapse").
std::optional<Chatter> ChatterLaw::collapsed(const SpringConstants<double>& springs, double eta,
                                             const SlideState<double>& at, double v, double allowed,
                                             double time) const {
  constexpr double kLnTen = 2.302585092994046;
  if (v <= constants_.threshold || loss_ == 0.0) return std::nullopt;
  // down to the cutoff each bounce loses the same part of v; below it v falls like exp(-k J/2)
  const double end = constants_.constant_loss ? constants_.threshold : std::min(v, cutoff_);
  const double gamma = 1.0 - loss_;
  double J10 = 2.0 * (v - end) / loss_;
  double cubes = 2.0 * (v * v * v - end * end * end) / (1.0 - gamma * gamma * gamma);
  if (!constants_.constant_loss) {
    J10 += 2.0 * kLnTen / constants_.dw_dv;
    cubes += end * end / constants_.dw_dv;
  }
  const ReferenceForces<double> f = reference_forces(springs, eta, at);
  // a spring that is displaced by sigma gains the speed omega_h sigma
  const double per_height = std::max(std::abs(f.c_height), 2.0 * std::abs(f.turn) * std::max(springs.omega_h, 1.0));
  const double least = std::sqrt(per_height * cubes / (3.0 * allowed));  // reaction: the displacement goes like 1/P^2
  if (!(f.P > least) || J10 > time * f.P || !stays_above(least, J10, springs, eta, at, f)) return std::nullopt;
  double n = gamma > 0.0 ? portable_log(v / end) / -portable_log(gamma) : 1.0;
  if (!constants_.constant_loss) {
    constexpr double kLongDecay = 600.0;  // v is below every threshold then, and portable_exp ends at 700
    const double rest = std::min(0.5 * constants_.dw_dv * (time * f.P - J10), kLongDecay);
    const double last = std::max(constants_.threshold, 0.1 * end * portable_exp(-rest));
    n += (1.0 / last - 1.0 / end) / constants_.dw_dv;
  }
  const double height = cubes / (3.0 * f.P * f.P);  // its time integral
  return Chatter{0.0, std::max(n, 1.0), 2.0 * f.turn * height, f.c_height * height};
}

Projection project_onto_surface(const Model& model, const TipState& state) {
  return projected<double>(is_free_along_x(model), model.H, {state.phase, state.X, state.u, state.g1});
}

TipState leave_surface(const Model& model, const SlideState<double>& reference, double normal_speed) {
  const BounceState<double> b = launched<double>(is_free_along_x(model), model.H, reference, normal_speed);
  return {wrap_phase(b.phase), b.X, b.u, 0.0, b.g1};
}

SlideState<double> displaced_reference(const Model& model, const SlideState<double>& reference,
                                       const Chatter& chatter) {
  return displaced_reference_of(model.H, reference, chatter);
}

}  // namespace afm::detail
