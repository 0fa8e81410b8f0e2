#include "chain.h"

#include "afm/tip.h"
#include "common/cpu_clock.h"
#include "rivals/method.h"

namespace afm {
namespace {

class Stopwatch {
 public:
  explicit Stopwatch(double limit) : limit_(limit) {}
  double seconds() const { return thread_seconds() - start_; }
  // looks at the clock now and then only
  bool over() { return (++looks_ & 15) == 0 && seconds() > limit_; }

 private:
  double start_ = thread_seconds();
  double limit_;
  unsigned looks_ = 0;
};

constexpr double kPart = 8.0;  // [tau]
constexpr int kStuck = 1000;   // impacts without any time between them

Runner make_chain_runner(const Model& model, const TipState& start, const rivals::Method& method) {
  return
      [=, state = start, stuck = 0](double tau, double eta, std::uint64_t most_impacts, double most_seconds) mutable {
        ChainResult r;
        Stopwatch watch(most_seconds);
        while (r.tau < tau && r.impacts < most_impacts && r.finished && r.sound()) {
          // a part at a time: a method that crawls is stopped between them
          const double part = std::fmin(kPart, tau - r.tau);
          const rivals::Hit hit = method(model, eta, state, part);
          r.gave_up = hit.kind == rivals::Hit::gave_up;
          r.diverged = hit.kind == rivals::Hit::diverged;
          const double before = r.tau;
          r.tau += hit.kind == rivals::Hit::none ? part : hit.dt;
          if (hit.kind == rivals::Hit::impact) {
            r.energy += hit.energy_loss;
            ++r.impacts;
            stuck = r.tau > before ? 0 : stuck + 1;
          }
          if (r.sound()) state = hit.after;
          if (stuck >= kStuck) r.stuck = true;
          r.finished = !watch.over() && !r.stuck;
        }
        r.seconds = watch.seconds();
        r.end = state;
        return r;
      };
}

}  // namespace

Runner make_tip_runner(const Model& model, double start_eta, const TipState& start, double tolerance) {
  return [tip = Tip(model, start_eta, start, tolerance)](double tau, double eta, std::uint64_t most_impacts,
                                                         double most_seconds) mutable {
    ChainResult r;
    Stopwatch watch(most_seconds);
    const ModelTime begin = tip.now(), end = begin + tau;
    const std::uint64_t failures = tip.search_failures();
    if (eta != tip.eta()) tip.drag(eta);
    while (r.impacts < most_impacts && r.finished) {
      const Outcome outcome = tip.advance(end);
      if (outcome == Outcome::time_limit || outcome == Outcome::search_failed) break;
      if (outcome == Outcome::impact) {
        r.energy += tip.last_impact().energy_loss;
        r.impacts += tip.last_impact().count;
      }
      r.finished = !watch.over();
    }
    r.gave_up = tip.search_failures() > failures;
    r.seconds = watch.seconds();
    r.tau = tip.now() - begin;
    r.end = tip.tip_state();
    return r;
  };
}

double even_K_f(const Model& model) {
  const double s = kTwoPi * model.H;
  return 4.0 * (1.0 + model.gamma) / (1.0 - model.gamma) * s * s / (1.0 + s * s);
}

Runner make_runner(const std::string& method, double setting, const Model& model, double eta, const TipState& start) {
  if (method == "exact") return make_tip_runner(model, eta, start, setting);
  return make_chain_runner(model, start, rivals::find_method(method)->make(setting));
}

}  // namespace afm
