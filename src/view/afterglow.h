// What stays in the picture after it happened: the impacts of the path; where motion is too fast to follow, impacts and
// places of the tip for a second. Of what is new at most so much is taken, evenly: a picture costs the same at any
// speed.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "strobe.h"

namespace afm::view {

struct Spot {
  Corner corner;        // in the lab [a]
  double energy = 0.0;  // lost [m a^2 / tau^2]
  ImpactKind kind = ImpactKind::impact;
  std::uint64_t picture = 0;
};

constexpr std::size_t kNewImpacts = 40, kNewPositions = 64;  // a picture
constexpr std::size_t kMostImpacts = 2000;                   // along a path
constexpr std::uint64_t kGlow = 30;                          // pictures: a second

class Afterglow {
 public:
  // Takes what is new and forgets what is old. Precondition: the holder knows its place.
  void look(const RunView& run, const Strobe& strobe);
  void clear() { *this = Afterglow(); }

  const std::deque<Spot>& impacts() const { return impacts_; }
  const std::deque<Spot>& positions() const { return positions_; }  // none where the eye can follow

 private:
  void take_impacts(const RunView& run, bool too_fast);
  void take_positions(const RunView& run, bool wanted);
  void forget();

  std::uint64_t picture_ = 0, next_event_ = 0, next_sample_ = 0;
  std::uint32_t epoch_ = 0;
  ModelTime now_;
  std::deque<Spot> impacts_, positions_;
};

}  // namespace afm::view
