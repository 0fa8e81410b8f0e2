#include "stress_scene.h"

#include <algorithm>

#include "afm/run.h"

namespace afm {
namespace {

constexpr double kBatch = 63.66;                   // [tau] of the node: 10 ms
constexpr double kBetweenShippedCommands = 128.0;  // [tau] of scripts/soak

}  // namespace

StressScene::StressScene(std::uint64_t seed, Kind kind)
    : seed_(seed),
      kind_(kind),
      random_(seed),
      has_bath_((kind == Kind::any || kind == Kind::lever) && one_in(2)),
      model_(random_model()),
      eta_(random_eta()),
      tip_(model_, eta_, random_start(), kDefaultContactTolerance) {
  if (has_bath_) tip_.set_bath(random_bath());
}

// A choice: levers and crystals beyond those in config/, each way.
Model StressScene::random_lever() {
  lever_.omega_v_rad_per_s = kTwoPi * decades(5e3, 100e3);
  lever_.omega_h_rad_per_s = within(1.5, 40.0) * lever_.omega_v_rad_per_s;
  lever_.tip_mass_kg = decades(0.01, 5.0) / (lever_.omega_v_rad_per_s * lever_.omega_v_rad_per_s);
  lever_.lattice_spacing_m = within(0.2e-9, 0.6e-9);
  lever_.surface_amplitude_m = within(0.01e-9, 0.1e-9);
  lever_.restitution_gamma = one_in(4) ? within(0.3, 1.0) : 0.7;
  Model m = Units(lever_).to_natural(lever_);
  m.y0 = random_rest_height();
  return m;
}

// The rest height [a] under no load, or under 10 pN to 100 nN.
double StressScene::random_rest_height() {
  const double load = one_in(6) ? 0.0 : decades(0.01e-9, 100e-9);
  return -load / (spring_constant(lever_) * lever_.lattice_spacing_m);
}

Bath StressScene::random_bath() {
  if (one_in(6)) return {};
  if (kind_ == Kind::any) {
    Bath bath;
    bath.temperature = one_in(4) ? 0.0 : decades(1e-6, kMaxTemperature);
    bath.quality_factor = decades(kMinQualityFactor, 1e6);
    bath.lateral_quality_factor = one_in(2) ? 0.0 : decades(kMinQualityFactor, 1e6);
    bath.kicks_per_tau = decades(kMinKickRate, 300.0);
    bath.seed = seed_;
    return bath;
  }
  SiBath bath;
  bath.temperature_k = one_in(4) ? 0.0 : within(4.0, 400.0);
  bath.quality_factor = decades(2.0, 1000.0);
  bath.kicks_per_tau = one_in(3) ? bath.kicks_per_tau : 0.618 * model_.frequency_ratio;  // as docs/levers.md advises
  bath.seed = seed_;
  return Units(lever_).to_natural(bath);
}

Model StressScene::random_model() {
  if (kind_ == Kind::lever) return random_lever();
  Model m;
  if (kind_ == Kind::mica) m.v_c = decades(1e-3, 0.1);
  if (kind_ != Kind::any) return m;
  m.gamma = one_in(8) ? 0.0 : one_in(8) ? 1.0 : within(0.0, 1.0);
  m.v_c = one_in(8) ? 0.0 : decades(1e-4, 10.0);
  if (one_in(2)) m.y0 = one_in(4) ? 0.999999 * m.H : one_in(4) ? -10.0 : within(-1.0, m.H);
  if (one_in(4)) m.frequency_ratio = within(0.5, 20.0);
  return m;
}

double StressScene::random_eta() {
  if (one_in(10)) return 0.0;
  if (kind_ != Kind::shipped && one_in(10)) return one_in(2) ? 1.0 : -1.0;
  const double size = kind_ == Kind::mica      ? mica_eta()
                      : kind_ == Kind::shipped ? decades(1e-4, 10.0)
                      : kind_ == Kind::lever   ? decades(1e-9, 100e-6) / Units(lever_).velocity()  // from [m/s]
                                               : decades(1e-6, 100.0);
  return one_in(2) ? size : -size;
}

// Where the drag meets the horizontal spring most is lost, and most happens.
double StressScene::mica_eta() {
  const double slow = one_in(8) ? 6.0 : 0.0, fast = slow > 0.0 ? 6.5 : 9.0;
  return within(slow, fast);
}

FreeState StressScene::random_start() {
  if (kind_ == Kind::lever && is_held_down(model_)) return lowered_tip(model_.H);
  return {within(0.0, 1.0), within(-0.05, 0.05), model_.H + within(1e-6, 0.2), eta_ + within(-1.0, 1.0),
          within(-1.0, 1.0)};
}

bool StressScene::run(std::int64_t tau) {
  const ModelTime end{tau, 0.0};
  const double between = kind_ == Kind::shipped ? kBetweenShippedCommands : 1.0;
  while (tip_.tip().now() < end) {
    const ModelTime next = tip_.tip().now() + std::exponential_distribution<double>(1.0 / between)(random_);
    while (batch_begin_ + kBatch < next) {
      if (!tip_.advance(batch_begin_ + kBatch) || !keeps_budget()) return false;
    }
    if (!tip_.advance(next)) return false;
    command();
  }
  return true;
}

// The same again now and then; now and then a row of them at once.
void StressScene::command() {
  if (has_bath_ && one_in(8)) return tip_.set_bath(random_bath());
  if (kind_ == Kind::lever && one_in(4)) {
    if (one_in(4)) model_.gamma = within(0.3, 1.0);
    if (one_in(4)) model_.v_c = decades(1e-5, 1.0);
    model_.y0 = random_rest_height();
    return tip_.set_parameters(model_);
  }
  for (int n = kind_ == Kind::shipped && one_in(100) ? 20 : 1; n > 0; --n) {
    eta_ = one_in(20) ? eta_ : random_eta();
    tip_.drag(eta_);
  }
}

// A batch is over.
bool StressScene::keeps_budget() {
  const std::uint64_t events = tip_.count().events - events_before_;
  batch_begin_ = batch_begin_ + kBatch;
  events_before_ = tip_.count().events;
  most_events_ = std::max(most_events_, events);
  spent_ = kind_ == Kind::shipped && events >= RunSettings{}.impact_budget;
  return !spent_;
}

std::string StressScene::report() const {
  const char* const options[] = {"", " --mica", " --shipped", " --levers"};
  return (spent_ ? "a batch spends its budget: " + std::to_string(most_events_) + " events" : "") + tip_.violation() +
         "\n  again by: --seed " + std::to_string(seed_) + options[static_cast<int>(kind_)] + " --scenes 1";
}

}  // namespace afm
