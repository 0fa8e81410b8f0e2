// How much of the model is computed: from every bounce of the oscillator down to the hammer.
#pragma once

#include "model.h"
#include "tip.h"

namespace afm {

// Hammer, oscillator with bursts and contact at a tolerance, oscillator with every bounce (tolerance 0).
struct Level {
  ModelKind kind = ModelKind::oscillator;
  double contact_tolerance = kDefaultContactTolerance;
};

inline bool operator==(const Level& a, const Level& b) {
  return a.kind == b.kind && a.contact_tolerance == b.contact_tolerance;
}

inline bool has_valid_tolerance(const Level& level) {
  const double t = level.contact_tolerance;
  return t == 0.0 || (t >= kMinContactTolerance && t <= kMaxContactTolerance);
}

// `model` as the level has it.
inline Model at_level(Model model, const Level& level) {
  model.kind = level.kind;
  return model;
}

}  // namespace afm
