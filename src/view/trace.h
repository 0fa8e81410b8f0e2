// The tip's way: its latest samples and what happened between them, in natural units.
#pragma once

#include <afm_emulator/Deflection.h>
#include <afm_emulator/ImpactArray.h>

#include <cstdint>
#include <deque>
#include <vector>

#include "afm/model.h"
#include "afm/state.h"
#include "afm/units.h"
#include "holder.h"

namespace afm::view {

struct Sample {
  std::uint64_t index = 0;
  ModelTime time;
  double X = 0.0, Y = 0.0;  // tip minus holder [a]
};

struct Event {
  std::uint64_t index = 0;
  Impact impact;
  bool contact = false;  // whether the tip slides after it
};

// A corner of the path, in the lab [a].
struct Corner {
  ModelTime time;
  double x = 0.0, y = 0.0;
  bool contact = false;  // from here on
};

class Trace {
 public:
  // Forgets what is further back than that many samples.
  void keep(std::size_t samples) { kept_samples_ = samples; }

  // Forgets what was before, when that is of another epoch or when something between is missing.
  void add(const afm_emulator::Deflection& message, const Units& units, double sample_period_tau);
  void add(const afm_emulator::ImpactArray& message, const Units& units);

  // Samples and events belong to one epoch, which is the one given.
  bool has_epoch(std::uint32_t epoch) const {
    return !samples_.empty() && samples_epoch_ == epoch && events_epoch_ == epoch;
  }
  const std::deque<Sample>& samples() const { return samples_; }
  const std::deque<Event>& events() const { return events_; }
  bool in_contact(const ModelTime& time) const;

  // Where an event was: the surface phase is exact, the cell is that of the nearest sample.
  Corner place(const Event& event, const Model& model, const Holder& holder) const;
  // Samples and events of [from, newest sample], in order of time. Precondition: the holder knows its place.
  std::vector<Corner> path(const ModelTime& from, const Model& model, const Holder& holder) const;

 private:
  void forget_old();

  std::size_t kept_samples_ = 100000;
  std::uint32_t samples_epoch_ = 0, events_epoch_ = 0;
  std::uint64_t next_sample_ = 0, next_event_ = 0;
  bool contact_before_ = false;  // the first event kept
  std::deque<Sample> samples_;
  std::deque<Event> events_;
};

}  // namespace afm::view
