#include "afm/dynamics/attractor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "afm/dynamics/periodic_orbit.h"
#include "afm/dynamics/poincare_map.h"
#include "afm/dynamics/tangents.h"
#include "core/not_numbers.h"
#include "core/run/interruptible_advance.h"

namespace afm {
namespace {

// A point at which orbits are compared: the state after an impact or a release, its time, and the impacts so far.
struct Mark {
  TipState state;
  ModelTime time;
  int impacts;
};

double distance(const TipState& a, const TipState& b) { return section_difference(a, b).lpNorm<Eigen::Infinity>(); }

// Of a bounce that hardly lifts the tip [a/tau]. At a reaction of 4 a/tau^2 it rises by 1.3e-5 a: v^2/2P.
constexpr double kCreepSpeed = 1e-2;
bool is_creeping(const Impact& impact) {
  return impact.kind == ImpactKind::burst || impact.normal_speed < kCreepSpeed;
}

// Advances a tip from mark to mark within a budget of events, and sums the time in contact.
class Observer {
 public:
  Observer(Tip& tip, std::uint64_t most_events) : tip_(tip), left_(most_events) {}

  // False if the limit, the end of the budget or a failed search came first.
  bool next(const ModelTime& limit) {
    while (left_ > 0 && !failed_) {
      bool held = tip_.in_contact();
      const ModelTime before = tip_.now();
      const Outcome outcome = detail::advance_interruptibly(tip_, limit);
      --left_;
      held = held || (outcome == Outcome::impact && is_creeping(tip_.last_impact()));
      if (held) in_contact_ += tip_.now() - before;
      if (outcome == Outcome::time_limit) return false;
      failed_ = outcome == Outcome::search_failed;
      const bool single = outcome == Outcome::impact && tip_.last_impact().kind == ImpactKind::impact;
      impacts_ += single ? 1 : 0;
      if (single || outcome == Outcome::released) return true;
    }
    return false;
  }
  void run_until(const ModelTime& limit) {
    while (next(limit)) {
    }
  }

  Mark mark() const { return {tip_.tip_state(), tip_.now(), impacts_}; }
  bool stopped() const { return failed_ || left_ == 0; }
  std::uint64_t left() const { return left_; }
  double contact_time() const { return in_contact_; }  // so far [tau]

