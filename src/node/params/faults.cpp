// What values the parameters may have, and what follows from them.
#include <algorithm>
#include <cmath>
#include <utility>

#include "afm/number_text.h"
#include "parameters.h"

namespace afm::node {
namespace {

constexpr double kMaxSampleRate = 1e6;       // [1/s]: ten samples a turn of the fastest spring of interest
constexpr double kMaxBatchRate = 1e3;        // [1/s]: above it the wake-ups of the system are what one measures
constexpr double kMaxWallSampleRate = 1e7;   // [1/s]: at time scales above 1, what subscribers can take
constexpr double kMaxSamplesPerBatch = 1e6;  // 16 MB a message
constexpr double kMaxImpactBudget = 1e6;     // 56 MB a batch
constexpr double kMinReserveMb = 16.0;       // room for the last chunk and the index of a long recording
constexpr double kMaxReserveMb = 1e9;
constexpr double kMaxTimeout = 1e6;          // [s]: eleven days

class Check {
 public:
  void require(bool holds, const char* name, double value, const std::string& reason) {
    if (!holds) faults_.push_back({name, number_text(value), reason});
  }
  // NaN is within nothing
  void within(const char* name, double value, double least, double most) {
    require(value >= least && value <= most, name, value,
            "must be between " + number_text(least) + " and " + number_text(most));
  }
  void add(const ParameterError& fault) { faults_.push_back({fault.name, number_text(fault.value), fault.reason}); }
  void add(Fault fault) { faults_.push_back(std::move(fault)); }
  bool none() const { return faults_.empty(); }
  Faults faults() const { return faults_; }

