// The values that the parameters may have.
#include <algorithm>
#include <cmath>

#include "afm/number_text.h"
#include "parameters.h"

namespace afm::node {
namespace {

constexpr double kMaxBatchRate = 1e3;     // [1/s]: above it the wake-ups of the system are what one measures
constexpr double kMaxImpactBudget = 1e6;  // 56 MB a batch
constexpr double kMinReserveMb = 16.0;    // room for the last chunk and the index of a long recording
constexpr double kMaxTimeout = 1e6;       // [s]: eleven days
constexpr double kLeastFrictionWindow = 1.0, kMostFrictionWindow = 1e9;  // [tau]

class Check {
 public:
  explicit Check(Faults& faults) : faults_(faults) {}

  void require(bool holds, const char* name, double value, const std::string& reason) {
    if (!holds) faults_.push_back({name, number_text(value), reason});
  }
  void require(bool holds, const char* name, const std::string& value, const std::string& reason) {
    if (!holds) faults_.push_back({name, '"' + value + '"', reason});
  }
  void within(const char* name, double value, double least, double most) {  // NaN is within nothing
    require(value >= least && value <= most, name, value,
            "must be between " + number_text(least) + " and " + number_text(most));
  }
  void zero_or_within(const char* name, double value, double least, double most) {
    require(value == 0.0 || (value >= least && value <= most), name, value,
            "must be 0, or between " + number_text(least) + " and " + number_text(most));
  }

