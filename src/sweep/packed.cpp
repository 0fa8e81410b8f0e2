#include "packed.h"

#include <algorithm>

namespace afm {

PackedState pack(const TipState& s) { return {s.phase, s.X, s.u, s.g, s.g1}; }

TipState unpack(const PackedState& n) { return {n[0], n[1], n[2], n[3], n[4]}; }

PackedResult pack(const SweepResult& r) {
  const FrictionAverage& f = r.friction;
  PackedResult numbers{f.K_f,
                       f.K_f_std_error,
                       f.impacts_per_tau,
                       f.mean_energy_loss,
                       f.mean_flight_time,
                       static_cast<double>(f.search_failures),
                       r.attractor.lyapunov.exponents[0],
                       static_cast<double>(r.attractor.kind),
                       static_cast<double>(r.attractor.impacts),
                       static_cast<double>(r.attractor.cells),
                       f.K_f_work,
                       f.K_f_work_std_error};
  const PackedState end = pack(r.end);
  std::copy(end.begin(), end.end(), numbers.end() - kPackedState);
  return numbers;
}

SweepResult unpack(const PackedResult& n) {
  SweepResult r;
  r.friction = {n[0], n[1], n[2], n[3], n[4], static_cast<std::uint64_t>(n[5]), n[10], n[11]};
  r.attractor.lyapunov.exponents[0] = n[6];
  r.attractor.kind = static_cast<AttractorKind>(n[7]);
  r.attractor.impacts = static_cast<int>(n[8]);
  r.attractor.cells = static_cast<int>(n[9]);
  PackedState end;
  std::copy(n.end() - kPackedState, n.end(), end.begin());
  r.end = unpack(end);
  return r;
}

}  // namespace afm
