// Compiled for AVX-512. It runs only on machines that have it.
#include "registers_avx512.h"
#include "samples.h"

double afm::lanes::sample_avx512(const SampleRow& row) { return sample(row); }
