// Compiled for AVX2 and fused multiply-add whatever the rest is compiled for; run only where the machine has them.
#include "registers_avx2.h"
#include "samples.h"

double afm::lanes::sample_avx2(const SampleRow& row) { return sample(row); }
