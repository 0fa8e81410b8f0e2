// Methods against the scenes on which methods fail, each cell measured and judged. CSV.
#include <unistd.h>

#include <cstdio>
#include <stdexcept>

#include "common/command_line.h"
#include "stability.h"

namespace {

using afm::Cell;
using afm::StabilityScene;
using afm::Verdict;
using afm::rivals::MethodSpec;

const char kDescription[] =
    "Runs every method on scenes on which methods fail and writes a CSV table:\n"
    "scene,about,method,setting,verdict,number,meaning,ns_per_tau,right_below. right: every impact found and\n"
    "every error below 1e-6 (K_f: 1e-3, chaotic 5 %). stalls: time freezes, the method gives up, or when\n"
    "--seconds are over less than half of a run or not all flights are done; on `hour`, slower than the tip.\n"
    "exact_one_by_one is ours without bursts and contact (contact tolerance 0). Exit code 1 if one of ours (exact) is "
    "not right.";

struct Options {
  afm::Effort effort;
  std::vector<std::string> methods, scenes;
};

struct Column {
  std::string name;
  const MethodSpec* spec;
  double setting;
};

std::vector<Column> columns() {
  std::vector<Column> all;
  for (const MethodSpec& spec : afm::rivals::methods()) {
    all.push_back({spec.name, &spec, afm::usual_setting(spec)});
    if (spec.name == "exact") all.push_back({"exact_one_by_one", &spec, 0.0});
  }
  return all;
}

template <class T>
void check(const char* option, const std::vector<std::string>& chosen, const std::vector<T>& all) {
  std::vector<std::string> names;
  for (const T& one : all) names.push_back(one.name);
  afm::rivals::check_names(option, chosen, names);
}

void print(const StabilityScene& scene, const Column& column, double setting, const Cell& cell) {
  std::printf("%s,\"%s\",%s,%g,%s,%.3g,%s,%.4g,%g\n", scene.name.c_str(), scene.about.c_str(), column.name.c_str(),
              setting, afm::name_of(cell.verdict), cell.number, cell.meaning.c_str(), cell.ns_per_tau,
              scene.right_below);
  std::fflush(stdout);
}

// Whether all of ours were right.
bool run(const Options& o, const std::vector<StabilityScene>& scenes) {
  const bool terminal = isatty(STDERR_FILENO) != 0;
  bool ours_right = true;
  std::printf("scene,about,method,setting,verdict,number,meaning,ns_per_tau,right_below\n");
  for (const StabilityScene& scene : scenes) {
    if (!afm::rivals::is_chosen(o.scenes, scene.name)) continue;
    for (const Column& column : columns()) {
      if (!afm::rivals::is_chosen(o.methods, column.name)) continue;
      if (terminal) std::fprintf(stderr, "\r\033[K%s: %s", scene.name.c_str(), column.name.c_str());
      const double setting = scene.setting ? scene.setting(*column.spec) : column.setting;
      if (scene.setting && column.name == "exact_one_by_one") continue;
      const Cell cell = scene.measure(*column.spec, setting, o.effort);
      print(scene, column, setting, cell);
      if (column.name != "exact" || cell.verdict == Verdict::right) continue;
      ours_right = false;
      std::fprintf(stderr, "%sstability_matrix: ours, %s (%s): %s, %s %g\n", terminal ? "\r\033[K" : "",
                   scene.name.c_str(), scene.about.c_str(), afm::name_of(cell.verdict), cell.meaning.c_str(),
                   cell.number);
    }
  }
  if (terminal) std::fprintf(stderr, "\r\033[K");
  return ours_right;
}

}  // namespace

namespace afm {

const char* name_of(Verdict verdict) {
  constexpr const char* kNames[] = {"right", "inaccurate", "misses", "phantom", "stalls", "blows up"};
  return kNames[static_cast<std::size_t>(verdict)];
}

}  // namespace afm

int main(int argc, char** argv) {
  Options o;
  afm::CommandLine app("stability_matrix", kDescription);
  app.flag("quick", o.effort.quick, "fewer flights, shorter runs");
  app.option("methods", o.methods, "only these");
  app.option("scenes", o.scenes, "only these");
  app.option("seconds", o.effort.seconds, "of processor time for a cell (hour and gamma_1: 10 times as much)");
  return app.run(argc, argv, [&] {
    std::vector<StabilityScene> scenes = afm::run_scenes();
    for (StabilityScene& scene : afm::flight_scenes(o.effort)) scenes.push_back(std::move(scene));
    check("methods", o.methods, columns());
    check("scenes", o.scenes, scenes);
    const bool ours_right = run(o, scenes);
    if (std::ferror(stdout) != 0) throw std::runtime_error("cannot write the output");
    return ours_right ? 0 : 1;
  });
}
