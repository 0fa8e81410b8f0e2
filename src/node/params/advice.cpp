#include "node/params/advice.h"

#include <cmath>
#include <sstream>

#include "afm/number_text.h"

namespace afm::node {
namespace {

// pace of the trial run over what is needed: publishing and other programs take their part
constexpr double kSafePace = 1.2;

std::string rounded(double value, int digits) {
  std::ostringstream text;
  text.precision(digits);
  text << value;
  return text.str();
}

}  // namespace

std::string describe_tip(const Parameters& p) {
  std::ostringstream text;
  text << spring_constant(p.si) << " N/m at " << p.si.omega_v_rad_per_s / kTwoPi << " Hz, "
       << p.si.tip_mass_kg * std::pow(p.si.omega_h_rad_per_s, 2) << " N/m laterally, effective mass "
       << p.si.tip_mass_kg << " kg; load " << 0.0 - spring_constant(p.si) * p.si.rest_height_m
       << " N; tau = " << Units(p.si).time() << " s";
  return text.str();
}

std::vector<std::string> find_traps(const Parameters& p) {
  std::vector<std::string> traps;
  const RunSettings settings = run_settings(p);
  for (const ParameterError& trap : afm::find_traps(settings.model, settings.bath)) traps.emplace_back(trap.what());
  if (p.bath.temperature_k > 0.0 && !settings.bath.is_on()) {
    traps.push_back("temperature_k = " + number_text(p.bath.temperature_k) +
                    " has no effect: quality_factor is 0, so no heat reaches the tip");
  }
  if (p.command_timeout_s > 0.0 && p.pace == kLockstep && p.wait_for != kCommand) {
    traps.push_back("command_timeout_s = " + number_text(p.command_timeout_s) +
                    " has no effect: in lockstep the emulator waits for whoever steers");
  }
  return traps;
}

std::string find_pace_fault(const Parameters& p, double pace) {
  if (p.pace == kLockstep || pace > kSafePace * p.time_scale) return {};
  const RunSettings settings = run_settings(p);
  const double kicks = suitable_kicks(settings.model, settings.bath), scale = 0.7 * pace;
  const double digit = std::pow(10.0, std::floor(std::log10(scale)));  // one digit, rounded down
  const bool fewer_suffice = settings.bath.is_on() && p.bath.kicks_per_tau > 1.1 * kicks;
  return "this run will not keep its pace: time_scale = " + number_text(p.time_scale) + ", and a trial run made " +
         rounded(pace, 2) + " times real time. Give time_scale = " + rounded(std::floor(scale / digit) * digit, 1) +
         ", a lower sample_rate_hz, a contact_tolerance up to 1e-2," +
         (fewer_suffice ? " kicks_per_tau = " + rounded(kicks, 5) + "," : "") + " or model = hammer";
}

}  // namespace afm::node
