// Compiled for AVX2 and fused multiply-add whatever the rest is compiled for; run only where the machine has them.
#include "registers_avx2.h"
#include "schedule.h"

void afm::lanes::advance_avx2(const Work& work) { Schedule(work).run(); }
