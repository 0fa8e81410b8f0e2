#include "afm/impact_search.h"

#include <algorithm>
#include <cmath>

#include "afm/detail/double_double.h"
#include "afm/detail/multiversion.h"

namespace afm {
namespace {

constexpr double kFarEnough = 0.1;  // certified so far, a flight of too many looks is begun anew from there [tau]
constexpr double kTouch = 1e-20;    // no gap at all, where rounding hides it in twice the digits [a]

AFM_MULTIVERSION Landing<double> find_in_double(Flight<double>& flight, double horizon) {
  return find_impact(flight, horizon, 0.0, [&] { flight.bound_derivatives(); });
}

// Bounds that hold up to a time `s` only. A loose spring turns so slowly that its tip comes nowhere near its greatest
// speed in that time: stretched far, it may creep over cells that the bounds of a whole flight see it race over.
// In the flight's own digits: where springs and surface are in balance twice the digits see derivatives that double
// takes for none.
template <class T>
FlightBounds<T> bounds_until(const Flight<T>& flight, const T& s) {
  using std::abs;
  using std::max;
  using std::min;
  const Mechanics<T>& m = flight.mechanics();
  const FlightState<T>& o = flight.start().state;
  FlightBounds<T> b = flight.bounds();
  const T k = two_pi<T>(), zero(0.0), one(1.0), three(3.0);
  const T U = m.omega_h * b.X, eta = abs(flight.eta()), u0 = abs(flight.eta() + o.U);
  b.X = min(b.X, T(abs(o.X) + U * s));
  const T wh2 = m.omega_h * m.omega_h, a = wh2 * b.X, slope = k * m.H, wv2 = m.omega_v * m.omega_v;
  const T u = min(T(eta + U), T(u0 + a * s)), v = k * u;
  const T slow = max(zero, max(T(eta - U), T(u0 - a * s)));
  const T jerk = slope * (three * v * a + wh2 * U);  // but for that of the steady motion
  b.second = min(b.second, T(wv2 * b.Y + slope * (v * u + a)));
  b.third = min(b.third, T(m.omega_v * wv2 * b.Y + slope * v * v * u + jerk));
  b.fourth = flight.fourth_derivative_bound(s);
  const T change = max(abs(u * u - one), abs(slow * slow - one));
  b.drive = min(b.drive, T(slope * k * v * change + jerk));
  b.fastest = max(one, max(T(m.ratio), u));
  return b;
}

Landing<double> rounded(const Landing<DoubleDouble>& landing) {
  const auto d = [](const DoubleDouble& x) { return static_cast<double>(x); };
  const FlightState<DoubleDouble>& q = landing.jet.state;
  const GapJet<DoubleDouble>& j = landing.jet;
  const GapJet<double> jet{d(j.g), d(j.g1), d(j.g2), d(j.g3), {d(q.phase), d(q.X), d(q.U), d(q.Y), d(q.W)},
                           d(j.h), d(j.h1)};
  return {landing.outcome, d(landing.s), jet, landing.evaluations};
}

SearchOutcome without_end(const Landing<double>& landing) {
  if (!(landing.jet.g > kTouch)) return SearchOutcome::impact;
  return landing.s >= kFarEnough ? SearchOutcome::clear : SearchOutcome::cap;
}

}  // namespace

Landing<double> find_landing(const Model& model, const Flight<double>& flight, double horizon) {
  Flight<double> own = flight;
  return find_landing(model, own, horizon);
}

Landing<double> find_landing(const Model& model, Flight<double>& flight, double horizon) {
  Landing<double> landing = find_in_double(flight, horizon);
  const double seen = horizon + kFarthestRoot;
  if (landing.outcome == SearchOutcome::cap) {
    Flight<double> closer(flight, bounds_until(flight, seen));
    landing = find_in_double(closer, horizon);
  }
  if (landing.outcome == SearchOutcome::undecided) {
    const Flight<DoubleDouble> whole(Mechanics<DoubleDouble>(model), DoubleDouble(flight.eta()), flight.launch());
    const Flight<DoubleDouble> finer(whole, bounds_until(whole, DoubleDouble(seen)));
    landing = rounded(find_impact(finer, DoubleDouble(horizon), DoubleDouble(landing.s)));
  }
  if (landing.outcome == SearchOutcome::undecided || landing.outcome == SearchOutcome::cap)
    landing.outcome = without_end(landing);
  return landing;
}

}  // namespace afm
