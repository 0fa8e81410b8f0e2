// Kept for programs that include it by this name.
#pragma once

#include "afm/time_average.h"