 private:
  Tip& tip_;
  std::uint64_t left_;
  bool failed_ = false;
  int impacts_ = 0;
  double in_contact_ = 0.0;
};

constexpr double kMostEventsPerTau = 2000.0;  // a choice: a tip that bounces has some tens

// Of one period, which is seen twice; zero if the orbit does not return.
struct Period {
  int marks = 0, impacts = 0, cells = 0;
  double contact_share = 0.0;
};

// A difference of long sums may be above 1 by rounding.
double share(double contact_time, double duration) { return std::min(1.0, contact_time / duration); }

// Cells that the holder passes up to the nth mark. A bounce without speed returns within none.
int cells_until(const std::vector<Mark>& marks, int n, double eta) {
  return static_cast<int>(std::lround(std::abs(eta) * (marks[static_cast<std::size_t>(n)].time - marks[0].time)));
}

// While the tip still converges, a multiple of the period may be the first return within the tolerance.
int smallest_period(const std::vector<Mark>& marks, int n, double eta, double tolerance) {
  constexpr double kConverging = 100.0;  // a choice: distance of a shorter return, over the tolerance
  for (int d = 1; d < n; ++d) {
    const bool is_near = distance(marks[static_cast<std::size_t>(d)].state, marks[0].state) < kConverging * tolerance;
    if (n % d == 0 && is_near && cells_until(marks, d, eta) > 0) return d;
  }
  return n;
}

// The orbit must return twice.
Period find_period(Observer& observer, double eta, const ModelTime& limit, const AttractorSettings& settings) {
  if (!observer.next(limit)) return {};
  std::vector<Mark> marks{observer.mark()};
  const double contact_before = observer.contact_time();
  int found = 0;
  while (static_cast<int>(marks.size()) <= 2 * settings.longest && observer.next(limit)) {
    marks.push_back(observer.mark());
    const int n = static_cast<int>(marks.size()) - 1;
    if (distance(marks.back().state, marks[0].state) > settings.tolerance || cells_until(marks, n, eta) == 0) continue;
    if (found == 0) found = n;
    if (n < 2 * found) continue;
    const int period = smallest_period(marks, found, eta, settings.tolerance);
    const int impacts = marks[static_cast<std::size_t>(period)].impacts - marks[0].impacts;
    return {period, impacts, cells_until(marks, period, eta),
            share(observer.contact_time() - contact_before, marks.back().time - marks[0].time)};
  }
  return {};
}

// The exponents of a periodic orbit follow from the multipliers of one period.
LyapunovSpectrum exponents_of(const Model& model, Tip& tip, const Period& period) {
  LyapunovSpectrum s;
  Tangents tangents(model, tip);
  const double duration = period.cells / std::abs(tip.eta());
  if (!tangents.start(2.0 * duration)) return s;
  const ModelTime latest = tip.now() + 2.0 * duration;
  while (tip.in_contact() && tip.now() < latest) {  // a period begins at its end
    if (tangents.advance(latest) == Outcome::search_failed) return s;
  }
  const ModelTime end = tip.now() + 1.5 * duration;
  std::vector<SectionJacobian<double>> jacobians;
  double volume = 0.0;
  bool are_finite = true;
  for (int marks = 0; marks < period.marks && tip.now() < end;) {
    const Outcome outcome = tangents.advance(end);
    if (outcome == Outcome::search_failed || outcome == Outcome::time_limit) break;
    if (outcome != Outcome::flying) ++s.events;
    jacobians.push_back(tangents.jacobian());
    are_finite = are_finite && jacobians.back().allFinite();
    volume += tangents.growth().volume;
    const bool single = outcome == Outcome::impact && tip.last_impact().kind == ImpactKind::impact;
    if (single || outcome == Outcome::released) ++marks;
  }
  s.outcome = are_finite ? LyapunovOutcome::measured : LyapunovOutcome::no_number;
  if (s.outcome != LyapunovOutcome::measured) return s;
  s.rank = tangents.rank();
  s.duration = duration;
  s.volume_rate = s.rank < section_dimension(model) ? -kInfinity : volume / duration;
  const Multipliers multipliers = multipliers_of(jacobians);
  for (int i = 0; i < 4; ++i) {
    const auto k = static_cast<std::size_t>(i);
    s.exponents[k] = i < s.rank ? std::log(std::abs(multipliers[k])) / duration : -kInfinity;
  }
  return s;
}

bool attracts(const PeriodicOrbit& orbit, const TipState& from) {
  constexpr double kNearOrbit = 0.2;  // [a, a/tau] a choice: four times the distance of a near return
  double nearest = kInfinity;
  for (const TipState& point : orbit.points) nearest = std::min(nearest, distance(point, from));
  return nearest < kNearOrbit && std::abs(orbit.multipliers[0]) < 1.0;
}

void describe(const PeriodicOrbit& orbit, Attractor& found) {
  found.kind = AttractorKind::periodic;
  found.impacts = static_cast<int>(orbit.length());
  found.cells = std::abs(orbit.cells);
  found.cells_per_impact = static_cast<double>(found.cells) / found.impacts;
  for (std::size_t i = 0; i < 4; ++i)
    found.lyapunov.exponents[i] = std::log(std::abs(orbit.multipliers[i])) / orbit.period;
  double creeping = 0.0;
  for (std::size_t i = 0; i < orbit.length(); ++i) creeping += orbit.speeds[i] < kCreepSpeed ? orbit.times[i] : 0.0;
  found.contact_share = share(creeping, orbit.period);
}

// Slow convergence: Newton's method finds the orbit from a near return. Only for orbits of single impacts.
bool find_slow_period(const Model& model, Observer& observer, Tip& tip, const ModelTime& limit, Attractor& found) {
  constexpr std::size_t kLongestOrbit = 32;  // [impacts] a choice: the cost of a Newton step grows with the cube
  std::vector<TipState> run;
  while (run.size() <= kLongestOrbit && observer.next(limit)) {
    run.push_back(observer.mark().state);
    if (tip.in_contact() || !(run.back().g1 > 0.0)) return false;
  }
  constexpr double kNearReturn = 0.05;  // [a, a/tau] a choice
  constexpr int kMaxAttempts = 8;       // a choice
  int attempts = 0;
  for (std::size_t n = 1; n <= kLongestOrbit && n < run.size() && attempts < kMaxAttempts; ++n) {
    if (distance(run[n], run[0]) > kNearReturn) continue;
    ++attempts;
    const OrbitResult r =
        find_orbit(PoincareMap(model, tip.eta()), {run.begin(), run.begin() + static_cast<std::ptrdiff_t>(n)});
    if (r.outcome == OrbitOutcome::found && is_prime(r.orbit) && attracts(r.orbit, run[0])) {
      describe(r.orbit, found);
      return true;
    }
  }
  return false;
}

// Turns per impact about the centre of the points, in the plane of two coordinates, and by how much the turn of one
// impact differs from that of another. A spread near 1 says that the centre is not within the curve in this plane.
struct Turns {
  double mean = kNaN, spread = kInfinity;
};

// Each coordinate less its mean, over its deviation.
std::vector<Eigen::Vector4d> standardised(std::vector<Eigen::Vector4d> points) {
  Eigen::Vector4d mean = Eigen::Vector4d::Zero(), square = Eigen::Vector4d::Zero();
  const double n = static_cast<double>(points.size());
  for (const Eigen::Vector4d& p : points) mean += p / n;
  for (const Eigen::Vector4d& p : points) square += (p - mean).cwiseAbs2() / n;
  for (Eigen::Vector4d& p : points) {
    for (int i = 0; i < 4; ++i) p[i] = square[i] > 0.0 ? (p[i] - mean[i]) / std::sqrt(square[i]) : 0.0;
  }
  return points;
}

// A weighted Birkhoff average: steps at the ends weigh little, so the mean converges like a high power of their number.
double smooth_mean(const std::vector<double>& steps) {
  double sum = 0.0, weights = 0.0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double t = (static_cast<double>(i) + 0.5) / static_cast<double>(steps.size()), hill = t * (1.0 - t);
    const double weight = (hill * hill) * (hill * hill);
    sum += weight * steps[i], weights += weight;
  }
  return sum / weights;
}

Turns turns_in_plane(const std::vector<Eigen::Vector4d>& points, int a, int b) {
  std::vector<double> steps;
  double before = kNaN, cosine = 0.0, sine = 0.0;
  for (const Eigen::Vector4d& p : points) {
    const double angle = std::atan2(p[b], p[a]);
    if (!std::isnan(before)) {
      steps.push_back((angle - before) / kTwoPi);
      cosine += std::cos(angle - before), sine += std::sin(angle - before);
    }
    before = angle;
  }
  const double middle = std::atan2(sine, cosine) / kTwoPi;
  for (double& step : steps) step = std::remainder(step - middle, 1.0);
  const auto [least, most] = std::minmax_element(steps.begin(), steps.end());
  return {middle + smooth_mean(steps), *most - *least};
}

// The mean square of what lies between neighbours, over that of any two points, where the n-th point is put at n turns
// of a circle. Near 0: the place on this circle says where the point is, so they lie on one closed curve.
double disorder_on_circle(const std::vector<Eigen::Vector4d>& points, double turns) {
  std::vector<std::pair<double, std::size_t>> places;
  for (std::size_t n = 0; n < points.size(); ++n) {
    const double turned = static_cast<double>(n) * turns;
    places.emplace_back(turned - std::floor(turned), n);
  }
  std::sort(places.begin(), places.end());
  double between = 0.0, all = 0.0;
  for (std::size_t i = 1; i < places.size(); ++i) {
    between += (points[places[i].second] - points[places[i - 1].second]).squaredNorm();
    all += 2.0 * points[places[i].second].squaredNorm();
  }
  return between / all;
}

// As of several curves that the points visit in turn.
bool is_rational(double turns) {
  constexpr int kLongest = 64;  // choices
  constexpr double kFromWhole = 1e-7;
  for (int q = 1; q <= kLongest; ++q) {
    if (std::abs(std::remainder(q * turns, 1.0)) < kFromWhole) return true;
  }
  return false;
}

// Of the rotation to which the motion on a closed curve is conjugate; NaN if it is on no such curve, or this is not
// seen. Where the points go round the curve once, they may go round the centre m times, in the plane in which they do
// so most evenly. The hammer has one plane.
double rotation_number(const Model& model, Observer& observer, const ModelTime& limit) {
  constexpr std::size_t kRotationImpacts = 4000, kFewest = 200;  // choices
  constexpr double kMostSpread = 0.9;      // a choice: 0.54 was the largest of a curve that goes round
  constexpr double kMostDisorder = 0.005;  // a choice: 3e-5 to 3e-3 on curves; 0.02 and more with another rotation
  constexpr int kMostRounds = 4;           // a choice
  constexpr int kPhase = 0, kExtension = 1, kVelocity = 2, kGapRate = 3;
  std::vector<Eigen::Vector4d> points;
  TipState first;
  while (points.size() < kRotationImpacts && observer.next(limit)) {
    const TipState state = observer.mark().state;
    if (points.empty()) first = state;
    points.push_back(section_difference(state, first));
  }
  if (points.size() < kFewest) return kNaN;
  points = standardised(std::move(points));
  Turns best = turns_in_plane(points, kPhase, kGapRate);
  if (model.kind == ModelKind::oscillator) {
    for (const int other : {kGapRate, kVelocity}) {
      const Turns turns = turns_in_plane(points, kExtension, other);
      if (turns.spread < best.spread) best = turns;
    }
  }
  if (!(best.spread < kMostSpread) || is_rational(best.mean)) return kNaN;
  for (int m = 1; m <= kMostRounds; ++m) {
    for (int k = 0; k < m; ++k) {
      const double turns = (best.mean + k) / m;
      if (disorder_on_circle(points, turns) < kMostDisorder) return std::abs(std::remainder(turns, 1.0));
    }
  }
  return kNaN;
}

// An exponent is zero, as on a torus or at a bifurcation, within 0.01/tau or within four standard errors. A choice: in
// 500 tau it converges to about 5/500.
constexpr double kNoGrowth = 0.01, kStandardErrors = 4.0;

AttractorKind kind_of(const LyapunovSpectrum& s) {
  if (s.outcome != LyapunovOutcome::measured) return AttractorKind::undecided;
  if (s.exponents[0] > std::max(kNoGrowth, kStandardErrors * s.std_errors[0])) return AttractorKind::chaotic;
  return std::abs(s.exponents[0]) <= kNoGrowth ? AttractorKind::quasi_periodic : AttractorKind::undecided;
}

// A largest exponent above zero by less than its error is measured again over longer times, on a copy.
void measure_longer(const Model& model, const Observer& observer, const Tip& tip, double duration, Attractor& found) {
  constexpr int kMost = 3;  // a choice: 64 times as long, and an eighth of the error
  constexpr double kLonger = 4.0;
  for (int i = 0; i < kMost && found.kind == AttractorKind::undecided && found.lyapunov.exponents[0] > kNoGrowth; ++i) {
    duration *= kLonger;
    Tip copy = tip;
    const LyapunovSpectrum longer = lyapunov(model, copy, {0.0, duration, observer.left(), 0.0});
    if (longer.outcome != LyapunovOutcome::measured) return;
    found.lyapunov = longer;
    found.kind = kind_of(longer);
  }
}

Period search_period(Observer& observer, const Tip& tip, const AttractorSettings& settings) {
  const ModelTime end = tip.now() + settings.duration;
  Period period;
  while (tip.now() < end && !observer.stopped() && period.marks == 0) {
    period = find_period(observer, tip.eta(), end, settings);
  }
  return period;
}

void describe(const Model& model, Tip& tip, const Period& period, Attractor& found) {
  found.kind = AttractorKind::periodic;
  found.impacts = period.impacts;
  found.cells = period.cells;
  found.contact_share = period.contact_share;
  if (period.impacts > 0) found.cells_per_impact = static_cast<double>(period.cells) / period.impacts;
  found.lyapunov = exponents_of(model, tip, period);
}

// The kind follows from the exponents. If all are negative, the orbit is periodic and has not converged yet.
void describe_unrepeated(const Model& model, Observer& observer, Tip& tip, const AttractorSettings& settings,
                         Attractor& found) {
  found.lyapunov = lyapunov(model, tip, {0.0, settings.duration, observer.left(), 0.0});
  found.kind = kind_of(found.lyapunov);
  measure_longer(model, observer, tip, settings.duration, found);
  if (found.lyapunov.outcome != LyapunovOutcome::measured || found.kind == AttractorKind::chaotic) return;
  if (find_slow_period(model, observer, tip, tip.now() + settings.duration, found)) return;
  if (found.kind == AttractorKind::quasi_periodic) {
    found.rotation_number = rotation_number(model, observer, tip.now() + settings.duration);
    return;
  }
  constexpr double kConvergence = 25.0;  // e^-25 = 1.4e-11: a displacement of 0.1 a is then below the tolerance
  if (!(found.lyapunov.exponents[0] < 0.0) || std::isinf(found.lyapunov.exponents[0])) return;
  observer.run_until(tip.now() + kConvergence / -found.lyapunov.exponents[0]);
  const Period period = search_period(observer, tip, settings);
  if (period.marks > 0) describe(model, tip, period, found);
}

}  // namespace

