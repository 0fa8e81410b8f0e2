#include "stress_scene.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace afm {
namespace {

constexpr double kMostImbalance = 1e-9;
constexpr double kMostDepth = 1e-15;                // [a], times the largest height if that is more than 1 a
constexpr std::uint64_t kMostArcsInATau = 1000000;  // far more than any tau needs: a stall

}  // namespace

StressScene::StressScene(std::uint64_t seed, double contact_tolerance, bool mica)
    : seed_(seed),
      mica_(mica),
      random_(seed),
      model_(random_model()),
      eta_(random_eta()),
      tip_(model_, eta_, random_start(), contact_tolerance),
      ledger_(model_, tip_) {}

Model StressScene::random_model() {
  Model m;
  if (mica_) m.v_c = std::pow(10.0, within(-3.0, -1.0));
  if (mica_) return m;
  m.gamma = one_in(8) ? 0.0 : one_in(8) ? 1.0 : within(0.0, 1.0);
  m.v_c = one_in(8) ? 0.0 : std::pow(10.0, within(-4.0, 1.0));
  if (one_in(2)) m.y0 = one_in(4) ? 0.999999 * m.H : one_in(4) ? -10.0 : within(-1.0, m.H);
  if (one_in(4)) m.frequency_ratio = within(0.5, 20.0);
  return m;
}

double StressScene::random_eta() {
  if (one_in(10)) return 0.0;
  if (one_in(10)) return one_in(2) ? 1.0 : -1.0;
  // where the drag meets the horizontal spring most is lost, and most happens
  const double slow = mica_ && one_in(8) ? 6.0 : 0.0, fast = slow > 0.0 ? 6.5 : 9.0;
  const double size = mica_ ? within(slow, fast) : std::pow(10.0, within(-6.0, 2.0));
  return one_in(2) ? size : -size;
}

FreeState StressScene::random_start() {
  return {within(0.0, 1.0), within(-0.05, 0.05), model_.H + within(1e-6, 0.2), eta_ + within(-1.0, 1.0),
          within(-1.0, 1.0)};
}

bool StressScene::violated(const std::string& what) {
  violation_ = what;
  return false;
}

bool StressScene::check_depth(const ModelTime& t) {
  const Deflection d = tip_.deflection(t);
  if (!std::isfinite(d.vertical) || !std::isfinite(d.lateral) || !std::isfinite(d.gap)) return violated("not finite");
  const double height = std::max(1.0, std::abs(d.vertical));
  count_.deepest = std::max(count_.deepest, -d.gap / height);
  return -d.gap <= kMostDepth * height || violated("the gap is " + std::to_string(d.gap * 1e15) + "e-15");
}

bool StressScene::check_depths(const ModelTime& begin, const ModelTime& end) {
  constexpr int kSamples = 6;
  constexpr double kGoldenSection = 0.6180339887498949;  // its multiples fall evenly and never twice on the same part
  for (int i = 0; i < kSamples; ++i) {
    sample_ = std::fmod(sample_ + kGoldenSection, 1.0);
    const ModelTime t = begin + sample_ * (end - begin);
    if (t < end && !check_depth(t)) return false;
  }
  return true;
}

// A burst enters the books when it ends.
bool StressScene::check_energy() {
  if (ledger_.bursting()) return true;
  const double part = std::abs(ledger_.imbalance(tip_)) / ledger_.turnover(tip_);
  count_.worst_imbalance = std::max(count_.worst_imbalance, part);
  return part <= kMostImbalance ||
         violated("energy from nothing: " + std::to_string(part * 1e9) + "e-9 of the turnover");
}

bool StressScene::check_rate() {
  if (tip_.now().tau != tau_) arcs_this_tau_ = 0;
  tau_ = tip_.now().tau;
  count_.most_arcs_in_a_tau = std::max(count_.most_arcs_in_a_tau, ++arcs_this_tau_);
  return arcs_this_tau_ <= kMostArcsInATau || violated("it stalls");
}

void StressScene::enter(Outcome outcome) {
  ++count_.arcs;
  if (outcome == Outcome::contact) ++count_.contacts;
  if (outcome != Outcome::impact) return;
  ++count_.impacts;
  count_.bounces += tip_.last_impact().count;
  if (tip_.last_impact().kind == ImpactKind::burst) ++count_.bursts;
}

bool StressScene::arc(const ModelTime& limit, Outcome& outcome) {
  const ModelTime begin = tip_.now(), arc_end = tip_.arc_end(), end = arc_end < limit ? arc_end : limit;
  if (arc_end < begin) return violated("an arc ends before it begins");
  if (!check_depths(begin, end)) return false;
  outcome = ledger_.advance_arc(tip_, limit);
  enter(outcome);
  if (outcome == Outcome::search_failed) return violated("the search failed");
  if (tip_.now() < begin) return violated("time ran backwards");
  const TipState s = tip_.tip_state();
  if (!std::isfinite(s.phase + s.X + s.u + s.g + s.g1)) return violated("not finite");
  return check_energy() && check_rate();
}

bool StressScene::run(std::int64_t tau) {
  const ModelTime end{tau, 0.0};
  while (tip_.now() < end) {
    const ModelTime command = tip_.now() + std::exponential_distribution<double>(1.0)(random_);
    Outcome outcome = Outcome::flying;
    while (outcome != Outcome::time_limit) {
      if (!arc(command, outcome)) return false;
    }
    eta_ = one_in(20) ? eta_ : random_eta();  // the same again now and then
    tip_.drag(eta_);
    ++count_.commands;
  }
  return true;
}

std::string StressScene::report() const {
  const TipState s = tip_.tip_state();
  std::ostringstream text;
  text.precision(17);
  text << violation_ << "\n  --seed " << seed_ << (mica_ ? " --mica" : "") << " --scenes 1, at " << tip_.now().tau << " + " << tip_.now().phase
       << "\n  gamma " << model_.gamma << " v_c " << model_.v_c << " y0 " << model_.y0 << " ratio "
       << model_.frequency_ratio << " eta " << tip_.eta() << "\n  phase " << s.phase << " X " << s.X << " u " << s.u
       << " g " << s.g << " g1 " << s.g1
       << (tip_.in_contact()    ? " in contact"
           : ledger_.bursting() ? " in a burst"
                                : "");
  return text.str();
}

}  // namespace afm
