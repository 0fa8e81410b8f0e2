// The operations of a tip on its flights and slides, each compiled for several machines (multiversion.h).
#pragma once

#include <cmath>
#include <cstdint>

#include "afm/chatter.h"
#include "afm/contact.h"
#include "afm/impact_search.h"

namespace afm {

// A flight shorter than this part of the fastest turn may be rounding: 4500 ulp of a phase.
constexpr double kMinFlight = 1e-12;

// The count of a chatter sequence that has ended: at least its first bounce.
inline std::uint32_t whole_count(double n) {
  return static_cast<std::uint32_t>(std::fmax(1.0, std::fmin(std::floor(n), 4294967295.0)));
}

// Chatter that has died: what is left of its normal speed is lost.
inline Chatter settled(Chatter chatter) {
  chatter.loss += 0.5 * chatter.v * chatter.v;
  chatter.v = 0.0;
  return chatter;
}

// What the record of an impact keeps of its reflection.
struct Bounce {
  double phase, normal_speed, tangential_velocity, energy_loss;
};

// Begins a flight in the memory of another.
void launch(const Mechanics<double>& mechanics, double eta, const TipState& state, Flight<double>& flight);

// The flight after the landing of `flight`, in its memory. A bounce slower than kMinGapRate loses all its energy, and
// the new flight begins with a gap rate of zero.
void rebound(const Model& model, const Mechanics<double>& mechanics, double eta, const Landing<double>& landing,
             Flight<double>& flight, Bounce& bounce);

TipState state_of(const Flight<double>& flight, double s);
FlightState<double> flight_state(const Flight<double>& flight, double s);

// Begins a slide in the memory of another.
void slide_from(const Mechanics<double>& mechanics, double eta, const SlideState<double>& start, int bits,
                SlideSegment<double>& slide);
SlideState<double> slide_at(const SlideSegment<double>& slide, double s);
double release_of(const SlideSegment<double>& slide);  // the time of release [tau]; negative: none in this segment
double slide_energy(const Mechanics<double>& m, const SlideState<double>& q);  // kinetic energy and that of the springs
// A tip that bounces along a slide with the normal speed v.
struct BouncingSlide {
  SlideState<double> slide;
  double v;
};
// The state of the energy `energy` nearest to `at`. If none is near, a state of another energy.
BouncingSlide with_energy(const Mechanics<double>& m, const BouncingSlide& at, double energy);
double extension_integral(const SlideSegment<double>& slide, double s);        // of x - xc over the first s [a tau]

}  // namespace afm
