// Runs under random commands: whatever the tip is at, a run can be brought there.
#pragma once

#include <cstddef>
#include <ostream>

#include "commands.h"
#include "trials/random_launches.h"

namespace afm {

struct Scene {
  double eta, v_c, contact_tolerance;
  ModelKind kind;
  double temperature;  // 0: no bath
  double rest_height = 0.0;
};

inline std::ostream& operator<<(std::ostream& out, const Scene& s) {
  return out << name(s.kind) << ", eta " << s.eta << ", tolerance " << s.contact_tolerance << ", T " << s.temperature
             << ", y0 " << s.rest_height;
}

inline RunSettings settings_of(const Scene& scene) {
  RunSettings s;
  s.model.v_c = scene.v_c;
  s.model.kind = scene.kind;
  s.model.y0 = scene.rest_height;
  s.eta = s.initial.u = scene.eta;
  s.contact_tolerance = scene.contact_tolerance;
  s.bath.temperature = scene.temperature;
  s.bath.quality_factor = scene.temperature > 0.0 ? 50.0 : 0.0;
  s.samples_per_batch = 50;
  s.friction_window = 40.0;
  s.impact_budget = 500;
  return s;
}

class Chance {
 public:
  explicit Chance(unsigned seed) : random_(seed) {}
  double within(double low, double high) { return random_.within(low, high); }
  bool one_in(double n) { return within(0.0, n) < 1.0; }
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(within(0.0, 1.0) * static_cast<double>(n)) % n; }

  // Mostly the settings in force; now and then others.
  RunSettings command(const afm::Run& run) {
    RunSettings live = run.settings();
    if (one_in(10.0)) live.eta = within(-7.0, 7.0);
    if (one_in(30.0)) live.model.gamma = within(0.3, 0.9);
    if (one_in(30.0)) live.model.y0 = within(-0.1, 0.05);
    if (one_in(20.0)) live.sample_period = within(0.02, 0.04);
    if (one_in(30.0)) live.friction_window = within(20.0, 60.0);
    if (one_in(30.0)) live.bath = {within(0.0, 1.0), one_in(3.0) ? 0.0 : within(10.0, 200.0), 0.0, within(1.0, 5.0)};
    if (one_in(30.0)) live.model.kind = one_in(2.0) ? ModelKind::hammer : ModelKind::oscillator;
    if (one_in(30.0)) live.contact_tolerance = one_in(3.0) ? 0.0 : 1e-3;
    return live;
  }

  // To an impact, to a time within a batch, or to the end of the batch.
  Outcome advance(afm::Run& run, Batch& batch) {
    if (one_in(3.0)) return advance_impacts(1 + below(5), run, batch);
    if (one_in(2.0)) return advance_to(run.now() + within(0.0, 1.0), run, batch);
    return run.advance(batch);
  }

 private:
  RandomLaunches random_;
};

// To a time before an event of this kind, if there is one soon. Only a tip that chatters ends a chatter sequence next.
inline void seek(ImpactKind kind, Chance& chance, afm::Run& run) {
  Batch batch;
  for (int i = 0; i < 100; ++i) {
    afm::Run ahead = run;
    for (int batches = 0; batches < 10 && advance_impacts(1, ahead, batch) == Outcome::time_limit; ++batches) {
    }
    if (batch.impacts.empty()) return;  // it slides on and on
    if (batch.impacts.front().kind == kind) {
      if (!chance.one_in(4.0)) advance_to(run.now() + chance.within(0.0, 1.0) * (ahead.now() - run.now()), run, batch);
      return;
    }
    advance_impacts(1, run, batch);
  }
}

}  // namespace afm