 private:
  Faults faults_;
};

void check_model(const Parameters& p, Check& check) {
  for (const ParameterError& fault : find_faults(p.si)) check.add(fault);
  ModelKind kind;
  if (p.model != kAuto && !parse(p.model, kind)) {
    check.add({"model", '"' + p.model + '"', "there is no such model: use oscillator, hammer or auto"});
  }
  ToleranceOf of;
  if (!parse(p.tolerance_of, of)) {
    check.add({"tolerance_of", '"' + p.tolerance_of + '"', "there is no such quantity: use friction or deflection"});
  }
  const bool given = p.tolerance > 0.0 && std::isfinite(p.tolerance);
  check.require(given || (p.model != kAuto && p.tolerance == 0.0), "tolerance", p.tolerance,
                p.model == kAuto
                    ? "must be above 0 and finite: model auto takes the cheapest level whose error is below it"
                    : "must be above 0 and finite, or 0: none");
  if (p.contact_tolerance != 0.0) {  // every bounce by itself
    check.within("contact_tolerance", p.contact_tolerance, kMinContactTolerance, kMaxContactTolerance);
  }
}

void check_rates(const Parameters& p, Check& check) {
  check.within("time_scale", p.time_scale, 1e-6, 100.0);
  check.within("batch_rate_hz", p.batch_rate_hz, 1.0, kMaxBatchRate);
  check.within("sample_rate_hz", p.sample_rate_hz, 1.0, kMaxSampleRate);
  if (!check.none()) return;
  const double wall_rate = p.sample_rate_hz * p.time_scale;
  check.require(p.time_scale < 1.0 || wall_rate >= p.batch_rate_hz, "sample_rate_hz", p.sample_rate_hz,
                "is below batch_rate_hz: a batch would hold no sample");
  check.require(wall_rate >= 1.0, "time_scale", p.time_scale,
                "leaves less than one sample a second of wall time: raise it or sample_rate_hz");
  check.require(wall_rate <= kMaxWallSampleRate, "time_scale", p.time_scale,
                "makes more than 1e7 samples a second of wall time: lower it or sample_rate_hz");
  check.require(wall_rate / p.batch_rate_hz <= kMaxSamplesPerBatch, "batch_rate_hz", p.batch_rate_hz,
                "makes batches of more than 1e6 samples: raise it or lower sample_rate_hz");
}

void check_pace(const Parameters& p, Check& check) {
  if (p.pace != kRealTime && p.pace != kLockstep) {
    check.add({"pace", '"' + p.pace + '"', "there is no such pace: use real_time or lockstep"});
  }
  const bool waits = p.wait_for == kCommand;
  if (!waits && p.wait_for != "nothing") {
    check.add({"wait_for", '"' + p.wait_for + '"', "use nothing, or command"});
  } else if (waits && p.pace != kLockstep) {
    check.add({"wait_for", "\"command\"", "needs pace = lockstep"});
  }
  check.within("command_wait_s", p.command_wait_s, 0.001, kMaxTimeout);
}

void check_recording(const Parameters& p, Check& check) {
  check.within("disk_reserve_mb", p.disk_reserve_mb, kMinReserveMb, kMaxReserveMb);
  // a bag holds chunks of 0.8 MB
  if (p.split_size_mb != 0.0) check.within("split_size_mb", p.split_size_mb, 1.0, 1e9);
  if (p.split_duration_s != 0.0) check.within("split_duration_s", p.split_duration_s, 0.1, 1e9);
  if (p.compression != "none" && p.compression != "lz4") {
    check.add({"compression", '"' + p.compression + '"', "there is no such compression: use none or lz4"});
  }
  if (p.bag_directory.empty()) check.add({"bag_directory", "\"\"", "must name a directory"});
}

void check_drag(const Parameters& p, Check& check) {
  const double most = kMaxEta * Units(p.si).velocity();
  const bool limited = p.max_drag_velocity > 0.0 && p.max_drag_velocity <= most;
  check.require(limited, "max_drag_velocity", p.max_drag_velocity,
                "must be above 0 and at most " + number_text(most) + " m/s, a thousand lattice spacings per tau");
  check.require(std::isfinite(p.drag_velocity), "drag_velocity", p.drag_velocity, "must be finite");
  if (limited && std::isfinite(p.drag_velocity)) {
    check.require(!(std::abs(p.drag_velocity) > p.max_drag_velocity), "max_drag_velocity", p.max_drag_velocity,
                  "is below the drag velocity at start, drag_velocity = " + number_text(p.drag_velocity));
  }
  const double batch = std::chrono::duration<double>(batch_period(p)).count();
  check.require(p.command_timeout_s == 0.0 || (p.command_timeout_s >= batch && p.command_timeout_s <= kMaxTimeout),
                "command_timeout_s", p.command_timeout_s,
                "must be 0 (off), or between " + number_text(batch) +
                    " (a batch, as commands take effect between batches) and " + number_text(kMaxTimeout));
}

void check_commands(const Parameters& p, Check& check) {
  const double most = p.max_drag_velocity / Units(p.si).velocity();
  for (const double eta : p.commands_eta) {
    check.require(std::abs(eta) <= most, "commands_eta", eta, "is beyond max_drag_velocity, which is " + number_text(most) + " a/tau");
  }
  const double batch = static_cast<double>(samples_per_batch(p)) / p.sample_rate_hz;
  check.require(p.commands_eta.empty() || (p.commands_hold_s >= batch && p.commands_hold_s <= kMaxTimeout),
                "commands_hold_s", p.commands_hold_s,
                "must be between " + number_text(batch) + " (a batch, as commands take effect between batches) and " +
                    number_text(kMaxTimeout));
}

// The core checks its settings in natural units. Reports its faults with the names and values that were given.
void check_settings(const Parameters& p, Check& check) {
  check.within("friction_window_tau", p.friction_window_tau, kLeastFrictionWindow, kMostFrictionWindow);
  check.within("impact_budget", static_cast<double>(p.impact_budget), 1.0, kMaxImpactBudget);
  RunSettings settings = run_settings(p);
  // reported already, with the user's names
  settings.eta = 0.0;
  settings.friction_window = 1.0;
  settings.impact_budget = 1;
  settings.contact_tolerance = 0.0;
  for (const ParameterError& fault : afm::find_faults(settings)) {
    if (fault.name == "temperature") {
      check.within("temperature_k", p.bath.temperature_k, 0.0, kMaxTemperature * Units(p.si).temperature());
    } else if (fault.name == "sample_period") {
      check.require(false, "sample_rate_hz", p.sample_rate_hz, "the time between two samples " + fault.reason);
    } else {
      check.add(fault);
    }
  }
}

}  // namespace

Faults find_faults(const Parameters& parameters) {
  Check model, rates, rest;
  check_model(parameters, model);
  check_rates(parameters, rates);
  check_pace(parameters, rest);
  check_recording(parameters, rest);
  // the rest is measured in the model's units, by the sample rate
  Parameters judged = parameters;
  if (!find_faults(parameters.si).empty()) judged.si = SiModel{};
  if (!rates.none()) {
    judged.time_scale = Parameters{}.time_scale;
    judged.batch_rate_hz = Parameters{}.batch_rate_hz;
    judged.sample_rate_hz = Parameters{}.sample_rate_hz;
  }
  check_drag(judged, rest);
  check_commands(judged, rest);
  check_settings(judged, rest);
  Faults faults = model.faults();
  for (const Check* check : {&rates, &rest}) {
    for (const Fault& fault : check->faults()) faults.push_back(fault);
  }
  return faults;
}

double least_sample_rate(const Parameters& p) {
  return std::max(1.0, (p.time_scale < 1.0 ? 1.0 : p.batch_rate_hz) / p.time_scale);
}

double most_sample_rate(const Parameters& p) {
  return std::min(
      {kMaxSampleRate, kMaxWallSampleRate / p.time_scale, kMaxSamplesPerBatch * p.batch_rate_hz / p.time_scale});
}

std::uint64_t samples_per_batch(const Parameters& p) {
  return static_cast<std::uint64_t>(std::max(1.0, std::round(p.sample_rate_hz * p.time_scale / p.batch_rate_hz)));
}

std::chrono::nanoseconds batch_period(const Parameters& p) {
  const double seconds = static_cast<double>(samples_per_batch(p)) / (p.sample_rate_hz * p.time_scale);
  return std::chrono::nanoseconds(std::llround(seconds * 1e9));
}

double to_eta(double drag_velocity, const SiModel& si) { return drag_velocity / Units(si).velocity(); }

RunSettings run_settings(const Parameters& p) {
  const Units units(p.si);
  RunSettings settings;
  settings.model = units.to_natural(p.si);
  settings.model.kind = full_level(p).kind;
  settings.bath = units.to_natural(p.bath);
  settings.eta = to_eta(p.drag_velocity, p.si);
  settings.initial = p.initial;
  settings.sample_period = 1.0 / (p.sample_rate_hz * units.time());
  settings.samples_per_batch = samples_per_batch(p);
  settings.friction_window = p.friction_window_tau;
  settings.impact_budget = p.impact_budget;
  settings.contact_tolerance = p.contact_tolerance;
  return settings;
}

Batch preallocated_batch(const Parameters& p) {
  Parameters fastest = p;
  fastest.sample_rate_hz = most_sample_rate(p);
  Batch batch;
  batch.vertical.reserve(samples_per_batch(fastest));
  batch.lateral.reserve(samples_per_batch(fastest));
  batch.impacts.reserve(p.impact_budget);
  return batch;
}

}  // namespace afm::node
