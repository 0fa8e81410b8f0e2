// Any model that may be run, from any start in the air, under any commands, in any heat bath: the tip stays finite,
// above the surface, in balance with its energy, and moves on.
#include "afm/tip.h"

#include <algorithm>
#include <cmath>

#include "afm/surface.h"
#include "bytes.h"
#include "target.h"
#include "trials/tip_watch.h"

namespace {

using afm::fuzz::Bytes;
using afm::fuzz::require;

constexpr std::uint64_t kMostSegments = 400;  // of one input
constexpr std::uint64_t kMostAtOnce = 100;    // segments without any time passing
// Of one input. The search of each takes up to 20000 evaluations in double-double: without a limit they take nine
// tenths of the time.
constexpr int kMostGlides = 4;

afm::Model model_of(Bytes& bytes) {
  afm::Model m;
  m.kind = bytes.below(4) == 0 ? afm::ModelKind::hammer : afm::ModelKind::oscillator;
  m.gamma = bytes.within(0.0, 1.0);
  m.v_c = bytes.within(0.0, 10.0);
  // flatter ones may be run, but there the rounding of places as parts of a cell tells in the (tiny) energy
  if (bytes.below(4) == 0) m.H = bytes.within(1e-3, afm::kMaxAmplitude);
  if (bytes.below(4) == 0) m.y0 = bytes.within(afm::kMinRestHeight, m.H);
  if (bytes.below(4) == 0) m.frequency_ratio = bytes.within(afm::kMinFrequencyRatio, afm::kMaxFrequencyRatio);
  return m;
}

double tolerance_of(Bytes& bytes) {
  if (bytes.below(4) != 0) return afm::kDefaultContactTolerance;
  const double tolerance = bytes.within(0.0, afm::kMaxContactTolerance);
  return tolerance < afm::kMinContactTolerance ? 0.0 : tolerance;
}

double eta_of(Bytes& bytes) {
  return bytes.below(4) == 0 ? bytes.within(-afm::kMaxEta, afm::kMaxEta) : bytes.within(-10.0, 10.0);
}

afm::FreeState start_of(Bytes& bytes, const afm::Model& m, double eta) {
  afm::FreeState s;
  s.phase = bytes.within(0.0, 1.0);
  s.y = afm::surface_jet(m.H, s.phase).h + bytes.within(1e-9, 1.0);
  s.X = bytes.below(4) == 0 ? bytes.within(-10.0, 10.0) : bytes.within(-0.1, 0.1);
  s.u = eta + (bytes.below(4) == 0 ? bytes.within(-afm::kMaxEta, afm::kMaxEta) : bytes.within(-4.0, 4.0));
  s.w = bytes.below(4) == 0 ? bytes.within(-afm::kMaxEta, afm::kMaxEta) : bytes.within(-4.0, 4.0);
  return s;
}

// Leaves the surface no faster than rounding tells.
bool glides(const afm::Tip& tip) {
  const afm::TipState s = tip.tip_state();
  return tip.in_flight() && !(s.g > 0.0) && s.g1 > 0.0 && s.g1 < 1e-14;
}

// Counts the glides. False: the input has had its segments or its glides. Bounces that are shorter than the rounding of
// the time, under a large force, get on by becoming slower.
bool run_to(afm::TipWatch& watch, const afm::ModelTime& end, bool accumulates, int& glide_count) {
  std::uint64_t at_once = 0;
  double slowest = INFINITY;  // impact since the time has moved [a/tau]
  afm::Outcome outcome = afm::Outcome::flying;
  while (outcome != afm::Outcome::time_limit) {
    if (glides(watch.tip())) ++glide_count;
    const afm::ModelTime before = watch.tip().now();
    if (!watch.advance_segment(end, outcome)) require(false, watch.violation());
    const bool moves = before < watch.tip().now();
    const double speed = outcome == afm::Outcome::impact ? watch.tip().last_impact().normal_speed : INFINITY;
    at_once = moves || speed < slowest ? 0 : at_once + 1;
    slowest = moves ? INFINITY : std::min(slowest, speed);
    if (!accumulates && at_once >= kMostAtOnce) require(false, "time stands still" + watch.violation());
    if (watch.count().segments >= kMostSegments || glide_count >= kMostGlides) return false;
  }
  return true;
}

// False if they do not make a tip that may be run.
bool fly(const std::uint8_t* data, std::size_t size, const afm::Bath& bath) {
  Bytes bytes(data, size);
  const afm::Model model = model_of(bytes);
  const double tolerance = tolerance_of(bytes);
  const double eta = eta_of(bytes);
  const afm::FreeState start = start_of(bytes, model, eta);
  if (!afm::find_faults(model).empty() || !(afm::to_tip_state(model.H, start).g > 0.0)) return false;
  afm::TipWatch watch(model, eta, start, tolerance);
  watch.set_bath(bath);
  int glide_count = 0;
  while (run_to(watch, watch.tip().now() + bytes.within(0.0, 4.0), tolerance < 1e-12, glide_count)) {
    watch.drag(eta_of(bytes));
    if (bytes.empty()) break;
  }
  return true;
}

afm::Bath bath_of(Bytes bytes) {
  afm::Bath bath;
  bath.quality_factor = bytes.within(0.0, 1e4);
  if (bytes.below(2) == 0) bath.lateral_quality_factor = bytes.within(0.0, 1e4);
  bath.temperature = bytes.below(4) == 0 ? bytes.within(0.0, afm::kMaxTemperature) : bytes.within(0.0, 1.0);
  bath.kicks_per_tau =
      bytes.below(4) == 0 ? bytes.within(afm::kMinKickRate, afm::kMaxKickRate) : bytes.within(1.0, 50.0);
  bath.seed = bytes.raw<std::uint64_t>();
  return bath;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (!fly(data, size, {})) return -1;
  if (size % 2 == 0) return 0;
  // once more in a bath, which the end of the input chooses: the rest means what it meant without
  const std::size_t end = std::min<std::size_t>(size, 24);
  const afm::Bath bath = bath_of(Bytes(data + size - end, end));
  if (afm::find_faults(bath).empty()) fly(data, size, bath);
  return 0;
}
