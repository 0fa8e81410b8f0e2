#include "afm/model.h"

#include <cmath>
#include <utility>

#include "afm/number_text.h"

namespace afm {

ParameterError::ParameterError(std::string name_, double value_, std::string reason_)
    : std::invalid_argument(name_ + " = " + number_text(value_) + ": " + reason_),
      name(std::move(name_)),
      value(value_),
      reason(std::move(reason_)) {}

bool parse(const std::string& name, ModelKind& kind) {
  if (name != "oscillator" && name != "hammer") return false;
  kind = name == "hammer" ? ModelKind::hammer : ModelKind::oscillator;
  return true;
}

const char* name(ModelKind kind) { return kind == ModelKind::hammer ? "hammer" : "oscillator"; }

std::vector<ParameterError> find_faults(const Model& m) {
  std::vector<ParameterError> faults;
  // every condition is false for NaN
  const auto require = [&](bool holds, const char* name, double value, const char* reason) {
    if (!holds) faults.emplace_back(name, value, reason);
  };
  require(m.frequency_ratio >= kMinFrequencyRatio && m.frequency_ratio <= kMaxFrequencyRatio, "frequency_ratio",
          m.frequency_ratio, "omega_h/omega_v must be between 0.01 and 1000");
  require(m.H >= kMinAmplitude && m.H <= kMaxAmplitude, "H", m.H,
          "the surface amplitude must be between 1e-6 and 1 lattice spacings");
  require(std::isfinite(m.y0) && m.y0 < m.H, "y0", m.y0,
          "the holder must be at a finite height below the crest, or the tip hovers and never touches");
  require(m.y0 >= kMinRestHeight, "y0", m.y0, "the holder must be at most 100000 lattice spacings down");
  require(m.gamma >= 0.0 && m.gamma <= 1.0, "gamma", m.gamma, "the restitution must be between 0 and 1");
  require(m.v_c >= 0.0 && std::isfinite(m.v_c), "v_c", m.v_c, "the cutoff speed must be finite and not negative");
  require(!(m.v_c > 0.0) || m.v_c >= kMinCutoff, "v_c", m.v_c, "the cutoff speed must be 0 or at least 1e-9 a/tau");
  return faults;
}

std::string describe(const std::vector<ParameterError>& faults) {
  std::string text;
  for (const ParameterError& fault : faults) text += std::string(text.empty() ? "" : "\n") + fault.what();
  return text;
}

}  // namespace afm
