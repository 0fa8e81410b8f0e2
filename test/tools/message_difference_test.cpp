// What two runs must agree in is every byte of their messages, and a difference has the name of its field.
#include "tools/replay/message_difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "node/wire/checkpoint_message.h"
#include "node/wire/run_digest.h"

namespace afm::replay {
namespace {

template <class Message>
Message from_bytes(std::vector<std::uint8_t> bytes) {
  Message message;
  ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::deserialize(stream, message);
  return message;
}

// Of the names in the definition of a message: those of its own fields.
template <class Message>
std::set<std::string> defined_fields() {
  std::istringstream lines(ros::message_traits::definition<Message>());
  std::set<std::string> fields;
  for (std::string line; std::getline(lines, line) && line.compare(0, 3, "===") != 0;) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string type, name;
    if (words >> type >> name && name.find('=') == std::string::npos && name != "header") fields.insert(name);
  }
  return fields;
}

// The field of the message that a difference lies in: "digest" of "checkpoint.digest.time.tau".
std::string own_field(const FieldDifference& difference) {
  const std::size_t begin = difference.field.find('.') + 1;
  return difference.field.substr(begin, difference.field.find('.', begin) - begin);
}

// Changes one byte after the other; each must show, under the name of a field.
template <class Message>
std::set<std::string> fields_that_show(const Message& message, std::size_t headers) {
  std::set<std::string> fields;
  const auto bytes = node::bytes_of(message);
  for (std::size_t i = headers; i < bytes.size(); ++i) {
    auto changed = bytes;
    changed[i] ^= 1;
    const auto other = from_bytes<Message>(changed);
    node::Digest a, b;
    node::add_message(message, a);
    node::add_message(other, b);
    EXPECT_NE(a, b) << i;
    const auto difference = find_difference(message, other);
    if (difference) fields.insert(own_field(*difference));
    EXPECT_TRUE(difference) << i;
  }
  return fields;
}

template <class Message>
void expect_every_field_shows() {
  constexpr std::size_t kHeader = 16;  // bytes of an empty one
  EXPECT_EQ(fields_that_show(Message(), kHeader), defined_fields<Message>());
}

TEST(MessageDifference, EveryFieldShows) {
  expect_every_field_shows<afm_emulator::Friction>();
  expect_every_field_shows<afm_emulator::Digest>();
}

TEST(MessageDifference, TextsShowToo) {
  afm_emulator::AppliedDrag drag, other;
  other.model = "hammer";
  const auto difference = find_difference(drag, other);
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->field, "applied_drag.model");
  EXPECT_EQ(difference->second, "hammer");
}

TEST(MessageDifference, OfAnArrayHasTheIndexOrTheSize) {
  afm_emulator::Deflection a, b;
  a.vertical = b.vertical = {1.0, 2.0, 3.0};
  b.vertical[2] = std::nextafter(3.0, 4.0);
  auto difference = find_difference(a, b);
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->field, "deflection.vertical");
  EXPECT_EQ(difference->index, 2u);
  EXPECT_EQ(difference->second, "3.0000000000000004");
  b.vertical = {1.0, 2.0};
  difference = find_difference(a, b);
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->field, "size of deflection.vertical");
  EXPECT_EQ(difference->first, "3");
  EXPECT_EQ(difference->second, "2");
}

TEST(MessageDifference, OfImpactsHasTheIndexOfTheImpact) {
  afm_emulator::ImpactArray a, b;
  a.impacts.resize(3);
  b = a;
  EXPECT_FALSE(find_difference(a, b));
  b.impacts[1].time.phase = 0.5;
  auto difference = find_difference(a, b);
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->field, "impacts.time.phase");
  EXPECT_EQ(difference->index, 1u);
  b = a;
  b.impacts.pop_back();
  difference = find_difference(a, b);
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->field, "number of impacts");
}

TEST(MessageDifference, StampsAndSequenceNumbersDoNotCount) {
  afm_emulator::Checkpoint a, b;
  b.header.seq = 7;
  b.digest.header.stamp.sec = 3;
  EXPECT_FALSE(find_difference(a, b));
  EXPECT_EQ(node::digest_of(a), node::digest_of(b));
}

TEST(MessageDifference, EvenWhatPrintsAlikeDiffers) {
  afm_emulator::Friction a, b;
  a.k_f = std::numeric_limits<double>::quiet_NaN();
  b.k_f = from_bytes<afm_emulator::ModelTime>({0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0xf8, 0x7f}).phase;
  const auto difference = find_difference(a, b);
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->field, "bytes");
}

// Impacts may come in any messages.
TEST(RunDigest, OfImpactsDoesNotDependOnTheirMessages) {
  afm_emulator::ImpactArray both, first, second;
  both.impacts.resize(2);
  both.impacts[1].count = 3;
  first.impacts = {both.impacts[0]};
  second.impacts = {both.impacts[1]};
  node::RunDigest whole, parts;
  whole.add(both);
  parts.add(first);
  parts.add(second);
  EXPECT_EQ(whole.message().impacts_digest, parts.message().impacts_digest);
}

}  // namespace
}  // namespace afm::replay
