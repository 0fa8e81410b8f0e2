#include "point_options.h"

#include <stdexcept>

#include "afm/sweep.h"
#include "common/csv.h"
#include "common/decimal_range.h"

namespace afm {
namespace {

std::vector<double> values_of(const std::string& name, const std::string& text, const std::vector<std::string>& parts) {
  std::vector<double> values;
  try {
    for (const std::string& part : parts) {
      for (const double value : parse_range(part)) values.push_back(value);
    }
  } catch (const std::invalid_argument& fault) {
    throw std::invalid_argument(name + " = " + text + ": " + fault.what());
  }
  return values;
}

SweepPoint point_of(const PointOptions& o) {
  SweepPoint point{o.eta, o.gamma, o.cutoff, checked_kind(o.model)};
  point.frequency_ratio = o.frequency_ratio;
  return point;
}

}  // namespace

std::vector<double> range_option(const std::string& name, const std::string& text) {
  return values_of(name, text, {text});
}

std::vector<double> ranges_option(const std::string& name, const std::string& text) {
  return values_of(name, text, split_fields(text));
}

std::vector<double> ranges_option(const std::string& name, const std::vector<std::string>& texts) {
  std::vector<double> values;
  for (const std::string& text : texts) {
    for (const double value : range_option(name, text)) values.push_back(value);
  }
  return values;
}

std::vector<PointOptions> grid_option(const std::string& eta, const std::string& gamma, const std::string& cutoff,
                                      const std::string& frequency_ratio) {
  std::vector<PointOptions> grid;
  const std::vector<double> gammas = ranges_option("gamma", gamma), etas = ranges_option("eta", eta);
  const std::vector<double> ratios = ranges_option("frequency-ratio", frequency_ratio);
  for (const double v_c : ranges_option("cutoff", cutoff)) {
    for (const double g : gammas) {
      for (const double ratio : ratios) {
        for (const double e : etas) grid.push_back({e, g, v_c, "oscillator", ratio, {}, {}});
      }
    }
  }
  return grid;
}

void add_model_option(CommandLine& app, std::string& model) {
  app.option("model", model, "oscillator, or hammer: the horizontal spring infinitely stiff");
}

ModelKind checked_kind(const std::string& name) {
  ModelKind kind = ModelKind::oscillator;
  if (!parse(name, kind)) throw std::invalid_argument("model = " + name + ": must be oscillator or hammer");
  return kind;
}

void add_options(CommandLine& app, PointOptions& o) {
  app.option("eta", o.eta, "drag velocity [a/tau]");
  app.option("gamma", o.gamma, "restitution at and above the cutoff");
  app.option("cutoff", o.cutoff, "cutoff speed of the restitution [a/tau]");
  add_model_option(app, o.model);
}

void add_si_options(CommandLine& app, PointOptions& o) {
  add_drag_velocity_option(app, o.drag_velocity);
  add_si_options(app, o.si);
}

void take_si(const CommandLine& app, PointOptions& o) {
  checked_units(app, o.si);
  take_si(app, o.si, "cutoff", o.cutoff);
  if (has_drag_velocity(app, o.si)) {
    const std::vector<double> values = range_option("drag-velocity", o.drag_velocity);
    if (values.size() != 1) throw std::invalid_argument("drag-velocity = " + o.drag_velocity + ": must be one number");
    o.eta = values.front();
    take_si(app, o.si, "drag-velocity", o.eta);
  }
  checked_model(app, o);
}

Model checked_model(const CommandLine& app, const PointOptions& o) {
  const SweepPoint point = point_of(o);
  const std::vector<ParameterError> faults = as_given(app, o.si, find_faults(point));
  if (!faults.empty()) throw std::invalid_argument(describe(faults));
  return model_of(point);
}

Model checked_model(const PointOptions& o) {
  const SweepPoint point = point_of(o);
  const std::vector<ParameterError> faults = find_faults(point);
  if (!faults.empty()) throw std::invalid_argument(describe(faults));
  return model_of(point);
}

}  // namespace afm
