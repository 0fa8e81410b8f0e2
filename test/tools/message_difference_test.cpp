// Where two messages differ, in the words of their definition.
#include "tools/bags/message_difference.h"

#include <afm_emulator/Applied.h>
#include <afm_emulator/Deflection.h>
#include <afm_emulator/Friction.h>
#include <afm_emulator/ImpactArray.h>
#include <gtest/gtest.h>

#include <cmath>

namespace afm::bags {
namespace {

TEST(MessageDifference, HasTheNameOfTheField) {
  afm_emulator::Applied a, b;
  b.model = "hammer";
  FieldDifference difference = find_difference(a, b);
  EXPECT_EQ(difference.field, "model");
  EXPECT_EQ(difference.simulated, "hammer");
  b = a;
  b.time.phase = 0.1;
  difference = find_difference(a, b);
  EXPECT_EQ(difference.field, "time.phase");
  EXPECT_EQ(difference.simulated, "0.10000000000000001");
}

TEST(MessageDifference, OfAnArrayHasTheIndex) {
  afm_emulator::Deflection a, b;
  a.vertical = b.vertical = {1.0, 2.0, 3.0};
  b.vertical[2] = std::nextafter(3.0, 4.0);
  FieldDifference difference = find_difference(a, b);
  EXPECT_EQ(difference.field, "vertical[2]");
  EXPECT_EQ(difference.simulated, "3.0000000000000004");
  b.vertical = {1.0, 2.0};
  difference = find_difference(a, b);
  EXPECT_EQ(difference.field, "vertical[2]");
  EXPECT_EQ(difference.recorded, "3");
  EXPECT_EQ(difference.simulated, "none");
  EXPECT_EQ(find_difference(b, a).recorded, "none");
}

TEST(MessageDifference, OfImpactsHasTheImpactAndItsField) {
  afm_emulator::ImpactArray a, b;
  a.impacts.resize(3);
  b = a;
  b.impacts[1].time.phase = 0.5;
  EXPECT_EQ(find_difference(a, b).field, "impacts[1].time.phase");
  b = a;
  b.impacts.pop_back();
  EXPECT_EQ(find_difference(a, b).field, "impacts[2]");
}

TEST(MessageDifference, EvenWhatPrintsAlikeDiffers) {
  EXPECT_EQ(find_difference(afm_emulator::Friction(), afm_emulator::Friction()).field, "bytes");
}

}  // namespace
}  // namespace afm::bags
