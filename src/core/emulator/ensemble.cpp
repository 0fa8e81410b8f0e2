#include "afm/ensemble.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <thread>

#include "afm/detail/multiversion.h"
#include "core/lanes/lane_tip.h"

namespace afm {
namespace {

using lanes::LaneTip;
using lanes::Stage;

double bits_of(std::int64_t n) {
  double bits;
  static_assert(sizeof bits == sizeof n, "");
  std::copy_n(reinterpret_cast<const char*>(&n), sizeof n, reinterpret_cast<char*>(&bits));
  return bits;
}
std::int64_t whole_of(double bits) {
  std::int64_t n;
  std::copy_n(reinterpret_cast<const char*>(&bits), sizeof n, reinterpret_cast<char*>(&n));
  return n;
}

ModelTime time_in(const LaneTip& row, lanes::Field tau, lanes::Field phase) {
  return {whole_of(row.row[tau]), row.row[phase]};
}

AFM_MULTIVERSION bool ends_soon(const Flight<double>& flight) {
  return search_detail::root_from_launch(flight).certain;
}

// Off the surface, and for longer than a bounce among many: lanes know no other.
bool ordinary(const Tip& tip) {
  const Flight<double>& flight = tip.flight();
  return tip.in_flight() && flight.launch().g == 0.0 && flight.launch().g1 > lanes::kSlowestLaunch &&
         !ends_soon(flight);
}

AFM_MULTIVERSION void begin_search(const Flight<double>& flight, double* row) {
  search_detail::take_off(flight, row[lanes::kS], row[lanes::kAhead], row[lanes::kGuess]);
}

void write_model(const Tip& tip, double* row) {
  using namespace lanes;
  const Mechanics<double>& m = tip.flight().mechanics();
  const Model& model = tip.model();
  const double values[] = {tip.burst_gap_rate(), m.ratio,    m.omega_h,   m.per_omega_h, m.H, m.y0,
                           tip.flight().eta(),   m.mobility, model.gamma, model.v_c};
  constexpr int kPlaces[] = {kBurstGapRate, kRatio, kOmegaH,   kPerOmegaH, kAmplitude,
                             kCentre,       kEta,   kMobility, kGamma,     kCutoff};
  static_assert(sizeof values / sizeof *values == sizeof kPlaces / sizeof *kPlaces, "a place for each");
  for (std::size_t i = 0; i < sizeof values / sizeof *values; ++i) row[kPlaces[i]] = values[i];
}

void write_flight(const Flight<double>& flight, const ModelTime& start, double* row) {
  using namespace lanes;
  const GapJet<double>& o = flight.start();
  const FlightBounds<double>& b = flight.bounds();
  const double values[] = {
      o.state.phase, flight.launch().u, o.state.X, o.state.U, o.state.Y, o.state.W, o.g1, o.g2, o.g3, o.h, o.h1, b.X,
      b.Y,           b.second,          b.third,   b.fourth,  b.drive,   b.fastest};
  static_assert(kPhase == 0 && kFastest == 17 && sizeof values / sizeof *values == 18, "in the order of the fields");
  std::copy(std::begin(values), std::end(values), row);
  row[kStartTau] = bits_of(start.tau);
  row[kStartPhase] = start.phase;
}

// The flight of a tip, from its launch on, for lanes to go on with.
void take_up(const Tip& tip, LaneTip& row) {
  write_model(tip, row.row);
  Flight<double> flight = tip.flight();
  flight.bound_derivatives();
  write_flight(flight, tip.flight_start(), row.row);
  begin_search(flight, row.row);
  row.last = tip.last_impact();
  row.row[lanes::kCount] = 0.0;
  row.stage = Stage::look;
}

}  // namespace

namespace {

int lanes_in(LaneUse use) { return use == LaneUse::none ? 1 : use == LaneUse::four ? 4 : 8; }

}  // namespace

int Ensemble::lanes() const {
  int width = lanes_in(use_);
  while (width > 1 && lanes::advance_in(width) == nullptr) width /= 2;
  // what eight would be given is four where the machine has no more
  return width == 8 && lanes::advance_in(8) == lanes::advance_in(4) ? 4 : width;
}

struct Ensemble::Call {
  Ensemble* ensemble;
  std::uint32_t events;
  const ModelTime* limits;
  std::size_t stride;  // 0: one limit for all
  Impact* log;
  lanes::Advance in_lanes;

