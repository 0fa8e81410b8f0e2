// The phases of motion of a tip (docs/algorithm.md), each with its own data.
#pragma once

#include <cstdint>
#include <optional>

#include "afm/flight.h"
#include "afm/landing.h"
#include "afm/state.h"
#include "chatter.h"
#include "contact_step.h"
#include "slide_segment.h"

namespace afm::detail {

// Totals since the present segment record began. `energy` is the stored energy at `time`.
struct Account {
  ModelTime time;
  double impulse = 0.0, loss = 0.0, energy = 0.0;
  std::uint64_t count = 0;
};

struct Flying {
  Flying(const SpringConstants<double>& springs, double eta, const TipState& start) : flight(springs, eta, start) {}
  Flight<double> flight;
  Landing<double> landing{};  // at the end
};

// On the surface, at rest against it. Contact begins at once.
struct Touching {
  TipState state;
};

// One step in contact.
struct Sliding {
  Sliding(const SpringConstants<double>& springs, double eta, const SlideState<double>& start, double tolerance,
          const ContactStep::Hint& hint)
      : step(springs, eta, start, tolerance, hint) {}
  ContactStep step;
  bool releases = false;  // at its end the surface no longer presses
  Account begin;          // of the record under way
};

// Totals of a chatter sequence up to the start of its reference slide.
struct Sequence {
  double normal_speed;   // after its first bounce [a/tau]
  double loss, impulse;  // energy lost in the bounces; impulse of the holder
};

// One reference slide of a chatter sequence.
struct Chattering {
  Chattering(const SpringConstants<double>& springs, double eta, const SlideState<double>& start, int bits)
      : reference(springs, eta, start, bits) {}
  // The reference slide ends before the sequence: another one follows, and no record ends.
  bool goes_on() const { return run.end == ChatterEnd::time && !releases; }

  SlideSegment<double> reference;
  bool releases = false;  // at its end the surface no longer presses
  Chatter chatter{};      // at the start of the reference slide
  ChatterRun run{};       // to the end, or to the last bounce before it
  // from that bounce, if the sequence is cut: the tip is in it at the end
  std::optional<Flight<double>> last_flight;
  Sequence sequence{};
  Account begin;  // of the record under way
};

// A chatter sequence at a time: the tip displaced from the reference slide, and totals since the sequence began.
struct SequenceState {
  SlideState<double> displaced;
  double v;       // normal speed after the last bounce
  double energy;  // stored
  Sequence sequence;
};

// Bounces that are one event, and where contact goes on or begins.
struct Collapse {
  Impact impact;
  SlideState<double> end;
};

// A tip at rest on the surface leaves it under any pull, or only under one above the rounding of the reaction.
enum class Leaves { under_any_pull, above_rounding };

}  // namespace afm::detail
