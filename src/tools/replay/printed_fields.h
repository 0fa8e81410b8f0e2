// The fields of a message with their names and values, read from what ROS prints of it.
#pragma once

#include <cstddef>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace afm::replay {

struct PrintedField {
  std::string name;   // with those that it lies in: digest.time.tau; an element of an array has the name of the array
  std::string value;  // of a number: 17 digits
  std::size_t index;  // in its array; 0 elsewhere
};

struct FieldDifference {
  std::string field, first, second;
  std::size_t index = 0;  // in an array
};

std::string topic_name(const std::string& datatype);  // "afm_emulator/AppliedDrag" -> "applied_drag"

std::vector<PrintedField> parse_fields(const std::string& message_name, const std::string& text);

template <class Message>
std::vector<PrintedField> printed_fields(const std::string& message_name, const Message& message) {
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  text << message;
  return parse_fields(message_name, text.str());
}

// Precondition: the messages differ. Where all that is printed agrees (the signs of two NaN), the field is "bytes".
FieldDifference first_difference(const std::vector<PrintedField>& a, const std::vector<PrintedField>& b);

}  // namespace afm::replay
