// Compiled for AVX2 and fused multiply-add. It runs only on machines that have both.
#include "registers_avx2.h"
#include "samples.h"

double afm::lanes::sample_avx2(const SampleRow& row) { return sample(row); }
