#include "afm/run.h"

#include <algorithm>
#include <cmath>

namespace afm {

std::vector<ParameterError> find_faults(const RunSettings& s) {
  std::vector<ParameterError> faults = find_faults(s.model);
  const bool has_surface = faults.empty();
  for (const ParameterError& fault : find_faults(s.bath)) faults.push_back(fault);
  const auto require = [&](bool holds, const char* name, double value, const char* reason) {
    if (!holds) faults.emplace_back(name, value, reason);
  };
  require(std::abs(s.eta) <= kMaxEta, "eta", s.eta,
          "the drag velocity must be finite and at most 1000 lattice spacings per tau");
  require(s.sample_period >= 1e-9 && s.sample_period <= 1e6, "sample_period", s.sample_period,
          "must be between 1e-9 and 1e6 tau");
  // a batch is kept in memory: 160 MB of samples, 560 MB of impacts at most
  const auto require_count = [&](const char* name, std::uint64_t n) {
    require(n >= 1 && n <= 10000000, name, static_cast<double>(n), "must be between 1 and 10 million");
  };
  require_count("samples_per_batch", s.samples_per_batch);
  require_count("impact_budget", s.impact_budget);
  require(s.friction_window >= 1e-9 && s.friction_window <= 1e15, "friction_window", s.friction_window,
          "must be between 1e-9 and 1e15 tau");
  require(is_contact_tolerance(s.contact_tolerance), "contact_tolerance", s.contact_tolerance,
          "must be 0 (every bounce by itself), or between 1e-9 and 0.01");
  const FreeState& i = s.initial;
  const auto require_within = [&](const char* name, double value, double most, const char* reason) {
    require(std::abs(value) <= most, name, value, reason);
  };
  constexpr double kMaxPhase = 1e6, kMaxHeight = 100.0;
  require_within("initial_phase", i.phase, kMaxPhase, "must be within a million lattice spacings");
  require_within("initial_extension", i.X, 10.0, "must be within 10 lattice spacings");
  require_within("initial_height", i.y, kMaxHeight, "must be within 100 lattice spacings");
  require_within("initial_u", i.u, kMaxEta, "must be within 1000 lattice spacings per tau");
  require_within("initial_w", i.w, kMaxEta, "must be within 1000 lattice spacings per tau");
  if (has_surface && std::abs(i.y) <= kMaxHeight && std::abs(i.phase) <= kMaxPhase) {
    const TipState at_rest = to_tip_state(s.model.H, {i.phase, 0.0, i.y, 0.0, 0.0});
    require(at_rest.g >= 0.0, "initial_height", i.y, "the tip would start below the surface");
  }
  return faults;
}

namespace {

// True if the n-th time of the grid is the next one at `now`.
bool is_next(const SampleGrid& grid, std::uint64_t n, const ModelTime& now) {
  return n >= grid.first && is_possible(grid.origin) && grid.origin <= now && now <= grid.time_or_end(n) &&
         grid.time_or_end(n) < kEndOfTime && (n == grid.first || grid.time(n - 1) <= now);
}

}  // namespace

std::vector<ParameterError> find_faults(const Snapshot& s) {
  std::vector<ParameterError> faults = find_faults(s.settings);
  for (const ParameterError& fault : find_faults(s.tip, s.settings.model)) faults.push_back(fault);
  const auto require = [&](bool holds, const char* name, double value, const char* reason) {
    if (!holds) faults.emplace_back(name, value, reason);
  };
  const ModelTime& now = s.tip.time;
  require(s.samples.period == s.settings.sample_period && is_next(s.samples, s.next_sample, now), "samples",
          static_cast<double>(s.next_sample), "is not the number of samples that are due at the time of the snapshot");
  require(!s.settings.bath.is_on() || (s.kicks.period == 1.0 / s.settings.bath.kicks_per_tau &&
                                       s.kick_count >= s.kicks.first && is_next(s.kicks, s.kick_count + 1, now)),
          "kicks", static_cast<double>(s.kick_count), "is not the number of kicks up to the time of the snapshot");
  require(is_possible(s.holder.since) && s.holder.since <= now && std::isfinite(s.holder.from), "holder", s.holder.from,
          "its path does not begin before the snapshot");
  require(s.friction.is_possible(now, s.settings.eta, s.settings.friction_window), "friction",
          s.friction.sums().start - ModelTime{},
          "the sums of the friction estimate are not of a run up to the time of the snapshot");
  require(s.tip.phase != TipSnapshot::Phase::chatter || s.settings.contact_tolerance > 0.0, "contact_tolerance",
          s.settings.contact_tolerance, "must be above 0 in a chatter sequence");
  return faults;
}

namespace {

template <class Settings>
const Settings& checked(const Settings& settings) {
  const auto faults = find_faults(settings);
  if (!faults.empty()) throw faults.front();
  return settings;
}

}  // namespace

Run::Run(const RunSettings& settings)
    : settings_(checked(settings)),
      tip_(settings.model, settings.eta, settings.initial, settings.contact_tolerance),
      holder_{{}, settings.initial.phase - tip_.tip_state().X},  // a hammer has no extension
      friction_(settings.friction_window),
      grid_{settings.sample_period, 0, {}} {
  tip_.set_bath(settings.bath);
  friction_.restart({}, settings.eta);
}

Run::Run(const Snapshot& s)
    : settings_(checked(s).settings),
      tip_(settings_.model, settings_.eta, s.tip, settings_.contact_tolerance,
           Thermostat(settings_.bath, settings_.model.frequency_ratio, s.kicks, s.kick_count)),
      holder_(s.holder),
      friction_(s.friction),
      grid_(s.samples),
      next_sample_(s.next_sample),
      impact_index_(s.next_impact) {}

Snapshot Run::split() {
  friction_.add(tip_.segment());
  const Thermostat& kicks = tip_.thermostat();
  const Snapshot snapshot{settings_,    tip_.snapshot(), grid_,   next_sample_, impact_index_,
                          kicks.grid(), kicks.count(),   holder_, friction_};
  tip_ = Tip(settings_.model, settings_.eta, snapshot.tip, settings_.contact_tolerance, Thermostat(kicks));
  return snapshot;
}

double Run::apply(const RunSettings& settings) {
  const RunSettings old = settings_;
  settings_ = settings;
  settings_.model.H = old.model.H;
  settings_.model.frequency_ratio = old.model.frequency_ratio;
  settings_.initial = old.initial;
  settings_.impact_budget = old.impact_budget;
  const RunSettings& s = settings_;
  double dropped = 0.0;
  const bool new_model = s.model.gamma != old.model.gamma || s.model.v_c != old.model.v_c || s.model.y0 != old.model.y0;
  const bool new_level = s.model.kind != old.model.kind || s.contact_tolerance != old.contact_tolerance;
  const bool new_bath = s.bath != old.bath, acts = new_bath && (s.bath.is_on() || old.bath.is_on());
  if (new_model) {
    Model model = s.model;
    model.kind = old.model.kind;
    tip_.set_parameters(model);
  }
  if (new_bath) tip_.set_bath(s.bath);
  if (new_level) dropped = change_level(old);
  if (s.eta != old.eta) {
    holder_ = {now(), holder_.position(now(), old.eta)};
    tip_.drag(s.eta);
  }
  if (s.friction_window != old.friction_window) friction_.set_window(now(), s.friction_window);
  if (new_model || new_level || acts || s.eta != old.eta) friction_.restart(now(), s.eta);
  if (s.sample_period != old.sample_period) grid_ = {s.sample_period, next_sample_, now()};
  return dropped;
}

double Run::change_level(const RunSettings& old) {
  const FreeState before = tip_.state();
  const ModelKind kind = settings_.model.kind;
  const double dropped = tip_.set_model(kind, settings_.contact_tolerance);
  if (kind == ModelKind::hammer && old.model.kind != kind) {
    // the holder is moved above the tip; a chatter sequence that ends there may displace the tip a little
    const double displacement = std::remainder(tip_.state().phase - before.phase, 1.0);
    holder_ = {now(), holder_.position(now(), old.eta) + before.X + displacement};
  }
  return dropped;
}

ModelTime Run::next_boundary() const {
  // A boundary is the time of every samples_per_batch-th sample. An advance to an impact may have stopped before the
  // time of the next sample, even if that is at a boundary.
  const std::uint64_t n = settings_.samples_per_batch;
  const std::uint64_t last = grid_.first + (next_sample_ - grid_.first) / n * n;
  const ModelTime boundary = grid_.time(last);
  return now() < boundary ? boundary : grid_.time(last + n);
}

Outcome Run::advance(Batch& batch) {
  const Outcome outcome = advance(next_boundary(), settings_.impact_budget, batch);
  if (outcome == Outcome::budget_spent) ++counters_.budget_exhausted;
  return outcome;
}

Outcome Run::advance(const ModelTime& limit, std::uint64_t impacts, Batch& batch) {
  const ModelTime boundary = next_boundary();
  begin(batch);
  const Outcome outcome = run_segments(limit < boundary ? limit : boundary, impacts, batch);
  batch.end = now();
  batch.impulse += tip_.segment().impulse;
  batch.impact_limit = outcome == Outcome::budget_spent ? impacts : 0;
  batch.friction = friction_.estimate(now(), tip_.segment());
  return outcome;
}

void Run::begin(Batch& batch) const {
  batch.begin = now();
  batch.eta = settings_.eta;
  batch.impulse = -tip_.segment().impulse;  // the part of the segment under way that is of earlier batches
  batch.first_sample = next_sample_;
  batch.first_sample_time = grid_.time(next_sample_);
  batch.holder = holder_.position(batch.first_sample_time, settings_.eta);
  batch.first_impact = impact_index_;
  batch.vertical.clear();
  batch.lateral.clear();
  batch.impacts.clear();
}

// The first sample that is not before `time`.
std::uint64_t Run::first_sample_from(const ModelTime& time) const {
  std::uint64_t n = next_sample_;
  const double pause = time - grid_.time(n);
  if (!(pause > 0.0)) return n;
  n += static_cast<std::uint64_t>(pause / grid_.period);
  while (n > next_sample_ && !(grid_.time(n - 1) < time)) --n;
  while (grid_.time(n) < time) ++n;
  return n;
}

void Run::sample_until(const ModelTime& time, Batch& batch) {
  const std::uint64_t end = first_sample_from(time);
  if (end == next_sample_) return;
  const std::size_t had = batch.vertical.size(), n = static_cast<std::size_t>(end - next_sample_);
  batch.vertical.resize(had + n);
  batch.lateral.resize(had + n);
  const double lowest = tip_.deflections(grid_, next_sample_, n, &batch.vertical[had], &batch.lateral[had]);
  friction_.add_samples(&batch.vertical[had], n);
  counters_.worst_penetration = std::max(counters_.worst_penetration, -lowest);
  next_sample_ = end;
}

// Samples are taken segment by segment, before the next segment replaces the motion.
Outcome Run::run_segments(const ModelTime& end, std::uint64_t impacts, Batch& batch) {
  constexpr std::uint64_t kFailureCost = 100;  // [impacts] a choice: a batch with failed searches still ends soon
  Segments ended;
  for (std::uint64_t spent = 0; spent < impacts;) {
    const ModelTime segment_end = tip_.segment_end();
    sample_until(segment_end < end ? segment_end : end, batch);
    const Outcome outcome = tip_.advance_segment(end, &ended);
    if (outcome == Outcome::time_limit) return outcome;
    for (const Segment& segment : ended) {
      friction_.add(segment);
      batch.impulse += segment.impulse;
    }
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
  return Outcome::budget_spent;
}

}  // namespace afm
