// From one impact to the next in quad precision, written from the paper's formulas alone (Eq. 9-11): what Jacobians are
// compared with.
#pragma once

#include <Eigen/Core>

#include "afm/model.h"
#include "afm/state.h"
#include "trials/quad.h"

namespace afm {

// x, X, u, and the gap rate, after an impact.
using QuadPoint = std::array<Quad, 4>;

inline QuadPoint quad_point(const TipState& s) { return {s.phase, s.X, s.u, s.g1}; }

class QuadImpacts {
 public:
  QuadImpacts(const Model& model, double eta)
      : eta_(eta),
        gamma_(model.gamma),
        v_c_(model.v_c),
        H_(model.H),
        y0_(model.y0),
        wv_(detail::two_pi<Quad>()),
        wh_(wv_ * model.frequency_ratio),
        held_(model.kind == ModelKind::hammer) {}

  // The root of the gap next to `guess`. The hammer's X and u are taken as its holder's.
  QuadPoint next(const QuadPoint& start, const Quad& guess) {
    const QuadPoint p = held_ ? QuadPoint{start[0], 0, eta_, start[3]} : start;
    const Quad y = h(p[0]) - y0_, w = p[3] + h1(p[0]) * p[2], U = p[2] - eta_;
    Quad x, X, u, Y, W, s = guess;
    for (int i = 0; i < 60; ++i) {
      const Quad ch = cos(wh_ * s), sh = sin(wh_ * s), cv = cos(wv_ * s), sv = sin(wv_ * s);
      X = p[1] * ch + U * sh / wh_;
      u = eta_ + U * ch - wh_ * p[1] * sh;
      Y = y * cv + w * sv / wv_;
      W = w * cv - wv_ * y * sv;
      x = p[0] + (X - p[1]) + eta_ * s;
      const Quad step = (Y + y0_ - h(x)) / (W - h1(x) * u);
      s -= step;
      if (abs(step) < 1e-32) break;
    }
    return reflected(x, X, u, W);
  }
  const Quad& speed() const { return speed_; }  // normal, of the last impact

 private:
  Quad h(const Quad& x) const { return H_ * cos(wv_ * x); }
  Quad h1(const Quad& x) const { return -wv_ * H_ * sin(wv_ * x); }

  Quad restitution(const Quad& speed) const { return speed >= v_c_ ? gamma_ : 1 - (1 - gamma_) * speed / v_c_; }

  QuadPoint reflected(const Quad& x, const Quad& X, const Quad& u, const Quad& w) {
    if (held_) {
      speed_ = h1(x) * u - w;
      return {x, X, u, restitution(speed_) * speed_};
    }
    const Quad slope = h1(x), N = sqrt(1 + slope * slope), nx = -slope / N, ny = 1 / N;
    const Quad v = nx * u + ny * w;
    speed_ = -v;
    const Quad e = restitution(-v);
    const Quad u2 = u - (1 + e) * nx * v, w2 = w - (1 + e) * ny * v;
    return {x, X, u2, w2 - slope * u2};
  }

  Quad eta_, gamma_, v_c_, H_, y0_, wv_, wh_, speed_;
  bool held_;
};

// Central differences of a function of N numbers: good to step^2 of its third derivatives.
template <std::size_t M, std::size_t N, class F>
Eigen::Matrix<double, static_cast<int>(M), static_cast<int>(N)> quad_differences(const F& f,
                                                                                 const std::array<Quad, N>& at,
                                                                                 const Quad& step) {
  Eigen::Matrix<double, static_cast<int>(M), static_cast<int>(N)> J;
  for (std::size_t j = 0; j < N; ++j) {
    std::array<Quad, N> up = at, down = at;
    up[j] += step;
    down[j] -= step;
    const std::array<Quad, M> high = f(up), low = f(down);
    for (std::size_t i = 0; i < M; ++i) {
      J(static_cast<int>(i), static_cast<int>(j)) = static_cast<double>((high[i] - low[i]) / (2 * step));
    }
  }
  return J;
}

inline double relative_distance(const Eigen::MatrixXd& J, const Eigen::MatrixXd& truth) {
  return (J - truth).norm() / truth.norm();
}

}  // namespace afm
