// Levels of detail of the model, from the oscillator with every bounce (finest) to the hammer of the paper's section IX
// (coarsest).
#pragma once

#include "model.h"
#include "tip.h"

namespace afm {

// The tolerance is that of Tip: 0 computes every bounce by itself.
struct Level {
  ModelKind kind = ModelKind::oscillator;
  double contact_tolerance = kDefaultContactTolerance;
};

inline bool operator==(const Level& a, const Level& b) {
  return a.kind == b.kind && a.contact_tolerance == b.contact_tolerance;
}

// `model` with the kind of the level.
inline Model at_level(Model model, const Level& level) {
  model.kind = level.kind;
  return model;
}

}  // namespace afm
