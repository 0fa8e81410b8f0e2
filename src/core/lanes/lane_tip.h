// A tip in lanes: its flight and how far the search of the next impact has come, as rows of numbers that a pack is
// loaded from. No code of its own: it is shared by files that are compiled for different machines.
#pragma once

#include <cstdint>

#include "afm/state.h"

namespace afm {
namespace lanes {

// Where each number is in a row; loaded and stored two by two.
enum Field : int {
  // the flight: launch (gap 0), the jet there, bounds
  kPhase,
  kU,
  kX,
  kRateX,
  kY,
  kRateY,
  kG1,
  kG2,
  kG3,
  kH,
  kH1,
  kBoundX,
  kBoundY,
  kBound2,
  kBound3,
  kBound4,
  kBoundDrive,
  kFastest,
  // the search: certified up to, next look, reach of a step; or the time of the jet and the step from there to the root
  kS,
  kAhead,
  kGuess,
  kCount,  // of evaluations
  // the model
  kRatio,
  kOmegaH,
  kPerOmegaH,
  kAmplitude,
  kCentre,
  kEta,
  kMobility,
  kGamma,
  kCutoff,
  kBurstGapRate,
  // the jet near a certified root
  kJetPhase,
  kJetX,
  kJetRateX,
  kJetY,
  kJetRateY,
  kJetG,
  kJetG1,
  kJetG2,
  kJetG3,
  kJetH,
  kJetH1,
  kStep,
  kLow,
  kHigh,
  kJetS,   // where it was certified
  kJetT,   // since then
  kIsEnd,  // 1: the next evaluation is the last
  kUnused,
  // at the root, what a reflection asks for, and when
  kEndSurface,  // phase
  kEndX,
  kEndRateX,
  kEndG1,
  kEndH1,
  kUnusedToo,
  kStartTau,  // whole tau as bits
  kStartPhase,
  kEndTau,
  kEndPhase,
  kLimitTau,
  kLimitPhase,
  kFields
};

// Slower launches are the tip's own affair: powers of them have no digits left [a/tau].
constexpr double kSlowestLaunch = 1e-60;

// What is to be done next, where a tip is not at work.
enum class Stage : std::uint8_t {
  look,    // evaluate the gap where the search says
  bounce,  // found: reflect, and begin the next flight
  single   // one tip by itself must go on from the launch: whatever is not an ordinary flight
};

struct alignas(64) LaneTip {
  double row[kFields];
  Impact last;
  Impact* log;           // the next record goes here too; null: nowhere
  std::uint32_t events;  // since the call
  Stage stage;
  bool stuck;    // single, for this very flight lanes could not do
  bool bounced;  // in lanes, since the tip itself was last brought up to date
  bool waits;    // at the limit
};

// Advances all until each has had so many events or flies on at its limit.
struct Work {
  LaneTip* tips;
  std::uint32_t size;
  std::uint32_t most_events;
  LaneTip* spare;  // fills packs up
  // Brings one tip on by itself until it is in an ordinary flight again; false where it is done before.
  bool (*single)(void* context, LaneTip& tip);
  void* context;
};

using Advance = void (*)(const Work&);

// With at most so many in one register, on the machine this runs on; null where it has no lanes.
Advance advance_in(int width);

void advance_avx2(const Work& work);
void advance_avx512(const Work& work);

}  // namespace lanes
}  // namespace afm
