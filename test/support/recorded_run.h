// What a run produced, put together from its batches, to compare runs bit for bit.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "afm/run.h"

namespace afm {

struct RecordedRun {
  std::vector<double> vertical, lateral;
  std::vector<Impact> impacts;
  ModelTime end;

  void append(const Batch& batch) {
    ASSERT_EQ(batch.vertical.size(), batch.lateral.size());
    ASSERT_EQ(batch.first_sample, vertical.size());
    ASSERT_EQ(batch.first_impact, impacts.size());
    ASSERT_TRUE(batch.begin == end);
    for (const Impact& impact : batch.impacts) ASSERT_TRUE(batch.begin <= impact.time && impact.time <= batch.end);
    end = batch.end;
    vertical.insert(vertical.end(), batch.vertical.begin(), batch.vertical.end());
    lateral.insert(lateral.end(), batch.lateral.begin(), batch.lateral.end());
    impacts.insert(impacts.end(), batch.impacts.begin(), batch.impacts.end());
  }
};

inline bool same_bits(const Impact& a, const Impact& b) {
  return a.time == b.time && a.surface_phase == b.surface_phase && a.normal_speed == b.normal_speed &&
         a.tangential_velocity == b.tangential_velocity && a.energy_loss == b.energy_loss && a.kind == b.kind &&
         a.count == b.count;
}

// All of `run` stands at the beginning of `truth`.
inline void expect_first_of(const RecordedRun& run, const RecordedRun& truth) {
  ASSERT_FALSE(run.vertical.empty());
  ASSERT_FALSE(run.impacts.empty());
  ASSERT_LE(run.vertical.size(), truth.vertical.size());
  ASSERT_LE(run.impacts.size(), truth.impacts.size());
  for (std::size_t i = 0; i < run.vertical.size(); ++i) {
    ASSERT_EQ(run.vertical[i], truth.vertical[i]) << "sample " << i;
    ASSERT_EQ(run.lateral[i], truth.lateral[i]) << "sample " << i;
  }
  for (std::size_t i = 0; i < run.impacts.size(); ++i) {
    ASSERT_TRUE(same_bits(run.impacts[i], truth.impacts[i])) << "impact " << i;
  }
}

}  // namespace afm
