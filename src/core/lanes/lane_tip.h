// A tip in lanes: its flight and how far the search of the next impact has come, as rows of numbers that a pack is loaded from.
// No code of its own: it is shared by files that are compiled for different machines.
#pragma once

#include <cstdint>

#include "afm_emulator/state.h"

namespace afm {
namespace lanes {

// Where each number is in a row; loaded and stored two by two.
enum Field : int {
  kPhase,
  kU,  // the launch: surface phase and lab velocity; gap 0
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
  kSmallUntil,
  kS,
  kAhead,
  kGuess,
  kBurstGapRate,
  kRatio,
  kOmegaH,
  kPerOmegaH,
  kAmplitude,
  kCentre,
  kEta,
  kMobility,
  kGamma,
  kCutoff,
  kUnused,
  // the jet where a root is certified, and after it the incident state
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
  kEstimate,
  kLow,
  kHigh,
  kJetS,
  kUnused2,
  kStartTau,
  kStartPhase,
  kEndTau,
  kEndPhase,  // whole tau as bits
  kFields
};

// What is to be done next.
enum class Stage : std::uint8_t {
  look,    // evaluate the gap where the search says
  finish,  // a root is certified: find it
  bounce,  // found: reflect, and begin the next flight
  single   // one tip by itself must go on from the launch: whatever is not an ordinary flight
};

struct alignas(64) LaneTip {
  double row[kFields];
  Impact last;
  Impact* log;           // the next record goes here too; null: nowhere
  std::uint32_t events;  // since the call
  std::uint16_t looks;   // of this flight
  Stage stage;
  bool stuck;    // single, for this very flight lanes could not do
  bool bounced;  // in lanes, since the tip itself was last brought up to date
  bool waits;    // at the limit
};

// Advances all until each has had so many events or flies on at the limit.
struct Work {
  LaneTip* tips;
  std::uint32_t size;
  std::uint32_t most_events;
  ModelTime limit;
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
