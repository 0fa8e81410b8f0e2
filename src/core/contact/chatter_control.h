// Step control of chatter sequences: every limit of the law and of its integration.
#pragma once

namespace afm {

// Where no formula stands, the value is measured with benchmark/burst_error: with it the errors of sequences stay
// within the contact tolerance (docs/stability.md). Pure numbers unless a unit is given.
struct ChatterControl {
  // When a sequence may begin and go on.
  static constexpr double kMaxLoss = 0.25;  // of v in a bounce: the series of chatter_flow.h then have an error of 5e-4
  static constexpr double kMaxDuration = 0.06;  // adiabaticity limit: a bounce over the time of change of the reaction
  static constexpr double kLongerWithin = 2.5;  // times that limit within a sequence: only its last bounces reach it
  static constexpr double kSingleRatio = 0.5;   // times that limit for single bounces: they see the reaction as a cubic
  static constexpr double kMinSingleLoss = 0.05;   // 1 - gamma: with less, bounces one by one are too many
  static constexpr double kUsualThreshold = 1e-5;  // [a/tau] of the default tolerance; smaller ones take finer steps

  // A step, as a part of the time in which ...
  static constexpr double kFall = 2.0;          // ... v falls by the factor e, with a cutoff
  static constexpr double kLinearFall = 0.7;    // ... v falls to zero, without a cutoff
  static constexpr double kChange = 0.9;        // ... the reaction changes
  static constexpr double kSwing = 2.4;         // ... the reaction swings with the horizontal spring
  static constexpr double kLoseReaction = 0.6;  // ... the reaction falls by this part, by its first two derivatives
  static constexpr double kSingleStep = 0.15;   // ... the reaction changes, between two evaluations of single bounces

  // What must hold at the end of a step, or the step is halved.
  static constexpr double kMinReaction = 0.33;    // reaction over that at the start
  static constexpr double kMaxChange = 1.6;       // step over the time in which the reaction changes at the end
  static constexpr double kMaxSpeedGain = 2.0;    // v over that at the start
  static constexpr double kMaxBounce = 4.0;       // bounce over the time in which the reaction changes
  static constexpr double kMaxFallOfLogV = 10.0;  // more than twice the longest step, kFall / 0.5

  // The form of a step.
  static constexpr double kFastFall = 1.5;  // of ln v in a step: beyond it n needs its part in 1/v
  static constexpr double kBriefStep =
      1e-5;                                 // step over the shortest time of change: less gives differences of rounding
  static constexpr double kMinLoss = 1e-4;  // of v in a bounce: below it n alone changes

  // The last step of a sequence that dies may end below the threshold, and may be longer.
  static constexpr double kEndSpeed = 0.9;    // v at the end over the threshold
  static constexpr double kLinearEnd = 1.02;  // length over that to the threshold, without a cutoff
  static constexpr double kLastStep = 1.25;   // over a usual step

  // The last bounce of a sequence that exits.
  static constexpr double kFewBounces = 2.0;      // left until the limit: not worth a step
  static constexpr double kAcceptedRatio = 1.05;  // adiabaticity ratio there over the limit
  static constexpr double kMinRatio = 1e-9;       // a ratio of zero would give NaN in the formula for the limit
  static constexpr double kNearEnd = 0.009;     // fall of the reaction in a bounce: with less no step reaches the limit
  static constexpr double kNearlyWhole = 1e-2;  // of a bounce: error of n from where the end is interpolated
  static constexpr double kMinRest = 1e-6;      // of a bounce: smallest rest that kNearlyWhole is a part of
  static constexpr double kLittleLoss = 0.03;   // half a bounce over the fall time: the mean of two rates is enough
  static constexpr int kMaxTries = 5;           // for the step to the limit: more than one where P passes its maximum
  static constexpr int kMaxSteps = 40;          // to the whole n: bisection alone needs as many for 12 digits
};

}  // namespace afm
