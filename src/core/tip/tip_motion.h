// What a tip asks of its flights and slides, each in the version for the machine at hand (multiversion.h).
#pragma once

#include <cmath>
#include <cstdint>

#include "afm/impact_search.h"
#include "afm/contact.h"

namespace afm {

// A flight shorter than this part of the fastest turn may be rounding.
constexpr double kLeastFlight = 1e-12;

// Of a chatter sequence that is over: at least one, as its first bounce has been.
inline std::uint32_t whole_count(double n) {
  constexpr double kMost = 4294967295.0;
  return static_cast<std::uint32_t>(std::fmax(1.0, std::fmin(std::floor(n), kMost)));
}

// What of a reflection its record keeps.
struct Bounce {
  double phase, normal_speed, tangential_velocity, energy_loss;
};

// Begins a flight in the place of another.
void launch(const Mechanics<double>& mechanics, double eta, const TipState& state, Flight<double>& flight);

// The flight after the landing of this one, in its place. Of a bounce that is none all is lost that came in, and the
// flight begins without a gap rate.
void rebound(const Model& model, const Mechanics<double>& mechanics, double eta, const Landing<double>& landing,
             Flight<double>& flight, Bounce& bounce);

TipState state_of(const Flight<double>& flight, double s);
FlightState<double> flight_state(const Flight<double>& flight, double s);

// Begins a piece of a slide in the place of another.
void slide_from(const Mechanics<double>& mechanics, double eta, const SlideState<double>& start, int bits,
                SlideSegment<double>& slide);
SlideState<double> slide_at(const SlideSegment<double>& slide, double s);
double release_of(const SlideSegment<double>& slide);  // when the surface lets go; negative: not in it
double slide_energy(const Mechanics<double>& m, const SlideState<double>& q);  // kinetic and in the springs
double extension_integral(const SlideSegment<double>& slide, double s);            // of x - xc over the first s

}  // namespace afm
