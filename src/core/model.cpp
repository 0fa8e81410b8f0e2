#include "afm/model.h"

#include <cmath>
#include <utility>

#include "fault_list.h"

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
  detail::FaultList list;
  list.require_between(kMinFrequencyRatio, kMaxFrequencyRatio, "frequency_ratio", m.frequency_ratio,
                       "omega_h/omega_v must be");
  list.require_between(kMinAmplitude, kMaxAmplitude, "H", m.H, "the surface amplitude must be", " lattice spacings");
  // a surface that is too flat is one fault; -infinity, which a height in SI units may become, is too far down
  list.require(m.y0 < std::fmax(m.H, kMinAmplitude), "y0", m.y0,
               "the holder must be at a finite height below the crest, or the tip hovers and never touches");
  if (m.y0 < kMinRestHeight) {
    list.faults.emplace_back("y0", m.y0,
                             "the holder must be at most " + number_text(-kMinRestHeight) + " lattice spacings down");
  }
  list.require_between(0.0, 1.0, "gamma", m.gamma, "the restitution must be");
  list.require(m.v_c >= 0.0 && std::isfinite(m.v_c), "v_c", m.v_c, "the cutoff speed must be finite and not negative");
  if (m.v_c > 0.0 && m.v_c < kMinCutoff) {
    list.faults.emplace_back("v_c", m.v_c,
                             "the cutoff speed must be 0 or at least " + number_text(kMinCutoff) + " a/tau");
  }
  return list.faults;
}

std::string describe(const std::vector<ParameterError>& faults) {
  std::string text;
  for (const ParameterError& fault : faults) text += std::string(text.empty() ? "" : "\n") + fault.what();
  return text;
}

}  // namespace afm
