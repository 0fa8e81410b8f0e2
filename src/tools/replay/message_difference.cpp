#include "message_difference.h"

#include <algorithm>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <utility>
#include <vector>

#include "node/parameters/live_parameters.h"
#include "node/wire/message_conversion.h"

namespace afm::replay {
namespace {

std::uint64_t bits_of(double value) {
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

std::string to_text(double value) {
  char text[64];
  std::snprintf(text, sizeof text, "%.17g (bits %016" PRIx64 ")", value, bits_of(value));
  return text;
}
std::string to_text(const std::string& value) { return '"' + value + '"'; }
template <class Integer>
std::string to_text(Integer value) {
  return std::to_string(value);
}

bool same(double a, double b) { return bits_of(a) == bits_of(b); }
template <class T>
bool same(const T& a, const T& b) {
  return a == b;
}

// Notes the first field that differs.
class Comparison {
 public:
  template <class T>
  void field(const std::string& name, const T& a, const T& b) {
    if (found_ || same(a, b)) return;
    found_ = FieldDifference{name, to_text(a), to_text(b), index_};
  }
  void field(const std::string& name, const afm_emulator::ModelTime& a, const afm_emulator::ModelTime& b) {
    field(name + ".tau", a.tau, b.tau);
    field(name + ".phase", a.phase, b.phase);
  }
  void field(const std::string& name, const std::vector<double>& a, const std::vector<double>& b) {
    field("size of " + name, a.size(), b.size());
    if (found_ || a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0) return;
    for (index_ = 0; !found_ && index_ < a.size(); ++index_) field(name, a[index_], b[index_]);
  }
  void field(const std::string& name, const std::vector<std::uint64_t>& a, const std::vector<std::uint64_t>& b) {
    field("size of " + name, a.size(), b.size());
    for (index_ = 0; !found_ && index_ < a.size(); ++index_) field(name, a[index_], b[index_]);
  }
  void at(std::size_t index) { index_ = index; }
  const std::optional<FieldDifference>& found() const { return found_; }

 private:
  std::optional<FieldDifference> found_;
  std::size_t index_ = 0;
};

void compare(const afm_emulator::Impact& a, const afm_emulator::Impact& b, Comparison& c) {
  c.field("impacts.time", a.time, b.time);
  c.field("impacts.kind", a.kind, b.kind);
  c.field("impacts.count", a.count, b.count);
  c.field("impacts.surface_phase", a.surface_phase, b.surface_phase);
  c.field("impacts.normal_speed", a.normal_speed, b.normal_speed);
  c.field("impacts.tangential_velocity", a.tangential_velocity, b.tangential_velocity);
  c.field("impacts.energy_loss", a.energy_loss, b.energy_loss);
}

template <class Applied>
void compare_levels(const std::string& message, const Applied& a, const Applied& b, Comparison& c) {
  c.field(message + ".model", a.model, b.model);
  c.field(message + ".contact_tolerance", a.contact_tolerance, b.contact_tolerance);
  c.field(message + ".expected_error", a.expected_error, b.expected_error);
  c.field(message + ".energy_dropped", a.energy_dropped, b.energy_dropped);
}

template <class Told>
void compare_live(const std::string& message, const Told& a, const Told& b, Comparison& c) {
  const node::LiveParameters first = node::to_live(a), second = node::to_live(b);
  for (const node::LiveField& field : node::kLiveFields) {
    c.field(message + "." + field.name, first.*field.value, second.*field.value);
  }
}

}  // namespace

std::optional<FieldDifference> find_difference(const afm_emulator::Deflection& a, const afm_emulator::Deflection& b) {
  Comparison c;
  c.field("deflection.first_sample", a.first_sample, b.first_sample);
  c.field("deflection.time", a.time, b.time);
  c.field("deflection.sample_period", a.sample_period, b.sample_period);
  c.field("deflection.vertical", a.vertical, b.vertical);
  c.field("deflection.lateral", a.lateral, b.lateral);
  return c.found();
}

std::optional<FieldDifference> find_difference(const afm_emulator::ImpactArray& a, const afm_emulator::ImpactArray& b) {
  Comparison c;
  c.field("impacts.first_index", a.first_index, b.first_index);
  for (std::size_t i = 0; i < a.impacts.size() && i < b.impacts.size() && !c.found(); ++i) {
    c.at(i);
    compare(a.impacts[i], b.impacts[i], c);
  }
  c.at(std::min(a.impacts.size(), b.impacts.size()));
  c.field("number of impacts", a.impacts.size(), b.impacts.size());
  return c.found();
}

std::optional<FieldDifference> find_difference(const afm_emulator::Friction& a, const afm_emulator::Friction& b) {
  Comparison c;
  c.field("friction.time", a.time, b.time);
  c.field("friction.drag_velocity", a.drag_velocity, b.drag_velocity);
  c.field("friction.eta", a.eta, b.eta);
  c.field("friction.energy_loss", a.energy_loss, b.energy_loss);
  c.field("friction.impact_count", a.impact_count, b.impact_count);
  c.field("friction.force", a.force, b.force);
  c.field("friction.force_std_error", a.force_std_error, b.force_std_error);
  c.field("friction.k_f", a.k_f, b.k_f);
  c.field("friction.k_f_std_error", a.k_f_std_error, b.k_f_std_error);
  c.field("friction.k_f_tau_per_m", a.k_f_tau_per_m, b.k_f_tau_per_m);
  c.field("friction.window_force", a.window_force, b.window_force);
  c.field("friction.window_k_f", a.window_k_f, b.window_k_f);
  c.field("friction.window_k_f_std_error", a.window_k_f_std_error, b.window_k_f_std_error);
  return c.found();
}

std::optional<FieldDifference> find_difference(const afm_emulator::AppliedDrag& a, const afm_emulator::AppliedDrag& b) {
  Comparison c;
  c.field("applied_drag.epoch", a.epoch, b.epoch);
  c.field("applied_drag.time", a.time, b.time);
  c.field("applied_drag.first_impact", a.first_impact, b.first_impact);
  c.field("applied_drag.drag_velocity", a.drag_velocity, b.drag_velocity);
  compare_levels("applied_drag", a, b, c);
  return c.found();
}

std::optional<FieldDifference> find_difference(const afm_emulator::AppliedParameters& a,
                                               const afm_emulator::AppliedParameters& b) {
  Comparison c;
  c.field("applied_parameters.epoch", a.epoch, b.epoch);
  c.field("applied_parameters.time", a.time, b.time);
  c.field("applied_parameters.first_impact", a.first_impact, b.first_impact);
  c.field("applied_parameters.first_sample", a.first_sample, b.first_sample);
  c.field("applied_parameters.first_command", a.first_command, b.first_command);
  compare_live("applied_parameters", a, b, c);
  c.field("applied_parameters.samples_per_batch", a.samples_per_batch, b.samples_per_batch);
  c.field("applied_parameters.sample_period_tau", a.sample_period_tau, b.sample_period_tau);
  compare_levels("applied_parameters", a, b, c);
  return c.found();
}

std::optional<FieldDifference> find_difference(const afm_emulator::Configuration& a,
                                               const afm_emulator::Configuration& b) {
  using Message = afm_emulator::Configuration;
  Comparison c;
  c.field("configuration.version", a.version, b.version);
  c.field("configuration.arithmetic_digest", a.arithmetic_digest, b.arithmetic_digest);
  c.field("configuration.model", a.model, b.model);
  c.field("configuration.tolerance", a.tolerance, b.tolerance);
  c.field("configuration.tolerance_of", a.tolerance_of, b.tolerance_of);
  c.field("configuration.level_table", a.level_table, b.level_table);
  const std::pair<const char*, double Message::*> numbers[] = {{"omega_v_rad_per_s", &Message::omega_v_rad_per_s},
                                                               {"omega_h_rad_per_s", &Message::omega_h_rad_per_s},
                                                               {"tip_mass_kg", &Message::tip_mass_kg},
                                                               {"lattice_spacing_m", &Message::lattice_spacing_m},
                                                               {"surface_amplitude_m", &Message::surface_amplitude_m},
                                                               {"rest_height_m", &Message::rest_height_m},
                                                               {"restitution_gamma", &Message::restitution_gamma},
                                                               {"cutoff_speed", &Message::cutoff_speed},
                                                               {"initial_phase", &Message::initial_phase},
                                                               {"initial_extension", &Message::initial_extension},
                                                               {"initial_height", &Message::initial_height},
                                                               {"initial_u", &Message::initial_u},
                                                               {"initial_w", &Message::initial_w},
                                                               {"drag_velocity", &Message::drag_velocity},
                                                               {"max_drag_velocity", &Message::max_drag_velocity},
                                                               {"time_scale", &Message::time_scale},
                                                               {"batch_rate_hz", &Message::batch_rate_hz},
                                                               {"sample_rate_hz", &Message::sample_rate_hz},
                                                               {"sample_period", &Message::sample_period},
                                                               {"sample_period_tau", &Message::sample_period_tau},
                                                               {"friction_window_tau", &Message::friction_window_tau},
                                                               {"contact_tolerance", &Message::contact_tolerance}};
  for (const auto& [name, member] : numbers) c.field(std::string("configuration.") + name, a.*member, b.*member);
  c.field("configuration.samples_per_batch", a.samples_per_batch, b.samples_per_batch);
  c.field("configuration.impact_budget", a.impact_budget, b.impact_budget);
  return c.found();
}

namespace {

void compare(const afm_emulator::Digest& a, const afm_emulator::Digest& b, Comparison& c) {
  using Message = afm_emulator::Digest;
  c.field("digest.epoch", a.epoch, b.epoch);
  c.field("digest.time", a.time, b.time);
  const std::pair<const char*, std::uint64_t Message::*> figures[] = {
      {"configuration_digest", &Message::configuration_digest},
      {"first_sample", &Message::first_sample},
      {"samples", &Message::samples},
      {"impacts", &Message::impacts},
      {"commands", &Message::commands},
      {"estimates", &Message::estimates},
      {"commands_digest", &Message::commands_digest},
      {"samples_digest", &Message::samples_digest},
      {"impacts_digest", &Message::impacts_digest},
      {"estimates_digest", &Message::estimates_digest}};
  for (const auto& [name, member] : figures) c.field(std::string("digest.") + name, a.*member, b.*member);
}

}  // namespace

std::optional<FieldDifference> find_difference(const afm_emulator::Digest& a, const afm_emulator::Digest& b) {
  Comparison c;
  compare(a, b, c);
  return c.found();
}

std::optional<FieldDifference> find_difference(const afm_emulator::Checkpoint& a, const afm_emulator::Checkpoint& b) {
  Comparison c;
  c.field("checkpoint.epoch", a.epoch, b.epoch);
  c.field("checkpoint.time", a.time, b.time);
  c.field("checkpoint.impacts", a.impacts, b.impacts);
  c.field("checkpoint.samples", a.samples, b.samples);
  c.field("checkpoint.drags", a.drags, b.drags);
  c.field("checkpoint.next_drag", a.next_drag, b.next_drag);
  c.field("checkpoint.next_parameters", a.next_parameters, b.next_parameters);
  c.field("checkpoint.drag_velocity", a.drag_velocity, b.drag_velocity);
  compare_live("checkpoint", a, b, c);
  compare(a.digest, b.digest, c);
  c.field("checkpoint.layout", a.layout, b.layout);
  c.field("checkpoint.state", a.state, b.state);
  c.at(0);
  c.field("checkpoint.state_digest", a.state_digest, b.state_digest);
  return c.found();
}

}  // namespace afm::replay
