#include "afm_emulator/contact_jacobian.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "afm_emulator/dual.h"
#include "afm_emulator/surface.h"

namespace afm {
namespace {

template <class T>
struct Ride {
  T acceleration;  // along x
  T reaction;      // normal to the surface
};

// (1 + h'^2) x'' = -omega_h^2 X - h' q, as in slide_series.h; the hammer's x'' is 0 and its normal the vertical.
template <class T>
Ride<T> ride(const Mechanics<T>& m, const SlideState<T>& s) {
  using std::sqrt;
  const SurfaceJet<T> surface = surface_jet(m.H, s.phase);
  const T q = m.omega_v * m.omega_v * (surface.h - m.y0) + surface.h2 * s.u * s.u;
  if (static_cast<double>(m.mobility) == 0.0) return {T(0.0), q};
  const T N2 = T(1.0) + surface.h1 * surface.h1, spring = m.omega_h * m.omega_h * s.X;
  return {-(spring + surface.h1 * q) / N2, (q - surface.h1 * spring) / sqrt(N2)};
}

// The slide with its chatter: z = P^(1/3) / v grows evenly (v^3/P is kept by a bounce that loses nothing), n counts
// bounces.
using Riding = std::array<Dual4, 5>;  // x, X, u, z, n

struct LossLaw {
  LossLaw(const Model& model, double v)
      : geometric(!(v < model.v_c)),
        loss(geometric ? 1.0 - model.gamma : (1.0 - model.gamma) / model.v_c),
        logarithm(-std::log(std::max(model.gamma, 1e-9))) {}

  bool geometric;
  double loss, logarithm;

  // -dv/dn and, over 2 v/P, dt/dn of the flow through the bounces v -> v (1 - w): w = loss v, or loss alone.
  Dual4 fall(const Dual4& v) const {
    if (geometric) return Dual4(logarithm) * v;
    const Dual4 w = Dual4(loss) * v;
    return v * w * (Dual4(1.0) + w * (Dual4(1.0) + Dual4(1.5) * w));
  }
  Dual4 time(const Dual4& v) const { return geometric ? Dual4(loss / logarithm) : Dual4(1.0) + Dual4(0.5 * loss) * v; }
};

Riding rate(const Mechanics<Dual4>& m, double eta, const LossLaw& law, const Riding& r) {
  const Ride<Dual4> at = ride(m, SlideState<Dual4>{r[0], r[1], r[2]});
  const Dual4 root = cbrt(at.reaction), v = root / r[3];
  const Dual4 bounces = at.reaction / (Dual4(2.0) * v * law.time(v));
  return {r[2], r[2] - Dual4(eta), at.acceleration, r[3] / v * bounces * law.fall(v), bounces};
}

Riding moved(const Riding& a, double k, const Riding& b) {
  Riding sum;
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = a[i] + Dual4(k) * b[i];
  return sum;
}

Riding runge_kutta(const Mechanics<Dual4>& m, double eta, const LossLaw& law, const Riding& r, double dt) {
  const Riding k1 = rate(m, eta, law, r), k2 = rate(m, eta, law, moved(r, dt / 2.0, k1));
  const Riding k3 = rate(m, eta, law, moved(r, dt / 2.0, k2)), k4 = rate(m, eta, law, moved(r, dt, k3));
  return moved(moved(moved(moved(r, dt / 6.0, k1), dt / 3.0, k2), dt / 3.0, k3), dt / 6.0, k4);
}

// dv/dt, given the rates of the riding.
double speed_rate(const Mechanics<Dual4>& m, const Riding& at, const Riding& rates) {
  std::array<Dual4, 4> along;  // the one derivative is by time
  for (std::size_t i = 0; i < along.size(); ++i) along[i] = chain(at[i].value, rates[i].value, Dual4::variable(0.0, 0));
  const Ride<Dual4> here = ride(m, SlideState<Dual4>{along[0], along[1], along[2]});
  return (cbrt(here.reaction) / along[3]).by[0];
}

}  // namespace

SlideJacobian slide_jacobian(const Model& model, double eta, const SlideState<double>& start, double s) {
  const Mechanics<Dual3> mechanics(model);
  SlideState<Dual3> q{Dual3::variable(start.phase, 0), Dual3::variable(start.X, 1), Dual3::variable(start.u, 2)};
  constexpr int kMostPieces = 100000;
  double left = s;
  for (int i = 0; i < kMostPieces && left > 0.0; ++i) {
    const SlidePiece<Dual3> piece(mechanics, Dual3(eta), q);
    const double step = std::min(left, piece.length().value);
    q = piece.at(Dual3(step));
    left -= step;
  }
  SlideJacobian J;
  for (std::size_t i = 0; i < 3; ++i) {
    J.row(static_cast<Eigen::Index>(i)) << q.phase.by[i], q.X.by[i], q.u.by[i];
  }
  return held(mobility(model), SlideJacobian(J.transpose()));
}

Eigen::Vector3d slide_velocity(const Model& model, double eta, const SlideState<double>& q) {
  return {q.u, q.u - eta, ride(Mechanics<double>(model), q).acceleration};
}

Eigen::Matrix4d settle_jacobian(const Model& model, const TipState& s) {
  const SurfaceJet<double> surface = surface_jet(model.H, s.phase);
  const double N2 = 1.0 + surface.h1 * surface.h1, N = std::sqrt(N2);
  Eigen::Matrix4d J = Eigen::Matrix4d::Identity();
  if (model.kind == ModelKind::hammer) return J;
  J(2, 0) = s.g1 * surface.h2 * (2.0 - N2) / (N2 * N2);
  J(2, 3) = surface.h1 / N2;
  J(3, 0) = -s.g1 * surface.h1 * surface.h2 / (N2 * N);
  J(3, 3) = 1.0 / N;
  return J;
}

SectionJacobian<double> burst_jacobian(const Model& model, double eta, const TipState& start, double duration,
                                       const TipState& end) {
  constexpr int kSteps = 32;
  const Mechanics<Dual4> mechanics(model);
  const Settled settled = settle(model, start);
  const SlideState<Dual4> guide{Dual4::variable(settled.guide.phase, 0), Dual4::variable(settled.guide.X, 1),
                                Dual4::variable(settled.guide.u, 2)};
  const Dual4 v = Dual4::variable(settled.normal_speed, 3);
  const LossLaw law(model, settled.normal_speed);
  Riding r{guide.phase, guide.X, guide.u, cbrt(ride(mechanics, guide).reaction) / v, Dual4(0.0)};
  for (int i = 0; i < kSteps; ++i) r = runge_kutta(mechanics, eta, law, r, duration / kSteps);
  // the last bounce is the same one for every start: at its number, not at one time
  const Riding now = rate(mechanics, eta, law, r);
  const double v_rate = speed_rate(mechanics, r, now);
  r[3] = cbrt(ride(mechanics, SlideState<Dual4>{r[0], r[1], r[2]}).reaction) / r[3];
  Eigen::Matrix4d J;
  for (std::size_t j = 0; j < 4; ++j) {
    const double late = -r[4].by[j] / now[4].value;
    J.col(static_cast<Eigen::Index>(j)) << r[0].by[j] + late * now[0].value, r[1].by[j] + late * now[1].value,
        r[2].by[j] + late * now[2].value, r[3].by[j] + late * v_rate;
  }
  const SectionJacobian<double> around = settle_jacobian(model, end).inverse() * J * settle_jacobian(model, start);
  return held(mobility(model), around);
}

}  // namespace afm
