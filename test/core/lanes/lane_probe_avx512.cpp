#include "core/lanes/registers_avx512.h"
// after the registers
#include "core/lanes/pack.h"
#include "lane_probe_functions.h"

namespace afm {

void probe_avx512(const double* x, const double* y, const double* z, double results[kProbeResults][kProbeLanes]) {
  for (int at = 0; at < kProbeLanes; at += kLanes) {
    Pack packs[kProbeResults];
    probe_functions(Pack(_mm512_loadu_pd(x + at)), Pack(_mm512_loadu_pd(y + at)), Pack(_mm512_loadu_pd(z + at)), packs);
    for (int k = 0; k < kProbeResults; ++k) _mm512_storeu_pd(results[k] + at, packs[k].r);
  }
}

}  // namespace afm
