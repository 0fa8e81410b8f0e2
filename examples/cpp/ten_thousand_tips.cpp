// Ten thousand tips on all processors: how much the friction of one tip over 10 tau differs from that of another.
#include <afm/afm.h>

#include <algorithm>
#include <cstdio>
#include <thread>
#include <vector>

int main() {
  constexpr std::size_t kTips = 10000, kEvents = 32;
  const afm::Model mica;
  const double eta = 3.4, duration = 10.0;  // [a/tau], [tau]
  afm::Ensemble tips(static_cast<int>(std::thread::hardware_concurrency()));
  for (std::size_t i = 0; i < kTips; ++i) {
    const double phase = static_cast<double>(i) / kTips;  // evenly over one cell of the surface
    tips.add(afm::Tip(mica, eta, afm::FreeState{phase, 0.0, 0.2, eta, 0.0}));
  }

  std::vector<double> K_f(kTips, 0.0);            // of each tip [m_tip/tau]
  std::vector<afm::Impact> log(kTips * kEvents);  // of one call
  const afm::ModelTime begin{20, 0.0}, end = begin + duration;
  tips.advance(begin);  // onto the attractor
  for (bool on_the_way = true; on_the_way;) {
    tips.advance(kEvents, end, log.data());
    on_the_way = false;
    for (std::size_t i = 0; i < kTips; ++i) {
      for (std::size_t n = 0; n < tips.events(i); ++n)
        K_f[i] += log[i * kEvents + n].energy_loss / (eta * eta * duration);
      on_the_way = on_the_way || tips.events(i) == kEvents;
    }
  }
  std::sort(K_f.begin(), K_f.end());
  std::printf("K_f: median %.6g m_tip/tau, nine in ten within %.6g and %.6g\n", K_f[kTips / 2], K_f[kTips / 20],
              K_f[kTips - kTips / 20]);
}
