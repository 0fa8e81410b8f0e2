#include "node/params/advice.h"

#include <cmath>
#include <sstream>

#include "afm/number_text.h"

namespace afm::node {
namespace {

constexpr double kSlowBath = 100.0;  // from that Q on few kicks suffice
// pace of the trial run over what is needed: publishing and other programs take their part
constexpr double kSafePace = 1.2;

double frequency_ratio(const SiModel& si) { return si.omega_h_rad_per_s / si.omega_v_rad_per_s; }

// So many kicks per tau suffice from kSlowBath on (docs/levers.md): the golden section of omega_h/omega_v, so that they
// do not lock to the swing of the lateral spring; of a soft one those measured for mica.
double suitable_kicks(const SiModel& si) {
  constexpr double kGolden = 0.618034, kMica = 11.09, kLeast = 8.6;
  const double kicks = kGolden * frequency_ratio(si);
  return kicks < kLeast ? kMica : std::round(1000.0 * kicks) / 1000.0;
}

// Kicks near a whole or half number of turns of the lateral spring lock to its swing (docs/levers.md).
bool are_locked(const Parameters& p) {
  constexpr double kFewTurns = 0.4, kNear = 0.05;  // measured: 2 % of half a turn off, K_f is still 2 % wrong
  if (!run_settings(p).bath.is_on()) return false;
  const double turns = frequency_ratio(p.si) / p.bath.kicks_per_tau;
  return turns > kFewTurns && std::abs(turns - 0.5 * std::round(2.0 * turns)) < kNear;
}

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
  if (are_locked(p)) {
    traps.push_back(
        "kicks_per_tau = " + number_text(p.bath.kicks_per_tau) +
        " locks to the swing of the lateral spring, as omega_h/omega_v = " + rounded(frequency_ratio(p.si), 4) +
        ": K_f may be wrong by some per cent. Give kicks_per_tau = " + rounded(suitable_kicks(p.si), 5));
  }
  if (p.bath.temperature_k > 0.0 && !run_settings(p).bath.is_on()) {
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
  const double kicks = suitable_kicks(p.si), scale = 0.7 * pace;
  const double digit = std::pow(10.0, std::floor(std::log10(scale)));  // one digit, rounded down
  const bool fewer_suffice = p.bath.quality_factor >= kSlowBath && p.bath.kicks_per_tau > 1.1 * kicks;
  return "this run will not keep its pace: time_scale = " + number_text(p.time_scale) + ", and a trial run made " +
         rounded(pace, 2) + " times real time. Give time_scale = " + rounded(std::floor(scale / digit) * digit, 1) +
         ", a lower sample_rate_hz, a contact_tolerance up to 1e-2," +
         (fewer_suffice ? " kicks_per_tau = " + rounded(kicks, 5) + "," : "") + " or model = hammer";
}

}  // namespace afm::node
