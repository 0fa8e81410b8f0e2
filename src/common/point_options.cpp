#include "point_options.h"

#include <stdexcept>

namespace afm {
namespace {

SweepPoint point_of(const PointOptions& o) {
  return {o.eta, o.gamma, o.cutoff, checked_kind(o.model), o.rest_height, o.amplitude, o.frequency_ratio};
}

SweepPoint without_faults(const SweepPoint& point, const std::vector<ParameterError>& faults) {
  if (!faults.empty()) throw std::invalid_argument(describe(faults));
  return point;
}

}  // namespace

void add_model_option(CommandLine& app, std::string& model) {
  app.option("model", model, "oscillator, or hammer: the horizontal spring infinitely stiff");
}

ModelKind checked_kind(const std::string& name) {
  ModelKind kind = ModelKind::oscillator;
  if (!parse(name, kind)) throw std::invalid_argument("model = " + name + ": must be oscillator or hammer");
  return kind;
}

void add_tip_options(CommandLine& app, TipOptions& o) {
  add_model_option(app, o.model);
  app.option("frequency-ratio", o.frequency_ratio, "omega_h / omega_v");
  app.option("amplitude", o.amplitude, "of the surface [a]");
  app.option("rest-height", o.rest_height, "height of the holder above mid-surface [a]; the load is -(2 pi)^2 of it");
}

void add_options(CommandLine& app, PointOptions& o) {
  app.option("eta", o.eta, "drag velocity [a/tau]");
  app.option("gamma", o.gamma, "restitution at and above the cutoff");
  app.option("cutoff", o.cutoff, "cutoff speed of the restitution [a/tau]");
  add_tip_options(app, o);
}

void add_tip_si_options(CommandLine& app, TipOptions& o) {
  add_si_options(app, o.si);
  add_lever_options(app, o.lever);
}

void add_si_options(CommandLine& app, PointOptions& o) {
  app.option("drag-velocity", o.drag_velocity, kDragVelocityHelp);
  add_tip_si_options(app, o);
}

std::optional<LeverScene> take_tip_si(const CommandLine& app, TipOptions& o) {
  std::optional<LeverScene> lever = take_lever(app, o.lever, o.si);
  if (lever) {
    lever->take(app, "frequency-ratio", o.frequency_ratio);
    lever->take(app, "amplitude", o.amplitude);
    lever->take(app, "rest-height", o.rest_height);
  }
  checked_units(app, o.si);
  take_si(app, o.si, "amplitude", o.amplitude);
  take_si(app, o.si, "rest-height", o.rest_height);
  return lever;
}

void take_si(const CommandLine& app, PointOptions& o) {
  const auto lever = take_tip_si(app, o);
  if (lever) lever->take(app, "cutoff", o.cutoff);
  take_si(app, o.si, "cutoff", o.cutoff);
  if (has_drag_velocity(app, o.si)) {
    o.eta = o.drag_velocity;
    take_si(app, o.si, "drag-velocity", o.eta);
  }
  checked_point(app, o);
}

std::vector<ParameterError> find_faults(const PointOptions& o) { return find_faults(point_of(o)); }

SweepPoint checked_point(const CommandLine& app, const PointOptions& o) {
  return without_faults(point_of(o), as_given(app, o.si, find_faults(o)));
}

Model checked_model(const PointOptions& o) { return model_of(without_faults(point_of(o), find_faults(o))); }

}  // namespace afm
