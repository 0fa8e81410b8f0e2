#include "afm/dynamics/cycle_expansion.h"

#include <algorithm>
#include <cmath>

namespace afm {
namespace {

// The contribution of a product of distinct orbits: signed weight, energy and time.
struct Term {
  double weight, energy, time;
  std::size_t length;
};

double instability(const PeriodicOrbit& orbit) {
  double product = 1.0;
  for (const auto& multiplier : orbit.multipliers) product *= std::max(1.0, std::abs(multiplier));
  return product;
}

// Every product of distinct orbits of at most so many impacts; the empty product first.
std::vector<Term> combinations(const std::vector<PeriodicOrbit>& orbits, std::size_t longest) {
  std::vector<Term> terms{{1.0, 0.0, 0.0, 0}};
  for (const PeriodicOrbit& orbit : orbits) {
    const double expansion = instability(orbit);
    const std::size_t count = terms.size();
    for (std::size_t i = 0; i < count; ++i) {
      const Term t = terms[i];
      if (t.length + orbit.length() > longest) continue;
      terms.push_back({-t.weight / expansion, t.energy + orbit.energy_loss, t.time + orbit.period,
                       t.length + orbit.length()});
    }
  }
  return terms;
}

double determinant(const PeriodicOrbit& orbit, int repeats) {
  std::complex<double> product = 1.0;
  for (const auto& multiplier : orbit.multipliers) product *= 1.0 - std::pow(multiplier, repeats);
  return std::abs(product);
}

// A power series in z with the derivatives by the fields that count energy and time.
struct Series {
  explicit Series(std::size_t n) : value(n + 1), energy(n + 1), time(n + 1) {}
  std::vector<double> value, energy, time;
};

// n c_n of the logarithm -sum c_n z^n: the sum over orbits and repeats of z^(nr) e^(r field) n / |det(1 - J^r)|.
Series traces(const std::vector<PeriodicOrbit>& orbits, std::size_t longest) {
  Series c(longest);
  for (const PeriodicOrbit& orbit : orbits) {
    for (std::size_t r = 1; r * orbit.length() <= longest; ++r) {
      const std::size_t n = r * orbit.length();
      const double weight = static_cast<double>(orbit.length()) / determinant(orbit, static_cast<int>(r));
      c.value[n] += weight;
      c.energy[n] += weight * static_cast<double>(r) * orbit.energy_loss;
      c.time[n] += weight * static_cast<double>(r) * orbit.period;
    }
  }
  return c;
}

}  // namespace

std::vector<CycleAverage> zeta_averages(const std::vector<PeriodicOrbit>& orbits, double eta, int longest) {
  const std::vector<Term> terms = combinations(orbits, static_cast<std::size_t>(longest));
  std::vector<CycleAverage> rows;
  for (int n = 1; n <= longest; ++n) {
    int count = -1;  // the empty product is no cycle
    double weight = 0.0, energy = 0.0, time = 0.0;
    for (const Term& t : terms) {
      if (t.length > static_cast<std::size_t>(n)) continue;
      ++count;
      weight += t.weight;
      energy += t.weight * t.energy;
      time += t.weight * t.time;
    }
    rows.push_back({n, count, energy / time / (eta * eta), weight});
  }
  return rows;
}

// D = exp(-L), L = sum c_n z^n: n D_n = -sum_k k c_k D_(n-k), and likewise for the derivatives.
std::vector<CycleAverage> determinant_averages(const std::vector<PeriodicOrbit>& orbits, double eta, int longest) {
  const std::size_t N = static_cast<std::size_t>(longest);
  const Series c = traces(orbits, N);
  Series D(N);
  D.value[0] = 1.0;
  for (std::size_t n = 1; n <= N; ++n) {
    for (std::size_t k = 1; k <= n; ++k) {
      D.value[n] -= c.value[k] * D.value[n - k];
      D.energy[n] -= c.energy[k] * D.value[n - k] + c.value[k] * D.energy[n - k];
      D.time[n] -= c.time[k] * D.value[n - k] + c.value[k] * D.time[n - k];
    }
    D.value[n] /= static_cast<double>(n);
    D.energy[n] /= static_cast<double>(n);
    D.time[n] /= static_cast<double>(n);
  }
  std::vector<CycleAverage> rows;
  double value = 1.0, energy = 0.0, time = 0.0;
  for (std::size_t n = 1; n <= N; ++n) {
    value += D.value[n];
    energy += D.energy[n];
    time += D.time[n];
    rows.push_back({static_cast<int>(n), static_cast<int>(n), energy / time / (eta * eta), value});
  }
  return rows;
}

}  // namespace afm
