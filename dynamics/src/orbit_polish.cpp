#include "orbit_polish.h"

#include <cmath>

#include "afm/detail/flight_jets.h"
#include "afm/dynamics/jacobian.h"

namespace afm {

using namespace detail;

namespace {

using Fine = DoubleDouble;

// The state in flight after an impact, with the digits of double-double.
FlightState<Fine> launched(const SpringConstants<Fine>& m, const Fine& eta, const FinePoint& p) {
  const SurfaceJet<Fine> surface = surface_jet(m.H, p.phase);
  return {p.phase, p.X, p.u - eta, surface.h - m.y0, p.g1 + surface.h1 * p.u};
}

Eigen::Vector4d difference(const FinePoint& b, const FinePoint& a) {
  const Fine phase = b.phase - a.phase;
  return {static_cast<double>(phase - Fine(nearest(phase.high()))), static_cast<double>(b.X - a.X),
          static_cast<double>(b.u - a.u), static_cast<double>(b.g1 - a.g1)};
}

// From an impact to the next, near the time `estimate` [tau].
FineStep fine_map(const Model& model, double eta, const FinePoint& point, double estimate) {
  constexpr int kNewtonSteps = 4;  // each doubles the digits: two give all 31, near a graze more are needed
  FinePoint start = point;
  if (model.kind == ModelKind::hammer) start.X = Fine(0.0), start.u = eta;
  const SpringConstants<Fine> m(model);
  const Fine drag(eta);
  const FlightState<Fine> launch = launched(m, drag, start);
  const auto gap = [&](const Fine& time) { return jet_at(m, drag, state_after(m, drag, launch, time)); };
  Fine s(estimate);
  for (int i = 0; i < kNewtonSteps; ++i) {
    const GapJet<Fine> jet = gap(s);
    s = s - jet.g / jet.g1;
  }
  const GapJet<Fine> in = gap(s);
  const Fine speed = Incidence<Fine>(m, drag, in.state, in.g1).normal_speed;
  const Fine one(1.0), e = restitution_jet(model, speed).restitution;
  const Fine kick = m.is_free_along_x * (one + e) * in.h1 * in.g1 / (one + in.h1 * in.h1);
  const FinePoint after{in.state.phase, in.state.X, drag + in.state.U + kick, -(e * in.g1)};
  return {after, s, Fine(0.5) * (one - e) * (one + e) * speed * speed};
}

}  // namespace

FineOrbit polish(const PoincareMap& map, const std::vector<TipState>& points, const std::vector<double>& times,
                 const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& solve) {
  const std::size_t n = points.size();
  FineOrbit orbit;
  for (const TipState& p : points) orbit.points.push_back({p.phase, p.X, p.u, p.g1});
  constexpr int kPolishSteps = 3;  // Newton steps with a fixed matrix: each leaves an error of 1e-10 of the one before
  for (int round = 0; round <= kPolishSteps; ++round) {
    Eigen::VectorXd error(static_cast<Eigen::Index>(4 * n));
    orbit.steps.clear();
    for (std::size_t i = 0; i < n; ++i) {
      orbit.steps.push_back(fine_map(map.model(), map.eta(), orbit.points[i], times[i]));
      error.segment<4>(static_cast<Eigen::Index>(4 * i)) =
          difference(orbit.steps.back().after, orbit.points[(i + 1) % n]);
    }
    if (round == kPolishSteps) break;
    const Eigen::VectorXd step = solve(error);
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Vector4d d = step.segment<4>(static_cast<Eigen::Index>(4 * i));
      FinePoint& p = orbit.points[i];
      p = {p.phase + Fine(d[0]), p.X + Fine(d[1]), p.u + Fine(d[2]), p.g1 + Fine(d[3])};
    }
  }
  return orbit;
}

}  // namespace afm
