// For diagnostic_updater: OK, or what is wrong and why, and the figures. docs/interface.md has the table of levels.
#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include "health.h"

namespace afm::node {

constexpr double kTroublingLag = 0.5;        // [s]: what a person notices
constexpr double kHopelessLag = 2.0;         // [s]
constexpr double kTroublingLateShare = 0.1;  // of the batches since the last check
constexpr double kPenetration = 1e-10;       // [a]: more is not rounding
constexpr double kScarceReserves = 2.0;      // a recording comes near its end with less than so many reserves free

using Diagnosis = diagnostic_updater::DiagnosticStatusWrapper;

void diagnose_pace(const Health& health, Diagnosis& out);
void diagnose_commands(const Health& health, Diagnosis& out);
void diagnose_numerics(const Health& health, Diagnosis& out);
void diagnose_recording(const Health& health, Diagnosis& out);

}  // namespace afm::node
