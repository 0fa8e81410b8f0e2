#include "common/cpu_clock.h"
#include "quantile.h"
#include "speed_accuracy.h"

namespace afm {
namespace {

// A contender at work on a scene.
struct Entry {
  Entry(const Contender& c, std::size_t flights) : method(c.spec->make(c.setting)), hits(flights) {}

  rivals::Method method;
  std::vector<rivals::Hit> hits;
  std::vector<double> ns, exact_ns;  // a round each
  double used = 0.0;                 // [s]
};

// Time for one flight [ns]; short lists are run several times, or the clock would be most of it.
double pass(const FlightScene& scene, const rivals::Method& method, std::vector<rivals::Hit>& hits) {
  constexpr double kShortest = 2e-3;  // [s]
  const double start = thread_seconds();
  double seconds = 0.0;
  int passes = 0;
  for (; seconds < kShortest; ++passes, seconds = thread_seconds() - start) {
    for (std::size_t i = 0; i < hits.size(); ++i) {
      hits[i] = method(scene.model, scene.eta, scene.flights[i].start, kFlightHorizon);
    }
  }
  return 1e9 * seconds / (passes * static_cast<double>(hits.size()));
}

SpeedRow score(const FlightScene& scene, const Contender& contender, const Entry& entry) {
  FlightScore s;
  for (std::size_t i = 0; i < entry.hits.size(); ++i) s.add(scene.flights[i], entry.hits[i], scene);
  SpeedRow row{contender, scene.name};
  std::vector<double> ratios;
  for (std::size_t i = 0; i < entry.ns.size(); ++i) ratios.push_back(entry.ns[i] / entry.exact_ns[i]);
  row.ns = quantile(entry.ns, 0.5);
  row.exact_ns = quantile(entry.exact_ns, 0.5);
  row.ratio = quantile(ratios, 0.5);
  row.missed = static_cast<long long>(s.missed);
  row.phantom = static_cast<long long>(s.phantom);
  row.impacts = static_cast<long long>(scene.flights.size());
  row.error_median = quantile(s.errors, 0.5);
  row.error_p99 = quantile(s.errors, 0.99);
  row.error_max = quantile(s.errors, 1.0);
  row.errors = std::move(s.errors);
  return row;
}

}  // namespace

std::vector<SpeedRow> measure_flights(const FlightScene& scene, const std::vector<Contender>& contenders, int rounds,
                                      double most_seconds, const Progress& progress) {
  const auto exact = rivals::find_method("exact")->make(0.0);
  std::vector<rivals::Hit> exact_hits(scene.flights.size());
  std::vector<Entry> entries;
  for (const Contender& c : contenders) entries.emplace_back(c, scene.flights.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < entries.size(); ++i) {
      Entry& e = entries[i];
      if (e.used > most_seconds) continue;
      progress(scene.name, contenders[i]);
      e.exact_ns.push_back(pass(scene, exact, exact_hits));
      const double start = thread_seconds();
      e.ns.push_back(pass(scene, e.method, e.hits));
      e.used += thread_seconds() - start;
    }
  }
  std::vector<SpeedRow> rows;
  for (std::size_t i = 0; i < entries.size(); ++i) rows.push_back(score(scene, contenders[i], entries[i]));
  return rows;
}

std::vector<SpeedRow> pool(const std::vector<std::vector<SpeedRow>>& scenes, const std::string& name) {
  std::vector<SpeedRow> pooled;
  for (std::size_t i = 0; !scenes.empty() && i < scenes.front().size(); ++i) {
    SpeedRow sum{scenes.front()[i].contender, name};
    double exact_ns = 0.0;
    for (const auto& rows : scenes) {
      const SpeedRow& row = rows[i];
      const double n = static_cast<double>(row.impacts);
      sum.ns += row.ns * n;
      exact_ns += row.exact_ns * n;
      sum.missed += row.missed;
      sum.phantom += row.phantom;
      sum.impacts += row.impacts;
      sum.errors.insert(sum.errors.end(), row.errors.begin(), row.errors.end());
    }
    sum.ratio = sum.ns / exact_ns;
    sum.ns /= static_cast<double>(sum.impacts);
    sum.error_median = quantile(sum.errors, 0.5);
    sum.error_p99 = quantile(sum.errors, 0.99);
    sum.error_max = quantile(sum.errors, 1.0);
    pooled.push_back(std::move(sum));
  }
  return pooled;
}

void print_header(std::FILE* out) {
  std::fprintf(
      out,
      "method,setting,scene,ns_per_impact,ratio_to_exact,error_median,error_p99,error_max,missed,phantom,impacts\n");
}

void print(const SpeedRow& r, std::FILE* out) {
  std::fprintf(out, "%s,%g,%s,%.4g,%.4g,%.3g,%.3g,%.3g,%lld,%lld,%lld\n", r.contender.spec->name.c_str(),
               r.contender.setting, r.scene.c_str(), r.ns, r.ratio, r.error_median, r.error_p99, r.error_max, r.missed,
               r.phantom, r.impacts);
  std::fflush(out);
}

}  // namespace afm
