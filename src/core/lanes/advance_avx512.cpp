// Likewise for AVX-512.
#include "registers_avx512.h"
#include "schedule.h"

void afm::lanes::advance_avx512(const Work& work) { Schedule(work).run(); }