 private:
  Faults& faults_;
};

double batch_of_model_time(const Parameters& p) { return static_cast<double>(samples_per_batch(p)) / p.sample_rate_hz; }

std::string from_a_batch_on(double batch) {
  return "between " + number_text(batch) + " (a batch, as commands take effect between batches) and " +
         number_text(kMaxTimeout);
}

void check_model(const Parameters& p, Check& check) {
  ModelKind kind;
  ToleranceOf of;
  const bool automatic = p.model == kAuto, given = p.tolerance > 0.0 && std::isfinite(p.tolerance);
  check.require(automatic || parse(p.model, kind), "model", p.model,
                "there is no such model: use oscillator, hammer or auto");
  check.require(parse(p.tolerance_of, of), "tolerance_of", p.tolerance_of,
                "there is no such quantity: use friction or deflection");
  check.require(given || (!automatic && p.tolerance == 0.0), "tolerance", p.tolerance,
                automatic ? "must be above 0 and finite: model auto takes the cheapest level whose error is below it"
                          : "must be above 0 and finite, or 0: none");
  check.zero_or_within("contact_tolerance", p.contact_tolerance, kMinContactTolerance, kMaxContactTolerance);
}

// In their ranges, these rates must fit together.
void check_rates(const Parameters& p, Check& check) {
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
  check.require(p.pace == kRealTime || p.pace == kLockstep, "pace", p.pace,
                "there is no such pace: use real_time or lockstep");
  check.require(p.wait_for == "nothing" || p.wait_for == kCommand, "wait_for", p.wait_for, "use nothing, or command");
  check.require(p.wait_for != kCommand || p.pace == kLockstep, "wait_for", p.wait_for, "needs pace = lockstep");
  check.within("command_wait_s", p.command_wait_s, 0.001, kMaxTimeout);
}

void check_recording(const Parameters& p, Check& check) {
  check.within("disk_reserve_mb", p.disk_reserve_mb, kMinReserveMb, 1e9);
  check.zero_or_within("split_size_mb", p.split_size_mb, 1.0, 1e9);  // a bag holds chunks of 0.8 MB
  check.zero_or_within("split_duration_s", p.split_duration_s, 0.1, 1e9);
  check.require(p.compression == "none" || p.compression == "lz4", "compression", p.compression,
                "there is no such compression: use none or lz4");
  check.require(!p.bag_directory.empty(), "bag_directory", p.bag_directory, "must name a directory");
}

void check_drag(const Parameters& p, Check& check) {
  const double most = most_drag_velocity(p.si);
  const bool limited = p.max_drag_velocity > 0.0 && p.max_drag_velocity <= most;
  check.require(limited, "max_drag_velocity", p.max_drag_velocity,
                "must be above 0 and at most " + number_text(most) + " m/s, a thousand lattice spacings per tau");
  const bool possible = std::abs(p.drag_velocity) <= most;  // false for NaN
  check.require(
      possible, "drag_velocity", p.drag_velocity,
      "must be finite and at most " + number_text(most) + " m/s, a thousand lattice spacings per tau of this lever");
  if (limited && possible) {
    check.require(!(std::abs(p.drag_velocity) > p.max_drag_velocity), "max_drag_velocity", p.max_drag_velocity,
                  "is below the drag velocity at start, drag_velocity = " + number_text(p.drag_velocity));
  }
  const double batch = std::chrono::duration<double>(batch_period(p)).count();
  check.require(p.command_timeout_s == 0.0 || (p.command_timeout_s >= batch && p.command_timeout_s <= kMaxTimeout),
                "command_timeout_s", p.command_timeout_s, "must be 0 (off), or " + from_a_batch_on(batch));
}

void check_scene(const Parameters& p, Check& check) {
  check.require(p.command_timeout_s == 0.0 || p.commands_eta.empty(), "command_timeout_s", p.command_timeout_s,
                "must be 0 with commands_eta: what the emulator plays itself is no command");
  const double velocity = Units(p.si).velocity(), batch = batch_of_model_time(p);
  for (const double eta : p.commands_eta) {
    const double commanded = std::abs(eta * velocity);
    check.require(commanded <= p.max_drag_velocity, "commands_eta", eta,
                  "is " + number_text(commanded) +
                      " m/s, beyond max_drag_velocity = " + number_text(p.max_drag_velocity) + " m/s");
  }
  check.require(p.commands_eta.empty() || (p.commands_hold_s >= batch && p.commands_hold_s <= kMaxTimeout),
                "commands_hold_s", p.commands_hold_s, "must be " + from_a_batch_on(batch));
}

// The core checks its settings in natural units: what is left to it is reported with the names and values that were
// given.
void check_settings(const Parameters& p, Check& check, Faults& faults) {
  check.within("friction_window_tau", p.friction_window_tau, kLeastFrictionWindow, kMostFrictionWindow);
  check.within("impact_budget", static_cast<double>(p.impact_budget), 1.0, kMaxImpactBudget);
  RunSettings settings = run_settings(p);
  // checked elsewhere
  settings.eta = 0.0;
  settings.friction_window = 1.0;
  settings.impact_budget = 1;
  settings.contact_tolerance = 0.0;
  settings.bath = {};
  add(afm::find_faults(p.bath, Units(p.si)), faults);
  for (const ParameterError& fault : afm::find_faults(settings)) {
    if (fault.name == "sample_period") {
      check.require(false, "sample_rate_hz", p.sample_rate_hz, "the time between two samples " + fault.reason);
    } else {
      add({fault}, faults);
    }
  }
}

}  // namespace

void add(const std::vector<ParameterError>& faults_of_core, Faults& faults) {
  for (const ParameterError& fault : faults_of_core) {
    faults.push_back({fault.name, number_text(fault.value), fault.reason});
  }
}

std::string describe(const Faults& faults) {
  std::string text;
  for (const Fault& fault : faults) {
    text += (text.empty() ? "" : "\n") + fault.name + " = " + fault.value + ": " + fault.reason;
  }
  return text;
}

// A faulty value that others are checked against is replaced by its default, so that all faults are found at once.
Faults find_faults(const Parameters& parameters) {
  Parameters p = parameters;
  Faults faults;
  Check check(faults);
  add(find_faults(p.si), faults);
  if (!faults.empty()) {  // the lever and the surface stay, if they are possible
    p.si.restitution_gamma = 1.0;
    p.si.cutoff_speed = p.si.rest_height_m = 0.0;
  }
  if (!find_faults(p.si).empty()) {
    p.si = SiModel{};
    p.initial.y = std::max(p.initial.y, Parameters{}.initial.y);  // it may be a valley of the other surface
  }
  check_model(p, check);
  const std::size_t before = faults.size();
  check.within("time_scale", p.time_scale, 1e-6, 100.0);
  check.within("batch_rate_hz", p.batch_rate_hz, 1.0, kMaxBatchRate);
  check.within("sample_rate_hz", p.sample_rate_hz, 1.0, kMaxSampleRate);
  if (faults.size() == before) check_rates(p, check);
  if (faults.size() > before) {
    const Parameters usual;
    p.time_scale = usual.time_scale;
    p.batch_rate_hz = usual.batch_rate_hz;
    p.sample_rate_hz = usual.sample_rate_hz;
  }
  check_pace(p, check);
  check_recording(p, check);
  check_drag(p, check);
  check_scene(p, check);
  check_settings(p, check, faults);
  return faults;
}

}  // namespace afm::node