  const ModelTime& limit(std::size_t i) const { return limits[i * stride]; }
};

Ensemble::Ensemble(int threads, LaneUse use) : threads_(std::max(1, threads)), use_(use) {}
Ensemble::~Ensemble() = default;
Ensemble::Ensemble(Ensemble&&) noexcept = default;
Ensemble& Ensemble::operator=(Ensemble&&) noexcept = default;

void Ensemble::reserve(std::size_t tips) {
  members_.reserve(tips);
  rows_.reserve(tips);
}

void Ensemble::add(const Tip& tip) {
  members_.push_back({tip, tip.now(), 0, 0});
  LaneTip row{};
  row.last = tip.last_impact();
  row.stage = Stage::single;
  rows_.push_back(row);
}

std::uint32_t Ensemble::events(std::size_t i) const { return rows_[i].events; }
const Impact& Ensemble::last_impact(std::size_t i) const { return rows_[i].last; }

Tip& Ensemble::up_to_date(std::size_t i) {
  Member& member = members_[i];
  LaneTip& row = rows_[i];
  if (row.bounced) {
    const double* r = row.row;
    member.tip.resume({r[lanes::kPhase], r[lanes::kX], r[lanes::kU], 0.0, r[lanes::kG1]},
                      time_in(row, lanes::kStartTau, lanes::kStartPhase), row.last);
    row.bounced = false;
  }
  if (member.tip.now() < member.time) member.tip.advance(member.time);
  return member.tip;
}

void Ensemble::drag(std::size_t i, double eta) {
  up_to_date(i).drag(eta);
  rows_[i].stage = Stage::single;
  rows_[i].stuck = false;
}

// A flight that stopped lanes is gone through to its end; then lanes may have the next.
bool Ensemble::fly_alone(void* context, LaneTip& row) {
  const Call& call = *static_cast<const Call*>(context);
  const std::size_t i = static_cast<std::size_t>(&row - call.ensemble->rows_.data());
  Tip& tip = call.ensemble->up_to_date(i);
  while (row.events < call.events) {
    if (call.in_lanes != nullptr && !row.stuck && ordinary(tip)) {
      take_up(tip, row);
      return true;
    }
    const Outcome outcome = tip.advance(call.limit(i));
    if (outcome == Outcome::time_limit) return false;
    row.stuck = false;
    ++row.events;
    ++call.ensemble->members_[i].events_alone;
    if (outcome == Outcome::search_failed) {
      ++call.ensemble->members_[i].search_failures;
      continue;
    }
    row.last = tip.last_impact();
    if (row.log != nullptr) *row.log++ = row.last;
  }
  return false;
}

void Ensemble::fly(const Call& call, std::size_t from, std::size_t to) {
  for (std::size_t i = from; i < to; ++i) {
    LaneTip& row = rows_[i];
    row.events = members_[i].search_failures = members_[i].events_alone = 0;
    row.log = call.log == nullptr ? nullptr : call.log + i * call.events;
    row.row[lanes::kLimitTau] = bits_of(call.limit(i).tau);
    row.row[lanes::kLimitPhase] = call.limit(i).phase;
    row.waits = row.stage == Stage::bounce && call.limit(i) < time_in(row, lanes::kEndTau, lanes::kEndPhase);
  }
  if (call.in_lanes != nullptr) {
    LaneTip spare = rows_[from];
    spare.log = nullptr;
    void* context = const_cast<Call*>(&call);
    call.in_lanes({&rows_[from], static_cast<std::uint32_t>(to - from), call.events, &spare, fly_alone, context});
  } else {
    for (std::size_t i = from; i < to; ++i) fly_alone(const_cast<Call*>(&call), rows_[i]);
  }
  for (std::size_t i = from; i < to; ++i) {
    if (rows_[i].waits && members_[i].time < call.limit(i)) members_[i].time = call.limit(i);
  }
}

void Ensemble::advance(std::uint32_t events, const ModelTime& limit, Impact* log) {
  advance_all({this, events, &limit, 0, log, lanes::advance_in(lanes_in(use_))});
}

void Ensemble::advance(std::uint32_t events, const ModelTime* limits, Impact* log) {
  advance_all({this, events, limits, 1, log, lanes::advance_in(lanes_in(use_))});
}

void Ensemble::advance(const ModelTime& limit) { advance(std::numeric_limits<std::uint32_t>::max(), limit); }

void Ensemble::advance_all(const Call& call) {
  if (call.events == 0 || members_.empty()) return;
  // pieces small enough that none is left to do much when the others have finished
  constexpr std::size_t kLeast = 64, kPiecesPerThread = 8;
  const std::size_t threads = static_cast<std::size_t>(threads_);
  const std::size_t piece = threads == 1 ? size() : std::max(kLeast, size() / (threads * kPiecesPerThread));
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t from; (from = next.fetch_add(piece)) < size();) fly(call, from, std::min(from + piece, size()));
  };
  std::vector<std::thread> helpers;
  for (std::size_t i = 1; i < threads && i * piece < size(); ++i) helpers.emplace_back(work);
  work();
  for (std::thread& helper : helpers) helper.join();
}

}  // namespace afm