std::string Attractor::name() const {
  constexpr const char* kNames[] = {"", "quasi-periodic", "chaotic", "contact", "rest", "undecided"};
  if (kind == AttractorKind::periodic) return "period-" + std::to_string(impacts);
  return kNames[static_cast<std::size_t>(kind)];  // in the order of AttractorKind
}

Attractor find_attractor(const Model& model, Tip& tip, const AttractorSettings& settings) {
  Attractor found;
  const double most_events = kMostEventsPerTau * (settings.transient + settings.duration);
  Observer observer(tip, settings.most_events > 0 ? settings.most_events : static_cast<std::uint64_t>(most_events));
  observer.run_until(tip.now() + settings.transient);
  if (tip.eta() == 0.0) {
    if (model.gamma < 1.0 && !observer.stopped()) found.kind = AttractorKind::rest;
    found.contact_share = kNaN;
    return found;
  }
  const ModelTime begin = tip.now();
  const double contact_before = observer.contact_time();
  const int impacts_before = observer.mark().impacts;
  const Period period = search_period(observer, tip, settings);
  const double seen = tip.now() - begin;
  if (observer.stopped() || !(seen > 0.0)) return found;
  found.contact_share = share(observer.contact_time() - contact_before, seen);
  const int impacts = observer.mark().impacts - impacts_before;
  found.cells_per_impact = impacts > 0 ? std::abs(tip.eta()) * seen / impacts : 0.0;
  if (period.marks > 0) {
    describe(model, tip, period, found);
  } else {
    describe_unrepeated(model, observer, tip, settings, found);
  }
  if (found.contact_share > 0.5) found.kind = AttractorKind::contact;
  return found;
}

Attractor find_attractor(const Model& model, double eta, const TipState& start, const AttractorSettings& settings) {
  Tip tip(model, eta, start);
  return find_attractor(model, tip, settings);
}

}  // namespace afm
