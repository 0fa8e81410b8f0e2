#include "afm_emulator/impact_search.h"

#include <algorithm>
#include <cmath>

#include "afm_emulator/double_double.h"
#include "afm_emulator/multiversion.h"

namespace afm {
namespace {

AFM_MULTIVERSION Landing<double> find_in_double(const Flight<double>& flight, double horizon) {
  return find_impact(flight, horizon);
}

// Bounds that hold up to the horizon only. A loose spring turns so slowly that its tip comes nowhere near its greatest
// speed in that time: stretched far, it may creep over cells that the bounds of a whole flight see it race over.
FlightBounds<double> bounds_until(const Flight<double>& flight, double horizon) {
  const Mechanics<double>& m = flight.mechanics();
  const FlightState<double>& o = flight.start().state;
  FlightBounds<double> b = flight.bounds();
  const double k = kTwoPi, U = m.omega_h * b.X, eta = std::abs(flight.eta()), u0 = std::abs(flight.eta() + o.U);
  b.X = std::min(b.X, std::abs(o.X) + U * horizon);
  const double wh2 = m.omega_h * m.omega_h, a = wh2 * b.X, slope = k * m.H, wv2 = m.omega_v * m.omega_v;
  const double u = std::min(eta + U, u0 + a * horizon), slow = std::max({0.0, eta - U, u0 - a * horizon}), v = k * u;
  const double jerk = slope * (3.0 * v * a + wh2 * U);  // but for that of the steady motion
  b.second = std::min(b.second, wv2 * b.Y + slope * (v * u + a));
  b.third = std::min(b.third, m.omega_v * wv2 * b.Y + slope * v * v * u + jerk);
  b.fourth = flight.fourth_derivative_bound(horizon);
  const double change = std::max(std::abs(u * u - 1.0), std::abs(slow * slow - 1.0));
  b.drive = std::min(b.drive, slope * k * v * change + jerk);
  b.small_until = 0.125 / std::max({1.0, m.ratio, u});
  return b;
}

FlightBounds<DoubleDouble> widened(const FlightBounds<double>& b) {
  return {b.X, b.Y, b.second, b.third, b.fourth, b.drive, b.small_until};
}

Landing<double> rounded(const Landing<DoubleDouble>& landing) {
  const auto d = [](const DoubleDouble& x) { return static_cast<double>(x); };
  const FlightState<DoubleDouble>& q = landing.jet.state;
  const GapJet<DoubleDouble>& j = landing.jet;
  const GapJet<double> jet{d(j.g), d(j.g1), d(j.g2), d(j.g3), {d(q.phase), d(q.X), d(q.U), d(q.Y), d(q.W)},
                           d(j.h), d(j.h1)};
  return {landing.outcome, d(landing.s), jet, landing.evaluations};
}

}  // namespace

Landing<double> find_landing(const Model& model, const Flight<double>& flight, double horizon) {
  Landing<double> landing = find_in_double(flight, horizon);
  if (landing.outcome == SearchOutcome::cap) {
    landing = find_in_double(Flight<double>(flight, bounds_until(flight, horizon)), horizon);
  }
  if (landing.outcome == SearchOutcome::undecided) {
    const Flight<DoubleDouble> whole(Mechanics<DoubleDouble>(model), DoubleDouble(flight.eta()), flight.launch());
    const Flight<DoubleDouble> finer(whole, widened(bounds_until(flight, horizon)));
    landing = rounded(find_impact(finer, DoubleDouble(horizon), DoubleDouble(landing.s)));
    if (landing.outcome == SearchOutcome::undecided) landing.outcome = SearchOutcome::impact;
  }
  return landing;
}

}  // namespace afm
