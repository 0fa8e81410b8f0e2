// Flights built to pass the surface at a given distance, and what each is in quad precision: a touch or a miss
#pragma once

#include <cmath>

#include "core/search/impact_search.h"
#include "quad.h"
#include "random_launches.h"

namespace afm {

constexpr double kGrazeHorizon = 2.5;

struct Graze {
  Model model;
  double eta;
  TipState start;
  double s;  // of the graze
};

struct GrazeCount {
  long touched = 0, missed = 0, wrong = 0;
  long finer = 0;  // of them decided in twice the digits
};

// Drag speeds from 0.05 to 100 either way.
class Grazes {
 public:
  explicit Grazes(unsigned seed) : random_(seed) {}

  // Time run backwards from a point `clearance` above the surface with no gap rate, to the impact before.
  Graze after_a_flight(double clearance) {
    for (;;) {
      const double eta = drag(), u = -eta * random_.within(0.7, 1.3) + random_.within(-1.5, 1.5);
      const TipState top{random_.within(-0.5, 0.5), random_.within(-0.04, 0.04), u, clearance, 0.0};
      const Flight<Quad> back(quad_, -eta, top);
      if (!(back.start().g2 > 1)) continue;
      const Quad clear = sqrt(Quad(0.01) / back.start().g2);  // by then the gap is beyond any rounding
      if (!(back.gap(clear).g > Quad(0.001))) continue;
      const Flight<Quad> rest(quad_, -eta, back.tip_state(clear));
      const Landing<Quad> before = detail::find_impact(rest, Quad(kGrazeHorizon));
      const FlightState<Quad>& q = before.jet.state;
      const TipState start{wrap_phase(static_cast<double>(q.phase)), static_cast<double>(q.X),
                           -static_cast<double>(q.U - eta), 0.0, -static_cast<double>(before.jet.g1)};
      if (before.outcome != SearchOutcome::impact || start.g1 < 1e-2) continue;
      return {mica_, eta, start, static_cast<double>(clear + before.s)};
    }
  }

  // A bounce that the surface, falling away from under it, only just does not end.
  Graze after_the_start(double clearance) {
    for (;;) {
      const double eta = drag(), u = eta * random_.within(0.7, 1.3) + random_.within(-1.5, 1.5);
      TipState start{random_.within(0.0, 1.0), 0.0, u, 0.0, 0.0};
      const Flight<double> still(double_, eta, start);
      const double h1 = surface_jet(mica_.H, start.phase).h1;
      if (std::abs(h1) < 0.05) continue;
      const double g2 = -random_.power(-2.0, 1.0);
      start.X = (g2 - still.start().g2) / (h1 * double_.omega_h * double_.omega_h);
      const double g3 = Flight<double>(double_, eta, start).start().g3;
      const double s = -1.5 * g2 / g3;
      if (std::abs(start.X) > 0.05 || !(g3 > 0.0) || s > 0.02) continue;
      start.g1 = 0.375 * g2 * g2 / g3;
      Graze graze{mica_, eta, start, s};
      if (lower(graze, graze.start.g1, clearance, s)) return graze;
    }
  }

  // Dragged evenly at a whole number of lattice spacings a tau, it passes the same point at the same height every tau.
  Graze every_tau(double clearance) {
    for (;;) {
      const double speed = std::floor(random_.within(1.0, 10.0)), eta = random_.sign() * speed;
      Graze graze{mica_, eta, {random_.within(0.0, 1.0), 0.0, eta, random_.within(0.0, 0.1), 0.0}, 0.0};
      graze.model.y0 = random_.within(0.2, 0.8) * mica_.H;
      graze.start.g1 = -eta * surface_jet(mica_.H, graze.start.phase).h1;  // at its highest
      const SpringConstants<double> springs(graze.model);
      const Flight<double> flight(springs, eta, graze.start);
      if (!(flight.start().state.Y > 0.0)) continue;
      const double lowest = graze.s = lowest_point(flight);
      if (!lower(graze, graze.start.g, clearance, std::cos(kTwoPi * graze.s)) || graze.start.g < 0.01) continue;
      const Flight<double> lowered(springs, eta, graze.start);
      if (std::abs(lowest_point(lowered) - lowest) < 0.01) return graze;
    }
  }

 private:
  double drag() {
    const double fast = random_.within(0.0, 1.0) < 0.1 ? 2.0 : 1.0, size = random_.power(-1.3, fast);
    return random_.sign() * size;
  }

  // Within 1/256 tau, of the first tau.
  static double lowest_point(const Flight<double>& flight) {
    double at = 0.0, least = flight.start().g;
    for (double s = 0.0; s < 1.0; s += 1.0 / 256.0) {
      const double g = flight.gap(s).g;
      if (g < least) least = g, at = s;
    }
    return at;
  }

  // Changes `start` of the graze until the least gap near graze.s is `clearance`; `effect` of a change of it on that
  // gap.
  static bool lower(Graze& graze, double& start, double clearance, double effect) {
    for (int i = 0; i < 8; ++i) {
      const Flight<Quad> flight(SpringConstants<Quad>(graze.model), graze.eta, graze.start);
      Quad s = graze.s;
      GapJet<Quad> jet = flight.gap(s);
      for (int k = 0; k < 12; ++k, jet = flight.gap(s)) s -= jet.g1 / jet.g2;
      if (!(s > 0 && s < 1.5) || !(jet.g2 > 0)) return false;
      graze.s = static_cast<double>(s);
      const double off = static_cast<double>(jet.g - clearance);
      if (i > 3 && std::abs(off) <= 2e-16 * (std::abs(start) + std::abs(clearance))) return true;
      start -= off / effect;
    }
    return false;
  }

  RandomLaunches random_;
  Model mica_;
  SpringConstants<double> double_{mica_};
  SpringConstants<Quad> quad_{mica_};
};

// Is it decided as exact arithmetic on the same doubles does? Most wrong decisions are whole flights away.
inline bool decide(const Graze& graze, GrazeCount& count) {
  const Landing<Quad> truth = detail::find_impact(
      Flight<Quad>(SpringConstants<Quad>(graze.model), graze.eta, graze.start), Quad(kGrazeHorizon));
  const Flight<double> flight(SpringConstants<double>(graze.model), graze.eta, graze.start);
  const Landing<double> landing = find_landing(graze.model, flight, kGrazeHorizon);
  constexpr double kSame = 1e-6;  // [tau]: grazes shift times
  const bool right = landing.outcome == truth.outcome && std::abs(landing.s - static_cast<double>(truth.s)) < kSame;
  if (!right) ++count.wrong;
  const bool near = truth.outcome == SearchOutcome::impact && truth.s < graze.s + kSame;
  ++(near ? count.touched : count.missed);
  if (detail::find_impact(flight, kGrazeHorizon).outcome == SearchOutcome::undecided) ++count.finer;
  return right;
}

// The same with starts that are as near to it as doubles are, up to `steps` to either side.
inline bool decide_neighbours(Graze graze, int steps, GrazeCount& count) {
  const double first = graze.start.g1;
  bool right = true;
  for (int k = -steps; k <= steps; ++k) {
    const double direction = k < 0 ? -INFINITY : INFINITY;
    graze.start.g1 = first;
    for (int i = 0; i < std::abs(k); ++i) graze.start.g1 = std::nextafter(graze.start.g1, direction);
    right = decide(graze, count) && right;
  }
  return right;
}

}  // namespace afm
