#include "tip_motion.h"

#include <cmath>
#include <new>

#include "afm/reflection.h"

namespace afm {
namespace {

// A flight that is shorter than rounding, under a force within rounding, is no flight: its end is rounding too. Without
// this a drag of 1e-18 a/tau, which moves no phase, would repeat it for ever.
bool is_rounding(const Flight<double>& flight, double s) {
  const TipState& start = flight.launch();
  return s * flight.bounds().fastest < kMinFlight && start.g1 > 0.0 &&
         std::fabs(flight.start().g2) < release_noise(flight.mechanics(), start.u, start.X);
}

// In one function: between two, the values would wait for memory.
void reflect_and_launch(const Model& model, const Mechanics<double>& mechanics, double eta,
                                         const GapJet<double>& incident, Flight<double>& flight, Bounce& bounce) {
  const Reflection r = reflect(model, eta, incident);
  const TipState after{r.after.phase, r.after.X, r.after.u, 0.0, r.after.g1};
  new (&flight) Flight<double>(mechanics, eta, after);
  bounce.phase = r.after.phase;
  bounce.normal_speed = r.normal_speed;
  bounce.tangential_velocity = r.tangential_velocity;
  bounce.energy_loss = r.energy_loss;
}

void stay(const Mechanics<double>& mechanics, double eta, Flight<double>& flight, Bounce& bounce) {
  TipState at_rest = flight.launch();
  at_rest.g1 = 0.0;
  launch(mechanics, eta, at_rest, flight);
  bounce.energy_loss = 0.5 * bounce.normal_speed * bounce.normal_speed;
}

}  // namespace

// Constructed in place: a copy of the new flight would wait for memory, which costs a tenth of an impact.
void launch(const Mechanics<double>& mechanics, double eta, const TipState& state,
                             Flight<double>& flight) {
  new (&flight) Flight<double>(mechanics, eta, state);
}

void rebound(const Model& model, const Mechanics<double>& mechanics, double eta, const Landing<double>& landing,
             Flight<double>& flight, Bounce& bounce) {
  const bool rounding = is_rounding(flight, landing.s);
  reflect_and_launch(model, mechanics, eta, landing.jet, flight, bounce);
  if (rounding || flight.launch().g1 < kMinGapRate) stay(mechanics, eta, flight, bounce);
}

TipState state_of(const Flight<double>& flight, double s) { return flight.tip_state(s); }

FlightState<double> flight_state(const Flight<double>& flight, double s) { return flight.at(s); }

void slide_from(const Mechanics<double>& mechanics, double eta, const SlideState<double>& start,
                                 int bits, SlideSegment<double>& slide) {
  new (&slide) SlideSegment<double>(mechanics, eta, start, bits);
}

double slide_energy(const Mechanics<double>& m, const SlideState<double>& q) {
  const SurfaceJet<double> surface = surface_jet(m.H, q.phase);
  const double Y = surface.h - m.y0;
  return 0.5 * ((1.0 + surface.h1 * surface.h1) * q.u * q.u + m.omega_h * m.omega_h * q.X * q.X +
                m.omega_v * m.omega_v * Y * Y);
}

double extension_integral(const SlideSegment<double>& slide, double s) {
  return s * (slide.start().X - 0.5 * slide.eta() * s) + slide.displacement_integral(s);
}

double release_of(const SlideSegment<double>& slide) { return slide.find_release(); }

SlideState<double> slide_at(const SlideSegment<double>& slide, double s) { return slide.at(s); }

}  // namespace afm
