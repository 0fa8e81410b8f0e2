// The friction coefficient (by the work of the drag) over successive windows of time, for tips from many random starts:
// whether they end alike, and how long each stays where it is. CSV.
#include <cstdio>
#include <random>

#include "afm/tip.h"
#include "common/command_line.h"

namespace {

struct Options {
  double eta = 3.75, temperature = 0.0, quality_factor = 0.0, window = 20.0, duration = 2000.0, transient = 1000.0;
  int starts = 24;
  std::uint64_t seed = 1;
};

afm::Tip tip_number(int n, const Options& o) {
  std::mt19937_64 random(o.seed + static_cast<std::uint64_t>(n));
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const double phase = uniform(), height = uniform();
  afm::Tip tip(afm::Model{}, o.eta, afm::FreeState{phase, 0.0, 0.1 + 0.5 * height, o.eta * uniform(), 0.0});
  afm::Bath bath;
  bath.temperature = o.temperature;
  bath.quality_factor = o.quality_factor;
  bath.seed = o.seed;
  bath.stream = static_cast<std::uint64_t>(n);
  tip.set_bath(bath);
  return tip;
}

// The work of the drag up to a time.
class Work {
 public:
  explicit Work(afm::Tip& tip) : tip_(tip) {}
  double up_to(const afm::ModelTime& time) {
    while (tip_.advance_segment(time, &ended_) != afm::Outcome::time_limit) {
      for (const afm::Segment& segment : ended_) done_ += segment.work();
    }
    return done_ + tip_.segment().work();
  }

 private:
  afm::Tip& tip_;
  afm::Segments ended_;
  double done_ = 0.0;
};

void print_windows(int n, const Options& o) {
  afm::Tip tip = tip_number(n, o);
  Work work(tip);
  afm::ModelTime time = afm::ModelTime{} + o.transient;
  double before = work.up_to(time);
  for (int i = 1; i * o.window <= o.duration; ++i) {
    const double now = work.up_to(time + i * o.window);
    std::printf("%d,%g,%.8g\n", n, o.transient + i * o.window, (now - before) / (o.eta * o.eta * o.window));
    before = now;
  }
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  afm::CommandLine app("friction_windows",
                       "K_f by the work of the drag, window by window, for tips from random starts.");
  app.option("eta", o.eta, "drag velocity [a/tau]", afm::kPositive);
  app.option("temperature", o.temperature, "kT of the heat bath [m a^2/tau^2]", {0.0, afm::kMaxTemperature});
  app.option("quality-factor", o.quality_factor, "of the cantilever; 0: no bath", {0.0, 1e12});
  app.option("window", o.window, "[tau]", afm::kPositive);
  app.option("duration", o.duration, "of each tip [tau]", afm::kPositive);
  app.option("transient", o.transient, "before it [tau]", {0.0, 1e9});
  app.option("starts", o.starts, "tips", {1, 100000});
  app.option("seed", o.seed, "of the starts and of the heat bath");
  return app.run(argc, argv, [&] {
    std::printf("start,time,k_f_work\n");
    for (int n = 0; n < o.starts; ++n) print_windows(n, o);
    return 0;
  });
}
