// Gauss collocation of a slide in contact (docs/algorithm.md, "Contact"). The compiler makes vector operations of the
// loops over the nodes. No sum runs over the nodes in such a loop, so the bits do not depend on it.
#include "afm/detail/contact_step.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bernstein_fall.h"
#include "core/release_noise.h"
#include "gauss.h"

namespace afm::detail {
namespace {

constexpr std::size_t kN = kGaussNodes;

// docs/algorithm.md, "Contact", says where each of them stands.
struct ContactLimits {
  static constexpr double kMaxReach = 0.25;  // [a] from the middle of a step: turned_by() holds up to there

  // the iteration; the first three are squares
  static constexpr double kFirst = 1e-4;           // a first change so small, over the tolerance, is the last one
  static constexpr double kSafety = 16.0;          // of the estimate of what is left
  static constexpr double kMaxContraction = 0.1;   // beyond it a shorter step is faster
  static constexpr int kMaxEvaluations = 12;       // of a step
  static constexpr double kLeastStiffness = 0.25;  // over that of the spring and of the surface that passes

  // the interpolation
  static constexpr double kTail = 1e-4;  // integrals of the first coefficient left out over those of the last: a choice
  static constexpr double kFall = 0.3;   // from one coefficient to the next; one may vanish by chance, so we take two

  // a step so far within its limits is followed by one of the level before
  static constexpr double kEasyTail = 0.05;   // over the tolerance
  static constexpr double kEasyReach = 0.7;   // over kMaxReach
  static constexpr int kEasyEvaluations = 4;  // at most

