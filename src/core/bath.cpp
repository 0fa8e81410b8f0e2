#include "afm/bath.h"

#include <cmath>
#include <tuple>

#include "fault_list.h"

namespace afm {

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
    list.faults.emplace_back(name, q,
                             std::string("must be 0 (") + zero + "), or at least " + number_text(kMinQualityFactor));
  };
  list.require_between(0.0, kMaxTemperature, "temperature", b.temperature, "kT must be", " m a^2/tau^2");
  require_quality("quality_factor", b.quality_factor, "no bath");
  require_quality("lateral_quality_factor", b.lateral_quality_factor, "as the vertical one");
  list.require_between(kMinKickRate, kMaxKickRate, "kicks_per_tau", b.kicks_per_tau, "must be");
  return list.faults;
}

}  // namespace afm
