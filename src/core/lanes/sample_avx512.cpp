// Compiled for AVX-512 whatever the rest is compiled for; run only where the machine has it.
#include "registers_avx512.h"
#include "samples.h"

double afm::lanes::sample_avx512(const SampleRow& row) { return sample(row); }
