#include "afm/bath.h"

#include <cmath>
#include <tuple>

#include "fault_list.h"

namespace afm {
namespace {

// The hammer has no lateral spring.
double lateral_ratio(const Model& model) { return is_free_along_x(model) * model.frequency_ratio; }

// Whether the tip forgets so slowly that few kicks suffice: measured from Q = 100 on (docs/levers.md).
bool is_slow(const Bath& bath) {
  constexpr double kSlow = 100.0;
  const auto slow = [](double q) { return q == 0.0 || q >= kSlow; };
  return slow(bath.quality_factor) && slow(bath.lateral_quality_factor);
}

// Where the spring turns less than few_turns from kick to kick, the kicks follow its swing. Measured (docs/levers.md):
// at Q = 20 K_f is up to 19 % off, 0.055 of a turn from a lock, and 2 % at 0.07; at Q = 100 14 % at 0.02, 4 % at 0.055
// and 0.1 % at 0.07.
constexpr double kFewTurns = 0.39;
bool locks(const Model& model, const Bath& bath, double kicks_per_tau) {
  const double few_turns = is_slow(bath) ? 0.4 : kFewTurns, near = is_slow(bath) ? 0.06 : 0.11;
  const double turns = lateral_ratio(model) / kicks_per_tau;
  return turns > few_turns && std::abs(turns - 0.5 * std::round(2.0 * turns)) < near;
}

// The drag velocity near eta at which the holder passes a whole or half number of cells from kick to kick; 0: none.
double resonant_drag(double eta, double kicks_per_tau) {
  return 0.5 * std::round(2.0 * std::abs(eta) / kicks_per_tau) * kicks_per_tau;
}

// At it a kick meets the same one or two phases of the surface, and the start decides which. Beside it these phases
// move on by the difference. A choice: as slow as a cell in 100 tau.
bool locks_to_drag(double eta, double kicks_per_tau) {
  constexpr double kNear = 0.01;  // [a/tau]
  const double drag = resonant_drag(eta, kicks_per_tau);
  return drag > 0.0 && std::abs(std::abs(eta) - drag) <= kNear;
}

// Below it a kick takes more than this part of a velocity at once. On a slope it drives a sliding tip into the surface
// or off it, so that energy is lost: K_f by work was up to 0.3 of the part too large (docs/levers.md).
double least_kicks(const Model& model, const Bath& bath) {
  constexpr double kMostDamping = 0.11;
  const auto damping = [](double ratio, double q) { return q > 0.0 ? kTwoPi * ratio / q : 0.0; };  // [1/tau]
  return std::fmax(damping(1.0, bath.quality_factor), damping(lateral_ratio(model), bath.lateral_quality())) /
         kMostDamping;
}

}  // namespace

bool operator==(const Bath& a, const Bath& b) {
  const auto fields = [](const Bath& x) {
    return std::tie(x.temperature, x.quality_factor, x.lateral_quality_factor, x.kicks_per_tau, x.seed, x.stream);
  };
  return fields(a) == fields(b);
}

std::vector<ParameterError> find_faults(const Bath& b) {
  detail::FaultList list;
  const auto require_quality = [&](const char* name, double q, const char* zero) {
    if (q == 0.0 || (q >= kMinQualityFactor && std::isfinite(q))) return;
    list.faults.emplace_back(
        name, q, std::string("must be 0 (") + zero + "), or finite and at least " + number_text(kMinQualityFactor));
  };
  list.require_between(0.0, kMaxTemperature, "temperature", b.temperature, "kT must be", " m_tip a^2/tau^2");
  require_quality("quality_factor", b.quality_factor, "no bath");
  require_quality("lateral_quality_factor", b.lateral_quality_factor, "as the vertical one");
  list.require_between(kMinKickRate, kMaxKickRate, "kicks_per_tau", b.kicks_per_tau, "must be");
  return list.faults;
}

bool kicks_lock(const Model& model, const Bath& bath, double eta) {
  return bath.is_on() && (locks(model, bath, bath.kicks_per_tau) || locks_to_drag(eta, bath.kicks_per_tau));
}

double suitable_kicks(const Model& model, const Bath& bath, double eta) {
  constexpr double kGolden = 0.618034;   // 1.618 turns of the lateral spring from kick to kick: far from every lock
  constexpr double kLeastSection = 8.6;  // the least golden section that was measured (docs/levers.md)
  const double section = std::round(1000.0 * kGolden * lateral_ratio(model)) / 1000.0, least = least_kicks(model, bath);
  const std::vector<double> few{11.09, 29.034}, many{29.034, 46.979, 122.99};
  const bool section_locks = locks_to_drag(eta, section);
  if (is_slow(bath) && section >= kLeastSection && !section_locks) return section;
  for (const double kicks : is_slow(bath) ? few : many) {
    if (kicks >= least && !locks(model, bath, kicks) && !locks_to_drag(eta, kicks)) return kicks;
  }
  if (section >= std::fmax(least, many.front()) && !section_locks) return section;
  // no whole number, with which kicks come at the same phases of the drag again and again
  const double unlocked = lateral_ratio(model) / kFewTurns, most = kMaxKickRate - 1.0;
  const double kicks = unlocked > most ? section : std::fmin(std::ceil(std::fmax(least, unlocked)), most) + 0.618;
  return locks_to_drag(eta, kicks) ? kicks - 0.236 : kicks;  // its other golden section
}

std::vector<ParameterError> find_warnings(const Model& model, const Bath& bath, double eta) {
  if (!bath.is_on()) return {};
  if (model.kind == ModelKind::hammer && bath.quality_factor == 0.0) {
    return {ParameterError("lateral_quality_factor", bath.lateral_quality_factor,
                           "has no effect: the hammer has no lateral spring; give a quality factor")};
  }
  constexpr double kEnough = 0.9;  // of the rate that was measured
  const double advised = suitable_kicks(model, bath, eta), suitable = std::fmin(suitable_kicks(model, bath), advised);
  const double kicks = bath.kicks_per_tau;
  const auto warning = [&](const std::string& reason) {
    return std::vector<ParameterError>{ParameterError("kicks_per_tau", kicks, reason)};
  };
  const double usual = Bath{}.kicks_per_tau, damped = least_kicks(model, bath);
  const std::string give =
      "; give " + number_text(advised) + (advised < kEnough * damped ? ", though it is too low as well" : "");
  const std::string remedy = ": K_f may be wrong by a fifth and more" + give;
  if (locks(model, bath, kicks)) {
    return warning("locks to the swing of the lateral spring, as omega_h/omega_v = " +
                   number_text(std::round(1e4 * model.frequency_ratio) / 1e4) + remedy);
  }
  const double least = std::fmax(is_slow(bath) ? std::fmin(suitable, usual) : usual, std::fmin(suitable, damped));
  if (kicks < kEnough * least) return warning("is too low for these springs and quality factors" + remedy);
  if (kicks < kEnough * damped) {
    return warning(
        "is too low for these quality factors, and no rate is known that suits: K_f may be wrong by some per "
        "cent and more");
  }
  if (locks_to_drag(eta, kicks)) {
    constexpr int kFew = 6;
    return warning("locks to the drag near eta = " + rounded_text(resonant_drag(eta, kicks), kFew) +
                   ", where kicks meet the same phases of the surface: K_f depends on the start, by more than its "
                   "error says" +
                   give);
  }
  return {};
}

}  // namespace afm
