// Compiled for AVX2 and fused multiply-add whatever the rest is compiled for; run only where the machine has them.
#include "node_step.h"
#include "registers_avx2.h"
#include "step_nodes.h"

void afm::lanes::node_step_avx2(const ChatterFlow& flow, const ChatterPlace& from, double dt, ChatterPlace& to) {
  afm::node_step<Pack>(flow, from, dt, to);
}
