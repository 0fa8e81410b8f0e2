// The orders of a slide's series with their three products in the lanes of one register. No code of its own: it is
// shared by files that are compiled for different machines.
#pragma once

#include "afm/detail/slide_orders.h"

namespace afm {
namespace lanes {

using WriteSlideOrders = void (*)(const SlideBeginning<double>& start, double* d, double* u, double* lambda);

// On the machine this runs on; null where it has no lanes.
WriteSlideOrders slide_orders();

void slide_orders_avx2(const SlideBeginning<double>& start, double* d, double* u, double* lambda);

}  // namespace lanes
}  // namespace afm
