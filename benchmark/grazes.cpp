// Built grazes against quad precision: is each touch a touch and each miss a miss? And how often twice the digits are
// needed, in grazes and in ordinary flights.
#include "trials/grazes.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "afm/reflection.h"
#include "common/command_line.h"

namespace {

struct Options {
  int flights = 300;
  std::vector<std::string> kinds;
  long ordinary = 100000;
};

using Build = afm::Graze (afm::Grazes::*)(double);

long print_row(const char* name, Build build, double clearance, const Options& o) {
  constexpr int kNeighbours = 2;  // starts next to each, to either side
  afm::Grazes grazes(1);
  afm::GrazeCount count;
  for (int i = 0; i < o.flights; ++i) afm::decide_neighbours((grazes.*build)(clearance), kNeighbours, count);
  std::printf("%s,%.0e,%ld,%ld,%ld,%ld,%ld\n", name, clearance / afm::Model().H, count.touched + count.missed,
              count.touched, count.missed, count.finer, count.wrong);
  std::fflush(stdout);
  return count.wrong;
}

// From impact to impact.
void print_ordinary(double eta, const Options& o) {
  afm::Model model;
  const afm::SpringConstants<double> springs(model);
  afm::TipState start{0.25, 0.0, eta, 0.2, 0.0};
  long finer = 0;
  for (long i = 0; i < o.ordinary; ++i) {
    const afm::Flight<double> flight(springs, eta, start);
    const auto landing = afm::find_landing(model, flight, afm::kGrazeHorizon);
    if (afm::detail::find_impact(flight, afm::kGrazeHorizon).outcome == afm::SearchOutcome::undecided) ++finer;
    start = landing.outcome == afm::SearchOutcome::impact ? afm::reflect(model, eta, landing.jet).after
                                                          : flight.tip_state(landing.s);
  }
  std::printf("ordinary at eta %g,,%ld,,,%ld,\n", eta, o.ordinary, finer);
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  afm::CommandLine app(
      "grazes", "Grazes decided in double and double-double, against quad precision (clearances in units of H).");
  app.option("flights", o.flights, "built, of each kind and clearance");
  app.option("ordinary", o.ordinary, "flights of ordinary runs, at each drag speed");
  app.option("kinds", o.kinds, "flight, start, tau: all by default");
  return app.run(argc, argv, [&] {
    std::printf("graze,clearance,flights,touched,missed,in_double_double,wrong\n");
    const std::pair<const char*, Build> kinds[] = {{"flight", &afm::Grazes::after_a_flight},
                                                   {"start", &afm::Grazes::after_the_start},
                                                   {"tau", &afm::Grazes::every_tau}};
    long wrong = 0;
    for (const auto& kind : kinds) {
      if (!o.kinds.empty() && std::find(o.kinds.begin(), o.kinds.end(), kind.first) == o.kinds.end()) continue;
      for (int digits = 3; digits <= 15; ++digits) {
        const double clearance = std::pow(10.0, -digits) * afm::Model().H;
        wrong += print_row(kind.first, kind.second, clearance, o) + print_row(kind.first, kind.second, -clearance, o);
      }
      wrong += print_row(kind.first, kind.second, 0.0, o);
    }
    for (const double eta : {0.5, 2.0, 2.75, 3.4, 5.0, 7.05, 8.0}) print_ordinary(eta, o);
    std::printf("%ld wrong\n", wrong);
    return wrong == 0 ? 0 : 1;
  });
}
