// Our certified loop without its special routes: Lemmas 1 to 3 of docs/algorithm.md, a finish by Newton's steps and
// halves, and double-double where rounding hides the result. No lookahead, no steps above the crest, no series. What
// the routes of the shipped search are worth is the difference to `exact`.
#include "afm/reflection.h"
#include "core/search/double_double.h"
#include "core/search/impact_search.h"
#include "core/search/impact_steps.h"
#include "method.h"

namespace afm::rivals {

using namespace detail;

namespace {

// Inside [low, high] from time s, on which the gap falls from positive to negative.
template <class T>
Landing<T> finish_plainly(const Flight<T>& f, const T& s, T low, T high) {
  using std::abs;
  constexpr int kMaxSteps = 120;  // by halves alone: every bit of a double-double
  T t = (low + high) / T(2.0);
  for (int i = 1; i <= kMaxSteps; ++i) {
    GapJet<T> jet = f.gap(s + t);
    const T newton = t - jet.g / jet.g1;
    if (abs(jet.g) <= f.gap_error(s + t) && jet.g1 < T(0.0)) {
      return {SearchOutcome::impact, s + newton, f.gap(s + newton), i + 1};
    }
    (jet.g > T(0.0) ? low : high) = t;
    t = low < newton && newton < high ? newton : T((low + high) / T(2.0));
  }
  return {SearchOutcome::undecided, s, f.gap(s), kMaxSteps};
}

// Lemma 2 holds for a start on the surface too: the parabola is g1 t + (g2 + c S/3) t^2/2 there.
template <class T>
T leave(const Flight<T>& f, const T& trial) {
  using std::min;
  const T low = min(T(0.0), third_derivative_over(f, f.start(), trial).low);
  return T(0.999) * min(trial, first_root(T(0.0), f.start().g1, T(f.start().g2 + divide(T(low * trial), 3.0)), trial));
}

template <class T>
Landing<T> find_plainly(const Flight<T>& f, const T& horizon, const T& from) {
  T s = from, trial(0.05);
  const bool on_surface = !(f.start().g > T(0.0)) && !(from > T(0.0));
  if (on_surface && f.start().g1 < T(0.0)) return {SearchOutcome::impact, T(0.0), f.start(), 0};
  if (on_surface) s = leave(f, trial);
  for (int evaluations = 1; evaluations <= kMaxSearchSteps; ++evaluations) {
    if (!(s < horizon)) return {SearchOutcome::clear, horizon, f.start(), evaluations};
    const GapJet<T> jet = f.gap(s);
    const T error = f.gap_error(s);
    const RootInterval<T> root = certify_root(f, jet, error);
    if (root.certain) return finish_plainly(f, s, root.low, root.high);
    const T step = safe_step(f, jet, error, trial);
    if (!(step > T(4.0) * epsilon<T>() * s)) return {SearchOutcome::undecided, s, jet, evaluations};
    s = s + step;
    trial = T(2.0) * step;
  }
  return {SearchOutcome::cap, s, f.gap(s), kMaxSearchSteps};
}

Hit hit_of(const Model& model, double eta, SearchOutcome outcome, double s, const GapJet<double>& jet) {
  const Reflection r = reflect(model, eta, jet);
  return outcome == SearchOutcome::impact ? Hit{Hit::impact, s, r.after, r.energy_loss}
                                          : Hit{Hit::gave_up, s, r.after, 0.0};
}

Hit decide_in_double_double(const Model& model, double eta, const TipState& start, double horizon, double from) {
  const Flight<DoubleDouble> f(SpringConstants<DoubleDouble>(model), DoubleDouble(eta), start);
  const Landing<DoubleDouble> l = find_plainly(f, DoubleDouble(horizon), DoubleDouble(from));
  const double s = static_cast<double>(l.s);
  if (l.outcome == SearchOutcome::clear) return {Hit::none, horizon, f.tip_state(DoubleDouble(horizon)), 0.0};
  const auto d = [](const DoubleDouble& x) { return static_cast<double>(x); };
  const GapJet<DoubleDouble>& j = l.jet;
  const FlightState<DoubleDouble>& q = j.state;
  return hit_of(model, eta, l.outcome, s,
                {d(j.g), d(j.g1), d(j.g2), d(j.g3), {d(q.phase), d(q.X), d(q.U), d(q.Y), d(q.W)}, d(j.h), d(j.h1)});
}

Hit next_plainly(const Model& model, double eta, const TipState& start, double horizon) {
  const Flight<double> f(SpringConstants<double>(model), eta, start);
  const Landing<double> l = find_plainly(f, horizon, 0.0);
  if (l.s > horizon || l.outcome == SearchOutcome::clear) return {Hit::none, horizon, f.tip_state(horizon), 0.0};
  if (l.outcome == SearchOutcome::impact) return hit_of(model, eta, l.outcome, l.s, l.jet);
  return decide_in_double_double(model, eta, start, horizon, l.s);
}

}  // namespace

MethodSpec certified_plain_spec() {
  return {"certified_plain", {0.0}, 0.0, [](double) { return next_plainly; }};
}

}  // namespace afm::rivals
