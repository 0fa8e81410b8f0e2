#include "chain.h"

#include <utility>

#include "afm/tip.h"
#include "common/cpu_clock.h"

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

class TipRunner : public Runner {
 public:
  TipRunner(const Model& model, double eta, const TipState& start, double tolerance)
      : tip_(model, eta, start, tolerance) {}

  ChainResult run(double tau, double eta, std::uint64_t most_impacts, double most_seconds) override {
    ChainResult r;
    Stopwatch watch(most_seconds);
    const ModelTime begin = tip_.now(), end = begin + tau;
    const std::uint64_t failures = tip_.search_failures();
    if (eta != tip_.eta()) tip_.drag(eta);
    while (r.impacts < most_impacts && r.finished) {
      const Outcome outcome = tip_.advance(end);
      if (outcome == Outcome::time_limit || outcome == Outcome::search_failed) break;
      if (outcome == Outcome::impact) {
        r.energy += tip_.last_impact().energy_loss;
        r.impacts += tip_.last_impact().count;
      }
      r.finished = !watch.over();
    }
    r.gave_up = tip_.search_failures() > failures;
    r.seconds = watch.seconds();
    r.tau = tip_.now() - begin;
    r.end = tip_.tip_state();
    return r;
  }

 private:
  Tip tip_;
};

class ChainRunner : public Runner {
 public:
  ChainRunner(const Model& model, const TipState& start, rivals::Method method)
      : model_(model), state_(start), method_(std::move(method)) {}

  ChainResult run(double tau, double eta, std::uint64_t most_impacts, double most_seconds) override {
    ChainResult r;
    Stopwatch watch(most_seconds);
    while (r.tau < tau && r.impacts < most_impacts && r.finished && r.sound()) {
      // a part at a time: a method that crawls is stopped between them
      const double part = std::fmin(kPart, tau - r.tau);
      const rivals::Hit hit = method_(model_, eta, state_, part);
      r.gave_up = hit.kind == rivals::Hit::gave_up;
      r.diverged = hit.kind == rivals::Hit::diverged;
      const double before = r.tau;
      r.tau += hit.kind == rivals::Hit::none ? part : hit.dt;
      if (hit.kind == rivals::Hit::impact) {
        r.energy += hit.energy_loss;
        ++r.impacts;
        stuck_ = r.tau > before ? 0 : stuck_ + 1;
      }
      if (r.sound()) state_ = hit.after;
      if (stuck_ >= kStuck) r.stuck = true;
      r.finished = !watch.over() && !r.stuck;
    }
    r.seconds = watch.seconds();
    r.end = state_;
    return r;
  }

 private:
  static constexpr double kPart = 8.0;  // [tau]
  static constexpr int kStuck = 1000;   // impacts without any time between them
  Model model_;
  TipState state_;
  rivals::Method method_;
  int stuck_ = 0;
};

}  // namespace

std::unique_ptr<Runner> make_tip_runner(const Model& model, double eta, const TipState& start, double tolerance) {
  return std::make_unique<TipRunner>(model, eta, start, tolerance);
}

std::unique_ptr<Runner> make_runner(const std::string& method, double setting, const Model& model, double eta,
                                    const TipState& start) {
  if (method == "exact") return make_tip_runner(model, eta, start, setting);
  return std::make_unique<ChainRunner>(model, start, rivals::find_method(method)->make(setting));
}

}  // namespace afm
