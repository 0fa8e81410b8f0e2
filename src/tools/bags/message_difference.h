// Where two messages differ, as ROS prints them: nothing here lists the fields of a message.
#pragma once

#include <limits>
#include <sstream>
#include <string>

namespace afm::bags {

struct FieldDifference {
  std::string field;                // with those that it lies in: impacts[3].time.phase
  std::string recorded, simulated;  // of numbers: 17 digits
};

// The difference of two printed messages. Where they print alike (the signs of two NaN), the field is "bytes".
FieldDifference first_difference(const std::string& recorded, const std::string& simulated);

template <class Message>
FieldDifference find_difference(const Message& recorded, const Message& simulated) {
  const auto print = [](const Message& message) {
    std::ostringstream text;
    text.precision(std::numeric_limits<double>::max_digits10);
    text << message;
    return text.str();
  };
  return first_difference(print(recorded), print(simulated));
}

}  // namespace afm::bags
