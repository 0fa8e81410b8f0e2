// What the audit says of what it found: a line a subject.
#include <algorithm>
#include <cstdarg>
#include <cstdio>

#include "bag_audit.h"
#include "node/wire/diagnosis.h"

namespace afm::audit {
namespace {

constexpr double kSumRounding = 1e-11;  // of thousands of impacts, each rounded to SI
constexpr double kLawRounding = 1e-12;  // of a handful of products

__attribute__((format(printf, 1, 2))) std::string format(const char* pattern, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(text, sizeof text, pattern, arguments);
  va_end(arguments);
  return text;
}

Finding judge(bool good, const char* subject, std::string text) {
  return {good ? Finding::Kind::good : Finding::Kind::bad, subject, std::move(text)};
}

unsigned long long number(std::uint64_t value) { return value; }

}  // namespace

void BagAudit::report_extent(std::vector<Finding>& findings) const {
  const double wall = (end_stamp_ - begin_stamp_).toSec();
  const auto& first = log_.epochs().begin()->second.configuration;
  findings.push_back(
      {Finding::Kind::note, "run",
       format("version %s, arithmetic %s, %g samples/s, %g batches/s, time scale %g", first.version.c_str(),
              first.arithmetic_digest.c_str(), first.sample_rate_hz, first.batch_rate_hz, first.time_scale)});
  findings.push_back(
      {Finding::Kind::note, "extent",
       format("%llu samples, %llu records of %llu impacts, %llu epochs; %.6g s of model time in %.6g s of "
              "wall time",
              number(samples_), number(impacts_), number(bounces_), number(epochs_), model_seconds_, wall)});
  if (changes_ > 0) {
    findings.push_back({Finding::Kind::note, "steered", format("%llu changes of live parameters", number(changes_))});
  }
}

void BagAudit::report_sequence(std::vector<Finding>& findings) const {
  const auto& gaps = batches_.gaps();
  findings.push_back(judge(gaps.messages + status_gaps_ == 0, "messages",
                           gaps.messages == 0
                               ? format("%llu batches, none missing; %llu status messages missing",
                                        number(batches_.read()), number(status_gaps_))
                               : format("%llu missing, the first %s", number(gaps.messages), gaps.first.c_str())));
  findings.push_back(judge(grid_errors_ == 0, "sample grid",
                           format("%llu batches do not follow on, or are not at their times", number(grid_errors_))));
  findings.push_back(
      judge(order_errors_ == 0, "impact order",
            format("%llu batches whose impacts or ends are out of order, or do not follow on", number(order_errors_))));
  const auto& marks = recording_.bags().back()->marks;
  const std::uint64_t dropped = marks.empty() ? 0 : marks.back().dropped_messages;
  findings.push_back(judge(recording_.is_closed(), "closed",
                           !recording_.is_closed()     ? "no: killed, or the end is cut off; sound as far as it goes"
                           : recording_.is_continued() ? "goes on in another bag"
                                                       : "by the recorder"));
  findings.push_back(judge(dropped == 0, "dropped", format("%llu messages by the recorder", number(dropped))));
}

void BagAudit::report_digests(std::vector<Finding>& findings) const {
  if (digests_ == 0) {
    findings.push_back({Finding::Kind::note, "digests", "none in the recording: whether it was altered is unknown"});
    return;
  }
  findings.push_back(judge(!contradiction_, "digests",
                           !contradiction_ ? format("%llu, all of what is recorded", number(digests_))
                                           : contradiction_->field + " is not that of what is recorded: altered"));
}

void BagAudit::report_energy(std::vector<Finding>& findings) const {
  const EnergyReport& e = energy_report_;
  findings.push_back(
      judge(e.law_error <= kLawRounding, "impact law",
            format("%llu single impacts lose what restitution and normal speed say, within %.1e of their "
                   "energy",
                   number(e.by_law), e.law_error)));
  if (e.judged == 0) {
    findings.push_back({Finding::Kind::note, "energy balance", "no impact stands alone between two pairs of samples"});
    return;
  }
  const bool good = e.balance_error <= e.allowed && e.position_error <= e.allowed && e.speed_error <= e.allowed;
  findings.push_back(
      judge(good, "energy balance",
            format("%llu of %llu impacts (%.3g %% of the energy lost) stand alone between samples: energy "
                   "in - out = lost within %.1e, place %.1e, speed %.1e (rounding allows %.1e)",
                   number(e.judged), number(e.events), 100.0 * e.judged_energy / e.energy, e.balance_error,
                   e.position_error, e.speed_error, e.allowed)));
}

void BagAudit::report_balance(std::vector<Finding>& findings) const {
  const EnergyReport& e = energy_report_;
  if (e.balanced == 0) {
    findings.push_back({Finding::Kind::note, "work", "no two estimates of friction end in a flight with samples"});
    return;
  }
  findings.push_back(
      judge(e.work_error <= std::max(e.allowed, kSumRounding), "work",
            format("work of the drag = lost in impacts + heat + change of stored energy at %llu estimates "
                   "of friction, within %.1e",
                   number(e.balanced), e.work_error)));
}

void BagAudit::report_friction(std::vector<Finding>& findings) const {
  const FrictionReport& f = friction_report_;
  findings.push_back(judge(f.miscounted == 0 && f.energy_error <= kSumRounding, "energy lost",
                           format("%llu estimates; sums over the impacts agree within %.1e; %llu count other impacts",
                                  number(f.estimates), f.energy_error, number(f.miscounted))));
  findings.push_back(
      judge(f.k_f_error <= kSumRounding, "K_f",
            format("recomputed from the impacts: agrees with what was published within %.1e", f.k_f_error)));
}

void BagAudit::report_counters(std::vector<Finding>& findings) const {
  if (!status_) {
    findings.push_back({Finding::Kind::note, "counters", "no status in the recording"});
    return;
  }
  const auto& s = *status_;
  const double a = log_.epochs().rbegin()->second.configuration.lattice_spacing_m;
  const bool good = s.search_failures == 0 && s.dropped_messages == 0 && s.worst_penetration <= node::kPenetration * a;
  findings.push_back(judge(good, "counters",
                           format("search failures %llu, dropped messages %llu, worst penetration %.1e m",
                                  number(s.search_failures), number(s.dropped_messages), s.worst_penetration)));
  findings.push_back(
      {Finding::Kind::note, "pace",
       format("late batches %llu, worst lag %.3g s, cut short by the impact budget %llu, refused commands "
              "%llu; %s",
              number(s.late_batches), s.worst_lag, number(s.budget_exhausted), number(s.refused_commands),
              s.scheduler.c_str())});
}

}  // namespace afm::audit
