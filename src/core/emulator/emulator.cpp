#include "afm/emulator.h"

#include <algorithm>
#include <cmath>

namespace afm {

std::vector<ParameterError> find_faults(const EmulatorSettings& s) {
  std::vector<ParameterError> faults = find_faults(s.model);
  for (const ParameterError& fault : find_faults(s.bath)) faults.push_back(fault);
  const auto require = [&](bool holds, const char* name, double value, const char* reason) {
    if (!holds) faults.emplace_back(name, value, reason);
  };
  require(std::abs(s.eta) <= kMaxEta, "eta", s.eta,
          "the drag velocity must be finite and at most 1000 lattice spacings per tau");
  require(s.sample_period >= 1e-9 && s.sample_period <= 1e6, "sample_period", s.sample_period,
          "must be between 1e-9 and 1e6 tau");
  require(s.samples_per_batch >= 1, "samples_per_batch", static_cast<double>(s.samples_per_batch),
          "must be at least 1");
  require(s.friction_window > 0.0 && std::isfinite(s.friction_window), "friction_window", s.friction_window,
          "must be positive and finite");
  require(s.impact_budget >= 1, "impact_budget", static_cast<double>(s.impact_budget), "must be at least 1");
  require(has_valid_tolerance({s.model.kind, s.contact_tolerance}), "contact_tolerance", s.contact_tolerance,
          "must be 0 (every bounce by itself), or between 1e-9 and 0.01");
  const FreeState& i = s.initial;
  const auto require_within = [&](const char* name, double value, double most, const char* reason) {
    require(std::abs(value) <= most, name, value, reason);
  };
  require_within("initial_phase", i.phase, 1e6, "must be finite");
  require_within("initial_extension", i.X, 10.0, "must be within 10 lattice spacings");
  require_within("initial_height", i.y, 100.0, "must be within 100 lattice spacings");
  require_within("initial_u", i.u, kMaxEta, "must be within 1000 lattice spacings per tau");
  require_within("initial_w", i.w, kMaxEta, "must be within 1000 lattice spacings per tau");
  if (faults.empty()) {
    require(to_tip_state(s.model.H, i).g >= 0.0, "initial_height", i.y, "the tip would start below the surface");
  }
  return faults;
}

namespace {

const EmulatorSettings& checked(const EmulatorSettings& settings) {
  const auto faults = find_faults(settings);
  if (!faults.empty()) throw faults.front();
  return settings;
}

}  // namespace

Emulator::Emulator(const EmulatorSettings& settings)
    : settings_(checked(settings)),
      eta_(settings.eta),
      tip_(settings.model, settings.eta, settings.initial, settings.contact_tolerance),
      friction_(settings.friction_window),
      grid_{settings.sample_period, 0, {}} {
  tip_.set_bath(settings.bath);
  friction_.restart(now_, eta_);
}

void Emulator::reset() {
  const bool sampling = sampling_;
  *this = Emulator(settings_);
  sampling_ = sampling;
}

void Emulator::drag(double eta) {
  // setting the current velocity again has no effect
  if (eta == eta_) return;
  tip_.drag(eta);
  eta_ = eta;
  friction_.restart(now_, eta);
}

double Emulator::set_level(const Level& level) {
  if (level == Level{settings_.model.kind, settings_.contact_tolerance}) return 0.0;
  const double dropped = tip_.set_model(level.kind, level.contact_tolerance);
  settings_.model.kind = level.kind;
  settings_.contact_tolerance = level.contact_tolerance;
  friction_.restart(now_, eta_);
  return dropped;
}

LiveSettings live_settings(const EmulatorSettings& s) {
  return {s.model.gamma, s.model.v_c, s.model.y0, s.sample_period, s.samples_per_batch, s.friction_window, s.bath};
}

void Emulator::change(const LiveSettings& live) {
  Model& model = settings_.model;
  if (live.friction_window != settings_.friction_window) friction_.set_window(now_, live.friction_window);
  if (live.gamma != model.gamma || live.v_c != model.v_c || live.y0 != model.y0) {
    model.gamma = live.gamma;
    model.v_c = live.v_c;
    model.y0 = live.y0;
    tip_.set_parameters(model);
    friction_.restart(now_, eta_);
  }
  if (live.bath != settings_.bath) {
    settings_.bath = live.bath;
    tip_.set_bath(live.bath);
    friction_.restart(now_, eta_);
  }
  if (live.sample_period != settings_.sample_period) grid_ = {live.sample_period, next_sample_, now_};
  settings_.sample_period = live.sample_period;
  settings_.samples_per_batch = live.samples_per_batch;
  settings_.friction_window = live.friction_window;
}

void Emulator::reserve(Batch& batch) const {
  batch.vertical.reserve(settings_.samples_per_batch);
  batch.lateral.reserve(settings_.samples_per_batch);
  batch.impacts.reserve(settings_.impact_budget);
}

ModelTime Emulator::next_boundary() const {
  // A boundary is the time of every samples_per_batch-th sample. An advance to an impact may have stopped before the
  // time of the next sample, even if that is at a boundary.
  const std::uint64_t n = settings_.samples_per_batch;
  const std::uint64_t last = grid_.first + (next_sample_ - grid_.first) / n * n;
  const ModelTime boundary = grid_.time(last);
  return now_ < boundary ? boundary : grid_.time(last + n);
}

Outcome Emulator::run_batch(Batch& batch) { return run_until(next_boundary(), batch); }

Outcome Emulator::run_until(const ModelTime& time, Batch& batch) {
  const Outcome outcome = run(time, settings_.impact_budget, batch);
  if (outcome == Outcome::time_limit) return outcome;
  ++counters_.budget_exhausted;
  return Outcome::budget_spent;
}

Outcome Emulator::run_impacts(std::uint64_t n, Batch& batch) {
  return run(next_boundary(), std::min(n, settings_.impact_budget), batch);
}

void Emulator::begin(Batch& batch) const {
  batch.begin = now_;
  batch.eta = eta_;
  batch.first_sample = next_sample_;
  batch.first_sample_time = grid_.time(next_sample_);
  batch.first_impact = impact_index_;
  batch.vertical.clear();
  batch.lateral.clear();
  batch.impacts.clear();
}

// The first sample that is not before `time`.
std::uint64_t Emulator::first_sample_from(const ModelTime& time) const {
  std::uint64_t n = next_sample_;
  const double pause = time - grid_.time(n);
  if (!(pause > 0.0)) return n;
  n += static_cast<std::uint64_t>(pause / grid_.period);
  while (n > next_sample_ && !(grid_.time(n - 1) < time)) --n;
  while (grid_.time(n) < time) ++n;
  return n;
}

void Emulator::sample_until(const ModelTime& time, Batch& batch) {
  const std::uint64_t end = first_sample_from(time);
  if (end == next_sample_) return;
  const std::size_t had = batch.vertical.size(), n = static_cast<std::size_t>(end - next_sample_);
  batch.vertical.resize(had + n);
  batch.lateral.resize(had + n);
  const double lowest = tip_.deflections(grid_, next_sample_, n, &batch.vertical[had], &batch.lateral[had]);
  counters_.worst_penetration = std::max(counters_.worst_penetration, -lowest);
  next_sample_ = end;
}

// Samples are taken segment by segment, before the next segment replaces the motion.
Outcome Emulator::run_segments(const ModelTime& end, std::uint64_t impacts, Batch& batch) {
  constexpr std::uint64_t kFailureCost = 100;  // [impacts] a choice: a batch with failed searches still ends soon
  Segments ended;
  for (std::uint64_t spent = 0; spent < impacts;) {
    const ModelTime segment_end = tip_.segment_end();
    if (sampling_) sample_until(segment_end < end ? segment_end : end, batch);
    const Outcome outcome = tip_.advance_segment(end, &ended);
    if (outcome == Outcome::time_limit) return outcome;
    for (const Segment& segment : ended) friction_.add(segment);
    if (outcome == Outcome::search_failed) {
      ++counters_.search_failures;
      spent += kFailureCost;
    }
    const bool event = outcome == Outcome::impact || outcome == Outcome::contact || outcome == Outcome::released;
    if (!event) continue;
    batch.impacts.push_back(tip_.last_impact());
    ++impact_index_;
    ++spent;
  }
  return Outcome::impact;
}

Outcome Emulator::run(const ModelTime& end, std::uint64_t impacts, Batch& batch) {
  begin(batch);
  const Outcome outcome = run_segments(end, impacts, batch);
  now_ = tip_.now();
  if (!sampling_) next_sample_ = first_sample_from(now_);  // samples are counted also if not computed
  batch.end = now_;
  batch.friction = friction_.estimate(now_, tip_.segment());
  return outcome;
}

}  // namespace afm
