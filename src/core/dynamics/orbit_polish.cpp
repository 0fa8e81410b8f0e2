#include "orbit_polish.h"

#include <cmath>

#include "afm/flight.h"
#include "afm/surface.h"

namespace afm {
namespace {

using Fine = DoubleDouble;

struct Incident {
  Fine phase, X, u, g, g1;
  SurfaceJet<Fine> surface;
};

Incident fly(const Mechanics<Fine>& m, const Fine& eta, const FinePoint& p, const Fine& s) {
  const SurfaceJet<Fine> start = surface_jet(m.H, p.phase);
  const Fine Y = start.h - m.y0, W = p.g1 + start.h1 * p.u, U = p.u - eta;
  const SinCos<Fine> h = sin_cos_turns(turn_product(m.ratio, s)), v = sin_cos_turns(s);
  Incident at;
  at.X = p.X * h.cos + U * h.sin * m.inverse_omega_h;
  at.u = eta + U * h.cos - m.omega_h * p.X * h.sin;
  at.phase = p.phase + (at.X - p.X) + eta * s;
  at.surface = surface_jet(m.H, at.phase);
  at.g = Y * v.cos + W * v.sin * m.inverse_omega_v + m.y0 - at.surface.h;
  at.g1 = W * v.cos - m.omega_v * Y * v.sin - at.surface.h1 * at.u;
  return at;
}

double nearest_turn(const Fine& x) { return std::round(static_cast<double>(x)); }

Eigen::Vector4d difference(const FinePoint& b, const FinePoint& a) {
  const Fine phase = b.phase - a.phase;
  return {static_cast<double>(phase - Fine(nearest_turn(phase))), static_cast<double>(b.X - a.X),
          static_cast<double>(b.u - a.u), static_cast<double>(b.g1 - a.g1)};
}

}  // namespace

FineStep fine_map(const Model& model, double eta, const FinePoint& point, double guess) {
  FinePoint start = point;
  if (model.kind == ModelKind::hammer) start.X = Fine(0.0), start.u = eta;
  const Mechanics<Fine> m(model);
  constexpr int kSteps = 4;  // of Newton's method, from a time good to rounding
  Fine s(guess);
  for (int i = 0; i < kSteps; ++i) {
    const Incident at = fly(m, eta, start, s);
    s = s - at.g / at.g1;
  }
  const Incident in = fly(m, eta, start, s);
  const bool free = model.kind == ModelKind::oscillator;
  const Fine one(1.0), gamma(model.gamma), N2 = free ? one + in.surface.h1 * in.surface.h1 : one;
  const Fine speed = -in.g1 / sqrt(N2);
  const bool slow = speed < Fine(model.v_c);
  const Fine e = slow ? one - (one - gamma) * speed / Fine(model.v_c) : gamma;
  const Fine u = free ? in.u + (one + e) * in.surface.h1 * in.g1 / N2 : eta;
  return {{in.phase, in.X, u, -(e * in.g1)}, s, Fine(0.5) * (one - e) * (one + e) * speed * speed};
}

FineOrbit polish(const PoincareMap& map, const std::vector<TipState>& points, const std::vector<double>& times,
                 const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& solve) {
  const std::size_t n = points.size();
  FineOrbit orbit;
  for (const TipState& p : points) orbit.points.push_back({p.phase, p.X, p.u, p.g1});
  constexpr int kRounds = 3;  // the solution is good to 1e-10 of each step
  for (int round = 0; round <= kRounds; ++round) {
    Eigen::VectorXd error(static_cast<Eigen::Index>(4 * n));
    orbit.steps.clear();
    for (std::size_t i = 0; i < n; ++i) {
      orbit.steps.push_back(fine_map(map.model(), map.eta(), orbit.points[i], times[i]));
      error.segment<4>(static_cast<Eigen::Index>(4 * i)) =
          difference(orbit.steps.back().after, orbit.points[(i + 1) % n]);
    }
    if (round == kRounds) break;
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
