// The symbolic dynamics of the hammer: a partition of its section, the words that occur, and those of its orbits.
#include "afm/dynamics/symbolic_dynamics.h"

#include <fstream>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "afm/dynamics/orbit_search.h"
#include "afm/number_text.h"
#include "common/point_options.h"
#include "common/table_writer.h"

namespace {

const char kDescription[] =
    "Cuts the section of the hammer's attractor (surface phase, gap rate after an impact; units a, tau, tip mass)\n"
    "into bands and each band in two, and counts words of the letters. Rows: length; words that occur; the\n"
    "shortest words that do not, though all their parts do (pruning); the entropy of a letter given those before\n"
    "it, to be compared with the exponent of an impact: a partition that says everything reaches it, none can go\n"
    "beyond; and the spread of the gap rate at the middle of a word, over that of all, in the mean and of the\n"
    "word that says least. With --orbits the periodic orbits up to --max-length follow by their words; with\n"
    "--section the points and where the map takes them.";

struct Options {
  afm::PointOptions dynamics;
  int impacts = 200000, longest = 8;
  afm::OrbitSearchSettings search;
  std::string section, orbits, forbidden;
};

void add_options(afm::CommandLine& app, Options& o) {
  o.dynamics.eta = 3.2;
  o.dynamics.model = "hammer";
  o.search.trajectory = 100000;
  o.search.guesses = 1500;
  afm::add_options(app, o.dynamics);
  app.option("max-length", o.longest, "of words and orbits", {1, 16});
  app.option("impacts", o.impacts, "of the run", {1000, 100000000});
  app.option("guesses", o.search.guesses, "of the search for orbits, of each of three kinds, for each length",
             {1, 1000000});
  app.option("seed", o.search.seed, "of the run and of the search");
  app.option("orbits", o.orbits, "file for the orbits: length, word, how many orbits have it, K_f, multipliers");
  app.option("section", o.section, "file for points: phase, gap_rate, phase_next, gap_rate_next, letter");
  app.option("forbidden", o.forbidden, "file for the shortest words that do not occur: length, word");
}

void close(std::ofstream& out, const std::string& path) {
  out.close();
  if (!out) throw std::runtime_error("cannot write " + path);
}

void write_section(const Options& o, const afm::Partition& partition, const std::vector<afm::TipState>& points) {
  std::ofstream out(o.section);
  constexpr std::size_t kMostPoints = 20000;  // enough for a picture
  afm::TableWriter table(out, "phase,gap_rate,phase_next,gap_rate_next,letter");
  table.write_header();
  for (std::size_t i = 0; i + 1 < points.size() && i < kMostPoints; ++i) {
    const afm::TipState &p = points[i], &q = points[i + 1];
    table << p.phase << p.g1 << q.phase << q.g1 << std::string(1, partition.letter(p));
    table.end_row();
  }
  close(out, o.section);
}

void write_orbits(const Options& o, const afm::PoincareMap& map, const afm::Partition& partition) {
  afm::OrbitSearchSettings search = o.search;
  search.longest = o.longest;
  const auto found = search_orbits(map, search);
  std::ofstream out(o.orbits);
  std::map<std::string, int> times;
  for (const afm::FoundOrbit& f : found.orbits) ++times[cyclic_word(partition, f.orbit.points)];
  afm::TableWriter table(out, "length,word,orbits_with_it,cells,k_f,phase,gap_rate,multiplier_1,multiplier_2,approach");
  table.write_header();
  for (const afm::FoundOrbit& f : found.orbits) {
    const std::string word = cyclic_word(partition, f.orbit.points);
    table << f.orbit.length() << word << times[word] << f.orbit.cells << f.orbit.K_f << f.orbit.points[0].phase
          << f.orbit.points[0].g1 << f.orbit.multipliers[0].real() << f.orbit.multipliers[1].real() << f.approach;
    table.end_row();
  }
  close(out, o.orbits);
}

void write_forbidden(const Options& o, const std::vector<afm::WordCount>& counts) {
  std::ofstream out(o.forbidden);
  out << "length,word\n";
  for (const afm::WordCount& row : counts) {
    for (const std::string& word : row.forbidden) out << row.length << "," << word << "\n";
  }
  close(out, o.forbidden);
}

void report(const afm::Partition& partition, const afm::SymbolicRun& run) {
  for (std::size_t k = 0; k < partition.cuts.size(); ++k) {
    std::cerr << "band " << k + 1 << ": from phase " << partition.begins[k] << "; letters "
              << static_cast<char>('a' + 2 * k) << " and " << static_cast<char>('b' + 2 * k)
              << " below and above a gap rate of " << partition.cuts[k] << "\n";
  }
  std::cerr << "exponent of an impact: " << run.exponent << " +- " << run.exponent_std_error << "\n";
}

int run(const Options& o) {
  const afm::Model model = checked_model(o.dynamics);
  if (model.kind != afm::ModelKind::hammer) {
    throw std::invalid_argument(
        "model = oscillator: its section has four dimensions; the partition is for the hammer's two");
  }
  if (o.dynamics.eta == 0.0) throw std::invalid_argument("eta = 0: without drag there is nothing but rest");
  for (const std::string& path : {o.section, o.forbidden, o.orbits}) afm::check_writable(path);
  const afm::PoincareMap map(model, o.dynamics.eta);
  const afm::SymbolicRun run = run_on_section(map, static_cast<std::size_t>(o.impacts), o.search.seed);
  if (!run.on_section) throw std::runtime_error("the hammer has ended in contact: there is no section");
  if (!(run.exponent > 0.0)) {
    throw std::runtime_error("the exponent of an impact is " + afm::number_text(run.exponent) +
                             ": without chaos there are no words to count");
  }
  const afm::Partition partition = find_partition(run.points);
  if (partition.letters() > 26) throw std::runtime_error("the section has more bands than there are letters for");
  const std::string letters = word_of(partition, run.points);
  const auto counts = afm::count_words(letters, partition.letters(), o.longest);
  report(partition, run);
  afm::TableWriter table(std::cout, "length,words,forbidden,entropy,exponent,exponent_std_error,spread,largest_spread");
  table.write_header();
  for (const afm::WordCount& row : counts) {
    const afm::WordSpread spread = afm::word_spread(letters, run.points, row.length);
    table << row.length << row.words << row.forbidden.size() << row.entropy << run.exponent << run.exponent_std_error
          << spread.mean << spread.largest;
    table.end_row();
  }
  if (!o.section.empty()) write_section(o, partition, run.points);
  if (!o.forbidden.empty()) write_forbidden(o, counts);
  if (!o.orbits.empty()) write_orbits(o, map, partition);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  afm::CommandLine app("symbolic_dynamics", kDescription);
  Options options;
  add_options(app, options);
  return app.run(argc, argv, [&] { return run(options); });
}
