#include "node/params/advice.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <sstream>

#include "afm/number_text.h"

namespace afm::node {
namespace {

// pace of the trial run over what is needed: publishing and other programs take their part
constexpr double kSafePace = 1.2;

// The first is for caches and the transient of the initial state; the second is long enough for a tenth.
constexpr double kWarmUp = 5e-3, kTrial = 20e-3;  // [s]
constexpr std::uint64_t kTrialImpacts = 1000;     // at once, so that the clock is read often enough

// Processor time of this process, whose other threads still wait [s]: the wall clock measures other programs too.
double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// Model time that passes [tau] in so many seconds, over these seconds.
double advance_for(double seconds, Run& run, Batch& batch, std::uint64_t impacts) {
  const double begin = processor_seconds();
  const ModelTime start = run.now();
  double now = begin;
  for (; now - begin < seconds; now = processor_seconds()) run.advance(run.now() + 1.0, impacts, batch);
  return (run.now() - start) / (now - begin);
}

// At how many phases of tau all samples are taken, where these are very few; else 0.
int phases_of_samples(double samples_per_tau) {
  constexpr int kVeryFew = 4;
  constexpr double kSame = 1e-4;  // [tau]
  for (int phases = 1; phases <= kVeryFew; ++phases) {
    const double turns = phases / samples_per_tau;
    if (std::round(turns) >= 1.0 && std::abs(turns - std::round(turns)) < kSame) return phases;
  }
  return 0;
}

}  // namespace

std::string describe_tip(const Parameters& p) {
  std::ostringstream text;
  text << spring_constant(p.si) << " N/m at " << p.si.omega_v_rad_per_s / kTwoPi << " Hz, "
       << p.si.tip_mass_kg * std::pow(p.si.omega_h_rad_per_s, 2) << " N/m laterally, effective mass "
       << p.si.tip_mass_kg << " kg; load " << 0.0 - spring_constant(p.si) * p.si.rest_height_m
       << " N; tau = " << Units(p.si).time() << " s";
  const double vertical = p.bath.quality_factor, lateral = p.bath.lateral_quality_factor;
  if (vertical > 0.0) text << "; Q = " << vertical;
  if (lateral > 0.0) text << "; lateral Q = " << lateral;
  if (vertical > 0.0 || lateral > 0.0) {
    text << " at " << p.bath.temperature_k << " K, " << p.bath.kicks_per_tau << " kicks a tau";
  }
  return text.str();
}

std::vector<std::string> find_warnings(const Parameters& p) {
  std::vector<std::string> warnings;
  const RunSettings settings = run_settings(p);
  std::vector<double> etas = p.commands_eta;
  etas.insert(etas.begin(), settings.eta);
  for (const double eta : etas) {
    for (const ParameterError& warning : afm::find_warnings(settings.model, settings.bath, eta)) {
      if (std::find(warnings.begin(), warnings.end(), warning.what()) == warnings.end())
        warnings.emplace_back(warning.what());
    }
  }
  if (p.bath.temperature_k > 0.0 && !settings.bath.is_on()) {
    warnings.push_back("temperature_k = " + number_text(p.bath.temperature_k) +
                       " has no effect: quality_factor is 0, so no heat reaches the tip");
  }
  const int phases = phases_of_samples(p.sample_rate_hz * Units(p.si).time());
  if (phases > 0) {
    warnings.push_back("sample_rate_hz = " + number_text(p.sample_rate_hz) + ": samples see tau at " +
                       std::to_string(phases) +
                       " of its phases alone, so means of them, such as the mean normal force, may "
                       "be far off: give a rate that is a few per cent less");
  }
  if (p.tolerance > 0.0 && p.model != kAuto) {
    warnings.push_back("tolerance = " + number_text(p.tolerance) + " has no effect: model is " + p.model +
                       ", not auto");
  }
  if (p.command_timeout_s > 0.0 && p.pace == kLockstep && p.wait_for != kCommand) {
    warnings.push_back("command_timeout_s = " + number_text(p.command_timeout_s) +
                       " has no effect: in lockstep the emulator waits for whoever steers");
  }
  if (p.pace == kLockstep && (p.split_size_mb > 0.0 || p.split_duration_s > 0.0)) {
    warnings.emplace_back(
        "split_size_mb, split_duration_s: a new bag begins with a snapshot, which rounds the motion, at a time that "
        "depends on the disk: in lockstep two runs differ from there on");
  }
  return warnings;
}

Run trial_run(const Parameters& p) {
  RunSettings settings = run_settings(p);
  Run run(settings);
  const Level level = choose_level(p, settings).level;
  settings.model.kind = level.kind;
  settings.contact_tolerance = level.contact_tolerance;
  const double extension = longest_extension(run.settings().model);
  const bool slips = kTwoPi * extension > 1.0 && settings.eta != 0.0;
  if (slips && !settings.bath.is_on()) {
    RunSettings fast = settings;
    fast.eta = std::copysign(std::min(1.0 + extension, kMaxEta), settings.eta);
    run.apply(fast);
    Batch batch = preallocated_batch(p);
    run.advance(run.now() + 1.0, kTrialImpacts, batch);
  }
  run.apply(settings);
  return run;
}

double measure_times_real_time(const Parameters& p) {
  Run run = trial_run(p);
  Batch batch = preallocated_batch(p);
  advance_for(kWarmUp, run, batch, kTrialImpacts);
  return advance_for(kTrial, run, batch, kTrialImpacts) * Units(p.si).time();
}

std::string find_speed_warning(const Parameters& p, double times_real_time) {
  constexpr double kMargin = 0.7;      // a choice: publishing and other programs take their part
  constexpr double kWorthFewer = 1.1;  // a choice: fewer kicks are advised where they are at least a tenth fewer
  if (p.pace == kLockstep || times_real_time > kSafePace * p.time_scale) return {};
  const RunSettings settings = run_settings(p);
  const double kicks = suitable_kicks(settings.model, settings.bath, settings.eta);
  const bool more_needed =
      p.bath.kicks_per_tau < kicks && !afm::find_warnings(settings.model, settings.bath, settings.eta).empty();
  // a run with more kicks takes at most so much more time
  const double scale = kMargin * times_real_time * (more_needed ? p.bath.kicks_per_tau / kicks : 1.0);
  const double digit = std::pow(10.0, std::floor(std::log10(scale)));  // one digit, rounded down
  const bool fewer_suffice = settings.bath.is_on() && p.bath.kicks_per_tau > kWorthFewer * kicks;
  return "this run will not keep its pace: time_scale = " + number_text(p.time_scale) + ", and a trial run made " +
         rounded_text(times_real_time, 2) +
         " times real time. Give time_scale = " + rounded_text(std::floor(scale / digit) * digit, 2) +
         (more_needed ? " with kicks_per_tau = " + number_text(kicks) : "") +
         (fewer_suffice ? ", kicks_per_tau = " + rounded_text(kicks, 5) : "") +
         (p.contact_tolerance < kMaxContactTolerance ? ", a contact_tolerance up to 1e-2" : "") +
         (p.model != "hammer" ? ", model = hammer" : "") + ", or a lower sample_rate_hz";
}

}  // namespace afm::node
