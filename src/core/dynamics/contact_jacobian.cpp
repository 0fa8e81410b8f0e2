#include "afm/dynamics/contact_jacobian.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "afm/detail/dual.h"
#include "afm/surface.h"

namespace afm {
namespace {

template <class T>
struct Ride {
  T acceleration;  // along x
  T reaction;      // normal to the surface
};

// (1 + h'^2) x'' = -omega_h^2 X - h' q, as in slide_series.h; the hammer's x'' is 0 and its normal the vertical.
template <class T>
Ride<T> sequence_state(const Mechanics<T>& m, const SlideState<T>& s) {
  using std::sqrt;
  const SurfaceJet<T> surface = surface_jet(m.H, s.phase);
  const T q = m.omega_v * m.omega_v * (surface.h - m.y0) + surface.h2 * s.u * s.u;
  if (static_cast<double>(m.is_free_along_x) == 0.0) return {T(0.0), q};
  const T N2 = T(1.0) + surface.h1 * surface.h1, spring = m.omega_h * m.omega_h * s.X;
  return {-(spring + surface.h1 * q) / N2, (q - surface.h1 * spring) / sqrt(N2)};
}

}  // namespace

SlideJacobian slide_jacobian(const Model& model, double eta, const SlideState<double>& start, double s) {
  const Mechanics<Dual3> mechanics(model);
  SlideState<Dual3> q{Dual3::variable(start.phase, 0), Dual3::variable(start.X, 1), Dual3::variable(start.u, 2)};
  constexpr int kMaxSegments = 100000;
  double left = s;
  for (int i = 0; i < kMaxSegments && left > 0.0; ++i) {
    const SlideSegment<Dual3> piece(mechanics, Dual3(eta), q);
    const double step = std::min(left, piece.length().value);
    q = piece.at(Dual3(step));
    left -= step;
  }
  SlideJacobian J;
  for (std::size_t i = 0; i < 3; ++i) {
    J.row(static_cast<Eigen::Index>(i)) << q.phase.by[i], q.X.by[i], q.u.by[i];
  }
  return held(is_free_along_x(model), SlideJacobian(J.transpose()));
}

Eigen::Vector3d slide_velocity(const Model& model, double eta, const SlideState<double>& q) {
  return {q.u, q.u - eta, sequence_state(Mechanics<double>(model), q).acceleration};
}

Eigen::Matrix4d projection_jacobian(const Model& model, const TipState& s) {
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

}  // namespace afm
