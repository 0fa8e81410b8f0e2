#include "tip_motion.h"

#include <cmath>
#include <new>

#include "afm/detail/multiversion.h"
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
AFM_MULTIVERSION void reflect_and_launch(const Model& model, const Mechanics<double>& mechanics, double eta,
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
AFM_MULTIVERSION void launch(const Mechanics<double>& mechanics, double eta, const TipState& state,
                             Flight<double>& flight) {
  new (&flight) Flight<double>(mechanics, eta, state);
}

void rebound(const Model& model, const Mechanics<double>& mechanics, double eta, const Landing<double>& landing,
             Flight<double>& flight, Bounce& bounce) {
  const bool rounding = is_rounding(flight, landing.s);
  reflect_and_launch(model, mechanics, eta, landing.jet, flight, bounce);
  if (rounding || flight.launch().g1 < kMinGapRate) stay(mechanics, eta, flight, bounce);
}

AFM_MULTIVERSION TipState state_of(const Flight<double>& flight, double s) { return flight.tip_state(s); }

AFM_MULTIVERSION FlightState<double> flight_state(const Flight<double>& flight, double s) { return flight.at(s); }

AFM_MULTIVERSION void slide_from(const Mechanics<double>& mechanics, double eta, const SlideState<double>& start,
                                 int bits, SlideSegment<double>& slide) {
  new (&slide) SlideSegment<double>(mechanics, eta, start, bits);
}

AFM_MULTIVERSION double slide_energy(const Mechanics<double>& m, const SlideState<double>& q) {
  const SurfaceJet<double> surface = surface_jet(m.H, q.phase);
  const double Y = surface.h - m.y0;
  return 0.5 * ((1.0 + surface.h1 * surface.h1) * q.u * q.u + m.omega_h * m.omega_h * q.X * q.X +
                m.omega_v * m.omega_v * Y * Y);
}

// By steps along the gradient, in the coordinates x omega_h, speed along the surface, normal speed.
AFM_MULTIVERSION BouncingSlide with_energy(const Mechanics<double>& m, const BouncingSlide& at, double energy) {
  constexpr int kSteps = 3;  // each squares the relative error, which is 1e-4 at the begin
  SlideState<double> r = at.slide;
  double v = at.v;
  for (int i = 0; i < kSteps; ++i) {
    const SurfaceJet<double> h = surface_jet(m.H, r.phase);
    const double Y = h.h - m.y0, slope2 = 1.0 + h.h1 * h.h1;
    const double speed2 = slope2 * r.u * r.u, wh2 = m.omega_h * m.omega_h, wv2 = m.omega_v * m.omega_v;
    const double force = wh2 * r.X + wv2 * Y * h.h1 + h.h1 * h.h2 * r.u * r.u;  // dE/dx
    const double left = energy - 0.5 * (speed2 + wh2 * r.X * r.X + wv2 * Y * Y + v * v);
    const double gradient2 = speed2 + force * force / wh2 + v * v;
    if (!(std::fabs(left) < 0.1 * gradient2)) break;
    const double part = left / gradient2, dx = part * force / wh2;
    r.phase += dx, r.X += dx, r.u += part * r.u, v += part * v;
  }
  return {r, v};
}

AFM_MULTIVERSION double extension_integral(const SlideSegment<double>& slide, double s) {
  return s * (slide.start().X - 0.5 * slide.eta() * s) + slide.displacement_integral(s);
}

AFM_MULTIVERSION double release_of(const SlideSegment<double>& slide) { return slide.find_release(); }

AFM_MULTIVERSION SlideState<double> slide_at(const SlideSegment<double>& slide, double s) { return slide.at(s); }

}  // namespace afm
