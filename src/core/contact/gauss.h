// The constants of Gauss collocation for x'' = f(t, x, x') with a step in which a harmonic swing turns by a fixed angle
// (docs/algorithm.md, "Contact"). Everything is computed by the compiler.
#pragma once

#include <cstddef>

#include "afm/detail/contact_step.h"

namespace afm::detail {

// Legendre's polynomial on [0, 1], and its derivative.
constexpr double legendre(std::size_t m, double c) {
  const double x = 2.0 * c - 1.0;
  double before = 1.0, p = m == 0 ? 1.0 : x;
  for (std::size_t n = 1; n < m; ++n) {
    const double k = static_cast<double>(n), next = ((2.0 * k + 1.0) * x * p - k * before) / (k + 1.0);
    before = p, p = next;
  }
  return p;
}
constexpr double legendre_slope(std::size_t m, double c) {
  const double x = 2.0 * c - 1.0;
  return 2.0 * static_cast<double>(m) * (x * legendre(m, c) - legendre(m - 1, c)) / (x * x - 1.0);
}

struct Square {
  double at[kGaussNodes][kGaussNodes];
};
constexpr Square operator*(const Square& a, const Square& b) {
  Square c{};
  for (std::size_t i = 0; i < kGaussNodes; ++i) {
    for (std::size_t j = 0; j < kGaussNodes; ++j) {
      for (std::size_t k = 0; k < kGaussNodes; ++k) c.at[i][j] += a.at[i][k] * b.at[k][j];
    }
  }
  return c;
}

// (1 + factor a)^-1, by the method of Gauss and Jordan. Precondition: its pivots are not small.
constexpr Square inverse_of_one_plus(double factor, const Square& a) {
  Square m{}, inverse{};
  for (std::size_t i = 0; i < kGaussNodes; ++i) {
    for (std::size_t j = 0; j < kGaussNodes; ++j) m.at[i][j] = factor * a.at[i][j] + (i == j ? 1.0 : 0.0);
    inverse.at[i][i] = 1.0;
  }
  for (std::size_t k = 0; k < kGaussNodes; ++k) {
    const double pivot = m.at[k][k];
    for (std::size_t j = 0; j < kGaussNodes; ++j) m.at[k][j] /= pivot, inverse.at[k][j] /= pivot;
    for (std::size_t i = 0; i < kGaussNodes; ++i) {
      const double part = i == k ? 0.0 : m.at[i][k];
      for (std::size_t j = 0; j < kGaussNodes; ++j) {
        m.at[i][j] -= part * m.at[k][j];
        inverse.at[i][j] -= part * inverse.at[k][j];
      }
    }
  }
  return inverse;
}

struct Gauss {
  AtGaussNodes node, weight;        // of the integral over [0, 1]
  AtGaussNodes weight2;             // of its second integral, from 0 to 1
  Square integral;                  // [i][j]: weight of node j in the integral from 0 to node i
  Square power;                     // [m][j]: weight of node j in the coefficient of c^m of the interpolation
  Square bernstein;                 // [j][m]: the same in Bernstein's basis
  AtGaussNodes last, last_but_one;  // weight of node j in the coefficient of that Legendre polynomial
};

constexpr Gauss make_gauss() {
  constexpr std::size_t n = kGaussNodes;
  Gauss g{};
  for (std::size_t i = 0, found = 0; found < n; ++i) {  // Newton's method from where the sign changes
    constexpr double kGrid = 1.0 / 512;
    double c = (static_cast<double>(i) + 0.5) * kGrid;
    if (legendre(n, c - 0.5 * kGrid) * legendre(n, c + 0.5 * kGrid) > 0.0) continue;
    for (int k = 0; k < 8; ++k) c -= legendre(n, c) / legendre_slope(n, c);
    const double slope = legendre_slope(n, c);
    g.node[found] = c, g.weight[found] = 1.0 / (c * (1.0 - c) * slope * slope);
    ++found;
  }
  // Legendre's polynomials in powers of c
  double in_powers[n][n]{};
  in_powers[0][0] = 1.0, in_powers[1][0] = -1.0, in_powers[1][1] = 2.0;
  for (std::size_t m = 1; m + 1 < n; ++m) {
    const double k = static_cast<double>(m);
    for (std::size_t p = 0; p < n; ++p) {
      const double shifted = p == 0 ? 0.0 : in_powers[m][p - 1];
      in_powers[m + 1][p] = ((2.0 * k + 1.0) * (2.0 * shifted - in_powers[m][p]) - k * in_powers[m - 1][p]) / (k + 1.0);
    }
  }
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t m = 0; m < n; ++m) {
      const double k = static_cast<double>(m), part = (2.0 * k + 1.0) * g.weight[j] * legendre(m, g.node[j]);
      for (std::size_t i = 0; i < n; ++i) {
        const double c = g.node[i];
        g.integral.at[i][j] +=
            part * (m == 0 ? c : (legendre(m + 1, c) - legendre(m - 1, c)) / (2.0 * (2.0 * k + 1.0)));
        g.power.at[i][j] += part * in_powers[m][i];
      }
      g.last_but_one[j] = g.last[j], g.last[j] = part;
    }
  }
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = 0; i < n; ++i) {
      g.weight2[j] += g.weight[i] * g.integral.at[i][j];
      double binomials = 1.0;  // of i over p divided by that of n - 1 over p
      for (std::size_t p = 0; p <= i; ++p) {
        g.bernstein.at[j][i] += binomials * g.power.at[p][j];
        binomials *= static_cast<double>(i - p) / static_cast<double>(n - 1 - p == 0 ? 1 : n - 1 - p);
      }
    }
  }
  return g;
}
constexpr Gauss kGauss = make_gauss();