  // a close call
  static constexpr double kPathError = 10.0;  // over the tolerance
  static constexpr double kAtOnce = 0.05;     // of the step, between the earliest and the latest fall
  static constexpr int kFinerLevels = 4;      // of the step that is made again
};
using Limits = ContactLimits;

// In a step of level n the swing turns by 2 pi (3/4)^n. From kLevels on, steps are so short that it is not split off.
constexpr int kLevels = 8, kLastLevel = 60;
constexpr double kLevelRatio = 0.75;

constexpr std::array<double, kLastLevel + 1> make_angles() {
  std::array<double, kLastLevel + 1> angles{kTwoPi};
  for (std::size_t i = 1; i < angles.size(); ++i) angles[i] = kLevelRatio * angles[i - 1];
  return angles;
}
constexpr std::array<double, kLastLevel + 1> kAngle = make_angles();

constexpr std::array<SwingTable, kLevels + 1> make_swing_tables() {
  std::array<SwingTable, kLevels + 1> tables{};
  for (std::size_t i = 0; i < kLevels; ++i) tables[i] = make_swing_table(kAngle[i]);
  tables[kLevels] = make_swing_table(0.0);
  return tables;
}
constexpr std::array<SwingTable, kLevels + 1> kSwing = make_swing_tables();

constexpr double kMaxLength = 8.0;    // [tau] a choice: as far as a flight is searched at once
constexpr double kMinLength = 1e-12;  // [tau] only a corrupted state is so fast

inline double sum_of_products(const AtGaussNodes& a, const AtGaussNodes& b) {
  double sum[4];
  for (std::size_t i = 0; i < 4; ++i) sum[i] = a[i] * b[i] + a[i + 4] * b[i + 4];
  return (sum[0] + sum[2]) + (sum[1] + sum[3]);
}
inline double least_of(const AtGaussNodes& a) {
  double least = a[0];
  for (std::size_t i = 1; i < kN; ++i) least = a[i] < least ? a[i] : least;
  return least;
}

// With y = h(x), Newton's equations in x and y leave x'' = -(omega_h^2 X + h' push) / (1 + h'^2), where
// push = omega_v^2 (h - y0) + h'' x'^2; the reaction along y is (push - h' omega_h^2 X) / (1 + h'^2).
inline ContactForces forces(const SpringConstants<double>& m, const SinCos<double>& turn, double X, double u) {
  const double k = two_pi<double>(), k2 = k * k, wh2 = m.omega_h * m.omega_h, free = m.is_free_along_x;
  const double h = m.H * turn.cos, h1 = -k * m.H * turn.sin, h2 = -k2 * h, h3 = -k2 * h1, u2 = u * u;
  const double push = k2 * (h - m.y0) + h2 * u2, pull = wh2 * X, N2 = 1.0 + free * h1 * h1;
  const double force = -free * (pull + h1 * push) / N2;
  const double slope = wh2 + h2 * push + h1 * (h3 * u2 + k2 * h1);
  return {h, N2, force, (push - h1 * pull) / N2, free * (slope + 2.0 * h1 * h2 * force) / N2};
}

// Sine and cosine of the turn from which `turn` is r away, |r| <= 1/4: within 1e-12.
inline SinCos<double> turned_by(const SinCos<double>& turn, double r) {
  const double z = r * r, z2 = z * z, z4 = z2 * z2;
  const double s_low = (kSine[0] + z * kSine[1]) + z2 * (kSine[2] + z * kSine[3]);
  const double s_high = (kSine[4] + z * kSine[5]) + z2 * (kSine[6] + z * kSine[7]) + z4 * kSine[8];
  const double c_low = (kCosine[0] + z * kCosine[1]) + z2 * (kCosine[2] + z * kCosine[3]);
  const double c_high = (kCosine[4] + z * kCosine[5]) + z2 * (kCosine[6] + z * kCosine[7]) + z4 * kCosine[8];
  const double sine = r * (s_low + z4 * s_high), cosine = c_low + z4 * c_high;
  return {turn.sin * cosine + turn.cos * sine, turn.cos * cosine - turn.sin * sine};
}

}  // namespace

// The state of the energy that the drag has brought. The correction has the size of the error of the method. It goes
// into the velocity, or where the swing turns back, into the place. Where the tip is nearly at rest, the energy hardly
// depends on its state: there an error of energy is one of the work, and the integral takes it.
ContactPoint ContactStep::balanced(double time, double d, double u, double integral) const {
  // of the energy of the swing: beyond it the swing is as small as rounding or the error. A velocity can take nearly
  // all of it.
  constexpr double kMaxPart = 0.25, kMaxPartOfVelocity = 0.9;
  constexpr double kRounding = 1e-13;  // of the energy
  constexpr double kMaxShift = 100.0;  // over the tolerance: by so much its mean may change
  constexpr int kMaxTries = 8;         // two are enough, as the convergence is quadratic
  const SlideState<double> computed{start_.phase + d, start_.X + (d - eta_ * time), u};
  ContactPoint to{computed, integral};
  if (m_.is_free_along_x == 0.0) return to;
  SlideState<double>& q = to.state;
  const double u2 = u * u;
  // it takes the surplus if it has so much
  const auto change_velocity = [&](double surplus) {
    if (surplus < u2) q.u = std::copysign(std::sqrt(u2 - surplus), u);
  };
  const double wh2 = m_.omega_h * m_.omega_h, k = two_pi<double>();
  const double work = 2.0 * eta_ * wh2 * integral, kinetic = first_.N2 * (start_.u * start_.u);
  const double push = k * (first_.h - m_.y0), energy = kinetic + wh2 * start_.X * start_.X + push * push;
  double first_surplus = 0.0, last_surplus = 0.0;
  for (int i = 0; i < kMaxTries; ++i) {
    const ContactForces there = forces(m_, sin_cos_turns(q.phase), q.X, u);
    const double springs =
        wh2 * (q.X - start_.X) * (q.X + start_.X) + k * k * (there.h - first_.h) * (there.h + first_.h - 2.0 * m_.y0);
    // of twice the energy, over N2
    const double surplus = (there.N2 * u2 - kinetic + springs + work) / there.N2;
    const double swing = there.force * there.force / stiffness_;
    const bool by_velocity = u2 >= 0.25 * swing;
    if (!(std::fabs(surplus) < std::max(kMaxPart * swing, kMaxPartOfVelocity * u2))) {
      if (!(std::fabs(surplus) * there.N2 > kRounding * energy)) return to;
      const double shift = surplus * there.N2 / (2.0 * eta_ * wh2);  // infinite without drag
      if (std::fabs(shift) < kMaxShift * tolerance_ * time) {
        to.extension_integral -= shift;
      } else {
        change_velocity(surplus);
      }
      return to;
    }
    if (by_velocity) {
      change_velocity(surplus);
      return to;
    }
    // a least stiffness, of a spring that is soft beside the load, makes the swing larger than all the energy
    if (std::fabs(surplus) < 1e-15 * std::min(swing, energy / there.N2)) return to;
    (i == 0 ? first_surplus : last_surplus) = surplus;
    const double dx = 0.5 * surplus / there.force;
    q.phase += dx, q.X += dx;
  }
  if (std::fabs(last_surplus) <= kRounding * energy) return to;
  // no place near by has that energy, as next to a crest
  q = computed;
  change_velocity(first_surplus);
  return to;
}

// One step of the given level; false if it does not meet the tolerance.
bool ContactStep::attempt(int level, double stiffness, double tolerance) {
  const SpringConstants<double>& m = m_;
  const double k = two_pi<double>(), k2 = k * k, wh2 = m.omega_h * m.omega_h, free = m.is_free_along_x;
  const double u0 = start_.u, X0 = start_.X, eta = eta_, H = m.H, y0 = m.y0;
  const SwingTable& table = kSwing[static_cast<std::size_t>(free == 0.0 ? kLevels : std::min(level, kLevels))];
  const double least = Limits::kLeastStiffness * (wh2 * free + k2 * u0 * u0);
  const double angle = kAngle[static_cast<std::size_t>(level)];
  const double longest = std::min(kMaxLength, angle / std::sqrt(std::max(stiffness, least)));
  const double h = std::max(kMinLength, longest);
  const double h2 = h * h, inverse_h = 1.0 / h, kappa = table.angle * table.angle / h2;
  const double drag = wh2 * eta * free / first_.N2, n0 = h2 * first_.force, n1 = h2 * h * drag, n_u = h * u0;
  const double middle = n_u * table.mean_per_u + (n0 * table.mean_per_one + n1 * table.mean_per_c);
  const SinCos<double> turn = sin_cos_turns(start_.phase + middle);
  length_ = h;

  // the harmonic motion under a force that grows evenly with the drag
  AtGaussNodes d, u, rest, change, reaction;
  for (std::size_t i = 0; i < kN; ++i) {
    d[i] = n_u * table.x_per_u[i] + (n0 * table.x_per_one[i] + n1 * table.x_per_c[i]);
    u[i] = (n_u * table.u_per_u[i] + (n0 * table.u_per_one[i] + n1 * table.u_per_c[i])) * inverse_h;
  }
  // squares: an evaluation multiplies the error by the contraction now / before
  const double limit = static_cast<double>(kN) * tolerance * tolerance;
  double before = 0.0, reach = 0.0;
  int evaluations = 0;
  for (;;) {
    reach = 0.0;
    for (std::size_t i = 0; i < kN; ++i) {
      const double r = std::fabs(d[i] - middle);
      reach = r > reach ? r : reach;
    }
    if (!(reach <= Limits::kMaxReach)) return false;
    ++evaluations;
    for (std::size_t i = 0; i < kN; ++i) {
      const SinCos<double> there = turned_by(turn, d[i] - middle);
      const double h1 = -k * H * there.sin, push = k2 * (H * there.cos * (1.0 - u[i] * u[i]) - y0);
      const double pull = wh2 * (X0 + (d[i] - eta * h * kGauss.node[i])), inverse_N2 = 1.0 / (1.0 + free * h1 * h1);
      reaction[i] = (push - h1 * pull) * inverse_N2;
      rest[i] = h2 * (kappa * d[i] - free * (pull + h1 * push) * inverse_N2);
    }
    for (std::size_t i = 0; i < kN; ++i) {
      double x = n_u * table.x_per_u[i], w = n_u * table.u_per_u[i];
#pragma GCC unroll 8
      for (std::size_t j = 0; j < kN; ++j) {
        x += table.x_per_rest[j][i] * rest[j];
        w += table.u_per_rest[j][i] * rest[j];
      }
      change[i] = x - d[i];
      d[i] = x, u[i] = w * inverse_h;
    }
    const double now = sum_of_products(change, change);
    if (evaluations == 1 ? now <= Limits::kFirst * limit
                         : now <= limit || Limits::kSafety * now * now <= limit * before) {
      break;
    }
    const bool contracts = now < Limits::kMaxContraction * before;
    if (evaluations > 1 && (!contracts || evaluations == Limits::kMaxEvaluations)) return false;
    before = now;
  }
  for (std::size_t i = 0; i < kN; ++i) {
    force_[i] = rest[i] * (inverse_h * inverse_h) - kappa * d[i];
    reaction_[i] = reaction[i];
  }
  const double last = std::fabs(sum_of_products(kGauss.last, force_));
  const double before_last = Limits::kFall * std::fabs(sum_of_products(kGauss.last_but_one, force_));
  const double tail = Limits::kTail * h2 * (last > before_last ? last : before_last);
  if (!(tail <= tolerance)) return false;
  const bool may_be_longer = tail < Limits::kEasyTail * tolerance && reach < Limits::kEasyReach * Limits::kMaxReach &&
                             evaluations <= Limits::kEasyEvaluations;
  const ContactForces there = forces(m, turn, X0 + middle, 0.0);
  stiffness_ = std::max(there.stiffness, least);
  hint_ = {may_be_longer ? std::max(0, level - 1) : level, stiffness_};
  mean_displacement_ = sum_of_products(kGauss.weight, d);
  return true;
}

ContactPoint ContactStep::end() const {
  const double h = length_, u0 = start_.u;
  return balanced(h, h * u0 + h * h * sum_of_products(kGauss.weight2, force_),
                  u0 + h * sum_of_products(kGauss.weight, force_),
                  h * ((start_.X - 0.5 * eta_ * h) + mean_displacement_));
}

int ContactStep::try_levels(double tolerance, const Hint& hint) {
  int level = hint.level;
  double stiffness = hint.stiffness > 0.0 ? hint.stiffness : std::fabs(first_.stiffness);
  is_accurate_ = attempt(level, stiffness, tolerance);
  while (!is_accurate_ && level < kLastLevel) {
    stiffness = std::fabs(first_.stiffness);
    is_accurate_ = attempt(++level, stiffness, tolerance);
  }
  return level;
}

// The step in which the tip may leave is made to the last digits if it is a close call: the reaction is zero for ever
// on the glide at eta = 1.
ContactStep::ContactStep(const SpringConstants<double>& springs, double eta, const SlideState<double>& start,
                         double tolerance, const Hint& hint, Purpose purpose)
    : m_(springs), eta_(eta), tolerance_(tolerance), start_(start) {
  first_ = forces(m_, sin_cos_turns(start.phase), start.X, start.u);
  if (eta == 0.0 && start.u == 0.0 && first_.force == 0.0) {  // at rest for good
    length_ = kMaxLength, stiffness_ = 1.0, is_accurate_ = true;
    std::fill_n(reaction_, kN, first_.reaction);
    return;
  }
  const int level = try_levels(tolerance, hint);
  if (purpose == Purpose::look_ahead || tolerance <= kFinestStep || !is_close_call()) return;
  const Hint next = hint_;
  try_levels(kFinestStep, {std::min(level + Limits::kFinerLevels, kLastLevel), stiffness_});
  hint_ = next;
}

// True if the reaction neither stays above zero for certain, nor falls through it at once.
bool ContactStep::is_close_call() const {
  constexpr int kHalvings = 4;  // of the step: enough to enclose a swing
  const double k = two_pi<double>(), wh2 = m_.omega_h * m_.omega_h, u = std::fabs(start_.u);
  const double by_x = wh2 + k * k * (1.0 + u * u) + k * wh2 * std::fabs(start_.X);
  const double of_path = Limits::kPathError * tolerance_ * k * m_.H * (by_x + 2.0 * k * u * std::sqrt(stiffness_));
  const double of_interpolation =
      std::fabs(sum_of_products(kGauss.last, reaction_)) + std::fabs(sum_of_products(kGauss.last_but_one, reaction_));
  const double error = kReleaseNoise + of_path + of_interpolation;
  AtGaussNodes b;
  enclose(reaction_, b);
  if (least_of(b) > error) return false;
  if (!(first_.reaction > error)) return true;
  for (double& x : b) x -= error;
  const double earliest = first_bernstein_fall(b, 0.0, 1.0, kHalvings);
  if (earliest < 0.0) return false;
  for (double& x : b) x += 2.0 * error;
  const double latest = first_bernstein_fall(b, 0.0, 1.0, kHalvings);
  return latest < 0.0 || latest - earliest > Limits::kAtOnce;
}

Series<double> ContactStep::displacement() const {
  Series<double> d{};
  d[1] = start_.u;
  double scale = 1.0;
  for (std::size_t m = 0; m < kN; ++m) {
    d[m + 2] = coefficient(m, force_) * scale / static_cast<double>((m + 1) * (m + 2));
    scale /= length_;
  }
  return d;
}

ContactPoint ContactStep::point(double s) const {
  if (s == length_) return end();
  const Series<double> c = displacement();
  double d = 0.0, u = 0.0, integral = 0.0;
  for (std::size_t m = kN + 1; m >= 1; --m) {
    d = s * (d + c[m]), u = u * s + c[m] * static_cast<double>(m);
    integral = s * (integral + c[m] / static_cast<double>(m + 1));
  }
  return balanced(s, d, u, s * ((start_.X - 0.5 * eta_ * s) + integral));
}

double ContactStep::pressure(const SlideState<double>& q) const {
  return forces(m_, sin_cos_turns(q.phase), q.X, q.u).reaction;
}

}  // namespace afm::detail
