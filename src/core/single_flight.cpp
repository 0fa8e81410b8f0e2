#include "afm/single_flight.h"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "afm/flight.h"
#include "afm/landing.h"
#include "afm/reflection.h"
#include "afm/run.h"
#include "afm/surface.h"
#include "core/search/double_double.h"
#include "fault_list.h"

namespace afm {

using namespace detail;

namespace {

Model model_of(const FlightInput& input) {
  Model model;
  model.gamma = input.gamma;
  model.v_c = input.cutoff;
  model.kind = input.kind;
  model.y0 = input.rest_height;
  model.H = input.amplitude;
  model.frequency_ratio = input.frequency_ratio;
  return model;
}

void check(const FlightInput& input) {
  std::string text;
  for (const ParameterError& fault : find_faults(input)) text += (text.empty() ? "" : "; ") + std::string(fault.what());
  if (!text.empty()) throw std::invalid_argument(text);
}

// w - h'(phase) u is a small difference of velocities after a slow impact: taken in double-double.
TipState start_of(const FlightInput& input) {
  const DoubleDouble slope = surface_jet(DoubleDouble(model_of(input).H), DoubleDouble(input.phase)).h1;
  const bool held = input.kind == ModelKind::hammer;
  const double extension = held ? 0.0 : input.extension, u = held ? input.eta : input.u;
  const double gap_rate = static_cast<double>(DoubleDouble(input.w) - slope * DoubleDouble(u));
  if (gap_rate > 0.0) return {input.phase, extension, u, 0.0, gap_rate};
  std::ostringstream text;
  text << "the tip does not leave the surface: w - h'(phase) u = " << gap_rate << " is not above 0";
  throw std::invalid_argument(text.str());
}

// A search that fails on a long flight is restarted from where it is certified free of impacts.
Landing<double> land(const Model& model, double eta, TipState start) {
  constexpr int kAttempts = 100;
  const SpringConstants<double> springs(model);
  double flown = 0.0;
  for (int attempt = 0; attempt < kAttempts && flown < kLongestFlight; ++attempt) {
    Flight<double> flight(springs, eta, start);
    Landing<double> landing = find_landing(model, flight, kLongestFlight - flown);
    const double s = landing.s;
    landing.s = flown += s;
    if (landing.outcome == SearchOutcome::impact) {
      if (landing.jet.g1 < 0.0 || !(flown < kEarlyLanding)) return landing;  // else double-double could not decide
      throw std::runtime_error("the tip rests on the surface, to within rounding");
    }
    start = flight.tip_state(s);
  }
  std::ostringstream text;
  text << "no impact within " << flown << " tau";
  if (flown < kLongestFlight) text << ", where the search failed";
  throw std::runtime_error(text.str());
}

}  // namespace

std::vector<ParameterError> find_faults(const FlightInput& input) {
  RunSettings settings;
  settings.model = model_of(input);
  settings.eta = input.eta;
  // a phase that is no phase is reported, not used
  const double height = surface_jet(settings.model.H, std::abs(input.phase) <= 1e6 ? input.phase : 0.0).h;
  settings.initial = {input.phase, input.extension, height, input.u, input.w};
  std::vector<ParameterError> faults;
  for (const ParameterError& fault : find_faults(settings)) {
    faults.emplace_back(word_for(fault.name), fault.value, fault.reason);
  }
  return faults;
}

FlightResult fly_to_next_impact(const FlightInput& input) {
  check(input);
  const Model model = model_of(input);
  const Landing<double> landing = land(model, input.eta, start_of(input));
  const Reflection r = reflect(model, input.eta, landing.jet);
  const FreeState after = to_free_state(model.H, r.after);
  return {landing.s, after.phase, after.X, after.u, after.w, r.normal_speed, r.tangential_velocity, r.energy_loss};
}

}  // namespace afm