// The interpolation of values at the nodes: its coefficient of the power m of the part of the step.
inline double coefficient(std::size_t m, const AtGaussNodes& values) {
  double sum = 0.0;
  for (std::size_t j = 0; j < kGaussNodes; ++j) sum += kGauss.power.at[m][j] * values[j];
  return sum;
}
// In Bernstein's basis, whose coefficients b enclose it.
inline void enclose(const AtGaussNodes& values, AtGaussNodes& b) {
  for (std::size_t i = 0; i < kGaussNodes; ++i) {
    b[i] = 0.0;
#pragma GCC unroll 8
    for (std::size_t j = 0; j < kGaussNodes; ++j) b[i] += kGauss.bernstein.at[j][i] * values[j];
  }
}

// A swing x'' = -kappa (x - x0) + rest(t) over a step h with h sqrt(kappa) = angle, in the equations of collocation:
//   x - x0 = h u0 x_per_u + h^2 (sum over j of x_per_rest[j] rest_j),
//   u = u0 u_per_u + h (sum over j of u_per_rest[j] rest_j).
// ..._per_one and ..._per_c are the sums for a rest of 1, and for a rest that is the part of the step so far.
struct SwingTable {
  double angle;
  AtGaussNodes x_per_rest[kGaussNodes], u_per_rest[kGaussNodes];  // [j][i]: of node j at node i
  AtGaussNodes x_per_u, u_per_u, x_per_one, u_per_one, x_per_c, u_per_c;
  double mean_per_u, mean_per_one, mean_per_c;  // of x - x0 over the step
};

constexpr SwingTable make_swing_table(double angle) {
  const Square A = kGauss.integral, A2 = A * A, solver = inverse_of_one_plus(angle * angle, A2);
  const Square x = A2 * solver, u = A * solver;
  SwingTable t{};
  t.angle = angle;
  for (std::size_t i = 0; i < kGaussNodes; ++i) {
    t.u_per_u[i] = 1.0;
    for (std::size_t j = 0; j < kGaussNodes; ++j) {
      const double c = kGauss.node[j];
      t.x_per_rest[j][i] = x.at[i][j], t.u_per_rest[j][i] = u.at[i][j];
      t.x_per_u[i] += solver.at[i][j] * c;
      t.u_per_u[i] -= angle * angle * u.at[i][j] * c;
      t.x_per_one[i] += x.at[i][j], t.u_per_one[i] += u.at[i][j];
      t.x_per_c[i] += x.at[i][j] * c, t.u_per_c[i] += u.at[i][j] * c;
    }
    const double weight = kGauss.weight[i];
    t.mean_per_u += weight * t.x_per_u[i], t.mean_per_one += weight * t.x_per_one[i];
    t.mean_per_c += weight * t.x_per_c[i];
  }
  return t;
}

}  // namespace afm::detail
